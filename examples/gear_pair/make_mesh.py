"""Writes gear_pair.mdpa: a pinion and a wheel with involute teeth that touch at the pitch point.

    python3 make_mesh.py            (standard library only)

Lengths in mm. The centres lie on the x axis, the pitch point at (40, 0). Flanks below the base circle are radial, without fillets."""
import math

MODULE, ANGLE = 4.0, math.radians(20.0)
TEETH = {"Pinion": 20, "Wheel": 30}
BORE = {"Pinion": 15.0, "Wheel": 25.0}
FINE = 0.06           # cells of the flanks in contact at the pitch point
ZONE = 0.7            # along the flank on both sides of the pitch point, in cells of that size
GROWTH = 1.25         # of cells beyond it
BACKLASH = 0.3        # by which each tooth is thinner than half a pitch, so that the other flanks do not touch

nodes, elements, parts, conditions, known = [], [], {}, [], {}


def involute(angle):
    return math.tan(angle) - angle


def graded(size, length):
    """Places from 0 to `length`, whose first cell has about this size and which grow."""
    out, step = [0.0], size
    while out[-1] < length:
        out.append(out[-1] + step)
        step *= GROWTH
    return [place * length / out[-1] for place in out]


def node(place):
    """The node at a place, one for all cells of a body."""
    key = tuple(round(x, 7) for x in place)
    if key not in known:
        nodes.append(place)
        known[key] = len(nodes)
    return known[key]


def grid(rows, place):
    """Quadrilaterals between rows of nodes; `place` turns radius and angle into a place."""
    ids = [[node(place(*point)) for point in row] for row in rows]
    for low, high in zip(ids, ids[1:]):
        for at in range(len(low) - 1):
            cell = (low[at], high[at], high[at + 1], low[at + 1])
            corners = [nodes[i - 1] for i in cell]
            double = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))
            elements.append(cell if double > 0 else cell[::-1])
    return ids


def gear(name):
    """A gear; gives the nodes of the flank that touches, from the root to the tip, and those of the bore."""
    known.clear()
    count, first, first_node = TEETH[name], len(elements) + 1, len(nodes) + 1
    pitch = MODULE * count / 2
    base, root, tip = pitch * math.cos(ANGLE), pitch - 1.25 * MODULE, pitch + MODULE
    is_wheel = name == "Wheel"

    def place(radius, angle):
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        return (100.0 - x, y) if is_wheel else (x, y)

    def half(radius):
        """Half the angle of a tooth at a radius."""
        turned = 0.0 if radius <= base else involute(math.acos(base / radius))
        return (math.pi * pitch / count - BACKLASH) / (2 * pitch) + involute(ANGLE) - turned

    def toward(end):
        """Radii from the zone around the pitch point to the root or the tip."""
        length = abs(end - pitch) - ZONE
        sign = math.copysign(1.0, end - pitch)
        return [pitch + sign * (ZONE + own) for own in graded(FINE, length)]

    cells = round(2 * ZONE / FINE)
    zone = [pitch - ZONE + 2 * ZONE * i / cells for i in range(1, cells)]
    fine_radii = toward(root)[::-1] + zone + toward(tip)
    fine_shares = [1.0 - 2.0 * own for own in graded(FINE / (2 * pitch * half(pitch)), 1.0)]
    coarse_radii = [root + (tip - root) * i / 6 for i in range(7)]
    coarse_shares = [1.0 - 2.0 * i / 4 for i in range(5)]
    depths = [BORE[name] + (root - BORE[name]) * own / 14 for own in (0, 3, 6, 8.5, 10.5, 12, 13.2, 14)]
    flank, bore = [], []
    for tooth in range(count):
        # the flank of the first tooth at larger angles of the pinion, and of the wheel at smaller ones, passes through the pitch point
        sign = -1.0 if is_wheel else 1.0
        centre = 2 * math.pi * tooth / count - sign * half(pitch)
        radii, shares = (fine_radii, fine_shares) if tooth == 0 else (coarse_radii, coarse_shares)
        rows = [[(r, centre + sign * s * half(r)) for s in shares] for r in radii]
        ids = grid(rows, place)
        if tooth == 0:
            flank = [row[0] for row in ids]
        # below the tooth and below half the gap on each side of it
        gap = math.pi / count - half(root)
        beside = [sign * (half(root) + gap * own / 3) for own in (3, 2, 1)]
        below = beside + [sign * s * half(root) for s in shares] + [-own for own in beside[::-1]]
        ids = grid([[(r, centre + angle) for angle in below] for r in depths], place)
        bore += ids[0]
    parts[name] = (range(first_node, len(nodes) + 1), range(first, len(elements) + 1), ())
    return flank, bore


def surface(name, chain):
    """Conditions along nodes, with the body on their left."""
    made = range(len(conditions) + 1, len(conditions) + len(chain))
    conditions.extend(zip(chain, chain[1:]))
    parts[name] = (chain, (), made)


for name in TEETH:
    flank, bore = gear(name)
    # from root to tip the pinion's tooth is on the right of its flank, below it; the wheel's, above it, too: the way goes to smaller x
    surface(f"{name}Flank", flank[::-1])
    parts[f"{name}Bore"] = (bore, (), ())

with open("gear_pair.mdpa", "w", encoding="ascii") as out:
    out.write("Begin Properties 0\nEnd Properties\nBegin Nodes\n")
    out.writelines(f"{i} {x:.10g} {y:.10g} 0\n" for i, (x, y) in enumerate(nodes, 1))
    out.write("End Nodes\nBegin Elements SmallDisplacementElement2D4N\n")
    out.writelines(f"{i} 0 {' '.join(map(str, cell))}\n" for i, cell in enumerate(elements, 1))
    out.write("End Elements\nBegin Conditions LineCondition2D2N\n")
    out.writelines(f"{i} 0 {a} {b}\n" for i, (a, b) in enumerate(conditions, 1))
    out.write("End Conditions\n")
    for name, lists in parts.items():
        out.write(f"Begin SubModelPart {name}\n")
        for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
            out.write(f"Begin SubModelPart{kind}\n" + "".join(f"{i}\n" for i in sorted(set(ids))) + f"End SubModelPart{kind}\n")
        out.write("End SubModelPart\n")
