//! Builds the card of a model from its emitted constant.

use crate::lower::constant;
use crate::program::{Program, named};
use crate::{Refused, text};
use clebsch::card::{Card, Dimension, Field, Invariant, Kind, Open, OpenError};
use clebsch::solvers::Method;
use std::collections::BTreeMap;

/// The constants of a type in the emitted program, such as `CARD`.
pub struct Constants<'a> {
    program: &'a Program,
    ty: &'a str,
    sizes: &'a BTreeMap<String, usize>,
}

/// A placeholder until the card receives its function.
const NOTHING: Open = &|_, _, _| Err(OpenError::Solver { offered: &[] });

type Fields<'a> = BTreeMap<String, &'a syn::Expr>;

impl<'a> Constants<'a> {
    /// The constants of a type at these sizes.
    pub fn new(program: &'a Program, ty: &'a str, sizes: &'a BTreeMap<String, usize>) -> Self {
        Constants { program, ty, sizes }
    }

    fn own(&self, name: &str) -> Option<&'a syn::Expr> {
        let key = (self.ty.to_owned(), name.to_owned());
        self.program.constants.get(&key)
    }

    /// The card, without the function that opens its model.
    pub fn card(&self) -> Result<Card, Refused> {
        let read = || {
            let card = fields(self.own("CARD")?)?;
            let get = |name: &str| card.get(name).copied();
            let plain = Card::plain(NOTHING, &|_| None);
            Some(Card {
                name: self.text(get("name")?)?,
                kebab: self.text(get("kebab")?)?,
                doc: self.text(get("doc")?)?,
                source: self.text(get("source")?)?,
                fingerprint: self.fingerprint(get("fingerprint")?)?,
                summary: self.text(get("summary")?)?,
                solver: self.text(get("solver")?)?,
                order: get("order").map_or(Some(plain.order), |e| self.number(e))?,
                orders: match get("orders") {
                    Some(e) => kept(self.list(e, |c, e| c.number(e))?),
                    None => plain.orders,
                },
                preprocessed: get("preprocessed").map_or(Some(plain.preprocessed), truth)?,
                reversible: get("reversible").map_or(Some(plain.reversible), truth)?,
                parameters: kept(self.list(get("parameters")?, Self::field)?),
                initial: kept(self.list(get("initial")?, Self::field)?),
                observables: kept(self.list(get("observables")?, Self::field)?),
                invariants: kept(self.list(get("invariants")?, Self::invariant)?),
                discrete_energy: self.invariant(get("discrete_energy")?)?,
                solvers: get("solvers").map_or(Some(plain.solvers), |e| self.solvers(e))?,
                dimensions: match get("dimensions") {
                    Some(e) => kept(self.list(e, Self::dimension)?),
                    None => plain.dimensions,
                },
                ..plain
            })
        };
        read().ok_or_else(|| Refused::Construct(format!("{}::CARD", self.ty)))
    }

    /// The sizes of the model, as they are declared.
    pub fn dimensions(&self) -> Option<Vec<Dimension>> {
        let card = fields(self.own("CARD")?)?;
        let Some(dimensions) = card.get("dimensions").copied() else {
            return Some(Vec::new());
        };
        self.list(dimensions, |c, e| {
            let f = fields(e)?;
            let of = |name: &str| constant(f.get(name)?, c.sizes);
            let (from, to) = (of("from")?, of("to")?);
            let name = c.text(f.get("name")?)?;
            Some(Dimension {
                name,
                from,
                to,
                value: from,
            })
        })
    }

    /// The names of the sizes in the emitted code, in the same order.
    pub fn size_names(&self) -> Option<Vec<String>> {
        let card = fields(self.own("CARD")?)?;
        let Some(dimensions) = card.get("dimensions").copied() else {
            return Some(Vec::new());
        };
        self.list(dimensions, |_, e| match fields(e)?.get("value")? {
            syn::Expr::Path(p) => Some(named(&p.path)),
            _ => None,
        })
    }

    fn text(&self, e: &syn::Expr) -> Option<&'static str> {
        match e {
            syn::Expr::Lit(lit) => match &lit.lit {
                syn::Lit::Str(s) => Some(text(&s.value())),
                _ => None,
            },
            syn::Expr::Path(p) => self.text(self.own(&named(&p.path))?),
            _ => None,
        }
    }

    fn fingerprint(&self, e: &syn::Expr) -> Option<u64> {
        match e {
            syn::Expr::Lit(lit) => match &lit.lit {
                syn::Lit::Int(n) => n.base10_parse().ok(),
                _ => None,
            },
            syn::Expr::Path(p) => self.fingerprint(self.own(&named(&p.path))?),
            _ => None,
        }
    }

    fn count(&self, e: &syn::Expr) -> Option<usize> {
        match e {
            syn::Expr::Call(call) if is_named(&call.func, "even_count") => {
                let n = self.count(call.args.first()?)?;
                Some(clebsch::emitted::even_count(n))
            }
            other => constant(other, self.sizes),
        }
    }

    fn number(&self, e: &syn::Expr) -> Option<u32> {
        u32::try_from(self.count(e)?).ok()
    }

    fn list<V>(
        &self,
        e: &syn::Expr,
        one: impl Fn(&Self, &syn::Expr) -> Option<V>,
    ) -> Option<Vec<V>> {
        match e {
            syn::Expr::Reference(r) => self.list(&r.expr, one),
            syn::Expr::Array(a) => a.elems.iter().map(|e| one(self, e)).collect(),
            _ => None,
        }
    }

    /// `Kind::X.field(name, [rows, cols], doc)`, or `spelt` with the ASCII name if it differs.
    fn field(&self, e: &syn::Expr) -> Option<Field> {
        let syn::Expr::MethodCall(call) = e else {
            return None;
        };
        let mut arguments = call.args.iter();
        let name = self.text(arguments.next()?)?;
        let ascii = match call.method == "spelt" {
            true => self.text(arguments.next()?)?,
            false => name,
        };
        let size = self.list(arguments.next()?, Self::count)?;
        let doc = self.text(arguments.next()?)?;
        let size = <[usize; 2]>::try_from(size).ok()?;
        Some(kind(&call.receiver)?.spelt(name, ascii, size, doc))
    }

    /// `Invariant::exact(name, formula, rows)`, or `bounded`.
    fn invariant(&self, e: &syn::Expr) -> Option<Invariant> {
        let syn::Expr::Call(call) = e else {
            return None;
        };
        let [name, formula, rows] = &call.args.iter().collect::<Vec<_>>()[..] else {
            return None;
        };
        let (name, formula) = (self.text(name)?, self.text(formula)?);
        let rows = self.count(rows)?;
        Some(match is_named(&call.func, "exact") {
            true => Invariant::exact(name, formula, rows),
            false => Invariant::bounded(name, formula, rows),
        })
    }

    fn dimension(&self, e: &syn::Expr) -> Option<Dimension> {
        let f = fields(e)?;
        Some(Dimension {
            name: self.text(f.get("name")?)?,
            from: self.count(f.get("from")?)?,
            to: self.count(f.get("to")?)?,
            value: self.count(f.get("value")?)?,
        })
    }

    fn solvers(&self, e: &syn::Expr) -> Option<&'static [&'static str]> {
        match e {
            syn::Expr::Reference(r) => self.solvers(&r.expr),
            syn::Expr::Array(a) if a.elems.is_empty() => Some(&[]),
            syn::Expr::Path(p) => match named(&p.path).as_str() {
                "NAMES" => Some(&Method::NAMES),
                "DAVENPORT_FIRST" => Some(&Method::DAVENPORT_FIRST),
                "ANY_SIZE" => Some(&Method::ANY_SIZE),
                _ => None,
            },
            // By the size.
            syn::Expr::If(i) => {
                let syn::Expr::Binary(b) = &*i.cond else {
                    return None;
                };
                let equal = self.count(&b.left)? == self.count(&b.right)?;
                let chosen = match equal {
                    true => match i.then_branch.stmts.as_slice() {
                        [syn::Stmt::Expr(e, None)] => e,
                        _ => return None,
                    },
                    false => &*i.else_branch.as_ref()?.1,
                };
                self.solvers(chosen)
            }
            syn::Expr::Block(b) => match b.block.stmts.as_slice() {
                [syn::Stmt::Expr(e, None)] => self.solvers(e),
                _ => None,
            },
            _ => None,
        }
    }
}

fn fields(e: &syn::Expr) -> Option<Fields<'_>> {
    let syn::Expr::Struct(s) = e else {
        return None;
    };
    let all = s.fields.iter().filter_map(|f| match &f.member {
        syn::Member::Named(name) => Some((name.to_string(), &f.expr)),
        syn::Member::Unnamed(_) => None,
    });
    Some(all.collect())
}

fn truth(e: &syn::Expr) -> Option<bool> {
    match e {
        syn::Expr::Lit(lit) => match &lit.lit {
            syn::Lit::Bool(b) => Some(b.value),
            _ => None,
        },
        _ => None,
    }
}

fn is_named(e: &syn::Expr, name: &str) -> bool {
    matches!(e, syn::Expr::Path(p) if named(&p.path) == name)
}

fn kind(e: &syn::Expr) -> Option<Kind> {
    let syn::Expr::Path(p) = e else {
        return None;
    };
    Some(match named(&p.path).as_str() {
        "Scalar" => Kind::Scalar,
        "Vector" => Kind::Vector,
        "Symmetric" => Kind::Symmetric,
        "SecondMoments" => Kind::SecondMoments,
        "Skew" => Kind::Skew,
        "Diagonal" => Kind::Diagonal,
        "Matrix" => Kind::Matrix,
        "Rotation" => Kind::Rotation,
        "UnitQuaternion" => Kind::UnitQuaternion,
        "RigidMotion" => Kind::RigidMotion,
        "BodyMomentum" => Kind::BodyMomentum,
        "SpatialMomentum" => Kind::SpatialMomentum,
        "FieldMomentum" => Kind::FieldMomentum,
        _ => return None,
    })
}

/// A list that lives as long as the process, see [`text`].
fn kept<V>(list: Vec<V>) -> &'static [V] {
    Box::leak(list.into_boxed_slice())
}
