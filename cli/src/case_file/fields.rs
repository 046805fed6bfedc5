//! The tables `[parameters]` and `[initial]` of a case. Takes a table and the fields of a card; gives the numbers of each field, in
//! order, and how configurations start whose momenta are not given.

use super::beside::Beside;
use super::from_npz::{self, Arrays};
use super::inertia::{self, Given, Taken};
use super::location::File;
use super::motion::{Motion, Start, elements};
use super::read::{known_keys, table};
use super::scope::Scope;
use super::value::{self, Numbers, expected};
use super::velocity::{self, Way};
use crate::models::fields::is_momentum;
use crate::terminal::failure::Failure;
use crate::words::suggestion::slip;
use clebsch::card::{Field, Kind};
use std::collections::{BTreeMap, HashMap, HashSet};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Reads the numbers of a field from a value.
type Read = fn(&Field, &DeValue<'_>, &Numbers<'_>) -> Result<Vec<f64>, String>;

/// Reads tables of a case.
pub(super) struct Fields<'a> {
    pub file: &'a File<'a>,
    /// Values that stand beside the text.
    pub beside: &'a Beside,
    pub scope: &'a Scope,
    /// The lines of keys.
    pub lines: &'a mut BTreeMap<String, usize>,
    /// What is given by velocities, and what rests.
    pub motion: Motion,
}

/// One table.
struct Table<'t, 'i> {
    name: &'static str,
    fields: &'static [Field],
    table: &'t DeTable<'i>,
    taken: Taken<'static>,
    /// The names of all fields.
    names: HashSet<&'static str>,
    /// The configuration of each momentum.
    elements: HashMap<usize, usize>,
    arrays: Arrays,
}

impl Fields<'_> {
    /// The numbers of the fields of a table.
    pub(super) fn read(
        &mut self,
        top: &DeTable<'_>,
        name: &'static str,
        fields: &'static [Field],
    ) -> Result<Vec<Vec<f64>>, Failure> {
        let nothing = DeTable::new();
        let (found, span) = match table(self.file, top, name)? {
            Some((table, span)) => (table, Some(span)),
            None => (&nothing, None),
        };
        let needed: Vec<&str> = fields
            .iter()
            .filter(|field| !is_momentum(field))
            .map(|field| field.ascii)
            .collect();
        if span.is_none() && !needed.is_empty() {
            let message = format!("missing table [{name}] with keys {}", needed.join(", "));
            return Err(self.file.wrong(None, &message));
        }
        let own = Table {
            name,
            fields,
            table: found,
            taken: Taken::of(fields),
            names: fields.iter().map(|field| field.ascii).collect(),
            elements: elements(fields),
            arrays: Arrays::of(self.file),
        };
        self.known(&own)?;
        let mut values = Vec::with_capacity(fields.len());
        for (index, field) in fields.iter().enumerate() {
            if let Some(numbers) = self.beside.get(name, index) {
                values.push(numbers.to_vec());
                continue;
            }
            let read = match own.given(field) {
                Some(key) => {
                    if let Some((other, value)) = own.velocities(index).pop() {
                        let message =
                            format!("{name}.{other}: is given beside {key}: give one of them");
                        return Err(self.file.wrong(Some(&value.span()), &message));
                    }
                    self.value(&own, field, key)?
                }
                None if is_momentum(field) && own.elements.contains_key(&index) => {
                    self.moving(&own, index)?;
                    vec![0.0; field.count()]
                }
                None => {
                    let message = format!(
                        "missing key `{}.{}`: {}",
                        self.stands(&own, field),
                        field.ascii,
                        expected(field)
                    );
                    return Err(self.file.wrong(span.as_ref(), &message));
                }
            };
            values.push(read);
        }
        Ok(values)
    }

    /// The table in which a field stands: what an end holds is an initial value.
    fn stands(&self, own: &Table<'_, '_>, field: &Field) -> &'static str {
        match self.beside.initial(field.ascii) {
            true => "initial",
            false => own.name,
        }
    }

    /// Refuses keys that no field has.
    fn known(&self, own: &Table<'_, '_>) -> Result<(), Failure> {
        let mut keys = own.table.keys();
        if keys.all(|key| own.names.contains(key.get_ref().as_ref())) {
            return Ok(());
        }
        let in_text = own.fields.iter().enumerate();
        let in_text = in_text.filter(|(index, _)| self.beside.get(own.name, *index).is_none());
        let mut known: Vec<String> = Vec::new();
        let mut seen: HashSet<String> = HashSet::new();
        for (index, field) in in_text {
            let mut add = |key: String| {
                if seen.insert(key.clone()) {
                    known.push(key);
                }
            };
            add(field.ascii.to_owned());
            inertia::key(field, &own.taken)
                .into_iter()
                .for_each(&mut add);
            if let Some(base) = own.of_all_copies(field.ascii) {
                add(base.to_owned());
                let of_all = inertia::key_of(field, base, &own.taken);
                of_all.into_iter().for_each(&mut add);
            }
            own.ways(index)
                .into_iter()
                .flat_map(|(_, keys)| keys)
                .for_each(add);
        }
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        let otherwise = |asked: &str| {
            // `"Λ"` is how the model writes it, but files use the ASCII name.
            let written = own.fields.iter().find(|field| field.name == asked);
            if let Some(field) = written {
                return Some(format!("; did you mean `{}`?", field.ascii));
            }
            if let Some(near) = slip(asked, &names) {
                return Some(format!("; did you mean `{near}`?"));
            }
            velocity::is_meant(asked)
                .then(|| own.how_to_move())
                .flatten()
        };
        let place = format!("in [{}]", own.name);
        known_keys(self.file, own.table, &names, &place, &otherwise)
    }

    /// The numbers of a field that is given under a key.
    fn value(
        &mut self,
        own: &Table<'_, '_>,
        field: &'static Field,
        key: &str,
    ) -> Result<Vec<f64>, Failure> {
        let stands = self.stands(own, field);
        let shown = inertia::shown_key(own.table, field, key, &own.taken);
        let (value, found) = match inertia::given(own.table, field, key, &own.taken) {
            Given::Own(value) => {
                let read = self.numbers(own, (field, field), (&shown, value), value::numbers);
                (value, read?)
            }
            Given::Inertia(value) => {
                let inertia = inertia::field(field);
                let of = (field, &inertia);
                let read = self.numbers(own, of, (&shown, value), inertia::second_moments);
                (value, read?)
            }
            Given::Twice(value) => (
                value,
                Err("is given twice, by itself and by its inertia".to_owned()),
            ),
            Given::Missing => return Ok(Vec::new()),
        };
        let found = found.map_err(|message| {
            let message = format!("{stands}.{shown}: {message}");
            self.file.wrong(Some(&value.span()), &message)
        })?;
        let line = self.file.line(&value.span());
        self.lines.insert(format!("{stands}.{}", field.ascii), line);
        Ok(found)
    }

    /// The numbers of a value, or of an array of a file: `of` has the field and the shape of its array.
    fn numbers(
        &self,
        own: &Table<'_, '_>,
        (field, as_array): (&Field, &Field),
        (shown, value): (&str, &Spanned<DeValue<'_>>),
        read: Read,
    ) -> Result<Result<Vec<f64>, String>, Failure> {
        let of = |name: &str| self.scope.number(name);
        if !from_npz::is_meant(value.get_ref()) {
            let found = read(field, value.get_ref(), &of);
            return Ok(found.map_err(|why| self.scope.explained(why)));
        }
        let named = shown.trim_end_matches(".I");
        let text = own.arrays.whole(as_array, value, named).map_err(|fault| {
            let message = format!("{}.{shown}: {}", self.stands(own, field), fault.why);
            self.file.wrong(Some(&fault.at), &message)
        })?;
        let one = DeValue::parse(&text);
        let one = one.map_err(|e| self.file.wrong(Some(&value.span()), e.message()))?;
        Ok(read(field, one.get_ref(), &of))
    }

    /// The motion of a configuration whose momentum is not given.
    fn moving(&mut self, own: &Table<'_, '_>, index: usize) -> Result<(), Failure> {
        let (Some(momentum), Some(element)) = (own.fields.get(index), own.element(index)) else {
            return Ok(());
        };
        let given = own.velocities(index);
        let turns = |way: Way| way != Way::Rate;
        let mut before: Option<&str> = None;
        for (key, value) in &given {
            let way = own.way(index, key);
            let Some(way) = way else { continue };
            if let Some(other) = before.filter(|_| turns(way)) {
                let message = format!(
                    "{}.{key}: is given beside {other}: give one of them",
                    own.name
                );
                return Err(self.file.wrong(Some(&value.span()), &message));
            }
            before = turns(way).then_some(key.as_str()).or(before);
            let field = way.field(element, momentum);
            let read = self.numbers(own, (&field, &field), (key, value), velocity_numbers)?;
            let numbers = read.map_err(|why| {
                let message = format!("{}.{key}: {why}", own.name);
                self.file.wrong(Some(&value.span()), &message)
            })?;
            let line = self.file.line(&value.span());
            self.lines
                .insert(format!("{}.{}", own.name, momentum.ascii), line);
            self.motion.given.push(Start {
                momentum: index,
                way,
                key: key.clone(),
                line,
                numbers,
            });
        }
        if given.is_empty() {
            self.motion.resting.push(index);
        }
        Ok(())
    }
}

/// Of a skew matrix both halves are looked at.
fn velocity_numbers(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    let all = value::numbers(field, value, of)?;
    let n = field.rows;
    let at = |i: usize, j: usize| all.get(i * n + j).copied().unwrap_or_default();
    let off =
        |k: usize| (at(k / n, k % n) + at(k % n, k / n)).abs() > 1e-9 * at(k / n, k % n).abs();
    match field.kind == Kind::Skew && (0..n * n).any(off) {
        true => Err("not skew: an angular velocity W of n dimensions is a skew matrix, the rate of change of R being R*W".to_owned()),
        false => Ok(all),
    }
}

impl<'t, 'i> Table<'t, 'i> {
    /// The key by which a field is given: its own, or that of all copies.
    fn given(&self, field: &'static Field) -> Option<&'static str> {
        let is_given = |key: &str| {
            !matches!(
                inertia::given(self.table, field, key, &self.taken),
                Given::Missing
            )
        };
        let all = self.of_all_copies(field.ascii);
        [Some(field.ascii), all]
            .into_iter()
            .flatten()
            .find(|key| is_given(key))
    }

    /// The name of all copies of a quantity whose names end in numbers: `x` of `x1`, `x_2`. None where a field has it.
    fn of_all_copies<'k>(&self, name: &'k str) -> Option<&'k str> {
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let stem = match stem.len() < name.len() {
            true => stem.strip_suffix('_').unwrap_or(stem),
            false => return None,
        };
        (!stem.is_empty() && !self.names.contains(stem)).then_some(stem)
    }

    fn element(&self, momentum: usize) -> Option<&'static Field> {
        let at = self.elements.get(&momentum)?;
        self.fields.get(*at)
    }

    /// The velocities that a configuration may have, and the keys of each.
    fn ways(&self, momentum: usize) -> Vec<(Way, Vec<String>)> {
        let (Some(field), Some(element)) = (self.fields.get(momentum), self.element(momentum))
        else {
            return Vec::new();
        };
        let own = Way::ALL.into_iter().filter(|way| way.is_of(element, field));
        let each = own.filter_map(|way| {
            let key = way.key(field.ascii)?;
            let named = velocity::suffix(field.ascii)
                .is_some_and(str::is_empty)
                .then(|| format!("{key}_{}", element.ascii));
            let all = self.of_all_copies(&key).map(str::to_owned);
            let keys = [Some(key), named, all].into_iter().flatten();
            // A field of the model may bear such a name.
            let keys: Vec<String> = keys.filter(|k| !self.names.contains(k.as_str())).collect();
            Some((way, keys))
        });
        each.collect()
    }

    fn way(&self, momentum: usize, key: &str) -> Option<Way> {
        let ways = self.ways(momentum).into_iter();
        let mut own = ways.filter(|(_, keys)| keys.iter().any(|k| k == key));
        own.next().map(|(way, _)| way)
    }

    /// The velocities that are given of a configuration, each under the first of its keys.
    fn velocities(&self, momentum: usize) -> Vec<(String, &'t Spanned<DeValue<'i>>)> {
        let ways = self.ways(momentum).into_iter();
        let found = ways.filter_map(|(_, keys)| {
            keys.into_iter()
                .find_map(|key| Some((self.table.get(key.as_str())?, key)))
        });
        found.map(|(value, key)| (key, value)).collect()
    }

    /// Which keys a reader may write who looks for velocities.
    fn how_to_move(&self) -> Option<String> {
        let mut keys: Vec<String> = Vec::new();
        for index in 0..self.fields.len().min(64) {
            let ways = self.ways(index).into_iter();
            let first = ways.filter_map(|(way, keys)| Some((way, keys.into_iter().next()?)));
            for (way, key) in first {
                let said = match way {
                    Way::Rate => format!("`{key}`"),
                    Way::Body => format!("`{key}` (in the axes of the body)"),
                    Way::Space => format!("`{key}` (in those of space)"),
                };
                if !keys.contains(&said) {
                    keys.push(said);
                }
            }
        }
        (!keys.is_empty()).then(|| format!("; velocities are given by {}", keys.join(", ")))
    }
}
