#!/usr/bin/env python3
"""Writes pin.mdpa: a pin with a crowned end on a plate."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
crown = lambda x, y: (x, y + (1.0 - y) * 4e-3 * (x - 0.5) ** 2)
plate = grid.rectangle("Plate", steps(-1.0, 4.0, 9), [-0.5, 0.0])
pin = grid.rectangle("Pin", steps(0.0, 1.0, 10), steps(0.0, 1.0, 5), crown)
grid.part("Slave", pin["bottom"])
grid.part("Interface", plate["top"], pin["bottom"])
grid.part("Top", pin["top"])
grid.probe("Middle", next(node for node in pin["bottom"][0] if grid.nodes[node - 1][0] == 0.5))
grid.probe("Corner", pin["bottom"][0][0])
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "pin.mdpa"), "SmallDisplacementElement2D4N", {*pin["top"][1]})
