//! PNG files: one picture, or an animation that repeats.

use std::io::Write;
use std::path::Path;

use zelus_core::io::{Mark, replace_own_file};
use zelus_core::{Error, Result};

use super::image::Image;

/// Time of a picture of an animation, as a fraction of a second.
const PAUSE: (u16, u16) = (12, 100);
/// The program that has written a picture, by which one is recognised.
const SOFTWARE: &str = "zelus report";
pub(super) const MARK: Mark = Mark::Holds(SOFTWARE);
/// Filters of rows; which of them makes the smallest file depends on lines and shades of the picture.
const FILTERS: [png::Filter; 7] = [
    png::Filter::NoFilter,
    png::Filter::Sub,
    png::Filter::Up,
    png::Filter::Avg,
    png::Filter::Paeth,
    png::Filter::Adaptive,
    png::Filter::MinEntropy,
];

/// Writes the images by the filter that makes the smallest file.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn write(file: &Path, images: &[Image]) -> Result<()> {
    let mut least: Option<Vec<u8>> = None;
    for filter in FILTERS {
        let bytes = encoded(images, filter).map_err(|error| Error::System(format!("picture: {error}")))?;
        if least.as_ref().is_none_or(|own| bytes.len() < own.len()) {
            least = Some(bytes);
        }
    }
    replace_own_file(file, |out| out.write_all(&least.unwrap_or_default()))
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
