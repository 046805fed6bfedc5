//! `clebsch gradient`.

use super::{near, number, results, words};
use crate::common::{Folder, clebsch, runs};
use serde_json::Value;

fn derivative(found: &Value, name: &str) -> f64 {
    let rows = found["derivatives"].as_array().expect("rows");
    let row = rows.iter().find(|row| row["name"] == name);
    number(&row.unwrap_or_else(|| panic!("{name} in {rows:?}"))["derivative"])
}

/// The energy of the Kepler problem is p^2/(2m) - m k/|X|.
#[test]
fn the_energy_has_the_derivatives_of_its_formula() {
    // One step changes the energy only slightly; the sum over nodes 0 and 1 has twice the derivatives up to h^2.
    let of = |h: &str| {
        let command =
            format!("gradient kepler --of energy --sum --steps 1 --h {h} --set m=2 --set k=0.9");
        results(&words(&command, &[]))
    };
    let found = of("1e-4");
    // p = (0, 0.8, 0.6), X = (1, 0, 0)
    near(derivative(&found, "m"), 2.0 * (-1.0 / 8.0 - 0.9), 1e-6);
    near(derivative(&found, "k"), -4.0, 1e-6);
    near(derivative(&found, "X.1"), 2.0 * 2.0 * 0.9, 1e-3);
    near(derivative(&found, "momentum.2"), 2.0 * 0.8 / 2.0, 1e-3);
    near(number(&found["quantity"]), 2.0 * (0.25 - 1.8), 1e-6);
}

#[test]
fn derivatives_are_limits_of_differences_of_runs() {
    let at = |set: &str| {
        let command = format!(
            "gradient heavy-top --of sin(Γ[1])*body_momentum.y+energy/Gamma_3 --steps 60 {set}"
        );
        results(&words(&command, &[]))
    };
    let found = at("");
    let slope = |name: &str, value: f64| {
        let d = 1e-5;
        let value_at = |x: f64| {
            let set = if name == "h" {
                format!("--h {x}")
            } else {
                format!("--set {name}={x}")
            };
            number(&at(&set)["quantity"])
        };
        let expected = (value_at(value + d) - value_at(value - d)) / (2.0 * d);
        near(
            derivative(&found, name),
            expected,
            1e-6 * expected.abs().max(1.0),
        );
    };
    slope("J.12", 0.0);
    slope("J.33", 1.5);
    slope("gU.3", 1.0);
    slope("body_momentum.1", 0.1);
    slope("h", 0.1);
}

#[test]
fn a_table_and_files_have_all_names() {
    let folder = Folder::new("gradient-files");
    let done = folder.runs("gradient heavy-top --of Lambda[3,3] --steps 10 --out @out");
    done.prints([
        "turn_2(Lambda)",
        "body_momentum.3",
        "step size",
        "at node 10",
    ]);
    let table = folder.read("out/gradient.csv");
    assert!(
        table.starts_with("kind,name,value,derivative\nparameter,J.11,0.5,"),
        "{table}"
    );
    assert_eq!(
        folder.json("out/gradient.json")["results"]["of"],
        "Lambda[3,3]"
    );
    folder
        .clebsch("gradient heavy-top --of energy --steps 10 --out @out")
        .ended(2);
    // A chain that runs by loops over its sites.
    runs("gradient sine-gordon --of energy --steps 2").prints("at node 2");
}

#[test]
fn a_wrong_expression_is_marked() {
    let of = |text: &str| clebsch(&["gradient", "kepler", "--of", text]);
    of("X[1]^2 + Y").refuses([
        "--of, column 10: `Y` is neither",
        "  X[1]^2 + Y\n           ^\n",
        "Available: X[1..3], momentum[1..3], energy",
    ]);
    of("momentun[1]").refuses("Did you mean `momentum`?");
    of("X").refuses("`X` has 3 components");
    of("X[0]").refuses(["no component [0]", "count from 1"]);
    of("foo(energy)").refuses("`foo` is not a function");
    of("2 *").refuses("unexpected the end");
    of("2 $ 3").refuses("unexpected `$`");
    of("1.2.3").refuses("`1.2.3` is not a number");
    of("X[1] X[2]").refuses("Write an operation");
    of("").refuses("unexpected the end");
    of(&"(".repeat(500)).refuses("more than 100 brackets");
    of(&"-2^".repeat(3000)).ended(2);
    of("\u{1b}[31m").ended(2);
    clebsch("gradient kepler --of abs(momentum_angular[1]) --steps 3")
        .fails("Choose a quantity that is smooth");
}

#[test]
fn steps_in_parts_have_no_derivative() {
    clebsch("gradient kepler --of energy --halve").refuses("subdivided steps have no derivative");
}

#[test]
fn a_quantity_that_is_not_a_number_is_refused() {
    clebsch("gradient kepler --of log(X[1]-50) --steps 20").fails(["is NaN on this run"]);
    clebsch("gradient kepler --of 1/0 --steps 20").fails(["is inf on this run"]);
}
