//! Contents of a picture where its deck names nothing, and messages about names in a wrong list.

use std::path::Path;

use crate::support::{change, root, said, scratch_copy, zelus};
use zelus::core::io::results::{Column, Dataset, read_vtu};
use zelus::{RunOptions, Silent, Simulation};

const LISTS: &str = r#",
          "nodal_solution_step_data_variables": ["DISPLACEMENT", "REACTION", "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"],
          "gauss_point_variables_extrapolated_to_nodes": ["CAUCHY_STRESS_VECTOR", "VON_MISES_STRESS"]"#;

fn example() -> tempfile::TempDir {
    scratch_copy(&root().join("examples/hertz_line_contact"))
}

fn run(folder: &Path, arguments: &[&str]) {
    let output = zelus(folder, &[&["run", "ProjectParameters.json"], arguments].concat());
    assert!(output.status.success(), "{}", said(&output));
}

fn column<'d>(picture: &'d Dataset, name: &str) -> &'d Column {
    let names: Vec<&str> = picture.point_data.iter().map(|column| column.name.as_str()).collect();
    picture.point_data.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"))
}

fn values(column: &Column) -> Vec<f64> {
    (0..column.values.len()).map(|at| column.values.get(at)).collect()
}

#[test]
fn a_bare_output_process_writes_what_runs_are_looked_at_for() {
    let scratch = example();
    change(scratch.path(), "ProjectParameters.json", LISTS, "");
    run(scratch.path(), &[]);
    let read = |step: usize| read_vtu(&scratch.path().join(format!("vtu_output/Structure_{step}.vtu"))).unwrap();
    let (start, end) = (read(0), read(4));
    for name in ["DISPLACEMENT", "REACTION", "CAUCHY_STRESS_VECTOR", "VON_MISES_STRESS", "GREEN_LAGRANGE_STRAIN_VECTOR"]
    {
        assert!(values(column(&start, name)).iter().all(|value| *value == 0.0), "{name} at the start");
        assert!(values(column(&end, name)).iter().any(|value| *value != 0.0), "{name} at the end");
    }
    for name in ["PART", "PROPERTIES_ID"] {
        let found = end.cell_data.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("{name}"));
        assert!(values(found).contains(&2.0), "{name}");
    }
    let (pressure, status, force) = (
        values(column(&end, "CONTACT_PRESSURE")),
        values(column(&end, "CONTACT_STATUS")),
        column(&end, "CONTACT_FORCE"),
    );
    assert!(pressure.iter().all(|p| *p >= -1e-9), "pressure is positive in compression");
    for (at, state) in status.iter().enumerate() {
        assert!([-1.0, 0.0, 2.0].contains(state) && (*state != 0.0 || pressure[at] == 0.0), "{state} at {at}");
    }
    // the vertical force on the roller and that on the block are opposite, and equal the load
    let vertical: Vec<f64> = values(force).chunks(3).map(|force| force[1]).collect();
    let up: f64 = vertical.iter().filter(|force| **force > 0.0).sum();
    let total: f64 = vertical.iter().sum();
    let reaction: f64 = values(column(&end, "REACTION")).chunks(3).map(|force| force[1]).sum();
    assert!(up > 0.0 && total.abs() < 1e-9 * up, "{up} {total}");
    assert!((up - reaction).abs() < 1e-3 * up, "{up} {reaction}");
    let traction = values(column(&end, "CONTACT_TRACTION"));
    let slaves = |(at, _): &(usize, (&f64, &[f64]))| status[*at] >= 0.0;
    for (_, (pressure, traction)) in pressure.iter().zip(traction.chunks(3)).enumerate().filter(slaves) {
        let size = traction.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((size - pressure).abs() <= 1e-9 * pressure.abs(), "{traction:?} {pressure}");
    }
}

/// With friction too, force is traction times area at each slave node, and forces on masters are opposite to those on slaves.
#[test]
fn forces_of_friction_are_tractions_times_areas() {
    for case in ["friction_slide", "friction_penalty_stick"] {
        let scratch = scratch_copy(&root().join("tests/cases/contact_2d").join(case));
        let mut simulation =
            Simulation::open(&scratch.path().join("ProjectParameters.json"), &RunOptions::default()).unwrap();
        simulation.run(&mut Silent).unwrap();
        let values = &simulation.part().unwrap().nodes.values;
        let of = |name: &str| &*values.get(name).unwrap_or_else(|| panic!("{name}")).levels[0];
        let (force, traction) = (of("CONTACT_FORCE"), of("CONTACT_TRACTION"));
        let (area, status) = (of("NODAL_AREA"), of("CONTACT_STATUS"));
        let largest = force.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let mut sums = [0.0; 3];
        for (at, force) in force.chunks(3).enumerate() {
            for (i, force) in force.iter().enumerate() {
                sums[i] += force;
                let wanted = traction[3 * at + i] * area[at];
                assert!(status[at] < 0.0 || (force - wanted).abs() < 1e-9 * largest, "{case}: {force} {wanted}");
            }
        }
        assert!(force.iter().step_by(3).any(|tangential| tangential.abs() > 0.1 * largest), "{case} has friction");
        assert!(sums.iter().all(|sum| sum.abs() < 1e-9 * largest), "{case}: {sums:?}");
    }
}

/// Master nodes have the pressure of the slave: on flat faces of unlike meshes that of the patch test, which the balance gives; with
/// friction traction and force are along each other, and pressure is its part along the normal, which is y.
#[test]
fn pressures_of_masters_are_those_of_slaves() {
    for case in [
        "contact_2d/nonmatching",
        "contact_3d/hexahedra_nonmatching",
        "contact_3d/tetrahedra",
        "contact_2d/friction_slide",
    ] {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let mut simulation =
            Simulation::open(&scratch.path().join("ProjectParameters.json"), &RunOptions::default()).unwrap();
        simulation.run(&mut Silent).unwrap();
        let part = simulation.part().unwrap();
        let of = |name: &str| &*part.nodes.values.get(name).unwrap_or_else(|| panic!("{name}")).levels[0];
        let (pressure, status) = (of("CONTACT_PRESSURE"), of("CONTACT_STATUS"));
        let (force, traction) = (of("CONTACT_FORCE"), of("CONTACT_TRACTION"));
        let masters: Vec<usize> = (0..status.len()).filter(|&at| status[at] < 0.0 && pressure[at] != 0.0).collect();
        assert!(masters.len() > 2, "{case}");
        let slaves = || (0..status.len()).filter(|&at| status[at] > 0.0).map(|at| pressure[at]);
        let (least, most) = (slaves().fold(f64::INFINITY, f64::min), slaves().fold(0.0, f64::max));
        let up = part.info.domain_size - 1;
        for at in masters {
            let (force, traction) = (&force[3 * at..3 * at + 3], &traction[3 * at..3 * at + 3]);
            let sizes = [force, traction].map(|own| own.iter().map(|x| x * x).sum::<f64>().sqrt());
            let along: f64 = force.iter().zip(traction).map(|(a, b)| a * b).sum();
            assert!((along / (sizes[0] * sizes[1]) - 1.0).abs() < 1e-9, "{case}: {force:?} {traction:?}");
            assert!((traction[up].abs() / pressure[at] - 1.0).abs() < 1e-6, "{case}: {traction:?} {}", pressure[at]);
            // ANALYTIC: a uniform pressure stays uniform, to the round-off of the solve
            let is_uniform = most - least < 1e-6 * most;
            assert!(!is_uniform || (pressure[at] / most - 1.0).abs() < 1e-6, "{case}: {} {most}", pressure[at]);
        }
    }
}

#[test]
fn like_kratos_only_lists_are_written() {
    let scratch = example();
    change(scratch.path(), "ProjectParameters.json", LISTS, "");
    run(scratch.path(), &["--like", "kratos"]);
    let folder = scratch.path().join("vtu_output");
    assert!(!folder.join("Structure_0.vtu").exists());
    assert!(read_vtu(&folder.join("Structure_1.vtu")).unwrap().point_data.is_empty());
}

#[test]
fn a_name_in_the_wrong_list_is_refused_with_the_right_one() {
    for (find, with, name, list) in [
        (
            "\"nodal_solution_step_data_variables\"",
            "\"nodal_data_value_variables\"",
            "DISPLACEMENT",
            "nodal_solution_step_data_variables",
        ),
        (
            "\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\"],\n          \"gauss",
            "\"VON_MISES_STRESS\"],\n          \"gauss",
            "VON_MISES_STRESS",
            "gauss_point_variables_extrapolated_to_nodes",
        ),
        (
            "\"LAGRANGE_MULTIPLIER_CONTACT_PRESSURE\"],\n          \"gauss",
            "\"CONTACT_PRESSURE\"],\n          \"gauss",
            "CONTACT_PRESSURE",
            "nodal_data_value_variables",
        ),
    ] {
        let scratch = example();
        change(scratch.path(), "ProjectParameters.json", find, with);
        let output = zelus(scratch.path(), &["check", "ProjectParameters.json"]);
        let text = said(&output);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains("error[other-list]") && text.contains(name), "{text}");
        assert!(text.contains(&format!("name it in \"{list}\"")), "{text}");
        let output = zelus(scratch.path(), &["check", "ProjectParameters.json", "--like", "kratos"]);
        assert!(output.status.success(), "{}", said(&output));
    }
}

/// A run with one file writes the bytes that `zelus convert` makes of its pictures, be the run stopped between or not.
#[test]
fn one_file_holds_all_steps() {
    let deck = |one_file: bool| {
        let scratch = example();
        if one_file {
            change(
                scratch.path(),
                "ProjectParameters.json",
                "\"vtu_output_process\",\n        \"kratos_module\": \"KratosMultiphysics\",\n        \"Parameters\": {",
                "\"vtk_output_process\",\n        \"Parameters\": {\n          \"file_format\": \"vtkhdf\",",
            );
        }
        scratch
    };
    let files = |folder: &Path| {
        let all = std::fs::read_dir(folder.join("vtu_output")).unwrap().flatten();
        all.map(|entry| entry.file_name().into_string().unwrap()).collect::<Vec<_>>()
    };
    let many = deck(false);
    run(many.path(), &[]);
    let output = zelus(many.path(), &["convert", "vtu_output/Structure.pvd", "all.vtkhdf"]);
    assert!(output.status.success(), "{}", said(&output));
    let wanted = std::fs::read(many.path().join("all.vtkhdf")).unwrap();

    let one = deck(true);
    let path = one.path().join("ProjectParameters.json");
    let mut simulation = Simulation::open(&path, &RunOptions::default()).unwrap();
    (0..2).for_each(|_| assert!(simulation.step(&mut Silent).unwrap()));
    simulation.suspend().unwrap();
    drop(simulation);
    assert!(files(one.path()).contains(&"Structure_2.vtu".to_owned()), "a run that goes on writes pictures");
    let saved = one.path().join("ProjectParameters.resume");
    let pointer = std::fs::read(&saved).unwrap();
    run(one.path(), &["--resume"]);
    assert_eq!(files(one.path()), ["Structure.vtkhdf"]);
    assert!(std::fs::read(one.path().join("vtu_output/Structure.vtkhdf")).unwrap() == wanted);

    std::fs::write(saved, pointer).unwrap();
    let output = zelus(one.path(), &["run", "ProjectParameters.json", "--resume"]);
    assert!(!output.status.success() && said(&output).contains("into one file"), "{}", said(&output));
}
