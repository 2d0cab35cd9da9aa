//! Numbers that laws of bonds share: onset and energy of fracture at a ratio of modes, by Benzeggagh and Kenane (1996).
//!
//! With the energies e_n, e_s of the undamaged bond and the share B = e_s/(e_n + e_s) of shear, damage begins where
//! e_n + e_s = e₀ = N²/(2 K_n) + (S²/(2 K_s) − N²/(2 K_n)) B^η, and the bond takes up G = G_I + (G_II − G_I) B^η until it fails.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::scalar::Real;

/// Stiffnesses, onset and energies of both modes.
pub(super) struct MixedMode {
    /// K_n and K_s (stress by length).
    pub stiffness: [f64; 2],
    /// Energies by area at the onset of damage, of either mode alone.
    onset: [f64; 2],
    /// Energies of fracture by area.
    fracture: [f64; 2],
    /// Exponent η of the mixture.
    exponent: f64,
}

/// A bond at an opening, by its energies.
pub(super) struct ByMode<T> {
    /// Energy by area at the onset of damage of this mixture.
    pub onset: T,
    /// Energy of fracture over that at the onset, above 1.
    pub ratio: T,
    /// Opening over that at the onset.
    pub opening: T,
}

impl MixedMode {
    /// The numbers of the settings.
    ///
    /// # Errors
    /// A number that is not above 0, or energies that an elastic bond takes up before its strength.
    pub fn of(settings: &Settings) -> Result<Self> {
        let both = |words: [&str; 2]| -> Result<[f64; 2]> {
            Ok([settings.get_positive(words[0])?, settings.get_positive(words[1])?])
        };
        let stiffness = both(["normal_stiffness", "shear_stiffness"])?;
        let strength = both(["normal_strength", "shear_strength"])?;
        let fracture = both(["normal_energy", "shear_energy"])?;
        let onset = std::array::from_fn(|mode| 0.5 * strength[mode] * strength[mode] / stiffness[mode]);
        for (mode, word) in ["normal", "shear"].into_iter().enumerate() {
            check_energy(settings, word, (onset[mode], fracture[mode]))?;
        }
        Ok(Self { stiffness, onset, fracture, exponent: settings.get_f64("mixed_mode_exponent")? })
    }

    /// The bond at these energies; `None` without any.
    pub fn at<T: Real>(&self, [normal, shear]: [T; 2]) -> Option<ByMode<T>> {
        let energy = normal + shear;
        if energy.value() <= 0.0 {
            return None;
        }
        let share = (shear / energy).powf(self.exponent);
        let mix = |[normal, shear]: [f64; 2]| share * (shear - normal) + normal;
        let (onset, fracture) = (mix(self.onset), mix(self.fracture));
        Some(ByMode { onset, ratio: fracture / onset, opening: (energy / onset).sqrt() })
    }
}

/// Refuses an energy of fracture that does not exceed that at the onset of damage.
///
/// # Errors
/// Such an energy.
pub(super) fn check_energy(settings: &Settings, mode: &str, (onset, fracture): (f64, f64)) -> Result<()> {
    if fracture > onset {
        return Ok(());
    }
    let key = format!("{mode}_energy");
    let fact = format!(
        "\"{key}\" is {fracture}, and the elastic bond has taken up {onset} at its \"{mode}_strength\", by strength²/(2 stiffness): it \
         would fail before it is damaged"
    );
    let remedy = format!("raise \"{mode}_stiffness\" or \"{key}\", or lower \"{mode}_strength\"");
    Err(settings.error(&key, "out-of-range", fact).remedy(remedy).into())
}
