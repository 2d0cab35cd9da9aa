#!/usr/bin/env python3
"""Writes bars.mdpa: two bars end to end along x, whose meshes do not match where they touch."""
import os

LENGTHS, HEIGHT, CELLS, ROWS = (1.0, 0.5), 1.0, (8, 6), (7, 10)
nodes, elements, conditions, parts = [], [], [], {}
begin = 0.0
for bar, (name, length) in enumerate(zip(("Left", "Right"), LENGTHS)):
    base, cells, rows = len(nodes), CELLS[bar], ROWS[bar]
    nodes += [(begin + length * i / cells, HEIGHT * j / rows) for i in range(cells + 1) for j in range(rows + 1)]
    node = lambda i, j: base + i * (rows + 1) + j + 1
    own = [(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)) for i in range(cells) for j in range(rows)]
    ids = range(len(elements) + 1, len(elements) + len(own) + 1)
    elements += [(bar + 1, *corners) for corners in own]
    parts[name] = (range(base + 1, len(nodes) + 1), ids, ())
    face, end = (cells, 0) if bar == 0 else (0, cells)
    lines = [(node(face, j), node(face, j + 1))[:: 1 if bar == 0 else -1] for j in range(rows)]
    ids = range(len(conditions) + 1, len(conditions) + len(lines) + 1)
    conditions += [(bar + 1, *line) for line in lines]
    parts[name + "Face"] = ([node(face, j) for j in range(rows + 1)], (), ids)
    parts[name + "End"] = ([node(end, j) for j in range(rows + 1)], (), ())
    begin += length

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "bars.mdpa"), "w") as out:
    out.write("Begin Properties 1\nEnd Properties\nBegin Properties 2\nEnd Properties\nBegin Nodes\n")
    out.writelines(f"{at} {x!r} {y!r} 0.0\n" for at, (x, y) in enumerate(nodes, 1))
    for kind, table in (("Elements Element2D4N", elements), ("Conditions LineCondition2D2N", conditions)):
        out.write(f"End {'Nodes' if table is elements else 'Elements'}\nBegin {kind}\n")
        out.writelines(f"{at} {' '.join(map(str, row))}\n" for at, row in enumerate(table, 1))
    out.write("End Conditions\n")
    for name, lists in parts.items():
        out.write(f"Begin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            out.write(f"Begin SubModelPart{kind}\n{''.join(f'{i}' + chr(10) for i in ids)}End SubModelPart{kind}\n")
        out.write("End SubModelPart\n")
