//! The entities of a geometry and the physical groups they are in.

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::Result;

use super::Source;

/// Numbers of physical groups by dimension and number of the entity.
#[derive(Default)]
pub(super) struct Entities(FxHashMap<(usize, i64), Vec<i64>>);

impl Entities {
    /// Reads the section `$Entities` of version 4.1.
    pub(super) fn read(source: &mut Source<'_>) -> Result<Self> {
        let counts = [source.size()?, source.size()?, source.size()?, source.size()?];
        let mut out = FxHashMap::default();
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                let number = source.int()?;
                // a point has a position, everything else a box
                (0..if dimension == 0 { 3 } else { 6 }).try_for_each(|_| source.real().map(drop))?;
                let groups = source.size()?;
                let groups: Vec<i64> = (0..groups).map(|_| source.int().map(i64::abs)).collect::<Result<_>>()?;
                out.insert((dimension, number), groups);
                if dimension > 0 {
                    let around = source.size()?;
                    (0..around).try_for_each(|_| source.int().map(drop))?;
                }
            }
        }
        Ok(Self(out))
    }

    /// The groups of an entity.
    pub(super) fn groups(&self, dimension: usize, number: i64) -> &[i64] {
        self.0.get(&(dimension, number)).map_or(&[], Vec::as_slice)
    }
}
