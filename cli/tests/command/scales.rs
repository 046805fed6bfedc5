//! The natural scale of an invariant: the sum of the absolute values of its terms, the largest along the run.
//! Rounding of the terms never exceeds a bound, for any initial terms.

use crate::common::{Folder, on, runs};
use clebsch_cli::gallery::Gallery;
use serde_json::Value;

clebsch::model! {
    /// A rigid body that can rotate and move freely.
    model FreeRigidBody {
        param J: Sym<3>;
        param m: Real;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h);
    }
}

fn json(gallery: &Gallery, arguments: &[&str]) -> (u8, Value) {
    let done = on(gallery, &[arguments, &["--json"]].concat());
    let json = serde_json::from_str(&done.out).unwrap_or_else(|e| panic!("{e}: {}", done.err));
    (done.code, json)
}

fn invariant<'a>(json: &'a Value, name: &str) -> &'a Value {
    let list = json["results"]["invariants"].as_array().expect("a list");
    let found = list.iter().find(|one| one["name"] == name);
    found.unwrap_or_else(|| panic!("no invariant {name}"))
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// Bodies that move a thousand lengths away: the angular momentum about the origin is a thousandth of each of its two
/// terms, and its rounding error is relative to them.
#[test]
fn an_angular_momentum_about_the_origin_has_the_scale_of_the_lever_arm_reached() {
    let name = "spatial_momentum_angular_Z";
    for case in ["ellipsoid", "screw", "floating"] {
        let steps = "100000";
        let run = [
            "run",
            "kirchhoff-body",
            "--case",
            case,
            "--h",
            "0.1",
            "--steps",
            steps,
        ];
        let folder = Folder::new(&format!("lever_{case}"));
        let out = folder.path("out");
        let (code, json) = json(&Gallery::shipped(), &[&run[..], &["--out", &out]].concat());
        assert_eq!(code, 0, "{case}: {}", invariant(&json, name));
        // The distance at the end, which is vertical, times the horizontal linear momentum.
        let samples = folder.samples("out/trajectory.csv");
        let at = |name: &str| samples.end(name);
        let length = |of: [&str; 3]| of.map(at).iter().map(|x| x * x).sum::<f64>().sqrt();
        let away = length(["G_14", "G_24", "G_34"]);
        let linear = length(["body_momentum_4", "body_momentum_5", "body_momentum_6"]);
        let scale = number(&invariant(&json, name)["scale"]);
        assert!(away > 1e3, "{case}: {away}");
        assert!(scale > away * linear, "{case}: {scale} < {away} * {linear}");
        // The other term has the size of the start, and the body is farthest at the end.
        assert!(scale < away * linear + 2.0, "{case}: {scale}");
    }
}

/// Far from the origin, only the angular part is less accurate.
#[test]
fn angular_and_linear_momentum_have_scales_of_their_own() {
    let card = FreeRigidBody::CARD;
    let far = 4096.0;
    let mut place = vec![0.0; 16];
    for i in 0..4 {
        place[5 * i] = 1.0;
    }
    place[3] = far;
    let inertia = vec![1.0, 0.0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 0.4];
    let momentum = vec![0.0, 0.3, 0.4, 3.0, 0.0, 4.0];
    let settings = clebsch::card::Settings::step(0.05);
    let opened = (card.open)(&[inertia, vec![2.0]], &[place, momentum], settings);
    let mut motion = opened.unwrap_or_else(|e| panic!("{e}"));
    let mut scales = vec![0.0; card.invariant_count()];
    let mut values = scales.clone();
    let mut start = scales.clone();
    motion.invariants(&mut start);
    motion.scales(&mut scales);
    let from: usize = card
        .invariants
        .iter()
        .take_while(|v| v.name != "spatial_momentum")
        .map(|v| v.rows)
        .sum();
    let of = |all: &[f64]| all[from..from + 6].to_vec();
    // |m| + |x| |p| and |p|: lengths of 3-4-5 triangles.
    let (angular, linear) = (0.5 + far * 5.0, 5.0);
    for (scale, wanted) in of(&scales)
        .iter()
        .zip([angular, angular, angular, linear, linear, linear])
    {
        assert!((scale - wanted).abs() < 1e-12 * wanted, "{scales:?}");
    }
    for _ in 0..200 {
        motion.step().unwrap_or_else(|e| panic!("{e}"));
    }
    motion.invariants(&mut values);
    for ((a, b), scale) in of(&values).iter().zip(of(&start)).zip(of(&scales)) {
        // A few roundings of an advected number.
        assert!((a - b).abs() <= 1e-14 * scale, "{values:?} {start:?}");
    }
}

/// A top released from rest with its axis horizontal has neither kinetic nor potential energy at first.
#[test]
fn the_energy_of_a_top_released_from_rest_has_the_scale_of_its_swing() {
    let mut gallery = Gallery::shipped();
    gallery.entries.retain(|e| e.card.kebab == "heavy-top");
    let entry = &mut gallery.entries[0];
    entry.cases.truncate(1);
    let case = &mut entry.cases[0];
    case.initial[0] = vec![0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
    case.initial[1] = vec![0.0; 3];
    let (code, json) = json(
        &gallery,
        &["run", "heavy-top", "--h", "0.01", "--steps", "2000"],
    );
    assert_eq!(code, 0, "{json}");
    let energy = invariant(&json, "energy");
    assert_eq!(energy["absolute"], false, "{energy}");
    // It falls by the length of its axis, from 0 to -1, and the kinetic energy is then 1.
    let scale = number(&energy["scale"]);
    assert!((scale - 2.0).abs() < 1e-3, "{energy}");
    // A relative drift of order h squared, with the scale of the largest amplitude, not of the first node.
    assert!(number(&energy["worst_drift"]) < 1e-4, "{energy}");
}

/// The sum of the absolute values of the terms is not less than the value, at any node of any shipped case.
#[test]
fn no_value_is_larger_than_its_scale() {
    let gallery = Gallery::shipped();
    let mut compared = 0;
    for entry in &gallery.entries {
        for case in &entry.cases {
            let card = entry.card_of(case);
            let settings = clebsch::card::Settings::step(case.h);
            let opened = (card.open)(&case.parameters, &case.initial, settings);
            let mut motion = opened.unwrap_or_else(|e| panic!("{}: {e}", case.name));
            let mut values = vec![0.0; card.invariant_count()];
            let mut scales = values.clone();
            for _ in 0..50 {
                motion
                    .step()
                    .unwrap_or_else(|e| panic!("{}: {e}", case.name));
                motion.invariants(&mut values);
                motion.scales(&mut scales);
                for (value, scale) in values.iter().zip(&scales) {
                    // Lengths are products of a few roots: their rounding is some 1e-15.
                    let enough = value.abs() <= scale * (1.0 + 1e-14);
                    assert!(
                        enough,
                        "{} {}: {values:?} {scales:?}",
                        card.kebab, case.name
                    );
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 1000, "{compared}");
}

/// A top that hangs in equilibrium in a general direction: its momentum is only the rounding error of the impulses of
/// its weight, and is not used as its own scale.
#[test]
fn a_top_at_equilibrium_is_within_its_bounds() {
    let mut gallery = Gallery::shipped();
    gallery.entries.retain(|e| e.card.kebab == "heavy-top");
    let entry = &mut gallery.entries[0];
    entry.cases.truncate(1);
    let case = &mut entry.cases[0];
    let (down, up) = (vec![0.36, 0.48, -0.8], vec![-0.36, -0.48, 0.8]);
    case.parameters[1..].clone_from_slice(&[down, up]);
    case.initial[0] = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    case.initial[1] = vec![0.0; 3];
    let (code, json) = json(
        &gallery,
        &["run", "heavy-top", "--h", "0.1", "--steps", "2000"],
    );
    assert_eq!(code, 0, "{json}");
    let vertical = invariant(&json, "momentum_Gamma");
    // The impulse of a step, h |m g chi|, along each axis.
    let scale = number(&vertical["scale"]);
    assert!(scale > 0.1 && scale < 0.2, "{vertical}");
}

/// Components of a total that vanish up to rounding are measured by the length of the whole total, with loops over
/// sites as well as body by body.
#[test]
fn a_total_is_measured_as_a_whole_along_a_line_of_any_length() {
    let folder = Folder::new("scale-of-a-total");
    let model = "model Ring { label i in 0..N; periodic; param c: Real; group q: SU<2> at nodes velocity W; \
        constraint next(q) = q*W; lagrangian = (2/h)*dot(im(W), im(W)) + 4*c*h*re(q^T*next(q, i)); }";
    let model = folder.write("ring.clebsch", model);
    for n in [32, 33] {
        let case = format!(
            "model = \"ring\"\nname = \"own\"\nh = 0.01\nsteps = 5\n[labels]\ni = {n}\n[ends]\ni = \"periodic\"\n\
             [parameters]\nc = 1.0\n[initial]\nq = [\"cos(2*pi*2*i/N)\", \"sin(2*pi*2*i/N)\", 0.0, 0.0]\n\
             body_momentum_q = [0.1, 0.0, 0.2]\n"
        );
        let case = folder.write("own.toml", &case);
        let object = runs(&format!("run {model} --case {case} --json")).json();
        let all = object["results"]["invariants"].as_array().expect("a list");
        let total = all.iter().find(|own| own["name"] == "total_body_momentum");
        let scale = total
            .and_then(|own| own["scale"].as_f64())
            .expect("a number");
        let wanted = f64::from(n) * 0.05_f64.sqrt();
        assert!(
            (scale / wanted - 1.0).abs() < 1e-14,
            "{n}: {scale} {wanted}"
        );
    }
}
