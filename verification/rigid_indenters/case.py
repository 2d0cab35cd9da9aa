"""Rigid shapes under a force on a half-space: cylinder, sphere, wedge and cone."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, RADIUS, SLOPE, FAR = 1000.0, 0.3, 50.0, 0.02, 30.0
STIFFNESS = YOUNG / (1 - POISSON ** 2)
# Shape and whether about an axis: force on a half-width of 1, the pressure that scales the profile, and the profile over r/a.
HERTZ, SHARP = lambda r: math.sqrt(1 - r * r), lambda r: math.acosh(1 / r)
SHAPES = {
    "cylinder": (False, math.pi * STIFFNESS / (4 * RADIUS), STIFFNESS / (2 * RADIUS), HERTZ),
    "sphere": (True, 4 * STIFFNESS / (3 * RADIUS), 2 * STIFFNESS / (math.pi * RADIUS), HERTZ),
    "wedge": (False, STIFFNESS * SLOPE, STIFFNESS * SLOPE / math.pi, SHARP),
    "cone": (True, 0.5 * math.pi * STIFFNESS * SLOPE, 0.5 * STIFFNESS * SLOPE, SHARP),
}


def stations(fine, coarse):
    """Distances from the corner: even cells up to 1.5, then cells that grow by one ratio up to FAR."""
    first, rest, low, high = 1.5 / fine, FAR - 1.5, 1.0 + 1e-9, 3.0
    for _ in range(100):
        q = 0.5 * (low + high)
        low, high = (q, high) if first * q * (q ** coarse - 1) / (q - 1) < rest else (low, q)
    return [first * i for i in range(fine + 1)] + [1.5 + first * q * (q ** (i + 1) - 1) / (q - 1) for i in range(coarse)]


def fit(points, profile):
    """Width a and scale c of c · profile(r/a), by least squares over the points within 0.7 of the contact."""
    edge = max(r for r, p in points if p > 0)
    inner = [(r, p) for r, p in points if 0.1 * edge < r < 0.7 * edge]

    def best(a):
        shape = [profile(r / a) for r, _ in inner]
        c = sum(s * p for s, (_, p) in zip(shape, inner)) / sum(s * s for s in shape)
        return sum((c * s - p) ** 2 for s, (_, p) in zip(shape, inner)), c

    low, high = 0.75 * edge, 1.4 * edge
    for _ in range(80):
        one, other = low + 0.382 * (high - low), low + 0.618 * (high - low)
        low, high = (low, other) if best(one)[0] < best(other)[0] else (one, high)
    return low, best(low)[1]


def run(n, shape="cylinder", family="ALM", length=1.0, stress=1.0):
    about_axis, force, scale, profile = SHAPES[shape]
    m = Model(2, length, stress)
    cells = stations(8 * n, 5 * n)
    element = "AxisymSmallDisplacementElement" if about_axis else "SmallDisplacementElement"
    block = m.graded("Block", "2D4N", [cells, [-y for y in reversed(cells)]], element=element)
    m.material(block, "axis" if about_axis else "strain", YOUNG, POISSON)
    m.fix(block.side_nodes["y0"], x=0.0, y=0.0)
    m.fix(block.side_nodes["x0"], x=0.0)
    is_round = shape in ("cylinder", "sphere")
    tool = {"name": shape, "radius": RADIUS * length} if is_round else {
        "name": "cone", "half_angle": math.degrees(math.atan(1 / SLOPE)), "height": 0.5 * length}
    contact = m.interface_with_shape((block, "y1", lambda p: p[0] < 3.0), "Tool", "Point", shape=tool,
                                     position=[0.0, RADIUS * length if is_round else 0.0, 0.0], facet_angle=2.0)
    if not about_axis:
        for variable, held in (("DISPLACEMENT", 0), ("ROTATION", 2)):
            m.process("assign_vector_variable_process", {"model_part_name": "Structure.Point", "variable_name": variable,
                "constrained": [c == held for c in range(3)], "value": [0.0 if c == held else None for c in range(3)], "interval": [0.0, "End"]})
        force *= 0.5  # on half of the model
    m.process("assign_vector_variable_to_conditions_process", {"model_part_name": "Structure.Point", "variable_name": "POINT_LOAD",
        "value": [0.0, f"{-force * m.force_scale!r}*t", 0.0], "interval": [0.0, "End"]}, "loads")
    if about_axis:
        contact["alternative_formulations"] = {"axisymmetric": True}
    s = solve(m, family, contact=contact)
    pressure = s.pressure()
    points = [(m.mesh.nodes[i][0], p) for i, p in pressure.items()]
    width, top = fit(points, profile)
    beyond = [(r, p / scale) for r, p in sorted(points) if 0.0 < r < 1.5]
    return Outcome(s, {"width": width, "pressure": top / scale}, curves={"computed": beyond,
                   "published": [(0.01 * k, profile(0.01 * k)) for k in range(2, 101)]}, labels=("r over a", "pressure over its scale"))


CASE = Case(
    "Rigid indenters", "H. Hertz (1881); I. N. Sneddon, Int. J. Engng Sci. 3 (1965); K. L. Johnson, Contact Mechanics (1985), §§ 4.2, 5.2", "ANALYTIC",
    "Cylinder and sphere: a² = 4 F R/(π E*), a³ = 3 F R/(4 E*), elliptic pressure. Wedge and cone of the slope 0.02: F = E* a cot α, F = ½ π E* a² cot α, "
    "p ∝ arccosh (a/r). The block is 30 half-widths wide and deep, 11 and 16 cells on the half-width; width and pressure are fits of the profile, as shares "
    "of the closed form.",
    [Quantity("width", 1.0, 0.01, order=False), Quantity("pressure", 1.0, 0.02, order=False)],
    (2, 3), run, size=lambda n: 1 / n,
    variants={"cylinder": {}, "sphere": {"shape": "sphere"}, "wedge": {"shape": "wedge"}, "cone": {"shape": "cone"},
              "penalty": {"family": "penalty"}, "Nitsche": {"family": "Nitsche"}, "sphere, millimetres": {"shape": "sphere", "length": 1e3, "stress": 1e-6}},
    quick=["sphere", "wedge"])
