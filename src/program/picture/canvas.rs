//! Triangles and lines by depth, on a grid finer than the picture.

use super::image::{Colour, Image};

/// Points of the grid in each direction of a point of the picture.
pub(super) const FINE: usize = 3;

/// A corner of a triangle: place on the picture, depth towards the eye, value, brightness, and height over a cutting plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub place: [f64; 3],
    pub value: f64,
    pub light: f64,
    pub height: f64,
}

/// The grid.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    colours: Vec<Colour>,
    depths: Vec<f32>,
}

impl Canvas {
    pub fn new([width, height]: [usize; 2], ground: Colour) -> Self {
        let (width, height) = (width * FINE, height * FINE);
        Self { width, height, colours: vec![ground; width * height], depths: vec![f32::NEG_INFINITY; width * height] }
    }

    /// Calls `at` with index and shares of the corners at each point of the grid within a triangle.
    fn within(&mut self, corners: [[f64; 2]; 3], at: &mut dyn FnMut(&mut Self, usize, [f64; 3])) {
        let [a, b, c] = corners.map(|place| place.map(|x| x * FINE as f64 - 0.5));
        let double = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if !(double.abs() > 1e-12 && double.is_finite()) {
            return;
        }
        let least = |i: usize| a[i].min(b[i]).min(c[i]).ceil().max(0.0) as usize;
        let most = |i: usize, end: usize| a[i].max(b[i]).max(c[i]).floor().min(end as f64 - 1.0);
        let (right, bottom) = (most(0, self.width), most(1, self.height));
        if right < 0.0 || bottom < 0.0 {
            return;
        }
        for y in least(1)..=bottom as usize {
            for x in least(0)..=right as usize {
                let (px, py) = (x as f64, y as f64);
                let second = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / double;
                let third = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / double;
                let first = 1.0 - second - third;
                if first >= -1e-9 && second >= -1e-9 && third >= -1e-9 {
                    at(self, y * self.width + x, [first, second, third]);
                }
            }
        }
    }

    /// Fills a triangle where it is in front and below the cutting plane. A corner without value gives the whole none.
    pub fn triangle(&mut self, corners: &[Corner; 3], colour: &dyn Fn(f64) -> Colour) {
        let mix = |of: &dyn Fn(&Corner) -> f64, shares: [f64; 3]| {
            corners.iter().zip(shares).map(|(own, share)| of(own) * share).sum::<f64>()
        };
        self.within(corners.map(|own| [own.place[0], own.place[1]]), &mut |canvas, at, shares| {
            let depth = mix(&|own| own.place[2], shares) as f32;
            if depth <= canvas.depths[at] || mix(&|own| own.height, shares) > 0.0 {
                return;
            }
            canvas.depths[at] = depth;
            let light = mix(&|own| own.light, shares);
            canvas.colours[at] =
                colour(mix(&|own| own.value, shares)).map(|part| (light * f64::from(part)).min(255.0) as u8);
        });
    }

    /// Draws a line where nothing is further in front of it than `lift`, and where both its ends are below the cutting plane.
    pub fn line(&mut self, ends: [&Corner; 2], width: f64, colour: Colour, share: f64, lift: f64) {
        let [a, b] = ends;
        let way = [b.place[0] - a.place[0], b.place[1] - a.place[1]];
        let length = way[0].hypot(way[1]);
        if length < 1e-9 || (a.height > 0.0 && b.height > 0.0) {
            return;
        }
        let side = [-way[1] / length * width / 2.0, way[0] / length * width / 2.0];
        let of = |own: &Corner, sign: f64| [own.place[0] + sign * side[0], own.place[1] + sign * side[1]];
        let corners = [of(a, 1.0), of(b, 1.0), of(b, -1.0), of(a, -1.0)];
        let along = [0.0, 1.0, 1.0, 0.0];
        for three in [[0, 1, 2], [0, 2, 3]] {
            self.within(three.map(|at| corners[at]), &mut |canvas, at, shares| {
                let t: f64 = three.iter().zip(shares).map(|(&own, share)| along[own] * share).sum();
                let depth = a.place[2] + t * (b.place[2] - a.place[2]) + lift;
                if (depth as f32) < canvas.depths[at] || a.height + t * (b.height - a.height) > 0.0 {
                    return;
                }
                let mixed = |own: u8, new: u8| (f64::from(own) + share * (f64::from(new) - f64::from(own))) as u8;
                let old = canvas.colours[at];
                canvas.colours[at] = std::array::from_fn(|c| mixed(old[c], colour[c]));
            });
        }
    }

    /// The depth at a point of the picture.
    pub fn depth(&self, [x, y]: [f64; 2]) -> f64 {
        let at = |x: f64, end: usize| (x * FINE as f64).clamp(0.0, end as f64 - 1.0) as usize;
        f64::from(self.depths[at(y, self.height) * self.width + at(x, self.width)])
    }

    /// The picture: the mean of the points of the grid.
    pub fn image(&self) -> Image {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut colours = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sums = [0_u32; 3];
                for row in 0..FINE {
                    let from = (y * FINE + row) * self.width + x * FINE;
                    for own in &self.colours[from..from + FINE] {
                        sums.iter_mut().zip(own).for_each(|(sum, &part)| *sum += u32::from(part));
                    }
                }
                colours.extend(sums.map(|sum| ((sum + (FINE * FINE / 2) as u32) / (FINE * FINE) as u32) as u8));
            }
        }
        Image { width, height, colours }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(place: [f64; 3], value: f64) -> Corner {
        Corner { place, value, light: 1.0, height: -1.0 }
    }

    #[test]
    fn the_nearer_triangle_is_seen_and_values_are_interpolated() {
        let mut canvas = Canvas::new([10, 10], [255; 3]);
        let grey = |value: f64| [value as u8; 3];
        let all = |z: f64, values: [f64; 3]| {
            let places = [[0.0, 0.0, z], [20.0, 0.0, z], [0.0, 20.0, z]];
            std::array::from_fn(|at| corner(places[at], values[at]))
        };
        canvas.triangle(&all(1.0, [0.0, 200.0, 0.0]), &grey);
        canvas.triangle(&all(0.0, [9.0, 9.0, 9.0]), &grey);
        let image = canvas.image();
        // ANALYTIC: value 10 x at the middle of a point of the picture, up to the steps of a byte
        for x in 0..9 {
            let found = f64::from(image.colours[3 * (5 * 10 + x)]);
            assert!((found - 10.0 * (x as f64 + 0.5)).abs() < 1.1, "{x}: {found}");
        }
        assert_eq!(canvas.depth([3.0, 3.0]), 1.0);
    }

    #[test]
    fn what_lies_beyond_the_plane_is_not_drawn() {
        let mut canvas = Canvas::new([10, 10], [255; 3]);
        let places = [[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [0.0, 20.0, 0.0]];
        // the height is that of x over 5
        let corners = places.map(|place| Corner { height: place[0] - 5.0, ..corner(place, 0.0) });
        canvas.triangle(&corners, &|_| [0; 3]);
        let image = canvas.image();
        let row: Vec<u8> = (0..10).map(|x| image.colours[3 * (20 + x)]).collect();
        assert_eq!(row, [0, 0, 0, 0, 0, 255, 255, 255, 255, 255]);
    }
}
