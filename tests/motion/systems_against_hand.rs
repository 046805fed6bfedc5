//! Compares generated steppers of spatial forms, coupled bodies and bodies in fields with hand-written ones: one step from ten
//! thousand random states each, a thousand for coupled bodies. Tests check that a stepper of a slightly different system fails.

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};
use clebsch_models::body_in_quadratic_field::{
    BodyInQuadraticField, BodyInQuadraticFieldInitial, BodyInQuadraticFieldParameters,
};
use clebsch_models::body_in_two_fields::{
    BodyInTwoFields, BodyInTwoFieldsInitial, BodyInTwoFieldsParameters,
};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters,
};
use clebsch_models::free_body_spatial::{
    FreeBodySpatial, FreeBodySpatialInitial, FreeBodySpatialParameters,
};
use clebsch_models::heavy_top_spatial::{
    HeavyTopSpatial, HeavyTopSpatialInitial, HeavyTopSpatialParameters,
};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::attitude::{
    Matrix, Quaternion, Vector, apply, apply_transposed, dot,
};
use clebsch_oracle::handwritten::body_in_field::{BodyInField, QuadraticField, TwoFields};
use clebsch_oracle::handwritten::coupled_bodies::Pair;
use clebsch_oracle::handwritten::free_body_spatial::seen_from_space;
use clebsch_oracle::handwritten::heavy_top_spatial::SpatialTop;
use clebsch_oracle::physics::cases::Start;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

/// About thirty rounding errors of numbers of order one, for data without amplification.
const ONE_STEP: f64 = 1e-14;

/// Relative change of the data to measure conditioning: far above rounding, far below one.
const NUDGE: f64 = 1e-6;

/// A state with its data, one step from it in two ways, and a copy with the data of one kind slightly changed.
trait System: Sized {
    /// Number of random states.
    const STATES: u32 = 10_000;

    fn draw(draws: &mut Draws) -> Self;
    /// Increases momenta (kind 0) or a parameter (any other kind) by the fraction `by`; kind 1 rotates the attitude by that angle.
    fn nudged(&self, kind: u32, by: f64) -> Self;
    /// Attitude entries, momenta relative to the largest, other quantities relative to their size.
    fn by_hand(&self) -> Option<Vec<f64>>;
    fn generated(&self) -> Option<Vec<f64>>;
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, worse)
}

/// The factor, at least one, by which one step amplifies small changes: the change of the hand-written result over the relative
/// change of momenta, attitudes or parameters.
fn conditioning<S: System>(state: &S, result: &[f64]) -> f64 {
    (0..3)
        .filter_map(|kind| Some(apart(&state.nudged(kind, NUDGE).by_hand()?, result) / NUDGE))
        .fold(1.0, worse)
}

/// Largest difference divided by the conditioning of each state. Both steppers must fail for the same states.
fn single_steps<S: System>(name: &str, mistaken: f64) -> f64 {
    let mut draws = Draws::new(31);
    let (mut worst, mut bare, mut hardest, mut refused) = (0.0, 0.0, 0.0_f64, 0);
    for _ in 0..S::STATES {
        let state = S::draw(&mut draws);
        let generated = if mistaken == 0.0 {
            state.generated()
        } else {
            state.nudged(2, mistaken).generated()
        };
        match (generated, state.by_hand()) {
            (Some(generated), Some(hand)) => {
                let off = apart(&generated, &hand);
                let condition = conditioning(&state, &hand);
                bare = worse(bare, off);
                hardest = worse(hardest, condition);
                worst = worse(worst, off / condition);
            }
            (None, None) => refused += 1,
            (generated, hand) => panic!(
                "{name}: one refuses: generated {}, hand {}",
                generated.is_some(),
                hand.is_some()
            ),
        }
    }
    println!(
        "{name}: {bare:.1e}, over conditioning {worst:.1e} (at most {hardest:.1}), {refused} refused"
    );
    assert!(refused * 100 < S::STATES, "{name}: {refused} refused");
    worst
}

fn turned(q: &Quaternion, angle: f64) -> Quaternion {
    let half = 0.5 * angle;
    q.times(&Quaternion([1.0, 0.36 * half, 0.48 * half, 0.8 * half]))
        .normalised()
}

fn stretched(v: &Vector, by: f64) -> Vector {
    v.map(|c| c * (1.0 + by))
}

fn enlarged(m: &Matrix, by: f64) -> Matrix {
    m.map(|row| stretched(&row, by))
}

fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

fn column(v: &Vector) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

fn rotation(q: &Quaternion) -> Rotation<f64> {
    Rotation::from_quaternion(q.0).expect("a unit quaternion")
}

/// Attitude entries unchanged, and momenta divided by `size`.
fn listed(attitudes: &[Matrix3<f64>], momenta: &[Vector3<f64>], size: f64) -> Vec<f64> {
    let entries = attitudes
        .iter()
        .flat_map(|a| a.transpose().iter().copied().collect::<Vec<_>>());
    let scaled = momenta
        .iter()
        .flat_map(|m| m.iter().map(|c| c / size).collect::<Vec<_>>());
    entries.chain(scaled).collect()
}

fn written(attitudes: &[Matrix], momenta: &[Vector], size: f64) -> Vec<f64> {
    let entries = attitudes.iter().flat_map(|a| a.concat());
    entries
        .chain(momenta.iter().flat_map(|m| m.map(|c| c / size)))
        .collect()
}

fn length(v: &Vector) -> f64 {
    dot(v, v).sqrt()
}

/// The free body in the spatial form; the initial momentum is rotated to space.
struct SpatialBody(Start);

impl SpatialBody {
    fn data(&self) -> (Matrix, Vector) {
        let r = self.0.attitude.matrix();
        (
            seen_from_space(&self.0.top.poinsot, &r),
            apply(&r, &self.0.body_momentum),
        )
    }
}

impl System for SpatialBody {
    fn draw(draws: &mut Draws) -> Self {
        SpatialBody(draws.free_body())
    }

    fn nudged(&self, kind: u32, by: f64) -> Self {
        SpatialBody(nudged_start(&self.0, kind, by))
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let (j, m) = self.data();
        let start = &self.0;
        let mut body = handwritten::free_body_spatial::FreeBodySpatial::start(
            &j,
            &start.attitude,
            &m,
            start.h,
        )
        .ok()?;
        body.step();
        Some(written(
            &[body.attitude().matrix(), body.poinsot()],
            &[body.spatial_momentum()],
            length(&m),
        ))
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let (j, m) = self.data();
        let model = FreeBodySpatial::new(FreeBodySpatialParameters {
            scalar: std::marker::PhantomData,
        })
        .ok()?;
        let initial = FreeBodySpatialInitial {
            Λ: rotation(&self.0.attitude),
            spatial_momentum: SpatialMomentum(column(&m)),
            J: matrix(&j),
        };
        let (mut state, mut workspace) = model.start(initial, self.0.h).ok()?;
        model.step(&mut state, &mut workspace).ok()?;
        Some(listed(
            &[state.Λ().matrix(), model.J(&state)],
            &[state.spatial_momentum().0],
            length(&m),
        ))
    }
}

fn nudged_start(start: &Start, kind: u32, by: f64) -> Start {
    let mut moved = *start;
    match kind {
        0 => moved.body_momentum = stretched(&start.body_momentum, by),
        1 => moved.attitude = turned(&start.attitude, by),
        _ => moved.top.poinsot = enlarged(&start.top.poinsot, by),
    }
    moved
}

/// The heavy top in the spatial form.
struct SeenTop(Start);

impl SeenTop {
    fn data(&self) -> (SpatialTop, Vector) {
        let r = self.0.attitude.matrix();
        let top = SpatialTop {
            weight: 1.0,
            up: self.0.top.up,
            poinsot: seen_from_space(&self.0.top.poinsot, &r),
            arm: apply(&r, &self.0.top.weight),
        };
        (top, apply(&r, &self.0.body_momentum))
    }
}

impl System for SeenTop {
    fn draw(draws: &mut Draws) -> Self {
        SeenTop(draws.heavy_top())
    }

    fn nudged(&self, kind: u32, by: f64) -> Self {
        SeenTop(nudged_start(&self.0, kind, by))
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let (data, m) = self.data();
        let mut top = handwritten::heavy_top_spatial::HeavyTopSpatial::start(
            &data,
            &self.0.attitude,
            &m,
            self.0.h,
        )
        .ok()?;
        top.step().ok()?;
        let mut list = written(
            &[top.attitude().matrix(), top.poinsot()],
            &[top.spatial_momentum()],
            length(&m),
        );
        list.extend(top.arm());
        Some(list)
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let (data, m) = self.data();
        let model = HeavyTopSpatial::new(HeavyTopSpatialParameters {
            w: data.weight,
            z: column(&data.up),
        })
        .ok()?;
        let initial = HeavyTopSpatialInitial {
            Λ: rotation(&self.0.attitude),
            spatial_momentum: SpatialMomentum(column(&m)),
            J: matrix(&data.poinsot),
            χ: column(&data.arm),
        };
        let (mut state, mut workspace) = model.start(initial, self.0.h).ok()?;
        model.step(&mut state, &mut workspace).ok()?;
        let mut list = listed(
            &[state.Λ().matrix(), model.J(&state)],
            &[state.spatial_momentum().0],
            length(&m),
        );
        list.extend(model.χ(&state).iter());
        Some(list)
    }
}

/// A pair of bodies.
struct Joined {
    pair: Pair,
    attitudes: [Quaternion; 2],
    momenta: [Vector; 2],
    h: f64,
}

impl Joined {
    fn size(&self) -> f64 {
        length(&self.momenta[0]).max(length(&self.momenta[1]))
    }
}

impl System for Joined {
    /// Fewer states: each failed step searches for an admissible step size, which takes a tenth of a second.
    const STATES: u32 = 1_000;

    fn draw(draws: &mut Draws) -> Self {
        let eps = draws.uniform(0.05, 1.0);
        let [one, two] = [draws.free_body(), draws.free_body()];
        let mut arm = || {
            let longest = draws.uniform(0.1, 1.0);
            draws.direction().map(|c| c * longest)
        };
        let arms = [arm(), arm()];
        let mut poinsots = [one.top.poinsot, two.top.poinsot];
        for (j, d) in poinsots.iter_mut().zip(&arms) {
            for (row, x) in j.iter_mut().zip(d) {
                for (entry, y) in row.iter_mut().zip(d) {
                    *entry += eps * (x * y);
                }
            }
        }
        // Rescales the momenta of the free bodies, each drawn for its own step size, to one step size and well within the limit of
        // the pair, whose coupling lowers the inertia.
        let h = draws.uniform(0.01, 0.2);
        let momenta = [one, two].map(|s| s.body_momentum.map(|c| 0.4 * c * s.h / h));
        Joined {
            pair: Pair {
                poinsots,
                arms,
                eps,
            },
            attitudes: [one.attitude, two.attitude],
            momenta,
            h,
        }
    }

    fn nudged(&self, kind: u32, by: f64) -> Self {
        let mut moved = Joined { ..*self };
        match kind {
            0 => moved.momenta = self.momenta.map(|m| stretched(&m, by)),
            1 => moved.attitudes[0] = turned(&self.attitudes[0], by),
            _ => moved.pair.poinsots = self.pair.poinsots.map(|j| enlarged(&j, by)),
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let mut pair = handwritten::coupled_bodies::CoupledBodies::start(
            &self.pair,
            &self.attitudes,
            &self.momenta,
            self.h,
        )
        .ok()?;
        pair.step().ok()?;
        Some(written(
            &pair.attitudes().map(|q| q.matrix()),
            &[pair.body_momenta(), pair.spatial_momenta()].concat(),
            self.size(),
        ))
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let model = CoupledBodies::new(CoupledBodiesParameters {
            J1: matrix(&self.pair.poinsots[0]),
            J2: matrix(&self.pair.poinsots[1]),
            d1: column(&self.pair.arms[0]),
            d2: column(&self.pair.arms[1]),
            eps: self.pair.eps,
        })
        .ok()?;
        let initial = CoupledBodiesInitial {
            Λ1: rotation(&self.attitudes[0]),
            body_momentum_Λ1: BodyMomentum(column(&self.momenta[0])),
            Λ2: rotation(&self.attitudes[1]),
            body_momentum_Λ2: BodyMomentum(column(&self.momenta[1])),
        };
        let (mut state, mut workspace) = model.start(initial, self.h).ok()?;
        model.step(&mut state, &mut workspace).ok()?;
        Some(listed(
            &[state.Λ1().matrix(), state.Λ2().matrix()],
            &[
                state.body_momentum_Λ1().0,
                state.body_momentum_Λ2().0,
                state.spatial_momentum_Λ1().0,
                state.spatial_momentum_Λ2().0,
            ],
            self.size(),
        ))
    }
}

/// A body in a quadratic field; the torque has the size of the torque on the random top.
struct InQuadraticField(Start, Matrix);

impl System for InQuadraticField {
    fn draw(draws: &mut Draws) -> Self {
        let start = draws.heavy_top();
        let mut k = [[0.0; 3]; 3];
        for (r, c) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
            k[r][c] = draws.uniform(-0.7, 0.7);
            k[c][r] = k[r][c];
        }
        InQuadraticField(start, k)
    }

    fn nudged(&self, kind: u32, by: f64) -> Self {
        InQuadraticField(nudged_start(&self.0, kind, by), self.1)
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let start = &self.0;
        let field = QuadraticField {
            stiffness: self.1,
            axis: start.top.up,
        };
        let mu = &start.body_momentum;
        let mut body =
            BodyInField::start(&start.top.poinsot, &field, &start.attitude, mu, start.h).ok()?;
        body.step().ok()?;
        Some(written(
            &[body.attitude().matrix()],
            &[body.body_momentum(), body.spatial_momentum()],
            length(mu).max(start.h),
        ))
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let start = &self.0;
        let model = BodyInQuadraticField::new(BodyInQuadraticFieldParameters {
            J: matrix(&start.top.poinsot),
            K: matrix(&self.1),
        })
        .ok()?;
        let initial = BodyInQuadraticFieldInitial {
            Λ: rotation(&start.attitude),
            body_momentum: BodyMomentum(column(&start.body_momentum)),
            Γ: column(&apply_transposed(&start.attitude.matrix(), &start.top.up)),
        };
        let (mut state, mut workspace) = model.start(initial, start.h).ok()?;
        model.step(&mut state, &mut workspace).ok()?;
        Some(listed(
            &[state.Λ().matrix()],
            &[state.body_momentum().0, state.spatial_momentum().0],
            length(&start.body_momentum).max(start.h),
        ))
    }
}

/// A body in two uniform fields: the random top with a dipole.
struct InTwoFields(Start, TwoFields);

impl System for InTwoFields {
    fn draw(draws: &mut Draws) -> Self {
        let start = draws.heavy_top();
        let fields = TwoFields {
            weight: start.top.weight.map(|c| 0.5 * c),
            dipole: draws.direction(),
            up: start.top.up,
            field: draws.direction().map(|c| 0.7 * c),
        };
        InTwoFields(start, fields)
    }

    fn nudged(&self, kind: u32, by: f64) -> Self {
        InTwoFields(nudged_start(&self.0, kind, by), self.1)
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let start = &self.0;
        let mu = &start.body_momentum;
        let mut body =
            BodyInField::start(&start.top.poinsot, &self.1, &start.attitude, mu, start.h).ok()?;
        body.step().ok()?;
        Some(written(
            &[body.attitude().matrix()],
            &[body.body_momentum(), body.spatial_momentum()],
            length(mu).max(start.h),
        ))
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let start = &self.0;
        let model = BodyInTwoFields::new(BodyInTwoFieldsParameters {
            J: matrix(&start.top.poinsot),
            gU: column(&self.1.weight),
            p: column(&self.1.dipole),
            z: column(&self.1.up),
            b: column(&self.1.field),
        })
        .ok()?;
        let initial = BodyInTwoFieldsInitial {
            Λ: rotation(&start.attitude),
            body_momentum: BodyMomentum(column(&start.body_momentum)),
        };
        let (mut state, mut workspace) = model.start(initial, start.h).ok()?;
        model.step(&mut state, &mut workspace).ok()?;
        Some(listed(
            &[state.Λ().matrix()],
            &[state.body_momentum().0, state.spatial_momentum().0],
            length(&start.body_momentum).max(start.h),
        ))
    }
}

fn agree<S: System>(name: &str) {
    let worst = single_steps::<S>(name, 0.0);
    assert!(worst < ONE_STEP, "{name}: {worst:e}");
    // An inertia larger by one part in a million is a different system, and the comparison detects it.
    let worst = single_steps::<S>(name, 1e-6);
    assert!(worst > 1e4 * ONE_STEP, "{name}, other inertia: {worst:e}");
}

#[test]
fn free_body_spatial() {
    agree::<SpatialBody>("free body, spatial");
}

#[test]
fn heavy_top_spatial() {
    agree::<SeenTop>("heavy top, spatial");
}

#[test]
fn coupled_bodies() {
    agree::<Joined>("coupled bodies");
}

#[test]
fn body_in_quadratic_field() {
    agree::<InQuadraticField>("quadratic field");
}

#[test]
fn body_in_two_fields() {
    agree::<InTwoFields>("two fields");
}
