//! Arrays of an npz: a zip of npy files, written by `numpy.savez` or by a run as trajectory.npz. Takes the
//! file; gives its arrays by name, with shapes and numbers. Formats: PKWARE APPNOTE 6.3 (4.3.7, 4.3.12,
//! 4.3.16), NEP 1. Only uncompressed members are read.

use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Sizes in bytes of the record at the end of a zip, and of the longest comment after it.
const END: usize = 22;
const COMMENT: usize = 0xffff;

/// An open npz.
#[derive(Debug)]
pub(crate) struct Archive {
    file: File,
    /// Its name, for messages.
    name: String,
    members: Vec<Member>,
}

/// A file of the zip, as its directory lists it.
#[derive(Clone, Debug)]
struct Member {
    name: String,
    method: u16,
    sum: u32,
    size: u32,
    offset: u32,
}

/// An array of numbers.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    /// The length along each index.
    pub shape: Vec<usize>,
    entry: Entry,
    /// Whether the first index runs fastest.
    fortran: bool,
    data: Vec<u8>,
}

/// How an entry is written, lowest byte first.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Entry {
    Float(usize),
    Signed(usize),
    Unsigned(usize),
}

impl Archive {
    /// Opens a file.
    ///
    /// # Errors
    /// The file cannot be read, or it is not a zip archive.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let name = shown(path).to_string();
        let unread = |error: std::io::Error| format!("cannot read {name}: {error}");
        let mut file = File::open(path).map_err(unread)?;
        let length = file.seek(SeekFrom::End(0)).map_err(unread)?;
        let tail = length.min((END + COMMENT) as u64);
        let last = bytes(&mut file, length - tail, tail).map_err(unread)?;
        let ends = last
            .windows(END)
            .rposition(|w| w.starts_with(b"PK\x05\x06"));
        let Some(end) = ends.and_then(|at| last.get(at..)) else {
            let first = bytes(&mut file, 0, length.min(6)).map_err(unread)?;
            return Err(match first.starts_with(b"\x93NUMPY") {
                true => format!(
                    "{name} is a single array, written by numpy.save: write an npz with numpy.savez, with a name for each array"
                ),
                false => format!("{name} is not an npz file"),
            });
        };
        let [size, start] = [12, 16].map(|at| end.get(at..).map_or(0, |b| number(b, 4)));
        if start + size > length {
            return Err(format!(
                "{name} is truncated, or larger than 4 GiB, which clebsch does not read"
            ));
        }
        let directory = bytes(&mut file, start, size).map_err(unread)?;
        let mut members = Vec::new();
        let mut rest = directory.as_slice();
        while let Some(head) = rest.get(..46).filter(|h| h.starts_with(b"PK\x01\x02")) {
            let field = |at: usize, size: usize| head.get(at..).map_or(0, |b| number(b, size));
            let lengths = [28, 30, 32].map(|at| field(at, 2) as usize);
            let own = rest.get(46..46 + lengths[0]).unwrap_or_default();
            let own = String::from_utf8_lossy(own).into_owned();
            members.push(Member {
                name: own.strip_suffix(".npy").map_or(own.clone(), str::to_owned),
                method: field(10, 2) as u16,
                sum: field(16, 4) as u32,
                size: field(20, 4) as u32,
                offset: field(42, 4) as u32,
            });
            let next = 46 + lengths.iter().sum::<usize>();
            rest = rest.get(next..).unwrap_or_default();
        }
        Ok(Archive {
            file,
            name,
            members,
        })
    }

    /// Its name, for messages.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The names of its arrays.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().map(|m| m.name.as_str())
    }

    /// Whether it has an array of this name.
    pub(crate) fn has(&self, array: &str) -> bool {
        self.members.iter().any(|m| m.name == array)
    }

    /// The array with this name.
    ///
    /// # Errors
    /// There is no such array, or it is not numeric, compressed or damaged.
    pub(crate) fn array(&self, array: &str) -> Result<Array, String> {
        let name = &self.name;
        let member = self.members.iter().find(|m| m.name == array);
        let member = member.ok_or_else(|| {
            let known = self.members.iter().map(|m| m.name.as_str());
            match self.members.is_empty() {
                true => format!("{name} has no arrays"),
                false => format!(
                    "{name} has no array `{}`{}",
                    shown(array),
                    did_you_mean(array, known)
                ),
            }
        })?;
        if member.method != 0 {
            return Err(format!(
                "{name} is compressed, by numpy.savez_compressed: write it with numpy.savez"
            ));
        }
        let damaged = || format!("{name} is damaged: `{}` cannot be read", shown(array));
        let unread = |error: std::io::Error| format!("cannot read {name}: {error}");
        let mut file = &self.file;
        let length = file.seek(SeekFrom::End(0)).map_err(unread)?;
        let offset = u64::from(member.offset);
        if offset + 30 > length {
            return Err(damaged());
        }
        // The name and the extra field may have other lengths here than in the directory.
        let head = bytes(&mut file, offset, 30).map_err(unread)?;
        let behind =
            head.get(26..).map_or(0, |b| number(b, 2)) + head.get(28..).map_or(0, |b| number(b, 2));
        let (start, size) = (offset + 30 + behind, u64::from(member.size));
        if !head.starts_with(b"PK\x03\x04") || start + size > length {
            return Err(damaged());
        }
        let data = bytes(&mut file, start, size).map_err(unread)?;
        if crc32fast::hash(&data) != member.sum {
            return Err(damaged());
        }
        Array::read(data).map_err(|why| match why {
            Some(kind) => format!(
                "the array `{}` of {name} has entries of type `{}`: save floating-point or whole numbers of one to eight \
                 bytes, little-endian, such as numpy's float64",
                shown(array),
                shown(&kind)
            ),
            None => damaged(),
        })
    }
}

/// Reads this many bytes of a file.
fn bytes(mut file: impl Read + Seek, from: u64, size: u64) -> std::io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(from))?;
    let mut out = Vec::new();
    file.take(size).read_to_end(&mut out)?;
    Ok(out)
}

/// The number in the first bytes, lowest first.
fn number(bytes: &[u8], size: usize) -> u64 {
    let own = bytes.iter().take(size).enumerate();
    own.fold(0, |sum, (k, byte)| sum | u64::from(*byte) << (8 * k))
}

impl Array {
    /// The array in an npy file. The error is the type of the entries if they are not numbers, and `None` if
    /// the file is damaged.
    fn read(mut npy: Vec<u8>) -> Result<Self, Option<String>> {
        let head = npy.get(..12).filter(|h| h.starts_with(b"\x93NUMPY"));
        let head = head.ok_or(None)?;
        let (from, size) = match head.get(6) {
            Some(1) => (10, 2),
            _ => (12, 4),
        };
        let length = head.get(8..).map_or(0, |b| number(b, size)) as usize;
        let text = npy.get(from..from + length).ok_or(None)?;
        let text = String::from_utf8_lossy(text).into_owned();
        let value = |key: &str| Some(text.split_once(&format!("'{key}':"))?.1.trim_start());
        let kind = value("descr").ok_or(None)?;
        let kind = match kind.strip_prefix('\'').and_then(|k| k.split_once('\'')) {
            Some((kind, _)) => kind,
            // Records are lists of names and types.
            None => {
                return Err(Some(
                    kind.split(']').next().unwrap_or_default().to_owned() + "]",
                ));
            }
        };
        let entry = Entry::named(kind).ok_or_else(|| Some(kind.to_owned()))?;
        let fortran = value("fortran_order").ok_or(None)?.starts_with("True");
        let shape = value("shape").and_then(|s| s.strip_prefix('(')?.split_once(')'));
        let shape = shape.ok_or(None)?.0.split(',').map(str::trim);
        let shape: Result<Vec<usize>, _> =
            shape.filter(|n| !n.is_empty()).map(str::parse).collect();
        let shape = shape.map_err(|_| None)?;
        let count = shape
            .iter()
            .try_fold(entry.size(), |n, m| n.checked_mul(*m));
        npy.drain(..from + length);
        match count == Some(npy.len()) {
            true => Ok(Array {
                shape,
                entry,
                fortran,
                data: npy,
            }),
            false => Err(None),
        }
    }

    /// `count` numbers from index `from`, in row-major order.
    pub(crate) fn numbers(&self, from: usize, count: usize) -> Vec<f64> {
        let size = self.entry.size();
        let at = |index: usize| {
            let index = match self.fortran {
                true => self.in_fortran(index),
                false => index,
            };
            let own = self.data.get(index * size..(index + 1) * size);
            own.map_or(f64::NAN, |bytes| self.entry.value(bytes))
        };
        (from..from + count).map(at).collect()
    }

    /// Converts a row-major index to the index of the same entry in column-major order.
    fn in_fortran(&self, index: usize) -> usize {
        let mut rest = index;
        let mut stride = self.shape.iter().product::<usize>();
        let mut at = 0;
        for n in self.shape.iter().rev() {
            stride /= n;
            at += stride * (rest % n);
            rest /= n;
        }
        at
    }
}

impl Entry {
    /// The entry type that numpy writes as `kind`. `None` if it is big-endian or not a number.
    fn named(kind: &str) -> Option<Self> {
        let kind = kind.strip_prefix(['<', '|'])?;
        let (letter, size) = kind.split_at_checked(1)?;
        let size: usize = size.parse().ok()?;
        match (letter, size) {
            ("f", 4 | 8) => Some(Entry::Float(size)),
            ("i", 1 | 2 | 4 | 8) => Some(Entry::Signed(size)),
            ("u", 1 | 2 | 4 | 8) => Some(Entry::Unsigned(size)),
            _ => None,
        }
    }

    fn size(self) -> usize {
        match self {
            Entry::Float(size) | Entry::Signed(size) | Entry::Unsigned(size) => size,
        }
    }

    #[allow(clippy::cast_precision_loss)]
    fn value(self, bytes: &[u8]) -> f64 {
        let bits = number(bytes, self.size());
        match self {
            Entry::Float(4) => f64::from(f32::from_bits(bits as u32)),
            Entry::Float(_) => f64::from_bits(bits),
            Entry::Unsigned(_) => bits as f64,
            Entry::Signed(size) => {
                let unused = 64 - 8 * size;
                ((bits << unused) as i64 >> unused) as f64
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Array;

    fn npy(kind: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let text =
            format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
        let mut out = b"\x93NUMPY\x01\x00".to_vec();
        out.extend((text.len() as u16).to_le_bytes());
        out.extend(text.into_bytes());
        out.extend(data);
        out
    }

    #[test]
    fn entries_are_read_in_their_types_and_orders() {
        let whole = |kind: &str, data: &[u8]| {
            let array = Array::read(npy(kind, "False", "(2,)", data)).expect("reads");
            assert_eq!(array.shape, [2]);
            array.numbers(0, 2)
        };
        assert_eq!(whole("|i1", &[1, 255]), [1.0, -1.0]);
        assert_eq!(whole("|u1", &[1, 255]), [1.0, 255.0]);
        assert_eq!(whole("<i2", &[0, 1, 254, 255]), [256.0, -2.0]);
        assert_eq!(whole("<f4", &[0, 0, 192, 63, 0, 0, 0, 128]), [1.5, -0.0]);
        let least = i64::MIN.to_le_bytes();
        assert_eq!(
            whole("<i8", &[least, 7_i64.to_le_bytes()].concat()),
            [-(2.0_f64.powi(63)), 7.0]
        );
        // [[0, 2, 4], [1, 3, 5]], column after column.
        let array = Array::read(npy("|u1", "True", "(2, 3)", &[0, 1, 2, 3, 4, 5])).expect("reads");
        assert_eq!(array.numbers(0, 6), [0.0, 2.0, 4.0, 1.0, 3.0, 5.0]);
        assert_eq!(array.numbers(3, 2), [1.0, 3.0]);
        let scalar = Array::read(npy("|u1", "False", "()", &[9])).expect("reads");
        assert_eq!((scalar.shape.len(), scalar.numbers(0, 1)), (0, vec![9.0]));
    }

    #[test]
    fn what_is_no_number_or_cut_short_is_refused() {
        for kind in [">f8", "|O", "<U4", "<c16", "|b1", "<f2", "|S3"] {
            let read = Array::read(npy(kind, "False", "(1,)", &[0; 16]));
            assert_eq!(read.err(), Some(Some(kind.to_owned())));
        }
        for (shape, bytes) in [
            ("(2,)", 15),
            ("(2, 9223372036854775808)", 16),
            ("(x,)", 8),
            ("2", 16),
        ] {
            let read = Array::read(npy("<f8", "False", shape, &vec![0; bytes]));
            assert_eq!(read.err(), Some(None), "{shape}");
        }
        assert_eq!(Array::read(b"\x93NUMPY\x01".to_vec()).err(), Some(None));
    }
}
