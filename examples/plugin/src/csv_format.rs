//! Pictures as tables: one row a node, for programs that read nothing else.

use std::io::Write;

use zelus_core::io::replace_file;
use zelus_core::io::results::Values;
use zelus_core::processes::{OutputFormat, OutputFormatEntry, OutputFrame};
use zelus_core::{Result, register};

struct Csv;

impl OutputFormat for Csv {
    fn write(&mut self, frame: &OutputFrame<'_>) -> Result<()> {
        let data = frame.data.gathered(&frame.part.ranks);
        let path = frame.folder.join(format!("{}_{}.csv", frame.series, frame.label));
        replace_file(&frame.part.ranks, &path, |file| {
            write!(file, "id,x,y,z")?;
            for column in &data.point_data {
                (0..column.components).try_for_each(|c| write!(file, ",{}_{c}", column.name))?;
            }
            for (point, (id, [x, y, z])) in data.point_ids.iter().zip(&data.points).enumerate() {
                write!(file, "\n{id},{x},{y},{z}")?;
                for column in &data.point_data {
                    let own = point * column.components..(point + 1) * column.components;
                    match &column.values {
                        Values::Real(values) => values[own].iter().try_for_each(|value| write!(file, ",{value}"))?,
                        Values::Whole(values) => values[own].iter().try_for_each(|value| write!(file, ",{value}"))?,
                    }
                }
            }
            writeln!(file)
        })
    }

    fn endings(&self) -> &'static [&'static str] {
        &["csv"]
    }
}

register! { OutputFormatEntry "csv",
    about: "a table of nodes a step, with commas between its columns",
    build: |_settings| Ok(Box::new(Csv)),
}
