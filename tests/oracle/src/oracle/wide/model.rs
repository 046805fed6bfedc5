//! A random model from a seed: its groups, parameters, advected quantities and the summands of its action. Both the text and the
//! oracle use these tables.

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
    /// A field of scalars, vectors or matrices, which are additive.
    Added(usize, usize),
}

impl Family {
    /// Number of rows of its matrices.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::Rotation(n) | Self::Linear(n) | Self::Added(n, _) => n,
            Self::Quaternion | Self::Motion => 4,
            Self::Plane => 3,
        }
    }

    /// The dimension of the space that an element rotates.
    #[must_use]
    pub fn turned(self) -> usize {
        match self {
            Self::Plane => 2,
            _ => 3,
        }
    }

    /// Whether an element rotates and translates.
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

    /// The type in the model language.
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

/// The type of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A scalar.
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

    /// The type in the model language.
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

/// How a group element `g` acts on a quantity `c`. On the body side the inverse of `g` acts; some quantities use only its rotation.
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

/// The role of a symbol in the model.
#[derive(Clone, Debug)]
pub enum Role {
    /// The configuration of a body.
    Element(usize),
    /// Its velocity.
    Velocity(usize),
    /// A constant.
    Parameter,
    /// A quantity advected by a body.
    Advected {
        /// The body.
        body: usize,
        /// The action.
        action: Action,
        /// Whether only the rotation of the element acts.
        turns: bool,
        /// The parameter that gives its value at the identity, if the model defines the quantity.
        definition: Option<usize>,
    },
    /// The relative motion of two body-side bodies, `g1^-1 c g2`.
    Relative {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// Whether the model defines it, with `c = Id`.
        defined: bool,
    },
}

impl Role {
    /// Whether a node stores the symbol; computed symbols are not inputs.
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

/// A symbol.
#[derive(Clone, Debug)]
pub struct Letter {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: Kind,
    /// Its role.
    pub role: Role,
}

/// A configuration.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its group.
    pub family: Family,
    /// The side of its variations.
    pub side: Side,
    /// The index of the element's symbol; the velocity follows it.
    pub element: usize,
}

/// A random model.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its name, from the seed.
    pub name: String,
    /// Its configurations.
    pub bodies: Vec<Body>,
    /// All symbols.
    pub letters: Vec<Letter>,
    /// The edge to which nodal summands belong.
    pub rule: NodeRule,
    /// The factor between the stated sum and the action.
    pub scale: Option<Tree>,
    /// The summands as stated; `true` subtracts.
    pub summands: Vec<(bool, Tree)>,
    /// The style of the text, which does not change its meaning.
    pub style: Style,
}

/// The style of a text.
#[derive(Clone, Debug)]
pub struct Style {
    /// The name of the time index.
    pub time: &'static str,
    /// The name of the step size.
    pub step: &'static str,
    /// Whether the text contains only the parentheses that precedence requires.
    pub bare: bool,
    /// Whether products omit the multiplication sign if possible.
    pub juxtaposed: bool,
    /// A subexpression that gets its own `let` name.
    pub named: Option<Tree>,
}

/// Groups and products of groups, used in turn.
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
    /// A model with these configurations and no action.
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
        // Linear groups may use either side, and products may mix sides.
        let bodies = families
            .iter()
            .map(|family| match source.chance(25) && !family.is_added() {
                true => (*family, Side::Space),
                false => (*family, Side::Body),
            });
        let bodies: Vec<(Family, Side)> = bodies.collect();
        let mut model = Self::of(format!("Wide{seed}"), &bodies);
        model.rule = rule;
        // Every third round of models is stated by the configurations at both ends of the step.
        if (turn / GROUPS.len()) % 3 == 2 {
            unreduced::state(&mut model, &mut source, turn);
        } else {
            grow::state(&mut model, &mut source, turn);
        }
        if source.chance(15) {
            model.scale = Some(Tree::Product(vec![Tree::number("2"), Tree::Step]));
        }
        // Drops summands without a variation, which would test only that the engine finds nothing.
        let varied = (0..model.summands.len()).map(|k| model.varies(k));
        let mut varied = varied.collect::<Vec<bool>>().into_iter();
        model.summands.retain(|_| varied.next() == Some(true));
        model.write_otherwise(&mut Source::seeded(seed ^ 0x57_1e));
        model
    }

    /// Chooses the style of the text.
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

    /// Whether a summand on its own has a nonzero variation at one of three random points.
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
            // Values are of order one, far above the rounding error of an identity. NaN counts as a variation.
            found.iter().any(|x| x.is_nan() || x.abs() > 1e-9)
        })
    }

    /// Adds a symbol and returns its index.
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

    /// A symbol as an expression.
    #[must_use]
    pub fn letter(&self, index: usize) -> Tree {
        let shape = self.letters.get(index).map_or((1, 1), |l| l.kind.shape());
        Tree::Letter(index, shape)
    }

    /// Whether a summand contains neither a velocity nor a value at the end of the edge.
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

    /// Whether a summand depends only on the end of the edge. It is then a potential at that node, and node momenta contain half of
    /// it.
    #[must_use]
    pub fn is_of_the_end(&self, summand: &Tree) -> bool {
        let moves = |role: &Role| !matches!(role, Role::Parameter);
        let here = summand.mentions(&|t| match t {
            Tree::Letter(index, _) => self.letters.get(*index).is_some_and(|l| moves(&l.role)),
            _ => false,
        });
        !here && summand.mentions(&|t| matches!(t, Tree::Next(..)))
    }

    /// Whether the model mentions the symbol; configurations always count.
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
