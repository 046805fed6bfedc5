//! Wrong models and the messages of the compiler: one fault per file of `tests/ui/`, whose `.stderr` contains the
//! messages. A few run here; `refusals` of `derivation` tests all of them with the engine alone. To write messages
//! anew: `TRYBUILD=overwrite cargo test --profile quick -p clebsch-refusals --test compiler`.

/// The folder of the faults.
const FOLDER: &str = "tests/ui";

/// One fault for each way in which a message reaches the compiler: several at once, a rejection by the emitter, names
/// that other code uses, warnings, a range of tokens.
const COMPILED: [&str; 5] = [
    "several_faults",
    "group_too_large",
    "used_elsewhere",
    "warnings_on_their_tokens",
    "wrong_sided_action",
];

#[test]
fn the_compiler_shows_what_the_engine_says() {
    let compiler = trybuild::TestCases::new();
    if std::env::var_os("TRYBUILD").is_some() {
        compiler.compile_fail(format!("{FOLDER}/*.rs"));
    } else {
        for name in COMPILED {
            compiler.compile_fail(format!("{FOLDER}/{name}.rs"));
        }
    }
}
