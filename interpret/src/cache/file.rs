//! A file of the cache: texts, each after its length, then a checksum of all bytes before it. A file appears under its
//! name only when it is complete, so that concurrent processes and killed ones leave no half-written file.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

/// The extension of complete files.
pub const EXTENSION: &str = "derived";

/// The extension of files that are being written.
pub const PARTIAL: &str = "partial";

/// The length of the checksum, eight hexadecimal digits.
const CHECKSUM: usize = 8;

/// The bytes of a file with these texts.
pub fn packed(texts: &[&str]) -> Vec<u8> {
    let mut out = Vec::new();
    for text in texts {
        out.extend(format!("{}\n{text}\n", text.len()).as_bytes());
    }
    let checksum = format!("{:08x}", crc32fast::hash(&out));
    out.extend(checksum.as_bytes());
    out
}

/// The texts of a file. `None` if the file is not complete or has changed.
pub fn unpacked(bytes: &[u8]) -> Option<Vec<&str>> {
    let (body, checksum) = bytes.split_at_checked(bytes.len().checked_sub(CHECKSUM)?)?;
    if checksum != format!("{:08x}", crc32fast::hash(body)).as_bytes() {
        return None;
    }
    let mut rest = std::str::from_utf8(body).ok()?;
    let mut texts = Vec::new();
    while !rest.is_empty() {
        let (length, after) = rest.split_once('\n')?;
        let (text, after) = after.split_at_checked(length.parse().ok()?)?;
        texts.push(text);
        rest = after.strip_prefix('\n')?;
    }
    Some(texts)
}

/// The bytes of a file of at most `most` bytes, which becomes the most recently used one.
pub fn read(path: &Path, most: u64) -> Option<Vec<u8>> {
    let file = File::open(path).ok()?;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes).ok()?;
    // A folder that cannot be written keeps the old times.
    if let Ok(file) = File::options().append(true).open(path) {
        let _ = file.set_modified(SystemTime::now());
    }
    Some(bytes)
}

/// Writes a file under another name and then renames it. `None` if this fails.
pub fn write(path: &Path, bytes: &[u8]) -> Option<()> {
    /// Distinguishes the threads of a process.
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let next = NEXT.fetch_add(1, Ordering::Relaxed);
    let name = path.file_stem()?.to_string_lossy().into_owned();
    let partial = path.with_file_name(format!("{name}-{}-{next}.{PARTIAL}", std::process::id()));
    let written = File::create_new(&partial).and_then(|mut file| file.write_all(bytes));
    let written = written.and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        let _ = fs::remove_file(&partial);
    }
    written.ok()
}
