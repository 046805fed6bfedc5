//! Checks the import order of the folders in `cli/src`: each folder imports only from folders before it in [`ORDER`], so that
//! imports are acyclic.

use std::fs;
use std::path::Path;

/// The folders of the command, each after the folders from which it may import.
const ORDER: [&str; 15] = [
    "words",
    "terminal",
    "arguments",
    "models",
    "case_file",
    "overrides",
    "named",
    "plan",
    "derivatives",
    "trajectory",
    "output",
    "plots",
    "page",
    "commands",
    "session",
];

#[test]
fn folders_of_the_command_import_one_way() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cli/src");
    let mut wrong = Vec::new();
    let mut imports = 0;
    for entry in fs::read_dir(&root).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !ORDER.contains(&name.as_str()) {
            wrong.push(format!("cli/src/{name}: name this folder in ORDER"));
        }
        let is_root = ["lib.rs", "main.rs"].contains(&name.as_str());
        if path.is_file() && !is_root {
            wrong.push(format!("cli/src/{name}: put this file into a folder"));
        }
    }
    for folder in ORDER {
        let mut found = Vec::new();
        super::architecture::sources(&root.join(folder), &mut found);
        for path in found {
            let own = path.strip_prefix(&root).unwrap();
            let own = own.to_string_lossy().replace('\\', "/");
            for imported in imported(&own, &fs::read_to_string(&path).unwrap()) {
                imports += 1;
                wrong.extend(refusal(&own, folder, &imported));
            }
        }
    }
    assert!(imports > 300, "{imports} imports only");
    wrong.sort();
    wrong.dedup();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn wrong_imports_are_seen() {
    let of = |file: &str, text: &str| {
        let folder = file.split('/').next().unwrap();
        let all = imported(file, text).into_iter();
        all.filter_map(|name| refusal(file, folder, &name)).count()
    };
    assert_eq!(of("plan/mod.rs", "use crate::words::plain::shown;"), 0);
    assert_eq!(of("plan/mod.rs", "use crate::plan::invalid_values;"), 0);
    assert_eq!(of("plan/mod.rs", "use crate::page::page;"), 1);
    assert_eq!(of("plan/mod.rs", "let x = crate::Streams;"), 1);
    assert_eq!(of("plan/mod.rs", "// crate::page\nuse crate::{page};"), 1);
    assert_eq!(of("page/a/b.rs", "use super::super::c;"), 0);
    assert_eq!(of("page/a/b.rs", "use super::super::super::commands;"), 1);
    let tests = "use super::a;\n#[cfg(test)]\nmod tests {\n    use super::super::b;\n}\n";
    assert_eq!(of("page/a.rs", tests), 0);
}

/// The modules of the crate that a file imports, by `crate::` or by `super::` up to the crate root.
fn imported(file: &str, text: &str) -> Vec<String> {
    let names = file.strip_suffix(".rs").unwrap_or(file).split('/');
    let depth = names.filter(|name| *name != "mod").count();
    let mut inner = 0;
    let mut out = Vec::new();
    for line in text.lines() {
        let code = line.split("//").next().unwrap_or_default();
        inner += usize::from(code.starts_with("mod tests {"));
        let climbs = code.split("super::").skip(1);
        let ends = climbs.scan(0, |climbed, rest| {
            *climbed += 1;
            let end = (*climbed, rest);
            if !rest.is_empty() {
                *climbed = 0;
            }
            Some(end)
        });
        let ends = ends.filter(|(climbed, rest)| !rest.is_empty() && *climbed == depth + inner);
        let climbed = ends.map(|(_, rest)| rest);
        for rest in code.split("crate::").skip(1).chain(climbed) {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
            out.push(rest[..end.unwrap_or(rest.len())].to_owned());
        }
    }
    out
}

/// Why a file of a folder may not import from a module, and what to do.
fn refusal(file: &str, folder: &str, imported: &str) -> Option<String> {
    let place = |name: &str| ORDER.iter().position(|own| *own == name);
    match place(imported) {
        Some(at) if Some(at) <= place(folder) => None,
        Some(_) => Some(format!(
            "cli/src/{file} imports crate::{imported}, a later folder than {folder} (the order is {}). Move what both need into a \
             folder not later than {folder}, or let its caller pass it as an argument",
            ORDER.join(", ")
        )),
        None => Some(format!(
            "cli/src/{file} imports crate::{imported}, which is no folder: write the path through the folder, one for each `use`"
        )),
    }
}
