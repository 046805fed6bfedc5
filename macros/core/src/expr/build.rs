//! The only constructors of expression nodes. They compute shapes, flatten sums and products, drop neutral elements
//! and move transposes to the leaves, so that equal expressions look equal. Shapes must already fit: `check` verifies
//! the shapes in the user's model, and the derivation builds expressions of matching shapes.

use super::function::Parity;
use super::functional;
use super::hashed::{Hashed, Words};
use super::letter_mask::Marks;
use super::shape::{Dim, Shape, Structure};
use super::symbol::{SymbolId, Symbols};
use super::{Constant, Expr, Function, Inner, Letter, Map, Node, Part, Shift};
use crate::algebra::Rational;
use crate::work;
use core::hash::{Hash, Hasher};
use std::sync::Arc;

pub(super) fn make(node: Node, shape: Shape) -> Expr {
    let (mut size, mut marks) = (1u32, Marks::default());
    match &node {
        Node::Letter(at) => marks = Marks::of(*at),
        _ => node.each_child(&mut |c| {
            size = size.saturating_add(c.size());
            marks = marks.with(c.0.marks);
        }),
    }
    // Once the work limit is exceeded, every new expression is zero: the model fails anyway.
    let node = match work::make(size) {
        true => node,
        false => {
            (size, marks) = (1, Marks::default());
            match shape.is_scalar() {
                true => Node::Number(Rational::ZERO),
                false => Node::Zero(shape),
            }
        }
    };
    let mut hasher = Words::default();
    node.hash(&mut hasher);
    Expr(Arc::new(Inner {
        node,
        shape,
        size,
        hash: hasher.finish(),
        marks,
    }))
}

/// An exact number.
pub fn number(q: Rational) -> Expr {
    make(Node::Number(q), Shape::SCALAR)
}

/// An integer.
pub fn integer(n: i64) -> Expr {
    number(Rational::integer(n))
}

/// A symbol at an offset.
pub fn letter(symbols: &Symbols, symbol: SymbolId, shift: Shift) -> Expr {
    make(
        Node::Letter(Letter { symbol, shift }),
        symbols.get(symbol).shape,
    )
}

/// A symbol at the current node.
pub fn here(symbols: &Symbols, symbol: SymbolId) -> Expr {
    letter(symbols, symbol, Shift::HERE)
}

/// A letter of the given shape, for callers without a table of symbols.
pub(super) fn letter_of_shape(at: Letter, shape: Shape) -> Expr {
    make(Node::Letter(at), shape)
}

/// The identity matrix.
pub fn identity(n: Dim) -> Expr {
    if n == Dim::Fixed(1) {
        return integer(1);
    }
    make(Node::Identity(n), Shape::square(n))
}

/// Zero of a shape.
pub fn zero(shape: Shape) -> Expr {
    if shape.is_scalar() {
        return integer(0);
    }
    make(Node::Zero(shape), shape)
}

/// The unit vector along `axis`, counted from 0.
pub fn unit(n: Dim, axis: u8) -> Expr {
    make(Node::Unit(n, axis), Shape::vector(n))
}

/// 1 for scalars, the unit vectors along all axes for vectors. None for other shapes and for vectors of a named size.
pub fn axes(shape: Shape) -> Option<Vec<Expr>> {
    match (shape.is_scalar(), shape.is_vector(), shape.rows) {
        (true, ..) => Some(vec![integer(1)]),
        (_, true, Dim::Fixed(n)) => Some((0..n).map(|axis| unit(shape.rows, axis as u8)).collect()),
        _ => None,
    }
}

/// Sum of terms of equal shape; the empty sum needs `shape`. A term cancels with its negative.
pub fn sum(terms: impl IntoIterator<Item = Expr>, shape: Shape) -> Expr {
    let mut flat: Vec<Expr> = Vec::new();
    let mut constant = Rational::ZERO;
    for term in terms {
        let parts: Vec<Expr> = match term.node() {
            Node::Sum(inner) => inner.clone(),
            _ => vec![term],
        };
        for part in parts {
            match part.node() {
                Node::Number(q) => match constant.plus(*q) {
                    Some(s) => constant = s,
                    None => flat.push(part),
                },
                Node::Zero(_) => {}
                _ => flat.push(part),
            }
        }
    }
    without_opposites(&mut flat);
    if !constant.is_zero() {
        flat.push(number(constant));
    }
    match flat.len() {
        0 => zero(shape),
        1 => flat.remove(0),
        _ => make(Node::Sum(flat), shape),
    }
}

/// Removes pairs of a term and its negative, the earliest first. The remaining terms keep their order.
fn without_opposites(terms: &mut Vec<Expr>) {
    if !terms.iter().any(|t| matches!(t.node(), Node::Neg(_))) {
        return;
    }
    // Looked up, never iterated, so its order does not affect the sum.
    let mut places: Hashed<Vec<usize>> = Hashed::default();
    for (i, term) in terms.iter().enumerate().rev() {
        if !matches!(term.node(), Node::Neg(_)) {
            places.entry(term.clone()).or_default().push(i);
        }
    }
    let mut stays = vec![true; terms.len()];
    for (i, term) in terms.iter().enumerate() {
        if let Node::Neg(inner) = term.node()
            && let Some(opposite) = places.get_mut(inner).and_then(Vec::pop)
        {
            stays[i] = false;
            stays[opposite] = false;
        }
    }
    let mut stays = stays.into_iter();
    terms.retain(|_| stays.next().unwrap_or(true));
}

/// `a + b`.
pub fn add(a: Expr, b: Expr) -> Expr {
    let shape = a.shape();
    sum([a, b], shape)
}

/// `a - b`.
pub fn sub(a: Expr, b: Expr) -> Expr {
    add(a, neg(b))
}

/// `-a`.
pub fn neg(a: Expr) -> Expr {
    match a.node() {
        Node::Neg(inner) => inner.clone(),
        Node::Number(q) => number(q.negated()),
        Node::Zero(_) => a,
        Node::Sum(terms) => {
            let shape = a.shape();
            sum(terms.iter().cloned().map(neg), shape)
        }
        _ => {
            let shape = a.shape();
            make(Node::Neg(a), shape)
        }
    }
}

/// Product in order. Scalars move to the front, and signs are factored out.
pub fn product(factors: impl IntoIterator<Item = Expr>) -> Expr {
    let mut negative = false;
    let mut coefficient = Rational::ONE;
    let mut scalars: Vec<Expr> = Vec::new();
    let mut matrices: Vec<Expr> = Vec::new();
    let mut divisors: Vec<Expr> = Vec::new();
    let mut left: Option<Dim> = None;
    let mut right = Dim::Fixed(1);
    let mut queue: Vec<Expr> = factors.into_iter().collect();
    queue.reverse();
    let mut vanishes = false;
    while let Some(f) = queue.pop() {
        match f.node() {
            Node::Neg(inner) => {
                negative = !negative;
                queue.push(inner.clone());
            }
            // A row times a column is a scalar but stays whole, because its factors do not commute.
            Node::Product(inner)
                if !f.shape().is_scalar() || inner.iter().all(|x| x.shape().is_scalar()) =>
            {
                queue.extend(inner.iter().rev().cloned());
            }
            Node::Quotient(a, b) if !matches!(a.node(), Node::Sum(_)) => {
                divisors.push(b.clone());
                queue.push(a.clone());
            }
            Node::Number(q) => match coefficient.times(*q) {
                Some(c) => coefficient = c,
                None => scalars.push(f),
            },
            _ => {
                vanishes |= f.is_zero();
                if f.shape().is_scalar() {
                    scalars.push(f);
                } else {
                    left.get_or_insert(f.shape().rows);
                    right = f.shape().cols;
                    if !matches!(f.node(), Node::Identity(_)) {
                        matrices.push(f);
                    }
                }
            }
        }
    }
    let shape = Shape {
        rows: left.unwrap_or(Dim::Fixed(1)),
        cols: right,
    };
    if vanishes || coefficient.is_zero() {
        return zero(shape);
    }
    if coefficient.is_negative() {
        negative = !negative;
        coefficient = coefficient.negated();
    }
    let identity_left = left.is_some() && matrices.is_empty();
    let mut all: Vec<Expr> = Vec::new();
    if !coefficient.is_one() {
        all.push(number(coefficient));
    }
    all.append(&mut scalars);
    all.append(&mut matrices);
    if identity_left && !shape.is_scalar() {
        all.push(identity(shape.rows));
    }
    let core = match all.len() {
        0 => integer(1),
        1 => all.remove(0),
        _ => make(Node::Product(all), shape),
    };
    let mut result = core;
    if !divisors.is_empty() {
        let shape = result.shape();
        result = make(Node::Quotient(result, product(divisors)), shape);
    }
    if negative { neg(result) } else { result }
}

/// `a b`.
pub fn mul(a: Expr, b: Expr) -> Expr {
    product([a, b])
}

/// A constant that exact arithmetic does not represent.
pub fn constant(c: Constant) -> Expr {
    make(Node::Constant(c), Shape::SCALAR)
}

/// `q a` for an exact number.
pub fn scale(q: Rational, a: Expr) -> Expr {
    product([number(q), a])
}

/// `a / b` for a scalar `b`.
pub fn quotient(a: Expr, b: Expr) -> Expr {
    if a.is_zero() {
        return a;
    }
    match (a.node(), b.node()) {
        (_, Node::Number(q)) if q.inverse().is_some() => {
            scale(q.inverse().unwrap_or(Rational::ONE), a)
        }
        (_, Node::Neg(inner)) => neg(quotient(a, inner.clone())),
        (Node::Neg(inner), _) => neg(quotient(inner.clone(), b)),
        (Node::Quotient(x, y), _) => quotient(x.clone(), product([y.clone(), b])),
        _ => {
            let shape = a.shape();
            make(Node::Quotient(a, b), shape)
        }
    }
}

/// `a^q` for a scalar `a`.
pub fn power(a: Expr, q: Rational) -> Expr {
    if q.is_zero() {
        return integer(1);
    }
    if q.is_one() {
        return a;
    }
    if let (Node::Number(base), Some(n)) = (a.node(), q.as_integer())
        && let Some(value) = base.power(n)
    {
        return number(value);
    }
    if let Node::Power(base, inner) = a.node()
        && inner.as_integer().is_some()
        && q.as_integer().is_some()
        && let Some(total) = inner.times(q)
    {
        return power(base.clone(), total);
    }
    make(Node::Power(a, q), Shape::SCALAR)
}

/// The transpose of a matrix that has a temporary. It stays a node, and sums and products do not absorb it.
pub fn transposed(a: Expr) -> Expr {
    let shape = a.shape().transposed();
    make(Node::Transpose(a), shape)
}

/// The transpose, moved to the leaves.
pub fn transpose(symbols: &Symbols, a: Expr) -> Expr {
    let shape = a.shape();
    if shape.is_scalar() {
        return a;
    }
    match a.node() {
        Node::Letter(at) => match symbols.get(at.symbol).structure {
            Structure::Symmetric | Structure::Diagonal => a,
            Structure::Skew => neg(a),
            Structure::General
            | Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => make(Node::Transpose(a), shape.transposed()),
        },
        Node::Identity(_) => a,
        Node::Zero(_) => zero(shape.transposed()),
        Node::Sum(terms) => sum(
            terms.iter().cloned().map(|t| transpose(symbols, t)),
            shape.transposed(),
        ),
        Node::Neg(inner) => neg(transpose(symbols, inner.clone())),
        Node::Product(factors) => {
            product(factors.iter().rev().cloned().map(|f| transpose(symbols, f)))
        }
        Node::Quotient(x, y) => quotient(transpose(symbols, x.clone()), y.clone()),
        Node::Transpose(inner) => inner.clone(),
        Node::Hat(_) | Node::Map(Map::Pure, _) => neg(a),
        Node::Map(Map::Diagonal, _) => a,
        Node::Part(part, _) => match part {
            Part::Symmetric | Part::Diagonal => a,
            Part::Skew => neg(a),
        },
        Node::Inverse(inner) if transpose(symbols, inner.clone()) == *inner => a,
        Node::Adjugate(inner) => {
            let inner = transpose(symbols, inner.clone());
            make(Node::Adjugate(inner), shape)
        }
        Node::Given(_) | Node::PullBack(..)
            if let Some(known) = functional::transposed(symbols, &a) =>
        {
            known
        }
        Node::Number(_)
        | Node::Constant(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Power(..)
        | Node::Inverse(_)
        | Node::Trace(_)
        | Node::Det(_)
        | Node::Dot(..)
        | Node::Cross(..)
        | Node::Vee(_)
        | Node::Call(..)
        | Node::Map(..)
        | Node::Given(_)
        | Node::PullBack(..) => make(Node::Transpose(a), shape.transposed()),
    }
}

/// Whether this is a letter, or the rotation of a letter, whose inverse is its transpose.
fn is_rotation(symbols: &Symbols, a: &Expr) -> bool {
    match a.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure.is_orthogonal(),
        Node::Map(Map::Rotation, _) => true,
        _ => false,
    }
}

/// The inverse; for an element of SO(n) or SU(2), its transpose.
pub fn inverse(symbols: &Symbols, a: Expr) -> Expr {
    let shape = a.shape();
    if shape.is_scalar() {
        return power(a, Rational::MINUS_ONE);
    }
    match a.node() {
        _ if is_rotation(symbols, &a) => transpose(symbols, a),
        Node::Transpose(inner) if is_rotation(symbols, inner) => inner.clone(),
        Node::Transpose(inner) if let Node::Inverse(own) = inner.node() => {
            transpose(symbols, own.clone())
        }
        Node::Identity(_) => a,
        Node::Inverse(inner) => inner.clone(),
        Node::Product(factors)
            if factors
                .iter()
                .all(|f| f.shape().is_scalar() || f.shape().is_square()) =>
        {
            product(factors.iter().rev().cloned().map(|f| inverse(symbols, f)))
        }
        _ => make(Node::Inverse(a), shape),
    }
}

/// Whether the form of a matrix shows that it is invertible, because all its factors are.
pub fn is_invertible(symbols: &Symbols, e: &Expr) -> bool {
    let go = |x: &Expr| is_invertible(symbols, x);
    match e.node() {
        Node::Letter(l) => symbols.get(l.symbol).structure.is_invertible(),
        Node::Identity(_) | Node::Map(Map::Rotation, _) => true,
        Node::Number(q) => !q.is_zero(),
        Node::Transpose(a) | Node::Inverse(a) | Node::Neg(a) => go(a),
        Node::Product(factors) => factors.iter().all(go),
        _ => false,
    }
}

/// The trace.
pub fn trace(a: Expr) -> Expr {
    match a.node() {
        Node::Neg(inner) => neg(trace(inner.clone())),
        Node::Zero(_) => integer(0),
        Node::Number(_) => a,
        Node::Identity(Dim::Fixed(n)) => integer(i64::from(*n)),
        Node::Hat(_) => integer(0),
        _ if a.shape().is_scalar() => a,
        _ => make(Node::Trace(a), Shape::SCALAR),
    }
}

/// The scalar product of two vectors.
pub fn dot(a: Expr, b: Expr) -> Expr {
    match (a.node(), b.node()) {
        (Node::Zero(_), _) | (_, Node::Zero(_)) => integer(0),
        (Node::Neg(x), _) => neg(dot(x.clone(), b)),
        (_, Node::Neg(y)) => neg(dot(a, y.clone())),
        _ if a.shape().is_scalar() => mul(a, b),
        _ => make(Node::Dot(a, b), Shape::SCALAR),
    }
}

/// The vector product.
pub fn cross(a: Expr, b: Expr) -> Expr {
    let shape = a.shape();
    match (a.node(), b.node()) {
        _ if a == b => zero(shape),
        (Node::Zero(_), _) | (_, Node::Zero(_)) => zero(shape),
        (Node::Neg(x), _) => neg(cross(x.clone(), b)),
        (_, Node::Neg(y)) => neg(cross(a, y.clone())),
        _ => make(Node::Cross(a, b), shape),
    }
}

/// The skew matrix of a vector.
pub fn hat(v: Expr) -> Expr {
    let shape = Shape::square(v.shape().rows);
    match v.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(hat(x.clone())),
        Node::Vee(a) => part(Part::Skew, a.clone()),
        _ => make(Node::Hat(v), shape),
    }
}

/// The axial vector of the skew part.
pub fn vee(a: Expr) -> Expr {
    let shape = Shape::vector(a.shape().rows);
    match a.node() {
        Node::Zero(_) | Node::Identity(_) => zero(shape),
        Node::Neg(x) => neg(vee(x.clone())),
        Node::Hat(v) => v.clone(),
        Node::Product(factors) => match multiple_of_hat(factors) {
            Some(v) => v,
            None => make(Node::Vee(a), shape),
        },
        Node::Sum(terms) => {
            let found: Option<Vec<Expr>> = terms.iter().map(vector_of_hat).collect();
            match found {
                Some(vectors) => sum(vectors, shape),
                None => make(Node::Vee(a), shape),
            }
        }
        _ => make(Node::Vee(a), shape),
    }
}

/// `v` times scalars if the expression is a hat `hat(v)` times scalars.
fn vector_of_hat(e: &Expr) -> Option<Expr> {
    match e.node() {
        Node::Hat(v) => Some(v.clone()),
        Node::Neg(x) => vector_of_hat(x).map(neg),
        Node::Product(factors) => multiple_of_hat(factors),
        _ => None,
    }
}

/// The vector for a product of scalars and one hat.
fn multiple_of_hat(factors: &[Expr]) -> Option<Expr> {
    let matrices = factors.iter().filter(|f| !f.shape().is_scalar()).count();
    if matrices != 1 {
        return None;
    }
    let vector = |f: &Expr| match f.shape().is_scalar() {
        true => Some(f.clone()),
        false => vector_of_hat(f),
    };
    let factors: Option<Vec<Expr>> = factors.iter().map(vector).collect();
    let mut factors = factors?.into_iter();
    let first = factors.next()?;
    Some(factors.fold(first, mul))
}

/// A linear part of a square matrix.
pub fn part(which: Part, a: Expr) -> Expr {
    let shape = a.shape();
    match (a.node(), which) {
        (Node::Zero(_), _) => a,
        (Node::Identity(_), Part::Symmetric | Part::Diagonal) => a,
        (Node::Identity(_), Part::Skew) => zero(shape),
        (Node::Hat(_), Part::Skew) => a,
        (Node::Hat(_), Part::Symmetric | Part::Diagonal) => zero(shape),
        (Node::Map(Map::Diagonal, _), Part::Symmetric | Part::Diagonal) => a,
        (Node::Map(Map::Diagonal, _), Part::Skew) => zero(shape),
        (Node::Neg(x), _) => neg(part(which, x.clone())),
        _ => make(Node::Part(which, a), shape),
    }
}

/// A function of a scalar.
pub fn call(function: Function, a: Expr) -> Expr {
    if let Some(value) = function.at(&a) {
        return value;
    }
    if let Node::Neg(x) = a.node() {
        match function.parity() {
            Parity::Even => return call(function, x.clone()),
            Parity::Odd => return neg(call(function, x.clone())),
            Parity::None => {}
        }
    }
    make(Node::Call(function, a), Shape::SCALAR)
}
