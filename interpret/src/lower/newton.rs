//! Reads the loop of Newton's method from emitted code. The operations evaluate the equations at a trial. The
//! runtime's solver does everything else.

use super::{Binding, Lower, Shared, refuse};
use crate::Refused;
use crate::code::{Code, Routine};
use crate::newton::{AtTrial, Kind, SearchValue, Settled, Shape, Solve, Sought};
use crate::program::type_name;
use crate::recorded::Function;
use crate::value::Value;
use clebsch::solvers::newton::Rounded;
use quote::ToTokens;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The emitted code of one search.
pub struct Looped<'e> {
    /// `work.search.begin(node)`.
    pub begin: &'e syn::ExprMethodCall,
    /// The body of the loop.
    pub body: &'e syn::Block,
}

/// The loop in two statements, if these statements are such a loop.
pub fn looped<'e>(first: &'e syn::Stmt, second: Option<&'e syn::Stmt>) -> Option<Looped<'e>> {
    let (syn::Stmt::Local(local), Some(syn::Stmt::Expr(syn::Expr::Loop(all), _))) = (first, second)
    else {
        return None;
    };
    let init = local.init.as_ref()?;
    match &*init.expr {
        syn::Expr::MethodCall(begin) if begin.method == "begin" => Some(Looped {
            begin,
            body: &all.body,
        }),
        _ => None,
    }
}

/// The first call of a method whose name `wanted` accepts, anywhere in an expression.
fn called<'e>(
    e: &'e syn::Expr,
    wanted: &dyn Fn(&syn::Ident) -> bool,
) -> Option<&'e syn::ExprMethodCall> {
    match e {
        syn::Expr::MethodCall(m) if wanted(&m.method) => Some(m),
        syn::Expr::MethodCall(m) => {
            let inner = m.args.iter().find_map(|a| called(a, wanted));
            inner.or_else(|| called(&m.receiver, wanted))
        }
        syn::Expr::Closure(c) => called(&c.body, wanted),
        syn::Expr::Paren(p) => called(&p.expr, wanted),
        syn::Expr::Reference(r) => called(&r.expr, wanted),
        syn::Expr::Try(t) => called(&t.expr, wanted),
        syn::Expr::Binary(b) => called(&b.left, wanted).or_else(|| called(&b.right, wanted)),
        syn::Expr::Let(l) => called(&l.expr, wanted),
        syn::Expr::Call(c) => c.args.iter().find_map(|a| called(a, wanted)),
        syn::Expr::If(i) => called(&i.cond, wanted).or_else(|| in_block(&i.then_branch, wanted)),
        syn::Expr::Block(b) => in_block(&b.block, wanted),
        _ => None,
    }
}

fn in_block<'e>(
    block: &'e syn::Block,
    wanted: &dyn Fn(&syn::Ident) -> bool,
) -> Option<&'e syn::ExprMethodCall> {
    block.stmts.iter().find_map(|s| match s {
        syn::Stmt::Expr(e, _) => called(e, wanted),
        syn::Stmt::Local(l) => called(&l.init.as_ref()?.expr, wanted),
        _ => None,
    })
}

/// The first name in code with this prefix.
fn name_in(tokens: &impl ToTokens, beginning: &str) -> Option<String> {
    fn find(stream: proc_macro2::TokenStream, beginning: &str) -> Option<String> {
        stream.into_iter().find_map(|t| match t {
            proc_macro2::TokenTree::Ident(i) => {
                Some(i.to_string()).filter(|i| i.starts_with(beginning))
            }
            proc_macro2::TokenTree::Group(g) => find(g.stream(), beginning),
            _ => None,
        })
    }
    find(tokens.to_token_stream(), beginning)
}

impl Lower<'_, '_> {
    /// `newton::Search::...()` of a declared type, as a constant.
    #[inline(never)]
    pub(super) fn search(
        &self,
        constructor: &str,
        ty: Option<&syn::Type>,
    ) -> Result<Option<Code<f64>>, Refused> {
        let tries = match constructor {
            "from_rest" => false,
            "to_try" => true,
            _ => return Ok(None),
        };
        let Some(ty) = ty else {
            return Ok(None);
        };
        let sought = self.sought(ty)?;
        let held = SearchValue::begun(sought, tries);
        Ok(Some(Code::constant(Value::Search(held))))
    }

    /// The unknowns of a search, read from its declared type.
    pub(super) fn sought(&self, ty: &syn::Type) -> Result<&'static Sought, Refused> {
        let generics = arguments(ty).ok_or_else(|| refuse(ty))?;
        let [_, elements, whole @ ..] = generics.as_slice() else {
            return Err(refuse(ty));
        };
        let unknowns =
            |what: &str| Refused::Construct(format!("{what} in {}", ty.to_token_stream()));
        let kinds = self.kinds(elements).ok_or_else(|| unknowns("a group"))?;
        let whole = match whole.first() {
            Some(ty) => Some(Shape::new(
                self.kinds(ty).ok_or_else(|| unknowns("a group"))?,
            )),
            None => None,
        };
        let capacity = capacity(ty).ok_or_else(|| unknowns("a size"))?;
        // Searches borrow their shape for as long as they live; a model has only a few.
        Ok(Box::leak(Box::new(Sought {
            shape: Shape::new(kinds),
            whole,
            capacity,
        })))
    }

    /// The groups of a bundle: `[G; n]` or `(G, F)`.
    fn kinds(&self, ty: &syn::Type) -> Option<Vec<Kind>> {
        match ty {
            syn::Type::Array(a) => {
                let count = self.size(&a.len)?;
                Some(vec![self.group(&a.elem)?; count])
            }
            syn::Type::Tuple(t) => t.elems.iter().map(|ty| self.group(ty)).collect(),
            _ => None,
        }
    }

    fn group(&self, ty: &syn::Type) -> Option<Kind> {
        let sizes = self.sizes_of_type(Some(ty));
        Some(match (type_name(ty)?.as_str(), sizes.as_slice()) {
            ("Rotation", _) => Kind::Rotation,
            ("UnitQuaternion", _) => Kind::Quaternion,
            ("RigidMotion", _) => Kind::Motion,
            ("PlaneMotion", _) => Kind::Plane,
            ("Linear", [n]) => Kind::Linear(*n),
            ("Orthogonal", [n]) => Kind::Orthogonal(*n),
            ("Additive", [rows, cols]) => Kind::Field(*rows, *cols),
            _ => return None,
        })
    }
}

/// The types among the generic arguments of a type.
fn arguments(ty: &syn::Type) -> Option<Vec<syn::Type>> {
    let syn::Type::Path(p) = ty else {
        return None;
    };
    let syn::PathArguments::AngleBracketed(list) = &p.path.segments.last()?.arguments else {
        return None;
    };
    let types = list.args.iter().filter_map(|a| match a {
        syn::GenericArgument::Type(ty) => Some(ty.clone()),
        _ => None,
    });
    Some(types.collect())
}

/// The number of coordinates for which a search has space.
fn capacity(ty: &syn::Type) -> Option<usize> {
    let syn::Type::Path(p) = ty else {
        return None;
    };
    let syn::PathArguments::AngleBracketed(list) = &p.path.segments.last()?.arguments else {
        return None;
    };
    list.args.iter().find_map(|a| match a {
        syn::GenericArgument::Const(syn::Expr::Lit(lit)) => match &lit.lit {
            syn::Lit::Int(n) => n.base10_parse().ok(),
            _ => None,
        },
        _ => None,
    })
}

/// A separate function, such as the residual. Its parameters are in the places from 0 on.
fn alone(
    shared: &mut Shared<'_>,
    own_type: &str,
    function: &syn::ImplItemFn,
) -> Result<Routine<f64>, Refused> {
    let name = function.sig.ident.to_string();
    let mut lower = Lower {
        shared,
        scopes: vec![BTreeMap::new()],
        next: function.sig.inputs.len(),
        within: vec![(own_type.to_owned(), name)],
        steady: Vec::new(),
    };
    for (at, parameter) in function.sig.inputs.iter().enumerate() {
        let (name, kind) = lower.parameter(parameter)?;
        lower.bind(name, Binding::Place(Code::Place(at), kind));
    }
    let body = lower.block(&function.block)?;
    Ok(Routine {
        places: lower.next,
        body: Code::Function(Box::new(body)),
    })
}

/// The pattern of an arm and its guard.
fn guard(arm: &syn::Arm) -> Option<&syn::Expr> {
    match &arm.pat {
        syn::Pat::Guard(guarded) => Some(&guarded.guard),
        _ => None,
    }
}

impl<'a> Lower<'a, '_> {
    /// The loop as one operation.
    #[inline(never)]
    pub(super) fn solved(&mut self, of: &Looped) -> Result<Code<f64>, Refused> {
        self.scopes.push(BTreeMap::new());
        let solve = self.solve(of);
        self.scopes.pop();
        Ok(Code::Iterate(Arc::new(solve?)))
    }

    fn solve(&mut self, of: &Looped) -> Result<Solve, Refused> {
        let unknown = || refuse(of.body);
        let search = self.expression(&of.begin.receiver, None)?;
        let node = of.begin.args.first().ok_or_else(unknown)?;
        let node = self.expression(node, None)?;
        let ty = self.field_type(&of.begin.receiver).ok_or_else(unknown)?;
        self.sought(&ty)?;
        let is_scale = |s: &syn::Stmt| matches!(s, syn::Stmt::Expr(syn::Expr::If(_), _));
        let scale = of
            .body
            .stmts
            .iter()
            .position(is_scale)
            .ok_or_else(unknown)?;
        let (before, after) = of.body.stmts.split_at(scale);
        let ([syn::Stmt::Local(first), rest @ ..], [scale, at_trial @ .., assess, ended]) =
            (before, after)
        else {
            return Err(unknown());
        };
        let (
            syn::Pat::Ident(name),
            syn::Stmt::Expr(scale, _),
            syn::Stmt::Expr(syn::Expr::If(assess), _),
            syn::Stmt::Expr(syn::Expr::Match(ended), _),
        ) = (&first.pat, scale, assess, ended)
        else {
            return Err(unknown());
        };
        let mut trial = self.fresh();
        let mut trial_name = name.ident.to_string();
        self.bind(trial_name.clone(), Binding::Place(Code::Place(trial), None));
        let (part, rest_code) = (trial, self.statements(rest)?);
        if let Some(syn::Stmt::Local(whole)) = rest.last() {
            let syn::Pat::Ident(name) = &whole.pat else {
                return Err(unknown());
            };
            trial_name = name.ident.to_string();
            let Some(Binding::Place(Code::Place(at), _)) = self.find(&trial_name) else {
                return Err(unknown());
            };
            trial = *at;
        }
        let starts = |beginning: &'static str| {
            move |name: &syn::Ident| name.to_string().starts_with(beginning)
        };
        let rounding = called(scale, &starts("rounding")).ok_or_else(unknown)?;
        let mut known = vec![self.expression(&syn::parse_quote!(self.parameters), None)?];
        for argument in rounding.args.iter().take(3) {
            known.push(self.expression(argument, None)?);
        }
        let known = <[Code<f64>; 4]>::try_from(known).map_err(|_| unknown())?;
        let at_trial_code = self.statements(at_trial)?;
        let residual = called(&assess.cond, &starts("assess")).ok_or_else(unknown)?;
        let residual = residual.args.first().ok_or_else(unknown)?;
        let residual = self.expression(residual, None)?;
        let tangent = in_block(&assess.then_branch, &starts("set_tangent")).ok_or_else(unknown)?;
        let mut tangent = self.all(tangent.args.iter())?.into_iter();
        let (tangent, unit) = (tangent.next().ok_or_else(unknown)?, tangent.next());
        let syn::Expr::MethodCall(correct) = &*ended.expr else {
            return Err(unknown());
        };
        let [_, solved, otherwise] = ended.arms.as_slice() else {
            return Err(unknown());
        };
        let guard = guard(solved).ok_or_else(unknown)?;
        let convex = match guard {
            syn::Expr::Binary(either) => Some(self.expression(&either.left, None)?),
            _ => None,
        };
        let is_test = |name: &syn::Ident| name == "is_principal" || name == "is_part_of_principal";
        let at_rest = called(guard, &is_test).and_then(|call| call.args.get(1));
        let at_rest = self.expression(at_rest.ok_or_else(unknown)?, None)?;
        let settled = called(&otherwise.body, &starts("settled")).ok_or_else(unknown)?;
        let (settled, principal) = self.settled(settled)?;
        let own = self.own_type().to_owned();
        let program = self.shared.program;
        let function = |beginning: &str, from: &str| {
            let from = program.function(&own, from)?;
            program.function(&own, &name_in(&from.block, beginning)?)
        };
        let residual_at =
            function("residual_at", &rounding.method.to_string()).ok_or_else(unknown)?;
        let completed_at = function("completed_at", &rounding.method.to_string());
        let tangent_at = function("tangent_at", &principal).ok_or_else(unknown)?;
        let residual_at = alone(self.shared, &own, residual_at)?;
        let rounded = |routine: &Routine<f64>| {
            let rounded = routine.map_scalar(Rounded::exactly);
            rounded.ok_or_else(|| refuse(of.body))
        };
        let completed_at = match completed_at.filter(|_| !rest.is_empty()) {
            Some(function) => Some(rounded(&alone(self.shared, &own, function)?)?),
            None => None,
        };
        // The operations at a trial first complete it.
        let of_trial = |last: Code<f64>| {
            let before = rest_code.iter().chain(&at_trial_code).cloned();
            AtTrial {
                place: part,
                body: Code::Block(before.chain([last]).collect()),
            }
        };
        let unit = unit.unwrap_or(Code::constant(Value::Real(1.0)));
        Ok(Solve {
            search,
            node,
            completed_at,
            known,
            residual: of_trial(Code::List(vec![Code::Place(trial), residual])),
            at_rest,
            tangent: of_trial(Code::List(vec![tangent, unit])),
            from_left: correct.method.to_string().ends_with("from_left"),
            convex: convex.map(of_trial),
            settled,
            rounded_at: rounded(&residual_at)?,
            residual_at: Function::new(residual_at),
            tangent_at: Function::new(alone(self.shared, &own, tangent_at)?),
        })
    }

    /// The operations for a solution that is not known to be principal, and the name of the function that searches for
    /// the principal one.
    fn settled(&mut self, call: &syn::ExprMethodCall) -> Result<(Settled, String), Refused> {
        let unknown = || refuse(call);
        let own = self.own_type().to_owned();
        let program = self.shared.program;
        let function = program.function(&own, &call.method.to_string());
        let function = function.ok_or_else(unknown)?;
        let principal = name_in(&function.block, "principal").ok_or_else(unknown)?;
        let refused = name_in(&function.block, "refused").ok_or_else(unknown)?;
        let refused = program.function(&own, &refused).ok_or_else(unknown)?;
        // Its parameters: the receiver, the step, the state, further input, momenta, the iteration, how the iteration
        // ended, and the name of the solver if there is a choice.
        let mut scope = BTreeMap::new();
        let (mut at, tries) = (self.fresh(), self.fresh());
        for (i, parameter) in function.sig.inputs.iter().skip(1).enumerate() {
            let (name, kind) = self.parameter(parameter)?;
            let code = match i {
                0 | 1 | 6 => self.expression(call.args.get(i).ok_or_else(unknown)?, None)?,
                4 => Code::Place(tries),
                _ => continue,
            };
            scope.insert(name, Binding::Place(code, kind));
        }
        scope.insert("failed".to_owned(), Binding::Place(Code::Place(at), None));
        if let Some(binding) = self.find("self") {
            scope.insert("self".to_owned(), binding.clone());
        }
        let outer = std::mem::replace(&mut self.scopes, vec![scope]);
        let contact = self.contact(function);
        let other = self.other(refused);
        self.scopes = outer;
        let contact = contact?.map(|look| (std::mem::take(&mut at), tries, look));
        let (other, configurations) = other?;
        let settled = Settled {
            contact,
            other,
            configurations,
        };
        Ok((settled, principal))
    }

    /// The operations that check whether the motion to a solution leaves the domain.
    fn contact(&mut self, settled: &syn::ImplItemFn) -> Result<Option<Code<f64>>, Refused> {
        for statement in &settled.block.stmts {
            let syn::Stmt::Local(local) = statement else {
                continue;
            };
            let Some(syn::Expr::Match(m)) = local.init.as_ref().map(|i| &*i.expr) else {
                continue;
            };
            let folded = m.arms.iter().find(|a| name_in(&a.pat, "fold").is_some());
            let Some(syn::Expr::Block(b)) = folded.map(|a| &*a.body) else {
                continue;
            };
            let Some((_, looks @ [_, ..])) = b.block.stmts.split_last() else {
                continue;
            };
            let mut all = self.statements(looks)?;
            all.push(Code::constant(Value::Unit));
            return Ok(Some(Code::Function(Box::new(Code::Block(all)))));
        }
        Ok(None)
    }

    /// A step of another size by another search, and the names of the configurations.
    fn other(
        &mut self,
        refused: &syn::ImplItemFn,
    ) -> Result<(Code<f64>, &'static &'static [&'static str]), Refused> {
        let unknown = || refuse(&refused.sig);
        let explained =
            in_block(&refused.block, &|name| name == "explained").ok_or_else(unknown)?;
        let Some(syn::Expr::Closure(closure)) = explained.args.last() else {
            return Err(unknown());
        };
        let other = self.closure(closure)?;
        let names = refused.block.stmts.iter().find_map(|s| match s {
            syn::Stmt::Item(syn::Item::Const(c)) => Some(&*c.expr),
            _ => None,
        });
        let Some(syn::Expr::Reference(names)) = names else {
            return Err(unknown());
        };
        let syn::Expr::Array(names) = &*names.expr else {
            return Err(unknown());
        };
        let names = names.elems.iter().filter_map(|e| match e {
            syn::Expr::Lit(syn::ExprLit {
                lit: syn::Lit::Str(name),
                ..
            }) => Some(crate::text(&name.value())),
            _ => None,
        });
        // Errors borrow the names as long as they live.
        let names: &'static [&'static str] =
            Box::leak(names.collect::<Vec<_>>().into_boxed_slice());
        Ok((other, Box::leak(Box::new(names))))
    }

    /// The declared type of a field such as `work.search`.
    fn field_type(&self, e: &syn::Expr) -> Option<syn::Type> {
        let syn::Expr::Field(f) = e else {
            return None;
        };
        let syn::Member::Named(field) = &f.member else {
            return None;
        };
        let owner = self.kind(&f.base)?;
        let fields = self.shared.program.structs.get(&owner)?;
        let field = field.to_string();
        let (_, ty) = fields.iter().find(|(name, _)| *name == field)?;
        Some(ty.clone())
    }
}
