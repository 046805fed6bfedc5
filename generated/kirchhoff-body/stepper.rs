// Written by `clebsch derive --write`. Do not edit.

//! The model [`KirchhoffBody`](struct@KirchhoffBody) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`KirchhoffBody`](struct@KirchhoffBody).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBodyParameters<T = f64> {
    /// `J`: Poinsot matrix of the rotational inertia plus the added inertia of the fluid, body frame; a matrix of size 3 x 3, symmetric.
    pub J: SMatrix<T, 3, 3>,
    /// `M`: mass plus added mass, body frame; a matrix of size 3 x 3, symmetric.
    pub M: SMatrix<T, 3, 3>,
    /// `D`: coupling of angular and linear velocity, body frame; a matrix of size 3 x 3.
    pub D: SMatrix<T, 3, 3>,
    /// `b`: (moment of weight minus buoyancy, net weight), body frame; a vector of 4 components.
    pub b: SVector<T, 4>,
    /// `Z`: (vertical (up), 0), the plane of height 0, space frame; a vector of 4 components.
    pub Z: SVector<T, 4>,
}
/// Rigid body in an ideal fluid, with added mass, rotation-translation coupling and net weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBody<T = f64> {
    parameters: KirchhoffBodyParameters<T>,
    inverse_1: SMatrix<T, 3, 3>,
}
impl<T: Real> KirchhoffBody<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Rigid body in an ideal fluid, with added mass, rotation-translation coupling and net weight.\npub model KirchhoffBody {\n    /// Poinsot matrix of the rotational inertia plus the added inertia of the fluid, body frame\n    param J: Sym<3>;\n    /// mass plus added mass, body frame\n    param M: Sym<3>;\n    /// coupling of angular and linear velocity, body frame\n    param D: Mat<3>;\n    /// (moment of weight minus buoyancy, net weight), body frame\n    param b: Vec<4>;\n    /// (vertical (up), 0), the plane of height 0, space frame\n    param Z: Vec<4>;\n    /// position and attitude, body to space\n    group G: SE<3> velocity V;\n    /// (vertical, height), body frame\n    advected P: Vec<4> = G^T*Z;\n    constraint next(G) = G*V;\n    constraint next(P) = V^T*P;\n    lagrangian = -tr(J*rot(V))/h + dot((1/2)*(pos(V) + rot(V)^T*pos(V)), (1/2)*M*(pos(V) + rot(V)^T*pos(V)))/(2*h) + dot(vee(rot(V)), (1/2)*D*(pos(V) + rot(V)^T*pos(V)))/h - h*dot(b, P);\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 2595064832746986287u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: KirchhoffBodyParameters<T>) -> Result<Self, ParameterError> {
        validate::finite_entries("J", &parameters.J)?;
        validate::symmetric("J", &parameters.J)?;
        validate::finite_entries("M", &parameters.M)?;
        validate::symmetric("M", &parameters.M)?;
        validate::finite_entries("D", &parameters.D)?;
        validate::finite("b", parameters.b.as_slice())?;
        validate::finite("Z", parameters.Z.as_slice())?;
        let KirchhoffBodyParameters { M, .. } = parameters;
        let inverse_1 = inverse_or_nan(&(M));
        Ok(Self { parameters, inverse_1 })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBodyInitial<T = f64> {
    /// `G` at node 0: body -> space.
    pub G: RigidMotion<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyImpulse<T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame (of a rigid motion about the body's own origin), advected quantities as their values at the identity, so that rounding errors do not accumulate. Positions and their momenta are stored as two numbers, the second below the rounding of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBodyState<T = f64> {
    G: RigidMotion<T>,
    momentum: CarriedImpulse<T>,
    place_rest: SMatrix<T, 3, 1>,
    momentum_rest: SVector<T, 6>,
    node: u64,
}
impl<T: Real> KirchhoffBodyState<T> {
    /// `G` at this node: body -> space.
    pub fn G(&self) -> RigidMotion<T> {
        self.G
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum(&self) -> SpatialImpulse<T> {
        self.momentum.to_space(&self.G)
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum(&self) -> BodyImpulse<T> {
        self.momentum.to_body(&self.G)
    }
}
/// The step size, and the last velocities as initial guesses for the next step.
#[derive(Clone, Copy, Debug)]
pub struct KirchhoffBodyWorkspace<T = f64> {
    h: T,
    search: newton::Search<T, [Rotation<T>; 1], 3, [RigidMotion<T>; 1], 6>,
}
impl<T: Real> KirchhoffBodyWorkspace<T> {
    /// The tangents and corrections of the last step, and the residual before its last correction.
    pub fn solved(&self) -> newton::Summary {
        self.search.last()
    }
}
impl<T: Real> KirchhoffBody<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        _: &KirchhoffBodyState<T>,
        h: T,
        _: (),
    ) -> Result<KirchhoffBodyWorkspace<T>, StartError> {
        Ok(KirchhoffBodyWorkspace {
            h,
            search: newton::Search::from_rest(),
        })
    }
    /// One step, in place. Method: Newton's method on the derived residual, because the group is not SO(n).
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut KirchhoffBodyState<T>,
        work: &mut KirchhoffBodyWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let KirchhoffBodyParameters { J, M, D, b, Z, .. } = self.parameters;
        let G = state.G.matrix();
        let P = G.tr_mul(&Z);
        let found: newton::Solved<[RigidMotion<T>; 1]> = {
            let momenta_six = state.momentum.to_body(&state.G).0;
            let momenta: [SVector<T, 3>; 2] = [
                rows_from::<T, 6, 3, 1>(&momenta_six, 0),
                rows_from::<T, 6, 3, 1>(&momenta_six, 3),
            ];
            let V_pos_momentum = momenta[1];
            let k3 = self.inverse_1;
            let s1 = b[3];
            let k1 = h.powi(-1);
            let k2 = rows_from::<T, 4, 3, 1>(&b, 0)
                .cross(&rows_from::<T, 4, 3, 1>(&P, 0)) * (T::from_f64(0.5) * h);
            let k4 = rows_from::<T, 4, 3, 1>(&P, 0) * (T::from_f64(0.5) * h * s1);
            let k5 = V_pos_momentum * (T::from_f64(4.0) * h)
                - rows_from::<T, 4, 3, 1>(&P, 0) * (T::from_f64(2.0) * (h * h) * s1);
            let mut iteration = work.search.begin(state.node);
            loop {
                let turned = iteration.trial();
                let V_rot = turned[0].matrix();
                let V_rot_turn = turned[0].rodrigues();
                let V_pos_1 = (k5 - V_rot_turn.cross(&k5)) * T::from_f64(0.5)
                    - D.tr_mul(&vee(&V_rot)) * T::from_f64(2.0);
                let V_pos_2 = k3 * V_pos_1;
                let V_pos = (V_pos_2 + V_rot_turn.cross(&V_pos_2)) * T::from_f64(0.5);
                let trial = [rigid_motion(turned[0], V_pos)];
                if iteration.wants_scale() {
                    iteration
                        .set_scale(move |lane| {
                            self.rounding(h, &(P, []), &momenta, &trial, lane)
                        });
                }
                let (V_rot, V_pos) = (trial[0].rotation.matrix(), trial[0].translation);
                if iteration.wants_residual()
                    && iteration
                        .assess({
                            ((V_pos
                                .cross(
                                    &(V_pos_1 * T::from_f64(0.25)
                                        + D.tr_mul(&vee(&V_rot)) * T::from_f64(0.5)),
                                )
                                + vee(
                                    &(crossing(&V_rot, &(D * V_pos_2)) * T::from_f64(0.5)
                                        + V_rot * J * T::from_f64(2.0)),
                                )) * k1 + k2) - momenta[0]
                        })
                {
                    iteration
                        .set_tangent_times(
                            &{
                                let t1 = V_pos_1 * T::from_f64(0.25)
                                    + D.tr_mul(&vee(&V_rot)) * T::from_f64(0.5);
                                let t2 = SMatrix::<T, 3, 3>::identity() * V_rot.trace();
                                let t3 = D.tr_mul(&(t2 - V_rot)) - crossing(&M, &V_pos);
                                crossing(
                                    &(hat(&t1)
                                        - (t2 - V_rot.transpose()) * D * T::from_f64(0.25)),
                                    &V_pos,
                                ) + V_rot * (-(hat(&(D * V_pos_2)) * T::from_f64(0.25)) - J)
                                    + crossed(&V_pos, &t3) * T::from_f64(0.25)
                                    + SMatrix::<T, 3, 3>::identity()
                                        * (T::from_f64(0.25)
                                            * crossing(&V_rot, &(D * V_pos_2)).trace()
                                            + (V_rot * J).trace())
                                    - (t3.transpose() * T::from_f64(0.25)
                                        + (-hat(&t1) - crossed(&t1, &hat(&V_rot_turn)))
                                            * T::from_f64(0.5))
                                        * (k3
                                            * (t3 * T::from_f64(0.25)
                                                + (crossed(&V_rot_turn, &hat(&(V_rot * t1)))
                                                    - hat(&(V_rot * t1))) * T::from_f64(0.5)))
                                        * T::from_f64(4.0)
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
                                joined::<T, 2, 6>(&[(k2) - momenta[0], (k4) - momenta[1]])
                            },
                            || {
                                Self::tangent_at(
                                    &self.parameters,
                                    h,
                                    &(P, []),
                                    &Group::<T>::identity(),
                                )
                            },
                        ) => break solved,
                    ended => {
                        if let Some(solved) = self
                            .settled(h, *state, (P, []), momenta, &mut iteration, ended)?
                        {
                            break solved;
                        }
                    }
                }
            }
        };
        let solved = found.element;
        let V_matrix = solved[0].matrix();
        let G_velocity = solved[0];
        let (G_moved, G_rest) = state.G.moved(&G_velocity, &state.place_rest);
        let G_next = G_moved.matrix();
        let P_next = G_next.tr_mul(&Z);
        let t1 = rows_from::<T, 4, 3, 1>(&b, 0);
        let t2 = b[3];
        let (momentum_next, momentum_rest) = added(
            &state.momentum.0,
            &state.momentum_rest,
            &({
                let leaving = state
                    .G
                    .covector_turned(
                        &(-(into_rows::<
                            T,
                            6,
                            3,
                            1,
                        >(&t1.cross(&rows_from::<T, 4, 3, 1>(&P, 0)), 0)
                            * (T::from_f64(0.5) * h))
                            - into_rows::<T, 6, 3, 1>(&rows_from::<T, 4, 3, 1>(&P, 0), 3)
                                * (T::from_f64(0.5) * h * t2)),
                    );
                leaving
                    + state.G.gained_along(&G_velocity, &(state.momentum.0 + leaving))
                    + G_moved
                        .covector_turned(
                            &(-(into_rows::<
                                T,
                                6,
                                3,
                                1,
                            >(&t1.cross(&rows_from::<T, 4, 3, 1>(&P_next, 0)), 0)
                                * (T::from_f64(0.5) * h))
                                - into_rows::<
                                    T,
                                    6,
                                    3,
                                    1,
                                >(&rows_from::<T, 4, 3, 1>(&P_next, 0), 3)
                                    * (T::from_f64(0.5) * h * t2)),
                        )
            }),
        );
        if !(all_finite(&momentum_next)) {
            return Err(StepCause::not_finite("momentum").at_node(state.node));
        }
        state.G = G_moved;
        state.place_rest = G_rest;
        state.momentum = CarriedImpulse(momentum_next);
        state.momentum_rest = momentum_rest;
        state.node += 1;
        work.search.remember(state.node - 1, &found);
        Ok(())
    }
    /// The solution to use if the iteration fails or its solution may not be principal.
    /// `None` if the iteration restarts at the principal root.
    #[cold]
    #[inline(never)]
    fn settled(
        &self,
        h: T,
        state: KirchhoffBodyState<T>,
        given: (SVector<T, 4>, [T; 0]),
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
    ) -> Result<Option<newton::Solved<[RigidMotion<T>; 1]>>, StepError> {
        let failed = match ended {
            newton::Progress::Continue => return Ok(None),
            newton::Progress::Solved(solved) => Ok(solved),
            newton::Progress::Failed(e) => Err(e),
        };
        let asked = failed.as_ref().ok().map(|solved| &solved.element);
        let traced = self
            .principal(h, &given, &momenta, iteration.verdict(asked), asked);
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
        Err(self.refused(state, h, e))
    }
    /// Reports the equation with the largest residual, and a step size that succeeds.
    #[cold]
    #[inline(never)]
    fn refused(
        &self,
        state: KirchhoffBodyState<T>,
        h: T,
        e: newton::NewtonError,
    ) -> StepError {
        const CONFIGURATIONS: &[&str] = &["G"];
        let e = e
            .explained(
                h,
                &CONFIGURATIONS,
                |h, search| {
                    self.step(
                        &mut { state },
                        &mut KirchhoffBodyWorkspace {
                            h,
                            search,
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
    fn completed_at(
        parameters: &KirchhoffBodyParameters<T>,
        h: T,
        given: &(SVector<T, 4>, [T; 0]),
        momenta: &[SVector<T, 3>; 2],
        turned: &[Rotation<T>; 1],
    ) -> [RigidMotion<T>; 1] {
        let KirchhoffBodyParameters { J, M, D, b, Z, .. } = *parameters;
        let P = given.0;
        let V_pos_momentum = momenta[1];
        let V_rot = turned[0].matrix();
        let V_rot_turn = turned[0].rodrigues();
        let V_pos_1 = {
            let t1 = V_pos_momentum * (T::from_f64(4.0) * h);
            let t2 = -(rows_from::<T, 4, 3, 1>(&P, 0)
                * (T::from_f64(2.0) * (h * h) * b[3]));
            (t1 + t2 - V_rot_turn.cross(&(t1 + t2))) * T::from_f64(0.5)
                - D.tr_mul(&vee(&V_rot)) * T::from_f64(2.0)
        };
        let V_pos_2 = inverse_or_nan(&M) * V_pos_1;
        let V_pos = (V_pos_2 + V_rot_turn.cross(&V_pos_2)) * T::from_f64(0.5);
        [rigid_motion(turned[0], V_pos)]
    }
    /// The residual of the equations of a step.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn residual_at(
        parameters: &KirchhoffBodyParameters<T>,
        h: T,
        given: &(SVector<T, 4>, [T; 0]),
        momenta: &[SVector<T, 3>; 2],
        trial: &[RigidMotion<T>; 1],
    ) -> SVector<T, 6> {
        let KirchhoffBodyParameters { J, M, D, b, Z, .. } = *parameters;
        let P = given.0;
        let (V_rot, V_pos) = (trial[0].rotation.matrix(), trial[0].translation);
        let t1 = h.powi(-1);
        let t2 = V_rot.tr_mul(&V_pos) + V_pos;
        let t3 = M * t2 * T::from_f64(0.25);
        let t4 = D.tr_mul(&vee(&V_rot)) * T::from_f64(0.5);
        let t5 = t3 + t4;
        joined::<
            T,
            2,
            6,
        >(
            &[
                ((V_pos.cross(&t5)
                    + vee(
                        &(crossing(&V_rot, &(D * t2)) * T::from_f64(0.5)
                            + V_rot * J * T::from_f64(2.0)),
                    )) * t1
                    + rows_from::<T, 4, 3, 1>(&b, 0)
                        .cross(&rows_from::<T, 4, 3, 1>(&P, 0)) * (T::from_f64(0.5) * h))
                    - momenta[0],
                ((V_rot * t5 + t3 + t4) * t1
                    + rows_from::<T, 4, 3, 1>(&P, 0) * (T::from_f64(0.5) * h * b[3]))
                    - momenta[1],
            ],
        )
    }
    /// The tangent of the residual.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn tangent_at(
        parameters: &KirchhoffBodyParameters<T>,
        h: T,
        given: &(SVector<T, 4>, [T; 0]),
        trial: &[RigidMotion<T>; 1],
    ) -> SMatrix<T, 6, 6> {
        let KirchhoffBodyParameters { J, M, D, b, Z, .. } = *parameters;
        let P = given.0;
        let (V_rot, V_pos) = (trial[0].rotation.matrix(), trial[0].translation);
        let t1 = h.powi(-1);
        let t2 = V_rot.tr_mul(&V_pos);
        let t3 = t2 + V_pos;
        let t4 = crossing(&V_rot, &(D * t3));
        let t5 = V_rot * J;
        let t6 = trace_complement(&V_rot.transpose());
        let t7 = crossing(&M, &t2) + D.tr_mul(&t6);
        let t8 = SMatrix::<T, 3, 3>::identity() + V_rot;
        assembled::<
            T,
            2,
            6,
        >(
            &[
                [
                    ((trace_complement(&t4) * T::from_f64(0.25)
                        + SMatrix::<T, 3, 3>::identity() * t5.trace() - t5) * V_rot
                        + crossed(&V_pos, &t7) * T::from_f64(0.25)
                        + t6 * crossing(&D, &t2) * T::from_f64(0.25)) * t1,
                    ((crossed(&V_pos, &M) + t6 * D) * t8 * T::from_f64(0.25)
                        - crossed(
                            &(M * t3 * T::from_f64(0.25)
                                + D.tr_mul(&vee(&V_rot)) * T::from_f64(0.5)),
                            &V_rot,
                        )) * t1,
                ],
                [
                    (t8 * t7 * T::from_f64(0.25)
                        - crossing(
                            &V_rot,
                            &(M * t3 * T::from_f64(0.25)
                                + D.tr_mul(&vee(&V_rot)) * T::from_f64(0.5)),
                        )) * t1,
                    t8 * (M * t8) * (T::from_f64(0.25) * t1),
                ],
            ],
        )
    }
    /// Bounds of the rounding errors of the residual, in one lane.
    #[cold]
    #[inline(never)]
    fn rounding(
        &self,
        h: T,
        given: &(SVector<T, 4>, [T; 0]),
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
        let trial = KirchhoffBody::<
            newton::Rounded,
        >::completed_at(
            &parameters,
            step,
            &given,
            &momenta,
            &newton::Found::within(&trial),
        );
        {
            let all = KirchhoffBody::<
                newton::Rounded,
            >::residual_at(&parameters, step, &given, &momenta, &trial)
                .map(|x| x.error());
            SVector::from([all[0], all[1], all[2]])
        }
    }
    /// Finds the principal root, or proves that the given solution is the principal root.
    #[cold]
    #[inline(never)]
    fn principal(
        &self,
        h: T,
        given: &(SVector<T, 4>, [T; 0]),
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
                residual: &|trial: &[RigidMotion<f64>; 1]| KirchhoffBody::<
                    f64,
                >::residual_at(&parameters, step, &given, &momenta, trial),
                tangent: &|trial: &[RigidMotion<f64>; 1]| KirchhoffBody::<
                    f64,
                >::tangent_at(&parameters, step, &given, trial),
            };
            if let Some(root) = verdict.trace(lane, &equations, found.as_ref())? {
                let all = verdict.root_mut();
                all[0] = all[0].over(&mut newton::Numbers::of(&root[0]).put(lane));
            }
        }
        Ok(verdict.elsewhere())
    }
    /// `P` at the node of this state.
    #[inline]
    pub fn P(&self, state: &KirchhoffBodyState<T>) -> SVector<T, 4> {
        let KirchhoffBodyParameters { Z, .. } = self.parameters;
        let G = state.G.matrix();
        G.tr_mul(&Z)
    }
}
::clebsch::stepper! {
    [] KirchhoffBody,
    KirchhoffBodyParameters { J, M, D, b, Z },
    KirchhoffBodyInitial { G, body_momentum },
    KirchhoffBodyState { G, momentum, place_rest, momentum_rest } at node,
    KirchhoffBodyWorkspace { h, search },
    tried {} nothing symmetric judged { 6 }
    start { G, momentum = body_momentum.carried } { place_rest, momentum_rest }
    observables { state.G, state.body_momentum, state.spatial_momentum, P }
    invariants { energy, P_part_squared, momentum_linear_across_P_part_squared,
        spatial_momentum_linear_across_Z, spatial_momentum_angular_Z }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBodyConfiguration<T = f64> {
    /// `G` at the node: body -> space.
    pub G: RigidMotion<T>,
}
impl<T: Real> KirchhoffBody<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &KirchhoffBodyConfiguration<T>,
        here: &KirchhoffBodyConfiguration<T>,
        after: &KirchhoffBodyConfiguration<T>,
    ) -> SVector<T, 6> {
        let KirchhoffBodyParameters { J, M, D, b, Z, .. } = self.parameters;
        let G = here.G.matrix();
        let P = G.tr_mul(&Z);
        let V_before = before.G.body_velocity(&here.G).matrix();
        let V = here.G.body_velocity(&after.G).matrix();
        let t1 = h.powi(-1);
        let t2 = motion_rotation(&V_before);
        let t3 = t2.transpose();
        let t4 = motion_translation(&V_before);
        let t5 = t3 * t4;
        let t6 = vee(&t2);
        let t7 = rows_from::<T, 4, 3, 1>(&b, 0).cross(&rows_from::<T, 4, 3, 1>(&P, 0))
            * (T::from_f64(0.5) * h);
        let t8 = rows_from::<T, 4, 3, 1>(&P, 0) * (T::from_f64(0.5) * h * b[3]);
        let t9 = motion_rotation(&V);
        let t10 = t9.transpose();
        let t11 = motion_translation(&V);
        let t12 = vee(&t9);
        into_rows::<
            T,
            6,
            3,
            1,
        >(
            &((M * (t3 * t4)).cross(&t5) * (T::from_f64(0.25) * t1)
                + (M * t4).cross(&t5) * (T::from_f64(0.25) * t1)
                + D.tr_mul(&t6).cross(&t5) * (T::from_f64(0.5) * t1)
                + axial_of_difference(&(J * t2)) * t1
                + axial_of_difference(&crossing(&t3, &(D * (t3 * t4))))
                    * (T::from_f64(0.25) * t1)
                + axial_of_difference(&crossing(&t3, &(D * t4)))
                    * (T::from_f64(0.25) * t1) - t7),
            0,
        )
            + into_rows::<
                T,
                6,
                3,
                1,
            >(
                &(M * (t3 * t4) * (T::from_f64(0.25) * t1)
                    + M * t4 * (T::from_f64(0.25) * t1)
                    + D.tr_mul(&t6) * (T::from_f64(0.5) * t1)
                    + t3 * (M * (t3 * t4)) * (T::from_f64(0.25) * t1)
                    + t3 * (M * t4) * (T::from_f64(0.25) * t1)
                    + t3 * D.tr_mul(&t6) * (T::from_f64(0.5) * t1) - t8),
                3,
            )
            - into_rows::<
                T,
                6,
                3,
                1,
            >(
                &(axial_of_difference(&crossing(&t9, &(D * (t10 * t11))))
                    * (T::from_f64(0.25) * t1)
                    - (M * (t10 * t11)).cross(&t11) * (T::from_f64(0.25) * t1)
                    - (M * t11).cross(&t11) * (T::from_f64(0.25) * t1)
                    - D.tr_mul(&t12).cross(&t11) * (T::from_f64(0.5) * t1)
                    - axial_of_difference(&(J * t10)) * t1
                    + axial_of_difference(&crossing(&t9, &(D * t11)))
                        * (T::from_f64(0.25) * t1) + t7),
                0,
            )
            - into_rows::<
                T,
                6,
                3,
                1,
            >(
                &(M * (t10 * t11) * (T::from_f64(0.25) * t1)
                    + M * t11 * (T::from_f64(0.25) * t1)
                    + D.tr_mul(&t12) * (T::from_f64(0.5) * t1)
                    + t9 * (M * (t10 * t11)) * (T::from_f64(0.25) * t1)
                    + t9 * (M * t11) * (T::from_f64(0.25) * t1)
                    + t9 * D.tr_mul(&t12) * (T::from_f64(0.5) * t1) + t8),
                3,
            )
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &KirchhoffBodyState<T>) -> SMatrix<T, 6, 6> {
        let KirchhoffBodyParameters { J, M, D, .. } = self.parameters;
        columns(|axis| {
            let ξ: SVector<T, 6> = unit::<T, 6>(axis);
            into_rows::<T, 6, 3, 1>(&rows_from::<T, 6, 3, 1>(&ξ, 0), 0) * J.trace()
                - into_rows::<T, 6, 3, 1>(&(J * rows_from::<T, 6, 3, 1>(&ξ, 0)), 0)
                + into_rows::<T, 6, 3, 1>(&(D * rows_from::<T, 6, 3, 1>(&ξ, 3)), 0)
                + into_rows::<T, 6, 3, 1>(&D.tr_mul(&rows_from::<T, 6, 3, 1>(&ξ, 0)), 3)
                + into_rows::<T, 6, 3, 1>(&(M * rows_from::<T, 6, 3, 1>(&ξ, 3)), 3)
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &KirchhoffBodyState<T>) -> (T, T) {
        let KirchhoffBodyParameters { b, .. } = self.parameters;
        let P = self.P(state);
        let momentum = state.body_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 6);
        (momentum.dot(&velocity) * T::from_f64(0.5), b.dot(&P))
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &KirchhoffBodyState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `P_k[1:3]·P_k[1:3]`: Casimir: invariant under the group action.
    pub fn P_part_squared(&self, state: &KirchhoffBodyState<T>) -> T {
        let P = self.P(state);
        let t1 = rows_from::<T, 4, 3, 1>(&P, 0);
        t1.dot(&t1)
    }
    /// `(lin(μ_k) × P_k[1:3])·(lin(μ_k) × P_k[1:3])`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn momentum_linear_across_P_part_squared(
        &self,
        state: &KirchhoffBodyState<T>,
    ) -> T {
        let P = self.P(state);
        let μ = state.body_momentum().0;
        let t1 = rows_from::<T, 6, 3, 1>(&μ, 3).cross(&rows_from::<T, 4, 3, 1>(&P, 0));
        t1.dot(&t1)
    }
    /// `Z[1:3] × (rot(G_k) lin(μ_k))`: Noether: the action is invariant under translations.
    pub fn spatial_momentum_linear_across_Z(
        &self,
        state: &KirchhoffBodyState<T>,
    ) -> SVector<T, 3> {
        let KirchhoffBodyParameters { Z, .. } = self.parameters;
        let G = state.G.matrix();
        let μ = state.body_momentum().0;
        rows_from::<T, 4, 3, 1>(&Z, 0)
            .cross(&(motion_rotation(&G) * rows_from::<T, 6, 3, 1>(&μ, 3)))
    }
    /// `(rot(G_k) ang(μ_k) + pos(G_k) × (rot(G_k) lin(μ_k)))·Z[1:3]`: Noether: the action is invariant under rotations about the axis in space.
    pub fn spatial_momentum_angular_Z(&self, state: &KirchhoffBodyState<T>) -> T {
        let KirchhoffBodyParameters { Z, .. } = self.parameters;
        let G = state.G.matrix();
        let μ = state.body_momentum().0;
        let t1 = motion_rotation(&G);
        (t1 * rows_from::<T, 6, 3, 1>(&μ, 0)
            + motion_translation(&G).cross(&(t1 * rows_from::<T, 6, 3, 1>(&μ, 3))))
            .dot(&rows_from::<T, 4, 3, 1>(&Z, 0))
    }
    /// The discrete energy of the edge between two consecutive states, `-tr(J rot(V_k))/h² + 2 (½ (pos(V_k) + rot(V_k)ᵀ pos(V_k)))·(½ M (pos(V_k) + rot(V_k)ᵀ pos(V_k)))/(2 h)² + (vee(rot(V_k))·(½ D (pos(V_k) + rot(V_k)ᵀ pos(V_k))))/h² + ½ b·P_k + ½ b·P_{k+1} + tr(J)/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &KirchhoffBodyState<T>,
        after: &KirchhoffBodyState<T>,
    ) -> T {
        let KirchhoffBodyParameters { J, M, D, b, .. } = self.parameters;
        let P = self.P(before);
        let P_next = self.P(after);
        let V_matrix = before
            .G
            .velocity_between(&before.place_rest, &after.G, &after.place_rest)
            .matrix();
        let t1 = motion_translation(&V_matrix);
        let t2 = motion_rotation(&V_matrix);
        let t3 = t1 + t2.tr_mul(&t1);
        T::from_f64(2.0) * (t3 * T::from_f64(0.5)).dot(&(M * t3 * T::from_f64(0.5)))
            / (T::from_f64(2.0) * h * (T::from_f64(2.0) * h))
            + vee(&t2).dot(&(D * t3 * T::from_f64(0.5))) / (h * h)
            + T::from_f64(0.5) * b.dot(&P) + T::from_f64(0.5) * b.dot(&P_next)
            - (J * less_identity(&motion_rotation(&V_matrix))).trace() / (h * h)
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(
        &self,
        state: &KirchhoffBodyState<T>,
        h: T,
    ) -> Option<KirchhoffBodyState<T>> {
        let mut moving = *state;
        self.step(
                &mut moving,
                &mut KirchhoffBodyWorkspace {
                    h,
                    search: newton::Search::to_try(),
                },
            )
            .ok()?;
        Some(moving)
    }
}
impl KirchhoffBody<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &KirchhoffBodyState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let KirchhoffBodyParameters { b, Z, .. } = self.parameters;
        let P = self.P(state);
        let G = state.G.matrix();
        let energies = self.energies(state);
        let s1 = (h * h).sqrt();
        let s2 = rows_from::<T, 4, 3, 1>(&b, 0);
        let s3 = rows_from::<T, 4, 3, 1>(&P, 0);
        let s4 = b[3];
        let impulse1 = s1 * s2.dot(&s2).sqrt() * s3.dot(&s3).sqrt();
        let impulse2 = s1 * (s4 * s4).sqrt() * P.dot(&P).sqrt();
        let state = &KirchhoffBodyState {
            momentum: CarriedImpulse(
                not_less(not_less(state.momentum.0, (0, 3), impulse1), (3, 3), impulse2),
            ),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let μ = state.body_momentum().0;
        let t1 = rows_from::<T, 4, 3, 1>(&P, 0);
        let t2 = t1.dot(&t1).sqrt();
        let t3 = rows_from::<T, 6, 3, 1>(&μ, 3);
        let t4 = t3.dot(&t3).sqrt();
        let t5 = t3.cross(&t1);
        let t6 = rows_from::<T, 4, 3, 1>(&Z, 0);
        let t7 = t6.dot(&t6).sqrt();
        let t8 = rows_from::<T, 6, 3, 1>(&μ, 0);
        let t9 = motion_translation(&G);
        let out = put(
            out,
            [energy, t2 * t2, T::from_f64(2.0) * t4 * t2 * t5.dot(&t5).sqrt()],
        );
        let out = put(out, [t4 * t7; 3 * 1]);
        put(out, [(t8.dot(&t8).sqrt() + t9.dot(&t9).sqrt() * t4) * t7]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "KirchhoffBody",
        kebab: "kirchhoff-body",
        doc: "Rigid body in an ideal fluid, with added mass, rotation-translation coupling and net weight.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J rot(V_k))/h + ((½ (pos(V_k) + rot(V_k)ᵀ pos(V_k)))·(½ M (pos(V_k) + rot(V_k)ᵀ pos(V_k))))/(2 h) + (vee(rot(V_k))·(½ D (pos(V_k) + rot(V_k)ᵀ pos(V_k))))/h - ½ h b·P_k - ½ h b·P_{k+1}\nmomentum of G        ((pos(V_k) × (M rot(V_k)ᵀ pos(V_k)))/(4 h) + (pos(V_k) × (M pos(V_k)))/(4 h) + (pos(V_k) × (Dᵀ vee(rot(V_k))))/(2 h) - 2 vee(J rot(V_k)ᵀ)/h + vee(rot(V_k) hat(D rot(V_k)ᵀ pos(V_k)))/(2 h) + vee(rot(V_k) hat(D pos(V_k)))/(2 h), M rot(V_k)ᵀ pos(V_k)/(4 h) + M pos(V_k)/(4 h) + Dᵀ vee(rot(V_k))/(2 h) + rot(V_k) M rot(V_k)ᵀ pos(V_k)/(4 h) + rot(V_k) M pos(V_k)/(4 h) + rot(V_k) Dᵀ vee(rot(V_k))/(2 h))\nRiccati form         none: the group is not SO(n)\ninvariants           energy, P_part_squared, momentum_linear_across_P_part_squared, spatial_momentum_linear_across_Z, spatial_momentum_angular_Z\ntime reversal        symmetric: second order\ncertificate          12 identities proved by normal form, 5 (of three dimensions) by exact evaluation at random points modulo 2^61 - 1",
        solver: "Newton's method on the derived residual, because the group is not SO(n)",
        parameters: &[
            Kind::SecondMoments
                .field(
                    "J",
                    [3, 3],
                    "Poinsot matrix of the rotational inertia plus the added inertia of the fluid, body frame",
                ),
            Kind::Symmetric.field("M", [3, 3], "mass plus added mass, body frame"),
            Kind::Matrix
                .field(
                    "D",
                    [3, 3],
                    "coupling of angular and linear velocity, body frame",
                ),
            Kind::Vector
                .field(
                    "b",
                    [4, 1],
                    "(moment of weight minus buoyancy, net weight), body frame",
                ),
            Kind::Vector
                .field(
                    "Z",
                    [4, 1],
                    "(vertical (up), 0), the plane of height 0, space frame",
                ),
        ],
        initial: &[
            Kind::RigidMotion.field("G", [4, 4], "position and attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [6, 1], "momentum, body frame"),
        ],
        observables: &[
            Kind::RigidMotion.field("G", [4, 4], "position and attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [6, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [6, 1], "momentum, space frame"),
            Kind::Vector.field("P", [4, 1], "(vertical, height), body frame"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ μ_k·ζ + b·P_k, where μ_k = (-J ang(ζ) + D lin(ζ) + tr(J) ang(ζ), M lin(ζ) + Dᵀ ang(ζ))",
                1usize,
            ),
            Invariant::exact("P_part_squared", "P_k[1:3]·P_k[1:3]", 1usize),
            Invariant::exact(
                "momentum_linear_across_P_part_squared",
                "(lin(μ_k) × P_k[1:3])·(lin(μ_k) × P_k[1:3])",
                1usize,
            ),
            Invariant::exact(
                "spatial_momentum_linear_across_Z",
                "Z[1:3] × (rot(G_k) lin(μ_k))",
                3 * 1,
            ),
            Invariant::exact(
                "spatial_momentum_angular_Z",
                "(rot(G_k) ang(μ_k) + pos(G_k) × (rot(G_k) lin(μ_k)))·Z[1:3]",
                1usize,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-tr(J rot(V_k))/h² + 2 (½ (pos(V_k) + rot(V_k)ᵀ pos(V_k)))·(½ M (pos(V_k) + rot(V_k)ᵀ pos(V_k)))/(2 h)² + (vee(rot(V_k))·(½ D (pos(V_k) + rot(V_k)ᵀ pos(V_k))))/h² + ½ b·P_k + ½ b·P_{k+1} + tr(J)/h²",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
