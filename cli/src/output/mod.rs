//! What a run leaves behind: trajectory.csv, trajectory.npz, run.json and plots in one new folder, on demand files for
//! ParaView in one within.
//! Takes a run, finished or stopped in the middle; gives the names of the files. Nothing in them depends on the time of day.

pub(crate) mod arrays;
mod interrupted;
mod multipliers;
mod pdf;
pub(crate) mod points;
pub(crate) mod run_json;
pub(crate) mod samples;
pub(crate) mod sites;
mod staging;
mod standing;
mod thinned;
pub(crate) mod vtk;

pub(crate) use interrupted::Listening;
pub(crate) use multipliers::is_multiplier;
pub use staging::{Found, Staging};

use crate::checkpoint;
use crate::failure::Failure;
use crate::page;
use crate::plain::shown;
use crate::plan::Plan;
use crate::plots;
use crate::record::Samples;
use crate::verdict::Outcome;
use clebsch::card::Card;
use clebsch::integrate::Halvings;
use clebsch::record::{Record, Rows as _, npz, write_csv};
use clebsch_check::Verdict;
use samples::Rows;
use std::io::Write;
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

/// Most numbers that are written as text without being asked for: ten megabytes.
const MOST_IN_CSV: u64 = 500_000;

/// Writes all files into `staging`; gives their names.
///
/// # Errors
/// Failed: the file system refuses.
pub fn write(
    staging: &Staging,
    run: &Finished<'_>,
    rows: &Rows,
    opening: Option<Record>,
    in_space: Vec<vtk::Drawn>,
) -> Result<Vec<String>, Failure> {
    let [
        csv,
        archive,
        json,
        momentum,
        invariants,
        advected,
        fields,
        attitude,
        angles,
        particles,
        vorticity,
        snapshots,
        html,
        ..,
    ] = FILES;
    let mut files = vec![archive.to_owned(), json.to_owned()];
    let numbers = rows.count().saturating_mul(samples::width(run.card) as u64);
    if run.plan.csv || numbers <= MOST_IN_CSV {
        staging.write(csv, |file| write_csv(file, run.card, rows))?;
        files.insert(0, csv.to_owned());
    }
    let arrays = arrays::arrays(run.card, rows.count());
    staging.write(archive, |file| npz::write(file, rows, &arrays))?;
    let record = thinned::record(run.card, rows).map_err(|error| {
        let path = staging.folder().join(samples::NAME);
        Failure::io(&format!("cannot read {}", shown(&path)), &error)
    })?;
    let samples = &Samples { record, opening };
    let record = &samples.record;
    let mut pictures = Vec::new();
    let drawn = [
        (momentum, plots::momentum(run, samples)),
        (invariants, plots::invariants(run, record)),
        (advected, plots::advected(run, samples)),
        (fields, plots::fields(run, samples)),
        (attitude, plots::attitude(run, samples)),
        (angles, plots::angles(run, samples)),
        (particles, plots::particles(run, record)),
        (vorticity, plots::vorticity(run, record)),
        (snapshots, plots::snapshots(run, record)),
    ];
    for (name, plot) in drawn {
        let plot = plot.map_err(|error| Failure::Failed(format!("cannot draw {name}: {error}")))?;
        if let Some(svg) = plot {
            staging.write(name, |file| file.write_all(svg.as_bytes()))?;
            files.push(name.to_owned());
            if run.plan.paper
                && let Some(pdf) = pdf::pdf(&svg)
            {
                let pdf =
                    pdf.map_err(|why| Failure::Failed(format!("cannot set {name}: {why}")))?;
                let name = name.replace(".svg", ".pdf");
                staging.write(&name, |file| file.write_all(&pdf))?;
                files.push(name);
            }
            pictures.push((name, svg));
        }
    }
    let page = page::page(run, samples, &pictures);
    staging.write(html, |file| file.write_all(page.as_bytes()))?;
    files.push(html.to_owned());
    if !in_space.is_empty() {
        files.extend(vtk::write(staging, run.plan, rows, in_space)?);
    }
    let text = format!("{:#}\n", run_json::run_json(run, &files));
    staging.write(json, |file| file.write_all(text.as_bytes()))?;
    Ok(files)
}

/// Removes what a run that has come to its end, or cannot be gone on with, needs no longer.
pub(crate) fn remove_what_resumes(folder: &Path) {
    // The checkpoint first: without it the samples are nothing.
    for name in [checkpoint::NAME, checkpoint::UNFINISHED, samples::NAME] {
        let _ = std::fs::remove_file(folder.join(name));
    }
}
