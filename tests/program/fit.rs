//! `zelus fit`: constants of rubber from tables of test data.

use std::fmt::Write as _;
use std::path::Path;

use crate::support::{said, zelus};

/// A table of the closed form P = 2 (λ − λ⁻²)(C₁₀ + 2 C₂₀ x + 3 C₃₀ x²), x = λ² + 2/λ − 3, of Yeoh's material.
fn write_uniaxial(folder: &Path) {
    let mut text = "stretch, nominal stress\n# MPa\n".to_owned();
    for k in 1..=20 {
        let l = 1.0 + 0.1 * f64::from(k);
        let x = l * l + 2.0 / l - 3.0;
        let stress = 2.0 * (l - l.powi(-2)) * (0.5 - 0.02 * x + 0.003 * x * x);
        let _ = writeln!(text, "{l}, {stress}");
    }
    std::fs::write(folder.join("uniaxial.csv"), text).expect("a file");
}

/// ANALYTIC: 1e-8 of the constants; the file is one that materials are read from, the picture has the points.
#[test]
fn constants_of_a_table_are_written_as_a_material() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write_uniaxial(folder.path());
    for _ in 0..2 {
        let output =
            zelus(folder.path(), &["fit", "HyperElasticYeoh", "--uniaxial", "uniaxial.csv", "--bulk-modulus", "800"]);
        assert!(output.status.success(), "{}", said(&output));
        assert!(said(&output).contains("uniaxial: 20 points"), "{}", said(&output));
    }
    let text = std::fs::read_to_string(folder.path().join("fit.json")).expect("the material");
    assert!(text.contains("\"HyperElasticYeoh3DLaw\"") && text.contains("\"BULK_MODULUS\": 800.0"), "{text}");
    let number = |name: &str| -> f64 {
        let (_, rest) = text.split_once(&format!("\"{name}\": ")).expect("the constant");
        rest.split([',', '\n']).next().expect("a number").parse().expect("a number")
    };
    for (name, expected) in [("C10", 0.5), ("C20", -0.01), ("C30", 0.001)] {
        assert!((number(name) / expected - 1.0).abs() < 1e-8, "{name}: {}", number(name));
    }
    let picture = std::fs::read_to_string(folder.path().join("fit.svg")).expect("the picture");
    assert_eq!(picture.matches("<circle").count(), 21, "20 points and one of the legend");
    assert!(picture.contains("<polyline") && picture.contains("HyperElasticYeoh: data and fit"), "{picture}");
}

#[test]
fn wrong_tables_and_laws_are_named() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write_uniaxial(folder.path());
    let problem = |arguments: &[&str]| {
        let output = zelus(folder.path(), &[&["fit"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        said(&output)
    };
    let write = |text: &str| std::fs::write(folder.path().join("bad.csv"), text).expect("a file");
    assert!(problem(&["HyperElasticYeoh"]).contains("--uniaxial, --equibiaxial or --planar"));
    assert!(problem(&["LinearElastic3DLaw", "--uniaxial", "uniaxial.csv"]).contains("HyperElasticOgden"));
    assert!(problem(&["HyperElasticBlatzKo", "--uniaxial", "uniaxial.csv"]).contains("has no fit"));
    assert!(problem(&["HyperElasticYeoh", "--uniaxial", "none.csv"]).contains("none.csv"));
    write("1.1, 0.2\n1.2, high\n");
    assert!(problem(&["HyperElasticYeoh", "--planar", "bad.csv"]).contains("bad.csv:2"));
    write("0.1, 0.2\n0.2, 0.3\n");
    assert!(problem(&["HyperElasticYeoh", "--planar", "bad.csv"]).contains("1 + strain"));
    write("1.1, 0.2\n1.2, 0.3\n");
    assert!(
        problem(&["HyperElasticYeoh", "--planar", "bad.csv"]).contains("2 points do not determine the 3 constants")
    );
}
