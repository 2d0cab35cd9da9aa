//! Energies of `*HYPERELASTIC`: constants, then D₁ = 2/κ of the volume.

use zelus_core::diagnostics::Result;

use super::cards::Card;
use crate::mesh::Rubber;

/// The energy of a card, and whether it has further constants of the volume; `None` of energies that are not read.
///
/// # Errors
/// Numbers that are missing or are none.
pub(super) fn of(card: &Card) -> Result<Option<(Rubber, bool)>> {
    let has = |word: &str| card.get(word).is_some();
    let terms = card.get("N").map(|field| card.number(field, card.place().line)).transpose()?.unwrap_or(1.0);
    if has("TEST DATA INPUT") || !(1.0..=6.0).contains(&terms) || terms.fract() != 0.0 {
        return Ok(None);
    }
    let numbers = card.all_numbers()?;
    let n = terms as usize;
    let two = |a: f64, b: f64| vec![("C10", vec![a]), ("C01", vec![b])];
    let needed = match () {
        () if has("NEO HOOKE") => 1,
        () if has("MOONEY-RIVLIN") || has("ARRUDA-BOYCE") => 2,
        () if has("YEOH") => 3,
        () if has("OGDEN") => 2 * n,
        // POLYNOMIAL is the energy that is meant where none is named
        () if has("REDUCED POLYNOMIAL") || has("VAN DER WAALS") || has("MARLOW") || has("USER") || n > 2 => {
            return Ok(None);
        }
        () => [2, 5][n - 1],
    };
    if numbers.len() < needed {
        return Err(card.wrong(format!("*HYPERELASTIC has {} constants instead of {needed}", numbers.len())));
    }
    let (given, of_volume) = numbers.split_at(needed);
    let (law, constants, shear_modulus) = match (given, has("OGDEN"), has("ARRUDA-BOYCE")) {
        (terms, true, _) => {
            let pairs = terms.as_chunks::<2>().0;
            let moduli = pairs.iter().map(|[modulus, exponent]| 2.0 * modulus / exponent).collect();
            let exponents = pairs.iter().map(|[_, exponent]| *exponent).collect();
            let sum = pairs.iter().map(|[modulus, _]| modulus).sum();
            ("HyperElasticOgden", vec![("OGDEN_MODULI", moduli), ("OGDEN_EXPONENTS", exponents)], sum)
        }
        (&[modulus, stretch], _, true) => {
            let constants = vec![("SHEAR_MODULUS", vec![modulus]), ("LOCKING_STRETCH", vec![stretch])];
            ("HyperElasticArrudaBoyce", constants, modulus)
        }
        (&[c10], ..) => ("HyperElasticMooneyRivlin", two(c10, 0.0), 2.0 * c10),
        (&[c10, c01], ..) => ("HyperElasticMooneyRivlin", two(c10, c01), 2.0 * (c10 + c01)),
        (&[c10, c20, c30], ..) => {
            ("HyperElasticYeoh", vec![("C10", vec![c10]), ("C20", vec![c20]), ("C30", vec![c30])], 2.0 * c10)
        }
        (&[c10, c01, c20, c11, c02], ..) => {
            let more = [("C20", vec![c20]), ("C11", vec![c11]), ("C02", vec![c02])];
            ("HyperElasticMooneyRivlin", two(c10, c01).into_iter().chain(more).collect(), 2.0 * (c10 + c01))
        }
        _ => return Ok(None),
    };
    let first = of_volume.first().copied().unwrap_or(0.0);
    let bulk_modulus = (first > 0.0).then(|| 2.0 / first);
    let further = of_volume.iter().skip(1).any(|constant| *constant != 0.0);
    Ok(Some((Rubber { law, constants, shear_modulus, bulk_modulus }, further)))
}
