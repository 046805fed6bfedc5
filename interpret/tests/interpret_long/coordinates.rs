//! Chains whose sites are linear maps, rotations of the plane and rigid motions: run by loops over sites, in
//! coordinates; compared with the expanded bodies and with actions typed by hand.

mod compiled;
mod matrix;
mod models;

use clebsch::card::Settings;
use clebsch::scalar::largest;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory, NoLine};
use matrix::{A, D};
use models::{Chain, H};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

fn choice(chain: &Chain, n: usize) -> ChainConfig {
    let model = pipeline::parse_source(chain.source).expect("is a model");
    let lattice = Lattice::read(&model).expect("has labels");
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", n).expect("has sites");
    match chain.ends {
        None => choice.with_ring(&lattice).expect("closes"),
        Some(_) if lattice.ends[0].is_empty() => choice,
        Some([first, _]) => choice.with_end(&lattice, false, first).expect("begins so"),
    }
}

/// The model of a text, parsed once.
fn read(source: &str) -> Arc<LineModel> {
    static READ: Mutex<BTreeMap<String, Arc<LineModel>>> = Mutex::new(BTreeMap::new());
    let known = READ.lock().expect("is whole").get(source).cloned();
    known.unwrap_or_else(|| {
        let model = LineModel::read(source).expect("loops over sites take it");
        let mut all = READ.lock().expect("is whole");
        all.insert(source.to_owned(), model.clone());
        model
    })
}

fn started(chain: &Chain, source: &str, n: usize, h: f64) -> LineTrajectory {
    let model = read(source);
    let nodes = chain.nodes(n);
    // A configuration that an end prescribes does not have a momentum.
    let numbers = |name: &str| {
        let mut list = (chain.given)(name, nodes)?;
        if name.contains("_momentum_") {
            let size = chain.momentum();
            list[..chain.held * size].fill(0.0);
        }
        Some(list)
    };
    model.start(&choice(chain, n), h, &numbers).expect("starts")
}

fn elements(chain: &Chain, list: &[f64]) -> Vec<A> {
    let each = list.chunks(chain.rows * chain.rows);
    each.map(|x| A::of(chain.rows, x)).collect()
}

fn own_momentum(chain: &Chain) -> String {
    let frame = if chain.spatial { "spatial" } else { "body" };
    format!("{frame}_momentum_{}", chain.element)
}

/// The residual of the discrete Euler-Lagrange equations of an action at three nodes. Also the difference between the
/// momentum at the middle node and the derivative of the edge before it. Both are relative to the largest derivative of
/// that edge.
fn off(chain: &Chain, source: &str, n: usize, action: impl Fn(&[A], &[A]) -> D) -> [f64; 2] {
    let mut line = started(chain, source, n, H);
    let mut momentum = Vec::new();
    // The initial data are arbitrary.
    let three: Vec<Vec<A>> = (0..3)
        .map(|node| {
            line.step().expect("steps");
            if node == 1 {
                momentum = line.observe(&own_momentum(chain)).expect("is observed");
            }
            let list = line.observe(chain.element).expect("is observed");
            elements(chain, &list)
        })
        .collect();
    let [before, here, after] = three.as_slice() else {
        unreachable!("three nodes");
    };
    let size = momentum.len() / here.len();
    let (mut left, mut told, mut scale) = (Vec::new(), Vec::new(), Vec::new());
    for site in chain.held..here.len() {
        for (direction, component) in (chain.directions)() {
            let mut along = A::of(chain.rows, &direction);
            for x in &mut along.e {
                *x *= D::variable(0.0, 0);
            }
            let near = &A::identity(chain.rows) + &along;
            let mut moved = here.clone();
            moved[site] = match chain.spatial {
                false => &here[site] * &near,
                true => &near * &here[site],
            };
            let into = action(before, &moved).dual[0];
            let out = action(&moved, after).dual[0];
            left.push((into + out).abs());
            told.push((into - momentum[site * size + component]).abs());
            scale.push(into.abs());
        }
    }
    let scale = largest(scale);
    [largest(left) / scale, largest(told) / scale]
}

/// The rounding of positions of size ten, divided by h. Some positions are computed one after the other.
const ROUNDED: f64 = 1e-11;

#[test]
fn steps_are_stationary_for_the_action_typed_by_hand_and_momenta_are_its_derivatives() {
    for chain in models::all() {
        for n in [3, 40] {
            let ring = chain.ends.is_none();
            let off = off(&chain, chain.source, n, |a, b| (chain.action)(a, b, ring));
            let what = format!("{} {:?} {n}: {off:?}", chain.element, chain.ends);
            println!("{what}");
            assert!(off.iter().all(|x| *x < ROUNDED), "{what}");
        }
    }
}

/// Long, since a chain is derived anew for every term.
#[test]
fn a_term_that_is_changed_is_seen() {
    for (chain, term, other) in [
        (models::ellipsoids(), "(h*k/2)", "(h*k/1.99)"),
        (models::ellipses(), "a*tr(S)", "a*I1(S)*1.01"),
        (
            models::rotors(None),
            "h*c*tr(R^T*next(R, i))",
            "h*c*tr(R*next(R, i))",
        ),
        (models::frames(None, false), "pos(V^-1)", "pos(V^-1)*1.01"),
        (models::frames(None, false), "dot(b, P)", "dot(b, Z)"),
        (
            models::frames(Some(["tied", "free"]), false),
            "(h/2)*dot(pos(F0",
            "(h/1.9)*dot(pos(F0",
        ),
        (models::sledges(), "rot(G)*a", "a"),
    ] {
        let mutated = chain.source.replacen(term, other, 1);
        assert_ne!(mutated, chain.source, "{term}");
        let ring = chain.ends.is_none();
        let [left, _] = off(&chain, &mutated, 7, |a, b| (chain.action)(a, b, ring));
        assert!(left > 1e-6, "{term}: {left:e}");
    }
}

/// Long, since every chain is derived body by body.
#[test]
fn loops_over_sites_move_as_the_bodies_written_out() {
    for chain in models::all() {
        for n in [5] {
            let chosen = choice(&chain, n);
            let written = clebsch_interpret::card_on_lattice(chain.source, &chosen);
            let (card, _) = written.expect("is written out");
            let nodes = chain.nodes(n);
            let names = [
                "I0", "J", "M", "C", "K", "C0", "mu", "lambda", "k", "a", "d", "b", "c", "e", "m",
                "w", "s", "Z", "F0",
            ];
            let momentum = own_momentum(&chain);
            let names = names.into_iter().chain([chain.element, momentum.as_str()]);
            let known: Vec<(String, Vec<f64>)> = names
                .filter_map(|name| Some((ascii(name), (chain.given)(name, nodes)?)))
                .collect();
            let split = |name: &str| match name.rsplit_once('_') {
                Some((key, site)) if site.parse::<usize>().is_ok() => {
                    (key.to_owned(), site.parse::<usize>().ok())
                }
                _ => (name.to_owned(), None),
            };
            let values = |fields: &[clebsch::card::Field]| -> Vec<Vec<f64>> {
                let each = fields.iter().map(|field| {
                    let (key, site) = split(field.ascii);
                    let (_, list) = known.iter().find(|(own, _)| *own == key).expect("is given");
                    let at = match list.len() == field.count() {
                        true => 0,
                        false => site.expect("has a site") * field.count(),
                    };
                    list[at..at + field.count()].to_vec()
                });
                each.collect()
            };
            let (parameters, initial) = (values(card.parameters), values(card.initial));
            let bodies = (card.open)(&parameters, &initial, Settings::step(H));
            let mut bodies = bodies.expect("starts");
            let mut line = started(&chain, chain.source, n, H);
            for _ in 0..20 {
                bodies.step().expect("steps");
                line.step().expect("steps");
            }
            let mut all = vec![0.0; card.observable_count()];
            bodies.observe(&mut all);
            let (mut from, mut compared) = (0, 0);
            for field in card.observables {
                let (key, site) = split(field.ascii);
                let own = &all[from..from + field.count()];
                from += field.count();
                let shown = [
                    chain.element.to_owned(),
                    format!("body_momentum_{}", chain.element),
                    format!("spatial_momentum_{}", chain.element),
                ];
                let Some(name) = shown.into_iter().find(|o| ascii(o) == key) else {
                    continue;
                };
                let list = line.observe(&name).expect("is observed");
                let at = site.expect("has a site") * field.count();
                for (x, y) in own.iter().zip(&list[at..]) {
                    compared += 1;
                    // Twenty steps with several roundings each, for numbers up to ten.
                    assert!(
                        (x - y).abs() < 1e-12 * x.abs().max(10.0),
                        "{} {:?} {n}: {}: {x} {y}",
                        chain.element,
                        chain.ends,
                        field.name
                    );
                }
            }
            let least = 2 * (nodes - chain.held) * chain.momentum();
            assert!(compared >= least, "{compared} of {least}");
        }
    }
}

/// Long, since every chain is run at several steps.
#[test]
fn steps_are_of_second_order_keep_the_energy_and_return() {
    for chain in models::all() {
        let at_end = |parts: usize| {
            let mut line = started(&chain, chain.source, 6, H / parts as f64);
            for _ in 0..10 * parts {
                line.step().expect("steps");
            }
            line.observe(chain.element).expect("is observed")
        };
        let apart = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(x, y)| (x - y).abs()));
        let [one, two, four] = [1, 2, 4].map(at_end);
        let order = (apart(&one, &two) / apart(&two, &four)).log2();
        assert!(
            (order - 2.0).abs() < 0.1,
            "{} {:?}: {order}",
            chain.element,
            chain.ends
        );
        let drift = |h: f64| {
            let mut line = started(&chain, chain.source, 6, h);
            let of = |line: &mut LineTrajectory| {
                let [kinetic, potential] = line.energies().expect("has energies");
                kinetic + potential
            };
            let start = of(&mut line);
            let steps = (2.0 / h).round() as usize;
            largest((0..steps).map(|_| {
                line.step().expect("steps");
                (of(&mut line) - start).abs()
            }))
        };
        let (coarse, fine) = (drift(H), drift(H / 2.0));
        // The energy of the limit is off by the square of the step.
        assert!(
            coarse / fine > 3.0 && coarse < 0.1,
            "{} {:?}: {coarse:e} {fine:e}",
            chain.element,
            chain.ends
        );
    }
}

#[test]
fn lines_equal_the_compiled_ones_to_the_last_bit() {
    compiled::compared();
}

#[test]
fn totals_are_kept() {
    for (chain, least) in [
        (models::ellipsoids(), 1),
        // Linear and angular momentum along the vertical.
        (models::hanging(None), 2),
        (models::hanging(Some(["free", "free"])), 2),
    ] {
        let mut line = started(&chain, chain.source, 12, H);
        let model = read(chain.source);
        let names: Vec<String> = model.totals().map(str::to_owned).collect();
        assert!(names.len() >= least, "{}: {names:?}", chain.element);
        let start: Vec<Vec<f64>> = names
            .iter()
            .map(|n| line.total(n).expect("is told"))
            .collect();
        for _ in 0..100 {
            line.step().expect("steps");
        }
        for (name, before) in names.iter().zip(start) {
            let after = line.total(name).expect("is told");
            for (x, y) in before.iter().zip(&after) {
                assert!((x - y).abs() < 1e-12 * x.abs().max(10.0), "{name}: {x} {y}");
            }
        }
    }
}

#[test]
fn ten_thousand_sites_are_run() {
    let open = Some(["free", "free"]);
    for chain in [
        models::ellipsoids(),
        models::rotors(None),
        models::frames(open, false),
    ] {
        let mut line = started(&chain, chain.source, 10_000, H);
        for _ in 0..2 {
            line.step().expect("steps");
        }
        let list = line.observe(chain.element).expect("is observed");
        assert_eq!(list.len(), chain.nodes(10_000) * chain.rows * chain.rows);
        assert!(list.iter().all(|x| x.is_finite()));
    }
}

/// Why data are rejected.
fn refused(chain: &Chain, change: impl Fn(&str, &mut Vec<f64>)) -> String {
    let model = read(chain.source);
    let nodes = chain.nodes(50);
    let numbers = |name: &str| {
        let mut list = (chain.given)(name, nodes)?;
        change(name, &mut list);
        Some(list)
    };
    let started = model.start(&choice(chain, 50), H, &numbers);
    started.map(|_| ()).expect_err("is refused").to_string()
}

#[test]
fn the_site_of_an_element_that_is_none_is_named() {
    let set = |of: &'static str, at: usize, x: f64| {
        move |name: &str, list: &mut Vec<f64>| {
            if name == of {
                list[at] = x;
            }
        }
    };
    let singular = refused(&models::ellipsoids(), |name, list| {
        if name == "Q" {
            list[9 * 37..9 * 38].fill(1.0);
        }
    });
    assert!(
        singular.contains("at site 37: `Q`: not invertible"),
        "{singular}"
    );
    let turned = refused(&models::rotors(None), set("R", 4 * 12, 3.0));
    assert!(turned.contains("at site 12: `R`"), "{turned}");
    let whole = refused(&models::rotors(None), set("body_momentum_R", 4 * 7, 5.0));
    assert!(
        whole.contains("at site 7: `body_momentum_R`: not skew"),
        "{whole}"
    );
    let moved = refused(&models::frames(None, false), set("Φ", 16 * 8 + 12, 0.5));
    assert!(moved.contains("at site 8: `Φ`"), "{moved}");
    let lost = refused(
        &models::frames(None, false),
        set("body_momentum_Φ", 6 * 5 + 4, f64::NAN),
    );
    assert!(lost.contains("at site 5: `body_momentum_Φ`"), "{lost}");
}

#[test]
fn a_step_through_a_singular_map_is_refused_with_its_site() {
    let source = "model Maps { label i in 0..N; param m, k: Real; group Q: GL<2> at nodes velocity G;
        constraint next(Q) = Q*G;
        lagrangian = m*tr(Q*(G - Id)*(G - Id)^T*Q^T)/(2*h) - (h*k/2)*tr((next(Q, i) - Q)^T*(next(Q, i) - Q)); }";
    let chain = Chain {
        source,
        rows: 2,
        ..models::ellipsoids()
    };
    let model = LineModel::read(source).expect("is read");
    let numbers = |name: &str| {
        Some(match name {
            "m" | "k" => vec![1.0],
            "Q" => [1.0, 0.0, 0.0, 1.0].repeat(51),
            "body_momentum_Q" => {
                let mut list = vec![0.0; 4 * 51];
                list[4 * 20] = -3.0;
                list
            }
            _ => return None,
        })
    };
    let mut line = model
        .start(&choice(&chain, 50), H, &numbers)
        .expect("starts");
    let refused = (0..100).find_map(|_| line.step().err()).expect("meets it");
    let refused = refused.to_string();
    assert!(refused.contains("site 20"), "{refused}");
}

#[test]
fn a_homogeneous_matrix_in_another_form_is_refused_with_what_to_write() {
    let told = LineModel::read(
        "model Frames { label i in 0..N; param Q: Sym<4>; param c: Real; group Φ: SE<3> at nodes velocity V;
         constraint next(Φ) = Φ*V;
         lagrangian = tr((V - Id)*Q*(V - Id)^T)/(2*h) + h*c*tr(rot(Φ^-1*next(Φ, i))); }",
    );
    match told {
        Err(NoLine::Form(why)) => {
            assert!(why.contains("write the term with `rot` and `pos`"), "{why}")
        }
        other => panic!("{other:?}"),
    }
    let told = LineModel::read(
        "model Frames { label i in 0..N; param m, c: Real; group Q: GL<2> at nodes velocity G;
         advected v: Vec<2> at nodes; constraint next(Q) = Q*G; constraint next(v) = G^-1*v;
         lagrangian = m*tr(Q*(G - Id)*(G - Id)^T*Q^T)/(2*h) - h*dot(v, v)
            - (h*c/2)*tr((next(Q, i) - Q)^T*(next(Q, i) - Q)); }",
    );
    match told {
        Err(NoLine::Form(why)) => assert!(why.contains("define a quantity"), "{why}"),
        other => panic!("{other:?}"),
    }
}
