#!/usr/bin/env python3
"""Runs the flange of this folder in CalculiX (`ccx`) and prints the numbers that the case compares.

    python3 verification/flange/with_calculix.py"""
import math, os, re, subprocess, sys, tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from flange.case import BOLTS, LIFT, POISSON, PRELOAD, THROUGH, YOUNG, Flange  # noqa: E402

# nodes whose motion along the axis is printed: above and below the opening, on top of the inner edge and of a bolt's head
SEEN = (("upper", 0, 0, 0), ("lower", 0, 0, THROUGH), ("upper", 0, 0, THROUGH), ("upper", 2, 2, THROUGH))
STIFFNESS = 1e8  # of the penalty (stress over length)


def rows(numbers, width=12):
    numbers = list(numbers)
    return "\n".join(", ".join(map(str, numbers[i:i + width])) for i in range(0, len(numbers), width)) + "\n"


def face_of(cells, face):
    """Number and face label of the hexahedron with that face."""
    labels = {"S1": (0, 1, 2, 3), "S2": (4, 5, 6, 7)}
    for number, (_, nodes) in enumerate(cells, 1):
        for label, local in labels.items():
            if {nodes[i] for i in local} == set(face):
                return f"{number}, {label}"
    raise KeyError(face)


def nodal_forces(flange):
    """Forces of the uniform traction on the lifted faces, by node: a plane face, four Gauss points."""
    out = {}
    for face in flange.lifted:
        points = [flange.places[i - 1] for i in face]
        for s in (-1, 1):
            for t in (-1, 1):
                x, y = s / math.sqrt(3), t / math.sqrt(3)
                shape = [(1 + a * x) * (1 + b * y) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                by_x = [a * (1 + b * y) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                by_y = [b * (1 + a * x) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                j = [[sum(d * p[c] for d, p in zip(by, points)) for c in (0, 1)] for by in (by_x, by_y)]
                area = abs(j[0][0] * j[1][1] - j[0][1] * j[1][0])
                for node, n in zip(face, shape):
                    out[node] = out.get(node, 0.0) + n * area * LIFT
    return out


def deck(flange):
    first_free = len(flange.places) + 1
    text = "*NODE, NSET=ALL\n" + "".join(f"{i}, {x:.11g}, {y:.11g}, {z:.11g}\n" for i, (x, y, z) in enumerate(flange.places, 1))
    text += "".join(f"{first_free + b}, 0., 0., {b + 1.}\n" for b in range(BOLTS))
    text += "*ELEMENT, TYPE=C3D8, ELSET=SOLID\n" + "".join(f"{i}, {', '.join(map(str, nodes))}\n" for i, (_, nodes) in enumerate(flange.cells, 1))
    text += f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{YOUNG}, {POISSON}\n*SOLID SECTION, ELSET=SOLID, MATERIAL=STEEL\n"
    for name, faces in (("SLAVE", flange.slaves), ("MASTER", flange.masters)):
        text += f"*SURFACE, NAME={name}, TYPE=ELEMENT\n" + "".join(face_of(flange.cells, f) + "\n" for f in faces)
    text += f"*SURFACE INTERACTION, NAME=HARD\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{STIFFNESS}\n"
    text += "*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE\nSLAVE, MASTER\n"
    for b in range(BOLTS):
        # the lower face of the third cell of the shank from below
        shank = [(i, nodes) for i, (name, nodes) in enumerate(flange.cells, 1) if name == f"Bolt{b}"]
        section = [f"{i}, S1" for i, nodes in shank if abs(flange.places[nodes[0] - 1][2]) < 1e-9]
        text += f"*SURFACE, NAME=CUT{b}, TYPE=ELEMENT\n" + "\n".join(section) + "\n"
        text += f"*PRE-TENSION SECTION, SURFACE=CUT{b}, NODE={first_free + b}\n0., 0., -1.\n"
    text += "*NSET, NSET=BASE\n" + rows(flange.base())
    seen = [flange.known[at] for at in SEEN]
    text += f"*NSET, NSET=SEEN\n{rows(seen)}*BOUNDARY\nBASE, 1, 3\n"
    text += "*STEP\n*STATIC\n1., 1.\n*CLOAD\n" + "".join(f"{first_free + b}, 1, {PRELOAD}\n" for b in range(BOLTS)) + "*END STEP\n"
    text += "*STEP\n*STATIC\n1., 1.\n*BOUNDARY, FIXED\n" + "".join(f"{first_free + b}, 1, 1\n" for b in range(BOLTS))
    text += "*CLOAD\n" + "".join(f"{node}, 3, {force:.11g}\n" for node, force in sorted(nodal_forces(flange).items()))
    text += "*NODE PRINT, NSET=SEEN\nU\n*END STEP\n"
    return text, seen


def main():
    text, (upper, lower, top, head) = deck(Flange(BOLTS))
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "flange.inp"), "w") as file:
            file.write(text)
        done = subprocess.run(["ccx", "flange"], cwd=folder, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        with open(os.path.join(folder, "flange.dat")) as file:
            data = file.read()
    if "*ERROR" in done.stdout:
        sys.exit("\n".join(re.findall(r"\*ERROR[^\n]*\n[^\n]*", done.stdout)))
    rows_of_step = (line.split() for line in data.split("displacements")[-1].splitlines())
    u = {int(row[0]): float(row[3]) for row in rows_of_step if len(row) == 4 and row[0].isdigit()}
    print(f"opening at the inner edge {u[upper] - u[lower]:.6g} mm, lift of the inner edge {u[top]:.6g} mm, of a bolt's head {u[head]:.6g} mm")


if __name__ == "__main__":
    main()
