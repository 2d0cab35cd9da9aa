"""Nodes, elements, conditions and properties of a model part, in the way of Kratos."""

from __future__ import annotations

import numpy as np


class Container:
    """Nodes, elements or conditions of a part: iterated in their order, found by id."""

    def __init__(self, part, kind, made):
        self._part, self._kind, self._made = part, kind, made

    def _items(self):
        return np.asarray(self._part._session.items(self._part._path, self._kind))

    def _index(self, id):
        index = self._part._session.find(self._part._root, self._kind, id)
        if index is None:
            raise KeyError(f"there is no {self._kind[:-1]} {id} in {self._part._root}")
        return index

    def __len__(self):
        return len(self._items())

    def __iter__(self):
        ids = np.asarray(self._part._session.ids(self._part._root, self._kind))
        return (self._made(self._part, self._kind, int(at), int(ids[at])) for at in self._items())

    def __contains__(self, id):
        index = self._part._session.find(self._part._root, self._kind, int(id))
        items = self._items()
        at = np.searchsorted(items, index) if index is not None else len(items)
        return bool(at < len(items) and items[at] == index)

    def __getitem__(self, id):
        if id not in self:
            raise KeyError(f"there is no {self._kind[:-1]} {id} in {self._part._path}")
        return self._made(self._part, self._kind, self._index(id), int(id))

    def size(self):
        """How many there are."""
        return len(self)


def _numbers(value):
    """One number, or a tuple of three."""
    return float(value) if np.ndim(value) == 0 else tuple(float(own) for own in value)


def _read(value):
    return value if isinstance(value, float) else np.array(value)


class _Item:
    """Common interface of nodes, elements and conditions."""

    def __init__(self, part, kind, at, id):
        self._part, self._kind, self._at = part, kind, at
        self.Id = id

    def __eq__(self, other):
        return type(self) is type(other) and self.Id == other.Id and self._part._model is other._part._model

    def __hash__(self):
        return hash((self._kind, self.Id))

    def __repr__(self):
        return f"<{self._kind[:-1]} {self.Id}>"

    @property
    def _session(self):
        return self._part._session

    def GetValue(self, variable):
        """Its value without history."""
        return _read(self._session.value(self._part._root, self._kind, self._at, str(variable), 0))

    def SetValue(self, variable, value):
        """Writes its value without history."""
        self._session.set_value(self._part._root, self._kind, self._at, str(variable), 0, _numbers(value))

    def Has(self, variable):
        """Whether values without history are kept of that variable."""
        return self._session.has_column(self._part._root, self._kind, str(variable))

    def _flag(self, flag):
        name = str(flag)
        return (name[1:], True) if name.startswith("!") else (name, False)

    def Is(self, flag):
        """Whether the flag is set."""
        name, negative = self._flag(flag)
        return (self._session.flag(self._part._root, self._kind, self._at, name) is True) != negative

    def IsNot(self, flag):
        """Whether the flag is not set."""
        return not self.Is(flag)

    def IsDefined(self, flag):
        """Whether the flag is set or unset."""
        return self._session.flag(self._part._root, self._kind, self._at, self._flag(flag)[0]) is not None

    def Set(self, flag, state=True):
        """Sets or unsets the flag."""
        name, negative = self._flag(flag)
        self._session.set_flag(self._part._root, self._kind, self._at, name, bool(state) != negative)

    def Reset(self, flag):
        """Makes the flag undefined."""
        self._session.set_flag(self._part._root, self._kind, self._at, self._flag(flag)[0], None)


def _coordinate(component, initial):
    def read(self):
        return self._session.position(self._part._root, self._at, initial)[component]

    def write(self, value):
        if initial:
            self._part._model._check_changeable("initial positions", "ModifyInitialGeometry")
        position = list(self._session.position(self._part._root, self._at, initial))
        position[component] = float(value)
        self._session.set_position(self._part._root, self._at, initial, position)

    return property(read, write, doc="A coordinate, " + ("before any displacement." if initial else "now."))


class Node(_Item):
    """A node."""

    X, Y, Z = (_coordinate(component, False) for component in range(3))
    X0, Y0, Z0 = (_coordinate(component, True) for component in range(3))

    def Coordinates(self):
        """Its position now."""
        return np.array(self._session.position(self._part._root, self._at, False))

    def GetInitialPosition(self):
        """Its position before any displacement."""
        return np.array(self._session.position(self._part._root, self._at, True))

    def GetSolutionStepValue(self, variable, step=0):
        """Its value with history, so many steps ago."""
        return _read(self._session.value(self._part._root, "history", self._at, str(variable), step))

    def SetSolutionStepValue(self, variable, *step_and_value):
        """Writes its value with history: (variable, value) or (variable, step, value)."""
        *step, value = step_and_value
        step = step[0] if step else 0
        self._session.set_value(self._part._root, "history", self._at, str(variable), step, _numbers(value))

    def SolutionStepsDataHas(self, variable):
        """Whether nodes have this variable with history."""
        return self._session.has_column(self._part._root, "history", str(variable))

    HasSolutionStepValue = SolutionStepsDataHas

    def Fix(self, variable):
        """Prescribes an unknown: it keeps the value that is written to it."""
        self._session.fix(self._part._root, str(variable), [self._at], True)

    def Free(self, variable):
        """Lets an unknown be solved for."""
        self._session.fix(self._part._root, str(variable), [self._at], False)

    def IsFixed(self, variable):
        """Whether an unknown is prescribed."""
        return self._session.is_fixed(self._part._root, str(variable), self._at)


class _Geometry(list):
    """Nodes of an element or condition."""

    def PointsNumber(self):
        """How many nodes it has."""
        return len(self)

    def Center(self):
        """The mean of the positions of its nodes."""
        return np.mean([node.Coordinates() for node in self], axis=0)


class _Entity(_Item):
    """Common interface of elements and conditions."""

    def _facts(self):
        return self._session.entity(self._part._root, self._kind, self._at)

    def Info(self):
        """The registered name of its kind."""
        return self._facts()[0]

    @property
    def Properties(self):
        """Its properties."""
        return Properties(self._part, self._facts()[1])

    def GetNodes(self):
        """Its nodes."""
        ids = np.asarray(self._session.ids(self._part._root, "nodes"))
        return [Node(self._part, "nodes", at, int(ids[at])) for at in self._facts()[2]]

    def GetNode(self, place):
        """Its node at that place."""
        return self.GetNodes()[place]

    def GetGeometry(self):
        """Its nodes, with what follows from them."""
        return _Geometry(self.GetNodes())

    def IsActive(self):
        """Whether it takes part."""
        return self._session.flag(self._part._root, self._kind, self._at, "ACTIVE") is not False

    def CalculateOnIntegrationPoints(self, variable, _info=None):
        """A variable at its Gauss points, as a list with an entry each."""
        values = self._session.gauss(self._part._root, self._kind, self._at, str(variable))
        if values is None:
            raise KeyError(f"{self!r} does not know {variable}")
        return [float(row) if np.ndim(row) == 0 else np.array(row) for row in np.asarray(values)]


class Element(_Entity):
    """An element."""


class Condition(_Entity):
    """A condition."""


class Properties:
    """Material and other constants by id."""

    def __init__(self, part, id):
        if id not in part._session.properties(part._path):
            raise KeyError(f"there are no properties {id}")
        self._part, self.Id = part, id

    def GetValue(self, variable):
        """A value; raises where there is none."""
        value = self._part._session.property(self._part._root, self.Id, str(variable))
        if value is None:
            raise KeyError(f"properties {self.Id} have no {variable}")
        return np.array(value) if isinstance(value, list) else value

    __getitem__ = GetValue

    def Has(self, variable):
        """Whether there is a value."""
        return self._part._session.property(self._part._root, self.Id, str(variable)) is not None

    def SetValue(self, variable, value):
        """Writes a value, before the solver takes it up."""
        self._part._model._check_changeable("properties", "ModifyInitialProperties")
        plain = float(value) if np.ndim(value) == 0 else [float(own) for own in value]
        self._part._session.set_property(self._part._root, self.Id, str(variable), plain)

    __setitem__ = SetValue


class PropertiesContainer:
    """All properties of a part, by id."""

    def __init__(self, part):
        self._part = part

    def __len__(self):
        return len(self._part._session.properties(self._part._path))

    def __iter__(self):
        return (Properties(self._part, id) for id in self._part._session.properties(self._part._path))

    def __getitem__(self, id):
        return Properties(self._part, id)


# Numbers that the run counts itself.
_COUNTED = ("TIME", "DELTA_TIME", "STEP", "NL_ITERATION_NUMBER", "DOMAIN_SIZE")
_WHOLE = ("STEP", "NL_ITERATION_NUMBER", "DOMAIN_SIZE")


class ProcessInfo:
    """Time, counters and named numbers of the run."""

    def __init__(self, part):
        self._part = part

    def GetValue(self, variable):
        """A number; raises where there is none."""
        name = str(variable)
        if name == "IS_RESTARTED":
            return False
        value = self._part._session.info(self._part._root, name)
        if value is None:
            raise KeyError(f"the step data have no {name}")
        return int(value) if name in _WHOLE else value

    __getitem__ = GetValue

    def Has(self, variable):
        """Whether there is such a number."""
        return self._part._session.info(self._part._root, str(variable)) is not None

    def SetValue(self, variable, value):
        """Writes a named number; time and counters are the run's own."""
        if str(variable) in _COUNTED:
            raise RuntimeError(f"{variable} is counted by the run: \"time_stepping\" of the deck says how long steps are")
        self._part._session.set_info(self._part._root, str(variable), float(value))

    __setitem__ = SetValue
