"""Two blocks under a pressure that varies smoothly along their interface: how fast methods of contact converge."""
import cmath, math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE, SHARE, WAVE = 1e3, 0.3, 1e-3, 0.5, math.pi
SHEAR, KOLOSOV = YOUNG / (2 * (1 + POISSON)), 3 - 4 * POISSON


def displacement(x, y):
    """Muskhelishvili's potentials Φ = −P z/4 − a sin(k z), Ψ = −P z/2 + Φ₁ − z Φ₁': on y = 0 there is no shear, and the pressure is
    P (1 + s cos k x) with a = s P/(2 k)."""
    z, a = complex(x, y), SHARE * PRESSURE / (2 * WAVE)
    wave, slope = -a * cmath.sin(WAVE * z), -a * WAVE * cmath.cos(WAVE * z)
    phi, phi_slope = -PRESSURE / 4 * z + wave, -PRESSURE / 4 + slope
    psi = -PRESSURE / 2 * z + wave - z * slope
    u = (KOLOSOV * phi - z * phi_slope.conjugate() - psi.conjugate()) / (2 * SHEAR)
    return u.real, u.imag


def pressure(x):
    return PRESSURE * (1 + SHARE * math.cos(WAVE * x))


def run(n, family="Nitsche", shape="2D4N", friction=None, turn=0.0, slave="upper", contact=None, **units):
    m = Model(2, turn=turn, **units)
    low = m.box("Lower", shape, [2 * n, n], [0.0, -0.5], [1.0, 0.0])
    top = m.box("Upper", shape, [2 * n + n // 2, n], [0.0, 0.0], [1.0, 0.5])
    for body in (low, top):
        m.material(body, "strain", YOUNG, POISSON)
    sides = ("x0", "x1")
    for body, far in ((low, "y0"), (top, "y1")):
        for i in sorted({i for side in sides + (far,) for i in body.side_nodes[side]}):
            m.fix([i], *displacement(*m.mesh.nodes[i][:2]), None)
    pair = [(top, "y0"), (low, "y1")]
    m.interface(*(pair if slave == "upper" else pair[::-1]))
    s = solve(m, family, friction=friction, contact=contact, solver={"residual_relative_tolerance": 1e-8},
              settings={"contact_residual_relative_tolerance": 1e-8})
    ids = sorted(i for body in (low, top) for i in body.nodes)
    found, scale = s.u(ids), max(abs(c) for i in ids for c in displacement(*m.mesh.nodes[i][:2]))
    squares = [sum((found[i][c] - displacement(*m.mesh.nodes[i][:2])[c]) ** 2 for c in range(2)) for i in ids]
    within = {i: p for i, p in s.pressure().items() if 0.0 < m.mesh.nodes[i][0] < 1.0}
    misses = [(p - pressure(m.mesh.nodes[i][0])) ** 2 for i, p in within.items()]
    at = sorted((m.mesh.nodes[i][0], p / PRESSURE) for i, p in within.items())
    return Outcome(s, {"error of displacements": math.sqrt(sum(squares) / len(squares)) / scale,
                       "error of the pressure": math.sqrt(sum(misses) / len(misses)) / PRESSURE},
                   curves={"computed": at, "published": [(k / 100, pressure(k / 100) / PRESSURE) for k in range(101)]})


TRIANGLES = (2e-2, 5e-3, 1.5e-3)  # as stiff as they are


def variant(name, **more):
    return {"contact": {"nitsche_variant": name}, **more}


CASE = Case(
    "A smooth pressure between unlike meshes", "N. I. Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity; F. Chouly, "
    "P. Hild, Y. Renard, Symmetric and non-symmetric variants of Nitsche's method for contact problems in elasticity (2015)", "ANALYTIC",
    "Strains are 1e-6, so that theory and program differ by the mesh alone; orders 2 of displacements and 1 or more of the pressure are those "
    "of linear elements.",
    [Quantity("error of displacements", 0.0, {"": (7e-3, 2e-3, 5e-4), "triangles": TRIANGLES, "triangles, symmetric": TRIANGLES}, scale=1.0),
     Quantity("error of the pressure", 0.0, (3e-2, 1e-2, 3e-3), scale=1.0)],
    (4, 8, 16), run, size=lambda n: 1 / n,
    variants={"skew": variant("skew"), "symmetric": variant("symmetric"), "incomplete": variant("incomplete"),
              "lower as slave": {"slave": "lower"}, "triangles": {"shape": "2D3N"},
              "triangles, symmetric": variant("symmetric", shape="2D3N"), "frictional": {"family": "Nitsche frictional", "friction": 0.3},
              "turned by 33°": {"turn": 33.0}, "millimetres": {"length": 1e3, "stress": 1e-6}, "ALM": {"family": "ALM"}},
    quick=["skew", "symmetric"])
