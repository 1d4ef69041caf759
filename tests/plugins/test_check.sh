#!/bin/bash
# cost: 24
# `abut plugins check`: every built-in keeps every promise; each plugin of a gallery that breaks one fails on exactly that line, with the input that breaks it,
# also where it crashes, loops or ends the program; nothing is left behind. The same plugins in runs with `checked: true` end them with an error that names plugin,
# promise, bodies and time. test_check.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
templates=$PWD/plugins/new
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
unset ABUT_PLUGIN_PATH
export OMP_NUM_THREADS=1 TMPDIR=$scratch/tmp
mkdir -p "$TMPDIR"
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:handle_segv=0:handle_sigbus=0:handle_sigfpe=0 # of a build with sanitizers: a plugin's crash is the check's to tell
wrong=0
say() { wrong=1; printf '%s\n' "$*"; }
cd "$scratch" || exit 1

count=0
while read -r kind name _; do
    [ "$kind" = material ] || [ "$kind" = contact ] || [ "$kind" = boundary ] || continue
    count=$((count + 1))
    "$build/abut" plugins check "$name" >said.txt 2>&1
    status=$?
    [ $status -eq 0 ] && ! grep -q 'BROKEN\|not tried' said.txt || say "built-in $name (exit $status): $(cat said.txt)"
done < <("$build/abut" plugins)
[ $count -ge 15 ] || say "only $count built-ins were checked"

# broken KIND FAULT LINE PATTERN: exit 1, that line alone is broken, and the reason matches.
broken() {
    local file=$build/tests/plugins/broken/broken_$1_$2.so
    "$build/abut" plugins check "$file" >said.txt 2>&1
    local status=$? lines
    lines=$(awk '$1 == "BROKEN" { print $2 }' said.txt | tr '\n' ' ')
    [ $status -eq 1 ] && [ "$lines" = "$3 " ] || say "$1 $2 (exit $status): wanted $3 broken and nothing else, got '$lines': $(cat said.txt)"
    grep -A1 BROKEN said.txt | tail -n 1 | grep -qE -- "$4" || say "$1 $2: wanted '$4': $(cat said.txt)"
}
broken material TABLE_WITHOUT_BOUNDS settings 'SIGSEGV.*create with .*nu = .*outside of its range'
broken material NO_REASON settings 'refuses .*nu = 0\.[34].* and gives no reason'
broken material COUNTS_CALLS again 'row 0 of stress1 .* when asked again'
broken material OTHER_IN_EIGHTS batch 'in a batch of 1 with ld 1'
broken material SHARED_SCRATCH threads '4 threads'
broken material STIFFER_ALONG_X frame 'from turned input'
broken material SLOW_WAVES wave-speed 'its stiffness of 1.346.*e\+07 Pa'
broken material WRITES_OLD old-state 'it wrote into stress0'
broken material WRITES_BEHIND arrays 'behind the end of stress1'
broken material WRITES_BEFORE arrays 'before the start of stress1'
broken material TAKES_UNASKED unasked 'SIGSEGV.*NULL for deformation_gradient'
broken material NOT_FINITE finite 'row 1 of stress1 is -?nan: .*strain increment'
broken material NOT_WRITTEN finite 'row 0 of stress1 is not written'
broken material LOOPS finite 'did not come back.*SIGXCPU.*strain increment'
broken material CRASHES finite 'SIGSEGV.*strain increment'
broken material EXITS finite 'ended the program with exit status 0'
broken material MAKES_ENERGY dissipation 'dissipation is -'
broken response COUNTS_CALLS again 'when asked again'
broken response ASKS_NEIGHBOUR batch 'asked for 1 points at a time'
broken response FASTER_ALONG_X frame 'from turned input'
broken response FORGETS_ITSELF fixed-point 'asked again with the velocity'
broken response WRITES_NORMAL old-state 'it wrote into normal'
broken response WRITES_BEHIND arrays 'behind the end of stiffness'
broken response TAKES_UNASKED unasked 'SIGSEGV.*distance'
broken response DIVIDES_BY_MASS finite 'nan N s.*masses .* and 0 kg'
broken response THROWS dissipation 'more than they took'
broken finder FINDS_NOTHING find 'found no contact point'
broken finder COUNTS_CALLS again 'asked again gap'
broken finder REMEMBERS anew 'from an instance made anew'
broken finder LEANS_TO_X frame 'turned by a right angle gap'
broken finder WRITES_MASS old-state 'it wrote into mass'
broken finder WRITES_BEHIND arrays 'behind the end of gap'
broken finder NOT_FINITE finite 'area -?nan'
broken finder HEAVY_WEIGHTS momentum 'sum to 1.01, not 1'
broken boundary COUNTS_CALLS again 'row 0 of traction .* when asked again'
broken boundary REMEMBERS anew 'from an instance made anew'
broken boundary ASKS_NEIGHBOUR batch 'asked for [12] edges? alone'
broken boundary HARDER_ALONG_X frame 'from turned input'
broken boundary SAYS_LESS differences 'the damping that it says is .*; differences say'
broken boundary NEGATIVE_DAMPING differences 'damping across the normal is -'
broken boundary PUSHES passive 'that makes energy'
broken boundary WRITES_NORMAL old-state 'it wrote into normal'
broken boundary WRITES_BEHIND arrays 'behind the end of traction'
broken boundary WRITES_BEFORE arrays 'before the start of traction'
broken boundary TAKES_UNASKED unasked 'SIGSEGV.*NULL for stiffness prescribed'
broken boundary DIVIDES_BY_SPEED finite 'row 0 of traction is -?nan: .*waves'
broken boundary NOT_WRITTEN finite 'row 0 of state1 is not written'
broken boundary FORGETS_TO_SAVE save-load 'after load'
[ -z "$(ls "$TMPDIR")" ] || say "the check left files: $(ls "$TMPDIR")"

# What cannot be checked says so.
"$build/abut" plugins check nowhere.so >said.txt 2>&1
[ $? -eq 2 ] && grep -q "cannot read the plugin 'nowhere.so'" said.txt || say "a file that is not there: $(cat said.txt)"
"$build/abut" plugins check linear-elastc >said.txt 2>&1
[ $? -eq 2 ] && grep -q "did you mean 'linear-elastic'" said.txt || say "a class that is not there: $(cat said.txt)"
"$build/abut" plugins check "$build/tests/plugins/wrong_range.so" >said.txt 2>&1
[ $? -eq 2 ] && grep -q 'which holds nothing' said.txt || say "a descriptor that is wrong: $(cat said.txt)"
"$build/abut" plugins check linear-elastic --set nu=0.7 >said.txt 2>&1
[ $? -eq 1 ] && grep -q -- '--set nu=0.7: not a value' said.txt || say "a setting out of its range: $(cat said.txt)"

# ended KIND FAULT PATTERN: the template's scene with `checked: true`, and that plugin under its name.
ended() {
    rm -rf plugins
    mkdir -p plugins
    cp "$build/tests/plugins/broken/broken_$1_$2.so" plugins/my_law.so
    "$build/abut" run "$templates/$1.yaml" --set checked=true --set time.end=0.02 --quiet -j 1 -o out --plugin-path plugins >said.txt 2>&1
    local status=$?
    [ $status -ne 0 ] && [ $status -lt 3 ] && tr '\n' ' ' <said.txt | grep -qE -- "$3" || say "$1 $2 in a checked run (exit $status): wanted '$3': $(cat said.txt)"
}
ended material WRITES_OLD "material 'own'.*plugin 'my-law'.*\"what is handed in is not written\": it wrote into stress0"
ended material WRITES_BEHIND "plugin 'my-law'.*\"arrays are not overrun\": it went 0 bytes behind the end of stress1"
ended material WRITES_BEFORE "plugin 'my-law'.*\"arrays are not overrun\": it wrote before the start of stress1"
ended material MAKES_ENERGY "material 'own' of body 'block' gave up at t = .* near .* m (.*): plugin 'my-law'.*\"dissipation not negative\": it lost -.* item .* at t = "
ended response WRITES_NORMAL "contact of 'block' and 'table': .*plugin 'my-law'.*it wrote into normal.*at t = |contact of 'block' and 'table': .*plugin 'my-law'.*it wrote into normal.*t = "
ended response WRITES_BEHIND "contact of 'block' and 'table': .*plugin 'my-law'.*behind the end of stiffness.*t = "
ended response THROWS "contact of 'block' and 'table'.*plugin 'my-law'.*\"dissipation not negative\".*t = "
ended finder WRITES_MASS "contact of 'block' and 'table': .*plugin 'my-law'.*it wrote into mass"
ended finder WRITES_BEHIND "contact of 'block' and 'table': .*plugin 'my-law'.*behind the end of gap"
ended finder NOT_FINITE "contact of 'block' and 'table': .*plugin 'my-law'.*\"finite\": point 0 of .* t = "
ended finder HEAVY_WEIGHTS "contact of 'block' and 'table': .*plugin 'my-law'.*\"momentum is kept\": weights of side a of point 0 sum to 1.01"
ended boundary WRITES_NORMAL "boundary 'my-law' on 'column' .*gave up at t = .*plugin 'my-law'.*it wrote into normal"
ended boundary WRITES_BEHIND "boundary 'my-law' on 'column' .*gave up at t = .*plugin 'my-law'.*behind the end of traction"
ended boundary WRITES_BEFORE "boundary 'my-law' on 'column' .*gave up at t = .*plugin 'my-law'.*before the start of traction"
ended boundary DIVIDES_BY_SPEED "boundary 'my-law' on 'column' .*gave up at t = .*plugin 'my-law'.*\"finite\": row 0 of traction is -?nan"
exit $wrong
