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


def two(side, steps, apart=0, first="points"):
    """Two blocks, the upper one coming down and along; `apart`: cells between them. No contact is asked for."""
    scene = base(side, steps)
    scene["grid"]["to"] = [side + 24, 2 * side + apart + 24]
    lower = block if first == "points" else elements
    scene["bodies"] = {"lower": lower(side, 0, [f"0.5*sin(pi*x/{side})", "0.5"]), "upper": block(side, side + apart, ["1", "-0.5"])}
    return scene


def staged(scene):
    """A copy with its time as the one stage."""
    scene = copy.deepcopy(scene)
    time = scene.pop("time")
    scene["stages"] = [{"name": "all", "duration": time["end"], "dt": time["dt"]}]
    return scene


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
        pair("a `trade` block", one, put(one, "trade", {"tolerance": 0.01})),
        pair("empty grid x 1000", one, put(one, "grid.to", [(side + 24) * 32, (2 * side + 24) * 32])),
        pair("a contact of bodies 12 cells apart", apart, touching(apart, response="coulomb", friction=0.3)),
        pair("a contact with `adhesion: 0, shear_cap: 0, recovery: 0`", touch, put(touch, "contact", [contact | {"adhesion": 0, "shear_cap": 0, "recovery": 0}])),
    ]


def switched_on(side, steps):
    """(group, name, the scene it is compared with, the scene with it)."""
    one, touch, apart = base(side, steps), two(side, steps), two(side, steps, 12)
    body = "bodies.block."
    plastic = {"model": "von-mises", "E": 1e8, "nu": 0.3, "density": 1000}
    traction = {"body": "block", "where": {"side": "top"}, "traction": [0, "-1e4*min(t, 1)"]}
    stress = {"every": 1e-2, "fields": ["stress", "velocity"]}
    rows = [
        ("materials", "von Mises that stays elastic", one, put(one, "materials.rubber", plastic | {"yield": 1e30})),
        ("materials", "von Mises that yields everywhere", one, put(one, "materials.rubber", plastic | {"yield": 1})),
        ("materials", "neo-Hookean", one, put(one, "materials.rubber.model", "neo-hookean")),
        ("loads", "gravity", one, put(one, "gravity", [0, -9.81])),
        ("loads", "local damping", one, put(one, "damping", {"local": 0.1})),
        ("loads", "body force, a formula of t, x, y", one, put(one, "bodies.block.body_force", ["sin(x+t)", "cos(y)"])),
        ("loads", "a viscous boundary on one side", one, put(one, "boundaries", [{"on": "block", "where": {"side": "bottom"}, "boundary": "viscous"}])),
        ("loads", "traction on one side", one, put(one, "loads", [traction])),
        ("results", "a row of history at every step (the ledger added up)", one, put(one, "history", {"every": 1})),
        ("results", "and a monitor, over all points", put(one, "history", {"every": 1}),
         put(put(one, "history", {"every": 1}), "monitors", [{"name": "s", "body": "block", "value": "stress.yy", "over": "max"}])),
        ("results", "a frame with stress and velocity every 10 steps", one, put(one, "output", stress)),
        ("points", "`f_bar: cell`", one, put(one, body + "f_bar", "cell")),
        ("points", "`f_bar: patch`", one, put(one, body + "f_bar", "patch")),
        ("points", "`basis: linear`", one, put(one, body + "basis", "linear")),
        ("points", "`basis: bspline2`", one, put(one, body + "basis", "bspline2")),
        ("points", "`basis: bspline3`", one, put(one, body + "basis", "bspline3")),
        ("points", "`basis: cpdi`", one, put(one, body + "basis", "cpdi")),
        ("points", "`update: usl`", one, put(one, body + "update", "usl")),
        ("points", "`update: usf`", one, put(one, body + "update", "usf")),
        ("points", "`update: usavg`", one, put(one, body + "update", "usavg")),
        ("points", "`transfer: apic`", one, put(one, body + "transfer", "apic")),
        ("points", "`transfer: {xpic: 2}`", one, put(one, body + "transfer", {"xpic": 2})),
        ("points", "`transfer: {fmpm: 2}`", one, put(one, body + "transfer", {"fmpm": 2})),
        ("points", "`surface: points`, nothing that touches", one, put(one, body + "surface", "points")),
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
    mixed = two(side, steps, 0, "elements")
    rows += [
        ("points on elements", "multi-velocity, friction", mixed, touching(mixed, response="coulomb", friction=0.3)),
        ("points on elements", "point-to-segment, friction", mixed, touching(mixed, algorithm="point-to-segment", response="coulomb", friction=0.3)),
    ]
    return rows


def write(scene, path):
    with open(path, "w") as stream:
        json.dump(scene, stream)
