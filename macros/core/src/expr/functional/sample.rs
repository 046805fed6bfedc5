//! Functionals for tests. Each has an ordinary expression in its own letters, which evaluates it and can replace it.

use super::{Applied, Functional, Kind, Reach, derived, given, pairing};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Function, FunctionalId, Letter, Node, Shift};
use crate::interpret::{Assignment, FunctionalRequest, Matrix, evaluate};

pub(crate) const THREE: Dim = Dim::Fixed(3);

/// A functional and its expression.
pub(crate) struct SampleFunctional {
    pub(crate) id: FunctionalId,
    letters: Vec<SymbolId>,
    body: Expr,
}

/// The functionals `f(x)`, `g(x, y)` of vectors, `k(a)` of a scalar, `r(S)` of a symmetric matrix, `q(A)` with matrix
/// values, and `A(x)` over sites, with their letters added to a table.
pub(crate) struct Sample {
    pub(crate) symbols: Symbols,
    pub(crate) all: Vec<SampleFunctional>,
}

impl Sample {
    pub(crate) fn over(symbols: Symbols) -> Sample {
        let mut s = Sample {
            symbols,
            all: Vec::new(),
        };
        let vector = Kind::of(Shape::vector(THREE));
        let matrix = Kind::of(Shape::square(THREE));
        let number = Kind::of(Shape::SCALAR);
        let symmetric = Kind {
            structure: Structure::Symmetric,
            ..matrix
        };
        let dot = |a: &Expr, b: &Expr| expr::dot(a.clone(), b.clone());
        let along = |a: &Expr, i| expr::dot(a.clone(), expr::unit(THREE, i));
        s.add("f", &[vector], number, &|_, x| {
            let wave = expr::call(Function::Sin, dot(&x[0], &x[0]));
            expr::add(
                wave,
                expr::power(along(&x[0], 0), expr::Rational::integer(3)),
            )
        });
        s.add("g", &[vector, vector], vector, &|_, x| {
            let turned = expr::cross(x[0].clone(), x[1].clone());
            let scaled = expr::mul(dot(&x[0], &x[1]), x[0].clone());
            let waved = expr::mul(expr::call(Function::Cos, along(&x[0], 1)), x[1].clone());
            expr::sum([turned, scaled, waved], Shape::vector(THREE))
        });
        s.add("k", &[number], number, &|_, x| {
            expr::call(Function::Exp, expr::call(Function::Sin, x[0].clone()))
        });
        s.add("r", &[symmetric], number, &|_, x| {
            let square = expr::trace(expr::mul(x[0].clone(), x[0].clone()));
            let cubed = expr::trace(expr::product([x[0].clone(), x[0].clone(), x[0].clone()]));
            expr::add(expr::call(Function::Cos, square), cubed)
        });
        s.add("q", &[matrix], matrix, &|s, x| {
            let square = expr::mul(x[0].clone(), x[0].clone());
            let length = expr::trace(expr::mul(expr::transpose(s, x[0].clone()), x[0].clone()));
            expr::add(square, expr::mul(length, x[0].clone()))
        });
        s.add("A", &[vector], number, &|_, x| along(&x[0], 2));
        let sites = Functional {
            reach: Reach::Sites,
            name: "area".to_owned(),
            ..s.symbols.functional(s.all[5].id).clone()
        };
        s.all[5].id = s.symbols.add_functional(sites);
        s
    }

    fn add(
        &mut self,
        name: &str,
        arguments: &[Kind],
        value: Kind,
        body: &dyn Fn(&Symbols, &[Expr]) -> Expr,
    ) {
        let s = &mut self.symbols;
        let id = s.add_functional(Functional {
            name: name.to_owned(),
            arguments: arguments.to_vec(),
            value,
            reach: Reach::Point,
            path: String::new(),
            typeset: None,
        });
        let letters = arguments.iter().map(|kind| {
            let name = s.fresh_name(&format!("{name}1"));
            s.add(&name, kind.shape, kind.structure, Role::Parameter)
        });
        let letters: Vec<SymbolId> = letters.collect();
        let own: Vec<Expr> = letters.iter().map(|l| expr::here(s, *l)).collect();
        let body = body(s, &own);
        self.all.push(SampleFunctional { id, letters, body });
    }

    pub(crate) fn id(&self, name: &str) -> FunctionalId {
        let found = self
            .all
            .iter()
            .find(|k| self.symbols.functional(k.id).name == name);
        found.unwrap().id
    }

    pub(crate) fn of(&self, name: &str, arguments: &[&Expr]) -> Expr {
        let arguments = arguments.iter().map(|x| (*x).clone()).collect();
        given(&self.symbols, self.id(name), arguments)
    }

    /// A functional at arguments, along directions.
    pub(crate) fn along(&self, name: &str, arguments: &[&Expr], along: &[(u8, &Expr)]) -> Applied {
        Applied {
            functional: self.id(name),
            arguments: arguments.iter().map(|x| (*x).clone()).collect(),
            along: along.iter().map(|(i, x)| (*i, (*x).clone())).collect(),
        }
    }

    /// The pull-back of a seed.
    pub(crate) fn back(&self, name: &str, arguments: &[&Expr], which: u8, seed: &Expr) -> Expr {
        let a = self.along(name, arguments, &[]);
        expr::pull_back(&self.symbols, a, which, seed.clone())
    }

    /// The expression with every value of a functional replaced by its expression; derivatives are unchanged.
    pub(crate) fn opened(&self, e: &Expr) -> Expr {
        let s = &self.symbols;
        let e = expr::rebuild(s, e, &mut |x| self.opened(x));
        let Node::Given(a) = e.node() else { return e };
        assert!(a.along.is_empty());
        let known = self.all.iter().find(|k| k.id == a.functional).unwrap();
        let letters = known.letters.iter().map(|l| at(*l));
        let replaced: Vec<_> = letters.zip(a.arguments.iter().cloned()).collect();
        expr::substitute(s, &known.body, &replaced)
    }

    /// Defines every functional in `values`.
    pub(crate) fn define(&self, values: &mut Assignment) {
        for known in &self.all {
            let name = &self.symbols.functional(known.id).name;
            let (s, letters, body) = (
                self.symbols.clone(),
                known.letters.clone(),
                known.body.clone(),
            );
            values.define(name, move |asked| answer(&s, &letters, &body, asked));
        }
    }
}

pub(crate) fn at(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

fn answer(
    s: &Symbols,
    letters: &[SymbolId],
    body: &Expr,
    asked: &FunctionalRequest,
) -> Option<Matrix> {
    let mut s = s.clone();
    let mut values = Assignment::new();
    let mut set = |s: &Symbols, id: SymbolId, m: &Matrix| {
        values.set(&s.get(id).name, 0, m.rows, m.cols, &m.data);
    };
    for (l, m) in letters.iter().zip(asked.arguments) {
        set(&s, *l, m);
    }
    let shape = |m: &Matrix| Shape {
        rows: Dim::Fixed(m.rows as u32),
        cols: Dim::Fixed(m.cols as u32),
    };
    let mut e = body.clone();
    for (i, m) in asked.along {
        let name = s.fresh_name("direction");
        let id = s.add(&name, shape(m), Structure::General, Role::Parameter);
        set(&s, id, m);
        e = expr::directional(&s, &e, &[(at(letters[*i]), expr::here(&s, id))]);
    }
    if let Some((i, m)) = asked.back {
        let name = s.fresh_name("seed");
        let id = s.add(&name, shape(m), Structure::General, Role::Parameter);
        set(&s, id, m);
        let number = pairing(&s, expr::here(&s, id), e);
        e = expr::gradient(&s, &number, at(letters[i]));
    }
    evaluate(&s, &e, &values).ok()
}

#[test]
fn what_is_answered_is_what_is_opened() {
    let mut s = Symbols::default();
    let x = s.add(
        "X",
        Shape::vector(THREE),
        Structure::General,
        Role::Parameter,
    );
    let s = Sample::over(s);
    let mut values = Assignment::new();
    s.define(&mut values);
    values.set("X", 0, 3, 1, &[0.3, -0.2, 0.7]);
    let e = s.of("f", &[&expr::here(&s.symbols, x)]);
    let [a, b] = [&e, &s.opened(&e)].map(|e| evaluate(&s.symbols, e, &values).unwrap().data[0]);
    assert!((a - b).abs() < 1e-15 && a.abs() > 0.1, "{a} {b}");
    // Without a function, evaluation fails.
    assert!(evaluate(&s.symbols, &e, &Assignment::new()).is_err());
    let along = derived(&s.symbols, s.along("f", &[&expr::here(&s.symbols, x)], &[]));
    assert_eq!(along, e);
}
