//! Five random Lagrangians typed as model invocations: what the macro makes of a model nobody has seen.
//! The text is the generator's own; a test holds it against the generator.

use clebsch_oracle::oracle::random::RandomLagrangian;

/// The seeds of the models below: powers of the velocity with a name for its skew part; a quotient by an
/// advected quantity; one-sided nodes with triple products and an inverse; the spatial side with another name
/// of the step; a scaled Lagrangian with a root.
pub const SEEDS: [u64; 5] = [23, 26, 34, 117, 217];

clebsch::model! {
    pub model Random23 {
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        param J: Sym<3>;
        param L: Real;
        param κ: Vec<3>;
        param U: Sym<3>;
        advected c: Sym<3>;
        constraint next(c) = Ω^T*c*Ω;
        advected χ: Sym<3>;
        constraint next(χ) = Ω^T*χ*Ω;
        let part = skew((-Ω));
        lagrangian = -tr(J*Ω)/h + h L*tr(Ω*Ω*c) - tr(χ*U*χ) - dot(κ, vee(skew(part)));
    }
}

clebsch::model! {
    pub model Random26 {
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        param J: Sym<3>;
        param K_a: Vec<3>;
        advected b: Vec<3> = Λ^T*K_a;
        constraint next(b) = Ω^T*b;
        advected ξ: Vec<3> = Λ^T*(K_a + K_a);
        constraint next(ξ) = Ω^T*ξ;
        lagrangian = -tr(J Ω)/h + tr(Ω^-1)/(2 + dot(K_a, ξ)^2)/(2*h) + (tr(J*(K_a*b^T)));
    }
}

clebsch::model! {
    pub model Random34 {
        node incoming;
        group Lambda: SO<3> velocity Omega;
        constraint next(Lambda) = Lambda*Omega;
        param J: Sym<3>;
        param α: Real;
        param L: Vec<3>;
        param lever: Sym<3>;
        advected Y: Vec<3> = Lambda^T*(L + L);
        constraint next(Y) = Omega^T*Y;
        advected eta: Vec<3> = Lambda^T*L;
        constraint next(eta) = Omega^T*eta;
        let part = inv(J);
        lagrangian = -tr(J*Omega)/h - dot(part*(lever*L), cross(eta, L)) + 0.75 det(Omega^T + Omega) + h*α*dot(L, cross(Y, next(eta))) - (h/2)*sqrt(1 + dot(part*(Omega*L), part*(Omega*L)))^2;
    }
}

clebsch::model! {
    pub model Random117 {
        time i step s;
        scale 2*s;
        group Q: SO<3> velocity omega;
        constraint next(Q) = omega*Q;
        param J: Sym<3>;
        param α: Vec<3>;
        advected c: Vec<3>;
        constraint next(c) = omega*c;
        advected a: Vec<3> = Q*α;
        constraint next(a) = omega*a;
        advected Γ: Sym<3>;
        constraint next(Γ) = omega*Γ*omega^T;
        lagrangian = -tr(omega*J)/s - (s/2)*dot(a, omega^T*c) + s*dot(α, Γ*c);
    }
}

clebsch::model! {
    pub model Random217 {
        scale 2*h;
        group Lambda: SO<3> velocity Omega;
        constraint next(Lambda) = Lambda*Omega;
        param J: Sym<3>;
        param mass: Vec<3>;
        param C: Sym<3>;
        advected eta: Vec<3> = Lambda^T*mass;
        constraint next(eta) = Omega^T*eta;
        advected a: Sym<3> = Lambda^T*C*Lambda;
        constraint next(a) = Omega^T*a*Omega;
        advected ξ: Sym<3>;
        constraint next(ξ) = Omega^T*ξ*Omega;
        lagrangian = -tr(Omega*J)/h + 0.75*tr(Omega) + 0.75*sqrt(1 + dot(ξ*Omega^T*eta, ξ*Omega^T*eta)) + tr(ξ*a*C);
    }
}

/// The generator's texts that this file does not hold.
pub fn stale() -> Vec<String> {
    let bare = |text: &str| text.split_whitespace().collect::<String>();
    let here = bare(include_str!("oracle_typed.rs"));
    SEEDS
        .iter()
        .map(|&seed| RandomLagrangian::of_seed(seed).text())
        .filter(|text| !here.contains(&bare(text)))
        .collect()
}
