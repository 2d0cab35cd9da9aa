//! From keywords to a mesh.

use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_core::diagnostics::{Diagnostic, Error, Place, Report, Result, Severity, counted};

use super::abaqus_cells;
use super::cards::{self, Card, Row};
use super::discrete_elements::DiscreteElement;
use super::instance::Placement;
use super::sets::{Kind, Sets};
use super::unread;
use crate::mesh::Mesh;

/// Lines of a card that are named when they cannot be read; more are counted.
const NAMED: usize = 3;

/// A card in the place where it acts.
#[derive(Debug, Clone)]
pub(super) struct Statement {
    pub card: Rc<Card>,
    /// The instance whose labels it lists; empty outside of all.
    pub scope: String,
    /// The instance to which its sets belong.
    home: String,
    placement: Placement,
}

impl Statement {
    /// The instance to which its sets belong.
    pub(super) fn home(&self) -> &str {
        &self.home
    }
}

/// Contents read so far.
#[derive(Default)]
pub(super) struct Model {
    pub mesh: Mesh,
    pub nodes: FxHashMap<(String, u32), u32>,
    pub elements: FxHashMap<(String, u32), u32>,
    /// Elements of types that are not known: sets may list them.
    pub(super) omitted: FxHashSet<(String, u32)>,
    /// Springs and masses, and their places by label.
    pub(super) discrete: Vec<DiscreteElement>,
    pub(super) discrete_of: FxHashMap<(String, u32), u32>,
    pub sets: Sets,
    /// Types of elements that come in as cells without stiffness.
    structural: BTreeMap<String, Place>,
    /// Types whose elements come in as simpler ones: the missing feature, and the remedy.
    simpler: BTreeMap<String, (&'static str, &'static str, Place)>,
    pub report: Report,
}

/// The mesh of a file, with warnings.
pub(super) fn read(path: &Path) -> Result<(Mesh, Vec<Diagnostic>)> {
    let mut model = Model::default();
    let cards: Vec<Rc<Card>> = cards::read(path, &mut model.report)?.into_iter().map(Rc::new).collect();
    let statements = model.statements(&cards);
    for statement in &statements {
        let read = model.of_mesh(statement);
        model.tolerate(read);
    }
    let surfaces: Vec<&Statement> = statements.iter().filter(|own| own.card.keyword == "SURFACE").collect();
    model.make_surfaces(&surfaces);
    model.sets.make_groups(&mut model.mesh);
    model.read_materials(&statements);
    model.read_contact(&statements);
    model.read_analysis(&statements);
    let all: Vec<&Card> = cards.iter().map(Rc::as_ref).collect();
    unread::report(&all, &mut model.report);
    model.finish()
}

impl Model {
    /// The cards of the assembly, and those of each part once for each of its instances.
    fn statements(&mut self, cards: &[Rc<Card>]) -> Vec<Statement> {
        let mut parts: BTreeMap<String, Vec<Rc<Card>>> = BTreeMap::new();
        let mut part: Option<String> = None;
        let mut instance = (String::new(), Placement::default());
        let mut out = Vec::new();
        for card in cards {
            let name = || card.get("NAME").unwrap_or_default().to_ascii_uppercase();
            match card.keyword.as_str() {
                "PART" => part = Some(name()),
                "END PART" => part = None,
                "END INSTANCE" => instance = (String::new(), Placement::default()),
                "INSTANCE" => {
                    let placed = Placement::of(card);
                    instance = (name(), self.tolerate(placed).unwrap_or_default());
                    let of = card.get("PART").unwrap_or_default().to_ascii_uppercase();
                    let Some(own) = parts.get(&of) else {
                        self.report.push(card.left_out(format!("there is no part {of}")));
                        continue;
                    };
                    let (scope, placement) = &instance;
                    out.extend(own.iter().map(|card| Statement {
                        card: card.clone(),
                        scope: scope.clone(),
                        home: scope.clone(),
                        placement: placement.clone(),
                    }));
                }
                _ => match &part {
                    Some(name) => parts.entry(name.clone()).or_default().push(card.clone()),
                    None => {
                        let (home, placement) = instance.clone();
                        let scope = card.get("INSTANCE").map_or_else(|| home.clone(), str::to_ascii_uppercase);
                        out.push(Statement { card: card.clone(), scope, home, placement });
                    }
                },
            }
        }
        out
    }

    /// The value, or a warning in place of the error.
    pub(super) fn tolerate<T>(&mut self, result: Result<T>) -> Option<T> {
        match result {
            Ok(value) => return Some(value),
            Err(Error::Input(problems)) => {
                for problem in problems {
                    let fact = format!("{}: this is left out", problem.fact);
                    let severity = Severity::Warning;
                    self.report.push(Diagnostic { severity, code: "not-taken-over", fact, ..problem });
                }
            }
            Err(other) => self.report.push(Diagnostic::warning("not-taken-over", other.to_string())),
        }
        None
    }

    /// Reads each line of a card; lines that cannot be read are named.
    pub(super) fn each_row(&mut self, card: &Card, read: &mut dyn FnMut(&mut Self, &Row) -> Result<()>) {
        card.is_read.set(true);
        let mut wrong = 0;
        for row in &card.rows {
            if let Err(error) = read(self, row) {
                wrong += 1;
                if wrong <= NAMED {
                    self.tolerate::<()>(Err(error));
                }
            }
        }
        self.count_wrong(card, wrong, "line", "lines");
    }

    fn count_wrong(&mut self, card: &Card, wrong: usize, one: &str, several: &str) {
        if wrong > NAMED {
            let more = counted(wrong - NAMED, one, several);
            self.report.push(card.left_out(format!("*{}: {more} more cannot be read", card.keyword)));
        }
    }

    fn of_mesh(&mut self, statement: &Statement) -> Result<()> {
        let Statement { card, scope, home, placement } = statement;
        match card.keyword.as_str() {
            "NODE" => self.add_nodes(card, scope, placement),
            "ELEMENT" => self.add_elements(card, scope)?,
            "NSET" => {
                let name = card.require("NSET")?;
                let mut found = Vec::new();
                if let Some(elements) = card.get("ELSET") {
                    let cells = self.found(card, elements, 0, scope, Kind::Elements)?;
                    found.extend(cells.iter().flat_map(|&cell| self.mesh.cells.nodes(cell as usize)).copied());
                }
                found.extend(self.listed(card, scope, Kind::Nodes));
                self.sets.set_mut(Kind::Nodes, home, name).nodes.extend(found);
            }
            "ELSET" => {
                let name = card.require("ELSET")?;
                let found = self.listed(card, scope, Kind::Elements);
                self.sets.set_mut(Kind::Elements, home, name).cells.extend(found);
                let discrete = self.listed_discrete(card, scope);
                self.list_discrete(home, name, discrete);
            }
            _ => {}
        }
        Ok(())
    }

    fn add_nodes(&mut self, card: &Card, scope: &str, placement: &Placement) {
        let mut added = Vec::new();
        self.each_row(card, &mut |model, row| {
            let label = card.label(row.get(0), row.line)?;
            let mut point = [0.0; 3];
            for (to, field) in point.iter_mut().zip(row.fields.iter().skip(1).filter(|field| !field.is_empty())) {
                *to = card.number(field, row.line)?;
            }
            let at = model.mesh.points.len() as u32;
            if let Some(&known) = model.nodes.get(&(scope.to_owned(), label)) {
                model.mesh.points[known as usize] = placement.place(point);
                added.push(known);
                return Err(card.wrong_at(row.line, format!("node {label} stands there twice: its earlier position")));
            }
            model.nodes.insert((scope.to_owned(), label), at);
            model.mesh.points.push(placement.place(point));
            model.mesh.node_ids.push(label);
            added.push(at);
            Ok(())
        });
        if let Some(set) = card.get("NSET") {
            self.sets.set_mut(Kind::Nodes, scope, set).nodes.extend(added);
        }
    }

    fn add_elements(&mut self, card: &Card, scope: &str) -> Result<()> {
        let kind = card.require("TYPE")?;
        card.is_read.set(true);
        if self.add_discrete(card, scope).is_some() {
            return Ok(());
        }
        let Some((shape, plane)) = abaqus_cells::of(kind) else {
            let labels = card.rows.iter().filter_map(|row| row.get(0).parse().ok());
            self.omitted.extend(labels.map(|label: u32| (scope.to_owned(), label)));
            let known = "C3D4, C3D6, C3D8, C3D10, C3D15, C3D20, CPS…, CPE… and CAX… are known, whatever letters follow";
            let fact = format!("elements of type {kind} are not known and are left out");
            self.report.push(card.left_out(fact).remedy(known));
            return Ok(());
        };
        let capitals = kind.to_ascii_uppercase();
        if abaqus_cells::is_structural(kind) {
            self.structural.entry(capitals.clone()).or_insert_with(|| card.place());
        }
        if let Some((feature, remedy)) = abaqus_cells::left_out(kind, shape) {
            self.simpler.entry(capitals).or_insert_with(|| (feature, remedy, card.place()));
        }
        if let (Some(known), Some(plane)) = (self.mesh.plane, plane)
            && known != plane
        {
            let fact =
                format!("elements of type {kind} assume another plane state than those before: all take the first");
            self.report.push(card.left_out(fact).remedy("divide the model, or mesh it in space"));
        }
        self.mesh.plane = self.mesh.plane.or(plane);
        let mut added = Vec::new();
        let mut wrong = 0;
        let mut surplus = 0;
        let mut rows = card.rows.iter();
        while let Some(first) = rows.next() {
            // an element begins at a line and goes on in the next ones until it has all nodes
            let held = |row: &Row| row.fields.iter().filter(|field| !field.is_empty()).cloned().collect::<Vec<_>>();
            let mut fields: Vec<(String, u32)> = held(first).into_iter().map(|field| (field, first.line)).collect();
            while fields.len() <= shape.nodes() {
                let Some(more) = rows.next() else { break };
                fields.extend(held(more).into_iter().map(|field| (field, more.line)));
            }
            surplus += usize::from(fields.len() > shape.nodes() + 1);
            let row: Vec<(&str, u32)> = fields.iter().map(|(field, line)| (field.as_str(), *line)).collect();
            let Some(&(label, _)) = row.first() else { continue };
            let row = &row[..row.len().min(shape.nodes() + 1)];
            match self.element(card, scope, kind, row) {
                Ok(cell) => added.push(cell),
                Err(error) => {
                    if let Ok(label) = label.parse() {
                        self.omitted.insert((scope.to_owned(), label));
                    }
                    wrong += 1;
                    if wrong <= NAMED {
                        self.tolerate::<()>(Err(error));
                    }
                }
            }
        }
        self.count_wrong(card, wrong, "element", "elements");
        if surplus > 0 {
            let fact = format!(
                "{} more nodes than {kind}: the first {} are used",
                counted(surplus, "element has", "elements have"),
                shape.nodes()
            );
            self.report.push(card.left_out(fact));
        }
        if let Some(set) = card.get("ELSET") {
            self.sets.set_mut(Kind::Elements, scope, set).cells.extend(added);
        }
        Ok(())
    }

    /// Adds an element by its label and nodes.
    fn element(&mut self, card: &Card, scope: &str, kind: &str, row: &[(&str, u32)]) -> Result<u32> {
        let (shape, _) = abaqus_cells::of(kind).ok_or_else(|| card.wrong("it has no shape"))?;
        let (field, line) = row[0];
        let label = card.label(field, line)?;
        if row.len() <= shape.nodes() {
            return Err(card.wrong_at(line, format!("element {label} has too few nodes for {kind}")));
        }
        let mut nodes = vec![0; shape.nodes()];
        for (&place, &(field, line)) in abaqus_cells::order(shape).iter().zip(&row[1..]) {
            let node = card.label(field, line)?;
            let found = self.nodes.get(&(scope.to_owned(), node));
            let missing = || card.wrong_at(line, format!("element {label} has node {node}, which is not there"));
            nodes[place] = *found.ok_or_else(missing)?;
        }
        if self.elements.contains_key(&(scope.to_owned(), label)) {
            return Err(card.wrong_at(line, format!("element {label} stands there twice: the second one")));
        }
        let cell = self.mesh.cells.push(label, shape, nodes);
        self.elements.insert((scope.to_owned(), label), cell);
        Ok(cell)
    }

    /// The members that a card lists.
    fn listed(&mut self, card: &Card, scope: &str, kind: Kind) -> Vec<u32> {
        let mut out = Vec::new();
        let is_range = card.get("GENERATE").is_some();
        self.each_row(card, &mut |model, row| {
            if is_range {
                let mut numbers =
                    row.fields.iter().filter(|field| !field.is_empty()).map(|field| card.label(field, row.line));
                let first =
                    numbers.next().unwrap_or_else(|| Err(card.wrong_at(row.line, "a range has no beginning")))?;
                let last = numbers.next().unwrap_or(Ok(first))?;
                let by = numbers.next().unwrap_or(Ok(1))?.max(1);
                // a range may contain labels that do not exist
                let labels = if kind == Kind::Nodes { &model.nodes } else { &model.elements };
                let range = (first..=last).step_by(by as usize);
                out.extend(range.filter_map(|label| labels.get(&(scope.to_owned(), label)).copied()));
                return Ok(());
            }
            let mut missing = None;
            for field in row.fields.iter().filter(|field| !field.is_empty()) {
                match model.found(card, field, row.line, scope, kind) {
                    Ok(found) => out.extend(found),
                    Err(error) => missing = missing.or(Some(error)),
                }
            }
            missing.map_or(Ok(()), Err)
        });
        out
    }

    /// The nodes or elements of a label or set, which may stand behind the name of an instance and a dot.
    pub(super) fn found(&self, card: &Card, field: &str, line: u32, scope: &str, kind: Kind) -> Result<Vec<u32>> {
        let name = field.trim_matches('"');
        if let Some(found) = self.label(name, scope, kind) {
            return Ok(found.into_iter().collect());
        }
        if let Some(set) = self.sets.find(kind, scope, name) {
            return Ok(if kind == Kind::Nodes { set.nodes.clone() } else { set.cells.clone() });
        }
        let what = if kind == Kind::Nodes { "node or set of nodes" } else { "element or set of elements" };
        let line_of_card = card.place().line;
        Err(card.wrong_at(if line == 0 { line_of_card } else { line }, format!("there is no {what} {field}")))
    }

    /// The node or element of a label, `None` where the name is no label; an element that is left out is none of both.
    fn label(&self, name: &str, scope: &str, kind: Kind) -> Option<Option<u32>> {
        let (scope, label) = match name.split_once('.') {
            Some((instance, own)) => (instance.to_ascii_uppercase(), own.parse().ok()?),
            None => (scope.to_owned(), name.parse().ok()?),
        };
        let labels = if kind == Kind::Nodes { &self.nodes } else { &self.elements };
        let key = (scope, label);
        labels.get(&key).map(|&found| Some(found)).or_else(|| self.omitted.contains(&key).then_some(None))
    }

    /// The node of a field that is a label, not a set.
    pub(super) fn single_node(&self, field: &str, scope: &str) -> Option<u32> {
        self.label(field.trim_matches('"'), scope, Kind::Nodes).flatten()
    }

    fn finish(mut self) -> Result<(Mesh, Vec<Diagnostic>)> {
        for (name, place) in &self.structural {
            let fact = format!("elements of type {name} come in as cells without stiffness");
            let problem = Diagnostic::warning("not-taken-over", fact);
            self.report.push(problem.at(place.clone()).remedy("mesh the bodies with solid elements"));
        }
        for (name, (what, remedy, place)) in &self.simpler {
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
