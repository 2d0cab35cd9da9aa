"""`python -m zelus MainKratos.py` runs a program written for Kratos; `python -m zelus ProjectParameters.json` a deck."""

from __future__ import annotations

import argparse
import os
import runpy
import sys

from . import kratos
from .errors import InputError, NotConvergedError, ZelusError
from .running import run


def main(arguments=None):
    """Runs the file that the arguments name; gives the exit code."""
    parser = argparse.ArgumentParser(prog="python -m zelus", description=__doc__)
    parser.add_argument("--like", help="take the defaults of this program where the deck names nothing: kratos")
    parser.add_argument("file", help="a program in Python that imports KratosMultiphysics, or a deck")
    parser.add_argument("rest", nargs=argparse.REMAINDER, help="arguments of the program")
    chosen = parser.parse_args(arguments)
    try:
        if not chosen.file.endswith(".py"):
            print(run(chosen.file, like=chosen.like))
            return 0
        kratos.install(like=chosen.like)
        sys.argv = [chosen.file, *chosen.rest]
        sys.path.insert(0, os.path.dirname(os.path.abspath(chosen.file)))
        runpy.run_path(chosen.file, run_name="__main__")
    except ZelusError as error:
        print(error, file=sys.stderr)
        return {InputError: 2, NotConvergedError: 3}.get(type(error), 4)
    return 0


if __name__ == "__main__":
    sys.exit(main())
