"""A steel roller pressed on an aluminium block by 35 kN: the first of the contact benchmarks of NAFEMS."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.shapes import edge_of_contact, quarter_disc, scaled, stations
from lib.solution import solve

R, FORCE, STEEL, ALUMINIUM, POISSON = 50.0, 35000.0, 210000.0, 70000.0, 0.3
MODULUS = 1 / ((1 - POISSON ** 2) * (1 / STEEL + 1 / ALUMINIUM))
HALF = math.sqrt(4 * FORCE * R / (math.pi * MODULUS))
PEAK = 2 * FORCE / (math.pi * HALF)


def model(h, share, length, stress):
    m, wide = Model(2, length, stress), 8.0 * math.sqrt(share)
    h *= math.sqrt(share)
    near = stations(h, wide, R)
    arc = scaled(stations(h, wide, R * math.pi / 4))
    disc = quarter_disc(R)
    roller = m.graded("Roller", "2D4N", [arc, scaled(near)], disc)
    block = m.graded("Block", "2D4N", [stations(h * 0.9, wide, 100.0), [-y for y in reversed(stations(h * 0.9, wide, 200.0))]])
    m.material(roller, "strain", STEEL, POISSON)
    m.material(block, "strain", ALUMINIUM, POISSON)
    m.roll(roller.side_nodes["x0"] + block.side_nodes["x0"], x=0.0)
    m.roll(block.side_nodes["y0"], y=0.0)
    m.traction(roller, "y1", (0.0, -FORCE * share / (2 * R)))
    m.interface((roller, "y0", lambda p: p[0] < 2.5 * wide), (block, "y1", lambda p: p[0] < 2.5 * wide))
    return m


def run(h, family="ALM", friction=None, share=1.0, length=1.0, stress=1.0):
    m = model(h, share, length, stress)
    s = solve(m, family, steps=2, friction=friction)
    p, u = s.pressure(), s.u(m.watched[0])
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i]) for i in p)
    small = math.sqrt(share)
    half, peak = edge_of_contact(at)
    base = [i for i, (_, y, _) in m.mesh.nodes.items() if y == -200.0]
    return Outcome(s, {"half-width": half / small, "peak pressure": peak / small, "load": 2 * s.reaction(base)[1] / share},
                   curves={"computed": [q for q in at if q[0] < 1.3 * HALF],
                           "published": [(x, PEAK * math.sqrt(max(0.0, 1 - (x / HALF) ** 2))) for x in [HALF * k / 40 for k in range(53)]]})


CASE = Case(
    "Roller on a block (NAFEMS)",
    "A. Konter, Advanced Finite Element Contact Benchmarks, NAFEMS R0094 (2006), benchmark 1: a = 6.2146 mm, p₀ = 3585.4 N/mm²",
    "EXTERNAL",
    "The published values are Hertz' for half-planes at vanishing strain. At the full load aluminium strains by 2.7 % along the "
    "surface. So the contact, measured in the deformed state, is narrower by half of that. A hundredth of the load (values times 10) "
    "shows that there is no other difference. Friction between unlike materials narrows the contact a little more.",
    [Quantity("half-width", 6.2146, {"": 0.02, "μ = 0.1": 0.03}, "mm"), Quantity("peak pressure", 3585.4, {"": 0.02, "μ = 0.1": 0.03}, "N/mm²"),
     Quantity("load", FORCE, 1e-4, "N/mm", order=False)],
    (1.0, 0.5, 0.25), run, size=lambda h: h,
    variants={"ALM": {}, "a hundredth of the load": {"share": 0.01}, "components": {"family": "ALM components"},
              "penalty": {"family": "penalty"}, "Uzawa": {"family": "Uzawa"},
              "perturbed": {"family": "perturbed"}, "μ = 0.1": {"family": "ALM frictional", "friction": 0.1},
              "metres, pascals": {"length": 1e-3, "stress": 1e6}},
    quick=["ALM"])
