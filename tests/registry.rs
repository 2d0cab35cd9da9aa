//! What holds for everything a deck can name.

mod support;

use std::collections::BTreeSet;
use std::path::Path;
use support::root;
use zelus as _;
use zelus_core::parameters::{Defaults, Document, Settings};
use zelus_core::registry::{Kind, duplicates, entries, require};

#[test]
fn every_name_is_registered_once() {
    assert!(duplicates().is_empty(), "{}", duplicates().join("\n"));
}

#[test]
fn the_program_links_every_application() {
    let kinds: BTreeSet<Kind> = entries().iter().map(|entry| entry.kind).collect();
    for kind in [
        Kind::Element,
        Kind::Condition,
        Kind::ConstitutiveLaw,
        Kind::Process,
        Kind::ConvergenceCriterion,
        Kind::LinearSolver,
    ] {
        assert!(kinds.contains(&kind), "no {} is registered", kind.word());
    }
    let names: BTreeSet<&str> = entries().iter().map(|entry| entry.name).collect();
    for name in ["SmallDisplacementElement2D4N", "LinearElastic3DLaw", "alm_contact_process", "json_output_process"] {
        assert!(names.contains(name), "{name} is not registered");
    }
}

#[test]
fn every_name_says_what_it_is_and_where_it_lives() {
    let mut problems = Vec::new();
    for entry in entries() {
        let place = format!("{} {} ({}:{})", entry.kind.word(), entry.name, entry.file, entry.line);
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

/// What `--like` lays under a deck must be settings that the object takes.
#[test]
fn defaults_of_other_programs_are_settings() {
    let mut problems = Vec::new();
    for entry in entries() {
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
        (Kind::Element, "ShellThinElement3D3N", "mesh the thickness"),
        (
            Kind::Element,
            "SmallDisplacementMixedVolumetricStrainOssElement2D3N",
            "SmallDisplacementMixedVolumetricStrainElement",
        ),
        (Kind::Element, "TotalLagrangianQ1P0MixedElement2D4N", "TotalLagrangianMixedVolumetricStrainElement2D3N"),
        (Kind::Condition, "PointMomentCondition3D1N", "PointLoadCondition"),
        (Kind::Condition, "DisplacementControlCondition3D1N", "arc_length"),
        (
            Kind::ConstitutiveLaw,
            "SmallStrainIsotropicPlasticityPlaneStressVonMisesVonMises",
            "SmallDisplacementElement3D8N",
        ),
        (Kind::ConstitutiveLaw, "SmallStrainIsotropicPlasticity3DTrescaTresca", "VonMisesVonMises"),
        (Kind::ConstitutiveLaw, "SerialParallelRuleOfMixturesLaw3D", "ParallelRuleOfMixturesLaw3D"),
        (Kind::Scheme, "relaxation", "pseudo_static"),
        (Kind::Scheme, "multi_stage", "central_differences"),
        (Kind::Solver, "eigen_value", "Static"),
    ] {
        let said = require(kind, name).expect_err(name).to_string();
        assert!(said.contains(words), "{name}: no {words:?} in {said}");
    }
}
