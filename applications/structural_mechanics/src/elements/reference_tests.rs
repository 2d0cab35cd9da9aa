//! Elements against numbers of Kratos 10.4.4 on one distorted, deformed cell each.
//!
//! EXTERNAL: nodes x = A ξ + 0.03 sin(7 i + 3 a), displacements 0.05 cos(5 i + 2 a). The numbers are Σ cos(r) rhs_r, then
//! Σ cos(r) K_rc sin(c) of the tangent, the consistent and the lumped mass, and Σ cos(k) v_k over all values of
//! CAUCHY_STRESS_VECTOR and VON_MISES_STRESS.
//!
//! Not compared, because ours differs on purpose: axisymmetric mass (Kratos leaves out 2πr of the lumped one and takes the
//! present radius in the other), forces of the axisymmetric total Lagrangian element and all of the small-displacement one
//! (Kratos weighs with the present radius, so that neither tangent is a derivative), Cauchy
//! stress of Kirchhoff–Saint-Venant under small strain (Kratos adds ½ ε² to ε there only), and the 15-node prism (Kratos'
//! shape functions are linear in the triangle at half height, hence not quadratic), and the tangent of neo-Hooke under
//! small strain (Kratos' is exact to first order only).

use crate::test_model::{Single, reference_cell, size, weighted};
use zelus_core::entities::find_kind;
use zelus_core::model::Role;

/// Left out of the comparison.
const OTHER: f64 = f64::NAN;

#[rustfmt::skip]
const REFERENCE: &[(&str, &str, [f64; 6])] = &[
    ("SmallDisplacementElement2D3N", "LinearElasticPlaneStrain2DLaw", [-1.8641284500683257, 34.793676487605204, 0.0047538161774375405, 0.021427682011699006, 1.9884665152922398, 7.2205382151479425]),
    ("SmallDisplacementElement2D4N", "LinearElasticPlaneStrain2DLaw", [-0.5939911689703495, -7.259028956498229, 0.17034449209682825, 0.30132767945039246, 0.478892318936885, 1.2362778536767602]),
    ("SmallDisplacementElement2D6N", "LinearElasticPlaneStrain2DLaw", [-1.9681176962532878, -23.540544065034112, 0.0066199948547019305, 0.01852279206781935, -11.99942118810806, 26.200804029388372]),
    ("SmallDisplacementElement2D8N", "LinearElasticPlaneStrain2DLaw", [0.9191100690117286, -50.94356502914427, -0.3272493503333632, -0.6989637858383165, -11.821854612937233, 10.496128168617904]),
    ("SmallDisplacementElement2D9N", "LinearElasticPlaneStrain2DLaw", [-7.379325110514179, 90.65668700584322, 0.33796326676617744, 0.7248112687814935, -12.19746205741349, 20.136457916280087]),
    ("SmallDisplacementElement3D4N", "LinearElastic3DLaw", [-1.1973265328134006, 9.777320159266543, 0.0029643208540841505, 0.01752163822125042, 5.370536764919092, 14.413187339420007]),
    ("SmallDisplacementElement3D6N", "LinearElastic3DLaw", [-2.1172618345910705, -12.856975856609502, 0.003973498443647765, 0.04378068086277782, 98.61155622214152, -6.719347972998346]),
    ("SmallDisplacementElement3D8N", "LinearElastic3DLaw", [3.892026652506778, 24.151599213484968, 0.05384926598943366, 0.5042272376865006, 16.75415287955603, 3.833975223231495]),
    ("SmallDisplacementElement3D10N", "LinearElastic3DLaw", [2.3453337214046495, 57.97185517135116, 0.0011006924034714287, -0.00014049287562786582, 95.97082858687786, 9.790524790266407]),
    ("SmallDisplacementElement3D20N", "LinearElastic3DLaw", [-0.6965060709725567, -135.58945035893672, -0.10478183315608454, -1.287296037803113, 120.25511876290643, 46.33393723326854]),
    ("SmallDisplacementElement3D27N", "LinearElastic3DLaw", [10.308276681144331, 472.37352865355547, 0.15927141939503778, 0.3463815619311552, 69.4130325774696, 24.221334075514022]),
    ("SmallDisplacementElement3D4N", "HyperElastic3DLaw", [-0.8916424980227714, OTHER, 0.0029643208540841505, 0.01752163822125042, 3.7973260605618906, 9.717476266300581]),
    ("SmallDisplacementElement3D6N", "HyperElastic3DLaw", [-1.697549898319593, OTHER, 0.003973498443647765, 0.04378068086277782, 85.32254297607929, -5.446607574736726]),
    ("SmallDisplacementElement3D8N", "HyperElastic3DLaw", [3.6164143124804786, OTHER, 0.05384926598943366, 0.5042272376865006, 14.738745204275018, 3.047513556967379]),
    ("SmallDisplacementElement2D4N", "LinearElasticPlaneStress2DLaw", [-0.5526302861938556, -6.767835107568582, 0.17034449209682825, 0.30132767945039246, 0.415585996339354, 0.7931833545449518]),
    ("SmallDisplacementElement2D4N", "KirchhoffSaintVenantPlaneStrain2DLaw", [-0.5939911689703495, -7.259028956498229, 0.17034449209682825, 0.30132767945039246, OTHER, 1.23627785367676]),
    ("TotalLagrangianElement2D4N", "LinearElasticPlaneStrain2DLaw", [-0.6081173734281934, -6.542335846620178, 0.17034449209682825, 0.30132767945039246, 0.43310357215457096, 1.1857165408784043]),
    ("TotalLagrangianElement3D8N", "LinearElastic3DLaw", [4.219634045402955, 28.511516135992014, 0.05384926598943366, 0.5042272376865006, 19.80141360767595, 3.9673047470328338]),
    ("TotalLagrangianElement2D4N", "HyperElasticPlaneStrain2DLaw", [-0.6509196196765722, -6.755236932887048, 0.17034449209682825, 0.30132767945039246, 0.475874687426453, 1.2551047951271295]),
    ("TotalLagrangianElement3D8N", "HyperElastic3DLaw", [3.8572939782798326, 19.37319545379012, 0.05384926598943366, 0.5042272376865006, 16.91979194951758, 3.1620570936429555]),
    ("TotalLagrangianElement2D4N", "KirchhoffSaintVenantPlaneStrain2DLaw", [-0.6081173734281934, -6.542335846620178, 0.17034449209682825, 0.30132767945039246, 0.4353358787084274, 1.185716540878404]),
    ("TotalLagrangianElement3D8N", "KirchhoffSaintVenant3DLaw", [4.219634045402955, 28.511516135992014, 0.05384926598943366, 0.5042272376865006, 20.205956371392976, 3.9673047470328346]),
    ("TotalLagrangianElement3D4N", "HyperElastic3DLaw", [-1.096364793156305, 11.699305515924346, 0.0029643208540841505, 0.01752163822125042, 5.0718224850057805, 9.739240654054077]),
    ("TotalLagrangianElement3D6N", "HyperElastic3DLaw", [-1.8164490529529305, -3.741471709489651, 0.003973498443647765, 0.04378068086277782, 90.95502320784534, -5.322344455915907]),
    ("UpdatedLagrangianElement2D4N", "LinearElasticPlaneStrain2DLaw", [-0.7050449169145393, -6.352853056354951, 0.17034449209682825, 0.30132767945039246, 0.43310357215457096, 1.1857165408784043]),
    ("UpdatedLagrangianElement3D8N", "LinearElastic3DLaw", [4.224339508855289, 19.64812578835497, 0.05384926598943366, 0.5042272376865006, 19.80141360767595, 3.9673047470328338]),
    ("UpdatedLagrangianElement2D4N", "HyperElasticPlaneStrain2DLaw", [-0.6509196196765719, -6.755236932887046, 0.17034449209682825, 0.30132767945039246, 0.475874687426453, 1.249182748254153]),
    ("UpdatedLagrangianElement3D8N", "HyperElastic3DLaw", [3.8572939782798326, 19.373195453790125, 0.05384926598943366, 0.5042272376865006, 16.91979194951758, 3.728249399328866]),
    ("UpdatedLagrangianElement2D4N", "KirchhoffSaintVenantPlaneStrain2DLaw", [-0.6081173734281933, -6.542335846620174, 0.17034449209682825, 0.30132767945039246, 0.4353358787084274, 1.1812212609940584]),
    ("UpdatedLagrangianElement3D8N", "KirchhoffSaintVenant3DLaw", [4.219634045402957, 28.511516135992018, 0.05384926598943366, 0.5042272376865006, 20.205956371392976, 4.569621872147092]),
    ("UpdatedLagrangianElement3D4N", "HyperElastic3DLaw", [-1.0963647931563056, 11.69930551592434, 0.0029643208540841505, 0.01752163822125042, 5.0718224850057805, 13.202349442428215]),
    ("UpdatedLagrangianElement3D6N", "HyperElastic3DLaw", [-1.81644905295293, -3.7414717094896606, 0.003973498443647765, 0.04378068086277782, 90.95502320784534, -5.8456322515816055]),
    ("AxisymTotalLagrangianElement2D4N", "LinearElasticAxisym2DLaw", [OTHER, OTHER, OTHER, OTHER, -9.830227660580094, 0.788375273011533]),
];

fn double_weighted(matrix: &[f64], rows: usize) -> f64 {
    let products: Vec<f64> =
        matrix.chunks(rows).map(|row| row.iter().enumerate().map(|(c, v)| v * (c as f64).sin()).sum()).collect();
    weighted(&products)
}

#[test]
fn agrees_with_the_reference_program() {
    let mut wrong = Vec::new();
    for (name, law, expected) in REFERENCE {
        let entry = find_kind(Role::Element, name).unwrap();
        let (x, u) = reference_cell(entry.cell.unwrap(), entry.space);
        let values = [("YOUNG_MODULUS", 100.0), ("POISSON_RATIO", 0.3), ("DENSITY", 2.0), ("THICKNESS", 0.5)];
        let mut single = Single::new(Role::Element, name, Some(law), &values, &x);
        single.displace(&u);
        let (k, rhs) = single.system();
        let (consistent, lumped) = (single.mass(false), single.mass(true));
        let cauchy = single.gauss("CAUCHY_STRESS_VECTOR").values;
        let von_mises = single.gauss("VON_MISES_STRESS").values;
        let rows = rhs.len();
        let checks = [
            ("forces", weighted(&rhs), size(&rhs)),
            ("tangent", double_weighted(&k, rows), size(&k)),
            ("mass", double_weighted(&consistent, rows), size(&consistent)),
            ("lumped mass", double_weighted(&lumped, rows), size(&lumped)),
            ("Cauchy stress", weighted(&cauchy), size(&cauchy)),
            ("von Mises stress", weighted(&von_mises), size(&von_mises)),
        ];
        for ((what, value, scale), reference) in checks.into_iter().zip(expected) {
            if (value - reference).abs() > 1e-12 * scale * rows as f64 {
                wrong.push(format!("{name} {law} {what}: {value} instead of {reference}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// EXTERNAL: forces, tangent and Cauchy stress of the same cells with plastic laws and mean dilatation. The J2 laws
/// agree to round-off; the generic ones stop their return at 1e-4 of the yield stress, and have a tangent by
/// perturbation. Not compared: exponential hardening, whose yield stress Kratos takes from the beginning of the step,
/// and the generic law of plane strain, whose von Mises stress there leaves out the stress across the plane.
#[rustfmt::skip]
const PLASTIC: &[(&str, &str, &[(&str, f64)], f64, [f64; 3])] = &[
    ("SmallDisplacementElement3D8N", "SmallStrainJ2Plasticity3DLaw", HARDENING, 1e-12, [3.896602914809094, 8.649056616293866, 19.211663937022077]),
    ("SmallDisplacementElement3D4N", "SmallStrainJ2Plasticity3DLaw", HARDENING, 1e-12, [0.2734669613778571, 6.979527189363546, 12.978531339275108]),
    ("SmallDisplacementBbarElement2D4N", "SmallStrainJ2PlasticityPlaneStrain2DLaw", HARDENING, 1e-12, [-0.5586976892974578, -12.020066905220016, -1.6510024183537473]),
    ("SmallDisplacementBbarElement3D8N", "SmallStrainJ2Plasticity3DLaw", HARDENING, 1e-12, [0.2600973784661441, -3.3152832110571797, 19.94980587660486]),
    ("SmallDisplacementBbarElement3D8N", "LinearElastic3DLaw", &[], 1e-12, [0.2555211161638269, 12.187259386133908, 17.492294819138813]),
    ("SmallDisplacementElement3D8N", "SmallStrainIsotropicPlasticity3DVonMisesVonMises", PERFECT, 1e-5, [3.8969995242086277, 7.30550292433568, 19.42464822866913]),
    ("TotalLagrangianElement3D8N", "FiniteStrainIsotropicPlasticity3DVonMisesVonMises", PERFECT, 1e-2, [3.8490870737468397, 8.890364198478395, 18.897892188258645]),
];
const HARDENING: &[(&str, f64)] = &[("YIELD_STRESS", 1.0), ("ISOTROPIC_HARDENING_MODULUS", 10.0)];
const PERFECT: &[(&str, f64)] = &[("YIELD_STRESS", 1.0), ("HARDENING_CURVE", 3.0)];

#[test]
fn plasticity_agrees_with_the_reference_program() {
    let mut wrong = Vec::new();
    for (name, law, more, tolerance, expected) in PLASTIC {
        let entry = find_kind(Role::Element, name).unwrap();
        let (x, u) = reference_cell(entry.cell.unwrap(), entry.space);
        let values = [&[("YOUNG_MODULUS", 100.0), ("POISSON_RATIO", 0.3), ("THICKNESS", 0.5)], *more].concat();
        let mut single = Single::new(Role::Element, name, Some(law), &values, &x);
        single.displace(&u);
        let (k, rhs) = single.system();
        let cauchy = single.gauss("CAUCHY_STRESS_VECTOR").values;
        let checks = [
            ("forces", weighted(&rhs), size(&rhs)),
            ("tangent", double_weighted(&k, rhs.len()), size(&k)),
            ("Cauchy stress", weighted(&cauchy), size(&cauchy)),
        ];
        for ((what, value, scale), reference) in checks.into_iter().zip(expected) {
            if (value - reference).abs() > tolerance * scale * rhs.len() as f64 {
                wrong.push(format!("{name} {law} {what}: {value} instead of {reference}, size {scale}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
