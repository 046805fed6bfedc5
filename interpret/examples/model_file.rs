//! A model from a file, without a build: derived, opened from lists of numbers, run, its samples written as CSV.
//!
//! `cargo run --release --example model_file [FILE]`

use clebsch::card::Settings;
use clebsch::integrate::run;
use clebsch::record::{Record, write_csv};
use std::error::Error;

/// What is run where no file is named: a bead on a turning hoop, by its angle.
const BEAD: &str = "
model Bead {
    /// moment of inertia, weight times radius, square of the hoop's rate times the moment of inertia
    param A, w, s: Real;
    /// the angle from the bottom
    field q: Real;
    lagrangian = A*(next(q) - q)^2/(2*h) + h*w*cos(q) - h*s*cos(q)^2/2;
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let text = match std::env::args()
        .nth(1)
        .filter(|name| !name.starts_with('-'))
    {
        Some(file) => std::fs::read_to_string(file)?,
        None => BEAD.to_owned(),
    };
    let card = clebsch_interpret::card(&text)?;
    println!(
        "{}: {} parameters, {} initial values",
        card.name,
        card.parameters.len(),
        card.initial.len()
    );
    if card.name != "Bead" {
        return Ok(());
    }
    let parameters = [vec![1.0], vec![1.0], vec![2.0]];
    let initial = [vec![0.3], vec![0.0]];
    let settings = Settings::step(0.05);
    let mut running = (card.open)(&parameters, &initial, settings)?;
    let mut record = Record::new(running.card());
    let summary = run(running.as_mut(), 2000, 200, &mut record)?;
    let mut file = Vec::new();
    write_csv(&mut file, running.card(), &record)?;
    print!("{}", String::from_utf8(file)?);
    println!("{} steps, until t = {}", summary.steps, summary.time);
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
