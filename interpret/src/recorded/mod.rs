//! Functions as tapes of scalar operations, recorded when they are first called.
//!
//! A tape computes the same result as the function, bit for bit, as long as its decisions come out as they did when it
//! was recorded. If they do not, clebsch runs the function itself. Newton's iteration runs between two tapes: the first
//! computes the input of the equations, and the second computes the step from their solution. All trajectories of a model
//! share its tapes.

mod counts;
mod decision_tree;
mod equations;
mod form;
mod function;
mod loop_inputs;
mod ready;
mod shared;
mod sites;
mod solves;
mod tape_storage;
mod traced;
mod trajectory;

pub use equations::{EquationValues, NewtonFunction};
pub use form::value_of;
pub use function::{Function, run as run_alone};
pub use loop_inputs::List;
pub use ready::Ready;
pub use sites::{Lists, SiteBody, SiteFunction, TracedSite};
pub use solves::RecordedSolve;
pub use traced::{Traced, WithDerivatives, has_derivatives, record_with_derivatives};
pub use trajectory::{Recordable, Recorded, Watched};

use crate::code::{Iterate, Library, Native, Special};
use crate::library;
use std::sync::Arc;

impl Library for Traced {
    fn native(name: &str, arguments: usize) -> Option<Native<Self>> {
        library::native(name, arguments)
    }

    fn special(name: &str) -> Option<Special<Self>> {
        match name {
            "remember" => Some(solves::remember),
            _ => library::special(name),
        }
    }

    fn iterate(recorded: Option<Arc<dyn Iterate<Traced>>>) -> Option<Arc<dyn Iterate<Self>>> {
        recorded
    }
}

/// Writes numbers to inputs. Returns nothing if there are fewer inputs than numbers.
fn load(inputs: &mut [[f64; 1]], numbers: &[f64]) -> Option<()> {
    for (slot, x) in inputs.get_mut(..numbers.len())?.iter_mut().zip(numbers) {
        *slot = [*x];
    }
    Some(())
}
