//! Motions of one configuration that may be symmetries, and their momenta: turns and shifts seen from
//! space and from the body, turns about the body's own origin, and shifts of matrices entry by entry.
//! Takes the configurations; gives momenta in the letters of a node, and the variation that a motion
//! is.

use super::{Inputs, length};
use crate::check::spec::{Configuration, Group, Side};
use crate::derive::bracket;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr};
use crate::groups::{Additive, GeneralLinear, SpecialOrthogonal};

const THREE: Dim = Dim::Fixed(3);
const FOUR: Dim = Dim::Fixed(4);
const SIX: Dim = Dim::Fixed(6);

/// What a motion is read in: momenta of one sort may be added.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sort {
    /// Turns of three dimensions, by their axis.
    Angular,
    /// Shifts of three dimensions.
    Linear,
    /// Both of them.
    Rigid,
    /// Turns of n dimensions, by their planes.
    Planes(Dim),
    /// Linear maps of n dimensions.
    Affine(Dim),
    /// Shifts of square matrices.
    Entries(Dim),
    /// Shifts of other arrays.
    Shifts(Shape),
}

/// From where a motion is seen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Way {
    /// `δg = ζ g`.
    Space,
    /// `δg = g ζ`.
    Body,
    /// A rigid motion turns as seen from space, and its origin stays.
    Spin,
    /// A rigid motion turns as seen from space, about a place that a parameter is.
    About(SymbolId),
    /// `δQ` is a constant matrix.
    Shift,
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
    /// The same component by component, where they are of different units.
    pub(super) scales: Option<Expr>,
    /// Whether the motions before span it.
    pub(super) spanned: bool,
}

/// Most places that turns are tried about.
const PLACES: usize = 6;

/// The node momentum in the space frame.
pub(super) fn in_space(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::Body)
}

/// The node momentum in the body frame.
fn in_body(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::Spatial)
}

/// The node momentum, carried to the other frame if it is stated on this side.
fn turned(x: &Inputs, i: usize, from: Side) -> Expr {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    if c.side != from {
        return mu;
    }
    let g = expr::here(s, c.element);
    let g = match c.side {
        Side::Body => g,
        Side::Spatial => c.group.inverse(s, g),
    };
    c.group.to_space(s, &g, mu)
}

/// Angular and linear momentum of a rigid motion, in space or in the body.
fn parts(x: &Inputs, i: usize, way: Way) -> (Expr, Expr) {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    let (a, l) = (bracket::angular(s, &mu), bracket::linear(s, &mu));
    let g = expr::here(s, c.element);
    let (turn, place) = (expr::block(s, &g), expr::column(s, &g));
    match (way == Way::Body, c.side) {
        (true, Side::Body) | (false, Side::Spatial) => (a, l),
        (true, Side::Spatial) => {
            let back = expr::transpose(s, turn);
            let own = expr::sub(a, expr::cross(place, l.clone()));
            (expr::mul(back.clone(), own), expr::mul(back, l))
        }
        (false, Side::Body) => {
            let l = expr::mul(turn.clone(), l);
            (
                expr::add(expr::mul(turn, a), expr::cross(place, l.clone())),
                l,
            )
        }
    }
}

/// Sizes of the terms of the angular and of the linear momentum of a rigid motion. About the origin of
/// space the angular one is that about the body's own origin and that of the linear momentum, which
/// both grow when the body travels, while their sum stays.
fn sizes(x: &Inputs, i: usize, way: Way) -> [Expr; 2] {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    let own = length(x, &bracket::angular(s, &mu));
    let linear = length(x, &bracket::linear(s, &mu));
    if way == Way::Body && c.side == Side::Body {
        return [own, linear];
    }
    let place = expr::column(s, &expr::here(s, c.element));
    let lever = expr::mul(length(x, &place), linear.clone());
    [expr::add(own, lever), linear]
}

/// A vector whose three components are one.
fn ones() -> Expr {
    let units = (0..3).map(|axis| expr::unit(THREE, axis));
    expr::sum(units.collect::<Vec<_>>(), Shape::vector(THREE))
}

/// All motions of all configurations; those as seen from space first.
pub(super) fn motions(x: &Inputs) -> Vec<Motion> {
    let mut out: Vec<Motion> = Vec::new();
    let ways = [Way::Space, Way::Spin, Way::Shift, Way::Body];
    for way in ways {
        for i in 0..x.spec.configurations.len() {
            of_configuration(x, i, way, &mut out);
        }
    }
    let s = &x.letters.symbols;
    let places = x.spec.parameters.iter().copied();
    let of_field = |shape| {
        let mut all = x.spec.configurations.iter();
        all.any(|c| c.group.is_additive() && c.group.shape() == shape)
    };
    let places = places.filter(|p| {
        let shape = s.get(*p).shape;
        shape == Shape::vector(THREE) || shape.is_vector() && !shape.is_scalar() && of_field(shape)
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
        let scales = (sort == Sort::Rigid).then(|| {
            let [angular, linear] = sizes(x, i, way).map(|size| expr::mul(ones(), size));
            expr::stacked(angular, linear)
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
        Way::Space | Way::Spin | Way::About(_) | Way::Shift => in_space(x, i),
    };
    match (c.group, way) {
        (Group::RigidMotions(_), Way::Space | Way::Body) => {
            let [angular, linear] = sizes(x, i, way);
            let both = expr::add(angular.clone(), linear.clone());
            push(Sort::Rigid, m, Some(both), true);
            let (a, l) = parts(x, i, way);
            push(Sort::Linear, l, Some(linear), false);
            push(Sort::Angular, a, Some(angular), false);
        }
        (Group::RigidMotions(_), Way::Spin) => {
            let (angular, linear) = parts(x, i, Way::Space);
            let mu = expr::here(s, x.letters.node_momentum[i]);
            let g = expr::here(s, c.element);
            let value = match c.side {
                Side::Body => expr::mul(expr::block(s, &g), bracket::angular(s, &mu)),
                Side::Spatial => expr::sub(angular, expr::cross(expr::column(s, &g), linear)),
            };
            // The state keeps the moment about the origin of space, of which this is a part.
            let [angular, _] = sizes(x, i, Way::Space);
            push(Sort::Angular, value, Some(angular), false);
        }
        (Group::RigidMotions(_), Way::About(p)) => {
            let place = expr::here(s, p);
            let (angular, linear) = parts(x, i, Way::Space);
            let value = expr::sub(angular, expr::cross(place.clone(), linear));
            let [own, weight] = sizes(x, i, Way::Space);
            let far = expr::mul(length(x, &place), weight);
            let scale = expr::add(own, far);
            push(Sort::Angular, value, Some(scale), true);
        }
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
            let value = match c.side {
                Side::Body => expr::mul(back, mu),
                Side::Spatial => expr::mul(mu, back),
            };
            push(Sort::Entries(n), value, None, false);
        }
        (Group::Additive(Additive(shape)), Way::Space) => {
            let place = expr::here(s, c.element);
            push(shifts(shape), m.clone(), None, false);
            // Turns and linear maps of space, by which columns are moved.
            let outer = expr::mul(m.clone(), expr::transpose(s, place.clone()));
            let lever = expr::mul(length(x, &m), length(x, &place));
            let n = shape.rows;
            if shape == Shape::vector(THREE) {
                push(Sort::Angular, expr::cross(place, m), Some(lever), false);
            } else if shape.is_vector() && !shape.is_scalar() {
                let turning = expr::sub(outer.clone(), expr::transpose(s, outer));
                push(Sort::Planes(n), turning, Some(lever), false);
            } else if !shape.is_vector() {
                of_matrix(s, n, outer, lever, &mut push);
            }
        }
        // By which rows are moved.
        (Group::Additive(Additive(shape)), Way::Body) if !shape.is_vector() => {
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
        (Group::Additive(_), Way::Body) => {}
        (_, Way::Spin | Way::About(_) | Way::Shift) => {}
    }
}

/// What a shift of an array of a shape is.
fn shifts(shape: Shape) -> Sort {
    match shape == Shape::vector(THREE) {
        true => Sort::Linear,
        false if !shape.is_vector() && shape.rows == shape.cols => Sort::Entries(shape.rows),
        false => Sort::Shifts(shape),
    }
}

/// The momenta of linear maps of n dimensions and of the turns among them, given that of all maps.
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
    /// Shape and structure of what the momentum is paired with.
    pub(super) fn direction(&self) -> (Shape, Structure) {
        match self.sort {
            Sort::Angular | Sort::Linear => (Shape::vector(THREE), Structure::General),
            Sort::Rigid => (Shape::vector(SIX), Structure::General),
            Sort::Planes(n) => (Shape::square(n), Structure::Skew),
            Sort::Affine(n) | Sort::Entries(n) => (Shape::square(n), Structure::General),
            Sort::Shifts(shape) => (shape, Structure::General),
        }
    }

    /// The covector that a gradient with respect to the direction is.
    pub(super) fn covector(&self, s: &Symbols, gradient: Expr) -> Expr {
        match self.sort {
            Sort::Planes(_) => expr::sub(gradient.clone(), expr::transpose(s, gradient)),
            Sort::Angular
            | Sort::Linear
            | Sort::Rigid
            | Sort::Affine(_)
            | Sort::Entries(_)
            | Sort::Shifts(_) => gradient,
        }
    }

    /// The letter of variation `ξ` of the motion along `v`, `Λ^-1 δΛ` on the body side and
    /// `δΛ Λ^-1` on the spatial side, by the element `g`.
    pub(super) fn variation(&self, s: &Symbols, c: &Configuration, g: &Expr, v: &Expr) -> Expr {
        let v = v.clone();
        // In the frame of the motion, and whether that is the frame of ξ.
        let own = match (self.way, c.side) {
            (Way::Body, Side::Body) | (Way::Space, Side::Spatial) => true,
            (Way::Body, Side::Spatial) | (Way::Space, Side::Body) => false,
            (Way::Spin | Way::About(_) | Way::Shift, _) => false,
        };
        let back = || expr::inverse(s, g.clone());
        match c.group {
            Group::RigidMotions(_) => {
                let (angular, linear) = self.twist(s, g, v);
                if own || c.side == Side::Spatial && self.way != Way::Body {
                    return expr::stacked(angular, linear);
                }
                let turn = expr::block(s, g);
                let place = expr::column(s, g);
                if c.side == Side::Spatial {
                    let angular = expr::mul(turn.clone(), angular);
                    let moved =
                        expr::add(expr::mul(turn, linear), expr::cross(place, angular.clone()));
                    return expr::stacked(angular, moved);
                }
                let moved = expr::add(linear, expr::cross(angular.clone(), place));
                let turn = expr::transpose(s, turn);
                expr::stacked(expr::mul(turn.clone(), angular), expr::mul(turn, moved))
            }
            Group::SpecialOrthogonal(SpecialOrthogonal(THREE)) | Group::UnitQuaternions(_) => {
                let turn = c.group.turn(s, g).unwrap_or_else(|| g.clone());
                let moved = match (own, c.side) {
                    (true, _) => v,
                    (false, Side::Body) => expr::mul(expr::transpose(s, turn), v),
                    (false, Side::Spatial) => expr::mul(turn, v),
                };
                match c.group.coordinates() {
                    Some(_) => moved,
                    None => expr::hat(moved),
                }
            }
            Group::Additive(Additive(shape)) => match (self.sort, self.way) {
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
            Group::SpecialOrthogonal(_) | Group::GeneralLinear(_) => {
                let v = match (self.sort, c.group) {
                    (Sort::Angular, _) => expr::hat(v),
                    _ => v,
                };
                match (self.way, own, c.side) {
                    (_, true, _) => v,
                    (Way::Shift, _, Side::Body) => expr::mul(back(), v),
                    (Way::Shift, _, Side::Spatial) => expr::mul(v, back()),
                    (_, false, Side::Body) => expr::product([back(), v, g.clone()]),
                    (_, false, Side::Spatial) => expr::product([g.clone(), v, back()]),
                }
            }
        }
    }

    /// Angular and linear velocity of a rigid motion, in space or in the body.
    fn twist(&self, s: &Symbols, g: &Expr, v: Expr) -> (Expr, Expr) {
        let none = || expr::zero(Shape::vector(THREE));
        match (self.sort, self.way) {
            (Sort::Linear, _) => (none(), v),
            (Sort::Rigid, _) => (bracket::angular(s, &v), bracket::linear(s, &v)),
            (_, Way::Spin) => (v.clone(), expr::cross(expr::column(s, g), v)),
            (_, Way::About(p)) => (v.clone(), expr::cross(expr::here(s, p), v)),
            _ => (v, none()),
        }
    }
}

/// Whether homogeneous vectors have a meaning in the model.
pub(super) fn has_rigid_motions(x: &Inputs) -> bool {
    let mut list = x.spec.configurations.iter();
    list.any(|c| c.group.is_rigid())
}

/// Homogeneous parameters.
pub(super) fn homogeneous(x: &Inputs) -> Vec<SymbolId> {
    let s = &x.letters.symbols;
    let list = x.spec.parameters.iter().copied();
    list.filter(|p| has_rigid_motions(x) && s.get(*p).shape == Shape::vector(FOUR))
        .collect()
}
