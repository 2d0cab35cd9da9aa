"""Constitutive laws in Python."""

import json

import numpy as np
import pytest
from test_residual import block

import zelus


def elasticity(points):
    """Plane strain, with modulus and ratio of Poisson as parameters."""
    young, poisson = points.parameters
    shear, first = young / 2 / (1 + poisson), young * poisson / (1 + poisson) / (1 - 2 * poisson)
    matrix = np.diag([2 * shear, 2 * shear, 2 * shear, shear])
    matrix[:3, :3] += first
    return points.strain @ matrix, np.broadcast_to(matrix, (len(points.strain), 4, 4))


def made_of(name, parameters, states=()):
    """Writes the block's material anew: a law by a function."""

    def write(folder):
        variables = {"LAW_FUNCTION": name, "LAW_PARAMETERS": list(parameters), "STATE_VARIABLES": list(states), "THICKNESS": 1.0}
        material = {"constitutive_law": {"name": "FunctionLaw2DPlaneStrain"}, "Variables": variables}
        materials = {"properties": [{"model_part_name": "Structure", "properties_id": 0, "Material": material}]}
        (folder / "materials.json").write_text(json.dumps(materials))

    return write


def run(folder, material=None, **changes):
    folder.mkdir()
    deck = block(folder)
    if material is not None:
        material(folder)
    # the sides are free, the top slides: Poisson's ratio matters
    free = {"processes.held.0.Parameters.model_part_name": "Structure.Bottom", "processes.held.0.Parameters.constrained": [True, True, False]}
    free["processes.held.0.Parameters.value"] = [0.0, 0.0, None]
    return zelus.run(deck, set=free | changes)


def test_a_function_is_as_good_as_the_law_of_the_program(tmp_path):
    counts = []

    @zelus.law("plane_elasticity")
    def of_points(points):
        counts.append(len(points.strain))
        return elasticity(points)

    def built_in(folder):
        path = folder / "materials.json"
        path.write_text(path.read_text().replace('"POISSON_RATIO": 0.0', '"POISSON_RATIO": 0.3'))

    expected = run(tmp_path / "built_in", built_in)["DISPLACEMENT"]
    found = run(tmp_path / "function", made_of("plane_elasticity", [1000.0, 0.3]))["DISPLACEMENT"]
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()
    assert np.abs(expected[:, 0]).max() > 1e-4
    # eight elements of four points are one call
    assert max(counts) == 32

    zelus.law("plane_elasticity_without_tangent", lambda points: elasticity(points)[0])
    found = run(tmp_path / "differences", made_of("plane_elasticity_without_tangent", [1000.0, 0.3]))["DISPLACEMENT"]
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


@zelus.law("yielding_columns")
def yielding_columns(points):
    """Columns across the plane that yield at a stress, perfectly; the state is their plastic strain."""
    young, limit = points.parameters
    matrix = np.diag([young, young, young, 0.5 * young])
    tangent = np.tile(matrix, (len(points.strain), 1, 1))
    plastic = points.state.copy()
    trial = young * (points.strain[:, 1] - plastic[:, 0])
    over = np.abs(trial) > limit
    plastic[over, 0] = points.strain[over, 1] - np.sign(trial[over]) * limit / young
    stress = points.strain @ matrix
    stress[:, 1] = young * (points.strain[:, 1] - plastic[:, 0])
    # a hundredth keeps the stiffness regular
    tangent[over, 1, 1] = 0.01 * young
    return stress, tangent, plastic


def test_states_last_from_step_to_step(tmp_path):
    # pressed by 0.01 to yielding at 4, and back to 0.005: -1000 (-0.005 - p) with p = -0.006 is tension of 1
    changes = {"problem_data.end_time": 2.0}
    changes["processes.pressed.0.Parameters.value"] = [None, "-0.005*(t+1-abs(t-1))+0.0025*(t-1+abs(t-1))", None]
    result = run(tmp_path / "columns", made_of("yielding_columns", [1000.0, 4.0], [0.0]), **changes)
    assert result.converged
    # forces on a width of 2
    assert np.isclose(result.of_part("Top", "REACTION")[:, 1].sum(), 2.0, rtol=1e-6)


def test_mistakes_are_told_before_the_run(tmp_path):
    with pytest.raises(zelus.InputError, match="nowhere"):
        run(tmp_path / "unknown", made_of("nowhere", []))
    zelus.law("wrong_shape", lambda points: points.strain[:, :2])
    with pytest.raises(zelus.InputError, match="the stress has the shape"):
        run(tmp_path / "shape", made_of("wrong_shape", []))

    @zelus.law("wrong_tangent")
    def wrong_tangent(points):
        stress, tangent = elasticity(points)
        return stress, 1.5 * tangent

    with pytest.warns(zelus.ZelusWarning, match="the tangent of the function"):
        run(tmp_path / "tangent", made_of("wrong_tangent", [1000.0, 0.3]))


def test_what_goes_wrong_in_a_function_is_said(tmp_path):
    @zelus.law("brittle")
    def brittle(points):
        if points.strain[:, 1].min() < -0.004:
            raise ValueError("it has broken")
        return elasticity(points)

    with pytest.raises(zelus.ZelusError, match="it has broken"):
        run(tmp_path / "brittle", made_of("brittle", [1000.0, 0.3]))
