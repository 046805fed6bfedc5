//! One step of models from their texts, against the two end equations solved independently of the engine with 32
//! digits: positions and momenta, from random states, for three step sizes and five scales of masses and momenta.

mod data;
mod judge;
mod line;
mod posed;
mod quantity;
mod row;
mod rows;
mod words;

use judge::{Found, Wrong};
use line::Line;
use row::Row;

/// One model of the table, judged.
struct Judged {
    name: &'static str,
    refused: usize,
    known: Option<f64>,
    found: Found,
}

/// Judges all models, prints the measurements, and panics with all failures.
fn print_table<R>(rows: &[R], name: impl Fn(&R) -> &'static str, judge: impl Fn(&R) -> Judged) {
    let mut wrong = Vec::new();
    let asked = std::env::var("CLEBSCH_STEP_OF").ok();
    let asked = |row: &&R| asked.as_deref().is_none_or(|own| own == name(row));
    for row in rows.iter().filter(asked) {
        let judged = judge(row);
        println!("{}", table_line(&judged));
        wrong.extend(verdict(&judged));
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Judges models of bodies and fields.
fn judged(rows: &[Row]) {
    print_table(rows, Row::name, |row| Judged {
        name: row.name(),
        refused: row.refused,
        known: row.known,
        found: judge::judge(row),
    });
}

/// Judges lines of sites.
fn judged_lines(rows: &[Line]) {
    print_table(rows, Line::name, |row| Judged {
        name: row.name(),
        refused: row.refused,
        known: row.known,
        found: row.judged(),
    });
}

/// A line of the table that the run prints.
fn table_line(row: &Judged) -> String {
    let found = &row.found;
    let off = found.off;
    let miss = match row.known {
        Some(_) => "  KNOWN MISS",
        None => "",
    };
    let mut line = format!(
        "{:<26} increment {:8.1e} momentum {:8.1e} of {:8.1e} allowed; {} steps, {} refused{miss}",
        row.name,
        off.increment,
        off.momentum,
        found.allowed,
        found.made,
        found.refused.len()
    );
    if found.lost > 0 {
        line.push_str(&format!(
            ", {} without a root that the oracle reaches",
            found.lost
        ));
    }
    line
}

/// The defects of a row.
fn verdict(row: &Judged) -> Vec<String> {
    let mut out = Vec::new();
    let (name, found) = (row.name, &row.found);
    match row.known {
        None => {
            let all = found.wrong.iter();
            out.extend(all.map(|Wrong(what)| format!("{name}: {what}")));
        }
        // A known defect may shrink, but must not grow.
        Some(known) => {
            let worst = found.off.increment.max(found.off.momentum);
            if worst > 4.0 * known {
                out.push(format!("{name}: {worst:.1e}, a miss that was {known:.1e}"));
            }
        }
    }
    if found.refused.len() != row.refused {
        let told = found.refused.first().map_or("", String::as_str);
        let count = found.refused.len();
        out.push(format!(
            "{name}: {count} refused, not {}: {told}",
            row.refused
        ));
    }
    if found.unseen > 0 {
        let list = found.unseen_names.join(", ");
        out.push(format!("{name}: a wrong datum is not seen: {list}"));
    }
    out
}
