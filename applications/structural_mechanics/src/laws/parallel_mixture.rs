//! Layers that strain alike: S = Σ f_i S_i(E), the factors f_i scaled to add up to one.
//!
//! Each layer is a law with properties of its own (`sub_properties` of the material) and its own history. LAYER_EULER_ANGLES, three
//! angles a layer, turn the axes of each layer against those of the element, as EULER_ANGLES do ([`super::material_axes`]).

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::register;

use super::law::{ConstitutiveLaw, LawEntry, LawFactory, MakesLaw, Matrix, StrainState, StressMeasure, law_of};
use super::material_axes;
use crate::tensor::Tensor;

/// Key beside the name of the law: one share for each layer.
const FACTORS: &str = "combination_factors";

/// Sum of laws, weighted.
pub struct ParallelMixture<const S: usize> {
    layers: Vec<(f64, Box<dyn ConstitutiveLaw<S>>)>,
    /// Axes of each layer in those of the element; empty where they are the same.
    axes: Vec<Tensor>,
}

impl<const S: usize> ParallelMixture<S> {
    fn boxed(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>>
    where
        LawFactory: MakesLaw<S>,
    {
        let problem = |fact: String, remedy: &str| {
            Diagnostic::error("mixture", fact).at(properties.place.clone()).remedy(remedy.to_owned())
        };
        let factors = properties.law_lists.get(FACTORS).map_or(&[][..], Vec::as_slice);
        let (count, layers) = (factors.len(), properties.parts.len());
        if count == 0 || count != layers {
            let fact = format!("the mixture of properties {} has {count} {FACTORS} and {layers} layers", properties.id);
            let remedy = "give one of \"combination_factors\" beside the law's name for each of \"sub_properties\" beside \"Material\"";
            return Err(problem(fact, remedy).into());
        }
        let sum: f64 = factors.iter().sum();
        if factors.iter().any(|f| f.is_nan() || *f < 0.0) || sum <= 0.0 {
            let fact = format!("{FACTORS} of properties {} are {factors:?}", properties.id);
            return Err(problem(fact, "give shares from 0, one of them positive").into());
        }
        let made =
            factors.iter().zip(&properties.parts).map(|(factor, layer)| Ok((factor / sum, law_of(layer, S == 3)?)));
        let layers = made.collect::<Result<Vec<(f64, Box<dyn ConstitutiveLaw<S>>)>>>()?;
        if layers.iter().any(|(_, law)| law.bulk_of_element().is_some()) {
            let fact = format!("a layer of properties {} leaves the volume to the element", properties.id);
            return Err(problem(fact, "use HyperElastic3DLaw").into());
        }
        let has_axes = layers.iter().any(|(_, law)| law.has_axes());
        let axes = if has_axes { material_axes::of_layers(properties, layers.len(), S < 6)? } else { Vec::new() };
        Ok(Box::new(Self { layers, axes }))
    }

    /// Each layer with its factor and its part of the history.
    fn each<'a>(
        &'a self,
        state: &StrainState<'a, S>,
    ) -> impl Iterator<Item = (f64, &'a dyn ConstitutiveLaw<S>, StrainState<'a, S>)> {
        let (state, mut rest) = (*state, state.history);
        self.layers.iter().enumerate().map(move |(at, (factor, law))| {
            let (own, others) = rest.split_at(law.history());
            rest = others;
            let turned = self.axes.get(at).map(|turn| state.axes.map_or(*turn, |axes| turn * axes));
            (*factor, law.as_ref(), StrainState { history: own, axes: turned.or(state.axes), ..state })
        })
    }

    fn sum(
        &self,
        state: &StrainState<'_, S>,
        mut tangent: Option<&mut Matrix<S>>,
        of_layer: impl Fn(&dyn ConstitutiveLaw<S>, &StrainState<'_, S>, Option<&mut Matrix<S>>) -> [f64; S],
    ) -> [f64; S] {
        let mut stress = [0.0; S];
        if let Some(tangent) = tangent.as_deref_mut() {
            *tangent = [[0.0; S]; S];
        }
        for (factor, law, state) in self.each(state) {
            let mut d = [[0.0; S]; S];
            let own = of_layer(law, &state, tangent.is_some().then_some(&mut d));
            stress.iter_mut().zip(own).for_each(|(sum, s)| *sum += factor * s);
            if let Some(tangent) = tangent.as_deref_mut() {
                let entries = tangent.as_flattened_mut().iter_mut().zip(d.as_flattened());
                entries.for_each(|(sum, d)| *sum += factor * d);
            }
        }
        stress
    }
}

impl<const S: usize> ConstitutiveLaw<S> for ParallelMixture<S> {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        self.sum(state, tangent, |law, state, tangent| law.pk2(state, tangent))
    }

    fn stress(&self, state: &StrainState<'_, S>, measure: StressMeasure, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        self.sum(state, tangent, |law, state, tangent| law.stress(state, measure, tangent))
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        self.each(state).map(|(factor, law, state)| factor * law.energy(&state)).sum()
    }

    fn is_linear(&self) -> bool {
        self.layers.iter().all(|(_, law)| law.is_linear())
    }

    fn expands(&self) -> bool {
        self.layers.iter().any(|(_, law)| law.expands())
    }

    fn reads_point(&self) -> bool {
        self.layers.iter().any(|(_, law)| law.reads_point())
    }

    fn depends_on_time(&self) -> bool {
        self.layers.iter().any(|(_, law)| law.depends_on_time())
    }

    fn has_axes(&self) -> bool {
        self.layers.iter().any(|(_, law)| law.has_axes())
    }

    fn softens(&self) -> bool {
        self.layers.iter().any(|(_, law)| law.softens())
    }

    fn widest_band(&self) -> f64 {
        self.layers.iter().map(|(_, law)| law.widest_band()).fold(f64::INFINITY, f64::min)
    }

    fn is_symmetric(&self, small: bool) -> bool {
        self.layers.iter().all(|(_, law)| law.is_symmetric(small))
    }

    fn history(&self) -> usize {
        self.layers.iter().map(|(_, law)| law.history()).sum()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let mut rest = history;
        for (_, law, state) in self.each(state) {
            let (own, others) = rest.split_at_mut(law.history());
            law.advance(&state, own);
            rest = others;
        }
    }

    /// The weighted sum over the layers that know the variable.
    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        let mut sum: Option<Vec<f64>> = None;
        for (factor, law, state) in self.each(state) {
            let mut own = Vec::new();
            if law.internal(&state, variable, &mut own) {
                let sum = sum.get_or_insert_with(|| vec![0.0; own.len()]);
                sum.iter_mut().zip(own).for_each(|(sum, value)| *sum += factor * value);
            }
        }
        let known = sum.is_some();
        out.extend(sum.unwrap_or_default());
        known
    }

    fn ignores_measure(&self, small: bool) -> bool {
        self.layers.iter().all(|(_, law)| law.ignores_measure(small))
    }

    fn almansi(&self, state: &StrainState<'_, S>) -> [f64; S] {
        self.layers.first().map_or(state.strain, |(_, law)| law.almansi(state))
    }
}

register! { LawEntry "ParallelRuleOfMixturesLaw3D",
    about: "Layers of a solid that strain alike: combination_factors beside the name, a law for each of sub_properties",
    source: "S = Σ f_i S_i(E) / Σ f_i",
    build: LawFactory::Space(ParallelMixture::<6>::boxed),
}

register! { LawEntry "ParallelRuleOfMixturesLaw2D",
    about: "Layers of a planar body that strain alike: combination_factors beside the name, a law for each of sub_properties",
    source: "S = Σ f_i S_i(E) / Σ f_i",
    build: LawFactory::PlaneStress(ParallelMixture::<3>::boxed),
}
