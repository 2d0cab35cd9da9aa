//! The product of small dense blocks.
//!
//! Entries are added in one order, so that processors with wider vectors give the same bits, sooner.

/// Adds the product of a `h × k` and a `k × w` block to a `h × w` one, all by columns. The first and the sum have [`BESIDE`] entries
/// more, of whatever value, so that whole vectors can be read.
pub(super) type Multiply = fn([usize; 3], &[f32], &[f32], &mut [f32]);

/// Entries behind a block that may be read.
pub(super) const BESIDE: usize = 2;

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
        return |shape, a, b, out| unsafe { by_avx2::<H, L, K, W>(shape, a, b, out) };
    }
    fixed::<H, L, K, W>
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn by_avx2<const H: usize, const L: usize, const K: usize, const W: usize>(
    shape: [usize; 3],
    a: &[f32],
    b: &[f32],
    out: &mut [f32],
) {
    fixed::<H, L, K, W>(shape, a, b, out);
}

/// Columns of the first block and of the sum are read as `L ≥ H` entries, of which the first `H` count.
#[inline(always)]
fn fixed<const H: usize, const L: usize, const K: usize, const W: usize>(
    _: [usize; 3],
    a: &[f32],
    b: &[f32],
    out: &mut [f32],
) {
    let (a, b, out) = (&a[..H * (K - 1) + L], &b[..K * W], &mut out[..H * (W - 1) + L]);
    for w in 0..W {
        let mut sum: [f32; L] = out[w * H..w * H + L].try_into().expect("a column of the block");
        for k in 0..K {
            let column: &[f32; L] = a[k * H..k * H + L].try_into().expect("a column of the block");
            (0..L).for_each(|l| sum[l] += column[l] * b[w * K + k]);
        }
        out[w * H..(w + 1) * H].copy_from_slice(&sum[..H]);
    }
}

fn any([h, k, w]: [usize; 3], a: &[f32], b: &[f32], out: &mut [f32]) {
    for j in 0..w {
        for l in 0..k {
            for i in 0..h {
                out[j * h + i] += a[l * h + i] * b[j * k + l];
            }
        }
    }
}
