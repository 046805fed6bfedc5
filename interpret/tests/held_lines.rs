//! Lines with held constraints that run from their text: every number equals, to the last bit, that of the stepper which is
//! compiled, and to rounding that of the bodies written out.

#![allow(missing_docs, mixed_script_confusables)]

#[allow(dead_code)]
#[path = "lines/beside.rs"]
mod beside;
#[allow(dead_code)]
#[path = "lines/compiled.rs"]
mod compiled;

use beside::{bits, choice, start};
use clebsch::card::{Field, Settings};
use clebsch_interpret::lines::LineModel;
use compiled::{Case, held, sums};

#[test]
fn held_lines_equal_the_compiled_ones_to_the_last_bit() {
    beside::equal_to_the_last_bit(held::all().into_iter());
    beside::equal_to_the_last_bit(sums::all().into_iter());
}

#[test]
fn held_lines_move_as_their_bodies_do() {
    beside::move_as_bodies_do(held::all().into_iter(), 3);
    beside::move_as_bodies_do(sums::all().into_iter(), 3);
}

#[test]
fn totals_about_what_ends_hold_equal_the_compiled_ones_and_those_of_bodies() {
    beside::equal_to_the_last_bit(compiled::strung::all().into_iter());
    beside::move_as_bodies_do(compiled::strung::all().into_iter(), 5);
    let (source, make, _) = compiled::strung::all().remove(0);
    for (ends, name) in [
        (["pinned", "free"], "total_momentum_angular_about_X"),
        (["free", "pinned"], "total_momentum_angular_about_X"),
        (["pinned", "pinned"], "joint_momentum_across_X_angular"),
        (["free", "free"], "total_momentum_angular"),
    ] {
        // More sites than are written out: the card lists the total, and it does not drift.
        let case = Case::new(60, Some(ends));
        let chosen = choice(source, case.n, case.ends);
        let (card, _) = clebsch_interpret::card_on_lattice(source, &chosen).expect("a card");
        let listed = card.invariants.iter().any(|i| i.name == name);
        assert!(listed, "{ends:?}: {:?}", card.invariants);
        let model = LineModel::read(source).expect("is read");
        let (_, data) = make(&case);
        let mut line = start(&model, source, &case, &data);
        let total = |line: &mut clebsch_interpret::lines::LineTrajectory| {
            line.total(name).expect("is conserved")
        };
        let before = total(&mut line);
        let size: f64 = line.total_sizes(name).expect("has sizes").iter().sum();
        for _ in 0..100 {
            line.step().expect("steps");
        }
        for (x, y) in before.iter().zip(total(&mut line)) {
            // A few roundings of every term in each of a hundred steps.
            assert!((x - y).abs() < 1e-13 * size, "{ends:?}: {x} {y}, {size}");
        }
    }
}

/// The order of composed steps, of places and momenta; and a step that cannot be made leaves the line where it was.
#[test]
fn composed_steps_have_their_order() {
    let of_held = held::all().remove(1);
    let of_rod = compiled::all()
        .into_iter()
        .find(|(source, ..)| *source == compiled::ROD);
    let lines = [
        ((compiled::TODA, compiled::toda as _), Case::new(40, None)),
        (
            of_rod
                .map(|(source, make, _)| (source, make))
                .expect("is here"),
            Case::new(40, Some(["clamped", "load"])),
        ),
        (
            (of_held.0, of_held.1),
            Case::new(5, Some(["pinned", "free"])),
        ),
    ];
    for ((source, make), case) in lines {
        let (_, data) = make(&case);
        let chosen = choice(source, case.n, case.ends);
        let (card, _) = clebsch_interpret::card_on_lattice(source, &chosen).expect("a card");
        assert_eq!(card.orders, [2, 4, 6, 8], "{}", card.name);
        let (parameters, initial) = (
            beside::values(card.parameters, &data),
            beside::values(card.initial, &data),
        );
        let end = |order: u32, steps: u32| {
            let settings = Settings {
                order: Some(order),
                ..Settings::step(0.16 / f64::from(steps))
            };
            let mut line = (card.open)(&parameters, &initial, settings).expect("starts");
            for _ in 0..steps {
                line.step().expect("steps");
            }
            assert_eq!(line.node(), u64::from(steps));
            // What the data begin with; multipliers are those of the last part.
            let mut all = vec![0.0; card.observable_count()];
            line.observe(&mut all);
            let given = |f: &Field| data.of_ascii(beside::split(f).0).is_some();
            let of = card.observables.iter();
            let moving: Vec<bool> = of.flat_map(|f| vec![given(f); f.count()]).collect();
            let all = all.into_iter().zip(moving);
            all.filter(|(_, moves)| *moves)
                .map(|(x, _)| x)
                .collect::<Vec<f64>>()
        };
        let truth = end(8, 16);
        let error = |order, steps| {
            let all = end(order, steps);
            let off = all.iter().zip(&truth).map(|(x, y)| x - y);
            clebsch::scalar::largest(off)
        };
        for (order, steps) in [(2, 8), (4, 8), (6, 4)] {
            let (coarse, fine) = (error(order, steps), error(order, 2 * steps));
            let measured = (coarse / fine).log2();
            assert!(
                (measured - f64::from(order)).abs() < 0.15,
                "{} of order {order}: {measured:.3}, {coarse:e} {fine:e}",
                card.name
            );
        }
    }
}

#[test]
fn a_composed_step_that_is_refused_leaves_the_line_where_it_was() {
    let source = compiled::WATER;
    let case = Case::new(40, None);
    let (_, calm) = compiled::water(&case);
    // Particles that run into one another.
    let wild = calm.with("momentum_X", |p| p.iter_mut().for_each(|p| *p *= 400.0));
    let chosen = choice(source, case.n, case.ends);
    let (card, _) = clebsch_interpret::card_on_lattice(source, &chosen).expect("a card");
    let (parameters, initial) = (
        beside::values(card.parameters, &wild),
        beside::values(card.initial, &wild),
    );
    let settings = Settings {
        order: Some(4),
        ..Settings::step(0.02)
    };
    let mut line = (card.open)(&parameters, &initial, settings).expect("starts");
    let mut seen = vec![0.0; card.observable_count()];
    let refused = (0..1000).find_map(|node| {
        line.observe(&mut seen);
        line.step().err().map(|e| (node, e.to_string()))
    });
    let (node, words) = refused.expect("they meet");
    assert_eq!(line.node(), node);
    let mut after = vec![0.0; seen.len()];
    line.observe(&mut after);
    assert_eq!(bits(&seen), bits(&after), "{words}");
    assert!(words.contains("site "), "{words}");
}

#[test]
fn a_held_line_is_written_down_and_goes_on_to_the_last_bit() {
    beside::go_on(held::all().into_iter());
    beside::go_on(sums::all().into_iter());
    beside::go_on_composed(held::all().into_iter());
    beside::go_on_composed(sums::all().into_iter());
}

#[test]
fn a_wrong_sign_of_what_is_held_is_seen() {
    let wrong = [
        (held::ROD, " + (h/s)*tr(B*Λ^T*next(Λ, i))", ""),
        (
            held::CHAIN,
            "dot(V, V)/2 + dot(g, x)",
            "dot(V, V)/2 - dot(g, x)",
        ),
        // Other beads, the same at the start: the second link of three is held twice as heavily.
        (
            held::CHAIN,
            "dot(next(x, i) - x, next(x, i) - x) = a^2",
            "dot(next(x, i) - x, next(x, i) - x)^2 = a^4",
        ),
    ];
    for (source, term, rest) in wrong {
        let mutated = source.replacen(term, rest, 1);
        assert_ne!(mutated, source, "{term}");
        let model = LineModel::read(&mutated).expect("is read");
        let all = held::all();
        let (_, make, _) = all
            .iter()
            .find(|(own, ..)| *own == source)
            .expect("is here");
        let case = Case::new(5, Some(["free", "free"]));
        let (mut built, data) = make(&case);
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
}

#[test]
fn data_off_a_constraint_are_refused_at_their_site() {
    let model = LineModel::read(held::CHAIN).expect("is read");
    let case = Case::new(50, Some(["pinned", "free"]));
    let all = held::all();
    let (_, make, _) = &all[1];
    let (_, data) = make(&case);
    let chosen = choice(held::CHAIN, case.n, case.ends);
    let refused = |data: &compiled::Data| {
        let started = model.start(&chosen, case.h, &|name| data.get(name));
        started.map(|_| ()).expect_err("is refused").to_string()
    };
    let off = refused(&data.with("a", |a| a[31] *= 1.001));
    assert!(
        off.contains("site 31") && off.contains("off the constraint"),
        "{off}"
    );
    let across = refused(&data.with("momentum_x", |p| p[3 * 50 + 2] = -0.4));
    assert!(
        across.contains("site 49") && across.contains("is not tangent to the constraint"),
        "{across}"
    );
}

#[test]
fn a_site_without_mass_is_told_as_such() {
    let model = LineModel::read(held::ROD).expect("is read");
    let case = Case::new(50, Some(["free", "free"]));
    let (_, data) = (held::all()[0].1)(&case);
    let chosen = choice(held::ROD, case.n, case.ends);
    let refused = |name: &'static str, change: fn(&mut Vec<f64>)| {
        let data = data.with(name, change);
        let started = model.start(&chosen, case.h, &|name| data.get(name));
        started.map(|_| ()).expect_err("is refused").to_string()
    };
    let told = refused("m", |m| m[31] = 0.0);
    for part in ["site 31", "`φ`", "mass is zero", "positive mass"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(!told.contains("follow from others"), "{told}");
}

/// Rows of a long line come from the short one: every multiplier has its place, constraints of all sites are told together.
#[test]
fn the_card_of_a_long_held_line_tells_multipliers_and_constraints() {
    for ((source, ..), multiplier) in held::all().iter().zip(["n", "lambda"]) {
        let chosen = choice(source, 60, Some(["pinned", "free"]));
        let (card, _) = clebsch_interpret::card_on_lattice(source, &chosen).expect("is read");
        let own = card.observables.iter().map(|f| f.ascii);
        let held: Vec<&str> = own
            .filter(|n| n.rsplit_once('_').is_some_and(|(k, _)| k == multiplier))
            .collect();
        assert_eq!(held.len(), 60, "{held:?}");
        let names: Vec<&str> = card.invariants.iter().map(|i| i.name).collect();
        for level in ["constraint", "constraint_rate"] {
            assert!(
                names.contains(&format!("{level}_{multiplier}").as_str()),
                "{names:?}"
            );
        }
        let held = names.iter().filter(|n| n.starts_with("constraint"));
        assert_eq!(held.count(), 2, "{names:?}");
        assert!(!card.summary.contains("_2, constraint"), "{}", card.summary);
        assert!(card.summary.contains("loops over them"), "{}", card.summary);
    }
}

/// What sums hold is told without a site, and a sum that no motion changes is refused.
#[test]
fn data_off_a_sum_are_refused_with_the_equation() {
    let (source, make, _) = sums::all().swap_remove(0);
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(50, None);
    let (_, data) = make(&case);
    let chosen = choice(source, case.n, case.ends);
    let refused = |data: &compiled::Data| {
        let started = model.start(&chosen, case.h, &|name| data.get(name));
        started.map(|_| ()).expect_err("is refused").to_string()
    };
    let off = refused(&data.with("X", |x| x[0] += 0.1));
    for wanted in ["p", "off the constraint", "∑_{i=0}^{N-1} s Λ_{i,k} E₃ = X"] {
        assert!(off.contains(wanted), "{off}");
    }
    assert!(!off.contains("site"), "{off}");
    let across = refused(&data.with("body_momentum_Λ", |p| p[31] = 0.4));
    assert!(
        across.contains("is not tangent to the constraint"),
        "{across}"
    );
    // All along one axis: no turn changes the length to first order.
    let straight = data.with("Λ", |turns| {
        let one = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        turns.chunks_mut(9).for_each(|m| m.copy_from_slice(&one));
    });
    let straight = straight.with("X", |x| x.copy_from_slice(&[0.0, 0.0, 25.0]));
    let told = refused(&straight);
    assert!(told.contains("not determined"), "{told}");
    let short = refused(&data.with("X", |x| x.truncate(2)));
    assert!(short.contains("`X` takes 3 numbers"), "{short}");
}
