//! Words and numbers of an mdpa file, from its bytes.

/// The words of a file, comments removed, with the line each begins at.
pub(super) struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Line of the next byte, from 1.
    pub(super) line: u32,
    /// Line of a `/*` that is never closed.
    pub(super) open_comment: Option<u32>,
}

/// Powers of ten that are exact in a double.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// A number read from a word, and whether the word held more than the number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number<T> {
    pub(super) value: T,
    pub(super) whole: bool,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self { bytes, at: 0, line: 1, open_comment: None }
    }

    fn byte(&self, at: usize) -> u8 {
        self.bytes.get(at).copied().unwrap_or(b' ')
    }

    /// Moves to the next byte of a word and gives it; `None` at the end of the file.
    pub(super) fn skip(&mut self) -> Option<u8> {
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte <= b' ' {
                self.line += u32::from(byte == b'\n');
                self.at += 1;
            } else if byte == b'/' && matches!(self.byte(self.at + 1), b'/' | b'*') {
                self.skip_comment();
            } else {
                return Some(byte);
            }
        }
        None
    }

    fn skip_comment(&mut self) {
        let rest = &self.bytes[self.at + 2..];
        if self.byte(self.at + 1) == b'/' {
            self.at += 2 + rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
            return;
        }
        let length = rest.windows(2).position(|two| two == b"*/").map(|p| p + 2);
        if length.is_none() {
            self.open_comment.get_or_insert(self.line);
        }
        let body = &rest[..length.unwrap_or(rest.len())];
        self.line += body.iter().filter(|&&b| b == b'\n').count() as u32;
        self.at += 2 + body.len();
    }

    /// The end of the word that begins here; `delimiters` end it too.
    fn word_end(&self, delimiters: &[u8]) -> usize {
        let mut end = self.at;
        while let Some(&byte) = self.bytes.get(end) {
            let comment = byte == b'/' && matches!(self.byte(end + 1), b'/' | b'*');
            if byte <= b' ' || comment || delimiters.contains(&byte) {
                break;
            }
            end += 1;
        }
        end
    }

    /// The next word without moving past it.
    pub(super) fn peek(&mut self) -> Option<&'a [u8]> {
        self.skip()?;
        Some(&self.bytes[self.at..self.word_end(b"")])
    }

    /// The next word.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        let word = self.peek()?;
        self.at += word.len();
        Some(word)
    }

    /// The next word when it stands on the current line.
    pub(super) fn word_on_line(&mut self) -> Option<&'a [u8]> {
        let (at, line) = (self.at, self.line);
        if self.skip().is_some() && self.line == line {
            return self.word();
        }
        (self.at, self.line) = (at, line);
        None
    }

    /// Moves to the end of the current line.
    pub(super) fn skip_line(&mut self) {
        let line = self.line;
        while self.line == line && self.skip().is_some() {
            if self.line == line {
                self.at = self.word_end(b"").max(self.at + 1);
            }
        }
    }

    /// Moves past `wanted` when it is the next byte of a word.
    pub(super) fn punctuation(&mut self, wanted: u8) -> bool {
        let found = self.skip() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    /// The next word as an unsigned integer; the word stays when it does not begin with one.
    pub(super) fn integer(&mut self) -> Option<Number<u32>> {
        self.skip()?;
        let (mut value, mut end) = (0_u64, self.at);
        while let digit @ 0..=9 = self.byte(end).wrapping_sub(b'0') {
            value = value.saturating_mul(10).saturating_add(u64::from(digit));
            end += 1;
        }
        if end == self.at {
            return None;
        }
        let value = u32::try_from(value).ok()?;
        let whole = self.byte(end) <= b' ' || end == self.word_end(b",)]");
        self.at = if whole { end } else { self.word_end(b",)]") };
        Some(Number { value, whole })
    }

    /// The next word as a number; the word stays when it does not begin with one.
    pub(super) fn number(&mut self) -> Option<Number<f64>> {
        self.skip()?;
        let (value, length) = parse_prefix(&self.bytes[self.at..])?;
        let end = self.at + length;
        let whole = self.byte(end) <= b' ' || end == self.word_end(b",)]");
        self.at = if whole { end } else { self.word_end(b",)]") };
        Some(Number { value, whole })
    }
}

/// The number `text` begins with, as stream extraction in C++ reads it: `1.0D0` is 1.0, `abc` is none.
pub fn number_prefix(text: &str) -> Option<f64> {
    parse_prefix(text.as_bytes()).map(|(value, _)| value)
}

/// The longest number `bytes` begin with and its length in bytes.
pub(super) fn parse_prefix(bytes: &[u8]) -> Option<(f64, usize)> {
    let get = |i: usize| bytes.get(i).copied().unwrap_or(b' ');
    let negative = get(0) == b'-';
    let mut at = usize::from(negative || get(0) == b'+');
    let (mut mantissa, mut exponent, mut digits) = (0_u64, 0_i32, 0_usize);
    let first = at;
    while let digit @ 0..=9 = get(at).wrapping_sub(b'0') {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    digits += at - first;
    if get(at) == b'.' {
        let point = at;
        at += 1;
        while let digit @ 0..=9 = get(at).wrapping_sub(b'0') {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            at += 1;
        }
        digits += at - point - 1;
        exponent -= (at - point - 1) as i32;
    }
    if digits == 0 {
        return None;
    }
    if matches!(get(at), b'e' | b'E') {
        let sign = at + 1 + usize::from(matches!(get(at + 1), b'+' | b'-'));
        let mut end = sign;
        let mut power = 0_i32;
        while let digit @ 0..=9 = get(end).wrapping_sub(b'0') {
            power = power.saturating_mul(10).saturating_add(i32::from(digit));
            end += 1;
        }
        if end > sign {
            exponent = exponent.saturating_add(if get(at + 1) == b'-' { -power } else { power });
            at = end;
        }
    }
    // Clinger's fast path: both factors are exact doubles, so one rounding gives the nearest double.
    let value = if digits <= 19 && mantissa <= 1 << 53 && exponent.unsigned_abs() <= 22 {
        let power = EXACT_POWERS[exponent.unsigned_abs() as usize];
        let value = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
        if negative { -value } else { value }
    } else {
        std::str::from_utf8(&bytes[..at]).ok()?.parse().ok()?
    };
    Some((value, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_nearest_doubles() {
        for text in [
            "0",
            "-0.0",
            "1",
            "+2.5",
            ".5",
            "5.",
            "1e3",
            "1E-3",
            "0.1",
            "123456789012345678",
            "0.30000000000000004",
            "1.7976931348623157e308",
            "4.9e-324",
            "2.2250738585072011e-308",
            "9007199254740993",
            "1e23",
            "1e-400",
            "8.5e+22",
            "3.141592653589793238462643383279",
        ] {
            let (value, length) = parse_prefix(text.as_bytes()).unwrap();
            let wanted: f64 = text.parse().unwrap();
            assert_eq!((value.to_bits(), length), (wanted.to_bits(), text.len()), "{text}");
        }
    }

    #[test]
    fn a_number_is_the_beginning_of_its_word() {
        assert_eq!(number_prefix("1.0D0"), Some(1.0));
        assert_eq!(number_prefix("2e"), Some(2.0));
        assert_eq!(number_prefix("abc"), None);
        assert_eq!(number_prefix("-."), None);
        let mut tokens = Tokens::new(b"2.0 1.0D5 7//x\n8/*\n*/9");
        assert_eq!(tokens.integer(), Some(Number { value: 2, whole: false }));
        assert_eq!(tokens.number(), Some(Number { value: 1.0, whole: false }));
        assert_eq!(tokens.integer(), Some(Number { value: 7, whole: true }));
        assert_eq!(tokens.integer(), Some(Number { value: 8, whole: true }));
        assert_eq!((tokens.skip(), tokens.line), (Some(b'9'), 3));
    }
}
