"""A sphere on a block in space: a quarter of hexahedra."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.shapes import scaled, stations
from lib.solution import solve

YOUNG, POISSON, HALF, RADIUS, WIDTH = 1e3, 0.3, 1.0, 200.0, 12.0
MODULUS = YOUNG / (2 * (1 - POISSON ** 2))
FORCE = 4 * MODULUS * HALF ** 3 / (3 * RADIUS)
PEAK = 3 * FORCE / (2 * math.pi * HALF ** 2)


def run(n, family="ALM", slave="sphere", shape="3D8N", **units):
    m, size = Model(3, **units), 1.0 / n
    rise = lambda x, y: min(x * x + y * y, 4.5) / (2 * RADIUS)
    lines = stations(size, 1.3, WIDTH, 1.5)
    up = scaled(stations(size, 0.0, WIDTH, 1.5))
    sphere = m.graded("Sphere", shape, [lines, lines, up], lambda x, y, s: (x, y, rise(x, y) + s * (WIDTH - rise(x, y))))
    other = stations(1.2 * size, 1.3, WIDTH, 1.5)
    block = m.graded("Block", shape, [other, other, [-z for z in reversed(stations(1.2 * size, 0.0, WIDTH, 1.5))]])
    for body in (sphere, block):
        m.material(body, "3d", YOUNG, POISSON)
        m.roll(body.side_nodes["x0"], x=0.0)
        m.roll(body.side_nodes["y0"], y=0.0)
    m.roll(block.side_nodes["z0"], z=0.0)
    m.traction(sphere, "z1", (0.0, 0.0, -FORCE / 4 / WIDTH ** 2))
    near = lambda p: max(p[0], p[1]) < 2.2
    sides = [(sphere, "z0", near), (block, "z1", near)]
    m.interface(*(sides if slave == "sphere" else sides[::-1]))
    s = solve(m, family)
    p, area = s.pressure(), s.area()
    load = sum(p[i] * area[i] for i in p)
    second = sum(p[i] * area[i] * (m.mesh.nodes[i][0] ** 2 + m.mesh.nodes[i][1] ** 2) for i in p) / load
    # Hertz' pressure has the radius of gyration a sqrt(2/5)
    return Outcome(s, {"contact radius": math.sqrt(2.5 * second) / HALF, "peak pressure": max(p.values()) / PEAK, "load": 4 * load / FORCE},
                   curves={"computed": sorted((math.hypot(*m.mesh.nodes[i][:2]), q / PEAK) for i, q in p.items() if math.hypot(*m.mesh.nodes[i][:2]) < 1.6),
                           "published": [(k / 50, math.sqrt(max(0.0, 1 - (k / 50) ** 2))) for k in range(81)]})


CASE = Case(
    "Sphere on a block in space (Hertz)", "H. Hertz 1882; Johnson, Contact Mechanics, § 4.2", "ANALYTIC",
    "Values are relative to Hertz'; bodies are 12 contact radii deep and wide, and six to nine facets lie in a contact radius at the most.",
    [Quantity("contact radius", 1.0, (0.05, 0.04)), Quantity("peak pressure", 1.0, (0.06, 0.05)), Quantity("load", 1.0, 5e-3, order=False)],
    (3, 5), run, size=lambda n: 1 / n,
    variants={"ALM": {}, "block as slave": {"slave": "block"}, "components": {"family": "ALM components"}, "penalty": {"family": "penalty"},
              "3D10N": {"shape": "3D10N"}, "Uzawa": {"family": "Uzawa"}, "perturbed": {"family": "perturbed"}, "micrometres": {"length": 1e6, "stress": 1e-12}}, quick=["ALM"])
