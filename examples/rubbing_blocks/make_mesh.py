#!/usr/bin/env python3
"""Writes blocks.mdpa: two blocks on each other, finer towards the face where they rub."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from grids import Grid, steps

grid = Grid()
heights = [0.004 * (1.25**i - 1.0) / 0.25 for i in range(19)]
heights = [height / heights[-1] for height in heights]
lower = grid.rectangle("Lower", steps(0.0, 1.0, 6), [-height for height in reversed(heights)])
upper = grid.rectangle("Upper", steps(0.0, 1.0, 6), heights)
grid.part("Slave", upper["bottom"])
grid.part("Interface", lower["top"], upper["bottom"])
grid.part("Top", upper["top"])
for name, side in (("Above", upper["bottom"]), ("Below", lower["top"])):
    grid.probe(name, next(node for node in side[0] if grid.nodes[node - 1][0] == 0.5))
grid.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "blocks.mdpa"), "SmallDisplacementElement2D4N", {*upper["top"][1]})
