use std::io::Read;
use std::path::Path;

use super::number::scientific;
use super::*;
use crate::communication::Ranks;
use crate::geometry::Shape;

fn data() -> Dataset {
    let mut cells = Cells::default();
    cells.push(7, 1, Shape::Tri3, [0, 1, 2]);
    cells.push(9, 2, Shape::Quad4, [0, 1, 3, 2]);
    Dataset {
        point_ids: vec![2, 3, 5, 8],
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.25]],
        cells,
        point_data: vec![
            Column::real("DISPLACEMENT", 3, (0..12).map(|i| f64::from(i) / 3.0).collect()),
            Column::real("PRESSURE", 1, vec![0.1, -1.0, 1e-300, 1e10]),
            Column::ids("KRATOS_NODE_ID", &[2, 3, 5, 8]),
        ],
        cell_data: vec![Column::real("STRESS", 4, vec![1.0; 8]), Column::ids("PROPERTIES_ID", &[1, 2])],
    }
}

#[test]
fn numbers_have_the_exponents_of_c() {
    let said = |value: f64| {
        let mut out = Vec::new();
        scientific(&mut out, value, 3).unwrap();
        String::from_utf8(out).unwrap()
    };
    let wanted = ["0.000e+00", "-1.500e+00", "1.000e-07", "1.235e+100", "nan"];
    assert_eq!([0.0, -1.5, 1e-7, 1.2346e100, f64::NAN].map(said), wanted);
}

#[test]
fn legacy_text_has_the_layout_of_kratos() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtk");
    let mut data = data();
    data.point_data.remove(0);
    data.cell_data.remove(0);
    write_vtk(&Ranks::default(), &path, &data, VtkFormat::Ascii { precision: 7 }).unwrap();
    let wanted = "# vtk DataFile Version 4.0\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n\
        0.0000000e+00 0.0000000e+00 0.0000000e+00 \n1.0000000e+00 0.0000000e+00 0.0000000e+00 \n\
        0.0000000e+00 1.0000000e+00 0.0000000e+00 \n1.0000000e+00 1.0000000e+00 2.5000000e-01 \n\
        \nCELLS 2 9\n3 0 1 2\n4 0 1 3 2\n\nCELL_TYPES 2\n5\n9\nPOINT_DATA 4\nFIELD FieldData 2\n\
        PRESSURE 1 4  float\n1.0000000e-01\n-1.0000000e+00\n0.0000000e+00\n1.0000000e+10\n\
        KRATOS_NODE_ID 1 4  int\n2\n3\n5\n8\nCELL_DATA 2\nFIELD FieldData 1\nPROPERTIES_ID 1 2  int\n1\n2\n";
    assert_eq!(std::fs::read_to_string(&path).unwrap(), wanted);
}

#[test]
fn legacy_binary_has_the_bytes_of_kratos() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtk");
    write_vtk(&Ranks::default(), &path, &data(), VtkFormat::Binary).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let head = b"# vtk DataFile Version 4.0\nvtk output\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n";
    assert!(bytes.starts_with(head));
    let after = &bytes[head.len() + 4 * 12..];
    assert!(after.starts_with(b"\nCELLS 2 9\n\0\0\0\x03\0\0\0\0\0\0\0\x01\0\0\0\x02\0\0\0\x04"));
    assert_eq!(bytes[head.len() + 12..head.len() + 16], 1.0_f32.to_be_bytes());
    let find = |what: &[u8]| bytes.windows(what.len()).position(|w| w == what).unwrap() + what.len();
    assert!(bytes[find(b"CELL_TYPES 2\n")..].starts_with(b"\0\0\0\x05\0\0\0\x09POINT_DATA 4\nFIELD FieldData 3\n"));
    assert!(bytes[find(b"PRESSURE 1 4  float\n")..].starts_with(&0.1_f32.to_be_bytes()));
    assert!(bytes.ends_with(b"PROPERTIES_ID 1 2  int\n\0\0\0\x01\0\0\0\x02"));
}

/// One array of a VTU file with raw appended data, by VTK's rules: a header of block sizes, then zlib blocks.
struct Array {
    components: usize,
    kind: String,
    bytes: Vec<u8>,
}

impl Array {
    fn reals(&self) -> Vec<f64> {
        assert_eq!(self.kind, "Float64");
        self.bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    }

    fn wholes(&self) -> Vec<i64> {
        assert_eq!(self.kind, "Int64");
        self.bytes.chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap())).collect()
    }
}

/// The array called `name`. Appended data are not XML: they are found by their length, whatever bytes they hold.
fn read_array(path: &Path, name: &str) -> Array {
    const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
    let file = std::fs::read(path).unwrap();
    let begin = file.windows(MARK.len()).position(|w| w == MARK).unwrap() + MARK.len();
    let head = std::str::from_utf8(&file[..begin]).unwrap();
    assert!(head.contains("compressor=\"vtkZLibDataCompressor\"") && head.contains("header_type=\"UInt64\""), "{head}");
    assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
    let tag = head.lines().find(|line| line.contains(&format!("Name=\"{name}\""))).unwrap();
    let attribute = |key: &str| {
        let at = tag.find(&format!("{key}=\"")).unwrap() + key.len() + 2;
        tag[at..].split('"').next().unwrap().to_owned()
    };
    let data = &file[begin + attribute("offset").parse::<usize>().unwrap()..];
    let number = |at: usize| u64::from_le_bytes(data[8 * at..8 * at + 8].try_into().unwrap()) as usize;
    let (blocks, size, last) = (number(0), number(1), number(2));
    let mut at = 8 * (3 + blocks);
    let mut bytes = Vec::new();
    for block in 0..blocks {
        let packed = &data[at..at + number(3 + block)];
        let before = bytes.len();
        flate2::read::ZlibDecoder::new(packed).read_to_end(&mut bytes).unwrap();
        let whole = if block + 1 == blocks && last > 0 { last } else { size };
        assert_eq!(bytes.len() - before, whole, "block {block} of {name}");
        at += packed.len();
    }
    Array { components: attribute("NumberOfComponents").parse().unwrap(), kind: attribute("type"), bytes }
}

#[test]
fn vtu_reads_back_in_double_precision() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    write_vtu(&Ranks::default(), &path, &data()).unwrap();
    let array = |name| read_array(&path, name);
    assert_eq!(array("Points").reals(), data().points.concat());
    assert_eq!((array("connectivity").wholes(), array("offsets").wholes()), (vec![0, 1, 2, 0, 1, 3, 2], vec![3, 7]));
    assert_eq!(array("types").bytes, [5, 9]);
    let Values::Real(wanted) = &data().point_data[0].values else { panic!() };
    assert_eq!((&array("DISPLACEMENT").reals(), array("DISPLACEMENT").components), (wanted, 3));
    assert_eq!((array("STRESS").reals(), array("STRESS").components), (vec![1.0; 8], 4));
    assert_eq!(
        (array("PROPERTIES_ID").kind.as_str(), &array("PROPERTIES_ID").bytes[..4]),
        ("Int32", &[1, 0, 0, 0][..])
    );

    let file = |time: f64, file: &str| PvdFile { time, part: 0, name: String::new(), file: file.into() };
    write_pvd(&Ranks::default(), &folder.path().join("a.pvd"), &[file(0.1, "a_1.vtu"), file(0.2, "a_2.vtu")]).unwrap();
    let pvd = std::fs::read_to_string(folder.path().join("a.pvd")).unwrap();
    assert!(pvd.contains("<DataSet timestep=\"0.2\" part=\"0\" file=\"a_2.vtu\"/>"));
}

/// Compressed noise holds every byte, also those that mean something in XML, and several blocks.
#[test]
fn vtu_reads_back_whatever_bytes_its_blocks_hold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    let mut state = 1_u64;
    let noise: Vec<f64> = std::iter::repeat_with(|| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64
    })
    .take(30_000)
    .collect();
    let mut data = data();
    data.points = noise.chunks(3).map(|x| [x[0], x[1], x[2]]).collect();
    data.point_data = vec![Column::real("NOISE", 3, noise.clone())];
    write_vtu(&Ranks::default(), &path, &data).unwrap();
    let file = std::fs::read(&path).unwrap();
    assert!(file.windows(2).filter(|w| w[0] == b'<' && !w[1].is_ascii()).count() > 100, "the noise holds no marks");
    for name in ["NOISE", "Points"] {
        assert_eq!(read_array(&path, name).reals(), noise);
    }
    assert_eq!(read_array(&path, "offsets").wholes(), [3, 7]);
}

#[test]
fn gid_files_name_meshes_results_and_points() {
    let data = data();
    let mut mesh = Vec::new();
    write_gid_mesh(&mut mesh, &data, GidKind::Element, true).unwrap();
    let mesh = String::from_utf8(mesh).unwrap();
    let wanted =
        "MESH \"Kratos_Triangle3_elements\" dimension 3 ElemType Triangle Nnode 3\nCoordinates\n2 0.0 0.0 0.0\n";
    assert!(mesh.starts_with(wanted), "{mesh}");
    assert!(mesh.contains("End Coordinates\nElements\n9 2 3 8 5 2\nEnd Elements\n"), "{mesh}");
    let gauss = GaussResult {
        name: "VON_MISES_STRESS".into(),
        shape: Shape::Tri3,
        points: vec![[0.25, 0.5, 0.0]],
        components: 1,
        cells: vec![7],
        values: vec![3.5],
    };
    let mut out = Vec::new();
    write_gid_results_head(&mut out, &[gauss.clone(), gauss.clone()]).unwrap();
    write_gid_step(&mut out, 0.5, &data.point_ids, &data.point_data[1..2], &[gauss]).unwrap();
    let wanted = "GiD Post Results File 1.0\nGaussPoints \"triangle3_1gp_element\" ElemType Triangle\n\
        Number Of Gauss Points: 1\nNatural Coordinates: Given\n0.25 0.5\nEnd GaussPoints\n\
        Result \"PRESSURE\" \"Kratos\" 0.5 Scalar OnNodes\nValues\n2 0.1\n3 -1.0\n5 1e-300\n8 10000000000.0\nEnd Values\n\
        Result \"VON_MISES_STRESS\" \"Kratos\" 0.5 Scalar OnGaussPoints \"triangle3_1gp_element\"\nValues\n7 3.5\nEnd Values\n";
    assert_eq!(String::from_utf8(out).unwrap(), wanted);
}

#[test]
fn what_was_written_is_read_and_what_is_damaged_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    let mut data = data();
    for shape in Shape::ALL {
        let points = (0..shape.nodes() as u32).map(|at| at % 4);
        data.cells.push(11, 0, shape, points);
    }
    data.cells.properties.fill(0);
    data.cells.ids = (0..data.cells.len()).map(|at| at + 3).collect();
    data.cell_data = vec![Column::ids("KRATOS_ELEMENT_ID", &data.cells.ids)];
    write_vtu(&Ranks::default(), &path, &data).unwrap();
    assert_eq!(read_vtu(&path).unwrap(), data);
    let bytes = std::fs::read(&path).unwrap();
    for cut in (0..bytes.len()).step_by(7) {
        let _ = vtu_of(&bytes[..cut]);
        let mut damaged = bytes.clone();
        damaged[cut] = damaged[cut].wrapping_add(1 + (cut % 250) as u8);
        let _ = vtu_of(&damaged);
    }
    assert!(vtu_of(&bytes[..bytes.len() / 2]).is_err());
    let file = |part: usize, name: &str, file: &str| PvdFile { time: 0.5, part, name: name.into(), file: file.into() };
    let files = [file(0, "", "a.vtu"), file(1, "floor & wall", "a.interface_0.vtu")];
    write_pvd(&Ranks::default(), &folder.path().join("a.pvd"), &files).unwrap();
    let text = std::fs::read_to_string(folder.path().join("a.pvd")).unwrap();
    assert!(text.contains("part=\"1\" name=\"floor &amp; wall\" file=\"a.interface_0.vtu\""), "{text}");
    assert_eq!(read_pvd(&folder.path().join("a.pvd")).unwrap(), [(0.5, path)]);
}
