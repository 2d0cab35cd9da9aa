//! The product of a row of blocks with a vector: what the time of multigrid goes into.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

/// Entries behind the last block that may be read, but count for nothing.
pub(super) const TAIL: usize = 24;
/// Entries of the vector that are gathered at a time.
const GATHERED: usize = 96;
/// Entries of the vector that make whole lanes with blocks of any height.
const GROUP: usize = 8;

/// `Σ_j B_j x_j` over blocks of `H` rows and `W` columns, given by columns one after the other; `values` has [`TAIL`] entries more.
#[inline(always)]
pub(super) fn row_product<const H: usize, const W: usize>(columns: &[u32], values: &[f32], x: &[f32]) -> [f32; H] {
    match H {
        2 => low::<H, W, { 2 * GROUP }>(columns, values, x),
        3 if W.is_multiple_of(3) => threes::<H, W, Plain>(columns, values, x),
        3 => low::<H, W, { 3 * GROUP }>(columns, values, x),
        _ => high::<H, W>(columns, values, x),
    }
}

/// The same by AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
pub(super) fn row_product_by_avx2<const H: usize, const W: usize>(
    columns: &[u32],
    values: &[f32],
    x: &[f32],
) -> [f32; H] {
    match H {
        3 if W.is_multiple_of(3) => threes::<H, W, Avx2>(columns, values, x),
        _ => row_product::<H, W>(columns, values, x),
    }
}

/// Eight running sums.
trait Lanes: Copy {
    fn zero() -> Self;
    /// Adds the products of the entries of a block of three rows and columns but the last, by columns, with those of x.
    fn add(&mut self, block: &[f32; 9], x: [f32; 3]);
    fn sums(self) -> [f32; 8];
}

#[derive(Clone, Copy)]
struct Plain([f32; 8]);

impl Lanes for Plain {
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
struct Avx2(std::arch::x86_64::__m256);

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
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
