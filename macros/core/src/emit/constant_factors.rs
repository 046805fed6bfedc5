//! The linear balance of a field whose factors depend on parameters only, such as a constant metric and constant
//! second moments of mass. The model stores their inverses, and a step multiplies by them. Takes the balance; gives
//! the factors to invert and the solution.

use super::element::{self, Family, family};
use super::items::text;
use super::names::variable;
use crate::algebra::Algebra;
use crate::derive::Derivation;
use crate::derive::two_sided_linear::TwoSidedLinear;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// The constant factors of `left ΔX right = known`. A scalar factor is combined with the only matrix.
pub(super) struct Constant<'a> {
    form: &'a TwoSidedLinear,
    /// If both factors are matrices: the step size times the left one, and the right one. If one is a number: the
    /// step size times both factors, on the side of the matrix.
    pub factors: [Option<Expr>; 2],
}

impl<'a> Constant<'a> {
    /// The factors of configuration `i`. None if both are numbers, by which the step divides, or if a factor varies.
    pub fn of(d: &'a Derivation, i: usize, form: &'a TwoSidedLinear) -> Option<Self> {
        let Family::Field(_) = family(&d.spec.configurations[i]) else {
            return None;
        };
        let s = &d.letters.symbols;
        let step = expr::here(s, d.spec.step);
        let (left, right) = (form.left.clone(), form.right.clone());
        let factors = match [&left, &right].map(|e| e.shape().is_scalar()) {
            [true, true] => return None,
            [false, false] => [Some(expr::mul(step, left)), Some(right)],
            [false, true] => [Some(expr::product([step, left, right])), None],
            [true, false] => [None, Some(expr::product([step, left, right]))],
        };
        let algebra = Algebra::new(s);
        let of_parameters = |e: &Expr| {
            let letters = expr::letters(e);
            letters
                .iter()
                .all(|l| s.get(l.symbol).role == Role::Parameter)
        };
        let short = factors.map(|e| e.map(|e| algebra.shortest(&e)));
        let all = short.iter().flatten().all(of_parameters) && !algebra.exhausted();
        all.then_some(Constant {
            form,
            factors: short,
        })
    }

    /// The solution, computed with the inverses that the model stores.
    pub fn solution(
        &self,
        d: &Derivation,
        i: usize,
        [left, right]: [Ident; 2],
        known: TokenStream,
    ) -> TokenStream {
        let step = variable(&d.letters.symbols, d.spec.step);
        let known = element::array(&d.spec.configurations[i], known);
        let names = [text(d, &self.form.left), text(d, &self.form.right)];
        let [first, second] = &names;
        match &self.factors {
            [Some(_), Some(_)] => quote! {
                increment_between(&(self.#left * #step), &#known, &self.#right, &[#(#names),*])
            },
            [Some(_), None] => quote!(increment_behind(&(self.#left * #step), &#known, #first)),
            [None, _] => quote!(increment_before(&#known, &(self.#right * #step), #second)),
        }
    }
}

/// The solution of a linear balance, given the values of its factors, which may be numbers if the configuration is a
/// field.
pub(super) fn linear_solution(
    d: &Derivation,
    i: usize,
    form: &TwoSidedLinear,
    left: TokenStream,
    known: TokenStream,
    right: TokenStream,
) -> TokenStream {
    let c = &d.spec.configurations[i];
    let names = [text(d, &form.left), text(d, &form.right)];
    let Family::Field(shape) = family(c) else {
        return quote!(two_sided(&(#left), &#known, &(#right), &[#(#names),*]));
    };
    let s = &d.letters.symbols;
    let dims = [shape.rows, shape.cols].map(|n| super::sizes::size(s, n));
    let known = element::array(c, known);
    let [first, second] = &names;
    // The step divides by a scalar factor.
    let is_number = |e: &Expr| e.shape().is_scalar();
    let one = |e: &Expr| *e == expr::integer(1);
    match (is_number(&form.left), is_number(&form.right)) {
        (true, true) => quote!(divided(&#known, #left, #first)),
        (false, true) if one(&form.right) => quote!(left_sided(&(#left), &#known, #first)),
        (true, false) if one(&form.left) => quote!(right_sided(&#known, &(#right), #second)),
        (left_number, right_number) => {
            let [rows, cols] = &dims;
            let whole = |number: bool, value: TokenStream, n: &TokenStream| match number {
                true => quote!(SMatrix::<T, #n, #n>::from_diagonal_element(#value)),
                false => value,
            };
            let (left, right) = (
                whole(left_number, left, rows),
                whole(right_number, right, cols),
            );
            quote!(two_sided_increment(&(#left), &#known, &(#right), &[#(#names),*]))
        }
    }
}
