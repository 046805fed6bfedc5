//! Writes random models as `model!` invocations, each with a function that evaluates the model's residual on plain arrays.
//! `CLEBSCH_RANDOM_MODELS` sets their number; the default is 60.

use oracle::wide::model::{Model, Role};
use std::fmt::Write;

/// Includes only the generator, so that this build script depends on neither the runtime nor the engine.
#[allow(dead_code, unused_imports)]
#[path = "../oracle/src/oracle"]
mod oracle {
    pub mod dual;
    pub mod points;
    pub mod sides;
    pub mod square;
    pub mod wide;
}

#[allow(dead_code)]
#[path = "../oracle/src/sizes.rs"]
mod sizes;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-env-changed=CLEBSCH_RANDOM_MODELS");
    println!("cargo::rerun-if-env-changed=CLEBSCH_RANDOM_FIRST");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../oracle/src/oracle");
    println!("cargo::rerun-if-changed=../oracle/src/sizes.rs");
    let given = |name: &str| std::env::var(name).ok().and_then(|text| text.parse().ok());
    let count = given("CLEBSCH_RANDOM_MODELS").unwrap_or(sizes::COMPILED);
    let first = given("CLEBSCH_RANDOM_FIRST").unwrap_or(0);
    let mut text = String::new();
    let mut table = String::new();
    for seed in first..first + count {
        write_model(&mut text, &Model::of_seed(seed), seed)?;
        writeln!(
            table,
            "    Compiled {{ seed: {seed}, residual: m{seed}::residual, card: &m{seed}::Wide{seed}::<f64>::CARD }},"
        )?;
    }
    writeln!(
        text,
        "/// All of them.\npub const MODELS: &[Compiled] = &[\n{table}];"
    )?;
    let folder = std::env::var("OUT_DIR")?;
    std::fs::write(std::path::Path::new(&folder).join("models.rs"), text)?;
    Ok(())
}

/// Writes one model in its own module.
fn write_model(out: &mut String, model: &Model, seed: u64) -> std::fmt::Result {
    let name = &model.name;
    let fields = |wanted: &dyn Fn(&Role) -> bool, level: &str| -> String {
        let letters = model.letters.iter().enumerate();
        letters
            .filter(|(index, l)| model.uses(*index) && wanted(&l.role))
            .map(|(_, l)| format!("{0}: given.get(\"{0}\", {level})?, ", l.name))
            .collect()
    };
    let parameters = fields(&|role| matches!(role, Role::Parameter), "0");
    let configuration = fields(&Role::is_given, "level");
    writeln!(out, "/// A random model.\npub mod m{seed} {{")?;
    writeln!(
        out,
        "#![allow(missing_docs, non_snake_case, deprecated, clippy::all)]"
    )?;
    writeln!(out, "use crate::NamedValues;")?;
    writeln!(out, "clebsch::model! {{ pub {} }}", model.text())?;
    writeln!(
        out,
        "pub fn residual(h: f64, given: &NamedValues) -> Result<Vec<f64>, String> {{\n\
         let model = {name}::<f64>::new({name}Parameters {{ {parameters} }}).map_err(|e| e.to_string())?;\n\
         let at = |level: i8| -> Result<{name}Configuration<f64>, String> {{ Ok({name}Configuration {{ {configuration} }}) }};\n\
         Ok(model.balance(h, &at(-1)?, &at(0)?, &at(1)?).iter().copied().collect())\n}}"
    )?;
    writeln!(out, "}}")
}
