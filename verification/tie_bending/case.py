"""A cantilever glued from two unlike meshes."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, LENGTH, HIGH, LOAD = 1e6, 10.0, 1.0, 10.0
TIP = LOAD * HIGH * LENGTH ** 3 / (3 * YOUNG * HIGH ** 3 / 12) + 6 / 5 * LOAD * LENGTH / (YOUNG / 2)


def run(n, family="tie", slave="root", oblique=0.5, **units):
    m = Model(2, **units)
    middle = lambda y: LENGTH / 2 + oblique * (y - HIGH / 2)
    root = m.box("Root", "2D4N", [5 * n, n], [0.0, 0.0], [1.0, HIGH], lambda s, y: (s * middle(y), y))
    tip = m.box("Tip", "2D4N", [4 * n, n + n // 2], [0.0, 0.0], [1.0, HIGH], lambda s, y: (middle(y) + s * (LENGTH - middle(y)), y))
    for body in (root, tip):
        m.material(body, "strain", YOUNG, 0.0)
    m.fix(root.side_nodes["x0"], x=0.0, y=0.0)
    m.traction(tip, "x1", (0.0, LOAD))
    sides = [(root, "x1"), (tip, "x0")]
    m.interface(*(sides if slave == "root" else sides[::-1]))
    s = solve(m, family)
    ids = tip.side_nodes["x1"]
    u = s.u(ids)
    return Outcome(s, {"deflection of the tip": sum(v[1] for v in u.values()) / len(ids), "force at the root": s.reaction(root.side_nodes["x0"])[1]})


CASE = Case(
    "Glued cantilever", "beam theory with shear (Timoshenko)", "ANALYTIC",
    "Plane elements of first order are too stiff in bending by the square of their size; the theory neglects warping of the clamped end.",
    [Quantity("deflection of the tip", TIP, (0.05, 0.02, 0.01)), Quantity("force at the root", -LOAD * HIGH, 1e-6, order=False)],
    (4, 8, 16), run, size=lambda n: 1 / n,
    variants={"multipliers": {}, "tip as slave": {"slave": "tip"}, "straight cut": {"oblique": 0.0}, "constraints": {"family": "MPC tie"},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["multipliers"])
