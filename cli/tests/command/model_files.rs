//! Models that run from their texts: they give the same tables as compiled models, and equally good messages.

use crate::common::{Folder, on};
use crate::text_runs::run;
use clebsch_cli::gallery::Gallery;

/// The text of a model of the gallery.
fn text(model: &str) -> &'static str {
    clebsch_models::find(model)
        .expect("in the gallery")
        .card
        .source
}

/// A top whose energy differs from every model of the gallery.
const OTHER: &str = "model Beam {
    param J: Sym<3>;
    param a: Vec<3>;
    param k: Real;
    group R: SO<3> velocity W;
    advected u: Vec<3>;
    constraint next(R) = R*W;
    constraint next(u) = W^T*u;
    lagrangian = -tr(J*W)/h - h*k*(dot(a, u)^2 + dot(a, u));
}";

#[test]
fn a_run_tells_the_same_as_that_of_the_built_model() {
    let folder = Folder::new("model-files-same");
    let gallery = Gallery::shipped();
    for model in ["heavy-top", "free-body", "kepler"] {
        let file = folder.write(&format!("{model}.clebsch"), text(model));
        let case = folder.write(
            &format!("{model}.toml"),
            &on(&gallery, &["case", model]).out,
        );
        for more in [&[][..], &["--order", "4"], &["--json"]] {
            let common = [&["--steps", "300", "--case", case.as_str()], more].concat();
            let built = on(&gallery, &[&["run", model], &common[..]].concat());
            let read = on(&gallery, &[&["run", file.as_str()], &common[..]].concat());
            built.ended(0);
            assert_eq!((built.code, built.err), (read.code, read.err));
            // How long a step took, and when it ran.
            let timeless = |out: &str| -> Vec<String> {
                let lines = out
                    .lines()
                    .filter(|l| !l.contains("second") && !l.contains("time"));
                lines.map(str::to_owned).collect()
            };
            assert_eq!(
                timeless(&built.out),
                timeless(&read.out),
                "{model} {more:?}"
            );
        }
    }
}

#[test]
fn what_a_run_writes_is_the_same_as_of_the_built_model() {
    let folder = Folder::new("model-files-written");
    let gallery = Gallery::shipped();
    let file = folder.write("top.clebsch", text("heavy-top"));
    let case = folder.write("case.toml", &on(&gallery, &["case", "heavy-top"]).out);
    let built = folder.path("built");
    let read = folder.path("read");
    for (model, out) in [("heavy-top", &built), (file.as_str(), &read)] {
        on(
            &gallery,
            &[
                "run", model, "--case", &case, "--steps", "200", "--out", out,
            ],
        )
        .succeeds();
    }
    for name in [
        "trajectory.csv",
        "trajectory.npz",
        "momentum.svg",
        "invariants.svg",
    ] {
        let bytes = |folder: &str| std::fs::read(format!("{folder}/{name}")).expect(name);
        assert!(bytes(&built) == bytes(&read), "{name}");
    }
    // Two models may have one name, so run.json records the path.
    let told = std::fs::read_to_string(format!("{read}/run.json")).expect("run.json");
    let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!(told["arguments"]["model"], serde_json::json!(file));
}

#[test]
fn a_model_outside_the_gallery_gives_a_case_that_runs_and_compares() {
    let folder = Folder::new("model-files-other");
    let gallery = Gallery::shipped();
    let file = folder.write("beam.clebsch", OTHER);
    let case = on(&gallery, &["case", &file]);
    case.ended(0).says_nothing();
    case.prints("model = \"beam\"");
    let command = format!("clebsch run {file} --case THIS-FILE.toml");
    case.prints(&command);
    let case = folder.write("beam.toml", &case.out);
    on(&gallery, &["run", &file, "--case", &case, "--steps", "500"])
        .succeeds()
        .prints("energy");
    // Without a case, the sample.
    on(
        &gallery,
        &["run", &file, "--case", "sample", "--steps", "500"],
    )
    .succeeds();
    on(
        &gallery,
        &["compare", &file, "--case", &case, "--steps", "100"],
    )
    .succeeds()
    .prints("order");
}

#[test]
fn a_file_without_a_model_that_runs_is_told_as_derive_tells_it() {
    let folder = Folder::new("model-files-wrong");
    let gallery = Gallery::shipped();
    let wrong = OTHER.replace("next(u) = W^T*u", "next(u) = W*u");
    for (name, text) in [
        ("wrong.clebsch", wrong.as_str()),
        ("two.clebsch", &format!("{OTHER}\n{OTHER}")),
        ("none.clebsch", "fn main() {}"),
        ("empty.clebsch", ""),
    ] {
        let file = folder.write(name, text);
        let derived = on(&gallery, &["derive", &file]);
        for command in ["run", "compare", "case"] {
            let done = on(&gallery, &[command, &file]);
            assert_eq!(
                (done.code, done.out.as_str(), &done.err),
                (2, "", &derived.err),
                "{command}"
            );
            done.says(name);
        }
    }
    for missing in ["no-such-file.clebsch", "./no/such.clebsch"] {
        let derived = on(&gallery, &["derive", missing]);
        let done = on(&gallery, &["run", missing]);
        assert_eq!((done.code, &done.err), (2, &derived.err));
        done.says("does not exist; `clebsch new");
    }
}

#[test]
fn wrong_values_are_told_with_file_and_line() {
    let folder = Folder::new("model-files-values");
    let gallery = Gallery::shipped();
    let file = folder.write("top.clebsch", text("heavy-top"));
    let case = on(&gallery, &["case", "heavy-top"]).out;
    let place = case.find("\ngU = [").expect("a parameter") + "\ngU = [".len();
    let end = place + case[place..].find(',').expect("numbers");
    let spoiled = format!("{}nan{}", &case[..place], &case[end..]);
    let case = folder.write("case.toml", &spoiled);
    let built = on(&gallery, &["run", "heavy-top", "--case", &case]);
    let read = on(&gallery, &["run", &file, "--case", &case]);
    assert_eq!((built.code, &built.err), (read.code, &read.err));
    built.ended(2);
}

#[test]
fn a_warning_of_the_derivation_is_told() {
    let folder = Folder::new("model-files-warned");
    let gallery = Gallery::shipped();
    let text = OTHER.replace("param k: Real;", "param k: Real;\n    param unused: Real;");
    let file = folder.write("beam.clebsch", &text);
    let derived = on(&gallery, &["derive", &file]);
    derived.says("warning");
    let run = on(
        &gallery,
        &["run", &file, "--case", "sample", "--steps", "10"],
    );
    assert_eq!((run.code, run.err), (0, derived.err));
}

#[test]
fn a_comparison_of_a_file_says_what_it_measures_against() {
    let folder = Folder::new("model-files-compared");
    let gallery = Gallery::shipped();
    let file = folder.write("beam.clebsch", OTHER);
    let out = folder.path("out");
    let done = on(
        &gallery,
        &[
            "compare", &file, "--case", "sample", "--steps", "40", "--out", &out,
        ],
    )
    .succeeds();
    let said = "this model has no hand-written equations; the reference is the interpreted stepper with steps";
    done.prints(said);
    done.prints("\ninterpreted ");
    let read = |name: &str| std::fs::read_to_string(format!("{out}/{name}")).expect(name);
    for text in [
        done.out.clone(),
        read("comparison.json"),
        read("comparison.svg"),
    ] {
        assert!(!text.contains("generated"), "{text}");
    }
    // Every curve has one legend.
    let svg = read("comparison.svg");
    let entries = svg.lines().filter(|line| line.trim() == "extrapolated");
    assert_eq!(entries.count(), 1, "{svg}");
}

#[test]
fn numbers_are_drawn_by_their_names() {
    let folder = Folder::new("model-files-numbers");
    let gallery = Gallery::shipped();
    let text = "model Pair { param k: Real; field a: Real; field b: Vec<2>; let u = next(a) - a; \
        let v = next(b) - b; lagrangian = (u*u + dot(v, v))/(2*h) - (h/2)*k*(a*a + dot(b, b)); }";
    let file = folder.write("pair.clebsch", text);
    let out = folder.path("out");
    on(
        &gallery,
        &[
            "run", &file, "--case", "sample", "--steps", "40", "--out", &out,
        ],
    )
    .succeeds();
    let plots = std::fs::read_dir(&out).expect("results");
    let plots = plots.filter_map(|entry| {
        let path = entry.ok()?.path();
        let drawn = path.extension().is_some_and(|end| end == "svg");
        drawn.then(|| std::fs::read_to_string(path).expect("a plot"))
    });
    let all = plots.collect::<String>();
    assert!(all.contains("b₁") && all.contains("b₂"), "{all}");
    assert!(!all.contains("a₁"), "{all}");
}

#[test]
fn a_long_line_is_quoted_around_the_mistake() {
    let folder = Folder::new("model-files-long");
    let gallery = Gallery::shipped();
    let terms: Vec<String> = (0..200).map(|i| format!("k*dot(x, x)/{}", i + 2)).collect();
    let text = |end: &str| {
        format!(
            "model Long {{ param k: Real; field x: Vec<3>; let d = next(x) - x; lagrangian = \
             dot(d, d)/(2*h) - h*({} + {end}); }}",
            terms.join(" + ")
        )
    };
    let file = folder.write("long.clebsch", text("k*dot(y, x)"));
    let done = on(&gallery, &["run", &file]).exits(2);
    let lines: Vec<&str> = done.err.lines().collect();
    let quoted = lines.iter().position(|line| line.starts_with("1 | ..."));
    let quoted = quoted.unwrap_or_else(|| panic!("{}", done.err));
    let (line, marks) = (lines[quoted], lines[quoted + 1]);
    assert!(line.chars().count() < 230, "{line}");
    // The mark is below the unknown name.
    let at = marks.chars().position(|c| c == '^').expect("a mark");
    assert_eq!(line.chars().nth(at), Some('y'), "{line}\n{marks}");
}

/// A field of diagonal matrices of a named size takes the steps of the one whose size is a number.
#[test]
fn diagonal_fields_of_a_named_size_take_the_same_steps() {
    let case = "model = \"axes\"\nh = 0.1\nsteps = 20\n[parameters]\nm = 1\n\
                B = [[1, 0.2, 0.3], [0.1, 1, 0.4], [0, 0.1, 0.2]]\n\
                [initial]\nD = [1, 0.5, -0.3]\nmomentum = [0.1, 0.2, 0.4]\n";
    let of = |declared: &str, size: &str, options: &str| {
        let text = format!(
            "model Axes {{ {declared} param m: Real; param B: Mat<{size}>; field D: Diag<{size}>;
             lagrangian = m*tr((next(D) - D)*(next(D) - D))/(2*h) - h*tr((D + next(D))*B*(D + next(D))*B)/4; }}"
        );
        let folder = Folder::new("diagonal-fields");
        run(&folder, &text, case, &format!("{options} --out @out")).succeeds();
        folder
            .samples("out/trajectory.csv")
            .rows
            .pop()
            .expect("rows")
    };
    let (named, number) = (of("dim n in 2..=3;", "n", "--dim 3"), of("", "3", ""));
    assert_eq!(named.len(), number.len());
    for (a, b) in named.iter().zip(&number) {
        // Twenty steps round differently.
        assert!((a - b).abs() < 1e-12, "{named:?} {number:?}");
    }
}

#[test]
fn the_line_of_the_solver_names_the_method_once() {
    let model = "model Coupled { param m, k, c: Real; field x, y: Real; let u = next(x) - x; let v = next(y) - y;
        lagrangian = (m*u^2 + m*v^2 + c*u*v)/(2*h) - h*k*(x^2 + y^2)/2; }";
    let case = "model = \"coupled\"\nh = 0.1\nsteps = 5\n[parameters]\nm = 1\nk = 1\nc = 0.1\n[initial]\nx = 1\ny = 0\n";
    run(&Folder::new("solver-line"), model, case, "--verbose")
        .succeeds()
        .prints("solver: one linear system, which the first correction of Newton's method solves;");
}
