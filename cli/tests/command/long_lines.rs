//! Chains that run with loops over sites: any number of sites, with the same messages as for short chains.

use crate::common::{Folder, clebsch, text_of};

/// A case of a wave on a ring of Toda's points.
fn wave(count: usize) -> String {
    format!(
        "model = \"toda-chain\"\nname = \"wave\"\nh = 0.05\nsteps = 3\n[labels]\ni = {count}\n\
         [ends]\ni = \"periodic\"\n[parameters]\nm = 1.0\na = 1.0\nb = 1.0\nL = 0.0\n\
         [initial]\nq = \"0.3*sin(2*pi*i/N)\"\nmomentum_q = \"0.3*cos(4*pi*i/N)\"\n"
    )
}

/// Long because of the number of sites, whose plots and samples are written.
#[test]
fn a_line_of_a_hundred_thousand_sites_runs() {
    let folder = Folder::new("lattices-long");
    let out = folder.path("out");
    folder.write("wave.toml", wave(100_000));
    let done = folder
        .runs("run models/lattices/toda-chain.clebsch --case @wave.toml --out @out --verbose");
    done.prints([
        "lattice              N = 100000, periodic",
        "one for any number of sites, with loops over the sites\n",
        "action as stated: ",
        "total_momentum",
        "within bound",
    ]);
    let npz = folder.bytes("out/trajectory.npz");
    let has = |shape: &str| npz.windows(shape.len()).any(|w| w == shape.as_bytes());
    assert!(has("(4, 100000,)"));
    // A picture shows some of the sites.
    let map = std::fs::metadata(format!("{out}/fields.svg")).expect("is written");
    assert!(map.len() < 1_000_000, "{}", map.len());
}

#[test]
fn wrong_data_of_a_long_line_name_their_site() {
    let folder = Folder::new("lattices-long-wrong");
    let run = |from: &str, to: &str| {
        let case = wave(5_000);
        let wrong = case.replacen(from, to, 1);
        assert_ne!(wrong, case, "{from}");
        let file = folder.write("wrong.toml", &wrong);
        let done = clebsch(&format!(
            "run models/lattices/toda-chain.clebsch --case {file}"
        ));
        (done.code, done.err)
    };
    let (code, err) = run("q = \"0.3*sin(2*pi*i/N)\"", "q = \"1/(i - 37)\"");
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("initial.q_37: inf"), "{err}");
    let (code, err) = run("m = 1.0", "m = -0.0");
    assert!(
        code != 0 && err.contains("cannot take the first step"),
        "{err}"
    );
    assert!(err.contains("`q` at site 0"), "{err}");
    let (code, err) = run("q = \"0.3*sin(2*pi*i/N)\"", "q = [1.0, 2.0]");
    assert_eq!(code, 2);
    assert!(
        err.contains("for each of the 5000 sites; this list has 2"),
        "{err}"
    );
    let (code, err) = run("i = \"periodic\"", "i = \"held\"");
    assert_eq!(code, 2);
    assert!(
        err.contains("the model has no end condition `held`"),
        "{err}"
    );
    let folder = Folder::new("lattices-long-order");
    let file = folder.write("case.toml", wave(5_000));
    let of_order = |n: &str| {
        clebsch(&format!(
            "run models/lattices/toda-chain.clebsch --case {file} --order {n}"
        ))
    };
    let done = of_order("4").succeeds();
    done.prints("steps checked, largest residual");
    of_order("3").refuses("2, 4, 6, 8");
}

/// Momenta that are small compared with the rounding of the inertia divided by the step size, on a chain that solves for
/// its rotations together.
#[test]
fn bodies_that_hardly_turn_are_stepped_at_any_step() {
    let folder = Folder::new("hardly-turning");
    let case = text_of("lattices/coupled-body-chain.toml")
        .replace("i = 5", "i = 40")
        .replace("steps = 500", "steps = 10");
    let (head, _) = case
        .split_once("body_momentum_Lambda")
        .expect("has momenta");
    for h in ["1e-2", "1e-4", "1e-6"] {
        let case = format!("{head}body_momentum_Lambda = [1e-6, 2e-6, 3e-6]\n")
            .replace("h = 0.02", &format!("h = {h}"))
            .replace(
                "Lambda = [1.0, 0.0, 0.0, 0.0]",
                "Lambda = [\"cos(0.3*i)\", \"sin(0.3*i)\", 0.0, 0.0]",
            );
        assert!(case.contains("sin(0.3*i)") && case.contains(h));
        folder.write("case.toml", &case);
        folder
            .runs("run models/lattices/coupled-body-chain.clebsch --case @case.toml")
            .prints("within bound");
    }
}

/// A constraint on a sum over all sites brings the number of sites into combinations of momenta. The
/// combinations of the short chain that is derived are not invariants of a longer chain.
#[test]
fn totals_that_depend_on_the_number_of_sites_are_left_out() {
    let folder = Folder::new("lattices-sum-held");
    let text = "model D4 { label i in 0..N; param m: Real at nodes; param k: Real; param X: Vec<2>; field x: Vec<2> at nodes;
        hold p: sum(x) = X; let d = next(x) - x; let r = next(x, i) - x;
        lagrangian = m*dot(d, d)/(2*h) - h*k*dot(r, r)^2 - h*dot(x, x); }";
    folder.write("d4.clebsch", text);
    for sites in [4, 6, 12] {
        let case = format!(
            "model = \"d4\"\nh = 0.02\nsteps = 20\n[labels]\ni = {sites}\n[parameters]\nm = \"1 + 0.2*i\"\nk = 0.3\nX = [0, 0]\n\
             [initial]\nx = [\"i - N/2\", \"cos(2*pi*i/(N + 1))\"]\n"
        );
        let case = folder.write("case.toml", &case);
        folder
            .runs(&format!("run @d4.clebsch --case {case}"))
            .never_prints("joint_momentum");
    }
}
