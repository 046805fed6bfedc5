//! `clebsch linearise` and `clebsch orbit`.

use super::{near, number, results, sleeping, words};
use crate::common::{Folder, clebsch, runs};
use std::f64::consts::{PI, TAU};

/// A Toda ring of eight points at rest, whose springs have the constant a b = 1.
fn ring(displaced: &str) -> String {
    format!(
        "model = \"toda-chain\"\nname = \"rest\"\nh = 0.1\nsteps = 100\n\n[labels]\ni = 8\n\n[ends]\ni = \"periodic\"\n\n\
         [parameters]\nm = 1.0\na = 2.0\nb = 0.5\nL = 0.0\n\n[initial]\nq = \"{displaced}\"\nmomentum_q = \"0\"\n"
    )
}

#[test]
fn a_ring_at_rest_has_the_frequencies_of_its_springs() {
    let folder = Folder::new("linearise-ring");
    folder.write("rest.toml", ring("0"));
    let done = folder.runs("linearise toda-chain --case @rest.toml --out @out");
    done.prints(["is an equilibrium", "discrete system: spectrally stable"]);
    let object = folder.json("out/linearise.json")["results"].clone();
    let sorted = |modes: &serde_json::Value| {
        let all = modes.as_array().expect("modes").iter();
        let mut all: Vec<f64> = all.map(|mode| number(&mode["frequency"])).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let mut expected: Vec<f64> = (0..8)
        .map(|k| 2.0 * (f64::from(k) * PI / 8.0).sin())
        .collect();
    expected.extend(expected.clone().iter().map(|x| -x));
    expected.sort_by(f64::total_cmp);
    for (found, expected) in sorted(&object["continuous"]["modes"]).iter().zip(&expected) {
        near(*found, *expected, 1e-7);
    }
    // The step is the method of Störmer and Verlet.
    for (found, expected) in sorted(&object["modes"]).iter().zip(&expected) {
        near(*found, 20.0 * (0.05 * expected).asin(), 1e-7);
    }
    let picture = folder.read("out/modes.svg");
    assert!(picture.contains("frequency 0.7656"), "{picture}");
    assert_eq!(folder.read("out/linearise.csv").lines().count(), 17);
}

#[test]
fn an_equilibrium_nearby_is_found_and_said() {
    let folder = Folder::new("linearise-near");
    folder.write("near.toml", ring("0.1*sin(2*pi*i/N)"));
    let done = folder.runs("linearise toda-chain --case @near.toml");
    done.prints(["is no equilibrium", "clebsch found one at distance 0.2"]);
    let hanging = "linearise heavy-top-spatial:hanging --set body_momentum=[0,0,0]";
    drop(clebsch(hanging));
    clebsch("linearise kepler").fails(["no equilibrium near", "Newton's method stops"]);
    clebsch("linearise spherical-pendulum").fails("satisfy constraints");
}

#[test]
fn a_circular_orbit_returns_with_multipliers_on_the_circle() {
    let folder = Folder::new("orbit-kepler");
    let done = folder.runs("orbit kepler --period 2*pi --write-case @orbit.toml");
    done.prints(["126 steps", "spectrally stable", "orbit.toml"]);
    let found = results(&words("orbit kepler --period 2*pi", &[]));
    assert!(number(&found["residual"]) < 1e-12);
    assert!(number(&found["pairing_defect"]) < 1e-6);
    for z in found["multipliers"].as_array().expect("multipliers") {
        near(number(&z["re"]).hypot(number(&z["im"])), 1.0, 1e-6);
    }
    // The case starts on the orbit and ends where it starts.
    folder.runs("run kepler --case @orbit.toml --out @run --stability-limit 0");
    let rows: Vec<Vec<f64>> = folder
        .read("run/trajectory.csv")
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
        .collect();
    let (first, last) = (&rows[0], rows.last().expect("rows"));
    assert_eq!(last[0], 126.0);
    for (a, b) in first[2..8].iter().zip(&last[2..8]) {
        near(*a, *b, 1e-11);
    }
    folder
        .clebsch("orbit kepler --period 2*pi --write-case @orbit.toml")
        .refuses("the file exists");
}

/// A sleeping Lagrange top is stable if (I_3 w)^2 > 4 I_1 m g l = 8.
#[test]
fn a_sleeping_top_is_stable_if_it_is_fast() {
    let stable = |momentum: f64| {
        let period = format!("{}", TAU / momentum);
        let command = format!("orbit heavy-top --h 0.02 --period {period}");
        let found = results(&words(&command, &sleeping("[2,2,1]", momentum)));
        found["stable"] == true
    };
    let threshold = 8.0_f64.sqrt();
    assert!(!stable(0.7 * threshold));
    assert!(!stable(0.98 * threshold));
    assert!(stable(1.02 * threshold));
    assert!(stable(1.5 * threshold));
}

#[test]
fn wrong_requests_for_orbits_are_refused() {
    clebsch("orbit kepler --period 1e-9").refuses("Give another period");
    clebsch("orbit kepler --period 0").ended(2);
    clebsch("orbit kepler --period 6 --write-case orbit.txt").refuses("ends in .toml");
    clebsch("orbit toda-chain --period 1 --write-case orbit.toml").refuses("site data");
    runs("orbit kepler --period 6 --json");
}
