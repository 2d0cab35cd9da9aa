"""Writes shrink_fit.mdpa: a quarter of two rings that overlap by the interference.

    python3 make_mesh.py            (standard library only)

Lengths in mm; the rings' axis is the origin, x = 0 and y = 0 are symmetry planes. Both rings have as many elements
around: of two polygons with different corners, the corners and not the circles would decide where they touch."""
import math

INNER, JOINT, OUTER, INTERFERENCE = 20.0, 50.0, 80.0, 0.2
RINGS = {  # name: inner radius, outer radius, elements around a quarter, elements across
    "Shaft": (INNER, JOINT + INTERFERENCE, 60, 12),
    "Hub": (JOINT, OUTER, 60, 10),
}

nodes, elements, conditions, parts = [], [], [], {}
rings = {}
for name, (low, high, around, across) in RINGS.items():
    first, start = len(nodes) + 1, len(elements) + 1
    for j in range(across + 1):
        r = low * (high / low) ** (j / across)
        for i in range(around + 1):
            angle = 0.5 * math.pi * i / around
            nodes.append((r * math.cos(angle) if i < around else 0.0, r * math.sin(angle)))
    ids = [[first + j * (around + 1) + i for i in range(around + 1)] for j in range(across + 1)]
    for inside, outside in zip(ids, ids[1:]):
        elements += [(inside[i], outside[i], outside[i + 1], inside[i + 1]) for i in range(around)]
    rings[name] = ids
    parts[name] = [sum(ids, []), range(start, len(elements) + 1), []]


def edges(name, row):
    """Line conditions along a row of nodes, with the body on their left; their ids."""
    start = len(conditions) + 1
    conditions.extend(zip(row, row[1:]))
    parts[name][2] = range(start, len(conditions) + 1)
    return parts[name][2]


shaft, hub = rings["Shaft"][-1], rings["Hub"][0]
slave, master = edges("Shaft", shaft), edges("Hub", hub[::-1])
parts["ShaftSurface"] = [shaft, (), slave]
parts["Interface"] = [shaft + hub, (), [*slave, *master]]
parts["SymmetryX"] = [[row[-1] for ids in rings.values() for row in ids], (), ()]
parts["SymmetryY"] = [[row[0] for ids in rings.values() for row in ids], (), ()]
parts["Bore"] = [rings["Shaft"][0], (), ()]
parts["Rim"] = [rings["Hub"][-1], (), ()]

with open("shrink_fit.mdpa", "w") as file:
    def rows(ids):
        ids = sorted(ids)
        return "".join(" ".join(map(str, ids[i:i + 20])) + "\n" for i in range(0, len(ids), 20))

    file.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
    file.writelines(f"{i} {x:.12g} {y:.12g} 0\n" for i, (x, y) in enumerate(nodes, 1))
    file.write("End Nodes\n\nBegin Elements SmallDisplacementElement2D4N\n")
    file.writelines(f"{i} 0 {' '.join(map(str, cell))}\n" for i, cell in enumerate(elements, 1))
    file.write("End Elements\n\nBegin Conditions LineCondition2D2N\n")
    file.writelines(f"{i} 0 {a} {b}\n" for i, (a, b) in enumerate(conditions, 1))
    file.write("End Conditions\n")
    for name, lists in parts.items():
        file.write(f"\nBegin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            if ids:
                file.write(f"Begin SubModelPart{kind}\n{rows(ids)}End SubModelPart{kind}\n")
        file.write("End SubModelPart\n")
print(f"{len(nodes)} nodes, {len(elements)} elements, {len(slave)} slave and {len(master)} master edges")
