//! Finds letters, shifts them in time, and replaces them by expressions. All other rewriting happens on normal
//! forms.

use super::build::letter_of_shape;
use super::letter_mask::{Marks, Memo};
use super::symbol::{Role, Symbols};
use super::*;

/// Whether the letter occurs.
pub fn contains(e: &Expr, wanted: Letter) -> bool {
    let marks = Marks::of(wanted);
    fn walk(e: &Expr, wanted: Letter, marks: Marks) -> bool {
        if e.0.marks.are_apart(marks) {
            return false;
        }
        match e.node() {
            Node::Letter(at) => *at == wanted,
            _ => e.children().into_iter().any(|c| walk(c, wanted, marks)),
        }
    }
    walk(e, wanted, marks)
}

/// Whether a letter of this role occurs, at any offset.
pub fn contains_role(symbols: &Symbols, e: &Expr, role: Role) -> bool {
    letters(e)
        .iter()
        .any(|l| symbols.get(l.symbol).role == role)
}

/// Every letter that occurs, sorted, without repetition.
pub fn letters(e: &Expr) -> Vec<Letter> {
    fn walk(e: &Expr, seen: &mut Memo<()>, out: &mut Vec<Letter>) {
        if let Node::Letter(at) = e.node() {
            out.push(*at);
        }
        if e.0.marks.is_empty() || seen.get(e).is_some() {
            return;
        }
        e.node().each_child(&mut |c| walk(c, seen, out));
        seen.keep(e, &());
    }
    let mut out = Vec::new();
    walk(e, &mut Memo::default(), &mut out);
    out.sort();
    out.dedup();
    out
}

/// The expression with every time-dependent letter shifted by `by` levels. Constants are unchanged.
pub fn shift_time(symbols: &Symbols, e: &Expr, by: i8) -> Expr {
    let shifted = |at: Letter, shape| {
        let moves = match symbols.get(at.symbol).role {
            Role::Step | Role::Parameter | Role::Variation => false,
            Role::Element | Role::Velocity | Role::Advected | Role::Multiplier | Role::Derived => {
                true
            }
        };
        let mut to = at;
        if moves {
            to.shift.time = to.shift.time.saturating_add(by);
        }
        (to != at).then(|| letter_of_shape(to, shape))
    };
    map_letters(symbols, e, &mut Memo::default(), &shifted)
}

/// The expression with letters replaced; letters that are not listed are unchanged.
pub fn substitute(symbols: &Symbols, e: &Expr, replacements: &[(Letter, Expr)]) -> Expr {
    let wanted = Marks::of_all(replacements.iter().map(|(l, _)| *l));
    if e.0.marks.are_apart(wanted) {
        return e.clone();
    }
    let replaced = |at: Letter, _| {
        let own = replacements.iter().find(|(l, _)| *l == at);
        own.map(|(_, x)| x.clone())
    };
    map_letters(symbols, e, &mut Memo::default(), &replaced)
}

fn map_letters(
    symbols: &Symbols,
    e: &Expr,
    memo: &mut Memo<Expr>,
    f: &dyn Fn(Letter, shape::Shape) -> Option<Expr>,
) -> Expr {
    if let Node::Letter(at) = e.node() {
        return f(*at, e.shape()).unwrap_or_else(|| e.clone());
    }
    if e.0.marks.is_empty() {
        return e.clone();
    }
    if let Some(known) = memo.get(e) {
        return known;
    }
    let mapped = rebuild(symbols, e, &mut |x| map_letters(symbols, x, memo, f));
    memo.keep(e, &mapped);
    mapped
}

/// The expression rewritten from its leaves to its root; shared parts are rewritten once.
pub(super) fn bottom_up(symbols: &Symbols, e: &Expr, f: &dyn Fn(Expr) -> Expr) -> Expr {
    rewritten(symbols, e, f, &mut Memo::default())
}

fn rewritten(
    symbols: &Symbols,
    e: &Expr,
    f: &dyn Fn(Expr) -> Expr,
    known: &mut Memo<Expr>,
) -> Expr {
    if let Some(found) = known.get(e) {
        return found;
    }
    let new = f(rebuild(symbols, e, &mut |x| {
        rewritten(symbols, x, f, known)
    }));
    known.keep(e, &new);
    new
}

/// The node with every child replaced; if no child changes, the identical expression.
pub fn rebuild(symbols: &Symbols, e: &Expr, go: &mut dyn FnMut(&Expr) -> Expr) -> Expr {
    let (mut children, mut same) = (Vec::new(), true);
    e.node().each_child(&mut |x| {
        let y = go(x);
        same &= Arc::ptr_eq(&x.0, &y.0);
        children.push(y);
    });
    match same {
        true => e.clone(),
        false => with_children(symbols, e, children),
    }
}

/// The node with `children` as its children, in order; leaves are unchanged.
pub fn with_children(symbols: &Symbols, e: &Expr, children: Vec<Expr>) -> Expr {
    if let Node::Sum(_) = e.node() {
        return sum(children, e.shape());
    }
    if let Node::Product(_) = e.node() {
        return product(children);
    }
    let mut each = children.into_iter();
    let mut go = |x: &Expr| each.next().unwrap_or_else(|| x.clone());
    match e.node() {
        Node::Number(_)
        | Node::Constant(_)
        | Node::Letter(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Sum(_)
        | Node::Product(_) => e.clone(),
        Node::Neg(a) => neg(go(a)),
        Node::Quotient(a, b) => {
            let a = go(a);
            quotient(a, go(b))
        }
        Node::Power(a, q) => power(go(a), *q),
        Node::Transpose(a) => transpose(symbols, go(a)),
        Node::Inverse(a) => inverse(symbols, go(a)),
        Node::Trace(a) => trace(go(a)),
        Node::Det(a) => det(go(a)),
        Node::Adjugate(a) => adjugate(symbols, &go(a)),
        Node::Dot(a, b) => {
            let a = go(a);
            dot(a, go(b))
        }
        Node::Cross(a, b) => {
            let a = go(a);
            cross(a, go(b))
        }
        Node::Hat(a) => hat(go(a)),
        Node::Vee(a) => vee(go(a)),
        Node::Part(which, a) => part(*which, go(a)),
        Node::Call(function, a) => call(*function, go(a)),
        Node::Map(map, a) => match map {
            Map::Real => real(go(a)),
            Map::Imaginary => imaginary(go(a)),
            Map::Pure => pure(go(a)),
            Map::Rotation => rotation(symbols, go(a)),
            Map::Translation => column(symbols, &go(a)),
            Map::Twist => twist(go(a)),
            Map::Diagonal => diagonal(go(a)),
            Map::DiagonalOf => diagonal_of(go(a)),
        },
        Node::Given(a) => functional::rebuilt(symbols, a, None, &mut go),
        Node::PullBack(a, which, seed) => {
            functional::rebuilt(symbols, a, Some((*which, seed)), &mut go)
        }
    }
}
