//! A condition or law whose residual is a function of Python over all entities of a part.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Deserialize;
use zelus::Result;
use zelus::core::assembly::{NONE, System};
use zelus::core::diagnostics::{Diagnostic, Report};
use zelus::core::entities::{
    Coupling, EntityBlock, EntityError, Interaction, LocalSystems, LocalUnknown, Request, StepView, Tangent,
};
use zelus::core::model::{EntityKind, EntityRole, Model, ModelPart, Named, ScalarVariable, VariableKind, named};
use zelus::core::registry::Entry;

use crate::event::Event;
use crate::line::{Answer, Line};

/// Description that Python gives of the residual.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Description {
    /// The part whose entities it is of.
    pub(crate) part: String,
    /// "elements", "conditions" or "nodes".
    entities: String,
    unknowns: Vec<String>,
    symmetric: bool,
}

static KIND: EntityKind = EntityKind::new(EntityRole::Condition, Entry::new("Python", file!(), line!()));

/// The blocks of one function, one for each number of nodes.
pub(crate) struct PythonResidual {
    blocks: Vec<Block>,
}

impl PythonResidual {
    /// The blocks over the entities of a part; Python receives each, with ids and nodes.
    pub(crate) fn new(number: usize, line: &Arc<Line>, own: &Description, model: &mut Model) -> Result<Self> {
        let part = model.root(&own.part)?;
        let unknowns: Vec<_> = own.unknowns.iter().map(|name| scalar(name)).collect::<Result<_, _>>()?;
        let mut groups: BTreeMap<usize, (Vec<usize>, Vec<u32>)> = BTreeMap::new();
        for (id, nodes) in entities(part, own)? {
            let group = groups.entry(nodes.len()).or_default();
            group.0.push(id);
            group.1.extend(nodes);
        }
        if groups.is_empty() {
            let fact = format!("{} has no {}", own.part, own.entities);
            let remedy = "name a part that has some, or other \"entities\": elements, conditions, nodes";
            return Err(Diagnostic::error("empty-part", fact).remedy(remedy).into());
        }
        let mut blocks = Vec::new();
        for (at, (width, (ids, nodes))) in groups.into_iter().enumerate() {
            line.ask(Event::Block(number, at, ids.clone(), nodes.clone(), width), model, None)?;
            let local = (0..width).flat_map(|node| unknowns.iter().map(move |&variable| (node, variable)));
            let local = local.map(|(node, variable)| LocalUnknown::of_node(node as u8, variable)).collect();
            let tangent = if own.symmetric { Tangent::Symmetric } else { Tangent::Unsymmetric };
            let line = Arc::clone(line);
            blocks.push(Block {
                number,
                at,
                line,
                ids,
                nodes,
                width,
                unknowns: local,
                tangent,
                cache: Mutex::default(),
            });
        }
        Ok(Self { blocks })
    }
}

/// Says where an unknown is none of the solver's.
pub(crate) fn check(own: &Description, model: &Model, system: &System, report: &mut Report) -> Result<()> {
    let part = model.root(&own.part)?;
    for name in &own.unknowns {
        let numbers = system.dofs.numbers(scalar(name)?);
        let lacks = |node: &u32| numbers.get(*node as usize).is_none_or(|&number| number == NONE);
        if let Some(node) = entities(part, own)?.iter().flat_map(|(_, nodes)| nodes).find(|node| lacks(node)) {
            let fact = format!("{name} is no unknown at node {}", part.nodes.ids[*node as usize]);
            let remedy = "elements bring unknowns: name one of theirs, at nodes of theirs";
            report.push(Diagnostic::error("no-unknown", fact).remedy(remedy));
        }
    }
    Ok(())
}

fn scalar(name: &str) -> Result<ScalarVariable, Diagnostic> {
    match named(name) {
        Some(Named::Component(scalar)) => Ok(scalar),
        Some(Named::Whole(column, VariableKind::Scalar)) => Ok(ScalarVariable { column, component: None }),
        _ => Err(Diagnostic::error("unknown-variable", format!("{name} is no unknown"))
            .remedy("name single numbers, as DISPLACEMENT_X or TEMPERATURE")),
    }
}

/// Id and nodes of the entities.
fn entities(part: &ModelPart, own: &Description) -> Result<Vec<(usize, Vec<u32>)>> {
    let selected = part.part(&own.part)?;
    let (table, items) = match own.entities.as_str() {
        "nodes" => {
            let id = |&node: &u32| (part.nodes.ids[node as usize], vec![node]);
            return Ok(selected.nodes.iter().map(id).collect());
        }
        "elements" => (&part.elements, &selected.elements),
        "conditions" => (&part.conditions, &selected.conditions),
        other => {
            let fact = format!("\"entities\" is {other:?}");
            return Err(Diagnostic::error("wrong-value", fact).remedy("use elements, conditions or nodes").into());
        }
    };
    Ok(items.iter().map(|&item| (table.ids[item as usize], table.nodes(item).to_vec())).collect())
}

impl Interaction for PythonResidual {
    fn name(&self) -> &str {
        "Python"
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }
}

impl Coupling for PythonResidual {
    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(|block| block as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        0
    }
}

/// Entities of one number of nodes.
struct Block {
    number: usize,
    at: usize,
    line: Arc<Line>,
    ids: Vec<usize>,
    nodes: Vec<u32>,
    width: usize,
    unknowns: Vec<LocalUnknown>,
    tangent: Tangent,
    cache: Mutex<Option<Evaluated>>,
}

/// Last values of the function.
struct Evaluated {
    values: Vec<f64>,
    time: f64,
    residual: Vec<f64>,
    /// Row by row; empty when it was not asked for.
    tangent: Vec<f64>,
}

impl Block {
    /// The unknowns of all entities, in the order of their rows.
    fn gather(&self, view: &StepView<'_>) -> Vec<f64> {
        let value = |(nodes, unknown): (&[u32], &LocalUnknown)| {
            let node = nodes[usize::from(unknown.node)] as usize;
            view.nodes.history.scalar(unknown.variable, node).unwrap_or_default()
        };
        let rows = self.nodes.chunks_exact(self.width);
        rows.flat_map(|nodes| self.unknowns.iter().map(move |unknown| value((nodes, unknown)))).collect()
    }

    fn evaluate(&self, view: &StepView<'_>, values: Vec<f64>, both: bool) -> Result<Evaluated, EntityError> {
        let (time, length) = (view.info.time, view.info.delta_time);
        let event =
            Event::Evaluate { process: self.number, block: self.at, values: values.clone(), time, length, both };
        let size = self.unknowns.len();
        let (residual, tangent) = match self.line.ask_alone(event) {
            Ok(Answer::Numbers(residual, tangent)) => (residual, tangent),
            Ok(_) => (Vec::new(), Vec::new()),
            Err(error) => return Err(self.wrong(error.to_string())),
        };
        let fits = residual.len() == values.len() && (!both || tangent.len() == values.len() * size);
        if !fits || residual.iter().chain(&tangent).any(|number| !number.is_finite()) {
            return Err(self.wrong("its function gave numbers that are not finite, or not one a row".to_owned()));
        }
        Ok(Evaluated { values, time, residual, tangent })
    }

    fn wrong(&self, fact: String) -> EntityError {
        let remedy = "look at the function in Python";
        EntityError { kind: KIND.entry.name, id: self.ids[0], nodes: Vec::new(), fact, remedy }
    }
}

impl EntityBlock for Block {
    fn entry(&self) -> &'static EntityKind {
        &KIND
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.ids.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        &self.nodes[at * self.width..][..self.width]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        self.tangent
    }

    fn is_active(&self, _at: usize, _view: &StepView<'_>) -> bool {
        true
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let values = self.gather(view);
        let both = request == Request::Both;
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let serves = |known: &Evaluated| {
            known.values == values && known.time == view.info.time && (!both || !known.tangent.is_empty())
        };
        if !cache.as_ref().is_some_and(serves) {
            *cache = Some(self.evaluate(view, values, both)?);
        }
        let known = cache.as_ref().expect("just evaluated");
        let size = self.unknowns.len();
        out.rhs.copy_from_slice(&known.residual[range.start * size..range.end * size]);
        if both {
            out.lhs.copy_from_slice(&known.tangent[range.start * size * size..range.end * size * size]);
        }
        Ok(())
    }
}
