"""Conditions and laws in Python, for prototyping: a residual as a function over all entities of a part."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence

import numpy as np

from .process import Process, register_process


class Entities:
    """Entities of a part with one number of nodes each, as a residual sees them.

    ids: of the entities. nodes: indices of their nodes, one row each. x: initial positions (entity, node, 3). u: values of the
    unknowns (entity, node, unknown). time, delta_time: of the step. parameters: what the deck says, as Parameters.
    """

    def __init__(self, ids, nodes, x, parameters):
        self.ids, self.nodes, self.x, self.parameters = ids, nodes, x, parameters
        self.u = None
        self.time = self.delta_time = 0.0

    def size(self):
        """The largest distance of two nodes of each entity."""
        ends = self.x[:, :, None, :] - self.x[:, None, :, :]
        return np.sqrt((ends**2).sum(-1)).max(axis=(1, 2))


def residual(
    name: str,
    unknowns: Sequence[str],
    *,
    entities: str = "conditions",
    tangent: Callable[[Entities], np.ndarray] | None = None,
    symmetric: bool = False,
    step: float | None = None,
):
    """Registers a function as what acts on the entities of a part; decks name it as the "python_module" of a process.

    The function is called with Entities and gives the forces on their nodes, (entity, node, unknown), as external minus internal
    ones. It is called for all entities at once, but in Python, and for the tangent twice a row: it is slow, and meant to try things.

    name: what decks call it. unknowns: single numbers, as DISPLACEMENT_X; elements bring them. entities: of the part that
    "model_part_name" names: "conditions", "elements" or "nodes". tangent: gives minus the derivative of the residual, (entity, row,
    row), rows being nodes with their unknowns; by central differences when not given. symmetric: whether the tangent is. step: of
    the differences, in the unit of the unknowns; by default a small part of the entity's size, or of the values.
    """

    def register(function):
        def factory(settings, model):
            return _Residual(function, tangent, list(map(str, unknowns)), entities, symmetric, step, model, settings["Parameters"])

        register_process(name, factory)
        return function

    return register


class _Residual(Process):
    """The process that brings a residual into a run."""

    def __init__(self, function, tangent, unknowns, entities, symmetric, step, model, parameters):
        self._function, self._tangent, self._step = function, tangent, step
        self._unknowns, self._model, self._parameters = unknowns, model, parameters
        self._blocks = []
        self.part = model[parameters["model_part_name"].GetString()]
        own = {"part": self.part.FullName(), "entities": entities, "unknowns": unknowns, "symmetric": symmetric}
        self.description = json.dumps(own)

    def block(self, at, ids, nodes, width):
        """Hears of entities."""
        nodes = np.asarray(nodes).reshape(-1, width)
        points = self.part.GetRootModelPart().positions(initial=True)
        own = Entities(np.asarray(ids), nodes, points[nodes], self._parameters)
        size = own.size() if width > 1 else np.full(len(nodes), 1e-3 * np.ptp(points, axis=0).max())
        self._blocks[at:] = [(own, size)]

    def evaluate(self, at, values, time, length, both):
        """Residual and, where `both` are wanted, tangent."""
        own, size = self._blocks[at]
        own.u = np.asarray(values).reshape(*own.nodes.shape, len(self._unknowns))
        own.time, own.delta_time = time, length
        force = self._forces(own)
        tangent = self._derivative(own, size) if both else np.empty(0)
        return force.tobytes(), np.ascontiguousarray(tangent, float).tobytes()

    def _forces(self, own):
        force = np.ascontiguousarray(self._function(own), float)
        if force.shape != own.u.shape:
            raise ValueError(f"the residual has the shape {force.shape}, and should have that of u, {own.u.shape}")
        return force

    def _derivative(self, own, size):
        count, rows = len(own.u), own.u[0].size
        if self._tangent is not None:
            tangent = np.asarray(self._tangent(own))
            if tangent.shape != (count, rows, rows):
                raise ValueError(f"the tangent has the shape {tangent.shape}, and should have {(count, rows, rows)}")
            return tangent
        tangent = np.empty((count, rows, rows))
        held = own.u
        for row in range(rows):
            step = self._steps(row, held, size)
            ends = []
            for sign in (1, -1):
                own.u = held.copy()
                own.u.reshape(count, rows)[:, row] += sign * step
                ends.append(self._forces(own).reshape(count, rows))
            tangent[:, :, row] = (ends[1] - ends[0]) / (2 * step[:, None])
        own.u = held
        return tangent

    def _steps(self, row, values, size):
        """Steps of central differences, whose error is the third root of the last digit."""
        at = row % len(self._unknowns)
        if self._step is not None:
            return np.full(len(values), self._step)
        moves = self._unknowns[at].startswith("DISPLACEMENT")
        scale = size if moves else np.full(len(values), np.abs(values[:, :, at]).max() or 1.0)
        return np.cbrt(np.finfo(float).eps) * scale
