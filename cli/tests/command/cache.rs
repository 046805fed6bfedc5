//! The cache of derivations on the command line: results with it are those without it, whatever its folder contains.

use crate::cache_files::{edited, files};
use crate::common::{Done, Folder, Words, clebsch, text_of};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs the program with a cache in this folder.
fn with_cache(cache: &str, words: &str) -> Done {
    let words = words.words();
    let mut command = Command::new(env!("CARGO_BIN_EXE_clebsch"));
    let done = command.args(&words).env("CLEBSCH_CACHE", cache).output();
    let done = done.expect("runs");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Done {
        words,
        code: u8::try_from(done.status.code().expect("a code")).expect("a small code"),
        out: text(done.stdout),
        err: text(done.stderr),
    }
}

/// The results of a run: its exit code, what it prints, and the bytes of all files.
fn results(done: &Done, out: &str) -> (u8, [String; 2], Vec<Vec<u8>>) {
    let bytes = files(out)
        .into_iter()
        .map(|path| fs::read(path).expect("a file"));
    let printed = [&done.out, &done.err].map(|text| text.replace(out, "OUT"));
    (done.code, printed, bytes.collect())
}

#[test]
fn results_with_a_cache_are_those_without_it() {
    let folder = Folder::new("cached-results");
    let cache = folder.path("cache");
    let unused = "model Unused { param m, c, unused: Real; field q: Real;
                  lagrangian = m*(next(q) - q)^2/(2*h) - h*c*q^2/2; }";
    let unused = folder.write("unused.clebsch", unused);
    let long = text_of("lattices/toda-chain.toml").replace("i = 32", "i = 64");
    let long = folder.write("long.toml", long);
    // A body, a body with a warning, a chain that is expanded, loops over sites, constraints, and a fluid.
    let models = [
        ("spherical-pendulum".to_owned(), 1),
        (format!("{unused} --case sample"), 1),
        ("toda-chain".to_owned(), 2),
        (format!("toda-chain --case {long}"), 1),
        ("hanging-chain".to_owned(), 2),
        ("particle-mesh-1d".to_owned(), 2),
    ];
    for (i, (model, stored)) in models.iter().enumerate() {
        let before = files(&cache).len();
        let runs = ["", "", "--no-cache"].map(|option| {
            let out = folder.path(&format!("{i}{option}"));
            let run = format!("run {model} --steps 5 --stability-limit 0 --out {out} {option}");
            let done = with_cache(&cache, &run);
            let is_warned = done.err.contains("`unused`");
            assert_eq!(is_warned, model.contains("unused"), "{done:#?}");
            assert_eq!(files(&cache).len(), before + stored, "{run}");
            let found = results(&done, &out);
            assert!(found.0 == 0 && found.2.len() > 3, "{done:#?}");
            fs::remove_dir_all(out).expect("removed");
            found
        });
        assert!(runs[1] == runs[0] && runs[2] == runs[0], "{model}");
    }
}

#[test]
fn without_a_cache_nothing_is_written() {
    let folder = Folder::new("cached-nowhere");
    let cache = folder.path("cache");
    with_cache(&cache, "check spherical-pendulum --no-cache").ended(0);
    with_cache("off", "check spherical-pendulum").ended(0);
    assert!(files(&cache).is_empty() && !Path::new("off").exists());
}

#[test]
fn errors_and_refusals_are_not_kept() {
    let folder = Folder::new("cached-errors");
    let (cache, file) = (folder.path("cache"), folder.path("wrong.clebsch"));
    fs::write(&file, "model Wrong { param m: Real; lagrangian = m*x; }").expect("written");
    let check = format!("check {file}");
    let first = with_cache(&cache, &check);
    let second = with_cache(&cache, &check);
    first.ended(2);
    assert_eq!((first.code, &first.err), (second.code, &second.err));
    assert!(files(&cache).is_empty());
}

#[test]
fn a_folder_that_cannot_be_written_is_not_used() {
    let folder = Folder::new("cached-readonly");
    // A file instead of a folder: no one can write into it, whatever the permissions.
    let cache = folder.path("cache");
    fs::write(&cache, "a file").expect("written");
    let done = with_cache(&cache, "check spherical-pendulum");
    done.ended(0).says_nothing();
    assert_eq!(fs::read_to_string(&cache).expect("a file"), "a file");
}

#[test]
fn data_of_another_form_is_derived_again() {
    let folder = Folder::new("cached-forms");
    let cache = folder.path("cache");
    let check = "check spherical-pendulum";
    let whole = with_cache(&cache, check);
    whole.ended(0);
    let file = &files(&cache)[0];
    let bytes = fs::read(file).expect("read");
    let text = String::from_utf8(bytes.clone()).expect("UTF-8");
    let data = text
        .lines()
        .find(|line| line.starts_with('{'))
        .expect("JSON");
    for other in ["{}", "[1", "", "{\"name\":1}"] {
        fs::write(file, edited(&bytes, data, other)).expect("written");
        assert_eq!(with_cache(&cache, check).out, whole.out);
        assert_eq!(fs::read(file).expect("read"), bytes, "{other}");
    }
}

#[test]
fn processes_that_derive_one_model_at_once_succeed() {
    let folder = Folder::new("cached-together");
    let path = folder.path("cache");
    // Processes that derive the same model at once.
    let begin = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_clebsch"));
        command
            .args(["check", "spherical-pendulum"])
            .env("CLEBSCH_CACHE", &path);
        command
            .stdout(std::process::Stdio::piped())
            .spawn()
            .expect("starts")
    };
    let all: Vec<_> = (0..3).map(|_| begin()).collect();
    let all: Vec<_> = all
        .into_iter()
        .map(|child| child.wait_with_output().expect("ends"))
        .collect();
    let alone = clebsch("check spherical-pendulum").out;
    for done in &all {
        assert!(done.status.success());
        assert_eq!(String::from_utf8_lossy(&done.stdout), alone);
    }
    assert_eq!(files(&path).len(), 1);
}
