"""Four blocks stacked freely under their weight."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, DENSITY, GRAVITY, COUNT = 1e6, 0.2, 2e3, 10.0, 4


def run(n, family="ALM frictional", friction=0.3, dim=2, steps=1, **units):
    m, up, last = Model(dim, **units), "xyz"[dim - 1], dim - 1
    shape = "2D4N" if dim == 2 else "3D8N"
    blocks = []
    for k in range(COUNT):
        low = [0.0] * last + [float(k)]
        blocks.append(m.box(f"Block{k}", shape, [n + k % 2] * last + [n], low, [1.0] * last + [k + 1.0]))
        pull = [0.0] * 3
        pull[last] = -GRAVITY * m.stress / m.length  # weight per volume keeps the case's ratio to Young's modulus
        m.material(blocks[-1], "3d" if dim == 3 else "strain", YOUNG, POISSON, DENSITY=DENSITY, VOLUME_ACCELERATION=pull)
    m.fix(blocks[0].side_nodes[up + "0"], *[0.0] * dim)
    for below, above in zip(blocks, blocks[1:]):
        m.interface((above, up + "0"), (below, up + "1"))
    s = solve(m, family, friction=friction, steps=steps)
    weight = DENSITY * GRAVITY
    values = {"force on the ground": s.reaction(blocks[0].side_nodes[up + "0"])[last] / (COUNT * weight)}
    for k in range(COUNT - 1):
        p, area = s.pressure(k), s.area(k)
        values[f"joint {k + 1}"] = sum(p[i] * area[i] for i in p) / ((COUNT - 1 - k) * weight)
    return Outcome(s, values)


CASE = Case(
    "Stack of four blocks", "balance: each joint bears what lies on it", "ANALYTIC",
    "Pressure acts on areas widened by strains of up to 2 %; the balance of forces is that of the iteration. Joint 1 is the lowest.",
    [Quantity("force on the ground", 1.0, 1e-3, order=False)] + [Quantity(f"joint {k}", 1.0, 1e-3, order=False) for k in (1, 2, 3)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"plane": {}, "μ = 0.05": {"friction": 0.05}, "space": {"dim": 3}, "4 steps": {"steps": 4}, "penalty": {"family": "penalty frictional"},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["plane"])
