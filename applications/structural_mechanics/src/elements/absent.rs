//! Elements, conditions, laws, schemes and solvers of the reference program that are known and not there, and their replacements.

use zelus_core::analysis::SolverEntry;
use zelus_core::entities::{ConditionEntry, ElementEntry};
use zelus_core::processes::ProcessEntry;
use zelus_core::register_absent;
use zelus_core::strategies::SchemeEntry;

use crate::laws::LawEntry;

register_absent! { ElementEntry ["Shell", "IsotropicShell", "Sprism", "SolidShell", "CSDSG3", "MITC"] =>
"shells are not there: mesh the thickness with SmallDisplacementElement or TotalLagrangianElement 3D8N, 3D20N or 3D27N" }

register_absent! { ElementEntry ["CrBeam", "CrLinearBeam", "LinearTimoshenko", "Timoshenko", "NonLinearTimoshenko", "FiberBeamColumn"] =>
"beams are not there, nodes have no rotations: mesh the beam with solids, e.g. SmallDisplacementElement3D20N" }

register_absent! { ElementEntry ["Membrane", "PreStressMembrane", "PrestressMembrane"] =>
"membranes are not there: use thin solids, or in the plane SmallDisplacementElement with a law of plane stress" }

register_absent! { ElementEntry ["Cable", "SlidingCable", "RingElement"] =>
"cables are not there: TrussElement3D2N carries tension and compression" }

register_absent! { ElementEntry ["Bushing"] => "use SpringDamperElement3D2N for its displacements" }

register_absent! { ElementEntry ["SmallDisplacementMixedStrain", "SmallDisplacementMixedVolumetricStrainOss"] =>
"against volumetric locking use SmallDisplacementMixedVolumetricStrainElement, or SmallDisplacementBbarElement2D4N or 3D8N" }

register_absent! { ElementEntry ["TotalLagrangianQ1P0"] =>
"triangles of first order with one pressure lock: use TotalLagrangianMixedVolumetricStrainElement2D3N, or 2D6N of this element" }

register_absent! { LawEntry ["SmallStrainKinematicPlasticity"] =>
"of kinematic hardening VonMisesVonMises is there, in space, plane strain and with axial symmetry" }

register_absent! { LawEntry ["FiniteStrainKinematicPlasticity", "PlasticityIsotropicKinematic"] =>
"kinematic hardening is there under small strain: SmallStrainKinematicPlasticity3DVonMisesVonMises" }

register_absent! { LawEntry ["SmallStrainIsotropicPlasticity", "FiniteStrainIsotropicPlasticity"] =>
"of yield surfaces and potentials only VonMisesVonMises is there, in space and plane strain" }

register_absent! { LawEntry ["SmallStrainIsotropicPlasticityPlaneStress", "FiniteStrainIsotropicPlasticityPlaneStress", "SmallStrainJ2PlasticityPlaneStress", "J2PlasticityPlaneStress"] =>
"plasticity in plane stress is not there: mesh the thickness with solids, e.g. SmallDisplacementElement3D8N with SmallStrainJ2Plasticity3DLaw" }

register_absent! { LawEntry ["SmallStrainIsotropicDamage", "SmallStrainThermalIsotropicDamage"] =>
"of equivalent stresses VonMises, Rankine and Tresca are there, in space, plane strain and plane stress" }

register_absent! { LawEntry ["GenericAnisotropic", "SmallStrainOrthotropicDamage"] =>
"orthotropic elasticity is there, LinearElasticOrthotropic3DLaw; orthotropic plasticity and damage are not" }

register_absent! { LawEntry ["SmallStrainDplusDminus", "DamageDPlusDMinus", "SmallStrainHighCycleFatigue", "AssociativePlasticDamage", "SmallStrainPlasticDamage"] =>
"of damage the isotropic one is there, SmallStrainIsotropicDamage and SmallStrainThermalIsotropicDamage" }

register_absent! { LawEntry ["SerialParallelRuleOfMixtures", "TractionSeparationLaw"] =>
"of mixtures those whose layers strain alike are there: ParallelRuleOfMixturesLaw3D or 2D with sub_properties" }

register_absent! { LawEntry ["HyperElasticIsotropicOgden1D", "HyperElasticIsotropicHenky1D"] =>
"of hyperelastic laws those of solids are there, HyperElasticOgden3DLaw; bars have TrussConstitutiveLaw" }

register_absent! { SchemeEntry ["relaxation"] =>
"dynamic relaxation is not there: use \"solver_type\": \"Static\" for the state at rest, or \"pseudo_static\" with damping for the way to it" }

register_absent! { SchemeEntry ["multi_stage"] =>
"of explicit schemes \"central_differences\" is there: one evaluation of the forces a step" }

register_absent! { SolverEntry ["eigen_value", "harmonic_analysis", "prebuckling", "formfinding", "adjoint_static", "static_shifted_boundary"] =>
"of structural solvers \"Static\" and \"Dynamic\" are there" }

register_absent! { ConditionEntry ["DisplacementControl"] =>
"prescribe DISPLACEMENT, or follow the load by \"solving_strategy_settings\" of the type \"arc_length\"" }

register_absent! { ConditionEntry ["MovingLoad"] =>
"use LineLoadCondition with a load that is a function of x and t" }

register_absent! { ProcessEntry ["contact_remesh", "mmg_process", "metric_", "hessian_"] =>
"meshes are not changed during a run: refine the mesh file, or where contact is expected" }

register_absent! { ProcessEntry ["load_restart"] =>
"`zelus run DECK --resume` restarts a run from the files of save_restart_process" }

register_absent! { ProcessEntry ["set_moving_load"] =>
"use LineLoadCondition with a load that is a function of x and t" }

register_absent! { ProcessEntry ["set_initial_state", "set_automated_initial_variable"] =>
"initial strains and stresses are not there: prescribe displacements that make them" }
