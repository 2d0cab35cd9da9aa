//! Results of two steps as one file: what HDF5 finds in it is what was written step by step.

use hdf5_pure::File;
use zelus_core::geometry::Shape;
use zelus_core::io::results::{Column, Dataset, write_piece};
use zelus_meshes::write_vtkhdf;

/// A square of two triangles and a quadrilateral beside it, with a number at points and a vector at cells.
fn picture(value: f64, moved: f64) -> Dataset {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0 + moved, 1.0]];
    let mut out = Dataset { points: points.map(|[x, y]| [x, y, 0.0]).to_vec(), ..Dataset::default() };
    out.cells.push(1, 0, Shape::Tri3, [0, 1, 2]);
    out.cells.push(2, 0, Shape::Tri3, [0, 2, 3]);
    out.cells.push(3, 0, Shape::Quad4, [1, 4, 5, 2]);
    out.point_data.push(Column::real("HEIGHT", 1, (0..6).map(|at| value + f64::from(at)).collect()));
    out.cell_data.push(Column::real("FORCE", 3, (0..9).map(|at| value * f64::from(at)).collect()));
    out
}

#[test]
fn all_steps_stand_in_one_file() {
    let scratch = tempfile::tempdir().unwrap();
    let path = |name: &str| scratch.path().join(name);
    // The mesh of the third step is another; the first does not know the height.
    let mut steps = [picture(10.0, 0.0), picture(20.0, 0.0), picture(30.0, 0.5)];
    steps[0].point_data.clear();
    let mut series = String::from("<VTKFile type=\"Collection\"><Collection>\n");
    for (at, step) in steps.iter().enumerate() {
        write_piece(&path(&format!("step_{at}.vtu")), step).unwrap();
        series += &format!("<DataSet timestep=\"{}\" part=\"0\" file=\"step_{at}.vtu\"/>\n", 0.5 * at as f64);
    }
    std::fs::write(path("all.pvd"), series + "</Collection></VTKFile>\n").unwrap();
    assert_eq!(write_vtkhdf(&path("all.pvd"), &path("all.vtkhdf")).unwrap(), 3);

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

#[test]
fn what_is_no_series_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let (from, to) = (scratch.path().join("all.pvd"), scratch.path().join("all.vtkhdf"));
    for text in ["", "<DataSet timestep=\"0\" file=\"gone.vtu\"/>", "<DataSet file=\"gone.vtu\"/>"] {
        std::fs::write(&from, text).unwrap();
        assert!(write_vtkhdf(&from, &to).is_err(), "{text:?}");
        assert!(!to.exists());
    }
}
