//! The materials of a starter deck.

use zelus_core::diagnostics::Diagnostic;
use zelus_meshes::conditions::Axes;
use zelus_meshes::mesh::{Material, Mesh, Plane};

/// Young's modulus of steel in N and mm, where a mesh has no materials.
pub(super) const STEEL: f64 = 210_000.0;
/// Bulk modulus over the shear modulus of rubber that keeps its volume.
const BULK_RATIO: f64 = 1000.0;
/// Plastic strain and slope factor beyond a yield curve: its last stress stays.
const BEYOND: f64 = 10.0;

/// The file of materials: those of the mesh, else `whole`, else steel in newtons and millimetres for every body. Notes what no law has.
pub(super) fn text(mesh: &Mesh, space: usize, whole: Option<&Material>, said: &mut Vec<Diagnostic>) -> String {
    let mut entries = Vec::new();
    for (at, own) in parts(mesh).iter().enumerate() {
        let has_elasticity = |own: &&Material| own.young.is_some() || own.orthotropic.is_some() || own.rubber.is_some();
        let known = own.material.filter(has_elasticity);
        let remark = match (known, own.material) {
            (None, _) if whole.is_some() => whole.map(|material| material.name.clone()).unwrap_or_default(),
            (Some(material), _) if material.name.ends_with(')') => material.name.clone(),
            (Some(material), _) => format!("{}, from the mesh file", material.name),
            (None, Some(material)) => {
                format!("{}: the mesh file gives no elasticity; steel, in N and mm", material.name)
            }
            (None, None) => "steel, in N and mm: state your own".to_owned(),
        };
        let steel = Material { young: Some(STEEL), poisson: 0.3, ..Material::default() };
        let material = known.or(whole).unwrap_or(&steel);
        let about = mesh.material_axes.iter().find(|axes| format!("Structure.{}", axes.group) == own.part);
        let is_around = about.is_some_and(|axes| matches!(axes.axes, Axes::Cylindrical { .. }));
        let mut variables = elasticity(material, is_around);
        if material.density != 0.0 {
            variables.push(format!("\"DENSITY\": {:?}", material.density));
        }
        if own.thickness != 1.0 && space == 2 && mesh.plane != Some(Plane::Axial) {
            variables.push(format!("\"THICKNESS\": {:?}", own.thickness));
        }
        let expands = !mesh.temperatures.is_empty() && material.expansion.is_some();
        if let Some(expansion) = material.expansion.as_ref().filter(|_| expands) {
            let coefficient = expansion.table.first().map_or(0.0, |row| row[1]);
            variables.push(format!("\"THERMAL_EXPANSION_COEFFICIENT\": {coefficient:?}"));
            variables.push(format!("\"REFERENCE_TEMPERATURE\": {:?}", expansion.reference));
        }
        keeps_volume(material, said);
        let yields = !material.yield_curve.is_empty();
        let law = law(mesh, space, material, expands);
        if yields && !law.contains("Plasticity") {
            let fact = format!("{}: no law of plasticity fits these elements: it stays elastic", material.name);
            said.push(Diagnostic::warning("not-taken-over", fact).remedy("zelus list constitutive_law"));
        } else if yields {
            variables.extend(yielding(material));
        }
        let tables = if expands { tables(material) } else { String::new() };
        if !expands && !material.elastic_table.is_empty() {
            let fact = format!("{}: without temperatures the first line of its elasticity is used", material.name);
            said.push(Diagnostic::note("not-taken-over", fact));
        }
        entries.push(format!(
            r#"    {{ // {remark}
      "model_part_name": "{}",
      "properties_id": {},
      "Material": {{
        "constitutive_law": {{"name": "{law}"}},
        "Variables": {{{}}},
        "Tables": {{{tables}}}
      }}
    }}"#,
            own.part,
            at + 1,
            variables.join(", ")
        ));
    }
    format!("{{\n  \"properties\": [\n{}\n  ]\n}}\n", entries.join(",\n"))
}

/// The name of the law for the elements of the mesh.
fn law(mesh: &Mesh, space: usize, material: &Material, expands: bool) -> String {
    let (solid, plane) = (space == 3, mesh.plane);
    let heated = if expands { "Thermal" } else { "" };
    if material.rubber.is_some() || material.orthotropic.is_some() {
        let ending = match (solid, plane) {
            (true, _) => "3DLaw",
            (_, Some(Plane::Stress)) => "2DLaw",
            (_, Some(Plane::Axial)) => "Axisym2DLaw",
            (..) => "PlaneStrain2DLaw",
        };
        return match &material.rubber {
            // rubber in plane stress is not there: `check` names what fits
            Some(rubber) => format!("{}{ending}", rubber.law),
            None => format!("{heated}LinearElasticOrthotropic{ending}"),
        };
    }
    let ending = match (solid, plane) {
        (true, _) => Some("3D"),
        (_, Some(Plane::Stress)) => None,
        (_, Some(Plane::Axial)) => mesh.is_large.then_some("Axisym"),
        (..) => Some("PlaneStrain"),
    };
    if let Some(ending) = ending.filter(|_| !material.yield_curve.is_empty()) {
        let strain = if mesh.is_large { "Finite" } else { "Small" };
        return format!("{heated}{strain}StrainIsotropicPlasticity{ending}VonMisesVonMises");
    }
    match (solid, plane, expands) {
        (true, _, false) => "LinearElastic3DLaw",
        (true, _, true) => "ThermalElasticIsotropic3D",
        (_, Some(Plane::Stress), false) => "LinearElasticPlaneStress2DLaw",
        (_, Some(Plane::Stress), true) => "ThermalLinearPlaneStress",
        (_, Some(Plane::Axial), false) => "LinearElasticAxisym2DLaw",
        (_, Some(Plane::Axial), true) => "ThermalLinearAxisym",
        (_, _, false) => "LinearElasticPlaneStrain2DLaw",
        (_, _, true) => "ThermalLinearPlaneStrain",
    }
    .to_owned()
}

/// Notes the bulk modulus that rubber without one gets.
fn keeps_volume(material: &Material, said: &mut Vec<Diagnostic>) {
    if let Some(rubber) = material.rubber.as_ref().filter(|rubber| rubber.bulk_modulus.is_none()) {
        let bulk = BULK_RATIO * rubber.shear_modulus;
        let fact = format!(
            "{}: the mesh file gives no D1; BULK_MODULUS is {bulk:?}, 1000 times the shear modulus",
            material.name
        );
        said.push(Diagnostic::note("not-taken-over", fact));
    }
}

/// Elastic constants. Axis 2 of cylindrical axes runs along the cylinder here and around it in input files.
fn elasticity(material: &Material, is_around: bool) -> Vec<String> {
    if let Some(rubber) = &material.rubber {
        let number = |(name, values): &(&str, Vec<f64>)| match values.as_slice() {
            [one] if !name.starts_with("OGDEN") => format!("\"{name}\": {one:?}"),
            several => format!("\"{name}\": {several:?}"),
        };
        let bulk = rubber.bulk_modulus.unwrap_or(BULK_RATIO * rubber.shear_modulus);
        let constants = rubber.constants.iter().map(number);
        return constants.chain([format!("\"BULK_MODULUS\": {bulk:?}")]).collect();
    }
    let Some([e1, e2, e3, n12, n13, n23, g12, g13, g23]) = material.orthotropic else {
        let young = material.young.unwrap_or_default();
        return vec![format!("\"YOUNG_MODULUS\": {young:?}"), format!("\"POISSON_RATIO\": {:?}", material.poisson)];
    };
    let constants = if is_around {
        [e1, e3, e2, n13, n23 * e3 / e2, n12, g13, g23, g12]
    } else {
        [e1, e2, e3, n12, n23, n13, g12, g23, g13]
    };
    let names = [
        "YOUNG_MODULUS_X",
        "YOUNG_MODULUS_Y",
        "YOUNG_MODULUS_Z",
        "POISSON_RATIO_XY",
        "POISSON_RATIO_YZ",
        "POISSON_RATIO_XZ",
        "SHEAR_MODULUS_XY",
        "SHEAR_MODULUS_YZ",
        "SHEAR_MODULUS_XZ",
    ];
    names.iter().zip(constants).map(|(name, value)| format!("\"{name}\": {value:?}")).collect()
}

/// Constants of the yield curve; beyond its end the stress stays.
fn yielding(material: &Material) -> Vec<String> {
    let curve = &material.yield_curve;
    let first = curve.first().map_or(0.0, |row| row[0]);
    if curve.len() < 2 {
        return vec![format!("\"YIELD_STRESS\": {first:?}"), "\"HARDENING_CURVE\": 3".to_owned()];
    }
    let mut stresses: Vec<f64> = curve.iter().map(|row| row[0]).collect();
    let mut strains: Vec<f64> = curve.iter().map(|row| row[1]).collect();
    if let (Some(&stress), Some(&strain)) = (stresses.last(), strains.last()) {
        stresses.push(stress);
        strains.push(strain + BEYOND);
    }
    vec![
        format!("\"YIELD_STRESS\": {first:?}"),
        "\"HARDENING_CURVE\": 6".to_owned(),
        format!("\"EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE\": {stresses:?}"),
        format!("\"PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE\": {strains:?}"),
    ]
}

/// Constants over the temperature.
fn tables(material: &Material) -> String {
    let table = |name: &str, rows: Vec<[f64; 2]>| {
        format!(
            "\"{name}\": {{\"input_variable\": \"TEMPERATURE\", \"output_variable\": \"{name}\", \"data\": {rows:?}}}"
        )
    };
    let mut out = Vec::new();
    if !material.elastic_table.is_empty() {
        out.push(table("YOUNG_MODULUS", material.elastic_table.iter().map(|row| [row[0], row[1]]).collect()));
        if material.elastic_table.iter().any(|row| row[2] != material.poisson) {
            out.push(table("POISSON_RATIO", material.elastic_table.iter().map(|row| [row[0], row[2]]).collect()));
        }
    }
    let expansion = material.expansion.iter().filter(|own| own.table.len() > 1);
    out.extend(expansion.map(|own| table("THERMAL_EXPANSION_COEFFICIENT", own.table.clone())));
    out.join(", ")
}

/// A model part with its material.
struct Part<'a> {
    part: String,
    material: Option<&'a Material>,
    thickness: f64,
}

/// Model parts with their materials: sections of the file, else groups that share no element, else the whole.
fn parts(mesh: &Mesh) -> Vec<Part<'_>> {
    let dimension = mesh.dimension();
    let is_element = |cell: u32| mesh.cells.shapes[cell as usize].dim() == dimension;
    let mut covered = vec![false; mesh.cells.len()];
    let mut out = Vec::new();
    let named = |name: &str| mesh.materials.iter().find(|material| material.name == name);
    let section = |name: &str| mesh.sections.iter().rfind(|section| section.group == name);
    for group in mesh.groups.iter().filter(|group| mesh.sections.is_empty() || section(&group.name).is_some()) {
        let elements: Vec<usize> =
            group.cells.iter().filter(|&&cell| is_element(cell)).map(|&cell| cell as usize).collect();
        if elements.is_empty() || (mesh.sections.is_empty() && elements.iter().any(|&cell| covered[cell])) {
            continue;
        }
        elements.iter().for_each(|&cell| covered[cell] = true);
        let section = section(&group.name);
        let material = section.and_then(|section| named(&section.material));
        let thickness = section.map_or(1.0, |section| section.thickness);
        out.push(Part { part: format!("Structure.{}", group.name), material, thickness });
    }
    if (0..mesh.cells.len()).any(|cell| is_element(cell as u32) && !covered[cell]) {
        // the whole first: later entries are for its parts
        out.insert(0, Part { part: "Structure".to_owned(), material: None, thickness: 1.0 });
    }
    out
}
