//! Compares expanded chains with models of several bodies written by hand, and checks rejected models.

use super::{ChainConfig, Lattice};
use crate::derive::warnings::Topic;
use crate::document;
use crate::pipeline::{derive_lattice, derive_source, parse_source, representative};
use crate::print::Format;

const TOPS: &str = "model Tops {
    label i in 0..N step s; periodic;
    param J, C: Sym<3>; param g, z: Vec<3>;
    group Λ: SO<3> at nodes velocity Ω; advected Γ: Vec<3> at nodes = Λ^T*z;
    constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
    lagrangian = -s*tr(J*Ω)/h - h*s*dot(g, Γ) + (h/s)*tr(C*Λ^T*next(Λ, i));
}";

const CHAIN: &str = "model Chain {
    label i in 0..N; periodic;
    param m: Real at nodes; param k: Real at segments; param w: Real;
    field q: Real at nodes offset L;
    let r = next(q, i) - q;
    lagrangian = m*(next(q) - q)^2/(2*h) - h*(k*exp(-r) + w*r);
    end i = 0 { free; pinned { q = given; } spring { param c, q0: Real; term -(h/2)*c*(q - q0)^2; } }
    end i = N { free; pinned { q = given; } }
}";

fn chosen(source: &str, count: usize, ring: bool, ends: [&str; 2]) -> String {
    let model = parse_source(source).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let mut choice = representative(&model, &lattice).unwrap();
    choice = choice.with_count(&lattice, "i", count).unwrap();
    choice = match ring {
        true => choice.with_ring(&lattice).unwrap(),
        false => {
            let first = choice.with_end(&lattice, false, ends[0]).unwrap();
            first.with_end(&lattice, true, ends[1]).unwrap()
        }
    };
    let (_, d) = derive_lattice(&model, &lattice, &choice).unwrap();
    document::printed(&d, Format::Text)
}

fn by_hand(source: &str) -> String {
    document::printed(&derive_source(source).unwrap(), Format::Text)
}

/// The two models declare parameters in different order, which determines the order of factors in the limit.
/// Everything derived before the limit must be equal.
fn same_equations(found: &str, hand: &str) {
    let part = |text: &str| {
        let after = text.split("Discrete Lagrangian").nth(1).unwrap();
        after
            .split("Limit of small steps")
            .next()
            .unwrap()
            .to_owned()
    };
    let (found, hand) = (part(found), part(hand));
    for (a, b) in found.lines().zip(hand.lines()) {
        assert_eq!(a, b);
    }
    assert_eq!(found.lines().count(), hand.lines().count());
}

/// Tops in a row, coupled in these pairs.
fn row_of_tops(count: usize, pairs: &[(usize, usize)]) -> String {
    let mut text = "model Tops { param s: Real; param J, C: Sym<3>; param g, z: Vec<3>;".to_owned();
    for j in 0..count {
        text += &format!("group Λ_{j}: SO<3> velocity Ω_{j}; advected Γ_{j}: Vec<3> = Λ_{j}^T*z;");
        text += &format!(
            "constraint next(Λ_{j}) = Λ_{j}*Ω_{j}; constraint next(Γ_{j}) = Ω_{j}^T*Γ_{j};"
        );
    }
    let mut terms: Vec<String> = Vec::new();
    terms.extend((0..count).map(|j| format!("-s*tr(J*Ω_{j})/h")));
    terms.extend((0..count).map(|j| format!("-h*s*dot(g, Γ_{j})")));
    terms.extend(
        pairs
            .iter()
            .map(|(a, b)| format!("+(h/s)*tr(C*Λ_{a}^T*Λ_{b})")),
    );
    text + "lagrangian = " + &terms.join(" ") + ";}"
}

#[test]
fn rows_and_rings_of_tops_are_those_written_by_hand() {
    for n in [1, 2, 3, 5, 12] {
        let open: Vec<(usize, usize)> = (0..n).map(|j| (j, j + 1)).collect();
        let ring: Vec<(usize, usize)> = (0..n).map(|j| (j, (j + 1) % n)).collect();
        let found = chosen(TOPS, n, false, ["free", "free"]);
        assert_eq!(found, by_hand(&row_of_tops(n + 1, &open)), "{n} segments");
        let found = chosen(TOPS, n, true, ["free", "free"]);
        assert_eq!(found, by_hand(&row_of_tops(n, &ring)), "ring of {n}");
    }
}

#[test]
fn ends_are_those_written_by_hand() {
    let one = |held: &str, fields: &str, terms: &str| {
        format!(
            "model Chain {{ param m_0, m_1, m_2: Real; param k_0, k_1: Real; param w: Real; {held} {fields} lagrangian = {terms} \
             - h*(k_0*exp(-(q_1 - q_0))) - h*(k_1*exp(-(q_2 - q_1))) - h*(w*(q_1 - q_0)) - h*(w*(q_2 - q_1)) "
        )
    };
    let kinetic = |list: &[usize]| {
        let each = list
            .iter()
            .map(|j| format!("m_{j}*(next(q_{j}) - q_{j})^2/(2*h)"));
        each.collect::<Vec<_>>().join(" + ")
    };
    let fields = |list: &[usize]| {
        let each = list.iter().map(|j| format!("field q_{j}: Real;"));
        each.collect::<String>()
    };
    let cases = [
        (["free", "free"], vec![0, 1, 2], "", ""),
        (["pinned", "free"], vec![1, 2], "param q_0: Real;", ""),
        (["pinned", "pinned"], vec![1], "param q_0, q_2: Real;", ""),
        (
            ["spring", "free"],
            vec![0, 1, 2],
            "param c_0, q0_0: Real;",
            "-(h/2)*c_0*(q_0 - q0_0)^2",
        ),
    ];
    for (ends, moving, held, term) in cases {
        let hand = one(held, &fields(&moving), &kinetic(&moving)) + term + ";}";
        let found = chosen(CHAIN, 2, false, ends);
        same_equations(&found, &by_hand(&hand));
    }
}

#[test]
fn the_seam_of_a_ring_carries_the_offset() {
    let found = chosen(CHAIN, 3, true, ["free", "free"]);
    let hand = "model Chain { param m_0, m_1, m_2: Real; param k_0, k_1, k_2: Real; param w: Real;
        field q_0, q_1, q_2: Real; param L: Real;
        lagrangian = m_0*(next(q_0) - q_0)^2/(2*h) + m_1*(next(q_1) - q_1)^2/(2*h) + m_2*(next(q_2) - q_2)^2/(2*h)
          - h*(k_0*exp(-(q_1 - q_0))) - h*(k_1*exp(-(q_2 - q_1))) - h*(k_2*exp(-(q_0 + L - q_2)))
          - h*(w*(q_1 - q_0)) - h*(w*(q_2 - q_1)) - h*(w*(q_0 + L - q_2)); }";
    same_equations(&found, &by_hand(hand));
}

/// The first error for a model with these statements.
fn refused(middle: &str) -> String {
    let source = format!(
        "model M {{ label i in 0..N; label a in 0..P; param u: Real at a; param m: Real; field q: Real at nodes; {middle} }}"
    );
    match parse_source(&source).and_then(|m| crate::pipeline::derive_model(&m)) {
        Err(errors) => errors.to_string(),
        Ok(_) => "derived".to_owned(),
    }
}

#[test]
fn mistakes_are_told_in_the_words_of_the_statement() {
    let kinetic = "lagrangian = m*(next(q) - q)^2/(2*h)";
    assert_eq!(refused(&format!("{kinetic};")), "derived");
    let cases = [
        (format!("{kinetic} - h*next(q, j)^2;"), "`j` is not a label"),
        (
            format!("{kinetic} - h*next(u, a)^2;"),
            "`a` is a set of sites",
        ),
        (
            format!("{kinetic} - h*next(m, i)*q;"),
            "the same at every site",
        ),
        (format!("{kinetic} - h*u*q;"), "sites of `a` and of `i`"),
        (format!("{kinetic} - h*i*q;"), "counts sites"),
        (
            format!("{kinetic}; field X: Real at node;"),
            "did you mean `at nodes`?",
        ),
        (
            format!("{kinetic}; end i = 1 {{ free; }}"),
            "ends of the chain are 0 and N",
        ),
        (
            format!("{kinetic}; end j = 0 {{ free; }}"),
            "the label of the chain is `i`",
        ),
        (
            format!("{kinetic}; end i = 0 {{ free; free; }}"),
            "declared twice",
        ),
        (
            format!("{kinetic}; end i = 0 {{ held {{ m = given; }} }}"),
            "is not a quantity of the chain",
        ),
        (
            format!("{kinetic}; end i = 0 {{ held {{ term prev(q, i); }} }}"),
            "does not exist at this site",
        ),
        (
            format!("{kinetic}; label l in 0..K; field X: Real at nodes;"),
            "at most one chain",
        ),
        (
            format!("{kinetic}; field X: Real offset L;"),
            "field on a chain",
        ),
        (format!("{kinetic}; scale q;"), "is not repeated at sites"),
        (
            format!("{kinetic}; end i = 0 {{ q = given; }}"),
            "name the end condition",
        ),
        (format!("{kinetic}; periodic; periodic;"), "stated twice"),
        (format!("{kinetic} - h*q_1*q;"), "`q_1` is not declared"),
        (
            format!("{kinetic}; end i = 0 {{ held {{ param m: Real; term m*q; }} }}"),
            "`m` is declared twice",
        ),
        (
            format!("{kinetic}; field N: Real at nodes;"),
            "`N` is declared twice",
        ),
    ];
    for (middle, expected) in cases {
        let found = refused(&middle);
        assert!(found.contains(expected), "{middle}\n{found}");
    }
}

#[test]
fn a_configuration_without_sites_is_told_how_to_be_put_on_the_line() {
    let lagrangian = "lagrangian = m*dot(next(q) - q, next(q) - q)/(2*h);";
    let of = |declared: &str| {
        let source = format!(
            "model M {{ label i in 0..N; param m: Real; {declared} end i = 0 {{ pinned {{ q = given; }} }} {lagrangian} }}"
        );
        let model = parse_source(&source).expect("it parses");
        Lattice::read(&model)
            .expect_err("`q` has no sites")
            .to_string()
    };
    let found = of("field q: Vec<3>;");
    assert!(
        found.contains("write `field q: Vec<3> at nodes;`"),
        "{found}"
    );
    let found = of("group q: SO<3> velocity W;");
    assert!(
        found.contains("write `group q: SO<3> at nodes velocity W;`"),
        "{found}"
    );
}

#[test]
fn a_site_without_a_kinetic_term_is_told_in_the_words_of_the_statement() {
    let of = |parameters: &str, terms: &str| {
        let source = format!(
            "model M {{ label i in 0..N; {parameters} field x: Real at nodes; lagrangian = {terms}; }}"
        );
        let model = parse_source(&source).expect("it parses");
        let errors = crate::pipeline::derive_model(&model).expect_err("no kinetic energy");
        let found = errors.to_string();
        assert!(!found.contains("x_"), "{found}");
        found
    };
    let found = of(
        "param m: Real at segments;",
        "m*(next(x) - x)^2/(2*h) - h*(next(x, i) - x)^2/2",
    );
    assert!(
        found.contains("the last site i = N of `x` has no kinetic term"),
        "{found}"
    );
    assert!(found.contains("declare `m` at nodes"), "{found}");
    let found = of(
        "param m: Real;",
        "m*(next(x, i) - x)*(next(next(x), i) - next(x, i))/(2*h)",
    );
    assert!(
        found.contains("the first site i = 0 of `x` has no kinetic term"),
        "{found}"
    );
    let found = of("param m: Real;", "-h*m*x^2");
    assert!(found.contains("`next(x)` does not appear"), "{found}");
}

#[test]
fn a_mistake_in_an_end_block_is_the_only_one_told() {
    for end in [
        "end i = 0 { q = given; }",
        "end i = 0 { pinned { q = gven; } free; }",
        "end i = 0 { free; held { term ; } }",
    ] {
        let source = format!(
            "model M {{ label i in 0..N; param m: Real; field q: Real at nodes; {end} lagrangian = m*(next(q) - q)^2/(2*h); }}"
        );
        let errors = parse_source(&source).unwrap_err();
        assert_eq!(errors.iter().count(), 1, "{end}\n{errors}");
    }
}

#[test]
fn what_is_too_large_or_does_not_move_is_refused() {
    let refused = |source: &str, count: usize, ends: [&str; 2]| {
        let model = parse_source(source).unwrap();
        let lattice = Lattice::read(&model).unwrap();
        let choice = ChainConfig::representative(&lattice, 1);
        let choice = choice.with_count(&lattice, "i", count).unwrap();
        let choice = choice.with_end(&lattice, false, ends[0]).unwrap();
        let choice = choice.with_end(&lattice, true, ends[1]).unwrap();
        super::unfold(&model, &lattice, &choice)
            .unwrap_err()
            .to_string()
    };
    assert!(refused(CHAIN, 1_000_000, ["free", "free"]).contains("too large"));
    assert!(refused(CHAIN, 1, ["pinned", "pinned"]).contains("nothing moves"));
}

#[test]
fn a_choice_is_one_of_those_stated() {
    let model = parse_source(CHAIN).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let choice = ChainConfig::representative(&lattice, 1);
    assert!(choice.clone().with_count(&lattice, "j", 3).is_err());
    assert!(choice.clone().with_count(&lattice, "i", 0).is_err());
    assert!(choice.clone().with_end(&lattice, true, "spring").is_err());
    assert!(choice.with_end(&lattice, false, "spring").is_ok());
    let model = parse_source(&CHAIN.replace("periodic;", "")).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    assert!(
        ChainConfig::representative(&lattice, 1)
            .with_ring(&lattice)
            .is_err()
    );
}

#[test]
fn a_term_of_one_neighbour_is_warned_of_and_a_difference_is_not() {
    let warned = |term: &str| {
        let source = format!(
            "model M {{ label i in 0..N; param a: Real; field q: Real at nodes; let r = next(q, i) - q; lagrangian = (next(q) - q)^2/(2*h) {term}; }}"
        );
        let model = parse_source(&source).unwrap();
        let lattice = Lattice::read(&model).unwrap();
        let choice = representative(&model, &lattice).unwrap();
        super::unfold(&model, &lattice, &choice)
            .unwrap()
            .warnings
            .iter()
            .filter(|w| w.topic == Topic::OneNeighbour)
            .count()
    };
    for (term, count) in [
        ("- h*a*next(q, i)", 1),
        ("- h*a*(next(q, i) - q)", 0),
        ("- h*a*r", 0),
        ("- r", 0),
        ("- h*a*next(q, i)*prev(q, i)", 0),
        ("- h*(a*q^2/2 + next(q, i)*prev(q, i))", 0),
        ("- h*sum(a*next(q, i), segments)", 0),
    ] {
        assert_eq!(warned(term), count, "{term}");
    }
}

fn beads(hold: &str) -> String {
    format!(
        "model Beads {{
            label i in 0..N; periodic;
            param m: Real at nodes; param a: Real at segments; param X: Vec<3>; param R: Real;
            field φ: Vec<3> at nodes;
            {hold}
            lagrangian = m*dot(next(φ) - φ, next(φ) - φ)/(2*h) - h*m*dot(X, φ)/R;
        }}"
    )
}

#[test]
fn a_sum_that_is_held_is_the_sum_typed_by_hand() {
    let lattice = chosen(&beads("hold c: sum(m*φ) = X;"), 2, false, ["free", "free"]);
    let sum = "hold c: m_0*φ_0 + m_1*φ_1 + m_2*φ_2 = X;";
    assert!(lattice.contains(sum), "{lattice}");
    // Distances at segments, and squares at nodes.
    let several = "hold c: R = 2*sum(dot(next(φ, i) - φ, next(φ, i) - φ)) - sum(dot(φ, φ), nodes);";
    let lattice = chosen(&beads(several), 1, false, ["free", "free"]);
    let wanted = "R = 2*dot(φ_1 - φ_0, φ_1 - φ_0) - dot(φ_0, φ_0) - dot(φ_1, φ_1);";
    assert!(lattice.contains(wanted), "{lattice}");
}

#[test]
fn a_constraint_with_the_site_before_is_counted_from_that_one() {
    let with = |hold: &str, ring| chosen(&beads(hold), 4, ring, ["free", "free"]);
    for ring in [false, true] {
        let before = with(
            "hold n: dot(φ - prev(φ, i), φ - prev(φ, i)) = prev(a, i)^2;",
            ring,
        );
        let after = with("hold n: dot(next(φ, i) - φ, next(φ, i) - φ) = a^2;", ring);
        assert_eq!(before, after);
    }
}

#[test]
fn sums_are_refused_where_they_mean_nothing() {
    for (hold, wanted) in [
        ("hold c: sum(φ) = φ;", "differs between sites"),
        (
            "hold c: sum(sum(φ)) = X;",
            "contains another sum over sites",
        ),
        ("hold c: sum(X) = X;", "it cannot be summed over sites"),
        ("hold c: sum(φ) = R;", "a vector of length 3 is needed here"),
        ("hold c: sum(m) = R;", "contains no configuration"),
        (
            "hold c: sum(φ, edges) = X;",
            "over `nodes` or over `segments`",
        ),
        ("hold c: sum(next(φ)) = X;", "remove `next`"),
        (
            "hold c: sum(φ) = X; hold d: sum(2*φ) = X;",
            "follows from the others",
        ),
        ("scale sum(m);", "is allowed only in a `hold` constraint"),
        ("hold c: sum(y) = X;", "`y`"),
        ("hold c: sum(φ, nodes, 3) = X;", "`sum` takes an expression"),
        ("hold c: sum() = X;", "this sum over sites is empty"),
        ("hold c: sum φ = X;", "`sum` needs its summand"),
        ("scale m + sum(i) φ;", "takes the summand, not a label"),
    ] {
        let source = beads(hold);
        let model = parse_source(&source).unwrap();
        let lattice = Lattice::read(&model).unwrap();
        let told = document::printed_lattice(&model, &source, Format::Text, 100).map(|_| ());
        let told = told.expect_err(hold).to_string();
        assert!(told.contains(wanted), "{hold}: {told}");
        assert!(lattice.line.is_some());
    }
}

#[test]
fn a_sum_over_stated_sites_is_a_term_of_the_lagrangian_and_no_number_in_it() {
    let told = |term: &str| {
        let source = format!(
            "model Beads {{ label i in 0..N; param m: Real at nodes; param k: Real; field x: Real at nodes;
             lagrangian = m*(next(x) - x)^2/(2*h) - h*k*{term}; }}"
        );
        let model = parse_source(&source).unwrap();
        document::printed_lattice(&model, &source, Format::Text, 100)
    };
    for (term, wanted) in [
        ("sum(x, nodes)^2", "a power of a sum over sites"),
        ("cos(sum(x, nodes))", "a function of a sum over sites"),
        (
            "x*sum(x, nodes)",
            "a quantity of a site times a sum over sites",
        ),
        ("m/sum(m, nodes)", "a quotient by a sum over sites"),
        (
            "sum(x, nodes)*sum(m, nodes)",
            "a sum over pairs of sites, which is not supported yet",
        ),
        (
            "sum(m*sum(x))",
            "a sum over pairs of sites, which is not supported yet",
        ),
        (
            "sum(m*x^2, pairs)",
            "a sum over pairs of sites, which is not supported yet",
        ),
        ("sum(x, nodes, 3)", "`sum` takes an expression"),
    ] {
        let found = told(term).map(|_| ()).expect_err(term).to_string();
        assert!(found.contains(wanted), "{term}: {found}");
    }
    for term in ["sum(x^2, nodes)", "2*sum(x, nodes)/3", "(-sum(x*m, nodes))"] {
        assert!(told(term).is_ok(), "{term}");
    }
}

#[test]
fn a_parameter_of_nodes_that_stands_at_segments_is_used() {
    let told = |term: &str| {
        let source = format!(
            "model Springs {{ label i in 0..N; param m, a: Real at nodes; field q: Real at nodes;
             lagrangian = m*(next(q) - q)^2/(2*h) - (h/2){term}*(next(q, i) - q)^2; }}"
        );
        let model = parse_source(&source).unwrap();
        document::printed_lattice(&model, &source, Format::Text, 100)
            .unwrap()
            .text
    };
    // On an open chain, the last node does not have a segment.
    let used = told("*a");
    assert!(!used.contains("never used"), "{used}");
    assert!(told("").contains("the parameter `a` is never used"));
}

#[test]
fn constants_of_a_line_are_left_out_of_what_is_printed() {
    let source = "model Pendula { label i in 0..N; param m, g, k: Real; field q: Real at nodes;
         lagrangian = m*(next(q) - q)^2/(2*h) - h*m*g*(1 - cos(q)) - (h*k/2)*(next(q, i) - q)^2; }";
    let model = parse_source(source).unwrap();
    let text = document::printed_lattice(&model, source, Format::Text, 100)
        .unwrap()
        .text;
    assert!(text.contains("+ ∑_{i=0}^N h m g cos(q_{i,k})"), "{text}");
    assert!(
        !text.contains("- h m g\n") && !text.contains("- h m g +"),
        "{text}"
    );
    assert!(text.contains("Constants, which do not enter"), "{text}");
}

#[test]
fn first_order_is_said_once_for_all_sites() {
    let source = "model Line { label i in 0..N; periodic; param m, c: Real; field q: Real at nodes;
         lagrangian = m*(next(q) - q)^2*(1 + c*cos(q))/(2*h) - (h/2)*(next(q, i) - q)^2; }";
    let model = parse_source(source).unwrap();
    let text = document::printed_lattice(&model, source, Format::Text, 100)
        .unwrap()
        .text;
    let at = text.find("of first order only").expect("is warned of");
    let warning = &text[at..text[at..].find("\n\n").map_or(text.len(), |end| at + end)];
    assert_eq!(warning.matches("cos(q_{").count(), 1, "{warning}");
    assert!(warning.contains("at other sites"), "{warning}");
}

#[test]
fn momenta_bear_a_letter_that_the_model_does_not() {
    for (param, hold, momentum) in [
        ("k", "hold p: sum(m*q) = X;", "ϖ_{i,k} = "),
        ("p", "", "ϖ_{i,k} = "),
        ("p, ϖ", "", "ς_{i,k} = "),
        ("k", "", "p_{i,k} = "),
    ] {
        let source = format!(
            "model Line {{ label i in 0..N; param m: Real at nodes; param {param}, X, b: Real; field q: Real at nodes; {hold}
             lagrangian = m*(next(q) - q)^2/(2*h) - (h/2)*b*(next(q, i) - q - X)^2; }}"
        );
        let model = parse_source(&source).unwrap();
        let text = document::printed_lattice(&model, &source, Format::Text, 100)
            .unwrap()
            .text;
        assert!(text.contains(momentum), "{hold}: {text}");
    }
}

#[test]
fn an_offset_is_warned_of_where_the_line_is_no_ring() {
    let warned = |source: &str| {
        let model = parse_source(source).unwrap();
        let lattice = Lattice::read(&model).unwrap();
        let choice = representative(&model, &lattice).unwrap();
        let (unfolded, _) = derive_lattice(&model, &lattice, &choice).unwrap();
        let told = unfolded.warnings.iter().map(|w| w.diagnostic.text());
        told.filter(|t| t.contains("the chain is not periodic"))
            .count()
    };
    assert_eq!(warned(CHAIN), 0);
    assert_eq!(warned(&CHAIN.replace(" periodic;", "")), 1);
}

#[test]
fn a_smoother_without_a_length_smooths_over_alpha() {
    let fluid = |parameter: &str, length: &str| {
        let source = format!(
            "model Fluid {{ time k step dt; label a in 0..N; grid n; {parameter} param m: Real at a; param w: Real at n;
             param c0: Real; given R(Vec<2>): Vec<2> = case; field X: Vec<2> at a on box;
             mesh H: Real at n = deposit(X, m); mesh S: Real at n = smooth(H{length});
             lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) + m*dot(R((X + next(X))/2), next(X) - X)
                 - dt*(c0^2/2)*w*H*S; }}"
        );
        let model = parse_source(&source).unwrap();
        let printed = document::printed_lattice(&model, &source, Format::Text, 100);
        // The text after the statement.
        let text = printed.unwrap().text;
        text.split_once("Sites\n").map(|(_, rest)| rest.to_owned())
    };
    let remark = "/** smoothing length of the depth */ param alpha: Real;";
    let stated = fluid(remark, ", alpha");
    assert!(stated.as_ref().is_some_and(|t| t.contains("smooth(H, α)")));
    for parameter in ["", remark] {
        assert_eq!(fluid(parameter, ""), stated);
    }
}
