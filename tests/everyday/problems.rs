//! Problems of everyday engineering; lengths in mm, forces in N.

use std::f64::consts::{FRAC_PI_2, PI};

use serde_json::{Value, json};

use crate::grid::Vec3;
use crate::model::{Body, Model, high, low};
use crate::outcome::{Outcome, norm};

const STEEL: f64 = 210e3;
const POISSON: f64 = 0.3;

/// A deck with the sum of its loads, and its expected result.
pub struct Problem {
    pub model: Model,
    pub load: fn(f64) -> Vec3,
    /// Faults of an answer, in words.
    pub check: Box<dyn Fn(&Model, &Outcome) -> Vec<String>>,
}

/// A problem by its name, its coefficient of friction, its number of steps and how much finer its mesh is.
type Make = fn(Option<f64>, usize, usize) -> Problem;

/// Every problem with the number of steps that a first attempt would take.
pub const ALL: [(&str, Make, usize); 19] = [
    ("press_fit", press_fit, 2),
    ("lug_with_pin", lug_with_pin, 8),
    ("gear_pair", gear_pair, 8),
    ("snap_fit", snap_fit, 30),
    ("ring_between_plates", ring_between_plates, 8),
    ("stack_of_four", stack_of_four, 2),
    ("ball_in_socket", ball_in_socket, 8),
    ("tilted_landing", tilted_landing, 8),
    ("wedge", wedge, 5),
    ("initial_gap", initial_gap, 2),
    ("initial_penetration", initial_penetration, 1),
    ("strip_round_a_drum", strip_round_a_drum, 5),
    ("large_sliding", large_sliding, 20),
    ("flat_punch", flat_punch, 2),
    ("quarter_lug", quarter_lug, 4),
    ("tubes", tubes, 2),
    ("sharp_snap_fit", sharp_snap_fit, 30),
    ("beam_over_an_edge", beam_over_an_edge, 4),
    ("ball_on_block", ball_on_block, 3),
];

/// A fault when a number differs from the expected one by more than a share of it.
fn close(what: &str, found: f64, expected: f64, share: f64) -> Option<String> {
    let off = (found - expected).abs() / expected.abs();
    (off.is_nan() || off > share)
        .then(|| format!("{what} is {found:.5e}, not {expected:.5e}: off by {off:.1e}, allowed {share:.0e}"))
}

/// Radius along the first side, angle along the second.
fn polar(centre: [f64; 2], radii: [f64; 2], angles: [f64; 2]) -> impl Fn(Vec3) -> Vec3 {
    move |x| {
        let radius = radii[0] + (radii[1] - radii[0]) * x[0];
        let angle = angles[0] + (angles[1] - angles[0]) * x[1];
        [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin(), 0.0]
    }
}

fn rectangle(from: [f64; 2], to: [f64; 2]) -> impl Fn(Vec3) -> Vec3 {
    move |x| [from[0] + (to[0] - from[0]) * x[0], from[1] + (to[1] - from[1]) * x[1], 0.0]
}

const FREE: Value = Value::Null;

/// Holds two opposite nodes of a ring on each axis, where it goes round.
fn hold_ring(model: &mut Model, ring: &Body, rim: impl Fn(Vec3) -> bool) {
    let at = |places: [f64; 2]| ring.nodes(|x| rim(x) && places.iter().any(|y| (x[1] - y).abs() < 1e-9));
    model.fix(&at([0.0, 0.5]), [FREE, json!(0), FREE]);
    model.fix(&at([0.25, 0.75]), [json!(0), FREE, FREE]);
}

fn no_load(_: f64) -> Vec3 {
    [0.0; 3]
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A ring whose hole is too small on a tube: Lamé's pressure, here by the widening of the ring.
fn press_fit(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let (inner, radius, outer, interference) = (5.0, 10.0, 20.0, 0.05);
    let mut model = Model::new(2, friction, steps);
    let tube = model.body(&[3 * finer, 32 * finer], STEEL, POISSON, polar([0.0; 2], [inner, radius], [0.0, 2.0 * PI]));
    let ring = polar([0.0; 2], [radius - interference, outer], [0.0, 2.0 * PI]);
    let ring = model.body(&[6 * finer, 96 * finer], STEEL, POISSON, ring);
    hold_ring(&mut model, &tube, low(0));
    hold_ring(&mut model, &ring, high(0));
    model.contact(ring.facets(low(0)), tube.facets(high(0)));
    let rim = ring.nodes(high(0));
    let check = move |model: &Model, outcome: &Outcome| {
        let (young, poisson) = (STEEL / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
        let ratio = |a: f64, b: f64| (a * a + b * b) / (a * a - b * b);
        // polygons lie inside their circles by this on average
        let sagging = |sides: usize| radius * (PI / (sides * finer) as f64).powi(2) / 6.0;
        let interference = interference + sagging(96) - sagging(72);
        let pressure =
            interference * young / radius / (ratio(outer, radius) + poisson + ratio(radius, inner) - poisson);
        let widening = 2.0 * pressure * radius * radius * outer / (young * (outer * outer - radius * radius));
        let along = |&n: &usize| {
            let (x, u) = (model.nodes[n], outcome.last().displacement[n]);
            (x[0] * u[0] + x[1] * u[1]) / norm(x)
        };
        let found: Vec<f64> = rim.iter().map(along).collect();
        let spread = found.iter().map(|u| (u - mean(&found)).abs()).fold(0.0, f64::max);
        let mut faults: Vec<String> = close("widening", mean(&found), widening, 0.03).into_iter().collect();
        faults.extend(
            (spread > 0.02 * widening).then(|| format!("the rim is out of round by {:.1e}", spread / widening)),
        );
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A pin with play that is pulled in the hole of a plate; the answer is symmetric.
fn lug_with_pin(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let plate = |x: Vec3| {
        let angle = 2.0 * PI * x[1];
        let (c, s) = (angle.cos(), angle.sin());
        let square = 12.0 / c.abs().max(s.abs());
        let radius = 5.0 + (square - 5.0) * x[0].powf(1.3);
        [radius * c, radius * s, 0.0]
    };
    let plate = model.body(&[6 * finer, 48 * finer], STEEL, POISSON, plate);
    let pin = model.body(&[4 * finer, 56 * finer], STEEL, POISSON, polar([0.0; 2], [2.0, 4.95], [0.0, 2.0 * PI]));
    let edge = plate.nodes(|x| x[0] > 1.0 - 1e-9 && (x[1] - 0.5).abs() < 0.125 + 1e-9);
    model.fix(&edge, [json!(0), json!(0), FREE]);
    let hub = pin.nodes(low(0));
    model.fix(&hub, [json!("0.1*t"), json!(0), FREE]);
    model.contact(pin.facets(high(0)), plate.facets(low(0)));
    let check = move |model: &Model, outcome: &Outcome| {
        let state = outcome.last();
        let pull = state.sum(&hub);
        let sideways = (pull[1] / pull[0]).abs();
        let mut faults: Vec<String> = (sideways.is_nan() || sideways > 1e-3)
            .then(|| format!("sideways force {sideways:.1e}"))
            .into_iter()
            .collect();
        let turning = state.moment(&hub, [0.1, 0.0, 0.0]).abs() / (5.0 * pull[0].abs());
        faults.extend(
            (turning > 1e-3).then(|| format!("the pin turns by a moment of {turning:.1e} of force and radius")),
        );
        faults.extend((state.touching(model).len() < 5).then(|| "fewer than five nodes touch".to_owned()));
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// Two wheels with round teeth; one is turned, the other held.
fn gear_pair(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let (radius, height, teeth, hub, play) = (12.0, 1.0, 12.0, 7.0, 0.1);
    let apart = 2.0 * radius + play;
    let mut model = Model::new(2, friction, steps);
    let wheel = |centre: f64, sign: f64| {
        move |x: Vec3| {
            let angle = 2.0 * PI * x[1];
            let tip = radius + sign * height * (teeth * angle).cos();
            let at = hub + (tip - hub) * x[0];
            [centre + at * angle.cos(), at * angle.sin(), 0.0]
        }
    };
    let first = model.body(&[5 * finer, 144 * finer], STEEL, POISSON, wheel(0.0, 1.0));
    let second = model.body(&[5 * finer, 120 * finer], STEEL, POISSON, wheel(apart, -1.0));
    let (driving, driven) = (first.nodes(low(0)), second.nodes(low(0)));
    let turn = 0.02;
    let x = format!("X*(cos({turn}*t)-1)-Y*sin({turn}*t)");
    let y = format!("X*sin({turn}*t)+Y*(cos({turn}*t)-1)");
    model.fix(&driving, [json!(x), json!(y), FREE]);
    model.fix(&driven, [json!(0), json!(0), FREE]);
    model.contact(first.facets(high(0)), second.facets(high(0)));
    let check = move |_: &Model, outcome: &Outcome| {
        let state = outcome.last();
        let [one, other] = [state.moment(&driving, [0.0; 3]), state.moment(&driven, [0.0; 3])];
        let mut faults: Vec<String> =
            close("moment of the held wheel about the axis of the other", -other, one, 5e-3).into_iter().collect();
        faults.extend((one.abs() < 1.0).then(|| "no moment is transmitted".to_owned()));
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A hook that bends over a ridge, both with round tops, and is free behind it.
fn snap_fit(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let bump = |x: f64, half: f64| if x.abs() < half { 0.5 + 0.5 * (PI * x / half).cos() } else { 0.0 };
    hook_over_ridge(friction, steps, finer, bump, 1e-6)
}

/// A hook that bends over a ridge, with tops of the form `bump` (place, half-width), and is free behind it to `free` mm.
fn hook_over_ridge(
    friction: Option<f64>,
    steps: usize,
    finer: usize,
    bump: impl Fn(f64, f64) -> f64 + Copy,
    free: f64,
) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let hook = move |x: Vec3| {
        let along = 20.0 * x[0];
        let below = -bump(along - 17.5, 2.5);
        [along, below + (1.0 - below) * x[1], 0.0]
    };
    let base = move |x: Vec3| {
        let along = 18.0 + 12.0 * x[0];
        [along, -4.0 + (bump(along - 22.5, 2.0) + 2.8) * x[1], 0.0]
    };
    let hook = model.body(&[40 * finer, 3 * finer], 2e3, POISSON, hook);
    let base = model.body(&[24 * finer, 4 * finer], 2e3, POISSON, base);
    model.fix(&hook.nodes(low(0)), [json!("8*t"), json!(0), FREE]);
    model.fix(&base.nodes(low(1)), [json!(0), json!(0), FREE]);
    model.contact(hook.facets(low(1)), base.facets(high(1)));
    let tip = hook.nodes(high(0));
    let check = move |_: &Model, outcome: &Outcome| {
        let lift = outcome.states.iter().map(|s| s.displacement[tip[0]][1]).fold(0.0, f64::max);
        let mut faults: Vec<String> =
            (lift < 0.7).then(|| format!("the hook is lifted by {lift:.3} only")).into_iter().collect();
        let end = outcome.last().displacement[tip[0]];
        faults.extend(
            ((end[0] - 8.0).abs().max(end[1].abs()) > free).then(|| format!("at last the hook is not free: {end:?}")),
        );
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A ring pressed between two plates, one half of it; its middle goes down by half.
fn ring_between_plates(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let ring =
        model.body(&[2 * finer, 32 * finer], STEEL, POISSON, polar([0.0; 2], [8.0, 10.0], [-FRAC_PI_2, FRAC_PI_2]));
    let above = model.body(&[12 * finer, 2 * finer], STEEL, POISSON, rectangle([0.0, 10.0], [12.0, 12.0]));
    let below = model.body(&[12 * finer, 2 * finer], STEEL, POISSON, rectangle([0.0, -12.0], [12.0, -10.0]));
    model.fix(&ring.nodes(|x| low(1)(x) || high(1)(x)), [json!(0), FREE, FREE]);
    for plate in [&above, &below] {
        model.fix(&plate.nodes(low(0)), [json!(0), FREE, FREE]);
    }
    model.fix(&above.nodes(high(1)), [json!(0), json!("-1.0*t"), FREE]);
    model.fix(&below.nodes(low(1)), [json!(0), json!(0), FREE]);
    let outside = |from: f64, to: f64| ring.facets(move |x| x[0] > 1.0 - 1e-9 && (from..=to).contains(&x[1]));
    model.contact(outside(0.5, 1.0), above.facets(low(1)));
    model.contact(outside(0.0, 0.5), below.facets(high(1)));
    let middle = ring.nodes(|x| (x[1] - 0.5).abs() < 1e-9);
    let check = move |_: &Model, outcome: &Outcome| {
        let down: Vec<f64> = middle.iter().map(|&n| outcome.last().displacement[n][1]).collect();
        close("the way down of the middle", mean(&down), -0.5, 1e-3).into_iter().collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// Four blocks of unlike meshes under pressure, half of them.
fn stack_of_four(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let (height, width, pressure, young) = (5.0, 10.0, 1.0, 1000.0);
    let blocks: Vec<Body> = (0..4)
        .map(|at| {
            let (from, columns) = (height * f64::from(at), [5, 7, 4, 6][at as usize]);
            model.body(&[columns * finer, 3 * finer], young, POISSON, rectangle([0.0, from], [width, from + height]))
        })
        .collect();
    for block in &blocks {
        model.fix(&block.nodes(low(0)), [json!(0), FREE, FREE]);
    }
    model.fix(&blocks[0].nodes(low(1)), [FREE, json!(0), FREE]);
    model.load(blocks[3].facets(high(1)), [0.0, -pressure, 0.0], "t");
    for pair in blocks.windows(2) {
        model.contact(pair[1].facets(low(1)), pair[0].facets(high(1)));
    }
    let top = blocks[3].nodes(high(1));
    let check = move |_: &Model, outcome: &Outcome| {
        let down = -pressure * 4.0 * height * (1.0 - POISSON * POISSON) / young;
        // strains of 1e-3 are not quite small
        top.iter()
            .filter_map(|&n| close("the way down", outcome.last().displacement[n][1], down, 4e-3))
            .take(1)
            .collect()
    };
    Problem { model, load: |t| [0.0, -10.0 * t, 0.0], check: Box::new(check) }
}

/// A ball, as a cylinder, in a socket with little play, half of it.
fn ball_in_socket(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let ball =
        model.body(&[4 * finer, 26 * finer], STEEL, POISSON, polar([0.0; 2], [2.0, 9.95], [-FRAC_PI_2, FRAC_PI_2]));
    let socket = model.body(&[3 * finer, 17 * finer], STEEL, POISSON, polar([0.0; 2], [10.0, 16.0], [-FRAC_PI_2, 0.0]));
    let core = ball.nodes(low(0));
    model.fix(&ball.nodes(|x| low(1)(x) || high(1)(x)), [json!(0), FREE, FREE]);
    model.fix(&core, [json!(0), json!("-0.2*t"), FREE]);
    model.fix(&socket.nodes(low(1)), [json!(0), FREE, FREE]);
    model.fix(&socket.nodes(high(0)), [json!(0), json!(0), FREE]);
    model.contact(ball.facets(|x| high(0)(x) && x[1] < 0.5 + 1e-9), socket.facets(low(0)));
    let check = move |model: &Model, outcome: &Outcome| {
        let counts: Vec<usize> = outcome.states.iter().map(|state| state.touching(model).len()).collect();
        let grows = counts.windows(2).all(|pair| pair[0] <= pair[1]);
        (!grows || counts.last() < Some(&8))
            .then(|| format!("the contact does not grow: {counts:?}"))
            .into_iter()
            .collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A block in space that comes down tilted, first with a corner.
fn tilted_landing(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(3, friction, steps);
    let tilt = 0.03_f64;
    let block = move |x: Vec3| {
        let [x, y, z] = [6.0 * x[0], 6.0 * x[1], 3.0 * x[2]];
        [x + tilt * z, y + 0.5 * tilt * z, 0.05 + z + tilt * (6.0 - x) + 0.5 * tilt * (6.0 - y)]
    };
    let block = model.body(&[4 * finer, 4 * finer, 2 * finer], STEEL, POISSON, block);
    let base = |x: Vec3| [-2.0 + 10.0 * x[0], -2.0 + 10.0 * x[1], -2.0 + 2.0 * x[2]];
    let base = model.body(&[5 * finer, 5 * finer, finer], STEEL, POISSON, base);
    model.fix(&block.nodes(high(2)), [json!(0), json!(0), json!("-0.5*t")]);
    model.fix(&base.nodes(low(2)), [json!(0), json!(0), json!(0)]);
    let slave = block.facets(low(2));
    let all = block.nodes(low(2)).len();
    model.contact(slave, base.facets(high(2)));
    let check = move |model: &Model, outcome: &Outcome| {
        let [first, last] = [&outcome.states[0], outcome.last()].map(|state| state.touching(model).len());
        (first >= all || last < all)
            .then(|| format!("{first} nodes touch at first and {last} at last of {all}"))
            .into_iter()
            .collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A wedge that is driven along a slope of 15°, half of it: forces stand to each other as on paper.
fn wedge(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let angle = PI / 12.0;
    let slope = move |y: f64| 2.0 + y * angle.tan();
    let wedge = move |x: Vec3| [slope(10.0 * x[1]) * x[0], 10.0 * x[1], 0.0];
    let wedge = model.body(&[3 * finer, 8 * finer], 10.0 * STEEL, POISSON, wedge);
    let wall = move |x: Vec3| {
        let y = -3.0 + 16.0 * x[1];
        [slope(y) + (12.0 - slope(y)) * x[0], y, 0.0]
    };
    let wall = model.body(&[5 * finer, 11 * finer], STEEL, POISSON, wall);
    model.fix(&wedge.nodes(low(0)), [json!(0), FREE, FREE]);
    model.fix(&wedge.nodes(high(1)), [FREE, json!("-0.2*t"), FREE]);
    let back = wall.nodes(high(0));
    model.fix(&back, [json!(0), json!(0), FREE]);
    model.contact(wedge.facets(high(0)), wall.facets(low(0)));
    let check = move |_: &Model, outcome: &Outcome| {
        let force = outcome.last().sum(&back);
        // the slope bends a little under the wedge
        close("ratio of forces", -force[1] / force[0], (angle + friction.unwrap_or(0.0).atan()).tan(), 0.03)
            .into_iter()
            .collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

fn two_blocks(friction: Option<f64>, steps: usize, finer: usize, gap: f64) -> (Model, Body, Body) {
    let mut model = Model::new(2, friction, steps);
    let base = model.body(&[6 * finer, 3 * finer], 1000.0, POISSON, rectangle([0.0, -5.0], [10.0, 0.0]));
    let block = model.body(&[5 * finer, 3 * finer], 1000.0, POISSON, rectangle([0.0, gap], [10.0, 5.0 + gap]));
    for body in [&base, &block] {
        model.fix(&body.nodes(low(0)), [json!(0), FREE, FREE]);
    }
    model.fix(&base.nodes(low(1)), [FREE, json!(0), FREE]);
    model.contact(block.facets(low(1)), base.facets(high(1)));
    (model, base, block)
}

/// A block that pressure drives through a gap of a tenth of a mesh size onto another.
fn initial_gap(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let gap = 0.2;
    let (mut model, _, block) = two_blocks(friction, steps, finer, gap);
    model.load(block.facets(high(1)), [0.0, -1.0, 0.0], "t");
    let top = block.nodes(high(1));
    let check = move |_: &Model, outcome: &Outcome| {
        let down = -gap - 10.0 * (1.0 - POISSON * POISSON) / 1000.0;
        top.iter()
            .filter_map(|&n| close("the way down", outcome.last().displacement[n][1], down, 1e-3))
            .take(1)
            .collect()
    };
    Problem { model, load: |t| [0.0, -10.0 * t, 0.0], check: Box::new(check) }
}

/// Two blocks that are meshed into each other are pressed apart in the first step.
fn initial_penetration(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let depth = 0.02;
    let (mut model, base, block) = two_blocks(friction, steps, finer, -depth);
    model.fix(&block.nodes(high(1)), [FREE, json!(0), FREE]);
    let bottom = base.nodes(low(1));
    let check = move |_: &Model, outcome: &Outcome| {
        let force = 1000.0 / (1.0 - POISSON * POISSON) * depth / 10.0 * 10.0;
        // strains of 2e-3 are not quite small
        close("force", outcome.last().sum(&bottom)[1], force, 0.01).into_iter().collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A strip round a quarter of a drum, pulled over it: equal forces at its ends, or Euler's and Eytelwein's ratio.
fn strip_round_a_drum(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let (radius, thick, tail) = (10.0, 0.5, 5.0);
    let arc = radius * FRAC_PI_2;
    let strip = move |x: Vec3| {
        let (along, r) = ((arc + 2.0 * tail) * x[1] - tail, radius + thick * x[0]);
        let angle = (along / radius).clamp(0.0, FRAC_PI_2);
        let beyond = along - angle * radius;
        [r * angle.cos() - beyond * angle.sin(), r * angle.sin() + beyond * angle.cos(), 0.0]
    };
    let strip = model.body(&[2 * finer, 52 * finer], STEEL, POISSON, strip);
    let drum = polar([0.0; 2], [6.0, radius], [-0.3, FRAC_PI_2 + 0.3]);
    let drum = model.body(&[3 * finer, 30 * finer], 10.0 * STEEL, POISSON, drum);
    let (pulled, held) = (strip.nodes(low(1)), strip.nodes(high(1)));
    model.fix(&pulled, [FREE, json!("-0.05*t"), FREE]);
    model.fix(&held, [json!(0), FREE, FREE]);
    model.fix(&drum.nodes(low(0)), [json!(0), json!(0), FREE]);
    model.contact(strip.facets(low(0)), drum.facets(high(0)));
    let check = move |_: &Model, outcome: &Outcome| {
        let state = outcome.last();
        let ratio = state.sum(&pulled)[1] / state.sum(&held)[0];
        // the strip's middle runs on a larger radius than its friction acts on
        let lever = radius / (radius + 0.5 * thick);
        close("ratio of the forces", ratio, (friction.unwrap_or(0.0) * FRAC_PI_2 * lever).exp(), 0.03)
            .into_iter()
            .collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A block that is pressed on a long base and pushed along it; the base is the slave, whose nodes come and go.
fn large_sliding(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(2, friction, steps);
    let base = model.body(&[30 * finer, 3 * finer], STEEL, POISSON, rectangle([0.0, -2.0], [18.0, 0.0]));
    let block = model.body(&[6 * finer, 3 * finer], STEEL, POISSON, rectangle([2.0, 0.0], [6.0, 2.0]));
    model.fix(&base.nodes(low(1)), [json!(0), json!(0), FREE]);
    let top = block.nodes(high(1));
    // down until t = 0.1, then along
    let motion = [json!("10*(t-0.1+abs(t-0.1))/1.8"), json!("-0.05*(t+0.1-abs(t-0.1))"), FREE];
    model.fix(&top, motion);
    model.contact(base.facets(high(1)), block.facets(low(1)));
    let check = move |_: &Model, outcome: &Outcome| {
        let mut faults = Vec::new();
        for state in outcome.states.iter().skip(outcome.states.len() / 4) {
            let force = state.sum(&top);
            // the corners of the block dig in, and stand at a slope of some hundredths there
            let off = force[0] / -force[1] - friction.unwrap_or(0.0);
            faults.extend((off.is_nan() || off.abs() > 0.03).then(|| format!("push over load is off by {off:.1e}")));
        }
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// How a flat punch and the base below it are meshed, and which of them is the slave.
#[derive(Clone, Copy)]
pub struct Punch {
    pub dim: usize,
    pub simplices: bool,
    /// Columns of the base and of the punch.
    pub columns: [usize; 2],
    /// How far the punch is off the middle.
    pub off: f64,
    pub base_is_slave: bool,
}

/// A flat punch on a wider base: surfaces of the slave end within facets of the base, or those of the base beyond the punch.
pub fn punch(friction: Option<f64>, steps: usize, of: Punch) -> Problem {
    let Punch { dim, simplices, columns: [wide, narrow], off, base_is_slave } = of;
    let mut model = Model::new(dim, friction, steps);
    model.simplices = simplices;
    let up = dim - 1;
    let place = move |x: Vec3, half: f64, off: f64, low: f64| -> Vec3 {
        std::array::from_fn(|c| match c {
            _ if c == up => low + x[c],
            _ if c < dim => off + half * (2.0 * x[c] - 1.0),
            _ => 0.0,
        })
    };
    let rows = |columns: usize, rows: usize| [vec![columns; up], vec![rows]].concat();
    let base = model.body(&rows(wide, 2), 1e3, POISSON, |x| place(x, 1.5, 0.0, -1.0));
    let top = model.body(&rows(narrow, 2), 2e3, POISSON, |x| place(x, 1.0, off, 0.0));
    let moved = |depth: &str| -> [Value; 3] {
        std::array::from_fn(|c| {
            if c == up {
                json!(depth)
            } else if c < dim {
                json!(0)
            } else {
                FREE
            }
        })
    };
    let bottom = base.nodes(low(up));
    model.fix(&bottom, moved("0"));
    model.fix(&top.nodes(high(up)), moved("-0.02*t"));
    let (of_base, of_top) = (base.facets(high(up)), top.facets(low(up)));
    match base_is_slave {
        true => model.contact(of_base, of_top),
        false => model.contact(of_top, of_base),
    }
    let check = move |_: &Model, outcome: &Outcome| {
        let forces: Vec<f64> = outcome.states.iter().map(|state| state.sum(&bottom)[up]).collect();
        let per_step = forces[0];
        let straight =
            forces.iter().enumerate().find(|(at, force)| (*force / per_step - 1.0 - *at as f64).abs() > 0.05);
        straight
            .filter(|_| friction.is_none())
            .map(|(at, force)| format!("step {}: the force is {force:.3e}, the first {per_step:.3e}", at + 1))
            .into_iter()
            .chain((per_step < 1.0).then(|| format!("the force is {per_step:.3e}")))
            .collect()
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A flat punch in space on a finer base, which is the slave.
fn flat_punch(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let columns = [6 * finer, 4 * finer];
    punch(friction, steps, Punch { dim: 3, simplices: false, columns, off: 0.0, base_is_slave: true })
}

/// A pin with play that is pulled in the hole of a plate, in space: half of the length and half of the width.
fn quarter_lug(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(3, friction, steps);
    let plate = |x: Vec3| {
        let angle = PI * x[1];
        let (c, s) = (angle.cos(), angle.sin());
        let radius = 2.0 + (4.0 / c.abs().max(s.abs()) - 2.0) * x[0].powf(1.3);
        [radius * c, radius * s, x[2]]
    };
    let plate = model.body(&[4 * finer, 10 * finer, 2 * finer], STEEL, POISSON, plate);
    let pin = |x: Vec3| {
        let ([x, y, _], z) = (polar([0.0; 2], [0.6, 1.98], [0.0, PI])(x), 1.5 * x[2]);
        [x, y, z]
    };
    let pin = model.body(&[3 * finer, 14 * finer, 3 * finer], STEEL, POISSON, pin);
    for body in [&plate, &pin] {
        model.fix(&body.nodes(|x| low(1)(x) || high(1)(x)), [FREE, json!(0), FREE]);
        model.fix(&body.nodes(low(2)), [FREE, FREE, json!(0)]);
    }
    let held = plate.nodes(|x| high(0)(x) && x[1] > 0.75 - 1e-9);
    model.fix(&held, [json!(0), FREE, FREE]);
    let pulled = pin.nodes(low(0));
    model.fix(&pulled, [json!("0.1*t"), FREE, FREE]);
    model.contact(pin.facets(high(0)), plate.facets(low(0)));
    let check = move |model: &Model, outcome: &Outcome| {
        let state = outcome.last();
        let mut faults: Vec<String> =
            close("pull on the pin", state.sum(&pulled)[0], -state.sum(&held)[0], 2e-3).into_iter().collect();
        faults.extend((state.touching(model).len() < 12).then(|| "fewer than twelve nodes touch".to_owned()));
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A quarter of a tube that is meshed into another, both of unlike lengths, pressed apart and then pushed out.
fn tubes(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(3, friction, steps);
    let tube = |radii: [f64; 2], ends: [f64; 2]| {
        move |x: Vec3| {
            let [a, b, _] = polar([0.0; 2], radii, [0.0, FRAC_PI_2])(x);
            [a, b, ends[0] + (ends[1] - ends[0]) * x[2]]
        }
    };
    let inner = model.body(&[2 * finer, 9 * finer, 2 * finer], STEEL, POISSON, tube([1.5, 2.005], [0.0, 2.0]));
    let outer = model.body(&[2 * finer, 12 * finer, 3 * finer], STEEL, POISSON, tube([2.0, 3.0], [-0.3, 2.2]));
    for body in [&inner, &outer] {
        model.fix(&body.nodes(low(1)), [FREE, json!(0), FREE]);
        model.fix(&body.nodes(high(1)), [json!(0), FREE, FREE]);
    }
    let held = outer.nodes(low(2));
    model.fix(&held, [FREE, FREE, json!(0)]);
    let inside = inner.nodes(low(1));
    let pushed = inner.nodes(high(2));
    model.fix(&pushed, [FREE, FREE, json!("0.1*(t-0.5+abs(t-0.5))")]);
    model.contact(outer.facets(low(0)), inner.facets(high(0)));
    let check = move |_: &Model, outcome: &Outcome| {
        let state = outcome.last();
        let push = state.sum(&pushed)[2];
        let mut faults: Vec<String> = Vec::new();
        if let Some(friction) = friction {
            // normal force of a uniform pressure over a quarter: π/2 times its component along y
            let pressed = FRAC_PI_2 * state.sum(&inside)[1].abs();
            faults.extend(close("push over friction", push, friction * pressed, 0.05));
            faults.extend(close("push of the other", push, -state.sum(&held)[2], 5e-3));
        } else {
            let largest = state.reaction.iter().map(|&r| norm(r)).fold(0.0, f64::max);
            faults.extend((push.abs() > 0.05 * largest).then(|| format!("a push of {push:.1e} without friction")));
        }
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}

/// A hook with a sharp edge that bends over a sharp ridge and is free behind it.
fn sharp_snap_fit(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    hook_over_ridge(friction, steps, finer, |x, half| (1.0 - x.abs() / half).max(0.0), 5e-3)
}

/// A slender beam in space that a load bends over the sharp edge of a block.
fn beam_over_an_edge(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    let mut model = Model::new(3, friction, steps);
    let beam = |x: Vec3| [10.0 * x[0], 2.0 * x[1], 0.05 + 0.4 * x[2]];
    let beam = model.body(&[16 * finer, 3 * finer, 2 * finer], 1e5, POISSON, beam);
    let block = |x: Vec3| [5.0 + 3.0 * x[0], -0.3 + 2.6 * x[1], -2.0 + 2.0 * x[2]];
    let block = model.body(&[5 * finer, 2 * finer, 3 * finer], 2e5, POISSON, block);
    model.fix(&beam.nodes(low(0)), [json!(0), json!(0), json!(0)]);
    let ground = block.nodes(low(2));
    model.fix(&ground, [json!(0), json!(0), json!(0)]);
    model.load(beam.facets(high(0)), [0.0, 0.0, -30.0], "t");
    let skin = [block.facets(high(2)), block.facets(high(0)), block.facets(low(0))].concat();
    model.contact(beam.facets(low(2)), skin);
    let check = move |_: &Model, outcome: &Outcome| {
        // the beam pulls up at its clamp
        let force = outcome.last().sum(&ground)[2];
        (force < 24.0).then(|| format!("the block bears {force:.3e}, less than the load")).into_iter().collect()
    };
    Problem { model, load: |t| [0.0, 0.0, -24.0 * t], check: Box::new(check) }
}

/// A cap of a ball on a block, which is the slave: Hertz's force grows as the depth to the power of 3/2.
fn ball_on_block(friction: Option<f64>, steps: usize, finer: usize) -> Problem {
    ball(friction, steps, [8 * finer, 9 * finer], 0.1, false)
}

/// See [`ball_on_block`]: columns of ball and block, how deep the ball is pushed, and whether it is the slave.
pub fn ball(friction: Option<f64>, steps: usize, [own, wide]: [usize; 2], depth: f64, is_slave: bool) -> Problem {
    let mut model = Model::new(3, friction, steps);
    let cap = |x: Vec3| {
        let [a, b] = [0, 1].map(|c: usize| (0.7 * (2.0 * x[c] - 1.0)).tan());
        let radius = (2.0 - 0.8 * x[2]) / (1.0 + a * a + b * b).sqrt();
        [radius * a, radius * b, 2.0 - radius]
    };
    let cap = model.body(&[own, own, own / 4 + 1], STEEL, POISSON, cap);
    let block = |x: Vec3| [3.0 * x[0] - 1.5, 3.0 * x[1] - 1.5, 1.5 * x[2] - 1.5];
    let block = model.body(&[wide, wide, wide / 3], STEEL, POISSON, block);
    let pushed = cap.nodes(high(2));
    model.fix(&pushed, [json!(0), json!(0), json!(format!("-{depth:?}*t"))]);
    let ground = block.nodes(low(2));
    model.fix(&ground, [json!(0), json!(0), json!(0)]);
    let (of_block, of_cap) = (block.facets(high(2)), cap.facets(low(2)));
    match is_slave {
        true => model.contact(of_cap, of_block),
        false => model.contact(of_block, of_cap),
    }
    let check = move |_: &Model, outcome: &Outcome| {
        let sum = outcome.last().sum(&ground);
        let aside = (sum[0].hypot(sum[1])) / sum[2];
        let mut faults: Vec<String> =
            (aside > 1e-3).then(|| format!("a force aside of {aside:.1e}")).into_iter().collect();
        let forces: Vec<f64> = outcome.states.iter().map(|state| state.sum(&ground)[2]).collect();
        faults.extend((!forces.windows(2).all(|pair| pair[0] < pair[1])).then(|| format!("forces {forces:?}")));
        faults
    };
    Problem { model, load: no_load, check: Box::new(check) }
}
