"""Constitutive laws in Python, for prototyping: stress as a function of strain, for many points in a call."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ._zelus import add_law

# Half the width of the differences of strains, whose error is the third root of the last digit.
_STEP = float(np.cbrt(np.finfo(float).eps))


@dataclass(frozen=True)
class Points:
    """Points of one material, as a law sees them; arrays have a row a point.

    strain: xx, yy, zz, xy, yz, xz in space; xx, yy, zz, xy in plane strain and about the axis (rr, zz, circumferential, rz); xx, yy, xy
    in plane stress. Shear is doubled. Small strains, or Green and Lagrange's in elements of finite strain. state: state variables after
    the last accepted step. time, delta_time: at the end of the step, and its length. parameters: LAW_PARAMETERS of the material.
    elements: id of the element, 0 where there is none. gauss: number of the Gauss point in it, from 1.
    """

    strain: np.ndarray
    state: np.ndarray
    time: float
    delta_time: float
    parameters: np.ndarray
    elements: np.ndarray
    gauss: np.ndarray


def law(name: str, function: Callable | None = None):
    """Registers a function as a law, which materials name in LAW_FUNCTION; also as a decorator.

    The function is called with Points and gives the stress, (point, component): Piola and Kirchhoff's second one where strains are
    Green and Lagrange's. It may give its tangent too, (point, component, component), the derivative by the strain; and then the state
    variables at the end of the step, (point, variable). A tangent of None, or none, is found by central differences where it is wanted, at
    twice as many calls as there are components. The function is called with the points of up to 32 elements of a thread, one thread at a time: it is slow, and meant
    to try things.
    """
    if function is None:
        return lambda given: law(name, given) or given

    def respond(sizes, time, wants_tangent, lists):
        count, components, states = sizes
        strain, state, parameters, places = (np.frombuffer(own) for own in lists)
        places = places.reshape(count, 2).astype(int)
        points = Points(
            strain.reshape(count, components),
            state.reshape(count, states),
            time[1],
            time[1] - time[0],
            parameters,
            places[:, 0],
            places[:, 1],
        )
        stress, tangent, now = _answer(function, points)
        numbers = {"stress": (stress, (count, components)), "state": (now, (count, states))}
        if wants_tangent:
            tangent = _differences(function, points) if tangent is None else tangent
            numbers["tangent"] = (tangent, (count, components, components))
        for what, (own, shape) in numbers.items():
            if own.shape != shape:
                raise ValueError(f"the {what} has the shape {own.shape}, and should have {shape}")
        bytes_of = {what: np.ascontiguousarray(own, float).tobytes() for what, (own, _) in numbers.items()}
        return [bytes_of.get(what, b"") for what in ("stress", "tangent", "state")]

    add_law(name, respond)
    return None


def _answer(function, points):
    """Stress, tangent or None, and state variables."""
    given = function(points)
    given = given if isinstance(given, tuple) else (given,)
    stress, tangent, state = (*given, None, None)[:3]
    tangent = None if tangent is None else np.asarray(tangent, float)
    return np.asarray(stress, float), tangent, points.state if state is None else np.asarray(state, float)


def _differences(function, points):
    """The tangent by central differences."""
    columns = []
    for component in range(points.strain.shape[1]):
        ends = []
        for sign in (1, -1):
            strain = points.strain.copy()
            strain[:, component] += sign * _STEP
            ends.append(_answer(function, replace(points, strain=strain))[0])
        columns.append((ends[0] - ends[1]) / (2 * _STEP))
    return np.stack(columns, axis=-1)
