//! Points of three colours, on which text, lines and rings are laid with smooth rims.

/// A colour, red, green and blue.
pub(super) type Colour = [u8; 3];

/// A picture, row by row from the top.
#[derive(Debug, Clone)]
pub(super) struct Image {
    pub width: usize,
    pub height: usize,
    pub colours: Vec<u8>,
}

impl Image {
    /// Lays a colour on a point by its share of the point.
    pub fn blend(&mut self, x: i64, y: i64, colour: Colour, share: f64) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= self.width || y >= self.height {
            return;
        }
        let at = 3 * (y * self.width + x);
        for (own, new) in self.colours[at..at + 3].iter_mut().zip(colour) {
            *own = (f64::from(*own) + share * (f64::from(new) - f64::from(*own))).round() as u8;
        }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, [x, y]: [usize; 2], [width, height]: [usize; 2], colour: Colour) {
        for row in y..(y + height).min(self.height) {
            for column in x..(x + width).min(self.width) {
                let at = 3 * (row * self.width + column);
                self.colours[at..at + 3].copy_from_slice(&colour);
            }
        }
    }

    /// Lays another picture on it.
    pub fn paste(&mut self, [x, y]: [usize; 2], other: &Self) {
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let width = other.width.min(self.width.saturating_sub(x));
            let (to, from) = (3 * ((y + row) * self.width + x), 3 * row * other.width);
            self.colours[to..to + 3 * width].copy_from_slice(&other.colours[from..from + 3 * width]);
        }
    }

    /// Covers points by the share that the distance from a curve leaves of a pen.
    fn pen(&mut self, low: [f64; 2], high: [f64; 2], colour: Colour, width: f64, distance: &dyn Fn(f64, f64) -> f64) {
        let range = |a: f64, b: f64| (a - width - 1.0).floor() as i64..=(b + width + 1.0).ceil() as i64;
        for y in range(low[1], high[1]) {
            for x in range(low[0], high[0]) {
                let share = (width / 2.0 + 0.5 - distance(x as f64 + 0.5, y as f64 + 0.5)).clamp(0.0, 1.0);
                if share > 0.0 {
                    self.blend(x, y, colour, share);
                }
            }
        }
    }

    /// A line between two places.
    pub fn line(&mut self, a: [f64; 2], b: [f64; 2], colour: Colour, width: f64) {
        let way = [b[0] - a[0], b[1] - a[1]];
        let square = (way[0] * way[0] + way[1] * way[1]).max(1e-12);
        let distance = |x: f64, y: f64| {
            let share = (((x - a[0]) * way[0] + (y - a[1]) * way[1]) / square).clamp(0.0, 1.0);
            (x - a[0] - share * way[0]).hypot(y - a[1] - share * way[1])
        };
        let ends = |c: usize| (a[c].min(b[c]), a[c].max(b[c]));
        let ((left, right), (top, bottom)) = (ends(0), ends(1));
        self.pen([left, top], [right, bottom], colour, width, &distance);
    }

    /// A ring about a place.
    pub fn ring(&mut self, [x, y]: [f64; 2], radius: f64, colour: Colour, width: f64) {
        let distance = |px: f64, py: f64| ((px - x).hypot(py - y) - radius).abs();
        self.pen([x - radius, y - radius], [x + radius, y + radius], colour, width, &distance);
    }

    /// The rim of a rectangle.
    pub fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Colour, pen: f64) {
        let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
        for at in 0..4 {
            self.line(corners[at], corners[(at + 1) % 4], colour, pen);
        }
    }
}
