//! `zelus list` and `zelus describe`: the registry in words.

use std::collections::BTreeSet;

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_core::entities::find_kind;
use zelus_core::model::{EntityRole, Named, VariableEntry, VariableKind, named, variables};
use zelus_core::registry::{self, Entry, Kind, Registered};

use super::example::example;
use super::keys::{Key, keys};
use super::kratos_names::{done_here, names_of_kratos, without_shape};
use super::say::say;

/// Key of the line of an example in a file of defaults.
const EXAMPLE: &str = "\"$example\"";

/// Word of the list of names of Kratos.
const OF_KRATOS: &str = "kratos_name";

/// Prints the names of one kind, or of all.
pub(super) fn list(kind: Option<&str>) -> Result<()> {
    let of_kratos = kind.is_none_or(|word| singular(word) == OF_KRATOS);
    let kinds: Vec<&Kind> = match kind {
        None => registry::kinds(),
        Some(_) if of_kratos => Vec::new(),
        Some(word) => vec![kind_called(word)?],
    };
    for kind in kinds {
        let mut entries = (kind.entries)();
        entries.sort_by_key(|entry| entry.name);
        say(&format!("{} ({})", kind.word, entries.len()));
        for entry in entries {
            let values = values_of(kind.word, entry).map(|values| format!(" [{values}]")).unwrap_or_default();
            let aliases =
                if entry.aliases.is_empty() { String::new() } else { format!(" (also {})", entry.aliases.join(", ")) };
            say(&format!("  {}{values}{aliases}: {}", entry.name, entry.about));
        }
        for (stem, remedy) in registry::absent(kind.word) {
            say(&format!("  {stem}…: not there; {remedy}"));
        }
    }
    if of_kratos {
        let names = names_of_kratos()?;
        say(&format!("{OF_KRATOS} ({})", names.len()));
        names.iter().for_each(|(name, sentence)| say(&format!("  {name}: {sentence}")));
    }
    Ok(())
}

fn singular(word: &str) -> &str {
    word.strip_suffix('s').unwrap_or(word)
}

fn kind_called(word: &str) -> Result<&'static Kind> {
    registry::kinds().into_iter().find(|kind| kind.word == singular(word) || kind.word == word).ok_or_else(|| {
        let words = || registry::kinds().into_iter().map(|kind| kind.word).chain([OF_KRATOS]);
        let remedy =
            did_you_mean(word, words()).unwrap_or_else(|| format!("kinds: {}", words().collect::<Vec<_>>().join(", ")));
        Diagnostic::error("unknown-kind", format!("there is no kind {word:?}")).remedy(remedy).into()
    })
}

/// Prints everything the registry knows of a name: of an object, a variable, a flag, or a key of a deck.
pub(super) fn describe(name: &str) -> Result<()> {
    let variable = match named(name) {
        Some(Named::Component(component)) => component.column,
        _ => name,
    };
    let found: Vec<(&str, &Entry)> =
        registry::entries().into_iter().filter(|(_, entry)| entry.is_called(variable)).collect();
    for (kind, entry) in &found {
        describe_entry(kind, entry)?;
    }
    let keys = keys()?;
    let called: Vec<&Key> = keys.iter().filter(|key| key.is_called(name)).collect();
    for key in &called {
        say(&format!("key {}", key.path));
        say(&format!("  of {}", key.objects()));
        key.lines.iter().for_each(|line| say(&format!("  {line}")));
    }
    if !found.is_empty() || !called.is_empty() || answered(name)? {
        return Ok(());
    }
    let mut names: BTreeSet<&str> = keys.iter().filter_map(|key| key.path.rsplit('.').next()).collect();
    for name in registry::kinds().into_iter().flat_map(Kind::names) {
        names.insert(name);
    }
    let remedy = did_you_mean(name, names);
    let remedy = remedy.unwrap_or_else(|| "`zelus list` shows every name".to_owned());
    Err(Diagnostic::error("unknown-name", format!("nothing is registered as {name:?}")).remedy(remedy).into())
}

/// Prints an entry: words, source, settings and an example.
fn describe_entry(kind: &str, entry: &Entry) -> Result<()> {
    let values = values_of(kind, entry).map(|values| format!(" [{values}]")).unwrap_or_default();
    say(&format!("{kind} {}{values}", entry.name));
    say(&format!("  {}", entry.about));
    if !entry.aliases.is_empty() {
        say(&format!("  also called {}", entry.aliases.join(", ")));
    }
    let shape = [EntityRole::Element, EntityRole::Condition].into_iter().find(|role| role.word() == kind);
    if let Some(of) = shape.and_then(|role| find_kind(role, entry.name))
        && let Some(cell) = of.cell
    {
        say(&format!("  {} nodes, shape {cell:?}, in {} dimensions", of.nodes(), of.space));
    }
    if !entry.source.is_empty() {
        say(&format!("  source: {}", entry.source));
    }
    say(&format!("  code: {}:{}", entry.file, entry.line));
    if !entry.defaults.is_empty() {
        say("  settings with their defaults:");
        let settings = entry.defaults.lines().filter(|line| !line.trim_start().starts_with(EXAMPLE));
        settings.for_each(|line| say(&format!("    {line}")));
    }
    for (program, values) in entry.like {
        say(&format!("  with --like {program}, where a deck names nothing:"));
        values.lines().for_each(|line| say(&format!("    {line}")));
    }
    if let Some(text) = example(kind, entry)? {
        say("  example:");
        text.lines().for_each(|line| say(&format!("    {line}")));
    }
    Ok(())
}

/// Prints where the work of a known name is done, its shapes, or its replacement; returns whether there was anything.
fn answered(name: &str) -> Result<bool> {
    let done = done_here(name)?;
    if let Some(sentence) = &done {
        say(&format!("{name}: {sentence}"));
    }
    let mut found = done.is_some();
    for kind in registry::kinds() {
        let of_name = |known: &&str| *known != name && without_shape(known) == name;
        let several: Vec<&str> = kind.names().into_iter().filter(of_name).collect();
        if !several.is_empty() {
            say(&format!("{} {name}…: {}", kind.word, several.join(", ")));
            found = true;
        } else if let Some(remedy) = registry::instead_of(kind.word, name) {
            say(&format!("{} {name}: not there; {remedy}", kind.word));
            found = true;
        }
    }
    Ok(found)
}

/// The values of a variable; `None` for entries of other kinds.
fn values_of(kind: &str, entry: &Entry) -> Option<&'static str> {
    let variable = (kind == VariableEntry::KIND).then(|| variables().get(entry.name))??;
    Some(match variable.kind {
        VariableKind::Scalar => "number",
        VariableKind::Vector3 => "3 components",
        VariableKind::Vector => "vector",
        VariableKind::Matrix => "matrix",
        VariableKind::Boolean => "true or false",
        VariableKind::Integer => "integer",
        VariableKind::Text => "text",
    })
}
