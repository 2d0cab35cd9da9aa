//! A builder-and-solver that corrects each answer once by what it leaves.

use zelus_core::strategies::{BuilderAction, BuilderEntry};
use zelus_core::{State, WrongState, register};
use zelus_linear_algebra::{LinearSolver, SolveError, SolveReport, System};

struct Refining(Box<dyn LinearSolver>);

impl LinearSolver for Refining {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        let mut report = self.0.solve(system, rhs, x)?;
        let (mut left, mut correction) = (vec![0.0; rhs.len()], vec![0.0; rhs.len()]);
        let size = system.residual(rhs, x, &mut left);
        if size > 0.0 {
            let again = self.0.solve(system, &left, &mut correction)?;
            report.add_effort(&again);
            x.iter_mut().zip(&correction).for_each(|(x, more)| *x += more);
        }
        Ok(report)
    }

    fn forget(&mut self) {
        self.0.forget();
    }

    fn state(&self) -> Option<Box<dyn State>> {
        self.0.state()
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<(), WrongState> {
        self.0.resume(state)
    }
}

register! { BuilderEntry "refining",
    about: "each answer is corrected once by what it leaves",
    source: "x ← x + A⁻¹ (b − A x)",
    build: BuilderAction::Around(|_settings, solver| Ok(Box::new(Refining(solver)))),
}
