//! Finds expressions of a source file that have a wrong form of the same type: signs, orders of factors, comparisons, conditions,
//! numbers, time levels, factors of one half, transposes and inverses.

use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, UnOp};

/// An expression and its replacement.
#[derive(Clone, Debug)]
pub struct Site {
    /// Byte range in the file.
    pub range: Range<usize>,
    /// The wrong form.
    pub instead: String,
    /// A description of the change.
    pub what: &'static str,
}

struct Finder<'a> {
    text: &'a str,
    sites: Vec<Site>,
}

/// All sites of a file, in order of position.
pub fn sites(text: &str) -> Result<Vec<Site>, String> {
    let file = syn::parse_file(text).map_err(|e| e.to_string())?;
    let mut finder = Finder {
        text,
        sites: Vec::new(),
    };
    finder.visit_file(&file);
    finder.sites.sort_by_key(|s| (s.range.start, s.range.end));
    Ok(finder.sites)
}

/// Whether an item is compiled only for tests.
fn of_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("test")
            || a.path().is_ident("cfg") && a.parse_args::<syn::Ident>().is_ok_and(|i| i == "test")
    })
}

/// Pairs of functions that are mistaken for each other.
const TWINS: [(&str, &str, &str); 9] = [
    ("add", "sub", "a sum for a difference"),
    ("sub", "add", "a difference for a sum"),
    ("min", "max", "the least for the largest"),
    ("max", "min", "the largest for the least"),
    ("all", "any", "all for any"),
    ("any", "all", "any for all"),
    ("is_some", "is_none", "a condition"),
    ("is_none", "is_some", "a condition"),
    ("is_body", "is_spatial", "the side"),
];

/// Functions of one argument; the mutant replaces the call by its argument.
const LEFT_OUT: [(&str, &str); 4] = [
    ("neg", "a sign"),
    ("transpose", "a transpose"),
    ("transposed", "a transpose"),
    ("inverse", "an inverse"),
];

/// Functions of two arguments; the mutant exchanges them.
const EXCHANGED: [(&str, &str); 4] = [
    ("mul", "the order of factors"),
    ("cross", "the order of factors"),
    ("compose", "the order of factors"),
    ("ordered", "the order of factors"),
];

/// Pairs of constants that are mistaken for each other.
const CONSTANTS: [(&str, &str, &str); 5] = [
    ("HERE", "NEXT", "the time level"),
    ("NEXT", "HERE", "the time level"),
    ("HALF", "ONE", "a factor one half"),
    ("Body", "Spatial", "the side"),
    ("Spatial", "Body", "the side"),
];

impl Finder<'_> {
    fn source(&self, node: &impl Spanned) -> String {
        let range = node.span().byte_range();
        self.text.get(range).unwrap_or_default().to_owned()
    }

    fn push(&mut self, node: &impl Spanned, instead: String, what: &'static str) {
        let range = node.span().byte_range();
        let source = self.text.get(range.clone()).unwrap_or_default();
        if !source.is_empty() && source != instead {
            self.sites.push(Site {
                range,
                instead,
                what,
            });
        }
    }

    fn binary(&mut self, node: &syn::ExprBinary) {
        let (op, what) = match node.op {
            BinOp::Add(_) => ("-", "a sum for a difference"),
            BinOp::Sub(_) => ("+", "a difference for a sum"),
            BinOp::Mul(_) => ("/", "a product for a quotient"),
            BinOp::Div(_) => ("*", "a quotient for a product"),
            BinOp::Lt(_) => ("<=", "a comparison"),
            BinOp::Le(_) => ("<", "a comparison"),
            BinOp::Gt(_) => (">=", "a comparison"),
            BinOp::Ge(_) => (">", "a comparison"),
            BinOp::Eq(_) => ("!=", "a comparison"),
            BinOp::Ne(_) => ("==", "a comparison"),
            BinOp::And(_) => ("||", "and for or"),
            BinOp::Or(_) => ("&&", "or for and"),
            _ => return,
        };
        let (left, right) = (self.source(&node.left), self.source(&node.right));
        self.push(node, format!("({left}) {op} ({right})"), what);
    }

    fn call(&mut self, node: &syn::ExprCall) {
        let Expr::Path(function) = &*node.func else {
            return;
        };
        let Some(last) = function.path.segments.last() else {
            return;
        };
        let name = last.ident.to_string();
        let whole = self.source(&node.func);
        let stem = whole.strip_suffix(&name).unwrap_or_default().to_owned();
        let given: Vec<String> = node.args.iter().map(|a| self.source(a)).collect();
        if let Some((_, other, what)) = TWINS.iter().find(|(n, ..)| *n == name) {
            self.push(node, format!("{stem}{other}({})", given.join(", ")), what);
        }
        if let (Some((_, what)), Some(inner)) = (
            LEFT_OUT.iter().find(|(n, _)| *n == name),
            given.last().filter(|_| given.len() <= 2),
        ) {
            self.push(node, inner.clone(), what);
        }
        if let (Some((_, what)), [.., a, b]) =
            (EXCHANGED.iter().find(|(n, _)| *n == name), given.as_slice())
        {
            let before: Vec<String> = given.iter().take(given.len() - 2).cloned().collect();
            let all = [before, vec![b.clone(), a.clone()]].concat();
            self.push(node, format!("{whole}({})", all.join(", ")), what);
        }
    }

    fn method(&mut self, node: &syn::ExprMethodCall) {
        let name = node.method.to_string();
        let receiver = self.source(&node.receiver);
        let given: Vec<String> = node.args.iter().map(|a| self.source(a)).collect();
        let given = given.join(", ");
        if let Some((_, other, what)) = TWINS.iter().find(|(n, ..)| *n == name) {
            self.push(node, format!("{receiver}.{other}({given})"), what);
        }
        if let Some((_, what)) = LEFT_OUT.iter().find(|(n, _)| *n == name)
            && node.args.is_empty()
        {
            self.push(node, receiver.clone(), what);
        }
        if name == "cross" {
            self.push(
                node,
                format!("-({})", self.source(node)),
                "the order of factors",
            );
        }
        if name == "tr_mul" {
            self.push(node, format!("({receiver}) * ({given})"), "a transpose");
        }
    }

    fn condition(&mut self, condition: &Expr) {
        let text = self.source(condition);
        // A `let` chain is not an expression.
        if !text.contains("let ") {
            self.push(condition, format!("!({text})"), "a condition");
        }
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, node: &'ast syn::ItemMod) {
        if !of_tests(&node.attrs) {
            visit::visit_item_mod(self, node);
        }
    }

    fn visit_item_fn(&mut self, node: &'ast syn::ItemFn) {
        if node.sig.constness.is_none() && !of_tests(&node.attrs) {
            visit::visit_item_fn(self, node);
        }
    }

    fn visit_impl_item_fn(&mut self, node: &'ast syn::ImplItemFn) {
        if node.sig.constness.is_none() && !of_tests(&node.attrs) {
            visit::visit_impl_item_fn(self, node);
        }
    }

    // Constants are evaluated by the compiler, which has no environment variables.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}

    fn visit_expr(&mut self, node: &'ast Expr) {
        match node {
            Expr::Binary(binary) if !self.source(binary).contains("let ") => self.binary(binary),
            Expr::Call(call) => self.call(call),
            Expr::MethodCall(method) => self.method(method),
            Expr::If(node) => self.condition(&node.cond),
            Expr::Unary(unary) => {
                let what = match unary.op {
                    UnOp::Not(_) => Some("a condition"),
                    UnOp::Neg(_) => Some("a sign"),
                    _ => None,
                };
                if let Some(what) = what {
                    let inner = self.source(&unary.expr);
                    self.push(unary, inner, what);
                }
            }
            Expr::Lit(lit) => match &lit.lit {
                Lit::Bool(b) => self.push(lit, (!b.value).to_string(), "a condition"),
                Lit::Int(n) => {
                    if let Ok(value) = n.base10_parse::<u64>() {
                        let next = format!("{}{}", value.saturating_add(1), n.suffix());
                        self.push(lit, next, "a whole number");
                    }
                }
                Lit::Float(_) => {
                    let text = self.source(lit);
                    self.push(lit, format!("(1.5 * {text})"), "a number");
                }
                _ => {}
            },
            Expr::Path(path) => {
                let whole = self.source(path);
                let found = CONSTANTS.iter().find(|(name, ..)| {
                    path.path.segments.len() > 1
                        && path.path.segments.last().is_some_and(|s| s.ident == name)
                });
                if let Some((name, other, what)) = found
                    && let Some(stem) = whole.strip_suffix(name)
                {
                    self.push(path, format!("{stem}{other}"), what);
                }
            }
            _ => {}
        }
        visit::visit_expr(self, node);
    }
}
