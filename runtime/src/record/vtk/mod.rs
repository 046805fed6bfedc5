//! Samples as files that ParaView and VTK read: polygonal data (`.vtp`), image data (`.vti`) and collections over time
//! (`.pvd`). Takes points, cells and numbers at them; writes XML with the numbers in base64 inside it. The same numbers
//! give the same bytes. Format: VTK XML, version 1.0, uncompressed binary arrays whose lengths have eight bytes.

mod base64;
mod collection;
mod image;
mod poly;

pub use collection::{Member, write_collection};
pub use image::ImageData;
pub use poly::PolyData;

use base64::Encoder;
use std::io::{self, Write};

/// The beginning of a file of data, before its kind.
const HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" type=";

/// Numbers at points, or at cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// The name of the values.
    pub name: String,
    /// The number of components at each point or cell: 1 for numbers, 3 for vectors, which are drawn as arrows.
    pub components: usize,
    /// The numbers, point after point.
    pub numbers: Vec<f64>,
}

impl Values {
    /// One number at each point or cell.
    #[must_use]
    pub fn numbers(name: &str, numbers: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            components: 1,
            numbers,
        }
    }

    /// One vector at each point or cell.
    #[must_use]
    pub fn vectors(name: &str, vectors: &[[f64; 3]]) -> Self {
        Self {
            name: name.to_owned(),
            components: 3,
            numbers: vectors.iter().flatten().copied().collect(),
        }
    }

    /// Checks that the count matches the points or cells.
    fn fit(&self, count: usize) -> io::Result<()> {
        match count.checked_mul(self.components) == Some(self.numbers.len()) {
            true => Ok(()),
            false => Err(unfit(&format!(
                "`{}` has {} numbers, but {count} times {} are needed",
                self.name,
                self.numbers.len(),
                self.components
            ))),
        }
    }

    fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        let words = self.numbers.iter().map(|x| x.to_le_bytes());
        array(file, "Float64", &self.name, self.components, words)
    }
}

fn unfit(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why.to_owned())
}

/// The values of points or of cells, within their element.
fn data(file: &mut dyn Write, element: &str, values: &[Values], count: usize) -> io::Result<()> {
    values.iter().try_for_each(|v| v.fit(count))?;
    writeln!(file, "<{element}>")?;
    values.iter().try_for_each(|v| v.write(file))?;
    writeln!(file, "</{element}>")
}

/// One array of eight-byte words, preceded by their length in bytes, in a single base64 block.
fn array(
    file: &mut dyn Write,
    kind: &str,
    name: &str,
    components: usize,
    words: impl ExactSizeIterator<Item = [u8; 8]>,
) -> io::Result<()> {
    let name = escaped(name);
    write!(
        file,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">"
    )?;
    let mut encoder = Encoder::new(&mut *file);
    encoder.push(&(8 * words.len() as u64).to_le_bytes())?;
    for word in words {
        encoder.push(&word)?;
    }
    encoder.finish()?;
    writeln!(file, "</DataArray>")
}

/// Text within quotes.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests;
