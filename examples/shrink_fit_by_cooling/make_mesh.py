#!/usr/bin/env python3
"""Writes rings.mdpa: a quarter of two rings that touch, of the radii 20, 50 and 80."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

from math import cos, pi, sin

grid = Grid()
quarter = lambda r, angle: (r * cos(angle), r * sin(angle))
rings = {}
for name, low, high, across in (("Shaft", 20.0, 50.0, 12), ("Hub", 50.0, 80.0, 10)):
    rings[name] = grid.rectangle(name, [low * (high / low) ** s for s in steps(0.0, 1.0, across)], steps(0.0, pi / 2, 60), quarter)
shaft, hub = rings["Shaft"], rings["Hub"]
grid.part("Slave", shaft["right"])
grid.part("Interface", shaft["right"], hub["left"])
grid.part("SymmetryX", shaft["top"], hub["top"])
grid.part("SymmetryY", shaft["bottom"], hub["bottom"])
grid.part("Rim", hub["right"])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "rings.mdpa"), "SmallDisplacementElement2D4N")
