//! Lines of blocks whose couplings dominate all others, e.g. nodes through a thin wall: smoothers solve for the blocks of a line at once.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::block_matrix::BlockMatrix;
use super::couplings::Couplings;
use crate::dense_lu;
use crate::parallel;

/// Factor by which the couplings along a line exceed others, at each of its blocks.
const ALONG: f64 = 1.35;
/// The same for lines of two blocks, which the surfaces of bodies would have otherwise.
const BETWEEN_TWO: f64 = 1.5;
/// Blocks of a line at most; longer ones are cut.
const LONGEST: usize = 8;
/// Blocks that a thread takes at a time, at least.
const BLOCKS: usize = 256;
/// Lines that a thread takes at a time, at least.
const LINES: usize = 32;
/// Share of the largest entry of a diagonal block below which pivots are lifted.
const LEAST_PIVOT: f64 = 1e-6;

/// Lines of two blocks or more. No two have a block in common.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Lines {
    blocks: Vec<u32>,
    /// Where each line begins among the blocks, and the end.
    starts: Vec<u32>,
}

/// The neighbours of a block along a line, and by how much their couplings exceed the next.
#[derive(Clone, Copy)]
struct Nomination {
    neighbours: [Option<u32>; 2],
    factor: f64,
}

impl Nomination {
    /// Of the couplings of a block, given with their strengths.
    fn of(couplings: impl Iterator<Item = (u32, f64)>) -> Self {
        // The three strongest; of equal ones those of the first blocks.
        let mut strongest = [(0, 0.0_f64); 3];
        for (block, strength) in couplings {
            if let Some(at) = strongest.iter().position(|known| strength > known.1) {
                strongest[at..].rotate_right(1);
                strongest[at] = (block, strength);
            }
        }
        let [(first, a), (second, b), (_, c)] = strongest;
        let is_between_two = c > 0.0 && b >= ALONG * c && b * b >= a * c;
        let (neighbours, factor) = match () {
            () if is_between_two => ([Some(first), Some(second)], b / c),
            () if b > 0.0 && a >= ALONG * b => ([Some(first), None], a / b),
            () => ([None; 2], 0.0),
        };
        Self { neighbours, factor }
    }

    fn has(&self, block: u32) -> bool {
        self.neighbours.contains(&Some(block))
    }
}

impl Lines {
    /// The lines among own blocks.
    pub(super) fn new(couplings: &Couplings<'_>) -> Self {
        let nominations: Vec<Nomination> = parallel::map(couplings.matrix.rows, BLOCKS, |i| {
            let strength =
                |(j, square, both): (u32, f64, f64)| (j, if both > 0.0 { (square / both).sqrt() } else { 0.0 });
            Nomination::of(couplings.of(i).map(strength))
        });
        Self::of(&nominations)
    }

    /// The lines between blocks that nominate each other.
    fn of(nominations: &[Nomination]) -> Self {
        let mutual = |i: u32| {
            let both = nominations[i as usize].neighbours.into_iter().flatten();
            both.filter(move |&j| nominations[j as usize].has(i))
        };
        let mut lines = Self { blocks: Vec::new(), starts: vec![0] };
        let mut is_taken = vec![false; nominations.len()];
        // Lines begin at their ends; what is left after these are rings.
        for of_ring in [false, true] {
            for first in 0..nominations.len() as u32 {
                if is_taken[first as usize] || mutual(first).count() != 1 + usize::from(of_ring) {
                    continue;
                }
                let begin = lines.blocks.len();
                let mut next = Some(first);
                while let Some(block) = next {
                    is_taken[block as usize] = true;
                    lines.blocks.push(block);
                    next = mutual(block).find(|&j| !is_taken[j as usize]);
                }
                lines.end(begin, |block| nominations[block as usize].factor);
            }
        }
        lines
    }

    /// Ends the line of the last blocks, or cuts it to pieces of about equal length.
    fn end(&mut self, begin: usize, factor: impl Fn(u32) -> f64) {
        let blocks = self.blocks.len() - begin;
        if blocks < 2 || (blocks == 2 && self.blocks[begin..].iter().any(|&block| factor(block) < BETWEEN_TWO)) {
            self.blocks.truncate(begin);
            return;
        }
        let pieces = blocks.div_ceil(LONGEST);
        self.starts.extend((1..=pieces).map(|piece| (begin + blocks * piece / pieces) as u32));
    }

    /// Number of lines.
    pub(super) fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn range(&self, line: usize) -> Range<usize> {
        self.starts[line] as usize..self.starts[line + 1] as usize
    }

    /// Blocks of a line.
    pub(super) fn blocks(&self, line: usize) -> &[u32] {
        &self.blocks[self.range(line)]
    }

    /// The line of each of so many blocks and its place there.
    pub(super) fn places(&self, blocks: usize) -> Vec<Option<(u32, u32)>> {
        let mut places = vec![None; blocks];
        for line in 0..self.count() {
            for (at, &block) in self.blocks(line).iter().enumerate() {
                places[block as usize] = Some((line as u32, at as u32));
            }
        }
        places
    }

    /// A number for each line, and for each of so many blocks that is in none, in the order of their first blocks; and how many there are.
    pub(super) fn units(&self, blocks: usize) -> (Vec<u32>, usize) {
        let mut of_line = vec![u32::MAX; self.count()];
        let mut count = 0;
        let mut number = |known: Option<u32>| {
            known.unwrap_or_else(|| {
                count += 1;
                count - 1
            })
        };
        let units = self.places(blocks).into_iter().map(|place| match place {
            None => number(None),
            Some((line, _)) => {
                let of = &mut of_line[line as usize];
                *of = number((*of != u32::MAX).then_some(*of));
                *of
            }
        });
        (units.collect(), count as usize)
    }

    /// Whether those that were read can be lines of a matrix.
    pub(super) fn is_sound(&self, rows: usize) -> bool {
        let mut is_met = vec![false; rows];
        let is_new = |&block: &u32| is_met.get_mut(block as usize).is_some_and(|met| !std::mem::replace(met, true));
        let has_ends = match self.starts.last() {
            None => self.blocks.is_empty(),
            Some(&end) => self.starts[0] == 0 && end as usize == self.blocks.len(),
        };
        let lengths = self
            .starts
            .windows(2)
            .all(|ends| ends[1].checked_sub(ends[0]).is_some_and(|blocks| (2..=LONGEST).contains(&(blocks as usize))));
        has_ends && lengths && self.blocks.iter().all(is_new)
    }
}

/// The diagonal blocks of a matrix, those of its lines with the couplings between them, inverted.
#[derive(Default)]
pub(super) struct Inverses {
    /// Of each block by rows; one for those of lines.
    of_blocks: Vec<f32>,
    lines: Lines,
    /// Of each line by rows.
    of_lines: Vec<Vec<f32>>,
    height: usize,
}

impl Inverses {
    /// Tiny pivots are lifted, so that they always exist.
    pub(super) fn new(matrix: &BlockMatrix, lines: Lines) -> Self {
        let h = matrix.height;
        let mut of_blocks = vec![0.0; matrix.rows * h * h];
        parallel::parts_mut(&mut of_blocks, BLOCKS * h * h, &|first, out| {
            let mut memory = (Vec::new(), Vec::new());
            let each = out.chunks_exact_mut(h * h).zip(first as u32 / (h * h) as u32..);
            each.for_each(|(out, i)| invert(matrix, &[i], &mut memory, out));
        });
        let of_line = |line: usize| {
            let blocks = lines.blocks(line);
            let mut out = vec![0.0; (blocks.len() * h).pow(2)];
            invert(matrix, blocks, &mut (Vec::new(), Vec::new()), &mut out);
            out
        };
        let of_lines = parallel::map(lines.count(), LINES, of_line);
        for &block in &lines.blocks {
            let own = &mut of_blocks[block as usize * h * h..(block as usize + 1) * h * h];
            own.iter_mut().enumerate().for_each(|(at, v)| *v = f32::from(u8::from(at % (h + 1) == 0)));
        }
        Self { of_blocks, lines, of_lines, height: h }
    }

    /// The lines.
    pub(super) fn lines(&self) -> &Lines {
        &self.lines
    }

    /// Of each block by rows; one for those of lines.
    pub(super) fn of_blocks(&self) -> &[f32] {
        &self.of_blocks
    }

    /// Numbers of work space that [`Inverses::step`] needs.
    pub(super) fn work(&self) -> usize {
        self.lines.count() * LONGEST * self.height
    }

    /// The block of an inverse that stands at these places of a line, by columns, times a factor.
    pub(super) fn scaled_block(&self, line: usize, [row, column]: [usize; 2], factor: f32, out: &mut [f32]) {
        let (h, n) = (self.height, self.lines.blocks(line).len() * self.height);
        for k in 0..h {
            for l in 0..h {
                out[l * h + k] = factor * self.of_lines[line][(row * h + k) * n + column * h + l];
            }
        }
    }

    /// `step = keep step + gain D⁻¹ r`, where `one` does the same with the inverses of blocks.
    pub(super) fn step(&self, keep: f32, step: &mut [f32], work: &mut [f32], one: impl FnOnce(&mut [f32])) {
        let (h, wide) = (self.height, LONGEST * self.height);
        let place = |line: usize, at: usize| line * wide + at * h;
        let unknowns = |block: u32| block as usize * h..(block as usize + 1) * h;
        for line in 0..self.lines.count() {
            for (at, &block) in self.lines.blocks(line).iter().enumerate() {
                let to = &mut work[place(line, at)..][..h];
                to.iter_mut().zip(&step[unknowns(block)]).for_each(|(to, step)| *to = keep * step);
                step[unknowns(block)].fill(0.0);
            }
        }
        one(step);
        let from = &*step;
        parallel::groups_mut(work, wide, LINES, |line, work| {
            let blocks = self.lines.blocks(line);
            for (sum, row) in work.iter_mut().zip(self.of_lines[line].chunks_exact(blocks.len() * h)) {
                let gained = blocks
                    .iter()
                    .zip(row.chunks_exact(h))
                    .map(|(&block, row)| row.iter().zip(&from[unknowns(block)]).map(|(a, r)| a * r).sum::<f32>());
                *sum += gained.sum::<f32>();
            }
        });
        for line in 0..self.lines.count() {
            for (at, &block) in self.lines.blocks(line).iter().enumerate() {
                step[unknowns(block)].copy_from_slice(&work[place(line, at)..][..h]);
            }
        }
    }
}

/// Inverse, by rows, of the part of a matrix that these blocks have; its work space may be used again for as many blocks.
fn invert(matrix: &BlockMatrix, blocks: &[u32], (lu, column): &mut (Vec<f64>, Vec<f64>), out: &mut [f32]) {
    let (h, n) = (matrix.height, blocks.len() * matrix.height);
    lu.clear();
    lu.resize(n * n, 0.0);
    for (r, &i) in blocks.iter().enumerate() {
        let (columns, values) = matrix.row(i as usize);
        for (c, j) in blocks.iter().enumerate() {
            let Ok(at) = columns.binary_search(j) else { continue };
            for (l, column) in values[at * h * h..(at + 1) * h * h].chunks_exact(h).enumerate() {
                let to = &mut lu[(c * h + l) * n + r * h..][..h];
                to.iter_mut().zip(column).for_each(|(to, &v)| *to = f64::from(v));
            }
        }
    }
    let largest = lu.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 {
        return;
    }
    // Unknowns that nothing acts on, e.g. modes that an aggregate does not have.
    for k in 0..n {
        if (0..n).all(|l| lu[k + n * l] == 0.0) {
            lu[k + n * k] = largest;
        }
    }
    let pivots = dense_lu::factorise(lu, n, LEAST_PIVOT * largest);
    column.resize(n, 0.0);
    for w in 0..n {
        column.fill(0.0);
        column[w] = 1.0;
        dense_lu::solve(lu, n, &pivots, column);
        (0..n).for_each(|k| out[k * n + w] = column[k] as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of points, `through` to one along the third direction, with equal couplings beside.
    fn grid(points: [usize; 3], through: f32) -> BlockMatrix {
        let [nx, ny, nz] = points;
        let at = |i: usize, j: usize, k: usize| i + nx * (j + ny * k);
        BlockMatrix::from_rows([nx * ny * nz; 2], [1, 1], |row_at, row| {
            let (i, j, k) = (row_at % nx, row_at / nx % ny, row_at / nx / ny);
            let beside = [
                (i > 0, i.wrapping_sub(1), j),
                (i + 1 < nx, i + 1, j),
                (j > 0, i, j.wrapping_sub(1)),
                (j + 1 < ny, i, j + 1),
            ];
            for (_, i, j) in beside.into_iter().filter(|(is_there, _, _)| *is_there) {
                row.block(at(i, j, k) as u32)[0] = -1.0;
            }
            for k in [k.wrapping_sub(1), k + 1].into_iter().filter(|&k| k < nz) {
                row.block(at(i, j, k) as u32)[0] = -through;
            }
            row.block(row_at as u32)[0] = 4.0 + 2.0 * through;
        })
    }

    /// ANALYTIC: the strong direction of a grid; lines are longer than two or much stronger, and no longer than eight.
    #[test]
    fn lines_go_where_couplings_dominate() {
        let lines = |points: [usize; 3], through: f32| {
            let matrix = grid(points, through);
            let lines = Lines::new(&Couplings::new(&matrix, &vec![0; matrix.rows], &[]));
            assert!(lines.is_sound(matrix.rows));
            let all = (0..lines.count()).map(|line| lines.blocks(line).to_vec());
            let apart = points[0] * points[1];
            all.inspect(|line| {
                let steps = line.windows(2).map(|pair| (pair[0] as usize).abs_diff(pair[1] as usize));
                assert!(steps.into_iter().all(|step| step == apart), "{line:?}");
            })
            .map(|line| line.len())
            .collect::<Vec<usize>>()
        };
        assert_eq!(lines([4, 5, 3], 2.0), [3; 20]);
        assert_eq!(lines([4, 5, 2], 2.0), [2; 20]);
        assert!(lines([4, 5, 2], 1.4).is_empty() && lines([4, 5, 6], 1.2).is_empty());
        assert_eq!(lines([2, 2, 20], 3.0), [6, 7, 7, 6, 7, 7, 6, 7, 7, 6, 7, 7]);
    }

    /// ANALYTIC: a step over a grid of lines alone is the solution, to single precision.
    #[test]
    fn lines_are_solved_exactly() {
        let matrix = grid([1, 1, 5], 3.0);
        let lines = Lines { blocks: vec![4, 3, 2, 1, 0], starts: vec![0, 5] };
        let inverses = Inverses::new(&matrix, lines);
        let solution = [1.0, -2.0, 0.5, 3.0, 4.0];
        let mut b = vec![0.0; 5];
        matrix.mul_vec(&solution, &mut b, super::super::block_matrix::Into::Set);
        let (mut step, mut work) = (vec![1.0; 5], vec![0.0; inverses.work()]);
        inverses.step(0.5, &mut step, &mut work, |step| {
            matrix.smoothing_step(inverses.of_blocks(), &b, &[0.0; 5], [0.5, 2.0], step);
        });
        for (found, x) in step.iter().zip(solution) {
            assert!((found - (0.5 + 2.0 * x)).abs() < 1e-5, "{step:?}");
        }
    }
}
