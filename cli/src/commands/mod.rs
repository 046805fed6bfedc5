//! The commands, each of which takes the gallery and the matches of its arguments.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod converge;
pub mod derive;
pub(crate) mod equilibrium;
pub(crate) mod figures;
pub(crate) mod fit;
pub(crate) mod gradient;
pub(crate) mod linearise;
pub(crate) mod list;
pub(crate) mod lyapunov;
pub(crate) mod new;
pub(crate) mod orbit;
pub(crate) mod plot;
pub(crate) mod run;
pub(crate) mod section;
pub(crate) mod show;
pub(crate) mod sweep;
