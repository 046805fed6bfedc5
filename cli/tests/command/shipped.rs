//! Every shipped model is listed, shown, copied and run by its name, from any folder.

use crate::common::{Folder, clebsch, has, process_in, runs, with};
use clebsch_cli::gallery::Gallery;
use std::fs;
use std::path::Path;

#[test]
fn every_model_file_is_listed_with_every_case_beside_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let json = clebsch("list --json").json();
    let models = json["models"].as_array().expect("a list");
    let mut found = 0;
    for folder in ["elastic", "lattices", "fluids"] {
        for entry in fs::read_dir(root.join(folder)).expect("a folder").flatten() {
            let path = entry.path();
            if path.extension().is_none_or(|e| e != "clebsch") {
                continue;
            }
            found += 1;
            let name = path.file_stem().and_then(|s| s.to_str()).expect("a name");
            let model = models.iter().find(|model| model["model"] == name);
            let cases = model.expect(name)["cases"].as_array().expect("cases").len();
            let own = usize::from(path.with_extension("toml").is_file());
            let more = fs::read_dir(path.with_extension("")).map_or(0, Iterator::count);
            assert_eq!(cases, own + more, "{name}");
            assert!(cases > 0, "{name} has no case");
        }
    }
    assert!(found > 25, "{found}");
    assert_eq!(models.len(), found + Gallery::shipped().entries.len());
}

#[test]
fn families_and_models_are_listed_by_themselves() {
    clebsch("list chain")
        .prints("\ntoda-chain  ")
        .never_prints("heavy-top");
    clebsch("list toda-chain").prints("\ntwo-solitons  solitons with kappa");
    clebsch("list toda-chian").refuses("did you mean `toda-chain`?");
}

#[test]
fn a_shipped_model_runs_by_its_name_as_by_its_file() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/lattices");
    let named = clebsch("run toda-chain:two-solitons --steps 20");
    let path = format!("{root}/toda-chain.clebsch");
    let by_path = clebsch(&format!("run {path} --case two-solitons --steps 20"));
    assert_eq!((named.code, &named.err), (0, &String::new()));
    assert_eq!(named.out, by_path.out);
    // The file next to it is its default case.
    let first = clebsch("run toda-chain --steps 20");
    let beside = clebsch(&format!("run {path} --steps 20"));
    assert_eq!((first.code, first.out), (0, beside.out));
    for (model, case) in [
        ("toda-chain:solito", "soliton"),
        ("kepler:circulr", "circular"),
    ] {
        clebsch(&format!("run {model}")).refuses(format!("did you mean `{case}`?"));
    }
    clebsch("run kepler:circular --case eccentric").says("--case names another");
}

#[test]
fn a_file_without_a_case_is_not_run_with_made_up_numbers() {
    let folder = Folder::new("shipped-no-case");
    let text =
        "model FreeMass { param m: Real; field x: Real; lagrangian = m*(next(x) - x)^2/(2*h); }";
    let file = folder.write("free.clebsch", text);
    let done = folder.clebsch("run @free.clebsch");
    done.ended(2).prints_nothing();
    let way = format!("clebsch case {file} > {}", folder.path("free.toml"));
    done.says(&way);
    // The advice in the message works.
    folder.write("free.toml", &folder.clebsch("case @free.clebsch").out);
    folder.runs("run @free.clebsch");
    // An error in the model is reported before a missing case.
    folder.write("wrong.clebsch", text.replace("(2*h)", "(2*k)"));
    let done = folder.clebsch("run @wrong.clebsch");
    assert!(
        done.err.contains('^') && !done.err.contains("no case"),
        "{}",
        done.err
    );
}

#[test]
fn a_new_model_runs_wherever_it_was_copied_from() {
    let folder = Folder::new("shipped-new");
    for (name, from) in [
        ("own-spring", None),
        ("own-top", Some("heavy-top:general")),
        ("own-chain", Some("toda-chain:two-solitons")),
        ("own_fluid", Some("particle-mesh-2d")),
        ("OwnBody", Some("neo-hooke")),
    ] {
        let path = folder.path(name);
        let mut arguments = vec!["new", path.as_str()];
        arguments.extend(from.iter().flat_map(|from| ["--from", from]));
        runs(&arguments).says_nothing();
        let model = format!("{path}.clebsch");
        runs(&format!("check {model}"))
            .says_nothing()
            .prints("first step: solved");
        runs(&format!("run {model} --steps 3"));
        // A second call replaces nothing.
        let before = fs::read_to_string(&model).expect("the model");
        clebsch(&arguments).refuses("exists");
        assert_eq!(fs::read_to_string(&model).expect("the model"), before);
    }
    for wrong in ["3x", "a b!", "ö", "-"] {
        clebsch(&["new", &folder.path(wrong)]).refuses("cannot be the name of a model");
    }
}

#[test]
fn a_model_is_shown_with_its_statement_and_a_case() {
    for (model, parts) in [
        ("toda-chain", ["model TodaChain {", "name = \"soliton\""]),
        (
            "toda-chain:two-solitons",
            ["model TodaChain {", "name = \"two-solitons\""],
        ),
        ("heavy-top", ["model HeavyTop {", "name = \"lagrange\""]),
    ] {
        let done = runs(&format!("show {model}"));
        for part in parts {
            done.prints(part);
        }
    }
}

#[test]
fn input_without_end_is_refused() {
    let folder = Folder::new("shipped-bounded");
    let long = folder.write("long.toml", "# nothing\n".repeat(1_000_001));
    for arguments in [
        &["derive", "/dev/zero"][..],
        &["run", "kepler", "--case", &long],
    ] {
        clebsch(arguments).refuses("larger than 10 MB");
    }
    with(
        &Gallery::shipped(),
        &["derive", "-"],
        &" ".repeat(10_000_001),
        None,
    )
    .says("standard input is larger than 10 MB");
}

#[test]
fn an_installed_command_needs_no_folder_of_models() {
    let folder = Folder::new("shipped-elsewhere");
    let done = process_in(
        &folder.path("."),
        &["run", "sine-gordon", "--steps", "2", "--quiet"],
    );
    assert_eq!(
        (done.code, done.out.as_str(), done.err.as_str()),
        (0, "", "")
    );
}

#[test]
fn the_case_of_a_chain_has_the_words_of_the_model_and_its_bounds() {
    let folder = Folder::new("shipped-chain-case");
    let model = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../models/lattices/toda-chain.clebsch"
    );
    let case = clebsch(&format!("case {model}")).out;
    has(
        &case,
        [
            "# mass of a point\nm = ",
            "# momentum of q at the first node\n",
            "\n[bounds]\n",
            "\n# energy = 1e-3 ",
        ],
    );
    folder.write(
        "strict.toml",
        case.replace("\n# energy = 1e-3 ", "\nenergy = 1e-20 "),
    );
    folder
        .clebsch(&format!("run {model} --case @strict.toml --steps 10"))
        .exits(3);
}
