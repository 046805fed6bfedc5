//! What a run leaves behind: trajectory.csv, trajectory.npz, run.json and plots in one new folder.
//! Takes a run, finished or stopped in the middle; gives the names of the files. Nothing in them depends on the time of day.

mod csv;
mod interrupted;
mod names;
mod npz;
mod run_json;
pub(crate) mod sites;
mod staging;
mod standing;

pub use run_json::run_json;
pub use staging::Staging;

use crate::failure::Failure;
use crate::plan::Plan;
use crate::plots;
use crate::record::Samples;
use crate::verdict::Outcome;
use clebsch::card::Card;
use clebsch::integrate::LargestResidual;

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
    /// The largest residual of a step; none where the steps solve other equations.
    pub residual: Option<LargestResidual>,
    /// Where it stopped; none for a run that has come to its end.
    pub stopped: Option<Stopped>,
}

/// Every file name a run can write, so that a folder with anything else is never replaced.
pub const FILES: [&str; 7] = [
    "trajectory.csv",
    "trajectory.npz",
    "run.json",
    "momentum.svg",
    "invariants.svg",
    "advected.svg",
    "fields.svg",
];

/// Writes all files into `staging`; gives their names.
///
/// # Errors
/// Failed: the file system refuses.
pub fn write(
    staging: &Staging,
    run: &Finished<'_>,
    samples: &Samples,
) -> Result<Vec<&'static str>, Failure> {
    let record = &samples.record;
    let [csv, npz, json, momentum, invariants, advected, fields] = FILES;
    staging.write(csv, |file| csv::write(file, run.card, record))?;
    staging.write(npz, |file| npz::write(file, &npz::arrays(run.card, record)))?;
    let mut files = vec![csv, npz, json];
    let drawn = [
        (momentum, plots::momentum(run, samples)),
        (invariants, plots::invariants(run, record)),
        (advected, plots::advected(run, samples)),
        (fields, plots::fields(run, samples)),
    ];
    for (name, plot) in drawn {
        let plot = plot.map_err(|error| Failure::Failed(format!("cannot draw {name}: {error}")))?;
        if let Some(svg) = plot {
            staging.write(name, |file| file.write_all(svg.as_bytes()))?;
            files.push(name);
        }
    }
    let text = format!("{:#}\n", run_json(run, &files));
    staging.write(json, |file| file.write_all(text.as_bytes()))?;
    Ok(files)
}
