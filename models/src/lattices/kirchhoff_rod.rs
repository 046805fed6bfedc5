//! An inextensible rod, compiled for every number of sections.

clebsch::model! {
    /// An inextensible rod without shear, by Kirchhoff: places of its centreline at nodes, attitudes of its
    /// sections at segments, and the force that keeps each segment along the third axis of its section.
    pub model KirchhoffRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half at an end
        param m: Real at nodes;
        /// second moments of mass of a unit length, frame of the section
        param J: Sym<3> at segments;
        /// stiffness against bending and twist, as second moments: B with tr(B) Id - B the stiffness
        param B: Sym<3>;
        /// acceleration of gravity, space frame
        param g: Vec<3>;
        /// place of a node
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
