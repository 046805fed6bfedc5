//! `clebsch figures`: the figures of the thesis's second chapter from named cases of the gallery, and 3.1 to
//! 3.3 from a model file.
//! Takes the gallery; gives one SVG per figure in a new folder. docs/figures.md describes the figures.

mod bipolar;
mod bodies;
mod elastic;
mod fibration;
mod quaternions;
mod sheet;
mod splitting;

use crate::models::gallery::Gallery;
use crate::output::Staging;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::words::plain::shown;
use clap::ArgMatches;
use serde_json::{Value, json};
use std::io::Write;
use std::path::PathBuf;

/// A figure: its number in the thesis, its file, and its drawing function.
struct Figure {
    number: &'static str,
    file: &'static str,
    /// The model of the figure. If the gallery does not contain it, the figure is omitted.
    model: &'static str,
    draw: fn(&Gallery) -> Result<String, Failure>,
}

/// All figures, in the order of the thesis; the last one is not in it.
const FIGURES: [Figure; 18] = [
    Figure {
        number: "2.5",
        file: "figure-2-05.svg",
        model: "free-body",
        draw: bodies::symmetric,
    },
    Figure {
        number: "2.6",
        file: "figure-2-06.svg",
        model: "free-body",
        draw: bodies::asymmetric,
    },
    Figure {
        number: "2.7",
        file: "figure-2-07.svg",
        model: "free-body",
        draw: bodies::symmetric_drift,
    },
    Figure {
        number: "2.8",
        file: "figure-2-08.svg",
        model: "free-body",
        draw: bodies::asymmetric_drift,
    },
    Figure {
        number: "2.9",
        file: "figure-2-09.svg",
        model: "cayley-klein",
        draw: quaternions::components,
    },
    Figure {
        number: "2.10",
        file: "figure-2-10.svg",
        model: "cayley-klein",
        draw: quaternions::momenta,
    },
    Figure {
        number: "2.11",
        file: "figure-2-11.svg",
        model: "heavy-top",
        draw: bodies::heavy_top,
    },
    Figure {
        number: "2.12",
        file: "figure-2-12.svg",
        model: "coupled-bodies",
        draw: bodies::coupled_momenta,
    },
    Figure {
        number: "2.13",
        file: "figure-2-13.svg",
        model: "coupled-bodies",
        draw: bodies::coupled_difference,
    },
    Figure {
        number: "2.14",
        file: "figure-2-14.svg",
        model: "coupled-bodies",
        draw: bodies::coupled_drift,
    },
    Figure {
        number: "2.15",
        file: "figure-2-15.svg",
        model: "free-body",
        draw: splitting::energy_against_step,
    },
    Figure {
        number: "2.16",
        file: "figure-2-16.svg",
        model: "free-body",
        draw: splitting::time_against_steps,
    },
    Figure {
        number: "2.17",
        file: "figure-2-17.svg",
        model: "free-body",
        draw: splitting::drift,
    },
    Figure {
        number: "3.1",
        file: "figure-3-01.svg",
        model: "mooney-rivlin",
        draw: elastic::stretches,
    },
    Figure {
        number: "3.2",
        file: "figure-3-02.svg",
        model: "mooney-rivlin",
        draw: elastic::momenta,
    },
    Figure {
        number: "3.3",
        file: "figure-3-03.svg",
        model: "mooney-rivlin",
        draw: elastic::drift,
    },
    Figure {
        number: "3.1-3.3",
        file: "figure-3-bipolar.svg",
        model: "pseudo-rigid",
        draw: bipolar::beside,
    },
    Figure {
        number: "Hopf",
        file: "hopf.svg",
        model: "cayley-klein",
        draw: fibration::hopf,
    },
];

/// Runs the command.
///
/// # Errors
/// Usage: the folder exists, or the gallery lacks a case. Failed: a run stops, or a file cannot be written.
pub fn figures(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let files = FIGURES.map(|figure| figure.file);
    let Some(target) = matches.get_one::<PathBuf>("out") else {
        return Err(Failure::Usage("--out DIR is required".to_owned()));
    };
    let staging = Staging::new(target, matches.get_flag("force"), &files)?;
    let as_json = matches.get_flag("json");
    let gallery = &elastic::with_files(gallery)?;
    let has = |figure: &Figure| {
        gallery
            .entries
            .iter()
            .any(|entry| entry.card.kebab == figure.model)
    };
    let (drawn, left): (Vec<Figure>, Vec<Figure>) = FIGURES.into_iter().partition(has);
    for figure in &drawn {
        let svg = (figure.draw)(gallery)?;
        staging.write(figure.file, |file| file.write_all(svg.as_bytes()))?;
    }
    staging.commit()?;
    if as_json {
        let figure = |figure: &Figure| json!({"figure": figure.number, "file": figure.file, "model": figure.model});
        let object = json!({
            "figures": drawn.iter().map(figure).collect::<Vec<Value>>(),
            "left_out": left.iter().map(figure).collect::<Vec<Value>>(),
            "out": target.display().to_string(),
            "exit_code": DONE,
        });
        writeln!(streams.out, "{object}")?;
        return Ok(DONE);
    }
    for figure in &drawn {
        writeln!(
            streams.out,
            "{:<7} {:<20}  {}",
            figure.number, figure.file, figure.model
        )?;
    }
    for figure in &left {
        writeln!(
            streams.out,
            "{:<7} omitted: the gallery has no model `{}`",
            figure.number, figure.model
        )?;
    }
    writeln!(streams.out, "\nwritten to {}", shown(target))?;
    Ok(DONE)
}
