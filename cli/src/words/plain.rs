//! Text that a terminal shows and does not execute: control characters are escaped. A name may contain escape
//! sequences. Printing it must neither move the cursor nor fake a line.

use std::ffi::OsStr;
use std::fmt;
use std::io::{self, Write};
use std::path::Path;

/// Whether a terminal would execute the character rather than show it: control characters (C0, DEL, C1) and
/// characters that change the direction of writing.
fn acts(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || matches!(letter, '\u{2028}' | '\u{2029}')
}

/// A number of steps as text.
pub(crate) fn steps(count: u64) -> String {
    match count {
        1 => "1 step".to_owned(),
        n => format!("{n} steps"),
    }
}

/// A name for a message, on one line, every control character written `\u001b`.
pub(crate) struct PrintableName(String);

/// The name as a message shows it.
pub(crate) fn shown(name: impl MessageName) -> PrintableName {
    PrintableName(name.text())
}

/// A name in a message: a text, or a file, whose name need not be valid text.
pub(crate) trait MessageName {
    /// The name, with a replacement character for every invalid part.
    fn text(&self) -> String;
}

impl MessageName for &str {
    fn text(&self) -> String {
        (*self).to_owned()
    }
}

impl MessageName for &String {
    fn text(&self) -> String {
        (*self).clone()
    }
}

impl MessageName for &Path {
    fn text(&self) -> String {
        self.display().to_string()
    }
}

impl MessageName for &std::path::PathBuf {
    fn text(&self) -> String {
        self.display().to_string()
    }
}

impl MessageName for std::ffi::OsString {
    fn text(&self) -> String {
        OsStr::display(self).to_string()
    }
}

impl fmt::Display for PrintableName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|letter| match acts(letter) {
            true => write!(f, "\\u{:04x}", u32::from(letter)),
            false => write!(f, "{letter}"),
        })
    }
}

/// A stream that passes only newlines and tabs as control characters. It escapes all others as JSON and TOML
/// do, `\u001b`, so that a parser of these formats reads the same string.
pub(crate) struct Plain<'a>(pub &'a mut dyn Write);

impl Write for Plain<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        for chunk in bytes.utf8_chunks() {
            let text = chunk.valid();
            let mut from = 0;
            for (at, letter) in text.char_indices() {
                if !acts(letter) || letter == '\n' || letter == '\t' {
                    continue;
                }
                self.0
                    .write_all(text.get(from..at).unwrap_or_default().as_bytes())?;
                write!(self.0, "\\u{:04x}", u32::from(letter))?;
                from = at + letter.len_utf8();
            }
            self.0
                .write_all(text.get(from..).unwrap_or_default().as_bytes())?;
            // Everything printed is text; a terminal takes single bytes above 127 for controls.
            for byte in chunk.invalid() {
                write!(self.0, "\\x{byte:02x}")?;
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::{Plain, shown};
    use std::io::Write;

    #[test]
    fn names_stay_on_their_line() {
        let name = "a\u{1b}[31m\nclebsch: done\t\u{9b}2J\u{202e}Γ₁é";
        let words = "a\\u001b[31m\\u000aclebsch: done\\u0009\\u009b2J\\u202eΓ₁é";
        assert_eq!(shown(name).to_string(), words);
    }

    #[test]
    fn streams_keep_lines_and_write_out_the_rest() {
        let mut out = Vec::new();
        let mut plain = Plain(&mut out);
        plain
            .write_all("Γ\u{7f}\r\nx\ty\u{85}\u{1b}]0;t\u{7}".as_bytes())
            .expect("memory");
        plain.write_all(b"\x9b\xff!").expect("memory");
        assert_eq!(
            String::from_utf8(out).expect("UTF-8"),
            "Γ\\u007f\\u000d\nx\ty\\u0085\\u001b]0;t\\u0007\\x9b\\xff!"
        );
    }
}
