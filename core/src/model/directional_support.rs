//! Supports along directions: d · u = g at a node, several of them at once beside prescribed components.
//!
//! The equations of a node are brought to the form u_c = Σ w u_m + g by Gauss–Jordan elimination with full pivoting. Pivots are
//! components that nothing else prescribes; an equation without a pivot is redundant or contradicts the others.

use serde::{Deserialize, Serialize};

/// Length of the remainder of a unit direction from which on it is independent of the others.
const INDEPENDENT: f64 = 1e-8;
/// Difference of two prescribed values that are one, as a share of the largest of them.
const SAME_VALUE: f64 = 1e-9;
/// Weight that is round-off of the elimination.
const ROUND_OFF: f64 = 1e-15;

/// The equation d · u = g of a support at the node of its constraint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DirectionalSupport {
    /// Unit vector d; its component out of the plane is zero in planar models.
    pub direction: [f64; 3],
    /// Value g.
    pub value: f64,
    /// Whether it acts in this step, also where other supports make it redundant.
    pub acts: bool,
}

/// Role of a component of the node beside its supports along directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SupportedComponent {
    /// May be eliminated.
    Free,
    /// Prescribed at a value, as far as it is known.
    Prescribed(Option<f64>),
    /// Follows other nodes by a constraint of its own.
    Follows,
}

/// An equation that cannot hold beside the others.
#[derive(Debug, Clone, PartialEq)]
pub enum SupportConflict {
    /// The others give d · u another value than it has: the number of the equation, their value and its own.
    Contradiction(usize, [f64; 2]),
    /// All components that it could prescribe follow other nodes: the number of the equation.
    Constrained(usize),
}

/// The form u_c = Σ w u_m + g of an equation: c, the terms (m, w), and g.
type Solved = (usize, Vec<(usize, f64)>, f64);

#[derive(Clone, Copy)]
struct Row {
    direction: [f64; 3],
    /// `None` where it is not known yet.
    value: Option<f64>,
    pivot: Option<usize>,
}

/// Solves the equations `(d, g)` of a node for as many components; `None` for one that follows from the others. The first `dimension`
/// components count.
///
/// ```
/// use zelus_core::model::{SupportedComponent, reduce_supports};
///
/// // A roller on a slope of 3 : 4, along a multiple of its normal.
/// let free = [SupportedComponent::Free; 3];
/// let reduced = reduce_supports(&[([0.75, 1.0, 0.0], Some(0.5))], free, 2).unwrap();
/// assert_eq!(reduced, [Some((1, vec![(0, -0.75)], 0.5))]);
/// ```
///
/// # Errors
/// An equation that contradicts the others, or is left with components that follow other nodes.
pub fn reduce_supports(
    equations: &[([f64; 3], Option<f64>)],
    components: [SupportedComponent; 3],
    dimension: usize,
) -> Result<Vec<Option<Solved>>, SupportConflict> {
    let row = |&(direction, value): &([f64; 3], Option<f64>)| Row { direction, value, pivot: None };
    let mut rows: Vec<Row> = equations.iter().map(row).collect();
    let mut free: Vec<usize> = (0..dimension).filter(|&c| components[c] == SupportedComponent::Free).collect();
    while let Some((at, c)) = pivot(&rows, &free) {
        let lead = rows[at].direction[c];
        rows[at].direction = rows[at].direction.map(|d| d / lead);
        rows[at].direction[c] = 1.0;
        rows[at].value = rows[at].value.map(|value| value / lead);
        rows[at].pivot = Some(c);
        free.retain(|&other| other != c);
        let own = rows[at];
        for row in rows.iter_mut().enumerate().filter(|(other, _)| *other != at).map(|(_, row)| row) {
            let factor = row.direction[c];
            (0..3).for_each(|d| row.direction[d] -= factor * own.direction[d]);
            row.direction[c] = 0.0;
            row.value = row.value.zip(own.value).map(|(value, of)| value - factor * of);
        }
    }
    for (at, row) in rows.iter().enumerate().filter(|(_, row)| row.pivot.is_none()) {
        check(at, row, equations, components, dimension)?;
    }
    let solved = |row: &Row| {
        let c = row.pivot?;
        let others = (0..dimension).filter(|&m| m != c && row.direction[m].abs() > ROUND_OFF);
        Some((c, others.map(|m| (m, -row.direction[m])).collect(), row.value.unwrap_or(0.0)))
    };
    Ok(rows.iter().map(solved).collect())
}

/// The largest entry of rows without a pivot, among these components.
fn pivot(rows: &[Row], free: &[usize]) -> Option<(usize, usize)> {
    let mut best = (INDEPENDENT, None);
    for (at, row) in rows.iter().enumerate().filter(|(_, row)| row.pivot.is_none()) {
        for &c in free {
            let size = row.direction[c].abs();
            if size > best.0 {
                best = (size, Some((at, c)));
            }
        }
    }
    best.1
}

/// Checks an equation without a pivot against the values of prescribed components.
fn check(
    at: usize,
    row: &Row,
    equations: &[([f64; 3], Option<f64>)],
    components: [SupportedComponent; 3],
    dimension: usize,
) -> Result<(), SupportConflict> {
    let (mut follows, mut largest) = (0.0, 0.0_f64);
    for c in 0..dimension {
        let weight = row.direction[c];
        match components[c] {
            SupportedComponent::Follows if weight.abs() > INDEPENDENT => return Err(SupportConflict::Constrained(at)),
            SupportedComponent::Prescribed(None) if weight.abs() > INDEPENDENT => return Ok(()),
            SupportedComponent::Prescribed(Some(value)) => {
                follows += weight * value;
                largest = largest.max((weight * value).abs());
            }
            _ => {}
        }
    }
    let Some(value) = row.value else { return Ok(()) };
    let given = equations.iter().filter_map(|(_, value)| *value).fold(0.0_f64, |most, value| most.max(value.abs()));
    if (value - follows).abs() <= SAME_VALUE * largest.max(given) {
        return Ok(());
    }
    // The others give d · u what the equation lacks.
    let own = equations[at].1.unwrap_or(0.0);
    Err(SupportConflict::Contradiction(at, [own - (value - follows), own]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use SupportedComponent::{Follows, Free, Prescribed};

    const SLOPE: [f64; 3] = [0.6, 0.8, 0.0];

    #[test]
    fn two_directions_meet_on_an_edge() {
        let equations = [(SLOPE, Some(1.0)), ([0.0, 0.6, 0.8], Some(2.0))];
        let reduced = reduce_supports(&equations, [Free; 3], 3).unwrap();
        // Whatever the remaining component is, both equations hold.
        for free in [0.0, 3.0] {
            let mut u = [free; 3];
            for (c, terms, constant) in reduced.iter().flatten() {
                u[*c] = terms.iter().map(|&(m, w)| w * u[m]).sum::<f64>() + constant;
            }
            for (direction, value) in equations {
                let sum: f64 = (0..3).map(|c| direction[c] * u[c]).sum();
                assert!((sum - value.unwrap()).abs() < 1e-14, "{sum} {value:?}");
            }
        }
    }

    #[test]
    fn three_directions_clamp_a_node() {
        let equations = [(SLOPE, Some(0.6)), ([0.8, -0.6, 0.0], Some(0.8)), ([0.0, 0.6, 0.8], Some(0.0))];
        let reduced = reduce_supports(&equations, [Free; 3], 3).unwrap();
        for (c, terms, constant) in reduced.into_iter().flatten() {
            assert!(terms.is_empty());
            assert!((constant - [1.0, 0.0, 0.0][c]).abs() < 1e-14);
        }
    }

    #[test]
    fn prescribed_components_stay() {
        let reduced = reduce_supports(&[(SLOPE, Some(0.0))], [Free, Prescribed(Some(0.0)), Free], 3).unwrap();
        let (c, terms, _) = reduced[0].clone().unwrap();
        assert_eq!((c, terms[0].0), (0, 1));
    }

    #[test]
    fn consistent_supports_are_redundant_and_others_contradict() {
        let clamp = |x| [Prescribed(Some(x)), Prescribed(Some(0.5)), Free];
        assert_eq!(reduce_supports(&[(SLOPE, Some(1.0))], clamp(1.0), 2), Ok(vec![None]));
        let wrong = reduce_supports(&[(SLOPE, Some(1.0))], clamp(0.0), 2);
        assert_eq!(wrong, Err(SupportConflict::Contradiction(0, [0.4, 1.0])));
        let twice = [(SLOPE, Some(0.2)), (SLOPE, Some(0.2))];
        assert_eq!(reduce_supports(&twice, [Free; 3], 2).unwrap().iter().flatten().count(), 1);
        let twice = [(SLOPE, Some(0.2)), (SLOPE.map(|d| -d), Some(0.2))];
        assert_eq!(reduce_supports(&twice, [Free; 3], 2), Err(SupportConflict::Contradiction(1, [-0.2, 0.2])));
        assert_eq!(reduce_supports(&[(SLOPE, None)], clamp(0.0), 2), Ok(vec![None]));
        let tied = [Follows, Follows, Free];
        assert_eq!(reduce_supports(&[(SLOPE, Some(0.0))], tied, 2), Err(SupportConflict::Constrained(0)));
    }
}
