//! Starts without a scale: at rest, or without forces. The drift of such an invariant is absolute, and a number
//! that is not finite stops the run at its node.

use crate::common::{Folder, clebsch, on, rotor};
use clebsch::card::Kind;
use clebsch_cli::gallery::Gallery;

/// Steps of each run: enough for forces to set a body at rest in motion.
const STEPS: &str = "100";

/// Parameters that remove the kinetic energy if they are zero.
const INERTIA: [(&str, &str); 4] = [
    ("charged-particle", "m"),
    ("kepler", "m"),
    ("mixed-four", "M"),
    ("mixed-four", "m"),
];

/// Every shipped model with its momenta set to zero, or with its vectors and numbers among the
/// parameters (weights, fields, couplings, but no masses) set to zero, or both.
#[test]
fn no_model_exceeds_a_bound_from_rest_or_without_forces() {
    for (rest, free) in [(true, false), (false, true), (true, true)] {
        let mut gallery = Gallery::shipped();
        for entry in &mut gallery.entries {
            entry.cases.truncate(1);
            for case in &mut entry.cases {
                case.bounds.clear();
                let momenta = entry.card.initial.iter().zip(&mut case.initial);
                for (field, values) in momenta {
                    let momentum = matches!(field.kind, Kind::BodyMomentum | Kind::SpatialMomentum);
                    if rest && momentum {
                        values.fill(0.0);
                    }
                }
                let parameters = entry.card.parameters.iter().zip(&mut case.parameters);
                for (field, values) in parameters {
                    let inertia = INERTIA.contains(&(entry.card.kebab, field.ascii));
                    if free && !inertia && matches!(field.kind, Kind::Scalar | Kind::Vector) {
                        values.fill(0.0);
                    }
                }
            }
        }
        for entry in &gallery.entries {
            let name = entry.card.kebab;
            let done = on(&gallery, &["run", name, "--steps", STEPS]).succeeds();
            done.never_prints("NaN");
            // All scales of a free body at rest are zero.
            if name == "free-body" && rest {
                let words = "absolute, because the scale is zero: ";
                done.prints(words);
            }
        }
    }
}

#[test]
fn absolute_drifts_are_said_and_judged() {
    let folder = Folder::new("absolute");
    let text = rotor("case harmonic-rotor").out;
    let rest = text.replace(", 1.5]", ", 0.0]");
    assert_ne!(rest, text);
    let file = folder.write("rest.toml", &rest);
    let run = ["run", "harmonic-rotor", "--case", &file, "--steps", "20"];
    let done = rotor(&run).succeeds();
    let words = "\nabsolute, because the scale is zero: energy\n";
    done.prints(words);
    let json = rotor(&[&run[..], &["--json"]].concat()).json();
    let energy = &json["results"]["invariants"][0];
    assert_eq!(energy["absolute"], true);
    assert_eq!(energy["worst_drift"], 0.0);
    assert_eq!(energy["verdict"], "kept");
    assert_eq!(json["results"]["invariants"][1]["absolute"], false);
}

/// Without weight, the momentum across its direction is zero for any motion, so it tests nothing.
#[test]
fn what_is_zero_by_a_parameter_is_told_and_not_praised() {
    let folder = Folder::new("zero-by-a-parameter");
    let file = folder.write(
        "thrown.clebsch",
        "/// Thrown.\nmodel Thrown {\n    param m: Real;\n    \
         param g: Vec<3>;\n    field x: Vec<3>;\n    let v = (next(x) - x)/h;\n    \
         lagrangian = h*(m*dot(v, v)/2 + m*dot(g, x));\n}\n",
    );
    let case = |g: &str| {
        let text = format!(
            "model = \"thrown\"\nname = \"one\"\nh = 0.01\nsteps = 20\n[parameters]\nm = 1.0\ng = {g}\n\
             [initial]\nx = [0.0, 0.0, 1.0]\nmomentum = [1.0, 2.0, 3.0]\n"
        );
        folder.write("one.toml", &text)
    };
    let out = folder.path("out");
    let run = |g: &str| {
        let case = case(g);
        let run = ["run", &file, "--case", &case, "--force", "--out", &out];
        let done = rotor(&run).succeeds();
        done.out
    };
    let told = "zero because g = 0, so these invariants are not tested: ";
    let falling = run("[0.0, 0.0, -1.0]");
    assert!(!falling.contains(told), "{falling}");
    let free = run("[0.0, 0.0, 0.0]");
    let line = free.lines().find_map(|line| line.strip_prefix(told));
    let line = line.unwrap_or_else(|| panic!("{free}"));
    assert!(line.contains("across_g"), "{line}");
    let row = free.lines().find(|l| l.starts_with("momentum_across_g"));
    assert!(
        row.is_some_and(|row| !row.contains("within bound")),
        "{free}"
    );
    let read = |name: &str| std::fs::read_to_string(format!("{out}/{name}")).expect("is written");
    assert!(read("invariants.svg").contains("zero with g = 0"));
    assert!(read("run.html").contains("<p>Zero because g = 0"));
    let json: serde_json::Value = serde_json::from_str(&read("run.json")).expect("JSON");
    let all = json["results"]["invariants"].as_array().expect("a list");
    let own = all.iter().find(|own| own["name"] == "momentum_across_g");
    assert_eq!(own.expect("is listed")["zero_by"][0], "g");
}

#[test]
fn what_is_no_number_stops_the_run_at_its_node() {
    let folder = Folder::new("no_number");
    // The square of this momentum is infinite, but the step is short enough to succeed.
    let text = rotor("case harmonic-rotor").out;
    let large = text
        .replace(", 1.5]", ", 1e200]")
        .replace("h = 0.05", "h = 1e-300");
    let file = folder.write("large.toml", &large);
    let out = folder.path("out");
    let run = [
        "run",
        "harmonic-rotor",
        "--case",
        &file,
        "--steps",
        "5",
        "--out",
        &out,
    ];
    let done = rotor(&run).exits(1);
    let words = "clebsch: at node 0 (time 0) the invariant `energy` is inf: ";
    assert!(done.err.starts_with(words), "{}", done.err);
    assert_eq!(folder.names(), ["large.toml"]);
}

/// An inextensible rod, at rest and falling freely: it does not rotate, and the equations of its frames contain only
/// rounding errors, which solving for all velocities together cannot reduce further.
#[test]
fn a_held_rod_at_rest_falls() {
    let folder = Folder::new("held-rod-at-rest");
    folder.write(
        "rod.clebsch",
        "model InextensibleRod {
            label i in 0..N step s; param m: Real at nodes; param I0: Sym<3> at segments; param C0: Sym<3>; param g: Vec<3>;
            field phi: Vec<3> at nodes; group Λ: SO<3> at segments velocity Ω; constraint next(Λ) = Λ*Ω;
            hold n: next(phi, i) - phi = s*Λ*E3;
            lagrangian = m*dot(next(phi) - phi, next(phi) - phi)/(2*h) + h*m*dot(g, phi) - s*tr(I0*Ω)/h
                       + (h/s)*tr(C0*Λ^T*next(Λ, i));
        }",
    );
    let sample = folder.rotor("case @rod.clebsch").succeeds();
    let short = sample.out.replace("i = 8", "i = 2");
    folder.write("case.toml", &short);
    folder
        .rotor("run @rod.clebsch --case @case.toml --steps 20")
        .succeeds();
}

/// A ring at rest in a plane: the forces of neighbours balance the force of a constraint on a sum. The scale of the
/// rounded momenta comes from these forces, both for loops over sites and for single bodies.
#[test]
fn totals_of_a_line_at_rest_are_measured_by_the_impulses_that_cancel() {
    let folder = Folder::new("line-at-rest");
    for n in [4, 40] {
        let model = format!(
            "model Still {{
                label i in 0..N;
                periodic;
                param m, k: Real;
                field q: Vec<2> at nodes;
                hold p: sum(dot(q, q)) = {n};
                let r = next(q, i) - q;
                lagrangian = m*dot(next(q) - q, next(q) - q)/(2*h) - (h/2)*k*dot(r, r);
            }}"
        );
        let model = folder.write("still.clebsch", &model);
        let case = format!(
            "model = \"still\"\nh = 0.01\nsteps = 200\n[labels]\ni = {n}\n[ends]\ni = \"periodic\"\n\
             [parameters]\nm = 1.0\nk = 3.0\n[initial]\nq = [\"cos(2*pi*i/N)\", \"sin(2*pi*i/N)\"]\n\
             momentum_q = [0.0, 0.0]\n"
        );
        let case = folder.write("still.toml", &case);
        let json = rotor(&format!("run {model} --case {case} --json"))
            .succeeds()
            .json();
        let all = json["results"]["invariants"].as_array().expect("a list");
        let angular = all.iter().find(|v| {
            let name = v["name"].as_str().unwrap_or("");
            name.contains("momentum_angular")
        });
        let scale = angular.expect("is conserved")["scale"].as_f64();
        // Each of n bodies receives h k |r| = 0.03 |r| from either neighbour, at the distance 1 from the origin.
        let link = 2.0 * (std::f64::consts::PI / f64::from(n)).sin();
        let least = f64::from(n) * 0.03 * link;
        assert!(
            scale.is_some_and(|s| s > 0.5 * least),
            "{n}: {scale:?} of {least}"
        );
    }
}

/// Two masses on rods without weight.
const ON_RODS: &str = "model Pair { param m, L: Real; field x: Vec<3>; field y: Vec<3>; hold λ: dot(x, x) = L^2; \
    hold κ: dot(y - x, y - x) = L^2; lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h); }";

/// A case of it: a direction of both rods, and a momentum of the outer mass.
fn on_rods([x, y, z]: [f64; 3], momentum: &str) -> String {
    let length = (x * x + y * y + z * z).sqrt();
    format!(
        "model = \"pair\"\nh = 0.01\nsteps = 200\n[parameters]\nm = 1.3\nL = {length:?}\n[initial]\nx = [{x}, {y}, {z}]\n\
         y = [{}, {}, {}]\nmomentum_x = [0, 0, 0]\nmomentum_y = {momentum}\n",
        2.0 * x,
        2.0 * y,
        2.0 * z
    )
}

/// Corrections of the rounding of a constraint do not measure an angular momentum; a small momentum of the body does.
#[test]
fn bodies_that_constraints_hold_at_rest_exceed_no_bound() {
    let folder = Folder::new("rest-on-rods");
    let model = folder.write("pair.clebsch", ON_RODS);
    let run = |direction: [f64; 3], momentum: &str| {
        let case = folder.write("pair.toml", on_rods(direction, momentum));
        clebsch(&format!("run {model} --case {case} --stability-limit 0"))
    };
    for k in 1..12 {
        let k = f64::from(k);
        let done = run([0.3 * k, 0.7 - 0.1 * k, 0.11 * k * k], "[0, 0, 0]");
        assert_eq!(done.code, 0, "{k}: {}\n{}", done.err, done.out);
    }
    let scale = |done: &str| {
        let row = done
            .lines()
            .find(|line| line.starts_with("total_momentum_angular"));
        let mut cells = row.expect("a row").split_whitespace().skip(1);
        cells
            .next()
            .and_then(|cell| cell.parse::<f64>().ok())
            .expect("a scale")
    };
    // m |x| |v| with |v| about 1e-7, not the fraction of m |x|²/h that is used at rest.
    let slow = run([0.6, 0.0, 0.8], "[0, 1.3e-7, 0]");
    assert!((1e-8..1e-6).contains(&scale(&slow.out)), "{}", slow.out);
}
