//! A dataset in pieces on several ranks, put together on rank 0.

use std::collections::BTreeMap;

use super::dataset::{Column, Dataset, Values};
use crate::communication::Ranks;
use crate::geometry::Shape;

impl Dataset {
    /// The whole on rank 0, from the piece of each rank: points and cells by id, points of several pieces once. Other ranks
    /// get an empty one; collective.
    pub fn gathered(&self, ranks: &Ranks) -> Self {
        let all = ranks.to_root(pack(self));
        if ranks.is_root() { join(self, &all) } else { Self::default() }
    }
}

fn columns(piece: &Dataset) -> impl Iterator<Item = &Column> {
    piece.point_data.iter().chain(&piece.cell_data)
}

/// A piece as numbers; ids below 2^53 are exact.
fn pack(piece: &Dataset) -> Vec<f64> {
    let mut out = vec![piece.points.len() as f64, piece.cells.len() as f64];
    for (id, position) in piece.point_ids.iter().zip(&piece.points) {
        out.push(*id as f64);
        out.extend(position);
    }
    for (at, (shape, points)) in piece.cells.iter().enumerate() {
        out.extend([piece.cells.ids[at] as f64, piece.cells.properties[at] as f64, shape as usize as f64]);
        out.extend(points.iter().map(|&point| f64::from(point)));
    }
    for column in columns(piece) {
        out.push(column.components as f64);
        match &column.values {
            Values::Real(values) => out.extend(values),
            Values::Whole(values) => out.extend(values.iter().map(|&value| f64::from(value))),
        }
    }
    out
}

/// Reads numbers from the front of a message.
struct MessageReader<'a>(&'a [f64]);

impl<'a> MessageReader<'a> {
    fn take(&mut self, count: usize) -> &'a [f64] {
        let (own, rest) = self.0.split_at(count);
        self.0 = rest;
        own
    }

    fn count(&mut self) -> usize {
        self.take(1)[0] as usize
    }
}

/// The whole of the messages of [`pack`]; `own` is a piece with the names of the columns.
fn join(own: &Dataset, messages: &[Vec<f64>]) -> Dataset {
    let mut readers: Vec<MessageReader<'_>> = messages.iter().map(|message| MessageReader(message)).collect();
    let mut points: BTreeMap<usize, (usize, usize, [f64; 3])> = BTreeMap::new();
    let mut cells: BTreeMap<usize, (usize, usize, usize, Shape, Vec<usize>)> = BTreeMap::new();
    let mut sizes = Vec::new();
    for (rank, reader) in readers.iter_mut().enumerate() {
        let (point_count, cell_count) = (reader.count(), reader.count());
        let rows: Vec<&[f64]> = reader.take(4 * point_count).chunks_exact(4).collect();
        for (row, point) in rows.iter().enumerate() {
            points.entry(point[0] as usize).or_insert((rank, row, [point[1], point[2], point[3]]));
        }
        for row in 0..cell_count {
            let [id, properties, shape] = [reader.count(), reader.count(), reader.count()];
            let shape = Shape::ALL[shape];
            let nodes = reader.take(shape.nodes()).iter().map(|&at| rows[at as usize][0] as usize).collect();
            cells.insert(id, (rank, row, properties, shape, nodes));
        }
        sizes.push([point_count, cell_count]);
    }
    let place: BTreeMap<usize, u32> = points.keys().enumerate().map(|(at, &id)| (id, at as u32)).collect();
    let mut out = Dataset {
        point_ids: points.keys().copied().collect(),
        points: points.values().map(|(.., position)| *position).collect(),
        ..Dataset::default()
    };
    for (&id, (_, _, properties, shape, nodes)) in &cells {
        out.cells.push(id, *properties, *shape, nodes.iter().map(|node| place[node]));
    }
    let of_points: Vec<(usize, usize)> = points.values().map(|&(rank, row, _)| (rank, row)).collect();
    let of_cells: Vec<(usize, usize)> = cells.values().map(|&(rank, row, ..)| (rank, row)).collect();
    for (kind, (columns, rows)) in [(&own.point_data, &of_points), (&own.cell_data, &of_cells)].into_iter().enumerate()
    {
        for column in columns {
            let pieces: Vec<(usize, &[f64])> = readers
                .iter_mut()
                .zip(&sizes)
                .map(|(reader, sizes)| {
                    let components = reader.count();
                    (components, reader.take(components * sizes[kind]))
                })
                .collect();
            let components = pieces.iter().map(|piece| piece.0).max().unwrap_or(1);
            let row = |&(rank, row): &(usize, usize)| {
                let (size, values) = pieces[rank];
                (0..components).map(move |c| if c < size { values[row * size + c] } else { 0.0 })
            };
            let values = rows.iter().flat_map(row);
            let values = match column.values {
                Values::Real(_) => Values::Real(values.collect()),
                Values::Whole(_) => Values::Whole(values.map(|value| value as i32).collect()),
            };
            let column = Column { name: column.name.clone(), components, values };
            if kind == 0 { out.point_data.push(column) } else { out.cell_data.push(column) }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line between two points with a value each, and a number of its own.
    fn piece(id: usize, points: [usize; 2]) -> Dataset {
        let mut piece = Dataset {
            point_ids: points.to_vec(),
            points: points.iter().map(|&id| [id as f64, 0.0, 0.0]).collect(),
            point_data: vec![Column::real("X", 1, points.iter().map(|&id| id as f64).collect())],
            cell_data: vec![Column::ids("ID", &[id])],
            ..Dataset::default()
        };
        piece.cells.push(id, 1, Shape::Line2, [0, 1]);
        piece
    }

    #[test]
    fn pieces_are_joined_by_id() {
        let pieces = [piece(8, [5, 3]), piece(2, [3, 4])];
        let whole = join(&pieces[0], &pieces.each_ref().map(pack));
        assert_eq!((&whole.point_ids[..], &whole.cells.ids[..]), (&[3, 4, 5][..], &[2, 8][..]));
        assert_eq!(whole.cells.points, [0, 1, 2, 0]);
        assert_eq!(whole.point_data, [Column::real("X", 1, vec![3.0, 4.0, 5.0])]);
        assert_eq!(whole.cell_data, [Column::ids("ID", &[2, 8])]);
    }
}
