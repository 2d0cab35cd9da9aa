//! Heat that follows a structure through the iterations of a step, so that both are found in one: `coupling_settings`, "monolithic".
//!
//! Heat is solved for after each iteration, and the effect of temperatures on the next increment is part of its tangent ([`Follower`]).
//! So the iteration of both converges as Newton's, also where the one drives the other strongly.

use std::sync::{Arc, Mutex, PoisonError};

use zelus_core::diagnostics::Result;
use zelus_core::entities::{EntityBlock, Follower, Interaction};
use zelus_core::model::ModelPart;
use zelus_core::strategies::{Linearized, Silent};

use crate::columns::Columns;
use crate::elements::PLASTIC_HEAT_POWER;
use crate::heat::Heat;
use crate::staggered::sizes;

/// Share of the spread of temperatures by which differences change them.
const NEARBY: f64 = 1e-6;

/// Heat beside the structure of a step.
pub(crate) struct MonolithicCoupling {
    heat: Arc<Mutex<Heat>>,
    /// Temperatures at the start of the step, prescribed ones as they are at its end.
    start: Vec<f64>,
    /// Out-of-balance residual in the state that differences refer to.
    referred: Vec<f64>,
}

impl MonolithicCoupling {
    /// For a step whose heat has been solved for once; `start` are the temperatures from which it was.
    pub(crate) fn new(heat: Arc<Mutex<Heat>>, start: Vec<f64>) -> Self {
        Self { heat, start, referred: Vec::new() }
    }
}

impl Heat {
    /// Out-of-balance residual in the present state of the structure.
    fn out_of_balance(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Vec<f64>> {
        self.plastic.take(part, elements);
        for interaction in &mut self.system.interactions {
            interaction.begin_step(part)?;
        }
        let Self { strategy, system, .. } = self;
        linearized(strategy.linearized()).out_of_balance(part, system)
    }

    /// The temperatures that answer this.
    fn answer(&mut self, part: &ModelPart, out_of_balance: &[f64]) -> Result<Vec<f64>> {
        let Self { strategy, system, .. } = self;
        linearized(strategy.linearized()).answer(part, system, out_of_balance)
    }
}

fn linearized(strategy: Option<&mut dyn Linearized>) -> &mut dyn Linearized {
    strategy.expect("checked when the strategies were joined")
}

impl Interaction for MonolithicCoupling {
    fn name(&self) -> &str {
        "heat with the structure"
    }

    fn follower(&mut self) -> Option<&mut dyn Follower> {
        Some(self)
    }
}

impl Follower for MonolithicCoupling {
    fn follow(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Option<String>> {
        let mut heat = self.heat.lock().unwrap_or_else(PoisonError::into_inner);
        heat.plastic.take(part, elements);
        part.nodes.history.write_level(Columns::of(part).unknown.column, 0, &self.start);
        let record = heat.solve_step(part, &mut Silent)?;
        heat.sweeps += 1;
        if !record.converged {
            return Ok(Some(record.failure.map_or("heat".to_owned(), |why| format!("heat: {why}"))));
        }
        heat.last = Some(record);
        Ok(None)
    }

    fn reads_elements(&self) -> bool {
        self.heat.lock().unwrap_or_else(PoisonError::into_inner).plastic.acts()
    }

    fn refer(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Vec<f64>> {
        let mut heat = self.heat.lock().unwrap_or_else(PoisonError::into_inner);
        self.referred = heat.out_of_balance(part, elements)?;
        heat.answer(part, &self.referred)
    }

    fn respond(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Vec<f64>> {
        let mut heat = self.heat.lock().unwrap_or_else(PoisonError::into_inner);
        let power = part.elements.data.level(PLASTIC_HEAT_POWER, 0).to_vec();
        let mut change = heat.out_of_balance(part, elements)?;
        part.elements.data.write_level(PLASTIC_HEAT_POWER, 0, &power);
        change.iter_mut().zip(&self.referred).for_each(|(change, referred)| *change -= referred);
        heat.answer(part, &change)
    }

    fn nudge(&self, part: &mut ModelPart, increment: &[f64]) -> f64 {
        let (largest, spread) = sizes(part, increment);
        if largest == 0.0 {
            return 0.0;
        }
        let share = NEARBY * if spread > 0.0 { spread / largest } else { 1.0 };
        let small: Vec<f64> = increment.iter().map(|d| share * d).collect();
        self.heat.lock().unwrap_or_else(PoisonError::into_inner).system.dofs.scatter_add(&small, part);
        share
    }

    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.heat.lock().unwrap_or_else(PoisonError::into_inner).strategy.assembler().dot(a, b)
    }
}
