"""A run in its thread, driven from point to point."""

from __future__ import annotations

import json
import os
import warnings

from . import _zelus
from .errors import Problem, ZelusWarning, error_of
from .progress import Progress

# Seconds between two checks for signals.
_PAUSE = 0.05


class Driving:
    """Commands a run, answers what it asks, and raises what stops it.

    make: called with an entry of the deck's lists of processes and whether there is a process of that name; gives an object with
    the methods of `Process`, or `None` to leave it to the program.
    attended: whether it stops at the points of the loop.
    """

    def __init__(self, path, *, deck=None, changes=None, threads=None, like=None, attended=False, make=None, progress=None):
        self.processes = []
        self.end_time = None
        self.interrupted = False
        self.is_set_up = False
        self._make = make or (lambda entry, known: None)
        self._raised = None
        self._warnings = []
        self._progress = Progress(progress)
        try:
            self.session = _zelus.Session(os.fspath(path), deck, list((changes or {}).items()), threads, like, attended)
        except RuntimeError as error:
            raise error_of(str(error)) from None

    def do(self, command):
        """Begins to "prepare", "step" or "finish", and continues to the next stop."""
        self.session.command(command)
        return self.next()

    def go(self, what=None, error=None):
        """Answers at a stop, and continues to the next one."""
        self.session.answer(what=what, error=error)
        return self.next()

    def next(self):
        """The next stop: ("at", point) before what is done there, ("acted", point) after it, ("idle", more) after a command.

        Raises the error that ended the run.
        """
        while True:
            kind, *more = self._wait()
            if kind in ("at", "acted"):
                self.is_set_up |= more[0] == "ready"
                return kind, more[0]
            if kind == "idle":
                return self._idle(*more)
            if kind == "make":
                self._answer(lambda entry, known: self._add(self._make(json.loads(entry), known)), more)
            elif kind == "call":
                self.is_set_up &= more[1] != "ExecuteInitialize"
                self._call(*more)
            elif kind == "block":
                self._answer(lambda number, *own: self.processes[number].block(*own), more)
            elif kind == "evaluate":
                self._answer(self._evaluate, more)
            elif kind == "warning":
                self._warnings.append(Problem(**json.loads(more[0])))
            elif kind in ("stage", "begin", "iteration", "note"):
                if kind == "stage":
                    self.is_set_up, self.end_time = True, more[3]
                getattr(self._progress, kind)(*more)

    def result(self):
        """The report and, where a stage was prepared, mesh and fields; the session ends."""
        return self.session.end()

    def fail(self, error):
        """Ends the run at a stop, for an exception that is raised once the run has ended."""
        self._raised = error
        self.session.answer(error=f"{type(error).__name__}: {error}")

    def _wait(self):
        while True:
            try:
                event = self.session.wait(_PAUSE)
            except KeyboardInterrupt:
                if self.interrupted:
                    raise
                self.interrupted = True
                self._progress.note("ends after this step; once more to leave it")
                continue
            if event is not None:
                return event

    def _idle(self, more, error):
        problems, self._warnings = self._warnings, []
        for problem in problems:
            if problem.severity == "warning":
                warnings.warn(str(problem), ZelusWarning, stacklevel=5)
        if not more or error:
            self._progress.close()
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        if error:
            raise error_of(error)
        return "idle", more

    def _add(self, process):
        if process is None:
            return {}
        self.processes.append(process)
        return {"process": len(self.processes) - 1, "residual": getattr(process, "description", None)}

    def _evaluate(self, number, *wanted):
        if self._raised is not None:
            return {"error": "its function has failed"}
        return {"numbers": self.processes[number].evaluate(*wanted)}

    def _call(self, number, method):
        def call():
            out = getattr(self.processes[number], method)()
            return {"truth": bool(out)} if method == "IsOutputStep" else {}

        self._answer(call, [])

    def _answer(self, work, arguments):
        """Answers with what `work` gives; what it raises ends the run."""
        try:
            answer = work(*arguments) or {}
        except BaseException as error:
            # where an end follows a failure, the first one counts
            self._raised = self._raised or error
            answer = {"error": f"{type(error).__name__}: {error}"}
        self.session.answer(**answer)
