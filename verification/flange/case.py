"""A flange of eight bolts with clearance: tightened, then lifted at its inner edge; whole, and one sector with cyclic symmetry."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

BOLTS, INNER, OUTER, HEIGHT, YOUNG, POISSON, PRELOAD, LIFT = 8, 20.0, 40.0, 8.0, 2.1e5, 0.3, 4000.0, 6.0
TURN = -2e-5  # of the rim against the base, in the variant with friction (radian)
# cells along the radius, around a sector and through a ring; those of the bolt among them
RADIAL, AROUND, THROUGH = 5, 4, 2
BOLT = (range(2, 3), range(1, 3))


class Flange:
    """Nodes and cells; lower and upper ring, bolts that are one with both at their ends."""

    def __init__(self, sectors):
        self.known, self.places, self.cells, self.sectors = {}, [], [], sectors
        self.slaves, self.masters, self.lifted = [], [], []
        for j in range(AROUND * sectors):
            for i in range(RADIAL):
                if i in BOLT[0] and j % AROUND in BOLT[1]:
                    self.cells += [(f"Bolt{j // AROUND}", self.cell("bolt", i, j, k)) for k in range(2 * THROUGH)]
                    continue
                for ring in ("lower", "upper"):
                    self.cells += [("Rings", self.cell(ring, i, j, k)) for k in range(THROUGH)]
                self.slaves.append(self.face("lower", i, j, THROUGH))
                self.masters.append(self.face("upper", i, j, 0)[::-1])
                if i == 0:
                    self.lifted.append(self.face("upper", i, j, THROUGH))

    def node(self, body, i, j, k):
        j %= AROUND * BOLTS
        if body == "bolt" and k in (0, 2 * THROUGH):  # heads are one with the rings
            body, k = ("lower", 0) if k == 0 else ("upper", THROUGH)
        if (body, i, j, k) not in self.known:
            radius, angle = INNER + (OUTER - INNER) * i / RADIAL, 2 * math.pi * j / (AROUND * BOLTS)
            base = 0.0 if body == "upper" else -HEIGHT
            self.places.append((radius * math.cos(angle), radius * math.sin(angle), base + HEIGHT * k / THROUGH))
            self.known[body, i, j, k] = len(self.places)
        return self.known[body, i, j, k]

    def face(self, body, i, j, k):
        return tuple(self.node(body, i + a, j + b, k) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))

    def cell(self, body, i, j, k):
        return self.face(body, i, j, k) + self.face(body, i, j, k + 1)

    def select(self, wanted):
        return [node for at, node in self.known.items() if wanted(*at)]

    def base(self):
        return self.select(lambda body, i, j, k: body == "lower" and k == 0 and i <= 1)

    def rim(self):
        return self.select(lambda body, i, j, k: body == "upper" and i == RADIAL)


def motions(sectors, friction, length, stress):
    """Solution and displacements of the second step by place in the mesh."""
    flange = Flange(sectors)
    m = Model(3, length, stress)
    for place in flange.places:
        m.mesh.add_node(place)
    parts = {}
    for name, nodes in flange.cells:
        parts.setdefault(name, []).append(m.mesh.add_element("SmallDisplacementElement3D8N", nodes))
    for name, elements in parts.items():
        m.mesh.part(name, {i for e in elements for i in m.mesh.elements[e - 1][1]}, elements)
    m.materials.append({"model_part_name": "Structure", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElastic3DLaw"}, "Variables": {"YOUNG_MODULUS": YOUNG * stress, "POISSON_RATIO": POISSON}, "Tables": {}}})
    sides = [[m.mesh.add_condition("SurfaceLoadCondition3D4N", f) for f in faces] for faces in (flange.slaves, flange.masters, flange.lifted)]
    m.between(sides[0], sides[1])
    m.fix(flange.base(), x=0.0, y=0.0, z=0.0)
    for bolt in range(sectors):
        m.process("bolt_pretension_process", {
            "model_part_name": f"Structure.Bolt{bolt}", "point": [0.0, 0.0, 0.5 * HEIGHT * length], "normal": [0.0, 0.0, 1.0],
            "force": f"{PRELOAD * m.force_scale!r}*t", "interval": [0.0, 1.5]})
    lifted = m.part({i for f in flange.lifted for i in f}, sides[2], "Lift")
    m.process("assign_vector_variable_to_conditions_process", {
        "model_part_name": "Structure." + lifted, "variable_name": "SURFACE_LOAD", "value": [0.0, 0.0, f"{LIFT * stress!r}*(t - 1.0)"],
        "interval": [1.5, "End"]}, "loads")
    if friction:
        rim = m.part(flange.rim())
        m.process("assign_vector_variable_process", {
            "model_part_name": "Structure." + rim, "variable_name": "DISPLACEMENT", "constrained": [True, True, False],
            "value": [f"{-TURN!r}*Y*t", f"{TURN!r}*X*t", None], "interval": [0.0, "End"]})
    if sectors < BOLTS:
        first, second = (m.part(flange.select(lambda body, i, j, k, at=at: j == at)) for at in (0, AROUND))
        m.process("apply_periodic_condition_process", {
            "model_part_name": "Structure", "first_model_part_name": first, "second_model_part_name": second, "variable_names": ["DISPLACEMENT"],
            "transformation_settings": {"rotation_settings": {"axis_of_rotation": [0.0, 0.0, 1.0], "angle_degree": 360.0 / BOLTS}}})
    s = solve(m, "ALM frictional" if friction else "ALM", friction=friction, steps=2, end=2.0,
              solver={"residual_relative_tolerance": 1e-8}, settings={"contact_residual_relative_tolerance": 1e-8})
    u = s.u(m.mesh.nodes)
    return s, {at: u[node] for at, node in flange.known.items()}


def run(friction=None, length=1.0, stress=1.0):
    whole, of_whole = motions(BOLTS, friction, length, stress)
    sector, of_sector = motions(1, friction, length, stress)
    size = max(abs(c) for u in of_whole.values() for c in u)
    values = {"sector beside the whole": max(abs(a - b) for at, u in of_sector.items() for a, b in zip(u, of_whole[at])) / size}
    if not friction:
        values["opening at the inner edge"] = of_whole["upper", 0, 0, 0][2] - of_whole["lower", 0, 0, THROUGH][2]
        values["lift of the inner edge"] = of_whole["upper", 0, 0, THROUGH][2]
        values["motion of a bolt's head"] = of_whole["upper", 2, 2, THROUGH][2]
    return Outcome([whole, sector], values)


CALCULIX = {"opening at the inner edge": 7.87142e-4, "lift of the inner edge": 1.05197e-3, "motion of a bolt's head": -2.63253e-3}
frictionless = lambda value: lambda variant: None if variant.get("friction") else value
CASE = Case(
    "Flange with eight bolts", "CalculiX 2.20, contact by penalty, the same mesh: `python3 verification/flange/with_calculix.py`", "EXTERNAL",
    "The bolts are tightened and locked; then the inner edge is lifted. A sector with cyclic symmetry is the same problem as the whole flange: "
    "1e-8 of the iteration. CalculiX has the same cells of eight nodes: 1 %.",
    [Quantity("sector beside the whole", 0.0, 1e-8, scale=1.0, tag="ANALYTIC", order=False),
     *(Quantity(name, frictionless(value), 1e-2, "mm", order=False) for name, value in CALCULIX.items())],
    (1,), lambda mesh, **settings: run(**settings),
    variants={"": {}, "twisted, μ = 0.2": {"friction": 0.2}, "metres, pascals": {"length": 1e-3, "stress": 1e6}}, quick=[""])
