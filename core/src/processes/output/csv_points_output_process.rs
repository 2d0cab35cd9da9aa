//! The histories of quantities at the points of a table, a text file of columns each.

use super::points::{REQUIRED, points_output};
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::parameters::Defaults;
use crate::processes::target::read_text;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let key = "csv_file_path";
    let settings = request.settings_with(|defaults: Defaults| defaults.require(&REQUIRED).require(&[key]))?;
    let path = request.folder.join(settings.get_str(key)?);
    let text = read_text(&settings, key, &path)?;
    let mut rows = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let names: Vec<&str> = rows.next().map(|(_, line)| line.split(',').map(str::trim).collect()).unwrap_or_default();
    let columns = ["x", "y", "z"].map(|axis| names.iter().position(|name| *name == axis));
    let [Some(x), Some(y), Some(z)] = columns else {
        let fact = format!("the first line of {} does not name the columns x, y and z", path.display());
        return Err(Diagnostic::error("wrong-table", fact)
            .at(settings.key_place(key))
            .remedy("begin it with x,y,z")
            .into());
    };
    let mut points = Vec::new();
    for (at, row) in rows {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        let number = |column: usize| cells.get(column).and_then(|cell| cell.parse::<f64>().ok());
        let [Some(x), Some(y), Some(z)] = [x, y, z].map(number) else {
            let place = Place::at(&path, at as u32 + 1, 1);
            return Err(Diagnostic::error("bad-number", "a point is not three numbers").at(place).into());
        };
        points.push([x, y, z]);
    }
    points_output(request, &settings, key, &points, true)
}

register! { ProcessEntry "csv_points_output_process",
    aliases: &["CsvPointsOutputProcess", "CSVPointsOutputProcess"],
    about: "writes the histories of quantities at the points of a table, a file each, a line a step",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/csv_points_output_process.json")),
    build: build,
}
