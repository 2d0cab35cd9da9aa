//! Saved runs that no program has written: MessagePack taken apart, changed here and there, and put together again.

/// A value of MessagePack.
#[derive(Clone)]
pub enum Value {
    /// Bytes that stand for themselves: numbers, truth values, nothing.
    Plain(Vec<u8>),
    /// Text or bytes, without their length.
    Long(bool, Vec<u8>),
    /// Bytes that are a value of their own, as states are.
    Inner(Box<Value>),
    /// A list.
    Array(Vec<Value>),
    /// Keys and values, one after the other.
    Map(Vec<Value>),
}

/// Numbers that are rarely right, as MessagePack has them.
const ODD: [&[u8]; 12] = [
    &[0],
    &[1],
    &[0xff],
    &[0xcc, 0xff],
    &[0xcd, 0xff, 0xff],
    &[0xce, 0xff, 0xff, 0xff, 0xff],
    &[0xcf, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff],
    &[0xcb, 0x7f, 0xf8, 0, 0, 0, 0, 0, 0],
    &[0xcb, 0x7f, 0xf0, 0, 0, 0, 0, 0, 0],
    &[0xcb, 0xff, 0xe0, 0, 0, 0, 0, 0, 0],
    &[0xc0],
    &[0xc3],
];

impl Value {
    /// The value that `bytes` begin with; `None` where they are no MessagePack.
    pub fn read(bytes: &mut &[u8]) -> Option<Self> {
        let mark = take(bytes, 1)?[0];
        let plain = |bytes: &mut &[u8], more: usize| Some(Self::Plain([&[mark][..], take(bytes, more)?].concat()));
        match mark {
            0x80..=0x8f => Self::items(bytes, 2 * usize::from(mark & 0xf)).map(Self::Map),
            0x90..=0x9f => Self::items(bytes, usize::from(mark & 0xf)).map(Self::Array),
            0xa0..=0xbf => Some(Self::Long(true, take(bytes, usize::from(mark & 0x1f))?.to_vec())),
            0xc4..=0xc6 | 0xd9..=0xdb => {
                let text = mark > 0xd0;
                let length = length(bytes, 1 << (mark - if text { 0xd9 } else { 0xc4 }))?;
                let own = take(bytes, length)?;
                let mut rest = own;
                let inner = Self::read(&mut rest).filter(|inner| !text && rest.is_empty() && inner.is_list());
                Some(inner.map_or_else(|| Self::Long(text, own.to_vec()), |inner| Self::Inner(Box::new(inner))))
            }
            0xdc | 0xdd => length(bytes, 2 << (mark - 0xdc)).and_then(|n| Self::items(bytes, n)).map(Self::Array),
            0xde | 0xdf => length(bytes, 2 << (mark - 0xde)).and_then(|n| Self::items(bytes, 2 * n)).map(Self::Map),
            0xca | 0xce | 0xd2 => plain(bytes, 4),
            0xcb | 0xcf | 0xd3 => plain(bytes, 8),
            0xcc | 0xd0 => plain(bytes, 1),
            0xcd | 0xd1 => plain(bytes, 2),
            _ => plain(bytes, 0),
        }
    }

    fn is_list(&self) -> bool {
        matches!(self, Self::Array(_) | Self::Map(_))
    }

    fn items(bytes: &mut &[u8], count: usize) -> Option<Vec<Self>> {
        (0..count).map(|_| Self::read(bytes)).collect()
    }

    /// Appends the value to `out`.
    pub fn write(&self, out: &mut Vec<u8>) {
        // As short as the program writes it: where the bytes of entities end is said elsewhere.
        let head = |few: u8, limit: usize, marks: [u8; 3], length: usize, out: &mut Vec<u8>| match length {
            _ if length < limit => out.push(few | length as u8),
            0..=0xff if marks[0] > 0 => out.extend([marks[0], length as u8]),
            0..=0xffff => {
                out.push(marks[1]);
                out.extend((length as u16).to_be_bytes());
            }
            _ => {
                out.push(marks[2]);
                out.extend((length as u32).to_be_bytes());
            }
        };
        let bytes_of = |bytes: &[u8], out: &mut Vec<u8>| {
            head(0, 0, [0xc4, 0xc5, 0xc6], bytes.len(), out);
            out.extend(bytes);
        };
        match self {
            Self::Plain(bytes) => out.extend(bytes),
            Self::Long(true, bytes) => {
                head(0xa0, 32, [0xd9, 0xda, 0xdb], bytes.len(), out);
                out.extend(bytes);
            }
            Self::Long(false, bytes) => bytes_of(bytes, out),
            Self::Inner(value) => {
                let mut bytes = Vec::new();
                value.write(&mut bytes);
                bytes_of(&bytes, out);
            }
            Self::Array(items) => {
                head(0x90, 16, [0, 0xdc, 0xdd], items.len(), out);
                items.iter().for_each(|item| item.write(out));
            }
            Self::Map(items) => {
                head(0x80, 16, [0, 0xde, 0xdf], items.len() / 2, out);
                items.iter().for_each(|item| item.write(out));
            }
        }
    }

    /// The value that `steps` lead to from here: which of those inside, at each list; where that ends early, by itself.
    fn find(&mut self, steps: &mut impl Iterator<Item = usize>) -> &mut Self {
        if let Self::Inner(value) = self {
            return value.find(steps);
        }
        let is_list = matches!(self, Self::Array(items) | Self::Map(items) if !items.is_empty());
        let Some(step) = steps.next().filter(|step| is_list && *step % 8 != 7) else { return self };
        match self {
            // Keys stay: a name that is not known is refused at once.
            Self::Map(items) => {
                let count = items.len() / 2;
                items[2 * (step / 8 % count) + 1].find(steps)
            }
            Self::Array(items) => {
                let count = items.len();
                items[step / 8 % count].find(steps)
            }
            Self::Plain(_) | Self::Long(..) | Self::Inner(_) => self,
        }
    }

    /// Changes one value, which `dice` choose.
    pub fn forge(&mut self, dice: &mut impl FnMut() -> usize) {
        let steps: Vec<usize> = (0..24).map(|_| dice()).collect();
        let (how, which) = (dice(), dice());
        match self.find(&mut steps.into_iter()) {
            Self::Plain(bytes) if how % 4 == 0 && bytes.len() == 1 => bytes[0] = bytes[0].wrapping_add(1),
            Self::Plain(bytes) => *bytes = ODD[which % ODD.len()].to_vec(),
            Self::Long(_, bytes) => bytes.truncate(which % (bytes.len() + 1)),
            Self::Inner(_) => {}
            Self::Map(items) => {
                let at = which % (items.len() / 2).max(1);
                items.drain((2 * at).min(items.len())..(2 * at + 2).min(items.len()));
            }
            Self::Array(items) => {
                let at = which % items.len().max(1);
                match how % 4 {
                    0 if at < items.len() => drop(items.remove(at)),
                    1 if at < items.len() => items.push(items[at].clone()),
                    2 if at + 1 < items.len() => items.swap(at, at + 1),
                    3 => items.truncate(at),
                    _ => {}
                }
            }
        }
    }
}

fn take<'b>(bytes: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (first, rest) = bytes.split_at_checked(count)?;
    *bytes = rest;
    Some(first)
}

fn length(bytes: &mut &[u8], count: usize) -> Option<usize> {
    take(bytes, count).map(|bytes| bytes.iter().fold(0, |sum, &byte| sum << 8 | usize::from(byte)))
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
