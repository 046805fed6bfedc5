//! Keeps the names of the model's `let` statements in print. A value is recognised if it occurs literally, shifted in
//! time, transposed, or distributed over the terms of a sum, as in `M a/2 + M b/2` for `u = a + b`. Each replacement
//! is proved before it is printed.

use crate::algebra::{Algebra, Rational};
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node, Shift};

/// Expressions with more nodes than this are not searched for names.
const LARGEST: u32 = 4_000;

/// A name and its value.
struct Let {
    symbol: SymbolId,
    value: Expr,
    patterns: Vec<Pattern>,
}

/// How a value occurs in expressions: its terms, the longest first, and the name that replaces them.
struct Pattern {
    terms: Vec<(Rational, Expr)>,
    /// Base and exponent, if the value is a power.
    power: Option<(Expr, Rational)>,
    name: Expr,
}

/// The names of a model.
#[derive(Default)]
pub struct Lets {
    list: Vec<Let>,
}

impl Lets {
    /// Adds a name for a value in the letters of the page, unless the value is as short as a name.
    pub fn name(&mut self, symbols: &mut Symbols, name: &str, value: &Expr) {
        let value = expr::shown(symbols, &self.named(symbols, value));
        if value.size() <= 2 {
            return;
        }
        let letters = expr::letters(&value);
        // A value that contains both ends of a step belongs to the declared model; the printed equations use
        // velocities instead.
        let ends =
            |l: &Letter| symbols.get(l.symbol).role == Role::Element && l.shift != Shift::HERE;
        if letters.iter().any(ends) {
            return;
        }
        let moves = letters.iter().any(|l| {
            let role = symbols.get(l.symbol).role;
            !matches!(role, Role::Step | Role::Parameter | Role::Variation)
        });
        let role = if moves {
            Role::Derived
        } else {
            Role::Parameter
        };
        let name = symbols.fresh_name(name);
        let turned = expr::shown(symbols, &expr::transpose(symbols, value.clone()));
        let structure =
            match turned == value && value.shape().is_square() && !value.shape().is_scalar() {
                true => Structure::Symmetric,
                false => Structure::General,
            };
        let symbol = symbols.add(&name, value.shape(), structure, role);
        let shifts: &[i8] = if moves { &[0, 1, -1] } else { &[0] };
        let mut patterns = Vec::new();
        for by in shifts {
            let shift = Shift {
                time: *by,
                ..Shift::HERE
            };
            let own = expr::letter(symbols, symbol, shift);
            let shifted = expr::shift_time(symbols, &value, *by);
            patterns.push(pattern(symbols, &shifted, own.clone()));
            if !value.shape().is_scalar() {
                let turned = expr::transpose(symbols, shifted);
                patterns.push(pattern(symbols, &turned, expr::transpose(symbols, own)));
            }
        }
        self.list.push(Let {
            symbol,
            value,
            patterns,
        });
    }

    /// Substitutes the names in an expression.
    pub fn named(&self, symbols: &Symbols, e: &Expr) -> Expr {
        if e.size() > LARGEST {
            return e.clone();
        }
        let mut out = e.clone();
        for one in &self.list {
            for pattern in &one.patterns {
                let tried = pattern.put(symbols, &out);
                if tried != out && self.is_equal(symbols, &out, &tried) {
                    out = tried;
                }
            }
        }
        out
    }

    /// Whether two expressions are equal after names are replaced by their values.
    fn is_equal(&self, symbols: &Symbols, a: &Expr, b: &Expr) -> bool {
        let written_out = |e: &Expr| self.written_out(symbols, e);
        Algebra::new(symbols).equal(&written_out(a), &written_out(b))
    }

    /// Replaces the names in an expression by their values.
    pub fn written_out(&self, symbols: &Symbols, e: &Expr) -> Expr {
        let mut out = e.clone();
        // Later names may contain earlier ones.
        for one in self.list.iter().rev() {
            let places = expr::letters(&out).into_iter();
            let places = places.filter(|at| at.symbol == one.symbol);
            let values: Vec<(Letter, Expr)> = places
                .map(|at| (at, expr::shift_time(symbols, &one.value, at.shift.time)))
                .collect();
            out = expr::substitute(symbols, &out, &values);
        }
        out
    }

    /// The value of a name.
    pub fn value(&self, symbol: SymbolId) -> Option<&Expr> {
        let found = self.list.iter().find(|one| one.symbol == symbol)?;
        Some(&found.value)
    }
}

fn pattern(symbols: &Symbols, value: &Expr, name: Expr) -> Pattern {
    let terms = match expr::shown(symbols, value).node() {
        Node::Sum(terms) => terms.clone(),
        _ => vec![value.clone()],
    };
    let mut terms: Vec<(Rational, Expr)> = terms.iter().map(expr::coefficient).collect();
    // A sum with a numerical factor: `(a + b)/2`.
    if let [(c, core)] = terms.as_slice()
        && let Node::Sum(inner) = core.node()
    {
        let scaled = inner.iter().map(|t| {
            let (q, t) = expr::coefficient(t);
            Some((c.times(q)?, t))
        });
        terms = scaled.collect::<Option<_>>().unwrap_or(terms);
    }
    terms.sort_by_key(|(_, t)| std::cmp::Reverse(t.size()));
    let power = match value.node() {
        Node::Power(base, q) => Some((base.clone(), *q)),
        _ => None,
    };
    Pattern { terms, power, name }
}

impl Pattern {
    /// Whether the letters of the value can all occur in the expression.
    fn may_stand_in(&self, e: &Expr) -> bool {
        self.terms.iter().all(|(_, term)| expr::may_hold(e, term))
    }

    /// Substitutes the name wherever all terms of the value occur in one context.
    fn put(&self, symbols: &Symbols, e: &Expr) -> Expr {
        if !self.may_stand_in(e) {
            return e.clone();
        }
        if let Some(power) = self.power_of_name(e) {
            return power;
        }
        let e = expr::rebuild(symbols, e, &mut |x| self.put(symbols, x));
        match self.terms.as_slice() {
            [(c, only)] => {
                let e = self.alone(symbols, &e, *c, only);
                self.in_trace(symbols, &e, *c, only)
            }
            _ => match e.node() {
                Node::Sum(terms) => self.in_sum(symbols, &e, terms),
                _ => e,
            },
        }
    }

    /// If the expression is a whole power of the name, that power: `(x·x)^{3/2}` is `r^3` for `r = |x|`.
    fn power_of_name(&self, e: &Expr) -> Option<Expr> {
        let (base, q) = self.power.as_ref()?;
        let own = match e.node() {
            Node::Power(a, own) if a == base => *own,
            _ if e == base => Rational::ONE,
            _ => return None,
        };
        let times = own.times(q.inverse()?)?;
        times.as_integer()?;
        Some(expr::power(self.name.clone(), times))
    }

    /// Substitutes a value of one term within a trace, whose factors may be cyclically permuted: `tr(C Q Q^T)`
    /// contains `Q^T C Q`.
    fn in_trace(&self, symbols: &Symbols, e: &Expr, c: Rational, only: &Expr) -> Expr {
        let mut out = e.clone();
        // Each replacement leaves fewer factors, so that the loop ends.
        while let Some(shorter) = self.turned_in_trace(symbols, &out, c, only) {
            out = shorter;
        }
        out
    }

    fn turned_in_trace(
        &self,
        symbols: &Symbols,
        e: &Expr,
        c: Rational,
        only: &Expr,
    ) -> Option<Expr> {
        let Node::Trace(inner) = e.node() else {
            return None;
        };
        let Node::Product(list) = inner.node() else {
            return None;
        };
        let scalar = |f: &Expr| f.shape().is_scalar();
        let (numbers, word): (Vec<Expr>, Vec<Expr>) = list.iter().cloned().partition(scalar);
        (0..word.len()).find_map(|from| {
            let (behind, before) = word.split_at_checked(from)?;
            let turned = expr::product(before.iter().chain(behind).cloned());
            let named = self.alone(symbols, &turned, c, only);
            let own = numbers.iter().cloned().chain([named.clone()]);
            (named.size() < turned.size()).then(|| expr::trace(expr::product(own)))
        })
    }

    /// Rewrites `v·(A^T w)` or `(A^T w)·v` as `u·w`, where the name `u` stands for `A v`.
    fn paired(&self, symbols: &Symbols, e: &Expr) -> Option<Expr> {
        let ([(c, only)], Node::Dot(a, b)) = (self.terms.as_slice(), e.node()) else {
            return None;
        };
        let Node::Product(word) = only.node() else {
            return None;
        };
        let (v, turn) = word.split_last()?;
        if !c.is_one() || !v.shape().is_vector() || word.iter().any(|f| f.shape().is_scalar()) {
            return None;
        }
        let back = turn.iter().rev();
        let back: Vec<Expr> = back.map(|f| expr::transpose(symbols, f.clone())).collect();
        let rest = |of: &Expr| match of.node() {
            Node::Product(list) => {
                let rest = list.strip_prefix(back.as_slice())?;
                (!rest.is_empty()).then(|| expr::product(rest.iter().cloned()))
            }
            _ => None,
        };
        match (a == v, b == v) {
            (true, _) => Some(expr::dot(self.name.clone(), rest(b)?)),
            (_, true) => Some(expr::dot(rest(a)?, self.name.clone())),
            _ => None,
        }
    }

    /// Substitutes a value of one term.
    fn alone(&self, symbols: &Symbols, e: &Expr, c: Rational, only: &Expr) -> Expr {
        if let Some(paired) = self.paired(symbols, e) {
            return paired;
        }
        let whole = Context::of(e, only).into_iter().find(|found| found.at_root);
        match (whole, c.inverse()) {
            (Some(found), Some(q)) => {
                let name = expr::scale(q, self.name.clone());
                expr::shown(symbols, &found.with(symbols, &name))
            }
            _ => e.clone(),
        }
    }

    /// Substitutes a value of several terms within a sum.
    fn in_sum(&self, symbols: &Symbols, e: &Expr, terms: &[Expr]) -> Expr {
        let mut terms: Vec<(Rational, Expr)> = terms.iter().map(expr::coefficient).collect();
        let mut at = 0;
        while let Some((q, core)) = terms.get(at).cloned() {
            match self.matched(symbols, &terms, at, q, &core) {
                Some((used, new)) => {
                    let mut kept = Vec::new();
                    for (i, term) in terms.into_iter().enumerate() {
                        if i == at {
                            kept.push(expr::coefficient(&new));
                        } else if !used.contains(&i) {
                            kept.push(term);
                        }
                    }
                    terms = kept;
                    at = 0;
                }
                None => at += 1,
            }
        }
        let list = terms.into_iter().map(|(q, core)| expr::scale(q, core));
        expr::sum(list.collect::<Vec<_>>(), e.shape())
    }

    /// The terms that together with this term form the value in some context, and that context applied to the name.
    fn matched(
        &self,
        symbols: &Symbols,
        terms: &[(Rational, Expr)],
        at: usize,
        q: Rational,
        core: &Expr,
    ) -> Option<(Vec<usize>, Expr)> {
        let ((first, longest), others) = self.terms.split_first()?;
        'contexts: for found in Context::of(core, longest) {
            let put = |x: &Expr| expr::coefficient(&expr::shown(symbols, &found.with(symbols, x)));
            let (own, again) = put(longest);
            if again != *core {
                continue;
            }
            let mut used = vec![at];
            for (c, other) in others {
                let (sign, wanted) = put(other);
                let ratio = c.times(first.inverse()?)?;
                let weight = q.times(ratio)?.times(sign)?.times(own.inverse()?)?;
                let same = |(i, (w, t)): (usize, &(Rational, Expr))| {
                    !used.contains(&i) && *w == weight && *t == wanted
                };
                match (0..terms.len()).zip(terms).position(same) {
                    Some(i) => used.push(i),
                    None => continue 'contexts,
                }
            }
            let scale = q.times(first.inverse()?)?.times(own.inverse()?)?;
            let new = expr::scale(scale, found.with(symbols, &self.name));
            return Some((used, expr::shown(symbols, &new)));
        }
        None
    }
}

/// A position in an expression that depends linearly on the subexpression there.
struct Context {
    /// The path from the root inwards: each node, and the index of its child.
    way: Vec<(Expr, usize)>,
    /// The factors before and after, if the position is a run of factors.
    around: Option<(Vec<Expr>, Vec<Expr>)>,
    /// Whether the position is the whole expression or a run of its factors.
    at_root: bool,
}

impl Context {
    /// The linear positions at which `wanted` occurs.
    fn of(e: &Expr, wanted: &Expr) -> Vec<Context> {
        let mut out = Vec::new();
        let mut way = Vec::new();
        look(e, wanted, &mut way, &mut out);
        out
    }

    /// The expression with another subexpression at this position.
    fn with(&self, symbols: &Symbols, x: &Expr) -> Expr {
        let inner = match &self.around {
            Some((before, behind)) => {
                let all = before.iter().chain([x]).chain(behind).cloned();
                expr::product(all.collect::<Vec<_>>())
            }
            None => x.clone(),
        };
        self.way.iter().rev().fold(inner, |inner, (node, which)| {
            let children = node.children().into_iter().enumerate();
            let children = children.map(|(i, c)| {
                if i == *which {
                    inner.clone()
                } else {
                    c.clone()
                }
            });
            expr::with_children(symbols, node, children.collect())
        })
    }
}

fn look(e: &Expr, wanted: &Expr, way: &mut Vec<(Expr, usize)>, out: &mut Vec<Context>) {
    if e == wanted {
        out.push(Context {
            way: way.clone(),
            around: None,
            at_root: way.is_empty(),
        });
        return;
    }
    let linear: Vec<usize> = match e.node() {
        Node::Product(list) => {
            if let Some(around) = run(list, wanted) {
                out.push(Context {
                    way: way.clone(),
                    around: Some(around),
                    at_root: way.is_empty(),
                });
            }
            (0..list.len()).collect()
        }
        Node::Neg(_)
        | Node::Quotient(..)
        | Node::Transpose(_)
        | Node::Trace(_)
        | Node::Hat(_)
        | Node::Vee(_)
        | Node::Part(..)
        | Node::Map(
            Map::Twist | Map::Pure | Map::Imaginary | Map::Real | Map::Diagonal | Map::DiagonalOf,
            _,
        ) => vec![0],
        Node::Dot(..) | Node::Cross(..) => vec![0, 1],
        _ => Vec::new(),
    };
    let children = e.children();
    for which in linear {
        if let Some(child) = children.get(which) {
            way.push((e.clone(), which));
            look(child, wanted, way, out);
            way.pop();
        }
    }
}

/// The factors before and after `wanted`, if its factors are consecutive; scalar factors may be anywhere.
fn run(list: &[Expr], wanted: &Expr) -> Option<(Vec<Expr>, Vec<Expr>)> {
    let Node::Product(inner) = wanted.node() else {
        return None;
    };
    let scalar = |f: &Expr| f.shape().is_scalar();
    let parted =
        |list: &[Expr]| -> (Vec<Expr>, Vec<Expr>) { list.iter().cloned().partition(scalar) };
    let ((mut numbers, own), (wanted, run)) = (parted(list), parted(inner));
    for number in wanted {
        let at = numbers.iter().position(|n| *n == number)?;
        numbers.remove(at);
    }
    let at = match run.is_empty() {
        true => 0,
        false => own.windows(run.len()).position(|w| w == run.as_slice())?,
    };
    let (before, rest) = own.split_at_checked(at)?;
    let behind = rest.get(run.len()..)?;
    let before = numbers.into_iter().chain(before.iter().cloned());
    Some((before.collect(), behind.to_vec()))
}
