//! Bodies: elements that share nodes.

use std::sync::atomic::{AtomicBool, Ordering};

use zelus_linear_algebra::{Components, parallel};

use super::model_part::ModelPart;

/// Elements that a thread takes at a time, at least.
const ELEMENTS: usize = 1 << 10;

/// The body that each node is of, by the id of its first node; `None` for nodes of no element. Collective.
pub fn bodies_of_nodes(part: &ModelPart) -> Vec<Option<usize>> {
    let (nodes, elements) = (part.nodes.len(), &part.elements);
    let components = Components::new(nodes);
    let used: Vec<AtomicBool> = (0..nodes).map(|_| AtomicBool::new(false)).collect();
    parallel::ranges(elements.len(), ELEMENTS, &|range| {
        for at in range {
            let [first, others @ ..] = elements.nodes(at as u32) else { continue };
            for &other in others {
                components.join(*first, other);
                used[other as usize].store(true, Ordering::Relaxed);
            }
            if !others.is_empty() {
                used[*first as usize].store(true, Ordering::Relaxed);
            }
        }
    });
    let used: Vec<bool> = used.into_iter().map(AtomicBool::into_inner).collect();
    let roots: Vec<usize> = (0..nodes as u32).map(|node| components.first(node) as usize).collect();
    let id = |node: usize| if used[node] { part.nodes.ids[node] as f64 } else { f64::MAX };
    let mut first: Vec<f64> = (0..used.len()).map(id).collect();
    // Ranks tell each other of connections elsewhere, until nothing changes any more.
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
