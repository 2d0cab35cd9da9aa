"""Helpers of the cases of the atlas: meshes, decks, runs, pictures. Meshes and deck files come from the cases of the tests."""
import os, sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "cases"))
