//! Checks of the initial data of models with constraints: the configuration must satisfy them, and its momentum must
//! be tangent to them. Takes the constraint as the model states it, with numbers; gives an error with these numbers
//! if a check fails.

use crate::{ParameterError, Problem, Real};

/// The first step solves the constraint to rounding: data typed with ten digits are on it.
const OFF: f64 = 1e-9;

/// The constraint forces absorb a small normal part: data typed with eight digits count as tangent.
const ACROSS: f64 = 1e-7;

/// The initial configuration satisfies a constraint.
///
/// # Errors
/// If `value`, the left side minus the right side, is more than rounding of terms of size `scale`.
pub fn on_constraint<T: Real>(
    field: &'static str,
    equation: &'static str,
    value: T,
    scale: T,
) -> Result<(), ParameterError> {
    let (size, scale) = (value.magnitude(), scale.magnitude());
    if size <= OFF * scale {
        return Ok(());
    }
    Err(ParameterError {
        field,
        problem: Problem::OffConstraint {
            equation,
            size,
            scale,
        },
        remedy: "give a configuration that satisfies it to ten digits, in a case to eight, or adjust the parameters",
    })
}

/// The initial momentum is tangent to a constraint. `impulse` is the multiplier that the projection found, `taken`
/// the size of the removed part of a momentum of size `whole`.
///
/// # Errors
/// If the projection removes more than rounding, or does not determine the multiplier.
pub fn along_constraint<T: Real>(
    field: &'static str,
    equation: &'static str,
    impulse: T,
    taken: T,
    whole: T,
) -> Result<(), ParameterError> {
    if !impulse.is_finite() {
        return Err(ParameterError {
            field,
            problem: Problem::DependentConstraints { equation },
            remedy: "remove constraints that follow from others, or start elsewhere; if all are independent, the masses differ \
                too much for double precision: make them more similar, and replace zero masses by small positive values",
        });
    }
    let (taken, whole) = (taken.magnitude(), whole.magnitude());
    // A constraint with multiplier zero removes nothing: the error then belongs to another constraint.
    if taken <= ACROSS * whole || impulse.magnitude() == 0.0 {
        return Ok(());
    }
    Err(ParameterError {
        field,
        problem: Problem::AcrossConstraint {
            equation,
            impulse: impulse.value(),
            taken,
            whole,
        },
        remedy: "subtract the multiplier times the gradient of the left side minus the right side, or give the momentum of a \
            velocity that satisfies the constraint",
    })
}

/// A unit impulse at the start gives the constrained quantity a velocity of size `answer`.
///
/// # Errors
/// If `answer` is not finite.
pub fn has_inertia<T: Real>(field: &'static str, answer: T) -> Result<(), ParameterError> {
    if answer.is_finite() {
        return Ok(());
    }
    Err(ParameterError {
        field,
        problem: Problem::NoInertia,
        remedy: "give every moving site a positive mass, and second moments with inertia in every direction",
    })
}
