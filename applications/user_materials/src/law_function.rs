//! Functions of the host program that give stresses, by name.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

/// Points of one material, of which a function gives the stress.
#[derive(Debug, Clone, Default)]
pub struct Points {
    /// Components of strain a point: 6 in space (xx, yy, zz, xy, yz, xz), 4 in plane strain and about an axis (xx, yy, zz, xy), 3 in plane
    /// stress (xx, yy, xy).
    pub components: usize,
    /// State variables a point.
    pub states: usize,
    /// Strains: small ones, or Green and Lagrange's of elements of finite strain; shear is doubled.
    pub strain: Vec<f64>,
    /// State variables after the last accepted step.
    pub state: Vec<f64>,
    /// TIME at the beginning and at the end of the step.
    pub time: [f64; 2],
    /// Whether the tangent is wanted.
    pub wants_tangent: bool,
    /// Constants of the material.
    pub parameters: Arc<[f64]>,
    /// Id of the element and number of the Gauss point, from 1, of each; zeros where there is none.
    pub places: Vec<[usize; 2]>,
}

impl Points {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
}

/// Result of a function at [`Points`], point by point.
#[derive(Debug, Clone, Default)]
pub struct Response {
    /// Stress that does work on the rate of the strain: Piola and Kirchhoff's second one where that is Green and Lagrange's.
    pub stress: Vec<f64>,
    /// Its derivative by the strain, row by row; it counts where it is wanted alone.
    pub tangent: Vec<f64>,
    /// State variables at the end of the step.
    pub state: Vec<f64>,
}

impl Response {
    /// # Errors
    /// Lists of another length than those of `points` need.
    pub(crate) fn check(self, points: &Points) -> Result<Self, String> {
        let (count, components) = (points.len(), points.components);
        for (name, found, wanted, counts) in [
            ("stress", self.stress.len(), count * components, true),
            ("tangent", self.tangent.len(), count * components * components, points.wants_tangent),
            ("state", self.state.len(), count * points.states, true),
        ] {
            if counts && found != wanted {
                return Err(format!("{name} of {count} points has {found} numbers, not {wanted}"));
            }
        }
        Ok(self)
    }
}

/// A function that gives stresses.
pub trait LawFunction: Send + Sync {
    /// Stress, tangent and state of all points.
    ///
    /// # Errors
    /// Why it has none.
    fn respond(&self, points: &Points) -> Result<Response, String>;
}

static FUNCTIONS: RwLock<BTreeMap<String, Arc<dyn LawFunction>>> = RwLock::new(BTreeMap::new());

/// Makes a function known by the name that materials give as LAW_FUNCTION; it takes the place of an earlier one.
pub fn add_function(name: &str, function: Arc<dyn LawFunction>) {
    FUNCTIONS.write().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned(), function);
}

/// The function of a name.
pub(crate) fn function(name: &str) -> Option<Arc<dyn LawFunction>> {
    FUNCTIONS.read().unwrap_or_else(PoisonError::into_inner).get(name).cloned()
}

/// Names of all functions.
pub(crate) fn names() -> Vec<String> {
    FUNCTIONS.read().unwrap_or_else(PoisonError::into_inner).keys().cloned().collect()
}
