//! The expression tree of a random model and the kinds of its letters.
//! Takes letters by their place in the table of symbols; gives trees that can be asked what they mention.

/// The kind of a letter. `Positive` is declared symmetric and has positive eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A scalar.
    Real,
    /// A column of three.
    Vector,
    /// A symmetric matrix.
    Symmetric,
    /// A symmetric matrix with positive eigenvalues.
    Positive,
    /// A skew matrix.
    Skew,
    /// A matrix without symmetry.
    Matrix,
    /// A rotation.
    Rotation,
}

/// How the group carries an advected quantity; written for the body side, transposed on the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// `Λᵀ a`.
    Vector,
    /// `Λᵀ S Λ`.
    Congruence,
    /// `Λᵀ B` for a matrix B.
    OneSided,
}

/// What a letter is in the model.
#[derive(Clone, Debug)]
pub enum Role {
    /// The configuration.
    Group,
    /// The velocity on the edge.
    Velocity,
    /// A constant.
    Parameter,
    /// A quantity carried by the group.
    Advected {
        /// The action.
        carried: Carried,
        /// What it is, if the model says so.
        definition: Option<Expr>,
    },
}

impl Role {
    /// The definition of an advected quantity.
    #[must_use]
    pub fn definition(&self) -> Option<&Expr> {
        match self {
            Self::Advected { definition, .. } => definition.as_ref(),
            _ => None,
        }
    }
}

/// A letter.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// As written.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// Its role.
    pub role: Role,
}

impl Symbol {
    /// A letter of a kind in a role.
    #[must_use]
    pub fn new(name: &str, kind: Kind, role: Role) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            role,
        }
    }
}

/// A subexpression with a name.
#[derive(Clone, Debug)]
pub struct Named {
    /// As written.
    pub name: String,
    /// The kind of its value.
    pub kind: Kind,
    /// What it stands for.
    pub expr: Expr,
}

/// An expression.
#[derive(Clone, Debug)]
pub enum Expr {
    /// A number, as typed and as meant.
    Number(&'static str, f64),
    /// The step.
    Step,
    /// The identity matrix.
    Identity,
    /// A unit vector, counted from 1.
    Axis(usize),
    /// A letter, by its place in the table.
    Symbol(usize),
    /// An advected quantity at the head of the edge.
    Next(usize),
    /// A named subexpression, by its place in the list.
    Let(usize),
    /// `-a`.
    Negated(Box<Expr>),
    /// `a + b`.
    Sum(Box<Expr>, Box<Expr>),
    /// `a - b`.
    Difference(Box<Expr>, Box<Expr>),
    /// `a*b`, or `a b` if the flag is set.
    Product(Box<Expr>, Box<Expr>, bool),
    /// `a/b` with a scalar b.
    Quotient(Box<Expr>, Box<Expr>),
    /// An integer power of a scalar, or the inverse of a matrix.
    Power(Box<Expr>, i32),
    /// The transpose.
    Transposed(Box<Expr>),
    /// A function of the language.
    Call(&'static str, Vec<Expr>),
    /// Parentheses that change nothing.
    Grouped(Box<Expr>),
}

impl Expr {
    /// A number.
    #[must_use]
    pub fn number(typed: &'static str, value: f64) -> Self {
        Self::Number(typed, value)
    }
    /// The sum with another.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self::Sum(Box::new(self), Box::new(other))
    }
    /// The difference to another.
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        Self::Difference(Box::new(self), Box::new(other))
    }
    /// The product, with or without a star.
    #[must_use]
    pub fn product(left: Self, right: Self, juxtaposed: bool) -> Self {
        Self::Product(Box::new(left), Box::new(right), juxtaposed)
    }
    /// The product with a star.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self::product(self, other, false)
    }
    /// The quotient by a scalar.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        Self::Quotient(Box::new(self), Box::new(other))
    }
    /// The negative.
    #[must_use]
    pub fn negated(self) -> Self {
        Self::Negated(Box::new(self))
    }
    /// An integer power.
    #[must_use]
    pub fn to_power(self, exponent: i32) -> Self {
        Self::Power(Box::new(self), exponent)
    }
    /// The transpose.
    #[must_use]
    pub fn transposed(self) -> Self {
        Self::Transposed(Box::new(self))
    }
    /// The same in parentheses.
    #[must_use]
    pub fn grouped(self) -> Self {
        Self::Grouped(Box::new(self))
    }
    /// A function of the language.
    #[must_use]
    pub fn call(name: &'static str, arguments: Vec<Self>) -> Self {
        Self::Call(name, arguments)
    }

    /// The direct parts.
    #[must_use]
    pub fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Number(..)
            | Self::Step
            | Self::Identity
            | Self::Axis(_)
            | Self::Symbol(_)
            | Self::Next(_)
            | Self::Let(_) => Vec::new(),
            Self::Negated(a) | Self::Power(a, _) | Self::Transposed(a) | Self::Grouped(a) => {
                vec![a]
            }
            Self::Sum(a, b)
            | Self::Difference(a, b)
            | Self::Product(a, b, _)
            | Self::Quotient(a, b) => vec![a, b],
            Self::Call(_, arguments) => arguments.iter().collect(),
        }
    }

    /// Whether a part, or a part of a named subexpression within, has a property.
    pub fn mentions(&self, lets: &[Named], property: &dyn Fn(&Self) -> bool) -> bool {
        if property(self) {
            return true;
        }
        if let Self::Let(index) = self {
            return lets
                .get(*index)
                .is_some_and(|named| named.expr.mentions(lets, property));
        }
        self.parts()
            .into_iter()
            .any(|part| part.mentions(lets, property))
    }

    /// The number of nodes of the tree.
    #[must_use]
    pub fn size(&self) -> usize {
        1 + self.parts().into_iter().map(Self::size).sum::<usize>()
    }
}
