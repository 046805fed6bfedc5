//! Sums of momenta that advected rotations transform into one frame, for any other couplings, on either side and for
//! either rotation group; also momenta with vanishing terms omitted.

use super::{Family, derive, found};
use crate::algebra::{assumed, exact::Point};
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Node};
use crate::print::{Format, Style, expression};

/// Names and values of the invariants of a family.
fn shown(text: &str, family: Family) -> Vec<String> {
    let d = derive(text);
    let own = d.invariants.iter().filter(|v| v.family == family);
    own.filter_map(|v| {
        let value = v.value.as_ref()?;
        let style = Style::new(&d.spec.time_index);
        let value = expression(value, &d.letters.symbols, &style, Format::Text);
        Some(format!("{}: {value}", v.name))
    })
    .collect()
}

#[test]
fn what_rotations_join_turns_together() {
    let pair = |groups: &str, carried: &str, kinetic: &str| {
        format!(
            "model Joined {{ param J: Sym<3>; param a, b: Vec<3>; param e: Real; {groups} \
             group q: SU<2> velocity w; advected U: Sym<3>; advected g: Vec<3>; \
             constraint next(q) = q*w; constraint next(U) = rot(w)^T*U*rot(w); {carried} \
             lagrangian = {kinetic} + (2/h)*dot(im(w), J*im(w)) \
             - h*e*(dot(a, R*b) + dot(g, a)*dot(a, U*b) + dot(a, g)^2); }}"
        )
    };
    let rotations = "group A: SO<3> velocity u; group B: SO<3> velocity v; advected R: SO<3>;";
    let quaternion = rotations.replace("A: SO<3>", "A: SU<2>");
    let two = "-tr(J*u)/h - tr(J*v)/h";
    for (groups, carried, kinetic, said) in [
        (
            rotations,
            "constraint next(A) = A*u; constraint next(B) = B*v; \
             constraint next(R) = u^T*R*v; constraint next(g) = u^T*g;",
            two,
            "total_momentum_A_B_g: (μ_{1,k} + R_k μ_{2,k})·g_k",
        ),
        (
            rotations,
            "constraint next(A) = u*A; constraint next(B) = v*B; \
             constraint next(R) = u*R*v^T; constraint next(g) = u*g;",
            two,
            "total_momentum_A_B_g: (m_{1,k} + R_k m_{2,k})·g_k",
        ),
        // A rotation of the body B is the inverse of a rotation of space.
        (
            rotations,
            "constraint next(A) = u*A; constraint next(B) = B*v; \
             constraint next(R) = u*R*v; constraint next(g) = u*g;",
            two,
            "total_momentum_A_B_g: (m_{1,k} - R_k μ_{2,k})·g_k",
        ),
        (
            &quaternion,
            "constraint next(A) = A*u; constraint next(B) = B*v; \
             constraint next(R) = rot(u)^T*R*v; constraint next(g) = rot(u)^T*g;",
            "(2/h)*dot(im(u), J*im(u)) - tr(J*v)/h",
            "total_momentum_A_B_g: (μ_{1,k} + R_k μ_{2,k})·g_k",
        ),
    ] {
        let text = pair(groups, carried, kinetic);
        let found = shown(&text, Family::Casimir);
        assert!(found.iter().any(|v| v == said), "{text}\n{found:#?}");
        // A vector advected by another body's velocity is not part of the sum.
        let (head, tail) = text.split_once("next(g) = ").unwrap();
        let (_, rest) = tail.split_once(';').unwrap();
        let broken = format!("{head}next(g) = rot(w)^T*g;{rest}");
        let found = shown(&broken, Family::Casimir);
        assert!(found.iter().all(|v| v != said), "{broken}\n{found:#?}");
    }
}

/// Whether a term of a sum, or of a sum projected on an axis, vanishes for all values of the letters.
fn has_idle_term(point: &Point, e: &Expr) -> bool {
    let vanishes = |t: &Expr| point.value(t).is_some_and(|m| m.vanishes());
    match e.node() {
        Node::Sum(list) => list.iter().any(|t| vanishes(t) || has_idle_term(point, t)),
        Node::Dot(a, b) => [(a, b), (b, a)].into_iter().any(|(a, b)| match a.node() {
            Node::Sum(list) => list
                .iter()
                .any(|t| vanishes(&expr::dot(t.clone(), b.clone()))),
            _ => false,
        }),
        _ => false,
    }
}

#[test]
fn about_a_place_the_whole_momentum_is_found_and_no_term_of_it_is_zero() {
    let text = "model Five { param J: Sym<3>; param a, b, c: Vec<3>; param m, e: Real; \
        group A: SO<3> velocity u; group B: SO<3> velocity v; group C: SO<3> velocity w; \
        group q: SU<2> velocity y; group G: SE<3> velocity V; \
        constraint next(A) = A*u; constraint next(B) = B*v; constraint next(C) = w*C; \
        constraint next(q) = q*y; constraint next(G) = G*V; \
        let x = pos(G*V) - pos(G); \
        lagrangian = -(tr(J*u) + tr(J*v) + tr(J*C^T*w*C) + tr(J*rot(V)))/h \
        + (2/h)*dot(im(y), J*im(y)) + m*dot(x, x)/(2*h) \
        - h*e*(dot(A*a, rot(G)*b) + dot(A*c, B*b)*dot(rot(q)*a, C*b) + dot(B*a, rot(q)*c) \
        + dot(b, pos(G)) + dot(rot(G)*c, pos(G) + b) + dot(pos(G), pos(G))/2); }";
    // Springs to the point -b.
    assert_eq!(
        shown(text, Family::Noether),
        [
            "joint_momentum_angular_about_b: A_k μ_{1,k} + B_k μ_{2,k} + ϖ_{3,k} + rot(q_k) μ_{4,k} \
             + rot(G_k) ang(μ_{5,k}) + pos(G_k) × (rot(G_k) lin(μ_{5,k})) + b × (rot(G_k) lin(μ_{5,k}))"
        ]
    );
    // Without the springs, rotations about the vertical and translations across it remain.
    let free = text.replace("+ dot(pos(G), pos(G))/2", "");
    for text in [text, &free] {
        let d = derive(text);
        let point = assumed::point(&d.letters.symbols, 1, &[]).expect("a point");
        for v in &d.invariants {
            if let Some(value) = &v.value {
                assert!(!has_idle_term(&point, value), "{}: {value:?}", v.name);
            }
        }
    }
}

#[test]
fn constraints_between_bodies_leave_the_sums_of_momenta() {
    let pair = |held: &str| {
        let names = found(&format!(
            "model Pair {{ param m, n, a: Real; field x, y: Vec<3>; hold l: {held} = a^2;
             lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + n*dot(next(y) - y, next(y) - y)/(2*h); }}"
        ));
        let momenta = names.into_iter().filter(|n| n.contains("momentum"));
        momenta.collect::<Vec<String>>()
    };
    let both = ["total_momentum", "total_momentum_angular"];
    assert_eq!(pair("dot(y - x, y - x)"), both);
    // A constraint force that acts twice as strongly on one point conserves another sum, and exerts no moment.
    assert_eq!(
        pair("dot(y - 2*x, y - 2*x)"),
        ["joint_momentum", "total_momentum_angular"]
    );
    // A chain with links between neighbours.
    let chain = found(
        "model Chain { param m, a: Real; param g: Vec<3>; field x, y, z: Vec<3>;
            hold l: dot(y - x, y - x) = a^2; hold k: dot(z - y, z - y) = a^2;
            lagrangian = m*(dot(next(x) - x, next(x) - x) + dot(next(y) - y, next(y) - y) + dot(next(z) - z, next(z) - z))/(2*h)
                + h*m*dot(g, x + y + z); }",
    );
    let momenta = chain.iter().filter(|n| n.contains("momentum"));
    let momenta: Vec<&String> = momenta.collect();
    assert_eq!(
        momenta,
        ["total_momentum_across_g", "total_momentum_angular_g"]
    );
}

#[test]
fn joints_leave_what_is_conserved_where_they_hold() {
    let momenta = |more: &str, hold: &str| {
        let names = found(&format!(
            "model Joint {{ param m, n: Real; param J, K: Sym<3>; param a, b, c, g: Vec<3>; field x, y: Vec<3>;
             group R: SO<3> velocity O; group S: SO<3> velocity W;
             constraint next(R) = R*O; constraint next(S) = S*W; {hold}
             lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + n*dot(next(y) - y, next(y) - y)/(2*h)
                - tr(J*O)/h - tr(K*W)/h{more}; }}"
        ));
        let momenta = names.into_iter().filter(|n| n.contains("momentum"));
        momenta.collect::<Vec<String>>()
    };
    let free = ["total_momentum_x_y", "total_momentum_angular"];
    let ball = "hold l: x + R*a = y + S*b;";
    assert_eq!(momenta("", ball), free, "a ball joint");
    let about = ["total_momentum_x_y_across_g", "total_momentum_angular_g"];
    let weight = " + h*dot(g, m*x + n*y)";
    assert_eq!(momenta(weight, ball), about, "a ball joint under weight");
    let hinge = format!("{ball} hold k: dot(R*c, S*a) = 0; hold j: dot(R*g, S*a) = 0;");
    assert_eq!(momenta("", &hinge), free, "a common axis");
    // Under a common rotation of space, one side of this constraint rotates with its frame and the other does not.
    let held = format!("{ball} hold k: dot(R*c, S^T*a) = 0;");
    assert_eq!(
        momenta("", &held),
        free[..1],
        "axes that turn against each other"
    );
    let to_a_wall = momenta("", "hold l: x + R*a = b;");
    assert!(to_a_wall.contains(&"total_momentum_x_R_angular_about_b".to_owned()));
    assert!(
        !to_a_wall.iter().any(|n| n.contains("momentum_x_y")),
        "{to_a_wall:?}"
    );
}

#[test]
fn joints_of_rigid_motions_leave_their_angular_momentum() {
    // The momentum of a rigid motion has both parts, angular about the origin and linear.
    let rows = |hold: &str| {
        let d = derive(&format!(
            "model Joint {{ param J, K: Sym<3>; param m, n: Real; param d, e: Vec<3>;
             group A: SE<3> velocity V; group B: SE<3> velocity W; constraint next(A) = A*V; constraint next(B) = B*W;
             hold l: {hold};
             lagrangian = -tr(J*rot(V))/h - tr(K*rot(W))/h + m*dot(pos(V), pos(V))/(2*h) + n*dot(pos(W), pos(W))/(2*h); }}"
        ));
        let total = d.invariants.iter().find(|v| v.name == "total_momentum");
        total.and_then(|v| v.value.as_ref().map(|e| e.shape().rows))
    };
    let joint = "pos(A) + rot(A)*d = pos(B) + rot(B)*e";
    assert_eq!(rows(joint), Some(Dim::Fixed(6)));
    // If one vector rotates against its body, only the linear sum remains.
    let turned = joint.replace("rot(B)*e", "rot(B)^T*e");
    assert_ne!(rows(&turned), Some(Dim::Fixed(6)));
}
