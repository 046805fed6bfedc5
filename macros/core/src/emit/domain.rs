//! Domains that a step must not leave: the domains of functions in the model, and invertible matrices. Takes the
//! derivation; gives the tests of a step, of a step size and of the parameters, if the model has such functions.

use super::between::{Edge, edge_between};
use super::element::{Family, family};
use super::expression::{Bindings, Writer, program};
use super::items::{letters_of, parameter_locals, text, with_transports};
use super::names::{Names, item, own, per_configuration, variable};
use super::sizes::Generics;
use super::step::at;
use crate::algebra::Rational;
use crate::derive::Derivation;
use crate::derive::select_solver::Method;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Function, Letter, Node, Shift};
use crate::print::{Format, Style, expression};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The domain of an argument; the names are the runtime's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Domain {
    Positive,
    NotNegative,
    NotZero,
}

impl Domain {
    fn tokens(self) -> TokenStream {
        match self {
            Domain::Positive => quote!(domain::Domain::Positive),
            Domain::NotNegative => quote!(domain::Domain::NotNegative),
            Domain::NotZero => quote!(domain::Domain::NotZero),
        }
    }
}

/// A function or operation with a domain; the names are the runtime's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DomainOperation {
    Log,
    Sqrt,
    Power,
    Quotient,
    Inverse,
}

impl DomainOperation {
    fn tokens(self) -> TokenStream {
        match self {
            DomainOperation::Log => quote!(domain::Function::Log),
            DomainOperation::Sqrt => quote!(domain::Function::Sqrt),
            DomainOperation::Power => quote!(domain::Function::Power),
            DomainOperation::Quotient => quote!(domain::Function::Quotient),
            DomainOperation::Inverse => quote!(domain::Function::Inverse),
        }
    }
}

/// The dependence of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Parameters only.
    Parameters,
    /// The step size and parameters.
    Step,
    /// Quantities at one node.
    Node,
    /// Velocities, or both ends of an edge.
    Edge,
}

/// The argument of a function, and its domain.
#[derive(Clone, Debug, PartialEq)]
struct Guard {
    domain: Domain,
    function: DomainOperation,
    argument: Expr,
    place: Place,
}

impl Guard {
    /// The function and its argument, as the runtime names them.
    fn call(&self, d: &Derivation) -> TokenStream {
        self.call_in(&text(d, &self.argument))
    }

    /// The function, with `argument` as the text of its argument.
    fn call_in(&self, argument: &str) -> TokenStream {
        let function = self.function.tokens();
        quote!(&domain::Call { function: #function, argument: #argument })
    }
}

/// All guards of a model except those on squares, in the order in which the Lagrangian names them.
fn guards(d: &Derivation) -> Vec<Guard> {
    let mut all = with_squares(d);
    all.retain(|g| !is_square(&g.argument));
    all
}

fn with_squares(d: &Derivation) -> Vec<Guard> {
    let mut all = Vec::new();
    let lagrangian = [&d.spec.lagrangian, &d.action.edge, &d.action.nodal];
    let definitions = d.spec.advected.iter().filter_map(|a| a.definition.as_ref());
    for e in lagrangian.into_iter().chain(definitions) {
        collect(&d.letters.symbols, e, &mut all);
    }
    all
}

fn of(d: &Derivation, place: Place) -> Vec<Guard> {
    let mut all = guards(d);
    all.retain(|g| g.place == place);
    all
}

fn collect(s: &Symbols, e: &Expr, all: &mut Vec<Guard>) {
    match e.node() {
        Node::Call(Function::Log, a) => guard(s, Domain::Positive, DomainOperation::Log, a, all),
        Node::Power(a, q) => match (q.as_integer(), q.is_negative()) {
            (Some(_), false) => {}
            (Some(_), true) => guard(s, Domain::NotZero, DomainOperation::Quotient, a, all),
            (None, true) => guard(s, Domain::Positive, DomainOperation::Power, a, all),
            (None, false) if *q == Rational::HALF => {
                guard(s, Domain::NotNegative, DomainOperation::Sqrt, a, all)
            }
            (None, false) => guard(s, Domain::NotNegative, DomainOperation::Power, a, all),
        },
        Node::Quotient(_, b) => guard(s, Domain::NotZero, DomainOperation::Quotient, b, all),
        Node::Inverse(a) if !expr::is_invertible(s, a) => {
            guard(
                s,
                Domain::NotZero,
                DomainOperation::Inverse,
                &expr::det(a.clone()),
                all,
            );
        }
        _ => {}
    }
    for child in e.children() {
        collect(s, child, all);
    }
}

/// Whether a scalar is a sum of squares. Such an argument cannot leave a domain. If it is zero, the step itself
/// detects the infinite value, and `start` rejects it.
fn is_square(e: &Expr) -> bool {
    match e.node() {
        Node::Dot(a, b) => a == b,
        Node::Power(a, q) => match q.as_integer() {
            Some(n) => n % 2 == 0 || is_square(a),
            None => is_square(a),
        },
        Node::Number(q) => !q.is_negative() && !q.is_zero(),
        Node::Constant(_) => true,
        Node::Sum(list) | Node::Product(list) => list.iter().all(is_square),
        Node::Quotient(a, b) => is_square(a) && is_square(b),
        _ => false,
    }
}

/// Factors whose squares occur in `e`, and the remaining factor. For `det(Q^T C Q)` these are `det(Q)` and `det(C)`.
fn squared(e: &Expr) -> Option<(Vec<Expr>, Expr)> {
    match e.node() {
        Node::Power(a, q) => {
            let even = q.as_integer().is_some_and(|n| n % 2 == 0);
            even.then(|| (vec![a.clone()], expr::integer(1)))
        }
        Node::Det(a) => {
            let Node::Product(factors) = a.node() else {
                return None;
            };
            if !factors.iter().all(|f| f.shape().is_square()) {
                return None;
            }
            let dets: Vec<Expr> = factors.iter().map(|f| expr::det(f.clone())).collect();
            let (mut twice, mut once) = (Vec::new(), Vec::new());
            for x in &dets {
                let count = dets.iter().filter(|y| *y == x).count();
                if count > 1 && !twice.contains(x) {
                    twice.push(x.clone());
                }
                if count % 2 == 1 && !once.contains(x) {
                    once.push(x.clone());
                }
            }
            (!twice.is_empty()).then(|| (twice, expr::product(once)))
        }
        _ => None,
    }
}

fn guard(
    s: &Symbols,
    domain: Domain,
    function: DomainOperation,
    argument: &Expr,
    all: &mut Vec<Guard>,
) {
    // A product is zero if one of its factors is.
    if let (Domain::NotZero, Node::Product(factors)) = (domain, argument.node())
        && factors.iter().all(|f| f.shape().is_scalar())
    {
        for f in factors {
            guard(s, domain, function, f, all);
        }
        return;
    }
    // A square cannot leave its domain. But a step may move the squared number through zero, where the function is
    // infinite.
    if domain != Domain::NotNegative
        && let Some((squared, left)) = squared(argument)
    {
        for f in &squared {
            guard(s, Domain::NotZero, function, f, all);
        }
        return guard(s, domain, function, &left, all);
    }
    let letters = expr::letters(argument);
    let has = |role| letters.iter().any(|l| s.get(l.symbol).role == role);
    let place = if has(Role::Velocity) || letters.iter().any(|l| l.shift.time != 0) {
        Place::Edge
    } else if has(Role::Element) || has(Role::Advected) {
        Place::Node
    } else if has(Role::Step) {
        Place::Step
    } else {
        Place::Parameters
    };
    let own_step = matches!(argument.node(), Node::Letter(_)) && place == Place::Step;
    if own_step || letters.is_empty() {
        return;
    }
    let found = Guard {
        domain,
        function,
        argument: argument.clone(),
        place,
    };
    if !all.contains(&found) {
        all.push(found);
    }
}

/// Whether the guard only requires that the step size is nonzero, which always holds.
fn is_power_of_step(g: &Guard) -> bool {
    let of_letter = |e: &Expr| matches!(e.node(), Node::Letter(_));
    let power = match g.argument.node() {
        Node::Power(a, q) => of_letter(a) && q.as_integer().is_some(),
        _ => false,
    };
    power && g.place == Place::Step && g.domain == Domain::NotZero
}

/// A guard as tokens.
pub(super) struct Tested {
    /// The domain, as the runtime names it.
    pub domain: TokenStream,
    /// The function.
    pub function: TokenStream,
    /// The function and its argument, as the runtime names them.
    pub call: TokenStream,
    /// The argument as text.
    pub text: String,
    /// The argument.
    pub argument: Expr,
    /// Whether the argument depends on parameters only.
    pub constant: bool,
}

/// The guards of some expressions of a model on quantities at a node and on parameters. None if an expression has a
/// guard on velocities.
pub(super) fn tested(s: &Symbols, time_index: &str, list: &[Expr]) -> Option<Vec<Tested>> {
    let mut all = Vec::new();
    list.iter().for_each(|e| collect(s, e, &mut all));
    let text = |e: &Expr| expression(e, s, &Style::new(time_index), Format::Text);
    all.retain(|g| !is_square(&g.argument) && !is_power_of_step(g));
    all.iter()
        .map(|g| {
            let admitted = matches!(g.place, Place::Node | Place::Parameters);
            admitted.then(|| Tested {
                domain: g.domain.tokens(),
                function: g.function.tokens(),
                call: g.call_in(&text(&g.argument)),
                text: text(&g.argument),
                argument: g.argument.clone(),
                constant: g.place == Place::Parameters,
            })
        })
        .collect()
}

/// Whether a step must be tested.
pub(super) fn is_guarded(d: &Derivation) -> bool {
    let linear = |c| matches!(family(c), Family::Linear(_));
    let tested = |g: &Guard| matches!(g.place, Place::Node | Place::Edge);
    d.spec.configurations.iter().any(linear) || guards(d).iter().any(tested)
}

/// The head of the function that makes a step. If the step must be tested, another function wraps it.
pub(super) fn step_head(d: &Derivation) -> TokenStream {
    match is_guarded(d) {
        true => quote!(fn step_untested),
        false => quote!(pub fn step),
    }
}

/// The tests of the parameters, and the letters that the tests contain.
pub(super) fn of_parameters(d: &Derivation) -> (Vec<Letter>, TokenStream) {
    tests_of(d, Place::Parameters)
}

fn tests_of(d: &Derivation, place: Place) -> (Vec<Letter>, TokenStream) {
    let list = of(d, place);
    let none = Bindings::new();
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings: &none,
    };
    let tests = list.iter().map(|g| {
        let (domain, function) = (g.domain.tokens(), g.function.tokens());
        let (argument, value) = (text(d, &g.argument), writer.write(&g.argument));
        quote!(validate::inside(#domain, #function, #argument, #value)?;)
    });
    let tests = quote!(#(#tests)*);
    (letters_of(list.iter().map(|g| &g.argument)), tests)
}

/// The test of the step size, if the model divides by other functions of the step size than its powers.
pub(super) fn of_step(d: &Derivation) -> TokenStream {
    let (letters, tests) = tests_of(d, Place::Step);
    if tests.is_empty() {
        return tests;
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &letters);
    let step = variable(&d.letters.symbols, d.spec.step);
    quote! {
        { let #step = h; #parameters #tests }
    }
}

/// The test of the initial state. An infinite value there fails the first step, and a smaller step size does not
/// help.
pub(super) fn of_start(d: &Derivation, names: &Names) -> TokenStream {
    let mut list = with_squares(d);
    // The root of a sum of squares is defined everywhere.
    let idle = |g: &Guard| g.domain == Domain::NotNegative && is_square(&g.argument);
    list.retain(|g| g.place == Place::Node && !idle(g));
    if list.is_empty() {
        return TokenStream::new();
    }
    let (locals, values) = arguments(d, names, &list);
    let timed = list
        .iter()
        .any(|g| expr::contains(&g.argument, at(d.spec.step, Shift::HERE)));
    let step = timed.then(|| {
        let step = variable(&d.letters.symbols, d.spec.step);
        quote!(let #step = h;)
    });
    let tests = list.iter().zip(values).map(|(g, value)| {
        let (domain, function) = (g.domain.tokens(), g.function.tokens());
        let argument = text(d, &g.argument);
        quote!(validate::defined(#domain, #function, #argument, #value)?;)
    });
    quote! {{
        #step
        #locals
        #(#tests)*
    }}
}

/// The statements that bind the letters of the arguments at the node of `state`, and the values of the arguments.
fn arguments(d: &Derivation, names: &Names, list: &[Guard]) -> (TokenStream, Vec<TokenStream>) {
    let arguments: Vec<Expr> = list.iter().map(|g| g.argument.clone()).collect();
    let needed = letters_of(&arguments);
    let mut bindings = Bindings::new();
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = super::step::here(d, names, &needed, &mut bindings);
    let p = schedule::program(&d.letters.symbols, &arguments, "t");
    let (lets, values) = program(&p, &bindings);
    (quote!(#parameters #locals #lets), values)
}

/// The test in a step that its momenta are finite. A model with guards tests the momenta after the domains, because a
/// left domain may be the cause of a value that is not finite.
pub(super) fn finite_in_step(d: &Derivation, names: &Names, finite: &[TokenStream]) -> TokenStream {
    if is_guarded(d) {
        return TokenStream::new();
    }
    let node = names.local("node");
    quote! {
        if !(#(#finite)&&*) {
            return Err(StepCause::not_finite("momentum").at_node(state.#node));
        }
    }
}

/// The public `step` of a model with guards.
pub(super) fn tested_step(d: &Derivation, names: &Names) -> TokenStream {
    if !is_guarded(d) {
        return TokenStream::new();
    }
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let used = Generics::of(d).used();
    let (node, before) = (names.local("node"), names.local("before"));
    let momenta = (0..d.spec.configurations.len()).map(|i| per_configuration(d, "momentum", i));
    let inside = inside(d, names);
    let method = format!(" One step, in place. Method: {}.", d.how_solved());
    let (asked, taken) = match d.solve.method {
        Method::Newton => (
            quote!(work.h, work.search.tries(),),
            quote!(h: T, tries: bool,),
        ),
        Method::Blocks => (quote!(work.h,), quote!(h: T,)),
        _ => Default::default(),
    };
    let trials = {
        let trial = super::blocks::trial(d, "to_try");
        quote! {
            contact.with_trials(h, |h| {
                let mut moving = *state;
                self.step(&mut moving, &mut #trial).is_ok()
            })
        }
    };
    let trials = match d.solve.method {
        Method::Newton => quote!(let contact = if tries { contact } else { #trials };),
        Method::Blocks => quote!(let contact = #trials;),
        _ => TokenStream::new(),
    };
    quote! {
        #[doc = #method]
        ///
        /// # Errors
        /// If the step cannot be solved or leaves the domain of the model. The error gives numbers
        /// and a remedy; the state is unchanged.
        #[inline]
        pub fn step(&self, state: &mut #state #used, work: &mut #work #used) -> Result<(), StepError> {
            let #before = *state;
            self.step_untested(state, work)?;
            let finite = #(all_finite(&state.#momenta.0))&&*;
            match self.stays_inside(&#before, state, work.h) {
                Ok(()) if finite => Ok(()),
                Err(contact) if finite || contact.is_finite() => {
                    *state = #before;
                    Err(self.left_domain(state, #asked contact))
                }
                _ => {
                    *state = #before;
                    Err(StepCause::not_finite("momentum").at_node(state.#node))
                }
            }
        }

        /// Reports where the step leaves the domain, and a step size that succeeds.
        #[cold]
        #[inline(never)]
        fn left_domain(&self, state: &#state #used, #taken contact: domain::Contact) -> StepError {
            #trials
            StepCause::from(contact).at_node(state.#node)
        }

        #inside
    }
}

/// The function that tests whether a step stays in the domain of the model.
fn inside(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let (before, after) = (names.local("before"), names.local("after"));
    let step = variable(s, d.spec.step);
    let all = guards(d);
    let invertible = d.spec.configurations.iter().filter_map(|c| {
        let (name, own) = (&s.get(c.element).name, own(d, c.element));
        // If the determinant of a field must not vanish at a node, it must not vanish between two nodes either.
        let shape = s.get(c.element).shape;
        let det = expr::det(expr::here(s, c.element));
        let inverted =
            shape.is_square() && !shape.is_scalar() && all.iter().any(|g| g.argument == det);
        let test = match family(c) {
            Family::Linear(_) => quote!(domain::invertible),
            Family::Field(_) if inverted => quote!(domain::field_invertible),
            _ => return None,
        };
        Some((
            det,
            quote!(#test(#name, &#before.#own, &#after.#own, #step)?;),
        ))
    });
    let (dets, linear): (Vec<Expr>, Vec<TokenStream>) = invertible.unzip();
    let linear = quote!(#(#linear)*);
    let (mut nodal, edge) = (of(d, Place::Node), of(d, Place::Edge));
    // A determinant that does not vanish during the step keeps its sign, which is tested at the start.
    nodal.retain(|g| !dets.contains(&g.argument));
    let (nodes, arguments) = at_nodes(d, names, &nodal);
    let edges = on_edge(d, names, &edge);
    quote! {
        /// Whether the step from one state to the next stays where the model is defined.
        #[inline]
        fn stays_inside(&self, #before: &#state #used, #after: &#state #used, #step: T) -> Result<(), domain::Contact> {
            #linear
            #nodes
            #edges
            let _ = (#before, #after, #step);
            Ok(())
        }
        #arguments
    }
}

/// The tests at both nodes, and the function that gives the arguments at one node.
fn at_nodes(d: &Derivation, names: &Names, list: &[Guard]) -> (TokenStream, TokenStream) {
    if list.is_empty() {
        return Default::default();
    }
    let s = &d.letters.symbols;
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let (before, after) = (names.local("before"), names.local("after"));
    let step = variable(s, d.spec.step);
    let count = Literal::usize_unsuffixed(list.len());
    let tests = list.iter().enumerate().map(|(i, g)| {
        let (domain, call) = (g.domain.tokens(), g.call(d));
        let i = Literal::usize_unsuffixed(i);
        quote!(#domain.at_nodes(#call, #before[#i], #after[#i], #step)?;)
    });
    // The node at which a step starts was tested by the previous step or when the workspace was made. Its arguments
    // are computed only if a sign must not change, or to report where the step left a domain.
    let nodes = match list.iter().any(|g| g.domain == Domain::NotZero) {
        true => quote! {{
            let (#before, #after) = (self.domain_arguments(#before, #step), self.domain_arguments(#after, #step));
            #(#tests)*
        }},
        false => {
            let admits = list.iter().enumerate().map(|(i, g)| {
                let (domain, i) = (g.domain.tokens(), Literal::usize_unsuffixed(i));
                quote!(#domain.admits(#after[#i]))
            });
            quote! {{
                let #after = self.domain_arguments(#after, #step);
                if !(#(#admits)&&*) {
                    let #before = self.domain_arguments(#before, #step);
                    #(#tests)*
                }
            }}
        }
    };
    let (locals, values) = arguments(d, names, list);
    let function = quote! {
        /// The arguments of the functions that the model uses, at the node of this state.
        #[inline]
        fn domain_arguments(&self, state: &#state #used, #step: T) -> [T; #count] {
            #locals
            let _ = (state, #step);
            [#(#values),*]
        }
    };
    (nodes, function)
}

/// The tests of arguments that depend on velocities.
fn on_edge(d: &Derivation, names: &Names, list: &[Guard]) -> TokenStream {
    if list.is_empty() {
        return TokenStream::new();
    }
    let s = &d.letters.symbols;
    let step = variable(s, d.spec.step);
    let rest: Vec<(Letter, Expr)> = d
        .spec
        .configurations
        .iter()
        .map(|c| (at(c.velocity, Shift::HERE), c.group.identity()))
        .collect();
    let mut wanted: Vec<Expr> = Vec::new();
    for g in list {
        let forward = expr::substitute(s, &g.argument, &d.spec.end_of_edge());
        wanted.push(expr::substitute(s, &forward, &rest));
        wanted.push(g.argument.clone());
    }
    let Edge {
        parameters,
        locals,
        bindings,
    } = edge_between(d, names, &wanted, false);
    let p = schedule::program(s, &wanted, "t");
    let (lets, values) = program(&p, &bindings);
    let tests = list.iter().zip(values.chunks(2)).map(|(g, pair)| {
        let (domain, call) = (g.domain.tokens(), g.call(d));
        quote!(#domain.on_edge(#call, #(#pair),*, #step)?;)
    });
    quote! {{
        #parameters
        #locals
        #lets
        #(#tests)*
    }}
}
