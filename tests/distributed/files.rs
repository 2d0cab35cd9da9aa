//! Output of several ranks, and runs that stand beside each other.

use std::collections::BTreeMap;
use std::path::Path;

use zelus::core::communication::{self, Ranks};
use zelus::{RunOptions, Silent, Simulation};

use crate::runs::*;
use crate::support::{change, contents, read_json, root, said, scratch_copy, zelus};
use crate::vtu::{Columns, read_vtu, sources};

/// Contents of a picture, whatever its pieces: columns of each node and of each cell, by id, and the corners of the cells.
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
pub const PICTURES: &str = r#""pictures": [{"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics",
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

/// Put before the JSON output of a deck: rank 0 writes the values of all.
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
                // Values that should be zero are round-off of stresses and forces.
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
    let name = "files::a_run_of_one_rank_stands_beside_one_of_all";
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
