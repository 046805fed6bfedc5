//! A random model: its groups, parameters, advected quantities and the summands of its action.
//! Takes a seed; gives the tables that the text and the oracle are both made of.

use super::grow;
use super::tree::{Shape, Tree};
use super::unreduced;
use crate::oracle::points::Source;
use crate::oracle::sides::{NodeRule, Side};

/// A group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// SO(n).
    Rotation(usize),
    /// SU(2), 4 x 4.
    Quaternion,
    /// SE(3), 4 x 4.
    Motion,
    /// GL(n).
    Linear(usize),
}

impl Family {
    /// Rows of its matrices.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::Rotation(n) | Self::Linear(n) => n,
            Self::Quaternion | Self::Motion => 4,
        }
    }

    /// Whether the inverse is the transpose.
    #[must_use]
    pub fn is_orthogonal(self) -> bool {
        matches!(self, Self::Rotation(_) | Self::Quaternion)
    }

    /// As the language writes it.
    #[must_use]
    pub fn text(self) -> String {
        match self {
            Self::Rotation(n) => format!("SO<{n}>"),
            Self::Quaternion => "SU<2>".to_owned(),
            Self::Motion => "SE<3>".to_owned(),
            Self::Linear(n) => format!("GL<{n}>"),
        }
    }
}

/// What a letter is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Real,
    /// A vector.
    Vector(usize),
    /// A symmetric matrix.
    Symmetric(usize),
    /// A symmetric matrix with positive eigenvalues.
    Positive(usize),
    /// A skew matrix.
    Skew(usize),
    /// A diagonal matrix.
    Diagonal(usize),
    /// Any matrix.
    Matrix(usize, usize),
    /// An element of a group.
    Element(Family),
}

impl Kind {
    /// Rows and columns.
    #[must_use]
    pub fn shape(self) -> Shape {
        match self {
            Self::Real => (1, 1),
            Self::Vector(n) => (n, 1),
            Self::Symmetric(n) | Self::Positive(n) | Self::Skew(n) | Self::Diagonal(n) => (n, n),
            Self::Matrix(n, m) => (n, m),
            Self::Element(family) => (family.size(), family.size()),
        }
    }

    /// As the language writes it.
    #[must_use]
    pub fn text(self) -> String {
        match self {
            Self::Real => "Real".to_owned(),
            Self::Vector(n) => format!("Vec<{n}>"),
            Self::Symmetric(n) | Self::Positive(n) => format!("Sym<{n}>"),
            Self::Skew(n) => format!("Skew<{n}>"),
            Self::Diagonal(n) => format!("Diag<{n}>"),
            Self::Matrix(n, m) if n == m => format!("Mat<{n}>"),
            Self::Matrix(n, m) => format!("Mat<{n}, {m}>"),
            Self::Element(family) => family.text(),
        }
    }
}

/// How a group acts on a quantity `c`, for an element `g` (on the body side its inverse), or for
/// the rotation that the element has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// `g c`.
    Forward,
    /// `g^-T c`.
    Dual,
    /// `g c g^T`.
    Congruence,
    /// `g^-T c g^-1`.
    DualCongruence,
    /// `g c g^-1`.
    Conjugation,
    /// `det(g) c`.
    Weight,
}

/// What a letter is in the model.
#[derive(Clone, Debug)]
pub enum Role {
    /// The configuration of a body.
    Element(usize),
    /// Its velocity.
    Velocity(usize),
    /// A constant.
    Parameter,
    /// A quantity carried by a body.
    Advected {
        /// The body.
        body: usize,
        /// How.
        action: Action,
        /// Whether the rotation of the element acts, not the element.
        turns: bool,
        /// The parameter that it is at the identity, where the model says so.
        definition: Option<usize>,
    },
    /// The motion of one body seen from another, `g1^-1 c g2`: of two on the body side.
    Relative {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// Whether the model says so, with `c = Id`.
        defined: bool,
    },
}

/// A letter.
#[derive(Clone, Debug)]
pub struct Letter {
    /// As written.
    pub name: String,
    /// What it is made of.
    pub kind: Kind,
    /// What it is for.
    pub role: Role,
}

/// A configuration.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its group.
    pub family: Family,
    /// The side of its variations.
    pub side: Side,
    /// The letter of the element; that of the velocity follows it.
    pub element: usize,
}

/// A random model.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its name, from the seed.
    pub name: String,
    /// Its configurations.
    pub bodies: Vec<Body>,
    /// All letters.
    pub letters: Vec<Letter>,
    /// Where nodal summands belong.
    pub rule: NodeRule,
    /// What is typed is so many times the action.
    pub scale: Option<Tree>,
    /// The summands as typed; `true` subtracts.
    pub summands: Vec<(bool, Tree)>,
}

/// Groups and products of groups, by turns.
const GROUPS: [&[Family]; 16] = {
    use Family::{Linear, Motion, Quaternion, Rotation};
    [
        &[Rotation(3)],
        &[Motion],
        &[Quaternion],
        &[Linear(3)],
        &[Rotation(4)],
        &[Rotation(3), Rotation(3)],
        &[Motion],
        &[Linear(2)],
        &[Rotation(3), Motion],
        &[Rotation(2)],
        &[Motion, Motion],
        &[Quaternion, Rotation(3)],
        &[Rotation(5)],
        &[Linear(3), Rotation(3)],
        &[Rotation(3), Quaternion, Rotation(2)],
        &[Quaternion, Quaternion],
    ]
};

impl Model {
    /// The model of a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        let mut source = Source::seeded(seed ^ 0x771d_e5ee);
        let turn = usize::try_from(seed).unwrap_or(0);
        let families = GROUPS[turn % GROUPS.len()];
        let mut model = Model {
            name: format!("Wide{seed}"),
            bodies: Vec::new(),
            letters: Vec::new(),
            rule: match source.below(8) {
                0 => NodeRule::Incoming,
                1 => NodeRule::Outgoing,
                _ => NodeRule::Symmetric,
            },
            scale: None,
            summands: Vec::new(),
        };
        for (i, family) in families.iter().enumerate() {
            // Linear groups are stepped on either side; mixed sides are allowed in products.
            let side = if source.chance(25) {
                Side::Space
            } else {
                Side::Body
            };
            let number = match families.len() {
                1 => String::new(),
                _ => (i + 1).to_string(),
            };
            let element = model.add(
                &format!("g{number}"),
                Kind::Element(*family),
                Role::Element(i),
            );
            model.add(
                &format!("V{number}"),
                Kind::Element(*family),
                Role::Velocity(i),
            );
            model.bodies.push(Body {
                family: *family,
                side,
                element,
            });
        }
        // Every third model is stated by its configurations at both ends of the step.
        if (turn / GROUPS.len()) % 3 == 2 {
            unreduced::state(&mut model, &mut source, turn);
        } else {
            grow::state(&mut model, &mut source, turn);
        }
        if source.chance(15) {
            model.scale = Some(Tree::Product(vec![Tree::number("2"), Tree::Step]));
        }
        model
    }

    /// Adds a letter and says which it is.
    pub fn add(&mut self, name: &str, kind: Kind, role: Role) -> usize {
        self.letters.push(Letter {
            name: name.to_owned(),
            kind,
            role,
        });
        self.letters.len() - 1
    }

    /// A new parameter.
    pub fn parameter(&mut self, kind: Kind) -> Tree {
        let initial = match kind {
            Kind::Real => "c",
            Kind::Vector(_) => "v",
            Kind::Symmetric(_) => "S",
            Kind::Positive(_) => "J",
            Kind::Skew(_) => "X",
            Kind::Diagonal(_) => "D",
            Kind::Matrix(..) => "A",
            Kind::Element(_) => "K",
        };
        let count = self
            .letters
            .iter()
            .filter(|l| matches!(l.role, Role::Parameter))
            .count();
        let index = self.add(&format!("{initial}{}", count + 1), kind, Role::Parameter);
        Tree::Letter(index, kind.shape())
    }

    /// A letter as an expression.
    #[must_use]
    pub fn letter(&self, index: usize) -> Tree {
        let shape = self.letters.get(index).map_or((1, 1), |l| l.kind.shape());
        Tree::Letter(index, shape)
    }

    /// Whether a summand has neither a velocity nor a value at the end of the edge.
    #[must_use]
    pub fn is_nodal(&self, summand: &Tree) -> bool {
        !summand.mentions(&|t| match t {
            Tree::Next(..) => true,
            Tree::Letter(index, _) => {
                matches!(
                    self.letters.get(*index).map(|l| &l.role),
                    Some(Role::Velocity(_))
                )
            }
            _ => false,
        })
    }

    /// Whether anything mentions the letter; configurations always stand.
    #[must_use]
    pub fn uses(&self, index: usize) -> bool {
        let names = |tree: &Tree| {
            tree.mentions(&|t| match t {
                Tree::Letter(other, _) | Tree::Next(other, _) => *other == index,
                _ => false,
            })
        };
        let here = self.summands.iter().any(|(_, t)| names(t));
        let standing = matches!(
            self.letters.get(index).map(|l| &l.role),
            Some(Role::Element(_) | Role::Velocity(_))
        );
        let defines = || {
            self.letters
                .iter()
                .enumerate()
                .any(|(other, l)| match l.role {
                    Role::Advected {
                        definition: Some(by),
                        ..
                    } => by == index && self.uses(other),
                    _ => false,
                })
        };
        here || standing || defines()
    }
}
