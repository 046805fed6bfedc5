//! Functionals of all sites: the runtime's functionals behind one interface. Takes the name of a functional in a model,
//! its setting and its constants. Gives values and pull-backs over lists of sites.

use crate::sites::Column;
use crate::value::Value;
use clebsch::mesh::{self, Domain, Functional, MeshError, Setting};
use clebsch::saved::{Saved, Words};
use clebsch::{ParameterError, Real};
use core::any::Any;
use core::fmt;
use nalgebra::SVector;

/// A domain of one or two dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// An interval, or a circle.
    Line(Domain<1>),
    /// A rectangle.
    Plane(Domain<2>),
}

/// The setting that a functional is built for.
#[derive(Clone, Debug, PartialEq)]
pub enum FunctionalSetting {
    /// On an interval.
    Line(Setting<1>),
    /// On a rectangle.
    Plane(Setting<2>),
}

impl FunctionalSetting {
    /// A domain, with a grid if there is one, and the number of particles.
    pub fn new(extent: Extent, grid: Option<&[usize]>, particles: usize) -> Option<Self> {
        Some(match extent {
            Extent::Line(domain) => FunctionalSetting::Line(Setting {
                domain,
                grid: grid.map(<[usize; 1]>::try_from).transpose().ok()?,
                particles,
            }),
            Extent::Plane(domain) => FunctionalSetting::Plane(Setting {
                domain,
                grid: grid.map(<[usize; 2]>::try_from).transpose().ok()?,
                particles,
            }),
        })
    }

    /// The number of nodes of the grid.
    pub fn nodes(&self) -> usize {
        match self {
            FunctionalSetting::Line(setting) => setting.nodes(),
            FunctionalSetting::Plane(setting) => setting.nodes(),
        }
    }

    /// Lengths of a cell along each direction.
    pub fn cell(&self) -> Vec<f64> {
        match self {
            FunctionalSetting::Line(setting) => setting.cell().to_vec(),
            FunctionalSetting::Plane(setting) => setting.cell().to_vec(),
        }
    }
}

/// The argument of a functional at one site.
trait Element<T: Real>: Copy + Send + Sync + 'static {
    const ZERO: fn() -> Self;

    /// Reads a list of sites into `out`. Returns nothing if the list has another type.
    fn read(list: &Column<T>, out: &mut Vec<Self>) -> Option<()>;

    /// A list of sites.
    fn written(list: &[Self]) -> Column<T>;
}

impl<T: Real> Element<T> for T {
    const ZERO: fn() -> Self = T::zero;

    fn read(list: &Column<T>, out: &mut Vec<Self>) -> Option<()> {
        let (Column::Numbers(all) | Column::Arrays([1, 1], all)) = list else {
            return None;
        };
        out.clear();
        out.extend_from_slice(all);
        Some(())
    }

    fn written(list: &[Self]) -> Column<T> {
        Column::Numbers(list.to_vec())
    }
}

impl<T: Real> Element<T> for SVector<T, 2> {
    const ZERO: fn() -> Self = SVector::zeros;

    fn read(list: &Column<T>, out: &mut Vec<Self>) -> Option<()> {
        let Column::Arrays([2, 1], all) = list else {
            return None;
        };
        out.clear();
        out.extend(all.chunks_exact(2).map(SVector::from_column_slice));
        Some(())
    }

    fn written(list: &[Self]) -> Column<T> {
        let all = list.iter().flat_map(|x| x.iter().copied());
        Column::Arrays([2, 1], all.collect())
    }
}

/// A functional with an argument of any type.
trait Computes<T: Real>: Send + Sync {
    fn copied(&self) -> Box<dyn Computes<T>>;
    fn value(&mut self, at: &Column<T>, out: &mut [T]) -> Option<Result<(), MeshError>>;
    fn pull_back(&mut self, at: &Column<T>, seed: &[T]) -> Option<Result<Column<T>, MeshError>>;
    fn words(&mut self, words: &mut Words);
}

/// A functional with buffers for its arguments.
#[derive(Clone)]
struct With<F, A> {
    functional: F,
    at: Vec<A>,
    back: Vec<A>,
}

/// A functional for one dimension, which its type does not determine.
#[derive(Clone)]
struct In<F, A, const D: usize>(With<F, A>);

impl<T, F, A, const D: usize> Computes<T> for In<F, A, D>
where
    T: Real,
    A: Element<T>,
    F: Functional<T, D, Argument = A> + 'static,
{
    fn copied(&self) -> Box<dyn Computes<T>> {
        Box::new(self.clone())
    }

    fn value(&mut self, at: &Column<T>, out: &mut [T]) -> Option<Result<(), MeshError>> {
        let own = &mut self.0;
        A::read(at, &mut own.at)?;
        Some(own.functional.value(&own.at, out))
    }

    fn pull_back(&mut self, at: &Column<T>, seed: &[T]) -> Option<Result<Column<T>, MeshError>> {
        let own = &mut self.0;
        A::read(at, &mut own.at)?;
        own.back.clear();
        own.back.resize(own.at.len(), A::ZERO());
        let done = own.functional.pull_back(&own.at, seed, &mut own.back);
        Some(done.map(|()| A::written(&own.back)))
    }

    fn words(&mut self, words: &mut Words) {
        let own: &mut dyn Any = &mut self.0.functional;
        // Functionals on grids keep no data that affect later values.
        if let Some(f) = own.downcast_mut::<mesh::voronoi_area<f64>>() {
            f.words(words);
        } else if let Some(f) = own.downcast_mut::<mesh::second_moment<f64>>() {
            f.words(words);
        } else if let Some(f) = own.downcast_mut::<mesh::helmholtz_depth<f64>>() {
            f.words(words);
        } else if let Some(f) = own.downcast_mut::<mesh::helmholtz_twice<f64>>() {
            f.words(words);
        } else if let Some(f) = own.downcast_mut::<mesh::kernel_depth<f64>>() {
            f.words(words);
        } else if let Some(f) = own.downcast_mut::<mesh::pair_core<f64>>() {
            f.words(words);
        }
    }
}

/// A functional of any type.
pub struct AnyFunctional<T: Real>(Box<dyn Computes<T>>);

impl<T: Real> Clone for AnyFunctional<T> {
    fn clone(&self) -> Self {
        AnyFunctional(self.0.copied())
    }
}

impl<T: Real> fmt::Debug for AnyFunctional<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyFunctional").finish_non_exhaustive()
    }
}

impl<T: Real> AnyFunctional<T> {
    /// Its values at positions, or at the values of another functional.
    pub fn value(&mut self, at: &Column<T>, out: &mut [T]) -> Option<Result<(), MeshError>> {
        self.0.value(at, out)
    }

    /// Its pull-back of a seed.
    pub fn pull_back(
        &mut self,
        at: &Column<T>,
        seed: &[T],
    ) -> Option<Result<Column<T>, MeshError>> {
        self.0.pull_back(at, seed)
    }
}

impl Saved for AnyFunctional<f64> {
    fn words(&mut self, words: &mut Words) {
        self.0.words(words);
    }
}

type NewFunctional<T> = Option<Result<AnyFunctional<T>, ParameterError>>;

fn held<T, F, A, const D: usize>(setting: &Setting<D>, data: F::Data<'_>) -> NewFunctional<T>
where
    T: Real,
    A: Element<T>,
    F: Functional<T, D, Argument = A> + 'static,
{
    let made = F::new(setting, data).map(|functional| {
        let (at, back) = (Vec::new(), Vec::new());
        let with = With {
            functional,
            at,
            back,
        };
        AnyFunctional(Box::new(In::<F, A, D>(with)) as Box<dyn Computes<T>>)
    });
    Some(made)
}

/// The functional of this name. Returns nothing if the name is unknown or the functional takes other constants.
pub fn made<T: Real>(
    name: &str,
    around: &FunctionalSetting,
    data: &[Value<T>],
) -> NewFunctional<T> {
    use FunctionalSetting::{Line, Plane};
    let numbers = |value: &Value<T>| match value {
        Value::Sites(Column::Numbers(list)) => Some(list.clone()),
        _ => None,
    };
    let one = |value: &Value<T>| match value {
        Value::Real(x) => Some(*x),
        _ => None,
    };
    match (name, around, data) {
        ("voronoi_area", Plane(s), []) => held::<T, mesh::voronoi_area<T>, _, 2>(s, ()),
        ("second_moment", Plane(s), []) => held::<T, mesh::second_moment<T>, _, 2>(s, ()),
        ("helmholtz_depth", Plane(s), [m, alpha]) => {
            held::<T, mesh::helmholtz_depth<T>, _, 2>(s, (&numbers(m)?, one(alpha)?))
        }
        ("helmholtz_twice", Plane(s), [m, alpha]) => {
            held::<T, mesh::helmholtz_twice<T>, _, 2>(s, (&numbers(m)?, one(alpha)?))
        }
        ("kernel_depth", Plane(s), [m, alpha]) => {
            held::<T, mesh::kernel_depth<T>, _, 2>(s, (&numbers(m)?, one(alpha)?))
        }
        ("pair_core", Plane(s), [m, radius, strength]) => {
            let data = (&numbers(m)?[..], one(radius)?, one(strength)?);
            held::<T, mesh::pair_core<T>, _, 2>(s, data)
        }
        ("deposit", Line(s), [m]) => held::<T, mesh::deposit<T, 1>, _, 1>(s, (&numbers(m)?,)),
        ("deposit", Plane(s), [m]) => held::<T, mesh::deposit<T, 2>, _, 2>(s, (&numbers(m)?,)),
        ("deposit_quintic", Line(s), [m]) => {
            held::<T, mesh::deposit_quintic<T, 1>, _, 1>(s, (&numbers(m)?,))
        }
        ("deposit_quintic", Plane(s), [m]) => {
            held::<T, mesh::deposit_quintic<T, 2>, _, 2>(s, (&numbers(m)?,))
        }
        ("smooth", Line(s), [length]) => held::<T, mesh::smooth<T, 1>, _, 1>(s, (one(length)?,)),
        ("smooth", Plane(s), [length]) => held::<T, mesh::smooth<T, 2>, _, 2>(s, (one(length)?,)),
        ("smooth_isotropic", Plane(s), [length]) => {
            held::<T, mesh::smooth_isotropic<T, 2>, _, 2>(s, (one(length)?,))
        }
        _ => None,
    }
}
