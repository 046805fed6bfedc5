//! Pictures of columns of a finished run.

use crate::common::{Folder, clebsch, runs, table};
use std::fs;

/// A run of the eccentric orbit, in this folder.
fn orbit(out: &str) {
    let run = [
        "run",
        "kepler:eccentric",
        "--steps",
        "500",
        "--quiet",
        "--out",
        out,
    ];
    runs(&run);
}

#[test]
fn columns_are_drawn_against_time_and_each_other() {
    let folder = Folder::new("plot");
    let out = folder.path("run");
    orbit(&out);
    let listed = folder.clebsch("plot @run");
    listed.prints(["  X.1 to X.3\n", "  invariant_energy\n", "  time\n"]);
    folder.runs("plot @run --x X.1 --y X_2 --out @orbit.svg");
    assert!(folder.read("orbit.svg").contains("X_2 against X.1"));
    // A picture is drawn again over itself, but never over another file.
    folder.runs("plot @run --y X --out @orbit.svg");
    folder.write("other.svg", "<svg>mine</svg>");
    folder.clebsch("plot @run --y X --out @other.svg").exits(2);
    assert_eq!(folder.read("other.svg"), "<svg>mine</svg>");
    // Several orbits, each against its own column; otherwise all against one.
    folder.runs("plot @run --x X.1 --y X.2 --x X.2 --y X.3 --out @orbit.svg");
    let picture = folder.read("orbit.svg");
    assert!(picture.contains("X.2 against X.1") && picture.contains("X.3 against X.2"));
    folder
        .clebsch("plot @run --x X.1 --x X.2 --y X")
        .says("2 columns along x and 3 along y");
    folder
        .clebsch("plot @run --y X --out @a.png")
        .says("ends in .svg");
    // In the folder of the run, which may still be replaced.
    folder.runs("plot @run --y X --y invariant_energy --from 2 --to 3");
    let picture = folder.read("run/plot-X-invariant_energy.svg");
    assert!(picture.contains("time 2 to 3"));
    folder.runs("run kepler:eccentric --steps 500 --quiet --out @run --force");
    for [arguments, words] in table(
        "
        --y Y            | the run has no column `Y`
        --y X.4          | `X.4` does not name one column of `X`; give a component, X.1 to X.3
        --y X --from 1e9 | the run has times 0 to
",
    ) {
        folder
            .clebsch(&format!("plot @run {arguments}"))
            .refuses(words);
    }
    clebsch(&format!("plot {} --y X", folder.path("."))).says("no trajectory.npz");
}

#[test]
fn sites_are_counted_from_zero() {
    let folder = Folder::new("plot-sites");
    folder.runs("run toda-chain --steps 5 --quiet --out @run");
    folder.clebsch("plot @run").prints("  q_0 to q_31\n");
    folder.runs("plot @run --x momentum_q_31 --y q_0");
    // If an end prescribes the first site, this site is not a column, and the other sites keep their numbers.
    let held = folder.path("held");
    folder.runs("run hanging-chain:swing --steps 5 --quiet --out @held");
    folder.clebsch("plot @held").prints("  x_1.1 to x_");
    folder.clebsch("plot @held --y x_0.1").says("an end prescribes `x_0`, so the run has no such column; give a site and a component, x_1.1 to x_20.3");
    folder
        .clebsch("plot @run --y q_32")
        .says("give a site, q_0 to q_31");
    folder
        .clebsch("plot @held --y lambda")
        .says("give a site, lambda_0 to lambda_19");
    // All components of a vector at a site; lists and brackets.
    for (name, labels) in [
        ("x_10", &["x_10.1", "x_10.2", "x_10.3"][..]),
        ("x_10.1,x_9.3", &["x_10.1", "x_9.3"]),
        ("x[10][2], lambda_3", &["x[10][2]", "lambda_3"]),
    ] {
        let svg = curves(&held, &folder, &[name]).0;
        for label in labels {
            assert!(svg.contains(label), "{name}: {label}");
        }
    }
}

/// A picture of these columns, and the points of its longest lines.
fn curves(run: &str, folder: &Folder, names: &[&str]) -> (String, Vec<Vec<[f64; 2]>>) {
    let out = folder.path("curves.svg");
    let mut arguments = vec!["plot", run, "--out", &out];
    arguments.extend(names.iter().flat_map(|name| ["--y", name]));
    runs(&arguments);
    let svg = fs::read_to_string(&out).expect("a picture");
    let of_line = |text: &str| -> Vec<[f64; 2]> {
        let points = text.split("points=\"").nth(1).unwrap_or_default();
        let points = points.split('"').next().unwrap_or_default();
        let number = |text: &str| text.parse::<f64>().expect("a number");
        let point = |text: &str| text.split_once(',').map(|(x, y)| [number(x), number(y)]);
        points.split_whitespace().filter_map(point).collect()
    };
    let lines = svg.split("<polyline").skip(1).map(of_line);
    let lines = lines.filter(|line| line.len() > 2).collect();
    (svg, lines)
}

#[test]
fn a_multiplier_begins_where_a_step_has_found_it() {
    let folder = Folder::new("plot-multiplier");
    let out = folder.path("run");
    let run = [
        "run",
        "hanging-chain:swing",
        "--steps",
        "5",
        "--quiet",
        "--out",
        &out,
    ];
    runs(&run);
    let left = |name: &str| curves(&out, &folder, &[name]).1[0].clone();
    assert_eq!(left("x_1.1").len(), 6);
    let multiplier = left("lambda_3");
    assert_eq!(multiplier.len(), 5);
    assert!(multiplier[0][0] > left("x_1.1")[0][0] + 1.0);
}

#[test]
fn what_is_constant_to_rounding_is_drawn_flat() {
    let folder = Folder::new("plot-flat");
    let out = folder.path("run");
    orbit(&out);
    let height = |line: &[[f64; 2]]| {
        let heights = || line.iter().map(|point| point[1]);
        heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min)
    };
    // The first component is rounding about zero, but the norm of the whole is not small.
    for name in [
        "invariant_momentum_angular.1",
        "invariant_momentum_angular.2",
        "invariant_momentum_angular.3",
    ] {
        let (svg, lines) = curves(&out, &folder, &[name]);
        assert!(svg.contains("constant to rounding"), "{name}");
        // The chart is nearly a thousand units high.
        assert!(lines.iter().all(|line| height(line) < 10.0), "{name}");
    }
    let (svg, lines) = curves(&out, &folder, &["X.1"]);
    assert!(!svg.contains("constant to rounding"));
    assert!(lines.iter().any(|line| height(line) > 300.0));
}

/// Columns can be named as in the table, also if the site is in the middle of the name, as for relative
/// attitudes.
#[test]
fn columns_are_found_as_the_table_names_them() {
    let folder = Folder::new("plot-names");
    let model = "model Turns {
        label i in 0..N;
        param J: Sym<3> at nodes;
        param k: Real;
        group R: SO<3> at nodes velocity W;
        constraint next(R) = R*W;
        lagrangian = -tr(J*R^T*next(R))/h + h*k*tr(R^T*next(R, i));
    }";
    let case = "model = \"turns\"\nh = 0.01\nsteps = 3\n[labels]\ni = 2\n[parameters]\nJ = { I = [2, 3, 4] }\nk = 1\n[initial]\n\
                R = { axis = [0, 0, 1], angle = 0.3 }\nangular_velocity_R = [1, 0.2, 0]\n";
    let out = folder.path("out");
    crate::text_runs::run(&folder, model, case, "--out @out").succeeds();
    let table = folder.read("out/trajectory.csv");
    let names = table.lines().next().unwrap_or_default().split(',');
    let own: Vec<&str> = names.filter(|name| name.starts_with("relative_")).collect();
    assert!(own.contains(&"relative_R_0_R_1_11"), "{own:?}");
    for name in own {
        let picture = folder.path(&format!("{name}.svg"));
        let arguments = [
            "plot", &out, "--x", name, "--y", "R_0_11", "--out", &picture,
        ];
        runs(&arguments);
    }
}
