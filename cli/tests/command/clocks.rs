//! Clocks of models that are driven in time: they tell the time after many steps as well.

use crate::common::{Folder, clebsch};

/// Kept in one number a clock loses a part of its own rounding at every step, which adds up: 1e-10 here.
#[test]
fn a_clock_tells_the_time_after_many_steps() {
    let folder = Folder::new("clock");
    let model = folder.write(
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
    let case = clebsch(&["case", &model]).out;
    let case: Vec<&str> = case
        .lines()
        .map(|line| match line {
            l if l.starts_with("t = ") => "t = 0.0",
            l if l.starts_with("phase = ") => "phase = [0.0, 0.0]",
            l => l,
        })
        .collect();
    let case = folder.write("driven.toml", &case.join("\n"));
    let out = folder.path("out");
    let done = clebsch(&[
        "run", &model, "--case", &case, "--h", "0.01", "--steps", "20000", "--every", "2000",
        "--out", &out,
    ]);
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    let table = std::fs::read_to_string(folder.path("out/trajectory.csv")).expect("written");
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let column = |name: &str| head.iter().position(|x| *x == name).expect(name);
    let (time, clocks) = (column("time"), ["t", "phase_1"].map(column));
    let mut last = 0.0;
    for line in lines {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|x| x.parse().expect("a number"))
            .collect();
        last = numbers[time];
        for clock in clocks {
            // Two roundings of 200.
            let off = (numbers[clock] - numbers[time]).abs();
            assert!(off < 6e-14, "{off:e} at {last}");
        }
    }
    assert_eq!(last, 200.0);
}
