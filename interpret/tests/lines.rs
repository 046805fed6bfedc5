//! Lines that run from their text: every number that they show equals, to the last bit, that of the stepper
//! which is compiled from the same statement.

#![allow(missing_docs, mixed_script_confusables)]

#[path = "lines/compiled.rs"]
mod compiled;

use clebsch_core::lattice::{Choice, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory};
use compiled::{Case, Compiled, Data};
use std::sync::Arc;

fn choice(source: &str, n: usize, ends: Option<[&str; 2]>) -> Choice {
    let model = pipeline::parse_source(source).expect("is a model");
    let lattice = Lattice::read(&model).expect("has labels");
    let choice = Choice::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", n).expect("has sites");
    match ends {
        None => choice.with_ring(&lattice).expect("closes"),
        Some([first, last]) => {
            let choice = choice.with_end(&lattice, false, first).expect("begins so");
            choice.with_end(&lattice, true, last).expect("ends so")
        }
    }
}

fn start(model: &Arc<LineModel>, source: &str, case: &Case, data: &Data) -> LineTrajectory {
    let choice = choice(source, case.n, case.ends);
    model
        .start(&choice, case.h, &|name| data.get(name))
        .expect("starts")
}

fn bits(list: &[f64]) -> Vec<u64> {
    list.iter().map(|x| x.to_bits()).collect()
}

/// Compares all that both show.
fn same(line: &mut LineTrajectory, built: &dyn Compiled, model: &LineModel, what: &str) {
    assert_eq!(line.node(), built.node(), "{what}");
    for name in model.observers() {
        let read = line.observe(name).expect("is observed");
        let own = built.seen(name);
        assert!(!own.is_empty(), "{what}: {name}");
        assert_eq!(bits(&read), bits(&own), "{what}: {name}");
    }
    let energies = line.energies().expect("has energies");
    assert_eq!(bits(&energies), bits(&built.energies()), "{what}: energies");
    let totals = built.totals();
    assert_eq!(model.totals().count(), totals.len(), "{what}");
    for (name, total) in totals {
        let read = line.total(name).expect("is conserved");
        assert_eq!(bits(&read), bits(&total), "{what}: {name}");
    }
}

#[test]
fn every_line_of_the_gallery_equals_the_compiled_one_to_the_last_bit() {
    for (source, make, cases) in compiled::all() {
        let model = LineModel::read(source).expect("is read");
        for case in cases {
            let data = make(&case);
            let (built, numbers) = &data;
            let mut built = built.clone_box();
            let what = format!("{} {case:?}", model.name());
            let mut line = start(&model, source, &case, numbers);
            same(&mut line, &*built, &model, &what);
            for step in 1..=200 {
                let (one, other) = (built.step(), line.step().map_err(|e| e.to_string()));
                assert_eq!(one, other, "{what} step {step}");
                one.expect("steps");
                if step < 4 || step % 50 == 0 {
                    same(&mut line, &*built, &model, &format!("{what} step {step}"));
                }
            }
        }
    }
}

#[test]
fn the_site_of_a_wrong_value_is_named() {
    let source = compiled::TODA;
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(50, None);
    let (_, numbers) = compiled::toda(&case);
    let started = |numbers: &Data| {
        let choice = choice(source, case.n, case.ends);
        let started = model.start(&choice, case.h, &|name| numbers.get(name));
        started.map(|_| ()).expect_err("is refused").to_string()
    };
    let wrong = numbers.with("q", |q| q[37] = f64::NAN);
    assert_eq!(
        started(&wrong),
        compiled::refused(&case, &wrong),
        "a number at site 37"
    );
    assert!(started(&wrong).contains("site 37"), "{}", started(&wrong));
    let short = numbers.with("momentum_q", |q| q.truncate(49));
    assert_eq!(started(&short), compiled::refused(&case, &short));
    assert!(started(&short).contains("49 sites"), "{}", started(&short));
    // A step that is refused: neighbours so far apart that the force is not a number.
    let far = numbers.with("q", |q| q[20] = 1e200);
    assert_eq!(started(&far), compiled::refused(&case, &far));
    assert!(started(&far).contains("site "), "{}", started(&far));
    let none = numbers.without("q");
    assert_eq!(started(&none), "`q` is not given");
}

#[test]
fn a_step_that_is_refused_is_refused_alike_and_leaves_the_state() {
    // Particles that run into one another.
    let source = compiled::WATER;
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(12, None);
    let (_, calm) = compiled::water(&case);
    let wild = calm.with("momentum_X", |p| p.iter_mut().for_each(|p| *p *= 400.0));
    let mut built = compiled::shallow_water(&case, &wild);
    let mut line = start(&model, source, &case, &wild);
    let refused = (0..1000).find_map(|_| {
        let (one, other) = (built.step(), line.step().map_err(|e| e.to_string()));
        assert_eq!(one, other);
        one.err()
    });
    let refused = refused.expect("they meet");
    assert!(refused.contains("at site "), "{refused}");
    same(&mut line, &*built, &model, &refused);
}
