#!/bin/bash
# cost: 18
# abut trade: the front and the sentence against what the runs themselves say, runs that are there already, failures, limits, signals, bad input. test_trade.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
. "$here/must.bash"
bar=$here/bar_1.yaml
basis='bodies.bar.basis=linear,gimp,bspline2'
must "a ladder of meshes and bases" says 0 "cheapest within an error of 0.01 is constants.cells=" "$build/abut" trade "$bar" --vary constants.cells=12,25,50 --vary "$basis" -o bar --write best.yaml --tolerance 1e-2
must "the files it leaves" python3 - <<'PYTHON'
import csv, json, math
import xml.dom.minidom
trade = json.load(open("bar/trade.json"))
runs = trade["runs"]
assert len(runs) == 9 and all(r["outcome"] == "done" for r in runs)
for r in runs:
    summary = json.load(open(r["folder"] + "/summary.json"))
    errors = {e["name"]: abs(e["error"]) for e in summary["expects"]}
    assert r["errors"] == errors and r["error"] == max(errors.values()), r
    assert r["remainder"] == summary["ledger"]["remainder_relative"] and 0 < r["cpu_seconds"] and r["peak_bytes"] > 1e6
    beaten = any(o["error"] <= r["error"] and o["cpu_seconds"] <= r["cpu_seconds"] and (o["error"], o["cpu_seconds"]) != (r["error"], r["cpu_seconds"]) for o in runs)
    assert r["front"] == (not beaten), r
good = [r for r in runs if r["error"] <= 1e-2]
assert trade["cheapest"] == min(good, key=lambda r: r["cpu_seconds"])["settings"]
assert trade["most_accurate"] == min((r for r in runs if r["cpu_seconds"] <= 10), key=lambda r: r["error"])["settings"]
rows = list(csv.DictReader(open("bar/trade.csv")))
assert [float(row["error"]) for row in rows] == [r["error"] for r in runs]
picture = xml.dom.minidom.parse("bar/trade.svg")
assert len(picture.getElementsByTagName("circle")) == 9
PYTHON
# The same runs again, with fewer seconds than the most accurate of them takes: another one is named.
seconds=$(python3 - <<'PYTHON'
import json
runs = json.load(open("bar/trade.json"))["runs"]
least, best = min(r["cpu_seconds"] for r in runs), min(runs, key=lambda r: r["error"])
assert least < best["cpu_seconds"]
print(repr(0.5 * (max(r["cpu_seconds"] for r in runs if r["cpu_seconds"] < best["cpu_seconds"]) + best["cpu_seconds"])))
PYTHON
)
must "fewer seconds" says 0 "the most accurate within [0-9.]+ s is constants.cells=" "$build/abut" trade "$bar" --vary constants.cells=12,25,50 --vary "$basis" -o bar --seconds "$seconds"
must "name another run as the most accurate" python3 - "$seconds" <<'PYTHON'
import json, sys
trade = json.load(open("bar/trade.json"))
runs = trade["runs"]
assert trade["seconds"] == float(sys.argv[1])
assert trade["most_accurate"] == min((r for r in runs if r["cpu_seconds"] <= trade["seconds"]), key=lambda r: r["error"])["settings"]
assert trade["most_accurate"] != min(runs, key=lambda r: r["error"])["settings"]
PYTHON
must "too few seconds" says 0 "no run with a known error takes 0.0001 s or less" "$build/abut" trade "$bar" --vary constants.cells=12,25,50 --vary "$basis" -o bar --seconds 1e-4
must "the scene it writes runs and is as good" "$build/abut" run best.yaml --quiet -o best
must "errors of that scene" python3 -c "
import json
assert max(abs(e['error']) for e in json.load(open('best/summary.json'))['expects']) <= 1e-2"
must "runs that are there are not run again" says 0 "9 of 9 .*done before" "$build/abut" trade "$bar" --vary constants.cells=12,25,50 --vary "$basis" -o bar
sed 's/v0: 1e-4/v0: 2e-4/' "$bar" >other.yaml
must "runs of another scene are" bash -c "'$build/abut' trade other.yaml --vary constants.cells=12 -o bar 2>&1 | grep -q '1 of 1.*done, '"

ladders=(--vary constants.cells=12,25,50 --vary bodies.bar.basis=linear,gimp,bspline2,bspline3 --vary bodies.bar.transfer='flip,{flip: 0.9},pic,{xpic: 2}' --set 'constants.end=2*2*pi/w')
# Which runs a path makes goes by their times: tests/unit/test_trade_path.c holds that with given ones. Here: that it is made, and of runs that all stand in its table.
must "a path through them" says 0 "of 48 combinations were run" "$build/abut" trade "$bar" "${ladders[@]}" -o walk --path --seconds 0.1
must "from the scene's own settings on" python3 - <<'PYTHON'
import json
path = json.load(open("walk/trade.json"))
done = [r for r in path["runs"] if r["outcome"] == "done"]
assert path["search"] == "path" and len(path["runs"]) == 48 and 5 <= len(done), len(done)
assert any(r["settings"]["constants.cells"] == "50" and r["settings"]["bodies.bar.transfer"] == "flip" for r in done) # bar_1.yaml's own is 50 cells, flip
settings = [r["settings"] for r in done]
assert path["cheapest"] in settings and (path["most_accurate"] is None or path["most_accurate"] in settings)
PYTHON
must "threads are a ladder" says 0 "cheapest within" "$build/abut" trade "$bar" --vary threads=1,2 --set constants.cells=25 --set trade.cost=wall -o threads --tolerance 1 --write threads.yaml
must "and are used" python3 -c "
import json
runs = json.load(open('threads/trade.json'))['runs']
assert [json.load(open(r['folder'] + '/summary.json'))['threads'] for r in runs] == [1, 2] and runs[0]['error'] == runs[1]['error'], runs"
must "the scene with them runs" "$build/abut" check threads.yaml
must "threads that are none" says 2 "no number of threads" "$build/abut" trade "$bar" --vary threads=1,many -o never
must "elements, algorithm, response, normal and cfl are ladders" says 0 "16 of 32 runs have no answer" "$build/abut" trade "$here/impact_mpm_fe.yaml" --set constants.cells=8 \
    --vary bodies.b.mesh.type=q4r,q4 --vary 'contact[0].algorithm=multi-velocity,point-to-segment' --vary 'contact[0].response=coulomb,frictionless' \
    --vary 'contact[0].normal=average,volume-gradient' --vary time.cfl=0.4,0.2 -o many

cat >plain.yaml <<'SCENE' # without expects: the last values of the monitors tend to a limit
abut: 1
space: plane-strain
constants: {cells: 10, h: 25/cells, w: 10*pi/50}
time: {end: 0.4*pi/w, cfl: 0.4}
grid: {from: [0, 0], to: [25 + 4*h, 2*h], cell: h, sides: {left: roller, bottom: roller, top: roller}}
materials: {m: {model: linear-elastic, E: 100, nu: 0, density: 1}}
bodies: {bar: {method: material-points, material: m, shape: {box: [[0, 0], [25, 2*h]]}, velocity: ["1e-4*sin(pi*x/50)", 0], update: usf}}
monitors: [{name: tip, body: bar, value: displacement.x, over: max}, {name: v, body: bar, value: velocity.x}]
trade:
  vary: [{set: constants.cells, values: [10, 20, 40]}]
SCENE
must "a scene without expects" says 0 "limit that constants.cells tends to" "$build/abut" trade plain.yaml -o plain
must "its errors are those against Richardson's limit, of the tip next to the exact answer" python3 - <<'PYTHON'
import csv, json, math
runs = json.load(open("plain/trade.json"))["runs"]
answer = 1e-4 / (10 * math.pi / 50) * math.sin(0.4 * math.pi)  # of the tip: the first mode of a bar, c = 10
for name in ("tip", "v"):
    histories = [[float(row[name]) for row in csv.DictReader(open(r["folder"] + "/history.csv"))] for r in runs]
    a, b, c = (h[-1] for h in histories)
    limit = c + (c - b) / ((a - b) / (b - c) - 1)
    peak = max(abs(v) for v in histories[2])
    for r, h in zip(runs, histories):
        assert abs(r["errors"][name] - abs(h[-1] - limit) / peak) <= 1e-9 * r["errors"][name], (name, r["errors"][name])
    assert name == "v" or abs(limit - answer) < 0.2 * abs(c - answer), (limit, c, answer)
e = [r["errors"]["tip"] for r in runs]
assert 2 < e[0] / e[1] < 8 and 2 < e[1] / e[2] < 8, e
PYTHON
must "a ladder from fine to coarse is the same" says 0 "with order 0.77 to 1.1; finest: constants.cells=40, 3.2e.04 point-steps\)$" "$build/abut" trade plain.yaml -o plain --vary constants.cells=40,20,10
must "to the last digit" python3 - <<'PYTHON'
import json
trade = json.load(open("plain/trade.json"))
assert [r["settings"]["constants.cells"] for r in trade["runs"]] == ["10", "20", "40"] and trade["finest"] == {"constants.cells": "40"} and trade["doubts"] == []
assert 2 < trade["runs"][0]["errors"]["tip"] / trade["runs"][1]["errors"]["tip"] < 8
PYTHON
must "the finest is that of the smallest cfl" says 0 "the finest run, time.cfl=0.1, constants.cells=20 .3.2e.04 point-steps., and nothing says how near" "$build/abut" trade plain.yaml -o plain --vary time.cfl=0.1,0.4 --vary constants.cells=20,10
must "it alone has no error" python3 -c "
import json
assert [r['settings'] for r in json.load(open('plain/trade.json'))['runs'] if r['error'] is None] == [{'time.cfl': '0.1', 'constants.cells': '20'}]"
must "a path begins with it, too" says 0 "errors are against the limit that constants.cells tends to" "$build/abut" trade plain.yaml -o plain --vary constants.cells=40,20,10,5 --path
must "what does not converge is said with the sentence" says 0 "But 'tip' does not converge along constants.cells: it changes by 0.00[0-9]+, then by 0.00[0-9]+; 'v' does not .*differences to the finest run" \
    "$build/abut" trade plain.yaml -o grows --set 'bodies.bar.velocity=["1e-4*cells*sin(pi*x/50)", 0]'
must "and in its file" python3 -c "
import json
trade = json.load(open('grows/trade.json'))
assert len(trade['doubts']) == 2 and trade['runs'][2]['error'] is None and 'limit' not in trade['reference'], trade"
must "a ladder of what refines nothing tends to no limit" says 0 "the finest run, constants.part=4 " "$build/abut" trade plain.yaml -o part --set constants.part=1 --set 'bodies.bar.velocity=["1e-4*(1 + 1/part)*sin(pi*x/50)", 0]' --vary constants.part=1,2,4
must "monitors that count are named" says 0 "the largest of 'v'$" "$build/abut" trade plain.yaml -o plain --set 'trade.error=[v]'
must "a monitor that is not there" says 2 "there is no monitor 'vv'; known: tip, v" "$build/abut" trade plain.yaml -o plain --set 'trade.error=[vv]'
must "a run that fails is a row, not the end" says 0 "refused" "$build/abut" trade "$bar" --vary bodies.bar.transfer=flip,tpic --vary bodies.bar.update=musl,usl --set constants.cells=12 -o refused
must "the limit stops dear runs" says 0 "cheaper run is over the limit" "$build/abut" trade "$bar" --vary constants.cells=12,1600,3200 --limit 3 -o limit
must "a signal leaves what is done" says 124 "1 of 2 runs have no answer" timeout -s INT 6 "$build/abut" trade "$bar" --vary constants.cells=12,1600 -o signal
must "and it goes on from there" says 0 "done before" "$build/abut" trade "$bar" --vary constants.cells=12,25 -o signal
# A folder is of one program at a time; of one that was killed its runs are gone, too, and the next goes on at once.
"$build/abut" trade "$bar" --vary constants.cells=12,3200 -o shared -q >first 2>&1 &
first=$!
for ((i = 0; i < 200; i++)); do runs=$(tr -d " " </proc/$first/task/$first/children) && [ -n "$(cat shared/runs/*/trial.json 2>/dev/null)" ] && break; sleep 0.05; done
must "one at work in a folder" test -n "$runs"
must "a second one there is told whose it is" says 1 "error: another abut is at work in the folder shared, process $first: wait until it has ended, or give another folder with -o" "$build/abut" trade "$bar" --vary constants.cells=12,25 -o shared
must "extremes as well" says 1 "at work in the folder shared/., process $first:" "$build/abut" extremes "$bar" --vary constants.cells=12,25 -o shared/.
kill -KILL $first
wait $first 2>/dev/null
must "after it was killed a new one goes on" says 0 "2 of 2 .*cells=25: done" "$build/abut" trade "$bar" --vary constants.cells=12,25 -o shared
must "with what it had done" grep -q "cells=12: done before" said
must "and its runs are gone" bash -c "! grep -s '^State:' /proc/$runs/status | grep -qv zombie" # where nobody collects orphans they stay as zombies
kill -KILL $runs 2>/dev/null # should they not be
mkdir copy && cp -r "$build/abut" "$build/plugins" copy/
must "runs with another plugin are new ones" bash -c "
    copy/abut trade '$bar' --vary constants.cells=12 -o again -q >first && copy/abut trade '$bar' --vary constants.cells=12 -o again 2>&1 | grep -q 'done before' &&
    printf 'x' >>copy/plugins/material/linear_elastic.so && copy/abut trade '$bar' --vary constants.cells=12 -o again 2>&1 | grep -q 'cells=12: done, '"
"$build/abut" trade plain.yaml -o cut -q >first
for file in summary.json history.csv; do
    must "a run of which $file is cut off" bash -c "f=\$(ls -d cut/runs/20_*/)$file; truncate -s \$((\$(stat -c %s \$f) / 2)) \$f"
    must "is made again, and only that" says 0 "cells=20: done, " "$build/abut" trade plain.yaml -o cut
    must "the others stand" bash -c "[ \$(grep -c 'done before' said) = 2 ]"
done
must "a full disk is no verdict" bash -c "
    (ulimit -f 8; '$build/abut' trade '$bar' --vary constants.cells=12 -o full >first 2>&1); '$build/abut' trade '$bar' --vary constants.cells=12 -o full 2>&1 | grep -q 'cells=12: done, '"
must "and the table is shown, with what each run said" bash -c "grep -q 'cells=12: failed, .*: cannot write ' first && grep -q 'constants.cells' first"
must "no run at all" says 1 "no run came to its end" "$build/abut" trade "$bar" --vary constants.cells=12 --set 'time={end: end, dt: "2*h/c"}' -o none
must "a place that cannot be written" says 2 "cannot be written" "$build/abut" trade "$bar" --vary constants.cells=12 -o never --write nowhere/best.yaml
cp "$bar" own.yaml && ln -s own.yaml link.yaml
for name in own link; do
    must "--write on the scene itself" says 2 "^error: --write ./$name.yaml: that is the scene itself, .*name another file" "$build/abut" trade own.yaml --vary constants.cells=12 -o never --write ./$name.yaml
done
must "it is as it was" cmp "$bar" own.yaml
mkfifo pipe && : >kept.yaml && ln -s kept.yaml chain.yaml
must "--write into what is no file" says 2 "^error: --write pipe: that is no file" "$build/abut" trade "$bar" --vary constants.cells=12 -o never --write pipe
must "it is still there" test -p pipe
must "--write over a link" says 0 "holds the scene" "$build/abut" trade "$bar" --vary constants.cells=12 -o chained --write chain.yaml
must "goes to where it leads" bash -c "test -L chain.yaml && grep -q 'constants.cells=12' kept.yaml"
must "one path in two ladders" says 2 "trade.vary.1.: constants.cells is set by trade.vary.0., too, and a run has one value of it; put all" "$build/abut" trade "$bar" --vary constants.cells=12,25 --vary constants.cells=12,50 -o never
must "an unknown constant" says 2 "did you mean 'cells'" "$build/abut" trade "$bar" --vary constants.cels=1,2 -o never
must "values that none goes" says 2 "no value of 'bodies.bar.basis' is accepted" "$build/abut" trade "$bar" --vary bodies.bar.basis=liner,gimpp -o never
must "nothing to try" says 2 "nothing to try" "$build/abut" trade "$bar" -o never
must "a ladder with a value twice" says 2 "stands there twice" "$build/abut" trade "$bar" --vary constants.cells=12,12 -o never
must "too many combinations" says 2 "combinations" "$build/abut" trade "$bar" --vary constants.cells="$(seq -s, 1 60)" --vary constants.n="$(seq -s, 1 60)" --vary constants.L="$(seq -s, 1 60)" -o never
must "nothing is written where the input is wrong" test ! -e never
[ $missed -eq 0 ]
