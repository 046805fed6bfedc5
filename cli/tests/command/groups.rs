//! Models of plane motions, frames and deformable bodies, run from their texts: their output, and what clebsch rejects.

use crate::common::{Folder, runs};

/// A motion of the plane, stated in space, runs and satisfies the action as stated.
#[test]
fn a_motion_of_the_plane_seen_from_space_is_judged() {
    let folder = Folder::new("plane-from-space");
    folder.write(
        "plate.clebsch",
        "model Plate {
            param Q: Sym<3>;
            group G: SE<2> velocity V;
            constraint next(G) = V*G;
            lagrangian = tr((next(G) - G)*Q*(next(G) - G)^T)/(2*h);
        }",
    );
    let case = folder.clebsch("case @plate.clebsch");
    let case = folder.write("plate.toml", &case.out);
    folder
        .runs(&format!("run @plate.clebsch --case {case} --steps 50"))
        .never_prints("NaN")
        .prints("50 steps checked");
}

/// Advected quantities at sites may have different shapes even if their names differ only by a number.
#[test]
fn what_a_clamped_rod_of_frames_carries_is_written() {
    let folder = Folder::new("frames-written");
    folder.write(
        "rod.clebsch",
        "model Rod {
            label i in 0..N step s;
            param J, K: Sym<3>;
            param m: Real;
            group P: SE<3> at nodes velocity V;
            constraint next(P) = P*V;
            let y = pos(next(P)) - pos(P);
            let F = pos(P^-1*next(P, i))/s - E3;
            lagrangian = -s*tr(J*rot(V))/h + s*m*dot(y, y)/(2*h) - (h*s/2)*dot(F, K*F);
            end i = 0 { free; clamped { P = given; } }
        }",
    );
    let case = folder.clebsch("case @rod.clebsch").out;
    let lines: Vec<String> = case
        .lines()
        .map(|line| match line {
            l if l.starts_with("i = [") || l.starts_with("i = \"") => {
                "i = [\"clamped\", \"free\"]".to_owned()
            }
            l if l.starts_with("i = ") => "i = 3".to_owned(),
            l => l.to_owned(),
        })
        .collect();
    let case = folder.write("rod.toml", lines.join("\n"));
    folder.runs(&format!(
        "run @rod.clebsch --case {case} --steps 10 --out @out"
    ));
    let held = folder.bytes("out/trajectory.npz");
    assert!(!held.is_empty());
}

/// If the force beyond det = 0 is not a number, the message still gives the cause.
#[test]
fn a_step_through_a_singular_matrix_says_so_where_the_force_there_is_no_number() {
    let folder = Folder::new("through-singular");
    folder.write(
        "soft.clebsch",
        "model Soft {
            param a: Real;
            field Q: Mat<2>;
            lagrangian = tr((next(Q) - Q)*(next(Q) - Q)^T)/(2*h) - h*a*log(det(Q))^2;
        }",
    );
    let case = "model = \"soft\"\nh = 0.05\nsteps = 10\n\n[parameters]\na = 0.1\n\n[initial]\n\
                Q = [[1.0, 0.0], [0.0, 1.0]]\nmomentum = [[0.0, 0.0], [0.0, -60.0]]\n";
    let case = folder.write("soft.toml", case);
    let done = folder
        .clebsch(&format!("run @soft.clebsch --case {case}"))
        .exits(1);
    done.says(["its determinant reaches 0", "from this state succeeds"]);
}

/// `det(Q^T*C*Q)` is `det(C)` times a square. A step that moves `Q` through a singular matrix fails, even
/// though the argument of the logarithm is positive at both ends.
#[test]
fn a_body_is_not_turned_inside_out_by_a_step() {
    let folder = Folder::new("inside-out");
    folder.write(
        "soft.clebsch",
        "model Soft {
            param J, C: Sym<2>;
            param a, b: Real;
            field Q: Mat<2>;
            lagrangian = tr((next(Q) - Q)*J*(next(Q) - Q)^T)/(2*h)
                - h*(a*tr(Q^T*C*Q)/2 - b*log(det(Q^T*C*Q)));
        }",
    );
    let case = "model = \"soft\"\nname = \"fall\"\nh = 0.05\nsteps = 100\n\n[parameters]\n\
        J = [[1.0, 0.1], [0.1, 0.8]]\nC = [[1.0, 0.2], [0.2, 0.9]]\na = 1.0\nb = 0.001\n\n[initial]\n\
        Q = [[1.0, 0.1], [0.0, 0.9]]\nmomentum = [[-1.0, 0.3], [0.2, -1.0]]\n";
    let case = folder.write("soft.toml", case);
    let done = folder.clebsch(&format!("run @soft.clebsch --case {case}"));
    assert_ne!(done.code, 0, "{}", done.out);
    done.says("`Q` becomes singular");
}

/// The default solver works for every group of a model: besides a rotation of space with a factor known at each
/// node, there are groups without a 4 x 4 matrix.
#[test]
fn rotations_of_other_dimensions_run_beside_bodies_seen_from_space() {
    let folder = Folder::new("rotations-beside");
    let own = "group S: SO<2> velocity X;";
    let body = "group R: SO<3> velocity W;";
    for (name, [first, second], moved) in [
        ("plane-first", [own, body], "X*S"),
        ("plane-last", [body, own], "X*S"),
        ("plane-from-body", [own, body], "S*X"),
        ("four", ["group S: SO<4> velocity X;", body], "X*S"),
    ] {
        let model = folder.write(
            &format!("{name}.clebsch"),
            format!(
                "model A {{ param j: Real; param J: Sym<3>; {first} {second} constraint next(R) = W*R;
                 constraint next(S) = {moved}; lagrangian = -j*tr(X)/h - tr(J*R^T*next(R))/h; }}"
            ),
        );
        for solver in ["", "davenport", "kappa", "lie-newton", "sign"] {
            let mut arguments = vec!["run", &model, "--case", "sample", "--steps", "20"];
            if !solver.is_empty() {
                arguments.extend(["--solver", solver]);
            }
            runs(&arguments);
        }
    }
}
