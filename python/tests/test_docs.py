"""The code of docs/python.md runs."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]


def test_the_page_runs(inside, capsys):
    pytest.importorskip("matplotlib").use("agg")
    pytest.importorskip("meshio")
    text = (ROOT / "docs/python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    # the first picture takes ten lines
    assert len(blocks) > 4 and len([line for line in blocks[0].splitlines() if line.strip()]) <= 10
    names = {"__name__": "page"}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert {"pressure.png", "result.vtu", "run.png"} <= {path.name for path in inside.iterdir()}
    said = capsys.readouterr().out
    assert "max_iteration" in said or "type" in said
    # the last process prints the pressure of Hertz
    assert abs(float(said.split()[-1]) / 579.47 - 1) < 0.005
