//! Matching of the points of two pictures.

use std::collections::HashMap;

use zelus_core::io::results::{Column, Dataset};

/// Points nearer than this share of the picture's size are at one place.
const SAME_PLACE: f64 = 1e-6;

/// How points were told to be the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    /// They come in the same order.
    Order,
    /// They are at the same places.
    Place,
    /// They have the same ids.
    Id,
}

/// For each point of `a` its place in `b`; nothing where the pictures do not have the same points.
pub(super) fn match_points(a: &Dataset, b: &Dataset) -> Option<(By, Vec<usize>)> {
    if a.points.len() != b.points.len() {
        return None;
    }
    let size = size_of(a);
    let near = |x: &[f64; 3], y: &[f64; 3]| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= SAME_PLACE * size);
    let same_ids = a.point_ids.is_empty() || b.point_ids.is_empty() || a.point_ids == b.point_ids;
    if same_ids && a.points.iter().zip(&b.points).all(|(x, y)| near(x, y) || (x[0].is_nan() && y[0].is_nan())) {
        return Some((By::Order, (0..a.points.len()).collect()));
    }
    by_place(a, b, size).map(|found| (By::Place, found)).or_else(|| by_id(a, b).map(|found| (By::Id, found)))
}

/// The longest edge of the box around the points.
fn size_of(data: &Dataset) -> f64 {
    let extent = |axis: usize| {
        let of = data.points.iter().map(|point| point[axis]);
        let (least, most) = of.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
        most - least
    };
    (0..3).map(extent).filter(|extent| extent.is_finite()).fold(0.0, f64::max)
}

fn by_id(a: &Dataset, b: &Dataset) -> Option<Vec<usize>> {
    let of_id: HashMap<usize, usize> = b.point_ids.iter().enumerate().map(|(at, &id)| (id, at)).collect();
    let found: Option<Vec<usize>> = a.point_ids.iter().map(|id| of_id.get(id).copied()).collect();
    found.filter(|found| found.len() == a.points.len() && of_id.len() == b.points.len())
}

/// Points at one place, as the two sides of a closed interface, are told apart by their values.
fn by_place(a: &Dataset, b: &Dataset, size: f64) -> Option<Vec<usize>> {
    let edge = 4.0 * SAME_PLACE * size;
    let cell = |x: &[f64; 3]| x.map(|x| (x / edge).floor() as i64);
    if !(edge > 0.0 && a.points.iter().chain(&b.points).flatten().all(|x| x.is_finite())) {
        return None;
    }
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    b.points.iter().enumerate().for_each(|(at, point)| grid.entry(cell(point)).or_default().push(at));
    let distance = |x: &[f64; 3], y: &[f64; 3]| x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let mut taken = vec![false; b.points.len()];
    let mut found = Vec::with_capacity(a.points.len());
    for (at, point) in a.points.iter().enumerate() {
        let [i, j, k] = cell(point);
        let around = (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [i + x, j + y, k + z])));
        let here = around.filter_map(|cell| grid.get(&cell)).flatten().copied();
        let here = here.filter(|&other| !taken[other] && distance(point, &b.points[other]) <= SAME_PLACE * size);
        let other = here.min_by(|&x, &y| apart(a, at, b, x).total_cmp(&apart(a, at, b, y)))?;
        taken[other] = true;
        found.push(other);
    }
    Some(found)
}

/// How far the values of two points are apart, each field by its size there.
fn apart(a: &Dataset, at: usize, b: &Dataset, other: usize) -> f64 {
    let of = |own: &Column| {
        let same = b.point_data.iter().find(|column| column.name == own.name && column.components == own.components)?;
        let values = |column: &Column, at: usize| -> Vec<f64> {
            (0..own.components).map(|component| column.values.get(at * own.components + component)).collect()
        };
        let (x, y) = (values(own, at), values(same, other));
        let size = x.iter().chain(&y).fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        Some(x.iter().zip(&y).map(|(x, y)| (x - y).abs() / size).fold(0.0, f64::max))
    };
    a.point_data.iter().filter(|column| !column.name.starts_with("KRATOS_")).filter_map(of).sum()
}
