#!/usr/bin/env python3
"""Writes rubbed_bar.mdpa: a bar on a plate."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
plate = grid.rectangle("Plate", steps(-0.5, 1.5, 4), [-0.5, 0.0])
bar = grid.rectangle("Bar", [0.0, 1.0], steps(0.0, 1.0, 24))
grid.part("Slave", bar["bottom"])
grid.part("Interface", plate["top"], bar["bottom"])
grid.part("Top", bar["top"])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "rubbed_bar.mdpa"), "SmallDisplacementElement2D4N")
