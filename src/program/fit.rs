//! `zelus fit`: constants of a hyperelastic material from test data, with a picture of both.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::{Mark, replace_own_file};
use zelus_structural_mechanics::laws::{EnergyKind, Fit, HomogeneousTest, TestData, fit, stable_stretches};

use super::fit_picture::picture;
use super::report::check_output;
use super::say::say;

/// Words of every material file that this command writes.
const MARK: Mark = Mark::Holds("constants by zelus fit");
/// Bulk modulus over the shear modulus where none is given: Poisson's ratio is 0.4995.
const BULK_RATIO: f64 = 1000.0;
/// Stretches between which stability is checked beyond the data.
const LIMITS: [f64; 2] = [0.2, 10.0];

/// The command line of `zelus fit`.
#[derive(Debug, clap::Args)]
pub(super) struct FitArguments {
    /// The law or the beginning of its name, e.g. HyperElasticOgden or HyperElasticYeoh3DLaw.
    law: String,
    /// Uniaxial tension or compression: a table of stretch and nominal stress (force by initial area) in two columns.
    #[arg(long, value_name = "FILE")]
    uniaxial: Option<PathBuf>,
    /// Equibiaxial tension: the same table.
    #[arg(long, value_name = "FILE")]
    equibiaxial: Option<PathBuf>,
    /// Planar tension (pure shear): the same table.
    #[arg(long, value_name = "FILE")]
    planar: Option<PathBuf>,
    /// Number of terms: 2 or 5 of Mooney–Rivlin (2), 1 to 6 of Ogden (3).
    #[arg(long)]
    terms: Option<usize>,
    /// Minimise relative errors of the stress instead of absolute ones.
    #[arg(long)]
    relative: bool,
    /// Bulk modulus of the material; 1000 times the fitted shear modulus where it is not given.
    #[arg(long, value_name = "MODULUS")]
    bulk_modulus: Option<f64>,
    /// The materials file to write; its picture stands beside it, with the ending .svg.
    #[arg(short, long, default_value = "fit.json")]
    output: PathBuf,
}

/// Fits the constants, prints them with their errors, and writes the material and the picture.
pub(super) fn run(arguments: &FitArguments) -> Result<()> {
    let files = [&arguments.uniaxial, &arguments.equibiaxial, &arguments.planar];
    let given: Vec<&Path> = files.iter().filter_map(|file| file.as_deref()).collect();
    let drawing = arguments.output.with_extension("svg");
    check_output("the material", &arguments.output, &given, MARK)?;
    check_output("the picture", &drawing, &given, Mark::Holds("data and fit"))?;
    let kind = energy(&arguments.law)?;
    let mut data = Vec::new();
    for (test, file) in HomogeneousTest::ALL.into_iter().zip(files) {
        if let Some(file) = file {
            data.push(TestData { test, points: table(file)? });
        }
    }
    if data.is_empty() {
        let problem = Diagnostic::error("fit", "there are no test data");
        return Err(problem.remedy("give --uniaxial, --equibiaxial or --planar with a file").into());
    }
    if let Some(bulk) = arguments.bulk_modulus.filter(|bulk| !(*bulk > 0.0 && bulk.is_finite())) {
        let problem = Diagnostic::error("fit", format!("--bulk-modulus is {bulk}"));
        return Err(problem.remedy("give a positive number").into());
    }
    let fitted = fit(kind, arguments.terms, &data, arguments.relative)?;
    let modulus = fitted.energy.shear_modulus();
    let bulk = arguments.bulk_modulus.unwrap_or(BULK_RATIO * modulus);
    explain(kind, &fitted, &data, bulk);
    let remark = format!("residual {:.4e}, {:.2} % of the stress", fitted.residual, 100.0 * fitted.relative);
    let material = material(&arguments.law, kind, &fitted, bulk, &remark);
    replace_own_file(&arguments.output, |file| file.write_all(material.as_bytes()))?;
    let title = format!("{}: data and fit, {remark}", kind.name);
    let drawn = picture(&title, &fitted, &data);
    replace_own_file(&drawing, |file| file.write_all(drawn.as_bytes()))?;
    say(&format!("written: {}, {}", arguments.output.display(), drawing.display()));
    Ok(())
}

/// The energy of a law by name.
fn energy(law: &str) -> Result<&'static EnergyKind> {
    EnergyKind::of_law(law).ok_or_else(|| {
        let fact = format!("{law} is no law whose constants are fitted");
        let names: Vec<&str> = EnergyKind::all().iter().map(|kind| kind.name).collect();
        Diagnostic::error("fit", fact).remedy(format!("take one of {}", names.join(", "))).into()
    })
}

/// Stretches and stresses of a file: numbers in two columns with commas, semicolons or spaces between them. A first line of words and
/// lines that begin with # are left out.
fn table(path: &Path) -> Result<Vec<[f64; 2]>> {
    let missing = |error| Diagnostic::error("missing-file", format!("{}: {error}", path.display()));
    let text = std::fs::read_to_string(path).map_err(missing)?;
    let mut out: Vec<[f64; 2]> = Vec::new();
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().map(|(at, line)| (at, line.trim()));
    let is_word = |line: &str| line.starts_with(|c: char| c.is_alphabetic() || c == '"');
    for (row, (at, line)) in lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).enumerate() {
        if row == 0 && is_word(line) {
            continue;
        }
        let cells = line.split([',', ';', '\t', ' ']).filter(|cell| !cell.is_empty());
        let numbers: Option<Vec<f64>> = cells.map(|cell| cell.parse().ok()).collect();
        let problem = |fact: String, remedy: &str| {
            Diagnostic::error("table", fact).at(Place::at(path, at as u32 + 1, 1)).remedy(remedy.to_owned())
        };
        match numbers.as_deref() {
            Some(&[stretch, stress]) if stretch > 0.0 && stretch.is_finite() && f64::is_finite(stress) => {
                if stress * (stretch - 1.0) < 0.0 {
                    let fact = format!("the stress {stress} at the stretch {stretch} has the wrong sign");
                    let remedy = "give stretches, 1 + strain, and nominal stresses, negative in compression";
                    return Err(problem(fact, remedy).into());
                }
                out.push([stretch, stress]);
            }
            Some(&[stretch, _]) => {
                let remedy = "give stretches above 0: 1 + strain";
                return Err(problem(format!("the stretch {stretch} or its stress is out of range"), remedy).into());
            }
            _ => {
                let fact = format!("\"{line}\" is no stretch and nominal stress");
                return Err(problem(fact, "write two numbers a line, e.g. 1.25, 0.31").into());
            }
        }
    }
    if out.is_empty() {
        let problem = Diagnostic::error("table", "the file has no line with two numbers").at(Place::file(path));
        return Err(problem.remedy("write a stretch and a nominal stress a line, e.g. 1.25, 0.31").into());
    }
    Ok(out)
}

/// Prints constants, errors and the stretches between which the material is stable.
fn explain(kind: &EnergyKind, fitted: &Fit, data: &[TestData], bulk: f64) {
    let modulus = fitted.energy.shear_modulus();
    say(&format!("{}: shear modulus {modulus:.6}, bulk modulus {bulk:.6}", kind.name));
    for (name, values) in &fitted.constants {
        let values: Vec<String> = values.iter().map(|value| format!("{value:.8}")).collect();
        say(&format!("  {name} {}", values.join(", ")));
    }
    for own in data {
        let mean = |of: &dyn Fn(f64, f64) -> f64| {
            let sum: f64 = own.points.iter().map(|[stretch, stress]| of(*stretch, *stress).powi(2)).sum();
            (sum / own.points.len() as f64).sqrt()
        };
        let error = mean(&|stretch, stress| own.test.nominal_stress(&fitted.energy, stretch) - stress);
        let share = 100.0 * error / mean(&|_, stress| stress);
        let (name, count) = (own.test.name(), own.points.len());
        say(&format!("  {name}: {count} points, residual {error:.4e} ({share:.2} % of the stress)"));
    }
    for test in HomogeneousTest::ALL {
        let [least, most] = stable_stretches(&fitted.energy, test, LIMITS);
        let measured = data.iter().find(|own| own.test == test).map(|own| own.points.as_slice()).unwrap_or_default();
        let is_within = measured.iter().all(|[stretch, _]| (least..=most).contains(stretch));
        if [least, most] == LIMITS {
            continue;
        }
        let fact = format!("{} stretches are stable from {least:.3} to {most:.3}", test.name());
        let remedy = if is_within {
            "keep to these stretches, or take another law"
        } else {
            "the data lie outside of it: take another law, or fewer terms"
        };
        say(&Diagnostic::warning("unstable-material", fact).remedy(remedy).to_string());
    }
}

/// The materials file with the constants; a beginning of a name stands for the law in space.
fn material(law: &str, kind: &EnergyKind, fitted: &Fit, bulk: f64, remark: &str) -> String {
    let name = if law == kind.name { format!("{law}3DLaw") } else { law.to_owned() };
    let mut variables: Vec<String> = fitted
        .constants
        .iter()
        .map(|(name, values)| match values.as_slice() {
            [one] if !name.starts_with("OGDEN") => format!("\"{name}\": {one:?}"),
            several => format!("\"{name}\": {several:?}"),
        })
        .collect();
    variables.push(format!("\"BULK_MODULUS\": {bulk:?}"));
    format!(
        r#"{{
  "properties": [
    {{ // constants by zelus fit, {remark}
      "model_part_name": "Structure",
      "properties_id": 1,
      "Material": {{
        "constitutive_law": {{"name": "{name}"}},
        "Variables": {{
          {}
        }},
        "Tables": {{}}
      }}
    }}
  ]
}}
"#,
        variables.join(",\n          ")
    )
}
