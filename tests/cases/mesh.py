"""Small structured meshes for the decks of this folder: boxes of any cell shape, their facets, and the mdpa text."""
import itertools, math

FACES = {  # outward oriented
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tet": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
    "prism": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "hex": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}
CORNERS = {"tri": 3, "quad": 4, "tet": 4, "prism": 6, "hex": 8}
QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
PRISM_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)]
HEX_EDGES = QUAD_EDGES + [(0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
HEX_FACES = [(0, 1, 2, 3), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
# shape name -> (linear cell, corner groups whose means are the further nodes)
SHAPES = {
    "2D3N": ("tri", []),
    "2D4N": ("quad", []),
    "3D4N": ("tet", []),
    "3D6N": ("prism", []),
    "3D8N": ("hex", []),
    "2D6N": ("tri", [(0, 1), (1, 2), (2, 0)]),
    "2D8N": ("quad", QUAD_EDGES),
    "2D9N": ("quad", QUAD_EDGES + [(0, 1, 2, 3)]),
    "3D10N": ("tet", [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]),
    "3D15N": ("prism", PRISM_EDGES),
    "3D20N": ("hex", HEX_EDGES),
    "3D27N": ("hex", HEX_EDGES + HEX_FACES + [tuple(range(8))]),
}


def split(kind, c):
    """The cells of `kind` that fill one quadrilateral or hexahedron."""
    if kind in ("quad", "hex"):
        return [c]
    if kind == "tri":
        return [(c[0], c[1], c[2]), (c[0], c[2], c[3])]
    if kind == "prism":
        return [(c[0], c[1], c[2], c[4], c[5], c[6]), (c[0], c[2], c[3], c[4], c[6], c[7])]
    # six tetrahedra around the diagonal 0-6, one a permutation of the axes, so that neighbours match
    step = {0: 1, 1: 2, 2: 4}
    at = {0: c[0], 1: c[1], 3: c[2], 2: c[3], 4: c[4], 5: c[5], 7: c[6], 6: c[7]}
    cells = []
    for axes in itertools.permutations(range(3)):
        walk = [0]
        for axis in axes:
            walk.append(walk[-1] + step[axis])
        even = axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        walk = walk if even else [walk[0], walk[2], walk[1], walk[3]]
        cells.append(tuple(at[i] for i in walk))
    return cells


class Box:
    """A box of cells: node ids, cells, and the oriented facets of its sides "x0", "x1", "y0", ... ."""

    def __init__(self, mesh, name, shape, divisions, low, high, mapping=None, distortion=0.0,
                 element="SmallDisplacementElement"):
        kind, groups = SHAPES[shape]
        dim = len(divisions)
        self.mesh, self.name, self.shape, self.dim = mesh, name, shape, dim
        counts = [n + 1 for n in divisions]
        ids, self.reference = {}, {}
        for index in itertools.product(*(range(n) for n in reversed(counts))):
            index = index[::-1]
            at = [a + (b - a) * i / n for a, b, i, n in zip(low, high, index, divisions)]
            moved = list(at)
            if all(0 < i < n for i, n in zip(index, divisions)):
                for d in range(dim):
                    wave = math.sin(12.9898 * index[0] + 78.233 * index[1] + 37.719 * (index[2] if dim > 2 else 0) + 4.1 * d)
                    moved[d] += distortion * wave * (high[d] - low[d]) / divisions[d]
            ids[index] = mesh.add_node(mapping(*moved) if mapping else moved)
            self.reference[ids[index]] = tuple(at)
        self.cells = []
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)] if dim == 2 else [
            (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        for index in itertools.product(*(range(n) for n in reversed(divisions))):
            base = index[::-1]
            self.cells += split(kind, tuple(ids[tuple(b + c for b, c in zip(base, corner))] for corner in corners))
        seen = {}
        for cell in self.cells:
            for face in FACES[kind]:
                nodes = tuple(cell[i] for i in face)
                seen.setdefault(tuple(sorted(nodes)), []).append(nodes)
        boundary = [faces[0] for faces in seen.values() if len(faces) == 1]
        between = {}
        for position, cell in enumerate(self.cells):
            for group in groups:
                key = tuple(sorted(cell[i] for i in group))
                if key not in between:
                    between[key] = mesh.add_node(mean([mesh.nodes[i] for i in key]))
                    self.reference[between[key]] = mean([self.reference[i] for i in key])
            self.cells[position] = cell + tuple(between[tuple(sorted(cell[i] for i in g))] for g in groups)
        self.nodes = sorted(self.reference)
        self.side_nodes, self.facets = {}, {}
        for d, letter in enumerate("xyz"[:dim]):
            for end, value in (("0", low[d]), ("1", high[d])):
                on = {i for i, at in self.reference.items() if abs(at[d] - value) < 1e-9}
                self.side_nodes[letter + end] = sorted(on)
                self.facets[letter + end] = [f for f in boundary if all(i in on for i in f)]
        self.boundary = sorted(set().union(*self.side_nodes.values()))
        self.elements = [mesh.add_element(element + shape, cell) for cell in self.cells]
        self.skin = []
        mesh.part(name, self.nodes, self.elements)

    def conditions(self, side, family, where=None):
        """Adds conditions of `family` ("Line", "SurfaceLoad", ...) on a side; their ids."""
        made = []
        for facet in self.facets[side]:
            if where is None or where(mean([self.mesh.nodes[i] for i in facet])):
                made.append(self.mesh.add_condition(f"{family}Condition{self.dim}D{len(facet)}N", facet))
        # with its conditions in the body's part, the material reaches them: contact takes its stiffness from there
        self.skin += made
        self.mesh.part(self.name, self.nodes, self.elements, self.skin)
        return made


def mean(points):
    return tuple(sum(p[d] for p in points) / len(points) for d in range(len(points[0])))


class Mesh:
    """Nodes, elements, conditions and sub model parts of one deck."""

    def __init__(self):
        self.nodes, self.elements, self.condition_list, self.parts, self.nodal_data = {}, [], [], {}, {}
        self.digits = 12

    def add_node(self, at):
        self.nodes[len(self.nodes) + 1] = tuple(at) + (0.0,) * (3 - len(at))
        return len(self.nodes)

    def add_element(self, name, nodes):
        self.elements.append((name, nodes))
        return len(self.elements)

    def add_condition(self, name, nodes):
        self.condition_list.append((name, nodes))
        return len(self.condition_list)

    def part(self, name, nodes=(), elements=(), conditions=()):
        self.parts[name] = (sorted(nodes), sorted(elements), sorted(conditions))
        return name

    def nodal_h(self):
        """Shortest distance of every node to another node of one of its elements."""
        shortest = {}
        for _, cell in self.elements:
            for i in cell:
                distance = min(math.dist(self.nodes[i], self.nodes[j]) for j in cell if j != i)
                shortest[i] = min(shortest.get(i, math.inf), distance)
        return shortest

    def facet_size(self, facet):
        p = [self.nodes[i] for i in facet]
        if len(p) == 2:
            return math.dist(*p)
        halves = [(p[0], p[1], p[2])] + ([(p[0], p[2], p[3])] if len(p) == 4 else [])
        total = 0.0
        for a, b, c in halves:
            u, v = [x - y for x, y in zip(b, a)], [x - y for x, y in zip(c, a)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            total += 0.5 * math.hypot(*n)
        return total

    def text(self):
        """The mesh as mdpa; every entity has property 0, the materials file gives the others."""
        out = ["Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n"]
        out += ["{} {:.{d}g} {:.{d}g} {:.{d}g}\n".format(i, *at, d=self.digits) for i, at in self.nodes.items()]
        out.append("End Nodes\n")
        for kind, rows in (("Elements", self.elements), ("Conditions", self.condition_list)):
            numbered = list(enumerate(rows, 1))
            for name, group in itertools.groupby(numbered, key=lambda row: row[1][0]):
                out.append(f"\nBegin {kind} {name}\n")
                out += [f"{i} 0 {' '.join(map(str, nodes))}\n" for i, (_, nodes) in group]
                out.append(f"End {kind}\n")
        for name, values in self.nodal_data.items():
            out.append(f"\nBegin NodalData {name}\n")
            out += [f"{i} 0 {value:.12g}\n" for i, value in values.items()]
            out.append("End NodalData\n")
        for name, lists in self.parts.items():
            out.append(f"\nBegin SubModelPart {name}\n")
            for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
                if ids:
                    rows = [" ".join(map(str, ids[i:i + 16])) + "\n" for i in range(0, len(ids), 16)]
                    out.append(f"  Begin SubModelPart{kind}\n    " + "    ".join(rows) + f"  End SubModelPart{kind}\n")
            out.append("End SubModelPart\n")
        return "".join(out)
