//! Clocks of driven models remain exact after many steps.

use crate::common::Folder;

/// A number that is advected by a rule other than the motion is checked against that rule. All of these steps satisfy
/// their rule.
#[test]
fn numbers_carried_by_any_rule_are_judged_by_it() {
    let folder = Folder::new("clocks-rules");
    let case = "model = \"carried\"\nh = 0.05\nsteps = 5\n[parameters]\nm = 1.3\nk = 2.0\n[initial]\nt = 1.0\nx = -0.12\nmomentum = -0.55\n";
    let case = folder.write("case.toml", case);
    for rule in [
        "t + h",
        "t + 1",
        "2*t",
        "-t",
        "h - t",
        "sin(t) + h",
        "h",
        "3",
        "m",
        "t^2/2",
        "t*(1 - h)",
    ] {
        let text = format!(
            "model Carried {{ param m, k: Real; field x: Real; advected t: Real; constraint next(t) = {rule};
             lagrangian = m*(next(x) - x)^2/(2*h) - h*k*cos(t)*x^2; }}"
        );
        folder.write("carried.clebsch", &text);
        folder
            .runs(&format!("run @carried.clebsch --case {case} --check all"))
            .prints("5 steps checked");
    }
}

/// If a clock is stored in one number, its rounding errors accumulate: 1e-10 here.
#[test]
fn a_clock_tells_the_time_after_many_steps() {
    let folder = Folder::new("clock");
    folder.write(
        "driven.clebsch",
        "model Driven {
            param m, k, A, w: Real;
            field q: Real;
            advected t: Real;
            advected phase: Vec<2>;
            constraint next(t) = t + h;
            constraint next(phase) = phase + h*E1;
            lagrangian = m*(next(q) - q)^2/(2*h) - h*k*q^2/2 + h*A*q*cos(w*t) + h*A*q*sin(phase[1]);
        }",
    );
    let case = folder.clebsch("case @driven.clebsch").out;
    let case: Vec<&str> = case
        .lines()
        .map(|line| match line {
            l if l.starts_with("t = ") => "t = 0.0",
            l if l.starts_with("phase = ") => "phase = [0.0, 0.0]",
            l => l,
        })
        .collect();
    let case = folder.write("driven.toml", case.join("\n"));
    folder.runs(&format!(
        "run @driven.clebsch --case {case} --h 0.01 --steps 20000 --every 2000 --out @out"
    ));
    let samples = folder.samples("out/trajectory.csv");
    for row in 0..samples.rows.len() {
        let time = samples.at("time", row);
        for clock in ["t", "phase_1"] {
            // Two roundings of 200.
            let off = (samples.at(clock, row) - time).abs();
            assert!(off < 6e-14, "{off:e} at {time}");
        }
    }
    assert_eq!(samples.end("time"), 200.0);
}

/// A bead on a spring attached to a prescribed bead, initially at rest and driven by `F sin(ω t)`.
#[test]
fn a_clock_goes_on_where_an_end_prescribes_a_value() {
    let folder = Folder::new("driven-bead");
    folder.write(
        "driven.clebsch",
        "model Driven {
            label i in 0..N;
            param m, k, F, w: Real;
            field q: Real at nodes;
            advected t: Real at nodes;
            constraint next(t) = t + h;
            lagrangian = m*(next(q) - q)^2/(2*h) - h*k*(next(q, i) - q)^2/2 + h*F*sin(w*t)*q;
            end i = 0 { free; pinned { q = given; } }
        }",
    );
    folder.write(
        "driven.toml",
        "model = \"driven\"\nname = \"d\"\ndoc = \"d\"\nh = 0.01\nsteps = 1000\n[labels]\ni = 1\n\
         [ends]\ni = [\"pinned\", \"free\"]\n[parameters]\nm = 1.0\nk = 1.0\nF = 1.0\nw = 0.5\n\
         [initial]\nq = 0.0\nmomentum_q = 0.0\nt = 0.0\n",
    );
    folder.runs("run @driven.clebsch --case @driven.toml --out @out");
    let found = folder.samples("out/trajectory.csv").end("q_1");
    let (w, t) = (0.5_f64, 10.0_f64);
    let wanted = ((w * t).sin() - w * t.sin()) / (1.0 - w * w);
    // The step is of second order, and h² is 1e-4.
    assert!((found - wanted).abs() < 1e-4, "{found} for {wanted}");
}
