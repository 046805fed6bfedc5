//! Models with labels on the command line: they are derived, and run from cases with site data. Errors
//! in cases name the line and the site.

use crate::common::{Folder, clebsch, has, models, runs, text_of};

/// The model files that the project ships, each with its case.
const SHIPPED: [&str; 11] = [
    "circular-rod",
    "coupled-body-chain",
    "coupled-tops",
    "geometrically-exact-rod",
    "hanging-chain",
    "kirchhoff-rod",
    "quaternion-rod",
    "shallow-water-1d",
    "sine-gordon",
    "toda-chain",
    "uniform-tension-rod",
];

/// If parameters give an invalid inertia, the message names these parameters with line, site and expression.
/// This holds for a short chain, which is expanded site by site, and for a program with loops over sites.
#[test]
fn an_inertia_at_a_site_is_told_by_the_parameters_that_make_it() {
    let folder = Folder::new("inertia-at-a-site");
    let short = text_of("lattices/quaternion-rod.toml").replace("i = 16", "i = 4");
    let (before, rest) = short.split_once("m = [").expect("masses");
    let (_, after) = rest.split_once("]\n").expect("their end");
    let short = format!("{before}m = \"s*(1 + 0*i)\"\n{after}");
    let long = text_of("lattices/kirchhoff-rod.toml");
    let told = |model: &str, case: &str| {
        let case = folder.write("case.toml", case);
        let done = clebsch(&format!(
            "run models/lattices/{model}.clebsch --case {case} --steps 3"
        ))
        .exits(2);
        done.err
    };
    let line = |text: &str, key: &str| {
        let at = text.lines().position(|line| line.starts_with(key));
        at.expect("is given") + 1
    };
    for (model, case, own) in [
        ("quaternion-rod", &short, "I"),
        ("kirchhoff-rod", &long, "J"),
    ] {
        let key = format!("{own} = ");
        let given = case
            .lines()
            .find(|line| line.starts_with(&key))
            .expect("given");
        let by = given.replacen("0.001", "\"0.001 - 0.0004*i\"", 1);
        let falling = case.replace(given, &by);
        let err = told(model, &falling);
        let words = format!("case.toml:{}: parameters.s = ", line(&falling, &key));
        assert!(err.contains(&words), "{err}");
        let words = format!(" at i = 3 (given by `0.001 - 0.0004*i`) make s {own}₃: ");
        assert!(err.contains(&words) && !err.contains("initial."), "{err}");

        let spacing = case
            .lines()
            .find(|line| line.starts_with("s = "))
            .expect("given");
        let negative = case.replace(spacing, "s = -0.0625");
        let err = told(model, &negative);
        let at = line(&negative, "s = ");
        let words = format!("case.toml:{at}: parameters.s = -0.0625 and parameters.{own} = ");
        assert!(
            err.contains(&words) && err.contains(" at i = 0 make s "),
            "{err}"
        );
    }
}

/// Long, since each of eleven models is derived in four formats and is run from three cases.
#[test]
fn every_model_is_derived_and_runs_its_case() {
    for name in SHIPPED {
        let model = models(&format!("lattices/{name}.clebsch"));
        for format in ["text", "latex", "markdown", "json"] {
            runs(&format!(
                "derive models/lattices/{name}.clebsch --format {format}"
            ))
            .prints("Invariants");
        }
        let done = runs(&format!(
            "run models/lattices/{name}.clebsch --case models/lattices/{name}.toml --steps 200 --verbose"
        ));
        done.prints("lattice              N = ");
        // The printed case can be read, and so can the printed case for every other end condition.
        let folder = Folder::new(&format!("lattices-{name}"));
        let sample = runs(&format!("case models/lattices/{name}.clebsch"));
        let own = folder.write("own.toml", &sample.out);
        let run = [
            "run",
            &model,
            "--steps",
            "20",
            "--stability-limit",
            "0",
            "--case",
        ];
        let done = clebsch(&[&run[..], &[&own]].concat());
        // Sample attitudes form a straight rod, whose ends cannot approach each other. The message says what to
        // give.
        if text_of(&format!("lattices/{name}.clebsch")).contains("sum(") {
            done.ended(2);
            done.says("violates the constraint");
            sample.prints("must satisfy the constraints");
            let done =
                clebsch(&format!("run models/lattices/{name}.clebsch --case sample")).exits(2);
            let way = "save them with `clebsch case ";
            done.says(way);
            continue;
        }
        done.ended(0);
        let same = clebsch(&[&run[..], &["sample"]].concat());
        assert_eq!((done.out, done.err), (same.out, same.err), "{name}");
    }
}

/// Long, since rods are derived with their ends.
#[test]
fn ranges_and_ends_are_printed() {
    let rod = clebsch("derive models/lattices/geometrically-exact-rod.clebsch").out;
    has(
        &rod,
        [
            "∑_{i=0}^{N-2} h tr(B (Λ_{i,k}ᵀ Λ_{i+1,k} - Id))/s",
            "End i = 0: clamped",
            "End i = N: load",
            "i = 1, ..., N-2.",
            "∑_{i=0}^{N-1} Λ_{i,k} μ_{2,i,k}",
            "fluxes between neighbouring sites",
        ],
    );
    let toda = clebsch("derive models/lattices/toda-chain.clebsch").out;
    has(
        &toda,
        [
            "q_{i+N} = q_{i} + L",
            "indices modulo N",
            "∑_{i=0}^{N-1} p_{i,k}",
        ],
    );
}

#[test]
fn a_wrong_case_is_told_by_line_and_site() {
    let folder = Folder::new("lattices-wrong");
    let case = text_of("lattices/toda-chain.toml");
    let changes = [
        ("i = 32\n", "i = 0\n", ":10: labels.i"),
        ("i = 32\n", "j = 32\n", "the model has no label `j`"),
        (
            "\"periodic\"",
            "\"held\"",
            ":13: ends.i: the model has no end condition `held`",
        ),
        (
            "m = 1.0",
            "m = \"x\"",
            ":16: parameters.m: \"x\": `x` has no value here",
        ),
        (
            "m = 1.0",
            "mass = 1.0",
            "unknown key `mass` in [parameters]",
        ),
        (
            "q = \"log",
            "q = [1.0, 2.0] #",
            ":22: initial.q: a list needs one value for each of the 32 sites; this list has 2",
        ),
        (
            "q = \"log",
            &format!("q = [{}nan, 1.0] #", "1.0, ".repeat(30)),
            ":22: initial.q: at i = 30, NaN is not a finite number",
        ),
        ("q = \"log", "q = \"sqrt(5.5 - i)\" #", "initial.q_6: NaN"),
        ("q = \"log", "q = \"1/(i - 7)\" #", ":22: initial.q_7: inf"),
        (
            "momentum_q =",
            "momenta_q =",
            "unknown key `momenta_q` in [initial]; did you mean `momentum_q`?",
        ),
    ];
    for (from, to, expected) in changes {
        let wrong = case.replacen(from, to, 1);
        assert_ne!(wrong, case, "{from}");
        let file = folder.write("wrong.toml", &wrong);
        clebsch(&format!(
            "run models/lattices/toda-chain.clebsch --case {file}"
        ))
        .refuses(expected);
    }
    let file = folder.write("none.toml", case.replace("[labels]\ni = 32\n", ""));
    clebsch(&format!(
        "run models/lattices/toda-chain.clebsch --case {file}"
    ))
    .says("missing table [labels]");
}

#[test]
fn lists_and_expressions_say_the_same() {
    let folder = Folder::new("lattices-lists");
    let base = text_of("lattices/toda-chain.toml").replace("i = 32", "i = 3");
    let (head, _) = base.split_once("[initial]").expect("has values");
    let by_list =
        format!("{head}[initial]\nq = [0.0, 0.5, \"2/4 + 0.5\"]\nmomentum_q = [0.1, 0.2, 0.3]\n");
    let by_text = format!("{head}[initial]\nq = \"i/2\"\nmomentum_q = \"(i + 1)/10\"\n");
    let run = |text: &str| {
        folder.write("case.toml", text);
        folder.clebsch("run models/lattices/toda-chain.clebsch --case @case.toml --steps 50")
    };
    let (a, b) = (run(&by_list), run(&by_text));
    a.ended(0);
    // 3/10 of the expression and 0.3 of the list are one number here.
    assert_eq!(a.out, b.out);
}

#[test]
fn arrays_are_by_sample_site_and_component_and_plots_are_maps() {
    let folder = Folder::new("lattices-written");
    folder.runs("run models/lattices/geometrically-exact-rod.clebsch --case models/lattices/geometrically-exact-rod.toml --steps 10 --out @out");
    let npz = folder.bytes("out/trajectory.npz");
    let has = |shape: &str| npz.windows(shape.len()).any(|w| w == shape.as_bytes());
    // The first of the 17 nodes is clamped; segments are 16.
    for shape in ["(11, 16, 3,)", "(11, 16, 3, 3,)", "sites_of_phi.npy"] {
        assert!(has(shape), "{shape}");
    }
    let map = folder.read("out/fields.svg");
    assert!(map.contains("site i") && map.contains("change since the start"));
}

#[test]
fn lists_hold_what_is_given_at_an_end_too() {
    let folder = Folder::new("lattices-given");
    let case = text_of("lattices/sine-gordon.toml");
    let (head, _) = case.split_once("[initial]").expect("has values");
    let head = head.replace("i = 80", "i = 3");
    let run = |values: &str| {
        let file = folder.write("case.toml", format!("{head}[initial]\n{values}\n"));
        clebsch(&format!(
            "run models/lattices/sine-gordon.clebsch --case {file} --steps 5"
        ))
    };
    let by_list = run("u = [0.0, 0.1, 0.2, 0.3]\nmomentum_u = [0.0, 0.1, 0.2, 0.0]");
    by_list.ended(0).says_nothing();
    // A site with a prescribed value does not have a momentum.
    let moving = run("u = [0.0, 0.1, 0.2, 0.3]\nmomentum_u = [0.1, 0.2]");
    assert_eq!(by_list.out, moving.out);
    run("u = \"i/10\"\nmomentum_u = [0.0, 0.1, 0.2, 0.0]").succeeds();
    run("u = [0.0, 0.1, 0.2]\nmomentum_u = 0.0").says("for each of the 4 sites; this list has 3");
    // One moving site, no moving site, and too many sites.
    let one = |from: &str, to: &str, expected: &str| {
        let text = text_of("lattices/toda-chain.toml")
            .replace("i = 32", from)
            .replace("\"periodic\"", to);
        let file = folder.write("one.toml", &text);
        let done = clebsch(&format!(
            "run models/lattices/toda-chain.clebsch --case {file} --steps 5 --verbose"
        ));
        assert!(
            (done.out.clone() + &done.err).contains(expected),
            "{}{}",
            done.out,
            done.err
        );
        done.code
    };
    assert_eq!(one("i = 1", "\"periodic\"", "N = 1, periodic"), 0);
    let none = head.replace("i = 3", "i = 1") + "[initial]\nu = 0.1\nmomentum_u = 0.0\n";
    let file = folder.write("none.toml", &none);
    clebsch(&format!(
        "run models/lattices/sine-gordon.clebsch --case {file}"
    ))
    .refuses("nothing moves");
}

/// An error in a model is reported with its position in the model, not in the case.
#[test]
fn a_wrong_sum_is_told_in_the_model_where_a_case_is_given() {
    let folder = Folder::new("wrong-sum");
    let text = "model M {\n    label i in 0..N;\n    param m: Real;\n    param X: Real;\n    \
                field x: Real at nodes;\n    hold p: sum(sum(x)) = X;\n    \
                lagrangian = m*(next(x) - x)^2/(2*h);\n}\n";
    folder.write("m.clebsch", text);
    folder.write(
        "c.toml",
        "model = \"M\"\nname = \"c\"\nh = 0.1\nsteps = 2\n",
    );
    folder
        .clebsch("run @m.clebsch --case @c.toml")
        .refuses("contains another sum over sites")
        .says("m.clebsch:6:");
}
