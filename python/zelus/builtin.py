"""Processes of the program as objects that Python calls itself."""

from __future__ import annotations

from pathlib import Path

from . import _zelus
from .errors import error_of
from .process import Process


def _raising(call, *arguments):
    try:
        return call(*arguments)
    except RuntimeError as error:
        text = str(error)
        raise (error_of(text) if text.startswith("{") else error) from None


class BuiltinProcess(Process):
    """A process of the program, such as "assign_vector_variable_process", made once the mesh is read.

    It acts when its methods are called, by Python. Contact and ties belong into the deck.
    """

    def __init__(self, model, name, parameters, folder="."):
        session = model._session
        self._own = _raising(_zelus.Builtin, session, name, parameters._value, str(Path(folder)))

    def IsOutputStep(self):
        """Whether it writes output after this step."""
        return _raising(self._own.call, "IsOutputStep")


def _method(name):
    def call(self):
        _raising(self._own.call, name)

    call.__name__, call.__doc__ = name, getattr(Process, name).__doc__
    return call


for _name in [*(name for name in vars(Process) if name.startswith("Execute")), "PrintOutput"]:
    setattr(BuiltinProcess, _name, _method(_name))
