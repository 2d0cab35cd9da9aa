"""A bolt and clamped parts between a rigid head and the ground: preload, external load, separation."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

BOLT, CLAMPED, PRELOAD, LENGTH, CONTACT = 100.0, 300.0, 10.0, 4.0, 3.0
YOUNG = 400.0
SHARE = BOLT / (BOLT + CLAMPED)
SEPARATION = PRELOAD / (1 - SHARE)


def run(shape, length=1.0, stress=1.0):
    dim = int(shape[0])
    m = Model(dim, length, stress)
    along = "xyz"[dim - 1]

    def block(name, x, y, cells):
        low, high = ([x[0], y[0]], [x[1], y[1]]) if dim == 2 else ([x[0], 0.0, y[0]], [x[1], 1.0, y[1]])
        body = m.box(name, shape, [1] * (dim - 1) + [cells], low, high)
        m.material(body, "stress" if dim == 2 else "3d", YOUNG, THICKNESS=length)
        return body

    bolt = block("Bolt", (0.0, 1.0), (0.0, LENGTH), 4)
    lower, upper = block("Lower", (2.0, 5.0), (0.0, CONTACT), 3), block("Upper", (2.0, 5.0), (CONTACT, LENGTH), 1)
    force = m.stress * m.length ** 2
    middle = [0.5, 1.9, 0.0] if dim == 2 else [0.5, 0.5, 1.9]
    m.process("bolt_pretension_process", {
        "model_part_name": "Structure.Bolt", "point": [c * length for c in middle], "normal": [float(c == along) for c in "xyz"],
        "force": f"{PRELOAD * force!r}*t", "interval": [0.0, 1.5]})
    everything = [i for body in (bolt, lower, upper) for i in body.nodes]
    m.fix(everything, x=0.0, **({"y": 0.0} if dim == 3 else {}))
    m.fix(bolt.side_nodes[along + "0"] + lower.side_nodes[along + "0"], **{along: 0.0})
    head = m.part(bolt.side_nodes[along + "1"] + upper.side_nodes[along + "1"])
    m.process("impose_rigid_movement_process", {"model_part_name": "Structure." + head, "master_variable_name": "DISPLACEMENT_" + along.upper()})
    load = f"{force!r}*(5.0 if t < 2.5 else ({SEPARATION - 1e-3!r} if t < 3.5 else 14.0))"
    m.process("distribute_load_on_surface_process", {
        "model_part_name": "Structure." + head, "load": [load if c == along else 0.0 for c in "xyz"], "interval": [1.5, "End"]}, "loads")
    m.interface((lower, along + "1"), (upper, along + "0"))
    s = solve(m, steps=4, end=4.0)
    ground = lower.side_nodes[along + "0"]
    of_bolt = lambda step: s.number("force of bolt Structure.Bolt", step) / force
    of_parts = lambda step: s.reaction(ground, step)[dim - 1] * m.force_scale / force
    return Outcome(s, {
        "shortening": s.number("shortening of bolt Structure.Bolt", 0) / length,
        "preload": of_bolt(0), "bolt under load": of_bolt(1), "parts under load": of_parts(1),
        "parts before separation": of_parts(2), "bolt after separation": of_bolt(3)})


CASE = Case(
    "Bolted joint", "VDI 2230; R. G. Budynas, J. K. Nisbett, Shigley's Mechanical Engineering Design, § 8-7", "ANALYTIC",
    "Bolt and clamped parts are springs of stiffness 100 and 300. The section of the bolt is shortened by F/100 + F/300 at the preload "
    "F = 10; at locked length a load P adds P/4 to the bolt and takes 3P/4 off the parts, which separate at P = 13.3333. Bars under "
    "axial load are exact in every element: 1e-8 of the iteration.",
    [Quantity("shortening", PRELOAD / BOLT + PRELOAD / CLAMPED, 1e-8, order=False), Quantity("preload", PRELOAD, 1e-8, order=False),
     Quantity("bolt under load", 11.25, 1e-8, order=False), Quantity("parts under load", 6.25, 1e-8, order=False),
     Quantity("parts before separation", 0.75e-3, 1e-7, scale=1.0, order=False), Quantity("bolt after separation", 14.0, 1e-8, order=False)],
    (1,), lambda mesh, **settings: run(**settings),
    variants={"hexahedra": {"shape": "3D8N"}, "hexahedra of second order": {"shape": "3D20N"}, "tetrahedra": {"shape": "3D4N"},
              "prisms": {"shape": "3D6N"}, "quadrilaterals": {"shape": "2D4N"}, "triangles": {"shape": "2D3N"},
              "millimetres": {"shape": "3D8N", "length": 1e3, "stress": 1e-6}},
    quick=["hexahedra", "quadrilaterals"])
