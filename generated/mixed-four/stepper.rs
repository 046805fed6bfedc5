// Written by `clebsch derive --write`. Do not edit.

//! The model [`MixedFour`](struct@MixedFour) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`MixedFour`](struct@MixedFour).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedFourParameters<T = f64> {
    /// `J`: second moments of mass of the first body about its fixed point, body frame; a matrix of size 3 x 3, symmetric.
    pub J: SMatrix<T, 3, 3>,
    /// `A`: second moments of mass of the free body about its reference point, body frame; a matrix of size 3 x 3, symmetric.
    pub A: SMatrix<T, 3, 3>,
    /// `M`: mass of the free body; a number.
    pub M: T,
    /// `I`: principal moments of inertia of the second body; a matrix of size 3 x 3, diagonal.
    pub I: SMatrix<T, 3, 3>,
    /// `m`: mass of the point mass; a number.
    pub m: T,
    /// `b`: coefficient of the quartic kinetic energy of the point mass; a number.
    pub b: T,
    /// `k`: stiffness of the springs; a number.
    pub k: T,
    /// `p`: attachment points of the springs, body frames: first body, free body, second body; a vector of 3 components.
    pub p: SVector<T, 3>,
    /// `s`: attachment points of the springs, body frames: first body, free body, second body; a vector of 3 components.
    pub s: SVector<T, 3>,
    /// `e`: attachment points of the springs, body frames: first body, free body, second body; a vector of 3 components.
    pub e: SVector<T, 3>,
    /// `g`: gravitational acceleration of the point mass, space frame; a vector of 3 components.
    pub g: SVector<T, 3>,
}
/// Two rigid bodies with fixed points, a free rigid body and a point mass, coupled by springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedFour<T = f64> {
    parameters: MixedFourParameters<T>,
    factor_1: LeftFactor<3, T>,
    factor_3: QuaternionBody<T>,
    method: Method,
}
impl<T: Real> MixedFour<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Two rigid bodies with fixed points, a free rigid body and a point mass, coupled by springs.\npub model MixedFour {\n    /// second moments of mass of the first body about its fixed point, body frame\n    param J: Sym<3>;\n    /// second moments of mass of the free body about its reference point, body frame\n    param A: Sym<3>;\n    /// mass of the free body\n    param M: Real;\n    /// principal moments of inertia of the second body\n    param I: Diag<3>;\n    /// mass of the point mass\n    param m: Real;\n    /// coefficient of the quartic kinetic energy of the point mass\n    param b: Real;\n    /// stiffness of the springs\n    param k: Real;\n    /// attachment points of the springs, body frames: first body, free body, second body\n    param p: Vec<3>;\n    /// attachment points of the springs, body frames: first body, free body, second body\n    param s: Vec<3>;\n    /// attachment points of the springs, body frames: first body, free body, second body\n    param e: Vec<3>;\n    /// gravitational acceleration of the point mass, space frame\n    param g: Vec<3>;\n    /// attitude of the first body, body to space\n    group R: SO<3> velocity V;\n    /// position and attitude of the free body, body to space\n    group G: SE<3> velocity W;\n    /// attitude of the second body, body to space\n    group q: SU<2> velocity Y;\n    /// position of the point mass, space frame\n    field X: Vec<3>;\n    constraint next(R) = R*V;\n    constraint next(G) = G*W;\n    constraint next(q) = q*Y;\n    lagrangian = -tr(J*V)/h - tr(A*rot(W))/h + M*dot(pos(next(G)) - pos(G), pos(next(G)) - pos(G))/(2*h) + 2*dot(im(Y), I*im(Y))/h + m*dot(next(X) - X, next(X) - X)/(2*h) + b*dot(next(X) - X, next(X) - X)^2/h^3 + h*m*dot(g, X) - (1/2)*h*k*dot(X - R*p, X - R*p) - (1/2)*h*k*dot(pos(G) + rot(G)*s - X, pos(G) + rot(G)*s - X) - h*k*dot(rot(q)*e, R*p);\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 11034751247602276517u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: MixedFourParameters<T>) -> Result<Self, ParameterError> {
        validate::finite_entries("J", &parameters.J)?;
        validate::symmetric("J", &parameters.J)?;
        validate::finite_entries("A", &parameters.A)?;
        validate::symmetric("A", &parameters.A)?;
        validate::finite("M", &[parameters.M])?;
        validate::finite_entries("I", &parameters.I)?;
        validate::diagonal("I", &parameters.I)?;
        validate::finite("m", &[parameters.m])?;
        validate::finite("b", &[parameters.b])?;
        validate::finite("k", &[parameters.k])?;
        validate::finite("p", parameters.p.as_slice())?;
        validate::finite("s", parameters.s.as_slice())?;
        validate::finite("e", parameters.e.as_slice())?;
        validate::finite("g", parameters.g.as_slice())?;
        let MixedFourParameters { J, I, .. } = parameters;
        let factor_1 = LeftFactor::new(J).map_err(|e| e.in_field("J"))?;
        let factor_3 = QuaternionBody::new("I", I, T::from_f64(0.0))?;
        Ok(Self {
            parameters,
            factor_1,
            factor_3,
            method: Method::of_size(if 3 == 3 { 3 } else { 4 }),
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedFourInitial<T = f64> {
    /// `R` at node 0: body -> space.
    pub R: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum_R: BodyMomentum<T>,
    /// `G` at node 0: body -> space.
    pub G: RigidMotion<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum_G: BodyImpulse<T>,
    /// `q` at node 0: body -> space.
    pub q: UnitQuaternion<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum_q: BodyMomentum<T>,
    /// `X` at node 0.
    pub X: Additive<3, 1, T>,
    /// Its momentum at node 0.
    pub momentum_X: FieldMomentum<3, 1, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame (of a rigid motion about the body's own origin), advected quantities as their values at the identity, so that rounding errors do not accumulate. Positions and their momenta are stored as two numbers, the second below the rounding of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedFourState<T = f64> {
    R: Rotation<T>,
    momentum_R: SpatialMomentum<T>,
    G: RigidMotion<T>,
    momentum_G: CarriedImpulse<T>,
    place_rest_G: SMatrix<T, 3, 1>,
    momentum_rest_G: SVector<T, 6>,
    q: UnitQuaternion<T>,
    momentum_q: SpatialMomentum<T>,
    X: Additive<3, 1, T>,
    momentum_X: FieldMomentum<3, 1, T>,
    place_rest_X: SMatrix<T, 3, 1>,
    momentum_rest_X: SMatrix<T, 3, 1>,
    node: u64,
}
impl<T: Real> MixedFourState<T> {
    /// `R` at this node: body -> space.
    pub fn R(&self) -> Rotation<T> {
        self.R
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum_R(&self) -> SpatialMomentum<T> {
        self.momentum_R
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum_R(&self) -> BodyMomentum<T> {
        self.momentum_R.to_body(&self.R)
    }
    /// `G` at this node: body -> space.
    pub fn G(&self) -> RigidMotion<T> {
        self.G
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum_G(&self) -> SpatialImpulse<T> {
        self.momentum_G.to_space(&self.G)
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum_G(&self) -> BodyImpulse<T> {
        self.momentum_G.to_body(&self.G)
    }
    /// `q` at this node: body -> space.
    pub fn q(&self) -> UnitQuaternion<T> {
        self.q
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum_q(&self) -> SpatialMomentum<T> {
        self.momentum_q
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum_q(&self) -> BodyMomentum<T> {
        self.momentum_q.to_body(&self.q)
    }
    /// `X` at this node.
    pub fn X(&self) -> Additive<3, 1, T> {
        self.X
    }
    /// Its momentum at this node.
    pub fn momentum_X(&self) -> FieldMomentum<3, 1, T> {
        self.momentum_X
    }
}
/// The step size, the solver, and the last velocities as initial guesses for the next step.
#[derive(Clone, Copy, Debug)]
pub struct MixedFourWorkspace<T = f64> {
    h: T,
    method: Method,
    search_2: newton::Search<T, [Rotation<T>; 1], 3, [RigidMotion<T>; 1], 6>,
    search_4: newton::Search<T, [Additive<3, 1, T>; 1], 3>,
}
impl<T: Real> MixedFour<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        _: &MixedFourState<T>,
        h: T,
        choice: Option<Method>,
    ) -> Result<MixedFourWorkspace<T>, StartError> {
        {
            let h = h;
            validate::inside(
                domain::Domain::NotZero,
                domain::Function::Quotient,
                "h³",
                h.powi(3),
            )?;
        }
        let method = choice.unwrap_or(self.method);
        Ok(MixedFourWorkspace {
            h,
            method,
            search_2: newton::Search::from_rest(),
            search_4: newton::Search::from_rest(),
        })
    }
    /// One step, in place. Method: V by a Moser-Veselov solver, because its left factor is constant; W by Newton's method, because the group is not SO(n); Y by one scalar equation, because its coefficients are constant; ΔX by Newton's method, because the balance is not linear in ΔX.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut MixedFourState<T>,
        work: &mut MixedFourWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let MixedFourParameters { A, M, m, b, k, p, s, e: e_, g, .. } = self.parameters;
        let R = state.R.matrix();
        let G = state.G.matrix();
        let q = state.q.matrix();
        let X = state.X.matrix();
        let relative_R_q = R.tr_mul(&quaternion_rotation(&q));
        let b1 = relative_R_q * e_;
        let V = match self
            .factor_1
            .rotation(
                &((R.tr_mul(&state.momentum_R.0)
                    - (p.cross(&(b1 - R.tr_mul(&X))) * (T::from_f64(0.5) * h * k))) * h),
                work.method,
            )
        {
            Ok(solved) => solved,
            Err(e) => return Err(self.refused(*state, work, e)),
        };
        let found_2: newton::Solved<[RigidMotion<T>; 1]> = {
            let momenta_six = state.momentum_G.to_body(&state.G).0;
            let momenta: [SVector<T, 3>; 2] = [
                rows_from::<T, 6, 3, 1>(&momenta_six, 0),
                rows_from::<T, 6, 3, 1>(&momenta_six, 3),
            ];
            let W_pos_momentum = momenta[1];
            let s1 = motion_rotation(&G);
            let s2 = s1.transpose();
            let s3 = motion_translation(&G);
            let s4 = s3 - X + s1 * s;
            let s5 = M.powi(-1);
            let k1 = h.powi(-1);
            let k2 = s.cross(&(s2 * (s3 - X))) * (T::from_f64(0.5) * h * k);
            let k3 = s2 * s4 * (T::from_f64(0.5) * h * k);
            let k4 = W_pos_momentum * (h * s5)
                - s2 * s4 * (T::from_f64(0.5) * (h * h) * k * s5);
            let mut iteration = work.search_2.begin(state.node);
            loop {
                let turned = iteration.trial();
                let W_pos = k4;
                let trial = [rigid_motion(turned[0], W_pos)];
                if iteration.wants_scale() {
                    iteration
                        .set_scale(move |lane| {
                            self.rounding_2(h, &(G, (X, [])), &momenta, &trial, lane)
                        });
                }
                let (W_rot, W_pos) = (trial[0].rotation.matrix(), trial[0].translation);
                if iteration.wants_residual()
                    && iteration
                        .assess({
                            (axial_of_difference(&(less_identity(&W_rot) * A)) * k1 + k2)
                                - momenta[0]
                        })
                {
                    iteration
                        .set_tangent_times(
                            &{
                                let t1 = W_rot * A;
                                trace_complement(&t1)
                            },
                            h,
                        );
                }
                match iteration.correct_part_from_left(trial) {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(
                        solved,
                    ) if iteration
                        .is_part_of_principal(
                            &solved.element,
                            &{
                                joined::<T, 2, 6>(&[(k2) - momenta[0], (k3) - momenta[1]])
                            },
                            || {
                                Self::tangent_at_2(
                                    &self.parameters,
                                    h,
                                    &(G, (X, [])),
                                    &Group::<T>::identity(),
                                )
                            },
                        ) => break solved,
                    ended => {
                        if let Some(solved) = self
                            .settled_2(
                                h,
                                *state,
                                (G, (X, [])),
                                momenta,
                                &mut iteration,
                                ended,
                                work.method,
                            )?
                        {
                            break solved;
                        }
                    }
                }
            }
        };
        let solved_2 = found_2.element;
        let W_matrix = solved_2[0].matrix();
        let Y = match self
            .factor_3
            .velocity(
                &((state.momentum_q.to_body(&state.q).0
                    - (-(relative_R_q.tr_mul(&p.cross(&b1))
                        * (T::from_f64(0.5) * h * k)))) * h),
            )
        {
            Ok(solved) => solved,
            Err(e) => return Err(self.refused_3(*state, work, e)),
        };
        let found_4: newton::Solved<[Additive<3, 1, T>; 1]> = {
            let momenta: [SVector<T, 3>; 1] = [state.momentum_X.0];
            let k1 = T::from_f64(4.0) * b / h.powi(3);
            let k2 = m / h;
            let k3 = X * (h * k) - g * (T::from_f64(0.5) * h * m)
                - R * p * (T::from_f64(0.5) * h * k)
                - motion_rotation(&G) * s * (T::from_f64(0.5) * h * k)
                - motion_translation(&G) * (T::from_f64(0.5) * h * k);
            let convex = { (m).least() > 0.0 && (b).least() >= 0.0 };
            let mut iteration = work.search_4.begin(state.node);
            loop {
                let trial = iteration.trial();
                if iteration.wants_scale() {
                    iteration
                        .set_scale(move |lane| {
                            self
                                .rounding_4(h, &(R, (G, (X, []))), &momenta, &trial, lane)
                        });
                }
                let ΔX = trial[0].matrix();
                if iteration
                    .assess({
                        (ΔX * (k1 * ΔX.dot(&ΔX)) + ΔX * k2 + k3) - momenta[0]
                    })
                {
                    iteration
                        .set_tangent(
                            &{
                                let c1 = k1 * ΔX.dot(&ΔX);
                                let mut matrix = SMatrix::<T, 3, 3>::zeros();
                                for axis in 0..(3 * 1) {
                                    let η4 = array_basis::<T, 3, 1>(axis);
                                    let along = ΔX * (k1 * (η4.dot(&ΔX) + ΔX.dot(&η4)))
                                        + η4 * c1 + η4 * k2;
                                    matrix.set_column(axis, &along);
                                }
                                matrix
                            },
                        );
                }
                match iteration.correct() {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(
                        solved,
                    ) if convex
                        || iteration
                            .is_principal(
                                &solved.element,
                                &{ (k3) - momenta[0] },
                                |trial| {
                                    Self::residual_at_4(
                                        &self.parameters,
                                        h,
                                        &(R, (G, (X, []))),
                                        &momenta,
                                        trial,
                                    )
                                },
                            ) => break solved,
                    ended => {
                        if let Some(solved) = self
                            .settled_4(
                                h,
                                *state,
                                (R, (G, (X, []))),
                                momenta,
                                &mut iteration,
                                ended,
                                work.method,
                            )?
                        {
                            break solved;
                        }
                    }
                }
            }
        };
        let solved_4 = found_4.element;
        let ΔX_matrix = solved_4[0].matrix();
        let R_moved = state.R * V;
        let (G_moved, G_rest) = state.G.moved(&(solved_2[0]), &state.place_rest_G);
        let q_moved = state.q * Y;
        let (X_moved, X_rest) = state.X.moved(&(solved_4[0]), &state.place_rest_X);
        let R_next = R_moved.matrix();
        let G_next = G_moved.matrix();
        let q_next = q_moved.matrix();
        let X_next = X_moved.matrix();
        let relative_R_q_next = R_next.tr_mul(&quaternion_rotation(&q_next));
        let t2 = relative_R_q_next * e_;
        let t3 = motion_rotation(&G);
        let t4 = t3.transpose();
        let t5 = motion_translation(&G);
        let t6 = t5 - X + t3 * s;
        let t7 = motion_rotation(&G_next);
        let t8 = t7.transpose();
        let t9 = motion_translation(&G_next);
        let t10 = t9 - X_next + t7 * s;
        let momentum_R_next = state.momentum_R.0
            + R * (p.cross(&(R.tr_mul(&X) - b1)) * (T::from_f64(0.5) * h * k))
            + R_next
                * (p.cross(&(R_next.tr_mul(&X_next) - t2)) * (T::from_f64(0.5) * h * k));
        let (momentum_G_next, momentum_G_rest) = added(
            &state.momentum_G.0,
            &state.momentum_rest_G,
            &({
                let leaving = state
                    .G
                    .covector_turned(
                        &((-into_rows::<T, 6, 3, 1>(&s.cross(&(t4 * t6)), 0)
                            - into_rows::<T, 6, 3, 1>(&(t4 * t6), 3))
                            * (T::from_f64(0.5) * h * k)),
                    );
                leaving
                    + G_moved
                        .covector_turned(
                            &((-into_rows::<T, 6, 3, 1>(&s.cross(&(t8 * t10)), 0)
                                - into_rows::<T, 6, 3, 1>(&(t8 * t10), 3))
                                * (T::from_f64(0.5) * h * k)),
                        )
            }),
        );
        let momentum_q_next = state.momentum_q.0
            + state
                .q
                .covector_to_space(
                    &(relative_R_q.tr_mul(&p.cross(&b1)) * (T::from_f64(0.5) * h * k)),
                )
            + q_moved
                .covector_to_space(
                    &(relative_R_q_next.tr_mul(&p.cross(&t2))
                        * (T::from_f64(0.5) * h * k)),
                );
        let (momentum_X_next, momentum_X_rest) = added(
            &state.momentum_X.0,
            &state.momentum_rest_X,
            &(g * (h * m)
                + ((R + R_next) * p * T::from_f64(0.5) + (t3 + t7) * s * T::from_f64(0.5)
                    - X - X_next + t5 * T::from_f64(0.5) + t9 * T::from_f64(0.5))
                    * (h * k)),
        );
        if !(all_finite(&momentum_R_next) && all_finite(&momentum_G_next)
            && all_finite(&momentum_q_next) && all_finite(&momentum_X_next))
        {
            return Err(StepCause::not_finite("momentum").at_node(state.node));
        }
        state.R = R_moved;
        state.G = G_moved;
        state.place_rest_G = G_rest;
        state.q = q_moved;
        state.X = X_moved;
        state.place_rest_X = X_rest;
        state.momentum_R = SpatialMomentum(momentum_R_next);
        state.momentum_G = CarriedImpulse(momentum_G_next);
        state.momentum_rest_G = momentum_G_rest;
        state.momentum_q = SpatialMomentum(momentum_q_next);
        state.momentum_X = FieldMomentum(momentum_X_next);
        state.momentum_rest_X = momentum_X_rest;
        state.node += 1;
        work.search_2.remember(state.node - 1, &found_2);
        work.search_4.remember(state.node - 1, &found_4);
        Ok(())
    }
    /// Reports how far the step exceeds the bound, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn refused(
        &self,
        state: MixedFourState<T>,
        work: &MixedFourWorkspace<T>,
        e: Unsolved,
    ) -> StepError {
        let method = work.method;
        let e = e
            .with_searched_step(
                work.h.value(),
                |h| {
                    let h = T::from_f64(h);
                    let made = self
                        .step(
                            &mut { state },
                            &mut MixedFourWorkspace {
                                h,
                                method,
                                search_2: newton::Search::to_try(),
                                search_4: newton::Search::to_try(),
                            },
                        );
                    made.ok().map(|()| 0.0)
                },
            );
        StepCause::from(e).at_node(state.node)
    }
    /// The solution to use if the iteration fails or its solution may not be principal.
    /// `None` if the iteration restarts at the principal root.
    #[cold]
    #[inline(never)]
    fn settled_2(
        &self,
        h: T,
        state: MixedFourState<T>,
        given: (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        momenta: [SVector<T, 3>; 2],
        iteration: &mut newton::Newton<
            '_,
            T,
            [Rotation<T>; 1],
            3,
            [RigidMotion<T>; 1],
            6,
        >,
        ended: newton::Progress<[RigidMotion<T>; 1]>,
        method: Method,
    ) -> Result<Option<newton::Solved<[RigidMotion<T>; 1]>>, StepError> {
        let failed = match ended {
            newton::Progress::Continue => return Ok(None),
            newton::Progress::Solved(solved) => Ok(solved),
            newton::Progress::Failed(e) => Err(e),
        };
        let asked = failed.as_ref().ok().map(|solved| &solved.element);
        let traced = self
            .principal_2(h, &given, &momenta, iteration.verdict(asked), asked);
        let e = match (traced, failed) {
            (Ok(None), Ok(solved)) => return Ok(Some(solved)),
            (Ok(Some(root)), _) if iteration.restart(root) => return Ok(None),
            (Ok(_), Err(e)) => e,
            (Ok(_), Ok(_)) => iteration.unpolished(),
            (Err(fold), failed) => iteration.folded(fold, failed.err()),
        };
        if iteration.begin_afresh() {
            return Ok(None);
        }
        Err(self.refused_2(state, h, e, method))
    }
    /// Reports the equation with the largest residual, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn refused_2(
        &self,
        state: MixedFourState<T>,
        h: T,
        e: newton::NewtonError,
        method: Method,
    ) -> StepError {
        const CONFIGURATIONS: &[&str] = &["G"];
        let e = e
            .explained(
                h,
                &CONFIGURATIONS,
                |h, search| {
                    self.step(
                        &mut { state },
                        &mut MixedFourWorkspace {
                            h,
                            method,
                            search_2: search,
                            search_4: search.alike(),
                        },
                    )
                },
            );
        StepCause::from(e).at_node(state.node)
    }
    /// The trial with these rotations and the translations that follow from them.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn completed_at_2(
        parameters: &MixedFourParameters<T>,
        h: T,
        given: &(SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        momenta: &[SVector<T, 3>; 2],
        turned: &[Rotation<T>; 1],
    ) -> [RigidMotion<T>; 1] {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = *parameters;
        let G = given.0;
        let X = given.1.0;
        let W_pos_momentum = momenta[1];
        let W_pos = {
            let t1 = M.powi(-1);
            let t2 = motion_rotation(&G);
            W_pos_momentum * (h * t1)
                - t2.tr_mul(&(motion_translation(&G) - X + t2 * s))
                    * (T::from_f64(0.5) * (h * h) * k * t1)
        };
        [rigid_motion(turned[0], W_pos)]
    }
    /// The residual of the equations of a step.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn residual_at_2(
        parameters: &MixedFourParameters<T>,
        h: T,
        given: &(SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        momenta: &[SVector<T, 3>; 2],
        trial: &[RigidMotion<T>; 1],
    ) -> SVector<T, 6> {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = *parameters;
        let G = given.0;
        let X = given.1.0;
        let (W_rot, W_pos) = (trial[0].rotation.matrix(), trial[0].translation);
        let t1 = h.powi(-1);
        let t2 = motion_rotation(&G);
        let t3 = t2.transpose();
        let t4 = motion_translation(&G);
        joined::<
            T,
            2,
            6,
        >(
            &[
                (axial_of_difference(&(less_identity(&W_rot) * A)) * t1
                    + s.cross(&(t3 * (t4 - X))) * (T::from_f64(0.5) * h * k))
                    - momenta[0],
                (W_pos * (M * t1) + t3 * (t4 - X + t2 * s) * (T::from_f64(0.5) * h * k))
                    - momenta[1],
            ],
        )
    }
    /// The tangent of the residual.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn tangent_at_2(
        parameters: &MixedFourParameters<T>,
        h: T,
        given: &(SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        trial: &[RigidMotion<T>; 1],
    ) -> SMatrix<T, 6, 6> {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = *parameters;
        let G = given.0;
        let X = given.1.0;
        let (W_rot, W_pos) = (trial[0].rotation.matrix(), trial[0].translation);
        let t1 = h.powi(-1);
        let t2 = W_rot * A;
        assembled::<
            T,
            2,
            6,
        >(
            &[
                [trace_complement(&t2) * W_rot * t1, SMatrix::<T, 3, 3>::zeros()],
                [SMatrix::<T, 3, 3>::zeros(), W_rot * (M * t1)],
            ],
        )
    }
    /// Bounds of the rounding errors of the residual, in one lane.
    #[cold]
    #[inline(never)]
    fn rounding_2(
        &self,
        h: T,
        given: &(SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        momenta: &[SVector<T, 3>; 2],
        trial: &[RigidMotion<T>; 1],
        lane: usize,
    ) -> SVector<f64, 3> {
        let change = &mut |x: T| newton::Rounded::exactly(x.lane(lane));
        let parameters = self.parameters.over(change);
        let (step, given, momenta) = (
            h.over(change),
            given.over(change),
            momenta.map(|part| part.over(change)),
        );
        let change = &mut |x: T| newton::Rounded::once(x.lane(lane));
        let trial = [trial[0].over(change)];
        let trial = MixedFour::<
            newton::Rounded,
        >::completed_at_2(
            &parameters,
            step,
            &given,
            &momenta,
            &newton::Found::within(&trial),
        );
        {
            let all = MixedFour::<
                newton::Rounded,
            >::residual_at_2(&parameters, step, &given, &momenta, &trial)
                .map(|x| x.error());
            SVector::from([all[0], all[1], all[2]])
        }
    }
    /// Finds the principal root, or proves that the given solution is the principal root.
    #[cold]
    #[inline(never)]
    fn principal_2(
        &self,
        h: T,
        given: &(SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0])),
        momenta: &[SVector<T, 3>; 2],
        mut verdict: newton::Verdict<[RigidMotion<T>; 1], 6>,
        solution: Option<&[RigidMotion<T>; 1]>,
    ) -> Result<Option<newton::Anchor<[RigidMotion<T>; 1], 6>>, newton::Fold> {
        for lane in 0..T::LANES {
            let change = &mut |x: T| x.lane(lane);
            let (parameters, step) = (self.parameters.over(change), h.over(change));
            let (given, momenta) = (
                given.over(change),
                momenta.map(|part| part.over(change)),
            );
            let found = match solution {
                Some(found) => Some([found[0].over(change)]),
                None => None,
            };
            let equations = newton::Equations {
                residual: &|trial: &[RigidMotion<f64>; 1]| MixedFour::<
                    f64,
                >::residual_at_2(&parameters, step, &given, &momenta, trial),
                tangent: &|trial: &[RigidMotion<f64>; 1]| MixedFour::<
                    f64,
                >::tangent_at_2(&parameters, step, &given, trial),
            };
            if let Some(root) = verdict.trace(lane, &equations, found.as_ref())? {
                let all = verdict.root_mut();
                all[0] = all[0].over(&mut newton::Numbers::of(&root[0]).put(lane));
            }
        }
        Ok(verdict.elsewhere())
    }
    /// Reports how far the step exceeds the bound, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn refused_3(
        &self,
        state: MixedFourState<T>,
        work: &MixedFourWorkspace<T>,
        e: QuaternionError,
    ) -> StepError {
        let method = work.method;
        let e = e
            .with_searched_steps(
                work.h.value(),
                |h| {
                    let h = T::from_f64(h);
                    let made = self
                        .step(
                            &mut { state },
                            &mut MixedFourWorkspace {
                                h,
                                method,
                                search_2: newton::Search::to_try(),
                                search_4: newton::Search::to_try(),
                            },
                        );
                    made.ok().map(|()| 0.0)
                },
            );
        StepCause::from(e).at_node(state.node)
    }
    /// The solution to use if the iteration fails or its solution may not be principal.
    /// `None` if the iteration restarts at the principal root.
    #[cold]
    #[inline(never)]
    fn settled_4(
        &self,
        h: T,
        state: MixedFourState<T>,
        given: (SMatrix<T, 3, 3>, (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0]))),
        momenta: [SVector<T, 3>; 1],
        iteration: &mut newton::Newton<'_, T, [Additive<3, 1, T>; 1], 3>,
        ended: newton::Progress<[Additive<3, 1, T>; 1]>,
        method: Method,
    ) -> Result<Option<newton::Solved<[Additive<3, 1, T>; 1]>>, StepError> {
        let failed = match ended {
            newton::Progress::Continue => return Ok(None),
            newton::Progress::Solved(solved) => Ok(solved),
            newton::Progress::Failed(e) => Err(e),
        };
        let asked = failed.as_ref().ok().map(|solved| &solved.element);
        let traced = self
            .principal_4(h, &given, &momenta, iteration.verdict(asked), asked);
        let e = match (traced, failed) {
            (Ok(None), Ok(solved)) => return Ok(Some(solved)),
            (Ok(Some(root)), _) if iteration.restart(root) => return Ok(None),
            (Ok(_), Err(e)) => e,
            (Ok(_), Ok(_)) => iteration.unpolished(),
            (Err(fold), failed) => iteration.folded(fold, failed.err()),
        };
        if iteration.begin_afresh() {
            return Ok(None);
        }
        Err(self.refused_4(state, h, e, method))
    }
    /// Reports the equation with the largest residual, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn refused_4(
        &self,
        state: MixedFourState<T>,
        h: T,
        e: newton::NewtonError,
        method: Method,
    ) -> StepError {
        const CONFIGURATIONS: &[&str] = &["X"];
        let e = e
            .explained(
                h,
                &CONFIGURATIONS,
                |h, search| {
                    self.step(
                        &mut { state },
                        &mut MixedFourWorkspace {
                            h,
                            method,
                            search_2: search.alike(),
                            search_4: search,
                        },
                    )
                },
            );
        StepCause::from(e).at_node(state.node)
    }
    /// The residual of the equations of a step.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn residual_at_4(
        parameters: &MixedFourParameters<T>,
        h: T,
        given: &(SMatrix<T, 3, 3>, (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0]))),
        momenta: &[SVector<T, 3>; 1],
        trial: &[Additive<3, 1, T>; 1],
    ) -> SVector<T, 3> {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = *parameters;
        let R = given.0;
        let G = given.1.0;
        let X = given.1.1.0;
        let ΔX = trial[0].matrix();
        (ΔX * (T::from_f64(4.0) * b * ΔX.dot(&ΔX) / h.powi(3)) + ΔX * (m / h)
            - g * (T::from_f64(0.5) * h * m) - R * p * (T::from_f64(0.5) * h * k)
            + X * (h * k) - motion_rotation(&G) * s * (T::from_f64(0.5) * h * k)
            - motion_translation(&G) * (T::from_f64(0.5) * h * k)) - momenta[0]
    }
    /// The tangent of the residual.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn tangent_at_4(
        parameters: &MixedFourParameters<T>,
        h: T,
        given: &(SMatrix<T, 3, 3>, (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0]))),
        trial: &[Additive<3, 1, T>; 1],
    ) -> SMatrix<T, 3, 3> {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = *parameters;
        let R = given.0;
        let G = given.1.0;
        let X = given.1.1.0;
        let ΔX = trial[0].matrix();
        let m1 = h.powi(-3);
        let c1 = T::from_f64(4.0) * m1 * b;
        let c2 = T::from_f64(4.0) * m1 * b * ΔX.dot(&ΔX);
        let c3 = m / h;
        let mut matrix = SMatrix::<T, 3, 3>::zeros();
        for axis in 0..(3 * 1) {
            let η4 = array_basis::<T, 3, 1>(axis);
            let along = ΔX * (c1 * (η4.dot(&ΔX) + ΔX.dot(&η4))) + η4 * c2
                + η4 * c3;
            matrix.set_column(axis, &along);
        }
        matrix
    }
    /// Bounds of the rounding errors of the residual, in one lane.
    #[cold]
    #[inline(never)]
    fn rounding_4(
        &self,
        h: T,
        given: &(SMatrix<T, 3, 3>, (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0]))),
        momenta: &[SVector<T, 3>; 1],
        trial: &[Additive<3, 1, T>; 1],
        lane: usize,
    ) -> SVector<f64, 3> {
        let change = &mut |x: T| newton::Rounded::exactly(x.lane(lane));
        let parameters = self.parameters.over(change);
        let (step, given, momenta) = (
            h.over(change),
            given.over(change),
            [momenta[0].over(change)],
        );
        let change = &mut |x: T| newton::Rounded::once(x.lane(lane));
        let trial = [trial[0].over(change)];
        MixedFour::<
            newton::Rounded,
        >::residual_at_4(&parameters, step, &given, &momenta, &trial)
            .map(|x| x.error())
    }
    /// Finds the principal root, or proves that the given solution is the principal root.
    #[cold]
    #[inline(never)]
    fn principal_4(
        &self,
        h: T,
        given: &(SMatrix<T, 3, 3>, (SMatrix<T, 4, 4>, (SVector<T, 3>, [T; 0]))),
        momenta: &[SVector<T, 3>; 1],
        mut verdict: newton::Verdict<[Additive<3, 1, T>; 1], 3>,
        solution: Option<&[Additive<3, 1, T>; 1]>,
    ) -> Result<Option<newton::Anchor<[Additive<3, 1, T>; 1], 3>>, newton::Fold> {
        for lane in 0..T::LANES {
            let change = &mut |x: T| x.lane(lane);
            let (parameters, step) = (self.parameters.over(change), h.over(change));
            let (given, momenta) = (given.over(change), [momenta[0].over(change)]);
            let found = match solution {
                Some(found) => Some([found[0].over(change)]),
                None => None,
            };
            let equations = newton::Equations {
                residual: &|trial: &[Additive<3, 1, f64>; 1]| MixedFour::<
                    f64,
                >::residual_at_4(&parameters, step, &given, &momenta, trial),
                tangent: &|trial: &[Additive<3, 1, f64>; 1]| MixedFour::<
                    f64,
                >::tangent_at_4(&parameters, step, &given, trial),
            };
            if let Some(root) = verdict.trace(lane, &equations, found.as_ref())? {
                let all = verdict.root_mut();
                all[0] = all[0].over(&mut newton::Numbers::of(&root[0]).put(lane));
            }
        }
        Ok(verdict.elsewhere())
    }
    /// `relative_R_q` at the node of this state.
    #[inline]
    pub fn relative_R_q(&self, state: &MixedFourState<T>) -> SMatrix<T, 3, 3> {
        let R = state.R.matrix();
        let q = state.q.matrix();
        R.tr_mul(&quaternion_rotation(&q))
    }
}
::clebsch::stepper! {
    [] MixedFour,
    MixedFourParameters { J, A, M, I, m, b, k, p, s, e, g },
    MixedFourInitial { R, body_momentum_R, G, body_momentum_G, q, body_momentum_q, X,
        momentum_X },
    MixedFourState { R, momentum_R, G, momentum_G, place_rest_G, momentum_rest_G, q,
        momentum_q, X, momentum_X, place_rest_X, momentum_rest_X } at node,
    MixedFourWorkspace { h, method, search_2, search_4 },
    tried {} solver symmetric judged { 3 + 6 + 3 + (3 * 1) }
    start { R, momentum_R = body_momentum_R.to_space; G, momentum_G =
        body_momentum_G.carried; q, momentum_q = body_momentum_q.to_space; X, momentum_X
        = momentum_X } { place_rest_G, momentum_rest_G, place_rest_X, momentum_rest_X }
    observables { state.R, state.body_momentum_R, state.spatial_momentum_R, state.G,
        state.body_momentum_G, state.spatial_momentum_G, state.q, state.body_momentum_q,
        state.spatial_momentum_q, state.X, state.momentum_X, relative_R_q }
    invariants { total_momentum_angular_g }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedFourConfiguration<T = f64> {
    /// `R` at the node: body -> space.
    pub R: Rotation<T>,
    /// `G` at the node: body -> space.
    pub G: RigidMotion<T>,
    /// `q` at the node: body -> space.
    pub q: UnitQuaternion<T>,
    /// `X` at the node.
    pub X: Additive<3, 1, T>,
}
impl<T: Real> MixedFour<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &MixedFourConfiguration<T>,
        here: &MixedFourConfiguration<T>,
        after: &MixedFourConfiguration<T>,
    ) -> SVector<T, 15> {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = self
            .parameters;
        let R = here.R.matrix();
        let G = here.G.matrix();
        let q = here.q.matrix();
        let X = here.X.matrix();
        let relative_R_q = R.tr_mul(&quaternion_rotation(&q));
        let V_before = before.R.body_velocity(&here.R).matrix();
        let V = here.R.body_velocity(&after.R).matrix();
        let W_before = before.G.body_velocity(&here.G).matrix();
        let W = here.G.body_velocity(&after.G).matrix();
        let Y_before = before.q.body_velocity(&here.q).matrix();
        let Y = here.q.body_velocity(&after.q).matrix();
        let ΔX_before = before.X.spatial_velocity(&here.X).matrix();
        let ΔX = here.X.spatial_velocity(&after.X).matrix();
        let t1 = p.cross(&(relative_R_q * e_));
        let t2 = h.powi(-1);
        let t3 = motion_rotation(&G);
        let t4 = t3.transpose();
        let t5 = motion_translation(&G);
        let t6 = s.cross(&(t4 * (t5 - X))) * (T::from_f64(0.5) * h * k);
        let t7 = t4 * (t5 + t3 * s - X) * (T::from_f64(0.5) * h * k);
        let t8 = h.powi(-3);
        {
            let parts: (SVector<T, 3>, SVector<T, 6>, SVector<T, 3>, SVector<T, 3>) = (
                p.cross(&R.tr_mul(&X)) * (h * k) - t1 * (h * k)
                    + axial_of_difference(&(J * less_identity(&V_before))) * t2
                    + axial_of_difference(&(J * less_identity(&V.transpose()))) * t2,
                into_rows::<
                    T,
                    6,
                    3,
                    1,
                >(
                    &(axial_of_difference(
                        &(A * less_identity(&motion_rotation(&W_before))),
                    ) * t2 - t6),
                    0,
                )
                    + into_rows::<
                        T,
                        6,
                        3,
                        1,
                    >(
                        &(motion_rotation(&W_before)
                            .tr_mul(&motion_translation(&W_before)) * (t2 * M) - t7),
                        3,
                    )
                    - into_rows::<
                        T,
                        6,
                        3,
                        1,
                    >(
                        &(t6
                            - axial_of_difference(
                                &(A * less_identity(&motion_rotation(&W).transpose())),
                            ) * t2),
                        0,
                    )
                    - into_rows::<
                        T,
                        6,
                        3,
                        1,
                    >(&(motion_translation(&W) * (t2 * M) + t7), 3),
                quaternion_imaginary(
                    &Y_before
                        .tr_mul(
                            &pure_quaternion(
                                &diagonal_times(&I, &quaternion_imaginary(&Y_before)),
                            ),
                        ),
                ) * (T::from_f64(2.0) * t2) + relative_R_q.tr_mul(&t1) * (h * k)
                    - quaternion_imaginary(
                        &(Y
                            * pure_quaternion(
                                &diagonal_times(&I, &quaternion_imaginary(&Y)),
                            )),
                    ) * (T::from_f64(2.0) * t2),
                ΔX_before * (T::from_f64(4.0) * t8 * b * ΔX_before.dot(&ΔX_before))
                    + ΔX_before * (t2 * m) + g * (h * m) + R * p * (h * k)
                    - X * (T::from_f64(2.0) * h * k) + t3 * s * (h * k) + t5 * (h * k)
                    - ΔX * (T::from_f64(4.0) * t8 * b * ΔX.dot(&ΔX)) - ΔX * (t2 * m),
            );
            let mut all = SVector::<T, 15>::zeros();
            let rest = all.as_mut_slice();
            let rest = put_vector(rest, &parts.0);
            let rest = put_vector(rest, &parts.1);
            let rest = put_vector(rest, &parts.2);
            let rest = put_matrix(rest, &parts.3);
            let _ = rest;
            all
        }
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &MixedFourState<T>) -> SMatrix<T, 15, 15> {
        let MixedFourParameters { J, A, M, I, m, .. } = self.parameters;
        let mut inertia = SMatrix::<T, 15, 15>::zeros();
        for axis in 0..3 {
            let ξ1: SMatrix<T, 3, 3> = basis::<T>(axis);
            let ξ2: SVector<T, 6> = SMatrix::zeros();
            let ξ3: SVector<T, 3> = SMatrix::zeros();
            let ξ4: SVector<T, 3> = SMatrix::zeros();
            let t1 = vee(&ξ1);
            let along = {
                let parts: (
                    SVector<T, 3>,
                    SVector<T, 6>,
                    SVector<T, 3>,
                    SVector<T, 3>,
                ) = (
                    t1 * J.trace() - J * t1,
                    into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 3), 3) * M
                        + into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 0), 0)
                            * A.trace()
                        - into_rows::<
                            T,
                            6,
                            3,
                            1,
                        >(&(A * rows_from::<T, 6, 3, 1>(&ξ2, 0)), 0),
                    diagonal_times(&I, &ξ3),
                    ξ4 * m,
                );
                let mut all = SVector::<T, 15>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_vector(rest, &parts.0);
                let rest = put_vector(rest, &parts.1);
                let rest = put_vector(rest, &parts.2);
                let rest = put_matrix(rest, &parts.3);
                let _ = rest;
                all
            };
            inertia.set_column(axis, &along);
        }
        for axis in 0..6 {
            let ξ1: SMatrix<T, 3, 3> = SMatrix::zeros();
            let ξ2: SVector<T, 6> = unit::<T, 6>(axis);
            let ξ3: SVector<T, 3> = SMatrix::zeros();
            let ξ4: SVector<T, 3> = SMatrix::zeros();
            let t1 = vee(&ξ1);
            let along = {
                let parts: (
                    SVector<T, 3>,
                    SVector<T, 6>,
                    SVector<T, 3>,
                    SVector<T, 3>,
                ) = (
                    t1 * J.trace() - J * t1,
                    into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 3), 3) * M
                        + into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 0), 0)
                            * A.trace()
                        - into_rows::<
                            T,
                            6,
                            3,
                            1,
                        >(&(A * rows_from::<T, 6, 3, 1>(&ξ2, 0)), 0),
                    diagonal_times(&I, &ξ3),
                    ξ4 * m,
                );
                let mut all = SVector::<T, 15>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_vector(rest, &parts.0);
                let rest = put_vector(rest, &parts.1);
                let rest = put_vector(rest, &parts.2);
                let rest = put_matrix(rest, &parts.3);
                let _ = rest;
                all
            };
            inertia.set_column(3 + axis, &along);
        }
        for axis in 0..3 {
            let ξ1: SMatrix<T, 3, 3> = SMatrix::zeros();
            let ξ2: SVector<T, 6> = SMatrix::zeros();
            let ξ3: SVector<T, 3> = unit::<T, 3>(axis);
            let ξ4: SVector<T, 3> = SMatrix::zeros();
            let t1 = vee(&ξ1);
            let along = {
                let parts: (
                    SVector<T, 3>,
                    SVector<T, 6>,
                    SVector<T, 3>,
                    SVector<T, 3>,
                ) = (
                    t1 * J.trace() - J * t1,
                    into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 3), 3) * M
                        + into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 0), 0)
                            * A.trace()
                        - into_rows::<
                            T,
                            6,
                            3,
                            1,
                        >(&(A * rows_from::<T, 6, 3, 1>(&ξ2, 0)), 0),
                    diagonal_times(&I, &ξ3),
                    ξ4 * m,
                );
                let mut all = SVector::<T, 15>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_vector(rest, &parts.0);
                let rest = put_vector(rest, &parts.1);
                let rest = put_vector(rest, &parts.2);
                let rest = put_matrix(rest, &parts.3);
                let _ = rest;
                all
            };
            inertia.set_column(3 + 6 + axis, &along);
        }
        for axis in 0..(3 * 1) {
            let ξ1: SMatrix<T, 3, 3> = SMatrix::zeros();
            let ξ2: SVector<T, 6> = SMatrix::zeros();
            let ξ3: SVector<T, 3> = SMatrix::zeros();
            let ξ4: SVector<T, 3> = array_basis::<T, 3, 1>(axis);
            let t1 = vee(&ξ1);
            let along = {
                let parts: (
                    SVector<T, 3>,
                    SVector<T, 6>,
                    SVector<T, 3>,
                    SVector<T, 3>,
                ) = (
                    t1 * J.trace() - J * t1,
                    into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 3), 3) * M
                        + into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ2, 0), 0)
                            * A.trace()
                        - into_rows::<
                            T,
                            6,
                            3,
                            1,
                        >(&(A * rows_from::<T, 6, 3, 1>(&ξ2, 0)), 0),
                    diagonal_times(&I, &ξ3),
                    ξ4 * m,
                );
                let mut all = SVector::<T, 15>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_vector(rest, &parts.0);
                let rest = put_vector(rest, &parts.1);
                let rest = put_vector(rest, &parts.2);
                let rest = put_matrix(rest, &parts.3);
                let _ = rest;
                all
            };
            inertia.set_column(3 + 6 + 3 + axis, &along);
        }
        inertia
    }
    /// `(R_k μ_{1,k} + rot(G_k) ang(μ_{2,k}) + pos(G_k) × (rot(G_k) lin(μ_{2,k})) + rot(q_k) μ_{3,k} + X_k × ϖ_{4,k})·g`: Noether: the action is invariant under rotations about the axis in space.
    pub fn total_momentum_angular_g(&self, state: &MixedFourState<T>) -> T {
        let MixedFourParameters { g, .. } = self.parameters;
        let R = state.R.matrix();
        let G = state.G.matrix();
        let q = state.q.matrix();
        let X = state.X.matrix();
        let μ1 = state.body_momentum_R().0;
        let μ2 = state.body_momentum_G().0;
        let μ3 = state.body_momentum_q().0;
        let ϖ4 = state.momentum_X().0;
        let t1 = motion_rotation(&G);
        (R * μ1 + t1 * rows_from::<T, 6, 3, 1>(&μ2, 0)
            + motion_translation(&G).cross(&(t1 * rows_from::<T, 6, 3, 1>(&μ2, 3)))
            + quaternion_rotation(&q) * μ3 + X.cross(&ϖ4))
            .dot(&g)
    }
    /// The discrete energy of the edge between two consecutive states, `-tr(J V_k)/h² - tr(A rot(W_k))/h² + 2 M pos(W_k)·pos(W_k)/(2 h)² + 2 im(Y_k)·(I im(Y_k))/h² + 2 m ΔX_k·ΔX_k/(2 h)² + 3 b (ΔX_k·ΔX_k)² h²/h⁶ - ½ m g·X_k + ¼ k (X_k - R_k p)·(X_k - R_k p) + ¼ k (pos(G_k) + rot(G_k) s - X_k)·(pos(G_k) + rot(G_k) s - X_k) + ½ k e·(relative_{R,q,k}ᵀ p) - ½ m g·X_{k+1} + ¼ k (X_{k+1} - R_{k+1} p)·(X_{k+1} - R_{k+1} p) + ¼ k (pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1})·(pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1}) + ½ k e·(relative_{R,q,k+1}ᵀ p) + tr(J)/h² + tr(A)/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &MixedFourState<T>,
        after: &MixedFourState<T>,
    ) -> T {
        let MixedFourParameters { J, A, M, I, m, b, k, p, s, e: e_, g, .. } = self
            .parameters;
        let relative_R_q = self.relative_R_q(before);
        let relative_R_q_next = self.relative_R_q(after);
        let V_matrix = before.R.body_velocity(&after.R).matrix();
        let W_matrix = before
            .G
            .velocity_between(&before.place_rest_G, &after.G, &after.place_rest_G)
            .matrix();
        let Y_matrix = before.q.body_velocity(&after.q).matrix();
        let ΔX_matrix = before
            .X
            .velocity_between(&before.place_rest_X, &after.X, &after.place_rest_X)
            .matrix();
        let R = before.R.matrix();
        let G = before.G.matrix();
        let X = before.X.matrix();
        let R_next = after.R.matrix();
        let G_next = after.G.matrix();
        let X_next = after.X.matrix();
        let t1 = motion_translation(&W_matrix);
        let t2 = T::from_f64(2.0) * h * (T::from_f64(2.0) * h);
        let t3 = quaternion_imaginary(&Y_matrix);
        let t4 = ΔX_matrix.dot(&ΔX_matrix);
        let t5 = X - R * p;
        let t6 = motion_translation(&G) + motion_rotation(&G) * s - X;
        let t7 = X_next - R_next * p;
        let t8 = motion_translation(&G_next) + motion_rotation(&G_next) * s - X_next;
        T::from_f64(2.0) * M * t1.dot(&t1) / t2
            + T::from_f64(2.0) * t3.dot(&diagonal_times(&I, &t3)) / (h * h)
            + T::from_f64(2.0) * m * t4 / t2
            + T::from_f64(3.0) * b * (t4 * t4) * (h * h) / h.powi(6)
            - T::from_f64(0.5) * m * g.dot(&X) + T::from_f64(0.25) * k * t5.dot(&t5)
            + T::from_f64(0.25) * k * t6.dot(&t6)
            + T::from_f64(0.5) * k * e_.dot(&relative_R_q.tr_mul(&p))
            - T::from_f64(0.5) * m * g.dot(&X_next) + T::from_f64(0.25) * k * t7.dot(&t7)
            + T::from_f64(0.25) * k * t8.dot(&t8)
            + T::from_f64(0.5) * k * e_.dot(&relative_R_q_next.tr_mul(&p))
            - (J * less_identity(&V_matrix)).trace() / (h * h)
            - (A * less_identity(&motion_rotation(&W_matrix))).trace() / (h * h)
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(&self, state: &MixedFourState<T>, h: T) -> Option<MixedFourState<T>> {
        let mut moving = *state;
        self.step(
                &mut moving,
                &mut {
                    let method = self.method;
                    MixedFourWorkspace {
                        h,
                        method,
                        search_2: newton::Search::to_try(),
                        search_4: newton::Search::to_try(),
                    }
                },
            )
            .ok()?;
        Some(moving)
    }
}
impl MixedFour<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &MixedFourState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let MixedFourParameters { m, k, p, s, e: e_, g, .. } = self.parameters;
        let relative_R_q = self.relative_R_q(state);
        let R = state.R.matrix();
        let G = state.G.matrix();
        let q = state.q.matrix();
        let X = state.X.matrix();
        let s1 = (h * h).sqrt();
        let s2 = (k * k).sqrt();
        let s3 = p.dot(&p).sqrt();
        let s4 = R.tr_mul(&R).trace().sqrt();
        let s5 = X.dot(&X).sqrt();
        let s6 = relative_R_q.tr_mul(&relative_R_q).trace().sqrt();
        let s7 = e_.dot(&e_).sqrt();
        let s8 = s.dot(&s).sqrt();
        let s9 = motion_rotation(&G);
        let s10 = s9.tr_mul(&s9).trace().sqrt();
        let s11 = motion_translation(&G);
        let s12 = s11 + s9 * s - X;
        let s13 = s12.dot(&s12).sqrt();
        let s14 = s11.dot(&s11).sqrt();
        let s15 = s14 + s10 * s8 + s5;
        let impulse1 = s1 * s2 * s3 * s4 * s5 + s1 * s2 * s3 * s6 * s7;
        let impulse2 = s1 * s2 * s8 * s10 * s13 + s1 * s2 * s8 * s10 * s15;
        let impulse3 = s1 * s2 * s10 * s13 + s1 * s2 * s10 * s15;
        let impulse4 = s1 * s2 * s6 * s3 * s6 * s7;
        let impulse5 = s1 * (m * m).sqrt() * g.dot(&g).sqrt() + s1 * s2 * s4 * s3
            + T::from_f64(2.0) * s1 * s2 * s5 + s1 * s2 * s10 * s8 + s1 * s2 * s14;
        let state = &MixedFourState {
            momentum_R: SpatialMomentum(not_less(state.momentum_R.0, (0, 3), impulse1)),
            momentum_G: CarriedImpulse(
                not_less(
                    not_less(state.momentum_G.0, (0, 3), impulse2),
                    (3, 3),
                    impulse3,
                ),
            ),
            momentum_q: SpatialMomentum(not_less(state.momentum_q.0, (0, 3), impulse4)),
            momentum_X: FieldMomentum(not_less(state.momentum_X.0, (0, 3), impulse5)),
            ..*state
        };
        let μ1 = state.body_momentum_R().0;
        let μ2 = state.body_momentum_G().0;
        let μ3 = state.body_momentum_q().0;
        let ϖ4 = state.momentum_X().0;
        let t1 = R * μ1;
        let t2 = g.dot(&g).sqrt();
        let t3 = rows_from::<T, 6, 3, 1>(&μ2, 0);
        let t4 = motion_translation(&G);
        let t5 = rows_from::<T, 6, 3, 1>(&μ2, 3);
        let t6 = quaternion_rotation(&q) * μ3;
        put(
            out,
            [
                t1.dot(&t1).sqrt() * t2
                    + (t3.dot(&t3).sqrt() + t4.dot(&t4).sqrt() * t5.dot(&t5).sqrt()) * t2
                    + t6.dot(&t6).sqrt() * t2
                    + ϖ4.dot(&ϖ4).sqrt() * X.dot(&X).sqrt() * t2,
            ],
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "MixedFour",
        kebab: "mixed-four",
        doc: "Two rigid bodies with fixed points, a free rigid body and a point mass, coupled by springs.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J V_k)/h - tr(A rot(W_k))/h + M pos(W_k)·pos(W_k)/(2 h) + 2 im(Y_k)·(I im(Y_k))/h + m ΔX_k·ΔX_k/(2 h) + b (ΔX_k·ΔX_k)²/h³ + ½ h m g·X_k - ¼ h k (X_k - R_k p)·(X_k - R_k p) - ¼ h k (pos(G_k) + rot(G_k) s - X_k)·(pos(G_k) + rot(G_k) s - X_k) - ½ h k e·(relative_{R,q,k}ᵀ p) + ½ h m g·X_{k+1} - ¼ h k (X_{k+1} - R_{k+1} p)·(X_{k+1} - R_{k+1} p) - ¼ h k (pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1})·(pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1}) - ½ h k e·(relative_{R,q,k+1}ᵀ p)\nmomentum of R        -J V_kᵀ/h + V_k J/h\nmomentum of G        (-2 vee(A rot(W_k)ᵀ)/h, M pos(W_k)/h)\nmomentum of q        2 im(Y_k quat(I im(Y_k)))/h\nmomentum of X        4 b (ΔX_k·ΔX_k) ΔX_k/h³ + m ΔX_k/h\nRiccati form         exact, C = J; none: the group is not SO(n); none; in unit quaternions, A = I, β = 0; none: the balance is not linear in ΔX\ninvariants           total_momentum_angular_g\ntime reversal        symmetric: second order\ncertificate          51 identities proved by normal form, 10 (of three dimensions) by exact evaluation at random points modulo 2^61 - 1",
        solver: "Blocks: V by a Moser-Veselov solver, because its left factor is constant; W by Newton's method, because the group is not SO(n); Y by one scalar equation, because its coefficients are constant; ΔX by Newton's method, because the balance is not linear in ΔX",
        parameters: &[
            Kind::SecondMoments
                .field(
                    "J",
                    [3, 3],
                    "second moments of mass of the first body about its fixed point, body frame",
                ),
            Kind::SecondMoments
                .field(
                    "A",
                    [3, 3],
                    "second moments of mass of the free body about its reference point, body frame",
                ),
            Kind::Scalar.field("M", [1, 1], "mass of the free body"),
            Kind::Diagonal
                .field("I", [3, 3], "principal moments of inertia of the second body"),
            Kind::Scalar.field("m", [1, 1], "mass of the point mass"),
            Kind::Scalar
                .field(
                    "b",
                    [1, 1],
                    "coefficient of the quartic kinetic energy of the point mass",
                ),
            Kind::Scalar.field("k", [1, 1], "stiffness of the springs"),
            Kind::Vector
                .field(
                    "p",
                    [3, 1],
                    "attachment points of the springs, body frames: first body, free body, second body",
                ),
            Kind::Vector
                .field(
                    "s",
                    [3, 1],
                    "attachment points of the springs, body frames: first body, free body, second body",
                ),
            Kind::Vector
                .field(
                    "e",
                    [3, 1],
                    "attachment points of the springs, body frames: first body, free body, second body",
                ),
            Kind::Vector
                .field(
                    "g",
                    [3, 1],
                    "gravitational acceleration of the point mass, space frame",
                ),
        ],
        initial: &[
            Kind::Rotation
                .field("R", [3, 3], "attitude of the first body, body to space"),
            Kind::BodyMomentum.field("body_momentum_R", [3, 1], "momentum, body frame"),
            Kind::RigidMotion
                .field(
                    "G",
                    [4, 4],
                    "position and attitude of the free body, body to space",
                ),
            Kind::BodyMomentum.field("body_momentum_G", [6, 1], "momentum, body frame"),
            Kind::UnitQuaternion
                .field("q", [4, 1], "attitude of the second body, body to space"),
            Kind::BodyMomentum.field("body_momentum_q", [3, 1], "momentum, body frame"),
            Kind::Vector.field("X", [3, 1], "position of the point mass, space frame"),
            Kind::FieldMomentum.field("momentum_X", [3, 1], "momentum of X"),
        ],
        observables: &[
            Kind::Rotation
                .field("R", [3, 3], "attitude of the first body, body to space"),
            Kind::BodyMomentum.field("body_momentum_R", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum_R", [3, 1], "momentum, space frame"),
            Kind::RigidMotion
                .field(
                    "G",
                    [4, 4],
                    "position and attitude of the free body, body to space",
                ),
            Kind::BodyMomentum.field("body_momentum_G", [6, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum_G", [6, 1], "momentum, space frame"),
            Kind::UnitQuaternion
                .field("q", [4, 1], "attitude of the second body, body to space"),
            Kind::BodyMomentum.field("body_momentum_q", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum_q", [3, 1], "momentum, space frame"),
            Kind::Vector.field("X", [3, 1], "position of the point mass, space frame"),
            Kind::FieldMomentum.field("momentum_X", [3, 1], "momentum of X"),
            Kind::Matrix.field("relative_R_q", [3, 3], ""),
        ],
        invariants: &[
            Invariant::exact(
                "total_momentum_angular_g",
                "(R_k μ_{1,k} + rot(G_k) ang(μ_{2,k}) + pos(G_k) × (rot(G_k) lin(μ_{2,k})) + rot(q_k) μ_{3,k} + X_k × ϖ_{4,k})·g",
                1usize,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-tr(J V_k)/h² - tr(A rot(W_k))/h² + 2 M pos(W_k)·pos(W_k)/(2 h)² + 2 im(Y_k)·(I im(Y_k))/h² + 2 m ΔX_k·ΔX_k/(2 h)² + 3 b (ΔX_k·ΔX_k)² h²/h⁶ - ½ m g·X_k + ¼ k (X_k - R_k p)·(X_k - R_k p) + ¼ k (pos(G_k) + rot(G_k) s - X_k)·(pos(G_k) + rot(G_k) s - X_k) + ½ k e·(relative_{R,q,k}ᵀ p) - ½ m g·X_{k+1} + ¼ k (X_{k+1} - R_{k+1} p)·(X_{k+1} - R_{k+1} p) + ¼ k (pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1})·(pos(G_{k+1}) + rot(G_{k+1}) s - X_{k+1}) + ½ k e·(relative_{R,q,k+1}ᵀ p) + tr(J)/h² + tr(A)/h²",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
