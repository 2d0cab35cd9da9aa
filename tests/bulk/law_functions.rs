//! Laws by functions of the host program beside the laws of the program (EXTERNAL: the same formulas written here).

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::{Value, json};
use zelus::user_materials::law_function::{LawFunction, Points, Response, add_function};
use zelus_core::geometry::Shape;

use super::deck::Deck;
use super::grid::Grid;
use super::user_materials::same;

/// A function of points, one after another: strain, state and parameters give stress, tangent and state.
type Pointwise = fn(&[f64], &[f64], &[f64]) -> (Vec<f64>, Vec<f64>, Vec<f64>);

/// A function, and the most points that it has got at once.
struct Counted(Pointwise, AtomicUsize);

impl LawFunction for Counted {
    fn respond(&self, points: &Points) -> Result<Response, String> {
        self.1.fetch_max(points.len(), Ordering::Relaxed);
        let mut all = Response::default();
        for at in 0..points.len() {
            let own = |values: &'_ [f64], width: usize| values[at * width..(at + 1) * width].to_vec();
            let (strain, state) = (own(&points.strain, points.components), own(&points.state, points.states));
            let (stress, tangent, state) = (self.0)(&strain, &state, &points.parameters);
            all.stress.extend(stress);
            all.tangent.extend(tangent);
            all.state.extend(state);
        }
        Ok(all)
    }
}

fn add(name: &str, of_point: Pointwise) -> Arc<Counted> {
    let function = Arc::new(Counted(of_point, AtomicUsize::new(0)));
    add_function(name, function.clone());
    function
}

fn material(name: &str, parameters: &[f64], states: usize) -> Value {
    json!({"LAW_FUNCTION": name, "LAW_PARAMETERS": parameters, "STATE_VARIABLES": vec![0.0; states]})
}

/// K 1⊗1 + 2μ of the deviator, shear doubled in strains; components normal and then shear.
fn hooke(components: usize, [bulk, shear]: [f64; 2]) -> Vec<f64> {
    let mut out = vec![0.0; components * components];
    for i in 0..components {
        out[i * components + i] = shear;
        for j in (0..3).filter(|_| i < 3) {
            out[i * components + j] = bulk - 2.0 / 3.0 * shear + if i == j { 2.0 * shear } else { 0.0 };
        }
    }
    out
}

fn moduli(parameters: &[f64]) -> [f64; 2] {
    let [young, poisson] = [parameters[0], parameters[1]];
    [young / 3.0 / (1.0 - 2.0 * poisson), young / 2.0 / (1.0 + poisson)]
}

fn product(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
}

fn elastic(strain: &[f64], _state: &[f64], parameters: &[f64]) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let matrix = hooke(strain.len(), moduli(parameters));
    (product(&matrix, strain), matrix, Vec::new())
}

/// Von Mises plasticity with linear isotropic hardening by radial return (Simo and Hughes, box 3.1 and 3.2); the state is the plastic strain,
/// shear doubled, and the equivalent one.
fn plastic(strain: &[f64], state: &[f64], parameters: &[f64]) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let [bulk, shear] = moduli(parameters);
    let (yields, hardening) = (parameters[2], parameters[3]);
    let mut matrix = hooke(6, [bulk, shear]);
    let elastic: Vec<f64> = strain.iter().zip(state).map(|(all, plastic)| all - plastic).collect();
    let mut stress = product(&matrix, &elastic);
    let mean = stress[..3].iter().sum::<f64>() / 3.0;
    let deviator: Vec<f64> = stress.iter().enumerate().map(|(c, s)| if c < 3 { s - mean } else { *s }).collect();
    let size = (0..6).map(|c| deviator[c] * deviator[c] * if c < 3 { 1.0 } else { 2.0 }).sum::<f64>().sqrt();
    let excess = size - (2.0_f64 / 3.0).sqrt() * (yields + hardening * state[6]);
    let mut state = state.to_vec();
    if excess > 0.0 {
        let step = excess / (2.0 * shear + 2.0 / 3.0 * hardening);
        let normal: Vec<f64> = deviator.iter().map(|s| s / size).collect();
        for c in 0..6 {
            stress[c] -= 2.0 * shear * step * normal[c];
            state[c] += step * normal[c] * if c < 3 { 1.0 } else { 2.0 };
        }
        state[6] += (2.0_f64 / 3.0).sqrt() * step;
        let theta = 1.0 - 2.0 * shear * step / size;
        let along = 1.0 / (1.0 + hardening / (3.0 * shear)) - (1.0 - theta);
        matrix = hooke(6, [bulk, shear * theta]);
        for i in 0..6 {
            (0..6).for_each(|j| matrix[6 * i + j] -= 2.0 * shear * along * normal[i] * normal[j]);
        }
    }
    (stress, matrix, state)
}

#[test]
fn functions_are_as_good_as_laws_of_the_program() {
    let function = add("elastic", elastic);
    let of = || [material("elastic", &[200.0, 0.3], 0), json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3})];
    let small = "SmallDisplacementElement";
    same(small, Shape::Hex8, ["FunctionLaw3D", "LinearElastic3DLaw"], of(), 1e-3);
    // Twelve elements of eight points.
    assert_eq!(function.1.load(Ordering::Relaxed), 96);
    same(small, Shape::Quad4, ["FunctionLaw2DPlaneStrain", "LinearElasticPlaneStrain2DLaw"], of(), 1e-3);
    let bbar = "SmallDisplacementBbarElement";
    same(bbar, Shape::Quad4, ["FunctionLaw2DPlaneStrain", "LinearElasticPlaneStrain2DLaw"], of(), 1e-3);
    let ring = "AxisymSmallDisplacementElement";
    same(ring, Shape::Quad8, ["FunctionLawAxisym2D", "LinearElasticAxisym2DLaw"], of(), 1e-3);
    for element in ["TotalLagrangianElement", "UpdatedLagrangianElement"] {
        same(element, Shape::Hex8, ["FunctionLaw3D", "KirchhoffSaintVenant3DLaw"], of(), 0.1);
    }
}

#[test]
fn states_of_functions_last() {
    add("plastic", plastic);
    let own = material("plastic", &[200.0, 0.3, 0.4, 20.0], 7);
    let known =
        json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3, "YIELD_STRESS": 0.4, "ISOTROPIC_HARDENING_MODULUS": 20.0});
    let laws = ["FunctionLaw3D", "SmallStrainJ2Plasticity3DLaw"];
    same("SmallDisplacementElement", Shape::Hex8, laws, [own, known], 1e-2);
}

#[test]
fn a_function_that_is_not_there_is_named() {
    let grid = Grid::new(Shape::Quad4, &[1, 1], |p| p);
    let deck = Deck::new(&grid, "SmallDisplacementElement", "FunctionLaw2DPlaneStrain", material("absent", &[], 0));
    let said = deck.problem();
    assert!(said.contains("user-material") && said.contains("absent"), "{said}");
}
