//! Tying of meshes that do not match, by multipliers.

use zelus_core::register;

use crate::pairs::{Multiplier, TyingFormulation, TyingFormulationEntry};
use crate::register_pair_conditions;
use crate::variables::{SCALAR_LAGRANGE_MULTIPLIER, VECTOR_LAGRANGE_MULTIPLIER};

register! { TyingFormulationEntry "ScalarMeshTying",
    about: "ties one number a node of two meshes by a multiplier",
    source: "eqs. D.5, D.7 of an equality; D and M: Wohlmuth (2000)",
    build: TyingFormulation {
        multiplier: Multiplier::Scalar(&SCALAR_LAGRANGE_MULTIPLIER),
        variables: &[("NORMAL", 3), ("SCALAR_LAGRANGE_MULTIPLIER", 1), ("WEIGHTED_SCALAR_RESIDUAL", 1)],
    },
}
register! { TyingFormulationEntry "ComponentsMeshTying",
    about: "ties the components of a vector of two meshes by multipliers",
    source: "eqs. D.5, D.7 of an equality; D and M: Wohlmuth (2000)",
    build: TyingFormulation {
        multiplier: Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER),
        variables: &[("NORMAL", 3), ("VECTOR_LAGRANGE_MULTIPLIER", 3), ("WEIGHTED_VECTOR_RESIDUAL", 3)],
    },
}
register_pair_conditions! { "MeshTyingMortarCondition",
    about: "pair of the formulations ScalarMeshTying and ComponentsMeshTying",
    source: "eqs. D.5, D.7 of an equality; D and M: Wohlmuth (2000)"
}
