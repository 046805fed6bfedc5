//! The components of a momentum: the whole of it, its part about an axis, across an axis or in a plane, or the part
//! that preserves a quadratic form. Takes the parameters, which distinguish axes and forms; gives linear maps of
//! momenta with their names.

use super::homogeneous;
use super::motions::{self, Sort};
use super::{Inputs, length};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Part};

/// The number of rows of a scalar.
const ONE: Dim = Dim::Fixed(1);

/// The largest number of parameters that are tried as axes or forms.
const AXES: usize = 12;

/// The largest number of parameters for which pairs give an axis across both.
const PAIRED: usize = 4;

/// A linear map of momenta of one sort.
pub(super) struct MomentumComponent {
    pub(super) sort: Sort,
    /// Its part of the name of a momentum; empty for the whole momentum.
    pub(super) name: String,
    what: What,
    /// The factor by which it increases their length.
    pub(super) size: Expr,
}

enum What {
    Whole,
    Along(Expr),
    Across(Expr),
    /// The moment about a homogeneous point.
    About(Expr),
    /// The component of rotations that fix an axis a: `|a|² m` minus its parts along a.
    Keeping(Expr),
    Plane(Expr, Expr),
    /// A scalar in proportion to a parameter.
    Times(Expr),
    /// The component of maps that preserve a quadratic form: for `δQ = ζ Q` with `ζ^T P + P ζ = 0`, the skew part of
    /// `P⁻¹ m`.
    Form(Expr),
    FormRight(Expr),
    /// Translations of one column, or of one row.
    Column(Expr),
    Row(Expr),
    /// The components of columns, or of rows, orthogonal to an axis a, times `|a|²`.
    AcrossColumns(Expr),
    AcrossRows(Expr),
}

impl MomentumComponent {
    /// This component of the momentum `m`.
    pub(super) fn of(&self, x: &Inputs, m: &Expr) -> Expr {
        let s = &x.letters.symbols;
        let m = m.clone();
        match &self.what {
            What::Whole => m,
            What::Along(a) => expr::dot(m, a.clone()),
            What::Across(a) => expr::cross(a.clone(), m),
            What::About(p) => match motions::rigid_of(x, m.shape()) {
                Some(rigid) => homogeneous::moment(s, rigid, &m, p),
                None => m,
            },
            What::Keeping(a) => {
                let outer = expr::mul(a.clone(), expr::transpose(s, a.clone()));
                let shape = m.shape();
                let square = expr::dot(a.clone(), a.clone());
                expr::sum(
                    [
                        expr::mul(square, m.clone()),
                        expr::neg(expr::mul(outer.clone(), m.clone())),
                        expr::neg(expr::mul(m, outer)),
                    ],
                    shape,
                )
            }
            What::Plane(a, b) => expr::dot(a.clone(), expr::mul(m, b.clone())),
            What::Times(a) => expr::mul(a.clone(), m),
            What::Form(p) => expr::part(Part::Skew, expr::mul(p.clone(), m)),
            What::FormRight(p) => expr::part(Part::Skew, expr::mul(m, p.clone())),
            What::Column(a) => expr::mul(m, a.clone()),
            What::Row(a) => expr::mul(expr::transpose(s, m), a.clone()),
            What::AcrossColumns(a) => expr::mul(across(x, a), m),
            What::AcrossRows(a) => expr::mul(m, across(x, a)),
        }
    }

    /// Whether it gives the whole momentum.
    pub(super) fn is_whole(&self) -> bool {
        matches!(self.what, What::Whole)
    }

    /// Whether it gives a scalar.
    pub(super) fn is_number(&self) -> bool {
        let of_number = matches!(self.sort, Sort::Mixed | Sort::Entries(ONE));
        matches!(self.what, What::Along(_) | What::Plane(..)) || of_number
    }
}

/// `|a|² Id - a a^T`.
fn across(x: &Inputs, a: &Expr) -> Expr {
    let outer = expr::mul(a.clone(), expr::transpose(&x.letters.symbols, a.clone()));
    let whole = expr::mul(
        expr::dot(a.clone(), a.clone()),
        expr::identity(a.shape().rows),
    );
    expr::sub(whole, outer)
}

/// An axis with its name and length.
struct Axis {
    name: String,
    value: Expr,
    length: Expr,
}

/// All components for the given sorts, whole momenta first.
pub(super) fn momentum_components(x: &Inputs, sorts: &[Sort]) -> Vec<MomentumComponent> {
    let mut out = Vec::new();
    let order = |sort: &Sort| match sort {
        Sort::Rigid(_) => 0,
        Sort::Linear => 1,
        Sort::Shifts(_) => 1,
        Sort::Mixed => 3,
        Sort::Planes(_) | Sort::Affine(_) | Sort::Entries(_) | Sort::Angular => 2,
    };
    let mut sorts = sorts.to_vec();
    sorts.sort_by_key(order);
    sorts.dedup();
    for sort in sorts {
        let mut push = |name: String, what: What, size: Expr| {
            out.push(MomentumComponent {
                sort,
                name,
                what,
                size,
            });
        };
        let one = || expr::integer(1);
        let told = |a: &Axis| !matches!(a.value.node(), expr::Node::Unit(..));
        push(String::new(), What::Whole, one());
        let axes = match sort {
            Sort::Rigid(_) | Sort::Mixed | Sort::Entries(ONE) => Vec::new(),
            Sort::Shifts(shape) if shape.is_vector() && !shape.is_scalar() => axes(x, shape.rows),
            Sort::Shifts(_) => Vec::new(),
            Sort::Angular | Sort::Linear => axes(x, Dim::Fixed(3)),
            Sort::Planes(n) | Sort::Affine(n) | Sort::Entries(n) => axes(x, n),
        };
        match sort {
            Sort::Mixed => {}
            Sort::Rigid(n) => {
                let space = motions::rigid_of(x, Shape::vector(n)).map(|rigid| rigid.space());
                for p in motions::homogeneous(x, space).into_iter().take(AXES) {
                    let point = expr::here(&x.letters.symbols, p);
                    let far = length(x, &point);
                    push(
                        format!("moment_about_{}", ascii(x, p)),
                        What::About(point),
                        far,
                    );
                }
            }
            Sort::Entries(ONE) => {
                for a in numbers(x) {
                    push(a.name, What::Times(a.value), a.length);
                }
            }
            Sort::Shifts(shape) => {
                for a in &axes {
                    let along = What::Along(a.value.clone());
                    push(a.name.clone(), along, a.length.clone());
                }
                for (name, value, size) in proportional(x, &axes) {
                    push(name, What::Along(value), size);
                }
                // In the plane there is one direction across an axis.
                let told = axes.iter().filter(|a| told(a));
                for a in told.filter(|_| shape == Shape::vector(Dim::Fixed(2))) {
                    let turn = expr::quarter_turn(&x.letters.symbols);
                    let across = What::Along(expr::mul(turn, a.value.clone()));
                    push(format!("across_{}", a.name), across, a.length.clone());
                }
            }
            Sort::Angular | Sort::Linear => {
                for a in &axes {
                    let along = What::Along(a.value.clone());
                    push(a.name.clone(), along, a.length.clone());
                }
                if sort == Sort::Linear {
                    for (name, value, size) in proportional(x, &axes) {
                        push(name, What::Along(value), size);
                    }
                }
                // The remaining components, if the component along an axis is not conserved.
                for a in axes.iter().filter(|a| told(a)) {
                    let across = What::Across(a.value.clone());
                    push(format!("across_{}", a.name), across, a.length.clone());
                }
                if sort == Sort::Linear {
                    let told: Vec<&Axis> = axes.iter().filter(|a| told(a)).take(PAIRED).collect();
                    for (i, a) in told.iter().enumerate() {
                        for b in told.iter().skip(i + 1) {
                            let normal = expr::cross(a.value.clone(), b.value.clone());
                            let size = expr::mul(a.length.clone(), b.length.clone());
                            let name = format!("across_{}_{}", a.name, b.name);
                            push(name, What::Along(normal), size);
                        }
                    }
                }
            }
            Sort::Planes(_) => {
                for a in &axes {
                    let square = expr::mul(a.length.clone(), a.length.clone());
                    push(a.name.clone(), What::Keeping(a.value.clone()), square);
                }
                for (i, a) in axes.iter().enumerate() {
                    for b in &axes[i + 1..] {
                        let size = expr::mul(a.length.clone(), b.length.clone());
                        let plane = What::Plane(a.value.clone(), b.value.clone());
                        push(format!("{}_{}", a.name, b.name), plane, size);
                    }
                }
            }
            Sort::Affine(n) => {
                let identity = What::Form(expr::identity(n));
                push("skew_identity".to_owned(), identity, one());
                for (name, p) in forms(x, n) {
                    let size = length(x, &p);
                    let left = What::Form(p.clone());
                    push(format!("skew_{name}"), left, size.clone());
                    push(format!("skew_{name}_right"), What::FormRight(p), size);
                }
            }
            Sort::Entries(_) => {
                for a in &axes {
                    let column = What::Column(a.value.clone());
                    push(format!("column_{}", a.name), column, a.length.clone());
                    let row = What::Row(a.value.clone());
                    push(format!("row_{}", a.name), row, a.length.clone());
                }
                for a in axes.iter().filter(|a| told(a)) {
                    let size = expr::mul(a.length.clone(), a.length.clone());
                    let columns = What::AcrossColumns(a.value.clone());
                    push(format!("columns_across_{}", a.name), columns, size.clone());
                    let rows = What::AcrossRows(a.value.clone());
                    push(format!("rows_across_{}", a.name), rows, size);
                }
            }
        }
    }
    out
}

fn ascii(x: &Inputs, id: SymbolId) -> String {
    x.letters.symbols.get(id).ascii.clone()
}

/// Axes of the basis, then parameters, then axes from homogeneous parameters in space.
fn axes(x: &Inputs, n: Dim) -> Vec<Axis> {
    let s = &x.letters.symbols;
    let count = match n {
        Dim::Fixed(n) => n.min(8) as u8,
        Dim::Named(_) => 0,
    };
    let mut out: Vec<Axis> = (0..count)
        .map(|axis| Axis {
            name: format!("E{}", axis + 1),
            value: expr::unit(n, axis),
            length: expr::integer(1),
        })
        .collect();
    let mut push = |p: SymbolId, value: Expr| {
        out.push(Axis {
            name: ascii(x, p),
            length: length(x, &value),
            value,
        });
    };
    let parameters = x.spec.parameters.iter().copied();
    let vectors = parameters.filter(|p| s.get(*p).shape == Shape::vector(n));
    for p in vectors.take(AXES) {
        push(p, expr::here(s, p));
    }
    for p in motions::homogeneous(x, Some(n)).into_iter().take(AXES) {
        push(p, homogeneous::spatial_part(s, &expr::here(s, p)));
    }
    out
}

/// Scalar parameters: one of several fields may move in proportion to such a parameter.
fn numbers(x: &Inputs) -> Vec<Axis> {
    let s = &x.letters.symbols;
    let fields = x
        .spec
        .configurations
        .iter()
        .filter(|c| c.group.is_additive());
    let number = fields.clone().any(|c| c.group.shape().is_scalar());
    if !number || fields.count() < 2 {
        return Vec::new();
    }
    let parameters = x.spec.parameters.iter().copied();
    let numbers = parameters.filter(|p| s.get(*p).shape.is_scalar());
    let axis = |p: SymbolId| Axis {
        name: ascii(x, p),
        value: expr::here(s, p),
        length: length(x, &expr::here(s, p)),
    };
    numbers.take(AXES).map(axis).collect()
}

/// The largest number of parameters in proportion to which a component of a vector may move.
const PROPORTIONS: usize = 4;

/// Axes of the basis in proportion to parameters, for motions with a scalar: their names, values and lengths.
fn proportional(x: &Inputs, axes: &[Axis]) -> Vec<(String, Expr, Expr)> {
    let units = axes
        .iter()
        .filter(|a| matches!(a.value.node(), expr::Node::Unit(..)));
    let numbers = numbers(x);
    let pairs = units.flat_map(|a| numbers.iter().take(PROPORTIONS).map(move |p| (a, p)));
    let of = |(a, p): (&Axis, &Axis)| {
        let name = format!("{}_{}", p.name, a.name);
        (
            name,
            expr::mul(p.value.clone(), a.value.clone()),
            p.length.clone(),
        )
    };
    pairs.map(of).collect()
}

/// Symmetric parameters and their inverses.
fn forms(x: &Inputs, n: Dim) -> Vec<(String, Expr)> {
    let s = &x.letters.symbols;
    let parameters = x.spec.parameters.iter().copied();
    let symmetric = parameters
        .filter(|p| s.get(*p).shape == Shape::square(n))
        .take(AXES)
        .filter(|p| s.get(*p).structure.is_symmetric());
    let both = symmetric.flat_map(|p| {
        let e = expr::here(s, p);
        [
            (
                format!("{}_inverse", ascii(x, p)),
                expr::inverse(s, e.clone()),
            ),
            (ascii(x, p), e),
        ]
    });
    both.collect()
}
