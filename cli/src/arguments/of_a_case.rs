//! The arguments that select a model and a case, and the options of its run.

use super::option::{flag, json, option, order_number, positive_count, positive_number, step_size};
use clap::{Arg, ArgAction, Command, value_parser};

/// Adds the arguments of every command that runs a case once.
pub(super) fn planned(command: Command, every: &'static str, out: &'static str) -> Command {
    of_a_case(command)
        .arg(option("every", "N", every).value_parser(positive_count))
        .arg(option("out", "DIR", out).value_parser(value_parser!(std::path::PathBuf)))
        .arg(flag("force", "Replace DIR when it holds an earlier run").requires("out"))
        .arg(json())
}

/// The case that `show` and `case` print.
pub(super) fn shown_case() -> Arg {
    option(
        "case",
        "NAME",
        "Case to print; the first one by default, and placeholder values for a model file",
    )
}

/// Adds the arguments that select a case, and the options of its run.
pub(super) fn of_a_case(command: Command) -> Command {
    command
        .arg(model())
        .arg(option(
            "case",
            "NAME|FILE.toml",
            "Case of the model, or a file ending in .toml. The default is the model's first case, and M.toml for a model \
             file M.clebsch; a NAME is then the case M/NAME.toml. MODEL:NAME does the same",
        ))
        .arg(
            option(
                "steps",
                "N",
                "Number of steps instead of the case's, such as 20000 or 2e4",
            )
            .value_parser(positive_count),
        )
        .arg(
            option(
                "until",
                "T",
                "Time to run to, instead of a number of steps; the run ends at the node nearest to it",
            )
            .conflicts_with("steps")
            .value_parser(positive_number),
        )
        .arg(
            option(
                "set",
                "NAME=VALUE",
                "Parameter or initial value instead of the case's: a number, a component, or what a case file takes, such as gU.z=0.5, gU=[0,0,1], R.angle=1 or 'R={axis=[0,0,1], angle=1}'; may be repeated",
            )
            .action(ArgAction::Append),
        )
        .arg(
            option(
                "h",
                "H",
                "Step size instead of the case's, in its unit of time",
            )
            .value_parser(step_size),
        )
        .arg(
            option(
                "order",
                "N",
                "Order of accuracy of a step, where the model offers more than one: 2 to 10 for a \
                 free body, 2 to 8 for other reversible steps",
            )
            .value_parser(order_number),
        )
        .arg(flag(
            "compensated",
            "Make steps of order 4, 6 or 8 of a free body symplectic with the attitude, by a \
             constant turn about the momentum",
        ))
        .arg(option(
            "solver",
            "NAME",
            "Solver of the implicit step instead of the model's own, where it offers several",
        ))
        .arg(flag(
            "halve",
            "Make a step that is refused by two, four, ... steps of a part of its length; the result says how many \
             were, and is no longer symplectic",
        ))
        .arg(
            option(
                "dim",
                "N",
                "Size of the matrices, for a model of any size: its first case of that size, or the \
                 size of the case file",
            )
            .value_parser(positive_count),
        )
}

pub(super) fn model() -> Arg {
    Arg::new("model")
        .value_name("MODEL")
        .required(true)
        .help("Model as `clebsch list` shows it, MODEL:CASE, or a model file")
}
