"""A ring that is stiffer around than across, under inner pressure."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.shapes import polar
from lib.solution import solve

INNER, OUTER, PRESSURE, RADIAL, HOOP, POISSON = 1.0, 2.0, 0.01, 1e4, 4e4, 0.1


def exact(r):
    """u = A r^k + B r^−k with k = √(E_θ/E_r), and the radial stress."""
    k = math.sqrt(HOOP / RADIAL)
    factor = 1 - POISSON ** 2 * HOOP / RADIAL
    c, d = RADIAL / factor, POISSON * HOOP / factor
    stress = lambda power, r: (c * power + d) * r ** (power - 1)
    determinant = stress(k, INNER) * stress(-k, OUTER) - stress(-k, INNER) * stress(k, OUTER)
    a, b = -PRESSURE * stress(-k, OUTER) / determinant, PRESSURE * stress(k, OUTER) / determinant
    return a * r ** k + b * r ** -k


def run(n, shape="2D8N", length=1.0, stress=1.0):
    m = Model(2, length, stress)
    ring = m.box("Ring", shape, [n, n], [INNER, 0.0], [OUTER, math.pi / 2], polar)
    m.materials.append({"model_part_name": "Structure.Ring", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElasticOrthotropic2DLaw"}, "Tables": {},
        "Variables": {"YOUNG_MODULUS_X": RADIAL * stress, "YOUNG_MODULUS_Y": HOOP * stress, "POISSON_RATIO_XY": POISSON,
                      "SHEAR_MODULUS_XY": 5e3 * stress, "THICKNESS": 1.0}}})
    m.process("set_cylindrical_local_axes_process", {
        "model_part_name": "Structure", "cylindrical_generatrix_axis": [0.0, 0.0, 1.0], "cylindrical_generatrix_point": [0.0, 0.0, 0.0]})
    m.fix(ring.side_nodes["y0"], y=0.0)
    m.fix(ring.side_nodes["y1"], x=0.0)
    m.pressure(ring, "x0", PRESSURE)
    s = solve(m)
    u = s.u(ring.side_nodes["y0"])
    at = {round(m.mesh.nodes[i][0], 9): u[i][0] for i in u}
    return Outcome(s, {"inner radius": at[INNER] / exact(INNER), "outer radius": at[OUTER] / exact(OUTER)})


CASE = Case(
    "Orthotropic ring under pressure", "S. G. Lekhnitskii, Anisotropic Plates, § 25", "ANALYTIC",
    "A ring in plane stress with E_θ = 4 E_r widens by A r² + B r⁻². Axes of the material are constant in an element, an error of second "
    "order in its angle. Values are shares of the closed form.",
    [Quantity(name, 1.0, (2e-2, 5e-3, 1.5e-3)) for name in ("inner radius", "outer radius")],
    (6, 12, 24), run, size=lambda n: 1 / n,
    variants={"eight nodes": {}, "four nodes": {"shape": "2D4N"}, "six nodes": {"shape": "2D6N"}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["eight nodes"])
