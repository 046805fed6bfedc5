//! Equations of configurations without a label, which couple to all sites. clebsch expands a lattice and a longer
//! one; if the equations of both agree, it writes them as sums over the sites.

use super::{Stated, stated_configurations, sums};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::expr::Shift;
use crate::print::formula::Formula;
use crate::print::{Format, Style, formula};

/// The two equations of a configuration without a label, with sums over the sites. `None` if they read differently on
/// the longer lattice.
pub(super) fn equations(
    folded: &mut IndexedNotation,
    part: &Part,
    s: &Stated,
) -> Option<Vec<Formula>> {
    let longer = part.longer.as_deref()?;
    let mut told = |part: &Part| {
        let all = stated_configurations(part);
        let shown = all.iter().find(|o| o.name == s.name)?.shown;
        let b = part.d.balances.get(shown)?;
        let sides = [&b.outgoing, &b.incoming].map(|e| sums::as_sums(folded, part, e));
        sides.into_iter().collect::<Option<Vec<Formula>>>()
    };
    let (own, there) = (told(part)?, told(longer)?);
    let style = Style::new(&part.d.spec.time_index);
    let text = |list: &[Formula]| -> Vec<String> {
        let each = list.iter();
        each.map(|f| formula(f, &folded.symbols, &style, Format::Text))
            .collect()
    };
    if text(&own) != text(&there) {
        return None;
    }
    let mu = *part.d.letters.node_momentum.get(s.shown)?;
    let sides = [Shift::HERE, Shift::NEXT].into_iter().zip(own);
    let each = sides.map(|(shift, sum)| {
        let momentum = folded.letter(part, mu, shift, IndexOrigin::Site(s.site));
        Formula::equal(momentum, sum)
    });
    Some(each.collect())
}
