//! Samples as npz, which `numpy.load` reads: a zip of stored npy arrays, one per quantity.
//! Takes the rows of a run; writes array after array without holding any. Formats: NEP 1 (npy 1.0) and
//! PKWARE APPNOTE 6.3 (sections 4.3.7, 4.3.12, 4.3.16). Every member is dated 1980-01-01.

use super::{Rows, names};
use crate::card::Card;
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;

/// A named array, row-major; mostly its first index is the sample.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    name: String,
    shape: Vec<usize>,
    entries: Entries,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Entries {
    /// The words of every row in these ranges, in order; `counts` tells whether they are integers.
    Columns {
        columns: Vec<Range<usize>>,
        counts: bool,
    },
    /// Numbers that do not come from rows.
    Numbers(Vec<u64>),
}

impl Array {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its length along each index.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The ranges of words that it takes from a row; for an array that takes nothing from rows, its numbers as the
    /// error.
    ///
    /// # Errors
    /// The counts of an array that takes nothing of the rows.
    pub fn columns(&self) -> Result<&[Range<usize>], &[u64]> {
        match &self.entries {
            Entries::Columns { columns, .. } => Ok(columns),
            Entries::Numbers(numbers) => Err(numbers),
        }
    }

    /// An array of `samples` times `shape` numbers: the words `columns` of every row, range by range.
    #[must_use]
    pub fn of_columns(
        name: &str,
        samples: u64,
        shape: &[usize],
        columns: Vec<Range<usize>>,
    ) -> Self {
        let samples = usize::try_from(samples).unwrap_or(usize::MAX);
        let mut whole = vec![samples];
        whole.extend(shape);
        Self {
            name: name.to_owned(),
            shape: whole,
            entries: Entries::Columns {
                columns,
                counts: false,
            },
        }
    }

    /// The array of the nodes: the first word of every row, an integer.
    #[must_use]
    pub fn of_nodes(name: &str, samples: u64) -> Self {
        let mut array = Self::of_columns(name, samples, &[], std::iter::once(0..1).collect());
        if let Entries::Columns { counts, .. } = &mut array.entries {
            *counts = true;
        }
        array
    }

    /// An array of given counts, independent of the rows.
    #[must_use]
    pub fn of_numbers(name: &str, numbers: Vec<u64>) -> Self {
        Self {
            name: name.to_owned(),
            shape: vec![numbers.len()],
            entries: Entries::Numbers(numbers),
        }
    }
}

/// The shape of one value: empty for a number, the rows of a vector, the rows and columns of a matrix.
#[must_use]
fn shape(rows: usize, cols: usize) -> Vec<usize> {
    match (rows, cols) {
        (1, 1) => vec![],
        (rows, 1) => vec![rows],
        (rows, cols) => vec![rows, cols],
    }
}

/// All arrays of a run: `node`, `time`, the observables, the invariants.
#[must_use]
pub fn arrays(card: &Card, samples: u64) -> Vec<Array> {
    let mut arrays = vec![
        Array::of_nodes("node", samples),
        Array::of_columns("time", samples, &[], std::iter::once(1..2).collect()),
    ];
    let mut from = 2;
    let mut next = |count: usize| {
        let here = from..from + count;
        from = here.end;
        std::iter::once(here).collect()
    };
    for field in card.observables {
        let shape = shape(field.rows, field.cols);
        arrays.push(Array::of_columns(
            field.ascii,
            samples,
            &shape,
            next(field.count()),
        ));
    }
    for invariant in card.invariants {
        let (name, shape) = (names::invariant(invariant), shape(invariant.rows, 1));
        arrays.push(Array::of_columns(
            &name,
            samples,
            &shape,
            next(invariant.rows),
        ));
    }
    arrays
}

impl Array {
    /// The npy header: magic, version 1.0, dictionary padded so that the data are 64-byte aligned.
    fn header(&self) -> Vec<u8> {
        let kind = match self.entries {
            Entries::Columns { counts: false, .. } => "<f8",
            Entries::Columns { .. } | Entries::Numbers(_) => "<u8",
        };
        // A tuple with one entry needs a trailing comma; longer tuples may have one.
        let shape: String = self.shape.iter().map(|n| format!("{n}, ")).collect();
        let mut text = format!(
            "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}",
            shape.trim_end()
        );
        let before = 10 + text.len() + 1;
        text.push_str(&" ".repeat(before.next_multiple_of(64) - before));
        text.push('\n');
        let mut header = b"\x93NUMPY\x01\x00".to_vec();
        header.extend(length(text.len()).to_le_bytes());
        header.extend(text.into_bytes());
        header
    }

    /// Bytes of the data.
    fn size(&self) -> usize {
        8 * self.shape.iter().product::<usize>()
    }

    /// Shows the data, eight bytes at a time.
    fn each(
        &self,
        rows: &dyn Rows,
        mut show: impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        match &self.entries {
            Entries::Numbers(list) => list.iter().try_for_each(|n| show(&n.to_le_bytes())),
            Entries::Columns { columns, .. } => rows.each(&mut |row| {
                let cells = columns
                    .iter()
                    .flat_map(|c| row.get(c.clone()).into_iter().flatten());
                cells.into_iter().try_for_each(|x| show(&x.to_le_bytes()))
            }),
        }
    }
}

/// A header of an array of at most three numbers stays far below 64 kB.
fn length(bytes: usize) -> u16 {
    u16::try_from(bytes).unwrap_or(u16::MAX)
}

/// A written member, for the directory at the end of the zip.
struct Member {
    name: String,
    crc: u32,
    size: u32,
    offset: u32,
}

impl Member {
    /// The fields that the local header and the directory share (4.3.7).
    fn common(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(26);
        let stored = [20_u16, 0, 0, 0, 0x0021];
        stored
            .iter()
            .for_each(|field| bytes.extend(field.to_le_bytes()));
        for field in [self.crc, self.size, self.size] {
            bytes.extend(field.to_le_bytes());
        }
        bytes.extend(length(self.name.len()).to_le_bytes());
        bytes.extend(0_u16.to_le_bytes());
        bytes
    }
}

/// Writes `arrays` of `rows` as the members of an npz, from the current position of `file`.
///
/// # Errors
/// The errors of `file` and of the rows. `InvalidInput` beyond the 4 GiB of a classic zip, or if an array was made for
/// another number of samples or for longer rows.
pub fn write(file: &mut (impl Write + Seek), rows: &dyn Rows, arrays: &[Array]) -> io::Result<()> {
    let too_large = |_| io::Error::new(io::ErrorKind::InvalidInput, "more than 4 GiB");
    let begin = file.stream_position()?;
    let mut members: Vec<Member> = Vec::with_capacity(arrays.len());
    let mut offset = 0_usize;
    for array in arrays {
        let header = array.header();
        let mut member = Member {
            name: format!("{}.npy", array.name),
            // Set when the data are written.
            crc: 0,
            size: u32::try_from(header.len() + array.size()).map_err(too_large)?,
            offset: u32::try_from(offset).map_err(too_large)?,
        };
        file.write_all(b"PK\x03\x04")?;
        file.write_all(&member.common())?;
        file.write_all(member.name.as_bytes())?;
        file.write_all(&header)?;
        let mut crc = crc32fast::Hasher::new();
        crc.update(&header);
        let mut written = 0;
        array.each(rows, |bytes| {
            crc.update(bytes);
            written += bytes.len();
            file.write_all(bytes)
        })?;
        if written != array.size() {
            let message = format!(
                "the array `{}` has space for {} bytes, but the rows have {written}: create it for as many samples",
                array.name,
                array.size()
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        member.crc = crc.finalize();
        file.seek(SeekFrom::Start(begin + u64::from(member.offset) + 4))?;
        file.write_all(&member.common())?;
        offset += 30 + member.name.len() + header.len() + array.size();
        file.seek(SeekFrom::Start(begin + offset as u64))?;
        members.push(member);
    }
    let start = u32::try_from(offset).map_err(too_large)?;
    let mut size = 0;
    for member in &members {
        file.write_all(b"PK\x01\x02\x14\x00")?;
        file.write_all(&member.common())?;
        // No comment, disk 0, no attributes.
        file.write_all(&[0; 10])?;
        file.write_all(&member.offset.to_le_bytes())?;
        file.write_all(member.name.as_bytes())?;
        size += 46 + member.name.len();
    }
    let count = length(members.len()).to_le_bytes();
    file.write_all(b"PK\x05\x06\x00\x00\x00\x00")?;
    file.write_all(&count)?;
    file.write_all(&count)?;
    file.write_all(&u32::try_from(size).map_err(too_large)?.to_le_bytes())?;
    file.write_all(&start.to_le_bytes())?;
    file.write_all(&[0; 2])
}

#[cfg(test)]
mod tests {
    use super::{Array, Rows, write};
    use std::io::{self, Cursor, Seek, SeekFrom};

    /// Five rows of a node and a time.
    struct Five;

    impl Rows for Five {
        fn count(&self) -> u64 {
            5
        }

        fn each(&self, show: &mut dyn FnMut(&[u64]) -> io::Result<()>) -> io::Result<()> {
            (0..5).try_for_each(|k| show(&[k, (0.5 * k as f64).to_bits()]))
        }
    }

    #[test]
    fn an_archive_begins_where_the_file_stands() {
        let arrays = [Array::of_nodes("node", 5)];
        let mut alone = Cursor::new(Vec::new());
        write(&mut alone, &Five, &arrays).expect("writes");
        let mut after = Cursor::new(b"before".to_vec());
        after.seek(SeekFrom::End(0)).expect("seeks");
        write(&mut after, &Five, &arrays).expect("writes");
        let after = after.into_inner();
        assert_eq!(after.split_at(6), (&b"before"[..], &alone.into_inner()[..]));
    }

    #[test]
    fn headers_end_where_the_format_of_numpy_wants_data_to_begin() {
        let arrays = [
            Array::of_nodes("node", 5),
            Array::of_nodes("a_longer_name", 123_456_789),
        ];
        for array in arrays {
            let header = array.header();
            let length = u16::from_le_bytes([header[8], header[9]]);
            assert_eq!(usize::from(length), header.len() - 10);
            assert!(header.len().is_multiple_of(64) && header.len() <= 128);
            assert!(header.ends_with(b" \n") || header.ends_with(b"}\n"));
        }
    }

    #[test]
    fn arrays_of_other_lengths_are_refused() {
        let told = write(
            &mut Cursor::new(Vec::new()),
            &Five,
            &[Array::of_nodes("node", 99)],
        );
        let told = told.expect_err("refused");
        assert_eq!(told.kind(), io::ErrorKind::InvalidInput);
        assert!(told.to_string().contains("space for 792 bytes"), "{told}");
    }
}
