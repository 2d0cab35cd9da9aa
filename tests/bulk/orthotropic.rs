//! Orthotropic elasticity with axes: tension at an angle to them, cylinders and spheres with axes about a line and a point.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::elastic::ring;
use super::grid::Grid;

const FREE: Value = Value::Null;

fn zero() -> Value {
    json!(0.0)
}

/// A unidirectional composite of fibres along axis 1 (MPa).
fn fibre() -> Value {
    json!({"YOUNG_MODULUS_X": 140e3, "YOUNG_MODULUS_Y": 10e3, "YOUNG_MODULUS_Z": 8e3, "POISSON_RATIO_XY": 0.3,
        "POISSON_RATIO_YZ": 0.4, "POISSON_RATIO_XZ": 0.25, "SHEAR_MODULUS_XY": 5e3, "SHEAR_MODULUS_YZ": 3e3,
        "SHEAR_MODULUS_XZ": 4e3})
}

fn keep(variables: Value, names: &[&str]) -> Value {
    names.iter().map(|name| ((*name).to_owned(), variables[*name].clone())).collect::<serde_json::Map<_, _>>().into()
}

/// Uniform tension of a block whose fibres lie at 30° to it: ε = σ/E(θ) along, γ = σ η by coupling of tension and shear, with
/// 1/E(θ) = c⁴/E_x + (1/G − 2ν/E_x) s²c² + s⁴/E_y. The state is uniform: 1e-9 of the iteration. Finite elements, at strains of 1e-6:
/// 1e-5.
#[test]
fn tension_at_an_angle_to_the_fibres() {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    let (ex, ey, nu, g, stress) = (140e3, 10e3, 0.3, 5e3, 0.01);
    let along = stress * (c.powi(4) / ex + (1.0 / g - 2.0 * nu / ex) * (s * c).powi(2) + s.powi(4) / ey);
    let both = 2.0 * nu / ex - 1.0 / g;
    let shear = stress * ((2.0 / ex + both) * s * c.powi(3) - (2.0 / ey + both) * s.powi(3) * c);
    let plane = ["YOUNG_MODULUS_X", "YOUNG_MODULUS_Y", "POISSON_RATIO_XY", "SHEAR_MODULUS_XY"];
    let cases = [
        ("SmallDisplacementElement", "LinearElasticOrthotropic2DLaw", Shape::Quad4, 1e-9),
        ("TotalLagrangianElement", "LinearElasticOrthotropic2DLaw", Shape::Tri6, 1e-5),
        ("UpdatedLagrangianElement", "LinearElasticOrthotropic2DLaw", Shape::Quad4, 1e-5),
        ("SmallDisplacementElement", "LinearElasticOrthotropic3DLaw", Shape::Hex8, 1e-9),
        ("SmallDisplacementBbarElement", "LinearElasticOrthotropic3DLaw", Shape::Hex8, 1e-9),
        ("TotalLagrangianElement", "LinearElasticOrthotropic3DLaw", Shape::Tet10, 1e-5),
    ];
    for (element, law, shape, tolerance) in cases {
        let dim = shape.dim();
        for by_angles in [false, true] {
            let grid = Grid::new(shape, &[2, 2, 2], |p| p);
            let mut constants = if dim == 2 { keep(fibre(), &plane) } else { fibre() };
            if by_angles {
                constants["EULER_ANGLES"] = json!([30.0, 0.0, 0.0]);
            }
            let mut deck = Deck::new(&grid, element, law, constants);
            deck.gauss("CAUCHY_STRESS_VECTOR");
            if !by_angles {
                let axes = if dim == 2 { json!([2.0 * c, 2.0 * s, 0.0]) } else { json!([[c, s, 0.0], [-s, c, 0.0]]) };
                let parameters = json!({"model_part_name": "Structure", "cartesian_local_axis": axes});
                deck.process("set_cartesian_local_axes_process", parameters);
            }
            // one point is held, its neighbours keep the body from turning
            deck.fix(|p| p == [0.0; 3], [zero(), zero(), if dim == 3 { zero() } else { FREE }])
                .fix(|p| p == [1.0, 0.0, 0.0], [FREE, zero(), if dim == 3 { zero() } else { FREE }]);
            if dim == 3 {
                deck.fix(|p| p == [0.0, 1.0, 0.0], [FREE, FREE, zero()]);
            }
            let (kind, load) =
                if dim == 2 { ("LineLoadCondition", "LINE_LOAD") } else { ("SurfaceLoadCondition", "SURFACE_LOAD") };
            deck.vector_load(|p| p[0] == 1.0, kind, load, [json!(stress), zero(), zero()]);
            deck.vector_load(|p| p[0] == 0.0, kind, load, [json!(-stress), zero(), zero()]);
            let ran = deck.run();
            let what = format!("{element} {law} by angles {by_angles}");
            let node = |at| grid.nodes_where(|p| p == at)[0];
            let (right, top) =
                (ran.last("DISPLACEMENT", node([1.0, 0.0, 0.0])), ran.last("DISPLACEMENT", node([0.0, 1.0, 0.0])));
            assert_close(right[0], along, tolerance, &what);
            // γ = ∂u_x/∂y, as the edge along x does not turn
            assert_close(top[0], shear, tolerance, &what);
            for (_, found) in ran.gauss("CAUCHY_STRESS_VECTOR", 0) {
                assert_close(found[0], stress, 10.0 * tolerance, &what);
            }
        }
    }
}

/// Radial displacement and stress where u = A r^m + B r^n and σ_r = c u′ + d u/r, under the inner pressure `p` (Lekhnitskii, Anisotropic
/// Plates, § 25).
fn under_pressure([m, n]: [f64; 2], c: f64, d: f64, [a, b]: [f64; 2], p: f64) -> impl Fn(f64) -> [f64; 2] {
    let stress = move |power: f64, r: f64| (c * power + d) * r.powf(power - 1.0);
    let determinant = stress(m, a) * stress(n, b) - stress(n, a) * stress(m, b);
    let (first, second) = (-p * stress(n, b) / determinant, p * stress(m, b) / determinant);
    move |r| [first * r.powf(m) + second * r.powf(n), first * stress(m, r) + second * stress(n, r)]
}

/// Error of the radial displacements at both ends of a wall, relative.
fn errors(found: [f64; 2], exact: &dyn Fn(f64) -> [f64; 2], ends: [f64; 2]) -> f64 {
    found.into_iter().zip(ends).map(|(u, r)| (u / exact(r)[0] - 1.0).abs()).fold(0.0, f64::max)
}

/// A ring in plane stress that is stiffer around than across, k = √(E_θ/E_r) = 2, under inner pressure: σ_r = A r^(k−1) + B r^(−k−1).
/// Axes are constant in an element, an error of second order in its angle: 1e-2 for 8 elements in a quarter, a quarter of it for 16.
#[test]
fn a_ring_with_stiff_hoops() {
    let (a, b, pressure) = (1.0, 2.0, 0.01);
    let (radial, hoop, nu) = (1e4, 4e4, 0.1);
    let factor = 1.0 - nu * nu * hoop / radial;
    let exact = under_pressure([2.0, -2.0], radial / factor, nu * hoop / factor, [a, b], pressure);
    let error_of = |cells: usize, update: bool| {
        let grid = Grid::new(Shape::Quad8, &[cells, cells], ring(a, b));
        let constants = json!({"YOUNG_MODULUS_X": radial, "YOUNG_MODULUS_Y": hoop, "POISSON_RATIO_XY": nu,
            "SHEAR_MODULUS_XY": 5e3, "THICKNESS": 1.0});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticOrthotropic2DLaw", constants);
        deck.process(
            "set_cylindrical_local_axes_process",
            json!({"model_part_name": "Structure", "cylindrical_generatrix_axis": [0.0, 0.0, 2.0],
                "cylindrical_generatrix_point": [0.0, 0.0, 1.0], "update_at_each_step": update}),
        );
        deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE]).fix(|p| p[1] == 1.0, [zero(), FREE, FREE]).scalar_load(
            |p| p[0] == 0.0,
            "LineLoadCondition",
            "NEGATIVE_FACE_PRESSURE",
            json!(pressure),
        );
        let ran = deck.run();
        let node = |end: f64| grid.nodes_where(|p| p == [end, 0.0, 0.0])[0];
        errors([0.0, 1.0].map(|end| ran.last("DISPLACEMENT", node(end))[0]), &exact, [a, b])
    };
    let [coarse, fine, updated] = [error_of(8, false), error_of(16, false), error_of(16, true)];
    println!("ring with stiff hoops: off by {coarse:.2e} and {fine:.2e}, with axes of present centres {updated:.2e}");
    assert!(coarse < 1e-2 && fine < 0.3 * coarse && updated < 0.3 * coarse, "{coarse:e} {fine:e} {updated:e}");
}

/// The stiffness matrix of normal stresses of [`fibre`]-like constants E_x, E_y, E_z, ν_xy, ν_yz, ν_xz.
fn normal_stiffness([x, y, z]: [f64; 3], [xy, yz, xz]: [f64; 3]) -> [[f64; 3]; 3] {
    // cofactors of the compliance
    let s = [[1.0 / x, -xy / x, -xz / x], [-xy / x, 1.0 / y, -yz / y], [-xz / x, -yz / y, 1.0 / z]];
    let minor = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (((i + 1) % 3, (i + 2) % 3), ((j + 1) % 3, (j + 2) % 3));
        s[a][c] * s[b][d] - s[a][d] * s[b][c]
    };
    let determinant: f64 = (0..3).map(|j| s[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

/// A long pipe held in its axial direction, k = √(C_θθ/C_rr): as a solid of revolution, whose axes are those of the space, 1e-4 for 10
/// cells of second order; as a quarter in space with axes about a line, 1e-2 for 8 elements in a quarter. Axes 1, 2 and 3 are the
/// radial, the axial and the hoop direction in both.
#[test]
fn a_long_pipe_with_stiff_hoops() {
    let (a, b, pressure) = (1.0, 2.0, 0.01);
    let (young, poisson) = ([8e3, 10e3, 40e3], [0.25, 0.08, 0.06]);
    let constants = json!({"YOUNG_MODULUS_X": young[0], "YOUNG_MODULUS_Y": young[1], "YOUNG_MODULUS_Z": young[2],
        "POISSON_RATIO_XY": poisson[0], "POISSON_RATIO_YZ": poisson[1], "POISSON_RATIO_XZ": poisson[2],
        "SHEAR_MODULUS_XY": 3e3, "SHEAR_MODULUS_YZ": 5e3, "SHEAR_MODULUS_XZ": 4e3});
    let c = normal_stiffness(young, poisson);
    let k = (c[2][2] / c[0][0]).sqrt();
    let exact = under_pressure([k, -k], c[0][0], c[0][2], [a, b], pressure);

    let grid = Grid::new(Shape::Quad8, &[10, 1], |p| [a + (b - a) * p[0], 0.1 * p[1], 0.0]);
    let mut section = constants.clone();
    ["SHEAR_MODULUS_YZ", "SHEAR_MODULUS_XZ"].into_iter().for_each(|name| {
        section.as_object_mut().expect("an object").remove(name);
    });
    let mut deck = Deck::new(&grid, "AxisymSmallDisplacementElement", "LinearElasticOrthotropicAxisym2DLaw", section);
    deck.fix(|_| true, [FREE, zero(), FREE]).scalar_load(
        |p| p[0] == 0.0,
        "AxisymLineLoadCondition",
        "NEGATIVE_FACE_PRESSURE",
        json!(pressure),
    );
    let ran = deck.run();
    let found = [0.0, 1.0].map(|end| ran.last("DISPLACEMENT", grid.nodes_where(|p| p[0] == end)[0])[0]);
    let of_revolution = errors(found, &exact, [a, b]);

    let grid = Grid::new(Shape::Hex20, &[4, 8, 1], |p| {
        let [x, y, _] = ring(a, b)(p);
        [x, y, 0.2 * p[2]]
    });
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticOrthotropic3DLaw", constants);
    deck.process("set_cylindrical_local_axes_process", json!({"model_part_name": "Structure"}));
    deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE])
        .fix(|p| p[1] == 1.0, [zero(), FREE, FREE])
        .fix(|_| true, [FREE, FREE, zero()])
        .scalar_load(|p| p[0] == 0.0, "SurfaceLoadCondition", "POSITIVE_FACE_PRESSURE", json!(pressure));
    let ran = deck.run();
    let node = |end: f64| grid.nodes_where(|p| p == [end, 0.0, 0.0])[0];
    let in_space = errors([0.0, 1.0].map(|end| ran.last("DISPLACEMENT", node(end))[0]), &exact, [a, b]);
    println!(
        "long pipe with stiff hoops: off by {of_revolution:.2e} as a solid of revolution, {in_space:.2e} in space"
    );
    assert!(of_revolution < 1e-4 && in_space < 1e-2, "{of_revolution:e} {in_space:e}");
}

/// A hollow sphere that is stiffer around than across, under inner pressure: u = A r^m + B r^n with m (m + 1) C_rr = 2 (C_θθ + C_θφ −
/// C_rθ), σ_r = C_rr u′ + 2 C_rθ u/r. A quarter as a solid of revolution with axes about a point: 2e-2 for 8 elements in a quarter,
/// and a quarter of it for 16. A part of an eighth in space: 1e-2 for 6 elements along an edge.
#[test]
fn a_hollow_sphere_with_stiff_layers() {
    let (a, b, pressure) = (1.0, 2.0, 0.01);
    let (radial, around, poisson) = (1e4, 4e4, [0.1, 0.2]);
    let c = normal_stiffness([radial, around, around], [poisson[0], poisson[1], poisson[0]]);
    let q = 2.0 * (c[1][1] + c[1][2] - c[0][1]) / c[0][0];
    let root = (0.25 + q).sqrt();
    let exact = under_pressure([root - 0.5, -root - 0.5], c[0][0], 2.0 * c[0][1], [a, b], pressure);
    let constants = json!({"YOUNG_MODULUS_X": radial, "YOUNG_MODULUS_Y": around, "POISSON_RATIO_XY": poisson[0],
        "POISSON_RATIO_YZ": poisson[1], "SHEAR_MODULUS_XY": 6e3});
    let axes = json!({"model_part_name": "Structure", "spherical_reference_axis": [0.0, 0.0, 1.0],
        "spherical_central_point": [0.0, 0.0, 0.0]});

    let error_of = |cells: usize| {
        let grid = Grid::new(Shape::Quad8, &[8, cells], ring(a, b));
        let law = "LinearElasticTransverselyIsotropicAxisym2DLaw";
        let mut deck = Deck::new(&grid, "AxisymSmallDisplacementElement", law, constants.clone());
        deck.process("set_spherical_local_axes_process", axes.clone());
        deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE]).fix(|p| p[1] == 1.0, [zero(), FREE, FREE]).scalar_load(
            |p| p[0] == 0.0,
            "AxisymLineLoadCondition",
            "NEGATIVE_FACE_PRESSURE",
            json!(pressure),
        );
        let ran = deck.run();
        let node = |end: f64| grid.nodes_where(|p| p == [end, 0.0, 0.0])[0];
        errors([0.0, 1.0].map(|end| ran.last("DISPLACEMENT", node(end))[0]), &exact, [a, b])
    };
    let [coarse, fine] = [error_of(8), error_of(16)];

    // the part of an eighth in a cone about the diagonal, by central projection of a square: free of the poles
    let grid = Grid::new(Shape::Hex20, &[4, 6, 6], |p| {
        let radius = a + (b - a) * p[0];
        let size = (1.0 + p[1] * p[1] + p[2] * p[2]).sqrt();
        [radius / size, radius * p[1] / size, radius * p[2] / size]
    });
    let law = "LinearElasticTransverselyIsotropic3DLaw";
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", law, constants);
    deck.process("set_spherical_local_axes_process", axes);
    // exact displacements on the sides, pressure inside, nothing outside
    let [m, n] = [root - 0.5, -root - 0.5];
    let unit = exact(1.0)[0];
    let first = (exact(2.0)[0] - unit * 2.0_f64.powf(n)) / (2.0_f64.powf(m) - 2.0_f64.powf(n));
    let second = unit - first;
    let radial = |axis: &str| {
        let r = "sqrt(X**2+Y**2+Z**2)";
        json!(format!("({first:e}*{r}**({:e})+({second:e})*{r}**({:e}))*{axis}", m - 1.0, n - 1.0))
    };
    deck.fix(|p| p[1] == 0.0 || p[2] == 0.0 || p[1] == 1.0 || p[2] == 1.0, [radial("X"), radial("Y"), radial("Z")])
        .scalar_load(|p| p[0] == 0.0, "SurfaceLoadCondition", "POSITIVE_FACE_PRESSURE", json!(pressure));
    let ran = deck.run();
    let middle = |end: f64| {
        let node = grid.nodes_where(|p| p == [end, 0.5, 0.5])[0];
        let (u, x) = (ran.last("DISPLACEMENT", node), grid.nodes[node]);
        (0..3).map(|c| u[c] * x[c]).sum::<f64>() / x.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let in_space = errors([middle(0.0), middle(1.0)], &exact, [a, b]);
    println!("hollow sphere with stiff layers: off by {coarse:.2e} and {fine:.2e}, {in_space:.2e} in space");
    assert!(coarse < 2e-2 && fine < 0.3 * coarse && in_space < 1e-2, "{coarse:e} {fine:e} {in_space:e}");
}

/// Wrong axes and constants are refused before the run.
#[test]
fn wrong_axes_are_refused() {
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let deck = |process: &str, parameters: Value, law: &str, constants: Value| {
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", law, constants);
        deck.process(process, parameters).fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        deck.problem()
    };
    let law = "LinearElasticOrthotropic3DLaw";
    let cartesian = |axes: Value| json!({"model_part_name": "Structure", "cartesian_local_axis": axes});
    let found =
        deck("set_cartesian_local_axes_process", cartesian(json!([[1.0, 0.0, 0.0], [0.1, 1.0, 0.0]])), law, fibre());
    assert!(found.contains("axes 1 and 2 are not perpendicular"), "{found}");
    let found = deck("set_cartesian_local_axes_process", cartesian(json!([[1.0, 0.0, 0.0]])), law, fibre());
    assert!(found.contains("has 1 axes") && found.contains("two axes"), "{found}");
    let middle = json!({"model_part_name": "Structure", "cylindrical_generatrix_point": [0.5, 0.5, 0.0]});
    let found = deck("set_cylindrical_local_axes_process", middle, law, fibre());
    assert!(found.contains("element 1 of Structure has no axes: its centre lies on the line"), "{found}");
    // axes of the data of elements, by another process, are seen when they are given
    let mut without = fibre();
    without["SHEAR_MODULUS_YZ"] = json!(-1.0);
    let found = deck("set_cylindrical_local_axes_process", json!({"model_part_name": "Structure"}), law, without);
    assert!(found.contains("SHEAR_MODULUS_YZ of properties 1 is -1"), "{found}");
    let mut mixed = Deck::new(&grid, "SmallDisplacementMixedVolumetricStrainElement", law, fibre());
    let found = mixed.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]).problem();
    assert!(found.contains("has no axes of the material"), "{found}");
}
