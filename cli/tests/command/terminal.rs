//! Output that fits a terminal, help on a terminal, and input from it.

use crate::common::{Folder, on, rotor, with};
use crate::rotor::gallery;
use clebsch_cli::gallery::Gallery;

const COMMANDS: [&str; 12] = [
    "list", "show", "case", "new", "check", "run", "sweep", "compare", "converge", "plot",
    "figures", "derive",
];

/// Lines of at most this many characters.
fn fits(text: &str, width: usize, what: &str) {
    assert!(!text.is_empty(), "{what}");
    for line in text.lines() {
        let letters = line.chars().count();
        assert!(
            letters <= width,
            "{what}, {letters} letters of {width}: {line}"
        );
    }
}

#[test]
fn help_fits_and_has_examples() {
    for width in [40, 60, 80, 100, 200] {
        let help = |arguments: &[&str]| {
            let done = with(&gallery(), arguments, "", Some(width)).succeeds();
            fits(&done.out, width.min(100), &format!("{arguments:?}"));
            done.out
        };
        let short = help(&["--help"]);
        for command in COMMANDS {
            assert!(short.contains(command), "{command}");
            let long = help(&[command, "--help"]);
            let examples = long.split("Examples:\n").nth(1).expect("examples");
            let example = format!("\n  clebsch {command}");
            assert!(format!("\n{examples}").contains(&example), "{long}");
        }
        assert!(short.contains("Examples:\n"));
    }
    // Without a terminal, lines have the width of a page.
    fits(&rotor("run --help").out, 100, "no terminal");
}

/// Every example of the help runs, on the shipped models.
#[test]
fn examples_of_the_help_are_understood() {
    for command in COMMANDS {
        let help = rotor(&format!("{command} --help")).out;
        let examples = help.split("Examples:\n").nth(1).expect("examples");
        for line in examples
            .lines()
            .filter(|line| line.starts_with("  clebsch "))
        {
            let words = line.split_whitespace().skip(1);
            let words: Vec<&str> = words
                .take_while(|word| !["<", ">"].contains(word))
                .collect();
            // Checks only that these are valid arguments for existing models, not the computation itself.
            let matched = clebsch_cli::arguments::command(None)
                .try_get_matches_from([&["clebsch"], &words[..]].concat());
            assert!(matched.is_ok(), "{line}: {}", matched.unwrap_err());
            let named = words
                .get(1)
                .is_some_and(|word| word.ends_with("-top") || word.ends_with("-body"));
            if named {
                assert!(Gallery::shipped().find(words[1]).is_ok(), "{line}");
            }
        }
    }
}

/// Long, since every derivation is printed in four widths. Equations are broken before the signs of their sums,
/// without losing anything.
#[test]
fn derivations_fit() {
    let gallery = Gallery::shipped();
    let words = |text: &str| -> String { text.split_whitespace().collect() };
    for entry in &gallery.entries {
        let model = entry.card.kebab;
        for arguments in [&["derive", model][..], &["derive", model, "--explain"]] {
            let page = on(&gallery, arguments).out;
            for width in [40, 60, 80, 132] {
                let what = format!("{arguments:?}, {width}");
                let done = with(&gallery, arguments, "", Some(width)).succeeds();
                fits(&done.out, width, &what);
                // The underline of a heading has the width of the heading, so rules are not compared.
                let lines = |text: &str| -> Vec<String> {
                    let rule =
                        |line: &&str| !line.is_empty() && line.chars().all(|c| "=-".contains(c));
                    text.lines()
                        .filter(|line| !rule(line))
                        .map(str::to_owned)
                        .collect()
                };
                assert_eq!(
                    words(&lines(&done.out).join(" ")),
                    words(&lines(&page).join(" ")),
                    "{what}"
                );
                // Displayed equations: numbered, or going on behind the number.
                let displayed =
                    |line: &&str| line.starts_with("  (") || line.starts_with("        ");
                for line in done.out.lines().filter(displayed) {
                    let sign = [" +", " -", " =", " :="]
                        .iter()
                        .any(|sign| line.ends_with(sign));
                    assert!(!sign, "{what}: {line}");
                }
            }
        }
    }
}

#[test]
fn tables_fit() {
    for width in [60, 80, 120] {
        let done = with(&Gallery::shipped(), &["list"], "", Some(width)).succeeds();
        fits(&done.out, width, "list");
        for entry in Gallery::shipped().entries {
            done.prints(entry.card.kebab);
        }
        for model in ["heavy-top", "kirchhoff-body", "coupled-bodies"] {
            let run = ["run", model, "--steps", "20"];
            let done = with(&Gallery::shipped(), &run, "", Some(width)).succeeds();
            fits(&done.out, width, model);
            // The words are unchanged without a width limit.
            let wide = on(&Gallery::shipped(), &run).out;
            for word in wide
                .split_whitespace()
                .filter(|word| word.chars().count() < 14)
            {
                done.prints(word);
            }
        }
        let compare = ["compare", "heavy-top", "--steps", "10"];
        let done = with(&Gallery::shipped(), &compare, "", Some(width)).succeeds();
        fits(&done.out, width, "compare");
    }
}

#[test]
fn what_was_meant_is_understood_or_answered() {
    let folder = Folder::new("meant");
    rotor("run harmonic-rotor --steps 2e3 --json")
        .succeeds()
        .prints("\"steps\":2000");
    let text = rotor("case harmonic-rotor").out;
    let file = folder.write("case.toml", text.replace("steps = 2000", "steps = 1e2"));
    let done = folder.rotor("run harmonic-rotor --case @case.toml --json");
    done.prints("\"steps\":100");
    for wrong in ["1e-3", "1.5", "1e300", "1e"] {
        rotor(&format!("run harmonic-rotor --steps {wrong}"))
            .refuses("give a whole number, such as 20000 or 2e4");
    }

    let run = format!("clebsch run harmonic-rotor --case {file}");
    for command in ["derive", "run", "compare", "case"] {
        folder
            .rotor(&format!("{command} @case.toml"))
            .refuses("is a case file")
            .says(&run);
    }
    let done = rotor("derive nowhere.toml");
    done.says("clebsch run MODEL --case nowhere.toml");

    let model = folder.write("my.clebsch", "model My {}");
    for name in [model.as_str(), "nowhere.clebsch"] {
        let done = rotor(&format!("run {name}")).exits(2);
        assert_eq!(done.err, rotor(&format!("derive {name}")).err);
    }
}

const SOURCE: &str = "model Body {
    param J: Sym<3>;
    group R: SO<3> velocity W;
    constraint next(R) = R*W;
    lagrangian = -tr(J*W)/h;
}
";

#[test]
fn a_model_is_read_from_standard_input() {
    let derive = |arguments: &[&str], input: &str| {
        let done = with(&gallery(), &[&["derive"], arguments].concat(), input, None);
        (done.code, done.out, done.err)
    };
    let folder = Folder::new("standard_input");
    let file = folder.write("body.clebsch", SOURCE);
    let (code, out, err) = derive(&["-"], SOURCE);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(out, derive(&[&file], "").1);
    let (code, out, err) = derive(&["-"], &SOURCE.replace("*W)/h", "*V)/h"));
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("standard input:5:"), "{err}");
    let (code, _, err) = derive(&["-"], " \n");
    assert_eq!(code, 2);
    assert!(err.contains("standard input is empty"), "{err}");

    // The extension of a file also selects the format.
    for (format, ending) in [
        ("latex", "tex"),
        ("markdown", "md"),
        ("rust", "rs"),
        ("text", "txt"),
    ] {
        let (code, long, _) = derive(&["-", "--format", format], SOURCE);
        assert_eq!(code, 0);
        assert_eq!(
            derive(&["-", "--format", ending], SOURCE).1,
            long,
            "{format}"
        );
    }

    // Each proof has its own flag.
    let plain = derive(&["-"], SOURCE).1;
    let second = "Second proof, by equality saturation";
    let explained = derive(&["-", "--explain"], SOURCE).1;
    assert!(explained.starts_with(&plain) && explained.len() > plain.len());
    assert!(!explained.contains(second), "{explained}");
    let (code, proved, said) = derive(&["-", "--second-proof"], SOURCE);
    if !cfg!(feature = "second-proof") {
        assert_eq!(code, 2);
        assert!(said.contains("--features second-proof"), "{said}");
        return;
    }
    assert!(
        proved.starts_with(&plain) && proved.contains(second),
        "{proved}"
    );
    let both = derive(&["-", "--explain", "--second-proof"], SOURCE).1;
    assert!(both.starts_with(&explained) && both.contains(second));
}

const MOTIONS: &str = "model Falling {
    param J: Sym<3>;
    param m: Real;
    param Z: Vec<4>;
    group G: SE<3> velocity V;
    advected P: Vec<4> = G^T*Z;
    constraint next(G) = G*V;
    constraint next(P) = V^T*P;
    lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - h*m*dot(P, P);
}
";

/// The position occurs by itself, and so does the metric of the whole group.
const SPRING: &str = "model Spring {
    param J: Sym<3>;
    param m, s: Real;
    param a, o: Vec<3>;
    group G: SE<3> velocity V;
    constraint next(G) = G*V;
    let x = pos(next(G)) - pos(G);
    let y = pos(G) + rot(G)*a - o;
    lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - h*s/2*dot(y, y);
}
";

/// Rigid motions and rotations of any dimension are printed on the terminal without the inclusion ι, and vectors of
/// six components in parts; pages of a paper have letters for them.
#[test]
fn vectors_of_six_are_derived_in_parts() {
    for (name, input) in [
        ("kirchhoff-body", ""),
        ("body-n", ""),
        ("-", MOTIONS),
        ("-", SPRING),
    ] {
        let derive = ["derive", name];
        let done = with(&Gallery::shipped(), &derive, input, None).succeeds();
        let inclusions: Vec<&str> = done.out.lines().filter(|line| line.contains('ι')).collect();
        assert!(inclusions.is_empty(), "{name}: {inclusions:#?}");
        if name != "body-n" {
            // The momentum of an edge gets another letter if the model has an M.
            let edge = match done.out.contains("param M:") {
                true => "Π",
                false => "M",
            };
            let [angular, linear] = ["ang", "lin"].map(|part| format!("{part}({edge}_"));
            done.prints([
                &*angular,
                &*linear,
                "ang(μ_k) = ",
                "lin(μ_k) = ",
                "ang and lin",
            ]);
            let page = [&derive[..], &["--format", "latex"]].concat();
            let page = with(&Gallery::shipped(), &page, input, None).out;
            assert!(!page.contains("\\iota"), "{name}");
        }
    }
    // The table of a run contains no inclusions either.
    let run = ["run", "kirchhoff-body", "--steps", "3"];
    let done = on(&Gallery::shipped(), &run);
    assert!(!done.out.contains('ι'), "{}", done.out);
}
