//! The results of a run in one new folder, and how to read them: samples, arrays, run.json, files for ParaView.
//! Takes a run that is finished or stopped early.

pub(crate) mod arrays;
pub(crate) mod attitude;
pub(crate) mod fluid;
mod interrupted;
mod multipliers;
mod output_target;
pub(crate) mod places;
pub(crate) mod points;
pub(crate) mod results;
pub(crate) mod run_json;
pub(crate) mod sample_selection;
pub(crate) mod samples;
pub(crate) mod sites;
mod staging;
pub(crate) mod vtk;

pub(crate) use interrupted::SignalListener;
pub(crate) use multipliers::is_multiplier;
pub(crate) use output_target::{MARK, is_drawn};
pub use staging::{ResumableRun, Staging};

use crate::plan::Plan;
use crate::trajectory::checkpoint;
use crate::trajectory::verdict::Outcome;
use clebsch::card::Card;
use clebsch::integrate::Halvings;
use clebsch_check::Verdict;
use std::path::Path;

/// Where and why a run stopped before its end.
pub struct Stopped {
    /// The last node that was reached.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// Why the next one was not, in a sentence.
    pub why: String,
}

/// A run that is complete, or that stopped after at least one step.
pub struct Finished<'a> {
    /// The model.
    pub card: &'a Card,
    /// The plan of the run.
    pub plan: &'a Plan,
    /// The drift of each invariant.
    pub outcomes: &'a [Outcome],
    /// Number of samples taken.
    pub samples: u64,
    /// Steps that were subdivided; `None` without `--halve`.
    pub halvings: Option<Halvings>,
    /// The check of steps against the action as stated; `None` if no steps were checked.
    pub stated: Option<Verdict>,
    /// The node at which the run stopped; `None` if it is complete.
    pub stopped: Option<Stopped>,
}

/// The names of all files that a run can write. A folder with any other file is never replaced.
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
    // Present while the run computes, and while it can be resumed.
    samples::NAME,
    checkpoint::NAME,
    checkpoint::UNFINISHED,
    // Pictures for papers.
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

/// Removes the files that only a resumed run needs.
pub(crate) fn remove_what_resumes(folder: &Path) {
    // The checkpoint goes first: without it the samples are useless.
    for name in [checkpoint::NAME, checkpoint::UNFINISHED, samples::NAME] {
        let _ = std::fs::remove_file(folder.join(name));
    }
}
