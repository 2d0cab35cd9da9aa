//! zelus with the additions of this crate: what follows is all that a program of one's own needs.
use zelus_plugin as _;

fn main() -> std::process::ExitCode {
    zelus::program::main()
}
