//! A tree of axis-aligned boxes over facets.

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: [f64; 3],
    /// Largest coordinates.
    pub high: [f64; 3],
}

impl Bounds {
    /// The smallest box around points.
    pub fn of(points: &[[f64; 3]]) -> Self {
        let mut bounds = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for point in points {
            for c in 0..3 {
                bounds.low[c] = bounds.low[c].min(point[c]);
                bounds.high[c] = bounds.high[c].max(point[c]);
            }
        }
        bounds
    }

    /// The box with `margin` added on every side.
    #[must_use]
    pub fn grown(mut self, margin: f64) -> Self {
        for c in 0..3 {
            self.low[c] -= margin;
            self.high[c] += margin;
        }
        self
    }

    /// Whether the boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|c| self.low[c] <= other.high[c] && other.low[c] <= self.high[c])
    }

    fn around(&self, other: &Self) -> Self {
        let mut out = *self;
        for c in 0..3 {
            out.low[c] = out.low[c].min(other.low[c]);
            out.high[c] = out.high[c].max(other.high[c]);
        }
        out
    }
}

/// Items in a leaf.
const LEAF: usize = 4;

#[derive(Debug, Clone)]
struct Branch {
    bounds: Bounds,
    /// Range of `items` below this branch.
    range: (usize, usize),
    /// Branches below; `None` for a leaf.
    children: Option<(usize, usize)>,
}

/// A static tree of boxes, split at the median of the longest axis.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    branches: Vec<Branch>,
    items: Vec<u32>,
    boxes: Vec<Bounds>,
}

impl Tree {
    /// The tree over these boxes; items are their positions in the list.
    pub fn new(boxes: Vec<Bounds>) -> Self {
        let mut tree = Self { branches: Vec::new(), items: (0..boxes.len() as u32).collect(), boxes };
        if !tree.boxes.is_empty() {
            tree.split(0, tree.items.len());
        }
        tree
    }

    /// The box around all; `None` around nothing.
    pub fn bounds(&self) -> Option<Bounds> {
        self.boxes.iter().copied().reduce(|sum, own| sum.around(&own))
    }

    fn split(&mut self, begin: usize, end: usize) -> usize {
        let first = self.boxes[self.items[begin] as usize];
        let bounds = self.items[begin..end].iter().fold(first, |all, &i| all.around(&self.boxes[i as usize]));
        let at = self.branches.len();
        self.branches.push(Branch { bounds, range: (begin, end), children: None });
        if end - begin > LEAF {
            let axis = (0..3)
                .max_by(|&a, &b| (bounds.high[a] - bounds.low[a]).total_cmp(&(bounds.high[b] - bounds.low[b])))
                .unwrap_or(0);
            let boxes = &self.boxes;
            let middle = |i: u32| boxes[i as usize].low[axis] + boxes[i as usize].high[axis];
            let half = (end - begin) / 2;
            self.items[begin..end]
                .select_nth_unstable_by(half, |&a, &b| middle(a).total_cmp(&middle(b)).then(a.cmp(&b)));
            let left = self.split(begin, begin + half);
            let right = self.split(begin + half, end);
            self.branches[at].children = Some((left, right));
        }
        at
    }

    /// Items whose boxes meet `query`, ascending.
    pub fn meeting(&self, query: &Bounds) -> Vec<u32> {
        let mut found = Vec::new();
        let mut stack = if self.branches.is_empty() { Vec::new() } else { vec![0] };
        while let Some(at) = stack.pop() {
            let branch = &self.branches[at];
            if !branch.bounds.meets(query) {
                continue;
            }
            match branch.children {
                Some((left, right)) => stack.extend([left, right]),
                None => {
                    let items = &self.items[branch.range.0..branch.range.1];
                    found.extend(items.iter().copied().filter(|&i| self.boxes[i as usize].meets(query)));
                }
            }
        }
        found.sort_unstable();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_plain_loop_finds() {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 31) as f64
        };
        let boxes: Vec<Bounds> = (0..200)
            .map(|_| {
                let p = [random(), random(), random()];
                Bounds::of(&[p, [p[0] + 0.1 * random(), p[1] + 0.1 * random(), p[2]]])
            })
            .collect();
        let tree = Tree::new(boxes.clone());
        for query in &boxes {
            let query = query.grown(0.05);
            let plain: Vec<u32> = (0..200).filter(|&i| boxes[i as usize].meets(&query)).collect();
            assert_eq!(tree.meeting(&query), plain);
        }
        assert!(Tree::new(Vec::new()).meeting(&boxes[0]).is_empty());
    }
}
