//! Finds PETSc and compiles the few lines of C that know its headers.

fn main() {
    #[cfg(feature = "petsc")]
    link();
}

#[cfg(feature = "petsc")]
fn link() {
    use std::path::PathBuf;

    for name in ["PETSC_DIR", "PETSC_ARCH", "MPICC"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    println!("cargo::rerun-if-changed=src/shim.c");
    let mut build = cc::Build::new();
    // the wrapper knows where the headers of MPI are, whichever MPI PETSc was built with
    let wrapper = std::env::var("MPICC").unwrap_or_else(|_| "mpicc".to_owned());
    build.compiler(&wrapper);
    let given = std::env::var("PETSC_DIR").ok().map(PathBuf::from).filter(|folder| folder.join("include").is_dir());
    if let Some(folder) = given {
        let arch = folder.join(std::env::var("PETSC_ARCH").unwrap_or_default());
        for root in [&folder, &arch] {
            build.include(root.join("include"));
            println!("cargo::rustc-link-search=native={}", root.join("lib").display());
        }
        let real = arch.join("lib/libpetsc_real.so").exists();
        println!("cargo::rustc-link-lib=dylib={}", if real { "petsc_real" } else { "petsc" });
    } else {
        let found = ["petsc", "PETSc"].iter().find_map(|name| pkg_config::probe_library(name).ok());
        let Some(found) = found else {
            println!(
                "cargo::error=PETSc was not found: install libpetsc-real-dev (Debian, Ubuntu) or set PETSC_DIR, or build \
                 without the feature `petsc`"
            );
            return;
        };
        build.includes(&found.include_paths);
    }
    build.file("src/shim.c").flag_if_supported("-std=c11").warnings(true);
    if let Err(problem) = build.try_compile("zelus_petsc_shim") {
        println!(
            "cargo::error=the headers of PETSc and MPI could not be used ({problem}): mpicc must be that of the MPI \
             library PETSc was built with; MPICC names another"
        );
    }
    // the wrapper does not link in the end, so its libraries are asked for
    let Ok(shown) = std::process::Command::new(&wrapper).arg("-show").output() else { return };
    for word in String::from_utf8_lossy(&shown.stdout).split_whitespace() {
        if let Some(folder) = word.strip_prefix("-L") {
            println!("cargo::rustc-link-search=native={folder}");
        } else if let Some(library) = word.strip_prefix("-l") {
            println!("cargo::rustc-link-lib=dylib={library}");
        }
    }
}
