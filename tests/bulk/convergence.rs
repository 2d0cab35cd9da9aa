//! Rates of convergence by a manufactured solution: u = a Π sin(π x_i) on the unit square or cube, zero on its boundary.
//!
//! The body force −div σ(u) is given at the nodes as VOLUME_ACCELERATION under DENSITY 1. L2 errors fall with the second
//! power of the cell size for shapes of first order, with the third for those of second order.

use std::f64::consts::PI;

use serde_json::json;
use zelus_core::geometry::Shape;

use super::deck::Deck;
use super::grid::{Grid, Vec3};

const YOUNG: f64 = 1.0;
const NU: f64 = 0.3;

/// Amplitudes of the components.
const AMPLITUDE: Vec3 = [1.0, -0.7, 0.5];

fn exact(dim: usize) -> impl Fn(Vec3) -> Vec3 {
    move |x| {
        let product: f64 = x[..dim].iter().map(|x| (PI * x).sin()).product();
        std::array::from_fn(|a| if a < dim { AMPLITUDE[a] * product } else { 0.0 })
    }
}

/// f_i = dim μ π² a_i Π sin − (λ + μ) Σ_j a_j ∂_i ∂_j Π sin, as text.
fn body_force(dim: usize) -> Vec<String> {
    let (lambda, mu) = (YOUNG * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 0.5 * YOUNG / (1.0 + NU));
    let axes = ["x", "y", "z"];
    let derivative = |i: usize, j: usize| {
        let factor = |k: usize| match i != j && (k == i || k == j) {
            true => format!("cos(pi*{})", axes[k]),
            false => format!("sin(pi*{})", axes[k]),
        };
        let sign = if i == j { -1.0 } else { 1.0 };
        (sign * PI * PI, (0..dim).map(factor).collect::<Vec<_>>().join("*"))
    };
    let component = |i: usize| {
        let mut terms = vec![format!("({})*{}", dim as f64 * mu * PI * PI * AMPLITUDE[i], derivative(i, i).1)];
        for (j, amplitude) in AMPLITUDE.iter().enumerate().take(dim) {
            let (factor, text) = derivative(i, j);
            terms.push(format!("({})*{text}", -(lambda + mu) * amplitude * factor));
        }
        terms.join(" + ")
    };
    (0..dim).map(component).collect()
}

fn error(element: &str, shape: Shape, cells: usize) -> f64 {
    let dim = shape.dim();
    let divisions = vec![cells; dim];
    // inner nodes are displaced by a smooth map that keeps the boundary
    let grid = Grid::new(shape, &divisions, |p| {
        let bump: f64 = 0.05 * p[..dim].iter().map(|x| (2.0 * PI * x).sin()).product::<f64>();
        std::array::from_fn(|a| if a < dim { p[a] + bump } else { 0.0 })
    });
    let law = if dim == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": NU, "DENSITY": 1.0});
    let mut deck = Deck::new(&grid, element, law, material);
    deck.set("analysis_type", json!("linear"));
    let force = body_force(dim);
    let value = std::array::from_fn(|a| force.get(a).map_or(json!(0.0), |text| json!(text)));
    let on_boundary = |p: Vec3| p[..dim].iter().any(|x| *x < 1e-9 || *x > 1.0 - 1e-9);
    deck.nodal("VOLUME_ACCELERATION", value).fix(on_boundary, [json!(0.0), json!(0.0), json!(0.0)]);
    grid.l2_error(&deck.run().displacements(&grid), exact(dim))
}

/// Slopes between two meshes; 0.15 below the theoretical one is allowed, the meshes being coarse.
fn check(shape: Shape, cells: [usize; 2], order: f64) {
    check_of("SmallDisplacementElement", shape, cells, order);
}

fn check_of(element: &str, shape: Shape, cells: [usize; 2], order: f64) {
    let [coarse, fine] = cells.map(|cells| error(element, shape, cells));
    let slope = (coarse / fine).ln() / (cells[1] as f64 / cells[0] as f64).ln();
    println!("{element} {shape:?} {cells:?}: {coarse:.3e} {fine:.3e} slope {slope:.3}");
    assert!(slope > order - 0.15, "{element} {shape:?}: the error falls with the power {slope:.3}, not {order}");
}

#[test]
fn first_order_in_the_plane() {
    check(Shape::Tri3, [32, 64], 2.0);
    check(Shape::Quad4, [16, 32], 2.0);
}

#[test]
fn second_order_in_the_plane() {
    check(Shape::Tri6, [8, 16], 3.0);
    check(Shape::Quad8, [8, 16], 3.0);
    check(Shape::Quad9, [8, 16], 3.0);
}

#[test]
fn first_order_in_space() {
    check(Shape::Tet4, [14, 24], 2.0);
    check(Shape::Pyramid5, [10, 16], 2.0);
    check(Shape::Prism6, [12, 20], 2.0);
    check(Shape::Hex8, [8, 16], 2.0);
}

#[test]
fn second_order_in_space() {
    check(Shape::Tet10, [6, 10], 3.0);
    check(Shape::Pyramid13, [4, 8], 3.0);
    check(Shape::Prism15, [5, 9], 3.0);
    check(Shape::Prism18, [5, 8], 3.0);
    check(Shape::Hex20, [4, 7], 3.0);
    check(Shape::Hex27, [4, 7], 3.0);
}

/// With the volumetric strain at the nodes as good as without, the body force being part of the stabilisation.
#[test]
fn mixed_elements() {
    let check = |shape, cells| check_of("SmallDisplacementMixedVolumetricStrainElement", shape, cells, 2.0);
    check(Shape::Tri3, [32, 64]);
    check(Shape::Quad4, [16, 32]);
    check(Shape::Tet4, [10, 16]);
    check(Shape::Hex8, [12, 18]);
}
