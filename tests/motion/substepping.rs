//! Tests steps that are too large and are split into substeps. Nodes equal the nodes of the shorter steps, a step
//! that can be made undivided is made undivided, the run reports the count, and a saved run continues bit for bit.

use clebsch::card::{Card, Settings, Trajectory};
use clebsch::integrate::{Halved, Halvings};
use clebsch::saved::Words;
use clebsch_models::{Case, gallery};

fn model(kebab: &str) -> (Card, Case) {
    let entries = gallery();
    let entry = entries
        .iter()
        .find(|e| e.card.kebab == kebab)
        .expect("a model");
    (entry.card, entry.cases[0].clone())
}

fn seen(t: &dyn Trajectory) -> Vec<f64> {
    let mut all = vec![0.0; t.card().observable_count()];
    t.observe(&mut all);
    all
}

fn halved(card: &Card, case: &Case, h: f64) -> Halved {
    Halved::open(card, &case.parameters, &case.initial, Settings::step(h)).expect("opens")
}

/// The largest solvable step size from the start, to one part in a thousand.
fn longest(card: &Card, case: &Case) -> f64 {
    let can = |h: f64| (card.open)(&case.parameters, &case.initial, Settings::step(h)).is_ok();
    let (mut least, mut most) = (case.h, case.h);
    while can(most) {
        (least, most) = (most, 2.0 * most);
    }
    while most > 1.001 * least {
        let middle = 0.5 * (least + most);
        match can(middle) {
            true => least = middle,
            false => most = middle,
        }
    }
    least
}

#[test]
fn refused_steps_are_made_by_parts_of_their_length() {
    for kebab in ["free-body", "heavy-top", "kirchhoff-body", "coupled-bodies"] {
        let (card, case) = model(kebab);
        // At 2.5 times the largest step size, four substeps of a quarter are solvable.
        let h = 2.5 * longest(&card, &case);
        let plain = (card.open)(&case.parameters, &case.initial, Settings::step(h));
        assert!(plain.is_err(), "{kebab}: {h} can be made");
        let mut whole = halved(&card, &case, h);
        let quarter = Settings::step(h / 4.0);
        let mut parts = (card.open)(&case.parameters, &case.initial, quarter).expect("opens");
        whole.step().expect("is made");
        for _ in 0..4 {
            parts.step().expect("is made");
        }
        // `Halved` passes the state through its observables, which rounds each number once or twice.
        for (a, b) in seen(&whole).iter().zip(seen(parts.as_ref())) {
            assert!(
                (a - b).abs() <= 1e-13 * b.abs().max(1.0),
                "{kebab}: {a} {b}"
            );
        }
        assert_eq!((whole.node(), whole.time()), (1, h), "{kebab}");
        assert_eq!(
            whole.halvings(),
            Some(Halvings { steps: 1, parts: 4 }),
            "{kebab}"
        );
    }
}

/// Steps that are solvable whole are bitwise identical to plain steps, and the run reports no substeps.
#[test]
fn steps_that_can_be_made_are_made_whole() {
    for kebab in ["free-body", "heavy-top", "mixed-four"] {
        let (card, case) = model(kebab);
        let settings = Settings::step(case.h);
        let mut plain = (card.open)(&case.parameters, &case.initial, settings).expect("opens");
        let mut halved = halved(&card, &case, case.h);
        for _ in 0..50 {
            plain.step().expect("is made");
            halved.step().expect("is made");
            assert_eq!(seen(plain.as_ref()), seen(&halved), "{kebab}");
        }
        assert_eq!(halved.halvings(), Some(Halvings::default()));
    }
}

#[test]
fn a_run_by_parts_is_written_down_and_goes_on_to_the_last_bit() {
    let (card, case) = model("heavy-top");
    // Steps of this size sometimes fail.
    let mixed = |h: &f64| {
        let mut run = halved(&card, &case, *h);
        (0..40).for_each(|_| run.step().expect("is made"));
        let made = run.halvings().expect("is told").steps;
        (5..=35).contains(&made)
    };
    let longest = longest(&card, &case);
    let lengths = (1..20).map(|n| longest * (1.0 - 0.05 * f64::from(n)));
    let h = lengths.into_iter().find(mixed).expect("a length");
    for nodes in [1, 2, 17, 40] {
        let mut one = halved(&card, &case, h);
        for _ in 0..nodes {
            one.step().expect("is made");
        }
        let mut words = Words::gathered();
        one.words(&mut words);
        let mut words = Words::given(words.into_list().expect("is written down"));
        let mut other = halved(&card, &case, h);
        other.words(&mut words);
        assert!(words.all_put());
        for _ in 0..20 {
            one.step().expect("is made");
            other.step().expect("is made");
            assert_eq!(seen(&one), seen(&other), "from node {nodes}");
        }
        assert_eq!(
            (one.node(), one.halvings()),
            (other.node(), other.halvings())
        );
    }
}

/// If no substep is solvable, the run does not open.
#[test]
fn what_no_part_can_make_is_refused() {
    let (card, case) = model("free-body");
    let wrong = Settings::step(f64::NAN);
    assert!(Halved::open(&card, &case.parameters, &case.initial, wrong).is_err());
    let far = Settings::step(1e9 * case.h);
    assert!(Halved::open(&card, &case.parameters, &case.initial, far).is_err());
}
