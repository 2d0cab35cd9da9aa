"""Two like arches pressed crown to crown meet in their plane of symmetry: each feels a rigid plane."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, INNER, OUTER = 1e3, 0.3, 9.0, 10.0


def half_ring(model, name, divisions, centre, side, shape="2D4N"):
    """An arch around `centre`, open below (`side` 1) or above (-1); the first of its divisions runs from the inner to the outer radius."""
    return model.box(name, shape, divisions, [INNER, 0.0], [OUTER, math.pi],
                     lambda r, t: (centre[0] + side * r * math.cos(t), centre[1] + side * r * math.sin(t)), element="TotalLagrangianElement")


def run(n, family="ALM", slave="upper", friction=None, depth=1.5, steps=8, shift=False, **units):
    """The pair is pressed by 2 `depth`, and one arch by `depth` on a plane."""
    forces, solutions = [], []
    for plane in (False, True):
        m = Model(2, **units)
        low = half_ring(m, "Lower", [2, 8 * n], (0.0, -OUTER), 1)
        if plane:
            top = m.box("Plane", "2D4N", [6 * n, 1], [-8.0, 0.0], [8.0, 0.5])
        else:
            count = 8 * n + 2 if shift else 8 * n
            top = half_ring(m, "Upper", [2, count], (0.0, OUTER), -1)
        for body in (low, top):
            m.material(body, "strain", YOUNG, POISSON)
        m.fix(low.side_nodes["y0"] + low.side_nodes["y1"], x=0.0, y=0.0)
        held = top.nodes if plane else top.side_nodes["y0"] + top.side_nodes["y1"]
        m.fix(held, x=0.0, y=f"{-depth * (1 if plane else 2)!r}*t")
        near = lambda p: abs(p[0]) < 8.0
        sides = [(low, "x1", near), (top, "y0" if plane else "x1", near)]
        m.interface(*(sides if slave == "lower" or plane else sides[::-1]))
        s = solve(m, family, friction=friction, steps=steps)
        forces.append(s.reaction(low.side_nodes["y0"] + low.side_nodes["y1"])[1])
        solutions.append(s)
    return Outcome(solutions[::-1], {"force over that on a plane": forces[0] / forces[1]})


CASE = Case(
    "Double arch", "mirror symmetry: both arches deform alike and meet in a plane (after the example double_arch of Kratos)", "ANALYTIC",
    "Nodes of matching meshes meet, so that only the faceting of the plane remains; non-matching meshes have errors of their size squared.",
    [Quantity("force over that on a plane", 1.0, (0.03, 0.02, 0.01))],
    (4, 6, 9), run, size=lambda n: 1 / n,
    variants={"like meshes": {}, "unlike meshes": {"shift": True}, "unlike meshes, lower as slave": {"shift": True, "slave": "lower"},
              "16 steps": {"shift": True, "steps": 16}, "frictional": {"family": "ALM frictional", "friction": 0.2},
              "penalty": {"family": "penalty"}}, quick=False)
