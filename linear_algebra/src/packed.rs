//! Values as bytes: the form of saved runs and of values that ranks send each other.
//!
//! The form is [MessagePack](https://github.com/msgpack/msgpack/blob/master/spec.md): structs are maps with the names of fields,
//! variants go by their names, and numbers keep their bits. Fields stand in the order of the struct; one that is skipped is left out.
//!
//! [`Writer`] and [`Reader`] are one type each, so serde's code for a type is compiled once. The reader is told what comes next and
//! accepts nothing else, which is far less code a type than a reader that takes whatever comes. A state behind a trait object is bytes
//! to the outside ([`stored_as_bytes`](crate::stored_as_bytes)): its fields are read by [`Reader`], too, and not through a table of
//! functions for each.

use std::fmt::{self, Display};

use serde::de::{self, DeserializeOwned, DeserializeSeed, IntoDeserializer, Visitor};
use serde::{Deserializer, Serialize, Serializer, ser};

/// Values within values that are read at most; a forged file must not use up the stack.
const DEEPEST: usize = 512;

/// Why a value cannot be written or read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error(String);

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

impl ser::Error for Error {
    fn custom<T: Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

impl de::Error for Error {
    fn custom<T: Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

type Result<T, E = Error> = std::result::Result<T, E>;

/// Appends a value to bytes.
///
/// # Errors
/// A value that says it cannot be written.
pub fn append<T: Serialize + ?Sized>(value: &T, bytes: &mut Vec<u8>) -> Result<()> {
    value.serialize(&mut Writer { bytes })
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
    let mut reader = Reader::new(bytes);
    let value = T::deserialize(&mut reader)?;
    reader.finish()?;
    Ok(value)
}

/// Serde's traits for a type with the attribute `#[serde(remote = "Self")]`: to the outside it is bytes.
#[macro_export]
macro_rules! stored_as_bytes {
    ($type:ty) => {
        impl ::serde::Serialize for $type {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let mut bytes = Vec::new();
                let written = <$type>::serialize(self, &mut $crate::packed::Writer::new(&mut bytes));
                written.map_err(::serde::ser::Error::custom)?;
                serializer.serialize_bytes(&bytes)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $type {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let bytes = $crate::packed::Bytes::read(deserializer)?;
                <$type>::deserialize(&mut $crate::packed::Reader::new(&bytes)).map_err(::serde::de::Error::custom)
            }
        }
    };
}

/// Bytes that a value has been written as.
#[derive(Debug)]
pub struct Bytes;

impl Bytes {
    /// Reads bytes from any form.
    ///
    /// # Errors
    /// Where it has something else.
    pub fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
        deserializer.deserialize_byte_buf(Self)
    }
}

impl<'de> Visitor<'de> for Bytes {
    type Value = Vec<u8>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("bytes")
    }

    fn visit_bytes<E: de::Error>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
        Ok(bytes.to_vec())
    }
}

/// Writes a value.
#[derive(Debug)]
pub struct Writer<'a> {
    bytes: &'a mut Vec<u8>,
}

impl<'a> Writer<'a> {
    /// One that appends to `bytes`.
    pub fn new(bytes: &'a mut Vec<u8>) -> Self {
        Self { bytes }
    }

    fn marked(&mut self, mark: u8, bytes: &[u8]) {
        self.bytes.push(mark);
        self.bytes.extend_from_slice(bytes);
    }

    fn whole(&mut self, value: u64) {
        match value {
            0..0x80 => self.bytes.push(value as u8),
            0x80..0x100 => self.marked(0xcc, &[value as u8]),
            0x100..0x1_0000 => self.marked(0xcd, &(value as u16).to_be_bytes()),
            0x1_0000..0x1_0000_0000 => self.marked(0xce, &(value as u32).to_be_bytes()),
            _ => self.marked(0xcf, &value.to_be_bytes()),
        }
    }

    fn signed(&mut self, value: i64) {
        match value {
            0.. => self.whole(value as u64),
            -0x20..0 => self.bytes.push(value as u8),
            -0x80..-0x20 => self.marked(0xd0, &[value as u8]),
            -0x8000..-0x80 => self.marked(0xd1, &(value as i16).to_be_bytes()),
            -0x8000_0000..-0x8000 => self.marked(0xd2, &(value as i32).to_be_bytes()),
            _ => self.marked(0xd3, &value.to_be_bytes()),
        }
    }

    /// A length: in the mark of `few` where it is below `limit`, else after one of `marks`, for one, two and four bytes.
    fn length(&mut self, length: usize, few: u8, limit: usize, marks: [u8; 3]) -> Result<()> {
        if length < limit {
            self.bytes.push(few | length as u8);
        } else if length < 0x100 && marks[0] > 0 {
            self.marked(marks[0], &[length as u8]);
        } else if length < 0x1_0000 {
            self.marked(marks[1], &(length as u16).to_be_bytes());
        } else {
            let length = u32::try_from(length).map_err(|_| Error(format!("{length} items are too many")))?;
            self.marked(marks[2], &length.to_be_bytes());
        }
        Ok(())
    }

    fn text(&mut self, text: &str) -> Result<()> {
        self.length(text.len(), 0xa0, 32, [0xd9, 0xda, 0xdb])?;
        self.bytes.extend_from_slice(text.as_bytes());
        Ok(())
    }

    /// The beginning of a list or a map: `kind` says which.
    fn begin(&mut self, kind: Kind, length: usize) -> Result<()> {
        match kind {
            Kind::List => self.length(length, 0x90, 16, [0, 0xdc, LIST]),
            Kind::Map => self.length(length, 0x80, 16, [0, 0xde, MAP]),
        }
    }

    /// A map of a name to what follows.
    fn variant(&mut self, name: &str) -> Result<()> {
        self.begin(Kind::Map, 1)?;
        self.text(name)
    }
}

/// Mark of a list whose length has four bytes.
const LIST: u8 = 0xdd;
/// The same of a map.
const MAP: u8 = 0xdf;

#[derive(Debug, Clone, Copy)]
enum Kind {
    List,
    Map,
}

/// Writes the parts of a value, one after the other.
#[derive(Debug)]
pub struct Parts<'w, 'a> {
    writer: &'w mut Writer<'a>,
    /// Where the length stands and the parts so far, where the length is not known before.
    open: Option<(usize, u32)>,
}

impl<'w, 'a> Parts<'w, 'a> {
    fn of(writer: &'w mut Writer<'a>, kind: Kind, length: Option<usize>) -> Result<Self> {
        let open = match length {
            Some(length) => {
                writer.begin(kind, length)?;
                None
            }
            None => {
                writer.marked(if matches!(kind, Kind::List) { LIST } else { MAP }, &[0; 4]);
                Some((writer.bytes.len() - 4, 0))
            }
        };
        Ok(Self { writer, open })
    }

    fn item<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<()> {
        if let Some((_, count)) = &mut self.open {
            *count += 1;
        }
        value.serialize(&mut *self.writer)
    }

    fn close(self) {
        if let Some((at, count)) = self.open {
            self.writer.bytes[at..at + 4].copy_from_slice(&count.to_be_bytes());
        }
    }
}

macro_rules! write_whole {
    ($($name:ident: $type:ty),*) => {
        $(fn $name(self, value: $type) -> Result<()> {
            self.whole(u64::from(value));
            Ok(())
        })*
    };
}

macro_rules! write_signed {
    ($($name:ident: $type:ty),*) => {
        $(fn $name(self, value: $type) -> Result<()> {
            self.signed(i64::from(value));
            Ok(())
        })*
    };
}

impl<'w, 'a> Serializer for &'w mut Writer<'a> {
    type Ok = ();
    type Error = Error;
    type SerializeSeq = Parts<'w, 'a>;
    type SerializeTuple = Parts<'w, 'a>;
    type SerializeTupleStruct = Parts<'w, 'a>;
    type SerializeTupleVariant = Parts<'w, 'a>;
    type SerializeMap = Parts<'w, 'a>;
    type SerializeStruct = Parts<'w, 'a>;
    type SerializeStructVariant = Parts<'w, 'a>;

    write_whole!(serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64);
    write_signed!(serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64);

    fn serialize_bool(self, value: bool) -> Result<()> {
        self.bytes.push(0xc2 | u8::from(value));
        Ok(())
    }

    fn serialize_char(self, value: char) -> Result<()> {
        self.text(value.encode_utf8(&mut [0; 4]))
    }

    fn serialize_f32(self, value: f32) -> Result<()> {
        self.marked(0xca, &value.to_be_bytes());
        Ok(())
    }

    fn serialize_f64(self, value: f64) -> Result<()> {
        self.marked(0xcb, &value.to_be_bytes());
        Ok(())
    }

    fn serialize_str(self, text: &str) -> Result<()> {
        self.text(text)
    }

    fn serialize_bytes(self, bytes: &[u8]) -> Result<()> {
        self.length(bytes.len(), 0, 0, [0xc4, 0xc5, 0xc6])?;
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    fn serialize_none(self) -> Result<()> {
        self.serialize_unit()
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<()> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<()> {
        self.bytes.push(NOTHING);
        Ok(())
    }

    fn serialize_unit_struct(self, _name: &'static str) -> Result<()> {
        self.serialize_unit()
    }

    fn serialize_unit_variant(self, _name: &'static str, _index: u32, variant: &'static str) -> Result<()> {
        self.text(variant)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _name: &'static str, value: &T) -> Result<()> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _name: &'static str,
        _index: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<()> {
        self.variant(variant)?;
        value.serialize(self)
    }

    fn serialize_seq(self, length: Option<usize>) -> Result<Parts<'w, 'a>> {
        Parts::of(self, Kind::List, length)
    }

    fn serialize_tuple(self, length: usize) -> Result<Parts<'w, 'a>> {
        Parts::of(self, Kind::List, Some(length))
    }

    fn serialize_tuple_struct(self, _name: &'static str, length: usize) -> Result<Parts<'w, 'a>> {
        Parts::of(self, Kind::List, Some(length))
    }

    fn serialize_tuple_variant(
        self,
        _name: &'static str,
        _index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<Parts<'w, 'a>> {
        self.variant(variant)?;
        Parts::of(self, Kind::List, Some(length))
    }

    fn serialize_map(self, length: Option<usize>) -> Result<Parts<'w, 'a>> {
        Parts::of(self, Kind::Map, length)
    }

    fn serialize_struct(self, _name: &'static str, length: usize) -> Result<Parts<'w, 'a>> {
        Parts::of(self, Kind::Map, Some(length))
    }

    fn serialize_struct_variant(
        self,
        _name: &'static str,
        _index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<Parts<'w, 'a>> {
        self.variant(variant)?;
        Parts::of(self, Kind::Map, Some(length))
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// The mark of nothing.
const NOTHING: u8 = 0xc0;

macro_rules! write_items {
    ($($trait:ident: $method:ident),*) => {
        $(impl ser::$trait for Parts<'_, '_> {
            type Ok = ();
            type Error = Error;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<()> {
                self.item(value)
            }

            fn end(self) -> Result<()> {
                self.close();
                Ok(())
            }
        })*
    };
}

write_items!(SerializeSeq: serialize_element, SerializeTuple: serialize_element);
write_items!(SerializeTupleStruct: serialize_field, SerializeTupleVariant: serialize_field);

macro_rules! write_fields {
    ($($trait:ident),*) => {
        $(impl ser::$trait for Parts<'_, '_> {
            type Ok = ();
            type Error = Error;

            fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<()> {
                self.writer.text(name)?;
                value.serialize(&mut *self.writer)
            }

            fn end(self) -> Result<()> {
                Ok(())
            }
        })*
    };
}

write_fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for Parts<'_, '_> {
    type Ok = ();
    type Error = Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<()> {
        self.item(key)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<()> {
        value.serialize(&mut *self.writer)
    }

    fn end(self) -> Result<()> {
        self.close();
        Ok(())
    }
}

/// Reads a value.
#[derive(Debug)]
pub struct Reader<'b> {
    rest: &'b [u8],
    /// Values that the one under way is within.
    depth: usize,
}

impl<'b> Reader<'b> {
    /// One that begins with the first of `bytes`.
    pub fn new(bytes: &'b [u8]) -> Self {
        Self { rest: bytes, depth: 0 }
    }

    fn finish(&self) -> Result<()> {
        if self.rest.is_empty() { Ok(()) } else { Err(Error(format!("{} bytes are left", self.rest.len()))) }
    }

    fn take(&mut self, count: usize) -> Result<&'b [u8]> {
        let (now, rest) = self.rest.split_at_checked(count).ok_or_else(ends_early)?;
        self.rest = rest;
        Ok(now)
    }

    fn mark(&mut self) -> Result<u8> {
        Ok(self.take(1)?[0])
    }

    /// A number of so many bytes.
    fn bytes(&mut self, count: usize) -> Result<u64> {
        Ok(self.take(count)?.iter().fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
    }

    fn whole(&mut self) -> Result<u64> {
        match self.mark()? {
            mark @ 0..0x80 => Ok(u64::from(mark)),
            mark @ 0xcc..=0xcf => self.bytes(1 << (mark - 0xcc)),
            mark => Err(unexpected(mark)),
        }
    }

    fn signed(&mut self) -> Result<i64> {
        match self.rest.first().copied().unwrap_or(0) {
            mark @ 0xe0..=0xff => {
                self.mark()?;
                Ok(i64::from(mark as i8))
            }
            mark @ 0xd0..=0xd3 => {
                self.mark()?;
                let bytes = 1 << (mark - 0xd0);
                let unused = 64 - 8 * bytes;
                Ok((self.bytes(bytes)? << unused) as i64 >> unused)
            }
            mark => i64::try_from(self.whole()?).map_err(|_| unexpected(mark)),
        }
    }

    /// A length that has its own mark: in the mark of `few` where it is below `limit`, else after one of `marks`.
    fn length(&mut self, few: u8, limit: u8, marks: [u8; 3]) -> Result<usize> {
        let mark = self.mark()?;
        if (few..few + limit).contains(&mark) {
            return Ok(usize::from(mark - few));
        }
        let bytes = marks.iter().position(|&known| known == mark && known > 0).ok_or_else(|| unexpected(mark))?;
        Ok(self.bytes(1 << bytes)? as usize)
    }

    fn slice(&mut self) -> Result<&'b [u8]> {
        let length = self.length(0, 0, [0xc4, 0xc5, 0xc6])?;
        self.take(length)
    }

    fn text(&mut self) -> Result<&'b str> {
        let length = self.length(0xa0, 32, [0xd9, 0xda, 0xdb])?;
        std::str::from_utf8(self.take(length)?).map_err(|error| Error(error.to_string()))
    }

    /// Begins a list or a map with the number of its items.
    fn begin(&mut self, kind: Kind) -> Result<usize> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Error("values stand too deep within others".to_owned()));
        }
        match kind {
            Kind::List => self.length(0x90, 16, [0, 0xdc, LIST]),
            Kind::Map => self.length(0x80, 16, [0, 0xde, MAP]),
        }
    }

    /// Ends a list or a map of which so many items are left.
    fn end(&mut self, left: usize) -> Result<()> {
        self.depth -= 1;
        if left > 0 { Err(Error(format!("{left} items are too many"))) } else { Ok(()) }
    }

    /// Passes over a value.
    fn skip(&mut self) -> Result<()> {
        let mut values = 1_u64;
        while values > 0 {
            values -= 1;
            let mark = self.mark()?;
            let bytes = match mark {
                0x80..=0x8f => {
                    values += 2 * u64::from(mark & 0xf);
                    0
                }
                0x90..=0x9f => {
                    values += u64::from(mark & 0xf);
                    0
                }
                0xa0..=0xbf => usize::from(mark & 0x1f),
                0xc4..=0xc6 => self.bytes(1 << (mark - 0xc4))? as usize,
                0xd9..=0xdb => self.bytes(1 << (mark - 0xd9))? as usize,
                0xdc | LIST => {
                    values += self.bytes(2 << (mark - 0xdc))?;
                    0
                }
                0xde | MAP => {
                    values += 2 * self.bytes(2 << (mark - 0xde))?;
                    0
                }
                0xca => 4,
                0xcb => 8,
                0xcc..=0xcf => 1 << (mark - 0xcc),
                0xd0..=0xd3 => 1 << (mark - 0xd0),
                0..0x80 | NOTHING | 0xc2 | 0xc3 | 0xe0.. => 0,
                _ => return Err(unexpected(mark)),
            };
            self.take(bytes)?;
        }
        Ok(())
    }

    fn list<'de, V: Visitor<'de>>(&mut self, visitor: V) -> Result<V::Value> {
        let mut items = Items { left: self.begin(Kind::List)?, fields: &[], reader: self };
        let value = visitor.visit_seq(&mut items)?;
        items.end()?;
        Ok(value)
    }

    fn fields<'de, V: Visitor<'de>>(&mut self, fields: &'static [&'static str], visitor: V) -> Result<V::Value> {
        let mut items = Items { left: self.begin(Kind::Map)?, fields, reader: self };
        let value = visitor.visit_seq(Fields(&mut items))?;
        items.end()?;
        Ok(value)
    }
}

fn ends_early() -> Error {
    Error("it ends too early".to_owned())
}

fn unexpected(mark: u8) -> Error {
    Error(format!("the mark {mark:#04x} stands where another value is needed"))
}

/// Items, pairs or fields that follow each other.
struct Items<'r, 'b> {
    reader: &'r mut Reader<'b>,
    /// How many there are still.
    left: usize,
    /// Names of the fields to come.
    fields: &'static [&'static str],
}

impl Items<'_, '_> {
    /// Whether there is one more.
    fn next(&mut self) -> bool {
        let is_there = self.left > 0;
        self.left -= usize::from(is_there);
        is_there
    }

    /// Whether the next field is there: its name then comes next.
    fn next_field(&mut self) -> Result<bool> {
        let Some((name, later)) = self.fields.split_first() else { return Ok(false) };
        self.fields = later;
        if self.left == 0 {
            return Ok(false);
        }
        let before = self.reader.rest;
        if self.reader.text()? != *name {
            self.reader.rest = before;
            return Ok(false);
        }
        Ok(self.next())
    }

    fn end(self) -> Result<()> {
        self.reader.end(self.left)
    }
}

impl<'de> de::SeqAccess<'de> for &mut Items<'_, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>> {
        if self.next() { seed.deserialize(&mut *self.reader).map(Some) } else { Ok(None) }
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left)
    }
}

/// The fields of a struct, in its order.
struct Fields<'i, 'r, 'b>(&'i mut Items<'r, 'b>);

impl<'de> de::SeqAccess<'de> for Fields<'_, '_, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>> {
        if self.0.next_field()? { seed.deserialize(&mut *self.0.reader).map(Some) } else { Ok(None) }
    }
}

impl<'de> de::MapAccess<'de> for &mut Items<'_, '_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>> {
        if self.next() { seed.deserialize(&mut *self.reader).map(Some) } else { Ok(None) }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value> {
        seed.deserialize(&mut *self.reader)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left)
    }
}

/// A variant: its name, and behind it what it holds, if anything.
struct Variant<'r, 'b> {
    reader: &'r mut Reader<'b>,
    is_alone: bool,
}

impl<'de> de::EnumAccess<'de> for Variant<'_, '_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self)> {
        let name: de::value::StrDeserializer<'_, Error> = self.reader.text()?.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl Variant<'_, '_> {
    fn check(&self, is_alone: bool) -> Result<()> {
        if self.is_alone == is_alone { Ok(()) } else { Err(Error("a variant of another form".to_owned())) }
    }
}

impl<'de> de::VariantAccess<'de> for Variant<'_, '_> {
    type Error = Error;

    fn unit_variant(self) -> Result<()> {
        self.check(true)
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value> {
        self.check(false)?;
        seed.deserialize(self.reader)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _length: usize, visitor: V) -> Result<V::Value> {
        self.check(false)?;
        self.reader.list(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value> {
        self.check(false)?;
        self.reader.fields(fields, visitor)
    }
}

macro_rules! read_whole {
    ($($name:ident),*) => {
        $(fn $name<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
            visitor.visit_u64(self.whole()?)
        })*
    };
}

macro_rules! read_signed {
    ($($name:ident),*) => {
        $(fn $name<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
            visitor.visit_i64(self.signed()?)
        })*
    };
}

impl<'de> Deserializer<'de> for &mut Reader<'_> {
    type Error = Error;

    read_whole!(deserialize_u8, deserialize_u16, deserialize_u32, deserialize_u64);
    read_signed!(deserialize_i8, deserialize_i16, deserialize_i32, deserialize_i64);

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.rest.first().copied().ok_or_else(ends_early)? {
            0..0x80 | 0xcc..=0xcf => self.deserialize_u64(visitor),
            0xe0.. | 0xd0..=0xd3 => self.deserialize_i64(visitor),
            0x80..=0x8f | 0xde | MAP => self.deserialize_map(visitor),
            0x90..=0x9f | 0xdc | LIST => self.deserialize_seq(visitor),
            0xa0..=0xbf | 0xd9..=0xdb => self.deserialize_str(visitor),
            0xc4..=0xc6 => self.deserialize_bytes(visitor),
            0xc2 | 0xc3 => self.deserialize_bool(visitor),
            0xca => self.deserialize_f32(visitor),
            0xcb => self.deserialize_f64(visitor),
            _ => self.deserialize_unit(visitor),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        self.skip()?;
        visitor.visit_unit()
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_str(self.text()?)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.mark()? {
            mark @ (0xc2 | 0xc3) => visitor.visit_bool(mark == 0xc3),
            mark => Err(unexpected(mark)),
        }
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_str(self.text()?)
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.mark()? {
            0xca => visitor.visit_f32(f32::from_bits(self.bytes(4)? as u32)),
            mark => Err(unexpected(mark)),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.mark()? {
            0xcb => visitor.visit_f64(f64::from_bits(self.bytes(8)?)),
            mark => Err(unexpected(mark)),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_str(self.text()?)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_str(self.text()?)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_bytes(self.slice()?)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        visitor.visit_bytes(self.slice()?)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        if self.rest.first() != Some(&NOTHING) {
            return visitor.visit_some(self);
        }
        self.mark()?;
        visitor.visit_none()
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.mark()? {
            NOTHING => visitor.visit_unit(),
            mark => Err(unexpected(mark)),
        }
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(self, _name: &'static str, visitor: V) -> Result<V::Value> {
        self.deserialize_unit(visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _name: &'static str, visitor: V) -> Result<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        self.list(visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _length: usize, visitor: V) -> Result<V::Value> {
        self.list(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _length: usize,
        visitor: V,
    ) -> Result<V::Value> {
        self.list(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let mut items = Items { left: self.begin(Kind::Map)?, fields: &[], reader: self };
        let value = visitor.visit_map(&mut items)?;
        items.end()?;
        Ok(value)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        self.fields(fields, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        let is_alone = matches!(self.rest.first(), Some(0xa0..=0xbf | 0xd9..=0xdb));
        if is_alone {
            return visitor.visit_enum(Variant { reader: self, is_alone });
        }
        if self.begin(Kind::Map)? != 1 {
            return Err(Error("a variant has one name".to_owned()));
        }
        let value = visitor.visit_enum(Variant { reader: &mut *self, is_alone })?;
        self.end(0)?;
        Ok(value)
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde::Deserialize;
    use serde::de::IgnoredAny;

    use super::*;

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
        #[serde(default, skip_serializing_if = "Option::is_none")]
        missing: Option<u64>,
        numbers: [f64; 3],
        names: BTreeMap<String, (i64, bool, char)>,
        last: u16,
    }

    /// Reads what comes, to see what it is.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(untagged)]
    enum Any {
        Whole(i64),
        Number(f64),
        Text(String),
        List(Vec<Any>),
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

    #[test]
    fn values_are_read_as_they_were_written() {
        kept(whole(2));
        from_bytes::<IgnoredAny>(&to_bytes(&whole(2)).unwrap()).unwrap();
        kept(vec![Any::Text("a".to_owned()), Any::Number(-1.5), Any::List(vec![Any::Whole(-1), Any::Whole(1 << 40)])]);
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
    fn lists_of_unknown_length_end_where_they_end() {
        struct Odd;
        impl Serialize for Odd {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_seq((0..100_u8).filter(|number| number % 2 == 1))
            }
        }
        let read: Vec<u8> = from_bytes(&to_bytes(&Odd).unwrap()).unwrap();
        assert_eq!(read, (0..50).map(|half| 2 * half + 1).collect::<Vec<u8>>());
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
        assert!(from_bytes::<Vec<f64>>(&[LIST, 0xff, 0xff, 0xff, 0xff]).is_err());
        assert!(from_bytes::<Whole>(&to_bytes(&whole(400)).unwrap()).is_err(), "too deep");
    }
}
