"""Two rings of unlike meshes under outer pressure: tied, in contact, and turned against each other."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import lame, mean, rms
from lib.model import Model
from lib.shapes import polar
from lib.solution import solve

INNER, MIDDLE, OUTER, YOUNG, POISSON, PRESSURE = 1.0, 1.5, 2.0, 1e5, 0.3, 500.0


def exact(held):
    rings = [(INNER, MIDDLE, YOUNG, POISSON), (MIDDLE, OUTER, YOUNG, POISSON)]
    return lame(rings, ("displacement", 0.0) if held else ("pressure", 0.0), ("pressure", PRESSURE))


def bearing(held):
    return -exact(held)[1](0, MIDDLE)


def closing(held):
    a, b = exact(held)[0][1]
    return -(a * OUTER + b / OUTER)


def run(n, family="ALM", slave="outer", degrees=0.0, held=False, friction=None, steps=1, turn=0.0, **units):
    m = Model(2, **units)
    start = math.radians(turn)
    at = lambda r, t: polar(r, t + start)
    kind = {"element": "TotalLagrangianElement"} if degrees else {}
    inner = m.box("Inner", "2D4N", [n // 4, 2 * n], [INNER, 0.0], [MIDDLE, 2 * math.pi], at, wrap="y", **kind)
    outer = m.box("Outer", "2D4N", [n // 4, 3 * n], [MIDDLE, 0.0], [OUTER, 2 * math.pi], lambda r, t: at(r, t + 0.01), wrap="y", **kind)
    for body in (inner, outer):
        m.material(body, "strain", YOUNG, POISSON)
    if held:  # the hub is held, or turned, as a rigid one
        angle = f"{math.radians(degrees)!r}*t"
        if degrees:
            x, y = (f"(X/{m.length!r})", f"(Y/{m.length!r})")
            m.fix(inner.side_nodes["x0"], x=f"{x}*(cos({angle}) - 1.0) - {y}*sin({angle})", y=f"{x}*sin({angle}) + {y}*(cos({angle}) - 1.0)")
        else:
            m.fix(inner.side_nodes["x0"], x=0.0, y=0.0)
    else:
        hold(m, inner, "x0")
    hold(m, outer, "x1")
    m.pressure(outer, "x1", PRESSURE, "1.0" if degrees else "t")
    sides = [(outer, "x0"), (inner, "x1")]
    m.interface(*(sides if slave == "outer" else sides[::-1]))
    s = solve(m, family, friction=friction, steps=steps)
    rim = outer.side_nodes["x1"]
    u, where = s.u(rim), s.at(rim)
    closed = -mean((u[i][0] * where[i][0] + u[i][1] * where[i][1]) / math.hypot(*where[i]) for i in rim)
    values = {"closing of the rim": closed / closing(held)}
    if family in ("ALM", "ALM components", "ALM frictional", "penalty", "Uzawa", "perturbed"):
        p = s.pressure().values()
        values["pressure between"] = mean(p) / bearing(held)
        values["scatter of the pressure"] = rms(v / mean(p) - 1.0 for v in p) if mean(p) else math.inf
    if degrees:
        hub = inner.side_nodes["x0"]
        moved = s.u(hub)
        force = s.vector("REACTION", hub, -1, m.force_scale)
        torque = sum((m.mesh.nodes[i][0] + moved[i][0]) * force[i][1] - (m.mesh.nodes[i][1] + moved[i][1]) * force[i][0] for i in hub)
        values["torque"] = torque / (bearing(held) * 2 * math.pi * MIDDLE ** 2)
    return Outcome(s, values)


def hold(m, ring, side):
    """Restrains the rigid-body modes of a ring at the four nodes of a rim on the axes, each along the rim."""
    nodes = m.mesh.nodes
    radius = math.hypot(*nodes[ring.side_nodes[side][0]])
    for axis, (cx, cy) in (("y", (radius, 0.0)), ("y", (-radius, 0.0)), ("x", (0.0, radius)), ("x", (0.0, -radius))):
        nearest = min(ring.side_nodes[side], key=lambda i: math.hypot(nodes[i][0] - cx, nodes[i][1] - cy))
        m.fix([nearest], **{axis: 0.0})


TURNED = {"held": True, "degrees": 9.0, "steps": 3}
ROTATED = ("turned by 9°", "turned by 9°, inner as slave", "turned by 9°, penalty")
CASE = Case(
    "Two rings under pressure (Lamé)", "G. Lamé 1852; Timoshenko and Goodier, Theory of Elasticity, § 28", "ANALYTIC",
    "Polygons in place of circles and unlike facets on them are off by the square of the mesh size; strains of 0.7 %, which Lamé neglects, "
    "count in the area that the pressure acts on. Values are shares of the closed form; the torque is the coefficient of friction that would bear it. "
    "A slave finer than its master feels the master's corners: its pressures scatter by the sagitta of a facet over its stretch, of first order. "
    "On a fixed hub the rim closes by little more than these sagittas.",
    [Quantity("closing of the rim", 1.0, {"": (0.15, 0.04, 0.015), **{v: (0.7, 0.2, 0.06) for v in ROTATED}}), Quantity("pressure between", 1.0, (0.6, 0.15, 0.04)),
     Quantity("scatter of the pressure", 0.0, {"": (1.5, 1.0, 0.7), "inner as slave": (0.3, 0.1, 0.03), "turned by 9°, inner as slave": (0.3, 0.1, 0.05)}, scale=1.0), Quantity("torque", 0.0, 1e-4, scale=1.0, order=False)],
    (16, 32, 64), run, size=lambda n: 1 / n,
    variants={"tied": {"family": "tie"}, "tied by constraints": {"family": "MPC tie"}, "ALM": {}, "inner as slave": {"slave": "inner"},
              "components": {"family": "ALM components"}, "penalty": {"family": "penalty"}, "perturbed": {"family": "perturbed"},
              "Uzawa": {"family": "Uzawa"}, "frictional": {"family": "ALM frictional", "friction": 0.3},
              "turned by 9°": TURNED, "turned by 9°, inner as slave": {**TURNED, "slave": "inner"},
              "turned by 9°, penalty": {**TURNED, "family": "penalty"}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    picture="ALM", quick=["tied", "ALM", "inner as slave", "turned by 9°"])
