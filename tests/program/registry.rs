//! Rules for every object that a deck can name.

use crate::support::{root, zelus};
use std::collections::BTreeSet;
use std::path::Path;
use zelus as _;
use zelus_core::parameters::{Defaults, Document, Settings};
use zelus_core::registry::{duplicates, entries, require_of};

#[test]
fn every_name_is_registered_once() {
    assert!(duplicates().is_empty(), "{}", duplicates().join("\n"));
}

#[test]
fn the_program_links_every_application() {
    let kinds: BTreeSet<&str> = entries().iter().map(|(kind, _)| *kind).collect();
    for kind in ["element", "condition", "constitutive_law", "process", "convergence_criterion", "linear_solver"] {
        assert!(kinds.contains(kind), "no {kind} is registered");
    }
    let names: BTreeSet<&str> = entries().iter().map(|(_, entry)| entry.name).collect();
    for name in ["SmallDisplacementElement2D4N", "LinearElastic3DLaw", "alm_contact_process", "json_output_process"] {
        assert!(names.contains(name), "{name} is not registered");
    }
}

#[test]
fn every_name_says_what_it_is_and_where_it_lives() {
    let mut problems = Vec::new();
    for (kind, entry) in entries() {
        let place = format!("{kind} {} ({}:{})", entry.name, entry.file, entry.line);
        if entry.about.trim().is_empty() {
            problems.push(format!("{place} does not say what it is"));
        }
        if !root().join(entry.file).is_file() {
            problems.push(format!("{place}: there is no such file"));
        }
        if !entry.defaults.is_empty()
            && let Err(error) = Defaults::parse(entry.name, entry.defaults)
        {
            problems.push(format!("{place}: {error}"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Kinds of names, input, output and settings, which no equation defines.
const WITHOUT_MATHEMATICS: [&str; 7] =
    ["flag", "mesh_format", "modeler", "output_format", "process", "solver_extension", "variable"];

/// Objects that compute cite their formula or literature; equations of the specification are those of the table in `docs/theory`.
#[test]
fn mathematics_cites_its_source() {
    let table = std::fs::read_to_string(root().join("docs/theory/equations.md")).expect("the table");
    let first_cells = table.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
    let listed: String = first_cells.map(|cell| cell.replace('–', "–, ")).collect::<Vec<_>>().join(", ");
    let mut problems = Vec::new();
    for (kind, entry) in entries() {
        let place = format!("{kind} {} ({}:{})", entry.name, entry.file, entry.line);
        let computes = !WITHOUT_MATHEMATICS.contains(&kind) && !entry.about.contains("without physics");
        if computes && entry.source.is_empty() {
            problems.push(format!("{place} cites nothing"));
        }
        for sentence in
            entry.source.split(';').filter(|sentence| sentence.contains("eq. ") || sentence.contains("eqs. "))
        {
            let numbers = sentence.split([' ', ',']).filter(|word| word.starts_with("D.") || word.starts_with("4."));
            for number in numbers.map(|word| word.split('–').next().unwrap_or(word)) {
                let number = number.trim_end_matches(|c: char| !c.is_ascii_digit());
                if !listed.split(", ").any(|known| known.trim_end_matches(|c: char| !c.is_ascii_digit()) == number) {
                    problems.push(format!("{place}: eq. {number} is not in docs/theory/equations.md"));
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Settings that `--like` gives must be settings that the object takes.
#[test]
fn defaults_of_other_programs_are_settings() {
    let mut problems = Vec::new();
    for (_, entry) in entries() {
        for (program, values) in entry.like {
            let laid = Document::from_str(values, Path::new(entry.name)).unwrap().root;
            let defaults = Defaults::parse(entry.name, entry.defaults).unwrap();
            if let Err(error) = Settings::check(&laid, &defaults) {
                problems.push(format!("{} like {program}: {error}", entry.name));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Of several beginnings that fit a name the longest counts.
#[test]
fn known_names_that_are_not_there_say_what_to_use_instead() {
    for (kind, name, words) in [
        ("element", "ShellThinElement3D3N", "mesh the thickness"),
        (
            "element",
            "SmallDisplacementMixedVolumetricStrainOssElement2D3N",
            "SmallDisplacementMixedVolumetricStrainElement",
        ),
        ("element", "TotalLagrangianQ1P0MixedElement2D3N", "TotalLagrangianMixedVolumetricStrainElement2D3N"),
        ("condition", "DisplacementControlCondition3D1N", "arc_length"),
        (
            "constitutive_law",
            "SmallStrainIsotropicPlasticityPlaneStressVonMisesVonMises",
            "SmallDisplacementElement3D8N",
        ),
        ("constitutive_law", "SmallStrainIsotropicPlasticity3DTrescaTresca", "VonMisesVonMises"),
        ("constitutive_law", "SerialParallelRuleOfMixturesLaw3D", "ParallelRuleOfMixturesLaw3D"),
        ("scheme", "relaxation", "pseudo_static"),
        ("scheme", "multi_stage", "central_differences"),
        ("solver", "eigen_value", "Static"),
        ("variable", "MAX_GAP_FACTOR", "max_gap_factor"),
    ] {
        let said = require_of(kind, name).expect_err(name).to_string();
        assert!(said.contains(words), "{name}: no {words:?} in {said}");
    }
}

/// Names that users of the reference program ask for are answered: by the object, or by where its work is done.
#[test]
fn names_of_the_reference_program_are_answered() {
    let text = std::fs::read_to_string(root().join("configs/kratos_names.json")).expect("the names");
    let listed = Document::from_str(&text, Path::new("kratos_names.json")).expect("JSON").root;
    let listed: Vec<(String, String)> = listed
        .as_object()
        .expect("an object")
        .iter()
        .map(|member| (member.key.clone(), member.node.as_str().expect("a sentence").to_owned()))
        .collect();
    assert!(listed.len() > 80, "hardly any names are listed");
    let known: BTreeSet<&str> = entries().iter().flat_map(|(_, entry)| entry.names()).collect();
    let mut problems = Vec::new();
    for (name, sentence) in &listed {
        if known.contains(name.as_str()) {
            problems.push(format!("{name} is registered: it needs no sentence"));
        }
        for quoted in sentence.split('`').skip(1).step_by(2) {
            let is_path = quoted.contains('/') && !quoted.contains(' ');
            if is_path && !root().join(quoted).exists() {
                problems.push(format!("{name}: there is no {quoted}"));
            }
        }
    }
    let asked = [
        "MeshTyingMortarCondition",
        "MPCMortarContactCondition",
        "LinearMasterSlaveConstraint",
        "SmallDisplacementElement",
        "AdvancedContactSearchProcess3D4N3N",
        "CoulombFrictionalLaw3D3NNV",
        "ShellThinElement3D3N",
        "SimpleMortarMapperProcess",
        "ALMFrictionlessMortarContactCondition",
        "ALMContactProcess",
        "alm_variables_calculation_process",
    ];
    for name in listed.iter().map(|(name, _)| name.as_str()).chain(asked) {
        let output = zelus(&root(), &["describe", name]);
        if !output.status.success() {
            problems.push(format!("{name} is not answered"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// The example of `describe` is taken by the object.
#[test]
fn examples_fit_the_settings_of_their_objects() {
    for (kind, entry) in entries().into_iter().filter(|(_, entry)| !entry.defaults.is_empty()) {
        let defaults = Defaults::parse(entry.name, entry.defaults).unwrap();
        let example = defaults.example().unwrap_or_else(|| panic!("{kind} {} has no example", entry.name)).clone();
        if let Err(error) = Settings::check(&example, &defaults) {
            panic!("the example of {kind} {}: {error}", entry.name);
        }
    }
}

#[test]
fn describe_shows_an_example_of_every_kind_of_object() {
    let shown = |name: &str| {
        let output = zelus(&root(), &["describe", name]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let example = text.split("  example:\n").nth(1).unwrap_or_else(|| panic!("no example of {name} in {text}"));
        example.lines().map(|line| &line[4..]).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(
        shown("SmallDisplacementElement2D4N"),
        "Begin Elements SmallDisplacementElement2D4N\n    1 1 1 2 3 4\nEnd Elements"
    );
    let json = |name: &str| serde_json::from_str::<serde_json::Value>(&shown(name)).expect("an example in JSON");
    assert_eq!(json("alm_contact_process")["python_module"], "alm_contact_process");
    assert_eq!(json("bossak")["solver_settings"]["scheme_type"], "bossak");
    assert_eq!(json("LinearElastic3DLaw")["Material"]["constitutive_law"]["name"], "LinearElastic3DLaw");
    assert_eq!(json("SmallStrainUMAT3DLaw")["Material"]["Variables"]["UDSM_NAME"], "libumat.so");
    assert_eq!(json("FunctionLaw3D")["Material"]["Variables"]["LAW_FUNCTION"], "my_law");
    assert_eq!(json("gmsh")["solver_settings"]["model_import_settings"]["input_type"], "gmsh");
}

/// Variables, flags and keys of the specification are described: as what they are, or by the setting in their place.
#[test]
fn names_of_the_specification_are_described() {
    let answers = [
        ("INITIAL_PENALTY", "variable INITIAL_PENALTY [number]"),
        ("WEIGHTED_SLIP_X", "variable WEIGHTED_SLIP [3 components]"),
        ("ACTIVE", "flag ACTIVE\n"),
        ("SLAVE", "flag SLAVE\n"),
        ("ISOLATED", "flag ISOLATED\n"),
        ("RIGID", "which nothing reads"),
        ("MAX_GAP_FACTOR", "set `max_gap_factor` of `advance_ALM_parameters`"),
        ("MAX_GAP_THRESHOLD", "set `max_gap_threshold`"),
        ("ADAPT_PENALTY", "set `adapt_penalty`"),
        ("REACTION_CHECK_STIFFNESS_FACTOR", "set `reaction_check_stiffness_factor`"),
        ("NODAL_PAUX", "not there; use CONTACT_PRESSURE"),
        ("CONSTRAINT_POINTER", "not there; `mpc_contact_process` owns"),
        ("advance_ALM_parameters", "an object with the keys manual_ALM, stiffness_factor, penalty_scale_factor"),
        ("penalty_scale_factor", "a number, by default 1.0; above 0\n  ratio of scale factor and penalty"),
        ("advance_ALM_parameters.max_gap_factor", "without effect unless advance_ALM_parameters.adapt_penalty is true"),
        ("reaction_check_stiffness_factor", "a number, by default 1e-10; at least 0"),
        ("condn_convergence_criterion", "of solver_extension contact_settings"),
        ("last_step", "one of automatic, shortened, whole, while_below, by default \"automatic\""),
        ("skiprows", "of table csv_table"),
    ];
    let mut problems = Vec::new();
    for (name, words) in answers {
        let text = String::from_utf8_lossy(&zelus(&root(), &["describe", name]).stdout).into_owned();
        if !text.contains(words) {
            problems.push(format!("{name}: no {words:?} in {text}"));
        }
    }
    let all = String::from_utf8_lossy(&zelus(&root(), &["list", "all"]).stdout).into_owned();
    for line in [
        "variable (",
        "flag (",
        "kratos_name (",
        "  ISOLATED: ",
        "  MAX_GAP_FACTOR…: not there; ",
        "  MPCContactCriteria: ",
    ] {
        if !all.contains(line) {
            problems.push(format!("`zelus list all` has no {line:?}"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
