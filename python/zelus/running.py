"""Runs decks."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .driving import Driving
from .errors import ZelusError
from .model import Model
from .process import process_of
from .result import Result


class Step:
    """The end of a step, as callbacks see it: `time`, and the model."""

    def __init__(self, time: float, model: Model):
        self.time = time
        self.model = model

    def field(self, name: str) -> np.ndarray:
        """A copy of a nodal field, one row a node."""
        return self.model._field(name)


def run(
    deck: str | os.PathLike,
    *,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    like: str | None = None,
    on_step: Callable[[Step], Any] | None = None,
    progress: bool | None = None,
) -> Result:
    """Runs a deck to its end and gives its result.

    deck: path of ProjectParameters.json. Its own processes in Python are found beside it.
    set: values in place of the deck's by dotted paths, {"solver_settings.max_iteration": 20}; places in lists count from 0.
    threads: all of the machine when not given; results do not depend on it.
    like: "kratos" for Kratos' defaults where the deck names nothing.
    on_step: called with a Step after each step; what it raises ends the run after the step, as Ctrl-C does.
    progress: a line that tells how far the run is; by default in terminals and notebooks.

    Raises InputError, NotConvergedError or SystemFailure; their `result` holds what was computed before.
    """
    deck = Path(deck)
    model = Model()
    make = process_of(model, deck.parent)
    driving = Driving(deck, changes=set, threads=threads, like=like, make=make, progress=progress)
    model._attach(driving)
    try:
        _steps(driving, model, on_step)
    except BaseException as error:
        ended = Result._of(driving.result())
        if isinstance(error, (ZelusError, KeyboardInterrupt)):
            error.result = ended if ended is not None and len(ended.points) else None
        raise
    return Result._of(driving.result())


def _steps(driving, model, on_step):
    while driving.do("step")[1]:
        stop = KeyboardInterrupt() if driving.interrupted else None
        try:
            if on_step is not None:
                on_step(Step(model._time(), model))
        except BaseException as error:
            stop = error
        if stop is not None:
            # the step is whole: processes write what they hold
            driving.do("finish")
            raise stop
