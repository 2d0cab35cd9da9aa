"""A force and a moment on the end of a bar, by their totals."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

FORCE, MOMENT, POINT = (3.0, -5.0, 2.0), (0.7, 11.0, -4.0), (3.0, 0.4, -2.0)


def run(shape, faces=True, length=1.0, stress=1.0):
    dim = int(shape[0])
    m = Model(dim, length, stress)
    bar = m.box("Bar", shape, [3, 2, 2][:dim], [0.0] * dim, [2.0, 1.0, 1.5][:dim], lambda x, y, *z: [x, y - 0.2 * x * x] + [c + 0.1 * x for c in z])
    m.material(bar, "strain" if dim == 2 else "3d", 1e4, 0.3)
    m.fix(bar.side_nodes["x0"], x=0.0, y=0.0, **({"z": 0.0} if dim == 3 else {}))
    made = bar.conditions("x1", "LineLoad" if dim == 2 else "SurfaceLoad") if faces else []
    end = m.part(bar.side_nodes["x1"], made, "End")
    flat = dim == 2
    force = [f * m.force_scale * (not (flat and d == 2)) for d, f in enumerate(FORCE)]
    moment = [f * m.force_scale * length * (not (flat and d < 2)) for d, f in enumerate(MOMENT)]
    point = [p * (not (flat and d == 2)) for d, p in enumerate(POINT)]
    m.process("distribute_resultant_on_part_process", {
        "model_part_name": "Structure." + end, "force": force, "moment": moment, "point": [p * length for p in point]}, "loads")
    s = solve(m)
    held = bar.side_nodes["x0"]
    reactions = s.vector("REACTION", held, -1, m.force_scale)
    off_force, off_moment = [f / m.force_scale for f in force], [f / (m.force_scale * length) for f in moment]
    for i in held:
        r, arm = reactions[i], [a - b for a, b in zip(m.mesh.nodes[i], point)]
        turn = [arm[1] * r[2] - arm[2] * r[1], arm[2] * r[0] - arm[0] * r[2], arm[0] * r[1] - arm[1] * r[0]]
        off_force = [a + b for a, b in zip(off_force, r)]
        off_moment = [a + b for a, b in zip(off_moment, turn)]
    if flat:  # reactions along z and moments about x and y are not there
        off_force[2] = off_moment[0] = off_moment[1] = 0.0
    return Outcome(s, {"force": max(map(abs, off_force)) / 6.2, "moment": max(map(abs, off_moment)) / 11.7})


CASE = Case(
    "Loads by their resultant", "equilibrium", "ANALYTIC",
    "Reactions balance a force and a moment about a distant point that a face bears, whatever its cells, and where a part has nodes alone: to "
    "round-off of the solution. Values are differences over the load.",
    [Quantity("force", 0.0, 1e-12, scale=1.0, order=False), Quantity("moment", 0.0, 1e-12, scale=1.0, order=False)],
    (1,), lambda mesh, **settings: run(**settings),
    variants={"hexahedra": {"shape": "3D8N"}, "hexahedra of second order": {"shape": "3D20N"}, "tetrahedra": {"shape": "3D10N"}, "prisms": {"shape": "3D15N"},
              "nodes alone": {"shape": "3D8N", "faces": False}, "quadrilaterals": {"shape": "2D8N"}, "triangles": {"shape": "2D3N"},
              "millimetres": {"shape": "3D8N", "length": 1e3, "stress": 1e-6}},
    quick=["hexahedra", "quadrilaterals"])
