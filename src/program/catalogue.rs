//! `zelus list` and `zelus describe`: the registry in words.

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_core::model::{VariableKind, variables};
use zelus_core::registry::{self, Entry, Kind};

use super::say::say;

/// Prints the names of one kind, or of all.
pub(super) fn list(kind: Option<&str>) -> Result<()> {
    let kinds: Vec<Kind> = match kind {
        None => Kind::ALL.to_vec(),
        Some("variable" | "variables") => Vec::new(),
        Some(word) => vec![find_kind(word)?],
    };
    for kind in kinds {
        let entries: Vec<&Entry> = registry::entries().into_iter().filter(|e| e.kind == kind).collect();
        if entries.is_empty() {
            continue;
        }
        say(&format!("{} ({})", kind.word(), entries.len()));
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

fn find_kind(word: &str) -> Result<Kind> {
    let wanted = word.trim_end_matches('s');
    Kind::ALL.into_iter().find(|kind| kind.word() == wanted || kind.word() == word).ok_or_else(|| {
        let words = || Kind::ALL.iter().map(|kind| kind.word()).chain(["variable"]);
        let remedy =
            did_you_mean(word, words()).unwrap_or_else(|| format!("kinds: {}", words().collect::<Vec<_>>().join(", ")));
        Diagnostic::error("unknown-kind", format!("there is no kind {word:?}")).remedy(remedy).into()
    })
}

/// Prints everything the registry knows of a name.
pub(super) fn describe(name: &str) -> Result<()> {
    let found: Vec<&Entry> = Kind::ALL.into_iter().filter_map(|kind| registry::find(kind, name)).collect();
    for entry in &found {
        say(&format!("{} {}", entry.kind.word(), entry.name));
        say(&format!("  {}", entry.about));
        if !entry.aliases.is_empty() {
            say(&format!("  also called {}", entry.aliases.join(", ")));
        }
        if let Some(cell) = entry.cell {
            say(&format!("  {} nodes, shape {cell:?}, in {} dimensions", entry.nodes(), entry.space));
        }
        if !entry.source.is_empty() {
            say(&format!("  source: {}", entry.source));
        }
        say(&format!("  code: {}:{}", entry.file, entry.line));
        if !entry.defaults.is_empty() {
            say("  settings with their defaults:");
            entry.defaults.lines().for_each(|line| say(&format!("    {line}")));
        }
        for (program, values) in entry.like {
            say(&format!("  with --like {program}, where a deck names nothing:"));
            values.lines().for_each(|line| say(&format!("    {line}")));
        }
    }
    let variable = variables().get(name);
    if let Some(entry) = variable {
        say(&format!("variable {} [{}]\n  {}", entry.name, kind_word(entry.kind), entry.about));
    }
    if !found.is_empty() || variable.is_some() {
        return Ok(());
    }
    let names: Vec<&str> = Kind::ALL.into_iter().flat_map(registry::names).chain(variables().keys().copied()).collect();
    let remedy = did_you_mean(name, names).unwrap_or_else(|| "`zelus list` shows every name".to_owned());
    Err(Diagnostic::error("unknown-name", format!("nothing is registered as {name:?}")).remedy(remedy).into())
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
