//! A geometrically exact elastic rod, compiled for every number of sections.

clebsch::model! {
    /// Geometrically exact elastic rod: positions of the centreline at nodes, attitudes of the cross-sections at segments.
    pub model GeometricallyExactRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half as much at an end
        param m: Real at nodes;
        /// second moments of mass per unit length, section frame
        param J: Sym<3> at segments;
        /// shear and extensional stiffness, section frame
        param S: Sym<3>;
        /// bending and torsional stiffness as a second-moment matrix, section frame: the stiffness is tr(B) Id - B
        param B: Sym<3>;
        /// gravitational acceleration, space frame
        param g: Vec<3>;
        /// position of a node, space frame; it increases by X once around a ring
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
