"""Unlike meshes in ratios from 1:2 to 7:3, each side as slave, 2D and 3D: a confined stack of unlike materials under pressure."""
from deck import oedometer
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

LOWER, UPPER, PRESSURE = (2e6, 0.3), (1e6, 0.2), 1e4


def run(n, family="ALM", slave="upper", shapes=("2D4N", "2D4N"), friction=None, **units):
    dim = int(shapes[0][0])
    m, up, last = Model(dim, **units), "xyz"[dim - 1], dim - 1
    low = m.box("Lower", shapes[0], [n] * last + [2], [0.0] * dim, [1.0] * dim)
    top = m.box("Upper", shapes[1], [2 * n + 1 if n < 4 else n // 2 + 1] * last + [2], [0.0] * last + [1.0], [1.0] * last + [2.0])
    for body, (young, poisson) in ((low, LOWER), (top, UPPER)):
        m.material(body, "3d" if dim == 3 else "strain", young, poisson)
    m.roll(low.side_nodes[up + "0"], **{up: 0.0})
    for axis in "xyz"[:last]:
        ids = [i for b in (low, top) for end in "01" for i in b.side_nodes[axis + end]]
        m.roll(ids, **{axis: 0.0})
    m.traction(top, up + "1", [0.0] * last + [-PRESSURE])
    sides = [(top, up + "0"), (low, up + "1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    tight = {} if family.startswith("MPC") else {"contact_residual_relative_tolerance": 1e-9}
    s = solve(m, family, friction=friction, solver={"residual_relative_tolerance": 1e-9}, settings=tight)

    def gradient(material):
        return [[-PRESSURE / oedometer(*material) if r == c == last else 0.0 for c in range(dim)] for r in range(dim)]
    values = {"strain error": max(affine_error(s, b, gradient(mat)) for b, mat in ((low, LOWER), (top, UPPER)))}
    if not family.startswith("MPC"):
        values["pressure error"] = max(abs(p / PRESSURE - 1.0) for p in s.pressure().values())
    return Outcome(s, values)


CUBES = {"shapes": ("3D8N", "3D8N")}
CASE = Case(
    "Patch test: unlike meshes, either side as slave", "M. A. Crisfield, Re-visiting the contact patch test, IJNME 48 (2000)", "ANALYTIC",
    "Confined blocks have uniform pressure and affine displacement, which a mortar method reproduces; the tolerance is that of the iteration, for Uzawa's that of its multipliers.",
    [Quantity("strain error", 0.0, {"": 1e-7, "Uzawa": 2e-4, "hexahedra, Uzawa": 2e-4}, scale=1.0, order=False), Quantity("pressure error", 0.0, {"": 1e-7, "Uzawa": 2e-4, "hexahedra, Uzawa": 2e-4}, scale=1.0, order=False)],
    (2, 5), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "lower as slave": {"slave": "lower"},
              "ALM frictional": {"family": "ALM frictional", "friction": 0.3},
              "triangles on quadrilaterals": {"shapes": ("2D4N", "2D3N")}, "hexahedra": CUBES, "hexahedra, lower as slave": {**CUBES, "slave": "lower"},
              "hexahedra, frictional": {**CUBES, "family": "ALM frictional", "friction": 0.3},
              "tetrahedra on hexahedra": {"shapes": ("3D8N", "3D4N")}, "prisms on tetrahedra": {"shapes": ("3D4N", "3D6N")},
              "hexahedra, penalty": {**CUBES, "family": "penalty"}, "hexahedra, MPC": {**CUBES, "family": "MPC"},
              "hexahedra, Uzawa": {**CUBES, "family": "Uzawa"}, "millimetres": {"length": 1e3, "stress": 1e-6},
              "hexahedra, micrometres": {**CUBES, "length": 1e6, "stress": 1e-12}},
    quick=["ALM", "hexahedra", "tetrahedra on hexahedra", "millimetres"])
