//! A rod of uniform tension, compiled for every number of sections.

clebsch::model! {
    /// Kirchhoff rod of uniform tension, without inertia of the centreline.
    /// The unknowns are the attitudes of the cross-sections, whose third axes are tangent to the centreline, and one force that
    /// keeps the two ends X apart.
    pub model UniformTensionRod {
        label i in 0..N step s;
        periodic;
        /// second moments of mass per unit length, section frame
        param J: Sym<3> at segments;
        /// bending and torsional stiffness as a second-moment matrix, section frame: the stiffness is tr(B) Id - B
        param B: Sym<3>;
        /// vector from the first end to the last, space frame; zero for a closed rod
        param X: Vec<3>;
        group Λ: SO<3> at segments velocity Ω;
        constraint next(Λ) = Λ*Ω;
        hold p: sum(s*Λ*E3) = X;
        lagrangian = -s*tr(J*Ω)/h + (h/s)*tr(B*Λ^T*next(Λ, i));
        end i = 0 {
            free;
            clamped { param Λw: SO<3>; term (2*h/s)*tr(B*Λw^T*Λ); }
        }
        end i = N {
            free;
            clamped { param Λw: SO<3>; term (2*h/s)*tr(B*Λ^T*Λw); }
        }
    }
}
