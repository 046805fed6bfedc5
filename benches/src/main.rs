//! Time per step of generated and hand-written steppers, called like a user calls them, one step at a time. Takes part of the name
//! of the cases to run, or nothing for all; prints a table of medians over eight processes, with the worst.
//! `cargo run --release --manifest-path benches/Cargo.toml`, about two minutes; `-- coupled` behind it for some.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

mod elastic;
mod elastic_bodies;
mod frames;
mod groups;
mod loops;
mod operation_counts;
mod points;
mod processes;
mod steppers;
mod systems;

use clebsch_benches::blocks;
use clebsch_benches::blocks::compare;
use clebsch_oracle::physics::cases::{
    Start, asymmetric_body, generic_top, lagrange_top, symmetric_body,
};
use clebsch_oracle::physics::systems::{generic_pair, reference_pair};
use elastic::{
    generated_convective, generated_four, generated_spatial, written_convective, written_four,
    written_spatial,
};
use elastic_bodies::{
    generated_fluid, generated_hooke, generated_mooney, written_fluid, written_hooke,
    written_mooney,
};
use frames::{generated_frames, generated_single_frames};
use groups::{
    generated_cayley_klein, generated_cayley_klein_spatial, generated_kirchhoff_body,
    written_cayley_klein, written_kirchhoff_body,
};
use operation_counts::Block;
use points::{generated_charge, generated_kepler, written_charge, written_kepler};
use processes::Row;
use steppers::{generated_body, generated_top, written_body, written_top};
use systems::{
    generated_free_body_spatial, generated_heavy_top_spatial, generated_pair,
    generated_quadratic_field, generated_two_fields, written_free_body_spatial,
    written_heavy_top_spatial, written_pair, written_quadratic_field, written_two_fields,
};

fn main() {
    let only = std::env::args().nth(1);
    let Some(number) = processes::number() else {
        println!("{}; {}", machine(), env!("RUSTC_VERSION"));
        println!(
            "{} processes, stack and heap shifted; in each {} blocks of {} steps for each stepper, in the order generated, hand, \
             hand, generated; ns of computing per step, medians; ratios of processes: median, best, worst",
            processes::SHIFTS.len(),
            2 * blocks::QUADRUPLES,
            blocks::STEPS
        );
        println!();
        processes::gather(only.as_deref());
        return;
    };
    processes::shift_heap(number);
    let table = Table { only };
    let bodies: [(&str, Start); 3] = [
        ("free body, I = (2, 2, 1)", symmetric_body()),
        ("free body, I = (3.5, 2.5, 2)", asymmetric_body()),
        ("free body, J full", generic_top()),
    ];
    for (name, start) in bodies {
        table.row(name, || generated_body(&start), || written_body(&start));
    }
    let tops: [(&str, Start); 2] = [
        ("heavy top, Lagrange", lagrange_top()),
        ("heavy top, J full", generic_top()),
    ];
    for (name, start) in tops {
        table.row(name, || generated_top(&start), || written_top(&start));
    }
    table.row(
        "free body in space",
        generated_free_body_spatial,
        written_free_body_spatial,
    );
    table.row(
        "heavy top in space, Lagrange",
        generated_heavy_top_spatial,
        written_heavy_top_spatial,
    );
    table.row(
        "body in a quadratic field",
        generated_quadratic_field,
        written_quadratic_field,
    );
    table.row(
        "body in two fields",
        generated_two_fields,
        written_two_fields,
    );
    for (name, start) in [
        ("coupled bodies, symmetric", reference_pair()),
        ("coupled bodies, general", generic_pair()),
    ] {
        table.row(name, || generated_pair(&start), || written_pair(&start));
    }
    for (name, c) in [
        ("unit quaternions, c = 0", 0.0),
        ("unit quaternions, c = 1", 1.0),
    ] {
        table.row(
            name,
            || generated_cayley_klein(c),
            || written_cayley_klein(c),
        );
    }
    table.row(
        "unit quaternions in space, c = 1",
        || generated_cayley_klein_spatial(1.0),
        || written_cayley_klein(1.0),
    );
    table.row(
        "body in a fluid",
        generated_kirchhoff_body,
        written_kirchhoff_body,
    );
    table.row("planet about a sun", generated_kepler, written_kepler);
    table.row("charge in uniform fields", generated_charge, written_charge);
    table.row(
        "ellipsoid, seen from the body",
        generated_convective,
        written_convective,
    );
    table.row(
        "ellipsoid, seen from space",
        generated_spatial,
        written_spatial,
    );
    table.row("elastic body, neo-Hookean", generated_hooke, written_hooke);
    table.row(
        "elastic body, Mooney-Rivlin",
        generated_mooney,
        written_mooney,
    );
    table.row(
        "elastic body, fluid ellipsoid",
        generated_fluid,
        written_fluid,
    );
    table.row("four joined by springs", generated_four, written_four);
    table.row(
        "ten frames, beside ten single ones",
        generated_frames,
        generated_single_frames,
    );
}

/// The cases to print: all, or those whose names contain a text.
struct Table {
    only: Option<String>,
}

impl Table {
    fn row<A: FnOnce(), B: FnOnce()>(
        &self,
        name: &str,
        generated: impl Fn() -> Block<A>,
        hand: impl Fn() -> B,
    ) {
        if self.only.as_ref().is_some_and(|only| !name.contains(only)) {
            return;
        }
        let work = generated().work;
        let times = compare(|| generated().run, hand);
        processes::hand_on(&Row {
            name: name.to_owned(),
            generated: times.generated,
            hand: times.hand,
            work,
        });
    }
}

/// Name of the processor, if the system provides it.
fn machine() -> String {
    std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}
