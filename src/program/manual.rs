//! `zelus manual`: one page with the options of every command.

use zelus_core::{Error, Result};

/// The manual page in the language of `man`.
///
/// # Errors
/// A page that cannot be written.
pub(super) fn manual(mut command: clap::Command) -> Result<String> {
    command.build();
    let failed = |error: std::io::Error| Error::System(format!("manual: {error}"));
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page).map_err(failed)?;
    let whole = String::from_utf8_lossy(&page).into_owned();
    // The part on exit codes and the version stay last.
    let at = whole.find(".SH EXTRA").unwrap_or(whole.len());
    let (head, tail) = whole.split_at(at);
    let mut out = String::from(head);
    for own in command.get_subcommands().filter(|own| own.get_name() != "help") {
        let name = own.get_name().to_owned();
        // Parts of a command stand below it, without a page of their own.
        let reference = format!("zelus\\-{}(1)", name.replace('-', "\\-"));
        out = out.replace(&reference, &format!("zelus {name}"));
        let man = clap_mangen::Man::new(own.clone());
        let mut part = Vec::new();
        man.render_synopsis_section(&mut part).map_err(failed)?;
        man.render_description_section(&mut part).map_err(failed)?;
        man.render_options_section(&mut part).map_err(failed)?;
        let part = String::from_utf8_lossy(&part).replace(".SH ", ".SS ");
        // Each part begins with the definitions of quotes that the page has already.
        let lines = part.lines().filter(|line| !line.starts_with(".ie ") && !line.starts_with(".el "));
        out.push_str(&format!(".SH ZELUS {}\n{}\n", name.to_uppercase(), lines.collect::<Vec<_>>().join("\n")));
    }
    out.push_str(tail);
    Ok(out)
}
