//! Cases that another program runs instead of a command, such as the Python package. Plan, steps, names of arrays and
//! verdicts agree with `clebsch run`. Samples stay in memory, and the caller decides how long each call runs.

mod edit;
mod layout;
mod model;
mod request;
mod running;

pub use crate::plan::Plan;
pub use crate::trajectory::verdict::{Outcome, Verdict};
pub use edit::{Edit, edited, quoted, quoted_key};
pub use layout::{Columns, Layout, layout};
pub use model::{Model, Planned};
pub use request::Request;
pub use running::{Rows, Running, StepLimits};
