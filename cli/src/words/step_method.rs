//! How steps are taken, as a sentence.

/// How a model runs: its stepper was `compiled` with the command, or is read from its text.
pub(crate) fn step_method(compiled: bool) -> &'static str {
    match (compiled, cfg!(feature = "native")) {
        (true, _) => "compiled",
        (false, true) => "from its text, with native code for frequent steps",
        (false, false) => "from its text, without native code",
    }
}
