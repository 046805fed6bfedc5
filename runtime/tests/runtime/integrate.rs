//! The integration loop: samples at the right nodes, drift at every step, errors at the right node.

use clebsch::card::{Card, Conserved, Field, Invariant, Kind, OpenError, Settings, Trajectory};
use clebsch::integrate::{Observer, RunError, Watched, run, run_until_stopped};
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
    open: &|_, _, _| {
        Ok(Box::new(Counter {
            node: 0,
            stop: u64::MAX,
        }))
    },
    solvers: &[],
    dimensions: &[],
    sized: &|_| None,
    differentiate: None,
};

/// Counts steps; its invariant deviates at node 5 only, and it fails beyond `stop`.
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
    // The deviation at node 5 is between the checked nodes.
    assert_eq!(summary.drifts[0].worst, 0.0);
    assert_eq!(summary.drifts[0].last, 0.0);
    assert_eq!(summary.drifts[0].scale, 4.0);
    // A short run without samples checks every node.
    let mut other = (CARD.open)(&[], &[], Settings::step(0.5)).expect("opens");
    let all = run(other.as_mut(), 10, 0, &mut Notes::default()).expect("runs");
    assert_eq!((all.samples, all.drifts[0].worst), (2, 0.5));
    // Continues from there.
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
    assert_eq!(error.node(), 7);
    assert_eq!(counter.node, 7);
    assert_eq!(notes.nodes, [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(
        error.to_string(),
        "step from node 7 failed (state unchanged): `x` is NaN or infinite; reduce the step size or check the initial values"
    );
}

#[test]
fn what_was_done_before_a_run_stopped_is_told() {
    let mut counter = Counter { node: 0, stop: 7 };
    let mut notes = Notes::default();
    let (summary, stopped) = run_until_stopped(&mut counter, 10, 4, &mut notes);
    assert!(matches!(stopped, Some(RunError::Step(e)) if e.node == 7));
    // The last node becomes a sample, although it was not scheduled.
    assert_eq!(notes.nodes, [0, 4, 7]);
    assert_eq!(notes.last, [7.0, 49.0]);
    assert_eq!((summary.steps, summary.node, summary.time), (7, 7, 3.5));
    assert_eq!(summary.samples, 3);
    assert_eq!(summary.drifts[0].worst, 0.0);
    // A scheduled last sample appears once.
    let mut counter = Counter { node: 0, stop: 8 };
    let mut notes = Notes::default();
    let (summary, _) = run_until_stopped(&mut counter, 10, 4, &mut notes);
    assert_eq!((notes.nodes, summary.samples), (vec![0, 4, 8], 3));
    // No step succeeds.
    let mut counter = Counter { node: 0, stop: 0 };
    let (summary, stopped) = run_until_stopped(&mut counter, 10, 4, &mut Notes::default());
    assert_eq!((summary.steps, summary.samples), (0, 1));
    assert!(stopped.is_some());
    // A NaN: the summary covers the nodes before it.
    for watched in [Watched::Invariant, Watched::Scale] {
        let mut failing = Failing {
            node: 0,
            at: 8,
            watched,
            value: f64::NAN,
        };
        let mut notes = Notes::default();
        let (summary, stopped) = run_until_stopped(&mut failing, 10, 4, &mut NoShape(&mut notes));
        assert!(matches!(stopped, Some(RunError::NotFinite(e)) if (e.node, e.since) == (8, 4)));
        assert_eq!(
            (summary.steps, summary.node, notes.nodes),
            (4, 4, vec![0, 4])
        );
        assert!(summary.drifts.iter().all(|d| d.worst.is_finite()));
    }
    // A complete run gives the same result as `run`.
    let end = |run: &dyn Fn(&mut Counter, &mut Notes)| {
        let mut counter = Counter { node: 0, stop: 99 };
        let mut notes = Notes::default();
        run(&mut counter, &mut notes);
        (counter.node, notes.nodes)
    };
    let whole = end(&|c, n| assert!(run(c, 10, 4, n).is_ok()));
    let part = end(&|c, n| assert!(run_until_stopped(c, 10, 4, n).1.is_none()));
    assert_eq!(whole, part);
}

#[test]
fn errors_say_what_was_expected() {
    let error = OpenError::Count {
        field: "J",
        expected: 9,
        found: 3,
    };
    assert_eq!(error.to_string(), "`J` takes 9 numbers, found 3");
    // Every step returns a result by value; ten words hold the numbers of every error.
    let size = std::mem::size_of::<StepError>();
    assert!(size <= 80, "{size}");
}

/// Fails in one of several ways: NaN in an invariant, a scale or an observable.
struct Failing {
    node: u64,
    at: u64,
    watched: Watched,
    value: f64,
}

static TWO: Card = Card {
    observables: &[
        Field {
            name: "t",
            ascii: "t",
            rows: 1,
            cols: 1,
            kind: Kind::Scalar,
            doc: "",
        },
        Field {
            name: "Λ",
            ascii: "Lambda",
            rows: 2,
            cols: 3,
            kind: Kind::Matrix,
            doc: "",
        },
    ],
    invariants: &[
        Invariant {
            name: "level",
            formula: "",
            rows: 1,
            conserved: Conserved::Boundedly,
        },
        Invariant {
            name: "pair",
            formula: "",
            rows: 2,
            conserved: Conserved::Exactly,
        },
    ],
    ..CARD
};

impl Failing {
    fn fill(&self, watched: Watched, out: &mut [f64]) {
        out.fill(1.0);
        if watched == self.watched && self.node == self.at {
            let last = out.len() - 1;
            out[last] = self.value;
        }
    }
}

impl Trajectory for Failing {
    fn node(&self) -> u64 {
        self.node
    }

    fn time(&self) -> f64 {
        self.node as f64 * 0.5
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.node += 1;
        Ok(())
    }

    fn card(&self) -> &'static Card {
        &TWO
    }

    fn observe(&self, out: &mut [f64]) {
        self.fill(Watched::Observable, out);
    }

    fn invariants(&self, out: &mut [f64]) {
        self.fill(Watched::Invariant, out);
    }

    fn scales(&self, out: &mut [f64]) {
        self.fill(Watched::Scale, out);
    }
}

#[test]
fn a_number_that_is_none_stops_the_run_at_its_node() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (watched, at, words) in [
            // Every fourth node is checked.
            (
                Watched::Invariant,
                0,
                "at node 0 (time 0) component 2 of the invariant `pair` is ",
            ),
            (
                Watched::Invariant,
                8,
                "at node 8 (time 4) or since the last checked node, 4, component 2 of the invariant `pair` is ",
            ),
            (
                Watched::Scale,
                0,
                "at node 0 (time 0) component 2 of the natural scale of the invariant `pair` is ",
            ),
            (
                Watched::Scale,
                8,
                "at node 8 (time 4) or since the last checked node, 4, component 2 of the natural scale of the invariant \
                 `pair` is ",
            ),
            (
                Watched::Observable,
                4,
                "at node 4 (time 2) or since the last checked node, 0, entry (2, 3) of `Λ` is ",
            ),
        ] {
            let mut trajectory = Failing {
                node: 0,
                at,
                watched,
                value,
            };
            let mut notes = Notes::default();
            let error =
                run(&mut trajectory, 10, 4, &mut NoShape(&mut notes)).expect_err("no number");
            assert_eq!(error.node(), at);
            assert_eq!(trajectory.node, at);
            assert!(
                notes.nodes.iter().all(|node| *node < at),
                "{:?}",
                notes.nodes
            );
            let why = match value.is_nan() {
                true => "the argument of a function left its domain",
                false => "it exceeds the largest double",
            };
            let words = format!("{words}{value}: {why}");
            assert!(error.to_string().starts_with(&words), "{error}");
            // At the start no step was made.
            let shorter = error.to_string().contains("reduce the step size");
            assert_eq!(shorter, at > 0, "{error}");
            let RunError::NotFinite(found) = error else {
                panic!("{error}");
            };
            assert_eq!((found.watched, found.node), (watched, at));
            assert_eq!(found.value.to_bits(), value.to_bits());
        }
    }
    // A large value is finite, and a node that is not sampled is not checked.
    for (watched, at, value) in [
        (Watched::Invariant, 4, f64::MAX),
        (Watched::Invariant, 5, f64::NAN),
        (Watched::Observable, 5, f64::NAN),
    ] {
        let mut trajectory = Failing {
            node: 0,
            at,
            watched,
            value,
        };
        run(&mut trajectory, 10, 4, &mut NoShape(&mut Notes::default())).expect("runs");
    }
}

/// Accepts samples of any shape.
struct NoShape<'a>(&'a mut Notes);

impl Observer for NoShape<'_> {
    fn sample(&mut self, node: u64, _: f64, _: &[f64], _: &[f64]) {
        self.0.nodes.push(node);
    }
}

/// An invariant that deviates by this amount at node 5, with terms of size this factor times the node.
struct Resting {
    counter: Counter,
    off: f64,
    growth: f64,
}

impl Trajectory for Resting {
    fn node(&self) -> u64 {
        self.counter.node()
    }
    fn time(&self) -> f64 {
        self.counter.time()
    }
    fn step(&mut self) -> Result<(), StepError> {
        self.counter.step()
    }
    fn card(&self) -> &'static Card {
        &CARD
    }
    fn observe(&self, out: &mut [f64]) {
        self.counter.observe(out);
    }
    fn invariants(&self, out: &mut [f64]) {
        out.fill(if self.counter.node == 5 {
            self.off
        } else {
            0.0
        });
    }
    fn scales(&self, out: &mut [f64]) {
        out.fill(self.growth * self.counter.node as f64);
    }
}

#[test]
fn an_invariant_is_measured_by_its_largest_terms_or_absolutely() {
    let drift = |growth: f64| {
        let counter = Counter {
            node: 0,
            stop: u64::MAX,
        };
        let mut resting = Resting {
            counter,
            off: -5e-15,
            growth,
        };
        let summary = run(&mut resting, 10, 5, &mut Notes::default()).expect("runs");
        summary.drifts[0]
    };
    let none = drift(0.0);
    assert_eq!((none.worst, none.last, none.scale), (5e-15, 0.0, 0.0));
    assert!(none.is_absolute());
    // Zero at the start, largest at the end, at node 10.
    let most = drift(1.0);
    assert_eq!(
        (most.worst, most.last, most.scale),
        (5e-15 / 10.0, 0.0, 10.0)
    );
    assert!(!most.is_absolute());
}
