//! `zelus report --picture`: the deformed model as a PNG file.

mod camera;
mod canvas;
mod drawing;
mod field;
mod image;
mod legend;
mod model;
mod options;
mod png_file;
mod pose;
mod section;
mod sheet;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::results::Dataset;
use zelus_core::{Error, Result};

use self::camera::Camera;
use self::field::Field;
use self::image::Image;
use self::legend::{Legend, number};
use self::model::Model;
use self::options::{Steps, wrong};
use self::pose::{Plane, Pose};
use self::sheet::{Drawn, Sheet, usual_limits};
use self::text::Writer;
use super::deformation::{automatic, displacements};
use super::report::check_output;
use super::results::{Series, find};
use super::say::say;
use super::stress_columns::with_invariants;

pub(super) use self::options::PictureOptions;

/// Directions towards the eye where none is given: of models in space, and of those that are turned about their axis.
const OBLIQUE: [f64; 3] = [-0.5, -1.0, 0.55];
const OF_REVOLUTION: [f64; 3] = [1.0, 0.7, 1.0];
/// Writes a picture of a run.
///
/// # Errors
/// Options that cannot be understood, a run without results, a field or step that it does not have, a file that cannot be written.
pub(super) fn write(file: &Path, report: &Path, run: &Value, options: &PictureOptions) -> Result<()> {
    options.check(file)?;
    check_output("the picture", file, &[report], png_file::MARK)?;
    let all = find(report)?;
    let mut shown: Vec<(&String, &Series, Dataset)> = Vec::new();
    for (name, series) in &all {
        let Some(first) = series.first() else { continue };
        let first = first.read()?;
        if first.cells.shapes.iter().any(|shape| shape.cell().dim >= 2) {
            shown.push((name, series, first));
        }
    }
    let Some((name, series, first)) = shown.first() else {
        let problem = Diagnostic::error("no-results", "the run has no picture of a mesh").at(Place::file(report));
        return Err(problem.remedy("add a vtu_output_process with empty lists to the deck").into());
    };
    let images = images(series, first, run, report, options)?;
    png_file::write(file, &images)?;
    let others = if shown.len() > 1 { format!(", of {name}") } else { String::new() };
    let count = if images.len() > 1 { format!(" with {} steps", images.len()) } else { String::new() };
    say(&format!("picture: {}{count}{others}", file.display()));
    Ok(())
}

/// Names of the bodies of the report by their least node.
fn names(run: &Value) -> BTreeMap<usize, String> {
    let bodies = run["bodies"].as_array().into_iter().flatten();
    bodies.filter_map(|own| Some((own["node"].as_u64()? as usize, own["name"].as_str()?.to_owned()))).collect()
}

fn images(
    series: &Series,
    first: &Dataset,
    run: &Value,
    report: &Path,
    options: &PictureOptions,
) -> Result<Vec<Image>> {
    let last = series.len() - 1;
    let steps = match options.steps()? {
        Steps::Last => vec![last],
        Steps::All => (0..=last).collect(),
        Steps::One(step) if step <= last => vec![step],
        Steps::One(step) => {
            return Err(wrong(
                format!("--step {step}: the run has written the steps 0 to {last}"),
                "name one of them, or all",
            ));
        }
    };
    let ending = series[last].read()?;
    let field = Field::of(options.field.as_deref(), &with_invariants(&ending), report)?;
    let model = whole_model(first, run, options)?;
    let used = model.used();
    let initial = |vertex: u32| model.moved(vertex as usize, first.points[model.vertices[vertex as usize].0 as usize]);
    let sizes: [[f64; 2]; 3] = std::array::from_fn(|c| {
        let of = |[low, high]: [f64; 2], at: &u32| [low.min(initial(*at)[c]), high.max(initial(*at)[c])];
        used.iter().fold([f64::INFINITY, f64::NEG_INFINITY], of)
    });
    let extent = sizes.iter().map(|[low, high]| (high - low).powi(2)).sum::<f64>().sqrt();
    let is_flat = sizes[2][1] - sizes[2][0] < 1e-9 * extent;
    let towards = match options.view()? {
        Some(given) => given,
        None if options.revolve.is_some() => OF_REVOLUTION,
        None if is_flat => [0.0, 0.0, 1.0],
        None => OBLIQUE,
    };
    let mut camera = Camera::new(towards, if is_flat || options.revolve.is_some() { 1 } else { 2 });
    let plane = match options.cut()? {
        Some(_) if !model.is_solid => {
            return Err(wrong("--cut: the model is in the plane and has no inside", "leave the option out"));
        }
        Some(cut) => {
            let [low, high] = sizes[cut.axis];
            let at = cut.place.unwrap_or((low + high) / 2.0);
            if !(at > low && at < high) {
                let remedy = format!("the model reaches from {} to {}", number(low), number(high));
                return Err(wrong(format!("--cut at {}: it leaves all or nothing", number(at)), remedy));
            }
            let faces_eye = camera.towards()[cut.axis] >= 0.0;
            let sign = if faces_eye != cut.is_negative { 1.0 } else { -1.0 };
            Some(Plane { normal: std::array::from_fn(|c| if c == cut.axis { sign } else { 0.0 }), at: sign * at })
        }
        None => None,
    };
    let ways = |data: &Dataset| displacements(data, first);
    let largest = ways(&ending).iter().map(|way| way.iter().map(|x| x * x).sum::<f64>().sqrt()).fold(0.0, f64::max);
    let factor = options.factor.unwrap_or_else(|| automatic(largest, extent));
    let mut drawn = Vec::with_capacity(steps.len());
    for step in steps {
        let data = series[step].read()?;
        if data.points.len() != first.points.len() {
            return Err(Error::System(format!("step {step} has another mesh than step 0, and is not drawn")));
        }
        let pose = Pose::new(&model, &first.points, &ways(&data), factor, &field.values(&data), plane);
        drawn.push(Drawn { step, time: series[step].time, pose });
    }
    let limits = match options.range()? {
        Some(limits) => limits,
        None => drawn
            .iter()
            .map(|own| usual_limits(&own.pose, &used))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], own| [low.min(own[0]), high.max(own[1])]),
    };
    let sheet = Sheet::new(options, &drawn, &used, &mut camera);
    let writer = Writer::new()?;
    let kept = |own: &Drawn| {
        let title = field.title(options.unit.as_deref());
        sheet.image(
            &model,
            own,
            &used,
            &camera,
            &writer,
            Legend {
                title,
                limits,
                exceeds: [false; 2],
                lines: vec![
                    match factor {
                        1.0 => "true deformation".to_owned(),
                        0.0 => "undeformed".to_owned(),
                        _ => format!("deformation × {}", number(factor)),
                    },
                    own.time.map_or_else(
                        || format!("step {} of {last}", own.step),
                        |time| format!("time {}", number(time)),
                    ),
                ],
            },
        )
    };
    Ok(drawn.iter().map(kept).collect())
}

/// The bodies that are shown, whole.
fn whole_model(first: &Dataset, run: &Value, options: &PictureOptions) -> Result<Model> {
    let names = names(run);
    let name_of = |node: usize, at: usize| names.get(&node).cloned().unwrap_or_else(|| format!("body {}", at + 1));
    let all = Model::new(first, &|_, _| true);
    let known: Vec<String> = all.names.values().enumerate().map(|(at, &node)| name_of(node, at)).collect();
    if let Some(missing) = options.hide.iter().find(|name| !known.contains(name)) {
        return Err(wrong(format!("--hide {missing}: there is no such body"), format!("bodies: {}", known.join(", "))));
    }
    let mut model = match options.hide.is_empty() {
        true => all,
        false => Model::new(first, &|node, at| !options.hide.contains(&name_of(node, at))),
    };
    if model.patches.is_empty() {
        return Err(wrong("--hide: no body is left", "hide fewer bodies"));
    }
    for mirror in options.mirrors()? {
        model.mirror(mirror.axis, mirror.place.unwrap_or(0.0), &first.points);
    }
    if let Some(degrees) = options.revolve {
        if model.is_solid {
            return Err(wrong("--revolve: the model is in space", "leave the option out"));
        }
        model.revolve(degrees, &first.points);
    }
    Ok(model)
}
