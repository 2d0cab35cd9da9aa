//! Words and numbers of a picture: quantity, unit, colours with ticks, deformation, time, largest value, axes.

use super::camera::Camera;
use super::drawing::{INK, Limits, colour};
use super::image::Image;
use super::text::Writer;

/// Content of the legend.
pub(super) struct Legend {
    /// Quantity and unit.
    pub title: String,
    pub limits: Limits,
    /// Whether values beyond the ends of the range exist.
    pub exceeds: [bool; 2],
    /// Lines below the colours.
    pub lines: Vec<String>,
}

/// A number with at most four digits.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    let power = size.log10().floor() as i32;
    let trimmed = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    let text = if (1e-3..1e6).contains(&size) {
        let unit = 10_f64.powi(power - 3);
        let rounded = if power > 3 { (value / unit).round() * unit } else { value };
        trimmed(format!("{rounded:.*}", (3 - power).max(0) as usize))
    } else {
        let text = format!("{value:.3e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}·10{}", trimmed(digits.to_owned()), exponent.chars().map(raised).collect::<String>())
    };
    text.replace('-', "−")
}

/// An end of a range, round-off beside its size as 0.
fn end(value: f64, [low, high]: Limits) -> String {
    number(if value.abs() < 1e-4 * (high - low) { 0.0 } else { value })
}

fn raised(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        other => other.to_digit(10).and_then(|own| char::from_u32(0x2070 + own)).unwrap_or(other),
    }
}

/// Round numbers between two limits.
fn ticks([low, high]: Limits) -> Vec<f64> {
    let raw = (high - low) / 5.0;
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|own| own * power).into_iter().find(|own| *own >= raw).unwrap_or(raw);
    let (first, last) = ((low / step).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|at| at as f64 * step).collect()
}

impl Legend {
    /// Writes the legend from a place, within a width, to a height; all lengths grow with `unit`.
    pub fn write(&self, image: &mut Image, writer: &Writer, [x, y]: [f64; 2], [width, height]: [f64; 2], unit: f64) {
        let (large, small) = (31.0 * unit, 27.0 * unit);
        let mut at = y + large;
        for line in writer.lines(&self.title, width, large) {
            writer.write(image, &line, [x, at], large, INK);
            at += 1.2 * large;
        }
        let below: Vec<String> = self.lines.iter().flat_map(|line| writer.lines(line, width, small)).collect();
        let reserved = 1.3 * small * below.len() as f64 + 1.2 * small;
        let [low, high] = self.limits;
        if high > low {
            let (top, bar) =
                (at + 0.1 * small, [34.0 * unit, (y + height - reserved - at - 0.2 * small).max(100.0 * unit)]);
            self.bar(image, writer, [x, top], bar, small);
            at = top + bar[1];
        }
        at += 1.7 * small;
        for line in below {
            writer.write(image, &line, [x, at], small, INK);
            at += 1.3 * small;
        }
    }

    fn bar(&self, image: &mut Image, writer: &Writer, [x, y]: [f64; 2], [width, height]: [f64; 2], size: f64) {
        let [low, high] = self.limits;
        let rows = height.round() as usize;
        for row in 0..rows {
            let value = high - (high - low) * (row as f64 + 0.5) / rows as f64;
            image.fill([x as usize, y as usize + row], [width as usize, 1], colour(value, self.limits));
        }
        let ends = [(low, "≤ ", self.exceeds[0]), (high, "≥ ", self.exceeds[1])];
        let mut said: Vec<(f64, String)> = ends
            .map(|(value, mark, exceeds)| {
                (value, format!("{}{}", if exceeds { mark } else { "" }, end(value, self.limits)))
            })
            .to_vec();
        let place = |value: f64| y + height * (high - value) / (high - low);
        let is_clear = |value: &f64| [low, high].iter().all(|end| (place(*value) - place(*end)).abs() > 1.1 * size);
        said.extend(ticks(self.limits).into_iter().filter(is_clear).map(|tick| (tick, number(tick))));
        for (value, text) in said {
            let at = place(value);
            image.line([x + width, at], [x + width + 0.3 * size, at], INK, 0.07 * size);
            writer.write(image, &text, [x + width + 0.5 * size, at + 0.28 * size], size, INK);
        }
    }
}

/// The axes as arrows about a place.
pub(super) fn axes(image: &mut Image, writer: &Writer, camera: &Camera, place: [f64; 2], unit: f64) {
    for (at, name) in ["x", "y", "z"].into_iter().enumerate() {
        let [right, down] = camera.direction(std::array::from_fn(|c| f64::from(u8::from(c == at))));
        if right.hypot(down) < 0.1 {
            continue;
        }
        let length = 52.0 * unit;
        let end = [place[0] + length * right, place[1] + length * down];
        image.line(place, end, INK, 2.5 * unit);
        let size = 25.0 * unit;
        let way = right.hypot(down);
        let beyond = [end[0] + 16.0 * unit * right / way, end[1] + 16.0 * unit * down / way];
        let wide = writer.length(name, size);
        writer.write_on_ground(image, name, [beyond[0] - wide / 2.0, beyond[1] + 0.27 * size], size, INK);
    }
}

/// A ring at a place, with words beside it that stay within the picture.
pub(super) fn mark(image: &mut Image, writer: &Writer, [x, y]: [f64; 2], words: &str, unit: f64) {
    let (radius, size) = (13.0 * unit, 28.0 * unit);
    image.ring([x, y], radius, [255; 3], 8.0 * unit);
    image.ring([x, y], radius, INK, 3.5 * unit);
    let wide = writer.length(words, size);
    let right = x + radius + 12.0 * unit;
    let from = if right + wide < image.width as f64 { right } else { x - radius - 12.0 * unit - wide };
    let base = (y + 0.3 * size).clamp(size, image.height as f64 - 0.4 * size);
    writer.write_on_ground(image, words, [from, base], size, INK);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        for (value, said) in [
            (0.0, "0"),
            (2742.4, "2742"),
            (27424.0, "27420"),
            (0.5, "0.5"),
            (-12.3456, "−12.35"),
            (2.5e-5, "2.5·10⁻⁵"),
            (3.2e9, "3.2·10⁹"),
        ] {
            assert_eq!(number(value), said);
        }
    }

    #[test]
    fn ticks_are_round_and_within_the_limits() {
        assert_eq!(ticks([0.0, 10.0]), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks([-130.0, 270.0]), [-100.0, 0.0, 100.0, 200.0]);
    }
}
