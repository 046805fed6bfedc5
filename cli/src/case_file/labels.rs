//! Cases of models with labels: how many sites, how the line ends, and site data as numbers,
//! expressions in the label, or lists. Gives the same case with a key for every copy, which is read
//! like any other, and the line that each of its lines came from.

use super::beside::Beside;
use super::chosen::choice;
use super::copies::{Base, Copies, base};
use super::fluid::Fluid;
use super::from_npz::{self, Arrays, Fault, Wanted};
use super::inertia::{self, Taken};
use super::location::File;
use super::motion::elements;
use super::scope::Scope;
use super::sites::{self, Site};
use super::space::Space;
use super::value::expected;
use super::velocity::{Way, suffix};
use crate::models::fields::is_momentum;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch::card::{Card, Field, Kind as FieldKind};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{Choice, Lattice};
use clebsch_core::syntax::ast::Model;
use clebsch_core::{document, pipeline};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Number of sites where no case says one.
pub(super) const SITES: usize = 8;

/// Number of particles of a fluid where no case says one.
pub(super) const PARTICLES: usize = 64;

/// A model with labels, as its file states it.
pub(crate) struct Stated {
    pub model: Model,
    pub lattice: Lattice,
}

impl Stated {
    /// Reads the text of a model; `None` where it has no labels or is no model.
    pub(crate) fn read(source: &str) -> Option<Stated> {
        let model = pipeline::parse_source(source).ok()?;
        if !clebsch_core::lattice::has_labels(&model) {
            return None;
        }
        let lattice = Lattice::read(&model).ok()?;
        Some(Stated { model, lattice })
    }

    /// What holds where no case says otherwise.
    pub(crate) fn default_choice(&self) -> Option<Choice> {
        let shortest = pipeline::representative(&self.model, &self.lattice).ok()?;
        let mut choice = document::default_choice(&self.lattice, shortest);
        for count in &mut choice.counts {
            *count = SITES;
        }
        if let Some(space) = Space::sample(self) {
            for (count, label) in choice.counts.iter_mut().zip(&self.lattice.labels) {
                *count = if label.grid { space.count() } else { PARTICLES };
            }
        }
        Some(choice)
    }

    /// Whether a key belongs to an end condition or a ring that is not chosen: a case keeps it.
    pub(super) fn of_other_ends(&self, key: &str) -> bool {
        let ends = self.lattice.ends.iter().flatten();
        let mut names = ends
            .flat_map(|a| &a.params)
            .flat_map(|(names, _)| names.iter().map(|n| ascii(&n.text)));
        let bare = key.rsplit_once('_').map_or(key, |(base, _)| base);
        let mut offsets = self
            .lattice
            .quantities
            .iter()
            .filter_map(|q| q.offset.as_ref());
        names.any(|n| n == key || n == bare) || offsets.any(|o| ascii(&o.text) == key)
    }

    /// The copies of quantities at the sites of a choice.
    pub(crate) fn copies(&self, choice: &Choice) -> Option<Copies> {
        Copies::of(self, choice)
    }
}

pub(super) fn table<'a, 'i>(
    file: &File<'_>,
    top: &'a DeTable<'i>,
    name: &str,
) -> Result<Option<&'a DeTable<'i>>, Failure> {
    let Some(value) = top.get(name) else {
        return Ok(None);
    };
    match value.get_ref().as_table() {
        Some(table) => Ok(Some(table)),
        None => Err(file.wrong(
            Some(&value.span()),
            &format!("{name}: expected a table [{name}]"),
        )),
    }
}

/// A case with a key for every copy, and the line of the file that each of its lines came from. Values of the particles and nodes of
/// a fluid, of which there may be millions, stand beside the text.
pub(crate) struct WrittenOut {
    pub text: String,
    pub lines: Vec<usize>,
    pub beside: Beside,
    /// How many sites there are, and how the line ends.
    pub choice: Choice,
}

impl WrittenOut {
    fn push(&mut self, line: &str, from: usize) {
        for part in line.split('\n') {
            self.text.push_str(part);
            self.text.push('\n');
            self.lines.push(from);
        }
    }
}

/// Writes a case out for the card of its choice.
///
/// # Errors
/// Usage: a missing or unknown key, site data that are none or of another length.
pub(crate) fn written_out(
    name: &str,
    text: &str,
    stated: &Stated,
    card: &Card,
) -> Result<WrittenOut, Failure> {
    let chosen = choice(name, text, stated)?;
    let file = File::new(name, text);
    let copies = chosen.as_ref().and_then(|choice| stated.copies(choice));
    let (Some(choice), Some(copies)) = (chosen, copies) else {
        return Err(file.wrong(None, "the model's lattice cannot be written out"));
    };
    let document = file.document()?;
    let top = document.get_ref();
    let scope = Scope::of(top);
    let mut out = WrittenOut {
        text: String::new(),
        lines: Vec::new(),
        beside: Beside::default(),
        choice: choice.clone(),
    };
    let raw = |span: &Range<usize>| text.get(span.clone()).unwrap_or_default().to_owned();
    const TABLES: [&str; 7] = [
        "labels",
        "domain",
        super::functions::TABLE,
        "ends",
        "parameters",
        "initial",
        "bounds",
    ];
    if let Some((key, _)) = top.get_key_value(super::functions::TABLE)
        && !super::functions::are_given(&stated.model)
    {
        let message = format!("unknown key `{}` at the top level", key.get_ref());
        return Err(file.wrong(Some(&key.span()), &message));
    }
    for (key, value) in top {
        let name = key.get_ref().as_ref();
        if TABLES.contains(&name) {
            continue;
        }
        // Expressions are evaluated here, where all names have their values.
        let is_number = ["h", "steps"].contains(&name) && value.get_ref().is_str();
        let text = match is_number {
            true => {
                let found = scope.read(value.get_ref());
                let wrong = |why| file.wrong(Some(&value.span()), &format!("{name}: {why}"));
                sites::spelt(found.map_err(wrong)?)
            }
            false => raw(&value.span()),
        };
        let line = format!("{} = {text}", key_text(name));
        out.push(&line, file.line(&value.span()));
    }
    let parameters = table(&file, top, "parameters")?;
    let initial = table(&file, top, "initial")?;
    let fluid = Fluid::read(&file, top, stated, &choice)?;
    let writer = Writer {
        fluid: fluid.as_ref(),
        file: &file,
        stated,
        choice: &choice,
        copies: &copies,
        scope,
        arrays: Arrays::of(&file),
    };
    writer.fields(&mut out, "parameters", card.parameters, parameters, initial)?;
    writer.fields(&mut out, "initial", card.initial, initial, None)?;
    if let Some(bounds) = table(&file, top, "bounds")? {
        out.push("[bounds]", 0);
        for (key, value) in bounds {
            let line = format!("{} = {}", key_text(key.get_ref()), raw(&value.span()));
            out.push(&line, file.line(&value.span()));
        }
    }
    Ok(out)
}

fn key_text(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match key.chars().all(bare) {
        true => key.to_owned(),
        false => format!("{key:?}"),
    }
}

struct Writer<'a> {
    fluid: Option<&'a Fluid>,
    file: &'a File<'a>,
    stated: &'a Stated,
    choice: &'a Choice,
    copies: &'a Copies,
    scope: Scope,
    arrays: Arrays,
}

type Table<'a, 'i> = Option<&'a DeTable<'i>>;

impl Writer<'_> {
    /// One table; of what is given at an end, values may stand among the initial ones (`others`).
    fn fields(
        &self,
        out: &mut WrittenOut,
        name: &'static str,
        fields: &[Field],
        values: Table<'_, '_>,
        others: Table<'_, '_>,
    ) -> Result<(), Failure> {
        out.push(&format!("[{name}]"), 0);
        let taken = Taken::of(fields);
        let elements = elements(fields);
        let read = self.fluid.into_iter().flat_map(Fluid::used);
        let mut used: HashSet<String> = read.map(str::to_owned).collect();
        let mut told: Vec<String> = Vec::new();
        for (index, field) in fields.iter().enumerate() {
            let base = base(self.copies, field);
            let own = base.as_ref().map(|b| (b.key.as_str(), b.site));
            if let Some((numbers, line)) = self.fluid.and_then(|f| f.numbers(field, own)) {
                out.beside.keep(name, index, numbers);
                if let Some((key, _)) = own
                    && !told.iter().any(|own| own == key)
                {
                    told.push(key.to_owned());
                    out.beside.stands(name, key, line);
                }
                continue;
            }
            if let Some((text, line)) = self.fluid.and_then(|f| f.text(field.ascii, own)) {
                out.push(&format!("{} = {text}", field.ascii), line);
                continue;
            }
            let mut found = None;
            for (own, site) in self.keys(field, base.as_ref(), &taken) {
                let value = values.and_then(|t| t.get(own.as_str()));
                let given = base.as_ref().is_some_and(|b| b.given);
                let other = others.filter(|_| given).and_then(|t| t.get(own.as_str()));
                used.insert(own.clone());
                if let Some(value) = value.or(other) {
                    found = Some((own, site, value));
                    if other.is_some_and(|o| std::ptr::eq(o, value)) {
                        out.beside.is_initial(field.ascii);
                    }
                    break;
                }
            }
            if let Some((own, site, value)) = found {
                let of_inertia = own.starts_with('I') && field.ascii.starts_with('J');
                // The inertia of a copy stands under the key of its own.
                let inertial = inertia::key(field, &taken);
                let written = match (&inertial, of_inertia) {
                    (Some(key), true) => key.as_str(),
                    _ => field.ascii,
                };
                let asked = match of_inertia && from_npz::is_meant(value.get_ref()) {
                    true => inertia::field(field),
                    false => *field,
                };
                let place = (base.as_ref(), site);
                self.one(out, (name, written), (&asked, place), (&own, value))?;
                continue;
            }
            if is_momentum(field) {
                self.velocities(
                    out,
                    (name, index),
                    fields,
                    (&elements, base.as_ref()),
                    values,
                    &mut used,
                )?;
                continue;
            }
            if let Some(base) = &base {
                return Err(self.missing(name, field, base));
            }
        }
        if name == "initial" {
            used.extend(out.beside.all_initial().map(str::to_owned));
        }
        self.unknown(name, values, &used)
    }

    /// Writes the value of a field that was found under a key.
    fn one(
        &self,
        out: &mut WrittenOut,
        (name, written): (&str, &str),
        (field, (base, site)): (&Field, (Option<&Base>, bool)),
        (own, value): (&str, &Spanned<DeValue<'_>>),
    ) -> Result<(), Failure> {
        let table = match out.beside.initial(field.ascii) {
            true => "initial",
            false => name,
        };
        let wrong = |why: &str, at: &Range<usize>| {
            let message = format!("{table}.{}: {why}", shown(own));
            self.file.wrong(Some(at), &message)
        };
        let text = match (base, site) {
            _ if from_npz::is_meant(value.get_ref()) => {
                let text = self.of_array(field, base.map(|b| (b, site)), own, value);
                Ok(text.map_err(|fault| wrong(&fault.why, &fault.at))?)
            }
            (Some(base), true) => self.at_site(field, base, value),
            _ => self.by_own_name(field, value),
        };
        let text = text.map_err(|why| wrong(&why, &value.span()))?;
        let line = self.file.line(&value.span());
        out.push(&format!("{written} = {text}"), line);
        Ok(())
    }

    /// Writes the velocities of a configuration whose momentum is not given; without any it rests.
    fn velocities(
        &self,
        out: &mut WrittenOut,
        (name, index): (&'static str, usize),
        fields: &[Field],
        (elements, base): (&HashMap<usize, usize>, Option<&Base>),
        values: Table<'_, '_>,
        used: &mut HashSet<String>,
    ) -> Result<(), Failure> {
        let momentum = fields.get(index);
        let element = elements.get(&index).and_then(|at| fields.get(*at));
        let (Some(momentum), Some(element)) = (momentum, element) else {
            return Ok(());
        };
        for way in Way::ALL
            .into_iter()
            .filter(|way| way.is_of(element, momentum))
        {
            let Some(written) = way.key(momentum.ascii) else {
                continue;
            };
            if let Some((text, line)) = base
                .and_then(|b| Some((way.key(&b.key)?, b.site)))
                .and_then(|(key, site)| self.fluid?.text(&written, Some((&key, site))))
            {
                out.push(&format!("{written} = {text}"), line);
                continue;
            }
            let of_all = base.and_then(|b| way.key(&b.key));
            let named = suffix(momentum.ascii)
                .is_some_and(str::is_empty)
                .then(|| format!("{written}_{}", element.ascii));
            let keys = [
                (Some(written.clone()), false),
                (named, false),
                (of_all, true),
            ];
            let mut keys = keys
                .into_iter()
                .filter_map(|(key, site)| Some((key?, site)));
            let found = keys.find_map(|(key, site)| {
                let value = values.and_then(|t| t.get(key.as_str()));
                used.insert(key.clone());
                Some((key, site, value?))
            });
            if let Some((own, site, value)) = found {
                let field = way.field(element, momentum);
                self.one(out, (name, &written), (&field, (base, site)), (&own, value))?;
            }
        }
        Ok(())
    }

    /// The keys under which a field may stand, and whether each is that of all sites.
    fn keys(&self, field: &Field, base: Option<&Base>, taken: &Taken<'_>) -> Vec<(String, bool)> {
        let mut keys = vec![(field.ascii.to_owned(), false)];
        keys.extend(inertia::key(field, taken).map(|k| (k, false)));
        if let Some(base) = base {
            let count = self.choice.count(base.label);
            if base.site == count
                && let Some(l) = self.stated.lattice.labels.get(base.label)
            {
                keys.push((format!("{}_{}", base.key, l.count.text), false));
            }
            keys.push((base.key.clone(), true));
            if field.kind == FieldKind::SecondMoments
                && let Some(rest) = base.key.strip_prefix('J')
            {
                keys.push((format!("I{rest}"), true));
            }
        }
        keys
    }

    fn number(&self, name: &str, site: Option<&Base>) -> Option<f64> {
        let labels = &self.stated.lattice.labels;
        if let Some(i) = labels.iter().position(|l| l.count.text == name) {
            #[allow(clippy::cast_precision_loss)]
            return Some(self.choice.count(i) as f64);
        }
        if let Some(base) = site
            && let Some(l) = labels.get(base.label)
            && l.index.text == name
        {
            #[allow(clippy::cast_precision_loss)]
            return Some(base.site as f64);
        }
        self.scope.number(name)
    }

    /// The value of a copy.
    fn at_site(
        &self,
        field: &Field,
        base: &Base,
        value: &Spanned<DeValue<'_>>,
    ) -> Result<String, String> {
        // Momenta have no value where their configuration is given; a list may leave these sites out.
        let group = self.copies.groups.iter().find(|g| g.of == base.of);
        let (every, left) = group.map_or((&[][..], &[][..]), |g| (&g.sites[..], &g.moving[..]));
        let place = |list: &[usize]| list.binary_search(&base.site).unwrap_or(0);
        let label = self.stated.lattice.labels.get(base.label);
        let index = label.map_or("i", |l| l.index.text.as_str());
        let at = Site {
            named: &format!("{index} = {}", base.site),
            field,
            place: place(every),
            count: if base.end { 1 } else { every.len() },
            moving: match base.is_momentum {
                true => Some((place(left), left.len())),
                false => None,
            },
        };
        sites::at(&at, value.get_ref(), &|n| self.number(n, Some(base)))
    }

    /// The value of a copy, or of what belongs to no site, from an array of a file.
    fn of_array(
        &self,
        field: &Field,
        place: Option<(&Base, bool)>,
        named: &str,
        value: &Spanned<DeValue<'_>>,
    ) -> Result<String, Fault> {
        let values = from_npz::shapes(field);
        let base = place.filter(|(b, site)| *site && !b.end).map(|(b, _)| b);
        let group = base.and_then(|b| self.copies.groups.iter().find(|g| g.of == b.of));
        let may_move = base.is_some_and(|b| b.is_momentum);
        let wanted = Wanted {
            values: &values,
            sites: group.map(|g| &g.sites[..]),
            moving: group.filter(|_| may_move).map(|g| &g.moving[..]),
        };
        let taken = self.arrays.take(value, named, wanted)?;
        let whole = |why: String| Fault {
            why,
            at: value.span(),
        };
        let text = taken.text(base.map_or(0, |b| b.site)).map_err(whole)?;
        let own = DeValue::parse(&text).map_err(|e| whole(e.message().to_owned()))?;
        self.by_own_name(field, &own).map_err(whole)
    }

    /// A value under the name with its site, or of what has none.
    fn by_own_name(&self, field: &Field, value: &Spanned<DeValue<'_>>) -> Result<String, String> {
        let found = sites::of_field(field, value.get_ref(), &|n| self.number(n, None));
        found.map_err(|why| self.scope.explained(why))
    }

    fn missing(&self, table: &str, field: &Field, base: &Base) -> Failure {
        let label = self.stated.lattice.labels.get(base.label);
        let index = label.map_or("i", |l| l.index.text.as_str());
        let what = expected(field);
        let message = match base.end {
            true => format!(
                "missing key `{table}.{}`: {what}, of the end condition at site {}",
                base.key, base.site
            ),
            false => format!(
                "missing key `{table}.{}` for site {index} = {}: {what}, with numbers or expressions in {index} for all sites, or a list of such for each",
                base.key, base.site
            ),
        };
        self.file.wrong(None, &message)
    }

    fn unknown(
        &self,
        name: &str,
        values: Table<'_, '_>,
        used: &HashSet<String>,
    ) -> Result<(), Failure> {
        for (key, value) in values.into_iter().flatten() {
            let asked = key.get_ref().as_ref();
            if used.contains(asked) {
                continue;
            }
            // Of a configuration whose every copy is given nothing is initial, and of an alternative
            // that is not chosen nothing is asked.
            let of_given = self.copies.groups.iter().any(|g| g.of == asked);
            let of_other_ends = self.stated.of_other_ends(asked);
            if (name == "initial" && of_given) || (name == "parameters" && of_other_ends) {
                continue;
            }
            let mut names: Vec<&str> = used.iter().map(String::as_str).collect();
            names.sort_unstable();
            let hint = did_you_mean(asked, names);
            let _ = value;
            return Err(self.file.wrong(
                Some(&key.span()),
                &format!("unknown key `{}` in [{name}]{hint}", shown(asked)),
            ));
        }
        Ok(())
    }
}
