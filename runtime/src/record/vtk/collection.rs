//! Files over time, as `.pvd`. Takes times and names; writes one file, which ParaView opens as a film.

use super::escaped;
use std::io::{self, Write};

/// One file of a collection.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The time it shows.
    pub time: f64,
    /// The path, relative to the folder of the collection.
    pub file: String,
}

/// Writes the list of files, in the order in which they are given.
///
/// # Errors
/// Errors of `file`.
pub fn write_collection(file: &mut dyn Write, members: &[Member]) -> io::Result<()> {
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>"
    )?;
    for Member { time, file: name } in members {
        let name = escaped(name);
        writeln!(
            file,
            "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{name}\"/>"
        )?;
    }
    writeln!(file, "</Collection>\n</VTKFile>")
}
