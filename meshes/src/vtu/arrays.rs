//! The numbers of an array, however they are written.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::xml::{File, Tag};

/// Most bytes of an array: damaged lengths must not fill the memory.
const MOST: u64 = 1 << 34;

/// The numbers of an array.
pub(super) enum Array {
    Real(Vec<f64>),
    Whole(Vec<i64>),
}

impl Array {
    /// Reads the array of a tag.
    pub(super) fn read(file: &File<'_>, tag: &Tag<'_>) -> Result<Self, String> {
        let name = tag.get("Name").unwrap_or("without name");
        let kind = tag.get("type").ok_or_else(|| format!("the array {name} has no type"))?;
        let damaged = || format!("the array {name} is damaged");
        match tag.get("format").unwrap_or("ascii") {
            "ascii" => {
                let words = tag.text.split_whitespace();
                if kind.starts_with("Float") {
                    words.map(|word| word.parse().ok()).collect::<Option<_>>().map(Array::Real).ok_or_else(damaged)
                } else {
                    words.map(|word| word.parse().ok()).collect::<Option<_>>().map(Array::Whole).ok_or_else(damaged)
                }
            }
            "binary" => {
                let bytes = base64(tag.text.as_bytes());
                content(&bytes, file).and_then(|bytes| numbers(kind, &bytes)).ok_or_else(damaged)
            }
            "appended" => {
                let offset: usize = tag.get("offset").and_then(|text| text.parse().ok()).ok_or_else(damaged)?;
                let data = file.appended.0.get(offset..).ok_or_else(damaged)?;
                let bytes = if file.appended.1 { content(&base64(data), file) } else { content(data, file) };
                bytes.and_then(|bytes| numbers(kind, &bytes)).ok_or_else(damaged)
            }
            other => Err(format!("the array {name} is written as {other:?}, which is not known")),
        }
    }

    /// As real numbers.
    pub(super) fn real(self) -> Vec<f64> {
        match self {
            Self::Real(values) => values,
            Self::Whole(values) => values.into_iter().map(|value| value as f64).collect(),
        }
    }

    /// As whole numbers.
    pub(super) fn whole(self) -> Result<Vec<i64>, String> {
        match self {
            Self::Whole(values) => Ok(values),
            Self::Real(_) => Err("whole numbers are written as real ones".to_owned()),
        }
    }
}

/// Bytes of text in base 64; whatever ends with `=` may be followed by more. Ends where the text does.
fn base64(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let (mut bits, mut count, mut padding) = (0_u32, 0, 0);
    for &byte in text {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => {
                padding += 1;
                0
            }
            byte if byte.is_ascii_whitespace() => continue,
            _ => break,
        };
        bits = bits << 6 | u32::from(value);
        count += 1;
        if count == 4 {
            out.extend(&bits.to_be_bytes()[1..4 - padding.min(2)]);
            (bits, count, padding) = (0, 0, 0);
        }
    }
    out
}

/// Contents of an array: its length and its bytes, or the number of its blocks, their sizes and the compressed blocks.
fn content(data: &[u8], file: &File<'_>) -> Option<Vec<u8>> {
    let number = |at: usize| -> Option<usize> {
        let bytes = data.get(at.checked_mul(file.header)?..at.checked_add(1)?.checked_mul(file.header)?)?;
        let mut whole = [0; 8];
        whole[..file.header].copy_from_slice(bytes);
        usize::try_from(u64::from_le_bytes(whole)).ok()
    };
    if !file.is_compressed {
        return data.get(file.header..file.header.checked_add(number(0)?)?).map(<[u8]>::to_vec);
    }
    let blocks = number(0)?;
    let mut start = blocks.checked_add(3)?.checked_mul(file.header).filter(|&start| start <= data.len())?;
    let mut out = Vec::new();
    for block in 0..blocks {
        let end = start.checked_add(number(3 + block)?)?;
        ZlibDecoder::new(data.get(start..end)?).take(MOST - out.len() as u64).read_to_end(&mut out).ok()?;
        start = end;
    }
    Some(out)
}

fn numbers(kind: &str, bytes: &[u8]) -> Option<Array> {
    fn of<const N: usize, T, U>(bytes: &[u8], read: fn([u8; N]) -> T, make: fn(T) -> U) -> Vec<U> {
        bytes.as_chunks::<N>().0.iter().map(|chunk| make(read(*chunk))).collect()
    }
    Some(match kind {
        "Float64" => Array::Real(of(bytes, f64::from_le_bytes, |x| x)),
        "Float32" => Array::Real(of(bytes, f32::from_le_bytes, f64::from)),
        "Int64" => Array::Whole(of(bytes, i64::from_le_bytes, |x| x)),
        "UInt64" => Array::Whole(of(bytes, u64::from_le_bytes, |x| i64::try_from(x).unwrap_or(-1))),
        "Int32" => Array::Whole(of(bytes, i32::from_le_bytes, i64::from)),
        "UInt32" => Array::Whole(of(bytes, u32::from_le_bytes, i64::from)),
        "Int16" => Array::Whole(of(bytes, i16::from_le_bytes, i64::from)),
        "UInt16" => Array::Whole(of(bytes, u16::from_le_bytes, i64::from)),
        "Int8" => Array::Whole(of(bytes, i8::from_le_bytes, i64::from)),
        "UInt8" => Array::Whole(of(bytes, u8::from_le_bytes, i64::from)),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn text_in_base_64_is_read_beyond_its_padding() {
        assert_eq!(base64(b"AQ==AgM=BAUG"), [1, 2, 3, 4, 5, 6]);
    }
}
