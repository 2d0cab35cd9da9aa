//! Subjects that users look for, with the names that decks write and the page of the documentation.

use std::path::Path;

use zelus_core::Result;
use zelus_core::parameters::{Document, Node};

const TOPICS: &str = include_str!("../../configs/topics.json");

/// A subject.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Topic {
    /// Words that mean it.
    pub words: Vec<String>,
    /// Objects, variables and keys that decks name for it.
    pub names: Vec<String>,
    /// Page of the documentation, with its heading.
    pub page: String,
}

/// All subjects.
///
/// # Errors
/// A list that is no JSON, or lacks a key.
pub(super) fn topics() -> Result<Vec<Topic>> {
    let list = Document::from_str(TOPICS, Path::new("configs/topics.json"))?.root;
    let texts =
        |node: &Node| -> Result<Vec<String>> { node.array()?.iter().map(|item| Ok(item.str()?.to_owned())).collect() };
    let topic = |node: &Node| {
        Ok(Topic {
            words: texts(node.require("words")?)?,
            names: texts(node.require("names")?)?,
            page: node.require("page")?.str()?.to_owned(),
        })
    };
    list.array()?.iter().map(topic).collect()
}

/// The subject that a word means.
///
/// # Errors
/// As [`topics`].
pub(super) fn topic_of(word: &str) -> Result<Option<Topic>> {
    let word = word.to_lowercase().replace([' ', '-'], "_");
    Ok(topics()?.into_iter().find(|topic| topic.words.contains(&word)))
}

/// The words of a name or a sentence in small letters, without the s of a plural: `SurfaceLoadCondition` has surface, load, condition.
pub(super) fn words_of(text: &str) -> Vec<String> {
    let mut words: Vec<String> = vec![String::new()];
    let letters: Vec<char> = text.chars().collect();
    for (at, &letter) in letters.iter().enumerate() {
        let before = at.checked_sub(1).map(|at| letters[at]);
        let follows = |is: fn(char) -> bool| before.is_some_and(is);
        let begins_a_word = letters.get(at + 1).is_some_and(|next| next.is_lowercase());
        let is_head =
            letter.is_uppercase() && (follows(char::is_lowercase) || follows(char::is_uppercase) && begins_a_word);
        if !letter.is_alphanumeric() || is_head {
            words.push(String::new());
        }
        if letter.is_alphanumeric() {
            words.last_mut().expect("one at least").extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words.iter().map(|word| word.strip_suffix('s').unwrap_or(word).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::catalogue::is_known;

    #[test]
    fn topics_name_what_is_there() {
        for topic in topics().expect("topics") {
            for name in &topic.names {
                assert!(is_known(name).expect("keys"), "{name} of {:?}", topic.words);
            }
            let page = Path::new(env!("CARGO_MANIFEST_DIR")).join(topic.page.split('#').next().expect("a page"));
            let text = std::fs::read_to_string(&page).unwrap_or_else(|e| panic!("{}: {e}", page.display()));
            let Some((_, anchor)) = topic.page.split_once('#') else { continue };
            let is_it = |line: &str| {
                let heading = line.trim_start_matches('#').trim().to_lowercase();
                let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -".contains(*c));
                line.starts_with('#') && kept.collect::<String>().replace(' ', "-") == anchor
            };
            assert!(text.lines().any(is_it), "{} has no heading #{anchor}", page.display());
        }
    }

    #[test]
    fn names_have_words() {
        assert_eq!(words_of("SurfaceLoadCondition3D4N"), ["surface", "load", "condition3d4n"]);
        assert_eq!(words_of("friction_coefficients of bolts"), ["friction", "coefficient", "of", "bolt"]);
        assert_eq!(words_of("ALMContactFrictional"), ["alm", "contact", "frictional"]);
    }
}
