//! Bodies without sites: frames, drawn as points with axes, and points with their own motion. Takes a card; gives a
//! ParaView point for each body.

use super::columns::{axes, in_space, place};
use super::{Data, Part};
use crate::output::attitude::placed;
use crate::output::points::Diagonals;
use crate::output::sites::at_sites;
use clebsch::card::{Card, Field, Kind};
use clebsch::record::vtk::{PolyData, Values};
use std::collections::HashSet;
use std::ops::Range;

/// The distance between bodies without positions.
const APART: f64 = 2.6;

struct Bodies {
    all: Vec<Body>,
    /// Vectors drawn at bodies: momenta, and other vectors if there is only one body.
    vectors: Vec<Vectors>,
}

struct Body {
    field: &'static Field,
    columns: Range<usize>,
    /// The position at which the body is drawn if it has none of its own.
    stands: [f64; 3],
}

/// One vector per body; zero for bodies without this vector.
struct Vectors {
    name: String,
    at: Vec<Option<Range<usize>>>,
}

/// The bodies of a model, if it has any.
pub(super) fn parts(card: &Card) -> Vec<(String, Box<dyn Part>)> {
    let sites = at_sites(card);
    let of_sites: HashSet<usize> = sites
        .iter()
        .flat_map(|q| q.members.iter().map(|(_, c)| c.start))
        .collect();
    let alone = placed(card.observables).filter(|(_, c)| !of_sites.contains(&c.start));
    let alone: Vec<(&'static Field, Range<usize>)> = alone.collect();
    let mut all: Vec<Body> = Vec::new();
    let diagonals = Diagonals::of(card);
    let mut standing = 0.0;
    for (i, (field, columns)) in alone.iter().enumerate() {
        let behind = alone.get(i + 1).map(|(f, _)| f.kind);
        let moves = behind == Some(Kind::FieldMomentum);
        let starts = card.initial.iter().any(|f| f.ascii == field.ascii);
        let unknown = vec![f64::NAN; field.count()];
        let shape = [field.rows, field.cols];
        // A matrix is drawn only if it has its own momentum or an initial value; other matrices are advected.
        let turns = axes(field.kind, shape, &unknown).is_some()
            && (field.kind != Kind::Matrix || moves || starts);
        let is_point = diagonals.leave(field, behind);
        if !turns && !is_point {
            continue;
        }
        let located = is_point || place(field.kind, field.rows, &unknown).is_some();
        all.push(Body {
            field,
            columns: columns.clone(),
            stands: [standing, 0.0, 0.0],
        });
        standing += if located { 0.0 } else { APART };
    }
    if all.is_empty() {
        return Vec::new();
    }
    let vectors = vectors(&all, &alone);
    vec![("bodies".to_owned(), Box::new(Bodies { all, vectors }))]
}

/// Momenta, by their names without the names of the bodies. If there is one body, other vectors are drawn as well.
fn vectors(all: &[Body], alone: &[(&'static Field, Range<usize>)]) -> Vec<Vectors> {
    let mut out: Vec<Vectors> = Vec::new();
    let mut put = |name: String, body: usize, columns: Range<usize>| {
        let own = out.iter_mut().find(|v| v.name == name);
        let own = match own {
            Some(own) => own,
            None => {
                out.push(Vectors {
                    name,
                    at: vec![None; all.len()],
                });
                match out.last_mut() {
                    Some(own) => own,
                    None => return,
                }
            }
        };
        if let Some(at) = own.at.get_mut(body) {
            *at = Some(columns);
        }
    };
    for (field, columns) in alone {
        let known = all.iter().any(|b| b.columns == *columns);
        if known || field.cols != 1 {
            continue;
        }
        for kind in ["body_momentum", "spatial_momentum", "momentum"] {
            let of = field.ascii.strip_prefix(kind);
            let Some(of) = of.map(|rest| rest.trim_start_matches('_')) else {
                continue;
            };
            let only = all.len() == 1 && of.is_empty();
            let body = all.iter().position(|b| only || b.field.ascii == of);
            let Some(body) = body else { continue };
            let Range { start, end } = *columns;
            match field.rows {
                2 | 3 => put(kind.to_owned(), body, columns.clone()),
                6 => {
                    put(kind.to_owned(), body, start..start + 3);
                    put(format!("{kind}_linear"), body, start + 3..end);
                }
                _ => {}
            }
        }
        if all.len() == 1 && field.kind == Kind::Vector && [2, 3].contains(&field.rows) {
            put(field.ascii.to_owned(), 0, columns.clone());
        }
    }
    out
}

impl Part for Bodies {
    fn data(&mut self, row: &[f64]) -> Data {
        let own = |body: &Body| row.get(body.columns.clone()).unwrap_or_default().to_vec();
        let points = self.all.iter().map(|body| {
            let (field, own) = (body.field, own(body));
            let shape = [field.rows, field.cols];
            match axes(field.kind, shape, &own) {
                None => in_space(&own),
                Some(_) => place(field.kind, field.rows, &own).unwrap_or(body.stands),
            }
        });
        let mut data = PolyData::of_points(points.collect());
        let frames = self.all.iter().map(|body| {
            let shape = [body.field.rows, body.field.cols];
            axes(body.field.kind, shape, &own(body))
        });
        let frames: Vec<Option<[[f64; 3]; 3]>> = frames.collect();
        if frames.iter().any(Option::is_some) {
            for d in 0..3 {
                // The axes of a point are zero.
                let each = frames.iter().map(|f| f.map_or([0.0; 3], |f| f[d]));
                let each: Vec<[f64; 3]> = each.collect();
                let name = format!("d{}", d + 1);
                data.point_data.push(Values::vectors(&name, &each));
            }
        }
        for vectors in &self.vectors {
            let each = vectors.at.iter().map(|at| {
                let own = at.as_ref().and_then(|at| row.get(at.clone()));
                own.map_or([0.0; 3], in_space)
            });
            let each: Vec<[f64; 3]> = each.collect();
            data.point_data.push(Values::vectors(&vectors.name, &each));
        }
        #[allow(clippy::cast_precision_loss)]
        let numbers = (0..self.all.len()).map(|i| i as f64).collect();
        data.point_data.push(Values::numbers("body", numbers));
        Data::Poly(data)
    }
}
