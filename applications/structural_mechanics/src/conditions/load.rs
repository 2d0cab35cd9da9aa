//! Code that load conditions share: the kernels of distributed loads and of loads at a node, values from the condition and its nodes, rows, thickness.

use std::marker::PhantomData;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::{Shape, ShapeTable, mapping};
use zelus_core::model::Variable;

use crate::variables::{DISPLACEMENT, NEGATIVE_FACE_PRESSURE, POSITIVE_FACE_PRESSURE, PRESSURE};

/// A load spread over a line or a surface: its integrand at all Gauss points of one condition.
pub trait DistributedLoad<const NODES: usize, const SIZE: usize>: 'static {
    /// Dimension of the cell: 1 a line, 2 a surface.
    const CELL: usize;
    /// Displacements a node.
    const SPACE: usize;

    /// Adds the forces, and minus their derivative when `lhs` is not empty.
    fn add(
        rule: &ShapeTable,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    );
}

/// The kernel of a distributed load, with a Gauss rule one order above the shape's; `STILL` on the initial geometry, for small
/// displacements: its forces do not follow the motion.
pub struct Distributed<L, const STILL: bool> {
    rule: &'static ShapeTable,
    /// Whether forces act on the initial geometry: by the name of the condition, or since the body is one of small displacements.
    still: bool,
    load: PhantomData<fn() -> L>,
}

/// One whose forces follow the motion, but for bodies of small displacements.
pub type Following<L> = Distributed<L, false>;
/// One whose forces stay as they were at first.
pub type AtStart<L> = Distributed<L, true>;

impl<L, const STILL: bool, const NODES: usize, const SIZE: usize> Kernel<NODES, SIZE> for Distributed<L, STILL>
where
    L: DistributedLoad<NODES, SIZE>,
{
    type State = ();

    fn unknowns() -> [LocalUnknown; SIZE] {
        displacements(L::SPACE)
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(L::CELL, NODES).expect("loads are registered for known shapes only");
        let rule = ShapeTable::get(shape, shape.cell().default_order + 1);
        Ok(Self { rule, still: STILL || request.on_initial, load: PhantomData })
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<(), String> {
        match mapping::domain_size(self.rule.shape(), &entity.initial) > 0.0 {
            true => Ok(()),
            false => Err("it has no size, so that nothing is loaded by it".to_owned()),
        }
    }

    fn tangent(&self) -> Tangent {
        if self.still { Tangent::Zero } else { Tangent::Unsymmetric }
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        _state: &(),
        view: &StepView<'_>,
        _request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        if self.still {
            let still = EntityView { current: entity.initial, ..*entity };
            L::add(self.rule, &still, view, &mut [], rhs);
        } else {
            L::add(self.rule, entity, view, lhs, rhs);
        }
        Ok(())
    }
}

/// A load at a node: the vector that states it, and the unknowns along which it works.
pub trait LoadAtNode: 'static {
    /// Vector that states it.
    const LOAD: &'static Variable<[f64; 3]>;
    /// Unknowns along which it works.
    const ALONG: &'static Variable<[f64; 3]>;

    /// First of its components with this number of them.
    fn first(_components: usize) -> usize {
        0
    }

    /// Its size for a vector of size 1.
    fn factor(_entity: &EntityView<'_, 1>) -> f64 {
        1.0
    }
}

/// The kernel of a load at a node, which does not change with the motion.
pub struct Nodal<L>(PhantomData<fn() -> L>);

impl<L: LoadAtNode, const SIZE: usize> Kernel<1, SIZE> for Nodal<L> {
    type State = ();

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node(0, L::ALONG.component((L::first(SIZE) + row) as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self(PhantomData))
    }

    fn state(&self, _entity: &EntityView<'_, 1>, _view: &StepView<'_>) -> Result<(), String> {
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 1>,
        _state: &(),
        view: &StepView<'_>,
        _request: Request,
        _lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let [load] = vector_load(entity, view, L::LOAD);
        let factor = L::factor(entity);
        rhs.iter_mut().zip(&load[L::first(SIZE)..]).for_each(|(r, f)| *r += factor * f);
        Ok(())
    }
}

/// Displacements of all nodes in `dim` directions, node by node.
pub(super) fn displacements<const SIZE: usize>(dim: usize) -> [LocalUnknown; SIZE] {
    std::array::from_fn(|row| LocalUnknown::of_node((row / dim) as u8, DISPLACEMENT.component((row % dim) as u8)))
}

/// Vector load at each node: that of the condition plus that of the node.
pub(super) fn vector_load<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    variable: &Variable<[f64; 3]>,
) -> [[f64; 3]; NODES] {
    let mut own = [0.0; 3];
    if let Some(value) =
        view.conditions.data.values(variable, 0).get(3 * entity.index as usize..).filter(|v| v.len() > 2)
    {
        own.copy_from_slice(&value[..3]);
    }
    match view.nodes.history.values(variable, 0) {
        [] => [own; NODES],
        column => entity.vectors(column).map(|v| [v[0] + own[0], v[1] + own[1], v[2] + own[2]]),
    }
}

/// Pressure at each node: PRESSURE + NEGATIVE_FACE_PRESSURE − POSITIVE_FACE_PRESSURE of the condition, plus negative
/// minus positive pressure of the node.
pub(super) fn pressure<const NODES: usize>(entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> [f64; NODES] {
    let own = |variable| view.conditions.data.values(variable, 0).get(entity.index as usize).copied().unwrap_or(0.0);
    let mut out = [own(&PRESSURE) + own(&NEGATIVE_FACE_PRESSURE) - own(&POSITIVE_FACE_PRESSURE); NODES];
    for (variable, sign) in [(&NEGATIVE_FACE_PRESSURE, 1.0), (&POSITIVE_FACE_PRESSURE, -1.0)] {
        let column = view.nodes.history.values(variable, 0);
        if !column.is_empty() {
            out.iter_mut().zip(entity.scalars(column)).for_each(|(p, value)| *p += sign * value);
        }
    }
    out
}

/// Whether the tangent counts the stretch of the area that a load acts on; the reference program leaves it out.
///
/// A linear analysis, which has no iterations, leaves it out too: its loads act on the initial geometry.
pub(super) fn counts_stretch(view: &StepView<'_>) -> bool {
    view.info.nl_iteration > 0 && !view.decides_normals()
}

/// THICKNESS of the condition's properties, 1 when not given.
pub(super) fn thickness<const NODES: usize>(entity: &EntityView<'_, NODES>) -> f64 {
    entity.properties.number("THICKNESS").unwrap_or(1.0)
}

/// Σ N_i v_i.
pub(super) fn interpolate<const NODES: usize>(n: &[f64; NODES], values: &[[f64; 3]; NODES]) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (n, v) in n.iter().zip(values) {
        for a in 0..3 {
            out[a] += n * v[a];
        }
    }
    out
}

/// Variables by which a distributed load acts: the vector `own` and pressures.
pub(super) const fn loads(own: &'static str) -> [&'static str; 4] {
    [own, "PRESSURE", "NEGATIVE_FACE_PRESSURE", "POSITIVE_FACE_PRESSURE"]
}

/// Registers a condition for shapes: name, local dimension, texts, variables of its load; then suffix, kernel, nodes and unknowns of each.
macro_rules! register_conditions {
    ($name:literal, $dim:literal, $about:literal, $source:literal, $loads:expr; $($suffix:literal: $kernel:ty, $nodes:literal, $size:literal);+) => {
        $(const _: () = { use zelus_core::entities::ConditionEntry; zelus_core::register! { ConditionEntry concat!($name, $suffix),
            about: $about,
            source: $source,
            loads: $loads,
            cell: zelus_core::geometry::Shape::of($dim, $nodes),
            space: ($suffix.as_bytes()[0] - b'0') as usize,
            build: zelus_core::entities::Build::Block(
                zelus_core::entities::KernelBlock::<$kernel, $nodes, $size>::boxed),
        } };)+
    };
}

pub(super) use register_conditions;
