//! The commands that draw and derive: `plot`, `figures` and `derive`.

use super::option::{flag, json, no_cache, option};
use clap::builder::PossibleValue;
use clap::{Arg, ArgAction, Command, value_parser};

pub(super) fn plot() -> Command {
    Command::new("plot")
        .about("Plot columns of a finished run, against time or against each other")
        .after_help(
            "Examples:\n  clebsch plot out/kepler\n  clebsch plot out/kepler --x X.1 --y X.2\n  \
             clebsch plot out/kepler --y X --y invariant_energy --from 100 --to 120",
        )
        .arg(
            Arg::new("dir")
                .value_name("DIR")
                .required(true)
                .value_parser(value_parser!(std::path::PathBuf))
                .help("Folder that `clebsch run --out` wrote"),
        )
        .arg(
            option(
                "x",
                "NAME",
                "Column along the horizontal axis, by default time. Give one for all --y, or one for each --y, for \
                 example for the orbits of two bodies",
            )
            .action(ArgAction::Append),
        )
        .arg(
            option(
                "y",
                "NAME",
                "Column to draw, such as X.1, X (all components) or q_3 (site 3 of a chain); comma-separated or repeated. \
                 Without it, the columns are listed",
            )
            .action(ArgAction::Append),
        )
        .arg(option("from", "T", "First time to draw").value_parser(value_parser!(f64)))
        .arg(option("to", "T", "Last time to draw").value_parser(value_parser!(f64)))
        .arg(
            option("out", "FILE", "SVG to write; by default a file in DIR named after the columns")
                .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace FILE even if this command did not write it"))
}

pub(super) fn figures() -> Command {
    Command::new("figures")
        .about("Draw the figures of Dixon's thesis for chapter 2 and the elastic body of chapter 3, from named cases")
        .after_help("Examples:\n  clebsch figures --out out/figures")
        .arg(
            option(
                "out",
                "DIR",
                "Write one SVG per figure into this new folder",
            )
            .required(true)
            .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace DIR if it contains earlier figures"))
        .arg(no_cache())
        .arg(json())
}

pub(super) fn derive() -> Command {
    Command::new("derive")
        .about("Derive the equations of a model")
        .after_help(
            "Examples:\n  clebsch derive heavy-top\n  clebsch derive heavy-top --format latex > top.tex\n  \
             clebsch derive my-top.clebsch --explain\n  clebsch derive - < my-top.clebsch",
        )
        .arg(
            Arg::new("model")
                .value_name("MODEL|FILE")
                .required_unless_present("write")
                .help(
                    "Shipped model, or a file with the text of a model; - for standard input",
                ),
        )
        .arg(
            option("format", "FORMAT", "What to print")
                .value_parser([
                    PossibleValue::new("text").alias("txt"),
                    PossibleValue::new("latex").alias("tex"),
                    PossibleValue::new("markdown").alias("md"),
                    PossibleValue::new("rust").alias("rs"),
                    PossibleValue::new("json"),
                    PossibleValue::new("program")
                        .help("The operations of a step, counted and listed, for MODEL:CASE or the first case"),
                ])
                .default_value("text"),
        )
        .arg(flag(
            "explain",
            "Justify each step of the derivation",
        ))
        .arg(flag(
            "second-proof",
            "Prove each step a second time, by equality saturation, which takes longer",
        ))
        .arg(flag(
            "no-thesis",
            "Omit references to the equations of Dixon's thesis",
        ))
        .arg(flag(
            "standalone",
            "Print a complete LaTeX document, with its bibliography",
        ))
        .arg(flag(
            "write",
            "Write the derivations of all compiled models to generated/",
        ))
}
