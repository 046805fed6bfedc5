//! Projects matrices onto a structure: the gradient with respect to a symmetric, skew or diagonal letter has the same
//! structure. Takes any matrix; gives its projection in the pairing `tr(A^T B)`, term by term. Terms that have the
//! structure are unchanged.

use super::shape::Structure;
use super::*;
use crate::expr::symbol::Symbols;

/// The projection of a gradient onto the structure of its letter.
pub fn projected(symbols: &Symbols, structure: Structure, e: &Expr) -> Expr {
    let which = match structure {
        Structure::Symmetric => Part::Symmetric,
        Structure::Skew => Part::Skew,
        Structure::Diagonal => Part::Diagonal,
        // These groups are not linear spaces of matrices. The multiplier of the group accounts for the remainder.
        Structure::General
        | Structure::Orthogonal
        | Structure::Invertible
        | Structure::UnitQuaternion
        | Structure::RigidMotion => return e.clone(),
    };
    of_term(symbols, which, e)
}

fn of_term(symbols: &Symbols, which: Part, e: &Expr) -> Expr {
    let go = |x: &Expr| of_term(symbols, which, x);
    match e.node() {
        Node::Sum(terms) => sum(terms.iter().map(go).collect::<Vec<_>>(), e.shape()),
        Node::Neg(a) => neg(go(a)),
        Node::Quotient(a, b) => quotient(go(a), b.clone()),
        Node::Product(list) => {
            let (numbers, word): (Vec<Expr>, Vec<Expr>) =
                list.iter().cloned().partition(|f| f.shape().is_scalar());
            let word = product(word);
            let inner = match word.node() {
                Node::Product(_) => of_word(symbols, which, word),
                _ => go(&word),
            };
            product(numbers.into_iter().chain([inner]))
        }
        _ => of_word(symbols, which, e.clone()),
    }
}

fn of_word(symbols: &Symbols, which: Part, word: Expr) -> Expr {
    let turned = transpose(symbols, word.clone());
    match which {
        Part::Symmetric if turned == word => word,
        Part::Symmetric => {
            // sym(X) = sym(X^T): the form with fewer transposes.
            let simpler = transposes(&turned) < transposes(&word);
            part(which, if simpler { turned } else { word })
        }
        Part::Skew if turned == neg(word.clone()) => word,
        Part::Skew if transposes(&turned) < transposes(&word) => neg(part(which, turned)),
        Part::Diagonal if is_diagonal(symbols, &word) => word,
        Part::Diagonal if transposes(&turned) < transposes(&word) => part(which, turned),
        Part::Skew | Part::Diagonal => part(which, word),
    }
}

fn is_diagonal(symbols: &Symbols, e: &Expr) -> bool {
    match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::Diagonal,
        Node::Product(list) => list
            .iter()
            .all(|f| f.shape().is_scalar() || is_diagonal(symbols, f)),
        Node::Inverse(a) | Node::Adjugate(a) => is_diagonal(symbols, a),
        Node::Identity(_) | Node::Zero(_) | Node::Part(Part::Diagonal, _) => true,
        _ => false,
    }
}

fn transposes(e: &Expr) -> usize {
    let own = usize::from(matches!(e.node(), Node::Transpose(_)));
    let inner: usize = e.children().into_iter().map(transposes).sum();
    own + inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::symbol::Role;

    #[test]
    fn a_gradient_takes_the_structure_of_its_letter() {
        let mut s = Symbols::default();
        let three = Shape::square(Dim::Fixed(3));
        let w = s.add("ω", three, Structure::Orthogonal, Role::Velocity);
        let j = s.add("J", three, Structure::Symmetric, Role::Advected);
        let h = s.add("h", Shape::SCALAR, Structure::General, Role::Step);
        let (w, j, h) = (here(&s, w), here(&s, j), here(&s, h));
        let wt = transpose(&s, w.clone());
        // d tr(ω J)/dJ = ω^T; only its symmetric part counts.
        let raw = neg(quotient(wt.clone(), h.clone()));
        let expected = neg(quotient(part(Part::Symmetric, w.clone()), h));
        assert_eq!(projected(&s, Structure::Symmetric, &raw), expected);
        // A symmetric term is unchanged.
        let congruence = product([wt.clone(), j.clone(), w.clone()]);
        let mixed = add(congruence.clone(), wt.clone());
        let symmetric = add(congruence, part(Part::Symmetric, w.clone()));
        assert_eq!(projected(&s, Structure::Symmetric, &mixed), symmetric);
        let skew = neg(part(Part::Skew, w.clone()));
        assert_eq!(projected(&s, Structure::Skew, &wt), skew);
        assert_eq!(
            projected(&s, Structure::Skew, &hat(unit(Dim::Fixed(3), 0))),
            hat(unit(Dim::Fixed(3), 0))
        );
        let diagonal = part(Part::Diagonal, w.clone());
        assert_eq!(projected(&s, Structure::Diagonal, &w), diagonal);
        assert_eq!(projected(&s, Structure::Diagonal, &wt), diagonal);
        assert_eq!(projected(&s, Structure::General, &wt), wt);
    }
}
