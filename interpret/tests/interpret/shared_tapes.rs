//! All trajectories of a model share its tapes: a second trajectory, with other parameters and another step size, runs on
//! the tapes of the first one, and computes what it computes without them.

use crate::side_by_side::seen;
use clebsch::card::{Card, Settings, Trajectory};
use clebsch_models::{Case, Entry, gallery};

/// More steps than a function is evaluated before it is recorded.
const STEPS: usize = 12;

/// The card of a text that no other test reads.
fn card(entry: &Entry, comment: &str) -> Card {
    let text = format!("{}\n// shared tapes, {comment}\n", entry.card.source);
    let card = clebsch_interpret::card(&text).expect("a model that runs from its text");
    let sizes: Vec<usize> = entry.card.dimensions.iter().map(|d| d.value).collect();
    (card.sized)(&sizes).unwrap_or(card)
}

/// Opens a case with all parameters times a factor.
fn open(card: &Card, case: &Case, factor: f64, h: f64) -> Box<dyn Trajectory> {
    let scaled = |list: &Vec<f64>| list.iter().map(|x| x * factor).collect();
    let parameters: Vec<Vec<f64>> = case.parameters.iter().map(scaled).collect();
    (card.open)(&parameters, &case.initial, Settings::step(h)).expect("a start")
}

#[test]
fn a_second_trajectory_runs_on_the_tapes_of_the_first() {
    // A step in closed form, a field, and equations that Newton's method solves.
    for name in ["heavy-top", "kepler", "coupled-bodies", "kirchhoff-body"] {
        let all = gallery();
        let entry = all.iter().find(|entry| entry.card.kebab == name);
        let entry = entry.expect("a model of the gallery");
        let case = entry.cases.first().expect("a case");
        let (shared, alone) = (card(entry, "shared"), card(entry, "alone"));
        let mut first = open(&shared, case, 1.0, case.h);
        for _ in 0..STEPS {
            first.step().expect("a step");
        }
        assert!(first.operations().is_some(), "{name} is not recorded");
        let mut second = open(&shared, case, 1.25, 0.5 * case.h);
        let mut without = open(&alone, case, 1.25, 0.5 * case.h);
        for step in 0..STEPS {
            second.step().expect("a step");
            without.step().expect("a step");
            if step == 0 {
                assert!(second.operations().is_some(), "{name} records again");
                assert!(without.operations().is_none(), "{name} is recorded at once");
            }
            let (own, others) = (seen(&*second, &shared), seen(&*without, &alone));
            assert_eq!(own, others, "{name}, step {step}");
        }
    }
}
