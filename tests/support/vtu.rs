//! Reads back the pictures that runs write: VTU files with appended compressed arrays, and lists of pieces.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Components and values of each array, by name.
pub type Columns = BTreeMap<String, (usize, Vec<f64>)>;

/// Arrays over points, their positions among them, and arrays over cells, their connectivity among them.
pub fn read_vtu(path: &Path) -> (Columns, Columns) {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let head = bytes.windows(mark.len()).position(|window| window == mark).expect("appended data");
    let (text, data) = (String::from_utf8_lossy(&bytes[..head]), &bytes[head + mark.len()..]);
    let mut found = [Columns::new(), Columns::new()];
    let mut is_of_cells = false;
    for tag in text.split('<') {
        is_of_cells = is_of_cells || tag.starts_with("CellData") || tag.starts_with("Cells");
        is_of_cells = is_of_cells && !tag.starts_with("Points") && !tag.starts_with("PointData");
        if tag.starts_with("DataArray") {
            let components = attribute(tag, "NumberOfComponents").parse().expect("a number");
            let offset: usize = attribute(tag, "offset").parse().expect("a number");
            let values = numbers(attribute(tag, "type"), &decompressed(&data[offset..]));
            found[usize::from(is_of_cells)].insert(attribute(tag, "Name").to_owned(), (components, values));
        }
    }
    let [points, cells] = found;
    (points, cells)
}

/// The files a PVTU file lists, whose arrays are those it declares.
pub fn sources(path: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let tags = |start: &'static str| text.split('<').filter(move |tag| tag.starts_with(start));
    let files: Vec<PathBuf> = tags("Piece ").map(|tag| path.with_file_name(attribute(tag, "Source"))).collect();
    for file in &files {
        let (points, cells) = read_vtu(file);
        let known = ["connectivity", "offsets", "types"];
        let mut own: Vec<&str> = points.keys().chain(cells.keys()).map(String::as_str).collect();
        own.retain(|name| !known.contains(name));
        let mut declared: Vec<&str> = tags("PDataArray").map(|tag| attribute(tag, "Name")).collect();
        own.sort_unstable();
        declared.sort_unstable();
        assert_eq!(own, declared, "{}", file.display());
    }
    files
}

fn attribute<'t>(tag: &'t str, name: &str) -> &'t str {
    let start = tag.find(&format!("{name}=\"")).unwrap_or_else(|| panic!("{tag} has no {name}")) + name.len() + 2;
    &tag[start..start + tag[start..].find('"').expect("a closing quote")]
}

/// An array: the number of blocks, their size, the size of the last if it is smaller, their compressed sizes, the blocks.
fn decompressed(data: &[u8]) -> Vec<u8> {
    let number = |at: usize| u64::from_le_bytes(data[8 * at..8 * at + 8].try_into().expect("eight bytes")) as usize;
    let blocks = number(0);
    let mut start = 8 * (3 + blocks);
    let mut out = Vec::new();
    for block in 0..blocks {
        let end = start + number(3 + block);
        flate2::read::ZlibDecoder::new(&data[start..end]).read_to_end(&mut out).expect("compressed data");
        start = end;
    }
    out
}

fn numbers(kind: &str, bytes: &[u8]) -> Vec<f64> {
    match kind {
        "Float64" => bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("8"))).collect(),
        "Int64" => bytes.chunks_exact(8).map(|b| i64::from_le_bytes(b.try_into().expect("8")) as f64).collect(),
        "Int32" => bytes.chunks_exact(4).map(|b| i32::from_le_bytes(b.try_into().expect("4")).into()).collect(),
        "UInt8" => bytes.iter().map(|&b| b.into()).collect(),
        other => panic!("numbers of type {other}"),
    }
}
