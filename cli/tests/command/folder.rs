//! Folders of the tests, and the files that runs write into them.
#![allow(missing_docs)]

use crate::common::{Done, clebsch, rotor};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A file of the models that the project ships.
pub fn models(file: &str) -> String {
    format!("{}/../models/{file}", env!("CARGO_MANIFEST_DIR"))
}

/// Its text.
pub fn text_of(file: &str) -> String {
    fs::read_to_string(models(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// A separate folder for each test, empty at the start and removed at the end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("UTF-8").to_owned()
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        fs::write(&path, text).expect("a file for the test");
        path
    }

    #[track_caller]
    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    #[track_caller]
    pub fn read(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).expect("UTF-8")
    }

    #[track_caller]
    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    #[track_caller]
    pub fn samples(&self, name: &str) -> Samples {
        Samples::of(&self.read(name))
    }

    /// Runs `clebsch` on its shipped models; words that start with `@` are names in this folder.
    #[track_caller]
    pub fn clebsch(&self, words: &str) -> Done {
        clebsch(&self.placed(words))
    }

    /// Runs the command; it must succeed.
    #[track_caller]
    pub fn runs(&self, words: &str) -> Done {
        self.clebsch(words).succeeds()
    }

    /// Runs `clebsch` on the hand-written rotor alone.
    #[track_caller]
    pub fn rotor(&self, words: &str) -> Done {
        rotor(&self.placed(words))
    }

    fn placed(&self, words: &str) -> String {
        let word = |word: &str| match word.strip_prefix('@') {
            Some(name) => self.path(name),
            None => word.to_owned(),
        };
        words
            .split_whitespace()
            .map(word)
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// Names of everything inside, hidden or not.
    pub fn names(&self) -> Vec<String> {
        names_in(&self.0)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Names of everything in a folder.
pub fn names_in(folder: impl AsRef<Path>) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder").flatten();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().expect("UTF-8");
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

/// The numbers of a table, such as trajectory.csv.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    pub names: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Samples {
    pub fn of(csv: &str) -> Self {
        let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
        let names = lines.next().expect("a head").split(',').map(str::to_owned);
        // The cells of a rejected point of a sweep are empty.
        let number = |x: &str| match x {
            "" => f64::NAN,
            x => x.parse().unwrap_or_else(|e| panic!("{e}: {x}")),
        };
        let row = |line: &str| line.split(',').map(number).collect();
        Self {
            names: names.collect(),
            rows: lines.map(row).collect(),
        }
    }

    /// The index of a column.
    #[track_caller]
    pub fn place(&self, name: &str) -> usize {
        let place = self.names.iter().position(|own| own == name);
        place.unwrap_or_else(|| panic!("no {name} in {:?}", self.names))
    }

    #[track_caller]
    pub fn at(&self, name: &str, row: usize) -> f64 {
        self.rows[row][self.place(name)]
    }

    /// In the last row.
    #[track_caller]
    pub fn end(&self, name: &str) -> f64 {
        self.at(name, self.rows.len() - 1)
    }

    #[track_caller]
    pub fn column(&self, name: &str) -> Vec<f64> {
        let place = self.place(name);
        self.rows.iter().map(|row| row[place]).collect()
    }

    /// The columns whose names are accepted, row by row.
    pub fn only(&self, accepted: impl Fn(&str) -> bool) -> Vec<Vec<f64>> {
        let of_row = |row: &Vec<f64>| {
            let own = self.names.iter().zip(row).filter(|(n, _)| accepted(n));
            own.map(|(_, x)| *x).collect()
        };
        self.rows.iter().map(of_row).collect()
    }
}
