#!/usr/bin/env python3
"""Writes rod.mdpa: a rod from x = 0 to 1, and a wall 7.5e-5 before its end."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
rod = grid.rectangle("Rod", steps(0.0, 1.0, 10), steps(0.0, 0.2, 2))
wall = grid.rectangle("Wall", [1.000075, 1.100075, 1.200075], steps(0.0, 0.2, 3))
grid.part("HotEnd", rod["left"])
grid.part("Slave", rod["right"])
grid.part("Interface", rod["right"], wall["left"])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "rod.mdpa"), "SmallDisplacementElement2D4N")
