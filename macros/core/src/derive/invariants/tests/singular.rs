//! Symmetries of potentials that are singular where bodies meet, or that contain square roots. In exact arithmetic
//! modulo a prime, half of all numbers have no square root.

use super::{Family, derive};

/// Names of the momenta that are found.
fn momenta(text: &str) -> Vec<String> {
    let d = derive(text);
    let own = d.invariants.iter().filter(|v| v.family == Family::Noether);
    own.map(|v| v.name.clone()).collect()
}

const TOTALS: [&str; 2] = ["total_momentum", "total_momentum_angular"];

/// Bodies with a potential for each pair.
fn bodies(names: &[&str], size: u8, pair: impl Fn(&str) -> String) -> String {
    let mut terms = Vec::new();
    for (i, a) in names.iter().enumerate() {
        terms.push(format!("m*dot(next({a}) - {a}, next({a}) - {a})/(2*h)"));
        for b in &names[..i] {
            terms.push(pair(&format!("dot({a} - {b}, {a} - {b})")));
        }
    }
    let (fields, action) = (names.join(", "), terms.join(" + "));
    format!(
        "model Bodies {{ param m, k, l: Real; field {fields}: Vec<{size}>; lagrangian = {action}; }}"
    )
}

#[test]
fn totals_of_bodies_that_attract_each_other() {
    let potentials: [&dyn Fn(&str) -> String; 4] = [
        &|r| format!("h*k/sqrt({r})"),
        &|r| format!("h*k*log({r})"),
        &|r| format!("h*k*(sqrt({r}) - l)^2"),
        &|r| format!("h*k*exp(-sqrt({r}))/sqrt({r})"),
    ];
    for potential in potentials {
        for names in [
            &["A", "B"][..],
            &["A", "B", "C"],
            &["A", "B", "C", "D", "E"],
        ] {
            for size in [2, 3] {
                assert_eq!(
                    momenta(&bodies(names, size, potential)),
                    TOTALS,
                    "{names:?} {size}"
                );
            }
        }
    }
}

#[test]
fn totals_of_more_bodies_than_are_counted() {
    // Eleven positions and momenta exceed the limit on unknowns for the search for all symmetries. The momenta that
    // are found directly are listed even then, and the total momentum does not hide the total angular momentum.
    let names: Vec<String> = (0..14).map(|i| format!("a{i}")).collect();
    for count in [10, 11, 14] {
        let masses = names[..count]
            .iter()
            .map(|a| format!("m*dot(next({a}) - {a}, next({a}) - {a})/(2*h)"));
        let springs = names[..count]
            .windows(2)
            .map(|pair| format!("(-h*k/2)*dot({1} - {0}, {1} - {0})", pair[0], pair[1]));
        let terms: Vec<String> = masses.chain(springs).collect();
        let (fields, action) = (names[..count].join(", "), terms.join(" + "));
        let text = format!(
            "model Chain {{ param m, k: Real; field {fields}: Vec<3>; lagrangian = {action}; }}"
        );
        assert_eq!(momenta(&text), TOTALS, "{count}");
    }
}

#[test]
fn a_pair_that_is_not_central_keeps_less() {
    let text = bodies(&["A", "B"], 3, |r| format!("h*k/sqrt({r} + dot(A, A))"));
    assert_eq!(momenta(&text), TOTALS[1..]);
    let text = bodies(&["A", "B"], 3, |r| format!("h*k/sqrt({r} + (A - B)[0]^2)"))
        .replace("(A - B)[0]", "dot(E1, A - B)");
    assert_eq!(
        momenta(&text),
        ["total_momentum", "total_momentum_angular_E1"]
    );
}

#[test]
fn moments_about_a_fixed_centre() {
    let about = |size: u8, term: &str| {
        let text = format!(
            "model Centre {{ param m, k: Real; param c: Vec<{size}>; field X, Y: Vec<{size}>; \
             lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) \
             + m*dot(next(Y) - Y, next(Y) - Y)/(2*h) + {term}; }}"
        );
        momenta(&text)
    };
    for size in [2, 3] {
        let both = about(
            size,
            "h*k/sqrt(dot(X - c, X - c)) - h*k*dot(Y - c, Y - c) - h*k*dot(X - Y, X - Y)^2",
        );
        assert_eq!(both, ["total_momentum_angular_about_c"]);
        // The other body is free.
        let one = about(size, "h*k/sqrt(dot(X - c, X - c))");
        assert_eq!(
            one,
            [
                "momentum_Y",
                "momentum_Y_angular",
                "momentum_X_angular_about_c"
            ]
        );
    }
}
