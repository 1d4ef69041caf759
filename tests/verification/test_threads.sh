#!/bin/bash
# cost: 20
# The same bits for any number of threads: the incline, shortened, on 1, 2, 3 and 5 threads; a ring with the transfers that have passes of their own,
# and with update usavg.
# test_threads.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
export OMP_WAIT_POLICY=passive # more threads than cores: waiting ones make room
for threads in 1 2 3 5; do
    "$build/abut" run cases/block_on_incline/scene.yaml --quiet -j $threads -o "$scratch/$threads" \
        --set time.end=0.06 --set constants.settle=0.02 --set output.every=0.02 --set history.every=1 --set grid.cell=0.125 --set expect=[]
done
python3 - "$scratch" <<'PYTHON'
import sys
import h5py

folder = sys.argv[1]


def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


first = datasets(f"{folder}/1/results.h5")
history = open(f"{folder}/1/history.csv", "rb").read()
assert len(first) > 3 and history.count(b"\n") > 100, "there is too little to compare"
for threads in (2, 3, 5):
    assert open(f"{folder}/{threads}/history.csv", "rb").read() == history, f"history.csv differs on {threads} threads"
    other = datasets(f"{folder}/{threads}/results.h5")
    assert other.keys() == first.keys(), f"other datasets on {threads} threads"
    for name, values in first.items():
        assert values.tobytes() == other[name].tobytes(), f"{name} differs on {threads} threads"
print(f"{len(first)} datasets and history.csv are the same on 1, 2, 3 and 5 threads")
PYTHON
for setting in transfer=apic 'transfer={xpic: 3}' update=usavg; do
    for threads in 1 2 3 5; do
        "$build/abut" run tests/verification/ring.yaml --quiet -j $threads -o "$scratch/ring$threads" --set bodies.ring."$setting" \
            --set constants.cells=24 --set time.end=0.005 --set history.every=1 --set expect=[] 2>/dev/null
    done
    for threads in 2 3 5; do
        cmp "$scratch/ring1/history.csv" "$scratch/ring$threads/history.csv" || { echo "$setting differs on $threads threads" >&2 && exit 1; }
    done
done
echo "apic, xpic and usavg give the same history.csv on 1, 2, 3 and 5 threads"
