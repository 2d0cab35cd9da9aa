//! Results of some steps as one file: HDF5 finds in it the data that were written step by step.

use std::path::{Path, PathBuf};

use hdf5_pure::File;
use zelus_core::geometry::Shape;
use zelus_core::io::results::{Column, Dataset, write_piece};
use zelus_meshes::{RESULTS, write_vtkhdf, write_xdmf};

/// A square of two triangles and a quadrilateral beside it, with a number at points and a vector at cells.
fn picture(value: f64, moved: f64) -> Dataset {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0 + moved, 1.0]];
    let mut out = Dataset { points: points.map(|[x, y]| [x, y, 0.0]).to_vec(), ..Dataset::default() };
    out.cells.push(1, 0, Shape::Tri3, [0, 1, 2]);
    out.cells.push(2, 0, Shape::Tri3, [0, 2, 3]);
    out.cells.push(3, 0, Shape::Quad4, [1, 4, 5, 2]);
    out.point_data.push(Column::real("HEIGHT", 1, (0..6).map(|at| value + f64::from(at)).collect()));
    out.cell_data.push(Column::real("STRESS", 6, (0..18).map(f64::from).collect()));
    out.cell_data.push(Column::real("FORCE", 3, (0..9).map(|at| value * f64::from(at)).collect()));
    out
}

/// Writes three steps: the mesh of the third is another, and the first does not know the height.
fn write_series(folder: &Path) -> PathBuf {
    let mut steps = [picture(10.0, 0.0), picture(20.0, 0.0), picture(30.0, 0.5)];
    steps[0].point_data.clear();
    let mut series = String::from("<VTKFile type=\"Collection\"><Collection>\n");
    for (at, step) in steps.iter().enumerate() {
        write_piece(&folder.join(format!("step_{at}.vtu")), step).unwrap();
        series += &format!("<DataSet timestep=\"{}\" part=\"0\" file=\"step_{at}.vtu\"/>\n", 0.5 * at as f64);
    }
    let path = folder.join("all.pvd");
    std::fs::write(&path, series + "</Collection></VTKFile>\n").unwrap();
    path
}

#[test]
fn all_steps_stand_in_one_file() {
    let scratch = tempfile::tempdir().unwrap();
    let path = |name: &str| scratch.path().join(name);
    let series = write_series(scratch.path());
    assert_eq!(write_vtkhdf(&series, &path("all.vtkhdf")).unwrap(), 3);

    let file = File::open(path("all.vtkhdf")).unwrap();
    let real = |name: &str| file.dataset(&format!("VTKHDF/{name}")).unwrap().read_f64().unwrap();
    let whole = |name: &str| file.dataset(&format!("VTKHDF/{name}")).unwrap().read::<i64>().unwrap();
    assert_eq!(real("Steps/Values"), [0.0, 0.5, 1.0]);
    assert_eq!(whole("NumberOfPoints"), [6, 6]);
    assert_eq!(whole("NumberOfCells"), [3, 3]);
    assert_eq!(whole("Offsets"), [0, 3, 6, 10, 0, 3, 6, 10]);
    assert_eq!(whole("Connectivity")[..10], [0, 1, 2, 0, 2, 3, 1, 4, 5, 2]);
    assert_eq!(whole("Types"), [5, 5, 9, 5, 5, 9]);
    for (name, wanted) in [
        ("PartOffsets", [0, 0, 1]),
        ("PointOffsets", [0, 0, 6]),
        ("CellOffsets", [0, 0, 3]),
        ("ConnectivityIdOffsets", [0, 0, 10]),
    ] {
        assert_eq!(whole(&format!("Steps/{name}")), wanted, "{name}");
    }
    assert_eq!(whole("Steps/PointDataOffsets/HEIGHT"), [0, 6, 12]);
    assert_eq!(whole("Steps/CellDataOffsets/FORCE"), [0, 3, 6]);
    let heights = real("PointData/HEIGHT");
    assert!(heights[..6].iter().all(|height| height.is_nan()), "{heights:?}");
    assert_eq!(heights[6..12], [20.0, 21.0, 22.0, 23.0, 24.0, 25.0]);
    assert_eq!(real("CellData/FORCE")[18..], (0..9).map(|at| 30.0 * f64::from(at)).collect::<Vec<_>>());
    assert_eq!(file.dataset("VTKHDF/CellData/FORCE").unwrap().shape().unwrap(), [9, 3]);
}

/// Each item of numbers that the text names is in the file beside it, with as many numbers.
#[test]
fn a_text_names_the_numbers_of_all_steps() {
    let scratch = tempfile::tempdir().unwrap();
    let to = scratch.path().join("all.xdmf");
    assert_eq!(write_xdmf(&write_series(scratch.path()), &to).unwrap(), 3);
    let file = File::open(scratch.path().join("all.h5")).unwrap();
    let text = std::fs::read_to_string(&to).unwrap();
    let mut named = Vec::new();
    for item in text.split("<DataItem ").skip(1) {
        let (head, rest) = item.split_once('>').unwrap();
        let (_, place) = rest.split_once("</DataItem>").unwrap().0.split_once("all.h5:/").unwrap();
        let dimensions = head.split_once("Dimensions=\"").unwrap().1.split_once('"').unwrap().0;
        let shape = file.dataset(place).unwrap().shape().unwrap();
        assert_eq!(dimensions, shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "), "{place}");
        named.push(place.to_owned());
    }
    let mesh = |at: usize| ["cells", "points"].map(|what| format!("mesh_{at}/{what}"));
    let force = |at: usize| format!("step_{at}_cell/FORCE");
    let stress = |at: usize| format!("step_{at}_cell/STRESS");
    let height = |at: usize| format!("step_{at}_node/HEIGHT");
    let [[cells, points], [other_cells, other_points]] = [mesh(0), mesh(2)];
    let steps = [
        vec![cells.clone(), points.clone(), stress(0), force(0)],
        vec![cells.clone(), points, height(1), stress(1), force(1)],
        vec![other_cells, other_points, height(2), stress(2), force(2)],
    ];
    assert_eq!(named, steps.concat());
    assert_eq!(file.dataset(&stress(0)).unwrap().shape().unwrap(), [3, 1, 6]);
    for time in ["0.0", "0.5", "1.0"] {
        assert!(text.contains(&format!("<Time Value=\"{time}\"/>")), "{text}");
    }
    assert_eq!(file.dataset(&cells).unwrap().read::<i64>().unwrap(), [4, 0, 1, 2, 4, 0, 2, 3, 5, 1, 4, 5, 2]);
    assert_eq!(file.dataset(&height(2)).unwrap().read_f64().unwrap(), [30.0, 31.0, 32.0, 33.0, 34.0, 35.0]);
    assert_eq!(file.dataset("mesh_2/points").unwrap().read_f64().unwrap()[15..], [2.5, 1.0, 0.0]);
}

#[test]
fn what_is_no_series_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let from = scratch.path().join("all.pvd");
    for text in ["", "<DataSet timestep=\"0\" file=\"gone.vtu\"/>", "<DataSet file=\"gone.vtu\"/>"] {
        std::fs::write(&from, text).unwrap();
        for (ending, write) in RESULTS {
            let to = from.with_extension(ending);
            assert!(write(&from, &to).is_err(), "{text:?}");
            assert!(!to.exists() && !to.with_extension("h5").exists());
        }
    }
}
