#!/bin/bash
# cost: 4
# Where a run writes and whose code it runs. A full disk, a folder that is read only or vanishes: an error with file and cause, and frames that can be read. Nothing is written outside
# of the folder of the results; no plugin is loaded that another user could have changed; nothing starts a shell. test_places.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
gravity: [0, -9.81]
time: {end: 1000, dt: 1e-4}
grid: {from: [-8, -100], to: [8, 8], cell: 0.25}
materials:
  rubber: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  block: {method: material-points, material: rubber, shape: {box: [[-4, -4], [0, 4]]}}
history: {every: 1}
output: {every: 1e-3, fields: [stress, velocity]}
checkpoint: {steps: 10}
SCENE
run() { "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 "$@"; }
readable() { /usr/bin/python3 tests/verification/check_results.py "$1" --partial >"$scratch/readable.log" 2>&1 || say "$2: the frames before cannot be read" "$scratch/readable.log"; }

# A disk of 2 MB that fills up. Where no such disk may be made, the limit on the size of a file (test_signals.sh) stands for it.
out=$scratch/small
mkdir "$out"
cat >"$scratch/on_small_disk.sh" <<'SCRIPT'
mount -t tmpfs -o size=2m none "$1" || exit 77
shift
"$@"
status=$?
cp -r "$out" "$out.kept"
exit $status
SCRIPT
out=$out unshare -rm bash "$scratch/on_small_disk.sh" "$out" "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out/run" >"$scratch/full.log" 2>&1
status=$?
if [ $status -eq 1 ] && [ -d "$out.kept" ]; then
    grep -qE "^error: cannot write (checkpoint )?'$out/run/.*No space left on device" "$scratch/full.log" || say "a full disk: not said which file" "$scratch/full.log"
    readable "$out.kept/run" "a full disk"
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out.kept/run" --restart "$out.kept/run/checkpoint.abut" --set time.end=0.03 >"$scratch/full.log" 2>&1 ||
        say "a full disk: no restart with more room: exit $?" "$scratch/full.log"
elif ! grep -qE "unshare|mount" "$scratch/full.log"; then
    say "a full disk: exit $status" "$scratch/full.log"
fi

# The folder vanishes while the run goes on: with frames, and without any.
for more in output.every=1e-3 checkpoint.steps=100000000; do
    out=$scratch/vanishing
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" --set "$more" $([ $more = output.every=1e-3 ] || echo --set output.every=1000) >"$scratch/vanished.log" 2>&1 &
    process=$!
    for _ in $(seq 200); do [ "$(stat -c %s "$out/history.csv" 2>/dev/null || echo 0)" -gt 0 ] && break; sleep 0.02; done
    until rm -rf "$out" 2>/dev/null; do sleep 0.01; done # a frame may come in between
    wait $process
    status=$?
    [ $status -eq 1 ] && grep -qE "^error: cannot write (checkpoint )?'$out/(frames/frame_|history.csv|checkpoint.abut|results)" "$scratch/vanished.log" ||
        say "a folder that vanishes ($more): exit $status" "$scratch/vanished.log"
    rm -rf "$out"
done

# A place where nothing may be written (root may write anywhere but to a system's own files).
run -o /proc/abut --set time.end=1e-3 >"$scratch/read_only.log" 2>&1
[ $? -eq 1 ] && grep -q "cannot make the folder '/proc/abut'.*name another with -o" "$scratch/read_only.log" || say "a read-only place" "$scratch/read_only.log"

# Two runs in one folder.
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/busy" >"$scratch/busy.log" 2>&1 &
process=$!
for _ in $(seq 200); do [ -f "$scratch/busy/checkpoint.abut" ] && break; sleep 0.02; done
run -o "$scratch/busy" --set time.end=1e-3 >"$scratch/second.log" 2>&1
[ $? -eq 1 ] && grep -q "another run is writing its results into '$scratch/busy'" "$scratch/second.log" || say "a second run in the folder of one that goes on is not refused" "$scratch/second.log"
run -o "$scratch/busy" --restart "$scratch/busy/checkpoint.abut" --set time.end=1 >"$scratch/second.log" 2>&1
[ $? -eq 1 ] && grep -q "another run is writing" "$scratch/second.log" || say "a restart in the folder of a run that goes on is not refused" "$scratch/second.log"
kill -9 $process
wait $process 2>/dev/null

# Names from the scene become names of files: none may lead elsewhere.
for name in ../out /tmp/out a/b ..; do
    sed "s|^  block:|  \"$name\":|" "$scratch/scene.yaml" >"$scratch/named.yaml"
    "$build/abut" check "$scratch/named.yaml" >"$scratch/named.log" 2>&1
    [ $? -eq 2 ] && grep -q "cannot be the name of a body" "$scratch/named.log" || say "a body named '$name' is not refused" "$scratch/named.log"
    "$build/abut" check "$scratch/scene.yaml" --set "monitors=[{name: \"$name\", body: block, value: mass}]" >"$scratch/named.log" 2>&1
    [ $? -eq 2 ] && grep -q "cannot be the name of a monitor" "$scratch/named.log" || say "a monitor named '$name' is not refused" "$scratch/named.log"
done
before=$(cd "$scratch" && find . | sort)
run -o "$scratch/inside" --set time.end=0.003 || say "a short run: exit $?"
after=$(cd "$scratch" && find . | grep -v "^./inside" | sort)
[ "$before" = "$after" ] || say "a run has written beside its folder: $(diff <(echo "$before") <(echo "$after"))"

# A plugin that another user could change is not loaded: the file, its folder, a folder above it. Forced, it is.
mkdir -p "$scratch/above/plugins"
sed 's/linear-elastic/linear-elastiq/g' "$build/plugins/material/linear_elastic.so" >"$scratch/above/plugins/linear_elastiq.so" # the same law by another name
sed 's/linear-elastic/linear-elastiq/' "$scratch/scene.yaml" >"$scratch/own.yaml"
load() { "$build/abut" check "$scratch/own.yaml" --plugin-path "$scratch/above/plugins" "$@" >"$scratch/load.log" 2>&1; }
load || say "a plugin of one's own is refused" "$scratch/load.log"
for place in above/plugins/linear_elastiq.so above/plugins above; do
    chmod o+w "$scratch/$place"
    load
    [ $? -eq 2 ] && grep -q "may be changed by anybody: the f[a-z]* '$scratch/$place'.*--force-plugins" "$scratch/load.log" || say "$place can be written to by all, and the plugin is loaded" "$scratch/load.log"
    load --force-plugins || say "$place: the plugin is refused though it is forced" "$scratch/load.log"
    chmod o-w "$scratch/$place"
done
if [ "$(id -u)" -eq 0 ]; then
    chown 12345 "$scratch/above/plugins/linear_elastiq.so"
    load
    [ $? -eq 2 ] && grep -q "belongs to user 12345" "$scratch/load.log" || say "a plugin that belongs to another user is loaded" "$scratch/load.log"
    chown 0:12345 "$scratch/above/plugins/linear_elastiq.so"
    chmod g+w "$scratch/above/plugins/linear_elastiq.so"
    load
    [ $? -eq 2 ] && grep -q "can be written to by the group 12345" "$scratch/load.log" || say "a plugin that a group can write to is loaded" "$scratch/load.log"
fi

# A script of Gmsh, which may run commands, is no mesh, whatever its name.
for head in '' '$MeshFormat
4.1 0 8
$EndMeshFormat'; do
    printf '%s\nSystemCall "touch %s/pwned";\nPoint(1) = {0, 0, 0, 1};\n' "$head" "$scratch" >"$scratch/beam.msh"
    "$build/abut" check "$scratch/scene.yaml" --set 'bodies={beam: {method: finite-elements, material: rubber, mesh: {file: beam.msh, type: q4}}}' >"$scratch/mesh.log" 2>&1
    "$build/abut" plan "$scratch/scene.yaml" --set 'bodies={beam: {method: finite-elements, material: rubber, mesh: {file: beam.msh, type: q4}}}' >"$scratch/mesh.log" 2>&1
    [ $? -eq 2 ] && grep -q "^error: \|error: body 'beam'" "$scratch/mesh.log" || say "a script of Gmsh is taken for a mesh" "$scratch/mesh.log"
    [ ! -e "$scratch/pwned" ] || say "a script of Gmsh has run a command"
done

# No shell: nothing calls one, and a scene's texts reach no command line.
found=$(grep -nE '\b(system|popen|execl|execlp|execvp|wordexp|posix_spawnp?)[[:space:]]*\(' core/*.[ch] mpm/*.[ch] fem/*.[ch] contact/*.[ch] plugins/*/*.[ch] plugins/*.h)
[ -z "$found" ] || say "something may start a shell: $found"
exit $wrong
