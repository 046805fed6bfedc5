//! A ring of points with exponential springs (Toda): one statement for any number of sites; two threads give the same bits as one.
//!
//! `cargo run --release --example lattice`

use clebsch::nalgebra::SMatrix;
use clebsch::prelude::*;

clebsch::model! {
    /// The Toda chain.
    pub model Toda {
        label i in 0..N;
        periodic;
        param m, a, b: Real;
        field q: Real at nodes offset L;
        let r = next(q, i) - q;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*((a/b)*exp(-b*r) + a*r);
    }
}

fn ring(sites: usize, threads: usize) -> Result<(f64, Vec<f64>), Error> {
    let ends = TodaEnds::Ring { L: 0.0 };
    let parameters = TodaParameters {
        m: 1.0,
        a: 1.0,
        b: 1.0,
    };
    let chain = Toda::new(parameters, TodaSites { N: sites, ends })?.with_threads(threads);
    let wave = |i: usize| (std::f64::consts::TAU * i as f64 / sites as f64).sin();
    let initial = TodaInitial {
        q: (0..sites)
            .map(|i| SMatrix::<f64, 1, 1>::new(wave(i)))
            .collect(),
        momentum_q: vec![SMatrix::zeros(); sites],
    };
    let (mut state, mut work) = chain.start(initial, 0.05)?;
    let energy = chain.energy(&state);
    for _ in 0..2000 {
        chain.step(&mut state, &mut work)?;
    }
    let places = state.q().iter().map(|q| q[0]).collect();
    Ok((chain.energy(&state) / energy - 1.0, places))
}

fn main() -> Result<(), Error> {
    for sites in [10, 100, 1000] {
        let (change, alone) = ring(sites, 1)?;
        let (_, shared) = ring(sites, 2)?;
        assert_eq!(alone, shared);
        println!(
            "{sites:5} sites: relative change of energy at t = 100: {change:+.2e}; the same on two threads"
        );
    }
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
