//! Orthotropic elasticity: constants along three material axes, and the matrices of its law.
//!
//! The compliance is S_ii = 1/E_i and S_ij = S_ji = −ν_ij/E_i between normal stress and strain, and γ_ij = τ_ij/G_ij. ν_ij is the
//! contraction along j per extension along i under stress along i, so that ν_ij/E_i = ν_ji/E_j. A transversely isotropic material has
//! the axis x and is isotropic across it: E_z = E_y, ν_xz = ν_xy, G_xz = G_xy and G_yz = E_y/(2 (1 + ν_yz)).

use nalgebra::Matrix2;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::law::Matrix;
use crate::tensor::{Tensor, pairs};

/// Constants of one orthotropic material in its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrthotropicElasticity {
    /// Stiffness C_ij between normal stresses and normal strains.
    normal: Tensor,
    /// Shear moduli G_xy, G_yz, G_xz.
    shear: [f64; 3],
}

/// Constants in space.
pub const CONSTANTS: &[&str] = &[
    "YOUNG_MODULUS_X",
    "YOUNG_MODULUS_Y",
    "YOUNG_MODULUS_Z",
    "POISSON_RATIO_XY",
    "POISSON_RATIO_YZ",
    "POISSON_RATIO_XZ",
    "SHEAR_MODULUS_XY",
    "SHEAR_MODULUS_YZ",
    "SHEAR_MODULUS_XZ",
    "EULER_ANGLES",
];

/// Constants in plane strain and with axial symmetry.
pub const CONSTANTS_OF_SECTIONS: &[&str] = &[
    "YOUNG_MODULUS_X",
    "YOUNG_MODULUS_Y",
    "YOUNG_MODULUS_Z",
    "POISSON_RATIO_XY",
    "POISSON_RATIO_YZ",
    "POISSON_RATIO_XZ",
    "SHEAR_MODULUS_XY",
    "EULER_ANGLES",
];

/// Constants in plane stress.
pub const CONSTANTS_OF_PLANE_STRESS: &[&str] =
    &["YOUNG_MODULUS_X", "YOUNG_MODULUS_Y", "POISSON_RATIO_XY", "SHEAR_MODULUS_XY", "EULER_ANGLES"];

/// Constants of transversely isotropic laws.
pub const CONSTANTS_ABOUT_AN_AXIS: &[&str] =
    &["YOUNG_MODULUS_X", "YOUNG_MODULUS_Y", "POISSON_RATIO_XY", "POISSON_RATIO_YZ", "SHEAR_MODULUS_XY", "EULER_ANGLES"];

impl OrthotropicElasticity {
    /// The constants along three axes; the shear moduli YZ and XZ where there is such shear, `in_space`.
    ///
    /// # Errors
    /// A constant that is missing or out of range, constants of negative energy.
    pub fn of(properties: &Properties, in_space: bool) -> Result<Self> {
        let (modulus, ratio) = (|name| modulus(properties, name), |name| ratio(properties, name));
        let young = [modulus("YOUNG_MODULUS_X")?, modulus("YOUNG_MODULUS_Y")?, modulus("YOUNG_MODULUS_Z")?];
        let poisson = [ratio("POISSON_RATIO_XY")?, ratio("POISSON_RATIO_YZ")?, ratio("POISSON_RATIO_XZ")?];
        let in_plane = modulus("SHEAR_MODULUS_XY")?;
        let shear = if in_space {
            [in_plane, modulus("SHEAR_MODULUS_YZ")?, modulus("SHEAR_MODULUS_XZ")?]
        } else {
            [in_plane; 3]
        };
        Self::new(properties, young, poisson, shear)
    }

    /// The constants of an axis X and of the plane across it.
    ///
    /// # Errors
    /// As [`OrthotropicElasticity::of`].
    pub fn about_an_axis(properties: &Properties) -> Result<Self> {
        let (x, y) = (modulus(properties, "YOUNG_MODULUS_X")?, modulus(properties, "YOUNG_MODULUS_Y")?);
        let (xy, yz) = (ratio(properties, "POISSON_RATIO_XY")?, ratio(properties, "POISSON_RATIO_YZ")?);
        let shear = modulus(properties, "SHEAR_MODULUS_XY")?;
        Self::new(properties, [x, y, y], [xy, yz, xy], [shear, 0.5 * y / (1.0 + yz), shear])
    }

    /// The constants of plane stress.
    ///
    /// # Errors
    /// As [`OrthotropicElasticity::of`].
    pub fn of_plane_stress(properties: &Properties) -> Result<Self> {
        let (x, y) = (modulus(properties, "YOUNG_MODULUS_X")?, modulus(properties, "YOUNG_MODULUS_Y")?);
        let xy = ratio(properties, "POISSON_RATIO_XY")?;
        let shear = modulus(properties, "SHEAR_MODULUS_XY")?;
        bound(properties, "XY", xy, [x, y])?;
        let compliance = Matrix2::new(x.recip(), -xy / x, -xy / x, y.recip());
        let mut normal = Tensor::zeros();
        let inverse = compliance.try_inverse().unwrap_or(Matrix2::repeat(f64::NAN));
        normal.fixed_view_mut::<2, 2>(0, 0).copy_from(&inverse);
        Ok(Self { normal, shear: [shear; 3] })
    }

    /// From E_x, E_y, E_z, from ν_xy, ν_yz, ν_xz and from G_xy, G_yz, G_xz.
    fn new(properties: &Properties, young: [f64; 3], poisson: [f64; 3], shear: [f64; 3]) -> Result<Self> {
        let ([x, y, z], [xy, yz, xz]) = (young, poisson);
        bound(properties, "XY", xy, [x, y])?;
        bound(properties, "YZ", yz, [y, z])?;
        bound(properties, "XZ", xz, [x, z])?;
        let compliance = Tensor::new(
            x.recip(),
            -xy / x,
            -xz / x, //
            -xy / x,
            y.recip(),
            -yz / y, //
            -xz / x,
            -yz / y,
            z.recip(),
        );
        let Some(factors) = compliance.cholesky() else {
            let fact = format!(
                "the Poisson's ratios XY, YZ and XZ of properties {}, {xy}, {yz} and {xz}, give strains of negative energy together",
                properties.id
            );
            let remedy =
                "lower them: 1 − ν_xy²E_y/E_x − ν_yz²E_z/E_y − ν_xz²E_z/E_x − 2 ν_xy ν_yz ν_xz E_z/E_x must be above 0";
            return Err(out_of_range(properties, fact, remedy).into());
        };
        Ok(Self { normal: factors.inverse(), shear })
    }

    /// The matrix of the law in the axes of the material.
    pub fn matrix<const S: usize>(&self) -> Matrix<S> {
        let pairs = pairs::<S>();
        let mut d = [[0.0; S]; S];
        for (s, &(p, q)) in pairs.iter().enumerate() {
            if p != q {
                // (0, 1), (1, 2) and (0, 2) are the shears xy, yz and xz
                d[s][s] = self.shear[if q - p == 2 { 2 } else { p }];
                continue;
            }
            for (t, &(i, j)) in pairs.iter().enumerate() {
                if i == j {
                    d[s][t] = self.normal[(p, i)];
                }
            }
        }
        d
    }
}

/// Young's modulus that stands for a material: YOUNG_MODULUS, or the mean of those along the axes.
pub fn representative_young(properties: &Properties) -> Option<f64> {
    let along = ["YOUNG_MODULUS_X", "YOUNG_MODULUS_Y", "YOUNG_MODULUS_Z"].into_iter();
    properties.number("YOUNG_MODULUS").or_else(|| {
        let moduli: Vec<f64> = along.filter_map(|name| properties.number(name)).collect();
        (!moduli.is_empty()).then(|| moduli.iter().sum::<f64>() / moduli.len() as f64)
    })
}

fn out_of_range(properties: &Properties, fact: String, remedy: &str) -> Diagnostic {
    Diagnostic::error("material-out-of-range", fact).at(properties.place.clone()).remedy(remedy.to_owned())
}

/// A modulus, which must be positive.
fn modulus(properties: &Properties, name: &str) -> Result<f64> {
    let value = properties.require(name)?;
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    let fact = format!("{name} of properties {} is {value}", properties.id);
    Err(out_of_range(properties, fact, "give a value above 0").into())
}

/// A Poisson's ratio, which must be a number.
fn ratio(properties: &Properties, name: &str) -> Result<f64> {
    let value = properties.require(name)?;
    if value.is_finite() {
        return Ok(value);
    }
    let fact = format!("{name} of properties {} is {value}", properties.id);
    Err(out_of_range(properties, fact, "give a number").into())
}

/// |ν_ij| < √(E_i/E_j).
fn bound(properties: &Properties, axes: &str, poisson: f64, [first, second]: [f64; 2]) -> Result<()> {
    let bound = (first / second).sqrt();
    if poisson.abs() < bound {
        return Ok(());
    }
    let (i, j) = axes.split_at(1);
    let fact = format!("POISSON_RATIO_{axes} of properties {} is {poisson}", properties.id);
    let remedy = format!("give a value within ±{bound:.6}, the root of YOUNG_MODULUS_{i}/YOUNG_MODULUS_{j}");
    Err(out_of_range(properties, fact, &remedy).into())
}
