#!/bin/bash
# cases/draw: a picture of points, elements and rigid bodies; a field, a component, results that are not there are told. slow_figures.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cases=$here/../../cases
/usr/bin/python3 -c "import matplotlib, h5py" 2>/dev/null || { echo "python3-matplotlib is not there"; exit 77; }
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
. "$here/must.bash"
must "a run" "$build/abut" run "$cases/smooth_wall/scene.yaml" --quiet -o sand --set 'output={every: 1e6, fields: [velocity, volume]}'
must "points and a rigid body" says 0 "velocity.x from .* at t = 0.8 s" "$cases/draw" sand velocity.x -o points.png
must "a run of elements" "$build/abut" run "$cases/slope/scene.yaml" --quiet -o slope --set constants.rows=4 --set 'output={every: 1e6, fields: [plastic_strain, displacement]}'
must "elements, deformed" says 0 "plastic_strain from .* at t =" "$cases/draw" slope plastic_strain --deformed 100 -o elements.png
must "pictures" /usr/bin/python3 -c "
from matplotlib import image
for name in 'points', 'elements':
    picture = image.imread(name + '.png')
    colours = {tuple(c) for row in picture[::3, ::3] for c in row.round(2)}
    assert picture.shape[1] > 400 and len(colours) > 20, (name, picture.shape, len(colours))"
must "a field that is not there" says 1 "no body has the field 'stress'; fields of the last body: body, id" "$cases/draw" sand stress
must "a component that is not there" says 1 "'velocity' has the components x, y, z, not 'w'" "$cases/draw" sand velocity.w
must "a folder without results" says 1 "there is no none/results.h5; run the scene with .output:" "$cases/draw" none velocity
[ "$missed" -eq 0 ]
