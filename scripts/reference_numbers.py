#!/usr/bin/env python3
"""Compute with Kratos the numbers that unit tests compare with; check or write the files that hold them.

    scripts/reference_numbers.py --check      how far the files are from what Kratos computes now; fails above 1e-10
    scripts/reference_numbers.py --write      the files anew

The files are listed in FILES. A line holds what is given, then what Kratos computes from it, so that a line may be added
with its givens alone and then written; the comments of a file say what its columns are. A `-` in place of a number is left
out on purpose and stays. `--check` compares with 1e-10 times the largest number of a line, or 1e-10 where that is above one.

Kratos 10.4.4 is what the files were made with: `python3 -m venv FOLDER`, then `FOLDER/bin/pip install` of each of the PACKAGES of
benches/compare.py with `==10.4.4`. Run by a Python without Kratos, the script goes on with the one that KRATOS_PYTHON names, or
with the newest release, which it then installs into target/reference, once.
"""
import argparse, math, os, re, sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

try:
    import KratosMultiphysics as KM
except ImportError:
    sys.path.insert(0, os.path.join(ROOT, "benches"))
    import compare
    python = compare.python_of_reference()
    os.execv(python, [python, os.path.abspath(__file__), *sys.argv[1:]])
KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.StructuralMechanicsApplication as SMA
import KratosMultiphysics.ConstitutiveLawsApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication as CSMA


# ---------------------------------------------------------------- elements and loads

def middles(corners, pairs):
    return [tuple((a + b) / 2 for a, b in zip(corners[i], corners[j])) for i, j in pairs]


LINE = [(-1, 0, 0), (1, 0, 0), (0, 0, 0)]
TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
CUBE = [(x, y, z) for z in (-1, 1) for x, y, _ in SQUARE]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
TRIANGLES = {3: TRIANGLE, 6: TRIANGLE + middles(TRIANGLE, [(0, 1), (1, 2), (2, 0)])}
SQUARES = {4: SQUARE, 8: SQUARE + middles(SQUARE, RING), 9: SQUARE + middles(SQUARE, RING) + [(0, 0, 0)]}
CUBE_EDGES = middles(CUBE, RING + [(i, i + 4) for i in range(4)] + [(i + 4, j + 4) for i, j in RING])
CUBE_FACES = [(0, 0, -1), (0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, 0, 1)]
CELLS = {  # by dimension, then by number of nodes
    1: {2: LINE[:2], 3: LINE},
    2: {**TRIANGLES, **SQUARES},
    3: {4: TETRAHEDRON, 10: TETRAHEDRON + middles(TETRAHEDRON, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]),
        6: [(x, y, z) for z in (0, 1) for x, y, _ in TRIANGLE], 8: CUBE, 20: CUBE + CUBE_EDGES,
        27: CUBE + CUBE_EDGES + CUBE_FACES + [(0, 0, 0)]}}


def variable(name):
    return KM.KratosGlobals.GetVariable(name)


def deformed_cell(name, dimension, variables):
    """A model, and its part with the nodes of the cell of `name`, displaced and moved: `reference_cell` of test_model.rs."""
    space, count = map(int, re.search(r"(\d)D(\d+)N$", name).groups())
    model = KM.Model()
    part = model.CreateModelPart("cell", 2)
    for each in ["DISPLACEMENT", "VOLUME_ACCELERATION", *variables]:
        part.AddNodalSolutionStepVariable(variable(each))
    part.ProcessInfo[KM.DOMAIN_SIZE] = space
    for i, (p, q, r) in enumerate(CELLS[dimension or space][count]):
        x = [4 + p + 0.3 * q + 0.1 * r, 0.8 * q - 1, 0.1 * p + 0.7 * r]
        u = [0.05 * math.cos(5 * i + 2 * a) if a < space else 0.0 for a in range(3)]
        x = [x[a] + 0.03 * math.sin(7 * i + 3 * a) if a < space else 0.0 for a in range(3)]
        node = part.CreateNewNode(i + 1, *x)
        node.SetSolutionStepValue(KM.DISPLACEMENT, u)
        node.X, node.Y, node.Z = (a + b for a, b in zip(x, u))
    return model, part


def weighted(values):
    return sum(math.cos(r) * value for r, value in enumerate(values))


def double_weighted(matrix):
    columns = range(matrix.Size2())
    return weighted(sum(matrix[r, c] * math.sin(c) for c in columns) for r in range(matrix.Size1()))


def element(words, _):
    name, law, more, _tolerance = words[:4]
    model, part = deformed_cell(name, None, [])
    properties, info = part.CreateNewProperties(1), part.ProcessInfo
    given = {"YOUNG_MODULUS": 100, "POISSON_RATIO": 0.3, "DENSITY": 2, "THICKNESS": 0.5}
    given.update(pair.split("=") for pair in more.split(",") if more != "-")
    for key, value in given.items():
        kind = variable(key)
        properties[kind] = int(value) if isinstance(kind, KM.IntegerVariable) else float(value)
    properties[KM.CONSTITUTIVE_LAW] = KM.KratosGlobals.GetConstitutiveLaw(law).Clone()
    it = part.CreateNewElement(name, 1, [node.Id for node in part.Nodes], properties)
    it.Initialize(info)
    k, b, mass = KM.Matrix(), KM.Vector(), KM.Matrix()
    it.CalculateLocalSystem(k, b, info)
    numbers = [weighted(b), double_weighted(k)]
    for lumped in (False, True):
        info[KM.COMPUTE_LUMPED_MASS_MATRIX] = lumped
        it.CalculateMassMatrix(mass, info)
        numbers.append(double_weighted(mass))
    stress = it.CalculateOnIntegrationPoints(KM.CAUCHY_STRESS_VECTOR, info)
    numbers.append(weighted(value for point in stress for value in point))
    numbers.append(weighted(it.CalculateOnIntegrationPoints(SMA.VON_MISES_STRESS, info)))
    return 4, numbers


def load(words, _):
    name = words[0]
    line = "Line" in name
    vector = SMA.LINE_LOAD if line else SMA.SURFACE_LOAD
    below, above = KM.NEGATIVE_FACE_PRESSURE, KM.POSITIVE_FACE_PRESSURE
    model, part = deformed_cell(name, 1 if line else 2, [v.Name() for v in (vector, below, above)])
    properties = part.CreateNewProperties(1)
    properties[KM.THICKNESS] = 0.5
    it = part.CreateNewCondition(name, 1, [node.Id for node in part.Nodes], properties)
    it.Initialize(part.ProcessInfo)
    for kind, value in ((vector, [1.0, 2.0, 3.0]), (above, 1.5), (below, 0.7), (KM.PRESSURE, 0.4)):
        it.SetValue(kind, value)
    for i, node in enumerate(part.Nodes):
        for kind, value in ((vector, [0.2 * i, 0.1, -0.3 * i]), (below, 0.3 * i), (above, 0.1 * i * i)):
            node.SetSolutionStepValue(kind, value)
    k, b = KM.Matrix(), KM.Vector()
    it.CalculateLocalSystem(k, b, part.ProcessInfo)
    return 1, [weighted(b)]


# ---------------------------------------------------------------- contact pairs

FACETS = {2: [(1, 0, 0), (0, 0, 0)], 3: TRIANGLE, 4: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]}
KINDS = {2: "LineCondition2D2N", 3: "SurfaceCondition3D3N", 4: "SurfaceCondition3D4N"}


def vectors(numbers):
    return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def place(nodes, points):
    for node, x in zip(nodes, points):
        node.X, node.Y, node.Z = x


def contact_pair(name, ns, nm):
    """A model, its part, the condition that the search makes of two facets that face each other, slave and master nodes."""
    model = KM.Model()
    part = model.CreateModelPart("pair", 3)
    for each in (KM.DISPLACEMENT, KM.NORMAL, KM.NODAL_H, KM.VECTOR_LAGRANGE_MULTIPLIER, CSMA.WEIGHTED_GAP, CSMA.WEIGHTED_SLIP):
        part.AddNodalSolutionStepVariable(each)
    part.ProcessInfo[KM.DOMAIN_SIZE] = 2 if ns == 2 else 3
    skin = part.CreateSubModelPart("Contact").CreateSubModelPart("ContactSub0")
    part.CreateSubModelPart("ComputingContact").CreateSubModelPart("ComputingContactSub0")
    properties = part.CreateNewProperties(1)
    for i, x in enumerate(FACETS[ns] + FACETS[nm][::-1]):
        skin.CreateNewNode(i + 1, *x)
    for key, count, nodes in ((1, ns, range(1, ns + 1)), (2, nm, range(ns + 1, ns + nm + 1))):
        facet = skin.CreateNewCondition(KINDS[count], key, list(nodes), properties)
        for each in [facet, *facet.GetNodes()]:
            each.Set(KM.SLAVE, key == 1)
            each.Set(KM.MASTER, key == 2)
    settings = KM.Parameters('{"check_gap": "no_check", "predefined_master_slave": true, "id_name": "0"}')
    settings.AddString("condition_name", name + "MortarContact")
    settings.AddString("final_string", "" if ns == nm else f"{nm}N")
    search = CSMA.ContactSearchProcess(part, settings, properties)
    search.ExecuteInitialize()
    search.ExecuteInitializeSolutionStep()
    pair, = part.GetSubModelPart("ComputingContact").Conditions
    nodes = list(part.Nodes)
    return model, part, pair, nodes[:ns], nodes[ns:]


def mortar_pair(words, _):
    """D and M from forces of unit multipliers, where the penalty weighs nothing; the gap as Kratos sums it up at the nodes."""
    ns, nm = int(words[0]), int(words[1])
    count = 2 + 3 * (2 * ns + nm + 2)
    given = vectors([float(word) for word in words[2:count]])
    slave_normal, master_normal = given[-2:]
    model, part, pair, slaves, masters = contact_pair("ALMFrictionlessComponents", ns, nm)
    # The condition takes the master's normal when it is initialised, and keeps it when the master moves.
    least = min(range(3), key=lambda a: abs(master_normal[a]))
    across = [0, 0, -1] if ns == 2 else cross(master_normal, [float(a == least) for a in range(3)])
    along = cross(across, master_normal)
    place(masters, [[p * a + q * b for a, b in zip(along, across)] for p, q, _ in FACETS[nm]])
    info = part.ProcessInfo
    pair.Initialize(info)
    place(slaves + masters, given)
    pair.SetValue(KM.NORMAL, slave_normal)
    info[KM.SCALE_FACTOR] = 1.0
    for node, normal in zip(slaves, given[ns + nm:]):
        node.SetSolutionStepValue(KM.NORMAL, normal)
        node.SetValue(KM.INITIAL_PENALTY, 1e-30)
        node.SetValue(CSMA.DYNAMIC_FACTOR, 1.0)
        node.SetSolutionStepValue(CSMA.WEIGHTED_GAP, 0.0)
        node.Set(KM.ACTIVE)
    CSMA.ContactUtilities.ComputeExplicitContributionConditions(part.GetSubModelPart("ComputingContact"))
    gap = [node.GetSolutionStepValue(CSMA.WEIGHTED_GAP) for node in slaves]
    d, m, b = [], [], KM.Vector()
    for node in slaves:
        node.SetSolutionStepValue(KM.VECTOR_LAGRANGE_MULTIPLIER, [1.0, 0.0, 0.0])
        pair.CalculateRightHandSide(b, info)
        node.SetSolutionStepValue(KM.VECTOR_LAGRANGE_MULTIPLIER, [0.0, 0.0, 0.0])
        forces = list(b)[:(nm + ns) * info[KM.DOMAIN_SIZE]:info[KM.DOMAIN_SIZE]]
        m += [-force for force in forces[:nm]]
        d += forces[nm:]
    return count, d + m + gap


def residual(words, step):
    if words[0] == "start":
        numbers = [float(word) for word in words[2:]]
        step.update(family=words[1], start=vectors(numbers[:24]), threshold=numbers[24], initial=vectors(numbers[25:]))
        return len(words), []
    given = [float(word) for word in words[:36]]
    now, states, penalties, factors = vectors(given[:30]), given[30:32], given[32:34], given[34:]
    name = {"alm_frictional": "ALMFrictional", "alm_components": "ALMFrictionlessComponents"}[step["family"]]
    model, part, pair, slaves, masters = contact_pair(name, 2, 2)
    nodes, info = slaves + masters, part.ProcessInfo
    info[KM.STEP], info[KM.DELTA_TIME], info[KM.SCALE_FACTOR] = 2, 1.0, 1.7
    info[CSMA.OPERATOR_THRESHOLD], info[CSMA.TANGENT_FACTOR] = step["threshold"], 0.3
    place(nodes, step["start"])
    for node, normal in zip(slaves, step["start"][4:]):
        node.SetSolutionStepValue(KM.NORMAL, normal)
    pair.SetValue(KM.NORMAL, step["start"][6])
    pair.Initialize(info)
    # The scheme calls InitializeSolutionStep of the condition.
    KM.ResidualBasedIncrementalUpdateStaticScheme().InitializeSolutionStep(part, KM.CompressedMatrix(), KM.Vector(), KM.Vector())
    place(nodes, now)
    for node, first, x in zip(nodes, step["initial"], now):
        node.X0, node.Y0, node.Z0 = first
        node.SetSolutionStepValue(KM.DISPLACEMENT, [a - b for a, b in zip(x, first)])
    for j, node in enumerate(slaves):
        node.SetSolutionStepValue(KM.NORMAL, now[4 + j])
        node.SetSolutionStepValue(KM.VECTOR_LAGRANGE_MULTIPLIER, now[6 + j])
        node.SetValue(KM.TANGENT_XI, now[8 + j])
        node.SetValue(KM.INITIAL_PENALTY, penalties[j])
        node.SetValue(CSMA.DYNAMIC_FACTOR, factors[j])
        node.SetValue(KM.FRICTION_COEFFICIENT, 0.4)
        node.Set(KM.ACTIVE, states[j] > 0)
        node.Set(KM.SLIP, states[j] == 2)
    b = KM.Vector()
    pair.CalculateRightHandSide(b, info)
    return 36, list(b)


# ---------------------------------------------------------------- files

FILES = {
    "applications/structural_mechanics/src/elements/reference_elements.txt": element,
    "applications/structural_mechanics/src/conditions/reference_loads.txt": load,
    "applications/contact_structural_mechanics/src/mortar/reference_pairs.txt": mortar_pair,
    "applications/contact_structural_mechanics/src/pairs/reference_residuals.txt": residual,
}


def renewed(text, compute):
    """The text with its numbers computed anew, the numbers compared, the largest difference, and what differs too much."""
    lines, count, largest, wrong, step = [], 0, 0.0, [], {}
    for at, line in enumerate(text.splitlines(), 1):
        if line.startswith("#"):
            lines.append(line)
            continue
        words = line.split()
        given, numbers = compute(words, step)
        old = words[given:] or ["nan"] * len(numbers)
        new = ["-" if word == "-" else repr(number) for word, number in zip(old, numbers, strict=True)]
        pairs = [(float(a), float(b)) for a, b in zip(old, new) if a != "-"]
        scale = min(1.0, max((abs(a) for a, _ in pairs), default=1.0))
        for a, b in pairs:
            difference = abs(a - b) / scale
            largest = max(largest, difference)
            if not difference <= 1e-10:
                wrong.append(f"  line {at}: {a!r} in the file, {b!r} now")
        count += len(pairs)
        lines.append(" ".join(words[:given] + new))
    return "\n".join(lines) + "\n", count, largest, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--check", action="store_true")
    what.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    failed = False
    print("Kratos", KM.KratosGlobals.Kernel.Version())
    for path, compute in FILES.items():
        path = os.path.join(ROOT, path)
        with open(path) as file:
            text, count, largest, wrong = renewed(file.read(), compute)
        print(f"{os.path.basename(path)}: {count} numbers, largest difference {largest:.1e}, {len(wrong)} above 1e-10")
        if arguments.write:
            with open(path, "w") as file:
                file.write(text)
        else:
            print("\n".join(wrong), end="\n" if wrong else "")
            failed = failed or bool(wrong)
    sys.exit(failed)


if __name__ == "__main__":
    main()
