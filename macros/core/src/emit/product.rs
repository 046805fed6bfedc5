//! Products as Rust: chains of matrices bracketed by cost, numbers gathered into one factor with one
//! division. Takes the factors; gives tokens that can stand in a sum.

use super::expression::{Writer, rational};
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr, Node};
use crate::schedule::{Bracketed, associate};
use proc_macro2::{Delimiter, Literal, TokenStream, TokenTree};
use quote::quote;

impl Writer<'_> {
    pub(super) fn product(&self, factors: &[Expr]) -> TokenStream {
        let (mut numbers, matrices): (Vec<Expr>, Vec<Expr>) =
            factors.iter().cloned().partition(|f| f.shape().is_scalar());
        // 2 vee(A) is the axial vector of A - A^T.
        let doubled = match matrices.as_slice() {
            [only] => match only.node() {
                Node::Vee(a) => Some(a.clone()),
                _ => None,
            },
            _ => None,
        };
        let coefficient = numbers
            .iter()
            .position(|n| matches!(n.node(), Node::Number(_)));
        let chain = if let (Some(a), Some(i)) = (doubled, coefficient)
            && let Node::Number(q) = numbers[i].node()
            && let Some(half) = q.times(Rational::HALF)
        {
            numbers[i] = expr::number(half);
            if half.is_one() {
                numbers.remove(i);
            }
            Some(self.function("axial_of_difference", &a))
        } else if matrices.is_empty() {
            None
        } else {
            Some(self.chain(&matrices))
        };
        let Some(chain) = chain else {
            return self.quotient(&numbers);
        };
        let (rows, cols) = (
            matrices.first().map(|m| m.shape().rows),
            matrices.last().map(|m| m.shape().cols),
        );
        let column = cols == Some(Dim::Fixed(1));
        let number = column && rows == cols;
        match (numbers.as_slice(), numbers.first().and_then(divisor)) {
            ([], _) => chain,
            ([_], Some(below)) if column => {
                let below = self.operand(&below);
                quote!(#chain / #below)
            }
            (several, _) if number => {
                let factor = self.quotient(several);
                quote!(#chain * #factor)
            }
            ([only], None) => {
                let only = self.operand(only);
                quote!(#chain * #only)
            }
            // Made once: every component is multiplied by it.
            (several, _) => {
                let factor = self.quotient(several);
                quote!(#chain * (#factor))
            }
        }
    }

    /// A product of numbers, with one division by all that stand below. Divisions read better than
    /// negative powers.
    fn quotient(&self, numbers: &[Expr]) -> TokenStream {
        let below: Vec<Expr> = numbers.iter().filter_map(divisor).collect();
        let above = numbers.iter().filter(|n| divisor(n).is_none());
        let times = |list: Vec<TokenStream>| {
            let mut out = TokenStream::new();
            for (i, part) in list.into_iter().enumerate() {
                let sign = (i > 0).then(|| quote!(*));
                out.extend(quote!(#sign #part));
            }
            out
        };
        let mut above: Vec<TokenStream> = above.map(|n| self.operand(n)).collect();
        if above.is_empty() {
            above.push(rational(Rational::ONE));
        }
        let above = times(above);
        match below.as_slice() {
            [] => above,
            [only] => {
                let only = self.operand(only);
                quote!(#above / #only)
            }
            _ => {
                let below = times(below.iter().map(|n| self.operand(n)).collect());
                quote!(#above / (#below))
            }
        }
    }

    fn chain(&self, factors: &[Expr]) -> TokenStream {
        fn write(w: &Writer, b: &Bracketed, f: &[Expr]) -> (TokenStream, Shape, Option<Expr>) {
            let number = |n: Dim| super::sizes::size(w.symbols, n);
            match b {
                Bracketed::Factor(i) => (w.operand(&f[*i]), f[*i].shape(), Some(f[*i].clone())),
                Bracketed::Pair(a, b) => {
                    let (x, left, x_expr) = write(w, a, f);
                    let (y, right, y_expr) = write(w, b, f);
                    let shape = Shape {
                        rows: left.rows,
                        cols: right.cols,
                    };
                    let transposed = x_expr.as_ref().and_then(|e| match e.node() {
                        Node::Transpose(inner) => Some(w.operand(inner)),
                        _ => None,
                    });
                    let (n, m) = (number(left.rows), number(right.cols));
                    let three = |e: &Option<Expr>| match e.as_ref().map(Expr::node) {
                        Some(Node::Hat(v)) => Some(w.operand(v)),
                        _ => None,
                    };
                    let crossed = match (three(&x_expr), three(&y_expr)) {
                        (Some(v), _) if right.is_vector() => Some(quote!(#v.cross(&#y))),
                        (Some(v), _) if right.cols == Dim::Fixed(3) => {
                            Some(quote!(crossed(&#v, &#y)))
                        }
                        (_, Some(v)) if left.rows == Dim::Fixed(3) => {
                            Some(quote!(crossing(&#x, &#v)))
                        }
                        _ if x_expr.as_ref().is_some_and(|e| w.is_diagonal(e)) => {
                            Some(quote!(diagonal_times(&#x, &#y)))
                        }
                        _ if y_expr.as_ref().is_some_and(|e| w.is_diagonal(e)) => {
                            Some(quote!(times_diagonal(&#x, &#y)))
                        }
                        _ => None,
                    };
                    let constant = match (x_expr.as_ref(), y_expr.as_ref()) {
                        (Some(e), _) if is_inclusion(e).is_some() => {
                            is_inclusion(e).map(|(whole, at, taken)| {
                                let (r, c) = (number(whole.rows), number(whole.cols));
                                match taken {
                                    true => quote!(rows_from::<T, #r, #c, #m>(&#y, #at)),
                                    false => quote!(into_rows::<T, #r, #c, #m>(&#y, #at)),
                                }
                            })
                        }
                        (_, Some(e)) => is_inclusion(e).map(|(whole, at, put)| {
                            let (r, c) = (number(whole.rows), number(whole.cols));
                            match put {
                                true => quote!(into_columns::<T, #r, #c, #n>(&#x, #at)),
                                false => quote!(columns_from::<T, #r, #c, #n>(&#x, #at)),
                            }
                        }),
                        _ => None,
                    };
                    let tokens = match transposed {
                        _ if constant.is_some() => constant.unwrap_or_default(),
                        _ if crossed.is_some() => crossed.unwrap_or_default(),
                        // nalgebra multiplies by a number on the right.
                        _ if left.is_scalar() => quote!((#y * #x)),
                        // A row times a column, and A^T B without forming the transpose.
                        Some(x) if shape.is_scalar() => quote!(#x.dot(&#y)),
                        None if shape.is_scalar() => quote!(#x.transpose().dot(&#y)),
                        Some(x) => quote!(#x.tr_mul(&#y)),
                        None => quote!((#x * #y)),
                    };
                    (tokens, shape, None)
                }
            }
        }
        let (tokens, ..) = write(self, &associate(factors), factors);
        match factors {
            // A sum keeps its parentheses: numbers may stand behind it.
            [_] => tokens,
            _ => unwrapped(tokens),
        }
    }
}

/// What a number divides by, if it stands below.
fn divisor(number: &Expr) -> Option<Expr> {
    match number.node() {
        Node::Power(base, q) if q.is_negative() => Some(expr::power(base.clone(), q.negated())),
        _ => None,
    }
}

/// The shape and the row of an inclusion, and whether it is transposed.
fn is_inclusion(e: &Expr) -> Option<(Shape, Literal, bool)> {
    let (e, transposed) = match e.node() {
        Node::Transpose(inner) => (inner, true),
        _ => (e, false),
    };
    match e.node() {
        Node::Inclusion(whole, at) => {
            let at = Literal::usize_unsuffixed(*at as usize);
            Some((*whole, at, transposed))
        }
        _ => None,
    }
}

/// Without parentheses around the whole.
fn unwrapped(tokens: TokenStream) -> TokenStream {
    let mut trees = tokens.clone().into_iter();
    match (trees.next(), trees.next()) {
        (Some(TokenTree::Group(g)), None) if g.delimiter() == Delimiter::Parenthesis => g.stream(),
        _ => tokens,
    }
}
