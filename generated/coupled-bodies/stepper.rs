// Written by `clebsch derive --write`. Do not edit.

//! The model [`CoupledBodies`](struct@CoupledBodies) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`CoupledBodies`](struct@CoupledBodies).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodiesParameters<T = f64> {
    /// `J1`: Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames; a matrix of size 3 x 3, symmetric.
    pub J1: SMatrix<T, 3, 3>,
    /// `J2`: Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames; a matrix of size 3 x 3, symmetric.
    pub J2: SMatrix<T, 3, 3>,
    /// `d1`: vectors from the joint to the centres of mass, body frames; a vector of 3 components.
    pub d1: SVector<T, 3>,
    /// `d2`: vectors from the joint to the centres of mass, body frames; a vector of 3 components.
    pub d2: SVector<T, 3>,
    /// `eps`: reduced mass m₁ m₂/(m₁ + m₂); a number.
    pub eps: T,
}
/// Two rigid bodies connected by a spherical joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodies<T = f64> {
    parameters: CoupledBodiesParameters<T>,
}
impl<T: Real> CoupledBodies<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Two rigid bodies connected by a spherical joint.\npub model CoupledBodies {\n    /// Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames\n    param J1: Sym<3>;\n    /// Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames\n    param J2: Sym<3>;\n    /// vectors from the joint to the centres of mass, body frames\n    param d1: Vec<3>;\n    /// vectors from the joint to the centres of mass, body frames\n    param d2: Vec<3>;\n    /// reduced mass m₁ m₂/(m₁ + m₂)\n    param eps: Real as \"\\varepsilon\";\n    /// attitude of body 1, body to space\n    group Λ1: SO<3> velocity Ω1;\n    /// attitude of body 2, body to space\n    group Λ2: SO<3> velocity Ω2;\n    /// attitude of body 2 relative to body 1\n    advected R: SO<3> = Λ1^T*Λ2;\n    constraint next(Λ1) = Λ1*Ω1;\n    constraint next(Λ2) = Λ2*Ω2;\n    constraint next(R) = Ω1^T*R*Ω2;\n    lagrangian = (-tr(J1*Ω1) - tr(J2*Ω2) - eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 17740339557977192018u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: CoupledBodiesParameters<T>) -> Result<Self, ParameterError> {
        validate::finite_entries("J1", &parameters.J1)?;
        validate::symmetric("J1", &parameters.J1)?;
        validate::finite_entries("J2", &parameters.J2)?;
        validate::symmetric("J2", &parameters.J2)?;
        validate::finite("d1", parameters.d1.as_slice())?;
        validate::finite("d2", parameters.d2.as_slice())?;
        validate::finite("eps", &[parameters.eps])?;
        Ok(Self { parameters })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodiesInitial<T = f64> {
    /// `Λ1` at node 0: body -> space.
    pub Λ1: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum_Λ1: BodyMomentum<T>,
    /// `Λ2` at node 0: body -> space.
    pub Λ2: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum_Λ2: BodyMomentum<T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodiesState<T = f64> {
    Λ1: Rotation<T>,
    momentum_Λ1: SpatialMomentum<T>,
    Λ2: Rotation<T>,
    momentum_Λ2: SpatialMomentum<T>,
    node: u64,
}
impl<T: Real> CoupledBodiesState<T> {
    /// `Λ1` at this node: body -> space.
    pub fn Λ1(&self) -> Rotation<T> {
        self.Λ1
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum_Λ1(&self) -> SpatialMomentum<T> {
        self.momentum_Λ1
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum_Λ1(&self) -> BodyMomentum<T> {
        self.momentum_Λ1.to_body(&self.Λ1)
    }
    /// `Λ2` at this node: body -> space.
    pub fn Λ2(&self) -> Rotation<T> {
        self.Λ2
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum_Λ2(&self) -> SpatialMomentum<T> {
        self.momentum_Λ2
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum_Λ2(&self) -> BodyMomentum<T> {
        self.momentum_Λ2.to_body(&self.Λ2)
    }
}
/// The step size, and the last velocities as initial guesses for the next step.
#[derive(Clone, Copy, Debug)]
pub struct CoupledBodiesWorkspace<T = f64> {
    h: T,
    search: newton::Search<T, [Rotation<T>; 2], 6>,
}
impl<T: Real> CoupledBodiesWorkspace<T> {
    /// The tangents and corrections of the last step, and the residual before its last correction.
    pub fn solved(&self) -> newton::Summary {
        self.search.last()
    }
}
impl<T: Real> CoupledBodies<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        _: &CoupledBodiesState<T>,
        h: T,
        _: (),
    ) -> Result<CoupledBodiesWorkspace<T>, StartError> {
        Ok(CoupledBodiesWorkspace {
            h,
            search: newton::Search::from_rest(),
        })
    }
    /// One step, in place. Method: Newton's method on the derived residuals, because the equations of several velocities are coupled.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut CoupledBodiesState<T>,
        work: &mut CoupledBodiesWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = self.parameters;
        let Λ1 = state.Λ1.matrix();
        let Λ2 = state.Λ2.matrix();
        let R = Λ1.tr_mul(&Λ2);
        let found: newton::Solved<[Rotation<T>; 2]> = {
            let momenta: [SVector<T, 3>; 2] = [
                Λ1.tr_mul(&state.momentum_Λ1.0),
                Λ2.tr_mul(&state.momentum_Λ2.0),
            ];
            let s1 = h.powi(-1);
            let s2 = R * d2;
            let s3 = d1.cross(&s2);
            let k3 = eps * s1;
            let k5 = crossed(&d1, &R);
            let k6 = crossing(&R.transpose(), &s2);
            let k7 = (s3 + s2.cross(&d1)) * (eps * s1);
            let mut iteration = work.search.begin(state.node);
            loop {
                let trial = iteration.trial();
                if iteration.wants_scale() {
                    iteration
                        .set_scale(move |lane| {
                            self.rounding(h, &(R, []), &momenta, &trial, lane)
                        });
                }
                let Ω1 = trial[0].matrix();
                let Ω2 = trial[1].matrix();
                if iteration
                    .assess({
                        joined::<
                            T,
                            2,
                            6,
                        >(
                            &[
                                (axial_of_difference(&(Ω1 * J1)) * s1
                                    + ((R * (Ω2 * d2)).cross(&d1) + s3) * k3) - momenta[0],
                                (axial_of_difference(&(Ω2 * J2)) * s1
                                    + R.tr_mul(&(Ω1 * d1 - d1).cross(&s2)) * k3) - momenta[1],
                            ],
                        )
                    })
                {
                    iteration
                        .set_tangent_times(
                            &{
                                let t1 = Ω1 * J1;
                                let t2 = Ω2 * J2;
                                assembled::<
                                    T,
                                    2,
                                    6,
                                >(
                                    &[
                                        [trace_complement(&t1), crossing(&k5, &(Ω2 * d2)) * eps],
                                        [crossing(&k6, &(Ω1 * d1)) * eps, trace_complement(&t2)],
                                    ],
                                )
                            },
                            h,
                        );
                }
                match iteration.correct_from_left() {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(
                        solved,
                    ) if iteration
                        .is_principal(
                            &solved.element,
                            &{
                                joined::<
                                    T,
                                    2,
                                    6,
                                >(
                                    &[
                                        (k7) - momenta[0],
                                        (SMatrix::<T, 3, 1>::zeros()) - momenta[1],
                                    ],
                                )
                            },
                            |trial| {
                                Self::residual_at(
                                    &self.parameters,
                                    h,
                                    &(R, []),
                                    &momenta,
                                    trial,
                                )
                            },
                        ) => break solved,
                    ended => {
                        if let Some(solved) = self
                            .settled(h, *state, (R, []), momenta, &mut iteration, ended)?
                        {
                            break solved;
                        }
                    }
                }
            }
        };
        let solved = found.element;
        let Ω1_matrix = solved[0].matrix();
        let Ω2_matrix = solved[1].matrix();
        let Λ1_moved = state.Λ1 * solved[0];
        let Λ2_moved = state.Λ2 * solved[1];
        let t1 = h.powi(-1);
        let t2 = Ω2_matrix - SMatrix::<T, 3, 3>::identity();
        let t3 = Ω1_matrix - SMatrix::<T, 3, 3>::identity();
        let momentum_Λ1_next = state.momentum_Λ1.0
            + Λ1 * ((R * (t2 * d2)).cross(&(t3 * d1)) * (eps * t1));
        let momentum_Λ2_next = state.momentum_Λ2.0
            + Λ2 * (-((t2 * d2).cross(&R.tr_mul(&(t3 * d1))) * (eps * t1)));
        if !(all_finite(&momentum_Λ1_next) && all_finite(&momentum_Λ2_next)) {
            return Err(StepCause::not_finite("momentum").at_node(state.node));
        }
        state.Λ1 = Λ1_moved;
        state.Λ2 = Λ2_moved;
        state.momentum_Λ1 = SpatialMomentum(momentum_Λ1_next);
        state.momentum_Λ2 = SpatialMomentum(momentum_Λ2_next);
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
        state: CoupledBodiesState<T>,
        given: (SMatrix<T, 3, 3>, [T; 0]),
        momenta: [SVector<T, 3>; 2],
        iteration: &mut newton::Newton<'_, T, [Rotation<T>; 2], 6>,
        ended: newton::Progress<[Rotation<T>; 2]>,
    ) -> Result<Option<newton::Solved<[Rotation<T>; 2]>>, StepError> {
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
        state: CoupledBodiesState<T>,
        h: T,
        e: newton::NewtonError,
    ) -> StepError {
        const CONFIGURATIONS: &[&str] = &["Λ1", "Λ2"];
        let e = e
            .explained(
                h,
                &CONFIGURATIONS,
                |h, search| {
                    self.step(
                        &mut { state },
                        &mut CoupledBodiesWorkspace {
                            h,
                            search,
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
    fn residual_at(
        parameters: &CoupledBodiesParameters<T>,
        h: T,
        given: &(SMatrix<T, 3, 3>, [T; 0]),
        momenta: &[SVector<T, 3>; 2],
        trial: &[Rotation<T>; 2],
    ) -> SVector<T, 6> {
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = *parameters;
        let R = given.0;
        let Ω1 = trial[0].matrix();
        let Ω2 = trial[1].matrix();
        let t1 = h.powi(-1);
        let t2 = R * d2;
        joined::<
            T,
            2,
            6,
        >(
            &[
                (axial_of_difference(&(Ω1 * J1)) * t1
                    + (d1.cross(&t2) + (R * (Ω2 * d2)).cross(&d1)) * (eps * t1))
                    - momenta[0],
                (axial_of_difference(&(Ω2 * J2)) * t1
                    + R.tr_mul(&(Ω1 * d1 - d1).cross(&t2)) * (eps * t1)) - momenta[1],
            ],
        )
    }
    /// The tangent of the residual.
    #[cold]
    #[inline(never)]
    #[allow(unused_variables)]
    fn tangent_at(
        parameters: &CoupledBodiesParameters<T>,
        h: T,
        given: &(SMatrix<T, 3, 3>, [T; 0]),
        trial: &[Rotation<T>; 2],
    ) -> SMatrix<T, 6, 6> {
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = *parameters;
        let R = given.0;
        let Ω1 = trial[0].matrix();
        let Ω2 = trial[1].matrix();
        let t1 = h.powi(-1);
        let t2 = Ω1 * J1;
        let t3 = Ω2 * J2;
        assembled::<
            T,
            2,
            6,
        >(
            &[
                [
                    trace_complement(&t2) * Ω1 * t1,
                    crossed(&d1, &(R * crossing(&Ω2, &d2))) * (eps * t1),
                ],
                [
                    R.tr_mul(&crossed(&(R * d2), &crossing(&Ω1, &d1))) * (eps * t1),
                    trace_complement(&t3) * Ω2 * t1,
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
        given: &(SMatrix<T, 3, 3>, [T; 0]),
        momenta: &[SVector<T, 3>; 2],
        trial: &[Rotation<T>; 2],
        lane: usize,
    ) -> SVector<f64, 6> {
        let change = &mut |x: T| newton::Rounded::exactly(x.lane(lane));
        let parameters = self.parameters.over(change);
        let (step, given, momenta) = (
            h.over(change),
            given.over(change),
            momenta.map(|part| part.over(change)),
        );
        let change = &mut |x: T| newton::Rounded::once(x.lane(lane));
        let trial = [trial[0].over(change), trial[1].over(change)];
        CoupledBodies::<
            newton::Rounded,
        >::residual_at(&parameters, step, &given, &momenta, &trial)
            .map(|x| x.error())
    }
    /// Finds the principal root, or proves that the given solution is the principal root.
    #[cold]
    #[inline(never)]
    fn principal(
        &self,
        h: T,
        given: &(SMatrix<T, 3, 3>, [T; 0]),
        momenta: &[SVector<T, 3>; 2],
        mut verdict: newton::Verdict<[Rotation<T>; 2], 6>,
        solution: Option<&[Rotation<T>; 2]>,
    ) -> Result<Option<newton::Anchor<[Rotation<T>; 2], 6>>, newton::Fold> {
        for lane in 0..T::LANES {
            let change = &mut |x: T| x.lane(lane);
            let (parameters, step) = (self.parameters.over(change), h.over(change));
            let (given, momenta) = (
                given.over(change),
                momenta.map(|part| part.over(change)),
            );
            let found = match solution {
                Some(found) => Some([found[0].over(change), found[1].over(change)]),
                None => None,
            };
            let equations = newton::Equations {
                residual: &|trial: &[Rotation<f64>; 2]| CoupledBodies::<
                    f64,
                >::residual_at(&parameters, step, &given, &momenta, trial),
                tangent: &|trial: &[Rotation<f64>; 2]| CoupledBodies::<
                    f64,
                >::tangent_at(&parameters, step, &given, trial),
            };
            if let Some(root) = verdict.trace(lane, &equations, found.as_ref())? {
                let all = verdict.root_mut();
                all[0] = all[0].over(&mut newton::Numbers::of(&root[0]).put(lane));
                all[1] = all[1].over(&mut newton::Numbers::of(&root[1]).put(lane));
            }
        }
        Ok(verdict.elsewhere())
    }
    /// `R` at the node of this state.
    #[inline]
    pub fn R(&self, state: &CoupledBodiesState<T>) -> SMatrix<T, 3, 3> {
        let Λ1 = state.Λ1.matrix();
        let Λ2 = state.Λ2.matrix();
        Λ1.tr_mul(&Λ2)
    }
}
::clebsch::stepper! {
    [] CoupledBodies,
    CoupledBodiesParameters { J1, J2, d1, d2, eps },
    CoupledBodiesInitial { Λ1, body_momentum_Λ1, Λ2, body_momentum_Λ2 },
    CoupledBodiesState { Λ1, momentum_Λ1, Λ2, momentum_Λ2 } at node,
    CoupledBodiesWorkspace { h, search },
    tried {} nothing symmetric judged { 6 }
    start { Λ1, momentum_Λ1 = body_momentum_Λ1.to_space; Λ2, momentum_Λ2 =
        body_momentum_Λ2.to_space }
    observables { state.Λ1, state.body_momentum_Λ1, state.spatial_momentum_Λ1, state.Λ2,
        state.body_momentum_Λ2, state.spatial_momentum_Λ2, R }
    invariants { energy, total_momentum, total_momentum_squared }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodiesConfiguration<T = f64> {
    /// `Λ1` at the node: body -> space.
    pub Λ1: Rotation<T>,
    /// `Λ2` at the node: body -> space.
    pub Λ2: Rotation<T>,
}
impl<T: Real> CoupledBodies<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &CoupledBodiesConfiguration<T>,
        here: &CoupledBodiesConfiguration<T>,
        after: &CoupledBodiesConfiguration<T>,
    ) -> SVector<T, 6> {
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = self.parameters;
        let Λ1_before = before.Λ1.matrix();
        let Λ2_before = before.Λ2.matrix();
        let R_before = Λ1_before.tr_mul(&Λ2_before);
        let Λ1 = here.Λ1.matrix();
        let Λ2 = here.Λ2.matrix();
        let R = Λ1.tr_mul(&Λ2);
        let Ω1_before = before.Λ1.body_velocity(&here.Λ1).matrix();
        let Ω1 = here.Λ1.body_velocity(&after.Λ1).matrix();
        let Ω2_before = before.Λ2.body_velocity(&here.Λ2).matrix();
        let Ω2 = here.Λ2.body_velocity(&after.Λ2).matrix();
        let t1 = h.powi(-1);
        let t2 = d1.cross(&(R * d2));
        {
            let parts: [SVector<T, 3>; 2] = [
                axial_of_difference(
                    &Ω1_before
                        .tr_mul(
                            &(-(J1 / h)
                                - R_before
                                    * ((Ω2_before - SMatrix::<T, 3, 3>::identity()) * d2)
                                    * d1.transpose() * eps / h),
                        ),
                ) + axial_of_difference(&(J1 * Ω1.transpose())) * t1 - t2 * (t1 * eps)
                    + d1.cross(&(R * (Ω2 * d2))) * (t1 * eps),
                axial_of_difference(
                    &Ω2_before
                        .tr_mul(
                            &(-(J2 / h)
                                - R_before
                                    .tr_mul(
                                        &((Ω1_before - SMatrix::<T, 3, 3>::identity()) * d1),
                                    ) * d2.transpose() * eps / h),
                        ),
                ) + axial_of_difference(&(J2 * Ω2.transpose())) * t1
                    - R.tr_mul(&(Ω1 * d1.cross(&Ω1.tr_mul(&(R * d2))))) * (t1 * eps)
                    + R.tr_mul(&t2) * (t1 * eps),
            ];
            SVector::<T, 6>::from_fn(|i, _| parts[i / 3][i % 3])
        }
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &CoupledBodiesState<T>) -> SMatrix<T, 6, 6> {
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = self.parameters;
        let R = self.R(state);
        let mut inertia = SMatrix::<T, 6, 6>::zeros();
        for axis in 0..3 {
            let ξ1: SMatrix<T, 3, 3> = basis::<T>(axis);
            let ξ2: SMatrix<T, 3, 3> = SMatrix::zeros();
            let t1 = d1.dot(&(R * d2));
            let t2 = vee(&ξ2);
            let t3 = vee(&ξ1);
            let along = {
                let parts: [SVector<T, 3>; 2] = [
                    R * d2 * (eps * d1.dot(&(R * t2))) - R * t2 * (eps * t1)
                        + t3 * J1.trace() - J1 * t3,
                    R.tr_mul(&d1) * (eps * d2.dot(&R.tr_mul(&t3)))
                        - R.tr_mul(&t3) * (eps * t1) + t2 * J2.trace() - J2 * t2,
                ];
                SVector::<T, 6>::from_fn(|i, _| parts[i / 3][i % 3])
            };
            inertia.set_column(axis, &along);
        }
        for axis in 0..3 {
            let ξ1: SMatrix<T, 3, 3> = SMatrix::zeros();
            let ξ2: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = d1.dot(&(R * d2));
            let t2 = vee(&ξ2);
            let t3 = vee(&ξ1);
            let along = {
                let parts: [SVector<T, 3>; 2] = [
                    R * d2 * (eps * d1.dot(&(R * t2))) - R * t2 * (eps * t1)
                        + t3 * J1.trace() - J1 * t3,
                    R.tr_mul(&d1) * (eps * d2.dot(&R.tr_mul(&t3)))
                        - R.tr_mul(&t3) * (eps * t1) + t2 * J2.trace() - J2 * t2,
                ];
                SVector::<T, 6>::from_fn(|i, _| parts[i / 3][i % 3])
            };
            inertia.set_column(3 + axis, &along);
        }
        inertia
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &CoupledBodiesState<T>) -> (T, T) {
        let momentum = {
            let parts: [SVector<T, 3>; 2] = [
                state.body_momentum_Λ1().0,
                state.body_momentum_Λ2().0,
            ];
            SVector::<T, 6>::from_fn(|i, _| parts[i / 3][i % 3])
        };
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 6);
        (momentum.dot(&velocity) * T::from_f64(0.5), T::zero())
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &CoupledBodiesState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `Λ_{1,k} μ_{1,k} + Λ_{2,k} μ_{2,k}`: Noether: the action is invariant under rotations of space.
    pub fn total_momentum(&self, state: &CoupledBodiesState<T>) -> SVector<T, 3> {
        state.spatial_momentum_Λ1().0 + state.spatial_momentum_Λ2().0
    }
    /// `(μ_{1,k} + R_k μ_{2,k})·(μ_{1,k} + R_k μ_{2,k})`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn total_momentum_squared(&self, state: &CoupledBodiesState<T>) -> T {
        let R = self.R(state);
        let μ1 = state.body_momentum_Λ1().0;
        let μ2 = state.body_momentum_Λ2().0;
        let t1 = μ1 + R * μ2;
        t1.dot(&t1)
    }
    /// The discrete energy of the edge between two consecutive states, `-tr(J₁ Ω_{1,k})/h² - tr(J₂ Ω_{2,k})/h² - eps ((Ω_{1,k} - Id) d₁)·(R_k (Ω_{2,k} - Id) d₂)/h² + tr(J₁)/h² + tr(J₂)/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &CoupledBodiesState<T>,
        after: &CoupledBodiesState<T>,
    ) -> T {
        let CoupledBodiesParameters { J1, J2, d1, d2, eps, .. } = self.parameters;
        let R = self.R(before);
        let Ω1_matrix = before.Λ1.body_velocity(&after.Λ1).matrix();
        let Ω2_matrix = before.Λ2.body_velocity(&after.Λ2).matrix();
        let t1 = h.powi(-2);
        let t2 = less_identity(&Ω2_matrix);
        -(t1 * eps * d1.dot(&(less_identity(&Ω1_matrix.transpose()) * (R * (t2 * d2)))))
            - t1 * (J1 * less_identity(&Ω1_matrix)).trace() - t1 * (J2 * t2).trace()
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(
        &self,
        state: &CoupledBodiesState<T>,
        h: T,
    ) -> Option<CoupledBodiesState<T>> {
        let mut moving = *state;
        self.step(
                &mut moving,
                &mut CoupledBodiesWorkspace {
                    h,
                    search: newton::Search::to_try(),
                },
            )
            .ok()?;
        Some(moving)
    }
}
impl CoupledBodies<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &CoupledBodiesState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let R = self.R(state);
        let Λ1 = state.Λ1.matrix();
        let Λ2 = state.Λ2.matrix();
        let μ1 = state.body_momentum_Λ1().0;
        let μ2 = state.body_momentum_Λ2().0;
        let t1 = Λ1 * μ1;
        let t2 = Λ2 * μ2;
        let t3 = μ1 + R * μ2;
        let out = put(out, [sum_of_sizes(self.energies(state))]);
        let out = put(out, [t1.dot(&t1).sqrt() + t2.dot(&t2).sqrt(); 3usize]);
        put(
            out,
            [
                T::from_f64(2.0)
                    * (μ1.dot(&μ1).sqrt()
                        + R.tr_mul(&R).trace().sqrt() * μ2.dot(&μ2).sqrt())
                    * t3.dot(&t3).sqrt(),
            ],
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "CoupledBodies",
        kebab: "coupled-bodies",
        doc: "Two rigid bodies connected by a spherical joint.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J₁ Ω_{1,k})/h - tr(J₂ Ω_{2,k})/h - eps ((Ω_{1,k} - Id) d₁)·(R_k (Ω_{2,k} - Id) d₂)/h\nmomentum of Λ1       -(J₁/h + eps R_k (Ω_{2,k} - Id) d₂ d₁ᵀ/h) Ω_{1,k}ᵀ + Ω_{1,k} (J₁/h + eps d₁ d₂ᵀ (Ω_{2,k}ᵀ - Id) R_kᵀ/h)\nmomentum of Λ2       -(J₂/h + eps R_kᵀ (Ω_{1,k} - Id) d₁ d₂ᵀ/h) Ω_{2,k}ᵀ + Ω_{2,k} (J₂/h + eps d₂ d₁ᵀ (Ω_{1,k}ᵀ - Id) R_k/h)\nRiccati form         coupled, C = J₁; coupled, C = J₂\ninvariants           energy, total_momentum, total_momentum_squared\ntime reversal        symmetric: second order\ncertificate          32 identities proved by normal form",
        solver: "Newton's method on the derived residuals, because the equations of several velocities are coupled",
        parameters: &[
            Kind::SecondMoments
                .field(
                    "J1",
                    [3, 3],
                    "Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames",
                ),
            Kind::SecondMoments
                .field(
                    "J2",
                    [3, 3],
                    "Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames",
                ),
            Kind::Vector
                .field(
                    "d1",
                    [3, 1],
                    "vectors from the joint to the centres of mass, body frames",
                ),
            Kind::Vector
                .field(
                    "d2",
                    [3, 1],
                    "vectors from the joint to the centres of mass, body frames",
                ),
            Kind::Scalar.field("eps", [1, 1], "reduced mass m₁ m₂/(m₁ + m₂)"),
        ],
        initial: &[
            Kind::Rotation
                .spelt("Λ1", "Lambda1", [3, 3], "attitude of body 1, body to space"),
            Kind::BodyMomentum
                .spelt(
                    "body_momentum_Λ1",
                    "body_momentum_Lambda1",
                    [3, 1],
                    "momentum, body frame",
                ),
            Kind::Rotation
                .spelt("Λ2", "Lambda2", [3, 3], "attitude of body 2, body to space"),
            Kind::BodyMomentum
                .spelt(
                    "body_momentum_Λ2",
                    "body_momentum_Lambda2",
                    [3, 1],
                    "momentum, body frame",
                ),
        ],
        observables: &[
            Kind::Rotation
                .spelt("Λ1", "Lambda1", [3, 3], "attitude of body 1, body to space"),
            Kind::BodyMomentum
                .spelt(
                    "body_momentum_Λ1",
                    "body_momentum_Lambda1",
                    [3, 1],
                    "momentum, body frame",
                ),
            Kind::SpatialMomentum
                .spelt(
                    "spatial_momentum_Λ1",
                    "spatial_momentum_Lambda1",
                    [3, 1],
                    "momentum, space frame",
                ),
            Kind::Rotation
                .spelt("Λ2", "Lambda2", [3, 3], "attitude of body 2, body to space"),
            Kind::BodyMomentum
                .spelt(
                    "body_momentum_Λ2",
                    "body_momentum_Lambda2",
                    [3, 1],
                    "momentum, body frame",
                ),
            Kind::SpatialMomentum
                .spelt(
                    "spatial_momentum_Λ2",
                    "spatial_momentum_Lambda2",
                    [3, 1],
                    "momentum, space frame",
                ),
            Kind::Matrix.field("R", [3, 3], "attitude of body 2 relative to body 1"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ μ_{1,k}·ζ₁ + ½ μ_{2,k}·ζ₂, where μ_{1,k} = -J₁ ζ₁ - eps (d₁·(R_k d₂)) R_k ζ₂ + eps (d₁·(R_k ζ₂)) R_k d₂ + tr(J₁) ζ₁, μ_{2,k} = -J₂ ζ₂ - eps (d₁·(R_k d₂)) R_kᵀ ζ₁ + eps (d₂·(R_kᵀ ζ₁)) R_kᵀ d₁ + tr(J₂) ζ₂",
                1usize,
            ),
            Invariant::exact(
                "total_momentum",
                "Λ_{1,k} μ_{1,k} + Λ_{2,k} μ_{2,k}",
                3usize,
            ),
            Invariant::exact(
                "total_momentum_squared",
                "(μ_{1,k} + R_k μ_{2,k})·(μ_{1,k} + R_k μ_{2,k})",
                1usize,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-tr(J₁ Ω_{1,k})/h² - tr(J₂ Ω_{2,k})/h² - eps ((Ω_{1,k} - Id) d₁)·(R_k (Ω_{2,k} - Id) d₂)/h² + tr(J₁)/h² + tr(J₂)/h²",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
