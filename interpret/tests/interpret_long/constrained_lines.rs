//! Chains with constraints that run from their text. Every number equals the number from the compiled stepper bit for
//! bit, and the number from the expanded bodies to rounding.

use crate::comparison::{self, bits, choice, start};
use crate::compiled::{self, Case, constraints, springs, sums};
use clebsch::card::{Field, Settings};
use clebsch_interpret::lines::LineModel;

#[test]
fn held_lines_equal_the_compiled_ones_to_the_last_bit() {
    comparison::equal_to_the_last_bit(constraints::all());
    comparison::equal_to_the_last_bit(sums::all());
}

/// Long, since every line is derived body by body.
#[test]
fn held_lines_move_as_their_bodies_do() {
    comparison::move_as_bodies_do(constraints::all(), 3);
    comparison::move_as_bodies_do(sums::all(), 3);
}

#[test]
fn totals_about_what_ends_hold_equal_the_compiled_ones_and_those_of_bodies() {
    comparison::equal_to_the_last_bit([springs::line()]);
    comparison::move_as_bodies_do([springs::line()], 5);
    let strung = springs::line();
    for (ends, name) in [
        (["pinned", "free"], "total_momentum_angular_about_X"),
        (["free", "pinned"], "total_momentum_angular_about_X"),
        (["pinned", "pinned"], "joint_momentum_across_X_angular"),
        (["free", "free"], "total_momentum_angular"),
    ] {
        // More sites than are written out: the card lists the total, and it does not drift.
        let case = Case::new(60, Some(ends));
        let data = (strung.data)(&case);
        let settings = Settings::step(case.h);
        let (card, _) = comparison::opened(strung.source, &case, &data, settings);
        let listed = card.invariants.iter().any(|i| i.name == name);
        assert!(listed, "{ends:?}: {:?}", card.invariants);
        let model = LineModel::read(strung.source).expect("is read");
        let mut line = start(&model, strung.source, &case, &data);
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

/// The order of composed steps, for positions and momenta. A failed step leaves the chain unchanged.
#[test]
fn composed_steps_have_their_order() {
    let [_, of_held, _] = constraints::all();
    let of = |source: &str| {
        let mut all = compiled::all().into_iter();
        all.find(|own| own.source == source).expect("is here")
    };
    let lines = [
        (of(compiled::TODA), Case::new(40, None)),
        (of(compiled::ROD), Case::new(40, Some(["clamped", "load"]))),
        (of_held, Case::new(5, Some(["pinned", "free"]))),
    ];
    for (own, case) in lines {
        let data = (own.data)(&case);
        let (card, _) = comparison::opened(own.source, &case, &data, Settings::step(case.h));
        assert_eq!(card.orders, [2, 4, 6, 8], "{}", card.name);
        let end = |order: u32, steps: u32| {
            let settings = Settings {
                order: Some(order),
                ..Settings::step(0.16 / f64::from(steps))
            };
            let (_, mut line) = comparison::opened(own.source, &case, &data, settings);
            for _ in 0..steps {
                line.step().expect("steps");
            }
            assert_eq!(line.node(), u64::from(steps));
            // The quantities with initial data; multipliers belong to the last substep.
            let mut all = vec![0.0; card.observable_count()];
            line.observe(&mut all);
            let given = |f: &Field| data.of_ascii(comparison::split(f).0).is_some();
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
    let calm = compiled::water(&case);
    // Particles that collide.
    let wild = calm.with("momentum_X", |p| p.iter_mut().for_each(|p| *p *= 400.0));
    let settings = Settings {
        order: Some(4),
        ..Settings::step(0.02)
    };
    let (card, mut line) = comparison::opened(source, &case, &wild, settings);
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
    comparison::go_on(constraints::all());
    comparison::go_on(sums::all());
    comparison::go_on_composed(constraints::all());
    comparison::go_on_composed(sums::all());
}

#[test]
fn a_wrong_sign_of_what_is_held_is_seen() {
    let wrong = [
        (constraints::ROD, " + (h/s)*tr(B*Λ^T*next(Λ, i))", ""),
        (
            constraints::CHAIN,
            "dot(V, V)/2 + dot(g, x)",
            "dot(V, V)/2 - dot(g, x)",
        ),
        // Other beads with the same initial values: the constraint of the second of three links has twice the weight.
        (
            constraints::CHAIN,
            "dot(next(x, i) - x, next(x, i) - x) = a^2",
            "dot(next(x, i) - x, next(x, i) - x)^2 = a^4",
        ),
    ];
    for (source, term, rest) in wrong {
        comparison::another_term_is_seen(&constraints::all(), source, term, rest);
    }
}

#[test]
fn data_off_a_constraint_are_refused_at_their_site() {
    let model = LineModel::read(constraints::CHAIN).expect("is read");
    let case = Case::new(50, Some(["pinned", "free"]));
    let [_, own, _] = constraints::all();
    let data = (own.data)(&case);
    let refused =
        |data: &compiled::Data| comparison::refused(&model, constraints::CHAIN, &case, data);
    let off = refused(&data.with("a", |a| a[31] *= 1.001));
    assert!(
        off.contains("site 31") && off.contains("violates the constraint"),
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
    let model = LineModel::read(constraints::ROD).expect("is read");
    let case = Case::new(50, Some(["free", "free"]));
    let [own, _, _] = constraints::all();
    let data = (own.data)(&case);
    let refused = |name: &'static str, change: fn(&mut Vec<f64>)| {
        comparison::refused(&model, constraints::ROD, &case, &data.with(name, change))
    };
    let told = refused("m", |m| m[31] = 0.0);
    for part in ["site 31", "`φ`", "mass is zero", "positive mass"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(!told.contains("follow from others"), "{told}");
}

/// The rows of a long chain come from the short chain. Every multiplier has its row, and constraints of all sites form
/// one invariant.
#[test]
fn the_card_of_a_long_held_line_tells_multipliers_and_constraints() {
    for (own, multiplier) in constraints::all().iter().zip(["n", "lambda"]) {
        let chosen = choice(own.source, 60, Some(["pinned", "free"]));
        let (card, _) = clebsch_interpret::card_on_lattice(own.source, &chosen).expect("is read");
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
        assert!(
            card.summary.contains("loops over the sites"),
            "{}",
            card.summary
        );
    }
}

/// The error for a constrained sum does not name a site, and a sum that the motion cannot change is rejected.
#[test]
fn data_off_a_sum_are_refused_with_the_equation() {
    let [own, _] = sums::all();
    let model = LineModel::read(own.source).expect("is read");
    let case = Case::new(50, None);
    let data = (own.data)(&case);
    let refused = |data: &compiled::Data| comparison::refused(&model, own.source, &case, data);
    let off = refused(&data.with("X", |x| x[0] += 0.1));
    for wanted in [
        "p",
        "violates the constraint",
        "∑_{i=0}^{N-1} s Λ_{i,k} E₃ = X",
    ] {
        assert!(off.contains(wanted), "{off}");
    }
    assert!(!off.contains("site"), "{off}");
    let across = refused(&data.with("body_momentum_Λ", |p| p[31] = 0.4));
    assert!(
        across.contains("is not tangent to the constraint"),
        "{across}"
    );
    // All links are along one axis, so no rotation changes the length to first order.
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
