//! Structural mechanics: elements, constitutive laws, loads and the solvers of structural problems.

mod solvers;
