//! The trajectory as npz, which `numpy.load` reads: a zip of stored npy arrays, one per quantity.
//! Takes named arrays; writes them without holding a second copy. Formats: NEP 1 (npy 1.0) and
//! PKWARE APPNOTE 6.3 (sections 4.3.7, 4.3.12, 4.3.16). Every member is dated 1980-01-01.

use super::names;
use super::sites::{AtSites, at_sites};
use crate::record::{Record, Table};
use clebsch::card::Card;
use std::io::{self, Write};
use std::ops::Range;

/// A named array whose first index is the sample.
pub(super) struct Array<'a> {
    name: String,
    shape: Vec<usize>,
    entries: Entries<'a>,
}

enum Entries<'a> {
    Nodes(&'a [u64]),
    Times(&'a [f64]),
    /// Columns `from .. from + width` of a table.
    Columns {
        table: &'a Table,
        from: usize,
        width: usize,
    },
    /// Columns of a table, one range for each site.
    Sites {
        table: &'a Table,
        columns: Vec<Range<usize>>,
    },
    /// The numbers of the sites.
    Numbers(Vec<u64>),
}

/// All arrays of a record: `node`, `time`, the observables, the invariants.
pub(super) fn arrays<'a>(card: &Card, record: &'a Record) -> Vec<Array<'a>> {
    let samples = record.nodes.len();
    let mut arrays = vec![
        Array {
            name: "node".to_owned(),
            shape: vec![samples],
            entries: Entries::Nodes(&record.nodes),
        },
        Array {
            name: "time".to_owned(),
            shape: vec![samples],
            entries: Entries::Times(&record.times),
        },
    ];
    let mut push = |name: String, rows: usize, cols: usize, table: &'a Table, from: &mut usize| {
        let width = rows * cols;
        let shape = match (rows, cols) {
            (1, 1) => vec![samples],
            (rows, 1) => vec![samples, rows],
            (rows, cols) => vec![samples, rows, cols],
        };
        let entries = Entries::Columns {
            table,
            from: *from,
            width,
        };
        *from += width;
        arrays.push(Array {
            name,
            shape,
            entries,
        });
    };
    let at_sites = at_sites(card);
    let mut from = 0;
    for field in card.observables {
        let of_a_site = |q: &AtSites<'_>| q.members.iter().any(|(_, c)| c.start == from);
        if at_sites.iter().any(of_a_site) {
            from += field.count();
            continue;
        }
        let name = field.ascii.to_owned();
        push(name, field.rows, field.cols, &record.observables, &mut from);
    }
    let mut from = 0;
    for invariant in card.invariants {
        let name = names::invariant(invariant);
        push(name, invariant.rows, 1, &record.invariants, &mut from);
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
            arrays.push(Array {
                name: format!("sites_of_{}", q.key),
                shape: vec![q.members.len()],
                entries: Entries::Numbers(numbers.collect()),
            });
        }
        arrays.push(Array {
            name: q.key,
            shape,
            entries: Entries::Sites {
                table: &record.observables,
                columns: q.members.into_iter().map(|(_, c)| c).collect(),
            },
        });
    }
    arrays
}

impl Array<'_> {
    /// The npy header: magic, version 1.0, dictionary padded so that the data are 64-byte aligned.
    fn header(&self) -> Vec<u8> {
        let kind = match self.entries {
            Entries::Nodes(_) | Entries::Numbers(_) => "<u8",
            Entries::Times(_) | Entries::Columns { .. } | Entries::Sites { .. } => "<f8",
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
            Entries::Sites { table, columns } => table.rows().try_for_each(|row| {
                let cells = columns
                    .iter()
                    .flat_map(|c| row.get(c.clone()).into_iter().flatten());
                cells.into_iter().try_for_each(|x| show(&x.to_le_bytes()))
            }),
            Entries::Nodes(nodes) => nodes.iter().try_for_each(|node| show(&node.to_le_bytes())),
            Entries::Times(times) => times.iter().try_for_each(|time| show(&time.to_le_bytes())),
            Entries::Columns { table, from, width } => table.rows().try_for_each(|row| {
                let columns = row.iter().skip(*from).take(*width);
                columns.into_iter().try_for_each(|x| show(&x.to_le_bytes()))
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
pub(super) fn write(file: &mut dyn Write, arrays: &[Array<'_>]) -> io::Result<()> {
    let too_large = |_| io::Error::new(io::ErrorKind::InvalidInput, "more than 4 GiB");
    let mut members: Vec<Member> = Vec::with_capacity(arrays.len());
    let mut offset = 0_usize;
    for array in arrays {
        let header = array.header();
        let mut crc = crc32fast::Hasher::new();
        crc.update(&header);
        array.each(|bytes| {
            crc.update(bytes);
            Ok(())
        })?;
        let member = Member {
            name: format!("{}.npy", array.name),
            crc: crc.finalize(),
            size: u32::try_from(header.len() + array.size()).map_err(too_large)?,
            offset: u32::try_from(offset).map_err(too_large)?,
        };
        file.write_all(b"PK\x03\x04")?;
        file.write_all(&member.common())?;
        file.write_all(member.name.as_bytes())?;
        file.write_all(&header)?;
        array.each(|bytes| file.write_all(bytes))?;
        offset += 30 + member.name.len() + header.len() + array.size();
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
