"""Progress of a run, in terminals and notebooks."""

import json
import sys

from .result import worst_ratio


def _notebook():
    """Display of lines in a notebook; `None` elsewhere."""
    shell = sys.modules.get("IPython")
    kernel = shell and shell.get_ipython() and hasattr(shell.get_ipython(), "kernel")
    if not kernel:
        return None
    from IPython.display import display

    return display({"text/plain": ""}, raw=True, display_id=True)


class Progress:
    """One line that tells how far the run is, kept up to date; `wanted`: `None` shows it in terminals and notebooks only."""

    def __init__(self, wanted=None):
        self._handle = _notebook() if wanted is not False else None
        self._terminal = self._handle is None and (wanted or (wanted is None and sys.stderr.isatty()))
        self._end, self._time, self._steps = 0.0, 0.0, None
        self._step = 0

    def stage(self, _stage, _stages, _start, end, steps):
        """A stage is ready."""
        self._end, self._steps = end, steps

    def begin(self, step, time, _length):
        """A step begins."""
        self._step, self._time = step, time
        self._show("")

    def iteration(self, record):
        """An iteration is done."""
        record = json.loads(record)
        changes = record["active_set_changes"] + record["stick_slip_changes"]
        changed = f", {changes} nodes change their state" if changes else ""
        self._show(f"iteration {record['iteration']}: {worst_ratio(record):.1e} of the tolerance{changed}")

    def note(self, text):
        """A line that stays."""
        if self._terminal:
            print(f"\r\x1b[K{text}", file=sys.stderr)

    def close(self):
        """The run is over."""
        if self._terminal and self._step:
            print(file=sys.stderr)

    def _show(self, what):
        of = f"/{self._steps}" if self._steps else ""
        line = f"step {self._step}{of}, time {self._time:g} of {self._end:g}  {what}".rstrip()
        if self._handle:
            self._handle.update({"text/plain": line}, raw=True)
        elif self._terminal:
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)
