//! The names of the elements.

use zelus_core::entities::{Build, ElementEntry, KernelBlock};
use zelus_core::geometry::Shape;
use zelus_core::register;

use super::equation::{Equation, Terms};
use super::explicit_element::{Explicit, Subscales};

/// Storage, convection, conduction and sources.
pub struct ConvectionDiffusion;

impl Terms for ConvectionDiffusion {
    const TRANSIENT: bool = true;
}

/// Conduction and sources: always the state at rest.
pub struct Laplacian;

impl Terms for Laplacian {
    const TRANSIENT: bool = false;
}

/// Storage and conduction after advection of the temperature.
pub struct Diffusion;

impl Terms for Diffusion {
    const TRANSIENT: bool = true;
    const ADVECTED: bool = true;
}

/// [`ConvectionDiffusion`] of a body of revolution.
pub struct Revolution;

impl Terms for Revolution {
    const TRANSIENT: bool = true;
    const AXISYMMETRIC: bool = true;
}

/// Subscales at rest in each step.
pub struct QuasiStatic;

impl Subscales for QuasiStatic {
    const DYNAMIC: bool = false;
}

/// Subscales that evolve in time.
pub struct Dynamic;

impl Subscales for Dynamic {
    const DYNAMIC: bool = true;
}

/// Names that Kratos has beside those of shape and nodes.
macro_rules! aliases {
    ("EulerianConvDiff", "2D3N") => {
        &["EulerianConvDiff2D"]
    };
    ("EulerianConvDiff", "3D4N") => {
        &["EulerianConvDiff3D"]
    };
    ($name:tt, $suffix:tt) => {
        &[]
    };
}

macro_rules! balance {
    ($name:tt, $terms:ty, $about:literal, $source:literal; $($suffix:tt: $nodes:literal, $dim:literal;)+) => {
        $(register! { ElementEntry concat!($name, $suffix),
            aliases: aliases!($name, $suffix),
            about: $about,
            source: $source,
            cell: Shape::of($dim, $nodes),
            space: $dim,
            of_revolution: <$terms as Terms>::AXISYMMETRIC,
            build: Build::Block(KernelBlock::<Equation<$terms, $nodes, $dim>, $nodes, $nodes>::boxed),
        })+
    };
}

/// Registers explicit elements on the shapes of first order: the lumped storage of others has rows of zero.
macro_rules! explicit {
    ($name:literal, $subscales:ty, $about:literal, $source:literal; $($suffix:literal: $nodes:literal, $dim:literal;)+) => {
        $(register! { ElementEntry concat!($name, $suffix),
            about: $about,
            source: $source,
            cell: Shape::of($dim, $nodes),
            space: $dim,
            build: Build::Block(KernelBlock::<Explicit<$subscales, $nodes, $dim>, $nodes, $nodes>::boxed),
        })+
    };
    ($($kind:tt)+) => {
        explicit! { $($kind)+;
            "2D3N": 3, 2;
            "2D4N": 4, 2;
            "3D4N": 4, 3;
            "3D5N": 5, 3;
            "3D6N": 6, 3;
            "3D8N": 8, 3;
        }
    };
}

macro_rules! place {
    ($name:literal; $($suffix:literal: $nodes:literal, $dim:literal;)+) => {
        $(register! { ElementEntry concat!($name, $suffix),
            about: "element without physics, in the place of which a solver of heat puts its own",
            cell: Shape::of($dim, $nodes),
            space: $dim,
            build: Build::Place,
        })+
    };
}

/// Registers a kind of element on the shapes in the plane, or on all.
macro_rules! on_shapes {
    (plane, $register:ident; $($kind:tt)+) => {
        $register! { $($kind)+;
            "2D3N": 3, 2;
            "2D4N": 4, 2;
            "2D6N": 6, 2;
            "2D8N": 8, 2;
            "2D9N": 9, 2;
        }
    };
    (all, $register:ident; $($kind:tt)+) => {
        on_shapes! { plane, $register; $($kind)+ }
        $register! { $($kind)+;
            "3D4N": 4, 3;
            "3D6N": 6, 3;
            "3D8N": 8, 3;
            "3D10N": 10, 3;
            "3D13N": 13, 3;
            "3D15N": 15, 3;
            "3D18N": 18, 3;
            "3D20N": 20, 3;
            "3D27N": 27, 3;
        }
    };
}

on_shapes! { all, balance; "EulerianConvDiff", ConvectionDiffusion,
"transient convection and conduction of heat, by VELOCITY less MESH_VELOCITY; stabilised along the flow, on request across it",
"ρc (∂T/∂t + v·∇T) = ∇·(k ∇T) + Q, weighted by N + τ v·∇N" }

on_shapes! { all, balance; "LaplacianElement", Laplacian,
"heat that is conducted, without storage: the state at rest whatever the solver",
"∇·(k ∇T) + Q = 0" }

on_shapes! { all, balance; "EulerianDiffusion", Diffusion,
"the second half of a semi-implicit step: conduction from PROJECTED_SCALAR1, the advected temperature",
"ρc (T − T*)/Δt = ∇·(k ∇(T + T*)/2) + Q" }

on_shapes! { plane, balance; "AxisymmetricEulerianConvectionDiffusion", Revolution,
"EulerianConvDiff of a body of revolution about the x axis: y is the radius, heat is that of the whole ring; about the y axis where a structure is",
"ρc (∂T/∂t + v·∇T) = (1/y) ∇·(y k ∇T) + Q, weighted by N + τ v·∇N" }

explicit! { "QSConvectionDiffusionExplicit", QuasiStatic,
"heat in explicit steps, stored at the nodes; stabilised by subscales that follow at once",
"R = ∫ N (Q − ρc v·∇T) − k ∇N·∇T + ρc (v·∇N) s, s = τ (r + ρc π)" }

explicit! { "DConvectionDiffusionExplicit", Dynamic,
"heat in explicit steps, stored at the nodes; stabilised by subscales that evolve in time",
"R = ∫ N (Q − ρc (v·∇T + ∂s/∂t)) − k ∇N·∇T + ρc (v·∇N) s, ρc ∂s/∂t + s/τ = r + ρc π" }

on_shapes! { all, place; "Element" }
