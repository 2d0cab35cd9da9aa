"""Helpers of the tests: decks of the repository, copied so that runs write beside the copies."""

import os
import pathlib
import shutil

import pytest

ROOT = pathlib.Path(__file__).parents[2]


@pytest.fixture
def copied(tmp_path):
    """Copies an example and gives the path of its deck."""

    def copy(name, to=None):
        folder = tmp_path / (to or name)
        shutil.copytree(ROOT / "examples" / name, folder, ignore=shutil.ignore_patterns("vtu_output"))
        return folder / "ProjectParameters.json"

    return copy


@pytest.fixture
def deck(copied):
    """The roller on the block."""
    return copied("hertz_line_contact")


@pytest.fixture
def inside(deck, monkeypatch):
    """The folder of the deck, which is the present one."""
    monkeypatch.chdir(deck.parent)
    return deck.parent


@pytest.fixture
def program():
    """The program `zelus`."""
    path = pathlib.Path(os.environ.get("ZELUS", ROOT / "target/release/zelus"))
    if not path.exists():
        pytest.skip("the program is not built")
    return path
