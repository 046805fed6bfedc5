//! Options with the names that other programs use: `--time` for `--until`. Takes an error of clap; gives the error
//! with the right option.

use clap::error::{ContextKind, ContextValue};

/// Option names of other programs, each with the clebsch option for the same purpose.
const NAMES: [(&str, &str); 9] = [
    ("--time", "--until"),
    ("--tmax", "--until"),
    ("--t-max", "--until"),
    ("--t-end", "--until"),
    ("--tend", "--until"),
    ("--duration", "--until"),
    ("--dt", "--h"),
    ("--step-size", "--h"),
    ("--output", "--out"),
];

/// The error, with the name of the intended option if the command has it.
pub(crate) fn explained(
    mut error: clap::Error,
    command: &clap::Command,
    name: Option<&str>,
) -> clap::Error {
    let asked = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(asked)) => asked.clone(),
        _ => return error,
    };
    let known = NAMES.iter().find(|(other, _)| *other == asked);
    let command = name.and_then(|name| command.find_subcommand(name));
    let (Some((_, own)), Some(command)) = (known, command) else {
        return error;
    };
    let mut options = command.get_arguments().filter_map(clap::Arg::get_long);
    if options.any(|long| own.strip_prefix("--") == Some(long)) {
        let own = ContextValue::String((*own).to_owned());
        error.insert(ContextKind::SuggestedArg, own);
        // The line of usage has the option that clap suggests.
        error.insert(ContextKind::Usage, ContextValue::None);
    }
    error
}
