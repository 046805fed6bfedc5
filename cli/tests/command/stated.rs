//! The verdict by the action as stated. It holds for every model file with its cases, skipped checks are
//! reported, and the JSON object contains the numbers.

use crate::common::{Folder, clebsch, models, runs};
use serde_json::Value;

/// The verdict on a few steps of every case of a model file.
fn judged(name: &str, steps: &str, words: &str) {
    let own = std::path::PathBuf::from(models(&format!("{name}.toml")));
    let folder = std::fs::read_dir(models(name)).into_iter().flatten();
    let mut cases: Vec<_> = folder.flatten().map(|entry| entry.path()).collect();
    cases.push(own);
    for case in cases.iter().filter(|case| case.is_file()) {
        let case = case.display().to_string();
        let done = runs(&format!(
            "run models/{name}.clebsch --case {case} --steps {steps}"
        ));
        let line = done.out.split("action as stated: ").nth(1);
        let line = line.unwrap_or_else(|| panic!("{case}: {}", done.out));
        assert!(line.contains(words), "{case}: {line}");
        assert!(!line.contains("NOT hold"), "{case}: {line}");
    }
}

macro_rules! judged {
    ($($test:ident: $file:literal $steps:literal $words:literal;)*) => {
        $(#[test]
        fn $test() {
            judged($file, $steps, $words);
        })*
    };
}
judged! {
    fluid_ellipsoid: "elastic/fluid-ellipsoid" "10" "10 steps checked";
    kirchhoff_static: "elastic/kirchhoff-static" "40" "40 steps checked";
    mooney_rivlin: "elastic/mooney-rivlin" "40" "40 steps checked";
    neo_hooke: "elastic/neo-hooke" "40" "40 steps checked";
    pseudo_rigid: "elastic/pseudo-rigid" "5" "5 steps checked";
    pseudo_rigid_anisotropic: "elastic/pseudo-rigid-anisotropic" "2" "2 steps checked";
    pseudo_rigid_bipolar: "elastic/pseudo-rigid-bipolar" "1" "1 step checked";
    pseudo_rigid_positive: "elastic/pseudo-rigid-positive" "2" "2 steps checked";
    spherical_pendulum: "elastic/spherical-pendulum" "40" "40 steps checked";
    circular_rod: "lattices/circular-rod" "5" "5 steps checked";
    coupled_body_chain: "lattices/coupled-body-chain" "5" "5 steps checked";
    coupled_tops: "lattices/coupled-tops" "5" "5 steps checked";
    geometrically_exact_rod: "lattices/geometrically-exact-rod" "5" "5 steps checked";
    hanging_chain: "lattices/hanging-chain" "5" "5 steps checked";
    kirchhoff_rod: "lattices/kirchhoff-rod" "5" "5 steps checked";
    quaternion_rod: "lattices/quaternion-rod" "5" "5 steps checked";
    shallow_water_1d: "lattices/shallow-water-1d" "5" "5 steps checked";
    sine_gordon: "lattices/sine-gordon" "5" "5 steps checked";
    toda_chain: "lattices/toda-chain" "5" "5 steps checked";
    uniform_tension_rod: "lattices/uniform-tension-rod" "5" "5 steps checked";
    particle_mesh: "fluids/particle-mesh-1d" "2" "not checked: functionals of all sites";
}

/// The steps that are judged, and their entries in the JSON object.
#[test]
fn the_steps_that_are_judged_are_those_asked_for() {
    let object = |check: &str| -> Value {
        let done = runs(&format!("run heavy-top --steps 300 --check {check} --json"));
        done.out.parse().expect("an object")
    };
    let of = |check: &str| object(check)["results"]["action_as_stated"].clone();
    let sample = of("sample");
    assert_eq!(sample["judged"], 101);
    assert_eq!(sample["holds"], true);
    assert!(
        sample["worst"]["ratio"]
            .as_f64()
            .is_some_and(|r| r > 1e-3 && r < 1.0)
    );
    assert_eq!(of("all")["judged"], 300);
    assert!(of("none").is_null());
    clebsch("run free-body --steps 10 --order 4")
        .prints("action as stated: not checked: a step of order 4 uses modified moments");
}

/// Each part of a composed step is judged with its own step size, for compiled bodies, for bodies read from a
/// file, and for chains.
#[test]
fn the_parts_of_a_composed_step_are_judged() {
    for (model, case) in [
        ("heavy-top".to_owned(), None),
        (
            models("elastic/neo-hooke.clebsch"),
            Some("elastic/neo-hooke.toml"),
        ),
        (
            models("lattices/sine-gordon.clebsch"),
            Some("lattices/sine-gordon.toml"),
        ),
    ] {
        for order in ["4", "8"] {
            let case = case.map(models);
            let mut words = vec!["run", &model, "--steps", "30", "--order", order, "--json"];
            words.extend(case.iter().flat_map(|c| ["--case", c.as_str()]));
            let object = runs(&words).json();
            let judged = &object["results"]["action_as_stated"];
            assert_eq!(judged["judged"], 30, "{model} {order}");
            let ratio = judged["worst"]["ratio"].as_f64();
            assert!(
                ratio.is_some_and(|r| r > 1e-3 && r < 1.0),
                "{model} {order}: {ratio:?}"
            );
        }
    }
}

/// A body at rest has residuals that are exactly zero, which prove nothing.
#[test]
fn a_body_at_rest_is_no_failure_of_the_check() {
    let folder = Folder::new("stated-at-rest");
    let text = "model Rest { param m, k: Real; field x: Vec<3>;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - (h*k/2)*dot(x, x); }";
    folder.write("rest.clebsch", text);
    let case = "model = \"rest\"\nh = 0.1\nsteps = 20\n[parameters]\nm = 1.3\nk = 0.7\n\
        [initial]\nx = [0.0, 0.0, 0.0]\nmomentum = [0.0, 0.0, 0.0]\n";
    let case = folder.write("rest.toml", case);
    folder
        .runs(&format!("run @rest.clebsch --case {case}"))
        .prints("20 steps checked, largest residual 0 of");
}
