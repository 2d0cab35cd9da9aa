//! The bad decks: the change of the good one, and the words of the message.

/// One change of the good deck.
pub enum Change {
    /// Removes a file.
    Remove(&'static str),
    /// Replaces the first occurrence of a text, which must be there.
    Replace(&'static str, &'static str, &'static str),
    /// Ends a file right before a text.
    CutAt(&'static str, &'static str),
}
use Change::{CutAt, Remove, Replace};

/// A bad deck: its name, how it comes from the good one, and words its message must hold.
pub struct BadDeck(pub &'static str, pub Change, pub &'static [&'static str]);

const DECK: &str = "ProjectParameters.json";
const MESH: &str = "mesh.mdpa";
const MATERIALS: &str = "StructuralMaterials.json";

/// A change of the project parameters.
const fn deck(name: &'static str, find: &'static str, with: &'static str, says: &'static [&'static str]) -> BadDeck {
    BadDeck(name, Replace(DECK, find, with), says)
}

/// A change of the mesh.
const fn mesh(name: &'static str, find: &'static str, with: &'static str, says: &'static [&'static str]) -> BadDeck {
    BadDeck(name, Replace(MESH, find, with), says)
}

/// A change of the materials.
const fn materials(
    name: &'static str,
    find: &'static str,
    with: &'static str,
    says: &'static [&'static str],
) -> BadDeck {
    BadDeck(name, Replace(MATERIALS, find, with), says)
}

/// All of them.
pub const BAD_DECKS: &[BadDeck] = &[
    // files
    BadDeck("project file missing", Remove(DECK), &[DECK]),
    BadDeck("mesh file missing", Remove(MESH), &[MESH]),
    BadDeck("materials file missing", Remove(MATERIALS), &[MATERIALS]),
    BadDeck("table file missing", Remove("pressure.csv"), &["pressure.csv"]),
    BadDeck("table with a word", Replace("pressure.csv", "1.0e5", "much"), &["pressure.csv", "much"]),
    // JSON
    deck("trailing comma", "\"end_time\": 1.0", "\"end_time\": 1.0,", &[DECK]),
    BadDeck("missing brace", CutAt(DECK, "\"output_processes\""), &[DECK]),
    deck("half a number", "\"time_step\": 1.0", "\"time_step\": 1.e", &["ProjectParameters.json:18"]),
    deck("missing quote", "\"two_blocks\"", "\"two_blocks", &[DECK]),
    materials("trailing comma in materials", "\"Tables\": {}", "\"Tables\": {},", &[MATERIALS]),
    // types and ranges
    deck(
        "word for a number",
        "\"max_iteration\": 10",
        "\"max_iteration\": \"ten\"",
        &["max_iteration", "ProjectParameters.json:21"],
    ),
    deck("number for a truth value", "\"compute_reactions\": true", "\"compute_reactions\": 1", &["compute_reactions"]),
    deck("list for an object", "{\"time_step\": 1.0}", "[1.0]", &["time_stepping"]),
    deck(
        "word for a list",
        "[\"DISPLACEMENT\"],\n          \"gauss",
        "\"DISPLACEMENT\",\n          \"gauss",
        &["output_variables"],
    ),
    deck("negative time step", "\"time_step\": 1.0", "\"time_step\": -1.0", &["time_step", "-1"]),
    deck("zero time step", "\"time_step\": 1.0", "\"time_step\": 0.0", &["time_step"]),
    deck("end before start", "\"end_time\": 1.0", "\"end_time\": -1.0", &["end_time"]),
    deck("four dimensions", "\"domain_size\": 2", "\"domain_size\": 4", &["domain_size", "4"]),
    deck("no iteration allowed", "\"max_iteration\": 10", "\"max_iteration\": 0", &["max_iteration"]),
    deck("negative penalty", "\"stiffness_factor\": 1.0", "\"stiffness_factor\": -1.0", &["stiffness_factor"]),
    deck("negative search factor", "\"search_factor\": 3.5", "\"search_factor\": -3.5", &["search_factor"]),
    deck("two components", "[null, 0.0, null]", "[null, 0.0]", &["value"]),
    deck("direction zero", "[0.0, -1.0, 0.0]", "[0.0, 0.0, 0.0]", &["direction"]),
    // missing keys
    deck("no problem data", "\"problem_data\"", "\"problem_dat\"", &["problem_data"]),
    deck("no solver settings", "\"solver_settings\"", "\"solver_setings\"", &["solver_settings"]),
    deck("no domain size", "    \"domain_size\": 2,\n", "", &["domain_size"]),
    deck("no time stepping", "    \"time_stepping\": {\"time_step\": 1.0},\n", "", &["time_stepping"]),
    deck("no time step", "{\"time_step\": 1.0}", "{}", &["time_step"]),
    deck("no end time", ",\n    \"end_time\": 1.0", "", &["end_time"]),
    deck("no value", ",\n          \"value\": [\"0.0*t\", null, null]", "", &["value"]),
    deck("no module", "\"python_module\": \"json_output_process\",\n", "", &["python_module"]),
    // unknown names
    deck("unknown solver type", "\"Static\"", "\"Sttic\"", &["Sttic", "Static"]),
    deck("unknown analysis type", "\"non_linear\"", "\"nonlinear\"", &["nonlinear", "non_linear"]),
    deck(
        "unknown criterion",
        "contact_residual_criterion",
        "contact_residul_criterion",
        &["contact_residual_criterion"],
    ),
    deck(
        "unknown linear solver",
        "skyline_lu_factorization",
        "skyline_lu_factorisation",
        &["skyline_lu_factorization"],
    ),
    deck(
        "unknown process",
        "\"assign_vector_variable_process\"",
        "\"assign_vector_variabl_process\"",
        &["assign_vector_variable_process"],
    ),
    deck("unknown output process", "\"vtk_output_process\"", "\"vkt_output_process\"", &["vtk_output_process"]),
    deck("unknown mortar type", "\"ALMContactFrictionless\"", "\"ALMContactFrictionles\"", &["ALMContactFrictionless"]),
    deck("unknown contact type", "\"Frictionless\"", "\"Frictionles\"", &["Frictionles", "ALMContactFrictionless"]),
    deck("unknown normal variation", "no_derivatives_computation", "no_derivative", &["normal_variation"]),
    deck("unknown search", "in_radius_with_obb", "in_radius_with_ob", &["in_radius_with_obb"]),
    deck(
        "unknown variable",
        "\"variable_name\": \"DISPLACEMENT\"",
        "\"variable_name\": \"DISPLACMENT\"",
        &["DISPLACMENT", "DISPLACEMENT"],
    ),
    deck(
        "unknown output variable",
        "[\"DISPLACEMENT\"],\n          \"gauss",
        "[\"DISPLACMENT\"],\n          \"gauss",
        &["DISPLACMENT"],
    ),
    deck("unknown stress", "VON_MISES_STRESS", "VON_MISSES_STRESS", &["VON_MISSES_STRESS", "VON_MISES_STRESS"]),
    deck(
        "unknown output control",
        "\"output_control_type\": \"step\"",
        "\"output_control_type\": \"stp\"",
        &["output_control_type", "step"],
    ),
    deck("unknown model part", "Structure.Bottom", "Structure.Botom", &["Structure.Botom", "Bottom"]),
    deck("unknown root", "Structure.Bottom", "Strcture.Bottom", &["Strcture", "Structure"]),
    deck("unknown contact part", "[\"Interface\"]", "[\"Interfac\"]", &["Interfac", "Interface"]),
    deck("unknown import type", "\"input_type\": \"mdpa\"", "\"input_type\": \"mpda\"", &["input_type", "mdpa"]),
    // unknown keys
    deck("unknown process key", "\"constrained\"", "\"constraind\"", &["constraind", "constrained"]),
    deck(
        "unknown contact key",
        "\"normal_variation\"",
        "\"normal_variatio\"",
        &["normal_variatio", "normal_variation"],
    ),
    deck("unknown search key", "\"search_factor\"", "\"search_facto\"", &["search_facto", "search_factor"]),
    deck("unknown output key", "\"output_interval\"", "\"output_intervall\"", &["output_intervall", "output_interval"]),
    // things that do not go together
    deck("friction without multipliers", "\"Frictionless\"", "\"Frictional\"", &["Frictional", "mortar_type"]),
    deck("contact without its solver", "{\"mortar_type\": \"ALMContactFrictionless\"}", "{}", &["mortar_type"]),
    deck(
        "scalar for a vector process",
        "\"variable_name\": \"DISPLACEMENT\"",
        "\"variable_name\": \"NEGATIVE_FACE_PRESSURE\"",
        &["NEGATIVE_FACE_PRESSURE"],
    ),
    deck(
        "unknown modeler",
        "\"problem_data\"",
        "\"modelers\": [{\"name\": \"Modelers.KratosMultiphysics.CombineModelPartModeler\", \"parameters\": {}}],\n  \"problem_data\"",
        &["CombineModelPartModeler"],
    ),
    deck("plane deck in space", "\"domain_size\": 2", "\"domain_size\": 3", &["domain_size"]),
    // expressions and intervals
    deck("half an expression", "1.0e6*t", "1.0e6*", &["1.0e6*"]),
    deck("unknown name in an expression", "1.0e6*t", "1.0e6*q", &["q"]),
    deck("unclosed bracket in an expression", "1.0e6*t", "1.0e6*(t", &["1.0e6*(t"]),
    deck("interval from Begin", "[0.0, \"End\"]", "[\"Begin\", \"End\"]", &["interval", "Begin"]),
    deck("interval with one end", "[0.0, \"End\"]", "[0.0]", &["interval"]),
    // mesh: form
    BadDeck("mesh cut off in the elements", CutAt(MESH, "3 0 7 8 9 10"), &[MESH, "Elements"]),
    BadDeck(
        "mesh cut off in a sub part",
        CutAt(MESH, "  End SubModelPartConditions\nEnd SubModelPart\n\nBegin SubModelPart Upper"),
        &[MESH, "SubModelPart"],
    ),
    mesh("unknown block", "Begin Nodes", "Begin Nodez", &["Nodez", "Nodes", "mesh.mdpa:7"]),
    mesh(
        "unknown constraint",
        "Begin NodalData",
        "Begin Constraints LinearMasterSlaveConstrain DISPLACEMENT_X\n1 0.0 [1.0] 9 10\nEnd Constraints\n\nBegin NodalData",
        &["unknown-constraint", "LinearMasterSlaveConstraint"],
    ),
    mesh(
        "pairs in the mesh",
        "Begin Conditions LineLoadCondition2D2N",
        "Begin Conditions ALMFrictionlessMortarContactCondition2D2N",
        &["pair-in-mesh", "take these conditions out"],
    ),
    mesh("block ended by another name", "End Elements", "End Conditions", &["mesh.mdpa:24", "Elements"]),
    mesh("letter in a coordinate", "2 1.0 0.0 0.0", "2 l.0 0.0 0.0", &["mesh.mdpa:9", "l.0"]),
    mesh("coordinate missing", "10 0.0 2.0 0.0", "10 0.0 2.0", &["mesh.mdpa"]),
    mesh("word for a node id", "1 0 1 2 5 4", "1 0 1 two 5 4", &["mesh.mdpa:21", "two"]),
    mesh("negative node id", "1 0.0 0.0 0.0", "-1 0.0 0.0 0.0", &["mesh.mdpa:8", "-1"]),
    // mesh: names
    mesh(
        "unknown element",
        "SmallDisplacementElement2D4N",
        "SmallDisplacementElement2D4",
        &["SmallDisplacementElement2D4N", "mesh.mdpa:20"],
    ),
    mesh("unknown condition", "LineCondition2D2N", "LineConditon2D2N", &["LineConditon2D2N", "LineCondition2D2N"]),
    mesh(
        "unknown nodal variable",
        "NodalData DISPLACEMENT_Y",
        "NodalData DISPLACMENT_Y",
        &["DISPLACMENT_Y", "DISPLACEMENT"],
    ),
    mesh("nodal variable without storage", "NodalData DISPLACEMENT_Y", "NodalData HUMIDITY", &["HUMIDITY"]),
    mesh("sub part twice", "SubModelPart Nothing", "SubModelPart Slave", &["Slave"]),
    // mesh: ids
    mesh("node twice at two places", "2 1.0 0.0 0.0", "1 1.0 0.0 0.0", &["mesh.mdpa:9", "1"]),
    mesh("element twice", "2 0 2 3 6 5", "1 0 2 3 6 5", &["mesh.mdpa:22", "1"]),
    mesh("condition twice", "2 0 5 4", "1 0 5 4", &["mesh.mdpa:28"]),
    mesh("element on an undefined node", "3 0 7 8 9 10", "3 0 7 8 9 11", &["mesh.mdpa:23", "11"]),
    mesh("condition on an undefined node", "4 0 9 10", "4 0 9 99", &["99"]),
    mesh("undefined properties", "1 0 1 2 5 4", "1 5 1 2 5 4", &["mesh.mdpa:21", "5"]),
    mesh("sub part with an undefined node", "    1 2 3\n", "    1 2 33\n", &["33", "Bottom"]),
    mesh(
        "sub part with an undefined element",
        "    1 2\n  End SubModelPartElements",
        "    1 22\n  End SubModelPartElements",
        &["22", "Lower"],
    ),
    mesh(
        "sub part with an undefined condition",
        "    1 2\n  End SubModelPartConditions",
        "    1 22\n  End SubModelPartConditions",
        &["22", "Lower"],
    ),
    mesh("data of an undefined node", "9 0 0.0\n", "90 0 0.0\n", &["90"]),
    // mesh: shapes
    mesh("inverted element", "1 0 1 2 5 4", "1 0 1 4 5 2", &["SmallDisplacementElement2D4N 1"]),
    mesh(
        "element without area",
        "4 0.0 1.0 0.0\n5 1.0 1.0 0.0",
        "4 0.0 0.0 0.0\n5 1.0 0.0 0.0",
        &["SmallDisplacementElement2D4N 1"],
    ),
    mesh(
        "solid element in the plane",
        "SmallDisplacementElement2D4N",
        "SmallDisplacementElement3D4N",
        &["SmallDisplacementElement3D4N"],
    ),
    mesh(
        "a shell",
        "SmallDisplacementElement2D4N",
        "ShellThinElement3D4N",
        &["ShellThinElement3D4N", "shells are not there"],
    ),
    mesh("element of too many nodes", "SmallDisplacementElement2D4N", "SmallDisplacementElement2D8N", &["mesh.mdpa"]),
    // contact parts
    deck("contact part without nodes", "[\"Interface\"]", "[\"Nothing\"]", &["Nothing"]),
    deck("slave part without nodes", "[\"Slave\"]", "[\"Nothing\"]", &["Nothing", "slave"]),
    deck("slave part away from the contact", "[\"Slave\"]", "[\"Bottom\"]", &["Bottom", "Interface"]),
    deck("contact part without a master", "[\"Interface\"]", "[\"Slave\"]", &["Slave"]),
    // materials
    materials(
        "unknown law",
        "LinearElasticPlaneStrain2DLaw",
        "LinearElasticPlainStrain2DLaw",
        &["LinearElasticPlaneStrain2DLaw", "StructuralMaterials.json:7"],
    ),
    materials("no law", "        \"constitutive_law\": {\"name\": \"LinearElasticPlaneStrain2DLaw\"},\n", "", &["law"]),
    materials(
        "law for solids in the plane",
        "LinearElasticPlaneStrain2DLaw",
        "LinearElastic3DLaw",
        &["LinearElastic3DLaw"],
    ),
    materials(
        "kinematic hardening",
        "LinearElasticPlaneStrain2DLaw",
        "ConstitutiveLawsApplication.FiniteStrainKinematicPlasticityPlaneStrainVonMisesVonMises",
        &["under small strain: SmallStrainKinematicPlasticity3DVonMisesVonMises"],
    ),
    materials(
        "plasticity without a yield stress",
        "LinearElasticPlaneStrain2DLaw",
        "SmallStrainJ2PlasticityPlaneStrain2DLaw",
        &["YIELD_STRESS"],
    ),
    materials(
        "a curve that softens",
        "LinearElasticPlaneStrain2DLaw\"},\n        \"Variables\": {\"YOUNG_MODULUS\": 2.0e9,",
        "SmallStrainIsotropicPlasticityPlaneStrainVonMisesVonMises\"},\n        \"Variables\": {\"YOUNG_MODULUS\": 2.0e9, \"YIELD_STRESS\": 1e6, \"FRACTURE_ENERGY\": 1e5, \"HARDENING_CURVE\": 1,",
        &["HARDENING_CURVE 1 softens"],
    ),
    materials("no Young's modulus", "\"YOUNG_MODULUS\": 2.0e9, ", "", &["YOUNG_MODULUS"]),
    materials("negative Young's modulus", "\"YOUNG_MODULUS\": 2.0e9", "\"YOUNG_MODULUS\": -2.0e9", &["YOUNG_MODULUS"]),
    materials("no Poisson's ratio", ", \"POISSON_RATIO\": 0.3", "", &["POISSON_RATIO"]),
    materials("Poisson's ratio one half", "\"POISSON_RATIO\": 0.3", "\"POISSON_RATIO\": 0.5", &["POISSON_RATIO"]),
    materials(
        "Poisson's ratio below minus one",
        "\"POISSON_RATIO\": 0.3",
        "\"POISSON_RATIO\": -1.2",
        &["POISSON_RATIO"],
    ),
    materials(
        "unknown material variable",
        "\"POISSON_RATIO\": 0.3",
        "\"POISON_RATIO\": 0.3",
        &["POISON_RATIO", "POISSON_RATIO"],
    ),
    materials(
        "word for a modulus",
        "\"YOUNG_MODULUS\": 2.0e9",
        "\"YOUNG_MODULUS\": \"stiff\"",
        &["YOUNG_MODULUS", "StructuralMaterials.json"],
    ),
    materials("material of an unknown part", "\"Structure.Upper\"", "\"Structure.Uper\"", &["Uper", "Upper"]),
    materials("two materials for a part", "\"Structure.Upper\"", "\"Structure.Lower\"", &["Lower"]),
    materials("no list of materials", "\"properties\": [", "\"propertys\": [", &["properties"]),
];
