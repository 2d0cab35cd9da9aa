"""Writes hertz_line_contact.mdpa: half of a roller segment above half of a block, meshed finely around the contact.

    python3 make_mesh.py            (standard library only)

Lengths in mm. The plane x = 0 is the symmetry plane, the block stands on y = 0, the contact starts at (0, BLOCK)."""
import math

RADIUS = 50.0         # of the roller
WIDTH = 25.0          # of the roller segment, from the symmetry plane
HEIGHT = 25.0         # of the roller segment, from the contact to its flat top
BLOCK = 30.0          # width and depth of the block
FINE = 1.3            # extent of the finely meshed strip; the contact reaches to 0.99
ROLLER_SIZE, BLOCK_SIZE = 1.0 / 50.0, 1.0 / 42.0   # elements in the strip: finer on the slave side, not matching
GROWTH = 1.2          # ratio of neighbouring elements outside


def graded(size, fine, end):
    """Stations from 0 to `end`: uniform up to `fine`, then growing by about GROWTH."""
    count = round(fine / size)
    at = [fine * i / count for i in range(count + 1)] if count else [0.0]
    rest = end - at[-1]
    steps = max(1, round(math.log(1.0 + rest / size * (GROWTH - 1.0)) / math.log(GROWTH)))
    low, high = 1.0, 2.0
    for _ in range(80):  # bisection: the growth that ends exactly at `end`
        ratio = 0.5 * (low + high)
        total = size * sum(ratio ** i for i in range(1, steps + 1))
        low, high = (ratio, high) if total < rest else (low, ratio)
    step = size
    for _ in range(steps - 1):
        step *= ratio
        at.append(at[-1] + step)
    return at + [end]


nodes, elements, parts, conditions = [], [], {}, []


def body(name, xs, rows, place):
    """Quadrilaterals on the grid `xs` x `rows`, each grid point put at place(x, row); node ids by row and column."""
    first = len(nodes) + 1
    nodes.extend(place(x, row) for row in rows for x in xs)
    ids = [[first + j * len(xs) + i for i in range(len(xs))] for j in range(len(rows))]
    start = len(elements) + 1
    for below, above in zip(ids, ids[1:]):
        elements.extend((below[i], below[i + 1], above[i + 1], above[i]) for i in range(len(xs) - 1))
    parts[name] = ([i for row in ids for i in row], range(start, len(elements) + 1), [])
    return ids


def edges(body_name, kind, row):
    """Conditions along a row of nodes, in the order that has the body on their left; their ids."""
    made = []
    for pair in zip(row, row[1:]):
        conditions.append((kind, pair))
        made.append(len(conditions))
    parts[body_name][2].extend(made)
    return made


def arc(x):
    return RADIUS - math.sqrt(RADIUS ** 2 - x ** 2)


xs = graded(BLOCK_SIZE, FINE, BLOCK)
block = body("Block", xs, [BLOCK - depth for depth in reversed(graded(BLOCK_SIZE, 0.0, BLOCK))], lambda x, y: (x, y))
xs = graded(ROLLER_SIZE, FINE, WIDTH)
roller = body("Roller", xs, [y / HEIGHT for y in graded(ROLLER_SIZE, 0.0, HEIGHT)],
              lambda x, part: (x, BLOCK + arc(x) + part * (HEIGHT - arc(x))))

reach = 3.0  # contact conditions up to here
upper = [i for i in roller[0] if nodes[i - 1][0] < reach]
lower = [i for i in reversed(block[-1]) if nodes[i - 1][0] < reach]
slave, master = edges("Roller", "LineCondition2D2N", upper), edges("Block", "LineCondition2D2N", lower)
load = edges("Roller", "LineLoadCondition2D2N", roller[-1][::-1])
parts["Symmetry"] = ([row[0] for row in block + roller], (), ())
parts["Bottom"] = (block[0], (), ())
parts["Top"] = (roller[-1], (), load)
parts["RollerSurface"] = (upper, (), slave)
parts["Interface"] = (lower + upper, (), slave + master)

with open("hertz_line_contact.mdpa", "w") as file:
    def rows(ids):
        ids = sorted(ids)
        return "".join(" ".join(map(str, ids[i:i + 20])) + "\n" for i in range(0, len(ids), 20))

    file.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
    file.writelines(f"{i} {x:.9g} {y:.9g} 0\n" for i, (x, y) in enumerate(nodes, 1))
    file.write("End Nodes\n\nBegin Elements SmallDisplacementElement2D4N\n")
    file.writelines(f"{i} 0 {' '.join(map(str, cell))}\n" for i, cell in enumerate(elements, 1))
    file.write("End Elements\n")
    for kind in ("LineCondition2D2N", "LineLoadCondition2D2N"):
        file.write(f"\nBegin Conditions {kind}\n")
        file.writelines(f"{i} 0 {a} {b}\n" for i, (k, (a, b)) in enumerate(conditions, 1) if k == kind)
        file.write("End Conditions\n")
    for name, lists in parts.items():
        file.write(f"\nBegin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            if ids:
                file.write(f"Begin SubModelPart{kind}\n{rows(ids)}End SubModelPart{kind}\n")
        file.write("End SubModelPart\n")
print(f"{len(nodes)} nodes, {len(elements)} elements, {len(slave)} slave and {len(master)} master edges")
