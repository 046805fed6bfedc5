//! Emitted code that depends on the group of a configuration: the types of elements and momenta, the coordinates of
//! covectors, bases of the Lie algebra.

use super::sizes::size;
use crate::check::spec::{Configuration, Side};
use crate::derive::Derivation;
use crate::derive::momentum_update::MomentumUpdate;
use crate::expr::shape::Dim;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// How the runtime stores the elements of a group.
pub use crate::groups::ElementStorage as Family;

/// The family of a configuration.
pub fn family(c: &Configuration) -> Family {
    c.group.kept()
}

/// The family of the configuration with this index, which must be an index of the model.
fn of(d: &Derivation, i: usize) -> Family {
    family(&d.spec.configurations[i])
}

/// Whether every configuration is a rotation of space. If so, the emitted code uses 3-vectors only.
pub fn only_rotations(d: &Derivation) -> bool {
    let mut all = d.spec.configurations.iter();
    all.all(|c| family(c) == Family::Rotation)
}

/// The largest value that the model allows for a size.
pub fn largest(d: &Derivation, n: Dim) -> u64 {
    match n {
        Dim::Fixed(n) => u64::from(n),
        Dim::Named(i) => d.spec.dimensions.get(i as usize).map_or(0, |x| x.to),
    }
}

/// The number of coordinates of the Lie algebra, maximised over the sizes that the model allows.
pub fn most_coordinates(d: &Derivation, i: usize) -> u64 {
    match of(d, i) {
        Family::Rotation | Family::Quaternion => 3,
        Family::Coordinates(names) => u64::from(names.coordinates),
        Family::Field(shape) => largest(d, shape.rows).saturating_mul(largest(d, shape.cols)),
        Family::Orthogonal(n) => {
            let n = largest(d, n);
            n.saturating_mul(n.saturating_sub(1)) / 2
        }
        Family::Linear(n) => {
            let n = largest(d, n);
            n.saturating_mul(n)
        }
    }
}

/// The largest number of coordinates of all configurations together, as a literal: the size of work arrays.
pub fn total(d: &Derivation) -> Literal {
    let sum: u64 = (0..d.spec.configurations.len())
        .map(|i| most_coordinates(d, i))
        .sum();
    Literal::usize_unsuffixed(usize::try_from(sum).unwrap_or(usize::MAX))
}

/// The number of coordinates of the Lie algebra, as tokens.
pub fn coordinates(d: &Derivation, i: usize) -> TokenStream {
    let s = &d.letters.symbols;
    match of(d, i) {
        Family::Rotation | Family::Quaternion => quote!(3),
        Family::Coordinates(names) => {
            let n = Literal::u32_unsuffixed(names.coordinates);
            quote!(#n)
        }
        Family::Field(shape) => {
            let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
            quote!((#rows * #cols))
        }
        Family::Orthogonal(Dim::Fixed(_)) | Family::Linear(Dim::Fixed(_)) => {
            let n = Literal::usize_unsuffixed(most_coordinates(d, i) as usize);
            quote!(#n)
        }
        Family::Orthogonal(n) => {
            let n = size(s, n);
            quote!((#n * (#n - 1) / 2))
        }
        Family::Linear(n) => {
            let n = size(s, n);
            quote!((#n * #n))
        }
    }
}

/// The number of coordinates of the preceding configurations, as tokens.
pub fn offset(d: &Derivation, i: usize) -> TokenStream {
    if only_rotations(d) {
        let n = Literal::usize_unsuffixed(3 * i);
        return quote!(#n);
    }
    match i {
        0 => quote!(0),
        _ => {
            let before = (0..i).map(|j| coordinates(d, j));
            quote!(#(#before)+*)
        }
    }
}

/// The type of an element over the scalar `T`.
pub fn ty(d: &Derivation, i: usize) -> TokenStream {
    ty_over(d, i, &quote!(T))
}

/// The type of an element over `scalar`.
pub fn ty_over(d: &Derivation, i: usize, scalar: &TokenStream) -> TokenStream {
    let s = &d.letters.symbols;
    match of(d, i) {
        Family::Rotation => quote!(Rotation<#scalar>),
        Family::Orthogonal(n) => {
            let n = size(s, n);
            quote!(Orthogonal<#n, #scalar>)
        }
        Family::Linear(n) => {
            let n = size(s, n);
            quote!(Linear<#n, #scalar>)
        }
        Family::Quaternion => quote!(UnitQuaternion<#scalar>),
        Family::Coordinates(names) => {
            let name = format_ident!("{}", names.element);
            quote!(#name<#scalar>)
        }
        Family::Field(shape) => {
            let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
            quote!(Additive<#rows, #cols, #scalar>)
        }
    }
}

/// The entries of an element as a slice.
pub fn numbers(d: &Derivation, i: usize, element: TokenStream) -> TokenStream {
    match of(d, i) {
        Family::Rotation => quote!(&#element.quaternion()),
        Family::Orthogonal(_) | Family::Linear(_) | Family::Coordinates(_) | Family::Field(_) => {
            quote!(#element.matrix().as_slice())
        }
        Family::Quaternion => quote!(&#element.components()),
    }
}

/// The value that expressions use for an element: its matrix, or the number of a scalar field.
pub fn matrix(c: &Configuration, element: TokenStream) -> TokenStream {
    match family(c) {
        Family::Field(shape) if shape.is_scalar() => quote!(#element.matrix()[0]),
        _ => quote!(#element.matrix()),
    }
}

/// The value that expressions use for a momentum, given the array that the runtime stores.
pub fn value(c: &Configuration, momentum: TokenStream) -> TokenStream {
    match family(c) {
        Family::Field(shape) if shape.is_scalar() => quote!(#momentum[0]),
        _ => momentum,
    }
}

/// The inverse of [`value`]: the array that the runtime stores for a covector.
pub fn array(c: &Configuration, value: TokenStream) -> TokenStream {
    match family(c) {
        Family::Field(shape) if shape.is_scalar() => quote!(SVector::<T, 1>::new(#value)),
        _ => value,
    }
}

/// The element at the end of an edge, given its velocity on `side`.
pub fn advanced(
    c: &Configuration,
    side: Side,
    element: TokenStream,
    velocity: TokenStream,
) -> TokenStream {
    match family(c) {
        Family::Field(_) => quote!(#element + #velocity),
        _ => {
            let (first, second) = side.ordered(element, velocity);
            quote!(#first * #second)
        }
    }
}

/// The name of the momentum of a configuration in the frame of a side. The momentum of a field has one frame only.
pub fn momentum_field(d: &Derivation, i: usize, side: Side) -> proc_macro2::Ident {
    let base = match of(d, i) {
        Family::Field(_) => "momentum",
        _ => side.of("body_momentum", "spatial_momentum"),
    };
    super::names::per_configuration(d, base, i)
}

/// The method that gives the velocity between two elements.
pub fn velocity_between(c: &Configuration) -> proc_macro2::Ident {
    format_ident!("{}_velocity", c.side.of("body", "spatial"))
}

/// The name of the momentum of a configuration in the space frame.
pub fn spatial_momentum_field(d: &Derivation, i: usize) -> proc_macro2::Ident {
    momentum_field(d, i, Side::Spatial)
}

/// The type of the array in which the runtime stores a covector.
pub fn kept_array(d: &Derivation, i: usize) -> TokenStream {
    let s = &d.letters.symbols;
    match of(d, i) {
        Family::Field(shape) => {
            let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
            quote!(SMatrix<T, #rows, #cols>)
        }
        _ => covector(d, i),
    }
}

/// Whether the state stores the momentum about the body's own origin, in the axes of space. This holds for rigid
/// motions stated in the body.
pub fn about_body(c: &Configuration) -> bool {
    c.side.is_body() && c.group.rigid().is_some()
}

/// Whether the linear momentum of a rigid motion is parallel to its displacement, so that its moment does not change
/// along the edge.
pub fn is_straight(d: &Derivation, i: usize) -> bool {
    matches!(d.carries[i], MomentumUpdate::Through { straight: true, .. })
}

/// Whether the state stores the position of the element in two numbers. A spatial velocity rotates the position about
/// the origin of space, and its momentum is about that origin, so two numbers would not improve it.
pub fn is_placed(c: &Configuration) -> bool {
    about_body(c) || c.group.is_additive()
}

/// The fields of the state for the low-order parts of a position and of a momentum that are stored in two numbers.
pub fn rests(d: &Derivation, i: usize) -> Option<[proc_macro2::Ident; 2]> {
    let kept = is_placed(&d.spec.configurations[i]);
    let names = ["place_rest", "momentum_rest"];
    kept.then(|| names.map(|base| super::names::per_configuration(d, base, i)))
}

/// The type of the low-order part of a position.
pub fn rest_ty(d: &Derivation, i: usize) -> TokenStream {
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[i];
    let (rows, cols) = match (family(c), c.group.rigid()) {
        (_, Some(rigid)) => (size(s, rigid.space()), quote!(1)),
        (Family::Field(shape), None) => (size(s, shape.rows), size(s, shape.cols)),
        (_, None) => (quote!(0), quote!(0)),
    };
    quote!(SMatrix<T, #rows, #cols>)
}

/// The type of a covector.
pub fn covector(d: &Derivation, i: usize) -> TokenStream {
    let s = &d.letters.symbols;
    match of(d, i) {
        Family::Rotation | Family::Quaternion => quote!(SVector<T, 3>),
        Family::Coordinates(names) => {
            let n = Literal::u32_unsuffixed(names.coordinates);
            quote!(SVector<T, #n>)
        }
        Family::Field(shape) => super::expression::ty(s, shape),
        Family::Orthogonal(n) | Family::Linear(n) => {
            let n = size(s, n);
            quote!(SMatrix<T, #n, #n>)
        }
    }
}

/// The name of the type of a momentum in the frame of a side.
pub fn momentum_name(d: &Derivation, i: usize, side: Side) -> TokenStream {
    let frame = side.of("Body", "Spatial");
    let name = match of(d, i) {
        Family::Rotation | Family::Quaternion => format_ident!("{frame}Momentum"),
        Family::Coordinates(names) => format_ident!("{frame}{}", names.momentum),
        Family::Field(_) => format_ident!("FieldMomentum"),
        Family::Orthogonal(_) | Family::Linear(_) => format_ident!("{frame}MomentumMatrix"),
    };
    quote!(#name)
}

/// The name of the type of the momentum that the state stores.
pub fn kept_name(d: &Derivation, i: usize) -> TokenStream {
    let c = &d.spec.configurations[i];
    match (about_body(c), family(c)) {
        (true, Family::Coordinates(names)) => {
            let name = format_ident!("Carried{}", names.momentum);
            quote!(#name)
        }
        _ => momentum_name(d, i, Side::Spatial),
    }
}

/// The type of the momentum that the state stores.
pub fn kept(d: &Derivation, i: usize) -> TokenStream {
    match about_body(&d.spec.configurations[i]) {
        true => {
            let name = kept_name(d, i);
            quote!(#name<T>)
        }
        false => momentum(d, i, Side::Spatial),
    }
}

/// The type of a momentum in the frame of a side.
pub fn momentum(d: &Derivation, i: usize, side: Side) -> TokenStream {
    let s = &d.letters.symbols;
    let name = momentum_name(d, i, side);
    match of(d, i) {
        Family::Rotation | Family::Quaternion | Family::Coordinates(_) => quote!(#name<T>),
        Family::Field(shape) => {
            let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
            quote!(#name<#rows, #cols, T>)
        }
        Family::Orthogonal(n) | Family::Linear(n) => {
            let n = size(s, n);
            quote!(#name<#n, T>)
        }
    }
}

/// The basis element of the Lie algebra with this index.
pub fn basis(d: &Derivation, i: usize, index: TokenStream) -> TokenStream {
    let s = &d.letters.symbols;
    match of(d, i) {
        Family::Rotation => quote!(basis::<T>(#index)),
        Family::Orthogonal(n) => {
            let n = size(s, n);
            quote!(skew_basis::<T, #n>(#index))
        }
        Family::Linear(n) => {
            let n = size(s, n);
            quote!(matrix_basis::<T, #n>(#index))
        }
        Family::Quaternion => quote!(unit::<T, 3>(#index)),
        Family::Coordinates(names) => {
            let n = Literal::u32_unsuffixed(names.coordinates);
            quote!(unit::<T, #n>(#index))
        }
        Family::Field(shape) if shape.is_scalar() => quote!(T::one()),
        Family::Field(shape) => {
            let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
            quote!(array_basis::<T, #rows, #cols>(#index))
        }
    }
}

/// Zero of a shape.
pub fn zero(d: &Derivation, shape: crate::expr::shape::Shape) -> TokenStream {
    if shape.is_scalar() {
        return quote!(T::zero());
    }
    let s = &d.letters.symbols;
    let (rows, cols) = (size(s, shape.rows), size(s, shape.cols));
    quote!(SMatrix::<T, #rows, #cols>::zeros())
}

/// The zero covector.
pub fn nothing(d: &Derivation, i: usize) -> TokenStream {
    match of(d, i) {
        Family::Field(shape) => zero(d, shape),
        _ => zero(d, d.letters.symbols.get(d.letters.node_momentum[i]).shape),
    }
}

/// Elements or covectors of all configurations: an array if their types agree, otherwise a tuple.
pub struct Bundle {
    count: usize,
    array: bool,
}

impl Bundle {
    /// The bundle of a model.
    pub fn of(d: &Derivation) -> Bundle {
        let list = &d.spec.configurations;
        Bundle {
            count: list.len(),
            array: list.windows(2).all(|w| family(&w[0]) == family(&w[1])),
        }
    }

    /// The type, given the types of its parts.
    pub fn ty(&self, parts: &[TokenStream]) -> TokenStream {
        let count = Literal::usize_unsuffixed(self.count);
        match (self.array, parts.first()) {
            (true, Some(first)) => quote!([#first; #count]),
            _ => quote!((#(#parts,)*)),
        }
    }

    /// The value, given its parts.
    pub fn value(&self, parts: &[TokenStream]) -> TokenStream {
        match self.array {
            true => quote!([#(#parts),*]),
            false => quote!((#(#parts,)*)),
        }
    }

    /// The part with index `i`.
    pub fn part(&self, bundle: TokenStream, i: usize) -> TokenStream {
        let i = Literal::usize_unsuffixed(i);
        match self.array {
            true => quote!(#bundle[#i]),
            false => quote!(#bundle.#i),
        }
    }
}

/// The type of the covectors of all configurations.
pub fn covectors(d: &Derivation) -> TokenStream {
    let parts: Vec<TokenStream> = (0..d.spec.configurations.len())
        .map(|i| covector(d, i))
        .collect();
    Bundle::of(d).ty(&parts)
}

/// The coordinates of all covectors, one configuration after another. `values` are the values of the covectors.
pub fn stacked(d: &Derivation, values: &[TokenStream]) -> TokenStream {
    let bundle = Bundle::of(d);
    let (dimension, covectors, value) = (total(d), covectors(d), bundle.value(values));
    if let [only] = values {
        match of(d, 0) {
            Family::Rotation | Family::Quaternion | Family::Coordinates(_) => return only.clone(),
            Family::Field(shape) if shape.is_scalar() => return quote!(SVector::<T, 1>::new(#only)),
            Family::Field(shape) if shape.is_vector() && matches!(shape.rows, Dim::Fixed(_)) => {
                return only.clone();
            }
            _ => {}
        }
    }
    if only_rotations(d) {
        return quote!({
            let parts: #covectors = #value;
            SVector::<T, #dimension>::from_fn(|i, _| parts[i / 3][i % 3])
        });
    }
    let puts = (0..values.len()).map(|i| {
        let part = bundle.part(quote!(parts), i);
        let put = match of(d, i) {
            Family::Rotation | Family::Quaternion | Family::Coordinates(_) => quote!(put_vector),
            Family::Orthogonal(_) => quote!(put_skew),
            Family::Field(shape) if shape.is_scalar() => quote!(put_number),
            Family::Linear(_) | Family::Field(_) => quote!(put_matrix),
        };
        quote!(let rest = #put(rest, &#part);)
    });
    quote!({
        let parts: #covectors = #value;
        let mut all = SVector::<T, #dimension>::zeros();
        let rest = all.as_mut_slice();
        #(#puts)*
        let _ = rest;
        all
    })
}
