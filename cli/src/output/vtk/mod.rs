//! A run as files for ParaView, in a separate folder: one file per sample for every object in space, and a collection
//! of these files over time. Takes a card and a plan, then the rows of the run; gives the names of the collections.

mod bodies;
mod cells;
mod columns;
pub(crate) mod fluid;
mod grid;
mod kinematics;
mod sites;

use super::samples::Rows;
use super::staging::Staging;
use crate::plan::Plan;
use crate::terminal::failure::Failure;
use clebsch::card::Card;
use clebsch::record::Rows as _;
use clebsch::record::vtk::{ImageData, Member, PolyData, write_collection};
use std::io::{self, Write};

/// The folder, by its name among the files that a run can write.
pub(crate) const FOLDER: &str = "vtk/";

/// By default, the largest number of samples that are written.
const FRAMES: u64 = 1000;

/// An object that is drawn.
pub(crate) struct DrawnObject {
    /// The name of its files.
    name: String,
    part: Box<dyn Part>,
}

/// The content of a file.
enum Data {
    Poly(PolyData),
    Image(ImageData),
}

/// Makes the data of a sample from its observables.
trait Part {
    /// `vtp` or `vti`.
    fn ending(&self) -> &'static str {
        "vtp"
    }

    fn data(&mut self, row: &[f64]) -> Data;
}

/// All objects of a model that can be drawn.
///
/// # Errors
/// Usage: there are none.
pub(crate) fn drawn(card: &Card, plan: &Plan) -> Result<Vec<DrawnObject>, Failure> {
    let own = |(name, part): (String, Box<dyn Part>)| DrawnObject { name, part };
    let mut all: Vec<DrawnObject> = fluid::parts(card, plan).into_iter().map(own).collect();
    let taken = !all.is_empty();
    all.extend(sites::parts(card, plan, taken).into_iter().map(own));
    all.extend(bodies::parts(card).into_iter().map(own));
    match all.is_empty() {
        false => Ok(all),
        true => Err(Failure::Usage(format!(
            "--vtk: `{}` has nothing to show in the plane or in space; trajectory.npz has its numbers",
            card.kebab
        ))),
    }
}

/// Writes all of them; gives the names of the collections.
///
/// # Errors
/// Failed: a file cannot be written.
pub(crate) fn write(
    staging: &Staging,
    plan: &Plan,
    rows: &Rows,
    mut drawn: Vec<DrawnObject>,
) -> Result<Vec<String>, Failure> {
    staging.make_folder(FOLDER)?;
    // If `--every` is given, all samples are written.
    let stride = match plan.arguments["every"].is_null() {
        true => rows.count().div_ceil(FRAMES).max(1),
        false => 1,
    };
    let digits = rows.count().saturating_sub(1).to_string().len();
    let mut members: Vec<Vec<Member>> = vec![Vec::new(); drawn.len()];
    let mut sample = 0_u64;
    let mut failed = None;
    let observables = |row: &[u64]| -> Vec<f64> {
        let numbers = row.iter().skip(2).map(|x| f64::from_bits(*x));
        numbers.collect()
    };
    let read = rows.each(&mut |row| {
        let at = sample;
        sample += 1;
        // The last sample of a run is always written.
        if !at.is_multiple_of(stride) && at + 1 != rows.count() {
            return Ok(());
        }
        let numbers = observables(row);
        let time = row.get(1).map_or(f64::NAN, |x| f64::from_bits(*x));
        for (own, members) in drawn.iter_mut().zip(&mut members) {
            let ending = own.part.ending();
            let file = format!("{}-{at:0digits$}.{ending}", own.name);
            let data = own.part.data(&numbers);
            let written = staging.write(&format!("{FOLDER}{file}"), |out| data.write(out));
            if let Err(failure) = written {
                failed = Some(failure);
                return Err(io::Error::other("told"));
            }
            members.push(Member { time, file });
        }
        Ok(())
    });
    if let Some(failure) = failed {
        return Err(failure);
    }
    read.map_err(|error| Failure::io("cannot read the samples", &error))?;
    let mut names = Vec::new();
    for (own, members) in drawn.iter().zip(&members) {
        let name = format!("{FOLDER}{}.pvd", own.name);
        staging.write(&name, |out| write_collection(out, members))?;
        names.push(name);
    }
    Ok(names)
}

impl Data {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Data::Poly(data) => data.write(out),
            Data::Image(data) => data.write(out),
        }
    }
}
