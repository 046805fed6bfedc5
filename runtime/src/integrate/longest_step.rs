//! The longest step with which small motions about the start stay small: 2/ω, ω the frequency of the fastest one.
//! Takes a model's card with its data; asks single steps from rest for forces and for the inverse of the mass.

use crate::Rotation;
use crate::card::{Card, Field, Kind, Settings};
use crate::groups::so3::hamilton;
use crate::scalar::largest;
use nalgebra::{DMatrix, Matrix3, SymmetricEigen, Vector3};
use std::ops::Range;

/// Most vectors of the Krylov space: the fastest of thousands of motions is found to about a hundredth.
const VECTORS: usize = 30;

/// A disturbance in parts of what is disturbed, and a momentum likewise: forces and velocities are taken as linear
/// in them. The square root of rounding and more, since models bend.
const PART: f64 = 1e-5;

/// Steps of the inquiry in parts of the run's own: with ω h at most about 2, ω² h² of them is 4e-6 at most.
const SHORT: f64 = 1e-3;

/// A limit that is a smaller part of the run's step than this is asked for once more by shorter steps.
const FAR: f64 = 0.1;

/// By which parts of the step.
const SHORTER: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

/// Growth in a step of which is warned: that of a body on its head takes many steps.
const GROWTH: f64 = 0.3;

/// What small motions about the start, at rest, ask of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongestStep {
    /// 2/ω, with ω the frequency of the fastest small motion; infinite where there is none that swings.
    pub step: f64,
    /// The rate at which the fastest growing one grows, in the inverse unit of time; 0 where none does.
    pub growth: f64,
    /// How many configurations were disturbed, each at every site.
    pub configurations: usize,
}

impl LongestStep {
    /// Of a model in these data, each field one vector, row-major; `h` is a step of about the size that is asked of.
    ///
    /// `None` for configurations other than fields, rotations of space, and unit quaternions, where nothing resists a
    /// disturbance, and where a step does not move what swings fastest as steps with the potential at the nodes do: with
    /// a potential in the middle of steps, with strong terms linear in velocities, at a kink, all steps may be stable.
    #[must_use]
    pub fn of(card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>], h: f64) -> Option<Self> {
        let asked = |part: f64| Self::asked(card, parameters, initial, h * part);
        let found = asked(1.0);
        if found.is_some_and(|found| found.step > FAR * h.abs()) {
            return found;
        }
        // Of a step that is hundreds of times too long even a small part is no short one.
        let shorter = SHORTER.into_iter().filter_map(asked);
        let mut shorter = shorter.filter(|found| found.step < h.abs());
        shorter.next().or(found)
    }

    /// The same, asked by steps that are short beside `h`.
    fn asked(card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>], h: f64) -> Option<Self> {
        let probe = Probe::new(card, parameters, initial, h * SHORT)?;
        let [least, largest] = probe.extremes()?;
        // What does not swing within a hundred thousand steps of this size is the rounding of forces that are none, as
        // what is rounding beside the other.
        let rounding = (2.0e-5 / h).powi(2);
        let seen = |x: f64, beside: f64| x.abs() > rounding && x.abs() > 1e-6 * beside.abs();
        let swings = largest.square > 0.0 && seen(largest.square, least.square);
        let grows = least.square < 0.0 && seen(least.square, largest.square);
        let step = match swings {
            true => 2.0 / largest.square.sqrt(),
            false => f64::INFINITY,
        };
        let growth = match grows {
            true => (-least.square).sqrt(),
            false => 0.0,
        };
        // A step of the model must move what it is told of as steps of this kind do.
        let moved = (!swings || probe.is_left(&largest, step))
            && (!grows || probe.is_left(&least, 1.0 / growth));
        (moved && (swings || grows)).then_some(Self {
            step,
            growth,
            configurations: probe.moves.len(),
        })
    }

    /// ω of the fastest small motion, in radians by the unit of time; 0 where there is none that swings.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        2.0 / self.step
    }

    /// The longest step over which the fastest growing motion grows by a third; infinite where none does.
    #[must_use]
    pub fn resolving(&self) -> f64 {
        GROWTH / self.growth
    }

    /// What is wrong with steps of `h`, if anything: they are too long, or a motion grows as they go on.
    #[must_use]
    pub fn warning(&self, h: f64) -> Option<String> {
        let h = h.abs();
        if h > self.step {
            return Some(format!(
                "the step h = {h} is {:.2} times the longest one that keeps small motions about the start small, \
                 {:.3e} (2/ω of the fastest): what is disturbed there grows in every step; take a shorter one",
                h / self.step,
                self.step
            ));
        }
        if h > self.resolving() {
            let a_step = match (h * self.growth).exp() {
                few if few < 1e3 => format!("{few:.2}"),
                many if many.is_finite() => format!("{many:.1e}"),
                _ => format!("exp({:.3e})", h * self.growth),
            };
            let grow = format!(
                "small motions about the start, at rest, grow with the rate {:.3e}, by a factor of {a_step} a step",
                self.growth
            );
            // A body on its head and a rod that is pulled along its length are unstable by right; between neighbours
            // what grows so fast is mostly a wrong sign.
            return Some(match self.configurations {
                1 => format!(
                    "{grow}: where the motion is near it, steps of h = {h} do not resolve how the start is left; those \
                     up to {:.3e} do",
                    self.resolving()
                ),
                _ => format!(
                    "{grow}: is there a sign wrong in the potential energy, or in a term that joins neighbours? Where \
                     the start is so unstable, steps of h = {h} do not resolve how it is left; those up to {:.3e} do",
                    self.resolving()
                ),
            });
        }
        None
    }
}

/// A small motion: its ω², and what moves with the kinetic energy one half.
struct Motion {
    square: f64,
    velocity: Vec<f64>,
    momentum: Vec<f64>,
}

/// A configuration and its momentum among the initial values and among what is observed.
struct Moves {
    initial: usize,
    behind: usize,
    kind: Kind,
    spatial: bool,
    place: Range<usize>,
    momentum: Range<usize>,
}

impl Moves {
    /// Its freedoms.
    fn count(&self) -> usize {
        self.momentum.len()
    }
}

struct Probe<'a> {
    card: &'a Card,
    parameters: &'a [Vec<f64>],
    /// At rest.
    initial: Vec<Vec<f64>>,
    moves: Vec<Moves>,
    /// The step of the inquiry.
    h: f64,
    /// The unit of disturbances of each freedom.
    units: Vec<f64>,
    /// What is observed after a step from rest.
    rest: Vec<f64>,
}

impl<'a> Probe<'a> {
    fn new(
        card: &'a Card,
        parameters: &'a [Vec<f64>],
        initial: &[Vec<f64>],
        h: f64,
    ) -> Option<Self> {
        let mut initial = initial.to_vec();
        let mut moves = Vec::new();
        for (at, place) in card.initial.iter().enumerate() {
            if is_momentum(place) {
                continue;
            }
            let behind = momentum_of(card, place)?;
            let momentum = card.initial.get(behind)?;
            let spatial = momentum.kind == Kind::SpatialMomentum;
            let known = match (place.kind, momentum.kind) {
                (_, Kind::FieldMomentum) => place.count() == momentum.count(),
                (
                    Kind::Rotation | Kind::UnitQuaternion,
                    Kind::BodyMomentum | Kind::SpatialMomentum,
                ) => momentum.count() == 3,
                _ => false,
            };
            if !known {
                return None;
            }
            moves.push(Moves {
                initial: at,
                behind,
                kind: match momentum.kind {
                    Kind::FieldMomentum => Kind::FieldMomentum,
                    _ => place.kind,
                },
                spatial,
                place: columns(card, place)?,
                momentum: columns(card, momentum)?,
            });
            initial.get_mut(behind)?.fill(0.0);
        }
        let units = units(&moves, &initial);
        let mut probe = Probe {
            card,
            parameters,
            initial,
            moves,
            h,
            units,
            rest: Vec::new(),
        };
        probe.rest = probe.after(&probe.initial, h)?;
        Some(probe)
    }

    /// What is observed after one step of `h`.
    fn after(&self, initial: &[Vec<f64>], h: f64) -> Option<Vec<f64>> {
        let settings = Settings::step(h);
        let mut trajectory = (self.card.open)(self.parameters, initial, settings).ok()?;
        trajectory.step().ok()?;
        let mut out = vec![0.0; self.card.observable_count()];
        trajectory.observe(&mut out);
        out.iter().all(|x| x.is_finite()).then_some(out)
    }

    /// Of momenta after a step from rest, disturbed by `v`, what the disturbance adds: minus the stiffness times `v`,
    /// and the step.
    fn stiffness(&self, v: &[f64]) -> Option<Vec<f64>> {
        let scale = PART / self.size(v);
        let after = self.after(&self.disturbed(v, scale)?, self.h)?;
        let each = self.moves.iter().flat_map(|body| body.momentum.clone());
        let change = each.map(|column| (self.rest[column] - after[column]) / (scale * self.h));
        Some(change.collect())
    }

    /// The velocity of a momentum `p`: by how much a step with it goes farther than one from rest.
    fn velocity(&self, p: &[f64]) -> Option<Vec<f64>> {
        // How far it goes is known once it has gone.
        let mut scale = PART / largest(p.iter().copied());
        if !scale.is_finite() {
            return None;
        }
        for _ in 0..12 {
            let mut moved = self.initial.clone();
            let mut from = 0;
            for body in &self.moves {
                let own = &p[from..from + body.count()];
                from += body.count();
                let target = moved.get_mut(body.behind)?;
                target.clone_from(&own.iter().map(|x| x * scale).collect());
            }
            let change = self.change(&self.rest, &self.after(&moved, self.h)?);
            let most = self.size(&change);
            if (0.01 * PART..=100.0 * PART).contains(&most) {
                return Some(change.iter().map(|x| x / (scale * self.h)).collect());
            }
            scale *= if most > 0.0 { PART / most } else { 1e6 };
        }
        None
    }

    /// Whether a step of `h` from rest, disturbed by this motion, leaves `1 - h² ω²/2` of it, as steps with the potential
    /// at the nodes do: one with it in the middle leaves `(4 - h² ω²)/(4 + h² ω²)`. Half a step where one cannot be made.
    fn is_left(&self, motion: &Motion, h: f64) -> bool {
        [h, 0.5 * h]
            .into_iter()
            .find_map(|h| self.left(motion, h))
            .is_some_and(|(h, left)| {
                let square = h * h * motion.square;
                (left - (1.0 - 0.5 * square)).abs() < 0.1 * square.abs()
            })
    }

    /// The part of a motion that a step leaves, and the step; `None` where it cannot be made.
    fn left(&self, motion: &Motion, h: f64) -> Option<(f64, f64)> {
        let scale = PART / self.size(&motion.velocity);
        let moved = self.disturbed(&motion.velocity, scale)?;
        let change = self.change(&self.after(&self.initial, h)?, &self.after(&moved, h)?);
        Some((h, dot(&motion.momentum, &change) / scale))
    }

    /// The largest part of a change in units of disturbances.
    fn size(&self, change: &[f64]) -> f64 {
        largest(change.iter().zip(&self.units).map(|(x, unit)| x / unit))
    }

    /// From the configurations of one observation to those of another.
    fn change(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let each = self.moves.iter().flat_map(|body| {
            let place = body.place.clone();
            difference(body, &from[place.clone()], &to[place])
        });
        each.collect()
    }

    /// The start with a disturbance `scale` times `v`.
    fn disturbed(&self, v: &[f64], scale: f64) -> Option<Vec<Vec<f64>>> {
        let mut moved = self.initial.clone();
        let mut from = 0;
        for body in &self.moves {
            let own: Vec<f64> = v[from..from + body.count()]
                .iter()
                .map(|x| x * scale)
                .collect();
            from += body.count();
            disturb(moved.get_mut(body.initial)?, body, &own)?;
        }
        Some(moved)
    }

    /// The motions of least and of largest ω², by Lanczos' method in the inner product of the mass.
    fn extremes(&self) -> Option<[Motion; 2]> {
        let count: usize = self.moves.iter().map(Moves::count).sum();
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            f64::from(u32::try_from(seed >> 33).unwrap_or(0)) / f64::from(1_u32 << 31) - 0.5
        };
        // Momenta that give about equal velocities in parts of what moves.
        let mut p: Vec<f64> = (0..count).map(|_| number()).collect();
        let first = self.velocity(&p)?;
        for ((p, v), unit) in p.iter_mut().zip(&first).zip(&self.units) {
            let own = (v / unit).abs();
            *p /= own.max(1e-3);
        }
        let (mut velocities, mut momenta) = (Vec::<Vec<f64>>::new(), Vec::<Vec<f64>>::new());
        let (mut alphas, mut betas) = (Vec::<f64>::new(), Vec::<f64>::new());
        for _ in 0..VECTORS.min(count) {
            // Twice is enough.
            for _ in 0..2 {
                for (v, q) in velocities.iter().zip(&momenta) {
                    let part = dot(v, &p);
                    p.iter_mut().zip(q).for_each(|(p, q)| *p -= part * q);
                }
            }
            let Some(v) = self.velocity(&p) else { break };
            let square = dot(&v, &p);
            // The space is exhausted: what is left of it is the rounding of the inquiry.
            let least = 1e-6 * largest(alphas.iter().copied());
            if square.is_nan() || square <= 0.0 || (!alphas.is_empty() && square.sqrt() <= least) {
                break;
            }
            let length = square.sqrt();
            if !alphas.is_empty() {
                betas.push(length);
            }
            let v: Vec<f64> = v.iter().map(|x| x / length).collect();
            momenta.push(p.iter().map(|x| x / length).collect());
            p = self.stiffness(&v)?;
            // Nothing resists: no step is too long for that.
            if velocities.is_empty() && p.iter().all(|x| *x == 0.0) {
                return None;
            }
            alphas.push(dot(&v, &p));
            velocities.push(v);
        }
        if alphas.is_empty() {
            return None;
        }
        let at = |i: usize, j: usize| match i.abs_diff(j) {
            0 => alphas[i],
            1 => betas[i.min(j)],
            _ => 0.0,
        };
        let small = SymmetricEigen::new(DMatrix::from_fn(alphas.len(), alphas.len(), at));
        let motion = |k: usize| {
            let of = |all: &[Vec<f64>]| {
                let mut sum = vec![0.0; count];
                for (part, own) in small.eigenvectors.column(k).iter().zip(all) {
                    sum.iter_mut().zip(own).for_each(|(s, x)| *s += part * x);
                }
                sum
            };
            Motion {
                square: small.eigenvalues[k],
                velocity: of(&velocities),
                momentum: of(&momenta),
            }
        };
        let by = |a: &usize, b: &usize| small.eigenvalues[*a].total_cmp(&small.eigenvalues[*b]);
        let (least, largest) = ((0..alphas.len()).min_by(by)?, (0..alphas.len()).max_by(by)?);
        Some([motion(least), motion(largest)])
    }
}

fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Which initial value is the momentum of a configuration: that with its name, or the only one.
fn momentum_of(card: &Card, place: &Field) -> Option<usize> {
    let behind = format!("momentum_{}", place.ascii);
    let mut all = card
        .initial
        .iter()
        .enumerate()
        .filter(|(_, f)| is_momentum(f));
    let named = all.clone().find(|(_, f)| f.ascii.ends_with(&behind));
    let (at, _) = named.or_else(|| all.next().filter(|_| card.initial.len() == 2))?;
    Some(at)
}

/// The columns of an initial value among the observables.
fn columns(card: &Card, wanted: &Field) -> Option<Range<usize>> {
    let mut from = 0;
    for field in card.observables {
        let own = from..from + field.count();
        if field.ascii == wanted.ascii {
            return (own.len() == wanted.count()).then_some(own);
        }
        from = own.end;
    }
    None
}

/// Of an angle one; of a field how far its values at all sites lie apart, if they do not the size of its values, at most one.
fn units(moves: &[Moves], initial: &[Vec<f64>]) -> Vec<f64> {
    let fields = moves.iter().filter(|m| m.kind == Kind::FieldMomentum);
    let all = fields.flat_map(|m| initial.get(m.initial).into_iter().flatten());
    let all: Vec<f64> = all.copied().collect();
    let first = all.first().copied().unwrap_or(0.0);
    let apart = largest(all.iter().map(|x| x - first));
    let sizes = [apart, largest(all.iter().copied()).min(1.0), 1.0];
    let unit = sizes.into_iter().find(|x| *x > 0.0).unwrap_or(1.0);
    let each = moves.iter().flat_map(|m| {
        let own = if m.kind == Kind::FieldMomentum {
            unit
        } else {
            1.0
        };
        vec![own; m.count()]
    });
    each.collect()
}

/// Moves a configuration by a small change: added to a field, a turn in the frame of the momentum for an attitude.
fn disturb(value: &mut Vec<f64>, body: &Moves, by: &[f64]) -> Option<()> {
    let turn = || Rotation::exp(&Vector3::new(by[0], by[1], by[2]));
    match body.kind {
        Kind::FieldMomentum => value.iter_mut().zip(by).for_each(|(x, by)| *x += by),
        Kind::Rotation => {
            let own = Matrix3::from_row_slice(value.get(..9)?);
            let turn = turn().matrix();
            let next = if body.spatial { turn * own } else { own * turn };
            *value = next.transpose().as_slice().to_vec();
        }
        _ => {
            let [a, b] = [value.as_slice().try_into().ok()?, turn().quaternion()];
            let next = if body.spatial {
                hamilton(b, a)
            } else {
                hamilton(a, b)
            };
            *value = next.to_vec();
        }
    }
    Some(())
}

/// The small change between two configurations.
fn difference(body: &Moves, a: &[f64], b: &[f64]) -> Vec<f64> {
    match body.kind {
        Kind::FieldMomentum => a.iter().zip(b).map(|(a, b)| b - a).collect(),
        Kind::Rotation => {
            let [a, b] = [a, b].map(Matrix3::from_row_slice);
            let turn = if body.spatial {
                b * a.transpose()
            } else {
                a.transpose() * b
            };
            let half = |i: usize, j: usize| 0.5 * (turn[(i, j)] - turn[(j, i)]);
            vec![half(2, 1), half(0, 2), half(1, 0)]
        }
        _ => {
            let of = |q: &[f64]| [q[0], q[1], q[2], q[3]];
            let (a, b) = (of(a), of(b));
            let back = [a[0], -a[1], -a[2], -a[3]];
            let turn = if body.spatial {
                hamilton(b, back)
            } else {
                hamilton(back, b)
            };
            turn[1..].iter().map(|x| 2.0 * x).collect()
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
