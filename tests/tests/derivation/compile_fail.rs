//! Wrong models and what the compiler says of them: one fault a file of `ui/`, whose `.stderr`
//! holds the message. Takes those files; fails when a model compiles or a message changes. To
//! write the messages anew: `TRYBUILD=overwrite cargo test --release --test derivation compile_fail`.

#[test]
fn every_fault_is_refused_on_its_tokens() {
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}
