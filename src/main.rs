//! The program `zelus`.

fn main() -> std::process::ExitCode {
    zelus::program::main()
}
