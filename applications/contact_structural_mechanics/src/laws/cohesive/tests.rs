use zelus_core::parameters::Document;
use zelus_core::registry::named;
use zelus_core::vector3::norm;

use crate::law::bond::bond;
use crate::law::{
    Bond, BondOpening, BondState, Bound, CohesiveLaw, CohesiveLawEntry, Rubbing, SurfaceLaw, SurfaceNumbers,
};

fn law(text: &str) -> zelus_core::Result<Box<dyn CohesiveLaw>> {
    let (entry, settings) =
        named::<CohesiveLawEntry>(&Document::from_str(text, "deck.json").expect("JSON").root, "law")?;
    (entry.build)(&settings)
}

const STIFFNESS: [f64; 2] = [1e4, 4e3];
const STRENGTH: [f64; 2] = [30.0, 50.0];
const ENERGY: [f64; 2] = [0.3, 0.9];
const EXPONENT: f64 = 1.6;

fn of(name: &str) -> Box<dyn CohesiveLaw> {
    let shear = format!(
        r#", "shear_stiffness": {}, "shear_strength": {}, "shear_energy": {}, "mixed_mode_exponent": {EXPONENT}"#,
        STIFFNESS[1], STRENGTH[1], ENERGY[1]
    );
    let normal = format!(
        r#""law": "{name}", "normal_stiffness": {}, "normal_strength": {}, "normal_energy": {}"#,
        STIFFNESS[0], STRENGTH[0], ENERGY[0]
    );
    law(&format!("{{{normal}{}}}", if name == "adhesion" { "" } else { &shear })).expect("a law")
}

const BONDED: BondState =
    BondState { bonded: Some(true), start: 0.0, damage: 0.0, dissipated: 0.0, sliding: [0.0; 3], friction: [0.0; 3] };
const NONE: Bound = Bound { coefficient: 0.0, threshold: 0.0 };

/// A bond opened by a vector, normal along z, from its state before.
fn opened(law: &dyn CohesiveLaw, before: &BondState, [x, y, z]: [f64; 3], friction: Bound) -> Bond {
    let sliding = [x, y, 0.0];
    let trial = std::array::from_fn(|c| before.friction[c] + STIFFNESS[1] * (sliding[c] - before.sliding[c]));
    let of = SurfaceLaw { cohesive: Some(law), rubbing: Rubbing::default() };
    let numbers = SurfaceNumbers { friction, stiffness: STIFFNESS, active: z <= 0.0, secant: false };
    bond(of, before, BondOpening { gap: z, sliding, trial }, numbers)
}

/// ANALYTIC: onset and energy of fracture at a share of shear, by Benzeggagh and Kenane.
fn onset_and_energy(share: f64) -> [f64; 2] {
    let onset = [0, 1].map(|mode: usize| STRENGTH[mode].powi(2) / (2.0 * STIFFNESS[mode]));
    [onset, ENERGY].map(|[normal, shear]| normal + (shear - normal) * share.powf(EXPONENT))
}

/// ANALYTIC: traction, damage and dissipation of the bilinear law along straight paths of mode I, mode II and two mixtures; the
/// dissipated energy of a failed bond is G. Round-off.
#[test]
fn the_bilinear_law_is_exact_and_dissipates_its_energy() {
    let law = of("bilinear");
    for direction in [[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [0.6, 0.0, 0.8], [-0.3, 0.9, 0.2]] {
        let [x, y, z] = direction;
        let parts = [STIFFNESS[0] * z * z, STIFFNESS[1] * (x * x + y * y)];
        let [onset, energy] = onset_and_energy(parts[1] / (parts[0] + parts[1]));
        let first = (2.0 * onset / (parts[0] + parts[1])).sqrt();
        let last = first * energy / onset;
        let mut state = BONDED;
        for step in 1..=60 {
            let way = 1.1 * last * f64::from(step) / 60.0;
            let found = opened(law.as_ref(), &state, direction.map(|c| way * c), NONE);
            let damage = (last * (way - first) / (way * (last - first))).clamp(0.0, 1.0);
            assert!((found.state.damage - damage).abs() < 1e-12, "{direction:?}: {}", found.state.damage);
            let exact = [x * STIFFNESS[1], y * STIFFNESS[1], z * STIFFNESS[0]].map(|t| (1.0 - damage) * way * t);
            let [tx, ty, _] = found.tangent.tangential;
            let off = [tx - exact[0], ty - exact[1], found.tangent.normal - exact[2]];
            assert!(norm(off) < 1e-12 * STRENGTH[1], "{direction:?}: {off:?}");
            // Work less what is stored.
            if (first..last).contains(&way) {
                let top = 2.0 * onset / first;
                let work = onset + 0.5 * (way - first) * (top + top * (last - way) / (last - first));
                let stored = 0.5 * (1.0 - damage) * (parts[0] + parts[1]) * way * way;
                assert!((found.state.dissipated - (work - stored)).abs() < 1e-12 * energy);
            }
            state = found.state;
        }
        assert_eq!(state.damage, 1.0);
        assert!((state.dissipated - energy).abs() < 1e-12 * energy, "{direction:?}: {} {energy}", state.dissipated);
    }
}

/// ANALYTIC: the energy of fracture of the exponential law as the work of its traction, and its strength as its largest value. The
/// tolerance is that of the trapezoidal rule and of the end of the path, at exp(−40).
#[test]
fn the_exponential_law_takes_up_its_energy() {
    let law = of("exponential");
    for mode in [0, 1] {
        let first = STRENGTH[mode] / STIFFNESS[mode];
        let last = 40.0 * (ENERGY[mode] / STRENGTH[mode] - 0.5 * first) + first;
        let (mut state, mut work, mut before, mut largest) = (BONDED, 0.0, 0.0, 0.0_f64);
        let steps = 40_000;
        for step in 1..=steps {
            let way = last * f64::from(step) / f64::from(steps);
            let found = opened(law.as_ref(), &state, if mode == 0 { [0.0, 0.0, way] } else { [0.0, way, 0.0] }, NONE);
            let traction = [found.tangent.normal, found.tangent.tangential[1]][mode];
            (work, largest) = (work + 0.5 * (before + traction) * last / f64::from(steps), largest.max(traction));
            (state, before) = (found.state, traction);
        }
        assert!((work - ENERGY[mode]).abs() < 1e-4 * ENERGY[mode], "{work}");
        assert!((state.dissipated - ENERGY[mode]).abs() < 1e-9 * ENERGY[mode], "{}", state.dissipated);
        assert!((largest - STRENGTH[mode]).abs() < 1e-2 * STRENGTH[mode], "{largest}");
    }
}

/// A bond of any law unloads towards its origin, keeps its damage, and is as stiff as before under compression.
#[test]
fn bonds_unload_towards_their_origin() {
    for name in ["bilinear", "exponential", "adhesion"] {
        let law = of(name);
        let damaged = opened(law.as_ref(), &BONDED, [0.0, 0.0, 0.008], NONE);
        let damage = damaged.state.damage;
        assert!((0.2..0.9).contains(&damage), "{name}: {damage}");
        for share in [0.7, 0.3, 0.0] {
            let back = opened(law.as_ref(), &damaged.state, [0.0, 0.0, 0.008 * share], NONE);
            assert_eq!((back.state.damage, back.state.dissipated), (damage, damaged.state.dissipated));
            assert!((back.tangent.normal - share * damaged.tangent.normal).abs() < 1e-12, "{name}");
        }
        let pressed = opened(law.as_ref(), &damaged.state, [0.0, 0.0, -0.001], NONE);
        assert!((pressed.tangent.normal + 10.0).abs() < 1e-12 && !pressed.slides, "{name}");
    }
}

/// ANALYTIC: friction of the failed share, d μ p beside (1 − d) K_s w, and μ p once the bond has failed; elastic where it turns back.
#[test]
fn the_failed_share_of_a_bond_has_friction() {
    let (law, friction) = (of("bilinear"), Bound { coefficient: 0.4, threshold: 0.0 });
    let (way, pressure) = (0.02, STIFFNESS[0] * 1e-3);
    let found = opened(law.as_ref(), &BONDED, [way, 0.0, -1e-3], friction);
    let damage = found.state.damage;
    assert!((0.2..0.9).contains(&damage), "{damage}");
    let exact = (1.0 - damage) * STIFFNESS[1] * way + damage * 0.4 * pressure;
    assert!((found.tangent.tangential[0] - exact).abs() < 1e-12, "{} {exact}", found.tangent.tangential[0]);
    let failed = opened(law.as_ref(), &found.state, [0.2, 0.0, -1e-3], friction);
    assert!((failed.tangent.tangential[0] - 0.4 * pressure).abs() < 1e-12);
    assert_eq!((failed.slides, failed.state.damage), (true, 1.0));
    let turned = opened(law.as_ref(), &failed.state, [0.2 - 1e-4, 0.0, -1e-3], friction);
    assert!((turned.tangent.tangential[0] - (0.4 * pressure - 1e-4 * STIFFNESS[1])).abs() < 1e-12);
    assert!(!turned.slides);
    let apart = opened(law.as_ref(), &turned.state, [0.2, 0.0, 1e-3], friction);
    assert_eq!((apart.tangent.tangential, apart.tangent.normal, apart.slides), ([0.0; 3], 0.0, false));
    // Adhesion carries no shear, and its surface rubs as without bond.
    let adhesive = opened(of("adhesion").as_ref(), &BONDED, [way, 0.0, -1e-3], friction);
    assert!((adhesive.tangent.tangential[0] - 0.4 * pressure).abs() < 1e-12 && adhesive.state.damage == 0.0);
}

#[test]
fn laws_without_energy_for_their_strength_are_refused() {
    let with = |change: [&str; 2]| {
        let text = r#"{"law": "bilinear", "normal_stiffness": 1e4, "shear_stiffness": 1e4, "normal_strength": 30.0,
            "shear_strength": 30.0, "normal_energy": 0.3, "shear_energy": 0.3}"#;
        let changed = text.replace(change[0], change[1]);
        assert_ne!(text, changed);
        law(&changed).err().map(|error| error.to_string()).unwrap_or_default()
    };
    for (change, words) in [
        ([r#""normal_energy": 0.3"#, r#""normal_energy": 0.04"#], "would fail before it is damaged"),
        ([r#""shear_energy": 0.3"#, r#""mixed_mode_exponent": 2.0"#], "\"shear_energy\" is 0"),
        ([r#""shear_strength": 30.0"#, r#""shear_strength": -30.0"#], "shear_strength"),
        ([r#""shear_energy": 0.3"#, r#""shear_energy": 0.3, "mixed_mode_exponent": 0.5"#], "mixed_mode_exponent"),
        ([r#""bilinear""#, r#""bilinea""#], "\"bilinear\""),
    ] {
        let said = with(change);
        assert!(said.contains(words), "{change:?}: {said}");
    }
}
