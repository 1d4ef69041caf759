# checkpoints.bash: sourced by the tests of checkpoints. $build is the build folder, $scratch a folder of one's own, $wrong becomes 1.
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }

# same NAME A B: two folders of results hold the same bits: every row of history.csv, every dataset of results.h5, what the xdmf and the summary say of them.
same() {
    cmp -s "$2/history.csv" "$3/history.csv" || say "$1: history.csv differs: $(cmp "$2/history.csv" "$3/history.csv" 2>&1)"
    /usr/bin/python3 - "$2" "$3" >"$scratch/same.log" 2>&1 <<'PYTHON' || say "$1: the results differ" "$scratch/same.log"
import glob, json, os, sys
import h5py
def values(path):
    found = {}
    def visit(group, name):
        found.update({name + "@" + k: v for k, v in ((k, str(group.attrs[k])) for k in group.attrs)})
        for key in group:
            item = group[key]
            visit(item, name + "/" + key) if isinstance(item, h5py.Group) else found.update({name + "/" + key: (item.shape, item[...].tobytes())})
    if os.path.exists(path):
        visit(h5py.File(path, "r"), "")
    return found
a, b = (values(d + "/results.h5") for d in sys.argv[1:])
different = sorted(k for k in set(a) | set(b) if a.get(k) != b.get(k))
names = [{os.path.basename(f): open(f).read() for f in glob.glob(d + "/*.xdmf")} for d in sys.argv[1:]]
different += sorted(k for k in set(names[0]) | set(names[1]) if names[0].get(k) != names[1].get(k))
summary = [json.load(open(d + "/summary.json")) for d in sys.argv[1:]]
different += [k for k in ("time", "steps", "frames", "ledger", "motion", "contacts", "expects", "columns", "outcome") if summary[0][k] != summary[1][k]]
print(len(different), "differ:", different[:8])
sys.exit(1 if different else 0)
PYTHON
}
