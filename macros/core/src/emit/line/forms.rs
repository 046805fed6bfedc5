//! The form in which a kernel of neighbours is computed: numeric factors are collected, common factors are factored
//! out, and the relative rotation or quaternion of two sites is computed once.

use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node};
use std::collections::BTreeMap;

/// The expressions of a kernel, with the values computed before them.
pub(super) struct Forms {
    /// The symbols, including the symbols of relative rotations.
    pub symbols: Symbols,
    /// Rotations or quaternions from the frame of one letter to the frame of another, with their values.
    pub relative: Vec<(SymbolId, Expr)>,
    /// The expressions.
    pub values: Vec<Expr>,
}

/// The product `X^T Y` of two rotations or quaternions in a fixed order, and whether the occurrence is its transpose.
type Pair = ((Letter, Letter), bool);

/// The form of several expressions that are computed together.
pub(super) fn forms(s: &Symbols, values: &[Expr], prefix: &str) -> Forms {
    // Twice, because factoring may produce an outer product, whose axial vector becomes a cross product.
    let once = |e: &Expr| expr::factored(s, e);
    let values: Vec<Expr> = values.iter().map(|e| once(&once(e))).collect();
    let mut met: BTreeMap<(Letter, Letter), usize> = BTreeMap::new();
    for e in &values {
        count(s, e, &mut met);
    }
    let mut symbols = s.clone();
    let mut names: BTreeMap<(Letter, Letter), SymbolId> = BTreeMap::new();
    let mut relative = Vec::new();
    let kept = |pair: &(Letter, Letter), n: usize| n > 1 || is_quaternion(s, &pair.0);
    for (pair, _) in met.into_iter().filter(|(pair, n)| kept(pair, *n)) {
        let [x, y] = [pair.0, pair.1].map(|l| expr::letter(s, l.symbol, l.shift));
        let value = expr::mul(expr::transpose(s, x.clone()), y);
        let name = symbols.fresh_name(&format!("{prefix}{}", relative.len() + 1));
        let structure = s.get(pair.0.symbol).structure;
        let id = symbols.add(&name, x.shape(), structure, Role::Derived);
        names.insert(pair, id);
        relative.push((id, value));
    }
    let values = match names.is_empty() {
        true => values,
        false => {
            let put =
                |e: &Expr| expr::quaternion_components(&symbols, &named_pairs(&symbols, e, &names));
            values.iter().map(put).collect()
        }
    };
    Forms {
        symbols,
        relative,
        values,
    }
}

/// Whether a letter is a unit quaternion. The product of two unit quaternions is not computed as a product of
/// matrices.
fn is_quaternion(s: &Symbols, l: &Letter) -> bool {
    s.get(l.symbol).structure == Structure::UnitQuaternion
}

/// The pair of two adjacent factors, if they form one.
fn pair(s: &Symbols, a: &Expr, b: &Expr) -> Option<Pair> {
    let Node::Transpose(x) = a.node() else {
        return None;
    };
    let (Node::Letter(x), Node::Letter(y)) = (x.node(), b.node()) else {
        return None;
    };
    let [one, other] = [x, y].map(|l| s.get(l.symbol).structure);
    let turns = matches!(one, Structure::Orthogonal | Structure::UnitQuaternion);
    let both = turns && one == other && x != y;
    both.then(|| match x < y {
        true => ((*x, *y), false),
        false => ((*y, *x), true),
    })
}

fn count(s: &Symbols, e: &Expr, met: &mut BTreeMap<(Letter, Letter), usize>) {
    if let Node::Product(factors) = e.node() {
        for two in factors.windows(2) {
            if let Some((which, _)) = pair(s, &two[0], &two[1]) {
                *met.entry(which).or_insert(0) += 1;
            }
        }
    }
    for child in e.children() {
        count(s, child, met);
    }
}

fn named_pairs(s: &Symbols, e: &Expr, names: &BTreeMap<(Letter, Letter), SymbolId>) -> Expr {
    let Node::Product(factors) = e.node() else {
        return expr::rebuild(s, e, &mut |x| named_pairs(s, x, names));
    };
    let mut out: Vec<Expr> = Vec::new();
    let mut i = 0;
    while i < factors.len() {
        let two = factors.get(i + 1).and_then(|b| pair(s, &factors[i], b));
        let known = two.and_then(|(which, turned)| Some((*names.get(&which)?, turned)));
        match known {
            Some((id, turned)) => {
                let r = expr::here(s, id);
                out.push(match turned {
                    true => expr::transpose(s, r),
                    false => r,
                });
                i += 2;
            }
            None => {
                out.push(named_pairs(s, &factors[i], names));
                i += 1;
            }
        }
    }
    expr::product(out)
}
