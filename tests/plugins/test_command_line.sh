#!/bin/bash
# The command line: what is wrong is said with a remedy, exits 2 and writes nothing. test_command_line.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
mkdir -p "$scratch/place"
scene=$(realpath cases/block_on_incline/scene.yaml)
cd "$scratch/place" || exit 1
wrong=0

# expect STATUS 'PATTERN' ARGUMENT...: the exit status, and the pattern in what is printed (either stream)
expect() {
    local status=$1 pattern=$2 printed actual
    shift 2
    printed=$("$build/abut" "$@" 2>&1 </dev/null)
    actual=$?
    if [ $actual -ne "$status" ] || ! grep -qE -- "$pattern" <<<"$printed"; then
        wrong=1
        printf 'abut %s\n  exit %d, wanted %d; wanted to read: %s\n%s\n' "$*" $actual "$status" "$pattern" "$(head -n 8 <<<"$printed")"
    fi
}

expect 2 '^Usage: abut COMMAND'
expect 0 '^Usage: abut COMMAND' --help
expect 0 '^Usage: abut COMMAND' help
for command in run check plan plugins version help; do
    expect 0 "^Usage: abut $command" help $command
    [ $command = help ] || expect 0 "^Usage: abut $command" $command --help
done
expect 0 'results/NAME' help run
expect 0 '^abut [0-9]+\.[0-9]+\.[0-9]+$' version
expect 0 '^abut [0-9]' --version
expect 2 "unknown command 'rum'; did you mean 'run'" rum x
expect 2 "unknown command 'xyzzy'; .abut help. lists" xyzzy
expect 2 'has no `extremes`, and no --vary is given' extremes "$scene"
expect 2 'SCENE missing; usage: abut run SCENE' run
expect 2 "one word too many: 'b'" run a b
expect 2 "unknown option '--strcit'; did you mean '--strict'" run "$scene" --strcit
expect 2 "unknown option '-z'" run "$scene" -z
expect 2 "unknown option '--output'" check "$scene" --output x
expect 2 "option '-o' wants a value" run "$scene" -o
expect 2 "wants the name of a folder" run "$scene" -o ''
for threads in 0 -1 two 1.5 4097 99999999999999999999 ''; do
    expect 2 'number of threads from 1 to 4096' run "$scene" -j "$threads"
done
expect 2 "wants PATH=VALUE, not 'constants.mu'" run "$scene" --set constants.mu
expect 2 "wants PATH=VALUE, not '=1'" run "$scene" --set =1
expect 2 'error' run no/such/scene.yaml
expect 2 'no/such/scene.yaml' check no/such/scene.yaml
expect 2 'error' run "$scene/.."
expect 2 'error: .*frction' run "$scene" --set 'contact[0].frction=1'
expect 2 "did you mean 'friction'" check "$scene" --set 'contact[0].frction=1'
expect 2 'error' run "$scene" --set 'contact[7].friction=1'
expect 2 'error' run "$scene" --set 'contact[0].algorithm=multi-velocty'
expect 2 'error' run "$scene" --set 'constants.mu=oops('
expect 2 "there is no 'a' at the top level" check "$scene" --set 'a[99].b=1'
expect 2 'time.end: steps of about .* more than 1e\+12' run "$scene" --set time.end=1e300 --set expect=[]
expect 2 'time.end: steps of about .* s \(limit: points of .* at 1e\+300 m/s, wave speed .*, in cells of .*\).*velocities and their units' check "$scene" --set bodies.block.velocity='[1e300, 0]' --set expect=[]
expect 2 'time.dt: 1e-300 s up to .* use a larger dt .*, or cfl' check "$scene" --set 'time={end: 1, dt: 1e-300}' --set expect=[]
expect 2 'time.end: steps of about' plan "$scene" --set time.end=1e300
expect 0 'warning: expect\[1\] is left out' check "$scene" --set time.end=0.01
expect 0 "warning: contact\[0\]: 'friction' is no setting" check "$scene" --set 'contact[0].response=tied'
expect 0 'scene.yaml: ok: 2 bodies, 2 materials, 1 contact' check "$scene"
expect 0 'scene.yaml: ok' check "$scene" --set constants.mu=0.3 --set 'bodies.block.fill.per_cell=4'
expect 0 'block' plan "$scene"
expect 0 '^\{' plan "$scene" --json
expect 0 'multi-velocity' plugins

if [ -n "$(ls -A .)" ]; then
    wrong=1
    echo "something was written: $(ls -A .)"
fi

# Output that cannot be written is not a success.
if "$build/abut" version >/dev/full 2>/dev/null; then
    wrong=1
    echo "abut version exits 0 although nothing could be written"
fi

# Where the results go.
"$build/abut" run "$scene" --quiet -j 1 --set time.end=1e-3 --set expect=[] || wrong=1
for file in results.h5 results.xdmf history.csv summary.json; do
    [ -s "results/block_on_incline/$file" ] || { wrong=1; echo "results/block_on_incline/$file is missing"; }
done
[ -d here ] && { wrong=1; echo "there is a folder that nobody asked for"; }

# A missed expect is a failure only with --strict; a met one never.
falls=(run ../falls.yaml --quiet -o here)
cat >../falls.yaml <<'YAML'
abut: 1
space: plane-strain
constants: {said: 0.5}
gravity: [0, -10]
time: {end: 0.1, dt: 1e-3}
grid: {from: [0, 0], to: [4, 4], cell: 0.5}
materials: {soil: {model: linear-elastic, E: "1 MPa", nu: 0.3, density: 1000}}
bodies:
  stone: {method: material-points, material: soil, shape: {box: [[1, 2], [2, 3]]}, fill: {rule: regular, per_cell: 4}}
monitors: [{name: speed, body: stone, value: velocity.y}]
expect: [{name: speed after a tenth of a second, monitor: speed, reference: "-said", norm: final, tolerance: 1e-6}]
YAML
sed -e 's|^gravity.*|gravity: [1/t, -10]|' -e 's|shape: {box|initial: {stress: gravity}, &|' ../falls.yaml >../settles.yaml
expect 0 '' "${falls[@]}"
expect 3 '' "${falls[@]}" --strict
expect 0 '' "${falls[@]}" --strict --set constants.said=1
expect 1 'cannot|not|could' "${falls[@]}" -o /dev/null/results
# A gravity without a value is named, in a run and in a stage; dt is not to blame.
expect 1 'error: gravity\[1\] is -?nan at t = 0\.05[0-9]* s, which is no finite number' "${falls[@]}" --set 'gravity=[0, "-10*sqrt(0.05-t)"]'
expect 2 ':4:11: error: gravity\[0\] is inf at t = 0 s, which is no finite number' run ../settles.yaml --quiet -o here
# A row of points that is looked for far from its body is doubted, as a place is.
expect 0 "warning: monitors\[0\].where: x = 9 lies outside body 'stone'; its nearest points are taken" check ../falls.yaml --set 'monitors[0].where={x: 9}'
expect 0 'ok: 1 body, 1 material, 1 monitor, 1 expect$' check ../falls.yaml --set 'monitors[0].where={x: 1.2}'
for file in history.csv summary.json; do
    [ -s "here/$file" ] || { wrong=1; echo "here/$file is missing"; }
done
exit $wrong
