//! Errata of chapter 2 and its appendix on rotations. At random points, gives the printed and the correct form to `judge`.

use super::{
    Matrix, Vector, ad_star, bracket, id, inner, judge, length, minus, residual, size, skew, sym,
};
use clebsch_core::derive_source;
use clebsch_oracle::oracle::action::bodies::{HeavyTop, Stated};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{cross, dot, hat, outer, vee};
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

#[test]
fn two_57_the_second_gradient_belongs_to_the_next_node() {
    judge("(2.57)", |s| {
        let (inertia, here, next, change) =
            (s.positive(), s.orthogonal(), s.orthogonal(), s.matrix());
        // L = tr(Λ I0 Λ'ᵀ), linear in Λ'.
        let of_next = (here * inertia * change.transpose()).trace();
        let (printed, right) = (next * inertia, here * inertia);
        (
            (inner(&printed, &change) - of_next).abs(),
            (inner(&right, &change) - of_next).abs(),
        )
    });
}

#[test]
fn after_two_89_a_rotation_is_no_opposite_of_one() {
    judge("Ω = -ωᵀ", |s| {
        let w: Matrix = s.orthogonal();
        let determinant = |g: &Matrix| (g.determinant() - 1.0).abs();
        (
            determinant(&w.transpose().scaled(-1.0)),
            determinant(&w.transpose()),
        )
    });
    // With Ω = ωᵀ the two momenta are opposite, not equal.
    judge("sign of M", |s| {
        let (j, w) = (s.positive(), s.orthogonal());
        let turned: Matrix = w.transpose();
        let theirs = w.transpose() * j - j * w;
        let ours = j * turned.transpose() - turned * j;
        (size(&(ours - theirs)), size(&(ours + theirs)))
    });
}

#[test]
fn two_107_the_multiplier_is_not_transposed() {
    judge("(2.107)", |s| {
        let (p, here, change) = (s.matrix(), s.orthogonal(), s.matrix());
        // tr(P'ᵀ (Λ' - ω Λ))/2 along a change of ω.
        let slope = -0.5 * (p.transpose() * change * here).trace();
        let gradient = |g: Matrix| -0.5 * inner(&g, &change);
        let printed = gradient(p.transpose() * here.transpose());
        let right = gradient(p * here.transpose());
        ((printed - slope).abs(), (right - slope).abs())
    });
}

#[test]
fn two_121_holds_for_the_gradient_of_the_free_body_alone() {
    let moved = |w: &Matrix, v: &Matrix| size(&(*v - *w * *v * w.transpose()));
    judge("(2.121)", |s| {
        let w: Matrix = s.orthogonal();
        // A general symmetric gradient against sym(ω), which commutes with ω.
        (moved(&w, &s.symmetric()), moved(&w, &sym(&w)))
    });
}

#[test]
fn two_128_is_the_dual_action() {
    judge("(2.128)", |s| {
        let (i, zeta): (Matrix, Matrix) = (s.symmetric(), s.matrix());
        // d/dε of (1 + εζ) I (1 + εζ)ᵀ, exact: a quadratic polynomial.
        let at = |e: f64| {
            let g = id() + zeta.scaled(e);
            g * i * g.transpose()
        };
        let slope = (at(1.0) - at(-1.0)).scaled(0.5);
        let printed = zeta.transpose() * i + i * zeta;
        let right = zeta * i + i * zeta.transpose();
        (size(&(printed - slope)), size(&(right - slope)))
    });
}

#[test]
fn remark_2_6_the_norm_of_the_momentum_is_no_casimir() {
    // {J, m_j} = [ê_j, J], {m_i, m_j} = (m × ...): the flow of the momentum, which preserves a Casimir.
    judge("|m| as a Casimir", |s| {
        let (j, m): (Matrix, Vector) = (s.symmetric(), s.vector());
        let of_norm = bracket(&hat(&m), &j).scaled(2.0);
        let of_trace: Vector = from_fn(|a| {
            let e: Vector = from_fn(|b| if a == b { 1.0 } else { 0.0 });
            (j * bracket(&hat(&e), &j)).trace() * 2.0
        });
        (size(&of_norm), length(&of_trace))
    });
}

#[test]
fn two_145_the_velocity_acts_from_the_right() {
    judge("(2.145)", |s| {
        let (p, here, w) = (s.matrix(), s.orthogonal(), s.orthogonal());
        let next = here * w;
        // The spatial momentum skew(P Λᵀ) is conserved (2.83).
        let momentum = |p: &Matrix, g: &Matrix| skew(&(*p * g.transpose()));
        let before = momentum(&p, &here);
        let printed = momentum(&(w * p), &next);
        let right = momentum(&(p * w), &next);
        (size(&(printed - before)), size(&(right - before)))
    });
}

#[test]
fn two_156_has_no_square_of_the_step() {
    judge("(2.156)", |s| {
        let (h, j, w) = (s.between(0.1, 0.5), s.positive(), s.orthogonal());
        let wanted = j * w.transpose() - w * j;
        let twice = skew(&(j * w.transpose())).scaled(2.0);
        let printed = twice.scaled(1.0 / (h * h));
        (size(&(printed - wanted)), size(&(twice - wanted)))
    });
}

/// A top with the potential at the start of the edge, as in (2.142).
type ThesisTop = HeavyTop<2>;

#[test]
fn two_154_to_two_157_the_coadjoint_action_is_that_of_the_velocity() {
    judge("(2.155), first line", |s| {
        let top = ThesisTop::random(s);
        let nodes: [[Matrix; 1]; 3] = from_fn(|_| ThesisTop::node(s));
        let wanted = residual(&top, &nodes);
        let w: [Matrix; 2] = from_fn(|k| nodes[k][0].transpose() * nodes[k + 1][0]);
        let m = w.map(|w| top.second_moment * w.transpose() - w * top.second_moment);
        let gamma = nodes[1][0].transpose().apply(&top.vertical);
        // ∇ℓ ◇ Γ = (h² gU × Γ)^.
        let force = hat(&cross(&top.lever, &gamma).map(|x| top.h * top.h * x));
        let off = |carried: Matrix| {
            let law = vee(&(m[1] - carried - force)).map(|x| x / top.h);
            length(&from_fn(|i| law[i] - wanted[i]))
        };
        (
            off(ad_star(&w[0].transpose(), &m[0])),
            off(ad_star(&w[0], &m[0])),
        )
    });
}

#[test]
fn two_155_the_vertical_is_carried_back() {
    judge("(2.155), second line", |s| {
        let (z, here, w): (Vector, Matrix, Matrix) = (s.vector(), s.orthogonal(), s.orthogonal());
        let gamma = here.transpose().apply(&z);
        let next = here * w;
        let off = |carried: Vector| length(&minus(&next.apply(&carried), &z));
        (off(w.apply(&gamma)), off(w.transpose().apply(&gamma)))
    });
    let top = |update: &str| {
        derive_source(&format!(
            "model Top {{ param J: Sym<3>; param gU: Vec<3>; group Λ: SO<3> velocity Ω;
             advected Γ: Vec<3>; constraint next(Λ) = Λ*Ω; constraint next(Γ) = {update};
             lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ); }}"
        ))
    };
    let refused = top("Ω*Γ")
        .expect_err("the engine takes the printed form")
        .to_string();
    assert!(refused.contains("not advected by the group"), "{refused}");
    assert!(top("Ω^T*Γ").is_ok());
}

/// The physical coupling over one step, times -h: `ε <Λ1' d1 - Λ1 d1, Λ2' d2 - Λ2 d2>`.
fn coupling(eps: f64, d: &[Vector; 2], w: &[Matrix; 2], relative: &Matrix) -> f64 {
    let change = |i: usize| (w[i] - id()).apply(&d[i]);
    eps * dot(&change(0), &relative.apply(&change(1)))
}

#[test]
fn two_165_and_two_166_the_matrix_of_the_vector_form_stands_under_the_trace() {
    judge("(2.166)", |s| {
        let (eps, d): (f64, [Vector; 2]) = (s.between(0.5, 1.0), from_fn(|_| s.vector()));
        let (w, relative): ([Matrix; 2], Matrix) = (from_fn(|_| s.orthogonal()), s.orthogonal());
        let wanted = coupling(eps, &d, &w, &relative);
        let trace = |middle: Matrix, last: Matrix| {
            eps * ((id() - w[0].transpose()) * middle * (id() - w[1]) * last).trace()
        };
        let printed = trace(hat(&d[0]).transpose() * relative * hat(&d[1]), id());
        let right = trace(relative, outer(&d[1], &d[0]));
        ((printed - wanted).abs(), (right - wanted).abs())
    });
}

#[test]
fn two_147ff_the_inertia_of_a_body_off_its_joint_grows() {
    // Kinetic energy of the point mass at d that rotates with velocity ω: ε |ω × d|²/2.
    judge("modified inertia", |s| {
        let (eps, d, w): (f64, Vector, Vector) = (s.between(0.5, 1.0), s.vector(), s.vector());
        let moved = cross(&w, &d);
        let wanted = 0.5 * eps * dot(&moved, &moved);
        let energy = |i: Matrix| 0.5 * dot(&w, &i.apply(&w));
        let square = hat(&d) * hat(&d);
        let printed = energy(square.scaled(eps));
        let right = energy(square.scaled(-eps));
        ((printed - wanted).abs(), (right - wanted).abs())
    });
}

#[test]
fn two_171_has_the_sign_of_the_multiplier_reversed() {
    judge("(2.171)", |s| {
        let (here, next): (Matrix, Matrix) = (s.matrix(), s.matrix());
        let (w, change): ([Matrix; 2], Matrix) = (from_fn(|_| s.orthogonal()), s.matrix());
        // The terms of the multiplier at node k on both edges, along a variation of Λ_k.
        let slope = inner(&here, &change) - inner(&next, &(w[0].transpose() * change * w[1]));
        let carried = w[0] * next * w[1].transpose();
        let printed = inner(&(carried - here), &change);
        let right = inner(&(here - carried), &change);
        ((printed - slope).abs(), (right - slope).abs())
    });
}

/// The thesis's quantities of the coupled bodies on one edge: momenta, `Λ ∇ℓᵀ` and `Λᵀ ∇ℓ`.
fn coupled_edge(
    system: &CoupledBodies<true>,
    tail: &[Matrix; 2],
    head: &[Matrix; 2],
    factors: impl Fn(&[Matrix; 2], &Matrix) -> ([Matrix; 2], Matrix),
) -> ([Matrix; 2], [Matrix; 2], [Matrix; 2]) {
    let w: [Matrix; 2] = from_fn(|i| tail[i].transpose() * head[i]);
    let relative = tail[0].transpose() * tail[1];
    let (coupled, gradient) = factors(&w, &relative);
    let momentum = from_fn(|i| {
        let c = system.second_moments[i] + coupled[i];
        c * w[i].transpose() - w[i] * c.transpose()
    });
    let forces = [
        relative * gradient.transpose(),
        relative.transpose() * gradient,
    ];
    (w, momentum, forces)
}

/// The distance of the law (2.184), with a weight on its last term, from the oracle.
fn coupled_law(s: &mut Source, weight: f64, vector_form: bool) -> f64 {
    let system = CoupledBodies::<true>::random(s);
    let nodes: [[Matrix; 2]; 3] = from_fn(|_| CoupledBodies::<true>::node(s));
    let wanted = residual(&system, &nodes);
    let (eps, [d1, d2]) = (system.reduced_mass, system.arms);
    let factors = |w: &[Matrix; 2], r: &Matrix| {
        if vector_form {
            // (2.172) and (2.175) as printed.
            let a = hat(&d1).transpose() * *r * hat(&d2);
            let gradient =
                hat(&d1) * (id() - w[0]) * (id() - w[1].transpose()) * hat(&d2).transpose();
            let coupled = [a * (w[1] - id()), a.transpose() * (w[0] - id())];
            return (coupled.map(|c| c.scaled(eps)), gradient.scaled(eps));
        }
        let still = |i: usize, d: &Vector| (id() - w[i]).apply(d);
        let gradient = outer(&still(0, &d1), &still(1, &d2)).scaled(eps);
        let moved = |i: usize, d: &Vector| (w[i] - id()).apply(d);
        let coupled = [
            outer(&r.apply(&moved(1, &d2)), &d1).scaled(eps),
            outer(&r.transpose().apply(&moved(0, &d1)), &d2).scaled(eps),
        ];
        (coupled, gradient)
    };
    let (w, before, _) = coupled_edge(&system, &nodes[0], &nodes[1], factors);
    let (_, after, forces) = coupled_edge(&system, &nodes[1], &nodes[2], factors);
    let off = |i: usize| {
        let force = skew(&forces[i]).scaled(weight);
        let law = vee(&(after[i] - ad_star(&w[i], &before[i]) - force));
        length(&from_fn(|k| law[k] / system.h - wanted[3 * i + k]))
    };
    worse(off(0), off(1))
}

#[test]
fn two_176_to_two_183_the_last_term_is_twice_the_skew_part() {
    judge("(2.182), (2.183)", |s| {
        let again = s.clone();
        (
            coupled_law(s, 1.0, false),
            coupled_law(&mut again.clone(), 2.0, false),
        )
    });
}

#[test]
fn two_172_and_two_175_belong_to_the_vector_form() {
    judge("(2.172), (2.175)", |s| {
        let again = s.clone();
        (
            coupled_law(s, 2.0, true),
            coupled_law(&mut again.clone(), 2.0, false),
        )
    });
}

#[test]
fn two_178_has_the_actions_of_both_bodies_exchanged() {
    judge("(2.178)", |s| {
        let (g, relative): (Matrix, Matrix) = (s.matrix(), s.orthogonal());
        let zeta: Matrix = s.skew();
        // The first body's part of (2.180), with 2 skew and with the pairing of so(3) by half the trace.
        let map = inner(&(relative * g.transpose()), &zeta);
        let printed = inner(&g, &(relative * zeta));
        let right = inner(&g, &(zeta * relative).scaled(-1.0));
        ((printed - map).abs(), (right - map).abs())
    });
}

#[test]
fn tables_a_1_and_a_2_have_the_momentum_map_transposed() {
    judge("table A.2", |s| {
        let (p, g, zeta): (Matrix, Matrix, Matrix) = (s.matrix(), s.orthogonal(), s.skew());
        // <J, ζ> = <P, Λ ζ> (2.80).
        let wanted = inner(&p, &(g * zeta));
        let printed = inner(&skew(&(g * p.transpose())), &zeta);
        let right = inner(&skew(&(g.transpose() * p)), &zeta);
        ((printed - wanted).abs(), (right - wanted).abs())
    });
}

#[test]
fn appendix_a_3_divides_by_the_old_tensor() {
    judge("A.3, step 6", |s| {
        let (w, j): (Matrix, Matrix) = (s.orthogonal(), s.positive());
        // S + A equals ω times the tensor before the step.
        let (x, next) = (w * j, w * j * w.transpose());
        let off = |candidate: Matrix| size(&(candidate - w));
        (off(x * next.inverse()), off(x * j.inverse()))
    });
}

#[test]
fn two_77_the_multiplier_of_orthogonality_counts_twice() {
    judge("(2.77)", |s| {
        let (theta, w, change): (Matrix, Matrix, Matrix) =
            (s.symmetric(), s.orthogonal(), s.matrix());
        // tr(Θ (Ω Ωᵀ - 1)) along a change of Ω, quadratic: the central difference is exact.
        let at = |e: f64| {
            let w = w + change.scaled(e);
            (theta * (w * w.transpose() - id())).trace()
        };
        let slope = 0.5 * (at(1.0) - at(-1.0));
        let gradient = theta * w;
        (
            (inner(&gradient, &change) - slope).abs(),
            (2.0 * inner(&gradient, &change) - slope).abs(),
        )
    });
}

#[test]
fn two_27_the_matrix_of_second_moments_is_no_inertia_matrix() {
    judge("inertia matrix of (2.27)", |s| {
        let (second, w): (Matrix, Vector) = (s.positive(), s.vector());
        // The limit of the action: tr(ξ I0 ξᵀ)/2 with ξ = hat(ω).
        let xi = hat(&w);
        let wanted = 0.5 * (xi * second * xi.transpose()).trace();
        let energy = |inertia: Matrix| 0.5 * dot(&w, &inertia.apply(&w));
        let right = id().scaled(second.trace()) - second;
        (
            (energy(second) - wanted).abs(),
            (energy(right) - wanted).abs(),
        )
    });
}

#[test]
fn appendix_a_3_formula_for_the_velocity() {
    judge("(A.3)", |s| {
        let (w, j): (Matrix, Matrix) = (s.orthogonal(), s.positive());
        // With the sign of the thesis; S is the symmetric part of Ω I.
        let (m, symmetric) = (j * w.transpose() - w * j, sym(&(w * j)));
        let printed = j.inverse() * (symmetric - m);
        let right = (symmetric - m.scaled(0.5)) * j.inverse();
        (size(&(printed - w)), size(&(right - w)))
    });
    judge("(A.2), second line", |s| {
        // Each momentum is the momentum of its own body plus its coupling.
        let (w, j, coupled): ([Matrix; 2], [Matrix; 2], Matrix) = (
            from_fn(|_| s.orthogonal()),
            from_fn(|_| s.positive()),
            s.matrix(),
        );
        let momentum = |c: Matrix, w: Matrix| c * w.transpose() - w * c.transpose();
        let wanted = momentum(j[1] + coupled, w[1]);
        let with = |own: Matrix| size(&(own + momentum(coupled, w[1]) - wanted));
        (with(momentum(j[0], w[0])), with(momentum(j[1], w[1])))
    });
}
