"""The loop of a stage with its hooks, processes in Python and access to the model."""

import numpy as np
import pytest

import zelus

HOOKS = """ModifyInitialProperties ModifyInitialGeometry Check ModifyAfterSolverInitialize ModifyBeforeSolutionLoop
InitializeSolutionStep ApplyBoundaryConditions ChangeMaterialProperties SolveSolutionStep FinalizeSolutionStep OutputSolutionStep
Finalize""".split()

POINTS = [name for name in vars(zelus.Process) if name.startswith("Execute")]


def parameters(folder, **changes):
    own = zelus.Parameters((folder / "ProjectParameters.json").read_text())
    for path, value in changes.items():
        *inner, last = path.split("__")
        at = own
        for key in inner:
            at = at[key]
        at[last] = value
    return own


def recording(log):
    """An AnalysisStage that notes its hooks."""

    def noted(name):
        def hook(self):
            log.append(name)
            getattr(zelus.AnalysisStage, name)(self)

        return hook

    return type("Recording", (zelus.AnalysisStage,), {name: noted(name) for name in HOOKS})


def test_hooks_are_called_in_the_order_of_kratos(inside):
    log = []

    @zelus.register_process("noting_process")
    class Noting(zelus.OutputProcess):
        def __init__(self, model, settings):
            self.model_part = model[settings["model_part_name"].GetString()]

    for name in [*POINTS, "Check", "PrintOutput"]:
        setattr(Noting, name, lambda self, name=name: log.append(f"  {name}"))
    own = parameters(inside, problem_data__end_time=0.5)
    own["processes"]["noting"] = [{"python_module": "noting_process", "Parameters": {"model_part_name": "Structure"}}]
    recording(log)(zelus.Model(), own).Run()
    step = """InitializeSolutionStep ApplyBoundaryConditions .ExecuteInitializeSolutionStep ChangeMaterialProperties
        SolveSolutionStep FinalizeSolutionStep .ExecuteFinalizeSolutionStep
        OutputSolutionStep .ExecuteBeforeOutputStep .PrintOutput .ExecuteAfterOutputStep"""
    expected = f"""ModifyInitialProperties ModifyInitialGeometry .ExecuteInitialize .Check Check
        ModifyAfterSolverInitialize ModifyBeforeSolutionLoop .ExecuteBeforeSolutionLoop {step} {step} Finalize .ExecuteFinalize"""
    assert log == [word.replace(".", "  ") for word in expected.split()]


def test_a_stage_gives_the_bits_of_a_run(inside):
    stage = zelus.AnalysisStage(zelus.Model(), parameters(inside))
    stage.Run()
    ours = stage.model["Structure"].array("DISPLACEMENT")
    result = stage.result()
    other = zelus.run(inside / "ProjectParameters.json")
    assert (ours == other["DISPLACEMENT"]).all() and (result["CONTACT_PRESSURE"] == other["CONTACT_PRESSURE"]).all()
    assert result.report["steps"] == other.report["steps"]


def test_a_loop_of_one_s_own(inside):
    stage = zelus.AnalysisStage(zelus.Model(), parameters(inside))
    stage.Initialize()
    times = []
    while stage.time < 0.6:
        stage.time = stage._GetSolver().AdvanceInTime(stage.time)
        stage.InitializeSolutionStep()
        assert stage.SolveSolutionStep()
        stage.FinalizeSolutionStep()
        stage.OutputSolutionStep()
        times.append(stage.time)
    stage.Finalize()
    result = stage.result()
    assert times == [0.25, 0.5, 0.75] == result.times.tolist() and not result.converged
    assert (inside / "vtu_output/Structure_3.vtu").exists()


def test_properties_and_geometry_may_be_changed_at_the_start(inside):
    class Softer(zelus.AnalysisStage):
        def ModifyInitialProperties(self):
            for own in filter(lambda own: own.Has(zelus.YOUNG_MODULUS), self.model["Structure"].Properties):
                own[zelus.YOUNG_MODULUS] = 0.25 * own[zelus.YOUNG_MODULUS]

        def ModifyAfterSolverInitialize(self):
            with pytest.raises(RuntimeError, match="ModifyInitialProperties"):
                self.model["Structure"].Properties[1].SetValue(zelus.YOUNG_MODULUS, 1.0)
            with pytest.raises(RuntimeError, match="ModifyInitialGeometry"):
                self.model["Structure"].Nodes[1].X0 = 1.0

    stage = Softer(zelus.Model(), parameters(inside))
    stage.Run()
    # Hertz: the peak goes with the root of the modulus
    peak = stage.result()["CONTACT_PRESSURE"].max()
    assert abs(peak / (0.5 * 579.47) - 1) < 0.02

    class Twice(zelus.AnalysisStage):
        def ModifyInitialGeometry(self):
            for node in self.model["Structure"].Nodes:
                node.X0, node.Y0 = 2 * node.X0, 2 * node.Y0
                node.X, node.Y = node.X0, node.Y0

    own = parameters(inside)
    own["processes"]["loads_process_list"][0]["Parameters"]["modulus"] = "18.0*t/2"
    stage = Twice(zelus.Model(), own)
    stage.Run()
    result = stage.result()
    assert np.isclose(result.points[:, 0].max(), 2 * zelus.run("ProjectParameters.json").points[:, 0].max())
    assert abs(result["CONTACT_PRESSURE"].max() / (579.47 / np.sqrt(2)) - 1) < 0.02


def test_boundary_conditions_in_python_are_those_of_the_deck(inside):
    reference = zelus.run("ProjectParameters.json", set={"problem_data.end_time": 0.5})

    class Loaded(zelus.AnalysisStage):
        def ApplyBoundaryConditions(self):
            super().ApplyBoundaryConditions()
            for condition in self.model["Structure.Top"].Conditions:
                condition.SetValue(zelus.LINE_LOAD, [0.0, -18.0 * self.time, 0.0])

        def ModifyAfterSolverInitialize(self):
            for node in self.model["Structure.Bottom"].Nodes:
                node.Fix(zelus.DISPLACEMENT_Y)
                assert node.IsFixed(zelus.DISPLACEMENT_Y) and not node.IsFixed(zelus.DISPLACEMENT_X)

    own = parameters(inside, problem_data__end_time=0.5)
    own["processes"].RemoveValue("loads_process_list")
    own["processes"]["constraints_process_list"] = own["processes"]["constraints_process_list"].Clone()
    own["processes"]["constraints_process_list"]._value.pop(1)
    stage = Loaded(zelus.Model(), own)
    # what Python holds is not known beforehand
    with pytest.warns(zelus.ZelusWarning, match="held-by-nothing"):
        stage.Run()
    assert (stage.result()["DISPLACEMENT"] == reference["DISPLACEMENT"]).all()


def test_what_a_hook_leaves_out_is_not_done(inside):
    class Silent(zelus.AnalysisStage):
        def OutputSolutionStep(self):
            pass

    Silent(zelus.Model(), parameters(inside)).Run()
    assert not list((inside / "vtu_output").glob("*_4.vtu"))


def test_the_model_is_read_and_written(inside):
    seen = {}

    class Looking(zelus.AnalysisStage):
        def FinalizeSolutionStep(self):
            super().FinalizeSolutionStep()
            part = self.model["Structure"]
            top = part.GetSubModelPart("Top")
            node = next(iter(top.Nodes))
            assert node == part.Nodes[node.Id] == part.GetNode(node.Id) and node.Id in top.Nodes
            u = node.GetSolutionStepValue(zelus.DISPLACEMENT)
            assert u[1] == node.GetSolutionStepValue(zelus.DISPLACEMENT_Y) == top.array("DISPLACEMENT")[0, 1]
            assert np.isclose(node.Y, node.Y0 + u[1]) and node.SolutionStepsDataHas(zelus.DISPLACEMENT)
            element = next(iter(part.Elements))
            assert len(element.GetNodes()) == len(element.GetGeometry()) > 2
            assert len(element.CalculateOnIntegrationPoints(zelus.VON_MISES_STRESS, part.ProcessInfo)) > 0
            assert element.Properties[zelus.YOUNG_MODULUS] in (70000.0, 210000.0)
            seen["step"] = part.ProcessInfo[zelus.STEP]
            node.SetValue(zelus.TEMPERATURE, 3.0)
            assert node.GetValue(zelus.TEMPERATURE) == 3.0 and node.Has(zelus.TEMPERATURE)
            node.Set(zelus.MARKER)
            assert node.Is(zelus.MARKER) and node.IsNot(zelus.NOT_MARKER) and not node.Is(zelus.VISITED)
            own = part.CreateSubModelPart(f"Own{seen['step']}")
            own.AddNodes([node.Id])
            assert own.NumberOfNodes() == 1 and part.HasSubModelPart(own.Name) and own.FullName() == f"Structure.{own.Name}"
            with pytest.raises(KeyError, match="did you mean"):
                self.model["Structure.Topp"]
            with pytest.raises(KeyError):
                part.Nodes[10**9]
            with pytest.raises(RuntimeError, match="time_stepping"):
                part.ProcessInfo[zelus.TIME] = 4.0
            part.set_array("DISPLACEMENT", part.array("DISPLACEMENT"))

    stage = Looking(zelus.Model(), parameters(inside))
    stage.Run()
    assert seen["step"] == 4
    with pytest.raises(RuntimeError, match="empty"):
        zelus.Model()["Structure"]


def test_what_a_process_raises_comes_out_and_ends_the_run(inside):
    @zelus.register_process("failing_process")
    class Failing(zelus.Process):
        def __init__(self, model, settings):
            self.ended = False

        def ExecuteFinalizeSolutionStep(self):
            raise ArithmeticError("enough")

        def ExecuteFinalize(self):
            (inside / "ended").touch()

    own = parameters(inside)
    own["processes"]["failing"] = [{"python_module": "failing_process", "Parameters": {}}]
    with pytest.raises(ArithmeticError, match="enough"):
        zelus.AnalysisStage(zelus.Model(), own).Run()
    assert (inside / "ended").exists()
    (inside / "ended").unlink()
    (inside / "ProjectParameters.json").write_text(own.WriteJsonString())
    with pytest.raises(ArithmeticError, match="enough"):
        zelus.run("ProjectParameters.json")
    assert (inside / "ended").exists()


@pytest.mark.parametrize("hook", [name for name in HOOKS if name != "Finalize"])
def test_what_a_hook_raises_comes_out(inside, hook):
    def fail(self):
        raise ArithmeticError(hook)

    stage = type("Failing", (zelus.AnalysisStage,), {hook: fail})(zelus.Model(), parameters(inside))
    with pytest.raises(ArithmeticError, match=hook):
        stage.Run()
    assert not stage.result().converged


@pytest.mark.parametrize("end_time", [1.0, 0.6])
def test_steps_that_are_cut_set_their_boundary_conditions_anew(inside, end_time):
    times = []

    class Cut(zelus.AnalysisStage):
        def ApplyBoundaryConditions(self):
            super().ApplyBoundaryConditions()
            times.append(self.process_info[zelus.TIME])

    own = parameters(inside, problem_data__end_time=end_time)
    own["solver_settings"]["time_stepping"]["time_step"] = 1.0
    own["solver_settings"]["max_iteration"] = 4
    (inside / "ProjectParameters.json").write_text(own.WriteJsonString())
    stage = Cut(zelus.Model(), own)
    stage.Run()
    result = stage.result()
    assert times[0] > min(times) and times[-1] == times[0] and times == result.steps["time"].tolist()
    assert result.converged and result.report["steps"] == zelus.run("ProjectParameters.json").report["steps"]


def test_a_loop_that_ends_within_a_step_that_was_cut_keeps_what_is_whole(inside):
    class Short(zelus.AnalysisStage):
        def KeepAdvancingSolutionLoop(self):
            return self.time < 0.1

    own = parameters(inside)
    own["solver_settings"]["time_stepping"]["time_step"] = 1.0
    own["solver_settings"]["max_iteration"] = 4
    stage = Short(zelus.Model(), own)
    stage.Run()
    result = stage.result()
    assert not result.converged and 0.1 <= result.times[-1] < 1.0 and result["CONTACT_PRESSURE"].max() > 0
    assert (inside / f"vtu_output/Structure_{result.steps['step'][-1]}.vtu").exists()


def test_errors_of_the_deck_come_out(inside):
    own = parameters(inside)
    own["solver_settings"]["max_iteration"] = "many"
    stage = zelus.AnalysisStage(zelus.Model(), own)
    with pytest.raises(zelus.InputError, match="max_iteration"):
        stage.Run()


def test_a_process_that_finds_something_wrong_ends_the_run_before_it_begins(inside):
    @zelus.register_process("checking_process")
    class Checking(zelus.Process):
        def __init__(self, model, settings):
            self.part = model["Structure"]

        def Check(self):
            if self.part.NumberOfNodes() < 10**6:
                raise ValueError("too few nodes")

    with pytest.raises(ValueError, match="too few nodes"):
        zelus.run("ProjectParameters.json", set={"processes.own": [{"python_module": "checking_process", "Parameters": {}}]})
    assert not (inside / "vtu_output").exists()


@pytest.mark.filterwarnings("ignore::zelus.ZelusWarning")
def test_a_run_that_goes_on_tells_its_processes_that_it_begins(inside):
    @zelus.register_process("telling_process")
    class Telling(zelus.Process):
        log = []

        def __init__(self, model, settings):
            self.part = model["Structure"]

        def ExecuteBeforeSolutionLoop(self):
            self.log.append("begins")

        def ExecuteInitializeSolutionStep(self):
            self.log.append(self.part.ProcessInfo[zelus.TIME])

    own = {"python_module": "telling_process", "Parameters": {}}
    saving = {"python_module": "save_restart_process", "Parameters": {"model_part_name": "Structure", "restart_save_frequency": 0.45}}
    changes = {"processes.own": [own], "output_processes.saved": [saving]}
    whole = zelus.run("ProjectParameters.json", set=changes)
    log, Telling.log[:] = list(Telling.log), []
    assert log == ["begins", 0.25, 0.5, 0.75, 1.0]
    settings = {"input_type": "rest", "input_filename": "Structure", "restart_load_file_label": "0.5"}
    changes["solver_settings.model_import_settings"] = settings
    again = zelus.run("ProjectParameters.json", set=changes)
    assert Telling.log == ["begins", 0.75, 1.0]
    assert (again["DISPLACEMENT"] == whole["DISPLACEMENT"]).all()
