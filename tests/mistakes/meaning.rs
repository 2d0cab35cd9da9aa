//! Decks that read well and mean something else than they seem to: each change is told with its code and its subject.

use serde_json::{Value, json};

use crate::DECK;
use crate::support::{read_json, root, said, scratch_copy, zelus};
use crate::table::{PRESSED, SLIDING, contact, load};

/// Heat and a structure on one mesh.
const COUPLED: &str = "examples/shrink_fit_by_cooling";

/// A change of a deck of tests/cases, and words of the message that `zelus check` gives then.
type Change = (&'static str, fn(&mut Value), &'static [&'static str]);

fn stepping(deck: &mut Value) -> &mut Value {
    &mut deck["solver_settings"]["time_stepping"]
}

const CHANGES: &[Change] = &[
    (
        PRESSED,
        |deck| {
            let process = &mut deck["processes"]["loads_process_list"][0];
            process["python_module"] = json!("assign_vector_by_direction_to_element_process");
            process["Parameters"]["model_part_name"] = json!("Structure.Upper");
        },
        &["warning[acts-on-nothing]", "no element of Structure.Upper takes LINE_LOAD", "warning[no-load]"],
    ),
    (
        PRESSED,
        |deck| load(deck)["variable_name"] = json!("REACTION"),
        &["warning[acts-on-nothing]", "no condition of Structure.Top takes REACTION", "warning[no-load]"],
    ),
    (
        PRESSED,
        |deck| *stepping(deck) = json!({"time_step": 1e30}),
        &["warning[time-step]", "the run from 0 to 1 is shorter"],
    ),
    (
        PRESSED,
        |deck| *stepping(deck) = json!({"time_step": 1.0, "time_step_table": [[0.0, 0.5], [1.0, 0.5]]}),
        &["warning[time-step]", "\"time_step\" alone acts"],
    ),
    (
        PRESSED,
        |deck| {
            let halves = json!({"a": {"interval": [0.0, 0.6], "time_step": 0.5}, "b": {"interval": [0.4, 1.0], "time_step": 0.5}});
            *stepping(deck) = json!({"time_step_intervals": halves});
        },
        &["warning[time-step]", "contain the times from 0.4 to 0.6"],
    ),
    (
        PRESSED,
        |deck| contact(deck)["search_parameters"] = json!({"normal_orientation_threshold": 2.5}),
        &["error[out-of-range]", "normal_orientation_threshold", "at least 0 and below 2"],
    ),
    (
        PRESSED,
        |deck| contact(deck)["advance_ALM_parameters"] = json!({"scale_factor": 1e6}),
        &["warning[key-without-effect]", "\"advance_ALM_parameters.manual_ALM\" is false"],
    ),
    (
        PRESSED,
        |deck| {
            deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "amgcl", "tolerance": "small"})
        },
        &["error[wrong-type]", "a number"],
    ),
    (
        PRESSED,
        |deck| deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "cg", "max_iteration": -5}),
        &["error[out-of-range]", "\"max_iteration\"", "at least 1"],
    ),
    (
        SLIDING,
        |deck| contact(deck)["friction_coefficients"] = json!({"0": 30.0}),
        &["warning[large-friction]", "the largest FRICTION_COEFFICIENT is 30"],
    ),
];

/// Messages of `zelus check` on a changed copy of a case, or of an example where its name begins with "examples/".
fn check(case: &str, change: impl Fn(&mut Value), files: impl Fn(&std::path::Path)) -> String {
    let folder = if case.starts_with("examples/") { root().join(case) } else { root().join("tests/cases").join(case) };
    let scratch = scratch_copy(&folder);
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    change(&mut deck);
    std::fs::write(&path, deck.to_string()).expect("the deck");
    files(scratch.path());
    said(&zelus(scratch.path(), &["check", DECK]))
}

#[test]
fn a_change_of_meaning_is_told() {
    for (case, change, words) in CHANGES {
        let said = check(case, change, |_| ());
        let missing: Vec<&&str> = words.iter().filter(|word| !said.contains(**word)).collect();
        assert!(missing.is_empty(), "{case}: {missing:?} in {said}");
    }
}

#[test]
fn words_that_a_key_does_not_know_are_refused() {
    let explicit = "contact_3d/explicit_touch";
    let cases: [(&str, fn(&mut Value), &str); 4] = [
        ("examples/transient_slab", |deck| deck["solver_settings"]["gradients"] = json!("at_center"), "at_centre"),
        (
            PRESSED,
            |deck| {
                deck["output_processes"]["pictures"] = json!([{"python_module": "vtu_output_process",
                    "Parameters": {"model_part_name": "Structure", "file_format": "asci"}}]);
            },
            "ascii",
        ),
        (COUPLED, |deck| deck["solver_settings"]["time_integration_method"] = json!("implict"), "implicit"),
        (explicit, |deck| deck["solver_settings"]["builder_and_solver_settings"] = json!({"type": "blok"}), "block"),
    ];
    for (case, change, remedy) in cases {
        let said = check(case, change, |_| ());
        assert!(said.contains("error[") && said.contains(&format!("did you mean \"{remedy}\"")), "{case}: {said}");
    }
    let said = check(COUPLED, |deck| deck["solver_settings"]["domain_size"] = json!("two"), |_| ());
    assert!(said.contains("error[wrong-type]") && said.contains("domain_size"), "{said}");
}

#[test]
fn keys_of_free_objects_that_nothing_reads_are_told() {
    let cases: [(&str, fn(&mut Value) -> &mut Value); 5] = [
        (PRESSED, |deck| &mut deck["solver_settings"]["solving_strategy_settings"]["advanced_settings"]),
        (PRESSED, |deck| &mut deck["solver_settings"]["builder_and_solver_settings"]["advanced_settings"]),
        (COUPLED, |deck| &mut deck["solver_settings"]["thermal_solver_settings"]["linear_solver_settings"]),
        (COUPLED, |deck| &mut deck["solver_settings"]["thermal_solver_settings"]["model_import_settings"]),
        ("mpc/mapped_field", |deck| {
            let lists = deck["processes"].as_object_mut().expect("lists of processes");
            let all = lists.values_mut().filter_map(Value::as_array_mut).flatten();
            let mapper = all.into_iter().find(|process| process["python_module"] == "simple_mortar_mapper_process");
            &mut mapper.expect("a mapper")["Parameters"]["linear_solver_settings"]
        }),
    ];
    for (case, object) in cases {
        let said = check(case, |deck| object(deck)["tolerence"] = json!(1e-3), |_| ());
        assert!(
            said.contains("warning[unknown-key-ignored]") && said.contains("nothing reads \"tolerence\""),
            "{case}: {said}"
        );
    }
    let other = |deck: &mut Value| {
        deck["solver_settings"]["thermal_solver_settings"]["time_stepping"] = json!({"time_step": 7.0})
    };
    let said = check(COUPLED, other, |_| ());
    assert!(said.contains("warning[time-step]") && said.contains("thermal_solver_settings.time_stepping"), "{said}");
}

#[test]
fn constants_that_the_law_at_hand_does_not_take_are_told() {
    for (name, words) in [
        ("YIELD_STRESS", "LinearElasticPlaneStrain2DLaw does not take it"),
        ("THERMAL_EXPANSION_COEFFICIENT", "LinearElasticPlaneStrain2DLaw does not take it"),
        ("FRICTION_COEFFICIENT", "is 0.4, and contact of pair \"0\" is without friction"),
    ] {
        let said = check(
            PRESSED,
            |_| (),
            |folder| {
                let path = folder.join("StructuralMaterials.json");
                let mut document = read_json(&path).expect("materials");
                document["properties"][0]["Material"]["Variables"][name] = json!(0.4);
                std::fs::write(&path, document.to_string()).expect("materials");
            },
        );
        assert!(said.contains("warning[variable-without-effect]") && said.contains(words), "{name}: {said}");
    }
}

#[test]
fn heat_and_wear_around_an_axis_that_bodies_do_not_have_are_told() {
    for (case, around) in
        [("examples/bars_in_thermal_contact", true), ("examples/brake_disc", false), ("examples/worn_pin", true)]
    {
        let said = check(
            case,
            |deck| {
                let lists = deck["processes"].as_object_mut().expect("lists of processes");
                for process in lists.values_mut().filter_map(Value::as_array_mut).flatten() {
                    if ["thermal_contact_process", "wear_process"].iter().any(|name| process["python_module"] == *name)
                    {
                        process["Parameters"]["axisymmetric"] = json!(around);
                    }
                }
            },
            |_| (),
        );
        assert!(said.contains("warning[contact-of-revolution]"), "{case}: {said}");
    }
}

#[test]
fn a_heat_face_that_is_listed_twice_is_told() {
    let twice = |folder: &std::path::Path| {
        let path = folder.join("slab.mdpa");
        let mesh = std::fs::read_to_string(&path).expect("the mesh");
        let first = "Begin Conditions LineCondition2D2N\n";
        assert!(mesh.contains(first), "faces");
        std::fs::write(&path, mesh.replacen(first, &format!("{first}9001 0 1 3\n"), 1)).expect("the mesh");
    };
    let said = check("examples/transient_slab", |_| (), twice);
    assert!(said.contains("warning[listed-twice]") && said.contains("1 conditions"), "{said}");
}

#[test]
fn rows_of_tables_without_order_are_told() {
    let reversed = |deck: &mut Value| *stepping(deck) = json!({"time_step_table": [[1.0, 0.5], [0.0, 0.5]]});
    let said = check(PRESSED, reversed, |_| ());
    assert!(said.contains("warning[table-rows]") && said.contains("goes back from 1 to 0 in row 2"), "{said}");
    let rows = "time,pressure\n0.0,1.0e6\n4.0,2.0e6\n2.0,3.0e6\n";
    let said = check(
        "structural/load_table",
        |_| (),
        |folder| std::fs::write(folder.join("load.csv"), rows).expect("a table"),
    );
    assert!(said.contains("warning[table-rows]") && said.contains("load.csv goes back from 4 to 2"), "{said}");
}

#[test]
fn tables_that_begin_late_or_lack_values_are_told() {
    let with = |rows: &str| {
        check("structural/load_table", |_| (), |folder| std::fs::write(folder.join("load.csv"), rows).expect("a table"))
    };
    let late = with("time,pressure\n3.0,1.0e6\n4.0,2.0e6\n");
    assert!(late.contains("warning[table-begins-late]") && late.contains("begins at time 3"), "{late}");
    let empty = with("time,pressure\n0.0,1.0e6\n2.0,\n4.0,2.0e6\n");
    assert!(empty.contains("warning[missing-values]") && empty.contains("1 empty cell, which counts as 0"), "{empty}");
}

#[test]
fn a_loaded_face_within_a_body_is_told() {
    // Node 13 is at the other end of the body; the other nodes are those of an edge between two elements.
    let across = loaded_line(|[first, _], _| [first, "13".to_owned()]);
    assert!(
        across.contains("warning[loose-load]") && across.contains("1 condition with a load is on no face"),
        "{across}"
    );
    let inner = loaded_line(|_, elements| {
        let edges = |nodes: &[String]| -> Vec<[String; 2]> {
            let count = nodes.len();
            let edge = |at: usize| [nodes[at].clone(), nodes[(at + 1) % count].clone()];
            (0..count).map(edge).collect()
        };
        let all: Vec<[String; 2]> = elements.iter().flat_map(|nodes| edges(nodes)).collect();
        let shared = all.iter().find(|[a, b]| all.contains(&[b.clone(), a.clone()]));
        shared.expect("an edge between two elements").clone()
    });
    assert!(inner.contains("1 condition with a load is on a face between two elements"), "{inner}");
}

/// Messages of `check` when the first loaded line of the pressed blocks has other nodes, chosen from its own and those of the elements.
fn loaded_line(choose: impl Fn([String; 2], &[Vec<String>]) -> [String; 2]) -> String {
    check(
        PRESSED,
        |_| (),
        |folder| {
            let path = folder.join("mesh.mdpa");
            let mesh = std::fs::read_to_string(&path).expect("the mesh");
            let begin = mesh.find("Begin Conditions LineLoadCondition2D2N").expect("loaded lines");
            let first = mesh[begin..].lines().nth(1).expect("a condition").to_owned();
            let words: Vec<&str> = first.split_whitespace().collect();
            let of_elements = &mesh[mesh.find("Begin Elements").expect("elements")..];
            let rows = of_elements.lines().skip(1).take_while(|line| !line.starts_with("End"));
            let elements: Vec<Vec<String>> =
                rows.map(|row| row.split_whitespace().skip(2).map(str::to_owned).collect()).collect();
            let [a, b] = choose([words[2].to_owned(), words[3].to_owned()], &elements);
            let changed = [words[0], words[1], &a, &b].join(" ");
            std::fs::write(&path, mesh.replacen(&first, &changed, 1)).expect("the mesh");
        },
    )
}

#[test]
fn a_planar_model_with_heights_is_told() {
    let lifted = check(
        PRESSED,
        |_| (),
        |folder| {
            let path = folder.join("mesh.mdpa");
            let mesh = std::fs::read_to_string(&path).expect("the mesh");
            let first =
                mesh.lines().skip_while(|line| !line.contains("Begin Nodes")).nth(1).expect("a node").to_owned();
            let (rest, _) = first.trim_end().rsplit_once(char::is_whitespace).expect("three coordinates");
            std::fs::write(&path, mesh.replacen(&first, &format!("{rest} 0.37"), 1)).expect("the mesh");
        },
    );
    assert!(lifted.contains("warning[out-of-plane]") && lifted.contains("from 0 to 0.37"), "{lifted}");
}

#[test]
fn unlike_friction_of_both_sides_is_told() {
    let materials = "StructuralMaterials.json";
    let unlike = |folder: &std::path::Path| {
        let path = folder.join(materials);
        let mut document = read_json(&path).expect("materials");
        let sides = document["properties"].as_array_mut().expect("a list");
        assert!(sides.len() > 1, "two materials");
        for (at, side) in sides.iter_mut().enumerate() {
            side["Material"]["Variables"]["FRICTION_COEFFICIENT"] = json!(0.1 + 0.2 * at as f64);
        }
        std::fs::write(&path, document.to_string()).expect("materials");
    };
    let said = check(SLIDING, |_| (), unlike);
    assert!(said.contains("that of the slave counts"), "{said}");
}
