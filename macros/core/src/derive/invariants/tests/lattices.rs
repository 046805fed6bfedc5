//! Symmetries of chains: a configuration is moved at all sites, or at a single site. Each test has a statement that
//! breaks the symmetry.

use crate::derive::invariants::Family;
use crate::lattice::{ChainConfig, Lattice};
use crate::pipeline;

/// Names of the Noether momenta without their sites, each with the number of its occurrences.
fn momenta(text: &str, periodic: bool) -> Vec<(String, usize)> {
    let model = pipeline::parse_source(text).unwrap_or_else(|e| panic!("{e}"));
    let lattice = Lattice::read(&model).unwrap_or_else(|e| panic!("{e}"));
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = if periodic {
        choice.as_ring(&lattice)
    } else {
        choice
    };
    let derived = pipeline::derive_lattice(&model, &lattice, &choice);
    let (unfolded, d) = derived.unwrap_or_else(|e| panic!("{e}"));
    let mut out: Vec<(String, usize)> = Vec::new();
    for v in d.invariants.iter().filter(|v| v.family == Family::Noether) {
        let name = unfolded.plain(&v.name);
        match out.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => out.push((name, 1)),
        }
    }
    out
}

fn expect(text: &str, periodic: bool, whole: &[(&str, usize)]) {
    let whole: Vec<(String, usize)> = whole.iter().map(|(n, c)| ((*n).to_owned(), *c)).collect();
    assert_eq!(momenta(text, periodic), whole, "{text}");
}

/// Point masses in the plane connected by springs, stated by coordinates.
fn planar(more: &str) -> String {
    format!(
        "model Chain {{ label i in 0..N; periodic; param m, k, l: Real; field x: Real at nodes; field y: Real at nodes;
            let r = sqrt((next(x, i) - x)^2 + (next(y, i) - y)^2);
            lagrangian = m*((next(x) - x)^2 + (next(y) - y)^2)/(2*h) - (h*k/2)*(r - l)^2{more}; }}"
    )
}

/// Expects momenta that are each one sum over all sites.
fn sums(text: &str, periodic: bool, whole: &[&str]) {
    let whole: Vec<(&str, usize)> = whole.iter().map(|n| (*n, 1)).collect();
    expect(text, periodic, &whole);
}

#[test]
fn coordinates_of_a_chain_keep_their_momenta_each_and_that_of_turns() {
    let all = [
        "total momentum x",
        "total momentum y",
        "momentum angular x y",
    ];
    sums(&planar(""), false, &all);
    sums(&planar(""), true, &all);
    // Weight along y, and springs to a fixed point.
    sums(&planar(" - h*m*y"), false, &all[..1]);
    sums(&planar(" - h*k*(x^2 + 2*y^2)"), false, &[]);
    sums(&planar(" - h*k*(x^2 + y^2)"), false, &all[2..]);
}

#[test]
fn particles_of_shallow_water_keep_their_potential_vorticity_each() {
    let water = |more: &str| {
        format!(
            "model Water {{ label i in 0..N; periodic; param m: Real at nodes; param g, f: Real;
                field X: Real at nodes offset L; field Y: Real at nodes;
                let depth = 2*m/(next(X, i) - prev(X, i));
                lagrangian = m*((next(X) - X)^2 + (next(Y) - Y)^2)/(2*h)
                    + m*f*((X + next(X))/2)*(next(Y) - Y) - h*(g/2)*m*depth{more}; }}"
        )
    };
    expect(
        &water(""),
        true,
        &[("momentum Y", 5), ("total momentum X", 1)],
    );
    // Transverse springs between particles leave only the sums.
    let tied = water(" - h*g*(next(Y, i) - Y)^2");
    sums(&tied, true, &["total momentum Y", "total momentum X"]);
}

#[test]
fn what_every_site_keeps_may_be_one_component() {
    let text = |potential: &str| {
        format!(
            "model Sheet {{ label i in 0..N; param m, k: Real; field x: Vec<2> at nodes;
                lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*k*{potential}; }}"
        )
    };
    expect(
        &text("dot(next(x, i) - x, E1)^2"),
        false,
        &[("momentum x E2", 5), ("total momentum", 1)],
    );
    expect(
        &text("dot(next(x, i) - x, E1)^4*dot(x, E2)"),
        false,
        &[("total momentum E1", 1)],
    );
}

#[test]
fn a_chain_in_space_by_coordinates_turns_about_every_axis() {
    let text = "model Chain { label i in 0..N; param m, k, l: Real;
        field x: Real at nodes; field y: Real at nodes; field z: Real at nodes;
        let r = sqrt((next(x, i) - x)^2 + (next(y, i) - y)^2 + (next(z, i) - z)^2);
        lagrangian = m*((next(x) - x)^2 + (next(y) - y)^2 + (next(z) - z)^2)/(2*h) - (h*k/2)*(r - l)^2; }";
    sums(
        text,
        false,
        &[
            "total momentum x",
            "total momentum y",
            "total momentum z",
            "momentum angular x y",
            "momentum angular x z",
            "momentum angular y z",
        ],
    );
}

#[test]
fn bodies_listed_one_by_one_keep_the_momenta_of_their_coordinates_apart() {
    let masses = |n: usize, more: &str| {
        let fields: String = (0..n)
            .map(|i| format!("field x{i}: Real; field y{i}: Real; "))
            .collect();
        let kinetic: String = (0..n)
            .map(|i| format!(" + m*((next(x{i}) - x{i})^2 + (next(y{i}) - y{i})^2)/(2*h)"))
            .collect();
        let springs: String = (1..n)
            .map(|i| {
                let j = i - 1;
                format!(
                    " - h*k*((x{i} - x{j})^2 + (y{i} - y{j})^2 + (x{i} - x{j})^2*(y{i} - y{j})^2)"
                )
            })
            .collect();
        format!("model M {{ param m, k: Real; {fields} lagrangian = 0{kinetic}{springs}{more}; }}")
    };
    let names = |text: &str| {
        let d = super::derive(text);
        let own = d.invariants.iter().filter(|v| v.family == Family::Noether);
        own.map(|v| v.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(
        names(&masses(3, "")),
        ["total_momentum_x0_x1_x2", "total_momentum_y0_y1_y2"]
    );
    assert_eq!(
        names(&masses(3, " - h*k*y1^2")),
        ["total_momentum_x0_x1_x2"]
    );
}

/// An inextensible rod: positions at nodes, frames at segments, and the constraint that aligns each segment with its
/// frame.
fn rod(ends: &str, more: &str) -> String {
    format!(
        "model Rod {{ label i in 0..N step s; periodic; param m: Real at nodes; param J, B: Sym<3>; param g: Vec<3>;
            field x: Vec<3> at nodes offset X; group R: SO<3> at segments velocity O; constraint next(R) = R*O;
            hold n: next(x, i) - x = s*R*E3;
            let V = (next(x) - x)/h;
            lagrangian = h*m*dot(V, V)/2 - s*tr(J*O)/h + (h/s)*tr(B*R^T*next(R, i)){more}; {ends} }}"
    )
}

#[test]
fn forces_along_a_rod_leave_its_angular_momentum() {
    let places = "total momentum x";
    let free = ["total momentum x", "total momentum angular"];
    sums(&rod("", ""), false, &free);
    // A ring with an offset conserves the angular momentum about the offset.
    sums(&rod("", ""), true, &[places, "total momentum angular X"]);
    let weight = "+ h*m*dot(g, x)";
    let about = ["total momentum x across g", "total momentum angular g"];
    sums(&rod("", weight), false, &about);
    sums(&rod("", weight), true, &about[..1]);
    // Segments aligned by the inverse of their frame: only rotations of the frames about their axis remain.
    let against = rod("", "").replace("= s*R*E3", "= s*R^T*E3");
    sums(&against, false, &[places, "total momentum R E3"]);
}

#[test]
fn linear_constraints_leave_what_is_kept_at_sites() {
    let pairs = |more: &str| {
        format!(
            "model P {{ label a in 0..N; param m, k: Real; field x, y: Real at a; hold l: x = 2*y;
                lagrangian = m*((next(x) - x)^2 + (next(y) - y)^2)/(2*h){more}; }}"
        )
    };
    expect(&pairs(""), false, &[("joint momentum x y", 2)]);
    let line = pairs(" - h*k*(next(x, i) - x)^4").replace("label a", "label i");
    let line = line.replace("at a", "at nodes");
    sums(&line, false, &["joint momentum"]);
    let ladder = "model L { label i in 0..N; periodic; param m, k: Real; field u, v: Real at nodes; hold p: next(u, i) - u = v;
        lagrangian = m*((next(u) - u)^2 + (next(v) - v)^2)/(2*h) - h*k*(next(v, i) - v)^4; }";
    sums(ladder, false, &["total momentum u"]);
    sums(ladder, true, &["total momentum u"]);
}
