//! Runs that are killed or interrupted at any moment and gone on with: their results are those of a run that was left
//! alone, to the last byte. The program itself is run, killed and run again.
#![cfg(unix)]

use super::common::Folder;
use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// What is run: a free body whose solver keeps constants of its own, a forced one, one solved by Newton's method, steps
/// that are composed, one whose factor is seen from the body, and a lattice read from its file.
const RUNS: [&[&str]; 6] = [
    &[
        "free-body",
        "--steps",
        "300000",
        "--every",
        "100",
        "--order",
        "6",
    ],
    &["heavy-top", "--steps", "100000", "--every", "7"],
    &["kirchhoff-body", "--steps", "20000", "--every", "3"],
    &[
        "coupled-bodies",
        "--steps",
        "2000",
        "--every",
        "5",
        "--order",
        "4",
    ],
    &["ellipsoid-spatial", "--steps", "20000", "--every", "11"],
    &["LATTICE", "--steps", "300", "--every", "4"],
];

/// How many kills a run is given before it is left to end: `CLEBSCH_KILLS`, or few.
fn kills() -> u32 {
    let asked = std::env::var("CLEBSCH_KILLS").ok();
    asked.and_then(|text| text.parse().ok()).unwrap_or(6)
}

fn lattice() -> String {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/lattices/");
    format!("{root}{LATTICE}.clebsch")
}

const LATTICE: &str = "coupled-tops";

fn command(arguments: &[&str], out: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clebsch"));
    command.arg("run");
    for argument in arguments {
        match *argument {
            "LATTICE" => {
                let file = lattice();
                let case = file.replace(".clebsch", ".toml");
                command.args([file, "--case".to_owned(), case]);
            }
            other => {
                command.arg(other);
            }
        }
    }
    command.args(["--out", out]).args(more);
    command
}

fn run(arguments: &[&str], out: &str, more: &[&str]) -> Output {
    command(arguments, out, more).output().expect("runs")
}

fn begun(arguments: &[&str], out: &str, more: &[&str]) -> Child {
    let mut command = command(arguments, out, more);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("starts")
}

fn send(signal: &str, child: &Child) {
    let id = child.id().to_string();
    // It may have ended by itself.
    let _ = Command::new("kill")
        .args([signal, &id])
        .stderr(Stdio::null())
        .status();
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

/// Numbers that look random: the same in every run of the test, the moments at which processes are met never.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Kills the run at random moments of its whole length, then lets it end.
fn killed_and_resumed(signals: &[&str]) {
    let folder = Folder::new(&format!("resumed{}", signals.concat()));
    let mut seed = 7;
    // Together they take somewhat longer than the run.
    let most = 3.0 / f64::from(kills());
    let mut all = 0;
    for (number, arguments) in RUNS.iter().enumerate() {
        let what = arguments.join(" ");
        let whole = folder.path(&format!("whole-{number}"));
        let from = Instant::now();
        let done = run(arguments, &whole, &[]);
        assert!(
            done.status.success(),
            "{what}: {}",
            String::from_utf8_lossy(&done.stderr)
        );
        let length = from.elapsed();
        let out = folder.path(&format!("killed-{number}"));
        let mut stopped = 0;
        let kills = kills();
        for kill in 0..kills {
            let mut child = begun(arguments, &out, &["--resume", "--checkpoint", "0.001"]);
            std::thread::sleep(length.mul_f64(most * random(&mut seed)));
            send(signals[kill as usize % signals.len()], &child);
            let status = child.wait().expect("ends");
            stopped += u32::from(!status.success());
        }
        println!("{what}: {stopped} of {kills} kills met it at work");
        all += stopped;
        let done = run(arguments, &out, &["--resume"]);
        assert!(
            done.status.success(),
            "{what}: {}",
            String::from_utf8_lossy(&done.stderr)
        );
        same(&whole, &out, &what);
    }
    assert_eq!(folder.names().len(), 2 * RUNS.len(), "{:?}", folder.names());
    assert!(all as usize >= RUNS.len(), "{all} kills met a run at work");
}

#[test]
fn killed_runs_end_bit_equal() {
    killed_and_resumed(&["-KILL"]);
}

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
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/fluids/");
    let model = format!("{root}particle-mesh-2d.clebsch");
    let case = format!(
        "model = \"ParticleMesh2D\"\nname = \"killed\"\ndoc = \"a bump in a channel\"\nh = {}\nsteps = 12\n\
         [labels]\na = {}\nn = [{cells}, {cells}]\n[domain]\nlengths = [1.0, 1.0]\nwalls = [\"solid\", \"periodic\"]\n\
         [parameters]\nm = {{ depth = \"1 + 0.2*cos(pi*x)*cos(2*pi*y)\" }}\nc0 = 1.0\nf = 1.0\nalpha = {}\n\
         [initial]\nX = {{ lattice = \"square\", jitter = 0.2, seed = 3 }}\nvelocity_X = [\"0.1 - slope(S, 2)\", \"0.2 + slope(S, 1)\"]\n",
        0.2 / cells as f64,
        4 * cells * cells,
        2.0 / cells as f64,
    );
    let case = folder.write("case.toml", &case);
    let arguments = [&model[..], "--case", &case, "--every", "12"];
    let whole = folder.path("whole");
    let from = Instant::now();
    let done = run(&arguments, &whole, &[]);
    let told = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{told}");
    let length = from.elapsed();
    let out = folder.path("out");
    let mut seed = 11;
    let mut stopped = 0;
    for signal in ["-KILL", "-INT", "-KILL"] {
        let mut child = begun(&arguments, &out, &["--resume", "--checkpoint", "0.001"]);
        let wait = length.mul_f64(0.3 + 0.4 * random(&mut seed));
        std::thread::sleep(wait);
        let asked = Instant::now();
        send(signal, &child);
        let status = child.wait().expect("ends");
        println!(
            "{signal} after {wait:.1?}: {status}, {:.1?} later",
            asked.elapsed()
        );
        // A signal before the first step ends the program: there is nothing to be kept yet.
        assert!(matches!(status.code(), Some(0 | 130) | None), "{status}");
        stopped += u32::from(!status.success());
    }
    assert!(stopped > 0, "no signal met the run at work");
    let from = Instant::now();
    let done = run(&arguments, &out, &["--resume"]);
    let told = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{told}");
    println!(
        "the whole run took {length:.1?}, the last part {:.1?}",
        from.elapsed()
    );
    same(&whole, &out, "a fluid");
}

/// A run of a heavy top that takes minutes, once its folder is there and its work has begun.
fn long(out: &str, hidden: impl Fn() -> bool, more: &[&str]) -> Child {
    let child = begun(
        &["heavy-top", "--steps", "2000000000", "--every", "1000000"],
        out,
        more,
    );
    let from = Instant::now();
    while !hidden() && from.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(hidden(), "nothing was begun");
    std::thread::sleep(Duration::from_millis(300));
    child
}

#[test]
fn an_interrupted_run_writes_what_there_is_and_says_so() {
    for (signal, code, name) in [("-INT", 130, "SIGINT"), ("-TERM", 143, "SIGTERM")] {
        let folder = Folder::new(&format!("interrupted{signal}"));
        let out = folder.path("new/out");
        let hidden =
            || fs::read_dir(folder.path("new")).is_ok_and(|mut list| list.next().is_some());
        let mut child = long(&out, hidden, &[]);
        send(signal, &child);
        assert_eq!(child.wait().expect("ends").code(), Some(code));
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
    let hidden = || folder.names().iter().any(|name| name.contains("partial"));
    let mut child = long(&out, hidden, &[]);
    send("-TERM", &child);
    child.wait().expect("ends");
    let before = contents(&out);
    let again = |more: &[&str]| {
        let steps = ["heavy-top", "--steps", "2000000000", "--every", "1000000"];
        let done = run(&steps, &out, more);
        (
            done.status.code(),
            String::from_utf8_lossy(&done.stderr).into_owned(),
        )
    };
    let (code, message) = again(&["--resume", "--h", "0.01"]);
    assert_eq!(code, Some(2), "{message}");
    assert!(
        message.contains("h = 0.1 there, h = 0.01 here"),
        "{message}"
    );
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
        let (code, message) = again(&["--resume"]);
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains(says), "{message}");
        // Where the checkpoint itself is whole, the folder was taken up, and is put back.
        fs::write(&path, &before[file]).expect("put back");
    }
    let (code, message) = again(&[]);
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("--force"), "{message}");
}

#[test]
fn a_killed_run_is_not_begun_anew_by_mistake() {
    let folder = Folder::new("killed-not-lost");
    let out = folder.path("out");
    let hidden = || folder.names().iter().any(|name| name.contains("partial"));
    let mut child = long(&out, hidden, &["--checkpoint", "0.01"]);
    let going_on = run(
        &["heavy-top", "--steps", "2000000000", "--every", "1000000"],
        &out,
        &["--resume"],
    );
    let message = String::from_utf8_lossy(&going_on.stderr).into_owned();
    assert!(message.contains("still going on"), "{message}");
    send("-KILL", &child);
    child.wait().expect("ends");
    let short = ["heavy-top", "--steps", "10"];
    let done = run(&short, &out, &[]);
    let message = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(2), "{message}");
    assert!(message.contains("--resume"), "{message}");
    // By force it is, and the hidden folder goes.
    assert!(run(&short, &out, &["--force"]).status.success());
    assert_eq!(folder.names(), ["out"]);
    // A run that is complete is left as it is, and another one is told apart.
    let before = contents(&out);
    assert!(run(&short, &out, &["--resume"]).status.success());
    let other = run(&["heavy-top", "--steps", "11"], &out, &["--resume"]);
    let message = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(2), "{message}");
    assert!(
        message.contains(
            "this run is complete, with steps = 10; to go on from its end, start a new run"
        ),
        "{message}"
    );
    assert!(
        message.contains("trajectory.npz\", sample = -1 }"),
        "{message}"
    );
    let other = run(
        &["heavy-top", "--steps", "11", "--h", "0.003"],
        &out,
        &["--resume"],
    );
    let message = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(
        message.contains("it holds another run, with another `h`"),
        "{message}"
    );
    assert!(before == contents(&out));
}

#[test]
fn results_are_kept_when_nobody_reads_the_output() {
    let folder = Folder::new("closed-output");
    let out = folder.path("out");
    let mut command = command(&["heavy-top", "--steps", "1000"], &out, &[]);
    // The end that would be read is closed before anything is written.
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut child = command
        .stdout(writer)
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    child.wait().expect("ends");
    let files = contents(&out);
    let json = String::from_utf8_lossy(&files["run.json"]).into_owned();
    assert!(json.contains("\"complete\": true"), "{json}");
    assert_eq!(folder.names(), ["out"]);
}
