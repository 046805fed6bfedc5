//! The syntax tree: the text as written, with the position of every part, before names and shapes are resolved.

use crate::algebra::Rational;
use crate::diagnostic::Place;
use crate::expr::Constant;

/// A name and its position.
#[derive(Clone, Debug)]
pub struct Name {
    /// The text.
    pub text: String,
    /// Its token.
    pub place: Place,
    /// How it is typeset, in LaTeX, where a declaration says so, and the token that does.
    pub typeset: Option<(String, Place)>,
    /// Whether it is the name of a copy at a site, which the model does not write.
    pub is_copy: bool,
}

impl Name {
    /// How it is typeset, where a declaration says so.
    pub fn latex(&self) -> Option<String> {
        self.typeset.as_ref().map(|(text, _)| text.clone())
    }
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expression {
    /// Its kind.
    pub kind: Kind,
    /// From its first to its last token.
    pub place: Place,
}

/// Kinds of expressions.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A number.
    Number(Rational),
    /// A number that exact arithmetic does not follow.
    Constant(Constant),
    /// A name.
    Name(String),
    /// An expression with a required shape: an argument or a value of a function that is written out.
    Shaped(Box<Expression>, Kindred),
    /// A sum of signed terms: `true` marks a term that is subtracted.
    Sum(Vec<(bool, Expression)>),
    /// A product in order.
    Product(Vec<Expression>),
    /// A quotient.
    Quotient(Box<Expression>, Box<Expression>),
    /// The opposite.
    Neg(Box<Expression>),
    /// `x^T`.
    Transpose(Box<Expression>),
    /// `x^q`.
    Power(Box<Expression>, Rational),
    /// A name with arguments in parentheses.
    Call(Name, Vec<Expression>),
    /// `v[i]` or `A[i, j]`, counted from 1.
    Component(Box<Expression>, Vec<u64>),
}

/// A size: a number or the name of a declared dimension.
#[derive(Clone, Debug)]
pub enum Size {
    /// A number.
    Number(u64, Place),
    /// A name.
    Name(Name),
}

/// A shape or a group: a name with sizes, `Sym<3>`.
#[derive(Clone, Debug)]
pub struct Kindred {
    /// `Real`, `Vec`, `SO`, ...
    pub name: Name,
    /// Its sizes.
    pub sizes: Vec<Size>,
    /// The whole of it.
    pub place: Place,
}

impl Kindred {
    /// As it is written: `Vec<3>`.
    pub fn text(&self) -> String {
        let sizes = self.sizes.iter().map(|size| match size {
            Size::Number(n, _) => n.to_string(),
            Size::Name(name) => name.text.clone(),
        });
        let sizes: Vec<String> = sizes.collect();
        match sizes.is_empty() {
            true => self.name.text.clone(),
            false => format!("{}<{}>", self.name.text, sizes.join(", ")),
        }
    }

    /// How many components a number or a vector of known size has; nothing of other shapes.
    pub fn components(&self) -> Option<usize> {
        match (self.name.text.as_str(), self.sizes.as_slice()) {
            ("Real", []) => Some(1),
            ("Vec", [Size::Number(n, _)]) => usize::try_from(*n).ok(),
            _ => None,
        }
    }

    /// The shape of a number, at this place.
    pub fn number(place: Place) -> Kindred {
        Kindred {
            name: Name {
                text: "Real".to_owned(),
                place,
                typeset: None,
                is_copy: false,
            },
            sizes: Vec::new(),
            place,
        }
    }
}

/// How purely nodal terms enter the action of a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NodeRule {
    /// Half on each adjacent edge: second order.
    Symmetric,
    /// On the edge that ends at the node.
    Incoming,
    /// On the edge that starts at the node.
    Outgoing,
}

/// A relation between two numbers or matrices in an assumption.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Comparison {
    /// `==`
    Equal,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
    /// `<`
    Less,
    /// `<=`
    AtMost,
}

impl Comparison {
    /// The opposite of an inequality.
    pub fn opposite(self) -> Option<Comparison> {
        match self {
            Comparison::Equal => None,
            Comparison::Greater => Some(Comparison::AtMost),
            Comparison::AtLeast => Some(Comparison::Less),
            Comparison::Less => Some(Comparison::AtLeast),
            Comparison::AtMost => Some(Comparison::Greater),
        }
    }
}

/// Which sites of a label hold a quantity.
#[derive(Clone, Debug)]
pub enum Site {
    /// The nodes of the chain.
    Nodes,
    /// The segments between them.
    Segments,
    /// The members of a set, by its label.
    Set(Name),
}

/// `at nodes`, `at segments`, `at a`.
#[derive(Clone, Debug)]
pub struct At {
    /// The sites.
    pub site: Site,
    /// The word or the name.
    pub place: Place,
}

/// One way to end a chain: `pinned { φ = given; }`.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name, by which a case chooses it.
    pub name: Name,
    /// Parameters of its own.
    pub params: Vec<(Vec<Name>, Kindred)>,
    /// Configurations that are given at this end.
    pub given: Vec<Name>,
    /// Its terms in the Lagrangian.
    pub terms: Vec<Expression>,
}

/// Where places of particles lie: `on torus(L)`, `on box`.
#[derive(Clone, Debug)]
pub enum Extent {
    /// A torus, with the name of its lengths.
    Torus(Name),
    /// A box, each direction of which closes on itself or ends in walls, as the case says.
    Box(Place),
}

/// A statement.
#[derive(Clone, Debug)]
pub enum Statement {
    /// `label i in 0..N step s;`
    Label {
        /// The name of the index.
        index: Name,
        /// The name of the number of segments, or of sites of a ring or a set.
        count: Name,
        /// The name of the spacing.
        step: Option<Name>,
    },
    /// `periodic;`
    Periodic(Place),
    /// `end i = 0 { free; pinned { φ = given; } }`
    End {
        /// The index of the chain.
        label: Name,
        /// The end: `0`, or the name of the number of segments.
        at: Name,
        /// The alternatives, the first being the default.
        alternatives: Vec<Alternative>,
    },
    /// `dim n in A..=B;`
    Dim {
        /// Its name.
        name: Name,
        /// Smallest value.
        from: u64,
        /// Largest value.
        to: u64,
    },
    /// `time k step h;`
    Time {
        /// Name of the index.
        index: Name,
        /// Name of the step.
        step: Name,
    },
    /// `param a, b: SHAPE;`
    Param {
        /// The names.
        names: Vec<Name>,
        /// Their shape.
        shape: Kindred,
        /// Where they live along a label.
        at: Option<At>,
    },
    /// `assume CONDITION;`
    Assume {
        /// Left side.
        left: Expression,
        /// Relation.
        relation: Comparison,
        /// Right side.
        right: Expression,
        /// The whole condition.
        place: Place,
    },
    /// `group Λ: GROUP velocity Ω;`
    Group {
        /// The element.
        name: Name,
        /// The group.
        group: Kindred,
        /// Where it lives along a label.
        at: Option<At>,
        /// Its velocity.
        velocity: Name,
    },
    /// `field X, Y: SHAPE;`
    Field {
        /// The configurations, each in the additive group of the shape.
        names: Vec<Name>,
        /// Their shape.
        shape: Kindred,
        /// Where they live along a label.
        at: Option<At>,
        /// The parameter by which the value grows once around a ring.
        offset: Option<Name>,
        /// Where the values lie, for fields of places of particles.
        domain: Option<Extent>,
    },
    /// `advected Γ, S: SHAPE;`, `advected Γ: SHAPE = EXPR;`
    Advected {
        /// The quantities: one, where there is a definition.
        names: Vec<Name>,
        /// Their shape.
        shape: Kindred,
        /// Where they live along a label.
        at: Option<At>,
        /// The definition.
        definition: Option<Expression>,
    },
    /// `constraint next(X) = EXPR;`
    Constraint {
        /// The quantity.
        name: Name,
        /// The right side.
        value: Expression,
        /// The whole statement.
        place: Place,
    },
    /// `hold λ: a = b;`
    Hold {
        /// The multiplier.
        name: Name,
        /// Left side.
        left: Expression,
        /// Right side.
        right: Expression,
        /// The whole equation.
        place: Place,
    },
    /// `given f(SHAPE, SHAPE): SHAPE = PATH;`, `given f(SHAPE): SHAPE = "EXPRESSION";`, `given f(SHAPE): SHAPE = case;`
    Given {
        /// The name in the model.
        name: Name,
        /// Its arguments.
        arguments: Vec<Kindred>,
        /// Its value.
        value: Kindred,
        /// The Rust path of the function; its own name if it is written out.
        path: Name,
        /// Its definition, if it is written out: an expression for each component.
        components: Vec<Expression>,
        /// The same as it was written, between the quotes.
        texts: Vec<String>,
        /// The word `case`, if the case gives the definition: there are no components until it does.
        by_case: Option<Place>,
    },
    /// `grid n;`
    Grid(Name),
    /// `mesh A: SHAPE at a = FUNCTIONAL(X);`
    Mesh {
        /// Its values, by this name.
        name: Name,
        /// Its shape at one site.
        shape: Kindred,
        /// At which sites.
        at: Option<At>,
        /// The functional that computes it: a name of the runtime, or a Rust path.
        path: Name,
        /// Its arguments: a field or another functional first, then quantities that are constant in time.
        arguments: Vec<Name>,
    },
    /// `let W = EXPR;`
    Let {
        /// The name.
        name: Name,
        /// Its value.
        value: Expression,
    },
    /// `scale EXPR;`
    Scale(Expression),
    /// `node RULE;`
    Node(NodeRule, Place),
    /// `lagrangian = EXPR;`
    Lagrangian(Expression),
}

/// A model.
#[derive(Clone, Debug)]
pub struct Model {
    /// Lines of its documentation.
    pub docs: Vec<String>,
    /// Whether it is `pub`.
    pub public: bool,
    /// Its name.
    pub name: Name,
    /// Its statements in order.
    pub statements: Vec<Statement>,
    /// Lines of the documentation of each statement.
    pub remarks: Vec<Vec<String>>,
}
