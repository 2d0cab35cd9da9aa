//! Periodic and cyclic symmetry: sectors against whole rings, periods against closed forms, unlike meshes.

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{norm, sub};

use super::deck::{Deck, Ran};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const PROCESS: &str = "apply_periodic_condition_process";
const INNER: f64 = 1.0;
const OUTER: f64 = 2.0;

/// Rotation about z.
fn turned(x: Vec3, angle: f64) -> Vec3 {
    let (s, c) = angle.sin_cos();
    [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]]
}

/// A ring, or a sector of it whose sides are spirals: no planes of symmetry.
fn ring(shape: Shape, [along, around]: [usize; 2], sector: f64, centre: Vec3) -> Grid {
    let divisions = [along, around, 1];
    Grid::new(shape, &divisions[..shape.dim()], |p| {
        let angle = sector * p[1] + 0.4 * p[0] * p[0];
        let x = turned([INNER + (OUTER - INNER) * p[0], 0.0, 0.5 * p[2]], angle);
        [x[0] + centre[0], x[1] + centre[1], x[2] + centre[2]]
    })
}

fn deck<'g>(grid: &'g Grid, element: &str, law: &str) -> Deck<'g> {
    let law = format!("{law}{}", if grid.shape.dim() == 2 { "PlaneStrain2DLaw" } else { "3DLaw" });
    Deck::new(grid, element, &law, json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3}))
}

/// Joins the second side of a sector to the first.
fn join(deck: &mut Deck<'_>, [first, second]: [&str; 2], more: &Value) {
    let mut settings = json!({"model_part_name": "Structure", "first_model_part_name": first,
        "second_model_part_name": second, "variable_names": ["DISPLACEMENT"], "transformation_settings": more});
    if let Some(names) = settings["transformation_settings"].as_object_mut().and_then(|own| own.remove("variables")) {
        settings["variable_names"] = names;
    }
    deck.process(PROCESS, settings);
}

fn rotation(angle: f64, centre: Vec3) -> Value {
    json!({"rotation_settings": {"center": centre, "axis_of_rotation": [0.0, 0.0, 3.0], "angle_degree": angle}})
}

/// Largest difference of the nodes of a sector from those of the ring at the same places.
fn difference(sector: (&Grid, &Ran), whole: (&Grid, &Ran)) -> f64 {
    let mut most = 0.0_f64;
    for (node, &x) in sector.0.nodes.iter().enumerate() {
        let same = whole.0.nodes.iter().position(|&y| norm(sub(x, y)) < 1e-9).expect("the place in the ring");
        let off = sub(sector.1.last("DISPLACEMENT", node), whole.1.last("DISPLACEMENT", same));
        most = most.max(norm(off));
    }
    most
}

/// Motion of the outer side of a ring about its centre: a twist, a dilation, and along z.
fn drive(deck: &mut Deck<'_>, centre: Vec3, dim: usize) {
    let [x, y] = [0, 1].map(|c| format!("({}-({:?}))", ["X", "Y"][c], centre[c]));
    let of = |a: &str, b: &str, sign: f64| json!(format!("(0.02*{a}+({:?})*{b})*t", 0.03 * sign));
    let z = if dim == 3 { json!("0.01*t") } else { FREE };
    deck.fix(|p| p[0] == 1.0, [of(&x, &y, -1.0), of(&y, &x, 1.0), z]);
    let held = json!(0.0);
    deck.fix(|p| p[0] == 0.0, [held.clone(), held.clone(), if dim == 3 { held } else { FREE }]);
}

/// ANALYTIC: the sector of a ring whose outer side is twisted and widened moves as the ring does, node by node; tolerance of the solver.
/// The sides are spirals, on which tractions do work; the centre is not the origin; small and large displacements.
#[test]
fn a_sector_moves_as_the_whole_ring() {
    let centre = [3.0, -2.0, 0.7];
    for shape in [Shape::Tri3, Shape::Quad8, Shape::Hex8, Shape::Tet10, Shape::Prism6] {
        let count = 8;
        let whole = ring(shape, [2, count], TAU, centre);
        let sector = ring(shape, [2, 1], TAU / count as f64, centre);
        for element in ["SmallDisplacementElement", "TotalLagrangianElement"] {
            let law = if element.starts_with("Total") { "KirchhoffSaintVenant" } else { "LinearElastic" };
            let run = |grid: &Grid, is_sector: bool| {
                let mut deck = deck(grid, element, law);
                drive(&mut deck, centre, shape.dim());
                if is_sector {
                    let sides = [deck.nodes(|p| p[1] == 0.0), deck.nodes(|p| p[1] == 1.0)];
                    join(&mut deck, [&sides[0], &sides[1]], &rotation(360.0 / count as f64, centre));
                }
                deck.run()
            };
            // Cells of the ring meet themselves.
            let closed = closed(&whole);
            let (of_sector, of_whole) = (run(&sector, true), run(&closed, false));
            let off = difference((&sector, &of_sector), (&closed, &of_whole));
            println!("{shape:?} {element}: {off:.1e}");
            assert!(off < 1e-10, "{shape:?} {element}: {off:.2e}");
        }
    }
}

/// A sector and its copies all around.
fn turned_copies(sector: &Grid, count: usize, centre: Vec3) -> Grid {
    let size = sector.nodes.len();
    let copy = |at: usize| {
        let image = move |x: &Vec3| {
            let r = turned(sub(*x, centre), TAU * at as f64 / count as f64);
            [0, 1, 2].map(|c| r[c] + centre[c])
        };
        sector.nodes.iter().map(image)
    };
    let cells = |at: usize| sector.cells.iter().map(move |cell| cell.iter().map(|&node| node + at * size).collect());
    closed(&Grid {
        shape: sector.shape,
        nodes: (0..count).flat_map(copy).collect(),
        reference: (0..count).flat_map(|_| sector.reference.clone()).collect(),
        cells: (0..count).flat_map(cells).collect(),
    })
}

/// The same cells with nodes at one place merged.
fn closed(grid: &Grid) -> Grid {
    let mut nodes: Vec<Vec3> = Vec::new();
    let mut reference = Vec::new();
    let mut new = Vec::new();
    for (&x, &r) in grid.nodes.iter().zip(&grid.reference) {
        let at = nodes.iter().position(|&y| norm(sub(x, y)) < 1e-9).unwrap_or_else(|| {
            nodes.push(x);
            reference.push(r);
            nodes.len() - 1
        });
        new.push(at);
    }
    let cells = grid.cells.iter().map(|cell| cell.iter().map(|&node| new[node]).collect()).collect();
    Grid { shape: grid.shape, nodes, reference, cells }
}

/// ANALYTIC: torsion of a ring between its held inner side and its turned outer side, u_θ = A r (1/a² − 1/r²), on a sector of triangles
/// with different numbers of cells on its two sides; the tolerance is the order of the mesh.
#[test]
fn unlike_sides_interpolate() {
    let angle = PI / 3.0;
    for backwards in [false, true] {
        let mut off = Vec::new();
        for refined in [1, 2] {
            let grid = unlike(refined, angle);
            let mut deck = deck(&grid, "SmallDisplacementElement", "LinearElastic");
            deck.fix(|p| p[0] == 0.0, [json!(0.0), json!(0.0), FREE]);
            deck.fix(|p| p[0] == 1.0, [json!("-0.01*Y"), json!("0.01*X"), FREE]);
            let sides = [0.0, 1.0].map(|at| deck.facets(|p| p[1] == at, "LineLoadCondition"));
            let [first, second] = if backwards { [1, 0] } else { [0, 1] };
            let sign = if backwards { -60.0 } else { 60.0 };
            join(&mut deck, [&sides[first], &sides[second]], &rotation(sign, [0.0; 3]));
            let ran = deck.run();
            let factor = 0.01 / (1.0 / (INNER * INNER) - 1.0 / (OUTER * OUTER));
            let exact = |x: Vec3| {
                let r = x[0].hypot(x[1]);
                let share = factor * (1.0 / (INNER * INNER) - 1.0 / (r * r));
                [-share * x[1], share * x[0], 0.0]
            };
            off.push(grid.l2_error(&ran.displacements(&grid), exact) / 0.02);
        }
        println!("{backwards}: {off:?}");
        assert!(off[0] < 0.02 && off[1] < 0.3 * off[0], "{off:?}");
    }
}

/// A sector of triangles with four cells on its first side and three on the second.
fn unlike(refined: usize, angle: f64) -> Grid {
    let polar = |p: Vec3| turned([INNER + (OUTER - INNER) * p[0], 0.0, 0.0], angle * p[1]);
    let count = |row: usize| if 2 * row < 4 * refined { 4 * refined } else { 3 * refined };
    let rows = 4 * refined;
    let mut grid = Grid { shape: Shape::Tri3, nodes: Vec::new(), reference: Vec::new(), cells: Vec::new() };
    let mut first_of = Vec::new();
    for row in 0..=rows {
        first_of.push(grid.nodes.len());
        for at in 0..=count(row) {
            let p = [at as f64 / count(row) as f64, row as f64 / rows as f64, 0.0];
            grid.reference.push(p);
            grid.nodes.push(polar(p));
        }
    }
    for row in 0..rows {
        let [below, above] = [row, row + 1].map(|row| (first_of[row], count(row)));
        let (mut i, mut j) = (0, 0);
        while i < below.1 || j < above.1 {
            let next_below = j == above.1 || (i < below.1 && (i + 1) * above.1 <= (j + 1) * below.1);
            let (a, b) = (below.0 + i, above.0 + j);
            grid.cells.push(if next_below { vec![a, a + 1, b] } else { vec![a, b + 1, b] });
            if next_below { i += 1 } else { j += 1 }
        }
    }
    grid
}

/// ANALYTIC: the corner of a square turned by quarters about its centre is a node of both sides and stays; a uniform dilation of the
/// outer sides goes through the whole, and a twist of a whole square is that of its quarter.
#[test]
fn nodes_on_the_axis_move_along_it_alone() {
    for shape in [Shape::Tri6, Shape::Quad4, Shape::Hex20] {
        let dim = shape.dim();
        let quarter = Grid::new(shape, &[3, 3, 1][..dim], |p| [p[0] + 1.0, p[1] - 1.0, p[2]]);
        let whole = turned_copies(&quarter, 4, [1.0, -1.0, 0.0]);
        let motion =
            |x: &str, y: &str, by: f64| json!(format!("0.01*({x})*(1+({x})*({x}))+({by:?})*({y})*({y})*({y})"));
        let value = |dim: usize| {
            let (x, y) = ("X-1.0", "Y+1.0");
            let z = if dim == 3 { json!("0.02*Z") } else { FREE };
            [motion(x, y, -0.02), motion(y, x, 0.02), z]
        };
        let mut of_quarter = deck(&quarter, "SmallDisplacementElement", "LinearElastic");
        of_quarter.fix(|p| p[0] == 1.0 || p[1] == 1.0, value(dim));
        let sides = [of_quarter.nodes(|p| p[1] == 0.0), of_quarter.nodes(|p| p[0] == 0.0)];
        join(&mut of_quarter, [&sides[0], &sides[1]], &rotation(90.0, [1.0, -1.0, 0.0]));
        let mut of_whole = deck(&whole, "SmallDisplacementElement", "LinearElastic");
        of_whole.fix(|p| p[0] == 1.0 || p[1] == 1.0, value(dim));
        let (of_quarter, of_whole) = (of_quarter.run(), of_whole.run());
        let off = difference((&quarter, &of_quarter), (&whole, &of_whole));
        println!("{shape:?}: {off:.1e}");
        assert!(off < 1e-10, "{shape:?}: {off:.2e}");
    }
}

/// ANALYTIC: a cell periodic in all directions around a load moves as the middle cell of many: here the load is a stripe of body force
/// whose mean is zero, a sawtooth, constant along y (and z). Edges and corners follow by two and three processes.
#[test]
fn cells_are_periodic_in_all_directions() {
    for shape in [Shape::Quad4, Shape::Tri6, Shape::Hex8] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[4, 2, 2][..dim], |p| [p[0], p[1], p[2]]);
        let mut deck = deck(&grid, "SmallDisplacementElement", "LinearElastic");
        let held = |p: Vec3| p == [0.0; 3];
        deck.fix(held, [json!(0.0), json!(0.0), if dim == 3 { json!(0.0) } else { FREE }]);
        // Two planes of nodes, one displaced against the other along x.
        deck.fix(|p| p[0] == 0.0 || p[0] == 1.0, [json!(0.0), FREE, FREE]);
        deck.fix(|p| p[0] == 0.5, [json!(0.01), FREE, FREE]);
        for axis in 0..dim {
            let sides = [0.0, 1.0].map(|at| deck.nodes(|p| p[axis] == at));
            let mut direction = [0.0; 3];
            direction[axis] = 2.0;
            join(
                &mut deck,
                [&sides[0], &sides[1]],
                &json!({"translation_settings": {"dir_of_translation": direction, "magnitude": 0.5}}),
            );
        }
        let ran = deck.run();
        // Strains along y and z are zero by periodicity: u is a roof.
        for (node, p) in grid.reference.iter().enumerate() {
            let roof = 0.02 * (0.5 - (p[0] - 0.5).abs());
            let off = norm(sub(ran.last("DISPLACEMENT", node), [roof, 0.0, 0.0]));
            assert!(off < 1e-13, "{shape:?} {p:?}: {off:.1e}");
        }
    }
}

/// Faults of a deck are told before the run, with their remedy.
#[test]
fn faults_of_sectors_are_named() {
    let grid = ring(Shape::Quad4, [2, 1], TAU / 8.0, [0.0; 3]);
    let problem = |[a, b]: [f64; 2], more: &Value| {
        let mut deck = deck(&grid, "SmallDisplacementElement", "LinearElastic");
        drive(&mut deck, [0.0; 3], 2);
        let sides = [deck.nodes(|p| p[1] == a), deck.nodes(|p| p[1] == b)];
        join(&mut deck, [&sides[0], &sides[1]], more);
        deck.problem()
    };
    let sides = [0.0, 1.0];
    let cases = [
        (problem(sides, &rotation(50.0, [0.0; 3])), ["cyclic-angle", "7 sectors have 51.428571428571 degrees"]),
        (problem(sides, &rotation(-45.0, [0.0; 3])), ["no-image", "its sign, too"]),
        (problem(sides, &json!({})), ["no-transformation", "angle of a sector"]),
        (problem([0.0, 0.0], &rotation(45.0, [0.0; 3])), ["listed-twice", "lie on the axis"]),
        (
            problem(sides, &json!({"translation_settings": {"magnitude": 1.0}})),
            ["invalid-direction", "from the first part to the second"],
        ),
        (
            problem(sides, &json!({"rotation_settings": {"angle_degree": 45.0}, "variables": ["DISPLACEMENT_X"]})),
            ["invalid-value", "name the whole vector DISPLACEMENT"],
        ),
        (
            problem(sides, &json!({"rotation_settings": {"angle_degree": 45.0}, "variables": ["TEMPERATURE"]})),
            ["not-an-unknown", "TEMPERATURE"],
        ),
    ];
    for (found, expected) in cases {
        assert!(expected.iter().all(|part| found.contains(part)), "{expected:?} in {found}");
    }
}
