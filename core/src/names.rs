//! Names that last as long as the program: those of variables, flags and codes, written in it or read from a file.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use serde::{Deserialize, Deserializer};

/// A name that lasts.
pub type Name = &'static str;

/// The name that reads so; each is kept once.
pub fn lasting(name: &str) -> Name {
    static NAMES: Mutex<BTreeSet<Name>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some(known) = names.get(name) {
        return known;
    }
    let new: Name = String::leak(name.to_owned());
    names.insert(new);
    new
}

/// Reads a name; for `#[serde(deserialize_with)]`, as those below.
///
/// # Errors
/// Anything but a text.
pub fn read<'de, D: Deserializer<'de>>(from: D) -> Result<Name, D::Error> {
    Ok(lasting(&String::deserialize(from)?))
}

/// Reads a map whose keys are names.
///
/// # Errors
/// Anything but such a map.
pub fn read_keys<'de, D: Deserializer<'de>, V: Deserialize<'de>>(from: D) -> Result<BTreeMap<Name, V>, D::Error> {
    Ok(BTreeMap::<String, V>::deserialize(from)?.into_iter().map(|(name, value)| (lasting(&name), value)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_kept_once() {
        let [first, second] = ["A_NAME", "A_NAME"].map(lasting);
        assert!(std::ptr::eq(first, second) && first == "A_NAME");
    }
}
