#!/bin/bash
# cost: 10
# The gap of multi-velocity by points on the bodies' own outline: a corner touches where it was drawn, at any angle and place on the grid; impact along the grid and turned,
# an oblique impact, with surface points on one body and on both; the same bits on any number of threads. test_surface_gap.sh BUILD
set -u
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
. tests/verification/variant.bash
variant "corner of 20 degrees" corner_touch constants.degrees=20
variant "on a grid moved" corner_touch constants.degrees=31 constants.shift=0.77
variant "points a quarter of a cell apart" corner_touch constants.degrees=60 constants.shift=0.5 'bodies.corner.surface={points: 0.25}' 'bodies.flat.surface={points: 0.5}'
variant "the corner alone has surface points" corner_touch constants.degrees=52 bodies.flat.surface=domains
for basis in linear bspline2 cpdi; do
    variant "$basis" corner_touch constants.degrees=38 constants.shift=0.11 bodies.corner.basis=$basis bodies.flat.basis=$basis
done
wanted=3 variant "by its domains it touches late" corner_touch bodies.corner.surface=domains bodies.flat.surface=domains
a=bodies.a.surface=points b=bodies.b.surface=points
variant "impact, turned" impact_turned $a $b
one=$count
threads=2 variant "on two threads" impact_turned $a $b
if ! cmp -s "$scratch/$one/history.csv" "$scratch/$count/history.csv"; then
    missed=$((missed + 1))
    echo "MISSED  two threads give other bits than one"
fi
variant "the first body alone" impact_turned $a constants.degrees=17
variant "the second body alone" impact_turned $b constants.degrees=45
variant "impact on a grid moved" impact $a $b constants.shift=0.37
variant "oblique impact" diagonal $a $b constants.cells=128
[ $missed -eq 0 ]
