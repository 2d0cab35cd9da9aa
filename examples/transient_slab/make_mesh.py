#!/usr/bin/env python3
"""Writes slab.mdpa: half a slab from its middle at x = 0 to its face at x = 1."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
sides = grid.rectangle("Slab", steps(0.0, 1.0, 24), [0.0, 0.1])
grid.part("Face", sides["right"])
grid.part("Middle", sides["left"])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "slab.mdpa"), "Element2D4N")
