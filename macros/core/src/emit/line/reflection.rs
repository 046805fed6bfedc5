//! Reflection at the walls of a box. A position beyond a wall is replaced by its mirror image, and so is the kinetic
//! part of its edge momentum. The contribution of a vector potential is taken at the position before and after the
//! reflection.

use super::locals::Places;
use super::{Lines, Moving, force_kernels, number};
use crate::algebra::Algebra;
use crate::expr::{self, Expr, Letter, Shift};
use crate::line::Line;
use crate::syntax::ast::Extent;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The emitted code of walls.
pub(super) struct ReflectionCode {
    /// The kernel of the vector potential.
    pub items: TokenStream,
    /// The statements of a step after all positions have moved.
    pub call: TokenStream,
}

/// The momentum of a configuration at zero velocity as a function of its position, which is the contribution of a
/// vector potential.
fn at_rest(m: &Moving) -> Option<Expr> {
    let limit = m.lone.d.limit.as_ref().ok()?;
    let xi = Letter {
        symbol: m.lone.d.letters.variation[m.mover.index],
        shift: Shift::HERE,
    };
    let s = &m.lone.outline.letters.symbols;
    Some(expr::gradient(
        s,
        &m.lone.outline.defined(&limit.linear),
        xi,
    ))
}

/// The reason why clebsch cannot emit the walls, if any.
pub(super) fn refusal(line: &Line) -> Option<String> {
    let boxed = |name: &str| {
        let q = line.lattice.find(name);
        q.is_some_and(|q| matches!(q.domain, Some(Extent::Box(_))))
    };
    let all = line
        .lone
        .iter()
        .flat_map(|lone| lone.movers.iter().map(move |mover| Moving { lone, mover }));
    let mut boxes = all.filter(|m| boxed(&m.mover.name));
    let m = boxes.next()?;
    if line.is_tied(&m.mover.name) {
        return Some(
            "walls reflect the momentum of one site, and this momentum contains velocities of neighbours".to_owned(),
        );
    }
    if at_rest(&m).is_none() {
        return Some(
            "walls reflect a kinetic momentum, which is unknown without a limit of small steps"
                .to_owned(),
        );
    }
    (!is_turned_by_itself(&m)).then(|| {
        format!(
            "the kinetic energy couples the components of `{}` with one another or with other velocities, and a wall reflects \
             one component",
            m.mover.name
        )
    })
}

/// Whether each component of the kinetic momentum depends on the same component of the velocity only, so that
/// reflecting the momentum reflects the velocity.
fn is_turned_by_itself(m: &Moving) -> bool {
    let d = m.d();
    let Ok(limit) = &d.limit else {
        return false;
    };
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let xi = |i: usize| Letter {
        symbol: d.letters.variation[i],
        shift: Shift::HERE,
    };
    let own = xi(m.mover.index);
    let Some(axes) = expr::axes(expr::letter(s, own.symbol, own.shift).shape()) else {
        return false;
    };
    let others: Vec<Letter> = (0..d.spec.configurations.len())
        .filter(|i| *i != m.mover.index)
        .map(xi)
        .collect();
    axes.iter().enumerate().all(|(i, axis)| {
        let momentum = expr::directional(s, &limit.kinetic, &[(own, axis.clone())]);
        let by = |u: &Expr| expr::directional(s, &momentum, &[(own, u.clone())]);
        let mut rest = axes.iter().enumerate().filter(|(j, _)| *j != i);
        rest.all(|(_, u)| algebra.is_zero(&by(u)))
            && others
                .iter()
                .all(|other| algebra.is_zero(&expr::gradient(s, &momentum, *other)))
    })
}

fn kernel(m: &Moving) -> Ident {
    format_ident!("at_rest_{}", m.mover.name)
}

/// The walls of a box, if there are any.
pub(super) fn reflection_code(l: &Lines) -> Option<ReflectionCode> {
    let (extent, directions) = l.extent()?;
    if !matches!(extent, Extent::Box(_)) {
        return None;
    }
    let q = l.line.lattice.places()?;
    let m = l.moving().find(|m| m.mover.name == q.name.text)?;
    let s = &m.lone.outline.letters.symbols;
    let (name, places, t, count) = (
        l.item(""),
        l.item("Places"),
        m.covector(),
        l.count_of(&m.mover.name),
    );
    let (field, kernel, text, d) = (m.name(), kernel(&m), &m.mover.name, number(directions));
    let values = [at_rest(&m)?];
    let (locals, bindings) = l.locals(
        s,
        &l.of_site(&m.lone.outline, &values),
        &Places::of_node(),
        &quote!(site),
    );
    let (lets, results) = l.program(s, &values, &bindings);
    let value = m.array(results.into_iter().next().unwrap_or_default());
    let doc = format!(" The momentum of `{text}` at zero velocity.");
    let items = quote! {
        impl<T: Real> #name<T> {
            #[doc = #doc]
            #[inline]
            fn #kernel(&self, site: usize, at: &#places<T>) -> #t {
                let _ = (site, at);
                #locals
                #lets
                #value
            }
        }
    };
    let added = m.mover.how.added().is_some().then(|| {
        let velocities = l.system_of(&m).map(|(field, ..)| field);
        let edge = force_kernels::edge_kernel(&m);
        quote!(self.#edge(h, site, &state.places, &work.places, &work.#velocities[site]))
    });
    let added = added.unwrap_or_else(|| quote!(SMatrix::zeros()));
    let call = quote! {
        work.stamp = line::Stamp::none();
        let (domain, cell) = (self.sites.domain, self.setting().cell());
        for site in 0..#count {
            let mut place: [T; #d] = work.places.#field[site].into();
            if !domain.is_inside(&place) {
                let kinetic: #t = work.edges.#field[site] + #added - self.#kernel(site, &work.places);
                let mut turned: [T; #d] = kinetic.into();
                match domain.reflect(site, &cell, &mut place, &mut turned) {
                    Ok(crossed) => work.reflections += crossed as u64,
                    Err(cause) => return Err(self.refused_by(state, h, #text, cause)),
                }
                work.places.#field[site] = place.into();
                let turned: #t = turned.into();
                work.edges.#field[site] = turned + self.#kernel(site, &work.places) - #added;
            }
        }
    };
    Some(ReflectionCode { items, call })
}
