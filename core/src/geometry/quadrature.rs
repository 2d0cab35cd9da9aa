//! Gauss rules of order 1 to 5 for every shape, with the points in Kratos' order.
//!
//! Lines, quadrilaterals and hexahedra: Gauss–Legendre, n points an axis, exact to degree 2n − 1 in each coordinate.
//! Triangles: exact to degree 1, 2, 3, 4, 6; tetrahedra: 1, 2, 3, 5, 6. Prisms: n points along the height, but always
//! the three-point rule (degree 2) in the triangle, with 18 nodes the six-point rule (degree 4). Pyramids: n points across and one more
//! along the height, at most five, on the cube that collapses to the apex; exact to degree 2n − 1.

use super::Shape;

/// Highest order of the quadrature rules.
pub const MAX_ORDER: usize = 5;

/// A point of a rule: local coordinates and weight on the reference cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraturePoint {
    /// Local coordinates; those beyond the dimension of the cell are 0.
    pub xi: [f64; 3],
    /// Weight; the sum over a rule is the size of the reference cell.
    pub weight: f64,
}

/// The rule of `order` (1 to 5, held to that range) for `shape`.
pub fn quadrature(shape: Shape, order: usize) -> Vec<QuadraturePoint> {
    let order = order.clamp(1, MAX_ORDER);
    match shape {
        Shape::Point1 => vec![QuadraturePoint { xi: [0.0; 3], weight: 1.0 }],
        Shape::Line2 | Shape::Line3 => {
            legendre(order).into_iter().map(|(x, weight)| QuadraturePoint { xi: [x, 0.0, 0.0], weight }).collect()
        }
        Shape::Tri3 | Shape::Tri6 => triangle(order),
        Shape::Quad4 | Shape::Quad8 | Shape::Quad9 => quadrilateral(order),
        Shape::Tet4 | Shape::Tet10 => tetrahedron(order),
        Shape::Pyramid5 | Shape::Pyramid13 => pyramid(order),
        Shape::Prism6 | Shape::Prism15 => prism(order),
        Shape::Prism18 => biquadratic_prism(order),
        Shape::Hex8 | Shape::Hex20 | Shape::Hex27 => hexahedron(order),
    }
}

/// Gauss–Legendre points on [−1, 1], ascending, with weights.
fn legendre(n: usize) -> Vec<(f64, f64)> {
    let (inner, outer) = match n {
        1 => return vec![(0.0, 2.0)],
        2 => return vec![(-(1.0f64 / 3.0).sqrt(), 1.0), ((1.0f64 / 3.0).sqrt(), 1.0)],
        3 => {
            let x = 0.6f64.sqrt();
            return vec![(-x, 5.0 / 9.0), (0.0, 8.0 / 9.0), (x, 5.0 / 9.0)];
        }
        4 => {
            let (root, w) = (2.0 / 7.0 * 1.2f64.sqrt(), 30.0f64.sqrt());
            (((3.0 / 7.0 - root).sqrt(), (18.0 + w) / 36.0), ((3.0 / 7.0 + root).sqrt(), (18.0 - w) / 36.0))
        }
        _ => {
            let (root, w) = (2.0 * (10.0f64 / 7.0).sqrt(), 13.0 * 70.0f64.sqrt());
            (((5.0 - root).sqrt() / 3.0, (322.0 + w) / 900.0), ((5.0 + root).sqrt() / 3.0, (322.0 - w) / 900.0))
        }
    };
    let mut points = vec![(-outer.0, outer.1), (-inner.0, inner.1), inner, outer];
    if n == 5 {
        points.insert(2, (0.0, 128.0 / 225.0));
    }
    points
}

/// Order 2 goes round the corners, 3 has the first coordinate fastest, 4 and 5 the second, as in Kratos.
fn quadrilateral(order: usize) -> Vec<QuadraturePoint> {
    let line = legendre(order);
    let at = |i: usize, j: usize| QuadraturePoint { xi: [line[i].0, line[j].0, 0.0], weight: line[i].1 * line[j].1 };
    match order {
        2 => [(0, 0), (1, 0), (1, 1), (0, 1)].into_iter().map(|(i, j)| at(i, j)).collect(),
        3 => (0..9).map(|k| at(k % 3, k / 3)).collect(),
        _ => (0..order * order).map(|k| at(k / order, k % order)).collect(),
    }
}

/// Layers along the third coordinate; inside a layer order 2 goes round, the others have the first coordinate fastest.
fn hexahedron(order: usize) -> Vec<QuadraturePoint> {
    let line = legendre(order);
    let mut layer = quadrilateral(order);
    if order > 3 {
        layer.sort_by(|a, b| a.xi[1].total_cmp(&b.xi[1]).then(a.xi[0].total_cmp(&b.xi[0])));
    }
    let mut points = Vec::with_capacity(layer.len() * order);
    for (z, w) in line {
        points.extend(layer.iter().map(|p| QuadraturePoint { xi: [p.xi[0], p.xi[1], z], weight: p.weight * w }));
    }
    points
}

#[expect(clippy::excessive_precision, reason = "digits as published; the nearest number is meant")]
fn triangle(order: usize) -> Vec<QuadraturePoint> {
    let p = |x: f64, y: f64, weight: f64| QuadraturePoint { xi: [x, y, 0.0], weight };
    // The orbit of (a, b, b) in the order b at both, a first, a second.
    let orbit = |a: f64, b: f64, w: f64| [p(b, b, w), p(a, b, w), p(b, a, w)];
    let third = 1.0 / 3.0;
    match order {
        1 => vec![p(third, third, 0.5)],
        2 => orbit(2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0).to_vec(),
        3 => [&orbit(0.6, 0.2, 25.0 / 96.0)[..], &[p(third, third, -27.0 / 96.0)]].concat(),
        4 => [
            orbit(0.816847572980459, 0.091576213509771, 0.054975871827661),
            orbit(0.108103018168070, 0.445948490915965, 0.1116907948390055),
        ]
        .concat(),
        _ => {
            let (w, a, b, c) = (0.041425537809186787, 0.053145049844816947, 0.31035245103378441, 0.63650249912139865);
            let corner = orbit(0.87382197101699554, 0.063089014491502228, 0.025422453185103408);
            let inner = orbit(0.50142650965817916, 0.24928674517091042, 0.058393137863189683);
            let mut points: Vec<_> = [corner, inner].iter().flat_map(|o| [o[1], o[2], o[0]]).collect();
            points.extend([(a, b), (b, a), (a, c), (b, c), (c, a), (c, b)].map(|(x, y)| p(x, y, w)));
            points
        }
    }
}

#[expect(clippy::excessive_precision, reason = "digits as published; the nearest number is meant")]
fn tetrahedron(order: usize) -> Vec<QuadraturePoint> {
    let p = |x: f64, y: f64, z: f64, weight: f64| QuadraturePoint { xi: [x, y, z], weight };
    let orbit = |a: f64, b: f64, w: f64| [p(a, b, b, w), p(b, a, b, w), p(b, b, a, w), p(b, b, b, w)];
    match order {
        1 => vec![p(0.25, 0.25, 0.25, 1.0 / 6.0)],
        // eight digits, as in Kratos
        2 => orbit(0.58541020, 0.13819660, 1.0 / 24.0).to_vec(),
        3 => [
            orbit(0.015835909865720058, 0.32805469671142665, 0.023087994418643690),
            orbit(0.67914317820120795, 0.10695227393293068, 0.018578672248022976),
        ]
        .concat(),
        4 => {
            let (a, b, w) = (0.045503704125649649, 0.45449629587435035, 0.0070910034628469111);
            let mut points = [
                orbit(0.72179424906732632, 0.092735250310891226, 0.012248840519393658),
                orbit(0.067342242210098171, 0.31088591926330061, 0.018781320953002642),
            ]
            .concat();
            let edges = [(a, a, b), (a, b, a), (a, b, b), (b, a, a), (b, a, b), (b, b, a)];
            points.extend(edges.map(|(x, y, z)| p(x, y, z, w)));
            points
        }
        _ => {
            let (a, b, c, w) = (0.60300566479164914, 0.26967233145831581, 0.063661001875017525, 0.0080357142857142857);
            let mut points = [
                orbit(0.35619138622025439, 0.21460287125991520, 0.0066537917096449394),
                orbit(0.87797812439616594, 0.040673958534611353, 0.0016795351758909704),
                orbit(0.032986329573173469, 0.32233789014227551, 0.0092261969239878997),
            ]
            .concat();
            let rest = [
                (a, b, c),
                (a, c, b),
                (a, c, c),
                (c, a, b),
                (c, a, c),
                (c, c, a),
                (b, a, c),
                (b, c, a),
                (b, c, c),
                (c, b, a),
                (c, b, c),
                (c, c, b),
            ];
            points.extend(rest.map(|(x, y, z)| p(x, y, z, w)));
            points
        }
    }
}

/// Height in [0, 1]; three points a layer: (2/3, 1/6), (1/6, 2/3), (1/6, 1/6).
fn prism(order: usize) -> Vec<QuadraturePoint> {
    let triangle = triangle(2);
    let mut points = Vec::with_capacity(3 * order);
    for (z, w) in legendre(order) {
        points.extend([1, 2, 0].map(|i| {
            let p = triangle[i];
            QuadraturePoint { xi: [p.xi[0], p.xi[1], 0.5 * (1.0 + z)], weight: p.weight * 0.5 * w }
        }));
    }
    points
}

/// Height in [0, 1]; the six points of degree 4 a layer.
fn biquadratic_prism(order: usize) -> Vec<QuadraturePoint> {
    let layer = |(z, w): (f64, f64)| {
        triangle(4)
            .into_iter()
            .map(move |p| QuadraturePoint { xi: [p.xi[0], p.xi[1], 0.5 * (1.0 + z)], weight: p.weight * 0.5 * w })
    };
    legendre(order).into_iter().flat_map(layer).collect()
}

/// Layers from the base to the apex, with (1 − z)² of the area of the base.
fn pyramid(order: usize) -> Vec<QuadraturePoint> {
    let layer = |(z, w): (f64, f64)| {
        let (height, rest) = (0.5 * (1.0 + z), 0.5 * (1.0 - z));
        quadrilateral(order).into_iter().map(move |p| QuadraturePoint {
            xi: [rest * p.xi[0], rest * p.xi[1], height],
            weight: p.weight * rest * rest * 0.5 * w,
        })
    };
    legendre((order + 1).min(MAX_ORDER)).into_iter().flat_map(layer).collect()
}
