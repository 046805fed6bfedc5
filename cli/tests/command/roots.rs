//! Steps whose equations have several roots: a step takes the one that follows from rest, or is refused at the fold.
//! Reference numbers come from a continuation in small parts of the momentum, in two million parts for the hoop.

use crate::common::{Folder, rotor};

/// One step of a model from a case; the run must succeed.
fn stepped(folder: &Folder, model: &str, case: &str) -> Vec<f64> {
    let out = folder.path("out");
    let run = format!("run {model} --case {case} --every 1 --csv --check none --force --out {out}");
    rotor(&run).succeeds();
    let table = std::fs::read_to_string(format!("{out}/trajectory.csv")).expect("a table");
    let last = table.lines().last().expect("a row");
    last.split(',')
        .map(|x| x.parse().expect("a number"))
        .collect()
}

/// Straight ahead lies another root, where the bead has crossed the axis of the hoop.
#[test]
fn a_bead_on_a_free_hoop_turns_back_before_the_axis() {
    let folder = Folder::new("hoop");
    let model = folder.write(
        "hoop.clebsch",
        "model Hoop { param m, R, I: Real; field th, ph: Real;
            let d = next(th) - th; let e = next(ph) - ph;
            lagrangian = m*R^2*d^2/(2*h) + (m*R^2*sin((th + next(th))/2)^2 + I)*e^2/(2*h); }",
    );
    let case = folder.write(
        "hoop.toml",
        "model = \"hoop\"\nh = 1.0\nsteps = 1\n[parameters]\nm = 1.0\nR = 1.0\nI = 0.001\n\
         [initial]\nth = -0.8\nph = 0.0\nmomentum_th = 1.6\nmomentum_ph = -0.2\n",
    );
    let row = stepped(&folder, &model, &case);
    let near = |x: f64, wanted: f64| (x - wanted).abs() < 1e-8;
    assert!(
        row.iter().any(|x| near(*x, 0.170_928_678)) && row.iter().any(|x| near(*x, -2.067_977_371)),
        "{row:?}"
    );
}

/// The mass grows a hundredfold in the middle of the way; beyond the fold lies another root.
#[test]
fn a_heavy_place_on_the_way_is_not_passed_over() {
    let folder = Folder::new("bump");
    let model = folder.write(
        "bump.clebsch",
        "model Bump { param a, w: Real; field x: Real; let d = next(x) - x; let c = (x + next(x))/2;
            lagrangian = d^2/(2*h)*(1 + a*exp(-c^2/(2*w^2))); }",
    );
    let case = folder.write(
        "bump.toml",
        "model = \"bump\"\nh = 1.0\nsteps = 1\n[parameters]\na = 100.0\nw = 0.1\n\
         [initial]\nx = -1.56\nmomentum = 4.59\n",
    );
    let done = rotor(&format!("run {model} --case {case}")).exits(1);
    let words = "the tangent becomes singular when 0.459250 of the momentum is reached";
    assert!(done.err.contains(words), "{}", done.err);
}

/// At rest nothing but the rounding of the constraint is left to solve for.
#[test]
fn a_pendulum_at_rest_stays() {
    let folder = Folder::new("pendulum-at-rest");
    let model = folder.write(
        "pen.clebsch",
        "model Pen { param m, L: Real; field x: Vec<2>; hold l: dot(x, x) = L^2;
            lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h); }",
    );
    for [x, y] in [
        [-0.011_851_109_634_899_208, 0.999_929_773_134_304_4],
        [-0.739_777_241_244_160_2, -0.672_851_865_819_795_1],
    ] {
        for speed in [0.0, 1e-17, 1e-15] {
            let momentum = [speed * y, -speed * x];
            let text = format!(
                "model = \"pen\"\nh = 0.1\nsteps = 20\n[parameters]\nm = 1.0\nL = 1.0\n\
                 [initial]\nx = {:?}\nmomentum = {momentum:?}\n",
                [x, y]
            );
            let case = folder.write("pen.toml", &text);
            rotor(&format!("run {model} --case {case}")).succeeds();
        }
    }
}
