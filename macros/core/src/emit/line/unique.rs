//! Names of locals in kernels. Each differs from the other quantities of the model, the temporaries and the names
//! that every kernel uses.

use super::Lines;
use crate::line::Line;
use proc_macro2::Ident;
use quote::format_ident;
use std::collections::BTreeSet;

/// The names that kernels and the surrounding functions use.
const KERNEL: [&str; 69] = [
    "a",
    "acting",
    "added",
    "after",
    "at",
    "attitude",
    "axis",
    "band",
    "before",
    "carried",
    "contact",
    "domain",
    "each",
    "edge",
    "edges",
    "energy",
    "factor",
    "first",
    "found",
    "from",
    "h",
    "held",
    "here",
    "i",
    "impulses",
    "index",
    "inertia",
    "inside",
    "j",
    "kick",
    "known",
    "last",
    "leaving",
    "line",
    "list",
    "made",
    "meshes",
    "model",
    "momenta",
    "momentum",
    "newton",
    "parts",
    "place",
    "pull",
    "pulls",
    "quantity",
    "rate",
    "reached",
    "responses",
    "ring",
    "row",
    "rows",
    "self",
    "setting",
    "site",
    "sites",
    "size",
    "space",
    "state",
    "still",
    "there",
    "tied",
    "to",
    "turn",
    "twice",
    "validate",
    "velocities",
    "velocity",
    "weights",
];

/// The reason why a name of the model conflicts with the emitted code, if any.
pub(super) fn refusal(line: &Line) -> Option<String> {
    let part = &line.representative;
    let step = &part.d.letters.symbols.get(part.d.spec.step).name;
    if KERNEL.contains(&step.as_str()) && step != "h" {
        return Some(format!(
            "the step is named `{step}`, which the emitted code uses: name it `h` or `dt`"
        ));
    }
    let counts = line.lattice.labels.iter().map(|l| &l.count.text);
    let mut taken = counts.filter(|n| ["domain", "scalar", "ends"].contains(&n.as_str()));
    if let Some(name) = taken.next() {
        return Some(format!(
            "the emitted code uses the name `{name}`: name the number of sites `N`"
        ));
    }
    if line.holds.iter().any(|h| h.name == "node") {
        return Some(
            "the emitted code uses the name `node`: give the multiplier another name".to_owned(),
        );
    }
    let scalar = line.model.name.text == "T";
    scalar.then(|| "the emitted code uses the name `T`: give the model another name".to_owned())
}

impl<'a> Lines<'a> {
    /// The names for the emitted code of a chain.
    pub(super) fn new(line: &'a Line, source: &'a str) -> Lines<'a> {
        let stated = stated(line);
        let prefix = |base: &str| {
            let mut prefix = base.to_owned();
            while stated.iter().any(|n| is_numbered(n, &prefix)) {
                prefix.push('_');
            }
            prefix
        };
        Lines {
            line,
            source,
            temporary: prefix("t"),
            relative: prefix("R"),
            stated,
        }
    }

    /// A unique name for the letter of `own`. `used` contains the names already in the kernel.
    pub(super) fn unique(&self, own: &str, base: &str, used: &mut Vec<String>) -> Ident {
        let mut name = base.to_owned();
        let made = [&self.temporary, &self.relative];
        while KERNEL.contains(&name.as_str())
            || used.contains(&name)
            || made.iter().any(|prefix| is_numbered(&name, prefix))
            || (name != own && self.stated.contains(&name))
        {
            name.push('_');
        }
        used.push(name.clone());
        format_ident!("{name}")
    }
}

/// Every name that the model states.
fn stated(line: &Line) -> BTreeSet<String> {
    let part = &line.representative;
    let s = &part.d.letters.symbols;
    let of_sites = line.lattice.quantities.iter().map(|q| &q.name.text);
    let of_ends = line.lattice.ends.iter().flatten().flat_map(|a| &a.params);
    let of_ends = of_ends.flat_map(|(names, _)| names.iter().map(|n| &n.text));
    let all = s.ids().filter(|id| part.sited(*id).is_none());
    let once = all.map(|id| &s.get(id).name);
    of_sites.chain(of_ends).chain(once).cloned().collect()
}

/// Whether a name is `prefix` followed by a number.
fn is_numbered(name: &str, prefix: &str) -> bool {
    let number = name.strip_prefix(prefix);
    number.is_some_and(|n| n.parse::<u32>().is_ok())
}
