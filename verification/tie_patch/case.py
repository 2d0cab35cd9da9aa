"""Two bodies of unlike meshes tied along an oblique cut, pulled and sheared."""
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain, solid
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, PULL = 1e6, 0.3, 1e3


def run(n, family="tie", shapes=("2D4N", "2D4N"), slave="upper", rise=0.3, finer=1, symmetry=False, turn=0.0, **units):
    """With `symmetry` the tie ends on a plane of symmetry whose nodes both sides hold."""
    dim = int(shapes[0][0])
    m, up, last = Model(dim, turn=turn, axis=(0.0, 0.0, 1.0) if dim == 2 else (1.0, 2.0, 0.5), **units), "xyz"[dim - 1], dim - 1
    cut = lambda p: 0.5 + rise * p[0]
    low = m.box("Lower", shapes[0], [n] * last + [2], [0.0] * dim, [1.0] * dim, lambda *p: (*p[:last], p[last] * cut(p)))
    top = m.box("Upper", shapes[1], [n + finer] * last + [2], [0.0] * last + [1.0], [1.0] * last + [2.0],
                lambda *p: (*p[:last], cut(p) + (p[last] - 1.0) * (1.5 - cut(p))))
    for body in (low, top):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
    gradient = plane_strain(YOUNG, POISSON, 0.0, PULL) if dim == 2 else solid(YOUNG, POISSON, 0.0, 0.0, PULL)
    if symmetry:
        for axis in "xyz"[:last]:
            m.roll(low.side_nodes[axis + "0"] + top.side_nodes[axis + "0"], **{axis: 0.0})
        m.roll(low.side_nodes[up + "0"], **{up: 0.0})
        m.traction(top, up + "1", [0.0] * last + [PULL])
    else:
        for i in sorted(set(low.side_nodes[up + "0"]) | set(top.side_nodes[up + "1"])):
            at = m.mesh.nodes[i]
            m.fix([i], *[sum(gradient[r][c] * at[c] for c in range(dim)) for r in range(dim)], *[None] * (3 - dim))
    sides = [(top, up + "0"), (low, up + "1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, solver={"residual_relative_tolerance": 1e-9})
    return Outcome(s, {"strain error": max(affine_error(s, b, gradient) for b in (low, top))})


CUBES = {"shapes": ("3D8N", "3D8N")}
CASE = Case(
    "Patch test: tied meshes", "the patch test of mesh tying (Puso and Laursen, IJNME 62, 2005; Park, Felippa and Rebel 2002)", "ANALYTIC",
    "Stress is uniform and displacement affine, which tying by mortars reproduces; the tolerance is that of the solution of the equations.",
    [Quantity("strain error", 0.0, 1e-8, scale=1.0, order=False)],
    (2, 5), run, size=lambda n: 1 / n,
    variants={"multipliers": {}, "coarser side as slave": {"slave": "lower"}, "twice as fine": {"finer": 3}, "matching": {"finer": 0},
              "triangles": {"shapes": ("2D3N", "2D3N")}, "turned by 33°": {"turn": 33.0}, "hexahedra": CUBES, "tetrahedra on hexahedra": {"shapes": ("3D8N", "3D4N")},
              "hexahedra turned in space": {**CUBES, "turn": 50.0}, "ends on symmetry planes": {"symmetry": True},
              "ends on symmetry planes, matching": {"symmetry": True, "finer": 0}, "ends on symmetry planes, hexahedra": {**CUBES, "symmetry": True},
              "constraints": {"family": "MPC tie"}, "constraints, matching": {"family": "MPC tie", "finer": 0}, "constraints, hexahedra": {**CUBES, "family": "MPC tie"},
              "constraints, ends on symmetry planes": {"family": "MPC tie", "symmetry": True}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["multipliers", "hexahedra", "constraints, matching", "ends on symmetry planes"])
