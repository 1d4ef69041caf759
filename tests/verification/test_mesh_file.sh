#!/bin/bash
# cost: 5
# A quarter of a ring from a Gmsh file must move as the same patch does, and a file that is wrong is refused by `abut check`. test_mesh_file.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
mkdir -p "$scratch/meshes"

scene() { # mesh
    cat <<SCENE
abut: 1
title: A quarter of a ring is pulled at its end
time: {end: 0.2, dt: 5e-4}
materials: {steel: {model: linear-elastic, E: 15 MPa, nu: 0.3, density: 6000}}
bodies:
  ring:
    method: finite-elements
    material: steel
    mesh: $1
    fix: [{where: {y: 0}, velocity: [0, 0]}]
loads:
  - {body: ring, at: [0, 2], force: ["1e4*min(t/0.1, 1)", 0]}
monitors:
  - {name: tip, body: ring, at: [0, 2], value: displacement.x}
SCENE
}
scene '{patch: {bottom: [[1, 0], [2, 0]], right: {arc: {from: [2, 0], to: [0, 2], center: [0, 0]}}, top: [[0, 1], [0, 2]], left: {arc: {from: [1, 0], to: [0, 1], center: [0, 0]}}}, elements: [3, 8]}' >"$scratch/patch.yaml"
scene '{file: meshes/ring.msh}' >"$scratch/file.yaml"
for name in wrong mixed twice; do scene "{file: meshes/$name.msh}" >"$scratch/$name.yaml"; done

# The same mesh in two surfaces of a file, ids with gaps, drawn clockwise.
/usr/bin/env python3 - "$scratch/meshes" <<'PYTHON' || exit 1
import math, sys

nr, na = 3, 8
node = {}
for j in range(2 * na + 1):
    for i in range(2 * nr + 1):
        if i % 2 == 0 or j % 2 == 0:
            r, a = 1 + i / (2 * nr), 0.5 * math.pi * j / (2 * na)
            node[i, j] = (1000 + 7 * len(node), r * math.cos(a) if j < 2 * na else 0.0, r * math.sin(a))
around = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]  # clockwise
lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(node))]
lines += [f"{id} {x!r} {y!r} 0" for id, x, y in node.values()]
lines += ["$EndNodes", "$Elements", str(nr * na)]
for j in range(na):
    for i in range(nr):
        ids = " ".join(str(node[2 * i + di, 2 * j + dj][0]) for di, dj in around)
        lines.append(f"{50 + 3 * (j * nr + i)} 16 2 {1 + j // 4} {1 + j // 4} {ids}")
text = "\n".join(lines) + "\n$EndElements\n"
open(sys.argv[1] + "/ring.msh", "w").write(text)
wrong = text.replace(lines[-1], lines[-1].replace(lines[-1].split()[0] + " 16 2", "999 16 2").replace(lines[-1].split()[5], "1000"))
open(sys.argv[1] + "/wrong.msh", "w").write(wrong)
# One element with a node in its middle among the others, in the same surface; the last element drawn twice, with nodes of its own.
last = lines[-1].split()
middle = text.replace("$Nodes\n" + str(len(node)), "$Nodes\n" + str(len(node) + 1)).replace("$EndNodes", "9999 0.1 1.8 0\n$EndNodes")
mixed = middle.replace(lines[-1], " ".join([last[0], "10"] + last[2:5] + last[5:] + ["9999"]))
open(sys.argv[1] + "/mixed.msh", "w").write(mixed)
place = {id: (x, y) for id, x, y in node.values()}
copies = [f"{20000 + k} {place[int(id)][0]!r} {place[int(id)][1]!r} 0" for k, id in enumerate(last[5:])]
twice = text.replace("$Nodes\n" + str(len(node)), "$Nodes\n" + str(len(node) + 8)).replace("$EndNodes", "\n".join(copies) + "\n$EndNodes")
twice = twice.replace("$Elements\n" + str(nr * na), "$Elements\n" + str(nr * na + 1))
twice = twice.replace("$EndElements", " ".join(["800"] + last[1:5] + [str(20000 + k) for k in range(8)]) + "\n$EndElements")
open(sys.argv[1] + "/twice.msh", "w").write(twice)
PYTHON

missed=0
say() { if [ "$1" -eq 0 ]; then echo "passed  $2"; else missed=$((missed + 1)) && echo "MISSED  $2"; fi; }
cd / # mesh files are looked for beside the scene, not here
"$build/abut" check "$scratch/file.yaml" >"$scratch/check.log" 2>&1
if grep -q 'built without libgmsh' "$scratch/check.log"; then
    say 0 'this program was built without libgmsh, and says so'
    echo "libgmsh-dev was not there when this program was built"
    exit 77
fi
say "$(grep -c error "$scratch/check.log")" 'a mesh file is checked'
for name in patch file; do "$build/abut" run "$scratch/$name.yaml" --quiet -j 1 -o "$scratch/$name" || exit 1; done
python3 - "$scratch" <<'PYTHON'
import csv, sys

def tip(name):
    with open(f"{sys.argv[1]}/{name}/history.csv") as stream:
        return [float(row["tip"]) for row in csv.DictReader(line for line in stream if not line.startswith("#"))]

patch, file = tip("patch"), tip("file")
size = max(abs(u) for u in patch)
far = max(abs(a - b) for a, b in zip(patch, file)) / size
print(f"tip moves by {size:.4g} m; file and patch differ by {far:.1e} of it at most in {len(patch)} rows")
sys.exit(len(patch) != len(file) or size < 1e-3 or far > 1e-9)
PYTHON
say $? 'a ring from a file moves as the patch does'
"$build/abut" check "$scratch/wrong.yaml" >"$scratch/wrong.log" 2>&1
status=$?
[ $status -eq 2 ] && grep -q "wrong.yaml:9:11: error: body 'ring': .*999" "$scratch/wrong.log"
say $? 'a mesh that is wrong is refused by its place in the scene and its ids'
"$build/abut" check "$scratch/mixed.yaml" >"$scratch/mixed.log" 2>&1
status=$?
[ $status -eq 2 ] && grep -q "several types: 1 of Quadrilateral 9 (9 nodes): elements 119, 23 of Quadrilateral 8" "$scratch/mixed.log"
say $? 'an element of another order in the same surface is found, counted and named'
"$build/abut" check "$scratch/twice.yaml" >"$scratch/twice.log" 2>&1
status=$?
[ $status -eq 2 ] && grep -q "overlap in 1 pair, by 0.119222 m2 together: 119 and 800, say, share 100 %" "$scratch/twice.log"
say $? 'an element drawn twice is found'
[ $missed -eq 0 ] || cat "$scratch"/*.log
[ $missed -eq 0 ]
