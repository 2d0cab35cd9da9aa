use super::mapping::*;
use super::*;
use crate::vector3::{add, cross, dot, norm, scale, sub};

type Vec3 = [f64; 3];

fn distance(a: Vec3, b: Vec3) -> f64 {
    norm(sub(a, b))
}

/// Reproducible numbers in [−1, 1].
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn inside(&mut self, shape: Shape) -> [f64; 3] {
        loop {
            let mut xi = [0.0; 3];
            xi[..shape.dim()].iter_mut().for_each(|x| *x = self.next());
            if shape.cell().contains(xi, 0.0) {
                return xi;
            }
        }
    }

    /// Nodes of an affinely moved and slightly disturbed reference cell; planar for lines and surfaces if asked.
    fn distorted(&mut self, shape: Shape, amount: f64, planar: bool) -> Vec<Vec3> {
        let moved = |p: &Vec3, noise: Vec3| {
            let y = [2.0 + p[0] + 0.3 * p[1] + 0.1 * p[2], 0.8 * p[1] - 1.0 + 0.2 * p[0], 0.1 * p[0] + 0.7 * p[2]];
            let y = add(y, scale(noise, amount));
            if planar { [y[0], y[1], 0.0] } else { y }
        };
        shape.cell().points.iter().map(|p| moved(p, [self.next(), self.next(), self.next()])).collect()
    }
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + b.abs())
}

#[test]
fn table_is_consistent() {
    for (k, shape) in Shape::ALL.into_iter().enumerate() {
        let cell = shape.cell();
        assert_eq!(shape as usize, k);
        assert_eq!(cell.shape, shape);
        assert_eq!(Shape::of(cell.dim, shape.nodes()), Some(shape));
        let mut order = cell.vtk_order.to_vec();
        order.sort_unstable();
        assert_eq!(order, (0..shape.nodes()).collect::<Vec<_>>(), "{shape:?}");
        assert!(cell.contains(cell.centre, 0.0));
        for facet in cell.faces.iter().chain(cell.edges) {
            assert_eq!(facet.nodes.len(), facet.shape.nodes());
        }
        let euler = cell.corners() as i64 - cell.edges.len() as i64 + cell.faces.len() as i64;
        assert_eq!(euler, [1, 3, cell.corners() as i64, 2][cell.dim], "{shape:?}");
    }
    assert_eq!(Shape::Prism6.cell().suffix(3), "3D6N");
}

#[test]
fn vtk_places_edge_middles_between_its_own_corners() {
    // edges of VTK's quadratic hexahedron and wedge, in VTK numbers
    let hexahedron = [0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7];
    let wedge = [0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 3, 0, 3, 1, 4, 2, 5];
    let pairs = [(Shape::Hex20, &hexahedron[..]), (Shape::Hex27, &hexahedron), (Shape::Prism15, &wedge)];
    for (shape, edges) in pairs {
        let cell = shape.cell();
        for (k, ends) in edges.chunks(2).enumerate() {
            let point = |vtk: usize| cell.points[cell.vtk_order[vtk]];
            let middle = scale(add(point(ends[0]), point(ends[1])), 0.5);
            assert_eq!(middle, point(cell.corners() + k), "{shape:?} edge {k}");
        }
    }
    let cell = Shape::Hex27.cell();
    let faces: Vec<_> = (20..26).map(|k| cell.points[cell.vtk_order[k]]).collect();
    let axes = [[-1., 0., 0.], [1., 0., 0.], [0., -1., 0.], [0., 1., 0.], [0., 0., -1.], [0., 0., 1.]];
    assert_eq!(faces, axes);
}

#[test]
fn shape_functions_are_one_at_their_node() {
    for shape in Shape::ALL {
        for (g, values) in (0..shape.nodes()).map(|g| (g, ShapeTable::at_nodes(shape).n_at(g))) {
            for (i, &value) in values.iter().enumerate() {
                assert!(near(value, f64::from(i == g), 1e-15), "{shape:?} N_{i} at node {g}");
            }
        }
    }
}

#[test]
fn shape_functions_sum_to_one_and_gradients_match_differences() {
    let mut random = Random(1);
    for shape in Shape::ALL {
        for _ in 0..5 {
            let xi = random.inside(shape);
            let (mut n, mut dn) = ([0.0; 27], [[0.0; 3]; 27]);
            shape_functions(shape, xi, &mut n);
            local_gradients(shape, xi, &mut dn);
            assert!(near(n.iter().sum(), 1.0, 1e-14), "{shape:?}");
            for k in 0..shape.dim() {
                let (h, mut plus, mut minus) = (1e-6, [0.0; 27], [0.0; 27]);
                let shifted = |s: f64| {
                    let mut shifted = xi;
                    shifted[k] += s;
                    shifted
                };
                shape_functions(shape, shifted(h), &mut plus);
                shape_functions(shape, shifted(-h), &mut minus);
                for i in 0..shape.nodes() {
                    assert!(near(dn[i][k], (plus[i] - minus[i]) / (2.0 * h), 1e-8), "{shape:?} N_{i},{k}");
                }
            }
        }
    }
}

#[test]
fn solids_of_second_order_reproduce_polynomials_of_degree_two() {
    let mut random = Random(5);
    let polynomial =
        |[x, y, z]: Vec3| 1.0 - x + 2.0 * y + z * z - x * y + 3.0 * y * z - 0.5 * z * x + x * x + 0.7 * y * y;
    for shape in Shape::ALL.into_iter().filter(|shape| shape.dim() == 3 && shape.linear() != *shape) {
        for _ in 0..5 {
            let (xi, mut n) = (random.inside(shape), [0.0; 27]);
            shape_functions(shape, xi, &mut n);
            let sum: f64 = shape.cell().points.iter().zip(n).map(|(&x, n)| n * polynomial(x)).sum();
            assert!(near(sum, polynomial(xi), 1e-13), "{shape:?}");
        }
    }
}

#[test]
fn isoparametric_cells_reproduce_their_own_coordinates() {
    let mut random = Random(2);
    for shape in Shape::ALL {
        let xi = random.inside(shape);
        assert!(distance(position(shape, shape.cell().points, xi), xi) < 1e-14, "{shape:?}");
    }
}

/// ∫ x^p y^q z^r over the reference cell.
fn monomial_integral(shape: Shape, p: [u32; 3]) -> f64 {
    let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
    let symmetric = |n: u32| if n % 2 == 1 { 0.0 } else { 2.0 / f64::from(n + 1) };
    let simplex = |dim: usize| {
        p[..dim].iter().map(|&n| factorial(n)).product::<f64>() / factorial(p[..dim].iter().sum::<u32>() + dim as u32)
    };
    match shape {
        Shape::Tri3 | Shape::Tri6 => simplex(2),
        Shape::Tet4 | Shape::Tet10 => simplex(3),
        Shape::Prism6 | Shape::Prism15 | Shape::Prism18 => simplex(2) / f64::from(p[2] + 1),
        Shape::Pyramid5 | Shape::Pyramid13 => {
            let across = p[0] + p[1];
            let along = factorial(across + 2) * factorial(p[2]) / factorial(across + p[2] + 3);
            symmetric(p[0]) * symmetric(p[1]) * along
        }
        _ => p[..shape.dim()].iter().map(|&n| symmetric(n)).product(),
    }
}

#[test]
fn rules_are_exact_to_their_degree() {
    for shape in Shape::ALL.into_iter().filter(|s| s.dim() > 0) {
        for order in 1..=MAX_ORDER {
            let gauss = 2 * order as u32 - 1;
            let (plane, height, total) = match shape {
                Shape::Tri3 | Shape::Tri6 => (9, 0, [1, 2, 3, 4, 6][order - 1]),
                Shape::Tet4 | Shape::Tet10 => (9, 9, [1, 2, 3, 5, 6][order - 1]),
                Shape::Prism6 | Shape::Prism15 => (2, gauss, 99),
                Shape::Prism18 => (4, gauss, 99),
                Shape::Pyramid5 | Shape::Pyramid13 => (gauss, gauss, [1, 3, 5, 7, 7][order - 1]),
                _ => (gauss, gauss, 99),
            };
            let tolerance = if matches!(shape, Shape::Tet4 | Shape::Tet10) && order == 2 { 2e-9 } else { 2e-15 };
            let rule = quadrature(shape, order);
            let dim = shape.dim();
            for p in 0..=9u32 {
                for q in 0..=9u32 {
                    for r in 0..=9u32 {
                        let prism = matches!(shape, Shape::Prism6 | Shape::Prism15 | Shape::Prism18);
                        let planar = if prism { p + q } else { p.max(q) };
                        if planar > plane || r > height || p + q + r > total {
                            continue;
                        }
                        if (dim < 3 && r > 0) || (dim < 2 && q > 0) {
                            continue;
                        }
                        let f = |x: &[f64; 3]| x[0].powi(p as i32) * x[1].powi(q as i32) * x[2].powi(r as i32);
                        let sum: f64 = rule.iter().map(|point| point.weight * f(&point.xi)).sum();
                        let exact = monomial_integral(shape, [p, q, r]);
                        assert!(near(sum, exact, tolerance), "{shape:?} order {order} x^{p}y^{q}z^{r}: {sum} {exact}");
                    }
                }
            }
        }
    }
}

#[test]
fn point_order_of_the_rules() {
    let s = (1.0f64 / 3.0).sqrt();
    let xi = |shape, order| quadrature(shape, order).iter().map(|p| p.xi).collect::<Vec<_>>();
    assert_eq!(xi(Shape::Quad4, 2), [[-s, -s, 0.], [s, -s, 0.], [s, s, 0.], [-s, s, 0.]]);
    assert_eq!(xi(Shape::Hex8, 2)[4..6], [[-s, -s, s], [s, -s, s]]);
    assert_eq!(xi(Shape::Prism6, 2)[0][..2], [2.0 / 3.0, 1.0 / 6.0]);
    let (a, b) = (xi(Shape::Quad4, 4), xi(Shape::Hex8, 4));
    assert!(a[0][0] == a[1][0] && b[0][1] == b[1][1], "quadrilateral: second coordinate fastest; hexahedron: first");
}

#[test]
fn faces_point_outward_and_bound_the_volume() {
    let mut random = Random(3);
    for shape in Shape::ALL.into_iter().filter(|s| s.dim() > 1) {
        let dim = shape.dim();
        for amount in [0.0, 0.05] {
            let x = random.distorted(shape, amount, dim == 2);
            // order 5 integrates the divergence x·n exactly, bilinear or quadratic faces alike
            let volume: f64 = ShapeTable::get(shape, 5)
                .points()
                .iter()
                .map(|p| p.weight * signed_det_jacobian(shape, &x, p.xi))
                .sum();
            let mut flux = 0.0;
            for face in shape.cell().faces {
                let nodes: Vec<Vec3> = face.nodes.iter().map(|&i| x[i]).collect();
                let outward = area_normal(face.shape, &nodes, face.shape.cell().centre);
                let from_centre = sub(centre(face.shape, &nodes), centre(shape, &x));
                assert!(dot(outward, from_centre) > 0.0, "{shape:?}");
                for p in ShapeTable::get(face.shape, 5).points() {
                    let at = position(face.shape, &nodes, p.xi);
                    flux += p.weight * dot(area_normal(face.shape, &nodes, p.xi), at) / dim as f64;
                }
            }
            // the rules of prisms in their triangle and of pyramids are not exact for a disturbed cell of second order
            let is_inexact = matches!(shape, Shape::Prism15 | Shape::Prism18 | Shape::Pyramid13) && amount > 0.0;
            let tolerance = if is_inexact { 1e-2 } else { 1e-12 };
            assert!(volume > 0.0 && near(flux, volume, tolerance), "{shape:?}: {flux} {volume}");
            assert!(!is_inverted(shape, dim, &x), "{shape:?}");
            if shape != Shape::Prism15 && dim == 3 {
                assert!(near(domain_size(shape, &x), volume, 1e-2));
            }
        }
        let mirrored: Vec<Vec3> = shape.cell().points.iter().map(|p| [-p[0], p[1], p[2]]).collect();
        assert!(is_inverted(shape, dim, &mirrored), "{shape:?}");
    }
}

#[test]
fn local_coordinates_invert_the_map() {
    let mut random = Random(4);
    for shape in Shape::ALL {
        let dim = shape.dim();
        let x = random.distorted(shape, 0.05, false);
        for _ in 0..10 {
            let xi = random.inside(shape);
            let mut point = position(shape, &x, xi);
            let found = local_coordinates(shape, &x, point).unwrap();
            assert!(distance(found.xi, if dim == 0 { [0.0; 3] } else { xi }) < 1e-12, "{shape:?} {found:?} {xi:?}");
            if dim == 1 || dim == 2 {
                // a point off the cell along a normal direction has the same foot
                let t = tangents(shape, &x, xi);
                let other = if dim == 1 { [0.3, -0.2, 0.9] } else { t[1] };
                let normal = crate::vector3::normalised(cross(t[0], other));
                point = add(point, scale(normal, 0.1));
                let found = local_coordinates(shape, &x, point).unwrap();
                assert!(distance(found.xi, xi) < 1e-10, "{shape:?} {found:?} {xi:?}");
                assert!(near(found.distance, 0.1, 1e-12));
            }
        }
    }
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    assert_eq!(local_coordinates(Shape::Tri3, &flat, [0.5, 0.5, 0.0]), None);
}

#[test]
fn feet_outside_the_cell_are_found_too() {
    let x = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let foot = local_coordinates(Shape::Line2, &x, [5.0, 3.0, 0.0]).unwrap();
    assert_eq!((foot.xi[0], foot.distance), (4.0, 3.0));
    assert!(!Shape::Line2.cell().contains(foot.xi, 1e-8));
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let foot = local_coordinates(Shape::Quad4, &square, [3.0, 0.5, 2.0]).unwrap();
    assert!(distance(foot.xi, [5.0, 0.0, 0.0]) < 1e-12 && near(foot.distance, 2.0, 1e-14));
}

#[test]
fn normals_follow_the_convention() {
    assert_eq!(unit_normal(Shape::Line2, &[[0.0; 3], [2.0, 0.0, 0.0]], [0.0; 3]), Some([0.0, -1.0, 0.0]));
    let triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(area_normal(Shape::Tri3, &triangle, [0.2, 0.2, 0.0]), [0.0, 0.0, 1.0]);
    assert_eq!(unit_normal(Shape::Line2, &[[1.0; 3], [1.0; 3]], [0.0; 3]), None);
}

#[test]
fn sizes_of_simple_cells() {
    let square = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    assert!(near(domain_size(Shape::Quad4, &square), 4.0, 1e-15));
    assert!(near(characteristic_length(Shape::Quad4, &square), 2.0, 1e-15));
    assert_eq!(shortest_node_distance(&square), 2.0);
    for shape in Shape::ALL {
        let (cell, linear) = (shape.cell(), shape.linear().cell());
        if shape.dim() > 0 {
            assert!(near(domain_size(shape, cell.points), cell.size(), 1e-8), "{shape:?}");
            assert!(near(monomial_integral(shape, [0; 3]), cell.size(), 1e-15), "{shape:?}");
        }
        assert_eq!((linear.size(), linear.points.len()), (cell.size(), cell.corners()));
        if shape.dim() == 2 {
            assert!(near(norm(vector_area(shape, cell.points)), cell.size(), 1e-15), "{shape:?}");
        }
    }
    // Warped, it is half the product of the diagonals.
    let warped = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.3], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let half = scale(cross(sub(warped[2], warped[0]), sub(warped[3], warped[1])), 0.5);
    assert!(distance(vector_area(Shape::Quad4, &warped), half) < 1e-15);
}

#[test]
fn tables_hand_out_typed_slices() {
    let table = ShapeTable::default_of(Shape::Hex8);
    assert_eq!((table.len(), table.n::<8>().len(), table.dn::<8, 3>().len()), (8, 8, 8));
    for g in 0..table.len() {
        assert_eq!(table.n::<8>()[g], table.n_at(g));
        for i in 0..8 {
            assert_eq!(table.dn::<8, 3>()[g][i], table.dn_at(g, i));
        }
    }
    assert!(std::ptr::eq(table, ShapeTable::get(Shape::Hex8, 2)));
}
