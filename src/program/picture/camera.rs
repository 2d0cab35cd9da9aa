//! Places of points on a picture, without perspective.

/// A direction of sight with the part of space that a picture shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    /// To the right, upwards, and towards the eye.
    axes: [[f64; 3]; 3],
    /// The point in the middle, along the first two axes.
    centre: [f64; 2],
    /// The middle on the picture.
    middle: [f64; 2],
    /// Points of the picture a length.
    pub scale: f64,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 { a.map(|x| x / length) } else { a }
}

impl Camera {
    /// A camera that sees from a direction; `upward` is an axis, replaced where it is the direction itself.
    pub fn new(towards: [f64; 3], upward: usize) -> Self {
        let towards = unit(towards);
        let axis = |at: usize| std::array::from_fn(|c| f64::from(u8::from(c == at)));
        let is_steep = towards[upward].abs() > 0.999;
        let up = if is_steep { axis(if upward == 1 { 2 } else { 1 }) } else { axis(upward) };
        let right = unit(cross(up, towards));
        let axes = [right, cross(towards, right), towards];
        Self { axes, centre: [0.0; 2], middle: [0.0; 2], scale: 1.0 }
    }

    /// Least and most of points along the axes of the picture.
    pub fn box_of(&self, points: &mut dyn Iterator<Item = [f64; 3]>) -> [[f64; 2]; 2] {
        let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for point in points {
            for (own, axis) in found.iter_mut().zip(self.axes) {
                let at = dot(axis, point);
                *own = [own[0].min(at), own[1].max(at)];
            }
        }
        found
    }

    /// Shows a box as large as it may be within a rectangle of the picture.
    pub fn fit(&mut self, [x, y]: [[f64; 2]; 2], [left, top]: [f64; 2], [width, height]: [f64; 2]) {
        self.centre = [(x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0];
        self.middle = [left + width / 2.0, top + height / 2.0];
        let scale = (width / (x[1] - x[0])).min(height / (y[1] - y[0]));
        self.scale = if scale.is_finite() { scale } else { 1.0 };
    }

    /// The same direction, `times` larger, with a place of this picture in the middle of a square of another.
    pub fn enlarged(&self, times: f64, [x, y]: [f64; 2], side: f64) -> Self {
        let middle = [side / 2.0 - times * (x - self.middle[0]), side / 2.0 - times * (y - self.middle[1])];
        Self { axes: self.axes, centre: self.centre, middle, scale: self.scale * times }
    }

    /// Place on the picture, and depth towards the eye as a length of the picture.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes.map(|axis| dot(axis, point));
        [
            self.middle[0] + self.scale * (x - self.centre[0]),
            self.middle[1] - self.scale * (y - self.centre[1]),
            self.scale * z,
        ]
    }

    /// The direction of a vector on the picture, as the share of its length to the right and downwards.
    pub fn direction(&self, vector: [f64; 3]) -> [f64; 2] {
        [dot(self.axes[0], vector), -dot(self.axes[1], vector)]
    }

    /// Brightness of a surface: full where it faces the eye, and never so little that a colour is mistaken.
    pub fn light(&self, normal: [f64; 3]) -> f64 {
        0.78 + 0.22 * dot(self.axes[2], normal).abs()
    }

    /// Towards the eye.
    pub fn towards(&self) -> [f64; 3] {
        self.axes[2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_from_the_front_shows_x_right_and_z_up() {
        let mut camera = Camera::new([0.0, -2.0, 0.0], 2);
        camera.fit([[0.0, 2.0], [0.0, 1.0]], [100.0, 0.0], [400.0, 300.0]);
        assert_eq!(camera.scale, 200.0);
        assert_eq!(camera.place([1.0, 7.0, 0.5]), [300.0, 150.0, -1400.0]);
        assert_eq!(camera.place([2.0, 0.0, 1.0]), [500.0, 50.0, 0.0]);
        let above = Camera::new([0.0, 0.0, 1.0], 2);
        assert_eq!(above.direction([1.0, 0.0, 0.0]), [1.0, 0.0]);
        assert_eq!(above.direction([0.0, 1.0, 0.0]), [0.0, -1.0]);
    }
}
