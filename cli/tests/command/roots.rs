//! Steps whose equations have several roots: a step takes the principal root, or fails at the fold. Reference numbers
//! come from continuation in small increments of the momentum, two million increments for the hoop, or by arclength;
//! the numbers for one field come from its momentum at 400,000 velocities.

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

/// One step of a model from a case; it must fail at this share of the momentum.
fn folds(name: &str, model: &str, case: &str, share: &str) {
    let folder = Folder::new(name);
    let model = folder.write(&format!("{name}.clebsch"), model);
    let text = format!("model = \"{name}\"\nsteps = 1\n{case}");
    let case = folder.write(&format!("{name}.toml"), &text);
    let done = rotor(&format!("run {model} --case {case}")).exits(1);
    let words = format!("its tangent becomes singular at {share}");
    assert!(done.err.contains(&words), "{}", done.err);
}

/// Another root is straight ahead, on the other side of the axis of the hoop.
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

/// The mass grows a hundredfold in the middle of the path; another root exists beyond the fold.
#[test]
fn a_heavy_place_on_the_way_is_not_passed_over() {
    let model = "model Bump { param a, w: Real; field x: Real; let d = next(x) - x; let c = (x + next(x))/2;
            lagrangian = d^2/(2*h)*(1 + a*exp(-c^2/(2*w^2))); }";
    let case = |a, w, x, momentum| {
        format!(
            "h = 1.0\n[parameters]\na = {a}\nw = {w}\n[initial]\nx = {x}\nmomentum = {momentum}\n"
        )
    };
    folds(
        "bump",
        model,
        &case("100.0", "0.1", "-1.56", "4.59"),
        "0.459250",
    );
    // The narrow region has a width of 0.006 of the displacement of its argument.
    folds(
        "bump",
        model,
        &case("1.0", "0.0064", "-0.42", "2.08"),
        "0.374210",
    );
    folds(
        "bump",
        model,
        &case("10.0", "0.004", "-0.28", "1.19"),
        "0.434710",
    );
}

/// A bead passes through the axis of its hoop several times; around the axis it would rotate a hundred times as fast.
/// The first correction ends before a bump, and the computed solution is beyond it. The first root of `T = 1`, where
/// `T = (1 + e) d + x e d²/(4 w²)`, `x = d/2 - c` and `e = -exp(-x²/(2 w²))/2`, is before it.
#[test]
fn a_bump_beyond_the_first_correction_is_not_passed_over() {
    let folder = Folder::new("beyond");
    let model = folder.write(
        "bump.clebsch",
        "model Bump { param c, w: Real; field q: Real; let d = next(q) - q; let y = ((q + next(q))/2 - c)/w;
            lagrangian = (1 - exp(-y^2/2)/2)*d^2/(2*h); }",
    );
    let case = folder.write(
        "bump.toml",
        "model = \"bump\"\nh = 1.0\nsteps = 1\n[parameters]\nc = 0.447946\nw = 0.011662\n\
         [initial]\nq = 0.0\nmomentum = 1.0\n",
    );
    let row = stepped(&folder, &model, &case);
    let [c, w, d] = [0.447946, 0.011662, row[2]];
    let x = d / 2.0 - c;
    let e = -0.5 * f64::exp(-x * x / (2.0 * w * w));
    let found = (1.0 + e) * d + x * e * d * d / (4.0 * w * w);
    assert!((found - 1.0).abs() < 1e-12, "{found} at {d}");
    assert!(d < 0.87, "{d} lies behind the fold at 0.8726");
}

#[test]
fn a_bead_that_crosses_the_axis_many_times_is_refused() {
    let model = "model Crossing { param m, R, g, I: Real; field th, ph: Real;
            let d = next(th) - th; let e = next(ph) - ph; let s = sin((th + next(th))/2);
            lagrangian = m*R^2*d^2/(2*h) + (m*R^2*s^2 + I)*e^2/(2*h) + h*m*g*R*cos(th); }";
    for (case, share) in [
        (
            "h = 6.335884451259102\n[parameters]\nm = 6.145165427904088\nR = 1.2615222303303002\n\
             g = 2.633469266364787\nI = 0.003553537103770711\n[initial]\nth = 1.1374016857258447\n\
             ph = -2.360840029490718\nmomentum_th = -0.028880358006107235\nmomentum_ph = -0.10187415901979992\n",
            "0.073866",
        ),
        (
            "h = 9.643095153532146\n[parameters]\nm = 3.25591722502067\nR = 1.038954485468665\n\
             g = 1.45739723243316\nI = 0.07294714331337958\n[initial]\nth = -2.1478249185773777\n\
             ph = -2.51271091108193\nmomentum_th = 0.2204622746956638\nmomentum_ph = -0.2056635438146722\n",
            "0.077783",
        ),
    ] {
        folds("crossing", model, case, share);
    }
}

/// The mass is large at the start of the step, within a fortieth or a fifth of the displacement.
#[test]
fn a_mass_that_falls_near_rest_is_not_left_behind() {
    let model = "model Pmass { param m, a, l: Real; field X: Vec<2>;
            let d = next(X) - X; let c = (X + next(X))/2;
            lagrangian = m*(dot(d, d) + a*dot(c, d)^2/l^2)/(2*h)*exp(-dot(c, c)/(2*l^2)) + m*a*dot(d, d)/(2*h); }";
    for (case, share) in [
        (
            "h = 5.7289395266444805\n[parameters]\nm = 0.017305994444519187\na = 0.013984708739245181\nl = 1.0\n\
             [initial]\nX = [0.07793505534974289, 1.2928186879576133]\n\
             momentum = [0.0008569030708842089, 0.0032266316098219275]\n",
            "0.341362",
        ),
        (
            "h = 7.398613743193748\n[parameters]\nm = 0.014318063082730351\na = 0.4172390904007519\n\
             l = 5.632519126991175e-07\n[initial]\nX = [-4.2928930502436434e-07, 3.592155275977712e-07]\n\
             momentum = [3.3320844516378814e-09, 1.003345926059844e-08]\n",
            "0.383318",
        ),
    ] {
        folds("pmass", model, case, share);
    }
}

/// The narrow region concerns a field that moves a thousandth as far as another field.
#[test]
fn a_light_place_beside_a_long_way_is_not_passed_over() {
    let model = "model Beside { param M, a, w: Real; field x, X: Real; let d = next(x) - x; let f = next(X) - X;
            let c = (x + next(x))/2; lagrangian = M*f^2/(2*h) + d^2/(2*h)*(1 + a*exp(-c^2/(2*w^2))); }";
    let case = "h = 1.0\n[parameters]\nM = 0.25\na = -0.5\nw = 0.2\n[initial]\nx = -0.41\nX = 0.0\n\
                momentum_x = 3.59\nmomentum_X = 1400.0\n";
    folds("beside", model, case, "0.126995");
}

/// At rest, only the rounding of the constraint remains in the equations.
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
