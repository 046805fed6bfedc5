//! `clebsch section` and `clebsch lyapunov`.

use super::{near, number, results, words};
use crate::common::{Folder, clebsch, runs};
use std::f64::consts::TAU;

#[test]
fn a_circular_orbit_crosses_once_a_period() {
    let gap = |h: f64| {
        let command = format!("section kepler --at X[2] --up --count 3 --until 20 --h {h}");
        let found = results(&words(&command, &[]));
        let all = found["crossings"].as_array().expect("crossings");
        assert_eq!(all.len(), 3);
        for crossing in all {
            assert!(number(&crossing["value"]).abs() < 1e-15, "{crossing}");
        }
        number(&all[1]["time"]) - number(&all[0]["time"]) - TAU
    };
    // The error is of second order, and the period of this step is longer than 2 pi by 2 h^2 or so.
    let (coarse, fine) = (gap(0.04), gap(0.02));
    assert!(coarse > 0.0 && coarse < 4e-3, "{coarse}");
    near(coarse / fine, 4.0, 0.1);
}

#[test]
fn directions_and_files_of_a_section() {
    let folder = Folder::new("section-files");
    let both = folder.runs("section kepler:eccentric --at X.2 --count 4 --out @out");
    both.prints(["4 crossings", "up", "down", "at most"]);
    let table = folder.read("out/section.csv");
    assert!(
        table.starts_with("crossing,time,upward,X_1,X_2,X_3,momentum_1"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 5);
    assert!(folder.read("out/section.svg").contains("section X.2 = 0"));
    let down = results(&words(
        "section kepler:eccentric --at X.2 --down --count 2",
        &[],
    ));
    for crossing in down["crossings"].as_array().expect("crossings") {
        assert_eq!(crossing["upward"], false);
    }
    // Constrained models have sections too.
    runs("section spherical-pendulum --at x[1] --count 2 --plot x[2],momentum[1]");
}

/// Between its zeros, tan(2 X_2) changes its sign at poles.
#[test]
fn a_pole_is_not_a_crossing() {
    let found = results(&words(
        "section kepler --at tan(2*X[2]) --count 4 --steps 600",
        &[],
    ));
    let all = found["crossings"].as_array().expect("crossings");
    assert_eq!(all.len(), 4);
    for crossing in all {
        assert!(number(&crossing["value"]).abs() < 1e-14, "{crossing}");
    }
}

#[test]
fn a_surface_that_is_never_met_is_told() {
    clebsch("section kepler --at X[1]-7 --steps 300").fails(["No crossing in 300 steps", "X[1]-7"]);
    clebsch("section kepler --at 1/X[2] --steps 300").fails(["infinite or undefined"]);
    clebsch("section kepler --at X[1]-7 --plot X[1]").refuses("--plot names 1 quantities");
    clebsch("section kepler --at X[4]").refuses("no component [4]");
    clebsch("section kepler --at X[1] --up --down").ended(2);
}

#[test]
fn exponents_tell_chaos_from_order() {
    let largest = |words_of: &str| {
        let found = results(&words(words_of, &[]));
        number(&found["exponents"][0])
    };
    let chaotic = largest("lyapunov heavy-top:general --steps 4000");
    assert!(chaotic > 0.05, "{chaotic}");
    let regular = largest("lyapunov heavy-top --steps 4000");
    assert!(regular.abs() < 0.02, "{regular}");
    runs("lyapunov heavy-top:general --steps 4000").prints("the motion is chaotic");
    runs("lyapunov heavy-top --steps 4000").prints("regular");
}

#[test]
fn all_exponents_of_a_symplectic_motion_add_to_zero() {
    let folder = Folder::new("lyapunov-files");
    folder.runs("lyapunov heavy-top --steps 400 --count 6 --out @out");
    let found = folder.json("out/lyapunov.json")["results"].clone();
    let all = found["exponents"].as_array().expect("exponents");
    let sum: f64 = all.iter().map(number).sum();
    assert!(sum.abs() < 1e-12, "{sum}");
    assert!(
        folder
            .read("out/lyapunov.csv")
            .starts_with("time,exponent_1,")
    );
    assert!(folder.read("out/lyapunov.svg").contains("<svg"));
    clebsch("lyapunov heavy-top --count 7").refuses("6 coordinates");
    clebsch("lyapunov spherical-pendulum").fails("satisfy constraints");
}
