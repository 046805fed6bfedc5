//! The laws of the table: all fields of a record describe the same group, given the inclusion of its Lie algebra into
//! matrices. A new line of the table is tested automatically.

use super::{Group, TABLE};
use crate::algebra::exact::vanishes;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr};

/// Letters of a group.
struct Letters {
    symbols: Symbols,
    element: SymbolId,
    matrix: SymbolId,
    covector: SymbolId,
    along: [SymbolId; 2],
    rate: SymbolId,
}

fn letters(group: Group) -> Letters {
    let mut symbols = Symbols::default();
    let mut add = |name: &str, (shape, structure): (Shape, Structure)| {
        symbols.add(name, shape, structure, Role::Parameter)
    };
    let whole = (group.shape(), Structure::General);
    Letters {
        element: add("g", (group.shape(), group.structure())),
        matrix: add("Y", whole),
        covector: add("m", group.dual()),
        along: [add("x", group.variation()), add("y", group.variation())],
        rate: add("z", group.dual()),
        symbols,
    }
}

/// The groups of the table; groups of any size in two to four dimensions.
fn groups() -> Vec<Group> {
    let sizes = |line: &super::Line| match line.size {
        Some(n) => vec![n],
        None => vec![2, 3, 4],
    };
    let lines = TABLE.iter();
    lines
        .flat_map(|line| sizes(line).into_iter().map(|n| (line.group)(Dim::Fixed(n))))
        .collect()
}

/// `tr(A^T B)`.
fn paired(s: &Symbols, a: &Expr, b: Expr) -> Expr {
    expr::trace(expr::mul(expr::transpose(s, a.clone()), b))
}

fn commutator(a: &Expr, b: &Expr) -> Expr {
    expr::sub(
        expr::mul(a.clone(), b.clone()),
        expr::mul(b.clone(), a.clone()),
    )
}

#[test]
fn covectors_brackets_and_coadjoint_actions_follow_from_the_inclusion() {
    let mut tested = 0;
    for group in groups() {
        let l = letters(group);
        let s = &l.symbols;
        let at = |id| expr::here(s, id);
        let (g, matrix, mu) = (at(l.element), at(l.matrix), at(l.covector));
        let [x, y] = l.along.map(at);
        let (ex, ey) = (group.element(x.clone()), group.element(y.clone()));
        let m = group.covector(s, matrix.clone());
        let rate = group.rate(at(l.rate));
        let seen = expr::product([expr::inverse(s, g.clone()), ex.clone(), g.clone()]);
        let laws = [
            (
                "covector",
                group.pairing(s, m.clone(), x.clone()),
                paired(s, &matrix, ex.clone()),
            ),
            (
                "bracket",
                group.bracket(s, m.clone(), x.clone(), y.clone()),
                paired(s, &matrix, commutator(&ex, &ey)),
            ),
            (
                "Ad*",
                group.pairing(s, group.to_space(s, &g, m), x.clone()),
                paired(s, &matrix, seen),
            ),
            (
                "ad*",
                group.pairing(s, group.coadjoint(s, mu.clone(), at(l.rate)), x.clone()),
                group.bracket(s, mu, rate, x),
            ),
        ];
        for (law, left, right) in laws {
            assert!(
                vanishes(s, &expr::sub(left.clone(), right)),
                "{law} of {group:?}"
            );
            assert!(
                !vanishes(s, &left) || group.shape().rows == Dim::Fixed(2),
                "{law} of {group:?}"
            );
            tested += 1;
        }
    }
    assert!(tested >= 36, "{tested}");
}

#[test]
fn families_have_all_sizes_or_those_of_the_table() {
    for (family, few) in [
        ("SO", false),
        ("GL", false),
        ("SU", true),
        ("SE", true),
        ("SP", false),
    ] {
        assert_eq!(super::has_few_sizes(family), few, "{family}");
    }
}
