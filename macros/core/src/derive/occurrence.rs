//! Finds a velocity in a term of a normal form. Takes the term; decides whether it is free of the velocity, linear in
//! it, or neither.

use super::variation::at;
use crate::algebra::{Algebra, Factor, Monomial, Poly, Rational, Source, Term};
use crate::expr::shape::Shape;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Shift};

/// The occurrence of a velocity in a term.
pub(super) enum Occurrence {
    /// Nowhere.
    Free,
    /// Once, as a factor of the word.
    Once {
        /// The index of the factor.
        place: usize,
        /// Whether the velocity is transposed.
        transposed: bool,
    },
    /// Several times, inverted, or inside a scalar or a map.
    Otherwise,
}

/// The occurrence in a term of the velocity of the edge that begins at the node.
pub(super) fn occurrence(algebra: &Algebra, term: &Term, velocity: SymbolId) -> Occurrence {
    if in_number(algebra, &term.monomial, velocity) {
        return Occurrence::Otherwise;
    }
    let w = at(velocity, Shift::HERE);
    let is_velocity =
        |f: &Factor| matches!(f, Factor::Letter { source: Source::Letter(l), .. } if *l == w);
    // Also inside expressions that a letter replaces: an inverse, or a value of a functional.
    let holds = |f: &Factor| match f {
        Factor::Letter {
            source: Source::Opaque(i),
            ..
        } => expr::contains(&algebra.opaque_matrix(*i), w),
        _ => is_velocity(f),
    };
    let mut places = (0..term.word.len()).filter(|p| in_word(&term.word[*p], &holds));
    let place = match (places.next(), places.next()) {
        (None, _) => return Occurrence::Free,
        (Some(place), None) => place,
        (Some(_), Some(_)) => return Occurrence::Otherwise,
    };
    match &term.word[place] {
        f @ Factor::Letter {
            transposed,
            inverted: false,
            ..
        } if is_velocity(f) => Occurrence::Once {
            place,
            transposed: *transposed,
        },
        _ => Occurrence::Otherwise,
    }
}

fn in_word(f: &Factor, wanted: &impl Fn(&Factor) -> bool) -> bool {
    match f {
        Factor::Hat(word)
        | Factor::Vee { word, .. }
        | Factor::Pure(word)
        | Factor::Imaginary { word, .. } => word.iter().any(|g| in_word(g, wanted)),
        Factor::Letter { .. }
        | Factor::Unit { .. }
        | Factor::Inclusion { .. }
        | Factor::Axial { .. } => wanted(f),
    }
}

fn in_number(algebra: &Algebra, monomial: &Monomial, velocity: SymbolId) -> bool {
    let term = Term {
        monomial: monomial.clone(),
        word: Vec::new(),
    };
    let number = algebra.raise(&Poly::term(Shape::SCALAR, Rational::ONE, term));
    expr::letters(&number).iter().any(|l| l.symbol == velocity)
}
