//! Contact: answers of every method against closed forms and against each other, whatever the mesh, the units and the numbering.

mod augmentation;
mod balance;
#[path = "../support/blocks.rs"]
mod blocks;
#[path = "../support/blocks_of_case.rs"]
mod blocks_of_case;
mod body_balance;
mod calculated_parameters;
mod clearance;
mod cohesive;
mod condensation;
mod corners;
mod elastic_start;
mod flange;
mod free_bodies;
mod friction_laws;
mod interface_surfaces;
mod lift_off;
mod like_kratos;
mod methods;
mod mpc;
mod nitsche;
mod penalty_friction;
mod penalty_twins;
mod refinement;
#[path = "../support/renumber.rs"]
mod renumber;
mod renumbering;
#[path = "../support/scene.rs"]
mod scene;
mod seal;
mod second_order;
mod sizes;
mod slivers;
#[path = "../support/specimen.rs"]
#[allow(dead_code, reason = "each test uses its part")]
mod specimen;
mod soft_contact;
mod spring_and_wall;
#[path = "../support/stacks.rs"]
mod stacks;
#[path = "../support/mod.rs"]
mod support;
mod supports;
#[path = "../support/thread_ranks.rs"]
mod thread_ranks;
mod units;
mod penetration_check;
mod wear;
mod whole_skin;
