//! Graphs cut into parts of equal weight, by METIS.

use std::sync::PoisonError;

use crate::ordering::METIS;
use crate::solver::SolveError;

/// Up to this number of parts the graph is halved again and again, which cuts fewer edges; beyond it, which takes
/// longer with every part, it is cut into all parts at once.
const BISECTED_PARTS: usize = 64;

/// An undirected graph with weights; neighbours of `v` are `targets[starts[v]..starts[v + 1]]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WeightedGraph {
    /// Where the neighbours of each vertex begin, one more than there are vertices.
    pub starts: Vec<usize>,
    /// Neighbours; every edge stands with both of its vertices, none with itself.
    pub targets: Vec<u32>,
    /// Weight of each edge, positive, the same in both directions.
    pub edge_weights: Vec<u32>,
    /// Weight of each vertex.
    pub vertex_weights: Vec<u32>,
}

/// The part of each vertex, from 0; parts of about equal weight with few edges between them, none empty.
///
/// The same graph gives the same parts on every machine and rank.
///
/// # Errors
/// [`SolveError::Failed`] when there are more parts than vertices, more than 2³¹ edges, or METIS refuses.
pub fn partition_graph(graph: &WeightedGraph, parts: usize) -> Result<Vec<u32>, SolveError> {
    let count = graph.vertex_weights.len();
    if parts == 0 || parts > count {
        return Err(SolveError::Failed(format!("partition: {parts} parts of {count} vertices")));
    }
    if parts == 1 {
        return Ok(vec![0; count]);
    }
    if parts == count {
        return Ok((0..count as u32).collect());
    }
    let narrow = |value: usize| {
        i32::try_from(value).map_err(|_| SolveError::Failed("partition: the graph has more than 2^31 edges".into()))
    };
    let mut starts: Vec<i32> = graph.starts.iter().map(|&at| narrow(at)).collect::<Result<_, _>>()?;
    let mut targets: Vec<i32> = graph.targets.iter().map(|&w| w as i32).collect();
    let mut edge_weights: Vec<i32> = graph.edge_weights.iter().map(|&w| w as i32).collect();
    let mut vertex_weights: Vec<i32> = graph.vertex_weights.iter().map(|&w| w as i32).collect();
    let mut options = [0_i32; metis_sys::METIS_NOPTIONS as usize];
    let (mut size, mut constraints, mut wanted, mut cut) = (narrow(count)?, 1_i32, narrow(parts)?, 0_i32);
    let mut part = vec![0_i32; count];
    let method =
        if parts <= BISECTED_PARTS { metis_sys::METIS_PartGraphRecursive } else { metis_sys::METIS_PartGraphKway };
    let alone = METIS.lock().unwrap_or_else(PoisonError::into_inner);
    // SAFETY: the arrays have the lengths METIS documents (`starts` count + 1, `targets` and `edge_weights`
    // starts[count], the others count, `options` METIS_NOPTIONS); null stands for equal sizes, equal targets and the
    // default tolerance; the graph is symmetric without loops, and METIS keeps no pointer.
    let status = unsafe {
        metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
        method(
            &mut size,
            &mut constraints,
            starts.as_mut_ptr(),
            targets.as_mut_ptr(),
            vertex_weights.as_mut_ptr(),
            std::ptr::null_mut(),
            edge_weights.as_mut_ptr(),
            &mut wanted,
            std::ptr::null_mut(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            &mut cut,
            part.as_mut_ptr(),
        )
    };
    drop(alone);
    if status != metis_sys::rstatus_et_METIS_OK {
        return Err(SolveError::Failed(format!("partition: METIS returned {status}")));
    }
    let mut part: Vec<u32> = part.into_iter().map(|p| p as u32).collect();
    fill_empty_parts(&mut part, parts);
    Ok(part)
}

/// Gives each empty part a vertex of the part that then has most: METIS leaves some empty when there are few vertices.
fn fill_empty_parts(part: &mut [u32], parts: usize) {
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); parts];
    for (v, &p) in part.iter().enumerate() {
        members[p as usize].push(v as u32);
    }
    let mut largest: std::collections::BinaryHeap<(usize, std::cmp::Reverse<usize>)> =
        members.iter().enumerate().map(|(p, list)| (list.len(), std::cmp::Reverse(p))).collect();
    for empty in 0..parts {
        if !members[empty].is_empty() {
            continue;
        }
        // the entries of the heap are those of parts that only shrink here, each put back after it has given
        let Some((_, std::cmp::Reverse(giver))) = largest.pop() else { return };
        let Some(v) = members[giver].pop() else { return };
        part[v as usize] = empty as u32;
        members[empty].push(v);
        largest.push((members[giver].len(), std::cmp::Reverse(giver)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` × `n` vertices.
    fn grid(n: usize) -> WeightedGraph {
        let mut graph = WeightedGraph { starts: vec![0], ..WeightedGraph::default() };
        for v in 0..n * n {
            let (i, j) = (v % n, v / n);
            let near = [(i > 0, v.wrapping_sub(1)), (i + 1 < n, v + 1), (j > 0, v.wrapping_sub(n)), (j + 1 < n, v + n)];
            graph.targets.extend(near.iter().filter(|(there, _)| *there).map(|&(_, w)| w as u32));
            graph.starts.push(graph.targets.len());
            graph.vertex_weights.push(1);
        }
        graph.edge_weights = vec![1; graph.targets.len()];
        graph
    }

    #[test]
    fn parts_are_balanced_and_never_empty() {
        let graph = grid(30);
        for parts in [1, 2, 3, 7, 64, 65, 300, 899, 900] {
            let part = partition_graph(&graph, parts).unwrap();
            assert_eq!(part, partition_graph(&graph, parts).unwrap(), "the same twice");
            let mut sizes = vec![0; parts];
            part.iter().for_each(|&p| sizes[p as usize] += 1);
            assert!(*sizes.iter().min().unwrap() >= 1, "{parts}");
            if parts < 10 {
                assert!(*sizes.iter().max().unwrap() <= 900_usize.div_ceil(parts) + 1, "{sizes:?}");
            }
        }
    }

    #[test]
    fn two_halves_of_a_grid_are_cut_across() {
        let graph = grid(30);
        let part = partition_graph(&graph, 2).unwrap();
        let cut = (0..900)
            .flat_map(|v| graph.targets[graph.starts[v]..graph.starts[v + 1]].iter().map(move |&w| (v, w as usize)))
            .filter(|&(v, w)| part[v] != part[w])
            .count();
        assert!(cut / 2 <= 33, "{cut}");
    }

    #[test]
    fn more_parts_than_vertices_are_refused() {
        assert!(partition_graph(&grid(2), 5).is_err());
        assert!(partition_graph(&grid(2), 0).is_err());
    }
}
