//! Where an equation stands in the thesis of M. F. Dixon, Geometric integrators for continuum
//! dynamics (2007), and what is wrong with it there. Takes a derivation, gives citations; decided by
//! the structure of the model alone: its groups, sides, actions on advected quantities, Lagrangian.
//! A model of another structure cites nothing.

use crate::algebra::Algebra;
use crate::check::spec::Configuration;
use crate::derive::Derivation;
use crate::expr::shape::Structure;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};
use crate::syntax::ast::NodeRule;

/// The systems that the thesis derives.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum System {
    /// Section 2.5.4: `-tr(J Ω)/h`, left-invariant.
    FreeBody,
    /// Section 2.5.5: `-tr(ω J)/h` with `J' = ω J ω^T`.
    SpatialBody,
    /// Section 2.7: the free body and a potential linear in `Γ' = Ω^T Γ`.
    HeavyTop,
    /// Section 2.8: two bodies with `R' = Ω1^T R Ω2`, coupled bilinearly.
    CoupledBodies,
    /// Section 3.1.2, convective.
    ConvectiveEllipsoid,
    /// Section 3.1.2, spatial.
    SpatialEllipsoid,
}

/// How the group carries a quantity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Carried {
    /// `Ω^T a`, a vector in the body.
    BodyVector,
    /// `ω a ω^T`, a tensor in space.
    SpatialTensor,
    /// `Ω1^T a Ω2`, a relative orientation.
    Relative,
    /// `G^T a G`, a metric on the body.
    BodyMetric,
    /// `γ a γ^T`, a shape in space.
    SpatialShape,
    /// Any other action.
    Other,
}

/// The citations of one model.
pub struct Thesis<'a> {
    d: &'a Derivation,
    /// The system, if the thesis derives it.
    pub system: Option<System>,
    carried: Vec<Carried>,
}

impl<'a> Thesis<'a> {
    /// Recognises the model.
    pub fn new(d: &'a Derivation) -> Thesis<'a> {
        let algebra = Algebra::new(&d.letters.symbols);
        let carried: Vec<Carried> = (0..d.spec.advected.len())
            .map(|j| carried(d, &algebra, j))
            .collect();
        Thesis {
            system: system(d, &algebra, &carried),
            carried,
            d,
        }
    }

    fn configuration(&self, i: usize) -> Option<&Configuration> {
        self.d.spec.configurations.get(i)
    }

    /// Whether the action holds group elements themselves: then the thesis has no such relation.
    fn holds_elements(&self) -> bool {
        expr::contains_role(&self.d.letters.symbols, &self.d.action.total, Role::Element)
    }

    /// Section of the system, and by what its Lagrangian differs from the action of a step.
    pub fn section(&self) -> Option<(&'static str, &'static str)> {
        Some(match self.system? {
            System::FreeBody => ("2.5.4", "-h"),
            System::SpatialBody => ("2.5.5", "-h"),
            System::HeavyTop => ("2.7.1", "-h"),
            System::CoupledBodies => ("2.8.2", "-h"),
            System::ConvectiveEllipsoid | System::SpatialEllipsoid => ("3.1.2", "h"),
        })
    }

    /// Of the reconstruction of one configuration.
    pub fn reconstruction(&self, i: usize) -> Option<String> {
        // The thesis writes neither quaternions nor rigid motions so.
        let c = self
            .configuration(i)
            .filter(|c| c.group.coordinates().is_none() && !c.group.is_additive())?;
        cite(match c.group.is_orthogonal() {
            true => c.side.of("(2.62)", "(2.106)"),
            false => "(3.16)",
        })
    }

    /// Of the constraint of one advected quantity.
    pub fn transport(&self, j: usize) -> Option<String> {
        cite(match self.carried.get(j)? {
            Carried::BodyVector if self.system == Some(System::HeavyTop) => {
                "(2.141); (2.155) prints $Ω$ for $Ωᵀ$"
            }
            Carried::BodyVector => "(2.141)",
            Carried::SpatialTensor => "(2.120)",
            Carried::Relative => "(2.167)",
            Carried::BodyMetric => "(3.23)",
            Carried::SpatialShape => "(3.24)",
            Carried::Other => return None,
        })
    }

    /// Of the action of a step.
    pub fn action(&self) -> Option<String> {
        let potential = match self.d.spec.node_rule {
            NodeRule::Outgoing => "",
            NodeRule::Symmetric | NodeRule::Incoming => ", which takes the potential at node $k$",
        };
        match self.system? {
            System::FreeBody => cite("(2.29) times $-1/h$"),
            System::SpatialBody => cite("(2.37) times $-1/h$"),
            System::HeavyTop => cite(&format!("(2.142) times $-1/h${potential}")),
            System::CoupledBodies => cite(
                "(2.166) times $-1/h$, corrected: there the matrix $A$ of the vector form stands under the trace",
            ),
            System::ConvectiveEllipsoid if self.d.action.nodal.is_zero() => {
                cite("(3.18) times $1/h$")
            }
            System::ConvectiveEllipsoid => cite("(3.18) times $1/h$, with a potential"),
            System::SpatialEllipsoid if self.d.action.nodal.is_zero() => cite("(3.20) times $1/h$"),
            System::SpatialEllipsoid => cite("(3.20) times $1/h$, with a potential"),
        }
    }

    /// Of the Clebsch action.
    pub fn clebsch_action(&self) -> Option<String> {
        cite(match self.system? {
            System::FreeBody => "(2.75)",
            System::SpatialBody => "(2.101), where the second multiplier carries a factor $1/2$",
            System::HeavyTop => "(2.143)",
            System::CoupledBodies => "(2.168)",
            System::ConvectiveEllipsoid => "(3.25)",
            System::SpatialEllipsoid => "(3.26)",
        })
    }

    /// Of the relation that belongs to a variable.
    pub fn relation(&self, variable: Letter) -> Option<String> {
        let spec = &self.d.spec;
        let (is_element, is_velocity) = (
            |c: &Configuration| c.element == variable.symbol,
            |c: &Configuration| c.velocity == variable.symbol,
        );
        if let Some(c) = spec.configurations.iter().find(|c| is_element(c)) {
            let other = c.group.coordinates().is_some() || c.group.is_additive();
            if self.holds_elements() || other {
                return None;
            }
            return cite(match (self.system, c.group.is_orthogonal()) {
                (Some(System::HeavyTop), ..) => "(2.145) corrected: there $Ωᵀ P$ for $P Ωᵀ$",
                (Some(System::CoupledBodies), ..) => "(2.170)",
                (_, true) => c.side.of("(2.60)", "(2.104)"),
                (_, false) => c
                    .side
                    .of("(3.28)", "(3.36), whose solved form prints $Γ$ for $γ$"),
            });
        }
        if spec.configurations.iter().any(is_velocity) {
            return cite(match self.system? {
                System::FreeBody => "(2.77)",
                System::SpatialBody => "(2.107) corrected: there $Pᵀ Λᵀ$ for $P Λᵀ$",
                System::HeavyTop => "(2.148)",
                System::CoupledBodies => "(2.174)",
                System::ConvectiveEllipsoid => "(3.28)",
                System::SpatialEllipsoid => "(3.36)",
            });
        }
        let j = spec
            .advected
            .iter()
            .position(|a| a.quantity == variable.symbol)?;
        cite(match self.carried.get(j)? {
            Carried::BodyVector if self.system == Some(System::HeavyTop) => "(2.145)",
            Carried::BodyVector => "(2.147)",
            Carried::SpatialTensor => "(2.104), where the multiplier carries a factor $1/2$",
            Carried::Relative => {
                "(2.171) corrected: there the terms of the multiplier have the other sign"
            }
            Carried::BodyMetric => "(3.28)",
            Carried::SpatialShape => "(3.36)",
            Carried::Other => return None,
        })
    }

    /// Of the momentum of the edge.
    pub fn momentum(&self) -> Option<String> {
        cite(match self.system? {
            System::FreeBody => "(2.86) times $-1/h$",
            System::SpatialBody => "(2.109) times $-1/h$",
            System::HeavyTop => "(2.156) times $-1/h$, corrected: there $2/h² skew$ for $2 skew$",
            System::CoupledBodies => "(2.176) times $-1/h$",
            System::ConvectiveEllipsoid => "(3.31) has the gradient alone for $M$",
            System::SpatialEllipsoid => {
                "(3.39) has the gradient alone for $m$, and there the container's metric is missing"
            }
        })
    }

    /// Of the momentum map of the multipliers.
    pub fn lifted(&self) -> Option<String> {
        cite(match self.system? {
            System::FreeBody => "(2.79)",
            System::SpatialBody => "(2.111)",
            System::HeavyTop => "(2.153)",
            System::CoupledBodies => {
                "(2.180) corrected: there $skew$ for $2 skew$ in the terms of the multiplier of the relative orientation"
            }
            System::ConvectiveEllipsoid => "(3.32)",
            System::SpatialEllipsoid => "(3.40)",
        })
    }

    /// Of the momentum of the edge as the momentum map at its start.
    pub fn at_start(&self) -> Option<String> {
        match self.system? {
            System::FreeBody => cite("(2.79)"),
            System::HeavyTop => cite("(2.151)"),
            System::CoupledBodies => cite("(2.176), with the same correction"),
            System::ConvectiveEllipsoid => cite("(3.30)"),
            System::SpatialEllipsoid => {
                cite("(3.38) corrected: there the last bracket closes too late")
            }
            System::SpatialBody => None,
        }
    }

    /// Of the momentum of the edge as the momentum map at its end.
    pub fn at_end(&self) -> Option<String> {
        match self.system? {
            System::SpatialBody => cite("(2.108)"),
            _ => None,
        }
    }

    /// Of the discrete Euler-Poincaré equation.
    pub fn balance(&self) -> Option<String> {
        let split = match self.d.spec.node_rule {
            NodeRule::Outgoing => "",
            NodeRule::Symmetric | NodeRule::Incoming => {
                "; its gradient is that of the edge after the node alone"
            }
        };
        match self.system? {
            System::FreeBody => cite("(2.85)"),
            System::SpatialBody => cite("(2.120)"),
            System::HeavyTop => cite(&format!(
                "(2.155) corrected: there $Ad*$ of $Ωᵀ$ for $Ad*$ of $Ω${split}"
            )),
            System::CoupledBodies => {
                cite("(2.184); (2.182) and (2.183) print $skew$ for $2 skew$ in its last term")
            }
            System::ConvectiveEllipsoid => cite(
                "(3.27) is the same for free motion, with the gradient alone for $M$; with a potential it is not",
            ),
            System::SpatialEllipsoid => cite(
                "(3.35) is the same for free motion, with the gradient alone for $m$; with a potential it is not",
            ),
        }
    }

    /// Of the coupled Riccati equations.
    pub fn riccati(&self) -> Option<String> {
        match self.system? {
            System::CoupledBodies => cite("(2.187) has the coupling in the factor instead of $N$"),
            System::SpatialBody => {
                cite("A.3 solves it; there step 6 divides by the new tensor for the old one")
            }
            _ => None,
        }
    }

    /// Of the continuous equations of motion.
    pub fn continuous(&self) -> Option<String> {
        match self.system? {
            System::FreeBody => Some("thesis table A.2".to_owned()),
            System::SpatialBody => {
                Some("thesis table A.3, where both terms have the other sign".to_owned())
            }
            System::HeavyTop => Some("thesis table A.4".to_owned()),
            System::CoupledBodies => {
                Some("thesis table A.5, whose matrix $A$ belongs to the vector form".to_owned())
            }
            System::ConvectiveEllipsoid | System::SpatialEllipsoid => None,
        }
    }
}

fn cite(what: &str) -> Option<String> {
    Some(format!("thesis {what}"))
}

fn at(symbol: crate::expr::symbol::SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

fn carried(d: &Derivation, algebra: &Algebra, j: usize) -> Carried {
    let s = &d.letters.symbols;
    let Some(a) = d.spec.advected.get(j) else {
        return Carried::Other;
    };
    let own = expr::here(s, a.quantity);
    let (shape, structure) = (own.shape(), s.get(a.quantity).structure);
    let w = |c: &Configuration| expr::here(s, c.velocity);
    let t = |e: Expr| expr::transpose(s, e);
    let is = |e: Expr| e.shape() == shape && algebra.equal(&a.update, &e);
    match d.spec.configurations.as_slice() {
        [c] if c.group.is_orthogonal() => {
            if shape.rows != c.group.size() {
                return Carried::Other;
            }
            match c.side.is_body() {
                true if shape.is_vector() && is(expr::mul(t(w(c)), own.clone())) => {
                    Carried::BodyVector
                }
                false
                    if structure == Structure::Symmetric
                        && is(expr::product([w(c), own.clone(), t(w(c))])) =>
                {
                    Carried::SpatialTensor
                }
                _ => Carried::Other,
            }
        }
        [c] if structure == Structure::Symmetric && shape.rows == c.group.size() => {
            match c.side.is_body() {
                true if is(expr::product([t(w(c)), own.clone(), w(c)])) => Carried::BodyMetric,
                false if is(expr::product([w(c), own.clone(), t(w(c))])) => Carried::SpatialShape,
                _ => Carried::Other,
            }
        }
        [a, b]
            if [a, b].iter().all(|c| {
                c.group.is_orthogonal() && c.side.is_body() && c.group.size() == shape.rows
            }) && shape.is_square() =>
        {
            let between = |x: &Configuration, y: &Configuration| {
                is(expr::product([t(w(x)), own.clone(), w(y)]))
            };
            if between(a, b) || between(b, a) {
                Carried::Relative
            } else {
                Carried::Other
            }
        }
        _ => Carried::Other,
    }
}

fn system(d: &Derivation, algebra: &Algebra, carried: &[Carried]) -> Option<System> {
    let s = &d.letters.symbols;
    let step = expr::here(s, d.spec.step);
    let gradients: Vec<Expr> = d
        .spec
        .configurations
        .iter()
        .map(|c| {
            let g = expr::gradient(s, &d.action.edge, at(c.velocity));
            algebra.raise(&algebra.lower(&expr::mul(step.clone(), g)))
        })
        .collect();
    let constant = |e: &Expr| {
        expr::letters(e)
            .iter()
            .all(|l| s.get(l.symbol).role == Role::Parameter)
    };
    let symmetric = |e: &Expr| algebra.equal(e, &expr::transpose(s, e.clone()));
    let nodal = &d.action.nodal;
    let edge_free_of = |j: usize| {
        let letters = expr::letters(&d.action.edge);
        letters
            .iter()
            .all(|l| l.symbol != d.spec.advected[j].quantity)
    };
    let rigid = gradients.iter().all(|g| constant(g) && symmetric(g));
    match (
        d.spec.configurations.as_slice(),
        carried,
        gradients.as_slice(),
    ) {
        ([c], [], _) if c.group.is_orthogonal() && c.side.is_body() => {
            (rigid && nodal.is_zero()).then_some(System::FreeBody)
        }
        ([_], [Carried::BodyVector], _) => {
            let force = expr::gradient(s, nodal, at(d.spec.advected[0].quantity));
            let linear = expr::letters(&force)
                .iter()
                .all(|l| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step));
            (rigid && linear && !force.is_zero() && edge_free_of(0)).then_some(System::HeavyTop)
        }
        ([_], [Carried::SpatialTensor], [g]) => {
            let own = expr::neg(expr::here(s, d.spec.advected[0].quantity));
            (nodal.is_zero() && algebra.equal(g, &own)).then_some(System::SpatialBody)
        }
        ([a, b], [Carried::Relative], [g1, g2]) => {
            let bilinear = coupled(d, algebra, [a, b], [g1, g2]);
            (nodal.is_zero() && bilinear).then_some(System::CoupledBodies)
        }
        ([c], [Carried::BodyMetric], [g]) if c.side.is_body() => {
            quadratic(d, algebra, c, g).then_some(System::ConvectiveEllipsoid)
        }
        ([c], [Carried::SpatialShape], [g]) if c.side.is_spatial() => {
            quadratic(d, algebra, c, g).then_some(System::SpatialEllipsoid)
        }
        _ => None,
    }
}

/// `tr(J1 Ω1) + tr(J2 Ω2)` and a coupling that vanishes where either body stands still.
fn coupled(
    d: &Derivation,
    algebra: &Algebra,
    bodies: [&Configuration; 2],
    gradients: [&Expr; 2],
) -> bool {
    let s = &d.letters.symbols;
    let holds = |e: &Expr, c: &Configuration| expr::contains(e, at(c.velocity));
    let relative = expr::gradient(s, &d.action.edge, at(d.spec.advected[0].quantity));
    let still = |e: &Expr, c: &Configuration| {
        let id = expr::identity(c.group.size());
        algebra.is_zero(&expr::substitute(s, e, &[(at(c.velocity), id)]))
    };
    let own = bodies.iter().zip(gradients).all(|(c, g)| !holds(g, c));
    own && !relative.is_zero() && bodies.iter().all(|c| still(&relative, c))
}

/// `h ∇ℓ` is `C (G - Id) I0` on the body side, `C0 (γ - Id) I` on the spatial side, with a constant
/// matrix that is read off at twice the identity.
fn quadratic(d: &Derivation, algebra: &Algebra, c: &Configuration, g: &Expr) -> bool {
    let s = &d.letters.symbols;
    let w = expr::here(s, c.velocity);
    let id = expr::identity(c.group.size());
    let a = expr::here(s, d.spec.advected[0].quantity);
    let back = expr::inverse(s, a.clone());
    let two = expr::scale(crate::algebra::Rational::integer(2), id.clone());
    let there = expr::substitute(s, g, &[(at(c.velocity), two)]);
    let constant = c.side.product(back, there);
    let constant = algebra.raise(&algebra.lower(&constant));
    let parameters = expr::letters(&constant)
        .iter()
        .all(|l| s.get(l.symbol).role == Role::Parameter);
    let moved = expr::sub(w, id);
    let (first, last) = c.side.ordered(a, constant);
    let expected = expr::product([first, moved, last]);
    let nodal = !expr::contains_role(s, &d.action.nodal, Role::Element);
    parameters && nodal && !expected.is_zero() && algebra.equal(g, &expected)
}
