//! A quick part of the verification atlas: the coarsest meshes of the cases it names.

use crate::support::{root, said};
use std::process::{Command, Stdio};

/// Whether there is a Python to run the scripts of the atlas with.
fn has_python() -> bool {
    let quiet = Command::new("python3").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    quiet.is_ok_and(|status| status.success())
}

#[test]
fn quick_cases_of_the_atlas_keep_their_tolerances() {
    if !has_python() {
        println!("skipped: the verification atlas, which needs python3");
        return;
    }
    let output = Command::new("python3")
        .arg(root().join("verification/run.py"))
        .args(["--quick", "--jobs", "2", "--program", env!("CARGO_BIN_EXE_zelus")])
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("python3 starts");
    let missed: Vec<String> =
        said(&output).lines().skip_while(|line| line.starts_with("ok")).map(str::to_owned).collect();
    assert!(output.status.success(), "{}", missed.join("\n"));
}
