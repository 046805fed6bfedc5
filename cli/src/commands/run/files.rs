//! The files of a run: samples, pictures, the page and run.json. Takes a run; gives the names of the files. Their
//! contents do not depend on the time of day.

use super::pdf;
use crate::output::samples::{self, Rows};
use crate::output::{FILES, Finished, Staging, arrays, run_json, sample_selection, vtk};
use crate::page;
use crate::plots;
use crate::terminal::failure::Failure;
use crate::trajectory::record::Samples;
use crate::words::plain::shown;
use clebsch::record::{Record, Rows as _, npz, write_csv};
use std::io::Write;

/// By default, the largest number of values that are written as text: ten megabytes.
const MOST_IN_CSV: u64 = 500_000;

/// Writes all files into `staging`; gives their names.
///
/// # Errors
/// Failed: a file cannot be written.
pub(super) fn write(
    staging: &Staging,
    run: &Finished<'_>,
    rows: &Rows,
    opening: Option<Record>,
    in_space: Vec<vtk::DrawnObject>,
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
    let record = sample_selection::record(run.card, rows).map_err(|error| {
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
