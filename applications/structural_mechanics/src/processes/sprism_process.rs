//! Accepted for decks that name it; solid-shell prisms are not part of the element library.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

struct Sprism;

impl Process for Sprism {}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(zelus_core::parameters::Defaults::lenient)?;
    let fact = "sprism_process does nothing here: it prepares solid-shell prisms and writes their THICKNESS";
    request.report.push(
        Diagnostic::warning("sprism-process", fact)
            .at(settings.place())
            .remedy("displacements do not depend on it; remove it if THICKNESS is not needed"),
    );
    Ok(Box::new(Sprism))
}

register! { ProcessEntry "sprism_process",
    aliases: &["SPRISMProcess"],
    about: "accepted without effect: prepares solid-shell prisms",
    defaults: include_str!("../../../../configs/processes/sprism_process.json"),
    build: build,
}
