//! Numbers and expressions at the sites of a fluid. Takes a value of a case; gives a number for each component
//! at each site, or an error with its position.

use super::meshes::Meshes;
use super::{Reader, Wrong, size};
use crate::case_file::from_npz::{self, AcceptedShapes};
use crate::case_file::names::{Nameless, Names as _};
use crate::case_file::space::Space;
use crate::case_file::value::{number, shape};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Quantity;
use clebsch_core::lattice::value::SiteData;
use toml::Spanned;
use toml::de::DeValue;

impl Reader<'_> {
    /// The value of a name at a site.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn number(&self, q: &Quantity, name: &str, site: usize) -> Option<f64> {
        let lattice = &self.stated.lattice;
        if let Some(l) = lattice.labels.get(q.label) {
            if l.index.text == name {
                return Some(site as f64);
            }
            if !l.grid && l.count.text == name {
                return Some(self.count(q) as f64);
            }
        }
        let lengths = &self.space.lengths;
        let even = lengths.iter().all(|l| Some(l) == lengths.first());
        let torus = Space::torus(self.stated).unwrap_or("L");
        match name {
            "x" | "y" => self.coordinate(q, usize::from(name == "y"), site),
            "Lx" => lengths.first().copied(),
            "Ly" => lengths.get(1).copied(),
            _ if name == torus && even => lengths.first().copied(),
            _ => self.scope.number(name).or_else(|| {
                let own = lattice
                    .quantities
                    .iter()
                    .find(|o| ascii(&o.name.text) == name)?;
                let column = self.fluid.columns.get(name)?;
                let fits = own.label == q.label && column.size == 1;
                column.numbers.get(site).copied().filter(|_| fits)
            }),
        }
    }

    /// A coordinate of a particle or a node.
    fn coordinate(&self, q: &Quantity, d: usize, site: usize) -> Option<f64> {
        if self.is_grid(q) {
            return self.nodes.0.get(site)?.get(d).copied();
        }
        let own = self.stated.lattice.places();
        let own = own.filter(|own| own.label == q.label)?;
        let column = self.fluid.columns.get(&ascii(&own.name.text))?;
        let all = column
            .numbers
            .get(site * column.size..(site + 1) * column.size)?;
        all.get(d).copied()
    }

    /// Reads a number, an expression, a list, or an array of a file. A list has an element for each component,
    /// or for each site. If the value names no array, the array is called `named`.
    pub(super) fn read(
        &self,
        q: &Quantity,
        named: &str,
        value: &Spanned<DeValue<'_>>,
    ) -> Result<Vec<f64>, Wrong> {
        let (size, count) = (size(q), self.count(q));
        if from_npz::is_meant(value.get_ref()) {
            let sites: Vec<usize> = (0..count).collect();
            let wanted = AcceptedShapes {
                values: &[if size == 1 { vec![] } else { vec![size] }],
                sites: Some(&sites),
                moving: None,
            };
            let taken = self.arrays.take(value, named, wanted)?;
            let mut out = Vec::with_capacity(count * size);
            for site in sites {
                out.extend(taken.at(site)?);
            }
            return Ok(out);
        }
        let list = match value.get_ref() {
            DeValue::Array(list) => list,
            own @ DeValue::Table(_) => {
                return Err(format!(
                    "expected numbers or expressions, found {}",
                    shape(own).words()
                )
                .into());
            }
            _ if size == 1 => return self.component(q, value),
            _ => {
                return Err(format!(
                    "expected {size} numbers or expressions, or a list with {size} for each site"
                )
                .into());
            }
        };
        let nested = list.iter().any(|v| v.get_ref().is_array());
        if !nested && size > 1 && list.len() == size {
            let each = list.iter().map(|v| self.component(q, v));
            let each: Vec<Vec<f64>> = each.collect::<Result<_, _>>()?;
            let at = |site: usize| each.iter().filter_map(move |c| c.get(site).copied());
            return Ok((0..count).flat_map(at).collect());
        }
        if list.len() != count {
            return Err(format!(
                "a list needs one value for each of the {count} sites; this list has {}",
                list.len()
            )
            .into());
        }
        let mut out = Vec::with_capacity(count * size);
        for (site, one) in list.iter().enumerate() {
            let own: Vec<&Spanned<DeValue<'_>>> = match one.get_ref() {
                DeValue::Array(own) => own.iter().collect(),
                _ => vec![one],
            };
            if own.len() != size {
                return Err(
                    format!("site {site} has {} numbers, expected {size}", own.len()).into(),
                );
            }
            for value in own {
                out.push(self.at(q, value, site)?);
            }
        }
        Ok(out)
    }

    /// One number or expression, at all sites.
    fn component(&self, q: &Quantity, value: &Spanned<DeValue<'_>>) -> Result<Vec<f64>, Wrong> {
        let DeValue::String(text) = value.get_ref() else {
            return Ok(vec![number(value.get_ref(), &Nameless)?; self.count(q)]);
        };
        let expression_error = |why: String| expression_error(text, value, &why);
        let (data, meshes) = self.expression(q, text).map_err(expression_error)?;
        let each = (0..self.count(q)).map(|site| self.valued(q, &data, &meshes, site));
        each.collect::<Result<_, _>>().map_err(expression_error)
    }

    fn at(&self, q: &Quantity, value: &Spanned<DeValue<'_>>, site: usize) -> Result<f64, Wrong> {
        let DeValue::String(text) = value.get_ref() else {
            return Ok(number(value.get_ref(), &Nameless)?);
        };
        let own = self.expression(q, text);
        let value_here = own.and_then(|(data, meshes)| self.valued(q, &data, &meshes, site));
        value_here.map_err(|why| expression_error(text, value, &why))
    }

    /// An expression, and the meshes in it.
    fn expression(&self, q: &Quantity, text: &str) -> Result<(SiteData, Meshes), String> {
        let data = SiteData::read(text)?;
        let meshes = self.meshes_in(q, &data)?;
        Ok((data, meshes))
    }

    /// The value of an expression at a site, if it is a number.
    fn valued(
        &self,
        q: &Quantity,
        data: &SiteData,
        meshes: &Meshes,
        site: usize,
    ) -> Result<f64, String> {
        let of = |name: &str| {
            let own = self.number(q, name, site);
            own.or_else(|| meshes.value(name, site))
        };
        let value = data.value_and_slopes(&of, &|name, along| meshes.slope(name, along, site))?;
        match value.is_finite() {
            true => Ok(value),
            false => Err(format!("{value} at site {site} is not a finite number")),
        }
    }
}

/// An error in an expression, with its position.
fn expression_error(text: &str, value: &Spanned<DeValue<'_>>, why: &str) -> Wrong {
    Wrong {
        why: format!("\"{text}\": {why}"),
        at: Some(value.span()),
    }
}
