//! Arithmetic in the numbers of every case, with and without labels, and one value for all copies of a quantity.

use crate::common::{Folder, clebsch, table};
use crate::text_runs::{Ran, run};

const MODEL: &str = "model Beads {
    param m1, m2, k: Real;
    param J1, J2: Sym<3>;
    param a: Vec<3>;
    group R1: SO<3> velocity W1;
    group R2: SO<3> velocity W2;
    constraint next(R1) = R1*W1;
    constraint next(R2) = R2*W2;
    field x_1, x_2: Vec<2>;
    let d = x_1 - x_2;
    lagrangian = m1*dot(next(x_1) - x_1, next(x_1) - x_1)/(2*h) + m2*dot(next(x_2) - x_2, next(x_2) - x_2)/(2*h)
        - h*k*dot(d, d)/2 - (tr(J1*W1) + tr(J2*W2))/h - h*dot(a, R1*R2^T*a);
}";

fn case(numbers: &str) -> String {
    format!(
        "model = \"beads\"\nh = \"m1/100\"\nsteps = \"10*k\"\n{numbers}\n\
         [initial]\nR = {{ axis = [0, 0, 1], angle = \"pi*m1\" }}\nx = [\"cos(pi/3)\", \"k - 1\"]\nx_2 = [0, 1]\nvelocity_x = [\"1/m2\", 0]\n\
         angular_velocity_R2 = [0, 0, \"sqrt(k)\"]\n[bounds]\nenergy = \"1/k\"\n"
    )
}

const PARAMETERS: &str = "[parameters]\nm2 = \"k*m1\"\nm1 = \"1/k\"\nk = 2\nI = [1, \"3/2\", \"k\"]\na = [0, 0, \"sin(0)\"]";

#[test]
fn every_number_may_be_an_expression_and_one_value_stands_for_all_copies() {
    let ran = Ran::of(MODEL, &case(PARAMETERS), "expressions");
    assert!(ran.out.contains("h = 0.005, 20 steps"), "{}", ran.out);
    assert_eq!([ran.parameter("m1"), ran.parameter("m2")], [0.5, 1.0]);
    assert!((ran.at("x_1_1", 0) - 0.5).abs() < 1e-15);
    assert_eq!([ran.at("x_1_2", 0), ran.at("x_2_1", 0)], [1.0, 0.0]);
    assert_eq!(
        [ran.at("momentum_x_1_1", 0), ran.at("momentum_x_2_1", 0)],
        [0.5, 1.0]
    );
    // Both attitudes are the quarter turn, and one of them moves.
    for name in ["R1", "R2"] {
        let [a, b] = ["21", "11"].map(|entry| ran.at(&format!("{name}_{entry}"), 0));
        assert!((a - 1.0).abs() < 1e-15 && b.abs() < 1e-15, "{a} {b}");
    }
    assert!((ran.at("body_momentum_R2_3", 0) - 2.0 * 2.0_f64.sqrt()).abs() < 1e-13);
    assert_eq!(ran.at("body_momentum_R1_3", 0), 0.0);
}

#[test]
fn what_has_no_value_is_told_at_its_key() {
    let folder = Folder::new("expressions-wrong");
    for [from, to, said] in table(
        r#"
        m1 = "1/k"           | m1 = "1/n"            | h: "m1/100": `m1` has no value here: m1 = "1/n", and `n` has no value; an expression may contain the step
        m2 = "k*m1"          | m2 = "1/n"            | parameters.m2: "1/n": `n` has no value here; an expression may contain the step
        m1 = "1/k"           | m1 = "m2/2"           | are circular definitions
        m1 = "1/k"           | m1 = "1/0"            | m1 = "1/0" is not a finite number
        steps = "10*k"       | steps = "10.2*k"      | steps: must be a whole number, at least 1, found 20.4
        "k - 1"              | "k -"                 | initial.x: "k -":
        energy = "1/k"       | energy = "-k"         | bounds.energy: a bound must not be negative, found -2
        a = [0, 0, "sin(0)"] | a = { csv = "a.csv" } | write an array of a file as { npz =
"#,
    ) {
        let text = case(PARAMETERS);
        let wrong = text.replacen(from, to, 1);
        assert_ne!(text, wrong, "{from}");
        run(&folder, MODEL, &wrong, "").refuses(said);
    }
}

#[test]
fn labels_and_domains_are_counted_by_expressions() {
    let folder = Folder::new("expressions-labels");
    let chain = "model Chain {
        label i in 0..N step s;
        param m, k, M: Real;
        field q: Real at nodes;
        lagrangian = (m + 0*M)*(next(q) - q)^2/(2*h) - (h*k/2)*(next(q, i) - q)^2/s;
    }";
    let case = "model = \"chain\"\nh = \"s/10\"\nsteps = \"M\"\n[labels]\ni = \"2*M\"\n\
                [parameters]\ns = \"1/M\"\nM = 3\nm = \"s\"\nk = 1\n[initial]\nq = \"0.1*sin(2*pi*i/N)\"\n";
    let done = run(&folder, chain, case, "").succeeds();
    done.prints("3 steps");
    let wrong = case.replace("\"2*M\"", "\"2.5*M\"");
    let done = run(&folder, chain, &wrong, "");
    let said = "labels.i: expected a whole number of sites";
    done.says(said);
}

/// A particle that starts beyond a wall is rejected, not reflected.
#[test]
fn particles_start_between_the_walls() {
    let model = "model Row {
        label a in 0..N;
        grid n;
        param m: Real at a;
        param w: Real at n;
        param c0, alpha: Real;
        field X: Real at a on box;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = m*(next(X) - X)^2/(2*h) - h*(c0^2/2)*w*H*S;
    }";
    let folder = Folder::new("start-outside");
    let case = |places: &str| {
        format!(
            "model = \"row\"\nh = 0.01\nsteps = 2\n[labels]\na = 4\nn = \"2*4\"\n[domain]\nlengths = [\"1/2 + 1/2\"]\nwalls = [\"solid\"]\n\
             [parameters]\nm = 0.25\nc0 = 1.0\nalpha = 0.1\n[initial]\nX = {places}\n"
        )
    };
    for (first, said) in [("-0.12", "-0.12"), ("-0.001", "-0.001"), ("3", "3")] {
        let places = format!("[{first}, 0.4, 0.6, 0.9]");
        let said = format!("initial.X: particle 0 at {said} lies outside the walls 0 to 1");
        run(&folder, model, &case(&places), "").refuses(&said);
    }
    run(&folder, model, &case("[0, 0.4, 0.6, 1]"), "").succeeds();
    clebsch(&format!(
        "run {} --case {}",
        folder.path("model.clebsch"),
        folder.write("csv.toml", case("{ csv = \"x.csv\" }"))
    ))
    .says("{ npz = ");
}
