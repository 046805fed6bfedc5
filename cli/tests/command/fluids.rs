//! Fluids on the command line: they are derived, and run from cases with domains, lattices and expressions in the
//! position. Errors in cases name the key and the site.

use crate::common::{Folder, clebsch, models, runs, table, text_of};

/// The model files that the project ships, each with its case.
const SHIPPED: [&str; 4] = [
    "particle-mesh-1d",
    "particle-mesh-2d",
    "shallow-water-2d",
    "shallow-water-2d-regularised",
];

/// Long, since every fluid is derived and run with its mesh.
#[test]
fn every_fluid_is_derived_and_runs_its_case() {
    for name in SHIPPED {
        let model = models(&format!("fluids/{name}.clebsch"));
        for format in ["text", "latex", "markdown", "json"] {
            runs(&format!(
                "derive models/fluids/{name}.clebsch --format {format}"
            ));
        }
        let done = runs(&format!(
            "run models/fluids/{name}.clebsch --case models/fluids/{name}.toml --steps 20"
        ));
        done.prints("energy");
        // The case that is printed for it runs.
        let folder = Folder::new(&format!("fluids-{name}"));
        let sample = runs(&format!("case models/fluids/{name}.clebsch"));
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
        let done = runs(&[&run[..], &[&own]].concat());
        let same = clebsch(&[&run[..], &["sample"]].concat());
        // The file names the source of its momenta.
        let of_file = |line: &&str| !line.starts_with("initial momentum_");
        let out: Vec<&str> = done.out.lines().filter(of_file).collect();
        let same_out: Vec<&str> = same.out.lines().collect();
        assert_eq!((out, done.err), (same_out, same.err), "{name}");
    }
}

#[test]
fn arrays_are_by_sample_particle_and_component_and_particles_are_mapped() {
    let folder = Folder::new("fluids-written");
    let out = folder.path("out");
    folder.runs("run models/fluids/particle-mesh-2d.clebsch --case models/fluids/particle-mesh-2d.toml --steps 4 --out @out");
    let npz = folder.bytes("out/trajectory.npz");
    let has = |shape: &str| npz.windows(shape.len()).any(|w| w == shape.as_bytes());
    // Nodes are one more than cells across the channel, and as many along it.
    for shape in ["(5, 1800, 2,)", "(5, 528,)", "momentum_X.npy", "H.npy"] {
        assert!(has(shape), "{shape}");
    }
    // Particles are not ordered along a chain, so these pictures are absent.
    for name in ["fields.svg", "momentum.svg"] {
        assert!(
            std::fs::metadata(format!("{out}/{name}")).is_err(),
            "{name}"
        );
    }
    let map = folder.read("out/particles.svg");
    let circles = map.matches("<circle").count();
    // Particles, twice.
    assert_eq!(circles, 2 * 1800, "{circles}");
    // The cells of nodes follow, with their edges; cells at the seam are on both sides.
    let cells = map.matches("<polygon").count();
    assert_eq!(cells, 2 * (528 + 33), "{cells}");
}

#[test]
fn velocities_and_momenta_say_the_same() {
    let folder = Folder::new("fluids-momenta");
    let case = text_of("fluids/shallow-water-2d.toml")
        .replace("f = 0.0", "f = 2.0")
        .replace("a = 400", "a = 64");
    let (head, _) = case.split_once("velocity_X").expect("has velocities");
    let run = |line: &str| {
        folder.write("case.toml", format!("{head}{line}\n"));
        let done =
            folder.runs("run models/fluids/shallow-water-2d.clebsch --case @case.toml --steps 5");
        done.out
    };
    // The momentum of a particle in a rotating frame is m v + (m f/2) perp(X).
    let by_velocity = run("velocity_X = [\"0.1*y\", \"0.2\"]");
    let by_momentum = run("momentum_X = [\"m*(0.1*y - f/2*y)\", \"m*(0.2 + f/2*x)\"]");
    let energy = |out: &str| -> String {
        let line = out
            .lines()
            .find(|l| l.trim_start().starts_with("energy"))
            .expect("has energy");
        line.split_whitespace()
            .take(2)
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(energy(&by_velocity), energy(&by_momentum));
}

/// A depth must be positive and an expression a number; if masses are given as numbers, clebsch warns about the
/// kinetic energy.
#[test]
fn masses_and_velocities_that_are_none_are_told() {
    let folder = Folder::new("fluids-masses");
    let run = |model: &str, key: &str, given: &str| {
        let case = text_of(&format!("fluids/{model}.toml"));
        let own = |line: &str| line.starts_with(&format!("{key} = "));
        let old = case.lines().find(|l| own(l)).expect("is given").to_owned();
        folder.write("own.toml", case.replace(&old, &format!("{key} = {given}")));
        folder.clebsch(&format!(
            "run models/fluids/{model}.clebsch --case @own.toml --steps 1"
        ))
    };
    for [model, key, given, said] in table(
        r#"
        particle-mesh-1d | m          | { depth = "-1" }                     | parameters.m: the depth at particle 0 is -1
        shallow-water-2d | m          | { depth = "a - 3", share = "cells" } | parameters.m: the depth at particle 0 is -3
        shallow-water-2d | velocity_X | ["x", "log(-1)"]                     | initial.velocity_X: "log(-1)": NaN at site 0 is not a finite number
"#,
    ) {
        let done = run(model, key, given);
        assert_ne!(done.code, 0, "{given}: {}", done.out);
        done.says(said);
    }
    for (model, count) in [("particle-mesh-1d", 256), ("shallow-water-2d", 800)] {
        let done = run(model, "m", "-1.0");
        let said = format!("is negative: it is negative in {count} of {count} independent");
        done.says(&said);
        run(model, "m", "0.01").never_says("kinetic energy");
    }
    // One of them.
    run("particle-mesh-1d", "m", "\"0.01*(a - 0.5)\"")
        .says("it is negative in 1 of 256 independent");
}

#[test]
fn a_wrong_case_is_told_by_key_and_site() {
    let folder = Folder::new("fluids-wrong");
    let check = |model: &str, changes: &[(&str, &str, &str)]| {
        let case = text_of(&format!("fluids/{model}.toml"));
        for (from, to, expected) in changes {
            let wrong = case.replacen(from, to, 1);
            assert_ne!(wrong, case, "{from}");
            folder.write("wrong.toml", &wrong);
            let done = folder.clebsch(&format!(
                "run models/fluids/{model}.clebsch --case @wrong.toml --steps 2"
            ));
            assert_ne!(done.code, 0, "{to}: {}{}", done.out, done.err);
            done.says(expected);
            done.never_says("panicked");
        }
    };
    check(
        "particle-mesh-2d",
        &[
            (
                "walls = [\"solid\", \"periodic\"]",
                "",
                "missing key `domain.walls`",
            ),
            (
                "\"periodic\"",
                "\"open\"",
                "domain.walls: expected \"solid\" or \"periodic\"",
            ),
            ("n = [32, 16]", "", "missing key `labels.n`"),
            (
                "n = [32, 16]",
                "n = 32",
                "labels.n: expected whole numbers of cells",
            ),
            (
                "lengths = [2.0, 1.0]",
                "lengths = [2.0]",
                "expected 2 positive numbers",
            ),
            ("[domain]", "[space]", "missing table [domain]"),
            ("alpha = 0.1", "", "missing key `parameters.alpha`"),
            (
                "alpha = 0.1",
                "alpha = -0.1",
                "parameters.alpha: the assumption `alpha >= 0` does not hold",
            ),
            (
                "velocity_X = [0.0, 0.0]",
                "speed_X = [0.0, 0.0]",
                "unknown key `speed_X` in [initial]",
            ),
            (
                "lattice = \"brick\"",
                "lattice = \"bricks\"",
                "the lattice \"bricks\" does not exist",
            ),
        ],
    );
    check(
        "shallow-water-2d",
        &[
            (
                "m = { depth = \"1\" }",
                "m = [1.0, 2.0]",
                "parameters.m: a list needs one value for each of the 400 sites; this list has 2",
            ),
            (
                "m = { depth = \"1\" }",
                "m = \"z\"",
                "parameters.m: \"z\": `z` has no value here",
            ),
            (
                "X = { lattice = \"brick\", jitter = 0.1, seed = 1 }",
                "X = [\"0.5\", \"0.5\"]",
                "at the same position",
            ),
            (
                "jitter = 0.1",
                "sweeps = 3",
                "sweeps: lattice = \"brick\" has no such key",
            ),
            (
                "X = { lattice = \"brick\", jitter = 0.1, seed = 1 }",
                "X = [\"0.01/(a - 7)\", \"a/N\"]",
                "initial.X: \"0.01/(a - 7)\": inf at site 7 is not a finite number",
            ),
            (
                "L = [1.0, 1.0]",
                "L = [1.0, 1.0]\nkind = \"channel\"",
                "which has no walls",
            ),
        ],
    );
}

#[test]
fn masses_are_depths_times_the_areas_of_cells() {
    let folder = Folder::new("fluids-shares");
    let text = text_of("fluids/shallow-water-2d.toml");
    let with = |share: &str| text.replace("{ depth = \"1\" }", share);
    folder.write("cells.toml", with("{ depth = \"2\", share = \"cells\" }"));
    folder
        .runs("run models/fluids/shallow-water-2d.clebsch --case @cells.toml --steps 1 --out @out");
    let json = folder.json("out/run.json");
    let masses: Vec<f64> = (0..400)
        .map(|a| {
            json["parameters"][format!("m_{a}")]
                .as_f64()
                .expect("a mass")
        })
        .collect();
    // Twice the area of the domain, in 400 parts that differ because of the jitter of the lattice.
    assert!((masses.iter().sum::<f64>() - 2.0).abs() < 1e-13);
    assert!(masses.iter().any(|m| (m - 0.005).abs() > 1e-4));
    let wrong = folder.write("wrong.toml", with("{ depth = \"2\", share = \"boxes\" }"));
    let done = clebsch(&format!(
        "run models/fluids/shallow-water-2d.clebsch --case {wrong} --steps 1"
    ))
    .exits(2);
    done.says("share: expected \"equal\" or \"cells\"");
    let case = text_of("fluids/particle-mesh-1d.toml");
    let case = case.replace(
        "-200*(x - 0.5)^2)\" }",
        "-200*(x - 0.5)^2)\", share = \"cells\" }",
    );
    let wrong = folder.write("grid.toml", &case);
    clebsch(&format!(
        "run models/fluids/particle-mesh-1d.clebsch --case {wrong} --steps 1"
    ))
    .refuses("share: Voronoi cells need particles");
}
