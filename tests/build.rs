//! The engine as rustc builds it for the macro: unoptimised and without features. A build script is
//! built that way in every profile, a test in release mode is not. Gives its own path to
//! `tests/expansion.rs`, which runs it again: with an argument it expands the heavy top once and
//! prints the microseconds.

use clebsch_core::pipeline::expand;
use std::time::Instant;

/// The model of `models/src/heavy_top.rs`, as the macro gets it.
const HEAVY_TOP: &str = "/// Heavy top, body representation.
pub model HeavyTop {
    param J: Sym<3>;
    param gU: Vec<3>;
    param z: Vec<3>;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T * z;
    constraint next(Λ) = Λ * Ω;
    constraint next(Γ) = Ω^T * Γ;
    lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
}";

fn main() {
    if std::env::args().nth(1).is_some() {
        return measure();
    }
    println!("cargo::rerun-if-changed=build.rs");
    let this = std::env::current_exe().unwrap_or_default();
    println!("cargo::rustc-env=UNOPTIMISED_ENGINE={}", this.display());
}

fn measure() {
    let Ok(tokens) = HEAVY_TOP.parse() else {
        return;
    };
    let start = Instant::now();
    let expanded = expand(tokens);
    let time = start.elapsed();
    // The stepper, not an error message in its place.
    if expanded.to_string().contains("fn step") {
        println!("{}", time.as_micros());
    }
}
