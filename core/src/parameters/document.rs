//! Reads JSON with comments into nodes that know their places.

use std::path::Path;
use std::sync::Arc;

use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::errors::ParseErrorKind;
use jsonc_parser::{CollectOptions, CommentCollectionStrategy, ParseOptions, parse_to_ast};

use super::node::{Member, Node, Object, Value};
use crate::diagnostics::{Diagnostic, Error, Place, Result};

/// A parsed JSON file.
#[derive(Debug, Clone)]
pub struct Document {
    /// The value the file holds.
    pub root: Node,
    /// Warnings about a file that can be read, e.g. a key given twice.
    pub warnings: Vec<Diagnostic>,
}

impl Document {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Input`] when the file cannot be read (`unreadable-file`) or is not JSON (`invalid-json`).
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let unreadable = |fact: String, remedy: &str| {
            Diagnostic::error("unreadable-file", fact).at(Place::file(path)).remedy(remedy)
        };
        let bytes = std::fs::read(path).map_err(|e| {
            unreadable(format!("cannot read the file: {e}"), "check the name and the working directory")
        })?;
        let text = String::from_utf8(bytes)
            .map_err(|e| unreadable(format!("the file is not UTF-8 text ({})", e.utf8_error()), "save it as UTF-8"))?;
        Self::from_str(text.strip_prefix('\u{feff}').unwrap_or(&text), path)
    }

    /// Parses a text; `path` is the name its places carry.
    ///
    /// # Errors
    /// [`Error::Input`] when the text is not JSON (`invalid-json`).
    pub fn from_str(text: &str, path: impl AsRef<Path>) -> Result<Self> {
        Ok(parse(text, path.as_ref(), false)?.0)
    }
}

/// A comment of the file, without its delimiters.
pub(super) struct Comment {
    pub(super) first_line: u32,
    pub(super) last_line: u32,
    /// Whether nothing but white space stands before it in its line.
    pub(super) own_line: bool,
    pub(super) text: String,
}

/// The document and, when asked for, its comments in order.
pub(super) fn parse(text: &str, path: &Path, with_comments: bool) -> Result<(Document, Vec<Comment>)> {
    let comments = if with_comments { CommentCollectionStrategy::Separate } else { CommentCollectionStrategy::Off };
    let options = ParseOptions {
        allow_comments: true,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed = parse_to_ast(text, &CollectOptions { comments, tokens: false }, &options).map_err(|e| {
        let (line, column) = Cursor::new(text).advance(e.range().start);
        let fact = lower_first(&e.kind().to_string());
        let problem = Diagnostic::error("invalid-json", fact).at(Place::at(path, line, column));
        problem.remedy(remedy(e.kind()))
    })?;
    let Some(root) = parsed.value else {
        let problem = Diagnostic::error("invalid-json", "the file holds no JSON value").at(Place::file(path));
        return Err(problem.remedy("write at least {}").into());
    };
    let mut builder = DocumentBuilder { file: Arc::from(path), cursor: Cursor::new(text), problems: Vec::new() };
    let root = builder.node(&root);
    if builder.problems.iter().any(|d| d.severity == crate::diagnostics::Severity::Error) {
        return Err(Error::Input(builder.problems));
    }
    let comments = parsed.comments.map_or_else(Vec::new, |map| comments_in_order(text, &map));
    Ok((Document { root, warnings: builder.problems }, comments))
}

fn remedy(kind: &ParseErrorKind) -> &'static str {
    match kind {
        ParseErrorKind::TrailingCommasNotAllowed => "remove the comma before the closing bracket",
        ParseErrorKind::ExpectedComma => "separate the values with a comma",
        ParseErrorKind::UnexpectedWord => "only true, false and null stand without quotes",
        ParseErrorKind::ExpectedStringObjectProperty => "put the key in double quotes",
        ParseErrorKind::SingleQuotedStringsNotAllowed => "use double quotes",
        ParseErrorKind::UnterminatedArray => "add the missing ]",
        ParseErrorKind::UnterminatedObject => "add the missing }",
        ParseErrorKind::UnaryPlusNumbersNotAllowed => "remove the +",
        ParseErrorKind::BareDecimalPointNumbersNotAllowed => "write a digit on both sides of the decimal point",
        ParseErrorKind::NonFiniteNumbersNotAllowed => "write a number; decks use 1e30 for \"unbounded\"",
        ParseErrorKind::MultipleRootJsonValues => "keep one value a file; a bracket may be closed too early",
        _ => "look for a quote, comma or bracket that is missing here or before",
    }
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_lowercase().chain(chars).collect())
}

fn comments_in_order(text: &str, map: &jsonc_parser::CommentMap<'_>) -> Vec<Comment> {
    let mut found: Vec<(usize, usize, &str)> =
        map.values().flat_map(|list| list.iter().map(|c| (c.start(), c.end(), c.text()))).collect();
    found.sort_unstable();
    found.dedup();
    let mut cursor = Cursor::new(text);
    let place = |(start, end, body): (usize, usize, &str)| {
        let first_line = cursor.advance(start).0;
        let last_line = cursor.advance(end).0;
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let own_line = text[line_start..start].trim().is_empty();
        let lines: Vec<&str> = body.lines().map(|l| l.trim().trim_start_matches('*').trim()).collect();
        Comment { first_line, last_line, own_line, text: lines.join("\n").trim().to_owned() }
    };
    found.into_iter().map(place).collect()
}

/// Turns ascending byte offsets into lines and columns, reading the text once.
struct Cursor<'a> {
    text: &'a str,
    offset: usize,
    line: u32,
    column: u32,
}

impl<'a> Cursor<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, offset: 0, line: 1, column: 1 }
    }

    fn advance(&mut self, to: usize) -> (u32, u32) {
        for c in self.text[self.offset..to.max(self.offset)].chars() {
            if c == '\n' {
                self.line += 1;
                self.column = 1;
            } else {
                self.column += 1;
            }
        }
        self.offset = self.offset.max(to);
        (self.line, self.column)
    }
}

struct DocumentBuilder<'a> {
    file: Arc<Path>,
    cursor: Cursor<'a>,
    problems: Vec<Diagnostic>,
}

impl DocumentBuilder<'_> {
    fn node(&mut self, value: &ast::Value<'_>) -> Node {
        let (line, column) = self.cursor.advance(value.start());
        let value = match value {
            ast::Value::NullKeyword(_) => Value::Null,
            ast::Value::BooleanLit(b) => Value::Bool(b.value),
            ast::Value::NumberLit(n) => self.number(n.value, (line, column)),
            ast::Value::StringLit(s) => Value::String(s.value.to_string()),
            ast::Value::Array(array) => Value::Array(array.elements.iter().map(|v| self.node(v)).collect()),
            ast::Value::Object(object) => Value::Object(self.object(object)),
        };
        Node { file: Arc::clone(&self.file), line, column, given: true, value }
    }

    fn number(&mut self, text: &str, (line, column): (u32, u32)) -> Value {
        if let Ok(i) = text.parse::<i64>() {
            return Value::Integer(i);
        }
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() => Value::Double(x),
            _ => {
                let problem = Diagnostic::error("invalid-json", format!("the number {text} is out of range"));
                let problem = problem.at(Place::at(&self.file, line, column));
                self.problems.push(problem.remedy("a double holds magnitudes up to 1.8e308"));
                Value::Double(0.0)
            }
        }
    }

    fn object(&mut self, object: &ast::Object<'_>) -> Object {
        let mut seen = rustc_hash::FxHashMap::default();
        let mut members = Vec::with_capacity(object.properties.len());
        for property in &object.properties {
            let key = property.name.as_str().to_owned();
            let key_position = self.cursor.advance(property.name.start());
            if let Some(first) = seen.insert(key.clone(), key_position.0) {
                let fact = format!("the key \"{key}\" is given twice (first in line {first}); the last one counts");
                let problem = Diagnostic::warning("duplicate-key", fact);
                let place = Place::at(&self.file, key_position.0, key_position.1);
                self.problems.push(problem.at(place).remedy("remove one of the two"));
            }
            members.push(Member { key, key_position, node: self.node(&property.value) });
        }
        Object::from_members(members)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        Document::from_str(text, "a.json").unwrap_err().to_string()
    }

    #[test]
    fn comments_are_allowed_and_places_are_known() {
        let document = Document::from_str("// deck\n{ /* é */ \"b\": [1, 2.5],\n  \"a\": null }\n", "a.json").unwrap();
        let root = &document.root;
        assert_eq!(root.place().to_string(), "a.json:2:1");
        assert_eq!(root.key_place("b").to_string(), "a.json:2:11");
        assert_eq!(root.get("b").unwrap().array().unwrap()[1].place().to_string(), "a.json:2:20");
        assert_eq!(root.key_place("a").to_string(), "a.json:3:3");
        assert!(root.get("a").unwrap().is_null());
    }

    #[test]
    fn objects_iterate_in_byte_order_of_keys() {
        let document = Document::from_str(r#"{"b": 1, "a10": 2, "a2": 3, "B": 4}"#, "a.json").unwrap();
        let object = document.root.object().unwrap();
        assert_eq!(object.keys().collect::<Vec<_>>(), ["B", "a10", "a2", "b"]);
        let source: Vec<&str> = object.in_source_order().iter().map(|m| m.key.as_str()).collect();
        assert_eq!(source, ["b", "a10", "a2", "B"]);
    }

    #[test]
    fn of_two_equal_keys_the_last_counts_with_a_warning() {
        let document = Document::from_str("{\"a\": 1,\n \"b\": 2,\n \"a\": 3}", "a.json").unwrap();
        assert_eq!(document.root.to_json().to_string(), r#"{"a":3,"b":2}"#);
        let said: Vec<String> = document.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "warning[duplicate-key] a.json:3:2: the key \"a\" is given twice (first in line 1); the last one counts\n    \
              remove one of the two"
            ]
        );
    }

    #[test]
    fn what_is_not_json_is_refused_with_place_and_remedy() {
        assert_eq!(
            refused("{\n  \"a\": 1,\n}"),
            "error[invalid-json] a.json:2:9: trailing commas are not allowed\n    remove the comma before the closing bracket"
        );
        assert_eq!(
            refused("{\"a\": 1\n \"b\": 2}"),
            "error[invalid-json] a.json:1:8: expected comma\n    separate the values with a comma"
        );
        assert!(refused("").contains("holds no JSON value"));
        assert!(refused("{\"a\": 1e999}").contains("a.json:1:7: the number 1e999 is out of range"));
        for text in
            ["{a: 1}", "{'a': 1}", "[.5]", "[1.]", "[+1]", "[0x1]", "[NaN]", "[True]", "[1] [2]", "[1", "{\"a\""]
        {
            assert!(refused(text).starts_with("error[invalid-json] a.json:1:"), "{text}");
        }
    }

    #[test]
    fn a_missing_file_names_itself() {
        let said = Document::read("no/such/deck.json").unwrap_err();
        assert_eq!(said.exit_code(), 2);
        assert!(said.to_string().starts_with("error[unreadable-file] no/such/deck.json: cannot read the file: "));
    }

    #[test]
    fn no_text_makes_it_panic() {
        let pieces = [
            "{", "}", "[", "]", ",", ":", "\"", "\"a\"", "1", "-", "e5", ".", "//", "/*", "*/", "\n", "null", "tru",
            "\\u12", "é",
        ];
        let mut seed = 1_u64;
        let mut random = move |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        let mut read = 0;
        for round in 0..20_000 {
            let length = random(12);
            let text: String = if round % 2 == 0 {
                (0..length).map(|_| pieces[random(pieces.len())]).collect()
            } else {
                String::from_utf8_lossy(&(0..length).map(|_| random(256) as u8).collect::<Vec<_>>()).into_owned()
            };
            read += usize::from(parse(&text, Path::new("a.json"), true).is_ok());
        }
        assert!(read > 100, "{read}");
        assert!(refused(&"[".repeat(100_000)).contains("nesting depth"));
    }
}
