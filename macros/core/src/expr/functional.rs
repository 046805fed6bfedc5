//! Functionals: functions `f(x, y)` of which the engine knows only names and shapes. There are two kinds of node. One
//! is a value, differentiated along some arguments, `D_1 f(x, y)[u]`. The other is its pull-back: the transposed
//! derivative with respect to one argument, applied to a seed. Gradients and directional derivatives of the two kinds
//! are sums of the two kinds. The gradient of `<s, f(x)>` is a pull-back, the gradient of a pull-back is a pull-back
//! along one more direction, and a directional derivative adds a direction. The derivative of a scalar along its last
//! direction is stored as a gradient: `Df(x)[u]` is `<∇f(x), u>`.

#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
pub(crate) mod tests;

use super::build::make;
use super::shape::{Shape, Structure};
use super::symbol::Symbols;
use super::*;

/// Index of a functional in the table of symbols.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct FunctionalId(pub u32);

/// The shape and structure of an argument or of the value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Kind {
    /// Its shape.
    pub shape: Shape,
    /// Its structure: gradients with respect to a symmetric argument are symmetric.
    pub structure: Structure,
}

impl Kind {
    /// The kind of this shape, without structure.
    pub fn of(shape: Shape) -> Kind {
        let structure = Structure::General;
        Kind { shape, structure }
    }

    fn is_symmetric(self) -> bool {
        matches!(self.structure, Structure::Symmetric | Structure::Diagonal)
    }
}

/// The path that denotes a function provided by the case.
pub const BY_CASE: &str = "case";

/// The arguments on which a functional depends.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Reach {
    /// Its value depends on the local values of its arguments.
    Point,
    /// Its value at one site depends on its arguments at all sites, as areas of a mesh do. Scalars that vary between
    /// sites do not factor out of its derivatives.
    Sites,
}

/// A functional of a model.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Functional {
    /// Name as written.
    pub name: String,
    /// Its arguments, in order.
    pub arguments: Vec<Kind>,
    /// Its value; for a field, the value at one site.
    pub value: Kind,
    /// The arguments on which it depends.
    pub reach: Reach,
    /// The Rust path of its implementation.
    pub path: String,
    /// Its LaTeX form, if the declaration gives one.
    pub typeset: Option<String>,
}

/// A functional at arguments, differentiated along some of them.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Applied {
    /// The functional.
    pub functional: FunctionalId,
    /// Its arguments.
    pub arguments: Vec<Expr>,
    /// The argument, counted from 0, and the direction of each derivative, in any order.
    pub along: Vec<(u8, Expr)>,
}

impl Applied {
    /// Arguments, then directions.
    pub(super) fn each_child<'a>(&'a self, visit: &mut dyn FnMut(&'a Expr)) {
        self.arguments.iter().for_each(&mut *visit);
        self.along.iter().for_each(|(_, x)| visit(x));
    }

    /// With one more derivative.
    pub(crate) fn also_along(&self, which: u8, amount: Expr) -> Applied {
        let mut all = self.clone();
        all.along.push((which, amount));
        all
    }

    /// Without the derivative at index `place`.
    pub(crate) fn less_one(&self, place: usize) -> Applied {
        let mut all = self.clone();
        all.along.remove(place);
        all
    }

    /// With another direction at index `place`.
    fn with_direction(&self, place: usize, amount: Expr) -> Applied {
        let mut all = self.clone();
        all.along[place].1 = amount;
        all
    }

    /// Every argument with its index.
    fn numbered(&self) -> impl Iterator<Item = (u8, &Expr)> {
        (0u8..).zip(&self.arguments)
    }

    fn map(&self, go: &mut dyn FnMut(&Expr) -> Expr) -> Applied {
        Applied {
            functional: self.functional,
            arguments: self.arguments.iter().map(&mut *go).collect(),
            along: self.along.iter().map(|(i, x)| (*i, go(x))).collect(),
        }
    }
}

/// The shape and structure of this node, if it is the value or pull-back of a functional.
pub(crate) fn kind(symbols: &Symbols, node: &Node) -> Option<Kind> {
    match node {
        Node::Given(a) => Some(symbols.functional(a.functional).value),
        Node::PullBack(a, which, _) => {
            let arguments = &symbols.functional(a.functional).arguments;
            arguments.get(usize::from(*which)).copied()
        }
        _ => None,
    }
}

/// The transpose of a value or a pull-back, if its structure determines it.
pub(super) fn transposed(symbols: &Symbols, e: &Expr) -> Option<Expr> {
    let kind = kind(symbols, e.node())?;
    match kind.structure {
        Structure::Skew => Some(neg(e.clone())),
        _ => kind.is_symmetric().then(|| e.clone()),
    }
}

/// `f(x, y)`.
pub fn given(symbols: &Symbols, functional: FunctionalId, arguments: Vec<Expr>) -> Expr {
    let along = Vec::new();
    derived(
        symbols,
        Applied {
            functional,
            arguments,
            along,
        },
    )
}

/// `f(x, y)`, or `D_1 f(x, y)[u]` if it is differentiated along directions.
pub fn derived(symbols: &Symbols, a: Applied) -> Expr {
    let f = symbols.functional(a.functional);
    let (outside, mut a) = apart(symbols, a);
    if outside.is_zero() {
        return zero(f.value.shape);
    }
    let number = f.reach == Reach::Point && f.value.shape.is_scalar();
    let core = match a.along.pop() {
        Some((which, amount)) if number => {
            let gradient = pull_back(symbols, a, which, integer(1));
            pairing(symbols, gradient, amount)
        }
        last => {
            a.along.extend(last);
            make(Node::Given(a), f.value.shape)
        }
    };
    mul(outside, core)
}

/// `(D_i f(x, y))^T[s]`: the transposed derivative with respect to the argument `which`, counted from 0, applied to
/// a seed of the shape of the value. For a number, this is `s ∇_i f(x, y)`.
pub fn pull_back(symbols: &Symbols, a: Applied, which: u8, seed: Expr) -> Expr {
    let f = symbols.functional(a.functional);
    let own = a.arguments.get(usize::from(which));
    let shape = own.map_or(Shape::SCALAR, Expr::shape);
    let (outside, a) = apart(symbols, a);
    let seed = projected(symbols, f.value.structure, &seed);
    let (factor, seed) = taken_out(f.reach, seed);
    let outside = mul(outside, factor);
    if outside.is_zero() || seed.is_zero() {
        return zero(shape);
    }
    mul(outside, make(Node::PullBack(a, which, seed), shape))
}

/// The factors of the directions, and the remainder; the factor is zero if a direction is. Directions are projected
/// onto the structure of their argument.
fn apart(symbols: &Symbols, mut a: Applied) -> (Expr, Applied) {
    let f = symbols.functional(a.functional);
    let mut outside = integer(1);
    for (which, amount) in &mut a.along {
        let kind = f.arguments.get(usize::from(*which));
        let structure = kind.map_or(Structure::General, |k| k.structure);
        let within = projected(symbols, structure, amount);
        let (factor, rest) = taken_out(f.reach, within);
        outside = match rest.is_zero() {
            true => integer(0),
            false => mul(outside, factor),
        };
        *amount = rest;
    }
    (outside, a)
}

/// A factor, and the remainder on which a derivative depends linearly. Factors are signs and exact numbers, and all
/// scalars if the functional depends on one point.
fn taken_out(reach: Reach, e: Expr) -> (Expr, Expr) {
    let number = |x: &Expr| match reach {
        Reach::Point => x.shape().is_scalar(),
        Reach::Sites => matches!(x.node(), Node::Number(_) | Node::Constant(_)),
    };
    if number(&e) {
        return (e, integer(1));
    }
    match e.node() {
        Node::Neg(a) => {
            let (factor, rest) = taken_out(reach, a.clone());
            (neg(factor), rest)
        }
        Node::Product(list) => {
            let (out, rest): (Vec<Expr>, Vec<Expr>) = list.iter().cloned().partition(number);
            match out.is_empty() {
                true => (integer(1), e),
                false => (product(out), product(rest)),
            }
        }
        Node::Quotient(a, b) if number(b) => {
            let (factor, rest) = taken_out(reach, a.clone());
            (quotient(factor, b.clone()), rest)
        }
        _ => (integer(1), e),
    }
}

/// The node with every child replaced, in order.
pub(super) fn rebuilt(
    symbols: &Symbols,
    a: &Applied,
    back: Option<(u8, &Expr)>,
    go: &mut dyn FnMut(&Expr) -> Expr,
) -> Expr {
    let a = a.map(go);
    match back {
        Some((which, seed)) => {
            let seed = go(seed);
            pull_back(symbols, a, which, seed)
        }
        None => derived(symbols, a),
    }
}

/// The contribution of a seed of the node to each selected child.
pub(super) fn gradients<'a>(
    symbols: &Symbols,
    a: &'a Applied,
    back: Option<(u8, &'a Expr)>,
    seed: &Expr,
    wanted: &dyn Fn(&Expr) -> bool,
) -> Vec<(&'a Expr, Expr)> {
    // The gradient of a pull-back, paired with `t`, is the gradient of the seed paired with the derivative along `t`.
    let (a_more, inner) = match back {
        Some((which, own)) => (a.also_along(which, seed.clone()), own.clone()),
        None => (a.clone(), seed.clone()),
    };
    let mut all = Vec::new();
    for (i, x) in a.numbered().filter(|(_, x)| wanted(x)) {
        all.push((x, pull_back(symbols, a_more.clone(), i, inner.clone())));
    }
    for (place, (i, x)) in a.along.iter().enumerate().filter(|(_, (_, x))| wanted(x)) {
        let rest = a_more.less_one(place);
        all.push((x, pull_back(symbols, rest, *i, inner.clone())));
    }
    if let Some((_, own)) = back.filter(|(_, own)| wanted(own)) {
        all.push((own, derived(symbols, a_more)));
    }
    all
}

/// The derivative of the node if its children change by `d`.
pub(super) fn changed(
    symbols: &Symbols,
    a: &Applied,
    back: Option<(u8, &Expr)>,
    d: &mut dyn FnMut(&Expr) -> Expr,
) -> Expr {
    let with = |a: Applied| match back {
        Some((which, seed)) => pull_back(symbols, a, which, seed.clone()),
        None => derived(symbols, a),
    };
    let mut terms = Vec::new();
    for (i, x) in a.numbered() {
        let amount = d(x);
        if !amount.is_zero() {
            terms.push(with(a.also_along(i, amount)));
        }
    }
    for (place, (_, x)) in a.along.iter().enumerate() {
        let amount = d(x);
        if !amount.is_zero() {
            terms.push(with(a.with_direction(place, amount)));
        }
    }
    let mut shape = symbols.functional(a.functional).value.shape;
    if let Some((which, seed)) = back {
        shape = a.arguments[usize::from(which)].shape();
        terms.push(pull_back(symbols, a.clone(), which, d(seed)));
    }
    sum(terms, shape)
}

/// `<a, b> = tr(a^T b)`, written as a product or scalar product if it is one.
pub(crate) fn pairing(symbols: &Symbols, a: Expr, b: Expr) -> Expr {
    if a.shape().is_scalar() {
        mul(a, b)
    } else if a.shape().is_vector() {
        dot(a, b)
    } else {
        trace(mul(transpose(symbols, a), b))
    }
}
