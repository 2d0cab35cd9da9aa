"""Utilities of Kratos for programs and processes: numbers, lines, loops over nodes, functions, intervals."""

from __future__ import annotations

import sys
import types

import numpy as np

from . import _zelus, variables


class Vector(np.ndarray):
    """Numbers: of a length, all zero or of one value, or from a list."""

    def __new__(cls, values=0, value=0.0):
        own = np.full(values, value, float) if isinstance(values, int) else np.array(values, float)
        return own.view(cls)

    def Size(self):
        """How many there are."""
        return len(self)


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
        """Output object that accepts a severity and ignores it."""
        return types.SimpleNamespace(SetSeverity=lambda _: None)


class KratosGlobals:
    """Variables by name."""

    @staticmethod
    def GetVariable(name):
        """The variable of that name."""
        found = variables.named(name)
        if not isinstance(found, variables.Variable):
            raise KeyError(f"there is no variable {name}")
        return found

    GetFlag = staticmethod(variables.named)

    @staticmethod
    def HasVariable(name):
        """Whether there is a variable of that name."""
        return isinstance(variables.named(name), variables.Variable)

    @staticmethod
    def GetVariableType(name):
        """The word for what it holds."""
        kinds = {"scalar": "Double", "component": "Double", "vector3": "Array", "boolean": "Bool", "text": "String"}
        kind = _zelus.variable_kind(name) or "none"
        return kinds.get(kind, kind.capitalize())


class _Kind(type):
    """A class that variables of some kinds are instances of."""

    def __instancecheck__(cls, value):
        return isinstance(value, variables.Variable) and _zelus.variable_kind(value) in cls.kinds


VARIABLE_CLASSES = {
    name: _Kind(name, (), {"kinds": kinds, "__doc__": "Variables of this kind are instances of it."})
    for name, kinds in {
        "DoubleVariable": ("scalar", "component"),
        "Array1DVariable3": ("vector3",),
        "VectorVariable": ("vector",),
        "MatrixVariable": ("matrix",),
        "BoolVariable": ("boolean",),
        "IntegerVariable": ("integer",),
        "StringVariable": ("text",),
    }.items()
}


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


class IntervalUtility:
    """The time span of a process: "interval" of its settings, [begin, end], whose end may be "End"."""

    def __init__(self, settings):
        if not settings.Has("interval"):
            settings.AddEmptyValue("interval").SetVector([0.0, 1e30])
        interval = settings["interval"]
        if interval[1].IsString():
            if interval[1].GetString() != "End":
                raise ValueError('the end of an "interval" is a number or "End"')
            interval[1].SetDouble(1e30)
        self._begin, self._end = (own.GetDouble() for own in interval)

    def GetIntervalBegin(self):
        """The first instant."""
        return self._begin

    def GetIntervalEnd(self):
        """The last instant."""
        return self._end

    def IsInInterval(self, time):
        """Whether a time lies in it."""
        return _zelus.in_interval(self._begin, self._end, time)


class GenericFunctionUtility:
    """A function of space and time, as decks write it."""

    def __init__(self, text, local_axes=None):
        if local_axes is not None and len(local_axes):
            raise NotImplementedError("functions in local axes belong into the deck")
        self._text, self._own = text, _zelus.Function(text)

    def DependsOnSpace(self):
        """Whether it depends on the position."""
        return self._own.depends_on_space()

    def UseLocalSystem(self):
        """Whether it has axes of its own."""
        return False

    def FunctionBody(self):
        """Its text."""
        return self._text

    def CallFunction(self, x, y, z, t, X=0.0, Y=0.0, Z=0.0):
        """Its value."""
        return self._own.value([x, y, z], [X, Y, Z], t)


class ApplyFunctionToNodesUtility:
    """Writes the values of a function to nodes."""

    def __init__(self, nodes, function):
        self._nodes, self._function = nodes, function

    def ReturnFunction(self, time):
        """Its values at the nodes."""
        return Vector([self._function.CallFunction(n.X, n.Y, n.Z, time, n.X0, n.Y0, n.Z0) for n in self._nodes])

    def ApplyFunction(self, variable, time):
        """Writes its values with history."""
        for node, value in zip(self._nodes, self.ReturnFunction(time)):
            node.SetSolutionStepValue(variable, float(value))
