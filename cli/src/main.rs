//! The program `clebsch`: runs its arguments on the shipped models and exits with their code. The library part of
//! this crate contains all of its code, so that it can be tested.

use std::process::ExitCode;

fn main() -> ExitCode {
    clebsch_cli::run_process()
}
