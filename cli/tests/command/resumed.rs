//! Runs that are killed or interrupted at any moment and then resumed. Their results are identical to an
//! uninterrupted run, byte for byte. The program itself is run, killed and run again.
#![cfg(unix)]

use crate::common::{Done, Folder, process_in};
use crate::signals::{begun, command, ended_by, wait_for};
use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Stdio};

/// The runs: a free body whose solver stores its own constants, a forced body, and a body with Newton's method. Also
/// composed steps, a body with a factor in its own frame, and a chain read from its file.
const RUNS: [&str; 6] = [
    "free-body --steps 300000 --every 100 --order 6",
    "heavy-top --steps 100000 --every 7",
    "kirchhoff-body --steps 20000 --every 3",
    "coupled-bodies --steps 2000 --every 5 --order 4",
    "ellipsoid-spatial --steps 20000 --every 11",
    "models/lattices/coupled-tops.clebsch --case models/lattices/coupled-tops.toml --steps 300 --every 4",
];

/// Checkpoints as often as can be.
const OFTEN: &str = "--resume --checkpoint 0.001";

/// The number of kills before a run may finish: `CLEBSCH_KILLS`, or few.
fn kills() -> u32 {
    let asked = std::env::var("CLEBSCH_KILLS").ok();
    asked.and_then(|text| text.parse().ok()).unwrap_or(6)
}

fn run(words: &str, out: &str, more: &str) -> Done {
    process_in(".", &format!("run {words} --out {out} {more}"))
}

/// Sends signals to a run one by one, each after more progress than the one before; returns how many signals reached
/// it during its work.
fn met(words: &str, signals: &[&str], kills: u32, [whole, out]: [&str; 2]) -> u32 {
    let samples = fs::metadata(format!("{whole}/trajectory.npz"))
        .expect("written")
        .len();
    let (mut seed, mut stopped) = (7, 0);
    for (kill, signal) in (0..kills).zip(signals.iter().cycle()) {
        let mut child = begun(&format!("run {words} --out {out} {OFTEN}"));
        let part = (f64::from(kill) + random(&mut seed)) / f64::from(kills + 1);
        let least = samples as f64 * part;
        wait_for(&mut child, out, "samples.bin", |bytes| {
            bytes.len() as f64 > least
        });
        let code = ended_by(signal, child);
        assert!(
            matches!(code, Some(0 | 130 | 143) | None),
            "{words}: {code:?}"
        );
        stopped += u32::from(code != Some(0));
    }
    stopped
}

/// All files of a folder.
fn contents(folder: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{folder}: {e}"));
    let file = |entry: fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).expect("a file"))
    };
    entries.flatten().map(file).collect()
}

fn same(one: &str, other: &str, what: &str) {
    let (one, other) = (contents(one), contents(other));
    let names = |all: &BTreeMap<String, Vec<u8>>| all.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other), "{what}");
    for (name, bytes) in &one {
        assert!(other[name] == *bytes, "{what}: {name} differs");
    }
}

/// Pseudorandom numbers: the same in every run of the test, although the moments of the signals differ.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Runs that are interrupted repeatedly give the results of an uninterrupted run.
fn killed_and_resumed(signals: &[&str]) {
    let folder = Folder::new(&format!("resumed{}", signals.concat()));
    let mut all = 0;
    for (number, words) in RUNS.into_iter().enumerate() {
        let [whole, out] = ["whole", "killed"].map(|name| folder.path(&format!("{name}-{number}")));
        run(words, &whole, "").ended(0);
        all += met(words, signals, kills(), [&whole, &out]);
        run(words, &out, "--resume").ended(0);
        same(&whole, &out, words);
    }
    assert_eq!(folder.names().len(), 2 * RUNS.len(), "{:?}", folder.names());
    assert!(
        all as usize >= RUNS.len(),
        "{all} signals met a run at work"
    );
}

/// Long, since six runs are interrupted by six signals each, and resumed.
#[test]
fn killed_runs_end_bit_equal() {
    killed_and_resumed(&["-KILL"]);
}

/// Long, since six runs receive six signals each and are resumed.
#[test]
fn interrupted_runs_end_bit_equal() {
    killed_and_resumed(&["-INT", "-TERM"]);
}

/// Particles of the fluid that is killed, `CLEBSCH_PARTICLES`, or few.
fn particles() -> usize {
    let asked = std::env::var("CLEBSCH_PARTICLES").ok();
    asked.and_then(|text| text.parse().ok()).unwrap_or(1024)
}

/// A channel with four particles in each cell of its grid. A million of them, optimised:
/// `CLEBSCH_PARTICLES=1000000 cargo test --profile quick -p clebsch-cli --test command of_particles -- --nocapture`
#[test]
fn a_fluid_of_particles_that_is_killed_or_interrupted_ends_bit_equal() {
    let folder = Folder::new("resumed-fluid");
    let cells = (particles() as f64 / 4.0).sqrt().round() as usize;
    let case = format!(
        "model = \"ParticleMesh2D\"\nname = \"killed\"\ndoc = \"a bump in a channel\"\nh = {}\nsteps = 12\n\
         [labels]\na = {}\nn = [{cells}, {cells}]\n[domain]\nlengths = [1.0, 1.0]\nwalls = [\"solid\", \"periodic\"]\n\
         [parameters]\nm = {{ depth = \"1 + 0.2*cos(pi*x)*cos(2*pi*y)\" }}\nc0 = 1.0\nf = 1.0\nalpha = {}\n\
         [initial]\nX = {{ lattice = \"square\", jitter = 0.2, seed = 3 }}\nvelocity_X = [\"0.1 - slope(S, 2)\", \"0.2 + slope(S, 1)\"]\n",
        0.2 / cells as f64,
        4 * cells * cells,
        2.0 / cells as f64,
    );
    folder.write("case.toml", &case);
    let words = format!(
        "models/fluids/particle-mesh-2d.clebsch --case {} --every 1",
        folder.path("case.toml")
    );
    let [whole, out] = ["whole", "out"].map(|name| folder.path(name));
    run(&words, &whole, "").ended(0);
    let stopped = met(&words, &["-KILL", "-INT", "-KILL"], 3, [&whole, &out]);
    assert!(stopped > 0, "no signal met the run at work");
    run(&words, &out, "--resume").ended(0);
    same(&whole, &out, "a fluid");
}

/// A run of a heavy top that takes minutes.
const LONG: &str = "heavy-top --steps 2000000000 --every 1000";

/// The running process, once it has written to this file of its hidden folder.
fn long(out: &str, file: &str, more: &str) -> Child {
    let mut child = begun(&format!("run {LONG} --out {out} {more}"));
    wait_for(&mut child, out, file, |bytes| !bytes.is_empty());
    child
}

#[test]
fn an_interrupted_run_writes_what_there_is_and_says_so() {
    for (signal, code, name) in [("-INT", 130, "SIGINT"), ("-TERM", 143, "SIGTERM")] {
        let folder = Folder::new(&format!("interrupted{signal}"));
        let out = folder.path("new/out");
        let child = long(&out, "samples.bin", "");
        assert_eq!(ended_by(signal, child), Some(code));
        let files = contents(&out);
        for file in [
            "trajectory.csv",
            "trajectory.npz",
            "checkpoint",
            "momentum.svg",
        ] {
            assert!(files.contains_key(file), "{:?}", files.keys());
        }
        let json = String::from_utf8_lossy(&files["run.json"]).into_owned();
        assert!(json.contains("\"complete\": false"), "{json}");
        assert!(json.contains(&format!("interrupted by {name}")), "{json}");
        assert_eq!(folder.names(), ["new"]);
    }
}

#[test]
fn a_checkpoint_that_is_damaged_or_of_another_run_is_refused() {
    let folder = Folder::new("refused-checkpoint");
    let out = folder.path("out");
    ended_by("-TERM", long(&out, "samples.bin", ""));
    let before = contents(&out);
    run(LONG, &out, "--resume --h 0.01").refuses("it has h = 0.1, but this run has h = 0.01");
    assert!(before == contents(&out), "nothing was changed");
    for (file, says) in [
        ("checkpoint", "its checksum"),
        ("samples.bin", "the samples"),
    ] {
        let path = format!("{out}/{file}");
        let mut bytes = before[file].clone();
        // In the middle of the checkpoint, in the first of the samples.
        let place = if file == "checkpoint" {
            bytes.len() / 2
        } else {
            9
        };
        bytes[place] ^= 1;
        fs::write(&path, &bytes).expect("written");
        run(LONG, &out, "--resume").refuses(says);
        // If the checkpoint is intact, the run has taken the folder, and restores it.
        fs::write(&path, &before[file]).expect("put back");
    }
    run(LONG, &out, "").refuses("--force");
}

#[test]
fn a_killed_run_is_not_begun_anew_by_mistake() {
    let folder = Folder::new("killed-not-lost");
    let out = folder.path("out");
    let child = long(&out, "checkpoint", "--checkpoint 0.01");
    run(LONG, &out, "--resume").says("another run is writing into this folder");
    ended_by("-KILL", child);
    let short = "heavy-top --steps 10";
    run(short, &out, "").refuses("--resume");
    // With --force it is replaced, and the hidden folder is removed.
    run(short, &out, "--force").ended(0);
    assert_eq!(folder.names(), ["out"]);
    // A complete run stays unchanged, and a different run is detected.
    let before = contents(&out);
    run(short, &out, "--resume").ended(0);
    run("heavy-top --steps 11", &out, "--resume").refuses([
        "this run is complete, with steps = 10; to continue it, start a new run",
        "trajectory.npz\", sample = -1 }",
    ]);
    let other = run("heavy-top --steps 11 --h 0.003", &out, "--resume");
    other.says("it contains another run, with another `h`");
    assert!(before == contents(&out));
}

#[test]
fn results_are_kept_when_nobody_reads_the_output() {
    let folder = Folder::new("closed-output");
    let out = folder.path("out");
    // The reading end is closed before anything is written.
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut command = command(&format!("run heavy-top --steps 1000 --out {out}"));
    let mut child = command.stdout(writer).stderr(Stdio::null()).spawn();
    child.as_mut().expect("starts").wait().expect("ends");
    let files = contents(&out);
    let json = String::from_utf8_lossy(&files["run.json"]).into_owned();
    assert!(json.contains("\"complete\": true"), "{json}");
    assert_eq!(folder.names(), ["out"]);
}
