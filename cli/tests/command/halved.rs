//! `--halve`: steps that are refused are made by parts, and the result says so.

use crate::common::{Folder, program as clebsch};

#[test]
fn a_run_with_steps_made_by_parts_says_that_it_is_not_symplectic() {
    let long = ["run", "free-body", "--h", "5", "--steps", "20"];
    let refused = clebsch(&long);
    assert_eq!(refused.code, 1, "{}{}", refused.out, refused.err);
    assert!(
        refused.err.contains("cannot take the first step"),
        "{}",
        refused.err
    );
    let halved = clebsch(&[&long[..], &["--halve"]].concat());
    assert_eq!(halved.code, 0, "{}{}", halved.out, halved.err);
    for wanted in [
        "made by parts: 20 steps of 20",
        "this run is not symplectic",
    ] {
        assert!(halved.out.contains(wanted), "{}", halved.out);
    }
    let json = clebsch(&[&long[..], &["--halve", "--json"]].concat());
    let object: serde_json::Value = json.out.parse().expect("is JSON");
    let made = &object["results"]["made_by_parts"];
    assert_eq!(
        (&made["steps"], &made["symplectic"]),
        (&20.into(), &false.into())
    );
    assert_eq!(object["arguments"]["halve"], true);
    // Where every step can be made nothing is said.
    let short = clebsch(&["run", "free-body", "--steps", "20", "--halve"]);
    assert!(!short.out.contains("made by parts"), "{}", short.out);
}

/// A weak wall at det = 0, met at speed: half the step can be made, the whole way to the node of the step cannot.
#[test]
fn a_step_that_no_parts_make_says_that_they_were_tried() {
    let folder = Folder::new("no-parts");
    let model = folder.write(
        "soft.clebsch",
        "model Soft {
            param J: Sym<2>;
            param a, b: Real;
            field Q: Mat<2>;
            lagrangian = tr((next(Q) - Q)*J*(next(Q) - Q)^T)/(2*h) - h*(a*tr(Q^T*Q)/2 - b*log(det(Q)));
        }",
    );
    let case = folder.write(
        "fall.toml",
        "model = \"soft\"\nh = 0.05\nsteps = 100\n\n[parameters]\nJ = [[1.0, 0.0], [0.0, 1.0]]\na = 1.0\nb = 1e-3\n\n\
         [initial]\nQ = [[1.0, 0.0], [0.0, 1.0]]\nmomentum = [[-30.0, 0.0], [0.0, 0.0]]\n",
    );
    let done = clebsch(&["run", &model, "--case", &case, "--halve"]);
    assert_eq!(done.code, 1, "{}{}", done.out, done.err);
    let tried = "--halve has tried it by 2, 4, ... to 65536 steps of a part of its length";
    assert!(done.err.contains(tried), "{}", done.err);
}
