//! Contact by the augmented Lagrangian: reads the settings and puts the interaction into the model part.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use zelus_core::diagnostics::{Diagnostic, Report};
use zelus_core::model::ModelPart;
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;
use zelus_core::registry::named;
use zelus_core::vector3::norm;
use zelus_core::{Error, Result};

use super::friction_settings::{check_sliding, friction_law};
use super::interaction_process::InteractionProcess;
use super::interface_settings::{
    check_analysis, check_positive, check_search, segmentation, warn_of_revolution, without_computing_part,
};
use crate::adaptation::{AdaptationSettings, ExplicitPenalty, PenaltyRule, UzawaSettings};
use crate::compatibility::{FormulationUse, Refusal, refusal};
use crate::friction::FrictionSettings;
use crate::interaction::ContactInteraction;
use crate::interface::{GivenParameters, NodalNormals, check_parts};
use crate::law::{
    Augmentation, CohesiveLaw, CohesiveLawEntry, FrictionEllipse, Margin, Nitsche, NitscheVariant, NormalVariation,
    OverclosureLaw, OverclosureLawEntry, Rubbing,
};
use crate::laws::bonded::BONDED;
use crate::mortar::OperatorThreshold;
use crate::pairs::{Formulation, Multiplier, find_formulation};
use crate::search::{GapCheck, SearchDistance, SearchSettings, SetAtStart, WithinStep};
use crate::settings::{ContactSettings, SurfaceSettings};
use crate::solver::ContactSolverSettings;

#[derive(Debug, Deserialize)]
struct ContactSearchKeys {
    simple_search: bool,
    adapt_search: bool,
    dynamic_search: bool,
    search_factor: f64,
    search_distance: SearchDistance,
    search_within_step: WithinStep,
    active_check_factor: f64,
    database_step_update: usize,
    normal_orientation_threshold: f64,
    check_gap: GapCheck,
    /// Processes whose steps do not iterate, or whose integration points decide, lack it.
    #[serde(default)]
    set_at_start: SetAtStart,
}

#[derive(Debug, Deserialize)]
struct PenaltyKeys {
    #[serde(rename = "manual_ALM")]
    manual: bool,
    stiffness_factor: f64,
    penalty_scale_factor: f64,
    use_scale_factor: bool,
    penalty: f64,
    scale_factor: f64,
    adapt_penalty: bool,
    max_gap_factor: f64,
    /// Formulations whose answer does not depend on the penalty lack the keys of the adapted penalty method.
    adaptation_rule: Option<PenaltyRule>,
    min_gap_factor: Option<f64>,
    /// Only processes of the penalty method have it.
    #[serde(default)]
    penalty_of_weighted_gaps: bool,
}

#[derive(Debug, Deserialize)]
struct AlternativeKeys {
    axisymmetric: bool,
}

#[derive(Debug, Deserialize)]
struct ContactKeys {
    model_part_name: String,
    contact_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    /// Only the process of the augmented Lagrangian has it.
    #[serde(default)]
    no_separation: Vec<String>,
    contact_type: String,
    normal_variation: NormalVariation,
    nodal_normals: NodalNormals,
    /// Only the process of the penalty method has it.
    #[serde(default)]
    cohesive_pairs: Vec<String>,
    /// Only the processes of the augmented Lagrangian and the penalty method have it.
    #[serde(default)]
    friction_direction: Vec<f64>,
    /// Only the processes of the augmented Lagrangian and the penalty method have it.
    friction_ratio: Option<f64>,
    /// Only the process of the penalty method has it.
    #[serde(default)]
    elastic_slip: f64,
    /// Processes whose formulations have their forces from penalties lack it.
    augmentation: Option<Augmentation>,
    /// Only the process of Nitsche's method has it.
    #[serde(default)]
    nitsche_variant: NitscheVariant,
    /// Only the process of Nitsche's method has it.
    nitsche_factor: Option<f64>,
    clear_inactive_for_post: bool,
    mind_supports: bool,
    /// Where points decide, nodes decide nothing.
    #[serde(default)]
    least_coverage: f64,
    search_parameters: ContactSearchKeys,
    #[serde(rename = "advance_ALM_parameters")]
    parameters: PenaltyKeys,
    alternative_formulations: AlternativeKeys,
}

/// In which direction a sliding node goes on, in the plane.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SlidingDirection {
    /// In which it began to slide.
    #[default]
    Kept,
    /// Direction of the tangential multiplier of each iterate.
    OfMultiplier,
}

/// The keys of friction; processes whose formulations have none lack them.
#[derive(Debug, Deserialize)]
struct FrictionKeys {
    friction_coefficients: BTreeMap<String, f64>,
    not_normal_update_frictional: bool,
    slip_augmentation_coefficient: f64,
    slip_threshold: f64,
    #[serde(default)]
    sliding_direction: SlidingDirection,
    slip_step_reset_frequency: i64,
    tangent_factor: f64,
    operator_threshold: f64,
    /// Only formulations that measure slip in two ways have it.
    #[serde(default)]
    absolute_operator_threshold: bool,
}

impl FrictionKeys {
    fn threshold(&self) -> OperatorThreshold {
        let (share, area) = (self.operator_threshold, 0.0);
        if self.absolute_operator_threshold {
            OperatorThreshold { share: area, area: share }
        } else {
            OperatorThreshold { share, area }
        }
    }
}

/// The process for the formulations whose names begin with that of `stem`.
///
/// # Errors
/// Settings that do not fit.
pub(super) fn of_formulations(request: &mut ProcessRequest<'_>, stem: &FormulationStem) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(without_computing_part)?;
    let (root, interaction) = interaction(&settings, request, stem)?;
    Ok(InteractionProcess::boxed(root, interaction))
}

/// The formulations that a process serves, and how stiff their penalty is.
pub(super) struct FormulationStem {
    /// How their names begin; the contact type follows.
    pub name: &'static str,
    /// Factor of the estimated penalty.
    pub penalty_factor: f64,
    /// Penalty in the place of an estimate of zero.
    pub least_penalty: f64,
}

/// The interaction that these settings describe.
fn interaction(
    settings: &Settings,
    request: &mut ProcessRequest<'_>,
    formulations: &FormulationStem,
) -> Result<(String, ContactInteraction)> {
    let whole: ContactKeys = settings.parse()?;
    check_gaps_of_adaptation(settings, &whole.parameters)?;
    let (stem, updated) = match whole.contact_type.strip_suffix("WithNormalUpdate") {
        Some(stem) => (stem, true),
        None => (whole.contact_type.as_str(), false),
    };
    let mut problems = Report::new();
    let named =
        find_formulation(&format!("{}{stem}", formulations.name)).map_err(|d| d.at(settings.key_place("contact_type")));
    let named = problems.absorb(named.map_err(Error::from));
    let part = request.model.root_mut(&whole.model_part_name)?;
    let known = check_parts(part, &whole.contact_model_part, &whole.assume_master_slave);
    problems.absorb(known.map_err(|error| error.at(&settings.place())));
    problems.absorb(check_search(settings));
    problems.absorb(check_no_separation(settings, &whole));
    problems.absorb(segmentation(settings));
    problems.finish()?;
    let solver = ContactSolverSettings::of(&part.info);
    let named = named.expect("it is known");
    let (part_is_explicit, dimension) = (part.info.solver.explicit, part.info.domain_size);
    let formulation = match named.by_node {
        Some(by_node) if !whole.parameters.penalty_of_weighted_gaps => {
            if part_is_explicit {
                by_node.explicit
            } else {
                by_node.implicit
            }
        }
        _ => named,
    };
    let ellipse = ellipse(settings, &whole, dimension, request)?;
    let augmentation =
        whole.augmentation.unwrap_or(if formulation.weighted_gaps { Augmentation::Pair } else { Augmentation::Node });
    let has_multipliers = formulations.name == AUGMENTED.name;
    if has_multipliers && !whole.friction_direction.is_empty() {
        check_direction(settings, formulation, augmentation)?;
    }
    let surface = if has_multipliers { None } else { surface(settings, &whole, (formulation, ellipse))? };
    let formulation = if surface.is_some() { &BONDED } else { formulation };
    let keys: Option<FrictionKeys> =
        settings.node().get("frictional_law").is_some().then(|| settings.parse()).transpose()?;
    let friction = match &keys {
        None => FrictionSettings::default(),
        Some(keys) => FrictionSettings {
            law: friction_law(settings, formulation.frictional(), request)?,
            coefficients: keys.friction_coefficients.clone(),
            // A penalty holds sliding nodes and sticking ones by the same spring.
            margin: if formulation.regularised {
                Margin::default()
            } else {
                Margin { augmentation: keys.slip_augmentation_coefficient, threshold: keys.slip_threshold }
            },
            keeps_direction: keys.sliding_direction == SlidingDirection::Kept,
            ellipse: if has_multipliers { ellipse } else { FrictionEllipse::default() },
            reset_frequency: usize::try_from(keys.slip_step_reset_frequency).ok().filter(|f| *f > 0),
        },
    };
    let keeps_normals = keys.as_ref().is_some_and(|keys| keys.not_normal_update_frictional);
    let normal_variation = match whole.normal_variation {
        NormalVariation::None if updated || (formulation.frictional() && !keeps_normals) => NormalVariation::Update,
        NormalVariation::Exact if formulation.frictional() && keeps_normals => NormalVariation::None,
        other => other,
    };
    if formulation.frictional() {
        let by_node = part_is_explicit || matches!(formulation.multiplier, Multiplier::Vector(_));
        check_sliding(settings, friction.law, by_node && augmentation == Augmentation::Node)?;
    }
    if formulations.name == AUGMENTED.name && augmentation == Augmentation::Node {
        warn_of_penalties(&whole.parameters, request);
    }
    let tangent_factor = keys.as_ref().map_or(1.0, |keys| keys.tangent_factor);
    // Bonds that carry shear give it the stiffness of friction, too.
    let stiffness = surface.as_ref().and_then(|own| own.cohesive.as_ref()).map(|law| law.stiffness());
    let tangent_factor = match stiffness {
        Some([normal, shear]) if shear > 0.0 => shear / normal,
        _ => tangent_factor,
    };
    // 0 stands for the default of the variant.
    let factor = whole.nitsche_factor.filter(|factor| *factor > 0.0);
    let rule = whole.parameters.adaptation_rule.unwrap_or_else(PenaltyRule::usual);
    let chosen = ContactSettings {
        parts: whole.contact_model_part,
        slaves: whole.assume_master_slave,
        no_separation: whole.no_separation,
        formulation,
        interval: Interval::from_node(settings.get("interval")?)?,
        normal_variation,
        nodal_normals: whole.nodal_normals,
        augmentation,
        nitsche: Nitsche::new(whole.nitsche_variant, factor, formulation.frictional().then_some(tangent_factor)),
        search: SearchSettings {
            factor: whole.search_parameters.search_factor,
            distance: whole.search_parameters.search_distance,
            within_step: whole.search_parameters.search_within_step,
            normal_orientation_threshold: whole.search_parameters.normal_orientation_threshold,
            check: whole.search_parameters.check_gap,
            dynamic: whole.search_parameters.dynamic_search,
        },
        active_check_factor: whole.search_parameters.active_check_factor,
        simple_search: whole.search_parameters.simple_search,
        set_at_start: if part_is_explicit { SetAtStart::Near } else { whole.search_parameters.set_at_start },
        adapt_search: whole.search_parameters.adapt_search,
        database_step_update: whole.search_parameters.database_step_update.max(1),
        given: GivenParameters {
            penalty: match stiffness {
                Some([normal, _]) => Some(normal),
                None => whole.parameters.manual.then_some(whole.parameters.penalty),
            },
            scale_factor: whole.parameters.manual.then_some(whole.parameters.scale_factor),
        },
        estimate: [whole.parameters.stiffness_factor, whole.parameters.penalty_scale_factor],
        penalty_factor: formulations.penalty_factor,
        least_penalty: formulations.least_penalty,
        weighted_penalty: named.by_node.is_some() && whole.parameters.penalty_of_weighted_gaps,
        uzawa: uzawa(settings)?,
        explicit: explicit_penalty(settings, request)?,
        use_scale_factor: whole.parameters.use_scale_factor,
        own_scale: named.by_node.is_some(),
        // Where slips only decide, they count no more than gaps.
        tangent_factor: if whole.augmentation == Some(Augmentation::Node) {
            tangent_factor.min(1.0)
        } else {
            tangent_factor
        },
        operator_threshold: keys.as_ref().map_or_else(OperatorThreshold::default, FrictionKeys::threshold),
        friction,
        overclosure: overclosure(settings, formulation)?,
        surface,
        adaptation: AdaptationSettings {
            rule: whole.parameters.adapt_penalty.then_some(rule),
            min_gap_factor: whole.parameters.min_gap_factor.unwrap_or(0.0),
            max_gap_factor: whole.parameters.max_gap_factor,
            dynamic_factor: false,
        },
        clear_inactive: whole.clear_inactive_for_post,
        mind_supports: whole.mind_supports,
        least_coverage: whole.least_coverage,
        segmentation: segmentation(settings)?,
        axisymmetric: whole.alternative_formulations.axisymmetric,
        solver,
    };
    let part = request.model.root_mut(&whole.model_part_name)?;
    check_use(part, formulation, settings)?;
    let warning = warn_of_revolution(part, settings, "alternative_formulations.axisymmetric")?;
    check_variables(part, formulation, settings)?;
    let interaction = ContactInteraction::new(chosen, part)?;
    warning.into_iter().for_each(|warning| request.report.push(warning));
    Ok((whole.model_part_name, interaction))
}

/// The law of soft contact of the settings.
///
/// # Errors
/// A law where contact has no multiplier that it softens.
fn overclosure(settings: &Settings, formulation: &Formulation) -> Result<Option<Arc<dyn OverclosureLaw>>> {
    let key = "pressure_overclosure";
    let Some(node) = settings.node().get(key).filter(|node| node.get("law").is_some()) else { return Ok(None) };
    let (entry, own) = named::<OverclosureLawEntry>(node, "law")?;
    if !formulation.regularised {
        let fact = "\"pressure_overclosure\" needs steps with equilibrium and penalties by node";
        let remedy = "take it out of explicit analyses, and set \"penalty_of_weighted_gaps\" to false";
        return Err(settings.error(key, "soft-contact", fact).remedy(remedy).into());
    }
    Ok(Some(Arc::from((entry.build)(&own)?)))
}

/// The limit of friction by direction, of the settings; warns of a ratio without a direction.
///
/// # Errors
/// A direction that is no vector in space.
fn ellipse(
    settings: &Settings,
    keys: &ContactKeys,
    dimension: usize,
    request: &mut ProcessRequest<'_>,
) -> Result<FrictionEllipse> {
    let ratio = keys.friction_ratio.unwrap_or(1.0);
    if keys.friction_direction.is_empty() {
        if ratio != 1.0 {
            let fact = format!("\"friction_ratio\" of {} is read and changes nothing", settings.name());
            let warning = Diagnostic::warning("key-without-effect", fact).at(settings.key_place("friction_ratio"));
            request.report.push(warning.remedy("give \"friction_direction\", along which the coefficient holds"));
        }
        return Ok(FrictionEllipse::default());
    }
    let vector = <[f64; 3]>::try_from(keys.friction_direction.as_slice()).unwrap_or_default();
    let size = norm(vector);
    if dimension != 3 || size <= 0.0 {
        let fact = "\"friction_direction\" must be a vector of three numbers, in a model in space";
        let remedy = "write e.g. [1.0, 0.0, 0.0], or take it out in the plane";
        return Err(settings.error("friction_direction", "surface-law", fact.to_owned()).remedy(remedy).into());
    }
    Ok(FrictionEllipse { direction: vector.map(|c| c / size), ratio })
}

/// Refuses friction by direction where multipliers do not state it.
///
/// # Errors
/// A type of contact without friction, and gaps that augment pair by pair.
fn check_direction(settings: &Settings, formulation: &Formulation, augmentation: Augmentation) -> Result<()> {
    if formulation.frictional() && augmentation == Augmentation::Node {
        return Ok(());
    }
    let fact = "\"friction_direction\" needs \"contact_type\": \"Frictional\" and \"augmentation\": \"node\"";
    let remedy = "choose both, or take \"friction_direction\" out";
    Err(settings.error("friction_direction", "surface-law", fact.to_owned()).remedy(remedy).into())
}

/// Laws of bonds and of friction by direction, of the settings.
///
/// # Errors
/// Such laws where tractions of nodes have no multiplier by component, beside other laws of the gap, or of pairs that are not there.
fn surface(
    settings: &Settings,
    keys: &ContactKeys,
    (formulation, ellipse): (&Formulation, FrictionEllipse),
) -> Result<Option<SurfaceSettings>> {
    let refuse = |key: &str, fact: &str, remedy: &str| -> Result<Option<SurfaceSettings>> {
        Err(settings.error(key, "surface-law", fact.to_owned()).remedy(remedy).into())
    };
    let law = settings.node().get("cohesive").filter(|node| node.get("law").is_some());
    let pairs = &keys.cohesive_pairs;
    if law.is_none() && !pairs.is_empty() {
        let fact = "\"cohesive_pairs\" names pairs, and there is no law of their bonds";
        return refuse("cohesive_pairs", fact, "give \"cohesive\": {\"law\": \"bilinear\", …}");
    }
    let directed = !keys.friction_direction.is_empty();
    let key = match (law.is_some(), directed, keys.elastic_slip > 0.0) {
        (true, _, _) => "cohesive",
        (_, true, _) => "friction_direction",
        (_, _, true) => "elastic_slip",
        _ => return Ok(None),
    };
    if !formulation.regularised || !formulation.frictional() {
        let fact =
            format!("\"{key}\" needs \"contact_type\": \"Frictional\", steps with equilibrium and penalties by node");
        let remedy = "choose \"Frictional\" (with the coefficient 0 there is no friction), no explicit analysis, and set \
                      \"penalty_of_weighted_gaps\" to false";
        return refuse(key, &fact, remedy);
    }
    if settings.node().get("pressure_overclosure").is_some_and(|node| node.get("law").is_some()) {
        let fact = format!("\"{key}\" and \"pressure_overclosure\" both give the tractions of contact");
        return refuse(key, &fact, "take one of the two out");
    }
    let rubbing = Rubbing { elastic_slip: Some(keys.elastic_slip).filter(|slip| *slip > 0.0), ellipse };
    let Some(node) = law else { return Ok(Some(SurfaceSettings { cohesive: None, pairs: Vec::new(), rubbing })) };
    if keys.parameters.adapt_penalty || keys.parameters.manual {
        let fact =
            "\"cohesive\" gives the stiffness of contact, and \"advance_ALM_parameters\" gives or adapts a penalty";
        return refuse(key, fact, "take \"adapt_penalty\", \"manual_ALM\" and \"penalty\" out");
    }
    if let Some(missing) = pairs.iter().find(|key| !keys.contact_model_part.contains_key(*key)) {
        let fact = format!("\"cohesive_pairs\" names the pair {missing:?}, which \"contact_model_part\" does not have");
        let known: Vec<&str> = keys.contact_model_part.keys().map(String::as_str).collect();
        return refuse("cohesive_pairs", &fact, &format!("pairs: {}", known.join(", ")));
    }
    let (entry, own) = named::<CohesiveLawEntry>(node, "law")?;
    let cohesive: Arc<dyn CohesiveLaw> = Arc::from((entry.build)(&own)?);
    Ok(Some(SurfaceSettings { cohesive: Some(cohesive), pairs: pairs.clone(), rubbing }))
}

/// Pairs that do not separate are pairs of the process.
///
/// # Errors
/// A pair that the process does not have.
fn check_no_separation(settings: &Settings, keys: &ContactKeys) -> Result<()> {
    let missing = keys.no_separation.iter().find(|key| !keys.contact_model_part.contains_key(*key));
    let Some(missing) = missing else { return Ok(()) };
    let fact = format!("\"no_separation\" names the pair {missing:?}, which \"contact_model_part\" does not have");
    let known: Vec<&str> = keys.contact_model_part.keys().map(String::as_str).collect();
    let remedy = format!("pairs: {}", known.join(", "));
    Err(settings.error("no_separation", "invalid-value", fact).remedy(remedy).into())
}

/// Warns of penalties of the deck where the augmentation of nodes takes none, and contact is the same whatever they are.
fn warn_of_penalties(parameters: &PenaltyKeys, request: &mut ProcessRequest<'_>) {
    let Some(given) = request.parameters.get("advance_ALM_parameters") else { return };
    for (key, acts) in [("adapt_penalty", parameters.adapt_penalty), ("penalty", parameters.manual)] {
        if !acts || given.get(key).is_none() {
            continue;
        }
        let fact = format!("\"{key}\" changes nothing: with \"augmentation\": \"node\" no penalty acts on contact");
        let warning = Diagnostic::warning("key-without-effect", fact).at(given.key_place(key));
        request.report.push(warning.remedy("take it out, or set \"augmentation\" to \"pair\""));
    }
}

/// How far the outer loop goes; processes without one have no such keys.
fn uzawa(settings: &Settings) -> Result<UzawaSettings> {
    let Some(node) = settings.node().get("uzawa_parameters") else {
        return Ok(UzawaSettings { tolerance: f64::INFINITY, max_updates: 0 });
    };
    check_positive(settings, &["uzawa_parameters.multiplier_tolerance"])?;
    Ok(UzawaSettings {
        tolerance: node.require("multiplier_tolerance")?.f64()?,
        max_updates: node.require("max_multiplier_updates")?.usize()?,
    })
}

/// How explicit steps adapt the penalty, where the process is the explicit one.
fn explicit_penalty(settings: &Settings, request: &ProcessRequest<'_>) -> Result<Option<ExplicitPenalty>> {
    if request.entry.name != "explicit_penalty_contact_process" {
        return Ok(None);
    }
    let gap = match settings.get_bool("advance_explicit_parameters.manual_max_gap_theshold")? {
        false => None,
        true => Some(settings.get_f64("advance_explicit_parameters.max_gap_threshold")?),
    };
    let most = settings.get_f64("advance_explicit_parameters.max_gap_factor")?;
    let exponent = settings.get_f64("advance_explicit_parameters.logistic_exponent_factor")?;
    Ok(Some(ExplicitPenalty { most, exponent, gap }))
}

/// The gap below which an adapted penalty falls must be smaller than that above which it grows.
///
/// # Errors
/// A penalty that is adapted between gaps in the other order.
fn check_gaps_of_adaptation(settings: &Settings, keys: &PenaltyKeys) -> Result<()> {
    let Some(least) = keys.min_gap_factor.filter(|least| keys.adapt_penalty && *least >= keys.max_gap_factor) else {
        return Ok(());
    };
    // Other rules know no lower bound.
    if settings.get_str("advance_ALM_parameters.adaptation_rule")? != "APM" {
        return Ok(());
    }
    let key = "advance_ALM_parameters.min_gap_factor";
    let fact = format!("\"min_gap_factor\" is {least}, \"max_gap_factor\" {}", keys.max_gap_factor);
    let remedy = "write a \"min_gap_factor\" below \"max_gap_factor\": the penalty falls below the one, and grows above the other";
    Err(settings.error(key, "out-of-range", fact).remedy(remedy).into())
}

/// Refuses a use that the formulation is not made for.
fn check_use(part: &ModelPart, formulation: &Formulation, settings: &Settings) -> Result<()> {
    check_analysis(settings, part)?;
    let key = "alternative_formulations.axisymmetric";
    let wanted = FormulationUse {
        dimension: part.info.domain_size,
        axisymmetric: settings.get_bool(key)?,
        explicit: part.info.solver.explicit,
        arc_length: part.info.solver.unknown_load_factor,
    };
    let Some(Refusal { reason, remedy }) = refusal(formulation, wanted) else { return Ok(()) };
    let key = if wanted.explicit || wanted.arc_length { "contact_type" } else { key };
    Err(settings.error(key, "contact-use", reason).remedy(remedy).into())
}

/// The solver gives the nodes the variables of its `mortar_type`; another formulation's would be missing.
fn check_variables(part: &ModelPart, formulation: &Formulation, settings: &Settings) -> Result<()> {
    match formulation.variables.iter().find(|(name, _)| !part.nodes.history.has(name)) {
        None => Ok(()),
        Some(_) if part.info.solver.incomplete => Ok(()),
        Some((name, _)) => {
            let fact = format!(
                "\"contact_type\" asks for {}, but the solver's \"mortar_type\" brings no {name}",
                formulation.condition
            );
            Err(settings
                .error("contact_type", "contact-type", fact)
                .remedy("let \"contact_settings.mortar_type\" and \"contact_type\" name the same formulation")
                .into())
        }
    }
}

const AUGMENTED: FormulationStem = FormulationStem { name: "ALMContact", penalty_factor: 1.0, least_penalty: 1.0 };

register! { ProcessEntry "alm_contact_process",
    aliases: &["ALMContactProcess"],
    about: "contact by the augmented Lagrangian method on mortar pairs",
    source: "eqs. 4.9, 4.11, D.11",
    defaults: include_str!("../../../../configs/processes/alm_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/alm_contact_process.json"))],
    build: |request| of_formulations(request, &AUGMENTED),
    puts: "contact",
    surfaces: super::touching::contact,
}
