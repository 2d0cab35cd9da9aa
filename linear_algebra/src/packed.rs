//! Values as bytes: the form of saved runs and of values that ranks send each other.
//!
//! The form is that of [postcard](https://postcard.jamesmunns.com): numbers keep their bits, and nothing says which number or field
//! stands where, so that bytes are read as the type that they were written as. All fields of a type must therefore be written: it
//! has no `skip_serializing_if`, `flatten`, `untagged` or `tag`. No list holds values that take no bytes, since nothing would bound
//! how many a forged file says there are.
//!
//! [`Writer`] and [`Reader`] are one type each, so serde's code for a type is compiled once. A state behind a trait object is bytes
//! to the outside ([`stored_as_bytes`](crate::stored_as_bytes)): its fields are read by [`Reader`], too, and not through a table of
//! functions for each.

use std::cell::Cell;
use std::fmt;

use postcard::{de_flavors, ser_flavors};
use serde::de::{self, DeserializeOwned, Visitor};
use serde::{Deserializer, Serialize};

/// States within states that are read at most; a forged file must not use up the stack.
const DEEPEST: usize = 32;

thread_local! {
    /// States that the one under way is within.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
}

/// Writes a value.
pub type Writer<'a> = postcard::Serializer<ser_flavors::io::WriteFlavor<&'a mut Vec<u8>>>;

/// Reads a value.
pub type Reader<'b> = postcard::Deserializer<'b, de_flavors::Slice<'b>>;

/// Why a value cannot be written or read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A value says that it cannot be written.
    #[error("a value cannot be written: {0}")]
    Writing(postcard::Error),
    /// The bytes end before the value does.
    #[error("it ends too early")]
    EndsEarly,
    /// The bytes are those of another value.
    #[error("a value in it is none that is known here")]
    Unknown,
    /// The value ends before the bytes do.
    #[error("{0} bytes are left")]
    Left(usize),
    /// More states within states than there are in any run.
    #[error("values stand too deep within others")]
    TooDeep,
}

type Result<T, E = Error> = std::result::Result<T, E>;

/// Appends a value to bytes.
///
/// # Errors
/// A value that says it cannot be written.
pub fn append<T: Serialize + ?Sized>(value: &T, bytes: &mut Vec<u8>) -> Result<()> {
    append_with(bytes, |writer| value.serialize(writer))
}

/// A value as bytes.
///
/// # Errors
/// As [`append`].
pub fn to_bytes<T: Serialize + ?Sized>(value: &T) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    append(value, &mut bytes)?;
    Ok(bytes)
}

/// The value that is all of these bytes.
///
/// # Errors
/// Bytes of another value.
pub fn from_bytes<T: DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    read_with(bytes, |reader| T::deserialize(reader))
}

/// Appends the output of `write`.
///
/// # Errors
/// As [`append`].
pub fn append_with(bytes: &mut Vec<u8>, write: impl FnOnce(&mut Writer<'_>) -> postcard::Result<()>) -> Result<()> {
    write(&mut Writer { output: ser_flavors::io::WriteFlavor::new(bytes) }).map_err(Error::Writing)
}

/// The value that `read` makes of all of these bytes.
///
/// # Errors
/// As [`from_bytes`].
pub fn read_with<T>(bytes: &[u8], read: impl FnOnce(&mut Reader<'_>) -> postcard::Result<T>) -> Result<T> {
    let mut reader = Reader::from_bytes(bytes);
    let value = read(&mut reader).map_err(unread)?;
    match reader.finalize().map_err(unread)? {
        [] => Ok(value),
        left => Err(Error::Left(left.len())),
    }
}

/// Postcard does not keep the messages of a type that rejects its bytes.
fn unread(error: postcard::Error) -> Error {
    if error == postcard::Error::DeserializeUnexpectedEnd { Error::EndsEarly } else { Error::Unknown }
}

/// Serde's traits for a type with the attribute `#[serde(remote = "Self")]`: to the outside it is bytes.
#[macro_export]
macro_rules! stored_as_bytes {
    ($type:ty) => {
        impl ::serde::Serialize for $type {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let mut bytes = Vec::new();
                let written = $crate::packed::append_with(&mut bytes, |writer| <$type>::serialize(self, writer));
                written.map_err(::serde::ser::Error::custom)?;
                serializer.serialize_bytes(&bytes)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $type {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let bytes = $crate::packed::Bytes::read(deserializer)?;
                bytes.value(|reader| <$type>::deserialize(reader)).map_err(::serde::de::Error::custom)
            }
        }
    };
}

/// Bytes that a value within another has been written as.
#[derive(Debug)]
pub struct Bytes(Vec<u8>);

impl Bytes {
    /// Reads bytes from any form.
    ///
    /// # Errors
    /// Where it has something else.
    pub fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_byte_buf(AnyBytes).map(Self)
    }

    /// The value that `read` makes of all of them.
    ///
    /// # Errors
    /// As [`from_bytes`]; values too deep within others.
    pub fn value<T>(&self, read: impl FnOnce(&mut Reader<'_>) -> postcard::Result<T>) -> Result<T> {
        let depth = DEPTH.get();
        if depth >= DEEPEST {
            return Err(Error::TooDeep);
        }
        DEPTH.set(depth + 1);
        let value = read_with(&self.0, read);
        DEPTH.set(depth);
        value
    }
}

struct AnyBytes;

impl Visitor<'_> for AnyBytes {
    type Value = Vec<u8>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("bytes")
    }

    fn visit_bytes<E: de::Error>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
        Ok(bytes.to_vec())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde::Deserialize;

    use super::*;
    use crate::{State, StateMapper};

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    enum Kind {
        Plain,
        One(i32),
        Two(u8, String),
        Named { values: Vec<f32>, inner: Option<Box<Whole>> },
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Whole {
        kinds: Vec<Kind>,
        missing: Option<u64>,
        numbers: [f64; 3],
        names: BTreeMap<String, (i64, bool, char)>,
        last: u16,
    }

    /// A state that is bytes to the outside, and may hold others.
    #[derive(Serialize, Deserialize)]
    #[serde(remote = "Self")]
    struct Outer {
        number: f64,
        inner: Vec<Option<Box<dyn State>>>,
    }

    stored_as_bytes!(Outer);

    #[typetag::serde(name = "outer of packed")]
    impl State for Outer {
        fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
    }

    /// A state that is read through a table of functions.
    #[derive(Serialize, Deserialize)]
    struct Plain {
        whole: Whole,
    }

    #[typetag::serde(name = "plain of packed")]
    impl State for Plain {
        fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
    }

    fn whole(depth: usize) -> Whole {
        let inner = depth.checked_sub(1).map(|depth| Box::new(whole(depth)));
        let kinds = vec![
            Kind::Plain,
            Kind::One(-7),
            Kind::Two(255, "ä".to_owned()),
            Kind::Named { values: vec![0.1, -0.0], inner },
        ];
        let names = [("a", i64::MIN), ("b", i64::MAX), ("c", -1)];
        let names = names.into_iter().map(|(name, number)| (name.to_owned(), (number, number < 0, '√'))).collect();
        Whole { kinds, missing: None, numbers: [5e-324, f64::MAX, -0.1], names, last: 300 }
    }

    fn kept<T: Serialize + DeserializeOwned + PartialEq + fmt::Debug>(value: T) {
        assert_eq!(from_bytes::<T>(&to_bytes(&value).unwrap()).unwrap(), value);
    }

    /// A state within so many others.
    fn within(others: usize) -> Box<dyn State> {
        let plain: Box<dyn State> = Box::new(Plain { whole: whole(1) });
        (0..others).fold(plain, |inner, at| Box::new(Outer { number: at as f64, inner: vec![None, Some(inner)] }))
    }

    #[test]
    fn values_are_read_as_they_were_written() {
        kept(whole(2));
        kept(Whole { missing: Some(u64::MAX), ..whole(0) });
        kept([0, 1, 127, 128, u64::MAX]);
        kept((Some(1_u16), None::<u8>, String::new(), Vec::<f64>::new()));
        kept([0, -1, -32, -33, -128, -129, -32769, i64::MIN, 70_000, i64::MAX]);
        kept(vec!["x".repeat(31), "y".repeat(32), "z".repeat(300), "ä".repeat(70_000)]);
        let bits = [0.1, -0.0, f64::INFINITY, f64::NAN, -f64::NAN];
        let read: Vec<f64> = from_bytes(&to_bytes(&bits.to_vec()).unwrap()).unwrap();
        assert_eq!(bits.map(f64::to_bits).to_vec(), read.into_iter().map(f64::to_bits).collect::<Vec<_>>());
    }

    #[test]
    fn values_stand_one_after_the_other() {
        let mut bytes = to_bytes(&1.5).unwrap();
        append("two", &mut bytes).unwrap();
        assert_eq!(from_bytes::<(f64, String)>(&bytes).unwrap(), (1.5, "two".to_owned()));
    }

    #[test]
    fn states_are_read_as_they_were_written() {
        let mut state: Box<dyn State> = from_bytes(&to_bytes(&within(3)).unwrap()).unwrap();
        for at in [2.0, 1.0, 0.0] {
            let mut outer: Outer = state.take().unwrap();
            assert_eq!((outer.number, outer.inner.len(), outer.inner[0].is_none()), (at, 2, true));
            state = outer.inner.pop().flatten().expect("a state");
        }
        assert_eq!(state.take::<Plain>().unwrap().whole, whole(1));
    }

    #[test]
    fn bytes_of_something_else_are_refused() {
        let bytes = to_bytes(&whole(1)).unwrap();
        for length in 0..bytes.len() {
            assert!(from_bytes::<Whole>(&bytes[..length]).is_err(), "{length}");
        }
        let more = [&bytes[..], &[0]].concat();
        assert_eq!(from_bytes::<Whole>(&more).unwrap_err().to_string(), "1 bytes are left");
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut forged = bytes.clone();
                forged[at] ^= 1 << bit;
                let _ = from_bytes::<Whole>(&forged);
            }
        }
        for length in [u64::from(u32::MAX), u64::MAX] {
            let length = to_bytes(&length).unwrap();
            assert_eq!(from_bytes::<Vec<f64>>(&length).unwrap_err(), Error::EndsEarly);
            assert_eq!(from_bytes::<String>(&length).unwrap_err(), Error::EndsEarly);
            assert_eq!(from_bytes::<BTreeMap<u64, u64>>(&length).unwrap_err(), Error::EndsEarly);
        }
        assert_eq!(from_bytes::<Kind>(&[4]).unwrap_err(), Error::Unknown);
    }

    #[test]
    fn forged_states_are_refused() {
        let refused = |bytes: &[u8]| from_bytes::<Box<dyn State>>(bytes).err();
        let bytes = to_bytes(&within(2)).unwrap();
        assert!((0..bytes.len()).all(|length| refused(&bytes[..length]).is_some()));
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut forged = bytes.clone();
                forged[at] ^= 1 << bit;
                refused(&forged);
            }
        }
        let mut renamed = bytes.clone();
        renamed[2] = b'a';
        assert_eq!(refused(&renamed), Some(Error::Unknown));
        assert_eq!(refused(&to_bytes(&within(DEEPEST)).unwrap()), None);
        assert_eq!(refused(&to_bytes(&within(DEEPEST + 1)).unwrap()), Some(Error::Unknown));
        assert_eq!(refused(&to_bytes(&within(1)).unwrap()), None, "the depth is that of one value");
        let within_name = |bytes: Vec<u8>| to_bytes(&BTreeMap::from([("outer of packed", bytes)])).unwrap();
        let empty = to_bytes(&(1.5, Vec::<u8>::new())).unwrap();
        assert_eq!(refused(&within_name(empty.clone())), None);
        assert_eq!(
            refused(&within_name([empty, vec![0]].concat())),
            Some(Error::Unknown),
            "a byte that no field takes"
        );
    }
}
