//! A rod of uniform tension, compiled for every number of sections.

clebsch::model! {
    /// A rod of Kirchhoff's whose tension is the same everywhere: attitudes of its sections, whose third axes are the tangent
    /// of its centreline, and one force that keeps its two ends X apart. The centreline has no inertia of its own.
    pub model UniformTensionRod {
        label i in 0..N step s;
        periodic;
        /// second moments of mass of a unit length, frame of the section
        param J: Sym<3> at segments;
        /// stiffness against bending and twist, as second moments: B with tr(B) Id - B the stiffness
        param B: Sym<3>;
        /// from the first end to the last one; of a closed rod zero
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
