//! Registered names of Newton's method: with full increments, and with a line search.

use super::line_search::{DEFAULTS, LineSearch};
use super::strategy_entry::StrategyEntry;
use crate::register;

register! { StrategyEntry "newton_raphson",
    about: "Newton's method with full increments",
    source: "K Δ = b, eq. D.2",
    build: |request| Ok(Box::new(request.newton()?)),
}

register! { StrategyEntry "line_search",
    about: "Newton's method with line search: the share of each increment at which its work on the residual is small",
    source: "u ← u + s Δ with Δ·b(u + s Δ) small; Crisfield (1982)",
    defaults: DEFAULTS,
    build: |mut request| {
        // One linear solve takes its increment whole.
        if !request.iteration.linear {
            request.iteration.line_search = Some(LineSearch::new(request.advanced)?);
        }
        Ok(Box::new(request.newton()?))
    },
}
