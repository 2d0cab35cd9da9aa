//! The materials of a starter deck.

use zelus_meshes::mesh::{Material, Mesh, Plane};

/// The file of materials: those of the mesh, else steel in newtons and millimetres for every body.
pub(super) fn text(mesh: &Mesh, space: usize) -> String {
    let law = match (space, mesh.plane) {
        (3, _) => "LinearElastic3DLaw",
        (_, Some(Plane::Stress)) => "LinearElasticPlaneStress2DLaw",
        (_, Some(Plane::Axial)) => "LinearElasticAxisym2DLaw",
        (..) => "LinearElasticPlaneStrain2DLaw",
    };
    let mut entries = Vec::new();
    for (at, (part, material)) in parts(mesh).iter().enumerate() {
        let known = material.filter(|material| material.young.is_some());
        let (young, poisson, density) =
            known.map_or((210_000.0, 0.3, 0.0), |own| (own.young.unwrap_or_default(), own.poisson, own.density));
        let remark = match (known, material) {
            (Some(own), _) => format!("{}, from the mesh file", own.name),
            (None, Some(own)) => format!("{}: the mesh file gives no elasticity; steel, in N and mm", own.name),
            (None, None) => "steel, in N and mm: state your own".to_owned(),
        };
        let density = if density == 0.0 { String::new() } else { format!(", \"DENSITY\": {density:?}") };
        entries.push(format!(
            r#"    {{ // {remark}
      "model_part_name": "{part}",
      "properties_id": {},
      "Material": {{
        "constitutive_law": {{"name": "{law}"}},
        "Variables": {{"YOUNG_MODULUS": {young:?}, "POISSON_RATIO": {poisson:?}{density}}},
        "Tables": {{}}
      }}
    }}"#,
            at + 1
        ));
    }
    format!("{{\n  \"properties\": [\n{}\n  ]\n}}\n", entries.join(",\n"))
}

/// Model parts with their materials: sections of the file, else groups that share no element, else the whole.
fn parts(mesh: &Mesh) -> Vec<(String, Option<&Material>)> {
    let dimension = mesh.dimension();
    let is_element = |cell: u32| mesh.cells.shapes[cell as usize].dim() == dimension;
    let mut covered = vec![false; mesh.cells.len()];
    let mut out = Vec::new();
    let named = |name: &str| mesh.materials.iter().find(|material| material.name == name);
    let section = |name: &str| mesh.sections.iter().find(|section| section.group == name);
    for group in mesh.groups.iter().filter(|group| mesh.sections.is_empty() || section(&group.name).is_some()) {
        let elements: Vec<usize> =
            group.cells.iter().filter(|&&cell| is_element(cell)).map(|&cell| cell as usize).collect();
        if elements.is_empty() || (mesh.sections.is_empty() && elements.iter().any(|&cell| covered[cell])) {
            continue;
        }
        elements.iter().for_each(|&cell| covered[cell] = true);
        let material = section(&group.name).and_then(|section| named(&section.material));
        out.push((format!("Structure.{}", group.name), material));
    }
    if (0..mesh.cells.len()).any(|cell| is_element(cell as u32) && !covered[cell]) {
        // the whole first: later entries are for its parts
        out.insert(0, ("Structure".to_owned(), None));
    }
    out
}
