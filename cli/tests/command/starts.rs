//! Computations before the first step: values are checked first, the search for the stability limit is bounded
//! and can be skipped, and the first step satisfies the discrete equations. Its numbers were computed with
//! forty digits by Newton's method on equations typed by hand.

use crate::common::{Done, Folder, Samples, on, rotor};
use crate::rotor::gallery;
use crate::text_runs::run;
use clebsch::card::{OpenError, Settings, Trajectory};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The number of probe trajectories of the rotor, one test at a time.
static INQUIRIES: AtomicUsize = AtomicUsize::new(0);
static ALONE: Mutex<()> = Mutex::new(());

/// How many runs have a folder.
static RUNS: AtomicUsize = AtomicUsize::new(0);

/// The rotor, with a count of its probe trajectories.
fn counted(
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
) -> Result<Box<dyn Trajectory>, OpenError> {
    if settings.inquiry {
        INQUIRIES.fetch_add(1, Ordering::SeqCst);
    }
    (crate::rotor::CARD.open)(parameters, initial, settings)
}

/// A run of the rotor, and the number of probe trajectories.
fn inquired(words: &str) -> (Done, usize) {
    let _alone = ALONE.lock();
    INQUIRIES.store(0, Ordering::SeqCst);
    let mut gallery = gallery();
    gallery.entries[0].card.open = &counted;
    let done = on(&gallery, words);
    (done, INQUIRIES.load(Ordering::SeqCst))
}

#[test]
fn the_search_for_the_stability_limit_ends_when_its_time_is_over() {
    let run = |seconds: &str| {
        let words = "run harmonic-rotor --steps 1 --stability-limit";
        inquired(&format!("{words} {seconds}"))
    };
    let (cut, inquiries) = run("1e-9");
    cut.ended(0);
    let told = "stability limit of the step size: not found within 1e-9 s; --stability-limit SECONDS searches longer";
    cut.prints(told);
    let (found, all) = run("600");
    found.ended(0).never_prints("not found within");
    assert!(inquiries < all, "{inquiries} {all}");
    rotor("run --help").prints("0 disables the search");
    // The trajectory is the one of a run without a search.
    let (unsearched, inquiries) = run("0");
    assert_eq!(inquiries, 0);
    unsearched.never_prints("stability limit");
    assert_eq!(cut.out.replace(&format!("{told}\n"), ""), unsearched.out);
    for wrong in ["-1", "nan", "soon"] {
        rotor(&format!("run harmonic-rotor --stability-limit {wrong}")).exits(2);
    }
}

#[test]
fn values_are_judged_before_anything_is_searched_for() {
    let folder = Folder::new("judged-first");
    let case = rotor("case harmonic-rotor").out;
    let wrong: Vec<&str> = case
        .lines()
        .map(|line| match line.starts_with("Lambda = ") {
            true => "Lambda = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]",
            false => line,
        })
        .collect();
    let wrong = folder.write("wrong.toml", wrong.join("\n"));
    let (done, inquiries) = inquired(&format!("run harmonic-rotor --case {wrong}"));
    assert_eq!((done.code, inquiries), (2, 0), "{}", done.err);
}

/// The results of a run with this number of steps.
fn ran(model: &str, case: &str, steps: u32) -> Samples {
    let number = RUNS.fetch_add(1, Ordering::SeqCst);
    let folder = Folder::new(&format!("starts-{number}"));
    run(&folder, model, case, &format!("--steps {steps} --out @out")).ended(0);
    folder.samples("out/trajectory.csv")
}

/// The first step of a model has these numbers, to rounding.
fn starts(model: &str, case: &str, wanted: &[(&str, f64)]) {
    let found = ran(model, case, 1);
    for (name, wanted) in wanted {
        let x = found.end(name);
        let is_near = (x - wanted).abs() < 4e-14 * (1.0 + wanted.abs());
        assert!(is_near, "{name}: {x} {wanted}");
    }
}

/// Two point masses on two rigid links: no force resists a disturbance at rest, so the search tries ever longer
/// steps.
#[test]
fn two_points_on_rigid_links_start() {
    let model = r#"/// two point masses on two rigid links
model TwoP {
    param m, l, g: Real;
    field x, y: Vec<2>;
    hold p: dot(x,x) = l^2;
    hold q: dot(y-x,y-x) = l^2;
    let v = next(x) - x;
    let vy = next(y) - y;
    lagrangian = (m*dot(v,v) + m*dot(vy,vy))/(2*h)  - h*g*m*(x[2]+y[2]);
}"#;
    let case = r#"model = "two-p"
name = "p"
doc = "two"
h = 0.002
steps = 1
[parameters]
m = 1.0
l = 1.0
g = 9.81
[initial]
x = [1,0]
y = [2,0]
momentum_x = [0,0.5]
momentum_y = [0,1.5]"#;
    starts(
        model,
        case,
        &[
            ("x_1", 0.999_999_519_427_412_3),
            ("x_2", 0.000_980_38),
            ("y_1", 1.999_997_519_425_412_4),
            ("y_2", 0.002_980_38),
            ("momentum_x_1", -0.000_470_956_179_217_754_1),
            ("momentum_x_2", 0.480_381_028_671_662_4),
            ("momentum_y_1", -0.002_470_953_199_199_002_5),
            ("momentum_y_2", 1.480_377_538_663_266_7),
        ],
    );
}

/// Four bars: nine coordinates, eight constraints.
#[test]
fn four_bars_closed_to_a_loop_start() {
    let model = r#"/// four bars of rigid bodies in the plane, closed to a loop about two fixed pivots
model FourBar {
    param m1, m2, m3, K1, K2, K3, l1, l2, l3, g: Real;
    param P: Vec<2>;
    field x1, x2, x3: Vec<2>;
    field a1, a2, a3: Real;
    let u1 = cos(a1)*E1 + sin(a1)*E2;
    let u2 = cos(a2)*E1 + sin(a2)*E2;
    let u3 = cos(a3)*E1 + sin(a3)*E2;
    hold A: x1 - (l1/2)*u1 = 0;
    hold B: x1 + (l1/2)*u1 = x2 - (l2/2)*u2;
    hold C: x2 + (l2/2)*u2 = x3 + (l3/2)*u3;
    hold D: x3 - (l3/2)*u3 = P;
    let v1 = next(x1) - x1;
    let v2 = next(x2) - x2;
    let v3 = next(x3) - x3;
    lagrangian = (m1*dot(v1,v1) + m2*dot(v2,v2) + m3*dot(v3,v3) + K1*(next(a1)-a1)^2 + K2*(next(a2)-a2)^2 + K3*(next(a3)-a3)^2)/(2*h)
       - h*g*(m1*x1[2] + m2*x2[2] + m3*x3[2]);
}"#;
    let case = r#"model = "four-bar"
name = "p"
doc = "crank and rocker"
h = 0.002
steps = 1
[parameters]
m1 = 0.5
m2 = 1.8
m3 = 1.2
K1 = 0.010416666666666666
K2 = 0.48600000000000004
K3 = 0.144
l1 = 0.5
l2 = 1.8
l3 = 1.2
g = 0.0
P = [2.0, 0.0]
[initial]
x1 = [0.13507557646703494, 0.21036774620197413]
x2 = [1.0825408895477422, 0.8080634101232474]
x3 = [1.9474653130807071, 0.5976956639212734]
a1 = 1.0
a2 = 0.4448963839311257
a3 = 1.6584664011535646
momentum_x1 = [-0.31555161930296116, 0.2026133647005524]
momentum_x2 = [-1.8925044118607453, 0.6629136253884895]
momentum_x3 = [-0.5043457215800566, -0.04432965835566609]
momentum_a1 = 0.03125
momentum_a2 = -0.2645204542080193
momentum_a3 = 0.10125803187619994"#;
    starts(
        model,
        case,
        &[
            ("x1_1", 0.133_813_365_088_595_86),
            ("x2_2", 0.808_793_817_264_731_9),
            ("x3_1", 1.946_622_009_232_512_6),
            ("a1", 1.005_988_545_546_645_7),
            ("a2", 0.443_813_622_258_679_9),
            ("a3", 1.659_877_414_276_329),
            ("momentum_x2_1", -1.897_373_625_753_989),
            ("momentum_a2", -0.261_704_590_188_325_1),
        ],
    );
}

/// Two bodies with a spherical joint fall freely from rest: by half the square of the step.
#[test]
fn two_bodies_on_a_spherical_joint_start() {
    let model = r#"/// two bodies on a spherical joint, in space
model Joint {
    param J, K: Sym<3>;
    param m, n: Real;
    param a, b, g: Vec<3>;
    field x, y: Vec<3>;
    group A: SO<3> velocity V;
    group B: SO<3> velocity W;
    constraint next(A) = A*V;
    constraint next(B) = B*W;
    hold p: x + A*a = y + B*b;
    lagrangian = -tr(J*V)/h - tr(K*W)/h + m*dot(next(x)-x,next(x)-x)/(2*h) + n*dot(next(y)-y,next(y)-y)/(2*h) + h*dot(g, m*x + n*y);
}"#;
    let case = r#"model = "joint"
name = "u"
doc = "u"
h = 0.01
steps = 1
[parameters]
J = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]
K = [[2.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 6.0]]
m = 1.0
n = 2.0
a = [0.3, 0.2, 0.1]
b = [-0.3, 0.1, 0.1]
g = [0.0, 0.0, -9.81]
[initial]
x = [0.0, 0.0, 0.0]
y = [0.6, 0.1, 0.0]
A = [1.0, 0.0, 0.0, 0.0]
B = [1.0, 0.0, 0.0, 0.0]
momentum_x = [0.0, 0.0, 0.0]
momentum_y = [0.0, 0.0, 0.0]
body_momentum_A = [0.0, 0.0, 0.0]
body_momentum_B = [0.0, 0.0, 0.0]"#;
    starts(
        model,
        case,
        &[
            ("x_3", -0.000_490_5),
            ("y_3", -0.000_490_5),
            ("A_11", 1.0),
            ("B_33", 1.0),
            ("momentum_x_3", -0.0981),
            ("momentum_y_3", -0.1962),
        ],
    );
}

/// No momentum makes a particle faster than light, so a step with a large momentum does not describe small motions.
#[test]
fn a_relativistic_particle_starts() {
    let model = r#"model Rel1 {
    param m, q: Real; param B, E: Vec<3>;
    field x: Vec<3>;
    let v = (next(x) - x)/h;
    lagrangian = -h*m*sqrt(1 - dot(v, v)) + (q/2)*dot(cross(B, x), next(x) - x) + h*q*dot(E, x);
}"#;
    let case = r#"model = "rel1"
name = "c"
doc = "c"
h = 0.003
steps = 3
[parameters]
m = 1.0
q = 1.0
B = [0.0,0.0,1.0]
E = [0.1,0.0,0.0]
[initial]
x = [0,0,0]
momentum = [0.5,0.2,0.1]"#;
    starts(
        model,
        case,
        &[
            ("x_1", 0.001_316_595_981_949_072_2),
            ("x_2", 0.000_524_472_554_573_072_1),
            ("x_3", 0.000_263_102_275_784_384_5),
            ("momentum_1", 0.500_562_236_277_286_5),
            ("momentum_2", 0.199_341_702_009_025_46),
            ("momentum_3", 0.1),
        ],
    );
}

/// Two rotations of the plane whose kinetic energy is quartic in the difference of their velocities.
#[test]
fn rotations_coupled_by_a_quartic_of_velocities_start() {
    let model = r#"model A28 {
    param J, M: Sym<2>; param k, b: Real;
    group A: SO<2> velocity U; group B: SO<2> velocity V;
    constraint next(A) = A*U; constraint next(B) = B*V;
    lagrangian = -tr(J*U)/h - tr(M*V)/h + (b/h^3)*(2 - tr(U^T*V))^2 + h*k*tr(A^T*B);
}"#;
    let case = r#"model = "a28"
name = "c"
doc = "c"
h = 0.05
steps = 12

[parameters]
J = [[0.8650820169138294, -0.05569155151010495], [-0.05569155151010495, 0.8700758840692316]]
M = [[1.1855565775795016, -0.10008843131629092], [-0.10008843131629092, 1.106099844314583]]
k = 0.46486585824954607
b = 0.6942143517142021

[initial]
A = [[0.9750944916725922, 0.22178983815713696], [-0.221789838157137, 0.9750944916725922]]
B = [[0.9943730965364196, -0.10593462552240612], [0.10593462552240611, 0.9943730965364196]]
body_momentum_A = [[0.0, -0.9023782046590898], [0.9023782046590898, 0.0]]
body_momentum_B = [[0.0, -0.9186103130116213], [0.9186103130116213, 0.0]]"#;
    starts(
        model,
        case,
        &[
            ("A_11", 0.980_546_148_371_574),
            ("A_21", -0.196_288_692_780_993_8),
            ("B_11", 0.992_057_057_925_362_5),
            ("B_21", 0.125_788_687_172_074_4),
            ("body_momentum_A_21", 0.917_298_290_861_887_5),
            ("body_momentum_B_21", 0.903_690_226_808_823_6),
        ],
    );
}

/// A potential at the midpoint of the step adds nothing to the momenta of neighbours in the limit of small steps.
/// From 9 segments on, where loops over sites run, the energy used to be NaN. The action is quadratic, so that the
/// energy is conserved exactly.
#[test]
fn a_potential_in_the_middle_of_the_step_runs_for_every_number_of_sites() {
    let model = r#"/// A line of masses on springs, the potential in the middle of the step: runs with N = 8, fails with N >= 9.
model Mid {
    label i in 0..N;
    param m: Real at nodes;
    param k: Real;
    field x: Real at nodes;
    let r = (next(x, i) + next(next(x, i)) - x - next(x))/2;
    lagrangian = m*(next(x) - x)^2/(2*h) - (h*k/2)*r^2;
}"#;
    for n in [8, 9, 40] {
        let case = format!(
            r#"model = "mid"
name = "c"
doc = "c"
h = 0.01
steps = 20
[labels]
i = {n}
[ends]
i = "free"
[parameters]
m = 1.0
k = 1.0
[initial]
x = "i"
momentum_x = 0.1"#
        );
        let found = ran(model, &case, 20);
        for (name, wanted) in [
            ("x_0", 0.039_933_181_895_467_36),
            ("momentum_x_0", 0.298_670_386_813_991_1),
            ("x_1", 1.020_066_727_258_567_6),
            ("invariant_energy", 0.505 * f64::from(n) + 0.005),
        ] {
            let x = found.end(name);
            assert!(
                (x - wanted).abs() < 1e-13 * (1.0 + f64::from(n)),
                "{n} {name}: {x} {wanted}"
            );
        }
    }
}

/// A pulley without mass moves with its rope only, so that its energy is 0/0; a small mass is enough.
#[test]
fn a_mass_of_zero_and_a_step_backwards_are_answered_with_what_to_do() {
    let folder = Folder::new("starts-massless");
    let model = "model Pulley { param m1, m2, g, l: Real; field x1, x2: Real; hold λ: x1 + 2*x2 = l;
        lagrangian = m1*(next(x1) - x1)^2/(2*h) + m2*(next(x2) - x2)^2/(2*h) + h*m1*g*x1 + h*m2*g*x2; }";
    let case = |m2: &str| {
        format!(
            "model = \"Pulley\"\nh = 0.01\nsteps = 10\n[parameters]\nm1 = 1.0\nm2 = {m2}\ng = 1.0\nl = 1.0\n\
             [initial]\nx1 = 0.6\nx2 = 0.2\n"
        )
    };
    let done = run(&folder, model, &case("0.0"), "").exits(1);
    let said = "if a mass or an inertia is zero, give it a small positive value";
    done.says(said);
    run(&folder, model, &case("1e-3"), "").succeeds();
    let done = run(&folder, model, &case("1.0"), "--h=-0.01").exits(2);
    let said = "to run backwards in time, reverse all initial momenta";
    done.says(said);
}
