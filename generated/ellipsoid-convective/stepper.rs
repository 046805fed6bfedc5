// Written by `clebsch derive --write`. Do not edit.

//! The model [`EllipsoidConvective`](struct@EllipsoidConvective) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`EllipsoidConvective`](struct@EllipsoidConvective).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidConvectiveParameters<const N: usize, T = f64> {
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
/// Elastic ellipsoid, convective representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidConvective<const N: usize, T = f64> {
    parameters: EllipsoidConvectiveParameters<N, T>,
    inverse_1_left: SMatrix<T, N, N>,
    inverse_1_right: SMatrix<T, N, N>,
}
impl<const N: usize, T: Real> EllipsoidConvective<N, T> {
    /// Sizes that the model does not admit do not compile.
    const ADMITTED: () = {
        ::core::assert!(2 <= N && N <= 4, "`n` ranges from 2 to 4 in this model");
    };
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Elastic ellipsoid, convective representation.\npub model EllipsoidConvective {\n    dim n in 2..=4;\n    /// metric of space\n    param C0: Sym<n> as \"C_0\";\n    /// second moments of mass, reference configuration\n    param I0: Sym<n> as \"I_0\";\n    /// stiffness against changes of length, area and volume\n    param a: Real;\n    /// stiffness against changes of length, area and volume\n    param b: Real;\n    /// stiffness against changes of length, area and volume\n    param c: Real;\n    /// resistance to collapse; the identity is stress-free if d = 2 a + 2 (n - 1) b + 2 c\n    param d: Real;\n    /// placement, reference to space\n    group Q: GL<n> velocity G;\n    /// metric of space, pulled back to the reference configuration\n    advected C: Sym<n> = Q^T*C0*Q;\n    constraint next(Q) = Q*G;\n    constraint next(C) = G^T*C*G;\n    lagrangian = tr(C*(G - Id)*I0*(G^T - Id))/(2*h) - h*(a*tr(C) + (1/2)*b*(tr(C)^2 - tr(C*C)) + c*det(C) - (1/2)*d*log(det(C)));\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 1047890013373966057u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: EllipsoidConvectiveParameters<N, T>,
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
        let EllipsoidConvectiveParameters { C0, I0, .. } = parameters;
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
pub struct EllipsoidConvectiveInitial<const N: usize, T = f64> {
    /// `Q` at node 0: body -> space.
    pub Q: Linear<N, T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentumMatrix<N, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidConvectiveState<const N: usize, T = f64> {
    Q: Linear<N, T>,
    momentum: SpatialMomentumMatrix<N, T>,
    node: u64,
}
impl<const N: usize, T: Real> EllipsoidConvectiveState<N, T> {
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
pub struct EllipsoidConvectiveWorkspace<const N: usize, T = f64> {
    h: T,
}
impl<const N: usize, T: Real> EllipsoidConvective<N, T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &EllipsoidConvectiveState<N, T>,
        h: T,
        _: (),
    ) -> Result<EllipsoidConvectiveWorkspace<N, T>, StartError> {
        {
            let EllipsoidConvectiveParameters { C0, .. } = self.parameters;
            let Q = state.Q.matrix();
            let C = Q.tr_mul(&(C0 * Q));
            validate::defined(
                domain::Domain::Positive,
                domain::Function::Log,
                "det(C_k)",
                determinant(&C),
            )?;
        }
        Ok(EllipsoidConvectiveWorkspace { h })
    }
    /// One step, in place. Method: two small linear systems, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved or leaves the domain of the model. The error gives numbers
    /// and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut EllipsoidConvectiveState<N, T>,
        work: &mut EllipsoidConvectiveWorkspace<N, T>,
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
        state: &EllipsoidConvectiveState<N, T>,
        h: T,
        contact: domain::Contact,
    ) -> StepError {
        let contact = contact
            .with_trials(
                h,
                |h| {
                    let mut moving = *state;
                    self.step(&mut moving, &mut EllipsoidConvectiveWorkspace { h })
                        .is_ok()
                },
            );
        StepCause::from(contact).at_node(state.node)
    }
    /// Whether the step from one state to the next stays where the model is defined.
    #[inline]
    fn stays_inside(
        &self,
        before: &EllipsoidConvectiveState<N, T>,
        after: &EllipsoidConvectiveState<N, T>,
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
                            argument: "det(C_k)",
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
    fn domain_arguments(&self, state: &EllipsoidConvectiveState<N, T>, h: T) -> [T; 1] {
        let EllipsoidConvectiveParameters { C0, .. } = self.parameters;
        let Q = state.Q.matrix();
        let C = Q.tr_mul(&(C0 * Q));
        let _ = (state, h);
        [determinant(&C)]
    }
    /// One step, in place. Method: two small linear systems, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    fn step_untested(
        &self,
        state: &mut EllipsoidConvectiveState<N, T>,
        work: &mut EllipsoidConvectiveWorkspace<N, T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let EllipsoidConvectiveParameters { C0, I0, a, b, c, d, .. } = self.parameters;
        let Q = state.Q.matrix();
        let Q_seen = C0 * (Q * Q.transpose());
        let momentum_leaving = state.momentum.0
            - (Q_seen * (h * a + h * b * Q_seen.trace()) - Q_seen * Q_seen * (h * b)
                + SMatrix::<T, N, N>::identity()
                    * (h * c * determinant(&Q_seen) - T::from_f64(0.5) * h * d));
        let Q_change = match displaced(
            &state.Q,
            &(self.inverse_1_left * h),
            &momentum_leaving,
            &self.inverse_1_right,
            &["C_k/h", "I₀"],
        ) {
            Ok(solved) => solved,
            Err(e) => return Err(StepCause::Singular(e).at_node(state.node)),
        };
        let Q_moved = state.Q.changed(&Q_change);
        let Q_next = Q_moved.matrix();
        let Q_seen_next = C0 * (Q_next * Q_next.transpose());
        let momentum_next = momentum_leaving
            + C0 * (Q_change * (I0 * Q_change.transpose())) * (T::from_f64(1.0) / h)
            + Q_seen_next * (-(h * a) - h * b * Q_seen_next.trace())
            + Q_seen_next * Q_seen_next * (h * b)
            + SMatrix::<T, N, N>::identity()
                * (T::from_f64(0.5) * h * d - h * c * determinant(&Q_seen_next));
        state.Q = Q_moved;
        state.momentum = SpatialMomentumMatrix(momentum_next);
        state.node += 1;
        Ok(())
    }
    /// `C` at the node of this state.
    #[inline]
    pub fn C(&self, state: &EllipsoidConvectiveState<N, T>) -> SMatrix<T, N, N> {
        let EllipsoidConvectiveParameters { C0, .. } = self.parameters;
        let Q = state.Q.matrix();
        Q.tr_mul(&(C0 * Q))
    }
}
::clebsch::stepper! {
    [N] EllipsoidConvective,
    EllipsoidConvectiveParameters { C0, I0, a, b, c, d },
    EllipsoidConvectiveInitial { Q, body_momentum },
    EllipsoidConvectiveState { Q, momentum } at node,
    EllipsoidConvectiveWorkspace { h },
    tried {} nothing symmetric judged { (N * N) }
    start { Q, momentum = body_momentum.to_space }
    observables { state.Q, state.body_momentum, state.spatial_momentum, C }
    invariants { energy, angular_momentum_C_2, angular_momentum_C_4,
        spatial_momentum_skew_C0_inverse }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidConvectiveConfiguration<const N: usize, T = f64> {
    /// `Q` at the node: body -> space.
    pub Q: Linear<N, T>,
}
impl<const N: usize, T: Real> EllipsoidConvective<N, T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &EllipsoidConvectiveConfiguration<N, T>,
        here: &EllipsoidConvectiveConfiguration<N, T>,
        after: &EllipsoidConvectiveConfiguration<N, T>,
    ) -> SVector<T, 16> {
        let EllipsoidConvectiveParameters { C0, I0, a, b, c, d, .. } = self.parameters;
        let Q_before = before.Q.matrix();
        let C_before = Q_before.tr_mul(&(C0 * Q_before));
        let Q = here.Q.matrix();
        let C = Q.tr_mul(&(C0 * Q));
        let G_before = before.Q.body_velocity(&here.Q).matrix();
        let G = here.Q.body_velocity(&after.Q).matrix();
        let t1 = h.powi(-1);
        let t2 = G_before - SMatrix::<T, N, N>::identity();
        {
            let parts: [SMatrix<T, N, N>; 1] = [
                C * C * (T::from_f64(2.0) * h * b) - C * (T::from_f64(2.0) * h * a)
                    - C * (T::from_f64(2.0) * h * b * C.trace())
                    - SMatrix::<T, N, N>::identity()
                        * (T::from_f64(2.0) * h * c * determinant(&C))
                    + SMatrix::<T, N, N>::identity() * (h * d)
                    + C_before * (t2 * I0) * t1
                    - C * ((G - SMatrix::<T, N, N>::identity()) * I0) * t1
                    + (G_before.transpose() - SMatrix::<T, N, N>::identity())
                        * (C_before * (t2 * I0)) * t1,
            ];
            let mut all = SVector::<T, 16>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_matrix(rest, &parts[0]);
            let _ = rest;
            all
        }
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &EllipsoidConvectiveState<N, T>) -> SMatrix<T, 16, 16> {
        let EllipsoidConvectiveParameters { I0, .. } = self.parameters;
        let C = self.C(state);
        let mut inertia = SMatrix::<T, 16, 16>::zeros();
        for axis in 0..(N * N) {
            let ξ: SMatrix<T, N, N> = matrix_basis::<T, N>(axis);
            let along = {
                let parts: [SMatrix<T, N, N>; 1] = [C * (ξ * I0)];
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
    pub fn energies(&self, state: &EllipsoidConvectiveState<N, T>) -> (T, T) {
        let EllipsoidConvectiveParameters { a, b, c, d, .. } = self.parameters;
        let C = self.C(state);
        let momentum = {
            let parts: [SMatrix<T, N, N>; 1] = [state.body_momentum().0];
            let mut all = SVector::<T, 16>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_matrix(rest, &parts[0]);
            let _ = rest;
            all
        };
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, (N * N));
        (
            momentum.dot(&velocity) * T::from_f64(0.5),
            a * C.trace() + T::from_f64(0.5) * b * (C.trace() * C.trace())
                - T::from_f64(0.5) * b * (C * C).trace() + c * determinant(&C)
                - T::from_f64(0.5) * d * determinant(&C).ln(),
        )
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &EllipsoidConvectiveState<N, T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `tr(C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k))`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn angular_momentum_C_2(&self, state: &EllipsoidConvectiveState<N, T>) -> T {
        let C = self.C(state);
        let μ = state.body_momentum().0;
        let t1 = skew_part(&(inverse_or_nan(&C) * μ));
        (C * (t1 * (C * t1))).trace()
    }
    /// `tr(C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k))`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn angular_momentum_C_4(&self, state: &EllipsoidConvectiveState<N, T>) -> T {
        let C = self.C(state);
        let μ = state.body_momentum().0;
        let t1 = skew_part(&(inverse_or_nan(&C) * μ));
        (C * (t1 * (C * (t1 * (C * (t1 * (C * t1))))))).trace()
    }
    /// `skew(C₀⁻¹ Q_k⁻ᵀ μ_k Q_kᵀ)`: Noether: the action is invariant under motions of space that fix the axis.
    pub fn spatial_momentum_skew_C0_inverse(
        &self,
        state: &EllipsoidConvectiveState<N, T>,
    ) -> SMatrix<T, N, N> {
        let EllipsoidConvectiveParameters { C0, .. } = self.parameters;
        let Q = state.Q.matrix();
        let μ = state.body_momentum().0;
        skew_part(
            &(inverse_or_nan(&C0) * inverse_or_nan(&Q).tr_mul(&(μ * Q.transpose()))),
        )
    }
    /// The discrete energy of the edge between two consecutive states, `2 tr(C_k (G_k - Id) I₀ (G_kᵀ - Id))/(2 h)² + ½ a tr(C_k) + ¼ b tr(C_k)² - ¼ b tr(C_k²) + ½ c det(C_k) - ¼ d log(det(C_k)) + ½ a tr(C_{k+1}) + ¼ b tr(C_{k+1})² - ¼ b tr(C_{k+1}²) + ½ c det(C_{k+1}) - ¼ d log(det(C_{k+1}))`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &EllipsoidConvectiveState<N, T>,
        after: &EllipsoidConvectiveState<N, T>,
    ) -> T {
        let EllipsoidConvectiveParameters { I0, a, b, c, d, .. } = self.parameters;
        let C = self.C(before);
        let C_next = self.C(after);
        let G_matrix = before.Q.body_velocity(&after.Q).matrix();
        let t1 = C.trace();
        let t2 = determinant(&C);
        let t3 = C_next.trace();
        let t4 = determinant(&C_next);
        T::from_f64(0.5) * a * t1 + T::from_f64(0.25) * b * (t1 * t1)
            - T::from_f64(0.25) * b * (C * C).trace() + T::from_f64(0.5) * c * t2
            - T::from_f64(0.25) * d * t2.ln() + T::from_f64(0.5) * a * t3
            + T::from_f64(0.25) * b * (t3 * t3)
            - T::from_f64(0.25) * b * (C_next * C_next).trace()
            + T::from_f64(0.5) * c * t4 - T::from_f64(0.25) * d * t4.ln()
            + T::from_f64(0.5)
                * (I0
                    * ((G_matrix.transpose() - SMatrix::<T, N, N>::identity())
                        * (C * (G_matrix - SMatrix::<T, N, N>::identity()))))
                    .trace() / (h * h)
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(
        &self,
        state: &EllipsoidConvectiveState<N, T>,
        h: T,
    ) -> Option<EllipsoidConvectiveState<N, T>> {
        let mut moving = *state;
        self.step(&mut moving, &mut EllipsoidConvectiveWorkspace { h }).ok()?;
        Some(moving)
    }
}
impl<const N: usize> EllipsoidConvective<N, f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &EllipsoidConvectiveState<N, f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let EllipsoidConvectiveParameters { C0, a, b, c, d, .. } = self.parameters;
        let C = self.C(state);
        let Q = state.Q.matrix();
        let energies = self.energies(state);
        let s1 = (h * h).sqrt();
        let s2 = (C * C).trace().sqrt();
        let s3 = (b * b).sqrt();
        let s4 = determinant(&C);
        let impulse = s1 * (a * a).sqrt() * s2 + s1 * s3 * s2 * s2
            + s1 * s3 * SMatrix::<T, N, N>::identity().trace().sqrt() * s2 * s2
            + s1 * (c * c).sqrt() * (s4 * s4).sqrt()
            + T::from_f64(0.5) * s1 * (d * d).sqrt();
        let state = &EllipsoidConvectiveState {
            momentum: SpatialMomentumMatrix(not_less(state.momentum.0, (0, N), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let μ = state.body_momentum().0;
        let t1 = Q * μ.transpose();
        let t2 = (C * C).trace().sqrt();
        let t3 = inverse_or_nan(&C);
        let t4 = (t3 * t3).trace().sqrt();
        let t5 = μ.tr_mul(&μ).trace().sqrt();
        let t6 = inverse_or_nan(&Q);
        let t7 = inverse_or_nan(&C0);
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
                (t1 * (t6 * t6.tr_mul(&t1.transpose()))).trace().sqrt()
                    * (t7 * t7).trace().sqrt(),
                N * N,
            ),
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "EllipsoidConvective",
        kebab: "ellipsoid-convective",
        doc: "Elastic ellipsoid, convective representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  tr(C_k (G_k - Id) I₀ (G_kᵀ - Id))/(2 h) - ½ h a tr(C_k) - ¼ h b tr(C_k)² + ¼ h b tr(C_k²) - ½ h c det(C_k) + ¼ h d log(det(C_k)) - ½ h a tr(C_{k+1}) - ¼ h b tr(C_{k+1})² + ¼ h b tr(C_{k+1}²) - ½ h c det(C_{k+1}) + ¼ h d log(det(C_{k+1}))\nmomentum of Q        C_k (G_k - Id) I₀ G_kᵀ/h\nRiccati form         none; linear, L = C_k/h, R = I₀\ninvariants           energy, angular_momentum_C_2, angular_momentum_C_4, spatial_momentum_skew_C0_inverse\ntime reversal        symmetric: second order\ncertificate          17 identities proved by normal form",
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
            Kind::BodyMomentum.field("body_momentum", [N, N], "momentum, body frame"),
        ],
        observables: &[
            Kind::Matrix.field("Q", [N, N], "placement, reference to space"),
            Kind::BodyMomentum.field("body_momentum", [N, N], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [N, N], "momentum, space frame"),
            Kind::Symmetric
                .field(
                    "C",
                    [N, N],
                    "metric of space, pulled back to the reference configuration",
                ),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ tr(μ_kᵀ ζ) + a tr(C_k) + ½ b tr(C_k)² - ½ b tr(C_k²) + c det(C_k) - ½ d log(det(C_k)), where μ_k = C_k ζ I₀",
                1usize,
            ),
            Invariant::exact(
                "angular_momentum_C_2",
                "tr(C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k))",
                1usize,
            ),
            Invariant::exact(
                "angular_momentum_C_4",
                "tr(C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k) C_k skew(C_k⁻¹ μ_k))",
                1usize,
            ),
            Invariant::exact(
                "spatial_momentum_skew_C0_inverse",
                "skew(C₀⁻¹ Q_k⁻ᵀ μ_k Q_kᵀ)",
                N * N,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "2 tr(C_k (G_k - Id) I₀ (G_kᵀ - Id))/(2 h)² + ½ a tr(C_k) + ¼ b tr(C_k)² - ¼ b tr(C_k²) + ½ c det(C_k) - ¼ d log(det(C_k)) + ½ a tr(C_{k+1}) + ¼ b tr(C_{k+1})² - ¼ b tr(C_{k+1}²) + ½ c det(C_{k+1}) - ¼ d log(det(C_{k+1}))",
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
            [2] => Some(EllipsoidConvective::<2, f64>::CARD),
            [3] => Some(EllipsoidConvective::<3, f64>::CARD),
            [4] => Some(EllipsoidConvective::<4, f64>::CARD),
            _ => None,
        }
    }
}
