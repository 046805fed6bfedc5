//! Five random Lagrangians typed as model invocations: what the macro makes of a model nobody has seen.
//! The text is the generator's own; a test holds it against the generator.

use clebsch_tests::oracle::random::RandomLagrangian;

/// The seeds of the models below: powers of the velocity with a name for its skew part; another name of the
/// step; the spatial side with a skew and a plain matrix; one-sided nodes; a scaled Lagrangian with a root.
pub const SEEDS: [u64; 5] = [23, 29, 45, 48, 217];

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
    pub model Random29 {
        time i step s;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        param J: Sym<3>;
        param q: Vec<3>;
        param p: Vec<3>;
        param X: Sym<3>;
        param P: Sym<3>;
        advected a: Vec<3> = Λ^T*(p + p);
        constraint next(a) = Ω^T*a;
        advected ξ: Vec<3>;
        constraint next(ξ) = Ω^T*ξ;
        advected eta: Sym<3> = Λ^T*X*Λ;
        constraint next(eta) = Ω^T*eta*Ω;
        lagrangian = -tr(J*Ω)/s - s*dot(a, Ω*ξ) + tr(Ω^T*Ω^T*eta) + (dot(vee(eta - eta^T), cross(q, a)) - dot(ξ, P*a)^2)/s + 0.75*exp(dot(p, ξ)/4);
    }
}

clebsch::model! {
    pub model Random45 {
        group Λ: SO<3> velocity ω;
        constraint next(Λ) = ω*Λ;
        param J: Sym<3>;
        param u: Real;
        param ρ: Vec<3>;
        param J0: Vec<3>;
        param C: Sym<3>;
        advected c: Vec<3>;
        constraint next(c) = ω*c;
        advected b: Vec<3> = Λ*ρ;
        constraint next(b) = ω*b;
        advected a: Sym<3> = Λ*C*Λ^T;
        constraint next(a) = ω*a*ω^T;
        advected N: Skew<3>;
        constraint next(N) = ω*N*ω^T;
        advected ξ: Mat<3>;
        constraint next(ξ) = ω*ξ;
        lagrangian = -tr(J ω)/h - dot(c, next(a)*b) + tr(N*J*ξ)/(2*h) + h*u*dot(J0, next(b)) - h*u*-dot(c, ω*b);
    }
}

clebsch::model! {
    pub model Random48 {
        node incoming;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        param J: Sym<3>;
        param p: Vec<3>;
        param α: Sym<3>;
        advected a: Vec<3>;
        constraint next(a) = Ω^T*a;
        lagrangian = -tr(J*Ω)/h + h^2*(dot(p, next(a)) - tr((α)));
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
    let here = bare(include_str!("mod.rs"));
    SEEDS
        .iter()
        .map(|&seed| RandomLagrangian::of_seed(seed).text())
        .filter(|text| !here.contains(&bare(text)))
        .collect()
}
