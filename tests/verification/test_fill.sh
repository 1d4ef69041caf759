#!/bin/bash
# cost: 10
# Fills that follow no lattice: columns under their own weight and bars that meet, of Voronoi cells with several seeds and of an uneven mesh in a file; what is wrong is
# refused by name; a long fill says how far it is and can be stopped. test_fill.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
here=$(dirname "$(realpath "$0")")
failed=0
fail() { echo "FAILED: $*"; failed=1; }
must() { # SCENE OPTIONS...
    "$build/abut" run "$@" --strict --quiet -j 1 -o "$scratch/out" >"$scratch/log" 2>&1 || { fail "$*"; cat "$scratch/log"; }
}
refused() { # TEXT SCENE OPTIONS...
    local text=$1
    shift
    "$build/abut" run "$@" --quiet -o "$scratch/none" >"$scratch/log" 2>&1
    [ $? = 2 ] || fail "exit of $*"
    grep -qF -- "$text" "$scratch/log" || { fail "$* does not say '$text'"; cat "$scratch/log"; }
}

column=$here/fill_cvt.yaml
for seed in 2 3; do must "$column" --set constants.seed=$seed; done
must "$column" --set constants.cells=20 --set constants.per_cell=9
must "$column" --set bodies.column.fill='{rule: cvt, points: 331, seed: 5}'
must "$here/impact.yaml" --set bodies.a.fill='{rule: cvt, per_cell: 4}' --set bodies.b.fill='{rule: cvt, per_cell: 4, seed: 2}'
must "$here/impact.yaml" --set bodies.a.fill='{rule: cvt, per_cell: 9}' --set constants.turned=1 \
    --set monitors[0].value=velocity.y --set monitors[1].value=velocity.y --set monitors[3].value=momentum.y

# The column in quadrilaterals whose inner nodes stand off their places by up to a quarter of an element; one file with an element folded.
/usr/bin/env python3 - "$scratch" <<'PYTHON' || exit 1
import random
import sys

random.seed(1)
nx, ny, width, height = 5, 10, 0.5, 1.0
x = {}
for j in range(ny + 1):
    for i in range(nx + 1):
        off = [random.uniform(-0.25, 0.25) if 0 < i < nx and 0 < j < ny else 0 for _ in range(2)]
        x[i, j] = ((i + off[0]) * width / nx, (j + off[1]) * height / ny)
number = {place: 10 + 3 * k for k, place in enumerate(x)}


def write(name, places):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(places))]
    lines += [f"{number[p]} {a!r} {b!r} 0" for p, (a, b) in places.items()]
    lines += ["$EndNodes", "$Elements", str(nx * ny)]
    for j in range(ny):
        for i in range(nx):
            corners = " ".join(str(number[p]) for p in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            lines.append(f"{1 + i + nx * j} 3 2 1 1 {corners}")
    with open(f"{sys.argv[1]}/{name}.msh", "w") as stream:
        stream.write("\n".join(lines + ["$EndElements"]) + "\n")


write("column", x)
write("folded", {**x, (2, 5): (0.45, 0.85)})
PYTHON
grep -v 'fill:' "$column" | sed 's/polygon: .*/mesh: {file: NAME.msh, type: q4}}/' >"$scratch/any.yaml"
for name in column folded; do sed "s/NAME/$name/" "$scratch/any.yaml" >"$scratch/$name.yaml"; done
mesh=$scratch/column.yaml
"$build/abut" check "$mesh" >"$scratch/log" 2>&1
if "$build/abut" run "$mesh" --quiet -o "$scratch/out" >"$scratch/log" 2>&1; then
    # two by two Gauss points in elements of a cell's size: 0.9 % on ten cells, as in a lattice (rule gauss), for their domains leave gaps; less with more of them
    must "$mesh" --set bodies.column.fill.per_cell=4 --set constants.allowed=1.2e-2
    must "$mesh" --set bodies.column.fill.per_cell=16
    refused "folded" "$scratch/folded.yaml"
    refused "lies partly outside the grid" "$mesh" --set grid.to='[0.4, 1.2]'
elif ! grep -q libgmsh "$scratch/log"; then
    fail "$mesh"
    cat "$scratch/log"
fi
box='{mesh: {box: [[0, 0], [0.5, 1]], elements: [10, 20], type: q4}}'
must "$column" --set constants.cells=20 --set bodies.column.shape="$box" --set bodies.column.fill='{rule: gauss, per_cell: 4}'
refused "a mesh is filled by the Gauss points of its elements; write gauss" "$column" --set bodies.column.shape="$box" --set bodies.column.fill='{rule: regular}'
refused "in each element of a mesh stand 1, 4, 9, 16" "$column" --set bodies.column.shape="$box" --set bodies.column.fill='{rule: gauss, per_cell: 6}'
refused "a mesh stands alone" "$column" --set bodies.column.shape="{union: [$box]}"
refused "holes stand beside a polygon" "$column" --set bodies.column.shape='{box: [[0, 0], [0.5, 1]], holes: [[[0.1, 0.1], [0.2, 0.1], [0.2, 0.2]]]}'
refused "more than the 1000000" "$column" --set bodies.column.fill='{rule: cvt, per_cell: 10000}' --set constants.cells=100
[ -e "$scratch/none" ] && fail "a refused scene has left results"

# The example of the page.
sed -n '/^```yaml$/,/^```$/{/^```/!p}' docs/fills.md >"$scratch/slope.yaml"
must "$scratch/slope.yaml"

# A fill that would take minutes.
long=(--set bodies.column.fill='{rule: cvt, points: 60000, tolerance: 1e-9}')
"$build/abut" run "$column" "${long[@]}" -j 1 -o "$scratch/none" >"$scratch/log" 2>&1 &
run=$!
for ((k = 0; k < 200; k++)); do grep -q "filling 'column'" "$scratch/log" && break; sleep 0.1; done
grep -q "filling 'column' with 60000 points: round" "$scratch/log" || { fail "a long fill says nothing"; cat "$scratch/log"; }
kill -TERM $run
wait $run
[ $? = 143 ] || fail "a fill that is stopped does not end with 143"
[ -e "$scratch/none" ] && fail "a fill that was stopped has left results"
exit $failed
