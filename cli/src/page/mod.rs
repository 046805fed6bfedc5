//! One page per run, in a single self-contained file: an interactive view in space, the table of invariants,
//! all pictures.
//! Takes a run and its pictures; gives HTML.

mod bodies;
mod body_positions;
mod chains;
mod links;
mod particle_colours;
mod scene;
mod value;

use crate::output::Finished;
use crate::trajectory::record::Samples;
use crate::trajectory::verdict::zeros;
use crate::words::plain::steps;
use std::fmt::Write as _;

/// The page.
pub(crate) fn page(run: &Finished<'_>, samples: &Samples, pictures: &[(&str, String)]) -> String {
    let case = &run.plan.case;
    let title = format!("{}, case {}", run.card.kebab, case.name);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n<style>\n{1}</style>\n\
         </head>\n<body>\n<h1>{0}</h1>\n",
        escaped(&title),
        include_str!("page.css")
    );
    let about = format!("h = {:?}, {}; {}", case.h, steps(case.steps), case.doc);
    let _ = writeln!(
        out,
        "<p class=\"about\">{}</p>",
        escaped(about.trim_end_matches("; "))
    );
    if let Some(stopped) = &run.stopped {
        let _ = writeln!(
            out,
            "<p><b>The run stopped at node {}, time {}:</b> {}</p>",
            stopped.node,
            stopped.time,
            escaped(&stopped.why)
        );
    }
    let scene = scene::scene(run, samples);
    if let Some(scene) = &scene {
        out.push_str(
            "<canvas id=\"view\"></canvas>\n<div class=\"controls\"><button id=\"play\">play</button>\
             <input id=\"time\" type=\"range\" min=\"0\" value=\"0\"><span id=\"clock\"></span></div>\n\
             ",
        );
        let said = format!("{} Drag to rotate, scroll to zoom.", scene.said);
        let _ = writeln!(out, "<p class=\"about\">{}</p>", escaped(said.trim()));
    }
    invariants(run, &mut out);
    if !pictures.is_empty() {
        out.push_str("<h2>Pictures</h2>\n");
    }
    for (name, svg) in pictures {
        // Omits the XML declaration of a separate file.
        let svg = svg.find("<svg").and_then(|at| svg.get(at..)).unwrap_or(svg);
        let _ = writeln!(out, "<figure id=\"{}\">\n{svg}\n</figure>", escaped(name));
    }
    if let Some(scene) = scene {
        // `</` would end the element.
        let data = scene.data.to_string().replace("</", "<\\/");
        let _ = writeln!(
            out,
            "<script type=\"application/json\" id=\"scene\">{data}</script>\n<script>\n{}</script>",
            include_str!("view.js")
        );
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// The table at the end of a run.
fn invariants(run: &Finished<'_>, out: &mut String) {
    if run.outcomes.is_empty() {
        return;
    }
    out.push_str(
        "<h2>Invariants</h2>\n<div class=\"scrolls\">\n<table>\n<tr><th>invariant</th><th>scale</th><th>max drift</th>\
         <th>bound</th><th>verdict</th><th>formula</th></tr>\n",
    );
    for outcome in run.outcomes {
        let bound = outcome
            .bound
            .map_or_else(|| "-".to_owned(), |b| format!("{b:e}"));
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td class=\"number\">{:.3e}</td><td class=\"number\">{:.3e}</td><td class=\"number\">{bound}</td>\
             <td>{}</td><td>{}</td></tr>",
            escaped(outcome.invariant.name),
            outcome.scale,
            outcome.worst,
            outcome.word(),
            escaped(outcome.invariant.formula)
        );
    }
    out.push_str("</table>\n</div>\n");
    for said in zeros(run.outcomes) {
        let rest = said.strip_prefix("zero").unwrap_or(&said);
        let _ = writeln!(out, "<p>Zero{}.</p>", escaped(rest));
    }
    if let Some(verdict) = &run.stated {
        let said = verdict.to_string();
        let rest = said.strip_prefix("action").unwrap_or(&said);
        let _ = writeln!(out, "<p>Action{}.</p>", escaped(rest));
    }
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            _ => out.push(c),
        }
    }
    out
}
