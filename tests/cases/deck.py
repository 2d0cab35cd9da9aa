"""Writes a case: mesh, materials, ProjectParameters.json and case.json, in one folder."""
import json, os

HERE = os.path.dirname(os.path.abspath(__file__))
KRATOS = "KratosMultiphysics"
CONTACT = KRATOS + ".ContactStructuralMechanicsApplication"
LAWS = {"3d": "LinearElastic3DLaw", "strain": "LinearElasticPlaneStrain2DLaw", "stress": "LinearElasticPlaneStress2DLaw",
        "j2": "SmallStrainJ2Plasticity3DLaw"}


def pretty(value, indent=0, width=118):
    """JSON with everything that fits on a line on one line."""
    flat = json.dumps(value)
    if len(flat) + indent <= width or not isinstance(value, (dict, list)) or not value:
        return flat
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        rows = [f"{pad}{json.dumps(k)}: {pretty(v, indent + 2, width)}" for k, v in value.items()]
        return "{\n" + ",\n".join(rows) + "\n" + " " * indent + "}"
    return "[\n" + ",\n".join(pad + pretty(v, indent + 2, width) for v in value) + "\n" + " " * indent + "]"


def process(module, parameters, where=KRATOS):
    return {"python_module": module, "kratos_module": where, "Parameters": parameters}


def fix(part, x=None, y=None, z=None):
    """Prescribes the components that are not None: a number or an expression each."""
    return process("assign_vector_variable_process", {
        "model_part_name": "Structure." + part, "variable_name": "DISPLACEMENT",
        "constrained": [v is not None for v in (x, y, z)], "value": [x, y, z], "interval": [0.0, "End"]})


def condition_load(part, variable, modulus, direction, interval=(0.0, "End")):
    """A traction on conditions: modulus (number or expression) times the unit vector of `direction`."""
    return process("assign_vector_by_direction_to_condition_process", {
        "model_part_name": "Structure." + part, "variable_name": variable, "modulus": modulus,
        "direction": list(direction), "interval": list(interval)})


def condition_pressure(part, variable, value, interval=(0.0, "End")):
    """A pressure on conditions."""
    return process("assign_scalar_variable_to_conditions_process", {
        "model_part_name": "Structure." + part, "variable_name": variable, "value": value, "interval": list(interval)})


def nodal_load(part, variable, modulus, direction):
    """A load at nodes, free (not a degree of freedom)."""
    return process("assign_vector_by_direction_process", {
        "model_part_name": "Structure." + part, "variable_name": variable, "constrained": False,
        "modulus": modulus, "direction": list(direction), "interval": [0.0, "End"]})


def nodal_scalar(part, variable, value):
    """A scalar load at nodes, free (not a degree of freedom): number, expression or csv table."""
    return process("assign_scalar_variable_process", {
        "model_part_name": "Structure." + part, "variable_name": variable, "constrained": False, "value": value,
        "interval": [0.0, "End"]})


def json_output(file, variables, part="", gauss=(), historical=True):
    return process("json_output_process", {
        "output_file_name": file, "model_part_name": "Structure" + ("." + part if part else ""),
        "output_variables": list(variables), **({"gauss_points_output_variables": list(gauss)} if gauss else {}),
        **({} if historical else {"historical_value": False}), "time_frequency": 0.0})


def material(part, number, law, young, poisson, **more):
    return {"model_part_name": "Structure." + part, "properties_id": number, "Material": {
        "constitutive_law": {"name": LAWS[law]},
        "Variables": {"YOUNG_MODULUS": young, "POISSON_RATIO": poisson, **more}, "Tables": {}}}


def solver(dim, mesh_name, time_step=1.0, **more):
    """Solver settings: static Newton with a tight residual."""
    return {
        "solver_type": "Static", "model_part_name": "Structure", "domain_size": dim, "echo_level": 0,
        "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "mdpa", "input_filename": mesh_name},
        "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
        "time_stepping": {"time_step": time_step},
        "convergence_criterion": "residual_criterion",
        "residual_relative_tolerance": 1e-9, "residual_absolute_tolerance": 1e-6, "max_iteration": 10, **more}


def contact_solver(dim, mesh_name, time_step=1.0, mortar="ALMContactFrictionless", **more):
    """Solver settings of a contact deck; `more` may replace any of them."""
    base = solver(dim, mesh_name, time_step)
    base["contact_settings"] = {
        "mortar_type": mortar, "contact_residual_relative_tolerance": 1e-9, "contact_residual_absolute_tolerance": 1e-6}
    base.update({"convergence_criterion": "contact_residual_criterion", "max_iteration": 20})
    for key, value in more.items():
        base[key] = {**base[key], **value} if isinstance(value, dict) and isinstance(base.get(key), dict) else value
    return base


def contact_process(pairs, kind="Frictionless", method="alm", **more):
    """The contact process; `pairs` is a list of (contact part, slave part), [] for skin detection."""
    return process(method + "_contact_process", {
        "model_part_name": "Structure", "contact_type": kind,
        **({"contact_model_part": {str(i): [c] for i, (c, _) in enumerate(pairs)},
            "assume_master_slave": {str(i): [s] for i, (_, s) in enumerate(pairs)}} if pairs else {}), **more}, CONTACT)


def parameters(name, solver_settings, constraints, loads=(), contact=(), outputs=(), end_time=1.0):
    """A whole ProjectParameters.json; the loop runs while time < end_time, so the last step is at end_time."""
    return {
        "problem_data": {"problem_name": name, "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                         "end_time": end_time - 0.5 * min(1.0, solver_settings["time_stepping"]["time_step"])},
        "solver_settings": solver_settings,
        "processes": {"constraints_process_list": list(constraints), "loads_process_list": list(loads),
                      **({"contact_process_list": list(contact)} if contact else {}),
                      "json_output_process_list": list(outputs)}}


def stages(decks):
    """Decks by name as stages in sequence on one model, each a second long; the first reads the mesh."""
    out = {}
    for number, (name, deck) in enumerate(decks.items()):
        if number:
            deck["solver_settings"]["model_import_settings"] = {"input_type": "use_input_model_part"}
            deck["solver_settings"]["material_import_settings"] = {"materials_filename": ""}
        deck["problem_data"].update(start_time=float(number), end_time=number + 0.6)
        where = KRATOS + ".StructuralMechanicsApplication.structural_mechanics_analysis"
        out[name] = {"stage_preprocess": {}, "stage_settings": {"analysis_stage": where, **deck}, "stage_postprocess": {}}
    return {"orchestrator": {"name": "Orchestrators.KratosMultiphysics.SequentialOrchestrator", "settings": {
        "echo_level": 0, "execution_list": list(decks), "load_from_checkpoint": None, "stage_checkpoints": False}},
        "stages": out}


def check(quantity, tolerance, results="results.json", **expected):
    """One comparison of case.json: `affine` [c, cx, cy, cz] of the initial coordinates, or `value`."""
    return {"quantity": quantity, "results": results, **expected, "tolerance": float(f"{tolerance:.3g}")}


def affine_checks(fields, relative, **more):
    """Checks of displacement components given as affine functions; tolerance relative to the largest coefficient."""
    scale = max(abs(c) for field in fields for c in field)
    return [check("DISPLACEMENT_" + axis, relative * scale, affine=list(field), **more) for axis, field in zip("XYZ", fields)]


def write_case(folder, requirement, why, project, materials, mesh, checks, reference="ANALYTIC", extra=None):
    """Writes the case; `extra` maps further file names to their text."""
    path = os.path.join(HERE, folder)
    os.makedirs(path, exist_ok=True)

    def put(name, text):
        with open(os.path.join(path, name), "w") as file:
            file.write(text)
    put("case.json", pretty({"requirement": requirement, "reference": reference, "why": why, "checks": checks}) + "\n")
    put("ProjectParameters.json", pretty(project) + "\n")
    if materials:
        put("StructuralMaterials.json", pretty({"properties": materials}) + "\n")
    put("mesh.mdpa", mesh.text())
    for name, text in (extra or {}).items():
        put(name, text)


def oedometer(young, poisson):
    """Stiffness of a laterally confined bar."""
    return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
