//! The card of a chain. clebsch derives a short chain with the same end conditions body by body and repeats its fields
//! for all sites. Takes a model with labels and a choice; gives the card that the command reads and starts.

use super::LineModel;
use super::coordinates::{self, UserRole};
use super::differentiated::TracedLine;
use crate::cache::Cache;
use crate::cards::named;
use crate::constants::Constants;
use crate::{Refused, derived, text};
use clebsch::card::{Card, Field, Invariant, Kind};
use clebsch_core::diagnostic::Report;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{self, ChainConfig, ExpandedModel, Kind as QuantityKind, Lattice};
use clebsch_core::line::Coordinates;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::Model;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// The origin of a field of the card: a quantity of the emitted program, and its site.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The name in the emitted program, such as `momentum_q`, in ASCII.
    pub key: String,
    /// The site, of a quantity that has one.
    pub site: Option<usize>,
}

/// A chain that the command can start: its card, and the places of its fields.
#[derive(Debug)]
pub struct Carded {
    /// The program.
    pub model: Arc<LineModel>,
    /// The number of sites and the end conditions.
    pub choice: ChainConfig,
    /// The card; the caller that opens it sets its functions.
    pub card: Card,
    /// The places of the parameters.
    pub parameters: Vec<Place>,
    /// The places of the initial values.
    pub initial: Vec<Place>,
    /// The places of the observables.
    pub observables: Vec<Place>,
    /// The number of sites of each quantity, by name.
    pub sites: BTreeMap<String, usize>,
    /// The functions that are recorded with derivatives.
    pub traced: OnceLock<TracedLine>,
}

/// The short chain from which the card is built.
struct Short<'a> {
    lattice: &'a Lattice,
    unfolded: &'a ExpandedModel,
    short: &'a ChainConfig,
    whole: &'a ChainConfig,
}

/// A field with its place, and the label and the quantity that it belongs to.
struct Placed {
    field: Field,
    place: Place,
    of: String,
    label: usize,
}

impl Carded {
    /// The card of a model for the chosen numbers of sites and end conditions, and the warnings about the model. A
    /// cache may have the short chain.
    ///
    /// # Errors
    /// [`Refused`], if the short chain cannot be derived.
    pub fn of(
        stated: (&Model, &Lattice),
        choice: &ChainConfig,
        model: Arc<LineModel>,
        (source, cache): (&str, &Cache),
    ) -> Result<(Self, Vec<Report>), Refused> {
        let (statement, as_stated) = stated;
        let restated = match model.coordinates.as_slice() {
            [] => None,
            _ => clebsch_core::line::restated(statement, as_stated),
        };
        let lattice = restated.as_ref().map(Lattice::read).transpose();
        let lattice = lattice.map_err(Refused::Model)?;
        let statement = restated.as_ref().unwrap_or(statement);
        let lattice = lattice.as_ref().unwrap_or(as_stated);
        let representative =
            pipeline::representative(statement, lattice).map_err(Refused::Model)?;
        let counts = representative.counts.iter().zip(&choice.counts);
        let short = ChainConfig {
            // With functionals, one site represents all sites.
            counts: match lattice.meshes.is_empty() {
                true => counts
                    .map(|(n, most)| {
                        // In a ring of even length, even and odd sites may form two separate sets.
                        let odd = usize::from(choice.periodic);
                        ((*n).max(4) | odd).min(*most)
                    })
                    .collect(),
                false => representative.counts.clone(),
            },
            ..choice.clone()
        };
        let unfolded = lattice::unfold(statement, lattice, &short).map_err(Refused::Model)?;
        let derived = derived::kept(cache, (&format!("{short:?}"), source), || {
            derived::Short::derive(statement, lattice, &short)
        })?;
        let none = BTreeMap::new();
        let program = derived::program(&derived.card)?;
        let card = Constants::new(&program, &derived.name, &none).card()?;
        let expander = Short {
            lattice,
            unfolded: &unfolded,
            short: &short,
            whole: choice,
        };
        let known = |p: &Place| model.observers().any(|o| ascii(&o) == p.key);
        let in_groups = |fields, initial| in_groups(&model.coordinates, fields, initial);
        // A value that an end condition prescribes is a parameter.
        let mut parameters = in_groups(expander.expanded(card.parameters), true);
        let space: Vec<_> = model
            .space()
            .map(|(name, count)| of_space(name, count))
            .collect();
        parameters.retain(|(field, _)| space.iter().all(|(own, _)| own.ascii != field.ascii));
        parameters.extend(space);
        let (parameters, at_parameters) = split(parameters);
        let (initial, at_initial) = split(in_groups(expander.expanded(card.initial), true));
        let mut observed = in_groups(expander.expanded(card.observables), false);
        let mut left_out: Vec<String> = Vec::new();
        observed.retain(|(_, p)| {
            let known = known(p);
            if !known && !left_out.contains(&p.key) {
                left_out.push(p.key.clone());
            }
            known
        });
        observed.extend(expander.functionals());
        let (observables, at_observables) = split(observed);
        let words = derived.words;
        let rows = |name: &str| model.conserved().find(|(own, ..)| *own == name);
        let named = named(card.invariants, words.invariants).into_iter();
        // If every site conserves a quantity, the card lists the sum over sites.
        let named = named.map(|i| match rows(i.name) {
            Some((_, rows, _)) if rows != i.rows => Invariant {
                formula: text(&format!("the sum of {}", i.formula)),
                rows,
                ..i
            },
            _ => i,
        });
        // The card reports constraints for all sites together, not for the sites of the short chain.
        let of_holds = |name: &str| name.starts_with("constraint_");
        let of_sums = !unfolded.totals.is_empty();
        let has_holds = !unfolded.holds.is_empty() || of_sums;
        let named = named.filter(|i| !(has_holds && of_holds(i.name)));
        // If the end conditions omit sites from a total, it is not the sum over all sites and is dropped.
        let is_same = |name: &str| {
            let mut there = model.densities(name).peekable();
            let own = &derived.totals;
            let here = |there: &str| own.iter().any(|(own, text)| own == name && text == there);
            there.peek().is_none() || there.any(here)
        };
        let (kept, lost): (Vec<Invariant>, Vec<Invariant>) = named.partition(|i| match i.name {
            "energy" => model.has_energies(),
            name => model.totals().any(|t| t == name) && is_same(name),
        });
        let mut kept = kept;
        // The short chain does not show which totals functionals of all sites conserve.
        let others = model.conserved();
        let others = others.filter(|(name, ..)| !lattice.meshes.is_empty() || of_holds(name));
        for (name, rows, reason) in others {
            if kept.iter().all(|i| i.name != name) {
                let formula = match of_holds(name) {
                    true if of_sums => format!("the norm of a sum over all sites; {reason}"),
                    true => {
                        format!("the square root of the sum of squares over all sites; {reason}")
                    }
                    false => format!("a sum over all sites; {reason}"),
                };
                kept.push(Invariant::exact(text(name), text(&formula), rows));
            }
        }
        left_out.extend(lost.iter().map(|i| expander.at_its_site(i.name)));
        let summary = words
            .summary
            .replace(&short.words(lattice), &choice.words(lattice));
        let mut summary = expander.at_its_site(&summary);
        if has_holds {
            summary = of_all_sites(
                &summary,
                kept.iter().map(|i| i.name).filter(|n| of_holds(n)),
            );
        }
        for c in &model.coordinates {
            summary.push_str(&format!("\ncoordinates          {}", c.words()));
        }
        summary.push_str(&program_description(&left_out));
        let card = Card {
            source: text(source),
            summary: text(&summary),
            solver: match (has_holds, model.is_solved_together()) {
                (true, _) if of_sums => HELD_SUMS,
                (true, _) => HELD,
                (false, true) => TOGETHER,
                (false, false) => text(&words.solver),
            },
            // Functionals of all sites, and walls that reflect, are not smooth enough for more.
            orders: match lattice.meshes.is_empty() && !card.preprocessed {
                true => card.orders,
                false => &[2],
            },
            preprocessed: false,
            solvers: &[],
            parameters,
            initial,
            observables,
            invariants: Box::leak(kept.into_boxed_slice()),
            ..card
        };
        let quantities = lattice.quantities.iter().chain(&as_stated.quantities);
        let sites = quantities.map(|q| (q.name.text.clone(), choice.sites_of(lattice, q)));
        let carded = Carded {
            model,
            choice: choice.clone(),
            card,
            parameters: at_parameters,
            initial: at_initial,
            observables: at_observables,
            sites: sites.collect(),
            traced: OnceLock::new(),
        };
        Ok((carded, derived.warnings))
    }
}

/// A parameter of the domain of a fluid, `count` numbers.
fn of_space(name: &str, count: usize) -> (Field, Place) {
    let doc = match name {
        "domain" => "lengths of the box, then 1 for each direction with walls, 0 for each without",
        _ => "along each direction",
    };
    let kind = match count {
        1 => Kind::Scalar,
        _ => Kind::Vector,
    };
    let key = ascii(name);
    let field = kind.field(text(name), [count, 1], doc);
    (field.spelt(text(&key)), Place { key, site: None })
}

/// The solver for multipliers along a chain.
const HELD: &str = "the multipliers of all sites together by Newton's method with block-tridiagonal derivatives, velocities \
                    site by site, so that the constraints hold at the end of the step";

/// The solver for multipliers of sums.
const HELD_SUMS: &str = "the multipliers of sums over all sites together by Newton's method, velocities site by site, so that the \
                         constraints hold at the end of the step";

/// The solver, if velocities enter the momenta of neighbouring sites.
const TOGETHER: &str =
    "the velocities of all sites together by Newton's method with block-tridiagonal derivatives";

/// A summary whose invariants name constraints of all sites together.
fn of_all_sites<'a>(summary: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let each = summary.lines().map(|line| {
        if !line.starts_with("invariants ") {
            return line.to_owned();
        }
        let (head, list) = line.split_at(line.find("  ").unwrap_or(0));
        let spaces: String = list.chars().take_while(|c| *c == ' ').collect();
        let own = list.trim_start().split(", ");
        let own = own.filter(|name| !name.starts_with("constraint_"));
        let all: Vec<&str> = own.chain(names.iter().copied()).collect();
        format!("{head}{spaces}{}", all.join(", "))
    });
    each.collect::<Vec<_>>().join("\n")
}

/// Describes how a chain is run, and lists the quantities that are not computed.
fn program_description(left_out: &[String]) -> String {
    let mut told = String::from(
        "\nprogram              one for any number of sites, with loops over the sites",
    );
    if !left_out.is_empty() {
        told.push_str("; not computed: ");
        told.push_str(&left_out.join(", "));
    }
    told
}

/// Replaces fields in the coordinates of a chain by the fields that users see.
fn in_groups(
    all: &[Coordinates],
    fields: Vec<(Field, Place)>,
    initial: bool,
) -> Vec<(Field, Place)> {
    let each = fields.into_iter().flat_map(|(field, place)| {
        let found = all
            .iter()
            .find_map(|c| Some((c, coordinates::of(c, &place.key)?)));
        let (Some((c, of)), Some(site)) = (found, place.site) else {
            return vec![(field, place)];
        };
        let own = match of {
            UserRole::Rest => Vec::new(),
            UserRole::Element => coordinates::fields(c, site, false, initial),
            UserRole::Momentum => coordinates::fields(c, site, true, initial),
        };
        let placed = own.into_iter().map(|(field, key)| {
            let site = Some(site);
            (field, Place { key, site })
        });
        placed.collect()
    });
    each.collect()
}

type Fields = (&'static [Field], Vec<Place>);

fn split(all: Vec<(Field, Place)>) -> Fields {
    let (fields, places): (Vec<Field>, Vec<Place>) = all.into_iter().unzip();
    (Box::leak(fields.into_boxed_slice()), places)
}

impl Short<'_> {
    /// The momentum of the only configuration of the short chain, which is named without the configuration.
    fn alone(&self, field: &Field, fields: &[Field]) -> Option<Placed> {
        if !["momentum", "body_momentum", "spatial_momentum"].contains(&field.ascii) {
            return None;
        }
        let all = self.lattice.quantities.iter();
        let mut moving = all.filter(|q| q.kind == QuantityKind::Configuration);
        let (own, None) = (moving.next()?, moving.next()) else {
            return None;
        };
        let name = ascii(&own.name.text);
        // If an end condition prescribes it at the first site, it moves at another site.
        let mut places = fields.iter().filter_map(|place| {
            let (of, site) = place.ascii.rsplit_once('_')?;
            site.parse().ok().filter(|_| of == name)
        });
        Some(Placed {
            field: *field,
            place: Place {
                key: format!("{}_{name}", field.ascii),
                site: Some(places.next()?),
            },
            of: own.name.text.clone(),
            label: own.label,
        })
    }

    /// The values of functionals at all of their sites.
    fn functionals(&self) -> Vec<(Field, Place)> {
        let all = self.lattice.quantities.iter();
        let own = all.filter(|q| q.kind == QuantityKind::Functional);
        let each = own.flat_map(|q| {
            let key = ascii(&q.name.text);
            (0..self.whole.sites_of(self.lattice, q)).map(move |site| {
                let name = text(&format!("{}_{site}", q.name.text));
                let field = Kind::Scalar.field(name, [1, 1], "a functional of all sites");
                let place = Place {
                    key: key.clone(),
                    site: Some(site),
                };
                (field.spelt(text(&format!("{key}_{site}"))), place)
            })
        });
        each.collect()
    }

    /// The place of a field, with the quantity of which the field is a copy.
    fn placed(&self, field: &Field, fields: &[Field]) -> Option<Placed> {
        if let Some(alone) = self.alone(field, fields) {
            return Some(alone);
        }
        let (key, digits) = field.ascii.rsplit_once('_')?;
        let site: usize = digits.parse().ok()?;
        let place = |key: &str| Place {
            key: key.to_owned(),
            site: Some(site),
        };
        let mut ends = self.unfolded.end_parameters.iter();
        if ends.any(|(own, ..)| ascii(own) == field.ascii) {
            return Some(Placed {
                field: *field,
                place: place(key),
                of: key.to_owned(),
                label: self.lattice.line?,
            });
        }
        let copy = self.unfolded.copies.iter().find(|c| {
            let of = ascii(&c.of);
            c.site == site && (key == of || key.strip_suffix(&of).is_some_and(|k| k.ends_with('_')))
        })?;
        Some(Placed {
            field: *field,
            place: place(key),
            of: copy.of.clone(),
            label: match self.lattice.find(&copy.of) {
                Some(q) => q.label,
                None => self.held(&copy.of)?,
            },
        })
    }

    /// The label of the sites at which a multiplier enforces a constraint.
    fn held(&self, multiplier: &str) -> Option<usize> {
        let mut all = self.unfolded.holds.iter();
        let own = all.find(|h| h.name == multiplier)?;
        Some(own.range.label)
    }

    /// Renames parameters of the last end condition in a text: their site becomes the last site of the whole chain.
    fn at_its_site(&self, text: &str) -> String {
        let count = self.lattice.line.map_or(0, |line| self.whole.count(line));
        let mut out = text.to_owned();
        for (own, stated, last) in &self.unfolded.end_parameters {
            if *last {
                out = out.replace(&ascii(own), &format!("{}_{count}", ascii(stated)));
            }
        }
        out
    }

    /// The site of the short chain that represents a site of the whole chain.
    fn like(&self, label: usize, site: usize) -> usize {
        let (short, whole) = (self.short.count(label), self.whole.count(label));
        let half = short / 2;
        match (site <= half, whole.saturating_sub(site) < short - half) {
            (true, _) => site,
            (false, true) => short - (whole - site),
            _ => half,
        }
    }

    /// The fields of the whole chain, in the order of the fields of the short chain.
    fn expanded(&self, fields: &[Field]) -> Vec<(Field, Place)> {
        let mut out = Vec::new();
        let mut block: Vec<Placed> = Vec::new();
        for field in fields {
            let placed = self.placed(field, fields);
            let goes_on = match (&placed, block.last()) {
                (Some(here), Some(last)) => here.of == last.of,
                _ => false,
            };
            if !goes_on {
                self.repeat(&mut block, &mut out);
            }
            match placed {
                Some(placed) => block.push(placed),
                None => {
                    let place = Place {
                        key: field.ascii.to_owned(),
                        site: None,
                    };
                    out.push((*field, place));
                }
            }
        }
        self.repeat(&mut block, &mut out);
        out
    }

    /// Repeats the fields of one quantity for all sites.
    fn repeat(&self, block: &mut Vec<Placed>, out: &mut Vec<(Field, Place)>) {
        let Some(label) = block.first().map(|p| p.label) else {
            return;
        };
        for site in 0..=self.whole.count(label) {
            let like = self.like(label, site);
            let own = block.iter().filter(|p| p.place.site == Some(like));
            for p in own {
                let base = p.field.name.rsplit_once('_');
                let base = base.map_or(p.place.key.as_str(), |(base, _)| base);
                let field = Field {
                    name: text(&format!("{base}_{site}")),
                    ascii: text(&format!("{}_{site}", p.place.key)),
                    ..p.field
                };
                let place = Place {
                    key: p.place.key.clone(),
                    site: Some(site),
                };
                out.push((field, place));
            }
        }
        block.clear();
    }
}
