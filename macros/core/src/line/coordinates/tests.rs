//! Configurations that are stored in coordinates: which coordinates, how the velocities are found, and which models
//! are rejected.

use super::CoordinateKind;
use crate::line::{Line, Refused, SiteSolve};
use crate::pipeline;

fn line(text: &str) -> Result<Line, Refused> {
    let model = pipeline::parse_source(text).map_err(Refused::Model)?;
    Line::of(&model)
}

fn taken(text: &str) -> Line {
    match line(text) {
        Ok(line) => line,
        Err(refused) => panic!("{text}: {refused:?}"),
    }
}

fn ellipsoids(constraint: &str, kinetic: &str) -> String {
    format!(
        "model Ellipsoids {{ label i in 0..N; periodic; param I0: Sym<3>; param k: Real;
         group Q: GL<3> at nodes velocity G; constraint {constraint};
         let d = next(Q, i) - Q;
         lagrangian = {kinetic}/(2*h) - (h*k/2)*tr(d^T*d); }}"
    )
}

#[test]
fn linear_maps_with_a_constant_inertia_step_explicitly_on_either_side() {
    for (constraint, kinetic) in [
        ("next(Q) = Q*G", "tr(Q^T*Q*(G - Id)*I0*(G - Id)^T)"),
        ("next(Q) = G*Q", "tr((G - Id)*Q*I0*Q^T*(G - Id)^T)"),
        ("next(Q) = Q*G", "tr((next(Q) - Q)*I0*(next(Q) - Q)^T)"),
    ] {
        let line = taken(&ellipsoids(constraint, kinetic));
        assert_eq!(
            line.coordinates[0].by,
            CoordinateKind::Entries(3),
            "{constraint}"
        );
        let mover = &line.lone[0].movers[0];
        assert!(matches!(mover.how, SiteSolve::Field { .. }), "{constraint}");
        assert_eq!(crate::emit::refusal_of_line(&line), None);
    }
}

#[test]
fn an_inertia_that_moves_with_the_map_is_refused_with_the_form_that_is_taken() {
    let refused = line(&ellipsoids("next(Q) = Q*G", "tr((G - Id)*I0*(G - Id)^T)"));
    let Err(Refused::Form(why)) = refused else {
        panic!("it is taken");
    };
    assert!(why.contains("the momentum of the matrix `Q`"), "{why}");
}

#[test]
fn rigid_motions_are_rotations_and_places() {
    let frames = |kinetic: &str| {
        format!(
            "model Frames {{ label i in 0..N step s; param J, C, M: Sym<3>; param m: Real; param b, Z: Vec<4>;
             group Φ: SE<3> at nodes velocity V; advected P: Vec<4> at nodes = Φ^T*Z;
             constraint next(Φ) = Φ*V; constraint next(P) = V^T*P;
             let U = Φ^-1*next(Φ, i); let u = (pos(V) - pos(V^-1))/2;
             lagrangian = -tr(J*rot(V))/h + {kinetic}/(2*h) - h*dot(b, P)
                - (h/2)*dot(pos(U) - s*E3, pos(U) - s*E3) + h*tr(C*rot(U)); }}"
        )
    };
    let line = taken(&frames("m*dot(pos(V), pos(V))"));
    let names = line.coordinates[0].names();
    assert_eq!(names, ["R_Φ", "x_Φ"]);
    let hows: Vec<bool> = line.lone[0]
        .movers
        .iter()
        .map(|m| matches!(m.how, SiteSolve::Rotation { .. } | SiteSolve::Field { .. }))
        .collect();
    assert_eq!(hows, [true, true]);
    // Added masses couple both velocities.
    let line = taken(&frames("dot(u, M*u)"));
    let movers = &line.lone[0].movers;
    assert!(
        movers
            .iter()
            .all(|m| matches!(m.how, SiteSolve::Newton { .. }))
    );
    assert_eq!(line.lone[0].blocks, [[0, 1]]);
}

#[test]
fn names_that_are_taken_are_others() {
    let line = taken(
        "model Rotors { label i in 0..N; periodic; param J: Sym<2>; param θ_R: Real;
         group R: SO<2> at nodes velocity W; constraint next(R) = R*W;
         lagrangian = -tr(J*W)/h + h*θ_R*tr(R^T*next(R, i)); }",
    );
    assert_eq!(
        line.coordinates[0].by,
        CoordinateKind::Angle("θθ_R".to_owned())
    );
}

#[test]
fn what_is_wrong_with_a_model_is_said_of_it_as_stated() {
    let wrong = "model Frames { label i in 0..N; param m: Real; group Φ: SE<3> at nodes velocity V;
         advected P: Vec<4> at nodes = Φ^T*Z; constraint next(Φ) = Φ*V;
         lagrangian = m*dot(pos(V), pos(V))/(2*h); }";
    assert!(matches!(line(wrong), Err(Refused::Model(_))));
}

#[test]
fn what_goes_on_by_itself_or_stands_otherwise_is_refused() {
    let text = ellipsoids("next(Q) = Q*G", "tr(Q^T*Q*(G - Id)*I0*(G - Id)^T)");
    let carried = text.replace(
        "let d",
        "advected v: Vec<3> at nodes; constraint next(v) = G^-1*v; let w = dot(v, v); let d",
    );
    let carried = carried.replace("- (h*k/2)", "- h*w - (h*k/2)");
    let Err(Refused::Form(why)) = line(&carried) else {
        panic!("it is taken");
    };
    assert!(why.contains("the constraint of `v` contains `G`"), "{why}");
    let whole = line(
        "model Frames { label i in 0..N; param Q: Sym<4>; param c: Real; group Φ: SE<3> at nodes velocity V;
         constraint next(Φ) = Φ*V;
         lagrangian = tr((V - Id)*Q*(V - Id)^T)/(2*h) + h*c*tr(rot(Φ^-1*next(Φ, i))); }",
    );
    let Err(Refused::Form(why)) = whole else {
        panic!("it is taken");
    };
    assert!(why.contains("homogeneous matrix of `V`"), "{why}");
}
