"""Writes hertz_sphere.mdpa: a quarter of a spherical cap above a quarter of a block, meshed finely around the contact.

    python3 make_mesh.py            (standard library only)

Lengths in mm. x = 0 and y = 0 are symmetry planes, the block stands on z = 0, the contact starts at (0, 0, BLOCK)."""
import math

RADIUS = 50.0                  # of the sphere
WIDTH = HEIGHT = 14.0          # of the cap
BLOCK = 14.0                   # width, depth and height of the block
FINE = 1.2                     # extent of the finely meshed square; the contact reaches to 1
CAP_SIZE, BLOCK_SIZE = 0.15, 0.133
GROWTH = 1.7                   # ratio of neighbouring elements outside


def graded(size, fine, end):
    """Stations from 0 to `end`: uniform up to `fine`, then growing by about GROWTH."""
    count = round(fine / size)
    at = [fine * i / count for i in range(count + 1)] if count else [0.0]
    rest = end - at[-1]
    steps = max(1, round(math.log(1.0 + rest / size * (GROWTH - 1.0)) / math.log(GROWTH)))
    low, high = 1.0, 3.0
    for _ in range(80):  # bisection: the growth that ends exactly at `end`
        ratio = 0.5 * (low + high)
        total = size * sum(ratio ** i for i in range(1, steps + 1))
        low, high = (ratio, high) if total < rest else (low, ratio)
    step = size
    for _ in range(steps - 1):
        step *= ratio
        at.append(at[-1] + step)
    return at + [end]


nodes, elements, conditions, parts = [], [], [], {}


def body(name, across, levels, place):
    """Hexahedra on the grid across x across x levels; node ids by level, row and column."""
    n, first, start = len(across), len(nodes) + 1, len(elements) + 1
    nodes.extend(place(x, y, level) for level in levels for y in across for x in across)
    ids = [[[first + (k * n + j) * n + i for i in range(n)] for j in range(n)] for k in range(len(levels))]
    for low, high in zip(ids, ids[1:]):
        for j in range(n - 1):
            for i in range(n - 1):
                elements.append([plane[j + dj][i + di] for plane in (low, high)
                                 for dj, di in ((0, 0), (0, 1), (1, 1), (1, 0))])
    parts[name] = [range(first, len(nodes) + 1), range(start, len(elements) + 1), []]
    return ids


def faces(body_name, kind, plane, upward, reach=math.inf):
    """Conditions on a plane of nodes within `reach` of the axis, normals up or down; their ids and nodes."""
    start, used = len(conditions) + 1, set()
    for j in range(len(plane) - 1):
        for i in range(len(plane) - 1):
            face = (plane[j][i], plane[j][i + 1], plane[j + 1][i + 1], plane[j + 1][i])
            if max(max(nodes[f - 1][:2]) for f in face) < reach:
                conditions.append((kind, face if upward else face[::-1]))
                used.update(face)
    made = range(start, len(conditions) + 1)
    parts[body_name][2].extend(made)
    return made, used


def cap(x, y):
    return RADIUS - math.sqrt(RADIUS ** 2 - x ** 2 - y ** 2)


block = body("Block", graded(BLOCK_SIZE, FINE, BLOCK), [BLOCK - d for d in reversed(graded(BLOCK_SIZE, 0.0, BLOCK))],
             lambda x, y, z: (x, y, z))
sphere = body("Sphere", graded(CAP_SIZE, FINE, WIDTH), [z / HEIGHT for z in graded(CAP_SIZE, 0.0, HEIGHT)],
              lambda x, y, part: (x, y, BLOCK + cap(x, y) + part * (HEIGHT - cap(x, y))))
slave, slave_nodes = faces("Sphere", "SurfaceCondition3D4N", sphere[0], False, 2.5)
master, master_nodes = faces("Block", "SurfaceCondition3D4N", block[-1], True, 2.5)
load, load_nodes = faces("Sphere", "SurfaceLoadCondition3D4N", sphere[-1], True)
flat = lambda plane: [i for row in plane for i in row]
parts["SymmetryX"] = [[row[0] for ids in (block, sphere) for plane in ids for row in plane], (), ()]
parts["SymmetryY"] = [[i for ids in (block, sphere) for plane in ids for i in plane[0]], (), ()]
parts["Bottom"] = [flat(block[0]), (), ()]
parts["Top"] = [load_nodes, (), load]
parts["SphereSurface"] = [slave_nodes, (), slave]
parts["Interface"] = [slave_nodes | master_nodes, (), [*slave, *master]]

with open("hertz_sphere.mdpa", "w") as file:
    def rows(ids):
        ids = sorted(ids)
        return "".join(" ".join(map(str, ids[i:i + 20])) + "\n" for i in range(0, len(ids), 20))

    file.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
    file.writelines(f"{i} {x:.8g} {y:.8g} {z:.8g}\n" for i, (x, y, z) in enumerate(nodes, 1))
    file.write("End Nodes\n\nBegin Elements SmallDisplacementElement3D8N\n")
    file.writelines(f"{i} 0 {' '.join(map(str, cell))}\n" for i, cell in enumerate(elements, 1))
    file.write("End Elements\n")
    for kind in ("SurfaceCondition3D4N", "SurfaceLoadCondition3D4N"):
        file.write(f"\nBegin Conditions {kind}\n")
        file.writelines(f"{i} 0 {' '.join(map(str, face))}\n" for i, (k, face) in enumerate(conditions, 1) if k == kind)
        file.write("End Conditions\n")
    for name, lists in parts.items():
        file.write(f"\nBegin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            if ids:
                file.write(f"Begin SubModelPart{kind}\n{rows(ids)}End SubModelPart{kind}\n")
        file.write("End SubModelPart\n")
print(f"{len(nodes)} nodes, {len(elements)} elements, {len(slave)} slave and {len(master)} master faces")
