//! Saved runs that no program has written: numbers, texts and lists changed here and there, the lengths of the states around them put
//! right.
//!
//! Nothing in the file marks the meaning of a byte. States are found by their tags, and lists by a number that may be the count of
//! their items.

/// The contents of a saved run, or of a state.
#[derive(Clone)]
pub struct Contents(Vec<Part>);

#[derive(Clone)]
enum Part {
    /// Bytes that stand for themselves.
    Plain(Vec<u8>),
    /// The bytes of a state, without their length.
    State(Contents),
}

/// Tags of states whose fields follow without a length.
const WITHOUT_LENGTH: [&str; 6] =
    ["contact", "mesh_tying", "mpc_contact", "simple_mortar_mapper", "constraints", "iterate_output"];
/// Single bytes that are rarely right.
const ODD_BYTES: [u8; 6] = [0, 1, 2, 0x7f, 0x80, 0xff];
/// Numbers that are rarely right.
const ODD: [f64; 7] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5e-324];
/// Bytes of an item of a list: small whole numbers, texts and pairs of them, numbers, points.
const WIDTHS: [usize; 6] = [1, 1, 2, 8, 8, 24];

impl Contents {
    /// The contents that are these bytes.
    pub fn read(bytes: &[u8]) -> Self {
        let (mut parts, mut from, mut at) = (Vec::new(), 0, 0);
        while at < bytes.len() {
            let Some((start, end)) = state(bytes, at) else {
                at += 1;
                continue;
            };
            let length = varint(end - start).len();
            parts.push(Part::Plain(bytes[from..start - length].to_vec()));
            parts.push(Part::State(Self::read(&bytes[start..end])));
            (from, at) = (end, end);
        }
        parts.push(Part::Plain(bytes[from..].to_vec()));
        Self(parts)
    }

    /// The contents as bytes.
    pub fn write(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for part in &self.0 {
            match part {
                Part::Plain(bytes) => out.extend(bytes),
                Part::State(state) => {
                    let bytes = state.write();
                    out.extend(varint(bytes.len()));
                    out.extend(bytes);
                }
            }
        }
        out
    }

    /// Changes one value, which `dice` choose.
    pub fn forge(&mut self, dice: &mut impl FnMut() -> usize) {
        let at = dice() % self.0.len();
        match &mut self.0[at] {
            Part::State(state) => state.forge(dice),
            Part::Plain(bytes) if bytes.is_empty() => {}
            Part::Plain(bytes) => {
                let (at, which) = (dice() % bytes.len(), dice());
                match dice() % 4 {
                    0 => bytes[at] = bytes[at].wrapping_add(1),
                    1 => bytes[at] = ODD_BYTES[which % ODD_BYTES.len()],
                    2 => {
                        let found = (at..bytes.len()).find(|&at| bytes.get(at..at + 8).is_some_and(is_number));
                        if let Some(at) = found {
                            bytes[at..at + 8].copy_from_slice(&ODD[which % ODD.len()].to_le_bytes());
                        }
                    }
                    _ => change_list(bytes, at, dice),
                }
            }
        }
    }
}

/// Takes items from the first list at or after a place, or gives it more.
fn change_list(bytes: &mut Vec<u8>, from: usize, dice: &mut impl FnMut() -> usize) {
    let (width, which, how) = (WIDTHS[dice() % WIDTHS.len()], dice(), dice());
    let list = |at: usize| {
        let (count, start) = number(bytes, at)?;
        let items = bytes.get(start..start.checked_add(count.checked_mul(width)?)?)?;
        let fits = match width {
            1 | 2 => items.iter().all(|&byte| byte < 0x80),
            _ => items.chunks(8).all(is_number),
        };
        (fits && count > 0).then_some((at, start, count))
    };
    let Some((at, start, count)) = (from..bytes.len()).find_map(list) else { return };
    let item = start + which % count * width;
    let count = match how % 3 {
        0 => {
            bytes.drain(item..item + width);
            count - 1
        }
        1 => {
            let copy = bytes[item..item + width].to_vec();
            bytes.splice(item..item, copy);
            count + 1
        }
        _ => {
            bytes.drain(item..start + count * width);
            which % count
        }
    };
    bytes.splice(at..start, varint(count));
}

/// Whether eight bytes may be a number of a run.
fn is_number(bytes: &[u8]) -> bool {
    let value = bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
    value == 0.0 || (1e-30..1e30).contains(&value.abs())
}

/// Where the bytes of a state begin and end whose tag stands at a place: a map of one name.
fn state(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let [1, length, rest @ ..] = &bytes[at..] else { return None };
    let tag = rest.get(..usize::from(*length)).filter(|tag| tag.len() > 2)?;
    let is_tag = tag.iter().all(|byte| matches!(byte, b'a'..=b'z' | b'0'..=b'9' | b'_'));
    if !is_tag || WITHOUT_LENGTH.iter().any(|other| other.as_bytes() == tag) {
        return None;
    }
    let (length, start) = number(bytes, at + 2 + tag.len())?;
    let end = start.checked_add(length)?;
    (end <= bytes.len()).then_some((start, end))
}

/// The whole number at a place, as it is written, and where it ends.
fn number(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let last = bytes.get(at..)?.iter().take(5).position(|byte| *byte < 0x80)?;
    let own = &bytes[at..=at + last];
    let value = own.iter().rev().fold(0, |sum, byte| sum << 7 | usize::from(byte & 0x7f));
    (varint(value) == own).then_some((value, at + last + 1))
}

/// A whole number: seven bits a byte, the lowest first.
fn varint(mut value: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// Bytes of a saved run of one process before the length of its contents: mark, version, number of processes.
const MARK: usize = 16 + 4 + 4;

/// A saved run of one process with other contents: their length and checksum are right.
pub fn with_contents(saved: &[u8], contents: &[u8]) -> Vec<u8> {
    let (length, sum) = ((contents.len() as u64).to_le_bytes(), crc32fast::hash(contents).to_le_bytes());
    [&saved[..MARK], &length, &sum, contents].concat()
}

/// The contents of a saved run of one process.
pub fn contents(saved: &[u8]) -> &[u8] {
    &saved[MARK + 12..]
}
