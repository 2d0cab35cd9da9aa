//! `zelus list` and `zelus describe`: the registry in words.

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_core::entities::find_kind;
use zelus_core::model::{EntityRole, VariableKind, variables};
use zelus_core::registry::{self, Entry, Kind};

use super::example::example;
use super::kratos_names::{done_here, without_shape};
use super::say::say;

/// Key of the line of an example in a file of defaults.
const EXAMPLE: &str = "\"$example\"";

/// Prints the names of one kind, or of all.
pub(super) fn list(kind: Option<&str>) -> Result<()> {
    let kinds: Vec<&Kind> = match kind {
        None => registry::kinds(),
        Some("variable" | "variables") => Vec::new(),
        Some(word) => vec![kind_called(word)?],
    };
    for kind in kinds {
        let mut entries = (kind.entries)();
        entries.sort_by_key(|entry| entry.name);
        say(&format!("{} ({})", kind.word, entries.len()));
        for entry in entries {
            let aliases =
                if entry.aliases.is_empty() { String::new() } else { format!(" (also {})", entry.aliases.join(", ")) };
            say(&format!("  {}{aliases}: {}", entry.name, entry.about));
        }
    }
    if kind.is_none_or(|word| word.starts_with("variable")) {
        say(&format!("variable ({})", variables().len()));
        for (name, entry) in variables() {
            say(&format!("  {name} [{}]: {}", kind_word(entry.kind), entry.about));
        }
    }
    Ok(())
}

fn kind_called(word: &str) -> Result<&'static Kind> {
    let wanted = word.trim_end_matches('s');
    registry::kinds().into_iter().find(|kind| kind.word == wanted || kind.word == word).ok_or_else(|| {
        let words = || registry::kinds().into_iter().map(|kind| kind.word).chain(["variable"]);
        let remedy =
            did_you_mean(word, words()).unwrap_or_else(|| format!("kinds: {}", words().collect::<Vec<_>>().join(", ")));
        Diagnostic::error("unknown-kind", format!("there is no kind {word:?}")).remedy(remedy).into()
    })
}

/// Prints everything the registry knows of a name.
pub(super) fn describe(name: &str) -> Result<()> {
    let found: Vec<(&str, &Entry)> =
        registry::entries().into_iter().filter(|(_, entry)| entry.is_called(name)).collect();
    for (kind, entry) in &found {
        say(&format!("{kind} {}", entry.name));
        say(&format!("  {}", entry.about));
        if !entry.aliases.is_empty() {
            say(&format!("  also called {}", entry.aliases.join(", ")));
        }
        let shape = [EntityRole::Element, EntityRole::Condition].into_iter().find(|role| role.word() == *kind);
        if let Some(of) = shape.and_then(|role| find_kind(role, name))
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
    }
    let variable = variables().get(name);
    if let Some(entry) = variable {
        say(&format!("variable {} [{}]\n  {}", entry.name, kind_word(entry.kind), entry.about));
    }
    if !found.is_empty() || variable.is_some() {
        return Ok(());
    }
    let registered = registry::kinds().into_iter().flat_map(Kind::names);
    if answered(name)? {
        return Ok(());
    }
    let names: Vec<&str> = registered.chain(variables().keys().copied()).collect();
    let remedy = did_you_mean(name, names).unwrap_or_else(|| "`zelus list` shows every name".to_owned());
    Err(Diagnostic::error("unknown-name", format!("nothing is registered as {name:?}")).remedy(remedy).into())
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

fn kind_word(kind: VariableKind) -> &'static str {
    match kind {
        VariableKind::Scalar => "number",
        VariableKind::Vector3 => "3 components",
        VariableKind::Vector => "vector",
        VariableKind::Matrix => "matrix",
        VariableKind::Boolean => "true or false",
        VariableKind::Integer => "integer",
        VariableKind::Text => "text",
    }
}
