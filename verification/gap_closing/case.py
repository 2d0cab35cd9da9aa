"""Two confined blocks with a gap or an overlap between them, driven by displacement or by load."""
from deck import oedometer
from lib.case import Case, Outcome, Quantity
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE = 1e6, 0.3, 1e4
STIFF = oedometer(YOUNG, POISSON)


def run(n, family="ALM", gap=0.005, load=False, steps=1, dim=2, **units):
    """Gaps in heights of a block; by displacement the top moves by the gap and 1 % more."""
    m, up, last = Model(dim, **units), "xyz"[dim - 1], dim - 1
    shape = "2D4N" if dim == 2 else "3D8N"
    low = m.box("Lower", shape, [n] * dim, [0.0] * dim, [1.0] * dim)
    top = m.box("Upper", shape, [n + 1] * last + [n], [0.0] * last + [1.0 + gap], [1.0] * last + [2.0 + gap])
    for body in (low, top):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
        for axis in "xyz"[:last]:
            m.roll(body.side_nodes[axis + "0"] + body.side_nodes[axis + "1"], **{axis: 0.0})
    m.roll(low.side_nodes[up + "0"], **{up: 0.0})
    if load:
        m.traction(top, up + "1", [0.0] * last + [-PRESSURE])
    else:
        m.roll(top.side_nodes[up + "1"], **{up: f"{-(gap + 0.01)!r}*t"})
    m.interface((top, up + "0"), (low, up + "1"))
    s = solve(m, family, steps=steps)
    force = s.reaction(low.side_nodes[up + "0"])[last]
    pressed = PRESSURE if load else STIFF * 0.01 / 2
    moved = s.u(top.side_nodes[up + "1"])
    down = -sum(v[last] for v in moved.values()) / len(moved)
    return Outcome(s, {"force": force / pressed, "motion of the top": down / (gap + 2 * pressed / STIFF)})


CASE = Case(
    "Gap that closes", "two springs in a row: p = E_oed (d - g) / 2", "ANALYTIC", "Displacement is affine; the tolerance is that of the iteration; a penalty yields by its compliance.",
    [Quantity("force", 1.0, {"": 1e-4, "penalty": 1e-3}, order=False), Quantity("motion of the top", 1.0, {"": 1e-3}, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "4 steps": {"steps": 4}, "wide gap": {"gap": 0.2}, "wide gap, 5 steps": {"gap": 0.2, "steps": 5},
              "overlap": {"gap": -0.005}, "overlap, load": {"gap": -0.005, "load": True}, "touching, load": {"gap": 0.0, "load": True},
              "gap, load": {"load": True}, "gap of a tenth of a cell, load": {"gap": 0.025, "load": True},
              "gap, load, 3D": {"load": True, "dim": 3}, "gap, load, 4 steps": {"load": True, "steps": 4}, "gap, load, MPC": {"load": True, "family": "MPC"},
              "gap, load, penalty": {"load": True, "family": "penalty"}, "metres to millimetres": {"length": 1e3, "stress": 1e-6, "load": True}},
    quick=["ALM", "overlap"])
