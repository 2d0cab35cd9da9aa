//! Comparison of the tangent of a user material with differences of its stress, before the run.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::Properties;
use zelus_structural_mechanics::laws::{ConstitutiveLaw, MakeLaw, Matrix, StrainState};
use zelus_structural_mechanics::tensor::{IDENTITY, Tensor, pairs};

/// Sizes of the strains at which tangents are compared.
const SIZES: [f64; 2] = [1e-5, 2e-3];
/// Half the width of a difference, in sizes of the strain.
const STEP: f64 = 1e-4;
/// Difference, as a share of the largest entry of the tangent, that Newton's iteration does not feel.
const TOLERANCE: f64 = 0.02;
/// The displacement gradient, in sizes of the strain: no two components alike.
const GRADIENT: [[f64; 3]; 3] = [[1.0, 0.25, -0.15], [0.25, -0.4, 0.1], [-0.15, 0.1, 0.3]];
/// Names of tensor components.
const AXES: [char; 3] = ['X', 'Y', 'Z'];

/// Name of what gives a tangent, and how to mend it.
pub struct TangentSource {
    name: &'static str,
    remedy: &'static str,
}

/// A subroutine UMAT.
pub const OF_UMAT: &TangentSource = &TangentSource {
    name: "UMAT",
    remedy: "DDSDDE is the derivative of STRESS at the end of the step by DSTRAN, of large strains by Jaumann's rate; set UMAT_IS_UNSYMMETRIC where it is not symmetric. Newton's iteration converges slowly with another",
};

/// A function of the host program.
pub const OF_FUNCTION: &TangentSource = &TangentSource {
    name: "function",
    remedy: "the tangent is the derivative of the stress at the end of the step by the strain, row by row; set LAW_IS_UNSYMMETRIC where it is not symmetric. Newton's iteration converges slowly with another",
};

/// The first step of a point at rest with this displacement gradient.
struct Trial<'a> {
    history: &'a [f64],
    element: usize,
    is_small: bool,
    temperature: f64,
}

impl Trial<'_> {
    fn state<const S: usize>(&self, gradient: &Tensor) -> StrainState<'_, S> {
        let f = IDENTITY + gradient;
        let strain =
            if self.is_small { 0.5 * (gradient + gradient.transpose()) } else { 0.5 * (f.transpose() * f - IDENTITY) };
        StrainState {
            strain: pairs::<S>().map(|(i, j)| if i == j { strain[(i, j)] } else { 2.0 * strain[(i, j)] }),
            f,
            det_f: f.determinant(),
            small: self.is_small,
            temperature: self.temperature,
            step: [0.0, 1.0],
            place: [self.element, 1],
            history: self.history,
            ..StrainState::REST
        }
    }

    /// Largest difference between tangent and differences at strains of a size, as a share of the largest entry of the tangent, and its
    /// row and column; `None` where the routine gives no numbers.
    fn difference<const S: usize>(&self, law: &dyn ConstitutiveLaw<S>, size: f64) -> Option<(f64, [usize; 2])> {
        let in_plane = |i: usize, j: usize| S == 6 || (i < 2 && j < 2) || i == j;
        let gradient = Tensor::from_fn(|i, j| if in_plane(i, j) { size * GRADIENT[i][j] } else { 0.0 });
        let mut tangent: Matrix<S> = [[0.0; S]; S];
        law.pk2(&self.state(&gradient), Some(&mut tangent));
        let largest = tangent.as_flattened().iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let mut worst = (0.0, [0; 2]);
        for (column, (i, j)) in pairs::<S>().into_iter().enumerate() {
            let at = |sign: f64| {
                let mut moved = gradient;
                moved[(i, j)] += 0.5 * sign * STEP * size;
                moved[(j, i)] += 0.5 * sign * STEP * size;
                let state = self.state::<S>(&moved);
                let mut unused: Matrix<S> = [[0.0; S]; S];
                (law.pk2(&state, Some(&mut unused)), state.strain)
            };
            let ((after, strain), (before, past)) = (at(1.0), at(-1.0));
            let change: [f64; S] = std::array::from_fn(|c| strain[c] - past[c]);
            for row in 0..S {
                let expected: f64 = tangent[row].iter().zip(change).map(|(entry, change)| entry * change).sum();
                let off = (after[row] - before[row] - expected).abs() / (largest * change[column].abs());
                if !off.is_finite() {
                    return None;
                }
                if off > worst.0 {
                    worst = (off, [row, column]);
                }
            }
        }
        Some(worst)
    }
}

/// A warning where the tangent of a law that `make` makes of properties differs from differences of its stress.
pub fn warning<const S: usize>(
    properties: &Properties,
    element: usize,
    make: MakeLaw<S>,
    is_small: bool,
    source: &TangentSource,
) -> Option<Diagnostic> {
    let law = make(properties).ok()?;
    let history = vec![0.0; law.history()];
    let temperature = properties.number("REFERENCE_TEMPERATURE").unwrap_or(0.0);
    let trial = Trial { history: &history, element, is_small, temperature };
    let of_sizes = SIZES.into_iter().filter_map(|size| Some((size, trial.difference(&*law, size)?)));
    let (size, (share, [row, column])) = of_sizes.max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    if share <= TOLERANCE {
        return None;
    }
    let name = |at: usize| {
        let (i, j) = pairs::<S>()[at];
        format!("{}{}", AXES[i], AXES[j])
    };
    let fact = format!(
        "the tangent of the {} of properties {} differs from differences of its stress by {:.1} % of its largest entry, in d{}/d{} at strains of {size:e}",
        source.name,
        properties.id,
        100.0 * share,
        name(row),
        name(column)
    );
    Some(Diagnostic::warning("wrong-tangent", fact).at(properties.place.clone()).remedy(source.remedy))
}
