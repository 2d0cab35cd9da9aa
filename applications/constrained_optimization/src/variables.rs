//! The variables of springs and walls.

use zelus_core::register_variable;

register_variable! {
    pub POSITION: f64 = "The unknown of a spring: the place of its free end (length).";
    pub CONSTRAINT_MULTIPLIER: f64 = "Multiplier of a constraint: the force between wall and spring, negative for g ≥ 0 and positive for g ≤ 0.";
    pub SECOND_CONSTRAINT_MULTIPLIER: f64 = "The other one of a pair of multipliers that share the force of a constraint.";
    pub CONSTRAINT_PENALTY: f64 = "Penalty parameter of a constraint as it stands (force per length).";
    pub CONSTRAINT_VIOLATION: f64 = "The larger of penetration and tension of a constraint; zero when it is obeyed.";
    kind SPRING_STIFFNESS: Scalar = "Stiffness k of a spring, f = k/2 d² or k/4 d⁴.";
    kind REST_POSITION: Scalar = "Position of a spring's free end without force.";
    kind CONSTRAINT_COEFFICIENTS: Vector = "Coefficients a of the linear constraint a·x + b ≤ 0, one a position.";
    kind CONSTRAINT_CONSTANT: Scalar = "Constant b of the linear constraint a·x + b ≤ 0.";
}
