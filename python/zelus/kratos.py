"""The name `KratosMultiphysics` for programs and processes written for Kratos: what they use most of it, over zelus.

It is there once `install()` has been called, or while the processes of a deck are imported; what of Kratos is not here raises
an error that names it.
"""

from __future__ import annotations

import contextlib
import importlib.abc
import importlib.machinery
import os
import sys
import types
import unittest

import numpy as np

from . import _zelus, analysis_stage, model, parameters, process, variables

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


class Vector(np.ndarray):
    """Numbers: of a length, all zero or of one value, or from a list."""

    def __new__(cls, values=0, value=0.0):
        own = np.full(values, value, float) if isinstance(values, int) else np.array(values, float)
        return own.view(cls)

    def Size(self):
        """How many there are."""
        return len(self)

    def Resize(self, size):
        """Makes it longer or shorter."""
        self.resize(size, refcheck=False)


class Matrix(np.ndarray):
    """Rows of numbers: of a size, all zero, or from lists."""

    def __new__(cls, rows=0, columns=0):
        own = np.zeros((rows, columns)) if isinstance(rows, int) else np.array(rows, float)
        return own.view(cls)

    def Size1(self):
        """Rows."""
        return self.shape[0]

    def Size2(self):
        """Columns."""
        return self.shape[1]


def Array3(values=0.0):
    """Three numbers."""
    return Vector(3, values) if np.ndim(values) == 0 else Vector(values)


class Logger:
    """Prints lines."""

    class Severity:
        """How much is printed."""

        INFO = WARNING = DETAIL = DEBUG = 0

    @staticmethod
    def PrintInfo(label="", *words):
        """Prints a line."""
        print(f"{label}:" if label else "", *words)

    PrintWarning = Print = PrintWarningOnAllRanks = PrintInfoOnAllRanks = PrintInfo

    @staticmethod
    def Flush():
        """Brings out what is printed."""
        sys.stdout.flush()

    @staticmethod
    def GetDefaultOutput():
        """What takes a severity and does not heed it."""
        return types.SimpleNamespace(SetSeverity=lambda _: None)


class _Globals:
    """Variables by name."""

    @staticmethod
    def GetVariable(name):
        """The variable of that name."""
        found = variables.named(name)
        if not isinstance(found, variables.Variable):
            raise KeyError(f"there is no variable {name}")
        return found

    GetFlag = staticmethod(lambda name: variables.named(name))

    @staticmethod
    def HasVariable(name):
        """Whether there is a variable of that name."""
        return isinstance(variables.named(name), variables.Variable)

    @staticmethod
    def GetVariableType(name):
        """The word for what it holds."""
        kinds = {"scalar": "Double", "component": "Double", "vector3": "Array", "boolean": "Bool", "integer": "Integer"}
        kind = _zelus.variable_kind(name)
        return kinds.get(kind, (kind or "none").capitalize().replace("Text", "String"))


class VariableUtils:
    """Work on many nodes at once."""

    def SetVariable(self, variable, value, nodes, *_):
        """Writes one value with history to nodes."""
        for node in nodes:
            node.SetSolutionStepValue(variable, value)

    SetScalarVar = SetVectorVar = SetVariable

    def SetNonHistoricalVariable(self, variable, value, items):
        """Writes one value without history to nodes, elements or conditions."""
        for item in items:
            item.SetValue(variable, value)

    def SetHistoricalVariableToZero(self, variable, nodes):
        """Writes zeros with history to nodes."""
        is_vector = _zelus.variable_kind(str(variable)) == "vector3"
        self.SetVariable(variable, [0.0] * 3 if is_vector else 0.0, nodes)

    def SetFlag(self, flag, state, items):
        """Sets or unsets a flag of nodes, elements or conditions."""
        for item in items:
            item.Set(flag, state)

    def ApplyFixity(self, variable, fixed, nodes):
        """Fixes or frees an unknown of nodes."""
        for node in nodes:
            (node.Fix if fixed else node.Free)(variable)

    def SumHistoricalNodeScalarVariable(self, variable, part, step=0):
        """The sum of a value with history over the nodes of a part."""
        return sum(node.GetSolutionStepValue(variable, step) for node in part.Nodes)

    SumHistoricalNodeVectorVariable = SumHistoricalNodeScalarVariable

    def AddDof(self, *_):
        """The solver adds its unknowns itself."""


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
    """What KratosMultiphysics itself has."""
    members = {
        "Array3": Array3,
        "CheckForPreviousImport": lambda: None,
        "DataCommunicator": types.SimpleNamespace(GetDefault=model._Communicator),
        "Flags": variables.Flag,
        "IsDistributedRun": lambda: False,
        "KratosGlobals": _Globals,
        "Logger": Logger,
        "Matrix": Matrix,
        "Model": model.Model,
        "ModelPart": model.ModelPart,
        "OutputProcess": process.OutputProcess,
        "Parameters": parameters.Parameters,
        "ParallelEnvironment": types.SimpleNamespace(GetDefaultDataCommunicator=model._Communicator),
        "Process": process.Process,
        "VariableUtils": VariableUtils,
        "Vector": Vector,
    }
    module.__dict__.update(members)
    return list(members)


def _tests(module):
    """What KratosUnittest has."""
    module.__dict__.update(
        {
            "TestCase": _TestCase,
            "WorkFolderScope": _scope,
            "main": unittest.main,
            "skipIf": unittest.skipIf,
            "skipUnless": unittest.skipUnless,
            "skipIfApplicationsNotAvailable": lambda *names: unittest.skipIf(set(names) - set(_APPLICATIONS), "not here"),
        }
    )


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the modules of Kratos that are here."""

    def find_spec(self, name, path=None, target=None):
        """The module of that name, where it is here."""
        top, _, rest = name.partition(".")
        if top != _TOP:
            return None
        packages = {"", *_APPLICATIONS}
        if rest not in packages | set(_ANALYSES) | {"KratosUnittest", "kratos_utilities"}:
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
        elif rest == "KratosUnittest":
            _tests(module)
            return
        elif rest == "kratos_utilities":
            module.CheckIfApplicationsAvailable = lambda *wanted: set(wanted) <= set(_APPLICATIONS)
            module.DeleteFileIfExisting = lambda file: os.path.exists(file) and os.remove(file)
            return
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
