//! Products of two matrices that occur in several other products: computed once, they shorten all of these. Takes
//! expressions that are computed together; gives names for such pairs and the remaining expressions.

use super::program::{Program, scheduled};
use super::work;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Exprs, Hashed, Node};
use std::collections::{HashMap, HashSet};

/// The largest number of pairs that are tried.
const TRIED: usize = 12;

/// The program with the pairs that reduce the work.
pub(super) fn paired(symbols: &Symbols, results: &[Expr], prefix: &str) -> Program {
    let mut best = Pairs {
        symbols: symbols.clone(),
        list: Vec::new(),
        results: results.to_vec(),
    };
    let mut program = scheduled(&best.symbols, &best.list, &best.results, prefix);
    let mut refused: HashSet<[Expr; 2]> = HashSet::new();
    for _ in 0..TRIED {
        let Some(pair) = best.most_frequent(&refused) else {
            break;
        };
        let tried = best.with(&pair, prefix);
        let other = scheduled(&tried.symbols, &tried.list, &tried.results, prefix);
        match work(&other) < work(&program) {
            true => (best, program) = (tried, other),
            false => {
                refused.insert(pair);
            }
        }
    }
    program
}

/// Named pairs in order of computation, and the expressions in these names.
struct Pairs {
    symbols: Symbols,
    list: Vec<(SymbolId, Expr)>,
    results: Vec<Expr>,
}

impl Pairs {
    fn all(&self) -> impl Iterator<Item = &Expr> {
        self.list.iter().map(|(_, e)| e).chain(&self.results)
    }

    /// The most frequent pair; the first one of several.
    fn most_frequent(&self, refused: &HashSet<[Expr; 2]>) -> Option<[Expr; 2]> {
        let mut found = PairCounts {
            symbols: &self.symbols,
            met: Exprs::default(),
            order: Vec::new(),
            counts: HashMap::new(),
        };
        self.all().for_each(|e| found.visit(e));
        let PairCounts { order, counts, .. } = found;
        let mut most: Option<(usize, [Expr; 2])> = None;
        for pair in order {
            let count = counts.get(&pair).copied().unwrap_or(0);
            let more = most.as_ref().is_none_or(|(known, _)| count > *known);
            if count > 1 && more && !refused.contains(&pair) {
                most = Some((count, pair));
            }
        }
        most.map(|(_, pair)| pair)
    }

    /// Replaces a pair or its transpose by a name, wherever it occurs.
    fn with(&self, pair: &[Expr; 2], prefix: &str) -> Pairs {
        let mut symbols = self.symbols.clone();
        let [left, right] = pair;
        let value = expr::mul(left.clone(), right.clone());
        let name = symbols.fresh_name(&format!("{prefix}{}", self.list.len() + 1));
        let id = symbols.add(&name, value.shape(), Structure::General, Role::Derived);
        let named = expr::here(&symbols, id);
        let mut put = PairReplacement {
            symbols: &symbols,
            turned: turned(&symbols, pair),
            pair,
            named: [named.clone(), expr::transpose(&symbols, named)],
            done: Hashed::default(),
        };
        let mut list: Vec<(SymbolId, Expr)> = Vec::new();
        for (known, e) in &self.list {
            list.push((*known, put.put(e)));
        }
        let results = self.results.iter().map(|e| put.put(e)).collect();
        // Before the first name that uses it.
        let uses = |e: &Expr| expr::letters(e).iter().any(|l| l.symbol == id);
        let first = list.iter().position(|(_, e)| uses(e));
        list.insert(first.unwrap_or(list.len()), (id, value));
        Pairs {
            list,
            results,
            symbols,
        }
    }
}

/// The transpose of a pair, as a pair.
fn turned(symbols: &Symbols, [left, right]: &[Expr; 2]) -> [Expr; 2] {
    [right, left].map(|e| expr::transpose(symbols, e.clone()))
}

/// Whether it is a square matrix with a name.
fn is_named(e: &Expr) -> bool {
    let letter = |e: &Expr| matches!(e.node(), Node::Letter(_));
    let plain = match e.node() {
        Node::Transpose(a) | Node::Inverse(a) => letter(a),
        _ => letter(e),
    };
    plain && e.shape().is_square() && !e.shape().is_scalar()
}

struct PairCounts<'a> {
    symbols: &'a Symbols,
    met: Exprs,
    order: Vec<[Expr; 2]>,
    counts: HashMap<[Expr; 2], usize>,
}

impl PairCounts<'_> {
    fn visit(&mut self, e: &Expr) {
        if super::increment_form::stays_whole(self.symbols, e) || !self.met.insert(e.clone()) {
            return;
        }
        e.children().into_iter().for_each(|c| self.visit(c));
        let Node::Product(factors) = e.node() else {
            return;
        };
        let mut last: Option<(usize, [Expr; 2])> = None;
        for (i, two) in factors.windows(2).enumerate() {
            let [left, right] = two else { continue };
            if !is_named(left) || !is_named(right) {
                continue;
            }
            let pair = [left.clone(), right.clone()];
            let turned = turned(self.symbols, &pair);
            let pair = match self.counts.contains_key(&turned) {
                true => turned,
                false => pair,
            };
            // Two that share a factor cannot both be replaced.
            if last
                .as_ref()
                .is_some_and(|(at, known)| at + 1 == i && *known == pair)
            {
                continue;
            }
            last = Some((i, pair.clone()));
            match self.counts.get_mut(&pair) {
                Some(count) => *count += 1,
                None => {
                    self.order.push(pair.clone());
                    self.counts.insert(pair, 1);
                }
            }
        }
    }
}

struct PairReplacement<'a> {
    symbols: &'a Symbols,
    pair: &'a [Expr; 2],
    turned: [Expr; 2],
    /// The name, and its transpose.
    named: [Expr; 2],
    done: Hashed<Expr>,
}

impl PairReplacement<'_> {
    fn put(&mut self, e: &Expr) -> Expr {
        if let Some(known) = self.done.get(e) {
            return known.clone();
        }
        let inner = super::increment_form::rebuilt(self.symbols, e, &mut |c| self.put(c));
        let out = match inner.node() {
            Node::Product(factors) => expr::product(self.replaced(factors)),
            _ => inner,
        };
        self.done.insert(e.clone(), out.clone());
        out
    }

    fn replaced(&self, factors: &[Expr]) -> Vec<Expr> {
        let mut out = Vec::with_capacity(factors.len());
        let mut rest = factors;
        while let Some((first, others)) = rest.split_first() {
            let is = |pair: &[Expr; 2]| *first == pair[0] && others.first() == Some(&pair[1]);
            let [named, transposed] = &self.named;
            let name = match (is(self.pair), is(&self.turned)) {
                (true, _) => Some(named),
                (false, true) => Some(transposed),
                (false, false) => None,
            };
            match name {
                Some(name) => {
                    out.push(name.clone());
                    rest = others.get(1..).unwrap_or(&[]);
                }
                None => {
                    out.push(first.clone());
                    rest = others;
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Dim, Shape};

    #[test]
    fn a_product_within_several_is_formed_once() {
        let mut symbols = Symbols::default();
        let three = Shape::square(Dim::Fixed(3));
        let mut letter = |name: &str, shape| {
            let id = symbols.add(name, shape, Structure::General, Role::Derived);
            expr::here(&symbols, id)
        };
        let (q, c) = (letter("Q", three), letter("C", three));
        let (u, v) = (
            letter("u", Shape::vector(Dim::Fixed(3))),
            letter("v", Shape::vector(Dim::Fixed(3))),
        );
        let of = |list: &[Expr]| work(&super::super::program(&symbols, list, "t"));
        let turn = |e: &Expr| expr::transpose(&symbols, e.clone());
        let metric = expr::product([turn(&q), c.clone(), q.clone()]);
        let square = expr::mul(metric.clone(), metric.clone());
        let force = expr::product([c.clone(), q.clone(), metric.clone()]);
        // C Q, then Q^T C Q, its square, and C Q (Q^T C Q): four products instead of eleven.
        assert_eq!(of(&[metric.clone(), square, force]), 4 * 45);
        // Repeated within a single expression.
        assert_eq!(
            of(&[expr::product([q.clone(), c.clone(), q.clone(), c.clone()])]),
            2 * 45
        );
        // For vectors, one matrix after the other is multiplied.
        let images = [u, v].map(|x| expr::product([c.clone(), q.clone(), x]));
        assert_eq!(of(&images), 4 * 15);
        // The transpose of a pair counts as that pair.
        let both = [
            expr::product([c.clone(), q.clone(), c.clone()]),
            expr::product([turn(&q), turn(&c), q.clone()]),
        ];
        assert_eq!(of(&both), 3 * 45);
    }
}
