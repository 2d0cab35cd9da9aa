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
        3 => low::<H, W, { 3 * GROUP }>(columns, values, x),
        _ => high::<H, W>(columns, values, x),
    }
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
