//! The emitted program of a model as its items: the structs and the functions of each type.
//! Takes the tokens that a build would compile; gives tables by name.

use crate::Refused;
use crate::protocol::Protocol;
use proc_macro2::TokenStream;
use std::collections::BTreeMap;

/// The items of a model.
#[derive(Default)]
pub struct Program {
    /// Fields and types of each struct.
    pub structs: BTreeMap<String, Vec<(String, syn::Type)>>,
    /// The variants of each enum, in order.
    pub variants: BTreeMap<String, Vec<String>>,
    /// Functions by type and name.
    pub functions: BTreeMap<(String, String), syn::ImplItemFn>,
    /// The user's functions of the model: the path of each by its name in the model.
    pub given: BTreeMap<String, String>,
    /// Types that have a name of their own.
    pub aliases: BTreeMap<String, syn::Type>,
    /// Constants by type and name.
    pub constants: BTreeMap<(String, String), syn::Expr>,
}

impl Program {
    /// Sorts the emitted items.
    ///
    /// # Errors
    /// If the tokens are not items. Emission never produces such tokens.
    pub fn read(tokens: TokenStream) -> Result<Self, Refused> {
        let file: syn::File = syn::parse2(tokens).map_err(|e| Refused::Construct(e.to_string()))?;
        let mut program = Program::default();
        program.take(file.items)?;
        Ok(program)
    }

    fn take(&mut self, items: Vec<syn::Item>) -> Result<(), Refused> {
        for item in items {
            match item {
                syn::Item::Mod(module) => {
                    if let Some((_, items)) = module.content {
                        self.take(items)?;
                    }
                }
                syn::Item::Struct(item) => {
                    let fields = item
                        .fields
                        .iter()
                        .filter_map(|f| Some((f.ident.as_ref()?.to_string(), f.ty.clone())));
                    self.structs
                        .insert(item.ident.to_string(), fields.collect());
                }
                // A variant of an enum is a struct of its full name.
                syn::Item::Enum(item) => {
                    let order = item.variants.iter().map(|v| v.ident.to_string());
                    self.variants
                        .insert(item.ident.to_string(), order.collect());
                    for variant in item.variants {
                        let name = format!("{}::{}", item.ident, variant.ident);
                        let fields = variant.fields.iter();
                        let fields = fields
                            .filter_map(|f| Some((f.ident.as_ref()?.to_string(), f.ty.clone())));
                        self.structs.insert(name, fields.collect());
                    }
                }
                syn::Item::Type(item) => {
                    self.aliases.insert(item.ident.to_string(), *item.ty);
                }
                syn::Item::Impl(item) => self.take_impl(item),
                syn::Item::Macro(item) if named(&item.mac.path) == "stepper" => {
                    self.take_protocol(item.mac.tokens)?;
                }
                syn::Item::Use(item) => self.take_use(&item.tree, String::new()),
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds the functions that the runtime's protocol gives to a model.
    fn take_protocol(&mut self, tokens: TokenStream) -> Result<(), Refused> {
        let protocol: Protocol =
            syn::parse2(tokens).map_err(|e| Refused::Construct(e.to_string()))?;
        for (ty, function) in protocol.functions(&self.structs) {
            let name = function.sig.ident.to_string();
            self.functions.insert((ty, name), function);
        }
        Ok(())
    }

    /// A path under another name.
    fn take_use(&mut self, tree: &syn::UseTree, before: String) {
        match tree {
            syn::UseTree::Path(p) => {
                self.take_use(&p.tree, format!("{before}{}::", p.ident));
            }
            syn::UseTree::Rename(r) => {
                let path = format!("{before}{}", r.ident);
                self.given.insert(r.rename.to_string(), path);
            }
            _ => {}
        }
    }

    fn take_impl(&mut self, item: syn::ItemImpl) {
        // Traits repeat what types have.
        if item.trait_.is_some() {
            return;
        }
        let Some(ty) = type_name(&item.self_ty) else {
            return;
        };
        for inner in item.items {
            match inner {
                syn::ImplItem::Fn(f) => {
                    self.functions
                        .insert((ty.clone(), f.sig.ident.to_string()), f);
                }
                syn::ImplItem::Const(c) => {
                    self.constants
                        .insert((ty.clone(), c.ident.to_string()), c.expr);
                }
                _ => {}
            }
        }
    }

    /// A function of a type.
    pub fn function(&self, ty: &str, name: &str) -> Option<&syn::ImplItemFn> {
        self.functions.get(&(ty.to_owned(), name.to_owned()))
    }
}

/// The last name of a path.
pub fn named(path: &syn::Path) -> String {
    let last = path.segments.last();
    last.map_or_else(String::new, |s| s.ident.to_string())
}

/// The name of a type, past references.
pub fn type_name(ty: &syn::Type) -> Option<String> {
    match ty {
        syn::Type::Path(path) => Some(named(&path.path)),
        syn::Type::Reference(inner) => type_name(&inner.elem),
        syn::Type::Paren(inner) => type_name(&inner.elem),
        _ => None,
    }
}
