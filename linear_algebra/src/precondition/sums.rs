//! A sparse sum of numbers under way.

/// Numbers by places, of which it holds few.
pub(super) struct Sums {
    at: Vec<u32>,
    places: Vec<u32>,
    values: Vec<f64>,
}

impl Sums {
    /// No number yet at any of `places`.
    pub(super) fn new(places: usize) -> Self {
        Self { at: vec![u32::MAX; places], places: Vec::new(), values: Vec::new() }
    }

    /// Adds a number at a place.
    pub(super) fn add(&mut self, place: usize, value: f64) {
        let at = &mut self.at[place];
        if *at == u32::MAX {
            *at = self.places.len() as u32;
            self.places.push(place as u32);
            self.values.push(0.0);
        }
        self.values[*at as usize] += value;
    }

    /// Hands on the sums by ascending places; none is left then.
    pub(super) fn drain(&mut self, mut each: impl FnMut(u32, f64)) {
        self.places.sort_unstable();
        for &place in &self.places {
            each(place, self.values[std::mem::replace(&mut self.at[place as usize], u32::MAX) as usize]);
        }
        self.places.clear();
        self.values.clear();
    }
}
