//! A geometrically exact elastic rod, compiled for every number of sections.

clebsch::model! {
    /// A geometrically exact elastic rod: places of its centreline at nodes, attitudes of its sections
    /// at segments.
    pub model GeometricallyExactRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half at an end
        param m: Real at nodes;
        /// second moments of mass of a unit length, frame of the section
        param J: Sym<3> at segments;
        /// stiffness against shear and extension, frame of the section
        param S: Sym<3>;
        /// stiffness against bending and twist, as second moments: B with tr(B) Id - B the stiffness
        param B: Sym<3>;
        /// acceleration of gravity, space frame
        param g: Vec<3>;
        /// place of a node; once around a ring it grows by X
        field φ: Vec<3> at nodes offset X;
        group Λ: SO<3> at segments velocity Ω;
        constraint next(Λ) = Λ*Ω;
        let V = (next(φ) - φ)/h;
        let F = Λ^T*(next(φ, i) - φ)/s - E3;
        lagrangian = h*m*(dot(V, V)/2 + dot(g, φ)) - s*tr(J*Ω)/h - (h*s/2)*dot(F, S*F)
            + (h/s)*tr(B*(Λ^T*next(Λ, i) - Id));
        end i = 0 {
            free;
            pinned { φ = given; }
            clamped { param Λw: SO<3>; φ = given; term (2*h/s)*tr(B*(Λw^T*Λ - Id)); }
        }
        end i = N {
            free;
            pinned { φ = given; }
            clamped { param Λw: SO<3>; φ = given; term (2*h/s)*tr(B*(Λw^T*Λ - Id)); }
            load { param force: Vec<3>; term h*dot(force, φ); }
        }
    }
}
