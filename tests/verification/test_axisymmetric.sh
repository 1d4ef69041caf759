#!/bin/bash
# cost: 32
# Scenes about an axis by other bases, meshes, elements and pairs of methods than the scenes themselves say; columns of the plane about an axis; and the example of docs/axisymmetric.md.
# test_axisymmetric.sh BUILD; with ABUT_ALL=yes (tests/run --all) some more
build=$(realpath "${1:?the build folder}")
cd "$(dirname "$0")/../.." || exit 1
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
export OMP_WAIT_POLICY=passive
. tests/verification/variant.bash

sed -n '/^```yaml/,/^```/p' docs/axisymmetric.md | sed '/^```/d' >"$scratch/example.yaml"
"$build/abut" run "$scratch/example.yaml" --quiet --strict -j 1 -o "$scratch/example" || { echo "MISSED  the example of docs/axisymmetric.md"; missed=1; }

e() { echo "expect[$1].tolerance=$2"; }
variant "tube, h = 0.2" axi_tube constants.h=0.2 "$(e 1 3e-3)" "$(e 2 0.1)" "$(e 3 5e-2)"
[ "${ABUT_ALL:-no}" = no ] || variant "tube, h = 0.05" axi_tube constants.h=0.05 "$(e 0 3e-4)" "$(e 1 1e-4)" "$(e 2 2.5e-2)" "$(e 3 1.1e-2)"
variant "tube, bspline2" axi_tube bodies.tube.basis=bspline2 "$(e 0 3e-4)" "$(e 1 6e-4)" "$(e 2 5e-3)" "$(e 3 2.5e-3)"
[ "${ABUT_ALL:-no}" = no ] || variant "tube, bspline3" axi_tube bodies.tube.basis=bspline3 "$(e 0 5e-4)" "$(e 1 5e-4)" "$(e 2 5e-3)" "$(e 3 2.5e-3)"
variant "tube, cpdi" axi_tube bodies.tube.basis=cpdi "$(e 0 1e-3)" "$(e 1 1e-3)"
variant "tube, linear" axi_tube bodies.tube.basis=linear "$(e 0 2e-2)" "$(e 1 1.2e-2)" "$(e 2 9e-2)" "$(e 3 3.5e-2)"
variant "tube, nu = 0.4999, f_bar" axi_tube constants.nu=0.4999 bodies.tube.f_bar=patch time.cfl=0.8 "$(e 0 5e-3)" "$(e 1 5e-3)" "$(e 2 0.1)" "$(e 3 0.1)"
for type in q8r q4 q4r q6; do
    variant "tube, $type" axi_fe_tube bodies.tube.mesh.type=$type $([ $type = q8r ] || echo "$(e 0 3e-3) $(e 1 3e-3) $(e 2 6e-2) $(e 3 3.3e-2) $(e 6 3e-3)")
done
for type in q4r q6; do variant "tube, $type, nu = 0.4999" axi_fe_tube bodies.tube.mesh.type=$type constants.nu=0.4999 "$(e 0 4e-3)" "$(e 1 4e-3)" "$(e 2 4e-2)" "$(e 3 4e-2)" "$(e 6 4e-3)"; done
variant "tube, q4 f_bar, nu = 0.4999" axi_fe_tube bodies.tube.mesh.type=q4 bodies.tube.mesh.f_bar=true constants.nu=0.4999 "$(e 0 3e-3)" "$(e 1 3e-3)" "$(e 2 5e-2)" "$(e 3 5e-2)" "$(e 6 5e-3)" "$(e 7 1e-3)"
variant "turning shaft, solid" axi_spinning constants.a=0 "$(e 0 2e-4)"
[ "${ABUT_ALL:-no}" = no ] || variant "turning shaft, solid, h = 0.05" axi_spinning constants.a=0 constants.h=0.05 "$(e 0 5e-5)" "$(e 1 3e-3)" "$(e 2 2e-3)"
variant "turning tube, gimp" axi_spinning bodies.tube.basis=gimp "$(e 0 1e-3)" "$(e 1 4e-2)" "$(e 2 2e-2)"
variant "breathing shaft, 10 cells" axi_vibration constants.n=10 "$(e 0 1e-2)" "$(e 1 1.5e-2)"
[ "${ABUT_ALL:-no}" = no ] || variant "breathing shaft, 40 cells" axi_vibration constants.n=40 "$(e 0 6e-4)" "$(e 1 1e-3)"
for transfer in apic "{xpic: 2}"; do variant "breathing shaft, $transfer" axi_vibration "bodies.shaft.transfer=$transfer" "$(e 1 3.5e-2)"; done

fe='method: finite-elements, material: m'
a="bodies.a={$fe, velocity: [0, v], mesh: {box: [[0, 0], [R, L]], elements: [n, cells], type: q4}}"
b="bodies.b={$fe, mesh: {box: [[0, x1], [R, x2]], elements: [n, cells], type: q4}}"
variant "rods, points and elements on nodes" axi_impact "$b"
variant "rods, points and elements on segments" axi_impact "$b" "contact[0].algorithm=point-to-segment"
variant "rods, elements on segments" axi_impact "$a" "$b" "contact[0].algorithm=point-to-segment"

fix='fix: [{where: {side: bottom}, velocity: [null, 0]}, {where: {side: top}, velocity: [null, 0]}]'
inner="bodies.inner={method: finite-elements, material: steel, mesh: {box: [[1, 0], [cf, H]], elements: [8, 5], type: q4}, $fix}"
outer="bodies.outer={method: finite-elements, material: steel, mesh: {box: [[cf, 0], [2, H]], elements: [7, 3], type: q8}, $fix}"
variant "layers, points and elements on segments" axi_two_tubes constants.h=0.1 "$outer" "contact[0].algorithm=point-to-segment"
variant "layers, elements that do not match" axi_two_tubes "$inner" "$outer" "contact[0].algorithm=point-to-segment"
column="bodies.column={method: finite-elements, material: soil, gravity: false, mesh: {box: [[0, 0], [R, L]], elements: [5, 20], type: q4}, fix: [{where: {side: bottom}, velocity: [null, 0]}, {where: {side: right}, velocity: [0, null]}]}"
segments="algorithm: point-to-segment"
between="bodies: [column, piston]"
# Springs of 0.5 M/h give by p h/(0.5 M).
variant "piston on springs" axi_piston "contact[0]={$between, algorithm: multi-velocity, response: penalty, stiffness_of: modulus}" 'expect[1].reference="-p*(L + 2*h)/M"' "$(e 1 1e-3)"
variant "piston on springs, stiffness of mass" axi_piston "contact[0]={$between, algorithm: multi-velocity, response: penalty}" "$(e 1 0.04)"
variant "piston on surface points" axi_piston "contact[0]={$between, $segments, response: coulomb, friction: 0.3}" bodies.column.surface=points bodies.column.basis=cpdi "$(e 1 1e-3)"
variant "layers of points on segments" axi_two_tubes constants.h=0.1 "contact[0].algorithm=point-to-segment"
variant "layers, surface points" axi_two_tubes constants.h=0.1 "contact[0].algorithm=point-to-segment" bodies.inner.surface=points bodies.inner.basis=cpdi bodies.outer.basis=cpdi
variant "piston on elements" axi_piston "$column" "contact[0].algorithm=point-to-segment"
variant "Hill, q8r" axi_hill "bodies.tube={method: finite-elements, material: steel, mesh: {box: [[a, 0], [b, '2*h']], elements: [10, 1], type: q8r}, $fix}" constants.share=1 time.cfl=0.9
# The strip footing about the axis: a smooth flat circular punch, of which a half space bears 5.69 c_u (Shield 1955); study_footing.sh has the finer mesh.
variant "circular punch on clay, q8r" fe_footing space=axisymmetric constants.cells=4 'constants.way=0.00024*b' constants.end=0.4 'bodies.footing.shape={box: [[0, 0], [b, "b/4"]]}' bodies.ground.mesh.type=q8r bodies.ground.mesh.f_bar=false 'expect[0].reference="-5.69*cu*pi*b^2"' "$(e 0 0.108)"

# Columns about the axis that are confined, or have nu = 0, are those of the plane: all that does not depend on their cross section.
intensive() { # scene, how many of its first expects
    "$build/abut" run tests/verification/$1.yaml --quiet -j 1 -o "$scratch/column" --set space=axisymmetric &&
        python3 -c "import json, sys; e = json.load(open('$scratch/column/summary.json'))['expects'][:$2]; [print('        ', x['name'], x['value'], x['reference']) for x in e if not x['pass']]; sys.exit(not all(x['pass'] for x in e))" &&
        echo "passed  $1 about an axis" || { echo "MISSED  $1 about an axis"; missed=$((missed + 1)); }
}
intensive self_weight 4
intensive column 6
intensive column_neo_hookean 6
intensive column_von_mises 6
intensive pulse 6

wrong() { # setting, message
    if "$build/abut" check tests/verification/axi_piston.yaml --set "$1" 2>&1 | grep -q "$2"; then echo "passed  refused: $1"; else echo "MISSED  not refused: $1"; missed=$((missed + 1)); fi
}
wrong 'bodies.piston.motion={velocity: [1, null]}' 'moves along the axis only'
wrong 'gravity=[1, 0]' 'point away from the axis'
wrong 'grid.from=[-0.1, 0]' 'x is the radius'
wrong 'grid.from=[0.1, 0]' 'begins at the axis'
wrong 'grid.sides={left: fixed}' 'it is the axis'
exit $((missed > 0))
