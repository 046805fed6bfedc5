//! Sweeps: which quantities vary, and that neither parts nor kills change a byte of the table.

use crate::common::{Done, Folder, Samples, clebsch, runs, table};
use std::fs;

const FILES: [&str; 3] = ["sweep.csv", "sweep.json", "sweep.npz"];

fn sweep(out: &str, more: &[&str]) -> Done {
    let mut all = vec!["sweep", "heavy-top", "--steps", "200", "--out", out];
    all.extend(["--vary", "gU.z=0:1:5", "--vary", "h=0.1,0.05,5"]);
    all.extend(more);
    clebsch(&all)
}

fn same(one: &str, other: &str) {
    for file in FILES {
        let read = |folder: &str| fs::read(format!("{folder}/{file}")).expect("there");
        assert!(read(one) == read(other), "{one} and {other}: {file}");
    }
}

fn column(folder: &str, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(format!("{folder}/sweep.csv")).expect("there");
    Samples::of(&text).column(name)
}

#[test]
fn a_row_is_the_run_of_its_point() {
    let folder = Folder::new("sweep-rows");
    let out = folder.path("sweep");
    let done = sweep(&out, &[]).exits(1);
    done.prints("15 points");
    done.prints("10 complete, 0 stopped early, 5 refused");
    // The step of 5 is the third value of the axis that varies first.
    done.says("the first refused point, 2: ");
    let values = column(&out, "gU.z");
    assert_eq!(values[..4], [0.0, 0.0, 0.0, 0.25]);
    assert_eq!(column(&out, "h")[..4], [0.1, 0.05, 5.0, 0.1]);
    assert_eq!(column(&out, "status")[..4], [0.0, 0.0, 2.0, 0.0]);
    // Point number four of the grid, given by a case file.
    let case = clebsch("case heavy-top").out;
    let lines = case.lines().map(|line| match line.starts_with("gU = ") {
        true => "gU = [0.0, 0.0, 0.25]".to_owned(),
        false => line.to_owned(),
    });
    let text: Vec<String> = lines.collect();
    let file = folder.path("case.toml");
    fs::write(&file, text.join("\n")).expect("written");
    folder.runs("run heavy-top --case @case.toml --steps 200 --h 0.1 --out @run");
    let text = folder.read("run/trajectory.csv");
    let (header, last) = (
        text.lines().next().expect("a header"),
        text.lines().last().expect("a row"),
    );
    for name in ["Lambda_11", "body_momentum_3", "Gamma_2"] {
        let at = header.split(',').position(|n| n == name).expect("a column");
        let expected: f64 = last
            .split(',')
            .nth(at)
            .expect("a cell")
            .parse()
            .expect("a number");
        assert_eq!(
            column(&out, name)[3].to_bits(),
            expected.to_bits(),
            "{name}"
        );
    }
    // It differs from the row of its neighbour.
    assert!(column(&out, "Lambda_11")[3] != column(&out, "Lambda_11")[0]);
}

#[test]
fn a_row_stopped_by_an_infinite_number_has_the_last_finite_state() {
    let folder = Folder::new("sweep-overflow");
    let model = "model Grow { param k: Real; field q: Real; lagrangian = (next(q) - q)^2/(2*h) + h*k*q^2/2; }";
    folder.write("grow.clebsch", model);
    let case = "model = \"grow\"\nh = 1.0\nsteps = 60\n[parameters]\nk = 1e6\n[initial]\nq = 1.0\nmomentum = 0.5\n";
    folder.write("grow.toml", case);
    folder.clebsch("sweep @grow.clebsch --vary k=1,1e6 --out @sweep");
    folder.clebsch("run @grow.clebsch --out @run");
    let text = folder.read("run/trajectory.csv");
    let last = text.lines().last().and_then(|row| row.split(',').nth(2));
    let expected: f64 = last.and_then(|q| q.parse().ok()).expect("a number");
    assert!(expected > 1e100, "{text}");
    let out = folder.path("sweep");
    assert_eq!(column(&out, "status"), [0.0, 1.0]);
    assert_eq!(column(&out, "q")[1].to_bits(), expected.to_bits());
}

/// As in a case file, a name without the number of a site means all sites. For an end it means the parameter of
/// the end.
#[test]
fn along_a_line_the_names_are_those_of_the_case_file() {
    let folder = Folder::new("sweep-line");
    let model = "model Beads { label i in 0..N; param m: Real at nodes; param k: Real; field x: Vec<2> at nodes; \
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*k*dot(next(x, i) - x, next(x, i) - x)/2; \
        end i = 0 { free; } end i = N { pulled { param F: Vec<2>; term h*dot(F, x); } } }";
    let model = folder.write("beads.clebsch", model);
    let case = "model = \"beads\"\nname = \"own\"\nh = 0.1\nsteps = 1\n[labels]\ni = 2\n[ends]\ni = [\"free\", \"pulled\"]\n\
        [parameters]\nm = 1.0\nk = 1.0\nF = [1.0, 0.0]\n[initial]\nx = [0.0, 0.0]\nmomentum_x = [1.0, 0.0]\n";
    let case = folder.write("own.toml", case);
    let last = |vary: &str| {
        let out = folder.path("out");
        let arguments = [
            "sweep", &model, "--case", &case, "--out", &out, "--force", "--vary", vary,
        ];
        runs(&arguments);
        ["x_0_1", "x_1_1", "x_2_1", "x_2_2"].map(|name| *column(&out, name).last().expect("a row"))
    };
    // One step moves each site by h p/m; the last site moves by an additional h^2 F/(2 m).
    let near = |found: [f64; 4], wanted: [f64; 4]| {
        let apart: Vec<f64> = found
            .iter()
            .zip(wanted)
            .map(|(a, b)| (a - b).abs())
            .collect();
        assert!(apart.iter().all(|x| *x < 1e-15), "{found:?} {wanted:?}");
    };
    near(last("m=1,2"), [0.05, 0.05, 0.0525, 0.0]);
    near(last("m_1=1,2"), [0.1, 0.05, 0.105, 0.0]);
    near(last("F.2=0,4"), [0.1, 0.1, 0.105, 0.02]);
    near(last("F_N.2=0,4"), [0.1, 0.1, 0.105, 0.02]);
    near(last("momentum_x.1=0,3"), [0.3, 0.3, 0.305, 0.0]);
    for [vary, more, says] in table(
        "
        m=1,2 | m_2=3   | --vary m_2: given twice, since --vary m sets the same number
        F.1=1 | F_N.1=1 | sets the same number
        F=1   | k=1     | `F` has 2 numbers; name one, such as F.1
        q=1   | k=1     | it has m, k, F, x, momentum_x, velocity_x and the step h
",
    ) {
        let (out, start) = (folder.path("none"), ["sweep", &model, "--case", &case]);
        let done =
            clebsch(&[&start[..], &["--out", &out, "--vary", vary, "--vary", more]].concat())
                .exits(2);
        let all = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(all.contains(says), "{vary}: {all}");
    }
}

#[test]
fn parts_are_joined_to_the_table_of_the_whole() {
    let folder = Folder::new("sweep-parts");
    let whole = folder.path("whole");
    assert_eq!(sweep(&whole, &[]).code, 1);
    let parts: Vec<String> = (1..=4)
        .map(|part| folder.path(&format!("part-{part}")))
        .collect();
    for (part, out) in parts.iter().enumerate() {
        sweep(out, &["--shard", &format!("{}/4", part + 1)]).exits(1);
    }
    let collect = |parts: &[&String], out: &str| {
        let mut all = vec!["collect", "--out", out];
        all.extend(parts.iter().map(|part| part.as_str()));
        clebsch(&all)
    };
    let joined = folder.path("joined");
    let [a, b, c, d] = [&parts[0], &parts[1], &parts[2], &parts[3]];
    collect(&[c, a, d, b], &joined).exits(1);
    same(&whole, &joined);
    // Parts that are incomplete or from different sweeps are reported.
    let refused = |parts: &[&String], says: &str| {
        collect(parts, &folder.path("none")).refuses(says);
    };
    refused(&[a, b, d], "is missing: 3 of 4");
    refused(&[a, b, b, c, d], "given twice");
    refused(&[a, &whole], "not of a part");
    let other = folder.path("other");
    assert_eq!(sweep(&other, &["--shard", "4/4", "--order", "4"]).code, 1);
    // The order does not belong to the case, and the columns do not contain it.
    let text = folder.read("other/sweep.json");
    assert!(text.contains("\"order\": 4"), "{text}");
    refused(&[a, b, c, &other], "belongs to another sweep");
    let csv = format!("{d}/sweep.csv");
    let text = fs::read_to_string(&csv).expect("there");
    let cut = text.trim_end().rsplit_once('\n').expect("lines").0;
    fs::write(&csv, cut).expect("written");
    refused(&[a, b, c, d], "damaged");
    assert!(!folder.names().contains(&"none".to_owned()));
}

#[test]
fn wrong_axes_are_named() {
    let folder = Folder::new("sweep-wrong");
    let out = folder.path("out");
    for (vary, says) in [
        ("gU", "NAME=FROM:TO:COUNT"),
        ("gU=1", "name one, such as gU.1"),
        ("mass=1", "no such parameter"),
        ("gU.w=1", "components gU.1 to gU.3"),
        ("h=a", "`a` is not a number"),
        ("h=1:2", "three parts"),
        ("h=1:2:0", "give 1 to"),
        ("Lambda.11=1", "it would no longer be a rotation"),
        ("h=0:1:1000000", ""),
    ] {
        let more: &[&str] = match says {
            "" => &["--vary", "gU.x=0:1:1000000"],
            _ => &[],
        };
        let mut all = vec!["sweep", "heavy-top", "--out", &out, "--vary", vary];
        all.extend(more);
        clebsch(&all).refuses(says);
    }
    folder
        .clebsch("sweep heavy-top --out @out --vary gU.z=1 --vary gU.3=2")
        .refuses("given twice");
    folder
        .clebsch("sweep heavy-top --out @out --vary gU.z=0:1:3 --set gU.3=5")
        .refuses("`--set gU.3=5` sets the same number; remove one of them");
    assert!(folder.names().is_empty());
}

#[cfg(unix)]
#[test]
fn killed_sweeps_go_on_with_what_is_left() {
    use crate::signals::{begun, ended_by, succeeds, wait_for, written};
    let folder = Folder::new("sweep-killed");
    let [whole, out] = ["whole", "killed"].map(|name| folder.path(name));
    let words = |out: &str| {
        format!("sweep heavy-top --steps 30000 --vary gU.z=0:1:60 --resume --out {out}")
    };
    assert!(succeeds(&words(&whole)));
    for signal in ["-KILL", "-INT", "-KILL", "-TERM"] {
        let before = written(&out, "samples.bin");
        let mut child = begun(&words(&out));
        // There is a checkpoint, and it contains more points than before.
        wait_for(&mut child, &out, "checkpoint", |bytes| !bytes.is_empty());
        wait_for(&mut child, &out, "samples.bin", |bytes| bytes != before);
        ended_by(signal, child);
    }
    assert!(succeeds(&words(&out)));
    same(&whole, &out);
    assert_eq!(folder.names(), ["killed", "whole"]);
}

#[test]
fn a_sweep_none_of_whose_points_starts_fails_with_the_reason() {
    let folder = Folder::new("sweep-refused");
    let out = folder.path("sweep");
    folder
        .clebsch("sweep heavy-top --vary h=5,6 --steps 3 --out @sweep")
        .fails("no point started; the first refused point, 0: ");
    assert_eq!(column(&out, "status"), [2.0, 2.0]);
}

/// As for a run, the exit code is 3 if a point exceeds its bound, and 0 if all points are within their bounds.
#[test]
fn a_sweep_ends_with_the_code_of_a_run() {
    let folder = Folder::new("sweep-codes");
    let model = "model Spring {
        param k: Real;
        field x: Real;
        lagrangian = (next(x) - x)^2/(2*h) - h*k*x^2/2;
    }";
    let model = folder.write("spring.clebsch", model);
    for (bound, code) in [(1.0, 0), (1e-9, 3)] {
        let case = format!(
            "model = \"spring\"\nh = 0.1\nsteps = 20\n[parameters]\nk = 1\n[initial]\nx = 1\n[bounds]\nenergy = {bound}\n"
        );
        folder.write("spring.toml", &case);
        let out = folder.path(&format!("out-{code}"));
        let arguments = ["sweep", &model, "--vary", "k=1,2", "--out", &out];
        clebsch(&arguments).ended(code);
        let again = [&arguments[..], &["--resume"]].concat();
        clebsch(&again).ended(code);
        clebsch(&format!("run {model}")).ended(code);
    }
}
