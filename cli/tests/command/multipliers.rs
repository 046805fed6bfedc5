//! Multipliers in recorded runs and in printed derivations: the test solves the equations of a step and of the
//! projection on arrival for them by hand, from recorded positions and momenta.

use crate::common::{Folder, clebsch, runs};

/// The columns of a run by name, at two nodes.
fn two_nodes(folder: &Folder, model: &str, case: &str) -> impl Fn(&str, usize) -> f64 {
    let model = folder.write("own.clebsch", model);
    let case = folder.write("own.toml", case);
    folder.runs(&format!(
        "run {model} --case {case} --every 1 --out @out --force"
    ));
    let samples = folder.samples("out/trajectory.csv");
    move |name, node| samples.at(name, node)
}

/// Rounding errors of momenta and positions divided by the step size, for multipliers of size one to ten.
const ROUNDED: f64 = 1e-10;

#[test]
fn the_multiplier_of_a_pendulum_is_that_of_the_printed_equations() {
    let folder = Folder::new("multiplier");
    let model = "model Pendulum {
        param m, L, g: Real;
        field x: Vec<3>;
        hold p: dot(x, x) = L^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[3];
    }";
    let case = "model = \"pendulum\"\nh = 0.01\nsteps = 4\n[parameters]\nm = 1.3\nL = 1.0\ng = 9.81\n\
                [initial]\nx = [0.6, 0.0, -0.8]\nmomentum = [0.0, 0.7, 0.0]\n";
    let at = two_nodes(&folder, model, case);
    let (m, g, h) = (1.3, 9.81, 0.01);
    let of = |name: &str, node: usize| [1, 2, 3].map(|i| at(&format!("{name}_{i}"), node));
    for k in 0..4 {
        let (x, y) = (of("x", k), of("x", k + 1));
        let (p, q) = (of("momentum", k), of("momentum", k + 1));
        let weight = |i: usize| if i == 2 { 0.5 * h * m * g } else { 0.0 };
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        // p_k = m Δx/h + h m g E3/2 - 2 h λ x_k, along x_k; x_k is of length one.
        let leaving: [f64; 3] = core::array::from_fn(|i| m * (y[i] - x[i]) / h + weight(i) - p[i]);
        let own = dot(leaving, x) / (2.0 * h);
        // m ζ = m Δx/h - h m g E3/2 - 2 δ x_{k+1}.
        let arriving: [f64; 3] = core::array::from_fn(|i| m * (y[i] - x[i]) / h - weight(i) - q[i]);
        let impulse = dot(arriving, y) / 2.0;
        let told = at("p", k + 1);
        assert!(
            (told - (own - impulse / h)).abs() < ROUNDED * told.abs(),
            "{k}: {told} {own} {impulse}"
        );
        // Neither part equals the whole.
        assert!((told - own).abs() > 0.3 * told.abs(), "{k}: {told} {own}");
    }
}

#[test]
fn the_multiplier_of_a_sum_is_that_of_the_printed_equations() {
    let folder = Folder::new("multiplier-of-a-sum");
    let model = "model Balanced {
        label i in 0..N;
        param m, f: Real at nodes;
        param X: Real;
        field q: Real at nodes;
        hold p: sum(m*q) = X;
        lagrangian = m*(next(q) - q)^2/(2*h) + h*f*q - (h/2)*(next(q, i) - q)^2;
    }";
    for n in [3, 40] {
        let case = format!(
            "model = \"balanced\"\nh = 0.05\nsteps = 3\n[labels]\ni = {n}\n[ends]\ni = [\"free\", \"free\"]\n\
             [parameters]\nm = \"1 + 0.5*i/N\"\nf = \"i/N\"\nX = 0.0\n[initial]\nq = 0.0\nmomentum_q = 0.0\n"
        );
        let at = two_nodes(&folder, model, &case);
        let h = 0.05;
        for k in 0..3 {
            let of = |name: &str, i: usize, node: usize| at(&format!("{name}_{i}"), node);
            let (mut own, mut impulse, mut squares) = (0.0, 0.0, 0.0);
            for i in 0..=n {
                let part = i as f64 / f64::from(n as u32);
                let (m, f) = (1.0 + 0.5 * part, part);
                let force = |node: usize| {
                    let here = of("q", i, node);
                    let before = if i > 0 {
                        of("q", i - 1, node) - here
                    } else {
                        0.0
                    };
                    let behind = if i < n {
                        of("q", i + 1, node) - here
                    } else {
                        0.0
                    };
                    f + before + behind
                };
                let moved = m * (of("q", i, k + 1) - of("q", i, k)) / h;
                // p_k = m Δq/h - h F_k/2 - h λ m, and m ζ = m Δq/h + h F_{k+1}/2 - δ m.
                own += m * (moved - 0.5 * h * force(k) - of("momentum_q", i, k)) / h;
                impulse += m * (moved + 0.5 * h * force(k + 1) - of("momentum_q", i, k + 1));
                squares += m * m;
            }
            let (own, impulse) = (own / squares, impulse / squares);
            let told = at("p", k + 1);
            assert!(
                (told - (own - impulse / h)).abs() < ROUNDED,
                "{n}, {k}: {told} {own} {impulse}"
            );
            assert!(
                (told - own).abs() > 0.3 * told.abs(),
                "{n}, {k}: {told} {own}"
            );
        }
    }
}

/// Two bodies on a hinge in units in which masses are 1e-8. The motion is the same, and rates along the constraints
/// vanish to the same rounding error. In the past, the projection of momenta lost the masses next to the larger
/// entries of the constraints.
#[test]
fn light_bodies_on_a_hinge_stay_on_it() {
    let folder = Folder::new("light-hinge");
    folder.write(
        "joint.clebsch",
        "model Joint {
            param J, K: Sym<3>;
            param p, q: Vec<3>;
            param m, M: Real;
            group R: SO<3> velocity W;
            group S: SO<3> velocity V;
            field x, y: Vec<3>;
            constraint next(R) = R*W;
            constraint next(S) = S*V;
            hold n: x + R*p = y + S*q;
            hold ax: dot(R*E1, S*E2) = 0;
            hold ay: dot(R*E1, S*E3) = 0;
            lagrangian = -tr(J*W)/h - tr(K*V)/h + m*dot(next(x) - x, next(x) - x)/(2*h)
                + M*dot(next(y) - y, next(y) - y)/(2*h) - h*(x[3] + y[3])*m;
        }",
    );
    folder.write(
        "joint.toml",
        "model = \"joint\"\nh = 0.02\nsteps = 200\n[parameters]\n\
         J = [[1e-8, 0.0, 0.0], [0.0, 2e-8, 0.0], [0.0, 0.0, 1.5e-8]]\n\
         K = [[2e-8, 0.0, 0.0], [0.0, 4e-8, 0.0], [0.0, 0.0, 3e-8]]\n\
         p = [0.5, 0.2, 0.0]\nq = [-0.5, 0.2, 0.0]\nm = 1e-8\nM = 2e-8\n\
         [initial]\nR = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n\
         S = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n\
         x = [0.0, 0.0, 0.0]\ny = [1.0, 0.0, 0.0]\n\
         body_momentum_R = [0.0, 0.0, 0.0]\nbody_momentum_S = [0.0, 0.0, 0.0]\n\
         momentum_x = [1e-9, 0.0, 0.0]\nmomentum_y = [2e-9, 0.0, 0.0]\n\
         [bounds]\nconstraint_rate_n = 1e-14\nconstraint_rate_ax = 1e-14\nconstraint_rate_ay = 1e-14\n",
    );
    folder.runs("run @joint.clebsch --case @joint.toml");
}

/// One segment has no pair of neighbouring sections and hence no bending energy: an empty sum, which must be a
/// number.
#[test]
fn a_held_rod_of_one_segment_has_an_energy() {
    let folder = Folder::new("one-segment");
    let case = "model = \"kirchhoff-rod\"\nname = \"one\"\nh = 0.001\nsteps = 5\n[labels]\ni = 1\n[ends]\ni = [\"pinned\", \"free\"]\n\
        [parameters]\ns = 0.5\nm = 1.0\nJ = [[0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.05]]\n\
        B = [[0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.05]]\ng = [0.0, 0.0, 9.81]\n[initial]\nphi = [0.0, 0.0, \"s*i\"]\n\
        momentum_phi = [0.0, 0.0, 0.0]\nLambda = [1.0, 0.0, 0.0, 0.0]\nbody_momentum_Lambda = [0.0, 0.0, 0.0]\n";
    let model = format!(
        "{}/../models/lattices/kirchhoff-rod.clebsch",
        env!("CARGO_MANIFEST_DIR")
    );
    let case = folder.write("one.toml", case);
    let object = runs(&format!("run {model} --case {case} --json")).json();
    let energy = &object["results"]["invariants"][0];
    assert_eq!(energy["name"], "energy", "{energy}");
    // It is at rest: the mass at the end, 1, times 9.81 over half a unit of length.
    let scale = energy["scale"].as_f64().expect("a number");
    assert!((scale - 4.905).abs() < 1e-14, "{energy}");
}

/// If the ends prescribe all sites but one, the momentum belongs to the remaining site. It moves, and a momentum off
/// the constraint is rejected.
#[test]
fn the_one_site_that_moves_has_its_momentum() {
    let folder = Folder::new("one-site");
    let model = |last: &str| {
        format!(
            "model Links {{ label i in 0..N; param m: Real at nodes; param l: Real at segments; field x: Vec<2> at nodes; \
             hold n: dot(next(x, i) - x, next(x, i) - x) = l^2; let V = next(x) - x; \
             lagrangian = m*dot(V, V)/(2*h) - h*m*x[2]; end i = 0 {{ pinned {{ x = given; }} }} {last} }}"
        )
    };
    let case = |links: usize, x: &str, p: [f64; 2]| {
        format!(
            "model = \"links\"\nname = \"own\"\nh = 0.001\nsteps = 1\n[labels]\ni = {links}\n\
             [parameters]\nm = 1.0\nl = 1.0\n[initial]\nx = {x}\nmomentum_x = [{:?}, {:?}]\n",
            p[0], p[1]
        )
    };
    // A tilted pendulum: a momentum along its circle is accepted, a momentum along its link is rejected.
    let leaning = "[\"0.6*i\", \"-0.8*i\"]";
    let (free, along) = (model(""), case(1, leaning, [0.8, 0.6]));
    let at = two_nodes(&folder, &free, &along);
    let (x, p) = (at("x_1_1", 1), at("momentum_x_1_1", 0));
    // The displacement of a step, up to a few terms of second order.
    assert!((x - 0.6 - 0.8e-3).abs() < 3e-6 && p == 0.8, "{x} {p}");
    let refused = |last: &str, case: &str| {
        let model = folder.write("links.clebsch", model(last));
        let case = folder.write("case.toml", case);
        clebsch(&format!("run {model} --case {case}")).refuses("is not tangent to the constraint");
    };
    refused("", &case(1, leaning, [0.6, -0.8]));
    // Between two prescribed ends, the joint of two links in the plane cannot move.
    let joint = "[\"0.6*i\", \"-0.8*i*(2 - i)\"]";
    let held = "end i = N { pinned { x = given; } }";
    refused(held, &case(2, joint, [0.1, 0.0]));
}

/// Action and constraint depend only on `C = Q^T Q`, which rotations of space do not change: constraint forces
/// conserve the momentum of these rotations, for any notation.
#[test]
fn reactions_written_by_advected_quantities_leave_what_they_do_not_change() {
    let folder = Folder::new("reactions-by-advected");
    let model = r#"model A4 {
    param I0: Sym<3>; param a, b, c: Real; param f: Vec<3>;
    group Q: GL<3> velocity G;
    advected C: Sym<3> = Q^T*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    hold p: dot(f, C*f) = dot(f, f);
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(a*tr(C) + b*I2(C) - c*log(det(C)));
}"#;
    let case = r#"model = "a4"
name = "c"
doc = "c"
h = 0.05
steps = 12

[parameters]
I0 = [[1.205746537945, 0.13961997097099804, 0.09763248442239597], [0.13961997097099804, 0.6311282645144728, -0.16149718052848774], [0.09763248442239597, -0.16149718052848774, 0.982340732677681]]
a = 0.46486585824954607
b = 0.6942143517142021
c = 0.4515974146458225
f = [0.2994231063173138, 0.019861053740829495, -0.1462283754825443]

[initial]
Q = [[0.8774019219310983, -0.028664803074704925, 0.022501246319340647], [-0.028899715573023527, 1.1293175359492715, 0.10132656257123335], [-0.22320132226492997, -0.18572307651610684, 0.959122720497102]]
body_momentum = [[-0.01110885263621708, 0.04994609090395395, -0.1353340905761882], [1.2397888160578638, -0.18155660460206013, -0.03428467048639613], [0.6222076644092212, 0.15081191467850244, 0.37689370434391967]]"#;
    let model = folder.write("own.clebsch", model);
    let case = folder.write("own.toml", case);
    let done = runs(&format!("run {model} --case {case} --json"));
    let object = done.json();
    let all = object["results"]["invariants"]
        .as_array()
        .expect("a list")
        .iter();
    let mut drifts = all.filter(|i| i["name"] == "spatial_momentum_skew_identity");
    let drift = drifts.next().and_then(|i| i["worst_drift"].as_f64());
    assert!(drift.is_some_and(|x| x < 1e-14), "{}", done.out);
}

#[test]
fn constraints_hold_where_a_velocity_that_rested_begins_to_move() {
    // The second mass is straight above the first: the terms of its horizontal equation vanish in the first
    // steps.
    let folder = Folder::new("double-pendulum");
    let model = "model Double {
        param m, l, g: Real;
        field x, y: Vec<2>;
        hold p: dot(x, x) = l^2;
        hold q: dot(y - x, y - x) = l^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) - h*g*m*(x[2] + y[2]);
    }";
    let case = "model = \"double\"\nh = 0.02\nsteps = 60\n[parameters]\nm = 1.0\nl = 1.0\ng = 9.81\n[initial]\n\
                x = [1.0, 0.0]\ny = [1.0, 1.0]\nmomentum_x = [0.0, 0.0]\nmomentum_y = [0.0, 0.0]\n";
    let at = two_nodes(&folder, model, case);
    for node in 0..=60 {
        let [x, y] = ["x", "y"].map(|name| [1, 2].map(|i| at(&format!("{name}_{i}"), node)));
        let square = |a: f64, b: f64| a * a + b * b;
        let off = (square(x[0], x[1]) - 1.0)
            .abs()
            .max((square(y[0] - x[0], y[1] - x[1]) - 1.0).abs());
        // A few roundings of squares of size one.
        assert!(off < 1e-14, "node {node}: {off:e}");
    }
}
