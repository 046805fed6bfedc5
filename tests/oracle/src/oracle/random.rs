//! Random Lagrangians on SO(3): the text of a whole model and, apart from it, its expression tree.
//! Takes a seed; gives a model that nobody has seen, with values for everything it names.
//! The text is written from the tree and never read back: the tree is the oracle's own meaning of it.

pub mod grow;
pub mod sample;
pub mod tree;
pub mod write;

use super::action::{NodeRule, Side, rotations, stationarity};
use super::points::Source;
use grow::Garden;
use sample::Sample;
use tree::{Carried, Expr, Kind, Named, Role, Symbol};

/// One summand of the Lagrangian as typed.
#[derive(Clone, Debug)]
pub struct Summand {
    /// Whether it is subtracted.
    pub subtracted: bool,
    /// The summand without that sign.
    pub expr: Expr,
}

/// A random model.
#[derive(Clone, Debug)]
pub struct RandomLagrangian {
    /// The name of the model, made from the seed.
    pub name: String,
    /// The name of the step.
    pub step: &'static str,
    /// The name of the time index.
    pub time: &'static str,
    /// The side of the variations.
    pub side: Side,
    /// The rule for summands without velocity.
    pub rule: NodeRule,
    /// What is typed is that many times the physical action.
    pub scale: Option<Expr>,
    /// All names; those that no expression uses are not declared.
    pub symbols: Vec<Symbol>,
    /// Named subexpressions.
    pub lets: Vec<Named>,
    /// The summands of the Lagrangian.
    pub summands: Vec<Summand>,
}

impl RandomLagrangian {
    /// The Lagrangian of a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        let mut source = Source::seeded(seed);
        let side = if source.chance(25) {
            Side::Space
        } else {
            Side::Body
        };
        let symbols = alphabet(&mut source, side);
        let lets = name_subexpressions(&mut source, &symbols);
        let summands = summands(&mut source, side, &symbols, &lets);
        let rule = match source.below(10) {
            0 => NodeRule::Incoming,
            1 => NodeRule::Outgoing,
            _ => NodeRule::Symmetric,
        };
        let scale = source.chance(20).then(|| scale(&mut source));
        let (time, step) = if source.chance(10) {
            ("i", "s")
        } else {
            ("k", "h")
        };
        Self {
            name: format!("Random{seed}"),
            step,
            time,
            side,
            rule,
            scale,
            symbols,
            lets,
            summands,
        }
    }

    /// Whether the summand has neither a velocity nor a quantity at the head: then the node rule holds.
    #[must_use]
    pub fn is_nodal(&self, summand: &Summand) -> bool {
        !summand.expr.mentions(&self.lets, &|expr| self.moves(expr))
    }

    fn moves(&self, expr: &Expr) -> bool {
        match expr {
            Expr::Next(_) => true,
            Expr::Symbol(index) => self
                .symbols
                .get(*index)
                .is_some_and(|symbol| matches!(symbol.role, Role::Velocity)),
            _ => false,
        }
    }

    /// Whether anything written mentions the symbol.
    #[must_use]
    pub fn uses(&self, index: usize) -> bool {
        let names = |expr: &Expr| {
            expr.mentions(&self.lets, &|part| match part {
                Expr::Symbol(other) | Expr::Next(other) => *other == index,
                _ => false,
            })
        };
        let written = self.summands.iter().any(|summand| names(&summand.expr))
            || self.scale.as_ref().is_some_and(names);
        written
            || self.symbols.iter().enumerate().any(|(other, symbol)| {
                // A definition is written only if the quantity that it defines is.
                other != index && symbol.role.definition().is_some_and(names) && self.uses(other)
            })
    }
}

/// Names of parameters, none of which the grammar reserves.
const NAMES: [&str; 24] = [
    "A", "B", "C", "F", "K", "L", "M", "P", "U", "X", "α", "β", "κ", "ρ", "σ", "mass", "lever",
    "p", "q", "u", "w", "J0", "K_a", "Δ",
];

fn fresh(source: &mut Source, taken: &mut Vec<String>, pool: &[&str]) -> String {
    for _ in 0..200 {
        if let Some(name) = source.choose(pool)
            && !taken.iter().any(|other| other == name)
        {
            taken.push((*name).to_owned());
            return (*name).to_owned();
        }
    }
    let name = format!("v{}", taken.len());
    taken.push(name.clone());
    name
}

/// The letters of a random model: group, velocity, parameters, advected quantities.
fn alphabet(source: &mut Source, side: Side) -> Vec<Symbol> {
    let mut taken = Vec::new();
    let mut symbols = Vec::new();
    let (group, velocity) = match (side, source.chance(30)) {
        (Side::Body, false) => ("Λ", "Ω"),
        (Side::Body, true) => ("Lambda", "Omega"),
        (Side::Space, false) => ("Λ", "ω"),
        (Side::Space, true) => ("Q", "omega"),
    };
    symbols.push(Symbol::new(group, Kind::Rotation, Role::Group));
    symbols.push(Symbol::new(velocity, Kind::Rotation, Role::Velocity));
    symbols.push(Symbol::new("J", Kind::Positive, Role::Parameter));
    let counts = [
        (Kind::Real, 1 + source.below(2)),
        (Kind::Vector, 1 + source.below(3)),
        (Kind::Symmetric, 1 + source.below(2)),
        (Kind::Skew, source.below(2)),
        (Kind::Matrix, source.below(2)),
    ];
    for (kind, count) in counts {
        for _ in 0..count {
            let name = fresh(source, &mut taken, &NAMES);
            symbols.push(Symbol::new(&name, kind, Role::Parameter));
        }
    }
    let vectors = source.below(4);
    let symmetric = if vectors == 0 {
        1 + source.below(2)
    } else {
        source.below(3)
    };
    let kinds = [
        (Kind::Vector, Carried::Vector, vectors),
        (Kind::Symmetric, Carried::Congruence, symmetric),
        (
            Kind::Skew,
            Carried::Congruence,
            usize::from(source.chance(8)),
        ),
        (
            Kind::Matrix,
            Carried::OneSided,
            usize::from(source.chance(8)),
        ),
    ];
    let pool = ["Γ", "χ", "a", "b", "c", "S", "Y", "ξ", "eta", "N"];
    for (kind, carried, count) in kinds {
        for _ in 0..count {
            let definition = source
                .chance(50)
                .then(|| definition(source, side, carried, kind, &symbols))
                .flatten();
            let name = fresh(source, &mut taken, &pool);
            let role = Role::Advected {
                carried,
                definition,
            };
            symbols.push(Symbol::new(&name, kind, role));
        }
    }
    symbols
}

/// A definition such as `Λᵀ z` or `Λᵀ K Λ` by parameters of the fitting kind.
fn definition(
    source: &mut Source,
    side: Side,
    carried: Carried,
    kind: Kind,
    symbols: &[Symbol],
) -> Option<Expr> {
    let fitting: Vec<usize> = (0..symbols.len())
        .filter(|&index| {
            symbols
                .get(index)
                .is_some_and(|symbol| symbol.kind == kind && matches!(symbol.role, Role::Parameter))
        })
        .collect();
    let constant = Expr::Symbol(*source.choose(&fitting)?);
    let constant = match (carried, source.chance(25), source.choose(&fitting)) {
        (Carried::Vector, true, Some(&other)) => constant.plus(Expr::Symbol(other)),
        _ => constant,
    };
    let group = Expr::Symbol(0);
    let (left, right) = match side {
        Side::Body => (group.clone().transposed(), group),
        Side::Space => (group.clone(), group.transposed()),
    };
    let juxtaposed = source.chance(20);
    let product = Expr::product(left, constant, juxtaposed);
    Some(match carried {
        Carried::Vector | Carried::OneSided => product,
        Carried::Congruence => Expr::product(product, right, juxtaposed),
    })
}

fn name_subexpressions(source: &mut Source, symbols: &[Symbol]) -> Vec<Named> {
    if !source.chance(45) {
        return Vec::new();
    }
    let velocity = source.chance(50);
    let kind = *source
        .choose(&[Kind::Real, Kind::Vector, Kind::Matrix])
        .unwrap_or(&Kind::Real);
    let mut garden = Garden::new(source, symbols, &[], velocity);
    let expr = match kind {
        Kind::Real => garden.scalar(2),
        Kind::Vector => garden.vector(2),
        _ => garden.matrix(2),
    };
    vec![Named {
        name: "part".to_owned(),
        kind,
        expr,
    }]
}

/// Attempts to grow a summand that has a variation.
const ATTEMPTS: usize = 20;

/// The summands: a kinetic one or not, some with velocity, some without.
///
/// A summand whose variation vanishes identically, such as `tr(hat(a))`, tests only that the engine finds
/// nothing: now and then one stays.
fn summands(source: &mut Source, side: Side, symbols: &[Symbol], lets: &[Named]) -> Vec<Summand> {
    let velocity = Expr::Symbol(1);
    let moment = Expr::Symbol(2);
    let juxtaposed = source.chance(20);
    let product = if source.chance(50) {
        Expr::product(moment, velocity, juxtaposed)
    } else {
        Expr::product(velocity, moment, juxtaposed)
    };
    let kinetic = Summand {
        subtracted: true,
        expr: Expr::call("tr", vec![product]).over(Expr::Step),
    };
    let first = if source.chance(60) {
        kinetic
    } else {
        let grown = (0..ATTEMPTS).find_map(|_| {
            let mut garden = Garden::new(source, symbols, lets, true);
            let expr = garden.moving_with_velocity();
            let summand = weighted(source, symbols, expr);
            varies(source, side, symbols, lets, &summand).then_some(summand)
        });
        grown.unwrap_or(kinetic)
    };
    let mut summands = vec![first];
    let more = 1 + source.below(4);
    for _ in 0..more {
        let moving = source.chance(50);
        let idle = source.chance(4);
        let grown = (0..ATTEMPTS).find_map(|_| {
            let mut garden = Garden::new(source, symbols, lets, moving);
            let expr = if moving {
                garden.moving()
            } else {
                garden.resting()
            }?;
            let summand = weighted(source, symbols, expr);
            (idle || varies(source, side, symbols, lets, &summand)).then_some(summand)
        });
        summands.extend(grown);
    }
    summands
}

/// Whether a summand alone has a variation at some of a few random points.
fn varies(
    source: &mut Source,
    side: Side,
    symbols: &[Symbol],
    lets: &[Named],
    summand: &Summand,
) -> bool {
    let alone = RandomLagrangian {
        name: String::new(),
        step: "h",
        time: "k",
        side,
        rule: NodeRule::Symmetric,
        scale: None,
        symbols: symbols.to_vec(),
        lets: lets.to_vec(),
        summands: vec![summand.clone()],
    };
    (0..3).any(|_| {
        let sample = Sample::draw(&alone, source);
        let nodes = std::array::from_fn(|_| [source.orthogonal()]);
        let total = stationarity(&sample, &nodes, &rotations());
        // Values are of order one: what is left of an identity by rounding is far below.
        total
            .derivative
            .iter()
            .any(|component| component.abs() > 1e-9)
    })
}

/// A summand with a random coefficient: powers of the step, numbers, real parameters.
fn weighted(source: &mut Source, symbols: &[Symbol], expr: Expr) -> Summand {
    let reals: Vec<usize> = (0..symbols.len())
        .filter(|&index| {
            symbols
                .get(index)
                .is_some_and(|symbol| symbol.kind == Kind::Real)
        })
        .collect();
    let juxtaposed = source.chance(15);
    let expr = match source.below(9) {
        0 => Expr::product(Expr::Step, expr, false),
        1 => expr.over(Expr::Step),
        2 => Expr::product(
            Expr::Step.over(Expr::number("2", 2.0)).grouped(),
            expr,
            juxtaposed,
        ),
        3 => expr.over(Expr::product(
            Expr::number("2", 2.0),
            Expr::Step,
            juxtaposed,
        )),
        4 => Expr::product(Expr::Step.to_power(2), expr, false),
        5 => Expr::product(Expr::number("0.75", 0.75), expr, juxtaposed),
        6 => match source.choose(&reals) {
            Some(&real) => Expr::product(
                Expr::product(Expr::Step, Expr::Symbol(real), juxtaposed),
                expr,
                false,
            ),
            None => expr,
        },
        7 => Expr::product(
            Expr::number("1", 1.0).over(Expr::number("3", 3.0)),
            expr.negated(),
            false,
        ),
        _ => expr,
    };
    Summand {
        subtracted: source.chance(50),
        expr,
    }
}

fn scale(source: &mut Source) -> Expr {
    match source.below(4) {
        0 => Expr::product(Expr::number("2", 2.0), Expr::Step, false),
        1 => Expr::Step.to_power(2).negated(),
        _ => Expr::Step.negated(),
    }
}
