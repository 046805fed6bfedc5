//! The command line: subcommands, options and the checks that need no model.
//! Takes nothing; gives the clap command, whose matches the commands read.

use clap::{Arg, ArgAction, Command, value_parser};

/// The whole command line.
#[must_use]
pub fn command() -> Command {
    Command::new("clebsch")
        .version(env!("CARGO_PKG_VERSION"))
        .about(
            "Discrete Clebsch variational integrators: derived from a Lagrangian, run from a case",
        )
        .after_help(
            "Exit codes: 0 done, 1 failed, 2 usage, 3 an invariant left the bound of its case \
             (results are written).",
        )
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("list")
                .about("List the models and their cases")
                .arg(json()),
        )
        .subcommand(
            Command::new("case")
                .about("Print a complete case as TOML, to start your own from")
                .arg(model())
                .arg(option(
                    "case",
                    "NAME",
                    "Case to print; the first one by default",
                )),
        )
        .subcommand(run())
        .subcommand(compare())
        .subcommand(figures())
        .subcommand(derive())
}

fn run() -> Command {
    planned(
        Command::new("run").about("Run a case and check what it conserves"),
        "Write every N-th node; by default such that at most 10000 are written. Invariants are \
         watched at every node in any case",
        "Write trajectory.csv, trajectory.npz, run.json and plots into this new folder",
    )
}

fn compare() -> Command {
    planned(
        Command::new("compare").about(
            "Run a case by the generated stepper, the hand-written one and other methods, side by side",
        ),
        "Compare at every N-th node; by default such that at most 10000 are compared",
        "Write comparison.csv, comparison.json and comparison.svg into this new folder",
    )
}

fn figures() -> Command {
    Command::new("figures")
        .about("Draw the figures of the thesis's second chapter from the cases of the gallery")
        .arg(
            option(
                "out",
                "DIR",
                "Write one SVG per figure into this new folder",
            )
            .required(true)
            .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace DIR when it holds earlier figures"))
        .arg(json())
}

/// What every command that runs a case takes.
fn planned(command: Command, every: &'static str, out: &'static str) -> Command {
    command
        .arg(model())
        .arg(option(
            "case",
            "NAME|FILE.toml",
            "Case of the model, or a file ending in .toml; the model's first case by default",
        ))
        .arg(
            option("steps", "N", "Number of steps instead of the case's")
                .value_parser(positive_count),
        )
        .arg(
            option(
                "h",
                "H",
                "Step size instead of the case's, in its unit of time",
            )
            .value_parser(positive_number),
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
        .arg(
            option(
                "dim",
                "N",
                "Size of the matrices, for a model of any size: its first case of that size, or the \
                 size of the case file",
            )
            .value_parser(positive_count),
        )
        .arg(option("every", "N", every).value_parser(positive_count))
        .arg(option("out", "DIR", out).value_parser(value_parser!(std::path::PathBuf)))
        .arg(flag("force", "Replace DIR when it holds an earlier run").requires("out"))
        .arg(json())
}

fn derive() -> Command {
    Command::new("derive")
        .about("Derive the equations of a model")
        .arg(
            Arg::new("model")
                .value_name("MODEL|FILE")
                .required_unless_present("write")
                .help("Model of the gallery, or a file that holds a model's text"),
        )
        .arg(
            option("format", "FORMAT", "What to print")
                .value_parser(["text", "latex", "markdown", "rust", "json"])
                .default_value("text"),
        )
        .arg(flag(
            "explain",
            "Show why each step of the derivation holds",
        ))
        .arg(flag(
            "write",
            "Write the derivations of all models of the gallery to generated/",
        ))
}

fn model() -> Arg {
    Arg::new("model")
        .value_name("MODEL")
        .required(true)
        .help("Model, as `clebsch list` shows it")
}

fn json() -> Arg {
    flag(
        "json",
        "Print one JSON object and nothing else on standard output",
    )
}

fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .action(ArgAction::SetTrue)
        .help(help)
}

/// Negative numbers reach the value's own check, whose message says what is wrong with them.
fn option(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .value_name(value)
        .allow_negative_numbers(true)
        .help(help)
}

fn positive_count(text: &str) -> Result<u64, String> {
    match text.parse::<u64>() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err(format!(
            "give a whole number, written in digits, at least 1 and at most {}",
            u64::MAX
        )),
    }
}

/// Which orders there are depends on the model, whose message lists them.
fn order_number(text: &str) -> Result<u32, String> {
    let order = text.parse::<u32>();
    order.map_err(|_| "give a whole number: 2, 4, 6, 8, or 10 for a free body".to_owned())
}

fn positive_number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("give a positive, finite number".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn clap_finds_no_contradiction() {
        super::command().debug_assert();
    }
}
