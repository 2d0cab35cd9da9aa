//! Repartitions states of ranks to another number of ranks, by the places of nodes in the whole mesh.

use rustc_hash::FxHashMap;
use zelus_linear_algebra::{State, StateMapper, Unknowns};

use super::rank_layout::RankLayout;
use super::saved_run::{SavedStage, States, other_deck};
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::entities::repartition;
use crate::model::ModelPart;

/// Owner of the state that is visited.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visited {
    /// State of an earlier rank.
    EarlierRank(usize),
    /// State of the new rank at its start.
    NewRankAtStart,
    /// The one that the rank to come is to have.
    NewRank,
}

/// A place in the whole mesh, and a component or unknown there.
type Key = (u32, u32);

/// See [`StateMapper`].
pub(super) struct Repartitioning {
    earlier_ranks: Vec<RankLayout>,
    new_rank: RankLayout,
    /// Node of the rank to come by place.
    nodes: FxHashMap<u32, u32>,
    visited: Visited,
    /// The unknowns of whom is shown.
    unknowns: Unknowns,
    /// Unknowns of the new rank, in the order in which they are begun.
    begun: Vec<Unknowns>,
    /// How many of them are.
    beginnings: usize,
    /// Names of unknowns.
    names: Vec<String>,
    /// Numbers of all ranks by key, for each column visited.
    shown: Vec<FxHashMap<Key, f64>>,
    /// How many columns of this state were shown.
    at: usize,
    fault: Option<String>,
}

impl Repartitioning {
    /// From the ranks that were to the present one, which has this of the part.
    pub(super) fn new(earlier_ranks: Vec<RankLayout>, part: &ModelPart, system: &System) -> Self {
        let new_rank = RankLayout::new(part, part.ranks.rank(), system.dofs.layout());
        Self {
            earlier_ranks,
            nodes: new_rank.places.iter().enumerate().map(|(node, &place)| (place, node as u32)).collect(),
            new_rank,
            visited: Visited::NewRankAtStart,
            unknowns: Unknowns::default(),
            begun: Vec::new(),
            beginnings: 0,
            names: Vec::new(),
            shown: Vec::new(),
            at: 0,
            fault: None,
        }
    }

    /// State of a stage on the new rank, from `stages`, the states of all earlier ranks; `begins` is the new rank's state at the start.
    ///
    /// # Errors
    /// States that do not fit each other or the mesh.
    pub(super) fn stage(mut self, stages: Vec<SavedStage>, begins: SavedStage, system: &System) -> Result<SavedStage> {
        let (mut elements, mut conditions) = (Vec::new(), Vec::new());
        let (mut strategies, mut interactions, mut processes) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = None;
        for stage in stages {
            first.get_or_insert((stage.begun, stage.contents, stage.first_length, stage.unknowns));
            elements.push(stage.elements);
            conditions.push(stage.conditions);
            strategies.push(vec![stage.strategy]);
            interactions.push(stage.interactions);
            processes.push(stage.processes);
        }
        let (begun, contents, first_length, unknowns) = first.ok_or_else(|| other_deck("it was saved by no rank"))?;
        Ok(SavedStage {
            begun,
            contents,
            first_length,
            unknowns,
            elements: repartition(&system.elements, elements)?,
            conditions: repartition(&system.conditions, conditions)?,
            strategy: self.states(strategies, vec![begins.strategy])?.swap_remove(0),
            interactions: self.states(interactions, begins.interactions)?,
            processes: self.states(processes, begins.processes)?,
        })
    }

    /// The states to come of as many participants: of those by rank, and as they begin.
    fn states(&mut self, of_ranks: Vec<States>, begin: States) -> Result<States> {
        let count = of_ranks.first().map_or(0, Vec::len);
        if of_ranks.iter().any(|states| states.len() != count) {
            return Err(other_deck("its ranks had different participants"));
        }
        let mut of_ranks: Vec<_> = of_ranks.into_iter().map(Vec::into_iter).collect();
        let mut begin = begin.into_iter();
        (0..count)
            .map(|_| {
                let all = of_ranks.len();
                let states: Vec<_> = of_ranks.iter_mut().filter_map(|states| states.next().flatten()).collect();
                let begins = begin.next().flatten();
                match states.len() {
                    0 => Ok(None),
                    count if count == all => self.state(states, begins).map(Some),
                    _ => Err(other_deck("its ranks had different participants")),
                }
            })
            .collect()
    }

    fn state(&mut self, mut of_ranks: Vec<Box<dyn State>>, begins: Option<Box<dyn State>>) -> Result<Box<dyn State>> {
        (self.shown, self.begun) = (Vec::new(), Vec::new());
        for (rank, state) in of_ranks.iter_mut().enumerate() {
            self.visit(Visited::EarlierRank(rank), self.earlier_ranks[rank].unknowns.clone());
            state.remap(self);
        }
        if let Some(mut begins) = begins {
            self.visit(Visited::NewRankAtStart, self.new_rank.unknowns.clone());
            begins.remap(self);
        }
        let mut new_rank = of_ranks.swap_remove(0);
        self.visit(Visited::NewRank, self.new_rank.unknowns.clone());
        new_rank.remap(self);
        self.fault.take().map_or(Ok(new_rank), |fault| Err(other_deck(fault)))
    }

    fn visit(&mut self, visited: Visited, unknowns: Unknowns) {
        (self.visited, self.unknowns, self.at, self.beginnings) = (visited, unknowns, 0, 0);
    }

    fn fail(&mut self, fact: &str) {
        self.fault.get_or_insert_with(|| fact.to_owned());
    }

    /// Keys of the unknowns of whom is shown, which has these places.
    fn keys(&mut self, places: &[u32]) -> Vec<Key> {
        let mut keys = Vec::new();
        let mut places = places.iter();
        for (nodes, names) in &self.unknowns.0 {
            let mut number = |name: &String| {
                let known = self.names.iter().position(|known| known == name);
                known.unwrap_or_else(|| {
                    self.names.push(name.clone());
                    self.names.len() - 1
                }) as u32
            };
            let names: Vec<u32> = names.iter().map(&mut number).collect();
            for &place in places.by_ref().take(*nodes as usize) {
                keys.extend(names.iter().map(|&name| (place, name)));
            }
        }
        keys
    }

    /// Keeps the numbers of the shown rank under their keys, or gives those of the rank to come.
    fn column(&mut self, values: &mut Vec<f64>, keys: impl FnOnce(&mut Self, &[u32], usize) -> Vec<Key>) {
        match self.visited {
            Visited::NewRankAtStart => {}
            Visited::EarlierRank(rank) => {
                let RankLayout { places, owned, .. } = &self.earlier_ranks[rank];
                let (places, owned): (_, FxHashMap<u32, bool>) =
                    (places.clone(), places.iter().copied().zip(owned.iter().copied()).collect());
                if self.shown.len() <= self.at {
                    self.shown.push(FxHashMap::default());
                }
                let keys = if values.is_empty() { Vec::new() } else { keys(self, &places, values.len()) };
                if keys.len() != values.len() {
                    self.fail("the history of its ranks does not fit their mesh");
                }
                let column = &mut self.shown[self.at];
                for (key, &value) in keys.into_iter().zip(&*values) {
                    if owned[&key.0] {
                        column.insert(key, value);
                    } else {
                        column.entry(key).or_insert(value);
                    }
                }
            }
            Visited::NewRank if values.is_empty() => {}
            Visited::NewRank => {
                let places = self.new_rank.places.clone();
                let components = values.len() / self.earlier_ranks[0].places.len().max(1);
                let keys = keys(self, &places, components * places.len());
                let Some(column) = self.shown.get(self.at) else {
                    return self.fail("its ranks remember different things");
                };
                match keys.iter().map(|key| column.get(key).copied()).collect() {
                    Some(numbers) => *values = numbers,
                    None => self.fail("its ranks do not remember all nodes"),
                }
            }
        }
        self.at += 1;
    }
}

impl StateMapper for Repartitioning {
    fn nodes(&mut self, nodes: &mut [u32]) {
        if self.visited != Visited::NewRank {
            return;
        }
        for node in nodes {
            match self.earlier_ranks[0].places.get(*node as usize).and_then(|place| self.nodes.get(place)) {
                Some(&new) => *node = new,
                None => return self.fail("it remembers something of nodes that not every rank has"),
            }
        }
    }

    fn by_node(&mut self, values: &mut Vec<f64>) {
        self.column(values, |_, places, count| {
            let components = (count / places.len().max(1)) as u32;
            places.iter().flat_map(|&place| (0..components).map(move |c| (place, c))).collect()
        });
    }

    fn by_unknown(&mut self, values: &mut Vec<f64>) {
        self.column(values, |repartitioning, places, _| repartitioning.keys(places));
    }

    fn begin_unknowns(&mut self, unknowns: &Unknowns) -> Unknowns {
        let unknowns = match self.visited {
            Visited::EarlierRank(_) => unknowns.clone(),
            Visited::NewRankAtStart => {
                self.begun.push(unknowns.clone());
                unknowns.clone()
            }
            Visited::NewRank => self.begun.get(self.beginnings).unwrap_or(unknowns).clone(),
        };
        self.beginnings += 1;
        std::mem::replace(&mut self.unknowns, unknowns)
    }
}
