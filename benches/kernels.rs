//! Times of the kernels of runs, on one thread, beside the limits of the machine: `cargo bench --bench kernels`.
//!
//! Bounds are measured on the spot: bytes over the rate at which memory is read, operations over the rate of additions and
//! multiplications. A harness of its own, because the bound of each line is the point of it.

#[path = "../linear_algebra/tests/samples/mod.rs"]
mod samples;
#[allow(dead_code, reason = "a benchmark takes its part")]
#[path = "../tests/support/specimen.rs"]
mod specimen;

use std::hint::black_box;
use std::time::Instant;

use specimen::{Loads, Random, Specimen, cell};
use zelus as _;
use zelus_contact_structural_mechanics::mortar::{
    Choices, EXACT_MOTION, LANES, Operators, PairGeometry, PairPoints, SegmentationSettings, find_operators, operators,
};
use zelus_core::entities::find_kind;
use zelus_core::geometry::{
    FacetShape, QUADRILATERAL_4, QUADRILATERAL_8, QUADRILATERAL_9, Shape, TRIANGLE_3, TRIANGLE_6, reversed,
};
use zelus_core::model::EntityRole;
use zelus_linear_algebra::{Engine, MultigridSettings, Symmetry, System, create};

/// Cells along an edge of the box whose matrix is multiplied: 47,000 equations, whose entries no cache holds.
const CELLS: usize = 24;
/// Numbers of the arrays that are read for the rate of memory.
const NUMBERS: usize = 1 << 25;
/// Seconds that a measurement takes at least.
const LONG: f64 = 0.3;
/// Bytes of an entry of a sparse matrix: value and column.
const ENTRY: f64 = 12.0;
/// The same in blocks of 3 × 3 in single precision, and how much of them all levels have.
const BLOCK_ENTRY: f64 = (9.0 * 4.0 + 4.0) / 9.0;
const LEVELS: f64 = 1.2;
/// Products with the first level in a cycle.
const PRODUCTS: f64 = 4.0;

/// Seconds of one call, the shortest of many.
fn seconds(mut work: impl FnMut()) -> f64 {
    let (begin, mut best) = (Instant::now(), f64::INFINITY);
    while begin.elapsed().as_secs_f64() < LONG {
        let start = Instant::now();
        work();
        best = best.min(start.elapsed().as_secs_f64());
    }
    best
}

/// Bytes a second.
fn rate_of_memory() -> f64 {
    let numbers = vec![1.0_f64; NUMBERS];
    let read = seconds(|| {
        let mut sums = [0.0; 16];
        for block in numbers.chunks_exact(16) {
            sums.iter_mut().zip(block).for_each(|(sum, v)| *sum += v);
        }
        black_box(sums);
    });
    8.0 * NUMBERS as f64 / read
}

/// Additions and multiplications a second.
fn rate_of_operations() -> f64 {
    const TIMES: usize = 100_000;
    let once = seconds(|| {
        let mut x = black_box([1.0_f64; 16]);
        for _ in 0..TIMES {
            x.iter_mut().for_each(|x| *x = *x * 0.999_999 + 1e-6);
        }
        black_box(x);
    });
    2.0 * 16.0 * TIMES as f64 / once
}

fn line(kernel: &str, unit: &str, measured: f64, bound: f64) {
    println!("| {kernel} | {unit} | {measured:.3e} | {bound:.3e} | {:.2} |", bound / measured);
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("a pool");
    let (memory, operations) = (rate_of_memory(), rate_of_operations());
    println!("Memory is read at {:.1} GB/s; {:.1} billion operations a second.\n", memory / 1e9, operations / 1e9);
    println!("| kernel | of | seconds | bound | share |\n|---|---|---:|---:|---:|");

    let (matrix, layout) = samples::clamped_box(CELLS);
    let x: Vec<f64> = (0..matrix.rows).map(|i| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5).collect();
    let mut y = vec![0.0; matrix.rows];
    let entries = matrix.entries() as f64;
    let product = seconds(|| matrix.mul_vec(black_box(&x), &mut y));
    line("product", "entry", product / entries, ENTRY / memory);

    let system = System::bulk(&layout, &matrix, Symmetry::PositiveDefinite);
    let settings = MultigridSettings { least: [0; 2], ..MultigridSettings::default() };
    let mut solver = create(Engine::Multigrid(settings));
    let report = solver.solve(&system, &x, &mut y).expect("solved");
    let bytes = ENTRY + PRODUCTS * LEVELS * BLOCK_ENTRY;
    line("iteration of multigrid", "entry", report.seconds_solve / report.iterations as f64 / entries, bytes / memory);
    line("levels of multigrid", "entry", report.seconds_numeric / entries, bytes / memory);

    // Of each of 8 points: D B and Bᵀ (D B) above the diagonal, each an addition and a multiplication.
    let count = 8.0 * 2.0 * (6.0 * 6.0 * 24.0 + 6.0 * 300.0);
    let elements =
        [("SmallDisplacementElement3D8N", "LinearElastic3DLaw"), ("TotalLagrangianElement3D8N", "HyperElastic3DLaw")];
    for (name, law) in elements {
        let kind = find_kind(EntityRole::Element, name).expect("registered");
        let shape = Shape::of(3, 8).expect("a hexahedron");
        let places = cell(shape, 3, 0.05, &mut Random(1));
        let nodes: Vec<u32> = (0..8).collect();
        let specimen = Specimen::new(kind, Some(law), &places, &nodes, Loads::Vectors).expect("an element");
        let tangent = seconds(|| {
            (0..100).for_each(|_| {
                black_box(specimen.system());
            });
        });
        line(&format!("tangent of {name}"), "element", tangent / 100.0, count / operations);
    }
    pairs();
}

/// A pair of triangles or quadrilaterals that overlap in part and are bent a little where they can be.
fn pair(slave_shape: &'static FacetShape, master_shape: &'static FacetShape) -> PairGeometry<f64> {
    let place = |x: f64, y: f64| [x, y, 0.05 * (x * x + 0.5 * y * y)];
    let slave = slave_shape.nodal(|n| {
        let [x, y] = slave_shape.corner(n);
        place(x, y)
    });
    let mirrored = reversed(master_shape.shape, &std::array::from_fn::<u32, 9, _>(|n| n as u32)[..master_shape.nodes]);
    let master = master_shape.nodal(|n| {
        let [x, y] = master_shape.corner(mirrored[n] as usize);
        place(x + 0.31, y + 0.17)
    });
    let normal = |shape: &FacetShape, nodes: &[[f64; 3]]| shape.unit_normal(nodes, shape.centre);
    PairGeometry {
        slave_shape,
        master_shape,
        slave,
        master,
        nodal_normals: slave_shape.nodal(|n| slave_shape.unit_normal(&slave, slave_shape.corner(n))),
        slave_normal: normal(slave_shape, &slave),
        master_normal: normal(master_shape, &master),
        choices: Choices::default(),
        exact: None,
    }
}

/// Times D and M of pairs of facets, plain and with their derivatives by all displacements.
fn pairs() {
    println!("\n| pair | D and M, s | with derivatives, s | by that of Tri3 |\n|---|---:|---:|---:|");
    let settings = SegmentationSettings::default();
    let mut first = None;
    for shape in [&TRIANGLE_3, &TRIANGLE_6, &QUADRILATERAL_4, &QUADRILATERAL_8, &QUADRILATERAL_9] {
        let pair = pair(shape, shape);
        assert!(operators(&pair, &settings).cells().is_some(), "the facets overlap");
        let plain = seconds(|| {
            black_box(operators(black_box(&pair), &settings));
        });
        let mut out = Operators::zero(shape, shape);
        let derivatives = seconds(|| {
            let points = PairPoints::new(black_box(&pair), &settings);
            for first in (0..pair.unknowns()).step_by(LANES) {
                out.clear();
                let found = find_operators(&pair.seeded_from(first), &settings, &points, &EXACT_MOTION, &mut out);
                black_box(found.cells());
            }
        });
        let one = *first.get_or_insert(derivatives);
        println!("| {:?} | {plain:.3e} | {derivatives:.3e} | {:.1} |", shape.shape, derivatives / one);
    }
}
