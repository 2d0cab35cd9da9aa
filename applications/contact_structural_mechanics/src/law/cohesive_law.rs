//! Laws of bonds between surfaces: how an opened bond is damaged.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::registered_kind;

use crate::mortar::Active;

/// A law of bonds.
///
/// The energies of a bond are those that it would store at its opening without damage, by area: ½ K_n ⟨w_n⟩² normal and ½ K_s |w_t|²
/// shear, with the opening w, its parts along the normal and across it, and the stiffnesses K.
pub trait CohesiveLaw: Send + Sync {
    /// Stiffnesses K_n > 0 and K_s ≥ 0 of the undamaged bond (stress by length). One without K_s carries no shear.
    fn stiffness(&self) -> [f64; 2];

    /// Damage, from 0 to 1, of a bond at these energies that has never been opened farther, normal and shear.
    fn damage(&self, energies: [Active; 2]) -> Active;

    /// Energy by area that a bond opened at this ratio of energies has dissipated at a damage.
    fn dissipated(&self, energies: [f64; 2], damage: f64) -> f64;
}

/// Makes a law from its settings, defaults filled in.
pub type MakeCohesiveLaw = fn(&Settings) -> Result<Box<dyn CohesiveLaw>>;

registered_kind! {
    /// A law of bonds, by the name of `law` in `cohesive`.
    pub struct CohesiveLawEntry("cohesive_law", "unknown-name") {
        build: MakeCohesiveLaw;
    }
}
