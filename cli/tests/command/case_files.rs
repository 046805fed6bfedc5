//! Case files: `clebsch case` prints text that parses to the same bits, and every mistake is reported with its file,
//! line and key.

use crate::common::{Folder, on, rotor, table};
use crate::rotor::{CARD, case};
use clebsch_cli::case_file;
use clebsch_cli::failure::Failure;
use clebsch_cli::gallery::Gallery;

/// Line of the printed case that contains `key`.
fn line_of(text: &str, key: &str) -> usize {
    1 + text
        .lines()
        .position(|line| line.starts_with(key))
        .expect("the key is there")
}

/// The printed case with the value of `key`, which may span lines, replaced.
fn with(key: &str, value: &str) -> String {
    let text = case_file::write(&CARD, &case(), CARD.kebab);
    let start = text.find(&format!("\n{key} = ")).expect("the key is there") + 1;
    let rest = &text[start..];
    let end = if rest[key.len()..].starts_with(" = [\n") {
        rest.find("\n]\n").expect("the matrix ends") + 2
    } else {
        rest.find('\n').expect("the line ends")
    };
    format!("{}{key} = {value}{}", &text[..start], &rest[end..])
}

#[test]
fn a_printed_case_reads_back_bit_by_bit() {
    let done = rotor("case harmonic-rotor").succeeds();
    let read = case_file::read("x.toml", &done.out, &CARD).expect("it reads");
    assert_eq!(read.case, case());
    assert_eq!(read.lines["parameters.kappa"], line_of(&done.out, "kappa"));
}

#[test]
fn a_file_runs_like_the_case_it_was_printed_from() {
    let folder = Folder::new("file_like_case");
    let printed = rotor("case harmonic-rotor").out;
    folder.write("mine.toml", &printed);
    let from_file = folder.rotor("run harmonic-rotor --case @mine.toml");
    let named = rotor("run harmonic-rotor");
    from_file.ended(0);
    assert_eq!(from_file.out, named.out);
}

#[test]
fn a_rotation_may_be_a_quaternion_and_a_number_an_integer() {
    // A rotation about the first axis by 2 acos 0.8, as the matrix in the case.
    let text = with("Lambda", "[0.894427190999916, 0.447213595499958, 0, 0]")
        .replace("kappa = 1.0", "kappa = 1");
    let read = case_file::read("x.toml", &text, &CARD).expect("it reads");
    let matrix = &read.case.initial[0];
    for (entry, expected) in matrix.iter().zip(&case().initial[0]) {
        // Three products of numbers of size one.
        assert!((entry - expected).abs() < 1e-15, "{matrix:?}");
    }
    assert_eq!(read.case.parameters[1], [1.0]);
}

#[test]
fn name_doc_and_bounds_may_be_left_out() {
    let text = rotor("case harmonic-rotor").out;
    let kept: Vec<&str> = text
        .lines()
        .take_while(|line| *line != "[bounds]")
        .filter(|line| !line.starts_with("name") && !line.starts_with("doc"))
        .collect();
    let read = case_file::read("some/where.toml", &kept.join("\n"), &CARD).expect("it reads");
    assert_eq!(read.case.name, "where");
    assert_eq!(read.case.doc, "");
    assert!(read.case.bounds.is_empty());
}

#[test]
fn every_mistake_is_named_with_file_and_line() {
    // Key replaced, its new value, what the message says after the position.
    for [key, value, message] in table(
        r#"
        model  | "other"                        | model: this case is for `other`, not for `harmonic-rotor`
        model  | 3                              | model: expected a string, found a value of type integer
        name   | []                             | name: expected a string, found a value of type array
        h      | -0.1                           | h: -0.1 is not positive; give a positive step size; to run backwards in time, reverse all initial momenta
        h      | 0                              | h: 0 is not positive; give a positive, finite step size
        h      | nan                            | h: NaN is not a finite number
        h      | inf                            | h: inf is not a finite number
        h      | 1e999                          | h: inf is not a finite number
        h      | "0.1*q"                        | h: "0.1*q": `q` has no value here; an expression may contain the step and parameters that are single numbers: kappa
        steps  | 0                              | steps: must be a whole number, at least 1, found 0
        steps  | -7                             | steps: must be a whole number, at least 1, found -7
        steps  | 10.5                           | steps: must be a whole number, at least 1, found 10.5
        kappa  | [1.0]                          | parameters.kappa: expected a number, found a vector of 1 numbers
        kappa  | true                           | parameters.kappa: expected a number, found a value of type boolean
        z      | [1.0, 2.0]                     | parameters.z: expected a vector of 3 numbers [a, ..], found a vector of 2 numbers
        z      | 1.0                            | parameters.z: expected a vector of 3 numbers [a, ..], found one number
        z      | [1.0, nan, 0.0]                | parameters.z: NaN is not a finite number
        z      | [1.0, "a", 0.0]                | parameters.z: "a": `a` has no value here; an expression may contain
        J      | [1.0, 1.0, 1.0]                | parameters.J: expected a symmetric 3x3 matrix [[..], ..], written in full, found a vector of 3
        J      | [[1, 0], [0, 1]]               | parameters.J: expected a symmetric 3x3 matrix [[..], ..], written in full, found a 2x2 matrix
        J      | [[1, 0, 0], [0, 1], [0, 0, 1]] | parameters.J: expected a symmetric 3x3 matrix [[..], ..], written in full, found an array that
        Lambda | [1.0, 0.0, 0.0]                | initial.Lambda: expected a 3x3 matrix [[..], [..], [..]], a unit quaternion [w, x, y, z], { axis =
        Lambda | [1.0, 1.0, 0.0, 0.0]           | initial.Lambda: the quaternion has norm 1.414
        Lambda | [1.00001, 0.0, 0.0, 0.0]       | initial.Lambda: the quaternion has norm 1.00001
        energy | -1                             | bounds.energy: a bound must not be negative, found -1
        energy | inf                            | bounds.energy: inf is not a finite number
"#,
    ) {
        let text = with(key, value);
        let place = format!(
            "dir/a.toml:{}: {message}",
            line_of(&text, &format!("{key} = "))
        );
        let found = case_file::read("dir/a.toml", &text, &CARD).expect_err(value);
        assert!(matches!(found, Failure::Usage(_)), "{found:?}");
        let found = found.to_string();
        assert!(
            found.starts_with(&place),
            "expected\n{place}\nfound\n{found}"
        );
    }
}

#[test]
fn unknown_and_missing_keys_are_named() {
    let text = rotor("case harmonic-rotor").out;
    // `#` means the line of the changed key.
    for [old, new, message] in table(
        r#"
        \nh =        | \nstep =      | :#: unknown key `step` at the top level; did you mean `steps`?
        \nkappa      | \nkapa        | :#: unknown key `kapa` in [parameters]; did you mean `kappa`?
        \nLambda     | \n"Λ"         | :#: unknown key `Λ` in [initial]; did you mean `Lambda`?
        \nenergy     | \nenrgy       | :#: unknown key `enrgy` in [bounds]; did you mean `energy`?
        \n[initial]  | \n[intial]    | :#: unknown key `intial` at the top level; did you mean `initial`?
        \nh =        | \n#           | : missing key `h`: the step size
        \nmodel =    | \n#           | : missing key `model`: the model's name, "harmonic-rotor"
        \nkappa      | \n# kappa     | :[parameters]: missing key `parameters.kappa`: a number
        \nh =        | \nh ==        | :#: not TOML:
        \nsteps      | \nh = 2\nsteps | :#: not TOML: duplicate key
        \n[initial]  | \n[initial    | :#: the bracket `[` on this line is not closed; write `]` at the end of the name of the table
"#,
    ) {
        let changed = text.replacen(old, new, 1);
        assert_ne!(changed, text);
        let line = |key: &str| line_of(&text, key).to_string();
        let message = message.replace('#', &line(old.trim_start()));
        let message = message.replace("[parameters]:", &format!("{}:", line("[parameters]")));
        let found = case_file::read("a.toml", &changed, &CARD).expect_err(new);
        assert!(matches!(found, Failure::Usage(_)), "{found:?}");
        let (found, message) = (found.to_string(), format!("a.toml{message}"));
        assert!(
            found.starts_with(&message),
            "expected\n{message}\nfound\n{found}"
        );
    }
    let short = "model = \"harmonic-rotor\"\nh = 1\nsteps = 1\n";
    let refused = |text: &str| {
        case_file::read("a.toml", text, &CARD)
            .expect_err("refused")
            .to_string()
    };
    assert_eq!(
        refused(short),
        "a.toml: missing table [parameters] with keys J, kappa, z"
    );
    assert_eq!(
        refused(&format!("{short}parameters = 3\n")),
        "a.toml:4: parameters: expected a table [parameters], found a value of type integer"
    );
}

#[test]
fn data_that_the_model_refuses_are_placed_in_their_file() {
    let folder = Folder::new("refused_data");
    for [key, value, message] in table(
        "
        J      | [[1, 0, 0], [0, 1, 0], [0, 0, -3]]  | parameters.J:
        J      | [[1, 0.2, 0], [0, 1, 0], [0, 0, 1]] | parameters.J: not symmetric:
        Lambda | [[1, 0, 0], [0, 1, 0], [0, 0, -1]]  | initial.Lambda:
        Lambda | [[1, 0, 0], [0, 1, 0], [0, 0, 1.1]] | initial.Lambda:
",
    ) {
        let text = with(key, value);
        let file = folder.write("case.toml", &text);
        let done = folder
            .rotor("run harmonic-rotor --case @case.toml")
            .exits(2);
        let expected = format!(
            "clebsch: {file}:{}: {message}",
            line_of(&text, &format!("{key} = "))
        );
        assert!(
            done.err.starts_with(&expected),
            "expected\n{expected}\nfound\n{}",
            done.err
        );
        assert_eq!(done.out, "");
    }
}

/// The text of a case with a key and its value, of one line or several, replaced by a line.
fn replaced(text: &str, key: &str, line: &str) -> String {
    let own = format!("{key} = ");
    let (mut found, mut inside) = (false, false);
    let mut out = Vec::new();
    for l in text.lines() {
        let starts = l.starts_with(&own);
        inside = starts || (inside && l.starts_with([' ', ']']));
        if starts {
            out.push(line);
            found = true;
        } else if !inside {
            out.push(l);
        }
    }
    assert!(found, "no {key}");
    out.join("\n")
}

/// The values of a shipped model's case with one key replaced by another line.
fn shipped_with(model: &str, key: &str, line: &str) -> Result<Vec<Vec<f64>>, String> {
    let gallery = Gallery::shipped();
    let text = replaced(&on(&gallery, &["case", model]).out, key, line);
    let card = gallery.find(model).expect("a model").card;
    match case_file::read("a.toml", &text, &card) {
        Ok(read) => {
            let values = read.case.parameters.into_iter();
            Ok(values.chain(read.case.initial).collect())
        }
        Err(failure) => Err(failure.to_string()),
    }
}

#[test]
fn the_inertia_may_stand_where_second_moments_are_asked_for() {
    // I = tr(J) Id - J: J = (2.5, 1.5, 0.5) has the moments (2, 3, 4).
    let expected = vec![2.5, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.5];
    let forms = [
        "I = [2, 3, 4]",
        "I = [[2, 0, 0], [0, 3, 0], [0, 0, 4]]",
        "J = { I = [2.0, 3.0, 4.0] }",
        "J = { I = [[2, 0, 0], [0, 3, 0], [0, 0, 4]] }",
        "J = [[2.5, 0, 0], [0, 1.5, 0], [0, 0, 0.5]]",
    ];
    for model in [
        "free-body",
        "heavy-top",
        "kirchhoff-body",
        "free-body-spatial",
    ] {
        for form in forms {
            let values = shipped_with(model, "J", form).expect(form);
            assert!(values.contains(&expected), "{model}, {form}: {values:?}");
        }
    }
    // If there are several bodies, each has its own key.
    let values = shipped_with("coupled-bodies", "J2", "I2 = [2, 3, 4]").expect("I2");
    assert!(values.contains(&expected), "{values:?}");
    // Products of inertia change their sign.
    let line = "I = [[2, 0.1, 0], [0.1, 3, 0], [0, 0, 4]]";
    let values = shipped_with("free-body", "J", line).expect(line);
    assert_eq!(values[0], [2.5, -0.1, 0.0, -0.1, 1.5, 0.0, 0.0, 0.0, 0.5]);
}

#[test]
fn wrong_inertias_are_named() {
    for [line, what] in table(
        r#"
        J = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nI = [1, 1, 1] | given twice
        I = [1, 1]                               | principal moments of inertia
        I = 3                                    | principal moments of inertia
        I = [1, 1]                               | parameters.I: expected
        I = [[2, 0.1, 0], [0.2, 3, 0], [0, 0, 4]] | parameters.I: not symmetric: entry (1, 2) is 0.1 but (2, 1) is 0.2
        J = { I = [[2, 0, 0], [0, 3, 1], [0, 0, 4]] } | parameters.J.I: not symmetric: entry (2, 3) is 1 but (3, 2) is 0
        I = [1, nan, 1]                          | parameters.I: NaN is not a finite number
        I = [1, 'a', 1]                          | parameters.I: "a": `a` has no value
        J = { I = [1, 1, 1], K = 2 }             | symmetric 3x3 matrix
        I1 = [1, 1, 1]                           | unknown key `I1`
                                                 | missing key `parameters.J`
"#,
    ) {
        let found = shipped_with("free-body", "J", line).expect_err(line);
        assert!(found.contains(what), "{line}: {found}");
    }
    // If the model asks for an inertia, a given inertia is not converted.
    let found = shipped_with("cayley-klein", "I", "I = { I = [1, 1, 1] }");
    assert!(found.is_err());
}

#[test]
fn an_inertia_that_no_body_has_is_refused_by_its_moments() {
    // I = (2.5, 1.3, 0.8) is positive, and J = (-0.2, 1, 1.5) is not.
    let gallery = Gallery::shipped();
    let folder = Folder::new("no-body");
    let text = on(&gallery, &["case", "free-body"]).out;
    let of_inertia = ["moments of inertia must satisfy I1 <= I2 + I3; 2.5 > 2.1"];
    let of_moments = [
        "of the other two, which is impossible for a body",
        "positive moments of inertia are not enough",
    ];
    for (line, told) in [
        ("I = [2.5, 1.3, 0.8]", of_inertia.as_slice()),
        ("J = [[-0.2, 0, 0], [0, 1, 0], [0, 0, 1.5]]", &of_moments),
    ] {
        let file = folder.write("a.toml", replaced(&text, "J", line));
        let ran = on(
            &gallery,
            &["run", "free-body", "--case", &file, "--steps", "1"],
        );
        for words in told {
            ran.says(words);
        }
    }
}

#[test]
fn a_kinetic_energy_that_is_not_positive_is_warned_of_at_the_start() {
    let gallery = Gallery::shipped();
    let folder = Folder::new("kinetic-warning");
    let text = on(&gallery, &["case", "kirchhoff-body"]).out;
    let with = |m: &str| {
        let line = format!("M = [[{m}, 0, 0], [0, 2, 0], [0, 0, 3]]");
        let file = folder.write("a.toml", replaced(&text, "M", &line));
        let arguments = ["run", "kirchhoff-body", "--case", &file, "--steps", "1"];
        let plain = on(&gallery, &arguments).err;
        let json = on(&gallery, &[&arguments[..], &["--json"]].concat()).out;
        (plain, json)
    };
    let (sound, json) = with("1.5");
    assert!(!sound.contains("warning"), "{sound}");
    assert!(json.contains("\"warnings\":[]"), "{json}");
    let (negative, json) = with("-1.5");
    for words in [
        "negative in 1 of 6",
        "this applies to I = tr(J) Id - J",
        "kinetic minus potential",
    ] {
        assert!(
            negative.contains(words) && json.contains(words),
            "{negative}\n{json}"
        );
    }
    for model in &gallery.entries {
        for case in &model.cases {
            on(
                &gallery,
                &[
                    "run",
                    model.card.kebab,
                    "--case",
                    &case.name,
                    "--steps",
                    "1",
                ],
            )
            .never_says("warning");
        }
    }
}
