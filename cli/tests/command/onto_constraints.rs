//! Starts with typed digits. If they satisfy their constraints to ten digits, they are moved onto them, with a note;
//! the check of the action as stated then succeeds. Other starts are rejected, and the message contains the distance.

use crate::common::Folder;
use crate::text_runs::run;

const PENDULUM: &str = "model Pendulum {
    param m, L, g: Real;
    field x: Vec<3>;
    hold λ: dot(x, x) = L^2;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[3];
}";

fn pendulum(x: &str) -> crate::common::Done {
    let case = format!(
        "model = \"pendulum\"\nh = 0.01\nsteps = 50\n[parameters]\nm = 2\nL = 1\ng = 9.81\n[initial]\nx = {x}\nmomentum = [0, 1, 0]\n"
    );
    run(&Folder::new("onto-pendulum"), PENDULUM, &case, "")
}

#[test]
fn a_start_of_ten_to_twelve_digits_is_moved_onto_its_constraint() {
    for (x, off) in [
        ("[0.1411200081, 0, -0.9899924966]", "1.0e-11"),
        ("[0.14112000806, 0, -0.98999249660]", "8.4e-13"),
        ("[0.6000000001, 0, -0.8]", "1.2e-10"),
    ] {
        pendulum(x)
            .succeeds()
            .prints("the initial configuration was moved onto its constraints, by at most ")
            .prints(format!("`λ` was violated by {off}"));
    }
}

#[test]
fn a_start_on_its_constraint_stays_and_one_that_is_far_off_is_rejected() {
    let done = pendulum("[0.6, 0, -0.8]").succeeds();
    done.never_prints("moved onto");
    pendulum("[0.6001, 0, -0.8]").refuses("1.2001");
}

/// The model measures a residual by all terms and their changes, here by three times the position. Every start that
/// it accepts is moved, so that the check of the action holds.
#[test]
fn a_start_that_the_model_accepts_is_moved() {
    let rail = "model Rail {
        param m, g, w: Real;
        field x: Vec<2>;
        hold λ: x[1] = w;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[2];
    }";
    let run = |off: &str| {
        let case = format!(
            "model = \"rail\"\nh = 0.01\nsteps = 20\n[parameters]\nm = 1\ng = 1\nw = 1\n[initial]\nx = [\"1 + {off}\", 0]\n"
        );
        run(&Folder::new("onto-rail"), rail, &case, "")
    };
    for off in ["5e-10", "9.5e-10", "1.2e-9", "2.9e-9"] {
        run(off).succeeds().prints(format!(
            "`λ` was violated by {:.1e}",
            off.parse::<f64>().unwrap()
        ));
    }
    run("1e-7").refuses("its sides differ by 1.0");
}

/// The links of a chain are corrected together, and bodies are rotated onto their constraints.
#[test]
fn chains_and_bodies_are_moved_too() {
    let chain = "model Chain {
        label i in 0..N;
        param m: Real at nodes;
        param L, g: Real;
        field x: Vec<2> at nodes;
        hold λ: dot(next(x,i) - x, next(x,i) - x) = L^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[2];
    }";
    for count in [5, 60] {
        // Corners of a polygon to ten digits.
        let places: Vec<String> = (0..=count)
            .map(|i| {
                let (s, c) = (0.7_f64 + 0.05 * f64::from(i)).sin_cos();
                format!("[{c:.10}, {s:.10}]")
            })
            .collect();
        let case = format!(
            "model = \"chain\"\nh = 0.01\nsteps = 5\n[labels]\ni = {count}\n[parameters]\nm = 1\nL = \"2*sin(0.025)\"\ng = 1\n\
             [initial]\nx = [{}]\n",
            places.join(", ")
        );
        run(&Folder::new("onto-chain"), chain, &case, "")
            .succeeds()
            .prints("moved onto its constraints");
    }
    let body = "model Hinge {
        param J: Sym<3>;
        param k: Real;
        group R: SO<3> velocity W;
        constraint next(R) = R*W;
        hold λ: dot(R*E3, E1) = 0;
        lagrangian = -tr(J*W)/h - h*k*dot(R*E3, E3);
    }";
    let case = "model = \"hinge\"\nh = 0.01\nsteps = 20\n[parameters]\nJ = { I = [2, 3, 4] }\nk = 1\n[initial]\n\
                R = { axis = [1, 1e-11, 0], angle = 0.4 }\n";
    run(&Folder::new("onto-body"), body, case, "")
        .succeeds()
        .prints("moved onto its constraints");
}
