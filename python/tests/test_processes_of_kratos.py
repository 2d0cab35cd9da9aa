"""Decks of Kratos' own tests whose processes are Kratos' files of Python, as they are, in place of those of the program.

They need the decks (`ZELUS_SHARED`, or the folder `shared` beside the repository) and a Python with Kratos (`KRATOS_PYTHON`, as
for benches/compare.py): skipped without.
"""

import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
import zelus

SHARED = pathlib.Path(os.environ.get("ZELUS_SHARED", pathlib.Path(__file__).parents[3] / "shared"))
TAKEN = {
    "assign_scalar_variable_process",
    "assign_vector_by_direction_to_condition_process",
    "assign_vector_variable_process",
    "assign_vector_variable_to_conditions_process",
}
DECKS = {
    "decks/ALM_frictionless_contact_test_2D/simple_patch_test": "DISPLACEMENT",
    "decks/ALM_frictionless_contact_test_2D/taylor_patch_dynamic_test": "DISPLACEMENT",
    "decks/ALM_frictional_contact_test_2D/pure_friction_test": "DISPLACEMENT",
    "decks/mesh_tying_test/simple_patch_test_2D": "DISPLACEMENT",
    "decks/penalty_frictionless_contact_test_2D/hyper_simple_patch_test": "DISPLACEMENT",
    "heat/decks/conv_diff_tests/source_pure_diffusion": "TEMPERATURE",
}


@pytest.fixture(scope="module")
def files():
    """The folder of Kratos' processes."""
    python = os.environ.get("KRATOS_PYTHON")
    if not python or not (SHARED / "decks").exists():
        pytest.skip("needs ZELUS_SHARED and KRATOS_PYTHON")
    found = "import importlib.util as u; print(u.find_spec('KratosMultiphysics').submodule_search_locations[0])"
    folder = subprocess.run([python, "-c", found], capture_output=True, text=True, check=True).stdout.strip()
    return pathlib.Path(folder)


def entries(value):
    """The entries of processes in a deck."""
    values = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    own = [value] if isinstance(value, dict) and "python_module" in value else []
    return own + [entry for inner in values for entry in entries(inner)]


@pytest.mark.parametrize("name", DECKS)
def test_processes_of_kratos_run_as_they_are(name, files, tmp_path, monkeypatch):
    folder = tmp_path / "deck"
    shutil.copytree(SHARED / name, folder)
    folder.chmod(0o755)
    monkeypatch.chdir(folder)
    own = zelus.run("ProjectParameters.json", like="kratos")
    deck = json.loads(pathlib.Path("ProjectParameters.json").read_text())
    taken = [entry for entry in entries(deck) if entry["python_module"] in TAKEN]
    assert taken
    for entry in taken:
        # Without the name of a package the file beside the deck is the process.
        del entry["kratos_module"]
        shutil.copy(files / f"{entry['python_module']}.py", folder)
    path = folder / "Taken.json"
    path.write_text(json.dumps(deck))
    theirs = zelus.run("Taken.json", like="kratos")
    first, second = own[DECKS[name]], theirs[DECKS[name]]
    assert np.abs(first).max() > 0 and np.allclose(first, second, rtol=0, atol=1e-12 * np.abs(first).max())
