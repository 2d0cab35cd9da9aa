//! From keywords to a mesh.

use std::collections::BTreeMap;
use std::path::Path;

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::{Diagnostic, Place, Report, Result};

use super::abaqus_cells;
use super::cards::Card;
use super::instance::Placement;
use super::steps::Interactions;
use super::surfaces::Surface;
use crate::mesh::{Material, Mesh, Section, word};

/// Keywords that say nothing about a mesh, a material or a load, or that are told by others.
const WITHOUT_MESH: [&str; 28] = [
    "HEADING",
    "PREPRINT",
    "ASSEMBLY",
    "END ASSEMBLY",
    "END INSTANCE",
    "END PART",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "CONTACT OUTPUT",
    "OUTPUT",
    "RESTART",
    "NODE FILE",
    "EL FILE",
    "NODE PRINT",
    "EL PRINT",
    "CONTACT FILE",
    "CONTACT PRINT",
    "SECTION PRINT",
    "FILE FORMAT",
    "MONITOR",
    "END STEP",
    "SURFACE BEHAVIOR",
    "STATIC",
    "CONTROLS",
    "SOLVER",
    "AMPLITUDE",
    "TIME POINTS",
    "PRINT",
];

/// A label or set within an instance; the name of the instance is empty outside of all.
pub(super) type Named = (String, String);

/// Contents read so far.
#[derive(Default)]
pub(super) struct Model {
    pub mesh: Mesh,
    /// Cards of each part.
    parts: BTreeMap<String, Vec<Card>>,
    pub nodes: FxHashMap<(String, u32), u32>,
    pub elements: FxHashMap<(String, u32), u32>,
    /// Indices of nodes by set.
    pub node_sets: BTreeMap<Named, Vec<u32>>,
    /// Indices of elements by set.
    pub element_sets: BTreeMap<Named, Vec<u32>>,
    /// Surfaces, made when all elements are there.
    pub surfaces: Vec<Surface>,
    pub interactions: Interactions,
    /// The material under way.
    material: Option<usize>,
    /// Steps begun so far.
    pub step: usize,
    /// Keywords that are not read, with their number.
    unread: BTreeMap<String, usize>,
    structural: BTreeMap<String, usize>,
    /// Types whose elements come in as simpler ones: the missing feature, and the remedy.
    simpler: BTreeMap<String, (&'static str, &'static str)>,
    pub report: Report,
}

/// The mesh of the cards, with warnings.
pub(super) fn read(cards: &[Card], path: &Path) -> Result<(Mesh, Vec<Diagnostic>)> {
    let mut model = Model::default();
    let mut part: Option<String> = None;
    for card in cards {
        match card.keyword.as_str() {
            "PART" => part = Some(card.require("NAME")?.to_ascii_uppercase()),
            "END PART" => part = None,
            "INSTANCE" => model.instance(card)?,
            _ => match &part {
                Some(name) => model.parts.entry(name.clone()).or_default().push(card.clone()),
                None => model.card(card, &scope_of(card), &Placement::default())?,
            },
        }
    }
    model.finish(path)
}

/// The instance whose nodes or elements a card of the assembly lists.
fn scope_of(card: &Card) -> String {
    card.get("INSTANCE").unwrap_or_default().to_ascii_uppercase()
}

impl Model {
    fn instance(&mut self, card: &Card) -> Result<()> {
        let (name, part) = (card.require("NAME")?.to_ascii_uppercase(), card.require("PART")?.to_ascii_uppercase());
        let placement = Placement::of(card)?;
        let cards = self.parts.get(&part).ok_or_else(|| card.wrong(format!("there is no part {part}")))?.clone();
        cards.iter().try_for_each(|own| self.card(own, &name, &placement))
    }

    fn card(&mut self, card: &Card, scope: &str, placement: &Placement) -> Result<()> {
        match card.keyword.as_str() {
            "NODE" => self.add_nodes(card, scope, placement),
            "ELEMENT" => self.add_elements(card, scope),
            "NSET" => {
                let found = self.listed(card, scope, true)?;
                self.add_to_set(card.require("NSET")?, scope, found, true);
                Ok(())
            }
            "ELSET" => {
                let found = self.listed(card, scope, false)?;
                self.add_to_set(card.require("ELSET")?, scope, found, false);
                Ok(())
            }
            "SURFACE" => self.add_surface(card, scope),
            "SOLID SECTION" => self.section(card, scope),
            "MATERIAL" => {
                let name = word(card.require("NAME")?);
                self.mesh.materials.push(Material { name, young: None, poisson: 0.0, density: 0.0 });
                self.material = Some(self.mesh.materials.len() - 1);
                Ok(())
            }
            "ELASTIC" | "DENSITY" => self.of_material(card),
            "STEP" => {
                self.step += 1;
                if card.get("NLGEOM").is_some_and(|given| !given.eq_ignore_ascii_case("no")) {
                    let fact = "NLGEOM is not taken over: elements are those of small displacements";
                    let remedy = "write TotalLagrangianElement as \"element_name\" (--element-name)";
                    self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()).remedy(remedy));
                }
                Ok(())
            }
            _ => {
                let is_read = self.interaction(card, scope)? || WITHOUT_MESH.contains(&card.keyword.as_str());
                if !is_read {
                    *self.unread.entry(card.keyword.clone()).or_default() += 1;
                }
                Ok(())
            }
        }
    }

    fn add_nodes(&mut self, card: &Card, scope: &str, placement: &Placement) -> Result<()> {
        let mut added = Vec::new();
        for line in &card.lines {
            let label = card.label(line.first().map_or("", String::as_str))?;
            let mut point = [0.0; 3];
            for (to, field) in point.iter_mut().zip(line.iter().skip(1).filter(|field| !field.is_empty())) {
                *to = card.number(field)?;
            }
            let at = self.mesh.points.len() as u32;
            if self.nodes.insert((scope.to_owned(), label), at).is_some() {
                return Err(card.wrong(format!("node {label} stands there twice")));
            }
            self.mesh.points.push(placement.place(point));
            self.mesh.node_ids.push(label);
            added.push(at);
        }
        if let Some(set) = card.get("NSET") {
            self.add_to_set(set, scope, added, true);
        }
        Ok(())
    }

    fn add_elements(&mut self, card: &Card, scope: &str) -> Result<()> {
        let kind = card.require("TYPE")?;
        let Some((shape, plane)) = abaqus_cells::of(kind) else {
            let known = "C3D4, C3D6, C3D8, C3D10, C3D15, C3D20, CPS…, CPE… and CAX… are known, whatever letters follow";
            return Err(Diagnostic::error("mesh-syntax", format!("elements of type {kind} are not known"))
                .at(card.place())
                .remedy(known)
                .into());
        };
        if abaqus_cells::is_structural(kind) {
            *self.structural.entry(kind.to_ascii_uppercase()).or_default() += 1;
        }
        if let Some(left_out) = abaqus_cells::left_out(kind, shape) {
            self.simpler.insert(kind.to_ascii_uppercase(), left_out);
        }
        self.mesh.plane = self.mesh.plane.or(plane);
        let fields: Vec<&str> = card.fields().collect();
        let mut added = Vec::new();
        for row in fields.chunks(shape.nodes() + 1) {
            let label = card.label(row[0])?;
            if row.len() <= shape.nodes() {
                return Err(card.wrong(format!("element {label} has too few nodes for {kind}")));
            }
            let mut nodes = vec![0; shape.nodes()];
            for (&place, field) in abaqus_cells::order(shape).iter().zip(&row[1..]) {
                let node = (scope.to_owned(), card.label(field)?);
                let found = self.nodes.get(&node);
                nodes[place] = *found
                    .ok_or_else(|| card.wrong(format!("element {label} has node {}, which is not there", node.1)))?;
            }
            let cell = self.mesh.cells.push(label, shape, nodes);
            if self.elements.insert((scope.to_owned(), label), cell).is_some() {
                return Err(card.wrong(format!("element {label} stands there twice")));
            }
            added.push(cell);
        }
        if let Some(set) = card.get("ELSET") {
            self.add_to_set(set, scope, added, false);
        }
        Ok(())
    }

    fn add_to_set(&mut self, name: &str, scope: &str, found: Vec<u32>, of_nodes: bool) {
        // A set of the assembly that lists an instance's is one of the assembly.
        let sets = if of_nodes { &mut self.node_sets } else { &mut self.element_sets };
        let set = sets.entry((scope.to_owned(), name.to_ascii_uppercase())).or_default();
        set.extend(found);
        let group = self.mesh.group_mut(&group_name(scope, name));
        let list = if of_nodes { &mut group.nodes } else { &mut group.cells };
        list.extend(set.iter());
        list.sort_unstable();
        list.dedup();
    }

    fn listed(&self, card: &Card, scope: &str, of_nodes: bool) -> Result<Vec<u32>> {
        let mut out = Vec::new();
        if card.get("GENERATE").is_some() {
            for line in &card.lines {
                let mut numbers = line.iter().filter(|field| !field.is_empty()).map(|field| card.label(field));
                let first = numbers.next().unwrap_or_else(|| Err(card.wrong("a range has no beginning")))?;
                let last = numbers.next().unwrap_or(Ok(first))?;
                let by = numbers.next().unwrap_or(Ok(1))?.max(1);
                // a range may contain labels that do not exist
                let labels = if of_nodes { &self.nodes } else { &self.elements };
                let range = (first..=last).step_by(by as usize);
                out.extend(range.filter_map(|label| labels.get(&(scope.to_owned(), label)).copied()));
            }
            return Ok(out);
        }
        for field in card.fields() {
            out.extend(self.found(card, field, scope, of_nodes)?);
        }
        Ok(out)
    }

    /// The nodes or elements of a label or set, which may stand behind the name of an instance and a dot.
    pub(super) fn found(&self, card: &Card, field: &str, scope: &str, of_nodes: bool) -> Result<Vec<u32>> {
        let name = field.trim_matches('"').to_ascii_uppercase();
        let (scope, name) = name
            .split_once('.')
            .map_or((scope.to_owned(), name.clone()), |(instance, own)| (instance.to_owned(), own.to_owned()));
        let (labels, sets) =
            if of_nodes { (&self.nodes, &self.node_sets) } else { (&self.elements, &self.element_sets) };
        let of_label = name.parse().ok().and_then(|label| labels.get(&(scope.clone(), label)));
        if let Some(&found) = of_label {
            return Ok(vec![found]);
        }
        let found = sets.get(&(scope, name.clone())).or_else(|| sets.get(&(String::new(), name)));
        let what = if of_nodes { "node or set of nodes" } else { "element or set of elements" };
        found.cloned().ok_or_else(|| card.wrong(format!("*{}: there is no {what} {field}", card.keyword)))
    }

    fn section(&mut self, card: &Card, scope: &str) -> Result<()> {
        let group = group_name(scope, card.require("ELSET")?);
        self.mesh.sections.push(Section { group, material: word(card.require("MATERIAL")?) });
        let thickness = card.fields().next().map_or(Ok(1.0), |field| card.number(field))?;
        if thickness != 1.0 && thickness > 0.0 {
            let fact = format!("the thickness {thickness} of a section is not taken over: plane elements have 1");
            let remedy = "write THICKNESS among the \"Variables\" of its material";
            self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()).remedy(remedy));
        }
        Ok(())
    }

    fn of_material(&mut self, card: &Card) -> Result<()> {
        let Some(material) = self.material.map(|at| &mut self.mesh.materials[at]) else {
            return Err(card.wrong(format!("*{} stands below no *MATERIAL", card.keyword)));
        };
        let numbers = card.fields().take(2).map(|field| card.number(field)).collect::<Result<Vec<f64>>>()?;
        match (card.keyword.as_str(), &numbers[..]) {
            ("ELASTIC", &[young, poisson])
                if card.get("TYPE").is_none_or(|kind| kind.to_ascii_uppercase().starts_with("ISO")) =>
            {
                (material.young, material.poisson) = (Some(young), poisson);
            }
            ("ELASTIC", _) => {
                let fact = format!("material {} is not isotropic: its elasticity is not taken over", material.name);
                self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()));
            }
            (_, numbers) => material.density = numbers.first().copied().unwrap_or(0.0),
        }
        Ok(())
    }

    fn finish(mut self, path: &Path) -> Result<(Mesh, Vec<Diagnostic>)> {
        self.make_surfaces()?;
        self.make_interactions()?;
        let place = Place::file(path);
        for (list, fact, remedy) in [
            (&self.unread, "keywords of the file are not read", "state what they mean in the deck"),
            (
                &self.structural,
                "elements of these types come in as cells without stiffness",
                "mesh the bodies with solid elements",
            ),
        ] {
            let names: Vec<&str> = list.keys().map(String::as_str).collect();
            if !names.is_empty() {
                let problem = Diagnostic::warning("not-taken-over", format!("{fact}: {}", names.join(", ")));
                self.report.push(problem.at(place.clone()).remedy(remedy));
            }
        }
        for (name, (what, remedy)) in &self.simpler {
            let problem = Diagnostic::warning("not-taken-over", format!("elements {name} have {what}"));
            self.report.push(problem.at(place.clone()).remedy(*remedy));
        }
        if self.mesh.dimension() == 3 {
            self.mesh.plane = None;
        }
        renumber(&mut self.mesh.node_ids);
        renumber(&mut self.mesh.cells.ids);
        self.mesh.groups.retain(|group| !(group.cells.is_empty() && group.nodes.is_empty()));
        Ok((self.mesh, self.report.finish()?))
    }
}

/// Numbers from 1 where instances have brought the same ones.
fn renumber(ids: &mut [u32]) {
    let mut sorted = ids.to_vec();
    sorted.sort_unstable();
    if sorted.windows(2).any(|two| two[0] == two[1]) {
        ids.iter_mut().zip(1..).for_each(|(id, new)| *id = new);
    }
}

/// The name of the group of a set or surface.
pub(super) fn group_name(scope: &str, name: &str) -> String {
    // the name of an instance is in capitals, however it is written
    let name = match name.split_once('.') {
        Some((instance, own)) => format!("{}_{own}", instance.to_ascii_uppercase()),
        None if scope.is_empty() => name.to_owned(),
        None => format!("{scope}_{name}"),
    };
    word(&name)
}
