//! Loops over sites that compute several sites at once, with the feature `simd` on the widest instruction set. Results
//! agree bit for bit with the loop over single sites. That loop also handles the remaining sites, and every group in
//! which the fast path fails for some site.

use super::part::{InColumns, LANES};
use super::sweep::{Threads, Two, try_fill_part, try_in_parts, update_part};
use crate::Real;
use crate::integrate::{InstructionSet, Work};
use core::ops::Range;
use nalgebra::SMatrix;

/// Computes the values of several sites at once.
pub trait Stage: Sync {
    /// The value of a site.
    type One;

    /// Computes the values of [`LANES`] sites from `first` on; returns whether all were found. If not, `out` is
    /// meaningless. Mark it and everything it calls `#[inline(always)]`.
    fn lanes<P: InColumns<One = Self::One>>(&self, first: usize, out: &mut P::Lanes) -> bool;
}

/// Computes the values of several sites at once from stored values, and updates the stored values.
pub trait Change: Sync {
    /// The value of a site.
    type One;
    /// The stored value of a site.
    type Kept;

    /// Computes the values of [`LANES`] sites from `first` on; returns whether the stored values are finite. If not,
    /// both are meaningless. Mark it and everything it calls `#[inline(always)]`.
    fn lanes<P: InColumns<One = Self::One>, K: InColumns<One = Self::Kept>>(
        &self,
        first: usize,
        out: &mut P::Lanes,
        kept: &mut K::Lanes,
    ) -> bool;
}

/// A value that can be tested for NaN and infinities.
pub trait Finite {
    /// Whether all numbers of the value are finite.
    fn is_finite(&self) -> bool;
}

impl<T: Real, const R: usize, const C: usize> Finite for SMatrix<T, R, C> {
    #[inline(always)]
    fn is_finite(&self) -> bool {
        // Combines all tests without branches, so that the caller branches once.
        let each = self.as_slice().iter();
        each.fold(true, |all, x| all & x.is_finite())
    }
}

/// `out[i] = value(i)` for every site, several of them together.
#[inline]
pub fn fill_in_lanes<P: InColumns>(
    threads: Threads,
    out: P,
    value: impl Fn(usize) -> P::One + Sync + Copy,
    together: &impl Stage<One = P::One>,
) {
    let value = |i| Ok::<_, core::convert::Infallible>(value(i));
    let Ok(()) = try_fill_in_lanes(threads, out, value, together);
}

/// Like `fill_in_lanes`, for computations that can fail at a site. If one fails, other sites may or may not be filled.
///
/// # Errors
/// The error of the site with the smallest number.
#[inline]
pub fn try_fill_in_lanes<P: InColumns, E: Send>(
    threads: Threads,
    out: P,
    value: impl Fn(usize) -> Result<P::One, E> + Sync + Copy,
    together: &impl Stage<One = P::One>,
) -> Result<(), (usize, E)> {
    try_in_parts(threads, out, |first, part| {
        InstructionSet::Best.run(Filling {
            first,
            part,
            value,
            together,
        })
    })
}

struct Filling<'a, P, F, S> {
    first: usize,
    part: P,
    value: F,
    together: &'a S,
}

impl<P, E, F, S> Work for Filling<'_, P, F, S>
where
    P: InColumns,
    F: Fn(usize) -> Result<P::One, E>,
    S: Stage<One = P::One>,
{
    type Output = Result<(), (usize, E)>;

    #[inline(always)]
    fn done(mut self) -> Self::Output {
        let whole = self.part.count() / LANES * LANES;
        let mut at = 0;
        while at < whole {
            let mut lanes = P::zeros();
            match self.together.lanes::<P>(self.first + at, &mut lanes) {
                true => self.part.write(at, &lanes),
                false => singly(self.first, &mut self.part, at..at + LANES, &self.value)?,
            }
            at += LANES;
        }
        let rest = whole..self.part.count();
        singly(self.first, &mut self.part, rest, &self.value)
    }
}

/// Computes sites one by one. Compiled once, for the instruction set of the build.
#[inline(never)]
fn singly<P: InColumns, E>(
    first: usize,
    out: &mut P,
    sites: Range<usize>,
    value: &impl Fn(usize) -> Result<P::One, E>,
) -> Result<(), (usize, E)> {
    try_fill_part(first, out, sites, value)
}

/// `(out[i], kept[i]) = change(i, kept[i])` for every site, several of them together.
///
/// # Errors
/// The first site for which `change` returns `None`; the stored values are then meaningless.
#[inline]
pub fn update_in_lanes<P: InColumns, K: InColumns>(
    threads: Threads,
    out: P,
    kept: K,
    change: impl Fn(usize, K::One) -> Option<(P::One, K::One)> + Sync + Copy,
    together: &impl Change<One = P::One, Kept = K::One>,
) -> Result<(), usize> {
    let parts = Two(out, kept);
    let made = try_in_parts(threads, parts, |first, Two(out, kept)| {
        InstructionSet::Best.run(Changing {
            first,
            out,
            kept,
            change,
            together,
        })
    });
    made.map_err(|(site, ())| site)
}

struct Changing<'a, P, K, F, S> {
    first: usize,
    out: P,
    kept: K,
    change: F,
    together: &'a S,
}

impl<P, K, F, S> Work for Changing<'_, P, K, F, S>
where
    P: InColumns,
    K: InColumns,
    F: Fn(usize, K::One) -> Option<(P::One, K::One)>,
    S: Change<One = P::One, Kept = K::One>,
{
    type Output = Result<(), (usize, ())>;

    #[inline(always)]
    fn done(mut self) -> Self::Output {
        let whole = self.out.count() / LANES * LANES;
        let mut at = 0;
        while at < whole {
            let (mut lanes, mut kept) = (P::zeros(), self.kept.read(at));
            let first = self.first + at;
            match self.together.lanes::<P, K>(first, &mut lanes, &mut kept) {
                true => {
                    self.out.write(at, &lanes);
                    self.kept.write(at, &kept);
                }
                false => {
                    let (out, kept) = (&mut self.out, &mut self.kept);
                    changed_singly(self.first, out, kept, at..at + LANES, &self.change)?;
                }
            }
            at += LANES;
        }
        let (rest, out, kept) = (whole..self.out.count(), &mut self.out, &mut self.kept);
        changed_singly(self.first, out, kept, rest, &self.change)
    }
}

/// Computes sites one by one. Compiled once, for the instruction set of the build.
#[inline(never)]
fn changed_singly<P: InColumns, K: InColumns>(
    first: usize,
    out: &mut P,
    kept: &mut K,
    sites: Range<usize>,
    change: &impl Fn(usize, K::One) -> Option<(P::One, K::One)>,
) -> Result<(), (usize, ())> {
    update_part(first, out, kept, sites, change)
}

/// Defines a [`Stage`] or a [`Change`]: its inputs, the lists it reads with the number of sites ahead, and the value of
/// one site.
#[doc(hidden)]
#[macro_export]
macro_rules! in_lanes {
    (
        $(#[$about:meta])*
        $name:ident($($read:ident: $of:ty),*) -> $one:ty
        { $($seen:ident: $on:tt = $list:expr),* }
        |$site:ident| $body:expr
    ) => {
        $crate::in_lanes! { @read $(#[$about])* $name $($read: $of),* }
        impl<T: $crate::Real> $crate::line::Stage for $name<'_, T> {
            type One = $one;

            #[inline(always)]
            fn lanes<P: $crate::line::InColumns<One = $one>>(&self, first: usize, out: &mut P::Lanes) -> bool {
                let Self { $($read,)* first: before } = *self;
                let first = first + before;
                $(let $seen = $crate::line::Windowed::<{ $crate::line::LANES + $on }>::window(&$list, first);)*
                let mut all = true;
                for lane in 0..$crate::line::LANES {
                    let $site = first + lane;
                    let (made, found): ($one, bool) = $body;
                    all &= found;
                    P::put_lane(out, lane, made);
                }
                all
            }
        }
    };
    (
        $(#[$about:meta])*
        $name:ident($($read:ident: $of:ty),*) -> $one:ty, $kept:ty
        { $($seen:ident: $on:tt = $list:expr),* }
        |$site:ident, $edge:ident| $body:expr
    ) => {
        $crate::in_lanes! { @read $(#[$about])* $name $($read: $of),* }
        impl<T: $crate::Real> $crate::line::Change for $name<'_, T> {
            type One = $one;
            type Kept = $kept;

            #[inline(always)]
            fn lanes<P: $crate::line::InColumns<One = $one>, K: $crate::line::InColumns<One = $kept>>(
                &self, first: usize, out: &mut P::Lanes, kept: &mut K::Lanes,
            ) -> bool {
                let Self { $($read,)* first: before } = *self;
                let first = first + before;
                $(let $seen = $crate::line::Windowed::<{ $crate::line::LANES + $on }>::window(&$list, first);)*
                let mut all = true;
                for lane in 0..$crate::line::LANES {
                    let ($site, $edge) = (first + lane, K::lane(kept, lane));
                    let (value, after): ($one, $kept) = $body;
                    all &= $crate::line::Finite::is_finite(&after);
                    P::put_lane(out, lane, value);
                    K::put_lane(kept, lane, after);
                }
                all
            }
        }
    };
    (@read $(#[$about:meta])* $name:ident $($read:ident: $of:ty),*) => {
        $(#[$about])*
        struct $name<'a, T: $crate::Real> {
            $($read: &'a $of,)*
            /// The first site of the part.
            first: usize,
        }
    };
}

#[cfg(test)]
mod tests {
    use super::{fill_in_lanes, try_fill_in_lanes, update_in_lanes};
    use crate::Rotation;
    use crate::line::{Attitude, Attitudes, Edges, Threads, Turning, fill, try_fill, update};
    use crate::solvers::moser_veselov::{Edge, Poinsot};
    use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};

    /// A factor, and a list read at a site and at the next one.
    struct Row<T> {
        list: Vec<SMatrix<T, 2, 1>>,
        factor: T,
    }

    crate::in_lanes! {
        /// Differences.
        Differences(row: Row<T>) -> SMatrix<T, 2, 1>
        { at: 1 = row.list }
        |site| ((at.ahead::<1>(site) - at.at(site)) * row.factor, true)
    }

    crate::in_lanes! {
        /// The sum of a stored value and a difference.
        Shifted(row: Row<T>) -> SMatrix<T, 2, 1>, SMatrix<T, 2, 1>
        { at: 1 = row.list }
        |site, kept| (kept + at.at(site), kept + at.ahead::<1>(site) * row.factor)
    }

    const COUNTS: [usize; 8] = [0, 1, 15, 16, 17, 31, 100, 5000];

    fn row(count: usize) -> Row<f64> {
        let list =
            (0..count + 4).map(|i| Vector2::new((0.3 * i as f64).sin(), 1.0 / (i + 1) as f64));
        Row {
            list: list.collect(),
            factor: 0.7,
        }
    }

    #[test]
    fn several_sites_together_get_what_each_gets() {
        for count in COUNTS {
            let row = row(count);
            let value = |i: usize| (row.list[2 + i + 1] - row.list[2 + i]) * row.factor;
            let mut one = vec![Vector2::zeros(); count];
            fill(Threads::ONE, &mut one[..], value);
            for threads in [1, 2, 3] {
                let mut other = vec![Vector2::zeros(); count];
                let together = Differences {
                    row: &row,
                    first: 2,
                };
                fill_in_lanes(Threads(threads), &mut other[..], value, &together);
                assert_eq!(one, other, "{count} sites, {threads} threads");
            }
        }
    }

    #[test]
    fn what_is_kept_changes_alike_and_the_first_site_that_is_not_finite_is_named() {
        for count in COUNTS {
            for bad in [None, Some(0), Some(20), Some(count.saturating_sub(1))] {
                let mut row = row(count);
                if let Some(bad) = bad.filter(|b| *b < count) {
                    row.list[bad + 1] = Vector2::new(f64::INFINITY, 0.0);
                    row.list[count + 1].x = f64::NAN;
                }
                let change = |i: usize, kept: Vector2<f64>| {
                    let after = kept + row.list[i + 1] * row.factor;
                    let finite = after.iter().all(|x| x.is_finite());
                    finite.then_some((kept + row.list[i], after))
                };
                let blank = || {
                    (
                        vec![Vector2::zeros(); count],
                        vec![Vector2::new(0.1, 3.0); count],
                    )
                };
                let (mut one, mut other) = (blank(), blank());
                let made = update(Threads::ONE, &mut one.0[..], &mut one.1[..], change);
                let together = Shifted {
                    row: &row,
                    first: 0,
                };
                let (out, kept) = (&mut other.0[..], &mut other.1[..]);
                let same = update_in_lanes(Threads(2), out, kept, change, &together);
                assert_eq!(made, same, "{count} sites, {bad:?}");
                if made.is_ok() {
                    assert_eq!(one, other, "{count} sites");
                }
            }
        }
    }

    /// Tests groups with zero, one or several bodies that need more than one iteration or are unsolvable.
    #[test]
    fn bodies_turn_together_as_each_does() {
        let full = Matrix3::new(0.5, 0.1, 0.0, 0.1, 0.7, 0.05, 0.0, 0.05, 1.5);
        let h = 0.1;
        for j in [Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)), full] {
            let body = Poinsot::new(j).expect("a body");
            // With moments of inertia about 1, momenta up to 10 have a solution; near 10 it takes many iterations.
            for (count, hard) in [(40, 0.0), (40, 3.0), (40, 9.0), (5000, 9.0), (40, 40.0)] {
                let momentum = |i: usize| {
                    let size = if i % 17 == 9 { hard } else { 0.5 };
                    Vector3::new((0.3 * i as f64).sin(), (0.2 * i as f64).cos(), 0.3).normalize()
                        * size
                };
                let at: Attitudes<f64> = (0..count)
                    .map(|i| Attitude::new(Rotation::exp(&Vector3::new(0.1 * i as f64, 0.6, 0.0))))
                    .collect();
                let edges: Edges<f64> = (0..count).map(momentum).collect();
                let turned = |i: usize| {
                    let attitude = at.at(i).rotation();
                    let made = Edge::of_space(edges.at(i), &attitude).turn(&body, h, &attitude);
                    made.map(|t| Attitude::turned(&t)).map_err(|_| ())
                };
                let (mut one, mut other) = (at.clone(), at.clone());
                let made = try_fill(Threads::ONE, one.part(0..count), turned);
                let together = Turning {
                    at: &at,
                    edges: &edges,
                    bodies: &[body],
                    h,
                    first: 0,
                };
                let same = try_fill_in_lanes(Threads(2), other.part(0..count), turned, &together);
                assert_eq!(made, same, "{hard}");
                assert_eq!(made.is_err(), hard > 30.0, "{hard}: {made:?}");
                if made.is_ok() {
                    assert_eq!(one, other, "{hard}");
                }
            }
        }
    }
}
