//! A hundred million steps of the generated free body from every start of the gallery, with and without the projection every 64
//! steps. Measures the errors of energy, Casimir, spatial momentum and phase, and the corrections of the projection. Takes no
//! arguments; prints tables. `cargo run --release --manifest-path benches/Cargo.toml --bin long_run`, two minutes.

#[path = "long_run/course.rs"]
mod course;
#[path = "long_run/phase.rs"]
mod phase;

use clebsch::Order;
use clebsch_benches::body::start_of;
use clebsch_comparisons::body::Start;
use clebsch_models::free_body;
use course::{Course, STEPS, run};

fn main() {
    println!("{}; {STEPS} steps each", env!("RUSTC_VERSION"));
    let starts = starts();
    for order in [Order::Two, Order::Ten] {
        let all = |projects: bool| {
            let courses = starts
                .iter()
                .map(|(name, start)| (name.as_str(), run(start, order, projects)));
            courses.collect::<Vec<_>>()
        };
        println!("\n## Order {order}, projection every 64 steps\n");
        let projected = all(true);
        drifts(&projected);
        println!(
            "\n| body | correction of M: mean, largest | of the attitude | phase of M after 1e4, 1e6, 1e8 steps | attitude |"
        );
        println!("|---|---|---|---|---|");
        for (name, course) in &projected {
            let list = |at: &dyn Fn(&phase::Lag) -> f64| {
                let values = course.lags.iter().map(|lag| format!("{:.0e}", at(lag)));
                values.collect::<Vec<_>>().join(", ")
            };
            println!(
                "| {name} | {} | {} | {} | {} |",
                sizes(&course.momentum),
                sizes(&course.attitude),
                list(&|lag| lag.momentum),
                list(&|lag| lag.attitude),
            );
        }
        println!("\n## Order {order}, without projection\n");
        drifts(&all(false));
    }
}

fn sizes(tally: &course::Tally) -> String {
    format!("{:.1e}, {:.1e}", tally.mean(), tally.largest)
}

/// The table of the conserved quantities.
fn drifts(courses: &[(&str, Course)]) {
    println!(
        "| body | energy | square of M | spatial momentum, first million | whole run | its growth (standard errors) |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, course) in courses {
        println!(
            "| {name} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:+.0e} ({:.1}) |",
            course.energy,
            course.square,
            course.spatial_early,
            course.spatial,
            course.trend.change,
            course.trend.significance,
        );
    }
}

/// The distinct starts of the gallery's cases, and the same numbers as the Poinsot matrix J if they are admissible.
fn starts() -> Vec<(String, Start)> {
    let mut found: Vec<(String, Start)> = Vec::new();
    let mut add = |name: String, start: Start| {
        let known = found.iter().any(|(_, s)| *s == start);
        if !known {
            found.push((name, start));
        }
    };
    for case in free_body::entry().cases {
        let (Some(j), [_, momentum]) = (case.parameters.first(), case.initial.as_slice()) else {
            continue;
        };
        let [Some(x), Some(y), Some(z)] = [0, 4, 8].map(|i| j.get(i).copied()) else {
            continue;
        };
        let body_momentum: [f64; 3] = std::array::from_fn(|i| momentum[i]);
        let moments = [y + z, z + x, x + y];
        let say = |name: &str, values: [f64; 3]| {
            let [a, b, c] = values;
            let [p, q, r] = body_momentum;
            format!(
                "{name} = ({a}, {b}, {c}), M = ({p}, {q}, {r}), h = {}",
                case.h
            )
        };
        add(say("I", moments), start_of(moments, body_momentum, case.h));
        // For some of its triples, the thesis says neither.
        let [a, b, c] = moments;
        let read = start_of([b + c, c + a, a + b], body_momentum, case.h);
        if case.h == 0.1 && case.name.starts_with("figure") {
            add(say("J", moments), read);
        }
    }
    found
}
