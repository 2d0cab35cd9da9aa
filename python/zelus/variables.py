"""Variables and flags by name."""

from __future__ import annotations

from . import _zelus


class Variable(str):
    """The name of a variable."""

    __slots__ = ()

    def Name(self):
        """The name."""
        return str(self)

    def GetSourceVariable(self):
        """The vector that a component is of."""
        is_component = _zelus.variable_kind(self) == "component"
        return Variable(self[:-2]) if is_component else self

    def __repr__(self):
        return f"<variable {self}>"


class Flag(str):
    """The name of a flag, or of one that is not set."""

    __slots__ = ()

    def AsFalse(self):
        """The flag unset."""
        return Flag(self[1:] if self.startswith("!") else f"!{self}")

    def __repr__(self):
        return f"<flag {self}>"


# Names of the step data that are no variables of nodes.
_OF_STEPS = ("TIME", "DELTA_TIME", "STEP", "NL_ITERATION_NUMBER", "DOMAIN_SIZE", "IS_RESTARTED", "TIME_STEPS")


def named(name):
    """The variable or flag of that name; `None` when there is none."""
    if name in _OF_STEPS or _zelus.variable_kind(name):
        return Variable(name)
    negative = name.startswith("NOT_")
    if _zelus.is_flag(name[4:] if negative else name):
        return Flag(f"!{name[4:]}") if negative else Flag(name)
    return None
