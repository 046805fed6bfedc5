//! Names of emitted items and locals: the model's own as written, all others chosen so that no
//! name of the model hides them.

use crate::derive::Derivation;
use crate::expr::symbol::SymbolId;
use proc_macro2::Ident;
use quote::format_ident;

/// Names of one model.
pub struct Names {
    /// Name of the module that holds the items.
    pub module: String,
    taken: Vec<String>,
}

impl Names {
    /// The names of a model.
    pub fn new(d: &Derivation) -> Names {
        let s = &d.letters.symbols;
        Names {
            module: snake(&d.spec.name),
            taken: s.ids().map(|id| s.get(id).name.clone()).collect(),
        }
    }

    /// A local name that no symbol of the model bears.
    pub fn local(&self, base: &str) -> Ident {
        let mut name = base.to_owned();
        while self.taken.iter().any(|t| *t == name) {
            name.push('_');
        }
        format_ident!("{name}")
    }
}

/// The symbol's own name.
pub fn own(d: &Derivation, id: SymbolId) -> Ident {
    format_ident!("{}", d.letters.symbols.get(id).name)
}

/// The symbol's name at another time level or in another guise.
pub fn tagged(d: &Derivation, names: &Names, id: SymbolId, tag: &str) -> Ident {
    names.local(&format!("{}_{tag}", d.letters.symbols.get(id).name))
}

/// An item that belongs to the model: `HeavyTopState`.
pub fn item(d: &Derivation, suffix: &str) -> Ident {
    format_ident!("{}{suffix}", d.spec.name)
}

/// `base` for one configuration, `base_Λ1` for several.
pub fn per_configuration(d: &Derivation, base: &str, i: usize) -> Ident {
    match d.spec.configurations.as_slice() {
        [_] => format_ident!("{base}"),
        list => {
            let element = list
                .get(i)
                .map(|c| d.letters.symbols.get(c.element).name.clone());
            format_ident!("{base}_{}", element.unwrap_or_default())
        }
    }
}

/// `HeavyTop` as `heavy_top`.
pub fn snake(name: &str) -> String {
    separated(name, '_')
}

/// `HeavyTop` as `heavy-top`.
pub fn kebab(name: &str) -> String {
    separated(&crate::expr::symbol::ascii(name), '-').replace('_', "-")
}

fn separated(name: &str, separator: char) -> String {
    let chars: Vec<char> = name.chars().collect();
    let mut out = String::new();
    for (i, c) in chars.iter().enumerate() {
        let starts = c.is_uppercase()
            && i > 0
            && (!chars[i - 1].is_uppercase() || chars.get(i + 1).is_some_and(|n| n.is_lowercase()))
            && chars[i - 1] != '_';
        if starts {
            out.push(separator);
        }
        out.extend(c.to_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{kebab, snake};

    #[test]
    fn names_of_models_change_case() {
        assert_eq!(snake("HeavyTop"), "heavy_top");
        assert_eq!(kebab("HeavyTop"), "heavy-top");
        assert_eq!(kebab("BodyN"), "body-n");
        assert_eq!(snake("SO3Body"), "so3_body");
    }
}
