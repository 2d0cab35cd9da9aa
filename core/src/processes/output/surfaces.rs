//! Surfaces of interfaces as pictures.

use super::format::SurfaceFrame;
use super::quantity::{Quantity, flag_column};
use crate::io::results::{Column, Dataset};
use crate::model::{InterfaceSurface, ModelPart, Rates, SubPart};

/// Surfaces of the interfaces of a part now, with the facets whose mesh nodes all belong to the selection; those without such facets are
/// left out.
pub(super) fn surfaces(part: &ModelPart, selection: &SubPart, deformed: bool) -> Vec<SurfaceFrame> {
    let shown = |(number, surface): (usize, &InterfaceSurface)| {
        let data = picture(part, selection, surface, deformed);
        (!data.cells.is_empty()).then(|| SurfaceFrame { number, name: surface.name.clone(), data })
    };
    part.interface_surfaces.iter().enumerate().filter_map(shown).collect()
}

fn picture(part: &ModelPart, selection: &SubPart, surface: &InterfaceSurface, deformed: bool) -> Dataset {
    let selected = |point: u32| selection.nodes.binary_search(&surface.nodes[point as usize]).is_ok();
    let facets = || surface.facets().filter(|(_, points)| points.iter().all(|&point| selected(point)));
    let mut used = vec![false; surface.nodes.len()];
    facets().flat_map(|(_, points)| points).for_each(|&point| used[point as usize] = true);
    let points: Vec<u32> = (0..used.len() as u32).filter(|&point| used[point as usize]).collect();
    let mut point_of = vec![0; used.len()];
    points.iter().enumerate().for_each(|(at, &point)| point_of[point as usize] = at as u32);

    let node = |&point: &u32| surface.nodes[point as usize] as usize;
    let positions = if deformed { &part.nodes.current } else { &part.nodes.initial };
    let mut data = Dataset {
        point_ids: points.iter().map(|point| part.nodes.ids[node(point)]).collect(),
        points: points.iter().map(|point| positions[node(point)]).collect(),
        ..Dataset::default()
    };
    for (at, (shape, points)) in facets().enumerate() {
        data.cells.push(at + 1, 0, shape, points.iter().map(|&point| point_of[point as usize]));
    }
    // By this column programs displace surfaces as they do the mesh.
    if let Some(moving) = Rates::moving(&part.nodes.history).and_then(|name| Quantity::new(name).ok()) {
        let nodes: Vec<u32> = points.iter().map(|point| node(point) as u32).collect();
        data.point_data.push(moving.gather(&part.nodes.history, &nodes));
    }
    data.point_data.extend(surface.values.iter().map(|(name, field)| {
        let row = |&point: &u32| &field.levels[0][point as usize * field.components..][..field.components];
        Column::real(name, field.components, points.iter().flat_map(row).copied().collect())
    }));
    data.point_data.extend(surface.flags.names().map(|name| flag_column(&surface.flags, name, &points)));
    let patches: Vec<usize> = points.iter().map(|&point| surface.patches[point as usize] as usize).collect();
    data.point_data.push(Column::ids("PATCH", &patches));
    data.point_data.push(Column::ids("KRATOS_NODE_ID", &data.point_ids));
    data
}
