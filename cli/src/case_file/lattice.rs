//! The sample case of a model with labels: a key for each quantity of the text, with expressions in the label.
//! Takes a card and its choice; gives the text of a case file.

use super::copies::{Base, Copies, base};
use super::motion::elements;
use super::remarks::remark;
use super::sample as fluid;
use super::space::Space;
use super::stated::Stated;
use super::write::{bounds, comment, instead};
use crate::models::constraints::{CONSTRAINTS_REMARK, has_constraints};
use crate::models::fields::{is_momentum, sample_entry, turns};
use crate::words::plain::shown;
use clebsch::card::{Card, Field, Kind};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::ChainConfig;
use std::fmt::Write as _;

/// The text of the sample case.
pub(crate) fn write_lattice(
    card: &Card,
    stated: &Stated,
    choice: &ChainConfig,
    named: &str,
) -> String {
    let lattice = &stated.lattice;
    let named = shown(named).to_string();
    let held = match has_constraints(&stated.model) {
        true => format!("# {CONSTRAINTS_REMARK}\n"),
        false => String::new(),
    };
    let mut text = format!(
        "# A case of the model {}; run it with\n#   clebsch run {named} --case THIS-FILE.toml\n\
         # Units: any consistent system. The model fixes none.\n\
         # Site data: a number for all sites; an expression in quotes, of the label, the number of sites and the scalars\n\
         # below; a list with one element per site; or an array [site, component] from a file next to this one,\n\
         # {{ npz = \"n.npz\", key = \"q\" }}. {{ npz = \"out/trajectory.npz\" }} takes the last sample of a run.\n{held}\
         model = \"{}\"\nname = \"sample\"\ndoc = \"placeholder values; edit them for a case of your own\"\n\
         h = 0.01     # step size, positive\nsteps = 1000     # number of steps, at least 1\n\n[labels]\n",
        card.kebab, card.kebab
    );
    let space = Space::sample(stated);
    for (i, l) in lattice.labels.iter().enumerate() {
        if let Some(cells) = space
            .as_ref()
            .and_then(|s| s.cells.as_ref())
            .filter(|_| l.grid)
        {
            let cells = match cells.as_slice() {
                [n] => n.to_string(),
                all => format!("{all:?}"),
            };
            let _ = writeln!(
                text,
                "{} = {cells}     # number of grid cells in each direction",
                l.index.text
            );
            continue;
        }
        let what = match l.set {
            true if space.is_some() => "number of particles",
            true => "number of sites",
            false if lattice.periodic.is_some() => {
                "number of segments; on a ring also the number of nodes"
            }
            false => "number of segments, one less than the number of nodes",
        };
        let _ = writeln!(text, "{} = {}     # {what}", l.index.text, choice.count(i));
    }
    ends(&mut text, stated, choice);
    super::functions::sample_table(&mut text, &stated.model, space.is_some());
    if let Some(space) = &space {
        fluid::domain(&mut text, stated, space);
        fluid::tables(&mut text, card, stated, space);
        return text;
    }
    let Some(copies) = Copies::of(stated, choice) else {
        return text;
    };
    let elements = elements(card.initial);
    for (table, fields) in [("parameters", card.parameters), ("initial", card.initial)] {
        let _ = writeln!(text, "\n[{table}]");
        let mut told: Vec<String> = Vec::new();
        for (at, field) in fields.iter().enumerate() {
            let base = base(&copies, field);
            let key = base.as_ref().map_or(field.ascii, |b| &*b.key);
            // A value prescribed at an end is an element of the list of all sites.
            if base.as_ref().is_some_and(|b| b.given) || told.iter().any(|t| t == key) {
                continue;
            }
            told.push(key.to_owned());
            if let Some(words) = remark(&stated.model, key) {
                comment(&mut text, &words);
            }
            let value = sample(stated, field, base.as_ref(), table, turns(card));
            let or = elements
                .get(&at)
                .filter(|_| table == "initial")
                .and_then(|own| fields.get(*own))
                .map_or_else(String::new, |element| {
                    format!("     # or {}", instead(element, field, key))
                });
            let _ = writeln!(text, "{key} = {value}{or}");
        }
    }
    bounds(&mut text, card, &[]);
    text
}

/// Writes the possible end conditions.
fn ends(text: &mut String, stated: &Stated, choice: &ChainConfig) {
    let lattice = &stated.lattice;
    let Some(line) = lattice.line_label() else {
        return;
    };
    let [first, last] = [false, true].map(|end| lattice.alternatives(end));
    let several = first.len() > 1 || last.len() > 1;
    if !several && lattice.periodic.is_none() {
        return;
    }
    let chosen = |names: &[String], end: usize| {
        let name = names.get(choice.ends[end]).cloned();
        name.unwrap_or_default()
    };
    let value = match choice.periodic {
        true => "\"periodic\"".to_owned(),
        false => format!("[\"{}\", \"{}\"]", chosen(&first, 0), chosen(&last, 1)),
    };
    let ring = match lattice.periodic.is_some() {
        true => "\"periodic\", or ",
        false => "",
    };
    let _ = writeln!(
        text,
        "\n[ends]\n{} = {value}     # {ring}[first end, last end]: first end {}; last end {}",
        line.index.text,
        first.join(", "),
        last.join(", ")
    );
}

/// A sample value, as TOML. If `turned`, square momenta are skew.
fn sample(
    stated: &Stated,
    field: &Field,
    base: Option<&Base<'_>>,
    table: &str,
    turned: bool,
) -> String {
    let (rows, cols) = (field.rows, field.cols);
    let lattice = &stated.lattice;
    let labels = &lattice.labels;
    let of_offset = |name: &str| {
        let mut offsets = lattice.quantities.iter().filter_map(|q| q.offset.as_ref());
        offsets.any(|o| ascii(&o.text) == name)
    };
    if base.is_none() && of_offset(field.ascii) {
        let count = lattice.line_label().map_or("N", |l| l.count.text.as_str());
        return along(rows, &format!("\"{count}\""));
    }
    let place = base.filter(|b| table == "initial" && !b.end);
    if let Some(place) = place {
        let label = labels.get(place.label);
        let (i, n) = label.map_or(("i", "N"), |l| {
            (l.index.text.as_str(), l.count.text.as_str())
        });
        let along_line = label
            .and_then(|l| l.step.as_ref())
            .map_or_else(|| format!("\"{i}\""), |s| format!("\"{}*{i}\"", s.text));
        let has_offset = lattice
            .quantities
            .iter()
            .any(|q| ascii(&q.name.text) == place.key && q.offset.is_some());
        match field.kind {
            Kind::Scalar if has_offset => return format!("\"{i} + 0.1*sin(2*pi*{i}/{n})\""),
            Kind::Scalar => return format!("\"0.1*sin(2*pi*{i}/{n})\""),
            Kind::Vector => return along(rows, &along_line),
            Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
                if rows * cols == 1 =>
            {
                return "0.0".to_owned();
            }
            _ => {}
        }
    }
    let at_rest = has_constraints(&stated.model) && is_momentum(field);
    let number = |i: usize, j: usize| match at_rest {
        true => 0.0,
        false => sample_entry(field, turned, i, j),
    };
    if rows * cols == 1 {
        return format!("{:?}", number(0, 0));
    }
    let row = |i: usize| {
        let each: Vec<String> = (0..cols).map(|j| format!("{:?}", number(i, j))).collect();
        each.join(", ")
    };
    match cols {
        1 => format!("[{}]", (0..rows).map(row).collect::<Vec<_>>().join(", ")),
        _ => {
            let rows: Vec<String> = (0..rows).map(|i| format!("[{}]", row(i))).collect();
            format!("[{}]", rows.join(", "))
        }
    }
}

/// A vector along its last axis.
fn along(rows: usize, last: &str) -> String {
    if rows == 1 {
        return last.to_owned();
    }
    let zeros = vec!["0.0"; rows - 1].join(", ");
    format!("[{zeros}, {last}]")
}
