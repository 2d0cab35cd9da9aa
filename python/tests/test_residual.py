"""Conditions and laws in Python."""

import json

import numpy as np
import pytest

import zelus

MESH = """Begin Properties 0
End Properties
Begin Nodes
{nodes}
End Nodes
Begin Elements SmallDisplacementElement2D4N
{elements}
End Elements
Begin Conditions LineCondition2D2N
{conditions}
End Conditions
Begin SubModelPart Bottom
  Begin SubModelPartNodes
{bottom}
  End SubModelPartNodes
  Begin SubModelPartConditions
{ids}
  End SubModelPartConditions
End SubModelPart
Begin SubModelPart Top
  Begin SubModelPartNodes
{top}
  End SubModelPartNodes
End SubModelPart
"""


def block(folder, unit=1.0):
    """A block of 4 by 2 elements, 2 by 1 units, on its bottom edge, which nothing holds; its deck."""
    at = lambda i, j: 1 + i + 5 * j
    nodes = [f"{at(i, j)} {0.5 * unit * i} {0.5 * unit * j} 0" for j in range(3) for i in range(5)]
    elements = [
        f"{1 + i + 4 * j} 0 {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}" for j in range(2) for i in range(4)
    ]
    conditions = [f"{i + 1} 0 {at(i, 0)} {at(i + 1, 0)}" for i in range(4)]
    lines = {"nodes": nodes, "elements": elements, "conditions": conditions}
    lines |= {"bottom": [str(at(i, 0)) for i in range(5)], "ids": [str(i + 1) for i in range(4)]}
    lines |= {"top": [str(at(i, 2)) for i in range(5)]}
    (folder / "block.mdpa").write_text(MESH.format(**{key: "\n".join(own) for key, own in lines.items()}))
    law = {"name": "LinearElasticPlaneStrain2DLaw"}
    material = {"constitutive_law": law, "Variables": {"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.0, "THICKNESS": 1.0}}
    materials = {"properties": [{"model_part_name": "Structure", "properties_id": 0, "Material": material}]}
    (folder / "materials.json").write_text(json.dumps(materials))
    deck = {
        "problem_data": {"problem_name": "block", "start_time": 0.0, "end_time": 1.0, "parallel_type": "OpenMP", "echo_level": 0},
        "solver_settings": {
            "solver_type": "Static",
            "analysis_type": "non_linear",
            "model_part_name": "Structure",
            "domain_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "block"},
            "material_import_settings": {"materials_filename": "materials.json"},
            "time_stepping": {"time_step": 0.5},
            "displacement_relative_tolerance": 1e-10,
            "residual_relative_tolerance": 1e-10,
        },
        "processes": {
            "held": [
                {
                    "python_module": "assign_vector_variable_process",
                    "Parameters": {
                        "model_part_name": "Structure",
                        "variable_name": "DISPLACEMENT",
                        "constrained": [True, False, False],
                        "value": [0.0, None, None],
                    },
                }
            ],
            "pressed": [
                {
                    "python_module": "assign_vector_variable_process",
                    "Parameters": {
                        "model_part_name": "Structure.Top",
                        "variable_name": "DISPLACEMENT",
                        "constrained": [False, True, False],
                        "value": [None, "-0.01*t", None],
                    },
                }
            ],
        },
    }
    (folder / "deck.json").write_text(json.dumps(deck))
    return folder / "deck.json"


def resting_on(name, **more):
    own = {"python_module": name, "Parameters": {"model_part_name": "Structure.Bottom", **more}}
    return {"processes.residuals": [own]}


def bed(own, law):
    """Line forces law(u) over the length of two-noded lines, by two Gauss points, against the vertical displacement."""
    force = np.zeros_like(own.u)
    for place in (-1, 1):
        shape = np.array([0.5 - place / np.sqrt(12), 0.5 + place / np.sqrt(12)])
        u = own.u[:, :, 0] @ shape
        force[:, :, 0] += (0.5 * own.size() * law(u))[:, None] * shape
    return force


def test_a_bed_of_springs_is_in_series_with_the_block(tmp_path):
    @zelus.residual("winkler_bed", ["DISPLACEMENT_Y"])
    def winkler(own):
        return bed(own, lambda u: -own.parameters["stiffness"].GetDouble() * u)

    result = zelus.run(block(tmp_path), set=resting_on("winkler_bed", stiffness=500.0))
    # a column of 1000 per length 1 on springs of 500 per area: the bottom takes two thirds of what the top goes down
    assert np.allclose(result.of_part("Bottom", "DISPLACEMENT")[:, 1], -0.01 * 2 / 3, rtol=1e-9)
    assert np.isclose(-result.of_part("Top", "REACTION")[:, 1].sum(), 2 * 0.01 * 1000 * 500 / 1500, rtol=1e-9)


def test_differences_are_as_good_as_a_tangent_in_every_unit(tmp_path):
    def law(u, scale):
        return -5.0 / scale * (u + 40 * u**3 / scale**2)

    def run(name, unit):
        folder = tmp_path / f"{name}_{unit}"
        folder.mkdir()
        changes = resting_on(name, scale=0.01 * unit)
        changes["processes.pressed.0.Parameters.value"] = [None, f"{-0.01 * unit}*t", None]
        return zelus.run(block(folder, unit), set=changes)

    @zelus.residual("hardening_bed", ["DISPLACEMENT_Y"])
    def hardening(own):
        return bed(own, lambda u: law(u, own.parameters["scale"].GetDouble()))

    def tangent(own):
        scale = own.parameters["scale"].GetDouble()
        out = np.zeros((len(own.u), 2, 2))
        for place in (-1, 1):
            shape = np.array([0.5 - place / np.sqrt(12), 0.5 + place / np.sqrt(12)])
            u = own.u[:, :, 0] @ shape
            slope = 5.0 / scale * (1 + 120 * u**2 / scale**2)
            out += (0.5 * own.size() * slope)[:, None, None] * np.outer(shape, shape)
        return out

    zelus.residual("hardening_bed_with_tangent", ["DISPLACEMENT_Y"], tangent=tangent, symmetric=True)(hardening)
    exact = run("hardening_bed_with_tangent", 1.0)
    for unit in (1.0, 1e3, 1e-3):
        by_differences = run("hardening_bed", unit)
        assert np.allclose(by_differences["DISPLACEMENT"] / unit, exact["DISPLACEMENT"], rtol=1e-7, atol=1e-12)
        assert (by_differences.iterations == exact.iterations).all()
    assert exact.iterations.min() > 1


def test_springs_at_nodes(tmp_path):
    @zelus.residual("nodal_springs", ["DISPLACEMENT_Y"], entities="nodes")
    def springs(own):
        return -own.parameters["stiffness"].GetDouble() * own.u

    result = zelus.run(block(tmp_path), set=resting_on("nodal_springs", stiffness=100.0))
    forces = -100.0 * result.of_part("Bottom", "DISPLACEMENT")[:, 1]
    assert np.isclose(forces.sum(), -result.of_part("Top", "REACTION")[:, 1].sum(), rtol=1e-9)


def test_what_is_wrong_with_a_residual_is_said(tmp_path):
    deck = block(tmp_path)
    zelus.residual("of_rotations", ["ROTATION_Z"])(lambda own: -own.u)
    with pytest.raises(zelus.InputError, match="ROTATION_Z is no unknown at node"):
        zelus.run(deck, set=resting_on("of_rotations"))
    zelus.residual("of_elements", ["DISPLACEMENT_Y"], entities="elements")(lambda own: -own.u)
    with pytest.raises(zelus.InputError, match="has no elements"):
        zelus.run(deck, set=resting_on("of_elements"))
    zelus.residual("wrong_shape", ["DISPLACEMENT_Y"])(lambda own: own.u[0])
    with pytest.raises(ValueError, match="should have that of u"):
        zelus.run(deck, set=resting_on("wrong_shape"))
    zelus.residual("failing_residual", ["DISPLACEMENT_Y"])(lambda own: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        zelus.run(deck, set=resting_on("failing_residual"))
    zelus.residual("not_a_number", ["DISPLACEMENT_Y"])(lambda own: own.u + np.nan)
    with pytest.raises(zelus.ZelusError, match="not finite"):
        zelus.run(deck, set=resting_on("not_a_number"))
