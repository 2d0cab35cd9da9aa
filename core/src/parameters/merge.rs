//! Lays the user's tree over the defaults: old spellings, unknown keys, types.

use super::defaults::{Deprecated, Replacement};
use super::node::{Member, Node, Object, Value};
use crate::diagnostics::{Diagnostic, Place, Report, did_you_mean};

/// More known keys than this are not listed in a message.
const LISTED_KEYS: usize = 16;

/// The merge of one object, with where its problems go.
pub(super) struct Merger<'a> {
    /// Whether unknown keys are only a warning.
    pub(super) lenient: bool,
    /// Takes every problem.
    pub(super) report: &'a mut Report,
    /// Whether one of them is an error.
    pub(super) failed: bool,
}

impl Merger<'_> {
    pub(super) fn error(&mut self, problem: Diagnostic) {
        self.failed = true;
        self.report.push(problem);
    }

    /// Replaces one old spelling, if the user has it.
    pub(super) fn translate(&mut self, user: &mut Node, deprecated: &Deprecated, name: &str) {
        let old = deprecated.old;
        let (parent, key) = old.rsplit_once('.').unwrap_or(("", old));
        let Some(owner) = object_at(user, parent) else { return };
        let Some(member) = owner.remove(key) else { return };
        let place = Place::at(&member.node.file, member.key_position.0, member.key_position.1);
        let warning = |fact: String| Diagnostic::warning("deprecated-key", fact).at(place.clone());
        let (new, node) = match deprecated.what {
            Replacement::Dropped(why) => {
                let problem = warning(format!("\"{old}\" of {name} has no effect: {why}"));
                return self.report.push(problem.remedy(format!("remove \"{key}\"")));
            }
            Replacement::Renamed(new) => (new, member.node),
            Replacement::Translated(new, f) => match f(&member.node.value) {
                Some(value) => (new, Node { value, ..member.node }),
                None => {
                    let fact = format!("\"{old}\" of {name} cannot be {} ({})", member.node.value.kind(), member.node);
                    return self
                        .error(Diagnostic::error("wrong-type", fact).at(place).remedy(format!("set \"{new}\"")));
                }
            },
        };
        if user.get_path(new).is_some() {
            let fact = format!("\"{old}\" of {name} is ignored, since \"{new}\", its new name, is given too");
            return self.report.push(warning(fact).remedy(format!("remove \"{key}\"")));
        }
        let problem =
            warning(format!("\"{old}\" of {name} is now \"{new}\"")).remedy(format!("write \"{new}\": {node}"));
        self.report.push(problem);
        insert_at(user, new, node, member.key_position);
    }

    /// The user's object completed with defaults; they also replace unsuitable values, which are reported.
    pub(super) fn merge(&mut self, user: &Node, defaults: &Node, name: &str) -> Node {
        let (Some(given), Some(known)) = (user.as_object(), defaults.as_object()) else { return user.clone() };
        if known.is_empty() {
            return user.clone();
        }
        let mut members = Vec::with_capacity(known.len());
        for member in given.in_source_order() {
            match known.get(&member.key) {
                Some(default) => {
                    let fit = self.fit(&member.node, default, &format!("{name}.{}", member.key));
                    members.push(Member { node: fit.unwrap_or_else(|| default.clone()), ..member.clone() });
                }
                None => self.unknown(member, known, name),
            }
        }
        for default in known.in_source_order().iter().filter(|m| given.get(&m.key).is_none()) {
            let mut member = default.clone();
            member.key_position = (user.line, user.column);
            member.node.move_to((&user.file, user.line, user.column), false);
            members.push(member);
        }
        Node { value: Value::Object(Object::from_members(members)), ..user.clone() }
    }

    /// The user's value in the type of the default; `None` when it does not fit.
    fn fit(&mut self, user: &Node, default: &Node, name: &str) -> Option<Node> {
        let value = match (&default.value, &user.value) {
            (Value::Null, _)
            | (Value::Bool(_), Value::Bool(_))
            | (Value::String(_), Value::String(_))
            | (Value::Array(_), Value::Array(_)) => return Some(user.clone()),
            (Value::Object(_), Value::Object(_)) => return Some(self.merge(user, default, name)),
            (Value::Integer(_), Value::Integer(_) | Value::Double(_)) => user.as_i64().map(Value::Integer),
            (Value::Double(_), Value::Integer(_) | Value::Double(_)) => user.as_f64().map(Value::Double),
            _ => None,
        };
        if value.is_none() {
            let fact = format!("{name} must be {}, found {} ({user})", default.value.kind(), user.value.kind());
            let remedy = format!("write a value like its default, {default}");
            self.error(Diagnostic::error("wrong-type", fact).at(user.place()).remedy(remedy));
        }
        value.map(|value| Node { value, ..user.clone() })
    }

    fn unknown(&mut self, member: &Member, known: &Object, name: &str) {
        let place = Place::at(&member.node.file, member.key_position.0, member.key_position.1);
        let near = did_you_mean(&member.key, known.keys());
        let list = (known.len() <= LISTED_KEYS)
            .then(|| format!("known keys: {}", known.keys().collect::<Vec<_>>().join(", ")));
        let remedy = match (near, list) {
            (Some(near), Some(list)) => format!("{near} {list}"),
            (Some(text), None) | (None, Some(text)) => text,
            (None, None) => "remove it; `zelus describe` lists the known keys".to_owned(),
        };
        // A key of the command line or of a table of runs stands for something; a deck may hold keys of other programs.
        if self.lenient && !place.is_of_command_line() {
            let fact = format!("\"{}\" is not a setting of {name} and is ignored", member.key);
            self.report.push(Diagnostic::warning("unknown-key-ignored", fact).at(place).remedy(remedy));
        } else {
            let fact = format!("\"{}\" is not a setting of {name}", member.key);
            self.error(Diagnostic::error("unknown-key", fact).at(place).remedy(remedy));
        }
    }
}

/// The object at a dotted path; an empty path is the root.
fn object_at<'a>(root: &'a mut Node, path: &str) -> Option<&'a mut Object> {
    let mut node = root;
    for key in path.split('.').filter(|k| !k.is_empty()) {
        let Value::Object(object) = &mut node.value else { return None };
        node = object.get_mut(key)?;
    }
    match &mut node.value {
        Value::Object(object) => Some(object),
        _ => None,
    }
}

/// Puts a node at a dotted path, making the objects on the way where there are none.
fn insert_at(root: &mut Node, path: &str, node: Node, key_position: (u32, u32)) {
    let (parents, key) = path.rsplit_once('.').unwrap_or(("", path));
    let mut reached = String::new();
    for parent in parents.split('.').filter(|k| !k.is_empty()) {
        let Some(object) = object_at(root, &reached) else { return };
        if object.get(parent).is_none() {
            let empty = Node { value: Value::Object(Object::default()), ..node.clone() };
            object.insert(Member { key: parent.to_owned(), key_position, node: empty });
        }
        reached = if reached.is_empty() { parent.to_owned() } else { format!("{reached}.{parent}") };
    }
    if let Some(object) = object_at(root, parents) {
        object.insert(Member { key: key.to_owned(), key_position, node });
    }
}
