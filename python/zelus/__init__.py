"""zelus: finite elements with mortar contact that run Kratos decks.

    import zelus
    result = zelus.run("ProjectParameters.json", set={"solver_settings.max_iteration": 20})
    result["DISPLACEMENT"]  # one row a node
"""

from . import kratos
from ._zelus import __version__
from .analysis_stage import AnalysisStage, Solver
from .builtin import BuiltinProcess
from .errors import InputError, NotConvergedError, Problem, SystemFailure, ZelusError, ZelusWarning
from .law import Points, law
from .model import Model, ModelPart
from .parameters import Parameters
from .process import OutputProcess, Process, register_process
from .residual import Entities, residual
from .result import Result
from .running import Step, run
from .variables import Flag, Variable, named

__all__ = [
    "AnalysisStage",
    "BuiltinProcess",
    "Entities",
    "Flag",
    "InputError",
    "Model",
    "ModelPart",
    "NotConvergedError",
    "OutputProcess",
    "Parameters",
    "Points",
    "Problem",
    "Process",
    "Result",
    "Solver",
    "Step",
    "SystemFailure",
    "Variable",
    "ZelusError",
    "ZelusWarning",
    "__version__",
    "kratos",
    "law",
    "register_process",
    "residual",
    "run",
]


def __getattr__(name: str) -> Variable | Flag:
    """Variables and flags by name, such as zelus.DISPLACEMENT."""
    found = named(name)
    if found is None:
        raise AttributeError(f"module 'zelus' has no attribute {name!r}")
    return found
