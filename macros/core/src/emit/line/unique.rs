//! Names of locals in kernels: none is that of another quantity of the model, of a temporary, or of what
//! every kernel has.

use super::Lines;
use proc_macro2::Ident;
use quote::format_ident;

/// What kernels and the functions around them call their own.
const KERNEL: [&str; 44] = [
    "a", "acting", "after", "at", "axis", "before", "contact", "domain", "each", "edge", "edges",
    "energy", "factor", "first", "from", "h", "i", "index", "inertia", "inside", "j", "kick",
    "known", "last", "line", "list", "made", "model", "momenta", "momentum", "newton", "parts",
    "pulls", "ring", "self", "site", "sites", "space", "state", "to", "turn", "twice", "validate",
    "velocity",
];

impl Lines<'_> {
    /// Every name that the model states.
    fn is_stated(&self, name: &str) -> bool {
        let of_site = self.line.lattice.find(name).is_some();
        let s = &self.line.representative.d.letters.symbols;
        let of_end = self.line.lattice.ends.iter().flatten();
        let mut of_end = of_end.flat_map(|a| a.params.iter().flat_map(|(names, _)| names));
        of_site || s.find(name).is_some() || of_end.any(|n| n.text == name)
    }

    /// The beginning of names of temporaries, which no stated name has before a number.
    pub(super) fn prefix(&self, base: &str) -> String {
        let mut prefix = base.to_owned();
        let taken = |prefix: &str| (1..=400).any(|n| self.is_stated(&format!("{prefix}{n}")));
        while taken(&prefix) {
            prefix.push('_');
        }
        prefix
    }

    /// A name for the letter of `own` that no other one has; `used` are those of the same kernel.
    pub(super) fn unique(&self, own: &str, base: &str, used: &mut Vec<String>) -> Ident {
        let mut name = base.to_owned();
        let temporary = |name: &str| {
            ["t", "R"].iter().any(|base| {
                let rest = name.strip_prefix(&self.prefix(base));
                rest.is_some_and(|n| n.parse::<u32>().is_ok())
            })
        };
        while KERNEL.contains(&name.as_str())
            || used.contains(&name)
            || temporary(&name)
            || (name != own && self.is_stated(&name))
        {
            name.push('_');
        }
        used.push(name.clone());
        format_ident!("{name}")
    }
}
