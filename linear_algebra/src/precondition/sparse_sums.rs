//! A sparse sum of vectors under way.

/// Vectors of a width by places, of which it holds few.
pub(super) struct SparseSums {
    width: usize,
    at: Vec<u32>,
    places: Vec<u32>,
    values: Vec<f64>,
}

impl SparseSums {
    /// No vector of this width yet at any of `places`.
    pub(super) fn new(places: usize, width: usize) -> Self {
        Self { width, at: vec![u32::MAX; places], places: Vec::new(), values: Vec::new() }
    }

    /// The sum at a place, zero at first.
    #[inline]
    pub(super) fn at(&mut self, place: usize) -> &mut [f64] {
        let at = &mut self.at[place];
        if *at == u32::MAX {
            *at = self.places.len() as u32;
            self.places.push(place as u32);
            self.values.resize(self.values.len() + self.width, 0.0);
        }
        let begin = *at as usize * self.width;
        &mut self.values[begin..begin + self.width]
    }

    /// Hands on the sums in the order of their first terms; none is left then.
    pub(super) fn drain(&mut self, mut each: impl FnMut(u32, &[f64])) {
        for (&place, values) in self.places.iter().zip(self.values.chunks_exact(self.width)) {
            self.at[place as usize] = u32::MAX;
            each(place, values);
        }
        self.places.clear();
        self.values.clear();
    }
}
