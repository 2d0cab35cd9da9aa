//! `zelus report --picture`: the deformed model as a PNG file.

mod camera;
mod canvas;
mod drawing;
mod image;
mod legend;
mod model;
mod options;
mod pose;
mod text;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use serde_json::Value;
use zelus_core::diagnostics::{Diagnostic, Place, did_you_mean};
use zelus_core::io::results::{Column, Dataset};
use zelus_core::io::{Mark, replace_own_file};
use zelus_core::{Error, Result};

use self::camera::Camera;
use self::canvas::Canvas;
use self::drawing::{GROUND, INK, Limits};
use self::image::Image;
use self::legend::{Legend, number};
use self::model::Model;
use self::options::{Steps, wrong};
use self::pose::{Plane, Pose, Vertex};
use self::text::Writer;
use super::deformation::{automatic, displacements};
use super::quantities::{FIRST_FIELDS, components, in_words, unit};
use super::report::check_output;
use super::results::{Series, find};
use super::say::say;
use super::stress_columns::with_invariants;

pub(super) use self::options::PictureOptions;

/// Directions towards the eye where none is given: of models in space, and of those that are turned about their axis.
const OBLIQUE: [f64; 3] = [-0.5, -1.0, 0.55];
const OF_REVOLUTION: [f64; 3] = [1.0, 0.7, 1.0];
/// Time of a picture of an animation, as a fraction of a second.
const PAUSE: (u16, u16) = (12, 100);
/// The program that has written a picture, by which one is recognised.
const SOFTWARE: &str = "zelus report";
const MARK: Mark = Mark::Holds(SOFTWARE);

/// A field and one of its components.
struct Field {
    name: String,
    component: String,
    /// Place among the numbers of a point; none for the size of a vector.
    at: Option<usize>,
}

impl Field {
    /// The field that is asked for, or the first of those that are usually shown.
    fn of(asked: Option<&str>, columns: &[Cow<'_, Column>], of: &Path) -> Result<Self> {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        let (name, part) = match asked {
            Some(text) => text.split_once(':').map_or((text, None), |(name, part)| (name, Some(part))),
            None => {
                let usual = FIRST_FIELDS.into_iter().find(|name| names.contains(name));
                (usual.or(names.first().copied()).unwrap_or(""), None)
            }
        };
        let Some(column) = columns.iter().find(|column| column.name == name) else {
            let problem = Diagnostic::error("unknown-field", format!("the run has written no field {name:?} of nodes"));
            let all = || format!("fields: {}", names.join(", "));
            return Err(problem
                .at(Place::file(of))
                .remedy(did_you_mean(name, names.iter().copied()).unwrap_or_else(all))
                .into());
        };
        let parts = components(name, column.components);
        let component = part.unwrap_or(&parts[0]).to_owned();
        if !parts.contains(&component) {
            return Err(wrong(
                format!("{name} has no component {component:?}"),
                format!("components: {}", parts.join(", ")),
            ));
        }
        let shift = usize::from(parts[0] == "size");
        let at = parts.iter().position(|own| *own == component).and_then(|own| own.checked_sub(shift));
        Ok(Self { name: name.to_owned(), component, at })
    }

    /// Its value at each point; not a number where a step has no such field.
    fn values(&self, data: &Dataset) -> Vec<f64> {
        let columns = with_invariants(data);
        let Some(column) = columns.iter().find(|column| column.name == self.name) else {
            return vec![f64::NAN; data.points.len()];
        };
        let of = |point: usize, c: usize| column.values.get(point * column.components + c);
        let value = |point: usize| match self.at {
            Some(at) => of(point, at),
            None => (0..column.components).map(|c| of(point, c).powi(2)).sum::<f64>().sqrt(),
        };
        (0..data.points.len()).map(value).collect()
    }

    fn title(&self, asked: Option<&str>) -> String {
        let unit = asked.map_or_else(|| unit(&self.name), str::to_owned);
        let part = if ["size", "value"].contains(&self.component.as_str()) { "" } else { &self.component };
        let words = [in_words(&self.name), part.to_owned(), if unit.is_empty() { unit } else { format!("({unit})") }];
        words.into_iter().filter(|own| !own.is_empty()).collect::<Vec<_>>().join(" ")
    }
}

/// A step that is drawn.
struct Drawn {
    step: usize,
    time: Option<f64>,
    pose: Pose,
}

/// Writes a picture of a run.
///
/// # Errors
/// Options that cannot be understood, a run without results, a field or step that it does not have, a file that cannot be written.
pub(super) fn write(file: &Path, report: &Path, run: &Value, options: &PictureOptions) -> Result<()> {
    options.check(file)?;
    check_output("the picture", file, &[report], MARK)?;
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
    encode(file, &images)?;
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

/// All values that are seen, with their vertices.
fn seen<'p>(pose: &'p Pose, used: &'p [u32]) -> impl Iterator<Item = &'p Vertex> {
    let whole = used.iter().map(|&at| &pose.vertices[at as usize]).filter(|own| own.height <= 0.0);
    whole.chain(pose.section.iter().flatten()).filter(|own| own.value.is_finite())
}

/// The range of what is seen; without its peak, where that would hide the rest.
fn usual_limits(pose: &Pose, used: &[u32]) -> Limits {
    let mut all: Vec<f64> = seen(pose, used).map(|own| own.value).collect();
    all.sort_unstable_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (all.first(), all.last()) else { return [0.0, 0.0] };
    let others: Vec<f64> = all.into_iter().filter(|&own| own != 0.0).collect();
    let most = others.get(99 * others.len().saturating_sub(1) / 100).copied().unwrap_or(high);
    if most > low && most < 0.5 * high { [low, most] } else { [low, high] }
}

/// Places of all parts of a picture.
struct Sheet {
    size: [usize; 2],
    /// Length that words and lines grow with.
    unit: f64,
    /// The second view: enlargement, place and size.
    inset: Option<(f64, [f64; 2], f64)>,
    /// Least and largest place of the model.
    model: [[f64; 2]; 2],
}

impl Sheet {
    /// The sheet on which the camera shows all steps.
    fn new(options: &PictureOptions, drawn: &[Drawn], used: &[u32], camera: &mut Camera) -> Self {
        let unit = options.width as f64 / 1600.0;
        let mut points = drawn.iter().flat_map(|own| {
            let places = used.iter().map(|&at| &own.pose.vertices[at as usize]).filter(|own| own.height <= 0.0);
            places.chain(own.pose.section.iter().flatten()).map(|own| own.place)
        });
        let [x, y] = camera.box_of(&mut points);
        let (left, margin) = (340.0 * unit, 44.0 * unit);
        let aside = if options.inset.is_some() { 640.0 * unit } else { 0.0 };
        let width = options.width as f64 - left - margin - aside;
        let ratio = (y[1] - y[0]) / (x[1] - x[0]).max(1e-300);
        let height = (ratio * width + 2.0 * margin).clamp(700.0 * unit, 820.0 * unit);
        camera.fit([x, y], [left, margin], [width, height - 2.0 * margin]);
        let side = (aside - 30.0 * unit).min(height - 2.0 * margin);
        let place = [options.width as f64 - margin - side, (height - side) / 2.0];
        let inset = options.inset.map(|times| (times, place, side));
        let size = [options.width, height.round() as usize];
        let half = |own: [f64; 2]| camera.scale * (own[1] - own[0]) / 2.0;
        let middle = [left + width / 2.0, height / 2.0];
        let model = [[middle[0] - half(x), middle[0] + half(x)], [middle[1] - half(y), middle[1] + half(y)]];
        Self { size, unit, inset, model }
    }

    /// The middle of the part that a second view enlarges: a place, so far from the rims that all of the part is of the model.
    fn middle_of_part(&self, place: [f64; 3], half: f64) -> [f64; 2] {
        std::array::from_fn(|c| {
            let [low, high] = self.model[c];
            if high - low > 2.0 * half { place[c].clamp(low + half, high - half) } else { (low + high) / 2.0 }
        })
    }

    fn image(
        &self,
        model: &Model,
        drawn: &Drawn,
        used: &[u32],
        camera: &Camera,
        writer: &Writer,
        mut legend: Legend,
    ) -> Image {
        let Self { size, unit, inset, .. } = *self;
        let pose = &drawn.pose;
        let limits = legend.limits;
        let mut canvas = Canvas::new(size, GROUND);
        drawing::draw(&mut canvas, model, pose, camera, limits, 2.0 * unit);
        let mut image = canvas.image();
        let [low, high] = limits;
        let most = seen(pose, used).max_by(|a, b| a.value.total_cmp(&b.value));
        let least = seen(pose, used).map(|own| own.value).fold(f64::INFINITY, f64::min);
        let most = most.filter(|own| own.value > least);
        let margin = 1e-9 * (high - low);
        legend.exceeds = [least < low - margin, most.is_some_and(|own| own.value > high + margin)];
        if let Some(most) = most {
            let place = camera.place(most.place);
            let is_hidden = canvas.depth([place[0], place[1]]) > place[2] + 0.01 * size[0] as f64;
            let behind = if is_hidden { " (behind)" } else { "" };
            let words = format!("max {}{behind}", number(most.value));
            match inset {
                Some((times, _, side)) => {
                    let middle = self.middle_of_part(place, side / times / 2.0);
                    let near = camera.enlarged(times, middle, side);
                    let mut canvas = Canvas::new([side as usize; 2], GROUND);
                    drawing::draw(&mut canvas, model, pose, &near, limits, 2.0 * unit);
                    let mut part = canvas.image();
                    let [x, y, _] = near.place(most.place);
                    legend::mark(&mut part, writer, [x, y], &words, unit);
                    self.add(&mut image, &part, middle, writer);
                }
                None => legend::mark(&mut image, writer, [place[0], place[1]], &words, unit),
            }
        } else if high <= low {
            legend.lines.insert(0, format!("{} everywhere", number(if least.is_finite() { least } else { 0.0 })));
        }
        let margin = 44.0 * unit;
        legend.write(&mut image, writer, [margin, margin], [280.0 * unit, size[1] as f64 - 2.0 * margin], unit);
        legend::axes(&mut image, writer, camera, [250.0 * unit, size[1] as f64 - 200.0 * unit], unit);
        image
    }

    /// Adds the second view with lines to the part that it enlarges.
    fn add(&self, image: &mut Image, part: &Image, [x, y]: [f64; 2], writer: &Writer) {
        let Some((times, corner, side)) = self.inset else { return };
        let half = side / times / 2.0;
        let pen = 2.5 * self.unit;
        image.frame([x - half, y - half], [2.0 * half; 2], INK, pen);
        for sign in [0.0, 1.0] {
            image.line([x + half, y + (2.0 * sign - 1.0) * half], [corner[0], corner[1] + sign * side], INK, 0.6 * pen);
        }
        image.paste(corner.map(|own| own.round() as usize), part);
        image.frame(corner.map(f64::round), [part.width as f64, part.height as f64], INK, pen);
        let size = 26.0 * self.unit;
        writer.write_on_ground(
            image,
            &format!("× {}", number(times)),
            [corner[0] + 0.5 * size, corner[1] + 1.3 * size],
            size,
            INK,
        );
    }
}

/// Writes one picture, or an animation that repeats, by the filter of rows that makes the smaller file.
fn encode(file: &Path, images: &[Image]) -> Result<()> {
    let failed = |error: png::EncodingError| Error::System(format!("picture: {error}"));
    let all = [png::Filter::NoFilter, png::Filter::Adaptive].map(|filter| encoded(images, filter).map_err(failed));
    let [one, other] = all;
    let (one, other) = (one?, other?);
    let bytes = if one.len() <= other.len() { one } else { other };
    replace_own_file(file, |out| out.write_all(&bytes))
}

fn encoded(images: &[Image], filter: png::Filter) -> std::result::Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let size = images.first().map_or([0; 2], |image| [image.width as u32, image.height as u32]);
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(filter);
    if images.len() > 1 {
        encoder.set_animated(images.len() as u32, 0)?;
        encoder.set_frame_delay(PAUSE.0, PAUSE.1)?;
    }
    let mut writer = encoder.write_header()?;
    for image in images {
        writer.write_image_data(&image.colours)?;
    }
    writer.finish()?;
    Ok(bytes)
}
