//! Functionals of all sites: their derivations, their invariants, and rejected models.

use crate::line::Line;
use crate::pipeline::{derive_model, emitted_line, parse_source};

const KINETIC: &str = "m*dot(next(X) - X, next(X) - X)/(2*h)";

/// A model of particles with these statements, and with these terms added to the kinetic energy.
fn model(statements: &str, terms: &str) -> String {
    format!(
        "model Particles {{ label a in 0..N; param m: Real at a; param f, k: Real; field X: Vec<2> at a on torus(L);
         {statements} lagrangian = {KINETIC} {terms}; }}"
    )
}

fn line(text: &str) -> Line {
    match parse_source(text) {
        Ok(model) => match Line::of(&model) {
            Ok(line) => line,
            Err(refused) => panic!("{text}\n{refused:?}"),
        },
        Err(errors) => panic!("{text}\n{errors}"),
    }
}

fn totals(text: &str) -> Vec<String> {
    let all = line(text).totals.into_iter();
    all.map(|t| t.name).collect()
}

#[test]
fn a_total_momentum_is_found_where_nothing_singles_out_a_place() {
    let cells = "mesh A: Real at a = voronoi_area(X);";
    let kept = vec!["momentum".to_owned()];
    assert_eq!(totals(&model(cells, "- h*k*m/A")), kept);
    // On a rotating plane with the Coriolis term.
    let turning = "+ (m*f/2)*dot(perp(X), next(X)) - h*k*m*log(A)";
    assert_eq!(totals(&model(cells, turning)), kept);
    // A position outside the functional, as a factor or in a separate term, breaks the symmetry.
    let none: Vec<String> = Vec::new();
    assert_eq!(totals(&model(cells, "- h*k*m*X[1]/A")), none);
    let own = totals(&model(cells, "- h*k*m/A - h*m*dot(X, X)"));
    assert_eq!(own, none);
    // For user-defined functionals nothing is known, so that no invariant is stated.
    let path = "mesh A: Real at a = crate::area(X);";
    assert_eq!(totals(&model(path, "- h*k*m/A")), none);
}

#[test]
fn a_grid_keeps_no_momentum_and_a_field_beside_it_keeps_its_own() {
    let text = "model Mesh { label a in 0..N; grid n; param m: Real at a; param w: Real at n; param k: Real;
        field X: Real at a on box; field Y: Real at a; mesh H: Real at n = deposit(X, m);
        lagrangian = m*((next(X) - X)^2 + (next(Y) - Y)^2)/(2*h) - h*k*w*H^2; }";
    let all = totals(text);
    assert_eq!(all.len(), 1, "{all:?}");
    let found = &line(text).totals[0];
    let names: Vec<String> = found
        .densities
        .iter()
        .flat_map(|d| crate::expr::letters(&d.value))
        .map(|l| {
            line(text)
                .representative
                .d
                .letters
                .symbols
                .get(l.symbol)
                .name
                .clone()
        })
        .collect();
    // The momentum of Y, which does not occur in any functional.
    assert_eq!(names.len(), 1, "{names:?}");
}

#[test]
fn pull_backs_of_one_functional_are_computed_once() {
    let text = "model Mesh { label a in 0..N; grid n; param m: Real at a; param w: Real at n; param k, c: Real;
        field X: Vec<2> at a on box; mesh H: Real at n = deposit(X, m); mesh S: Real at n = smooth(H, c);
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*k*w*H*S - h*w*H^2; }";
    let meshed = line(text).meshed.expect("functionals");
    let [force] = meshed.forces.as_slice() else {
        panic!("one field is pushed");
    };
    let mut count = 0;
    count_backs(&force.value, &mut count);
    // One of the deposit, and in its seed one of the smoothing.
    assert_eq!(count, 2);
}

#[test]
fn momenta_that_walls_turn_are_not_listed_and_coupled_ones_are_refused() {
    let free = |domain: &str| {
        format!(
            "model Boxed {{ label a in 0..N; param m: Real at a; param k: Vec<2>; field X: Vec<2> at a {domain};
             field Z: Vec<2> at a; mesh A: Real at a = crate::waves(X, m, k);
             lagrangian = {KINETIC} + m*dot(next(Z) - Z, next(Z) - Z)/(2*h) - h*A; }}"
        )
    };
    let in_box = line(&free("on box"));
    for t in &in_box.totals {
        let letters = t
            .densities
            .iter()
            .flat_map(|d| crate::expr::letters(&d.value));
        for l in letters {
            let sited = in_box.representative.sited(l.symbol);
            let of = sited.as_ref().and_then(|at| at.momentum_of());
            assert_ne!(of, Some("X"), "{}", t.name);
        }
    }
    assert!(!in_box.totals.is_empty());
    let coupled = "model Coupled { label a in 0..N; grid n; param M: Sym<2>; param m: Real at a; param w: Real at n;
        field X: Vec<2> at a on box; mesh H: Real at n = deposit(X, m);
        lagrangian = dot(next(X) - X, M*(next(X) - X))/(2*h) - h*w*H^2; }";
    let model = parse_source(coupled).expect("a model");
    let told = emitted_line(&model, "")
        .map(|_| ())
        .expect_err("coupled")
        .to_string();
    assert!(told.contains("the kinetic energy couples"), "{told}");
}

#[test]
fn totals_of_two_sets_have_names_of_their_own() {
    let two = "model Two { label a in 0..N; label b in 0..M; param m: Real at a; param u: Real at b;
        field X: Vec<2> at a; field Z: Vec<2> at b;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + u*dot(next(Z) - Z, next(Z) - Z)/(2*h); }";
    let mut names = totals(two);
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count, "{names:?}");
}

fn count_backs(e: &crate::expr::Expr, count: &mut usize) {
    *count += usize::from(matches!(e.node(), crate::expr::Node::PullBack(..)));
    e.children().into_iter().for_each(|x| count_backs(x, count));
}

/// The error of the derivation or of emission, or `derived`.
fn outcome(statements: &str, terms: &str) -> String {
    let text = model(statements, terms);
    let read = parse_source(&text);
    let derived = read.and_then(|m| derive_model(&m).and_then(|_| emitted_line(&m, "")));
    match derived {
        Ok(_) => "derived".to_owned(),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn mistakes_in_functionals_are_told() {
    let area = "mesh A: Real at a = voronoi_area(X);";
    let cases = [
        (area, "- h*k/A", "derived"),
        (
            "mesh A: Real at a = voronoi_aera(X);",
            "- h*k/A",
            "did you mean `voronoi_area`?",
        ),
        (
            "mesh A: Real at a = voronoi_area(X, m);",
            "- h*k/A",
            "takes only a field",
        ),
        (
            "mesh A: Real at a = helmholtz_depth(X, m);",
            "- h*k/A",
            "a field and 2 parameters",
        ),
        (
            "mesh A: Real at a = voronoi_area(m);",
            "- h*k/A",
            "`m` is neither a field",
        ),
        (
            "mesh A: Real at a = voronoi_area(Q);",
            "- h*k/A",
            "`Q` is neither a field",
        ),
        (
            "mesh A: Real = voronoi_area(X);",
            "- h*k/A",
            "at which sites",
        ),
        (
            "mesh A: Vec<2> at a = voronoi_area(X);",
            "- h*k/A[1]",
            "one number at each site",
        ),
        (
            "mesh A: Real at b = voronoi_area(X);",
            "- h*k/A",
            "`b` is not a label",
        ),
        (
            "mesh A: Real at a = voronoi_area(2*X);",
            "- h*k/A",
            "the name of a field, a functional or a parameter",
        ),
        (
            "mesh B: Real at a = crate::f(A); mesh A: Real at a = voronoi_area(X);",
            "- h*k/A",
            "is neither a field",
        ),
        (
            "grid a; mesh A: Real at a = voronoi_area(X);",
            "- h*k/A",
            "declared twice",
        ),
        (
            area,
            "- k*dot(next(X) - X, next(X) - X)/A",
            "a functional of all sites and a velocity",
        ),
        (
            "field Y: Vec<2> at a on torus(M); mesh A: Real at a = voronoi_area(X);",
            "+ m*dot(next(Y) - Y, next(Y) - Y)/h - h*k/A",
            "a second field is declared in a domain",
        ),
        (
            "grid n; param w: Real at n; mesh H: Real at n = deposit(X, m);",
            "- h*w*H*m",
            "the sites to combine are ambiguous",
        ),
        (
            "param e: Real; mesh A: Real at a = helmholtz_depth(X, e, m);",
            "- h*k/A",
            "this argument is the masses",
        ),
        (
            "param e: Real; mesh A: Real at a = helmholtz_depth(X, m, h);",
            "- h*k/A",
            "`h` is not a parameter",
        ),
        (
            "param e: Real; mesh A: Real at a = helmholtz_depth(X, m, z);",
            "- h*k/A",
            "`z` is not a parameter",
        ),
        (
            "grid n; mesh A: Real at n = voronoi_area(X);",
            "- h*k",
            "its values at the particles",
        ),
        (
            "mesh A: Real at a = deposit(X, m);",
            "- h*k/A",
            "its values at the nodes of a grid",
        ),
        (
            "grid n; mesh A: Real at a = voronoi_area(X); mesh S: Real at n = smooth(A, k);",
            "- h*k/A",
            "is not declared at the nodes",
        ),
        (
            "grid n; param w: Real at n; mesh H: Real at n = deposit(X, w);",
            "- h*w*H",
            "this argument is the masses",
        ),
        (
            "field Z: Vec<3> at a; mesh A: Real at a = voronoi_area(Z);",
            "- h*k/A",
            "the positions `Z` have no domain",
        ),
        (
            "mesh A: Real at a = voronoi_area(X); hold u: A = m;",
            "- h*k/A",
            "a `hold` constraint cannot contain a functional",
        ),
        (
            "param L: Vec<2>; mesh A: Real at a = voronoi_area(X);",
            "- h*k/A",
            "`L` is declared twice",
        ),
        (
            "grid n; grid l; mesh A: Real at a = voronoi_area(X);",
            "- h*k/A",
            "a model can have only one grid",
        ),
        ("", "- h*k*m", "`X` has a domain, but no functional uses it"),
        (
            "mesh A: Real at a = voronoi_area(X); mesh B: Real at a = second_moment(X);",
            "- h*k/A",
            "no term of the Lagrangian contains `B`",
        ),
        (
            "label i in 0..K; field q: Real at nodes; mesh A: Real at a = voronoi_area(X);",
            "- h*k/A + k*(next(q) - q)^2/h",
            "this model has a chain",
        ),
        ("mesh A: Real at a = voronoi_area(X) of;", "", "expected"),
    ];
    for (statements, terms, expected) in cases {
        let found = outcome(statements, terms);
        assert!(found.contains(expected), "{statements} {terms}\n{found}");
    }
    let without = "model P { label a in 0..N; param m, k: Real; field X: Vec<2> at a;
        mesh A: Real at a = voronoi_area(X); lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*k/A; }";
    let model = parse_source(without).expect("a model");
    let told = emitted_line(&model, "")
        .map(|_| ())
        .expect_err("no domain")
        .to_string();
    assert!(told.contains("the positions `X` have no domain"), "{told}");
    for domain in ["on tours(L)", "on torus", "on torus(2)", "on sphere"] {
        let text = without.replace("Vec<2> at a;", &format!("Vec<2> at a {domain};"));
        let told = parse_source(&text).expect_err("no such domain").to_string();
        assert!(
            told.contains("torus(L)") || told.contains("the side lengths of the torus"),
            "{domain}: {told}"
        );
    }
}
