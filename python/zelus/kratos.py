"""The module `KratosMultiphysics` for programs and processes written for Kratos: its most used part, by zelus.

It exists once `install()` has been called, or while the processes of a deck are imported; a missing name of Kratos raises an
error that names it.
"""

from __future__ import annotations

import contextlib
import importlib.abc
import importlib.machinery
import json
import math
import os
import sys
import types
import unittest
import warnings

import numpy as np

from . import _zelus, analysis_stage, builtin, kratos_utilities, model, parameters, process, variables

_TOP = "KratosMultiphysics"
_APPLICATIONS = (
    "ConstitutiveLawsApplication",
    "ConstrainedOptimizationApplication",
    "ContactStructuralMechanicsApplication",
    "ConvectionDiffusionApplication",
    "ExternalSolversApplication",
    "LinearSolversApplication",
    "SolidMechanicsApplication",
    "StructuralMechanicsApplication",
)
_ANALYSES = {
    "analysis_stage": "AnalysisStage",
    "StructuralMechanicsApplication.structural_mechanics_analysis": "StructuralMechanicsAnalysis",
    "ContactStructuralMechanicsApplication.contact_structural_mechanics_analysis": "ContactStructuralMechanicsAnalysis",
    "ConvectionDiffusionApplication.convection_diffusion_analysis": "ConvectionDiffusionAnalysis",
}

# The program whose defaults analyses take where a deck names nothing.
_like = None


class _TestCase(unittest.TestCase):
    """A test case that processes may be, too."""

    _type_equality_funcs: dict = {}

    def __init__(self, method="runTest"):
        super().__init__(method)

    def runTest(self):
        """Nothing of its own."""

    def assertVectorAlmostEqual(self, first, second, places=7, msg=None, delta=None):
        """Compares two lists of numbers."""
        self.assertEqual(len(first), len(second), msg)
        for one, other in zip(first, second):
            self.assertAlmostEqual(one, other, None if delta else places, msg, delta)

    def assertMatrixAlmostEqual(self, first, second, places=7, msg=None, delta=None):
        """Compares two tables of numbers."""
        self.assertVectorAlmostEqual(np.ravel(first), np.ravel(second), places, msg, delta)

    def assertIsClose(self, first, second, rel_tol=1e-9, abs_tol=0.0, msg=None):
        """Compares two numbers."""
        np.testing.assert_allclose(first, second, rel_tol, abs_tol, err_msg=msg or "")

    def skipTestIfApplicationsNotAvailable(self, *names):
        """Skips where an application is not here."""
        lacking = [name for name in names if name not in _APPLICATIONS]
        if lacking:
            self.skipTest(f"not here: {', '.join(lacking)}")


@contextlib.contextmanager
def _scope(path, file=None, *_):
    before = os.getcwd()
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(file)), path) if file else path)
    try:
        yield
    finally:
        os.chdir(before)


class _Analysis(analysis_stage.AnalysisStage):
    """An analysis of a program for Kratos."""

    def __init__(self, own_model, project_parameters):
        super().__init__(own_model, project_parameters, like=_like)


class _Module(types.ModuleType):
    """A module that also has all variables and flags."""

    def __getattr__(self, name):
        found = None if name.startswith("_") else variables.named(name)
        if found is None:
            raise AttributeError(f"zelus has no {self.__name__}.{name}")
        return found


def _top(module):
    """Names of KratosMultiphysics itself."""
    names = """Array3 ApplyFunctionToNodesUtility GenericFunctionUtility IntervalUtility KratosGlobals Logger Matrix VariableUtils
        Vector""".split()
    members = {name: getattr(kratos_utilities, name) for name in names} | kratos_utilities.VARIABLE_CLASSES
    members |= {
        "CheckForPreviousImport": lambda: None,
        "DataCommunicator": types.SimpleNamespace(GetDefault=model._Communicator),
        "Flags": variables.Flag,
        "IsDistributedRun": lambda: False,
        "Model": model.Model,
        "ModelPart": model.ModelPart,
        "OutputProcess": process.OutputProcess,
        "Parameters": parameters.Parameters,
        "ParallelEnvironment": types.SimpleNamespace(GetDefaultDataCommunicator=model._Communicator),
        "Process": process.Process,
    }
    module.__dict__.update(members)
    return list(members)


def _tests(module):
    """Names of KratosUnittest."""
    module.__dict__.update(
        {
            "TestCase": _TestCase,
            "WorkFolderScope": _scope,
            "isclose": math.isclose,
            "main": unittest.main,
            "skipIf": unittest.skipIf,
            "skipUnless": unittest.skipUnless,
            "skipIfApplicationsNotAvailable": lambda *names: unittest.skipIf(set(names) - set(_APPLICATIONS), "not here"),
        }
    )


def _process(module, name):
    """Names in the module of a process of the program: its class by Kratos' name, and Factory."""

    def begin(self, own_model, settings):
        builtin.BuiltinProcess.__init__(self, own_model, name, settings)

    own = "".join(word.capitalize() for word in name.split("_"))
    made = type(own, (builtin.BuiltinProcess,), {"__init__": begin, "__doc__": f"The process {name}."})
    module.__dict__.update({own: made, "Factory": lambda settings, own_model: made(own_model, settings["Parameters"])})
    return [own, "Factory"]


class _ProcessFactory:
    """Makes the processes of a list of a deck."""

    def __init__(self, own_model):
        self.Model = own_model

    def ConstructListOfProcesses(self, entries):
        """The processes of all entries."""
        own = process.process_of(self.Model, ".")
        return [self._made(own, entry) for entry in entries]

    def _made(self, own, entry):
        name = entry["python_module"].GetString().rsplit(".", 1)[-1]
        known = _zelus.is_process(name)
        made = own(entry._value, known)
        if made is None and not known:
            raise KeyError(f"there is no process {name}")
        return made or builtin.BuiltinProcess(self.Model, name, entry["Parameters"])


class _CsvTable:
    """Tables of files belong into the deck."""

    def __init__(self, *_):
        raise NotImplementedError("values from tables in files belong into the deck")


def _utilities(module):
    module.CheckIfApplicationsAvailable = lambda *wanted: set(wanted) <= set(_APPLICATIONS)
    module.IssueDeprecationWarning = lambda label, *words: warnings.warn(f"{label}: {' '.join(words)}", stacklevel=2)
    module.DeleteFileIfExisting = lambda file: os.path.exists(file) and os.remove(file)


def _json_utilities(module):
    def read(file):
        with open(file, encoding="utf-8") as opened:
            return json.load(opened)

    def write(file, data):
        with open(file, "w", encoding="utf-8") as opened:
            json.dump(data, opened, sort_keys=True, indent=4, separators=(",", ": "))

    module.__dict__.update(read_external_json=read, write_external_json=write)


# Modules that are no packages, analyses or processes, and what fills them.
_OTHERS = {
    "KratosUnittest": _tests,
    "json_utilities": _json_utilities,
    "kratos_utilities": _utilities,
    "process_factory": lambda module: setattr(module, "KratosProcessFactory", _ProcessFactory),
    "read_csv_table_utility": lambda module: setattr(module, "ReadCsvTableUtility", _CsvTable),
}


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the modules of Kratos that are here."""

    def find_spec(self, name, path=None, target=None):
        """The module of that name, where it is here."""
        top, _, rest = name.partition(".")
        if top != _TOP:
            return None
        packages = {"", *_APPLICATIONS}
        is_here = rest in packages | set(_ANALYSES) | set(_OTHERS)
        if not is_here and not _zelus.is_process(rest.rpartition(".")[2]):
            raise ModuleNotFoundError(f"zelus has no {name}", name=name)
        return importlib.machinery.ModuleSpec(name, self, is_package=rest in packages)

    def create_module(self, spec):
        """The empty module."""
        return _Module(spec.name)

    def exec_module(self, module):
        """Fills the module."""
        rest = module.__name__.partition(".")[2]
        names = [name for names in _zelus.names() for name in names]
        if rest in _ANALYSES:
            own = type(_ANALYSES[rest], (_Analysis,), {})
            setattr(module, own.__name__, own)
            names = [own.__name__]
        elif rest in _OTHERS:
            _OTHERS[rest](module)
            return
        elif _zelus.is_process(rest.rpartition(".")[2]):
            names = _process(module, rest.rpartition(".")[2])
        elif rest == "":
            names += _top(module)
            names += [name for name in variables._OF_STEPS if name not in names]
        module.__all__ = names


_FINDER = _Finder()


def _modules():
    return {name: own for name, own in sys.modules.items() if name == _TOP or name.startswith(f"{_TOP}.")}


def install(like=None):
    """Makes `import KratosMultiphysics` give this module from now on; `like`: "kratos" for Kratos' defaults."""
    global _like
    _like = like
    if _FINDER not in sys.meta_path:
        for name in _modules():
            del sys.modules[name]
        sys.meta_path.insert(0, _FINDER)


# The modules of Kratos as the processes of decks have imported them.
_own: dict = {}


@contextlib.contextmanager
def installed():
    """As `install`, for a time; a Kratos that is installed is there again afterwards."""
    if _FINDER in sys.meta_path:
        yield
        return
    before = _modules()
    for name in before:
        del sys.modules[name]
    sys.modules.update(_own)
    sys.meta_path.insert(0, _FINDER)
    try:
        yield
    finally:
        sys.meta_path.remove(_FINDER)
        _own.update(_modules())
        for name in _own:
            sys.modules.pop(name, None)
        sys.modules.update(before)
