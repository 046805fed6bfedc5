// Written by `clebsch derive --write`. Do not edit.

//! The model [`BodyN`](struct@BodyN) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`BodyN`](struct@BodyN).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyNParameters<const N: usize, T = f64> {
    /// `C`: second moments of mass; any matrix with positive determinant; a matrix of size n x n.
    pub C: SMatrix<T, N, N>,
}
/// Free rigid body in n dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyN<const N: usize, T = f64> {
    parameters: BodyNParameters<N, T>,
    factor: LeftFactor<N, T>,
    method: Method,
}
impl<const N: usize, T: Real> BodyN<N, T> {
    /// Sizes that the model does not admit do not compile.
    const ADMITTED: () = {
        ::core::assert!(3 <= N && N <= 8, "`n` ranges from 3 to 8 in this model");
    };
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Free rigid body in n dimensions.\npub model BodyN {\n    dim n in 3..=8;\n    /// second moments of mass; any matrix with positive determinant\n    param C: Mat<n>;\n    /// attitude, body to space\n    group Λ: SO<n> velocity Ω;\n    /// reconstruction\n    constraint next(Λ) = Λ*Ω;\n    lagrangian = -tr(C^T*Ω)/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 4749394489071051681u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: BodyNParameters<N, T>) -> Result<Self, ParameterError> {
        let () = Self::ADMITTED;
        validate::finite_entries("C", &parameters.C)?;
        let BodyNParameters { C, .. } = parameters;
        let factor = LeftFactor::new(C).map_err(|e| e.in_field("C"))?;
        Ok(Self {
            parameters,
            factor,
            method: Method::of_size(N),
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyNInitial<const N: usize, T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Orthogonal<N, T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentumMatrix<N, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyNState<const N: usize, T = f64> {
    Λ: Orthogonal<N, T>,
    momentum: SpatialMomentumMatrix<N, T>,
    node: u64,
}
impl<const N: usize, T: Real> BodyNState<N, T> {
    /// `Λ` at this node: body -> space.
    pub fn Λ(&self) -> Orthogonal<N, T> {
        self.Λ
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum(&self) -> SpatialMomentumMatrix<N, T> {
        self.momentum
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum(&self) -> BodyMomentumMatrix<N, T> {
        self.momentum.to_body(&self.Λ)
    }
}
/// The step size and the solver.
#[derive(Clone, Copy, Debug)]
pub struct BodyNWorkspace<const N: usize, T = f64> {
    h: T,
    method: Method,
}
impl<const N: usize, T: Real> BodyN<N, T> {
    /// The state at node 0.
    fn begin(
        &self,
        initial: BodyNInitial<N, T>,
    ) -> Result<BodyNState<N, T>, StartError> {
        validate::finite("Λ", initial.Λ.matrix().as_slice())?;
        validate::finite("body_momentum", initial.body_momentum.0.as_slice())?;
        validate::skew("body_momentum", &initial.body_momentum.0)?;
        Ok(BodyNState {
            Λ: initial.Λ,
            momentum: initial.body_momentum.to_space(&initial.Λ),
            node: 0,
        })
    }
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        _: &BodyNState<N, T>,
        h: T,
        choice: Option<Method>,
    ) -> Result<BodyNWorkspace<N, T>, StartError> {
        let method = choice.unwrap_or(self.method);
        Ok(BodyNWorkspace { h, method })
    }
    /// One step, in place. Method: Newton's method on the Lie algebra, because the left factor is constant.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut BodyNState<N, T>,
        work: &mut BodyNWorkspace<N, T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let edge = self.edge_momentum(state, h);
        let Ω = match self.factor.solve(&skew_part(&(edge * h)), work.method) {
            Ok(solved) => solved,
            Err(e) => return Err(self.refused(state, work, e)),
        };
        let Λ_moved = state.Λ * Ω;
        let momentum_next = state.momentum.0;
        if !(all_finite(&momentum_next)) {
            return Err(StepCause::not_finite("momentum").at_node(state.node));
        }
        state.Λ = Λ_moved;
        state.momentum = SpatialMomentumMatrix(momentum_next);
        state.node += 1;
        Ok(())
    }
    /// The momentum of the edge that starts at this node, for a step `h`.
    #[inline]
    fn edge_momentum(&self, state: &BodyNState<N, T>, h: T) -> SMatrix<T, N, N> {
        state.momentum.to_body(&state.Λ).0
    }
    /// Reports how far the step exceeds the bound, and a step size that succeeds.
    #[cold]
    fn refused(
        &self,
        state: &BodyNState<N, T>,
        work: &BodyNWorkspace<N, T>,
        e: Unsolved,
    ) -> StepError {
        let ratio = |trial: f64| {
            let trial = T::from_f64(trial);
            let momentum = self.edge_momentum(state, trial) * trial;
            Some(self.factor.reach(&momentum))
        };
        StepCause::from(e.with_searched_step(work.h.value(), ratio)).at_node(state.node)
    }
}
::clebsch::stepper! {
    [N] BodyN,
    BodyNParameters { C },
    BodyNInitial { Λ, body_momentum },
    BodyNState { Λ, momentum } at node,
    BodyNWorkspace { h, method },
    explicit {} solver none judged { (N * (N - 1) / 2) }
    observables { state.Λ, state.body_momentum, state.spatial_momentum }
    invariants { state.spatial_momentum as skew, momentum_squared, trace_momentum4,
        trace_momentum6, trace_momentum8 }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyNConfiguration<const N: usize, T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Orthogonal<N, T>,
}
impl<const N: usize, T: Real> BodyN<N, T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &BodyNConfiguration<N, T>,
        here: &BodyNConfiguration<N, T>,
        after: &BodyNConfiguration<N, T>,
    ) -> SVector<T, 28> {
        let BodyNParameters { C, .. } = self.parameters;
        let Ω_before = before.Λ.body_velocity(&here.Λ).matrix();
        let Ω = here.Λ.body_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        let t2 = C * (Ω.transpose() - SMatrix::<T, N, N>::identity()) * t1;
        let t3 = C.tr_mul(&(Ω_before - SMatrix::<T, N, N>::identity())) * t1;
        {
            let parts: [SMatrix<T, N, N>; 1] = [
                t2 + t3 - t3.transpose() - t2.transpose(),
            ];
            let mut all = SVector::<T, 28>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_skew(rest, &parts[0]);
            let _ = rest;
            all
        }
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &BodyNState<N, T>) -> SMatrix<T, 28, 28> {
        let BodyNParameters { C, .. } = self.parameters;
        let mut inertia = SMatrix::<T, 28, 28>::zeros();
        for axis in 0..(N * (N - 1) / 2) {
            let ξ: SMatrix<T, N, N> = skew_basis::<T, N>(axis);
            let along = {
                let parts: [SMatrix<T, N, N>; 1] = [
                    C.tr_mul(&ξ) * T::from_f64(0.5)
                        + ξ * C.transpose() * T::from_f64(0.5)
                        + ξ * C * T::from_f64(0.5) + C * ξ * T::from_f64(0.5),
                ];
                let mut all = SVector::<T, 28>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_skew(rest, &parts[0]);
                let _ = rest;
                all
            };
            inertia.set_column(axis, &along);
        }
        inertia
    }
    /// `-½ tr(μ_k²)`: Casimir: constant on coadjoint orbits.
    pub fn momentum_squared(&self, state: &BodyNState<N, T>) -> T {
        let μ = state.body_momentum().0;
        -(T::from_f64(0.5) * (μ * μ).trace())
    }
    /// `tr(μ_k⁴)`: Casimir: constant on coadjoint orbits.
    pub fn trace_momentum4(&self, state: &BodyNState<N, T>) -> T {
        let μ = state.body_momentum().0;
        let t1 = μ * μ;
        (t1 * t1).trace()
    }
    /// `tr(μ_k⁶)`: Casimir: constant on coadjoint orbits.
    pub fn trace_momentum6(&self, state: &BodyNState<N, T>) -> T {
        let μ = state.body_momentum().0;
        let t1 = μ * μ;
        (t1 * (t1 * t1)).trace()
    }
    /// `tr(μ_k⁸)`: Casimir: constant on coadjoint orbits.
    pub fn trace_momentum8(&self, state: &BodyNState<N, T>) -> T {
        let μ = state.body_momentum().0;
        let t1 = μ * μ;
        let t2 = t1 * t1;
        (t2 * t2).trace()
    }
    /// The discrete energy of the edge between two consecutive states, `tr(C)/h² - tr(C Ω_kᵀ)/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &BodyNState<N, T>,
        after: &BodyNState<N, T>,
    ) -> T {
        let BodyNParameters { C, .. } = self.parameters;
        let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
        -((C * less_identity(&Ω_matrix.transpose())).trace() / (h * h))
    }
}
impl<const N: usize> BodyN<N, f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &BodyNState<N, f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let Λ = state.Λ.matrix();
        let μ = state.body_momentum().0;
        let t1 = Λ * μ;
        let t2 = t1 * Λ.transpose();
        let t3 = (-(μ * μ).trace()).sqrt();
        let out = put(
            out,
            ::core::iter::repeat_n((-(t2 * t2).trace()).sqrt(), (N * (N - 1) / 2)),
        );
        put(
            out,
            [
                T::from_f64(0.5) * t3 * t3,
                t3 * t3 * t3 * t3,
                t3 * t3 * t3 * t3 * t3 * t3,
                t3 * t3 * t3 * t3 * t3 * t3 * t3 * t3,
            ],
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "BodyN",
        kebab: "body-n",
        doc: "Free rigid body in n dimensions.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(Cᵀ Ω_k)/h\nmomentum of Λ        -C Ω_kᵀ/h + Ω_k Cᵀ/h\nRiccati form         exact, C = C\ninvariants           spatial_momentum, momentum_squared, trace_momentum4, trace_momentum6, trace_momentum8\ntime reversal        not symmetric: first order\ncertificate          10 identities proved by normal form",
        solver: "Moser-Veselov: Newton's method on the Lie algebra, because the left factor is constant",
        order: 1,
        reversible: false,
        orders: &[1],
        parameters: &[
            Kind::Matrix
                .field(
                    "C",
                    [N, N],
                    "second moments of mass; any matrix with positive determinant",
                ),
        ],
        initial: &[
            Kind::Rotation.spelt("Λ", "Lambda", [N, N], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [N, N], "momentum, body frame"),
        ],
        observables: &[
            Kind::Rotation.spelt("Λ", "Lambda", [N, N], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [N, N], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [N, N], "momentum, space frame"),
        ],
        invariants: &[
            Invariant::exact("spatial_momentum", "Λ_k μ_k Λ_kᵀ", (N * (N - 1) / 2)),
            Invariant::exact("momentum_squared", "-½ tr(μ_k²)", 1usize),
            Invariant::exact("trace_momentum4", "tr(μ_k⁴)", 1usize),
            Invariant::exact("trace_momentum6", "tr(μ_k⁶)", 1usize),
            Invariant::exact("trace_momentum8", "tr(μ_k⁸)", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "tr(C)/h² - tr(C Ω_kᵀ)/h²",
            1,
        ),
        solvers: if N == 3 { &Method::NAMES } else { &Method::ANY_SIZE },
        dimensions: &[
            Dimension {
                name: "n",
                from: 3,
                to: 8,
                value: N,
            },
        ],
        ..Card::plain(&open::<Self>, &Self::sized)
    };
    /// The card of the model at the given sizes, in the order of their declaration.
    fn sized(sizes: &[usize]) -> Option<Card> {
        match sizes {
            [3] => Some(BodyN::<3, f64>::CARD),
            [4] => Some(BodyN::<4, f64>::CARD),
            [5] => Some(BodyN::<5, f64>::CARD),
            [6] => Some(BodyN::<6, f64>::CARD),
            [7] => Some(BodyN::<7, f64>::CARD),
            [8] => Some(BodyN::<8, f64>::CARD),
            _ => None,
        }
    }
}
