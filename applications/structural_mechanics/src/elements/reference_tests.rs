//! Elements against the numbers of Kratos in `reference_elements.txt`, on one distorted, deformed cell each.

use crate::test_model::{Single, reference_cell, size, weighted};
use zelus_core::entities::find_kind;
use zelus_core::model::EntityRole;

fn double_weighted(matrix: &[f64], rows: usize) -> f64 {
    let products: Vec<f64> =
        matrix.chunks(rows).map(|row| row.iter().enumerate().map(|(c, v)| v * (c as f64).sin()).sum()).collect();
    weighted(&products)
}

#[test]
fn agrees_with_the_reference_program() {
    let mut wrong = Vec::new();
    let lines: Vec<&str> = include_str!("reference_elements.txt").lines().filter(|l| !l.starts_with('#')).collect();
    for line in &lines {
        let words: Vec<&str> = line.split(' ').collect();
        let [name, law, more, tolerance] = words[..4] else { panic!("{line}") };
        let tolerance: f64 = tolerance.parse().unwrap();
        let entry = find_kind(EntityRole::Element, name).unwrap();
        let (x, u) = reference_cell(entry.cell.unwrap(), entry.space);
        let mut values = vec![("YOUNG_MODULUS", 100.0), ("POISSON_RATIO", 0.3), ("DENSITY", 2.0), ("THICKNESS", 0.5)];
        let more = more.split(',').filter_map(|pair| pair.split_once('='));
        values.extend(more.map(|(name, value)| (name, value.parse::<f64>().unwrap())));
        let mut single = Single::new(EntityRole::Element, name, Some(law), &values, &x);
        single.displace(&u);
        let (k, rhs) = single.system();
        let (consistent, lumped) = (single.mass(false), single.mass(true));
        let cauchy = single.gauss("CAUCHY_STRESS_VECTOR").values;
        let von_mises = single.gauss("VON_MISES_STRESS").values;
        let rows = rhs.len();
        let checks = [
            ("forces", weighted(&rhs), size(&rhs)),
            ("tangent", double_weighted(&k, rows), size(&k)),
            ("mass", double_weighted(&consistent, rows), size(&consistent)),
            ("lumped mass", double_weighted(&lumped, rows), size(&lumped)),
            ("Cauchy stress", weighted(&cauchy), size(&cauchy)),
            ("von Mises stress", weighted(&von_mises), size(&von_mises)),
        ];
        assert_eq!(words.len(), 4 + checks.len(), "{line}");
        for ((what, value, scale), reference) in checks.into_iter().zip(&words[4..]).filter(|(_, word)| **word != "-") {
            let reference: f64 = reference.parse().unwrap();
            if (value - reference).abs() > tolerance * scale * rows as f64 {
                wrong.push(format!("{name} {law} {what}: {value} instead of {reference}, size {scale}"));
            }
        }
    }
    assert!(lines.len() >= 40 && wrong.is_empty(), "{} lines\n{}", lines.len(), wrong.join("\n"));
}
