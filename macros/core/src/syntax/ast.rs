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
    /// Its LaTeX, if a declaration gives it, and the token of that LaTeX.
    pub typeset: Option<(String, Place)>,
    /// Whether it names a copy at a site and does not occur in the model text.
    pub is_copy: bool,
}

impl Name {
    /// Its LaTeX, if a declaration gives it.
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

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A number.
    Number(Rational),
    /// A number outside the range of exact arithmetic.
    Constant(Constant),
    /// A name.
    Name(String),
    /// An expression with a required shape: the argument or value of a user-defined function.
    Shaped(Box<Expression>, SizedName),
    /// A sum of signed terms: `true` marks a term that is subtracted.
    Sum(Vec<(bool, Expression)>),
    /// A product in order.
    Product(Vec<Expression>),
    /// A quotient.
    Quotient(Box<Expression>, Box<Expression>),
    /// The negative.
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
pub struct SizedName {
    /// `Real`, `Vec`, `SO`, ...
    pub name: Name,
    /// Its sizes.
    pub sizes: Vec<Size>,
    /// The whole of it.
    pub place: Place,
}

impl SizedName {
    /// Its text: `Vec<3>`.
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

    /// The number of components of a scalar or a vector of known size; `None` for other shapes.
    pub fn components(&self) -> Option<usize> {
        match (self.name.text.as_str(), self.sizes.as_slice()) {
            ("Real", []) => Some(1),
            ("Vec", [Size::Number(n, _)]) => usize::try_from(*n).ok(),
            _ => None,
        }
    }

    /// The shape of a scalar, at this position.
    pub fn number(place: Place) -> SizedName {
        SizedName {
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

/// How nodal terms enter the action of a step.
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
    /// The negation of an inequality.
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

/// The sites of a label at which a quantity is defined.
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

/// An end condition of a chain: `pinned { φ = given; }`.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name, by which a case chooses it.
    pub name: Name,
    /// Parameters of its own.
    pub params: Vec<(Vec<Name>, SizedName)>,
    /// Configurations that are prescribed at this end.
    pub given: Vec<Name>,
    /// Its terms in the Lagrangian.
    pub terms: Vec<Expression>,
}

/// The domain of particle positions: `on torus(L)`, `on box`.
#[derive(Clone, Debug)]
pub enum Extent {
    /// A torus, with the name of its lengths.
    Torus(Name),
    /// A box; in each direction a case makes it periodic or bounded by walls.
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
        /// Name of the step size.
        step: Name,
    },
    /// `param a, b: SHAPE;`
    Param {
        /// The names.
        names: Vec<Name>,
        /// Their shape.
        shape: SizedName,
        /// Its sites along a label.
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
        group: SizedName,
        /// Its sites along a label.
        at: Option<At>,
        /// Its velocity.
        velocity: Name,
    },
    /// `field X, Y: SHAPE;`
    Field {
        /// The configurations, each in the additive group of the shape.
        names: Vec<Name>,
        /// Their shape.
        shape: SizedName,
        /// Its sites along a label.
        at: Option<At>,
        /// The parameter by which the value grows once around a ring.
        offset: Option<Name>,
        /// The domain of the values, for fields of particle positions.
        domain: Option<Extent>,
    },
    /// `advected Γ, S: SHAPE;`, `advected Γ: SHAPE = EXPR;`
    Advected {
        /// The quantities; only one if there is a definition.
        names: Vec<Name>,
        /// Their shape.
        shape: SizedName,
        /// Its sites along a label.
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
        arguments: Vec<SizedName>,
        /// Its value.
        value: SizedName,
        /// The Rust path of the function; its own name if it is defined by a formula.
        path: Name,
        /// Its formulas, one expression for each component; empty if it is not defined by a formula.
        components: Vec<Expression>,
        /// The text of the formulas between the quotes.
        texts: Vec<String>,
        /// The word `case`, if the case defines the function; its formulas are then empty until the case is read.
        by_case: Option<Place>,
    },
    /// `grid n;`
    Grid(Name),
    /// `mesh A: SHAPE at a = FUNCTIONAL(X);`
    Mesh {
        /// The name of its values.
        name: Name,
        /// Its shape at one site.
        shape: SizedName,
        /// Its sites.
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
