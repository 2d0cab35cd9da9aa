//! The parsed tree: values that know where they stand in which file.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use crate::diagnostics::{Diagnostic, Error, Place, Result, did_you_mean};

/// Value of a node.
#[derive(Debug, Clone)]
pub enum Value {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A number written without fraction and exponent.
    Integer(i64),
    /// Any other number; always finite.
    Double(f64),
    /// A string, escapes resolved.
    String(String),
    /// A list, in the order written.
    Array(Vec<Node>),
    /// Named values.
    Object(Object),
}

impl Value {
    /// Type of the value, with its article, for messages: `a string`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool(_) => "a boolean",
            Self::Integer(_) => "an integer",
            Self::Double(_) => "a number",
            Self::String(_) => "a string",
            Self::Array(_) => "an array",
            Self::Object(_) => "an object",
        }
    }
}

/// A path for messages; the empty one is the deck.
fn said(path: &str) -> &str {
    if path.is_empty() { "the deck" } else { path }
}

/// One named value of an object.
#[derive(Debug, Clone)]
pub struct Member {
    /// The name.
    pub key: String,
    /// Line and column of the name.
    pub(super) key_position: (u32, u32),
    /// The value.
    pub node: Node,
}

impl Member {
    /// The same member as if it stood at `place`.
    pub fn at(&self, place: &Place) -> Self {
        let mut member = self.clone();
        let file: Arc<Path> = Arc::from(place.file.as_path());
        member.key_position = (place.line, place.column);
        member.node.move_to((&file, place.line, place.column), true);
        member
    }

    /// The same member with another value.
    #[must_use]
    pub fn with(mut self, value: Value) -> Self {
        self.node.value = value;
        self
    }
}

/// Named values: iterated in byte order of their keys, source order on demand.
#[derive(Debug, Clone, Default)]
pub struct Object {
    members: Vec<Member>,
    by_key: Vec<u32>,
}

impl Object {
    /// The object of these members; of equal keys the last one stays.
    pub fn from_members(members: Vec<Member>) -> Self {
        let mut by_key: Vec<u32> = (0..members.len() as u32).collect();
        by_key.sort_by(|&a, &b| members[a as usize].key.cmp(&members[b as usize].key).then(b.cmp(&a)));
        let before = by_key.len();
        by_key.dedup_by(|a, b| members[*a as usize].key == members[*b as usize].key);
        if by_key.len() == before {
            return Self { members, by_key };
        }
        let kept: Vec<bool> = (0..before as u32).map(|i| by_key.contains(&i)).collect();
        let mut kept = kept.into_iter();
        let members = members.into_iter().filter(|_| kept.next() == Some(true)).collect();
        Self::from_members(members)
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.member(key).map(|m| &m.node)
    }

    /// The member of a key.
    pub fn member(&self, key: &str) -> Option<&Member> {
        let at = self.by_key.binary_search_by(|&i| self.members[i as usize].key.as_str().cmp(key)).ok()?;
        Some(&self.members[self.by_key[at] as usize])
    }

    /// Members in byte order of their keys, the order in which decks are executed.
    pub fn iter(&self) -> impl Iterator<Item = &Member> {
        self.by_key.iter().map(|&i| &self.members[i as usize])
    }

    /// The values of all members.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut Node> {
        self.members.iter_mut().map(|member| &mut member.node)
    }

    /// Members in the order the file has them.
    pub fn in_source_order(&self) -> &[Member] {
        &self.members
    }

    /// The keys in byte order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.iter().map(|m| m.key.as_str())
    }

    /// How many members there are.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// Takes a member out.
    pub fn remove(&mut self, key: &str) -> Option<Member> {
        let at = self.members.iter().position(|m| m.key == key)?;
        let member = self.members.remove(at);
        *self = Self::from_members(std::mem::take(&mut self.members));
        Some(member)
    }

    /// Adds a member, or replaces the one of the same key.
    pub fn insert(&mut self, member: Member) {
        let mut members = std::mem::take(&mut self.members);
        members.push(member);
        *self = Self::from_members(members);
    }

    /// The value of a key, to change.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.members.iter_mut().find(|m| m.key == key).map(|m| &mut m.node)
    }
}

/// A value with the place where it is written.
#[derive(Debug, Clone)]
pub struct Node {
    pub(super) file: Arc<Path>,
    pub(super) line: u32,
    pub(super) column: u32,
    pub(super) given: bool,
    /// The value.
    pub value: Value,
}

impl Node {
    /// A value that belongs to a place.
    pub fn new(value: Value, place: &Place) -> Self {
        Self { file: Arc::from(place.file.as_path()), line: place.line, column: place.column, given: true, value }
    }

    /// A whole JSON tree that belongs to one place, for settings made by a program.
    ///
    /// # Errors
    /// [`Error::Input`] for a number out of range.
    pub fn from_json(json: &serde_json::Value, place: &Place) -> Result<Self> {
        super::Document::from_str(&json.to_string(), &place.file).map(|document| {
            let mut root = document.root;
            root.move_to((&Arc::from(place.file.as_path()), place.line, place.column), true);
            root
        })
    }

    /// Where the value is written; for a default, where the object it completes is.
    pub fn place(&self) -> Place {
        Place::at(&self.file, self.line, self.column)
    }

    /// Whether the user wrote it, rather than a default.
    pub fn is_given(&self) -> bool {
        self.given
    }

    /// Puts the whole tree at one place.
    pub(super) fn move_to(&mut self, (file, line, column): (&Arc<Path>, u32, u32), given: bool) {
        self.file = Arc::clone(file);
        (self.line, self.column, self.given) = (line, column, given);
        match &mut self.value {
            Value::Array(items) => items.iter_mut().for_each(|n| n.move_to((file, line, column), given)),
            Value::Object(object) => object.members.iter_mut().for_each(|m| {
                m.key_position = (line, column);
                m.node.move_to((file, line, column), given);
            }),
            _ => {}
        }
    }

    /// The value of a key, when this is an object that has it.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.as_object()?.get(key)
    }

    /// The node at a dotted path of keys.
    pub fn get_path(&self, path: &str) -> Option<&Node> {
        path.split('.').try_fold(self, |node, key| node.get(key))
    }

    /// As [`Node::get_path`], to change.
    pub fn get_path_mut(&mut self, path: &str) -> Option<&mut Node> {
        path.split('.').try_fold(self, |node, key| match &mut node.value {
            Value::Object(members) => members.get_mut(key),
            _ => None,
        })
    }

    /// Puts a value at a dotted path of keys and places in lists; only the last key may be new.
    ///
    /// # Errors
    /// A path on which something is missing; the caller adds the place.
    pub fn set_path(&mut self, path: &str, value: Node) -> Result<(), Diagnostic> {
        let mut here = self;
        let mut walked = String::new();
        let mut keys = path.split('.').peekable();
        while let Some(key) = keys.next() {
            let is_last = keys.peek().is_none();
            let fact = match &here.value {
                Value::Object(_) => format!("there is no {key:?} in {}", said(&walked)),
                Value::Array(items) => format!("{} is a list of {} and has no {key:?}", said(&walked), items.len()),
                other => format!("{} is {}, which holds nothing", said(&walked), other.kind()),
            };
            let missing = Diagnostic::error("unknown-path", fact);
            here = match &mut here.value {
                Value::Object(members) => {
                    if is_last && members.get(key).is_none() {
                        let key_position = (value.line, value.column);
                        members.insert(Member { key: key.to_owned(), key_position, node: value });
                        return Ok(());
                    }
                    let near = did_you_mean(key, members.keys());
                    match members.get_mut(key) {
                        Some(node) => node,
                        None => return Err(near.map_or(missing.clone(), |near| missing.remedy(near))),
                    }
                }
                Value::Array(items) => match key.parse::<usize>().ok().and_then(|at| items.get_mut(at)) {
                    Some(node) => node,
                    None => return Err(missing.remedy("places in lists count from 0")),
                },
                _ => return Err(missing),
            };
            walked = if walked.is_empty() { key.to_owned() } else { format!("{walked}.{key}") };
        }
        *here = value;
        Ok(())
    }

    /// Where a key is written, else where the object begins.
    pub fn key_place(&self, key: &str) -> Place {
        match self.as_object().and_then(|o| o.member(key)) {
            Some(m) => Place::at(&m.node.file, m.key_position.0, m.key_position.1),
            None => self.place(),
        }
    }

    /// Whether it is `null`.
    pub fn is_null(&self) -> bool {
        matches!(self.value, Value::Null)
    }

    /// The number, when it is one.
    pub fn as_f64(&self) -> Option<f64> {
        match self.value {
            Value::Integer(i) => Some(i as f64),
            Value::Double(x) => Some(x),
            _ => None,
        }
    }

    /// The integer, when it is one; `2.0` is one too.
    pub fn as_i64(&self) -> Option<i64> {
        match self.value {
            Value::Integer(i) => Some(i),
            Value::Double(x) if x.fract() == 0.0 && x.abs() < 9.0e15 => Some(x as i64),
            _ => None,
        }
    }

    /// The string, when it is one.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(s) => Some(s),
            _ => None,
        }
    }

    /// The boolean, when it is one.
    pub fn as_bool(&self) -> Option<bool> {
        match self.value {
            Value::Bool(b) => Some(b),
            _ => None,
        }
    }

    /// The items, when it is an array.
    pub fn as_array(&self) -> Option<&[Node]> {
        match &self.value {
            Value::Array(items) => Some(items),
            _ => None,
        }
    }

    /// The object, when it is one.
    pub fn as_object(&self) -> Option<&Object> {
        match &self.value {
            Value::Object(object) => Some(object),
            _ => None,
        }
    }

    /// The number.
    ///
    /// # Errors
    /// `wrong-type` at this place, as for all accessors that name a type.
    pub fn f64(&self) -> Result<f64> {
        self.as_f64().ok_or_else(|| self.wrong_type("a number"))
    }

    /// The integer; errors as [`Node::f64`].
    pub fn i64(&self) -> Result<i64> {
        self.as_i64().ok_or_else(|| self.wrong_type("an integer"))
    }

    /// The integer from 0; errors as [`Node::f64`].
    pub fn usize(&self) -> Result<usize> {
        let index = self.as_i64().and_then(|i| usize::try_from(i).ok());
        index.ok_or_else(|| self.wrong_type("an integer from 0"))
    }

    /// The boolean; errors as [`Node::f64`].
    pub fn bool(&self) -> Result<bool> {
        self.as_bool().ok_or_else(|| self.wrong_type("true or false"))
    }

    /// The string; errors as [`Node::f64`].
    pub fn str(&self) -> Result<&str> {
        self.as_str().ok_or_else(|| self.wrong_type("a string"))
    }

    /// The items; errors as [`Node::f64`].
    pub fn array(&self) -> Result<&[Node]> {
        self.as_array().ok_or_else(|| self.wrong_type("an array"))
    }

    /// The object; errors as [`Node::f64`].
    pub fn object(&self) -> Result<&Object> {
        self.as_object().ok_or_else(|| self.wrong_type("an object"))
    }

    /// The value of a key that must be there.
    ///
    /// # Errors
    /// `wrong-type` when this is no object, `missing-key` when the key is not in it.
    pub fn require(&self, key: &str) -> Result<&Node> {
        let object = self.object()?;
        object.get(key).ok_or_else(|| {
            let near = crate::diagnostics::did_you_mean(key, object.keys());
            let fact = format!("\"{key}\" is missing");
            Diagnostic::error("missing-key", fact)
                .at(self.place())
                .remedy(near.unwrap_or_else(|| format!("add \"{key}\" to this object")))
                .into()
        })
    }

    fn wrong_type(&self, expected: &str) -> Error {
        let fact = format!("expected {expected}, found {} ({self})", self.value.kind());
        Diagnostic::error("wrong-type", fact).at(self.place()).remedy(format!("write {expected}")).into()
    }

    /// The tree as plain JSON, keys in byte order.
    pub fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::Null => serde_json::Value::Null,
            Value::Bool(b) => (*b).into(),
            Value::Integer(i) => (*i).into(),
            Value::Double(x) => (*x).into(),
            Value::String(s) => s.as_str().into(),
            Value::Array(items) => items.iter().map(Node::to_json).collect(),
            Value::Object(object) => object.iter().map(|m| (m.key.clone(), m.node.to_json())).collect(),
        }
    }
}

/// Compact JSON, cut after 60 characters; for messages.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self.to_json().to_string();
        match text.char_indices().nth(60) {
            Some((cut, _)) => write!(f, "{}…", &text[..cut]),
            None => f.write_str(&text),
        }
    }
}
