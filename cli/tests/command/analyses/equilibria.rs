//! `clebsch equilibrium`.

use super::{near, number, results, sleeping, words};
use crate::common::{Folder, clebsch, runs};

/// Moments 1, 2, 2.5: the rotations about the first and the last axis are stable.
#[test]
fn a_free_body_is_stable_about_its_outer_axes() {
    let about = |axis: usize, off: f64| {
        let mut momentum = [off; 3];
        momentum[axis] = 1.0;
        let set = [
            "--set",
            "J={I=[1,2,2.5]}",
            "--set",
            &format!("body_momentum={momentum:?}").replace(' ', ""),
        ]
        .map(str::to_owned);
        results(&words("equilibrium free-body", &set))
    };
    for (axis, expected) in [(0, "stable"), (1, "unstable"), (2, "stable")] {
        for off in [0.0, 0.02] {
            let found = about(axis, off);
            assert_eq!(found["stability"], expected, "{axis} {off}");
            assert_eq!(found["fixed"].as_array().map(Vec::len), Some(3), "{found}");
            assert_eq!(found["symmetric_directions"], 1);
            let moment = [1.0, 2.0, 2.5][axis];
            let square = 1.0 + 2.0 * off * off;
            near(number(&found["energy"]), square / (2.0 * moment), 1e-12);
            // The multipliers are minus the angular velocity in space.
            let velocity = found["multipliers"].as_array().expect("three").iter();
            let size = velocity.map(|x| number(x).powi(2)).sum::<f64>().sqrt();
            near(size, square.sqrt() / moment, 1e-9);
        }
    }
    let set = ["--set", "J={I=[1,2,2.5]}", "--set", "body_momentum=[0,1,0]"];
    runs(&[&["equilibrium", "free-body"], &set[..]].concat())
        .prints(["unstable", "spatial_momentum.2"]);
}

/// The momentum in the body is not conserved: the middle axis of a free body looks stable at fixed component 2.
#[test]
fn a_quantity_that_is_not_proved_to_be_conserved_gives_no_verdict() {
    let set = [
        "--set",
        "J={I=[1,2,2.5]}",
        "--set",
        "body_momentum=[0,1,0]",
        "--fix",
        "body_momentum.2",
    ];
    runs(&[&["equilibrium", "free-body"], &set[..]].concat())
        .prints(["no verdict on stability", "body_momentum.2"]);
    let found = results(&words("equilibrium free-body", &set.map(str::to_owned)));
    assert_eq!(found["stability"], "undecided");
    assert!(found["stable"].is_null());
}

#[test]
fn a_circular_orbit_is_a_relative_equilibrium() {
    let found = results(&words("equilibrium kepler:eccentric", &[]));
    assert_eq!(found["stable"], true);
    let state: Vec<f64> = found["state"]["X"]
        .as_array()
        .expect("X")
        .iter()
        .map(number)
        .collect();
    // The radius is L^2/k with L^2 = 1 - 0.36.
    near(state.iter().map(|x| x * x).sum::<f64>().sqrt(), 0.64, 1e-9);
}

/// The energy at fixed momentum c about the vertical has a minimum for the upright top if
/// c^2 (I_3 - I_1) / I_3^2 > m g l, here 2 > gU.
#[test]
fn an_upright_oblate_top_loses_its_minimum() {
    let folder = Folder::new("equilibrium-branch");
    let mut command = words(
        "equilibrium heavy-top --continue gU.3=0.5:4 --out",
        &[folder.path("out")],
    );
    command.extend(sleeping("[1,1,1.5]", 3.0));
    let list: Vec<&str> = command.iter().map(String::as_str).collect();
    runs(&list).prints("change of stability at gU.3 = 2.000000000");
    let object = folder.json("out/equilibrium.json")["results"].clone();
    assert_eq!(object["fixed"], serde_json::json!(["momentum_Gamma"]));
    let special = &object["specials"][0];
    near(number(&special["parameter"]), 2.0, 1e-7);
    assert_eq!(special["event"], "change of stability");
    let table = folder.read("out/branch.csv");
    assert!(table.starts_with("point,gU.3,Lambda.11,"), "{table}");
    assert!(
        folder
            .read("out/branch.svg")
            .contains("branch of critical points")
    );
}

/// Two potentials: x^3/3 - p x has equilibria x = ±sqrt(p) that meet in a fold at p = 0.
#[test]
fn a_fold_turns_back() {
    let folder = Folder::new("equilibrium-fold");
    folder.write(
        "fold.clebsch",
        "model Fold {
            param m, p: Real;
            field x: Real;
            lagrangian = m*(next(x) - x)^2/(2*h) - h*(x^3/3 - p*x);
        }",
    );
    folder.write(
        "fold.toml",
        "model = \"fold\"\nh = 0.01\nsteps = 10\n\n[parameters]\nm = 1.0\np = 1.0\n\n[initial]\nx = 1.1\nmomentum = 0.0\n",
    );
    folder
        .runs("equilibrium @fold.clebsch")
        .prints(["stable", "1.000000000000"]);
    let done = folder.runs("equilibrium @fold.clebsch --continue p=1:-1 --out @out");
    done.prints(["fold at p = ", "returns to p = 1"]);
    let object = folder.json("out/equilibrium.json")["results"].clone();
    near(number(&object["specials"][0]["parameter"]), 0.0, 1e-9);
    let last = object["points"]
        .as_array()
        .and_then(|all| all.last())
        .expect("points");
    near(number(&last["state"][0]), -1.0, 1e-8);
    folder
        .clebsch("equilibrium @fold.clebsch --set p=-1")
        .fails("no equilibrium near");
}

#[test]
fn wrong_names_are_refused() {
    clebsch("equilibrium kepler --fix energi").refuses("--fix energi: there is no such");
    clebsch("equilibrium kepler --fix momentum_angula").refuses("did you mean `momentum_angular`?");
    clebsch("equilibrium kepler --continue k").refuses("give NAME=FROM:TO");
    clebsch("equilibrium kepler --continue kk=1:2").refuses("no such parameter");
    clebsch("equilibrium kepler --continue k=1:1").refuses("both ends are equal");
    clebsch("equilibrium kepler --continue h=1:2").refuses("is no parameter");
    clebsch("equilibrium kepler --fix none").fails("no equilibrium near");
    runs("equilibrium heavy-top --fix momentum_Gamma");
}
