//! Runs of the command in this process, and their output; folders and tables of the tests.
#![allow(missing_docs)]

use crate::rotor;
use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute};
use serde_json::Value;
use std::ffi::OsString;
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

pub use crate::folder::{Folder, Samples, models, names_in, text_of};

/// Words of a command line: a text to split, or a list of words.
pub trait Words {
    fn words(&self) -> Vec<String>;
}

impl Words for str {
    /// Folders of the project may have spaces in their names. A word may begin with `models/`, the folder of the shipped models.
    fn words(&self) -> Vec<String> {
        let roots = [env!("CARGO_TARGET_TMPDIR"), env!("CARGO_MANIFEST_DIR")];
        let text = self.replace(roots[0], "\0").replace(roots[1], "\x01");
        let whole = |word: &str| match word.strip_prefix("models/") {
            Some(file) => models(file),
            None => word.replace('\0', roots[0]).replace('\x01', roots[1]),
        };
        text.split_whitespace().map(whole).collect()
    }
}

impl Words for String {
    fn words(&self) -> Vec<String> {
        self.as_str().words()
    }
}

impl<W: Words + ?Sized> Words for &W {
    fn words(&self) -> Vec<String> {
        (**self).words()
    }
}

impl Words for [&str] {
    fn words(&self) -> Vec<String> {
        self.iter().map(|word| (*word).to_owned()).collect()
    }
}

impl<const N: usize> Words for [&str; N] {
    fn words(&self) -> Vec<String> {
        self.as_slice().words()
    }
}

impl Words for Vec<&str> {
    fn words(&self) -> Vec<String> {
        self.as_slice().words()
    }
}

/// One or several parts of the output.
pub trait Parts {
    fn parts(&self) -> Vec<&str>;
}

impl Parts for str {
    fn parts(&self) -> Vec<&str> {
        vec![self]
    }
}

impl Parts for String {
    fn parts(&self) -> Vec<&str> {
        vec![self]
    }
}

impl<const N: usize> Parts for [&str; N] {
    fn parts(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Parts for [&str] {
    fn parts(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<P: Parts + ?Sized> Parts for &P {
    fn parts(&self) -> Vec<&str> {
        (**self).parts()
    }
}

/// The result of a command.
#[derive(Debug)]
pub struct Done {
    pub words: Vec<String>,
    pub code: u8,
    pub out: String,
    pub err: String,
}

impl Done {
    /// The command exited with this code.
    #[track_caller]
    pub fn ended(&self, code: u8) -> &Self {
        assert_eq!(self.code, code, "{self:#?}");
        self
    }

    #[track_caller]
    pub fn exits(self, code: u8) -> Self {
        self.ended(code);
        self
    }

    #[track_caller]
    pub fn succeeds(self) -> Self {
        self.exits(0)
    }

    /// The command rejects the request, and the message contains these words.
    #[track_caller]
    pub fn refuses(&self, words: impl Parts) -> &Self {
        self.ended(2).says(words)
    }

    /// The command failed, and the message contains these words.
    #[track_caller]
    pub fn fails(&self, words: impl Parts) -> &Self {
        self.ended(1).says(words)
    }

    /// Standard output contains these words.
    #[track_caller]
    pub fn prints(&self, words: impl Parts) -> &Self {
        holds(&self.out, &words, &self.words);
        self
    }

    /// Standard error contains these words.
    #[track_caller]
    pub fn says(&self, words: impl Parts) -> &Self {
        holds(&self.err, &words, &self.words);
        self
    }

    #[track_caller]
    pub fn never_prints(&self, words: &str) -> &Self {
        assert!(!self.out.contains(words), "`{words}` in {self:#?}");
        self
    }

    #[track_caller]
    pub fn never_says(&self, words: &str) -> &Self {
        assert!(!self.err.contains(words), "`{words}` in {self:#?}");
        self
    }

    #[track_caller]
    pub fn prints_nothing(&self) -> &Self {
        assert_eq!(self.out, "", "{:?}", self.words);
        self
    }

    #[track_caller]
    pub fn says_nothing(&self) -> &Self {
        assert_eq!(self.err, "", "{:?}", self.words);
        self
    }

    /// The one object of `--json`.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}: {self:#?}"))
    }
}

/// A text contains these words.
#[track_caller]
pub fn has(text: &str, words: impl Parts) {
    holds(text, &words, &[]);
}

#[track_caller]
fn holds(text: &str, parts: &impl Parts, command: &[String]) {
    for part in parts.parts() {
        assert!(
            text.contains(part),
            "`{part}` of {command:?} is not in\n{text}"
        );
    }
}

/// Runs `clebsch` on the models that it ships with.
pub fn clebsch<W: Words + ?Sized>(words: &W) -> Done {
    static SHIPPED: OnceLock<Gallery> = OnceLock::new();
    on(SHIPPED.get_or_init(Gallery::shipped), words)
}

/// Runs the command; it must succeed.
#[track_caller]
pub fn runs<W: Words + ?Sized>(words: &W) -> Done {
    clebsch(words).succeeds()
}

/// Runs `clebsch` on the hand-written rotor alone.
pub fn rotor<W: Words + ?Sized>(words: &W) -> Done {
    on(&rotor::gallery(), words)
}

/// Runs `clebsch` on any gallery.
pub fn on<W: Words + ?Sized>(gallery: &Gallery, words: &W) -> Done {
    with(gallery, words, "", None)
}

/// Runs `clebsch` with a standard input and a width of the terminal.
pub fn with<W>(gallery: &Gallery, words: &W, input: &str, width: Option<usize>) -> Done
where
    W: Words + ?Sized,
{
    let (words, mut out, mut err) = (words.words(), Vec::new(), Vec::new());
    let arguments = ["clebsch"]
        .into_iter()
        .chain(words.iter().map(String::as_str));
    let mut streams = Streams {
        input: &mut input.as_bytes(),
        out: &mut out,
        err: &mut err,
        progress: false,
        width,
    };
    let code = execute(arguments.map(OsString::from), gallery, &mut streams);
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    let (out, err) = (text(out), text(err));
    Done {
        words,
        code,
        out,
        err,
    }
}

/// Runs the program itself, in a folder.
pub fn process_in<W: Words + ?Sized>(folder: &str, words: &W) -> Done {
    let words = words.words();
    let mut command = Command::new(env!("CARGO_BIN_EXE_clebsch"));
    command.env("CLEBSCH_CACHE", "off");
    let done = command.args(&words).current_dir(folder).output();
    let done = done.expect("runs");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    let code = done.status.code().expect("a code");
    Done {
        words,
        code: u8::try_from(code).expect("a small code"),
        out: text(done.stdout),
        err: text(done.stderr),
    }
}

/// The rows of a table of texts: one line per row, with cells separated by `|`. Lines that begin with `//` are
/// remarks, `\n` in a cell is a new line.
pub fn table<const N: usize>(text: &str) -> Vec<[&'static str; N]> {
    let lines = text.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("//"));
    let row = |line: &str| {
        let cell = |cell: &str| &*cell.trim().replace("\\n", "\n").leak();
        let cells: Vec<&'static str> = line.splitn(N, '|').map(cell).collect();
        cells
            .try_into()
            .unwrap_or_else(|_| panic!("{N} cells: {line}"))
    };
    lines.map(row).collect()
}

/// Waits for a condition, with a bound that no assertion depends on.
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let from = Instant::now();
    while !condition() {
        assert!(from.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}
