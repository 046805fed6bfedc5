//! A number of a case by its name on the command line: `gU.z`, `q_3`, `h`.
//! Takes a name and a card; gives the entries of parameters or initial values with this name, or the step size.

use crate::case_file::stated::Stated;
use crate::case_file::{Motion, at_site, is_key_of_rotation, is_velocity, velocity_keys};
use crate::models::gallery::Case;
use crate::overrides::substitute::is_within_a_table;
use clebsch::card::{Card, Field, Kind};

/// A quantity that can be set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    /// The name as the user typed it, such as `gU.z`.
    pub name: String,
    place: Place,
}

/// The destination of a value.
#[derive(Clone, Debug, PartialEq)]
enum Place {
    Step,
    /// Fields and entries of a parameter, each entry with the sign that its kind requires. On a chain there may
    /// be a field per site.
    Parameter(Vec<usize>, Vec<(usize, f64)>),
    Initial(Vec<usize>, Vec<(usize, f64)>),
    /// An entry of a table of the case, which is read again with the value inserted into its text.
    Text,
    /// Entries of velocities that the case gives.
    Velocity(Vec<usize>, Vec<(usize, f64)>),
}

impl Quantity {
    /// The quantity called `name`.
    ///
    /// # Errors
    /// The mistake in the name, and the names of the model.
    pub fn read(name: &str, card: &Card, motion: &Motion) -> Result<Self, String> {
        let name = name.trim();
        let place = place(name, card, motion)?;
        Ok(Self {
            name: name.to_owned(),
            place,
        })
    }

    /// A quantity of a case that is read from a text, or an entry of a table in it, such as the angle of a rotation.
    ///
    /// # Errors
    /// As [`Quantity::read`].
    pub fn of_case(
        name: &str,
        card: &Card,
        motion: &Motion,
        text: Option<&str>,
    ) -> Result<Self, String> {
        match text.is_some_and(|text| is_within_a_table(text, name.trim())) {
            true => Ok(Self {
                name: name.trim().to_owned(),
                place: Place::Text,
            }),
            false => Self::read(name, card, motion),
        }
    }

    /// Whether the case is read again with its value.
    pub fn is_of_text(&self) -> bool {
        self.place == Place::Text
    }

    /// The components of a vector, if `name` is one.
    pub fn components(name: &str, card: &Card, motion: &Motion) -> Option<Vec<Self>> {
        let name = name.trim();
        let own = found(name, card.parameters, card)
            .or_else(|| motion.named(name, card))
            .or_else(|| found(name, card.initial, card));
        let (_, field) = own.filter(|(_, field)| field.cols == 1 && field.rows > 1)?;
        let each = (1..=field.rows).map(|i| Self::read(&format!("{name}.{i}"), card, motion).ok());
        each.collect()
    }

    /// Whether it is the step size.
    pub fn is_step(&self) -> bool {
        self.place == Place::Step
    }

    /// The step size itself.
    #[cfg(test)]
    pub fn step() -> Self {
        Self {
            name: "h".to_owned(),
            place: Place::Step,
        }
    }

    /// Whether both quantities set a common number.
    pub fn meets(&self, other: &Self) -> bool {
        match (&self.place, &other.place) {
            (Place::Step, Place::Step) => true,
            (Place::Text, Place::Text) => self.name == other.name,
            (Place::Parameter(a, own), Place::Parameter(b, others))
            | (Place::Initial(a, own), Place::Initial(b, others))
            | (Place::Velocity(a, own), Place::Velocity(b, others)) => {
                let is_other = |at: usize| others.iter().any(|(other, _)| *other == at);
                // Fields are sorted; a chain may have a hundred thousand of them, so this is a binary search.
                own.iter().any(|(at, _)| is_other(*at))
                    && a.iter().any(|field| b.binary_search(field).is_ok())
            }
            _ => false,
        }
    }

    /// For a parameter: the fields and entries that it sets, each with a sign.
    pub fn of_parameter(&self) -> Option<Vec<(usize, usize, f64)>> {
        let Place::Parameter(fields, entries) = &self.place else {
            return None;
        };
        let of = |field: &usize| {
            let field = *field;
            entries
                .iter()
                .map(move |(entry, sign)| (field, *entry, *sign))
        };
        Some(fields.iter().flat_map(of).collect())
    }

    /// Sets a value in a case, or in its initial velocities.
    pub fn put(&self, value: f64, case: &mut Case, motion: &mut Motion) {
        let entries = |list: &mut Vec<Vec<f64>>, fields: &[usize], entries: &[(usize, f64)]| {
            for (field, (entry, sign)) in fields
                .iter()
                .flat_map(|field| entries.iter().map(move |entry| (field, entry)))
            {
                if let Some(x) = list.get_mut(*field).and_then(|own| own.get_mut(*entry)) {
                    *x = sign * value;
                }
            }
        };
        match &self.place {
            Place::Text => {}
            Place::Step => case.h = value,
            Place::Parameter(fields, list) => entries(&mut case.parameters, fields, list),
            Place::Initial(fields, list) => {
                entries(&mut case.initial, fields, list);
                fields.iter().for_each(|field| motion.gives(*field));
            }
            Place::Velocity(places, list) => {
                for place in places {
                    for (entry, sign) in list {
                        motion.set(*place, *entry, sign * value);
                    }
                }
            }
        }
    }
}

fn place(name: &str, card: &Card, motion: &Motion) -> Result<Place, String> {
    if name == "h" {
        return Ok(Place::Step);
    }
    let (field, component) = match name.split_once('.') {
        Some((field, component)) => (field, Some(component)),
        None => (name, None),
    };
    if let Some((at, own)) = found(field, card.parameters, card) {
        return Ok(Place::Parameter(at, entries(&own, field, component)?));
    }
    if let Some((at, own)) = motion.named(field, card) {
        return Ok(Place::Velocity(at, entries(&own, field, component)?));
    }
    if let Some((at, own)) = found(field, card.initial, card) {
        if let Some(key) = at.iter().find_map(|at| motion.key_of(*at)) {
            return Err(format!("the case gives {key} instead; set {key}"));
        }
        return Ok(Place::Initial(at, entries(&own, field, component)?));
    }
    if is_velocity(field, card) {
        return Err(format!(
            "the case gives the momentum instead of `{field}`; give the whole velocity, with --set {field}=..., or in the case"
        ));
    }
    if let Some(label) = label(name, card) {
        return Err(format!(
            "`{name}` is the number of sites of `{label}`: set it in the case, as `{name} = ...` under [labels]"
        ));
    }
    Err(format!(
        "`{}` has no such parameter or initial value; it has {} and the step h",
        card.kebab,
        settable(card).join(", ")
    ))
}

/// The names that can be set, without the numbers of sites. A velocity may take the place of a momentum.
fn settable(card: &Card) -> Vec<String> {
    let mut names: Vec<&str> = Vec::new();
    for fields in [card.parameters, card.initial] {
        for own in fields {
            let stem = at_site(own.ascii).map(|(stem, _)| stem);
            // There may be a hundred thousand sites; only the first copy of a quantity is looked up.
            if stem.is_some_and(|stem| names.contains(&stem)) {
                continue;
            }
            let name = stem.filter(|stem| found(stem, fields, card).is_some());
            let name = name.unwrap_or(own.ascii);
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    let velocities = velocity_keys(card);
    let names = names.into_iter().map(str::to_owned);
    names.chain(velocities).collect()
}

/// The index of the label whose number of sites has this name.
fn label(name: &str, card: &Card) -> Option<String> {
    let stated = Stated::read(card.source)?;
    let mut labels = stated.lattice.labels.iter();
    let own = labels.find(|l| l.count.text == name && !l.grid)?;
    Some(own.index.text.clone())
}

/// The fields with a name, and the first of them. A chain uses the names of a case file: a name without a site number
/// means all sites or both ends, and `_N` means the last end.
fn found(name: &str, fields: &'static [Field], card: &Card) -> Option<(Vec<usize>, Field)> {
    let all = card.parameters.iter().chain(card.initial);
    let last = all.filter_map(|f| Some(at_site(f.ascii)?.1)).max();
    let of = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let fields = fields.iter().enumerate();
        let found = fields.filter(|(_, f)| is(f.name) || is(f.ascii));
        found.map(|(at, _)| at).collect()
    };
    let mut own = of(&|own| own == name);
    if own.is_empty() {
        own = of(&|own| at_site(own).is_some_and(|(stem, _)| stem == name));
        let numbers: Vec<usize> = own
            .iter()
            .filter_map(|at| Some(at_site(fields.get(*at)?.ascii)?.1))
            .collect();
        let of_ends =
            numbers.len() == 2 && numbers.first() == Some(&0) && numbers.last() == last.as_ref();
        let of_all = numbers.iter().enumerate().all(|(at, number)| *number == at);
        if !(numbers.len() == 1 || of_ends || of_all) {
            own.clear();
        }
    }
    if let (true, Some(stem)) = (own.is_empty(), name.strip_suffix("_N")) {
        own = of(&|own| at_site(own).is_some_and(|(s, number)| s == stem && Some(number) == last));
    }
    let first = *fields.get(*own.first()?)?;
    Some((own, first))
}

/// The entries of a field that a component names. If the kind is symmetric or skew, the mirrored entry is
/// included.
fn entries(
    field: &Field,
    name: &str,
    component: Option<&str>,
) -> Result<Vec<(usize, f64)>, String> {
    let (rows, cols) = (field.rows, field.cols);
    let Some(component) = component else {
        return match rows * cols {
            1 => Ok(vec![(0, 1.0)]),
            count => Err(format!(
                "`{name}` has {count} numbers; name one, such as {name}.{}",
                if cols == 1 { "1" } else { "11" }
            )),
        };
    };
    if matches!(field.kind, Kind::Rotation | Kind::UnitQuaternion) && is_key_of_rotation(component)
    {
        return Err(format!(
            "in the case, `{name}` is not a table with `{component}`; write `--set '{name}={{axis=[0,1,0], angle=1}}'`, or \
             this table in the case"
        ));
    }
    let outside = || match cols {
        1 => format!(
            "`{name}` has the components {name}.1 to {name}.{rows}, or x, y, z if there are three"
        ),
        _ => {
            format!("`{name}` has the entries {name}.11 to {name}.{rows}{cols}, row before column")
        }
    };
    let number = |text: &str, most: usize| {
        let number = text.parse::<usize>().ok()?;
        (1..=most).contains(&number).then(|| number - 1)
    };
    if cols == 1 {
        let letter = ["x", "y", "z"]
            .iter()
            .position(|letter| *letter == component);
        let entry = letter
            .filter(|_| rows == 3)
            .or_else(|| number(component, rows));
        return Ok(vec![(entry.ok_or_else(outside)?, 1.0)]);
    }
    let (row, col) = match component.split_once('_') {
        Some(pair) => pair,
        None if component.len() == 2 && component.is_ascii() => component.split_at(1),
        None => return Err(outside()),
    };
    let (Some(i), Some(j)) = (number(row, rows), number(col, cols)) else {
        return Err(outside());
    };
    let (here, mirror) = (i * cols + j, j * cols + i);
    Ok(match field.kind {
        Kind::Rotation | Kind::RigidMotion => {
            return Err(format!(
                "you cannot vary single entries of `{name}`: it would no longer be a {}",
                if field.kind == Kind::Rotation {
                    "rotation"
                } else {
                    "rigid motion"
                }
            ));
        }
        _ if i == j && field.kind != Kind::Skew => vec![(here, 1.0)],
        Kind::Symmetric | Kind::SecondMoments => vec![(here, 1.0), (mirror, 1.0)],
        Kind::Skew if i != j => vec![(here, 1.0), (mirror, -1.0)],
        Kind::Skew | Kind::Diagonal => {
            return Err(format!(
                "the entry {} of `{name}` is zero for every such matrix",
                component
            ));
        }
        _ => vec![(here, 1.0)],
    })
}

#[cfg(test)]
mod tests {
    use super::entries;
    use clebsch::card::Kind;

    #[test]
    fn mirror_images_follow_the_kind() {
        let field = |kind: Kind| kind.field("J", [3, 3], "");
        assert_eq!(
            entries(&field(Kind::Symmetric), "J", Some("12")),
            Ok(vec![(1, 1.0), (3, 1.0)])
        );
        assert_eq!(
            entries(&field(Kind::Skew), "J", Some("3_1")),
            Ok(vec![(6, 1.0), (2, -1.0)])
        );
        assert_eq!(
            entries(&field(Kind::Matrix), "J", Some("12")),
            Ok(vec![(1, 1.0)])
        );
        assert_eq!(
            entries(&field(Kind::Diagonal), "J", Some("22")),
            Ok(vec![(4, 1.0)])
        );
        for (kind, component) in [
            (Kind::Diagonal, "12"),
            (Kind::Skew, "11"),
            (Kind::Rotation, "12"),
            (Kind::Matrix, "14"),
            (Kind::Matrix, "x"),
            (Kind::Matrix, "é"),
        ] {
            assert!(
                entries(&field(kind), "J", Some(component)).is_err(),
                "{kind:?} {component}"
            );
        }
        let vector = Kind::Vector.field("g", [3, 1], "");
        assert_eq!(entries(&vector, "J", Some("z")), Ok(vec![(2, 1.0)]));
        assert_eq!(entries(&vector, "J", Some("1")), Ok(vec![(0, 1.0)]));
        assert!(entries(&vector, "J", None).is_err());
    }
}
