#!/bin/bash
# cost: 45
# Bodies of points that touch by points on their own outline: impact along the grid and turned, a block at rest, a block that slides; the same bits on any number of
# threads; and contact points in the results. test_surface_points.sh BUILD
set -u
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
. tests/verification/variant.bash
both=(bodies.a.surface=points bodies.b.surface=points 'contact[0].algorithm=point-to-segment')
variant "impact" impact "${both[@]}"
variant "impact, turned" impact_turned "${both[@]}"
one=$count
variant "impact, turned, points half a cell apart" impact_turned "${both[@]:2}" 'bodies.a.surface={points: 0.5}' 'bodies.b.surface={points: 0.5}'
variant "impact, turned, one body by its domains" impact_turned "${both[@]:1}"
variant "oblique impact" diagonal "${both[@]}"
threads=2 variant "on two threads" impact_turned "${both[@]}"
if ! cmp -s "$scratch/$one/history.csv" "$scratch/$count/history.csv"; then
    missed=$((missed + 1))
    echo "MISSED  two threads give other bits than one"
fi
variant "at rest" rest_on_segments bodies.block.surface=points
variant "contact points in the results" rest_on_segments bodies.block.surface=points 'output={contact: true}' time.end=0.5
[ -f "$scratch/$count/results_contact_0.xdmf" ] || { missed=$((missed + 1)); echo "MISSED  results_contact_0.xdmf"; }
# Hertz at places of the block in the grid; the scene itself is a test, at 0.55 0.25. Its pressure has to stand still, or what it ends with is chance.
for place in "0.37 0.31" "0.05 0.5" "0.2 0.0" "0.8 0.7"; do
    variant "pressure of Hertz, surface and middle at $place of a cell" hertz_points constants.shift="${place% *}" constants.aside="${place#* }"
    if ! awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /pressure/) at = k; next } $at + 0 == $at { p[++n] = $at }
                  END { for (i = int(0.9 * n); i <= n; ++i) { if (!low || p[i] < low) low = p[i]; if (p[i] > high) high = p[i] }
                        exit !(n > 20 && high - low < 2e-3 * high) }' "$scratch/$count/history.csv"; then
        missed=$((missed + 1))
        echo "MISSED  the pressure swings by more than 0.2 % at $place"
    fi
done
[ $missed -eq 0 ]
