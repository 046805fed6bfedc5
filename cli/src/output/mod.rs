//! What a run leaves behind in one new folder, and how it is read there: samples, arrays, run.json, files for ParaView. Takes a run,
//! finished or stopped in the middle.

pub(crate) mod arrays;
pub(crate) mod attitude;
pub(crate) mod fluid;
mod interrupted;
mod multipliers;
pub(crate) mod places;
pub(crate) mod points;
pub(crate) mod run_json;
pub(crate) mod samples;
pub(crate) mod sites;
mod staging;
mod standing;
pub(crate) mod thinned;
pub(crate) mod vtk;

pub(crate) use interrupted::Listening;
pub(crate) use multipliers::is_multiplier;
pub use staging::{Found, Staging};
pub(crate) use standing::{MARK, is_drawn};

use crate::plan::Plan;
use crate::trajectory::checkpoint;
use crate::trajectory::verdict::Outcome;
use clebsch::card::Card;
use clebsch::integrate::Halvings;
use clebsch_check::Verdict;
use std::path::Path;

/// Where and why a run stopped before its end.
pub struct Stopped {
    /// The last node reached.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// Why the next one was not, in a sentence.
    pub why: String,
}

/// A run that has come to its end, or stopped after at least one step.
pub struct Finished<'a> {
    /// The model.
    pub card: &'a Card,
    /// What was asked for.
    pub plan: &'a Plan,
    /// What was conserved.
    pub outcomes: &'a [Outcome],
    /// Number of samples taken.
    pub samples: u64,
    /// Steps that were made by parts; none where a refused step ends a run.
    pub halvings: Option<Halvings>,
    /// What the action as stated says of the judged steps; none where none was to be judged.
    pub stated: Option<Verdict>,
    /// Where it stopped; none for a run that has come to its end.
    pub stopped: Option<Stopped>,
}

/// Every file name a run can write, so that a folder with anything else is never replaced.
pub const FILES: [&str; 26] = [
    "trajectory.csv",
    "trajectory.npz",
    "run.json",
    "momentum.svg",
    "invariants.svg",
    "advected.svg",
    "fields.svg",
    "attitude.svg",
    "angles.svg",
    "particles.svg",
    "vorticity.svg",
    "snapshots.svg",
    "run.html",
    vtk::FOLDER,
    // While it runs, and where it can be gone on with.
    samples::NAME,
    checkpoint::NAME,
    checkpoint::UNFINISHED,
    // Of pictures for a paper.
    "momentum.pdf",
    "invariants.pdf",
    "advected.pdf",
    "fields.pdf",
    "attitude.pdf",
    "angles.pdf",
    "particles.pdf",
    "vorticity.pdf",
    "snapshots.pdf",
];

/// Removes what a run that has come to its end, or cannot be gone on with, needs no longer.
pub(crate) fn remove_what_resumes(folder: &Path) {
    // The checkpoint first: without it the samples are nothing.
    for name in [checkpoint::NAME, checkpoint::UNFINISHED, samples::NAME] {
        let _ = std::fs::remove_file(folder.join(name));
    }
}
