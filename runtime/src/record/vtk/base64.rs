//! Bytes in the 64 characters of RFC 4648, section 4. Takes bytes in pieces; writes characters, padded with `=` at
//! the end.

use std::io::{self, Write};

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Characters are written in pieces of about this size.
const STRETCH: usize = 4096;

/// An encoder between two writes.
pub(super) struct Encoder<'a> {
    file: &'a mut dyn Write,
    /// Bytes that wait for a third one.
    waiting: [u8; 3],
    count: usize,
    letters: Vec<u8>,
}

impl<'a> Encoder<'a> {
    pub(super) fn new(file: &'a mut dyn Write) -> Self {
        Self {
            file,
            waiting: [0; 3],
            count: 0,
            letters: Vec::with_capacity(STRETCH + 4),
        }
    }

    pub(super) fn push(&mut self, bytes: &[u8]) -> io::Result<()> {
        for byte in bytes {
            self.waiting[self.count] = *byte;
            self.count += 1;
            if self.count == 3 {
                self.letters.extend(letters(self.waiting));
                self.count = 0;
            }
        }
        if self.letters.len() >= STRETCH {
            self.file.write_all(&self.letters)?;
            self.letters.clear();
        }
        Ok(())
    }

    /// Writes the remaining bytes.
    pub(super) fn finish(mut self) -> io::Result<()> {
        if self.count > 0 {
            self.waiting[self.count..].fill(0);
            let last = letters(self.waiting);
            self.letters.extend(&last[..=self.count]);
            self.letters.extend(&b"=="[..3 - self.count]);
        }
        self.file.write_all(&self.letters)
    }
}

/// Encodes three bytes as four characters.
fn letters([a, b, c]: [u8; 3]) -> [u8; 4] {
    let sixes = [
        a >> 2,
        (a & 3) << 4 | b >> 4,
        (b & 15) << 2 | c >> 6,
        c & 63,
    ];
    sixes.map(|six| LETTERS[usize::from(six)])
}

#[cfg(test)]
mod tests {
    use super::Encoder;

    #[test]
    fn words_of_rfc_4648_are_encoded_as_there() {
        for (bytes, letters) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            let mut file = Vec::new();
            let mut encoder = Encoder::new(&mut file);
            for byte in bytes.as_bytes() {
                encoder.push(&[*byte]).expect("a list takes everything");
            }
            encoder.finish().expect("a list takes everything");
            assert_eq!(file, letters.as_bytes(), "{bytes}");
        }
    }
}
