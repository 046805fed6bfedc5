//! Symbols of a model and their table: name, shape, structure and role of every letter
//! that can appear in an expression, in order of declaration.

use super::functional::{Functional, FunctionalId};
use super::shape::{Dim, Shape, Structure};
use super::spelling::{Parsed, parse, parse_apart, seen, seen_apart, seen_typeset};
use std::collections::BTreeSet;

/// Index of a symbol in its table.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct SymbolId(pub u32);

/// The role of a symbol, which determines whether its values belong to nodes, edges or the model.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Role {
    /// The time step, a positive constant.
    Step,
    /// A constant of the model.
    Parameter,
    /// A group element, at nodes.
    Element,
    /// A discrete velocity, on the edge from node k to node k+1.
    Velocity,
    /// A quantity advected by the group, at nodes.
    Advected,
    /// A Lagrange multiplier of a Clebsch constraint, at nodes.
    Multiplier,
    /// A free variation (an element of the Lie algebra, or a test matrix).
    Variation,
    /// A name given to a derived quantity for display and for structural tests.
    Derived,
}

/// One symbol.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Symbol {
    /// Name as written, e.g. `Λ1`.
    pub name: String,
    /// The ASCII spelling used in files, e.g. `Lambda1`.
    pub ascii: String,
    /// Shape.
    pub shape: Shape,
    /// Structure.
    pub structure: Structure,
    /// Role.
    pub role: Role,
    /// Its LaTeX form, if the declaration gives one.
    pub typeset: Option<String>,
    /// Whether it is a copy that prints with its site in brackets, because another name would print alike.
    pub apart: bool,
    /// Lines of the documentation of its declaration.
    pub docs: Vec<String>,
}

impl Symbol {
    /// The name as it prints, in its parts.
    pub(crate) fn parsed(&self) -> Parsed {
        match self.apart {
            true => parse_apart(&self.name),
            false => parse(&self.name),
        }
    }
}

/// All symbols of a model, in order of creation.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub struct Symbols {
    list: Vec<Symbol>,
    /// Their names as readers see them.
    seen: BTreeSet<String>,
    /// The time index; empty if none was given.
    time_index: String,
    dims: Vec<NamedSize>,
    functionals: Vec<Functional>,
    /// Whether differences from the identity are computed without loss of digits, which costs more.
    differences: bool,
}

/// A named dimension.
#[derive(Clone, PartialEq, Eq, Debug)]
struct NamedSize {
    name: String,
    from: u64,
    to: u64,
}

/// The largest size that is tried for a named dimension, if the model allows smaller ones. An identity between words
/// that holds at this size holds for every larger size.
const LARGEST_TRIED: u64 = 8;

impl Symbols {
    /// Adds a symbol and returns its index.
    pub fn add(&mut self, name: &str, shape: Shape, structure: Structure, role: Role) -> SymbolId {
        self.seen.insert(seen(name, &self.time_index));
        self.list.push(Symbol {
            name: name.to_owned(),
            ascii: ascii(name),
            shape,
            structure,
            role,
            typeset: None,
            apart: false,
            docs: Vec::new(),
        });
        SymbolId((self.list.len() - 1) as u32)
    }

    /// Sets whether differences from the identity, `Id - Ω`, are computed without loss of digits.
    pub fn keep_differences(&mut self, whole: bool) {
        self.differences = whole;
    }

    /// Whether differences from the identity are computed without loss of digits.
    pub fn differences(&self) -> bool {
        self.differences
    }

    /// Sets the time index: `x_k` then prints as `x` at a node.
    pub fn count_time_by(&mut self, index: &str) {
        self.time_index = index.to_owned();
    }

    /// Sets the LaTeX form and the documentation of a symbol, from its declaration.
    pub fn describe(&mut self, id: SymbolId, typeset: Option<String>, docs: &[String]) {
        // Letters of the derivation avoid the printed form as well as the name.
        let printed = typeset.iter().map(|t| seen_typeset(t, &self.time_index));
        self.seen.extend(printed);
        if let Some(symbol) = self.list.get_mut(id.0 as usize) {
            symbol.typeset = typeset;
            symbol.docs = docs.to_vec();
        }
    }

    /// Prints the copy of a quantity with its site in brackets.
    pub fn tell_apart(&mut self, name: &str) {
        let Some(id) = self.find(name) else { return };
        self.seen.insert(seen_apart(name, &self.time_index));
        if let Some(symbol) = self.list.get_mut(id.0 as usize) {
            symbol.apart = true;
        }
    }

    /// Adds a functional and returns its index.
    pub fn add_functional(&mut self, functional: Functional) -> FunctionalId {
        self.seen.insert(seen(&functional.name, &self.time_index));
        let typeset = functional.typeset.iter();
        let printed = typeset.map(|t| seen_typeset(t, &self.time_index));
        self.seen.extend(printed);
        self.functionals.push(functional);
        FunctionalId((self.functionals.len() - 1) as u32)
    }

    /// The functional with this index. Indices are only made by [`Symbols::add_functional`].
    pub fn functional(&self, id: FunctionalId) -> &Functional {
        &self.functionals[id.0 as usize]
    }

    /// All functionals, in order.
    pub fn functionals(&self) -> &[Functional] {
        &self.functionals
    }

    /// The functional of this name.
    pub fn functional_named(&self, name: &str) -> Option<FunctionalId> {
        let found = self.functionals.iter().position(|f| f.name == name)?;
        Some(FunctionalId(found as u32))
    }

    /// Declares a named dimension with its range of sizes.
    pub fn add_dim(&mut self, name: &str, from: u64, to: u64) -> Dim {
        self.dims.push(NamedSize {
            name: name.to_owned(),
            from,
            to,
        });
        Dim::Named((self.dims.len() - 1) as u16)
    }

    /// The text of a dimension: its number or its name.
    pub fn dim_text(&self, dim: Dim) -> String {
        match dim {
            Dim::Fixed(n) => n.to_string(),
            Dim::Named(i) => self
                .dims
                .get(i as usize)
                .map(|d| d.name.clone())
                .unwrap_or_default(),
        }
    }

    /// The smallest and the largest size at which a dimension is tried.
    pub fn sizes(&self, dim: Dim) -> (usize, usize) {
        match dim {
            Dim::Fixed(n) => (n as usize, n as usize),
            Dim::Named(i) => self.dims.get(i as usize).map_or((3, 4), |d| {
                let largest = d.to.min(LARGEST_TRIED.max(d.from));
                (d.from as usize, largest as usize)
            }),
        }
    }

    /// The number of named dimensions.
    pub fn dim_count(&self) -> u16 {
        u16::try_from(self.dims.len()).unwrap_or(u16::MAX)
    }

    /// The declared dimension of that name.
    pub fn find_dim(&self, name: &str) -> Option<Dim> {
        let i = self.dims.iter().position(|d| d.name == name)?;
        Some(Dim::Named(i as u16))
    }

    /// The symbol with this index. Indices are only made by [`Symbols::add`].
    pub fn get(&self, id: SymbolId) -> &Symbol {
        &self.list[id.0 as usize]
    }

    /// The symbol declared under this name.
    pub fn find(&self, name: &str) -> Option<SymbolId> {
        let i = self.list.iter().position(|s| s.name == name)?;
        Some(SymbolId(i as u32))
    }

    /// All indices in order.
    pub fn ids(&self) -> impl Iterator<Item = SymbolId> + use<> {
        (0..self.list.len() as u32).map(SymbolId)
    }

    /// The first of these letters that no symbol has as its name; if `is_numbered` is set, followed by a number
    /// either. The first letter if all are taken.
    pub fn free_letter<'a>(&self, letters: &[&'a str], is_numbered: bool) -> &'a str {
        let digit = |c: char| c.is_ascii_digit() || c == '_';
        let bears = |s: &Symbol, letter: &str| match s.name.strip_prefix(letter) {
            Some("") => true,
            Some(rest) => is_numbered && rest.chars().all(digit),
            None => false,
        };
        let free = |letter: &&&str| !self.list.iter().any(|s| bears(s, letter));
        let found = letters.iter().find(free).or(letters.first());
        found.copied().unwrap_or("")
    }

    /// A name that no symbol has or prints as: `base`, or `base` with a number. The number is separated from a
    /// trailing digit: `R_1` belongs to one site, and `R_11` to another.
    pub fn fresh_name(&self, base: &str) -> String {
        let apart = if base.ends_with(|c: char| c.is_ascii_digit()) {
            "_"
        } else {
            ""
        };
        let mut name = base.to_owned();
        let mut n = 1u32;
        while self.seen.contains(&seen(&name, &self.time_index)) {
            name = format!("{base}{apart}{n}");
            n += 1;
        }
        name
    }
}

impl Symbol {
    /// Its documentation on one line; empty if there is none.
    pub fn doc(&self) -> String {
        let lines = self.docs.iter().map(|l| l.trim());
        let words: Vec<&str> = lines.filter(|l| !l.is_empty()).collect();
        words.join(" ")
    }
}

/// Greek letters with their ASCII names, the public ones in files.
pub const GREEK: [(char, &str); 54] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "epsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('ο', "omicron"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('ς', "varsigma"),
    ('σ', "sigma"),
    // Variants, by their HTML names, where LaTeX uses the shorter name for the plain letter.
    ('ϵ', "straightepsilon"),
    ('ϑ', "vartheta"),
    ('ϕ', "straightphi"),
    ('ϖ', "varpi"),
    ('ϱ', "varrho"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "phi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Α', "Alpha"),
    ('Β', "Beta"),
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Ε', "Epsilon"),
    ('Ζ', "Zeta"),
    ('Η', "Eta"),
    ('Θ', "Theta"),
    ('Ι', "Iota"),
    ('Κ', "Kappa"),
    ('Λ', "Lambda"),
    ('Μ', "Mu"),
    ('Ν', "Nu"),
    ('Ξ', "Xi"),
    ('Ο', "Omicron"),
    ('Π', "Pi"),
    ('Ρ', "Rho"),
    ('Σ', "Sigma"),
    ('Τ', "Tau"),
    ('Υ', "Upsilon"),
    ('Φ', "Phi"),
    ('Χ', "Chi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
];

/// The LaTeX command for a letter of [`GREEK`]; capitals that look Latin have none.
pub(crate) fn greek_command(word: &str) -> String {
    let latin = match word {
        "Alpha" => "A",
        "Beta" => "B",
        "Epsilon" => "E",
        "Zeta" => "Z",
        "Eta" => "H",
        "Iota" => "I",
        "Kappa" => "K",
        "Mu" => "M",
        "Nu" => "N",
        "Omicron" => "O",
        "Rho" => "P",
        "Tau" => "T",
        "Chi" => "X",
        "omicron" => return "o".to_owned(),
        "epsilon" => return "\\varepsilon".to_owned(),
        "phi" => return "\\varphi".to_owned(),
        "straightepsilon" => return "\\epsilon".to_owned(),
        "straightphi" => return "\\phi".to_owned(),
        _ => return format!("\\{word}"),
    };
    format!("\\mathrm{{{latin}}}")
}

/// The ASCII spelling of a name: Greek letters by name, other non-ASCII characters as `u` and their code point in
/// hexadecimal.
pub fn ascii(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii() {
            out.push(c);
        } else if let Some((_, word)) = GREEK.iter().find(|(g, _)| *g == c) {
            out.push_str(word);
        } else {
            out.push_str(&format!("u{:x}", c as u32));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::ascii;

    #[test]
    fn greek_names_have_ascii_twins() {
        assert_eq!(ascii("Λ1"), "Lambda1");
        assert_eq!(ascii("Γ"), "Gamma");
        assert_eq!(ascii("chi"), "chi");
    }
}
