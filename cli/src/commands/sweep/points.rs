//! The points of a sweep on disk: for each point a row of eight-byte numbers with its own checksum, at a fixed
//! offset.
//! Takes rows in any order from several threads; after a restart it finds the complete rows.

use crate::output::samples::{self, Rows};
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// The file.
pub(super) struct Points {
    file: File,
    /// Words in a row, including the checksum at its end.
    width: usize,
    count: u64,
}

fn sum(words: &[u64]) -> u64 {
    let mut sum = crc32fast::Hasher::new();
    words
        .iter()
        .for_each(|word| sum.update(&word.to_le_bytes()));
    // A row of zeros, which was never written, has a different checksum.
    u64::from(sum.finalize()) | 1 << 32
}

impl Points {
    /// Opens the file in a folder, or creates it, for `count` rows of `width` words plus the checksum.
    pub(super) fn open(folder: &Path, width: usize, count: u64) -> io::Result<Self> {
        let path = folder.join(samples::NAME);
        let options = &mut OpenOptions::new();
        let file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)?;
        let width = width + 1;
        file.set_len(count.saturating_mul(8 * width as u64))?;
        Ok(Self { file, width, count })
    }

    /// For each point from `first` on, whether its row is complete.
    pub(super) fn there(&mut self, first: u64) -> io::Result<Vec<bool>> {
        self.file.seek(SeekFrom::Start(0))?;
        let mut file = BufReader::new(&self.file);
        let mut bytes = vec![0; 8 * self.width];
        let mut row = vec![0; self.width];
        let mut there = Vec::new();
        for number in 0..self.count {
            file.read_exact(&mut bytes)?;
            for (word, eight) in row.iter_mut().zip(bytes.as_chunks::<8>().0) {
                *word = u64::from_le_bytes(*eight);
            }
            let whole = row.split_last().is_some_and(|(known, words)| {
                *known == sum(words) && words.first() == Some(&(first + number))
            });
            there.push(whole);
        }
        Ok(there)
    }

    /// Writes the row with this number.
    pub(super) fn put(&mut self, number: u64, words: &[u64]) -> io::Result<()> {
        let bytes: Vec<u8> = words
            .iter()
            .chain([&sum(words)])
            .flat_map(|word| word.to_le_bytes())
            .collect();
        self.file
            .seek(SeekFrom::Start(number * 8 * self.width as u64))?;
        self.file.write_all(&bytes)
    }

    /// All rows, flushed to disk.
    pub(super) fn into_rows(self, folder: &Path) -> io::Result<Rows> {
        self.file.sync_all()?;
        Ok(Rows::of(
            &folder.join(samples::NAME),
            self.width,
            self.count,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::Points;
    use std::fs;

    #[test]
    fn rows_are_known_by_their_own_checksum() {
        let folder = std::env::temp_dir().join(format!("clebsch-points-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let mut points = Points::open(&folder, 2, 4).expect("made");
        assert_eq!(points.there(10).expect("read"), [false; 4]);
        points.put(2, &[12, 5]).expect("written");
        points.put(0, &[10, 0]).expect("written");
        points.put(3, &[99, 0]).expect("another point");
        assert_eq!(points.there(10).expect("read"), [true, false, true, false]);
        let mut again = Points::open(&folder, 2, 4).expect("opened");
        assert_eq!(again.there(10).expect("read"), [true, false, true, false]);
        fs::remove_dir_all(&folder).expect("removed");
    }
}
