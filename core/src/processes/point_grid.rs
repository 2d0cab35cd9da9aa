//! Points in a grid of cells, to find those near a place.

use rustc_hash::FxHashMap;

use crate::vector3::{norm, sub};

/// Points in cells, to find those near a place.
pub(super) struct PointGrid<'a> {
    points: &'a [[f64; 3]],
    size: f64,
    of_cell: FxHashMap<[i64; 3], Vec<u32>>,
}

impl<'a> PointGrid<'a> {
    /// Points in cells of a size.
    pub fn new(points: &'a [[f64; 3]], size: f64) -> Self {
        let mut of_cell = FxHashMap::<_, Vec<u32>>::default();
        for (at, x) in (0..).zip(points) {
            of_cell.entry(x.map(|x| (x / size).floor() as i64)).or_default().push(at);
        }
        Self { points, size, of_cell }
    }

    /// The points within the least multiple of the size in which there are so many, ascending.
    pub fn near(&self, x: [f64; 3], fewest: usize) -> Vec<u32> {
        let here = x.map(|x| (x / self.size).floor() as i64);
        let distance = |at: u32| norm(sub(self.points[at as usize], x));
        for rings in 1.. {
            // Far away from everything it is quicker to look at all points than at ever more cells.
            if (2 * rings + 1_i64).pow(3) as usize > self.points.len().max(27) {
                let mut distances: Vec<f64> = (0..self.points.len() as u32).map(distance).collect();
                let (_, farthest, _) = distances.select_nth_unstable_by(fewest - 1, f64::total_cmp);
                let reach = (*farthest / self.size).ceil().max(rings as f64) * self.size;
                return (0..self.points.len() as u32).filter(|&at| distance(at) <= reach).collect();
            }
            let around = |c: usize| here[c] - rings..=here[c] + rings;
            let cells = around(0).flat_map(|i| around(1).flat_map(move |j| around(2).map(move |k| [i, j, k])));
            let near = cells.filter_map(|cell| self.of_cell.get(&cell)).flatten().copied();
            let mut found: Vec<u32> = near.filter(|&at| distance(at) <= rings as f64 * self.size).collect();
            if found.len() >= fewest {
                found.sort_unstable();
                return found;
            }
        }
        unreachable!("there are as many points as are asked for")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_neighbours_are_found_as_are_asked_for() {
        let points: Vec<[f64; 3]> = (0..50).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let cells = PointGrid::new(&points, 1.0);
        assert_eq!(cells.near([10.2, 0.0, 0.0], 1), [10, 11]);
        assert_eq!(cells.near([10.2, 0.0, 0.0], 3), [9, 10, 11, 12]);
        assert_eq!(cells.near([10.0, 5.5, 0.0], 2).len(), 5, "within six");
        assert_eq!(cells.near([1e4, 0.0, 0.0], 50).len(), 50);
    }
}
