"""A tube pressed end to end on another and twisted until it slides."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.solution import solve

YOUNG, INNER, OUTER, PRESSED, FRICTION = 1e5, 1.0, 1.5, 1e-3, 0.3
TORQUE = 2 * math.pi / 3 * FRICTION * YOUNG * PRESSED / 2 * (OUTER ** 3 - INNER ** 3)


def run(n, family="ALM frictional", degrees=1.0, slave="upper", steps=4, **units):
    m, bodies = Model(3, **units), []
    for name, low, count, begin in (("Lower", -1.0, 4 * n, 0.0), ("Upper", 0.0, 5 * n, 0.05)):
        shape = lambda r, t, z, begin=begin: (r * math.cos(t + begin), r * math.sin(t + begin), z)
        body = m.box(name, "3D8N", [max(1, n // 3), count, 2], [INNER, 0.0, low], [OUTER, 2 * math.pi, low + 1.0], shape, wrap="y")
        m.material(body, "3d", YOUNG, 0.0)
        bodies.append(body)
    lower, upper = bodies
    m.fix(lower.side_nodes["z0"], x=0.0, y=0.0, z=0.0)
    angle, unit = f"({math.radians(degrees)!r}*{ramp(1.0, float(steps))})", m.length
    x, y = f"(X/{unit!r})", f"(Y/{unit!r})"
    m.fix(upper.side_nodes["z1"], x=f"{x}*(cos{angle} - 1.0) - {y}*sin{angle}", y=f"{x}*sin{angle} + {y}*(cos{angle} - 1.0)",
          z=f"{-PRESSED!r}*{ramp(0.0, 1.0)}")
    sides = [(upper, "z0"), (lower, "z1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, friction=FRICTION, end=float(steps), steps=steps)
    top = upper.side_nodes["z1"]
    u, r = s.u(top), s.vector("REACTION", top, -1, m.force_scale)
    place = {i: [m.mesh.nodes[i][d] + u[i][d] for d in range(2)] for i in top}
    torque = sum(place[i][0] * r[i][1] - place[i][1] * r[i][0] for i in top)
    force = -sum(r[i][2] for i in top)
    return Outcome(s, {"torque": torque, "axial force": force})


CASE = Case(
    "Twisted tubes", "Coulomb's law on an annulus under uniform pressure: T = 2π/3 μ p (r₂³ - r₁³)", "ANALYTIC",
    "Polygons in place of circles lose area and lever arm of second order in the mesh size; Poisson's ratio is 0, so that pressure stays uniform.",
    [Quantity("torque", lambda v: math.copysign(TORQUE, v.get("degrees", 1.0)), (0.05, 0.02, 0.01)), Quantity("axial force", YOUNG * PRESSED / 2 * math.pi * (OUTER ** 2 - INNER ** 2), (0.05, 0.02, 0.01))],
    (4, 6, 9), run, size=lambda n: 1 / n,
    variants={"ALM": {}, "backwards": {"degrees": -1.0}, "lower as slave": {"slave": "lower"}, "penalty": {"family": "penalty frictional"},
              "MPC": {"family": "MPC frictional"}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["ALM"])
