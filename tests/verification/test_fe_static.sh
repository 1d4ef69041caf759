#!/bin/bash
# cost: 25
# Statics of finite elements by a slow load and damping, element type by element type: cantilever, Cook's membrane, thick tube, Hill's tube and its limit pressure, self-weight
# of elements and of points. Prints value, reference and error of each; what locks is shown to lock. test_fe_static.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
export OMP_WAIT_POLICY=passive

cat >row.py <<'PYTHON'
"""row.py LABEL EXPECT=LIMIT..: value, reference, error of these expects of out/summary.json; "EXPECT>LIMIT": an error larger than that, because it locks."""
import json, re, sys

expects = {e["name"]: e for e in json.load(open("out/summary.json"))["expects"]}
missed = 0
for argument in sys.argv[2:]:
    name, sign, limit = re.fullmatch("(.*)([=>])(.*)", argument).groups()
    e, limit = expects[name], float(limit)
    good = e["error"] is not None and (e["error"] <= limit if sign == "=" else e["error"] > limit)
    print(f"{sys.argv[1]:40} {name:24} {e['value']:13.6e} {e['reference']:13.6e} {e['error']:9.2e} {'<=' if sign == '=' else '> '} {limit:.0e}{'' if good else '  MISSED'}")
    missed += not good
sys.exit(missed > 0)
PYTHON
row() { # label, scene, options -- limits
    local label="$2: $1" scene=$2 options=()
    shift 2
    while [ "$1" != -- ]; do options+=(--set "$1"); shift; done
    "$build/abut" run "$here/$scene.yaml" --quiet -j 1 -o out "${options[@]}"
    python3 row.py "$label" "${@:2}" || missed=$((missed + 1))
}
missed=0
printf '%-40s %-24s %13s %13s %9s\n' scene expect value reference error

# Cantilever, 16 x 4 elements: linear shapes without modes of bending are too stiff.
beam=bodies.beam.mesh
row "q4" fe_cantilever $beam.type=q4 -- tip=6e-2 'at rest=1e-6'
row "q4, 32 x 8" fe_cantilever $beam.type=q4 constants.nx=32 constants.ny=8 -- tip=1.5e-2
row "q4r" fe_cantilever $beam.type=q4r -- tip=1e-3 'at rest=1e-6'
row "q6" fe_cantilever $beam.type=q6 -- tip=1e-3 'at rest=1e-6'
row "q8, 8 x 2" fe_cantilever $beam.type=q8 constants.nx=8 constants.ny=2 -- tip=1e-3
row "q8r" fe_cantilever $beam.type=q8r -- tip=1e-3 'strain energy=1e-3' 'at rest=1e-6'
row "q8r, 8 x 2" fe_cantilever $beam.type=q8r constants.nx=8 constants.ny=2 -- tip=1e-3

# Cook's membrane, nu = 1/3; and 0.4999, where q4 locks and its mean dilatation does not (1 % with 64 x 64, test_elements_static).
panel=bodies.panel.mesh
row "q4" fe_cook $panel.type=q4 -- 'middle of the right side=4e-2' reaction=1e-3
row "q4r" fe_cook $panel.type=q4r -- 'middle of the right side=2e-2' reaction=1e-3
row "q8r, 8 x 8" fe_cook $panel.type=q8r constants.n=8 -- 'middle of the right side=1e-2' reaction=1e-3
soft=(materials.m.nu=0.4999 constants.n=8 constants.small=1e-4 constants.ramp=1500 'expect[0].reference=18.512*small')
row "q4, nu .4999, 8 x 8" fe_cook $panel.type=q4 "${soft[@]}" -- 'middle of the right side>0.5'
row "q4 f_bar, nu .4999, 8 x 8" fe_cook $panel.type=q4 $panel.f_bar=true "${soft[@]}" -- 'middle of the right side=5e-2'

# Thick tube, nu = 0.3 and 0.4999.
tube=bodies.tube.mesh
for type in q4 q4r q6; do
    row "$type, 16 x 32" fe_tube $tube.type=$type constants.n=16 -- 'u at a=1e-3' 'u at b=1e-3' 'at rest=1e-6'
done
row "q8r" fe_tube $tube.type=q8r -- 'u at a=2e-4' 'u at b=2e-4' 'at rest=1e-6'
nu=constants.nu=0.4999
row "q4, nu .4999, 4 x 8" fe_tube $tube.type=q4 constants.n=4 $nu -- 'u at a>0.5' 'the halves hold together=1e-3'
row "q4 f_bar, nu .4999, 8 x 16" fe_tube $tube.type=q4 $tube.f_bar=true $nu -- 'u at a=3e-3' 'u at b=3e-3'
row "q6, nu .4999, 4 x 8" fe_tube $tube.type=q6 constants.n=4 $nu -- 'u at a=2e-2' 'u at b=2e-2'
row "q8r, nu .4999, 4 x 8" fe_tube $tube.type=q8r constants.n=4 $nu damping.local=0.2 -- 'u at a=2e-3' 'u at b=2e-3'

# Hill's tube: von Mises' own axial stress, by radial elements with the return of Newton's method.
cat >radial.py <<'PYTHON'
import numpy as np

a, b, E, nu, sy, n = 0.1, 0.2, 210e9, 0.3, 240e6, 300
r = np.linspace(a, b, n + 1)
h, m = r[1] - r[0], 0.5 * (r[1:] + r[:-1])
G, K = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
u, plastic, before = np.zeros(n + 1), np.zeros((n, 3)), 0.0
for p in (120e6, 140e6, 160e6, 190e6):
    for part in np.linspace(0, 1, 41)[1:]:
        load = before + part * (p - before)
        while True:
            strain = np.stack([np.diff(u) / h, 0.5 * (u[1:] + u[:-1]) / m, 0 * m], 1) - plastic
            s = 2 * G * (strain - strain.mean(1, keepdims=True))
            q = np.maximum(np.sqrt(1.5 * (s**2).sum(1)), 1.0)
            flow = np.maximum(0, (q - sy) / (3 * G))
            along = 1.5 * s / q[:, None]
            stress = K * strain.sum(1, keepdims=True) + s - 2 * G * flow[:, None] * along
            D = K + (2 * G * (1 - 3 * G * flow / q))[:, None, None] * (np.eye(3) - 1 / 3)
            D = D - ((flow > 0) * 4 * G * G * (1 / (3 * G) - flow / q))[:, None, None] * along[:, :, None] * along[:, None, :]
            B = np.zeros((n, 3, 2))
            B[:, 0] = -1 / h, 1 / h
            B[:, 1] = (0.5 / m)[:, None]
            force, stiffness = np.zeros(n + 1), np.zeros((n + 1, n + 1))
            force[0] = load * a
            inner = np.einsum("ecj,ec,e->ej", B, stress, m * h)
            k = np.einsum("eci,ecd,edj,e->eij", B, D, B, m * h)
            e = np.arange(n)
            for i in range(2):
                np.add.at(force, e + i, -inner[:, i])
                for j in range(2):
                    np.add.at(stiffness, (e + i, e + j), k[:, i, j])
            if np.abs(force).max() < 1e-9 * load * a:
                break
            u = u + np.linalg.solve(stiffness, force)
        plastic = plastic + flow[:, None] * along
    before = p
    print(f"{u[-1]:.9e}")
PYTHON
mapfile -t exact < <(python3 radial.py)
echo "radial elements: u at b = ${exact[*]} m at 120, 140, 160, 190 MPa"
hill=(constants.u1="${exact[0]}*small" constants.u2="${exact[1]}*small" constants.u3="${exact[2]}*small")
von_mises=('von Mises at 120 MPa=3e-3' 'von Mises at 140 MPa=3e-3' 'von Mises at 160 MPa=3e-3' 'Hill at 160 MPa=4e-3' 'at rest=1e-6')
row "q8r" fe_hill "${hill[@]}" -- "${von_mises[@]}"
row "q4 f_bar, 16 x 16" fe_hill $tube.type=q4 $tube.f_bar=true constants.n=16 "${hill[@]}" -- "${von_mises[@]}"
row "q4r, 16 x 16" fe_hill $tube.type=q4r constants.n=16 "${hill[@]}" -- "${von_mises[@]}"
row "q6, 16 x 16" fe_hill $tube.type=q6 constants.n=16 "${hill[@]}" -- "${von_mises[@]}"
# It holds 190 MPa and flows without end at 194: the limit is 2/sqrt(3) 240 MPa ln 2 = 192.09 MPa.
row "190 MPa" fe_hill constants.p3=190e6 constants.n=8 constants.u3="${exact[3]}*small" -- 'on the other axis=1e-1' 'at rest=1e-6'
row "194 MPa" fe_hill constants.p3=194e6 constants.n=8 constants.u3="${exact[3]}*small" -- 'on the other axis>5' 'at rest>1e-4'

# A soft column under its own weight.
neo=(materials.soft.model=neo-hookean constants.neo=1)
whole=('settlement=1e-3' 'stress half-way=1e-2' 'strain energy=1e-3' 'at rest=1e-5')
for type in q4 q4r q8 q8r; do row "$type, neo-Hooke" fe_self_weight bodies.column.mesh.type=$type "${neo[@]}" -- "${whole[@]}"; done
row "q4r" fe_self_weight bodies.column.mesh.type=q4r -- "${whole[@]}"
row "neo-Hooke" self_weight "${neo[@]}" -- "${whole[@]}"
row "neo-Hooke, two cells wide" self_weight "${neo[@]}" constants.width=2*h -- "${whole[@]}"
row "cells of 0.5 m" self_weight constants.cells=100 -- "${whole[@]}"

[ "$missed" -eq 0 ] || { echo "$missed runs with misses"; exit 1; }
