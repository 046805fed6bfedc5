//! Named cases next to model files: clebsch finds them by name, prints and suggests them. All shipped cases run, and
//! two of them agree with other implementations and closed forms.

use crate::common::{Folder, clebsch, runs};
use std::fs;
use std::path::{Path, PathBuf};

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")
}

fn model(name: &str) -> String {
    let path = models().join(format!("{name}.clebsch"));
    path.to_string_lossy().into_owned()
}

/// Model files with the names of the cases in the folders next to them.
fn shipped() -> Vec<(String, Vec<String>)> {
    let mut all = Vec::new();
    for kind in ["elastic", "fluids", "lattices"] {
        for entry in fs::read_dir(models().join(kind))
            .expect("a folder")
            .flatten()
        {
            let path = entry.path();
            if !path.is_dir() {
                continue;
            }
            let files = fs::read_dir(&path).expect("a folder").flatten();
            let mut names: Vec<String> = files
                .map(|e| {
                    e.path()
                        .file_stem()
                        .expect("a name")
                        .to_string_lossy()
                        .into_owned()
                })
                .collect();
            names.sort();
            let file = path.with_extension("clebsch");
            assert!(file.is_file(), "{}", file.display());
            all.push((file.to_string_lossy().into_owned(), names));
        }
    }
    all.sort();
    all
}

/// Long, since every shipped model with named cases is derived, and each case is run.
#[test]
fn every_shipped_case_runs_by_its_name() {
    let all = shipped();
    let count: usize = all.iter().map(|(_, names)| names.len()).sum();
    assert!(count >= 14, "{all:?}");
    for (model, names) in all {
        for name in names {
            let done = runs(&format!("run {model} --case {name} --steps 2"));
            let told = format!("case {name}: ");
            done.prints(&told);
        }
    }
    for name in [
        "fluids/particle-mesh-2d-over-ground",
        "lattices/hanging-chain",
    ] {
        runs(&format!("derive {}", model(name)));
    }
    // A case with the name of its model is selected by this name.
    runs(&format!(
        "run {} --case swing --steps 2",
        model("lattices/hanging-chain")
    ))
    .prints("constraint_lambda");
}

#[test]
fn a_case_is_printed_and_a_wrong_name_told() {
    let own = model("fluids/shallow-water-2d-regularised");
    let done = runs(&format!("case {own} --case bickley-jet"));
    let file = models().join("fluids/shallow-water-2d-regularised/bickley-jet.toml");
    assert_eq!(done.out, fs::read_to_string(file).expect("is shipped"));
    for (name, told) in [
        ("bickley-jets", "did you mean `bickley-jet`?"),
        ("xyz", "known: shear, bickley-jet, geostrophic-vortex, "),
    ] {
        clebsch(&format!("run {own} --case {name}")).refuses(told);
    }
    // Without any case next to the model, the only valid name is `sample`.
    let folder = Folder::new("cases-alone");
    let text = fs::read_to_string(model("elastic/neo-hooke")).expect("is shipped");
    folder.write("alone.clebsch", &text);
    folder.runs("run @alone.clebsch --case sample --steps 2");
    folder.clebsch("run @alone.clebsch --case other").ended(2);
}

/// Columns of the trajectory of a case by the beginnings of their names.
fn trajectory(name: &str, case: &str, steps: &str, wanted: &str) -> Vec<Vec<f64>> {
    let folder = Folder::new(&format!("cases-{case}"));
    folder.runs(&format!(
        "run {} --case {case} --steps {steps} --csv --out @out",
        model(name)
    ));
    let samples = folder.samples("out/trajectory.csv");
    samples.only(|name| name.starts_with(wanted))
}

/// Singular values of the placement at nodes 10 and 50, from another implementation of the same scheme; compared by
/// the sum of their squares and by their product, the determinant.
#[test]
fn the_data_of_the_figures_give_the_stretches_of_the_reference_run() {
    let rows = trajectory("elastic/mooney-rivlin", "thesis-figures", "1000", "Q_");
    let determinant = |q: &[f64]| {
        q[0] * (q[4] * q[8] - q[5] * q[7]) - q[1] * (q[3] * q[8] - q[5] * q[6])
            + q[2] * (q[3] * q[7] - q[4] * q[6])
    };
    for (node, stretches) in [
        (
            10,
            [1.226539590135073, 0.9357611651938557, 0.7393750419258576],
        ),
        (
            50,
            [1.140689429138439, 0.8964305035068983, 0.7774157151281648],
        ),
    ] {
        let squares: f64 = rows[node].iter().map(|x| x * x).sum();
        let wanted: f64 = stretches.iter().map(|x| x * x).sum();
        // Fifty steps of rounding, which they enlarge about a thousandfold.
        assert!(
            (squares - wanted).abs() < 1e-12,
            "{node}: {squares} {wanted}"
        );
        let wanted: f64 = stretches.iter().product();
        assert!((determinant(&rows[node]) - wanted).abs() < 1e-12, "{node}");
    }
    for q in &rows {
        assert!(
            (0.753..1.022).contains(&determinant(q)),
            "{}",
            determinant(q)
        );
    }
}

/// Solitons with parameters κ₁ > κ₂ are displaced by their encounter: the first by -log(A)/(2 κ₁) forwards and
/// the second by -log(A)/(2 κ₂) backwards. √A is the quotient of sinh((κ₁ - κ₂)/2) and sinh((κ₁ + κ₂)/2).
#[test]
fn solitons_are_displaced_by_their_encounter() {
    let rows = trajectory("lattices/toda-chain", "two-solitons", "1600", "momentum_q_");
    let (fast, slow) = (1.5_f64, 0.5_f64);
    let root = ((fast - slow) / 2.0).sinh() / ((fast + slow) / 2.0).sinh();
    let shift = -2.0 * root.ln();
    // The maximum of a soliton near a position, interpolated between sites by the parabola through three logarithms.
    let top = |row: &[f64], near: f64| {
        let near = near.round() as isize;
        let at = |site: isize| row[site.rem_euclid(128) as usize];
        let highest = (near - 4..=near + 4).max_by(|a, b| at(*a).total_cmp(&at(*b)));
        let highest = highest.expect("there are nine");
        let [a, b, c] = [-1, 0, 1].map(|by| at(highest + by).ln());
        highest as f64 + (a - c) / (2.0 * (a - 2.0 * b + c)) - 0.5
    };
    let (before, after) = (&rows[0], rows.last().expect("rows"));
    for (kappa, from, moved) in [
        (fast, 20.0, shift / (2.0 * fast)),
        (slow, 40.0, -shift / (2.0 * slow)),
    ] {
        // A single soliton moves by this distance, at sinh(κ)/κ sites per unit of time.
        let run = 80.0 * kappa.sinh() / kappa;
        // The slow one starts behind the fast one's influence.
        let start = top(before, from);
        let found = top(after, from + run) - start - run;
        // The step size of 0.05 increases the speed by parts in 1000, over 120 sites; positions are known to a
        // hundredth of a site.
        assert!((found - moved).abs() < 0.1, "{kappa}: {found} {moved}");
    }
}

/// The largest absolute difference between the first column of a row and `at` of its index.
fn wandered(rows: &[Vec<f64>], at: impl Fn(usize) -> f64) -> f64 {
    let rows = rows.iter().enumerate();
    let off = rows.map(|(k, row)| (row[0] - at(k)).abs());
    off.fold(0.0, |most: f64, x| if x > most { x } else { most })
}

/// The slowest mode of a beam on two supports oscillates with the frequency of Timoshenko's theory, and a cantilever
/// in the shape of beam theory stays in it: up to the square of the length of a section, which is 1/40.
#[test]
fn beams_swing_and_rest_as_beam_theory_has_it() {
    let rod = "lattices/geometrically-exact-rod";
    let rows = trajectory(rod, "supported-beam", "694", "phi_20_1");
    // The smaller root of 0.01 w^4 - (k^2 + 100 + k^2) w^2 + 100 k^4 = 0, k = pi, over a period.
    let k = std::f64::consts::PI;
    let b = 2.0 * k * k + 100.0;
    let square = (b - (b * b - 4.0 * k.powi(4)).sqrt()) / 0.02;
    let swings = |k: usize| 1e-3 * (square.sqrt() * 1e-3 * k as f64).cos();
    let off = wandered(&rows, swings);
    assert!(off < 1e-5, "{off:e}");
    // One that only bends is a quarter of a period ahead by then.
    let bends = wandered(&rows, |n| 1e-3 * (k * k * 1e-3 * n as f64).cos());
    assert!(bends > 3e-4, "{bends:e}");
    let rows = trajectory(rod, "resting-cantilever", "1000", "phi_40_1");
    let off = wandered(&rows, |_| -(0.1 / 16.0 + 0.1 / 1000.0));
    assert!(off < 3e-3 * 6.35e-3, "{off:e}");
}
