//! The rows of a matrix that this rank owns, added up from what all ranks have, and what their columns are.

use rustc_hash::FxHashMap;
use zelus_linear_algebra::{Csr, Layout, Owned};

use crate::assembly::Numbering;
use crate::communication::Ranks;

/// "Not among those that own rows refer to."
const NONE: u32 = u32::MAX;

/// The nodes of own equations.
#[derive(Default)]
pub(super) struct OwnedNodes {
    first: u32,
    /// First number over all ranks, equations, and a bit for each that is a multiplier, of the node of each own equation.
    of_equations: Vec<[u32; 3]>,
    /// How this rank counts the equations it has: number of each own one, else [`NONE`].
    owned: Vec<u32>,
}

impl OwnedNodes {
    /// Those of the equations of `layout` that this rank owns.
    pub(super) fn new(ranks: &Ranks, numbering: &Numbering, layout: &Layout) -> Self {
        let first = numbering.starts[ranks.rank()] as u32;
        let mut of_equations: Vec<[u32; 3]> = Vec::with_capacity(numbering.own.len());
        // Equations of a node stand together.
        for of_node in numbering.own.chunk_by(|&a, &b| layout.node[a as usize] == layout.node[b as usize]) {
            let bit = |(k, &e): (usize, &u32)| u32::from(layout.multiplier[e as usize]) << k;
            let bits = of_node.iter().enumerate().map(bit).sum();
            let node = [first + of_equations.len() as u32, of_node.len() as u32, bits];
            of_equations.extend(of_node.iter().map(|_| node));
        }
        let mut owned = vec![NONE; layout.equations()];
        numbering.own.iter().enumerate().for_each(|(at, &e)| owned[e as usize] = at as u32);
        Self { first, of_equations, owned }
    }

    /// Number over all ranks of the first own equation.
    pub(super) fn first(&self) -> u32 {
        self.first
    }

    /// Number of own equations.
    pub(super) fn equations(&self) -> usize {
        self.of_equations.len()
    }
}

/// Places of equations in vectors of this rank: the own ones, then ghosts in the order in which it met their nodes.
#[derive(Clone, Default)]
pub(super) struct Places {
    first: u32,
    own: u32,
    /// Number over all ranks of each ghost.
    ghosts: Vec<u32>,
    at: FxHashMap<u32, u32>,
    /// First number, equations and bits of multipliers of each node of ghosts.
    nodes: Vec<[u32; 3]>,
    with_multipliers: Vec<[u32; 2]>,
}

impl Places {
    /// No ghosts yet.
    pub(super) fn new(nodes: &OwnedNodes) -> Self {
        Self { first: nodes.first, own: nodes.equations() as u32, ..Self::default() }
    }

    /// Number of own equations and ghosts.
    pub(super) fn len(&self) -> usize {
        self.own as usize + self.ghosts.len()
    }

    fn is_own(&self, number: u32) -> bool {
        number.checked_sub(self.first).is_some_and(|at| at < self.own)
    }

    /// Place of an equation, of which this rank knows, by its number over all ranks.
    pub(super) fn at(&self, number: u32) -> u32 {
        if self.is_own(number) { number - self.first } else { self.at[&number] }
    }

    /// Number over all ranks of the equation at a place.
    pub(super) fn number(&self, place: u32) -> u32 {
        place.checked_sub(self.own).map_or(place + self.first, |ghost| self.ghosts[ghost as usize])
    }

    /// Nodes of ghosts with multipliers, in the order in which the rank met them: first number, and equations.
    pub(super) fn with_multipliers(&self) -> &[[u32; 2]] {
        &self.with_multipliers
    }

    /// Gives places to the nodes of equations that have none; collective.
    pub(super) fn learn(
        &mut self,
        ranks: &Ranks,
        numbering: &Numbering,
        nodes: &OwnedNodes,
        numbers: impl Iterator<Item = u32>,
    ) {
        let is_new = |number: &u32| !self.is_own(*number) && !self.at.contains_key(number);
        let mut new: Vec<u32> = numbers.filter(is_new).collect();
        new.sort_unstable();
        new.dedup();
        let mut wanted = vec![Vec::new(); ranks.size()];
        new.iter().for_each(|&number| wanted[numbering.owner(number)].push(number));
        let node = |&number: &u32| nodes.of_equations[(number - nodes.first) as usize];
        let asked = ranks.exchange_indices(&wanted);
        let told: Vec<Vec<u32>> = asked.iter().map(|list| list.iter().flat_map(node).collect()).collect();
        for told in ranks.exchange_indices(&told) {
            for &[first, count, bits] in told.as_chunks().0 {
                if self.at.contains_key(&first) {
                    continue;
                }
                for number in first..first + count {
                    self.at.insert(number, self.own + self.ghosts.len() as u32);
                    self.ghosts.push(number);
                }
                self.nodes.push([first, count, bits]);
                if bits != 0 {
                    self.with_multipliers.push([first, count]);
                }
            }
        }
    }

    /// Nodes and kinds of all equations, own nodes first.
    pub(super) fn layout(&self, nodes: &OwnedNodes) -> Layout {
        let mut layout = Layout::default();
        let own = nodes.of_equations.chunk_by(|a, b| a[0] == b[0]).map(|of_node| of_node[0]);
        for (node, [_, count, bits]) in own.chain(self.nodes.iter().copied()).enumerate() {
            for k in 0..count {
                layout.node.push(node as u32);
                layout.multiplier.push(bits >> k & 1 == 1);
            }
        }
        layout
    }

    /// Who owns each ghost.
    pub(super) fn owned(&self, numbering: &Numbering) -> Vec<Owned> {
        let owned = |&number: &u32| {
            let owner = numbering.owner(number);
            (owner as u32, number - numbering.starts[owner] as u32)
        };
        self.ghosts.iter().map(owned).collect()
    }
}

/// Own rows of the sum of what all ranks have, with places as columns.
#[derive(Default)]
pub(super) struct OwnedMatrix {
    pub(super) matrix: Csr,
    /// Where the entries of own rows go.
    kept: Vec<u32>,
    /// Rows of this rank's part that are own.
    own: Vec<u32>,
    /// Entries that go to each rank.
    sent: Vec<Vec<u32>>,
    /// Where those from each rank go.
    received: Vec<Vec<u32>>,
}

impl OwnedMatrix {
    /// The pattern, for this rank's `part`; ghosts get places. Collective.
    pub(super) fn new(
        ranks: &Ranks,
        numbering: &Numbering,
        part: &Csr,
        nodes: &OwnedNodes,
        places: &mut Places,
    ) -> Self {
        let mut sent = vec![Vec::new(); ranks.size()];
        let (mut rows, mut columns) = (vec![Vec::new(); ranks.size()], vec![Vec::new(); ranks.size()]);
        for e in (0..part.rows).filter(|&e| nodes.owned[e] == NONE) {
            let range = part.row_starts[e]..part.row_starts[e + 1];
            if range.is_empty() {
                continue;
            }
            let number = numbering.numbers[e];
            let owner = numbering.owner(number);
            rows[owner].extend([number, range.len() as u32]);
            columns[owner].extend(part.columns[range.clone()].iter().map(|&c| numbering.numbers[c as usize]));
            sent[owner].extend(range.map(|at| at as u32));
        }
        let (rows, columns) = (ranks.exchange_indices(&rows), ranks.exchange_indices(&columns));
        let mut is_met = vec![false; part.rows];
        for &e in &numbering.own {
            part.row(e as usize).0.iter().for_each(|&c| is_met[c as usize] = true);
        }
        let met = || (0..part.rows).filter(|&e| is_met[e]);
        let numbers = met().map(|e| numbering.numbers[e]).chain(columns.iter().flatten().copied());
        places.learn(ranks, numbering, nodes, numbers);
        let mut place_of = vec![NONE; part.rows];
        met().for_each(|e| place_of[e] = places.at(numbering.numbers[e]));
        // Own row and place of each entry of others.
        let mut arrived: Vec<Vec<(u32, u32)>> = Vec::with_capacity(ranks.size());
        for (rows, columns) in rows.iter().zip(&columns) {
            let each = rows.as_chunks().0.iter().flat_map(|&[row, count]| (0..count).map(move |_| row));
            arrived.push(each.zip(columns).map(|(row, &column)| (row - places.first, places.at(column))).collect());
        }
        let mut of_others: Vec<(u32, u32)> = arrived.concat();
        of_others.sort_unstable();
        of_others.dedup();
        let mut rest = &of_others[..];
        let mut made = Self { own: numbering.own.clone(), sent, ..Self::default() };
        let (mut row_starts, mut joined) = (vec![0], Vec::with_capacity(part.entries()));
        let mut row: Vec<u32> = Vec::new();
        for (at, &e) in numbering.own.iter().enumerate() {
            let (own, others) = (part.row(e as usize).0, rest.partition_point(|entry| entry.0 as usize <= at));
            row.clear();
            row.extend(own.iter().map(|&c| place_of[c as usize]));
            row.extend(rest[..others].iter().map(|entry| entry.1));
            rest = &rest[others..];
            row.sort_unstable();
            row.dedup();
            let start = joined.len();
            let find = |&c: &u32| (start + row.partition_point(|&place| place < place_of[c as usize])) as u32;
            made.kept.extend(own.iter().map(find));
            joined.extend_from_slice(&row);
            row_starts.push(joined.len());
        }
        joined.shrink_to_fit();
        let find = |&(row, place): &(u32, u32)| {
            let range = row_starts[row as usize]..row_starts[row as usize + 1];
            (range.start + joined[range].partition_point(|&other| other < place)) as u32
        };
        made.received = arrived.iter().map(|list| list.iter().map(find).collect()).collect();
        // Columns count ghosts, rows do not yet.
        made.matrix = Csr { rows: numbering.own.len(), values: vec![0.0; joined.len()], row_starts, columns: joined };
        made
    }

    /// The values, for those of this rank's `part`; collective.
    pub(super) fn fill(&mut self, ranks: &Ranks, part: &Csr) {
        let sent: Vec<Vec<f64>> =
            self.sent.iter().map(|list| list.iter().map(|&at| part.values[at as usize]).collect()).collect();
        let values = &mut self.matrix.values;
        values.fill(0.0);
        let own = self.own.iter().flat_map(|&e| part.row(e as usize).1);
        self.kept.iter().zip(own).for_each(|(&place, value)| values[place as usize] += value);
        for (list, arrived) in self.received.iter().zip(ranks.exchange_numbers(&sent)) {
            list.iter().zip(arrived).for_each(|(&place, value)| values[place as usize] += value);
        }
    }
}
