//! Chains that run from their files: closed forms, orders, copies of a single body, and steps equal to the steps of
//! the same bodies typed by hand and compiled.

mod between_walls;
mod prescribed;

use crate::side_by_side::compare;
use clebsch::card::{Card, Settings, Trajectory};
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_models::Case;

pub const TODA: &str = include_str!("../../../models/lattices/toda-chain.clebsch");
pub const TOPS: &str = include_str!("../../../models/lattices/coupled-tops.clebsch");
pub const SINE_GORDON: &str = include_str!("../../../models/lattices/sine-gordon.clebsch");

clebsch::model! {
    pub model Three {
        param m: Real;
        param a: Real;
        param b: Real;
        field q_0, q_1, q_2: Real;
        param L: Real;
        lagrangian = m*(next(q_0) - q_0)^2/(2*h) + m*(next(q_1) - q_1)^2/(2*h) + m*(next(q_2) - q_2)^2/(2*h)
            - h*((a/b)*exp(-b*(q_1 - q_0))) - h*((a/b)*exp(-b*(q_2 - q_1))) - h*((a/b)*exp(-b*(q_0 + L - q_2)))
            - h*(a*(q_1 - q_0)) - h*(a*(q_2 - q_1)) - h*(a*(q_0 + L - q_2));
    }
}

pub fn choice(source: &str, count: usize, ring: bool, ends: [&str; 2]) -> ChainConfig {
    let model = pipeline::parse_source(source).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", count).unwrap();
    match ring {
        true => choice.with_ring(&lattice).unwrap(),
        false => {
            let first = choice.with_end(&lattice, false, ends[0]).unwrap();
            first.with_end(&lattice, true, ends[1]).unwrap()
        }
    }
}

pub fn card(source: &str, count: usize, ring: bool, ends: [&str; 2]) -> Card {
    clebsch_interpret::card_on_lattice(source, &choice(source, count, ring, ends))
        .expect("is read")
        .0
}

/// The values of fields in the order of the card, by the name of the quantity and the site.
pub fn values(
    fields: &[clebsch::card::Field],
    of: &dyn Fn(&str, Option<usize>) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    let each = fields.iter().map(|f| {
        let split = f.ascii.rsplit_once('_');
        match split.and_then(|(base, site)| Some((base, site.parse::<usize>().ok()?))) {
            Some((base, site)) => of(base, Some(site)),
            None => of(f.ascii, None),
        }
    });
    each.collect()
}

/// A trajectory from the values of fields, as [`values`] takes them.
fn started(
    card: &Card,
    of: &dyn Fn(&str, Option<usize>) -> Vec<f64>,
    h: f64,
) -> Box<dyn Trajectory> {
    let [parameters, initial] = [card.parameters, card.initial].map(|fields| values(fields, of));
    (card.open)(&parameters, &initial, Settings::step(h)).expect("starts")
}

fn observed(t: &dyn Trajectory, name: &str) -> Vec<f64> {
    let card = t.card();
    let mut all = vec![0.0; card.observable_count()];
    t.observe(&mut all);
    let mut from = 0;
    for f in card.observables {
        if f.ascii == name {
            return all[from..from + f.count()].to_vec();
        }
        from += f.count();
    }
    panic!("{name} is no observable");
}

#[test]
fn a_ring_steps_as_the_same_points_typed_by_hand_and_compiled() {
    let read = card(TODA, 3, true, ["free", "free"]);
    let names =
        |fields: &[clebsch::card::Field]| -> Vec<&str> { fields.iter().map(|f| f.ascii).collect() };
    let mut given = names(Three::CARD.parameters);
    let mut found = names(read.parameters);
    given.sort_unstable();
    found.sort_unstable();
    assert_eq!(given, found);
    let value = |name: &str, site: Option<usize>| {
        let j = site.unwrap_or(0) as f64;
        vec![match name {
            "m" => 1.3,
            "a" => 0.8,
            "b" => 1.1,
            "L" => 4.0,
            "q" => 1.2 * j + 0.1 * j * j,
            _ => 0.3 - 0.2 * j,
        }]
    };
    // In both models, the parameter of the offset is declared with the field, after the others.
    assert_eq!(names(Three::CARD.initial), names(read.initial));
    let case = |card: &Card| Case {
        name: "here".to_owned(),
        doc: String::new(),
        h: 0.05,
        steps: 400,
        parameters: values(card.parameters, &value),
        initial: values(card.initial, &value),
        bounds: Vec::new(),
    };
    assert_eq!(case(&Three::CARD).parameters, case(&read).parameters);
    for order in [2, 4] {
        let settings = Settings::step(0.05).of_order(order);
        let made = compare(&Three::CARD, &read, &case(&read), settings, 400);
        assert_eq!(made, 400);
    }
}

/// A soliton of Toda's chain with parameter κ, its position as a function of site and time.
fn soliton(kappa: f64, site: f64, time: f64) -> (f64, f64) {
    let beta = kappa.sinh();
    let phase = |n: f64| 2.0 * (kappa * n - beta * time);
    let q = phase(site - 1.0).exp().ln_1p() - phase(site).exp().ln_1p();
    let part = |n: f64| 1.0 / (1.0 + (-phase(n)).exp());
    let p = 2.0 * beta * (part(site) - part(site - 1.0));
    (q, p)
}

/// The largest error of a soliton on a ring after a time.
fn soliton_error(h: f64, steps: u64) -> f64 {
    let count = 40;
    let read = card(TODA, count, true, ["free", "free"]);
    let (kappa, middle) = (1.0, 16.0);
    let value = |name: &str, site: Option<usize>| {
        let (q, p) = soliton(kappa, site.unwrap_or(0) as f64 - middle, 0.0);
        vec![match name {
            "m" | "a" | "b" => 1.0,
            "L" => -2.0 * kappa,
            "q" => q,
            _ => p,
        }]
    };
    let mut t = started(&read, &value, h);
    let mut before = vec![0.0; read.invariant_count()];
    t.invariants(&mut before);
    for _ in 0..steps {
        t.step().expect("steps");
    }
    let mut after = vec![0.0; read.invariant_count()];
    t.invariants(&mut after);
    // The energy oscillates in proportion to h squared; the momentum stays constant to rounding.
    assert!(
        (after[0] - before[0]).abs() < 0.2 * h * h,
        "{before:?} {after:?}"
    );
    assert!((after[1] - before[1]).abs() < 1e-13, "{before:?} {after:?}");
    let time = h * steps as f64;
    let errors = (0..count).map(|j| {
        let (q, _) = soliton(kappa, j as f64 - middle, time);
        (observed(&*t, &format!("q_{j}"))[0] - q).abs()
    });
    clebsch::scalar::largest(errors)
}

#[test]
fn a_soliton_keeps_its_form_with_order_two() {
    let errors: Vec<f64> = [(0.04, 125), (0.02, 250), (0.01, 500)]
        .into_iter()
        .map(|(h, steps)| soliton_error(h, steps))
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        // The next term of the error is smaller by h squared.
        assert!(
            (order - 2.0).abs() < 0.01,
            "order {order}, errors {errors:?}"
        );
    }
}

/// A mode of small oscillations: the sites, the end conditions, and whether the mode has nodes or antinodes at the
/// ends.
fn mode_error(ends: [&str; 2], shape: &dyn Fn(f64) -> f64) -> f64 {
    let (count, s, k, h) = (12, 0.5, 0.7, 0.1);
    let wave = std::f64::consts::PI / count as f64;
    let turn = 4.0 * (wave / 2.0).sin().powi(2) / (s * s) + k;
    let omega = 2.0 / h * (h * turn.sqrt() / 2.0).asin();
    let size = 1e-7;
    let read = card(SINE_GORDON, count, false, ends);
    let value = |name: &str, site: Option<usize>| {
        let j = site.unwrap_or(0);
        vec![match name {
            "s" => s,
            "k" => k,
            "w" if j == 0 || j == count => s / 2.0,
            "w" => s,
            "u" => size * shape(wave * j as f64),
            _ => 0.0,
        }]
    };
    let mut t = started(&read, &value, h);
    let steps = 300;
    for _ in 0..steps {
        t.step().expect("steps");
    }
    let swing = (omega * h * f64::from(steps)).cos();
    let errors = read.observables.iter().filter_map(|f| {
        let site: f64 = f.ascii.strip_prefix("u_")?.parse().ok()?;
        let exact = size * shape(wave * site) * swing;
        Some((observed(&*t, f.ascii)[0] - exact).abs() / size)
    });
    clebsch::scalar::largest(errors)
}

#[test]
fn small_swings_between_pinned_and_free_ends_are_those_of_the_discrete_dispersion_relation() {
    // The cubic term of the sine is 1e-14 of the linear one, and adds up over thirty radians.
    assert!(mode_error(["pinned", "pinned"], &f64::sin) < 1e-12);
    assert!(mode_error(["free", "free"], &f64::cos) < 1e-12);
    // Different end conditions have a different mode.
    assert!(mode_error(["free", "pinned"], &f64::cos) > 0.1);
}

#[test]
fn tops_in_phase_with_free_ends_are_one_top() {
    let lone = clebsch_models::gallery()
        .into_iter()
        .find(|e| e.card.kebab == "heavy-top")
        .expect("is in the gallery")
        .card;
    let attitude = clebsch::groups::Rotation::exp(&clebsch::nalgebra::Vector3::new(0.1, 0.6, 0.0));
    let matrix: Vec<f64> = attitude.matrix().transpose().iter().copied().collect();
    let value = |name: &str, _: Option<usize>| match name {
        "s" => vec![1.0],
        "J" => vec![0.5, 0.0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 1.5],
        "C" => vec![0.4, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0, 0.2],
        "gU" | "z" => vec![0.0, 0.0, 1.0],
        n if n.starts_with("Lambda") => matrix.clone(),
        _ => vec![0.1, 0.0, 1.0],
    };
    for count in [1, 4] {
        let read = card(TOPS, count, false, ["free", "free"]);
        let [mut one, mut row] = [&lone, &read].map(|c| started(c, &value, 0.05));
        for _ in 0..200 {
            one.step().expect("steps");
            row.step().expect("steps");
        }
        let wanted = observed(&*one, "body_momentum");
        for j in 0..=count {
            let found = observed(&*row, &format!("body_momentum_Lambda_{j}"));
            for (a, b) in wanted.iter().zip(&found) {
                // The moments of the neighbours vanish up to the rounding of C.
                assert!((a - b).abs() < 1e-13, "{count} {j}: {wanted:?} {found:?}");
            }
        }
    }
}

/// Beads on hoops with springs across: a drive along the hoops does not act on the positions across.
pub const BEADS: &str = "model Beads { label i in 0..N; periodic; param m, k: Real; field x: Real at nodes; field q: Real at nodes;
    lagrangian = m*((next(x) - x)^2 + (1 + (x^2 + next(x)^2)/2)*(next(q) - q)^2)/(2*h) - (h*k/2)*(next(x, i) - x)^2; }";

#[test]
fn what_every_site_keeps_is_one_invariant_with_a_row_for_each_and_of_a_line_their_sum() {
    for (count, rows) in [(7, 7), (60, 1)] {
        let read = card(BEADS, count, true, ["free", "free"]);
        let told: Vec<_> = read.invariants.iter().map(|i| (i.name, i.rows)).collect();
        assert_eq!(told, [("energy", 1), ("momentum_q", rows)]);
        let formula = read.invariants[1].formula;
        assert!(formula.ends_with("at every site"), "{formula}");
        assert_eq!(formula.starts_with("the sum of"), rows == 1, "{formula}");
        let value = |name: &str, site: Option<usize>| {
            let turn = site.unwrap_or(0) as f64;
            vec![match name {
                "m" | "k" => 1.0,
                "x" => (1.3 * turn).sin(),
                "q" => 0.0,
                "momentum_x" => 0.2,
                _ => 1.0 + 0.1 * turn,
            }]
        };
        let mut t = started(&read, &value, 0.05);
        let mut all = vec![0.0; read.invariant_count()];
        t.invariants(&mut all);
        let momenta: Vec<f64> = (0..count).map(|i| 1.0 + 0.1 * i as f64).collect();
        let known = match rows {
            1 => vec![momenta.iter().sum()],
            _ => momenta,
        };
        for _ in 0..100 {
            // One rounding of a momentum in each step, in either direction, summed over the sites.
            let size = clebsch::scalar::largest(known.iter().map(|p: &f64| p.abs()));
            for (own, p) in all[1..].iter().zip(&known) {
                assert!((own - p).abs() <= 100.0 * f64::EPSILON * size, "{own} {p}");
            }
            t.step().expect("steps");
            t.invariants(&mut all);
        }
        assert!((observed(&*t, "q_0")[0]).abs() > 1.0);
    }
}

#[test]
fn more_sites_than_fit_into_memory_are_refused_at_once() {
    let model = pipeline::parse_source(TODA).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", 1_000_000_000_000).unwrap();
    let told = clebsch_interpret::card_on_lattice(TODA, &choice).expect_err("is refused");
    assert!(told.to_string().contains("`i = 1000000000000`"), "{told}");
}

/// A term joins two fields at different sites of a chain. The momenta of the second field add up over all sites. With
/// the momenta of the first field, the sum omits an end.
const CROSSED: &str = "model Crossed { label i in 0..N; periodic; param m, k, f: Real; field x, y: Real at nodes;
    lagrangian = m*((next(x)-x)^2 + (next(y)-y)^2)/(2*h) + f*(x+next(x))/2*(next(next(y,i))-next(y,i))
        - h*k*((next(x,i)-x)^2+(next(y,i)-y)^2)/2; }";

#[test]
fn a_total_of_an_open_line_is_not_taken_for_that_of_all_sites() {
    for (ring, count, totals) in [(true, 40, 2), (false, 40, 1), (false, 5, 2)] {
        let read = card(CROSSED, count, ring, ["free", "free"]);
        let names = read.invariants.iter().map(|i| i.name);
        assert_eq!(names.filter(|n| *n != "energy").count(), totals, "{count}");
        let value = |name: &str, site: Option<usize>| {
            let turn = site.unwrap_or(0) as f64;
            vec![match name {
                "m" | "k" | "f" => 0.7,
                "x" => (1.3 * turn).sin(),
                "y" => (0.7 * turn).cos(),
                _ => 0.2 * (0.4 * turn).cos(),
            }]
        };
        let mut t = started(&read, &value, 0.05);
        let mut all = vec![0.0; read.invariant_count()];
        t.invariants(&mut all);
        let start = all.clone();
        for _ in 0..50 {
            t.step().expect("steps");
        }
        t.invariants(&mut all);
        for (i, own) in read.invariants.iter().enumerate() {
            // Sums of a hundred terms of size one, each with one rounding per step.
            let exact = own.name == "energy" || (all[i] - start[i]).abs() < 1e-11;
            assert!(exact, "{} {} {}", own.name, start[i], all[i]);
        }
    }
}

/// One component of a vector without forces on it.
const SHEET: &str = "model Sheet { label i in 0..N; periodic; param m: Real at nodes; param k: Real at segments; field x_a: Vec<3> at nodes;
    lagrangian = m*dot(next(x_a)-x_a,next(x_a)-x_a)/(2*h) - h*k*(next(x_a,i)[1]-x_a[1])^4/4; }";

#[test]
fn components_that_every_site_keeps_are_told_of_every_site() {
    for count in [7, 40] {
        let read = card(SHEET, count, true, ["free", "free"]);
        let told: Vec<_> = read
            .invariants
            .iter()
            .map(|i| (i.name, i.rows, i.formula))
            .collect();
        for name in ["momentum_x_a_E2", "momentum_x_a_E3"] {
            let (_, rows, formula) = told.iter().find(|(n, ..)| *n == name).expect(name);
            assert_eq!(*rows, if count > 32 { 1 } else { count });
            assert!(formula.ends_with("at every site"), "{formula}");
        }
    }
}

#[test]
fn the_total_of_a_ring_is_told_where_even_and_odd_sites_have_their_own() {
    let water = include_str!("../../../models/lattices/shallow-water-1d.clebsch");
    for count in [41, 64] {
        let read = card(water, count, true, ["free", "free"]);
        let names: Vec<&str> = read.invariants.iter().map(|i| i.name).collect();
        assert_eq!(names, ["energy", "momentum_Y", "total_momentum_X"]);
    }
}

/// Far from the origin, the energy of a chain equals its energy near the origin, up to the rounding of positions:
/// strains have errors of 1e-10 at 1e6.
#[test]
fn energies_of_chains_do_not_depend_on_where_they_are() {
    const CHAIN: &str = "model Stiff { label i in 0..N; periodic; param m, k, l, b: Real; field q: Real at nodes offset L;
        let r = next(q, i) - q - l;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*(k*r^2/2 + b*r^4/4); }";
    for count in [8, 40] {
        let card = card(CHAIN, count, true, ["free", "free"]);
        let energy = |place: f64| {
            let of = |name: &str, site: Option<usize>| {
                let s = site.unwrap_or(0) as f64;
                vec![match name {
                    "q" => place + s + 0.125 * f64::from(site == Some(3)),
                    "momentum_q" => 0.25,
                    "L" => count as f64,
                    _ => 1.0,
                }]
            };
            let line = started(&card, &of, 0.0078125);
            let mut invariants = vec![0.0; card.invariant_count()];
            line.invariants(&mut invariants);
            let mut scales = vec![0.0; card.invariant_count()];
            line.scales(&mut scales);
            assert_eq!(card.invariants[0].name, "energy");
            [invariants[0], scales[0]]
        };
        let near = energy(0.0);
        // Two springs are strained by 1/8.
        let strain: f64 = 0.125;
        let expected = count as f64 * 0.03125 + strain.powi(2) + strain.powi(4) / 2.0;
        for value in near.into_iter().chain(energy(1e6)) {
            assert!(
                (value - expected).abs() < 1e-9 * expected,
                "{count} sites: {value} {expected}"
            );
        }
    }
}
