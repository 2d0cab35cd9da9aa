//! Couplings of surfaces to reference nodes with rotations: kinematic (RBE2) and distributing (RBE3).

use serde_json::{Value, json};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{add, cross, sub};

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const KINEMATIC: &str = "kinematic_coupling_process";
const DISTRIBUTING: &str = "distributing_coupling_process";
const REFERENCE: &str = "Structure.Reference";

fn zero() -> Value {
    json!(0.0)
}

/// Couples a part to a new reference node, which is the last node.
fn couple(deck: &mut Deck<'_>, process: &str, part: &str, point: Vec3, more: Value) {
    let mut settings = json!({"model_part_name": format!("Structure.{part}"), "reference_model_part_name": REFERENCE,
        "reference_point": point});
    more.as_object().into_iter().flatten().for_each(|(key, value)| settings[key] = value.clone());
    deck.process(process, settings);
    deck.output(&["ROTATION", "REACTION_MOMENT"]);
}

/// Force and moment on the reference node, which grow with t.
fn load(deck: &mut Deck<'_>, force: Vec3, moment: Vec3) {
    for (variable, value) in [("POINT_LOAD", force), ("POINT_MOMENT", moment)] {
        let value = value.map(|v| json!(format!("{v:?}*t")));
        let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "value": value});
        deck.process("assign_vector_variable_to_conditions_process", settings);
    }
}

/// Prescribes displacement or rotation of the reference node, `null` leaving a component free.
fn hold(deck: &mut Deck<'_>, variable: &str, value: [Value; 3]) {
    let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "constrained": constrained,
        "value": value, "interval": [0.0, "End"]});
    deck.process("assign_vector_variable_process", settings);
}

fn assert_vector(found: Vec3, expected: Vec3, size: f64, tolerance: f64, what: &str) {
    let off = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max) / size;
    println!("{what}: {off:.1e}");
    assert!(off < tolerance, "{what}: {found:?} instead of {expected:?}, off by {off:.2e}");
}

/// ANALYTIC: pure bending of a cantilever in plane stress by a moment on the reference node, θ = M L/EI and u_y = M L²/2EI, which
/// shapes of second order hold exactly; with Poisson's ratio the end narrows, so that it follows along x alone. Then a force F at the
/// end of an arm a beyond the beam: its moment about the end is F a.
#[test]
fn a_moment_bends_a_cantilever() {
    let (length, height, young, moment) = (10.0, 1.0, 1e6, 1.0);
    let inertia = 0.5 * height * height * height / 12.0;
    for shape in [Shape::Tri6, Shape::Quad8, Shape::Quad9] {
        for poisson in [0.0, 0.3] {
            let grid = Grid::new(shape, &[4, 2], |p| [length * p[0], height * (p[1] - 0.5), 0.0]);
            let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": poisson, "THICKNESS": 0.5});
            let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStress2DLaw", material);
            deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]).fix(|p| p[0] == 0.0 && p[1] == 0.5, [FREE, zero(), FREE]);
            let end = deck.nodes(|p| p[0] == 1.0);
            let more = json!({"components": [true, poisson == 0.0, false]});
            couple(&mut deck, KINEMATIC, &end, [length, 0.0, 0.0], more);
            if poisson > 0.0 {
                hold(&mut deck, "DISPLACEMENT", [FREE, zero(), FREE]);
            }
            load(&mut deck, [0.0; 3], [0.0, 0.0, moment]);
            let ran = deck.run();
            let (what, node) = (format!("{shape:?} {poisson}"), grid.nodes.len());
            let rotation = moment * length / (young * inertia);
            assert_close(ran.last("ROTATION", node)[2], rotation, 1e-10, &what);
            assert_close(ran.number(&format!("ROTATION_Z of {REFERENCE}"), 0), rotation, 1e-10, &what);
            let tip = grid.nodes_where(|p| p[0] == 1.0 && p[1] == 0.5)[0];
            let deflection = 0.5 * rotation * length;
            assert_close(ran.last("DISPLACEMENT", tip)[1], deflection, 1e-10, &what);
            if poisson == 0.0 {
                assert_close(ran.last("DISPLACEMENT", node)[1], deflection, 1e-10, &what);
            }
        }
    }
}

/// A force on the reference node of a linear cantilever leaves no moment there but that of round-off: one iteration is enough.
#[test]
fn a_force_without_a_moment_converges_at_once() {
    for process in [KINEMATIC, DISTRIBUTING] {
        let grid = Grid::new(Shape::Hex20, &[4, 2, 2], |p| [8.0 * p[0], p[1] - 0.5, p[2] - 0.5]);
        let material = json!({"YOUNG_MODULUS": 2.1e5, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        let end = deck.facets(|p| p[0] == 1.0, "SurfaceLoadCondition");
        couple(&mut deck, process, &end, [8.0, 0.0, 0.0], json!({}));
        load(&mut deck, [0.0, 0.0, 1.0], [0.0; 3]);
        let ran = deck.run();
        let iterations: Vec<usize> = ran.report.steps.iter().map(|step| step.iterations.len()).collect();
        assert_eq!(iterations, [1], "{process}");
    }
}

/// REGRESSION: multigrid takes at most 1.3 times the iterations of a body under a load on its face when that face is coupled to a
/// reference node, in it or beside it. 1.3 is the difference between loads.
#[test]
fn multigrid_keeps_its_iterations() {
    let iterations = |coupling: Option<(&str, Vec3)>| {
        let grid = Grid::new(Shape::Hex8, &[12, 16, 16], |p| [12.0 * p[0], 16.0 * (p[1] - 0.5), 16.0 * (p[2] - 0.5)]);
        let material = json!({"YOUNG_MODULUS": 2.1e5, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.set("linear_solver_settings", json!({"solver_type": "amgcl"}));
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        if let Some((process, point)) = coupling {
            let end = deck.facets(|p| p[0] == 1.0, "SurfaceLoadCondition");
            couple(&mut deck, process, &end, point, json!({}));
            load(&mut deck, [0.0, 256.0, 0.0], [0.0; 3]);
        } else {
            deck.vector_load(|p| p[0] == 1.0, "SurfaceLoadCondition", "SURFACE_LOAD", [zero(), json!(1.0), zero()]);
        }
        let ran = deck.run();
        let of_steps = ran.report.steps.iter().flat_map(|step| &step.iterations);
        of_steps.map(|iteration| iteration.linear_iterations).max().expect("an iteration")
    };
    let plain = iterations(None);
    let coupled = [(KINEMATIC, 12.0), (KINEMATIC, 18.0), (DISTRIBUTING, 12.0), (DISTRIBUTING, 18.0)]
        .map(|(process, x)| iterations(Some((process, [x, 0.0, 0.0]))));
    println!("{plain} iterations, {coupled:?} with couplings");
    assert!(plain > 5 && coupled.iter().all(|&number| 10 * number <= 13 * plain), "{plain}, {coupled:?}");
}

/// ANALYTIC: a bar without axial motion is twisted by u = θ x/L e_x × r, M = G J_p θ/L with the polar moment of area; trilinear shapes
/// hold that. The rotation is that of the moment, and the moment of the supports that of a prescribed rotation.
#[test]
fn a_moment_twists_a_shaft() {
    let (length, [a, b], shear, moment) = (5.0, [1.0, 1.5], 400.0, 3.0);
    let polar = a * b * (a * a + b * b) / 12.0;
    for (shape, prescribed) in [(Shape::Hex8, false), (Shape::Hex20, false), (Shape::Hex8, true)] {
        let grid = Grid::new(shape, &[3, 2, 2], |p| [length * p[0], a * (p[1] - 0.5), b * (p[2] - 0.5)]);
        let material = json!({"YOUNG_MODULUS": 2.6 * shear, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.fix(|_| true, [zero(), FREE, FREE]).fix(|p| p[0] == 0.0, [FREE, zero(), zero()]);
        let end = deck.nodes(|p| p[0] == 1.0);
        // The reference node stands beside the axis.
        let point = [length + 2.0, 0.4, -0.3];
        couple(&mut deck, KINEMATIC, &end, point, json!({"components": [false, true, true]}));
        let rotation = moment * length / (shear * polar);
        hold(&mut deck, "DISPLACEMENT", [zero(), FREE, FREE]);
        if prescribed {
            hold(&mut deck, "ROTATION", [json!(rotation), zero(), zero()]);
        } else {
            hold(&mut deck, "ROTATION", [FREE, zero(), zero()]);
            load(&mut deck, [0.0; 3], [moment, 0.0, 0.0]);
        }
        let ran = deck.run();
        let node = grid.nodes.len();
        let what = format!("{shape:?} {prescribed}");
        assert_vector(ran.last("ROTATION", node), [rotation, 0.0, 0.0], rotation, 1e-11, &what);
        let arm = [0.0, point[1], point[2]];
        let motion = cross([rotation, 0.0, 0.0], arm);
        assert_vector(ran.last("DISPLACEMENT", node), motion, rotation, 1e-11, &what);
        if prescribed {
            let reaction = ran.last("REACTION_MOMENT", node)[0];
            assert_close(reaction, moment, 1e-11, "moment of the supports");
            assert_close(ran.number(&format!("REACTION_MOMENT_X of {REFERENCE}"), 0), moment, 1e-11, "its report");
        }
    }
}

/// exp [θ]× v, by Rodrigues' formula.
fn rotated(theta: Vec3, v: Vec3) -> Vec3 {
    let t = theta.iter().map(|x| x * x).sum::<f64>().sqrt();
    let first = cross(theta, v);
    let second = cross(theta, first);
    std::array::from_fn(|c| v[c] + t.sin() / t * first[c] + (1.0 - t.cos()) / (t * t) * second[c])
}

/// ANALYTIC: a body whose face follows a prescribed rotation and is held by nothing else rotates without strain, about its reference
/// node and with it; supports bear nothing. One and two rotations of a radian and more about oblique axes.
#[test]
fn large_rotations_strain_nothing() {
    for shape in [Shape::Quad4, Shape::Tri6, Shape::Hex8, Shape::Tet10] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[2, 2, 2][..dim], |p| [2.0 * p[0], p[1] - 0.3, p[2]]);
        let law = if dim == 2 { "KirchhoffSaintVenantPlaneStrain2DLaw" } else { "KirchhoffSaintVenant3DLaw" };
        let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "TotalLagrangianElement", law, material);
        deck.steps(0.25, 1.0);
        let face = deck.nodes(|p| p[0] == 0.0);
        let point = if dim == 2 { [-1.0, 0.4, 0.0] } else { [-1.0, 0.4, 0.8] };
        couple(&mut deck, KINEMATIC, &face, point, json!({}));
        let theta = if dim == 2 { [0.0, 0.0, 2.5] } else { [1.1, -0.6, 1.4] };
        let by_time = |v: Vec3| v.map(|v| json!(format!("{v:?}*t")));
        let [way, rotation] = [by_time([0.5, -0.2, 0.0]), by_time(theta)];
        let flat = |[x, y, z]: [Value; 3], keep: bool| if dim == 2 && !keep { [x, y, FREE] } else { [x, y, z] };
        hold(&mut deck, "DISPLACEMENT", flat(way, false));
        hold(&mut deck, "ROTATION", if dim == 2 { [FREE, FREE, rotation[2].clone()] } else { rotation });
        let ran = deck.run();
        let reference = grid.nodes.len();
        for (node, &x) in grid.nodes.iter().enumerate() {
            let arm = sub(x, point);
            let expected = add(sub(rotated(theta, arm), arm), [0.5, -0.2, 0.0]);
            let found = ran.last("DISPLACEMENT", node);
            assert_vector(found, expected, 3.0, 1e-9, &format!("{shape:?} node {node}"));
        }
        assert_vector(ran.last("REACTION_MOMENT", reference), [0.0; 3], 100.0, 1e-9, "moment of the supports");
        assert_vector(ran.last("REACTION", reference), [0.0; 3], 100.0, 1e-9, "force of the supports");
    }
}

/// ANALYTIC: a slender strip bent to a quarter of a circle by a moment, θ = M L/EI = π/2, u = (2/π − 1, 2/π) L. The strip has strains
/// of h/2 · π/2L = 0.8 %, the tolerance.
#[test]
fn a_moment_bends_a_strip_to_a_quarter_circle() {
    let (length, height, young) = (20.0, 0.2, 1e6);
    let grid = Grid::new(Shape::Quad8, &[40, 1], |p| [length * p[0], height * (p[1] - 0.5), 0.0]);
    let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0, "THICKNESS": 1.0});
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", "KirchhoffSaintVenantPlaneStress2DLaw", material);
    deck.steps(0.1, 1.0).set("max_iteration", json!(30));
    deck.fix(|p| p[0] == 0.0, [zero(), zero(), FREE]);
    let end = deck.nodes(|p| p[0] == 1.0);
    couple(&mut deck, KINEMATIC, &end, [length, 0.0, 0.0], json!({}));
    let half = std::f64::consts::FRAC_PI_2;
    let moment = half * young * height * height * height / 12.0 / length;
    load(&mut deck, [0.0; 3], [0.0, 0.0, moment]);
    let ran = deck.run();
    let node = grid.nodes.len();
    let iterations: Vec<usize> = ran.report.steps.iter().map(|step| step.iterations.len()).collect();
    println!("iterations {iterations:?}");
    let u = ran.last("DISPLACEMENT", node);
    assert_close(ran.last("ROTATION", node)[2], half, 8e-3, "rotation");
    assert_close(u[0], (1.0 / half - 1.0) * length, 8e-3, "u_x");
    assert_close(u[1], 1.0 / half * length, 8e-3, "u_y");
}

fn resultants(ran: &Ran, grid: &Grid, nodes: &[usize], about: Vec3) -> [Vec3; 2] {
    nodes.iter().fold([[0.0; 3]; 2], |[force, moment], &node| {
        let r = ran.last("REACTION", node);
        [add(force, r), add(moment, cross(sub(grid.nodes[node], about), r))]
    })
}

/// ANALYTIC: force and moment on the reference node of a distributing coupling reach the supports whole, and the displacements are those
/// of `distribute_resultant_on_part_process`; for faces of all shapes, and for nodes alone.
#[test]
fn distributed_loads_are_statically_equivalent() {
    // Where nodes are eliminated, the weights of the others add to the round-off of the solve.
    distribute(false, 1e-12);
    distribute(true, 2e-11);
}

fn distribute(leads: bool, tolerance: f64) {
    let (force, moment, point) = ([3.0, -5.0, 2.0], [0.7, 11.0, -4.0], [3.0, 0.4, -2.0]);
    for shape in [Shape::Hex8, Shape::Hex20, Shape::Tet4, Shape::Tet10, Shape::Prism6, Shape::Quad4, Shape::Quad8] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[3, 2, 2][..dim], |p| {
            [2.0 * p[0], p[1] - 0.2 * p[0] * p[0], if dim == 2 { 0.0 } else { 1.5 * p[2] + 0.1 * p[0] }]
        });
        let flat =
            |v: Vec3, c: [usize; 2]| std::array::from_fn(|d| if dim == 3 || c.contains(&d) { v[d] } else { 0.0 });
        let (force, moment, point) = (flat(force, [0, 1]), flat(moment, [2, 2]), flat(point, [0, 1]));
        let (law, kind) = match dim {
            2 => ("LinearElasticPlaneStrain2DLaw", "LineLoadCondition"),
            _ => ("LinearElastic3DLaw", "SurfaceLoadCondition"),
        };
        for has_faces in [true, false] {
            let run = |is_coupled: bool| {
                let material = json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3});
                let mut deck = Deck::new(&grid, "SmallDisplacementElement", law, material);
                deck.fix(|p| p[0] == 0.0, [zero(), zero(), if dim == 3 { zero() } else { FREE }]);
                let wanted = |p: Vec3| p[0] == 1.0;
                let name = if has_faces { deck.facets(wanted, kind) } else { deck.nodes(wanted) };
                if is_coupled {
                    couple(&mut deck, DISTRIBUTING, &name, point, json!({"reference_node_leads": leads}));
                    load(&mut deck, force, moment);
                } else {
                    let settings = json!({"model_part_name": format!("Structure.{name}"), "force": force,
                        "moment": moment, "point": point});
                    deck.process("distribute_resultant_on_part_process", settings);
                }
                deck.run()
            };
            let (coupled, loaded) = (run(true), run(false));
            let what = format!("{shape:?}, {leads}, {}", if has_faces { "faces" } else { "nodes" });
            let [of_force, of_moment] = resultants(&coupled, &grid, &grid.nodes_where(|p| p[0] == 0.0), point);
            assert_vector(of_force, force.map(|f| -f), 6.0, tolerance, &format!("force, {what}"));
            assert_vector(of_moment, moment.map(|m| -m), 20.0, tolerance, &format!("moment, {what}"));
            let [found, expected] = [&coupled, &loaded].map(|ran| ran.displacements(&grid));
            let size = expected.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
            let off = found.iter().zip(&expected).flat_map(|(a, b)| sub(*a, *b)).fold(0.0_f64, |m, u| m.max(u.abs()));
            assert!(off < 10.0 * tolerance * size, "{what}: {off:e} of {size:e}");
        }
    }
}

/// ANALYTIC: the end of a cantilever in plane stress that a rotation of its reference node bends on average remains free to contract:
/// M = EI θ/L is the moment of the supports, for any Poisson's ratio, which shapes of second order hold exactly. The force of the
/// supports is zero.
#[test]
fn a_prescribed_mean_rotation_bends_a_cantilever() {
    let (length, height, young, rotation) = (10.0, 1.0, 1e6, 2e-4);
    for shape in [Shape::Tri6, Shape::Quad8, Shape::Quad9] {
        let grid = Grid::new(shape, &[4, 2], |p| [length * p[0], height * (p[1] - 0.5), 0.0]);
        let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "THICKNESS": 0.5});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStress2DLaw", material);
        deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]).fix(|p| p[0] == 0.0 && p[1] == 0.5, [FREE, zero(), FREE]);
        let end = deck.facets(|p| p[0] == 1.0, "LineCondition");
        let point = [length + 3.0, -0.7, 0.0];
        couple(&mut deck, DISTRIBUTING, &end, point, json!({"reference_node_leads": true}));
        hold(&mut deck, "ROTATION", [FREE, FREE, json!(rotation)]);
        let ran = deck.run();
        let node = grid.nodes.len();
        let moment = young * 0.5 * height * height * height / 12.0 * rotation / length;
        assert_close(ran.last("REACTION_MOMENT", node)[2], moment, 1e-10, &format!("moment, {shape:?}"));
        let tip = grid.nodes_where(|p| p[0] == 1.0 && p[1] == 0.5)[0];
        assert_close(ran.last("DISPLACEMENT", tip)[1], 0.5 * rotation * length, 1e-10, &format!("{shape:?}"));
        assert_vector(ran.last("REACTION", node), [0.0; 3], moment, 1e-10, &format!("force, {shape:?}"));
    }
}

/// ANALYTIC: the reference node of a distributing coupling has the rotation and the displacement of a part that moves rigidly, and the
/// mean of one that deforms: a uniform stretch moves it, and rotates nothing.
#[test]
fn reference_nodes_take_the_mean_motion() {
    let (theta, way, point) = ([2e-3, -1e-3, 3e-3], [0.02, 0.01, -0.03], [3.0, 0.4, -2.0]);
    for shape in [Shape::Hex8, Shape::Hex20, Shape::Tet10, Shape::Quad9, Shape::Tri3] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[3, 2, 2][..dim], |p| [2.0 * p[0], p[1], if dim == 2 { 0.0 } else { 1.5 * p[2] }]);
        let (theta, way, point) = match dim {
            2 => ([0.0, 0.0, theta[2]], [way[0], way[1], 0.0], [point[0], point[1], 0.0]),
            _ => (theta, way, point),
        };
        let (law, kind) = match dim {
            2 => ("LinearElasticPlaneStrain2DLaw", "LineCondition"),
            _ => ("LinearElastic3DLaw", "SurfaceCondition"),
        };
        let mut deck =
            Deck::new(&grid, "SmallDisplacementElement", law, json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3}));
        // A stretch by 1 % across the face about its centre does not move its mean.
        let of = |c: usize| {
            let [i, j] = [(c + 1) % 3, (c + 2) % 3];
            let axis = ["X", "Y", "Z"];
            let stretch = ["0", "0.01*(Y-0.5)", "0.01*(Z-0.75)"][c];
            json!(format!("{:?}+({:?})*{}-({:?})*{}+{stretch}", way[c], theta[i], axis[j], theta[j], axis[i]))
        };
        deck.fix(|_| true, [of(0), of(1), if dim == 3 { of(2) } else { FREE }]);
        let face = deck.facets(|p| p[0] == 1.0, kind);
        couple(&mut deck, DISTRIBUTING, &face, point, json!({}));
        let ran = deck.run();
        let node = grid.nodes.len();
        assert_vector(ran.last("ROTATION", node), theta, 3e-3, 1e-11, &format!("rotation of {shape:?}"));
        let expected = add(way, cross(theta, point));
        assert_vector(ran.last("DISPLACEMENT", node), expected, 3e-2, 1e-11, &format!("motion of {shape:?}"));
    }
}

/// ANALYTIC: a rigid face of a block pressed on the ground by a force on its reference node, through another block in contact: the block
/// between is compressed by F L/EA, without Poisson's ratio. The coupled nodes are the slaves of contact. Contact by constraints would
/// have to eliminate them twice, and says so.
#[test]
fn coupled_nodes_may_be_in_contact() {
    let (length, young, force) = (2.0, 100.0, 3.0);
    let mut grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| [p[0], p[1], length * p[2]]);
    let upper = Grid::new(Shape::Hex8, &[2, 2, 1], |p| [p[0], p[1], length + p[2]]);
    let first = grid.nodes.len();
    grid.nodes.extend(upper.nodes);
    grid.reference.extend(upper.reference.iter().map(|p| [p[0] + 10.0, p[1], p[2]]));
    grid.cells.extend(upper.cells.iter().map(|cell| cell.iter().map(|node| node + first).collect()));
    let attempt = |contact: &str| {
        let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.set("convergence_criterion", json!("contact_residual_criterion"));
        let by_constraints = contact == "mpc_contact_process";
        if by_constraints {
            deck.set("mpc_contact_settings", json!({}));
        } else {
            deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictionless"}));
        }
        deck.fix(|p| p[0] < 5.0 && p[2] == 0.0, [zero(), zero(), zero()]);
        let slave = deck.facets(|p| p[0] > 5.0 && p[2] == 0.0, "SurfaceCondition");
        let master = deck.facets(|p| p[0] < 5.0 && p[2] == 1.0, "SurfaceCondition");
        deck.process(
            contact,
            json!({"model_part_name": "Structure", "contact_type": "Frictionless",
                "contact_model_part": {"0": [format!("Structure.{slave}"), format!("Structure.{master}")]},
                "assume_master_slave": {"0": [format!("Structure.{slave}")]}}),
        );
        couple(&mut deck, KINEMATIC, &slave, [0.5, 0.5, length + 1.5], json!({}));
        hold(&mut deck, "DISPLACEMENT", [zero(), zero(), FREE]);
        hold(&mut deck, "ROTATION", [FREE, FREE, zero()]);
        load(&mut deck, [0.0, 0.0, -force], [0.0; 3]);
        deck.attempt()
    };
    let (result, ran) = attempt("alm_contact_process");
    result.expect("it converges");
    let node = grid.nodes.len();
    let expected = [0.0, 0.0, -force * length / young];
    assert_vector(ran.last("DISPLACEMENT", node), expected, expected[2].abs(), 1e-10, "motion of the face");
    assert_vector(ran.last("ROTATION", node), [0.0; 3], expected[2].abs(), 1e-10, "rotation of the face");
    let said = attempt("mpc_contact_process").0.expect_err("two constraints of one node").to_string();
    for words in ["constraint-twice", "kinematic_coupling_process on Structure.Part", "both eliminate DISPLACEMENT_Z"] {
        assert!(said.contains(words), "no {words:?} in: {said}");
    }
}

/// ANALYTIC: a block of mass m coupled to its centre as a rigid body, M = I θ̈ with I = m (a² + b²)/12, in the steps of Newmark's method:
/// θ grows by Δt ω + Δt²/4 (α₀ + α₁), ω by Δt/2 (α₀ + α₁). The matrix of mass holds rotations exactly.
#[test]
fn a_torque_spins_a_block() {
    let ([a, b, c], density, dt) = ([2.0, 1.0, 0.5], 3.0, 0.1);
    let grid = Grid::new(Shape::Hex8, &[2, 2, 1], |p| [a * p[0], b * p[1], c * p[2]]);
    let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3, "DENSITY": density});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("newmark"));
    deck.set("time_integration_method", json!("implicit")).steps(dt, 0.5);
    let all = deck.nodes(|_| true);
    couple(&mut deck, KINEMATIC, &all, [0.5 * a, 0.5 * b, 0.5 * c], json!({}));
    let moment = 0.02;
    load(&mut deck, [0.0; 3], [0.0, 0.0, moment]);
    let ran = deck.run();
    let inertia = density * a * b * c * (a * a + b * b) / 12.0;
    let [mut theta, mut omega, mut before] = [0.0; 3];
    for step in 0..5 {
        let alpha = moment * dt * (step + 1) as f64 / inertia;
        theta += dt * omega + 0.25 * dt * dt * (before + alpha);
        omega += 0.5 * dt * (before + alpha);
        before = alpha;
        assert_close(ran.vector("ROTATION", grid.nodes.len(), step)[2], theta, 1e-9, &format!("step {step}"));
    }
}

/// A reference node of the mesh, with a condition of its own, does as one that is made.
#[test]
fn reference_nodes_may_be_those_of_the_mesh() {
    let point = [3.0, 0.4, -0.2];
    let run = |of_mesh: bool| {
        let mut grid = Grid::new(Shape::Hex8, &[3, 2, 2], |p| [2.0 * p[0], p[1], p[2]]);
        if of_mesh {
            grid.nodes.push(point);
            grid.reference.push([9.0; 3]);
        }
        let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        let face = deck.nodes(|p| p[0] == 1.0);
        let (reference, more) = match of_mesh {
            true => (format!("Structure.{}", deck.nodes(|p| p[0] == 9.0)), Value::Null),
            false => (REFERENCE.to_owned(), json!(point)),
        };
        let settings = json!({"model_part_name": format!("Structure.{face}"), "reference_model_part_name": reference,
            "reference_point": more});
        deck.process(KINEMATIC, settings);
        for (variable, value) in [("POINT_LOAD", [0.3, -0.2, 0.1]), ("POINT_MOMENT", [0.1, 0.4, -0.2])] {
            let settings = json!({"model_part_name": reference, "variable_name": variable, "value": value});
            deck.process("assign_vector_variable_to_conditions_process", settings);
        }
        let ran = deck.run();
        ran.displacements(&grid).into_iter().take(36).collect::<Vec<Vec3>>()
    };
    let (found, expected) = (run(true), run(false));
    let size = expected.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    let off = found.iter().zip(&expected).flat_map(|(a, b)| sub(*a, *b)).fold(0.0_f64, |m, u| m.max(u.abs()));
    assert!(size > 1e-3 && off < 1e-12 * size, "{off:e} of {size:e}");
}

/// Couplings that cannot be are named before the run.
#[test]
fn mistakes_are_named() {
    let problem = |process: &str, change: &dyn Fn(&mut Value, &mut Deck<'_>)| {
        let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
        let mut deck = Deck::new(
            &grid,
            "SmallDisplacementElement",
            "LinearElastic3DLaw",
            json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.3}),
        );
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        let face = deck.nodes(|p| p[0] == 1.0);
        let mut settings = json!({"model_part_name": format!("Structure.{face}"),
            "reference_model_part_name": REFERENCE, "reference_point": [2.0, 0.5, 0.5]});
        change(&mut settings, &mut deck);
        deck.process(process, settings);
        deck.problem()
    };
    type Change<'c> = &'c dyn Fn(&mut Value, &mut Deck<'_>);
    let part = |deck: &mut Deck<'_>, wanted: fn(Vec3) -> bool| json!(format!("Structure.{}", deck.nodes(wanted)));
    let no_point: Change<'_> = &|own, _| own["reference_point"] = Value::Null;
    let several: Change<'_> = &|own, deck| {
        own["reference_model_part_name"] = part(deck, |p| p[1] == 0.5);
        own["reference_point"] = Value::Null;
    };
    let elsewhere: Change<'_> = &|own, deck| own["reference_model_part_name"] = part(deck, |p| p == [0.0; 3]);
    let within: Change<'_> = &|own, deck| {
        own["reference_model_part_name"] = part(deck, |p| p == [1.0; 3]);
        own["reference_point"] = Value::Null;
    };
    let no_part: Change<'_> = &|own, _| own["model_part_name"] = json!("Structure.No");
    let on_support: Change<'_> = &|own, deck| own["model_part_name"] = part(deck, |p| p[1] == 1.0);
    let twice: Change<'_> = &|own, deck| {
        let mut other = own.clone();
        (other["reference_model_part_name"], other["reference_point"]) =
            (json!("Structure.Other"), json!([3.0, 0.0, 0.0]));
        deck.process(KINEMATIC, other);
    };
    let nothing: Change<'_> = &|own, _| own["components"] = json!([false, false, false]);
    let on_line: Change<'_> = &|own, deck| own["model_part_name"] = part(deck, |p| p[0] == 1.0 && p[1] == 1.0);
    let held: Change<'_> = &|own, deck| {
        let settings = json!({"model_part_name": REFERENCE, "variable_name": "ROTATION", "value": [0.1, null, null]});
        let _ = own;
        deck.process("assign_vector_variable_process", settings);
    };
    for (process, change, wanted) in [
        (KINEMATIC, no_point, &["unknown-model-part", "Structure.Reference"][..]),
        (KINEMATIC, several, &["reference-node", "a coupling one reference node"]),
        (KINEMATIC, elsewhere, &["reference-node", "does not stand at"]),
        (KINEMATIC, within, &["reference-node", "belongs to Structure.Part"]),
        (DISTRIBUTING, no_part, &["unknown-model-part", "Structure.No"]),
        (KINEMATIC, on_support, &["constraint-on-support", "kinematic_coupling_process on Structure.Part"]),
        (KINEMATIC, twice, &["constraint-twice", "kinematic_coupling_process on Structure.Part"]),
        (KINEMATIC, nothing, &["invalid-value", "no component is coupled"]),
        (DISTRIBUTING, on_line, &["moment-without-arm", "whose rotation is unknown"]),
        (DISTRIBUTING, held, &["constraint-on-support", "distributing_coupling_process", "ROTATION_X"]),
    ] {
        let said = problem(process, change);
        wanted.iter().for_each(|words| assert!(said.contains(words), "no {words:?} in: {said}"));
    }
}
