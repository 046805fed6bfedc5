//! Initial values as velocities: their momenta come from the discrete Legendre transform, and are compared with
//! closed forms. If there are no momenta, the message says what to write.

use crate::common::Folder;
use crate::text_runs::{Ran, run};

/// Eight roundings of a sum of terms of this size.
fn near(found: f64, expected: f64, size: f64) {
    assert!(
        (found - expected).abs() <= 8.0 * f64::EPSILON * size.abs(),
        "{found} for {expected}"
    );
}

const KEPLER: &str = "model Kepler {
    param m, k: Real;
    field x: Vec<2>;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + h*k*m/sqrt(dot(x, x));
}";

/// A circle is closed up to terms of the order of the method; this fails if the initial momentum is wrong by a force
/// times h/2.
#[test]
fn a_velocity_is_that_of_the_start_to_the_order_of_the_method() {
    let off = |count: u32| {
        let case = format!(
            "model = \"kepler\"\nh = \"2*pi/{count}\"\nsteps = {count}\n[parameters]\nm = 0.3\nk = 1\n\
             [initial]\nx = [1, 0]\nvelocity_x = [0, 1]\n"
        );
        let ran = Ran::of(KEPLER, &case, &format!("kepler-{count}"));
        assert_eq!(
            [ran.at("momentum_1", 0), ran.at("momentum_2", 0)],
            [0.0, 0.3]
        );
        let said = "initial momentum from velocity_x: (0, 0.3)";
        assert!(ran.out.contains(said), "{}", ran.out);
        let h = std::f64::consts::TAU / f64::from(count);
        // The displacement of the first step is h v plus half of the acceleration times h^2.
        let first = ran.at("x_1", 1) - 1.0;
        assert!((first / (h * h) + 0.5).abs() < 1e-3, "{first}");
        let last = usize::try_from(count).expect("few");
        (ran.at("x_1", last) - 1.0).hypot(ran.at("x_2", last))
    };
    let [coarse, fine] = [off(200), off(400)];
    assert!((coarse / fine - 4.0).abs() < 0.02, "{coarse} {fine}");
}

#[test]
fn a_vector_potential_adds_to_the_momentum_of_rest_too() {
    let model = "model Charge {
        param m, B: Real;
        field x: Vec<2>;
        let d = next(x) - x;
        lagrangian = m*dot(d, d)/(2*h) + (B/2)*dot(perp(x), next(x));
    }";
    let of = |start: &str, name: &str| {
        let case = format!(
            "model = \"charge\"\nh = 0.01\nsteps = 1\n[parameters]\nm = 2\nB = 3\n[initial]\nx = [0.5, 0.25]\n{start}"
        );
        let ran = Ran::of(model, &case, name);
        [ran.at("momentum_1", 0), ran.at("momentum_2", 0)]
    };
    // m v + B/2 perp(x).
    let moving = of("velocity = [1, \"-1/4\"]", "charge-moving");
    near(moving[0], 2.0 - 1.5 * 0.25, 2.0);
    near(moving[1], -0.5 + 1.5 * 0.5, 2.0);
    let resting = of("", "charge-resting");
    near(resting[0], -1.5 * 0.25, 1.0);
    near(resting[1], 1.5 * 0.5, 1.0);
}

#[test]
fn far_from_the_origin_momenta_are_as_exact() {
    let case = "model = \"kepler\"\nh = 0.01\nsteps = 1\n[parameters]\nm = 0.7\nk = 1\n\
                [initial]\nx = [1.2345e6, 7]\nvelocity_x = [1e-3, 0.1]\n";
    let ran = Ran::of(KEPLER, case, "kepler-far");
    near(ran.at("momentum_1", 0), 0.7e-3, 0.7e-3);
    near(ran.at("momentum_2", 0), 0.07, 0.07);
}

/// A top whose inertia is (2, 2, 1), tilted by a sixth of pi.
#[test]
fn angular_velocities_are_those_of_the_body_or_of_space() {
    let folder = Folder::new("velocities-top");
    let of = |start: &str| {
        let case = format!(
            "model = \"heavy-top\"\nh = 0.01\nsteps = 2\n[parameters]\nJ = {{ I = [2.0, 2.0, 1.0] }}\ngU = [0, 0, 1]\nz = [0, 0, 1]\n\
             [initial]\nLambda = {{ axis = [1, 0, 0], angle = \"pi/6\" }}\n{start}\n"
        );
        folder.write("top.toml", &case);
        folder.clebsch("run heavy-top --case @top.toml --check all")
    };
    let done = of("angular_velocity = [0, 0.2, 5]").succeeds();
    let said = "initial body_momentum from angular_velocity: (0, 0.4, 5)";
    done.prints(said);
    // The third axis of space is (0, 1/2, sqrt(3)/2) in the body.
    let done = of("spatial_angular_velocity_Lambda = [0, 0, 2]");
    let said = "initial body_momentum from spatial_angular_velocity_Lambda: (0, 2, 1.7320508)";
    done.prints(said);
    let done = of("angular_velocity = [0, 0.2, 5]\nbody_momentum = [0, 0, 1]");
    let said =
        "top.toml:10: initial.angular_velocity: conflicts with body_momentum: give one of them";
    done.says(said);
    let done = of("omega = [0, 0.2, 5]");
    let said = "unknown key `omega` in [initial]; velocities are given by `angular_velocity` (in the axes of the body), \
        `spatial_angular_velocity` (in space axes)";
    done.says(said);
}

#[test]
fn rigid_motions_have_an_angular_velocity_and_one_of_their_position() {
    let model = "model Body {
        param J: Sym<3>;
        param m: Real;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h);
    }";
    let case = "model = \"body\"\nh = 0.01\nsteps = 1\n[parameters]\nJ = { I = [2.0, 3.0, 4.0] }\nm = 2\n\
        [initial]\nG = { rotation = { axis = [0, 0, 1], angle = \"pi/2\" }, position = [100, 2, 3] }\n\
        angular_velocity = [0.1, 0.2, 0.3]\nvelocity = [1, 0, 0]\n";
    let ran = Ran::of(model, case, "rigid-motion");
    // I w, and the linear momentum (2, 0, 0) of space in the axes of the body.
    for (i, p) in [0.2, 0.6, 1.2, 0.0, -2.0, 0.0].into_iter().enumerate() {
        let found = ran.at(&format!("body_momentum_{}", i + 1), 0);
        assert!((found - p).abs() < 1e-13, "{i}: {found} for {p}");
    }
    assert!((ran.at("G_14", 1) - 100.01).abs() < 1e-12);
}

#[test]
fn matrices_quaternions_and_rotations_of_the_plane_start_with_velocities() {
    let linear = "model Frame {
        param C: Sym<2>;
        group Q: GL<2> velocity G;
        constraint next(Q) = Q*G;
        lagrangian = tr((next(Q) - Q)*C*(next(Q) - Q)^T)/(2*h);
    }";
    let case = "model = \"frame\"\nh = 0.01\nsteps = 1\n[parameters]\nC = [[1, 0], [0, 2]]\n\
                [initial]\nQ = [[1, 0.2], [0, 1]]\nvelocity_Q = [[0.1, 0.2], [0.3, 0.4]]\n";
    let ran = Ran::of(linear, case, "linear");
    // Q^T dQ/dt C.
    for (name, p) in [("11", 0.1), ("12", 0.4), ("21", 0.32), ("22", 0.88)] {
        let found = ran.at(&format!("body_momentum_{name}"), 0);
        assert!((found - p).abs() < 1e-13, "{name}: {found}");
    }
    let quaternion = "model Spinning {
        param I: Diag<3>;
        param c: Real;
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        lagrangian = -(4*c/h)*re(W) + (2/h)*dot(im(W), (I - c*Id)*im(W));
    }";
    let case = "model = \"spinning\"\nh = 0.01\nsteps = 1\n[parameters]\nI = [2, 3, 4]\nc = 3\n\
                [initial]\nq = { axis = [0, 0, 1], angle = \"pi/2\" }\nspatial_angular_velocity_q = [0, 0.1, 0.3]\n";
    let ran = Ran::of(quaternion, case, "quaternion");
    for (i, p) in [0.2, 0.0, 1.2].into_iter().enumerate() {
        let found = ran.at(&format!("body_momentum_{}", i + 1), 0);
        assert!((found - p).abs() < 1e-13, "{i}: {found}");
    }
    let plane = "model Disc {
        param J: Sym<2>;
        group R: SO<2> velocity W;
        constraint next(R) = R*W;
        lagrangian = -tr(J*W)/h;
    }";
    let case = "model = \"disc\"\nh = 0.01\nsteps = 1\n[parameters]\nJ = [[1, 0], [0, 2]]\n\
                [initial]\nR = \"pi/6\"\nangular_velocity = 0.5\n";
    let ran = Ran::of(plane, case, "plane");
    let angle = ran.at("R_21", 1).atan2(ran.at("R_11", 1));
    assert!(
        (angle - std::f64::consts::FRAC_PI_6 - 0.005).abs() < 1e-7,
        "{angle}"
    );
}

/// A double pendulum: the bob at rest has a momentum due to the motion of the other bob.
#[test]
fn what_is_not_given_rests_and_has_the_momentum_of_coupled_velocities() {
    let model = "model DoublePendulum {
        param m1, m2, g, l: Real;
        field a, b: Real;
        let da = next(a) - a;
        let db = next(b) - b;
        let between = (a + next(a) - b - next(b))/2;
        lagrangian = ((m1 + m2)*l^2*da^2/2 + m2*l^2*db^2/2 + m2*l^2*cos(between)*da*db)/h
            + h*(m1 + m2)*g*l*cos(a) + h*m2*g*l*cos(b);
    }";
    let case = "model = \"double-pendulum\"\nh = 0.01\nsteps = 1\n[parameters]\nm = 1.5\ng = 9.81\nl = \"1/2\"\n\
                [initial]\na = \"pi/3\"\nb = 0.2\nvelocity_a = 0.7\n";
    let ran = Ran::of(model, case, "double-pendulum");
    near(ran.at("momentum_a", 0), 3.0 * 0.25 * 0.7, 1.0);
    let angle = std::f64::consts::FRAC_PI_3 - 0.2;
    let expected = 1.5 * 0.25 * angle.cos() * 0.7;
    assert!((ran.at("momentum_b", 0) - expected).abs() < 1e-13);
    let folder = Folder::new("velocities-mixed");
    let mixed = format!("{case}momentum_b = 0.1\n");
    let done = run(&folder, model, &mixed, "").exits(2);
    let said = "initial.velocity_a: the momentum also depends on the velocity of `b`";
    done.says(said);
    // If they are not coupled, one body may have a velocity and another a momentum.
    let apart = model.replace("+ m2*l^2*cos(between)*da*db", "");
    run(&folder, &apart, &mixed, "").succeeds();
}

#[test]
fn along_a_line_velocities_are_values_expressions_or_lists() {
    let model = "model Chain {
        label i in 0..N step s;
        param m: Real at nodes;
        param k: Real;
        field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) - (h*k/2)*(next(q, i) - q)^2/s;
        end i = 0 { free; pinned { q = given; } }
    }";
    for count in [6, 40] {
        let of = |velocity: &str, name: &str| {
            let case = format!(
                "model = \"chain\"\nh = \"s/100\"\nsteps = \"2*s\"\n[labels]\ni = {count}\n[ends]\ni = [\"pinned\", \"free\"]\n\
                 [parameters]\ns = 1\nm = \"2 + i\"\nk = \"2*s\"\n[initial]\nq = 0\nvelocity_q = {velocity}\n"
            );
            Ran::of(model, &case, &format!("chain-{name}-{count}"))
        };
        let all = of("0.25", "all");
        let along = of("\"0.1*i\"", "along");
        let list: Vec<String> = (0..=count).map(|i| format!("{}", i * i)).collect();
        let list = of(&format!("[{}]", list.join(", ")), "list");
        for i in 1..=count {
            let (name, i) = (format!("momentum_q_{i}"), f64::from(i));
            near(all.at(&name, 0), 0.25 * (2.0 + i), i);
            near(along.at(&name, 0), 0.1 * i * (2.0 + i), i * i);
            near(list.at(&name, 0), i * i * (2.0 + i), i * i * i);
        }
    }
}

/// The printed case of a chain names the velocity that may replace a momentum.
#[test]
fn printed_cases_of_chains_name_velocities() {
    let folder = Folder::new("velocities-printed");
    folder.write(
        "chain.clebsch",
        "model Chain { label i in 0..N; param m, k: Real; field q: Real at nodes;
         lagrangian = m*(next(q) - q)^2/(2*h) - (h*k/2)*(next(q, i) - q)^2; }",
    );
    let printed = folder.clebsch("case @chain.clebsch");
    let said = "momentum_q = 0.0     # or velocity_q\n";
    printed.prints(said);
}

#[test]
fn velocities_that_leave_a_constraint_are_refused() {
    let model = "model Pendulum {
        param m, L, g: Real;
        field x: Vec<3>;
        hold λ: dot(x, x) = L^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[3];
    }";
    let case = |velocity: &str| {
        format!(
            "model = \"pendulum\"\nh = 0.01\nsteps = 5\n[parameters]\nm = 2\nL = 1\ng = 9.81\n\
             [initial]\nx = [0.6, 0, -0.8]\nvelocity_x = {velocity}\n"
        )
    };
    let ran = Ran::of(model, &case("[0.4, 0.1, 0.3]"), "pendulum");
    for (i, v) in [0.4, 0.1, 0.3].into_iter().enumerate() {
        near(ran.at(&format!("momentum_{}", i + 1), 0), 2.0 * v, 1.0);
    }
    let folder = Folder::new("velocities-across");
    let done = run(&folder, model, &case("[0.4, 0.1, 0]"), "").exits(2);
    let said = "case.toml:10: initial.velocity_x: the velocities violate the constraint `λ`: its left side minus its right \
        side changes at the rate 0.48";
    done.says(said);
}

/// Particles together with another field: both start with velocities.
#[test]
fn every_configuration_of_a_fluid_has_a_velocity() {
    let model = "model Mixed {
        label a in 0..N;
        grid n;
        param m, th: Real at a;
        param w: Real at n;
        param g, f, alpha: Real;
        field X: Vec<2> at a on box;
        field s: Real at a;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = (m/(2*h))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X))
            + th*(next(s) - s)^2/(2*h) - h*g*w*H*S/2 - h*th*s^2;
    }";
    let case = |start: &str| {
        format!(
            "model = \"mixed\"\nh = 0.01\nsteps = 1\n[labels]\na = 12\nn = [4, 4]\n[domain]\nlengths = [1.5, 1.0]\n\
             walls = [\"solid\", \"periodic\"]\n[parameters]\nm = 0.03\nth = \"0.01*(2 + cos(a))\"\ng = 1.0\nf = 2.0\nalpha = 0.15\n\
             [initial]\nX = {{ lattice = \"square\" }}\ns = \"0.3*sin(a)\"\n{start}\n"
        )
    };
    let ran = Ran::of(
        model,
        &case("velocity_X = [\"0.2*sin(pi*x/1.5)\", \"0.1\"]\nmomentum_s = 0.01"),
        "mixed-one",
    );
    let both = Ran::of(model, &case("velocity_s = \"0.1*a\""), "mixed-both");
    for a in 0..12_u32 {
        let [x, y] = [1, 2].map(|d| ran.at(&format!("X_{a}_{d}"), 0));
        let v = 0.2 * (std::f64::consts::PI * x / 1.5).sin();
        near(ran.at(&format!("momentum_X_{a}_1"), 0), 0.03 * (v - y), 0.1);
        near(
            ran.at(&format!("momentum_X_{a}_2"), 0),
            0.03 * (0.1 + x),
            0.1,
        );
        assert_eq!(ran.at(&format!("momentum_s_{a}"), 0), 0.01);
        // The particles are at rest in a rotating plane.
        near(both.at(&format!("momentum_X_{a}_1"), 0), -0.03 * y, 0.1);
        let heat = 0.01 * (2.0 + f64::from(a).cos());
        near(
            both.at(&format!("momentum_s_{a}"), 0),
            heat * 0.1 * f64::from(a),
            0.1,
        );
    }
}

#[test]
fn a_sweep_keeps_velocities_and_varies_them() {
    let folder = Folder::new("velocities-sweep");
    folder.write("kepler.clebsch", KEPLER);
    folder.write(
        "case.toml",
        "model = \"kepler\"\nh = 0.01\nsteps = 1\n[parameters]\nm = 1\nk = 1\n[initial]\nx = [1, 0]\nvelocity_x = [0, 1]\n",
    );
    let vary = |what: &str| {
        folder.clebsch(&format!(
            "sweep @kepler.clebsch --case @case.toml --vary {what} --out @out --force"
        ))
    };
    // The energy m (v^2/2 - 1) at the start and its drift depend on the momentum at each point.
    let columns = |name: &str| folder.samples("out/sweep.csv").column(name);
    vary("m=1,2").succeeds();
    for (m, p) in [1.0, 2.0].into_iter().zip(columns("momentum_2")) {
        assert!((p - m).abs() < 1e-3 * m, "{p}");
    }
    vary("velocity_x.2=1,3").succeeds();
    for (v, p) in [1.0, 3.0].into_iter().zip(columns("momentum_2")) {
        assert!((p - v).abs() < 1e-3, "{p}");
    }
    let done = vary("momentum.2=1,3").exits(2);
    let said = "the case gives velocity_x instead; set velocity_x";
    done.says(said);
}

#[test]
fn a_velocity_that_no_momentum_knows_is_refused() {
    let typed_as_two_h = "model Two {
        param m: Real;
        field x: Real;
        lagrangian = m*(next(x)-x)^2/2*h - h*x^2/2;
    }";
    let vortex = "model Vortex {
        param m: Real;
        field x, y: Real;
        lagrangian = m*(x + next(x))/2*(next(y)-y) - h*(x^2+y^2)/2;
    }";
    for (name, model, start, key) in [
        (
            "two",
            typed_as_two_h,
            "x = 0.5\nvelocity = 0.1",
            "initial.velocity",
        ),
        (
            "vortex",
            vortex,
            "x = 0.5\ny = 0.2\nvelocity_x = 0.1",
            "initial.velocity_x",
        ),
    ] {
        let folder = Folder::new(&format!("velocities-lost-{name}"));
        let case = format!(
            "model = \"{name}\"\nh = 0.01\nsteps = 5\n[parameters]\nm = 2\n[initial]\n{start}\n"
        );
        let done = run(&folder, model, &case, "").exits(2);
        let said = format!("{key}: no momentum depends on this velocity");
        let example = "as in `m*(next(x) - x)^2/(2*h)`";
        done.says(&said).says(example);
    }
    // The momentum of the other body determines the velocity of the first.
    let crossed = "model Crossed {
        param m: Real;
        field x, y: Real;
        lagrangian = m*(next(x)-x)*(next(y)-y)/h - h*x*y;
    }";
    let case = "model = \"crossed\"\nh = 0.01\nsteps = 5\n[parameters]\nm = 2\n[initial]\nx = 0.5\ny = 0.2\n\
                velocity_x = 0.1\nvelocity_y = 0\n";
    let ran = Ran::of(crossed, case, "crossed");
    near(ran.at("momentum_y", 0), 0.2, 1.0);
}
