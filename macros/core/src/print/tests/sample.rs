//! Expressions and formulas for the tests: a symbol table, and lists that contain every kind of node.

use crate::algebra::Rational;
use crate::expr::Constant;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{
    self, Applied, Expr, Function, Functional, FunctionalId, Kind, Letter, Node, Part, Reach, Shift,
};
use crate::print::formula::{Formula, Operator, Relation};

pub const THREE: Dim = Dim::Fixed(3);

/// Symbols of a heavy top, and symbols for other cases that the printers must support.
pub struct Sample {
    pub symbols: Symbols,
}

impl Sample {
    pub fn new() -> Sample {
        let mut s = Symbols::default();
        let matrix = Shape::square(THREE);
        let vector = Shape::vector(THREE);
        s.add("h", Shape::SCALAR, Structure::General, Role::Step);
        for name in ["c", "x_ref"] {
            s.add(name, Shape::SCALAR, Structure::General, Role::Parameter);
        }
        for name in ["J", "C0"] {
            s.add(name, matrix, Structure::Symmetric, Role::Parameter);
        }
        s.add("A", matrix, Structure::General, Role::Parameter);
        for name in ["gU", "z", "d1"] {
            s.add(name, vector, Structure::General, Role::Parameter);
        }
        for name in ["Λ", "Λ1"] {
            s.add(name, matrix, Structure::Orthogonal, Role::Element);
        }
        s.add("Ω", matrix, Structure::Orthogonal, Role::Velocity);
        s.add("Q", matrix, Structure::Invertible, Role::Element);
        for name in ["Γ", "chi"] {
            s.add(name, vector, Structure::General, Role::Advected);
        }
        s.add("M", matrix, Structure::Skew, Role::Derived);
        s.add("P", matrix, Structure::General, Role::Multiplier);
        s.add("ξ", vector, Structure::General, Role::Variation);
        let four = Shape::square(Dim::Fixed(4));
        s.add("q", four, Structure::UnitQuaternion, Role::Element);
        s.add("G", four, Structure::RigidMotion, Role::Element);
        let kind = Kind::of(vector);
        s.add_functional(Functional {
            name: "R".to_owned(),
            arguments: vec![kind],
            value: kind,
            reach: Reach::Point,
            path: String::new(),
            typeset: None,
        });
        Sample { symbols: s }
    }

    pub fn id(&self, name: &str) -> SymbolId {
        self.symbols.find(name).unwrap()
    }

    pub fn letter(&self, name: &str, time: i8) -> Letter {
        Letter {
            symbol: self.id(name),
            shift: Shift {
                time,
                label: [0, 0],
            },
        }
    }

    pub fn at(&self, name: &str, time: i8) -> Expr {
        let at = self.letter(name, time);
        expr::letter(&self.symbols, at.symbol, at.shift)
    }

    pub fn v(&self, name: &str) -> Expr {
        self.at(name, 0)
    }

    pub fn t(&self, e: Expr) -> Expr {
        expr::transpose(&self.symbols, e)
    }

    /// `-tr(J Ω)/h - h gU·Γ`.
    pub fn heavy_top(&self) -> Expr {
        let kinetic = expr::trace(expr::mul(self.v("J"), self.v("Ω")));
        let potential = expr::mul(self.v("h"), expr::dot(self.v("gU"), self.v("Γ")));
        expr::sub(expr::neg(expr::quotient(kinetic, self.v("h"))), potential)
    }

    /// Expressions with every kind of node, and combinations that need brackets.
    pub fn expressions(&self) -> Vec<Expr> {
        let v = |name: &str| self.v(name);
        let q = |n, d| Rational::new(n, d).unwrap();
        let id = || expr::identity(THREE);
        let inverse = |e| expr::inverse(&self.symbols, e);
        let scalars = || expr::add(v("c"), v("x_ref"));
        let minus_id = || expr::sub(v("Ω"), id());
        let row = || self.t(v("z"));
        let two_over_h = || expr::quotient(expr::integer(2), v("h"));
        vec![
            expr::number(q(-7, 3)),
            expr::number(Rational::HALF),
            expr::integer(0),
            expr::product([expr::integer(2), expr::constant(Constant::PI), v("c")]),
            expr::product(
                ["1.380649e-23", "0.123456789"]
                    .map(|x| expr::constant(Constant::parse(x).unwrap())),
            ),
            expr::zero(Shape::vector(THREE)),
            expr::unit(THREE, 2),
            self.heavy_top(),
            expr::neg(expr::quotient(scalars(), v("h"))),
            expr::mul(scalars(), v("J")),
            expr::product([expr::number(q(3, 7)), v("c"), v("gU")]),
            expr::product([expr::number(Rational::HALF), v("c"), v("gU")]),
            expr::quotient(expr::scale(q(3, 2), v("c")), expr::mul(v("h"), v("x_ref"))),
            expr::quotient(expr::mul(v("c"), v("x_ref")), expr::scale(q(2, 1), v("h"))),
            expr::mul(two_over_h(), expr::dot(v("gU"), v("Γ"))),
            expr::neg(two_over_h()),
            expr::quotient(expr::integer(-2), v("h")),
            expr::mul(expr::quotient(scalars(), v("h")), v("A")),
            expr::product([
                expr::quotient(expr::integer(1), v("c")),
                expr::quotient(scalars(), v("h")),
            ]),
            expr::quotient(v("c"), expr::power(v("h"), q(2, 1))),
            expr::power(scalars(), q(2, 1)),
            expr::power(scalars(), Rational::HALF),
            expr::power(v("c"), Rational::HALF),
            expr::power(expr::power(v("c"), Rational::HALF), q(2, 1)),
            expr::power(v("c"), q(-3, 2)),
            expr::power(expr::trace(v("A")), q(-2, 1)),
            expr::power(expr::number(q(2, 3)), Rational::HALF),
            expr::mul(self.t(v("Λ")), v("z")),
            self.t(expr::product([v("A"), v("Q"), v("gU")])),
            self.at("Λ1", 1),
            self.t(self.at("Λ1", -1)),
            inverse(v("Q")),
            self.t(inverse(v("Q"))),
            inverse(self.t(v("Q"))),
            inverse(expr::add(v("A"), v("J"))),
            self.t(inverse(expr::add(v("A"), v("J")))),
            expr::trace(expr::mul(v("C0"), minus_id())),
            expr::det(v("Q")),
            expr::adjugate(&self.symbols, &v("A")),
            expr::dot(
                expr::mul(minus_id(), v("d1")),
                expr::product([v("A"), minus_id(), v("d1")]),
            ),
            expr::product([
                v("c"),
                expr::dot(v("gU"), v("z")),
                expr::dot(v("Γ"), v("z")),
            ]),
            expr::product([v("c"), expr::cross(v("gU"), expr::mul(v("J"), v("Γ")))]),
            expr::cross(expr::cross(v("gU"), v("Γ")), v("z")),
            expr::dot(v("z"), expr::cross(v("gU"), v("Γ"))),
            expr::neg(expr::cross(v("gU"), v("Γ"))),
            expr::neg(expr::mul(expr::add(v("A"), v("J")), v("A"))),
            self.t(expr::cross(v("gU"), v("Γ"))),
            expr::hat(v("Γ")),
            expr::hat(v("gU")),
            expr::hat(expr::mul(self.t(v("Λ")), v("z"))),
            expr::vee(expr::mul(v("A"), v("J"))),
            expr::part(Part::Symmetric, expr::mul(v("A"), v("J"))),
            expr::part(Part::Skew, v("A")),
            expr::part(Part::Diagonal, v("A")),
            expr::call(Function::Exp, scalars()),
            expr::call(Function::Log, expr::det(v("Q"))),
            expr::sum(
                Function::ALL.map(|f| expr::call(f, scalars())),
                scalars().shape(),
            ),
            expr::call(Function::Abs, v("c")),
            expr::diagonal(v("gU")),
            expr::dot(v("gU"), expr::unit(THREE, 1)),
            expr::dot(
                expr::mul(v("A"), expr::unit(THREE, 0)),
                expr::unit(THREE, 2),
            ),
            expr::dot(
                expr::product([v("q"), v("G"), expr::unit(Dim::Fixed(4), 3)]),
                expr::unit(Dim::Fixed(4), 1),
            ),
            expr::dot(
                expr::product([v("G"), expr::inclusion(Dim::Fixed(4), THREE, 0), v("z")]),
                expr::unit(Dim::Fixed(4), 3),
            ),
            expr::product([v("h"), expr::mul(row(), v("gU")), v("A")]),
            expr::product([v("h"), row(), v("gU")]),
            expr::product([row(), v("A"), v("gU"), row(), v("gU")]),
            expr::product([v("z"), row(), v("gU"), row()]),
            expr::mul(self.t(v("Q")), expr::mul(v("C0"), v("Q"))),
            expr::add(expr::mul(v("h"), v("h")), expr::integer(-1)),
            expr::real(v("q")),
            expr::imaginary(expr::mul(v("q"), expr::pure(v("z")))),
            self.t(expr::rotation(&self.symbols, v("q"))),
            expr::mul(v("J"), expr::block(&self.symbols, &v("G"))),
            self.t(expr::block(&self.symbols, &expr::mul(v("G"), v("G")))),
            expr::column(&self.symbols, &v("G")),
            self.t(expr::column(&self.symbols, &inverse(v("G")))),
            expr::twist(expr::mul(expr::inclusion(Dim::Fixed(6), THREE, 3), v("z"))),
            expr::given(&self.symbols, FunctionalId(0), vec![v("Γ")]),
            expr::pull_back(
                &self.symbols,
                Applied {
                    functional: FunctionalId(0),
                    arguments: vec![v("Γ")],
                    along: Vec::new(),
                },
                0,
                v("z"),
            ),
        ]
    }

    /// Formulas of every kind.
    pub fn formulas(&self) -> Vec<Formula> {
        let f = |name: &str| Formula::Expr(self.v(name));
        let b = Box::new;
        let sum = || Formula::Sum(vec![f("M"), f("P")]);
        vec![
            Formula::Expr(self.heavy_top()),
            Formula::name("J^R_{k+1}"),
            Formula::Relation(vec![f("M"), sum(), f("P")], Relation::Equal),
            Formula::minus(f("M"), sum()),
            Formula::neg(sum()),
            Formula::Product(vec![
                sum(),
                Formula::gradient("ℓ", self.letter("Ω", 0)),
                f("Λ"),
            ]),
            Formula::Quotient(b(sum()), b(f("h"))),
            Formula::Power(b(f("c")), Rational::integer(2)),
            Formula::transpose(Formula::gradient("ℓ", self.letter("Ω", 0))),
            Formula::transpose(Formula::Inverse(b(f("Q")))),
            Formula::Inverse(b(Formula::Product(vec![f("Q"), f("A")]))),
            Formula::Dot(b(f("gU")), b(f("Γ"))),
            Formula::Cross(b(f("gU")), b(f("Γ"))),
            Formula::diamond(Formula::gradient("ℓ", self.letter("Γ", 0)), f("Γ")),
            Formula::Bracket(b(Formula::hat(f("gU"))), b(Formula::hat(f("Γ")))),
            Formula::pairing(f("M"), f("ξ")),
            Formula::Ad {
                group: b(f("Λ")),
                argument: b(f("ξ")),
            },
            Formula::ad_star(Formula::Expr(self.at("Ω", -1)), self.at("M", -1)),
            Formula::ad_star(f("Ω"), sum()),
            Formula::lie_ad_star(f("ξ"), f("M")),
            Formula::rate(f("M")),
            Formula::rate(sum()),
            Formula::Matrix(vec![vec![f("A"), f("J")], vec![sum(), f("A")]]),
            Formula::continuous(Formula::Expr(self.at("Ω", -1))),
            Formula::continuous(f("M")),
            Formula::variation(f("Λ")),
            Formula::transpose(Formula::variation(f("Λ"))),
            Formula::Tangent {
                parameter: "ε".to_owned(),
                of: b(Formula::apply(Formula::name("S_d"), vec![f("Λ"), f("Ω")])),
            },
            Formula::operator(Operator::Skew, Formula::Product(vec![f("A"), f("P")])),
            Formula::operator(Operator::Trace, f("A")),
            Formula::operator(Operator::Det, f("A")),
            Formula::operator(Operator::Sym, f("A")),
            Formula::operator(Operator::Diag, f("A")),
            Formula::operator(Operator::Vee, f("A")),
            Formula::operator(Operator::Exp, f("c")),
            Formula::operator(Operator::Log, f("c")),
            Formula::hat(f("gU")),
            Formula::Norm(b(f("Γ"))),
            Formula::SumOver {
                index: "k".to_owned(),
                from: Some("0".to_owned()),
                to: Some("N-1".to_owned()),
                of: b(Formula::name("ℓ_k")),
            },
            Formula::Grouped(b(f("A"))),
            Formula::List(vec![
                Formula::equal(Formula::variation(f("Λ")), f("A")),
                Formula::equal(f("M"), f("P")),
            ]),
            Formula::Sequence(vec![
                Formula::equal(
                    Formula::pairing(f("M"), f("ξ")),
                    Formula::Expr(expr::integer(0)),
                ),
                Formula::text("for all"),
                f("ξ"),
            ]),
            Formula::Relation(
                vec![Formula::equal(f("M"), f("P")), Formula::name("Gamma")],
                Relation::Implies,
            ),
        ]
    }
}

/// The number of a node's kind.
fn kind(node: &Node) -> usize {
    match node {
        Node::Number(_) => 0,
        Node::Letter(_) => 1,
        Node::Identity(_) => 2,
        Node::Zero(_) => 3,
        Node::Unit(..) => 4,
        Node::Sum(_) => 5,
        Node::Neg(_) => 6,
        Node::Product(_) => 7,
        Node::Quotient(..) => 8,
        Node::Power(..) => 9,
        Node::Transpose(_) => 10,
        Node::Inverse(_) => 11,
        Node::Trace(_) => 12,
        Node::Det(_) => 13,
        Node::Dot(..) => 14,
        Node::Cross(..) => 15,
        Node::Hat(_) => 16,
        Node::Vee(_) => 17,
        Node::Part(..) => 18,
        Node::Call(..) => 19,
        Node::Adjugate(_) => 20,
        Node::Inclusion(..) => 21,
        Node::Map(..) => 22,
        Node::Given(_) => 23,
        Node::PullBack(..) => 24,
        Node::Constant(_) => 25,
    }
}

#[test]
fn the_sample_holds_every_kind_of_node() {
    fn walk(e: &Expr, seen: &mut [bool; 26]) {
        seen[kind(e.node())] = true;
        e.children().into_iter().for_each(|c| walk(c, seen));
    }
    let mut seen = [false; 26];
    let sample = Sample::new();
    sample.expressions().iter().for_each(|e| walk(e, &mut seen));
    assert_eq!(seen, [true; 26]);
}
