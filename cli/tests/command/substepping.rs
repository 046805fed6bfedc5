//! `--halve`: failed steps are subdivided, and the result reports this.

use crate::common::{Folder, clebsch, runs};

#[test]
fn a_run_with_steps_made_by_parts_says_that_it_is_not_symplectic() {
    let long = ["run", "free-body", "--h", "5", "--steps", "20"];
    clebsch(&long).fails("cannot take the first step");
    let halved = runs(&[&long[..], &["--halve"]].concat());
    halved.prints([
        "subdivided steps: 20 steps of 20",
        "this run is not symplectic",
    ]);
    let object = clebsch(&[&long[..], &["--halve", "--json"]].concat()).json();
    let made = &object["results"]["made_by_parts"];
    assert_eq!(
        (&made["steps"], &made["symplectic"]),
        (&20.into(), &false.into())
    );
    assert_eq!(object["arguments"]["halve"], true);
    // If every step succeeds, there is no note.
    clebsch("run free-body --steps 20 --halve").never_prints("subdivided");
}

/// A weak barrier at det = 0 that is reached at speed: half the step succeeds, the full step does not.
#[test]
fn a_step_that_no_parts_make_says_that_they_were_tried() {
    let folder = Folder::new("no-parts");
    folder.write(
        "soft.clebsch",
        "model Soft {
            param J: Sym<2>;
            param a, b: Real;
            field Q: Mat<2>;
            lagrangian = tr((next(Q) - Q)*J*(next(Q) - Q)^T)/(2*h) - h*(a*tr(Q^T*Q)/2 - b*log(det(Q)));
        }",
    );
    folder.write(
        "fall.toml",
        "model = \"soft\"\nh = 0.05\nsteps = 100\n\n[parameters]\nJ = [[1.0, 0.0], [0.0, 1.0]]\na = 1.0\nb = 1e-3\n\n\
         [initial]\nQ = [[1.0, 0.0], [0.0, 1.0]]\nmomentum = [[-30.0, 0.0], [0.0, 0.0]]\n",
    );
    let done = folder
        .clebsch("run @soft.clebsch --case @fall.toml --halve")
        .exits(1);
    let tried = "--halve tried 2, 4, ... up to 65536 substeps";
    done.says(tried);
}
