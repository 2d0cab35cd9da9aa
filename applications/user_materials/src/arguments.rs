//! One call of a UMAT: its arguments in the order and the layout of the calling convention.
//!
//! Voigt vectors are (11, 22, 33, 12, 13, 23), in plane stress (11, 22, 12), with engineering shear strains, matrices by columns; tension
//! is positive.

use std::sync::PoisonError;

use crate::ending;
use crate::library::Subroutine;

/// Components of stress at most.
pub const COMPONENTS: usize = 6;
/// Length of CMNAME.
const NAME: usize = 80;

/// CMNAME: capitals, filled with blanks.
pub type Name = [u8; NAME];

/// The name of a material as CMNAME.
pub fn name_of(text: &str) -> Name {
    let mut name = [b' '; NAME];
    name.iter_mut().zip(text.bytes()).for_each(|(to, from)| *to = from.to_ascii_uppercase());
    name
}

/// Input and output of a call.
#[derive(Debug, Clone)]
pub struct Arguments<'a> {
    /// Stress at the start, and at the end (force per area).
    pub stress: [f64; COMPONENTS],
    /// dΔσ/dΔε by columns, the first `components`² numbers (force per area).
    pub tangent: [f64; COMPONENTS * COMPONENTS],
    /// Strain at the start.
    pub strain: [f64; COMPONENTS],
    /// Its increment.
    pub increment: [f64; COMPONENTS],
    /// Deformation gradients at the start and at the end, by columns.
    pub gradients: [[f64; 9]; 2],
    /// Rotation of the increment, by columns.
    pub rotation: [f64; 9],
    /// TIME at the start and at the end.
    pub time: [f64; 2],
    /// TEMPERATURE at the start and at the end.
    pub temperature: [f64; 2],
    /// COORDS of the point.
    pub position: [f64; 3],
    /// Components of stress: 6 in space, 4 in plane strain and about an axis, 3 in plane stress.
    pub components: usize,
    /// Constants.
    pub constants: &'a [f64],
    /// Name of the material.
    pub name: &'a Name,
    /// Id of the element and number of the Gauss point, 0 where unknown.
    pub place: [usize; 2],
    /// Energy per volume that the routine states: elastic, plastic, creep.
    pub energies: [f64; 3],
    /// Share of the time step that the routine asks for.
    pub next_step: f64,
}

impl Arguments<'_> {
    /// Replaces the tangent by its symmetric part.
    pub fn take_symmetric_tangent(&mut self) {
        let n = self.components;
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (self.tangent[i * n + j] + self.tangent[j * n + i]);
                (self.tangent[i * n + j], self.tangent[j * n + i]) = (mean, mean);
            }
        }
    }

    /// Calls the subroutine; `states` are those at the start, and at the end.
    pub fn call(&mut self, subroutine: &Subroutine, in_turn: bool, states: &mut [f64]) {
        let [begin, end] = self.time;
        let (time, step) = ([begin, begin], end - begin);
        let direct = if self.components == 3 { 2 } else { 3 };
        let [direct, shear, all, states_len, constants] =
            [direct, self.components - direct, self.components, states.len(), self.constants.len()].map(|n| n as i32);
        let [start, reached] = self.temperature;
        let heating = reached - start;
        let [element, point] = self.place.map(|n| n as i32);
        let [elastic, plastic, creep] = &mut self.energies;
        let (mut heat, mut by_temperature, mut heat_by_strain, mut heat_by_temperature) =
            (0.0, [0.0; COMPONENTS], [0.0; COMPONENTS], 0.0);
        let (zero, one) = (0.0, 1);
        let [gradient, next_gradient] = &self.gradients;
        let call = || {
            // SAFETY: the arguments have the sizes of the calling convention, and no one else has them.
            unsafe {
                (subroutine.call)(
                    self.stress.as_mut_ptr(),
                    states.as_mut_ptr(),
                    self.tangent.as_mut_ptr(),
                    elastic,
                    plastic,
                    creep,
                    &mut heat,
                    by_temperature.as_mut_ptr(),
                    heat_by_strain.as_mut_ptr(),
                    &mut heat_by_temperature,
                    self.strain.as_ptr(),
                    self.increment.as_ptr(),
                    time.as_ptr(),
                    &step,
                    &start,
                    &heating,
                    &zero,
                    &zero,
                    self.name.as_ptr(),
                    &direct,
                    &shear,
                    &all,
                    &states_len,
                    self.constants.as_ptr(),
                    &constants,
                    self.position.as_ptr(),
                    self.rotation.as_ptr(),
                    &mut self.next_step,
                    &1.0,
                    gradient.as_ptr(),
                    next_gradient.as_ptr(),
                    &element,
                    &point,
                    &one,
                    &one,
                    [1, 1, 0, 0].as_ptr(),
                    &one,
                    NAME,
                );
            }
        };
        let turn = in_turn.then(|| subroutine.turn.lock().unwrap_or_else(PoisonError::into_inner));
        ending::within(self.place[0], self.place[1], call);
        drop(turn);
    }
}
