//! Conditions that carry forces at nodes, and the file of forces that differ from node to node.

use std::collections::BTreeMap;

use zelus_core::io::mdpa::{MdpaDocument, MdpaEntities, SubModelPart};
use zelus_meshes::conditions::LoadKind;
use zelus_meshes::history::History;
use zelus_meshes::mesh::{Group, Mesh};

/// Groups of equal forces beyond which a file gives the force of each node.
const GROUPS: usize = 24;

/// Forces of many nodes.
pub(super) struct ForceFile {
    /// The part of the nodes.
    pub group: String,
    /// Name of the file.
    pub name: String,
    /// Its text, JSON.
    pub text: String,
}

/// Joins forces that differ from node to node in one group, whose forces a file gives; `None` where processes can state them.
pub(super) fn join(mesh: &mut Mesh) -> Option<ForceFile> {
    let mut forces: BTreeMap<u32, [History; 3]> = BTreeMap::new();
    let of_mesh = |group: &str| mesh.group(group).map(|group| group.nodes.clone());
    let mut groups = 0;
    for load in &mesh.loads {
        let (LoadKind::Force(values), Some(nodes)) = (&load.kind, of_mesh(&load.group)) else { continue };
        groups += 1;
        for node in nodes {
            forces.insert(node, values.clone());
        }
    }
    // the file finds nodes by their places: two at one place would take the same force
    let mut places: Vec<[u64; 3]> = forces.keys().map(|&node| mesh.points[node as usize].map(f64::to_bits)).collect();
    places.sort_unstable();
    if groups <= GROUPS || places.windows(2).any(|two| two[0] == two[1]) {
        return None;
    }
    let mut times: Vec<f64> = forces.values().flatten().flat_map(History::points).map(|point| point[0]).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let sites = forces.iter().enumerate().map(|(at, (&node, values))| {
        let series = |value: &History| times.iter().map(|&time| value.at(time)).collect::<Vec<f64>>();
        let [x, y, z] = mesh.points[node as usize];
        let [fx, fy, fz] = values.each_ref().map(series);
        format!(
            "  \"{}\": {{\"COORDINATES\": [{x:?}, {y:?}, {z:?}], \"VALUES\": {{\"POINT_LOAD_X\": {fx:?}, \"POINT_LOAD_Y\": {fy:?}, \"POINT_LOAD_Z\": {fz:?}}}}}",
            at + 1
        )
    });
    let text = format!("{{\n  \"TIME\": {times:?},\n{}\n}}\n", sites.collect::<Vec<_>>().join(",\n"));
    let nodes: Vec<u32> = forces.keys().copied().collect();
    let old: Vec<String> =
        mesh.loads.iter().filter(|load| is_force(&load.kind)).map(|load| load.group.clone()).collect();
    mesh.loads.retain(|load| !is_force(&load.kind) || mesh.groups.iter().all(|group| group.name != load.group));
    mesh.groups.retain(|group| !(old.contains(&group.name) && group.name.starts_with("Node_")));
    let group = "Forces_of_nodes".to_owned();
    mesh.groups.push(Group { name: group.clone(), nodes, cells: Vec::new() });
    Some(ForceFile { group, name: "forces.json".to_owned(), text })
}

fn is_force(kind: &LoadKind) -> bool {
    matches!(kind, LoadKind::Force(_))
}

/// Gives each node with a force of its own a condition that carries it.
pub(super) fn add(mesh: &Mesh, document: &mut MdpaDocument, space: usize, forces: Option<&ForceFile>) {
    let mut next = document.conditions.iter().flat_map(|block| &block.ids).max().map_or(1, |id| id + 1);
    let name = format!("PointLoadCondition{space}D1N");
    let properties = document.properties.first().map_or(0, |first| first.id);
    let mut block = MdpaEntities { name, nodes_per_entity: 1, ..MdpaEntities::default() };
    let mut carry = |part: &mut SubModelPart| {
        for &node in &part.nodes {
            block.ids.push(next);
            block.properties.push(properties);
            block.nodes.push(node);
            part.conditions.push(next);
            next += 1;
        }
    };
    let named = mesh.loads.iter().filter(|load| is_force(&load.kind)).map(|load| load.group.as_str());
    for name in named.chain(forces.map(|file| file.group.as_str())) {
        document.sub_model_parts.iter_mut().filter(|part| part.name == name).for_each(&mut carry);
    }
    if !block.ids.is_empty() {
        document.conditions.push(block);
    }
}
