use super::COULOMB;
use crate::law::{Sliding, find_friction_law};

fn bound(law: &str, numbers: &[f64], pressure: f64, speed: f64) -> f64 {
    let law = find_friction_law(law).expect("it is registered");
    (law.bound)(numbers, Sliding { pressure, speed, temperature: 0.0 }).at(pressure)
}

#[test]
fn bounds_are_those_of_the_laws() {
    assert_eq!(bound("Coulomb", &[0.3], -10.0, 2.0), 3.0);
    assert_eq!(bound("Tresca", &[0.3], -10.0, 2.0), 0.3);
    assert_eq!(bound("Orowan", &[0.5, 4.0], -6.0, 0.0), 3.0);
    assert_eq!(bound("Orowan", &[0.5, 4.0], -10.0, 0.0), 4.0);
    assert_eq!(bound("StaticKinetic", &[0.5, 0.2, 3.0], -10.0, 0.0), 5.0);
    let sliding = bound("StaticKinetic", &[0.5, 0.2, 3.0], -10.0, 0.4);
    assert!((sliding - 10.0 * (0.2 + 0.3 * (-1.2_f64).exp())).abs() < 1e-14, "{sliding}");
}

#[test]
fn friction_softens_between_two_temperatures() {
    let law = find_friction_law("ThermalSoftening").expect("it is registered");
    let numbers = [0.4, 2.0, -20.0, 180.0];
    assert_eq!((law.check)(&numbers), Ok(()));
    // θ = 0.5 at 80.
    for (temperature, right) in [(-50.0, 4.0), (-20.0, 4.0), (80.0, 3.0), (180.0, 0.0), (300.0, 0.0)] {
        let bound = (law.bound)(&numbers, Sliding { pressure: -10.0, speed: 0.0, temperature }).at(-10.0);
        assert!((bound - right).abs() < 1e-14, "at {temperature}: {bound}");
    }
    assert!((law.check)(&[0.4, 0.0, -20.0, 180.0]).is_err() && (law.check)(&[0.4, 1.0, 180.0, 180.0]).is_err());
}

#[test]
fn bounds_without_strength_are_smooth() {
    let none = Sliding::default();
    assert!((COULOMB.bound)(&[0.0], none).is_smooth());
    for (law, numbers) in [
        ("Tresca", &[0.0][..]),
        ("Orowan", &[0.0, 0.0]),
        ("StaticKinetic", &[0.0, 0.0, 1.0]),
        ("ThermalSoftening", &[0.0, 1.0, 0.0, 1.0]),
    ] {
        let law = find_friction_law(law).expect("it is registered");
        assert!((law.bound)(numbers, none).is_smooth());
    }
}

/// The bound of a law is a tangent: its slope is the derivative by the pressure.
#[test]
fn coefficients_are_derivatives_by_the_pressure() {
    for (name, numbers) in [("Orowan", &[0.5, 4.0][..]), ("StaticKinetic", &[0.5, 0.2, 3.0])] {
        let law = find_friction_law(name).expect("it is registered");
        for pressure in [-2.0, -7.0, -9.0, -20.0] {
            let step = 1e-6;
            let [less, more] = [pressure - step, pressure + step].map(|p| bound(name, numbers, p, 0.3));
            let slope = (law.bound)(numbers, Sliding { pressure, speed: 0.3, temperature: 0.0 }).coefficient;
            assert!(((less - more) / (2.0 * step) - slope).abs() < 1e-8, "{name} at {pressure}");
        }
    }
}
