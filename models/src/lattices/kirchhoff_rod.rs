//! An inextensible rod, compiled for every number of sections.

clebsch::model! {
    /// Inextensible, unshearable Kirchhoff rod: positions of the centreline at nodes, attitudes of the cross-sections at segments.
    /// The constraint force n keeps each segment parallel to the third axis of its cross-section.
    pub model KirchhoffRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half as much at an end
        param m: Real at nodes;
        /// second moments of mass per unit length, section frame
        param J: Sym<3> at segments;
        /// bending and torsional stiffness as a second-moment matrix, section frame: the stiffness is tr(B) Id - B
        param B: Sym<3>;
        /// gravitational acceleration, space frame
        param g: Vec<3>;
        /// position of a node, space frame
        field φ: Vec<3> at nodes offset X;
        group Λ: SO<3> at segments velocity Ω;
        constraint next(Λ) = Λ*Ω;
        hold n: next(φ, i) - φ = s*Λ*E3;
        let V = (next(φ) - φ)/h;
        lagrangian = h*m*(dot(V, V)/2 + dot(g, φ)) - s*tr(J*Ω)/h + (h/s)*tr(B*Λ^T*next(Λ, i));
        end i = 0 {
            free;
            pinned { φ = given; }
            clamped { param Λw: SO<3>; φ = given; term (2*h/s)*tr(B*Λw^T*Λ); }
        }
        end i = N {
            free;
            pinned { φ = given; }
            load { param force: Vec<3>; term h*dot(force, φ); }
        }
    }
}
