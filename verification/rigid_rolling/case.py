"""A rigid disc and a rigid ball roll down a slope."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

ANGLE, GRAVITY, MASS, RADIUS, END = 0.2, 9.81, 1.0, 1.0, 1.2


def run(n, dim=2, family="ALM frictional", time_step=0.02, length=1.0, stress=1.0):
    m, last = Model(dim, length, stress), dim - 1
    shape, low, high = ("2D4N", [0.0, -0.4], [3.0, 0.0]) if dim == 2 else ("3D8N", [0.0, -0.2, -0.4], [1.0, 0.2, 0.0])
    slope = m.box("Slope", shape, [30 * n, 2 * n - 1] if dim == 2 else [5 * n, 2 * n, n], low, high, element="TotalLagrangianElement")
    law = "KirchhoffSaintVenantPlaneStrain2DLaw" if dim == 2 else "KirchhoffSaintVenant3DLaw"
    weight = stress / length  # of a unit volume where g is one unit of length by s²
    m.material(slope, law, 2e3 if dim == 2 else 4e3, 0.3, DENSITY=1e-3 * weight / length)
    m.fix(slope.side_nodes["xyz"[last] + "0"], *[0.0] * dim)
    share = 0.5 if dim == 2 else 0.4  # of m r²
    mass = MASS * m.force_scale / length
    inertia = share * mass * (RADIUS * length) ** 2
    place = [(0.8 if dim == 2 else 0.3) * length, 0.0, 0.0]
    place[last] = (RADIUS + 1e-3) * length
    contact = m.interface_with_shape(
        (slope, "xyz"[last] + "1"), "Tool", "Centre", shape={"name": "cylinder" if dim == 2 else "sphere", "radius": RADIUS * length},
        position=place, mass=mass, inertia=inertia if dim == 2 else [inertia] * 3, facet_angle=5.0 if dim == 2 else 30.0)
    force = [MASS * GRAVITY * math.sin(ANGLE) * m.force_scale, 0.0, 0.0]
    force[last] = -MASS * GRAVITY * math.cos(ANGLE) * m.force_scale
    m.process("assign_vector_variable_to_conditions_process", {"model_part_name": "Structure.Centre", "variable_name": "POINT_LOAD",
        "value": [f"{f!r}*t/{END}" for f in force], "interval": [0.0, "End"]}, "loads")
    s = solve(m, family, friction=0.6, time_step=time_step, end=END, dynamic={"scheme_type": "newmark"}, contact=contact)
    way = s.number("DISPLACEMENT_X of Structure.Centre") / length
    rolled = abs(s.number(("ROTATION_Z" if dim == 2 else "ROTATION_Y") + " of Structure.Centre"))
    expected = GRAVITY * math.sin(ANGLE) / (1 + share) * END ** 2 / 6
    return Outcome(s, {"way": way / expected, "rotation": rolled * RADIUS / expected})


CASE = Case(
    "Rolling down a slope", "balance of momentum and of its moment about the line of contact: a = g sin α/(1 + J/(m r²)), 2/3 and 5/7 of g sin α", "ANALYTIC",
    "The weight grows with t/T, so that the body does not bounce: it goes a T²/6 and rotates by that over r. The slope is soft, so that contact spans several "
    "cells; its indentation resists rolling by a share of the size of the contact. Values are shares of the closed form.",
    [Quantity("way", 1.0, 0.02, order=False), Quantity("rotation", 1.0, 0.03, order=False)],
    (2, 3), run, size=lambda n: 1 / n,
    variants={"disc": {}, "ball": {"dim": 3}, "disc, half steps": {"time_step": 0.01}, "disc, penalty": {"family": "penalty frictional"},
              "disc, millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["disc"])
