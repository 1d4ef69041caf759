#!/bin/bash
# cost: 4
# A record from a file: what is wrong with it is told at its line and column by `abut check`, exit 2; runs of it have the same bits under guard, on two threads and after a restart; a restart with
# another record is refused; the log says what was made of it. test_record.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
scenes=$PWD/tests/verification
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
unset ABUT_PLUGIN_PATH
wrong=0
say() { wrong=1; printf '%s\n' "$*"; }
cd "$scratch" || exit 1
cp "$scenes"/base_rigid.yaml "$scenes"/base_compliant.yaml "$scenes"/fe_base_compliant.yaml "$scenes"/base_sine.csv .

refused() { # PATTERN [--set ...]: exit 2 with a line that matches
    local pattern=$1
    shift
    "$build/abut" check base_rigid.yaml "$@" >said.txt 2>&1
    [ $? -eq 2 ] && grep -qE -- "$pattern" said.txt || say "$*: wanted '$pattern': $(cat said.txt)"
}
printf 't [s], a [m/s2]\n0, 1\n0.1, one\n0.05, 2\n0.2, 3\n0.2, 4\n' >bad.csv
refused '^(\./)?bad.csv:3:6: error: .one. in column 2 is not a number' --set 'boundaries[0].acceleration={file: bad.csv}'
refused '^(\./)?bad.csv:6:1: error: column 1 has to grow from row to row: 0.2 here, and 0.2 in line 5' --set 'boundaries[0].acceleration={file: bad.csv}'
refused "acceleration.file: cannot read 'nowhere.csv'|acceleration: cannot read '.*nowhere.csv'" --set 'boundaries[0].acceleration={file: nowhere.csv}'
refused "has no column 'v' \(line 2\)" --set 'boundaries[0].acceleration={file: base_sine.csv, columns: [t, v]}'
refused "'s' here, and 'ms' in the header" --set 'boundaries[0].acceleration={file: base_sine.csv, units: [s, cm/s2]}'
refused 'a record is missing' --set 'boundaries[0].acceleration=[[0, 1]]' --set 'boundaries[0].factor=1' --set 'boundaries[0]={on: column, where: {side: bottom}, boundary: base-motion}'

stopped() { # PATTERN [--set ...]: the run ends before its first step, exit 1 or 2, with a line that matches
    local pattern=$1
    shift
    "$build/abut" run base_rigid.yaml --quiet -j 1 -o stopped "$@" >said.txt 2>&1
    [ $? -ne 0 ] && grep -qE -- "$pattern" said.txt || say "$*: wanted '$pattern': $(cat said.txt)"
}
base='{on: column, where: {side: bottom}, boundary: base-motion, direction: y, acceleration: {file: base_sine.csv}}'
stopped 'both say how .column. moves along' --set "boundaries=[$base, $base]"
stopped 'free-field stands beside upright sides' --set 'boundaries=[{on: column, where: {side: bottom}, boundary: free-field, spacing: 0.25, base: compliant, velocity: [[0, 0], [1, 1]]}]'
sed 's/^  from:.*/  from: [0, 0]/; s/from: \[[^]]*\]/from: [0, 0]/' base_rigid.yaml >held.yaml
"$build/abut" run held.yaml --quiet -j 1 -o stopped --set grid.sides.bottom=fixed >said.txt 2>&1
[ $? -eq 2 ] && grep -q 'where a side of the grid or .fix. holds it' said.txt || say "a base that a side holds: $(cat said.txt)"

ran() { # NAME ARGUMENTS...: into folder NAME
    local name=$1
    shift
    "$build/abut" run "$@" --quiet -o "$name" >said.txt 2>&1 || say "$name: $(cat said.txt)"
}
for scene in base_rigid base_compliant fe_base_compliant; do
    ran plain $scene.yaml -j 1
    grep -q "acceleration of 401 rows, 0 to 0.8 s; baseline none" said.txt || say "$scene does not say what it reads: $(cat said.txt)"
    ran checked $scene.yaml -j 1 --set checked=true
    ran threads $scene.yaml -j 2
    for other in checked threads; do cmp plain/history.csv $other/history.csv || say "$scene: another result ($other)"; done
done
ran whole base_compliant.yaml -j 1 --set 'checkpoint={every: 0.15}'
cp base_sine.csv kept.csv
last=$(ls whole/checkpoint*.abut | tail -n 1)
ran again base_compliant.yaml -j 1 --set 'checkpoint={every: 0.15}' --restart "$last"
tail -n 3 whole/history.csv >a.txt && tail -n 3 again/history.csv | cmp - a.txt || say "the run that went on is another one"
sed 's/^100, .*/100, -31/' kept.csv >base_sine.csv
"$build/abut" run base_compliant.yaml -j 1 --quiet --set 'checkpoint={every: 0.15}' --restart "$last" -o other >said.txt 2>&1
[ $? -eq 2 ] && grep -q 'file base_sine.csv' said.txt || say "a restart with another record: $(cat said.txt)"
exit $wrong
