//! User materials: subroutines UMAT in Fortran, compiled here, beside the laws of the program and a driver in Fortran (EXTERNAL).

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};
use tempfile::TempDir;
use zelus_core::geometry::Shape;

use super::deck::{Deck, Ran};
use super::grid::Grid;

const FREE: Value = Value::Null;
const COMPILER: &str = "gfortran";

/// A library of sources of this folder; `None`, said, where there is no compiler.
fn library(sources: &[&str], folder: &TempDir, is_program: bool) -> Option<PathBuf> {
    let target = folder.path().join(if is_program { "driver".to_owned() } else { format!("lib{}.so", sources[0]) });
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bulk/umat");
    let mut command = Command::new(COMPILER);
    command.current_dir(folder.path()).args(["-O1", "-ffree-line-length-none", "-o"]).arg(&target);
    if !is_program {
        command.args(["-shared", "-fPIC"]);
    }
    sources.iter().for_each(|source| {
        command.arg(here.join(source).with_extension("f90"));
    });
    match command.output() {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            Some(target)
        }
        Err(_) => {
            println!("skipped: user materials, which need {COMPILER}");
            None
        }
    }
}

fn user(library: &Path, constants: &[f64], states: usize) -> Value {
    json!({"UDSM_NAME": library, "UMAT_PARAMETERS": constants, "STATE_VARIABLES": vec![0.0; states]})
}

/// A twisted and stretched block, fixed at one end.
fn twisted(grid: &Grid, element: &str, law: &str, material: Value, size: f64, steps: usize) -> Ran {
    let dim = grid.shape.dim();
    let mut deck = Deck::new(grid, element, law, material);
    deck.steps(1.0 / steps as f64, 1.0).set("residual_relative_tolerance", json!(1e-12));
    let revolves = element.starts_with("Axisym");
    let zero = || json!(0.0);
    deck.fix(|p| p[1] == 0.0, [zero(), zero(), if dim == 3 { zero() } else { FREE }]);
    let by = |factor: f64, text: &str| json!(format!("{:?}*t*({text})", factor * size));
    let across = if revolves { by(0.4, "X") } else { by(1.0, "1+Y") };
    deck.fix(|p| p[1] == 1.0, [across, by(1.5, "1"), if dim == 3 { by(0.7, "X-0.5") } else { FREE }]);
    deck.run()
}

fn worst(found: &Ran, expected: &Ran, grid: &Grid) -> f64 {
    let [found, expected] = [found, expected].map(|ran| ran.displacements(grid));
    let size = expected.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    let off = found.iter().zip(&expected).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()));
    off.fold(0.0, f64::max) / size
}

fn iterations(ran: &Ran) -> Vec<usize> {
    ran.report.steps.iter().map(|step| step.iterations.len()).collect()
}

/// A plate or a block that is heated unevenly, held in one corner alone.
fn heated(grid: &Grid, law: &str, material: Value) -> Ran {
    let mut deck = Deck::new(grid, "SmallDisplacementElement", law, material);
    deck.steps(0.25, 1.0).set("auxiliary_variables_list", json!(["TEMPERATURE"])).gauss("STATE_VARIABLES");
    deck.set("residual_relative_tolerance", json!(1e-12));
    deck.process(
        "assign_scalar_variable_process",
        json!({"model_part_name": "Structure", "variable_name": "TEMPERATURE", "value": "20+100*t*X*X+30*Y", "constrained": false}),
    );
    for axis in 0..grid.shape.dim() {
        deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
    }
    deck.run()
}

/// A body of a user material moves as one of the law that it repeats, with as many iterations: stress and tangent are those. The tolerance
/// is that of Newton's iteration.
pub(super) fn same(element: &str, shape: Shape, [own, law]: [&str; 2], [user, known]: [Value; 2], size: f64) {
    let grid = Grid::new(shape, &[2, 3, 2][..shape.dim()], |p| [1.0 + p[0] + 0.1 * p[1], p[1], p[2]]);
    let found = twisted(&grid, element, own, user, size, 4);
    let expected = twisted(&grid, element, law, known, size, 4);
    let off = worst(&found, &expected, &grid);
    println!("{element} {shape:?} {own}: {off:.1e}");
    assert!(off < 1e-9, "{element} {shape:?} {own}: {off:e}");
    let [found, expected] = [iterations(&found), iterations(&expected)];
    // A residual at the tolerance falls to either side of it.
    let most = found.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1), "{element} {shape:?} {own}: {found:?} iterations, {expected:?} by the program's");
}

#[test]
fn elasticity_is_that_of_the_program() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["elastic"], &folder, false) else { return };
    let known = json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3});
    let of = || [user(&library, &[200.0, 0.3], 1), known.clone()];
    for shape in [Shape::Hex8, Shape::Tet10] {
        same("SmallDisplacementElement", shape, ["SmallStrainUMAT3DLaw", "LinearElastic3DLaw"], of(), 1e-3);
    }
    let laws = ["SmallStrainUMAT2DPlaneStrainLaw", "LinearElasticPlaneStrain2DLaw"];
    for element in ["SmallDisplacementElement", "SmallDisplacementBbarElement"] {
        same(element, Shape::Quad4, laws, of(), 1e-3);
    }
    let laws = ["SmallStrainUMATAxisym2DLaw", "LinearElasticAxisym2DLaw"];
    same("AxisymSmallDisplacementElement", Shape::Quad8, laws, of(), 1e-3);
}

#[test]
fn plasticity_is_that_of_the_program() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["plastic"], &folder, false) else { return };
    let known = json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3, "YIELD_STRESS": 0.4,
        "ISOTROPIC_HARDENING_MODULUS": 20.0});
    let laws = ["SmallStrainUMAT3DLaw", "SmallStrainJ2Plasticity3DLaw"];
    let of = [user(&library, &[200.0, 0.3, 0.4, 20.0], 1), known];
    same("SmallDisplacementElement", Shape::Hex8, laws, of, 1e-2);
}

#[test]
fn finite_elasticity_is_that_of_the_program() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["neo_hooke"], &folder, false) else { return };
    let (young, poisson): (f64, f64) = (200.0, 0.3);
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let constants = [lambda, young / (2.0 * (1.0 + poisson))];
    let known = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": poisson});
    let of = || [user(&library, &constants, 0), known.clone()];
    for element in ["TotalLagrangianElement", "UpdatedLagrangianElement"] {
        same(element, Shape::Hex8, ["FiniteStrainUMAT3DLaw", "HyperElastic3DLaw"], of(), 0.3);
        let laws = ["FiniteStrainUMAT2DPlaneStrainLaw", "HyperElasticPlaneStrain2DLaw"];
        same(element, Shape::Quad4, laws, of(), 0.3);
    }
    let laws = ["FiniteStrainUMATAxisym2DLaw", "HyperElasticAxisym2DLaw"];
    same("AxisymTotalLagrangianElement", Shape::Quad4, laws, of(), 0.3);
}

/// TEMP, DTEMP and COORDS, in plane stress (NDI = 2) too: a body with uneven temperatures warps as one of the program's law. The
/// tolerance is that of Newton's iteration, and the round-off of Gauss points.
#[test]
fn routines_get_temperature_and_position() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["heated"], &folder, false) else { return };
    let known = json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3, "THERMAL_EXPANSION_COEFFICIENT": 1e-3,
        "REFERENCE_TEMPERATURE": 20.0});
    let mut own = user(&library, &[200.0, 0.3, 1e-3], 4);
    own["REFERENCE_TEMPERATURE"] = json!(20.0);
    for (shape, [law, other]) in [
        (Shape::Hex8, ["SmallStrainUMAT3DLaw", "ThermalElasticIsotropic3D"]),
        (Shape::Quad4, ["SmallStrainUMAT2DPlaneStressLaw", "ThermalLinearPlaneStress"]),
    ] {
        let grid = Grid::new(shape, &[2, 2, 1][..shape.dim()], |p| [2.0 * p[0], p[1], 0.5 * p[2]]);
        let found = heated(&grid, law, own.clone());
        let off = worst(&found, &heated(&grid, other, known.clone()), &grid);
        assert!(off < 1e-9, "{law}: {off:e}");
        // The first Gauss point of the first cell, 1 × 1/2 × 1/2.
        let near = 0.5 - 0.5 / 3.0_f64.sqrt();
        let state = &found.gauss("STATE_VARIABLES", 3)[0].1;
        let z = if shape == Shape::Hex8 { 0.5 * near } else { 0.0 };
        let place = [near, 0.5 * near, z];
        assert!((0..3).all(|c| (state[c] - place[c]).abs() < 1e-14), "{state:?} instead of {place:?}");
        // TEMPERATURE of the nodes of the cell, 20 + 100 x² + 30 y, interpolated.
        let temperature = 20.0 + 100.0 * near + 15.0 * near;
        assert!((state[3] - temperature).abs() < 1e-11, "{} instead of {temperature}", state[3]);
    }
    // A reference without a temperature says nothing.
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "SmallStrainUMAT3DLaw", own);
    deck.fix(|_| true, [json!(0.0), json!(0.0), json!(0.0)]);
    let (result, _) = deck.attempt();
    let said = result.expect_err("no temperature").to_string();
    assert!(said.contains("TEMPERATURE, which nodes do not have"), "{said}");
}

/// EXTERNAL: a program in Fortran calls the same subroutine along the same path of strains in all six components.
#[test]
fn a_cube_goes_the_path_of_a_driver() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["plastic"], &folder, false) else { return };
    let driver = library_of_driver(&folder);
    let output = Command::new(driver).output().expect("the driver starts");
    let rows: Vec<Vec<f64>> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| line.split_whitespace().map(|word| word.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 40, "{}", String::from_utf8_lossy(&output.stderr));
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let material = user(&library, &[200.0, 0.3, 0.4, 20.0], 1);
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "SmallStrainUMAT3DLaw", material);
    deck.steps(1.0 / 40.0, 1.0).gauss("CAUCHY_STRESS_VECTOR").gauss("STATE_VARIABLES");
    let [xx, yy, zz] = ["0.01*sin(6*t)", "-0.004*t", "0.003*sin(9*t)"];
    let [xy, xz, yz] = ["0.012*t*(1-t)", "0.006*sin(5*t)", "-0.008*t"];
    deck.fix(
        |_| true,
        [json!(format!("({xx})*X+({xy})*Y+({xz})*Z")), json!(format!("({yy})*Y+({yz})*Z")), json!(format!("({zz})*Z"))],
    );
    let ran = deck.run();
    let mut most = 0.0_f64;
    for (step, row) in rows.iter().enumerate() {
        let stress = ran.gauss("CAUCHY_STRESS_VECTOR", step)[0].1.clone();
        // xx, yy, zz, xy, yz, xz beside xx, yy, zz, xy, xz, yz
        for (at, c) in [0, 1, 2, 3, 5, 4].into_iter().enumerate() {
            most = most.max((stress[at] - row[c]).abs());
        }
        most = most.max((ran.gauss("STATE_VARIABLES", step)[0].1[0] - row[6]).abs());
    }
    println!("beside the driver: {most:.1e}");
    assert!(rows[39][6] > 0.01 && most < 1e-12, "{most:e}");
}

fn library_of_driver(folder: &TempDir) -> PathBuf {
    library(&["driver", "plastic"], folder, true).expect("a compiler")
}

/// A routine that asks for a shorter step gets one.
#[test]
fn steps_are_cut_where_the_routine_asks() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["elastic"], &folder, false) else { return };
    let mut material = user(&library, &[200.0, 0.3], 1);
    material["UMAT_NAME"] = json!("steps");
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let ran = twisted(&grid, "SmallDisplacementElement", "SmallStrainUMAT3DLaw", material, 1e-3, 1);
    let lengths: Vec<f64> = ran.report.steps.iter().filter(|s| s.converged).map(|s| s.delta_time).collect();
    assert!(lengths.len() >= 4 && lengths.iter().all(|length| *length <= 0.3), "{lengths:?}");
}

/// Threads may call a routine one at a time, or at once: the answer has the same bits.
#[test]
fn threads_do_not_change_the_answer() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["plastic"], &folder, false) else { return };
    let grid = Grid::new(Shape::Hex8, &[4, 4, 4], |p| p);
    let run = |is_safe: bool| {
        let mut material = user(&library, &[200.0, 0.3, 0.4, 20.0], 1);
        material["UMAT_IS_THREAD_SAFE"] = json!(is_safe);
        twisted(&grid, "SmallDisplacementElement", "SmallStrainUMAT3DLaw", material, 1e-2, 2).displacements(&grid)
    };
    assert_eq!(run(true), run(false));
}

/// A tangent that is no derivative of the stress is named before the run; those of the other tests here are not.
#[test]
fn a_wrong_tangent_is_named() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let sources = ["elastic", "plastic", "neo_hooke"];
    let libraries: Vec<PathBuf> = sources.iter().filter_map(|source| library(&[source], &folder, false)).collect();
    let [elastic, plastic, neo_hooke] = &*libraries else { return };
    let right = |source: &Path, constants: &[f64]| (user(source, constants, 1), None);
    let named = |name: &str, words: &'static str| {
        let mut material = user(elastic, &[200.0, 0.3], 1);
        material["UMAT_NAME"] = json!(name);
        (material, Some(words))
    };
    let small = [
        right(elastic, &[200.0, 0.3]),
        right(plastic, &[200.0, 0.3, 0.1, 20.0]),
        named("softens", "by 11.1 % of its largest entry, in dXX/dXX"),
        named("turns", "in dYY/dXX"),
    ];
    let large = [right(neo_hooke, &[115.0, 77.0]), (user(elastic, &[200.0, 0.3], 1), None)];
    let all = small.into_iter().map(|case| ("SmallDisplacement", "SmallStrain", case));
    for (element, kind, (material, expected)) in all.chain(large.map(|case| ("TotalLagrangian", "FiniteStrain", case)))
    {
        for (shape, law) in
            [(Shape::Hex8, "UMAT3DLaw"), (Shape::Quad4, "UMAT2DPlaneStrainLaw"), (Shape::Quad4, "UMATAxisym2DLaw")]
        {
            let grid = Grid::new(shape, &[1, 1, 1][..shape.dim()], |p| [p[0] + 1.0, p[1], p[2]]);
            let revolves = if law.contains("Axisym") { "Axisym" } else { "" };
            let (element, law) = (format!("{revolves}{element}Element"), format!("{kind}{law}"));
            let mut deck = Deck::new(&grid, &element, &law, material.clone());
            deck.fix(|p| p[1] == 0.0, [json!(0.0), json!(0.0), json!(0.0)]);
            deck.fix(|p| p[1] == 1.0, [FREE, json!("0.001*t"), FREE]);
            let written = deck.write();
            let output = Command::new(env!("CARGO_BIN_EXE_zelus"))
                .args(["check", "ProjectParameters.json"])
                .current_dir(written.path())
                .output()
                .expect("the program starts");
            let said = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
            assert_eq!(output.status.code(), Some(0), "{said}");
            match expected {
                Some(words) => {
                    assert!(said.contains("warning[wrong-tangent]") && said.contains(words), "{law}: {said}")
                }
                None => assert!(!said.contains("wrong-tangent"), "{law}, {material}: {said}"),
            }
        }
    }
}

/// Libraries that cannot be used are named before the run; one that ends the program names the element.
#[test]
fn mistakes_are_named() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(library) = library(&["elastic"], &folder, false) else { return };
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let deck = |change: &dyn Fn(&mut Value)| {
        let mut material = user(&library, &[200.0, 0.3], 1);
        change(&mut material);
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "SmallStrainUMAT3DLaw", material);
        deck.fix(|p| p[0] == 0.0, [json!(0.0), json!(0.0), json!(0.0)]);
        deck.fix(|p| p[0] == 1.0, [json!("0.001*t"), FREE, FREE]);
        deck
    };
    let text = folder.path().join("text.so");
    std::fs::write(&text, "no library").expect("a file");
    type Change<'c> = &'c dyn Fn(&mut Value);
    let no_name: Change<'_> = &|m| {
        m.as_object_mut().expect("an object").remove("UDSM_NAME");
    };
    let nowhere: Change<'_> = &|m| m["UDSM_NAME"] = json!("nowhere.so");
    let no_library: Change<'_> = &|m| m["UDSM_NAME"] = json!(text);
    let no_symbol: Change<'_> = &|m| m["IS_FORTRAN_UDSM"] = json!(false);
    for (change, words) in [
        (no_name, ["missing-property", "have no UDSM_NAME"]),
        (nowhere, ["user-material", "nowhere.so is not there"]),
        (no_library, ["user-material", "does not load"]),
        (no_symbol, ["user-material", "has no symbol umat"]),
    ] {
        let said = deck(change).problem();
        words.iter().for_each(|word| assert!(said.contains(word), "no {word:?} in: {said}"));
    }
    for (name, word) in [("stops", "its own STOP"), ("aborts", "SIGABRT"), ("crashes", "SIGSEGV")] {
        let crash: Change<'_> = &|m| {
            m["UMAT_NAME"] = json!(name);
            m["UMAT_PARAMETERS"] = json!([200.0, 0.3, 4e9]);
        };
        let written = deck(crash).write();
        let output = Command::new(env!("CARGO_BIN_EXE_zelus"))
            .args(["run", "ProjectParameters.json"])
            .current_dir(written.path())
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        for words in ["error[user-material] element 1", word] {
            assert!(said.contains(words), "no {words:?} in: {said}");
        }
        assert_eq!(output.status.code(), Some(3), "{said}");
    }
}
