"""Writes rubber_seal.mdpa: a quarter of the section of a round seal below a plate.

    python3 make_mesh.py            (standard library only)

Lengths in mm. The planes x = 0 and y = 0 are symmetry planes; the seal touches the plate at (0, 1)."""
import math

CELLS = 20            # along each side of the square that is mapped to the quarter
PLATE = 6             # cells of the plate

nodes, elements, parts, conditions = [], [], {}, []


def block(name, divisions, place):
    """Quadrilaterals on a grid of the unit square, put at place(u, v); node ids by column and row."""
    first, start = len(nodes) + 1, len(elements) + 1
    across, up = divisions
    nodes.extend(place(i / across, j / up) for j in range(up + 1) for i in range(across + 1))
    ids = [[first + i + j * (across + 1) for j in range(up + 1)] for i in range(across + 1)]
    for j in range(up):
        for i in range(across):
            elements.append((ids[i][j], ids[i + 1][j], ids[i + 1][j + 1], ids[i][j + 1]))
    parts[name] = ([n for column in ids for n in column], list(range(start, len(elements) + 1)), [])
    return ids


def surface(name, rows):
    """Conditions along rows of nodes, in the order that has the body on their left."""
    made = []
    for row in rows:
        for pair in zip(row, row[1:]):
            conditions.append(pair)
            made.append(len(conditions))
    parts[name] = (sorted({n for row in rows for n in row}), [], made)
    return made


seal = block("Seal", (CELLS, CELLS), lambda u, v: (u * math.sqrt(1 - v * v / 2), v * math.sqrt(1 - u * u / 2)))
plate = block("Plate", (PLATE, 1), lambda u, v: (2.0 * u, 1.0 + 0.2 * v))
rim = surface("Rim", [seal[CELLS], [column[CELLS] for column in reversed(seal)]])
face = surface("Face", [[column[0] for column in plate]])
parts["Seal"][2].extend(rim)
parts["Plate"][2].extend(face)
parts["Interface"] = (sorted(parts["Rim"][0] + parts["Face"][0]), [], rim + face)
parts["Middle"] = (seal[0], [], [])
parts["Base"] = ([column[0] for column in seal], [], [])

with open("rubber_seal.mdpa", "w", encoding="ascii") as out:
    out.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
    for i, (x, y) in enumerate(nodes, 1):
        out.write(f"{i} {x:.10g} {y:.10g} 0\n")
    out.write("End Nodes\n\nBegin Elements TotalLagrangianQ1P0MixedElement2D4N\n")
    for i, cell in enumerate(elements, 1):
        out.write(f"{i} 0 {' '.join(map(str, cell))}\n")
    out.write("End Elements\n\nBegin Conditions LineCondition2D2N\n")
    for i, pair in enumerate(conditions, 1):
        out.write(f"{i} 0 {pair[0]} {pair[1]}\n")
    out.write("End Conditions\n")
    for name, lists in parts.items():
        out.write(f"\nBegin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            out.write(f"  Begin SubModelPart{kind}\n" + "".join(f"  {i}\n" for i in ids) + f"  End SubModelPart{kind}\n")
        out.write("End SubModelPart\n")
