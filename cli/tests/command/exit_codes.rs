//! Exit codes and messages of the commands, and the stream of each message.

use crate::common::{Folder, process_in, rotor, table};

#[test]
fn list_shows_models_with_cases_and_one_line() {
    let done = rotor("list").succeeds();
    assert_eq!(
        done.out,
        "model           family  cases         description\n\
         harmonic-rotor  rigid   swing, quiet  Rotor on a fixed axis with a restoring torque.\n"
    );
    let json = rotor("list --json").json();
    assert_eq!(json["models"][0]["model"], "harmonic-rotor");
    assert_eq!(json["models"][0]["cases"][1]["name"], "quiet");
    assert_eq!(json["models"][0]["fingerprint"], "0123456789abcdef");
}

#[test]
fn a_run_prints_what_was_derived_and_a_table() {
    let done = rotor("run harmonic-rotor --verbose");
    done.ended(0).says_nothing();
    done.prints([
        "p' = p - h κ sin θ\nθ' = θ + h p / I\n",
        "solver: explicit; reversible\n",
        "harmonic-rotor, case swing: Swings \"widely\".\n",
        "h = 0.05, 2000 steps, to time 100; order 2\n",
        "invariant   scale  max drift  final drift  bound  verdict       formula\n",
        "energy     0.5627",
        "across          1          0            0  1e-12  within bound  (μ₁, μ₂)\n",
    ]);
}

#[test]
fn an_oscillating_invariant_without_bound_gets_no_verdict() {
    rotor("run HarmonicRotor --case quiet")
        .succeeds()
        .prints("-  no bound  ");
}

#[test]
fn json_is_one_object_and_nothing_else() {
    let done = rotor("run harmonic-rotor --json --steps 10 --h 0.01").succeeds();
    assert_eq!(done.out.lines().count(), 1);
    let json = done.json();
    assert_eq!(json["steps"], 10);
    assert_eq!(json["h"], 0.01);
    assert_eq!(json["exit_code"], 0);
    assert_eq!(json["parameters"]["J"][0][1], 0.1);
    assert_eq!(json["results"]["invariants"][1]["bound"], 1e-12);
    assert_eq!(
        json["results"]["invariants"][1]["components"][1]["worst"],
        0.0
    );

    let json = rotor("run harmonic-rotor --json --h 10").exits(1).json();
    assert_eq!(json["exit_code"], 1);
}

#[test]
fn every_wrong_request_is_named() {
    let folder = Folder::new("wrong_requests");
    std::fs::create_dir(folder.path("a.toml")).expect("a folder");
    // `$` denotes a run of the rotor; `&` joins parts of the message.
    for [words, code, parts] in table(
        "
                            | 2 | Usage: clebsch
        rum                 | 2 | unrecognized subcommand 'rum' & 'run'
        run                 | 2 | <MODEL>
        run harmonic-roter  | 2 | no model `harmonic-roter`; did you mean `harmonic-rotor`?
        case zzz            | 2 | no model `zzz`; `clebsch list` shows all models
        case harmonic-rotor --case quite | 2 | no case `quite` & did you mean `quiet`?
        $ --case swin       | 2 | no case `swin` & did you mean `swing`?
        $ --case none.toml  | 2 | cannot read the case file none.toml
        $ --case @a.toml    | 2 | cannot read the case file
        $ --step 3          | 2 | --step & --steps
        $ --steps 0         | 2 | '0' & --steps & at least 1
        $ --steps -3        | 2 | '-3' & --steps & at least 1
        $ --steps 1.5       | 2 | --steps & whole number
        $ --steps 99999999999999999999 | 2 | --steps & at most 18446744073709551615
        $ --order four      | 2 | 'four' & --order & whole number
        $ --order -4        | 2 | '-4' & --order & whole number
        $ --solver newton   | 2 | --solver newton: this model has only one solver
        $ --every 0         | 2 | --every & at least 1
        $ --h -0.1          | 2 | '-0.1' & --h & positive
        $ --h 0             | 2 | --h & positive
        $ --h nan           | 2 | --h & finite
        $ --h inf           | 2 | --h & finite
        $ --force           | 2 | --out
        $ --h 10            | 1 | cannot take the first step & reduce the step size
        derive harmonic-roto --format text | 2 | no model `harmonic-roto`; did you mean
        derive harmonic-rotor --format pdf | 2 | 'pdf' & latex
",
    ) {
        let done = folder.rotor(&words.replace('$', "run harmonic-rotor"));
        let parts: Vec<&str> = parts.split(" & ").collect();
        done.ended(code.parse().expect("a code"))
            .prints_nothing()
            .says(&parts[..]);
    }
}

#[test]
fn more_samples_than_fit_are_refused_before_the_run() {
    let folder = Folder::new("too_many_samples");
    folder
        .rotor("run harmonic-rotor --steps 1000000000000 --every 1 --out @out")
        .refuses(["--every 1: ", "give --every "]);
    assert!(folder.names().is_empty());
}

#[test]
fn help_and_version_are_results() {
    for arguments in [&["--help"][..], &["run", "--help"], &["--version"]] {
        let done = rotor(arguments);
        done.ended(0).says_nothing();
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
        clebsch_cli::execute(arguments, &crate::rotor::gallery(), &mut streams),
        1
    );
    assert!(err.is_empty());
}

#[test]
fn the_program_itself_gives_its_exit_code() {
    let version = process_in(".", "--version");
    version.ended(0);
    assert_eq!(
        version.out,
        format!("clebsch {}\n", env!("CARGO_PKG_VERSION"))
    );
    let wrong = process_in(".", "run no-such-model");
    wrong.prints_nothing().refuses("no model `no-such-model`");
}
