//! Settings of friction that processes share, and their checks.

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::parameters::Settings;
use zelus_core::processes::ProcessRequest;

use crate::law::{FrictionLaw, find_friction_law};

/// Refuses a law that depends on how a node slides where a formulation does not decide node by node.
///
/// # Errors
/// Such a law without `by_node`.
pub(super) fn check_sliding(settings: &Settings, law: &FrictionLaw, by_node: bool) -> Result<()> {
    if by_node || !law.depends_on_sliding {
        return Ok(());
    }
    let fact =
        format!("\"frictional_law\": \"{}\" needs a traction of each slave node", settings.get_str("frictional_law")?);
    let remedy =
        "take the augmented Lagrangian or the penalty method with \"augmentation\": \"node\", or Coulomb's law";
    Err(settings.error("frictional_law", "friction-of-nodes", fact).remedy(remedy).into())
}

/// The law of friction of the settings; warns of numbers that nothing will read.
///
/// # Errors
/// A law that does not exist, coefficients that are not numbers from 0.
pub(super) fn friction_law(
    settings: &Settings,
    frictional: bool,
    request: &mut ProcessRequest<'_>,
) -> Result<&'static FrictionLaw> {
    let law = find_friction_law(settings.get_str("frictional_law")?)
        .map_err(|d| d.at(settings.key_place("frictional_law")))?;
    if !frictional && settings.get_str("frictional_law")? != "Coulomb" {
        let fact = format!("\"frictional_law\" of {} is read and changes nothing", settings.name());
        let warning = Diagnostic::warning("key-without-effect", fact).at(settings.key_place("frictional_law"));
        request.report.push(warning.remedy("\"contact_type\" has no friction: choose \"Frictional\""));
    }
    let given = settings.get("friction_coefficients")?.object()?;
    for member in given.iter() {
        let path = format!("friction_coefficients.{}", member.key);
        let coefficient = member.node.f64()?;
        if coefficient < 0.0 {
            let fact = format!("\"{path}\" is {coefficient}, it must be 0 or more");
            return Err(settings.error(&path, "invalid-value", fact).remedy("write a number from 0").into());
        }
        let pair = settings.get("contact_model_part")?.get(&member.key).and_then(|list| list.as_array());
        let why = match (frictional, law.by_coefficients) {
            _ if coefficient == 0.0 => continue,
            (false, _) => "\"contact_type\" has no friction: choose \"Frictional\"",
            (true, false) => "the law of friction takes its number from properties or nodes",
            (true, true) if pair.is_none_or(<[_]>::is_empty) => "\"contact_model_part\" has no such pair",
            (true, true) => continue,
        };
        let fact = format!("\"{path}\" of {} is read and changes nothing", settings.name());
        request.report.push(Diagnostic::warning("key-without-effect", fact).at(member.node.place()).remedy(why));
    }
    Ok(law)
}
