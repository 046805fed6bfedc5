//! The arguments that select a model and a case, and the options of its run.

use super::option::{
    flag, json, no_cache, option, order_number, positive_count, positive_number, step_size,
};
use clap::{Arg, ArgAction, Command, value_parser};

/// Adds the arguments of every command that runs a case once.
pub(super) fn planned(command: Command, every: &'static str, out: &'static str) -> Command {
    of_a_case(command)
        .arg(option("every", "N", every).value_parser(positive_count))
        .arg(option("out", "DIR", out).value_parser(value_parser!(std::path::PathBuf)))
        .arg(flag("force", "Replace DIR if it contains an earlier run").requires("out"))
        .arg(json())
}

/// The case that `show` and `case` print.
pub(super) fn shown_case() -> Arg {
    option(
        "case",
        "NAME",
        "Case to print; by default the first, and placeholder values for a model file",
    )
}

/// Adds the arguments that select a case, and the options of its run.
pub(super) fn of_a_case(command: Command) -> Command {
    command
        .arg(model())
        .arg(option(
            "case",
            "NAME|FILE.toml",
            "Case of the model, or a .toml file. The default is the first case of the model, or M.toml for a model file \
             M.clebsch. For a model file, NAME selects the case M/NAME.toml. MODEL:NAME is a short form",
        ))
        .arg(
            option(
                "steps",
                "N",
                "Number of steps, such as 20000 or 2e4; overrides the case",
            )
            .value_parser(positive_count),
        )
        .arg(
            option(
                "until",
                "T",
                "Final time, instead of a number of steps; the run ends at the nearest node after the start",
            )
            .conflicts_with("steps")
            .value_parser(positive_number),
        )
        .arg(
            option(
                "set",
                "NAME=VALUE",
                "Parameter or initial value that overrides the case: a number, a component, or any value of a case file, \
                 such as gU.z=0.5, gU=[0,0,1], R.angle=1 or 'R={axis=[0,0,1], angle=1}'; repeatable",
            )
            .action(ArgAction::Append),
        )
        .arg(
            option(
                "h",
                "H",
                "Step size in the case's unit of time; overrides the case",
            )
            .value_parser(step_size),
        )
        .arg(
            option(
                "order",
                "N",
                "Order of accuracy, if the model offers several: 2 to 10 for a free body, 2 to 8 for other reversible steps",
            )
            .value_parser(order_number),
        )
        .arg(flag(
            "compensated",
            "Add a constant rotation about the momentum to each step of order 4, 6 or 8 of a free body, so that the step is \
             symplectic in momentum and attitude up to h^11",
        ))
        .arg(option(
            "solver",
            "NAME",
            "Solver of the implicit step, if the model offers several",
        ))
        .arg(flag(
            "halve",
            "If a step fails, retry it as two, four, ... substeps; the result reports them and is no longer symplectic",
        ))
        .arg(
            option(
                "dim",
                "N",
                "Size of the matrices, for a model of any size: selects the first case of that size, or sets the size of the case \
                 file",
            )
            .value_parser(positive_count),
        )
        .arg(no_cache())
}

pub(super) fn model() -> Arg {
    Arg::new("model")
        .value_name("MODEL")
        .required(true)
        .help("Model from `clebsch list`, MODEL:CASE, or a model file")
}
