#!/usr/bin/env python3
"""Writes disc.mdpa: a quarter section of a disc and of the ring that is pressed on it, about the y axis."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

RADII = (1.0, 2.0)
# Fine where heat enters: heights from the interface on grow by a tenth from row to row.
HEIGHTS = [0.0]
while HEIGHTS[-1] < 0.25:
    HEIGHTS.append(HEIGHTS[-1] + 0.004 * 1.1 ** (len(HEIGHTS) - 1))

grid = Grid()
disc = grid.rectangle("Disc", steps(*RADII, 10), [-height for height in reversed(HEIGHTS)])
ring = grid.rectangle("Ring", steps(*RADII, 10), HEIGHTS)
grid.part("Slave", ring["bottom"])
grid.part("Interface", disc["top"], ring["bottom"])
grid.part("Foot", disc["bottom"])
grid.part("Top", ring["top"])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "disc.mdpa"), "AxisymSmallDisplacementElement2D4N",
           {*ring["top"][1]}, "AxisymLineLoadCondition2D2N")
