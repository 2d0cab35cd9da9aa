//! The product of small dense blocks.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

/// Adds the products of a `h × k` block with `k × w` blocks that stand side by side, all by columns, to sums at places, each by columns of
/// [`lanes`] of `h` numbers; the first block has [`BESIDE`] entries more, of whatever value, so that whole vectors can be read.
pub(super) type Multiply = fn([usize; 3], &[f32], &[f32], &[u32], &mut [f32]);

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

/// The products of blocks of this shape `[h, k, w]`.
pub(super) fn multiplier(shape: [usize; 3]) -> Multiply {
    match shape {
        [1, 1, 1] => fixed::<1, 1, 1, 1>,
        [2, 2, 2] => fixed::<2, 2, 2, 2>,
        [2, 2, 3] => fixed::<2, 2, 2, 3>,
        [3, 2, 3] => wide::<3, 4, 2, 3>(),
        [3, 3, 3] => wide::<3, 4, 3, 3>(),
        #[cfg(target_arch = "x86_64")]
        [3, 3, 6] if std::arch::is_x86_feature_detected!("avx2") => {
            // SAFETY: the processor has just said that it knows AVX2.
            |_, a, b, places, sums| unsafe { pairs_of_columns(a, b, places, sums) }
        }
        [3, 3, 6] => fixed::<3, 4, 3, 6>,
        [6, 3, 6] => wide::<6, 8, 3, 6>(),
        [6, 6, 6] => wide::<6, 8, 6, 6>(),
        _ => any,
    }
}

/// The products for the instruction set of the processor.
fn wide<const H: usize, const L: usize, const K: usize, const W: usize>() -> Multiply {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just said that it knows AVX2.
        return |shape, a, b, places, sums| unsafe { by_avx2::<H, L, K, W>(shape, a, b, places, sums) };
    }
    fixed::<H, L, K, W>
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn by_avx2<const H: usize, const L: usize, const K: usize, const W: usize>(
    shape: [usize; 3],
    a: &[f32],
    b: &[f32],
    places: &[u32],
    sums: &mut [f32],
) {
    fixed::<H, L, K, W>(shape, a, b, places, sums);
}

/// As [`fixed`] for 3 × 3 by 3 × 6, two columns of the sums at a time.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn pairs_of_columns(a: &[f32], b: &[f32], places: &[u32], sums: &mut [f32]) {
    use std::arch::x86_64::*;
    let (b, _) = b.as_chunks::<18>();
    let (sums, _) = sums.as_chunks_mut::<24>();
    // Where the vectors that are read begin in a block, and the place in them of the first number of the pair's first column.
    const FROM: [(usize, i32); 3] = [(0, 0), (6, 0), (10, 2)];
    let a: &[f32; 10] = a[..10].try_into().expect("three columns and one number more");
    // SAFETY: four numbers of `a` are read from the third, the sixth and the first on, of ten.
    let columns = [0, 3, 6].map(|k| unsafe { _mm_loadu_ps(a.as_ptr().add(k)) }).map(|c| _mm256_set_m128(c, c));
    for (b, &place) in b.iter().zip(places) {
        let sums = &mut sums[place as usize];
        for (pair, (from, first)) in FROM.into_iter().enumerate() {
            // SAFETY: eight numbers are read from the first, seventh or eleventh of eighteen on.
            let numbers = unsafe { _mm256_loadu_ps(b.as_ptr().add(from)) };
            let to = sums[pair * 8..pair * 8 + 8].as_mut_ptr();
            // SAFETY: these are eight numbers.
            let mut sum = unsafe { _mm256_loadu_ps(to) };
            for (k, column) in (first..).zip(columns) {
                let at = _mm256_set_epi32(k + 3, k + 3, k + 3, k + 3, k, k, k, k);
                sum = _mm256_add_ps(sum, _mm256_mul_ps(column, _mm256_permutevar8x32_ps(numbers, at)));
            }
            // SAFETY: these are eight numbers.
            unsafe { _mm256_storeu_ps(to, sum) };
        }
    }
}

/// Columns of the first block are read as `L ≥ H` entries, of which the first `H` count.
#[inline(always)]
fn fixed<const H: usize, const L: usize, const K: usize, const W: usize>(
    _: [usize; 3],
    a: &[f32],
    b: &[f32],
    places: &[u32],
    sums: &mut [f32],
) {
    let a = &a[..H * (K - 1) + L];
    let columns: [[f32; L]; K] = std::array::from_fn(|k| a[k * H..k * H + L].try_into().expect("a column"));
    for (b, &place) in b.chunks_exact(K * W).zip(places) {
        let (sums, _) = sums[place as usize * L * W..][..L * W].as_chunks_mut::<L>();
        for (w, sum) in sums.iter_mut().enumerate() {
            for (k, column) in columns.iter().enumerate() {
                (0..L).for_each(|l| sum[l] += column[l] * b[w * K + k]);
            }
        }
    }
}

fn any([h, k, w]: [usize; 3], a: &[f32], b: &[f32], places: &[u32], sums: &mut [f32]) {
    let size = lanes(h) * w;
    for (b, &place) in b.chunks_exact(k * w).zip(places) {
        let sums = &mut sums[place as usize * size..][..size];
        for j in 0..w {
            for l in 0..k {
                for i in 0..h {
                    sums[j * lanes(h) + i] += a[l * h + i] * b[j * k + l];
                }
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
            let (size, places) = (lanes(h) * w, [2, 0, 3]);
            let b: Vec<f32> = (0..3 * k * w).map(|at| (at * 5 % 13) as f32 - 6.0).collect();
            let mut sums = vec![1.0; 4 * size];
            multiplier([h, k, w])([h, k, w], &a, &b, &places, &mut sums);
            for (b, place) in b.chunks_exact(k * w).zip(places) {
                let sums = &sums[place as usize * size..];
                for (i, j) in (0..h).flat_map(|i| (0..w).map(move |j| (i, j))) {
                    let exact = (0..k).map(|l| a[l * h + i] * b[j * k + l]).sum::<f32>() + 1.0;
                    assert_eq!(sums[j * lanes(h) + i], exact, "{h} {k} {w}: {i} {j}");
                }
            }
            assert!(sums[size..2 * size].iter().all(|sum| *sum == 1.0), "{h} {k} {w}");
        }
    }
}
