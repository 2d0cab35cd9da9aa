"""Errors that stop a run, and its warnings."""

from __future__ import annotations

import json
from dataclasses import dataclass


@dataclass(frozen=True)
class Problem:
    """One problem of the input: code, place, fact and remedy."""

    code: str
    severity: str
    fact: str
    remedy: str | None = None
    file: str | None = None
    line: int = 0
    column: int = 0

    @property
    def place(self) -> str | None:
        """File, line and column, as far as they are known; `None` where no file is to blame."""
        numbers = [str(number) for number in (self.line, self.column) if number]
        return ":".join([self.file, *numbers]) if self.file else None

    def __str__(self):
        place = f" {self.place}" if self.place else ""
        remedy = f"\n    {self.remedy}" if self.remedy else ""
        return f"{self.severity}[{self.code}]{place}: {self.fact}{remedy}"


class ZelusError(Exception):
    """A run that did not come to its end; `result` holds the converged steps, `None` where nothing was run."""

    def __init__(self, text, problems=(), result=None):
        super().__init__(text)
        self.problems = tuple(problems)
        self.result = result

    def __reduce__(self):
        return type(self), (str(self), self.problems, self.result)

    def _first(self):
        errors = [problem for problem in self.problems if problem.severity == "error"]
        return errors[0] if errors else None

    @property
    def code(self) -> str | None:
        """The code of the first problem."""
        first = self._first()
        return first.code if first else None

    @property
    def place(self) -> str | None:
        """The place of the first problem, as file:line:column."""
        first = self._first()
        return first.place if first else None

    @property
    def remedy(self) -> str | None:
        """The remedy of the first problem."""
        first = self._first()
        return first.remedy if first else None


class InputError(ZelusError):
    """The deck is wrong: every problem that was found is in `problems`."""


class NotConvergedError(ZelusError):
    """A step did not converge, however short."""


class SystemFailure(ZelusError):
    """The machine, a file or a solver failed."""


class ZelusWarning(UserWarning):
    """Warning of a run; the text begins with its code."""


_KINDS = {"input": InputError, "not_converged": NotConvergedError, "system": SystemFailure}


def error_of(text):
    """The exception that the compiled part describes as JSON."""
    said = json.loads(text)
    return _KINDS[said["kind"]](said["text"], [Problem(**problem) for problem in said["problems"]])
