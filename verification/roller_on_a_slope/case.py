"""A block on a roller along a slope, pressed and sheared: as the one on level ground, turned."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, PRESSED, DRAWN = 100.0, 0.3, 2.0, 1.0


def motion(shape, degrees, length=1.0, stress=1.0):
    dim = int(shape[0])
    angle = math.radians(degrees)
    cos, sin = math.cos(angle), math.sin(angle)
    turned = lambda p: [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]] + list(p[2:])
    m = Model(dim, length, stress)
    block = m.box("Block", shape, [3, 2, 2][:dim], [0.0] * dim, [2.0, 1.0, 1.5][:dim], lambda *p: turned(p))
    m.material(block, "strain" if dim == 2 else "3d", YOUNG, POISSON)
    along = lambda p: turned(p) + [0.0] * (3 - dim)

    def support(side, direction):
        part = m.part(block.side_nodes[side])
        m.process("assign_displacement_along_direction_process", {"model_part_name": "Structure." + part, "direction": along(direction)})

    flat = [0.0] * (dim - 2)
    support("y0", [0.0, 1.0] + flat)
    support("x0", [1.0, 0.0] + flat)
    if dim == 3:
        m.fix(block.side_nodes["z0"], z=0.0)
    m.traction(block, "y1", along([0.0, -PRESSED] + flat))
    m.traction(block, "x1", along([0.0, DRAWN] + flat))
    s = solve(m, solver={"residual_relative_tolerance": 1e-13})
    back = lambda v: [cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]]
    return s, {i: back(u) for i, u in s.u(block.nodes).items()}


def run(shape, degrees, **units):
    _, level = motion(shape, 0.0)
    s, found = motion(shape, degrees, **units)
    size = max(abs(c) for u in level.values() for c in u)
    return Outcome(s, {"difference": max(abs(a - b) for i, u in level.items() for a, b in zip(u, found[i])) / size})


CASE = Case(
    "Roller on a slope", "The answer of mechanics is the same in all axes of the space", "ANALYTIC",
    "Two rollers along and across a slope hold a block under pressure and shear. Turned back, its displacements are those on level ground, to "
    "round-off.",
    [Quantity("difference", 0.0, 1e-12, scale=1.0, order=False)], (1,), lambda mesh, **settings: run(**settings),
    variants={"30°": {"shape": "2D4N", "degrees": 30.0}, "triangles": {"shape": "2D6N", "degrees": -50.0}, "hexahedra": {"shape": "3D8N", "degrees": 30.0},
              "tetrahedra": {"shape": "3D10N", "degrees": 100.0}, "millimetres": {"shape": "3D8N", "degrees": 30.0, "length": 1e3, "stress": 1e-6}},
    quick=["30°", "hexahedra"])
