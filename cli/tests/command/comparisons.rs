//! `clebsch compare`: its output, its files, and its answers to wrong requests and to models without other methods.
//! Takes the shipped gallery and the rotor of these tests.

use crate::common::{Folder, clebsch, rotor, runs, table};
use clebsch_cli::gallery::Gallery;

/// The method of this name in a comparison.
fn method<'a>(object: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    let methods = object["methods"].as_array().expect("methods");
    let found = methods.iter().find(|method| method["name"] == name);
    found.unwrap_or_else(|| panic!("no {name} in {object}"))
}

#[test]
fn every_model_has_a_row_for_itself_and_for_its_reference() {
    for entry in Gallery::shipped().entries {
        let model = entry.card.kebab;
        let done = runs(&format!("compare {model} --steps 40 --json"));
        let object = done.says_nothing().json();
        assert_eq!(object["model"], model);
        let methods = object["methods"].as_array().expect("methods");
        assert_eq!(
            methods.first().expect("one")["role"],
            "generated",
            "{model}"
        );
        assert_eq!(methods.last().expect("one")["role"], "reference", "{model}");
        assert!(
            methods.iter().all(|method| method["stopped"].is_null()),
            "{model}: {object}"
        );
    }
}

/// Long, since every case of the gallery is compared twice with references of thirteen digits.
/// The scheme is of second order against independent references. This verifies the hand-written equations
/// against the model, for every model that has some.
#[test]
fn generated_steppers_tend_to_the_hand_written_equations() {
    for entry in Gallery::shipped().entries {
        let model = entry.card.kebab;
        for case in &entry.cases {
            let errors = [0.02, 0.01].map(|h: f64| {
                let (case, steps) = (&case.name, (2.0 / h).round());
                let done = runs(&format!(
                    "compare {model} --case {case} --h {h} --steps {steps} --json"
                ));
                let fields = done.says_nothing().json()["methods"][0]["error"].clone();
                let fields = fields.as_object().expect("fields").values();
                fields
                    .map(|field| field["worst"].as_f64().expect("a number"))
                    .fold(0.0, clebsch::scalar::larger)
            });
            // The velocity tends to the rotation in the left factor, not to the identity: there is no limit.
            if (model, case.name.as_str()) == ("body-n", "turned") {
                continue;
            }
            // Steady motions are exact but for rounding; else the error falls by 2^order. The next term of
            // the expansion, some h^2 of the first one, and rounding change the exponent by less than 0.1.
            // A step that has not been shown to be reversible may still be of order two.
            let order = (errors[0] / errors[1]).log2();
            let expected = f64::from(entry.card.order);
            let exact = errors[1] < 1e-11;
            assert!(
                exact
                    || (order - expected).abs() < 0.1
                    || (!entry.card.reversible && order > expected),
                "{model} {}: order {order}, errors {errors:?}",
                case.name
            );
        }
    }
}

/// The worst errors of a method, one for each observable.
fn errors(object: &serde_json::Value, name: &str) -> Vec<f64> {
    let fields = method(object, name)["error"].as_object().expect("fields");
    let worst = fields.values().map(|field| field["worst"].as_f64());
    worst.map(|error| error.expect("a number")).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    differences.fold(0.0, clebsch::scalar::larger)
}

/// Long, since every case of the gallery is compared with all its methods. The hand-written stepper implements the
/// generated scheme, so both have the same errors up to the rounding of 200 steps. Errors of the scheme exceed 1e-6,
/// and other schemes of second order have different errors.
#[test]
fn steppers_by_hand_have_the_errors_of_the_generated_ones() {
    let compared = |model: &str, case: &str| {
        let done = runs(&format!("compare {model} --case {case} --steps 200 --json"));
        done.says_nothing().json()
    };
    let mut models = Vec::new();
    for entry in Gallery::shipped().entries {
        let model = entry.card.kebab;
        for case in &entry.cases {
            let object = compared(model, &case.name);
            let methods = object["methods"].as_array().expect("methods");
            // There is no hand-written stepper if a factor is not symmetric.
            let by_hand = methods.iter().find(|method| method["name"] == "by-hand");
            if by_hand.is_some_and(|method| method["stopped"].is_null()) {
                let off = apart(&errors(&object, "generated"), &errors(&object, "by-hand"));
                assert!(off < 1e-11, "{model} {}: {off:e}", case.name);
                models.push(model);
            }
        }
    }
    for model in ["cayley-klein", "cayley-klein-spatial", "kirchhoff-body"] {
        assert!(models.contains(&model), "{model}");
    }
    // Another member of the family, and another method.
    let one = compared("cayley-klein", "figure-2-9");
    let other = compared("cayley-klein", "figure-2-9-thesis");
    assert!(apart(&errors(&one, "generated"), &errors(&other, "by-hand")) > 1e-3);
    let one = compared("free-body", "figure-2-6");
    assert!(apart(&errors(&one, "generated"), &errors(&one, "splitting")) > 1e-4);
}

#[test]
fn the_free_body_is_compared_with_everything() {
    let object = runs("compare free-body --case figure-2-6 --json").json();
    let worst = |name: &str, kind: &str, of: &str| {
        method(&object, name)[kind][of]["worst"]
            .as_f64()
            .expect("a number")
    };
    // The reference, which another method confirms to the rounding of a thousand steps.
    assert!(worst("verner-98-finer", "error", "body_momentum") < 1e-13);
    // One scheme with four solvers: they differ by rounding, and their common error is much larger.
    let error = worst("generated", "error", "body_momentum");
    assert!(error > 1e-3);
    for name in ["by-hand", "fixed-point", "newton"] {
        let other = worst(name, "error", "body_momentum");
        assert!((other - error).abs() < 1e-12, "{name}");
    }
    // The scheme keeps the energy to rounding; splitting and Runge-Kutta with a loose tolerance do not.
    assert!(worst("generated", "drift", "energy") < 1e-14);
    assert!(worst("splitting", "drift", "energy") > 1e-6);
    assert!(worst("dormand-prince-54", "drift", "energy") > 1e-12);
}

#[test]
fn a_model_without_other_methods_is_compared_with_itself() {
    let done = rotor("compare harmonic-rotor --steps 50");
    done.ended(0).says_nothing();
    done.prints([
        "reference extrapolated: this model has no hand-written equations",
        "It tests the accuracy of the step, not the equations",
        "\ngenerated ",
        "\nextrapolated ",
    ]);
}

#[test]
fn files_are_the_same_but_for_times() {
    let folder = Folder::new("compare");
    let read = |name: &str| {
        let request = format!("compare heavy-top --steps 100 --out @{name}");
        folder
            .runs(&request)
            .prints("comparison.csv, comparison.json, comparison.svg");
        folder
            .clebsch(&request)
            .refuses("this exists; replace it with --force");
        ["comparison.csv", "comparison.svg"].map(|file| folder.bytes(&format!("{name}/{file}")))
    };
    assert!(read("one") == read("two"));
    let csv = folder.read("one/comparison.csv");
    let head = csv.lines().next().expect("a line");
    assert!(
        head.starts_with("method,time,error_Lambda,error_body_momentum,drift_energy"),
        "{head}"
    );
    assert_eq!(
        csv.lines()
            .filter(|line| line.starts_with("by-hand,"))
            .count(),
        100
    );
}

#[test]
fn wrong_requests_are_usage_errors() {
    for [request, words] in table("
        compare heavy-topp               | did you mean `heavy-top`?
        compare heavy-top --case lagrang | did you mean `lagrange`?
        compare heavy-top --h -1         | give a positive step size; to run backwards in time, reverse all initial momenta
        compare heavy-top --force        | --out
") {
        clebsch(request).prints_nothing().refuses(words);
    }
    // A step beyond the bound of solvability is a failure, not wrong usage.
    let done = clebsch("compare free-body --h 5 --json").exits(1);
    assert_eq!(done.json()["exit_code"], 1);
}
