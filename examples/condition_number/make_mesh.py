"""Writes condition_number.mdpa: a tall punch of hexahedra on a larger block, all of side 1.

    python3 make_mesh.py            (standard library only)

Lengths in m. The block stands on z = 0; the punch covers the middle of its top. Nodes of both meet there, unjoined."""
SIZE = 1.0
BLOCK = (6, 6, 3)      # elements of the block along x, y, z
PUNCH = (2, 2, 25)     # elements of the punch, in the middle of the block's top

nodes, elements, conditions, parts = [], [], [], {}


def body(name, count, corner):
    """Hexahedra of side SIZE from `corner` on; node ids by level, row and column."""
    first, start = len(nodes) + 1, len(elements) + 1
    across = [[c + SIZE * i for i in range(n + 1)] for c, n in zip(corner, count)]
    nodes.extend((x, y, z) for z in across[2] for y in across[1] for x in across[0])
    wide, deep = count[0] + 1, count[1] + 1
    ids = [[[first + (k * deep + j) * wide + i for i in range(wide)] for j in range(deep)] for k in range(count[2] + 1)]
    for low, high in zip(ids, ids[1:]):
        for j in range(count[1]):
            for i in range(count[0]):
                elements.append([plane[j + dj][i + di] for plane in (low, high)
                                 for dj, di in ((0, 0), (0, 1), (1, 1), (1, 0))])
    parts[name] = [range(first, len(nodes) + 1), range(start, len(elements) + 1), []]
    return ids


def faces(name, kind, plane, upward):
    """Conditions on a plane of nodes, normals up or down; their ids, and the ids of the plane's nodes."""
    start = len(conditions) + 1
    for low, high in zip(plane, plane[1:]):
        for i in range(len(low) - 1):
            face = (low[i], low[i + 1], high[i + 1], high[i])
            conditions.append((kind, face if upward else face[::-1]))
    made = range(start, len(conditions) + 1)
    parts[name][2].extend(made)
    return made, [i for row in plane for i in row]


block = body("Block", BLOCK, (0.0, 0.0, 0.0))
punch = body("Punch", PUNCH, tuple(0.5 * SIZE * (b - p) for b, p in zip(BLOCK[:2], PUNCH[:2])) + (SIZE * BLOCK[2],))
slave, slave_nodes = faces("Punch", "SurfaceCondition3D4N", punch[0], False)
master, master_nodes = faces("Block", "SurfaceCondition3D4N", block[-1], True)
load, load_nodes = faces("Punch", "SurfaceLoadCondition3D4N", punch[-1], True)
bottom = [i for row in block[0] for i in row]
# frictionless contact leaves the punch free to slide and to turn: its middle column of nodes is held sideways, and one
# node beside it
middle = [plane[PUNCH[1] // 2][PUNCH[0] // 2] for plane in punch]
parts["Bottom"] = [bottom, (), ()]
parts["Axis"] = [middle, (), ()]
parts["Turn"] = [[punch[-1][PUNCH[1] // 2][-1]], (), ()]
parts["Top"] = [load_nodes, (), load]
parts["PunchFace"] = [slave_nodes, (), slave]
parts["Interface"] = [slave_nodes + master_nodes, (), list(slave) + list(master)]

with open("condition_number.mdpa", "w") as out:
    out.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
    out.writelines(f"{i} {x:g} {y:g} {z:g}\n" for i, (x, y, z) in enumerate(nodes, 1))
    out.write("End Nodes\n\nBegin Elements SmallDisplacementElement3D8N\n")
    out.writelines(f"{i} 0 {' '.join(map(str, cell))}\n" for i, cell in enumerate(elements, 1))
    out.write("End Elements\n")
    for kind in ("SurfaceCondition3D4N", "SurfaceLoadCondition3D4N"):
        out.write(f"\nBegin Conditions {kind}\n")
        out.writelines(f"{i} 0 {' '.join(map(str, face))}\n" for i, (k, face) in enumerate(conditions, 1) if k == kind)
        out.write("End Conditions\n")
    for name, lists in parts.items():
        out.write(f"\nBegin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            if len(ids):
                out.write(f"  Begin SubModelPart{kind}\n")
                out.writelines(f"    {i}\n" for i in sorted(ids))
                out.write(f"  End SubModelPart{kind}\n")
        out.write("End SubModelPart\n")
