//! Hands the version of the compiler to the benchmark, which prints it beside the times.
//! Takes the compiler that cargo runs; gives the variable `RUSTC_VERSION`.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(compiler)
        .arg("--version")
        .output()
        .ok()
        .and_then(|output| String::from_utf8(output.stdout).ok())
        .unwrap_or_else(|| "unknown rustc".into());
    println!("cargo::rustc-env=RUSTC_VERSION={}", version.trim());
}
