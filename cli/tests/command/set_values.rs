//! `--set` accepts the values of a case file: rotations in any form, inertias, matrices, and entries of a table. A
//! case may leave the number of steps to an option.

use crate::common::{Folder, clebsch, runs};
use crate::text_runs::run;

const TOP: &str = "model Top {
    param J: Sym<3>;
    param k: Real;
    group R: SO<3> velocity W;
    constraint next(R) = R*W;
    lagrangian = -tr(J*W)/h - h*k*dot(R*E3, E3);
}";

/// The inertia spans two lines, and the number of steps is missing.
const CASE: &str = "model = \"top\"\nh = 0.01\n[parameters]\nJ = { I = [2.0,\n  3.0, 4.0] }\nk = 1\n[initial]\n\
                    R = { axis = [0, 0, 1], angle = 0.5 }\nangular_velocity = [1, 0, 0.2]\n";

/// The first row after the head, and the parameters.
fn start(name: &str, set: &str) -> (Vec<f64>, serde_json::Value) {
    let folder = Folder::new(&format!("set-values-{name}"));
    let model = folder.write("top.clebsch", TOP);
    let case = folder.write("top.toml", CASE);
    let out = folder.path("out");
    let run = [
        "run", &model, "--case", &case, "--steps", "1", "--out", &out,
    ];
    runs(&[&run[..], &["--set", set]].concat());
    let row = &folder.samples("out/trajectory.csv").rows[0];
    let json = folder.json("out/run.json");
    (row[2..11].to_vec(), json["parameters"].clone())
}

#[test]
fn rotations_are_set_in_every_form() {
    let (s, c) = 1.0_f64.sin_cos();
    let about_z = [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
    for (n, value) in [
        "R.angle=1",
        "R.angle=2*pi/(2*pi)",
        "R={axis = [0, 0, 1], angle = 1}",
        "R={euler=zxz, angles=[1, 0, 0]}",
        "R=[cos(1/2), 0, 0, sin(1/2)]",
        "R={quaternion=[cos(0.5), 0, 0, \"sin(0.5)\"]}",
        "R=[[cos(1), -sin(1), 0], [sin(1), cos(1), 0], [0, 0, 1]]",
        "R={from=[1,0,0], to=[cos(1),sin(1),0]}",
    ]
    .into_iter()
    .enumerate()
    {
        let (found, _) = start(&n.to_string(), value);
        for (x, y) in found.iter().zip(about_z) {
            assert!((x - y).abs() < 1e-15, "{value}: {found:?}");
        }
    }
}

#[test]
fn inertias_and_matrices_are_set() {
    for (n, (value, diagonal)) in [
        ("I=[1, 2, 2.5]", [1.75, 0.75, 0.25]),
        ("J={I=[1, 2, 5/2]}", [1.75, 0.75, 0.25]),
        ("J=[[1, 0, 0], [0, 2, 0], [0, 0, 3]]", [1.0, 2.0, 3.0]),
        ("J.I.1=3", [2.0, 2.0, 1.0]),
    ]
    .into_iter()
    .enumerate()
    {
        let (_, parameters) = start(&format!("inertia-{n}"), value);
        for (i, x) in diagonal.into_iter().enumerate() {
            assert_eq!(parameters["J"][i][i], x, "{value}: {parameters}");
        }
    }
    // The cases of compiled models are not texts.
    let done = clebsch(&[
        "run",
        "heavy-top",
        "--steps",
        "2",
        "--json",
        "--set",
        "I=[1, 2, 2.5]",
    ]);
    let json = done.json();
    assert_eq!(json["parameters"]["J"][0][0], 1.75, "{}", done.err);
}

#[test]
fn an_entry_of_a_rotation_is_varied() {
    let folder = Folder::new("set-values-vary");
    folder.write("top.clebsch", TOP);
    folder.write("top.toml", CASE);
    folder.runs("sweep @top.clebsch --until 0.02 --vary R.angle=0:pi:3 --out @out");
    let ends = folder.samples("out/sweep.csv").column("R_11");
    for (end, angle) in ends.iter().zip([0.0_f64, 0.5, 1.0]) {
        let expected = (angle * std::f64::consts::PI).cos();
        assert!((end - expected).abs() < 1e-2, "{ends:?}");
    }
}

#[test]
fn the_number_of_steps_may_be_an_option() {
    let folder = Folder::new("set-values-steps");
    let done = run(&folder, TOP, CASE, "--until 0.05");
    done.prints("5 steps, to time 0.05");
    let done = run(&folder, TOP, CASE, "").exits(2);
    let said =
        "case.toml: missing key `steps`: give the number of steps, or --until T or --steps N";
    done.says(said);
}
