//! Expressions other than calls.

use super::{Binding, Lower, refuse};
use crate::Refused;
use crate::code::{Arm, Code, Operator, Pattern};
use crate::program::named;
use crate::value::Value;
use clebsch::Real;
use clebsch::domain;
use clebsch::emitted::{Method, Order};
use std::collections::BTreeMap;

impl Lower<'_, '_> {
    /// An expression; `ty` is its type, if it is known.
    pub(super) fn expression(
        &mut self,
        e: &syn::Expr,
        ty: Option<&syn::Type>,
    ) -> Result<Code<f64>, Refused> {
        Ok(match e {
            syn::Expr::Lit(lit) => Code::constant(self.literal(&lit.lit)?),
            syn::Expr::Path(p) => self.path(&p.path)?.ok_or_else(|| refuse(e))?,
            syn::Expr::Paren(p) => self.expression(&p.expr, ty)?,
            syn::Expr::Group(g) => self.expression(&g.expr, ty)?,
            syn::Expr::Reference(r) => self.expression(&r.expr, ty)?,
            syn::Expr::Cast(c) => self.expression(&c.expr, ty)?,
            syn::Expr::Unary(u) => {
                let a = self.expression(&u.expr, ty)?;
                match u.op {
                    syn::UnOp::Deref(_) => a,
                    syn::UnOp::Neg(_) => Code::Negative(Box::new(a)),
                    syn::UnOp::Not(_) => Code::Not(Box::new(a)),
                    _ => return Err(refuse(e)),
                }
            }
            syn::Expr::Binary(b) => self.binary(b)?,
            syn::Expr::Field(f) => self.field(f)?,
            syn::Expr::Index(i) => self.element(e, i)?,
            syn::Expr::Call(c) => self.call(c, ty)?,
            syn::Expr::MethodCall(m) => self.method(m, ty)?,
            // A place in braces is a copy, and only the copy is changed.
            syn::Expr::Block(b) => match self.block(&b.block)? {
                code if super::statement::is_place(&code) => Code::Block(vec![code]),
                code => code,
            },
            syn::Expr::If(i) => self.conditional(i)?,
            syn::Expr::Match(m) => self.matched(m)?,
            syn::Expr::Assign(a) => self.assigned(a)?,
            syn::Expr::Struct(s) => self.made(s)?,
            syn::Expr::Tuple(t) => Code::List(self.all(t.elems.iter())?),
            syn::Expr::Array(a) => self.array(a, ty)?,
            syn::Expr::Repeat(r) => {
                let (value, count) = (self.expression(&r.expr, None)?, self.size(&r.len));
                let count = count.ok_or_else(|| refuse(&r.len))?;
                Code::Repeat(Box::new(value), Box::new(whole(count)))
            }
            syn::Expr::Return(r) => {
                let value = match &r.expr {
                    Some(value) => self.expression(value, None)?,
                    None => Code::constant(Value::Unit),
                };
                Code::Return(Box::new(value))
            }
            syn::Expr::Try(t) => Code::Try(Box::new(self.expression(&t.expr, ty)?)),
            syn::Expr::ForLoop(f) => self.counted(f)?,
            syn::Expr::While(w) => {
                let condition = self.expression(&w.cond, None)?;
                Code::While(Box::new(condition), Box::new(self.block(&w.body)?))
            }
            syn::Expr::Closure(c) => self.closure(c)?,
            syn::Expr::Macro(m) => self.macro_call(m)?,
            other => return Err(refuse(other)),
        })
    }

    /// An element, or a range of elements.
    #[inline(never)]
    fn element(&mut self, e: &syn::Expr, i: &syn::ExprIndex) -> Result<Code<f64>, Refused> {
        if let syn::Expr::Range(_) = &*i.index {
            return self.part(e);
        }
        let base = self.expression(&i.expr, None)?;
        let at = match &*i.index {
            syn::Expr::Tuple(t) => self.all(t.elems.iter())?,
            one => vec![self.expression(one, None)?],
        };
        Ok(Code::Index(Box::new(base), at))
    }

    #[inline(never)]
    fn assigned(&mut self, a: &syn::ExprAssign) -> Result<Code<f64>, Refused> {
        if let Some(all) = self.one_by_one(a)? {
            return Ok(all);
        }
        let value = self.expression(&a.right, None)?;
        let targets = match &*a.left {
            syn::Expr::Tuple(t) => self.all(t.elems.iter())?,
            one => vec![self.expression(one, None)?],
        };
        Ok(Code::Assign(targets, Box::new(value)))
    }

    #[inline(never)]
    fn array(&mut self, a: &syn::ExprArray, ty: Option<&syn::Type>) -> Result<Code<f64>, Refused> {
        let ty = match ty {
            Some(syn::Type::Array(of)) => Some(&*of.elem),
            _ => None,
        };
        let all = a.elems.iter().map(|e| self.expression(e, ty));
        let all: Vec<Code<f64>> = all.collect::<Result<_, _>>()?;
        Ok(match all.is_empty() {
            // An empty array is still a list; an empty tuple is `()`.
            true => Code::constant(Value::List(Vec::new())),
            false => Code::List(all),
        })
    }

    /// Assigns a tuple to a tuple one component at a time, if no assigned place is read.
    #[inline(never)]
    fn one_by_one(&mut self, a: &syn::ExprAssign) -> Result<Option<Code<f64>>, Refused> {
        let (syn::Expr::Tuple(left), syn::Expr::Tuple(right)) = (&*a.left, &*a.right) else {
            return Ok(None);
        };
        let (targets, values) = (self.all(left.elems.iter())?, self.all(right.elems.iter())?);
        let assigned: Vec<Option<usize>> = targets.iter().map(root).collect();
        let apart = |value: &Code<f64>| root(value).is_some_and(|r| !assigned.contains(&Some(r)));
        if targets.len() != values.len() || !values.iter().all(apart) {
            return Ok(None);
        }
        let pairs = targets.into_iter().zip(values);
        let each = pairs.map(|(target, value)| Code::Assign(vec![target], Box::new(value)));
        Ok(Some(Code::Block(each.collect())))
    }

    /// Several expressions.
    pub(super) fn all<'e>(
        &mut self,
        list: impl Iterator<Item = &'e syn::Expr>,
    ) -> Result<Vec<Code<f64>>, Refused> {
        list.map(|e| self.expression(e, None)).collect()
    }

    fn literal(&self, lit: &syn::Lit) -> Result<Value<f64>, Refused> {
        Ok(match lit {
            syn::Lit::Int(n) => Value::Int(n.base10_parse().map_err(|_| refuse(lit))?),
            syn::Lit::Float(x) => Value::Double(x.base10_parse().map_err(|_| refuse(lit))?),
            syn::Lit::Bool(b) => Value::Bool(b.value),
            syn::Lit::Str(s) => Value::Text(crate::text(&s.value())),
            other => return Err(refuse(other)),
        })
    }

    /// The value of a path: a local, a size, or a constant of the runtime.
    #[inline(never)]
    pub(super) fn path(&self, path: &syn::Path) -> Result<Option<Code<f64>>, Refused> {
        let constant = |value| Ok(Some(Code::constant(value)));
        if let Some(name) = path.get_ident() {
            let name = name.to_string();
            if let Some(Binding::Place(code, _)) = self.find(&name) {
                return Ok(Some(code.clone()));
            }
            if let Some(n) = self.shared.sizes.get(&name) {
                return Ok(Some(whole(*n)));
            }
            return match name.as_str() {
                "None" => constant(Value::None),
                _ => Ok(None),
            };
        }
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Ok(Some(Code::constant(match names.as_slice() {
            [.., "Method", name] => {
                let all = Method::ALL.into_iter();
                let found = all.into_iter().find(|m| format!("{m:?}") == *name);
                Value::Method(found.ok_or_else(|| refuse(path))?)
            }
            // The number of threads changes no result.
            [.., "Threads", "ONE"] => Value::Int(1),
            ["T", "EPSILON"] => Value::Double(<f64 as Real>::EPSILON),
            ["f64", "NAN"] => Value::Double(f64::NAN),
            [.., "Order", "Two"] => Value::Order(Order::Two),
            [.., "Domain", "Positive"] => Value::Domain(domain::Domain::Positive),
            [.., "Domain", "NotNegative"] => Value::Domain(domain::Domain::NotNegative),
            [.., "Domain", "NotZero"] => Value::Domain(domain::Domain::NotZero),
            [.., "Function", name] => Value::Function(function(name).ok_or_else(|| refuse(path))?),
            // Sizes are checked when they are chosen, and the scalar is known.
            [.., "ADMITTED" | "PhantomData"] => Value::Unit,
            _ => return Ok(None),
        })))
    }

    /// A loop over the operands, not a recursion: sums over sites have hundreds of terms.
    fn binary(&mut self, b: &syn::ExprBinary) -> Result<Code<f64>, Refused> {
        let mut chain = vec![b];
        let mut first = &*b.left;
        while let syn::Expr::Binary(inner) = first {
            chain.push(inner);
            first = &inner.left;
        }
        let mut value = self.expression(first, None)?;
        for b in chain.into_iter().rev() {
            let right = self.expression(&b.right, None)?;
            value = joined(b, value, right)?;
        }
        Ok(value)
    }

    fn field(&mut self, f: &syn::ExprField) -> Result<Code<f64>, Refused> {
        match &f.member {
            syn::Member::Named(name) => {
                let name = name.to_string();
                let base = self.expression(&f.base, None)?;
                Ok(Code::Field(Box::new(base), self.shared.name(&name)))
            }
            syn::Member::Unnamed(index) => {
                let base = self.expression(&f.base, None)?;
                Ok(match index.index {
                    0 => Code::Inner(Box::new(base)),
                    n => Code::Index(Box::new(base), vec![whole(n as usize)]),
                })
            }
        }
    }

    #[inline(never)]
    fn conditional(&mut self, i: &syn::ExprIf) -> Result<Code<f64>, Refused> {
        let otherwise = match &i.else_branch {
            Some((_, e)) => Some(self.expression(e, None)?),
            None => None,
        };
        let syn::Expr::Let(condition) = &*i.cond else {
            let condition = self.expression(&i.cond, None)?;
            let then = self.block(&i.then_branch)?;
            return Ok(Code::If(
                Box::new(condition),
                Box::new(then),
                otherwise.map(Box::new),
            ));
        };
        let value = self.expression(&condition.expr, None)?;
        self.scopes.push(BTreeMap::new());
        let pattern = self.pattern(&condition.pat, None);
        let then = self.block(&i.then_branch);
        self.scopes.pop();
        let arm = |pattern, body| Arm {
            pattern,
            guard: None,
            body,
        };
        let rest = otherwise.unwrap_or(Code::constant(Value::Unit));
        let arms = vec![arm(pattern?, then?), arm(Pattern::Any, rest)];
        Ok(Code::Match(Box::new(value), arms))
    }

    #[inline(never)]
    fn matched(&mut self, m: &syn::ExprMatch) -> Result<Code<f64>, Refused> {
        let value = self.expression(&m.expr, None)?;
        let mut arms = Vec::new();
        for arm in &m.arms {
            self.scopes.push(BTreeMap::new());
            let made = self.arm(arm);
            self.scopes.pop();
            arms.push(made?);
        }
        Ok(Code::Match(Box::new(value), arms))
    }

    fn arm(&mut self, arm: &syn::Arm) -> Result<Arm<f64>, Refused> {
        let (pat, guard) = match &arm.pat {
            syn::Pat::Guard(guarded) => (&*guarded.pat, Some(&guarded.guard)),
            pat => (pat, None),
        };
        let pattern = self.pattern(pat, None)?;
        let guard = match guard {
            Some(guard) => Some(self.expression(guard, None)?),
            None => None,
        };
        let body = self.expression(&arm.body, None)?;
        Ok(Arm {
            pattern,
            guard,
            body,
        })
    }

    #[inline(never)]
    fn counted(&mut self, f: &syn::ExprForLoop) -> Result<Code<f64>, Refused> {
        let (counts, down) = match &*f.expr {
            syn::Expr::MethodCall(m) if m.method == "rev" => match &*m.receiver {
                syn::Expr::Paren(p) => (&*p.expr, true),
                other => (other, true),
            },
            other => (other, false),
        };
        let syn::Pat::Ident(name) = &*f.pat else {
            return Err(refuse(f));
        };
        let syn::Expr::Range(range) = counts else {
            return self.each(f, &name.ident);
        };
        let (Some(from), Some(to)) = (&range.start, &range.end) else {
            return Err(refuse(f));
        };
        let (from, to) = (self.expression(from, None)?, self.expression(to, None)?);
        self.scopes.push(BTreeMap::new());
        let at = self.fresh();
        self.bind(
            name.ident.to_string(),
            Binding::Place(Code::Place(at), None),
        );
        let body = self.block(&f.body);
        self.scopes.pop();
        let (from, to, body) = (Box::new(from), Box::new(to), Box::new(body?));
        Ok(match down {
            true => Code::Down(at, from, to, body),
            false => Code::For(at, from, to, body),
        })
    }

    /// A loop over the elements of an array.
    fn each(&mut self, f: &syn::ExprForLoop, name: &syn::Ident) -> Result<Code<f64>, Refused> {
        let (list, i, own) = (self.fresh(), self.fresh(), self.fresh());
        let all = self.expression(&f.expr, None)?;
        let length = self.native("len", vec![Code::Place(list)], Vec::new());
        let length = length.ok_or_else(|| refuse(f))?;
        self.scopes.push(BTreeMap::new());
        self.bind(name.to_string(), Binding::Place(Code::Place(own), None));
        let body = self.block(&f.body);
        self.scopes.pop();
        let one = Code::Index(Box::new(Code::Place(list)), vec![Code::Place(i)]);
        let body = Code::Block(vec![
            Code::Let(Pattern::Place(own), Box::new(one), None),
            body?,
        ]);
        let (from, to) = (Box::new(whole(0)), Box::new(length));
        Ok(Code::Block(vec![
            Code::Let(Pattern::Place(list), Box::new(all), None),
            Code::For(i, from, to, Box::new(body)),
        ]))
    }

    /// A closure: its parameters get places of their own.
    #[inline(never)]
    pub(super) fn closure(&mut self, c: &syn::ExprClosure) -> Result<Code<f64>, Refused> {
        self.scopes.push(BTreeMap::new());
        let mut parameters = Vec::new();
        let mut inputs = Vec::new();
        c.inputs
            .iter()
            .for_each(|input| named_parts(input, &mut inputs));
        for input in inputs {
            let at = self.fresh();
            parameters.push(at);
            if let syn::Pat::Ident(name) = input {
                self.bind(
                    name.ident.to_string(),
                    Binding::Place(Code::Place(at), None),
                );
            }
        }
        let body = self.expression(&c.body, None);
        self.scopes.pop();
        Ok(Code::Closure(parameters, Box::new(body?)))
    }

    /// A struct literal.
    #[inline(never)]
    fn made(&mut self, s: &syn::ExprStruct) -> Result<Code<f64>, Refused> {
        if let Some(error) = self.error_of_line(s)? {
            return Ok(error);
        }
        let name = named(&s.path);
        let values: Vec<(String, &syn::Expr)> = s
            .fields
            .iter()
            .filter_map(|f| match &f.member {
                syn::Member::Named(name) => Some((name.to_string(), &f.expr)),
                syn::Member::Unnamed(_) => None,
            })
            .collect();
        let by_name = |field: &str| values.iter().find(|(n, _)| n == field).map(|(_, e)| *e);
        if name == "Call" {
            let all = [by_name("function"), by_name("argument")];
            let all = self.all(all.into_iter().flatten())?;
            let [Code::Constant(function), Code::Constant(argument)] = all.as_slice() else {
                return Err(refuse(s));
            };
            let (Value::Function(function), Value::Text(argument)) = (&**function, &**argument)
            else {
                return Err(refuse(s));
            };
            let (function, argument) = (*function, *argument);
            // Errors contain the name as long as they live.
            let call = Box::leak(Box::new(domain::Call { function, argument }));
            return Ok(Code::constant(Value::Call(call)));
        }
        let name = match name.as_str() {
            "Self" => self.own_type().to_owned(),
            _ => name,
        };
        let layout = self.shared.layout(&name)?;
        let declared = self
            .shared
            .program
            .structs
            .get(&name)
            .cloned()
            .unwrap_or_default();
        let mut given = Vec::new();
        for (field, e) in values {
            let number = self.shared.name(&field);
            let at = layout.fields.iter().position(|f| *f == number);
            let at = at.ok_or_else(|| refuse(s))?;
            let ty = declared.iter().find(|(n, _)| *n == field).map(|(_, ty)| ty);
            given.push((at, self.expression(e, ty)?));
        }
        let base = match &s.rest {
            Some(rest) => Some(Box::new(self.expression(rest, None)?)),
            None => None,
        };
        Ok(Code::Struct(layout, given, base))
    }
}

/// The names in a pattern of a closure, one after the other.
fn named_parts<'a>(input: &'a syn::Pat, out: &mut Vec<&'a syn::Pat>) {
    match input {
        syn::Pat::Type(typed) => named_parts(&typed.pat, out),
        syn::Pat::Reference(inner) => named_parts(&inner.pat, out),
        syn::Pat::Paren(inner) => named_parts(&inner.pat, out),
        syn::Pat::Tuple(all) => all.elems.iter().for_each(|p| named_parts(p, out)),
        other => out.push(other),
    }
}

/// The place that an expression is part of.
fn root(code: &Code<f64>) -> Option<usize> {
    match code {
        Code::Place(at) => Some(*at),
        Code::Field(base, _) => root(base),
        _ => None,
    }
}

/// A count.
pub(super) fn whole(n: usize) -> Code<f64> {
    Code::constant(Value::Int(i64::try_from(n).unwrap_or(i64::MAX)))
}

fn function(name: &str) -> Option<domain::Function> {
    Some(match name {
        "Log" => domain::Function::Log,
        "Sqrt" => domain::Function::Sqrt,
        "Power" => domain::Function::Power,
        "Quotient" => domain::Function::Quotient,
        "Inverse" => domain::Function::Inverse,
        _ => return None,
    })
}

/// Two operands joined by their operator.
fn joined(b: &syn::ExprBinary, x: Code<f64>, y: Code<f64>) -> Result<Code<f64>, Refused> {
    use syn::BinOp;
    let operator = match b.op {
        BinOp::Add(_) => Operator::Add,
        BinOp::Sub(_) => Operator::Sub,
        BinOp::Mul(_) => Operator::Mul,
        BinOp::Div(_) => Operator::Div,
        BinOp::Rem(_) => Operator::Rem,
        BinOp::Eq(_) => Operator::Equal,
        BinOp::Ne(_) => Operator::Differs,
        BinOp::Lt(_) => Operator::Less,
        BinOp::Le(_) => Operator::AtMost,
        BinOp::Gt(_) => Operator::More,
        BinOp::Ge(_) => Operator::AtLeast,
        BinOp::And(_) | BinOp::BitAnd(_) | BinOp::Or(_) | BinOp::BitOr(_) => {
            let settles = matches!(b.op, BinOp::Or(_) | BinOp::BitOr(_));
            return Ok(Code::Lazy(settles, Box::new(x), Box::new(y)));
        }
        BinOp::AddAssign(_) => return Ok(Code::Increase(Box::new(x), Box::new(y))),
        _ => return Err(refuse(b)),
    };
    Ok(Code::Binary(operator, Box::new(x), Box::new(y)))
}
