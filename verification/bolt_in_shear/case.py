"""Two plates that a bolt with clearance clamps: they slip under shear until the bolt bears."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, FRICTION, PRELOAD, CLEARANCE, SIDE, HOLE, THICK = 1e5, 0.3, 1000.0, 0.05, 30.0, 10.0, 8.0
HALF = 0.5 * HOLE
SLIP = [0.5 * CLEARANCE, 0.9 * CLEARANCE, 1.6 * CLEARANCE]


def run(n, family="ALM frictional", length=1.0, stress=1.0, along=(1.0, 0.0)):
    m = Model(3, length, stress)
    low, high = -0.5 * SIDE, 0.5 * SIDE

    def plate(name, z):
        """Eight blocks about a square hole, with common nodes."""
        cuts = [(low, -HALF), (-HALF, HALF), (HALF, high)]
        known, cells = {}, []
        grid = [low + (-HALF - low) * i / n for i in range(n)] + [-HALF + HOLE * i / n for i in range(n)] + [HALF + (high - HALF) * i / n for i in range(n + 1)]
        def node(i, j, k):
            if (i, j, k) not in known:
                known[i, j, k] = m.mesh.add_node((grid[i], grid[j], z + THICK * k / 2))
            return known[i, j, k]
        for k in range(2):
            for j in range(3 * n):
                for i in range(3 * n):
                    if not (n <= i < 2 * n and n <= j < 2 * n):
                        ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                        cells.append(((i, j, k), tuple(node(*c, k) for c in ring) + tuple(node(*c, k + 1) for c in ring)))
        elements = [m.mesh.add_element("SmallDisplacementElement3D8N", nodes) for _, nodes in cells]
        m.mesh.part(name, sorted(known.values()), elements)
        return known, {at: nodes for at, nodes in cells}

    lower, of_lower = plate("Lower", 0.0)
    upper, of_upper = plate("Upper", THICK)
    width = HALF - CLEARANCE
    bolt = m.box("Bolt", "3D8N", [n, n, 8], [-width, -width, 0.0], [width, width, 2 * THICK])
    m.bodies.append(bolt)
    for name in ("Lower", "Upper", "Bolt"):
        m.materials.append({"model_part_name": "Structure." + name, "properties_id": len(m.materials) + 1, "Material": {
            "constitutive_law": {"name": "LinearElastic3DLaw"}, "Variables": {"YOUNG_MODULUS": YOUNG * stress, "POISSON_RATIO": 0.3}, "Tables": {}}})
    side = lambda cells, k, face: [m.mesh.add_condition("SurfaceCondition3D4N", tuple(nodes[i] for i in face)) for (_, _, layer), nodes in cells.items() if layer == k]
    # the plates in contact, and the bolt in its hole
    m.between(side(of_upper, 0, (0, 3, 2, 1)), side(of_lower, 1, (4, 5, 6, 7)))
    walls = []
    for (i, j, k), c in ((at, c) for at, c in of_upper.items() if at[2] == 0):
        for hit, face in ((n <= j < 2 * n and i == n - 1, (1, 2, 6, 5)), (n <= j < 2 * n and i == 2 * n, (3, 0, 4, 7)),
                          (n <= i < 2 * n and j == n - 1, (2, 3, 7, 6)), (n <= i < 2 * n and j == 2 * n, (0, 1, 5, 4))):
            if hit:
                walls.append(m.mesh.add_condition("SurfaceCondition3D4N", tuple(c[q] for q in face)))
    shank = [c for s in ("x0", "x1", "y0", "y1") for c in bolt.conditions(s, "Surface", lambda p: THICK < p[2] < 1.5 * THICK)]
    m.between(shank, walls)
    # nut and lower plate are held; the head presses the upper plate without friction through a rigid washer
    base = [lower[key] for key in lower if key[2] == 0] + bolt.side_nodes["z0"]
    m.fix(base, x=0.0, y=0.0, z=0.0)
    m.fix(bolt.side_nodes["z1"], x=0.0, y=0.0)
    top = [upper[key] for key in upper if key[2] == 2]
    head = m.part(top + bolt.side_nodes["z1"])
    m.process("impose_rigid_movement_process", {"model_part_name": "Structure." + head, "master_variable_name": "DISPLACEMENT_Z"})
    force = m.force_scale
    m.process("bolt_pretension_process", {
        "model_part_name": "Structure.Bolt", "point": [0.0, 0.0, 0.9 * THICK * length], "normal": [0.0, 0.0, 1.0],
        "force": f"{PRELOAD * force!r}*t", "interval": [0.0, 1.5]})
    way = "(0.0 if t < 1.5 else (" + f"{SLIP[0]!r} if t < 2.5 else ({SLIP[1]!r} if t < 3.5 else {SLIP[2]!r})))"
    m.fix(top, x=f"{along[0]!r}*{way}", y=f"{along[1]!r}*{way}")
    s = solve(m, family, friction=FRICTION, steps=4, end=4.0)
    # the force that moves the upper plate, over what friction bears of the bolt's force
    def drawn(step):
        r = s.reaction(top, step)
        return (r[0] * along[0] + r[1] * along[1]) / (FRICTION * s.number("force of bolt Structure.Bolt", step) / force)
    base_force = s.reaction(base, 3)
    top_force = s.reaction(top + bolt.side_nodes["z1"], 3)
    return Outcome(s, {"slips at half the clearance": drawn(1), "slips at 0.9 of it": drawn(2), "bears beyond it": float(drawn(3) > 1.5),
                       "balance": max(abs(a + b) for a, b in zip(base_force[:2], top_force[:2])) / PRELOAD})


CASE = Case(
    "Bolt with clearance in shear", "C. A. Coulomb 1781; VDI 2230, slip resistant joints", "ANALYTIC",
    "A bolt in a hole with clearance clamps two plates. Moved aside, they slip at a force of μ times that of the bolt, which the reports of both "
    "give, until the wall of the hole meets the shank. Values are shares of μ F; beyond the clearance the bolt bears, and more is needed.",
    [Quantity("slips at half the clearance", 1.0, {"": 1e-4, "Nitsche": 1e-2}, order=False),
     Quantity("slips at 0.9 of it", 1.0, {"": 1e-4, "Nitsche": 1e-2}, order=False),
     Quantity("bears beyond it", 1.0, 1e-12, order=False), Quantity("balance", 0.0, 1e-6, scale=1.0, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"ALM": {}, "Nitsche": {"family": "Nitsche frictional"}, "along another side": {"along": (0.0, -1.0)}, "oblique": {"along": (0.6, 0.8)},
              "millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["ALM"])
