//! Parts of the steppers of models with labels other than expressions: loops over sites, parts of lists, end
//! conditions.

use super::expression::whole;
use super::statement::is_place;
use super::{Binding, Lower, refuse};
use crate::Refused;
use crate::code::{Arm, Code, Kind, Pattern, Slice, Sweep, Terms};
use crate::program::named;
use crate::recorded::SiteFunction;
use crate::value::Value;
use std::collections::BTreeMap;
use std::sync::Arc;
use syn::parse::Parser;

impl Lower<'_, '_> {
    /// A list of sites, or a part of it.
    fn slice(&mut self, e: &syn::Expr) -> Result<Slice<f64>, Refused> {
        let inner = past_references(e);
        let part = match inner {
            syn::Expr::Index(i) => range(&i.index).map(|r| (&*i.expr, r)),
            syn::Expr::MethodCall(m) if m.method == "part" => {
                let own = m.args.first().and_then(range);
                own.map(|r| (&*m.receiver, r))
            }
            _ => None,
        };
        let (list, from, to) = match part {
            Some((list, r)) => {
                let [from, to] = self.bounds(r)?;
                (list, from, to)
            }
            None => (inner, None, None),
        };
        let list = self.expression(list, None)?;
        match is_place(&list) {
            true => Ok(Slice { list, from, to }),
            false => Err(refuse(e)),
        }
    }

    /// The two ends of a range, if they are given.
    fn bounds(&mut self, r: &syn::ExprRange) -> Result<[Option<Code<f64>>; 2], Refused> {
        let mut end = |e: &Option<Box<syn::Expr>>| match e {
            Some(e) => self.expression(e, None).map(Some),
            None => Ok(None),
        };
        Ok([end(&r.start)?, end(&r.end)?])
    }

    /// A part of a list as a value.
    #[inline(never)]
    pub(super) fn part(&mut self, e: &syn::Expr) -> Result<Code<f64>, Refused> {
        let slice = self.slice(e)?;
        self.special("slice", ends(slice), e)
    }

    fn special(
        &self,
        name: &str,
        arguments: Vec<Code<f64>>,
        e: &impl quote::ToTokens,
    ) -> Result<Code<f64>, Refused> {
        let special = crate::library::special(name).ok_or_else(|| refuse(e))?;
        Ok(Code::Special(special, arguments, name.into()))
    }

    /// A loop over sites of the runtime, if a call is one.
    #[inline(never)]
    pub(super) fn sweep(
        &mut self,
        name: &str,
        c: &syn::ExprCall,
    ) -> Result<Option<Code<f64>>, Refused> {
        let list: Vec<&syn::Expr> = c.args.iter().collect();
        let (kind, out, range, body) = match (name, list.as_slice()) {
            // Lanes do not change the result, so sites are computed one after the other.
            ("line::fill", [_, out, body]) | ("line::fill_in_lanes", [_, out, body, _]) => {
                (Kind::Fill, vec![self.slice(out)?], None, body)
            }
            ("line::try_fill", [_, out, body]) | ("line::try_fill_in_lanes", [_, out, body, _]) => {
                (Kind::TryFill, vec![self.slice(out)?], None, body)
            }
            ("line::update", [_, out, kept, body])
            | ("line::update_in_lanes", [_, out, kept, body, _]) => {
                let out = vec![self.slice(out)?, self.slice(kept)?];
                (Kind::Update, out, None, body)
            }
            // The interpreter already stores equal bodies only once.
            ("line::once", [_]) => return Ok(Some(Code::constant(Value::Unit))),
            ("line::try_each", [first, last, body]) => {
                let range = [self.expression(first, None)?, self.expression(last, None)?];
                (Kind::TryEach, Vec::new(), Some(range), body)
            }
            (name @ ("line::sum" | "line::total"), [sites, body]) => {
                let range = [whole(0), self.expression(sites, None)?];
                let terms = match name {
                    "line::sum" => Terms::Numbers,
                    _ => Terms::Arrays,
                };
                let kind = match self.shared.by_size {
                    true => Kind::Sizes(terms),
                    false => Kind::Sum(terms),
                };
                (kind, Vec::new(), Some(range), body)
            }
            _ => return Ok(None),
        };
        let Code::Closure(parameters, body) = self.argument(body)? else {
            return Err(refuse(c));
        };
        Ok(Some(Code::Iterate(Arc::new(Sweep {
            kind,
            out,
            range,
            sites: SiteFunction::new(parameters, *body),
        }))))
    }

    /// A call of a closure that is bound to a name.
    #[inline(never)]
    pub(super) fn called_back(
        &mut self,
        name: &str,
        c: &syn::ExprCall,
    ) -> Result<Option<Code<f64>>, Refused> {
        let Some(Binding::Closure(closure)) = self.find(name) else {
            return Ok(None);
        };
        let closure = closure.clone();
        let arguments = self.all(c.args.iter())?;
        let Code::Closure(parameters, body) = self.closure(&closure)? else {
            return Err(refuse(c));
        };
        let given = parameters.into_iter().zip(arguments);
        let mut all: Vec<Code<f64>> = given
            .map(|(at, value)| Code::Let(Pattern::Place(at), Box::new(value), None))
            .collect();
        all.push(Code::Function(body));
        Ok(Some(Code::Block(all)))
    }

    /// Methods of lists, and methods that change a part of a value.
    #[inline(never)]
    pub(super) fn method_of_list(
        &mut self,
        m: &syn::ExprMethodCall,
    ) -> Result<Option<Code<f64>>, Refused> {
        let arguments: Vec<&syn::Expr> = m.args.iter().collect();
        Ok(Some(
            match (m.method.to_string().as_str(), arguments.as_slice()) {
                ("at", [site]) => {
                    let list = self.expression(&m.receiver, None)?;
                    let site = self.expression(site, None)?;
                    Code::Index(Box::new(list), vec![site])
                }
                ("set", [site, value]) => {
                    let list = self.expression(&m.receiver, None)?;
                    let site = self.expression(site, None)?;
                    let value = self.expression(value, None)?;
                    let place = Code::Index(Box::new(list), vec![site]);
                    Code::Assign(vec![place], Box::new(value))
                }
                ("take", [count]) => {
                    let syn::Expr::MethodCall(all) = &*m.receiver else {
                        return Ok(None);
                    };
                    let list = self.expression(&all.receiver, None)?;
                    let count = self.expression(count, None)?;
                    let all = vec![list, Code::constant(Value::None), count];
                    self.special("slice", all, m)?
                }
                ("keep", [sites, other]) => {
                    let [from, to] = self.bounds(range(sites).ok_or_else(|| refuse(m))?)?;
                    let list = self.expression(&m.receiver, None)?;
                    let other = self.expression(other, None)?;
                    let other = Slice {
                        list: other,
                        from: from.clone(),
                        to: to.clone(),
                    };
                    let mut all = ends(Slice { list, from, to });
                    all.push(self.special("slice", ends(other), m)?);
                    self.special("copy_slice", all, m)?
                }
                ("copy_from_slice", [other]) => {
                    let mut all = ends(self.slice(&m.receiver)?);
                    all.push(self.expression(other, None)?);
                    self.special("copy_slice", all, m)?
                }
                ("fill", [value]) => {
                    let mut all = ends(self.slice(&m.receiver)?);
                    all.push(self.expression(value, None)?);
                    self.special("fill_slice", all, m)?
                }
                ("copy_from", [block]) => {
                    let syn::Expr::MethodCall(view) = &*m.receiver else {
                        return Ok(None);
                    };
                    if view.method != "fixed_view_mut" {
                        return Ok(None);
                    }
                    let mut all = vec![self.expression(&view.receiver, None)?];
                    all.extend(self.all(view.args.iter())?);
                    all.push(self.expression(block, None)?);
                    self.special("put_block", all, m)?
                }
                _ => return Ok(None),
            },
        ))
    }

    /// `matches!(value, pattern)` and `vec![value; count]`.
    #[inline(never)]
    pub(super) fn macro_call(&mut self, m: &syn::ExprMacro) -> Result<Code<f64>, Refused> {
        let tokens = m.mac.tokens.clone();
        match named(&m.mac.path).as_str() {
            "matches" => {
                let read = |input: syn::parse::ParseStream<'_>| {
                    let value: syn::Expr = input.parse()?;
                    let _: syn::Token![,] = input.parse()?;
                    let pattern = syn::Pat::parse_multi_with_leading_vert(input)?;
                    let _: Option<syn::Token![,]> = input.parse()?;
                    Ok((value, pattern))
                };
                let (value, pattern) = read.parse2(tokens).map_err(|_| refuse(m))?;
                let value = self.expression(&value, None)?;
                self.scopes.push(BTreeMap::new());
                let pattern = self.pattern(&pattern, None);
                self.scopes.pop();
                let arm = |pattern, met| Arm {
                    pattern,
                    guard: None,
                    body: Code::constant(Value::Bool(met)),
                };
                let arms = vec![arm(pattern?, true), arm(Pattern::Any, false)];
                Ok(Code::Match(Box::new(value), arms))
            }
            "vec" => {
                let read = |input: syn::parse::ParseStream<'_>| {
                    let value: syn::Expr = input.parse()?;
                    let _: syn::Token![;] = input.parse()?;
                    let count: syn::Expr = input.parse()?;
                    Ok((value, count))
                };
                let (value, count) = read.parse2(tokens).map_err(|_| refuse(m))?;
                let all = self.all([&value, &count].into_iter())?;
                self.native("filled", all, Vec::new())
                    .ok_or_else(|| refuse(m))
            }
            _ => Err(refuse(m)),
        }
    }

    /// The errors of a chain that are struct literals, and the struct that names a site.
    pub(super) fn error_of_line(
        &mut self,
        s: &syn::ExprStruct,
    ) -> Result<Option<Code<f64>>, Refused> {
        let names: Vec<String> = s
            .path
            .segments
            .iter()
            .map(|p| p.ident.to_string())
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let (name, order): (&str, &[&str]) = match names.as_slice() {
            [.., "Place"] => ("Place", &["quantity", "site"]),
            [.., "LineError", "Site"] => ("LineError::Site", &["at", "error"]),
            [.., "mesh", "Setting"] => ("Setting", &["domain", "grid", "particles"]),
            [.., "LineError", "Functional"] => (
                "LineError::Functional",
                &["node", "quantity", "cause", "works"],
            ),
            [.., "LineError", "Step"] => ("LineError::Step", &["node", "at", "cause", "works"]),
            _ => return Ok(None),
        };
        let mut all = Vec::new();
        for wanted in order {
            let field = s.fields.iter().find(|f| match &f.member {
                syn::Member::Named(name) => name == wanted,
                syn::Member::Unnamed(_) => false,
            });
            all.push(self.expression(&field.ok_or_else(|| refuse(s))?.expr, None)?);
        }
        self.native(name, all, Vec::new())
            .map(Some)
            .ok_or_else(|| refuse(s))
    }

    /// The pattern of a variant of an enum of the model.
    pub(super) fn variant(
        &mut self,
        path: &syn::Path,
        fields: &[&syn::FieldPat],
    ) -> Result<Option<Pattern<f64>>, Refused> {
        let Some(name) = self.variant_name(path) else {
            return Ok(None);
        };
        let mut all = Vec::new();
        for field in fields {
            let syn::Member::Named(member) = &field.member else {
                return Err(refuse(path));
            };
            let number = self.shared.name(&member.to_string());
            all.push((number, self.pattern(&field.pat, None)?));
        }
        Ok(Some(Pattern::Variant(name.into(), all)))
    }

    fn variant_name(&self, path: &syn::Path) -> Option<String> {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let [.., owner, name] = names.as_slice() else {
            return None;
        };
        let full = format!("{owner}::{name}");
        self.shared
            .program
            .structs
            .contains_key(&full)
            .then_some(full)
    }
}

/// The list of a slice, and its two ends as values.
fn ends(slice: Slice<f64>) -> Vec<Code<f64>> {
    let end = |e: Option<Code<f64>>| e.unwrap_or(Code::constant(Value::None));
    vec![slice.list, end(slice.from), end(slice.to)]
}

fn range(e: &syn::Expr) -> Option<&syn::ExprRange> {
    match e {
        syn::Expr::Range(r) => Some(r),
        _ => None,
    }
}

fn past_references(e: &syn::Expr) -> &syn::Expr {
    match e {
        syn::Expr::Reference(r) => past_references(&r.expr),
        syn::Expr::Paren(p) => past_references(&p.expr),
        other => other,
    }
}
