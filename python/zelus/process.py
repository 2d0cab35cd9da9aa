"""Processes in Python: their base, and how a deck's own are found."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path

from .parameters import Parameters

# Factories by name, as `register_process` adds them.
_REGISTERED = {}


class Process:
    """Something done at fixed points of the loop; hooks that are not overridden do nothing."""

    def ExecuteInitialize(self):
        """Mesh and materials are read, the solver is not ready yet."""

    def ExecuteBeforeSolutionLoop(self):
        """All is ready, before the first step."""

    def ExecuteInitializeSolutionStep(self):
        """Time has advanced, nothing is solved; once more where a step is cut."""

    def ExecuteFinalizeSolutionStep(self):
        """The step is solved and accepted."""

    def ExecuteBeforeOutputStep(self):
        """Some process writes output now."""

    def ExecuteAfterOutputStep(self):
        """Output is written."""

    def ExecuteFinalize(self):
        """After the last step, also when a step failed."""

    def Check(self):
        """All is ready; raises an error where the process cannot run."""
        return 0

    def IsOutputStep(self):
        """Whether it writes output after this step."""
        return False

    def PrintOutput(self):
        """Writes output."""

    def Clear(self):
        """Drops caches."""


class OutputProcess(Process):
    """A process that writes output."""

    def IsOutputStep(self):
        """Whether it writes output after this step: after each."""
        return True


def register_process(name, factory=None):
    """Makes a process known by the name that decks give as "python_module"; also as a decorator of a class.

    factory(settings, model) gives the process, `settings` being the entry of the deck as Parameters. A class is called with the
    model and the "Parameters" of the entry.
    """
    if factory is None:
        return lambda made: register_process(name, made) or made
    _REGISTERED[name] = _of_class(factory) if isinstance(factory, type) else factory
    return None


def _of_class(made):
    return lambda settings, model: made(model, settings["Parameters"])


def process_of(model, folder):
    """Factory of the Python processes of a deck in `folder`; returns `None` for those of the program."""
    folder = Path(folder).resolve()

    def make(entry, known):
        module = entry.get("python_module") or entry.get("name") or ""
        last = module.rsplit(".", 1)[-1]
        factory = _REGISTERED.get(last)
        if factory is None:
            factory = _factory(module, entry.get("kratos_module", ""), folder, known)
        if factory is None:
            return None
        return _complete(factory(Parameters(entry), model))

    return make


def _factory(module, kratos_module, folder, known):
    """`Factory` of a module beside the deck or, where the program knows no process of that name, of one that can be imported."""
    from . import kratos

    last = module.rsplit(".", 1)[-1]
    file = folder / f"{last}.py"
    # as in Kratos, a name with a package is a process of that package
    if file.exists() and not (known and kratos_module):
        with kratos.installed():
            return _load(last, file).Factory
    if known:
        return None
    names = [f"{kratos_module}.{module}", module] if kratos_module else [module]
    for name in names:
        top = name.split(".")[0]
        if top in ("", "KratosMultiphysics") or not _is_there(name):
            continue
        with kratos.installed():
            found = importlib.import_module(name)
        if hasattr(found, "Factory"):
            return found.Factory
    return None


def _is_there(name):
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _load(name, file):
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(file.parent))
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(file.parent))
    return module


def _complete(process):
    """The process itself, or one that has what it lacks of the methods."""
    lacking = [name for name in vars(Process) if not name.startswith("_") and not hasattr(process, name)]
    for name in lacking:
        setattr(process, name, getattr(Process, name).__get__(process))
    return process
