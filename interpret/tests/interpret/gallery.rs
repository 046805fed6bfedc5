//! The models of the gallery, from their texts and compiled: cards, steps, observables, invariants and scales agree
//! bit for bit.

use crate::side_by_side::compare;
use clebsch::card::{Card, Settings};
use clebsch_models::{Entry, gallery};

/// How many steps are compared.
const STEPS: u64 = 1000;

/// The card that is read from the text of a compiled model.
fn read(entry: &Entry) -> Option<Card> {
    match clebsch_interpret::card(entry.card.source) {
        Ok(card) => Some(card),
        Err(refused) => {
            println!("{}: {refused}", entry.card.name);
            None
        }
    }
}

fn served() -> Vec<(Entry, Card)> {
    let mut all = Vec::new();
    for entry in gallery() {
        match read(&entry) {
            Some(card) => all.push((entry, card)),
            None => panic!("{} needs a build", entry.card.name),
        }
    }
    all
}

/// A card without the parts that differ: functions and chosen sizes.
fn comparable_parts(card: &Card) -> String {
    let all = [
        format!(
            "{:?}",
            (card.name, card.kebab, card.doc, card.source, card.summary)
        ),
        format!(
            "{:?}",
            (card.solver, card.order, card.orders, card.fingerprint)
        ),
        format!("{:?}", (card.preprocessed, card.reversible, card.solvers)),
        format!("{:?}", (card.parameters, card.initial, card.observables)),
        format!(
            "{:?}",
            (card.invariants, card.discrete_energy, card.dimensions)
        ),
    ];
    all.join("\n")
}

#[test]
fn cards_are_those_of_built_models() {
    for (entry, card) in served() {
        let sizes: Vec<usize> = entry.card.dimensions.iter().map(|d| d.value).collect();
        let card = (card.sized)(&sizes).unwrap_or(card);
        assert_eq!(
            comparable_parts(&entry.card),
            comparable_parts(&card),
            "{}",
            entry.card.name
        );
    }
}

#[test]
fn steps_agree_to_the_last_bit() {
    for (entry, card) in served() {
        for case in &entry.cases {
            let built = entry.card_of(case);
            let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
            let Some(read) = (card.sized)(&sizes) else {
                panic!("{} {sizes:?}", card.name);
            };
            let made = compare(
                &built,
                &read,
                case,
                Settings::step(case.h),
                STEPS.min(case.steps),
            );
            println!("{} {}: {made} steps", card.name, case.name);
        }
    }
}

#[test]
fn orders_and_solvers_agree_to_the_last_bit() {
    for (entry, card) in served() {
        let Some(case) = entry.cases.first() else {
            continue;
        };
        let built = entry.card_of(case);
        let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
        let Some(read) = (card.sized)(&sizes) else {
            panic!("{} {sizes:?}", card.name);
        };
        let plain = Settings::step(case.h);
        for order in [1, 2, 3, 4, 6, 8, 10] {
            compare(&built, &read, case, plain.of_order(order), 60);
            let compensated = Settings {
                compensated: true,
                ..plain.of_order(order)
            };
            compare(&built, &read, case, compensated, 60);
        }
        for name in clebsch::solvers::Method::ALL {
            let settings = Settings {
                solver: Some(name),
                ..plain
            };
            compare(&built, &read, case, settings, 60);
        }
    }
}

#[test]
fn refusals_are_told_alike() {
    for (entry, card) in served() {
        // If Newton's method rejects a step, the search for a smaller step takes many steps.
        let few = if card.solver.contains("Newton") {
            1
        } else {
            entry.cases.len()
        };
        for case in entry.cases.iter().take(few) {
            let built = entry.card_of(case);
            let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
            let Some(read) = (card.sized)(&sizes) else {
                panic!("{} {sizes:?}", card.name);
            };
            // Steps that are too large, for both kinds of start, and values that are NaN.
            for h in [0.0, -1.0, f64::NAN, 10.0 * case.h, 1e3 * case.h, 1e9] {
                compare(&built, &read, case, Settings::step(h), 20);
            }
            for spoiled in [f64::NAN, -1.0] {
                for i in 0..case.parameters.len() {
                    let mut other = case.clone();
                    if let Some(x) = other.parameters[i].first_mut() {
                        *x = spoiled;
                    }
                    compare(&built, &read, &other, Settings::step(case.h), 20);
                }
                for i in 0..case.initial.len() {
                    let mut other = case.clone();
                    if let Some(x) = other.initial[i].first_mut() {
                        *x = spoiled;
                    }
                    compare(&built, &read, &other, Settings::step(case.h), 20);
                }
            }
        }
    }
}

/// More functionals than an earlier table could contain, each with its own action.
#[test]
fn any_number_of_models_opens_and_a_text_is_read_once() {
    let text = |i: u32| {
        format!(
            "model Spring {{ field x: Real; lagrangian = (next(x) - x)^2/(2*h) - h*{i}*x^2/2; }}"
        )
    };
    for i in 1..=70 {
        let of_text = clebsch_interpret::card(&text(i)).unwrap_or_else(|e| panic!("{e}"));
        let again = clebsch_interpret::card(&text(i)).unwrap_or_else(|e| panic!("{e}"));
        assert!(std::ptr::addr_eq(of_text.open, again.open));
        let opened = (of_text.open)(&[], &[vec![1.0], vec![0.0]], Settings::step(0.1));
        let mut motion = opened.unwrap_or_else(|e| panic!("{e}"));
        motion.step().unwrap_or_else(|e| panic!("{e}"));
        let mut seen = [0.0; 2];
        motion.observe(&mut seen);
        let wanted = 1.0 - 0.005 * f64::from(i);
        assert!((seen[0] - wanted).abs() < 1e-15, "{i}: {seen:?}");
    }
}
