//! The equations of velocities that Newton's method finds together: residual and tangent are both derived. Takes the
//! derivation and the unknowns, which are the whole model or a block of it; gives the loop of the solver and its
//! functions, and the step if the block is the whole model.

use super::blocks::Inverse;
use super::element::{self, Bundle, Family, family};
use super::equations::{self, Equations, TURNED};
use super::expression::{Bindings, program};
use super::items::{advanced, letters_of, parameter_locals, with_transports};
use super::names::{Names, item, own, tagged, variable};
use super::principal::Principal;
use super::sizes::Generics;
use super::step::{AtTheStart, at, finish, here, node_momentum, step_signature};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::convex::convexity;
use crate::derive::schur_reduction::SchurReduction;
use crate::derive::seen_from_body::outgoing;
use crate::derive::spatial_increment_form::SpatialIncrementForm;
use crate::expr::{Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The unknowns that Newton's method finds together.
pub(super) struct JointUnknowns<'a> {
    /// The model.
    pub whole: &'a Derivation,
    /// The unknowns as a model of their own; the model itself if it is a single block.
    pub block: &'a Derivation,
    /// The indices of their configurations in the model.
    pub members: &'a [usize],
    /// The number of the block, starting at 1, if there are several.
    pub number: Option<usize>,
    /// The names of the model.
    pub names: &'a Names,
}

/// The code of the solver.
pub(super) struct Loop {
    /// The statements that compute the values known at the node.
    pub known: TokenStream,
    /// The computed values as a program with its bindings, for the code after the solution.
    pub computed: Option<(schedule::Program, Bindings)>,
    /// An expression that gives the solution or returns an error.
    pub solve: TokenStream,
    /// The functions of the stepper that the loop calls.
    pub functions: TokenStream,
}

impl JointUnknowns<'_> {
    /// A name of the block: the name in a model of one block, followed by the number of this block.
    pub fn name(&self, base: &str) -> Ident {
        match self.number {
            Some(n) => self.names.local(&format!("{base}_{n}")),
            None => format_ident!("{base}"),
        }
    }

    /// The type of all velocities together.
    pub fn elements(&self) -> TokenStream {
        let d = self.block;
        let count = d.spec.configurations.len();
        let types: Vec<TokenStream> = (0..count).map(|i| element::ty(d, i)).collect();
        Bundle::of(d).ty(&types)
    }

    /// The unknowns that are eliminated beforehand, and the fields of the model with the inverses for that.
    pub fn eliminated(&self) -> Option<(SchurReduction, Vec<(Expr, Ident)>)> {
        let found = equations::eliminated(self.block, &self.momenta())?;
        let mut constants: Vec<Expr> = Vec::new();
        for a in found.places.iter().flat_map(|p| p.constants()) {
            if !constants.contains(a) {
                constants.push(a.clone());
            }
        }
        let named = constants.into_iter().enumerate();
        let named = named.map(|(i, a)| (a, self.name(&format!("inverse_{}", i + 1))));
        let named = named.collect();
        Some((found, named))
    }

    /// The type and dimension of the unknowns of Newton's method, then of all velocities: the parameters of the
    /// search type after its scalar.
    fn kinds(&self, eliminated: Option<&SchurReduction>) -> TokenStream {
        let elements = self.elements();
        let dimension = element::total(self.block);
        match eliminated {
            Some(found) => {
                let count = found.rotations.len();
                let [count, part] = [count, 3 * count].map(Literal::usize_unsuffixed);
                quote!([Rotation<T>; #count], #part, #elements, #dimension)
            }
            None => quote!(#elements, #dimension),
        }
    }

    /// The type of the search, which extrapolates from step to step.
    pub fn search_type(&self) -> TokenStream {
        let eliminated = self.eliminated();
        let kinds = self.kinds(eliminated.as_ref().map(|(found, _)| found));
        quote!(newton::Search<T, #kinds>)
    }

    /// The side on which the velocity is found.
    pub fn side(&self, i: usize) -> Side {
        let c = &self.block.spec.configurations[i];
        let turned = self.block.solve.seen_from_body.is_some() && !c.group.is_additive();
        if turned { Side::Body } else { c.side }
    }

    /// The momenta of the outgoing edge in the equations.
    pub fn momenta(&self) -> Vec<Expr> {
        let d = self.block;
        match &d.solve.seen_from_body {
            Some(list) => list.clone(),
            None => outgoing(&d.spec, &d.letters, &d.balances),
        }
    }

    /// The letters at the node that the equations need.
    pub fn needed(&self) -> Vec<Letter> {
        let mut needed = letters_of(&self.momenta());
        for (i, c) in self.block.spec.configurations.iter().enumerate() {
            if self.side(i).is_body() && family(c) == Family::Rotation {
                needed.push(at(c.element, Shift::HERE));
            }
        }
        needed
    }

    /// One velocity of a solution.
    pub fn part(&self, solution: TokenStream, i: usize) -> TokenStream {
        Bundle::of(self.block).part(solution, i)
    }

    /// Locals for the matrices of the velocities in the frames in which the model states them; binds their names in
    /// `after`.
    pub fn matrices(&self, solved: &Ident, after: &mut Bindings) -> TokenStream {
        let d = self.whole;
        let mut out = TokenStream::new();
        for (i, c) in self.block.spec.configurations.iter().enumerate() {
            let name = tagged(d, self.names, c.velocity, "matrix");
            after.bind(at(c.velocity, Shift::HERE), name.clone());
            let part = self.part(quote!(#solved), i);
            let stated = element::matrix(c, part.clone());
            out.extend(match self.side(i) == c.side {
                true => quote!(let #name = #stated;),
                false => {
                    let own = own(d, c.element);
                    quote!(let #name = (state.#own * #part * state.#own.inverse()).matrix();)
                }
            });
        }
        out
    }

    /// If the action is convex in the velocities, the root is unique. Gives the local with that result, and the
    /// condition as a further alternative.
    fn convex(&self, bindings: &Bindings) -> (TokenStream, TokenStream) {
        let d = self.block;
        let s = &d.letters.symbols;
        let Some(found) = convexity(&d.spec, s, &d.action) else {
            return Default::default();
        };
        let weights: Vec<Expr> = found.all().cloned().collect();
        let p = schedule::program(s, &weights, "w");
        let (lets, values) = program(&p, bindings);
        let positive = found.positive.len();
        let tests = values
            .iter()
            .enumerate()
            .map(|(i, value)| match i < positive {
                true => quote!((#value).least() > 0.0),
                false => quote!((#value).least() >= 0.0),
            });
        let convex = self.names.local("convex");
        let decided = quote! {
            let #convex = { #lets #(#tests)&&* };
        };
        (decided, quote!(#convex ||))
    }

    /// The code. `bindings` contains the values at the node; `search` is the field of the workspace; `tried` is the
    /// workspace of a trial step `h` with a given `search`.
    pub fn code(&self, bindings: &Bindings, search: &Ident, tried: &TokenStream) -> Loop {
        let (d, names) = (self.block, self.names);
        let s = &d.letters.symbols;
        let elements = self.elements();
        let used = Generics::of(d).used();
        let state = item(d, "State");
        let node = names.local("node");
        let step = variable(s, d.spec.step);
        let [trial, mu, newton] = ["trial", "momenta", "iteration"].map(|base| names.local(base));
        let [lane, ended, solved] = ["lane", "ended", "solved"].map(|base| names.local(base));
        let [residual_at, settled, principal, refused, rounding] =
            ["residual_at", "settled", "principal", "refused", "rounding"].map(|f| self.name(f));
        let [tangent_at, completed_at] = ["tangent_at", "completed_at"].map(|f| self.name(f));
        let node_momenta: Vec<TokenStream> = (0..d.spec.configurations.len())
            .map(|i| match self.members.get(i) {
                Some(member) => node_momentum(self.whole, *member, self.side(i)),
                // The residual of a constraint is zero at the end of the step.
                None => element::nothing(d, i),
            })
            .collect();
        let eliminated = self.eliminated();
        let kinds = self.kinds(eliminated.as_ref().map(|(found, _)| found));
        let solved_for = Equations {
            d,
            names,
            bindings,
            trial: &trial,
            momenta: &mu,
            eliminated: eliminated.as_ref(),
        };
        let (known, equations) = solved_for.write(&self.momenta(), &node_momenta);
        let (residual_body, tangent_body) = (&equations.residual, &equations.tangent);
        let at_rest = &equations.at_rest;
        let principal_root = Principal {
            d,
            bindings,
            equations: &equations,
            momenta: &mu,
            trial: &trial,
            residual_at: &residual_at,
            tangent_at: &tangent_at,
            rounding: &rounding,
            principal: &principal,
            completed_at: &completed_at,
        };
        let given = principal_root.packed(&equations.alone.given);
        let given_type = Principal::packed_type(d, &equations.alone.given);
        let momenta_type = &equations.momenta;
        let functions = principal_root.functions();
        let configurations = d.spec.configurations.iter().map(|c| &s.get(c.element).name);
        let contact = self.contact(&step, &newton);
        let chosen = super::left_factor::default_solver(self.whole);
        let (method, with_method) = match chosen.is_some() {
            true => (quote!(method: Method,), quote!(, method)),
            false => Default::default(),
        };
        let of_work = chosen.map(|_| quote!(, work.method));
        let (decided, only_root) = self.convex(bindings);
        let at_whole = &equations.at_trial;
        // If a part of the equations is eliminated, the tangent of all equations at zero velocity is the same at
        // every node.
        let is_principal = match &equations.part {
            Some(_) => quote! {
                is_part_of_principal(&#solved.element, &{ #at_rest }, || {
                    Self::#tangent_at(&self.parameters, #step, &#given, &Group::<T>::identity())
                })
            },
            None => quote! {
                is_principal(&#solved.element, &{ #at_rest }, |trial| {
                    Self::#residual_at(&self.parameters, #step, &#given, &#mu, trial)
                })
            },
        };
        let (at_trial, wants, correct) = match &equations.part {
            Some(part) => {
                let (turned, at_trial) = (format_ident!("{TURNED}"), &part.at_trial);
                let correct = if equations.side.is_body() {
                    quote!(correct_part(#trial))
                } else {
                    quote!(correct_part_from_left(#trial))
                };
                let at_trial = [
                    quote!(let #turned = #newton.trial(); #at_trial),
                    quote!(#at_whole),
                ];
                (at_trial, quote!(#newton.wants_residual() &&), correct)
            }
            None => {
                let (of_body, of_space) = (quote!(correct()), quote!(correct_from_left()));
                let correct = equations.side.of(of_body, of_space);
                let at_trial = [quote!(let #trial = #newton.trial();), quote!(#at_whole)];
                (at_trial, quote!(), correct)
            }
        };
        let [begins, at_trial] = at_trial;
        let set_tangent = match equations.times_step {
            true => quote!(#newton.set_tangent_times(&{ #tangent_body }, #step);),
            false => quote!(#newton.set_tangent(&{ #tangent_body });),
        };
        let solve = quote! {
            #decided
            let mut #newton = work.#search.begin(state.#node);
            loop {
                #begins
                if #newton.wants_scale() {
                    #newton.set_scale(move |#lane| self.#rounding(#step, &#given, &#mu, &#trial, #lane));
                }
                #at_trial
                if #wants #newton.assess({ #residual_body }) {
                    #set_tangent
                }
                match #newton.#correct {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(#solved) if #only_root #newton.#is_principal => break #solved,
                    #ended => {
                        if let Some(#solved) = self.#settled(#step, *state, #given, #mu, &mut #newton, #ended #of_work)? {
                            break #solved;
                        }
                    }
                }
            }
        };
        // The arguments of cold functions are copied at the call: a value whose address is taken inside the loop
        // would live in memory.
        let functions = quote! {
            /// The solution to use if the iteration fails or its solution may not be principal.
            /// `None` if the iteration restarts at the principal root.
            #[cold]
            #[inline(never)]
            fn #settled(
                &self,
                #step: T,
                state: #state #used,
                given: #given_type,
                #mu: #momenta_type,
                #newton: &mut newton::Newton<'_, T, #kinds>,
                #ended: newton::Progress<#elements>,
                #method
            ) -> Result<Option<newton::Solved<#elements>>, StepError> {
                let failed = match #ended {
                    newton::Progress::Continue => return Ok(None),
                    newton::Progress::Solved(solved) => Ok(solved),
                    newton::Progress::Failed(e) => Err(e),
                };
                let asked = failed.as_ref().ok().map(|solved| &solved.element);
                let traced = self.#principal(#step, &given, &#mu, #newton.verdict(asked), asked);
                let e = match (traced, failed) {
                    (Ok(None), Ok(solved)) => return Ok(Some(solved)),
                    (Ok(Some(root)), _) if #newton.restart(root) => return Ok(None),
                    (Ok(_), Err(e)) => e,
                    (Ok(_), Ok(_)) => #newton.unpolished(),
                    (Err(fold), failed) => {
                        #contact
                        #newton.folded(fold, failed.err())
                    }
                };
                if #newton.begin_afresh() {
                    return Ok(None);
                }
                Err(self.#refused(state, #step, e #with_method))
            }

            /// Reports the equation with the largest residual, and a step size that succeeds.
            #[cold]
            #[inline(never)]
            fn #refused(&self, state: #state #used, h: T, e: newton::NewtonError, #method) -> StepError {
                const CONFIGURATIONS: &[&str] = &[#(#configurations),*];
                let e = e.explained(h, &CONFIGURATIONS, |h, search| {
                    self.step(&mut { state }, &mut #tried)
                });
                StepCause::from(e).at_node(state.#node)
            }

            #functions
        };
        Loop {
            known,
            computed: equations.computed.clone(),
            solve,
            functions,
        }
    }

    /// A root outside the domain is not the principal one. The error reports the domain that was left, if the whole
    /// motion of the step is known.
    fn contact(&self, step: &Ident, newton: &Ident) -> Option<TokenStream> {
        let d = self.block;
        if self.number.is_some() {
            return self.lost_inverse(step);
        }
        if !super::domain::is_guarded(d) {
            return None;
        }
        let moving = d.spec.configurations.iter().take(self.members.len());
        let moves = moving.enumerate().map(|(i, c)| {
            let (own, part) = (own(d, c.element), self.part(quote!(solved.element), i));
            let end = element::advanced(c, self.side(i), quote!(state.#own), part);
            quote!(moved.#own = #end;)
        });
        Some(quote! {
            if let Ok(solved) = &failed {
                let mut moved = state;
                #(#moves)*
                if let Err(contact) = self.stays_inside(&state, &moved, #step) {
                    return Err(self.left_domain(&state, #step, #newton.tries(), contact));
                }
            }
        })
    }

    /// The same for a block, whose other configurations are not known: tests whether a linear map of the block
    /// becomes singular.
    fn lost_inverse(&self, step: &Ident) -> Option<TokenStream> {
        let d = self.block;
        let maps = d.spec.configurations.iter().enumerate();
        let maps = maps.filter(|(_, c)| matches!(family(c), Family::Linear(_)));
        let tests: Vec<TokenStream> = maps
            .map(|(i, c)| {
                let (own, part) = (own(d, c.element), self.part(quote!(solved.element), i));
                let name = &d.letters.symbols.get(c.element).name;
                let (first, second) = self.side(i).ordered(quote!(state.#own), part.clone());
                let moved = quote!(#first * #second);
                quote! {
                    if let Err(contact) = domain::invertible(#name, &state.#own, &(#moved), #step) {
                        return Err(self.left_domain(&state, #step, contact));
                    }
                }
            })
            .collect();
        (!tests.is_empty()).then(|| quote!(if let Ok(solved) = &failed { #(#tests)* }))
    }
}

/// The letters at the node that the step needs besides the equations, in order to advance.
pub(super) fn onwards(d: &Derivation, by_change: &[Option<SpatialIncrementForm>]) -> Vec<Letter> {
    let carries = d.carries.iter().enumerate();
    let acting = carries.flat_map(|(i, carry)| match by_change.get(i) {
        Some(Some(form)) => vec![&form.added],
        _ => carry.parts(),
    });
    let mut needed = letters_of(acting);
    needed.extend(letters_of(advanced(d).map(|a| &a.update)));
    needed
}

/// All velocities together; `block` contains the multipliers too.
fn all<'a>(
    d: &'a Derivation,
    block: &'a Derivation,
    names: &'a Names,
    members: &'a [usize],
) -> JointUnknowns<'a> {
    JointUnknowns {
        whole: d,
        block,
        members,
        number: None,
        names,
    }
}

/// The model with all multipliers as further velocities.
fn with_all_multipliers(d: &Derivation) -> Derivation {
    let holds: Vec<usize> = (0..d.spec.holds.len()).collect();
    d.with_multipliers(&holds)
}

/// The type of the search if all velocities are found together.
pub(super) fn search_of_all(d: &Derivation, names: &Names) -> TokenStream {
    let members: Vec<usize> = (0..d.spec.configurations.len()).collect();
    all(d, &with_all_multipliers(d), names, &members).search_type()
}

/// The inverses that the model stores for the elimination, if all velocities are found together.
pub(super) fn kept_inverses(d: &Derivation, names: &Names) -> Vec<Inverse> {
    let members: Vec<usize> = (0..d.spec.configurations.len()).collect();
    inverses(&all(d, &with_all_multipliers(d), names, &members))
}

/// The inverses that the model stores for the elimination of one block.
pub(super) fn inverses(together: &JointUnknowns) -> Vec<Inverse> {
    let fields = together
        .eliminated()
        .map_or_else(Vec::new, |(_, fields)| fields);
    fields
        .into_iter()
        .map(|(of, name)| Inverse { name, of })
        .collect()
}

/// `step`, if all velocities are found together.
pub fn step(d: &Derivation, names: &Names) -> TokenStream {
    let members: Vec<usize> = (0..d.spec.configurations.len()).collect();
    let block = with_all_multipliers(d);
    let all = all(d, &block, names, &members);
    let mut needed = all.needed();
    needed.extend(onwards(d, &[]));
    let mut letters = with_transports(d, &needed, 0);
    letters.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &letters);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let work = item(d, "Workspace");
    let search = format_ident!("search");
    let Loop {
        known,
        computed,
        solve,
        functions,
    } = all.code(&bindings, &search, &quote!(#work { h, search }));
    let [found, solved, node] = ["found", "solved", "node"].map(|base| names.local(base));
    let elements = all.elements();
    // The code after the solution uses these values too.
    let (known, solve) = match computed.is_some() {
        true => (known, solve),
        false => (TokenStream::new(), quote!(#known #solve)),
    };
    let (computed, mut after) = computed.unwrap_or_else(|| {
        (
            schedule::Program::none(&d.letters.symbols),
            bindings.clone(),
        )
    });
    let matrices = all.matrices(&solved, &mut after);
    let remembered = quote!(work.search.remember(state.#node - 1, &#found););
    let solved_at = |i: usize| all.part(quote!(#solved), i);
    let rest = finish(
        d,
        names,
        &mut after,
        &solved_at,
        &AtTheStart {
            by_change: &[],
            forces: &[],
            computed: &computed,
        },
        remembered,
    );
    let step = variable(&d.letters.symbols, d.spec.step);
    let step = step_signature(
        d,
        quote! {
            let #step = work.h;
            #parameters
            #locals
            #known
            let #found: newton::Solved<#elements> = {
                #solve
            };
            let #solved = #found.element;
            #matrices
            #rest
        },
    );
    quote!(#step #functions)
}
