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
use super::topics::{topic_of, words_of};

/// Key of the line of an example in a file of defaults.
const EXAMPLE: &str = "\"$example\"";

/// Word of the list of names of Kratos.
const OF_KRATOS: &str = "kratos_name";

/// Word of the list of everything.
const ALL: &str = "all";

/// Kinds by what they are for; a plugin's own kinds follow.
const GROUPS: [(&str, &[&str]); 5] = [
    ("mesh and materials", &["element", "condition", "constitutive_law", "constraint", "modeler", "mesh_format"]),
    ("supports, loads, contact, outputs", &["process", "output_format"]),
    (
        "contact",
        &[
            "contact_formulation",
            "friction_law",
            "overclosure_law",
            "cohesive_law",
            "tying_formulation",
            "penalty_adaptation",
            "contact_conductance",
            "wear_law",
            "rigid_shape",
        ],
    ),
    (
        "solver",
        &[
            "solver",
            "solver_extension",
            "scheme",
            "strategy",
            "convergence_criterion",
            "linear_solver",
            "preconditioner",
            "builder_and_solver",
        ],
    ),
    ("values", &["variable", "flag"]),
];
/// Most letters of the names of a kind on the first screen.
const WIDTH: usize = 90;

/// Prints an overview, the names of one kind, of all, or those about a word.
pub(super) fn list(kind: Option<&str>) -> Result<()> {
    match kind {
        None => overview(),
        Some(ALL) => {
            registry::kinds().into_iter().for_each(list_whole);
            list_of_kratos()
        }
        Some(word) if singular(word) == OF_KRATOS => list_of_kratos(),
        Some(word) => match kind_called(word) {
            Ok(kind) => {
                list_by_stem(kind);
                Ok(())
            }
            Err(problem) => {
                if about(word)? {
                    Ok(())
                } else {
                    Err(problem)
                }
            }
        },
    }
}

/// Kinds in groups, with their numbers of names and the first of them.
fn overview() -> Result<()> {
    say(
        "`zelus list KIND` prints the names of a kind, `zelus list WORD` those about a word, e.g. contact, `zelus list all` all of them;",
    );
    say("`zelus describe NAME` prints settings, defaults and an example.");
    let grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, kinds)| kinds.iter().copied()).collect();
    let others = registry::kinds().into_iter().map(|kind| kind.word).filter(|word| !grouped.contains(word));
    let others: Vec<&str> = others.collect();
    for (title, words) in GROUPS.into_iter().chain([("others", &others[..])]).filter(|(_, words)| !words.is_empty()) {
        say(&format!("\n{title}"));
        for kind in words.iter().filter_map(|word| kind_called(word).ok()) {
            let stems = stems(kind).into_iter().filter(|stem| !stem.is_pair).map(|stem| stem.name);
            let names: Vec<&str> = stems.collect();
            let mut shown = String::new();
            for name in &names {
                if shown.len() + name.len() > WIDTH {
                    shown += ", …";
                    break;
                }
                shown += &format!("{}{name}", if shown.is_empty() { "" } else { ", " });
            }
            say(&format!("  {} ({}): {shown}", kind.word, names.len()));
        }
    }
    say(&format!(
        "\nKratos\n  {OF_KRATOS} ({}): names of Kratos whose work is done here by something else",
        names_of_kratos()?.len()
    ));
    Ok(())
}

/// Entries of a kind that differ in their shapes only.
struct Stem {
    /// Name without shape.
    name: &'static str,
    /// Whether contact makes these conditions for pairs of facets, so that no deck names them.
    is_pair: bool,
    entries: Vec<&'static Entry>,
}

/// The entries of a kind by their names without shapes and their descriptions.
fn stems(kind: &Kind) -> Vec<Stem> {
    let mut entries = (kind.entries)();
    entries.sort_by_key(|entry| entry.name);
    let mut out: Vec<Stem> = Vec::new();
    for entry in entries {
        let name = without_shape(entry.name);
        match out.last_mut().filter(|last| last.name == name && last.entries[0].about == entry.about) {
            Some(last) => last.entries.push(entry),
            None => out.push(Stem { name, is_pair: entry.about.starts_with("pair of "), entries: vec![entry] }),
        }
    }
    out
}

/// Prints the names of a kind, those of several shapes on one line.
fn list_by_stem(kind: &Kind) {
    let stems = stems(kind);
    say(&format!("{} ({})", kind.word, (kind.entries)().len()));
    for stem in stems.iter().filter(|stem| !stem.is_pair) {
        match &stem.entries[..] {
            [entry] => say_entry(kind, entry),
            several => {
                let shapes: Vec<&str> = several.iter().map(|entry| &entry.name[stem.name.len()..]).collect();
                say(&format!("  {} {}: {}", stem.name, shapes.join(", "), several[0].about));
            }
        }
    }
    let pairs: usize = stems.iter().filter(|stem| stem.is_pair).map(|stem| stem.entries.len()).sum();
    if pairs > 0 {
        say(&format!(
            "  {pairs} conditions of pairs of facets, which contact and ties make by their `mortar_type`: `zelus list {ALL}`"
        ));
    }
    list_absent(kind);
}

fn say_entry(kind: &Kind, entry: &Entry) {
    let values = values_of(kind.word, entry).map(|values| format!(" [{values}]")).unwrap_or_default();
    let aliases =
        if entry.aliases.is_empty() { String::new() } else { format!(" (also {})", entry.aliases.join(", ")) };
    say(&format!("  {}{values}{aliases}: {}", entry.name, entry.about));
}

fn list_absent(kind: &Kind) {
    for (stem, remedy) in registry::absent(kind.word) {
        say(&format!("  {stem}…: not there; {remedy}"));
    }
}

/// Prints every name of a kind.
fn list_whole(kind: &Kind) {
    let mut entries = (kind.entries)();
    entries.sort_by_key(|entry| entry.name);
    say(&format!("{} ({})", kind.word, entries.len()));
    entries.into_iter().for_each(|entry| say_entry(kind, entry));
    list_absent(kind);
}

fn list_of_kratos() -> Result<()> {
    let names = names_of_kratos()?;
    say(&format!("{OF_KRATOS} ({})", names.len()));
    names.iter().for_each(|(name, sentence)| say(&format!("  {name}: {sentence}")));
    Ok(())
}

/// Most keys that are told about a word.
const MOST_KEYS: usize = 12;

/// Prints the names about a word: those of its subject, and those with the word in name or description; returns whether there were any.
fn about(word: &str) -> Result<bool> {
    let topic = topic_of(word)?;
    let mut found = topic.is_some();
    if let Some(topic) = topic {
        say(&format!("{word}: see {}", topic.page));
        for name in &topic.names {
            let words = registry::entries().into_iter().find(|(_, entry)| entry.is_called(name));
            let words =
                words.map_or_else(|| "a key of decks".to_owned(), |(kind, entry)| format!("{kind}, {}", entry.about));
            say(&format!("  {name}: {words}"));
        }
    }
    let [wanted] = &words_of(word)[..] else { return Ok(found) };
    for kind in registry::kinds() {
        let has_word = |stem: &Stem| {
            let entry = stem.entries[0];
            words_of(stem.name).contains(wanted) || words_of(entry.about).contains(wanted)
        };
        let stems: Vec<Stem> = stems(kind).into_iter().filter(|stem| !stem.is_pair && has_word(stem)).collect();
        if stems.is_empty() {
            continue;
        }
        found = true;
        say(&format!("{} with {word:?} in name or description", kind.word));
        for stem in stems {
            let several = if stem.entries.len() > 1 { "…" } else { "" };
            let name = if stem.entries.len() > 1 { stem.name } else { stem.entries[0].name };
            say(&format!("  {name}{several}: {}", stem.entries[0].about));
        }
    }
    let mut names: Vec<String> = Vec::new();
    for key in keys()? {
        let last = key.path.rsplit('.').next().unwrap_or_default().to_owned();
        if words_of(&last).contains(wanted) && !names.contains(&last) {
            names.push(last);
        }
    }
    if !names.is_empty() {
        found = true;
        let more = if names.len() > MOST_KEYS { ", …" } else { "" };
        names.truncate(MOST_KEYS);
        say(&format!("keys: {}{more}", names.join(", ")));
    }
    Ok(found)
}

/// Whether a deck can name it: an object, a variable or a key.
#[cfg(test)]
pub(super) fn is_known(name: &str) -> Result<bool> {
    let is_entry = registry::entries().into_iter().any(|(_, entry)| entry.is_called(name));
    Ok(is_entry || keys()?.iter().any(|key| key.is_called(name)))
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
    if !found.is_empty() || !called.is_empty() || answered(name)? || about(name)? {
        return Ok(());
    }
    let mut names: BTreeSet<&str> = keys.iter().filter_map(|key| key.path.rsplit('.').next()).collect();
    for name in registry::kinds().into_iter().flat_map(Kind::names) {
        names.insert(name);
    }
    let remedy = did_you_mean(name, names);
    let remedy = remedy.unwrap_or_else(|| "`zelus list all` shows every name".to_owned());
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
