//! Profiles of lines and arcs, and the surfaces that they sweep: turned about an axis, extruded, or in the plane as they are.
//!
//! The rigid body lies to the left of the profile in the direction in which it runs, so normals (t_y, −t_x) point out of it.

use std::f64::consts::{PI, TAU};

use zelus_core::geometry::ExactSurface;

use super::exact_surfaces::{cone, cylinder, sphere, torus};
use super::shape_facets::{ShapeFacets, middle};

/// Share of the size of a profile within which a point is on its axis, and two ends are one.
const ROUND_OFF: f64 = 1e-9;
/// Sides of a ring of facets at least.
const LEAST_SIDES: usize = 8;
/// Length of a facet along a cylinder by its width, at most.
const LONGEST: f64 = 4.0;

/// A part of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Segment {
    /// A straight line.
    Line {
        /// Its ends.
        ends: [[f64; 2]; 2],
    },
    /// An arc of a circle.
    Arc {
        /// Centre of the circle.
        centre: [f64; 2],
        /// Radius of the circle.
        radius: f64,
        /// Angle at the start, from the first axis.
        from: f64,
        /// Angle that it sweeps: positive anticlockwise.
        sweep: f64,
    },
}

/// A fault of a profile: what is wrong, and how to mend it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileFault {
    /// The fact.
    pub fact: &'static str,
    /// The remedy.
    pub remedy: &'static str,
}

/// Connected segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The segments, each beginning where the one before ends.
    pub segments: Vec<Segment>,
}

/// Number of equal parts of a length that are no longer than `most`.
fn parts(length: f64, most: f64) -> usize {
    ((length / most * (1.0 - ROUND_OFF)).ceil() as usize).max(1)
}

impl Segment {
    /// The arc about a centre from one point to another, anticlockwise or clockwise.
    pub fn arc(centre: [f64; 2], from: [f64; 2], to: [f64; 2], clockwise: bool) -> Self {
        let angle = |x: [f64; 2]| (x[1] - centre[1]).atan2(x[0] - centre[0]);
        let start = angle(from);
        let turned = (angle(to) - start).rem_euclid(TAU);
        let sweep = if clockwise { turned - TAU } else { turned };
        let sweep = if sweep == 0.0 { TAU } else { sweep };
        Self::Arc { centre, radius: (from[0] - centre[0]).hypot(from[1] - centre[1]), from: start, sweep }
    }

    /// The point at a share of its length.
    fn at(&self, share: f64) -> [f64; 2] {
        match *self {
            Self::Line { ends: [a, b] } => [0, 1].map(|c| a[c] + share * (b[c] - a[c])),
            Self::Arc { centre, radius, from, sweep } => {
                let (sin, cos) = (from + share * sweep).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            }
        }
    }

    fn length(&self) -> f64 {
        match *self {
            Self::Line { ends: [a, b] } => (b[0] - a[0]).hypot(b[1] - a[1]),
            Self::Arc { radius, sweep, .. } => radius * sweep.abs(),
        }
    }

    /// Unit normal of a line, out of the body.
    fn normal(&self) -> [f64; 2] {
        let ([a, b], size) = ([self.at(0.0), self.at(1.0)], self.length());
        [(b[1] - a[1]) / size, (a[0] - b[0]) / size]
    }
}

impl Profile {
    /// Connected segments.
    ///
    /// # Errors
    /// No segments, one without length, ones that do not meet.
    pub fn new(segments: Vec<Segment>) -> Result<Self, ProfileFault> {
        let size = segments.iter().map(Segment::length).fold(0.0, f64::max);
        let fault = |fact, remedy| Err(ProfileFault { fact, remedy });
        if segments.is_empty() {
            return fault("the profile has no segments", "write a line or an arc at least");
        }
        if segments.iter().any(|own| !(own.length() > ROUND_OFF * size && own.length().is_finite())) {
            return fault("a segment of the profile has no length", "take it out, or mend its ends");
        }
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        if segments.windows(2).any(|two| apart(two[0].at(1.0), two[1].at(0.0)) > 1e-6 * size) {
            return fault(
                "two segments of the profile do not meet",
                "let each end of an arc be as far from its centre as its start",
            );
        }
        Ok(Self { segments })
    }

    /// Its mirror image across the second axis, which runs the other way: the body stays to its left.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let own = |segment: &Segment| match *segment {
            Segment::Line { ends: [a, b] } => Segment::Line { ends: [[-b[0], b[1]], [-a[0], a[1]]] },
            Segment::Arc { centre: [x, y], radius, from, sweep } => {
                Segment::Arc { centre: [-x, y], radius, from: PI - from - sweep, sweep }
            }
        };
        Self { segments: self.segments.iter().rev().map(own).collect() }
    }

    fn size(&self) -> f64 {
        self.segments.iter().map(Segment::length).fold(0.0, f64::max)
    }

    fn is_closed(&self) -> bool {
        let (Some(first), Some(last)) = (self.segments.first(), self.segments.last()) else { return false };
        let ([a, b], [c, d]) = (first.at(0.0), last.at(1.0));
        (a - c).hypot(b - d) < ROUND_OFF * self.size()
    }

    /// Ends of facets along a segment, as shares of its length: arcs in steps of at most `angle`, all of at most `length`.
    fn shares(segment: &Segment, angle: f64, length: f64) -> Vec<f64> {
        let by_angle = match segment {
            Segment::Arc { sweep, .. } => parts(sweep.abs(), angle),
            Segment::Line { .. } => 1,
        };
        let count = by_angle.max(parts(segment.length(), length));
        (0..=count).map(|n| n as f64 / count as f64).collect()
    }

    /// Lines in the plane.
    pub fn lines(&self, angle: f64, length: f64) -> ShapeFacets {
        let mut out = ShapeFacets::default();
        let place = |[x, y]: [f64; 2]| [x, y, 0.0];
        let first = out.point(place(self.segments[0].at(0.0)));
        let (mut last, closed) = (first, self.is_closed());
        for (at, segment) in self.segments.iter().enumerate() {
            let exact = match *segment {
                Segment::Line { .. } => None,
                Segment::Arc { centre, radius, .. } => Some((cylinder(centre, radius), out.apex(place(centre)))),
            };
            let shares = Self::shares(segment, angle, length);
            for (n, &share) in shares.iter().enumerate().skip(1) {
                let ends = closed && at + 1 == self.segments.len() && n + 1 == shares.len();
                let next = if ends { first } else { out.point(place(segment.at(share))) };
                out.line([last, next], exact);
                last = next;
            }
        }
        out
    }

    /// The surface that the profile sweeps along z, from `−depth/2` to `depth/2`.
    pub fn extruded(&self, depth: f64, angle: f64, length: f64) -> ShapeFacets {
        let mut out = ShapeFacets::default();
        let widest = |segment: &Segment| match *segment {
            Segment::Line { .. } => f64::INFINITY,
            Segment::Arc { radius, .. } => LONGEST * radius * angle,
        };
        let most = self.segments.iter().map(widest).fold(length, f64::min);
        let layers = parts(depth, most);
        let height = |layer: usize| depth * (layer as f64 / layers as f64 - 0.5);
        let column = |out: &mut ShapeFacets, [x, y]: [f64; 2]| -> Vec<u32> {
            (0..=layers).map(|layer| out.point([x, y, height(layer)])).collect()
        };
        let first = column(&mut out, self.segments[0].at(0.0));
        let (mut last, closed) = (first.clone(), self.is_closed());
        for (at, segment) in self.segments.iter().enumerate() {
            let surface = match *segment {
                Segment::Line { .. } => None,
                Segment::Arc { centre, radius, .. } => Some((cylinder(centre, radius), centre)),
            };
            let apexes: Vec<Option<(ExactSurface, u32)>> = (0..layers)
                .map(|layer| {
                    let z = 0.5 * (height(layer) + height(layer + 1));
                    surface.map(|(surface, [x, y])| (surface, out.apex([x, y, z])))
                })
                .collect();
            let shares = Self::shares(segment, angle, length);
            for (n, &share) in shares.iter().enumerate().skip(1) {
                let ends = closed && at + 1 == self.segments.len() && n + 1 == shares.len();
                let next = if ends { first.clone() } else { column(&mut out, segment.at(share)) };
                for (layer, &exact) in apexes.iter().enumerate() {
                    let [a, b, c, d] = [last[layer], next[layer], next[layer + 1], last[layer + 1]];
                    // Diagonals alternate, so that no direction is preferred.
                    let triangles = if (n + layer) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                    triangles.into_iter().for_each(|own| out.triangle(own, exact));
                }
                last = next;
            }
        }
        out
    }

    /// The surface that the profile, in coordinates (r, z), sweeps about the z axis.
    ///
    /// # Errors
    /// A profile that crosses the axis.
    pub fn turned(&self, angle: f64, length: f64) -> Result<ShapeFacets, ProfileFault> {
        let mut out = ShapeFacets::default();
        let axis = ROUND_OFF * self.size();
        let mut last: Option<(Vec<u32>, [f64; 2])> = None;
        for segment in &self.segments {
            let shares = Self::shares(segment, angle, length);
            let step = segment.length() / (shares.len() - 1) as f64;
            for &share in &shares {
                let [r, z] = segment.at(share);
                if r < -axis {
                    return Err(ProfileFault {
                        fact: "the profile crosses its axis",
                        remedy: "let the first coordinate, the distance from the axis, be 0 or more",
                    });
                }
                if share == 0.0 && last.is_some() {
                    continue;
                }
                let sides = parts(TAU * r, step.min(r * angle).min(length)).max(LEAST_SIDES);
                let sides = match *segment {
                    // Triangles at the tip of a cone are as long as its side.
                    Segment::Line { .. } => parts(TAU, angle),
                    Segment::Arc { .. } => sides.min(parts(TAU, angle)),
                };
                let ring: Vec<u32> = if r <= axis {
                    vec![out.point([0.0, 0.0, z])]
                } else {
                    (0..sides).map(|n| out.point(at_angle([r, z], TAU * n as f64 / sides as f64))).collect()
                };
                if let Some((before, from)) = &last {
                    strip(&mut out, [before, &ring], &mut Apexes::new(segment, middle2(*from, [r, z]), axis));
                }
                last = Some((ring, [r, z]));
            }
        }
        Ok(out)
    }
}

fn at_angle([r, z]: [f64; 2], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [r * cos, r * sin, z]
}

fn middle2([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [0.5 * (a + c), 0.5 * (b + d)]
}

/// The exact surface of a strip between two rings, and the apexes of its facets.
struct Apexes {
    surface: Option<ExactSurface>,
    /// Distance of apexes from the axis, and their height.
    at: [f64; 2],
    /// The apex of each sector about the axis; one for all on the axis.
    made: Vec<Option<u32>>,
}

impl Apexes {
    fn new(segment: &Segment, [r, z]: [f64; 2], axis: f64) -> Self {
        let (surface, at) = match *segment {
            Segment::Line { ends: [start, _] } => {
                let [nr, nz] = segment.normal();
                // The normal through the middle of the strip meets the axis there; a disc is flat.
                let distance = nr * start[0] + nz * start[1];
                if nr.abs() < ROUND_OFF {
                    (None, [0.0, z])
                } else {
                    (Some(cone([nr, nz], distance)), [0.0, z - r * nz / nr])
                }
            }
            Segment::Arc { centre, radius, .. } if centre[0].abs() <= axis => {
                (Some(sphere(centre[1], radius)), [0.0, centre[1]])
            }
            Segment::Arc { centre, radius, .. } => (Some(torus(centre, radius)), centre),
        };
        let around = match *segment {
            Segment::Arc { radius, .. } if at[0] != 0.0 => parts(TAU * at[0].abs(), 0.5 * radius).max(LEAST_SIDES),
            _ => 1,
        };
        Self { surface, at, made: vec![None; around] }
    }

    fn of(&mut self, out: &mut ShapeFacets, centre: [f64; 3]) -> Option<(ExactSurface, u32)> {
        let surface = self.surface?;
        let count = self.made.len();
        let sector = (centre[1].atan2(centre[0]).rem_euclid(TAU) / TAU * count as f64).round() as usize % count;
        let at = at_angle(self.at, if count == 1 { 0.0 } else { TAU * sector as f64 / count as f64 });
        let apex = *self.made[sector].get_or_insert_with(|| out.apex(at));
        Some((surface, apex))
    }
}

/// Triangles between two rings of any numbers of points, the second further along the profile.
fn strip(out: &mut ShapeFacets, [below, above]: [&[u32]; 2], apexes: &mut Apexes) {
    let (mut i, mut j) = (0, 0);
    let sides = |ring: &[u32]| if ring.len() == 1 { 0 } else { ring.len() };
    let (m, n) = (sides(below), sides(above));
    let angle = |k: usize, count: usize| if count == 0 { 3.0 * PI } else { TAU * k as f64 / count as f64 };
    while i < m || j < n {
        let (a, b) = (below[i % below.len()], above[j % above.len()]);
        // The ring whose next point comes first about the axis goes on.
        let first = j >= n || i < m && angle(i + 1, m) <= angle(j + 1, n);
        let points = if first {
            i += 1;
            [a, below[i % below.len()], b]
        } else {
            j += 1;
            [a, above[j % above.len()], b]
        };
        let [p, q, r] = points.map(|at| out.points[at as usize]);
        let centre = middle(middle(p, q), middle(q, r));
        let exact = apexes.of(out, centre);
        out.triangle(points, exact);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::geometry::{ExactFacet, TRIANGLE_3_APEX, combine};
    use zelus_core::vector3::norm;

    const ANGLE: f64 = 0.1;

    /// Largest value of the level of its surface at inner points of facets.
    fn off_surface(facets: &ShapeFacets) -> f64 {
        let own = |facet: &super::super::shape_facets::ShapeFacet| {
            let Some((surface, apex)) = facet.exact else { return 0.0 };
            let corners = facet.points.map(|at| facets.points[at as usize]);
            let apex = facets.apexes[apex as usize];
            let exact = ExactFacet { surface, corners, apex };
            let [a, b, c] = corners;
            let x = combine(&exact.functions(&TRIANGLE_3_APEX, [0.3, 0.4]).values, &[a, b, c, apex]);
            (surface.level)(&surface.numbers, x).0.abs()
        };
        facets.facets.iter().map(own).fold(0.0, f64::max)
    }

    fn half_circle(centre: f64, radius: f64) -> Profile {
        Profile::new(vec![Segment::Arc { centre: [centre, 0.0], radius, from: -0.5 * PI, sweep: PI }]).unwrap()
    }

    /// ANALYTIC: volume 4/3 π R³ of a sphere, to the error of its facets; points on the sphere to round-off.
    #[test]
    fn a_turned_half_circle_is_a_closed_sphere() {
        let sphere = half_circle(0.0, 2.0).turned(ANGLE, f64::INFINITY).unwrap();
        let volume = sphere.enclosed() / 6.0;
        let exact = 4.0 / 3.0 * PI * 8.0;
        assert!((volume / exact - 1.0).abs() < 5e-3, "{volume} {exact}");
        assert!(off_surface(&sphere) < 1e-13);
        assert!(sphere.points.iter().all(|&x| (norm(x) - 2.0).abs() < 1e-14));
    }

    /// ANALYTIC: volumes of a torus 2π² R ρ² and of a cone π R² H/3 with its base, to the error of their facets.
    #[test]
    fn turned_circles_and_lines_enclose_their_volumes() {
        let circle = Segment::Arc { centre: [3.0, 0.5], radius: 1.0, from: 0.0, sweep: TAU };
        let torus = Profile::new(vec![circle]).unwrap().turned(ANGLE, f64::INFINITY).unwrap();
        let exact = 2.0 * PI * PI * 3.0;
        assert!((torus.enclosed() / 6.0 / exact - 1.0).abs() < 5e-3, "{} {exact}", torus.enclosed() / 6.0);
        assert!(off_surface(&torus) < 1e-13);
        let lines = [[[0.0, 0.0], [2.0, 1.5]], [[2.0, 1.5], [0.0, 1.5]]].map(|ends| Segment::Line { ends });
        let cone = Profile::new(lines.to_vec()).unwrap().turned(ANGLE, f64::INFINITY).unwrap();
        let exact = PI * 4.0 * 1.5 / 3.0;
        assert!((cone.enclosed() / 6.0 / exact - 1.0).abs() < 5e-3, "{} {exact}", cone.enclosed() / 6.0);
        assert!(off_surface(&cone) < 1e-13);
    }

    /// ANALYTIC: the lateral surface of a cylinder is 2π R L, to the error of its facets; its points in the plane are on the circle.
    #[test]
    fn a_circle_is_extruded_to_a_cylinder() {
        let circle = Segment::Arc { centre: [0.4, 0.0], radius: 1.5, from: 0.0, sweep: TAU };
        let profile = Profile::new(vec![circle]).unwrap();
        let cylinder = profile.extruded(2.0, ANGLE, f64::INFINITY);
        // One third of the volume lies below the lateral surface, seen from the centre.
        assert!((cylinder.enclosed() / 6.0 / (2.0 / 3.0 * PI * 2.25 * 2.0) - 1.0).abs() < 5e-3);
        assert!(off_surface(&cylinder) < 1e-13);
        let lines = profile.lines(ANGLE, f64::INFINITY);
        assert_eq!(lines.points.len(), lines.facets.len());
        assert!(lines.points.iter().all(|x| ((x[0] - 0.4).hypot(x[1]) - 1.5).abs() < 1e-14));
    }
}
