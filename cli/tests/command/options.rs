//! Options that replace numbers of a case, and how much a run looks at and prints.

use crate::common::{Folder, clebsch, table};
use std::fs;

#[test]
fn a_run_ends_at_the_node_nearest_to_a_time() {
    for [arguments, said] in table(
        "
        --until 10         | h = 0.05, 200 steps, to time 10;
        --until 10 --h 0.3 | h = 0.3, 33 steps, to time 9.9;
        --until 0.001      | h = 0.05, 1 step, to time 0.05;
",
    ) {
        clebsch(&format!("run kepler --check none {arguments}")).prints(said);
    }
    for wrong in ["--until 10 --steps 3", "--until -1", "--until nan"] {
        clebsch(&format!("run kepler {wrong}")).ended(2);
    }
    clebsch("run kepler --until 1e300").says("--until 1");
}

#[test]
fn quantities_are_set_by_name_and_component() {
    let folder = Folder::new("options-set");
    let done = folder.clebsch(
        "run kepler --steps 1 --out @out --set X.x=1.5 --set momentum=0,0.5,0.25 --set k=2",
    );
    assert!(done.code != 2, "{}", done.err);
    let start = folder.samples("out/trajectory.csv").rows.remove(0);
    assert_eq!(start[2..8], [1.5, 0.0, 0.0, 0.0, 0.5, 0.25]);
    let json = folder.json("out/run.json");
    assert_eq!(json["parameters"]["k"], 2.0);
    assert_eq!(json["arguments"]["set"][0], "X.x=1.5");
    for [set, words] in table(
        "
        X=1   | `X` has 3 numbers; name one, such as X.1
        X=1,2 | `X` has 3 components, but 2 values are given
        k=1,2 | `k` takes one number
        q=1   | `kepler` has no such parameter or initial value; it has m, k, X, momentum, velocity and the step h
        k=two | `two` is not a number: `two` has no value here
        k     | give NAME=VALUE
",
    ) {
        clebsch(&format!("run kepler --set {set}")).refuses(words);
    }
    // If the model rejects a value, the message names the option, not a line of the case.
    clebsch("run heavy-top --set J.11=-5").refuses("--set J.11: negative second moment");
}

/// The circular case of mass 1 gives a momentum; a velocity replaces it as a whole.
#[test]
fn a_velocity_takes_the_place_of_a_momentum() {
    let folder = Folder::new("options-velocity");
    folder
        .clebsch("run kepler --steps 1 --set m=2 --set velocity=0,1/2,-0.25*m --out @out")
        .prints("initial momentum from velocity: (0, 1, -1)");
    let start = folder.samples("out/trajectory.csv").rows.remove(0);
    for (found, wanted) in start[5..8].iter().zip([0.0, 1.0, -1.0]) {
        // The limit of small steps is taken of differences, to some roundings.
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
    for [arguments, words] in table(
        "
        run kepler --set velocity.y=1       | give the whole velocity, with --set velocity=...
        run kepler --set velocity=1,2       | has 3 numbers
        run kepler --set angular_velocity=1 | no such parameter or initial value
",
    ) {
        clebsch(arguments).refuses(words);
    }
}

/// A run with an option equals the run of the case with this value typed in, including expressions that contain it.
#[test]
fn expressions_follow_what_options_set() {
    let folder = Folder::new("options-follow");
    let text =
        "model Osc { param m, k, c: Real; param g: Vec<2>; field x: Vec<2>; let d = next(x) - x;
        lagrangian = m*dot(d, d)/(2*h) - h*(k*dot(x, x)/2 + c*dot(x, x)^2 - dot(g, x)); }";
    folder.write("osc.clebsch", text);
    let case = |h: &str, k: &str| {
        format!(
            "model = \"osc\"\nh = {h}\nsteps = 40\n[parameters]\nm = 1.5\nk = {k}\nc = \"k/10\"\ng = [\"0.1*m\", \"-m*h\"]\n\
             [initial]\nx = [\"k/2\", 0.5]\nvelocity_x = [0, \"k\"]\n"
        )
    };
    let last = |name: &str, case: &str, more: &str| {
        folder.write(&format!("{name}.toml"), case);
        let run = format!("run @osc.clebsch --case @{name}.toml --out @{name} {more}");
        folder.runs(&run);
        let mut rows = folder.samples(&format!("{name}/trajectory.csv")).rows;
        rows.pop().expect("a row")
    };
    let plain = case("\"k/40\"", "2");
    let set = last("set", &plain, "--set k=1");
    assert_eq!(set, last("typed", &case("\"k/40\"", "1"), ""));
    let step = last("step", &plain, "--h 0.02 --steps 10");
    assert_eq!(step, last("step-typed", &case("0.02", "2"), "--steps 10"));
    // A point of a sweep is also that run.
    let out = folder.path("sweep");
    folder.write("from.toml", case("0.025", "2"));
    folder.runs(&format!(
        "sweep @osc.clebsch --case @from.toml --vary k=1,3 --out {out}"
    ));
    let points = folder.samples("sweep/sweep.csv").rows;
    for (k, row) in [("1", 0), ("3", 1)] {
        let typed = last(&format!("k{k}"), &case("0.025", k), "");
        let at = points[row].len() - 4;
        assert_eq!(points[row][at..], typed[2..6], "{k}");
    }
}

#[test]
fn options_take_expressions() {
    let run = |more: &str| clebsch(&format!("run kepler --check none {more}")).out;
    assert!(run("--until 2*pi --h pi/50").contains(", 100 steps, to time 6.28318530718;"));
    assert_eq!(run("--steps 3 --set k=m/4"), run("--steps 3 --set k=0.25"));
}

#[test]
fn a_sweep_over_the_step_keeps_the_time() {
    let folder = Folder::new("options-sweep");
    let sweep = |name: &str, more: &str, code: u8| {
        let vary = "sweep kepler --vary h=0.1,0.05,0.025";
        folder
            .clebsch(&format!("{vary} --out @{name} {more}"))
            .ended(code);
        let rows = folder.samples(&format!("{name}/sweep.csv")).rows;
        rows.iter().map(|row| [row[3], row[4]]).collect::<Vec<_>>()
    };
    assert_eq!(
        // The energy leaves the bound of the case with the longest step.
        sweep("until", "--until 2", 3),
        [[20.0, 2.0], [40.0, 2.0], [80.0, 2.0]]
    );
    assert_eq!(
        sweep("steps", "--steps 4", 0),
        [[4.0, 0.4], [4.0, 0.2], [4.0, 0.1]]
    );
}

/// At time t the body of the circular case is at (cos t, 0.8 sin t, 0.6 sin t).
#[test]
fn orders_are_measured_against_the_limit() {
    let folder = Folder::new("options-converge");
    folder.runs("converge kepler --h 0.1 --until 10 --out @converged");
    let levels = folder.samples("converged/convergence.csv").rows;
    assert_eq!(levels.len(), 6);
    for (level, row) in levels.iter().enumerate() {
        let steps = 100 << level;
        assert_eq!(row[1], f64::from(steps));
        folder.clebsch(&format!(
            "run kepler --h {} --steps {steps} --every {steps} --check none --out @run-{level}",
            row[0]
        ));
        let samples = folder.samples(&format!("run-{level}/trajectory.csv"));
        let last = samples.rows.last().expect("a row");
        let (sine, cosine) = 10_f64.sin_cos();
        let exact = [cosine, 0.8 * sine, 0.6 * sine];
        let distance = exact
            .iter()
            .zip(&last[2..5])
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>()
            .sqrt();
        // The extrapolation is far better than the finest run.
        assert!((row[2] - distance).abs() < 1e-8, "{} {distance}", row[2]);
        if level > 0 {
            assert!(
                (row[3] - 2.0).abs() < 0.02 && (row[5] - 2.0).abs() < 0.02,
                "{row:?}"
            );
        }
    }
    assert!(folder.read("converged/convergence.svg").contains("order 2"));
    let order = |words: &str| {
        let json = clebsch(&format!("converge {words} --json")).json();
        json["levels"][3]["orders"][0].as_f64().expect("an order")
    };
    let fourth = order("kepler --order 4 --h 0.2 --until 10");
    assert!((fourth - 4.0).abs() < 0.1, "{fourth}");
    // The mass is evaluated only at the start of the step.
    let text =
        "model Uneven { param m: Real; field x: Real; lagrangian = m*x^2*(next(x) - x)^2/(2*h); }";
    let file = folder.write("uneven.clebsch", text);
    let case = "model = \"uneven\"\nh = 0.01\nsteps = 100\n[parameters]\nm = 1.0\n[initial]\nx = 1.0\nmomentum = 0.5\n";
    folder.write("uneven.toml", case);
    let first = order(&file);
    assert!((first - 1.0).abs() < 0.1, "{first}");
}

#[test]
fn a_run_prints_as_much_as_it_is_asked_to() {
    let run = |more: &str| clebsch(&format!("run heavy-top --steps 20 {more}"));
    let (quiet, plain, verbose) = (run("--quiet"), run(""), run("--verbose"));
    assert_eq!(
        (quiet.code, quiet.out.as_str(), quiet.err.as_str()),
        (0, "", "")
    );
    assert!(
        plain.out.starts_with("heavy-top, case lagrange: "),
        "{}",
        plain.out
    );
    assert!(!plain.out.contains("Riccati") && verbose.out.contains("Riccati form"));
    verbose.prints(["steps: compiled\n"]);
    assert!(
        verbose
            .out
            .ends_with(plain.out.split_once('\n').expect("lines").1)
    );
    // A run still reports an exceeded bound.
    clebsch("run kepler --h 0.2 --quiet")
        .exits(3)
        .prints_nothing()
        .says("bound exceeded: energy");
}

#[test]
fn invariants_are_looked_at_where_it_was_asked() {
    let run = |every: &str| {
        let json = clebsch(&format!(
            "run kepler:eccentric --steps 1000 --every {every} --json"
        ))
        .json();
        json["results"]["invariants"][0]["worst_drift"]
            .as_f64()
            .expect("a drift")
    };
    // The energy oscillates: its deviation is not largest at the last node.
    assert!(run("1") > run("1000"));
    clebsch("run kepler --steps 100 --every 10")
        .prints("drifts: sampled every 10 nodes and at the last");
}

#[test]
fn long_samples_are_text_where_that_is_asked_for() {
    let folder = Folder::new("options-csv");
    let run = |name: &str, more: &str| {
        let out = folder.path(name);
        folder.runs(&format!(
            "run toda-chain:two-solitons --steps 2000 --check none --out @{name} {more}"
        ));
        fs::metadata(format!("{out}/trajectory.csv")).is_ok()
    };
    // 2001 samples of 258 numbers.
    assert_eq!(
        [
            run("long", ""),
            run("asked", "--csv"),
            run("few", "--every 10")
        ],
        [false, true, true]
    );
}

#[test]
fn many_sites_are_compared_as_one_quantity() {
    clebsch("compare toda-chain --steps 10")
        .prints("error q  error momentum_q")
        .never_prints("q_0");
}

/// Two bodies that fall towards each other meet between two nodes, which no step detects.
#[test]
fn an_energy_that_is_lost_is_told_with_its_node() {
    let folder = Folder::new("options-lost");
    let text = "model TwoBody { param G, M, m: Real; field X, Y: Vec<3>; let u = next(X) - X; let v = next(Y) - Y; let d = Y - X;
        lagrangian = (M*dot(u, u) + m*dot(v, v))/(2*h) + h*G*M*m/sqrt(dot(d, d)); }";
    folder.write("two-body.clebsch", text);
    let case = |y: &str, momentum: &str| {
        format!(
            "model = \"two-body\"\nh = 0.01\nsteps = 300\n[parameters]\nG = 1.0\nM = 1.0\nm = 1.0\n[initial]\nX = [0, 0, 0]\n\
             Y = {y}\nmomentum_X = [0, 0, 0]\nmomentum_Y = {momentum}\n"
        )
    };
    folder.write("fall.toml", case("[1, 0, 0]", "[0, 0, 0]"));
    folder
        .clebsch("run @two-body.clebsch --case @fall.toml")
        .says("warning: the energy is not conserved from node 79 (time 0.79) on");
    let json = folder.clebsch("run @two-body.clebsch --case @fall.toml --json");
    let json = json.json();
    assert_eq!(json["results"]["invariants"][0]["lost_at"], 79);
    assert!(
        json["warnings"][0]
            .as_str()
            .is_some_and(|w| w.contains("reduce h"))
    );
    // Bodies that pass at a distance conserve their energy.
    folder.write("pass.toml", case("[1, 0, 0]", "[0, 0.5, 0]"));
    folder
        .clebsch("run @two-body.clebsch --case @pass.toml")
        .never_says("is not conserved from");
}

/// A momentum that is not projected is of first order at its node, while the motion is of second order.
#[test]
fn what_is_of_lower_order_at_its_node_is_told() {
    let folder = Folder::new("options-converge-clock");
    let text = "model Shaken {
        param m, g, A, w: Real;
        field x: Vec<2>;
        advected t: Real;
        constraint next(t) = t + h;
        hold λ: dot(x, x) = 1;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[2]*(1 + A*sin(w*t));
    }";
    folder.write("shaken.clebsch", text);
    let case = "model = \"shaken\"\nh = 0.02\nsteps = 50\n[parameters]\nm = 2\ng = 9.81\nA = 0.1\nw = 2\n[initial]\n\
                x = [0.6, -0.8]\nvelocity = [0.2, 0.15]\nt = 0\n";
    folder.write("shaken.toml", case);
    let done = folder.clebsch("converge @shaken.clebsch");
    let said =
        "measured order below 2: `momentum` (1.00); `x` converges with the order of the step";
    done.prints(said);
    let json = folder.clebsch("converge @shaken.clebsch --json").json();
    for (at, order) in [(0, 2.0), (1, 1.0)] {
        let fitted = json["fitted_orders"][at].as_f64().expect("an order");
        assert!((fitted - order).abs() < 0.05, "{}", json["fitted_orders"]);
        for level in 1..6 {
            let measured = json["levels"][level]["orders"][at].as_f64();
            let measured = measured.expect("an order");
            assert!((measured - order).abs() < 0.05, "{json}");
        }
    }
    assert!(json["fitted_orders"][2].is_null(), "{json}");
}
