//! The typed specification of a model: what `check` hands to `derive`. Everything in it has passed names, shapes
//! and sides; positions in the source are kept only to report errors of a derivation.

use crate::diagnostic::Place;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::syntax::ast::{Comparison, NodeRule};

pub use crate::groups::Group;

/// The side of the velocity in the reconstruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// `next(Λ) = Λ Ω`: left-invariant systems, velocity and momentum in the body frame.
    Body,
    /// `next(Λ) = ω Λ`: right-invariant systems, velocity and momentum in the space frame.
    Spatial,
}

impl Side {
    /// Both sides, the body's first.
    pub const BOTH: [Side; 2] = [Side::Body, Side::Spatial];

    /// Whether velocities are in the body frame.
    pub fn is_body(self) -> bool {
        self == Side::Body
    }

    /// Whether velocities are in the space frame.
    pub fn is_spatial(self) -> bool {
        self == Side::Spatial
    }

    /// The other side.
    pub fn opposite(self) -> Side {
        self.of(Side::Spatial, Side::Body)
    }

    /// The element of a pair that belongs to this side.
    pub fn of<T>(self, body: T, space: T) -> T {
        match self {
            Side::Body => body,
            Side::Spatial => space,
        }
    }

    /// The frame of velocities and momenta, in one word.
    pub fn frame(self) -> &'static str {
        self.of("body", "space")
    }

    /// Two factors in the order of this side: `a b` for the body side, `b a` for the spatial side. An element and its
    /// velocity are multiplied in this order, `Λ Ω` or `ω Λ`.
    pub fn ordered<T>(self, a: T, b: T) -> (T, T) {
        match self {
            Side::Body => (a, b),
            Side::Spatial => (b, a),
        }
    }

    /// The product of two factors in the order of this side.
    pub fn product(self, a: Expr, b: Expr) -> Expr {
        let (first, second) = self.ordered(a, b);
        expr::mul(first, second)
    }
}

/// A configuration variable and its velocity.
#[derive(Clone, Debug)]
pub struct Configuration {
    /// The group element, at nodes.
    pub element: SymbolId,
    /// The velocity, on the edge k -> k+1.
    pub velocity: SymbolId,
    /// The group.
    pub group: Group,
    /// Body or spatial.
    pub side: Side,
    /// The right side of its constraint.
    pub update: Expr,
    /// The position of the constraint.
    pub place: Place,
    /// The position of its name in its declaration.
    pub name_place: Place,
    /// The position of its group.
    pub group_place: Place,
    /// The quantity that it is a copy of, in an expanded chain.
    pub copy: Option<CopyOf>,
}

/// A configuration of a chain at one of its sites.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CopyOf {
    /// The declared configuration, by the number of its first copy.
    pub family: usize,
    /// The site, counted from 0.
    pub site: usize,
}

/// A quantity advected by the group.
#[derive(Clone, Debug)]
pub struct Advected {
    /// The quantity, at nodes.
    pub quantity: SymbolId,
    /// Its definition in terms of the configuration, if declared.
    pub definition: Option<Expr>,
    /// The position of the definition.
    pub definition_place: Option<Place>,
    /// The right side of its constraint.
    pub update: Expr,
    /// The position of the constraint.
    pub place: Place,
    /// The position of its name in its declaration.
    pub name_place: Place,
    /// Whether the reduction found it instead of a declaration.
    pub found: bool,
}

/// A holonomic constraint, enforced at every node by a multiplier.
#[derive(Clone, Debug)]
pub struct Hold {
    /// Its multiplier, at nodes: a scalar or a vector.
    pub multiplier: SymbolId,
    /// The left side, a function of configurations and advected quantities at one node.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// The expression that vanishes: the left side minus the right side.
    pub value: Expr,
    /// The position of the equation.
    pub place: Place,
    /// The position of the name of the multiplier.
    pub name_place: Place,
}

/// The reduction of a model that was declared in terms of `Λ` and `next(Λ)`.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Terms on the edge, in velocities and advected quantities.
    pub edge: Expr,
    /// Terms at one node.
    pub nodal: Expr,
    /// How the invariance was decided: with definitions substituted for advected quantities, the reduced Lagrangian
    /// equals the declared one.
    pub known: crate::algebra::Decision,
    /// Whether groups were declared by `next`, so that parameters that become advected were searched.
    pub carries: bool,
}

/// A condition on the parameters, checked when their values are given.
#[derive(Clone, Debug)]
pub struct Assumption {
    /// Left side.
    pub left: Expr,
    /// Relation.
    pub relation: Comparison,
    /// Right side.
    pub right: Expr,
    /// Its position.
    pub place: Place,
}

/// A named range `dim n in from..=to`.
#[derive(Clone, Debug)]
pub struct Dimension {
    /// The name.
    pub name: String,
    /// Smallest value.
    pub from: u64,
    /// Largest value.
    pub to: u64,
}

/// A statement that does not declare a symbol and may be documented.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Subject {
    /// The dimension with this index.
    Dimension(usize),
    /// The statement of time index and step size.
    Time,
    /// The assumption with this index.
    Assumption(usize),
    /// The constraint of a quantity.
    Constraint(SymbolId),
    /// The constraint with this multiplier.
    Hold(SymbolId),
    /// The scale.
    Scale,
    /// The rule for nodal terms.
    Node,
    /// The Lagrangian.
    Lagrangian,
}

/// A checked model.
#[derive(Clone, Debug)]
pub struct Spec {
    /// Its name.
    pub name: String,
    /// The position of the name.
    pub name_place: Place,
    /// Documentation lines.
    pub docs: Vec<String>,
    /// Documentation lines of statements that do not declare a symbol; symbols store their own lines.
    pub remarks: Vec<(Subject, Vec<String>)>,
    /// Whether it is `pub`.
    pub public: bool,
    /// All symbols in order of declaration; the derivation appends its own.
    pub symbols: Symbols,
    /// Name of the time index.
    pub time_index: String,
    /// The step size.
    pub step: SymbolId,
    /// Named dimensions.
    pub dimensions: Vec<Dimension>,
    /// Parameters in order.
    pub parameters: Vec<SymbolId>,
    /// The positions of their names in their declarations.
    pub parameter_places: Vec<Place>,
    /// Conditions on the parameters.
    pub assumptions: Vec<Assumption>,
    /// User-defined functions with a formula, as declared; their calls are expanded.
    pub formulas: Vec<String>,
    /// The `let` definitions in order, with their names expanded.
    pub lets: Vec<(String, Expr)>,
    /// Names of unused definitions, with their positions.
    pub unused_lets: Vec<(String, Place)>,
    /// Configurations in order.
    pub configurations: Vec<Configuration>,
    /// Advected quantities in order.
    pub advected: Vec<Advected>,
    /// Constraints in order.
    pub holds: Vec<Hold>,
    /// The Lagrangian as typed.
    pub typed: Expr,
    /// The value of `scale`: typed = scale x physical.
    pub scale: Option<Expr>,
    /// The physical action of one step, before nodal terms are distributed.
    pub lagrangian: Expr,
    /// The position of the Lagrangian.
    pub lagrangian_place: Place,
    /// Its terms as they were typed, with their positions.
    pub terms: Vec<(Expr, Place)>,
    /// Whether it is one site of a chain, whose velocities may occur only in terms of neighbours.
    pub of_site: bool,
    /// The rule for nodal terms.
    pub node_rule: NodeRule,
    /// The reduction, for a model that was declared unreduced.
    pub reduction: Option<Reduction>,
}

impl Spec {
    /// Whether all configurations are fields, so that the model does not contain a nonabelian group.
    pub fn has_only_fields(&self) -> bool {
        self.configurations.iter().all(|c| c.group.is_additive())
    }

    /// Shape of a symbol.
    pub fn shape(&self, id: SymbolId) -> Shape {
        self.symbols.get(id).shape
    }

    /// Documentation lines of a statement.
    pub fn remark(&self, of: Subject) -> &[String] {
        let found = self.remarks.iter().find(|(subject, _)| *subject == of);
        found.map_or(&[], |(_, lines)| lines)
    }

    /// The advected quantities that depend on time: their update contains the step size or another such quantity, or
    /// they advance by themselves, whatever moves.
    pub fn clocks(&self) -> Vec<SymbolId> {
        let mut found: Vec<SymbolId> = Vec::new();
        loop {
            let knows = |a: &&Advected| {
                let letters = expr::letters(&a.update);
                let tells = |l: &Letter| l.symbol == self.step || found.contains(&l.symbol);
                let role = |l: &Letter| self.symbols.get(l.symbol).role;
                let moved = |l: &Letter| {
                    let moves = matches!(role(l), Role::Velocity | Role::Element | Role::Advected);
                    moves && l.symbol != a.quantity
                };
                let by_itself = || {
                    a.update != expr::here(&self.symbols, a.quantity) && !letters.iter().any(moved)
                };
                !found.contains(&a.quantity) && (letters.iter().any(tells) || by_itself())
            };
            match self.advected.iter().find(knows) {
                Some(next) => found.push(next.quantity),
                None => return found,
            }
        }
    }

    /// The quantities at the end of an edge, elements and advected quantities, as functions of its start and the
    /// velocities. In this form all dependence on the velocities is explicit.
    pub fn end_of_edge(&self) -> Vec<(Letter, Expr)> {
        let at_end = |symbol| Letter {
            symbol,
            shift: Shift::NEXT,
        };
        let elements = self.configurations.iter();
        let advected = self.advected.iter();
        elements
            .map(|c| (at_end(c.element), c.update.clone()))
            .chain(advected.map(|a| (at_end(a.quantity), a.update.clone())))
            .collect()
    }
}
