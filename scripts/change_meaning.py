#!/usr/bin/env python3
"""Changes the meaning of decks, and checks that the program says so.

    scripts/change_meaning.py target/release/zelus --seconds 600 --seed 1 [--only NAME] [--list] DECK_FOLDER...

Each mutator states an expectation:

    refused  the run ends with an error that names the key, part or variable
    told     a warning or an error names it, unless the mutator may be harmless and results stay
    same     results stay, to 1e-9 of the largest, without a further warning
    scaled   results change by a known factor, without a further warning

Mutators of settings are made from configs/*.json; those of materials, processes and meshes are written below. A violation is one line:

    silent       nothing is said and results differ
    ignored      nothing is said, results stay, and the setting is wrong
    unnamed      a message comes that does not name the key, part or variable
    accepted     a warning where the run should be refused
    unchecked    `run` refuses a deck that `check` accepts
    changed      results differ that should stay or scale
    false-alarm  a warning without a reason
    failed       an error without a reason
    broken       no exit code of the guide, or the run does not end

Decks are those of tests/cases and examples whose meshes are small, unless folders are named. The decks with violations are kept
in `--keep`, with the output and the claim. One run at a time, on one thread.
"""

import argparse
import copy
import dataclasses
import json
import math
import os
import pathlib
import pickle
import random
import re
import shutil
import subprocess
import tempfile
import time
import typing

from fuzz_decks import MOST_MESH, ROOT, limit

DECK = "ProjectParameters.json"
SAME = 1e-9
OBSERVED = "observed_{}.json"
NONSENSE = "Nonsense"
HEAT = {"stationary", "transient"}
CONTACT = re.compile(r"(alm|penalty|nitsche|uzawa|perturbed_lagrangian|explicit_penalty|mpc)_contact_process$")
STRESSES = {
    "YOUNG_MODULUS",
    "YIELD_STRESS",
    "ISOTROPIC_HARDENING_MODULUS",
    "HARDENING_MODULUS_1D",
    "TRESCA_FRICTION_THRESHOLD",
    "DENSITY",
    "ADHESION",
}
LOADS = {"LINE_LOAD", "SURFACE_LOAD", "POINT_LOAD", "POSITIVE_FACE_PRESSURE", "NEGATIVE_FACE_PRESSURE"}
# Processes of output that are added to decks that have none.
ADDED = {"vtu_output_process", "vtk_output_process", "gid_output_process", "json_output_process", "save_restart_process"}
# Keys whose words are free: names of files, parts and texts.
FREE = re.compile(r"help|name|path|prefix|postfix|folder|files?$|directory|variable|flag|_dofs|label|comment|model_part|title", re.I)


# Decks -----------------------------------------------------------------------------------------------------------------


def without_comments(text):
    """A JSON text without its // comments."""
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*', lambda found: found.group(1) or "", text)


@dataclasses.dataclass
class Part:
    """A sub model part of a mesh: lists of ids by kind, further lines, and its own parts."""

    name: str
    lists: dict
    parts: list
    rest: list

    def whole(self, above=""):
        """All parts below and this one, with their paths."""
        path = f"{above}.{self.name}" if above else self.name
        yield path, self
        for part in self.parts:
            yield from part.whole(path)


class Mesh:
    """An mdpa file: blocks of rows of words, and sub model parts."""

    def __init__(self, text):
        self.blocks, self.parts = [], []
        lines = [line.split("//")[0].split() for line in text.split("\n")]
        rows = iter([words for words in lines if words])
        for words in rows:
            if words[:2] == ["Begin", "SubModelPart"]:
                self.parts.append(self.read_part(words[2], rows))
            elif words[0] == "Begin":
                kind, own = words[1], []
                for row in rows:
                    if row[0] == "End" and row[1] == kind:
                        break
                    own.append(row)
                self.blocks.append([kind, words[2:], own])

    def read_part(self, name, rows):
        part = Part(name, {}, [], [])
        for words in rows:
            if words[:2] == ["End", "SubModelPart"]:
                break
            if words[:2] == ["Begin", "SubModelPart"]:
                part.parts.append(self.read_part(words[2], rows))
            elif words[0] == "Begin":
                own = []
                for row in rows:
                    if row[0] == "End":
                        break
                    own += row
                part.lists[words[1].removeprefix("SubModelPart")] = own
        return part

    def of(self, kind):
        """Rows of all blocks of a kind."""
        return [row for block in self.blocks if block[0] == kind for row in block[2]]

    def named(self, path):
        """A part by its path below the root part."""
        return next((part for own in self.parts for place, part in own.whole() if place == path), None)

    def all_parts(self):
        return [found for part in self.parts for found in part.whole()]

    def is_plain(self):
        """Whether nodes, elements, conditions and parts are all there is."""
        return all(block[0] in ("Nodes", "Elements", "Conditions") or not block[2] for block in self.blocks)

    def text(self):
        out = []
        for kind, name, rows in self.blocks:
            out += [" ".join(["Begin", kind, *name]), *(" ".join(row) for row in rows), f"End {kind}", ""]

        def write(part):
            out.append(f"Begin SubModelPart {part.name}")
            for kind, ids in part.lists.items():
                out.extend([f"Begin SubModelPart{kind}", *ids, f"End SubModelPart{kind}"])
            for own in part.parts:
                write(own)
            out.append("End SubModelPart")

        for part in self.parts:
            write(part)
        return "\n".join(out) + "\n"


class Deck:
    """A deck in memory: settings, materials, mesh, and the arguments of a run."""

    def __init__(self, folder):
        self.folder = folder
        self.project = json.loads(without_comments((folder / DECK).read_text()))
        stages = self.project.get("stages")
        self.stages = [stage["stage_settings"] for stage in stages.values()] if stages else [self.project]
        self.materials, self.meshes, self.arguments, self.texts = {}, {}, [], {}
        for _, settings in self.solvers():
            name = settings.get("material_import_settings", {}).get("materials_filename")
            if name and (folder / name).exists():
                self.materials[name] = json.loads(without_comments((folder / name).read_text()))
            given = settings.get("model_import_settings", {})
            mesh = folder / (given.get("input_filename", "") + ".mdpa")
            if given.get("input_type") == "mdpa" and mesh.exists():
                self.meshes[mesh.name] = Mesh(mesh.read_text())
        self.mesh = next(iter(self.meshes.values())) if len(self.meshes) == 1 else None
        self.observed, self.size = self.roots(), self.extent()

    def solvers(self):
        """Settings of each solver with the name of their config."""
        for stage in self.stages:
            settings = stage.get("solver_settings", {})
            kind = settings.get("solver_type", "").lower()
            if kind == "thermomechanicallycoupled":
                yield "thermo_mechanically_coupled", settings
                for key in ("structural_solver_settings", "thermal_solver_settings"):
                    yield from self.solver(settings.get(key, {}))
            else:
                yield from self.solver(settings)

    def solver(self, settings):
        kind = settings.get("solver_type", "").lower()
        if kind == "dynamic" and settings.get("time_integration_method") == "explicit":
            kind = "explicit_dynamic"
        yield kind, settings
        for key in ("contact_settings", "mpc_contact_settings"):
            if isinstance(settings.get(key), dict):
                yield key, settings[key]

    def lists(self):
        for stage in self.stages:
            for key in ("processes", "output_processes"):
                for name, own in stage.get(key, {}).items():
                    if isinstance(own, list):
                        yield own
            # Decks of earlier versions have their lists at the top.
            yield from (own for name, own in stage.items() if name.endswith("process_list") and isinstance(own, list))

    def processes(self):
        return [process for own in self.lists() for process in own if isinstance(process, dict) and "Parameters" in process]

    def settings(self, config):
        """All settings of a config in this deck."""
        found = [settings for name, settings in self.solvers() if name == config]
        return found + [process["Parameters"] for process in self.processes() if process.get("python_module") == config]

    def roots(self):
        """Root parts with what is solved for."""
        return {own["model_part_name"]: kind for kind, own in self.solvers() if own.get("model_part_name")}

    def extent(self):
        """The longest edge of the box around the nodes."""
        rows = [row for mesh in self.meshes.values() for row in mesh.of("Nodes")]
        return (
            max((max(float(row[at]) for row in rows) - min(float(row[at]) for row in rows) for at in (1, 2, 3)), default=1.0)
            if rows
            else 1.0
        )

    def add(self, process):
        self.stages[-1].setdefault("processes", {}).setdefault("added_process_list", []).append(process)

    def variables(self):
        """Variables of each material."""
        return [
            item["Material"]["Variables"]
            for own in self.materials.values()
            for item in own.get("properties", [])
            if "Variables" in item.get("Material", {})
        ]

    def laws(self):
        return [
            item["Material"]["constitutive_law"]
            for own in self.materials.values()
            for item in own.get("properties", [])
            if "constitutive_law" in item.get("Material", {})
        ]

    def is_of_revolution(self):
        text = json.dumps([self.project, *self.materials.values()])
        names = [word for mesh in self.meshes.values() for block in mesh.blocks for word in block[1]]
        return "xisym" in text or any("xisym" in name for name in names)

    def write(self, folder):
        shutil.copytree(self.folder, folder, dirs_exist_ok=True)
        observed = copy.deepcopy(self.project)
        last = list(observed["stages"].values())[-1]["stage_settings"] if "stages" in observed else observed
        has_contact = any(CONTACT.search(str(process.get("python_module"))) for process in self.processes())
        for root, kind in self.observed.items():
            names = ["TEMPERATURE"] if kind in HEAT else ["DISPLACEMENT"] + ["CONTACT_PRESSURE"] * has_contact
            process = {
                "python_module": "json_output_process",
                "kratos_module": "KratosMultiphysics",
                "Parameters": {
                    "model_part_name": root,
                    "output_file_name": OBSERVED.format("heat" if kind in HEAT else "body"),
                    "output_variables": names,
                    "time_frequency": 0.0,
                },
            }
            if isinstance(last.setdefault("processes", {}), dict):
                last["processes"].setdefault("observed_process_list", []).append(process)
        (folder / DECK).write_text(json.dumps(observed, indent=1))
        for name, document in self.materials.items():
            (folder / name).write_text(json.dumps(document, indent=1))
        for name, mesh in self.meshes.items():
            (folder / name).write_text(mesh.text())
        for name, text in self.texts.items():
            (folder / name).write_text(text)


# Mutators --------------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Claim:
    """A claim about a changed deck: words of which a message has one, or the factors by which results change."""

    names: list = dataclasses.field(default_factory=list)
    factors: dict = dataclasses.field(default_factory=dict)
    nodes: dict | None = None
    turn: typing.Callable | None = None


@dataclasses.dataclass
class Mutator:
    name: str
    expects: str
    # The places of a deck where it applies; none where it does not.
    places: typing.Callable
    change: typing.Callable
    # Silence is right where results stay.
    harmless: bool = False
    # Number of decks to try in a round.
    decks: int = 6
    tolerance: float = SAME
    # A config that a deck must have.
    config: str = ""


MUTATORS = []


def mutator(name, expects, places, **more):
    def register(change):
        MUTATORS.append(Mutator(name, expects, places, change, **more))
        return change

    return register


def always(deck):
    return [deck.project]


def structural(deck):
    return [own for kind, own in deck.solvers() if kind in ("static", "dynamic")]


def implicit(deck):
    return [own for kind, own in deck.solvers() if kind in ("static", "dynamic", *HEAT)]


def of_module(pattern, also=lambda parameters: True):
    def places(deck):
        return [
            process["Parameters"]
            for process in deck.processes()
            if re.fullmatch(pattern, process.get("python_module", "")) and also(process["Parameters"])
        ]

    return places


contact = of_module(r"(alm|penalty|nitsche|uzawa|perturbed_lagrangian|explicit_penalty|mpc)_contact_process")
in_pairs = of_module(
    r".*_contact_process|mesh_tying_process|wear_process",
    lambda own: any(own.get(key) for key in ("contact_model_part", "mesh_tying_model_part")),
)
loads = of_module(r"assign_vector_by_direction.*|assign_(vector|scalar)_variable.*", lambda own: own.get("variable_name") in LOADS)
supports = of_module(
    r"assign_vector_variable_process|assign_scalar_variable_process", lambda own: str(own.get("variable_name")).startswith("DISPLACEMENT")
)
boundary = of_module(r"assign_.*")
outputs = of_module(r"json_output_process|v[tu][ku]_output_process")
anything = of_module(r".*", lambda own: "model_part_name" in own)


def pairs_key(own):
    return "mesh_tying_model_part" if "mesh_tying_model_part" in own else "contact_model_part"


def put(node, path, value):
    for key in path[:-1]:
        if not isinstance(node.get(key), dict):
            node[key] = {}
        node = node[key]
    node[path[-1]] = value


def get(node, path):
    for key in path:
        if not isinstance(node, dict) or key not in node:
            return None
        node = node[key]
    return node


def misspelt(word):
    """A word with two neighbouring letters exchanged."""
    for at in range(len(word) // 2, len(word) - 1):
        if word[at] != word[at + 1]:
            return word[:at] + word[at + 1] + word[at] + word[at + 2 :]
    return word + word[-1]


# Mutators of all settings, from configs


def keys_of(document, path=()):
    for key, value in document.items():
        if key.startswith("$"):
            continue
        yield path + (key,), value
        if isinstance(value, dict) and value:
            yield from keys_of(value, path + (key,))


def beyond(range_text):
    """Numbers just outside of a range, and far outside."""
    low, high = (float(word) for word in range_text[1:-1].split(","))
    out = []
    if low > -math.inf:
        out += [low if range_text[0] == "(" else low - 1e-3, low - 1e3]
    if high < math.inf:
        out += [high if range_text[-1] == ")" else high + 1e-3, high + 1e3]
    return out


def places_of(config, is_added, example):
    """The settings of a config in a deck; an output process is added to a deck that has none."""

    def places(deck):
        found = deck.settings(config)
        if found or not is_added:
            return found
        root = next(iter(deck.roots()), None)
        if root is None or deck.mesh is None or not deck.mesh.parts:
            return []
        own = copy.deepcopy(example)
        for key in ("model_part_name", "main_model_part_name"):
            if key in own:
                own[key] = root
        if "variable_name" in own or "output_variables" in own:
            is_heat = deck.roots()[root] in HEAT
            key = "variable_name" if "variable_name" in own else "output_variables"
            own[key] = (["TEMPERATURE"] if is_heat else ["DISPLACEMENT"])[:1] if key == "output_variables" else own[key]
        deck.add({"python_module": config, "kratos_module": "KratosMultiphysics", "Parameters": own})
        return [own]

    return places


def setting(name, expects, places, path, value, words, **more):
    def change(deck, own, dice):
        put(own, path, copy.deepcopy(value))
        return Claim(names=words)

    config = name.split("/")[1].split(".")[0]
    MUTATORS.append(Mutator(name, expects, places, change, decks=1, config="" if config in ADDED else config, **more))


def settings_of_configs():
    for path in sorted(ROOT.glob("configs/*/*.json")):
        if path.parent.name not in ("solvers", "processes"):
            continue
        config = path.stem
        document = json.loads(without_comments(path.read_text()))
        ranges = {key: range_text for range_text, keys in document.get("$ranges", {}).items() for key in keys}
        unused = {key for keys in document.get("$without_effect", {}).values() for key in keys}
        places = places_of(config, config in ADDED, document.get("$example", {}))
        for keys, default in keys_of(document):
            key, label = keys[-1], f"{config}.{'.'.join(keys)}"
            dotted = ".".join(keys)
            if keys == ("help",):
                continue

            # Settings that others override or that are taken whole from a deck have no default to spell out.
            def not_given(deck, config=config, keys=keys):
                return [own for own in deck.settings(config) if get(own, keys) is None]

            if not isinstance(default, dict) and default is not None and default not in ("", [], -1):
                setting(f"default/{label}", "same", not_given, keys, default, [])
            if len(keys) == 1:
                setting(f"misspelt/{label}", "told", places, (misspelt(key),), default, [misspelt(key)])
            if dotted in unused:
                other = not default if isinstance(default, bool) else default + 1 if isinstance(default, (int, float)) else None
                if other is not None:
                    setting(f"without-effect/{label}", "told", places, keys, other, [key])
                continue
            for number in beyond(ranges[dotted]) if dotted in ranges else []:
                setting(f"range/{label}={number:g}", "refused", places, keys, int(number) if number == int(number) else number, [key])
            if isinstance(default, bool):
                setting(f"type/{label}", "refused", places, keys, "yes", [key])
            elif isinstance(default, (int, float)):
                setting(f"type/{label}", "refused", places, keys, "many", [key])
                if dotted not in ranges and "interval" not in key:
                    setting(f"negative/{label}", "told", places, keys, -abs(default or 1), [key], harmless=True)
                    setting(f"zero/{label}", "told", places, keys, type(default)(0), [key], harmless=True)
                    setting(f"huge/{label}", "told", places, keys, 10**12 if isinstance(default, int) else 1e30, [key], harmless=True)
                if isinstance(default, int):
                    setting(f"fraction/{label}", "refused", places, keys, 1.5, [key])
            elif isinstance(default, str):
                setting(f"type/{label}", "refused", places, keys, 7, [key])
                if not FREE.search(key):
                    setting(f"choice/{label}", "refused", places, keys, NONSENSE, [NONSENSE, key])
                    if default:
                        setting(f"case/{label}", "told", not_given, keys, default.swapcase(), [key, default.swapcase()], harmless=True)
                elif "variable" in key or key.endswith("element_name") or key.endswith("condition_name"):
                    setting(f"name/{label}", "refused", places, keys, "NO_SUCH_VARIABLE", ["NO_SUCH_VARIABLE", key])
            elif isinstance(default, list):
                setting(f"type/{label}", "refused", places, keys, 7, [key])
                if key == "interval":
                    for value in ([2.0, 1.0], ["End", 0.0], [1e9, 2e9], [0.0], ["now", "End"]):
                        setting(f"interval/{label}={json.dumps(value)}", "told", places, keys, value, [key, "interval", "acts", "never"])
                elif not default:
                    setting(f"list/{label}", "refused", places, keys, [NONSENSE], [NONSENSE, key])
            elif isinstance(default, dict):
                setting(f"type/{label}", "refused", places, keys, [1], [key])
                if not default:
                    setting(f"inside/{label}", "told", places, keys + ("no_such_key",), 1, ["no_such_key"], harmless=False)


settings_of_configs()


# Time and problem data


def of_time(name, expects, path, value, words, **more):
    def change(deck, own, dice):
        for stage in deck.stages:
            put(stage, path, value)
        return Claim(names=words)

    MUTATORS.append(Mutator(f"time/{name}", expects, lambda deck: [deck.project] if len(deck.stages) == 1 else [], change, decks=3, **more))


def of_steps(name, expects, steps, words, **more):
    def change(deck, own, dice):
        for kind, settings in deck.solvers():
            if "time_stepping" in settings:
                settings["time_stepping"] = copy.deepcopy(steps)
        return Claim(names=words)

    MUTATORS.append(Mutator(f"steps/{name}", expects, implicit, change, decks=4, **more))


of_time("end-before-start", "refused", ("problem_data", "end_time"), -1.0, ["end_time"])
of_time("end-at-start", "told", ("problem_data", "end_time"), 0.0, ["end_time"])
of_time("start-after-end", "refused", ("problem_data", "start_time"), 1e15, ["end_time", "start_time"])
of_time("end-text", "refused", ("problem_data", "end_time"), "soon", ["end_time"])
of_time("end-null", "refused", ("problem_data", "end_time"), None, ["end_time"])
of_time("parallel-type", "refused", ("problem_data", "parallel_type"), NONSENSE, ["parallel_type"])
of_time("like", "refused", ("problem_data", "like"), NONSENSE, ["like", NONSENSE])
of_time("threads", "told", ("problem_data", "number_of_threads"), 4, ["number_of_threads"])
for wrong in (0, 0.0, -1, -0.1, 1e-300, "fast", None, [0.1], True, 1e300):
    of_steps(f"time_step={wrong}", "told" if wrong == 1e300 else "refused", {"time_step": wrong}, ["time_step"])
of_steps("none", "refused", {}, ["time_step"])
of_steps("unknown-key", "told", {"time_step": 1.0, "time_stp": 0.1}, ["time_stp"])
of_steps("table-empty", "refused", {"time_step_table": []}, ["time_step_table"])
of_steps("table-reversed", "refused", {"time_step_table": [[1.0, 0.1], [0.0, 0.2]]}, ["time_step_table"])
of_steps("table-negative", "refused", {"time_step_table": [[0.0, -0.1], [1.0, -0.1]]}, ["time_step_table"])
of_steps("table-zero", "refused", {"time_step_table": [[0.0, 0.0], [1.0, 0.0]]}, ["time_step_table"])
of_steps("table-columns", "refused", {"time_step_table": [[0.0], [1.0, 0.1, 7.0]]}, ["time_step_table"])
of_steps("both", "told", {"time_step": 1.0, "time_step_table": [[0.0, 0.5], [1e9, 0.5]]}, ["time_step"])
of_steps("intervals-empty", "refused", {"time_step_intervals": {}}, ["time_step_intervals"])
of_steps("intervals-gap", "refused", {"time_step_intervals": {"a": {"interval": [1e9, "End"], "time_step": 1.0}}}, ["time_step_intervals"])
of_steps(
    "intervals-overlap",
    "told",
    {"time_step_intervals": {"a": {"interval": [0.0, "End"], "time_step": 1.0}, "b": {"interval": [0.0, "End"], "time_step": 0.5}}},
    ["time_step_intervals", '"a"', '"b"'],
)
of_steps("last-step", "refused", {"time_step": 1.0, "last_step": NONSENSE}, ["last_step", NONSENSE])


@mutator(
    "steps/one-of-two-solvers",
    "told",
    lambda deck: [own for kind, own in deck.solvers() if kind in HEAT] if "coupled" in str(list(deck.solvers())).lower() else [],
)
def one_solver_has_other_steps(deck, own, dice):
    own["time_stepping"] = {"time_step": 1e-7}
    return Claim(names=["time_step"])


# Command line


def of_command(name, expects, arguments, words, **more):
    def change(deck, own, dice):
        deck.arguments = arguments
        return Claim(names=words)

    MUTATORS.append(Mutator(f"command/{name}", expects, always, change, decks=2, **more))


of_command("threads=-1", "refused", ["--threads", "-1"], ["threads"])
of_command("threads=0", "told", ["--threads", "0"], ["threads"])
of_command("threads=99999", "refused", ["--threads", "99999"], ["threads"])
of_command("like", "refused", ["--like", NONSENSE], [NONSENSE])
of_command("set-unknown-key", "refused", ["--set", "solver_settings.max_iterations=3"], ["max_iterations"])
of_command("set-unknown-section", "refused", ["--set", "solver.max_iteration=3"], ["solver"])
of_command("set-no-value", "refused", ["--set", "solver_settings.max_iteration"], ["max_iteration"])
of_command("set-text", "refused", ["--set", "solver_settings.max_iteration=many"], ["max_iteration"])
of_command("set-empty", "refused", ["--set", "problem_data.end_time="], ["end_time"])
of_command("sweep-missing", "refused", ["--sweep", "nothing.csv"], ["nothing.csv"])


# Sections and keys of a deck


@mutator("section/misspelt-solver", "refused", always)
def _(deck, own, dice):
    stage = deck.stages[0]
    stage["solver_setings"] = stage.pop("solver_settings")
    return Claim(names=["solver_settings"])


@mutator("section/misspelt-processes", "told", always)
def _(deck, own, dice):
    stage = deck.stages[0]
    if "processes" not in stage:
        return None
    stage["proceses"] = stage.pop("processes")
    return Claim(names=["proceses"])


@mutator("section/process-list-in-root", "told", lambda deck: [deck.project] if len(deck.stages) == 1 and loads(deck) else [])
def _(deck, own, dice):
    given = own.get("processes", {}).items()
    name = next((name for name, listed in given if any(process.get("Parameters") is loads(deck)[0] for process in listed)), None)
    if name is None:
        return None
    own["my_loads"] = own["processes"].pop(name)
    return Claim(names=["my_loads"])


@mutator("section/solver-key-in-problem-data", "told", implicit)
def _(deck, own, dice):
    deck.stages[0]["problem_data"]["max_iteration"] = 3
    return Claim(names=["max_iteration"])


@mutator("section/contact-key-in-solver", "told", lambda deck: structural(deck) if contact(deck) else [])
def _(deck, own, dice):
    own["contact_residual_relative_tolerance"] = 0.5
    return Claim(names=["contact_residual_relative_tolerance"])


@mutator("section/solver-key-in-contact-settings", "told", lambda deck: [own for kind, own in deck.solvers() if kind == "contact_settings"])
def _(deck, own, dice):
    own["max_iteration"] = 3
    return Claim(names=["max_iteration"])


@mutator("section/friction-in-contact-settings", "told", lambda deck: [own for kind, own in deck.solvers() if kind == "contact_settings"])
def _(deck, own, dice):
    own["friction_coefficients"] = {"0": 0.9}
    return Claim(names=["friction_coefficients"])


@mutator("section/penalty-beside-advance", "told", contact)
def _(deck, own, dice):
    own["penalty"] = 1e3
    return Claim(names=["penalty"])


@mutator("section/interval-beside-parameters", "told", boundary)
def _(deck, own, dice):
    process = next(process for process in deck.processes() if process["Parameters"] is own)
    process["interval"] = [1e9, "End"]
    return Claim(names=["interval"])


@mutator("section/parameters-missing", "refused", boundary)
def _(deck, own, dice):
    process = next(process for process in deck.processes() if process["Parameters"] is own)
    del process["Parameters"]
    return Claim(names=["Parameters", "model_part_name"])


@mutator("section/unknown-process", "refused", boundary)
def _(deck, own, dice):
    process = next(process for process in deck.processes() if process["Parameters"] is own)
    process["python_module"] = "assign_nothing_process"
    return Claim(names=["assign_nothing_process"])


@mutator("section/wrong-kratos-module", "told", boundary, harmless=True)
def _(deck, own, dice):
    process = next(process for process in deck.processes() if process["Parameters"] is own)
    process["kratos_module"] = "KratosMultiphysics.NothingApplication"
    return Claim(names=["kratos_module", "NothingApplication"])


@mutator("section/analysis-stage", "told", always, harmless=True)
def _(deck, own, dice):
    deck.stages[0]["analysis_stage"] = "KratosMultiphysics.FluidDynamicsApplication.fluid_dynamics_analysis"
    return Claim(names=["analysis_stage", "fluid"])


# Solver settings beyond their configs

for key in ("residual_relative_tolerance", "displacement_relative_tolerance", "solution_relative_tolerance"):
    for wrong, expects in ((1.0, "refused"), (7.0, "refused"), (-1e-6, "refused"), (0.0, "told"), (0.99, "told"), (1e-300, "told")):

        def _(deck, own, dice, key=key, wrong=wrong):
            own[key] = wrong
            return Claim(names=[key])

        MUTATORS.append(
            Mutator(
                f"tolerance/{key}={wrong}",
                expects,
                lambda deck, key=key: [
                    own
                    for kind, own in deck.solvers()
                    if kind
                    in (
                        ("static", "dynamic") if key.startswith("disp") else HEAT if key.startswith("sol") else ("static", "dynamic", *HEAT)
                    )
                ],
                _,
                harmless=wrong != -1e-6,
                decks=3,
            )
        )
for key in ("residual_absolute_tolerance", "displacement_absolute_tolerance", "solution_absolute_tolerance"):
    for wrong in (1e30, 1e6, -1.0):

        def _(deck, own, dice, key=key, wrong=wrong):
            own[key] = wrong
            return Claim(names=[key])

        MUTATORS.append(
            Mutator(
                f"tolerance/{key}={wrong}",
                "refused" if wrong < 0 else "told",
                lambda deck, key=key: [
                    own
                    for kind, own in deck.solvers()
                    if kind
                    in (
                        ("static", "dynamic") if key.startswith("disp") else HEAT if key.startswith("sol") else ("static", "dynamic", *HEAT)
                    )
                ],
                _,
                harmless=True,
                decks=4,
            )
        )
for key in ("contact_residual", "frictional_stick_contact_residual", "frictional_slip_contact_residual", "contact_displacement"):
    for kind, wrong, expects in (
        ("relative", 1.5, "refused"),
        ("relative", -1.0, "refused"),
        ("absolute", 1e30, "told"),
        ("absolute", -1.0, "refused"),
    ):

        def _(deck, own, dice, key=f"{key}_{kind}_tolerance", wrong=wrong):
            own[key] = wrong
            return Claim(names=[key])

        MUTATORS.append(
            Mutator(
                f"tolerance/{key}_{kind}={wrong}",
                expects,
                lambda deck: [own for kind, own in deck.solvers() if kind == "contact_settings"],
                _,
                harmless=True,
                decks=3,
            )
        )


@mutator("tolerance/everything-converges", "told", implicit, harmless=True)
def _(deck, own, dice):
    for key in ("residual", "displacement", "solution"):
        if f"{key}_absolute_tolerance" in own or key == "residual":
            own[f"{key}_absolute_tolerance"] = 1e30
    own["check_body_balance"] = False
    for kind in ("contact_residual", "contact_displacement", "frictional_stick_contact_residual", "frictional_slip_contact_residual"):
        if "contact_settings" in own:
            own["contact_settings"][f"{kind}_absolute_tolerance"] = 1e30
    return Claim(names=["absolute_tolerance", "out of balance", "out-of-balance"])


for wrong, expects in ((0, "refused"), (-3, "refused"), (1.5, "refused"), (1, "told"), (10**9, "told")):

    def _(deck, own, dice, wrong=wrong):
        own["max_iteration"] = wrong
        return Claim(names=["max_iteration", "iteration"])

    MUTATORS.append(Mutator(f"iterations/max_iteration={wrong}", expects, implicit, _, harmless=True, decks=4))

for label, given, expects, words in (
    ("unknown", {"solver_type": NONSENSE}, "refused", [NONSENSE]),
    ("unknown-prefixed", {"solver_type": "LinearSolversApplication.nonsense"}, "refused", ["nonsense"]),
    ("no-type", {"tolerance": 1e-8}, "told", ["solver_type", "tolerance"]),
    ("text", "direct", "refused", ["linear_solver_settings"]),
    ("cg-tolerance=1e-300", {"solver_type": "cg", "tolerance": 1e-300}, "told", ["tolerance"]),
    ("cg-tolerance=0", {"solver_type": "cg", "tolerance": 0.0}, "told", ["tolerance"]),
    ("cg-tolerance=0.9", {"solver_type": "cg", "tolerance": 0.9}, "told", ["tolerance"]),
    ("cg-tolerance=text", {"solver_type": "cg", "tolerance": "small"}, "refused", ["tolerance"]),
    ("gmres-max_iteration=0", {"solver_type": "gmres", "max_iteration": 0}, "refused", ["max_iteration"]),
    ("gmres-max_iteration=-5", {"solver_type": "gmres", "max_iteration": -5}, "refused", ["max_iteration"]),
    ("gmres-max_iteration=1", {"solver_type": "gmres", "max_iteration": 1}, "told", ["max_iteration", "direct", "gmres"]),
    ("cg-preconditioner", {"solver_type": "cg", "preconditioner_type": NONSENSE}, "refused", [NONSENSE, "preconditioner_type"]),
    ("amgcl-smoother", {"solver_type": "amgcl", "smoother_type": NONSENSE}, "told", [NONSENSE, "smoother_type"]),
    ("amgcl-krylov", {"solver_type": "amgcl", "krylov_type": NONSENSE}, "told", [NONSENSE, "krylov_type"]),
    ("direct-below=-1", {"solver_type": "amgcl", "direct_below": -1}, "refused", ["direct_below"]),
    ("direct-below=0", {"solver_type": "amgcl", "direct_below": 0}, "told", ["direct_below"]),
    ("memory_limit=0", {"solver_type": "amgcl", "memory_limit": 0.0}, "refused", ["memory"]),
    ("memory_limit=-1", {"memory_limit": -1.0}, "refused", ["memory"]),
    ("memory_limit=1e-9", {"memory_limit": 1e-9}, "refused", ["memory"]),
    ("direct-tolerance", {"solver_type": "sparse_lu", "tolerance": 1e-3}, "told", ["tolerance"]),
    ("scaling", {"solver_type": "sparse_lu", "scaling": "yes"}, "told", ["scaling"]),
    ("unknown-key", {"solver_type": "cg", "tolerence": 1e-3}, "told", ["tolerence"]),
    ("max_iteration-direct", {"solver_type": "sparse_lu", "max_iteration": 1}, "told", ["max_iteration"]),
):

    def _(deck, own, dice, given=given, words=words):
        own["linear_solver_settings"] = copy.deepcopy(given)
        return Claim(names=words)

    MUTATORS.append(
        Mutator(f"linear/{label}", expects, implicit, _, harmless=expects == "told" and label != "unknown-key", decks=3, tolerance=1e-7)
    )

for wrong, expects in (("residual_criterio", "refused"), ("RESIDUAL_CRITERION", "told"), ("", "refused"), ("solution_criterion", "told")):

    def _(deck, own, dice, wrong=wrong):
        own["convergence_criterion"] = wrong
        return Claim(names=["convergence_criterion", wrong or "criterion"])

    MUTATORS.append(Mutator(f"criterion/{wrong or 'empty'}", expects, implicit, _, harmless=expects == "told", decks=3))

for wrong in (0, 1, 4, -2, "2", 2.5):

    def _(deck, own, dice, wrong=wrong):
        own["domain_size"] = wrong
        return Claim(names=["domain_size"])

    MUTATORS.append(Mutator(f"domain_size/{wrong}", "refused", structural, _, decks=2))


@mutator("domain_size/other", "refused", structural)
def _(deck, own, dice):
    own["domain_size"] = 5 - own.get("domain_size", 2)
    return Claim(names=["domain_size", "2D", "3D", "plane", "dimension"])


@mutator("solver/root-part-other", "refused", implicit)
def _(deck, own, dice):
    own["model_part_name"] = "Other"
    return Claim(names=["Other", *deck.roots()])


@mutator("solver/root-part-case", "refused", implicit)
def _(deck, own, dice):
    own["model_part_name"] = own["model_part_name"].lower() if "model_part_name" in own else "structure"
    return Claim(names=["model_part_name", own["model_part_name"], *deck.roots()])


@mutator("solver/root-part-missing", "refused", implicit)
def _(deck, own, dice):
    own.pop("model_part_name", None)
    return Claim(names=["model_part_name"])


@mutator("solver/mesh-missing", "refused", implicit)
def _(deck, own, dice):
    put(own, ("model_import_settings",), {"input_type": "mdpa", "input_filename": "no_mesh"})
    return Claim(names=["no_mesh", "input_filename"])


@mutator("solver/materials-missing", "refused", implicit)
def _(deck, own, dice):
    own["material_import_settings"] = {"materials_filename": "NoMaterials.json"}
    return Claim(names=["NoMaterials.json"])


@mutator("solver/materials-none", "refused", implicit)
def _(deck, own, dice):
    own["material_import_settings"] = {"materials_filename": ""}
    return Claim(names=["material", "properties", "YOUNG_MODULUS", "CONDUCTIVITY", "constitutive"])


@mutator("solver/linear-with-contact", "refused", lambda deck: structural(deck) if contact(deck) else [])
def _(deck, own, dice):
    own["analysis_type"] = "linear"
    return Claim(names=["linear"])


@mutator(
    "solver/linear-with-large-displacement",
    "told",
    lambda deck: (
        structural(deck) if deck.mesh and any("Total" in str(block[1]) or "Updated" in str(block[1]) for block in deck.mesh.blocks) else []
    ),
)
def _(deck, own, dice):
    own["analysis_type"] = "linear"
    return Claim(names=["linear"])


@mutator("solver/dynamic-without-density", "told", lambda deck: [own for kind, own in deck.solvers() if kind == "static"])
def _(deck, own, dice):
    own.update(solver_type="Dynamic", scheme_type="newmark")
    for variables in deck.variables():
        variables.pop("DENSITY", None)
    return Claim(names=["DENSITY", "mass"])


for scheme in ("Newmark", NONSENSE, ""):

    @mutator(
        f"solver/scheme={scheme}", "refused", lambda deck: [own for kind, own in deck.solvers() if kind in ("static", "dynamic")], decks=3
    )
    def _(deck, own, dice, scheme=scheme):
        own.update(solver_type="Dynamic", scheme_type=scheme)
        for variables in deck.variables():
            variables["DENSITY"] = 1.0
        return Claim(names=["scheme_type", scheme or "scheme"])


for key, wrong, expects in (
    ("rho_inf", 1.5, "refused"),
    ("rho_inf", -0.5, "refused"),
    ("damp_factor_m", 0.5, "refused"),
    ("damp_factor_m", -2.0, "refused"),
    ("newmark_beta", 0.0, "told"),
    ("newmark_beta", -1.0, "refused"),
    ("rayleigh_alpha", -1.0, "refused"),
):

    @mutator(f"dynamics/{key}={wrong}", expects, lambda deck: [own for kind, own in deck.solvers() if kind == "static"], decks=3)
    def _(deck, own, dice, key=key, wrong=wrong):
        scheme = "generalized_alpha" if key == "rho_inf" else "bossak" if key.startswith("damp") else "newmark"
        own.update({"solver_type": "Dynamic", "scheme_type": scheme, key: wrong})
        for variables in deck.variables():
            variables["DENSITY"] = 1.0
        return Claim(names=[key])


# Materials

MATERIAL = {
    "YOUNG_MODULUS": (0.0, -1.0),
    "POISSON_RATIO": (0.5, 0.6, -1.0, -1.5, 1.0),
    "DENSITY": (-1.0,),
    "THICKNESS": (0.0, -1.0),
    "CONDUCTIVITY": (0.0, -1.0),
    "SPECIFIC_HEAT": (-1.0,),
    "FRICTION_COEFFICIENT": (-0.1,),
    "YIELD_STRESS": (0.0, -1.0),
    "CROSS_AREA": (0.0, -1.0),
    "TRESCA_FRICTION_THRESHOLD": (-1.0,),
    "THERMAL_EXPANSION_COEFFICIENT": (),
    "ISOTROPIC_HARDENING_MODULUS": (),
    "REFERENCE_TEMPERATURE": (),
    "HARDENING_MODULUS_1D": (),
    "ADHESION": (-1.0,),
    "FRICTION_ANGLE": (95.0, -5.0),
}
for variable, wrongs in MATERIAL.items():

    def having(deck, variable=variable):
        return [own for own in deck.variables() if variable in own]

    for wrong in (*wrongs, "1e9", None, [1.0], True):

        def _(deck, own, dice, variable=variable, wrong=wrong):
            own[variable] = wrong
            return Claim(names=[variable])

        MUTATORS.append(Mutator(f"material/{variable}={wrong}", "refused", having, _, decks=3))

    def _(deck, own, dice, variable=variable):
        del own[variable]
        return Claim(names=[variable])

    MUTATORS.append(Mutator(f"material/{variable}-missing", "told", having, _, decks=5, harmless=True))

    def _(deck, own, dice, variable=variable):
        own[misspelt(variable)] = own.pop(variable)
        return Claim(names=[misspelt(variable), variable])

    MUTATORS.append(Mutator(f"material/{variable}-misspelt", "told", having, _, decks=3))

    def _(deck, own, dice, variable=variable):
        own[variable.lower()] = own.pop(variable)
        return Claim(names=[variable.lower(), variable])

    MUTATORS.append(Mutator(f"material/{variable}-lower-case", "told", having, _, decks=3))


@mutator("material/unused-variable", "told", lambda deck: deck.variables())
def _(deck, own, dice):
    own["YIELD_STRENGTH_OF_NOTHING"] = 1.0
    return Claim(names=["YIELD_STRENGTH_OF_NOTHING"])


@mutator(
    "material/variable-that-law-does-not-read",
    "told",
    lambda deck: [own for own in deck.variables() if "YIELD_STRESS" not in own and "YOUNG_MODULUS" in own],
)
def _(deck, own, dice):
    own["YIELD_STRESS"] = 1e-9
    return Claim(names=["YIELD_STRESS"])


@mutator(
    "material/thickness-in-space",
    "told",
    lambda deck: [own for own in deck.variables()] if any(own.get("domain_size") == 3 for _, own in deck.solvers()) else [],
    harmless=True,
)
def _(deck, own, dice):
    own["THICKNESS"] = 7.0
    return Claim(names=["THICKNESS"])


@mutator("material/law-unknown", "refused", lambda deck: deck.laws())
def _(deck, own, dice):
    own["name"] = "LinearElasticNonsenseLaw"
    return Claim(names=["LinearElasticNonsenseLaw"])


@mutator("material/law-of-other-dimension", "refused", lambda deck: deck.laws())
def _(deck, own, dice):
    own["name"] = "LinearElastic3DLaw" if "2D" in own["name"] or "Plane" in own["name"] else "LinearElasticPlaneStrain2DLaw"
    return Claim(names=[own["name"], "dimension"])


@mutator("material/law-missing", "refused", lambda deck: deck.laws())
def _(deck, own, dice):
    own.clear()
    return Claim(names=["constitutive_law", "name"])


@mutator("material/law-lower-case", "refused", lambda deck: deck.laws(), harmless=True)
def _(deck, own, dice):
    own["name"] = own["name"].lower()
    return Claim(names=[own["name"]])


@mutator(
    "material/strain-law-in-large-deformation",
    "told",
    lambda deck: (
        deck.laws() if deck.mesh and any("Total" in str(block[1]) or "Updated" in str(block[1]) for block in deck.mesh.blocks) else []
    ),
    harmless=True,
)
def _(deck, own, dice):
    own["name"] = (
        own["name"]
        .replace("HyperElasticPlaneStrain", "LinearElasticPlaneStrain")
        .replace("HyperElastic3D", "LinearElastic3D")
        .replace("KirchhoffSaintVenant", "LinearElastic")
    )
    return Claim(names=["LinearElastic", "small"])


def items(deck):
    return [item for own in deck.materials.values() for item in own.get("properties", []) if "model_part_name" in item]


for label, changed in (
    ("part-unknown", lambda path: path + "_x"),
    ("part-case", str.swapcase),
    ("part-root-missing", lambda path: path.split(".", 1)[-1] if "." in path else path + "_x"),
    ("part-empty", lambda path: ""),
    ("part-root", lambda path: path.split(".")[0]),
):

    def _(deck, own, dice, changed=changed):
        before = own["model_part_name"]
        own["model_part_name"] = changed(before)
        return None if own["model_part_name"] == before else Claim(names=[before, own["model_part_name"] or "model_part_name"])

    MUTATORS.append(
        Mutator(
            f"material/{label}",
            "told" if label in ("part-root-missing", "part-root") else "refused",
            items,
            _,
            decks=4,
            harmless=label in ("part-root", "part-root-missing"),
        )
    )


@mutator("material/removed", "refused", items)
def _(deck, own, dice):
    for document in deck.materials.values():
        if own in document["properties"]:
            document["properties"].remove(own)
    return Claim(names=[own["model_part_name"], own["model_part_name"].split(".")[-1], "properties", "material"])


@mutator("material/id-twice", "refused", lambda deck: items(deck) if len(items(deck)) > 1 else [])
def _(deck, own, dice):
    for item in next(document for document in deck.materials.values() if own in document["properties"])["properties"]:
        item["properties_id"] = own["properties_id"]
    return Claim(names=["propert"])


@mutator("material/given-twice", "told", items)
def _(deck, own, dice):
    other = copy.deepcopy(own)
    other["properties_id"] = 991
    if "YOUNG_MODULUS" in other["Material"].get("Variables", {}):
        other["Material"]["Variables"]["YOUNG_MODULUS"] *= 3
    next(document for document in deck.materials.values() if own in document["properties"])["properties"].append(other)
    return Claim(names=[own["model_part_name"], "991"])


@mutator("material/id-missing", "refused", items)
def _(deck, own, dice):
    own.pop("properties_id")
    return Claim(names=["properties_id"])


@mutator("material/key-outside-material", "told", items)
def _(deck, own, dice):
    own["Variables"] = {"YOUNG_MODULUS": 1.0}
    return Claim(names=["Variables"])


TABLES = {
    "reversed": [[400.0, 1.0], [200.0, 2.0]],
    "empty": [],
    "one-column": [[1.0], [2.0]],
    "same-abscissa": [[0.0, 1.0], [0.0, 2.0]],
    "one-row": [[0.0, 1.0]],
    "text": [["a", 1.0], [2.0, 3.0]],
}
for label, rows in TABLES.items():

    @mutator(
        f"material/table-{label}",
        "refused",
        lambda deck: [item for item in items(deck) if "YOUNG_MODULUS" in item.get("Material", {}).get("Variables", {})],
        decks=2,
        harmless=label == "one-row",
    )
    def _(deck, own, dice, rows=rows):
        modulus = own["Material"]["Variables"]["YOUNG_MODULUS"]
        data = [[row[0], row[1] * modulus] if len(row) > 1 else row for row in rows]
        own["Material"]["Tables"] = {
            "TEMPERATURE_YOUNG": {"input_variable": "TEMPERATURE", "output_variable": "YOUNG_MODULUS", "data": data}
        }
        return Claim(names=["TEMPERATURE_YOUNG", "YOUNG_MODULUS", "table", "Table"])


@mutator(
    "material/table-of-what-nothing-reads",
    "told",
    lambda deck: [item for item in items(deck) if "POISSON_RATIO" in item.get("Material", {}).get("Variables", {})],
    harmless=True,
)
def _(deck, own, dice):
    own["Material"]["Tables"] = {
        "T": {"input_variable": "TEMPERATURE", "output_variable": "NO_SUCH_VARIABLE", "data": [[0.0, 1.0], [1.0, 2.0]]}
    }
    return Claim(names=["NO_SUCH_VARIABLE", '"T"'])


# Processes: parts

for label, changed in (
    ("unknown", lambda path: path + "_x"),
    ("case", lambda path: path.split(".")[0] + "." + path.split(".", 1)[-1].swapcase()),
    ("root-missing", lambda path: path.split(".", 1)[-1]),
    ("empty", lambda path: ""),
    ("space", lambda path: path + " "),
    ("two-dots", lambda path: path.replace(".", "..")),
    ("root-twice", lambda path: path.split(".")[0] + "." + path),
):

    def _(deck, own, dice, changed=changed):
        before = own["model_part_name"]
        own["model_part_name"] = changed(before)
        return (
            None
            if own["model_part_name"] == before or "." not in before
            else Claim(names=[own["model_part_name"] or "model_part_name", before])
        )

    MUTATORS.append(
        Mutator(f"part/{label}", "told" if label == "root-missing" else "refused", anything, _, decks=8, harmless=label == "root-missing")
    )


def empty_part(deck, lists=None):
    deck.mesh.parts.append(Part("Empty", lists or {"Nodes": []}, [], []))
    return f"{next(iter(deck.roots()))}.Empty"


def with_mesh(places):
    return lambda deck: places(deck) if deck.mesh is not None and deck.roots() else []


@mutator("part/empty-in-boundary", "told", with_mesh(boundary), decks=8)
def _(deck, own, dice):
    own["model_part_name"] = empty_part(deck)
    return Claim(names=["Empty"])


@mutator("part/empty-in-output", "told", with_mesh(outputs))
def _(deck, own, dice):
    own["model_part_name"] = empty_part(deck)
    return Claim(names=["Empty"])


@mutator("part/empty-in-added-output", "told", with_mesh(always))
def _(deck, own, dice):
    deck.add({"python_module": "vtu_output_process", "Parameters": {"model_part_name": empty_part(deck), "output_path": "v"}})
    return Claim(names=["Empty"])


@mutator("part/empty-in-rigid-movement", "told", with_mesh(structural))
def _(deck, own, dice):
    empty_part(deck)
    deck.add(
        {
            "python_module": "impose_rigid_movement_process",
            "Parameters": {"main_model_part_name": next(iter(deck.roots())), "model_part_name": "Empty"},
        }
    )
    return Claim(names=["Empty"])


@mutator("part/no-conditions-in-load", "told", with_mesh(of_module("assign_vector_by_direction_to_condition_process")), decks=8)
def _(deck, own, dice):
    nodes = [row[0] for row in deck.mesh.of("Nodes")]
    own["model_part_name"] = empty_part(deck, {"Nodes": nodes[:3]})
    return Claim(names=["Empty"])


@mutator("part/free-nodes-in-load", "told", with_mesh(loads))
def _(deck, own, dice):
    number = 1 + max(int(row[0]) for row in deck.mesh.of("Nodes"))
    next(block for block in deck.mesh.blocks if block[0] == "Nodes")[2].append([str(number), "77", "77", "0"])
    own["model_part_name"] = empty_part(deck, {"Nodes": [str(number)]})
    return Claim(names=["Empty"])


# Processes: intervals

for label, value in (
    ("reversed", [0.9, 0.1]),
    ("outside", [1e9, 2e9]),
    ("negative", [-2.0, -1.0]),
    ("between", [1e-12, 2e-12]),
    ("text-end", [0.0, "end"]),
    ("text-begin", ["Begin", "End"]),
    ("one-number", [0.0]),
    ("three", [0.0, 1.0, 2.0]),
    ("text", "always"),
    ("null", None),
    ("null-end", [0.0, None]),
):
    for kind, own_places in (
        ("load", loads),
        ("support", supports),
        ("contact", contact),
        ("tie", of_module("mesh_tying_process")),
        ("heat", of_module("thermal_contact_process")),
        ("wear", of_module("wear_process")),
    ):

        def _(deck, own, dice, value=value):
            own["interval"] = value
            return Claim(names=["interval", str(own.get("variable_name")), "acts"])

        MUTATORS.append(Mutator(f"interval/{kind}-{label}", "told", own_places, _, decks=3))


# Processes: values

for label, value, expects in (
    ("unknown-function", "nonsense(t)", "refused"),
    ("unknown-name", "2.0*w", "refused"),
    ("empty", "", "refused"),
    ("divided-by-zero", "1.0/(t-t)", "refused"),
    ("root-of-negative", "sqrt(-1.0-t)", "refused"),
    ("logarithm-of-zero", "log(0.0*t)", "refused"),
    ("list", [1.0], "refused"),
    ("true", True, "refused"),
    ("null", None, "told"),
    ("huge", 1e300, "told"),
    ("unit", "1.0e6 Pa", "refused"),
    ("comma", "1,5*t", "refused"),
    ("assignment", "t=1", "refused"),
    ("capital-t", "T*1.0", "refused"),
    ("table-missing", {"name": "csv_table", "filename": "none.csv"}, "refused"),
    ("table-kind", {"name": "xls_table", "filename": "none.csv"}, "refused"),
):

    def _(deck, own, dice, value=value, label=label):
        key = "modulus" if "modulus" in own else "value"
        old = own.get(key)
        if isinstance(old, list):
            at = next((at for at, one in enumerate(old) if one not in (None, 0, 0.0)), None)
            if at is None:
                return None
            old[at] = value
        elif old in (0.0, None):
            return None
        else:
            own[key] = value
        return Claim(names=[key, str(value), str(own.get("variable_name")), "none.csv"])

    MUTATORS.append(Mutator(f"value/{label}", expects, boundary, _, decks=4, harmless=label == "huge"))

for label, value, expects in (
    ("zero", [0.0, 0.0, 0.0], "refused"),
    ("two", [0.0, 1.0], "refused"),
    ("text", "downwards", "refused"),
    ("null", None, "refused"),
    ("missing", "missing", "refused"),
    ("four", [0.0, 1.0, 0.0, 0.0], "refused"),
    ("out-of-plane", [0.0, 0.0, 1.0], "told"),
    ("bool", [False, True, False], "refused"),
):

    def _(deck, own, dice, value=value):
        if value == "missing":
            del own["direction"]
        else:
            own["direction"] = value
        return Claim(names=["direction", "plane", str(own.get("variable_name"))])

    MUTATORS.append(
        Mutator(
            f"direction/{label}",
            expects,
            of_module("assign_vector_by_direction.*", lambda own: "direction" in own),
            _,
            decks=4,
            harmless=False,
        )
    )
    if label == "out-of-plane":
        MUTATORS[-1].places = lambda deck: (
            of_module("assign_vector_by_direction.*")(deck) if any(own.get("domain_size") == 2 for _, own in deck.solvers()) else []
        )

for label, value, expects in (
    ("unknown", "NO_SUCH_LOAD", "refused"),
    ("case", "line_load", "refused"),
    ("scalar", "TEMPERATURE", "told"),
    ("result", "REACTION", "told"),
    ("output", "CAUCHY_STRESS_TENSOR", "told"),
    ("component", "LINE_LOAD_W", "refused"),
    ("velocity", "VELOCITY", "told"),
    ("empty", "", "refused"),
    ("torque", "POINT_MOMENT", "told"),
    ("rotation", "ROTATION", "told"),
):

    def _(deck, own, dice, value=value):
        own["variable_name"] = value
        return Claim(names=["variable_name", value or "variable", "VariablesList"])

    MUTATORS.append(Mutator(f"variable/load-{label}", expects, loads, _, decks=3))

    def _(deck, own, dice, value=value):
        own["variable_name"] = value
        return Claim(names=["variable_name", value or "variable"])

    MUTATORS.append(Mutator(f"variable/support-{label}", expects, supports, _, decks=3))


@mutator("value/constrained-length", "refused", supports)
def _(deck, own, dice):
    if not isinstance(own.get("constrained"), list):
        return None
    own["constrained"] = [True]
    return Claim(names=["constrained"])


@mutator("value/constrained-null", "refused", supports)
def _(deck, own, dice):
    own["constrained"] = None
    return Claim(names=["constrained"])


@mutator("value/value-length", "refused", supports)
def _(deck, own, dice):
    if not isinstance(own.get("value"), list):
        return None
    own["value"] = own["value"][:2]
    return Claim(names=["value"])


@mutator("value/load-constrained", "told", loads, harmless=True)
def _(deck, own, dice):
    own["constrained"] = True if str(own["variable_name"]).endswith("PRESSURE") else [True, True, True]
    return Claim(names=["constrained"])


@mutator("value/local-axes-skewed", "refused", boundary, harmless=True)
def _(deck, own, dice):
    own["local_axes"] = {"origin": [0.0, 0.0, 0.0], "axes": [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]}
    return Claim(names=["local_axes", "axes"])


@mutator("value/local-axes-without-function", "told", loads, harmless=True)
def _(deck, own, dice):
    own["local_axes"] = {"origin": [1.0, 0.0, 0.0], "axes": [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]}
    return Claim(names=["local_axes"])


# Tables of loads


def csv(name, text, expects, harmless=False):
    @mutator(f"table/{name}", expects, loads, decks=3, harmless=harmless)
    def _(deck, own, dice, text=text):
        key = "modulus" if "modulus" in own else "value"
        if isinstance(own.get(key), list):
            return None
        own[key] = {"name": "csv_table", "filename": "changed.csv", "skiprows": 1}
        deck.texts["changed.csv"] = text
        return Claim(names=["changed.csv", "table"])


csv("ends-early", "t,v\n0.0,1.0\n1e-9,2.0\n", "told")
csv("begins-late", "t,v\n1e8,1.0\n2e8,2.0\n", "told")
csv("nan", "t,v\n0.0,1.0\n1e9,nan\n", "refused")
csv("infinite", "t,v\n0.0,1.0\n1e9,inf\n", "refused")
csv("not-in-order", "t,v\n0.0,1.0\n1e9,3.0\n0.5,2.0\n", "refused")
csv("same-time", "t,v\n-1.0,1.0\n0.5,1.0\n0.5,2.0\n0.5,3.0\n1e9,2.0\n", "refused")
csv("only-heading", "t,v\n", "refused")
csv("empty", "", "refused")
csv("one-column", "t\n0.0\n1e9\n", "refused")
csv("semicolons", "t;v\n0.0;1.0\n1e9;2.0\n", "refused")
csv("decimal-commas", "t;v\n0,0;1,0\n1000000000,0;2,0\n", "refused")
csv("words", "t,v\n0.0,one\n1e9,two\n", "told")
csv("missing-cell", "t,v\n0.0,\n1e9,2.0\n", "told")
csv("binary", "\x00\x01,\x02\n\x03,\x04\n", "refused")


# Processes: two of them


@mutator("twice/load", "told", loads)
def _(deck, own, dice):
    deck.add(copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own)))
    return Claim(names=[own["variable_name"]])


@mutator("twice/support", "same", supports)
def _(deck, own, dice):
    deck.add(copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own)))
    return Claim()


@mutator("twice/contradicting-support", "told", supports)
def _(deck, own, dice):
    other = copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own))
    value = other["Parameters"].get("value")
    other["Parameters"]["value"] = [None if one is None else 0.01 for one in value] if isinstance(value, list) else 0.01
    deck.add(other)
    return Claim(names=["DISPLACEMENT"])


@mutator("twice/contact-process", "told", in_pairs)
def _(deck, own, dice):
    deck.add(copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own)))
    return Claim(names=["pair", "twice"])


@mutator("twice/pair", "told", in_pairs)
def _(deck, own, dice):
    for key in (pairs_key(own), "assume_master_slave", "friction_coefficients"):
        if isinstance(own.get(key), dict) and own[key]:
            own[key]["77"] = copy.deepcopy(next(iter(own[key].values())))
    return Claim(names=["77"])


@mutator("twice/output", "refused", outputs)
def _(deck, own, dice):
    deck.add(copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own)))
    return Claim(names=["output", str(own.get("output_file_name")), str(own.get("output_path"))])


@mutator("twice/rigid-movement", "told", of_module("impose_rigid_movement_process"))
def _(deck, own, dice):
    deck.add(copy.deepcopy(next(process for process in deck.processes() if process["Parameters"] is own)))
    return Claim(names=["onstraint", "twice", own["model_part_name"]])


@mutator("support/of-loaded-nodes", "told", lambda deck: [own for own in loads(deck) if "direction" in own])
def _(deck, own, dice):
    deck.add(
        {
            "python_module": "assign_vector_variable_process",
            "Parameters": {
                "model_part_name": own["model_part_name"],
                "variable_name": "DISPLACEMENT",
                "constrained": [True, True, True],
                "value": [0.0, 0.0, 0.0],
            },
        }
    )
    return Claim(names=[own["variable_name"], own["model_part_name"]])


@mutator("support/removed", "told", lambda deck: supports(deck) if not deck.settings("dynamic") else [])
def _(deck, own, dice):
    for listed in deck.lists():
        listed[:] = [process for process in listed if process.get("Parameters") is not own]
    return Claim(names=["rigid", "support", "held", "restrain", "singular"])


@mutator("support/not-constrained", "told", supports)
def _(deck, own, dice):
    own["constrained"] = [False, False, False] if isinstance(own.get("value"), list) else False
    return Claim(names=["rigid", "support", "fixes", "restrain", "DISPLACEMENT"])


@mutator("support/all-removed", "told", lambda deck: supports(deck) if not deck.settings("dynamic") else [])
def _(deck, own, dice):
    gone = [id(one) for one in supports(deck)]
    for listed in deck.lists():
        listed[:] = [process for process in listed if id(process.get("Parameters")) not in gone]
    return Claim(names=["rigid", "support", "restrain"])


def is_moved(deck):
    """Whether a support moves its nodes."""
    values = [own["value"] if isinstance(own.get("value"), list) else [own.get("value")] for own in supports(deck)]
    return any(one not in (None, 0, 0.0) for value in values for one in value)


@mutator("load/all-removed", "told", lambda deck: loads(deck)[:1] if not is_moved(deck) else [])
def _(deck, own, dice):
    gone = [id(one) for one in loads(deck)]
    for listed in deck.lists():
        listed[:] = [process for process in listed if id(process.get("Parameters")) not in gone]
    return Claim(names=["load", "moves"])


@mutator("constraint/on-support", "refused", lambda deck: structural(deck) if deck.mesh and supports(deck) else [])
def _(deck, own, dice):
    held = next((one for one in supports(deck) if isinstance(one.get("constrained"), list) and True in one["constrained"]), None)
    part = held and deck.mesh.named(held["model_part_name"].split(".", 1)[-1])
    if not part or not part.lists.get("Nodes"):
        return None
    slave = part.lists["Nodes"][0]
    master = next(row[0] for row in reversed(deck.mesh.of("Nodes")) if row[0] not in part.lists["Nodes"])
    name = "DISPLACEMENT_" + "XYZ"[held["constrained"].index(True)]
    deck.mesh.blocks.append(["Constraints", ["LinearMasterSlaveConstraint", name, name], [["901", "0.0", "[1.0]", slave, master]]])
    return Claim(names=[name])


for label, row in (
    ("unknown-node", ["901", "0.0", "[1.0]", "SLAVE", "99999999"]),
    ("self", ["901", "0.0", "[1.0]", "SLAVE", "SLAVE"]),
    ("nan", ["901", "nan", "[1.0]", "SLAVE", "1"]),
    ("weights", ["901", "0.0", "[1.0,2.0]", "SLAVE", "1"]),
):

    @mutator(f"constraint/{label}", "refused", lambda deck: structural(deck) if deck.mesh else [], decks=3)
    def _(deck, own, dice, row=row):
        last = deck.mesh.of("Nodes")[-1][0]
        deck.mesh.blocks.append(
            [
                "Constraints",
                ["LinearMasterSlaveConstraint", "DISPLACEMENT_X", "DISPLACEMENT_X"],
                [[last if word == "SLAVE" else word for word in row]],
            ]
        )
        return Claim(names=["onstraint", "mdpa", "901"])


# Contact


@mutator(
    "contact/sides-exchanged",
    "told",
    lambda deck: [own for own in in_pairs(deck) if own.get("assume_master_slave")] if deck.mesh else [],
    harmless=True,
    tolerance=0.3,
)
def _(deck, own, dice):
    for pair, slaves in own["assume_master_slave"].items():
        both = own[pairs_key(own)].get(pair, [])
        conditions = lambda names: {
            one for name in names for one in (deck.mesh.named(name) or Part("", {}, [], [])).lists.get("Conditions", [])
        }
        masters = sorted(conditions(both) - conditions(slaves))
        if not masters:
            return None
        nodes = sorted({node for row in deck.mesh.of("Conditions") if row[0] in masters for node in row[2:]}, key=int)
        deck.mesh.parts.append(Part(f"Other{pair}", {"Nodes": nodes, "Conditions": masters}, [], []))
        own["assume_master_slave"][pair] = [f"Other{pair}"]
    return Claim(names=["slave", "master"], factors={"CONTACT_PRESSURE": None})


for label, value in (
    ("missing", None),
    ("empty", {}),
    ("unknown-part", {"0": ["NoSuchPart"]}),
    ("part-case", "case"),
    ("not-a-list", {"0": "Slave"}),
    ("other-pair", {"9": ["Slave"]}),
    ("part-with-root", "root"),
    ("list", ["Slave"]),
):
    for key in ("pairs", "assume_master_slave"):

        def _(deck, own, dice, value=value, key=key):
            key = pairs_key(own) if key == "pairs" else key
            if not own.get(key):
                return None
            if value is None:
                del own[key]
            elif value in ("case", "root"):
                root = own.get("model_part_name", "Structure")
                own[key] = {
                    pair: [name.swapcase() if value == "case" else f"{root}.{name}" for name in names] for pair, names in own[key].items()
                }
            else:
                own[key] = copy.deepcopy(value)
            return Claim(
                names=[
                    key,
                    "skin",
                    "self contact",
                    "self-contact",
                    "NoSuchPart",
                    "slave",
                    *([] if value != "case" else [name for names in own[key].values() for name in names]),
                ]
            )

        MUTATORS.append(Mutator(f"contact/{key}-{label}", "told", in_pairs, _, decks=4, harmless=label in ("part-with-root",)))

for label, value, expects in (
    ("unknown", NONSENSE, "refused"),
    ("of-other-formulation", "Frictional", "told"),
    ("frictionless", "Frictionless", "told"),
    ("lower-case", "frictional", "refused"),
    ("empty", "", "refused"),
    ("tying", "MeshTying", "told"),
):

    def _(deck, own, dice, value=value):
        if own.get("contact_type", "Frictionless") == value:
            return None
        own["contact_type"] = value
        return Claim(names=["contact_type", value or "contact type", "riction", "mortar_type"])

    MUTATORS.append(Mutator(f"contact/type-{label}", expects, contact, _, decks=5))

for value in (
    "ALMContactFrictional",
    "ALMContactFrictionless",
    "PenaltyContactFrictionless",
    "PenaltyContactFrictional",
    "NitscheContact",
    NONSENSE,
    "ALMContactFrictionlesss",
    "",
    "alm",
):

    def _(deck, own, dice, value=value):
        if own.get("mortar_type") == value:
            return None
        own["mortar_type"] = value
        return Claim(names=["mortar_type", value or "mortar_type", "contact_type", "riction"])

    MUTATORS.append(
        Mutator(
            f"contact/mortar_type={value}",
            "told",
            lambda deck: [own for kind, own in deck.solvers() if kind == "contact_settings"],
            _,
            decks=5,
        )
    )

for label, value, expects in (
    ("one-missing", "one", "told"),
    ("negative", -0.3, "refused"),
    ("huge", 1e30, "told"),
    ("text", "0.3", "refused"),
    ("null", None, "refused"),
    ("list", [0.3], "refused"),
    ("number", "bare", "refused"),
    ("percent", 30.0, "told"),
):

    def _(deck, own, dice, value=value):
        given = own["friction_coefficients"]
        if value == "bare":
            own["friction_coefficients"] = 0.3
        elif value == "one":
            given.pop(next(iter(given)))
        else:
            given[next(iter(given))] = value
        return Claim(names=["friction", "FRICTION"])

    MUTATORS.append(
        Mutator(f"friction/{label}", expects, lambda deck: [own for own in contact(deck) if own.get("friction_coefficients")], _, decks=4)
    )


@mutator(
    "friction/coefficient-without-friction",
    "told",
    lambda deck: [own for own in contact(deck) if own.get("contact_type", "Frictionless") == "Frictionless"],
)
def _(deck, own, dice):
    own["friction_coefficients"] = {"0": 0.5}
    return Claim(names=["friction_coefficients", "Frictional"])


@mutator(
    "friction/in-materials-without-friction",
    "told",
    lambda deck: [own for own in contact(deck) if own.get("contact_type", "Frictionless") == "Frictionless"],
)
def _(deck, own, dice):
    for variables in deck.variables():
        variables["FRICTION_COEFFICIENT"] = 0.5
    return Claim(names=["FRICTION_COEFFICIENT"])


@mutator(
    "friction/in-one-material",
    "told",
    lambda deck: (
        [own for own in contact(deck) if own.get("contact_type") == "Frictional" and own.get("friction_coefficients")]
        if len(deck.variables()) > 1
        else []
    ),
)
def _(deck, own, dice):
    deck.variables()[0]["FRICTION_COEFFICIENT"] = 0.77
    return Claim(names=["FRICTION_COEFFICIENT"])


@mutator(
    "friction/differs-between-materials",
    "told",
    lambda deck: [own for own in contact(deck) if own.get("contact_type") == "Frictional"] if len(deck.variables()) > 1 else [],
)
def _(deck, own, dice):
    own.pop("friction_coefficients", None)
    for at, variables in enumerate(deck.variables()):
        variables["FRICTION_COEFFICIENT"] = 0.1 + 0.5 * at
    return Claim(names=["FRICTION_COEFFICIENT"])


@mutator(
    "friction/Tresca-without-threshold",
    "told",
    lambda deck: [
        own
        for own in contact(deck)
        if own.get("contact_type") == "Frictional" and own.get("frictional_law") != "Tresca" and "alm" in str(deck.project)
    ],
)
def _(deck, own, dice):
    own["frictional_law"] = "Tresca"
    return Claim(names=["TRESCA_FRICTION_THRESHOLD", "Tresca"])


PENALTIES = {"zero": 0.0, "negative": -1.0, "tiny": 1e-30, "huge": 1e30, "text": "stiff", "soft": 1.0}
for label, value in PENALTIES.items():
    for key in ("penalty", "scale_factor"):

        def _(deck, own, dice, key=key, value=value):
            advance = own.setdefault("advance_ALM_parameters", {})
            advance.update({"manual_ALM": True, "penalty": 1e9, "scale_factor": 1e9})
            advance[key] = value
            return Claim(names=[key, "penetrat"])

        MUTATORS.append(
            Mutator(
                f"penalty/{key}-{label}",
                "told" if label in ("tiny", "huge", "soft") else "refused",
                of_module("(alm|uzawa)_contact_process" if key == "scale_factor" else "(alm|penalty|uzawa)_contact_process"),
                _,
                decks=5,
                harmless=True,
                tolerance=1e-3,
            )
        )

        def _(deck, own, dice, key=key, value=value):
            own.setdefault("advance_ALM_parameters", {}).update({"manual_ALM": False, key: value})
            return Claim(names=[key])

        MUTATORS.append(Mutator(f"penalty/{key}-{label}-not-manual", "told", of_module("(alm|penalty|uzawa)_contact_process"), _, decks=2))
for label, value in {"zero": 0.0, "tiny": 1e-12, "huge": 1e12}.items():

    def _(deck, own, dice, value=value):
        own.setdefault("advance_ALM_parameters", {})["stiffness_factor"] = value
        return Claim(names=["stiffness_factor", "penetrat"])

    MUTATORS.append(
        Mutator(
            f"penalty/stiffness_factor-{label}",
            "told",
            of_module("(alm|penalty|uzawa)_contact_process"),
            _,
            decks=5,
            harmless=True,
            tolerance=1e-3,
        )
    )
for key, values in {
    "search_factor": (0.0, -1.0, 1e-6, 1e-3),
    "normal_orientation_threshold": (-1.0, 0.0, 1.9, 2.5),
    "active_check_factor": (0.0, -1.0, 1e30),
    "database_step_update": (0, -1, 10**9),
    "max_number_results": (0, -1),
}.items():
    for value in values:

        def _(deck, own, dice, key=key, value=value):
            own.setdefault("search_parameters", {})[key] = value
            return Claim(names=[key, "pair", "search", "reach"])

        MUTATORS.append(
            Mutator(
                f"search/{key}={value}",
                "told",
                of_module("(alm|penalty|nitsche|uzawa|mpc)_contact_process|mesh_tying_process"),
                _,
                decks=5,
                harmless=True,
            )
        )
for value in (0, -1, 6, 100, 1.5, "2"):

    def _(deck, own, dice, value=value):
        own["integration_order"] = value
        return Claim(names=["integration_order"])

    MUTATORS.append(Mutator(f"contact/integration_order={value}", "refused", in_pairs, _, decks=4))
for key, value in (
    ("search_factor", 0.0),
    ("search_factor", -3.0),
    ("search_factor", 1e-6),
    ("normal_orientation_threshold", 2.5),
    ("normal_orientation_threshold", -1.0),
    ("touching_gap", -1.0),
    ("touching_gap", 1e30),
):

    def _(deck, own, dice, key=key, value=value):
        own[key] = value
        return Claim(names=[key, "pair", "reach"])

    MUTATORS.append(Mutator(f"thermal-contact/{key}={value}", "told", of_module("thermal_contact_process"), _, decks=3, harmless=True))
for label, value, expects in (
    ("empty", [], "refused"),
    ("unknown-law", [{"law": NONSENSE}], "refused"),
    ("no-law", [{"conductance": 3.0}], "refused"),
    ("no-value", [{"law": "constant"}], "refused"),
    ("negative", [{"law": "constant", "conductance": -20.0}], "refused"),
    ("zero", [{"law": "constant", "conductance": 0.0}], "told"),
    ("huge", [{"law": "constant", "conductance": 1e30}], "told"),
    ("key", [{"law": "constant", "conductance": 20.0, "conductanc": 1.0}], "told"),
    ("not-a-list", {"law": "constant", "conductance": 20.0}, "refused"),
):

    def _(deck, own, dice, value=value):
        own["conductance"] = copy.deepcopy(value)
        return Claim(names=["conductance", "law", NONSENSE])

    MUTATORS.append(Mutator(f"thermal-contact/conductance-{label}", expects, of_module("thermal_contact_process"), _, decks=3))


@mutator("contact/process-removed", "told", contact)
def _(deck, own, dice):
    for listed in deck.lists():
        listed[:] = [process for process in listed if process.get("Parameters") is not own]
    return Claim(names=["contact", "nothing couples", "restrain"])


@mutator(
    "contact/settings-removed",
    "told",
    lambda deck: [own for kind, own in deck.solvers() if "mortar_type" in own.get("contact_settings", {})],
)
def _(deck, own, dice):
    del own["contact_settings"]
    return Claim(names=["contact_settings", "mortar_type"])


@mutator(
    "contact/ordinary-criterion",
    "told",
    lambda deck: [own for own in structural(deck) if "contact" in str(own.get("convergence_criterion"))],
    harmless=True,
    tolerance=1e-6,
)
def _(deck, own, dice):
    own["convergence_criterion"] = "residual_criterion"
    return Claim(names=["criterion"])


@mutator(
    "contact/axisymmetric-of-plane",
    "told",
    lambda deck: (
        of_module("alm_contact_process")(deck)
        if not deck.is_of_revolution() and any(own.get("domain_size") == 2 for _, own in deck.solvers())
        else []
    ),
)
def _(deck, own, dice):
    own["alternative_formulations"] = {"axisymmetric": True}
    return Claim(names=["axisymmetric", "revolution"])


# Outputs

for label, value, expects in (
    ("unknown", ["NO_SUCH_RESULT"], "refused"),
    ("case", ["displacement"], "refused"),
    ("component", ["DISPLACEMENT_W"], "refused"),
    ("empty", [], "told"),
    ("not-computed", ["VELOCITY"], "told"),
    ("number", [3], "refused"),
    ("text", "DISPLACEMENT", "refused"),
    ("twice", ["DISPLACEMENT", "DISPLACEMENT"], "told"),
    ("gauss", ["VON_MISES_STRESS"], "told"),
    ("pressure", ["WATER_PRESSURE"], "told"),
):

    def _(deck, own, dice, value=value):
        own["output_variables"] = value
        return Claim(names=["output_variables", *(str(word) for word in value)])

    MUTATORS.append(Mutator(f"output/json-{label}", expects, of_module("json_output_process"), _, decks=3, harmless=label == "twice"))
for label, key, value, expects in (
    ("frequency-never", "time_frequency", 1e30, "told"),
    ("frequency-negative", "time_frequency", -1.0, "refused"),
    ("file-empty", "output_file_name", "", "refused"),
    ("file-is-mesh", "output_file_name", "mesh.mdpa", "refused"),
    ("file-is-deck", "output_file_name", DECK, "refused"),
    ("folder-missing", "output_file_name", "no/such/folder/x.json", "told"),
    ("gauss-unknown", "gauss_points_output_variables", ["NO_SUCH_STRESS"], "refused"),
    ("gauss-nodal", "gauss_points_output_variables", ["DISPLACEMENT"], "told"),
    ("flag-unknown", "check_for_flag", "NO_SUCH_FLAG", "refused"),
    ("flag-unset", "check_for_flag", "INTERFACE", "told"),
    ("sub-part-unknown", "sub_model_part_name", "NoSuchPart", "refused"),
):

    def _(deck, own, dice, key=key, value=value):
        if value == "mesh.mdpa" and not (deck.folder / value).exists():
            return None
        own[key] = value
        return Claim(names=[key, str(value if not isinstance(value, list) else value[0])])

    MUTATORS.append(
        Mutator(f"output/json-{label}", expects, of_module("json_output_process"), _, decks=3, harmless=label == "folder-missing")
    )
for label, given, expects, words in (
    ("interval-never", {"output_interval": 1e30}, "told", ["output_interval"]),
    ("interval-never-time", {"output_control_type": "time", "output_interval": 1e30}, "told", ["output_interval"]),
    ("interval-fraction", {"output_interval": 0.5}, "told", ["output_interval"]),
    ("interval-negative", {"output_interval": -1}, "refused", ["output_interval"]),
    ("nodal-unknown", {"nodal_solution_step_data_variables": ["NO_SUCH"]}, "refused", ["NO_SUCH"]),
    ("nodal-wrong-list", {"nodal_solution_step_data_variables": ["VON_MISES_STRESS"]}, "refused", ["VON_MISES_STRESS"]),
    ("not-a-variable-of-the-model", {"nodal_solution_step_data_variables": ["WATER_PRESSURE"]}, "told", ["WATER_PRESSURE"]),
    ("velocity-of-statics", {"nodal_solution_step_data_variables": ["VELOCITY"]}, "told", ["VELOCITY"]),
    ("gauss-unknown", {"gauss_point_variables_in_elements": ["NO_SUCH"]}, "refused", ["NO_SUCH"]),
    ("flags-unknown", {"nodal_flags": ["NO_SUCH"]}, "refused", ["NO_SUCH"]),
    ("element-unknown", {"element_data_value_variables": ["NO_SUCH"]}, "refused", ["NO_SUCH"]),
    ("gauss-not-computed", {"gauss_point_variables_in_elements": ["TEMPERATURE_GRADIENT"]}, "told", ["TEMPERATURE_GRADIENT"]),
    ("plastic-of-elastic", {"gauss_point_variables_in_elements": ["EQUIVALENT_PLASTIC_STRAIN"]}, "told", ["EQUIVALENT_PLASTIC_STRAIN"]),
    ("condition-data", {"condition_data_value_variables": ["DISPLACEMENT"]}, "told", ["DISPLACEMENT"]),
):
    for module in ("vtu_output_process", "vtk_output_process"):

        @mutator(f"output/{module[:3]}-{label}", expects, lambda deck: structural(deck), decks=2)
        def _(deck, own, dice, given=given, module=module, words=words):
            deck.add(
                {"python_module": module, "Parameters": {"model_part_name": own["model_part_name"], "output_path": "changed", **given}}
            )
            return Claim(names=words)


# Heat


@mutator(
    "heat/initial-temperature-missing",
    "told",
    lambda deck: [
        own for own in of_module("assign_.*")(deck) if own.get("variable_name") == "TEMPERATURE" and own.get("interval") == [0.0, 0.0]
    ],
)
def _(deck, own, dice):
    for listed in deck.lists():
        listed[:] = [process for process in listed if process.get("Parameters") is not own]
    return Claim(names=["TEMPERATURE", "initial"])


@mutator(
    "heat/temperatures-free-at-rest",
    "told",
    lambda deck: (
        []
        if not deck.settings("stationary")
        else [own for own in of_module("assign_.*")(deck) if own.get("variable_name") == "TEMPERATURE" and own.get("constrained", True)]
    ),
)
def _(deck, own, dice):
    for one in of_module("assign_.*")(deck):
        if one.get("variable_name") == "TEMPERATURE":
            one["constrained"] = False
    return Claim(names=["TEMPERATURE", "temperature"])


@mutator(
    "heat/flux-on-nodes-without-faces", "told", lambda deck: [own for kind, own in deck.solvers() if kind in HEAT] if deck.mesh else []
)
def _(deck, own, dice):
    faces = {node for row in deck.mesh.of("Conditions") for node in row[2:]}
    nodes = [row[0] for row in deck.mesh.of("Nodes") if row[0] not in faces][:2]
    deck.mesh.parts.append(Part("Spots", {"Nodes": nodes}, [], []))
    deck.add(
        {
            "python_module": "assign_scalar_variable_process",
            "Parameters": {
                "model_part_name": f"{own['model_part_name']}.Spots",
                "variable_name": "FACE_HEAT_FLUX",
                "constrained": False,
                "value": 5.0,
            },
        }
    )
    return Claim(names=["FACE_HEAT_FLUX", "Spots"])


@mutator(
    "heat/expansion-without-reference", "told", lambda deck: [own for own in deck.variables() if "THERMAL_EXPANSION_COEFFICIENT" in own]
)
def _(deck, own, dice):
    own.pop("REFERENCE_TEMPERATURE", None)
    return Claim(names=["REFERENCE_TEMPERATURE"])


@mutator(
    "heat/expansion-in-law-without",
    "told",
    lambda deck: [own for own in deck.variables() if "YOUNG_MODULUS" in own and "THERMAL_EXPANSION_COEFFICIENT" not in own],
)
def _(deck, own, dice):
    own["THERMAL_EXPANSION_COEFFICIENT"] = 1e-2
    return Claim(names=["THERMAL_EXPANSION_COEFFICIENT"])


@mutator("heat/temperature-in-statics", "told", lambda deck: [own for kind, own in deck.solvers() if kind == "static"])
def _(deck, own, dice):
    deck.add(
        {
            "python_module": "assign_scalar_variable_process",
            "Parameters": {"model_part_name": own["model_part_name"], "variable_name": "TEMPERATURE", "constrained": False, "value": 500.0},
        }
    )
    return Claim(names=["TEMPERATURE"])


# Loads that have no carrier


@mutator("load/gravity-without-density", "told", structural)
def _(deck, own, dice):
    for variables in deck.variables():
        variables.pop("DENSITY", None)
    deck.add(
        {
            "python_module": "assign_vector_by_direction_process",
            "Parameters": {
                "model_part_name": own["model_part_name"],
                "variable_name": "VOLUME_ACCELERATION",
                "modulus": 9.81,
                "direction": [0.0, -1.0, 0.0],
                "constrained": False,
            },
        }
    )
    return Claim(names=["DENSITY"])


@mutator("load/gravity-with-density-of-one", "told", lambda deck: structural(deck) if len(deck.variables()) > 1 else [])
def _(deck, own, dice):
    for variables in deck.variables():
        variables.pop("DENSITY", None)
    deck.variables()[0]["DENSITY"] = 1.0
    deck.add(
        {
            "python_module": "assign_vector_by_direction_process",
            "Parameters": {
                "model_part_name": own["model_part_name"],
                "variable_name": "VOLUME_ACCELERATION",
                "modulus": 9.81,
                "direction": [0.0, -1.0, 0.0],
                "constrained": False,
            },
        }
    )
    return Claim(names=["DENSITY"])


@mutator("load/point-load-on-part-of-lines", "told", loads)
def _(deck, own, dice):
    if own["variable_name"] == "POINT_LOAD" or str(own["variable_name"]).endswith("PRESSURE"):
        return None
    own["variable_name"] = "POINT_LOAD"
    return Claim(names=["POINT_LOAD"])


@mutator("load/line-for-surface", "told", loads)
def _(deck, own, dice):
    other = {"LINE_LOAD": "SURFACE_LOAD", "SURFACE_LOAD": "LINE_LOAD"}.get(own["variable_name"])
    if not other:
        return None
    own["variable_name"] = other
    return Claim(names=[other])


@mutator("load/on-elements-process", "told", of_module("assign_vector_by_direction_to_condition_process"))
def _(deck, own, dice):
    next(process for process in deck.processes() if process["Parameters"] is own)[
        "python_module"
    ] = "assign_vector_by_direction_to_element_process"
    return Claim(names=[own["variable_name"]])


@mutator("load/inward-normal-and-vector", "refused", of_module("assign_vector_by_direction_to_condition_process"))
def _(deck, own, dice):
    own["direction"] = "automatic_inward_normal"
    return Claim(names=["automatic_inward_normal", "direction"])


# Meshes


def rows_of(kind):
    return lambda deck: deck.mesh.of(kind) if deck.mesh is not None else []


def is_surface(deck, row):
    return len(row) - 2 in (3, 4) and any(own.get("domain_size") == 2 for _, own in deck.solvers())


@mutator("mesh/node-twice-other-place", "refused", rows_of("Nodes"))
def _(deck, row, dice):
    next(block for block in deck.mesh.blocks if block[0] == "Nodes")[2].append([row[0], "9.9", "9.9", "0"])
    return Claim(names=[f" {row[0]}"])


@mutator("mesh/node-twice-same-place", "told", rows_of("Nodes"))
def _(deck, row, dice):
    next(block for block in deck.mesh.blocks if block[0] == "Nodes")[2].append(list(row))
    return Claim(names=[row[0]])


@mutator(
    "mesh/node-moved-far",
    "told",
    lambda deck: [row for row in rows_of("Nodes")(deck) if any(row[0] in element[2:] for element in deck.mesh.of("Elements"))],
)
def _(deck, row, dice):
    row[1], row[2] = str(float(row[1]) - 1e3), str(float(row[2]) + 1e3)
    return Claim(names=["element", "facet", "Jacobian", "inverted", "negative", "volume", "area", row[0]])


for word in ("nan", "inf", "1e400", "1,5", "x", "1e300"):

    @mutator(f"mesh/coordinate={word}", "refused", rows_of("Nodes"), decks=3)
    def _(deck, row, dice, word=word):
        row[1] = word
        return Claim(names=["mdpa", row[0]])


@mutator("mesh/element-reversed", "told", lambda deck: [row for row in rows_of("Elements")(deck) if is_surface(deck, row)], harmless=True)
def _(deck, row, dice):
    row[2:] = row[:1:-1]
    return Claim(names=[row[0]])


@mutator(
    "mesh/all-elements-reversed",
    "told",
    lambda deck: [row for row in rows_of("Elements")(deck) if is_surface(deck, row)][:1],
    harmless=True,
)
def _(deck, row, dice):
    for row in deck.mesh.of("Elements"):
        row[2:] = row[:1:-1]
    return Claim(names=["element", "Element"])


@mutator(
    "mesh/element-twisted", "refused", lambda deck: [row for row in rows_of("Elements")(deck) if is_surface(deck, row) and len(row) == 6]
)
def _(deck, row, dice):
    row[2], row[3] = row[3], row[2]
    return Claim(names=[row[0]])


@mutator("mesh/element-collapsed", "told", rows_of("Elements"))
def _(deck, row, dice):
    if len(row) < 5:
        return None
    row[3] = row[2]
    return Claim(names=[row[0]])


@mutator("mesh/element-flat", "refused", lambda deck: [row for row in rows_of("Elements")(deck) if is_surface(deck, row)])
def _(deck, row, dice):
    nodes = {node[0]: node for node in deck.mesh.of("Nodes")}
    for node in row[3:]:
        nodes[node][1:] = nodes[row[2]][1:]
    return Claim(names=[row[0], "element", "facet"])


@mutator(
    "mesh/element-listed-but-missing",
    "refused",
    lambda deck: [part for _, part in deck.mesh.all_parts() if part.lists.get("Elements")] if deck.mesh else [],
)
def _(deck, part, dice):
    part.lists["Elements"].append("99999999")
    return Claim(names=["99999999"])


@mutator(
    "mesh/node-listed-but-missing",
    "refused",
    lambda deck: [part for _, part in deck.mesh.all_parts() if part.lists.get("Nodes")] if deck.mesh else [],
)
def _(deck, part, dice):
    part.lists["Nodes"].append("99999999")
    return Claim(names=["99999999"])


@mutator(
    "mesh/condition-listed-but-missing",
    "refused",
    lambda deck: [part for _, part in deck.mesh.all_parts() if part.lists.get("Conditions")] if deck.mesh else [],
)
def _(deck, part, dice):
    part.lists["Conditions"].append("99999999")
    return Claim(names=["99999999"])


@mutator("mesh/element-twice", "told", rows_of("Elements"))
def _(deck, row, dice):
    block = next(block for block in deck.mesh.blocks if any(one is row for one in block[2]))
    number = str(1 + max(int(one[0]) for one in deck.mesh.of("Elements")))
    block[2].append([number, *row[1:]])
    for _, part in deck.mesh.all_parts():
        if row[0] in part.lists.get("Elements", []):
            part.lists["Elements"].append(number)
    return Claim(names=[number])


@mutator("mesh/element-id-twice", "refused", rows_of("Elements"))
def _(deck, row, dice):
    block = next(block for block in deck.mesh.blocks if any(one is row for one in block[2]))
    block[2].append([row[0], *(block[2][0][1:])])
    return Claim(names=[row[0]])


@mutator("mesh/condition-twice", "told", rows_of("Conditions"))
def _(deck, row, dice):
    block = next(block for block in deck.mesh.blocks if any(one is row for one in block[2]))
    number = str(1 + max(int(one[0]) for one in deck.mesh.of("Conditions")))
    block[2].append([number, *row[1:]])
    for _, part in deck.mesh.all_parts():
        if row[0] in part.lists.get("Conditions", []):
            part.lists["Conditions"].append(number)
    return Claim(names=[number])


@mutator("mesh/condition-reversed", "told", rows_of("Conditions"), harmless=True)
def _(deck, row, dice):
    if len(row) - 2 not in (2, 3, 4):
        return None
    row[2:] = [row[3], row[2], *row[4:]] if len(row) == 4 else row[:1:-1]
    return Claim(names=[row[0], "faces", "facet"])


@mutator(
    "mesh/condition-of-inner-face", "told", lambda deck: rows_of("Elements")(deck) if loads(deck) and rows_of("Conditions")(deck) else []
)
def _(deck, row, dice):
    # A loaded line across an element.
    own = loads(deck)[0]
    part = deck.mesh.named(own["model_part_name"].split(".", 1)[-1])
    if part is None or not part.lists.get("Conditions") or len(row) != 6 or not is_surface(deck, row):
        return None
    ids = part.lists["Conditions"]
    block = next(block for block in deck.mesh.blocks if any(one[0] == ids[0] for one in block[2]) and block[0] == "Conditions")
    block[2].append(["999901", block[2][0][1], row[2], row[4]])
    ids.append("999901")
    part.lists["Nodes"] = sorted({*part.lists.get("Nodes", []), row[2], row[4]}, key=int)
    return Claim(names=["999901"])


@mutator("mesh/condition-nodes-of-two-bodies", "told", lambda deck: rows_of("Conditions")(deck) if contact(deck) else [])
def _(deck, row, dice):
    if len(row) != 4:
        return None
    nodes = deck.mesh.of("Nodes")
    row[3] = nodes[0][0] if nodes[0][0] not in row[2:] else nodes[-1][0]
    return Claim(names=[row[0], row[3]])


@mutator("mesh/hanging-node", "told", rows_of("Elements"), harmless=True)
def _(deck, row, dice):
    number = str(1 + max(int(one[0]) for one in deck.mesh.of("Nodes")))
    next(block for block in deck.mesh.blocks if block[0] == "Nodes")[2].append([number, "3", "3", "3"])
    for path, part in deck.mesh.all_parts():
        part.lists.setdefault("Nodes", []).append(number)
    return Claim(names=[number, "node"])


@mutator("mesh/lips-not-merged", "told", lambda deck: rows_of("Elements")(deck) if not in_pairs(deck) and not contact(deck) else [])
def _(deck, row, dice):
    nodes = {node[0]: node for node in deck.mesh.of("Nodes")}
    shared = [node for node in row[2:] if sum(node in one[2:] for one in deck.mesh.of("Elements")) > 1]
    if not shared:
        return None
    number = str(1 + max(int(one) for one in nodes))
    next(block for block in deck.mesh.blocks if block[0] == "Nodes")[2].append([number, *nodes[shared[0]][1:]])
    row[2 + row[2:].index(shared[0])] = number
    for path, part in deck.mesh.all_parts():
        if shared[0] in part.lists.get("Nodes", []):
            part.lists["Nodes"].append(number)
    return Claim(names=[number])


@mutator(
    "mesh/element-unknown", "refused", lambda deck: [block for block in deck.mesh.blocks if block[0] == "Elements"] if deck.mesh else []
)
def _(deck, block, dice):
    block[1] = ["NoSuchElement2D4N"]
    return Claim(names=["NoSuchElement2D4N"])


@mutator(
    "mesh/element-of-other-shape",
    "refused",
    lambda deck: [block for block in deck.mesh.blocks if block[0] == "Elements"] if deck.mesh else [],
)
def _(deck, block, dice):
    before = block[1][0]
    block[1] = [re.sub(r"(\d)N$", lambda found: "3N" if found.group(1) != "3" else "4N", before)]
    return None if block[1][0] == before else Claim(names=[block[1][0], "nodes", "mdpa"])


@mutator(
    "mesh/quadrilaterals-as-tetrahedra",
    "refused",
    lambda deck: [block for block in deck.mesh.blocks if block[0] == "Elements" and "2D4N" in str(block[1])] if deck.mesh else [],
)
def _(deck, block, dice):
    block[1] = [block[1][0].replace("2D4N", "3D4N")]
    return Claim(names=[block[1][0], "plane", "volume", "domain_size", "dimension"])


@mutator(
    "mesh/part-without-its-nodes",
    "told",
    lambda deck: (
        [part for _, part in deck.mesh.all_parts() if part.lists.get("Conditions") and part.lists.get("Nodes")] if deck.mesh else []
    ),
    harmless=True,
)
def _(deck, part, dice):
    part.lists["Nodes"] = []
    return Claim(names=[part.name])


@mutator("mesh/part-twice", "told", lambda deck: deck.mesh.parts if deck.mesh else [], harmless=True)
def _(deck, part, dice):
    deck.mesh.parts.append(Part(part.name, {"Nodes": deck.mesh.of("Nodes")[0][:1]}, [], []))
    return Claim(names=[part.name])


@mutator(
    "mesh/element-in-no-material",
    "refused",
    lambda deck: [part for _, part in deck.mesh.all_parts() if len(part.lists.get("Elements", [])) > 2] if deck.mesh else [],
    harmless=True,
)
def _(deck, part, dice):
    part.lists["Elements"].pop()
    return Claim(names=["element", "propert", "material"])


@mutator(
    "mesh/out-of-plane",
    "told",
    lambda deck: rows_of("Nodes")(deck) if any(own.get("domain_size") == 2 for _, own in deck.solvers()) else [],
)
def _(deck, row, dice):
    row[3] = "0.37"
    return Claim(names=[row[0], "plane", "Z"])


# Changes without meaning


def plain(deck):
    return [deck.mesh] if deck.mesh is not None and deck.mesh.is_plain() else []


def named_nodes(deck):
    return any(word in json.dumps(deck.project) for word in ("impose_rigid", "master_node_id", "mpc_contact", "_check_"))


@mutator("same/renumbered-nodes", "same", lambda deck: plain(deck) if not named_nodes(deck) else [], decks=40)
def _(deck, mesh, dice):
    old = [row[0] for row in mesh.of("Nodes")]
    new = list(old)
    dice.shuffle(new)
    to = dict(zip(old, new))
    for kind, _, rows in mesh.blocks:
        for row in rows:
            if kind == "Nodes":
                row[0] = to[row[0]]
            elif kind in ("Elements", "Conditions"):
                row[2:] = [to[word] for word in row[2:]]
    for _, part in mesh.all_parts():
        part.lists["Nodes"] = [to[word] for word in part.lists.get("Nodes", [])]
    return Claim(nodes=to)


@mutator("same/node-ids-with-gaps", "same", lambda deck: plain(deck) if not named_nodes(deck) else [], decks=20)
def _(deck, mesh, dice):
    to = {row[0]: str(7 * int(row[0]) + 1000) for row in mesh.of("Nodes")}
    for kind, _, rows in mesh.blocks:
        for row in rows:
            if kind == "Nodes":
                row[0] = to[row[0]]
            elif kind in ("Elements", "Conditions"):
                row[2:] = [to[word] for word in row[2:]]
    for _, part in mesh.all_parts():
        part.lists["Nodes"] = [to[word] for word in part.lists.get("Nodes", [])]
    return Claim(nodes=to)


for kind in ("Elements", "Conditions"):

    @mutator(f"same/renumbered-{kind.lower()}", "same", plain, decks=30)
    def _(deck, mesh, dice, kind=kind):
        old = [row[0] for row in mesh.of(kind)]
        new = list(old)
        dice.shuffle(new)
        to = dict(zip(old, new))
        for row in mesh.of(kind):
            row[0] = to[row[0]]
        for _, part in mesh.all_parts():
            if kind in part.lists:
                part.lists[kind] = [to[word] for word in part.lists[kind]]
        return Claim()

    @mutator(f"same/order-of-{kind.lower()}", "same", plain, decks=30)
    def _(deck, mesh, dice, kind=kind):
        for block in mesh.blocks:
            if block[0] == kind:
                dice.shuffle(block[2])
        return Claim()


@mutator("same/order-of-nodes", "same", plain, decks=30)
def _(deck, mesh, dice):
    for block in mesh.blocks:
        if block[0] == "Nodes":
            dice.shuffle(block[2])
    return Claim()


@mutator(
    "same/first-node-of-elements",
    "same",
    lambda deck: (
        plain(deck)
        if plain(deck)
        and any(is_surface(deck, row) for row in deck.mesh.of("Elements"))
        and not any("Triangles" in str(block[1]) for block in deck.mesh.blocks)
        else []
    ),
    decks=30,
)
def _(deck, mesh, dice):
    for row in mesh.of("Elements"):
        if is_surface(deck, row):
            turn = dice.randrange(len(row) - 2)
            row[2:] = row[2 + turn :] + row[2 : 2 + turn]
    return Claim()


@mutator("same/order-in-parts", "same", plain, decks=20)
def _(deck, mesh, dice):
    for _, part in mesh.all_parts():
        for ids in part.lists.values():
            dice.shuffle(ids)
    return Claim()


@mutator("same/order-of-parts", "same", plain, decks=20)
def _(deck, mesh, dice):
    dice.shuffle(mesh.parts)
    return Claim()


@mutator("same/order-of-processes", "same", always, decks=30)
def _(deck, own, dice):
    modules = json.dumps(deck.project)
    if "mixture" in str(deck.folder) or "impose_rigid" in modules or deck.settings("transient"):
        return None
    for listed in deck.lists():
        listed.reverse()
    return Claim()


@mutator("same/order-of-process-lists", "same", always, decks=20)
def _(deck, own, dice):
    for stage in deck.stages:
        if isinstance(stage.get("processes"), dict):
            stage["processes"] = dict(reversed(list(stage["processes"].items())))
    return Claim()


@mutator("same/order-of-keys", "same", always, decks=30)
def _(deck, own, dice):
    def turned(node):
        if isinstance(node, dict):
            return {key: turned(value) for key, value in reversed(list(node.items()))}
        return [turned(value) for value in node] if isinstance(node, list) else node

    if "stages" in deck.project:
        return None
    deck.project = {key: value if key == "processes" else turned(value) for key, value in deck.project.items()}
    deck.stages = [deck.project]
    deck.materials = {name: turned(document) for name, document in deck.materials.items()}
    return Claim()


@mutator(
    "same/order-of-materials",
    "same",
    lambda deck: [document for document in deck.materials.values() if len(document.get("properties", [])) > 1],
    decks=20,
)
def _(deck, document, dice):
    document["properties"].reverse()
    return Claim()


@mutator("same/ids-of-materials", "same", lambda deck: list(deck.materials.values()) if len(deck.materials) == 1 else [], decks=20)
def _(deck, document, dice):
    if "sub_properties" in json.dumps(document):
        return None
    for item in document["properties"]:
        item["properties_id"] += 40
    return Claim()


@mutator("same/parts-renamed", "same", plain, decks=20)
def _(deck, mesh, dice):
    names = sorted({part.name for _, part in mesh.all_parts()}, key=len, reverse=True)
    if any(name in deck.roots() for name in names):
        return None

    def renamed(node):
        if isinstance(node, dict):
            return {key: renamed(value) if key not in ("variable_name", "output_file_name") else value for key, value in node.items()}
        if isinstance(node, list):
            return [renamed(value) for value in node]
        if isinstance(node, str):
            return ".".join(f"Q_{word}" if word in names else word for word in node.split("."))
        return node

    if "stages" in deck.project:
        return None
    deck.project = renamed(deck.project)
    deck.stages = [deck.project]
    deck.materials = {name: renamed(document) for name, document in deck.materials.items()}
    for _, part in list(mesh.all_parts()):
        part.name = f"Q_{part.name}"
    return Claim()


@mutator("same/mesh-with-comments", "same", plain, decks=10)
def _(deck, mesh, dice):
    name = next(iter(deck.meshes))
    text = mesh.text().replace("\nEnd ", "  // a comment\n\n\t End ").replace("\n", "\r\n")
    deck.texts[name] = "// a mesh\r\n" + text
    return Claim()


@mutator("same/interval-spelt-out", "same", lambda deck: [own for own in boundary(deck) if own.get("interval") == [0.0, "End"]], decks=15)
def _(deck, own, dice):
    own["interval"] = [0.0, 1e30]
    return Claim()


@mutator("same/number-as-function", "same", loads, decks=15)
def _(deck, own, dice):
    key = "modulus" if "modulus" in own else "value"
    if not isinstance(own.get(key), (int, float)):
        return None
    own[key] = f"{own[key]!r} + 0.0*x*t"
    return Claim()


@mutator("same/unused-part", "same", plain, decks=10)
def _(deck, mesh, dice):
    mesh.parts.append(Part("Unused", {"Nodes": [mesh.of("Nodes")[0][0]]}, [], []))
    return Claim()


@mutator("same/part-in-part", "same", plain, decks=15)
def _(deck, mesh, dice):
    part = dice.choice(mesh.parts)
    part.parts.append(Part("Within", {"Nodes": list(part.lists.get("Nodes", []))[:2]}, [], []))
    return Claim()


@mutator("mesh/free-node", "told", lambda deck: plain(deck) if structural(deck) else [], decks=10)
def _(deck, mesh, dice):
    number = str(1 + max(int(one[0]) for one in mesh.of("Nodes")))
    next(block for block in mesh.blocks if block[0] == "Nodes")[2].append([number, "0.3", "0.3", "0"])
    return Claim(names=[number])


@mutator(
    "same/load-as-two-halves-of-faces",
    "same",
    lambda deck: [own for own in of_module("assign_vector_by_direction_to_condition_process")(deck)] if plain(deck) else [],
    decks=10,
)
def _(deck, own, dice):
    part = deck.mesh.named(own["model_part_name"].split(".", 1)[-1])
    if (
        part is None
        or len(part.lists.get("Conditions", [])) < 2
        or own.get("direction") in ("automatic_inwards_normal", "automatic_outwards_normal")
    ):
        return None
    ids = part.lists["Conditions"]
    process = next(process for process in deck.processes() if process["Parameters"] is own)
    for at, half in enumerate((ids[: len(ids) // 2], ids[len(ids) // 2 :])):
        nodes = sorted({node for row in deck.mesh.of("Conditions") if row[0] in half for node in row[2:]}, key=int)
        part.parts.append(Part(f"Half{at}", {"Nodes": nodes, "Conditions": half}, [], []))
        if at:
            other = copy.deepcopy(process)
            other["Parameters"]["model_part_name"] += f".Half{at}"
            deck.add(other)
    own["model_part_name"] += ".Half0"
    return Claim()


def vectors(deck):
    """Whether loads and supports are plain vectors without functions of place: the model can be moved and turned."""
    text = json.dumps([process for process in deck.processes()])
    bad = re.search(
        r'"[^"]*\b[xyzXYZ]\b[^"]*[*/+-][^"]*"|"[^"]*[*/+-]\s*[xyzXYZ]\b|sliding_speed|local_axes|_points_|point_output|line_output|_check_',
        text,
    )
    # Which side of a self contact is the slave depends on the axes.
    bad = bad or any(not own.get("assume_master_slave") for own in in_pairs(deck))
    return not bad and not deck.is_of_revolution() and plain(deck) != []


@mutator("same/moved", "same", lambda deck: plain(deck) if vectors(deck) else [], decks=40, tolerance=1e-8)
def _(deck, mesh, dice):
    for row in mesh.of("Nodes"):
        row[1:3] = [repr(float(row[1]) + 1.25), repr(float(row[2]) - 0.625)]
    return Claim()


def turned_vectors(deck, turn):
    """Turns all vectors of loads and supports; false where one cannot be."""
    for process in deck.processes():
        own, module = process["Parameters"], process.get("python_module", "")
        if not module.startswith("assign_"):
            if module not in ("json_output_process",) and not CONTACT.search(module) and module != "mesh_tying_process":
                return False
            continue
        if re.search(r"_[XYZ]$", str(own.get("variable_name"))):
            return False
        if isinstance(own.get("direction"), list):
            if any(isinstance(one, str) for one in own["direction"]):
                return False
            own["direction"] = turn(own["direction"], lambda one: -one)
        elif "direction" in own:
            pass
        if isinstance(own.get("value"), list):
            own["value"] = turn(own["value"], lambda one: None if one is None else f"-({one})" if isinstance(one, str) else -one)
        if isinstance(own.get("constrained"), list):
            own["constrained"] = turn(own["constrained"], lambda one: one)
    return True


@mutator(
    "same/turned-by-90-degrees", "same", lambda deck: plain(deck) if vectors(deck) and structural(deck) else [], decks=60, tolerance=1e-8
)
def _(deck, mesh, dice):
    turn = lambda vector, negative: [negative(vector[1]), vector[0], vector[2]]
    if not turned_vectors(deck, turn):
        return None
    for row in mesh.of("Nodes"):
        row[1:3] = [repr(-float(row[2])), row[1]]
    return Claim(turn=lambda x, y, z: (y, -x, z))


def scale_value(own, factor):
    key = "modulus" if "modulus" in own else "value"
    if " if " in json.dumps(own.get(key)):
        return False
    scaled = lambda one: (
        None
        if one is None
        else f"({factor!r})*({one})" if isinstance(one, str) else one * factor if isinstance(one, (int, float)) else "table"
    )
    own[key] = [scaled(one) for one in own[key]] if isinstance(own.get(key), list) else scaled(own.get(key))
    return "table" not in (own[key] if isinstance(own[key], list) else [own[key]]) and own[key] is not None


def scalable(deck):
    modules = {process.get("python_module", "") for process in deck.processes()}
    known = all(re.match(r"assign_|json_output|alm_|penalty_|nitsche_|uzawa_|mesh_tying|mpc_contact|vtu|vtk", module) for module in modules)
    known = known and "check_" not in json.dumps(deck.project)
    return (
        plain(deck) if known and structural(deck) and not any(kind in HEAT for kind, _ in deck.solvers()) and len(deck.stages) == 1 else []
    )


def tolerances(deck, factor, length=1.0):
    for kind, own in deck.solvers():
        for key in own:
            if key.endswith("residual_absolute_tolerance"):
                own[key] *= factor


@mutator("scaled/stresses", "scaled", scalable, decks=80, tolerance=1e-8)
def _(deck, mesh, dice):
    factor = 1024.0
    text = json.dumps(deck.project)
    if "manual_ALM" in text or "from_json" in text:
        return None
    for variables in deck.variables():
        for name in variables:
            if name in STRESSES and isinstance(variables[name], (int, float)):
                variables[name] *= factor
    for own in loads(deck):
        if not scale_value(own, factor):
            return None
    tolerances(deck, factor)
    return Claim(factors={"DISPLACEMENT": 1.0, "CONTACT_PRESSURE": factor})


def replaced_lengths(text, factor):
    return re.sub(r"\b([xyzXYZ])\b", rf"(\1/{factor!r})", text)


@mutator("scaled/lengths", "scaled", scalable, decks=80, tolerance=1e-8)
def _(deck, mesh, dice):
    factor = 1024.0
    text = json.dumps(deck.project)
    is_plane = any(own.get("domain_size") == 2 for _, own in deck.solvers())
    if (
        "manual_ALM" in text
        or "CROSS_AREA" in json.dumps(deck.materials)
        or deck.is_of_revolution()
        or "SpringDamper" in mesh.text()
        or "TrussElement" in mesh.text()
        or "HARDENING" in json.dumps(deck.materials)
    ):
        return None
    for row in mesh.of("Nodes"):
        row[1:] = [repr(float(word) * factor) for word in row[1:]]
    for variables in deck.variables():
        if "DENSITY" in variables:
            variables["DENSITY"] /= factor**2
    for process in deck.processes():
        own = process["Parameters"]
        if not process.get("python_module", "").startswith("assign_"):
            continue
        for key in ("modulus", "value"):
            if isinstance(own.get(key), str):
                own[key] = replaced_lengths(own[key], factor)
            elif isinstance(own.get(key), list):
                own[key] = [replaced_lengths(one, factor) if isinstance(one, str) else one for one in own[key]]
        name = str(own.get("variable_name"))
        power = {"POINT_LOAD": 1 if is_plane else 2, "LINE_LOAD": 0 if is_plane else 1, "VOLUME_ACCELERATION": 1}.get(
            name, 1 if re.match("DISPLACEMENT|VELOCITY|ACCELERATION", name) else 0 if name in LOADS else None
        )
        if power is None or own.get("local_axes"):
            return None
        if power and not scale_value(own, factor**power):
            return None
    for kind, own in deck.solvers():
        for key in own:
            if key.endswith("displacement_absolute_tolerance"):
                own[key] *= factor
            elif key.endswith("residual_absolute_tolerance"):
                own[key] *= factor ** (1 if is_plane else 2)
    return Claim(factors={"DISPLACEMENT": factor, "CONTACT_PRESSURE": 1.0})


def linear(deck):
    laws = [own.get("name", "") for own in deck.laws()]
    kinds = [word for mesh in deck.meshes.values() for block in mesh.blocks if block[0] == "Elements" for word in block[1]]
    is_linear = all(name.startswith("LinearElastic") for name in laws) and all(
        kind.startswith("SmallDisplacementElement") for kind in kinds
    )
    return scalable(deck) if is_linear and not contact(deck) and not named_nodes(deck) else []


@mutator("scaled/loads-of-linear-model", "scaled", linear, decks=60, tolerance=1e-8)
def _(deck, mesh, dice):
    for own in loads(deck) + supports(deck) + of_module("assign_.*", lambda own: own.get("variable_name") == "VOLUME_ACCELERATION")(deck):
        if not scale_value(own, 4.0):
            return None
    tolerances(deck, 4.0)
    return Claim(factors={"DISPLACEMENT": 4.0})


@mutator(
    "scaled/moduli-of-linear-model",
    "scaled",
    lambda deck: (
        linear(deck)
        if not any(
            isinstance(one, (int, float, str)) and one not in (0, 0.0)
            for own in supports(deck)
            for one in (own["value"] if isinstance(own.get("value"), list) else [own.get("value")])
        )
        else []
    ),
    decks=40,
    tolerance=1e-8,
)
def _(deck, mesh, dice):
    for variables in deck.variables():
        if "YOUNG_MODULUS" in variables:
            variables["YOUNG_MODULUS"] *= 4.0
    return Claim(factors={"DISPLACEMENT": 0.25})


# Runs ------------------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Answer:
    code: int | None
    text: str
    messages: list
    results: dict


def messages_of(text):
    """Errors, warnings and notes with their lines."""
    out = []
    for line in text.split("\n"):
        found = re.match(r"(error|warning|note)(?:\[([\w-]+)\])?", line)
        if found:
            out.append([found.group(1), found.group(2) or "", line])
        elif out and line.startswith("    ") and not re.match(r"\s+\d+ ", line):
            out[-1][2] += "\n" + line
    return out


def run(program, folder, arguments, patience=30, command="run"):
    words = [program, command, DECK] + (["--threads", "1"] if command == "run" and "--threads" not in arguments else [])
    try:
        done = subprocess.run(
            words + (arguments if command == "run" else []),
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**os.environ, "NO_COLOR": "1"},
            preexec_fn=limit,
            timeout=patience,
        )
        code, text = done.returncode, done.stdout.decode(errors="replace")
    except subprocess.TimeoutExpired as late:
        code, text = None, (late.stdout or b"").decode(errors="replace")
    messages = messages_of(text)
    for message in messages:
        for name, line in re.findall(r"([\w.]+\.(?:json|mdpa|csv)):(\d+)", message[2].split("\n")[0]):
            if (folder / name).exists():
                # The line that a place names says the key.
                message.append("".join((folder / name).read_text(errors="replace").split("\n")[int(line) - 1 : int(line)]))
    results = {}
    for kind in ("body", "heat"):
        path = folder / OBSERVED.format(kind)
        if code in (0, 3) and path.exists():
            try:
                results[kind] = json.loads(path.read_text())
            except json.JSONDecodeError:
                results[kind] = "no JSON"
    return Answer(code, text, messages, results)


def table(results):
    """Values by file, node and variable: lists over time."""
    out = {}
    for kind, document in results.items():
        for node, columns in document.items() if isinstance(document, dict) else ():
            if node.startswith("NODE_"):
                for variable, values in columns.items():
                    out[kind, node[5:], variable] = values
    return out


def difference(before, after, claim, size):
    """Largest difference of results, relative to the largest value of each variable."""
    old, new = table(before), table(after)
    if claim.nodes:
        old = {(kind, claim.nodes[node], variable): values for (kind, node, variable), values in old.items()}
    if claim.turn:
        turned = {}
        for (kind, node, variable), values in new.items():
            if variable == "DISPLACEMENT_X":
                rows = [new[kind, node, f"DISPLACEMENT_{axis}"] for axis in "XYZ"]
                for axis, column in zip("XYZ", zip(*(claim.turn(*row) for row in zip(*rows)))):
                    turned[kind, node, f"DISPLACEMENT_{axis}"] = list(column)
            elif not variable.startswith("DISPLACEMENT"):
                turned[kind, node, variable] = values
        new = turned
    largest = {}
    for (kind, _, variable), values in old.items():
        name = (kind, re.sub(r"_[XYZ]$", "", variable))
        largest[name] = max(largest.get(name, 0.0), *(abs(value) for value in values)) if values else largest.get(name, 0.0)
    worst = 0.0
    for place, values in old.items():
        other = new.get(place)
        if other is None or len(other) != len(values):
            return math.inf
        name = re.sub(r"_[XYZ]$", "", place[2])
        factor = claim.factors.get(name, 1.0)
        if factor is None:
            continue
        bound = max(largest[place[0], name], 1e-12 * size if name == "DISPLACEMENT" else 1e-300) * factor
        for one, two in zip(values, other):
            if not isinstance(two, (int, float)) or math.isnan(two):
                return math.inf
            worst = max(worst, abs(one * factor - two) / bound)
    return worst


def stem(message):
    """A message without numbers, to compare those of two runs."""
    return message[0], message[1], re.sub(r"[\d.e+-]+", "#", message[2].split("\n")[0])


def judge(mutator, claim, before, after, size, check):
    """Kind and words of a violation; nothing where the program does as expected."""
    known = {stem(message) for message in before.messages}
    fresh = [message for message in after.messages if stem(message) not in known]
    loud = [message for message in fresh if message[0] != "note"]
    said = "\n".join("\n".join(message[2:]) for message in fresh)
    first = (loud or fresh or [("", "", "")])[0][2].split("\n")[0]
    if after.code not in (0, 2, 3, 4) or "panicked" in after.text:
        return ("broken", f"exit code {after.code}: {after.text[-200:]!r}")
    moved = difference(before.results, after.results, claim, size) if after.code == 0 else math.inf
    if mutator.expects in ("same", "scaled"):
        if after.code != 0:
            return ("failed", f"exit code {after.code}: {first}")
        if moved > mutator.tolerance:
            return ("changed", f"by {moved:.1e}" + (f"; {first}" if first else ""))
        codes = {message[1] for message in before.messages}
        alarms = [message for message in loud if message[1] not in codes]
        return ("false-alarm", alarms[0][2].split("\n")[0]) if alarms else None
    is_named = any(word and word in said for word in claim.names)
    if after.code != 0 and not any(message[0] == "error" for message in after.messages) and after.code == 2 and "error" not in after.text:
        return ("broken", f"exit code {after.code} without an error")
    if not fresh and after.code == 0:
        if moved <= mutator.tolerance:
            return None if mutator.harmless else ("ignored", "")
        return ("silent", f"results differ by {moved:.1e}")
    if not is_named and not any(word and word in after.text for word in claim.names if after.code == 2):
        if mutator.harmless and moved <= mutator.tolerance and after.code == 0:
            return None
        return ("unnamed", f"exit code {after.code}: {first or after.text.strip().split(chr(10))[-1]}")
    if mutator.expects == "refused":
        if after.code == 0:
            return ("accepted", first)
        if after.code == 2 and check is not None and check.code == 0 and "not-finite" not in first:
            return ("unchecked", first)
    return None


class Runs:
    """The decks, their own results, and the counts."""

    def __init__(self, program, keep, decks, slowest):
        self.program, self.keep, self.originals, self.answers = program, keep, {}, {}
        self.slowest, self.decks, self.number, self.counts, self.found = slowest, decks, 0, {}, {}

    def original(self, folder):
        self.has(folder, "")
        return pickle.loads(self.originals[folder][0])

    def has(self, folder, config):
        """Whether a deck has settings of this config."""
        if folder not in self.originals:
            deck = Deck(folder)
            configs = {name for name, _ in deck.solvers()} | {process.get("python_module") for process in deck.processes()}
            self.originals[folder] = pickle.dumps(deck), configs
        return not config or config in self.originals[folder][1]

    def answer(self, folder):
        """The run of the unchanged deck; none where it fails or takes long."""
        if folder not in self.answers:
            with tempfile.TemporaryDirectory() as scratch:
                own = pathlib.Path(scratch) / "deck"
                self.original(folder).write(own)
                start = time.monotonic()
                found = run(self.program, own, [])
                is_short = time.monotonic() - start < self.slowest
                self.answers[folder] = found if found.code == 0 and is_short else None
        return self.answers[folder]

    def attempt(self, mutator, folder, seed):
        """Changes a deck, runs it and judges; false where the mutator does not apply."""
        if not self.has(folder, mutator.config):
            return False
        dice = random.Random(seed)
        deck = self.original(folder)
        places = mutator.places(deck)
        before = self.answer(folder) if places else None
        if not places or before is None:
            return False
        try:
            claim = mutator.change(deck, dice.choice(places), dice)
        except (AttributeError, KeyError, StopIteration, TypeError, ValueError) as problem:
            print(f"the mutator {mutator.name} fails on {folder}: {problem!r}", flush=True)
            return False
        if claim is None:
            return False
        with tempfile.TemporaryDirectory() as scratch:
            own = pathlib.Path(scratch) / "deck"
            deck.write(own)
            after = run(self.program, own, deck.arguments)
            check = None
            if mutator.expects == "refused" and after.code == 2 and not deck.arguments:
                check = run(self.program, own, [], command="check")
            self.number += 1
            wrong = judge(mutator, claim, before, after, deck.size, check)
            if wrong:
                kind, words = wrong
                name = f"{folder.parent.name}/{folder.name}"
                kept = self.keep / kind / re.sub(r"[^\w.=-]", "_", f"{mutator.name}--{folder.name}")
                shutil.rmtree(kept, ignore_errors=True)
                shutil.copytree(own, kept)
                (kept / "said.txt").write_text(after.text)
                (kept / "claim.txt").write_text(
                    f"{mutator.name}: {mutator.expects} {claim.names} {claim.factors}\n{kind}: {words}\n"
                    f"seed {seed}, arguments {deck.arguments}\n"
                )
                self.counts[kind] = self.counts.get(kind, 0) + 1
                self.found.setdefault((kind, mutator.name), []).append(name)
                print(f"{kind} {mutator.name} ({mutator.expects}) {name}: {words[:200]}; {kept}", flush=True)
        return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("decks", type=pathlib.Path, nargs="*")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slowest", type=float, default=1.0, help="seconds that an unchanged deck may take")
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "zelus-meaning")
    parser.add_argument("--only", default="", help="regular expression of the names of mutators")
    parser.add_argument("--list", action="store_true", help="print the mutators")
    options = parser.parse_args()
    chosen = [one for one in MUTATORS if re.search(options.only, one.name)]
    if options.list:
        for one in chosen:
            print(one.expects, one.name)
        return
    folders = options.decks or [ROOT / "tests/cases", ROOT / "examples"]
    decks = sorted(path.parent for folder in folders for path in folder.rglob(DECK))
    decks = [deck for deck in decks if all(mesh.stat().st_size < MOST_MESH for mesh in deck.rglob("*.mdpa"))]
    options.keep.mkdir(parents=True, exist_ok=True)
    runs, end, dice = (
        Runs(options.program.resolve(), options.keep, decks, options.slowest),
        time.monotonic() + options.seconds,
        random.Random(options.seed),
    )
    queues = {one.name: dice.sample(decks, len(decks)) for one in chosen}
    ran, complete = set(), False
    for _ in range(len(decks)):
        if not any(queues.values()) or time.monotonic() > end:
            break
        for one in dice.sample(chosen, len(chosen)):
            left = one.decks
            while left and queues[one.name] and time.monotonic() < end:
                if runs.attempt(one, queues[one.name].pop(), options.seed):
                    left -= 1
                    ran.add(one.name)
        complete = True
    print(
        f"{len(ran)} of {len(chosen)} mutators, {sum(answer is not None for answer in runs.answers.values())} decks, {runs.number} runs; "
        f"violations {dict(sorted(runs.counts.items()))}"
    )
    if not complete:
        print("the first round was not completed")
    raise SystemExit(1 if runs.counts else 0)


if __name__ == "__main__":
    main()
