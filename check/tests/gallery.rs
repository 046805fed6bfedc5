//! Every model and case of the gallery is judged to be within its bound, step by step, and a wrong number is seen.

use clebsch::card::{Card, Settings};
use clebsch_check::{Judge, Judged, Setup};
use clebsch_core::pipeline::parse_source;
use clebsch_models::{Case, gallery};

/// Steps of each case.
const STEPS: u64 = 12;

/// More of them, of longer runs of the test.
fn steps() -> u64 {
    let asked = std::env::var("CLEBSCH_CHECK_STEPS").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(STEPS)
}

fn judge(card: &Card, case: &Case) -> Result<Judge, String> {
    let model = parse_source(card.source).map_err(|e| e.render(card.source, card.name))?;
    let sizes = card.dimensions.iter().map(|d| (d.name.to_owned(), d.value));
    let sizes: Vec<_> = sizes.collect();
    let fields = card.parameters.iter().map(|f| (f.name, f.rows, f.cols));
    let parameters = fields.zip(case.parameters.iter().map(Vec::as_slice));
    let observables = card.observables.iter().map(|f| (f.name, f.rows, f.cols));
    Judge::new(&model, &sizes, Setup::new(case.h, parameters, observables))
}

/// The nodes of a few steps.
fn nodes(card: &Card, case: &Case) -> Vec<Vec<f64>> {
    let settings = Settings::step(case.h);
    let mut trajectory =
        (card.open)(&case.parameters, &case.initial, settings).expect("the case opens");
    let mut out = Vec::new();
    for _ in 0..=steps().min(case.steps) {
        let mut here = vec![0.0; card.observable_count()];
        trajectory.observe(&mut here);
        out.push(here);
        trajectory.step().expect("a step");
    }
    out
}

fn of_all(what: &mut dyn FnMut(&Card, &Case, &Judge, &[Vec<f64>])) {
    for entry in gallery() {
        for case in &entry.cases {
            let card = entry.card_of(case);
            let judge =
                judge(&card, case).unwrap_or_else(|e| panic!("{} {}: {e}", card.name, case.name));
            what(&card, case, &judge, &nodes(&card, case));
        }
    }
}

fn step(judge: &Judge, number: u64, both: &[Vec<f64>]) -> Judged {
    judge.step(number, &both[0], &both[1]).expect("judged")
}

#[test]
fn steps_of_the_gallery_hold() {
    let mut wrong = Vec::new();
    of_all(&mut |card, case, judge, nodes| {
        let mut worst = 0.0;
        let mut told = String::new();
        for (k, both) in nodes.windows(2).enumerate() {
            let judged = step(judge, k as u64 + 1, both);
            let part = judged.worst.expect("equations");
            if !(part.ratio() <= worst) {
                worst = part.ratio();
                told = format!("{part:?}");
            }
        }
        println!(
            "{:22} {:20} {worst:.3} {}",
            card.name,
            case.name,
            if worst > 0.5 { &told } else { "" }
        );
        if !(worst <= 1.0) {
            wrong.push(format!("{} {}: {worst} {told}", card.name, case.name));
        }
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
