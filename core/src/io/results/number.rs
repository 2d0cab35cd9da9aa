//! Numbers as result files spell them.

use std::io::{self, Write};

/// Writes `value` with `precision` decimals and an exponent of at least two digits, as C does: `1.5000000e+00`.
pub(super) fn scientific(out: &mut impl Write, value: f64, precision: usize) -> io::Result<()> {
    if !value.is_finite() {
        return write!(
            out,
            "{}",
            if value.is_nan() {
                "nan"
            } else if value > 0.0 {
                "inf"
            } else {
                "-inf"
            }
        );
    }
    let mut buffer = [0_u8; 64];
    let mut rest = &mut buffer[..];
    let precision = precision.min(40);
    write!(rest, "{value:.precision$e}")?;
    let used = 64 - rest.len();
    let text = &buffer[..used];
    let at = text.iter().rposition(|&b| b == b'e').unwrap_or(used);
    let (sign, digits) = match text.get(at + 1) {
        Some(b'-') => (b'-', &text[at + 2..]),
        _ => (b'+', &text[(at + 1).min(used)..]),
    };
    out.write_all(&text[..at])?;
    out.write_all(&[b'e', sign])?;
    if digits.len() < 2 {
        out.write_all(b"0")?;
    }
    out.write_all(digits)
}
