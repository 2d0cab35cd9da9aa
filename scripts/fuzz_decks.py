#!/usr/bin/env python3
"""Runs decks with random mistakes: each must end in words, with an exit code of the guide, and in time.

    scripts/fuzz_decks.py target/release/zelus --seconds 1200 --seed 1 --jobs 2 DECK_FOLDER...

Without folders, those of tests/cases and examples whose meshes are small. A run that lasts longer than `--patience` is asked to stop
(SIGTERM) and must do so with exit code 5 after the step under way. Failed decks are kept in `--keep`, with the output.
"""

import argparse
import concurrent.futures
import copy
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CODES = {0, 2, 3, 4, 5}
STRANGE = [None, True, False, 0, -1, 1, 2, 3, 7, 1e-300, 1e300, -1e300, 1e-3, 10**12, -(10**12), 0.5, "", "0", "x", "t", "1/t", "1/0",
           "sin(", "Structure", "Structure.Nothing", "DISPLACEMENT", "DISPLACEMENT_X", "End", "none", [], [[]], [0], [0.0, 1.0],
           [0.0, "End"], [1.0, 0.0], {}, {"name": "csv_table", "filename": "mesh.mdpa"}, "é" * 200, "../../etc"]
WORDS = ["0", "-1", "1", "7", "99999999", "4294967295", "4294967296", "1e300", "-1e300", "nan", "inf", "1e-320", "Begin", "End", "Begin Nodes",
         "End Nodes", "//", "/*", "[3]", "(1,2", "x", "Elements", "SubModelPart", "é"]
MOST_MESH = 200_000
MEMORY = 6 << 30


def places(node, path=()):
    """Paths of all values of a JSON document."""
    yield path
    members = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in members:
        yield from places(value, path + (key,))


def at(node, path):
    for key in path:
        node = node[key]
    return node


def mutate_json(text, dice):
    """Changes a value or key of a document, or else some of its bytes."""
    if dice.random() < 0.1:
        return mutate_bytes(text, dice)
    document = json.loads(text)
    for _ in range(dice.choice([1, 1, 1, 2, 4])):
        path = dice.choice([path for path in places(document) if path] or [()])
        if not path:
            break
        owner, key = at(document, path[:-1]), path[-1]
        what = dice.randrange(6)
        if what == 0:
            del owner[key]
        elif what == 1 and isinstance(owner, dict):
            owner[dice.choice([key + "s", "_" + key, key[:-1]])] = owner.pop(key)
        elif what == 2:
            owner[key] = copy.deepcopy(at(document, dice.choice(list(places(document)))))
        elif what == 3 and isinstance(owner, list):
            owner.insert(key, copy.deepcopy(owner[key]))
        elif what == 4 and isinstance(owner[key], (int, float)) and not isinstance(owner[key], bool):
            owner[key] = owner[key] * dice.choice([-1, 0, 1e-6, 1e6, 1.1, 0.9, 1e30])
        else:
            owner[key] = copy.deepcopy(dice.choice(STRANGE))
    return json.dumps(document, indent=1)


def mutate_mesh(text, dice):
    """Changes words, lines or bytes of a mesh."""
    if dice.random() < 0.1:
        return mutate_bytes(text, dice)
    lines = text.split("\n")
    for _ in range(dice.choice([1, 1, 2, 5])):
        row = dice.randrange(len(lines))
        what = dice.randrange(6)
        if what == 0:
            lines[row] = ""
        elif what == 1:
            lines.insert(row, lines[dice.randrange(len(lines))])
        elif what == 2:
            other = dice.randrange(len(lines))
            lines[row], lines[other] = lines[other], lines[row]
        elif what == 3 and dice.random() < 0.2:
            lines = lines[: row + 1]
        else:
            words = lines[row].split(" ")
            words[dice.randrange(len(words))] = dice.choice(WORDS)
            lines[row] = " ".join(words)
    return "\n".join(lines)


def mutate_bytes(text, dice):
    content = bytearray(text.encode())
    for _ in range(dice.choice([1, 3, 10])):
        content[dice.randrange(len(content))] = dice.randrange(256)
    return bytes(content)


def mutate(folder, dice):
    """Makes mistakes in one or two files of a deck."""
    files = [path for path in sorted(folder.rglob("*")) if path.suffix in (".json", ".mdpa", ".csv")]
    files = [path for path in files if path.name not in ("case.json", "expected.json") and path.stat().st_size < MOST_MESH]
    weights = [6 if path.name == "ProjectParameters.json" else 2 for path in files]
    for path in dice.choices(files, weights, k=dice.choice([1, 1, 2])):
        text = path.read_bytes().decode(errors="replace")
        try:
            text = mutate_json(text, dice) if path.suffix == ".json" else mutate_mesh(text, dice)
        except (json.JSONDecodeError, RecursionError):
            text = mutate_bytes(text, dice)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def judge(program, deck, seed, patience, keep):
    """Faults of the answer to a deck with mistakes; nothing where all is well."""
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "deck"
        shutil.copytree(deck, folder)
        mutate(folder, dice)
        command = dice.choice(["check", "run", "run", "run"])
        words = [program, command, "ProjectParameters.json"] + (["--threads", "1", "-q"] if command == "run" else [])
        environment = {**os.environ, "NO_COLOR": "1"}
        with open(folder / "said.txt", "wb") as said:
            process = subprocess.Popen(words, cwd=folder, stdout=said, stderr=said, env=environment, preexec_fn=limit)
            stopped = hangs = False
            try:
                process.wait(patience)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGTERM)
                stopped = True
                try:
                    process.wait(patience)
                except subprocess.TimeoutExpired:
                    hangs = True
                    process.kill()
                    process.wait()
        text = (folder / "said.txt").read_text(errors="replace")
        code = process.returncode
        wrong = None
        if hangs:
            wrong = "does not stop"
        elif code not in CODES or "panicked" in text:
            wrong = f"ends with {code}" if "memory allocation" not in text else None
        elif stopped and command == "check":
            wrong = "check takes too long"
        elif code in (2, 3, 4) and "error[" not in text:
            wrong = f"ends with {code} and says no error"
        if wrong:
            kept = keep / f"{deck.name}-{seed}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
        return deck, seed, command, code, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("decks", type=pathlib.Path, nargs="*")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--patience", type=float, default=20)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "zelus-fuzz")
    options = parser.parse_args()
    folders = options.decks or [ROOT / "tests/cases", ROOT / "examples"]
    decks = sorted(path.parent for folder in folders for path in folder.rglob("ProjectParameters.json"))
    small = lambda deck: all(mesh.stat().st_size < MOST_MESH for mesh in deck.rglob("*.mdpa"))
    decks = [deck for deck in decks if small(deck)]
    options.keep.mkdir(parents=True, exist_ok=True)
    program, end, seed = options.program.resolve(), time.monotonic() + options.seconds, options.seed * 1_000_000
    codes, wrong, pending = {}, 0, set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        while pending or time.monotonic() < end:
            while len(pending) < 2 * options.jobs and time.monotonic() < end:
                deck = random.Random(seed).choice(decks)
                pending.add(pool.submit(judge, program, deck, seed, options.patience, options.keep))
                seed += 1
            done, pending = concurrent.futures.wait(pending, return_when=concurrent.futures.FIRST_COMPLETED)
            for deck, number, command, code, why in (future.result() for future in done):
                codes[code] = codes.get(code, 0) + 1
                if why:
                    wrong += 1
                    print(f"{deck} {number} ({command}): {why}", flush=True)
    print(f"{sum(codes.values())} decks of {len(decks)}; exit codes {dict(sorted(codes.items()))}; {wrong} wrong")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
