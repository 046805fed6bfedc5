//! A geometrically exact elastic rod in unit quaternions, compiled for every number of sections.

clebsch::model! {
    /// Geometrically exact elastic rod with the attitudes of its cross-sections as unit quaternions.
    /// Positions of the centreline are at nodes, attitudes at segments. The bending and torsional strain is the imaginary part
    /// of the relative quaternion of adjacent cross-sections.
    pub model QuaternionRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half as much at an end
        param m: Real at nodes;
        /// moments of inertia per unit length, section frame
        param I: Sym<3> at segments;
        /// shear and extensional stiffness, section frame
        param S: Sym<3>;
        /// bending and torsional stiffness, section frame
        param K: Sym<3>;
        /// gravitational acceleration, space frame
        param g: Vec<3>;
        /// position of a node, space frame
        field φ: Vec<3> at nodes offset X;
        group q: SU<2> at segments velocity W;
        constraint next(q) = q*W;
        let V = (next(φ) - φ)/h;
        let F = rot(q)^T*(next(φ, i) - φ)/s - E3;
        let U = im(q^T*next(q, i));
        lagrangian = h*m*(dot(V, V)/2 + dot(g, φ)) + (2*s/h)*dot(im(W), I*im(W)) - (h*s/2)*dot(F, S*F)
            - (2*h/s)*dot(U, K*U);
        end i = 0 {
            free;
            pinned { φ = given; }
            clamped { param qw: SU<2>; φ = given; term -(4*h/s)*dot(im(qw^T*q), K*im(qw^T*q)); }
        }
        end i = N {
            free;
            pinned { φ = given; }
            load { param force: Vec<3>; term h*dot(force, φ); }
        }
    }
}
