"""The scenes of tests/bench/cost: one base scene, and the same with a feature written down but off, or on. Scenes are mappings, written as JSON, which is YAML."""
import copy
import json

HUGE = 100_000_000  # steps between rows of history.csv: none but the first and the last


def base(side, steps):
    """An elastic block of side x side cells, four points each, that flies, shakes and shears; nothing is written."""
    return {
        "abut": 1,
        "time": {"end": steps * 1e-3, "dt": 1e-3},
        "grid": {"from": [-8, -8], "to": [side + 24, 2 * side + 24], "cell": 1},
        "materials": {"rubber": {"model": "linear-elastic", "E": 1e8, "nu": 0.3, "density": 1000}},
        "bodies": {"block": block(side, 0, [f"5 + 0.5*sin(pi*x/{side})", f"3 + 0.5*cos(2*pi*x/{side})"])},
        "history": {"every": HUGE},
    }


def block(side, bottom, velocity):
    return {"method": "material-points", "material": "rubber", "shape": {"box": [[0, bottom], [side, bottom + side]]},
            "fill": {"rule": "regular", "per_cell": 4}, "basis": "gimp", "update": "musl", "velocity": velocity}


def elements(side, bottom, velocity):
    return {"method": "finite-elements", "material": "rubber", "velocity": velocity,
            "mesh": {"box": [[0, bottom], [side, bottom + side]], "elements": [side, side], "type": "q4"}}


def meshed(side, steps, kind="q4"):
    """One block of elements alone, in steps that all types bear."""
    scene = base(side, steps)
    scene["time"] = {"end": steps * 2e-4, "dt": 2e-4}
    scene["bodies"] = {"block": elements(side, 0, [f"0.5*sin(pi*x/{side})", f"0.5*cos(2*pi*x/{side})"])}
    return put(scene, "bodies.block.mesh.type", kind)


def two(side, steps, apart=0, first="points"):
    """Two blocks, the upper one coming down and along; `apart`: cells between them. No contact is asked for."""
    scene = base(side, steps)
    scene["grid"]["to"] = [side + 24, 2 * side + apart + 24]
    lower = block if first == "points" else elements
    scene["bodies"] = {"lower": lower(side, 0, [f"0.5*sin(pi*x/{side})", "0.5"]), "upper": block(side, side + apart, ["1", "-0.5"])}
    return scene


def staged(scene, **settings):
    """A copy with its time as the one stage."""
    scene = copy.deepcopy(scene)
    time = scene.pop("time")
    scene["stages"] = [{"name": "all", "duration": time["end"], "dt": time["dt"]} | settings]
    return scene


def bounded(scene, plugin, side="bottom", **settings):
    """A copy with one boundary plugin more, on a side of the block."""
    entry = {"on": "block", "where": {"side": side}, "boundary": plugin} | settings
    return put(scene, "boundaries", scene.get("boundaries", []) + [entry])


def put(scene, path, value):
    """A copy with one value changed or added: put(scene, "bodies.block.basis", "linear")."""
    scene = copy.deepcopy(scene)
    *way, last = path.split(".")
    place = scene
    for key in way:
        place = place.setdefault(key, {})
    place[last] = value
    return scene


def touching(scene, **settings):
    return put(scene, "contact", [{"bodies": ["lower", "upper"], "algorithm": "multi-velocity", "response": "frictionless"} | settings])


def pair(name, without, within):
    return name, without, within


def switched_off(side, steps):
    """(name, scene without the key, scene with the key that says no): the second must cost what the first does."""
    one, apart = base(side, steps), two(side, steps, 12)
    touch = touching(two(side, steps), response="coulomb", friction=0.3)
    contact = touch["contact"][0]
    segments = touching(two(side, steps), algorithm="point-to-segment", response="coulomb", friction=0.3)
    viscous = bounded(one, "viscous")
    return [
        pair("`gravity: [0, 0]`", one, put(one, "gravity", [0, 0])),
        pair("`damping: {local: 0}`", one, put(one, "damping", {"local": 0})),
        pair("`f_bar: false`", one, put(one, "bodies.block.f_bar", False)),
        pair("`transfer: {flip: 1}`", one, put(one, "bodies.block.transfer", {"flip": 1})),
        pair("`body_force: [0, 0]`", one, put(one, "bodies.block.body_force", [0, 0])),
        pair("`surface: domains`", one, put(one, "bodies.block.surface", "domains")),
        pair("all `sides: free`", one, put(one, "grid.sides", {"left": "free", "right": "free", "bottom": "free", "top": "free"})),
        pair("`watchdog: {stop: false}`", one, put(one, "watchdog", {"stop": False})),
        pair("`boundaries: []`", one, put(one, "boundaries", [])),
        pair("`stages`, one of them, in place of `time`", one, staged(one)),
        pair("`loads: []`", one, put(one, "loads", [])),
        pair("`contact: []`", one, put(one, "contact", [])),
        pair("`monitors: []`, `expect: []`", one, put(put(one, "monitors", []), "expect", [])),
        pair("`checked: false`", one, put(one, "checked", False)),
        pair("`space: plane-strain`", one, put(one, "space", "plane-strain")),
        pair("a `trade` block", one, put(one, "trade", {"tolerance": 0.01})),
        pair("an `extremes` block", one, put(one, "extremes", {"vary": [{"name": "E", "set": "materials.rubber.E", "from": 1e7, "to": 1e8}]})),
        pair("empty grid x 1000", one, put(one, "grid.to", [(side + 24) * 32, (2 * side + 24) * 32])),
        pair("a contact of bodies 12 cells apart", apart, touching(apart, response="coulomb", friction=0.3)),
        pair("a boundary with `at: points`, `hold: false`", viscous, bounded(one, "viscous", at="points", hold=False)),
        pair("a stage with `damping: {local: 0}`", staged(one), staged(one, damping={"local": 0})),
        pair("elements with `f_bar: false`, `fix: []`", meshed(side, steps), put(put(meshed(side, steps), "bodies.block.mesh.f_bar", False), "bodies.block.fix", [])),
        pair("point-to-segment with `touching: centre`, `passes: both`", segments, put(segments, "contact", [segments["contact"][0] | {"touching": "centre", "passes": "both"}])),
        pair("a contact with `adhesion: 0, shear_cap: 0, recovery: 0`", touch, put(touch, "contact", [contact | {"adhesion": 0, "shear_cap": 0, "recovery": 0}])),
    ]


def switched_on(side, steps):
    """(group, name, the scene it is compared with, the scene with it)."""
    one, touch, apart = base(side, steps), two(side, steps), two(side, steps, 12)
    body = "bodies.block."
    plastic = {"model": "von-mises", "E": 1e8, "nu": 0.3, "density": 1000}
    calm = put(one, "bodies.block.velocity", [0, 0])
    at_axis = put(one, "grid.from", [0, -8])
    soil = {"E": 1e8, "nu": 0.3, "density": 1000}
    clay = {"model": "modified-cam-clay", "kappa": 0.01, "lambda": 0.1, "M": 1, "nu": 0.3, "void_ratio": 1, "pressure": 1e5, "density": 1000}
    record = [[0, 0], [1, 0.1]]
    traction = {"body": "block", "where": {"side": "top"}, "traction": [0, "-1e4*min(t, 1)"]}
    stress = {"every": 1e-2, "fields": ["stress", "velocity"]}
    rows = [
        ("materials", "von Mises that stays elastic", one, put(one, "materials.rubber", plastic | {"yield": 1e30})),
        ("materials", "von Mises that yields everywhere", one, put(one, "materials.rubber", plastic | {"yield": 1})),
        ("materials", "neo-Hookean", one, put(one, "materials.rubber.model", "neo-hookean")),
        ("materials", "Tresca that yields everywhere", one, put(one, "materials.rubber", soil | {"model": "tresca", "cohesion": 1})),
        ("materials", "Mohr-Coulomb that yields everywhere", one, put(one, "materials.rubber", soil | {"model": "mohr-coulomb", "cohesion": 1, "friction": 0.5})),
        ("materials", "Drucker-Prager that yields everywhere", one, put(one, "materials.rubber", soil | {"model": "drucker-prager", "cohesion": 1, "friction": 0.5})),
        ("materials", "modified Cam clay under 100 kPa", one, put(put(one, "materials.rubber", clay), "bodies.block.initial", {"stress": [-1e5, -1e5, -1e5, 0]})),
        ("loads", "gravity", one, put(one, "gravity", [0, -9.81])),
        ("loads", "local damping", one, put(one, "damping", {"local": 0.1})),
        ("loads", "body force, a formula of t, x, y", one, put(one, "bodies.block.body_force", ["sin(x+t)", "cos(y)"])),
        ("loads", "traction on one side", one, put(one, "loads", [traction])),
        ("boundaries", "`viscous` on one side", one, bounded(one, "viscous")),
        ("boundaries", "`viscous`, `at: nodes`", one, bounded(one, "viscous", at="nodes")),
        ("boundaries", "`viscous` that holds the stress (`hold: true`)", bounded(one, "viscous"), bounded(one, "viscous", hold=True)),
        ("boundaries", "`viscoelastic` on one side", one, bounded(one, "viscoelastic", r_b=side)),
        ("boundaries", "`pressure` on one side", one, bounded(one, "pressure", "top", pressure=1e4)),
        ("boundaries", "`base-motion`, rigid, on one side", calm, bounded(calm, "base-motion", velocity=record)),
        ("boundaries", "and `free-field` on another", bounded(calm, "base-motion", velocity=record),
         bounded(bounded(calm, "base-motion", velocity=record), "free-field", "left", velocity=record, spacing=1)),
        ("boundaries", "`viscous` on one side of elements", meshed(side, steps), bounded(meshed(side, steps), "viscous")),
        ("stages", "local damping", staged(one), staged(one, damping={"local": 0.1})),
        ("stages", "kinetic damping", staged(one), staged(one, damping={"kinetic": True})),
        ("stages", "gravity that grows, looked at for rest (`until`)", staged(put(one, "gravity", [0, -9.81])),
         staged(put(one, "gravity", [0, -9.81]), gravity="ramp", until={"unbalanced_force": 1e-9, "missed": "warn"})),
        ("stages", "`initial: {stress: K0}`", put(one, "gravity", [0, -9.81]), put(put(one, "gravity", [0, -9.81]), "bodies.block.initial", {"stress": "K0"})),
        ("results", "a row of history at every step (the ledger added up)", one, put(one, "history", {"every": 1})),
        ("results", "and a monitor, over all points", put(one, "history", {"every": 1}),
         put(put(one, "history", {"every": 1}), "monitors", [{"name": "s", "body": "block", "value": "stress.yy", "over": "max"}])),
        ("results", "a frame with stress and velocity every 10 steps", one, put(one, "output", stress)),
        ("results", "a checkpoint every 10 steps", one, put(one, "checkpoint", {"steps": 10})),
        ("results", "`checked: true`", one, put(one, "checked", True)),
        ("space", "`space: axisymmetric`", at_axis, put(at_axis, "space", "axisymmetric")),
        ("points", "`f_bar: cell`", one, put(one, body + "f_bar", "cell")),
        ("points", "`f_bar: patch`", one, put(one, body + "f_bar", "patch")),
        ("points", "`basis: linear`", one, put(one, body + "basis", "linear")),
        ("points", "`basis: bspline2`", one, put(one, body + "basis", "bspline2")),
        ("points", "`basis: bspline3`", one, put(one, body + "basis", "bspline3")),
        ("points", "`basis: cpdi`", one, put(one, body + "basis", "cpdi")),
        ("points", "`update: usl`", one, put(one, body + "update", "usl")),
        ("points", "`update: usf`", one, put(one, body + "update", "usf")),
        ("points", "`update: usavg`", one, put(one, body + "update", "usavg")),
        ("points", "`transfer: {flip: 0.99}`", one, put(one, body + "transfer", {"flip": 0.99})),
        ("points", "`transfer: apic`", one, put(one, body + "transfer", "apic")),
        ("points", "`transfer: {xpic: 2}`", one, put(one, body + "transfer", {"xpic": 2})),
        ("points", "`transfer: {fmpm: 2}`", one, put(one, body + "transfer", {"fmpm": 2})),
        ("points", "`surface: points`, nothing that touches", one, put(one, body + "surface", "points")),
        ("elements", "q4 with `f_bar`", meshed(side, steps), put(meshed(side, steps), "bodies.block.mesh.f_bar", True)),
        ("elements", "q4r in place of q4", meshed(side, steps), meshed(side, steps, "q4r")),
        ("elements", "q6 in place of q4", meshed(side, steps), meshed(side, steps, "q6")),
        ("elements", "q8r in place of q4, as many elements", meshed(side, steps), meshed(side, steps, "q8r")),
        ("elements", "q8 in place of q4, as many elements", meshed(side, steps), meshed(side, steps, "q8")),
        ("bodies", "a second body of as many points, far away", one, apart),
        ("bodies", "a second body of as many q4 elements, far away", one, two(side, steps, 12, "elements")),
    ]
    names = "contact, one row of nodes as long as the block"
    frictionless, friction = touching(touch), touching(touch, response="coulomb", friction=0.3)
    rows += [
        (names, "that body comes near, no contact asked for", apart, touch),
        (names, "it touches, frictionless", touch, frictionless),
        (names, "and friction", frictionless, friction),
        (names, "and friction that remembers slip (`kinetic_friction`)", friction, touching(touch, response="coulomb", friction=0.3, kinetic_friction=0.2)),
        (names, "penalty in place of it", frictionless, touching(touch, response="penalty")),
        (names, "`surface: points` on both", friction, put(put(friction, "bodies.lower.surface", "points"), "bodies.upper.surface", "points")),
        (names, "the contact points in each tenth step's frame", put(friction, "output", stress), put(friction, "output", stress | {"contact": True})),
    ]
    segments = touching(touch, algorithm="point-to-segment", response="coulomb", friction=0.3)
    names = "points on points by point-to-segment"
    rows += [
        (names, "friction", touch, segments),
        (names, "`touching: outline` in place of `centre`", segments, touching(touch, algorithm="point-to-segment", response="coulomb", friction=0.3, touching="outline")),
        (names, "`passes: first` in place of `both`", segments, touching(touch, algorithm="point-to-segment", response="coulomb", friction=0.3, passes="first")),
    ]
    mixed = two(side, steps, 0, "elements")
    rows += [
        ("points on elements", "multi-velocity, friction", mixed, touching(mixed, response="coulomb", friction=0.3)),
        ("points on elements", "point-to-segment, friction", mixed, touching(mixed, algorithm="point-to-segment", response="coulomb", friction=0.3)),
    ]
    return rows


def write(scene, path):
    with open(path, "w") as stream:
        json.dump(scene, stream)
