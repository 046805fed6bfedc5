//! The model as data: fields of its parameters, initial values, observables and invariants, and a way to run it
//! without knowing its type. The command line and the generic tests use it.

use super::element::{self, Family, family};
use super::formula::formula;
use super::items::kept;
use super::names::{Names, item, kebab};
use super::sizes::{Generics, size};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::kinetic::{self, Kinetic};
use crate::derive::select_solver::Method;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Symbol, SymbolId, Symbols};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

struct FieldOf {
    name: String,
    shape: Shape,
    kind: &'static str,
    doc: String,
}

impl FieldOf {
    fn tokens(&self, s: &Symbols) -> TokenStream {
        let (name, doc) = (&self.name, &self.doc);
        let ascii = crate::expr::symbol::ascii(name);
        let (rows, cols) = super::expression::dims(s, self.shape);
        let kind = format_ident!("{}", self.kind);
        match ascii == *name {
            true => quote!(Kind::#kind.field(#name, [#rows, #cols], #doc)),
            false => quote!(Kind::#kind.spelt(#name, #ascii, [#rows, #cols], #doc)),
        }
    }
}

fn of_symbol(d: &Derivation, id: SymbolId, when: &str) -> FieldOf {
    let symbol = d.letters.symbols.get(id);
    let kind = if symbol.shape.is_scalar() {
        "Scalar"
    } else if symbol.shape.is_vector() {
        "Vector"
    } else {
        let moments =
            |form: &Kinetic| kinetic::is_second_moment(&d.spec, &d.letters, &form.energy, id);
        match symbol.structure {
            Structure::Symmetric if d.kinetic.as_ref().is_some_and(moments) => "SecondMoments",
            Structure::Symmetric => "Symmetric",
            Structure::Skew => "Skew",
            Structure::Diagonal => "Diagonal",
            Structure::General
            | Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => "Matrix",
        }
    };
    FieldOf {
        name: symbol.name.clone(),
        shape: symbol.shape,
        kind,
        doc: description(symbol, when),
    }
}

/// The field of a symbol whose value a case gives. Its kind names the group of an element, because a case can give
/// elements in other forms than matrices.
fn of_given(d: &Derivation, id: SymbolId, when: &str) -> FieldOf {
    let own = of_symbol(d, id, when);
    let kind = match d.letters.symbols.get(id).structure {
        Structure::Orthogonal => "Rotation",
        Structure::UnitQuaternion => "UnitQuaternion",
        Structure::RigidMotion => "RigidMotion",
        _ => own.kind,
    };
    FieldOf { kind, ..own }
}

/// The symbol's documentation in the model, or `else_words` if there is none.
fn description(symbol: &Symbol, else_words: &str) -> String {
    match symbol.doc() {
        doc if doc.is_empty() => else_words.to_owned(),
        doc => doc,
    }
}

fn element_field(d: &Derivation, i: usize) -> FieldOf {
    let c = &d.spec.configurations[i];
    let (kind, doc) = match family(c) {
        Family::Rotation | Family::Orthogonal(_) => ("Rotation", "attitude, body to space"),
        Family::Quaternion => ("UnitQuaternion", "attitude (w, x, y, z), body to space"),
        Family::Coordinates(names) => (names.kind, names.words),
        Family::Linear(_) => ("Matrix", "configuration, reference to space"),
        Family::Field(shape) => match (shape.is_scalar(), shape.is_vector()) {
            (true, _) => ("Scalar", ""),
            (false, true) => ("Vector", ""),
            (false, false) => ("Matrix", ""),
        },
    };
    FieldOf {
        name: d
            .letters
            .symbols
            .get(d.spec.configurations[i].element)
            .name
            .clone(),
        shape: match family(c) {
            // The four components determine the matrix.
            Family::Quaternion => Shape::vector(c.group.size()),
            _ => c.group.shape(),
        },
        kind,
        doc: description(d.letters.symbols.get(c.element), doc),
    }
}

fn momentum_field(d: &Derivation, i: usize, side: Side) -> FieldOf {
    let c = &d.spec.configurations[i];
    let (kind, doc) = match c.group.is_additive() {
        true => {
            let name = &d.letters.symbols.get(c.element).name;
            ("FieldMomentum", format!("momentum of {name}"))
        }
        false => (
            side.of("BodyMomentum", "SpatialMomentum"),
            format!("momentum, {} frame", side.frame()),
        ),
    };
    FieldOf {
        name: element::momentum_field(d, i, side).to_string(),
        shape: d.letters.symbols.get(d.letters.node_momentum[i]).shape,
        kind,
        doc,
    }
}

/// `CARD` and the functions to which it refers.
pub fn card(d: &Derivation, names: &Names) -> TokenStream {
    let name = item(d, "");
    let preprocessed = super::stepper::preprocessed(d);
    let count = d.spec.configurations.len();
    let parameters: Vec<FieldOf> = d
        .spec
        .parameters
        .iter()
        .map(|p| of_given(d, *p, ""))
        .collect();
    let mut initial = Vec::new();
    let mut observables = Vec::new();
    for i in 0..count {
        let c = &d.spec.configurations[i];
        initial.push(element_field(d, i));
        initial.push(momentum_field(d, i, c.side));
        observables.push(element_field(d, i));
        match c.group.is_additive() {
            true => observables.push(momentum_field(d, i, c.side)),
            false => observables.extend(Side::BOTH.map(|side| momentum_field(d, i, side))),
        }
    }
    for id in kept(d) {
        initial.push(of_given(d, id, "value at node 0"));
    }
    for a in &d.spec.advected {
        observables.push(of_symbol(d, a.quantity, ""));
    }
    for hold in &d.spec.holds {
        observables.push(of_symbol(
            d,
            hold.multiplier,
            "multiplier over the step before",
        ));
    }
    let scales = super::invariants::scales(d, names);
    let invariants: Vec<TokenStream> = d
        .invariants
        .iter()
        .map(|v| {
            let (label, text) = (&v.name, formula(d, v));
            let rows = super::invariants::rows(d, v);
            let conserved = format_ident!("{}", if v.exact { "exact" } else { "bounded" });
            quote!(Invariant::#conserved(#label, #text, #rows))
        })
        .collect();
    let (kebab_name, model_name) = (kebab(&d.spec.name), &d.spec.name);
    let doc = d
        .spec
        .docs
        .iter()
        .map(|l| l.trim())
        .collect::<Vec<_>>()
        .join(" ");
    let summary = crate::document::summary(d);
    let solver = format!(
        "{}: {}",
        match d.solve.method {
            Method::FreeMoserVeselov
            | Method::ForcedMoserVeselov
            | Method::LeftFactor
            | Method::Davenport => "Moser-Veselov",
            Method::UnitQuaternions => "Unit quaternions",
            Method::Newton => "Newton",
            Method::Blocks if d.solve.blocks.len() == 1 => "Explicit",
            Method::Linear => "Explicit",
            Method::Blocks => "Blocks",
        },
        d.how_solved()
    );
    let solver = match solver.strip_prefix("Newton: ") {
        Some(how) if how.contains("Newton's method") => how.to_owned(),
        _ => solver,
    };
    // A symmetric one-step action gives an even order; one-sided nodal terms leave order one.
    let irreversible = (!d.reversible).then(|| quote!(order: 1, reversible: false,));
    let discrete_energy = discrete_energy(d);
    let fields = |list: &[FieldOf]| -> Vec<TokenStream> {
        list.iter().map(|f| f.tokens(&d.letters.symbols)).collect()
    };
    let (p, i, o) = (fields(&parameters), fields(&initial), fields(&observables));
    let g = Generics::of(d);
    let (bound, plain) = (g.sizes_bound(), g.plain());
    let solvers = super::left_factor::offered(d).map(|list| quote!(solvers: #list,));
    let dimensions = dimensions(d);
    let dimensions = (!dimensions.is_empty()).then(|| quote!(dimensions: &[#(#dimensions),*],));
    let (sized, sized_by) = match d.spec.dimensions.is_empty() {
        true => (TokenStream::new(), quote!(&only_size::<Self>)),
        false => (sized(d), quote!(&Self::sized)),
    };
    let orders = match (preprocessed, super::invariants::composes(d)) {
        (true, _) => quote!(orders: &[2, 4, 6, 8, 10], preprocessed: true,),
        (false, true) => TokenStream::new(),
        (false, false) if d.reversible => quote!(orders: &[2],),
        (false, false) => quote!(orders: &[1],),
    };
    let state = item(d, "State");
    quote! {
        impl #bound #name #plain {
            /// The scales of all invariants at a state, for steps of `h`.
            fn scales(&self, state: &#state #plain, h: f64, out: &mut [f64]) {
                #scales
            }

            /// The model as data.
            pub const CARD: Card = Card {
                name: #model_name,
                kebab: #kebab_name,
                doc: #doc,
                source: Self::SOURCE,
                fingerprint: Self::FINGERPRINT,
                summary: #summary,
                solver: #solver,
                #irreversible
                #orders
                parameters: &[#(#p),*],
                initial: &[#(#i),*],
                observables: &[#(#o),*],
                invariants: &[#(#invariants),*],
                discrete_energy: #discrete_energy,
                #solvers
                #dimensions
                ..Card::plain(&open::<Self>, #sized_by)
            };

            #sized
        }
    }
}

/// The discrete energy as data.
fn discrete_energy(d: &Derivation) -> TokenStream {
    let energy = &d.integrability.discrete_energy;
    let formula = super::items::text(d, &energy.value);
    let conserved = format_ident!("{}", if energy.exact { "exact" } else { "bounded" });
    quote!(Invariant::#conserved("discrete_energy", #formula, 1))
}

/// The named sizes of the model, with the values of this card.
fn dimensions(d: &Derivation) -> Vec<TokenStream> {
    let s = &d.letters.symbols;
    let list = d.spec.dimensions.iter().zip(0u16..);
    list.map(|(n, i)| {
        let (name, value) = (&n.name, size(s, crate::expr::shape::Dim::Named(i)));
        let (from, to) = (
            Literal::u64_unsuffixed(n.from),
            Literal::u64_unsuffixed(n.to),
        );
        quote!(Dimension { name: #name, from: #from, to: #to, value: #value })
    })
    .collect()
}

/// The card at other sizes: one match arm per choice of sizes.
fn sized(d: &Derivation) -> TokenStream {
    let name = item(d, "");
    let mut all: Vec<Vec<u64>> = vec![Vec::new()];
    for n in &d.spec.dimensions {
        all = all
            .into_iter()
            .flat_map(|sizes| {
                (n.from..=n.to).map(move |value| {
                    let mut sizes = sizes.clone();
                    sizes.push(value);
                    sizes
                })
            })
            .collect();
    }
    let arms = all.iter().map(|sizes| {
        let sizes: Vec<Literal> = sizes.iter().map(|n| Literal::u64_unsuffixed(*n)).collect();
        quote!([#(#sizes),*] => Some(#name::<#(#sizes,)* f64>::CARD),)
    });
    quote! {
        /// The card of the model at the given sizes, in the order of their declaration.
        fn sized(sizes: &[usize]) -> Option<Card> {
            match sizes {
                #(#arms)*
                _ => None,
            }
        }
    }
}
