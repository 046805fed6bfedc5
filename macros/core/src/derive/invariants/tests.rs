//! Which invariants are found and which are not. Takes models as text; compares the names of the invariants.

mod lattices;
mod mixed_fields;
mod scales;
mod singular;
mod symmetries;
mod totals;

use super::{CasimirSearch, Family};
use crate::derive::Derivation;
use crate::pipeline::derive_source;

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{e}"))
}

/// The names of the invariants, with a mark on bounded ones.
fn names(d: &Derivation) -> Vec<String> {
    let list = d.invariants.iter();
    list.map(|v| format!("{}{}", v.name, if v.exact { "" } else { "~" }))
        .collect()
}

fn found(text: &str) -> Vec<String> {
    names(&derive(text))
}

/// The heavy top with assumptions on its parameters.
fn top(assumed: &str) -> String {
    format!(
        "model Top {{
            param J: Sym<3>; param gU, z: Vec<3>;
            {assumed}
            group Λ: SO<3> velocity Ω;
            advected Γ: Vec<3> = Λ^T*z;
            constraint next(Λ) = Λ*Ω;
            constraint next(Γ) = Ω^T*Γ;
            lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
        }}"
    )
}

#[test]
fn a_symmetric_top_keeps_the_momentum_about_its_axis_when_that_is_assumed() {
    let general = ["energy~", "momentum_Gamma", "Gamma_squared"];
    assert_eq!(found(&top("")), general);
    let symmetric = [
        "assume J*hat(E3) == hat(E3)*J; assume cross(gU, E3) == 0;",
        "assume dot(E1, J*E1) == dot(E2, J*E2); assume dot(E1, J*E2) == 0; assume dot(E1, J*E3) == 0;
         assume dot(E2, J*E3) == 0; assume dot(gU, E1) == 0; assume dot(gU, E2) == 0;",
        "assume J*hat(E3) - hat(E3)*J == 0; assume gU == dot(gU, E3)*E3; assume dot(z, z) == 1;",
    ];
    for assumed in symmetric {
        let all = [&general[..], &["momentum_E3"]].concat();
        assert_eq!(found(&top(assumed)), all, "{assumed}");
    }
    // One assumption is not enough, and neither is a wrong axis.
    for assumed in [
        "assume J*hat(E3) == hat(E3)*J;",
        "assume cross(gU, E3) == 0;",
        "assume J*hat(E3) == hat(E3)*J; assume cross(gU, E1) == 0;",
        "assume dot(E1, J*E1) == dot(E2, J*E2); assume cross(gU, E3) == 0;",
        "assume dot(gU, gU) > 1;",
    ] {
        assert_eq!(found(&top(assumed)), general, "{assumed}");
    }
    // The axis is a parameter, which may be zero; the assumption then does not restrict gU. The momentum about n is
    // always conserved, the momentum about gU is not.
    let axis = "param n: Vec<3>; assume J*hat(n) == hat(n)*J; assume cross(gU, n) == 0;";
    let all = [&general[..], &["momentum_n"]].concat();
    assert_eq!(found(&top(axis)), all);
}

#[test]
fn an_assumption_with_two_branches_serves_neither() {
    let text = |assumed: &str| {
        format!(
            "model Body {{
                param J: Sym<3>; param a, b, c: Real; param g: Vec<3>; {assumed}
                group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
                lagrangian = -tr(J*Ω)/h - (a - b)*h*dot(g, Λ*g);
            }}"
        )
    };
    let free = found(&text("assume a == b;"));
    assert!(free.contains(&"spatial_momentum".to_owned()), "{free:?}");
    let either = found(&text("assume (a - b)*(a - c) == 0;"));
    assert!(
        !either.contains(&"spatial_momentum".to_owned()),
        "{either:?}"
    );
}

#[test]
fn coupled_bodies_keep_the_sum_of_their_momenta() {
    let bodies = |more: &str| {
        format!(
            "model Bodies {{
                param J1, J2: Sym<3>; param d1, d2, g, z: Vec<3>; param eps: Real;
                group A: SO<3> velocity a; group B: SO<3> velocity b;
                advected R: SO<3> = A^T*B; advected G: Vec<3> = A^T*z;
                constraint next(A) = A*a; constraint next(B) = B*b;
                constraint next(R) = a^T*R*b; constraint next(G) = a^T*G;
                lagrangian = -(tr(J1*a) + tr(J2*b) + eps*dot((a - Id)*d1, R*(b - Id)*d2))/h{more};
            }}"
        )
    };
    let d = derive(&bodies(""));
    assert!(names(&d).contains(&"total_momentum".to_owned()));
    let d = derive(&bodies(" - h*dot(g, G)"));
    assert_eq!(
        names(&d),
        ["energy~", "total_momentum_Gamma", "Gamma_squared"].map(|n| n.replace("Gamma", "G"))
    );
    assert_eq!(d.integrability.rank(), Some((12, 10)));
}

#[test]
fn bodies_that_do_not_meet_keep_their_own() {
    let names = found(
        "model Two {
            param J1, J2: Sym<3>;
            group A: SO<3> velocity a; group B: SO<3> velocity b;
            constraint next(A) = A*a; constraint next(B) = B*b;
            lagrangian = -(tr(J1*a) + tr(J2*b))/h;
        }",
    );
    assert_eq!(
        names,
        [
            "energy",
            "spatial_momentum_A",
            "spatial_momentum_B",
            "momentum_A_squared",
            "momentum_B_squared"
        ]
    );
}

#[test]
fn the_spatial_side_has_the_eigenvalues_of_what_it_carries() {
    let d = derive(
        "model Top {
            param w: Real; param z: Vec<3>;
            group Λ: SO<3> velocity ω; advected J: Sym<3>; advected chi: Vec<3>;
            constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T;
            constraint next(chi) = ω*chi;
            lagrangian = -tr(ω*J)/h - h*w*dot(chi, z);
        }",
    );
    let wanted = [
        "energy~",
        "chi_squared",
        "trace_J1",
        "trace_J2",
        "trace_J3",
        "chi_J_chi",
        "chi_J2_chi",
        "momentum_z",
    ];
    assert_eq!(names(&d), wanted);
    assert_eq!(d.integrability.rank(), Some((12, 6)));
    assert_eq!(casimirs(&d), [(None, 6, 6)]);
    let free = "model Body {
        group Λ: SO<3> velocity ω; advected J: Sym<3>;
        constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T;
        lagrangian = -tr(ω*J)/h;
    }";
    // The energy of the free body is also exact in the spatial form, but |m| is not a Casimir there.
    let d = derive(free);
    let wanted = [
        "energy",
        "spatial_momentum",
        "trace_J1",
        "trace_J2",
        "trace_J3",
        "momentum_quadratic",
    ];
    assert_eq!(names(&d), wanted);
    assert!(d.integrability.lax.is_some() && d.integrability.discrete_energy.exact);
}

#[test]
fn free_bodies_have_manakov_integrals_in_every_dimension() {
    for (n, rank) in [(4, (6, 4)), (5, (10, 8))] {
        let d = derive(&format!(
            "model Body {{
                param C: Sym<{n}>; group Λ: SO<{n}> velocity Ω;
                constraint next(Λ) = Λ*Ω; lagrangian = -tr(C*Ω)/h;
            }}"
        ));
        let wanted = [
            "energy",
            "spatial_momentum",
            "momentum_squared",
            "trace_momentum4",
            "manakov",
        ];
        assert_eq!(names(&d), wanted, "{n}");
        assert_eq!(d.integrability.rank(), Some(rank));
        assert!(d.integrability.lax.is_some());
    }
    // A factor without symmetry has no Lax form: only the momentum and its Casimirs remain.
    let d = derive(
        "model Body {
            param C: Mat<4>; group Λ: SO<4> velocity Ω;
            constraint next(Λ) = Λ*Ω; lagrangian = -tr(C^T*Ω)/h;
        }",
    );
    assert!(d.integrability.lax.is_none());
    assert!(d.invariants.iter().all(|v| v.family != Family::Manakov));
}

#[test]
fn affine_bodies_keep_circulation_and_angular_momentum() {
    let wanted = [
        "energy~",
        "angular_momentum_C_2",
        "spatial_momentum_skew_C0_inverse",
    ];
    let names = found(
        "model Ellipsoid {
            param C0, I0: Sym<3>; param a: Real;
            group Q: GL<3> velocity G; advected C: Sym<3> = Q^T*C0*Q;
            constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*a*tr(C*C);
        }",
    );
    assert_eq!(names, wanted);
}

#[test]
fn the_list_is_that_of_the_system_not_of_its_text() {
    let renamed = "model Other {
        scale -h;
        param q, p: Vec<3>;
        group g: SO<3> velocity W;
        param A: Sym<3>;
        advected y: Vec<3> = g^T*q;
        constraint next(y) = W^T*y;
        constraint next(g) = g*W;
        lagrangian = tr(W*A) + h^2*dot(y, p);
    }";
    let wanted = found(&top("")).into_iter().map(|n| n.replace("Gamma", "y"));
    assert_eq!(found(renamed), wanted.collect::<Vec<_>>());
}

#[test]
fn the_bracket_of_body_and_space_differ_in_sign() {
    use crate::derive::bracket::Space;
    use crate::interpret::Assignment;
    let body = derive(
        "model Body { param J: Sym<3>; group L: SO<3> velocity W;
        constraint next(L) = L*W; lagrangian = -tr(J*W)/h; }",
    );
    let space = derive(
        "model Body { advected J: Sym<3>; group L: SO<3> velocity w;
        constraint next(L) = w*L; constraint next(J) = w*J*w^T; lagrangian = -tr(J*w)/h; }",
    );
    let mut at = Assignment::new();
    at.set("μ", 0, 3, 1, &[1.0, 2.0, 4.0]);
    at.set("m", 0, 3, 1, &[1.0, 2.0, 4.0]);
    at.set(
        "J",
        0,
        3,
        3,
        &[1.0, 2.0, 3.0, 2.0, 5.0, 7.0, 3.0, 7.0, 11.0],
    );
    let entry = |d: &Derivation, i: usize, j: usize| {
        d.bracket_matrix(Space::Reduced, &at).map(|m| m.get(i, j))
    };
    // {μ_1, μ_2} = -μ_3 and {m_1, m_2} = m_3.
    assert_eq!(entry(&body, 0, 1), Ok(-4.0));
    assert_eq!(entry(&space, 0, 1), Ok(4.0));
    // {J, m_3} = [hat(e_3), J], whose entry (1, 1) is -2 J_12.
    assert_eq!(entry(&space, 3, 2), Ok(-4.0));
    assert_eq!(entry(&space, 2, 3), Ok(4.0));
}

/// A body in a fluid, with these declarations for its surroundings and this potential.
fn body_in_fluid(declared: &str, potential: &str) -> Derivation {
    derive(&format!(
        "model Body {{
            param J, M: Sym<3>; param D: Mat<3>;
            group G: SE<3> velocity V;
            {declared}
            constraint next(G) = G*V;
            let u = (pos(V) - pos(V^-1))/2;
            lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(vee(rot(V)), D*u)/h{potential};
        }}"
    ))
}

#[test]
fn a_body_in_a_fluid_keeps_what_its_surroundings_leave_alone() {
    let free = body_in_fluid("", "");
    let wanted = [
        "energy~",
        "spatial_momentum",
        "momentum_angular_momentum_linear",
        "momentum_linear_squared",
    ];
    assert_eq!(names(&free), wanted);
    assert_eq!(free.integrability.rank(), Some((6, 4)));
    // Neutral buoyancy: the potential depends on the vertical direction only.
    let upright = body_in_fluid(
        "param b, z: Vec<3>; advected Γ: Vec<3> = rot(G)^T*z; constraint next(Γ) = rot(V)^T*Γ;",
        " - h*dot(b, Γ)",
    );
    let wanted = [
        "energy~",
        "momentum_linear_squared",
        "momentum_linear_Gamma",
        "Gamma_squared",
        "spatial_momentum_linear",
        "spatial_momentum_angular_z",
    ];
    assert_eq!(names(&upright), wanted);
    assert_eq!(upright.integrability.rank(), Some((9, 6)));
    // A net weight: the potential depends on the height and not on horizontal translations.
    let heavy = body_in_fluid(
        "param b, Z: Vec<4>; advected P: Vec<4> = G^T*Z; constraint next(P) = V^T*P;",
        " - h*dot(b, P)",
    );
    let wanted = [
        "energy~",
        "P_part_squared",
        "momentum_linear_across_P_part_squared",
        "spatial_momentum_linear_across_Z",
        "spatial_momentum_angular_Z",
    ];
    assert_eq!(names(&heavy), wanted);
    assert_eq!(heavy.integrability.rank(), Some((10, 8)));
    assert_eq!(casimirs(&heavy), [(None, 2, 2)]);
    // A spring to a fixed point instead of a weight: the moment about that point is conserved.
    let held = body_in_fluid(
        "param K: Sym<4>; param X: Vec<4>; advected Q: Vec<4> = G^-1*X; constraint next(Q) = V^-1*Q;",
        " - h*dot(Q, K*Q)",
    );
    let wanted = [
        "energy~",
        "moment_about_Q_squared",
        "Q_weight",
        "spatial_momentum_moment_about_X",
    ];
    assert_eq!(names(&held), wanted);
    assert_eq!(held.integrability.rank(), Some((10, 8)));
}

/// For each size: the number of Casimirs found, and their total number.
fn casimirs(d: &Derivation) -> Vec<(Option<usize>, usize, usize)> {
    match &d.integrability.casimirs {
        CasimirSearch::Counted(counts) => {
            counts.iter().map(|c| (c.size, c.found, c.all())).collect()
        }
        CasimirSearch::NotSought(_) => Vec::new(),
    }
}

fn body_of(dimension: &str, size: &str, factor: &str, assumed: &str) -> Derivation {
    derive(&format!(
        "model Body {{
            {dimension} param C: {factor}<{size}>; {assumed}
            group Λ: SO<{size}> velocity Ω; constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(C^T*Ω)/h;
        }}"
    ))
}

#[test]
fn casimirs_of_a_named_size_are_counted_at_every_size() {
    let d = body_of("dim n in 3..=8;", "n", "Mat", "");
    let all = [(3, 1), (4, 2), (5, 2), (6, 3), (7, 3), (8, 4)];
    assert_eq!(casimirs(&d), all.map(|(n, c)| (Some(n), c, c)));
    let text = crate::document::printed(&d, crate::print::Format::Text);
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("for n = 7 it is 18 of 21, and there are 3 independent Casimirs"),
        "{text}"
    );
    // Beyond the sizes that are tried, the document says so.
    let wide = body_of("dim n in 3..=12;", "n", "Mat", "");
    assert_eq!(casimirs(&wide).last(), Some(&(Some(8), 4, 4)));
    let none = body_of("", "12", "Mat", "");
    assert!(matches!(
        none.integrability.casimirs,
        CasimirSearch::NotSought(_)
    ));
    assert!(none.integrability.rank().is_none());
}

#[test]
fn a_symmetric_factor_makes_the_step_reversible() {
    use crate::derive::reversal::Reversal;
    for dimension in [("dim n in 3..=8;", "n"), ("", "3"), ("", "4")] {
        let of = |factor, assumed| body_of(dimension.0, dimension.1, factor, assumed);
        let general = of("Mat", "");
        assert!(matches!(general.reversal, Reversal::Broken(Some(_))));
        assert!(!general.reversible && general.limit.is_err());
        let declared = of("Sym", "");
        assert!(matches!(declared.reversal, Reversal::Symmetric));
        assert!(declared.reversible && declared.limit.is_ok());
        let assumed = of("Mat", "assume C^T == C;");
        assert!(matches!(assumed.reversal, Reversal::Assumed));
        assert!(assumed.reversible && assumed.limit.is_ok());
        // An unrelated assumption does not suffice.
        let other = of("Mat", "assume tr(C) == 1;");
        assert!(!other.reversible && other.limit.is_err());
    }
}

#[test]
fn the_discrete_energy_has_no_term_that_is_zero() {
    // The discrete energy subtracts the action at zero velocity, which has a term in the velocity minus the identity.
    let d = derive(
        "model Body {
            param J: Sym<3>; param d, g: Vec<3>;
            group Λ: SO<3> velocity Ω; advected Γ: Vec<3> = Λ^T*g;
            constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
            lagrangian = (-tr(J*Ω) - dot((Ω - Id)*d, Γ)*dot((Ω - Id)*d, next(Γ)))/h;
        }",
    );
    let s = &d.letters.symbols;
    let value = &d.integrability.discrete_energy.value;
    let still = crate::expr::substitute(
        s,
        value,
        &[(
            crate::expr::Letter {
                symbol: d.spec.configurations[0].velocity,
                shift: crate::expr::Shift::HERE,
            },
            crate::expr::identity(crate::expr::shape::Dim::Fixed(3)),
        )],
    );
    // tr(J), tr(J Ω) and the coupling are three terms, and their sum is zero at zero velocity.
    assert_eq!(value.children().len(), 3, "{value:?}");
    assert!(still.is_zero(), "{still:?}");
}

/// `A` and its inverse are both advected, and `tr(A A⁻¹)` is 3 in every state. A matrix with an empty last row has
/// determinant zero. The length of an advected vector is listed, although it is constant in a given model.
#[test]
fn what_is_the_same_number_for_every_state_is_not_listed() {
    let metrics = derive(
        "model Metrics {
            param k: Real; group Q: GL<3> velocity G; constraint next(Q) = Q*G;
            lagrangian = tr((next(Q) - Q)*(next(Q) - Q)^T)/(2*h) - h*k*tr(inv(Q^T*Q));
        }",
    );
    let moments = ["spatial_momentum_skew_identity", "momentum_skew_identity"];
    assert_eq!(names(&metrics), [&["energy~"][..], &moments].concat());
    let same = |d: &Derivation| match &d.integrability.casimirs {
        CasimirSearch::Counted(counts) => counts.iter().map(|c| (c.found, c.same)).collect(),
        CasimirSearch::NotSought(_) => Vec::new(),
    };
    assert_eq!(same(&metrics), [(2, 2)]);
    let spring = derive(
        "model Spring {
            param J, K: Sym<3>; param m: Real; param c, d: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            let y = pos(next(G)) - pos(G); let u = pos(G) + rot(G)*c;
            lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - (h/2)*dot(u, K*u) + h*dot(d, rot(G)*c);
        }",
    );
    let listed = names(&spring);
    assert!(!listed.iter().any(|n| n.starts_with("det_")), "{listed:?}");
    assert_eq!(same(&spring), [(2, 1)]);
    // A reference of length 1 in every state has no listed length; any other reference has one.
    let top = found(&top("").replace("Λ^T*z", "Λ^T*E3"));
    assert_eq!(top, ["energy~", "momentum_Gamma", "Gamma_squared"]);
}
