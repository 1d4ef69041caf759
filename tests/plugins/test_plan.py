"""The plan says what a scene needs, and what it does not need is not there. test_plan.py BUILD

One body: no contact pass, no contact plugin. An elastic body: no state arrays; a plastic one has them. No boundary plugin: no boundary pass. An empty
grid costs nothing: a box of 4000 m x 4000 m around a block takes what one of 8 m x 4 m takes, in the plan and in the process that runs it."""
import json
import os
import resource
import subprocess
import sys
import tempfile

abut = os.path.join(os.path.abspath(sys.argv[1]), "abut")
os.chdir(os.environ.get("ABUT_SCRATCH") or tempfile.mkdtemp())

SCENE = """
abut: 1
space: plane-strain
time: {end: 0.02, dt: 1e-4}
grid: {from: [0, 0], to: [8, 4], cell: 0.25}
materials:
  soil: {model: linear-elastic, E: 1 MPa, nu: 0.3, density: 1000}
bodies:
  block: {method: material-points, material: soil, shape: {box: [[2, 1], [4, 2]]}, fill: {rule: regular, per_cell: 4}, velocity: [0.1, 0]}
"""
SECOND = """
  other: {method: material-points, material: soil, shape: {box: [[5, 1], [7, 2]]}, fill: {rule: regular, per_cell: 4}}
contact:
  - {bodies: [block, other], algorithm: multi-velocity, response: coulomb, friction: 0.1}
"""


def write(name, text):
    with open(name, "w") as stream:
        stream.write(text)
    return name


def plan(name, *options):
    done = subprocess.run([abut, "plan", name, "--json", *options], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def peak_of_run(name, *options):
    """Bytes of the largest run so far of this process's children, and the processor seconds of this one."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([abut, "run", name, "--quiet", "-j", "1", *options], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open("results/" + name.removesuffix(".yaml") + "/summary.json") as stream:
        return json.load(stream)["peak_bytes"], after.ru_utime - before


one = write("one.yaml", SCENE)
two = write("two.yaml", SCENE + SECOND)

alone = plan(one)
assert [body["name"] for body in alone["bodies"]] == ["block"]
assert alone["points"] == alone["bodies"][0]["points"] == 4 * 8 * 4, alone["points"]
assert alone["cells"] == 8 * 4, alone["cells"]
assert alone["contact_passes"] == 0 and alone["contacts"] == [] and alone["boundary_passes"] == 0
assert [plugin["kind"] for plugin in alone["plugins"]] == ["material"], alone["plugins"]
assert any(line.startswith("contact:") for line in alone["not_paid_for"])
assert any(line.startswith("state:") for line in alone["not_paid_for"])
assert abs(alone["steps"] - 200) < 1 and alone["dt"] == 1e-4 and 0 < alone["critical_dt"] and alone["limit"]

# What is not on the plan is not opened either.
traced = subprocess.run([abut, "run", one, "--quiet", "-j", "1", "-o", "traced"], env={**os.environ, "LD_DEBUG": "files"}, capture_output=True, text=True)
assert "linear_elastic.so" in traced.stderr and "multi_velocity.so" not in traced.stderr and "coulomb.so" not in traced.stderr

together = plan(two)
assert together["contact_passes"] == 1 and len(together["contacts"]) == 1
assert sorted(plugin["name"] for plugin in together["plugins"]) == ["coulomb", "linear-elastic", "multi-velocity"]
assert all(plugin["for"] and os.path.isfile(plugin["file"]) for plugin in together["plugins"])
assert not any(line.startswith("contact:") for line in together["not_paid_for"])

plastic = plan(one, "--set", "materials.soil.model=von-mises", "--set", "materials.soil.yield=1e9")
extra = set(plastic["bodies"][0]["fields"]) - set(alone["bodies"][0]["fields"])
assert extra and not any(line.startswith("state:") for line in plastic["not_paid_for"]), extra
assert plastic["bodies"][0]["bytes_per_point"] > alone["bodies"][0]["bytes_per_point"]

# Transfers: a point carries an affine velocity, four numbers, only with apic and tpic; the filter of xpic and fmpm lies on the nodes, and there only from order 2 on.
flip = alone["bodies"][0]
for transfer in ("flip", "pic", "{flip: 0.9}", "{xpic: 1}", "{fmpm: 1}"):
    body = plan(one, "--set", f"bodies.block.transfer={transfer}")["bodies"][0]
    assert all(body[key] == flip[key] for key in ("fields", "passes", "bytes", "bytes_per_point")), (transfer, body)
for transfer in ("apic", "tpic"):
    body = plan(one, "--set", f"bodies.block.transfer={transfer}")["bodies"][0]
    assert set(body["fields"]) - set(flip["fields"]) == {"affine velocity"} and body["bytes_per_point"] == flip["bytes_per_point"] + 32, (transfer, body)
    assert body["passes"] == flip["passes"], (transfer, body)
for transfer in ("{xpic: 3}", "{fmpm: 3}"):
    body = plan(one, "--set", f"bodies.block.transfer={transfer}")["bodies"][0]
    assert body["fields"] == flip["fields"] and body["bytes_per_point"] == flip["bytes_per_point"] and body["bytes"] > flip["bytes"], (transfer, body)
    assert [p for p in body["passes"] if p not in flip["passes"]] == ["filter of velocities 2 times"], (transfer, body)

# Empty grid: at the corner of the box or in its middle, 16000 x 16000 cells cost what 32 x 16 cost.
wide = ["--set", "grid.from=[-1999,-1999]", "--set", "grid.to=[2001,2001]"]
big = plan(one, *wide)
assert big["bytes"] <= 1.05 * alone["bytes"] and big["tiles"] <= alone["tiles"] + 16, (big["bytes"], alone["bytes"])
small_peak, small_seconds = peak_of_run(one)
big_peak, big_seconds = peak_of_run(one, *wide)
print(f"peak memory {small_peak / 2**20:.1f} and {big_peak / 2**20:.1f} MiB, time {small_seconds:.3f} and {big_seconds:.3f} s in the small and the large box")
assert big_peak <= 1.1 * small_peak + 2**20
assert big_seconds <= 1.5 * small_seconds + 0.1

text = subprocess.run([abut, "plan", two], capture_output=True, text=True, check=True).stdout
for wanted in ("block", "other", "multi-velocity", "points", "steps", "Not paid for", "stable limit"):
    assert wanted in text, f"'{wanted}' is not in the plan:\n{text}"
assert not os.path.exists("results/two"), "a plan writes nothing"
print("the plan holds")

# Bodies of elements: nodes and elements in place of points, no grid where nothing looks at one, and no points inside elements without a contact that wants them.
BEAM = """
abut: 1
space: plane-strain
time: {end: 0.02, dt: 1e-5}
materials:
  steel: {model: linear-elastic, E: 1 MPa, nu: 0.3, density: 1000}
bodies:
  beam: {method: finite-elements, material: steel, mesh: {box: [[0, 0], [4, 1]], elements: [8, 2], type: q8}}
"""
REST = """
  stone: {method: rigid, shape: {box: [[1, 1], [2, 2]]}, motion: {mass: 10, inertia: 1}}
contact:
  - {bodies: [stone, beam], algorithm: point-to-segment, response: coulomb, friction: 0.1}
"""
SAND = """
  sand: {method: material-points, material: steel, shape: {box: [[1, 1], [2, 2]]}}
contact:
  - {bodies: [sand, beam], algorithm: multi-velocity, response: coulomb, friction: 0.1}
"""


def left_out(found, start):
    return [line for line in found["not_paid_for"] if line.startswith(start)]


beam = plan(write("beam.yaml", BEAM))
assert beam["bodies"][0]["nodes"] == 3 * 8 * 2 + 2 * (8 + 2) + 1 and beam["bodies"][0]["elements"] == 16, beam["bodies"]
assert "points" not in beam["bodies"][0] and beam["points"] == 0 and beam["elements"] == 16 and beam["nodes"] == beam["bodies"][0]["nodes"]
assert left_out(beam, "grid:") and left_out(beam, "points on the grid:") and left_out(beam, "contact:") and not left_out(beam, "empty grid:")

rest = plan(write("rest.yaml", BEAM + REST))
assert len(left_out(rest, "points on the grid:")) == 2 and left_out(rest, "grid:") and left_out(rest, "stress:"), rest["not_paid_for"]
assert rest["contacts"][0]["needs"] == ["points and faces of the outlines"] and rest["elements"] == 16 and rest["points"] == 0

sand = plan(write("sand.yaml", BEAM + SAND), "--set", "grid={from: [-1, -1], to: [5, 3], cell: 0.25}")
assert not left_out(sand, "grid:") and not left_out(sand, "points on the grid:") and left_out(sand, "outlines:"), sand["not_paid_for"]
assert sand["points"] > 0 and sand["elements"] == 16
assert "nodes of the grid that both have mass at" in sand["contacts"][0]["needs"]

text = subprocess.run([abut, "plan", "rest.yaml"], capture_output=True, text=True, check=True).stdout
for wanted in ("69 nodes in 16 elements", "points on the outline", "needs: points and faces of the outlines"):
    assert wanted in text, f"'{wanted}' is not in the plan:\n{text}"
print("the plan of bodies with elements holds")
