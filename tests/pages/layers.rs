//! The order of the code: a module uses only those above it in the list of its crate, the framework names no physics, and nothing of
//! a run is global.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Crates whose `lib.rs` lists its modules so that each uses only those above it.
const CRATES: [&str; 8] = [
    "core/src",
    "linear_algebra/src",
    "petsc/src",
    "applications/structural_mechanics/src",
    "applications/contact_structural_mechanics/src",
    "applications/constrained_optimization/src",
    "applications/convection_diffusion/src",
    "src",
];

/// The crate whose folders each hold files that use each other one way.
const CONTACT: &str = "applications/contact_structural_mechanics/src";

/// Variables, flags and keys of applications.
const PHYSICS: [&str; 25] = [
    "DISPLACEMENT",
    "VELOCITY",
    "ACCELERATION",
    "REACTION",
    "ROTATION",
    "TEMPERATURE",
    "CONDUCTIVITY",
    "PRESSURE",
    "VOLUME_ACCELERATION",
    "MIDDLE_VELOCITY",
    "FORCE_RESIDUAL",
    "NODAL_MASS",
    "NORMAL",
    "RAYLEIGH_ALPHA",
    "RAYLEIGH_BETA",
    "DENSITY",
    "YOUNG_MODULUS",
    "THICKNESS",
    "CONTACT",
    "SLAVE",
    "MASTER",
    "SLIP",
    "contact_model_part",
    "mesh_tying_model_part",
    "assume_master_slave",
];

/// Types of a global that changes.
const CHANGEABLE: [&str; 6] = ["Mutex", "RwLock", "Cell<", "Lock<", "Atomic", "static mut"];

/// Globals that hold no state of a run: constants that are read or computed once, the lock of a library that takes one caller at a
/// time, and how deep a reader of states within states is on its thread.
const CONSTANT: [&str; 10] =
    ["DEPTH", "VARIABLES", "FLAGS", "RATES", "RANGES", "CSV_DEFAULTS", "TABLES", "CODES", "METIS", "NAMES"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The code of a file without comments and without its tests; nothing of files that are tests.
fn code(path: &Path) -> String {
    let name = path.file_name().unwrap().to_string_lossy();
    if name.contains("test") {
        return String::new();
    }
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    text.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            out.push(path);
        }
    }
}

/// The modules that `lib.rs` lists.
fn listed(folder: &Path) -> Vec<String> {
    let lib = std::fs::read_to_string(folder.join("lib.rs")).unwrap();
    let module = |line: &str| {
        let line = line.trim();
        let line = line.strip_prefix("pub(crate) ").or(line.strip_prefix("pub ")).unwrap_or(line);
        line.strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned)
    };
    lib.lines().filter_map(module).collect()
}

fn word_at(text: &str) -> &str {
    &text[..text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len())]
}

/// Names after `prefix`, those of `prefix{a::b, c}` too.
fn names_after<'t>(text: &'t str, prefix: &str) -> Vec<&'t str> {
    let mut out = Vec::new();
    for (at, _) in text.match_indices(prefix) {
        let is_word = text[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$');
        if is_word {
            continue;
        }
        let rest = &text[at + prefix.len()..];
        let Some(list) = rest.strip_prefix('{') else {
            out.push(word_at(rest));
            continue;
        };
        let mut depth = 1;
        let mut begins = true;
        for (i, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 1 => begins = true,
                _ if begins && !c.is_whitespace() => {
                    out.push(word_at(&list[i..]));
                    begins = false;
                }
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    out
}

/// Modules of its own crate that a file uses: names of modules at the crate's top.
fn used(text: &str, is_at_top: bool) -> Vec<&str> {
    let mut out = names_after(text, "crate::");
    if is_at_top {
        out.extend(names_after(text, "super::"));
    }
    out
}

/// Modules that use one below themselves, as "module uses module (file)".
fn reaching_forward(folder: &Path) -> Vec<String> {
    let modules = listed(folder);
    let mut files = Vec::new();
    sources(folder, &mut files);
    let mut out = Vec::new();
    for file in files {
        let inside = file.strip_prefix(folder).unwrap();
        let top = inside.iter().next().unwrap().to_string_lossy();
        let Some(own) = modules.iter().position(|module| *module == top.trim_end_matches(".rs")) else { continue };
        let text = code(&file);
        for name in used(&text, inside.iter().count() == 1) {
            if modules.iter().position(|module| module == name).is_some_and(|at| at > own) {
                out.push(format!("{} uses {name} ({})", modules[own], inside.display()));
            }
        }
    }
    out
}

#[test]
fn a_module_uses_only_those_above_it() {
    let mut wrong = Vec::new();
    for name in CRATES {
        let folder = root().join(name);
        assert!(!listed(&folder).is_empty(), "{name} lists no modules");
        wrong.extend(reaching_forward(&folder).into_iter().map(|what| format!("{name}: {what}")));
    }
    assert!(wrong.is_empty(), "used before they are listed:\n{}", wrong.join("\n"));
}

#[test]
fn every_way_of_naming_a_module_is_seen() {
    let text =
        "use crate::a::B;\nuse crate::{c::D, e::{F, G}, h};\nlet x = crate::i::j();\n$crate::k::l();\nuse super::m::N;";
    assert_eq!(used(text, true), ["a", "c", "e", "h", "i", "m"]);
    assert_eq!(used(text, false), ["a", "c", "e", "h", "i"]);
}

/// The files of a folder, each with the files beside it that it uses.
fn uses_of_files(folder: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let mut paths = Vec::new();
    sources(folder, &mut paths);
    let named = |path: &PathBuf| (path.file_stem().unwrap().to_string_lossy().into_owned(), code(path));
    let mut texts: BTreeMap<String, String> = paths.iter().map(named).collect();
    let face = texts.remove("mod").unwrap_or_default();
    let shown: Vec<(String, String)> = texts
        .keys()
        .flat_map(|file| {
            names_after(&face, &format!("{file}::")).into_iter().map(|item| (item.to_owned(), file.clone()))
        })
        .collect();
    let file_of = |name: &str| match texts.contains_key(name) {
        true => Some(name.to_owned()),
        false => shown.iter().find(|(item, _)| item == name).map(|(_, file)| file.clone()),
    };
    let uses = |(file, text): (&String, &String)| {
        let used = names_after(text, "super::").into_iter().filter_map(file_of).filter(|other| other != file);
        (file.clone(), used.collect())
    };
    texts.iter().map(uses).collect()
}

/// The files that are left when those that use none of the others are taken away, again and again: loops, and their users.
fn looped(mut uses: BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    loop {
        let free: Vec<String> = uses.iter().filter(|(_, used)| used.is_empty()).map(|(file, _)| file.clone()).collect();
        if free.is_empty() {
            return uses.into_keys().collect();
        }
        for file in free {
            uses.remove(&file);
            uses.values_mut().for_each(|used| {
                used.remove(&file);
            });
        }
    }
}

#[test]
fn files_of_a_folder_of_contact_use_each_other_one_way() {
    let mut wrong = Vec::new();
    for module in &listed(&root().join(CONTACT)) {
        let folder = root().join(CONTACT).join(module);
        if folder.is_dir() {
            let files = looped(uses_of_files(&folder));
            if !files.is_empty() {
                wrong.push(format!("{module}: {}", files.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "in loops, or users of those:\n{}", wrong.join("\n"));
}

#[test]
fn loops_of_files_are_seen() {
    let uses = |of: &[(&str, &[&str])]| {
        of.iter()
            .map(|(file, used)| ((*file).to_owned(), used.iter().map(|name| (*name).to_owned()).collect()))
            .collect()
    };
    assert!(looped(uses(&[("a", &[]), ("b", &["a"]), ("c", &["a", "b"])])).is_empty());
    assert_eq!(looped(uses(&[("a", &["c"]), ("b", &["a"]), ("c", &["b"]), ("d", &[])])), ["a", "b", "c"]);
    assert!(uses_of_files(&root().join(CONTACT).join("mortar")).values().any(|used| !used.is_empty()), "uses are read");
}

#[test]
fn the_framework_names_no_physics() {
    let mut files = Vec::new();
    sources(&root().join("core/src"), &mut files);
    let mut wrong = Vec::new();
    for file in files {
        let text = code(&file);
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        let named: Vec<&str> = words.filter(|word| PHYSICS.contains(word)).collect();
        if !named.is_empty() {
            wrong.push(format!("{}: {}", file.strip_prefix(root()).unwrap().display(), named.join(", ")));
        }
    }
    assert!(wrong.is_empty(), "variables, flags or keys of applications:\n{}", wrong.join("\n"));
}

/// Runs that stand beside each other in one program, over ranks or alone, know nothing of each other.
#[test]
fn nothing_of_a_run_is_global() {
    let mut wrong = Vec::new();
    for name in CRATES {
        let mut files = Vec::new();
        sources(&root().join(name), &mut files);
        for file in files {
            // The rounds over a range of entities are told to laws by the thread: they begin and end within one call.
            if file.ends_with("entities/together.rs") {
                continue;
            }
            let text = code(&file);
            let statics = text.lines().filter_map(|line| {
                let line = line.trim_start();
                let at = line.find("static ").filter(|&at| at == 0 || line.starts_with("pub"))?;
                let is_changeable = CHANGEABLE.iter().any(|word| line.contains(word));
                let name = word_at(&line[at + "static ".len()..]);
                (is_changeable && !CONSTANT.contains(&name)).then_some(line)
            });
            // A reader of states within states counts how deep it is, so that a forged file ends in an error.
            let threads = text.lines().filter(|line| line.contains("thread_local!") && !file.ends_with("packed.rs"));
            // MPI's own world is named in one file.
            let worlds = text.lines().filter(|line| line.contains("world()") && !file.ends_with("mpi_world.rs"));
            let worlds = worlds.filter(|_| name != "petsc/src");
            let place = file.strip_prefix(root()).unwrap().display();
            wrong.extend(statics.chain(threads).chain(worlds).map(|line| format!("{place}: {line}")));
        }
    }
    assert!(wrong.is_empty(), "global state:\n{}", wrong.join("\n"));
}
