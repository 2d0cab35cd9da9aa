//! The functions and constants an expression may name.

/// A function by its number of arguments.
#[derive(Debug, Clone, Copy)]
pub(super) enum Function {
    /// One argument.
    One(fn(f64) -> f64),
    /// Two arguments.
    Two(fn(f64, f64) -> f64),
}

/// Every function by name; `log` is decadic.
pub(super) const FUNCTIONS: [(&str, Function); 22] = [
    ("abs", Function::One(f64::abs)),
    ("acos", Function::One(f64::acos)),
    ("asin", Function::One(f64::asin)),
    ("atan", Function::One(f64::atan)),
    ("atan2", Function::Two(f64::atan2)),
    ("ceil", Function::One(f64::ceil)),
    ("cos", Function::One(f64::cos)),
    ("cosh", Function::One(f64::cosh)),
    ("exp", Function::One(f64::exp)),
    ("fac", Function::One(factorial)),
    ("floor", Function::One(f64::floor)),
    ("ln", Function::One(f64::ln)),
    ("log", Function::One(f64::log10)),
    ("log10", Function::One(f64::log10)),
    ("ncr", Function::Two(combinations)),
    ("npr", Function::Two(permutations)),
    ("pow", Function::Two(f64::powf)),
    ("sin", Function::One(f64::sin)),
    ("sinh", Function::One(f64::sinh)),
    ("sqrt", Function::One(f64::sqrt)),
    ("tan", Function::One(f64::tan)),
    ("tanh", Function::One(f64::tanh)),
];

/// Every constant by name.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("e", std::f64::consts::E), ("pi", std::f64::consts::PI)];

/// The largest argument that is counted up to; beyond it the result is infinite.
const COUNTABLE: f64 = u32::MAX as f64;

/// n!, of the whole part of `n`; NaN below 0, infinite when it exceeds 64 bits.
fn factorial(n: f64) -> f64 {
    if n.is_nan() || n < 0.0 {
        return f64::NAN;
    }
    if n > COUNTABLE {
        return f64::INFINITY;
    }
    let product = (1..=n as u64).try_fold(1_u64, u64::checked_mul);
    product.map_or(f64::INFINITY, |p| p as f64)
}

/// The number of ways to choose `r` of `n`; NaN outside 0 ≤ r ≤ n, infinite when it exceeds 64 bits.
fn combinations(n: f64, r: f64) -> f64 {
    if n.is_nan() || r.is_nan() || n < 0.0 || r < 0.0 || n < r {
        return f64::NAN;
    }
    if n > COUNTABLE || r > COUNTABLE {
        return f64::INFINITY;
    }
    let (n, r) = (n as u64, r as u64);
    let r = r.min(n - r);
    let product = (1..=r).try_fold(1_u64, |result, i| Some(result.checked_mul(n - r + i)? / i));
    product.map_or(f64::INFINITY, |p| p as f64)
}

/// The number of ordered ways to choose `r` of `n`.
fn permutations(n: f64, r: f64) -> f64 {
    combinations(n, r) * factorial(r)
}
