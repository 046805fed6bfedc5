//! Checks that advected quantities follow their constraints between the stored nodes. This detects a clock that does
//! not advance.

use crate::evaluate::Here;
use crate::judge::Part;
use crate::number::UNIT;
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::Moving;
use crate::stated::{Role, Stated};
use std::collections::BTreeSet;

/// The residuals of all statements.
///
/// # Errors
/// One cannot be evaluated.
pub fn carried(
    stated: &Stated,
    setup: &Setup,
    (before, after): (&[f64], &[f64]),
    moving: &[Moving<'_>],
) -> Result<Vec<Part>, String> {
    let nothing = crate::scene::Varied::default();
    let scene = Scene::new(stated, setup, [before, after], &nothing);
    let mut parts = Vec::new();
    for q in stated.quantities.values() {
        let (Role::Advected, Some(update)) = (&q.role, &q.update) else {
            continue;
        };
        let sites: BTreeSet<Option<usize>> = match q.at {
            None => std::iter::once(None).collect(),
            // The sites that are judged.
            Some(at) => {
                let own =
                    |m: &&Moving| stated.quantities.get(m.name).and_then(|q| q.at) == Some(at);
                moving.iter().filter(own).map(|m| m.site).collect()
            }
        };
        for site in sites {
            let Some(own) = setup.observed(&q.name, site) else {
                continue;
            };
            let index = site.map_or(0, |s| i64::try_from(s).unwrap_or(0));
            let value = scene.value(update, Here::at(index))?;
            let sized = value.sized(own.rows, own.cols);
            let brought = sized.ok_or_else(|| format!("`{}` changes its shape", q.name))?;
            let numbers = own.of(after);
            let size = numbers.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
            for (i, (there, here)) in numbers.iter().zip(brought.entries.iter()).enumerate() {
                parts.push(Part {
                    what: q.name.clone(),
                    site,
                    component: i + 1,
                    node: 1,
                    residual: there - here.value,
                    // The stored value was computed from an element and an initial value.
                    bound: here.error + 4.0 * UNIT * size,
                    terms: 0.0,
                });
            }
        }
    }
    Ok(parts)
}
