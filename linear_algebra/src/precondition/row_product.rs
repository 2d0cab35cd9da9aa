//! The product of a row of blocks with a vector: the kernel that dominates the time of multigrid.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

use crate::prefetch::{AHEAD, prefetch, prefetch_as_many};

/// Entries behind the last block that may be read, but count for nothing.
pub(super) const TAIL: usize = 24;
/// Entries of the vector that are gathered at a time.
const GATHERED: usize = 96;
/// Entries of the vector that make whole lanes with blocks of any height.
const GROUP: usize = 8;

/// `Σ_j B_j x_j` over blocks of `H` rows and `W` columns, given by columns one after the other; `values` has [`TAIL`] entries more.
#[inline(always)]
pub(super) fn row_product<const H: usize, const W: usize, L: Lanes>(
    columns: &[u32],
    values: &[f32],
    x: &[f32],
) -> [f32; H] {
    match H {
        2 => low::<H, W, { 2 * GROUP }>(columns, values, x),
        3 if W.is_multiple_of(3) => threes::<H, W, L>(columns, values, x),
        3 => low::<H, W, { 3 * GROUP }>(columns, values, x),
        _ => high::<H, W>(columns, values, x),
    }
}

/// Eight running sums.
pub(super) trait Lanes: Copy {
    fn zero() -> Self;
    /// Adds the products of the entries of a block of three rows and columns but the last, by columns, with those of x.
    fn add(&mut self, block: &[f32; 9], x: [f32; 3]);
    fn sums(self) -> [f32; 8];
}

/// For any processor.
#[derive(Clone, Copy)]
pub(super) struct PortableLanes([f32; 8]);

impl Lanes for PortableLanes {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; 8])
    }

    #[inline(always)]
    fn add(&mut self, block: &[f32; 9], [x, y, z]: [f32; 3]) {
        let wide = [x, x, x, y, y, y, z, z];
        (0..8).for_each(|l| self.0[l] += block[l] * wide[l]);
    }

    #[inline(always)]
    fn sums(self) -> [f32; 8] {
        self.0
    }
}

/// Made only where the processor knows AVX2.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Avx2Lanes(std::arch::x86_64::__m256);

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2Lanes {
    #[inline(always)]
    fn zero() -> Self {
        // SAFETY: see the type.
        Self(unsafe { std::arch::x86_64::_mm256_setzero_ps() })
    }

    #[inline(always)]
    fn add(&mut self, block: &[f32; 9], [x, y, z]: [f32; 3]) {
        use std::arch::x86_64::*;
        // SAFETY: see the type; a block has the eight entries that are read.
        unsafe {
            let wide = _mm256_castps128_ps256(_mm_set_ps(0.0, z, y, x));
            let wide = _mm256_permutevar8x32_ps(wide, _mm256_set_epi32(2, 2, 1, 1, 1, 0, 0, 0));
            self.0 = _mm256_add_ps(self.0, _mm256_mul_ps(_mm256_loadu_ps(block.as_ptr()), wide));
        }
    }

    #[inline(always)]
    fn sums(self) -> [f32; 8] {
        let mut sums = [0.0; 8];
        // SAFETY: see the type; there is room for eight entries.
        unsafe { std::arch::x86_64::_mm256_storeu_ps(sums.as_mut_ptr(), self.0) };
        sums
    }
}

/// Blocks of three rows and columns, of which `W / 3` stand side by side. All their entries but the last fill a vector.
#[inline(always)]
fn threes<const H: usize, const W: usize, L: Lanes>(columns: &[u32], values: &[f32], x: &[f32]) -> [f32; H] {
    // Running sums side by side hide the time that an addition takes.
    let (mut sums, mut last) = ([L::zero(); 2], [0.0_f32; 2]);
    let (blocks, _) = values.as_chunks::<9>();
    let (x, _) = x.as_chunks::<3>();
    let mut add = |way: usize, at: usize, j: usize| {
        prefetch(&blocks[at], AHEAD);
        sums[way].add(&blocks[at], x[j]);
        last[way] += blocks[at][8] * x[j][2];
    };
    let wide = W / 3;
    if wide == 1 {
        let (pairs, rest) = columns.as_chunks::<2>();
        for (at, &[i, j]) in pairs.iter().enumerate() {
            add(0, 2 * at, i as usize);
            add(1, 2 * at + 1, j as usize);
        }
        rest.iter().for_each(|&j| add(0, columns.len() - 1, j as usize));
    } else {
        for (at, &j) in columns.iter().enumerate() {
            (0..wide).for_each(|k| add(k % 2, at * wide + k, j as usize * wide + k));
        }
    }
    let [a, b] = sums.map(L::sums);
    let s: [f32; 8] = std::array::from_fn(|l| a[l] + b[l]);
    let found = [s[0] + s[3] + s[6], s[1] + s[4] + s[7], s[2] + s[5] + (last[0] + last[1])];
    std::array::from_fn(|h| found[h])
}

/// Blocks of few rows: entries of x are gathered and each is repeated `H` times, so that products are those of long vectors; a running
/// sum is of one row as `L` is a multiple of `H`.
#[inline(always)]
fn low<const H: usize, const W: usize, const L: usize>(columns: &[u32], values: &[f32], x: &[f32]) -> [f32; H] {
    let mut sums = [0.0_f32; L];
    let mut gathered = [0.0_f32; GATHERED + GROUP];
    for (batch, columns) in columns.chunks(GATHERED / W).enumerate() {
        for (to, &j) in gathered.chunks_exact_mut(W).zip(columns) {
            let from: &[f32; W] = x[j as usize * W..j as usize * W + W].try_into().expect("a block of x");
            to.copy_from_slice(from);
        }
        let known = columns.len() * W;
        gathered[known..known + GROUP].fill(0.0);
        let values = &values[batch * GATHERED * H..];
        for (x, values) in gathered[..known.next_multiple_of(GROUP)].chunks_exact(GROUP).zip(values.chunks_exact(L)) {
            prefetch_as_many(values, AHEAD);
            for l in 0..L {
                sums[l] += values[l] * x[l / H];
            }
        }
    }
    let mut out = [0.0; H];
    (0..L).for_each(|l| out[l % H] += sums[l]);
    out
}

/// Blocks of up to eight rows, by columns.
#[inline(always)]
fn high<const H: usize, const W: usize>(columns: &[u32], values: &[f32], x: &[f32]) -> [f32; H] {
    // Running sums side by side hide the time that an addition takes.
    let mut sums = [[0.0_f32; GROUP]; 3];
    for (at, &j) in columns.iter().enumerate() {
        let block = &values[at * H * W..at * H * W + (W - 1) * H + GROUP];
        prefetch_as_many(block, AHEAD);
        let x: &[f32; W] = x[j as usize * W..j as usize * W + W].try_into().expect("a block of x");
        for w in 0..W {
            let column: &[f32; GROUP] = block[w * H..w * H + GROUP].try_into().expect("a column of the block");
            for l in 0..GROUP {
                sums[w % 3][l] += column[l] * x[w];
            }
        }
    }
    std::array::from_fn(|h| sums[0][h] + sums[1][h] + sums[2][h])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of blocks, its columns, and a vector of as many blocks.
    fn row(blocks: usize, size: usize, width: usize) -> (Vec<u32>, Vec<f32>, Vec<f32>) {
        let numbers = |n: usize, seed: usize| (0..n).map(move |k| ((k * seed + 7) % 101) as f32 / 37.0 - 1.3);
        let mut values: Vec<f32> = numbers(blocks * size, 53).collect();
        values.extend([0.0; TAIL]);
        let columns = (0..blocks as u32).map(|at| 2 * at + at % 2).collect();
        (columns, values, numbers((2 * blocks + 1) * width, 29).collect())
    }

    fn check<const H: usize, const W: usize, L: Lanes>(blocks: usize) {
        let (columns, values, x) = row(blocks, H * W, W);
        let found = row_product::<H, W, L>(&columns, &values, &x);
        assert_eq!(found, row_product::<H, W, PortableLanes>(&columns, &values, &x), "{blocks} blocks of {H} by {W}");
        for (h, found) in found.into_iter().enumerate() {
            let entry = |at: usize, w: usize| f64::from(values[at * H * W + w * H + h]);
            let terms = columns.iter().enumerate().flat_map(|(at, &j)| (0..W).map(move |w| (at, j as usize, w)));
            let terms = terms.map(|(at, j, w)| entry(at, w) * f64::from(x[j * W + w]));
            let [sum, size] = terms.fold([0.0_f64; 2], |[sum, size], term| [sum + term, size + term.abs()]);
            assert!((f64::from(found) - sum).abs() <= 1e-6 * size, "{blocks} blocks of {H} by {W}: {found}, {sum}");
        }
    }

    fn check_all<L: Lanes>() {
        for blocks in [0, 1, 2, 3, 8, 27, 32, 33, 64, 65] {
            check::<1, 1, L>(blocks);
            check::<2, 2, L>(blocks);
            check::<2, 3, L>(blocks);
            check::<3, 2, L>(blocks);
            check::<3, 3, L>(blocks);
            check::<3, 6, L>(blocks);
            check::<6, 3, L>(blocks);
            check::<6, 6, L>(blocks);
        }
    }

    #[test]
    fn every_processor_gives_the_same_bits() {
        check_all::<PortableLanes>();
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            check_all::<Avx2Lanes>();
        }
    }
}
