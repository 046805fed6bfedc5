//! Messages about faults of options and cases. Each names the place of the fault, and says what to write.

use crate::common::Folder;
use crate::text_runs::run;

const POINT: &str = "model Point {
    param m: Real;
    field y: Real;
    lagrangian = m*(next(y) - y)^2/(2*h);
}";

fn case(steps: &str) -> String {
    format!(
        "model = \"point\"\nh = 0.1\nsteps = {steps}\n[parameters]\nm = 1\n[initial]\ny = 1\nvelocity = 1\n"
    )
}

/// The case is right, so the message names the option.
#[test]
fn a_bracket_of_an_option_is_told_with_the_option() {
    let folder = Folder::new("faults-brackets");
    for (value, why) in [
        ("m=[1", "the bracket `[` in `[1` is not closed; add `]`"),
        ("y={1", "the bracket `{` in `{1` is not closed; add `}`"),
        ("m=1]", "this `]` in `1]` has no matching `[`"),
        ("y={a=1}}", "this `}` in `{a=1}}` has no matching `{`"),
        ("y=[1)", "`)` closes `[` in `[1)`; write `]`"),
    ] {
        let done = run(&folder, POINT, &case("1"), &format!("--set {value}"));
        let done = done.exits(2);
        done.says(format!("clebsch: --set {value}: {why}"));
        assert!(!done.err.contains("case.toml"), "{}", done.err);
    }
}

#[test]
fn the_largest_number_of_steps_is_told() {
    let folder = Folder::new("faults-steps");
    for steps in ["1e30", "99999999999999999999"] {
        run(&folder, POINT, &case(steps), "").exits(2).says(format!(
            "case.toml:3: steps: {steps} is too large; give at most 18446744073709551615"
        ));
    }
}

#[test]
fn numbers_whose_products_leave_the_range_of_doubles_are_named() {
    let folder = Folder::new("faults-range");
    for (set, said) in [
        (
            "m=1e-200 --set velocity=1e-150",
            "with `m` = 1e-200, terms of the momentum underflow",
        ),
        (
            "m=1e308",
            "with `m` = 1e308, terms of the momentum overflow",
        ),
        (
            "velocity=1e308",
            "with `velocity` = 1e308, terms of the momentum overflow",
        ),
    ] {
        run(&folder, POINT, &case("1"), &format!("--set {set}"))
            .exits(2)
            .says(said);
    }
}

#[test]
fn a_run_without_invariants_prints_no_table() {
    let model = "model Driven {
        param m: Real;
        field y: Real;
        lagrangian = m*(next(y) - y)^2/(2*h) + sin(h*next(y)*y)*y*cos(next(y));
    }";
    let folder = Folder::new("faults-table");
    let text = case("2")
        .replace("point", "driven")
        .replace("velocity", "momentum");
    let done = run(&folder, model, &text, "").exits(0);
    assert!(!done.out.contains("max drift"), "{}", done.out);
    done.prints("2 steps checked");
}

/// At the lowest point of a pendulum, all terms of the rate are rounding, or zero.
#[test]
fn a_velocity_whose_rate_is_rounding_is_tangent() {
    let model = "model Pendulum {
        param m, L, g: Real;
        field x: Vec<3>;
        hold λ: dot(x, x) = L^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[3];
    }";
    let folder = Folder::new("faults-tangent");
    let case = |velocity: &str| {
        format!(
            "model = \"pendulum\"\nh = 0.01\nsteps = 2\n[parameters]\nm = 2\nL = 1\ng = 9.81\n\
             [initial]\nx = [0, 0, -1]\nvelocity_x = {velocity}\n"
        )
    };
    run(&folder, model, &case("[0.4, 0.1, 1e-17]"), "").exits(0);
    let done = run(&folder, model, &case("[0.4, 0.1, 2e-7]"), "").exits(2);
    done.says("changes at the rate -4e-7. Give velocities");
}
