//! A geometrically exact elastic rod in unit quaternions, compiled for every number of sections.

clebsch::model! {
    /// A geometrically exact elastic rod: places of its centreline at nodes, attitudes of its sections at
    /// segments, by unit quaternions. The strain of bending and twist is the imaginary part of the quaternion from one
    /// section to the next.
    pub model QuaternionRod {
        label i in 0..N step s;
        periodic;
        /// mass of a node; half at an end
        param m: Real at nodes;
        /// moments of inertia of a unit length, frame of the section
        param I: Sym<3> at segments;
        /// stiffness against shear and extension, frame of the section
        param S: Sym<3>;
        /// stiffness against bending and twist, frame of the section
        param K: Sym<3>;
        /// acceleration of gravity, space frame
        param g: Vec<3>;
        /// place of a node
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
