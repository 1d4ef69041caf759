#!/bin/bash
# cost: 3
# What is known not to work is said before it starts, with place and remedy, and what goes wrong on the way names its first culprit. test_doubts.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
missed=0
expect() { # what to do, status, pattern ("-": no warning and no error), scene, settings
    local what=$1 status=$2 pattern=$3 scene=$here/$4.yaml set=() more=()
    shift 4
    for s in "$@"; do set+=(--set "$s"); done
    [ "$what" = run ] && more=(-q -j 1 -o out)
    "$build/abut" "$what" "$scene" "${more[@]}" "${set[@]}" >said 2>&1
    local got=$?
    if [ $got -ne "$status" ] || { [ "$pattern" = - ] && grep -Eq 'warning:|error:' said; } || { [ "$pattern" != - ] && ! grep -Eq -- "$pattern" said; }; then
        echo "MISSED  $what $scene: exit $got, wanted $status and '$pattern': $*"
        sed 's/^/        /' said
        missed=$((missed + 1))
    fi
}
nodes=light_nodes
# Every stage's own dt, by its name, and springs of the boundaries that act in it; the column of a free field.
stages=../verification/fe_stages_column
expect check 2 "error: dt of stage 'release' 1 s is [0-9.e+]+ times the stable limit" $stages 'stages[1]={name: release, duration: 1, dt: 1}'
expect check 0 "warning: dt of stage 'release' 0.0015 s is above the stable limit" $stages 'stages[1]={name: release, duration: 1, dt: 1.5e-3}'
expect check 0 - $stages 'stages[1]={name: release, duration: 1, dt: 8e-4}'
expect check 0 "boundaries\[0\] \(viscoelastic\).* and dt of stage 'release' \(line [0-9]+\) is 0.0008 s" $stages 'stages[1]={name: release, duration: 1, dt: 8e-4}' \
    'boundaries=[{on: ground, where: {side: right}, boundary: viscoelastic, springs: given, k_n: 1e11, stages: release}]'
expect check 0 - $stages 'boundaries=[{on: ground, where: {side: right}, boundary: viscoelastic, springs: given, k_n: 2e8, stages: release}]'
expect check 2 'yaml:[0-9]+:[0-9]+: error: boundaries\[1\] \(free-field\) on .shear.*more than 1000 steps.*use a spacing above' ../verification/free_field 'boundaries[1].spacing=1e-6'
expect check 2 'yaml:[0-9]+:[0-9]+: error: boundaries\[1\] \(free-field\) on .shear.*has more than 100000 elements' ../verification/free_field 'boundaries[1].spacing=9e-5' 'time={end: 1.2, cfl: 1e-6}'
expect check 0 - $nodes
expect check 2 '--set time: error: time.dt 2 s is [0-9.]+ times the stable limit .* use dt below the limit' $nodes 'time={end: end, dt: 2}'
expect plan 2 'error: time.dt 2 s is' $nodes 'time={end: end, dt: 2}'
expect run 2 'error: time.dt 2 s is' $nodes 'time={end: end, dt: 2}'
expect check 0 'warning: dt 2 s is above the stable limit' $nodes 'time={end: end, dt: 2}' 'watchdog={stop: false}'
expect check 2 'error: time.cfl 3.1 is so many times the stable limit' $nodes time.cfl=3.1
expect check 0 'warning: time.cfl 2.9 is above 1' $nodes time.cfl=2.9
expect check 0 'warning: time.cfl 5 is above 1' $nodes time.cfl=5 'watchdog={stop: false}'
expect check 0 'warning: dt 0.8 s is above the stable limit' $nodes 'time={end: end, dt: 0.8}'
expect check 0 - $nodes 'time={end: end, dt: 0.5}'
expect check 2 "error: time.dt: body 'block' moves [0-9.]+ cells in the first step" $nodes constants.drift=1000 'time={end: end, dt: 0.5}'
expect check 0 'warning: bodies.block: it flies through about [0-9.]+ cells with transfer flip, update musl on basis linear' $nodes constants.drift=20 bodies.block.update=musl
expect check 0 - $nodes constants.drift=20
expect check 2 'error: bodies.block: it flies through about [0-9.e+]+ cells .* on basis gimp, which may make energy out of rounding from some [0-9.e+]+ cells on, at this dt; use update usavg' $nodes constants.drift=3000 bodies.block.update=musl bodies.block.basis=gimp
expect run 2 'error: bodies.block: it flies' $nodes constants.drift=3000 bodies.block.update=usf bodies.block.basis=gimp
expect check 0 - $nodes constants.drift=150 bodies.block.update=musl bodies.block.basis=gimp
expect check 0 - $nodes constants.drift=3000 bodies.block.update=usavg bodies.block.basis=gimp
expect check 0 - $nodes constants.drift=3000 bodies.block.update=usavg
expect check 2 'error: bodies.block: a point at .* stands [0-9.e-]+ of a cell from a line of nodes' $nodes constants.eps=9e-4 bodies.block.update=usf
expect check 0 - $nodes constants.eps=0.02 bodies.block.update=usf
expect check 0 - $nodes constants.eps=9e-4 bodies.block.update=usavg
expect check 0 - $nodes constants.drift=3000 bodies.block.update=musl bodies.block.basis=gimp bodies.block.transfer=apic
expect check 0 'warning: time.cfl 0.9: basis bspline3 with update usl' $nodes bodies.block.basis=bspline3
expect check 0 - $nodes bodies.block.basis=bspline3 time.cfl=0.6
expect check 0 'warning: bodies.block: nu = 0.4999 .* waves [0-9.]+ times as fast.*f_bar: patch' $nodes constants.nu=0.4999
expect check 0 - $nodes constants.nu=0.4999 bodies.block.f_bar=patch
expect run 1 "body 'block': point [0-9]+ moved [0-9.]+ cells in one step, to \(.*velocity .*step 0, dt .*limit .*watchdog" $nodes 'time={end: end, dt: 0.4}' 'bodies.block.body_force=["10*rho", 0]'
expect run 1 "body 'block': point [0-9]+ moved .* cells in one step, to \(.*something threw it" $nodes 'time={end: 50, dt: 0.4}' 'bodies.block.body_force=["1e9*rho*t", 0]'
expect run 1 "turned inside out .*dt is above the limit of the mesh as it is now" ../verification/fe_bar 'time={end: 50, dt: 0.08}'
expect run 1 "turned inside out .*step [0-9]+, dt .*limit|makes energy" ../verification/fe_bar 'time={end: 50, dt: 0.075}'
expect check 2 "contact: body 'stone' is a single material point" small_bodies
expect check 0 - small_bodies 'contact[0].normal=[0, -1]'
expect check 0 "warning: contact: body 'stone' is 4 material points" small_bodies bodies.stone.fill.per_cell=4
expect check 0 "warning: contact: body 'stone' is 9 material points" small_bodies bodies.stone.fill.per_cell=9
expect check 2 "use normal: faces, algorithm point-to-segment, a direction as normal" small_bodies
expect check 0 - small_bodies 'contact[0].normal=faces'
expect check 0 - small_bodies bodies.stone.fill.per_cell=4 'contact[0].normal=faces'
expect check 0 "is 4 material points: .*; use algorithm point-to-segment, a direction" small_bodies bodies.stone.fill.per_cell=4 'contact[0].normal=faces' bodies.stone.basis=cpdi
mesh='{method: finite-elements, material: stone, mesh: {box: [[-3, -1], [4, 0]], elements: [7, 1], type: q4}, fix: [{where: {side: bottom}, velocity: [0, 0]}], gravity: false}'
expect check 0 "is 4 material points: .*; use algorithm point-to-segment, a direction" small_bodies bodies.stone.fill.per_cell=4 'contact[0].normal=faces' "bodies.plane=$mesh"
expect check 0 - small_bodies bodies.stone.fill.per_cell=16
expect check 0 - small_bodies bodies.stone.fill.per_cell=4 'contact[0].normal=[0, -1]'
expect check 0 - small_bodies bodies.stone.fill.per_cell=4 'contact[0].algorithm=point-to-segment'
expect check 0 "warning: bodies.block: by its speed it leaves the grid through its right side at about [0-9.]+ s, before time.end, and would be [0-9.]+ m beyond" crossings 'grid.to=[20, 3]'
expect check 0 - crossings 'grid.to=[20, 3]' 'grid.sides={right: outflow}'
# 1.275 m down at 0.1 m/s2: 5.05 s; the run ends at 10 s, 5 - 1.275 m below
fall=(crossings constants.crossings=10 'gravity=[0, -0.1]' "bodies.ledge={method: rigid, shape: {box: [[2, -0.8], [5, -0.6]]}, motion: {velocity: [0, 0], spin: 0}}")
past="bodies.ledge.shape.box=[[-2, -0.8], [-1.5, -0.6]]"
meets='contact=[{bodies: [block, ledge], algorithm: point-to-segment, response: frictionless}]'
expect plan 0 "warning: bodies.block: by its speed and gravity it leaves the grid through its bottom side at about 5.05 s, before time.end, and would be 3.7[0-9]* m beyond" "${fall[@]}"
expect check 0 - "${fall[@]}" "$meets"
expect check 0 "bodies.block: by its speed and gravity it leaves the grid through its bottom side at about 5.05" "${fall[@]}" "$meets" "$past"
expect check 0 - "${fall[@]}" "$meets" "$past" 'grid.sides={bottom: roller}'
expect check 0 - "${fall[@]}" 'gravity=[0, -0.1*(t > 6)]'
expect check 0 - "${fall[@]}" 'damping={local: 0.1}'
expect check 0 "through its bottom side at about 8.0[0-9]* s" "${fall[@]}" 'gravity=[0, "t < 3 ? 0 : -0.1"]'
expect run 1 "left the grid through its bottom side at .* t = 5.0[0-9]* s" "${fall[@]}"
expect check 0 "through its top side at about 1.78[0-9]* s|through its top side at about 1.77[0-9]* s" "${fall[@]}" 'bodies.block.velocity=[0.1, 1.2]'
expect check 0 - "${fall[@]}" bodies.block.gravity=false
expect check 0 - crossings
# friction that is to hold fast, and centres of points that are seen both ways
pulled=../verification/pulled_block
rough='contact=[{bodies: [block, plane], algorithm: point-to-segment, response: coulomb, friction: 1e6'
expect check 0 "warning: contact: friction 1e.06 is to hold 'block' and 'plane' together, .* use touching: auto or outline, or passes: first" $pulled "$rough, touching: centre}]"
expect check 0 - $pulled "$rough}]"
expect check 0 - $pulled "$rough, touching: outline}]"
expect check 0 - $pulled "$rough, passes: second}]"
expect check 0 - $pulled "${rough/1e6/0.9}}]"
# springs against the step: the limits that the run finds are 0.00183 s, 0.00100 s and 1.00e-5 s for stiffness 30, 100 and 1e6
springs=../verification/springs_slide
expect plan 0 "contact: where 'block' and 'plane' meet, springs of stiffness 30 x modulus are stable up to a dt of about 0.00223 s, and time.dt is 0.0044 s.*stiffness below 7.7" $springs constants.k=30 'time={end: end, dt: 0.0044}'
expect check 2 "springs_slide.yaml:17:5: error: contact: where 'block' and 'plane' meet, springs of stiffness 30 x modulus are stable up to a dt of about 0.00223 s, and time.dt is 0.0045 s, 2.02 times that: .*stiffness below 7.3, or stiffness_of: mass" $springs constants.k=30 'time={end: end, dt: 0.0045}'
expect check 0 "warning: contact: where .* stable up to a dt of about 0.00223 s" $springs constants.k=30 'time={end: end, dt: 0.0045}' 'watchdog={stop: false}'
expect check 0 - $springs constants.k=30 'time={end: end, dt: 0.001}'
expect check 0 - $springs constants.k=3 'time={end: end, dt: 0.0045}'
expect check 0 "springs_slide.yaml:17:5: warning: contact: .*dt of about 1.22e-05 s, so the step becomes 5.3e.02 times as short; .*stiffness_of: mass" $springs constants.k=1e6
cavity=../verification/boundary_cavity
given='boundaries[0]={on: endless, where: {side: right}, boundary: viscoelastic, springs: given, k_n: '
expect check 0 - $cavity
expect check 0 - $cavity "${given}1e5}"
expect check 0 "warning: boundaries\[0\] \(viscoelastic\) on 'endless': springs of 1e.07 Pa/m .* the step becomes 15 times as short; use softer springs" $cavity "${given}1e7}"
expect check 2 "error: boundaries\[0\] \(viscoelastic\) on 'endless': springs of 1e.16 Pa/m are stable up to a dt of about 3.44e-09 s" $cavity "${given}1e16}"
expect check 0 "warning: boundaries\[0\] .* and time.dt is 0.0015 s" $cavity "${given}1e5}" 'time={end: 0.1, dt: 0.0015}'
expect run 1 "springs of boundaries on 'endless'.* The springs of that boundary are too stiff for what they hold: use softer ones" $cavity "${given}1e25}" 'watchdog={stop: false}'
# springs at nodes of a gimp body, and a monitor that asks by number for a boundary that stands under grid.sides
side='where: {side: bottom}, boundary: viscoelastic, springs: given, k_n: 10'
expect check 2 "error: boundaries\[0\].at: springs of 'viscoelastic' at nodes .* use at: points, or basis linear" $nodes bodies.block.basis=gimp "boundaries=[{on: block, $side, at: nodes}]"
expect check 0 - $nodes bodies.block.basis=linear "boundaries=[{on: block, $side, at: nodes}]"
expect check 0 - $nodes bodies.block.basis=gimp "boundaries=[{on: block, $side, at: points}]"
expect check 2 'error: monitors\[0\].boundary: .* those under grid.sides have no number: write the side there instead' crossings \
    'grid.sides={left: {boundary: viscous}}' 'bodies.block.shape={box: [["-2*h", 0], [0, "2*h"]]}' 'monitors=[{name: f, boundary: 0, value: force.x}]' 'expect=[]'
# one element, a corner of which is pushed through its diagonal: first nearly inside out, then, where that is let go on, turned
cat >pushed_in.yaml <<'SCENE'
abut: 1
title: A corner pushed in
time: {end: 2, dt: 1e-3}
materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}
bodies:
  block:
    method: finite-elements
    material: m
    mesh: {box: [[0, 0], [1, 1]], elements: [1, 1], type: q4}
    fix: [{where: {x: 0}, velocity: [0, 0]}, {where: {y: 0}, velocity: [0, 0]}, {where: {x: 1, y: 1}, velocity: [-0.5, -0.5]}]
SCENE
here=. expect run 1 "body 'block': element [0-9]+ near .* m is nearly turned inside out \(watchdog: \{stop: false\} lets it go on\) at t = 0.99.*step 99[0-9], dt .*limit .*use a smaller dt" pushed_in
here=. expect run 1 "element [0-9]+ near .* m is turned inside out at t = 1" pushed_in 'watchdog={stop: false}'
# gravity in other units than the rest; a body of elements that blows up names a node
cat >weight.yaml <<'SCENE'
abut: 1
title: Gravity that nothing bears
gravity: [0, -10]
time: {end: 0.3, cfl: 0.5}
grid: {from: [0, 0], to: [4, 4], cell: 0.25, sides: {bottom: fixed}}
materials: {m: {model: linear-elastic, E: 1e6, nu: 0, density: 1000}}
bodies:
  points: {method: material-points, material: m, shape: {box: [[0, 0], [1, 1]]}}
  elements: {method: finite-elements, material: m, mesh: {box: [[2, 0], [3, 1]], elements: [4, 4], type: q4}}
SCENE
here=. expect check 0 - weight 'gravity=[0, -900]'
here=. expect check 0 '--set gravity: warning: gravity: by 1100 m/s2 a column of body .elements., 1 m high, weighs 1.1e.06 Pa, 1.1 times the modulus' weight 'gravity=[0, -1100]'
here=. expect check 0 - weight 'gravity=[0, -1100]' bodies.elements.gravity=false bodies.points.gravity=false
here=. expect check 2 "--set gravity: error: gravity: by 1e.05 m/s2 body .points. would move at .* faster than waves in it \(31.62 m/s\)" weight 'gravity=[0, -1e5]'
here=. expect run 1 "body 'elements': the kinetic energy is no finite number any more: node [0-9]+ at \(.*\) m has the velocity .*step 0, dt .*look at what drives it" weight \
    'gravity=[0, -1e300]' bodies.points.gravity=false 'watchdog={stop: false}'
[ $missed -eq 0 ] && echo "passed: $(basename "$0")"
[ $missed -eq 0 ]
