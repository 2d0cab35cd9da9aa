//! Points whose stresses are computed together.

use std::cell::RefCell;
use std::sync::Arc;

use zelus_core::entities::{Round, note, round};

use crate::law_function::{LawFunction, Points, Response};

/// Points of one material of a range of entities.
struct Noted {
    function: Arc<dyn LawFunction>,
    points: Points,
    response: Response,
    /// Points whose results have been taken.
    taken: usize,
}

/// Points of a range of entities.
#[derive(Default)]
struct Range {
    number: u64,
    materials: Vec<Noted>,
}

thread_local! {
    static RANGE: RefCell<Range> = RefCell::default();
}

/// Calls the functions of all materials of the range.
fn compute() -> Result<(), (usize, String)> {
    let mut range = RANGE.take();
    for noted in &mut range.materials {
        let found = noted.function.respond(&noted.points).and_then(|found| found.check(&noted.points));
        noted.response = found.map_err(|why| (noted.points.places.first().map_or(0, |place| place[0]), why))?;
    }
    RANGE.set(range);
    Ok(())
}

/// The numbers of a point, `width` each.
fn own(values: &[f64], at: usize, width: usize) -> &[f64] {
    &values[at * width..(at + 1) * width]
}

/// Result at one point (`points` has one), unless it has been noted for the second round: `of` gets the numbers of the point.
pub(crate) fn respond<T>(
    function: &Arc<dyn LawFunction>,
    point: Points,
    of: impl FnOnce(&[f64], &[f64], &[f64]) -> T,
) -> Result<Option<T>, String> {
    let (components, states, parameters) = (point.components, point.states, Arc::clone(&point.parameters));
    let is_same = |noted: &Noted| {
        Arc::ptr_eq(&noted.function, function)
            && Arc::ptr_eq(&noted.points.parameters, &parameters)
            && noted.points.components == components
    };
    match round() {
        Round::Alone => {
            let found = function.respond(&point)?.check(&point)?;
            Ok(Some(of(&found.stress, &found.tangent, &found.state)))
        }
        Round::Noting(number) => RANGE.with_borrow_mut(|range| {
            if range.number != number {
                *range = Range { number, materials: Vec::new() };
                note(compute);
            }
            match range.materials.iter_mut().find(|noted| is_same(noted)) {
                Some(Noted { points, .. }) => {
                    points.strain.extend(&point.strain);
                    points.state.extend(&point.state);
                    points.places.extend(&point.places);
                    points.wants_tangent |= point.wants_tangent;
                }
                None => {
                    let (function, response) = (Arc::clone(function), Response::default());
                    range.materials.push(Noted { function, points: point, response, taken: 0 });
                }
            }
            Ok(None)
        }),
        Round::Taking => RANGE.with_borrow_mut(|range| {
            let noted = range.materials.iter_mut().find(|noted| is_same(noted)).ok_or("no point was noted")?;
            let at = noted.taken;
            noted.taken += 1;
            let Response { stress, tangent, state } = &noted.response;
            let tangent = if noted.points.wants_tangent { own(tangent, at, components * components) } else { &[] };
            Ok(Some(of(own(stress, at, components), tangent, own(state, at, states))))
        }),
    }
}
