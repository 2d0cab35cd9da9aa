"""Settings in the way of Kratos: `Parameters`."""

from __future__ import annotations

import json
import re

import numpy as np

_TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def _without_comments(text):
    return _TOKEN.sub(lambda found: found.group() if found.group().startswith('"') else " ", text)


def _plain(value):
    """Plain JSON of a value."""
    if isinstance(value, Parameters):
        return value._value
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, dict):
        return {str(key): _plain(own) for key, own in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(own) for own in value]
    return value


class Parameters:
    """JSON whose members are read and written by type; members share their values with what they are of."""

    def __init__(self, value="{}"):
        self._holder = [json.loads(_without_comments(value)) if isinstance(value, str) else _plain(value)]
        self._key = 0

    @classmethod
    def _of(cls, holder, key):
        own = cls.__new__(cls)
        own._holder, own._key = holder, key
        return own

    @property
    def _value(self):
        return self._holder[self._key]

    @_value.setter
    def _value(self, value):
        self._holder[self._key] = value

    def __getitem__(self, key):
        value = self._value
        if isinstance(key, str):
            if not isinstance(value, dict) or key not in value:
                known = ", ".join(value) if isinstance(value, dict) else "none"
                raise KeyError(f'there is no "{key}"; there are: {known}')
        elif not isinstance(value, list) or not 0 <= key < len(value):
            raise IndexError(f"there is no entry {key}")
        return Parameters._of(value, key)

    def __setitem__(self, key, value):
        self._value[key] = _plain(value)

    def __contains__(self, key):
        return self.Has(key)

    def __iter__(self):
        keys = range(len(self._value)) if isinstance(self._value, list) else list(self._value)
        return (self[key] for key in keys)

    def __len__(self):
        return len(self._value) if isinstance(self._value, (dict, list)) else 0

    def __str__(self):
        return self.PrettyPrintJsonString()

    def __eq__(self, other):
        return isinstance(other, Parameters) and self._value == other._value

    __hash__ = None

    def __reduce__(self):
        return Parameters, (self.WriteJsonString(),)

    def keys(self):
        """Keys of an object."""
        return list(self._value)

    def values(self):
        """Members of an object."""
        return [self[key] for key in self._value]

    def items(self):
        """Keys and members of an object."""
        return [(key, self[key]) for key in self._value]

    def size(self):
        """Number of members."""
        return len(self)

    def Has(self, key):
        """Whether an object has this key."""
        return isinstance(self._value, dict) and key in self._value

    def Clone(self):
        """A copy that shares nothing."""
        return Parameters(self.WriteJsonString())

    def Copy(self):
        """As Clone."""
        return self.Clone()

    def WriteJsonString(self):
        """JSON in one line."""
        return json.dumps(self._value)

    def PrettyPrintJsonString(self):
        """JSON in lines."""
        return json.dumps(self._value, indent=4)

    def IsEquivalentTo(self, other):
        """Whether both hold the same."""
        return self._value == other._value

    def _typed(self, kinds, word):
        value = self._value
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            raise TypeError(f"{value!r} is no {word}")
        return value

    def GetString(self):
        """The word it holds."""
        return self._typed((str,), "text")

    def GetInt(self):
        """The whole number it holds."""
        return self._typed((int,), "whole number")

    def GetDouble(self):
        """The number it holds."""
        return float(self._typed((int, float), "number"))

    def GetBool(self):
        """Whether it is true."""
        return self._typed((bool,), "truth")

    def GetStringArray(self):
        """The words it holds."""
        return [own.GetString() for own in self]

    def GetVector(self):
        """The numbers it holds."""
        return np.array([own.GetDouble() for own in self])

    def GetMatrix(self):
        """The rows of numbers it holds."""
        return np.array([own.GetVector() for own in self])

    def IsNull(self):
        """Whether it is null."""
        return self._value is None

    def IsString(self):
        """Whether it is a text."""
        return isinstance(self._value, str)

    def IsBool(self):
        """Whether it is true or false."""
        return isinstance(self._value, bool)

    def IsInt(self):
        """Whether it is a whole number."""
        return isinstance(self._value, int) and not self.IsBool()

    def IsDouble(self):
        """Whether it is a number that is not whole."""
        return isinstance(self._value, float)

    def IsNumber(self):
        """Whether it is a number."""
        return self.IsInt() or self.IsDouble()

    def IsArray(self):
        """Whether it is a list."""
        return isinstance(self._value, list)

    def IsStringArray(self):
        """Whether it is a list of texts."""
        return self.IsArray() and all(own.IsString() for own in self)

    def IsVector(self):
        """Whether it is a list of numbers."""
        return self.IsArray() and all(own.IsNumber() for own in self)

    def IsMatrix(self):
        """Whether it is a list of rows of numbers."""
        return self.IsArray() and len(self) > 0 and all(own.IsVector() for own in self)

    def IsSubParameter(self):
        """Whether it is an object."""
        return isinstance(self._value, dict)

    def _set(self, value):
        self._value = _plain(value)
        return self

    SetString = SetInt = SetBool = SetStringArray = SetVector = SetMatrix = _set

    def SetDouble(self, value):
        """Puts a number there."""
        return self._set(float(value))

    def SetValue(self, key, value):
        """Puts a value in the place of one."""
        if key not in self._value:
            raise KeyError(f'there is no "{key}" to set')
        self[key] = value

    def AddValue(self, key, value):
        """Adds a member."""
        self[key] = value

    AddString = AddInt = AddBool = AddVector = AddMatrix = AddStringArray = AddValue

    def AddDouble(self, key, value):
        """Adds a number."""
        self[key] = float(value)

    def AddEmptyValue(self, key):
        """Adds a member that is null unless it is there, and gives it."""
        self._value.setdefault(key, None)
        return self[key]

    def AddEmptyArray(self, key):
        """Adds an empty list unless it is there, and gives it."""
        self._value.setdefault(key, [])
        return self[key]

    def Append(self, value):
        """Adds an entry to a list."""
        self._value.append(_plain(value))

    def RemoveValue(self, key):
        """Takes a member out; whether it was there."""
        return self._value.pop(key, self) is not self

    def RemoveValues(self, keys):
        """Takes members out; whether all were there."""
        return all([self.RemoveValue(key) for key in keys])

    def AddMissingParameters(self, defaults):
        """Takes members of the defaults that are missing."""
        for key, value in defaults._value.items():
            self._value.setdefault(key, json.loads(json.dumps(value)))

    def RecursivelyAddMissingParameters(self, defaults):
        """As AddMissingParameters, in objects of both too."""
        self.AddMissingParameters(defaults)
        for key, value in defaults.items():
            if value.IsSubParameter() and self[key].IsSubParameter():
                self[key].RecursivelyAddMissingParameters(value)

    def ValidateDefaults(self, defaults):
        """Raises where a key is not among the defaults, or of another type."""
        for key, value in self.items():
            if not defaults.Has(key):
                raise RuntimeError(f'"{key}" is not known; known are: {", ".join(defaults.keys())}')
            own, other = value._value, defaults[key]._value
            both = isinstance(own, (int, float)) and isinstance(other, (int, float))
            numbers = both and isinstance(own, bool) == isinstance(other, bool)
            if own is not None and other is not None and not numbers and type(own) is not type(other):
                raise RuntimeError(f'"{key}" is {own!r}, and should be like {other!r}')

    def ValidateAndAssignDefaults(self, defaults):
        """Checks the members against the defaults, and takes those that are missing."""
        self.ValidateDefaults(defaults)
        self.AddMissingParameters(defaults)

    def RecursivelyValidateDefaults(self, defaults):
        """As ValidateDefaults, in objects of both too."""
        self.ValidateDefaults(defaults)
        for key, value in self.items():
            if value.IsSubParameter() and defaults[key].IsSubParameter():
                value.RecursivelyValidateDefaults(defaults[key])

    def RecursivelyValidateAndAssignDefaults(self, defaults):
        """As ValidateAndAssignDefaults, in objects of both too."""
        self.RecursivelyValidateDefaults(defaults)
        self.RecursivelyAddMissingParameters(defaults)
