//! Evaluates expressions of a model in a sample: vectors, matrices and numbers, from the parameters and the
//! observables. Takes an expression, a sample and a site; gives its entries. `None` if it uses a function that
//! pictures do not need.

use crate::output::attitude::{matrix, placed};
use crate::output::places::{Places, Point};
use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use clebsch::card::{Card, Field, Kind as FieldKind};
use clebsch::nalgebra::DMatrix;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Sites;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Expression, Kind, Model, Statement};
use std::collections::HashMap;
use std::ops::Range;

/// A number is a matrix of one entry, a vector one of one column.
pub(super) type Value = DMatrix<f64>;

/// The largest depth of nested abbreviations.
const DEEP: usize = 40;

/// The text of a model, with the numbers of a run.
pub(super) struct Stated<'a> {
    card: &'a Card,
    plan: &'a Plan,
    pub(super) model: Model,
    pub(super) sites: Vec<AtSites<'a>>,
    /// The number of components of a position, which is the length of unit vectors.
    space: usize,
    lets: HashMap<String, Expression>,
    observed: HashMap<&'static str, (&'static Field, Range<usize>)>,
    parameters: HashMap<&'static str, (&'static Field, usize)>,
}

/// The values at which an expression is evaluated.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    /// All that is observed.
    pub(super) row: &'a [f64],
    /// The site, of an expression of sites.
    pub(super) site: Option<isize>,
}

impl<'a> Stated<'a> {
    /// The model of a card; `None` if its text does not parse.
    pub(super) fn of(card: &'a Card, plan: &'a Plan) -> Option<Self> {
        let model = pipeline::parse_source(card.source).ok()?;
        let lets = model.statements.iter().filter_map(|s| match s {
            Statement::Let { name, value } => Some((name.text.clone(), value.clone())),
            _ => None,
        });
        let lets = lets.collect();
        let fields = model.statements.iter().filter_map(|s| match s {
            Statement::Field { shape, .. } => shape.components().filter(|d| *d > 1),
            _ => None,
        });
        let space = fields.max().unwrap_or(3);
        let parameters = card.parameters.iter().enumerate();
        Some(Stated {
            card,
            plan,
            sites: at_sites(card),
            space,
            lets,
            observed: placed(card.observables)
                .map(|(field, columns)| (field.ascii, (field, columns)))
                .collect(),
            parameters: parameters.map(|(at, f)| (f.ascii, (f, at))).collect(),
            model,
        })
    }

    /// The expression that a `let` statement names.
    pub(super) fn abbreviated(&self, name: &str) -> Option<&Expression> {
        self.lets.get(name)
    }

    /// Whether an expression contains an observable.
    pub(super) fn moves(&self, e: &Expression) -> bool {
        self.names(e, &|name| {
            let key = ascii(name);
            self.observed.contains_key(key.as_str()) || self.sites.iter().any(|q| q.key == key)
        })
    }

    /// Whether an expression contains such a name, directly or within an abbreviation.
    pub(super) fn names(&self, e: &Expression, is: &dyn Fn(&str) -> bool) -> bool {
        self.names_within(e, is, DEEP)
    }

    fn names_within(&self, e: &Expression, is: &dyn Fn(&str) -> bool, deep: usize) -> bool {
        let Some(deeper) = deep.checked_sub(1) else {
            return false;
        };
        match &e.kind {
            Kind::Name(n) => match self.lets.get(n) {
                Some(value) => self.names_within(value, is, deeper),
                None => is(n),
            },
            _ => e
                .parts()
                .into_iter()
                .any(|p| self.names_within(p, is, deep)),
        }
    }

    /// The terms of a sum with their signs. Abbreviations and brackets are expanded.
    pub(super) fn terms(&self, e: &Expression) -> Vec<(bool, Expression)> {
        let mut out = Vec::new();
        self.put_terms(e, false, DEEP, &mut out);
        out
    }

    fn put_terms(
        &self,
        e: &Expression,
        minus: bool,
        deep: usize,
        out: &mut Vec<(bool, Expression)>,
    ) {
        let Some(deeper) = deep.checked_sub(1) else {
            return;
        };
        match &e.kind {
            Kind::Sum(terms) => {
                for (own, term) in terms {
                    self.put_terms(term, minus != *own, deeper, out);
                }
            }
            Kind::Neg(inner) => self.put_terms(inner, !minus, deeper, out),
            Kind::Name(n) if self.lets.contains_key(n) => {
                if let Some(value) = self.lets.get(n) {
                    self.put_terms(value, minus, deeper, out);
                }
            }
            Kind::Number(n) if n.is_zero() => {}
            _ => out.push((minus, e.clone())),
        }
    }

    /// The sum of these terms; `None` without terms.
    pub(super) fn sum(&self, terms: &[(bool, Expression)], at: At<'_>) -> Option<Value> {
        self.sum_within(terms.iter(), at, DEEP)
    }

    fn sum_within<'e>(
        &self,
        terms: impl Iterator<Item = &'e (bool, Expression)>,
        at: At<'_>,
        deep: usize,
    ) -> Option<Value> {
        let mut each = terms.map(|(minus, e)| {
            let value = self.within(e, at, deep)?;
            Some(if *minus { -value } else { value })
        });
        let first = each.next()??;
        each.try_fold(first, |sum, next| {
            let next = next?;
            (sum.shape() == next.shape()).then(|| sum + next)
        })
    }

    /// The value of an expression at the node of the sample: `next` in time is ignored.
    pub(super) fn value(&self, e: &Expression, at: At<'_>) -> Option<Value> {
        self.within(e, at, DEEP)
    }

    fn within(&self, e: &Expression, at: At<'_>, deep: usize) -> Option<Value> {
        let deep = deep.checked_sub(1)?;
        let of = |e: &Expression| self.within(e, at, deep);
        match &e.kind {
            Kind::Number(n) => Some(number(n.value())),
            Kind::Constant(c) => Some(number(c.value())),
            Kind::Name(n) => match self.lets.get(n) {
                Some(value) => of(value),
                None => self.named(n, at),
            },
            Kind::Shaped(inner, _) => of(inner),
            Kind::Neg(inner) => Some(-of(inner)?),
            Kind::Transpose(inner) => Some(of(inner)?.transpose()),
            Kind::Sum(list) => {
                let zero = |e: &Expression| matches!(&e.kind, Kind::Number(n) if n.is_zero());
                self.sum_within(list.iter().filter(|(_, e)| !zero(e)), at, deep)
            }
            Kind::Product(list) => {
                let mut each = list.iter().map(of);
                let first = each.next()??;
                each.try_fold(first, |product, next| times(product, next?))
            }
            Kind::Quotient(a, b) => Some(of(a)? / scalar(&of(b)?)?),
            Kind::Power(a, power) => {
                let base = of(a)?;
                match (scalar(&base), power.as_integer()) {
                    (Some(x), _) => Some(number(x.powf(power.value()))),
                    (None, Some(-1)) if base.is_square() => base.try_inverse(),
                    _ => None,
                }
            }
            Kind::Component(a, places) => {
                let value = of(a)?;
                let place = |k: usize| usize::try_from(places.get(k)?.checked_sub(1)?).ok();
                let entry = match places.len() {
                    1 if value.ncols() == 1 => value.get((place(0)?, 0)),
                    2 => value.get((place(0)?, place(1)?)),
                    _ => None,
                };
                entry.map(|x| number(*x))
            }
            Kind::Call(name, arguments) => {
                let first = arguments.first()?;
                match (name.text.as_str(), arguments.get(1)) {
                    ("next", None) => of(first),
                    (way @ ("next" | "prev"), Some(_)) => {
                        let by = if way == "next" { 1 } else { -1 };
                        let site = Some(at.site? + by);
                        self.within(first, At { site, ..at }, deep)
                    }
                    ("dot", Some(second)) => {
                        let (a, b) = (of(first)?, of(second)?);
                        (a.shape() == b.shape()).then(|| number(a.dot(&b)))
                    }
                    ("rot", None) => rotation(&of(first)?),
                    ("pos", None) => translation(&of(first)?),
                    (function, None) => {
                        let x = scalar(&of(first)?)?;
                        let apply: fn(f64) -> f64 = match function {
                            "sqrt" => f64::sqrt,
                            "sin" => f64::sin,
                            "cos" => f64::cos,
                            "exp" => f64::exp,
                            "log" => f64::ln,
                            "abs" => f64::abs,
                            _ => return None,
                        };
                        Some(number(apply(x)))
                    }
                    _ => None,
                }
            }
        }
    }

    fn named(&self, name: &str, at: At<'_>) -> Option<Value> {
        let key = ascii(name);
        if let Some(site) = at.site {
            let own = self.sites.iter().find(|q| q.key == key);
            if let Some(own) = own {
                if own.moves {
                    let point = self.places(own).point(site)?;
                    return Some(shaped(own.field, &point.at(at.row)));
                }
                let wanted = usize::try_from(site).ok()?;
                let (_, columns) = own.members.iter().find(|(s, _)| *s == wanted)?;
                return Some(shaped(own.field, at.row.get(columns.clone())?));
            }
            let copy = format!("{key}_{site}");
            if let Some((field, number)) = self.parameters.get(copy.as_str()) {
                return Some(shaped(field, self.plan.case.parameters.get(*number)?));
            }
        }
        if let Some((field, columns)) = self.observed.get(key.as_str()) {
            return Some(shaped(field, at.row.get(columns.clone())?));
        }
        if let Some((field, number)) = self.parameters.get(key.as_str()) {
            return Some(shaped(field, self.plan.case.parameters.get(*number)?));
        }
        if name == "Id" {
            return Some(Value::identity(self.space, self.space));
        }
        let axis: usize = name.strip_prefix('E')?.parse().ok()?;
        let axis = axis.checked_sub(1).filter(|a| *a < self.space)?;
        Some(Value::from_fn(self.space, 1, |i, _| {
            if i == axis { 1.0 } else { 0.0 }
        }))
    }

    /// The positions of these points, including points with prescribed positions.
    pub(super) fn places<'b>(&'b self, points: &'b AtSites<'b>) -> Places<'b> {
        Places::themselves((self.card, self.plan), points)
    }

    /// The points of a chain in order. They include points with prescribed positions, and for a ring its first node,
    /// repeated at the end.
    pub(super) fn along(&self, points: &AtSites<'_>) -> Vec<Point> {
        let sites = || points.members.iter().map(|(site, _)| *site);
        let (first, last) = (sites().min().unwrap_or(0), sites().max().unwrap_or(0));
        let places = self.places(points);
        // Points with prescribed positions are before the first and after the last site. On a ring the first node
        // follows the last.
        let first = isize::try_from(first).unwrap_or(0);
        let last = isize::try_from(last).unwrap_or(0);
        let beyond = match points.at {
            Sites::Nodes => last.saturating_add(1),
            _ => last,
        };
        let all = first.saturating_sub(1).max(0)..=beyond;
        all.filter_map(|site| places.point(site)).collect()
    }
}

fn number(x: f64) -> Value {
    Value::from_element(1, 1, x)
}

pub(super) fn scalar(value: &Value) -> Option<f64> {
    (value.shape() == (1, 1)).then(|| value.sum())
}

fn times(a: Value, b: Value) -> Option<Value> {
    match (scalar(&a), scalar(&b)) {
        (Some(x), _) => Some(b * x),
        (_, Some(x)) => Some(a * x),
        _ => (a.ncols() == b.nrows()).then(|| a * b),
    }
}

fn shaped(field: &Field, numbers: &[f64]) -> Value {
    match field.kind {
        FieldKind::Diagonal if numbers.len() == field.rows => {
            Value::from_diagonal(&clebsch::nalgebra::DVector::from_row_slice(numbers))
        }
        _ if numbers.len() == field.count() => {
            Value::from_row_slice(field.rows, field.cols, numbers)
        }
        _ => Value::from_row_slice(numbers.len(), 1, numbers),
    }
}

/// The rotation of a rigid motion or of a unit quaternion.
fn rotation(value: &Value) -> Option<Value> {
    match value.shape() {
        (4, 1) => {
            let turn = matrix(value.as_slice())?;
            Some(Value::from_fn(3, 3, |i, j| turn[(i, j)]))
        }
        (n, m) if n == m && n > 1 => Some(value.view((0, 0), (n - 1, n - 1)).into_owned()),
        _ => None,
    }
}

/// The translation of a rigid motion.
fn translation(value: &Value) -> Option<Value> {
    let (n, m) = value.shape();
    (n == m && n > 1).then(|| value.view((0, n - 1), (n - 1, 1)).into_owned())
}
