"""Runs of decks, as a user of the installed wheel makes them."""

import json
import os
import pickle
import signal
import subprocess
import threading
import time
import warnings

import numpy as np
import pytest

import zelus

# Hertz (1882) for the roller of the example: peak pressure in N/mm², half-width in mm.
PEAK, HALF_WIDTH = 579.47, 0.98877


def test_the_pressure_is_that_of_hertz(deck):
    result = zelus.run(deck)
    x, pressure = result.of_part("RollerSurface")[:, 0], result.of_part("RollerSurface", "CONTACT_PRESSURE")
    assert abs(pressure.max() / PEAK - 1) < 0.005
    inside = x < 0.9 * HALF_WIDTH
    exact = PEAK * np.sqrt(1 - (x[inside] / HALF_WIDTH) ** 2)
    assert np.abs(pressure[inside] - exact).max() < 0.03 * PEAK
    assert (pressure[x > 1.1 * HALF_WIDTH] == 0).all()


def test_results_are_arrays(deck):
    result = zelus.run(deck, threads=1)
    assert result.converged and np.allclose(result.times, [0.25, 0.5, 0.75, 1.0])
    assert result["DISPLACEMENT"].shape == result.points.shape == (len(result.node_ids), 3)
    cells = sum(len(own) for own in result.cells.values())
    assert cells == len(result.element_ids) == len(result.element_fields["VON_MISES_STRESS"])
    assert max(own.max() for own in result.cells.values()) < len(result.points)
    assert result.element_fields["VON_MISES_STRESS"].max() > 100 and result["VON_MISES_STRESS"].max() > 100
    assert (result.iterations > 0).all() and len(result.iteration_records) == result.steps["iterations"].sum()
    last = result.iteration_records[result.iteration_records["step"] == result.steps["step"][-1]]
    assert last["ratio"][-1] <= 1 < last["ratio"][0]
    assert any((values[1:] > 0).all() for values in result.contact.values())
    with pytest.raises(KeyError, match="DISPLACEMENT"):
        result["DISPLACMENT"]


def test_buffers_are_taken_over_without_copies(deck):
    result = zelus.run(deck)
    displacement = result["DISPLACEMENT"]
    assert not displacement.flags.owndata and displacement.flags.writeable
    kept = displacement.copy()
    del result
    assert (displacement == kept).all()


def test_the_bits_are_those_of_the_program(copied, program):
    ours, others = copied("hertz_line_contact", "ours"), copied("hertz_line_contact", "others")
    result = zelus.run(ours, threads=1)
    report = others.parent / "report.json"
    subprocess.run([program, "run", others, "--threads", "2", "--report", report], check=True, capture_output=True)
    assert json.loads(report.read_text())["steps"] == result.report["steps"]
    pressures = [(deck.parent / "contact_pressure.json").read_bytes() for deck in (ours, others)]
    assert pressures[0] == pressures[1] and len(pressures[0]) > 100
    written = sorted(path.name for path in (ours.parent / "vtu_output").iterdir())
    assert len(written) > 4
    for name in written:
        assert (ours.parent / "vtu_output" / name).read_bytes() == (others.parent / "vtu_output" / name).read_bytes()


def test_values_take_the_place_of_the_deck_s(deck):
    half = zelus.run(deck, set={"problem_data.end_time": 0.5, "processes.loads_process_list.0.Parameters.modulus": "36.0*t"})
    assert np.allclose(half.times, [0.25, 0.5])
    assert abs(half["CONTACT_PRESSURE"].max() / PEAK - 1) < 0.005


def test_what_is_set_is_checked(deck):
    with pytest.raises(zelus.InputError, match="max_iteration"):
        zelus.run(deck, set={"solver_settings.max_iteration": "many"})


def test_results_survive_pickling(deck):
    result = zelus.run(deck, set={"problem_data.end_time": 0.25})
    again = pickle.loads(pickle.dumps(result))
    assert (again["DISPLACEMENT"] == result["DISPLACEMENT"]).all() and again.report == result.report
    assert (again.parts["Interface"] == result.parts["Interface"]).all()


def test_problems_have_code_place_and_remedy(deck):
    deck.write_text(deck.read_text().replace("alm_contact_process", "alm_contact_proces"))
    with pytest.raises(zelus.InputError) as raised:
        zelus.run(deck)
    error = raised.value
    assert error.code == "unknown-process" and "alm_contact_process" in error.remedy
    file, line, column = error.place.rsplit(":", 2)
    assert file == str(deck) and "alm_contact_proces" in deck.read_text().splitlines()[int(line) - 1] and int(column) > 0
    assert pickle.loads(pickle.dumps(error)).problems == error.problems


def test_a_deck_that_is_not_there_is_an_error(tmp_path):
    with pytest.raises(zelus.ZelusError, match="missing.json"):
        zelus.run(tmp_path / "missing.json")


def test_a_step_that_does_not_converge_leaves_what_did(deck):
    changes = {"solver_settings.max_iteration": 1, "solver_settings.residual_relative_tolerance": 1e-14}
    with pytest.raises(zelus.NotConvergedError) as error:
        zelus.run(deck, set=changes)
    result = error.value.result
    assert not result.converged and not result.steps["converged"].any() and len(result.points)


def test_warnings_are_warnings_of_python(deck):
    with pytest.warns(zelus.ZelusWarning, match=r"warning\[unknown-key-ignored\]"):
        zelus.run(deck, set={"problem_dat": {}})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        zelus.run(deck, set={"problem_data.end_time": 0.25})


def test_threads_do_not_change_the_bits(deck):
    one, two = (zelus.run(deck, threads=threads)["DISPLACEMENT"] for threads in (1, 2))
    assert (one == two).all()


def test_runs_stand_beside_each_other(copied):
    decks = [copied("hertz_line_contact", f"run_{number}") for number in range(2)]
    results = [None, None]

    def work(at):
        results[at] = zelus.run(decks[at], threads=1)

    threads = [threading.Thread(target=work, args=(at,)) for at in range(2)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert (results[0]["DISPLACEMENT"] == results[1]["DISPLACEMENT"]).all()


def test_other_threads_go_on_while_it_solves(deck):
    ticks, over = [], threading.Event()

    def tick():
        while not over.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    beside = threading.Thread(target=tick)
    beside.start()
    begun = time.perf_counter()
    zelus.run(deck, threads=1)
    took = time.perf_counter() - begun
    over.set()
    beside.join()
    assert np.diff(ticks).max() < 0.5 * took and len(ticks) > 20


def test_a_callback_sees_steps_and_may_end_the_run(deck):
    seen = []

    def look(step):
        seen.append((step.time, np.abs(step.field("DISPLACEMENT")).max()))
        if len(seen) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        zelus.run(deck, on_step=look)
    assert [time for time, _ in seen] == [0.25, 0.5] and 0 < seen[0][1] < seen[1][1]
    assert (deck.parent / "vtu_output/Structure_2.vtu").exists()
    assert not (deck.parent / "vtu_output/Structure_3.vtu").exists()
    assert np.allclose(stopped.value.result.times, [0.25, 0.5])


def test_ctrl_c_ends_after_the_step(deck, request):
    # Shells let what they run in the background ignore the signal.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, before))
    signals = []

    def interrupt(step):
        if not signals:
            signals.append(threading.Timer(0.001, os.kill, (os.getpid(), signal.SIGINT)))
            signals[0].start()

    with pytest.raises(KeyboardInterrupt) as stopped:
        zelus.run(deck, set={"solver_settings.time_stepping.time_step": 0.002}, on_step=interrupt)
    result = stopped.value.result
    assert not result.converged and result.steps["converged"].all() and 1 <= len(result.times) < 500
    assert result["DISPLACEMENT"].any()


def test_errors_of_callbacks_come_out_as_they_are(deck):
    with pytest.raises(ZeroDivisionError):
        zelus.run(deck, on_step=lambda step: 1 / 0)


def test_meshes_of_other_packages(deck):
    meshio = pytest.importorskip("meshio")
    result = zelus.run(deck, set={"problem_data.end_time": 0.25})
    mesh = result.to_meshio()
    mesh.write(deck.parent / "again.vtu")
    again = meshio.read(deck.parent / "again.vtu")
    assert np.allclose(again.point_data["CONTACT_PRESSURE"], result["CONTACT_PRESSURE"])
    assert sum(len(block.data) for block in again.cells) == len(result.element_ids)
    assert np.allclose(np.concatenate(again.cell_data["PART"]), result.element_fields["PART"])


def test_cells_have_the_nodes_of_the_result_file(copied):
    meshio = pytest.importorskip("meshio")
    deck = copied("hertz_sphere")
    result = zelus.run(deck, set={"problem_data.end_time": 0.25})
    written = meshio.read(sorted((deck.parent / "vtu_output").glob("*_1.vtu"))[0])
    ours = result.to_meshio()
    assert [block.type for block in ours.cells] == [block.type for block in written.cells]
    for block, other in zip(ours.cells, written.cells):
        assert np.allclose(ours.points[block.data], written.points[other.data])
    assert np.allclose(ours.point_data["DISPLACEMENT"], written.point_data["DISPLACEMENT"], atol=1e-12)


def test_pictures(deck):
    pytest.importorskip("matplotlib").use("agg")
    figure = zelus.run(deck).plot()
    figure.savefig(deck.parent / "run.png")
    assert (deck.parent / "run.png").stat().st_size > 5000


def test_grids_of_pyvista(deck):
    pytest.importorskip("pyvista")
    grid = zelus.run(deck, set={"problem_data.end_time": 0.25}).to_pyvista()
    assert grid.n_points and grid.point_data["CONTACT_PRESSURE"].max() > 0 and len(grid.cell_data["PART"]) == grid.n_cells


def test_progress_tells_steps_and_iterations(deck, capfd):
    zelus.run(deck, progress=True)
    said = capfd.readouterr().err
    assert "step 4/4, time 1 of 1" in said and "of the tolerance" in said
    zelus.run(deck, progress=False)
    assert capfd.readouterr().err == ""
