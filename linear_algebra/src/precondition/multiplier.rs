//! The product of small dense blocks.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

/// Adds the product of a `h × k` and a `k × w` block, by columns, to sums by columns of [`lanes`] of `h` numbers; the first block has
/// [`BESIDE`] entries more, of whatever value, so that whole vectors can be read.
pub(super) type Multiply = fn([usize; 3], &[f32], &[f32], &mut [f32]);

/// Entries behind a block that may be read.
pub(super) const BESIDE: usize = 2;

/// Numbers from one column of sums to the next: columns of the size of a vector are written and read again in one piece.
pub(super) fn lanes(height: usize) -> usize {
    match height {
        3 => 4,
        6 => 8,
        other => other,
    }
}

/// The product of blocks of this shape `[h, k, w]`.
pub(super) fn multiplier(shape: [usize; 3]) -> Multiply {
    match shape {
        [1, 1, 1] => fixed::<1, 1, 1, 1>,
        [2, 2, 2] => fixed::<2, 2, 2, 2>,
        [2, 2, 3] => fixed::<2, 2, 2, 3>,
        [3, 2, 3] => wide::<3, 4, 2, 3>(),
        [3, 3, 3] => wide::<3, 4, 3, 3>(),
        [3, 3, 6] => wide::<3, 4, 3, 6>(),
        [6, 3, 6] => wide::<6, 8, 3, 6>(),
        [6, 6, 6] => wide::<6, 8, 6, 6>(),
        _ => any,
    }
}

/// The product for what the processor has.
fn wide<const H: usize, const L: usize, const K: usize, const W: usize>() -> Multiply {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just said that it knows AVX2.
        return |shape, a, b, sums| unsafe { by_avx2::<H, L, K, W>(shape, a, b, sums) };
    }
    fixed::<H, L, K, W>
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn by_avx2<const H: usize, const L: usize, const K: usize, const W: usize>(
    shape: [usize; 3],
    a: &[f32],
    b: &[f32],
    sums: &mut [f32],
) {
    fixed::<H, L, K, W>(shape, a, b, sums);
}

/// Columns of the first block are read as `L ≥ H` entries, of which the first `H` count.
#[inline(always)]
fn fixed<const H: usize, const L: usize, const K: usize, const W: usize>(
    _: [usize; 3],
    a: &[f32],
    b: &[f32],
    sums: &mut [f32],
) {
    let (a, b, (sums, _)) = (&a[..H * (K - 1) + L], &b[..K * W], sums[..L * W].as_chunks_mut::<L>());
    let columns: [[f32; L]; K] = std::array::from_fn(|k| a[k * H..k * H + L].try_into().expect("a column"));
    for (w, sum) in sums.iter_mut().enumerate() {
        for (k, column) in columns.iter().enumerate() {
            (0..L).for_each(|l| sum[l] += column[l] * b[w * K + k]);
        }
    }
}

fn any([h, k, w]: [usize; 3], a: &[f32], b: &[f32], sums: &mut [f32]) {
    for j in 0..w {
        for l in 0..k {
            for i in 0..h {
                sums[j * lanes(h) + i] += a[l * h + i] * b[j * k + l];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_all_shapes_are_sums_of_their_terms() {
        let shapes = [
            [1, 1, 1],
            [2, 2, 2],
            [2, 2, 3],
            [3, 2, 3],
            [3, 3, 3],
            [3, 3, 6],
            [6, 3, 6],
            [6, 6, 6],
            [4, 3, 5],
            [6, 2, 1],
        ];
        for [h, k, w] in shapes {
            let a: Vec<f32> = (0..h * k + BESIDE).map(|at| (at * 7 % 11) as f32 - 5.0).collect();
            let b: Vec<f32> = (0..k * w).map(|at| (at * 5 % 13) as f32 - 6.0).collect();
            let mut sums = vec![1.0; lanes(h) * w];
            multiplier([h, k, w])([h, k, w], &a, &b, &mut sums);
            for (i, j) in (0..h).flat_map(|i| (0..w).map(move |j| (i, j))) {
                let exact = (0..k).map(|l| a[l * h + i] * b[j * k + l]).sum::<f32>() + 1.0;
                assert_eq!(sums[j * lanes(h) + i], exact, "{h} {k} {w}: {i} {j}");
            }
        }
    }
}
