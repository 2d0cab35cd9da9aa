//! A system without inactive equations.

use crate::csr::Csr;
use crate::system::{Layout, System};

/// Equations that are left, and their matrices.
pub(crate) struct Reduced {
    layout: Layout,
    bulk: Csr,
    coupling: Option<Csr>,
    /// Number in the whole system of each equation.
    equations: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Reduced {
    /// The reduced system of a system that is not shared.
    pub(crate) fn new(system: &System<'_>) -> Self {
        let whole = system.layout;
        let equations: Vec<u32> = (0..system.equations() as u32).filter(|&e| !whole.is_inactive(e as usize)).collect();
        let mut number = vec![NONE; system.equations()];
        equations.iter().enumerate().for_each(|(at, &e)| number[e as usize] = at as u32);
        let matrix = |of: &Csr| {
            let mut out = Csr::empty(equations.len());
            for (row, &e) in equations.iter().enumerate() {
                let (columns, values) = of.row(e as usize);
                let left = columns.iter().zip(values).filter(|(j, _)| number[**j as usize] != NONE);
                for (&j, &value) in left {
                    out.columns.push(number[j as usize]);
                    out.values.push(value);
                }
                out.row_starts[row + 1] = out.columns.len();
            }
            out
        };
        let layout = Layout {
            node: equations.iter().map(|&e| whole.node[e as usize]).collect(),
            multiplier: equations.iter().map(|&e| whole.multiplier[e as usize]).collect(),
            ..Layout::default()
        };
        Self { layout, bulk: matrix(system.bulk), coupling: system.coupling.map(matrix), equations }
    }

    /// It with the stamps of the whole.
    pub(crate) fn system<'a>(&'a self, whole: &System<'a>) -> System<'a> {
        System { layout: &self.layout, bulk: &self.bulk, coupling: self.coupling.as_ref(), ..*whole }
    }

    /// Numbers of the whole system at the equations that are left.
    pub(crate) fn gather(&self, whole: &[f64]) -> Vec<f64> {
        self.equations.iter().map(|&e| whole[e as usize]).collect()
    }

    /// Writes numbers of the equations that are left to those of the whole system.
    pub(crate) fn scatter(&self, left: &[f64], whole: &mut [f64]) {
        self.equations.iter().zip(left).for_each(|(&e, &value)| whole[e as usize] = value);
    }

    /// Number in the whole system of an equation that is left.
    pub(crate) fn whole(&self, equation: usize) -> usize {
        self.equations[equation] as usize
    }
}
