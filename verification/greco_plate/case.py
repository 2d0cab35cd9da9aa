"""A plate pressed on a rigid foundation and pushed from the side: it sticks, slides and lifts."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, FRICTION = 130000.0, 0.2, 1.0  # N/mm²
TOP, SIDE, SIZE = 50.0, 150.0, 40.0
POINTS = {"A": (0.0, 28.6), "B": (1.25, 27.2), "C": (5.0, 22.8), "D": (7.5, 19.8), "E": (11.25, 15.0)}


def run(n, family="ALM frictional", length=1.0, stress=1.0, steps=1):
    m = Model(2, length, stress)
    plate = m.box("Plate", "2D4N", [n, n], [0.0, 0.0], [SIZE, SIZE])
    ground = m.box("Ground", "2D4N", [n, 1], [-SIZE / 4, -SIZE / 4], [1.25 * SIZE, 0.0])
    m.material(plate, "strain", YOUNG, POISSON)
    m.material(ground, "strain", YOUNG, POISSON)
    m.fix(ground.nodes, x=0.0, y=0.0)
    m.roll(plate.side_nodes["x1"], x=0.0)
    m.traction(plate, "y1", (0.0, -TOP))
    m.traction(plate, "x0", (SIDE, 0.0))
    m.interface((plate, "y0"), (ground, "y1"))
    s = solve(m, family, steps=steps, friction=FRICTION)
    base = sorted(plate.side_nodes["y0"], key=lambda i: m.mesh.nodes[i][0])
    u = s.u(base)
    line = [(m.mesh.nodes[i][0], 1e3 * u[i][0]) for i in base]

    def at(x):
        k = min(int(x / SIZE * n), n - 1)
        (a, ua), (b, ub) = line[k], line[k + 1]
        return ua + (ub - ua) * (x - a) / (b - a)
    return Outcome(s, {"u" + name: at(x) for name, (x, _) in POINTS.items()},
                   curves={"computed": line, "published": list(POINTS.values())})


CASE = Case(
    "Plate on a rigid foundation (GRECO)",
    "working group GRECO (Raous, Chabrand, Lebon, J. Méc. Théor. Appl. 7, 1988); Code_Aster SSNV128: 28.6, 27.2, 22.8, 19.8, 15.0 µm",
    "EXTERNAL",
    "Results of several programs differ by 3 %; the last value is read from a curve. Points lie 0, 1.25, 5, 7.5 and 11.25 mm from "
    "the loaded side.",
    [Quantity("u" + name, u, (0.06, 0.04, 0.04), "µm", order=False) for name, (_, u) in POINTS.items()],
    (16, 32, 64), run, variants={"mm": {}, "m": {"length": 1e-3, "stress": 1e6}, "4 steps": {"steps": 4}}, quick=["mm", "m"])
