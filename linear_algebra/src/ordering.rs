//! Fill-reducing orderings: nested dissection of the graph of the nodes.

use std::sync::{Mutex, PoisonError};

use crate::csr::Csr;
use crate::solver::SolveError;
use crate::system::Layout;

/// The vertex of an equation that has none.
const NONE: u32 = u32::MAX;

/// An undirected graph without loops; neighbours of `v` are `targets[starts[v]..starts[v + 1]]`, ascending.
pub(crate) struct Graph {
    pub(crate) starts: Vec<usize>,
    pub(crate) targets: Vec<u32>,
}

impl Graph {
    pub(crate) fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    #[inline]
    pub(crate) fn neighbours(&self, v: usize) -> &[u32] {
        &self.targets[self.starts[v]..self.starts[v + 1]]
    }
}

/// Equations gathered by node: the vertices the ordering works with, and their graph.
///
/// Vertices `0..interior` are free to be ordered, the rest stays last.
pub(crate) struct Vertices {
    pub(crate) graph: Graph,
    pub(crate) interior: usize,
    /// Equations of each vertex, displacements before multipliers.
    pub(crate) equations: Vec<Vec<u32>>,
}

impl Vertices {
    /// Gathers the equations of `pattern`, those with `last` apart from the others of their node, inactive ones not at all.
    pub(crate) fn new(pattern: &Csr, layout: &Layout, last: &[bool]) -> Self {
        let nodes = layout.node.iter().max().map_or(0, |&node| node as usize + 1);
        let mut vertex_of_key = vec![NONE; 2 * nodes];
        let mut equations: Vec<Vec<u32>> = Vec::new();
        let mut vertex_of = vec![NONE; pattern.rows];
        let mut interior = 0;
        for wanted in [false, true] {
            for i in (0..pattern.rows).filter(|&i| last[i] == wanted && !layout.is_inactive(i)) {
                let key = &mut vertex_of_key[2 * layout.node[i] as usize + usize::from(wanted)];
                if *key == NONE {
                    *key = equations.len() as u32;
                    equations.push(Vec::new());
                }
                equations[*key as usize].push(i as u32);
                vertex_of[i] = *key;
            }
            if !wanted {
                interior = equations.len();
            }
        }
        for list in &mut equations {
            list.sort_by_key(|&i| (layout.multiplier[i as usize], i));
        }
        let graph = compressed_graph(pattern, &equations, &vertex_of);
        Self { graph, interior, equations }
    }
}

/// The graph of `pattern + patternᵀ` on the vertices.
fn compressed_graph(pattern: &Csr, equations: &[Vec<u32>], vertex_of: &[u32]) -> Graph {
    let vertices = equations.len();
    let mut seen = vec![NONE; vertices];
    let mut starts = vec![0_usize];
    let mut targets = Vec::new();
    for (v, list) in equations.iter().enumerate() {
        seen[v] = v as u32;
        for &i in list {
            for &j in pattern.row(i as usize).0 {
                let w = vertex_of[j as usize];
                if w != NONE && seen[w as usize] != v as u32 {
                    seen[w as usize] = v as u32;
                    targets.push(w);
                }
            }
        }
        starts.push(targets.len());
    }
    let mut by_target = vec![0_usize; vertices + 1];
    for &w in &targets {
        by_target[w as usize + 1] += 1;
    }
    for v in 0..vertices {
        by_target[v + 1] += by_target[v];
    }
    let mut sources = vec![0_u32; targets.len()];
    let mut next = by_target.clone();
    for v in 0..vertices {
        for &w in &targets[starts[v]..starts[v + 1]] {
            sources[next[w as usize]] = v as u32;
            next[w as usize] += 1;
        }
    }
    let mut graph = Graph { starts: vec![0], targets: Vec::with_capacity(targets.len()) };
    for v in 0..vertices {
        let from = graph.targets.len();
        graph.targets.extend_from_slice(&targets[starts[v]..starts[v + 1]]);
        graph.targets.extend_from_slice(&sources[by_target[v]..by_target[v + 1]]);
        graph.targets[from..].sort_unstable();
        let mut kept = from;
        for at in from..graph.targets.len() {
            if kept == from || graph.targets[kept - 1] != graph.targets[at] {
                graph.targets[kept] = graph.targets[at];
                kept += 1;
            }
        }
        graph.targets.truncate(kept);
        graph.starts.push(kept);
    }
    graph
}

/// METIS draws from one random sequence of the process, so that calls at the same time would disturb each other.
pub(crate) static METIS: Mutex<()> = Mutex::new(());

/// The interior vertices in elimination order, by METIS' nested dissection.
///
/// # Errors
/// [`SolveError::Failed`] when METIS refuses the graph or it has more than 2³¹ edges.
pub(crate) fn nested_dissection(vertices: &Vertices) -> Result<Vec<u32>, SolveError> {
    let count = vertices.interior;
    if count <= 1 {
        return Ok((0..count as u32).collect());
    }
    let mut starts: Vec<i32> = vec![0];
    let mut targets: Vec<i32> = Vec::with_capacity(vertices.graph.targets.len());
    for v in 0..count {
        targets.extend(vertices.graph.neighbours(v).iter().filter(|&&w| (w as usize) < count).map(|&w| w as i32));
        let end = i32::try_from(targets.len())
            .map_err(|_| SolveError::Failed("ordering: the graph has more than 2^31 edges".into()))?;
        starts.push(end);
    }
    if targets.is_empty() {
        return Ok((0..count as u32).collect());
    }
    let mut weights: Vec<i32> = vertices.equations[..count].iter().map(|list| list.len() as i32).collect();
    let mut options = [0_i32; metis_sys::METIS_NOPTIONS as usize];
    let mut size = count as i32;
    let mut order = vec![0_i32; count];
    let mut position = vec![0_i32; count];
    let alone = METIS.lock().unwrap_or_else(PoisonError::into_inner);
    // SAFETY: the arrays have the lengths METIS documents (`starts` count + 1, `targets` starts[count], the others
    // count, `options` METIS_NOPTIONS), the graph is symmetric without loops, and METIS keeps no pointer.
    let status = unsafe {
        metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
        metis_sys::METIS_NodeND(
            &mut size,
            starts.as_mut_ptr(),
            targets.as_mut_ptr(),
            weights.as_mut_ptr(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            position.as_mut_ptr(),
        )
    };
    drop(alone);
    if status != metis_sys::rstatus_et_METIS_OK {
        return Err(SolveError::Failed(format!("ordering: METIS_NodeND returned {status}")));
    }
    Ok(order.into_iter().map(|v| v as u32).collect())
}
