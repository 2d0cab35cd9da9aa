//! Right-hand sides of blocks at the nodes of a model part, as forces of contact on bodies.

use super::local::{each_of_runs, own_runs};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, Request};
use crate::model::{ModelPart, Variable};

/// Adds up the right-hand sides of the active entities of `blocks` at the unknowns of `variable`: 3 numbers a node of the part,
/// written into `out`, the same on each rank that has the node. Collective.
///
/// # Errors
/// The first entity that cannot be computed.
pub fn nodal_vectors(
    part: &ModelPart,
    blocks: &[&dyn EntityBlock],
    variable: &Variable<[f64; 3]>,
    mut out: Vec<f64>,
) -> Result<Vec<f64>> {
    out.clear();
    out.resize(3 * part.nodes.len(), 0.0);
    let view = part.view();
    let add = |block: &dyn EntityBlock, out: &mut [f64]| {
        let component = |unknown| (0..3_u8).find(|&c| variable.component(c) == unknown);
        let unknowns = block.unknowns().iter().enumerate();
        let rows: Vec<(usize, usize, usize)> = unknowns
            .filter_map(|(row, at)| component(at.variable).map(|c| (row, usize::from(at.node), usize::from(c))))
            .collect();
        let acts = |at: usize| block.is_active(at, &view) && part.evaluates_pair(block.nodes(at));
        each_of_runs(block, &view, &own_runs(block.len(), acts), Request::Residual, |at, _, rhs| {
            let nodes = block.nodes(at);
            rows.iter().for_each(|&(row, node, c)| out[3 * nodes[node] as usize + c] += rhs[row]);
        })
    };
    let added = blocks.iter().try_for_each(|block| add(*block, &mut out));
    part.ranks.agree(added.map_err(Into::into))?;
    if let Some(share) = &part.share {
        share.halo.expand(|node, of| of.extend(3 * node..3 * node + 3)).sum(&mut out);
    }
    Ok(out)
}
