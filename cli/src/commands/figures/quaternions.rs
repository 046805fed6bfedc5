//! Figures 2.9 and 2.10: the symmetric body in unit quaternions. Takes the gallery; gives SVG of the
//! quaternion's components, the body momentum, and their invariants.

use super::sheet::{Series, Subject, change, line, magnitudes, norm, panel, sheet};
use crate::models::gallery::Gallery;
use crate::terminal::failure::Failure;

const MODEL: &str = "cayley-klein";
const CASE: &str = "figure-2-9";

fn shifted(series: &Series, by: f64) -> Series {
    series.iter().map(|(t, x)| (*t, x - by)).collect()
}

/// Figure 2.9.
pub(super) fn components(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, MODEL, CASE)?;
    let own = body.generated()?;
    let q = body.components(&own, "q");
    let squares: Series = norm(&q).into_iter().map(|(t, x)| (t, x * x)).collect();
    let names = ["q₀", "q₁", "q₂", "q₃"].iter().zip(&q);
    let mut panels: Vec<_> = names
        .map(|(name, series)| panel(name, "", vec![line("", 0, series.clone())]))
        .collect();
    panels.push(magnitudes(
        "| |q|² − 1 |",
        "",
        vec![line("", 0, shifted(&squares, 1.0))],
    ));
    sheet(
        "Figure 2.9: unit quaternion of the symmetric body, I = (1, 1, 0.5)",
        &body,
        "",
        panels,
    )
}

/// Figure 2.10.
pub(super) fn momenta(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, MODEL, CASE)?;
    let own = body.generated()?;
    let mu = body.components(&own, "body_momentum");
    let of = |index: usize| mu.get(index).cloned().unwrap_or_default();
    let squares: Series = norm(&mu).into_iter().map(|(t, x)| (t, x * x)).collect();
    let units = "";
    let panels = vec![
        panel("M₁", units, vec![line("", 0, of(0))]),
        panel("M₂", units, vec![line("", 0, of(1))]),
        magnitudes("|M₃ − M₃(0)|", units, vec![line("", 0, change(&of(2)))]),
        magnitudes(
            "| |M|² − |M(0)|² |",
            units,
            vec![line("", 0, change(&squares))],
        ),
    ];
    sheet(
        "Figure 2.10: body momentum of the symmetric body, I = (1, 1, 0.5)",
        &body,
        "",
        panels,
    )
}
