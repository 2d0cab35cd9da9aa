"""Two bodies of distorted cells in a state of uniform stress: pressure across the interface and tension along it."""
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain, solid
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

PRESSURE, ALONG = 1e3, 400.0
LOWER, UPPER = (1e6, 0.3), (1e6, 0.3)


def run(n, family="ALM", shape="2D4N", friction=None, turn=0.0, **units):
    dim = int(shape[0])
    m, up, last = Model(dim, turn=turn, axis=(0.0, 0.0, 1.0) if dim == 2 else (1.0, 2.0, 0.5), **units), "xyz"[dim - 1], dim - 1
    low = m.box("Lower", shape, [n] * last + [n], [0.0] * last + [-1.0], [1.0] * last + [0.0], distortion=0.2)
    top = m.box("Upper", shape, [n + 1] * last + [n], [0.0] * dim, [1.0] * dim, distortion=0.2)
    for body, (young, poisson) in ((low, LOWER), (top, UPPER)):
        m.material(body, "3d" if dim == 3 else "strain", young, poisson)
    gradient = plane_strain(*LOWER, ALONG, -PRESSURE) if dim == 2 else solid(*LOWER, ALONG, ALONG, -PRESSURE)
    # the outside follows the uniform field, so that a turned body needs no inclined support
    outside = set(low.side_nodes[up + "0"]) | set(top.side_nodes[up + "1"])
    for axis in "xyz"[:last]:
        for end in "01":
            outside |= {i for b, contact in ((low, up + "1"), (top, up + "0")) for i in b.side_nodes[axis + end] if i not in b.side_nodes[contact]}
    for i in sorted(outside):
        at = m.mesh.nodes[i]
        u = [sum(gradient[r][c] * at[c] for c in range(dim)) for r in range(dim)]
        m.fix([i], *u, *[None] * (3 - dim))
    m.interface((top, up + "0"), (low, up + "1"))
    # a frictionless interface leaves the two rims to slide along: they carry the uniform tension
    for body in (low, top):
        for d, axis in enumerate("xyz"[:last]):
            for end, sign in (("0", -1.0), ("1", 1.0)):
                v = [0.0] * dim
                v[d] = sign * ALONG
                m.traction(body, axis + end, v)
    tight = {} if family.startswith("MPC") else {"contact_residual_relative_tolerance": 1e-9}
    s = solve(m, family, friction=friction, solver={"residual_relative_tolerance": 1e-9}, settings=tight)
    values = {"strain error": max(affine_error(s, b, gradient) for b in (low, top))}
    if not family.startswith("MPC"):
        stretch = 1 + gradient[0][0] + (gradient[1][1] if dim == 3 else 0.0)
        values["pressure error"] = max(abs(p / PRESSURE * stretch - 1.0) for p in s.pressure().values())
    return Outcome(s, values)


CUBES = {"shape": "3D8N"}
CASE = Case(
    "Patch test: distorted cells, pressed and stretched", "N. El-Abbasi, K. J. Bathe, Stability and patch test performance of contact "
    "discretizations, Computers & Structures 79 (2001)", "ANALYTIC",
    "Stress is uniform and displacement affine; the tolerance is that of the iteration, for Uzawa's that of its multipliers; penalties yield by 1e-4 of an element.",
    [Quantity(name, 0.0, {"": tolerance, "Uzawa": 2e-4, **dict.fromkeys(("penalty", "perturbed", "hexahedra turned, penalty"), 1e-4)}, scale=1.0, order=False)
     for name, tolerance in (("strain error", 1e-7), ("pressure error", 1e-5))],
    (2, 4), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "ALM frictional": {"family": "ALM frictional", "friction": 0.3},
              "turned by 33°": {"turn": 33.0}, "turned by 33°, frictional": {"turn": 33.0, "family": "ALM frictional", "friction": 0.3},
              "triangles turned": {"shape": "2D3N", "turn": 20.0},
              "hexahedra": CUBES, "hexahedra turned in space": {**CUBES, "turn": 40.0}, "tetrahedra turned in space": {"shape": "3D4N", "turn": 40.0},
              "hexahedra turned, frictional": {**CUBES, "turn": 40.0, "family": "ALM frictional", "friction": 0.3},
              "hexahedra turned, MPC": {**CUBES, "turn": 40.0, "family": "MPC"}, "hexahedra turned, penalty": {**CUBES, "turn": 40.0, "family": "penalty"}},
    quick=["ALM", "turned by 33°", "hexahedra turned in space", "hexahedra turned, frictional"])
