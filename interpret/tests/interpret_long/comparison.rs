//! Chains that run from their text, compared with compiled chains and with bodies expanded site by site.

use crate::compiled::{Case, Compiled, Data, Line};
use clebsch::card::{Card, Field, Settings, Trajectory};
use clebsch::saved::{Saved, Words};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory};
use std::sync::Arc;

pub fn choice(source: &str, n: usize, ends: Option<[&str; 2]>) -> ChainConfig {
    let model = pipeline::parse_source(source).expect("is a model");
    let lattice = Lattice::read(&model).expect("has labels");
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", n).expect("has sites");
    match ends {
        None => choice.with_ring(&lattice).expect("closes"),
        Some([first, last]) => {
            let choice = choice.with_end(&lattice, false, first).expect("begins so");
            choice.with_end(&lattice, true, last).expect("ends so")
        }
    }
}

pub fn start(model: &Arc<LineModel>, source: &str, case: &Case, data: &Data) -> LineTrajectory {
    let choice = choice(source, case.n, case.ends);
    model
        .start(&choice, case.h, &|name| data.get(name))
        .expect("starts")
}

pub fn bits(list: &[f64]) -> Vec<u64> {
    list.iter().map(|x| x.to_bits()).collect()
}

/// Compares all observables.
pub fn same(line: &mut LineTrajectory, built: &dyn Compiled, model: &LineModel, what: &str) {
    assert_eq!(line.node(), built.node(), "{what}");
    for name in model.observers() {
        let read = line.observe(&name).expect("is observed");
        let own = built.seen(&name);
        assert!(!own.is_empty(), "{what}: {name}");
        assert_eq!(bits(&read), bits(&own), "{what}: {name}");
    }
    let energies = line.energies().expect("has energies");
    assert_eq!(bits(&energies), bits(&built.energies()), "{what}: energies");
    let totals = built.totals();
    let names: Vec<&str> = model.totals().collect();
    assert_eq!(names.len(), totals.len(), "{what}: {names:?}");
    for (name, total) in totals {
        let read = line.total(name).expect("is conserved");
        assert_eq!(bits(&read), bits(&total), "{what}: {name}");
    }
}

/// The name of a quantity and its site.
pub fn split(field: &Field) -> (&str, Option<usize>) {
    match field.ascii.rsplit_once('_') {
        Some((key, site)) if site.parse::<usize>().is_ok() => (key, site.parse().ok()),
        _ => (field.ascii, None),
    }
}

/// The values of fields of a card.
pub fn values(fields: &[Field], data: &Data) -> Vec<Vec<f64>> {
    let each = fields.iter().map(|field| {
        let (key, site) = split(field);
        let list = data.of_ascii(key).expect("is given");
        let at = match list.len() == field.count() {
            // The same value at every site, or a value of an end.
            true => 0,
            false => site.expect("has a site") * field.count(),
        };
        list[at..at + field.count()].to_vec()
    });
    each.collect()
}

/// Every number that a trajectory shows, next to the number of the chain; for energies the change since the start,
/// because the bodies omit constants.
pub fn beside(
    (card, bodies): (&Card, &dyn Trajectory),
    line: &mut LineTrajectory,
    model: &LineModel,
    energies: [f64; 2],
) -> Vec<[f64; 2]> {
    let mut all = vec![0.0; card.observable_count()];
    bodies.observe(&mut all);
    let mut pairs = Vec::new();
    let mut from = 0;
    for field in card.observables {
        let (key, site) = split(field);
        let own = &all[from..from + field.count()];
        from += field.count();
        let Some(name) = model.observers().find(|o| ascii(o) == key) else {
            continue;
        };
        let list = line.observe(&name).expect("is observed");
        // A quantity of the whole chain does not have a site.
        let at = site.unwrap_or(0) * field.count();
        let pair = own.iter().zip(&list[at..at + field.count()]);
        pairs.extend(pair.map(|(x, y)| [*x, *y]));
    }
    let mut sums = vec![0.0; card.invariant_count()];
    bodies.invariants(&mut sums);
    let mut from = 0;
    for invariant in card.invariants {
        let own = &sums[from..from + invariant.rows];
        from += invariant.rows;
        if invariant.name == "energy" {
            let [kinetic, potential] = line.energies().expect("has energies");
            pairs.push([own[0] - energies[0], kinetic + potential - energies[1]]);
            continue;
        }
        let Some(values) = line.total(invariant.name) else {
            // An invariant for this choice of ends only, not for every chain.
            continue;
        };
        match own.len() == values.len() {
            true => pairs.extend(own.iter().zip(&values).map(|(x, y)| [*x, *y])),
            // If every site conserves a quantity, the chain reports the sum.
            false => pairs.extend(values.iter().map(|y| [own.iter().sum(), *y])),
        }
    }
    pairs
}

/// The energies of both at the start.
pub fn energies(bodies: &dyn Trajectory, line: &mut LineTrajectory) -> [f64; 2] {
    let card = bodies.card();
    let mut sums = vec![0.0; card.invariant_count()];
    bodies.invariants(&mut sums);
    let before = card.invariants.iter().take_while(|i| i.name != "energy");
    let at: usize = before.map(|i| i.rows).sum();
    let [kinetic, potential] = line.energies().expect("has energies");
    [sums[at], kinetic + potential]
}

/// The card of a line and its trajectory of these data.
pub fn opened(
    source: &str,
    case: &Case,
    data: &Data,
    settings: Settings,
) -> (Card, Box<dyn Trajectory>) {
    let chosen = choice(source, case.n, case.ends);
    let (card, _) = clebsch_interpret::card_on_lattice(source, &chosen).expect("a card");
    let (parameters, initial) = (values(card.parameters, data), values(card.initial, data));
    let line = (card.open)(&parameters, &initial, settings);
    (card, line.expect("starts"))
}

/// Chains from their text equal compiled chains bit for bit.
pub fn equal_to_the_last_bit(lines: impl IntoIterator<Item = Line>) {
    for own in lines {
        let model = LineModel::read(own.source).expect("is read");
        for case in &own.cases {
            let (mut built, numbers) = own.made(case);
            let what = format!("{} {case:?}", model.name());
            let mut line = start(&model, own.source, case, &numbers);
            same(&mut line, &*built, &model, &what);
            for step in 1..=200 {
                let what = format!("{what} step {step}");
                let (one, other) = (built.step(), line.step().map_err(|e| e.to_string()));
                assert_eq!(one, other, "{what}");
                one.expect("steps");
                if step < 4 || step % 50 == 0 {
                    same(&mut line, &*built, &model, &what);
                }
            }
        }
    }
}

/// Chains move as the expanded bodies do.
pub fn move_as_bodies_do(lines: impl IntoIterator<Item = Line>, sites: usize) {
    for own in lines {
        let source = own.source;
        let model = LineModel::read(source).expect("is read");
        for case in own.cases.iter().filter(|c| c.n == sites) {
            let data = (own.data)(case);
            let chosen = choice(source, case.n, case.ends);
            let (card, _) =
                clebsch_interpret::card_body_by_body(source, &chosen).expect("is written out");
            let (parameters, initial) =
                (values(card.parameters, &data), values(card.initial, &data));
            let settings = Settings::step(case.h);
            let mut bodies = (card.open)(&parameters, &initial, settings).expect("starts");
            let mut line = start(&model, source, case, &data);
            let energies = energies(&*bodies, &mut line);
            for _ in 0..20 {
                bodies.step().expect("steps");
                line.step().expect("steps");
            }
            let pairs = beside((&card, &*bodies), &mut line, &model, energies);
            assert!(pairs.len() > 8, "{case:?}");
            for [x, y] in pairs {
                // Twenty steps with a few roundings each, for numbers up to ten.
                assert!(
                    (x - y).abs() < 1e-12 * x.abs().max(10.0),
                    "{case:?}: {x} {y}"
                );
            }
        }
    }
}

/// Chains are saved and restored bit for bit.
pub fn go_on(lines: impl IntoIterator<Item = Line>) {
    for own in lines {
        let source = own.source;
        let model = LineModel::read(source).expect("is read");
        let case = own.cases.last().expect("has cases");
        let data = (own.data)(case);
        let mut whole = start(&model, source, case, &data);
        for _ in 0..20 {
            whole.step().expect("steps");
        }
        let mut words = Words::gathered();
        whole.words(&mut words);
        let list = words.into_list().expect("is written down");
        let mut again = start(&model, source, case, &data);
        again.words(&mut Words::given(list));
        assert_eq!(again.node(), 20);
        for _ in 0..20 {
            whole.step().expect("steps");
            again.step().expect("steps");
        }
        for name in model.observers() {
            let (one, other) = (whole.observe(&name), again.observe(&name));
            let (one, other) = (one.expect("is there"), other.expect("is there"));
            assert_eq!(bits(&one), bits(&other), "{}: {name}", model.name());
        }
    }
}

/// The same for composed steps, from the card.
pub fn go_on_composed(lines: impl IntoIterator<Item = Line>) {
    for own in lines {
        let case = own.cases.last().expect("has cases");
        let data = (own.data)(case);
        let start = |order| {
            let settings = Settings {
                order,
                ..Settings::step(case.h)
            };
            opened(own.source, case, &data, settings)
        };
        let (card, _) = start(None);
        if !card.orders.contains(&4) {
            continue;
        }
        let [(_, mut whole), (_, mut again)] = [start(Some(4)), start(Some(4))];
        for _ in 0..5 {
            whole.step().expect("steps");
        }
        let mut words = Words::gathered();
        whole.words(&mut words);
        again.words(&mut Words::given(
            words.into_list().expect("is written down"),
        ));
        let seen = [whole, again].map(|mut line| {
            for _ in 0..5 {
                line.step().expect("steps");
            }
            let mut all = vec![0.0; card.observable_count()];
            line.observe(&mut all);
            all
        });
        for list in &seen {
            assert!(list.iter().all(|x| x.is_finite()), "{}", card.name);
        }
        assert!(bits(&seen[0]) == bits(&seen[1]), "{}", card.name);
    }
}

/// A statement with a different term gives numbers that differ from the compiled chain.
pub fn another_term_is_seen(lines: &[Line], source: &str, term: &str, rest: &str) {
    let mutated = source.replacen(term, rest, 1);
    assert_ne!(mutated, source, "{term}");
    let model = LineModel::read(&mutated).expect("is read");
    let own = lines.iter().find(|own| own.source == source);
    let case = Case::new(5, Some(["free", "free"]));
    let (mut built, data) = own.expect("is here").made(&case);
    let mut line = start(&model, &mutated, &case, &data);
    for _ in 0..3 {
        built.step().expect("steps");
        line.step().expect("steps");
    }
    let differs = model.observers().any(|name| {
        let read = line.observe(&name).expect("is observed");
        bits(&read) != bits(&built.seen(&name))
    });
    assert!(differs, "{term}");
}

/// The error if a chain cannot start with the data.
pub fn refused(model: &Arc<LineModel>, source: &str, case: &Case, data: &Data) -> String {
    let chosen = choice(source, case.n, case.ends);
    let started = model.start(&chosen, case.h, &|name| data.get(name));
    started.map(|_| ()).expect_err("is refused").to_string()
}
