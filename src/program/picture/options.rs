//! Options of `zelus report --picture`.

use std::path::PathBuf;

use zelus_core::diagnostics::Diagnostic;
use zelus_core::{Error, Result};

/// The file of the picture, and options that select its content.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Options of a picture")]
pub(in super::super) struct PictureOptions {
    /// Write the deformed model as a PNG file, without a browser.
    #[arg(long = "picture", value_name = "FILE.png")]
    pub file: Option<PathBuf>,
    /// Field of the colours, with a component after a colon, e.g. CONTACT_PRESSURE or DISPLACEMENT:y. By default the first that the run
    /// has of VON_MISES_STRESS, CONTACT_PRESSURE, TEMPERATURE, DISPLACEMENT.
    #[arg(long, requires = "file", value_name = "NAME[:COMPONENT]")]
    pub field: Option<String>,
    /// Written step, from 0; all makes an animation. By default the last.
    #[arg(long, requires = "file", value_name = "N")]
    pub step: Option<String>,
    /// Factor of the deformation. By default 1 where the deformation is seen, else a round factor that shows it.
    #[arg(long, requires = "file", value_name = "X", allow_negative_numbers = true)]
    pub factor: Option<f64>,
    /// Direction towards the eye: x, -x, y, -y, z, -z, or three numbers, e.g. 1,-2,0.5. By default oblique; of models in the plane z.
    #[arg(long, requires = "file", value_name = "DIRECTION", allow_hyphen_values = true)]
    pub view: Option<String>,
    /// Plane that cuts off what is before it: x, y or z through the middle, or at a place, e.g. y=12.5; -y keeps what is before it.
    #[arg(long, requires = "file", value_name = "AXIS[=PLACE]", allow_hyphen_values = true)]
    pub cut: Option<String>,
    /// Plane of symmetry at which the model is mirrored, through 0 or at a place, e.g. x or x=-5. May be repeated.
    #[arg(long, requires = "file", value_name = "AXIS[=PLACE]")]
    pub mirror: Vec<String>,
    /// Angle, in degrees, by which a model of revolution is turned about its axis, e.g. 270.
    #[arg(long, requires = "file", value_name = "DEGREES", conflicts_with_all = ["cut", "mirror"])]
    pub revolve: Option<f64>,
    /// Body that is left out, by its name on the page. May be repeated.
    #[arg(long, requires = "file", value_name = "BODY")]
    pub hide: Vec<String>,
    /// Range of the colours, e.g. 0:250. By default that of the step, without a peak that hides the rest.
    #[arg(long, requires = "file", value_name = "LOW:HIGH", allow_hyphen_values = true)]
    pub range: Option<String>,
    /// Unit after the name of the quantity, e.g. N/mm². By default its dimension.
    #[arg(long, requires = "file", value_name = "TEXT")]
    pub unit: Option<String>,
    /// Second view, enlarged by this factor, of the place with the largest value.
    #[arg(long, requires = "file", value_name = "FACTOR")]
    pub inset: Option<f64>,
    /// Width in points.
    #[arg(long, requires = "file", value_name = "POINTS", default_value_t = 1600)]
    pub width: usize,
}

/// Steps that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    Last,
    One(usize),
    All,
}

pub(super) fn wrong(fact: impl Into<String>, remedy: impl Into<String>) -> Error {
    Diagnostic::error("command-line", fact.into()).remedy(remedy.into()).into()
}

/// An axis with a place on it: `x`, `-y` or `z=3`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AtAxis {
    pub axis: usize,
    pub is_negative: bool,
    pub place: Option<f64>,
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|own: &f64| own.is_finite())
}

fn at_axis(option: &str, text: &str) -> Result<AtAxis> {
    let form =
        || wrong(format!("{option} {text} is no plane"), format!("write an axis, e.g. {option} y, or {option} y=12.5"));
    let (axis, place) = text.split_once('=').map_or((text, None), |(axis, place)| (axis, Some(place)));
    let place = place.map(|own| number(own).ok_or_else(form)).transpose()?;
    let name = axis.trim().trim_start_matches('-');
    let at = ["x", "y", "z"].iter().position(|own| *own == name).ok_or_else(form)?;
    Ok(AtAxis { axis: at, is_negative: axis.trim().starts_with('-'), place })
}

impl PictureOptions {
    /// # Errors
    /// A text that is no number of a step.
    pub(super) fn steps(&self) -> Result<Steps> {
        match self.step.as_deref() {
            None => Ok(Steps::Last),
            Some("all") => Ok(Steps::All),
            Some(text) => text
                .parse()
                .map(Steps::One)
                .map_err(|_| wrong(format!("--step {text} is no written step"), "write a number from 0, or all")),
        }
    }

    /// # Errors
    /// A text that is no plane.
    pub(super) fn cut(&self) -> Result<Option<AtAxis>> {
        self.cut.as_deref().map(|text| at_axis("--cut", text)).transpose()
    }

    /// # Errors
    /// A text that is no plane.
    pub(super) fn mirrors(&self) -> Result<Vec<AtAxis>> {
        self.mirror.iter().map(|text| at_axis("--mirror", text)).collect()
    }

    /// The direction towards the eye, where it is given.
    ///
    /// # Errors
    /// A text that is no direction.
    pub(super) fn view(&self) -> Result<Option<[f64; 3]>> {
        let Some(text) = self.view.as_deref() else { return Ok(None) };
        let form = || wrong(format!("--view {text} is no direction"), "write x, -x, y, -y, z, -z, or e.g. 1,-2,0.5");
        if let Ok(AtAxis { axis, is_negative, place: None }) = at_axis("--view", text) {
            let sign = if is_negative { -1.0 } else { 1.0 };
            return Ok(Some(std::array::from_fn(|c| if c == axis { sign } else { 0.0 })));
        }
        let numbers: Vec<f64> = text.split(',').map(number).collect::<Option<_>>().ok_or_else(form)?;
        let numbers: [f64; 3] = numbers.try_into().map_err(|_| form())?;
        if numbers == [0.0; 3] { Err(form()) } else { Ok(Some(numbers)) }
    }

    /// # Errors
    /// A text that is no range.
    pub(super) fn range(&self) -> Result<Option<[f64; 2]>> {
        let Some(text) = self.range.as_deref() else { return Ok(None) };
        let both = text.split_once(':').and_then(|(low, high)| Some([number(low)?, number(high)?]));
        let both = both.filter(|[low, high]| low < high);
        both.map(Some).ok_or_else(|| wrong(format!("--range {text} is no range"), "write e.g. 0:250"))
    }

    /// Refuses numbers out of their range and a file of another kind.
    ///
    /// # Errors
    /// The first of them.
    pub(super) fn check(&self, file: &std::path::Path) -> Result<()> {
        if !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            return Err(wrong(format!("--picture {} is no PNG file", file.display()), "let the name end in .png"));
        }
        let positive = |name: &str, value: Option<f64>, most: f64| match value {
            Some(own) if !(own > 0.0 && own <= most) => {
                Err(wrong(format!("{name} {own} is out of range"), format!("it is above 0 and at most {most}")))
            }
            _ => Ok(()),
        };
        positive("--revolve", self.revolve, 360.0)?;
        positive("--inset", self.inset, 1000.0)?;
        if self.factor.is_some_and(|factor| !factor.is_finite()) {
            return Err(wrong("--factor is no number", "write e.g. --factor 20"));
        }
        if !(400..=4000).contains(&self.width) {
            return Err(wrong(format!("--width {} is out of range", self.width), "it is 400 to 4000 points"));
        }
        Ok(())
    }
}
