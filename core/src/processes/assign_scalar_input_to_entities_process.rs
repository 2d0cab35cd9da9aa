//! Gives nodes, conditions or elements the time series of the nearest site of a file.
//!
//! The file is JSON, `{"TIME": […], "1": {"ID": 7 or "COORDINATES": [x, y, z], "VALUES": {variable: […]}}, "2": …}`, or text
//! with tabs between: in the first line a word, then an id or (x,y,z) for each site; below, a time and a value for each.
//! Values are linear between times. Nearness is that of the initial positions, of entities that of their centres.

use crate::processes::ProcessEntry;
use std::path::{Path, PathBuf};

use super::assign_to_entities::{Container, centre};
use super::face_direction;
use super::prescription::{Load, LoadCarrier};
use super::process::{Process, ProcessRequest};
use super::target::{Target, read_text, scalar_variable};
use super::time_table::TimeTable;
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::io::FileUse;
use crate::model::{Fields, Model, ModelPart, ScalarVariable, SubPart, Table};
use crate::parameters::{Document, Node, Settings};
use crate::register;
use crate::vector3::{norm, sub};

/// Where a site is.
enum Site {
    At([f64; 3]),
    /// At the node or entity with this id.
    Id(usize),
}

struct AssignScalarInput {
    target: Target,
    containers: Vec<Container>,
    variable: ScalarVariable,
    /// Nodal values with history instead of those without.
    history: bool,
    sites: Vec<(Site, Table)>,
    /// Members of each container with their site, once the mesh is there.
    members: Vec<Vec<(u32, usize)>>,
    place: Place,
    file: PathBuf,
    messages: Vec<Diagnostic>,
}

fn build(
    request: &mut ProcessRequest<'_>,
    containers: fn(&Settings) -> Result<Vec<Container>>,
) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "variable_name", "file"];
    let settings = &request.settings_with(|defaults| defaults.require(&required))?;
    let algorithm = settings.get_str("transfer_algorithm")?;
    if algorithm != "nearest_neighbour" {
        let fact = format!("there is no transfer algorithm {algorithm:?}");
        return Err(settings
            .error("transfer_algorithm", "invalid-value", fact)
            .remedy("use \"nearest_neighbour\"")
            .into());
    }
    let path = request.folder.join(settings.get_str("file")?);
    let sites = match path.extension().and_then(|ending| ending.to_str()) {
        Some("json") => json_sites(&path, settings.get_str("variable_name")?)?,
        Some("txt") => text_sites(&path, settings)?,
        _ => {
            let fact = format!("{} is neither JSON nor text", path.display());
            return Err(settings.error("file", "invalid-value", fact).remedy("its name ends in .json or .txt").into());
        }
    };
    Ok(Box::new(AssignScalarInput {
        target: Target::new(settings, request.model)?,
        containers: containers(settings)?,
        variable: scalar_variable(settings)?,
        history: settings.get_bool("historical")?,
        sites,
        members: Vec::new(),
        place: settings.key_place("file"),
        file: path,
        messages: Vec::new(),
    }))
}

fn json_sites(path: &Path, variable: &str) -> Result<Vec<(Site, Table)>> {
    let root = Document::read(path)?.root;
    let numbers = |node: &Node| node.array()?.iter().map(Node::f64).collect::<Result<Vec<f64>>>();
    let times = numbers(root.require("TIME")?)?;
    let mut sites = Vec::new();
    for number in 1.. {
        let Some(site) = root.get(&number.to_string()) else { break };
        let place = match (site.get("ID"), site.get("COORDINATES")) {
            (Some(id), _) => Site::Id(id.usize()?),
            (None, Some(at)) => Site::At(numbers(at)?.try_into().map_err(|_| {
                Diagnostic::error("wrong-size", "\"COORDINATES\" are not three numbers").at(at.place())
            })?),
            (None, None) => {
                let fact = format!("site {number} has neither \"ID\" nor \"COORDINATES\"");
                return Err(Diagnostic::error("missing-key", fact).at(site.place()).into());
            }
        };
        let list = site.require("VALUES")?.require(variable)?;
        let values = numbers(list)?;
        if values.len() != times.len() {
            let fact = format!("site {number} has {} values for {} times", values.len(), times.len());
            return Err(Diagnostic::error("wrong-size", fact).at(list.place()).into());
        }
        sites.push((place, Table::new(times.iter().zip(values).map(|(&t, v)| [t, v]).collect())));
    }
    if sites.is_empty() {
        let fact = "there is no site \"1\"";
        return Err(Diagnostic::error("missing-key", fact)
            .at(root.place())
            .remedy("sites are named \"1\", \"2\", …")
            .into());
    }
    Ok(sites)
}

fn text_sites(path: &Path, settings: &Settings) -> Result<Vec<(Site, Table)>> {
    let text = read_text(settings, "file", path)?;
    let wrong = |line: usize, fact: String| {
        let remedy = "a line is a time and a value for each site, with tabs between";
        Diagnostic::error("bad-number", fact).at(Place::at(path, line as u32 + 1, 1)).remedy(remedy)
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let head = lines.next().map_or("", |(_, line)| line);
    let site = |word: &str| {
        let inner = word.trim().strip_prefix('(').and_then(|word| word.strip_suffix(')'));
        let Some(inner) = inner else { return word.trim().parse().ok().map(Site::Id) };
        let numbers: Vec<f64> = inner.split(',').map_while(|x| x.trim().parse().ok()).collect();
        numbers.try_into().ok().map(Site::At)
    };
    let sites: Vec<Site> = head.split('\t').skip(1).map_while(site).collect();
    if sites.is_empty() || sites.len() + 1 != head.split('\t').count() {
        return Err(wrong(0, "the first line does not name sites by id or (x,y,z)".to_owned()).into());
    }
    let mut series = vec![Vec::new(); sites.len()];
    for (at, line) in lines {
        let numbers: Vec<f64> = line.split('\t').map_while(|word| word.trim().parse().ok()).collect();
        if numbers.len() != sites.len() + 1 {
            let fact = format!("{} numbers for a time and {} sites", numbers.len(), sites.len());
            return Err(wrong(at, fact).into());
        }
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(wrong(at, format!("a number of the table is {number}")).into());
        }
        series.iter_mut().zip(&numbers[1..]).for_each(|(points, &value)| points.push([numbers[0], value]));
    }
    Ok(sites.into_iter().zip(series.into_iter().map(Table::new)).collect())
}

impl AssignScalarInput {
    /// The members of a container with the site that is nearest to each, of equal ones the first.
    fn nearest(&self, part: &ModelPart, selection: &SubPart, container: Container) -> Result<Vec<(u32, usize)>> {
        let position = |at: u32| match container {
            Container::Nodes => part.nodes.initial[at as usize],
            Container::Conditions => centre(part.conditions.nodes(at), &part.nodes.initial),
            Container::Elements => centre(part.elements.nodes(at), &part.nodes.initial),
        };
        let of_id = |id: usize| match container {
            Container::Nodes => part.nodes.find(id),
            Container::Conditions => part.conditions.find(id),
            Container::Elements => part.elements.find(id),
        };
        let mut places = Vec::new();
        for (site, _) in &self.sites {
            places.push(match site {
                Site::At(x) => *x,
                Site::Id(id) => {
                    // Each rank knows its own part of the mesh.
                    let here = of_id(*id).map_or(Vec::new(), |at| position(at).to_vec());
                    let anywhere = part.ranks.gather_numbers(&here).into_iter().find_map(|x| x.try_into().ok());
                    anywhere.ok_or_else(|| {
                        let fact = format!("the file names {id}, which the mesh does not have");
                        Diagnostic::error("unknown-id", fact).at(self.place.clone())
                    })?
                }
            });
        }
        let members = match container {
            Container::Nodes => &selection.nodes,
            Container::Conditions => &selection.conditions,
            Container::Elements => &selection.elements,
        };
        let nearest = |&at: &u32| {
            let distance = |site: &usize| norm(sub(position(at), places[*site]));
            let site = (0..places.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            (at, site.expect("a file has sites"))
        };
        Ok(members.iter().map(nearest).collect())
    }
}

impl Process for AssignScalarInput {
    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::Reads(self.file.clone())]
    }

    fn decisive_files(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root(&self.target.path)?;
        let selection = self.target.selection(&part.tree)?;
        let members = self.containers.iter().map(|&container| self.nearest(part, selection, container));
        self.members = members.collect::<Result<_>>()?;
        let (nodes, conditions) = (selection.nodes.clone(), selection.conditions.clone());
        let part = model.root_mut(&self.target.path)?;
        for container in &self.containers {
            let said = match container {
                Container::Nodes if self.history => face_direction::pulling_of_nodes(part, &nodes, self.variable, None),
                Container::Conditions => face_direction::pulling(part, &conditions, self.variable, None),
                Container::Nodes | Container::Elements => None,
            };
            self.messages.extend(said.map(|said| said.at(self.target.place.clone())));
        }
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn time_tables(&self) -> Vec<TimeTable> {
        let name = self.file.file_name().unwrap_or_default().to_string_lossy();
        let of_site =
            |(_, table): &(Site, Table)| TimeTable::new(&name, self.place.clone(), table, self.target.interval);
        self.sites.iter().take(1).filter_map(of_site).collect()
    }

    fn loads(&self, part: &ModelPart) -> Vec<Load> {
        let carrier = |of: &Container| if self.history { LoadCarrier::History } else { of.carrier() };
        let variable = || std::iter::once(self.variable);
        self.containers.iter().filter_map(|of| self.target.load(part, variable(), carrier(of))).collect()
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let time = part.info.time;
        if !self.target.interval.contains(time) {
            return Ok(());
        }
        let values: Vec<f64> = self.sites.iter().map(|(_, table)| table.value(time)).collect();
        for (container, members) in self.containers.iter().zip(&self.members) {
            let data: &mut Fields = match container {
                Container::Nodes if self.history => &mut part.nodes.history,
                Container::Nodes => &mut part.nodes.values,
                Container::Conditions => &mut part.conditions.data,
                Container::Elements => &mut part.elements.data,
            };
            data.add_named(self.variable.column, if self.variable.component.is_some() { 3 } else { 1 });
            let field = data.field_mut(self.variable.column)?;
            for &(at, site) in members {
                field.levels[0][at as usize * field.components + self.variable.offset()] = values[site];
            }
        }
        Ok(())
    }
}

macro_rules! register_inputs {
    ($($name:literal, $alias:literal, $of:literal, $containers:expr;)+) => {
        $(register! { ProcessEntry $name,
            aliases: &[$alias],
            about: concat!("gives ", $of, " of a part the time series of the nearest site of a file"),
            defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/", $name, ".json")),
            build: |request| build(request, $containers),
        })+
    };
}

register_inputs! {
    "assign_scalar_input_to_entities_process", "AssignScalarInputToEntitiesProcess", "the listed kinds of entities",
        Container::list;
    "assign_scalar_input_to_nodes_process", "AssignScalarInputToNodesProcess", "the nodes",
        |_| Ok(vec![Container::Nodes]);
    "assign_scalar_input_to_conditions_process", "AssignScalarInputToConditionsProcess", "the conditions",
        |_| Ok(vec![Container::Conditions]);
    "assign_scalar_input_to_elements_process", "AssignScalarInputToElementsProcess", "the elements",
        |_| Ok(vec![Container::Elements]);
}
