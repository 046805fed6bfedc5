//! Parts of an equation that do not depend on the unknowns: they are computed once, before the solution. Takes
//! expressions and the letters that vary; gives names for the constant parts, and the expressions in these names.

use crate::algebra::Rational;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node};

/// Names and values of the constant parts, in order of occurrence.
pub struct LoopInvariants<'a> {
    /// The symbols, including the names.
    pub symbols: Symbols,
    /// The names and their values.
    pub values: Vec<(SymbolId, Expr)>,
    varies: &'a dyn Fn(Letter) -> bool,
    prefix: &'a str,
}

impl<'a> LoopInvariants<'a> {
    /// No names yet. `prefix` starts the names.
    pub fn new(symbols: &Symbols, varies: &'a dyn Fn(Letter) -> bool, prefix: &'a str) -> Self {
        LoopInvariants {
            symbols: symbols.clone(),
            values: Vec::new(),
            varies,
            prefix,
        }
    }

    fn is_known(&self, e: &Expr) -> bool {
        expr::letters(e).iter().all(|l| !(self.varies)(*l))
    }

    /// The expression with its constant parts replaced by names.
    pub fn apart(&mut self, e: &Expr) -> Expr {
        if self.is_known(e) {
            return self.named(e);
        }
        if let Node::Product(factors) = e.node() {
            return self.product(factors);
        }
        if let Node::Sum(terms) = e.node() {
            let (known, rest): (Vec<Expr>, Vec<Expr>) =
                terms.iter().cloned().partition(|t| self.is_known(t));
            let rest: Vec<Expr> = rest.iter().map(|t| self.apart(t)).collect();
            let known = match known.is_empty() {
                true => None,
                false => Some(self.named(&expr::sum(known, e.shape()))),
            };
            return expr::sum(rest.into_iter().chain(known), e.shape());
        }
        let children: Vec<Expr> = e.children().into_iter().cloned().collect();
        let apart: Vec<(Expr, Expr)> = children
            .into_iter()
            .map(|c| {
                let a = self.apart(&c);
                (c, a)
            })
            .collect();
        expr::rebuild(&self.symbols, e, &mut |x| {
            let found = apart.iter().find(|(c, _)| c == x);
            found.map_or_else(|| x.clone(), |(_, a)| a.clone())
        })
    }

    /// Combines scalars, and adjacent matrices.
    fn product(&mut self, factors: &[Expr]) -> Expr {
        let mut numbers = Vec::new();
        let mut rest = Vec::new();
        let mut word: Vec<Expr> = Vec::new();
        for f in factors {
            match (self.is_known(f), f.shape().is_scalar()) {
                (true, true) => numbers.push(f.clone()),
                (true, false) => word.push(f.clone()),
                (false, _) => {
                    self.close(&mut word, &mut rest);
                    rest.push(self.apart(f));
                }
            }
        }
        self.close(&mut word, &mut rest);
        // Twice an axial vector is the axial vector of a difference, which costs less than the axial vector itself.
        let axial = rest.len() == 1 && matches!(rest[0].node(), Node::Vee(_));
        if axial && !numbers.is_empty() {
            numbers.push(expr::number(Rational::HALF));
            rest.push(expr::integer(2));
        }
        let number = expr::product(numbers);
        if !matches!(number.node(), Node::Number(q) if q.is_one()) {
            rest.insert(0, self.named(&number));
        }
        expr::product(rest)
    }

    fn close(&mut self, word: &mut Vec<Expr>, rest: &mut Vec<Expr>) {
        if !word.is_empty() {
            rest.push(self.named(&expr::product(std::mem::take(word))));
        }
    }

    fn named(&mut self, e: &Expr) -> Expr {
        let plain = match e.node() {
            Node::Number(_)
            | Node::Constant(_)
            | Node::Letter(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..) => true,
            Node::Transpose(a) => matches!(a.node(), Node::Letter(_) | Node::Inclusion(..)),
            _ => false,
        };
        if plain {
            return e.clone();
        }
        match e.node() {
            Node::Neg(a) => return expr::neg(self.named(a)),
            // Products with a hat are vector products.
            Node::Hat(v) => return expr::hat(self.named(v)),
            _ => {}
        }
        let known = self.values.iter().find(|(_, value)| value == e);
        let id = match known {
            Some((id, _)) => *id,
            None => {
                let name = format!("{}{}", self.prefix, self.values.len() + 1);
                let name = self.symbols.fresh_name(&name);
                let id = self
                    .symbols
                    .add(&name, e.shape(), Structure::General, Role::Derived);
                self.values.push((id, e.clone()));
                id
            }
        };
        expr::here(&self.symbols, id)
    }
}
