#!/usr/bin/env python3
"""Compare our defaults with those of Kratos on a folder of decks: by how much, by which setting, which is nearer to a finer mesh.

    scripts/compare_defaults.py DECKS [--zelus target/release/zelus] [--only TEXT] [--most-nodes N] [--write FILE.md]

Every deck is run twice, with our defaults and with `--like kratos`, at the tolerances that its reference.json asks for. The
difference of a field is the largest at any node and time of the reference, over the largest value. Where a difference is above
the tolerance of the reference,

- each setting that `--like kratos` gave the deck is laid under it alone, and those that make at least a quarter of the
  difference are named;
- the mesh is cut in halves (lines in 2, faces in 4, solids in 8) and run both ways; the two refined answers, where they
  agree better than the coarse ones, say which coarse answer is nearer.

Multipliers are compared as tractions, times SCALE_FACTOR. Checks of results that a deck holds are taken out: their files are
Kratos' answers. Only the standard library is used.
"""
import argparse, json, os, shutil, subprocess, sys, tempfile

FIELDS = {"DISPLACEMENT": ["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"],
          "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE": ["LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"],
          "VECTOR_LAGRANGE_MULTIPLIER": ["VECTOR_LAGRANGE_MULTIPLIER_X", "VECTOR_LAGRANGE_MULTIPLIER_Y",
                                         "VECTOR_LAGRANGE_MULTIPLIER_Z"]}
TOLERANCE = {"DISPLACEMENT": 1e-4}
DECK = "ProjectParameters.json"


# ---------------------------------------------------------------- meshes

def lattice(shape):
    """Points of the halved cell as sets of corners, and the children as lists of those points."""
    if shape == "point":
        return [(0,)], [[0]]
    if shape == "line":
        return [(0,), (0, 1), (1,)], [[0, 1], [1, 2]]
    if shape == "triangle":
        return [(0,), (1,), (2,), (0, 1), (1, 2), (0, 2)], [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]
    if shape == "tetrahedron":
        points = [(0,), (1,), (2,), (3,), (0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
        return points, [[0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3],
                        [4, 8, 6, 7], [4, 5, 6, 8], [6, 5, 9, 8], [6, 9, 7, 8]]
    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
    if shape == "hexahedron":
        corners += [(x, y, 2) for x, y, _ in corners]
    deep = 3 if shape == "hexahedron" else 1
    at = {(x, y, z): x + 3 * y + 9 * z for z in range(deep) for y in range(3) for x in range(3)}
    points = []
    for (x, y, z) in sorted(at, key=at.get):
        near = lambda a, b: b == 1 or a == b
        points.append(tuple(i for i, c in enumerate(corners) if near(c[0], x) and near(c[1], y) and near(c[2], z)))
    children = []
    for z in range(max(1, deep - 1)):
        for y in range(2):
            for x in range(2):
                square = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
                levels = (z, z + 1) if deep == 3 else (0,)
                children.append([at[(a, b, level)] for level in levels for a, b in square])
    return points, children


def shape_of(name, count, conditions):
    solid = "3D" in name and not conditions
    shapes = {1: "point", 2: "line", 3: "triangle", 4: "tetrahedron" if solid else "quadrilateral", 8: "hexahedron"}
    if count not in shapes or (count == 8 and not solid):
        raise ValueError(f"{name} cannot be cut in halves")
    return shapes[count]


def refine(source, target):
    """Writes the mesh with every cell cut in halves."""
    lines = [line.split("//")[0].strip() for line in open(source, encoding="latin-1")]
    lines = [line for line in lines if line]
    nodes, kept, groups = {}, [], {"Elements": [], "Conditions": []}
    parts, stack, at = [], [], 0
    while at < len(lines):
        words = lines[at].split()
        if words[0] != "Begin":
            at += 1
            if words[0] == "End" and words[1] == "SubModelPart":
                stack.pop()
            continue
        kind = words[1]
        if kind == "SubModelPart":
            part = {"name": words[2], "path": [p["name"] for p in stack] + [words[2]], "Nodes": [], "Elements": [],
                    "Conditions": [], "children": []}
            (stack[-1]["children"] if stack else parts).append(part)
            stack.append(part)
            at += 1
            continue
        end = at + 1
        while lines[end].split()[:2] != ["End", kind]:
            end += 1
        body = lines[at + 1:end]
        if kind == "Nodes":
            for line in body:
                i, x, y, z = line.split()[:4]
                nodes[int(i)] = (float(x), float(y), float(z))
        elif kind in groups:
            groups[kind].append((words[2], [list(map(int, line.split())) for line in body]))
        elif stack and kind.startswith("SubModelPart"):
            ids = [int(word) for line in body for word in line.split()] if kind[12:] in stack[-1] else []
            stack[-1].setdefault(kind[12:], []).extend(ids)
        elif kind in ("Properties", "ModelPartData", "Table"):
            kept.append(lines[at:end + 1])
        elif kind not in ("SubModelPartData", "SubModelPartTables", "SubModelPartProperties") and body:
            raise ValueError(f"{kind} of the mesh are not carried over")
        at = end + 1
    made, next_node = {}, max(nodes) + 1
    children = {"Elements": {}, "Conditions": {}}
    out = []
    for kind, blocks in groups.items():
        next_id = 1
        for name, rows in blocks:
            refined = []
            for row in rows:
                corners = row[2:]
                points, cells = lattice(shape_of(name, len(corners), kind == "Conditions"))
                ids = []
                for point in points:
                    key = tuple(sorted(corners[i] for i in point))
                    if len(key) == 1:
                        ids.append(key[0])
                        continue
                    if key not in made:
                        made[key] = next_node
                        nodes[next_node] = tuple(sum(nodes[n][c] for n in key) / len(key) for c in range(3))
                        next_node += 1
                    ids.append(made[key])
                for cell in cells:
                    refined.append([next_id, row[1]] + [ids[i] for i in cell])
                    children[kind].setdefault(row[0], []).append(next_id)
                    next_id += 1
            out.append((kind, name, refined))

    def write_part(file, part, indent):
        inside = set(part["Nodes"])
        more = [new for key, new in made.items() if inside.issuperset(key)]
        print(f"{indent}Begin SubModelPart {part['name']}", file=file)
        for kind, ids in (("Nodes", part["Nodes"] + more),
                          ("Elements", [c for i in part["Elements"] for c in children["Elements"][i]]),
                          ("Conditions", [c for i in part["Conditions"] for c in children["Conditions"][i]])):
            print(f"{indent}  Begin SubModelPart{kind}", *ids, f"{indent}  End SubModelPart{kind}", sep="\n", file=file)
        for child in part["children"]:
            write_part(file, child, indent + "  ")
        print(f"{indent}End SubModelPart", file=file)

    with open(target, "w") as file:
        for block in kept:
            print(*block, sep="\n", file=file)
        print("Begin Nodes", file=file)
        for i, x in sorted(nodes.items()):
            print(i, *(repr(c) for c in x), file=file)
        print("End Nodes", file=file)
        for kind, name, rows in out:
            print(f"Begin {kind} {name}", file=file)
            for row in rows:
                print(*row, file=file)
            print(f"End {kind}", file=file)
        for part in parts:
            write_part(file, part, "")


# ---------------------------------------------------------------- runs

def merge(base, extra):
    for key, value in extra.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            merge(base[key], value)
        else:
            base[key] = value


def complete(settings, path, value):
    """Sets a key that is not there, objects on the way to it too."""
    for key in path[:-1]:
        settings = settings.setdefault(key, {})
    settings.setdefault(path[-1], value)


class Deck:
    def __init__(self, folder, zelus, timeout):
        self.folder, self.zelus, self.timeout = folder, zelus, timeout
        self.reference = json.load(open(os.path.join(folder, "reference.json")))
        self.times = [snapshot["time"] for snapshot in self.reference["snapshots"]]
        first = self.reference["snapshots"][0]
        self.fields = [field for field in FIELDS if field in first]
        self.nodes = {"DISPLACEMENT": first["node_ids"]}
        for field in self.fields[1:]:
            self.nodes[field] = first["contact_node_ids"]

    def mesh(self, parameters):
        return parameters["solver_settings"]["model_import_settings"]["input_filename"] + ".mdpa"

    def run(self, like=False, laid=None, finer=False):
        """{field: {time: {node: values}}} of a run, and its report; None where it does not end well."""
        with tempfile.TemporaryDirectory() as scratch:
            work = os.path.join(scratch, "deck")
            shutil.copytree(self.folder, work)
            path = os.path.join(work, DECK)
            parameters = json.load(open(path))
            merge(parameters["solver_settings"], self.reference.get("settings", {}))
            # The reference has the times of Kratos.
            complete(parameters["solver_settings"], ["time_stepping", "last_step"], "while_below")
            lists = parameters.setdefault("processes", {})
            for holder in (lists, parameters.get("output_processes", {})):
                for name, items in holder.items():
                    holder[name] = [p for p in items if not any(word in p.get("python_module", "")
                                                                for word in ("check", "output"))]
            if laid:
                name, keys, value = laid
                processes = [p["Parameters"] for items in lists.values() for p in items
                             if p.get("python_module", "").split(".")[-1] == name]
                solver = parameters["solver_settings"]
                for target in processes or [solver[name] if name in solver else solver]:
                    complete(target, keys, value)
            names = [n for field in self.fields for n in FIELDS[field]]
            lists["comparison"] = [{
                "python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {"output_variables": names, "output_file_name": "comparison.json", "time_frequency": 0.0,
                               "model_part_name": parameters["solver_settings"]["model_part_name"]}}]
            if finer:
                mesh = os.path.join(work, self.mesh(parameters))
                refine(mesh, mesh + ".fine")
                os.replace(mesh + ".fine", mesh)
            json.dump(parameters, open(path, "w"))
            command = [self.zelus, "run", DECK, "--report", "run.json"] + (["--like", "kratos"] if like else [])
            try:
                done = subprocess.run(command, cwd=work, capture_output=True, text=True, timeout=self.timeout)
            except subprocess.TimeoutExpired:
                return None, {"why": f"no end within {self.timeout} s"}
            report = {}
            if os.path.exists(os.path.join(work, "run.json")):
                report = json.load(open(os.path.join(work, "run.json")))
            if done.returncode != 0:
                report["why"] = f"exit {done.returncode}"
                return None, report
            found = json.load(open(os.path.join(work, "comparison.json")))
        factor = scale_factor(report)
        at = {t: min(range(len(found["TIME"])), key=lambda i: abs(found["TIME"][i] - t)) for t in self.times}
        values = {}
        for field in self.fields:
            times = factor if field != "DISPLACEMENT" else 1.0
            values[field] = {t: {n: [times * found[f"NODE_{n}"][name][i] for name in FIELDS[field]
                                     if name in found[f"NODE_{n}"]] for n in self.nodes[field]} for t, i in at.items()}
        return values, report


def scale_factor(report):
    """SCALE_FACTOR of the run, 1 where it has none."""
    return report.get("parameters", {}).get("scale factor k", 1.0)


def difference(a, b, field):
    """The largest difference of two runs over the largest value of the second."""
    most, scale = 0.0, 0.0
    for t in a[field]:
        for n, value in a[field][t].items():
            for x, y in zip(value, b[field][t][n]):
                most, scale = max(most, abs(x - y)), max(scale, abs(y))
    return most / scale if scale > 0.0 else most


def iterations(report):
    return sum(len(step["iterations"]) for step in report.get("steps", []))


def settings(report):
    """(object, keys, value) of the defaults that a deck was given."""
    for line in report.get("defaults_from_kratos", report.get("laid_defaults", [])):
        path, _, value = line.partition(" = ")
        name, *keys = path.split(".")
        yield name, keys, json.loads(value)


def compare(deck, most_nodes):
    ours, report = deck.run()
    theirs, other = deck.run(like=True)
    row = {"iterations": (iterations(report), iterations(other))}
    if ours is None or theirs is None:
        row["why"] = f"ours {report.get('why', 'ends')}, like Kratos {other.get('why', 'ends')}"
        return row
    tolerance = {**TOLERANCE, **deck.reference.get("tolerance", {})}
    row["differences"] = {field: difference(ours, theirs, field) for field in deck.fields}
    moved = [field for field in deck.fields if row["differences"][field] > tolerance.get(field, 1e-3)]
    if not moved:
        return row
    row["moved"] = moved
    whole, causes = row["differences"][moved[0]], []
    for name, keys, value in settings(other):
        single, _ = deck.run(laid=(name, keys, value))
        if single is not None and difference(ours, single, moved[0]) > 0.25 * whole:
            causes.append((difference(ours, single, moved[0]), ".".join(keys)))
    row["causes"] = [name for _, name in sorted(causes, reverse=True)] or ["several together"]
    if len(deck.nodes["DISPLACEMENT"]) > most_nodes:
        row["nearer"] = "not refined: too large"
        return row
    try:
        fine, _ = deck.run(finer=True)
        fine_like, _ = deck.run(like=True, finer=True)
    except ValueError as error:
        row["nearer"] = f"not refined: {error}"
        return row
    if fine is None or fine_like is None:
        stopped = [name for name, run in (("ours", fine), ("like Kratos", fine_like)) if run is None]
        row["nearer"] = "the refined deck does not end: " + " and ".join(stopped)
        return row
    # Tractions at single nodes do not converge at edges; displacements do.
    far = [difference(run, fine, "DISPLACEMENT") for run in (ours, theirs)]
    apart = difference(fine, fine_like, "DISPLACEMENT")
    word = "ours" if far[0] < far[1] else "like Kratos"
    if abs(far[0] - far[1]) < 0.5 * apart or abs(far[0] - far[1]) < 0.05 * max(far):
        word = "neither"
    row["nearer"] = f"{word} ({far[0]:.1e} against {far[1]:.1e})"
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("decks")
    parser.add_argument("--zelus", default="target/release/zelus")
    parser.add_argument("--only", default="")
    parser.add_argument("--most-nodes", type=int, default=4000)
    parser.add_argument("--timeout", type=float, default=300.0)
    parser.add_argument("--write", help="write the table as Markdown here")
    args = parser.parse_args()
    zelus = os.path.abspath(args.zelus)
    index = json.load(open(os.path.join(args.decks, "index.json")))
    table, sums, ended = [], [0, 0], 0
    for case in index:
        if args.only not in case["path"] or not case.get("kratos_trustworthy", True):
            continue
        row = compare(Deck(os.path.join(args.decks, case["path"]), zelus, args.timeout), args.most_nodes)
        sums = [a + b for a, b in zip(sums, row["iterations"])]
        ended += "why" not in row
        said = row.get("why") or " ".join(f"{k.split('_')[0].lower()}={v:.1e}" for k, v in row["differences"].items())
        print(case["path"], "iterations %d and %d" % row["iterations"], said, ", ".join(row.get("causes", [])),
              row.get("nearer", ""), sep="  ", flush=True)
        if "why" in row or "moved" in row:
            table.append((case["path"], row))
    print(f"{ended} decks end both ways; iterations {sums[0]} with our defaults, {sums[1]} like Kratos")
    if args.write:
        with open(args.write, "w") as file:
            print("| deck | displacement | traction | setting | a finer mesh is nearer to |\n|---|---|---|---|---|", file=file)
            for path, row in table:
                found = row.get("differences", {})
                traction = max((v for k, v in found.items() if k != "DISPLACEMENT"), default=None)
                folder, name = path.split("/", 1)
                cells = [f"`{name}` of {folder}", f"{found['DISPLACEMENT']:.1e}" if found else row["why"],
                         "" if traction is None else f"{traction:.1e}", ", ".join(f"`{c}`" for c in row.get("causes", [])),
                         row.get("nearer", "")]
                print("| " + " | ".join(cells) + " |", file=file)
    sys.exit(0 if all("why" not in row for _, row in table) else 1)


if __name__ == "__main__":
    main()
