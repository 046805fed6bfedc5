//! Names from arguments and files reach neither the terminal nor a plot as commands.

use crate::common::{Done, Folder, rotor, with};

/// A colour, a cleared screen, a line that claims success, a bell, a C1 control, a turned direction.
const NAME: &str = "x\u{1b}[31m\u{1b}[2J\nclebsch: done\r\u{7}\u{9b}1m\u{7f}\u{202e}y";

/// The escaped form of these characters.
const SHOWN: &str =
    "x\\u001b[31m\\u001b[2J\\u000aclebsch: done\\u000d\\u0007\\u009b1m\\u007f\\u202ey";

fn acts(letter: char) -> bool {
    letter != '\n' && (letter.is_control() || letter == '\u{202e}')
}

fn is_plain(done: &Done, what: &str) {
    for stream in [&done.out, &done.err] {
        assert!(!stream.contains(acts), "{what}: {stream:?}");
        let faked = stream.lines().any(|line| line.starts_with("clebsch: done"));
        assert!(!faked, "{what}: {stream:?}");
    }
}

#[test]
fn arguments() {
    let folder = Folder::new("names_in_arguments");
    let file = folder.path(&format!("{NAME}.clebsch"));
    std::fs::write(&file, "model \u{1b}[2J {").expect("a file");
    let toml = folder.path(&format!("{NAME}.toml"));
    std::fs::write(&toml, "h = 1").expect("a file");
    let out = folder.path(NAME);
    let model = "harmonic-rotor";
    let requests: &[&[&str]] = &[
        &["run", NAME],
        &["case", NAME],
        &["compare", NAME],
        &["derive", NAME],
        &["derive", &file],
        &["derive", &toml],
        &["run", &file],
        &["run", &toml],
        &["case", model, "--case", NAME],
        &["run", model, "--case", NAME],
        &["run", model, "--case", &toml],
        &["run", model, "--case", "\u{1b}none.toml"],
        &["run", model, "--solver", NAME],
        &["run", model, "--steps", "5", "--out", &out],
        &["run", model, "--steps", "5", "--out", &out],
    ];
    for arguments in requests {
        let done = rotor(arguments);
        is_plain(&done, &format!("{arguments:?}"));
        if arguments.contains(&NAME) {
            done.says(SHOWN);
        }
    }
    // The message of clap for unknown arguments, apart from newlines.
    let wrong = NAME.replace('\n', "");
    for arguments in [
        &["run", model, "--order", &wrong][..],
        &["run", model, &wrong],
        &[&wrong],
        &["derive", model, "--format", &wrong],
        &["run", model, &format!("--{wrong}")],
    ] {
        let done = rotor(arguments).exits(2);
        is_plain(&done, &format!("{arguments:?}"));
    }
    is_plain(
        &with(
            &crate::rotor::gallery(),
            &["derive", "-"],
            "model \u{1b}[2J",
            None,
        ),
        "input",
    );
}

#[test]
fn case_files() {
    let folder = Folder::new("names_in_files");
    let quoted = serde_json::to_string(NAME).expect("a string");
    // TOML does not allow a raw DEL in strings.
    let quoted = quoted.replace('\u{7f}', "\\u007f");
    let text = rotor("case harmonic-rotor").out;
    let changes = [
        ("name = \"swing\"", format!("name = {quoted}")),
        (
            "doc = \"Swings",
            format!("doc = {}Swings", &quoted[..quoted.len() - 1]),
        ),
        ("model = \"harmonic-rotor\"", format!("model = {quoted}")),
        ("kappa = 1.0", format!("{quoted} = 1.0")),
        ("h = 0.05", format!("h = 0.05\n{quoted} = 1")),
    ];
    for (index, (from, to)) in changes.iter().enumerate() {
        let changed = text.replace(from, to);
        assert_ne!(changed, text);
        let file = folder.write("case.toml", &changed);
        let out = folder.path(&format!("out{index}"));
        let run = [
            "run",
            "harmonic-rotor",
            "--case",
            &file,
            "--steps",
            "5",
            "--out",
            &out,
        ];
        let done = rotor(&run);
        is_plain(&done, &changed);
        assert_eq!(done.code, if index < 2 { 0 } else { 2 }, "{}", done.err);
        if index != 1 {
            let said = format!("{}{}", done.out, done.err);
            assert!(said.contains(SHOWN), "{said}");
        }
        if done.code == 0 {
            // XML allows no control characters, even written as entities.
            let svg = std::fs::read_to_string(format!("{out}/momentum.svg")).expect("the plot");
            assert!(
                !svg.contains(|letter| acts(letter) && letter != '\r'),
                "{svg:?}"
            );
            let json = std::fs::read_to_string(format!("{out}/run.json")).expect("run.json");
            let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
            if index == 0 {
                assert_eq!(json["case"], NAME);
            }
        }
        // JSON stays JSON, with the same string.
        let done = rotor(&[&run[..6], &["--json"]].concat());
        is_plain(&done, &changed);
        let json = done.json();
        if index == 0 {
            assert_eq!(json["case"], NAME);
        }
    }
}

/// The names of copies at sites are not written in a model. If such a name would print as another name or as a
/// symbol of the derivation, its site is printed in brackets.
#[test]
fn copies_at_sites_take_no_name_of_the_model() {
    let folder = Folder::new("names-of-copies");
    let modulus = r#"/// Elastic string with stiff stretching under its own weight.
model ElasticString {
    label i in 0..N step s;
    param m: Real at nodes;
    param E: Real at segments;
    param g: Vec<3>;
    field x: Vec<3> at nodes;
    let t = (next(x, i) - x)/s;
    let e = (dot(t, t) - 1)/2;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + h*m*dot(g, x) - h*s*E*e^2/2;
    end i = 0 { pinned { x = given; } free; }
    end i = N { free; pinned { x = given; } load { param force: Vec<3>; term h*dot(force, x); } }
}"#;
    let inertia = r#"model L6 {
    label i in 0..N step s;
    param S, B: Real; param m: Real at nodes;
    field φ: Vec<3> at nodes;
    group Λ: SO<3> at segments velocity ω;
    param J0: Sym<3>;
    advected J: Sym<3> at segments = Λ*J0*Λ^T;
    advected t: Vec<3> at segments = Λ*E3;
    constraint next(Λ) = ω*Λ;
    constraint next(J) = ω*J*ω^T;
    constraint next(t) = ω*t;
    let F = (next(φ, i) - φ)/s - t;
    lagrangian = m*dot(next(φ) - φ, next(φ) - φ)/(2*h) - s*tr(ω*J)/h - (h*s*S/2)*dot(F, F) + (h*B/s)*dot(t, next(t, i));
}"#;
    for (name, model, shown) in [
        ("modulus", modulus, "h E_{(1)} ((("),
        ("inertia", inertia, "J_{(0),k}"),
    ] {
        let file = folder.write(&format!("{name}.clebsch"), model);
        rotor(&format!("derive {file}")).succeeds().prints(shown);
        let case = folder.write(&format!("{name}.toml"), &rotor(&format!("case {file}")).out);
        rotor(&format!("run {file} --case {case} --steps 20")).succeeds();
    }
    // A name that the model declares twice is still rejected.
    let twice = inertia.replace("J0", "J_0");
    let file = folder.write("twice.clebsch", &twice);
    rotor(&format!("derive {file}")).ended(2);
}
