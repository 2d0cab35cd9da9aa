//! Libraries with a subroutine UMAT, each loaded once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

/// A subroutine UMAT; the last argument is the length of CMNAME, which Fortran compilers append.
pub type Umat = unsafe extern "C" fn(
    stress: *mut f64,
    statev: *mut f64,
    ddsdde: *mut f64,
    sse: *mut f64,
    spd: *mut f64,
    scd: *mut f64,
    rpl: *mut f64,
    ddsddt: *mut f64,
    drplde: *mut f64,
    drpldt: *mut f64,
    stran: *const f64,
    dstran: *const f64,
    time: *const f64,
    dtime: *const f64,
    temp: *const f64,
    dtemp: *const f64,
    predef: *const f64,
    dpred: *const f64,
    cmname: *const u8,
    ndi: *const i32,
    nshr: *const i32,
    ntens: *const i32,
    nstatv: *const i32,
    props: *const f64,
    nprops: *const i32,
    coords: *const f64,
    drot: *const f64,
    pnewdt: *mut f64,
    celent: *const f64,
    dfgrd0: *const f64,
    dfgrd1: *const f64,
    noel: *const i32,
    npt: *const i32,
    layer: *const i32,
    kspt: *const i32,
    jstep: *const i32,
    kinc: *const i32,
    length: usize,
);

/// A subroutine with its library, which stays loaded.
pub struct Subroutine {
    /// The subroutine.
    pub call: Umat,
    /// Held while it runs, where threads call it one at a time.
    pub turn: Mutex<()>,
    _library: Library,
}

static LOADED: Mutex<BTreeMap<(PathBuf, bool), Arc<Subroutine>>> = Mutex::new(BTreeMap::new());

/// The subroutine that properties name.
///
/// # Errors
/// A library that is not there or does not load, or that has no such symbol.
pub fn subroutine(properties: &Properties) -> Result<Arc<Subroutine>> {
    let place = properties.place.clone();
    let Some(PropertyValue::Text(name)) = properties.values.get("UDSM_NAME") else {
        let fact = format!("properties {} have no UDSM_NAME", properties.id);
        let problem = Diagnostic::error("missing-property", fact).at(place);
        return Err(problem.remedy("give the path of the library with the subroutine UMAT as a string").into());
    };
    let is_fortran = properties.number("IS_FORTRAN_UDSM").is_none_or(|flag| flag != 0.0);
    let folder = place.as_ref().and_then(|place| Path::new(&place.file).parent().map(Path::to_path_buf));
    let path = folder.unwrap_or_default().join(name);
    let path = path.canonicalize().unwrap_or(path);
    let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = loaded.get(&(path.clone(), is_fortran)) {
        return Ok(known.clone());
    }
    let problem = |fact: String, remedy: &str| {
        Diagnostic::error("user-material", fact).at(properties.place.clone()).remedy(remedy.to_owned())
    };
    if !path.is_file() {
        let fact = format!("the library {} is not there", path.display());
        let remedy = "compile it (gfortran -O2 -shared -fPIC umat.f -o libumat.so); names start at the materials file";
        return Err(problem(fact, remedy).into());
    }
    // SAFETY: what a library does when it is loaded is its author's affair, as all that it computes.
    let library = unsafe { Library::open(Some(&path), RTLD_NOW | RTLD_LOCAL) }.map_err(|error| {
        let fact = format!("the library {} does not load: {error}", path.display());
        problem(fact, "link it with all that it calls; routines of Abaqus itself, as XIT or SPRINC, are not there")
    })?;
    let symbol = if is_fortran { "umat_" } else { "umat" };
    // SAFETY: the signature is that of the calling convention.
    let call = unsafe { library.get::<Umat>(symbol.as_bytes()) }.map(|symbol| *symbol).map_err(|_| {
        let fact = format!("the library {} has no symbol {symbol}", path.display());
        problem(fact, "name the subroutine UMAT; set \"IS_FORTRAN_UDSM\": false for umat without the underscore")
    })?;
    let made = Arc::new(Subroutine { call, turn: Mutex::new(()), _library: library });
    loaded.insert((path, is_fortran), made.clone());
    Ok(made)
}
