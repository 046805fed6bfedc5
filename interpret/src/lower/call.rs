//! Calls: of the model's own functions and of the runtime's.

use super::expression::whole;
use super::statement::is_place;
use super::{Binding, Lower, refuse};
use crate::Refused;
use crate::code::{Code, Pattern, Routine};
use crate::program::named;
use crate::value::{Frame, Value};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// The ratio of a circle to its diameter, by the name that the standard library gives it.
fn is_pi(e: &syn::Expr) -> bool {
    let syn::Expr::Path(path) = e else {
        return false;
    };
    path.path.segments.last().is_some_and(|s| s.ident == "PI")
}

impl Lower<'_, '_> {
    /// A function of the runtime, if there is one.
    pub(super) fn native(
        &self,
        name: &str,
        arguments: Vec<Code<f64>>,
        sizes: Vec<usize>,
    ) -> Option<Code<f64>> {
        let native = crate::library::native(name, arguments.len())?;
        Some(Code::Call(native, arguments, sizes, name.into()))
    }

    /// The sizes among generic arguments, without the scalar.
    fn generics(&self, list: Option<&syn::AngleBracketedGenericArguments>) -> Vec<usize> {
        let Some(list) = list else {
            return Vec::new();
        };
        let sizes = list.args.iter().filter_map(|a| match a {
            syn::GenericArgument::Const(e) => self.size(e),
            syn::GenericArgument::Type(syn::Type::Path(p)) => {
                let name = p.path.get_ident()?.to_string();
                self.shared.sizes.get(&name).copied()
            }
            _ => None,
        });
        sizes.collect()
    }

    fn sizes_of(&self, path: &syn::Path) -> Vec<usize> {
        let lists = path.segments.iter().filter_map(|s| match &s.arguments {
            syn::PathArguments::AngleBracketed(list) => Some(list),
            _ => None,
        });
        lists.flat_map(|list| self.generics(Some(list))).collect()
    }

    /// The sizes of a declared matrix.
    pub(super) fn sizes_of_type(&self, ty: Option<&syn::Type>) -> Vec<usize> {
        match ty {
            Some(syn::Type::Path(p)) => self.sizes_of(&p.path),
            _ => Vec::new(),
        }
    }

    /// A closure, given directly or by name.
    pub(super) fn argument(&mut self, e: &syn::Expr) -> Result<Code<f64>, Refused> {
        if let syn::Expr::Path(p) = e
            && let Some(name) = p.path.get_ident()
            && let Some(Binding::Closure(closure)) = self.find(&name.to_string())
        {
            let closure = closure.clone();
            return self.closure(&closure);
        }
        // A function of the runtime by its path.
        if let syn::Expr::Path(p) = e
            && let [.., owner, name] = &p.path.segments.iter().collect::<Vec<_>>()[..]
        {
            let (name, at) = (format!("{}::{}", owner.ident, name.ident), self.fresh());
            if let Some(call) = self.native(&name, vec![Code::Place(at)], Vec::new()) {
                return Ok(Code::Closure(vec![at], Box::new(call)));
            }
        }
        self.expression(e, None)
    }

    pub(super) fn call(
        &mut self,
        c: &syn::ExprCall,
        ty: Option<&syn::Type>,
    ) -> Result<Code<f64>, Refused> {
        let syn::Expr::Path(path) = &*c.func else {
            return Err(refuse(c));
        };
        if let (Some(of), [.., owner, made]) = (
            &path.qself,
            &path.path.segments.iter().collect::<Vec<_>>()[..],
        ) && (owner.ident == "Functional" && made.ident == "new")
        {
            return self.functional(&of.ty, c);
        }
        let path = &path.path;
        let sizes = self.sizes_of(path);
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if let Some(made) = self.made_by_name(c, &names, &sizes, ty)? {
            return Ok(made);
        }
        if let [.., owner, name] = names.as_slice()
            && let Some(sweep) = self.sweep(&format!("{owner}::{name}"), c)?
        {
            return Ok(sweep);
        }
        if let [name] = names.as_slice()
            && let Some(called) = self.called_back(name, c)?
        {
            return Ok(called);
        }
        if let Some(frame) = frame(&named(path)) {
            let [inner] = &self.all(c.args.iter())?[..] else {
                return Err(refuse(c));
            };
            return Ok(Code::Momentum(frame, Box::new(inner.clone())));
        }
        // A function of the model without a receiver.
        if let [owner, name] = names.as_slice() {
            let owner = match *owner {
                "Self" => self.own_type().to_owned(),
                other => other.to_owned(),
            };
            if self.shared.program.function(&owner, name).is_some() {
                return self.written_out(&owner, name, None, c.args.iter());
            }
        }
        let name = match names.as_slice() {
            ["SMatrix" | "SVector", name] => (*name).to_owned(),
            [name] => (*name).to_owned(),
            [.., owner, name] => format!("{owner}::{name}"),
            [] => return Err(refuse(c)),
        };
        self.runtime(&name, c.args.iter(), None, sizes)?
            .ok_or_else(|| refuse(c))
    }

    /// Numbers, matrices and lists made by functions whose names say how.
    #[inline(never)]
    fn made_by_name(
        &mut self,
        c: &syn::ExprCall,
        names: &[&str],
        sizes: &[usize],
        ty: Option<&syn::Type>,
    ) -> Result<Option<Code<f64>>, Refused> {
        let made = match names {
            ["T", "from_f64"] if c.args.iter().any(is_pi) => {
                Some(Code::constant(Value::Real(std::f64::consts::PI)))
            }
            ["T", "from_f64"] => match self.all(c.args.iter())?.pop() {
                Some(Code::Constant(value)) => match *value {
                    Value::Double(x) => Some(Code::constant(Value::Real(x))),
                    other => self.native("from_f64", vec![Code::constant(other)], Vec::new()),
                },
                Some(other) => self.native("from_f64", vec![other], Vec::new()),
                None => None,
            },
            ["T", "from_ratio"] => {
                let arguments = self.all(c.args.iter())?;
                self.native("from_ratio", arguments, Vec::new())
            }
            ["T", "zero"] => Some(Code::constant(Value::Real(0.0))),
            ["T", "one"] => Some(Code::constant(Value::Real(1.0))),
            ["SMatrix" | "SVector", "zeros"] if sizes.is_empty() => {
                let sizes = self.sizes_of_type(ty);
                self.native("zeros", Vec::new(), sizes)
            }
            ["SMatrix" | "SVector", "from_fn"] => {
                let size = |at: usize| whole(sizes.get(at).copied().unwrap_or(1));
                let mut arguments = vec![size(0), size(1)];
                for a in &c.args {
                    arguments.push(self.argument(a)?);
                }
                let special = crate::library::special("from_fn");
                special.map(|special| Code::Special(special, arguments, "from_fn".into()))
            }
            ["SVector" | "SMatrix", "new"] => {
                let arguments = self.all(c.args.iter())?;
                self.native("single", arguments, sizes.to_vec())
            }
            ["newton", "Turn"] => Some(Code::List(self.all(c.args.iter())?)),
            ["newton", "Search", constructor] => self.search(constructor, ty)?,
            [.., "repeat_n"] => match <[Code<f64>; 2]>::try_from(self.all(c.args.iter())?) {
                Ok([value, count]) => Some(Code::Repeat(Box::new(value), Box::new(count))),
                Err(_) => None,
            },
            _ => return Ok(None),
        };
        made.map(Some).ok_or_else(|| refuse(c))
    }

    /// Builds a functional of all sites. The interpreter knows only the runtime's functionals.
    #[inline(never)]
    fn functional(&mut self, of: &syn::Type, c: &syn::ExprCall) -> Result<Code<f64>, Refused> {
        let syn::Type::Path(of) = of else {
            return Err(refuse(c));
        };
        let names = of.path.segments.iter().map(|s| s.ident.to_string());
        let names: Vec<String> = names.collect();
        let name = match names.as_slice() {
            [first, module, name] if first == "clebsch" && module == "mesh" => name,
            own => {
                return Err(Refused::Functional {
                    path: own.join("::"),
                });
            }
        };
        let mut all = vec![Code::constant(Value::Text(crate::text(name)))];
        all.extend(self.all(c.args.iter())?);
        self.native("Functional::new", all, Vec::new())
            .ok_or_else(|| refuse(c))
    }

    /// A function or a method of the runtime.
    fn runtime<'e>(
        &mut self,
        name: &str,
        list: impl Iterator<Item = &'e syn::Expr>,
        receiver: Option<Code<f64>>,
        sizes: Vec<usize>,
    ) -> Result<Option<Code<f64>>, Refused> {
        let name = match (self.shared.by_length, name) {
            (true, "dot") => "dot_sizes",
            (true, "cross") => "cross_sizes",
            _ => name,
        };
        let name = match (self.shared.projects, name) {
            (true, "validate::along_constraint") => "validate::is_determined",
            _ => name,
        };
        let mut arguments: Vec<Code<f64>> = receiver.into_iter().collect();
        for e in list {
            arguments.push(self.argument(e)?);
        }
        // A function that takes a closure or changes places is not a function of values.
        let calls_back = arguments.iter().any(|a| matches!(a, Code::Closure(..)));
        if let Some(special) = crate::library::special(name)
            && (calls_back || crate::library::native::<f64>(name, arguments.len()).is_none())
        {
            let made = Code::Special(special, arguments, name.into());
            // An inertia that depends only on the model is computed once.
            if name == "columns" && self.is_steady(&made, &mut Vec::new()) {
                let at = self.fresh();
                self.steady.push(at);
                let once = Code::Once(at, Box::new(made));
                return Ok(Some(Code::Block(vec![once, Code::Place(at)])));
            }
            return Ok(Some(made));
        }
        Ok(self.native(name, arguments, sizes))
    }

    pub(super) fn method(
        &mut self,
        m: &syn::ExprMethodCall,
        ty: Option<&syn::Type>,
    ) -> Result<Code<f64>, Refused> {
        let name = m.method.to_string();
        if let (true, Some(ty)) = (name == "alike", ty) {
            let like = self
                .search("from_rest", Some(ty))?
                .ok_or_else(|| refuse(m))?;
            let search = self.expression(&m.receiver, None)?;
            return self
                .native("alike", vec![search, like], Vec::new())
                .ok_or_else(|| refuse(m));
        }
        if let Some(owner) = self.kind(&m.receiver)
            && self.shared.program.function(&owner, &name).is_some()
        {
            return self.written_out(&owner, &name, Some(&m.receiver), m.args.iter());
        }
        if let Some(path) = self.given(&m.receiver) {
            let arguments = self.all(m.args.iter())?;
            let missing = || Refused::Given {
                path: path.clone(),
                method: name.clone(),
            };
            return self
                .native(&format!("{path}::{name}"), arguments, Vec::new())
                .ok_or_else(missing);
        }
        if let Some(done) = self.method_of_list(m)? {
            return Ok(done);
        }
        let receiver = self.expression(&m.receiver, None)?;
        let sizes = self.generics(m.turbofish.as_ref());
        self.runtime(&name, m.args.iter(), Some(receiver), sizes)?
            .ok_or_else(|| refuse(m))
    }

    /// The path of a user's function, if an expression names one.
    fn given(&self, e: &syn::Expr) -> Option<String> {
        let syn::Expr::Path(p) = e else { return None };
        let name = p.path.get_ident()?.to_string();
        match self.find(&name) {
            Some(_) => None,
            None => self.shared.program.given.get(&name).cloned(),
        }
    }

    /// A function of the model: its body, with arguments in place of the parameters. A function that is rarely
    /// called, or is recursive, gets its own places instead.
    fn written_out<'e>(
        &mut self,
        owner: &str,
        name: &str,
        receiver: Option<&'e syn::Expr>,
        list: impl Iterator<Item = &'e syn::Expr>,
    ) -> Result<Code<f64>, Refused> {
        let program = self.shared.program;
        let Some(function) = program.function(owner, name) else {
            return Err(Refused::Construct(format!("{owner}::{name}")));
        };
        let given: Vec<&syn::Expr> = receiver.into_iter().chain(list).collect();
        let mut arguments = Vec::new();
        for e in &given {
            arguments.push(self.expression(e, None)?);
        }
        let key = (owner.to_owned(), name.to_owned());
        let rare = function.attrs.iter().any(|a| a.path().is_ident("cold"));
        if rare || self.within.contains(&key) {
            return Ok(Code::Routine(self.routine(&key, function)?, arguments));
        }
        self.within.push(key);
        let mut scope = BTreeMap::new();
        let mut all = Vec::new();
        for (parameter, code) in function.sig.inputs.iter().zip(arguments) {
            let (name, kind) = self.parameter(parameter)?;
            let place = match is_place(&code) {
                true => code,
                false => {
                    let at = self.fresh();
                    all.push(Code::Let(Pattern::Place(at), Box::new(code), None));
                    Code::Place(at)
                }
            };
            scope.insert(name, Binding::Place(place, kind));
        }
        // It cannot use the names of its caller.
        let outer = std::mem::replace(&mut self.scopes, vec![scope]);
        let body = self.body(function);
        self.scopes = outer;
        self.within.pop();
        all.push(body?);
        Ok(Code::Function(Box::new(Code::Block(all))))
    }

    fn routine(
        &mut self,
        key: &(String, String),
        function: &syn::ImplItemFn,
    ) -> Result<Arc<OnceLock<Routine<f64>>>, Refused> {
        if let Some(known) = self.shared.routines.get(key) {
            return Ok(known.clone());
        }
        let routine = Arc::new(OnceLock::new());
        self.shared.routines.insert(key.clone(), routine.clone());
        let mut inner = Lower {
            shared: self.shared,
            scopes: vec![BTreeMap::new()],
            next: function.sig.inputs.len(),
            within: vec![key.clone()],
            steady: Vec::new(),
        };
        for (at, parameter) in function.sig.inputs.iter().enumerate() {
            let (name, kind) = inner.parameter(parameter)?;
            inner.bind(name, Binding::Place(Code::Place(at), kind));
        }
        let body = inner.body(function)?;
        let places = inner.next;
        let body = Code::Function(Box::new(body));
        // The cell was empty when it was read above, so `set` succeeds.
        let _ = routine.set(Routine { places, body });
        Ok(routine)
    }
}

/// The frame of a momentum by its type.
fn frame(name: &str) -> Option<Frame> {
    Some(match name {
        "BodyMomentum" | "BodyMomentumMatrix" | "BodyImpulse" | "BodyPlaneImpulse" => Frame::Body,
        "SpatialMomentum" | "SpatialMomentumMatrix" | "SpatialImpulse" | "SpatialPlaneImpulse" => {
            Frame::Spatial
        }
        "CarriedImpulse" | "CarriedPlaneImpulse" => Frame::Carried,
        "FieldMomentum" => Frame::Field,
        _ => return None,
    })
}
