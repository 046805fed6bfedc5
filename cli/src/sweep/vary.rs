//! What a sweep varies: `gU.z=0:1:100`, `h=0.1,0.05`, `kappa=2`.
//! Takes texts and a card; gives the entries of parameters, initial values or the step that take the values, and the
//! values of each point of the grid.

use crate::case_file::{Motion, at_site};
use crate::failure::Failure;
use crate::plain::shown;
use crate::plan::Plan;
use clebsch::card::{Card, Field, Kind};

/// Most values of one quantity, so that a slip of the keyboard does not fill the memory.
const MOST_VALUES: usize = 1_000_000;

/// Most points of a sweep.
pub(super) const MOST_POINTS: u64 = 1_000_000_000;

/// A quantity and its values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// As it was written, such as `gU.z`: the name of its column.
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) values: Vec<f64>,
}

/// What takes the values.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    Step,
    /// Entries of a parameter, each with the sign that its kind asks for; along a line those of several sites.
    Parameter(Vec<usize>, Vec<(usize, f64)>),
    Initial(Vec<usize>, Vec<(usize, f64)>),
    /// Entries of velocities that the case gives.
    Velocity(Vec<usize>, Vec<(usize, f64)>),
}

impl Axis {
    /// Reads `NAME=FROM:TO:COUNT` or `NAME=VALUE,VALUE,...`.
    ///
    /// # Errors
    /// Usage: what is wrong with it, and what the model has.
    pub(super) fn read(text: &str, card: &Card, motion: &Motion) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::Usage(format!("--vary {}: {why}", shown(text)));
        let Some((name, values)) = text.split_once('=') else {
            return Err(wrong(
                "give NAME=FROM:TO:COUNT or NAME=VALUE,VALUE,..., such as gU.z=0:1:100".to_owned(),
            ));
        };
        let place = place(name.trim(), card, motion).map_err(wrong)?;
        let values = read_values(values).map_err(wrong)?;
        Ok(Self {
            name: name.trim().to_owned(),
            place,
            values,
        })
    }

    /// Whether both set a number that is the same one.
    pub(super) fn meets(&self, other: &Self) -> bool {
        match (&self.place, &other.place) {
            (Place::Step, Place::Step) => true,
            (Place::Parameter(a, own), Place::Parameter(b, others))
            | (Place::Initial(a, own), Place::Initial(b, others))
            | (Place::Velocity(a, own), Place::Velocity(b, others)) => {
                let is_other = |at: usize| others.iter().any(|(other, _)| *other == at);
                // Fields stand in their order, along a line a hundred thousand of them.
                own.iter().any(|(at, _)| is_other(*at))
                    && a.iter().any(|field| b.binary_search(field).is_ok())
            }
            _ => false,
        }
    }

    /// Puts a value into the case of a plan.
    pub(super) fn put(&self, value: f64, plan: &mut Plan) {
        let (case, motion) = (&mut plan.case, &mut plan.motion);
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
            return Err(format!("the case gives {key} instead; vary that"));
        }
        return Ok(Place::Initial(at, entries(&own, field, component)?));
    }
    let mut names: Vec<&str> = Vec::new();
    for fields in [card.parameters, card.initial] {
        for own in fields {
            let stem = at_site(own.ascii).map(|(stem, _)| stem);
            // Of a hundred thousand sites the first one tells it.
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
    Err(format!(
        "`{}` has no such parameter or initial value; it has {} and the step h",
        card.kebab,
        names.join(", ")
    ))
}

/// The fields of a name, and the first of them. Along a line a name is that of a case file: without the number of a site it is that of
/// all sites or of both ends, with `N` that of the last end.
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

/// The entries of a field that a component names: with its mirror image where the kind has one.
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
    let outside = || match cols {
        1 => format!("`{name}` has the components {name}.1 to {name}.{rows}, or x, y, z of three"),
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
                "single entries of `{name}` cannot be varied: it would be no {} any more",
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
                "the entry {} of `{name}` is zero by its kind",
                component
            ));
        }
        _ => vec![(here, 1.0)],
    })
}

fn read_values(text: &str) -> Result<Vec<f64>, String> {
    let number = |text: &str| match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("`{}` is no finite number", shown(text))),
    };
    let parts: Vec<&str> = text.split(':').collect();
    match parts.as_slice() {
        [from, to, count] => {
            let (from, to) = (number(from)?, number(to)?);
            let count = crate::arguments::whole(count.trim())
                .and_then(|count| usize::try_from(count).ok())
                .filter(|count| (1..=MOST_VALUES).contains(count))
                .ok_or_else(|| format!("give from 1 to {MOST_VALUES} values"))?;
            if count == 1 {
                return Ok(vec![from]);
            }
            // The ends are what was written, to the last bit.
            let last = count - 1;
            let value = |i: usize| match i {
                _ if i == last => to,
                _ => from + (to - from) * (i as f64 / last as f64),
            };
            Ok((0..count).map(value).collect())
        }
        [list] => list.split(',').map(number).collect(),
        _ => Err("a range has three parts, FROM:TO:COUNT".to_owned()),
    }
}

/// How many points all axes have together.
pub(super) fn points(axes: &[Axis]) -> Result<u64, Failure> {
    let all = axes
        .iter()
        .try_fold(1_u64, |n, axis| n.checked_mul(axis.values.len() as u64));
    all.filter(|n| *n <= MOST_POINTS)
        .ok_or_else(|| Failure::Usage(format!("a sweep has at most {MOST_POINTS} points")))
}

/// The values of a point, one of each axis: the last axis varies fastest.
pub(super) fn at(axes: &[Axis], point: u64) -> Vec<f64> {
    let mut left = point;
    let mut values: Vec<f64> = axes
        .iter()
        .rev()
        .map(|axis| {
            let count = (axis.values.len() as u64).max(1);
            let own = usize::try_from(left % count).unwrap_or(0);
            left /= count;
            axis.values.get(own).copied().unwrap_or(f64::NAN)
        })
        .collect();
    values.reverse();
    values
}

#[cfg(test)]
mod tests {
    use super::{Axis, at, entries, points, read_values};
    use clebsch::card::Kind;

    #[test]
    fn ranges_hold_their_ends_and_lists_are_taken_as_they_are() {
        assert_eq!(
            read_values("0:0.3:4").expect("a range"),
            [0.0, 0.3 * (1.0 / 3.0), 0.3 * (2.0 / 3.0), 0.3]
        );
        assert_eq!(read_values("2:9:1").expect("a range"), [2.0]);
        assert_eq!(read_values("0.1, 1e-2").expect("a list"), [0.1, 0.01]);
        for wrong in ["", "1:2", "1:2:0", "1:inf:3", "a", "1,,2", "1:2:3:4"] {
            assert!(read_values(wrong).is_err(), "{wrong}");
        }
    }

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

    #[test]
    fn the_last_axis_varies_fastest() {
        let axis = |values: &[f64]| Axis {
            name: "h".to_owned(),
            place: super::Place::Step,
            values: values.to_vec(),
        };
        let axes = [axis(&[1.0, 2.0]), axis(&[5.0, 6.0, 7.0])];
        assert_eq!(points(&axes), Ok(6));
        let all: Vec<Vec<f64>> = (0..6).map(|point| at(&axes, point)).collect();
        assert_eq!(all[1], [1.0, 6.0]);
        assert_eq!(all[3], [2.0, 5.0]);
        assert!(points(&vec![axis(&[0.0; 2000]); 3]).is_err());
    }
}
