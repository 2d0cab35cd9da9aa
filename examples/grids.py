"""Meshes of rectangles for the examples, as mdpa files (standard library only)."""


class Grid:
    """Rectangles of quadrilaterals; parts hold nodes, elements and conditions, conditions are edges with the body on their left."""

    def __init__(self):
        self.nodes, self.elements, self.conditions, self.parts = [], [], [], {}

    def rectangle(self, name, columns, rows, place=lambda x, y: (x, y)):
        """A part with nodes at the product of both lists; gives its sides, each nodes with the edges between them."""
        base, first = len(self.nodes), len(self.elements) + 1
        self.nodes += [place(x, y) for x in columns for y in rows]
        n, m = len(columns), len(rows)
        node = lambda i, j: base + i * m + j + 1
        self.elements += [
            (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)) for i in range(n - 1) for j in range(m - 1)
        ]
        self.parts[name] = (range(base + 1, len(self.nodes) + 1), range(first, len(self.elements) + 1), ())
        around = {
            "bottom": [node(i, 0) for i in range(n)],
            "right": [node(n - 1, j) for j in range(m)],
            "top": [node(i, m - 1) for i in reversed(range(n))],
            "left": [node(0, j) for j in reversed(range(m))],
        }
        sides = {}
        for side, chain in around.items():
            edges = range(len(self.conditions) + 1, len(self.conditions) + len(chain))
            self.conditions += list(zip(chain, chain[1:]))
            sides[side] = (chain, edges)
        return sides

    def part(self, name, *sides):
        """A part with the nodes and edges of these sides."""
        self.parts[name] = ([n for nodes, _ in sides for n in nodes], (), [e for _, edges in sides for e in edges])

    def probe(self, name, node):
        """A part of one node."""
        self.parts[name] = ([node], (), ())

    def write(self, path, element, loads=(), load="LineLoadCondition2D2N"):
        """Writes the file; the edges in `loads` are conditions of the kind `load`."""
        with open(path, "w") as out:
            out.write("Begin Properties 0\nEnd Properties\nBegin Nodes\n")
            out.writelines(f"{at} {x!r} {y!r} 0.0\n" for at, (x, y) in enumerate(self.nodes, 1))
            out.write(f"End Nodes\nBegin Elements {element}\n")
            out.writelines(f"{at} 0 {' '.join(map(str, row))}\n" for at, row in enumerate(self.elements, 1))
            out.write("End Elements\n")
            for kind, loaded in (("LineCondition2D2N", False), (load, True)):
                rows = [(at, *row) for at, row in enumerate(self.conditions, 1) if (at in loads) == loaded]
                if rows:
                    out.write(f"Begin Conditions {kind}\n")
                    out.writelines(f"{at} 0 {a} {b}\n" for at, a, b in rows)
                    out.write("End Conditions\n")
            for name, lists in self.parts.items():
                out.write(f"Begin SubModelPart {name}\n")
                for kind, ids in zip(("Nodes", "Elements", "Conditions"), lists):
                    body = "".join(f"{i}\n" for i in sorted(set(ids)))
                    out.write(f"Begin SubModelPart{kind}\n{body}End SubModelPart{kind}\n")
                out.write("End SubModelPart\n")


def steps(start, end, count):
    """Numbers from start to end, count intervals of one length."""
    return [start + (end - start) * i / count for i in range(count + 1)]
