//! Runs on several processes: the same answers in the same iterations as one process gives, and clean ends of failed runs.
//!
//! They need the feature `mpi`, without which they are ignored, and mpirun.

#[path = "support/boxes.rs"]
mod boxes;
mod support;
#[path = "support/vtu.rs"]
mod vtu;

use boxes::Boxes;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use support::{Results, change, contents, read_json, root, said, scratch_copy, zelus};
use vtu::{Columns, read_vtu, sources};
use zelus::core::communication::{self, Ranks};
use zelus::{RunOptions, Silent, Simulation};

const RANKS: [usize; 5] = [1, 2, 3, 4, 8];
const DECK: &str = "ProjectParameters.json";
/// Within this a failed run ends on all ranks.
const PROMPT: Duration = Duration::from_secs(30);

/// `mpirun` with what it needs to start more processes than there are cores.
fn mpirun(folder: &Path) -> Command {
    let version = Command::new("mpirun").arg("--version").output().expect("mpirun, which the feature `mpi` needs");
    let mut command = Command::new("mpirun");
    command.current_dir(folder).env("NO_COLOR", "1");
    if said(&version).contains("Open MPI") {
        command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1").arg("--oversubscribe");
    }
    command
}

fn distributed(folder: &Path, ranks: usize, arguments: &[&str]) -> Output {
    let mut command = mpirun(folder);
    command.args(["-n", &ranks.to_string(), env!("CARGO_BIN_EXE_zelus")]).args(arguments);
    command.output().expect("mpirun starts")
}

/// All numbers below `value`, by path.
fn numbers(value: &Value, path: &str, out: &mut BTreeMap<String, f64>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, v)| numbers(v, &format!("{path}/{key}"), out)),
        Value::Array(items) => items.iter().enumerate().for_each(|(at, v)| numbers(v, &format!("{path}/{at}"), out)),
        _ => _ = value.as_f64().map(|number| out.insert(path.to_owned(), number)),
    }
}

/// The quantity a path belongs to, vectors as a whole.
fn quantity(path: &str) -> &str {
    let name = path.split('/').nth(2).unwrap_or(path);
    name.strip_suffix("_X").or(name.strip_suffix("_Y")).or(name.strip_suffix("_Z")).unwrap_or(name)
}

/// Numbers of every JSON file the run has written, and the iterations of its steps.
fn outcome(folder: &Path, before: &[std::path::PathBuf]) -> (BTreeMap<String, f64>, Vec<usize>) {
    let mut found = BTreeMap::new();
    for name in contents(folder).into_keys().filter(|name| !before.contains(name)) {
        if name.extension().is_some_and(|e| e == "json") && name != Path::new("report.json") {
            let key = name.to_string_lossy().replace('/', "_");
            numbers(&read_json(&folder.join(&name)).expect("results"), &key, &mut found);
        }
    }
    let report = read_json(&folder.join("report.json")).expect("the report");
    let steps = report["steps"].as_array().expect("steps").iter();
    (found, steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).collect())
}

/// Holds `found` to what is expected, within `tolerance` of the largest value of each quantity.
fn assert_near(found: &BTreeMap<String, f64>, expected: &BTreeMap<String, f64>, tolerance: f64, what: &str) {
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (path, value) in expected {
        let size = largest.entry(quantity(path)).or_insert(0.0);
        *size = size.max(value.abs());
    }
    assert!(found.keys().eq(expected.keys()), "{what} writes other results");
    for (path, value) in expected {
        let difference = (found[path] - value).abs();
        let size = largest[quantity(path)];
        assert!(difference <= tolerance * size, "{what}: {path} is {}, not {value}", found[path]);
    }
}

/// Runs a case serially and on every number of ranks; results may differ by `tolerance` of their quantity's largest value.
fn equals_serial(case: &str, changes: &[(&str, &str)], tolerance: f64, same_iterations: bool) {
    let original = scratch_copy(&root().join("tests/cases").join(case));
    let path = original.path().join(DECK);
    let mut text = std::fs::read_to_string(&path).expect("the deck");
    for (find, with) in changes {
        assert!(text.contains(find), "{case} does not have {find:?}");
        text = text.replace(find, with);
    }
    std::fs::write(&path, text).expect("the deck");
    let before: Vec<_> = contents(original.path()).into_keys().collect();
    let arguments = ["run", DECK, "--report", "report.json"];
    let alone = scratch_copy(original.path());
    let output = zelus(alone.path(), &arguments);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let (expected, iterations) = outcome(alone.path(), &before);
    assert!(!expected.is_empty(), "{case} writes no JSON results");
    for ranks in RANKS {
        let folder = scratch_copy(original.path());
        let output = distributed(folder.path(), ranks, &arguments);
        assert!(output.status.success(), "{case} on {ranks} ranks: {}", said(&output));
        let (found, of_ranks) = outcome(folder.path(), &before);
        assert!(
            !same_iterations || of_ranks == iterations,
            "{case} on {ranks} ranks: {of_ranks:?}, not {iterations:?}"
        );
        assert_near(&found, &expected, tolerance, &format!("{case} on {ranks} ranks"));
        let whole = said(&output).contains("slave facets on 1 of them");
        assert!(!whole, "{case} on {ranks} ranks: the interface is not cut");
    }
}

/// METIS leaves most facets of a sphere's small contact to few ranks: their pairs are shared out, and nothing else changes. The engine is
/// named: one process alone would hand over to the direct one, whose answers are closer than multigrid's.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn pairs_of_full_ranks_are_evaluated_by_others() {
    let deck = root().join("examples/hertz_sphere");
    // Levels depend on who has which rows: solves go further than the criteria ask, so that answers are those of no engine.
    let exact = r#""linear_solver_settings": {"solver_type": "amgcl", "tolerance": 1e-12}, "max_iteration""#;
    let engine = ("\"max_iteration\"", exact);
    equals_serial(&deck.to_string_lossy(), &[engine], EQUAL, true);
    let folder = scratch_copy(&deck);
    let output = distributed(folder.path(), 2, &["run", DECK]);
    assert!(said(&output).contains("pairs moved to other ranks"), "{}", said(&output));
}

/// A tolerance for what has a closed form, which `tests/cases.rs` holds the serial run to.
const EXACT: f64 = 1e-10;
/// A tolerance where round-off of the slip grows over steps of one iteration each, as `tests/renumbering.rs` says.
const GROWN: f64 = 1e-7;
/// A tolerance for what has none.
const EQUAL: f64 = 1e-9;

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn bodies_without_contact() {
    equals_serial("elements/load_patch_2D4N", &[], EXACT, true);
    equals_serial("elements/displacement_patch_3D8N", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn heat_through_contact() {
    let deck = root().join("examples/bars_in_thermal_contact");
    equals_serial(&deck.to_string_lossy(), &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictionless_contact_in_the_plane() {
    equals_serial("contact_2d/nonmatching", &[], EXACT, true);
    equals_serial("contact_2d/opening", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictionless_contact_in_space() {
    equals_serial("contact_3d/hexahedra_nonmatching", &[], EXACT, true);
    equals_serial("contact_3d/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Slips of sticking nodes are round-off and left out.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictional_contact() {
    equals_serial("contact_2d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_3d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_2d/friction_pure_slip", &[], EXACT, true);
    equals_serial("contact_2d/friction_arc", &[], EQUAL, true);
    equals_serial("contact_2d/friction_none", &[], EXACT, true);
    equals_serial("contact_2d/friction_slide", &[], EXACT, true);
    equals_serial("contact_2d/friction_tresca_slide", &[], EXACT, true);
    equals_serial("contact_2d/friction_by_pair", &[], EXACT, true);
    equals_serial("contact_3d/friction_slide", &[], EXACT, true);
    equals_serial("contact_3d/friction_tresca_slide", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn penalty_contact() {
    let common =
        [("alm_contact_process", "penalty_contact_process"), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP")];
    let frictionless = [&common[..], &[("ALMContactFrictionless", "PenaltyContactFrictionless")]].concat();
    let sliding = "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3}";
    let frictional =
        [("ALMContactFrictionless", "PenaltyContactFrictional"), ("\"contact_type\": \"Frictionless\"", sliding)];
    equals_serial("contact_2d/nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_2d/nonmatching", &[&common[..], &frictional].concat(), EQUAL, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &[&common[..], &frictional].concat(), EQUAL, true);
}

/// Points decide on contact by the traction of the slave's own element, which every rank has for each slave facet.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn contact_by_tractions_of_elements() {
    equals_serial("contact_2d/nitsche", &[], EXACT, true);
    equals_serial("contact_3d/nitsche", &[], EXACT, true);
    let family = [("alm_contact_process", "nitsche_contact_process"), ("ALMContact", "NitscheContact")];
    let parted = [&family[..], &[("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP")]].concat();
    equals_serial("contact_2d/opening", &parted, EQUAL, true);
    equals_serial("contact_3d/opening", &parted, EQUAL, true);
    let rubbed = [&family[..], &[("\"VECTOR_LAGRANGE_MULTIPLIER\", \"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")]].concat();
    equals_serial("contact_2d/friction_slide", &rubbed, EQUAL, true);
    equals_serial("contact_3d/friction_slide", &rubbed, EQUAL, true);
    equals_serial("contact_3d/friction_stick", &rubbed, EQUAL, true);
}

/// A node's traction is the penalty times its gap over all its pairs, which several ranks evaluate.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn friction_by_penalties_of_nodes() {
    equals_serial("contact_2d/friction_penalty_slide", &[], EQUAL, true);
    equals_serial("contact_3d/friction_penalty_slide", &[], GROWN, false);
    equals_serial("contact_3d/friction_penalty_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EQUAL, true);
}

/// The block goes beyond the end of its ground, which then covers a twelfth of the last but one facet.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn nodes_beside_the_master() {
    let beyond = ("2.0*(t-1.0)", "2.73*(t-1.0)");
    equals_serial("contact_2d/slid_past", &[beyond], EQUAL, true);
    let of_nodes = ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP");
    let by_penalty = [("alm_contact_process", "penalty_contact_process"), ("ALMContact", "PenaltyContact"), of_nodes];
    equals_serial("contact_2d/slid_past", &[&by_penalty[..], &[beyond]].concat(), EQUAL, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn tied_meshes() {
    equals_serial("mesh_tying/triangles_on_quadrilaterals", &[], EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Systems as small as these are solved by rank 0 unless the deck asks for PETSc.
/// Ties over a whole part, stages, dynamics, whole skins, fields that are mapped, and bodies that touch themselves.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn what_looks_beyond_a_rank() {
    equals_serial("constraints/rigid_plate", &[], EXACT, true);
    equals_serial("structural/stages_of_plastic_flow", &[], EXACT, true);
    equals_serial("structural/volumetric_strain_swings_3D8N", &[], EQUAL, true);
    equals_serial("contact_3d/skin_detection", &[], EXACT, true);
    equals_serial("contact_3d/parts_of_nodes", &[], EXACT, true);
    equals_serial("mpc/mapped_field", &[], EXACT, true);
    equals_serial("self_contact/slit_hexahedra", &[], EQUAL, true);
}

/// κ of the system of all ranks, not of what one of them adds to it.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn condition_numbers_are_those_of_the_whole_system() {
    let folder = case("contact_2d/nonmatching");
    let asks = "\"mortar_type\": \"ALMContactFrictionless\"";
    change(folder.path(), DECK, asks, &format!("{asks}, \"condn_convergence_criterion\": true"));
    let arguments = ["run", DECK, "--report", "report.json"];
    let number = |folder: &Path| -> f64 {
        let report = read_json(&folder.join("report.json")).expect("the report");
        report["steps"][0]["iterations"][0]["condition_number"].as_f64().expect("a condition number")
    };
    assert!(zelus(folder.path(), &arguments).status.success());
    let alone = number(folder.path());
    for ranks in [2, 3] {
        let output = distributed(folder.path(), ranks, &arguments);
        assert!(output.status.success(), "{}", said(&output));
        let shared = number(folder.path());
        assert!((shared - alone).abs() <= EQUAL * alone, "{ranks} ranks: {shared}, not {alone}");
    }
}

#[test]
#[cfg_attr(not(feature = "petsc"), ignore = "needs the feature `petsc`")]
fn petsc_solves_for_all() {
    let asks = "\"solver_type\": \"Static\", \"linear_solver_settings\": {\"petsc_engine\": \"automatic\"}";
    let asks = [("\"solver_type\": \"Static\"", asks)];
    equals_serial("contact_2d/nonmatching", &asks, EXACT, true);
    equals_serial("contact_2d/opening", &asks, EXACT, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &asks, EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &asks, EXACT, true);
    equals_serial("mpc/pressed_and_opened", &asks, EXACT, true);
    let slips = ("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"");
    equals_serial("contact_3d/friction_stick", &[asks[0], slips], EXACT, true);
}

/// Multigrid gets systems without multipliers; where these cannot be condensed a factorisation serves, and a warning
/// says so.
#[test]
#[cfg_attr(not(feature = "petsc"), ignore = "needs the feature `petsc`")]
fn multigrid_solves_for_all_but_multipliers() {
    let gmres = "\"solver_type\": \"gmres\", \"petsc_engine\": \"gmres_gamg\"";
    equals_serial("contact_3d/iterative_engine", &[("\"solver_type\": \"gmres\"", gmres)], EQUAL, false);
    let asks = "\"solver_type\": \"Static\", \"linear_solver_settings\": {\"petsc_engine\": \"gmres_gamg\", \"tolerance\": 1e-11}";
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[("\"solver_type\": \"Static\"", asks)], EQUAL, false);
    for (name, is_condensed) in [("mesh_tying/hexahedra", true), ("mesh_tying/hexahedra_on_tetrahedra", false)] {
        let folder = case(name);
        change(folder.path(), DECK, "\"solver_type\": \"Static\"", asks);
        let arguments = ["run", DECK, "--report", "report.json"];
        let output = distributed(folder.path(), 2, &arguments);
        assert!(output.status.success(), "{name}: {}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let engine = &report["steps"][0]["iterations"][0]["engine"];
        assert_eq!(engine, if is_condensed { "gmres_gamg" } else { "mumps_lu" }, "{name}: {}", said(&output));
        assert_eq!(
            said(&output).matches("warning[not-condensed]").count(),
            usize::from(!is_condensed),
            "{}",
            said(&output)
        );
    }
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn contact_by_constraints() {
    equals_serial("mpc/pressed_and_opened", &[], EXACT, true);
    equals_serial("mpc/pressed_and_opened_hexahedra", &[], EXACT, true);
    equals_serial("mpc/tying_matching", &[], EXACT, true);
    equals_serial("mpc/tying_matching_hexahedra", &[], EXACT, true);
}

/// Constraints hand on forces to nodes that other ranks own.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn reactions_of_supports_that_constraints_reach() {
    let all = ("[\"DISPLACEMENT\"]", "[\"DISPLACEMENT\", \"REACTION\"]");
    equals_serial("mpc/pressed_and_opened", &[all], EQUAL, true);
    equals_serial("mpc/tying_matching_hexahedra", &[all], EQUAL, true);
    let part = "\"Parameters\": {\n          \"model_part_name\": \"Structure\",\n";
    let rubbed = part.to_owned() + "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3},";
    let friction =
        [all, ("{\"contact_type\": \"Frictionless\"}", "{\"contact_type\": \"Frictional\"}"), (part, &rubbed)];
    equals_serial("mpc/pressed_and_opened_hexahedra", &friction, EQUAL, true);
}

const MULTIGRID: (&str, &str) = (
    "\"Static\"",
    "\"Static\", \"linear_solver_settings\": {\"solver_type\": \"amgcl\", \"direct_below\": 0, \"tolerance\": 1e-11}",
);

/// Results of multigrid where the rows are equal those of one process.
fn multigrid_equals_serial(case: &str, changes: &[(&str, &str)]) {
    let changes = [&[MULTIGRID], changes].concat();
    // Criteria of sliding are met by a hair.
    equals_serial(case, &changes, EQUAL, !case.contains("friction"));
    let folder = self::case(case);
    changes.iter().for_each(|(find, with)| change(folder.path(), DECK, find, with));
    let output = distributed(folder.path(), 3, &["run", DECK, "--report", "report.json"]);
    assert!(output.status.success(), "{case}: {}", said(&output));
    let report = read_json(&folder.path().join("report.json")).expect("the report");
    let iterations = report["steps"].as_array().expect("steps").iter().flat_map(|step| step["iterations"].as_array());
    for iteration in iterations.flatten() {
        assert_eq!(iteration["engine"], "multigrid over ranks", "{case}: {iteration}");
        assert!(iteration["fallback"].is_null(), "{case}: {iteration}");
    }
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn multigrid_over_ranks() {
    multigrid_equals_serial("contact_2d/nonmatching", &[]);
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &[]);
    // Gaps are round-off there.
    multigrid_equals_serial("contact_3d/hexahedra_on_tetrahedra", &[("\"WEIGHTED_GAP\"", "\"DISPLACEMENT\"")]);
    multigrid_equals_serial("contact_3d/nitsche", &[]);
    let pressure = ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "VECTOR_LAGRANGE_MULTIPLIER");
    let components = ("\"ALMContactFrictionless\"", "\"ALMContactFrictionlessComponents\"");
    let of_components = ("\"contact_type\": \"Frictionless\"", "\"contact_type\": \"FrictionlessComponents\"");
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &[components, of_components, pressure]);
    let gap = ("\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\", \"WEIGHTED_GAP\"", "\"DISPLACEMENT\"");
    let penalty = [("alm_contact_process", "penalty_contact_process"), ("ALMContact", "PenaltyContact"), gap];
    multigrid_equals_serial("contact_3d/hexahedra_nonmatching", &penalty);
    multigrid_equals_serial("mpc/pressed_and_opened_hexahedra", &[]);
    multigrid_equals_serial("mpc/tying_matching_hexahedra", &[]);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn multigrid_over_ranks_with_friction_and_ties() {
    multigrid_equals_serial("contact_2d/friction_slide", &[]);
    multigrid_equals_serial("contact_3d/friction_slide", &[]);
    let slips = ("\"FRICTION_TRACTION\", \"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"");
    // A stiff penalty makes of what criteria leave of displacements more of the pressure.
    let pressures = ("\"AUGMENTED_NORMAL_CONTACT_PRESSURE\"", "\"DISPLACEMENT\"");
    multigrid_equals_serial("contact_3d/friction_penalty_slide", &[slips, pressures]);
    multigrid_equals_serial("contact_3d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")]);
    multigrid_equals_serial("mesh_tying/hexahedra", &[]);
    multigrid_equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[]);
}

/// More equations than the coarsest level takes: without the motions of bodies the iteration is a longer one.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn levels_over_ranks_are_as_good_as_those_of_one() {
    let folder = scratch_copy(&root().join("examples/hertz_sphere"));
    change(folder.path(), DECK, MULTIGRID.0, MULTIGRID.1);
    change(folder.path(), DECK, "\"end_time\": 1.0", "\"end_time\": 0.25");
    let arguments = ["run", DECK, "--report", "report.json"];
    let solves = |output: Output, engine: &str| -> Vec<f64> {
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let iterations = report["steps"][0]["iterations"].as_array().expect("iterations");
        assert!(iterations.iter().all(|iteration| iteration["engine"] == engine), "{}", said(&output));
        iterations.iter().map(|iteration| iteration["linear_iterations"].as_f64().expect("a number")).collect()
    };
    let alone = solves(zelus(folder.path(), &arguments), "multigrid");
    for ranks in [2, 3] {
        let shared = solves(distributed(folder.path(), ranks, &arguments), "multigrid over ranks");
        let alike = shared.len() == alone.len() && shared.iter().zip(&alone).all(|(a, b)| *a <= 1.15 * b + 2.0);
        assert!(alike, "{ranks} ranks: {shared:?} iterations, not {alone:?}");
    }
}

/// What a picture holds, whatever its pieces: columns of each node and of each cell, by id, and the corners of the cells.
#[derive(Debug, Default, PartialEq)]
struct Pictured {
    nodes: BTreeMap<i64, BTreeMap<String, Vec<f64>>>,
    cells: BTreeMap<i64, BTreeMap<String, Vec<f64>>>,
    corners: BTreeMap<i64, Vec<i64>>,
    cell_count: usize,
}

impl Pictured {
    /// Reads a VTU file, or the pieces that a PVTU file lists; gives their number, too.
    fn read(path: &Path) -> (Self, usize) {
        let pieces = if path.extension().is_some_and(|e| e == "pvtu") { sources(path) } else { vec![path.to_owned()] };
        let mut out = Self::default();
        pieces.iter().for_each(|piece| out.add(piece));
        (out, pieces.len())
    }

    fn add(&mut self, piece: &Path) {
        let (points, cells) = read_vtu(piece);
        let whole = |columns: &Columns, name: &str| -> Vec<i64> {
            columns.get(name).unwrap_or_else(|| panic!("no {name}")).1.iter().map(|&x| x as i64).collect()
        };
        let (node_ids, cell_ids) = (whole(&points, "KRATOS_NODE_ID"), whole(&cells, "KRATOS_ELEMENT_ID"));
        assert!(!node_ids.is_empty(), "a piece without points");
        let (connectivity, ends) = (whole(&cells, "connectivity"), whole(&cells, "offsets"));
        let mut start = 0;
        for (id, end) in cell_ids.iter().zip(ends) {
            let corners = connectivity[start..end as usize].iter().map(|&point| node_ids[point as usize]);
            self.corners.insert(*id, corners.collect());
            start = end as usize;
        }
        self.cell_count += cell_ids.len();
        for (ids, columns, out) in [(&node_ids, points, &mut self.nodes), (&cell_ids, cells, &mut self.cells)] {
            for (name, (components, values)) in columns {
                if matches!(name.as_str(), "connectivity" | "offsets") {
                    continue;
                }
                assert_eq!(values.len(), ids.len() * components, "{name}");
                for (&id, row) in ids.iter().zip(values.chunks_exact(components)) {
                    let known = out.entry(id).or_default().insert(name.clone(), row.to_vec());
                    assert!(known.is_none_or(|known| known == row), "{name} of {id} differs between pieces");
                }
            }
        }
    }
}

/// Put before the JSON output of a deck.
const PICTURES: &str = r#""pictures": [{"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics",
    "Parameters": {"model_part_name": "Structure", "output_sub_model_parts": true, "write_ids": true,
    "nodal_solution_step_data_variables": ["DISPLACEMENT"], "nodal_flags": ["SLAVE"],
    "gauss_point_variables_in_elements": ["VON_MISES_STRESS"],
    "gauss_point_variables_extrapolated_to_nodes": ["VON_MISES_STRESS"]}}], "json_output_process_list""#;

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn ranks_write_a_piece_of_the_picture_each() {
    let folder = case("contact_3d/hexahedra_nonmatching");
    change(folder.path(), DECK, "\"json_output_process_list\"", PICTURES);
    let alone = scratch_copy(folder.path());
    assert!(zelus(alone.path(), &["run", DECK]).status.success());
    for ranks in [2, 3, 8] {
        let shared = scratch_copy(folder.path());
        let output = distributed(shared.path(), ranks, &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        let files = shared.path().join("VTU_Output");
        let series = std::fs::read_to_string(files.join("Structure.pvd")).expect("the series");
        assert!(series.contains("file=\"Structure_1.pvtu\""), "{series}");
        for part in ["Structure", "Structure_Lower", "Structure_Upper"] {
            let (expected, _) = Pictured::read(&alone.path().join("VTU_Output").join(format!("{part}_1.vtu")));
            let (found, pieces) = Pictured::read(&files.join(format!("{part}_1.pvtu")));
            assert!(part != "Structure" || pieces == ranks, "{pieces} pieces of {ranks} ranks");
            assert_eq!((found.cell_count, &found.corners), (expected.cell_count, &expected.corners), "{part}");
            for (found, expected) in [(found.nodes, expected.nodes), (found.cells, expected.cells)] {
                assert!(found.keys().eq(expected.keys()), "{part}: other nodes or cells");
                let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
                for (name, row) in expected.values().flatten() {
                    let size = largest.entry(name).or_insert(0.0);
                    *size = row.iter().fold(*size, |size, value| size.max(value.abs()));
                }
                for (id, columns) in &expected {
                    assert!(columns.keys().eq(found[id].keys()), "{part}: other columns at {id}");
                    for (name, row) in columns {
                        let other = &found[id][name];
                        let agree = row.iter().zip(other).all(|(a, b)| (a - b).abs() <= EXACT * largest[name.as_str()]);
                        assert!(agree, "{part} {id}: {name} is {other:?}, not {row:?}");
                    }
                }
            }
        }
        // A picture of an earlier run does not stay beside those of this one.
        let output = distributed(shared.path(), 1, &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        assert!(contents(&files).keys().all(|name| name.extension().is_some_and(|e| e != "pvtu")));
    }
}

/// Put before the JSON output of a deck: what rank 0 writes of the values of all.
const FILES: &str = r#""files": [
    {"python_module": "integration_values_extrapolation_to_nodes_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure", "list_of_variables": ["VON_MISES_STRESS"]}},
    {"python_module": "vtk_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure", "output_sub_model_parts": true, "write_ids": true,
        "output_precision": 14, "file_format": "ascii", "nodal_solution_step_data_variables": ["DISPLACEMENT"],
        "nodal_data_value_variables": ["VON_MISES_STRESS"], "nodal_flags": ["SLAVE"],
        "gauss_point_variables_in_elements": ["VON_MISES_STRESS"]}},
    {"python_module": "gid_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure", "output_name": "pictures", "postprocess_parameters": {
        "result_file_configuration": {"gidpost_flags": {"GiDPostMode": "GiD_PostAscii",
        "WriteConditionsFlag": "WriteConditions"}, "nodal_results": ["DISPLACEMENT", "REACTION"],
        "gauss_point_results": ["VON_MISES_STRESS", "PK2_STRESS_TENSOR"]}}}},
    {"python_module": "line_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure.Lower", "start_point": [0.05, 0.1, 0.2], "end_point": [0.9, 0.8, 0.9],
        "sampling_points": 5, "output_variables": ["DISPLACEMENT", "VELOCITY_X"],
        "output_file_settings": {"file_name": "line"}}},
    {"python_module": "point_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure.Upper", "entity_type": "node", "position": [1.0, 0.8, 2.0],
        "output_variables": ["REACTION"], "output_file_settings": {"file_name": "corner"}}},
    {"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure", "output_file_name": "stresses.json", "historical_value": false,
        "output_variables": ["VON_MISES_STRESS"], "gauss_points_output_variables": ["CAUCHY_STRESS_VECTOR"],
        "time_frequency": 0.0}},
    {"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Structure.Bottom", "output_file_name": "sum.json", "resultant_solution": true,
        "output_variables": ["REACTION"], "time_frequency": 0.0}}], "json_output_process_list""#;

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn files_of_one_rank_hold_what_all_have() {
    let folder = case("contact_3d/hexahedra_nonmatching");
    change(folder.path(), DECK, "\"json_output_process_list\"", FILES);
    let before: Vec<_> = contents(folder.path()).into_keys().collect();
    let written = |folder: &Path| -> BTreeMap<std::path::PathBuf, String> {
        let texts = contents(folder).into_iter().filter(|(name, _)| !before.contains(name));
        texts.map(|(name, bytes)| (name, String::from_utf8(bytes).expect("text"))).collect()
    };
    let alone = scratch_copy(folder.path());
    let output = zelus(alone.path(), &["run", DECK]);
    assert!(output.status.success(), "{}", said(&output));
    let expected = written(alone.path());
    assert!(expected.len() >= 15, "{:?}", expected.keys());
    for ranks in [2, 3, 8] {
        let shared = scratch_copy(folder.path());
        let output = distributed(shared.path(), ranks, &["run", DECK]);
        assert!(output.status.success(), "{}", said(&output));
        let found = written(shared.path());
        assert!(found.keys().eq(expected.keys()), "{ranks} ranks: {:?}, not {:?}", found.keys(), expected.keys());
        for (name, text) in &expected {
            let number = |word: &str| word.trim_end_matches(',').parse::<f64>().ok();
            let largest = text.split_whitespace().filter_map(number).fold(0.0, |most: f64, x| most.max(x.abs()));
            let same = |(a, b): (&str, &str)| match (number(a), number(b)) {
                // What should be zero is round-off of stresses and forces.
                (Some(a), Some(b)) => {
                    let size = a.abs().max(b.abs());
                    (a - b).abs() <= EQUAL * size || size <= 1e-12 * largest
                }
                _ => a == b,
            };
            let (found, text) = (found[name].split_whitespace(), text.split_whitespace());
            assert_eq!(found.clone().count(), text.clone().count(), "{ranks} ranks: {}", name.display());
            let other = text.zip(found).find(|pair| !same(*pair));
            assert!(other.is_none(), "{ranks} ranks: {} differs: {other:?}", name.display());
        }
    }
}

/// Set for the processes that run this very test as ranks.
const AS_RANK: &str = "ZELUS_TEST_AS_RANK";

/// Rank 0 makes the steps of a run of its own between those of the run that all ranks share.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_run_of_one_rank_stands_beside_one_of_all() {
    if std::env::var_os(AS_RANK).is_some() {
        return run_alone_and_together();
    }
    let mut command = mpirun(&root());
    command.env(AS_RANK, "yes").args(["-n", "3"]).arg(std::env::current_exe().expect("this program"));
    let name = "a_run_of_one_rank_stands_beside_one_of_all";
    let output = command.args(["--exact", name, "--test-threads=1"]).output().expect("mpirun starts");
    assert!(output.status.success() && said(&output).matches("1 passed").count() == 3, "{}", said(&output));
}

fn run_alone_and_together() {
    let ranks = communication::join().expect("the ranks that mpirun started");
    let open = |ranks: Ranks| {
        let mut deck = read_json(&case_folder("contact_3d/hexahedra_nonmatching").join(DECK)).expect("a deck");
        deck.as_object_mut().expect("a deck").remove("output_processes");
        deck["solver_settings"]["time_stepping"]["time_step"] = 0.25.into();
        // PETSc, where there is one, takes the processes of MPI and leaves the other run alone.
        deck["solver_settings"]["linear_solver_settings"] = serde_json::json!({"petsc_engine": "automatic"});
        deck["processes"].as_object_mut().expect("lists").remove("json_output_process_list");
        let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
        Simulation::of_value(&deck, &case_folder("contact_3d/hexahedra_nonmatching"), &options).expect("a deck")
    };
    let mut together = open(ranks.clone());
    let mut alone = (ranks.rank() == 0).then(|| open(Ranks::default()));
    let mut steps = 0;
    loop {
        let stepped = alone.as_mut().map(|alone| alone.step(&mut Silent).expect("it converges"));
        let went_on = together.step(&mut Silent).expect("it converges");
        assert!(stepped.is_none_or(|stepped| stepped == went_on));
        if !went_on {
            break;
        }
        steps += 1;
        let Some(alone) = &alone else { continue };
        let by_node = |simulation: &Simulation| -> BTreeMap<usize, Vec<f64>> {
            let displacement = simulation.field("DISPLACEMENT").expect("a field").chunks_exact(3).map(<[f64]>::to_vec);
            simulation.part().expect("a part").nodes.ids.iter().copied().zip(displacement).collect()
        };
        let (expected, found) = (by_node(alone), by_node(&together));
        assert!(found.len() < expected.len(), "nothing is shared out");
        let largest = expected.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
        for (id, u) in found {
            let near = u.iter().zip(&expected[&id]).all(|(a, b)| (a - b).abs() <= EQUAL * largest);
            assert!(near, "node {id}: {u:?}, not {:?}", expected[&id]);
        }
    }
    assert!(steps > 1);
}

fn case_folder(name: &str) -> std::path::PathBuf {
    root().join("tests/cases").join(name)
}

fn case(name: &str) -> tempfile::TempDir {
    scratch_copy(&case_folder(name))
}

/// The run fails with this exit code and says the text once.
fn fails(output: &Output, code: i32, text: &str) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert_eq!(said.matches(text).count(), 1, "{said}");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_bad_deck_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"Static\"", "\"Statik\"");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "error[");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_step_that_does_not_converge_ends_all_ranks() {
    let folder = case("contact_2d/friction_slide");
    change(folder.path(), DECK, "\"max_iteration\": 30", "\"max_iteration\": 1, \"step_cutting\": false");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 3, "error[not-converged]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_file_that_cannot_be_written_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"output_file_name\": \"", "\"output_file_name\": \"mesh.mdpa/");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "mesh.mdpa/lower.json: ");
}

/// Runs the deck on three ranks of which `rank` finds the disk full when it writes `file`.
fn full_disk(folder: &Path, rank: usize, file: &str) -> Output {
    let mut command = mpirun(folder);
    let program = env!("CARGO_BIN_EXE_zelus");
    let (path, name) = file.rsplit_once('/').map_or((".", file), |(path, name)| (path, name));
    // what a rank writes first goes to the name with its process id, which exec keeps
    let full = format!("mkdir -p {path}; ln -s /dev/full {path}/.{name}.$$.part; exec {program} run {DECK}");
    for at in 0..3 {
        command.args([if at > 0 { ":" } else { "-n" }, if at > 0 { "-n" } else { "1" }]);
        command.args(if at > 0 { &["1"][..] } else { &[] });
        command.args(if at == rank { vec!["sh", "-c", &full] } else { vec![program, "run", DECK] });
    }
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    output
}

#[test]
#[cfg_attr(not(all(feature = "mpi", target_os = "linux")), ignore = "needs the feature `mpi` and /dev/full")]
fn a_full_disk_of_another_rank_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), DECK, "\"json_output_process_list\"", PICTURES);
    let output = full_disk(folder.path(), 1, "VTU_Output/Structure_1_1.vtu");
    fails(&output, 4, "Structure_1_1.vtu: cannot be written");
    assert!(!folder.path().join("VTU_Output/Structure_1.pvtu").exists(), "a list of what is not there");
}

#[test]
#[cfg_attr(not(all(feature = "mpi", target_os = "linux")), ignore = "needs the feature `mpi` and /dev/full")]
fn a_full_disk_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    let output = full_disk(folder.path(), 0, "lower.json");
    fails(&output, 4, "lower.json: cannot be written");
    let parts = contents(folder.path()).into_keys().filter(|name| name.extension().is_some_and(|e| e == "part"));
    assert_eq!(parts.count(), 0, "half-written files stay");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_body_that_nothing_holds_is_said_once() {
    for engine in ["", "mumps_lu", "none"] {
        let folder = case("contact_2d/nonmatching");
        change(folder.path(), DECK, "[true, false, false]", "[false, false, false]");
        let settings = format!("\"Static\", \"linear_solver_settings\": {{\"petsc_engine\": \"{engine}\"}}");
        change(folder.path(), DECK, "\"Static\"", &settings);
        let output = distributed(folder.path(), 3, &["run", DECK]);
        fails(&output, 4, "error[system]");
        assert!(said(&output).contains("the system of equations is singular"), "{}", said(&output));
        assert!(said(&output).contains("DISPLACEMENT_X of node"), "{}", said(&output));
    }
}

/// Rank 0 runs the deck of one folder, rank 1 that of another.
fn one_each(first: &Path, second: &Path) -> Output {
    let mut command = mpirun(first);
    let program = env!("CARGO_BIN_EXE_zelus");
    let decks = [first, second].map(|folder| folder.join(DECK).to_string_lossy().into_owned());
    let report = ["--report", "report.json"];
    command.args(["-n", "1", program, "run", &decks[0]]).args(report);
    command.args([":", "-n", "1", program, "run", &decks[1]]).args(report);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(start.elapsed() < PROMPT, "{}", said(&output));
    output
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_rank_that_fails_alone_ends_all() {
    let (good, bad) = (case("contact_2d/nonmatching"), case("contact_2d/nonmatching"));
    std::fs::remove_file(bad.path().join(DECK)).expect("a deck");
    let output = one_each(good.path(), bad.path());
    fails(&output, 2, "error[unreadable-file]");
    let output = one_each(bad.path(), good.path());
    fails(&output, 2, "error[unreadable-file]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn only_rank_0_reads_meshes_and_materials() {
    let [alone, one, other] = [(); 3].map(|()| case("contact_2d/nonmatching"));
    let before: Vec<_> = contents(alone.path()).into_keys().collect();
    for file in ["mesh.mdpa", "StructuralMaterials.json"] {
        std::fs::remove_file(other.path().join(file)).expect("a file of the case");
    }
    let output = one_each(one.path(), other.path());
    assert!(output.status.success(), "{}", said(&output));
    zelus(alone.path(), &["run", DECK, "--report", "report.json"]);
    let [expected, found] = [&alone, &one].map(|folder| outcome(folder.path(), &before));
    assert!(!expected.0.is_empty() && expected.1 == found.1);
    assert_near(&found.0, &expected.0, 1e-9, "one of two ranks without a mesh");
    let output = one_each(other.path(), one.path());
    fails(&output, 2, "error[missing-file]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn ranks_with_different_settings_do_not_run() {
    for (file, find, with, says) in [
        (DECK, "\"end_time\": 1.0", "\"end_time\": 6.0", "the ranks have read different decks"),
        ("load.csv", "1.0, -2.0", "1.0, -2.5", "load.csv"),
    ] {
        let (one, other) = (case("contact_2d/nonmatching"), case("contact_2d/nonmatching"));
        for folder in [&one, &other] {
            std::fs::write(folder.path().join("load.csv"), "0.0, 0.0\n1.0, -2.0\n").expect("a table");
            let table = "\"modulus\": {\"name\": \"csv_table\", \"filename\": \"load.csv\"}";
            change(folder.path(), DECK, "\"modulus\": 1000000.0", table);
        }
        change(other.path(), file, find, with);
        let output = one_each(one.path(), other.path());
        fails(&output, 4, says);
    }
}

/// One rank alone owns the element.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn an_inverted_element_is_said_once() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), "mesh.mdpa", "\n1 0 1 2 6 5\n", "\n1 0 1 5 6 2\n");
    let output = distributed(folder.path(), 3, &["run", DECK]);
    fails(&output, 2, "error[");
    assert!(said(&output).contains("SmallDisplacementElement2D4N 1 "), "{}", said(&output));
}

/// Elements that a load turns inside out on some of the ranks cut the step on all of them, until there is none to cut.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn an_element_that_fails_in_a_step_ends_all_ranks() {
    let folder = case("contact_2d/nonmatching");
    change(folder.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    change(folder.path(), "StructuralMaterials.json", "LinearElasticPlaneStrain2DLaw", "HyperElasticPlaneStrain2DLaw");
    change(folder.path(), DECK, "\"modulus\": 1000000.0", "\"modulus\": 1e15");
    let output = distributed(folder.path(), 2, &["run", DECK]);
    fails(&output, 3, "error[not-converged]");
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn a_killed_rank_ends_all() {
    let folder = case("contact_2d/opening");
    change(folder.path(), DECK, "\"end_time\": ", "\"end_time\": 100000");
    let mut command = mpirun(folder.path());
    let program = env!("CARGO_BIN_EXE_zelus");
    let killed = format!("{program} run {DECK} & sleep 2; kill -9 $!; wait $!");
    command.args(["-n", "1", program, "run", DECK, ":", "-n", "1", "sh", "-c", &killed]);
    let start = Instant::now();
    let output = command.output().expect("mpirun starts");
    assert!(!output.status.success() && start.elapsed() < PROMPT, "{}", said(&output));
}

/// A corner that lands between the nodes of a coarse slave makes energy: what the work of contact says, on any number of ranks.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn work_of_contact_is_counted_once() {
    const MATERIAL: [f64; 3] = [1.0, 0.2, 1.0];
    let boxes = Boxes::thrown_on_coarse_ground(0.35);
    let work = |ranks: usize| -> Vec<f64> {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let settings = json!({"contact_settings": {"largest_energy_gain": 0.0, "largest_penetration": 0.0}});
        boxes.write_thrown(folder.path(), MATERIAL, 40.0, &settings);
        let output = distributed(folder.path(), ranks, &["run", DECK, "--report", "report.json"]);
        assert!(output.status.success(), "{ranks} ranks: {}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let steps = report["steps"].as_array().expect("steps").iter().filter(|step| step["converged"] == true);
        let of_step = |step: &Value| {
            let numbers = step["interactions"].as_array().expect("numbers").iter();
            numbers.filter(|number| number[0] == "work of contact").find_map(|number| number[1].as_f64()).expect("work")
        };
        let work: Vec<f64> = steps.map(of_step).collect();
        let results = Results::read(&folder.path().join("results.json")).expect("results");
        let energy = |step| boxes.state("Block", MATERIAL, &results, step).energy();
        let (won, done) = (energy(Some(results.len() - 1)) - energy(None), work[work.len() - 1]);
        // In steps this long the scheme has a share of the energy too.
        assert!((won - done).abs() < 0.1 * done.abs(), "{ranks} ranks: the block wins {won}, contact does {done}");
        work
    };
    let alone = work(1);
    let most = alone.iter().fold(0.0_f64, |most, work| most.max(work.abs()));
    assert!(most > 1e-6, "contact does no work: {most}");
    for ranks in [2, 3] {
        let shared = work(ranks);
        assert_eq!(shared.len(), alone.len(), "{ranks} ranks");
        for (step, (a, b)) in alone.iter().zip(&shared).enumerate() {
            assert!((a - b).abs() < 1e-6 * most, "{ranks} ranks, step {step}: {b}, not {a}");
        }
    }
}

/// A program without MPI that is started as one of several would run the whole deck in each of them.
#[test]
#[cfg_attr(feature = "mpi", ignore = "of a program without the feature `mpi`")]
fn several_processes_need_the_feature() {
    let folder = case("contact_2d/nonmatching");
    let output = Command::new(env!("CARGO_BIN_EXE_zelus"))
        .args(["run", DECK])
        .current_dir(folder.path())
        .env("OMPI_COMM_WORLD_SIZE", "2")
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("without the feature `mpi`"), "{}", said(&output));
}
