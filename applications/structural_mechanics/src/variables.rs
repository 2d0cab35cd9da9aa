//! The variables of structural mechanics.

use zelus_core::{register_material_range, register_rates, register_usual_results, register_variable};

register_variable! {
    pub DISPLACEMENT: [f64; 3] = "Displacement from the initial position (length).";
    pub VELOCITY: [f64; 3] = "Velocity (length per time).";
    pub ACCELERATION: [f64; 3] = "Acceleration (length per time squared).";
    pub REACTION: [f64; 3] = "Force of the supports on the node, of constraints where it is free: minus the residual (force).";
    pub NORMAL: [f64; 3] = "Outward unit normal of the surface at the node.";
    pub MIDDLE_VELOCITY: [f64; 3] = "Velocity half a step after VELOCITY, in explicit integration (length per time).";
    pub MIDDLE_ANGULAR_VELOCITY: [f64; 3] = "Angular velocity half a step after ANGULAR_VELOCITY, in explicit integration (radian per time).";
    pub FORCE_RESIDUAL: [f64; 3] = "External minus internal forces that explicit integration accelerates (force).";
    pub POINT_LOAD: [f64; 3] = "Force on a point (force).";
    pub ROTATION: [f64; 3] = "Rotation vector of the reference node of a coupling (radian); other nodes have none.";
    pub WHOLE_TURNS: [f64; 3] = "Whole turns that ROTATION counts: the rest of it states the rotation (radian).";
    pub ANGULAR_VELOCITY: [f64; 3] = "Rate of ROTATION (radian per time).";
    pub ANGULAR_ACCELERATION: [f64; 3] = "Second rate of ROTATION (radian per time squared).";
    pub REACTION_MOMENT: [f64; 3] = "Moment of the supports on a reference node, of couplings where it is free (force times length).";
    pub POINT_MOMENT: [f64; 3] = "Moment on the reference node of a coupling (force times length).";
    pub GROUND_STIFFNESS: [f64; 3] = "Stiffness of springs between a node and the ground along the axes (force per length).";
    pub RESULTANT_LOAD: [f64; 3] = "Share of a node in a load that is given by its resultant (force).";
    pub LINE_LOAD: [f64; 3] = "Force per present length of a line (force per length).";
    pub SURFACE_LOAD: [f64; 3] = "Force per present area of a surface (force per area).";
    pub VOLUME_ACCELERATION: [f64; 3] = "Acceleration that acts on the mass, e.g. gravity (length per time squared).";
    pub PRESSURE: f64 = "Pressure on a face; acts as NEGATIVE_FACE_PRESSURE does (force per area).";
    pub POSITIVE_FACE_PRESSURE: f64 =
        "Pushes a line to its right and a surface against t1 × t2: on faces whose normals point out of the body, positive \
         values press in space and pull in the plane (force per area).";
    pub NEGATIVE_FACE_PRESSURE: f64 =
        "Pushes a line to its left and a surface along t1 × t2: on faces whose normals point out of the body, positive \
         values press in the plane and pull in space (force per area).";
    pub TEMPERATURE: f64 = "Temperature; kelvin where bodies radiate.";
    pub VOLUMETRIC_STRAIN: f64 = "Change of volume per volume, an unknown of the nodes of mixed elements.";
    pub NODAL_MASS: f64 = "Mass at a node; in explicit integration all of it, lumped (mass).";
    pub NODAL_DISPLACEMENT_STIFFNESS: [f64; 3] = "Stiffness of a spring in each direction (force per length).";
    pub AXIAL_STIFFNESS: f64 = "Stiffness of a spring along its line (force per length).";
    pub NODAL_DAMPING_RATIO: [f64; 3] = "Viscosity of a damper in each direction (force per velocity).";
    pub NODAL_INITIAL_DISPLACEMENT: [f64; 3] = "Displacement at which a spring to the ground is at rest (length).";
    pub NODAL_ROTATIONAL_STIFFNESS: [f64; 3] = "Stiffness against rotations; refused, nodes have no rotations.";
    pub NODAL_ROTATIONAL_DAMPING_RATIO: [f64; 3] = "Damping of rotations; refused, nodes have no rotations.";
    pub NODAL_INERTIA: [f64; 3] = "Inertia against rotations; refused, nodes have no rotations.";
    kind CROSS_AREA: Scalar = "Area of the cross-section of a truss (length squared).";
    kind TRUSS_PRESTRESS_PK2: Scalar = "Second Piola–Kirchhoff stress of a truss without strain (force per area).";
    kind YOUNG_MODULUS: Scalar = "Young's modulus (force per area).";
    kind POISSON_RATIO: Scalar = "Poisson's ratio.";
    kind DENSITY: Scalar = "Mass per initial volume.";
    kind THICKNESS: Scalar = "Thickness of a planar model (length).";
    kind INTEGRATION_ORDER: Integer = "Order of the Gauss rule of an element, 1 to 5, instead of its default.";
    kind COMPUTE_LUMPED_MASS_MATRIX: Boolean = "Whether the mass matrix is diagonal.";
    kind RAYLEIGH_ALPHA: Scalar = "Factor of the mass matrix in Rayleigh damping (per time).";
    kind RAYLEIGH_BETA: Scalar = "Factor of the stiffness matrix in Rayleigh damping (time).";
    pub LOCAL_AXIS_1: [f64; 3] = "Axis 1 of the material of an element; axis x where it is not given.";
    pub LOCAL_AXIS_2: [f64; 3] = "Axis 2 of the material of an element in space, perpendicular to LOCAL_AXIS_1.";
    kind EULER_ANGLES: Vector = "Angles φ, θ, ψ that turn the axes of a material about axes 3, 1 and 3 (degrees).";
    kind LAYER_EULER_ANGLES: Vector = "EULER_ANGLES of the layers of a mixture, three a layer (degrees).";
    kind YOUNG_MODULUS_X: Scalar = "Young's modulus along axis 1 of an orthotropic material (force per area).";
    kind YOUNG_MODULUS_Y: Scalar = "Young's modulus along axis 2 of an orthotropic material (force per area).";
    kind YOUNG_MODULUS_Z: Scalar = "Young's modulus along axis 3 of an orthotropic material (force per area).";
    kind POISSON_RATIO_XY: Scalar = "Contraction along axis 2 per extension along axis 1, under stress along axis 1.";
    kind POISSON_RATIO_YZ: Scalar = "Contraction along axis 3 per extension along axis 2, under stress along axis 2.";
    kind POISSON_RATIO_XZ: Scalar = "Contraction along axis 3 per extension along axis 1, under stress along axis 1.";
    kind SHEAR_MODULUS_XY: Scalar = "Shear modulus between axes 1 and 2 (force per area).";
    kind SHEAR_MODULUS_YZ: Scalar = "Shear modulus between axes 2 and 3 (force per area).";
    kind SHEAR_MODULUS_XZ: Scalar = "Shear modulus between axes 1 and 3 (force per area).";
    kind YIELD_STRESS: Scalar = "Yield stress in tension and compression (force per area).";
    kind YIELD_STRESS_TENSION: Scalar = "Yield stress in tension; serves where YIELD_STRESS is not given.";
    kind YIELD_STRESS_COMPRESSION: Scalar = "Yield stress in compression; that of tension holds for both.";
    kind ISOTROPIC_HARDENING_MODULUS: Scalar = "Slope of the yield stress over equivalent plastic strain.";
    kind EXPONENTIAL_SATURATION_YIELD_STRESS: Scalar = "Yield stress that exponential hardening tends to.";
    kind HARDENING_MODULUS_1D: Scalar = "Slope of the yield stress of a bar over its plastic strain (force per area).";
    kind HARDENING_EXPONENT: Scalar = "Rate of exponential hardening over equivalent plastic strain.";
    kind HARDENING_CURVE: Integer = "Form of the yield stress: 3 constant, 4 polynomial, 6 through points.";
    kind KINEMATIC_HARDENING_TYPE: Integer = "Form of kinematic hardening: 0 linear (Prager), 1 Armstrong–Frederick.";
    kind KINEMATIC_PLASTICITY_PARAMETERS: Vector = "Modulus C (force per area) and rate γ of kinematic hardening; C alone where it is linear.";
    kind NORTON_COEFFICIENT: Scalar = "Factor A of the creep rate A q^n t^m (area^n per force^n per time^(1+m)).";
    kind NORTON_EXPONENT: Scalar = "Exponent n of the von Mises stress in the creep rate, from 1.";
    kind NORTON_TIME_EXPONENT: Scalar = "Exponent m of TIME in the creep rate, above -1; 0 where it is not given: steady creep.";
    kind CURVE_FITTING_PARAMETERS: Vector = "Coefficients of the polynomial of HARDENING_CURVE 4, constant first.";
    kind PLASTIC_STRAIN_INDICATORS: Vector = "Ends of the polynomial and the straight part of HARDENING_CURVE 4.";
    kind TANGENCY_REGION2: Boolean = "Whether the straight part of HARDENING_CURVE 4 keeps the polynomial's last slope.";
    kind EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE: Vector = "Yield stresses of HARDENING_CURVE 6.";
    kind PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE: Vector = "Equivalent plastic strains of HARDENING_CURVE 6.";
    kind TOTAL_STRAIN_VECTOR_PLASTICITY_POINT_CURVE: Vector = "Total uniaxial strains of HARDENING_CURVE 6.";
    kind FRACTURE_ENERGY: Scalar = "Energy by area of a crack, which softening takes; hardening curves do not use it.";
    kind MAXIMUM_STRESS: Scalar = "Peak of softening curves; hardening curves do not use it.";
    kind MAXIMUM_STRESS_POSITION: Scalar = "Place of the peak of softening curves; hardening curves do not use it.";
    kind FRICTION_ANGLE: Scalar = "Without effect: angle of internal friction, which no law here has.";
    kind DILATANCY_ANGLE: Scalar = "Without effect: angle of dilatancy, which no law here has.";
    kind COHESION: Scalar = "Without effect: cohesion, which no law here has.";
    kind SOFTENING_TYPE: Integer = "How strength falls in laws of damage: 0 linear, 1 exponential.";
    kind TANGENT_OPERATOR_ESTIMATION: Integer = "Without effect: how Kratos estimates tangents; here they are exact.";
    kind VISCOUS_PARAMETER: Scalar = "Without effect: viscosity of laws of Kelvin and Maxwell, which no law here has.";
    kind DELAY_TIME: Scalar = "Without effect: time of relaxation, which no law here has.";
    kind THERMAL_EXPANSION_COEFFICIENT: Scalar = "Strain by temperature of laws that expand (per temperature).";
    kind REFERENCE_TEMPERATURE: Scalar = "Temperature at which laws that expand are without thermal strain.";
    kind PLASTIC_DISSIPATION: Scalar = "Not computed: no law here measures it; EQUIVALENT_PLASTIC_STRAIN grows with it.";
    kind DAMAGE: Scalar = "Damage, from 0 to 1: the share of stress and stiffness that is lost.";
    kind THRESHOLD: Scalar = "Largest equivalent stress so far, which damage compares with UNIAXIAL_STRESS (force per area).";
    kind EQUIVALENT_PLASTIC_STRAIN: Scalar = "Equivalent plastic strain ∫ √(2/3) ‖dε_p‖.";
    kind ACCUMULATED_PLASTIC_STRAIN: Scalar = "The same number as EQUIVALENT_PLASTIC_STRAIN.";
    kind PLASTIC_STRAIN_VECTOR: Vector = "Plastic strain (logarithmic under finite strain), components as STRAIN.";
    kind UNIAXIAL_STRESS: Scalar = "Stress that yielding or damage compares: von Mises stress of the whole Kirchhoff stress, less the back stress, or the equivalent stress of the undamaged (force per area).";
    kind EQUIVALENT_CREEP_STRAIN: Scalar = "Equivalent creep strain ∫ √(2/3) ‖dε_c‖.";
    kind CREEP_STRAIN_VECTOR: Vector = "Creep strain, components as STRAIN.";
    kind BACK_STRESS_VECTOR: Vector = "Centre of the yield surface of laws with kinematic hardening, components as CAUCHY_STRESS_VECTOR.";
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
    kind PRINCIPAL_CAUCHY_STRESS_VECTOR: Vector = "Principal Cauchy stresses, largest first (force per area).";
    kind MAX_PRINCIPAL_STRESS: Scalar = "Largest principal Cauchy stress, positive in tension (force per area).";
    kind MIN_PRINCIPAL_STRESS: Scalar = "Smallest principal Cauchy stress, negative in compression (force per area).";
    kind TRESCA_STRESS: Scalar = "Equivalent stress of Tresca: largest less smallest principal Cauchy stress (force per area).";
    kind HYDROSTATIC_PRESSURE: Scalar = "Minus the mean of the principal Cauchy stresses, positive in compression (force per area).";
    kind SAFETY_FACTOR: Scalar = "Safety factor to yield: YIELD_STRESS over VON_MISES_STRESS, at most 1000; of materials with YIELD_STRESS.";
    kind STRAIN_ENERGY: Scalar = "Stored energy per initial volume.";
    kind INTEGRATION_WEIGHT: Scalar = "Part of the initial volume that a Gauss point stands for.";
}

register_variable! {
    kind BULK_MODULUS: Scalar = "Bulk modulus κ of hyperelastic materials, 2/D₁ (force per area).";
    kind SHEAR_MODULUS: Scalar = "Modulus μ of hyperelastic materials (force per area).";
    kind C10: Scalar = "Constant C₁₀ of Mooney–Rivlin and Yeoh materials (force per area).";
    kind C01: Scalar = "Constant C₀₁ of Mooney–Rivlin materials (force per area).";
    kind C20: Scalar = "Constant C₂₀ of Mooney–Rivlin and Yeoh materials (force per area).";
    kind C11: Scalar = "Constant C₁₁ of Mooney–Rivlin materials (force per area).";
    kind C02: Scalar = "Constant C₀₂ of Mooney–Rivlin materials (force per area).";
    kind C30: Scalar = "Constant C₃₀ of Yeoh materials (force per area).";
    kind OGDEN_MODULI: Vector = "Moduli μ_p of the terms μ_p/α_p (λ₁^α_p + λ₂^α_p + λ₃^α_p − 3) of Ogden materials (force per area).";
    kind OGDEN_EXPONENTS: Vector = "Exponents α_p of the terms of Ogden materials, not 0.";
    kind GENT_LIMIT: Scalar = "Limit J_m of I₁ − 3 in Gent materials.";
    kind LOCKING_STRETCH: Scalar = "Stretch λ_L at which the chains of Arruda–Boyce materials lock.";
    kind BLATZ_KO_SHARE: Scalar = "Share f of the solid in Blatz–Ko materials, from 0 (foam; the default) to 1.";
    kind PRONY_SHARES: Vector = "Shares g_i of the instantaneous shear modulus that relax; their sum is below 1.";
    kind PRONY_TIMES: Vector = "Times τ_i in which the shares of PRONY_SHARES relax (time).";
    kind MULLINS_R: Scalar = "Constant r of Mullins' softening, above 1: at most the share 1/r of the stress is lost.";
    kind MULLINS_M: Scalar = "Constant m of Mullins' softening (energy per volume).";
    kind MULLINS_BETA: Scalar = "Constant β of Mullins' softening, from 0 (the default).";
}

register_material_range! { "(0, inf)": ["CROSS_AREA", "THICKNESS", "BULK_MODULUS", "SHEAR_MODULUS", "GENT_LIMIT", "LOCKING_STRETCH"] }
register_material_range! { "(1, inf)": ["MULLINS_R"] }
register_material_range! { "[0, 1]": ["BLATZ_KO_SHARE"] }
register_material_range! { "[0, inf)": ["DENSITY", "RAYLEIGH_ALPHA", "RAYLEIGH_BETA", "FRACTURE_ENERGY", "MULLINS_M", "MULLINS_BETA"] }

register_usual_results! {
    values: [],
    gauss: ["CAUCHY_STRESS_VECTOR", "VON_MISES_STRESS", "GREEN_LAGRANGE_STRAIN_VECTOR", "EQUIVALENT_PLASTIC_STRAIN", "EQUIVALENT_CREEP_STRAIN", "DAMAGE"],
    largest: ["VON_MISES_STRESS", "MAX_PRINCIPAL_STRESS", "TRESCA_STRESS", "HYDROSTATIC_PRESSURE", "EQUIVALENT_PLASTIC_STRAIN", "EQUIVALENT_CREEP_STRAIN", "DAMAGE"],
    smallest: ["MIN_PRINCIPAL_STRESS", "SAFETY_FACTOR"]
}

register_rates! { "DISPLACEMENT",
    first: "VELOCITY",
    second: Some("ACCELERATION"),
    middle: Some("MIDDLE_VELOCITY"),
    reaction: Some("REACTION"),
    out_of_balance: Some("FORCE_RESIDUAL"),
    mass: Some("NODAL_MASS"),
    rayleigh: Some(["RAYLEIGH_ALPHA", "RAYLEIGH_BETA"]),
    moves_mesh: true,
}

register_rates! { "ROTATION",
    first: "ANGULAR_VELOCITY",
    second: Some("ANGULAR_ACCELERATION"),
    middle: Some("MIDDLE_ANGULAR_VELOCITY"),
    reaction: Some("REACTION_MOMENT"),
    turns: Some("DISPLACEMENT"),
}
