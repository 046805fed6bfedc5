//! Reports configurations whose velocities occur in no kinetic term, in the words of the declared model: the affected
//! sites, and what to declare.

use super::ExpandedModel;
use crate::check::spec::{Configuration, Spec};
use crate::check::unused_velocity;
use crate::diagnostic::Diagnostic;
use crate::lattice::{ChainConfig, Lattice, Sites, any_name};
use crate::syntax::ast::{Expression, Kind};

impl ExpandedModel {
    /// The error for configurations whose velocities the Lagrangian does not contain; it names at least the first of
    /// them.
    pub fn motionless(
        &self,
        lattice: &Lattice,
        choice: &ChainConfig,
        spec: &Spec,
        (first, all): (&Configuration, &[&Configuration]),
    ) -> Diagnostic {
        let copy = |c: &Configuration| self.copy(&spec.symbols.get(c.element).name);
        let general = unused_velocity(spec, first);
        let Some(own) = copy(first) else {
            return general;
        };
        let is_own = |c: &&Configuration| copy(c).is_some_and(|c| c.of == own.of);
        let sites = all.iter().copied().filter(is_own);
        let sites: Vec<usize> = sites.filter_map(|c| copy(c).map(|c| c.site)).collect();
        let label = lattice
            .find(&own.of)
            .and_then(|q| Some((lattice.labels.get(q.label)?, q)));
        let every = spec.configurations.iter().filter(is_own).count();
        let (Some((label, quantity)), false) = (label, sites.len() == every) else {
            return Diagnostic {
                message: self.without_sites(&general.message),
                help: general.help.iter().map(|h| self.without_sites(h)).collect(),
                ..general
            };
        };
        let (count, last) = (
            choice.count(quantity.label),
            choice.sites_of(lattice, quantity).saturating_sub(1),
        );
        let number = |site: usize| match count.saturating_sub(site) {
            _ if 2 * site <= last => site.to_string(),
            0 => label.count.text.clone(),
            from_end => format!("{}-{from_end}", label.count.text),
        };
        let numbers: Vec<String> = sites.iter().map(|site| number(*site)).collect();
        let index = &label.index.text;
        let place = match sites.as_slice() {
            [0] => format!("the first site {index} = 0 of `{}` has", own.of),
            [site] if *site == last => {
                format!(
                    "the last site {index} = {} of `{}` has",
                    number(last),
                    own.of
                )
            }
            [site] => format!("the site {index} = {} of `{}` has", number(*site), own.of),
            _ => format!(
                "the sites {index} = {} of `{}` have",
                numbers.join(", "),
                own.of
            ),
        };
        let velocity = spec.symbols.get(first.velocity).name.as_str();
        let velocity = self.copy(velocity).map_or(velocity, |c| c.of.as_str());
        let (moving, example) = match first.group.is_additive() {
            true => (
                format!("next({})", own.of),
                first.group.kinetic_example(&own.of),
            ),
            false => (velocity.to_owned(), format!("-tr(J*{velocity})/h")),
        };
        let d = Diagnostic::new(
            general.place,
            format!("{place} no kinetic term: no term of the Lagrangian contains `{moving}` there"),
        );
        let of_segments = self.summands.iter().map(|s| &s.stated);
        let mut of_segments = of_segments.filter(|term| moves(term, &own.of, velocity));
        let segment = of_segments.find_map(|term| {
            let mut all = lattice.quantities.iter();
            all.find(|q| q.sites == Sites::Segments && any_name(term, &|n| n == q.name.text))
        });
        d.help(match segment.filter(|q| quantity.sites == Sites::Nodes && q.name.text != own.of) {
            Some(q) => format!(
                "the kinetic term contains `{0}`, which is declared at segments, and a chain has one segment fewer than nodes: \
                 declare `{0}` at nodes",
                q.name.text
            ),
            None => format!("add a kinetic term that every site has, for example `{example}`"),
        })
    }
}

/// Whether a term contains the velocity of a configuration, or its value at the end of the step.
fn moves(term: &Expression, element: &str, velocity: &str) -> bool {
    let mut found = any_name(term, &|n| n == velocity);
    term.each(&mut |e| {
        if let Kind::Call(f, arguments) = &e.kind
            && let ("next", [inner]) = (f.text.as_str(), arguments.as_slice())
        {
            found |= any_name(inner, &|n| n == element);
        }
    });
    found
}
