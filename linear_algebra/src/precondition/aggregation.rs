//! Aggregates of node blocks and the tentative prolongation that reproduces the near-null space.

use std::cmp::Reverse;

use super::couplings::Couplings;
use super::lines::Lines;
use crate::parallel;

/// Aggregate of a block that has no strong neighbour.
pub(super) const NONE: u32 = u32::MAX;
/// Share of the geometric mean of two diagonal blocks above which their coupling is strong.
const STRONG: f64 = 0.02;
/// The same for the inverse squares of distances, beside the sums of those of all couplings: cubes have all of their nodes near each other,
/// cells three times as long as wide only those across.
const NEAR: f64 = 0.02;
/// Share of a vector that must be left after orthogonalisation for it to be kept.
const INDEPENDENT: f64 = 1e-6;

/// The tentative coarse space: each block is interpolated from the one aggregate it belongs to.
pub(super) struct Tentative {
    /// Aggregate of each block, or [`NONE`].
    pub(super) aggregate: Vec<u32>,
    /// Number of aggregates.
    pub(super) aggregates: usize,
    /// Body of each aggregate.
    pub(super) bodies: Vec<u32>,
    /// Position of each aggregate, empty where those of blocks are not known.
    pub(super) positions: Vec<[f64; 3]>,
    /// Rows of the prolongation, `height × modes` entries a block by columns.
    pub(super) values: Vec<f32>,
    /// The modes on the aggregates, as `modes` vectors of `aggregates × modes` entries.
    pub(super) modes: Vec<Vec<f64>>,
}

/// Rows of one task.
const ROWS: usize = 256;

/// The strong couplings between units, lines of blocks or single blocks, row after row.
struct Strong {
    /// Ends of the lists of the rows of each task, and the lists.
    parts: Vec<(Vec<u32>, Vec<u32>)>,
}

/// Couplings of a unit with another one.
struct UnitCoupling {
    unit: u32,
    /// Sum of the [nearness](Couplings::nearness) of their blocks.
    nearness: f64,
    has_strong: bool,
}

impl Strong {
    /// Between units of these members; `unit` says which of them a block is or is in.
    fn new(couplings: &Couplings<'_>, members: &[Vec<u32>], unit: &[u32]) -> Self {
        // Nodes that a cell couples are near or far: of flat and long cells all couplings are large, those along their
        // long edges as parts of a mass matrix, which stiffens no mode that changes along these.
        let of_unit = |own: usize, list: &mut Vec<UnitCoupling>| {
            list.clear();
            for &i in &members[own] {
                list.extend(couplings.of(i as usize).filter(|(j, ..)| unit[*j as usize] as usize != own).map(
                    |(j, square, both)| UnitCoupling {
                        unit: unit[j as usize],
                        nearness: couplings.nearness(i as usize, j as usize),
                        has_strong: square > (STRONG * STRONG) * both,
                    },
                ));
            }
            if members[own].len() > 1 {
                list.sort_by_key(|coupling| coupling.unit);
                list.dedup_by(|next, kept| {
                    let is_same = next.unit == kept.unit;
                    if is_same {
                        kept.nearness += next.nearness;
                        kept.has_strong |= next.has_strong;
                    }
                    is_same
                });
            }
        };
        let units = members.len();
        let sum = |own: usize, list: &mut Vec<UnitCoupling>| {
            of_unit(own, list);
            list.iter().map(|coupling| coupling.nearness).filter(|nearness| nearness.is_finite()).sum::<f64>()
        };
        let tasks = |task: usize| task * ROWS..((task + 1) * ROWS).min(units);
        let sums_of = |task: usize| {
            let mut list = Vec::new();
            tasks(task).map(|own| sum(own, &mut list)).collect::<Vec<f64>>()
        };
        let sums = match couplings.positions {
            [] => vec![0.0; units],
            _ => parallel::map(units.div_ceil(ROWS), 1, sums_of).concat(),
        };
        let of_task = |task: usize| {
            let (mut ends, mut lists, mut list) = (Vec::with_capacity(ROWS), Vec::new(), Vec::new());
            for own in tasks(task) {
                of_unit(own, &mut list);
                let is_near = |coupling: &UnitCoupling| {
                    coupling.nearness > NEAR * (sums[own] * sums[coupling.unit as usize]).sqrt()
                };
                let strong = list.iter().filter(|coupling| coupling.has_strong && is_near(coupling));
                lists.extend(strong.map(|coupling| coupling.unit));
                ends.push(lists.len() as u32);
            }
            (ends, lists)
        };
        Self { parts: parallel::map(units.div_ceil(ROWS), 1, of_task) }
    }

    /// Strong neighbours of a block.
    fn of(&self, g: usize) -> &[u32] {
        let (ends, lists) = &self.parts[g / ROWS];
        let at = g % ROWS;
        &lists[at.checked_sub(1).map_or(0, |before| ends[before] as usize)..ends[at] as usize]
    }
}

/// Aggregate of each block, and their number; blocks without strong neighbours have none. A hub is an aggregate alone: joined with all it
/// is coupled to, it would make a coarse node of a whole surface. Lines stay whole.
fn aggregate(couplings: &Couplings<'_>, lines: &Lines) -> (Vec<u32>, usize) {
    let is_hub = &couplings.is_hub;
    let (unit, units) = lines.units(is_hub.len());
    let (mut members, mut hubs) = (vec![Vec::new(); units], vec![false; units]);
    for (block, (&unit, &is_hub)) in unit.iter().zip(is_hub).enumerate() {
        members[unit as usize].push(block as u32);
        hubs[unit as usize] |= is_hub;
    }
    let (of, count) = aggregate_units(&Strong::new(couplings, &members, &unit), &hubs);
    (unit.iter().map(|&unit| of[unit as usize]).collect(), count)
}

/// The same for units of blocks with these couplings.
fn aggregate_units(strong: &Strong, is_hub: &[bool]) -> (Vec<u32>, usize) {
    let units = is_hub.len();
    let mut of = vec![NONE; units];
    let mut count = 0;
    for g in (0..units).filter(|&g| is_hub[g]) {
        of[g] = count;
        count += 1;
    }
    for g in 0..units {
        let near = strong.of(g);
        if of[g] == NONE && !near.is_empty() && near.iter().all(|&h| of[h as usize] == NONE) {
            of[g] = count;
            near.iter().for_each(|&h| of[h as usize] = count);
            count += 1;
        }
    }
    join(&mut of, count as usize, strong);
    for g in 0..units {
        if of[g] == NONE && !strong.of(g).is_empty() {
            of[g] = count;
            for &h in strong.of(g) {
                if of[h as usize] == NONE {
                    of[h as usize] = count;
                }
            }
            count += 1;
        }
    }
    (of, count as usize)
}

/// Lets blocks that have no aggregate join the one with most of their strong neighbours, of those the smallest.
fn join(of: &mut [u32], aggregates: usize, strong: &Strong) {
    let first = of.to_vec();
    let mut sizes = vec![0_usize; aggregates];
    first.iter().filter(|&&a| a != NONE).for_each(|&a| sizes[a as usize] += 1);
    let mut near = Vec::new();
    for g in (0..first.len()).filter(|&g| first[g] == NONE) {
        near.clear();
        near.extend(strong.of(g).iter().map(|&h| first[h as usize]).filter(|&a| a != NONE));
        near.sort_unstable();
        let rank = |alike: &[u32]| (alike.len(), Reverse(sizes[alike[0] as usize]), Reverse(alike[0]));
        if let Some((_, _, Reverse(a))) = near.chunk_by(|a, b| a == b).map(rank).max() {
            of[g] = a;
            sizes[a as usize] += 1;
        }
    }
}

/// The tentative coarse space of the own rows of a matrix with these couplings, lines and near-null vectors, and a body for each block.
pub(super) fn coarsen(couplings: &Couplings<'_>, lines: &Lines, near_null_space: &[Vec<f64>]) -> Tentative {
    let (matrix, bodies) = (couplings.matrix, couplings.bodies);
    let (aggregate, aggregates) = aggregate(couplings, lines);
    let (height, modes) = (matrix.height, near_null_space.len());
    let mut members = vec![Vec::new(); aggregates];
    // Place of each block among the members of its aggregate.
    let mut place = vec![0_u32; matrix.rows];
    for (i, &a) in aggregate.iter().enumerate().filter(|(_, a)| **a != NONE) {
        place[i] = members[a as usize].len() as u32;
        members[a as usize].push(i);
    }
    let orthonormal: Vec<(Vec<f64>, Vec<f64>)> =
        parallel::map(members.len(), 16, |at| orthonormalise(&members[at], height, near_null_space));
    let mut values = vec![0.0; matrix.rows * height * modes];
    parallel::groups_mut(&mut values, height * modes, ROWS, |i, block| {
        let (a, place) = (aggregate[i], place[i]);
        if a == NONE {
            return;
        }
        let length = members[a as usize].len() * height;
        for (m, column) in block.chunks_exact_mut(height).enumerate() {
            let known = &orthonormal[a as usize].0[m * length + place as usize * height..][..height];
            column.iter_mut().zip(known).for_each(|(to, from)| *to = *from as f32);
        }
    });
    let mut coarse = vec![vec![0.0; aggregates * modes]; modes];
    for (a, (_, triangle)) in orthonormal.iter().enumerate() {
        for (m, vector) in coarse.iter_mut().enumerate() {
            vector[a * modes..(a + 1) * modes].copy_from_slice(&triangle[m * modes..(m + 1) * modes]);
        }
    }
    let bodies = members.iter().map(|list| bodies[list[0]]).collect();
    let positions = match couplings.positions {
        [] => Vec::new(),
        positions => members.iter().map(|list| middle(list, positions)).collect(),
    };
    Tentative { aggregate, aggregates, bodies, positions, values, modes: coarse }
}

/// The mean of the positions of these blocks, of each coordinate where it is known.
fn middle(list: &[usize], positions: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let known = list.iter().map(|&i| positions[i][axis]).filter(|coordinate| !coordinate.is_nan());
        let (sum, count) = known.fold((0.0, 0.0), |(sum, count), coordinate| (sum + coordinate, count + 1.0));
        sum / count
    })
}

/// Orthonormal vectors on the blocks of `list` that span the near-null space there, one after the other, and each of its
/// vectors in their terms; a vector that depends on those before it is zero.
fn orthonormalise(list: &[usize], height: usize, near_null_space: &[Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let (length, modes) = (list.len() * height, near_null_space.len());
    let mut basis = vec![0.0; length * modes];
    let mut triangle = vec![0.0; modes * modes];
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for (m, vector) in near_null_space.iter().enumerate() {
        let (done, rest) = basis.split_at_mut(m * length);
        let local = &mut rest[..length];
        for (at, &i) in list.iter().enumerate() {
            local[at * height..(at + 1) * height].copy_from_slice(&vector[i * height..(i + 1) * height]);
        }
        let before = norm(local);
        for _ in 0..2 {
            for (q, known) in done.chunks_exact(length).enumerate() {
                let part: f64 = known.iter().zip(local.iter()).map(|(q, v)| q * v).sum();
                triangle[m * modes + q] += part;
                local.iter_mut().zip(known).for_each(|(v, q)| *v -= part * q);
            }
        }
        let after = norm(local);
        if after > INDEPENDENT * before {
            local.iter_mut().for_each(|v| *v /= after);
            triangle[m * modes + m] = after;
        } else {
            local.fill(0.0);
        }
    }
    (basis, triangle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precondition::block_matrix::BlockMatrix;
    use crate::precondition::couplings::HUB;

    /// A chain whose points are all coupled to one more, as the nodes of a face are to the reference node of a coupling.
    #[test]
    fn a_hub_is_an_aggregate_alone() {
        let points = 3 * HUB;
        let chain = BlockMatrix::from_rows([points + 1; 2], [1, 1], |i, row| {
            if i == points {
                (0..points as u32).for_each(|j| row.block(j)[0] = -1.0);
                row.block(points as u32)[0] = points as f32;
            } else {
                [i.checked_sub(1), Some(i + 1).filter(|&j| j < points)]
                    .into_iter()
                    .flatten()
                    .for_each(|j| row.block(j as u32)[0] = -1.0);
                row.block(i as u32)[0] = 3.0;
                row.block(points as u32)[0] = -1.0;
            }
        });
        let (of, count) = aggregate(&Couplings::new(&chain, &vec![0; points + 1], &[]), &Lines::default());
        assert_eq!(of.iter().filter(|&&a| a == of[points]).count(), 1);
        assert_eq!(count, 1 + points / 3);
        assert!(of.iter().all(|&a| a != NONE));
    }

    /// Rows that are all long, as those of coarse matrices, have no hubs: they would not become fewer.
    #[test]
    fn rows_that_are_all_long_are_no_hubs() {
        let points = 2 * HUB;
        let full = BlockMatrix::from_rows([points; 2], [1, 1], |i, row| {
            (0..points).for_each(|j| row.block(j as u32)[0] = if i == j { points as f32 } else { -1.0e3 });
        });
        assert_eq!(aggregate(&Couplings::new(&full, &vec![0; points], &[]), &Lines::default()).1, 1);
    }

    /// ANALYTIC: nodes of a grid with equal couplings in the cells beside each, as flat and long cells have them, by the lengths of their
    /// edges. Aggregates of cubes are cubes of 27; those of long cells join nodes across alone, those of flat ones nodes along the short edge.
    #[test]
    fn aggregates_go_along_short_edges() {
        let count = 9;
        let at = |i: usize| [i % count, i / count % count, i / (count * count)];
        let grid = BlockMatrix::from_rows([count.pow(3); 2], [1, 1], |i, row| {
            for j in (0..count.pow(3)).filter(|&j| at(i).iter().zip(at(j)).all(|(a, b)| a.abs_diff(b) < 2)) {
                row.block(j as u32)[0] = if i == j { 26.0 } else { -1.0 };
            }
        });
        let sizes = |edges: [f64; 3]| {
            let positions: Vec<[f64; 3]> =
                (0..count.pow(3)).map(|i| std::array::from_fn(|axis| at(i)[axis] as f64 * edges[axis])).collect();
            let bodies = vec![0; count.pow(3)];
            let (of, aggregates) = aggregate(&Couplings::new(&grid, &bodies, &positions), &Lines::default());
            (0..aggregates as u32)
                .map(|a| {
                    let members: Vec<[usize; 3]> = (0..of.len()).filter(|&i| of[i] == a).map(at).collect();
                    [0, 1, 2].map(|axis| {
                        let along = || members.iter().map(|place| place[axis]);
                        1 + along().max().expect("a member") - along().min().expect("a member")
                    })
                })
                .collect::<Vec<_>>()
        };
        assert!(sizes([1.0, 1.0, 1.0]).iter().all(|size| size.iter().all(|&nodes| nodes > 1)));
        assert!(sizes([1.0, 1.0, 10.0]).iter().all(|size| size[2] == 1 && size[0] > 1 && size[1] > 1));
        assert!(sizes([10.0, 10.0, 1.0]).iter().all(|size| size[..2] == [1, 1] && size[2] > 1));
    }
}
