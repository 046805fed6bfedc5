//! Puts a velocity of every constraint of every gallery model on its wrong side. The engine must reject the model at that
//! constraint, because accepting it would leave multipliers in the equations.

use clebsch_core::derive_source;

/// The tokens of a statement: names as a whole, everything else character by character.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut inside = false;
    for c in text.chars() {
        let letter = c.is_alphanumeric() || c == '_';
        match words.last_mut() {
            Some(word) if letter && inside => word.push(c),
            _ => words.push(c.to_string()),
        }
        inside = letter;
    }
    words
}

/// The right-hand side with one velocity replaced by its inverse, for a group whose inverse is the transpose.
fn turned(text: &str, velocity: &str) -> Option<String> {
    let words = words(text);
    let mut out = String::new();
    let mut found = false;
    let mut at = 0;
    while at < words.len() {
        let rest: String = words[at + 1..].concat();
        if words[at] != velocity {
            out.push_str(&words[at]);
        } else if let Some(inverse) = ["^T", "^-1"].into_iter().find(|i| rest.starts_with(i)) {
            found = true;
            out.push_str(velocity);
            at += inverse.chars().count();
        } else {
            found = true;
            out.push_str(&format!("{velocity}^-1"));
        }
        at += 1;
    }
    found.then_some(out)
}

#[test]
fn no_wrong_sided_action_is_derived() {
    let mut tried = 0;
    for entry in clebsch_models::gallery() {
        let source = entry.card.source;
        assert!(derive_source(source).is_ok(), "{}", entry.card.kebab);
        let declared = |keyword: &str| {
            let mut names = Vec::new();
            let all: Vec<&str> = source.split_whitespace().collect();
            for pair in all.windows(2) {
                if pair[0] == keyword {
                    names.push(pair[1].trim_end_matches([';', ':']).to_owned());
                }
            }
            names
        };
        let (advected, velocities) = (declared("advected"), declared("velocity"));
        for quantity in &advected {
            let head = format!("constraint next({quantity}) = ");
            let start = source.find(&head).expect("stated") + head.len();
            let end = start + source[start..].find(';').expect("ended");
            for velocity in &velocities {
                let Some(wrong) = turned(&source[start..end], velocity) else {
                    continue;
                };
                let model = format!("{}{wrong}{}", &source[..start], &source[end..]);
                let what = format!("{}: next({quantity}) = {wrong}", entry.card.kebab);
                let Err(errors) = derive_source(&model) else {
                    panic!("{what} is derived");
                };
                let said = errors.to_string();
                assert!(said.contains(quantity.as_str()), "{what}: {said}");
                tried += 1;
            }
        }
    }
    assert!(tried >= 6, "only {tried} constraints were turned");
}

/// For several groups, in the body and in space: an advection of a quantity in the wrong direction, and the correct one.
const OFFERED: [[&str; 5]; 7] = [
    ["SO<3>", "G*V", "Vec<3>", "V*P", "V^T * P"],
    ["SO<3>", "V*G", "Vec<3>", "V^T*P", "V * P"],
    ["SU<2>", "G*V", "Vec<3>", "rot(V)*P", "rot(V)^T * P"],
    [
        "SU<2>",
        "V*G",
        "Sym<3>",
        "rot(V)^T*P*rot(V)",
        "rot(V) * P * rot(V)^T",
    ],
    ["SE<3>", "G*V", "Vec<4>", "V*P", "V^-1 * P"],
    ["SE<3>", "G*V", "Vec<3>", "rot(V)*P", "rot(V)^T * P"],
    ["GL<3>", "G*V", "Vec<3>", "V*P", "V^-1 * P"],
];

#[test]
fn what_is_offered_instead_is_derived() {
    for [group, reconstruction, kind, wrong, right] in OFFERED {
        let weight = if kind == "Sym<3>" {
            "tr(P)"
        } else {
            "dot(a, P)"
        };
        let space = kind.replace("Sym<3>", "Vec<3>");
        let model = |update: &str| {
            format!(
                "model Carried {{ param a: {space}; group G: {group} velocity V; advected P: {kind}; \
                 constraint next(G) = {reconstruction}; constraint next(P) = {update}; \
                 lagrangian = -tr(V)/h - h*{weight}; }}"
            )
        };
        let refused = derive_source(&model(wrong)).expect_err(wrong).to_string();
        let offer = format!("`constraint next(P) = {right};`");
        assert!(refused.contains(&offer), "{group}: {refused}");
        if let Err(e) = derive_source(&model(right)) {
            panic!("{group}: {right}: {e}");
        }
    }
}
