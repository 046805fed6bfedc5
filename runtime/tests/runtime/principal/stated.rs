//! Models that use Newton's method, on every group, with potentials and terms linear in the velocity.

clebsch::model! {
    /// Two bodies with a joint.
    pub model Pair {
        param J1, J2: Sym<3>;
        param d1, d2: Vec<3>;
        param eps, k: Real;
        group Λ1: SO<3> velocity Ω1;
        group Λ2: SO<3> velocity Ω2;
        advected R: SO<3> = Λ1^T*Λ2;
        constraint next(Λ1) = Λ1*Ω1;
        constraint next(Λ2) = Λ2*Ω2;
        constraint next(R) = Ω1^T*R*Ω2;
        lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h - h*k*dot(d1, R*d2);
    }
}

clebsch::model! {
    /// A rigid body in an ideal fluid, with net weight.
    pub model FluidBody {
        param J, M: Sym<3>;
        param D: Mat<3>;
        param b, Z: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(vee(rot(V)), D*u)/h - h*dot(b, P);
    }
}

clebsch::model! {
    /// A charged top in a magnetic field: a term linear in the velocity.
    pub model ChargedTop {
        param J: Sym<3>;
        param a, z, B: Vec<3>;
        param q, c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        advected F: Vec<3> = Λ^T*B;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        constraint next(F) = Ω^T*F;
        lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h + q*dot(F, vee(Ω)) - h*dot(a, Γ);
    }
}

clebsch::model! {
    /// Three bodies with springs from one to the next.
    pub model ThreeSprings {
        param J1, J2, J3: Sym<3>;
        param m, k: Real;
        param a, b: Vec<3>;
        group G1: SE<3> velocity V1;
        group G2: SE<3> velocity V2;
        group G3: SE<3> velocity V3;
        constraint next(G1) = G1*V1;
        constraint next(G2) = G2*V2;
        constraint next(G3) = G3*V3;
        let s = pos(G1) + rot(G1)*a - pos(G2) - rot(G2)*b;
        let t = pos(G2) + rot(G2)*a - pos(G3) - rot(G3)*b;
        lagrangian = -(tr(J1*rot(V1)) + tr(J2*rot(V2)) + tr(J3*rot(V3)))/h
            + m*(dot(pos(V1), pos(V1)) + dot(pos(V2), pos(V2)) + dot(pos(V3), pos(V3)))/(2*h)
            - h*k*(dot(s, s) + dot(t, t))/2;
    }
}

clebsch::model! {
    /// Three frames coupled elastically.
    pub model Frames {
        param J1, J2, J3: Sym<3>;
        param k, c: Real;
        group Λ1: SO<3> velocity Ω1;
        group Λ2: SO<3> velocity Ω2;
        group Λ3: SO<3> velocity Ω3;
        constraint next(Λ1) = Λ1*Ω1;
        constraint next(Λ2) = Λ2*Ω2;
        constraint next(Λ3) = Λ3*Ω3;
        lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + tr(J3*Ω3))/h + h*k*(tr(Λ1^T*Λ2) + tr(Λ2^T*Λ3))
            + c*dot(vee(Ω1), vee(Ω2))/h;
    }
}

clebsch::model! {
    /// An inertia that varies with the attitude.
    pub model Varying {
        param J: Sym<3>;
        param a, z: Vec<3>;
        param c, d: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -(1 + c*dot(a, Γ)^2)*tr(J*Ω)/h - d*tr(J*Ω)^2/h - h*dot(a, Γ);
    }
}

clebsch::model! {
    /// In unit quaternions, with a momentum that does not come from a quadratic form.
    pub model StiffQuaternion {
        param S: Sym<3>;
        param c: Real;
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        lagrangian = (2/h)*dot(im(W), S*im(W)) + (2*c/h)*dot(im(W), S*im(W))^2 - (4*c/h)*re(W);
    }
}

clebsch::model! {
    /// Bodies in different groups.
    pub model MixedPair {
        param J, S: Sym<3>;
        param a: Vec<3>;
        param eps: Real;
        group Λ: SO<3> velocity Ω;
        group q: SU<2> velocity W;
        constraint next(Λ) = Λ*Ω;
        constraint next(q) = q*W;
        lagrangian = -tr(J*Ω)/h + (2/h)*dot(im(W), S*im(W)) + eps*dot(im(W), Ω*a)*re(W)/h;
    }
}

clebsch::model! {
    /// A Lagrangian in four dimensions that is not linear in the velocity.
    pub model StiffBody {
        param J: Sym<4>;
        param c: Real;
        group Λ: SO<4> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h;
    }
}

clebsch::model! {
    /// An ellipsoid of changing shape.
    pub model Ellipsoid {
        param I0: Sym<3>;
        param k: Real;
        group Q: GL<3> velocity G;
        constraint next(Q) = Q*G;
        lagrangian = tr((Q*(G - Id))^T*(Q*(G - Id))*I0)/(2*h) - h*k*tr(Q^T*Q)/2;
    }
}

/// Generic Lagrangians on SO(3), not chosen with the solver in mind.
macro_rules! random {
    ($($name:ident: [$($lagrangian:tt)+];)+) => {$(
        clebsch::model! {
            pub model $name {
                param J, S: Sym<3>;
                param a, b, z: Vec<3>;
                param c, d: Real;
                group Λ: SO<3> velocity Ω;
                advected Γ: Vec<3> = Λ^T*z;
                constraint next(Λ) = Λ*Ω;
                constraint next(Γ) = Ω^T*Γ;
                lagrangian = $($lagrangian)+;
            }
        }
    )+};
}

random! {
    Random0: [-tr(J*Ω)/h - c*tr(J*Ω*S*Ω)/h - h*dot(a, Γ)];
    Random1: [-tr(J*Ω)/h + c*dot(vee(Ω), S*vee(Ω))/h + d*dot(b, vee(Ω))];
    Random2: [-tr(J*Ω)/h - c*dot(a, Ω*b)^2/h - h*dot(a, Γ)^2];
    Random3: [-tr(J*Ω)/h - c*tr(J*Ω)*tr(S*Ω)/h + d*dot(Γ, vee(Ω)) - h*dot(a, S*Γ)];
    Random4: [dot(vee(Ω), J*vee(Ω))/(2*h) - c*tr(S*Ω)/h - h*dot(a, Γ)];
    Random5: [-(1 + c*dot(b, Γ)^2)*tr(J*Ω)/h - d*dot(vee(Ω), S*vee(Ω))^2/h];
    Random6: [-tr(J*Ω)/h - c*exp(-tr(S*Ω)/4)/h + d*dot(a, Ω*b)];
    Random7: [-tr(J*Ω)/h + c*dot(vee(Ω*S), a)^2/h - h*dot(a, Γ)*dot(b, Γ)];
    Random8: [-tr(J*Ω*Ω)/(4*h) - c*tr(J*Ω)/h + d*dot(b, vee(Ω)) - h*dot(z, S*Γ)];
    Random9: [-tr(J*Ω)/h + c*dot(Γ, S*vee(Ω))*dot(a, vee(Ω))/h - h*d*dot(Γ, S*Γ)];
}
