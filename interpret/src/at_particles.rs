//! Evaluates functionals of all sites at the particles of a fluid before a run starts. Takes the positions of the
//! particles and the data of the case. Gives the value at each particle. If a functional lives on a grid, the splines
//! of its deposit interpolate it and give its slopes.

use crate::functional::{AnyFunctional, FunctionalSetting, made};
use crate::lines::{Numbers, extent};
use crate::sites::Column;
use crate::value::Value;
use clebsch::ParameterError;
use clebsch::mesh::{self, Functional, MeshError, Nodes, Setting, deposit, deposit_quintic};
use clebsch_core::lattice::{FunctionalKind, Lattice, Mesh, Source};
use core::fmt;
use nalgebra::SVector;

/// Where the particles of a fluid are.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// Lengths of the domain along each of one or two directions.
    pub lengths: &'a [f64],
    /// Whether each of them ends in walls.
    pub walls: &'a [bool],
    /// The number of grid cells along each direction, if there is a grid.
    pub cells: Option<&'a [usize]>,
    /// Coordinates of one particle after the other.
    pub at: &'a [f64],
}

/// A functional at the particles.
#[derive(Clone, Debug, PartialEq)]
pub struct AtParticles {
    /// The value at each particle. If the functional lives on a grid, the splines of its deposit interpolate it.
    pub values: Vec<f64>,
    /// The derivatives along each direction, one particle after the other, if the functional lives on a grid. For the
    /// functional in the potential, they are the force per unit mass: the pull-back of the deposit gives the same
    /// numbers up to rounding.
    pub slopes: Option<Vec<f64>>,
}

/// Why a functional cannot be evaluated at the particles.
#[derive(Clone, Debug, PartialEq)]
pub enum Unvalued {
    /// A quantity that the functional depends on is not given; its name.
    Missing(String),
    /// The functional is Rust code and needs a build; its path.
    Path(String),
    /// The given values are not valid for the functional.
    Parameter(ParameterError),
    /// The functional cannot be evaluated at these positions.
    Mesh(MeshError),
    /// The domain lacks a grid, or the functional does not depend on these positions.
    Unfit,
}

impl fmt::Display for Unvalued {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(name) => write!(f, "it needs `{name}`, which is missing"),
            Self::Path(path) => write!(f, "`{path}` is your own Rust code, which must be compiled"),
            Self::Parameter(e) => write!(f, "{e}"),
            Self::Mesh(e) => write!(f, "{e}"),
            Self::Unfit => write!(f, "it does not depend on the positions of these particles"),
        }
    }
}

impl std::error::Error for Unvalued {}

impl From<ParameterError> for Unvalued {
    fn from(e: ParameterError) -> Self {
        Unvalued::Parameter(e)
    }
}

impl From<MeshError> for Unvalued {
    fn from(e: MeshError) -> Self {
        Unvalued::Mesh(e)
    }
}

/// Evaluates functional number `mesh` of a model at the particles. `numbers` returns parameters by their names in the
/// model, and data of particles as one list with one particle after the other.
///
/// # Errors
/// [`Unvalued`], if a quantity is missing or the functional cannot be evaluated.
pub fn at_particles(
    lattice: &Lattice,
    mesh: usize,
    placed: &Placed<'_>,
    numbers: &Numbers<'_>,
) -> Result<AtParticles, Unvalued> {
    let count = placed.at.len() / placed.lengths.len().max(1);
    let around = extent(placed.lengths, placed.walls)
        .and_then(|e| FunctionalSetting::new(e, placed.cells, count));
    let around = around.ok_or(Unvalued::Unfit)?;
    let (column, root) = values(lattice, mesh, &around, placed, numbers)?;
    let Column::Numbers(values) = column else {
        return Err(Unvalued::Unfit);
    };
    let (Some(root), Some(own)) = (lattice.meshes.get(root), lattice.meshes.get(mesh)) else {
        return Err(Unvalued::Unfit);
    };
    if lattice
        .find(&own.name.text)
        .is_some_and(|q| !lattice.is_grid(q.label))
    {
        return Ok(AtParticles {
            values,
            slopes: None,
        });
    }
    let places = || {
        placed
            .at
            .as_chunks::<2>()
            .0
            .iter()
            .map(|x| SVector::from(*x))
    };
    match (named(root)?, &around) {
        ("deposit", FunctionalSetting::Line(s)) => {
            interpolated::<deposit<f64, 1>, f64, 1>(s, placed.at, &values)
        }
        ("deposit", FunctionalSetting::Plane(s)) => {
            let at: Vec<SVector<f64, 2>> = places().collect();
            interpolated::<deposit<f64, 2>, _, 2>(s, &at, &values)
        }
        ("deposit_quintic", FunctionalSetting::Line(s)) => {
            interpolated::<deposit_quintic<f64, 1>, f64, 1>(s, placed.at, &values)
        }
        ("deposit_quintic", FunctionalSetting::Plane(s)) => {
            let at: Vec<SVector<f64, 2>> = places().collect();
            interpolated::<deposit_quintic<f64, 2>, _, 2>(s, &at, &values)
        }
        _ => Err(Unvalued::Unfit),
    }
}

/// The name of a functional that the runtime supplies.
fn named(mesh: &Mesh) -> Result<&str, Unvalued> {
    let name = mesh.path.strip_prefix("clebsch::mesh::");
    let known = name.filter(|_| mesh.kind != FunctionalKind::Path);
    known.ok_or_else(|| Unvalued::Path(mesh.path.clone()))
}

/// The values of a functional at its sites, and the index of the functional at the root, which takes the positions.
fn values(
    lattice: &Lattice,
    at: usize,
    around: &FunctionalSetting,
    placed: &Placed<'_>,
    numbers: &Numbers<'_>,
) -> Result<(Column<f64>, usize), Unvalued> {
    let mesh = lattice.meshes.get(at).ok_or(Unvalued::Unfit)?;
    let (of, root) = match &mesh.of {
        Source::Field(name) if lattice.places().is_some_and(|q| q.name.text == *name) => {
            let column = match placed.lengths.len() {
                1 => Column::Numbers(placed.at.to_vec()),
                d => Column::of_rows([d, 1], placed.at),
            };
            (column, at)
        }
        Source::Field(_) => return Err(Unvalued::Unfit),
        // A functional can depend only on functionals declared before it.
        Source::Functional(i) if *i < at => values(lattice, *i, around, placed, numbers)?,
        Source::Functional(_) => return Err(Unvalued::Unfit),
    };
    let data = mesh.arguments.iter().skip(1).map(|a| {
        let missing = || Unvalued::Missing(a.text.clone());
        let list = numbers(&a.text).ok_or_else(missing)?;
        Ok(match lattice.find(&a.text) {
            Some(_) => Value::Sites(Column::Numbers(list)),
            None => Value::Real(*list.first().ok_or_else(missing)?),
        })
    });
    let data: Vec<Value<f64>> = data.collect::<Result<_, Unvalued>>()?;
    let made = made::<f64>(named(mesh)?, around, &data).ok_or(Unvalued::Unfit)?;
    let mut functional: AnyFunctional<f64> = made?;
    let own = lattice.find(&mesh.name.text).ok_or(Unvalued::Unfit)?;
    let count = match lattice.is_grid(own.label) {
        true => around.nodes(),
        false => placed.at.len() / placed.lengths.len().max(1),
    };
    let mut out = vec![0.0; count];
    functional.value(&of, &mut out).ok_or(Unvalued::Unfit)??;
    Ok((Column::Numbers(out), root))
}

/// A deposit that interpolates. It has unit masses, so that massless particles also get values and slopes.
trait Interpolates<A, const D: usize>:
    for<'a> Functional<f64, D, Argument = A, Data<'a> = (&'a [f64],)>
{
    fn at_last(&mut self, nodal: &[f64], out: &mut [f64]) -> Result<(), MeshError>;
    fn zero() -> A;
    fn coordinates(of: &A) -> [f64; D];
}

macro_rules! interpolates {
    ($($name:ident),*) => {$(
        impl Interpolates<f64, 1> for mesh::$name<f64, 1> {
            fn at_last(&mut self, nodal: &[f64], out: &mut [f64]) -> Result<(), MeshError> {
                self.interpolate(nodal, out)
            }

            fn zero() -> f64 {
                0.0
            }

            fn coordinates(of: &f64) -> [f64; 1] {
                [*of]
            }
        }

        impl Interpolates<SVector<f64, 2>, 2> for mesh::$name<f64, 2> {
            fn at_last(&mut self, nodal: &[f64], out: &mut [f64]) -> Result<(), MeshError> {
                self.interpolate(nodal, out)
            }

            fn zero() -> SVector<f64, 2> {
                SVector::zeros()
            }

            fn coordinates(of: &SVector<f64, 2>) -> [f64; 2] {
                [of.x, of.y]
            }
        }
    )*};
}

interpolates!(deposit, deposit_quintic);

fn interpolated<F, A, const D: usize>(
    setting: &Setting<D>,
    at: &[A],
    nodal: &[f64],
) -> Result<AtParticles, Unvalued>
where
    A: Copy,
    F: Interpolates<A, D>,
{
    let mut spread = F::new(setting, (&vec![1.0; at.len()],))?;
    let mut nodes = vec![0.0; nodal.len()];
    spread.value(at, &mut nodes)?;
    let mut values = vec![0.0; at.len()];
    spread.at_last(nodal, &mut values)?;
    let weights = Nodes::new(setting)?.weights::<f64>();
    let seed: Vec<f64> = nodal.iter().zip(weights).map(|(s, w)| s * w).collect();
    let mut slopes = vec![F::zero(); at.len()];
    spread.pull_back(at, &seed, &mut slopes)?;
    let slopes = slopes.iter().flat_map(F::coordinates).collect();
    Ok(AtParticles {
        values,
        slopes: Some(slopes),
    })
}
