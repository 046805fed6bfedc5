//! Warnings about chains: the sign of kinetic energies with neighbour coupling, terms of ends, unused parameters.

use crate::derive::warnings::{Topic, Warning};
use crate::lattice::{ChainConfig, Lattice};
use crate::pipeline::{derive_lattice, parse_source, representative};

/// The warnings for a chain with these ends, or for the ring.
fn warnings_of(source: &str, count: Option<usize>, ends: Option<[&str; 2]>) -> Vec<Warning> {
    let model = parse_source(source).unwrap_or_else(|e| panic!("{source}\n{e}"));
    let lattice = Lattice::read(&model).unwrap();
    let choice = representative(&model, &lattice).unwrap();
    let count = count.unwrap_or_else(|| choice.count(0));
    let choice = choice.with_count(&lattice, "i", count).unwrap();
    let choice: ChainConfig = match ends {
        None => choice.with_ring(&lattice).unwrap(),
        Some([first, last]) => {
            let choice = choice.with_end(&lattice, false, first).unwrap();
            choice.with_end(&lattice, true, last).unwrap()
        }
    };
    let (unfolded, d) = derive_lattice(&model, &lattice, &choice).unwrap();
    unfolded.declared_warnings(&choice, &d.warnings)
}

#[test]
fn velocities_that_are_joined_weakly_have_a_positive_energy() {
    let ring = |parameters: &str, kinetic: &str| {
        let source = format!(
            "model Ring {{ label i in 0..N; periodic; {parameters} field x: Vec<3> at nodes; let d = next(x) - x;
             lagrangian = {kinetic} - h*dot(next(x, i) - x, next(x, i) - x)/2; }}"
        );
        let all = warnings_of(&source, Some(5), None);
        let sign = |w: &&Warning| w.topic == Topic::SignOfKineticEnergy;
        all.iter().filter(sign).count()
    };
    for (parameters, kinetic, count) in [
        (
            "param m: Real at nodes; param C: Sym<3> at segments;",
            "m*dot(d, d)/(2*h) + (1/h)*dot(d, C*next(d, i))",
            0,
        ),
        (
            "param M, C: Sym<3>;",
            "dot(d, M*d)/(2*h) + (1/h)*dot(d, C*next(d, i))",
            0,
        ),
        (
            "param c: Real at segments;",
            "dot(d, d)/(2*h) + (c/h)*dot(d, next(d, i))",
            0,
        ),
        // Indefinite for every value of m: with five sites, the symbol m (1 + 1.4 cos θ) is negative at θ = 4π/5.
        (
            "param m: Real;",
            "m*dot(d, d)/(2*h) + (0.7*m/h)*dot(d, next(d, i))",
            1,
        ),
        // Neighbour coupling does not repair a negative sign.
        (
            "param m, c: Real;",
            "(c/h)*dot(d, next(d, i)) - m*dot(d, d)/(2*h)",
            1,
        ),
    ] {
        assert_eq!(ring(parameters, kinetic), count, "{kinetic}");
    }
}

#[test]
fn a_term_of_an_end_without_a_limit_is_told_where_it_stands() {
    let end = "F*q";
    let source = format!(
        "model Line {{ label i in 0..N; param m, k: Real; field q: Real at nodes;
         lagrangian = m*(next(q) - q)^2/(2*h) - h*k*(next(q, i) - q)^2/2;
         end i = 0 {{ free; load {{ param F: Real; term {end}; }} }} }}"
    );
    let all = warnings_of(&source, None, Some(["load", "free"]));
    let limits: Vec<&Warning> = all.iter().filter(|w| w.topic == Topic::NoLimit).collect();
    let [only] = limits.as_slice() else {
        panic!("{limits:?}");
    };
    let shown = only.diagnostic.render("warning", &source, "line");
    assert!(
        shown.contains(&source[source.find("end i").unwrap()..]),
        "{shown}"
    );
    let carets = shown.lines().find_map(|line| {
        let marks = line.trim().strip_prefix('|')?.trim();
        let only = !marks.is_empty() && marks.chars().all(|c| c == '^');
        only.then_some(marks.len())
    });
    assert_eq!(carets, Some(end.len()), "{shown}");
}

#[test]
fn what_nothing_names_is_told_of_every_line() {
    let source = |neighbours: &str| {
        format!(
            "model Line {{ label i in 0..N step s; periodic; param m, k, F: Real; field q: Real at nodes;
             lagrangian = m*(next(q) - q)^2/(2*h) - h*k*{neighbours};
             end i = 0 {{ free; pinned {{ q = given; }} }}
             end i = N {{ free; load {{ term h*F*q; }} }} }}"
        )
    };
    let unused = |source: &str, count, ends| -> Vec<String> {
        let all = warnings_of(source, count, ends).into_iter();
        let own = all.filter(|w| w.topic == Topic::UnusedParameter);
        own.map(|w| w.diagnostic.message).collect()
    };
    let s = "the parameter `s` is never used";
    let without = source("(next(q, i) - q)^2/2");
    for count in [None, Some(2), Some(5)] {
        for ends in [
            Some(["pinned", "free"]),
            Some(["pinned", "load"]),
            Some(["free", "load"]),
        ] {
            assert_eq!(unused(&without, count, ends), [s], "{count:?} {ends:?}");
        }
        let found = unused(&without, count, None);
        assert!(found.iter().any(|w| w == s), "{count:?}: {found:?}");
    }
    // A case must give the spacing as long as the model declares it.
    let found = warnings_of(&without, None, Some(["pinned", "load"]));
    let own = found.iter().find(|w| w.diagnostic.message == s);
    let help = own.map(|w| w.diagnostic.help.join(" "));
    let help = help.unwrap_or_default();
    for said in ["remove `step s` from the label", "every case must give `s`"] {
        assert!(help.contains(said), "{help}");
    }
    let with = source("(next(q, i) - q)^2/(2*s)");
    assert!(unused(&with, None, Some(["pinned", "load"])).is_empty());
}

#[test]
fn a_parameter_that_another_end_uses_is_not_unused() {
    let source = |term: &str| {
        format!(
            "model Line {{ label i in 0..N; periodic; param m, k, F, b: Real; param g: Real at nodes; field q: Real at nodes; let f = F*q + g*q;
             lagrangian = m*(next(q) - q)^2/(2*h) - h*k*(next(q, i) - q)^2/2;
             end i = 0 {{ free; load {{ term {term}; }} }}
             end i = N {{ free; load {{ term {term}; }} }} }}"
        )
    };
    for term in ["h*F*q + h*g*q", "h*f"] {
        for ends in [None, Some(["free", "free"]), Some(["free", "load"])] {
            let all = warnings_of(&source(term), Some(12), ends).into_iter();
            let own = all.filter(|w| w.topic == Topic::UnusedParameter);
            let messages: Vec<String> = own.map(|w| w.diagnostic.message).collect();
            let expected = ["the parameter `b` is never used"];
            assert_eq!(messages, expected, "{term} {ends:?}");
        }
    }
}

#[test]
fn a_definition_that_nothing_uses_is_said_once() {
    let source = "model Beads { label i in 0..N; param m, k: Real; field q: Real at nodes; let d = next(q, i) - q; let f = k*d;
         lagrangian = m*(next(q) - q)^2/(2*h) - h*k*d^2/2; end i = 0 { free; pulled { param F: Real; term h*F*q; } } }";
    let unused = |source: &str| {
        let all = warnings_of(source, None, Some(["free", "free"]));
        let own = all.iter().filter(|w| w.topic == Topic::UnusedLet);
        own.map(|w| w.diagnostic.message.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        unused(source),
        ["`f` is defined by `let` but never used: it has no effect"]
    );
    // An end condition that is not chosen uses it.
    assert!(unused(&source.replace("h*F*q", "h*F*f")).is_empty());
}
