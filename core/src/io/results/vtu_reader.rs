//! Reads the VTU, PVTU and PVD files that runs write.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use flate2::read::ZlibDecoder;

use super::dataset::{Column, Dataset, Values};
use crate::diagnostics::{Diagnostic, Error, Place, Result};
use crate::geometry::Shape;

/// Text between the tags of a file and its arrays.
const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
/// Most bytes of an array: damaged lengths must not fill the memory.
const MOST: u64 = 1 << 34;

/// The columns that hold the ids of points and of cells, where they are written.
const POINT_ID: &str = "KRATOS_NODE_ID";
const CELL_IDS: [&str; 2] = ["KRATOS_ELEMENT_ID", "KRATOS_CONDITION_ID"];

/// Times and files of the mesh in a PVD file, without surfaces beside it.
///
/// # Errors
/// A file that cannot be read or is none.
pub fn read_pvd(path: &Path) -> Result<Vec<(f64, PathBuf)>> {
    let text = fs::read_to_string(path).map_err(|error| unreadable(path, &error.to_string()))?;
    let is_mesh = |tag: &&str| attribute(tag, "part").is_none_or(|part| part == "0");
    let of = |tag: &str| {
        let time = attribute(tag, "timestep")?.parse().ok()?;
        Some((time, path.with_file_name(unescape(attribute(tag, "file")?))))
    };
    let tags = text.split('<').filter(|tag| tag.starts_with("DataSet ")).filter(is_mesh);
    tags.map(|tag| of(tag).ok_or_else(|| unreadable(path, "a step has no time or no file"))).collect()
}

/// The picture of a VTU file, or of a PVTU file the pieces one after another. Ids are those of the columns that hold them, else empty.
///
/// # Errors
/// A file that cannot be read, or that no run of this program has written.
pub fn read_vtu(path: &Path) -> Result<Dataset> {
    let bytes = fs::read(path).map_err(|error| unreadable(path, &error.to_string()))?;
    if path.extension().is_none_or(|ending| ending != "pvtu") {
        return vtu_of(&bytes).map_err(|fact| unreadable(path, &fact));
    }
    let text = String::from_utf8_lossy(&bytes);
    let mut whole: Option<Dataset> = None;
    for tag in text.split('<').filter(|tag| tag.starts_with("Piece ")) {
        let source = attribute(tag, "Source").ok_or_else(|| unreadable(path, "a piece has no file"))?;
        let piece = read_vtu(&path.with_file_name(unescape(source)))?;
        match &mut whole {
            None => whole = Some(piece),
            Some(whole) => add(whole, piece).map_err(|fact| unreadable(path, &fact))?,
        }
    }
    Ok(whole.unwrap_or_default())
}

/// The picture that the bytes of a VTU file hold.
///
/// # Errors
/// The fault of the bytes.
pub fn vtu_of(bytes: &[u8]) -> std::result::Result<Dataset, String> {
    let head = bytes.windows(MARK.len()).position(|window| window == MARK).ok_or("it has no appended data")?;
    let (text, data) = (String::from_utf8_lossy(&bytes[..head]), &bytes[head + MARK.len()..]);
    let mut columns: [Vec<Column>; 3] = [const { Vec::new() }; 3];
    let mut within = 2;
    for tag in text.split('<') {
        match tag.split(['>', ' ', '/']).next().unwrap_or_default() {
            "PointData" => within = 0,
            "CellData" => within = 1,
            "Points" | "Cells" => within = 2,
            "DataArray" => columns[within].push(column(tag, data)?),
            _ => {}
        }
    }
    let [point_data, cell_data, mut mesh] = columns;
    let mut take = |name: &str| {
        let at = mesh.iter().position(|column| column.name == name).ok_or(format!("it has no array {name}"))?;
        Ok::<_, String>(mesh.swap_remove(at).values)
    };
    let Values::Real(points) = take("Points")? else { return Err("points are whole numbers".to_owned()) };
    let whole = |values| match values {
        Values::Whole(values) => Ok(values),
        Values::Real(_) => Err("cells hold real numbers".to_owned()),
    };
    let [connectivity, types] = [whole(take("connectivity")?)?, whole(take("types")?)?];
    let mut out = Dataset {
        points: points.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect(),
        point_ids: ids(&point_data, &[POINT_ID]),
        point_data,
        cell_data,
        ..Dataset::default()
    };
    let cell_ids = ids(&out.cell_data, &CELL_IDS);
    let mut rest = connectivity.as_slice();
    for (at, kind) in types.iter().enumerate() {
        let shape = Shape::ALL.into_iter().find(|shape| i32::from(shape.cell().vtk_type) == *kind);
        let shape = shape.ok_or_else(|| format!("cells of type {kind} are not known"))?;
        let own = rest.split_off(..shape.nodes()).ok_or("cells have too few points")?;
        let mut nodes = vec![0; own.len()];
        for (&place, &point) in shape.cell().vtk_order.iter().zip(own) {
            nodes[place] = u32::try_from(point)
                .ok()
                .filter(|&point| (point as usize) < out.points.len())
                .ok_or("a cell names a point that is not there")?;
        }
        out.cells.push(cell_ids.get(at).copied().unwrap_or_default(), 0, shape, nodes);
    }
    let lengths = [(&out.point_data, out.points.len()), (&out.cell_data, out.cells.len())];
    let has = |column: &Column, count: usize| column.values.len() == count * column.components;
    match lengths.iter().find_map(|(columns, count)| columns.iter().find(|column| !has(column, *count))) {
        Some(column) => Err(format!("the array {} has another length than its mesh", column.name)),
        None => Ok(out),
    }
}

fn ids(columns: &[Column], names: &[&str]) -> Vec<usize> {
    let column = columns.iter().find(|column| names.contains(&column.name.as_str()));
    match column.map(|column| &column.values) {
        Some(Values::Whole(ids)) => ids.iter().map(|&id| id as usize).collect(),
        _ => Vec::new(),
    }
}

fn column(tag: &str, data: &[u8]) -> std::result::Result<Column, String> {
    let get = |name: &str| attribute(tag, name).ok_or(format!("an array has no {name}"));
    let name = unescape(get("Name")?);
    let components: usize =
        get("NumberOfComponents")?.parse().ok().filter(|&n| n > 0).ok_or("a wrong number of components")?;
    let offset: usize = get("offset")?.parse().map_err(|_| "an array has no offset".to_owned())?;
    let bytes = data.get(offset..).and_then(decompressed).ok_or(format!("the array {name} is damaged"))?;
    let values = match get("type")? {
        "Float64" => Values::Real(numbers(&bytes, f64::from_le_bytes)),
        "Int32" => Values::Whole(numbers(&bytes, i32::from_le_bytes)),
        "Int64" => Values::Whole(numbers(&bytes, |b| i32::try_from(i64::from_le_bytes(b)).unwrap_or(-1))),
        "UInt8" => Values::Whole(bytes.iter().map(|&b| i32::from(b)).collect()),
        other => return Err(format!("numbers of type {other} are not known")),
    };
    Ok(Column { name, components, values })
}

fn numbers<const N: usize, T>(bytes: &[u8], of: impl Fn([u8; N]) -> T) -> Vec<T> {
    bytes.as_chunks::<N>().0.iter().map(|chunk| of(*chunk)).collect()
}

/// An array: the number of blocks, their size, the size of the last if it is smaller, their compressed sizes, the blocks.
fn decompressed(data: &[u8]) -> Option<Vec<u8>> {
    let number = |at: usize| {
        let at = at.checked_mul(8)?;
        usize::try_from(u64::from_le_bytes(data.get(at..at.checked_add(8)?)?.try_into().ok()?)).ok()
    };
    let blocks = number(0)?;
    let mut start = blocks.checked_add(3)?.checked_mul(8).filter(|&start| start <= data.len())?;
    let mut out = Vec::new();
    for block in 0..blocks {
        let end = start.checked_add(number(3 + block)?)?;
        let left = MOST - out.len() as u64;
        ZlibDecoder::new(data.get(start..end)?).take(left).read_to_end(&mut out).ok()?;
        start = end;
    }
    Some(out)
}

/// Adds the points and cells of a piece to those of others.
fn add(whole: &mut Dataset, piece: Dataset) -> std::result::Result<(), String> {
    let first = whole.points.len() as u32;
    whole.points.extend(piece.points);
    whole.point_ids.extend(piece.point_ids);
    whole.cells.ids.extend(piece.cells.ids);
    whole.cells.properties.extend(piece.cells.properties);
    whole.cells.shapes.extend(piece.cells.shapes);
    whole.cells.points.extend(piece.cells.points.iter().map(|point| point + first));
    for (columns, more) in [(&mut whole.point_data, piece.point_data), (&mut whole.cell_data, piece.cell_data)] {
        if columns.len() != more.len() {
            return Err("its pieces hold different arrays".to_owned());
        }
        for (column, more) in columns.iter_mut().zip(more) {
            match (&mut column.values, more.values) {
                (Values::Real(all), Values::Real(own)) if column.name == more.name => all.extend(own),
                (Values::Whole(all), Values::Whole(own)) if column.name == more.name => all.extend(own),
                _ => return Err("its pieces hold different arrays".to_owned()),
            }
        }
    }
    Ok(())
}

fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    let (_, rest) = tag.split_once(&format!("{name}=\""))?;
    rest.split_once('"').map(|(value, _)| value)
}

fn unescape(text: &str) -> String {
    text.replace("&quot;", "\"").replace("&lt;", "<").replace("&amp;", "&")
}

fn unreadable(path: &Path, fact: &str) -> Error {
    let problem = Diagnostic::error("unreadable-file", format!("it cannot be read: {fact}")).at(Place::file(path));
    problem.remedy("name a .vtu, .pvtu or .pvd file of vtu_output_process, a report, or a folder of them").into()
}
