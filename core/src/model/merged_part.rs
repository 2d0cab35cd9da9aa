//! Joins the shares of ranks to the whole part: the inverse of [`ModelPart::keep`].

use super::entity_table::EntityTable;
use super::geometries::Geometries;
use super::model_part::ModelPart;
use super::slave_nodes::SlaveNodes;
use super::sub_part::SubPart;

/// Where the entities of all shares, one share after another, are in the whole part.
struct MergedIndices {
    /// New index of each entity of the shares.
    new: Vec<u32>,
    /// For each entity of the whole its owner's.
    chosen: Vec<u32>,
}

impl MergedIndices {
    /// By ascending id; `owners` has for each entity the id, its rank and the rank that evaluates it.
    fn of(all: Vec<(usize, usize, u32)>, count: usize) -> Option<Self> {
        let is_own = |(_, (_, rank, owner)): &(usize, &(usize, usize, u32))| *owner as usize == *rank;
        let mut own: Vec<(usize, u32)> =
            all.iter().enumerate().filter(is_own).map(|(at, e)| (e.0, at as u32)).collect();
        own.sort_unstable();
        own.dedup_by_key(|(id, _)| *id);
        let place =
            |(id, ..): &(usize, usize, u32)| own.binary_search_by_key(id, |(id, _)| *id).ok().map(|at| at as u32);
        let new = all.iter().map(place).collect::<Option<_>>()?;
        (own.len() == count).then(|| Self { new, chosen: own.into_iter().map(|(_, at)| at).collect() })
    }
}

impl ModelPart {
    /// The whole part of the shares of all ranks, in their order; values are those of the owners. Entities stand by ascending id.
    ///
    /// # Errors
    /// Shares that do not make up a whole.
    pub fn merged(shares: Vec<Self>) -> Result<Self, String> {
        let incomplete = || "the shares of its ranks do not make up a whole mesh".to_owned();
        if shares.iter().all(|part| part.share.is_none()) {
            return shares.into_iter().next().ok_or_else(incomplete);
        }
        let ranks: Option<Vec<_>> = shares.iter().map(|part| part.share.as_ref()).collect();
        let ranks = ranks.ok_or_else(incomplete)?;
        let whole = ranks.first().ok_or_else(incomplete)?.whole;
        if whole.nodes > shares.iter().map(|part| part.nodes.len()).sum() {
            return Err(incomplete());
        }
        let (mut places, mut chosen) = (Vec::new(), vec![u32::MAX; whole.nodes]);
        for (rank, share) in ranks.iter().enumerate() {
            for (&place, &owner) in share.places.iter().zip(&share.owners) {
                let of_place = chosen.get_mut(place as usize).ok_or_else(incomplete)?;
                if owner as usize == rank {
                    *of_place = places.len() as u32;
                }
                places.push(place);
            }
        }
        if chosen.contains(&u32::MAX) {
            return Err(incomplete());
        }
        let entities = |table: fn(&Self) -> &EntityTable, owners: &[&Vec<u32>], count: usize| {
            let of_rank = |(rank, part): (usize, &Self)| {
                table(part).ids.iter().zip(owners[rank]).map(|(&id, &owner)| (id, rank, owner)).collect::<Vec<_>>()
            };
            MergedIndices::of(shares.iter().enumerate().flat_map(of_rank).collect(), count)
        };
        let owners: Vec<_> = ranks.iter().map(|share| &share.elements).collect();
        let elements = entities(|part| &part.elements, &owners, whole.elements).ok_or_else(incomplete)?;
        let owners: Vec<_> = ranks.iter().map(|share| &share.conditions).collect();
        let conditions = entities(|part| &part.conditions, &owners, whole.conditions).ok_or_else(incomplete)?;

        let has_all = shares[0].nodes.len() == whole.nodes && shares[0].elements.len() == whole.elements;
        let mut tree = SubPart::new(shares[0].name.clone());
        let mut from = [0; 3];
        for part in &shares {
            let counts = [part.nodes.len(), part.elements.len(), part.conditions.len()];
            let own = |list: &[u32], at: usize| list[from[at]..from[at] + counts[at]].to_vec();
            let mut of_rank = part.tree.clone();
            of_rank.renumber(&own(&places, 0), &own(&elements.new, 1), &own(&conditions.new, 2));
            tree.join(&of_rank);
            from.iter_mut().zip(counts).for_each(|(from, count)| *from += count);
        }
        tree.normalise();
        let of_ranks: Vec<_> = shares
            .iter()
            .zip(&ranks)
            .enumerate()
            .map(|(rank, (part, share))| {
                let owned = share.owners.iter().map(|&owner| owner as usize == rank).collect();
                (&part.slave_nodes, share.places.as_slice(), owned)
            })
            .collect();
        let slave_nodes = SlaveNodes::merged(&of_ranks)?;
        let mut shares = shares.into_iter();
        let mut all = shares.next().ok_or_else(incomplete)?;
        for part in shares {
            let offset = all.nodes.len() as u32;
            all.nodes.append(&part.nodes);
            all.elements.append(&part.elements, offset);
            all.conditions.append(&part.conditions, offset);
        }
        for constraint in &mut all.constraints {
            constraint.slave.0 = places[constraint.slave.0 as usize];
            constraint.masters.iter_mut().for_each(|((node, _), _)| *node = places[*node as usize]);
        }
        all.nodes = all.nodes.pick(&chosen);
        all.elements = all.elements.pick(&elements.chosen, &places);
        all.conditions = all.conditions.pick(&conditions.chosen, &places);
        if has_all {
            tree.take_geometries(&all.tree);
        } else {
            all.geometries = Geometries::default();
        }
        (all.tree, all.share, all.slave_nodes) = (tree, None, slave_nodes);
        all.interface_surfaces.clear();
        Ok(all)
    }

    /// The same part cut down to the entities of `share`, which is a share of the same mesh.
    ///
    /// # Errors
    /// Nodes or entities that are not here.
    pub fn cut_like(self, share: &Self) -> Result<Self, String> {
        let Some(of_rank) = &share.share else { return Ok(self) };
        let places = |table: &EntityTable, wanted: &EntityTable| -> Option<Vec<u32>> {
            wanted.ids.iter().map(|&id| table.find(id)).collect()
        };
        let (elements, conditions) =
            (places(&self.elements, &share.elements), places(&self.conditions, &share.conditions));
        let here = of_rank.places.iter().all(|&place| (place as usize) < self.nodes.len());
        let (Some(elements), Some(conditions), true) = (elements, conditions, here) else {
            return Err(format!("the mesh of {} is another than that of the saved run", share.name));
        };
        let mut cut = self.kept(&of_rank.places, &elements, &conditions);
        cut.tree.normalise();
        cut.share = Some(of_rank.clone());
        Ok(cut)
    }
}
