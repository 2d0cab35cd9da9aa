"""A copper bar hits a rigid wall at 227 m/s: a quarter in space, by tetrahedra that do not lock."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import mean
from lib.model import Model
from lib.solution import solve

LENGTH, RADIUS, SPEED, END = 32.4, 3.2, 0.227, 80.0  # mm, µs, g: stress in units of 1000 GPa
YOUNG, POISSON, YIELD, HARDENING, DENSITY = 0.117, 0.35, 4e-4, 1e-4, 8.93e-3


def disc(x, y):
    """The unit square to a quarter of the unit disc."""
    return x * math.sqrt(1 - 0.5 * y * y), y * math.sqrt(1 - 0.5 * x * x)


def run(n, family="ALM", steps=80, dynamic=None):
    m = Model(3)
    shape = lambda x, y, z: (*(RADIUS * c for c in disc(x, y)), z)
    bar = m.box("Bar", "3D4N", [n, n, 5 * n], [0.0, 0.0, 0.0], [1.0, 1.0, LENGTH], shape, element="TotalLagrangianMixedVolumetricStrainElement")
    wall = m.box("Wall", "3D8N", [2, 2, 1], [-1.0, -1.0, -1.0], [3 * RADIUS, 3 * RADIUS, 0.0])
    strains = [0.0, 10.0]
    m.material(bar, "FiniteStrainIsotropicPlasticity3DVonMisesVonMises", YOUNG, POISSON, DENSITY=DENSITY, HARDENING_CURVE=6, YIELD_STRESS=YIELD,
               EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE=[YIELD + HARDENING * e for e in strains],
               PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE=strains)
    m.material(wall, "3d", YOUNG, POISSON, DENSITY=DENSITY)
    m.fix(wall.nodes, x=0.0, y=0.0, z=0.0)
    m.roll(bar.side_nodes["x0"], x=0.0)
    m.roll(bar.side_nodes["y0"], y=0.0)
    m.velocity(bar.nodes, (0.0, 0.0, -SPEED))
    m.interface((bar, "z0"), (wall, "z1"))
    s = solve(m, family, time_step=END / steps, end=END, dynamic=dynamic or {}, variables=("DISPLACEMENT", "VELOCITY"))
    u, at = s.u(bar.nodes), m.mesh.nodes
    rim = [i for i in bar.side_nodes["z0"] if abs(math.hypot(*at[i][:2]) - RADIUS) < 1e-9]
    height = lambda side: mean(at[i][2] + u[i][2] for i in bar.side_nodes[side])
    return Outcome(s, {"final length": height("z1") - height("z0"),
                       "final radius of the foot": mean(math.hypot(at[i][0] + u[i][0], at[i][1] + u[i][1]) for i in rim)})


CASE = Case(
    "Taylor bar", "G. I. Taylor 1948; as computed by Kamoulakos 1990, Zhu and Cescotto 1995, Camacho and Ortiz 1997: length 21.42 to 21.47 mm, radius "
    "6.89 to 7.24 mm", "EXTERNAL", "Published programs differ by 0.3 % in length and 5 % in radius; the foot flattens to a rim that coarse elements do not resolve.",
    [Quantity("final length", 21.44, (0.03, 0.02), "mm"), Quantity("final radius of the foot", 7.05, (0.25, 0.15), "mm")],
    (3, 4), run, size=lambda n: 1 / n, variants={"default scheme": {}}, quick=False, slow=True)
