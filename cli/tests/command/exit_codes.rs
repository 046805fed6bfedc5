//! Exit codes and messages of the commands, and what goes to which stream.

use super::common::{Folder, clebsch};
use std::process::Command;

#[test]
fn list_shows_models_with_cases_and_one_line() {
    let done = clebsch(&["list"]);
    assert_eq!(done.code, 0);
    assert_eq!(
        done.out,
        "model           family  cases         what it is\n\
         harmonic-rotor  rigid   swing, quiet  Rotor on a fixed axis with a restoring torque.\n"
    );
    let done = clebsch(&["list", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one JSON object");
    assert_eq!(json["models"][0]["model"], "harmonic-rotor");
    assert_eq!(json["models"][0]["cases"][1]["name"], "quiet");
    assert_eq!(json["models"][0]["fingerprint"], "0123456789abcdef");
}

#[test]
fn a_run_prints_what_was_derived_and_a_table() {
    let done = clebsch(&["run", "harmonic-rotor", "--verbose"]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    for words in [
        "p' = p - h κ sin θ\nθ' = θ + h p / I\n",
        "solver: explicit; reversible\n",
        "harmonic-rotor, case swing: Swings \"widely\".\n",
        "h = 0.05, 2000 steps, to time 100; order 2\n",
        "invariant   scale  max drift  final drift  bound  verdict       formula\n",
        "energy     0.5627",
        "across          1          0            0  1e-12  within bound  (μ₁, μ₂)\n",
    ] {
        assert!(
            done.out.contains(words),
            "{words:?} is missing in\n{}",
            done.out
        );
    }
}

#[test]
fn an_oscillating_invariant_without_bound_gets_no_verdict() {
    let done = clebsch(&["run", "HarmonicRotor", "--case", "quiet"]);
    assert_eq!(done.code, 0);
    assert!(done.out.contains("-  no bound  "), "{}", done.out);
}

#[test]
fn json_is_one_object_and_nothing_else() {
    let done = clebsch(&[
        "run",
        "harmonic-rotor",
        "--json",
        "--steps",
        "10",
        "--h",
        "0.01",
    ]);
    assert_eq!(done.code, 0);
    assert_eq!(done.out.lines().count(), 1);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("JSON");
    assert_eq!(json["steps"], 10);
    assert_eq!(json["h"], 0.01);
    assert_eq!(json["exit_code"], 0);
    assert_eq!(json["parameters"]["J"][0][1], 0.1);
    assert_eq!(json["results"]["invariants"][1]["bound"], 1e-12);
    assert_eq!(
        json["results"]["invariants"][1]["components"][1]["worst"],
        0.0
    );

    let done = clebsch(&["run", "harmonic-rotor", "--json", "--h", "10"]);
    assert_eq!(done.code, 1);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("JSON");
    assert_eq!(json["exit_code"], 1);
}

/// Arguments, exit code, words of the message.
#[test]
fn every_wrong_request_is_named() {
    let folder = Folder::new("wrong_requests");
    let directory = folder.path("a.toml");
    std::fs::create_dir(&directory).expect("a folder");
    let wrong: &[(&[&str], u8, &[&str])] = &[
        (&[], 2, &["Usage: clebsch"]),
        (&["rum"], 2, &["unrecognized subcommand 'rum'", "'run'"]),
        (&["run"], 2, &["<MODEL>"]),
        (
            &["run", "harmonic-roter"],
            2,
            &["no model `harmonic-roter`; did you mean `harmonic-rotor`?"],
        ),
        (
            &["case", "zzz"],
            2,
            &["no model `zzz`; `clebsch list` shows all models"],
        ),
        (
            &["case", "harmonic-rotor", "--case", "quite"],
            2,
            &["no case `quite`", "did you mean `quiet`?"],
        ),
        (
            &["run", "harmonic-rotor", "--case", "swin"],
            2,
            &["no case `swin`", "did you mean `swing`?"],
        ),
        (
            &["run", "harmonic-rotor", "--case", "none.toml"],
            2,
            &["cannot read the case file none.toml"],
        ),
        (
            &["run", "harmonic-rotor", "--case", &directory],
            2,
            &["cannot read the case file"],
        ),
        (
            &["run", "harmonic-rotor", "--step", "3"],
            2,
            &["--step", "--steps"],
        ),
        (
            &["run", "harmonic-rotor", "--steps", "0"],
            2,
            &["'0'", "--steps", "at least 1"],
        ),
        (
            &["run", "harmonic-rotor", "--steps", "-3"],
            2,
            &["'-3'", "--steps", "at least 1"],
        ),
        (
            &["run", "harmonic-rotor", "--steps", "1.5"],
            2,
            &["--steps", "whole number"],
        ),
        (
            &["run", "harmonic-rotor", "--steps", "99999999999999999999"],
            2,
            &["--steps", "at most 18446744073709551615"],
        ),
        (
            &["run", "harmonic-rotor", "--order", "four"],
            2,
            &["'four'", "--order", "whole number"],
        ),
        (
            &["run", "harmonic-rotor", "--order", "-4"],
            2,
            &["'-4'", "--order", "whole number"],
        ),
        (
            &["run", "harmonic-rotor", "--solver", "newton"],
            2,
            &["--solver newton: this model has one solver only"],
        ),
        (
            &["run", "harmonic-rotor", "--every", "0"],
            2,
            &["--every", "at least 1"],
        ),
        (
            &["run", "harmonic-rotor", "--h", "-0.1"],
            2,
            &["'-0.1'", "--h", "positive"],
        ),
        (
            &["run", "harmonic-rotor", "--h", "0"],
            2,
            &["--h", "positive"],
        ),
        (
            &["run", "harmonic-rotor", "--h", "nan"],
            2,
            &["--h", "finite"],
        ),
        (
            &["run", "harmonic-rotor", "--h", "inf"],
            2,
            &["--h", "finite"],
        ),
        (&["run", "harmonic-rotor", "--force"], 2, &["--out"]),
        (
            &["run", "harmonic-rotor", "--h", "10"],
            1,
            &["cannot take the first step", "reduce the step size"],
        ),
        (
            &["derive", "harmonic-roto", "--format", "text"],
            2,
            &["no model `harmonic-roto`; did you mean"],
        ),
        (
            &["derive", "harmonic-rotor", "--format", "pdf"],
            2,
            &["'pdf'", "latex"],
        ),
    ];
    for (arguments, code, words) in wrong {
        let done = clebsch(arguments);
        assert_eq!(done.code, *code, "{arguments:?}: {}", done.err);
        assert_eq!(done.out, "", "{arguments:?}");
        for word in *words {
            assert!(
                done.err.contains(word),
                "{arguments:?}: {word:?} is missing in\n{}",
                done.err
            );
        }
    }
}

#[test]
fn more_samples_than_fit_are_refused_before_the_run() {
    let folder = Folder::new("too_many_samples");
    let out = folder.path("out");
    let steps = "1000000000000";
    let done = clebsch(&[
        "run",
        "harmonic-rotor",
        "--steps",
        steps,
        "--every",
        "1",
        "--out",
        &out,
    ]);
    assert_eq!(done.code, 2);
    assert!(
        done.err.contains("--every 1: ") && done.err.contains("give --every "),
        "{}",
        done.err
    );
    assert!(folder.names().is_empty());
}

#[test]
fn help_and_version_are_results() {
    for arguments in [&["--help"][..], &["run", "--help"], &["--version"]] {
        let done = clebsch(arguments);
        assert_eq!((done.code, done.err.as_str()), (0, ""));
        assert!(!done.out.is_empty());
    }
}

#[test]
fn a_reader_that_goes_away_is_not_an_error_message() {
    struct Gone;
    impl std::io::Write for Gone {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let mut err = Vec::new();
    let mut streams = clebsch_cli::Streams {
        input: &mut std::io::empty(),
        out: &mut Gone,
        err: &mut err,
        progress: false,
        width: None,
    };
    let arguments = ["clebsch", "list"].map(std::ffi::OsString::from);
    assert_eq!(
        clebsch_cli::execute(arguments, &super::common::gallery(), &mut streams),
        1
    );
    assert!(err.is_empty());
}

#[test]
fn the_program_itself_gives_its_exit_code() {
    let run = |arguments: &[&str]| {
        let program = Command::new(env!("CARGO_BIN_EXE_clebsch"))
            .args(arguments)
            .output();
        program.expect("the program starts")
    };
    let version = run(&["--version"]);
    assert_eq!(version.status.code(), Some(0));
    assert_eq!(
        version.stdout,
        format!("clebsch {}\n", env!("CARGO_PKG_VERSION")).into_bytes()
    );
    let wrong = run(&["run", "no-such-model"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(wrong.stdout.is_empty());
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("no model `no-such-model`"));
}
