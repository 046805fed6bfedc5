//! The closed form of the free body against a double-double Taylor series, and every other method for a free body against the
//! closed form: orders, equality of maps, and invariants.

use clebsch::scalar::larger;
use clebsch::{DoubleDouble, Real};
use clebsch_comparisons::body::exact::Exact;
use clebsch_comparisons::body::implicit::{FixedPoint, Newton};
use clebsch_comparisons::body::splitting::{FourthOrderSplitting, MergedSplitting, Splitting};
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::continuous::rigid::{Field, RigidBody};
use clebsch_comparisons::handwritten::attitude::{Matrix, Quaternion, Vector, apply, dot};
use clebsch_comparisons::handwritten::free_body::FreeBody;
use clebsch_comparisons::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta};

/// J from principal moments, rotated by a quaternion.
fn poinsot(moments: Vector, frame: [f64; 4]) -> Matrix {
    let half = moments.iter().sum::<f64>() / 2.0;
    let r = Quaternion(frame).normalised().matrix();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (0..3)
                .map(|k| r[i][k] * (half - moments[k]) * r[j][k])
                .sum()
        })
    })
}

fn start(moments: Vector, frame: [f64; 4], body_momentum: Vector, h: f64) -> Start {
    Start {
        poinsot: poinsot(moments, frame),
        attitude: Quaternion([0.5, -0.1, 0.7, 0.3]).normalised(),
        body_momentum,
        h,
    }
}

const STRAIGHT: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// Bodies of every kind: on both sides of the separatrix, both symmetric cases, steady, near the separatrix, and in axes that are
/// not principal.
fn bodies() -> Vec<(&'static str, Start)> {
    let crooked = [0.9, 0.2, -0.3, 0.1];
    vec![
        (
            "round the largest",
            start([3.5, 2.5, 2.0], STRAIGHT, [1.0, 0.3, -0.2], 0.1),
        ),
        (
            "round the smallest",
            start([3.5, 2.5, 2.0], STRAIGHT, [-0.5, 0.0, 1.0], 0.1),
        ),
        (
            "reversed",
            start([3.5, 2.5, 2.0], STRAIGHT, [0.5, 0.4, -1.0], 0.1),
        ),
        (
            "ordered upward",
            start([1.0, 2.0, 3.0], STRAIGHT, [0.5, 0.3, 1.0], 0.1),
        ),
        (
            "unordered",
            start([2.5, 3.5, 2.0], STRAIGHT, [-0.8, 0.3, 0.1], 0.1),
        ),
        (
            "oblate",
            start([2.0, 2.0, 3.0], STRAIGHT, [0.1, 0.2, 1.0], 0.1),
        ),
        (
            "prolate",
            start([2.0, 2.0, 1.0], STRAIGHT, [0.1, 0.0, 1.0], 0.1),
        ),
        (
            "symmetric about the first axis",
            start([1.0, 2.0, 2.0], STRAIGHT, [0.3, -0.2, 1.0], 0.1),
        ),
        ("sphere", start([2.0; 3], STRAIGHT, [0.3, -0.2, 1.0], 0.1)),
        (
            "steady",
            start([3.5, 2.5, 2.0], STRAIGHT, [0.0, 0.0, 1.0], 0.1),
        ),
        (
            "nearly steady",
            start([3.5, 2.5, 2.0], STRAIGHT, [1e-7, 2e-7, 1.0], 0.1),
        ),
        (
            "nearly symmetric",
            start([2.0, 2.0 - 1e-9, 1.0], STRAIGHT, [0.3, -0.2, 1.0], 0.1),
        ),
        (
            "near the separatrix",
            start([3.5, 2.5, 2.0], STRAIGHT, [1e-3, 1.0, 2e-3], 0.1),
        ),
        (
            "crooked axes",
            start([3.5, 2.5, 2.0], crooked, [-0.5, 0.3, 1.0], 0.1),
        ),
    ]
}

type Dd = DoubleDouble;

/// The continuous motion by a double-double Taylor series, from the same `f64` numbers. Products of series use Cauchy's rule; 30
/// terms with steps of 1/16 have an error of 1e-30.
fn taylor(start: &Start, time: f64) -> ([Dd; 4], [Dd; 3]) {
    const TERMS: usize = 30;
    let c = Dd::from_f64;
    let trace = c(start.poinsot[0][0]) + c(start.poinsot[1][1]) + c(start.poinsot[2][2]);
    let inertia: [[Dd; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { trace } else { c(0.0) } - c(start.poinsot[i][j]))
    });
    let cofactor = |r: usize, s: usize| {
        let (r1, r2, s1, s2) = ((r + 1) % 3, (r + 2) % 3, (s + 1) % 3, (s + 2) % 3);
        inertia[r1][s1] * inertia[r2][s2] - inertia[r1][s2] * inertia[r2][s1]
    };
    let det = (0..3).fold(c(0.0), |sum, k| sum + inertia[0][k] * cofactor(0, k));
    let inverse: [[Dd; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / det));
    let mut q = start.attitude.0.map(c);
    let mut m = start.body_momentum.map(c);
    let count = (time * 16.0).ceil();
    let step = c(time) / c(count);
    for _ in 0..count as usize {
        let (mut qs, mut ms, mut ws) = (vec![q], vec![m], Vec::new());
        for n in 0..TERMS {
            ws.push(std::array::from_fn::<Dd, 3, _>(|i| {
                (0..3).fold(c(0.0), |sum, j| sum + inverse[i][j] * ms[n][j])
            }));
            let next = c((n + 1) as f64);
            let (mut dq, mut dm) = ([c(0.0); 4], [c(0.0); 3]);
            for k in 0..=n {
                let (a, w, b): ([Dd; 4], [Dd; 3], [Dd; 3]) = (qs[k], ws[n - k], ms[k]);
                dq[0] += -(a[1] * w[0] + a[2] * w[1] + a[3] * w[2]);
                for i in 0..3 {
                    let (j, l) = ((i + 1) % 3, (i + 2) % 3);
                    dq[i + 1] += a[0] * w[i] + a[j + 1] * w[l] - a[l + 1] * w[j];
                    dm[i] += b[j] * w[l] - b[l] * w[j];
                }
            }
            qs.push(dq.map(|x| x / (next + next)));
            ms.push(dm.map(|x| x / next));
        }
        let sum =
            |of: &dyn Fn(usize) -> Dd| (0..=TERMS).rev().fold(c(0.0), |s, n| s * step + of(n));
        q = std::array::from_fn(|i| sum(&|n| qs[n][i]));
        m = std::array::from_fn(|i| sum(&|n| ms[n][i]));
    }
    (q, m)
}

/// Largest difference of attitude (as quaternions up to sign) and momentum.
fn distance(a: &(Quaternion, Vector), b: &(Quaternion, Vector)) -> f64 {
    let along = |s: f64| {
        let pairs = a.0.0.iter().zip(b.0.0);
        pairs.map(|(x, y)| (x - s * y).abs()).fold(0.0, larger)
    };
    let momenta = a.1.iter().zip(b.1).map(|(x, y)| (x - y).abs());
    momenta.fold(along(1.0).min(along(-1.0)), f64::max)
}

fn exact(start: &Start, time: f64) -> (Quaternion, Vector) {
    Exact::start(start).unwrap().at(time)
}

/// Rounding of the closed form: the initial data are rounded to principal axes, and a rate error of 1e-15 grows to 1e-14 radians
/// within ten radians. The total rotation is about 50 radians at most.
#[test]
fn closed_form_is_the_continuous_motion() {
    for (name, start) in bodies() {
        for time in [0.0, 0.37, 5.0, 40.0] {
            let (q, m) = taylor(&start, time);
            let truth = (Quaternion(q.map(Real::value)), m.map(Real::value));
            let error = distance(&exact(&start, time), &truth);
            // Near the separatrix, neighbouring starts diverge exponentially, here by about e^5.
            let bound = if name == "near the separatrix" {
                1e-12
            } else {
                1e-13
            };
            assert!(error < bound, "{name} at {time}: {error:e}");
        }
    }
}

/// The exact separatrix: parameter m = 1, where the functions are hyperbolic.
#[test]
fn separatrix_is_followed() {
    // For I = (4, 2, 1), the condition |mu|^2 = 2 E I_2 means mu_1^2 (1/2 - 1/4) = mu_3^2 (1 - 1/2). The first pair satisfies this
    // exactly for squares rounded to f64, the second pair up to rounding.
    let pairs = [(0.6187184335382291_f64, 0.4375), (2.0_f64.sqrt(), 1.0)];
    assert!(pairs[0].0.powi(2) == 2.0 * pairs[0].1.powi(2));
    for ((x, z), time) in pairs
        .into_iter()
        .flat_map(|p| [0.3, 1.0, 3.0].map(|t| (p, t)))
    {
        let start = start([4.0, 2.0, 1.0], STRAIGHT, [x, 0.5, z], 0.1);
        let (q, m) = taylor(&start, time);
        let truth = (Quaternion(q.map(Real::value)), m.map(Real::value));
        let error = distance(&exact(&start, time), &truth);
        assert!(error < 1e-13, "at {time}: {error:e}");
    }
}

/// Largest error at the nodes up to time 10 with this number of steps.
fn error<M: BodyMotion>(make: impl Fn(&Start) -> M, start: &Start, steps: u32) -> f64 {
    let start = Start {
        h: 10.0 / f64::from(steps),
        ..*start
    };
    let (mut motion, mut truth) = (make(&start), Exact::start(&start).unwrap());
    (0..steps).fold(0.0, |worst, _| {
        motion.step().unwrap();
        truth.step().unwrap();
        let here = (motion.attitude(), motion.body_momentum());
        distance(&here, &(truth.attitude(), truth.body_momentum())).max(worst)
    })
}

#[test]
fn orders_are_those_of_the_literature() {
    let start = start(
        [3.5, 2.5, 2.0],
        [0.9, 0.2, -0.3, 0.1],
        [-0.5, 0.3, 1.0],
        0.1,
    );
    let order = |errors: [f64; 2]| (errors[0] / errors[1]).log2();
    let measured = [
        (
            2.0,
            order([100, 200].map(|n| error(|s| Splitting::start(s).unwrap(), &start, n))),
        ),
        (
            2.0,
            order([100, 200].map(|n| error(|s| MergedSplitting::start(s).unwrap(), &start, n))),
        ),
        (
            4.0,
            order([40, 80].map(|n| error(|s| FourthOrderSplitting::start(s).unwrap(), &start, n))),
        ),
        (
            2.0,
            order([100, 200].map(|n| error(|s| FixedPoint::start(s).unwrap(), &start, n))),
        ),
        (
            2.0,
            order([100, 200].map(|n| error(|s| Newton::start(s).unwrap(), &start, n))),
        ),
    ];
    // The next term of the expansion is (h/2)^2 = 1e-3 of the leading one; 0.05 is a wide margin and far from the next order.
    for (index, (order, measured)) in measured.into_iter().enumerate() {
        assert!(
            (measured - order).abs() < 0.05,
            "method {index}: order {measured}"
        );
    }
}

#[test]
fn iterations_solve_the_explicit_step() {
    for (name, start) in bodies() {
        let mut explicit = FreeBody::start(
            &start.poinsot,
            &start.attitude,
            &start.body_momentum,
            start.h,
        )
        .unwrap();
        let (mut fixed, mut newton) = (
            FixedPoint::start(&start).unwrap(),
            Newton::start(&start).unwrap(),
        );
        for _ in 0..100 {
            explicit.step();
            fixed.step().unwrap();
            newton.step().unwrap();
        }
        let here = (explicit.attitude(), explicit.body_momentum());
        for other in [&fixed as &dyn BodyMotion, &newton] {
            let apart = distance(&here, &(other.attitude(), other.body_momentum()));
            // A hundred rounding errors, amplified about tenfold near the separatrix.
            assert!(apart < 1e-12, "{name}: {apart:e}");
        }
    }
}

/// The rotations conserve the spatial momentum to rounding, and the energy only within O(h^2).
#[test]
fn splitting_keeps_spatial_momentum_and_swings_in_energy() {
    let start = start([3.5, 2.5, 2.0], STRAIGHT, [-0.5, 0.3, 1.0], 0.1);
    let space = |m: &dyn BodyMotion| apply(&m.attitude().matrix(), &m.body_momentum());
    let energy = |m: &dyn BodyMotion| {
        let mu = m.body_momentum();
        0.5 * dot(&mu, &[mu[0] / 3.5, mu[1] / 2.5, mu[2] / 2.0])
    };
    let mut motions: [Box<dyn BodyMotion>; 3] = [
        Box::new(Splitting::start(&start).unwrap()),
        Box::new(MergedSplitting::start(&start).unwrap()),
        Box::new(FourthOrderSplitting::start(&start).unwrap()),
    ];
    for motion in &mut motions {
        let (before, first) = (space(motion.as_ref()), energy(motion.as_ref()));
        let mut swing = 0.0_f64;
        for _ in 0..1000 {
            motion.step().unwrap();
            swing = swing.max((energy(motion.as_ref()) - first).abs());
        }
        let after = space(motion.as_ref());
        let drift = before
            .iter()
            .zip(after)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, larger);
        // At most 25000 rounding errors, as a random walk.
        assert!(drift < 1e-13, "{drift:e}");
        assert!(swing > 1e-11 && swing < 1e-3, "{swing:e}");
    }
}

#[test]
fn runge_kutta_meets_its_tolerance() {
    let start = start([3.5, 2.5, 2.0], STRAIGHT, [-0.5, 0.3, 1.0], 0.1);
    let [w, x, y, z] = start.attitude.0;
    let [a, b, c] = start.body_momentum;
    let first = [w, x, y, z, a, b, c];
    let body = || RigidBody::new(&start.poinsot, Field::None);
    let errors = |state: &[f64; 7], time: f64| {
        let [w, x, y, z, a, b, c] = *state;
        distance(&(Quaternion([w, x, y, z]), [a, b, c]), &exact(&start, time))
    };
    let accuracy = Accuracy::reference(2);
    let mut reference =
        RungeKutta::<Method98<7>, _, 7>::start(body(), &first, 0.1, accuracy).unwrap();
    let mut eighth =
        RungeKutta::<Method85<7>, _, 7>::start(body(), &first, 0.1, Accuracy::of(1e-12)).unwrap();
    let mut fifth =
        RungeKutta::<Method54<7>, _, 7>::start(body(), &first, 0.1, Accuracy::of(1e-6)).unwrap();
    for _ in 0..1000 {
        reference.step().unwrap();
        eighth.step().unwrap();
        fifth.step().unwrap();
    }
    // Rounding of two thousand steps as a random walk, as an angle over 50 radians.
    assert!(errors(reference.state(), 100.0) < 3e-13);
    assert!(errors(eighth.state(), 100.0) < 1e-11);
    let coarse = errors(fifth.state(), 100.0);
    assert!(coarse > 1e-12 && coarse < 1e-4, "{coarse:e}");
}
