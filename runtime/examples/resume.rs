//! Interrupts a run, saves it to disk and resumes it bit for bit: with the typed state and its workspace, and with a trajectory
//! opened from its card.
//!
//! `cargo run --release --example resume`

use clebsch::Snapshot;
use clebsch::card::Settings;
use clebsch::prelude::*;

clebsch::model! {
    /// A planet about a sun that stays where it is.
    pub model Planet {
        param m, k: Real;
        field x: Vec<2>;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + h*k/sqrt(dot(x, x));
    }
}

fn start() -> Result<(Planet, PlanetState, PlanetWorkspace), Error> {
    let planet = Planet::new(PlanetParameters { m: 1.0, k: 1.0 })?;
    let initial = PlanetInitial {
        x: Additive::new(Vector2::new(1.0, 0.0)),
        momentum: FieldMomentum(Vector2::new(0.0, 1.2)),
    };
    let (state, work) = planet.start(initial, 0.05)?;
    Ok((planet, state, work))
}

/// With the typed state and workspace.
fn typed(file: &std::path::Path) -> Result<(), Box<dyn std::error::Error>> {
    let (planet, mut state, mut work) = start()?;
    for _ in 0..500 {
        planet.step(&mut state, &mut work)?;
    }
    let kept = [Snapshot::of(&state)?, Snapshot::of(&work)?].map(|part| part.to_bytes());
    std::fs::write(file, kept.concat())?;
    let length = kept[0].len();
    for _ in 0..500 {
        planet.step(&mut state, &mut work)?;
    }

    // In another process, later.
    let bytes = std::fs::read(file)?;
    let (planet, mut again, mut work) = start()?;
    Snapshot::from_bytes(&bytes[..length])?.put_into(&mut again)?;
    Snapshot::from_bytes(&bytes[length..])?.put_into(&mut work)?;
    for _ in 0..500 {
        planet.step(&mut again, &mut work)?;
    }
    assert_eq!(state.x(), again.x());
    println!(
        "after 1000 steps at {:?}, and so after a break",
        again.x().matrix().as_slice()
    );
    Ok(())
}

/// With a trajectory of any model, from its card and lists of numbers.
fn from_card(file: &std::path::Path) -> Result<(), Box<dyn std::error::Error>> {
    let settings = Settings::step(0.05).of_order(4);
    let open = || {
        (Planet::CARD.open)(
            &[vec![1.0], vec![1.0]],
            &[vec![1.0, 0.0], vec![0.0, 1.2]],
            settings,
        )
    };
    let mut running = open()?;
    for _ in 0..500 {
        running.step()?;
    }
    std::fs::write(file, Snapshot::of_trajectory(running.as_mut())?.to_bytes())?;
    let mut again = open()?;
    Snapshot::from_bytes(&std::fs::read(file)?)?.put_into_trajectory(again.as_mut())?;
    let (mut one, mut other) = ([0.0; 4], [0.0; 4]);
    for _ in 0..500 {
        running.step()?;
        again.step()?;
    }
    running.observe(&mut one);
    again.observe(&mut other);
    assert_eq!(one, other);
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::temp_dir().join(format!("clebsch-resume-{}", std::process::id()));
    let done = typed(&file).and_then(|()| from_card(&file));
    std::fs::remove_file(&file).ok();
    done
}

#[test]
fn it_runs() {
    main().unwrap();
}
