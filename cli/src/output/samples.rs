//! The samples of a run on disk: rows of eight-byte numbers, appended during the run, read row by row for its files.
//! Takes the samples of the integration loop; gives rows. Memory does not grow with their number.

use clebsch::card::Card;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The name of the file. The file is removed when a run is complete.
pub(crate) const NAME: &str = "samples.bin";

/// Bytes read or written at once.
const BUFFER: usize = 1 << 18;

/// Numbers in a row: node, time, observables, invariants.
pub(crate) fn width(card: &Card) -> usize {
    2 + card.observable_count() + card.invariant_count()
}

/// The file while it grows.
#[derive(Debug)]
pub(crate) struct Stream {
    path: PathBuf,
    file: BufWriter<File>,
    width: usize,
    /// The bytes of one row.
    row: Vec<u8>,
    rows: u64,
    sum: crc32fast::Hasher,
    /// The first error. No row was written after it.
    failed: Option<io::Error>,
}

impl Stream {
    /// A new file in a folder.
    pub(crate) fn new(folder: &Path, card: &Card) -> io::Result<Self> {
        let path = folder.join(NAME);
        let file = File::create_new(&path)?;
        Ok(Self {
            path,
            file: BufWriter::with_capacity(BUFFER, file),
            width: width(card),
            row: Vec::new(),
            rows: 0,
            sum: crc32fast::Hasher::new(),
            failed: None,
        })
    }

    /// The file of a run that is resumed after `rows` rows with checksum `sum`. Later rows are dropped.
    /// `Ok(None)` if the file is too short or the checksum differs.
    pub(crate) fn again(
        folder: &Path,
        card: &Card,
        rows: u64,
        sum: u32,
    ) -> io::Result<Option<Self>> {
        let path = folder.join(NAME);
        let width = width(card);
        let Some(length) = rows.checked_mul(8 * width as u64) else {
            return Ok(None);
        };
        let mut file = OpenOptions::new().read(true).write(true).open(&path)?;
        if file.metadata()?.len() < length {
            return Ok(None);
        }
        let mut seen = crc32fast::Hasher::new();
        let mut left = (&file).take(length);
        let mut buffer = vec![0; BUFFER];
        loop {
            match left.read(&mut buffer)? {
                0 => break,
                read => seen.update(buffer.get(..read).unwrap_or_default()),
            }
        }
        if seen.clone().finalize() != sum {
            return Ok(None);
        }
        file.set_len(length)?;
        file.seek(SeekFrom::Start(length))?;
        Ok(Some(Self {
            path,
            file: BufWriter::with_capacity(BUFFER, file),
            width,
            row: Vec::new(),
            rows,
            sum: seen,
            failed: None,
        }))
    }

    /// Appends a row. An error is stored for [`Stream::settled`].
    pub(crate) fn push(&mut self, node: u64, time: f64, observables: &[f64], invariants: &[f64]) {
        if self.failed.is_some() {
            return;
        }
        let numbers = observables.iter().chain(invariants).map(|x| x.to_bits());
        self.row.clear();
        for word in [node, time.to_bits()].into_iter().chain(numbers) {
            self.row.extend(word.to_le_bytes());
        }
        self.sum.update(&self.row);
        match self.file.write_all(&self.row) {
            Ok(()) => self.rows += 1,
            Err(error) => self.failed = Some(error),
        }
    }

    /// Flushes everything so far to the disk; returns the number of rows and their checksum.
    pub(crate) fn settled(&mut self) -> io::Result<(u64, u32)> {
        self.check()?;
        self.file.flush()?;
        self.file.get_ref().sync_data()?;
        Ok((self.rows, self.sum.clone().finalize()))
    }

    /// The first error so far, if any.
    pub(crate) fn check(&mut self) -> io::Result<()> {
        self.failed.take().map_or(Ok(()), Err)
    }

    /// Closes the file; returns its rows.
    pub(crate) fn into_rows(mut self) -> io::Result<Rows> {
        self.check()?;
        self.file.flush()?;
        Ok(Rows {
            path: self.path.clone(),
            width: self.width,
            count: self.rows,
        })
    }
}

/// All rows of a run.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    path: PathBuf,
    width: usize,
    count: u64,
}

impl Rows {
    /// The rows of a file: `count` rows of `width` words.
    pub(crate) fn of(path: &Path, width: usize, count: u64) -> Self {
        Self {
            path: path.to_owned(),
            width,
            count,
        }
    }
}

impl clebsch::record::Rows for Rows {
    fn count(&self) -> u64 {
        self.count
    }

    fn each(&self, show: &mut dyn FnMut(&[u64]) -> io::Result<()>) -> io::Result<()> {
        let mut file = BufReader::with_capacity(BUFFER, File::open(&self.path)?);
        let mut bytes = vec![0; 8 * self.width];
        let mut row = vec![0; self.width];
        for _ in 0..self.count {
            file.read_exact(&mut bytes)?;
            for (word, eight) in row.iter_mut().zip(bytes.as_chunks::<8>().0) {
                *word = u64::from_le_bytes(*eight);
            }
            show(&row)?;
        }
        Ok(())
    }
}
