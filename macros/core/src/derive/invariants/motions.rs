//! Motions of one configuration that may be symmetries, and their momenta: rotations and translations in space and in
//! the body, rotations about the body's own origin, and translations of matrix entries. Takes the configurations;
//! gives momenta in the letters of a node, and the variation of each motion.

use super::mixed::{self, Component};
use super::{Inputs, length};
use crate::check::spec::{Group, Side};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr};
use crate::groups::{Additive, Euclidean, GeneralLinear, SpecialOrthogonal};

const THREE: Dim = Dim::Fixed(3);

/// The coordinates of the momentum of a motion. Momenta of one sort may be added.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sort {
    /// Rotations of three dimensions, by their axis.
    Angular,
    /// Translations of three dimensions.
    Linear,
    /// Both of these, with this number of coordinates.
    Rigid(Dim),
    /// Rotations of n dimensions, by their planes.
    Planes(Dim),
    /// Linear maps of n dimensions.
    Affine(Dim),
    /// Translations of square matrices.
    Entries(Dim),
    /// Translations of other arrays.
    Shifts(Shape),
    /// One component of a field in proportion to another, of any field.
    Mixed,
}

/// The frame of a motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Way {
    /// `δg = ζ g`.
    Space,
    /// `δg = g ζ`.
    Body,
    /// A rigid motion rotates in space, and its origin is fixed.
    Spin,
    /// A rigid motion rotates in space about a position that is a parameter.
    About(SymbolId),
    /// `δQ` is a constant matrix.
    Shift,
    /// `δX_entry = by` for components of fields. Combinations of such motions are linear maps of all fields together.
    Mixing { entry: u8, by: Component },
}

/// A motion of one configuration.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) configuration: usize,
    pub(super) way: Way,
    pub(super) sort: Sort,
    /// Its momentum.
    pub(super) value: Expr,
    /// The size of its terms.
    pub(super) scale: Expr,
    /// The sizes by components, if the components have different units.
    pub(super) scales: Option<Expr>,
    /// Whether the previous motions span it.
    pub(super) spanned: bool,
}

/// The largest number of positions about which rotations are tried.
const PLACES: usize = 6;

/// The node momentum in the space frame.
pub(super) fn in_space(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::is_body)
}

/// The node momentum in the body frame.
fn in_body(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::is_spatial)
}

/// The node momentum, transformed to the other frame if it is stated on this side.
fn turned(x: &Inputs, i: usize, from: fn(Side) -> bool) -> Expr {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    if !from(c.side) {
        return mu;
    }
    let g = expr::here(s, c.element);
    let g = if c.side.is_body() {
        g
    } else {
        c.group.inverse(s, g)
    };
    c.group.to_space(s, &g, mu)
}

/// Angular and linear momentum of a rigid motion, in space or in the body.
fn parts(x: &Inputs, i: usize, rigid: &dyn Euclidean, way: Way) -> (Expr, Expr) {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    let (a, l) = (rigid.angular(s, &mu), rigid.linear(s, &mu));
    let g = expr::here(s, c.element);
    let (turn, place) = (expr::block(s, &g), expr::column(s, &g));
    match (way == Way::Body, c.side.is_body()) {
        (true, true) | (false, false) => (a, l),
        (true, false) => {
            let back = expr::transpose(s, turn);
            let own = expr::sub(a, rigid.moment(s, place, l.clone()));
            (rigid.turned(back.clone(), own), expr::mul(back, l))
        }
        (false, true) => {
            let l = expr::mul(turn.clone(), l);
            let moment = rigid.moment(s, place, l.clone());
            (expr::add(rigid.turned(turn, a), moment), l)
        }
    }
}

/// Sizes of the terms of the angular and of the linear momentum of a rigid motion. About the origin of space, the
/// angular momentum is the sum of two terms: the angular momentum about the body's own origin, and the moment of the
/// linear momentum. Both can grow with the displacement of the body, although their sum is conserved.
fn sizes(x: &Inputs, i: usize, rigid: &dyn Euclidean, way: Way) -> [Expr; 2] {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    let own = length(x, &rigid.angular(s, &mu));
    let linear = length(x, &rigid.linear(s, &mu));
    if way == Way::Body && c.side.is_body() {
        return [own, linear];
    }
    let place = expr::column(s, &expr::here(s, c.element));
    let lever = expr::mul(length(x, &place), linear.clone());
    [expr::add(own, lever), linear]
}

/// A vector of ones; for a scalar, one.
fn ones(shape: Shape) -> Expr {
    let units = match shape.rows {
        _ if shape.is_scalar() => return expr::integer(1),
        Dim::Fixed(n) => (0..n).filter_map(|axis| u8::try_from(axis).ok()),
        Dim::Named(_) => return expr::zero(shape),
    };
    let units = units.map(|axis| expr::unit(shape.rows, axis));
    expr::sum(units.collect::<Vec<_>>(), shape)
}

/// The sort of the momenta of rotations of a space.
fn turns(space: Dim) -> Sort {
    match space == THREE {
        true => Sort::Angular,
        false => Sort::Planes(space),
    }
}

/// All motions of all configurations; motions in space come first.
pub(super) fn motions(x: &Inputs) -> Vec<Motion> {
    let mut out: Vec<Motion> = Vec::new();
    let ways = [Way::Space, Way::Spin, Way::Shift, Way::Body];
    for way in ways {
        for i in 0..x.spec.configurations.len() {
            of_configuration(x, i, way, &mut out);
        }
    }
    out.extend(mixed::motions(x));
    let s = &x.letters.symbols;
    let places = x.spec.parameters.iter().copied();
    let of_places = |shape| {
        let mut all = x.spec.configurations.iter();
        all.any(|c| match c.group.rigid() {
            Some(rigid) => rigid.linear_shape() == shape,
            None => c.group.is_additive() && c.group.shape() == shape,
        })
    };
    let places = places.filter(|p| {
        let shape = s.get(*p).shape;
        shape == Shape::vector(THREE) || shape.is_vector() && !shape.is_scalar() && of_places(shape)
    });
    for p in places.take(PLACES) {
        for i in 0..x.spec.configurations.len() {
            of_configuration(x, i, Way::About(p), &mut out);
        }
    }
    out
}

fn of_configuration(x: &Inputs, i: usize, way: Way, out: &mut Vec<Motion>) {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mut push = |sort: Sort, value: Expr, scale: Option<Expr>, spanned: bool| {
        let scale = scale.unwrap_or_else(|| length(x, &value));
        let whole = c.group.rigid().filter(|_| matches!(sort, Sort::Rigid(_)));
        let scales = whole.map(|rigid| {
            let [angular, linear] = sizes(x, i, rigid, way);
            let angular = expr::mul(ones(rigid.angular_shape()), angular);
            expr::stacked(angular, expr::mul(ones(rigid.linear_shape()), linear))
        });
        out.push(Motion {
            configuration: i,
            way,
            sort,
            value,
            scale,
            scales,
            spanned,
        });
    };
    let m = match way {
        Way::Body => in_body(x, i),
        Way::Space | Way::Spin | Way::About(_) | Way::Shift | Way::Mixing { .. } => in_space(x, i),
    };
    if let Some(rigid) = c.group.rigid() {
        return of_rigid(x, i, rigid, way, m, &mut push);
    }
    match (c.group, way) {
        (
            Group::SpecialOrthogonal(SpecialOrthogonal(THREE)) | Group::UnitQuaternions(_),
            Way::Space | Way::Body,
        ) => {
            push(Sort::Angular, m, None, false);
        }
        (Group::SpecialOrthogonal(SpecialOrthogonal(n)), Way::Space | Way::Body) => {
            push(Sort::Planes(n), m, None, false);
        }
        (Group::GeneralLinear(GeneralLinear(n)), Way::Space | Way::Body) => {
            let scale = length(x, &m);
            of_matrix(s, n, m, scale, &mut push);
        }
        (Group::GeneralLinear(GeneralLinear(n)), Way::Shift) => {
            let mu = expr::here(s, x.letters.node_momentum[i]);
            let back = expr::inverse(s, expr::transpose(s, expr::here(s, c.element)));
            let value = c.side.product(back, mu);
            push(Sort::Entries(n), value, None, false);
        }
        (Group::Additive(Additive(shape)), Way::Space) => {
            let place = expr::here(s, c.element);
            push(shifts(shape), m.clone(), None, false);
            // Rotations and linear maps of space, which act on columns.
            let outer = expr::mul(m.clone(), expr::transpose(s, place.clone()));
            let lever = expr::mul(length(x, &m), length(x, &place));
            let n = shape.rows;
            if shape == Shape::vector(THREE) {
                push(Sort::Angular, expr::cross(place, m), Some(lever), false);
            } else if shape.is_vector() && !shape.is_scalar() {
                let turning = expr::sub(outer.clone(), expr::transpose(s, outer));
                push(Sort::Planes(n), turning, Some(lever), false);
            } else if !shape.is_vector() && !shape.is_scalar() {
                of_matrix(s, n, outer, lever, &mut push);
            }
        }
        // Maps that act on rows.
        (Group::Additive(Additive(shape)), Way::Body)
            if !shape.is_vector() && !shape.is_scalar() =>
        {
            let place = expr::here(s, c.element);
            let lever = expr::mul(length(x, &m), length(x, &place));
            let outer = expr::mul(expr::transpose(s, place), m);
            of_matrix(s, shape.cols, outer, lever, &mut push);
        }
        (Group::Additive(Additive(shape)), Way::About(p)) if s.get(p).shape == shape => {
            let (place, about) = (expr::here(s, c.element), expr::here(s, p));
            let reach = expr::add(length(x, &place), length(x, &about));
            let lever = Some(expr::mul(length(x, &m), reach));
            let arm = expr::sub(place, about);
            if shape == Shape::vector(THREE) {
                push(Sort::Angular, expr::cross(arm, m), lever, true);
            } else {
                let outer = expr::mul(m, expr::transpose(s, arm));
                let turning = expr::sub(outer.clone(), expr::transpose(s, outer));
                push(Sort::Planes(shape.rows), turning, lever, true);
            }
        }
        _ => {}
    }
}

/// Bodies are drawn one by one; each draw is repeated until the roots that it completes exist.
fn of_rigid(
    x: &Inputs,
    i: usize,
    rigid: &dyn Euclidean,
    way: Way,
    m: Expr,
    push: &mut impl FnMut(Sort, Expr, Option<Expr>, bool),
) {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let turns = turns(rigid.space());
    match way {
        Way::Space | Way::Body => {
            let [angular, linear] = sizes(x, i, rigid, way);
            let both = expr::add(angular.clone(), linear.clone());
            push(Sort::Rigid(m.shape().rows), m, Some(both), true);
            let (a, l) = parts(x, i, rigid, way);
            push(shifts(rigid.linear_shape()), l, Some(linear), false);
            push(turns, rigid.as_turn(s, a), Some(angular), false);
        }
        Way::Spin => {
            let (angular, linear) = parts(x, i, rigid, Way::Space);
            let mu = expr::here(s, x.letters.node_momentum[i]);
            let g = expr::here(s, c.element);
            let value = if c.side.is_body() {
                rigid.turned(expr::block(s, &g), rigid.angular(s, &mu))
            } else {
                expr::sub(angular, rigid.moment(s, expr::column(s, &g), linear))
            };
            // The state stores the moment about the origin of space, of which this is a part.
            let [angular, _] = sizes(x, i, rigid, Way::Space);
            push(turns, rigid.as_turn(s, value), Some(angular), false);
        }
        Way::About(p) if s.get(p).shape == rigid.linear_shape() => {
            let place = expr::here(s, p);
            let (angular, linear) = parts(x, i, rigid, Way::Space);
            let value = expr::sub(angular, rigid.moment(s, place.clone(), linear));
            let [own, weight] = sizes(x, i, rigid, Way::Space);
            let far = expr::mul(length(x, &place), weight);
            let scale = expr::add(own, far);
            push(turns, rigid.as_turn(s, value), Some(scale), true);
        }
        Way::About(_) | Way::Shift | Way::Mixing { .. } => {}
    }
}

/// The sort of a translation of an array of this shape.
fn shifts(shape: Shape) -> Sort {
    match shape == Shape::vector(THREE) {
        true => Sort::Linear,
        false if !shape.is_vector() && shape.rows == shape.cols => Sort::Entries(shape.rows),
        false => Sort::Shifts(shape),
    }
}

/// The momenta of linear maps of n dimensions and of the rotations among them, from the momentum of all maps.
fn of_matrix(
    s: &Symbols,
    n: Dim,
    whole: Expr,
    scale: Expr,
    push: &mut impl FnMut(Sort, Expr, Option<Expr>, bool),
) {
    push(Sort::Affine(n), whole.clone(), Some(scale.clone()), false);
    let turning = Group::rotations(n).covector(s, whole);
    match n == THREE {
        true => push(Sort::Angular, turning, Some(scale), true),
        false => push(Sort::Planes(n), turning, Some(scale), true),
    }
}

impl Motion {
    /// Shape and structure of the direction of the motion.
    pub(super) fn direction(&self) -> (Shape, Structure) {
        match self.sort {
            Sort::Angular | Sort::Linear => (Shape::vector(THREE), Structure::General),
            Sort::Rigid(n) => (Shape::vector(n), Structure::General),
            Sort::Planes(n) => (Shape::square(n), Structure::Skew),
            Sort::Affine(n) | Sort::Entries(n) => (Shape::square(n), Structure::General),
            Sort::Shifts(shape) => (shape, Structure::General),
            Sort::Mixed => (Shape::SCALAR, Structure::General),
        }
    }

    /// The covector of a gradient with respect to the direction.
    pub(super) fn covector(&self, s: &Symbols, gradient: Expr) -> Expr {
        match self.sort {
            Sort::Planes(_) => expr::sub(gradient.clone(), expr::transpose(s, gradient)),
            Sort::Angular
            | Sort::Linear
            | Sort::Rigid(_)
            | Sort::Affine(_)
            | Sort::Entries(_)
            | Sort::Shifts(_)
            | Sort::Mixed => gradient,
        }
    }

    /// The letter of variation `ξ` of the motion along `v`, `Λ^-1 δΛ` on the body side and `δΛ Λ^-1` on the spatial
    /// side, for the element `g`.
    pub(super) fn variation(&self, x: &Inputs, s: &Symbols, g: &Expr, v: &Expr) -> Expr {
        let c = &x.spec.configurations[self.configuration];
        let v = v.clone();
        // In the frame of the motion, and whether that is the frame of ξ.
        let own = match self.way {
            Way::Body => c.side.is_body(),
            Way::Space => c.side.is_spatial(),
            Way::Spin | Way::About(_) | Way::Shift | Way::Mixing { .. } => false,
        };
        let back = || expr::inverse(s, g.clone());
        if let Some(rigid) = c.group.rigid() {
            let (angular, linear) = self.twist(s, rigid, g, v);
            if own || c.side.is_spatial() && self.way != Way::Body {
                return expr::stacked(angular, linear);
            }
            let turn = expr::block(s, g);
            let place = expr::column(s, g);
            if c.side.is_spatial() {
                let angular = rigid.turned(turn.clone(), angular);
                let back = expr::neg(rigid.swept(s, angular.clone(), place));
                let moved = expr::add(expr::mul(turn, linear), back);
                return expr::stacked(angular, moved);
            }
            let moved = expr::add(linear, rigid.swept(s, angular.clone(), place));
            let turn = expr::transpose(s, turn);
            return expr::stacked(rigid.turned(turn.clone(), angular), expr::mul(turn, moved));
        }
        match c.group {
            Group::SpecialOrthogonal(SpecialOrthogonal(THREE)) | Group::UnitQuaternions(_) => {
                let turn = c.group.turn(s, g).unwrap_or_else(|| g.clone());
                let moved = match (own, c.side.is_body()) {
                    (true, _) => v,
                    (false, true) => expr::mul(expr::transpose(s, turn), v),
                    (false, false) => expr::mul(turn, v),
                };
                match c.group.coordinates() {
                    Some(_) => moved,
                    None => expr::hat(moved),
                }
            }
            Group::Additive(Additive(shape)) => match (self.sort, self.way) {
                (_, Way::Mixing { entry, by }) => {
                    // At the node of the element.
                    let time = expr::letters(g).first().map_or(0, |l| l.shift.time);
                    let field = expr::shift_time(s, &by.field(x), time);
                    let moved = expr::mul(v, by.of(&field));
                    match shape.is_scalar() {
                        true => moved,
                        false => expr::mul(moved, expr::unit(shape.rows, entry)),
                    }
                }
                (Sort::Linear | Sort::Shifts(_) | Sort::Entries(_), _) => v,
                (Sort::Angular | Sort::Planes(_), Way::About(p)) => {
                    let arm = expr::sub(g.clone(), expr::here(s, p));
                    match self.sort {
                        Sort::Angular => expr::cross(v, arm),
                        _ => expr::mul(v, arm),
                    }
                }
                (Sort::Angular, _) if shape.is_vector() => expr::cross(v, g.clone()),
                (Sort::Angular, Way::Body) => expr::mul(g.clone(), expr::hat(v)),
                (Sort::Angular, _) => expr::mul(expr::hat(v), g.clone()),
                (_, Way::Body) => expr::mul(g.clone(), v),
                _ => expr::mul(v, g.clone()),
            },
            _ => {
                let v = match (self.sort, c.group) {
                    (Sort::Angular, _) => expr::hat(v),
                    _ => v,
                };
                match self.way {
                    _ if own => v,
                    Way::Shift => c.side.product(back(), v),
                    _ if c.side.is_body() => expr::product([back(), v, g.clone()]),
                    _ => expr::product([g.clone(), v, back()]),
                }
            }
        }
    }

    /// Angular and linear velocity of a rigid motion, in space or in the body.
    fn twist(&self, s: &Symbols, rigid: &dyn Euclidean, g: &Expr, v: Expr) -> (Expr, Expr) {
        let turning = |place: Option<Expr>| {
            let angular = rigid.of_turn(v.clone());
            let linear = match place {
                // Its velocity at the origin is the negative of the velocity of the position under a rotation about
                // the origin.
                Some(place) => expr::neg(rigid.swept(s, angular.clone(), place)),
                None => expr::zero(rigid.linear_shape()),
            };
            (angular, linear)
        };
        match (self.sort, self.way) {
            (Sort::Linear | Sort::Shifts(_), _) => (expr::zero(rigid.angular_shape()), v),
            (Sort::Rigid(_), _) => (rigid.angular(s, &v), rigid.linear(s, &v)),
            (_, Way::Spin) => turning(Some(expr::column(s, g))),
            (_, Way::About(p)) => turning(Some(expr::here(s, p))),
            _ => turning(None),
        }
    }
}

/// The dimension of the space whose homogeneous coordinates have this shape, if the model has rigid motions of it.
pub(super) fn space_of(x: &Inputs, shape: Shape) -> Option<Dim> {
    let mut list = x.spec.configurations.iter();
    let whole = list.find(|c| c.group.rigid().is_some() && Shape::vector(c.group.size()) == shape);
    whole.map(|c| expr::within(c.group.size()))
}

/// The group of rigid motions whose covectors are of this shape.
pub(super) fn rigid_of<'a>(x: &'a Inputs, covector: Shape) -> Option<&'a dyn Euclidean> {
    let mut list = x.spec.configurations.iter();
    list.find_map(|c| {
        c.group
            .rigid()
            .filter(|_| c.group.variation().0 == covector)
    })
}

/// Homogeneous parameters of a space.
pub(super) fn homogeneous(x: &Inputs, space: Option<Dim>) -> Vec<SymbolId> {
    let s = &x.letters.symbols;
    let list = x.spec.parameters.iter().copied();
    list.filter(|p| space.is_some() && space_of(x, s.get(*p).shape) == space)
        .collect()
}
