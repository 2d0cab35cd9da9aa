//! What random bytes are given to: each reader must refuse or read them, and come back.

use std::path::PathBuf;
use std::sync::OnceLock;

use zelus::core::io::{SavedFile, read_mesh, results::vtu_of};
use zelus::core::model::ModelPart;
use zelus::core::parameters::{Document, Expression};
use zelus::{RunOptions, Silent, Simulation};

/// A deck of two blocks in contact, without outputs.
const DECK: [(&str, &str); 3] = [
    ("ProjectParameters.json", include_str!("../deck/ProjectParameters.json")),
    ("StructuralMaterials.json", include_str!("../deck/StructuralMaterials.json")),
    ("mesh.mdpa", include_str!("../deck/mesh.mdpa")),
];
/// Bytes of a saved run of one process before the length of its contents: mark, version, number of processes.
const MARK: usize = 16 + 4 + 4;

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
    std::fs::read(folder().join("saved")).expect("the saved run")[MARK + 12..].to_vec()
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

/// The contents of a saved run: with a checksum that is not theirs they are refused, and read as what they are with theirs.
pub fn checkpoint(contents: &[u8]) {
    let whole = std::fs::read(folder().join("saved")).expect("the saved run");
    let path = folder().join("random.saved");
    let write = |head: &[&[u8]]| std::fs::write(&path, [&head.concat(), contents].concat()).expect("a file");
    write(&[&whole[..MARK + 12]]);
    let loaded = open(folder()).load(&path, &mut Silent);
    assert_eq!(loaded.is_ok(), contents == &whole[MARK + 12..], "what is damaged is refused");
    let (length, sum) = ((contents.len() as u64).to_le_bytes(), crc32fast::hash(contents).to_le_bytes());
    write(&[&whole[..MARK], &length, &sum]);
    let _ = SavedFile::open(&path).and_then(|file| file.read::<serde::de::IgnoredAny>(0));
}

/// A picture.
pub fn vtu(bytes: &[u8]) {
    let _ = vtu_of(bytes);
}
