//! The Lie-Poisson bracket of the reduced space, from the action in the constraints. The bracket of momenta is the
//! commutator, and `{a, ⟨μ, ξ⟩}` is the change of `a` if the configuration moves along `ξ`. Takes the variations;
//! gives rows to print and the matrix of the bracket at any point.

use super::Letters;
use super::action::Action;
use super::variation::{Variation, at};
use crate::check::spec::Spec;
use crate::derive::Derivation;
use crate::expr::shape::{Dim, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::interpret::{Assignment, EvalError, Matrix, evaluate};

/// `{first, second} = value`, with free elements `ξ`, `η` of the Lie algebra.
#[derive(Clone, Debug)]
pub struct Row {
    /// A quantity.
    pub first: Expr,
    /// A momentum along a free element.
    pub second: Expr,
    /// Their bracket.
    pub value: Expr,
}

/// The change of one quantity at a node along one configuration.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The configuration.
    pub configuration: usize,
    /// The change of the quantity, linear in the `ξ` of that configuration.
    pub change: Expr,
    /// The change in the frame to which [`Coordinates`] refer.
    local: Expr,
}

/// A quantity of the bracket that is not a momentum, and its changes.
#[derive(Clone, Debug)]
pub struct AdvectedMotions {
    /// The quantity.
    pub quantity: SymbolId,
    /// Its changes, without configurations that do not change it.
    pub motions: Vec<Motion>,
}

/// The bracket, in the sign convention in which a body momentum of SO(3) has `{μ_i, μ_j} = -ε_ijk μ_k` and a spatial
/// one `{m_i, m_j} = ε_ijk m_k`; `{a, μ_j} = E_j·a` is the change of `a` along `E_j`.
#[derive(Clone, Debug)]
pub struct Bracket {
    /// For each configuration: `⟨μ, [ξ, η]⟩` with its sign.
    pub momenta: Vec<Expr>,
    /// Advected quantities.
    pub advected: Vec<AdvectedMotions>,
    /// Group elements, with which it is the bracket of the phase space.
    pub elements: Vec<AdvectedMotions>,
    /// The printed rows: momenta, then configurations that occur in the action, then advected quantities.
    pub rows: Vec<Row>,
    /// Whether the action depends on configurations themselves, so that this is the bracket of their phase space.
    pub holds_elements: bool,
}

/// The space of a bracket matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Space {
    /// Momenta and advected quantities.
    Reduced,
    /// Momenta, group elements, and the advected quantities without a definition in group elements.
    Phase,
}

/// The independent coordinates of one quantity, as entries (row, column). Vectors, scalars and general matrices: all
/// entries, row by row. Symmetric: on and above the diagonal. Skew: see [`skew_entries`]. Elements of SO(n): the skew
/// matrix `X^T dX`; quaternions and rigid motions: the element `X^-1 dX` of the Lie algebra.
pub type Coordinates = Vec<(usize, usize)>;

pub use crate::groups::Element;

/// The derived bracket.
pub fn bracket(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    variations: &[Variation],
) -> Bracket {
    let s = &letters.symbols;
    let mut rows = Vec::new();
    let mut momenta = Vec::new();
    for (i, c) in spec.configurations.iter().enumerate() {
        let mu = expr::here(s, letters.node_momentum[i]);
        let (xi, eta) = (
            expr::here(s, letters.variation[i]),
            expr::here(s, letters.direction[i]),
        );
        let along = |e: Expr| c.group.pairing(s, mu.clone(), e);
        let value = c.group.bracket(s, mu.clone(), xi.clone(), eta.clone());
        let value = if c.side.is_body() {
            expr::neg(value)
        } else {
            value
        };
        rows.push(Row {
            first: along(xi),
            second: along(eta),
            value: value.clone(),
        });
        momenta.push(value);
    }
    let moved = |quantity: SymbolId, of: &dyn Fn(&Variation) -> Option<Expr>| {
        let all = variations.iter().enumerate().filter_map(|(i, v)| {
            let change = of(v).filter(|e| !e.is_zero())?;
            let local = match s.get(quantity).structure {
                Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion => {
                    let own = expr::here(s, quantity);
                    expr::mul(expr::inverse(s, own), change.clone())
                }
                Structure::General
                | Structure::Symmetric
                | Structure::Skew
                | Structure::Diagonal
                | Structure::Invertible => change.clone(),
            };
            Some(Motion {
                configuration: i,
                change,
                local,
            })
        });
        AdvectedMotions {
            quantity,
            motions: all.collect(),
        }
    };
    let advected: Vec<AdvectedMotions> = spec
        .advected
        .iter()
        .map(|a| {
            let own = at(a.quantity, Shift::HERE);
            moved(a.quantity, &|v| {
                let found = v.advected.iter().find(|(l, _)| *l == own);
                found.map(|(_, e)| e.clone())
            })
        })
        .collect();
    let elements = spec
        .configurations
        .iter()
        .map(|c| {
            let own = at(c.element, Shift::HERE);
            moved(c.element, &|v| {
                (v.element.0 == own).then(|| v.element.1.clone())
            })
        })
        .collect();
    let stands = |m: &AdvectedMotions| {
        let at_ends = [Shift::HERE, Shift::NEXT].map(|shift| at(m.quantity, shift));
        at_ends.iter().any(|l| expr::contains(&action.total, *l))
    };
    let elements: Vec<AdvectedMotions> = elements;
    let holds_elements = elements.iter().any(stands);
    let shown = elements.iter().filter(|m| stands(m)).chain(&advected);
    for m in shown {
        for motion in &m.motions {
            let c = &spec.configurations[motion.configuration];
            let mu = expr::here(s, letters.node_momentum[motion.configuration]);
            let xi = expr::here(s, letters.variation[motion.configuration]);
            rows.push(Row {
                first: expr::here(s, m.quantity),
                second: c.group.pairing(s, mu, xi),
                value: motion.change.clone(),
            });
        }
    }
    Bracket {
        momenta,
        advected,
        elements,
        rows,
        holds_elements,
    }
}

/// The entries that determine a skew matrix. In three dimensions these are the entries of the axial vector in order,
/// (2,1), (0,2), (1,0); otherwise (j, i) for `i < j`, row by row.
pub fn skew_entries(n: usize) -> Coordinates {
    if n == 3 {
        return vec![(2, 1), (0, 2), (1, 0)];
    }
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (j, i)));
    pairs.collect()
}

/// The coordinates of a quantity of `rows x cols`.
pub fn coordinates(structure: Structure, rows: usize, cols: usize) -> Coordinates {
    let entries = (0..rows).flat_map(|i| (0..cols).map(move |j| (i, j)));
    match structure {
        Structure::General | Structure::Invertible => entries.collect(),
        Structure::Symmetric => entries.filter(|(i, j)| i <= j).collect(),
        Structure::Diagonal => entries.filter(|(i, j)| i == j).collect(),
        Structure::Skew | Structure::Orthogonal => skew_entries(rows),
        // X^-1 dX is the left multiplication by a vector, which is part of its first column.
        Structure::UnitQuaternion => vec![(1, 0), (2, 0), (3, 0)],
        Structure::RigidMotion => {
            let last = rows.saturating_sub(1);
            let column = (0..last).map(|i| (i, last)).collect();
            [skew_entries(last), column].concat()
        }
    }
}

/// The numbers in which a bracket matrix is computed.
pub(crate) trait Numbers {
    /// A number.
    type Number: Copy;
    /// Zero.
    fn zero(&self) -> Self::Number;
    /// The negative.
    fn opposite(&self, x: Self::Number) -> Self::Number;
    /// The value of a dimension.
    fn dim(&self, d: Dim) -> usize;
    /// `tr(g^T e)`, for a gradient stored by rows with `cols` columns.
    fn paired(&self, gradient: &[Self::Number], cols: usize, e: &Element) -> Self::Number;
    /// The entries of an expression, row by row, with basis elements in place of some letters.
    fn entries(&mut self, e: &Expr, with: &[(Letter, &Element)]) -> Option<Vec<Self::Number>>;
}

impl Bracket {
    fn moved(&self, spec: &Spec, space: Space) -> Vec<&AdvectedMotions> {
        match space {
            Space::Reduced => self.advected.iter().collect(),
            Space::Phase => {
                let free = self.advected.iter().zip(&spec.advected);
                let free = free.filter(|(_, a)| a.definition.is_none()).map(|(m, _)| m);
                self.elements.iter().chain(free).collect()
            }
        }
    }

    /// The matrix of the bracket, row by row: momenta in the order of their configurations, then the other quantities
    /// of the space.
    pub(crate) fn assemble<N: Numbers>(
        &self,
        spec: &Spec,
        letters: &Letters,
        space: Space,
        numbers: &mut N,
    ) -> Option<Vec<Vec<N::Number>>> {
        let s = &letters.symbols;
        let bases: Vec<_> = spec
            .configurations
            .iter()
            .map(|c| c.group.basis(&|n| numbers.dim(n)))
            .collect();
        let starts: Vec<usize> = bases
            .iter()
            .scan(0, |sum, b| {
                let start = *sum;
                *sum += b.len();
                Some(start)
            })
            .collect();
        let momenta: usize = bases.iter().map(Vec::len).sum();
        let moved = self.moved(spec, space);
        let places: Vec<Coordinates> = moved
            .iter()
            .map(|m| {
                let x = s.get(m.quantity);
                let (r, c) = (numbers.dim(x.shape.rows), numbers.dim(x.shape.cols));
                coordinates(x.structure, r, c)
            })
            .collect();
        let total = momenta + places.iter().map(Vec::len).sum::<usize>();
        let mut out = vec![vec![numbers.zero(); total]; total];
        for (k, own) in bases.iter().enumerate() {
            let (xi, eta) = (
                at(letters.variation[k], Shift::HERE),
                at(letters.direction[k], Shift::HERE),
            );
            // Linear in the second direction, so its gradient has the values along the whole basis.
            let along = expr::gradient(s, &self.momenta[k], eta);
            let cols = numbers.dim(along.shape().cols);
            for (i, e) in own.iter().enumerate() {
                let gradient = numbers.entries(&along, &[(xi, e)])?;
                for (j, f) in own.iter().enumerate().skip(i + 1) {
                    let value = numbers.paired(&gradient, cols, f);
                    out[starts[k] + i][starts[k] + j] = value;
                    out[starts[k] + j][starts[k] + i] = numbers.opposite(value);
                }
            }
        }
        let mut row = momenta;
        for (m, entries) in moved.iter().zip(&places) {
            let cols = numbers.dim(s.get(m.quantity).shape.cols);
            for motion in &m.motions {
                let k = motion.configuration;
                let xi = at(letters.variation[k], Shift::HERE);
                for (j, e) in bases[k].iter().enumerate() {
                    let change = numbers.entries(&motion.local, &[(xi, e)])?;
                    for (r, (a, b)) in entries.iter().enumerate() {
                        let value = *change.get(a * cols + b)?;
                        out[row + r][starts[k] + j] = value;
                        out[starts[k] + j][row + r] = numbers.opposite(value);
                    }
                }
            }
            row += entries.len();
        }
        Some(out)
    }
}

/// Numbers at a point given by an assignment.
struct Plain<'a> {
    symbols: &'a Symbols,
    values: Assignment,
    failure: Option<EvalError>,
}

impl Numbers for Plain<'_> {
    type Number = f64;

    fn zero(&self) -> f64 {
        0.0
    }

    fn opposite(&self, x: f64) -> f64 {
        -x
    }

    fn dim(&self, d: Dim) -> usize {
        match d {
            Dim::Fixed(n) => n as usize,
            Dim::Named(_) => 0,
        }
    }

    fn paired(&self, gradient: &[f64], cols: usize, e: &Element) -> f64 {
        let own = |(i, j, x): &(usize, usize, i64)| *x as f64 * gradient[i * cols + j];
        e.iter().map(own).sum()
    }

    fn entries(&mut self, e: &Expr, with: &[(Letter, &Element)]) -> Option<Vec<f64>> {
        for (l, entries) in with {
            let symbol = self.symbols.get(l.symbol);
            let (rows, cols) = (self.dim(symbol.shape.rows), self.dim(symbol.shape.cols));
            let mut m = Matrix::zeros(rows, cols);
            for (i, j, x) in entries.iter() {
                if let Some(slot) = m.data.get_mut(i * cols + j) {
                    *slot = *x as f64;
                }
            }
            self.values
                .set(&symbol.name, l.shift.time, rows, cols, &m.data);
        }
        match evaluate(self.symbols, e, &self.values) {
            Ok(m) => Some(m.data),
            Err(error) => {
                self.failure = Some(error);
                None
            }
        }
    }
}

impl Derivation {
    /// The matrix of the bracket at a point: momenta first (by configuration, in the basis of
    /// [`crate::groups::Record::basis`]), then the quantities of the space in order of declaration, in
    /// [`Coordinates`]. `values` must contain the momenta (under their names in [`Letters::node_momentum`]) and the
    /// quantities, at level 0.
    ///
    /// # Errors
    /// If a value is missing or a dimension is named.
    pub fn bracket_matrix(&self, space: Space, values: &Assignment) -> Result<Matrix, EvalError> {
        if !self.spec.dimensions.is_empty() {
            return Err(EvalError::NamedDimension);
        }
        let mut numbers = Plain {
            symbols: &self.letters.symbols,
            values: values.clone(),
            failure: None,
        };
        let rows = self
            .bracket
            .assemble(&self.spec, &self.letters, space, &mut numbers);
        match (rows, numbers.failure) {
            (Some(rows), _) => Ok(Matrix {
                rows: rows.len(),
                cols: rows.len(),
                data: rows.concat(),
            }),
            (None, Some(error)) => Err(error),
            (None, None) => Err(EvalError::Shape("the bracket".to_owned())),
        }
    }
}
