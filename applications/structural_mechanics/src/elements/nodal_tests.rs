use zelus_core::entities::{Request, Tangent};
use zelus_core::model::{EntityRole, PropertyValue};

use crate::test_model::{Random, Single, Vec3, near, size};
use crate::variables::*;

#[test]
fn a_mass_on_a_spring_hangs_where_it_must() {
    let mut single =
        Single::new(EntityRole::Element, "NodalConcentratedElement3D1N", None, &[("NODAL_MASS", 2.0)], &[[0.0; 3]]);
    let stiffness = PropertyValue::Vector(vec![10.0, 20.0, 40.0]);
    single.part.properties.get_mut(&1).unwrap().values.insert("NODAL_DISPLACEMENT_STIFFNESS".into(), stiffness);
    single.part.elements.data.values_mut(&NODAL_INITIAL_DISPLACEMENT, 0)[0] = 0.5;
    single.part.elements.data.values_mut(&NODAL_DAMPING_RATIO, 0)[1] = 3.0;
    single.initialize();
    single.set_nodal(&VOLUME_ACCELERATION, &[[0.0, 0.0, -9.81]]);
    single.displace(&[[0.5, 0.0, -2.0 * 9.81 / 40.0]]);
    let (k, rhs) = single.system();
    assert!(size(&rhs) < 1e-14, "{rhs:?}");
    assert_eq!([k[0], k[4], k[8]], [10.0, 20.0, 40.0]);
    assert_eq!(single.mass(true).iter().sum::<f64>(), 6.0);
    assert_eq!(single.damping()[4], 3.0);
    // loads that do not depend on displacements: weight, and the initial length of the spring
    assert_eq!(single.try_system(Request::External).unwrap().1, [5.0, 0.0, -19.62]);
}

#[test]
fn rotational_springs_are_refused() {
    let mut single = Single::new(EntityRole::Element, "NodalConcentratedElement2D1N", None, &[], &[[0.0; 3]]);
    let values = &mut single.part.properties.get_mut(&1).unwrap().values;
    values.insert("NODAL_ROTATIONAL_STIFFNESS".into(), PropertyValue::Vector(vec![0.0, 0.0, 1.0]));
    assert!(single.try_initialize().unwrap_err().contains("nodes have no rotations"));
}

#[test]
fn rotational_constants_of_the_elements_own_data_are_refused() {
    for (name, nodes) in [("NodalConcentratedElement3D1N", 1), ("SpringDamperElement3D2N", 2)] {
        let x: Vec<Vec3> = (0..nodes).map(|at| [at as f64, 0.0, 0.0]).collect();
        for variable in [&NODAL_ROTATIONAL_STIFFNESS, &NODAL_ROTATIONAL_DAMPING_RATIO, &NODAL_INERTIA] {
            let mut single = Single::new(EntityRole::Element, name, None, &[], &x);
            single.part.elements.data.values_mut(variable, 0)[2] = 1.0;
            let said = single.try_initialize().unwrap_err();
            assert!(said.contains(variable.name()) && said.contains("nodes have no rotations"), "{said}");
        }
    }
}

#[test]
fn springs_and_dampers_between_nodes_pull_equally() {
    let mut random = Random(41);
    for (name, space) in [("SpringDamperElement2D2N", 2), ("SpringDamperElement3D2N", 3)] {
        let mut single = Single::new(EntityRole::Element, name, None, &[], &[[0.0; 3], [1.0, 0.0, 0.0]]);
        single.part.elements.data.values_mut(&NODAL_DISPLACEMENT_STIFFNESS, 0).copy_from_slice(&[2.0, 3.0, 5.0]);
        single.part.elements.data.values_mut(&NODAL_DAMPING_RATIO, 0).copy_from_slice(&[7.0, 11.0, 13.0]);
        single.initialize();
        let u: Vec<Vec3> = (0..2).map(|_| random.vector(0.1, space)).collect();
        single.displace(&u);
        let (k, rhs) = single.system();
        for (a, stiffness) in [2.0, 3.0, 5.0][..space].iter().enumerate() {
            assert!(near(rhs[a], stiffness * (u[1][a] - u[0][a]), 1e-15) && rhs[a] == -rhs[space + a], "{name}");
        }
        let (differences, damping) = (single.difference_tangent(&u, space, true), single.damping());
        assert!(k.iter().zip(&differences).all(|(a, b)| near(*a, *b, 1e-9)), "{name}");
        assert_eq!((damping[0], damping[space]), (7.0, -7.0), "{name}");
    }
}

#[test]
fn bars_pull_along_their_axis() {
    let x = [[0.0; 3], [3.0, 4.0, 0.0]];
    let material = [("YOUNG_MODULUS", 100.0), ("CROSS_AREA", 0.2), ("DENSITY", 3.0), ("TRUSS_PRESTRESS_PK2", 0.7)];
    for (name, linear) in [("TrussElement3D2N", false), ("TrussLinearElement3D2N", true)] {
        let mut single = Single::new(EntityRole::Element, name, Some("TrussConstitutiveLaw"), &material, &x);
        assert_eq!(single.block().tangent(), if linear { Tangent::Constant } else { Tangent::Symmetric });
        single.displace(&[[0.0; 3], [0.03, 0.04, 0.0]]);
        let strain = if linear { 0.01 } else { 0.5 * (1.01 * 1.01 - 1.0) };
        let force = 0.2 * (100.0 * strain + 0.7) * if linear { 1.0 } else { 1.01 };
        let rhs = single.residual();
        assert!(near(rhs[0], 0.6 * force, 1e-13) && near(rhs[1], 0.8 * force, 1e-13) && rhs[3] == -rhs[0], "{name}");
        assert!(near(single.mass(false).iter().sum(), 9.0, 1e-13) && near(single.mass(true)[0], 1.5, 1e-14));
        let u = [[0.1, -0.2, 0.3], [0.2, 0.1, -0.1]];
        single.displace(&u);
        let (k, _) = single.system();
        let differences = single.difference_tangent(&u, 3, true);
        assert!(k.iter().zip(&differences).all(|(a, b)| near(*a, *b, 1e-9)), "{name}");
    }
}

/// A spring of length 5 that is stretched to 13 across its line; the linear one takes the part along its initial line.
#[test]
fn springs_along_their_line_pull_by_their_stretch() {
    let x = [[0.0; 3], [3.0, 4.0, 0.0]];
    for (space, linear) in [(2, false), (3, false), (2, true), (3, true)] {
        let name = format!("{}AxialSpringElement{space}D2N", if linear { "Linear" } else { "" });
        let mut single = Single::new(EntityRole::Element, &name, None, &[], &x);
        single.part.elements.data.values_mut(&AXIAL_STIFFNESS, 0)[0] = 2.0;
        single.initialize();
        assert_eq!(single.block().tangent(), if linear { Tangent::Constant } else { Tangent::Symmetric });
        single.displace(&[[0.0; 3], [2.0, 8.0, 0.0]]);
        // ANALYTIC: l = |(5, 12)| = 13, f = 2 (13 − 5) (5, 12)/13; linear: f = 2 ((2, 8)·(0.6, 0.8)) (0.6, 0.8)
        let (size, [along, up]) = if linear { (15.2, [0.6, 0.8]) } else { (16.0, [5.0 / 13.0, 12.0 / 13.0]) };
        let rhs = single.residual();
        assert!(near(rhs[0], size * along, 1e-14) && near(rhs[1], size * up, 1e-14), "{name}: {rhs:?}");
        assert!(rhs[space] == -rhs[0] && rhs[space + 1] == -rhs[1], "{name}");
        let u = [[0.1, -0.2, 0.0], [1.2, 0.7, 0.0]];
        single.displace(&u);
        let (k, _) = single.system();
        let differences = single.difference_tangent(&u, space, true);
        assert!(k.iter().zip(&differences).all(|(a, b)| near(*a, *b, 1e-8)), "{name}");
    }
}
