//! Ensembles: time per body and step, one by one and in lanes, for each instruction set, in and out of the cache. Takes no
//! arguments; prints tables. `cargo run --release --manifest-path benches/Cargo.toml --bin ensembles`, about a minute.

use clebsch::integrate::{Ensemble, InstructionSet, Model, Work};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::scalar::gather;
use clebsch::solvers::moser_veselov::forced;
use clebsch::{BodyMomentum, Lanes, Order, Poinsot, Rotation};
use clebsch_benches::blocks::computed;
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters,
};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::heavy_top::{HeavyTop, HeavyTopInitial, HeavyTopParameters};
use std::hint::black_box;

clebsch::model! {
    /// A top in a quadratic field with a kinetic energy that is not linear: Newton's method in three coordinates.
    model StiffTop {
        param J: Sym<3>;
        param K: Sym<3>;
        param c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(Γ, K*Γ)/2 + (c/h)*tr(Ω - Id)^2;
    }
}

const H: f64 = 0.1;

/// Number of interleaved rounds.
const ROUNDS: usize = 25;

const SETS: [(&str, InstructionSet); 3] = [
    ("build", InstructionSet::Build),
    ("AVX2", InstructionSet::Avx2),
    ("best", InstructionSet::Best),
];

/// A number between 0 and 1 that differs from body to body.
fn spread(body: usize, which: usize) -> f64 {
    ((body * 7919 + which * 104_729) % 10_007) as f64 / 10_007.0
}

fn poinsot(body: usize) -> Matrix3<f64> {
    let at = |which, low| low + 0.5 * spread(body, which);
    Matrix3::from_diagonal(&Vector3::new(at(0, 0.5), at(1, 1.0), at(2, 1.5)))
}

fn vector(body: usize, first: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| 2.0 * spread(body, first + i) - 1.0)
}

fn free_body(body: usize) -> (FreeBodyParameters, FreeBodyInitial) {
    let initial = FreeBodyInitial {
        Λ: Rotation::exp(&vector(body, 6)),
        body_momentum: BodyMomentum(vector(body, 3)),
    };
    (FreeBodyParameters { J: poinsot(body) }, initial)
}

fn heavy_top(body: usize) -> (HeavyTopParameters, HeavyTopInitial) {
    let parameters = HeavyTopParameters {
        J: poinsot(body),
        gU: vector(body, 9),
        z: Vector3::z(),
    };
    let initial = HeavyTopInitial {
        Λ: Rotation::exp(&vector(body, 6)),
        body_momentum: BodyMomentum(vector(body, 3)),
    };
    (parameters, initial)
}

fn stiff_top(body: usize) -> (StiffTopParameters, StiffTopInitial) {
    let parameters = StiffTopParameters {
        J: poinsot(body),
        K: poinsot(body + 1),
        c: 0.1,
    };
    let initial = StiffTopInitial {
        Λ: Rotation::exp(&vector(body, 6)),
        body_momentum: BodyMomentum(vector(body, 3)),
        Γ: vector(body, 9).normalize(),
    };
    (parameters, initial)
}

fn coupled(body: usize) -> (CoupledBodiesParameters, CoupledBodiesInitial) {
    let parameters = CoupledBodiesParameters {
        J1: poinsot(body),
        J2: poinsot(body + 1),
        d1: vector(body, 9),
        d2: vector(body, 12),
        eps: 0.1,
    };
    let initial = CoupledBodiesInitial {
        Λ1: Rotation::exp(&vector(body, 6)),
        body_momentum_Λ1: BodyMomentum(vector(body, 3)),
        Λ2: Rotation::exp(&vector(body, 15)),
        body_momentum_Λ2: BodyMomentum(vector(body, 18)),
    };
    (parameters, initial)
}

/// An implementation, and its times per body and step in nanoseconds.
struct Way<'a> {
    name: String,
    run: Box<dyn FnMut() + 'a>,
    times: Vec<f64>,
}

impl<'a> Way<'a> {
    fn new(name: impl Into<String>, run: impl FnMut() + 'a) -> Self {
        Way {
            name: name.into(),
            run: Box::new(run),
            times: Vec::new(),
        }
    }
}

/// Times all implementations in turn, in several rounds; one call does `body_steps` steps.
fn race(title: &str, body_steps: f64, mut ways: Vec<Way<'_>>) {
    for round in 0..ROUNDS + 2 {
        for way in &mut ways {
            let begin = computed();
            (way.run)();
            let time = (computed() - begin) / body_steps;
            // The first rounds warm caches and clock frequency.
            if round >= 2 {
                way.times.push(time);
            }
        }
    }
    println!("\n{title}");
    println!(
        "{:<24} {:>8} {:>8} {:>8} {:>8}",
        "", "best", "1st q.", "median", "3rd q."
    );
    for way in &mut ways {
        way.times.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (share * (way.times.len() - 1) as f64).round() as usize;
            way.times[place]
        };
        println!(
            "{:<24} {:8.2} {:8.2} {:8.2} {:8.2}",
            way.name,
            at(0.0),
            at(0.25),
            at(0.5),
            at(0.75)
        );
    }
}

/// One ensemble, run on every instruction set.
fn sets<'a, M: Model<Scalar = f64> + 'a, const N: usize>(
    ways: &mut Vec<Way<'a>>,
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
    steps: u64,
) {
    for (name, set) in SETS {
        let started = Ensemble::<M, N>::start_with(bodies.iter().copied(), H, choice);
        let mut ensemble = started.expect("bodies can start").with_instructions(set);
        ways.push(Way::new(format!("{N} lanes, {name}"), move || {
            ensemble.run(steps).expect("steps can be made");
            black_box(&ensemble);
        }));
    }
}

/// Bodies one by one and in lanes.
fn table<M: Model<Scalar = f64>>(
    title: &str,
    body: impl Fn(usize) -> (M::Parameters, M::Initial),
    choice: M::Choice,
    [count, steps]: [usize; 2],
) {
    let bodies: Vec<_> = (0..count).map(body).collect();
    let mut ways = Vec::new();
    let begun = |(parameters, initial): &(M::Parameters, M::Initial)| {
        let model = M::of(*parameters).expect("bodies are admissible");
        let state = model.begin(*initial).expect("bodies can start");
        let workspace = model.prepare(&state, H, choice).expect("bodies can start");
        (model, state, workspace)
    };
    let mut alone: Vec<_> = bodies.iter().map(begun).collect();
    ways.push(Way::new("one by one", move || {
        for (model, state, workspace) in &mut alone {
            model
                .advance_many(state, workspace, steps as u64)
                .expect("steps can be made");
        }
        black_box(&alone);
    }));
    sets::<M, 1>(&mut ways, &bodies, choice, steps as u64);
    ways.truncate(2);
    sets::<M, 8>(&mut ways, &bodies, choice, steps as u64);
    sets::<M, 16>(&mut ways, &bodies, choice, steps as u64);
    race(
        &format!("{title}: {count} bodies, {steps} steps a call"),
        (count * steps) as f64,
        ways,
    );
}

/// The Moser-Veselov equation for one momentum per body.
struct Solve<'a, const N: usize>(&'a [(Poinsot<Lanes<N>>, Vector3<Lanes<N>>)]);

impl<const N: usize> Work for Solve<'_, N> {
    type Output = Lanes<N>;

    #[inline(always)]
    fn done(self) -> Lanes<N> {
        let mut sum = Lanes([0.0; N]);
        for (body, momentum) in self.0 {
            if let Ok(rotation) = forced(body, momentum) {
                let [w, x, y, z] = rotation.quaternion();
                sum += (w + x) + (y + z);
            }
        }
        sum
    }
}

fn equations<const N: usize>(count: usize) -> Vec<(Poinsot<Lanes<N>>, Vector3<Lanes<N>>)> {
    let group = |at: usize| {
        let body = Poinsot::new(gather(|i| poinsot(at * N + i))).expect("bodies");
        (body, gather(|i| vector(at * N + i, 3) * H))
    };
    (0..count / N).map(group).collect()
}

/// A group of free bodies: the body, its momentum in the body frame and its attitude.
type Turning<const N: usize> = (Poinsot<Lanes<N>>, Vector3<Lanes<N>>, Rotation<Lanes<N>>);

/// Free bodies whose root is computed again in every step.
struct Anew<'a, const N: usize>(&'a mut [Turning<N>], usize);
impl<const N: usize> Work for Anew<'_, N> {
    type Output = ();
    #[inline(always)]
    fn done(self) {
        let h = Lanes([H; N]);
        for (body, momentum, attitude) in self.0 {
            let (mut m, mut a) = (*momentum, *attitude);
            for _ in 0..self.1 {
                if let Ok(rotation) = forced(body, &Vector3::new(m.x * h, m.y * h, m.z * h)) {
                    m = rotation.inverse_rotate(&m);
                    a = a * rotation;
                }
            }
            (*momentum, *attitude) = (m, a);
        }
    }
}
fn turning<const N: usize>(count: usize) -> Vec<Turning<N>> {
    let group = |at: usize| {
        let body = Poinsot::new(gather(|i| poinsot(at * N + i))).expect("a body");
        (
            body,
            gather(|i| vector(at * N + i, 3)),
            gather(|i| Rotation::exp(&vector(at * N + i, 6))),
        )
    };
    (0..count / N).map(group).collect()
}
fn way<const N: usize>(ways: &mut Vec<Way<'_>>, count: usize, steps: usize) {
    for (name, set) in SETS {
        let mut list = turning::<N>(count);
        ways.push(Way::new(format!("{N} lanes, {name}"), move || {
            set.run(Anew(&mut list, steps));
            black_box(&list);
        }));
    }
}
fn anew(count: usize, steps: usize) {
    let mut ways = vec![];
    way::<1>(&mut ways, count, steps);
    ways.truncate(1);
    way::<8>(&mut ways, count, steps);
    way::<16>(&mut ways, count, steps);
    let title =
        format!("free body, its root anew at every step: {count} bodies, {steps} steps a call");
    race(&title, (count * steps) as f64, ways);
}

fn quartic(count: usize) {
    const REPEATS: usize = 64;
    let (one, eight, sixteen) = (
        equations::<1>(count),
        equations::<8>(count),
        equations::<16>(count),
    );
    let mut ways = vec![Way::new("one by one", || {
        for _ in 0..REPEATS {
            black_box(InstructionSet::Build.run(Solve(black_box(&one))));
        }
    })];
    for (name, set) in SETS {
        let eight = &eight;
        ways.push(Way::new(format!("8 lanes, {name}"), move || {
            for _ in 0..REPEATS {
                black_box(set.run(Solve(black_box(eight))));
            }
        }));
    }
    for (name, set) in SETS {
        let sixteen = &sixteen;
        ways.push(Way::new(format!("16 lanes, {name}"), move || {
            for _ in 0..REPEATS {
                black_box(set.run(Solve(black_box(sixteen))));
            }
        }));
    }
    let title = format!("quartic with its quaternion, normalised: {count} equations");
    race(&title, (count * REPEATS) as f64, ways);
}

fn main() {
    println!(
        "{}, h = {H}; ns per body and step, {ROUNDS} rounds",
        env!("RUSTC_VERSION")
    );
    table::<FreeBody>("free body, order 10", free_body, Order::Ten, [1024, 1024]);
    table::<FreeBody>("free body, order 10", free_body, Order::Ten, [1024, 64]);
    table::<FreeBody>(
        "free body, order 10",
        free_body,
        Order::Ten,
        [100_000, 1024],
    );
    table::<FreeBody>("free body, order 10", free_body, Order::Ten, [100_000, 64]);
    quartic(256);
    quartic(4096);
    anew(256, 64);
    table::<HeavyTop>("heavy top", heavy_top, None, [256, 64]);
    table::<HeavyTop>("heavy top", heavy_top, None, [100_000, 64]);
    table::<StiffTop>("stiff top, by Newton", stiff_top, (), [256, 64]);
    table::<CoupledBodies>("coupled bodies, by Newton", coupled, (), [256, 64]);
}
