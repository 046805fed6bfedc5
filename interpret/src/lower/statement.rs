//! Blocks, bindings and patterns.

use super::{Binding, Lower, refuse};
use crate::Refused;
use crate::code::{Code, Pattern};
use crate::program::named;
use crate::value::Value;
use std::collections::BTreeMap;

impl Lower<'_, '_> {
    /// The body of a function; the return type gives the shape of the value.
    pub(super) fn body(&mut self, function: &syn::ImplItemFn) -> Result<Code<f64>, Refused> {
        match &function.sig.output {
            syn::ReturnType::Type(_, ty) => self.block_of(&function.block, Some(ty)),
            syn::ReturnType::Default => self.block(&function.block),
        }
    }

    /// A block, with a scope of its own.
    pub(super) fn block(&mut self, block: &syn::Block) -> Result<Code<f64>, Refused> {
        self.block_of(block, None)
    }

    fn block_of(
        &mut self,
        block: &syn::Block,
        ty: Option<&syn::Type>,
    ) -> Result<Code<f64>, Refused> {
        self.scopes.push(BTreeMap::new());
        let all = self.statements_of(&block.stmts, ty);
        self.scopes.pop();
        let mut all = all?;
        Ok(match all.len() {
            1 => all.remove(0),
            _ => Code::Block(all),
        })
    }

    pub(super) fn statements(&mut self, list: &[syn::Stmt]) -> Result<Vec<Code<f64>>, Refused> {
        self.statements_of(list, None)
    }

    /// Statements, the last of which has a value of this type.
    fn statements_of(
        &mut self,
        list: &[syn::Stmt],
        ty: Option<&syn::Type>,
    ) -> Result<Vec<Code<f64>>, Refused> {
        let mut out = Vec::new();
        let mut skipped = false;
        for (i, statement) in list.iter().enumerate() {
            if std::mem::take(&mut skipped) {
                continue;
            }
            if let Some(looped) = super::newton::looped(statement, list.get(i + 1)) {
                out.push(self.solved(&looped)?);
                skipped = true;
                continue;
            }
            match statement {
                syn::Stmt::Local(local) => self.local(local, &mut out)?,
                // The scalar type parameter of a block.
                syn::Stmt::Item(_) => {}
                syn::Stmt::Expr(e, semicolon) => {
                    let last = semicolon.is_none() && i + 1 == list.len();
                    out.push(self.expression(e, ty.filter(|_| last))?);
                    if semicolon.is_some() && i + 1 == list.len() {
                        out.push(Code::constant(Value::Unit));
                    }
                }
                other => return Err(refuse(other)),
            }
        }
        if matches!(list.last(), Some(syn::Stmt::Local(_))) {
            out.push(Code::constant(Value::Unit));
        }
        self.filled_once(&mut out);
        Ok(out)
    }

    /// If a loop fills a list from the model alone, the list is filled once.
    #[inline(never)]
    fn filled_once(&mut self, list: &mut Vec<Code<f64>>) {
        for i in 0..list.len() {
            let Some(Code::Let(Pattern::Place(at), value, None)) = list.get(i) else {
                continue;
            };
            let (at, mut own) = (*at, vec![*at]);
            if !self.is_steady(value, &mut own) {
                continue;
            }
            let loops = list.iter().skip(i + 1);
            let loops = loops.take_while(|c| matches!(c, Code::For(..)));
            let count = loops.take_while(|c| self.is_steady(c, &mut own)).count();
            if count == 0 {
                continue;
            }
            self.steady.push(at);
            let mut all: Vec<Code<f64>> = list.drain(i..=i + count).collect();
            all.push(Code::constant(Value::Bool(true)));
            let made = Code::Once(self.fresh(), Box::new(Code::Block(all)));
            list.insert(i, made);
        }
    }

    #[inline(never)]
    fn local(&mut self, local: &syn::Local, out: &mut Vec<Code<f64>>) -> Result<(), Refused> {
        let (pat, ty) = match &local.pat {
            syn::Pat::Type(typed) => (&*typed.pat, Some(&*typed.ty)),
            other => (other, None),
        };
        let Some(init) = &local.init else {
            return Err(refuse(local));
        };
        match (pat, &*init.expr) {
            (
                syn::Pat::Wild(_),
                syn::Expr::Path(_) | syn::Expr::Tuple(_) | syn::Expr::Reference(_),
            ) => return Ok(()),
            (syn::Pat::Ident(name), syn::Expr::Closure(closure)) => {
                let binding = Binding::Closure(Box::new(closure.clone()));
                self.bind(name.ident.to_string(), binding);
                return Ok(());
            }
            _ => {}
        }
        if let (syn::Pat::Tuple(names), syn::Expr::Tuple(values)) = (pat, &*init.expr)
            && self.lent(names, values)?
        {
            return Ok(());
        }
        let kind = self.kind(&init.expr);
        let value = self.expression(&init.expr, ty)?;
        if let syn::Pat::Struct(fields) = pat {
            // If the struct is stored in a place, its fields are used there without a copy.
            let base = match is_place(&value) {
                true => value,
                false => {
                    let at = self.fresh();
                    out.push(Code::Let(Pattern::Place(at), Box::new(value), None));
                    Code::Place(at)
                }
            };
            for field in &fields.fields {
                let (syn::Member::Named(member), syn::Pat::Ident(name)) =
                    (&field.member, &*field.pat)
                else {
                    return Err(refuse(pat));
                };
                let number = self.shared.name(&member.to_string());
                let code = Code::Field(Box::new(base.clone()), number);
                self.bind(name.ident.to_string(), Binding::Place(code, None));
            }
            return Ok(());
        }
        if let (syn::Pat::Ident(name), None) = (pat, &init.diverge)
            && name.mutability.is_none()
            && self.is_steady(&value, &mut Vec::new())
        {
            let at = self.fresh();
            self.steady.push(at);
            self.bind(
                name.ident.to_string(),
                Binding::Place(Code::Place(at), kind),
            );
            out.push(Code::Once(at, Box::new(value)));
            return Ok(());
        }
        let otherwise = match &init.diverge {
            Some((_, diverge)) => Some(Box::new(self.expression(diverge, None)?)),
            None => None,
        };
        let pattern = self.pattern(pat, kind)?;
        out.push(Code::Let(pattern, Box::new(value), otherwise));
        Ok(())
    }

    /// `let (a, b) = (&x, &y)`: binds the names without a copy, if every value is stored in a place.
    #[inline(never)]
    fn lent(&mut self, names: &syn::PatTuple, values: &syn::ExprTuple) -> Result<bool, Refused> {
        let mut bound = Vec::new();
        for (name, value) in names.elems.iter().zip(&values.elems) {
            let (syn::Pat::Ident(name), syn::Expr::Reference(lent)) = (name, value) else {
                return Ok(false);
            };
            let code = self.expression(&lent.expr, None)?;
            if !is_place(&code) || name.mutability.is_some() {
                return Ok(false);
            }
            let kind = self.kind(&lent.expr);
            bound.push((name.ident.to_string(), Binding::Place(code, kind)));
        }
        for (name, binding) in bound {
            self.bind(name, binding);
        }
        Ok(names.elems.len() == values.elems.len())
    }

    /// Whether a value depends on the model alone, so that it can be computed once. `own` are the places within the
    /// value.
    pub(super) fn is_steady(&self, code: &Code<f64>, own: &mut Vec<usize>) -> bool {
        match code {
            Code::Constant(_) => true,
            Code::Place(at) => self.steady.contains(at) || own.contains(at),
            Code::Field(a, _) | Code::Inner(a) | Code::Negative(a) => self.is_steady(a, own),
            Code::Binary(_, a, b) => self.is_steady(a, own) && self.is_steady(b, own),
            Code::Index(a, at) => {
                self.is_steady(a, own) && at.iter().all(|c| self.is_steady(c, own))
            }
            Code::Call(_, list, ..) | Code::List(list) => {
                list.iter().all(|c| self.is_steady(c, own))
            }
            // Special functions change only their arguments.
            Code::Special(_, list, _) => list.iter().all(|c| self.is_steady(c, own)),
            Code::Closure(parameters, body) => {
                own.extend(parameters);
                self.is_steady(body, own)
            }
            Code::For(at, from, to, body) | Code::Down(at, from, to, body) => {
                own.push(*at);
                [from, to, body].iter().all(|c| self.is_steady(c, own))
            }
            Code::Block(list) => list.iter().all(|c| match c {
                Code::Let(Pattern::Place(at), value, None) => {
                    own.push(*at);
                    self.is_steady(value, own)
                }
                Code::Once(at, value) => {
                    own.push(*at);
                    self.is_steady(value, own)
                }
                other => self.is_steady(other, own),
            }),
            _ => false,
        }
    }

    /// A pattern; its names are bound in the innermost scope.
    pub(super) fn pattern(
        &mut self,
        pat: &syn::Pat,
        kind: Option<String>,
    ) -> Result<Pattern<f64>, Refused> {
        Ok(match pat {
            syn::Pat::Wild(_) => Pattern::Any,
            syn::Pat::Ident(name) if name.ident == "None" => Pattern::None,
            syn::Pat::Ident(name) => {
                let at = self.fresh();
                self.bind(
                    name.ident.to_string(),
                    Binding::Place(Code::Place(at), kind),
                );
                Pattern::Place(at)
            }
            syn::Pat::Paren(inner) => self.pattern(&inner.pat, kind)?,
            syn::Pat::Reference(inner) => self.pattern(&inner.pat, kind)?,
            syn::Pat::Type(inner) => {
                let kind = self.struct_of(&inner.ty);
                self.pattern(&inner.pat, kind)?
            }
            syn::Pat::Tuple(all) => {
                let all = all.elems.iter().map(|p| self.pattern(p, None));
                Pattern::List(all.collect::<Result<_, _>>()?)
            }
            syn::Pat::TupleStruct(t) => {
                let [inner] = &t.elems.iter().collect::<Vec<_>>()[..] else {
                    return Err(refuse(pat));
                };
                let inner = Box::new(self.pattern(inner, None)?);
                match named(&t.path).as_str() {
                    "Ok" | "Some" => Pattern::Done(inner),
                    "Err" => Pattern::Failed(inner),
                    _ => return Err(refuse(pat)),
                }
            }
            syn::Pat::Path(p) => {
                if let Some(variant) = self.variant(&p.path, &[])? {
                    return Ok(variant);
                }
                match self.path(&p.path)? {
                    Some(Code::Constant(value)) => Pattern::Exactly(value),
                    _ => return Err(refuse(pat)),
                }
            }
            syn::Pat::Struct(s) => {
                let fields: Vec<&syn::FieldPat> = s.fields.iter().collect();
                self.variant(&s.path, &fields)?.ok_or_else(|| refuse(pat))?
            }
            syn::Pat::Or(all) => {
                let all = all.cases.iter().map(|p| self.pattern(p, None));
                Pattern::Or(all.collect::<Result<_, _>>()?)
            }
            syn::Pat::Slice(all) => {
                let all = all.elems.iter().map(|p| self.pattern(p, None));
                Pattern::List(all.collect::<Result<_, _>>()?)
            }
            syn::Pat::Lit(lit) => match self.expression(&syn::Expr::Lit(lit.clone()), None)? {
                Code::Constant(value) => Pattern::Exactly(value),
                _ => return Err(refuse(pat)),
            },
            other => return Err(refuse(other)),
        })
    }
}

/// Whether an expression refers to a place, so that a name can refer to it without a copy.
pub(super) fn is_place(code: &Code<f64>) -> bool {
    match code {
        Code::Place(_) => true,
        Code::Field(base, _) => is_place(base),
        Code::Index(base, at) => {
            is_place(base) && matches!(at.as_slice(), [index] if index.constant_count().is_some())
        }
        _ => false,
    }
}
