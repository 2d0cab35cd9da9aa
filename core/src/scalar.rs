//! Scalars a formula can be evaluated in: plain numbers, and dual numbers that carry the exact gradient along.
//!
//! A kernel written once for `T: Real` gives its value with `f64` and its value and derivative with [`Dual`]. Branches
//! compare values only, so a derivative is that of the branch taken.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number, possibly with derivatives.
/// Mixed arithmetic with `f64` treats the plain number as a constant; comparison is by value.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + AddAssign<f64>
    + SubAssign<f64>
    + MulAssign<f64>
    + DivAssign<f64>
{
    /// Whether it carries derivatives.
    const DIFFERENTIATES: bool;

    /// A number without derivative.
    fn constant(value: f64) -> Self;

    /// The number itself, derivatives dropped.
    fn value(self) -> f64;

    /// Whether all derivatives are zero.
    fn is_constant(&self) -> bool;

    /// Applies a function of one variable, given its value and derivative at `self.value()`.
    fn chain(self, value: f64, derivative: f64) -> Self;

    /// Adds `a * b` in place, without a temporary.
    fn add_product(&mut self, a: Self, b: Self);

    /// Adds `a * factor` in place, without a temporary.
    fn add_scaled(&mut self, a: Self, factor: f64);

    /// The constant 0.
    #[inline]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    /// The constant 1.
    #[inline]
    fn one() -> Self {
        Self::constant(1.0)
    }

    /// Square root; the derivative at 0 is infinite.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, 0.5 / root)
    }

    /// Absolute value; at 0 the derivative is that of the right-hand side.
    #[inline]
    fn abs(self) -> Self {
        if self.value() < 0.0 { -self } else { self }
    }

    /// Reciprocal.
    #[inline]
    fn recip(self) -> Self {
        let r = 1.0 / self.value();
        self.chain(r, -r * r)
    }

    /// Integer power.
    #[inline]
    fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::one(),
            _ => self.chain(self.value().powi(n), f64::from(n) * self.value().powi(n - 1)),
        }
    }

    /// Real power with a constant exponent.
    #[inline]
    fn powf(self, exponent: f64) -> Self {
        self.chain(self.value().powf(exponent), exponent * self.value().powf(exponent - 1.0))
    }

    /// Exponential function.
    #[inline]
    fn exp(self) -> Self {
        let e = self.value().exp();
        self.chain(e, e)
    }

    /// Natural logarithm.
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value().ln(), 1.0 / self.value())
    }

    /// Sine of an angle in radians.
    #[inline]
    fn sin(self) -> Self {
        self.chain(self.value().sin(), self.value().cos())
    }

    /// Cosine of an angle in radians.
    #[inline]
    fn cos(self) -> Self {
        self.chain(self.value().cos(), -self.value().sin())
    }

    /// Tangent of an angle in radians.
    #[inline]
    fn tan(self) -> Self {
        let t = self.value().tan();
        self.chain(t, 1.0 + t * t)
    }

    /// Inverse sine, in radians.
    #[inline]
    fn asin(self) -> Self {
        let v = self.value();
        self.chain(v.asin(), 1.0 / (1.0 - v * v).sqrt())
    }

    /// Inverse cosine, in radians.
    #[inline]
    fn acos(self) -> Self {
        let v = self.value();
        self.chain(v.acos(), -1.0 / (1.0 - v * v).sqrt())
    }

    /// Inverse tangent, in radians.
    #[inline]
    fn atan(self) -> Self {
        let v = self.value();
        self.chain(v.atan(), 1.0 / (1.0 + v * v))
    }

    /// Hyperbolic tangent.
    #[inline]
    fn tanh(self) -> Self {
        let t = self.value().tanh();
        self.chain(t, 1.0 - t * t)
    }

    /// The larger by value; the first of two equal ones.
    #[inline]
    fn max(self, other: Self) -> Self {
        if other.value() > self.value() { other } else { self }
    }

    /// The smaller by value; the first of two equal ones.
    #[inline]
    fn min(self, other: Self) -> Self {
        if other.value() < self.value() { other } else { self }
    }
}

impl Real for f64 {
    const DIFFERENTIATES: bool = false;

    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn is_constant(&self) -> bool {
        true
    }
    #[inline]
    fn chain(self, value: f64, _derivative: f64) -> Self {
        value
    }
    #[inline]
    fn add_product(&mut self, a: Self, b: Self) {
        *self += a * b;
    }
    #[inline]
    fn add_scaled(&mut self, a: Self, factor: f64) {
        *self += a * factor;
    }
}

/// A number with its gradient with respect to `N` variables (forward differentiation).
/// `gradient[i]` is the partial derivative by variable `i`; order and equality look at the value only.
#[derive(Debug, Clone, Copy)]
pub struct Dual<const N: usize> {
    /// The number.
    pub value: f64,
    /// Its partial derivatives.
    pub gradient: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// Variable `index`: its gradient is the unit vector `index`.
    ///
    /// # Panics
    /// If `index >= N`.
    #[inline]
    pub fn variable(value: f64, index: usize) -> Self {
        let mut gradient = [0.0; N];
        gradient[index] = 1.0;
        Self { value, gradient }
    }
}

impl<const N: usize> Default for Dual<N> {
    fn default() -> Self {
        Self::zero()
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline]
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl<const N: usize> PartialEq for Dual<N> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<const N: usize> PartialOrd for Dual<N> {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<const N: usize> Real for Dual<N> {
    const DIFFERENTIATES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0; N] }
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn is_constant(&self) -> bool {
        self.gradient.iter().all(|&derivative| derivative == 0.0)
    }
    #[inline(always)]
    fn chain(mut self, value: f64, derivative: f64) -> Self {
        self.value = value;
        self.gradient.iter_mut().for_each(|g| *g *= derivative);
        self
    }
    #[inline(always)]
    fn add_product(&mut self, a: Self, b: Self) {
        self.value += a.value * b.value;
        for i in 0..N {
            self.gradient[i] += a.gradient[i] * b.value + b.gradient[i] * a.value;
        }
    }
    #[inline(always)]
    fn add_scaled(&mut self, a: Self, factor: f64) {
        self.value += a.value * factor;
        for i in 0..N {
            self.gradient[i] += a.gradient[i] * factor;
        }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for i in 0..N {
            self.gradient[i] += other.gradient[i];
        }
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for i in 0..N {
            self.gradient[i] -= other.gradient[i];
        }
    }
}

impl<const N: usize> MulAssign for Dual<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        for i in 0..N {
            self.gradient[i] = self.gradient[i] * other.value + other.gradient[i] * self.value;
        }
        self.value *= other.value;
    }
}

impl<const N: usize> DivAssign for Dual<N> {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        let inverse = 1.0 / other.value;
        self.value /= other.value;
        for i in 0..N {
            self.gradient[i] = (self.gradient[i] - other.gradient[i] * self.value) * inverse;
        }
    }
}

impl<const N: usize> AddAssign<f64> for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: f64) {
        self.value += other;
    }
}

impl<const N: usize> SubAssign<f64> for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: f64) {
        self.value -= other;
    }
}

impl<const N: usize> MulAssign<f64> for Dual<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: f64) {
        *self = self.chain(self.value * other, other);
    }
}

impl<const N: usize> DivAssign<f64> for Dual<N> {
    #[inline(always)]
    fn div_assign(&mut self, other: f64) {
        *self = self.chain(self.value / other, 1.0 / other);
    }
}

macro_rules! by_assignment {
    ($($op:ident $method:ident $assign:ident),*) => {$(
        impl<const N: usize> $op for Dual<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                self.$assign(other);
                self
            }
        }
        impl<const N: usize> $op<f64> for Dual<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: f64) -> Self {
                self.$assign(other);
                self
            }
        }
    )*};
}
by_assignment!(Add add add_assign, Sub sub sub_assign, Mul mul mul_assign, Div div div_assign);

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation in one expression, smooth at the test points.
    fn everything<T: Real>(x: T, y: T) -> T {
        let mut z = (x * y + 2.0) / (y - x) - x.powi(3) * 0.5 + (-y).exp() - (x + 3.0).ln();
        z += x.sin() * y.cos() + (x * 0.1).tan() + (x * 0.3).asin() - (y * 0.2).acos() + y.atan() * x.tanh();
        z -= (x * x + y * y).sqrt() + y.powf(1.7) / 3.0 + x.recip() * y.abs() - x.max(y) * x.min(y);
        z *= (x - y) * 0.25;
        z /= y + 1.0;
        z.add_product(x, y);
        z.add_scaled(y, -0.75);
        z
    }

    #[test]
    fn gradient_matches_central_differences() {
        for (x, y) in [(0.7, 1.9), (1.3, 0.4), (0.2, 2.5)] {
            let d = everything(Dual::<2>::variable(x, 0), Dual::variable(y, 1));
            let h = 1e-6;
            let by_x = (everything(x + h, y) - everything(x - h, y)) / (2.0 * h);
            let by_y = (everything(x, y + h) - everything(x, y - h)) / (2.0 * h);
            assert!((d.value - everything(x, y)).abs() < 1e-14);
            assert!((d.gradient[0] - by_x).abs() < 1e-8, "{} {by_x}", d.gradient[0]);
            assert!((d.gradient[1] - by_y).abs() < 1e-8, "{} {by_y}", d.gradient[1]);
        }
    }

    #[test]
    fn powers_at_zero_are_finite() {
        let x = Dual::<1>::variable(0.0, 0);
        assert_eq!(x.powi(0).gradient, [0.0]);
        assert_eq!(x.powi(1).gradient, [1.0]);
        assert_eq!(x.powi(2).gradient, [0.0]);
    }
}
