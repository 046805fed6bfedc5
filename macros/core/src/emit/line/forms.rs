//! The form in which a kernel of neighbours is computed: numbers gathered, common factors taken out,
//! the rotation from one site to the next made once.

use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node};
use std::collections::BTreeMap;

/// Expressions of a kernel with what is made before them.
pub(super) struct Forms {
    /// The symbols, those of relative rotations among them.
    pub symbols: Symbols,
    /// Rotations from the frame of one letter to that of another, with their values.
    pub relative: Vec<(SymbolId, Expr)>,
    /// The expressions.
    pub values: Vec<Expr>,
}

/// The pair `X^T Y` of two rotations in one order, and whether that is transposed.
type Pair = ((Letter, Letter), bool);

/// The form of several expressions that are computed together.
pub(super) fn forms(s: &Symbols, values: &[Expr], prefix: &str) -> Forms {
    // Twice: what comes out of a bracket may be an outer product, whose axial vector is a cross product.
    let once = |e: &Expr| expr::factored(s, e);
    let values: Vec<Expr> = values.iter().map(|e| once(&once(e))).collect();
    let mut met: BTreeMap<(Letter, Letter), usize> = BTreeMap::new();
    for e in &values {
        count(s, e, &mut met);
    }
    let mut symbols = s.clone();
    let mut names: BTreeMap<(Letter, Letter), SymbolId> = BTreeMap::new();
    let mut relative = Vec::new();
    for (pair, _) in met.into_iter().filter(|(_, n)| *n > 1) {
        let [x, y] = [pair.0, pair.1].map(|l| expr::letter(s, l.symbol, l.shift));
        let value = expr::mul(expr::transpose(s, x.clone()), y);
        let name = symbols.fresh_name(&format!("{prefix}{}", relative.len() + 1));
        let id = symbols.add(&name, x.shape(), Structure::Orthogonal, Role::Derived);
        names.insert(pair, id);
        relative.push((id, value));
    }
    let values = match names.is_empty() {
        true => values,
        false => values.iter().map(|e| put(&symbols, e, &names)).collect(),
    };
    Forms {
        symbols,
        relative,
        values,
    }
}

/// Whether two factors side by side are such a pair.
fn pair(s: &Symbols, a: &Expr, b: &Expr) -> Option<Pair> {
    let Node::Transpose(x) = a.node() else {
        return None;
    };
    let (Node::Letter(x), Node::Letter(y)) = (x.node(), b.node()) else {
        return None;
    };
    let turns = |l: &Letter| s.get(l.symbol).structure == Structure::Orthogonal;
    let both = turns(x) && turns(y) && x != y;
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

fn put(s: &Symbols, e: &Expr, names: &BTreeMap<(Letter, Letter), SymbolId>) -> Expr {
    let Node::Product(factors) = e.node() else {
        return expr::rebuild(s, e, &mut |x| put(s, x, names));
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
                out.push(put(s, &factors[i], names));
                i += 1;
            }
        }
    }
    expr::product(out)
}
