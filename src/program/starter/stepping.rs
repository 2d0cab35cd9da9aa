//! Time steps of a starter deck, from the steps of the file and the points of its amplitudes.

use zelus_meshes::conditions::LoadKind;
use zelus_meshes::history::History;
use zelus_meshes::mesh::{Mesh, Step};

/// Parts of a step of the file: with contact, yielding bodies or large displacements, and without.
const NONLINEAR: f64 = 4.0;
const YIELDING: f64 = 10.0;
/// The most parts that points of amplitudes ask for.
const MOST: f64 = 200.0;
/// Relative length below which two points are a jump.
const JUMP: f64 = 1e-6;

/// The end of the run.
pub(super) fn end(mesh: &Mesh) -> f64 {
    mesh.steps.last().map_or(1.0, |step| step.end)
}

/// The object `time_stepping`.
pub(super) fn text(mesh: &Mesh) -> String {
    let whole = Step { start: 0.0, end: 1.0, increment: None };
    let steps = if mesh.steps.is_empty() { &[whole][..] } else { &mesh.steps };
    let lengths: Vec<f64> = steps.iter().map(|step| length(mesh, step)).collect();
    if let &[length] = &lengths[..] {
        return format!("{{\"time_step\": {length:?}}}");
    }
    let rule = |(at, (step, length)): (usize, (&Step, &f64))| {
        let end = step.end - 0.5 * length;
        format!("\"{}\": {{\"interval\": [{:?}, {end:?}], \"time_step\": {length:?}}}", at + 1, step.start)
    };
    let rules: Vec<String> = steps.iter().zip(&lengths).enumerate().map(rule).collect();
    format!("{{\"time_step_intervals\": {{{}}}}}", rules.join(", "))
}

fn histories(mesh: &Mesh) -> Vec<&History> {
    let mut out: Vec<&History> = mesh.supports.iter().flat_map(|support| support.values.iter().flatten()).collect();
    for load in &mesh.loads {
        match &load.kind {
            LoadKind::Pressure(value) | LoadKind::Centrifugal { square: value, .. } => out.push(value),
            LoadKind::Force(all)
            | LoadKind::Total(all)
            | LoadKind::Moment(all)
            | LoadKind::Traction(all)
            | LoadKind::Acceleration(all) => {
                out.extend(all);
            }
        }
    }
    out.extend(mesh.temperatures.iter().map(|own| &own.value));
    out.extend(mesh.bolts.iter().flat_map(|bolt| bolt.force.iter().chain(&bolt.shortening)));
    out
}

/// Length of the increments of a step.
fn length(mesh: &Mesh, step: &Step) -> f64 {
    let whole = step.end - step.start;
    if let Some(increment) = step.increment {
        return whole / (whole / increment).round().max(1.0);
    }
    let yields = mesh.materials.iter().any(|own| !own.yield_curve.is_empty());
    let touches = mesh.pairs.iter().any(|pair| !pair.tied);
    let parts = match (yields, touches || mesh.is_large) {
        (true, _) => YIELDING,
        (false, true) => NONLINEAR,
        _ => 1.0,
    };
    let mut times: Vec<f64> = vec![step.start, step.end];
    let points = histories(mesh).into_iter().flat_map(History::points).map(|point| point[0]);
    times.extend(points.filter(|time| *time > step.start && *time < step.end));
    times.sort_unstable_by(f64::total_cmp);
    let gaps = times.windows(2).map(|two| two[1] - two[0]).filter(|gap| *gap > JUMP * whole);
    let shortest = gaps.fold(whole, f64::min);
    whole / parts.max((whole / shortest - JUMP).ceil().min(MOST))
}
