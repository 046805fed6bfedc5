//! The growth of work with the size of models: many groups, many quantities, and expressions that expand. The tests
//! assert counts, which do not depend on the machine.

use super::{LARGEST, NODES, PRODUCTS, Work};
use crate::pipeline::derive_source;

/// Statements of `count` groups, and their kinetic energies as terms of the Lagrangian.
fn bodies(count: usize, group: &str, kinetic: &str) -> (String, String) {
    let numbered = |text: &str, i: usize| text.replace('#', &i.to_string());
    let statements = (0..count).map(|i| {
        numbered(
            &format!("group G#: {group} velocity W#; constraint next(G#) = G#*W#; "),
            i,
        )
    });
    let terms = (0..count).map(|i| numbered(kinetic, i));
    (statements.collect(), terms.collect())
}

fn free(count: usize) -> String {
    let (statements, kinetic) = bodies(count, "SO<3>", " - tr(J*W#)/h");
    format!("model M {{ param J: Sym<3>; {statements} lagrangian = 0{kinetic}; }}")
}

/// A chain of bodies, coupled by the relative rotations of neighbours.
fn chain(count: usize) -> String {
    let (statements, kinetic) = bodies(count, "SO<3>", " - tr(J*W#)/h");
    let neighbours = (1..count).map(|j| (j - 1, j));
    let rotations: String = neighbours
        .clone()
        .map(|(i, j)| {
            format!(
                "advected R{i}: SO<3> = G{i}^T*G{j}; constraint next(R{i}) = W{i}^T*R{i}*W{j}; "
            )
        })
        .collect();
    let springs: String = neighbours
        .map(|(i, _)| format!(" - h*dot(d, R{i}*d)"))
        .collect();
    format!(
        "model M {{ param J: Sym<3>; param d: Vec<3>; {statements} {rotations} lagrangian = 0{kinetic}{springs}; }}"
    )
}

/// Bodies in one field; each conserves its momentum about the same axis.
fn tops(count: usize) -> String {
    let (statements, kinetic) = bodies(count, "SO<3>", " - tr(J*W#)/h - h*dot(z, G#*g)");
    format!(
        "model M {{ param J: Sym<3>; param g, z: Vec<3>; {statements} lagrangian = 0{kinetic}; }}"
    )
}

fn carried(count: usize) -> String {
    let quantities: String = (0..count)
        .map(|i| format!("advected a{i}: Vec<3>; constraint next(a{i}) = W^T*a{i}; "))
        .collect();
    let potentials: String = (0..count).map(|i| format!(" - h*dot(a{i}, g)")).collect();
    format!(
        "model M {{ param J: Sym<3>; param g: Vec<3>; group G: SO<3> velocity W; \
         constraint next(G) = G*W; {quantities} lagrangian = -tr(J*W)/h{potentials}; }}"
    )
}

fn work(model: &str) -> Work {
    match derive_source(model) {
        Ok(d) => d.work,
        Err(e) => panic!("{e}\n{model}"),
    }
}

fn refusal(model: &str) -> String {
    match derive_source(model) {
        Ok(d) => panic!("derived with {:?}", d.work),
        Err(e) => e.to_string(),
    }
}

/// Doubling the model multiplies the work by at most this factor, which is less than the 8 of cubic growth. Every
/// group is compared with every other group, and the number of independent momenta grows with the number of groups.
const GROWTH: u64 = 6;

#[test]
fn work_grows_less_than_the_cube_of_what_is_declared() {
    type Family = (&'static str, fn(usize) -> String);
    let families: [Family; 4] = [
        ("free bodies", free),
        ("chain", chain),
        ("tops", tops),
        ("carried quantities", carried),
    ];
    for (name, family) in families {
        let (small, large) = (work(&family(10)), work(&family(20)));
        for (what, a, b) in [
            ("nodes", small.nodes, large.nodes),
            ("terms", small.terms, large.terms),
            ("products", small.products, large.products),
        ] {
            assert!(
                b <= GROWTH * a,
                "{name}: {b} {what} for twice as many, {a} for half"
            );
        }
    }
}

#[test]
fn the_largest_models_of_many_groups_stay_far_below_the_limits() {
    for (name, model) in [
        ("free", free(100)),
        ("chain", chain(40)),
        ("tops", tops(60)),
    ] {
        let w = work(&model);
        assert!(model.len() <= 10_000, "{name}: {} bytes", model.len());
        assert!(
            w.nodes <= NODES / 3 && w.products <= PRODUCTS / 2,
            "{name}: {w:?}"
        );
    }
}

/// A model of a top with a potential of its advected vector.
fn potential(statements: &str, value: &str) -> String {
    format!(
        "model M {{ param J: Sym<3>; param g: Vec<3>; group G: SO<3> velocity W; \
         advected a: Vec<3>; advected S: Sym<3>; constraint next(G) = G*W; \
         constraint next(a) = W^T*a; constraint next(S) = W^T*S*W; \
         {statements} lagrangian = -tr(J*W)/h - h*({value}); }}"
    )
}

#[test]
fn what_multiplies_out_beyond_the_limits_is_refused() {
    let lets = |first: &str, step: &str, count: usize| -> String {
        let mut text = format!("let v0 = {first}; ");
        for i in 0..count {
            text += &format!("let v{} = {}; ", i + 1, step.replace('#', &format!("v{i}")));
        }
        text
    };
    for (first, step, last) in [
        ("S", "inv(Id + #*#)", "tr(v6)"),
        ("S", "inv(Id + #*#)", "tr(v7)"),
        ("S", "det(# + W)*#", "tr(v7)"),
        ("J + W", "#*#", "tr(v7)"),
        ("dot(a, g)", "exp(#*#) + #", "v6"),
        ("a", "cross(#, S*#)", "dot(v6, g)"),
        ("dot(a, g)", "#*#", "v40"),
    ] {
        let count = last
            .chars()
            .filter(char::is_ascii_digit)
            .collect::<String>();
        let count = count.parse().unwrap_or(0);
        let message = refusal(&potential(&lets(first, step, count), last));
        assert!(message.contains("too large"), "{step}: {message}");
    }
    let power = "*(1 + dot(a, J*g) + tr(S) + det(S))".repeat(30);
    let message = refusal(&potential("", &power[1..]));
    assert!(message.contains("too large"), "{message}");
}

#[test]
fn what_is_too_large_is_said_with_the_number_and_the_limit() {
    // The message states the requested number before the limit, and it exceeds the limit.
    let beyond = |message: &str, limit: u64| {
        let numbers: Vec<u64> = message
            .split(|c: char| !c.is_ascii_digit())
            .filter_map(|n| n.parse().ok())
            .collect();
        let at = numbers.iter().position(|n| *n == limit);
        at.is_some_and(|i| i > 0 && numbers[i - 1] > limit)
    };
    let sum = |count: usize| {
        let terms: Vec<String> = (0..count).map(|k| format!("{}*g[1]*a[2]", k + 2)).collect();
        potential("", &terms.join("+"))
    };
    for model in [sum(160), sum(300)] {
        let message = refusal(&model);
        assert!(beyond(&message, 1_000), "{message}");
        // The message does not suggest `let`, and there is no second message about a missing Lagrangian.
        assert!(
            !message.contains("`let`") && !message.contains("no Lagrangian"),
            "{message}"
        );
    }
    let nested = "let x = dot(a, g); ".to_owned()
        + "let y = x*x + x^3 + exp(x); let z = y*y + y^3 + exp(y) + y; let w = z*z*z*z + exp(z*z*z);
           let u = w*w*w*w + exp(w*w*w);";
    let message = refusal(&potential(&nested, "u"));
    assert!(
        beyond(&message, 1_000) && message.contains("a `let` counts in full"),
        "{message}"
    );
    let power = "*(1 + dot(a, J*g) + tr(S) + det(S))".repeat(30);
    let message = refusal(&potential("", &power[1..]));
    let limits = [4_000, 1_000_000, u64::from(LARGEST)];
    assert!(limits.iter().any(|l| beyond(&message, *l)), "{message}");
}

#[test]
fn longer_texts_are_refused_with_the_limit() {
    let terms = |count: usize| potential("", &vec!["tr(S)"; count].join("+"));
    let message = refusal(&terms(1_700));
    assert!(message.contains("more than 10000 bytes"), "{message}");
    // A megabyte of text is rejected before it is split into tokens.
    let message = refusal(&terms(300_000));
    assert!(message.contains("at most 250000"), "{message}");
    // Text outside the model does not count.
    let remark = format!("// {}\n", "x".repeat(20_000));
    let documentation = "/// a line\n".repeat(2_000);
    assert!(derive_source(&(remark + &documentation + &free(1))).is_ok());
}
