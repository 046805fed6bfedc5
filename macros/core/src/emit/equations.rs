//! The equations that Newton's method solves: residual and tangent of one step at a trial. Takes the derived momenta
//! of the outgoing edge; gives the code of both. If all groups act on 3-space, the code uses vectors and 3x3 blocks,
//! otherwise coordinates and columns.

use super::element::{self, Bundle, stacked};
use super::expression::{Bindings, program};
use super::items::letters_of;
use super::names::{Names, variable};
use super::precomputed_values::{PrecomputedValues, stated};
use super::step::at;
use crate::check::spec::Side;
use crate::derive::parts::{Parts, Velocity};
use crate::derive::schur_reduction::SchurReduction;
use crate::derive::tangent::Direction;
use crate::derive::{Derivation, lie};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// The context of the equations.
pub(super) struct Equations<'a> {
    /// The model.
    pub d: &'a Derivation,
    /// The model's names.
    pub names: &'a Names,
    /// The locals of the quantities known at the node.
    pub bindings: &'a Bindings,
    /// The local of the trial.
    pub trial: &'a Ident,
    /// The local of the node momenta.
    pub momenta: &'a Ident,
    /// The unknowns that are eliminated before the iteration, and the fields of the model with the inverses for that.
    pub eliminated: Option<&'a (SchurReduction, Vec<(Expr, Ident)>)>,
}

/// The equations as code.
pub(super) struct EquationCode {
    /// The statements that residual and tangent share.
    pub at_trial: TokenStream,
    /// The residual, as the body of a block.
    pub residual: TokenStream,
    /// The residual of all equations at zero velocity, as the body of a block.
    pub at_rest: TokenStream,
    /// The tangent, as the body of a block.
    pub tangent: TokenStream,
    /// The side on which the tangent perturbs the velocity.
    pub side: Side,
    /// Whether the tangent is multiplied by the step size.
    pub times_step: bool,
    /// Residual and tangent on the body side, without the factor of the step size, and without precomputed values.
    pub alone: SeparateEquations,
    /// The type of the node momenta together, over `T`.
    pub momenta: TokenStream,
    /// The node momenta, with `change` applied to every number.
    pub momenta_over: TokenStream,
    /// How to complete a trial, if residual and tangent cover a part of it only.
    pub part: Option<Part>,
    /// The values computed at the node before the loop, for the code after the solution.
    pub computed: Option<(schedule::Program, Bindings)>,
}

/// A trial whose translations are eliminated.
pub(super) struct Part {
    /// The statements that bind the velocities and the trial, given its rotations.
    pub at_trial: TokenStream,
    /// The body of a function that computes the whole trial.
    pub alone: TokenStream,
    /// The components of the whole residual that remain.
    pub rows: Vec<usize>,
}

/// The shape of a 3-vector.
const THREE: Shape = Shape::vector(Dim::Fixed(3));

/// The local with the rotations of a trial whose translations are eliminated.
pub(super) const TURNED: &str = "turned";

/// The equations in parts of three components, if all groups act on 3-space.
fn by_parts(d: &Derivation, list: &[Expr]) -> Option<(Parts, Vec<Expr>)> {
    let parts = Parts::of(&d.spec, &d.letters)?;
    let s = &parts.symbols;
    let list: Option<Vec<Expr>> = parts
        .covectors(list)
        .iter()
        .map(|e| parts.write(&schedule::by_imaginary(s, &schedule::displaced(s, e))))
        .collect();
    let list = list?.iter().map(|e| expr::factored(s, e)).collect();
    Some((parts, list))
}

/// The 3x3 blocks of the tangent, row by row, multiplied by `unit`; every velocity is perturbed on `side`.
fn blocks_of(parts: &Parts, list: &[Expr], side: Side, unit: &Expr) -> Option<Vec<Expr>> {
    let s = &parts.symbols;
    let direction = Direction {
        symbols: s,
        letter: parts.direction,
    };
    let mut blocks: Vec<Expr> = Vec::new();
    for e in list {
        for change in parts.changes(side) {
            let derivative = expr::directional(s, e, &change);
            let derivative = expr::mul(unit.clone(), derivative);
            let derivative = expr::collect(s, &derivative);
            blocks.push(expr::factored(s, &direction.matrix(&derivative)?));
        }
    }
    Some(blocks)
}

/// The unknowns that can be eliminated from the equations `list`. None unless the tangent is the same at every node,
/// so that the proof of the principal root needs one tangent only.
pub(super) fn eliminated(d: &Derivation, list: &[Expr]) -> Option<SchurReduction> {
    let moves = |c: &crate::check::spec::Configuration| c.group.rigid().is_some();
    if !d.spec.configurations.iter().any(moves) {
        return None;
    }
    let (parts, list) = by_parts(d, list)?;
    let found = SchurReduction::of(&parts, &list)?;
    let blocks = blocks_of(&parts, &list, Side::Body, &expr::integer(1))?;
    at_the_node(&parts.symbols, &blocks)
        .is_empty()
        .then_some(found)
}

/// Residual and tangent as functions of their own, and the values at the node that both need.
pub(super) struct SeparateEquations {
    /// The residual, as the body of a block.
    pub residual: TokenStream,
    /// The tangent, as the body of a block.
    pub tangent: TokenStream,
    /// Elements and quantities at the node that both functions need.
    pub given: Vec<Letter>,
}

impl Equations<'_> {
    /// The statement that binds the node momenta, and the equations. `list` is the derived momenta, `node` the values
    /// of the node momenta.
    pub fn write(&self, list: &[Expr], node: &[TokenStream]) -> (TokenStream, EquationCode) {
        self.in_blocks(list, node)
            .unwrap_or_else(|| self.in_columns(list, node))
    }

    /// The equations in 3x3 blocks. None if a group has other coordinates, or if no rule gives the tangent.
    fn in_blocks(
        &self,
        list: &[Expr],
        node: &[TokenStream],
    ) -> Option<(TokenStream, EquationCode)> {
        let (d, trial, mu) = (self.d, self.trial, self.momenta);
        let (parts, list) = by_parts(d, list)?;
        let eliminated = self.eliminated.map(|(found, _)| found);
        let s = eliminated.map_or(&parts.symbols, |found| &found.symbols);
        let one = expr::integer(1);
        let simpler =
            |list: &[Expr]| -> Vec<Expr> { list.iter().map(|e| expr::simpler(s, e)).collect() };
        let whole = simpler(&blocks_of(&parts, &list, Side::Body, &one)?);
        let blocks_from = |side: Side, unit: &Expr| {
            let blocks = blocks_of(&parts, &list, side, unit)?;
            let Some(found) = eliminated else {
                return Some(simpler(&blocks));
            };
            let along = blocks_of(&parts, &list, Side::Spatial, unit)?;
            Some(found.tangent(&blocks, &along, side))
        };
        let blocks = blocks_from(Side::Body, &one)?;
        let step = expr::here(s, d.spec.step);
        // Equivalent forms of the tangent; the loop uses the one with the least work. If a model is stated in space,
        // its velocities are corrected in the body: corrections in space gave positions far from the origin a few
        // more rounding errors in free fall.
        let in_bodies = d.spec.configurations.iter().all(|c| c.side.is_body());
        let others = [
            (Side::Body, true),
            (Side::Spatial, false),
            (Side::Spatial, true),
        ]
        .into_iter()
        .filter(|_| in_bodies)
        .filter_map(|(side, times_step)| {
            let unit = if times_step { &step } else { &one };
            Some((side, times_step, blocks_from(side, unit)?))
        });
        let bundle = Bundle::of(d);
        let mut velocities = TokenStream::new();
        let mut rest: Vec<(Letter, Expr)> = Vec::new();
        let mut rests = |id: SymbolId, e: Expr| rest.push((at(id, Shift::HERE), e));
        let (unmoved, upright) = (expr::zero(THREE), expr::identity(THREE.rows));
        let mut known = TokenStream::new();
        let mut given = Vec::new();
        for (i, (v, value)) in parts.velocities.iter().zip(node).enumerate() {
            let part = bundle.part(quote!(#trial), i);
            let name = |id| variable(s, id);
            match v {
                Velocity::Rotation(w) => {
                    rests(*w, upright.clone());
                    let w = name(*w);
                    velocities.extend(quote!(let #w = #part.matrix();));
                    given.push(value.clone());
                }
                Velocity::Quaternion(re, im) => {
                    rests(*re, expr::integer(1));
                    rests(*im, unmoved.clone());
                    let (re, im) = (name(*re), name(*im));
                    velocities.extend(quote!(let (#re, #im) = (#part.real(), #part.imaginary());));
                    given.push(value.clone());
                }
                Velocity::Motion(rot, pos) => {
                    rests(*rot, upright.clone());
                    rests(*pos, unmoved.clone());
                    let (rot, pos) = (name(*rot), name(*pos));
                    velocities.extend(
                        quote!(let (#rot, #pos) = (#part.rotation.matrix(), #part.translation);),
                    );
                    let both = self.names.local(&match i {
                        0 => "momenta_six".to_owned(),
                        _ => format!("momenta_six_{i}"),
                    });
                    known.extend(quote!(let #both = #value;));
                    given.extend([
                        quote!(rows_from::<T, 6, 3, 1>(&#both, 0)),
                        quote!(rows_from::<T, 6, 3, 1>(&#both, 3)),
                    ]);
                }
            }
        }
        let count = Literal::usize_unsuffixed(given.len());
        known.extend(quote!(let #mu: [SVector<T, 3>; #count] = [#(#given),*];));
        let mut before = std::mem::take(&mut known);
        let momenta: Vec<TokenStream> = (0..given.len())
            .map(|i| {
                let i = Literal::usize_unsuffixed(i);
                quote!(#mu[#i])
            })
            .collect();
        let all: Vec<usize> = (0..given.len()).collect();
        let sizes = |n: usize| [n, 3 * n].map(Literal::usize_unsuffixed);
        let residual_of = |values: &[TokenStream], rows: &[usize], lets: TokenStream| {
            let own = rows.iter().map(|i| &momenta[*i]);
            let rows: Vec<TokenStream> = (values.iter().zip(own))
                .map(|(value, own)| quote!((#value) - #own))
                .collect();
            let [count, total] = sizes(rows.len());
            match rows.as_slice() {
                [only] => quote!(#lets #only),
                rows => quote!(#lets joined::<T, #count, #total>(&[#(#rows),*])),
            }
        };
        let tangent_of = |values: &[TokenStream], lets: TokenStream| match values {
            [only] => quote!(#lets #only),
            _ => {
                let n = values.len().isqrt();
                let [count, total] = sizes(n);
                let rows = values.chunks(n).map(|row| quote!([#(#row),*]));
                quote!(#lets assembled::<T, #count, #total>(&[#(#rows),*]))
            }
        };
        let alone = {
            let list = simpler(&list);
            let p = schedule::program(s, &list, "t");
            let (lets, values) = program(&p, self.bindings);
            let residual = residual_of(&values, &all, lets);
            let p = schedule::program(s, &whole, "t");
            let (lets, values) = program(&p, self.bindings);
            SeparateEquations {
                residual,
                tangent: tangent_of(&values, lets),
                given: at_the_node(s, list.iter().chain(&whole)),
            }
        };
        let at_rest = simpler(&substituted(s, &list, &rest));
        let left = eliminated.map_or(all.clone(), |found| found.left(all.len()));
        let written = |e: &Expr| eliminated.map_or(e.clone(), |found| found.written(e));
        let list: Vec<Expr> = left.iter().map(|i| written(&list[*i])).collect();
        let list = simpler(&list);
        let varies = |l| parts.varies(l) || eliminated.is_some_and(|found| found.varies(l));
        let mut at_node = schedule::LoopInvariants::new(s, &varies, "k");
        let (side, times_step, blocks) = {
            // Values computed before the loop add little work.
            let cost = |blocks: &[Expr]| {
                let mut known = schedule::LoopInvariants::new(s, &varies, "k");
                let all = list.iter().chain(blocks).map(|e| known.apart(e));
                let all: Vec<Expr> = all.collect();
                schedule::work(&schedule::program(&known.symbols, &all, "t"))
            };
            let mut least = cost(&blocks);
            let mut chosen = (Side::Body, false, blocks);
            for other in others {
                let own = cost(&other.2);
                if own < least {
                    (chosen, least) = (other, own);
                }
            }
            chosen
        };
        let list: Vec<Expr> = list.iter().map(|e| at_node.apart(e)).collect();
        let blocks: Vec<Expr> = blocks.iter().map(|e| at_node.apart(e)).collect();
        let at_rest: Vec<Expr> = at_rest.iter().map(|e| at_node.apart(e)).collect();
        let steps = eliminated.map_or_else(Vec::new, |found| found.steps());
        let apart = steps.iter().map(|(id, e)| (*id, at_node.apart(e)));
        let apart: Vec<(SymbolId, Expr)> = apart.collect();
        // The model stores the inverses of constants.
        let kept = |e: &Expr| {
            let Node::Inverse(a) = e.node() else {
                return None;
            };
            let (_, fields) = self.eliminated?;
            fields
                .iter()
                .find(|(of, _)| of == a)
                .map(|(_, field)| field)
        };
        for (name, value) in &at_node.values {
            if let Some(field) = kept(value) {
                let name = variable(&at_node.symbols, *name);
                known.extend(quote!(let #name = self.#field;));
            }
        }
        at_node.values.retain(|(_, value)| kept(value).is_none());
        let s = &at_node.symbols;
        let PrecomputedValues {
            statements,
            bindings,
            ..
        } = stated(s, at_node.values, "s", self.bindings);
        known.extend(statements);
        let p = schedule::program(s, &list, "t");
        let (lets, values) = program(&p, &bindings);
        let residual = residual_of(&values, &left, lets);
        let p = schedule::program(s, &at_rest, "t");
        let (lets, values) = program(&p, &bindings);
        let at_rest = residual_of(&values, &all, lets);
        let p = schedule::program(s, &blocks, "t");
        let (lets, values) = program(&p, &bindings);
        let tangent = tangent_of(&values, lets);
        let part = eliminated.map(|found| {
            let here = self.completed(found, s, &apart, &blocks, &bindings);
            let alone = self.completed(found, s, &steps, &[], self.bindings);
            let trial_is = bundle.value(&self.wholes(found));
            let momenta = found.places.iter().map(|p| {
                let (name, own) = (variable(s, p.momentum), &momenta[p.block]);
                quote!(let #name = #own;)
            });
            let momenta: TokenStream = momenta.collect();
            before.extend(momenta.clone());
            Part {
                at_trial: quote!(#here let #trial = #trial_is;),
                alone: quote!(#momenta #alone #trial_is),
                rows: left.iter().flat_map(|i| 3 * i..3 * i + 3).collect(),
            }
        });
        before.extend(known);
        let known = before;
        Some((
            known,
            EquationCode {
                at_trial: velocities,
                residual,
                at_rest,
                tangent,
                side,
                times_step,
                alone,
                momenta: quote!([SVector<T, 3>; #count]),
                momenta_over: quote!(#mu.map(|part| part.over(change))),
                part,
                computed: None,
            },
        ))
    }

    /// The translations of a trial, given its rotations. `others` are further expressions that may need Rodrigues
    /// vectors.
    fn completed(
        &self,
        found: &SchurReduction,
        s: &Symbols,
        steps: &[(SymbolId, Expr)],
        others: &[Expr],
        bindings: &Bindings,
    ) -> TokenStream {
        let turned = Ident::new(TURNED, proc_macro2::Span::call_site());
        let mut out = TokenStream::new();
        let asked = |id: SymbolId, others: &[Expr]| {
            let letter = at(id, Shift::HERE);
            let mut all = steps.iter().map(|(_, e)| e).chain(others);
            all.any(|e| expr::contains(e, letter))
        };
        for (i, (w, turn)) in found.rotations.iter().zip(&found.turns).enumerate() {
            let i = Literal::usize_unsuffixed(i);
            if asked(*w, &[]) {
                let w = variable(s, *w);
                out.extend(quote!(let #w = #turned[#i].matrix();));
            }
            if asked(*turn, others) {
                let turn = variable(s, *turn);
                out.extend(quote!(let #turn = #turned[#i].rodrigues();));
            }
        }
        for (name, value) in steps {
            let name = variable(s, *name);
            let p = schedule::program(s, std::slice::from_ref(value), "t");
            let (lets, values) = program(&p, bindings);
            out.extend(match lets.is_empty() {
                true => quote!(#(let #name = #values;)*),
                false => quote!(let #name = { #lets #(#values)* };),
            });
        }
        out
    }

    /// The velocities of a trial, once its translations are known.
    fn wholes(&self, found: &SchurReduction) -> Vec<TokenStream> {
        let turned = Ident::new(TURNED, proc_macro2::Span::call_site());
        let each = (0..found.rotations.len()).map(|i| {
            let at = Literal::usize_unsuffixed(i);
            match found.places.iter().find(|p| p.velocity == i) {
                Some(p) => {
                    let x = p.steps.last().map(|(x, _)| variable(&found.symbols, *x));
                    quote!(rigid_motion(#turned[#at], #x))
                }
                None => quote!(#turned[#at]),
            }
        });
        each.collect()
    }

    /// The columns of the tangent for the velocity of configuration `j`. `values` are the derivatives along its
    /// direction.
    fn columns(&self, j: usize, lets: TokenStream, values: &[TokenStream]) -> TokenStream {
        let d = self.d;
        let eta = variable(&d.letters.symbols, d.letters.direction[j]);
        let column = if j == 0 {
            quote!(axis)
        } else {
            let offset = element::offset(d, j);
            quote!(#offset + axis)
        };
        let (directions, basis) = (
            element::coordinates(d, j),
            element::basis(d, j, quote!(axis)),
        );
        let stacked = stacked(d, values);
        quote! {
            for axis in 0..#directions {
                let #eta = #basis;
                #lets
                let along = #stacked;
                matrix.set_column(#column, &along);
            }
        }
    }

    /// The equations in coordinates, with one column of the tangent per coordinate.
    fn in_columns(&self, list: &[Expr], node: &[TokenStream]) -> (TokenStream, EquationCode) {
        let (d, trial, mu) = (self.d, self.trial, self.momenta);
        let s = &d.letters.symbols;
        let bodies = d.spec.configurations.len();
        let dimension = element::total(d);
        let bundle = Bundle::of(d);
        let covectors = element::covectors(d);
        let velocities: TokenStream = (0..bodies)
            .map(|i| {
                let c = &d.spec.configurations[i];
                let w = variable(s, c.velocity);
                let matrix = element::matrix(c, bundle.part(quote!(#trial), i));
                quote!(let #w = #matrix;)
            })
            .collect();
        let rest = d.spec.configurations.iter().map(|c| {
            let shape = s.get(c.velocity).shape;
            let rest = match c.group.is_additive() {
                true => expr::zero(shape),
                false => expr::identity(shape.rows),
            };
            (at(c.velocity, Shift::HERE), rest)
        });
        let rest: Vec<(Letter, Expr)> = rest.collect();
        let node = bundle.value(node);
        let known = quote!(let #mu: #covectors = #node;);
        let momenta: Vec<TokenStream> = (0..bodies).map(|i| bundle.part(quote!(#mu), i)).collect();
        let list: Vec<Expr> = list.iter().map(|e| schedule::displaced(s, e)).collect();
        let list = list.as_slice();
        let residual_of = |s: &Symbols, list: &[Expr], bindings: &Bindings| {
            let p = schedule::program(s, list, "t");
            let (lets, values) = program(&p, bindings);
            let parts: Vec<TokenStream> = values
                .iter()
                .zip(&momenta)
                .map(|(value, own)| quote!((#value) - #own))
                .collect();
            let stacked = stacked(d, &parts);
            quote!(#lets #stacked)
        };
        // The derivative along Ω η, for every basis element η of every velocity.
        let derived: Vec<Vec<Expr>> = (0..bodies)
            .map(|j| {
                let c = &d.spec.configurations[j];
                let along = lie::element(s, c.group, d.letters.direction[j]);
                let change = c.group.moved(Side::Body, expr::here(s, c.velocity), along);
                let along = [(at(c.velocity, Shift::HERE), change)];
                list.iter()
                    .map(|m| expr::directional(s, m, &along))
                    .collect()
            })
            .collect();
        let tangent_of = |s: &Symbols, derived: &[Vec<Expr>], bindings: &Bindings| {
            let columns = derived.iter().enumerate().map(|(j, derivatives)| {
                let p = schedule::program(s, derivatives, "t");
                let (lets, values) = program(&p, bindings);
                self.columns(j, lets, &values)
            });
            let columns: TokenStream = columns.collect();
            quote! {
                let mut matrix = SMatrix::<T, #dimension, #dimension>::zeros();
                #columns
                matrix
            }
        };
        // In the loop, values at the node are computed beforehand, and values at the trial once for all columns.
        let is_velocity = |l: Letter| d.spec.configurations.iter().any(|c| c.velocity == l.symbol);
        let along = |l: Letter| d.letters.direction.contains(&l.symbol);
        let varies = |l: Letter| is_velocity(l) || along(l);
        let mut at_node = schedule::LoopInvariants::new(s, &varies, "k");
        let apart: Vec<Expr> = list.iter().map(|e| at_node.apart(e)).collect();
        let derived_apart = columns_apart(&mut at_node, &derived);
        let at_rest = substituted(s, list, &rest);
        let at_rest = at_rest.iter().map(|e| expr::simpler(s, e));
        let at_rest: Vec<Expr> = at_rest.map(|e| at_node.apart(&e)).collect();
        let (symbols, values) = (at_node.symbols, at_node.values);
        let mut at_trial = schedule::LoopInvariants::new(&symbols, &along, "c");
        let of_columns = columns_apart(&mut at_trial, &derived_apart);
        let before = stated(&symbols, values, "s", self.bindings);
        let statements = before.statements;
        let known = quote!(#known #statements);
        let residual = residual_of(&symbols, &apart, &before.bindings);
        let at_rest = residual_of(&symbols, &at_rest, &before.bindings);
        let once = stated(&at_trial.symbols, at_trial.values, "m", &before.bindings);
        let columns = tangent_of(&at_trial.symbols, &of_columns, &once.bindings);
        let once = once.statements;
        let tangent = quote!(#once #columns);
        let mut at_trial = schedule::LoopInvariants::new(s, &along, "c");
        let of_columns = columns_apart(&mut at_trial, &derived);
        let once = stated(&at_trial.symbols, at_trial.values, "m", self.bindings);
        let columns = tangent_of(&at_trial.symbols, &of_columns, &once.bindings);
        let once = once.statements;
        let alone_tangent = quote!(#once #columns);
        let over: Vec<TokenStream> = momenta.iter().map(|m| quote!(#m.over(change))).collect();
        let alone = SeparateEquations {
            residual: residual_of(s, list, self.bindings),
            tangent: alone_tangent,
            given: at_the_node(s, list.iter().chain(derived.iter().flatten())),
        };
        (
            known,
            EquationCode {
                at_trial: velocities,
                residual,
                at_rest,
                tangent,
                side: Side::Body,
                times_step: false,
                alone,
                momenta: covectors,
                momenta_over: bundle.value(&over),
                part: None,
                computed: Some((before.computed, before.bindings)),
            },
        )
    }
}

/// The equations of every column, with known subexpressions replaced by names.
fn columns_apart(known: &mut schedule::LoopInvariants, columns: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    let mut all = Vec::with_capacity(columns.len());
    for column in columns {
        all.push(column.iter().map(|e| known.apart(e)).collect());
    }
    all
}

/// The expressions after a substitution of letters.
fn substituted(s: &Symbols, list: &[Expr], by: &[(Letter, Expr)]) -> Vec<Expr> {
    let mut all = Vec::with_capacity(list.len());
    for e in list {
        all.push(expr::substitute(s, e, by));
    }
    all
}

/// The letters of elements and advected quantities in `list`.
fn at_the_node<'e>(s: &Symbols, list: impl IntoIterator<Item = &'e Expr>) -> Vec<Letter> {
    let at_node = |l: &Letter| matches!(s.get(l.symbol).role, Role::Element | Role::Advected);
    letters_of(list).into_iter().filter(at_node).collect()
}
