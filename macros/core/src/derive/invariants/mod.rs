//! Conserved quantities: candidates built from momenta, advected quantities, group elements and parameters, each
//! listed only if it is proved constant over one step. clebsch searches for Casimirs up to the corank of the bracket,
//! for Noether momenta of every group, frame and axis, and for Manakov integrals if the step has a Lax form. The
//! energy is exact if that is proved, otherwise bounded.

mod casimir_candidates;
mod casimirs;
mod columns;
mod difference;
mod draws;
mod energy;
mod homogeneous;
mod independence;
mod isospectral;
mod kernel;
mod mixed;
mod momentum_components;
mod motions;
mod noether;
mod noether_description;
pub(crate) mod random_step;
#[cfg(test)]
mod tests;
mod totals;

use super::Letters;
use super::action::Action;
use super::balance::Balance;
use super::bracket::Bracket;
use super::limit::Limit;
use super::select_solver::Solve;
use super::variation::Variation;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::Spec;
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr, Letter, Shift};
use crate::work;
use random_step::RandomStep;

pub use casimirs::Count;
pub use energy::DiscreteEnergy;
pub use isospectral::Lax;

/// Where an invariant comes from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Family {
    /// A momentum, from a symmetry of the action that moves configurations.
    Noether,
    /// A function that commutes with every other, so that it is constant for every Lagrangian.
    Casimir,
    /// Eigenvalues of a Lax matrix.
    Manakov,
    /// An energy.
    Energy,
    /// A constraint, or its rate of change.
    Held,
}

/// The kind of an invariant.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Kind {
    /// The spatial momentum of the only configuration, conserved by a symmetry and stored in the state.
    SpatialMomentum(usize),
    /// The sum of the spatial momenta of several configurations.
    TotalMomentum(Vec<usize>),
    /// A scalar, vector or matrix computed from quantities at a node.
    Value,
    /// The coefficients of `det(ν + M + λ C²)` in which the momentum occurs.
    Spectrum,
    /// The physical energy.
    Energy,
    /// The rate of change of a constraint, by its index.
    ConstraintRate(usize),
}

/// One conserved quantity at a node.
#[derive(Clone, Debug)]
pub struct Invariant {
    /// Its ASCII name.
    pub name: String,
    /// The kind.
    pub kind: Kind,
    /// Where it comes from.
    pub family: Family,
    /// Its value, expressed by node momenta, advected quantities, group elements and parameters. None for the energy,
    /// which is evaluated from the limit.
    pub value: Option<Expr>,
    /// The sum of the absolute values of its terms, or a bound of it: a number, or a vector of the shape of its value
    /// if components have different units. None for the energy, see `value`.
    pub scale: Option<Expr>,
    /// Whether it is conserved exactly or only oscillates.
    pub exact: bool,
    /// Why it is conserved, in a few words.
    pub reason: String,
}

/// The number of Casimirs, the Lax form, and the discrete energy.
#[derive(Clone, Debug)]
pub struct Integrability {
    /// The Casimirs: their number, or why the search was skipped.
    pub casimirs: CasimirSearch,
    /// The Lax form of the step, if one was found.
    pub lax: Option<Lax>,
    /// The discrete energy of an edge.
    pub discrete_energy: DiscreteEnergy,
}

/// The result of the search for the Casimirs of a model.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum CasimirSearch {
    /// The numbers of existing and of found Casimirs, at each size that was searched.
    Counted(Vec<Count>),
    /// No search, with the reason.
    NotSought(String),
}

impl Integrability {
    /// The dimension of the reduced space and the rank of its bracket at a general point, for a model of one size
    /// that was searched.
    pub fn rank(&self) -> Option<(usize, usize)> {
        match &self.casimirs {
            CasimirSearch::Counted(counts) => match counts.as_slice() {
                [one] if one.size.is_none() => Some((one.dimension, one.rank)),
                _ => None,
            },
            CasimirSearch::NotSought(_) => None,
        }
    }
}

/// The input of the search.
pub struct Inputs<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// All letters.
    pub letters: &'a Letters,
    /// The action of a step.
    pub action: &'a Action,
    /// How quantities vary.
    pub variations: &'a [Variation],
    /// The balances.
    pub balances: &'a [Balance],
    /// The action and the balances with constraint forces, if there are constraints; `action` and `balances` are
    /// without them.
    pub held: Option<(&'a Action, &'a [Balance])>,
    /// The bracket.
    pub bracket: &'a Bracket,
    /// The equations to solve.
    pub solve: &'a Solve,
    /// The continuous Lagrangian.
    pub limit: Option<&'a Limit>,
    /// The assumptions on the parameters, as expressions that vanish.
    pub assumed: &'a [Expr],
    /// The normal forms.
    pub algebra: &'a Algebra<'a>,
}

/// A quantity that may be conserved.
struct Candidate {
    name: String,
    value: Expr,
}

/// The invariants that can be proved.
pub fn invariants(x: &Inputs) -> (Vec<Invariant>, Integrability) {
    let roots = draws::Roots::of(x);
    let passages = random_step::random_steps(x, &roots, x.assumed);
    let mut out = Vec::new();
    let large = too_large(x);
    let small = large.is_none();
    out.extend(energy::energy(x, if small { &passages } else { &[] }));
    // Constraint forces change the momentum of a single body; they may conserve the sum over several bodies.
    let momenta = match x.held {
        None => noether::momenta(x, &roots, &passages),
        Some((action, balances)) => {
            let x = &Inputs {
                action,
                balances,
                held: None,
                ..*x
            };
            let roots = draws::Roots::of(x);
            noether::momenta(x, &roots, &random_step::random_steps(x, &roots, x.assumed))
        }
    };
    out.extend(momenta.of_sites);
    let elements = x.bracket.holds_elements;
    let casimirs = match small && !elements {
        true => casimirs::casimirs(x, x.assumed, &passages),
        false => casimirs::Casimirs::default(),
    };
    let (vectors, about_axes): (Vec<_>, Vec<_>) = momenta
        .space
        .into_iter()
        .partition(|v| !matches!(v.kind, Kind::Value));
    out.extend(vectors);
    out.extend(casimirs.list);
    let lax = isospectral::lax(x);
    let spectrum = isospectral::integrals(x, lax.as_ref(), &passages);
    let fresh = |v: &Invariant| casimirs::is_new(x, &passages, &out, v);
    let spectrum: Vec<Invariant> = spectrum.into_iter().filter(fresh).collect();
    out.extend(spectrum);
    // A momentum about an axis may be a Casimir already, expressed by advected quantities.
    let mut linear: Vec<Invariant> = out.clone();
    for v in about_axes.into_iter().chain(momenta.body) {
        if independence::is_new(x, &passages, &linear, &v) {
            linear.push(v.clone());
            out.push(v);
        }
    }
    // This is a property of the advected quantities, not of the motion.
    let mut counts = casimirs.counts;
    out.retain(|v| {
        let same = v.family == Family::Casimir && independence::is_same_for_all(x, &passages, v);
        if same {
            counts.iter_mut().for_each(|count| count.same += 1);
        }
        !same
    });
    distinguish(&mut out);
    let known = Integrability {
        casimirs: match large {
            _ if elements => CasimirSearch::NotSought(
                "the equations contain the configuration itself, not only reduced variables"
                    .to_owned(),
            ),
            Some(why) => CasimirSearch::NotSought(why),
            None if work::cut_short() => CasimirSearch::NotSought(format!(
                "the search needs more than {} products of numbers",
                work::products()
            )),
            None => CasimirSearch::Counted(counts),
        },
        discrete_energy: energy::discrete(x, &passages, lax.as_ref()),
        lax,
    };
    (out, known)
}

/// The largest number of scalar products for one bracket matrix. Matrices of up to eight dimensions need a tenth of
/// that.
const LARGEST: usize = 4_000_000;

/// The reason why the spaces of the model are too large to search, if they are. Without a search, nothing is listed.
fn too_large(x: &Inputs) -> Option<String> {
    let s = &x.letters.symbols;
    let number = |d: Dim| s.sizes(d).1;
    let sizes = x.spec.configurations.iter().map(|c| number(c.group.size()));
    let work: usize = sizes.map(|n| n.saturating_pow(7)).sum();
    let entries: usize = x
        .spec
        .advected
        .iter()
        .map(|a| {
            let shape = s.get(a.quantity).shape;
            number(shape.rows) * number(shape.cols)
        })
        .sum();
    // The cost of eliminating a matrix with this many rows.
    if work > 4 * LARGEST {
        return Some("the Lie algebra of the configuration has too many dimensions".to_owned());
    }
    (entries.saturating_pow(3) > 16 * LARGEST)
        .then(|| format!("the advected quantities have {entries} entries, too many for the search"))
}

/// Numbers invariants that share a name, so that their names differ.
fn distinguish(list: &mut [Invariant]) {
    for i in 0..list.len() {
        let base = list[i].name.clone();
        let mut n = 2;
        while list[..i].iter().any(|v| v.name == list[i].name) {
            list[i].name = format!("{base}_{n}");
            n += 1;
        }
    }
}

fn here(symbol: crate::expr::symbol::SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

/// Whether a value is the same before and after every step.
fn is_conserved(passages: &[RandomStep], value: &Expr) -> bool {
    !passages.is_empty() && passages.iter().all(|p| p.keeps(value))
}

/// The length of a vector, or of all entries of a matrix.
fn length(x: &Inputs, e: &Expr) -> Expr {
    let square = if e.shape().is_vector() {
        expr::dot(e.clone(), e.clone())
    } else if e.shape() == Shape::SCALAR {
        expr::power(e.clone(), Rational::integer(2))
    } else {
        let t = expr::transpose(&x.letters.symbols, e.clone());
        expr::trace(expr::mul(t, e.clone()))
    };
    expr::power(square, Rational::HALF)
}
