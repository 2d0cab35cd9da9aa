//! Elements with the volumetric strain as an unknown of the nodes, against volumetric locking: their common parts.
//!
//! The unknowns of a node are its displacements and θ_i, a change of volume per volume. A [`VolumetricForm`] gives the strain for the
//! law at a Gauss point, and the contribution of the point to forces and stiffness. Mass is that of the displacements. Damping that
//! goes with the stiffness acts on velocities, and θ has none: θ is then that of u + β v, so that its stress has the damping of volume
//! in it.

use std::marker::PhantomData;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::entities::{
    AssumedSmall, BlockRequest, EntityView, Gauss, Kernel, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::{Shape, ShapeTable};

use super::gradients::{nodal_vectors, physical_gradients};
use super::material::Material;
use super::results;
use super::small_motion::small_motion;
use crate::laws::{ConstitutiveLaw, LawFactory, MakesLaw, Matrix, StrainState, StressMeasure};
use crate::tensor::IDENTITY;
use crate::variables::{DISPLACEMENT, VOLUME_ACCELERATION, VOLUMETRIC_STRAIN};

/// Order of the Gauss rule of every shape.
const ORDER: usize = 2;

/// How displacements and nodal volumetric strain make strain and forces.
pub trait VolumetricForm: Send + Sync + 'static {
    /// Whether strains are finite; otherwise the tangent of a linear law is constant.
    const FINITE: bool;

    /// The strain that the law sees at a Gauss point.
    ///
    /// # Errors
    /// Volume that is no longer positive.
    fn state<'a, const NODES: usize, const DIM: usize, const S: usize>(
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        law: &dyn ConstitutiveLaw<S>,
        history: &'a [f64],
    ) -> Result<StrainState<'a, S>, String>;

    /// Adds the contribution of a Gauss point.
    fn add<const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize>(
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        matter: &Matter<'_, DIM, S>,
        state: &StrainState<'_, S>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    );
}

/// A Gauss point of an element in its initial configuration.
pub struct Place<'a, const NODES: usize, const DIM: usize> {
    /// Number of the point, from 0.
    pub(super) g: usize,
    /// Shape functions.
    pub(super) n: &'a [f64; NODES],
    /// Their gradients.
    pub(super) dn: [[f64; DIM]; NODES],
    /// Volume that the point stands for.
    pub(super) weight: f64,
}

/// Nodal values of one element.
pub struct Values<const NODES: usize> {
    /// Displacements.
    pub(super) u: [[f64; 3]; NODES],
    /// Volumetric strains.
    pub(super) theta: [f64; NODES],
}

/// Material data at a Gauss point.
pub struct Matter<'a, const DIM: usize, const S: usize> {
    /// The law.
    pub(super) law: &'a dyn ConstitutiveLaw<S>,
    /// The law's matrix without strain.
    pub(super) initial: &'a Matrix<S>,
    /// Bulk modulus of that matrix, that of the plane in the plane.
    pub(super) bulk: f64,
    /// Its shear modulus.
    pub(super) shear: f64,
    /// Force per initial volume.
    pub(super) body: [f64; DIM],
    /// Length of an edge of a cube, or square, of the element's initial volume.
    pub(super) size: f64,
}

/// Element of displacements and volumetric strain with `NODES` nodes in `DIM` dimensions and `S` strains.
pub struct MixedVolumetricStrain<F, const NODES: usize, const DIM: usize, const S: usize> {
    shape: Shape,
    materials: Vec<Material<S>>,
    tangent: Tangent,
    form: PhantomData<fn() -> F>,
}

/// The law's matrix without strain.
fn initial_matrix<const S: usize>(law: &dyn ConstitutiveLaw<S>, small: bool) -> Matrix<S> {
    let mut d = [[0.0; S]; S];
    let history = vec![0.0; law.history()];
    let state =
        StrainState { strain: [0.0; S], f: IDENTITY, det_f: 1.0, small, history: &history, ..StrainState::REST };
    law.stress(&state, StressMeasure::Pk2, Some(&mut d));
    d
}

/// Bulk and shear modulus of an isotropic matrix, the bulk modulus that of the plane in the plane.
fn moduli<const S: usize>(d: &Matrix<S>, dim: usize) -> (f64, f64) {
    let bulk = d[..dim].iter().flat_map(|row| &row[..dim]).sum::<f64>() / (dim * dim) as f64;
    (bulk, d[dim][dim])
}

impl<F: VolumetricForm, const NODES: usize, const DIM: usize, const S: usize> MixedVolumetricStrain<F, NODES, DIM, S> {
    fn material(&self, entity: &EntityView<'_, NODES>) -> &Material<S> {
        Material::find(&self.materials, entity.properties.id)
    }

    fn values(entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Values<NODES> {
        let theta = match view.nodes.history.values(&VOLUMETRIC_STRAIN, 0) {
            [] => [0.0; NODES],
            column => entity.scalars(column),
        };
        Values { u: nodal_vectors(entity, view, &DISPLACEMENT), theta }
    }

    fn place<'a>(material: &'a Material<S>, g: usize, entity: &EntityView<'_, NODES>) -> Place<'a, NODES, DIM> {
        let (dn, det) = physical_gradients(&entity.initial, &material.rule.dn::<NODES, DIM>()[g]);
        Place { g, n: &material.rule.n()[g], dn, weight: material.rule.weight(g) * det * material.thickness }
    }

    fn state_at<'a>(
        material: &Material<S>,
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        state: &'a [f64],
    ) -> Result<StrainState<'a, S>, String> {
        F::state(at, values, material.law.as_ref(), material.remembered(at.g, state))
    }
}

impl<F: VolumetricForm, const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize> Kernel<NODES, SIZE>
    for MixedVolumetricStrain<F, NODES, DIM, S>
where
    LawFactory: MakesLaw<S>,
{
    type State = Box<[f64]>;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| {
            LocalUnknown::of_node(
                (row / (DIM + 1)) as u8,
                match row % (DIM + 1) {
                    a if a < DIM => DISPLACEMENT.component(a as u8),
                    _ => VOLUMETRIC_STRAIN.scalar(),
                },
            )
        })
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(DIM, NODES).expect("registered for known shapes only");
        let mut materials = Material::all(request, shape, DIM == 2, false)?;
        let asks = |material: &Material<S>| match &material.law {
            law if law.expands() => Some("temperature at its Gauss points"),
            law if law.softens() => Some("band in which it softens"),
            law if law.depends_on_time() => Some("time at its Gauss points"),
            law if law.has_axes() => Some("axes of the material"),
            _ => None,
        };
        if let Some(what) = materials.iter().find_map(asks) {
            let fact = format!("{} has no {what}, which its law asks for", request.entry.name);
            let remedy = "take SmallDisplacementElement, SmallDisplacementBbarElement or TotalLagrangianElement";
            return Err(Diagnostic::error("law-does-not-fit", fact).remedy(remedy).into());
        }
        materials.iter_mut().for_each(|material| material.rule = ShapeTable::get(shape, ORDER));
        let constant = !F::FINITE && materials.iter().all(|m| m.law.is_linear());
        let tangent = if constant { Tangent::Constant } else { Tangent::Unsymmetric };
        Ok(Self { shape, materials, tangent, form: PhantomData })
    }

    fn fits(&self, own: &Self::State, saved: &Self::State) -> bool {
        own.len() == saved.len()
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<Box<[f64]>, String> {
        let material = self.material(entity);
        let table = material.rule;
        let det = |g| physical_gradients::<NODES, DIM>(&entity.initial, &table.dn::<NODES, DIM>()[g]).1;
        if (0..table.len()).all(|g| det(g) > 0.0) {
            Ok(vec![0.0; table.len() * material.law.history()].into())
        } else {
            Err("inverted in the mesh or without volume".into())
        }
    }

    fn tangent(&self) -> Tangent {
        self.tangent
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let material = self.material(entity);
        let values = Self::values(entity, view);
        let acceleration = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        let initial = initial_matrix(material.law.as_ref(), !F::FINITE);
        let (bulk, shear) = moduli(&initial, DIM);
        let volume: f64 = (0..material.rule.len()).map(|g| Self::place(material, g, entity).weight).sum();
        let size = (volume / material.thickness).powf(1.0 / DIM as f64);
        for g in 0..material.rule.len() {
            let at = Self::place(material, g, entity);
            let body = std::array::from_fn(|a| {
                let nodal: f64 = at.n.iter().zip(&acceleration).map(|(n, v)| n * v[a]).sum();
                material.density * (material.acceleration[a] + nodal)
            });
            let matter = Matter { law: material.law.as_ref(), initial: &initial, bulk, shear, body, size };
            let point = Self::state_at(material, &at, &values, state)?;
            F::add(&at, &values, &matter, &point, request, lhs, rhs);
        }
        Ok(())
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        Material::have_weight(&self.materials, view)
    }

    /// ∫ ρ N_i N_j on the displacements, its row sums when lumped.
    fn mass(
        &self,
        entity: &EntityView<'_, NODES>,
        _state: &Box<[f64]>,
        _view: &StepView<'_>,
        lumped: bool,
        out: &mut [f64],
    ) -> bool {
        let material = self.material(entity);
        let lumped = lumped || material.lumped;
        for g in 0..material.rule.len() {
            let n = &material.rule.n::<NODES>()[g];
            let (_, det) = physical_gradients::<NODES, DIM>(&entity.initial, &material.rule.dn::<NODES, DIM>()[g]);
            let mass = material.density * material.rule.weight(g) * det * material.thickness;
            for (i, j) in (0..NODES).flat_map(|i| (0..NODES).map(move |j| (i, j))) {
                let (share, j) = if lumped { (n[i] * n[j], i) } else { (n[i] * n[j], j) };
                for a in 0..DIM {
                    out[(i * (DIM + 1) + a) * SIZE + j * (DIM + 1) + a] += mass * share;
                }
            }
        }
        true
    }

    fn has_history(&self, state: &Box<[f64]>) -> bool {
        !state.is_empty()
    }

    fn accept(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &mut Box<[f64]>,
        view: &StepView<'_>,
    ) -> Result<(), String> {
        if state.is_empty() {
            return Ok(());
        }
        let (material, values) = (self.material(entity), Self::values(entity, view));
        let before = state.clone();
        for (g, history) in state.chunks_exact_mut(material.law.history()).enumerate() {
            let at = Self::place(material, g, entity);
            material.law.advance(&Self::state_at(material, &at, &values, &before)?, history);
        }
        Ok(())
    }

    /// A law with as many numbers of history is taken to be the same.
    fn inherit(&self, state: &mut Box<[f64]>, earlier: &Box<[f64]>) {
        if state.len() == earlier.len() {
            state.copy_from_slice(earlier);
        }
    }

    fn gauss(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        variable: &str,
    ) -> Option<Gauss> {
        let (material, values) = (self.material(entity), Self::values(entity, view));
        results::gauss(material, StressMeasure::Pk2, false, variable, &|g| {
            let at = Self::place(material, g, entity);
            Some((Self::state_at(material, &at, &values, state).ok()?, at.weight / material.thickness))
        })
    }

    fn gauss_variables(&self) -> &'static [&'static str] {
        results::variables(&self.materials)
    }

    fn assumed_small(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Option<AssumedSmall> {
        (!F::FINITE).then(|| small_motion::<NODES, DIM>(self.shape, entity, view))
    }
}

/// Registers a form for shapes: `kind!("Name", Form, S, "about", "source"; DIM: "2D3N" 3, …)`.
macro_rules! register_mixed {
    ($name:literal, $form:ty, $strains:literal, $about:literal, $source:literal;
     $dim:literal: $($suffix:literal $nodes:literal),+) => {
        $(const _: () = { use zelus_core::entities::ElementEntry; zelus_core::register! { ElementEntry concat!($name, $suffix),
            about: $about,
            source: $source,
            cell: zelus_core::geometry::Shape::of($dim, $nodes),
            space: $dim,
            body_load: ("VOLUME_ACCELERATION", "DENSITY"),
            small_displacement: !<$form as $crate::elements::VolumetricForm>::FINITE,
            nodal: &[("VOLUMETRIC_STRAIN", 1)],
            build: zelus_core::entities::Build::Block(zelus_core::entities::KernelBlock::<
                $crate::elements::MixedVolumetricStrain<$form, $nodes, $dim, $strains>,
                $nodes,
                { $nodes * ($dim + 1) },
            >::boxed),
        } };)+
    };
}

pub(super) use register_mixed;
