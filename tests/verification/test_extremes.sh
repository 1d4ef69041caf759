#!/bin/bash
# cost: 6
# abut extremes: a limit that is known exactly is found, runs that are there already, refusals, islands, maps, limits, signals, bad input. test_extremes.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
. "$here/must.bash"
page=$(realpath "$here/../../docs/stability.md")
sed -n '/^```yaml$/,/^```$/{/^```/!p}' "$page" >example.yaml
must "the example of docs/stability.md" "$build/abut" extremes example.yaml -o example -q
"$build/abut" extremes example.yaml -o example -q | grep '^|' >table
must "its table is the one on the page" bash -c "sed -n '/the table of the example/,/^\$/{/^|/p}' '$page' | diff - table"
cat >bar.yaml <<'SCENE' # linear elements, lumped: stable to dt c/h = 1 exactly, whatever the mesh
abut: 1
constants: {L: 25, cells: 10, E: 100, rho: 1, v0: 1e-4, part: 0.5, c: sqrt(E/rho), h: L/cells, w: 0.5*pi*c/L, nu: 0, mu: 0}
time: {end: 20*pi/w, dt: part*h/c}
materials: {bar: {model: linear-elastic, E: E, nu: nu, density: rho}}
bodies:
  bar:
    method: finite-elements
    material: bar
    mesh: {box: [[0, 0], [L, 2*h]], elements: [cells, 2], type: q4}
    fix: [{where: {side: left}, velocity: [0, null]}, {where: {side: bottom}, velocity: [null, 0]}]
    velocity: ["v0*sin(pi*x/(2*L))", 0]
monitors: [{name: end, body: bar, value: displacement.x, at: [L, 0]}]
expect: [{name: end, monitor: end, reference: v0/w, norm: peak, tolerance: 0.02}]
extremes:
  vary:
    - {name: dt, set: time.dt, value: "@*h/c", from: 0.5, to: 1.2, right_to: 0.98}
    - {name: nu, set: constants.nu, from: 0, to: 0.6, until: 0.1}
  limit: 20
SCENE
must "the stable limit of a bar" says 0 "^. dt . 1, not 1.01 . 1, not 1.01 . nowhere . yes . .*turned inside out" "$build/abut" extremes bar.yaml -o bar -q
must "right, stable and refused in one line" says 0 "^. nu . 0.26, not 0.3 . 0.4, not 0.45 . 0.5 . no . body 'bar'" "$build/abut" extremes bar.yaml -o bar -q
must "the files it leaves" python3 - <<'PYTHON'
import csv, json
extremes = json.load(open("bar/extremes.json"))
dt, nu = extremes["quantities"]
last, first = float(dt["stable"]["last"]), float(dt["stable"]["first_not"])
assert last <= 1 < first and first - last <= 0.02 * 0.7 + 1e-12, dt["stable"]
assert dt["holds"] and dt["right"] == dt["stable"] and dt["accepted"]["first_not"] is None
assert [p["verdict"] for p in dt["pieces"]] == ["right", "unstable"]
assert "inside out" in dt["how_it_ends"]
rows = list(csv.DictReader(open("bar/extremes.csv")))
assert len(rows) == len(dt["runs"]) + len(nu["runs"]) and rows[0]["verdict"] == "right" and float(rows[0]["error"]) < 0.02
PYTHON
must "runs that are there are not run again" bash -c "'$build/abut' extremes bar.yaml -o bar 2>&1 >/dev/null | grep -vc ' before, ' | grep -qx 0"
must "runs of another scene are" bash -c "sed 's/v0: 1e-4/v0: 2e-4/' bar.yaml >other.yaml; '$build/abut' extremes other.yaml --vary constants.nu=0,0.1 -o bar 2>&1 | grep -q '2 of 2.*done, '"
must "by the command line" says 0 "^. constants.part . 1, not 1.0" "$build/abut" extremes bar.yaml --vary constants.part=0.5..1.2 -o line -q
must "a formula with a condition" says 0 "^. k . 2, the end" "$build/abut" extremes bar.yaml --set 'extremes={vary: [{name: k, set: constants.v0, value: "@ > 1 ? 1e-4 : 2e-4", values: [1, 2]}]}' -o condition -q
must "right up to what is not tried" says 2 "right_to: 1.4 is not between from, 0.5, and to, 1.2" "$build/abut" extremes bar.yaml --set extremes.vary[0].right_to=1.4 -o bar -q
must "what must be right and is not, with --strict" says 3 "dt does not hold: unstable at" "$build/abut" extremes bar.yaml --set extremes.vary[0].right_to=1.1 --strict -o bar -q
# From the other end: the first value is not right, stable or accepted, and where it begins to be is found as closely.
must "the stable limit of a bar from beyond it" says 0 "^. part . from 1, not 1.01, up to 0.5, the end . from 1, not 1.01, up to 0.5, the end . nowhere . no . .*turned inside out" "$build/abut" extremes bar.yaml --set 'extremes.vary=[{name: part, set: constants.part, from: 1.2, to: 0.5}]' -o line -q
must "meshes from too coarse a one on" says 0 "^. cells . from 6, not 5, up to 16, the end . 16, the end . nowhere . no . 'end' is" "$build/abut" extremes bar.yaml --set 'extremes.vary=[{name: cells, set: constants.cells, from: 2, to: 16, rungs: 3, whole: true}]' --set 'expect[0].tolerance=5e-3' -o meshes -q
must "what is refused at both ends" says 0 "^. nu . from -0.17, not -0.2, up to 0.25, not 0.28 . from -0.8, not -0.82, up to 0.43, not 0.45 . -1.5 up to -1 and from 0.5 . no " "$build/abut" extremes bar.yaml --set 'extremes.vary=[{name: nu, set: constants.nu, from: -1.5, to: 0.6}]' -o ends -q
must "their files" python3 - <<'PYTHON'
import json
cells = json.load(open("meshes/extremes.json"))["quantities"][0]
assert cells["right"] == {"last_not": "5", "first": "6", "last": "16", "first_not": None} and cells["stable"] == {"last": "16", "first_not": None}, cells
assert json.load(open("ends/extremes.json"))["quantities"][0]["accepted"] == {"last_not": "-1", "first": "-0.97", "last": "0.47", "first_not": "0.5"}
PYTHON
must "pieces that do not go one way" says 0 "v0 does not go one way: right 1e-4, wrong 0, right 2e-4" "$build/abut" extremes bar.yaml --vary constants.v0=1e-4,0,2e-4 --set 'expect=[{name: end, monitor: end, reference: 1e-4/w, norm: peak, scale: 1/w, tolerance: 1e-3}]' --set 'expect[0].reference="max(v0, 1e-4)/w"' --set 'expect[0].tolerance=1e-5' -o pieces -q
one=(--vary 'time.end=12.3*pi/w' --set constants.part=0.9 -q) # ends in the middle of a vibration, where a step as long as this has energy made
"$build/abut" extremes bar.yaml "${one[@]}" -o made >said
made=$(python3 -c "import json; print(json.load(open('made/extremes.json'))['quantities'][0]['runs'][0]['remainder'])")
must "the run has made energy" python3 -c "assert 0.01 < $made < 0.1"
must "energy that is over what may be made" says 0 "time.end . not even 12.3.pi/w . not even 12.3.pi/w . .* . no . energy made: 0.0[0-9]+ of what moved" "$build/abut" extremes bar.yaml "${one[@]}" --set "extremes.energy=0.99*$made" -o made
must "energy that is below it" says 0 "time.end . 12.3.pi/w, the end . 12.3.pi/w, the end . nowhere . yes" "$build/abut" extremes bar.yaml "${one[@]}" --set "extremes.energy=1.01*$made" -o made
twins='set: constants.v0, values: [1e-4, 1.001e-4], same:' # the end of the bar goes by 1.0018 of v0/w, so the answers are 1.0018e-3 of a reference that stays apart
must "answers that are the same, and not quite" says 0 "^. wide . 1.001e-4, the end .* yes" "$build/abut" extremes bar.yaml --set "extremes.vary=[{name: wide, $twins 1.01e-3}, {name: narrow, $twins 0.99e-3}]" --set 'expect[0].reference=1e-4/w' -o twins -q
must "are told apart" grep -Eq "^. narrow . 1e-4, not 1.001e-4 . 1.001e-4, the end . nowhere . no . .*they differ by 0.001, 0.00099 allowed" said
must "a map" says 0 "0.1  # # o|# right" "$build/abut" extremes bar.yaml --vary constants.part=0.5,0.9,1.1 --vary constants.nu=0,0.1,0.5 --map part,nu -o map -q
must "its picture" python3 - <<'PYTHON'
import json, xml.dom.minidom
cells = json.load(open("map/extremes.json"))["map"]
verdicts = {(c["value"], c["second_value"]): c["verdict"] for c in cells}
assert verdicts["0.5", "0"] == "right" and verdicts["1.1", "0"] == "unstable" and verdicts["0.9", "0.5"] == "refused", verdicts
rects = xml.dom.minidom.parse("map/map.svg").getElementsByTagName("rect")
coloured = [r for r in rects if r.getElementsByTagName("title")]
assert len(coloured) == 9 and {r.getAttribute("fill") for r in coloured} == {"#4c9f50", "#c0392b", "#9aa0ad"} | ({"#eebc3a"} if "wrong" in verdicts.values() else set())
PYTHON
must "the limit of time" says 0 "over the limit of 2 s" "$build/abut" extremes bar.yaml --vary constants.cells=10,2000 --limit 2 -o limit -q
must "a signal leaves what is done" says 124 "1 of 2 runs have no verdict" timeout -s INT 4 "$build/abut" extremes bar.yaml --vary constants.cells=10,3000 -o signal
must "and it goes on from there" says 0 "done before" "$build/abut" extremes bar.yaml --vary constants.cells=10,20 -o signal
must "an unknown constant" says 2 "did you mean 'part'" "$build/abut" extremes bar.yaml --vary constants.prat=1..2 -o never
must "an unknown key" says 2 "wrong.yaml:17:[0-9]+: error: unknown key 'form' in extremes.vary\[1\]; did you mean 'from'" bash -c "sed 's/nu, from/nu, form/' bar.yaml >wrong.yaml; '$build/abut' extremes wrong.yaml -o never"
must "values that none goes" says 2 "no value of 'bodies.bar.method' is accepted" "$build/abut" extremes bar.yaml --vary bodies.bar.method=finite,elements -o never
must "nothing to drive" says 2 "nothing to drive" bash -c "sed '/^extremes/,\$d' bar.yaml >bare.yaml; '$build/abut' extremes bare.yaml -o never"
must "log through 0" says 2 "neither may be 0" "$build/abut" extremes bar.yaml --set extremes.vary[1].scale=log -o never
must "a map of one" says 2 "no quantity 'mu'" "$build/abut" extremes bar.yaml --map dt,mu -o never
must "a map of one path" says 2 "'a' and 'b' both set constants.nu, of which a run has one value" "$build/abut" extremes bar.yaml --set 'extremes={map: [a, b], vary: [{name: a, set: constants.nu, values: [0, 0.1]}, {name: b, set: constants.nu, values: [0, 0.1]}]}' -o never
must "one path twice" says 2 "two quantities are called 'constants.nu'" "$build/abut" extremes bar.yaml --vary constants.nu=0,0.1 --vary constants.nu=0,0.2 -o never
must "nothing is written where the input is wrong" test ! -e never
[ $missed -eq 0 ]
