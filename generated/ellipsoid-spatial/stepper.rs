// Written by `clebsch derive --write`. Do not edit.

//! The model [`EllipsoidSpatial`](struct@EllipsoidSpatial) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`EllipsoidSpatial`](struct@EllipsoidSpatial).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSpatialParameters<const N: usize, T = f64> {
    /// `C0`: metric of space; a matrix of size n x n, symmetric.
    pub C0: SMatrix<T, N, N>,
    /// `I0`: second moments of mass, reference configuration; a matrix of size n x n, symmetric.
    pub I0: SMatrix<T, N, N>,
    /// `a`: stiffness against changes of length, area and volume; a number.
    pub a: T,
    /// `b`: stiffness against changes of length, area and volume; a number.
    pub b: T,
    /// `c`: stiffness against changes of length, area and volume; a number.
    pub c: T,
    /// `d`: resistance to collapse; the identity is stress-free if d = 2 a + 2 (n - 1) b + 2 c; a number.
    pub d: T,
}
/// Elastic ellipsoid, spatial representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSpatial<const N: usize, T = f64> {
    parameters: EllipsoidSpatialParameters<N, T>,
    inverse_1_left: SMatrix<T, N, N>,
    inverse_1_right: SMatrix<T, N, N>,
}
impl<const N: usize, T: Real> EllipsoidSpatial<N, T> {
    /// Sizes that the model does not admit do not compile.
    const ADMITTED: () = {
        ::core::assert!(2 <= N && N <= 4, "`n` ranges from 2 to 4 in this model");
    };
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Elastic ellipsoid, spatial representation.\npub model EllipsoidSpatial {\n    dim n in 2..=4;\n    /// metric of space\n    param C0: Sym<n> as \"C_0\";\n    /// second moments of mass, reference configuration\n    param I0: Sym<n> as \"I_0\";\n    /// stiffness against changes of length, area and volume\n    param a: Real;\n    /// stiffness against changes of length, area and volume\n    param b: Real;\n    /// stiffness against changes of length, area and volume\n    param c: Real;\n    /// resistance to collapse; the identity is stress-free if d = 2 a + 2 (n - 1) b + 2 c\n    param d: Real;\n    /// placement, reference to space\n    group Q: GL<n> velocity g;\n    /// second moments of mass, space frame\n    advected S: Sym<n> = Q*I0*Q^T;\n    constraint next(Q) = g*Q;\n    constraint next(S) = g*S*g^T;\n    lagrangian = tr(C0*(g - Id)*S*(g^T - Id))/(2*h) - h*(a*tr(S) + (1/2)*b*(tr(S)^2 - tr(S*S)) + c*det(S) - (1/2)*d*log(det(S)));\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 4559964667135079899u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: EllipsoidSpatialParameters<N, T>,
    ) -> Result<Self, ParameterError> {
        let () = Self::ADMITTED;
        validate::finite_entries("C0", &parameters.C0)?;
        validate::symmetric("C0", &parameters.C0)?;
        validate::finite_entries("I0", &parameters.I0)?;
        validate::symmetric("I0", &parameters.I0)?;
        validate::finite("a", &[parameters.a])?;
        validate::finite("b", &[parameters.b])?;
        validate::finite("c", &[parameters.c])?;
        validate::finite("d", &[parameters.d])?;
        let EllipsoidSpatialParameters { C0, I0, .. } = parameters;
        let inverse_1_left = inverse_or_nan(&(C0));
        let inverse_1_right = inverse_or_nan(&(I0));
        Ok(Self {
            parameters,
            inverse_1_left,
            inverse_1_right,
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSpatialInitial<const N: usize, T = f64> {
    /// `Q` at node 0: body -> space.
    pub Q: Linear<N, T>,
    /// Momentum at node 0, in the space frame.
    pub spatial_momentum: SpatialMomentumMatrix<N, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSpatialState<const N: usize, T = f64> {
    Q: Linear<N, T>,
    momentum: SpatialMomentumMatrix<N, T>,
    node: u64,
}
impl<const N: usize, T: Real> EllipsoidSpatialState<N, T> {
    /// `Q` at this node: body -> space.
    pub fn Q(&self) -> Linear<N, T> {
        self.Q
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum(&self) -> SpatialMomentumMatrix<N, T> {
        self.momentum
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum(&self) -> BodyMomentumMatrix<N, T> {
        self.momentum.to_body(&self.Q)
    }
}
/// The step size, and the last velocities as initial guesses for the next step.
#[derive(Clone, Copy, Debug)]
pub struct EllipsoidSpatialWorkspace<const N: usize, T = f64> {
    h: T,
}
impl<const N: usize, T: Real> EllipsoidSpatial<N, T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &EllipsoidSpatialState<N, T>,
        h: T,
        _: (),
    ) -> Result<EllipsoidSpatialWorkspace<N, T>, StartError> {
        {
            let EllipsoidSpatialParameters { I0, .. } = self.parameters;
            let Q = state.Q.matrix();
            let S = Q * (I0 * Q.transpose());
            validate::defined(
                domain::Domain::Positive,
                domain::Function::Log,
                "det(S_k)",
                determinant(&S),
            )?;
        }
        Ok(EllipsoidSpatialWorkspace { h })
    }
    /// One step, in place. Method: two small linear systems, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved or leaves the domain of the model. The error gives numbers
    /// and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut EllipsoidSpatialState<N, T>,
        work: &mut EllipsoidSpatialWorkspace<N, T>,
    ) -> Result<(), StepError> {
        let before = *state;
        self.step_untested(state, work)?;
        let finite = all_finite(&state.momentum.0);
        match self.stays_inside(&before, state, work.h) {
            Ok(()) if finite => Ok(()),
            Err(contact) if finite || contact.is_finite() => {
                *state = before;
                Err(self.left_domain(state, work.h, contact))
            }
            _ => {
                *state = before;
                Err(StepCause::not_finite("momentum").at_node(state.node))
            }
        }
    }
    /// Reports where the step leaves the domain, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn left_domain(
        &self,
        state: &EllipsoidSpatialState<N, T>,
        h: T,
        contact: domain::Contact,
    ) -> StepError {
        let contact = contact
            .with_trials(
                h,
                |h| {
                    let mut moving = *state;
                    self.step(&mut moving, &mut EllipsoidSpatialWorkspace { h }).is_ok()
                },
            );
        StepCause::from(contact).at_node(state.node)
    }
    /// Whether the step from one state to the next stays where the model is defined.
    #[inline]
    fn stays_inside(
        &self,
        before: &EllipsoidSpatialState<N, T>,
        after: &EllipsoidSpatialState<N, T>,
        h: T,
    ) -> Result<(), domain::Contact> {
        domain::invertible("Q", &before.Q, &after.Q, h)?;
        {
            let after = self.domain_arguments(after, h);
            if !(domain::Domain::Positive.admits(after[0])) {
                let before = self.domain_arguments(before, h);
                domain::Domain::Positive
                    .at_nodes(
                        &domain::Call {
                            function: domain::Function::Log,
                            argument: "det(S_k)",
                        },
                        before[0],
                        after[0],
                        h,
                    )?;
            }
        }
        let _ = (before, after, h);
        Ok(())
    }
    /// The arguments of the functions that the model uses, at the node of this state.
    #[inline]
    fn domain_arguments(&self, state: &EllipsoidSpatialState<N, T>, h: T) -> [T; 1] {
        let EllipsoidSpatialParameters { I0, .. } = self.parameters;
        let Q = state.Q.matrix();
        let S = Q * (I0 * Q.transpose());
        let _ = (state, h);
        [determinant(&S)]
    }
    /// One step, in place. Method: two small linear systems, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    fn step_untested(
        &self,
        state: &mut EllipsoidSpatialState<N, T>,
        work: &mut EllipsoidSpatialWorkspace<N, T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let EllipsoidSpatialParameters { C0, I0, a, b, c, d, .. } = self.parameters;
        let Q = state.Q.matrix();
        let S = Q * (I0 * Q.transpose());
        let momentum_leaving = state.momentum.0
            - (S * (h * a + h * b * S.trace()) - S * S * (h * b)
                + SMatrix::<T, N, N>::identity()
                    * (h * c * determinant(&S) - T::from_f64(0.5) * h * d));
        let Q_change = match displaced(
            &state.Q,
            &(self.inverse_1_left * h),
            &momentum_leaving,
            &self.inverse_1_right,
            &["C₀/h", "S_k"],
        ) {
            Ok(solved) => solved,
            Err(e) => return Err(StepCause::Singular(e).at_node(state.node)),
        };
        let Q_moved = state.Q.changed(&Q_change);
        let Q_next = Q_moved.matrix();
        let S_next = Q_next * (I0 * Q_next.transpose());
        let momentum_next = momentum_leaving
            + C0 * (Q_change * (I0 * Q_change.transpose())) * (T::from_f64(1.0) / h)
            + S_next * (-(h * a) - h * b * S_next.trace()) + S_next * S_next * (h * b)
            + SMatrix::<T, N, N>::identity()
                * (T::from_f64(0.5) * h * d - h * c * determinant(&S_next));
        state.Q = Q_moved;
        state.momentum = SpatialMomentumMatrix(momentum_next);
        state.node += 1;
        Ok(())
    }
    /// `S` at the node of this state.
    #[inline]
    pub fn S(&self, state: &EllipsoidSpatialState<N, T>) -> SMatrix<T, N, N> {
        let EllipsoidSpatialParameters { I0, .. } = self.parameters;
        let Q = state.Q.matrix();
        Q * (I0 * Q.transpose())
    }
}
::clebsch::stepper! {
    [N] EllipsoidSpatial,
    EllipsoidSpatialParameters { C0, I0, a, b, c, d },
    EllipsoidSpatialInitial { Q, spatial_momentum },
    EllipsoidSpatialState { Q, momentum } at node,
    EllipsoidSpatialWorkspace { h },
    tried {} nothing symmetric judged { (N * N) }
    start { Q, momentum = spatial_momentum }
    observables { state.Q, state.body_momentum, state.spatial_momentum, S }
    invariants { energy, circulation_S_2, circulation_S_4,
        body_momentum_skew_I0_inverse_right }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSpatialConfiguration<const N: usize, T = f64> {
    /// `Q` at the node: body -> space.
    pub Q: Linear<N, T>,
}
impl<const N: usize, T: Real> EllipsoidSpatial<N, T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &EllipsoidSpatialConfiguration<N, T>,
        here: &EllipsoidSpatialConfiguration<N, T>,
        after: &EllipsoidSpatialConfiguration<N, T>,
    ) -> SVector<T, 16> {
        let EllipsoidSpatialParameters { C0, I0, a, b, c, d, .. } = self.parameters;
        let Q_before = before.Q.matrix();
        let S_before = Q_before * (I0 * Q_before.transpose());
        let Q = here.Q.matrix();
        let S = Q * (I0 * Q.transpose());
        let g_before = before.Q.spatial_velocity(&here.Q).matrix();
        let g = here.Q.spatial_velocity(&after.Q).matrix();
        let t1 = h.powi(-1);
        let t2 = g_before - SMatrix::<T, N, N>::identity();
        {
            let parts: [SMatrix<T, N, N>; 1] = [
                S * S * (T::from_f64(2.0) * h * b) - S * (T::from_f64(2.0) * h * a)
                    - S * (T::from_f64(2.0) * h * b * S.trace())
                    - SMatrix::<T, N, N>::identity()
                        * (T::from_f64(2.0) * h * c * determinant(&S))
                    + SMatrix::<T, N, N>::identity() * (h * d)
                    + C0 * (t2 * S_before) * t1
                    + C0
                        * (t2
                            * (S_before
                                * (g_before.transpose() - SMatrix::<T, N, N>::identity())))
                        * t1 - C0 * ((g - SMatrix::<T, N, N>::identity()) * S) * t1,
            ];
            let mut all = SVector::<T, 16>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_matrix(rest, &parts[0]);
            let _ = rest;
            all
        }
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &EllipsoidSpatialState<N, T>) -> SMatrix<T, 16, 16> {
        let EllipsoidSpatialParameters { C0, .. } = self.parameters;
        let S = self.S(state);
        let mut inertia = SMatrix::<T, 16, 16>::zeros();
        for axis in 0..(N * N) {
            let ξ: SMatrix<T, N, N> = matrix_basis::<T, N>(axis);
            let along = {
                let parts: [SMatrix<T, N, N>; 1] = [C0 * (ξ * S)];
                let mut all = SVector::<T, 16>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_matrix(rest, &parts[0]);
                let _ = rest;
                all
            };
            inertia.set_column(axis, &along);
        }
        inertia
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &EllipsoidSpatialState<N, T>) -> (T, T) {
        let EllipsoidSpatialParameters { a, b, c, d, .. } = self.parameters;
        let S = self.S(state);
        let momentum = {
            let parts: [SMatrix<T, N, N>; 1] = [state.spatial_momentum().0];
            let mut all = SVector::<T, 16>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_matrix(rest, &parts[0]);
            let _ = rest;
            all
        };
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, (N * N));
        (
            momentum.dot(&velocity) * T::from_f64(0.5),
            a * S.trace() + T::from_f64(0.5) * b * (S.trace() * S.trace())
                - T::from_f64(0.5) * b * (S * S).trace() + c * determinant(&S)
                - T::from_f64(0.5) * d * determinant(&S).ln(),
        )
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &EllipsoidSpatialState<N, T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `tr(skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k)`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn circulation_S_2(&self, state: &EllipsoidSpatialState<N, T>) -> T {
        let S = self.S(state);
        let m = state.spatial_momentum().0;
        let t1 = skew_part(&(m * inverse_or_nan(&S)));
        (t1 * (S * (t1 * S))).trace()
    }
    /// `tr(skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k)`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn circulation_S_4(&self, state: &EllipsoidSpatialState<N, T>) -> T {
        let S = self.S(state);
        let m = state.spatial_momentum().0;
        let t1 = skew_part(&(m * inverse_or_nan(&S)));
        (t1 * (S * (t1 * (S * (t1 * (S * (t1 * S))))))).trace()
    }
    /// `skew(Q_kᵀ m_k Q_k⁻ᵀ I₀⁻¹)`: Noether: the action is invariant under motions of the body's frame that fix the axis.
    pub fn body_momentum_skew_I0_inverse_right(
        &self,
        state: &EllipsoidSpatialState<N, T>,
    ) -> SMatrix<T, N, N> {
        let EllipsoidSpatialParameters { I0, .. } = self.parameters;
        let Q = state.Q.matrix();
        let m = state.spatial_momentum().0;
        skew_part(&Q.tr_mul(&(m * inverse_or_nan(&Q).tr_mul(&inverse_or_nan(&I0)))))
    }
    /// The discrete energy of the edge between two consecutive states, `2 tr(C₀ (g_k - Id) S_k (g_kᵀ - Id))/(2 h)² + ½ a tr(S_k) + ¼ b tr(S_k)² - ¼ b tr(S_k²) + ½ c det(S_k) - ¼ d log(det(S_k)) + ½ a tr(S_{k+1}) + ¼ b tr(S_{k+1})² - ¼ b tr(S_{k+1}²) + ½ c det(S_{k+1}) - ¼ d log(det(S_{k+1}))`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &EllipsoidSpatialState<N, T>,
        after: &EllipsoidSpatialState<N, T>,
    ) -> T {
        let EllipsoidSpatialParameters { C0, a, b, c, d, .. } = self.parameters;
        let S = self.S(before);
        let S_next = self.S(after);
        let g_matrix = before.Q.spatial_velocity(&after.Q).matrix();
        let t1 = S.trace();
        let t2 = determinant(&S);
        let t3 = S_next.trace();
        let t4 = determinant(&S_next);
        T::from_f64(0.5) * a * t1 + T::from_f64(0.25) * b * (t1 * t1)
            - T::from_f64(0.25) * b * (S * S).trace() + T::from_f64(0.5) * c * t2
            - T::from_f64(0.25) * d * t2.ln() + T::from_f64(0.5) * a * t3
            + T::from_f64(0.25) * b * (t3 * t3)
            - T::from_f64(0.25) * b * (S_next * S_next).trace()
            + T::from_f64(0.5) * c * t4 - T::from_f64(0.25) * d * t4.ln()
            + T::from_f64(0.5)
                * (C0
                    * ((g_matrix - SMatrix::<T, N, N>::identity())
                        * (S * (g_matrix.transpose() - SMatrix::<T, N, N>::identity()))))
                    .trace() / (h * h)
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(
        &self,
        state: &EllipsoidSpatialState<N, T>,
        h: T,
    ) -> Option<EllipsoidSpatialState<N, T>> {
        let mut moving = *state;
        self.step(&mut moving, &mut EllipsoidSpatialWorkspace { h }).ok()?;
        Some(moving)
    }
}
impl<const N: usize> EllipsoidSpatial<N, f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &EllipsoidSpatialState<N, f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let EllipsoidSpatialParameters { I0, a, b, c, d, .. } = self.parameters;
        let S = self.S(state);
        let Q = state.Q.matrix();
        let energies = self.energies(state);
        let s1 = (h * h).sqrt();
        let s2 = (S * S).trace().sqrt();
        let s3 = (b * b).sqrt();
        let s4 = determinant(&S);
        let impulse = s1 * (a * a).sqrt() * s2 + s1 * s3 * s2 * s2
            + s1 * s3 * SMatrix::<T, N, N>::identity().trace().sqrt() * s2 * s2
            + s1 * (c * c).sqrt() * (s4 * s4).sqrt()
            + T::from_f64(0.5) * s1 * (d * d).sqrt();
        let state = &EllipsoidSpatialState {
            momentum: SpatialMomentumMatrix(not_less(state.momentum.0, (0, N), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let m = state.spatial_momentum().0;
        let t1 = m.tr_mul(&Q);
        let t2 = m.tr_mul(&m).trace().sqrt();
        let t3 = inverse_or_nan(&S);
        let t4 = (t3 * t3).trace().sqrt();
        let t5 = (S * S).trace().sqrt();
        let t6 = inverse_or_nan(&Q);
        let t7 = inverse_or_nan(&I0);
        let out = put(
            out,
            [
                energy,
                t2 * t4 * t5 * t2 * t4 * t5,
                t2 * t4 * t5 * t2 * t4 * t5 * t2 * t4 * t5 * t2 * t4 * t5,
            ],
        );
        put(
            out,
            ::core::iter::repeat_n(
                (t6 * (t1 * t1.tr_mul(&t6.transpose()))).trace().sqrt()
                    * (t7 * t7).trace().sqrt(),
                N * N,
            ),
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "EllipsoidSpatial",
        kebab: "ellipsoid-spatial",
        doc: "Elastic ellipsoid, spatial representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  tr(C₀ (g_k - Id) S_k (g_kᵀ - Id))/(2 h) - ½ h a tr(S_k) - ¼ h b tr(S_k)² + ¼ h b tr(S_k²) - ½ h c det(S_k) + ¼ h d log(det(S_k)) - ½ h a tr(S_{k+1}) - ¼ h b tr(S_{k+1})² + ¼ h b tr(S_{k+1}²) - ½ h c det(S_{k+1}) + ¼ h d log(det(S_{k+1}))\nmomentum of Q        C₀ (g_k - Id) S_k g_kᵀ/h\nRiccati form         none; linear, L = C₀/h, R = S_k\ninvariants           energy, circulation_S_2, circulation_S_4, body_momentum_skew_I0_inverse_right\ntime reversal        symmetric: second order\ncertificate          17 identities proved by normal form",
        solver: "Explicit: two small linear systems, because the balance is linear",
        parameters: &[
            Kind::Symmetric.field("C0", [N, N], "metric of space"),
            Kind::Symmetric
                .field("I0", [N, N], "second moments of mass, reference configuration"),
            Kind::Scalar
                .field(
                    "a",
                    [1, 1],
                    "stiffness against changes of length, area and volume",
                ),
            Kind::Scalar
                .field(
                    "b",
                    [1, 1],
                    "stiffness against changes of length, area and volume",
                ),
            Kind::Scalar
                .field(
                    "c",
                    [1, 1],
                    "stiffness against changes of length, area and volume",
                ),
            Kind::Scalar
                .field(
                    "d",
                    [1, 1],
                    "resistance to collapse; the identity is stress-free if d = 2 a + 2 (n - 1) b + 2 c",
                ),
        ],
        initial: &[
            Kind::Matrix.field("Q", [N, N], "placement, reference to space"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [N, N], "momentum, space frame"),
        ],
        observables: &[
            Kind::Matrix.field("Q", [N, N], "placement, reference to space"),
            Kind::BodyMomentum.field("body_momentum", [N, N], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [N, N], "momentum, space frame"),
            Kind::Symmetric.field("S", [N, N], "second moments of mass, space frame"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ tr(m_kᵀ ζ) + a tr(S_k) + ½ b tr(S_k)² - ½ b tr(S_k²) + c det(S_k) - ½ d log(det(S_k)), where m_k = C₀ ζ S_k",
                1usize,
            ),
            Invariant::exact(
                "circulation_S_2",
                "tr(skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k)",
                1usize,
            ),
            Invariant::exact(
                "circulation_S_4",
                "tr(skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k skew(m_k S_k⁻¹) S_k)",
                1usize,
            ),
            Invariant::exact(
                "body_momentum_skew_I0_inverse_right",
                "skew(Q_kᵀ m_k Q_k⁻ᵀ I₀⁻¹)",
                N * N,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "2 tr(C₀ (g_k - Id) S_k (g_kᵀ - Id))/(2 h)² + ½ a tr(S_k) + ¼ b tr(S_k)² - ¼ b tr(S_k²) + ½ c det(S_k) - ¼ d log(det(S_k)) + ½ a tr(S_{k+1}) + ¼ b tr(S_{k+1})² - ¼ b tr(S_{k+1}²) + ½ c det(S_{k+1}) - ¼ d log(det(S_{k+1}))",
            1,
        ),
        dimensions: &[
            Dimension {
                name: "n",
                from: 2,
                to: 4,
                value: N,
            },
        ],
        ..Card::plain(&open::<Self>, &Self::sized)
    };
    /// The card of the model at the given sizes, in the order of their declaration.
    fn sized(sizes: &[usize]) -> Option<Card> {
        match sizes {
            [2] => Some(EllipsoidSpatial::<2, f64>::CARD),
            [3] => Some(EllipsoidSpatial::<3, f64>::CARD),
            [4] => Some(EllipsoidSpatial::<4, f64>::CARD),
            _ => None,
        }
    }
}
