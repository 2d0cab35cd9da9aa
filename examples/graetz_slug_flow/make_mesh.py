#!/usr/bin/env python3
"""Writes channel.mdpa: half a channel from its axis at y = 0 to its wall at y = 0.5."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
sides = grid.rectangle("Channel", steps(0.0, 4.0, 160), steps(0.0, 0.5, 16))
grid.part("Wall", sides["top"])
corner, *inlet = sides["left"][0]
grid.part("Inlet", (inlet, ()))
for name, x in (("One", 1.0), ("Two", 2.0)):
    grid.probe(name, next(node for node in sides["bottom"][0] if grid.nodes[node - 1][0] == x))
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "channel.mdpa"), "Element2D4N")
