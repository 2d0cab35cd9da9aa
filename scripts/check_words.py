#!/usr/bin/env python3
"""Checks that documents, comments and messages are written in plain words of the field.

Usage: scripts/check_words.py [--self-test] [--list KIND]

Kinds of findings, each printed as "file:line: fact; remedy":

  banned    a phrase of the list in scripts/words.txt: in documents, comments, docstrings, string literals of Rust
  opening   a sentence of a comment or a document that opens with What, Whose, Of which or That which; a comment that opens with Those
  length    a sentence of a document with more words than scripts/words.txt allows
  link      a link between documents, or to a heading, that leads nowhere
  index     a term that the index of terms promises and no linked page contains, a standard term that it lacks, a page of the
            documentation that no link from its first page leads to
  spelling  a word that codespell or typos would correct, where one of them is installed
  exception an exception of scripts/words.txt that nothing needs any more

Quotations (text between “ ” or backticks, code blocks, block quotes) are left out. Needs Python 3.10, and nothing else.
"""

import argparse
import bisect
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tokenize
from dataclasses import dataclass, field
from pathlib import Path

SKIPPED_FOLDERS = {"target", "node_modules", "__pycache__", "book"}
MOST_EXCEPTIONS = 30
OPENING = re.compile(r"(?:What|Whose|Of which|That which)\b(?!['’]s\b)")
# Openings of the first sentence of a comment, which has no noun before it.
FIRST = re.compile(OPENING.pattern + r"|Those\b")
# Spaces after a full stop end a sentence, except after these.
ABBREVIATIONS = re.compile(
    r"(?:\b(?:e\.g|i\.e|cf|vs|Fig|Eq|eq|No|pp?|ed|Sect?|Chap|approx|resp|St|Dr|Prof|J|Int|Numer|Meth|Eng|Comput|Thermal)"
    r"|(?:^|[(,*\x00]\s?|\band |[A-Z]\. ?|:\s)[A-Z])\.$"
)
# A sentence begins with a capital, a number, a link, or a symbol.
BEGINNING = r"\s+(?:[\x00(*_“\"]*[A-Zx0-9Α-Ωα-ω|]|[\x00(*_]*\[|[\x00(]*\*\w|[\x00*_]*[a-zα-ω][\u0300-\u036f°₀-₉]*\s(?:is|are|and|=)\s)"


@dataclass(frozen=True)
class Finding:
    kind: str
    path: str
    line: int
    fact: str
    remedy: str
    text: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.fact}; {self.remedy}"


@dataclass
class Passage:
    """A paragraph, list item, table cell, heading, comment or string literal; `starts` gives the line of each offset."""

    path: str
    kind: str
    text: str = ""
    offsets: list = field(default_factory=list)
    lines: list = field(default_factory=list)

    def add(self, line, text):
        if self.text:
            self.text += " "
        self.offsets.append(len(self.text))
        self.lines.append(line)
        self.text += text.strip()

    def line(self, offset):
        return self.lines[bisect.bisect_right(self.offsets, offset) - 1]


@dataclass
class Rules:
    longest: int
    banned: list
    terms: list
    spelling: list
    exceptions: list


def read_rules(path):
    """Sections in square brackets; `#` opens a comment; `=>` separates a pattern from its remedy."""
    sections, section = {}, None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if line.startswith("["):
            section = sections.setdefault(line.strip("[] "), [])
        elif section is None:
            raise SystemExit(f"{path}:{number}: a line before the first section; write [section] above it")
        else:
            section.append(line.strip())
    banned = []
    for line in sections.get("banned", []):
        pattern, remedy = line.split(" => ")
        banned.append((re.compile(rf"\b(?:{pattern})(?!\w)".replace(" ", r"\s+"), re.IGNORECASE), remedy))
    exceptions = [tuple(part.strip() for part in line.split(" | ")) for line in sections.get("exceptions", [])]
    for exception in exceptions:
        if len(exception) != 4:
            raise SystemExit(f"{path}: an exception is not written as: path | kind | text | reason: {exception}")
    if len(exceptions) > MOST_EXCEPTIONS:
        raise SystemExit(f"{path}: {len(exceptions)} exceptions, more than {MOST_EXCEPTIONS}; reword some of the text")
    longest = int(sections.get("longest sentence", ["35"])[0])
    return Rules(longest, banned, sections.get("terms", []), sections.get("spelling", []), exceptions)


# ---------------------------------------------------------------------------------------------------------------------------------
# Text: passages of documents and of Rust files, with quotations blanked.

QUOTATIONS = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)|“[^”]*”|\$\$.+?\$\$")


def without_quotations(text):
    """Quotations become one word of the same length, so that offsets stay and a sentence keeps its shape."""
    return QUOTATIONS.sub(lambda m: "x" + "\x00" * (len(m.group()) - 1), text)


def without_targets(text):
    """`[text](target)` keeps its text only; addresses and tags vanish."""
    def blank(m):
        return "\x00" * len(m.group())

    text = re.sub(r"\]\([^)\s]*(?:\s+\"[^\"]*\")?\)", blank, text)
    return re.sub(r"<[^<>\s][^<>]*>|https?://\S+", blank, text)


def document_passages(path, text):
    passages, open_passage, fence, comment = [], None, None, False
    lines = text.splitlines()

    def close():
        nonlocal open_passage
        if open_passage is not None:
            passages.append(open_passage)
        open_passage = None

    before_blank = True
    for number, raw in enumerate(lines, 1):
        line = raw.strip()
        mark = re.match(r"(`{3,}|~{3,})", line)
        if fence:
            if mark and line.startswith(fence) and not line.strip("`~"):
                fence = None
            continue
        if mark:
            close()
            fence = mark.group(1)
            continue
        if comment or line.startswith("<!--"):
            close()
            comment = "-->" not in line
            continue
        indented = raw.startswith(("    ", "\t")) and open_passage is None and before_blank
        if not line:
            close()
            before_blank = True
            continue
        if indented and not in_list(passages, raw):
            continue
        before_blank = False
        if line.startswith(">"):
            close()
        elif line.startswith("#"):
            close()
            heading = Passage(path, "heading")
            heading.add(number, line.lstrip("#"))
            passages.append(heading)
        elif line.startswith("|"):
            close()
            kind = "table head" if number < len(lines) and re.fullmatch(r"[\s|:-]+", lines[number]) else "cell"
            if not re.fullmatch(r"[\s|:-]+", line):
                for cell in re.split(r"(?<!\\)\|", without_quotations(line).strip("|")):
                    entry = Passage(path, kind)
                    entry.add(number, cell)
                    passages.append(entry)
        else:
            item = re.match(r"(?:[-*+]|\d+[.)])\s+", line)
            if item:
                close()
                line = line[item.end():]
            if open_passage is None:
                open_passage = Passage(path, "item" if item else "text")
            open_passage.add(number, line)
    close()
    return passages


def in_list(passages, raw):
    """Whether an indented line continues a list item (not more than one code block's indent further in)."""
    return bool(passages) and passages[-1].kind == "item" and not raw.startswith("        ")


RUST_TOKENS = re.compile(
    r"""(?P<comment>//[^\n]*)|(?P<block>/\*)"""
    r"""|(?P<raw>\b(?:b|c)?r(?P<hashes>\#*)"(?P<rawtext>.*?)"(?P=hashes))"""
    r"""|(?P<string>(?:\b[bc])?"(?P<stringtext>(?:\\.|[^"\\])*)")"""
    r"""|(?P<char>(?:\bb)?'(?:\\(?:u\{[^}]*\}|x..|.)|[^'\\\n])')|[A-Za-z_]\w*""",
    re.DOTALL,
)


def rust_passages(path, text):
    newlines = [m.start() for m in re.finditer("\n", text)]
    passages, comment, fenced = [], None, False
    last_line = -1
    position = 0
    while True:
        token = RUST_TOKENS.search(text, position)
        if token is None:
            break
        position = token.end()
        line = bisect.bisect_left(newlines, token.start()) + 1
        if token.group("block"):
            end = text.find("*/", position)
            position = len(text) if end < 0 else end + 2
            block = Passage(path, "comment")
            for extra, part in enumerate(text[token.end():position - 2].split("\n")):
                block.add(line + extra, part.strip().lstrip("*!"))
            passages.append(block)
        elif token.group("comment"):
            marker = re.match(r"//[/!]?", token.group()).group()
            body = token.group()[len(marker):]
            if comment is not None and (line != last_line + 1 or comment.marker != marker):
                comment, fenced = None, False
            last_line = line
            if text[text.rfind("\n", 0, token.start()) + 1:token.start()].strip():
                comment = None
            if body.strip().startswith("```"):
                fenced = not fenced
                comment = None
                if not fenced:
                    continue
            if fenced:
                comment = Passage(path, "code")
                comment.marker = marker
                continue
            heading = marker != "//" and re.match(r"\s*#+\s", body)
            if not body.strip() or heading or re.match(r"\s*(?:[-*]|\d+\.|\|)\s", body) or body.startswith("     "):
                comment = None
            if not body.strip() or heading or body.startswith("     "):
                continue
            if comment is None:
                comment = Passage(path, "comment")
                comment.marker = marker
                passages.append(comment)
            comment.add(line, re.sub(r"^\s*(?:[-*]|\d+\.|\|)\s", "", body))
        elif token.group("string") or token.group("raw"):
            literal = Passage(path, "literal")
            content = token.group("stringtext") if token.group("string") else token.group("rawtext")
            for extra, part in enumerate(content.split("\n")):
                literal.add(line + extra, part.replace("\\n", "  ").rstrip("\\"))
            if " " in literal.text:
                passages.append(literal)
    return passages


def python_passages(path, text):
    """Comments and docstrings of Python; strings that stand alone are docstrings."""
    passages, before, alone = [], None, True
    try:
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    except (tokenize.TokenError, SyntaxError):
        return passages
    for token in tokens:
        if token.type == tokenize.COMMENT:
            if before is None or token.start[0] != before.lines[-1] + 1 or token.line[:token.start[1]].strip():
                before = Passage(path, "comment")
                passages.append(before)
            before.add(token.start[0], token.string.lstrip("#!"))
        elif token.type == tokenize.STRING and alone:
            paragraph = None
            for extra, line in enumerate(token.string.strip("rRbBuUfF").strip("\"'").splitlines()):
                if not line.strip():
                    paragraph = None
                    continue
                if paragraph is None:
                    paragraph = Passage(path, "comment")
                    passages.append(paragraph)
                paragraph.add(token.start[0] + extra, line)
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            alone = token.type in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING)
    return passages


JSON_TOKENS = re.compile(r"""(?P<string>"(?:\\.|[^"\\\n])*")|(?P<comment>//[^\n]*)""")


def json_passages(path, text):
    """Comments of JSON files, which `zelus describe` prints: whole lines in a row are one passage."""
    passages, before = [], None
    for number, line in enumerate(text.splitlines(), 1):
        comments = [token for token in JSON_TOKENS.finditer(line) if token.group("comment")]
        if not comments:
            before = None
            continue
        whole = line.lstrip().startswith("//")
        if before is None or not whole:
            before = Passage(path, "comment")
            passages.append(before)
        before.add(number, comments[0].group("comment").lstrip("/"))
        if not whole:
            before = None
    return passages


def sentences(text):
    """Offset and text of each sentence."""
    begin = 0
    for stop in re.finditer(r"[.!?][\x00)\]*_”\"]*(?=" + BEGINNING + ")", text):
        if ABBREVIATIONS.search(text[begin:stop.start() + 1]):
            continue
        yield trimmed(begin, text[begin:stop.end()])
        begin = stop.end()
    yield trimmed(begin, text[begin:])


def trimmed(begin, sentence):
    skipped = len(sentence) - len(sentence.lstrip(" \x00*_([\"“"))
    return begin + skipped, sentence[skipped:]


# ---------------------------------------------------------------------------------------------------------------------------------
# Checks

def check_banned(passage, rules):
    text = passage.text if passage.kind == "literal" else without_quotations(passage.text)
    for pattern, remedy in rules.banned:
        for match in pattern.finditer(text):
            place = passage.line(match.start())
            yield Finding("banned", passage.path, place, f"“{match.group()}” is no term of the field", f"write {remedy}", passage.text)


def check_openings(passage):
    if passage.kind in ("heading", "table head", "literal"):
        return
    text = without_quotations(passage.text)
    for begin, sentence in sentences(text):
        first = begin == 0 and passage.kind == "comment"
        if (FIRST if first else OPENING).match(sentence) and not sentence.rstrip().endswith("?"):
            fact = f"a sentence opens with “{' '.join(sentence.split()[:3])}”".replace("\x00", "")
            yield Finding("opening", passage.path, passage.line(begin), fact, "open it with a noun of the field", sentence)


def check_length(passage, longest):
    if passage.kind not in ("text", "item"):
        return
    text = without_targets(without_quotations(passage.text))
    for begin, sentence in sentences(text):
        words = re.findall(r"[^\W\d_][\w'’./-]*", sentence.replace("\x00", ""))
        if len(words) > longest:
            fact = f"a sentence of {len(words)} words: “{' '.join(words[:5])} …”"
            yield Finding("length", passage.path, passage.line(begin), fact, f"split it: at most {longest} words, better 25", sentence)


def anchors(text):
    """Names of headings as GitHub and mdBook make them."""
    names, fence = set(), False
    for line in text.splitlines():
        if line.startswith("```"):
            fence = not fence
        heading = None if fence else re.match(r"#{1,6}\s+(.*)", line)
        if heading:
            words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1)).strip().lower()
            name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
            number, unique = 0, name
            while unique in names:
                number += 1
                unique = f"{name}-{number}"
            names.add(unique)
        names.update(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", line))
    return names


def links(text):
    """Line, page and anchor of each link that stays within the repository."""
    fence = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fence = not fence
        if fence:
            continue
        for target in re.findall(r"\]\(<?([^)>\s]+)>?(?:\s+\"[^\"]*\")?\)", re.sub(r"`[^`]*`", "", line)):
            if "://" not in target and not target.startswith("mailto:"):
                page, _, anchor = target.partition("#")
                yield number, page, anchor


def check_links(root, documents):
    known = {}
    for path, text in documents.items():
        for line, page, anchor in links(text):
            target = (root / path).parent / page if page else root / path
            if not target.exists():
                yield Finding("link", path, line, f"the link to {page} leads nowhere", "correct or remove it", page)
            elif anchor and target.suffix == ".md":
                target = target.resolve()
                if target not in known:
                    known[target] = anchors(target.read_text(encoding="utf-8"))
                if anchor not in known[target]:
                    fact = f"{page or path} has no heading #{anchor}"
                    yield Finding("link", path, line, fact, "correct the anchor", anchor)


def contains(text, term):
    """Whether the text has the term, in any case, singular or plural, with spaces or hyphens."""
    pattern = re.escape(term).replace(r"\ ", r"[\s-]+").replace(r"\-", r"[\s-]")
    pattern = re.sub("y$", "(?:y|ies)", pattern)
    return re.search(rf"\b{pattern}", text, re.IGNORECASE) is not None


def check_index(root, path, terms):
    """Terms of each row on a page of that row; a row for each of the standard `terms`."""
    index = root / path
    if not index.exists():
        yield Finding("index", path, 1, "there is no index of terms", "add one", "")
        return
    listed = []
    for number, line in enumerate(index.read_text(encoding="utf-8").splitlines(), 1):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|") or len(cells) != 2 or "](" not in cells[1]:
            continue
        linked = []
        for _, page, _ in links(cells[1]):
            target = index.parent / page
            if target.exists():
                linked.append(target.read_text(encoding="utf-8"))
        listed += cells[0].split(", ")
        for term in cells[0].split(", "):
            if not any(contains(text, term) for text in linked):
                fact = f"no page of this row contains “{term}”"
                yield Finding("index", path, number, fact, "write the term there, or link another page", term)
    for term in terms:
        if not any(contains(entry, term) for entry in listed):
            fact = f"no row of the index has the standard term “{term}”"
            yield Finding("index", path, 1, fact, "add the term with the page that treats it", term)


def check_reach(documents, first):
    """Pages in the folder of the first page, to which its links must lead; but for mdBook's table of contents."""
    folder, reached, pending = Path(first).parent, {first}, [first]
    while pending:
        path = pending.pop()
        for _, page, _ in links(documents.get(path, "")):
            target = Path(os.path.normpath(Path(path).parent / page)).as_posix()
            if target in documents and target not in reached:
                reached.add(target)
                pending.append(target)
    for path in documents:
        if folder in Path(path).parents and path not in reached and Path(path).name != "SUMMARY.md":
            yield Finding("index", path, 1, f"no link from {first} leads to this page", "link it there", "")


def has_speller():
    return any(shutil.which(program) for program in ("codespell", "typos"))


def spoken(passages):
    """Lines of a file with its sentences alone: no code, no quotations, no literals that are names or inputs."""
    lines = {}
    for passage in passages:
        text = without_targets(without_quotations(passage.text))
        if passage.kind == "literal" and len(re.findall(r"[a-z]{2,}", text)) < 5:
            continue
        for at, line in enumerate(passage.lines):
            end = passage.offsets[at + 1] if at + 1 < len(passage.lines) else len(text)
            words = text[passage.offsets[at]:end].replace("\x00", " ").strip()
            lines[line] = f"{lines.get(line, '')} {words}".strip()
    return "\n".join(lines.get(number, "") for number in range(1, max(lines, default=0) + 1)) + "\n"


def check_spelling(passages_of, accepted):
    """Findings of codespell or typos in the sentences of the files; `passages_of` by path."""
    if shutil.which("codespell"):
        command = ["codespell", "--quiet-level=2", "--ignore-words-list=" + ",".join(accepted), "."]
        pattern = re.compile(r"(?:\./)?(?P<path>.+?):(?P<line>\d+): (?P<word>\S+) ==> (?P<better>.+)")
    elif shutil.which("typos"):
        command = ["typos", "--format=brief", "."]
        pattern = re.compile(r"(?:\./)?(?P<path>.+?):(?P<line>\d+):\d+: (?:error: )?`(?P<word>[^`]+)` (?:->|should be) (?P<better>.+)")
    else:
        return
    with tempfile.TemporaryDirectory() as folder:
        for path, passages in passages_of.items():
            copy = Path(folder) / f"{path}.txt"
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(spoken(passages), encoding="utf-8")
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    for line in run.stdout.splitlines():
        match = pattern.match(line)
        if match and match["word"].lower() not in accepted:
            path = match["path"].removesuffix(".txt")
            fact = f"“{match['word']}” is misspelt"
            yield Finding("spelling", path, int(match["line"]), fact, f"write {match['better']}", match["word"])


# ---------------------------------------------------------------------------------------------------------------------------------

READERS = {".rs": rust_passages, ".py": python_passages, ".json": json_passages}


def files(root, ending):
    found, pending = [], [root]
    while pending:
        for path in pending.pop().iterdir():
            if path.is_dir():
                if not path.name.startswith(".") and path.name not in SKIPPED_FOLDERS and not path.is_symlink():
                    pending.append(path)
            elif path.name.endswith(ending):
                found.append(path.relative_to(root).as_posix())
    return sorted(found)


def findings(root, rules, rules_path, index="docs/user-guide.md", first="docs/README.md"):
    documents = {path: (root / path).read_text(encoding="utf-8") for path in files(root, ".md")}
    sources = files(root, ".rs") + files(root, ".py") + [path for path in files(root, ".json") if path.startswith("configs/")]
    passages_of = {path: document_passages(path, text) for path, text in documents.items()}
    for path in sources:
        read = READERS[Path(path).suffix]
        passages_of[path] = read(path, (root / path).read_text(encoding="utf-8"))
    every = []
    for path, passages in passages_of.items():
        for passage in passages:
            every += check_banned(passage, rules)
            every += check_openings(passage)
            if path in documents:
                every += check_length(passage, rules.longest)
    every += check_links(root, documents)
    every += check_index(root, index, rules.terms)
    every += check_reach(documents, first)
    every += check_spelling(passages_of, rules.spelling)
    used, kept = set(), []
    for finding in every:
        excused = [e for e in rules.exceptions if e[0] == finding.path and e[1] == finding.kind and e[2] in finding.text]
        used.update(excused)
        if not excused:
            kept.append(finding)
    for exception in rules.exceptions:
        if exception not in used and exception[1] != "spelling":
            kept.append(Finding("exception", rules_path, 1, f"nothing needs the exception “{exception[2]}”", "remove it", ""))
    return kept


PLANTED = {
    "docs/page.md": """# What a heading may say

Nothing here finds no rest. What follows is wrong. “What is quoted, is right.” `What` is code.

> What a quotation says counts for nothing.

    What code says counts for nothing.

This sentence goes on and on and on and on and on and on and on and on and on and on and on and on and on and on and on and on
and on and on and on, until it has far too many words.

See [a page](gone.md), [a heading](#gone), [this one](#what-a-heading-may-say) and [the index](index.md).
""",
    "docs/index.md": """# Index

| term | page |
|---|---|
| heading, boundary condition | [page](page.md) |
""",
    "docs/lost.md": "# A page to which nothing leads\n",
    "configs/object.json": """// An object.
// What it is for.
{
    "key": "// What a value says", // the key; what it is
    "other": 1 // Bodies by turns
}
""",
    "tool.py": """'''What a module is.

By turns it is another.'''
WORDS = "What a string says"  # Whose comment this is
""",
    "src/lib.rs": """//! A crate.

/// What an item is, `by turns`.
pub const A: &str = "contact finds no rest \\"here\\"";
// The value of it. Whose second sentence
// opens wrongly.
///
/// # Errors
/// What is no number.
pub const B: char = '"';
/// Those of a body. Those of another follow.
pub const D: char = ' ';
/// Bodies that find
/// no rest.
pub const C: &str = r#"What a "literal" says"#; // Of which this is wrong.
""",
}
EXPECTED = {
    ("banned", "docs/page.md", 3),
    ("opening", "docs/page.md", 3),
    ("length", "docs/page.md", 9),
    ("link", "docs/page.md", 12),
    ("index", "docs/index.md", 5),
    ("index", "docs/index.md", 1),
    ("index", "docs/lost.md", 1),
    ("opening", "configs/object.json", 2),
    ("banned", "configs/object.json", 5),
    ("opening", "tool.py", 1),
    ("banned", "tool.py", 3),
    ("opening", "tool.py", 4),
    ("opening", "src/lib.rs", 3),
    ("banned", "src/lib.rs", 4),
    ("opening", "src/lib.rs", 5),
    ("opening", "src/lib.rs", 9),
    ("opening", "src/lib.rs", 11),
    ("banned", "src/lib.rs", 13),
    ("opening", "src/lib.rs", 15),
    ("exception", "words.txt", 1),
}
PLANTED_RULES = """[longest sentence]
35
[banned]
finds? no rest => does not settle
by turns => staggered
[terms]
time step
[exceptions]
docs/page.md | banned | nowhere | a needless one
"""


def self_test():
    """Plants a fault of each kind and expects each to be found, and nothing else."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for path, text in PLANTED.items():
            (root / path).parent.mkdir(exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        (root / "words.txt").write_text(PLANTED_RULES, encoding="utf-8")
        found = findings(root, read_rules(root / "words.txt"), "words.txt", "docs/index.md", "docs/index.md")
        kinds = [(f.kind, f.path, f.line) for f in found if f.kind != "spelling"]
    missed, surplus = EXPECTED - set(kinds), set(kinds) - EXPECTED
    for kind, path, line in sorted(missed):
        print(f"self-test: the fault “{kind}” in line {line} of {path} is not found")
    for kind, path, line in sorted(surplus):
        print(f"self-test: “{kind}” is found in line {line} of {path}, where no fault is")
    if kinds.count(("link", "docs/page.md", 12)) != 2:
        print("self-test: of a page and a heading that are gone, one is not found")
        missed.add("link")
    return not missed and not surplus


def main():
    parser = argparse.ArgumentParser(description="Checks documents, comments and messages for plain words of the field.")
    parser.add_argument("--self-test", action="store_true", help="find a planted fault of each kind")
    parser.add_argument("--list", metavar="KIND", help="print the findings of one kind only")
    arguments = parser.parse_args()
    if arguments.self_test:
        sys.exit(0 if self_test() else 1)
    root = Path(__file__).resolve().parent.parent
    if not has_speller():
        print("skipped: spelling, which needs codespell (pip install codespell) or typos (cargo install typos-cli)")
    found = findings(root, read_rules(root / "scripts/words.txt"), "scripts/words.txt")
    if arguments.list:
        found = [finding for finding in found if finding.kind == arguments.list]
    for finding in found:
        print(finding)
    if found:
        print(f"{len(found)} findings; scripts/words.txt holds the rules and their exceptions", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
