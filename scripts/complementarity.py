#!/usr/bin/env python3
"""Check a contact deck's results against the conditions of contact and friction, step by step and node by node.

    scripts/complementarity.py DECK_FOLDER ... [--zelus PATH] [--deck FILE] [--tolerances RELATIVE] [--end-time T]
                               [--keep FOLDER [--again]] [--where]

The deck is run in a copy, with a vtk_output_process for its contact part added; everything below is computed here, from
those files and the mesh file, by another code than the program's. Of every accepted step and slave node:

    open        no multiplier; the weighted gap per area, g, is not negative
    closed      g vanishes; the multiplier presses
    friction    the tangential traction is at most the coefficient times the pressure
    sliding     it is as large as that, and points against the slip; "along": nodes it pushes along a slip above 1e-6
    sticking    the weighted slip per area vanishes

Lengths are printed over the size of the mesh at the node, tractions over the largest pressure of the step, and each column
is the worst of all steps (NORMAL, multiplier, gap and slip as the program writes them). "depth" is geometry alone: how deep
a slave node is in the nearest facet of the other side, facets being faces of the mesh file's elements, at present
positions. Contact is weighted over facets, so that nodes may be in a curved side by a fraction of the mesh size. "way"
counts sliding nodes with friction along the motion, above 1e-4, of the node itself since the last step, projected likewise.

Only the standard library is used.
"""
import argparse, json, math, os, shutil, subprocess, sys, tempfile

FACES = {(2, 3): ((0, 1), (1, 2), (2, 0)), (2, 4): ((0, 1), (1, 2), (2, 3), (3, 0)),
         (3, 4): ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
         (3, 6): ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         (3, 8): ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))}
HISTORY = ["DISPLACEMENT", "NORMAL", "WEIGHTED_GAP"]
FLAGS = ["ACTIVE", "SLAVE", "MASTER", "SLIP"]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a, b, factor=1.0):
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def size(a):
    return math.sqrt(dot(a, a))


def unit(a):
    length = size(a)
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0.0 else (0.0, 0.0, 0.0)


def skin(mesh):
    """Initial positions of the nodes, and the outward faces of elements that only one element has."""
    nodes, faces, block, dim = {}, {}, "", 0
    for line in open(mesh):
        words = line.split("//")[0].split()
        if not words:
            continue
        if words[0] in ("Begin", "End"):
            block = words[1] if words[0] == "Begin" else ""
            if block == "Elements":
                name = words[2]
                dim = 2 if "2D" in name else 3
            continue
        if block == "Nodes":
            nodes[int(words[0])] = tuple(float(w) for w in words[1:4])
        elif block == "Elements":
            cell = [int(w) for w in words[2:]]
            for face in FACES.get((dim, len(cell)), ()):
                ids = tuple(cell[i] for i in face)
                faces.setdefault(tuple(sorted(ids)), []).append(ids)
    return nodes, [found[0] for found in faces.values() if len(found) == 1], dim


def read_vtk(path):
    """Columns of the points of a legacy ASCII file, {name: list of numbers or tuples}."""
    out, words = {}, open(path).read().split()
    at = words.index("POINT_DATA")
    count, at = int(words[at + 1]), words.index("FIELD", at) + 2
    fields, at = int(words[at]), at + 1
    for _ in range(fields):
        name, width = words[at], int(words[at + 1])
        at += 4
        values = [float(w) for w in words[at:at + width * count]]
        at += width * count
        out[name] = values if width == 1 else [tuple(values[i:i + width]) for i in range(0, width * count, width)]
    return out


def project(x, direction, facet):
    """Distance from x along the unit `direction` to a facet, and the weights of its corners; None when it misses."""
    if len(facet) == 2:
        a, b = facet
        edge = minus(b, a)
        det = direction[0] * edge[1] - direction[1] * edge[0]
        if abs(det) < 1e-30:
            return None
        way = minus(a, x)
        distance, s = (way[0] * edge[1] - way[1] * edge[0]) / det, (way[0] * direction[1] - way[1] * direction[0]) / det
        return (distance, (1.0 - s, s)) if -1e-9 <= s <= 1.0 + 1e-9 else None
    for corners in ((0, 1, 2),) if len(facet) == 3 else ((0, 1, 2), (0, 2, 3)):
        a, b, c = (facet[i] for i in corners)
        u, v = minus(b, a), minus(c, a)
        normal = cross(u, v)
        det = dot(direction, normal)
        if abs(det) < 1e-30:
            continue
        distance = dot(minus(a, x), normal) / det
        hit = minus(plus(x, direction, distance), a)
        area = dot(normal, normal)
        s, t = dot(cross(hit, v), normal) / area, dot(cross(u, hit), normal) / area
        if s >= -1e-9 and t >= -1e-9 and s + t <= 1.0 + 1e-9:
            weights = [0.0] * len(facet)
            for corner, weight in zip(corners, (1.0 - s - t, s, t)):
                weights[corner] = weight
            return distance, weights
    return None


def facet_normal(facet, dim):
    if dim == 2:
        edge = minus(facet[1], facet[0])
        return unit((edge[1], -edge[0], 0.0))
    return unit(cross(minus(facet[1], facet[0]), minus(facet[-1], facet[0])))


def run(folder, args):
    """Runs the deck with the output added; the copy's folder, the deck and whether multipliers are vectors."""
    work = os.path.join(args.keep or tempfile.mkdtemp(), os.path.basename(os.path.abspath(folder)))
    if not args.again:
        shutil.rmtree(work, ignore_errors=True)
        shutil.copytree(folder, work)
    path = os.path.join(work, args.deck)
    deck = json.load(open(path))
    settings = deck["solver_settings"]
    kind = settings.get("contact_settings", {}).get("mortar_type", "")
    vector = "Frictional" in kind or "Components" in kind
    multiplier = "VECTOR_LAGRANGE_MULTIPLIER" if vector else "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"
    frictional = "Frictional" in kind
    if args.again:
        return work, deck, multiplier, frictional
    if args.tolerances:
        for key in [k for k in settings if k.endswith("relative_tolerance")]:
            settings[key] = args.tolerances
    if args.end_time:
        deck["problem_data"]["end_time"] = args.end_time
    for name in list(deck["processes"]):
        deck["processes"][name] = [p for p in deck["processes"][name] if "json" not in p["python_module"]]
    deck["output_processes"] = {"check": [{
        "python_module": "vtk_output_process", "kratos_module": "KratosMultiphysics", "process_name": "VtkOutputProcess",
        "Parameters": {
            "model_part_name": settings["model_part_name"] + ".Contact", "output_interval": 1, "file_format": "ascii",
            "output_precision": 12, "write_ids": True, "output_path": "check", "entity_type": "condition",
            "nodal_solution_step_data_variables": HISTORY + [multiplier] + (["WEIGHTED_SLIP"] if frictional else []),
            "nodal_data_value_variables": ["NODAL_AREA", "NODAL_H"] + (["FRICTION_COEFFICIENT"] if frictional else []),
            "nodal_flags": FLAGS}}]}
    json.dump(deck, open(path, "w"), indent=1)
    done = subprocess.run([os.path.abspath(args.zelus), "run", args.deck, "--report", "report.json"], cwd=work,
                          capture_output=True, text=True)
    if done.returncode not in (0, 3):
        sys.exit(f"{folder}: exit {done.returncode}\n{done.stdout[-500:]}{done.stderr[-1000:]}")
    return work, deck, multiplier, frictional


def check(work, deck, multiplier, frictional):
    name = deck["solver_settings"]["model_import_settings"]["input_filename"]
    initial, faces, dim = skin(os.path.join(work, name + ".mdpa"))
    files = os.listdir(os.path.join(work, "check"))
    files.sort(key=lambda f: int(f.rsplit("_", 1)[1].split(".")[0]))
    report = json.load(open(os.path.join(work, "report.json")))
    worst = dict.fromkeys(("open gap", "open load", "closed gap", "tension", "over", "cone", "stick", "depth"), 0.0)
    counts = dict.fromkeys(("closed", "sliding", "along", "way"), 0)
    where, before = {}, initial

    def note(what, value, step, node):
        if value > worst[what]:
            worst[what], where[what] = value, (step, node)

    for step, file in enumerate(files, 1):
        data = read_vtk(os.path.join(work, "check", file))
        ids = [int(i) for i in data["KRATOS_NODE_ID"]]
        at = {node: i for i, node in enumerate(ids)}
        x = {node: plus(initial[node], data["DISPLACEMENT"][i]) for node, i in at.items()}
        master = [f for f in faces if all(n in at and data["MASTER"][at[n]] == 1.0 for n in f)]
        placed = [(f, [x[n] for n in f]) for f in master]
        placed = [(f, p, facet_normal(p, dim), tuple(sum(c[k] for c in p) / len(p) for k in range(3))) for f, p in placed]
        reach = max((size(minus(p[0], centre)) for _, p, _, centre in placed), default=0.0)
        slaves = [i for i in range(len(ids)) if data["SLAVE"][i] == 1.0]
        normals = {i: unit(data["NORMAL"][i]) for i in slaves}
        parts = {}
        for i in slaves:
            value = data[multiplier][i]
            value = value if isinstance(value, tuple) else tuple(value * c for c in normals[i])
            pressure = -dot(value, normals[i])
            parts[i] = (pressure, plus(value, normals[i], pressure))
        largest = max((p for p, _ in parts.values()), default=0.0) or 1.0
        now = {}
        for i in slaves:
            node, area, h = ids[i], data["NODAL_AREA"][i], data["NODAL_H"][i]
            pressure, tangential = parts[i]
            gap = data["WEIGHTED_GAP"][i] / area / h if area > 0.0 else 0.0
            # geometry
            best = None
            for f, p, normal, centre in placed:
                if dot(normal, normals[i]) < -0.2 and size(minus(centre, x[node])) < 2.0 * reach + h:
                    hit = project(x[node], normals[i], p)
                    if hit and (best is None or abs(hit[0]) < abs(best[0])):
                        best = (*hit, f)
            if best and abs(best[0]) < h:
                note("depth", -best[0] / h, step, node)
                now[node] = best
            if data["ACTIVE"][i] != 1.0:
                note("open gap", -gap, step, node)
                note("open load", size(plus(tangential, normals[i], -pressure)) / largest, step, node)
                continue
            counts["closed"] += 1
            note("closed gap", abs(gap), step, node)
            note("tension", -pressure / largest, step, node)
            if not frictional:
                continue
            bound = data["FRICTION_COEFFICIENT"][i] * pressure
            note("over", (size(tangential) - bound) / largest, step, node)
            slip = data["WEIGHTED_SLIP"][i]
            slip = plus(slip, normals[i], -dot(slip, normals[i]))
            if data["SLIP"][i] != 1.0:
                note("stick", size(slip) / area / h, step, node)
                continue
            counts["sliding"] += 1
            note("cone", abs(size(tangential) - bound) / largest, step, node)
            # the slip is that of the other side along this one
            if size(slip) / area > 1e-6 * h and bound > 0.0 and dot(slip, tangential) < 0.0:
                counts["along"] += 1
                where.setdefault("along", []).append((step, node, round(pressure / largest, 6), size(slip) / area / h))
            if best and node in before and bound > 0.0:
                _, weights, f = best
                moved = minus(x[node], before[node])
                for corner, weight in zip(f, weights):
                    moved = plus(moved, minus(x[corner], before[corner]), -weight)
                moved = plus(moved, normals[i], -dot(moved, normals[i]))
                if size(moved) > 1e-4 * h and dot(moved, tangential) > 0.0:
                    counts["way"] += 1
                    where.setdefault("way", []).append((step, node, round(pressure / largest, 6), size(moved) / h))
        before = x
    warnings = sorted({w.split("[")[1].split("]")[0] for w in report.get("warnings", []) if "[" in w})
    return len(files), report["converged"], worst, counts, where, warnings


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--zelus", default="target/release/zelus")
    parser.add_argument("--deck", default="ProjectParameters.json")
    parser.add_argument("--tolerances", type=float, help="replaces all relative tolerances of the deck")
    parser.add_argument("--end-time", type=float, help="replaces that of the deck")
    parser.add_argument("--keep", help="run in this folder and keep what is written")
    parser.add_argument("--again", action="store_true", help="only check what an earlier run with --keep has written")
    parser.add_argument("--where", action="store_true", help="also print step and node of each worst value")
    args = parser.parse_args()
    titles = ["open gap", "open load", "closed gap", "tension", "over", "cone", "stick", "depth"]
    print("| deck | steps | closed | " + " | ".join(titles) + " | sliding | along | way | warnings |")
    print("|---" * (len(titles) + 7) + "|")
    for folder in args.folders:
        steps, whole, worst, counts, where, warnings = check(*run(folder, args))
        numbers = " | ".join(f"{worst[t]:.0e}" if worst[t] else "0" for t in titles)
        end = "" if whole else " (not to the end)"
        print(f"| {os.path.basename(os.path.abspath(folder))} | {steps}{end} | {counts['closed']} | {numbers} | "
              f"{counts['sliding']} | {counts['along']} | {counts['way']} | {', '.join(warnings)} |", flush=True)
        if args.where:
            print({what: found[:5] if isinstance(found, list) else found for what, found in where.items()})


if __name__ == "__main__":
    main()
