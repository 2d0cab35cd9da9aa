use zelus_core::parameters::Document;
use zelus_core::registry::named;

use crate::law::{OverclosureLaw, OverclosureLawEntry};

fn law(text: &str) -> zelus_core::Result<Box<dyn OverclosureLaw>> {
    let (entry, settings) =
        named::<OverclosureLawEntry>(&Document::from_str(text, "deck.json").expect("JSON").root, "law")?;
    (entry.build)(&settings)
}

const LAWS: [&str; 2] = [
    r#"{"law": "table", "rows": [[-0.1, 0.0], [0.3, 2.0], [0.4, 5.0]]}"#,
    r#"{"law": "exponential", "pressure": 3.0, "clearance": 0.2}"#,
];

#[test]
fn compliances_are_derivatives() {
    for text in LAWS {
        let law = law(text).expect("a law");
        for pressure in [1e-3, 0.4, 1.7, 3.0, 4.5, 60.0] {
            let step = 1e-5 * pressure;
            let depth = |p: f64| law.overclosure(p).depth;
            let slope = (depth(pressure + step) - depth(pressure - step)) / (2.0 * step);
            let compliance = law.overclosure(pressure).compliance;
            assert!((slope - compliance).abs() < 1e-5 * compliance, "{text} at {pressure}: {compliance}, {slope}");
        }
    }
}

/// ANALYTIC: the rows of a table, its last slope beyond them; the formula of the exponential law.
#[test]
fn depths_are_those_of_the_laws() {
    let table = law(LAWS[0]).expect("a law");
    for (pressure, depth) in [(0.0, -0.1), (1.0, 0.1), (2.0, 0.3), (3.5, 0.35), (8.0, 0.5)] {
        assert!((table.overclosure(pressure).depth - depth).abs() < 1e-15);
    }
    let exponential = law(LAWS[1]).expect("a law");
    assert_eq!(exponential.overclosure(0.0).depth, -0.2);
    for depth in [-0.15_f64, 0.0, 0.1, 1.5] {
        let x = 1.0 + depth / 0.2;
        let pressure = 3.0 / (std::f64::consts::E - 1.0) * x * (x.exp() - 1.0);
        assert!((exponential.overclosure(pressure).depth - depth).abs() < 1e-13, "{depth}");
    }
}

#[test]
fn tables_that_do_not_grow_are_refused() {
    for rows in ["[[0.0, 0.0]]", "[[0.0, 0.0], [0.1, 0.0]]", "[[0.0, 1.0], [0.1, 2.0]]", "[[0.1, 0.0], [0.2, 1.0]]"] {
        let Err(error) = law(&format!(r#"{{"law": "table", "rows": {rows}}}"#)) else { panic!("{rows}") };
        assert!(error.to_string().contains("growing from row to row"), "{error}");
    }
}
