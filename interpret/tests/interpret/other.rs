//! Models outside the gallery, with groups, fields and functions that the gallery lacks. They are compiled here and
//! also run from their texts.

use crate::side_by_side::compare;
use clebsch::card::{Card, Settings};
use clebsch_models::Case;

clebsch::model! {
    /// Rigid motion of the plane on a slope, by Newton's method.
    pub model Sledge {
        param J: Sym<2>;
        param m: Real;
        param a, w: Vec<2>;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a);
    }
}

clebsch::model! {
    /// A point in front of a wall, which it must not reach.
    pub model Wall {
        param m: Real;
        param g: Real;
        field x: Real;
        lagrangian = m*(next(x) - x)^2/(2*h) + h*(log(x) - g*x);
    }
}

clebsch::model! {
    /// A kinetic energy that is not quadratic, convex.
    pub model Quartic {
        param m: Real;
        param b: Real;
        param k: Real;
        field X: Vec<2>;
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 - (h/2)*k*dot(X, X);
    }
}

clebsch::model! {
    /// A charge in a field that rotates with its position, solved by elimination with pivots, next to a point that
    /// Newton's method solves for.
    pub model Beside {
        param m: Real;
        param q: Real;
        param M: Real;
        param b: Real;
        param k: Real;
        field X: Vec<3>;
        field Y: Vec<2>;
        let d = next(X) - X;
        let e = next(Y) - Y;
        lagrangian = m*dot(d, d)/(2*h) + q*dot(cross(X[2]*E1 + X[3]*E2 + X[1]*E3, X), d) - (h/2)*k*dot(X, X)
            + M*dot(e, e)/(2*h) + (b/h^3)*dot(e, e)^2 - (h/2)*k*dot(Y, Y) - h*k*X[1]*Y[1];
    }
}

clebsch::model! {
    /// A body that hangs on a point that moves: two different groups, solved together.
    pub model Hanging {
        param J: Sym<3>;
        param m: Real;
        param M: Real;
        param a: Vec<3>;
        param g: Vec<3>;
        param k: Real;
        group R: SO<3> velocity W;
        field x: Vec<3>;
        constraint next(R) = R*W;
        let d = next(x) - x;
        let y = d + next(R)*a - R*a;
        lagrangian = -tr(J*W)/h + M*dot(d, d)/(2*h) + m*dot(y, y)/(2*h)
            - (h/2)*k*dot(x, x) + h*m*dot(g, x + R*a);
    }
}

clebsch::model! {
    /// Four frames in a row, three of the same kind, each coupled to the next.
    pub model Alike {
        param J, K: Sym<3>;
        param a, b: Vec<3>;
        param c: Real;
        group P: SO<3> velocity U;
        group Q: SO<3> velocity V;
        group R: SO<3> velocity W;
        group S: SO<3> velocity Y;
        constraint next(P) = P*U;
        constraint next(Q) = Q*V;
        constraint next(R) = R*W;
        constraint next(S) = S*Y;
        lagrangian = -tr(J*(U + V + Y))/h - tr(K*W)/h
            + h*c*(dot(P*a, Q*b) + dot(Q*a, R*b) + dot(R*a, S*b));
    }
}

clebsch::model! {
    /// Fractions that no binary number is, assumptions of every kind, and a field of nine components.
    pub model Nine {
        param k, c, e: Real;
        assume k < 9;
        assume c <= 1;
        assume c >= -1;
        assume e == 2;
        field X: Vec<9>;
        field y: Real;
        let d = next(X) - X;
        lagrangian = dot(d, d)/(2*h) + (next(y) - y)^2/(3*h)
            - h*(k*dot(X, X)/3 + 0.1*y^2 + c*y^3/7 + y^4/e + log(3 + y^2));
    }
}

clebsch::model! {
    /// Five coordinates that a step solves for together, not by a linear system.
    pub model Five {
        param m, b, k: Real;
        field X: Vec<5>;
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 - (h/2)*k*dot(X, X);
    }
}

clebsch::model! {
    /// A rotation of four dimensions and a field with four components, with coupled velocities: a step
    /// solves for ten coordinates together.
    pub model Ten {
        param J: Sym<4>;
        param m, c, k: Real;
        param a, g: Vec<4>;
        group R: SO<4> velocity W;
        field x: Vec<4>;
        constraint next(R) = R*W;
        let d = next(x) - x;
        let y = d + c*(next(R)*a - R*a);
        lagrangian = -tr(J*W)/h + m*dot(d, d)/(2*h) + m*dot(y, y)/(2*h) - (h/2)*k*dot(x, x) + h*dot(g, x);
    }
}

clebsch::model! {
    /// Twelve coordinates by one linear system, three bodies that share their kinetic energy.
    pub model Twelve {
        param m, c, k: Real;
        field x, y, z: Vec<4>;
        let u = next(x) - x;
        let v = next(y) - y;
        let w = next(z) - z;
        lagrangian = m*(dot(u, u) + dot(v, v) + dot(w, w))/(2*h) + c*(dot(u, v) + dot(v, w))/h
            - (h/2)*k*(dot(x, x) + dot(y, y) + dot(z, z)) + h*log(4 + dot(x, y));
    }
}

clebsch::model! {
    /// A rotation of the plane and a rotation of space, both in the space frame: the factor of the first is
    /// constant, the factor of the second is known at each node.
    pub model Turns {
        param j: Real;
        param J: Sym<3>;
        group S: SO<2> velocity X;
        group R: SO<3> velocity W;
        constraint next(S) = X*S;
        constraint next(R) = W*R;
        lagrangian = -j*tr(X)/h - tr(J*R^T*next(R))/h;
    }
}

fn case(h: f64, parameters: &[&[f64]], initial: &[&[f64]]) -> Case {
    let lists = |all: &[&[f64]]| all.iter().map(|list| list.to_vec()).collect();
    Case {
        name: "here".to_owned(),
        doc: String::new(),
        h,
        steps: 400,
        parameters: lists(parameters),
        initial: lists(initial),
        bounds: Vec::new(),
    }
}

/// Plain and composed steps, longer steps until they fail, and values that are not numbers.
fn both(built: &Card, case: &Case) {
    let read = clebsch_interpret::card(built.source).expect("is read");
    let made = compare(built, &read, case, Settings::step(case.h), case.steps);
    assert_eq!(made, case.steps, "{}", built.name);
    for order in [1, 2, 4, 6] {
        let settings = Settings::step(case.h).of_order(order);
        compare(built, &read, case, settings, 40);
    }
    for times in [10.0, 1e2, 1e4] {
        compare(built, &read, case, Settings::step(times * case.h), 60);
    }
    for i in 0..case.initial.len() {
        let mut other = case.clone();
        other.initial[i][0] = f64::NAN;
        compare(built, &read, &other, Settings::step(case.h), 2);
    }
}

const ONE: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn fractions_assumptions_and_long_fields() {
    let place = [0.3, -0.2, 0.1, 0.7, 0.5, -0.4, 0.9, 0.8, -0.6];
    let momentum = [0.1, 0.2, -0.3, 0.4, -0.5, 0.6, -0.7, 0.8, 0.9];
    let initial: [&[f64]; 4] = [&place, &momentum, &[0.4], &[-0.2]];
    both(
        &Nine::CARD,
        &case(0.05, &[&[1.3], &[0.3], &[2.0]], &initial),
    );
    // Both versions reject each violated assumption in the same way.
    let read = clebsch_interpret::card(Nine::CARD.source).expect("is read");
    for (k, c, e) in [
        (9.0, 0.3, 2.0),
        (1.0, 1.5, 2.0),
        (1.0, -1.5, 2.0),
        (1.0, 0.3, 2.1),
    ] {
        let wrong = case(0.05, &[&[k], &[c], &[e]], &initial);
        assert_eq!(
            compare(&Nine::CARD, &read, &wrong, Settings::step(0.05), 2),
            0
        );
    }
}

#[test]
fn motions_of_the_plane() {
    let parameters: [&[f64]; 4] = [&[0.4, 0.1, 0.1, 0.7], &[1.3], &[0.2, -0.1], &[0.3, 1.1]];
    both(
        &Sledge::CARD,
        &case(0.05, &parameters, &[&ONE, &[0.4, 0.2, -0.3]]),
    );
}

#[test]
fn domains_of_functions() {
    let parameters: [&[f64]; 2] = [&[1.0], &[0.5]];
    both(&Wall::CARD, &case(0.02, &parameters, &[&[1.0], &[0.4]]));
    // Into the wall.
    let read = clebsch_interpret::card(Wall::CARD.source).expect("is read");
    for momentum in [-3.0, -30.0, -300.0] {
        let fast = case(0.1, &parameters, &[&[1.0], &[momentum]]);
        compare(&Wall::CARD, &read, &fast, Settings::step(0.1), 100);
    }
}

#[test]
fn energies_that_are_not_quadratic() {
    let parameters: [&[f64]; 3] = [&[1.0], &[0.3], &[2.0]];
    both(
        &Quartic::CARD,
        &case(0.05, &parameters, &[&[1.0, 0.2], &[0.1, 0.9]]),
    );
}

/// Decisions before Newton's method vary: if a tape does not apply, the search is unchanged.
#[test]
fn decisions_before_the_iteration() {
    let parameters: [&[f64]; 5] = [&[1.0], &[2.0], &[1.0], &[0.3], &[1.0]];
    let initial: [&[f64]; 4] = [
        &[1.0, 0.3, -0.4],
        &[0.3, 0.5, 0.2],
        &[1.0, 0.3],
        &[0.3, 0.5],
    ];
    let card = clebsch_interpret::card(Beside::CARD.source).expect("is read");
    for h in [0.2, 0.3, 0.4, 1.0] {
        let case = case(h, &parameters, &initial);
        compare(&Beside::CARD, &card, &case, Settings::step(h), 400);
    }
}

#[test]
fn different_groups_together() {
    let inertia = [0.5, 0.1, 0.0, 0.1, 0.7, 0.0, 0.0, 0.0, 0.9];
    let parameters: [&[f64]; 6] = [
        &inertia,
        &[1.0],
        &[2.0],
        &[0.3, 0.0, 0.4],
        &[0.0, 0.0, -1.0],
        &[3.0],
    ];
    let initial: [&[f64]; 4] = [&ONE, &[0.1, 0.5, 0.2], &[0.1, 0.0, 0.2], &[0.3, 0.1, 0.0]];
    both(&Hanging::CARD, &case(0.05, &parameters, &initial));
}

#[test]
fn bodies_that_are_alike() {
    let inertia = [0.5, 0.1, 0.0, 0.1, 0.7, 0.0, 0.0, 0.0, 0.9];
    let another = [0.3, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.6];
    let (a, b) = ([0.3, 0.1, 0.5], [-0.2, 0.4, 0.1]);
    let parameters: [&[f64]; 5] = [&inertia, &another, &a, &b, &[0.7]];
    let initial: [&[f64]; 8] = [
        &ONE,
        &[0.1, 0.5, 0.2],
        &ONE,
        &[0.3, -0.1, 0.4],
        &ONE,
        &[-0.2, 0.1, 0.3],
        &ONE,
        &[0.2, 0.3, -0.4],
    ];
    both(&Alike::CARD, &case(0.05, &parameters, &initial));
}

#[test]
fn five_coordinates_together() {
    let parameters: [&[f64]; 3] = [&[1.0], &[0.3], &[2.0]];
    let (place, momentum) = ([1.0, 0.2, -0.4, 0.3, 0.6], [0.1, 0.9, -0.2, 0.5, -0.3]);
    both(&Five::CARD, &case(0.05, &parameters, &[&place, &momentum]));
}

#[test]
fn ten_coordinates_together() {
    let inertia = [
        0.5, 0.1, 0.0, 0.0, 0.1, 0.7, 0.0, 0.1, 0.0, 0.0, 0.9, 0.0, 0.0, 0.1, 0.0, 0.6,
    ];
    let one: Vec<f64> = (0..16).map(|i| f64::from(u8::from(i % 5 == 0))).collect();
    let momentum = [
        0.0, -0.1, -0.2, 0.1, 0.1, 0.0, -0.3, -0.2, 0.2, 0.3, 0.0, 0.1, -0.1, 0.2, -0.1, 0.0,
    ];
    let parameters: [&[f64]; 6] = [
        &inertia,
        &[2.0],
        &[0.3],
        &[3.0],
        &[0.3, 0.0, 0.4, 0.1],
        &[0.0, 0.0, -1.0, 0.2],
    ];
    let initial: [&[f64]; 4] = [
        &one,
        &momentum,
        &[0.1, 0.0, 0.2, -0.1],
        &[0.3, 0.1, 0.0, 0.2],
    ];
    both(&Ten::CARD, &case(0.05, &parameters, &initial));
}

#[test]
fn twelve_coordinates_by_one_linear_system() {
    let parameters: [&[f64]; 3] = [&[1.5], &[0.4], &[2.0]];
    let initial: [&[f64]; 6] = [
        &[0.1, 0.5, 0.2, 0.3],
        &[0.3, 0.1, 0.0, -0.2],
        &[-0.1, 0.2, 0.4, 0.0],
        &[0.2, -0.1, 0.3, 0.1],
        &[0.0, 0.3, -0.2, 0.5],
        &[0.1, 0.0, 0.2, 0.4],
    ];
    both(&Twelve::CARD, &case(0.05, &parameters, &initial));
}

/// The rotation of the plane advances by the angle with `2 j sin(angle) = h p`, and the body moves as it does alone.
#[test]
fn turns_of_the_plane_beside_rotations_seen_from_space() {
    let inertia = [0.5, 0.1, 0.0, 0.1, 0.7, 0.0, 0.0, 0.0, 0.9];
    let (j, p, h) = (0.7, 0.9, 0.05);
    let parameters: [&[f64]; 2] = [&[j], &inertia];
    let turn = [1.0, 0.0, 0.0, 1.0];
    let momentum = [0.3, -0.5, 0.4];
    let initial: [&[f64]; 4] = [&turn, &[0.0, -p, p, 0.0], &ONE, &momentum];
    let together = case(h, &parameters, &initial);
    both(&Turns::CARD, &together);

    let text = "model Alone { param J: Sym<3>; group R: SO<3> velocity W; constraint next(R) = W*R;
        lagrangian = -tr(J*R^T*next(R))/h; }";
    let alone = clebsch_interpret::card(text).expect("is read");
    let own = case(h, &[&inertia], &[&ONE, &momentum]);
    let open = |card: &Card, case: &Case| {
        let opened = (card.open)(&case.parameters, &case.initial, Settings::step(h));
        opened.expect("starts")
    };
    let (mut a, mut b) = (open(&Turns::CARD, &together), open(&alone, &own));
    let mut seen = vec![0.0; Turns::CARD.observable_count()];
    let mut body = vec![0.0; alone.observable_count()];
    let angle = (h * p / (2.0 * j)).asin();
    for k in 1..=200 {
        a.step().expect("steps");
        b.step().expect("steps");
        a.observe(&mut seen);
        b.observe(&mut body);
        // Each step rounds a few times; the two solvers of the body round differently.
        let tolerance = 20.0 * f64::EPSILON * f64::from(k);
        let (sin, cos) = (f64::from(k) * angle).sin_cos();
        for (found, wanted) in seen.iter().zip([cos, -sin, sin, cos]) {
            assert!((found - wanted).abs() < tolerance, "{k}: {found} {wanted}");
        }
        let rest = seen.windows(9).any(|w| {
            let near = |(x, y): (&f64, &f64)| (x - y).abs() < tolerance;
            w.iter().zip(&body[..9]).all(near)
        });
        assert!(rest, "{k}: {seen:?} {body:?}");
    }
}

/// A chain of points in which every equation contains velocities of neighbours; quartic if `b` multiplies a kinetic
/// term.
fn chain(count: usize, quartic: bool) -> String {
    let each = |f: &dyn Fn(usize) -> String, join: &str| -> String {
        (0..count).map(f).collect::<Vec<_>>().join(join)
    };
    let term = |i: usize| match quartic {
        true => format!("m*dot(d{i}, d{i})/(2*h) + (b/h^3)*dot(d{i}, d{i})^2"),
        false => format!("m*dot(d{i}, d{i})/(2*h) - h*b*dot(x{i}, x{i})^2"),
    };
    let joint = |i: usize| format!("dot(d{i}, d{})", i + 1);
    let joints: Vec<String> = (0..count - 1).map(joint).collect();
    format!(
        "model Chain {{ param m, b, c, k: Real; {} {} lagrangian = {} + (c/h)*({}) - (h/2)*k*({}); }}",
        each(&|i| format!("field x{i}: Vec<3>;"), " "),
        each(&|i| format!("let d{i} = next(x{i}) - x{i};"), " "),
        each(&term, " + "),
        joints.join(" + "),
        each(&|i| format!("dot(x{i}, x{i})"), " + "),
    )
}

#[test]
fn sixty_coordinates_together() {
    for quartic in [false, true] {
        let count = 20;
        let card = clebsch_interpret::card(&chain(count, quartic)).expect("is read");
        let initial: Vec<Vec<f64>> = (0..2 * count)
            .map(|i| {
                (0..3)
                    .map(|j| (1.3 * i as f64 + 0.7 * f64::from(j)).sin())
                    .collect()
            })
            .collect();
        let parameters = [1.0, 0.01, 0.2, 1.5].map(|x| vec![x]);
        let mut t = (card.open)(&parameters, &initial, Settings::step(0.05)).expect("starts");
        let mut energy = vec![0.0; card.invariant_count()];
        t.invariants(&mut energy);
        let first = energy[0];
        for _ in 0..20 {
            t.step().expect("can be made");
        }
        t.invariants(&mut energy);
        assert!(
            (energy[0] - first).abs() < 1e-2 * first.abs(),
            "{first} {energy:?}"
        );
    }
}
