//! Text of pictures.

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use zelus_core::{Error, Result};

use super::image::{Colour, Image};

const FONT: &[u8] = include_bytes!("font/DejaVuSans.ttf");

/// Writes words.
pub(super) struct Writer {
    font: FontRef<'static>,
}

impl Writer {
    /// # Errors
    /// A font that cannot be read.
    pub fn new() -> Result<Self> {
        let font = FontRef::try_from_slice(FONT).map_err(|error| Error::System(format!("font: {error}")))?;
        Ok(Self { font })
    }

    /// Glyphs of a line from a place on its base line, and its length.
    fn glyphs(&self, text: &str, [x, y]: [f64; 2], size: f64) -> (Vec<Glyph>, f64) {
        let scale = PxScale::from(size as f32);
        let font = self.font.as_scaled(scale);
        let (mut at, mut glyphs, mut last) = (x as f32, Vec::new(), None);
        for letter in text.chars() {
            let id = self.font.glyph_id(letter);
            at += last.map_or(0.0, |last| font.kern(last, id));
            glyphs.push(id.with_scale_and_position(scale, point(at, y as f32)));
            at += font.h_advance(id);
            last = Some(id);
        }
        (glyphs, f64::from(at) - x)
    }

    /// The length of a line.
    pub fn length(&self, text: &str, size: f64) -> f64 {
        self.glyphs(text, [0.0; 2], size).1
    }

    /// Writes a line from a place on its base line; gives its length.
    pub fn write(&self, image: &mut Image, text: &str, place: [f64; 2], size: f64, colour: Colour) -> f64 {
        let (glyphs, length) = self.glyphs(text, place, size);
        for outline in glyphs.into_iter().filter_map(|glyph| self.font.outline_glyph(glyph)) {
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, share| {
                image.blend(corner.x as i64 + i64::from(x), corner.y as i64 + i64::from(y), colour, f64::from(share));
            });
        }
        length
    }

    /// Writes a line with a white rim, which is read on any ground.
    pub fn write_on_ground(&self, image: &mut Image, text: &str, [x, y]: [f64; 2], size: f64, colour: Colour) {
        let rim = 0.09 * size;
        for step in 0..12 {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 12.0).sin_cos();
            self.write(image, text, [x + rim * cos, y + rim * sin], size, [255; 3]);
        }
        self.write(image, text, [x, y], size, colour);
    }

    /// Lines of words that are no longer than a width; a longer word stands alone.
    pub fn lines(&self, text: &str, width: f64, size: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split(' ') {
            match lines.last_mut() {
                Some(line) if self.length(&format!("{line} {word}"), size) <= width => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_darken_a_white_ground_and_wrap() {
        let writer = Writer::new().expect("a font");
        let mut image = Image { width: 200, height: 40, colours: vec![255; 24_000] };
        let length = writer.write(&mut image, "σ ≥ 2·10³", [5.0, 30.0], 24.0, [0; 3]);
        assert!(length > 60.0 && length < 195.0, "{length}");
        assert!(image.colours.iter().filter(|&&part| part < 60).count() > 300);
        assert_eq!(writer.lines("contact pressure (force/area)", 210.0, 24.0), ["contact pressure", "(force/area)"]);
    }

    #[test]
    fn the_font_has_all_characters_of_the_program() {
        let writer = Writer::new().expect("a font");
        let used = "ABCxyz019.,:;+-−–×≥≤·°²³µσετπ()/|<>…";
        let missing: Vec<char> = used.chars().filter(|&own| writer.font.glyph_id(own).0 == 0).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
