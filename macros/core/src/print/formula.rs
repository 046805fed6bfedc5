//! Displayed mathematics above the level of expressions: relations, coadjoint action, diamonds, gradients,
//! variations, pairings, and words between formulas. A formula is a closed tree with expressions as leaves; every
//! renderer prints it.

mod mapped;

use crate::algebra::Rational;
use crate::expr::{Expr, Letter};

/// A formula of a derivation.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Formula {
    /// An expression, with its time indices.
    Expr(Expr),
    /// A name that is not a symbol of the model, e.g. `S_d`, `T^*G`. Greek words become letters, and trailing digits
    /// of the base become a subscript.
    Name {
        /// The letter or word, e.g. `ℓ`, `Omega`, `Diff`.
        base: String,
        /// Subscript as text, e.g. `k+1`.
        sub: Option<String>,
        /// Superscript as text, e.g. `R`.
        sup: Option<String>,
    },
    /// `a = b = ...`: one relation between consecutive members.
    Relation(Vec<Formula>, Relation),
    /// `a + b + ...`; a [`Formula::Neg`] term is subtracted.
    Sum(Vec<Formula>),
    /// `a - b`.
    Diff(Box<Formula>, Box<Formula>),
    /// `-a`.
    Neg(Box<Formula>),
    /// A product, in order.
    Product(Vec<Formula>),
    /// A quotient.
    Quotient(Box<Formula>, Box<Formula>),
    /// A rational power.
    Power(Box<Formula>, Rational),
    /// The transpose.
    Transpose(Box<Formula>),
    /// The inverse.
    Inverse(Box<Formula>),
    /// `a · b`.
    Dot(Box<Formula>, Box<Formula>),
    /// `a × b`.
    Cross(Box<Formula>, Box<Formula>),
    /// `a ◇ b`, the momentum map of an action: `⟨a ◇ b, ξ⟩ = ⟨a, ξ_V(b)⟩` (thesis 2.82).
    Diamond(Box<Formula>, Box<Formula>),
    /// `[a, b]`.
    Bracket(Box<Formula>, Box<Formula>),
    /// `⟨a, b⟩`.
    Pairing(Box<Formula>, Box<Formula>),
    /// `Ad_g ξ = g ξ g⁻¹`.
    Ad {
        /// The group element.
        group: Box<Formula>,
        /// The element of the Lie algebra.
        argument: Box<Formula>,
    },
    /// `Ad*_g μ`, the dual of `Ad_g` (thesis 2.87).
    AdStar {
        /// The group element.
        group: Box<Formula>,
        /// The momentum.
        momentum: Box<Formula>,
    },
    /// `ad*_ξ μ`, the dual of `ad_ξ η = [ξ, η]`.
    LieAdStar {
        /// The element of the Lie algebra.
        algebra: Box<Formula>,
        /// The momentum.
        momentum: Box<Formula>,
    },
    /// `da/dt`.
    Rate(Box<Formula>),
    /// A matrix by its blocks, row by row.
    Matrix(Vec<Vec<Formula>>),
    /// The formula in continuous time: letters do not have time indices.
    Continuous(Box<Formula>),
    /// `∇_x ℓ`, the gradient in the pairing `tr(Aᵀ B)`.
    Gradient {
        /// Name of the function; scripts as in [`Formula::name`].
        of: String,
        /// The variable of differentiation.
        wrt: Letter,
    },
    /// `δa`, a first variation.
    Variation(Box<Formula>),
    /// `d/dε|_{ε=0} a`.
    Tangent {
        /// Name of the parameter.
        parameter: String,
        /// The differentiated formula.
        of: Box<Formula>,
    },
    /// A named operator applied to one argument.
    Operator(Operator, Box<Formula>),
    /// The skew matrix of a vector.
    HatOf(Box<Formula>),
    /// `|a|`.
    Norm(Box<Formula>),
    /// `f(a, b, ...)`.
    Apply {
        /// The function.
        function: Box<Formula>,
        /// Its arguments.
        arguments: Vec<Formula>,
    },
    /// A sum over an index.
    SumOver {
        /// The index.
        index: String,
        /// First value.
        from: Option<String>,
        /// Last value.
        to: Option<String>,
        /// The summand.
        of: Box<Formula>,
    },
    /// Brackets even where they are not needed.
    Grouped(Box<Formula>),
    /// Formulas separated by commas.
    List(Vec<Formula>),
    /// Relations on separate lines under one number, aligned at their signs.
    Rows(Vec<Formula>),
    /// Formulas and words in sequence, e.g. a relation, `for all`, a letter.
    Sequence(Vec<Formula>),
    /// Words.
    Text(String),
}

/// Relations between two sides.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Relation {
    /// `=`
    Equal,
    /// `:=`
    Defined,
    /// `→`
    Carried,
    /// `≡`
    Identical,
    /// `≈`
    Approximate,
    /// `∈`
    Member,
    /// `<`
    Less,
    /// `≤`
    AtMost,
    /// `>`
    Greater,
    /// `≥`
    AtLeast,
    /// `⟹`
    Implies,
}

/// Operators written as a name with an argument in brackets.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Operator {
    /// The trace.
    Trace,
    /// The determinant.
    Det,
    /// `(A + Aᵀ)/2`.
    Sym,
    /// `(A - Aᵀ)/2`.
    Skew,
    /// The diagonal.
    Diag,
    /// The axial vector of the skew part.
    Vee,
    /// Exponential.
    Exp,
    /// Logarithm.
    Log,
}

impl From<Expr> for Formula {
    fn from(e: Expr) -> Self {
        Formula::Expr(e)
    }
}

impl Formula {
    /// A name with scripts in LaTeX notation: `M_k`, `ℓ_{k+1}`, `J^R_k`.
    pub fn name(text: &str) -> Formula {
        let parsed = super::name::parse(text);
        Formula::Name {
            base: parsed.base,
            sub: (!parsed.subs.is_empty()).then(|| parsed.subs.join(",")),
            sup: parsed.sup,
        }
    }

    /// Words.
    pub fn text(words: &str) -> Formula {
        Formula::Text(words.to_owned())
    }

    /// `a = b`.
    pub fn equal(a: impl Into<Formula>, b: impl Into<Formula>) -> Formula {
        Formula::Relation(vec![a.into(), b.into()], Relation::Equal)
    }

    /// `a := b`.
    pub fn defined(a: impl Into<Formula>, b: impl Into<Formula>) -> Formula {
        Formula::Relation(vec![a.into(), b.into()], Relation::Defined)
    }

    /// `a - b`.
    pub fn minus(a: impl Into<Formula>, b: impl Into<Formula>) -> Formula {
        Formula::Diff(Box::new(a.into()), Box::new(b.into()))
    }

    /// `-a`.
    pub fn neg(a: impl Into<Formula>) -> Formula {
        Formula::Neg(Box::new(a.into()))
    }

    /// `Ad*_g μ`.
    pub fn ad_star(group: impl Into<Formula>, momentum: impl Into<Formula>) -> Formula {
        Formula::AdStar {
            group: Box::new(group.into()),
            momentum: Box::new(momentum.into()),
        }
    }

    /// `da/dt`.
    pub fn rate(a: impl Into<Formula>) -> Formula {
        Formula::Rate(Box::new(a.into()))
    }

    /// The formula without time indices.
    pub fn continuous(a: impl Into<Formula>) -> Formula {
        Formula::Continuous(Box::new(a.into()))
    }

    /// `ad*_ξ μ`.
    pub fn lie_ad_star(algebra: impl Into<Formula>, momentum: impl Into<Formula>) -> Formula {
        Formula::LieAdStar {
            algebra: Box::new(algebra.into()),
            momentum: Box::new(momentum.into()),
        }
    }

    /// `a ◇ b`.
    pub fn diamond(a: impl Into<Formula>, b: impl Into<Formula>) -> Formula {
        Formula::Diamond(Box::new(a.into()), Box::new(b.into()))
    }

    /// `⟨a, b⟩`.
    pub fn pairing(a: impl Into<Formula>, b: impl Into<Formula>) -> Formula {
        Formula::Pairing(Box::new(a.into()), Box::new(b.into()))
    }

    /// `∇_x ℓ`.
    pub fn gradient(of: &str, wrt: Letter) -> Formula {
        Formula::Gradient {
            of: of.to_owned(),
            wrt,
        }
    }

    /// `δa`.
    pub fn variation(a: impl Into<Formula>) -> Formula {
        Formula::Variation(Box::new(a.into()))
    }

    /// A named operator applied to its argument.
    pub fn operator(operator: Operator, a: impl Into<Formula>) -> Formula {
        Formula::Operator(operator, Box::new(a.into()))
    }

    /// The transpose.
    pub fn transpose(a: impl Into<Formula>) -> Formula {
        Formula::Transpose(Box::new(a.into()))
    }

    /// The skew matrix of a vector.
    pub fn hat(a: impl Into<Formula>) -> Formula {
        Formula::HatOf(Box::new(a.into()))
    }

    /// `f(a, ...)`.
    pub fn apply(function: Formula, arguments: Vec<Formula>) -> Formula {
        Formula::Apply {
            function: Box::new(function),
            arguments,
        }
    }
}
