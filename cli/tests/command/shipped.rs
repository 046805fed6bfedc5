//! Every shipped model is listed, shown, copied and run by its name, from any folder.

use super::common::{Folder, program_in, shipped, with};
use clebsch_cli::gallery::Gallery;
use std::fs;
use std::path::Path;

#[test]
fn every_model_file_is_listed_with_every_case_beside_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let done = shipped(&["list", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("JSON");
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
    let chains = shipped(&["list", "chain"]);
    assert!(chains.out.contains("\ntoda-chain  "), "{}", chains.out);
    assert!(!chains.out.contains("heavy-top"), "{}", chains.out);
    let cases = shipped(&["list", "toda-chain"]);
    assert!(
        cases.out.contains("\ntwo-solitons  solitons of kappa"),
        "{}",
        cases.out
    );
    let wrong = shipped(&["list", "toda-chian"]);
    assert_eq!(wrong.code, 2);
    assert!(
        wrong.err.contains("did you mean `toda-chain`?"),
        "{}",
        wrong.err
    );
}

#[test]
fn a_shipped_model_runs_by_its_name_as_by_its_file() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/lattices");
    let named = shipped(&["run", "toda-chain:two-solitons", "--steps", "20"]);
    let path = format!("{root}/toda-chain.clebsch");
    let by_path = shipped(&["run", &path, "--case", "two-solitons", "--steps", "20"]);
    assert_eq!((named.code, &named.err), (0, &String::new()));
    assert_eq!(named.out, by_path.out);
    // The file beside it is its default case.
    let first = shipped(&["run", "toda-chain", "--steps", "20"]);
    let beside = shipped(&["run", &path, "--steps", "20"]);
    assert_eq!((first.code, first.out), (0, beside.out));
    for (model, case) in [
        ("toda-chain:solito", "soliton"),
        ("kepler:circulr", "circular"),
    ] {
        let done = shipped(&["run", model]);
        assert_eq!(done.code, 2);
        assert!(
            done.err.contains(&format!("did you mean `{case}`?")),
            "{}",
            done.err
        );
    }
    let twice = shipped(&["run", "kepler:circular", "--case", "eccentric"]);
    assert!(
        twice.err.contains("--case names another one"),
        "{}",
        twice.err
    );
}

#[test]
fn a_file_without_a_case_is_not_run_with_made_up_numbers() {
    let folder = Folder::new("shipped-no-case");
    let text =
        "model FreeMass { param m: Real; field x: Real; lagrangian = m*(next(x) - x)^2/(2*h); }";
    let file = folder.write("free.clebsch", text);
    let done = shipped(&["run", &file]);
    assert_eq!((done.code, done.out.as_str()), (2, ""));
    let way = format!("clebsch case {file} > {}", folder.path("free.toml"));
    assert!(done.err.contains(&way), "{}", done.err);
    // What the message says to do does it.
    folder.write("free.toml", &shipped(&["case", &file]).out);
    let done = shipped(&["run", &file]);
    assert_eq!(done.code, 0, "{}", done.err);
    // What is wrong with the model comes before what is missing.
    let wrong = folder.write("wrong.clebsch", &text.replace("(2*h)", "(2*k)"));
    let done = shipped(&["run", &wrong]);
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
        let done = shipped(&arguments);
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{name}");
        let model = format!("{path}.clebsch");
        let checked = shipped(&["check", &model]);
        assert_eq!((checked.code, checked.err.as_str()), (0, ""), "{name}");
        assert!(
            checked.out.contains("first step: solved"),
            "{}",
            checked.out
        );
        let run = shipped(&["run", &model, "--steps", "3"]);
        assert_eq!(run.code, 0, "{name}: {}", run.err);
        // A second time nothing is replaced.
        let before = fs::read_to_string(&model).expect("the model");
        let again = shipped(&arguments);
        assert_eq!(again.code, 2);
        assert!(again.err.contains("exists"), "{}", again.err);
        assert_eq!(fs::read_to_string(&model).expect("the model"), before);
    }
    for wrong in ["3x", "a b!", "ö", "-"] {
        let done = shipped(&["new", &folder.path(wrong)]);
        assert_eq!(done.code, 2, "{wrong}");
        assert!(done.err.contains("cannot name a model"), "{}", done.err);
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
        let done = shipped(&["show", model]);
        assert_eq!(done.code, 0, "{}", done.err);
        for part in parts {
            assert!(done.out.contains(part), "{part}\n{}", done.out);
        }
    }
}

#[test]
fn input_without_end_is_refused() {
    let folder = Folder::new("shipped-bounded");
    let long = folder.write("long.toml", &"# nothing\n".repeat(1_000_001));
    for arguments in [
        &["derive", "/dev/zero"][..],
        &["run", "kepler", "--case", &long],
    ] {
        let done = shipped(arguments);
        assert_eq!(done.code, 2, "{arguments:?}");
        assert!(done.err.contains("longer than 10 MB"), "{}", done.err);
    }
    let endless = with(
        &Gallery::shipped(),
        &["derive", "-"],
        &" ".repeat(10_000_001),
        None,
    );
    assert!(
        endless.err.contains("standard input is longer than 10 MB"),
        "{}",
        endless.err
    );
}

#[test]
fn an_installed_command_needs_no_folder_of_models() {
    let folder = Folder::new("shipped-elsewhere");
    let done = program_in(
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
    let case = shipped(&["case", model]).out;
    for line in [
        "# mass of a point\nm = ",
        "# momentum of q at the first node\n",
        "\n[bounds]\n",
        "\n# energy = 1e-3 ",
    ] {
        assert!(case.contains(line), "{line}\n{case}");
    }
    let strict = folder.write(
        "strict.toml",
        &case.replace("\n# energy = 1e-3 ", "\nenergy = 1e-20 "),
    );
    let done = shipped(&["run", model, "--case", &strict, "--steps", "10"]);
    assert_eq!(done.code, 3, "{}", done.err);
}
