//! Embeds the model files of `elastic/`, `lattices/` and `fluids/` and their cases, so that an installed command
//! includes them. Writes `files.rs`, an array of `ModelFile`.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of model files, and the family of their models.
const FOLDERS: [(&str, &str); 3] = [
    ("elastic", "Elastic"),
    ("lattices", "Chain"),
    ("fluids", "Fluid"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut array = String::from("&[\n");
    for (folder, family) in FOLDERS {
        println!("cargo:rerun-if-changed={folder}");
        for model in files(Path::new(folder), "clebsch") {
            writeln!(
                array,
                "ModelFile {{ name: {:?}, family: Family::{family}, text: {}, cases: &[",
                stem(&model),
                embedded(&model)?
            )?;
            let own = model.with_extension("toml");
            let first = own.is_file().then_some(own);
            let cases = first
                .into_iter()
                .chain(files(&model.with_extension(""), "toml"));
            for case in cases {
                writeln!(
                    array,
                    "CaseFile {{ stem: {:?}, text: {} }},",
                    stem(&case),
                    embedded(&case)?
                )?;
            }
            array.push_str("] },\n");
        }
    }
    array.push(']');
    let out = std::env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?;
    fs::write(PathBuf::from(out).join("files.rs"), array)?;
    Ok(())
}

/// The files of a folder with this extension, sorted by name; empty if the folder does not exist.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut all: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .collect();
    all.sort();
    all
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// The expression that includes a file's text.
fn embedded(path: &Path) -> Result<String, Box<dyn Error>> {
    let path = fs::canonicalize(path)?;
    Ok(format!("include_str!({:?})", path.to_string_lossy()))
}
