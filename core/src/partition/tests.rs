use std::collections::HashMap;

use super::mesh_shares::Shares;
use super::{Partition, PartitionCounts, Repeats, Surface, Traffic, common_nodes, partition, surfaces};
use crate::geometry::Shape;
use crate::model::test_variables::NORMAL;
use crate::model::{EntityKind, EntityRole, ModelPart, Nodes, SubPart};
use crate::parameters::{Document, Node};
use crate::processes::{NamedSurface, ProcessEntry};
use crate::register;
use crate::registry::Entry;

static HEXAHEDRON: EntityKind = EntityKind {
    cell: Some(Shape::Hex8),
    space: 3,
    ..EntityKind::new(EntityRole::Element, Entry::new("TestHexahedron", file!(), line!()))
};
static QUADRILATERAL: EntityKind = EntityKind {
    cell: Some(Shape::Quad4),
    space: 3,
    ..EntityKind::new(EntityRole::Condition, Entry::new("TestQuadrilateral", file!(), line!()))
};

/// Two cubes of `n`³ cells on each other, their meshes apart; part `Contact` holds both touching sides.
pub(super) fn two_blocks(n: usize) -> ModelPart {
    let mut part = ModelPart::new("Structure");
    let side = n + 1;
    let number = |block: usize, i: usize, j: usize, k: usize| (block * side.pow(3) + (k * side + j) * side + i) as u32;
    let mut points = Vec::new();
    for block in 0..2 {
        for k in 0..side {
            for j in 0..side {
                points.extend((0..side).map(|i| [i as f64, j as f64, (k + block * n) as f64].map(|x| x / n as f64)));
            }
        }
    }
    part.nodes = Nodes::new((1..=points.len()).collect(), points);
    for block in 0..2 {
        for (i, j, k) in (0..n * n * n).map(|at| (at % n, at / n % n, at / n / n)) {
            let corner = |a, b, c| number(block, i + a, j + b, k + c);
            let nodes = [
                corner(0, 0, 0),
                corner(1, 0, 0),
                corner(1, 1, 0),
                corner(0, 1, 0),
                corner(0, 0, 1),
                corner(1, 0, 1),
                corner(1, 1, 1),
                corner(0, 1, 1),
            ];
            part.elements.push(part.elements.len() + 1, &HEXAHEDRON, 1, &nodes);
            let at = part.conditions.len() + 1;
            if block == 1 && k == 0 {
                part.conditions.push(at, &QUADRILATERAL, 1, &[nodes[3], nodes[2], nodes[1], nodes[0]]);
            }
        }
    }
    let layer = |block: usize, k: usize| (0..side * side).map(move |at| number(block, at % side, at / side, k));
    let mut slave = SubPart::new("Slave");
    slave.nodes = layer(1, 0).collect();
    let mut contact = SubPart::new("Contact");
    contact.nodes = layer(0, n).chain(layer(1, 0)).collect();
    part.tree.children.insert("Slave".into(), slave);
    part.tree.children.insert("Contact".into(), contact);
    part
}

register! { ProcessEntry "partition_test_process",
    about: "names surfaces and nodes for the tests",
    common: &["model_part_name", "master_node_id"],
    surfaces: named,
    build: |_| unreachable!("it is only asked for its surfaces"),
}
/// The surfaces that the settings of the process of the tests name.
fn named(parameters: Option<&Node>) -> Vec<NamedSurface> {
    let name = |key| parameters?.get(key)?.as_str().map(str::to_owned);
    match (name("both"), name("slave")) {
        (Some(both), Some(slave)) => vec![NamedSurface::Parts { both: vec![both], slaves: vec![slave] }],
        _ => vec![NamedSurface::WholeSkin],
    }
}

/// The surfaces of [`two_blocks`], as a deck names them.
pub(super) fn its_surfaces(part: &ModelPart) -> Vec<Surface> {
    let deck = r#"{"processes": {"contact": [{"python_module": "partition_test_process",
        "Parameters": {"both": "Contact", "slave": "Structure.Slave"}}]}}"#;
    surfaces(&Document::from_str(deck, "deck.json").unwrap().root, part)
}

fn sizes(partition: &Partition) -> Vec<usize> {
    let mut sizes = vec![0; partition.ranks];
    partition.elements.iter().for_each(|&rank| sizes[rank as usize] += 1);
    sizes
}

#[test]
fn every_element_has_one_rank_and_the_loads_are_even() {
    let part = two_blocks(6);
    let surfaces = its_surfaces(&part);
    for ranks in [1, 2, 3, 4, 8, 100, 432] {
        let cut = partition(&part, &surfaces, ranks).unwrap();
        assert_eq!(cut, partition(&part, &surfaces, ranks).unwrap(), "the same twice");
        assert_eq!(sizes(&cut).iter().sum::<usize>(), 432);
        assert!(sizes(&cut).iter().all(|&size| size > 0), "{ranks}");
        let mut load = vec![0_usize; ranks];
        cut.elements.iter().for_each(|&rank| load[rank as usize] += 1);
        let slaves = cut.facets.iter().filter(|facet| facet.slave);
        slaves.for_each(|facet| load[cut.elements[facet.element as usize] as usize] += super::FACET_WEIGHT as usize);
        if ranks <= 8 {
            let mean = load.iter().sum::<usize>() / ranks;
            assert!(*load.iter().max().unwrap() <= mean + mean / 20 + 5, "{ranks}: {load:?}");
        }
    }
}

#[test]
fn nodes_and_conditions_go_with_elements() {
    let part = two_blocks(4);
    let cut = partition(&part, &its_surfaces(&part), 5).unwrap();
    let mut near: HashMap<u32, Vec<u32>> = HashMap::new();
    for element in 0..part.elements.len() as u32 {
        for &node in part.elements.nodes(element) {
            near.entry(node).or_default().push(cut.elements[element as usize]);
        }
    }
    for (node, owner) in cut.nodes.iter().enumerate() {
        assert!(near[&(node as u32)].contains(owner));
    }
    for (condition, rank) in cut.conditions.iter().enumerate() {
        let first = part.conditions.nodes(condition as u32)[0];
        assert!(near[&first].contains(rank));
    }
    let mut owned = vec![0_usize; 5];
    cut.nodes.iter().for_each(|&rank| owned[rank as usize] += 1);
    assert!(owned.iter().all(|&n| n * 10 > 250 * 8 / 10 / 2), "{owned:?}");
}

#[test]
fn facets_that_face_each_other_tend_to_share_a_rank() {
    let part = two_blocks(6);
    let cut = partition(&part, &its_surfaces(&part), 4).unwrap();
    assert_eq!(cut.facets.len(), 72);
    assert_eq!(cut.facets.iter().filter(|facet| facet.slave).count(), 36);
    let rank = |facet: &super::ContactFacet| cut.elements[facet.element as usize];
    let together = cut.facets.iter().filter(|facet| facet.slave).filter(|slave| {
        cut.facets.iter().any(|master| !master.slave && master.centre == slave.centre && rank(master) == rank(slave))
    });
    assert!(together.count() >= 30);
}

#[test]
fn a_deck_without_parts_of_contact_means_the_whole_skin() {
    let part = two_blocks(2);
    let deck = r#"{"processes": {"contact": [{"python_module": "partition_test_process"}]}}"#;
    let found = surfaces(&Document::from_str(deck, "deck.json").unwrap().root, &part);
    assert_eq!(found, [Surface { whole_skin: true, ..Surface::default() }]);
    assert_eq!(partition(&part, &found, 2).unwrap().facets.len(), 48);
}

#[test]
fn more_ranks_than_elements_are_refused() {
    let error = partition(&two_blocks(1), &[], 3).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("2 elements cannot be shared by 3 ranks"), "{error}");
}

#[test]
fn counts_of_a_halved_bar_are_those_of_its_section() {
    let part = two_blocks(4);
    let by_block: Vec<u32> = (0..128).map(|element| element / 64).collect();
    let mut cut = partition(&part, &its_surfaces(&part), 2).unwrap();
    // the blocks share no node, so one rank each leaves nothing but the pairs to talk about
    cut.nodes = (0..250).map(|node| node / 125).collect();
    (cut.elements, cut.cut) = (by_block, 0);
    let surfaces = its_surfaces(&part);
    let common = common_nodes(&part, &surfaces, &Document::from_str("{}", "deck.json").unwrap().root);
    let counts = PartitionCounts::new(&part, &cut, &common);
    let [lower, upper] = counts.ranks[..] else { panic!("two ranks") };
    assert_eq!((lower.nodes, lower.ghosts, lower.copies, lower.neighbours, lower.cut_faces), (125, 0, 0, 0, 0));
    assert_eq!((lower.slave_facets, upper.slave_facets, upper.far_pairs), (0, 16, 16));
    // two layers of 25 nodes a block at the interface
    assert_eq!((counts.common, lower.held, upper.held), (100, 125 + 50, 125 + 50));
    // 13³ pairs of neighbouring nodes a block: 3 n + 1 along each axis
    assert_eq!(counts.entries, 2 * 13 * 13 * 13);
    let repeats = Repeats { newton: 2, krylov: 3 };
    let bytes = 2 * (24 * 3 + 64 + (8 + 72) * 16 + 8 * 3 * 100);
    assert_eq!(counts.traffic(0, repeats), Traffic { messages: 2 * (9 + 4 + 1 + 2), bytes });
    assert_eq!(counts.traffic(1, repeats), counts.traffic(0, repeats));

    // lower block split along x = 1/2: a section of 25 nodes and 16 faces
    cut.elements = (0..128).map(|element| if element < 64 { u32::from(element % 4 >= 2) } else { 1 }).collect();
    cut.nodes = (0..250).map(|node| if node < 125 { u32::from(node % 5 > 2) } else { 1 }).collect();
    let counts = PartitionCounts::new(&part, &cut, &common);
    let [left, right] = counts.ranks[..] else { panic!("two ranks") };
    assert_eq!((left.nodes, left.ghosts, left.copies, left.neighbours, left.cut_faces), (75, 0, 25, 1, 16));
    assert_eq!((right.nodes, right.ghosts, right.copies, right.neighbours, right.cut_faces), (175, 25, 0, 1, 16));
    // rows of the section as the right half sees them: 13 · 13 pairs along it, 2 columns across
    assert_eq!(right.ghost_entries, 13 * 13 * 2);
}

/// Every rank has its elements with their nodes, the interface with the elements at it, and knows the shares of the others.
#[test]
fn ranks_keep_their_elements_and_the_interface() {
    let whole = two_blocks(6);
    let ranks = 5;
    let surfaces = its_surfaces(&whole);
    let cut = partition(&whole, &surfaces, ranks).unwrap();
    let deck = Document::from_str("{}", "deck.json").unwrap().root;
    let common = common_nodes(&whole, &surfaces, &deck);
    assert_eq!(common.iter().filter(|common| **common).count(), 2 * 49);
    let (of_all, mut shares) = (Shares::new(&whole, &cut, &common), Vec::new());
    for rank in 0..ranks {
        let mut part = of_all.of(&whole, rank);
        let share = part.share.take().unwrap();
        assert!(part.nodes.len() < 400 && share.owners.len() == part.nodes.len(), "{}", part.nodes.len());
        let own = |list: &[u32]| list.iter().filter(|&&owner| owner as usize == rank).count();
        assert_eq!(own(&share.elements), own(&cut.elements));
        assert_eq!((own(&share.owners), own(&share.conditions)), (own(&cut.nodes), own(&cut.conditions)));
        // Both layers of elements at the interface.
        assert!(part.elements.ids.iter().filter(|&&id| (181..=252).contains(&id)).count() == 72);
        for element in 0..part.elements.len() as u32 {
            let id = |node: &u32| part.nodes.ids[*node as usize];
            let before = whole.elements.find(part.elements.ids[element as usize]).unwrap();
            assert!(
                part.elements.nodes(element).iter().map(id).eq(whole
                    .elements
                    .nodes(before)
                    .iter()
                    .map(|n| *n as usize + 1))
            );
        }
        assert_eq!(part.part("Contact").unwrap().nodes.len(), 98);
        shares.push(share);
    }
    for (a, b) in (0..ranks).flat_map(|a| (0..ranks).map(move |b| (a, b))).filter(|(a, b)| a != b) {
        let places = |share: &crate::model::MeshShare, list: &[u32]| {
            list.iter().map(|&n| share.places[n as usize]).collect::<Vec<u32>>()
        };
        assert_eq!(places(&shares[a], &shares[a].halo.copied[b]), places(&shares[b], &shares[b].halo.copies[a]));
        for (of_a, of_b) in shares[a].halo.everywhere.iter().zip(&shares[b].halo.everywhere) {
            assert_eq!(places(&shares[a], of_a), places(&shares[b], of_b));
        }
    }
}

/// Slave nodes of interfaces go to all ranks in one order, those of other nodes with their nodes; shares make the whole again.
#[test]
fn slave_nodes_go_with_their_mesh_nodes_and_come_back() {
    let mut whole = two_blocks(3);
    let slaves = whole.part("Slave").unwrap().nodes.clone();
    whole.slave_nodes.set("floor", &slaves);
    whole.slave_nodes.set("edge", &slaves[..4]);
    whole.slave_nodes.set("earlier", &[0, 1, 127]);
    let values = whole.slave_nodes.history.values_mut(&NORMAL, 0);
    values.iter_mut().enumerate().for_each(|(at, value)| *value = at as f64);
    let surfaces = its_surfaces(&whole);
    let cut = partition(&whole, &surfaces, 3).unwrap();
    let common = common_nodes(&whole, &surfaces, &Document::from_str("{}", "deck.json").unwrap().root);
    let of_all = Shares::new(&whole, &cut, &common);
    let mut shares: Vec<ModelPart> = (0..3).map(|rank| of_all.of(&whole, rank)).collect();
    for share in &shares {
        share.check().unwrap();
        assert_eq!([share.slave_nodes.range("floor"), share.slave_nodes.range("edge")], [Some(0..16), Some(16..20)]);
        let ids = |part: &ModelPart, at: u32| part.nodes.ids[part.slave_nodes.mesh_node(at) as usize];
        assert!((0..20).all(|at| ids(share, at) == ids(&whole, at)));
    }
    assert!(shares.iter().any(|share| share.slave_nodes.len() < whole.slave_nodes.len()));
    // Values of copies count for nothing.
    for (rank, share) in shares.iter_mut().enumerate() {
        let owned = |at: u32| cut.nodes[share.share.as_ref().unwrap().places[at as usize] as usize] as usize == rank;
        let copies: Vec<bool> = share.slave_nodes.mesh_nodes().iter().map(|&node| !owned(node)).collect();
        let values = share.slave_nodes.history.values_mut(&NORMAL, 0).chunks_exact_mut(3);
        values.zip(copies).filter(|(_, is_copy)| *is_copy).for_each(|(value, _)| value.fill(f64::NAN));
    }
    let like = of_all.of(&whole, 1);
    let joined = ModelPart::merged(shares).unwrap();
    assert!(joined.slave_nodes == whole.slave_nodes);
    assert!(joined.cut_like(&like).unwrap().slave_nodes == like.slave_nodes);
}

/// A setting that a process leaves out has its default, the whole skin, and parts that it needs whole are kept.
#[test]
fn processes_say_what_every_rank_keeps() {
    let part = two_blocks(3);
    let text = r#"{"processes": {"list": [{"python_module": "partition_test_process",
        "Parameters": {"model_part_name": "Slave", "master_node_id": 1}}]}}"#;
    let deck = Document::from_str(text, "deck.json").unwrap().root;
    let common = common_nodes(&part, &[], &deck);
    assert_eq!(common.iter().filter(|common| **common).count(), 17);
    assert!(common[0]);
    let skin = [Surface { whole_skin: true, ..Surface::default() }];
    assert_eq!(common_nodes(&part, &skin, &deck).iter().filter(|common| **common).count(), 2 * (64 - 8));
}

/// Two ranks with the node pairs (7, 100, 100) and (3): everything above the mean of 105 goes over, node by node.
#[test]
fn pairs_of_a_full_rank_go_to_an_empty_one() {
    let part = two_blocks(2);
    let cut = partition(&part, &[], 2).unwrap();
    let home = cut.nodes.clone();
    let mut share = Shares::new(&part, &cut, &vec![true; part.nodes.len()]).of(&part, 0).share.unwrap();
    let of = |rank: u32| home.iter().enumerate().filter(move |(_, r)| **r == rank).map(|(node, _)| node as u32);
    let full: Vec<u32> = of(0).take(3).collect();
    let empty = of(1).next().unwrap();
    let pairs = |counts: [usize; 4]| {
        let nodes = [full[0], full[1], full[2], empty];
        nodes.into_iter().zip(counts).flat_map(|(node, count)| std::iter::repeat_n(node, count)).collect::<Vec<u32>>()
    };
    assert_eq!(share.balance_pairs(pairs([7, 100, 100, 3]).into_iter()), 107);
    assert_eq!(full.iter().map(|&node| share.pairs[node as usize]).collect::<Vec<_>>(), [1, 1, 0]);
    assert_eq!(share.pairs[empty as usize], 1);
    for balanced in [[7, 100, 0, 90], [10, 10, 10, 3]] {
        assert_eq!(share.balance_pairs(pairs(balanced).into_iter()), 0, "not worth it: {balanced:?}");
        assert_eq!(share.pairs, home, "pairs come home");
    }
}
