//! A program: temporaries and results, each an expression in the model's letters and earlier temporaries. The
//! emitted program and the interpreted program are the same.

use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Hashed, Letter, Node, Shift};

/// Temporaries in order of computation, then results.
#[derive(Clone, Debug)]
pub struct Program {
    /// The model's symbols and the temporaries.
    pub symbols: Symbols,
    /// Names and values of the temporaries.
    pub temporaries: Vec<(SymbolId, Expr)>,
    /// The results, in the requested order.
    pub results: Vec<Expr>,
}

impl Program {
    /// An empty program.
    pub fn none(symbols: &Symbols) -> Program {
        Program {
            symbols: symbols.clone(),
            temporaries: Vec::new(),
            results: Vec::new(),
        }
    }
}

/// Schedules several results together. `prefix` starts the names of temporaries.
pub fn program(symbols: &Symbols, results: &[Expr], prefix: &str) -> Program {
    // Results are in increment form, so that they lose no digits at small velocities. The determinant of a product is
    // expressed by the determinants of its factors.
    let results: Vec<Expr> = results
        .iter()
        .map(|r| {
            super::increment_form::displaced(symbols, &expr::with_plain_determinants(symbols, r))
        })
        .collect();
    let results = super::inverses::by_adjugates(symbols, &results);
    let results = super::collected::collected(symbols, &results);
    let results = super::transposed::aligned(symbols, &results);
    super::pairs::paired(symbols, &results, prefix)
}

/// Schedules results that may use the temporaries of an earlier program, which are not computed again.
pub fn program_after(earlier: &Program, results: &[Expr], prefix: &str) -> Program {
    let symbols = &earlier.symbols;
    let mut program = program(symbols, results, prefix);
    let mut whole: Vec<(Letter, Expr)> = Vec::new();
    let mut expanded = |symbols: &Symbols, id: SymbolId, e: &Expr| {
        let value = expr::substitute(symbols, e, &whole);
        whole.push((at(id), value.clone()));
        value
    };
    let mut known: Hashed<SymbolId> = Hashed::default();
    for (id, e) in &earlier.temporaries {
        known.insert(expanded(symbols, *id, e), *id);
    }
    let mut again: Vec<(Letter, Expr)> = Vec::new();
    let mut fresh = Vec::new();
    for (id, e) in &program.temporaries {
        match known.get(&expanded(&program.symbols, *id, e)) {
            Some(first) => again.push((at(*id), expr::here(symbols, *first))),
            None => fresh.push((*id, e.clone())),
        }
    }
    if !again.is_empty() {
        let told = |e: &Expr| expr::substitute(&program.symbols, e, &again);
        program.results = program.results.iter().map(told).collect();
        program.temporaries = fresh.iter().map(|(id, e)| (*id, told(e))).collect();
    }
    program
}

fn at(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

/// The program of results that are written in the names of `before`; these names are computed in the given order.
pub(super) fn scheduled(
    symbols: &Symbols,
    before: &[(SymbolId, Expr)],
    results: &[Expr],
    prefix: &str,
) -> Program {
    let mut uses: Hashed<usize> = Hashed::default();
    for e in before.iter().map(|(_, e)| e).chain(results) {
        count(symbols, e, &mut uses);
    }
    let mut build = Build {
        symbols: symbols.clone(),
        uses,
        done: Hashed::default(),
        temporaries: Vec::new(),
        named: before.len(),
        prefix,
    };
    for (id, e) in before {
        let value = build.rewrite(e);
        build.temporaries.push((*id, value));
    }
    let results = results.iter().map(|r| build.rewrite(r)).collect();
    Program {
        symbols: build.symbols,
        temporaries: build.temporaries,
        results,
    }
}

/// Counts the occurrences of each subexpression, visiting it once per parent.
fn count(symbols: &Symbols, e: &Expr, uses: &mut Hashed<usize>) {
    let n = uses.entry(e.clone()).or_insert(0);
    *n += 1;
    if *n == 1 && !super::increment_form::stays_whole(symbols, e) {
        e.children()
            .into_iter()
            .for_each(|c| count(symbols, c, uses));
    }
}

/// Whether computing the expression twice costs anything.
fn is_work(e: &Expr) -> bool {
    match e.node() {
        Node::Number(_)
        | Node::Constant(_)
        | Node::Letter(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Hat(_) => false,
        Node::Neg(a) | Node::Transpose(a) => is_work(a),
        Node::Power(a, q) => q.as_integer() != Some(2) || is_work(a),
        Node::Sum(_)
        | Node::Product(_)
        | Node::Quotient(..)
        | Node::Inverse(_)
        | Node::Trace(_)
        | Node::Det(_)
        | Node::Adjugate(_)
        | Node::Dot(..)
        | Node::Cross(..)
        | Node::Vee(_)
        | Node::Part(..)
        | Node::Call(..)
        | Node::Map(..)
        | Node::Given(_)
        | Node::PullBack(..) => true,
    }
}

/// Whether it needs its own temporary: a functional is computed once for each list of arguments, and other
/// expressions use its name.
fn is_stage(e: &Expr) -> bool {
    matches!(e.node(), Node::Given(_) | Node::PullBack(..))
}

struct Build<'a> {
    symbols: Symbols,
    uses: Hashed<usize>,
    done: Hashed<Expr>,
    temporaries: Vec<(SymbolId, Expr)>,
    /// The number of names so far.
    named: usize,
    prefix: &'a str,
}

impl Build<'_> {
    fn rewrite(&mut self, e: &Expr) -> Expr {
        if let Some(known) = self.done.get(e) {
            return known.clone();
        }
        // Children first: they may add temporaries, which the rebuilding must know.
        let inner = match super::increment_form::stays_whole(&self.symbols, e) {
            true => e.clone(),
            false => {
                for c in e.children() {
                    self.rewrite(c);
                }
                let done = &self.done;
                expr::rebuild(&self.symbols, e, &mut |c| {
                    done.get(c).cloned().unwrap_or_else(|| c.clone())
                })
            }
        };
        let shared = self.uses.get(e).is_some_and(|n| *n > 1) && is_work(e);
        let out = if shared || is_stage(e) {
            self.named += 1;
            let name = self
                .symbols
                .fresh_name(&format!("{}{}", self.prefix, self.named));
            let structure = crate::expr::shape::Structure::General;
            let id = self.symbols.add(&name, e.shape(), structure, Role::Derived);
            self.temporaries.push((id, inner));
            expr::here(&self.symbols, id)
        } else {
            inner
        };
        self.done.insert(e.clone(), out.clone());
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Dim, Shape, Structure};

    #[test]
    fn what_is_known_is_not_computed_again() {
        let mut symbols = Symbols::default();
        let three = Shape::square(Dim::Fixed(3));
        let mut letter = |name: &str| {
            let id = symbols.add(name, three, Structure::General, Role::Derived);
            expr::here(&symbols, id)
        };
        let (a, b) = (letter("A"), letter("B"));
        let product = expr::mul(a.clone(), b.clone());
        let force = expr::sum(
            [expr::mul(product.clone(), product.clone()), product.clone()],
            three,
        );
        let first = program(&symbols, std::slice::from_ref(&force), "b");
        assert_eq!(first.temporaries.len(), 1);
        let other = expr::sum([expr::mul(product.clone(), a), product.clone(), b], three);
        let second = program_after(&first, std::slice::from_ref(&other), "t");
        // A B has a name from the first program; without that program it gets a new name.
        assert!(second.temporaries.is_empty());
        assert_eq!(program(&symbols, &[other], "t").temporaries.len(), 1);
        let [(known, _)] = first.temporaries.as_slice() else {
            panic!("one name")
        };
        let letters = expr::letters(&second.results[0]);
        assert!(letters.iter().any(|l| l.symbol == *known));
    }
}
