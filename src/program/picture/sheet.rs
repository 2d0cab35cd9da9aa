//! The sheet of a picture: model, enlarged part, legend and axes, each in its place.

use super::camera::Camera;
use super::canvas::Canvas;
use super::drawing::{self, GROUND, INK, Limits};
use super::image::Image;
use super::legend::{self, Legend, number};
use super::model::Model;
use super::options::PictureOptions;
use super::pose::{Pose, Vertex};
use super::text::Writer;

/// A step that is drawn.
pub(super) struct Drawn {
    pub step: usize,
    pub time: Option<f64>,
    pub pose: Pose,
}

/// All values that are seen, with their vertices.
fn seen<'p>(pose: &'p Pose, used: &'p [u32]) -> impl Iterator<Item = &'p Vertex> {
    let whole = used.iter().map(|&at| &pose.vertices[at as usize]).filter(|own| own.height <= 0.0);
    whole.chain(pose.section.iter().flatten()).filter(|own| own.value.is_finite())
}

/// The range of what is seen; without its peak, where that would hide the rest.
pub(super) fn usual_limits(pose: &Pose, used: &[u32]) -> Limits {
    let mut all: Vec<f64> = seen(pose, used).map(|own| own.value).collect();
    all.sort_unstable_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (all.first(), all.last()) else { return [0.0, 0.0] };
    let others: Vec<f64> = all.into_iter().filter(|&own| own != 0.0).collect();
    let most = others.get(99 * others.len().saturating_sub(1) / 100).copied().unwrap_or(high);
    if most > low && most < 0.5 * high { [low, most] } else { [low, high] }
}

/// Places of all parts of a picture.
pub(super) struct Sheet {
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
    pub fn new(options: &PictureOptions, drawn: &[Drawn], used: &[u32], camera: &mut Camera) -> Self {
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

    /// The picture of a step.
    pub fn image(
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
