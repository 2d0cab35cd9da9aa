"""Results of a run."""

from __future__ import annotations

import json
from dataclasses import dataclass, field

import numpy as np

# Cells in meshio and VTK: their names there, their numbers in VTK, and which node stands at each place.
_HEX20 = [*range(12), 16, 17, 18, 19, 12, 13, 14, 15]
_CELLS = {
    "Point1": ("vertex", 1, None),
    "Line2": ("line", 3, None),
    "Line3": ("line3", 21, None),
    "Tri3": ("triangle", 5, None),
    "Tri6": ("triangle6", 22, None),
    "Quad4": ("quad", 9, None),
    "Quad8": ("quad8", 23, None),
    "Quad9": ("quad9", 28, None),
    "Tet4": ("tetra", 10, None),
    "Tet10": ("tetra10", 24, None),
    "Prism6": ("wedge", 13, None),
    "Prism15": ("wedge15", 26, [*range(9), 12, 13, 14, 9, 10, 11]),
    "Hex8": ("hexahedron", 12, None),
    "Hex20": ("hexahedron20", 25, _HEX20),
    "Hex27": ("hexahedron27", 29, [*_HEX20, 24, 22, 21, 23, 20, 25, 26]),
}

_STEP = [("step", int), ("time", float), ("delta_time", float), ("converged", bool), ("iterations", int)]
_ITERATION = [
    ("step", int),
    ("iteration", int),
    ("ratio", float),
    ("active_set_changes", int),
    ("stick_slip_changes", int),
    ("linear_iterations", int),
    ("linear_residual", float),
]


def worst_ratio(record):
    """The largest measure of an iteration by its tolerance; at most 1 where it has converged."""

    def ratio(check):
        pairs = [("ratio", "ratio_tolerance"), ("absolute", "absolute_tolerance")]
        return min(check[own] / check[limit] if check[limit] else np.inf for own, limit in pairs)

    return max((ratio(check) for check in record["checks"]), default=0.0)


def _arrays(value):
    """Arrays over the buffers, which are not copied."""
    if isinstance(value, dict):
        return {key: _arrays(own) for key, own in value.items()}
    return value if isinstance(value, str) else np.asarray(value)


@dataclass
class Result:
    """Mesh, fields at the end of the last step, and the report of the run; it can be pickled.

    points: initial positions, one row a node. node_ids: ids of the mesh file. cells: node indices by shape, one row an element;
    element_ids: their ids in that order. parts: node indices by sub model part, dotted below the root. fields: by variable, one
    row a node. element_fields: one row an element in the order of cells. report: sizes, steps, iterations, contact, timings and
    warnings, as `zelus run --report` writes them.
    """

    report: dict
    name: str = ""
    points: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    node_ids: np.ndarray = field(default_factory=lambda: np.empty(0, int))
    cells: dict = field(default_factory=dict)
    element_ids: np.ndarray = field(default_factory=lambda: np.empty(0, int))
    parts: dict = field(default_factory=dict)
    fields: dict = field(default_factory=dict)
    element_fields: dict = field(default_factory=dict)

    @classmethod
    def _of(cls, ended):
        if ended is None:
            return None
        report, raw = ended
        return cls(report=json.loads(report), **{key: _arrays(value) for key, value in (raw or {}).items()})

    def __getitem__(self, name: str) -> np.ndarray:
        """The nodal field of that name."""
        if name not in self.fields:
            raise KeyError(f"there is no field {name}; there are {', '.join(sorted(self.fields))}")
        return self.fields[name]

    def __repr__(self):
        end = "to its end" if self.converged else "and did not come to its end"
        return f"<zelus.Result of {self.report['problem']}: {len(self.points)} nodes, {len(self.times)} steps, {end}>"

    def of_part(self, part: str, name: str | None = None) -> np.ndarray:
        """The rows of a nodal field at the nodes of a sub model part; without a name those of the points."""
        if part not in self.parts:
            raise KeyError(f"there is no sub model part {part}; there are {', '.join(sorted(self.parts))}")
        return (self.points if name is None else self[name])[self.parts[part]]

    @property
    def converged(self) -> bool:
        """Whether the deck was run to its end."""
        return self.report["converged"]

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run."""
        return self.report["warnings"]

    @property
    def steps(self) -> np.ndarray:
        """Attempts at steps, those that were cut too: step, time, delta_time, converged, iterations."""
        rows = [
            (step["step"], step["time"], step["delta_time"], step["converged"], len(step["iterations"]))
            for step in self.report["steps"]
        ]
        return np.array(rows, dtype=_STEP)

    @property
    def iteration_records(self) -> np.ndarray:
        """Iterations of all attempts: step, iteration, ratio (worst measure to its tolerance), changes of state, linear solves."""
        rows = [
            (
                step["step"],
                record["iteration"],
                worst_ratio(record),
                record["active_set_changes"],
                record["stick_slip_changes"],
                record["linear_iterations"],
                record["linear_residual"],
            )
            for step in self.report["steps"]
            for record in step["iterations"]
        ]
        return np.array(rows, dtype=_ITERATION)

    @property
    def times(self) -> np.ndarray:
        """End of each step that converged."""
        return self.steps["time"][self.steps["converged"]]

    @property
    def iterations(self) -> np.ndarray:
        """Iterations of each step that converged."""
        return self.steps["iterations"][self.steps["converged"]]

    @property
    def contact(self) -> dict[str, np.ndarray]:
        """Numbers of contact by name, one for each step that converged, such as active nodes."""
        steps = [dict(step["interactions"]) for step in self.report["steps"] if step["converged"]]
        names = {name: None for step in steps for name in step}
        return {name: np.array([step.get(name, np.nan) for step in steps]) for name in names}

    def to_meshio(self):
        """A meshio.Mesh with all fields (needs meshio)."""
        import meshio

        cells = [(_CELLS[shape][0], self._ordered(shape)) for shape in self.cells]
        ends = np.cumsum([len(own) for own in self.cells.values()])[:-1]
        cell_data = {name: np.split(values, ends) for name, values in self.element_fields.items()}
        return meshio.Mesh(self.points, cells, point_data=dict(self.fields), cell_data=cell_data)

    def to_pyvista(self):
        """A pyvista.UnstructuredGrid with all fields (needs pyvista)."""
        import pyvista

        cells = [self._ordered(shape) for shape in self.cells]
        counted = [np.column_stack([np.full(len(own), own.shape[1]), own]).ravel() for own in cells]
        types = [np.full(len(own), _CELLS[shape][1], np.uint8) for shape, own in self.cells.items()]
        joined = [np.concatenate(lists) if lists else np.empty(0, int) for lists in (counted, types)]
        grid = pyvista.UnstructuredGrid(*joined, self.points)
        grid.point_data.update(self.fields)
        grid.cell_data.update(self.element_fields)
        return grid

    def plot(self):
        """Convergence of all attempts at steps, and the state of contact over time (needs matplotlib); gives the figure."""
        import matplotlib.pyplot as plt

        figure, (above, below) = plt.subplots(2, 1, layout="constrained")
        records = self.iteration_records
        solves = np.arange(1, len(records) + 1)
        above.semilogy(solves, np.maximum(records["ratio"], 1e-16), ".-")
        above.axhline(1.0, color="grey", linewidth=0.8)
        above.set_xlabel("iteration")
        above.set_ylabel("measure / tolerance")
        for name, values in self.contact.items():
            below.plot(self.times, values, ".-", label=name)
        if self.contact:
            below.legend()
        else:
            below.step(self.times, self.iterations, where="mid")
            below.set_ylabel("iterations")
        below.set_xlabel("time")
        return figure

    def _ordered(self, shape):
        order = _CELLS[shape][2]
        return self.cells[shape] if order is None else self.cells[shape][:, order]
