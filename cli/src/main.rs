//! The program `clebsch`: runs its arguments on the shipped models and exits with their code.
//! Everything it does is in the library part of this crate, so that it can be tested.

use std::process::ExitCode;

fn main() -> ExitCode {
    clebsch_cli::run_process()
}
