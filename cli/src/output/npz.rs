//! The trajectory as npz, which `numpy.load` reads: a zip of stored npy arrays, one per quantity.
//! Takes the rows of a run; writes array after array without holding any. Formats: NEP 1 (npy 1.0) and
//! PKWARE APPNOTE 6.3 (sections 4.3.7, 4.3.12, 4.3.16). Every member is dated 1980-01-01.

use super::names;
use super::samples::Rows;
use super::sites::at_sites;
use clebsch::card::Card;
use std::collections::HashSet;
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;

/// A named array whose first index is the sample.
pub(crate) struct Array<'a> {
    name: String,
    shape: Vec<usize>,
    entries: Entries<'a>,
}

enum Entries<'a> {
    /// Words of every row, one range after the other; whether they are counts.
    Columns {
        rows: &'a Rows,
        columns: Vec<Range<usize>>,
        counts: bool,
    },
    /// The numbers of the sites.
    Numbers(Vec<u64>),
}

/// All arrays of a run: `node`, `time`, the observables, the invariants.
pub(super) fn arrays<'a>(card: &Card, rows: &'a Rows) -> Vec<Array<'a>> {
    let samples = usize::try_from(rows.count).unwrap_or(usize::MAX);
    let columns = |columns: Vec<Range<usize>>, counts: bool| Entries::Columns {
        rows,
        columns,
        counts,
    };
    let array = |name: &str, shape: Vec<usize>, entries: Entries<'a>| Array {
        name: name.to_owned(),
        shape,
        entries,
    };
    let shaped = |rows: usize, cols: usize| match (rows, cols) {
        (1, 1) => vec![samples],
        (rows, 1) => vec![samples, rows],
        (rows, cols) => vec![samples, rows, cols],
    };
    let all = |range: Range<usize>| vec![range];
    let mut arrays = vec![
        array("node", vec![samples], columns(all(0..1), true)),
        array("time", vec![samples], columns(all(1..2), false)),
    ];
    let at_sites = at_sites(card);
    let of_sites = at_sites.iter().flat_map(|q| &q.members);
    let of_sites: HashSet<usize> = of_sites.map(|(_, c)| c.start).collect();
    // Where the observables begin in a row.
    let offset = 2;
    let mut from = offset;
    for field in card.observables {
        let here = from..from + field.count();
        from = here.end;
        if !of_sites.contains(&(here.start - offset)) {
            let shape = shaped(field.rows, field.cols);
            arrays.push(array(field.ascii, shape, columns(all(here), false)));
        }
    }
    for invariant in card.invariants {
        let here = from..from + invariant.rows;
        from = here.end;
        let (name, shape) = (names::invariant(invariant), shaped(invariant.rows, 1));
        arrays.push(array(&name, shape, columns(all(here), false)));
    }
    for q in at_sites {
        let (rows, cols) = (q.field.rows, q.field.cols);
        let mut shape = vec![samples, q.members.len()];
        shape.extend((rows * cols > 1).then_some(rows));
        shape.extend((cols > 1).then_some(cols));
        let whole = q
            .members
            .iter()
            .enumerate()
            .all(|(i, (site, _))| i == *site);
        if !whole {
            // Some site has its value given.
            let numbers = q.members.iter().map(|(site, _)| *site as u64);
            let name = format!("sites_of_{}", q.key);
            let entries = Entries::Numbers(numbers.collect());
            arrays.push(array(&name, vec![q.members.len()], entries));
        }
        let members = q.members.into_iter();
        let own = members.map(|(_, c)| c.start + offset..c.end + offset);
        arrays.push(array(&q.key, shape, columns(own.collect(), false)));
    }
    arrays
}

/// One array a column, the first of counts.
pub(crate) fn columns<'a>(names: &[String], rows: &'a Rows) -> Vec<Array<'a>> {
    let samples = usize::try_from(rows.count).unwrap_or(usize::MAX);
    let array = |(column, name): (usize, &String)| Array {
        name: name.clone(),
        shape: vec![samples],
        entries: Entries::Columns {
            rows,
            columns: std::iter::once(column..column + 1).collect(),
            counts: column == 0,
        },
    };
    names.iter().enumerate().map(array).collect()
}

impl Array<'_> {
    /// The npy header: magic, version 1.0, dictionary padded so that the data are 64-byte aligned.
    fn header(&self) -> Vec<u8> {
        let kind = match self.entries {
            Entries::Columns { counts: false, .. } => "<f8",
            Entries::Columns { .. } | Entries::Numbers(_) => "<u8",
        };
        // A tuple of one needs its comma; more may have it.
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
    fn each(&self, mut show: impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        match &self.entries {
            Entries::Numbers(list) => list.iter().try_for_each(|n| show(&n.to_le_bytes())),
            Entries::Columns { rows, columns, .. } => rows.each(|row| {
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

/// A member written, as the directory at the end of the zip repeats it.
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

/// Writes `arrays` as the members of an npz.
///
/// # Errors
/// Those of `file`, and `InvalidInput` beyond the 4 GiB of a classic zip.
pub(crate) fn write(file: &mut (impl Write + Seek), arrays: &[Array<'_>]) -> io::Result<()> {
    let too_large = |_| io::Error::new(io::ErrorKind::InvalidInput, "more than 4 GiB");
    let mut members: Vec<Member> = Vec::with_capacity(arrays.len());
    let mut offset = 0_usize;
    for array in arrays {
        let header = array.header();
        let mut member = Member {
            name: format!("{}.npy", array.name),
            // Known when the data are written.
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
        array.each(|bytes| {
            crc.update(bytes);
            file.write_all(bytes)
        })?;
        member.crc = crc.finalize();
        file.seek(SeekFrom::Start(u64::from(member.offset) + 4))?;
        file.write_all(&member.common())?;
        offset += 30 + member.name.len() + header.len() + array.size();
        file.seek(SeekFrom::Start(offset as u64))?;
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
