//! The tags of a file, and where its arrays are.

/// A tag with the text behind it up to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tag<'a> {
    head: &'a str,
    /// Text up to the next tag.
    pub text: &'a str,
}

impl<'a> Tag<'a> {
    /// The value of an attribute.
    pub(super) fn get(&self, name: &str) -> Option<&'a str> {
        let mut rest = self.head;
        while let Some(at) = rest.find(name) {
            let is_whole = rest[..at].ends_with(|c: char| c.is_whitespace());
            rest = &rest[at + name.len()..];
            let Some(value) = rest.trim_start().strip_prefix('=').filter(|_| is_whole) else { continue };
            let value = value.trim_start();
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            return value[1..].split_once(quote).map(|(value, _)| value);
        }
        None
    }
}

/// The arrays of a piece by the entities that they belong to.
#[derive(Debug, Default)]
pub(super) struct Piece<'a> {
    pub points: Vec<Tag<'a>>,
    pub cells: Vec<Tag<'a>>,
    pub point_data: Vec<Tag<'a>>,
    pub cell_data: Vec<Tag<'a>>,
}

/// A file: how its arrays are written, and its pieces.
#[derive(Debug)]
pub(super) struct File<'a> {
    /// Bytes of a number in the head of an array: 4 or 8.
    pub header: usize,
    pub is_compressed: bool,
    /// Appended bytes behind the underscore, and whether they are text in base 64.
    pub appended: (&'a [u8], bool),
    pub pieces: Vec<Piece<'a>>,
}

impl<'a> File<'a> {
    /// Finds the tags.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, String> {
        let mark = b"<AppendedData";
        let end = bytes.windows(mark.len()).position(|window| window == mark).unwrap_or(bytes.len());
        let text = std::str::from_utf8(&bytes[..end]).map_err(|_| "it is no text".to_owned())?;
        let mut out = Self { header: 4, is_compressed: false, appended: (&[], false), pieces: Vec::new() };
        if let Some(start) = bytes[end..].iter().position(|&byte| byte == b'_') {
            let head = String::from_utf8_lossy(&bytes[end..end + start]);
            out.appended = (&bytes[end + start + 1..], head.contains("base64"));
        }
        let mut within = "";
        let mut is_grid = false;
        for piece in text.split('<').skip(1) {
            let (head, rest) = piece.split_once('>').unwrap_or((piece, ""));
            let tag = Tag { head, text: rest };
            match head.split(|c: char| c.is_whitespace() || c == '/').next().unwrap_or_default() {
                "VTKFile" => {
                    is_grid = tag.get("type") == Some("UnstructuredGrid");
                    if tag.get("byte_order") == Some("BigEndian") {
                        return Err("its numbers have the bytes of another kind of machine".to_owned());
                    }
                    out.header = if tag.get("header_type") == Some("UInt64") { 8 } else { 4 };
                    out.is_compressed = match tag.get("compressor") {
                        None | Some("") => false,
                        Some("vtkZLibDataCompressor") => true,
                        Some(other) => return Err(format!("its arrays are compressed by {other}; save it with zlib")),
                    };
                }
                "Piece" => out.pieces.push(Piece::default()),
                name @ ("Points" | "Cells" | "PointData" | "CellData" | "FieldData") => within = name,
                "DataArray" => {
                    let Some(piece) = out.pieces.last_mut() else { continue };
                    match within {
                        "Points" => piece.points.push(tag),
                        "Cells" => piece.cells.push(tag),
                        "PointData" => piece.point_data.push(tag),
                        "CellData" => piece.cell_data.push(tag),
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        if is_grid { Ok(out) } else { Err("it is no unstructured grid of VTK's XML format".to_owned()) }
    }
}

/// Text with its entities replaced.
pub(super) fn unescape(text: &str) -> String {
    text.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}
