"""The loop of a stage with its hooks, in the way of Kratos: `AnalysisStage`."""

from __future__ import annotations

from pathlib import Path

from .driving import Driving
from .model import Model
from .parameters import Parameters
from .process import process_of
from .result import Result


class Solver:
    """Solver of the steps of an AnalysisStage."""

    def __init__(self, stage):
        self._stage = stage
        self.settings = stage.project_parameters["solver_settings"]

    @property
    def main_model_part(self):
        """The part that is solved for."""
        return self._stage.model[self._stage.model._root()]

    def GetComputingModelPart(self):
        """The part that is solved for."""
        return self.main_model_part

    def AdvanceInTime(self, _time=None):
        """Begins the next step; its time."""
        return self._stage._advance()

    def InitializeSolutionStep(self):
        """No action: the solution of the step includes it."""

    def Predict(self):
        """No action: the solution of the step includes it."""

    def SolveSolutionStep(self):
        """Solves the step; where it is cut, what is left of it follows as steps of their own. Raises where it does not converge."""
        return self._stage._solve()

    def FinalizeSolutionStep(self):
        """No action: the solution of the step includes it."""

    def Check(self):
        """A deck is checked as it is set up."""
        return 0

    def GetMinimumBufferSize(self):
        """How many steps are remembered."""
        return self.main_model_part.GetBufferSize()


class AnalysisStage:
    """Runs a deck as Kratos' class of that name does, with the same hooks in the same order.

    model: a Model. project_parameters: the deck as Parameters; its paths begin in `folder`, by default the present one.
    An overridden hook must call `super()`, else the work of the stage is not done.
    """

    def __init__(self, model, project_parameters, *, folder=".", threads=None, like=None, progress=None):
        if not isinstance(model, Model):
            raise TypeError("the first argument is a zelus.Model")
        if not isinstance(project_parameters, Parameters):
            raise TypeError("the second argument is a zelus.Parameters")
        if project_parameters.Has("stages"):
            raise ValueError("a deck of several stages is run by zelus.run")
        self.model = model
        self.project_parameters = project_parameters
        self.echo_level = self._problem("echo_level", 1)
        self.parallel_type = self._problem("parallel_type", "OpenMP")
        self.time = self._problem("start_time", 0.0)
        self.end_time = self._problem("end_time", 0.0)
        self._options = {"threads": threads, "like": like, "progress": progress}
        self._folder = Path(folder)
        self._driving = None
        self._at = None
        self._is_over = False
        self._solver = None

    def _problem(self, key, default):
        data = self.project_parameters
        data = data["problem_data"] if data.Has("problem_data") else Parameters()
        return data[key]._value if data.Has(key) else default

    # the loop

    def Run(self):
        """Runs the whole stage."""
        self.Initialize()
        self.RunSolutionLoop()
        self.Finalize()

    def Initialize(self):
        """Reads mesh and materials, makes the processes and sets up the solver."""
        make = process_of(self.model, self._folder)
        self._driving = Driving(self._folder, deck=self.project_parameters._value, attended=True, make=make, **self._options)
        self.model._attach(self._driving)
        self._at = self._driving.do("prepare")
        self._pass("at", "read")
        self._hook(self.ModifyInitialProperties)
        self._hook(self.ModifyInitialGeometry)
        self._pass("at", "ready")
        self._hook(self.Check)
        self._hook(self.ModifyAfterSolverInitialize)
        self._hook(self.ModifyBeforeSolutionLoop)
        self._pass("idle")
        self.end_time = self._driving.end_time
        self._at = self._driving.do("step")
        self._pass("at", "before_loop")
        self._act()

    def RunSolutionLoop(self):
        """Makes the steps."""
        while self.KeepAdvancingSolutionLoop():
            self.time = self._AdvanceTime()
            self._hook(self.InitializeSolutionStep)
            self._hook(self.SolveSolutionStep)
            self._hook(self.FinalizeSolutionStep)
            self._hook(self.OutputSolutionStep)

    def Finalize(self):
        """Brings the processes to their end."""
        if self._is_over:
            return
        self._settle()
        if self._at[0] != "idle":
            # what is left of a step that was cut, or one that was begun, is not made
            self._leave(InterruptedError("ended within a step"))
            return
        self._at = self._driving.do("finish" if self.time < self.end_time else "step")
        while self._at[0] != "idle":
            self._pass_on()
        self._is_over = True

    def KeepAdvancingSolutionLoop(self):
        """Whether there are steps to make, or what is left of one that was cut."""
        if self._is_over:
            return False
        self._settle()
        return self._at == ("at", "begin_step") or self.time < self.end_time

    def InitializeSolutionStep(self):
        """Time has advanced: boundary conditions and loads."""
        self.PrintAnalysisStageProgressInformation()
        self.ApplyBoundaryConditions()
        self.ChangeMaterialProperties()
        self._GetSolver().Predict()
        self._GetSolver().InitializeSolutionStep()

    def SolveSolutionStep(self):
        """Solves the step."""
        return self._GetSolver().SolveSolutionStep()

    def FinalizeSolutionStep(self):
        """The step is solved and accepted."""
        self._GetSolver().FinalizeSolutionStep()
        if self._at == ("at", "end_step"):
            self._act()

    def OutputSolutionStep(self):
        """Lets the processes write that write now."""
        while self._at in (("at", "end_step"), ("acted", "end_step")):
            self._at = self._driving.go()
        if self._at == ("at", "output"):
            self._act()

    # hooks

    def ModifyInitialProperties(self):
        """Mesh and materials are read: properties may be changed."""

    def ModifyInitialGeometry(self):
        """Mesh and materials are read: positions may be changed."""

    def ModifyAfterSolverInitialize(self):
        """All is ready to run."""

    def ModifyBeforeSolutionLoop(self):
        """All is ready to run."""

    def ApplyBoundaryConditions(self):
        """Lets the processes prescribe and load."""
        if self._at in (("at", "begin_step"), ("acted", "begin_step")):
            self._act()

    def ChangeMaterialProperties(self):
        """Called in each step; laws are taken up once, so nothing may be changed here."""

    def PrintAnalysisStageProgressInformation(self):
        """Called as a step begins; the progress of a run tells itself."""

    def Check(self):
        """Called once all is ready; the processes of the deck have checked themselves."""
        self._GetSolver().Check()

    # what there is

    @property
    def process_info(self):
        """Time, counters and named numbers."""
        return self._GetSolver().main_model_part.ProcessInfo

    def GetComputingModelPart(self):
        """The part that is solved for."""
        return self._GetSolver().GetComputingModelPart()

    def GetFinalData(self):
        """Data that a stage hands on by name: nothing of its own."""
        return {}

    def _GetSolver(self):
        if self._solver is None:
            self._solver = self._CreateSolver()
        return self._solver

    def _CreateSolver(self):
        return Solver(self)

    def _GetListOfProcesses(self):
        return self._driving.processes

    def _GetListOfOutputProcesses(self):
        return [process for process in self._driving.processes if hasattr(process, "PrintOutput")]

    def _GetSimulationName(self):
        return "Analysis"

    def _AdvanceTime(self):
        return self._GetSolver().AdvanceInTime(self.time)

    def result(self):
        """The Result, once the stage is over; the model is empty after it."""
        if not self._is_over:
            raise RuntimeError("the stage is not over")
        self.model._attach(None)
        return Result._of(self._driving.result())

    # from point to point

    def _hook(self, hook):
        """Calls a hook; what it raises ends the run, whose processes come to their end."""
        try:
            hook()
        except BaseException as error:
            if not self._is_over:
                self._leave(error)
            raise

    def _leave(self, error):
        if self._at[0] == "idle":
            self._is_over = True
            self._driving.do("finish")
            return
        self._driving.fail(error)
        try:
            self._at = self._driving.next()
            while self._at[0] != "idle":
                self._pass_on()
        except BaseException as ended:
            self._is_over = True
            if ended is not error:
                raise

    def _stopping(self, move):
        """Result of `move`; the stage is over where it raises."""
        try:
            self._at = move()
        except BaseException:
            self._is_over = True
            raise

    def _act(self):
        """Lets the run do what is done at this point."""
        self._stopping(lambda: self._driving.go("act"))
        while self._at[1] == "finalize":
            self._pass_on()

    def _pass_on(self):
        """Continues from a stop: processes come to their end, other actions that a hook left out are not done."""
        what = "act" if self._at == ("at", "finalize") else None
        self._stopping(lambda: self._driving.go(what))

    def _settle(self):
        """Goes on after a step, to where it is whole or the next part of it begins."""
        while self._at[1] in ("end_step", "output"):
            self._pass_on()

    def _pass(self, *wanted):
        """Goes on to a stop."""
        while self._at[: len(wanted)] != wanted:
            self._pass_on()

    def _advance(self):
        """Goes on to where the next step begins; its time."""
        if self._at == ("at", "begin_step"):
            return self.process_info["TIME"]
        while self._at != ("at", "begin_step"):
            if self._at[0] != "idle":
                self._pass_on()
                continue
            if self._driving.interrupted:
                self._is_over = True
                self._driving.do("finish")
                raise KeyboardInterrupt
            if not self._at[1]:
                self._is_over = True
                break
            self._stopping(lambda: self._driving.do("step"))
        return self.process_info["TIME"]

    def _solve(self):
        """Goes on to where the step is accepted; where a shorter one is made, its boundary conditions are set anew."""
        self._pass_on()
        while self._at != ("at", "end_step"):
            if self._at == ("at", "begin_step"):
                self.time = self.process_info["TIME"]
                self.InitializeSolutionStep()
            self._pass_on()
        return True
