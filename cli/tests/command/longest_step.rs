//! The stability limit of small motions about the start: it is printed before a run, is sharp, and larger steps cause
//! a warning.

use crate::common::{Done, Folder, clebsch, models, text_of};

/// Runs the program with a search that no load on the machine cuts short.
fn searched(words: &str) -> Done {
    clebsch(&format!("{words} --stability-limit 600"))
}

/// The printed stability limit for a model with a case, and the frequency ω with which it is 2/ω.
fn printed(model: &str, case: &str) -> f64 {
    let done = searched(&format!("run {model} --case {case} --steps 1"));
    let number = |before: &str, behind: &str| -> f64 {
        let rest = done.out.split_once(before).map(|(_, rest)| rest);
        let number = rest.and_then(|rest| rest.split_once(behind));
        let number = number.and_then(|(number, _)| number.parse().ok());
        number.unwrap_or_else(|| panic!("{}{}", done.out, done.err))
    };
    let frequency = number(
        "fastest small motion about the initial configuration: ω = ",
        "; ",
    );
    let step = number("stability limit 2/ω = ", "; h is ");
    assert!((frequency * step / 2.0 - 1.0).abs() < 0.01);
    step
}

/// In a straight rod, uniform and unloaded, shear and bending are coupled. The limit is 2/sqrt of the larger
/// eigenvalue of a pair.
#[test]
fn a_straight_rod_has_the_limit_of_its_coupled_modes() {
    let model = models("lattices/circular-rod.clebsch");
    let case = models("lattices/circular-rod.toml");
    let (s, mass, inertia, shear, bending) = (0.1, 1.0, 0.01, 100.0, 1.5);
    let a: f64 = 4.0 * shear / (mass * s * s);
    let b: f64 = 4.0 * bending / (inertia * s * s) + shear / inertia;
    let coupled = a * shear / inertia;
    let largest = 0.5 * (a + b) + (0.25 * (b - a) * (b - a) + coupled).sqrt();
    let limit = 2.0 / largest.sqrt();
    let found = printed(&model, &case);
    // A chain of 40 segments has waves of nearly the shortest length: the error is one part in a thousand.
    assert!((found / limit - 1.0).abs() < 0.01, "{found} {limit}");
    // Each limit by itself is larger.
    assert!(limit < 0.99 * 2.0 / a.sqrt() && limit < 0.99 * 2.0 / b.sqrt());
    // Below the limit the rod is stable; above it, the motion diverges within a few steps.
    let run = |part: f64| {
        let h = format!("{}", part * limit);
        searched(&format!(
            "run models/lattices/circular-rod.clebsch --case models/lattices/circular-rod.toml --h {h} --steps 300"
        ))
    };
    let (below, above) = (run(0.97), run(1.15));
    below.ended(0);
    below.never_says("longest");
    above.ended(1);
    above.says("1.15 times the stability limit");
}

/// One top that hangs, in rotations and in unit quaternions, has the frequency of a pendulum.
#[test]
fn a_hanging_top_has_the_limit_of_a_pendulum() {
    let folder = Folder::new("hanging-top");
    let data = "h = 1.3\nsteps = 1\n[parameters]\nJ = { I = [5.0, 4.0, 3.0] }\ngU = [0.0, 0.0, -3.0]\n\
                z = [0.0, 0.0, 1.0]\n[initial]\n";
    let rotations = "model Hang { param J: Sym<3>; param gU, z: Vec<3>; group Λ: SO<3> velocity Ω; \
        advected Γ: Vec<3> = Λ^T*z; constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; \
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ); }";
    let quaternions = rotations
        .replace("SO<3>", "SU<2>")
        .replace("Λ^T*z", "rot(Λ)^T*z")
        .replace("Ω^T*Γ", "rot(Ω)^T*Γ")
        .replace("J*Ω", "J*rot(Ω)");
    for (name, text) in [("rotations", rotations), ("quaternions", &quaternions)] {
        let model = folder.write(&format!("{name}.clebsch"), text);
        let case = format!(
            "model = \"hang\"\nname = \"hangs\"\n{data}Lambda = [1.0, 0.0, 0.0, 0.0]\nbody_momentum = [0.1, 0.0, 0.0]\n"
        );
        let case = folder.write(&format!("{name}.toml"), &case);
        let found = printed(&model, &case);
        let limit = 2.0 / (3.0_f64 / 4.0).sqrt();
        assert!(
            (found / limit - 1.0).abs() < 0.01,
            "{name}: {found} {limit}"
        );
    }
}

/// Long, since the limit of rows of twenty tops is sought at two steps. With the printed sign of
/// the Lagrangian in the thesis, neighbouring tops repel each other.
#[test]
fn a_wrong_sign_between_neighbours_is_warned_of() {
    let folder = Folder::new("wrong-sign");
    let text = text_of("lattices/coupled-tops.clebsch");
    let case = text_of("lattices/coupled-tops.toml");
    let case = case
        .replace("s = 1.0", "s = 0.1")
        .replace("i = 6", "i = 20")
        .replace("h = 0.01", "h = 0.04")
        .replace("\"3 + 2*exp(-i)\"", "0.1");
    let wrong = text.replace("+ (h/s)*tr(C", "- (h/s)*tr(C");
    assert_ne!(wrong, text);
    let case = folder.write("case.toml", &case);
    // For any step size, the growing motion alternates from site to site.
    for h in ["0.04", "0.0001"] {
        for (text, warned) in [(&text, false), (&wrong, true)] {
            let model = folder.write("model.clebsch", text);
            let done = searched(&format!("run {model} --case {case} --steps 1 --h {h}"));
            let said = done.err.contains("is the sign of the potential energy");
            assert_eq!(said, warned, "{h}: {}{}", done.out, done.err);
            assert_eq!(done.err.contains("elliptic"), warned, "{}", done.err);
        }
    }
}

/// Slow: derives chains on four groups.
/// Chains of springs on fields, planar rotations, rigid motions and linear maps have the same frequency as n + 1 free
/// beads: ω = 2 sqrt(k/m) sin(π n/(2n + 2)). It depends neither on the unit of mass nor on the step size of the case.
#[test]
fn rows_of_springs_have_one_limit_in_all_groups() {
    let folder = Folder::new("rows-of-springs");
    let ends = "end i = 0 { free; } end i = N { free; } }";
    let field = "field q: Vec<2> at nodes; lagrangian = h*m*dot((next(q) - q)/h, (next(q) - q)/h)/2 \
        - h*k*dot(next(q, i) - q, next(q, i) - q)/2;";
    let maps = "group Q: GL<2> at nodes velocity W; constraint next(Q) = Q*W; \
        lagrangian = m*tr((next(Q) - Q)^T*(next(Q) - Q))/(2*h) - h*k*tr((next(Q, i) - Q)^T*(next(Q, i) - Q))/2;";
    let motions = "group G: SE<3> at nodes velocity U; constraint next(G) = G*U; \
        let d = pos(next(G)) - pos(G); let e = pos(next(G, i)) - pos(G); \
        lagrangian = m*dot(d, d)/(2*h) - m*tr(rot(U))/h - h*k*dot(e, e)/2 + h*k*tr(rot(G)^T*rot(next(G, i)));";
    let turns = "group R: SO<2> at nodes velocity W; constraint next(R) = R*W; \
        lagrangian = -m*tr(W)/(2*h) + h*k*tr(R^T*next(R, i))/2;";
    let zero = "[0.0, 0.0]";
    let cases = [
        (
            "turns",
            turns,
            "R = [[1.0, 0.0], [0.0, 1.0]]\nbody_momentum_R = [[0.0, 0.0], [0.0, 0.0]]\n".to_owned(),
        ),
        ("field", field, format!("q = {zero}\nmomentum_q = {zero}\n")),
        (
            "maps",
            maps,
            "Q = [[1.0, 0.0], [0.0, 1.0]]\nbody_momentum_Q = [[0.0, 0.0], [0.0, 0.0]]\n".to_owned(),
        ),
        (
            "motions",
            motions,
            "G = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]\n\
             body_momentum_G = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n"
                .to_owned(),
        ),
    ];
    for (name, text, start) in &cases {
        let text = format!("model Row {{ label i in 0..N; param m, k: Real; {text} {ends}");
        let model = folder.write(&format!("{name}.clebsch"), &text);
        for (n, size, h) in [(4, 1.0, 0.1), (40, 1e-12, 0.01), (40, 1.0, 1e-12)] {
            let case = format!(
                "model = \"row\"\nname = \"row\"\nh = {h:e}\nsteps = 1\n[labels]\ni = {n}\n[ends]\n\
                 i = [\"free\", \"free\"]\n[parameters]\nm = {size:e}\nk = {size:e}\n[initial]\n{start}"
            );
            let case = folder.write(&format!("{name}-{n}.toml"), &case);
            let found = 2.0 / printed(&model, &case);
            let half = std::f64::consts::FRAC_PI_2 * f64::from(n) / f64::from(n + 1);
            let wanted = 2.0 * half.sin();
            // Three digits are printed.
            assert!(
                (found / wanted - 1.0).abs() < 0.01,
                "{name} {n} {size:e} {h:e}: {found} {wanted}"
            );
        }
    }
}

/// A chain of bodies that starts far from equilibrium, with its bonds rotated by up to forty radians. Forces rotate
/// with the frames of the bodies there, and the stiffness is the symmetric part of their derivative. The numbers are
/// square roots of the largest eigenvalue and of minus the least eigenvalue of the second derivative of the energy,
/// relative to the inertia tensors, by numpy. For 40 sites, the second number is 1.096802.
#[test]
fn a_bent_start_has_the_limit_of_the_symmetric_part() {
    let folder = Folder::new("bent-start");
    let text = "model Bent { label i in 0..N; param J: Sym<3>; param g, e: Vec<3>; group R: SO<3> at nodes velocity W; \
        constraint next(R) = R*W; lagrangian = -tr(J*W)/h + h*tr(R^T*next(R, i)) + h*dot(g, R*e); \
        end i = 0 { free; } end i = N { free; } }";
    let model = folder.write("bent.clebsch", text);
    let growth = "with the rate 1.097";
    for (n, frequency) in [(5, 1.397_230), (40, 1.413_624)] {
        let case = format!(
            "model = \"bent\"\nname = \"own\"\nh = 0.01\nsteps = 1\n[labels]\ni = {n}\n[ends]\ni = [\"free\", \"free\"]\n\
             [parameters]\nJ = [[1.0, 0.1, 0.0], [0.1, 1.5, 0.0], [0.0, 0.0, 2.0]]\ng = [0.0, 0.0, 1.0]\ne = [0.0, 0.0, 1.0]\n\
             [initial]\nR = [\"cos(0.5*i^2)\", 0.0, \"sin(0.5*i^2)\", 0.0]\nbody_momentum_R = [0.0, 0.0, 0.0]\n"
        );
        let case = folder.write("case.toml", &case);
        let found = 2.0 / printed(&model, &case);
        // With 18 degrees of freedom the result has the printed digits. With 123, in the space of 60 vectors,
        // it is within a hundredth.
        assert!(
            (found / frequency - 1.0).abs() < 0.02,
            "{n}: {found} {frequency}"
        );
        let done = searched(&format!("run {model} --case {case}"));
        let told = done.err.contains(growth);
        assert_eq!(told, n == 40, "{}", done.err);
    }
}

/// No limit is reported for other kinds of steps: a charge in a magnetic field, a potential at the midpoint of the
/// step, a kink. Large steps do not make them unstable.
#[test]
fn of_steps_of_another_kind_nothing_is_said() {
    let folder = Folder::new("other-steps");
    let silent = |done: crate::common::Done| {
        done.ended(0);
        done.never_says("longest");
        done.never_prints("longest");
    };
    silent(searched("run charged-particle --h 5 --steps 20"));
    let of = |name: &str, potential: &str, h: &str| {
        let text = format!(
            "model Spring {{ param m, k: Real; field q: Real; lagrangian = m*(next(q) - q)^2/(2*h) - {potential}; }}"
        );
        let model = folder.write(&format!("{name}.clebsch"), &text);
        let case = format!(
            "model = \"spring\"\nname = \"own\"\nh = {h}\nsteps = 20\n[parameters]\nm = 1.0\nk = 1.0\n[initial]\nq = 0.0\nmomentum = 0.1\n"
        );
        let case = folder.write(&format!("{name}.toml"), &case);
        searched(&format!("run {model} --case {case}"))
    };
    silent(of("middle", "h*(k/2)*((q + next(q))/2)^2", "5.0"));
    // A spring at the node has the limit 2.
    of("node", "h*(k/2)*q^2", "2.05").says("1.02 times the stability limit 2 of small motions");
    silent(of("node", "h*(k/2)*q^2", "0.5"));
}

/// A rod along its arc length is physically unstable, like a body balanced on its head. The warning does not
/// question a sign; it reports the step size that resolves the growth.
#[test]
fn of_one_body_that_is_unstable_no_sign_is_doubted() {
    let run = |h: &str| {
        searched(&format!(
            "run models/elastic/kirchhoff-static.clebsch --case models/elastic/kirchhoff-static.toml --h {h} --steps 2 --json"
        ))
    };
    let long = run("0.3").succeeds();
    // With the force (0.00179, 0.00568, 0.01448) on the section: the tangential part alone, with the root of the
    // bending stiffness 0.002, gives 2.6910; with half of the other part, which couples bending and twist, numpy
    // gives 2.7188; 0.3 divided by this.
    long.says([
        "rate 2.719",
        "do not resolve the growth; use at most 0.1103",
    ]);
    long.never_says("sign");
    let short = run("0.08");
    assert!(short.err.is_empty(), "{}", short.err);
}

/// Long, since the limit of two rods is searched for at five step sizes.
/// The limit is reported however far the step size exceeds it, and also if the first step fails.
#[test]
fn of_a_step_that_is_far_too_long_the_limit_is_told() {
    let run = |h: &str| {
        searched(&format!(
            "run models/lattices/geometrically-exact-rod.clebsch --case models/lattices/geometrically-exact-rod.toml --h {h} --steps 1 --json"
        ))
    };
    // From eight times to a million times too large.
    let said = "times the stability limit 0.0012";
    for h in ["0.01", "1", "1000"] {
        run(h).says(said);
    }
    // The first step of a rod that is struck fails.

    let refused = searched(
        "run models/lattices/circular-rod.clebsch --case models/lattices/circular-rod.toml --h 100",
    )
    .exits(1);
    refused.says(["times the stability limit", "cannot take the first step"]);
    // JSON output contains equal numbers.
    let object = run("0.0005").json();
    let limit = &object["longest_step"];
    let number = |key: &str| limit[key].as_f64().expect("a number");
    assert!((number("step") * number("frequency") - 2.0).abs() < 1e-12);
    assert!((number("share") * number("step") - 0.0005).abs() < 1e-15);
}

/// Long, since chains of up to forty links are derived, and run at two step sizes.
/// In a straight hanging chain of equal links, the squared frequencies are g/a times the roots of Laguerre
/// polynomials. A run with a step size above the limit fails, and a run below it succeeds.
#[test]
fn chains_that_hang_have_the_limits_of_laguerre() {
    let folder = Folder::new("hanging-straight");
    let text = "model Hang { label i in 0..N; param m, a: Real; param g: Vec<3>; field x: Vec<3> at nodes; \
        field u: Real at nodes; hold λ: dot(next(x, i) - x, next(x, i) - x) = a^2; let V = (next(x) - x)/h; \
        lagrangian = h*m*(dot(V, V)/2 + dot(g, x)) + (next(u) - u)^2/(2*h) - h*(next(u, i) - u)^2/2; \
        end i = 0 { pinned { x = given; u = given; } } end i = N { free; } }";
    let model = folder.write("hang.clebsch", text);
    // The last of 3 is derived body by body.
    for (n, root) in [
        (3, 6.289_945_082_937_479_f64),
        (5, 12.640_800_844_275_783),
        (40, 142.280_044_469_158_9),
    ] {
        let case = format!(
            "model = \"hang\"\nname = \"straight\"\nh = 0.001\nsteps = 1\n[labels]\ni = {n}\n[ends]\ni = [\"pinned\", \"free\"]\n\
             [parameters]\nm = 0.2\na = 0.1\ng = [0.0, 0.0, -2.0]\n[initial]\nx = [0.0, 0.0, \"-0.1*i\"]\n\
             momentum_x = [\"1e-8*sin(3*i*i)\", 0.0, 0.0]\nu = 0.0\nmomentum_u = 0.0\n"
        );
        let case = folder.write("case.toml", &case);
        let limit = 2.0 / (20.0 * root).sqrt();
        let found = printed(&model, &case);
        assert!((found / limit - 1.0).abs() < 0.01, "{n}: {found} {limit}");
        let run = |part: f64| {
            let h = format!("{}", part * limit);
            searched(&format!("run {model} --case {case} --h {h} --steps 600"))
        };
        let (below, above) = (run(0.98), run(1.02));
        below.ended(0);
        below.never_says("longest");
        above.ended(1);
        above.says(["1.02 times the stability limit", "step from node"]);
    }
}

/// Chains of equal links released from inclined straight lines: far from equilibrium, the forces are large compared
/// with their changes. The numbers are square roots of the largest eigenvalue of the second derivative of the energy
/// along the constraints, including the constraint forces at rest, from numpy.
#[test]
fn chains_that_lean_have_the_limits_along_their_constraints() {
    let folder = Folder::new("leaning-chains");
    let text = "model Leaning { label i in 0..N; param g: Vec<3>; field x: Vec<3> at nodes; \
        hold l: dot(next(x, i) - x, next(x, i) - x) = 1; \
        lagrangian = dot(next(x) - x, next(x) - x)/(2*h) + h*dot(g, x); \
        end i = 0 { held { x = given; } } end i = N { free; } }";
    let model = folder.write("leaning.clebsch", text);
    for (n, lean, frequency) in [
        (2, 1.4, 2.2853),
        (2, 1.55, 0.79936),
        (3, 1.5, 2.0011),
        (4, 1.4, 3.791),
        (6, 1.3, 6.2031),
        (6, 1.55, 1.7295),
    ] {
        let case = format!(
            "model = \"leaning\"\nname = \"own\"\nh = 0.01\nsteps = 1\n[labels]\ni = {n}\n[ends]\ni = [\"held\", \"free\"]\n\
             [parameters]\ng = [0.0, 0.0, -9.0]\n[initial]\nx = [\"i*sin({lean})\", 0.0, \"-i*cos({lean})\"]\nmomentum_x = [0.0, 0.0, 0.0]\n"
        );
        let case = folder.write("own.toml", &case);
        let found = 2.0 / printed(&model, &case);
        assert!(
            (found / frequency - 1.0).abs() < 0.01,
            "{n} {lean}: {found} {frequency}"
        );
    }
}

/// A constraint on a sum does not change the other modes. In a ring of springs with uniform mass the fastest are the
/// shortest waves; the constraint excludes the uniform mode.
#[test]
fn under_a_sum_that_is_held_the_others_swing() {
    let folder = Folder::new("held-sum");
    let text = "model Shared { label i in 0..N; periodic; param k, K, Q: Real; field u: Real at nodes; \
        field y: Real at nodes; hold p: sum(u) = Q; lagrangian = (next(u) - u)^2/(2*h) + (next(y) - y)^2/(2*h) \
        - h*k*(next(u, i) - u)^2/2 - h*K*u^2/2 - h*y^2/2; }";
    let model = folder.write("shared.clebsch", text);
    for (n, spring, site, square) in [
        (6, 2.0, 1.0, 9.0),
        // With 5 sites the springs contribute 4 sin^2(2π/5) k.
        (
            5,
            3.0,
            0.5,
            0.5 + 12.0 * (0.4 * std::f64::consts::PI).sin().powi(2),
        ),
    ] {
        let case = format!(
            "model = \"shared\"\nname = \"ring\"\nh = 0.01\nsteps = 1\n[labels]\ni = {n}\n[ends]\ni = \"periodic\"\n\
             [parameters]\nk = {spring:?}\nK = {site:?}\nQ = 0.0\n[initial]\nu = 0.0\nmomentum_u = 0.0\ny = 0.0\nmomentum_y = 0.0\n"
        );
        let case = folder.write("case.toml", &case);
        let limit = 2.0 / f64::sqrt(square);
        let found = printed(&model, &case);
        assert!((found / limit - 1.0).abs() < 0.01, "{n}: {found} {limit}");
    }
}

/// If the limit of a chain with constraints is unknown, the reason is reported without a number.
#[test]
fn where_nothing_is_known_of_a_held_line_the_reason_is_said() {
    let folder = Folder::new("held-unknown");
    let of = |name: &str, mass: &str, potential: &str| {
        let text = format!(
            "model Chain {{ label i in 0..N; param a: Real; field x: Vec<3> at nodes; \
             hold λ: dot(next(x, i) - x, next(x, i) - x) = a^2; let V = (next(x) - x)/h; let X = (x + next(x))/2; \
             lagrangian = h*({mass}*dot(V, V)/2 {potential}); end i = 0 {{ free; }} end i = N {{ free; }} }}"
        );
        let model = folder.write(&format!("{name}.clebsch"), &text);
        let case = "model = \"chain\"\nname = \"own\"\nh = 0.1\nsteps = 1\n[labels]\ni = 6\n[ends]\ni = [\"free\", \"free\"]\n\
            [parameters]\na = 0.1\n[initial]\nx = [0.0, 0.0, \"0.1*(i - N/2)\"]\nmomentum_x = [0.0, 0.0, 0.0]\n";
        let case = folder.write("case.toml", case);
        let done = searched(&format!("run {model} --case {case}"));
        done.never_prints("frequency");
        format!("{}{}", done.out.replace("\n", " "), done.err)
    };
    let said = |all: String, words: &str| {
        let all = all.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(all.contains(words), "{all}");
    };
    let not = "stability limit of small motions: not computed, since ";
    said(
        of("loose", "1.0", ""),
        &format!("{not}the stiffness at the initial configuration is zero"),
    );
    said(
        of("negative", "(-1.0)", "- dot(x, x)"),
        &format!("{not}the kinetic energy is not positive"),
    );
    said(
        of("middle", "1.0", "- 2*dot(X, X)"),
        &format!("{not}the scheme does not treat the fastest mode"),
    );
}

/// Slow: searches for the limit of chains of links with every force. Links that hang in a rotating plane oscillate
/// along their constraints, where the Coriolis force vanishes. Neither this force nor the origin of its potential
/// changes the limit. At rest, the momenta are the momenta of this potential.
#[test]
fn terms_linear_in_velocities_leave_the_limit_along_constraints() {
    let folder = Folder::new("coriolis");
    let text = "model Links { label i in 0..N; param m: Real at nodes; param f, g: Real; param l: Real at segments; \
        field x: Vec<2> at nodes; hold n: dot(next(x, i) - x, next(x, i) - x) = l^2; let V = next(x) - x; \
        lagrangian = m*dot(V, V)/(2*h) + (m*f/2)*dot(perp(x), V) - h*m*g*x[2]; \
        end i = 0 { pinned { x = given; } } }";
    let model = folder.write("links.clebsch", text);
    let limit = |links: usize, f: f64, aside: f64, h: &str| {
        let case = format!(
            "model = \"links\"\nname = \"own\"\nh = {h}\nsteps = 1\n[labels]\ni = {links}\n\
             [parameters]\nm = 1.0\nf = {f:?}\ng = 1.0\nl = 1.0\n\
             [initial]\nx = [{aside:?}, \"-i\"]\nmomentum_x = [\"f/2*i\", {:?}]\n",
            0.5 * f * aside
        );
        printed(&model, &folder.write("case.toml", &case))
    };
    // Three links swing at most with the root of 6.29 (Laguerre); forty by loops over sites.
    for (links, square) in [(3, Some(6.289_945)), (40, None)] {
        let still = limit(links, 0.0, 0.0, "0.002");
        if let Some(square) = square {
            assert!((still * f64::sqrt(square) / 2.0 - 1.0).abs() < 0.01);
        }
        for (f, aside, h) in [
            (0.7, 0.0, "0.002"),
            (0.7, 10.0, "0.002"),
            (2.0, 10.0, "0.0005"),
        ] {
            let found = limit(links, f, aside, h);
            assert!(
                (found / still - 1.0).abs() < 0.01,
                "{links} {f} {aside}: {found} {still}"
            );
        }
    }
}

/// A charge in a magnetic field and a trap: at the limit of the trap alone, successive steps are opposite, and the
/// field has no effect. The potential of the field may be written with any multiple `c` of a difference that adds up
/// to a constant.
#[test]
fn a_magnetic_field_leaves_the_limit_of_the_trap() {
    let folder = Folder::new("magnetic");
    let text = "model Charge { param K: Sym<2>; param f, c: Real; field x: Vec<2>; let V = next(x) - x; let X = (x + next(x))/2; \
        lagrangian = dot(V, V)/(2*h) + f*((1/2 + c)*X[1]*V[2] - (1/2 - c)*X[2]*V[1]) - (h/2)*dot(x, K*x); }";
    let model = folder.write("charge.clebsch", text);
    for (f, c) in [(0.0, 0.0), (1.0, 0.0), (1.0, -0.5)] {
        let case = format!(
            "model = \"charge\"\nname = \"own\"\nh = 0.9\nsteps = 1\n[parameters]\nK = [[1.0, 0.0], [0.0, 4.0]]\n\
             f = {f:?}\nc = {c:?}\n[initial]\nx = [0.0, 0.0]\nmomentum = [0.0, 0.0]\n"
        );
        let found = printed(&model, &folder.write("case.toml", &case));
        assert!((found - 1.0).abs() < 0.01, "{f} {c}: {found}");
    }
}
