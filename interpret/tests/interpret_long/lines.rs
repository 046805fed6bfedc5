//! Chains that run from their text. Every number equals, bit for bit, the number from the stepper that is compiled from
//! the same statement.

use crate::comparison::{self, choice, same, split, start};
use crate::compiled::{self, Case, Data, Line, TodaLine, WaterLine, coupled_velocities, newton};
use clebsch::card::{Field, Invariant};
use clebsch_core::expr::symbol::ascii;
use clebsch_interpret::lines::{LineModel, NoLine};

#[test]
fn every_line_of_the_gallery_equals_the_compiled_one_to_the_last_bit() {
    comparison::equal_to_the_last_bit(compiled::all().into_iter().chain(newton::all()));
}

#[test]
fn the_site_of_a_wrong_value_is_named() {
    let source = compiled::TODA;
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(50, None);
    let numbers = compiled::toda(&case);
    let started = |data: &Data| comparison::refused(&model, source, &case, data);
    let compiled = |data: &Data| TodaLine::of(&case, data).err().unwrap_or_default();
    let wrong = numbers.with("q", |q| q[37] = f64::NAN);
    assert_eq!(started(&wrong), compiled(&wrong), "a number at site 37");
    assert!(started(&wrong).contains("site 37"), "{}", started(&wrong));
    let short = numbers.with("momentum_q", |q| q.truncate(49));
    assert_eq!(started(&short), compiled(&short));
    assert!(started(&short).contains("49 sites"), "{}", started(&short));
    // A step that fails: neighbours are so far apart that the force is NaN.
    let far = numbers.with("q", |q| q[20] = 1e200);
    assert_eq!(started(&far), compiled(&far));
    // The error names this site, not the previous one, which the step also corrupts.
    assert!(started(&far).contains("site 20:"), "{}", started(&far));
    let none = numbers.without("q");
    assert_eq!(started(&none), "`q` is missing");
}

#[test]
fn a_step_that_is_refused_is_refused_alike_and_leaves_the_state() {
    // Particles that collide.
    let source = compiled::WATER;
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(12, None);
    let calm = compiled::water(&case);
    let wild = calm.with("momentum_X", |p| p.iter_mut().for_each(|p| *p *= 400.0));
    let mut built = WaterLine::of(&case, &wild).expect("starts");
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

#[test]
fn a_step_beyond_a_fold_is_refused_alike_and_names_its_site() {
    let source = newton::Steep::<f64>::SOURCE;
    let model = LineModel::read(source).expect("is read");
    let case = Case {
        h: 0.5,
        ..Case::new(12, None)
    };
    let calm = newton::steep(&Case::new(12, None));
    let wild = calm.with("q", |q| q[7] = 40.0).with("k", |k| k[0] = -0.8);
    let told = newton::SteepLine::of(&case, &wild).map(|_| ());
    let told = told.expect_err("is refused");
    assert_eq!(comparison::refused(&model, source, &case, &wild), told);
    assert!(
        told.contains("site 7") && told.contains("percent"),
        "{told}"
    );
}

/// Long, since every line is derived body by body.
#[test]
fn every_line_moves_as_its_bodies_do() {
    comparison::move_as_bodies_do(compiled::all(), 5);
}

#[test]
fn a_term_that_is_left_out_is_seen() {
    // The statement without one of its coupling terms, compared with the compiled chain that has it.
    let without = [
        (compiled::TODA, " + a*r)", ")"),
        (compiled::TODA, "(a/b)*exp(-b*r) + ", ""),
        (
            compiled::ROD,
            "\n        + (h/s)*tr(B*(Λ^T*next(Λ, i) - Id))",
            "",
        ),
    ];
    for (source, term, rest) in without {
        comparison::another_term_is_seen(&compiled::all(), source, term, rest);
    }
}

#[test]
fn velocities_of_all_sites_are_found_together_to_the_last_bit_and_as_those_of_bodies() {
    comparison::equal_to_the_last_bit(coupled_velocities::all());
    comparison::move_as_bodies_do(coupled_velocities::all(), 5);
    comparison::go_on(coupled_velocities::all());
}

#[test]
fn bodies_whose_velocities_are_joined_run_with_sixty_segments() {
    let own = coupled_velocities::all().remove(0);
    let case = Case::new(60, None);
    let settings = clebsch::card::Settings::step(case.h);
    let (card, mut line) = comparison::opened(own.source, &case, &(own.data)(&case), settings);
    let told = "one for any number of sites";
    assert!(card.summary.contains(told), "{}", card.summary);
    line.step().expect("steps");
    let mut sums = vec![f64::NAN; card.invariant_count()];
    line.invariants(&mut sums);
    assert!(sums.iter().all(|x| x.is_finite()), "{sums:?}");
}

#[test]
fn a_line_is_written_down_and_goes_on_to_the_last_bit() {
    comparison::go_on(compiled::all());
}

#[test]
fn what_loops_over_sites_do_not_take_is_run_body_by_body_or_refused_at_once() {
    let source =
        "model Coupled { label i in 0..N; param m: Real; param k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + (k/h)*(next(prev(q, i)) - prev(q, i))*(next(next(q, i)) - next(q, i)); }";
    let why = match LineModel::read(source) {
        Err(NoLine::Form(why)) => why,
        other => panic!("{other:?}"),
    };
    let card = |n: usize| {
        let chosen = choice(source, n, Some(["free", "free"]));
        clebsch_interpret::card_on_lattice(source, &chosen)
    };
    assert!(card(6).is_ok());
    let told = card(60).expect_err("is refused").to_string();
    for part in ["`i = 60`", "at most `i = 32`", &why] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

/// Long, since every line is derived with twelve and with a hundred sites.
#[test]
fn the_card_of_a_long_line_says_what_that_of_its_bodies_says() {
    // The cards agree in observables and invariants, except for omitted sites.
    for Line { source, cases, .. } in compiled::all() {
        let model = LineModel::read(source).expect("is read");
        let observed = |f: &Field| model.observers().any(|o| ascii(&o) == split(f).0);
        for case in cases.iter().filter(|c| c.n == 12) {
            let card = |n: usize| {
                let chosen = choice(source, n, case.ends);
                let card = clebsch_interpret::card_on_lattice(source, &chosen);
                card.expect("is read").0
            };
            // In a ring of even length, even and odd sites may form two separate sets.
            let n = 12 + usize::from(case.ends.is_none());
            let (short, long) = (card(n), card(100));
            let shifted = |n: usize, field: &Field| {
                let (key, site) = split(field);
                let from_end = site.map(|s| if s < 6 { (s, 0) } else { (6, n - s) });
                (key.to_owned(), from_end, field.kind, field.rows, field.cols)
            };
            let of = |n: usize, fields: &[Field]| {
                let all = fields.iter().map(|f| shifted(n, f));
                let mut all: Vec<_> = all.filter(|f| f.1.is_none_or(|s| s.1 < 6)).collect();
                all.dedup();
                all
            };
            for (own, other) in [
                (short.parameters, long.parameters),
                (short.initial, long.initial),
                (
                    // Derived quantities are not observed along a chain, and the summary lists them.
                    &short
                        .observables
                        .iter()
                        .copied()
                        .filter(observed)
                        .collect::<Vec<Field>>(),
                    long.observables,
                ),
            ] {
                assert_eq!(of(n, own), of(100, other), "{case:?}");
            }
            let known = |i: &&Invariant| i.name == "energy" || model.totals().any(|t| t == i.name);
            let kept: Vec<&Invariant> = short.invariants.iter().filter(known).collect();
            assert_eq!(kept.len(), long.invariants.len(), "{case:?}");
            for (own, other) in kept.iter().zip(long.invariants) {
                // If every site conserves a quantity, the card lists the sum.
                match own.rows == other.rows {
                    true => assert_eq!(*own, other, "{case:?}"),
                    false => {
                        let sum = format!("the sum of {}", own.formula);
                        assert_eq!((own.name, &*sum), (other.name, other.formula), "{case:?}");
                        // One more node than segments on an open line.
                        assert_eq!((own.rows, other.rows), (13, 1), "{case:?}");
                    }
                }
            }
            let lost = short
                .invariants
                .iter()
                .filter(|i| long.invariants.iter().all(|other| other.name != i.name));
            for invariant in lost {
                let name = invariant.name.replace(&format!("_{n}"), "_100");
                assert!(long.summary.contains(&name), "{name}: {}", long.summary);
            }
        }
    }
}
