"""Programs and processes written for Kratos."""

import json
import subprocess
import sys

import numpy as np
import pytest

import zelus

PROGRAM = '''
import sys
import KratosMultiphysics
from KratosMultiphysics import *
import KratosMultiphysics.KratosUnittest as KratosUnittest
from KratosMultiphysics.StructuralMechanicsApplication import *
from KratosMultiphysics.ContactStructuralMechanicsApplication.contact_structural_mechanics_analysis import (
    ContactStructuralMechanicsAnalysis,
)

class Own(ContactStructuralMechanicsAnalysis):
    def __init__(self, model, parameters):
        super().__init__(model, parameters)
        self.sums = []

    def ApplyBoundaryConditions(self):
        super().ApplyBoundaryConditions()
        VariableUtils().SetVariable(VOLUME_ACCELERATION, Vector([0.0, 0.0, 0.0]), self.model["Structure"].Nodes)

    def FinalizeSolutionStep(self):
        super().FinalizeSolutionStep()
        part = self._GetSolver().GetComputingModelPart().GetRootModelPart()
        bottom = part.GetSubModelPart("Bottom")
        self.sums.append(VariableUtils().SumHistoricalNodeScalarVariable(KratosMultiphysics.REACTION_Y, bottom, 0))
        Logger.PrintInfo("own", part.ProcessInfo[STEP], part.ProcessInfo[KratosMultiphysics.TIME])

    def Finalize(self):
        super().Finalize()
        KratosUnittest.TestCase().assertAlmostEqual(self.sums[-1] / 450.0, 1.0, places=2)
        print("sums", self.sums, sys.argv[1:])

if __name__ == "__main__":
    with open("ProjectParameters.json", "r") as parameter_file:
        parameters = KratosMultiphysics.Parameters(parameter_file.read())
    model = KratosMultiphysics.Model()
    Own(model, parameters).Run()
'''

PROCESS = '''
import KratosMultiphysics as KM
import KratosMultiphysics.KratosUnittest as KratosUnittest

def Factory(settings, model):
    if not isinstance(settings, KM.Parameters):
        raise Exception("expected input shall be a Parameters object, encapsulating a json string")
    return SpringsProcess(model, settings["Parameters"])

class SpringsProcess(KM.Process, KratosUnittest.TestCase):
    def __init__(self, model, settings):
        KM.Process.__init__(self)
        defaults = KM.Parameters("""{"help": "none", "model_part_name": "please_specify", "variable_name": "DISPLACEMENT",
            "interval": [0.0, 1e30], "file": "heights.txt"}""")
        settings.ValidateAndAssignDefaults(defaults)
        self.model_part = model[settings["model_part_name"].GetString()]
        self.variable = KM.KratosGlobals.GetVariable(settings["variable_name"].GetString())
        self.file = settings["file"].GetString()

    def ExecuteInitialize(self):
        self.lines = []

    def ExecuteFinalizeSolutionStep(self):
        highest = max((node for node in self.model_part.Nodes), key=lambda node: node.Y0)
        u = highest.GetSolutionStepValue(self.variable)
        self.assertAlmostEqual(highest.Y, highest.Y0 + u[1])
        self.lines.append(f"{self.model_part.ProcessInfo[KM.TIME]} {highest.Id} {u[1]}")

    def ExecuteFinalize(self):
        with open(self.file, "w") as out:
            out.write("\\n".join(self.lines))
'''


def module(folder, *arguments):
    command = [sys.executable, "-W", "ignore", "-m", "zelus", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_a_program_for_kratos_runs(inside):
    (inside / "MainKratos.py").write_text(PROGRAM)
    ran = module(inside, "MainKratos.py", "its", "arguments")
    assert ran.returncode == 0, ran.stderr
    # half of the roller carries half of 900 N
    assert "sums" in ran.stdout and "['its', 'arguments']" in ran.stdout and ran.stdout.count("own:") == 4
    assert (inside / "vtu_output/Structure_4.vtu").exists()
    strange = module(inside, "--like", "another", "MainKratos.py")
    assert strange.returncode == 2 and "another" in strange.stderr


def test_a_deck_runs_as_a_module(inside):
    ran = module(inside, "ProjectParameters.json")
    assert ran.returncode == 0 and "4 steps, to its end" in ran.stdout
    (inside / "ProjectParameters.json").write_text("{}")
    assert module(inside, "ProjectParameters.json").returncode == 2


@pytest.mark.parametrize("as_stage", [False, True])
def test_a_process_beside_its_deck_runs_as_it_is(inside, as_stage):
    (inside / "springs_process.py").write_text(PROCESS)
    deck = json.loads((inside / "ProjectParameters.json").read_text())
    own = {"python_module": "springs_process", "process_name": "SpringsProcess", "Parameters": {"model_part_name": "Structure.Top"}}
    deck["processes"]["own"] = [own]
    (inside / "ProjectParameters.json").write_text(json.dumps(deck))
    if as_stage:
        zelus.AnalysisStage(zelus.Model(), zelus.Parameters(json.dumps(deck))).Run()
    else:
        zelus.run("ProjectParameters.json")
    lines = np.loadtxt(inside / "heights.txt")
    assert lines[:, 0].tolist() == [0.25, 0.5, 0.75, 1.0] and (np.diff(lines[:, 2]) < 0).all()
    with pytest.raises(ModuleNotFoundError):
        import KratosMultiphysics  # noqa: F401


def test_settings_of_a_process_are_checked_by_itself(inside):
    (inside / "springs_process.py").write_text(PROCESS)
    own = {"python_module": "springs_process", "Parameters": {"model_part": "Structure.Top"}}
    with pytest.raises(RuntimeError, match='"model_part" is not known'):
        zelus.run("ProjectParameters.json", set={"processes.own": [own]})


def test_a_process_that_is_nowhere_is_an_error_with_its_name(inside):
    own = {"python_module": "nowhere_process", "Parameters": {}}
    with pytest.raises(zelus.InputError, match="nowhere_process"):
        zelus.run("ProjectParameters.json", set={"processes.own": [own]})


def test_what_of_kratos_is_not_here_is_named():
    with zelus.kratos.installed():
        import KratosMultiphysics as KM

        with pytest.raises(AttributeError, match="FluidDynamicsNothing"):
            KM.FluidDynamicsNothing
        with pytest.raises(ModuleNotFoundError, match="FluidDynamicsApplication"):
            import KratosMultiphysics.FluidDynamicsApplication  # noqa: F401
        assert KM.DISPLACEMENT_X == "DISPLACEMENT_X" and KM.KratosGlobals.GetVariableType("DISPLACEMENT") == "Array"
        assert KM.Vector(3).Size() == 3 and KM.Matrix(2, 3).Size2() == 3 and KM.Array3(2.0).tolist() == [2, 2, 2]
        assert not KM.IsDistributedRun() and KM.DataCommunicator.GetDefault().SumAll(3.0) == 3.0
    with pytest.raises(NotImplementedError, match="mesh file"):
        zelus.Model().CreateModelPart("Structure")


def test_processes_of_the_program_can_be_called_by_hand(inside):
    reference = zelus.run("ProjectParameters.json", set={"problem_data.end_time": 0.5})
    deck = json.loads((inside / "ProjectParameters.json").read_text())
    deck["problem_data"]["end_time"] = 0.5
    lists = {key: deck["processes"].pop(key) for key in ("constraints_process_list", "loads_process_list")}
    with zelus.kratos.installed():
        from KratosMultiphysics.assign_vector_variable_process import AssignVectorVariableProcess
        from KratosMultiphysics.process_factory import KratosProcessFactory

    class ByHand(zelus.AnalysisStage):
        def ModifyInitialGeometry(self):
            super().ModifyInitialGeometry()
            held, loads = (zelus.Parameters(own) for own in lists.values())
            self.own = [AssignVectorVariableProcess(self.model, item["Parameters"]) for item in held]
            self.own += KratosProcessFactory(self.model).ConstructListOfProcesses(loads)
            [process.ExecuteInitialize() for process in self.own]

        def ModifyAfterSolverInitialize(self):
            [process.ExecuteBeforeSolutionLoop() for process in self.own]

        def ApplyBoundaryConditions(self):
            super().ApplyBoundaryConditions()
            [process.ExecuteInitializeSolutionStep() for process in self.own]

    stage = ByHand(zelus.Model(), zelus.Parameters(json.dumps(deck)))
    with pytest.warns(zelus.ZelusWarning, match="held-by-nothing"):
        stage.Run()
    assert (stage.result()["DISPLACEMENT"] == reference["DISPLACEMENT"]).all()


def test_what_is_wrong_with_a_process_called_by_hand_is_said(inside):
    class Wrong(zelus.AnalysisStage):
        def ModifyInitialGeometry(self):
            with pytest.raises(zelus.InputError, match="there is no model part") as raised:
                settings = zelus.Parameters('{"model_part_name": "Structure.Nowhere", "variable_name": "DISPLACEMENT", "value": [0, 0, 0]}')
                zelus.BuiltinProcess(self.model, "assign_vector_variable_process", settings).ExecuteInitialize()
            assert raised.value.code == "unknown-model-part"
            with pytest.raises(zelus.InputError, match="no process"):
                zelus.BuiltinProcess(self.model, "assign_vectors_process", zelus.Parameters())
            (contact,) = self.project_parameters["processes"]["contact_process_list"]
            own = zelus.BuiltinProcess(self.model, "alm_contact_process", contact["Parameters"])
            with pytest.raises(RuntimeError, match="belongs into the lists"):
                own.ExecuteInitialize()
            raise InterruptedError

    with open("ProjectParameters.json") as file:
        stage = Wrong(zelus.Model(), zelus.Parameters(file.read()))
    with pytest.raises(InterruptedError):
        stage.Run()


def test_functions_and_intervals_are_those_of_decks():
    with zelus.kratos.installed():
        from KratosMultiphysics import DISPLACEMENT, DoubleVariable, GenericFunctionUtility, IntervalUtility, DISPLACEMENT_X

    settings = zelus.Parameters('{"interval": [1.0, "End"]}')
    interval = IntervalUtility(settings)
    assert interval.IsInInterval(1.0) and not interval.IsInInterval(0.5) and settings["interval"][1].GetDouble() == 1e30
    function = GenericFunctionUtility("2.0*t + x - X if y > 1 else 0")
    assert function.DependsOnSpace() and function.CallFunction(3.0, 2.0, 0.0, 5.0, 1.0, 0.0, 0.0) == 12.0
    assert function.CallFunction(3.0, 0.0, 0.0, 5.0) == 0.0
    with pytest.raises(ValueError, match="character 7"):
        GenericFunctionUtility("2.0*t+*")
    assert isinstance(DISPLACEMENT_X, DoubleVariable) and not isinstance(DISPLACEMENT, DoubleVariable)
