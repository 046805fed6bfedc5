//! `clebsch fit`.

use super::{near, number, results, words};
use crate::common::{Folder, clebsch};

/// Three vectors of a run with noise, every fifth node of 200.
fn data(folder: &Folder, noise: f64) {
    folder.runs("run heavy-top --steps 200 --every 5 --out @run --stability-limit 0 --check none");
    let table = folder.read("run/trajectory.csv");
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let place = |name: &str| names.iter().position(|own| *own == name).expect("a column");
    let wanted = ["Gamma_1", "Gamma_2", "Gamma_3"].map(place);
    let time = place("time");
    // Sums of twelve uniform numbers are nearly normal.
    let mut seed = 7_u64;
    let mut uniform = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut text = "t,Gamma_1,Gamma_2,Gamma_3\n".to_owned();
    for line in lines {
        let cells: Vec<f64> = line
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        text.push_str(&cells[time].to_string());
        for at in wanted {
            let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
            text.push_str(&format!(",{}", cells[at] + noise * normal));
        }
        text.push('\n');
    }
    folder.write("data.csv", text);
}

/// The rows of a fit: name, value and standard error.
fn fitted(folder: &Folder, vary: &str, set: &[&str]) -> Vec<(String, f64, f64)> {
    let mut rest = vec![
        folder.path("data.csv"),
        "--vary".to_owned(),
        vary.to_owned(),
    ];
    rest.extend(
        set.iter()
            .flat_map(|own| ["--set".to_owned(), (*own).to_owned()]),
    );
    let found = results(&words("fit heavy-top --data", &rest));
    let rows = found["fitted"].as_array().expect("rows").iter();
    let row = |row: &serde_json::Value| {
        let name = row["name"].as_str().expect("a name").to_owned();
        (name, number(&row["found"]), number(&row["standard_error"]))
    };
    rows.map(row).collect()
}

#[test]
fn a_fit_recovers_moments_and_momentum_within_three_errors() {
    let folder = Folder::new("fit-noise");
    data(&folder, 0.01);
    let start = ["J.11=0.53", "body_momentum=[0.12,0.03,0.9]"];
    let found = fitted(&folder, "J.11,J.33,initial:body_momentum", &start);
    let expected = [
        ("J.11", 0.5),
        ("J.33", 1.5),
        ("body_momentum.1", 0.1),
        ("body_momentum.2", 0.0),
        ("body_momentum.3", 1.0),
    ];
    assert_eq!(found.len(), expected.len());
    for ((name, value, error), (wanted, truth)) in found.iter().zip(expected) {
        assert_eq!(name, wanted);
        assert!(*error > 1e-4 && *error < 0.02, "{name}: {error}");
        near(*value, truth, 3.0 * error);
    }
    // Initial values alone use tangents.
    for (name, value, error) in fitted(&folder, "initial:body_momentum", &start[1..]) {
        let truth = [0.1, 0.0, 1.0][usize::from(name.as_bytes()[name.len() - 1] - b'1')];
        near(value, truth, 3.0 * error);
    }
}

#[test]
fn a_fit_to_exact_data_is_exact_and_writes_its_files() {
    let folder = Folder::new("fit-exact");
    data(&folder, 0.0);
    for (_, value, _) in fitted(&folder, "gU.3", &["gU.3=1.2"]) {
        near(value, 1.0, 1e-9);
    }
    let done = folder.runs("fit heavy-top --data @run/trajectory.npz --columns Gamma_1,body_momentum_2 --vary gU.3 --set gU.3=1.1 --out @out");
    done.prints(["82 numbers in 2 columns", "gU.3"]);
    assert!(folder.read("out/fit.csv").contains("\n0.5,Gamma_1,"));
    // Gamma does not depend on the angle about the vertical.
    folder
        .clebsch("fit heavy-top --data @data.csv --vary initial:Lambda")
        .fails(["do not determine the combination", "turn_3(Lambda)"]);
    assert!(folder.read("out/fit.svg").contains("least squares"));
}

#[test]
fn wrong_data_are_refused_with_their_place() {
    let folder = Folder::new("fit-wrong");
    let with = |text: &str, vary: &str| {
        folder.write("data.csv", text);
        folder.clebsch(&format!("fit heavy-top --data @data.csv --vary {vary}"))
    };
    with("t,Gamma_1\n0.25,1\n", "gU.3").refuses([
        "row 1: time 0.25 is no node",
        "the nearest is 0.3",
        "--h",
    ]);
    with("t,Gamma_1\n-1,1\n", "gU.3").refuses("Give times from 0");
    with("t,Gama_1\n0.2,1\n", "gU.3").refuses(["name of a column", "Did you mean `Gamma_1`?"]);
    with("x,Gamma_1\n0.2,1\n", "gU.3").refuses("no column `t`");
    with("t,Gamma_1\n0.2,one\n", "gU.3")
        .refuses(["line 2, column `Gamma_1`", "`one` is not a number"]);
    with("t,Gamma_1\n0.2\n", "gU.3").refuses("1 cells for 2 names");
    with("t,Gamma_1\n0.2,\n", "gU.3").refuses("no observed numbers");
    with("", "gU.3").refuses("is empty");
    with("t,Gamma_1\n0.2,1\n", "gU.3,gU.1").refuses("1 data cannot determine 2 numbers");
    with("t,Gamma_1\n0.2,1\n", "weight").refuses("no such parameter");
    with("t,Gamma_1\n0.2,1\n", "h").refuses("initial:h");
    with("t,Gamma_1\n0.2,1\n", "initial:momentum").refuses("no such initial value");
    clebsch("fit heavy-top --data missing.csv --vary gU.3").refuses("cannot read");
}
