//! Motions that elements hardly resist: multigrid has to carry them to the coarser levels.

use zelus_linear_algebra::parallel;

use crate::communication::Ranks;
use crate::model::{Rates, ScalarVariable};

/// Axes that a rotation turns into each other.
const ROTATIONS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// The unknown of an equation and the initial position of its node; multipliers have none.
pub type DofPosition = Option<(ScalarVariable, [f64; 3])>;

/// The near-null space of equations: for each vector field of the unknowns its translations and rotations, the latter with the field that
/// [turns](Rates::turns) it, for each scalar one the constant. Entries of multipliers are zero.
pub fn near_null_space(places: &[DofPosition]) -> Vec<Vec<f64>> {
    let mut variables: Vec<ScalarVariable> = Vec::new();
    let (mut center, share) = ([0.0; 3], 1.0 / places.len() as f64);
    for (variable, at) in places.iter().flatten() {
        (0..3).for_each(|axis| center[axis] += share * at[axis]);
        if !variables.contains(variable) {
            variables.push(*variable);
        }
    }
    motions(places, &variables, center)
}

/// The same for the places of each rank, which have some of `variables`: the motions are those of all together. Collective.
pub fn near_null_space_of_all(ranks: &Ranks, variables: &[ScalarVariable], places: &[DofPosition]) -> Vec<Vec<f64>> {
    let has = |variable: &ScalarVariable| places.iter().flatten().any(|(other, _)| other == variable);
    let mut appear: Vec<bool> = variables.iter().map(has).collect();
    ranks.any_of(&mut appear);
    let variables = variables.iter().zip(appear).filter(|(_, appears)| *appears).map(|(variable, _)| *variable);
    let mut sums = [0.0, 0.0, 0.0, places.iter().flatten().count() as f64];
    places.iter().flatten().for_each(|(_, at)| (0..3).for_each(|axis| sums[axis] += at[axis]));
    ranks.sum(&mut sums);
    motions(places, &variables.collect::<Vec<_>>(), [0, 1, 2].map(|axis| sums[axis] / sums[3].max(1.0)))
}

fn motions(places: &[DofPosition], variables: &[ScalarVariable], center: [f64; 3]) -> Vec<Vec<f64>> {
    let mut fields: Vec<(&'static str, [bool; 3], bool)> = Vec::new();
    for variable in variables {
        let field = match fields.iter_mut().find(|(column, ..)| *column == variable.column) {
            Some(field) => field,
            None => {
                fields.push((variable.column, [false; 3], variable.component.is_some()));
                fields.last_mut().expect("just pushed")
            }
        };
        field.1[variable.offset()] = true;
    }
    let mut space = Vec::new();
    let turned = |column: &str| Rates::of(column).and_then(|rates| rates.turns);
    let names: Vec<&str> = fields.iter().map(|(column, ..)| *column).collect();
    for (column, has, is_vector) in fields {
        // Rotations alone are no motions: they go with what they turn.
        if turned(column).is_some_and(|other| names.contains(&other)) {
            continue;
        }
        let rotation = names.iter().find(|name| turned(name) == Some(column));
        let unit = |is_one: bool| f64::from(u8::from(is_one));
        let mut add = |axis: usize, value: &(dyn Fn(usize, &[f64; 3]) -> f64 + Sync), is_rotation: bool| {
            let of = |place: &DofPosition| match place {
                Some((variable, at)) if variable.column == column => value(variable.offset(), at),
                Some((variable, _)) if is_rotation && Some(&variable.column) == rotation => {
                    unit(variable.offset() == axis)
                }
                _ => 0.0,
            };
            space.push(parallel::map(places.len(), 4096, |at| of(&places[at])));
        };
        for axis in (0..3).filter(|&axis| has[axis]) {
            add(axis, &|along, _| unit(along == axis), false);
        }
        for [a, b] in ROTATIONS.into_iter().filter(|[a, b]| is_vector && has[*a] && has[*b]) {
            let rotated = |along: usize, at: &[f64; 3]| match along {
                _ if along == a => center[b] - at[b],
                _ if along == b => at[a] - center[a],
                _ => 0.0,
            };
            add(3 - a - b, &rotated, true);
        }
    }
    space
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::test_variables::{DISPLACEMENT, ROTATION};

    #[test]
    fn a_vector_field_translates_and_rotates() {
        let [x, y] = [0, 1].map(|axis| DISPLACEMENT.component(axis));
        let (first, second) = ([0.0; 3], [2.0, 4.0, 0.0]);
        let space = near_null_space(&[Some((x, first)), Some((y, first)), Some((x, second)), Some((y, second))]);
        let expected = [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0], [2.0, -1.0, -2.0, 1.0]];
        assert_eq!(space, expected.map(|vector| vector.to_vec()));
    }

    #[test]
    fn rotations_of_bodies_turn_their_reference_nodes() {
        let [x, y, spin] = [DISPLACEMENT.component(0), DISPLACEMENT.component(1), ROTATION.component(2)];
        let (first, second) = ([0.0; 3], [2.0, 4.0, 0.0]);
        let space = near_null_space(&[(x, first), (y, first), (spin, first), (x, second), (y, second)].map(Some));
        let [translations @ .., rotation] = &space[..] else { panic!("{space:?}") };
        assert_eq!(translations, [[1.0, 0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0, 1.0]]);
        // About the mean place (4/5, 8/5) of the unknowns.
        let expected = [1.6, -0.8, 1.0, -2.4, 1.2];
        assert!(
            rotation.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12),
            "{rotation:?}"
        );
        assert_eq!(near_null_space(&[Some((spin, first))]).len(), 1, "a field alone has constants");
    }

    #[test]
    fn multipliers_have_no_part_in_a_scalar_field() {
        let scalar = ScalarVariable { column: "TEMPERATURE", component: None };
        assert_eq!(near_null_space(&[Some((scalar, [1.0; 3])), None]), [[1.0, 0.0]]);
    }
}
