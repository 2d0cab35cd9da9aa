//! The variables of structural mechanics.

use zelus_core::register_variable;

register_variable! {
    pub POINT_LOAD: [f64; 3] = "Force on a point (force).";
    pub LINE_LOAD: [f64; 3] = "Force per present length of a line (force per length).";
    pub SURFACE_LOAD: [f64; 3] = "Force per present area of a surface (force per area).";
    pub VOLUME_ACCELERATION: [f64; 3] = "Acceleration that acts on the mass, e.g. gravity (length per time squared).";
    pub PRESSURE: f64 = "Pressure on a face; acts as NEGATIVE_FACE_PRESSURE does (force per area).";
    pub POSITIVE_FACE_PRESSURE: f64 =
        "Pressure on the side the normal points from: a line is pushed to its right, a surface against t1 × t2.";
    pub NEGATIVE_FACE_PRESSURE: f64 =
        "Pressure on the other side: a line is pushed to the left of its direction, a surface along t1 × t2.";
    kind YOUNG_MODULUS: Scalar = "Young's modulus (force per area).";
    kind POISSON_RATIO: Scalar = "Poisson's ratio.";
    kind DENSITY: Scalar = "Mass per initial volume.";
    kind THICKNESS: Scalar = "Thickness of a planar model (length).";
    kind INTEGRATION_ORDER: Integer = "Order of the Gauss rule of an element, 1 to 5, instead of its default.";
    kind COMPUTE_LUMPED_MASS_MATRIX: Boolean = "Whether the mass matrix is diagonal.";
    kind RAYLEIGH_ALPHA: Scalar = "Factor of the mass matrix in Rayleigh damping (per time).";
    kind RAYLEIGH_BETA: Scalar = "Factor of the stiffness matrix in Rayleigh damping (time).";
    kind CAUCHY_STRESS_VECTOR: Vector = "Cauchy stress: xx yy (zz) xy (yz xz) (force per area).";
    kind PK2_STRESS_VECTOR: Vector = "Second Piola–Kirchhoff stress, components as CAUCHY_STRESS_VECTOR.";
    kind KIRCHHOFF_STRESS_VECTOR: Vector = "Kirchhoff stress det F σ, components as CAUCHY_STRESS_VECTOR.";
    kind STRAIN: Vector = "Strain of the element: small or Green–Lagrange, twice the tensor's shear components.";
    kind GREEN_LAGRANGE_STRAIN_VECTOR: Vector = "Green–Lagrange strain (small strain in small-displacement elements).";
    kind ALMANSI_STRAIN_VECTOR: Vector = "Almansi strain, where the law distinguishes it.";
    kind CAUCHY_STRESS_TENSOR: Matrix = "Cauchy stress as a square matrix.";
    kind PK2_STRESS_TENSOR: Matrix = "Second Piola–Kirchhoff stress as a square matrix.";
    kind KIRCHHOFF_STRESS_TENSOR: Matrix = "Kirchhoff stress as a square matrix.";
    kind GREEN_LAGRANGE_STRAIN_TENSOR: Matrix = "Green–Lagrange strain as a square matrix.";
    kind ALMANSI_STRAIN_TENSOR: Matrix = "Almansi strain as a square matrix.";
    kind DEFORMATION_GRADIENT: Matrix = "Deformation gradient ∂x/∂X.";
    kind VON_MISES_STRESS: Scalar = "Equivalent stress of von Mises (force per area).";
    kind STRAIN_ENERGY: Scalar = "Stored energy per initial volume.";
    kind INTEGRATION_WEIGHT: Scalar = "Part of the initial volume that a Gauss point stands for.";
}
