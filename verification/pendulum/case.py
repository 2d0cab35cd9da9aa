"""A compound pendulum, released level: a rigid body with mass and inertia that hangs on a reference node."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

MASS, ARM, INERTIA, GRAVITY = 2.0, 0.5, 0.3, 9.81
FREQUENCY = math.sqrt(MASS * GRAVITY * ARM / (INERTIA + MASS * ARM ** 2))
QUARTER = 1.854074677301372 / FREQUENCY  # K(sin 45°)
SPEED = math.sqrt(2.0) * FREQUENCY


def run(steps, shape="2D4N", scheme="newmark"):
    dim = int(shape[0])
    m = Model(dim)
    body = m.box("Body", shape, [1] * dim, [0.0] * dim, [1.0] * dim, element="TotalLagrangianElement")
    law = "KirchhoffSaintVenantPlaneStrain2DLaw" if dim == 2 else "KirchhoffSaintVenant3DLaw"
    m.material(body, law, 100.0, 0.3, DENSITY=0.0)
    m.process("kinematic_coupling_process", {
        "model_part_name": "Structure." + m.part(body.nodes), "reference_model_part_name": "Structure.Pin", "reference_point": [0.0] * 3,
        "mass": MASS, "centre_of_mass": [ARM, 0.0, 0.0], "inertia": INERTIA if dim == 2 else [0.1, 0.25, INERTIA]})

    def assign(variable, value, held=False, end="End"):
        m.process("assign_vector_variable_process", {"model_part_name": "Structure.Pin", "variable_name": variable,
            "constrained": [held] * 3, "value": value, "interval": [0.0, end]})

    assign("DISPLACEMENT", [0.0] * 3, True)
    assign("VOLUME_ACCELERATION", [0.0, -GRAVITY, 0.0])
    assign("ANGULAR_ACCELERATION", [0.0, 0.0, -FREQUENCY ** 2], end=0.0)
    s = solve(m, steps=steps, end=QUARTER, dynamic={"time_integration_method": "implicit", "scheme_type": scheme, "max_iteration": 60})
    return Outcome(s, {"angle at the bottom": s.number("ROTATION_Z of Structure.Pin") / (math.pi / 2)})


CASE = Case(
    "Compound pendulum", "L. D. Landau, E. M. Lifshitz, Mechanics, § 11", "ANALYTIC",
    "A body of mass m and inertia J about its centre, at a distance s from the pin, is released at a right angle. It passes its lowest point after "
    "√((J + m s²)/(m g s)) K(sin 45°); the angle there is −90°. The schemes are of second order.",
    [Quantity("angle at the bottom", -1.0, {"": (6e-3, 1.5e-3, 4e-4), "Bossak": (9e-3, 2.5e-3, 6e-4)})], (20, 40, 80), run, size=lambda n: 1 / n,
    variants={"Newmark, in the plane": {}, "Newmark, in space": {"shape": "3D8N"}, "Bossak": {"scheme": "bossak"}, "generalised α": {"scheme": "generalized_alpha"}},
    quick=["Newmark, in the plane"])
