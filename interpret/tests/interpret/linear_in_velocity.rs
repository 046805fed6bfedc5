//! Terms linear in a velocity, `c*x*(next(y) - y)`: one step from random positions and momenta against actions typed
//! by hand, `p = -D1 L(q, q')` and `p' = D2 L(q, q')`. A difference in time is one term: no part of it is moved to
//! another edge. With a power of the step in the momentum as well.

// The macro warns with this lint that invariants contain the step size.
#![allow(deprecated)]

use crate::side_by_side;
use clebsch::card::{Card, Field, Settings, Trajectory};
use clebsch::scalar::largest;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::LineModel;
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;

clebsch::model! {
    /// A charge whose invariants contain the step size.
    pub model Slow {
        param m: Real;
        param B: Vec<3>;
        field x: Vec<3>;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + h^2*dot(cross(B, x), next(x) - x);
    }
}

const H: f64 = 0.1;

/// Momenta are some m Δx/h, of order ten: a hundred roundings of their terms m x/h.
const ROUNDING: f64 = 3e-13;

/// The size of the change if a part of the action moves to another edge, for numbers of order one.
const SEEN: f64 = 1e-2;

/// The action of a step from `q` to `r` at the time `t`, by hand; `p` the parameters in order.
type Action = fn(p: &[f64], t: f64, q: &[Dual], r: &[Dual]) -> Dual;

fn of(x: f64) -> Dual {
    Dual::constant(x)
}

fn square(x: Dual) -> Dual {
    x * x
}

/// `[-D1 L, D2 L]`.
fn momenta(action: &dyn Fn(&[Dual], &[Dual]) -> Dual, q: &[f64], r: &[f64]) -> [Vec<f64>; 2] {
    let along = |list: &[f64], which: Option<usize>| -> Vec<Dual> {
        let each = list.iter().enumerate();
        let dual = |(i, value): (usize, &f64)| Dual {
            value: *value,
            slope: f64::from(u8::from(Some(i) == which)),
        };
        each.map(dual).collect()
    };
    let all = 0..q.len();
    let start = all
        .clone()
        .map(|i| -action(&along(q, Some(i)), &along(r, None)).slope);
    let end = all.map(|i| action(&along(q, None), &along(r, Some(i))).slope);
    [start.collect(), end.collect()]
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    largest(a.iter().zip(b).map(|(x, y)| (x - y).abs()))
}

fn is_momentum(field: &Field) -> bool {
    field.ascii.starts_with("momentum")
}

/// Numbers for fields, clocks set to `t`.
fn drawn(source: &mut Source, fields: &[Field], t: f64) -> Vec<Vec<f64>> {
    let each = fields.iter().map(|f| match f.ascii {
        "t" => vec![t],
        _ => (0..f.count()).map(|_| source.between(0.3, 1.4)).collect(),
    });
    each.collect()
}

/// Positions and momenta of a list that belongs to these fields.
fn parted<'a>(fields: impl Iterator<Item = (&'a Field, Vec<f64>)>) -> [Vec<f64>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for (field, values) in fields.filter(|(f, _)| f.ascii != "t") {
        out[usize::from(is_momentum(field))].extend(values);
    }
    out
}

fn observed(card: &Card, trajectory: &dyn Trajectory) -> [Vec<f64>; 2] {
    let mut all = vec![0.0; card.observable_count()];
    trajectory.observe(&mut all);
    let mut from = 0;
    let shown = card.observables.iter().map(|f| {
        from += f.count();
        (f, all[from - f.count()..from].to_vec())
    });
    let given = |f: &Field| card.initial.iter().any(|i| i.ascii == f.ascii);
    parted(shown.filter(|(f, _)| given(f)))
}

/// The largest deviation of one step from this action, over random states.
fn off(card: &Card, action: Action) -> f64 {
    let mut source = Source::seeded(20);
    let all = (0..20).map(|_| {
        let t = source.between(0.0, 3.0);
        let parameters = drawn(&mut source, card.parameters, t);
        let initial = drawn(&mut source, card.initial, t);
        let [q, p] = parted(card.initial.iter().zip(initial.iter().cloned()));
        let settings = Settings::step(H);
        let mut trajectory = (card.open)(&parameters, &initial, settings).expect("starts");
        assert!(apart(&q, &observed(card, &*trajectory)[0]) == 0.0);
        trajectory.step().expect("is solved");
        let [r, after] = observed(card, &*trajectory);
        let flat = parameters.concat();
        let [start, end] = momenta(&|q, r| action(&flat, t, q, r), &q, &r);
        apart(&p, &start).max(apart(&after, &end))
    });
    largest(all.collect::<Vec<_>>())
}

fn card(source: &str) -> Card {
    clebsch_interpret::card(source).expect("is run from its text")
}

const TURNED: &str = "param m, c: Real; field x, y: Real; \
    lagrangian = m*(next(x) - x)^2/(2*h) + m*(next(y) - y)^2/(2*h)";

fn free(m: f64, q: &[Dual], r: &[Dual]) -> Dual {
    let each = q.iter().zip(r).map(|(q, r)| square(*r - *q));
    each.fold(of(0.0), |a, b| a + b) * of(m / (2.0 * H))
}

fn turned(term: &str) -> Card {
    card(&format!("model Turned {{ {TURNED} {term}; }}"))
}

/// For each notation of the difference.
#[test]
fn a_factor_times_a_difference_is_one_term() {
    let whole: Action = |p, _, q, r| free(p[0], q, r) + of(p[1]) * q[0] * (r[1] - q[1]);
    let torn: Action = |p, _, q, r| {
        let halves = q[0] * q[1] + r[0] * r[1];
        free(p[0], q, r) + of(p[1]) * (q[0] * r[1] - of(0.5) * halves)
    };
    for term in [
        "+ c*x*(next(y) - y)",
        "- x*(c*y - c*next(y))",
        "+ h*c*x*((next(y) - y)/h)",
    ] {
        let card = turned(term);
        assert!(
            off(&card, whole) < ROUNDING,
            "{term}: {}",
            off(&card, whole)
        );
        assert!(off(&card, torn) > SEEN, "{term}");
    }
    // The other summands in the bracket form a potential, at both ends of the step.
    let beside: Action = |p, _, q, r| {
        let potential = |a: Dual, b: Dual| a * b + a * square(b);
        let halves = potential(q[0], q[1]) + potential(r[0], r[1]);
        let edge = of(p[1]) * q[0] * (square(r[1]) - square(q[1]));
        free(p[0], q, r) + edge - of(0.5 * H * p[1]) * halves
    };
    let card = turned("+ c*x*(next(y)^2 - h*y - h*y^2 - y^2)");
    assert!(off(&card, beside) < ROUNDING, "{}", off(&card, beside));
}

/// `p_y = m v_y + c x`: at x = 1 with p_y = 1 the motion in y begins at rest.
#[test]
fn the_momentum_that_is_given_is_that_of_the_statement() {
    let card = turned("+ c*x*(next(y) - y)");
    let names: Vec<&str> = card.initial.iter().map(|f| f.ascii).collect();
    assert_eq!(names, ["x", "momentum_x", "y", "momentum_y"]);
    let initial = [1.0, 0.0, 0.0, 1.0].map(|x| vec![x]);
    let settings = Settings::step(H);
    let parameters = [vec![1.0], vec![1.0]];
    let mut trajectory = (card.open)(&parameters, &initial, settings).expect("starts");
    trajectory.step().expect("is solved");
    let [places, momenta] = observed(&card, &*trajectory);
    assert!(apart(&places, &[1.0, 0.0]) < ROUNDING, "{places:?}");
    assert!(apart(&momenta, &[0.0, 1.0]) < ROUNDING, "{momenta:?}");
}

#[test]
fn a_clock_in_the_middle_of_the_step_is_of_second_order() {
    let source = "model Wave { param q, E, w: Real; field x: Real; advected t: Real; constraint next(t) = t + h; \
        lagrangian = (next(x) - x)^2/(2*h) + q*(E/w)*cos(w*(t + h/2))*(next(x) - x); }";
    let card = card(source);
    let action: Action = |p, t, q, r| {
        let a = p[0] * p[1] / p[2] * (p[2] * (t + H / 2.0)).cos();
        free(1.0, q, r) + of(a) * (r[0] - q[0])
    };
    let off = off(&card, action);
    assert!(off < ROUNDING, "{off}");
    assert!(card.reversible && card.orders.contains(&4));
    let kept: Vec<&str> = card.invariants.iter().map(|v| v.name).collect();
    assert_eq!(kept, ["momentum"]);
}

fn cross(a: &[f64], b: &[Dual]) -> [Dual; 3] {
    let of = |i: usize, j: usize| of(a[i]) * b[j] - of(a[j]) * b[i];
    [of(1, 2), of(2, 0), of(0, 1)]
}

fn magnetic(p: &[f64], q: &[Dual], r: &[Dual]) -> Dual {
    let a = cross(&p[1..], q);
    let each = (0..3).map(|i| a[i] * (r[i] - q[i]));
    each.fold(of(0.0), |a, b| a + b)
}

#[test]
fn a_power_of_the_step_in_the_momentum_is_run_and_its_invariants_hold() {
    let vectors = "param m: Real; param B: Vec<3>; field x: Vec<3>; \
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h)";
    let vectors = |term: &str| card(&format!("model Fields {{ {vectors} {term}; }}"));
    let all: [(Card, Action); 5] = [
        (vectors("+ dot(cross(B, x), next(x) - x)"), |p, _, q, r| {
            free(p[0], q, r) + magnetic(p, q, r)
        }),
        (
            vectors("+ h*dot(cross(B, x), next(x) - x)"),
            |p, _, q, r| free(p[0], q, r) + of(H) * magnetic(p, q, r),
        ),
        (
            vectors("+ h^2*dot(cross(B, x), next(x) - x)"),
            |p, _, q, r| free(p[0], q, r) + of(H * H) * magnetic(p, q, r),
        ),
        (vectors("+ h*dot(B, next(x) - x)"), |p, _, q, r| {
            let each = (0..3).map(|i| of(H * p[1 + i]) * (r[i] - q[i]));
            each.fold(free(p[0], q, r), |a, b| a + b)
        }),
        (
            turned("+ h*c*(x + next(x))*(next(y) - y)/2"),
            |p, _, q, r| free(p[0], q, r) + of(0.5 * H * p[1]) * (q[0] + r[0]) * (r[1] - q[1]),
        ),
    ];
    for (card, action) in &all {
        let off = off(card, *action);
        assert!(off < ROUNDING, "{}: {off}", card.source);
        // Invariants for one step size are not invariants for another, so steps cannot be composed.
        assert_eq!(
            card.orders.len() > 1,
            card.reversible && !card.source.contains("h^2")
        );
        let mut source = Source::seeded(3);
        let parameters = drawn(&mut source, card.parameters, 0.0);
        let initial = drawn(&mut source, card.initial, 0.0);
        let mut trajectory = (card.open)(&parameters, &initial, Settings::step(H)).expect("starts");
        let told = |t: &dyn Trajectory| {
            let mut out = vec![0.0; card.invariant_count()];
            t.invariants(&mut out);
            let mut from = 0;
            let mut exact = Vec::new();
            for v in card.invariants {
                let values = &out[from..from + v.rows];
                from += v.rows;
                if v.name != "energy" {
                    exact.extend(values.to_vec());
                }
            }
            exact
        };
        let first = told(&*trajectory);
        for _ in 0..50 {
            trajectory.step().expect("is solved");
        }
        let drift = apart(&first, &told(&*trajectory));
        assert!(
            !first.is_empty() && drift < ROUNDING,
            "{}: {drift}",
            card.source
        );
    }
}

const LINE: &str = "label i in 0..N; param m: Real at nodes; param c, k: Real; field x, y: Real at nodes; \
    lagrangian = m*(next(x) - x)^2/(2*h) + m*(next(y) - y)^2/(2*h) - h*k*(next(x, i) - x)^2/2";

/// Sites of mass one, all `x` before all `y`; the term linear in the velocity uses `x` this many sites ahead.
fn line(h: f64, ahead: usize, power: i32, q: &[Dual], r: &[Dual]) -> Dual {
    let sites = q.len() / 2;
    let mut sum = free(1.0, q, r);
    for i in 0..sites - ahead {
        sum = sum + of(0.7 * h.powi(power)) * q[i + ahead] * (r[sites + i] - q[sites + i]);
    }
    for i in 0..sites - 1 {
        let stretched = square(q[i + 1] - q[i]) + square(r[i + 1] - r[i]);
        sum = sum - of(0.25 * h * 1.3) * stretched;
    }
    sum
}

#[test]
fn on_a_line_of_sites_it_is_one_term_too() {
    for (term, ahead, power) in [
        ("+ c*x*(next(y) - y)", 0, 0),
        ("+ c*next(x, i)*(next(y) - y)", 1, 0),
        ("- h*c*x*(y - next(y))", 0, 1),
    ] {
        let source = format!("model Ln {{ {LINE} {term}; }}");
        let model = pipeline::parse_source(&source).expect("is a model");
        let lattice = Lattice::read(&model).expect("has labels");
        let choice = ChainConfig::representative(&lattice, 1);
        let choice = choice.with_count(&lattice, "i", 6).expect("has sites");
        let mut random = Source::seeded(8);
        let mut list = || -> Vec<f64> { (0..7).map(|_| random.between(-1.0, 1.0)).collect() };
        let [x, y, px, py] = [list(), list(), list(), list()];
        let given = |name: &str| {
            Some(match name {
                "m" => vec![1.0; 7],
                "c" => vec![0.7],
                "k" => vec![1.3],
                "x" => x.clone(),
                "y" => y.clone(),
                "momentum_x" => px.clone(),
                "momentum_y" => py.clone(),
                _ => return None,
            })
        };
        let action = |q: &[Dual], r: &[Dual]| line(H, ahead, power, q, r);
        let (q, p) = (
            [x.clone(), y.clone()].concat(),
            [px.clone(), py.clone()].concat(),
        );
        // By loops over sites.
        let looped = LineModel::read(&source).expect("loops over sites take it");
        let mut trajectory = looped.start(&choice, H, &given).expect("starts");
        trajectory.step().expect("is solved");
        let mut shown = |a, b| {
            let mut of = |name| trajectory.observe(name).expect("is shown");
            [of(a), of(b)].concat()
        };
        let (r, after) = (shown("x", "y"), shown("momentum_x", "momentum_y"));
        let [start, end] = momenta(&action, &q, &r);
        let off = apart(&p, &start).max(apart(&after, &end));
        assert!(off < ROUNDING, "{term}, by loops: {off}");
        // Written out.
        let (card, _) = clebsch_interpret::card_on_lattice(&source, &choice).expect("is run");
        let values = |fields: &[Field]| -> Vec<Vec<f64>> {
            let each = fields.iter().map(|f| {
                let (name, site) = match f.ascii.rsplit_once('_') {
                    Some((name, site)) => (name, site.parse::<usize>().ok()),
                    None => (f.ascii, None),
                };
                match site {
                    Some(site) => vec![given(name).expect("is given")[site]],
                    None => given(f.ascii).expect("is given"),
                }
            });
            each.collect()
        };
        let (parameters, initial) = (values(card.parameters), values(card.initial));
        let mut trajectory = (card.open)(&parameters, &initial, Settings::step(H)).expect("starts");
        trajectory.step().expect("is solved");
        let [places, momenta] = observed(&card, &*trajectory);
        assert!(apart(&places, &r) < ROUNDING, "{term}: {places:?} {r:?}");
        assert!(apart(&momenta, &after) < ROUNDING, "{term}: {momenta:?}");
    }
}

#[test]
fn what_is_built_with_the_step_in_an_invariant_is_what_is_read() {
    let read = card(Slow::CARD.source);
    let case = clebsch_models::Case {
        name: "random".to_owned(),
        doc: String::new(),
        h: H,
        steps: 50,
        parameters: vec![vec![1.3], vec![0.3, -0.2, 0.9]],
        initial: vec![vec![0.1, 0.5, 0.2], vec![0.4, -0.3, 0.7]],
        bounds: Vec::new(),
    };
    let settings = Settings::step(H);
    let made = side_by_side::compare(&Slow::CARD, &read, &case, settings, 50);
    assert_eq!(made, 50);
    assert_eq!(
        side_by_side::compare(&Slow::CARD, &read, &case, settings.of_order(4), 50),
        0
    );
}
