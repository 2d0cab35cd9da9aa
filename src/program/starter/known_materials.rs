//! Materials by name, in N, mm and t, with their sources.

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_meshes::mesh::Material;

/// A material of a standard or handbook.
struct KnownMaterial {
    name: &'static str,
    source: &'static str,
    young: f64,
    poisson: f64,
    density: f64,
}

const ALL: [KnownMaterial; 5] = [
    KnownMaterial { name: "aluminium", source: "EN 1999-1-1, 3.2.5", young: 70_000.0, poisson: 0.3, density: 2.7e-9 },
    KnownMaterial {
        name: "concrete",
        source: "C30/37, EN 1992-1-1, 3.1.3 and Table 3.1, uncracked",
        young: 33_000.0,
        poisson: 0.2,
        density: 2.4e-9,
    },
    KnownMaterial {
        name: "stainless_steel",
        source: "1.4301, EN 1993-1-4, 2.1.3",
        young: 200_000.0,
        poisson: 0.3,
        density: 7.9e-9,
    },
    KnownMaterial { name: "steel", source: "EN 1993-1-1, 3.2.6", young: 210_000.0, poisson: 0.3, density: 7.85e-9 },
    KnownMaterial { name: "titanium", source: "Ti-6Al-4V, MMPDS", young: 110_000.0, poisson: 0.31, density: 4.43e-9 },
];

/// A material by its name, with its source in the name.
///
/// # Errors
/// A name that is not known.
pub(super) fn find(name: &str) -> Result<Material> {
    let wanted = name.to_lowercase().replace(['-', ' '], "_");
    let known = ALL.iter().find(|own| own.name == wanted).ok_or_else(|| {
        let names: Vec<&str> = ALL.iter().map(|own| own.name).collect();
        let near = did_you_mean(&wanted, names.iter().copied()).unwrap_or_default();
        let problem = Diagnostic::error("unknown-name", format!("there is no material {name:?} by name; {near}"));
        problem.remedy(format!("names are {}; others are stated in StructuralMaterials.json", names.join(", ")))
    })?;
    Ok(Material {
        name: format!("{} ({})", known.name, known.source),
        young: Some(known.young),
        poisson: known.poisson,
        density: known.density,
        ..Material::default()
    })
}
