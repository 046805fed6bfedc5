//! `--halve`: steps that are refused are made by parts, and the result says so.

use crate::common::program as clebsch;

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
