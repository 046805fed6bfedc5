//! Attitudes that an end holds, or that stand among its parameters, by the four numbers of a unit quaternion, as those of
//! sites that move. Takes a value as it is written; gives it as the matrix that the parameter is.

use super::labels::{Base, Stated};
use super::sites::{self, Numbers, Site};
use clebsch::Rotation;
use clebsch::card::{Field, Kind};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::syntax::ast::{Kindred, Statement};
use toml::de::DeValue;

/// The value at a site where it is four numbers of a rotation or a unit quaternion; `None` of everything else.
pub(super) fn at(
    stated: &Stated,
    base: &Base,
    site: &Site<'_>,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Option<String> {
    let size = size(stated, base, site.field)?;
    // Lists of sites are told from the numbers of one by the shape of a quaternion.
    let four = Field {
        rows: 4,
        cols: 1,
        kind: Kind::UnitQuaternion,
        ..*site.field
    };
    let text = sites::at(
        &Site {
            field: &four,
            ..*site
        },
        value,
        of,
    )
    .ok()?;
    let numbers: Result<Vec<f64>, _> = text
        .trim_matches(['[', ']'])
        .split(',')
        .map(|x| x.trim().parse())
        .collect();
    let [w, x, y, z] = numbers.ok()?.try_into().ok()?;
    let rows: Vec<Vec<f64>> = match size {
        4 => vec![
            vec![w, -x, -y, -z],
            vec![x, w, -z, y],
            vec![y, z, w, -x],
            vec![z, -y, x, w],
        ],
        _ => {
            let turn = Rotation::from_quaternion([w, x, y, z]).ok()?.matrix();
            (0..3)
                .map(|i| (0..3).map(|j| turn[(i, j)]).collect())
                .collect()
        }
    };
    let row = |r: &Vec<f64>| {
        let each: Vec<String> = r.iter().map(|x| sites::spelt(*x)).collect();
        format!("[{}]", each.join(", "))
    };
    let rows: Vec<String> = rows.iter().map(row).collect();
    Some(format!("[{}]", rows.join(", ")))
}

/// The rows of the matrix that four numbers at a site stand for; `None` where they stand for none.
pub(super) fn size(stated: &Stated, base: &Base, field: &Field) -> Option<usize> {
    let is_held = base.given && !base.is_momentum;
    let kindred = group(stated, base).filter(|_| is_held || base.end)?;
    let size = match kindred.name.text.as_str() {
        "SU" => 4,
        "SO" => 3,
        _ => return None,
    };
    ((field.rows, field.cols) == (size, size)).then_some(size)
}

/// The group of a configuration, or that a parameter of an end condition is an element of.
fn group<'a>(stated: &'a Stated, base: &Base) -> Option<&'a Kindred> {
    if base.end {
        let all = stated.lattice.ends.iter().flatten().flat_map(|a| &a.params);
        let own = all.filter(|(names, _)| names.iter().any(|n| ascii(&n.text) == base.key));
        return own.map(|(_, kindred)| kindred).next();
    }
    stated.model.statements.iter().find_map(|s| match s {
        Statement::Group { name, group, .. } if ascii(&name.text) == base.of => Some(group),
        _ => None,
    })
}
