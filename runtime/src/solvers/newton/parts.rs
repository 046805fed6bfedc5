//! Groups the coordinates of a velocity into parts, each measured by its own length, because angles and translations
//! cannot be added. Takes coordinates and a tangent; gives lengths, the units of parts, and the lengths that a stage
//! counts (its course).

use super::checked_points::{Remainders, looks, shared_noise};
use super::principal::FALLS;
use crate::groups::Group;
use crate::linalg::Reals;
use crate::scalar::{Real, larger};
use nalgebra::SVector;

/// If nothing rotates, angles of this size set the scale.
const LITTLE: f64 = 1e-6;

/// The largest length of pure numbers that counts in a course: a quarter turn, or three times a length.
const TURN: f64 = 2.0;

/// A step that rotates by more than this, 74 degrees, is not judged by one correction. Among 400,000 random problems, 3
/// had another root that close, all of them beyond 90 degrees.
const STEP_TURN: f64 = 1.5;

/// In a step judged by one correction, the largest translation of a body that counts, in its units. Relative to a
/// longer displacement, any error would be small.
const STEP_WAY: f64 = 2.0;

/// A part that moves little is measured by this fraction of the part that moves most.
const ASIDE: f64 = 0.05;

/// Like `ASIDE`, in a step judged by one correction, for a part without a natural scale. Its equations may vary even
/// over a short length.
const OPEN_ASIDE: f64 = 1e-3;

/// The kind of test that selects the fraction by which slow parts are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlowPartTest {
    /// A step judged by one correction.
    OfStep,
    /// A stage, which also checks the tangent of all parts.
    OfStage,
}

impl SlowPartTest {
    /// The fraction for a part; `open` if the part lacks a natural scale.
    pub(super) fn of(self, open: bool) -> f64 {
        match self {
            Self::OfStep if open => OPEN_ASIDE,
            _ => ASIDE,
        }
    }
}

/// The square of the length of each part of a velocity, in every lane: see [`Group::compared`].
#[inline(always)]
pub(super) fn squares<T: Real, G: Group<T>, const D: usize>(velocity: &G) -> [T; D] {
    let mut both = [[T::zero(); 2]; D];
    velocity.compared(&[], &mut both);
    both.map(|[square, _]| square)
}

/// For each part, the square of its displacement and the square of the distance that a correction leaves.
pub(super) type Squares = smallvec::SmallVec<[[f64; 2]; 12]>;

/// The coordinates of a velocity and the parts that they belong to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The part of each coordinate.
    pub of: Vec<usize>,
    /// For each part, whether its coordinates are dimensionless.
    pub pure: Vec<bool>,
    /// For each part, whether its coordinates lack a natural scale.
    pub open: Vec<bool>,
}

impl Parts {
    /// The parts of a group; each part has at most `most` coordinates.
    pub(super) fn of_group<T, G: Group<T>>(most: usize) -> Self {
        Self {
            of: (0..G::DIMENSION.min(most)).map(G::part_of).collect(),
            pure: (0..G::PARTS).map(G::is_pure).collect(),
            open: (0..G::PARTS).map(G::is_open).collect(),
        }
    }

    /// The number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.of.len()
    }

    /// The number of parts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pure.len()
    }

    /// The part of a coordinate.
    #[must_use]
    pub fn part_of(&self, coordinate: usize) -> usize {
        self.of.get(coordinate).copied().unwrap_or(0)
    }

    /// The lengths of the parts.
    pub(super) fn lengths(&self, x: &[f64]) -> Reals {
        let mut squares = Reals::from_elem(0.0, self.count());
        for (part, x) in self.of.iter().zip(x) {
            if let Some(square) = squares.get_mut(*part) {
                *square += x * x;
            }
        }
        squares.iter().map(|x| x.sqrt()).collect()
    }

    /// The unit of length of each part: see [`Kinds::units_into`].
    pub(super) fn units(&self, entry: &dyn Fn(usize, usize) -> f64, aside: SlowPartTest) -> Reals {
        let mut units = Reals::from_elem(1.0, self.count());
        self.kinds().units_into(entry, aside, &mut units);
        units
    }

    /// A view of these parts that does not allocate.
    pub(super) fn kinds(&self) -> Kinds<'_> {
        Kinds {
            size: self.dimension(),
            part_of: &self.of,
            pure: &self.pure,
            open: &self.open,
        }
    }

    /// The reference lengths for later corrections of each part: the length of the first correction, or a small
    /// fraction of the part that moves most if that is larger.
    pub(super) fn course(
        &self,
        lengths: &[f64],
        units: &[f64],
        noise: impl Fn(usize) -> f64,
    ) -> Reals {
        let mut course = Reals::from_elem(0.0, self.count());
        let kinds = self.kinds();
        course_into(
            &kinds,
            SlowPartTest::OfStage,
            [lengths, units],
            noise,
            &mut course,
        );
        course
    }

    /// Whether one correction suffices to judge a step, given for each part the squares of its displacement and of the
    /// distance left; see [`is_near`].
    pub(super) fn are_near(
        &self,
        squares: &[[f64; 2]],
        units: &[f64],
        noise: &dyn Fn(usize) -> f64,
    ) -> bool {
        let mut lists = [
            Reals::from_elem(0.0, self.count()),
            Reals::from_elem(0.0, self.count()),
        ];
        let [ways, course] = &mut lists;
        are_near_beside(squares, units, &self.kinds(), noise, [ways, course])
    }

    /// The index of the coordinate that moves most.
    pub(super) fn fastest(&self, x: &[f64], units: &[f64]) -> usize {
        let size = |k: usize| x.get(k).copied().unwrap_or(0.0).abs();
        let share = |k: usize| size(k) / units.get(self.part_of(k)).copied().unwrap_or(1.0);
        (0..self.dimension())
            .max_by(|i, j| share(*i).total_cmp(&share(*j)))
            .unwrap_or(0)
    }
}

/// Coordinates and parts, borrowed from other lists.
pub(super) struct Kinds<'a> {
    /// The number of coordinates.
    pub size: usize,
    /// The part of each coordinate.
    pub part_of: &'a [usize],
    /// For each part, whether its coordinates are dimensionless.
    pub pure: &'a [bool],
    /// For each part, whether its coordinates lack a natural scale.
    pub open: &'a [bool],
}

impl Kinds<'_> {
    /// The coordinates of a part.
    pub(super) fn own(&self, part: usize) -> impl Iterator<Item = usize> {
        let own = self.part_of.iter().take(self.size).enumerate();
        own.filter(move |(_, p)| **p == part).map(|(k, _)| k)
    }

    /// The largest diagonal entry of the tangent in a part.
    fn block(&self, part: usize, entry: &dyn Fn(usize, usize) -> f64) -> f64 {
        self.own(part)
            .fold(0.0, |most, k| most.max(entry(k, k).abs()))
    }

    /// Whether a part that is not a multiplier lacks a natural scale. `entry` gives the entries of the tangent.
    pub(super) fn are_open(&self, entry: &dyn Fn(usize, usize) -> f64) -> bool {
        let mut open = self.open.iter().enumerate();
        open.any(|(b, open)| *open && self.block(b, entry) != 0.0)
    }

    /// The unit of length of each part: 1 for pure numbers; for translations the radius at which they weigh as much as the
    /// angles of the same element. A part that its own equations do not contain is a multiplier, which may jump, unlike
    /// a velocity. Its unit is the value that acts in the other equations as one unit of their parts, multiplied so
    /// that the multiplier is compared with the whole part that moves most. `entry` is the tangent.
    pub(super) fn units_into(
        &self,
        entry: &dyn Fn(usize, usize) -> f64,
        aside: SlowPartTest,
        units: &mut [f64],
    ) {
        for (b, own) in units.iter_mut().enumerate() {
            let unit = (self.block(b.saturating_sub(1), entry) / self.block(b, entry)).sqrt();
            *own = match self.pure[b] {
                true => 1.0,
                false if unit.is_finite() => unit,
                false => 0.0,
            };
        }
        for b in 0..units.len() {
            if self.pure[b] || self.block(b, entry) != 0.0 {
                continue;
            }
            let mut unit = f64::INFINITY;
            for column in self.own(b) {
                for (k, part) in self.part_of.iter().take(self.size).enumerate() {
                    let like = entry(k, k).abs() * units[*part] / entry(k, column).abs();
                    if like > 0.0 && like < unit {
                        unit = like;
                    }
                }
            }
            let aside = aside.of(self.open[b]);
            units[b] = if unit.is_finite() { unit / aside } else { 0.0 };
        }
    }
}

/// Calls a function with the coordinates and parts of a group of at most `D` coordinates.
pub(super) fn with_kinds<T, G: Group<T>, R, const D: usize>(
    ask: impl FnOnce(&Kinds<'_>) -> R,
) -> R {
    let count = G::PARTS.min(D);
    ask(&Kinds {
        size: G::DIMENSION.min(D),
        part_of: &core::array::from_fn::<_, D, _>(G::part_of),
        pure: &core::array::from_fn::<_, D, _>(|b| b < count && G::is_pure(b))[..count],
        open: &core::array::from_fn::<_, D, _>(|b| b < count && G::is_open(b))[..count],
    })
}

/// Writes the course of [`Parts::course`] into `course`, which has one entry for each part.
fn course_into(
    Kinds { pure, open, .. }: &Kinds<'_>,
    aside: SlowPartTest,
    [lengths, units]: [&[f64]; 2],
    noise: impl Fn(usize) -> f64,
    course: &mut [f64],
) {
    let mut most = 0.0;
    for (b, pure) in pure.iter().enumerate().take(course.len()) {
        let share = lengths[b] / units[b];
        let share = if *pure { share.max(LITTLE) } else { share };
        if share.is_finite() {
            most = larger(most, share);
        }
    }
    // In one step a body may move many times its own size without rotating.
    let turns = pure.iter().take(course.len()).any(|pure| *pure);
    let most = if turns { most.min(1.0) } else { most };
    for (b, own) in course.iter_mut().enumerate() {
        let aside = aside.of(open[b]) * most;
        let (length, least) = match pure[b] {
            // Coordinates of rotations grow without bound near half a turn.
            true if lengths[b] > TURN => (TURN, aside * units[b]),
            true => (lengths[b], aside * units[b]),
            false => (lengths[b], larger(aside * units[b], noise(b))),
        };
        // NaN is preserved.
        *own = if length < least { least } else { length };
    }
}

/// The test of [`Parts::are_near`], with given work lists.
fn are_near_beside(
    squares: &[[f64; 2]],
    units: &[f64],
    kinds: &Kinds<'_>,
    noise: impl Fn(usize) -> f64,
    [ways, course]: [&mut [f64]; 2],
) -> bool {
    for (way, [square, _]) in ways.iter_mut().zip(squares) {
        *way = square.sqrt();
    }
    course_into(kinds, SlowPartTest::OfStep, [ways, units], noise, course);
    let pure = kinds.pure;
    let mut each = squares.iter().zip(course.iter()).enumerate();
    each.all(|(b, ([way, off], course))| {
        let most = most_of_step(b, units, |b| pure[b]);
        let far = pure[b] && *way > most * most;
        !far && is_near([course * course, *off], most, false)
    })
}

/// The largest displacement of a part that counts in a step judged by one correction.
#[inline(always)]
fn most_of_step(part: usize, units: &[f64], pure: impl Fn(usize) -> bool) -> f64 {
    match (pure(part), part > 0 && pure(part - 1)) {
        (true, _) => STEP_TURN,
        (false, true) => STEP_WAY * units.get(part).copied().unwrap_or(0.0),
        (false, false) => f64::INFINITY,
    }
}

/// Whether a correction leaves at most a quarter of the displacement of a part, both given as squares. If the part
/// rotates by more than `most`, the result is false.
#[inline(always)]
fn is_near([way, off]: [f64; 2], most: f64, turns: bool) -> bool {
    let most = most * most;
    let counted = if way > most { most } else { way };
    // The comparison is false for NaN.
    off <= FALLS * FALLS * counted && !(turns && way > most)
}

/// Whether the negative of `correction`, applied at rest, comes within a quarter of the displacement of the solution.
#[inline(always)]
pub(super) fn comes_near<T: Real, G: Group<T>, const D: usize>(
    correction: &SVector<T, D>,
    solution: &G,
    units: &[f64; D],
    noise: &[f64; D],
) -> bool {
    let mut squares = [[T::zero(); 2]; D];
    solution.compared((-correction).as_slice(), &mut squares);
    are_near::<T, G, D>(&squares, units, noise)
}

/// The distance of the solution relative to the length of the correction: the maximum over the parts without a natural
/// scale, at least 1.
fn reach<T: Real, G: Group<T>, const D: usize>(correction: &SVector<T, D>, solution: &G) -> f64 {
    let ways = squares::<T, G, D>(solution);
    let mut corrected = [0.0; D];
    for k in 0..G::DIMENSION.min(D) {
        if let Some(square) = corrected.get_mut(G::part_of(k)) {
            *square += (correction[k] * correction[k]).greatest();
        }
    }
    let open = (0..G::PARTS.min(D)).filter(|b| G::is_open(*b));
    let shares = open.map(|b| ways[b].greatest().sqrt() / corrected[b].sqrt());
    shares.filter(|x| x.is_finite()).fold(1.0, larger)
}

/// Whether the equations vary little on the path from rest along the negative of `correction` and on to the solution.
/// `left` evaluates them at a point of the path and returns the remainder as a correction with the current tangent.
#[inline(never)]
pub(super) fn varies_little<T: Real, G: Group<T>, const D: usize>(
    correction: &SVector<T, D>,
    solution: &G,
    left: impl Fn(f64, &G) -> Option<SVector<T, D>>,
    units: &[f64; D],
    noise: &[f64; D],
) -> bool {
    let size = G::DIMENSION.min(D);
    let near = |off: &SVector<T, D>, noise: &[f64; D]| {
        let mut squares = [[T::zero(); 2]; D];
        for k in 0..size {
            if let Some([way, left]) = squares.get_mut(G::part_of(k)) {
                *way += correction[k] * correction[k];
                *left += off[k] * off[k];
            }
        }
        are_near::<T, G, D>(&squares, units, noise)
    };
    let shared = shared_noise(&noise[..G::PARTS.min(D)], units);
    let noises: [f64; D] = core::array::from_fn(|b| larger(noise[b], shared * units[b]));
    // If the rounding error is unknown, differences may be only rounding.
    let known = shared > 0.0;
    let mut so_far = Remainders::nothing(SVector::zeros());
    looks(reach::<T, G, D>(correction, solution)).all(|look| {
        let at = G::identity().retract((-*correction * T::from_f64(look.share)).as_slice());
        let Some(off) = left(look.share, &at) else {
            return false;
        };
        let judged = so_far.next(look, &off, |x, y| x - y);
        let mut judged = judged.iter().flatten();
        near(&off, noise)
            && (!known
                || judged.all(|x| {
                    let difference = x.difference * T::from_f64(x.factor);
                    near(&difference, &noises.map(|own| x.noise(own)))
                }))
    })
}

/// Whether the second square of each pair is small enough compared with the first, in every part and lane.
#[inline(always)]
fn are_near<T: Real, G: Group<T>, const D: usize>(
    squares: &[[T; 2]; D],
    units: &[f64; D],
    noise: &[f64; D],
) -> bool {
    let parts = G::PARTS.min(D);
    let mut near = true;
    for lane in 0..T::LANES {
        for (b, [way, off]) in squares.iter().enumerate().take(parts) {
            let most = most_of_step(b, units, G::is_pure);
            near &= is_near([way.lane(lane), off.lane(lane)], most, G::is_pure(b));
        }
    }
    near || near_beside::<T, G, D>(squares, units, noise)
}

/// Like `are_near`, for parts that move little compared with others, or only at rounding level.
#[cold]
#[inline(never)]
fn near_beside<T: Real, G: Group<T>, const D: usize>(
    squares: &[[T; 2]; D],
    units: &[f64; D],
    noise: &[f64; D],
) -> bool {
    let count = G::PARTS.min(D);
    let of = |lane: usize| {
        let own: [[f64; 2]; D] = core::array::from_fn(|b| squares[b].map(|x| x.lane(lane)));
        let (mut ways, mut course) = ([0.0; D], [0.0; D]);
        let lists = [&mut ways[..count], &mut course[..count]];
        with_kinds::<T, G, _, D>(|kinds| {
            let (own, units) = (&own[..count], &units[..count]);
            are_near_beside(own, units, kinds, |b| noise[b], lists)
        })
    };
    (0..T::LANES).all(of)
}
