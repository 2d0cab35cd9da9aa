//! Readers that get random bytes: each must refuse or read them, and return.

use std::path::PathBuf;
use std::sync::OnceLock;

use super::forge::{Contents, contents, with_contents};
use zelus::core::io::{read_mesh, results::vtu_of};
use zelus::core::model::ModelPart;
use zelus::core::parameters::{Document, Expression};
use zelus::{RunOptions, Silent, Simulation};

/// A deck of two blocks in contact, without outputs.
const DECK: [(&str, &str); 3] = [
    ("ProjectParameters.json", include_str!("../deck/ProjectParameters.json")),
    ("StructuralMaterials.json", include_str!("../deck/StructuralMaterials.json")),
    ("mesh.mdpa", include_str!("../deck/mesh.mdpa")),
];

/// A folder of this process with the deck and a run of it that is saved.
fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("zelus-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        DECK.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).expect("a file of the deck"));
        let mut simulation = open(&folder);
        simulation.step(&mut Silent).expect("a step");
        simulation.save(&folder.join("saved")).expect("a saved run");
        folder
    })
}

fn open(folder: &std::path::Path) -> Simulation {
    let options = RunOptions { threads: Some(1), ..RunOptions::default() };
    Simulation::open(&folder.join(DECK[0].0), &options).expect("the deck")
}

/// The contents of a saved run of the deck.
pub fn saved() -> Vec<u8> {
    contents(&whole()).to_vec()
}

fn whole() -> Vec<u8> {
    std::fs::read(folder().join("saved")).expect("the saved run")
}

/// A mesh file, read into a model part.
pub fn mdpa(bytes: &[u8]) {
    let path = folder().join("random.mdpa");
    std::fs::write(&path, bytes).expect("a file");
    let _ = read_mesh(&path, &mut ModelPart::new("Structure"));
}

/// A deck as JSON, and an expression.
pub fn json(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(document) = Document::from_str(text, "deck.json") {
        let again = Document::from_str(&document.root.to_json().to_string(), "again.json").expect("JSON");
        assert_eq!(again.root.to_json(), document.root.to_json());
    }
    let _ = Expression::parse(text);
}

/// The contents of a saved run: with a checksum that is not theirs they are refused, and read with theirs.
pub fn checkpoint(bytes: &[u8]) {
    let whole = whole();
    let path = folder().join("random.saved");
    let head = whole.len() - contents(&whole).len();
    std::fs::write(&path, [&whole[..head], bytes].concat()).expect("a file");
    let loaded = open(folder()).load(&path, &mut Silent);
    assert_eq!(loaded.is_ok(), bytes == contents(&whole), "what is damaged is refused");
    std::fs::write(&path, with_contents(&whole, bytes)).expect("a file");
    let _ = open(folder()).load(&path, &mut Silent);
}

/// A saved run forged as the bytes say, with a checksum that is right: it is refused, or goes on.
pub fn forged(bytes: &[u8]) {
    let whole = whole();
    let mut value = Contents::read(contents(&whole));
    let mut dice = bytes.chunks(2).map(|two| two.iter().fold(0, |sum, &byte| sum << 8 | usize::from(byte)));
    value.forge(&mut || dice.next().unwrap_or(7));
    let path = folder().join("forged.saved");
    std::fs::write(&path, with_contents(&whole, &value.write())).expect("a file");
    let mut simulation = open(folder());
    if simulation.load(&path, &mut Silent).is_ok() {
        let _ = simulation.step(&mut Silent);
    }
}

/// A picture.
pub fn vtu(bytes: &[u8]) {
    let _ = vtu_of(bytes);
}
