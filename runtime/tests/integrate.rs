//! The loop: samples where they belong, drift at every step, errors where they happen.

use clebsch::card::{Card, Conserved, Field, Invariant, Kind, OpenError, Settings, Trajectory};
use clebsch::integrate::{Observer, run};
use clebsch::{StepCause, StepError};

static CARD: Card = Card {
    name: "Counter",
    kebab: "counter",
    doc: "counts",
    source: "",
    fingerprint: 0,
    summary: "",
    solver: "none",
    order: 1,
    orders: &[1],
    preprocessed: false,
    reversible: false,
    parameters: &[],
    initial: &[],
    observables: &[Field {
        name: "x",
        ascii: "x",
        rows: 2,
        cols: 1,
        kind: Kind::Vector,
        doc: "node and its square",
    }],
    invariants: &[Invariant {
        name: "level",
        formula: "10 - bump",
        rows: 1,
        conserved: Conserved::Boundedly,
    }],
    discrete_energy: Invariant {
        name: "discrete_energy",
        formula: "0",
        rows: 1,
        conserved: Conserved::Exactly,
    },
    open: |_, _, _| {
        Ok(Box::new(Counter {
            node: 0,
            stop: u64::MAX,
        }))
    },
    solvers: &[],
    dimensions: &[],
    sized: |_| None,
};

/// Counts; its invariant dips at node 5 only; refuses to go beyond `stop`.
struct Counter {
    node: u64,
    stop: u64,
}

impl Trajectory for Counter {
    fn node(&self) -> u64 {
        self.node
    }

    fn time(&self) -> f64 {
        self.node as f64 * 0.5
    }

    fn step(&mut self) -> Result<(), StepError> {
        if self.node == self.stop {
            return Err(StepCause::NotFinite { what: "x" }.at_node(self.node));
        }
        self.node += 1;
        Ok(())
    }

    fn card(&self) -> &'static Card {
        &CARD
    }

    fn observe(&self, out: &mut [f64]) {
        let n = self.node as f64;
        out.copy_from_slice(&[n, n * n]);
    }

    fn invariants(&self, out: &mut [f64]) {
        out.fill(if self.node == 5 { 8.0 } else { 10.0 });
    }

    fn scales(&self, out: &mut [f64]) {
        out.fill(4.0);
    }
}

#[derive(Default)]
struct Notes {
    nodes: Vec<u64>,
    last: Vec<f64>,
    progress: Vec<(u64, u64)>,
}

impl Observer for Notes {
    fn sample(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        assert_eq!(time, node as f64 * 0.5);
        assert_eq!(invariants.len(), 1);
        self.nodes.push(node);
        self.last = observables.to_vec();
    }

    fn progress(&mut self, done: u64, total: u64) {
        self.progress.push((done, total));
    }
}

#[test]
fn samples_start_stride_and_end_and_drift_between_samples() {
    let mut counter = (CARD.open)(&[], &[], Settings::step(0.5)).expect("opens");
    let mut notes = Notes::default();
    let summary = run(counter.as_mut(), 10, 4, &mut notes).expect("runs");
    assert_eq!(notes.nodes, [0, 4, 8, 10]);
    assert_eq!(notes.last, [10.0, 100.0]);
    assert_eq!(notes.progress.last(), Some(&(10, 10)));
    assert_eq!((summary.steps, summary.node, summary.time), (10, 10, 5.0));
    assert_eq!(summary.samples, 4);
    // The dip at node 5 was never sampled.
    assert_eq!(summary.drifts[0].worst, 0.5);
    assert_eq!(summary.drifts[0].last, 0.0);
    assert_eq!(summary.drifts[0].scale, 4.0);
    // Going on from there.
    let again = run(counter.as_mut(), 3, 0, &mut notes).expect("runs");
    assert_eq!((again.node, again.samples), (13, 2));
    assert_eq!(notes.nodes, [0, 4, 8, 10, 10, 13]);
    let none = run(counter.as_mut(), 0, 1, &mut notes).expect("runs");
    assert_eq!((none.steps, none.samples), (0, 1));
}

#[test]
fn an_error_stops_the_run_at_its_node() {
    let mut counter = Counter { node: 0, stop: 7 };
    let mut notes = Notes::default();
    let error = run(&mut counter, 10, 1, &mut notes).expect_err("stops");
    assert_eq!(error.node, 7);
    assert_eq!(counter.node, 7);
    assert_eq!(notes.nodes, [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(
        error.to_string(),
        "no step from node 7 (state unchanged): `x` is NaN or infinite; reduce the step size or \
         check the initial values"
    );
}

#[test]
fn errors_say_what_was_expected() {
    let error = OpenError::Count {
        field: "J",
        expected: 9,
        found: 3,
    };
    assert_eq!(error.to_string(), "`J` takes 9 numbers, found 3");
    // A result is copied out of every step: ten words hold the numbers of every refusal.
    let size = std::mem::size_of::<StepError>();
    assert!(size <= 80, "{size}");
}
