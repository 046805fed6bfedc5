//! Translates the emitted functions to operations over numbered places: all names are looked up here. Functions are
//! inlined at their calls, except rarely called ones.
//!
//! Calls nest some hundred deep. Functions marked `inline(never)` keep the frames of the recursion small: a thread has two
//! megabytes of stack.

mod call;
mod expression;
mod line;
mod newton;
mod statement;

use crate::Refused;
use crate::code::{Code, Routine};
use crate::listing::FieldNames;
use crate::program::{Program, type_name};
use crate::value::Layout;
use quote::ToTokens;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::{Arc, OnceLock};

/// The meaning of a name.
#[derive(Clone)]
enum Binding {
    /// A place, and the type of the struct in it.
    Place(Code<f64>, Option<String>),
    /// A closure, inlined where a function receives it.
    Closure(Box<syn::ExprClosure>),
}

type Routines = BTreeMap<(String, String), Arc<OnceLock<Routine<f64>>>>;

/// Data that the lowering of all functions of one model shares.
pub struct Shared<'a> {
    /// The items.
    pub program: &'a Program,
    /// The values of named sizes.
    pub sizes: BTreeMap<String, usize>,
    names: Rc<RefCell<BTreeMap<String, u32>>>,
    layouts: BTreeMap<String, Arc<Layout>>,
    /// Whether sums over sites add the sizes of their terms.
    pub by_size: bool,
    /// Whether products of vectors become products of their lengths, so that each part of a momentum has the size of
    /// the whole.
    pub by_length: bool,
    /// Whether initial momenta are projected on the constraints, however large the normal part is.
    pub projects: bool,
    /// The first place that no function uses.
    free: usize,
    routines: Routines,
}

impl<'a> Shared<'a> {
    /// An empty lowering.
    pub fn new(program: &'a Program, sizes: BTreeMap<String, usize>) -> Self {
        let names = crate::library::NAMES.iter().zip(0..);
        Shared {
            program,
            sizes,
            names: Rc::new(RefCell::new(
                names.map(|(name, i)| ((*name).to_owned(), i)).collect(),
            )),
            layouts: BTreeMap::new(),
            by_size: false,
            by_length: false,
            projects: false,
            free: 0,
            routines: BTreeMap::new(),
        }
    }

    /// The index of a field name.
    pub fn name(&mut self, name: &str) -> u32 {
        let mut names = self.names.borrow_mut();
        let next = names.len() as u32;
        *names.entry(name.to_owned()).or_insert(next)
    }

    /// All field names by their indices.
    pub fn names(&self) -> FieldNames {
        let names = self.names.borrow();
        let mut all = vec![String::new(); names.len()];
        for (name, at) in names.iter() {
            if let Some(slot) = all.get_mut(*at as usize) {
                slot.clone_from(name);
            }
        }
        FieldNames(all)
    }

    /// The fields of a struct.
    pub fn layout(&mut self, name: &str) -> Result<Arc<Layout>, Refused> {
        if let Some(known) = self.layouts.get(name) {
            return Ok(known.clone());
        }
        let fields: Vec<String> = match (name, self.program.structs.get(name)) {
            ("Moving", _) => ["attitude", "momentum", "edge"].map(str::to_owned).to_vec(),
            (_, Some(fields)) => fields.iter().map(|(f, _)| f.clone()).collect(),
            _ => return Err(Refused::Construct(format!("struct {name}"))),
        };
        let fields = fields.iter().map(|f| self.name(f)).collect();
        let layout = Arc::new(Layout {
            name: name.to_owned(),
            fields,
        });
        self.layouts.insert(name.to_owned(), layout.clone());
        Ok(layout)
    }
}

/// The lowering of one function.
pub struct Lower<'a, 'b> {
    shared: &'b mut Shared<'a>,
    scopes: Vec<BTreeMap<String, Binding>>,
    /// The next free place.
    next: usize,
    /// The type whose function is lowered, and its name.
    within: Vec<(String, String)>,
    /// The place of the model, and the places of values computed from the model alone.
    steady: Vec<usize>,
}

/// Lowers a function of a type, with its parameters at given places and locals from `first` on.
///
/// # Errors
/// [`Refused`] for emitted code that the interpreter does not support.
pub fn entry(
    shared: &mut Shared<'_>,
    (ty, name): (&str, &str),
    given: &[usize],
    first: usize,
) -> Result<Routine<f64>, Refused> {
    let program = shared.program;
    let Some(function) = program.function(ty, name) else {
        return Err(Refused::Construct(format!("{ty}::{name}")));
    };
    let mut lower = Lower {
        // Each function has its own places, so that kept values are not lost to another function.
        next: first.max(shared.free),
        shared,
        scopes: vec![BTreeMap::new()],
        within: vec![(ty.to_owned(), name.to_owned())],
        steady: given
            .first()
            .into_iter()
            .copied()
            .filter(|at| *at == 0)
            .collect(),
    };
    for (parameter, given) in function.sig.inputs.iter().zip(given) {
        let (name, kind) = lower.parameter(parameter)?;
        lower.bind(name, Binding::Place(Code::Place(*given), kind));
    }
    let body = lower.body(function)?;
    lower.shared.free = lower.next;
    Ok(Routine {
        places: lower.next,
        body: Code::Function(Box::new(body)),
    })
}

/// Lowers a start that projects momenta on the constraints, however large their normal part is.
pub fn projecting(
    shared: &mut Shared<'_>,
    function: (&str, &str),
    given: &[usize],
) -> Result<Routine<f64>, Refused> {
    // The functions that it calls are also lowered separately.
    let usual = std::mem::take(&mut shared.routines);
    shared.projects = true;
    let routine = entry(shared, function, given, crate::opened::at::FIRST);
    shared.projects = false;
    shared.routines = usual;
    routine
}

impl Lower<'_, '_> {
    fn bind(&mut self, name: String, binding: Binding) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name, binding);
        }
    }

    fn find(&self, name: &str) -> Option<&Binding> {
        self.scopes.iter().rev().find_map(|s| s.get(name))
    }

    fn fresh(&mut self) -> usize {
        self.next += 1;
        self.next - 1
    }

    /// The type whose functions are lowered now.
    fn own_type(&self) -> &str {
        self.within.last().map_or("", |(ty, _)| ty.as_str())
    }

    /// The name and the struct of a parameter.
    fn parameter(&self, parameter: &syn::FnArg) -> Result<(String, Option<String>), Refused> {
        match parameter {
            syn::FnArg::Receiver(_) => Ok(("self".to_owned(), Some(self.own_type().to_owned()))),
            syn::FnArg::Typed(p) => {
                let name = match &*p.pat {
                    syn::Pat::Ident(name) => name.ident.to_string(),
                    syn::Pat::Wild(_) => String::new(),
                    other => return Err(refuse(other)),
                };
                Ok((name, self.struct_of(&p.ty)))
            }
        }
    }

    /// The struct of the model that a type names.
    fn struct_of(&self, ty: &syn::Type) -> Option<String> {
        let own = self.own_type();
        let name = match type_name(ty)? {
            of_self if of_self == "Self" => own.to_owned(),
            part if is_of_self(ty) => format!("{own}{part}"),
            other => other,
        };
        let known = self.shared.program.structs.contains_key(&name) || name == "Moving";
        known.then_some(name)
    }

    /// The struct that an expression evaluates to, if this can be inferred.
    fn kind(&self, e: &syn::Expr) -> Option<String> {
        match e {
            syn::Expr::Path(p) => match self.find(&p.path.get_ident()?.to_string())? {
                Binding::Place(_, kind) => kind.clone(),
                _ => None,
            },
            syn::Expr::Reference(r) => self.kind(&r.expr),
            syn::Expr::Unary(u) => self.kind(&u.expr),
            syn::Expr::Paren(p) => self.kind(&p.expr),
            syn::Expr::Struct(s) => match crate::program::named(&s.path).as_str() {
                "Self" => Some(self.own_type().to_owned()),
                other => Some(other.to_owned()),
            },
            syn::Expr::Field(f) => {
                let syn::Member::Named(field) = &f.member else {
                    return None;
                };
                let field = field.to_string();
                let owner = self.kind(&f.base)?;
                let fields = self.shared.program.structs.get(&owner)?;
                let (_, ty) = fields.iter().find(|(name, _)| *name == field)?;
                self.struct_of(ty)
            }
            syn::Expr::MethodCall(m) => {
                let owner = self.kind(&m.receiver)?;
                let function = self
                    .shared
                    .program
                    .function(&owner, &m.method.to_string())?;
                match &function.sig.output {
                    syn::ReturnType::Type(_, ty) => self.struct_of(ty),
                    syn::ReturnType::Default => None,
                }
            }
            _ => None,
        }
    }

    /// The value of a size: a literal, a named size, or arithmetic with them.
    fn size(&self, e: &syn::Expr) -> Option<usize> {
        constant(e, &self.shared.sizes)
    }
}

/// Whether a type is an associated type of the function's own type, such as `Self::State`.
fn is_of_self(ty: &syn::Type) -> bool {
    match ty {
        syn::Type::Path(p) => p.path.segments.first().is_some_and(|s| s.ident == "Self"),
        syn::Type::Reference(inner) => is_of_self(&inner.elem),
        _ => false,
    }
}

/// The value of an expression in named sizes.
pub fn constant(e: &syn::Expr, sizes: &BTreeMap<String, usize>) -> Option<usize> {
    match e {
        syn::Expr::Lit(lit) => match &lit.lit {
            syn::Lit::Int(n) => n.base10_parse().ok(),
            _ => None,
        },
        syn::Expr::Path(p) => sizes.get(&p.path.get_ident()?.to_string()).copied(),
        syn::Expr::Paren(p) => constant(&p.expr, sizes),
        syn::Expr::Group(g) => constant(&g.expr, sizes),
        syn::Expr::Block(b) => match b.block.stmts.as_slice() {
            [syn::Stmt::Expr(e, None)] => constant(e, sizes),
            _ => None,
        },
        syn::Expr::Binary(b) => {
            let (x, y) = (constant(&b.left, sizes)?, constant(&b.right, sizes)?);
            match b.op {
                syn::BinOp::Add(_) => x.checked_add(y),
                syn::BinOp::Sub(_) => x.checked_sub(y),
                syn::BinOp::Mul(_) => x.checked_mul(y),
                syn::BinOp::Div(_) => x.checked_div(y),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The error for an unsupported construct, which quotes the emitted code.
fn refuse(tokens: &impl ToTokens) -> Refused {
    let text: String = tokens.to_token_stream().to_string();
    Refused::Construct(text.chars().take(160).collect())
}
