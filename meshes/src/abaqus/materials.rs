//! Materials, sections, axes of materials and temperatures.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Result;
use zelus_core::vector3::{cross, norm, scale, sub};

use super::cards::Card;
use super::hyperelastic;
use super::model::{Model, Statement};
use super::sets::Kind;
use crate::conditions::{Axes, MaterialAxes};
use crate::mesh::{Expansion, Material, Section, word};

impl Model {
    /// Reads materials and what they are given to; sets have their groups.
    pub(super) fn read_materials(&mut self, statements: &[Statement]) {
        let mut orientations: BTreeMap<String, Axes> = BTreeMap::new();
        let mut under_way: Option<usize> = None;
        for Statement { card, scope, .. } in statements {
            let read = match card.keyword.as_str() {
                "MATERIAL" => self.material(card).map(|at| under_way = Some(at)),
                "ELASTIC" | "HYPERELASTIC" | "DENSITY" | "PLASTIC" | "EXPANSION" => self.of_material(card, under_way),
                "ORIENTATION" => orientation(card).map(|(name, axes)| {
                    orientations.insert(name, axes);
                }),
                _ => Ok(()),
            };
            self.tolerate(read);
            if card.keyword == "SOLID SECTION" {
                let read = self.section(card, scope, &orientations);
                self.tolerate(read);
            }
        }
    }

    fn material(&mut self, card: &Card) -> Result<usize> {
        card.is_read.set(true);
        let name = word(card.require("NAME")?);
        // a part that has several instances lists its materials several times
        let known = self.mesh.materials.iter().position(|own| own.name.eq_ignore_ascii_case(&name));
        Ok(known.unwrap_or_else(|| {
            self.mesh.materials.push(Material { name, ..Material::default() });
            self.mesh.materials.len() - 1
        }))
    }

    fn section(&mut self, card: &Card, scope: &str, orientations: &BTreeMap<String, Axes>) -> Result<()> {
        card.is_read.set(true);
        let name = card.require("ELSET")?;
        let set = self.sets.find(Kind::Elements, scope, name);
        let group = set
            .map(|set| set.group.clone())
            .ok_or_else(|| card.wrong(format!("there is no set of elements {name}")))?;
        if let Some(name) = card.get("ORIENTATION") {
            let axes = orientations.get(&name.to_ascii_uppercase());
            let axes = axes.ok_or_else(|| card.wrong(format!("there is no *ORIENTATION {name}")));
            if let Some(axes) = self.tolerate(axes) {
                self.mesh.material_axes.push(MaterialAxes { group: group.clone(), axes: axes.clone() });
            }
        }
        let given = card.get("MATERIAL").map(word).unwrap_or_default();
        let known = self.mesh.materials.iter().find(|own| own.name.eq_ignore_ascii_case(&given));
        let material = known.map_or(given, |own| own.name.clone());
        let row = card.rows.first().filter(|row| !row.get(0).is_empty());
        let thickness = row.map_or(Ok(1.0), |row| card.number(row.get(0), row.line));
        let thickness = self.tolerate(thickness).filter(|given| *given > 0.0).unwrap_or(1.0);
        self.mesh.sections.push(Section { group, material, thickness });
        Ok(())
    }

    fn of_material(&mut self, card: &Card, under_way: Option<usize>) -> Result<()> {
        let at = under_way.ok_or_else(|| card.wrong(format!("*{} stands below no *MATERIAL", card.keyword)))?;
        match card.keyword.as_str() {
            "ELASTIC" => self.elastic(card, at),
            "HYPERELASTIC" => self.hyperelastic(card, at),
            "DENSITY" => {
                card.is_read.set(true);
                let numbers = card.all_numbers()?;
                self.one_line(card);
                self.mesh.materials[at].density = numbers.first().copied().unwrap_or(0.0);
                Ok(())
            }
            "EXPANSION" => self.expansion(card, at),
            _ => self.plastic(card, at),
        }
    }

    /// Warns of the lines after the first: values at other temperatures.
    fn one_line(&mut self, card: &Card) {
        if card.rows.len() > 1 {
            let fact = format!("*{}: lines after the first, at other temperatures, are not read", card.keyword);
            self.report.push(card.left_out(fact));
        }
    }

    fn elastic(&mut self, card: &Card, at: usize) -> Result<()> {
        card.is_read.set(true);
        let kind = card.get("TYPE").unwrap_or("ISO").to_ascii_uppercase();
        let material = &self.mesh.materials[at];
        if kind.starts_with("ENGINEERING") || kind.starts_with("ORTHO") {
            let numbers = card.all_numbers()?;
            let Some(&[a, b, c, d, e, f, g, h, i]) = numbers.first_chunk::<9>() else {
                return Err(card.wrong(format!("*ELASTIC, TYPE={kind} has nine constants")));
            };
            let given = [a, b, c, d, e, f, g, h, i];
            let constants = if kind.starts_with("ORTHO") { engineering(given) } else { Some(given) };
            let constants = constants.ok_or_else(|| card.wrong("*ELASTIC: the stiffness has no inverse"))?;
            self.mesh.materials[at].orthotropic = Some(constants);
            if numbers.len() > 10 {
                let fact = "*ELASTIC: constants at further temperatures are not read";
                self.report.push(card.left_out(fact));
            }
            return Ok(());
        }
        if !kind.starts_with("ISO") {
            let fact = format!("*ELASTIC, TYPE={kind} of material {} is not read", material.name);
            self.report.push(card.left_out(fact));
            return Ok(());
        }
        let mut table = Vec::new();
        for row in &card.rows {
            let numbers = card.numbers(row)?;
            let young = numbers[0];
            let (poisson, temperature) = (numbers.get(1).copied(), numbers.get(2).copied());
            table.push([temperature.unwrap_or(0.0), young, poisson.unwrap_or(0.0)]);
        }
        let Some(&[_, young, poisson]) = table.first() else { return Err(card.wrong("*ELASTIC has no constants")) };
        let material = &mut self.mesh.materials[at];
        (material.young, material.poisson) = (Some(young), poisson);
        material.elastic_table = if table.len() > 1 { table } else { Vec::new() };
        Ok(())
    }

    fn hyperelastic(&mut self, card: &Card, at: usize) -> Result<()> {
        card.is_read.set(true);
        let name = &self.mesh.materials[at].name;
        match hyperelastic::of(card)? {
            Some((rubber, further)) => {
                if further {
                    let fact = format!(
                        "*HYPERELASTIC: constants of the volume after the first, of material {name}, are not read"
                    );
                    self.report.push(card.left_out(fact));
                }
                self.mesh.materials[at].rubber = Some(rubber);
            }
            None => {
                let fact = format!(
                    "*HYPERELASTIC of material {name} is not read: its energy, or test data instead of constants"
                );
                self.report.push(card.left_out(fact));
            }
        }
        Ok(())
    }

    fn plastic(&mut self, card: &Card, at: usize) -> Result<()> {
        let name = &self.mesh.materials[at].name;
        if let Some(kind) = card.get("HARDENING").filter(|kind| !kind.eq_ignore_ascii_case("ISOTROPIC")) {
            let fact = format!("*PLASTIC, HARDENING={kind} of material {name} is not read");
            card.is_read.set(true);
            self.report.push(card.left_out(fact));
            return Ok(());
        }
        card.is_read.set(true);
        let rows = card.rows.iter().map(|row| card.numbers(row)).collect::<Result<Vec<_>>>()?;
        let temperature = |row: &Vec<f64>| row.get(2).copied();
        let first = rows.first().and_then(temperature);
        let own = rows.iter().filter(|row| temperature(row) == first);
        let curve: Vec<[f64; 2]> = own.map(|row| [row[0], row.get(1).copied().unwrap_or(0.0)]).collect();
        if curve.len() < rows.len() {
            let fact = "*PLASTIC: curves at further temperatures are not read";
            self.report.push(card.left_out(fact));
        }
        self.mesh.materials[at].yield_curve = curve;
        Ok(())
    }

    fn expansion(&mut self, card: &Card, at: usize) -> Result<()> {
        card.is_read.set(true);
        if let Some(kind) = card.get("TYPE").filter(|kind| !kind.to_ascii_uppercase().starts_with("ISO")) {
            let fact = format!("*EXPANSION, TYPE={kind} is not read: expansion is the same in all directions");
            self.report.push(card.left_out(fact));
            return Ok(());
        }
        let mut table = Vec::new();
        for row in &card.rows {
            let numbers = card.numbers(row)?;
            table.push([numbers.get(1).copied().unwrap_or(0.0), numbers[0]]);
        }
        let reference = card.get("ZERO").map(|field| card.number(field, card.place().line)).transpose()?;
        self.mesh.materials[at].expansion = Some(Expansion { table, reference: reference.unwrap_or(0.0) });
        Ok(())
    }
}

/// E₁, E₂, E₃, ν₁₂, ν₁₃, ν₂₃, G₁₂, G₁₃, G₂₃ of the stiffness D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323.
fn engineering([d11, d12, d22, d13, d23, d33, g12, g13, g23]: [f64; 9]) -> Option<[f64; 9]> {
    let determinant = d11 * (d22 * d33 - d23 * d23) - d12 * (d12 * d33 - d13 * d23) + d13 * (d12 * d23 - d13 * d22);
    if determinant == 0.0 {
        return None;
    }
    let compliance = |minor: f64| minor / determinant;
    let (s11, s22, s33) =
        (compliance(d22 * d33 - d23 * d23), compliance(d11 * d33 - d13 * d13), compliance(d11 * d22 - d12 * d12));
    let (s12, s13, s23) =
        (compliance(d13 * d23 - d12 * d33), compliance(d12 * d23 - d13 * d22), compliance(d12 * d13 - d11 * d23));
    Some([1.0 / s11, 1.0 / s22, 1.0 / s33, -s12 / s11, -s13 / s11, -s23 / s22, g12, g13, g23])
}

/// Name in capitals and axes of `*ORIENTATION`.
fn orientation(card: &Card) -> Result<(String, Axes)> {
    card.is_read.set(true);
    let name = card.require("NAME")?.to_ascii_uppercase();
    let is_cylindrical = card.says("SYSTEM", "CYLINDRICAL");
    if !is_cylindrical && !card.says("SYSTEM", "RECTANGULAR") && card.get("SYSTEM").is_some() {
        return Err(card.wrong("*ORIENTATION of a system that is neither RECTANGULAR nor CYLINDRICAL"));
    }
    card.says("DEFINITION", "COORDINATES");
    let numbers = card.rows.first().map(|row| card.numbers(row)).transpose()?.unwrap_or_default();
    let axes = axes_of(card, &numbers, is_cylindrical)?;
    let turn = card.rows.get(1).map(|row| card.numbers(row)).transpose()?.unwrap_or_default();
    if turn.get(1).is_some_and(|angle| *angle != 0.0) {
        return Err(card.wrong("*ORIENTATION with a further rotation"));
    }
    Ok((name, axes))
}

/// Axes by two points: on axis 1 and in the plane of 1 and 2, or on the axis of a cylinder.
pub(super) fn axes_of(card: &Card, numbers: &[f64], is_cylindrical: bool) -> Result<Axes> {
    let Some(&[ax, ay, az, bx, by, bz]) = numbers.first_chunk::<6>() else {
        return Err(card.wrong(format!("*{} has two points: six numbers", card.keyword)));
    };
    let (a, b) = ([ax, ay, az], [bx, by, bz]);
    let same = || card.wrong(format!("*{}: its two points give no axes", card.keyword));
    if is_cylindrical {
        let axis = sub(b, a);
        return if norm(axis) > 0.0 {
            Ok(Axes::Cylindrical { origin: a, axis: scale(axis, 1.0 / norm(axis)) })
        } else {
            Err(same())
        };
    }
    let third = cross(a, b);
    if norm(third) == 0.0 {
        return Err(same());
    }
    let (first, third) = (scale(a, 1.0 / norm(a)), scale(third, 1.0 / norm(third)));
    Ok(Axes::Cartesian([first, cross(third, first), third]))
}
