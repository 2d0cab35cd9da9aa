"""A punch on a block in sizes from a thousandth to a thousand: everything scales."""
from lib.case import Case, Outcome, Quantity
from lib.measures import mean
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE = 1e5, 0.3, 1e2
KEPT = {}


def one(n, family, dim, size):
    m, up, last = Model(dim, length=size), "xyz"[dim - 1], dim - 1
    shape = "2D4N" if dim == 2 else "3D8N"
    block = m.box("Block", shape, [3 * n] * last + [n], [-1.0] * last + [-1.0], [2.0] * last + [0.0])
    punch = m.box("Punch", shape, [n + 1] * last + [n], [0.0] * dim, [1.0] * dim)
    for body in (block, punch):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
    m.fix(block.side_nodes[up + "0"], *[0.0] * dim)
    m.roll(punch.side_nodes[up + "1"], **{a: 0.0 for a in "xyz"[:last]})
    m.traction(punch, up + "1", [0.0] * last + [-PRESSURE])
    m.interface((punch, up + "0"), (block, up + "1"))
    s = solve(m, family)
    return s, -mean(v[last] for v in s.u(punch.side_nodes[up + "1"]).values())


def run(n, family="ALM", dim=2, size=1.0):
    base = KEPT.get((n, family, dim)) or KEPT.setdefault((n, family, dim), one(n, family, dim, 1.0))
    exact = KEPT.get((n, "ALM", dim)) or KEPT.setdefault((n, "ALM", dim), one(n, "ALM", dim, 1.0))
    s, down = one(n, family, dim, size)
    return Outcome(s, {"motion over that at size 1": down / base[1], "iterations over those at size 1": s.iterations / base[0].iterations,
                       "motion over that of ALM": down / exact[1]})


CASE = Case(
    "Punch in all sizes", "similarity: a linear elastic problem has no length of its own", "ANALYTIC",
    "The same mesh in other units of length must give the same result in the same iterations; a penalty may yield by a hundredth of the motion.",
    [Quantity("motion over that at size 1", 1.0, 1e-6, order=False), Quantity("iterations over those at size 1", 1.0, 0.0, order=False),
     Quantity("motion over that of ALM", 1.0, {"": 1e-2}, order=False)],
    (3,), run, size=lambda n: 1 / n,
    variants={f"{family}{', space' if dim == 3 else ''}, size {size:g}": {"family": family, "dim": dim, "size": size}
              for family in ("ALM", "penalty", "Uzawa", "perturbed") for dim in (2, 3) for size in (1e-3, 0.03, 1.3, 30.0, 1e3)},
    quick=["ALM, size 0.001", "ALM, size 1000"])
