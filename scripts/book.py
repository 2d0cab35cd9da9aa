#!/usr/bin/env python3
"""Makes the book of docs/ with mdBook: target/book/index.html.

    cargo build --release
    scripts/book.py [--program PATH] [--mdbook PATH]

A page that lists every registered object with its settings and an example is written from `zelus list` and `zelus describe`. Links that
lead out of docs/ become the names of the files. mdBook is taken from the path, or from --mdbook; `cargo install mdbook` gets it. Without it
the sources of the book are made, and the exit status is 3."""
import argparse, os, re, shutil, subprocess, sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCES = os.path.join(ROOT, "target", "book-sources")


def objects(program):
    """A page of every registered object."""
    say = lambda *words: subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout
    page, kind = ["# Every registered object\n", "Names that decks, meshes and materials may use, as `zelus describe NAME` prints them.\n"], ""
    shown = set()
    for line in say("list", "all").splitlines():
        if not line.startswith(" "):
            kind = line.split(" (")[0]
            page.append(f"## {kind}\n")
            continue
        name, about = re.match(r"  ([^ :]+)(.*)", line).groups()
        if kind in ("element", "condition", "variable", "constitutive_law"):
            page.append(f"- `{name}`{about}\n")
        elif name not in shown:
            shown.add(name)
            page += [f"### {name}\n", "```text", say("describe", name).rstrip(), "```\n"]
    return "\n".join(page)


def inside(text, folder):
    """The text with links out of the folder of pages as names of files."""
    docs = os.path.join(ROOT, "docs")

    def link(match):
        words, target = match.groups()
        path = os.path.normpath(os.path.join(folder, target.split("#")[0]))
        if "://" in target or target.startswith("#") or path.startswith(docs):
            return match.group(0)
        return f"{words} (`{os.path.relpath(path, ROOT)}`)"

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "zelus"))
    parser.add_argument("--mdbook", default=shutil.which("mdbook") or "")
    options = parser.parse_args()
    shutil.rmtree(SOURCES, ignore_errors=True)
    shutil.copytree(os.path.join(ROOT, "docs"), os.path.join(SOURCES, "docs"))
    shutil.copy(os.path.join(ROOT, "book.toml"), SOURCES)
    for folder, _, files in os.walk(os.path.join(SOURCES, "docs")):
        for name in (name for name in files if name.endswith(".md")):
            path = os.path.join(folder, name)
            with open(path) as file:
                text = file.read()
            original = os.path.join(ROOT, os.path.relpath(folder, SOURCES))
            with open(path, "w") as file:
                file.write(inside(text, original))
    with open(os.path.join(SOURCES, "docs", "objects.md"), "w") as file:
        file.write(objects(os.path.abspath(options.program)))
    summary = os.path.join(SOURCES, "docs", "SUMMARY.md")
    with open(summary) as file:
        text = file.read()
    with open(summary, "w") as file:
        file.write(text.replace("- [Python](python.md)\n", "- [Every registered object](objects.md)\n- [Python](python.md)\n"))
    if not options.mdbook:
        print(f"mdbook is missing: the sources of the book are in {SOURCES}")
        sys.exit(3)
    book = os.path.join(ROOT, "target", "book")
    subprocess.run([options.mdbook, "build", SOURCES, "--dest-dir", book], check=True)
    print(os.path.join(book, "index.html"))


if __name__ == "__main__":
    main()
