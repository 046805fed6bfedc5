//! No order of events loses results: files that another process creates during a run stay, and so do the results of
//! the run.

use crate::common::{Done, Folder, on, rotor};
use clebsch::StepError;
use clebsch::card::{Card, OpenError, Settings, Trajectory};
use clebsch_cli::gallery::{Citations, Entry, Gallery};
use std::cell::RefCell;
use std::fs;
use std::path::Path;
use std::sync::Barrier;

thread_local! {
    /// An action in the middle of a run on this thread.
    static MEANWHILE: RefCell<Option<Box<dyn FnOnce()>>> = const { RefCell::new(None) };
}

/// The rotor of the other tests; a given event happens in its tenth step.
struct Interrupted(Box<dyn Trajectory>);

impl Trajectory for Interrupted {
    fn node(&self) -> u64 {
        self.0.node()
    }
    fn time(&self) -> f64 {
        self.0.time()
    }
    fn step(&mut self) -> Result<(), StepError> {
        if self.0.node() == 9
            && let Some(event) = MEANWHILE.with(|event| event.borrow_mut().take())
        {
            event();
        }
        self.0.step()
    }
    fn card(&self) -> &'static Card {
        self.0.card()
    }
    fn observe(&self, out: &mut [f64]) {
        self.0.observe(out);
    }
    fn invariants(&self, out: &mut [f64]) {
        self.0.invariants(out);
    }
    fn scales(&self, out: &mut [f64]) {
        self.0.scales(out);
    }
}

fn open(
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
) -> Result<Box<dyn Trajectory>, OpenError> {
    let own = (crate::rotor::CARD.open)(parameters, initial, settings)?;
    Ok(Box::new(Interrupted(own)))
}

/// Runs with `event` in the middle. The 20 steps distinguish its results from other runs.
fn run_while(event: impl FnOnce() + 'static, out: &str, more: &[&str]) -> Done {
    let mut card = crate::rotor::CARD;
    card.open = &open;
    let gallery = Gallery {
        entries: vec![Entry {
            card,
            citations: Citations::NONE,
            cases: vec![crate::rotor::case()],
        }],
        ..Gallery::default()
    };
    MEANWHILE.with(|place| *place.borrow_mut() = Some(Box::new(event)));
    let arguments = ["run", "harmonic-rotor", "--steps", "20", "--out", out];
    let done = on(&gallery, &[&arguments[..], more].concat());
    assert!(
        MEANWHILE.with(|place| place.borrow().is_none()),
        "the event happened"
    );
    done
}

/// The number of steps of the run whose complete results are in `folder`.
fn steps_in(folder: &str) -> u64 {
    let text = fs::read_to_string(format!("{folder}/run.json")).expect("run.json");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for file in json["results"]["files"].as_array().expect("files") {
        let file = file.as_str().expect("a name");
        assert!(
            Path::new(folder).join(file).is_file(),
            "{folder} lacks {file}"
        );
    }
    json["steps"].as_u64().expect("a number")
}

/// An earlier run of 5 steps at `out`.
fn earlier(out: &str) {
    rotor(&format!("run harmonic-rotor --steps 5 --out {out}")).succeeds();
}

/// The run stopped with code 1, its results are in `kept`, and the message says so.
fn kept_beside(done: &Done, kept: &str) {
    done.ended(1);
    let words = format!("; the results are in {kept}\n");
    assert!(done.err.ends_with(&words), "{}", done.err);
    assert_eq!(steps_in(kept), 20);
}

/// Two failures: another process takes the folder, and then a step fails.
#[test]
fn results_of_a_run_that_stopped_are_kept_beside_a_folder_made_meanwhile() {
    let folder = Folder::new("made_and_stopped");
    let out = folder.path("out");
    let text = rotor("case harmonic-rotor").out;
    let file = folder.write("stiff.toml", text.replace("kappa = 1.0", "kappa = -200.0"));
    let made = out.clone();
    let event = move || fs::create_dir(&made).expect("a folder");
    let done = run_while(event, &out, &["--case", &file]);
    kept_beside(&done, &folder.path("out-2"));
    assert!(
        done.err.starts_with("clebsch: step from node 9 "),
        "{}",
        done.err
    );
    let made = "another program created it during the run";
    done.says(made);
    assert_eq!(folder.names(), ["out", "out-2", "stiff.toml"]);
}

#[test]
fn a_folder_made_meanwhile_is_left_as_it_is() {
    let folder = Folder::new("made_meanwhile");
    let out = folder.path("out");
    let thesis = format!("{out}/thesis.tex");
    let (made, written) = (out.clone(), thesis.clone());
    let event = move || {
        fs::create_dir(&made).expect("a folder");
        fs::write(&written, "years of work").expect("a file");
    };
    let done = run_while(event, &out, &[]);
    kept_beside(&done, &folder.path("out-2"));
    done.says("another program created it during the run");
    assert_eq!(
        fs::read_to_string(&thesis).expect("the file"),
        "years of work"
    );
    assert_eq!(folder.names(), ["out", "out-2"]);
}

#[test]
fn an_empty_folder_a_file_and_a_link_made_meanwhile_stay() {
    let folder = Folder::new("empty_meanwhile");
    for (index, what) in ["folder", "file", "link"].into_iter().enumerate() {
        let out = folder.path(&format!("out-of-{what}"));
        let (made, elsewhere) = (out.clone(), folder.path("elsewhere"));
        let event = move || match index {
            0 => fs::create_dir(&made).expect("a folder"),
            1 => fs::write(&made, "mine").expect("a file"),
            _ => std::os::unix::fs::symlink(&elsewhere, &made).expect("a link"),
        };
        let done = run_while(event, &out, &["--force"]);
        kept_beside(&done, &format!("{out}-2"));
        let now = fs::symlink_metadata(&out).expect("what was made");
        let kind = now.file_type();
        assert!(
            [kind.is_dir(), kind.is_file(), kind.is_symlink()][index],
            "{what}"
        );
        if kind.is_dir() {
            assert!(fs::read_dir(&out).expect("the folder").next().is_none());
        }
    }
}

#[test]
fn of_two_runs_into_one_folder_both_keep_their_results() {
    let folder = Folder::new("two_runs");
    // With and without --force: the folder of the other run did not exist at the start.
    for more in [&[][..], &["--force"]] {
        let out = folder.path(&format!("out{}", more.len()));
        let other = out.clone();
        let done = run_while(move || earlier(&other), &out, more);
        kept_beside(&done, &format!("{out}-2"));
        assert_eq!(steps_in(&out), 5);
    }
    // Again, with that name taken as well.
    let out = folder.path("out0");
    fs::remove_dir_all(&out).expect("removed");
    let other = out.clone();
    let done = run_while(move || earlier(&other), &out, &[]);
    kept_beside(&done, &format!("{out}-3"));
}

#[test]
fn force_replaces_only_what_stood_there_at_the_start() {
    let folder = Folder::new("force_meanwhile");
    // Without an event, the earlier results are replaced.
    let out = folder.path("quiet");
    earlier(&out);
    run_while(|| {}, &out, &["--force"]).succeeds();
    assert_eq!(steps_in(&out), 20);
    // Another process puts a file into the folder.
    let out = folder.path("foreign");
    earlier(&out);
    let note = format!("{out}/note.txt");
    let made = note.clone();
    let done = run_while(
        move || fs::write(made, "mine").expect("a file"),
        &out,
        &["--force"],
    );
    kept_beside(&done, &format!("{out}-2"));
    assert_eq!(fs::read_to_string(&note).expect("the note"), "mine");
    assert_eq!(steps_in(&out), 5);
    // A third run replaces it first.
    let out = folder.path("replaced");
    earlier(&out);
    let other = out.clone();
    let event = move || {
        let arguments = [
            "run",
            "harmonic-rotor",
            "--steps",
            "7",
            "--out",
            &other,
            "--force",
        ];
        rotor(&arguments).ended(0);
    };
    let done = run_while(event, &out, &["--force"]);
    kept_beside(&done, &format!("{out}-2"));
    assert_eq!(steps_in(&out), 7);
    // An empty folder replaces it, as if another run had just reserved the name.
    let out = folder.path("emptied");
    earlier(&out);
    let other = out.clone();
    let event = move || {
        fs::remove_dir_all(&other).expect("removed");
        fs::create_dir(&other).expect("a folder");
    };
    run_while(event, &out, &["--force"]).succeeds();
    assert_eq!(steps_in(&out), 20);
    // The folder is gone, so there is nothing to replace.
    let out = folder.path("gone");
    earlier(&out);
    let other = out.clone();
    run_while(
        move || fs::remove_dir_all(other).expect("removed"),
        &out,
        &["--force"],
    )
    .succeeds();
    assert_eq!(steps_in(&out), 20);
    assert_eq!(
        folder.names(),
        [
            "emptied",
            "foreign",
            "foreign-2",
            "gone",
            "quiet",
            "replaced",
            "replaced-2"
        ]
    );
}

#[test]
fn a_folder_of_the_name_of_a_file_of_a_run_is_not_replaced() {
    let folder = Folder::new("folder_as_file");
    let out = folder.path("out");
    earlier(&out);
    fs::remove_file(format!("{out}/run.json")).expect("removed");
    fs::create_dir(format!("{out}/run.json")).expect("a folder");
    folder
        .rotor("run harmonic-rotor --out @out --force")
        .refuses("it contains `run.json`");
    assert!(Path::new(&out).join("run.json").is_dir());
}

#[test]
fn what_other_processes_left_hidden_stays() {
    let folder = Folder::new("hidden");
    let out = folder.path("out");
    // The same process id is used again, or belongs to another machine with a shared disk.
    let names: Vec<String> = ["partial", "replaced"]
        .iter()
        .flat_map(|role| {
            let id = std::process::id();
            [format!(".out.{role}-{id}"), format!(".out.{role}-{id}-0")]
        })
        .collect();
    for name in &names {
        fs::create_dir(folder.path(name)).expect("a folder");
        fs::write(folder.path(&format!("{name}/trajectory.csv")), "theirs").expect("a file");
    }
    earlier(&out);
    assert_eq!(run_while(|| {}, &out, &["--force"]).code, 0);
    for name in &names {
        let text = fs::read_to_string(folder.path(&format!("{name}/trajectory.csv")));
        assert_eq!(text.expect("the file"), "theirs");
    }
    assert_eq!(folder.names().len(), 1 + names.len());
}

#[test]
fn many_runs_at_once_lose_nothing() {
    const RUNS: u64 = 8;
    let folder = Folder::new("many");
    for force in [false, true] {
        let out = folder.path(&format!("out-{force}"));
        if force {
            earlier(&out);
        }
        let together = Barrier::new(usize::try_from(RUNS).expect("few"));
        let codes: Vec<u8> = std::thread::scope(|scope| {
            let start = |index: u64| {
                let (out, together) = (&out, &together);
                scope.spawn(move || {
                    let steps = (100 + index).to_string();
                    let mut arguments =
                        vec!["run", "harmonic-rotor", "--steps", &steps, "--out", out];
                    arguments.extend(force.then_some("--force"));
                    together.wait();
                    rotor(&arguments).code
                })
            };
            let runs: Vec<_> = (0..RUNS).map(start).collect();
            runs.into_iter()
                .map(|run| run.join().expect("no panic"))
                .collect()
        });
        // A run that found the folder at its start was rejected, and computed nothing.
        let computed = codes.iter().filter(|code| **code != 2).count();
        assert!(codes.contains(&0), "{codes:?}");
        let name = format!("out-{force}");
        let folders = folder
            .names()
            .into_iter()
            .filter(|one| one.starts_with(&name));
        let mut steps: Vec<u64> = folders.map(|one| steps_in(&folder.path(&one))).collect();
        steps.sort_unstable();
        steps.dedup();
        // With --force, a run that starts after another has ended replaces it, as requested.
        let replaced = codes.iter().filter(|code| **code == 0).count() - 1;
        assert!(
            steps.len() + replaced * usize::from(force) >= computed,
            "{steps:?} {codes:?}"
        );
        // If another run has moved it, the earlier run may also be in a neighbouring folder.
        steps.retain(|steps| !force || *steps != 5);
        assert!(steps.iter().all(|steps| *steps >= 100), "{steps:?}");
        let hidden = folder
            .names()
            .into_iter()
            .filter(|one| one.starts_with('.'));
        assert_eq!(hidden.count(), 0);
    }
}

#[test]
fn what_a_killed_run_left_behind_is_removed_by_the_next() {
    let folder = Folder::new("abandoned");
    let out = folder.path("run");
    let sibling = |name: &str| folder.path(name);
    // The remains of a killed run, whose process has ended or whose number belongs to another process.
    for name in [".run.partial-1-0", ".run.partial-4194000-3"] {
        fs::create_dir(sibling(name)).expect("made");
        fs::write(format!("{}/trajectory.csv", sibling(name)), "1,2").expect("written");
    }
    // Folders of other programs, or of runs into another target, stay.
    for name in [
        ".other.partial-1-0",
        ".run.partial-notes",
        ".run.partial-1-0-1",
        ".run.partial-2-0",
        ".run.replaced-1-0",
    ] {
        fs::create_dir(sibling(name)).expect("made");
    }
    fs::write(format!("{}/notes.txt", sibling(".run.partial-2-0")), "mine").expect("written");
    // A run does not touch the folder of a run in progress, in this case its own folder.
    let inner = out.clone();
    let during = folder.path("");
    let done = run_while(
        move || {
            let hidden = |n: &str| {
                let all = fs::read_dir(&during).expect("there");
                let names = all
                    .flatten()
                    .map(|e| e.file_name().to_string_lossy().into_owned());
                let own = format!(".run.partial-{}-", std::process::id());
                names
                    .filter(|name| name.starts_with(&own))
                    .count()
                    .to_string()
                    == n
            };
            assert!(hidden("1"));
            run_while(|| (), &inner, &[]).succeeds();
            assert!(hidden("1"), "the folder of the outer run remains");
        },
        &out,
        &[],
    );
    done.ended(1);
    assert_eq!(
        folder.names(),
        [
            ".other.partial-1-0",
            ".run.partial-1-0-1",
            ".run.partial-2-0",
            ".run.partial-notes",
            ".run.replaced-1-0",
            "run",
            "run-2"
        ]
    );
}
