//! Unknowns of the framework's tests, registered as by an application.

use crate::{register_flags, register_rates, register_variable};

register_variable! {
    pub DISPLACEMENT: [f64; 3] = "Displacement of the tests.";
    pub VELOCITY: [f64; 3] = "Velocity of the tests.";
    pub ACCELERATION: [f64; 3] = "Acceleration of the tests.";
    pub NORMAL: [f64; 3] = "Normal of the tests.";
    pub REACTION: [f64; 3] = "Reaction of the tests.";
    pub ROTATION: [f64; 3] = "Rotation of the tests.";
}
register_flags! {
    pub SLAVE = "A mark of the tests.";
}
register_rates! { "DISPLACEMENT",
    first: "VELOCITY",
    second: Some("ACCELERATION"),
    reaction: Some("REACTION"),
    moves_mesh: true,
}
register_rates! { "ROTATION",
    first: "VELOCITY",
    turns: Some("DISPLACEMENT"),
}
