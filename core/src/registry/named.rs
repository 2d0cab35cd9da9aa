//! Objects that a deck names among their own settings.

use super::{Registered, require};
use crate::Result;
use crate::parameters::{Defaults, Node, Settings};

/// The entry that `key` of an object names, and the rest of the object merged with its defaults: `{"law": "gas", "conductivity": 2.0}`.
///
/// # Errors
/// No such key, an unknown name, settings that do not fit.
pub fn named<R: Registered>(object: &Node, key: &str) -> Result<(&'static R, Settings)> {
    let name = object.require(key)?;
    let registered = require::<R>(name.str()?).map_err(|problem| problem.at(name.place()))?;
    let entry = registered.entry();
    let (settings, _) = Settings::check(object, &Defaults::parse(entry.name, entry.defaults)?)?;
    Ok((registered, settings))
}
