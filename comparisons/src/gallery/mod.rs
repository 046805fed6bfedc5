//! The other methods for each gallery model. A method takes the values of a case in the order of the card, and returns its state as
//! initial values of the same card. A caller can therefore evaluate observables and invariants with the model itself.

mod any_dimension;
mod coupled;
mod ellipsoid;
mod mixed_four;
mod point;
mod rigid;
mod submerged;
mod unit_quaternion;

use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion};

/// The values of a case.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Parameters in the order of the card, each row-major.
    pub parameters: &'a [Vec<f64>],
    /// Initial values in the order of the card, each row-major.
    pub initial: &'a [Vec<f64>],
    /// Step size, the node distance.
    pub h: f64,
}

/// A running method.
pub trait Method {
    /// Advances to the next node.
    ///
    /// # Errors
    /// [`Unsolvable`] if the step fails.
    fn step(&mut self) -> Result<(), Unsolvable>;

    /// The state at the current node as initial values of the model, in the order of the card.
    fn shown(&self) -> Vec<Vec<f64>>;
}

/// The role of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The reference for the errors of the others: closed form, or Runge-Kutta at rounding level.
    Reference,
    /// The generated scheme, written by hand.
    ByHand,
    /// A method from the literature.
    Published,
}

/// A method for comparison with a model.
#[derive(Clone, Copy, Debug)]
pub struct Offer {
    /// Its name in tables and files.
    pub name: &'static str,
    /// Its description and source.
    pub doc: &'static str,
    /// Its role.
    pub role: Role,
    /// Its start function.
    pub start: Start,
}

/// Starts a method. Returns an error if the values do not fit the model, or if the step has no solution.
pub type Start = fn(&Problem<'_>) -> Result<Box<dyn Method>, Unsolvable>;

/// Tolerances of the published Runge-Kutta methods: near rounding, and typical.
const TIGHT: f64 = 1e-12;
const LOOSE: f64 = 1e-9;

/// The smallest tolerance of Matlab's ode45, 100 rounding errors; ode45 replaces 1e-15 by this value.
const SMALLEST: f64 = 2.3e-14;

fn reference(start: Start) -> Offer {
    Offer {
        name: "verner-98",
        doc: "Verner's Runge-Kutta 9(8), two steps a node at least",
        role: Role::Reference,
        start,
    }
}

/// A second run at rounding level. Its deviation measures the error of the reference, or its own error.
fn check(start: Start) -> Offer {
    Offer {
        name: "verner-98-finer",
        doc: "Verner's Runge-Kutta 9(8), three steps a node: how good the reference is",
        role: Role::Published,
        start,
    }
}

fn by_hand(start: Start) -> Offer {
    Offer {
        name: "by-hand",
        doc: "the generated scheme, written by hand",
        role: Role::ByHand,
        start,
    }
}

fn eighth(start: Start) -> Offer {
    Offer {
        name: "dormand-prince-85",
        doc: "Dormand and Prince 8(5,3), tolerance 1e-12",
        role: Role::Published,
        start,
    }
}

/// Dormand and Prince 5(4) with the smallest tolerance of Matlab's ode45, for the models that the thesis compares with it.
pub fn ode45(model: &str) -> Option<Offer> {
    let start: Start = match model {
        "free-body" => rigid::ode45::<rigid::FreeBody>,
        "heavy-top" => rigid::ode45::<rigid::HeavyTop>,
        "coupled-bodies" => coupled::ode45,
        _ => return None,
    };
    Some(Offer {
        name: "ode45",
        doc: "Dormand and Prince 5(4), tolerance 2.3e-14",
        role: Role::Published,
        start,
    })
}

fn fifth(start: Start) -> Offer {
    Offer {
        name: "dormand-prince-54",
        doc: "Dormand and Prince 5(4), as ode45, tolerance 1e-9",
        role: Role::Published,
        start,
    }
}

/// The methods for this model, with the reference first; empty for a model without hand-written equations.
pub fn offers(model: &str) -> Vec<Offer> {
    match model {
        "free-body" => rigid::free::<rigid::FreeBody>(),
        "free-body-spatial" => rigid::free::<rigid::FreeBodySpatial>(),
        "heavy-top" => rigid::top::<rigid::HeavyTop>(),
        "heavy-top-spatial" => rigid::top::<rigid::HeavyTopSpatial>(),
        "body-in-two-fields" => rigid::in_field::<rigid::BodyInTwoFields>(),
        "body-in-quadratic-field" => rigid::in_field::<rigid::BodyInQuadraticField>(),
        "charged-particle" => point::offers::<point::Charge>(),
        "coupled-bodies" => coupled::bodies(),
        "ellipsoid-convective" => ellipsoid::convective(),
        "ellipsoid-spatial" => ellipsoid::spatial(),
        "kepler" => point::offers::<point::Planet>(),
        "cayley-klein" => unit_quaternion::body::<unit_quaternion::InBody>(),
        "cayley-klein-spatial" => unit_quaternion::body::<unit_quaternion::InSpace>(),
        "mixed-four" => mixed_four::joined(),
        "kirchhoff-body" => submerged::bodies(),
        "body-n" => any_dimension::bodies(),
        _ => Vec::new(),
    }
}

impl Problem<'_> {
    fn parameter<T: Value>(&self, index: usize) -> Option<T> {
        T::read(self.parameters.get(index)?)
    }

    fn initial<T: Value>(&self, index: usize) -> Option<T> {
        T::read(self.initial.get(index)?)
    }
}

/// A value parsed from a list of numbers; `None` if the count differs.
trait Value: Sized {
    fn read(numbers: &[f64]) -> Option<Self>;
}

impl Value for f64 {
    fn read(numbers: &[f64]) -> Option<Self> {
        match numbers {
            [one] => Some(*one),
            _ => None,
        }
    }
}

impl<const N: usize> Value for [f64; N] {
    fn read(numbers: &[f64]) -> Option<Self> {
        numbers.try_into().ok()
    }
}

/// Row-major.
impl<const N: usize> Value for [[f64; N]; N] {
    fn read(numbers: &[f64]) -> Option<Self> {
        let mut matrix = [[0.0; N]; N];
        let places = matrix.as_flattened_mut();
        if places.len() != numbers.len() {
            return None;
        }
        places.copy_from_slice(numbers);
        Some(matrix)
    }
}

impl Value for Quaternion {
    fn read(numbers: &[f64]) -> Option<Self> {
        Some(Quaternion::from_matrix(&Matrix::read(numbers)?))
    }
}

/// The entries of a matrix, row by row.
fn rows(m: &Matrix) -> Vec<f64> {
    m.iter().flatten().copied().collect()
}
