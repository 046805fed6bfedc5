//! Chain models as programs: the shipped models, and models that are rejected.

use super::{Line, Refused, SiteSolve};
use crate::pipeline;

fn line(text: &str) -> Result<Line, Refused> {
    let model = pipeline::parse_source(text).map_err(Refused::Model)?;
    Line::of(&model)
}

fn shipped(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/lattices/");
    std::fs::read_to_string(format!("{folder}{name}.clebsch")).expect("a file")
}

#[test]
fn shipped_lattices_are_programs() {
    for (name, pulls, movers) in [
        ("toda-chain", 1, 1),
        ("sine-gordon", 1, 1),
        ("coupled-tops", 1, 1),
        ("geometrically-exact-rod", 2, 2),
        ("quaternion-rod", 2, 2),
        ("hanging-chain", 0, 1),
        // Terms between sections, and an end condition that exerts a force.
        ("kirchhoff-rod", 2, 2),
    ] {
        let line = match line(&shipped(name)) {
            Ok(line) => line,
            Err(refused) => panic!("{name}: {refused:?}"),
        };
        assert_eq!(line.pulls.len(), pulls, "{name}");
        let names: Vec<&str> = line.totals.iter().map(|t| t.name.as_str()).collect();
        println!("{name}: {names:?}");
        let all: usize = line.lone.iter().map(|l| l.movers.len()).sum();
        assert_eq!(all, movers, "{name}");
    }
}

#[test]
fn velocities_of_neighbours_are_found_together() {
    let text = "model Chain { label i in 0..N; periodic; param m, k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) + (k/h)*(next(q) - q)*(next(next(q, i)) - next(q, i)); }";
    match line(text) {
        Ok(line) => {
            assert_eq!((line.ties.len(), line.pulls.len()), (1, 0));
            assert!(matches!(
                line.lone[0].movers[0].how,
                SiteSolve::Newton { .. }
            ));
        }
        Err(refused) => panic!("{refused:?}"),
    }
}

#[test]
fn velocities_of_sites_that_are_no_neighbours_are_refused() {
    let text = "model Chain { label i in 0..N; param m, k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + (k/h)*(next(prev(q, i)) - prev(q, i))*(next(next(q, i)) - next(q, i)); }";
    let Err(Refused::Form(why)) = line(text) else {
        panic!("a program of velocities two sites apart");
    };
    assert!(why.contains("not neighbours"), "{why}");
}

#[test]
fn a_charge_at_a_site_is_one_system() {
    let text = "model Charges { label i in 0..N; param m, f, k: Real; field X: Vec<2> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (f/2)*dot(perp(X), next(X))
            - h*k*dot(next(X, i) - X, next(X, i) - X)/2; }";
    match line(text) {
        Ok(line) => assert!(matches!(
            line.lone[0].movers[0].how,
            SiteSolve::System { .. }
        )),
        Err(refused) => panic!("{refused:?}"),
    }
}

#[test]
fn what_is_held_reaches_its_site_and_the_next() {
    let rod = line(&shipped("kirchhoff-rod")).unwrap_or_else(|e| panic!("{e:?}"));
    let [held] = rod.holds.as_slice() else {
        panic!("one constraint");
    };
    assert_eq!((held.components, held.width, held.to), (3, 1, -1));
    let reached: Vec<(&str, usize)> = held
        .reaches
        .iter()
        .map(|r| (r.on.as_str(), r.site))
        .collect();
    assert_eq!(reached, [("φ", 0), ("φ", 1), ("Λ", 0)]);
    let multiple = |r: &super::Reach| matches!(r.columns, super::Matrix::Multiple(_));
    let multiples: Vec<bool> = held.reaches.iter().map(multiple).collect();
    assert_eq!(multiples, [true, true, false]);
}

/// A chain of quaternions with this kinetic energy and this coupling.
fn quaternions(kinetic: &str, coupling: &str) -> Result<Line, Refused> {
    line(&format!(
        "model Spins {{ label i in 0..N; periodic; param A, K: Sym<3>; param b, c: Real;
        group q: SU<2> at nodes velocity W; constraint next(q) = q*W;
        lagrangian = {kinetic} + h*{coupling};
        end i = 0 {{ free; held {{ param p: SU<2>; term h*c*re(p^T*q); }} }} }}"
    ))
}

const QUADRATIC: &str = "(2/h)*dot(im(W), A*im(W)) - (4*b/h)*re(W)";

#[test]
fn the_sign_of_a_quaternion_is_seen_by_real_parts() {
    let even = "dot(im(q^T*next(q, i)), K*im(q^T*next(q, i)))";
    for (coupling, seen) in [
        (even, false),
        ("c*re(q^T*next(q, i))", true),
        ("c*re(q^T*next(q, i))^2", false),
        ("dot(im(q), K*im(next(q, i)))", true),
        ("tr(K*rot(q)^T*rot(next(q, i)))", false),
    ] {
        let line = quaternions(QUADRATIC, coupling).unwrap_or_else(|e| panic!("{e:?}"));
        let [signs] = line.signs.as_slice() else {
            panic!("{coupling}: {:?}", line.signs);
        };
        assert_eq!((signs.of.as_str(), signs.seen), ("q", seen), "{coupling}");
        let [first, last] = &signs.walls;
        assert!(last.is_empty());
        let first: Vec<_> = first
            .iter()
            .map(|w| (w.parameter.as_str(), w.site))
            .collect();
        assert_eq!(first, [("p", 0)]);
    }
    let rod = line(&shipped("geometrically-exact-rod")).unwrap_or_else(|e| panic!("{e:?}"));
    assert!(rod.signs.is_empty());
}

#[test]
fn quaternions_with_another_kinetic_energy_are_refused() {
    let coupling = "c*re(q^T*next(q, i))";
    let told = quaternions("-(4*b/h)*re(W)^3", coupling).err();
    let Some(Refused::Form(why)) = told else {
        panic!("{told:?}");
    };
    assert!(why.contains("a quadratic form of im"), "{why}");
}

/// A chain of fields at nodes with this statement of a constraint; gives the reason for its rejection, empty if it is
/// accepted.
fn held(statement: &str) -> String {
    let text = format!(
        "model Beads {{ label i in 0..N; param m, a: Real; field X: Vec<2> at nodes; field Y: Mat<2> at nodes; {statement}
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + m*tr((next(Y) - Y)^T*(next(Y) - Y))/(2*h); }}"
    );
    match line(&text) {
        Err(Refused::Form(why)) => why,
        Ok(_) => String::new(),
        Err(other) => panic!("{other:?}"),
    }
}

#[test]
fn constraints_that_loops_do_not_take_are_refused_with_their_names() {
    assert_eq!(
        held("hold k: dot(next(X, i) - X, next(X, i) - X) = a^2;"),
        ""
    );
    assert_eq!(held("hold k: dot(X, X) = a^2;"), "");
    // Indices counted from the previous site.
    assert_eq!(
        held("hold k: dot(X - prev(X, i), X - prev(X, i)) = a^2;"),
        ""
    );
    assert_eq!(held("hold k: sum(m*X) = a*E1;"), "");
    assert_eq!(held("hold k: 2*sum(dot(X - prev(X, i), X)) = a;"), "");
    let far = "hold k: dot(next(next(X, i), i) - X, next(next(X, i), i) - X) = a^2;";
    for (statement, part) in [
        (far, "not neighbours"),
        (
            "hold k: dot(next(X, i), next(X, i)) = a^2;",
            "does not constrain its first site",
        ),
        (
            "hold k: dot(sum(X), sum(X)) = a;",
            "is not linear in the sums",
        ),
        (
            "hold k: sum(dot(X, X)) = sum(dot(next(X, i), X));",
            "over different ranges",
        ),
        (
            "hold k: sum(X) = a*E1; hold l: dot(X, X) = a;",
            "their multipliers must be solved together",
        ),
        ("hold k: det(Y) = 1;", "numbers, vectors and rotations"),
    ] {
        let why = held(statement);
        assert!(
            why.contains(part) && why.contains("`k`"),
            "{statement}: {why}"
        );
    }
}

/// Bodies with these terms of their own and these neighbour terms.
fn bodies(own: &str, neighbours: &str) -> Result<Line, Refused> {
    line(&format!(
        "model Bodies {{ label i in 0..N; periodic; param J, C: Sym<3>; param d, g: Vec<3>; param b, e, m: Real;
        field q: Real at nodes;
        group Λ: SO<3> at nodes velocity Ω; advected Γ: Vec<3> at nodes = Λ^T*g;
        constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h + m*(next(q) - q)^2/(2*h) {own} {neighbours}; }}"
    ))
}

#[test]
fn rotations_are_found_together_with_their_neighbours() {
    let dragged = "- (e/h)*dot((Ω - Id)*d, Λ^T*next(Λ, i)*(next(Ω, i) - Id)*d)";
    let sinking = "+ (e/h)*dot(next(Γ) - Γ, d)*(next(next(q, i)) - next(q, i))";
    let turned = "- h*dot(Γ, d) + h*tr(C*Λ^T*next(Λ, i))";
    for (neighbours, pulls) in [
        (dragged.to_owned(), 0),
        (sinking.to_owned(), 0),
        (format!("{dragged} {sinking}"), 0),
        (format!("{dragged} {turned}"), 1),
        (format!("{dragged} {sinking} {turned}"), 1),
    ] {
        match bodies("", &neighbours) {
            Ok(line) => {
                assert_eq!(
                    (line.ties.len(), line.pulls.len()),
                    (1, pulls),
                    "{neighbours}"
                );
                let mut movers = line.lone.iter().flat_map(|l| &l.movers);
                assert!(movers.any(|m| matches!(
                    m.how,
                    SiteSolve::Newton {
                        arriving: Some(_),
                        ..
                    }
                )));
                assert!(line.ties[0].inertia.is_some(), "{neighbours}");
                assert_eq!(crate::emit::refusal_of_line(&line), None);
            }
            Err(refused) => panic!("{neighbours}: {refused:?}"),
        }
    }
}

#[test]
fn rotations_whose_equation_is_another_are_found_by_newtons_method_at_their_site() {
    for own in [
        "+ b*tr(Id - Ω)^2/h^3",
        "+ (b/(2*h))*dot(next(Γ) - Γ, next(Γ) - Γ)",
        "- h*dot(g, (Λ + next(Λ))*d)/2",
        "- h*dot(g, (Λ + next(Λ))*d)^2/4",
    ] {
        match bodies(own, "+ h*tr(C*Λ^T*next(Λ, i))") {
            Ok(line) => {
                let mut movers = line.lone.iter().flat_map(|l| &l.movers);
                assert!(
                    movers.any(|m| matches!(
                        m.how,
                        SiteSolve::Newton {
                            arriving: Some(_),
                            ..
                        }
                    )),
                    "{own}"
                );
                assert_eq!(crate::emit::refusal_of_line(&line), None);
            }
            Err(refused) => panic!("{own}: {refused:?}"),
        }
    }
}

#[test]
fn loops_over_sites_keep_no_time() {
    for ends in [
        "",
        "end i = 0 { pinned { x = given; } free; } end i = N { pinned { x = given; } }",
    ] {
        let refused = line(&format!(
            "model M {{ label i in 0..N; param m, K: Real at nodes; param c, A, w: Real; field x: Real at nodes;
             advected τ: Real at nodes; constraint next(τ) = τ + h; let V = (next(x) - x)/h;
             lagrangian = h*m*V^2/2 - (h*c/2)*(next(x, i) - x)^2 - (h*K/2)*(x - A*sin(w*τ))^2; {ends} }}"
        ));
        let Err(Refused::Form(why)) = refused else {
            panic!("a clock is taken");
        };
        assert!(why.contains("advances with the step by itself"), "{why}");
    }
}

#[test]
fn what_no_definition_gives_is_refused_where_a_site_sees_it() {
    let fields =
        "field x: Real at nodes; advected y: Real at nodes; constraint next(y) = y + (next(x) - x);
        lagrangian = m*(next(x) - x)^2/(2*h) - h*m*y^2 - h*(next(x, i) - x)^2";
    let turned = "group Λ: SO<3> at nodes velocity Ω; constraint next(Λ) = Λ*Ω; param J: Sym<3>;
        advected y: Vec<3> at nodes; constraint next(y) = Ω^T*y;
        lagrangian = (1/h)*tr((Id - Ω)*((tr(J)/2)*Id - J)) - h*m*dot(y, E1) + h*tr(Λ^T*next(Λ, i))";
    for text in [fields, turned] {
        let refused = line(&format!(
            "model M {{ label i in 0..N; param m: Real at nodes; {text}; }}"
        ));
        let Err(Refused::Form(why)) = refused else {
            panic!("what is carried is taken");
        };
        assert!(
            why.contains("`y` has a constraint but no definition"),
            "{why}"
        );
    }
}

/// Beads in space connected by springs, with these end conditions.
fn strung(first: &str, last: &str) -> Line {
    let text = format!(
        "model Strung {{ label i in 0..N; param m, k, l: Real; field X: Vec<3> at nodes; let d = next(X, i) - X;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*(k/2)*(dot(d, d) - l)^2;
        end i = 0 {{ {first} }} end i = N {{ {last} }} }}"
    );
    line(&text).unwrap_or_else(|e| panic!("{e:?}"))
}

#[test]
fn totals_are_about_what_ends_hold() {
    let (free, both) = ("free;", "free; pinned { X = given; }");
    let of = |line: &Line| -> Vec<(String, Vec<[usize; 2]>, usize)> {
        let each = line.totals.iter().map(|t| {
            let left_out = t.densities.iter().map(|d| d.left_out).collect();
            (t.name.clone(), left_out, t.places.len())
        });
        each.collect()
    };
    let total =
        |name: &str, left_out: [usize; 2], places: usize| (name.to_owned(), vec![left_out], places);
    let of_free = [
        total("total_momentum", [0, 0], 0),
        total("total_momentum_angular", [0, 0], 0),
    ];
    assert_eq!(of(&strung(free, free)), of_free);
    let about = "total_momentum_angular_about_X";
    let first = [&of_free[..], &[total(about, [1, 0], 1)]].concat();
    assert_eq!(of(&strung(both, free)), first);
    let across = "joint_momentum_across_X_angular";
    let all = [
        &of_free[..],
        &[
            total(about, [0, 1], 1),
            total(about, [1, 0], 1),
            total(across, [1, 1], 2),
        ],
    ];
    assert_eq!(of(&strung(both, both)), all.concat());
}
