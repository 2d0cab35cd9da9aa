//! Bodies: elements that share nodes.

use super::model_part::ModelPart;

/// The body that each node is of, by the id of its first node; `None` for nodes of no element. Collective.
pub fn bodies_of_nodes(part: &ModelPart) -> Vec<Option<usize>> {
    let mut parents: Vec<u32> = (0..part.nodes.len() as u32).collect();
    let mut used = vec![false; part.nodes.len()];
    for nodes in (0..part.elements.len() as u32).map(|at| part.elements.nodes(at)).filter(|nodes| nodes.len() > 1) {
        let first = root(&mut parents, nodes[0]);
        for &node in nodes {
            used[node as usize] = true;
            let other = root(&mut parents, node);
            parents[other as usize] = first;
        }
    }
    let roots: Vec<usize> = (0..parents.len() as u32).map(|node| root(&mut parents, node) as usize).collect();
    let id = |node: usize| if used[node] { part.nodes.ids[node] as f64 } else { f64::MAX };
    let mut first: Vec<f64> = (0..used.len()).map(id).collect();
    // Ranks tell each other of what is connected elsewhere, until nothing changes any more.
    loop {
        let mut of_root = vec![f64::MAX; used.len()];
        roots.iter().zip(&first).for_each(|(&root, id)| of_root[root] = of_root[root].min(*id));
        let mut next: Vec<f64> = roots.iter().map(|&root| of_root[root]).collect();
        if let Some(share) = &part.share {
            share.halo.least(&mut next);
        }
        let changes = next != first;
        first = next;
        if !part.ranks.any(changes) {
            break;
        }
    }
    first.into_iter().map(|id| (id < f64::MAX).then_some(id as usize)).collect()
}

fn root(parents: &mut [u32], mut node: u32) -> u32 {
    while parents[node as usize] != node {
        parents[node as usize] = parents[parents[node as usize] as usize];
        node = parents[node as usize];
    }
    node
}
