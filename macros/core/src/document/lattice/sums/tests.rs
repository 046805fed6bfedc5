//! Compares invariants of short and longer chains with what is printed for every number of sites.

use crate::lattice::Lattice;
use crate::pipeline;
use crate::print::Format;

/// The items of the section on invariants, each joined into one line.
fn items(model: &str) -> Vec<String> {
    let parsed = pipeline::parse_source(model).unwrap_or_else(|e| panic!("{e}"));
    let printed = crate::document::printed_lattice(&parsed, model, Format::Text, 1000).unwrap();
    let text = printed.text;
    let begin = text.find("Invariants\n").unwrap();
    let end = text.find("Certificate\n").unwrap();
    let lines = text[begin..end].lines();
    lines
        .filter(|l| l.starts_with("- ") || l.starts_with("Other invariants"))
        .map(str::to_owned)
        .collect()
}

const PINNED: &str = "model M {
    label i in 0..N;
    end i = 0 { free; pinned { X = given; } }
    end i = N { free; pinned { X = given; } load { param F: Vec<3>; term h*dot(F, X); } }
    param m: Real at nodes; param e: Real; param g: Vec<3>;
    field X: Vec<3> at nodes;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*dot(g, X)
        - h*e*dot(next(X, i) - X, next(X, i) - X)^2/2;
}";

#[test]
fn what_an_end_holds_is_read_from_that_end() {
    let list = items(PINNED);
    let has = |part: &str| list.iter().any(|l| l.contains(part));
    assert!(
        has("about X g: (∑_{i=1}^N (X_{i,k} - X₀) × p_{i,k})·g (exact"),
        "{list:#?}"
    );
    assert!(
        has("(∑_{i=0}^{N-1} (X_{i,k} - X_N) × p_{i,k})·g (exact"),
        "{list:#?}"
    );
    assert!(
        has("across F g: (∑_{i=0}^N p_{i,k})·(F_N × g) (exact"),
        "{list:#?}"
    );
    // The expanded chain has four segments.
    for short in ["_4", "₄", "₂", "_{4", "_{N-2", " 4"] {
        assert!(!has(short), "{short}: {list:#?}");
    }
}

#[test]
fn parts_over_some_of_the_sites_are_told_together() {
    // Sites couple only to the next site but one: on an open chain, the even and the odd sites are separate chains.
    let list = items(
        "model M { label i in 0..N; param m: Real at nodes; param e: Real; field q: Real at nodes;
         lagrangian = m*(next(q) - q)^2/(2*h) - h*e*(next(next(q, i), i) - q)^4; }",
    );
    let sums = list
        .iter()
        .filter(|l| l.contains("∑_{i=0}^N p_{i,k} (exact"));
    assert_eq!(sums.count(), 1, "{list:#?}");
    assert!(
        list.iter().any(|l| l.starts_with("Other invariants")),
        "{list:#?}"
    );
    assert!(!list.iter().any(|l| l.contains("p_{0,k}")), "{list:#?}");
}

#[test]
fn names_are_those_of_longer_lattices() {
    let model = pipeline::parse_source(PINNED).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let short = pipeline::representative(&model, &lattice).unwrap();
    for more in [1, 3] {
        let mut choice = short.clone().with_end(&lattice, true, "load").unwrap();
        choice.counts[0] += more;
        let (unfolded, d) = pipeline::derive_lattice(&model, &lattice, &choice).unwrap();
        let names: Vec<String> = d
            .invariants
            .iter()
            .map(|v| unfolded.plain(&v.name))
            .collect();
        assert!(
            names.contains(&"total momentum across F g".to_owned()),
            "{names:?}"
        );
    }
}

/// Totals of sites without neighbours are sums over all sites, and so are the equations of a configuration that
/// couples to all of them. The momentum of that configuration has the number that the derivation assigns.
#[test]
fn sets_without_neighbours_are_summed_over_all_their_sites() {
    let model =
        "model M { label a in 0..N; param m, M, k: Real; field x: Vec<3> at a; field y: Vec<3>;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + M*dot(next(y) - y, next(y) - y)/(2*h)
            - (h/2)*k*dot(x - y, x - y); }";
    let list = items(model);
    for total in [
        "- total momentum: ∑_{a=0}^{N-1} p_{1,a,k} + p_{2,k} (exact",
        "- total momentum angular: ∑_{a=0}^{N-1} x_{a,k} × p_{1,a,k} + y_k × p_{2,k} (exact",
    ] {
        let found = list.iter().any(|l| l.starts_with(total));
        assert!(found, "{total}: {list:#?}");
    }
    let parsed = pipeline::parse_source(model).unwrap_or_else(|e| panic!("{e}"));
    let printed = crate::document::printed_lattice(&parsed, model, Format::Text, 1000).unwrap();
    for equation in [
        "p_{2,k} = M Δy_k/h - ∑_{a=0}^{N-1} ½ h k (x_{a,k} - y_k)",
        "p_{2,k+1} = M Δy_k/h + ∑_{a=0}^{N-1} ½ h k (x_{a,k+1} - y_{k+1})",
    ] {
        assert!(printed.text.contains(equation), "{}", printed.text);
    }
    for short in ["a+1", "p_3", "p_{3"] {
        assert!(!printed.text.contains(short), "{}", printed.text);
    }
    // The description of a run covers its actual number of sites.
    let lattice = Lattice::read(&parsed).unwrap();
    for count in [1, 2, 9] {
        let mut choice = pipeline::representative(&parsed, &lattice).unwrap();
        choice.counts = vec![count];
        let (unfolded, d) = pipeline::derive_lattice(&parsed, &lattice, &choice).unwrap();
        let words = crate::document::card_words(&lattice, &choice, unfolded, &d, "none");
        let total = words.invariants.iter().find(|v| v.name == "total_momentum");
        let formula = total.map(|v| v.formula.as_str());
        assert_eq!(
            formula,
            Some("∑_{a=0}^{N-1} p_{1,a,k} + p_{2,k}"),
            "{count}"
        );
    }
}
