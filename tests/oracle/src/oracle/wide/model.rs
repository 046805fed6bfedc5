//! A random model: its groups, parameters, advected quantities and the summands of its action.
//! Takes a seed; gives the tables that the text and the oracle are both made of.

use super::grow;
use super::point::Point;
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
    /// SE(2), 3 x 3.
    Plane,
    /// A field: numbers, vectors or matrices that are added.
    Added(usize, usize),
}

impl Family {
    /// Rows of its matrices.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::Rotation(n) | Self::Linear(n) | Self::Added(n, _) => n,
            Self::Quaternion | Self::Motion => 4,
            Self::Plane => 3,
        }
    }

    /// The dimension of the space that an element turns.
    #[must_use]
    pub fn turned(self) -> usize {
        match self {
            Self::Plane => 2,
            _ => 3,
        }
    }

    /// Whether an element turns space and moves it.
    #[must_use]
    pub fn is_motion(self) -> bool {
        matches!(self, Self::Motion | Self::Plane)
    }

    /// Whether it is a field.
    #[must_use]
    pub fn is_added(self) -> bool {
        matches!(self, Self::Added(..))
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
            Self::Plane => "SE<2>".to_owned(),
            Self::Added(1, 1) => Kind::Real.text(),
            Self::Added(n, 1) => Kind::Vector(n).text(),
            Self::Added(n, m) => Kind::Matrix(n, m).text(),
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
            Self::Element(Family::Added(n, m)) => (n, m),
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

impl Role {
    /// Whether a node holds the letter: what is computed from others is not given.
    #[must_use]
    pub fn is_given(&self) -> bool {
        match self {
            Self::Element(_) => true,
            Self::Advected { definition, .. } => definition.is_none(),
            Self::Relative { defined, .. } => !defined,
            Self::Parameter | Self::Velocity(_) => false,
        }
    }
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
    /// How the text is written, which changes no meaning.
    pub style: Style,
}

/// How a text is written.
#[derive(Clone, Debug)]
pub struct Style {
    /// The name of the time index.
    pub time: &'static str,
    /// The name of the step.
    pub step: &'static str,
    /// Whether only the parentheses stand that the precedence of the language asks for.
    pub bare: bool,
    /// Whether products are written without a sign where that is possible.
    pub juxtaposed: bool,
    /// A part of a summand that has a name of its own.
    pub named: Option<Tree>,
}

/// Groups and products of groups, by turns.
const GROUPS: [&[Family]; 20] = {
    use Family::{Added, Linear, Motion, Plane, Quaternion, Rotation};
    [
        &[Rotation(3)],
        &[Motion],
        &[Quaternion],
        &[Linear(3)],
        &[Rotation(4)],
        &[Rotation(3), Rotation(3)],
        &[Plane],
        &[Linear(2)],
        &[Added(3, 1), Rotation(3)],
        &[Rotation(3), Motion],
        &[Rotation(2)],
        &[Motion, Added(1, 1)],
        &[Motion, Motion],
        &[Quaternion, Rotation(3)],
        &[Rotation(5)],
        &[Linear(3), Added(3, 3), Added(3, 1)],
        &[Linear(3), Rotation(3)],
        &[Rotation(3), Quaternion, Rotation(2)],
        &[Added(3, 1), Quaternion],
        &[Quaternion, Quaternion],
    ]
};

impl Model {
    /// A model of these configurations, without an action.
    #[must_use]
    pub fn of(name: String, families: &[(Family, Side)]) -> Self {
        let mut model = Model {
            name,
            bodies: Vec::new(),
            letters: Vec::new(),
            rule: NodeRule::Symmetric,
            scale: None,
            summands: Vec::new(),
            style: Style {
                time: "k",
                step: "h",
                bare: false,
                juxtaposed: false,
                named: None,
            },
        };
        for (i, (family, side)) in families.iter().enumerate() {
            let number = match families.len() {
                1 => String::new(),
                _ => (i + 1).to_string(),
            };
            let kind = Kind::Element(*family);
            let element = model.add(&format!("g{number}"), kind, Role::Element(i));
            model.add(&format!("V{number}"), kind, Role::Velocity(i));
            model.bodies.push(Body {
                family: *family,
                side: *side,
                element,
            });
        }
        model
    }

    /// The model of a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        let mut source = Source::seeded(seed ^ 0x771d_e5ee);
        let turn = usize::try_from(seed).unwrap_or(0);
        let families = GROUPS[turn % GROUPS.len()];
        let rule = match source.below(8) {
            0 => NodeRule::Incoming,
            1 => NodeRule::Outgoing,
            _ => NodeRule::Symmetric,
        };
        // Linear groups are stepped on either side; mixed sides are allowed in products.
        let bodies = families
            .iter()
            .map(|family| match source.chance(25) && !family.is_added() {
                true => (*family, Side::Space),
                false => (*family, Side::Body),
            });
        let bodies: Vec<(Family, Side)> = bodies.collect();
        let mut model = Self::of(format!("Wide{seed}"), &bodies);
        model.rule = rule;
        // Every third model is stated by its configurations at both ends of the step.
        if (turn / GROUPS.len()) % 3 == 2 {
            unreduced::state(&mut model, &mut source, turn);
        } else {
            grow::state(&mut model, &mut source, turn);
        }
        if source.chance(15) {
            model.scale = Some(Tree::Product(vec![Tree::number("2"), Tree::Step]));
        }
        // A summand without a variation tests only that the engine finds nothing.
        let varied = (0..model.summands.len()).map(|k| model.varies(k));
        let mut varied = varied.collect::<Vec<bool>>().into_iter();
        model.summands.retain(|_| varied.next() == Some(true));
        model.write_otherwise(&mut Source::seeded(seed ^ 0x57_1e));
        model
    }

    /// Chooses how the text is written.
    fn write_otherwise(&mut self, source: &mut Source) {
        if source.chance(10) {
            (self.style.time, self.style.step) = ("i", "s");
        }
        self.style.bare = source.chance(50);
        self.style.juxtaposed = source.chance(20);
        let parts = self.summands.iter().flat_map(|(_, t)| t.compounds());
        let parts: Vec<&Tree> = parts.collect();
        if source.chance(45) {
            self.style.named = source.choose(&parts).map(|t| (*t).clone());
        }
    }

    /// Whether a summand alone has a variation at some of a few random points.
    fn varies(&self, summand: usize) -> bool {
        let alone = Model {
            summands: vec![self.summands[summand].clone()],
            scale: None,
            ..self.clone()
        };
        let mut source = Source::seeded(7);
        (0..3).any(|_| {
            let point = Point::draw(&alone, &mut source, 0.5);
            let nodes = std::array::from_fn(|_| point.node(&mut source));
            let found = point.stationarity(&nodes).derivative;
            // Values are of order one: what is left of an identity by rounding is far below. What is no number stays.
            found.iter().any(|x| x.is_nan() || x.abs() > 1e-9)
        })
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

    /// Whether a summand is a function of the end of the edge alone: it is a potential there, and momenta of nodes have
    /// half of it.
    #[must_use]
    pub fn is_of_the_end(&self, summand: &Tree) -> bool {
        let moves = |role: &Role| !matches!(role, Role::Parameter);
        let here = summand.mentions(&|t| match t {
            Tree::Letter(index, _) => self.letters.get(*index).is_some_and(|l| moves(&l.role)),
            _ => false,
        });
        !here && summand.mentions(&|t| matches!(t, Tree::Next(..)))
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
