//! Profiles as decks write them: a start, and segments that go on from there.

use zelus_core::diagnostics::Result;
use zelus_core::parameters::{Node, Settings};

use super::profile::{Profile, Segment};
use super::rigid_shape::profile_of;

/// Where a profile starts, and its segments.
const START: &str = "start";
const SEGMENTS: &str = "segments";

/// The profile by `start` and `segments`, each `{"line_to": [x, y]}` or `{"arc_to": [x, y], "centre": [x, y], "clockwise": false}`.
///
/// # Errors
/// Segments that are neither, or make no profile.
pub(super) fn profile(settings: &Settings) -> Result<Profile> {
    let mut at: [f64; 2] = settings.get(START)?.parse(START)?;
    let mut segments = Vec::new();
    for item in settings.items(SEGMENTS)? {
        let (segment, end) = segment(settings, item, at)?;
        segments.push(segment);
        at = end;
    }
    profile_of(settings, SEGMENTS, segments)
}

fn segment(settings: &Settings, item: &Node, from: [f64; 2]) -> Result<(Segment, [f64; 2])> {
    let known = |key: &str| ["line_to", "arc_to", "centre", "clockwise"].contains(&key);
    let keys: Vec<&str> = item.as_object().map(|own| own.keys().collect()).unwrap_or_default();
    let is_arc = keys.contains(&"arc_to");
    let fits =
        keys.iter().all(|key| known(key)) && if is_arc { !keys.contains(&"line_to") } else { keys == ["line_to"] };
    if !fits {
        let problem = settings.error(SEGMENTS, "rigid-shape", "a segment of the profile is neither a line nor an arc");
        let remedy = "write {\"line_to\": [x, y]} or {\"arc_to\": [x, y], \"centre\": [x, y], \"clockwise\": false}";
        return Err(problem.at(item.place()).remedy(remedy).into());
    }
    if !is_arc {
        let to: [f64; 2] = item.require("line_to")?.parse("line_to")?;
        return Ok((Segment::Line { ends: [from, to] }, to));
    }
    let (to, centre): ([f64; 2], [f64; 2]) =
        (item.require("arc_to")?.parse("arc_to")?, item.require("centre")?.parse("centre")?);
    let clockwise = item.get("clockwise").map_or(Ok(false), Node::bool)?;
    let [start, end] = [from, to].map(|x| (x[0] - centre[0]).hypot(x[1] - centre[1]));
    if (start - end).abs() > 1e-6 * start.max(end) {
        let fact = format!("an arc of the profile starts {start} from its centre and ends {end} from it");
        let problem = settings.error(SEGMENTS, "rigid-shape", fact).at(item.place());
        return Err(problem.remedy("let both ends be as far from the centre").into());
    }
    Ok((Segment::arc(centre, from, to, clockwise), to))
}
