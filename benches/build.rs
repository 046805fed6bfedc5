//! Passes the compiler version, which the benchmarks print next to the times, and the path of this program to the benchmarks. A
//! build script is built without optimisation in every profile, like a macro. With an argument, this program expands the statement
//! on its standard input and prints the microseconds.

use clebsch_core::pipeline::expand;
use std::io::Read as _;
use std::process::Command;
use std::time::Instant;

fn main() {
    if std::env::args().nth(1).is_some() {
        return measure();
    }
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(compiler)
        .arg("--version")
        .output()
        .ok()
        .and_then(|output| String::from_utf8(output.stdout).ok())
        .unwrap_or_else(|| "unknown rustc".into());
    println!("cargo::rustc-env=RUSTC_VERSION={}", version.trim());
    let this = std::env::current_exe().unwrap_or_default();
    println!("cargo::rustc-env=UNOPTIMISED_ENGINE={}", this.display());
}

/// One expansion, the first in its process, as in rustc.
fn measure() {
    let mut source = String::new();
    if std::io::stdin().read_to_string(&mut source).is_err() {
        return;
    }
    let Ok(tokens) = clebsch_core::syntax::tokens(&source) else {
        return;
    };
    let start = Instant::now();
    let expanded = expand(tokens);
    let time = start.elapsed();
    // The output is the stepper and not an error message.
    if expanded.to_string().contains(":: clebsch :: stepper !") {
        println!("{}", time.as_micros());
    }
}
