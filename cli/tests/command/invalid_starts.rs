//! The messages about a start or numbers outside a model's domain, and about Lagrangians that look like a
//! mistake but are valid.

use crate::common::{Done, Folder, has, process_in, table};
use crate::text_runs;

/// A run of a model with a case, into `out`.
fn run(folder: &Folder, model: &str, case: &str) -> Done {
    text_runs::run(folder, model, case, "--every 1 --out @out --force")
}

const PENDULA: &str = "model Pendula {
    param m, g: Real;
    field x, y: Vec<2>;
    hold p: dot(x, x) = 1;
    hold q: dot(y, y) = 1;
    lagrangian = m*(dot(next(x) - x, next(x) - x) + dot(next(y) - y, next(y) - y))/(2*h) - h*m*g*(x[2] + y[2]);
}";

#[test]
fn a_momentum_that_is_not_tangent_is_told_of_the_constraint_that_takes_it() {
    let folder = Folder::new("not-tangent");
    let case = "model = \"pendula\"\nname = \"own\"\nh = 0.01\nsteps = 2\n[parameters]\nm = 1.0\ng = 1.0\n[initial]\n\
        x = [0.0, -1.0]\ny = [1.0, 0.0]\nmomentum_x = [1.0, 0.0]\nmomentum_y = [0.5, 0.25]\n";
    let done = run(&folder, PENDULA, case);
    assert_ne!(done.code, 0);
    let told = "q: the initial momentum is not tangent to the constraint `y_k·y_k = 1`: projecting it onto the constraints \
        removes 5.000e-1 of its size 1.559e0, with the multiplier 0.25 for this constraint; subtract the multiplier times the \
        gradient";
    done.says(told);
    // Without that part, the model runs.
    let done = run(
        &folder,
        PENDULA,
        &case.replace("[0.5, 0.25]", "[0.0, 0.25]"),
    );
    done.ended(0);
}

#[test]
fn what_overflows_is_told_from_what_has_no_value() {
    let folder = Folder::new("overflow");
    let model = "model Spring { param m, k: Real; field x: Real; lagrangian = m*(next(x) - x)^2/(2*h) - h*k*x^2/2; }";
    let case = "model = \"spring\"\nname = \"own\"\nh = 5.0\nsteps = 400\n[parameters]\nm = 1.0\nk = 1.0\n[initial]\nx = 1.0\nmomentum = 0.0\n";
    let done = run(&folder, model, case);
    assert_ne!(done.code, 0);
    let why = "the invariant `energy` is inf: it exceeds the largest double, 1.8e308; reduce the step size";
    done.says(why);
}

const VORTICES: &str = "model Vortices {
    param a, b: Real;
    field x, y: Vec<2>;
    let d = x - y;
    lagrangian = (a*dot(perp(x), next(x) - x) + b*dot(perp(y), next(y) - y))/2 + h*a*b*log(dot(d, d))/(4*pi);
}";

#[test]
fn point_vortices_run_without_a_warning() {
    let folder = Folder::new("vortices");
    let case = "model = \"vortices\"\nname = \"pair\"\nh = 0.01\nsteps = 1000\n[parameters]\na = 1.0\nb = 1.0\n[initial]\n\
        x = [0.5, 0.0]\ny = [-0.5, 0.0]\nmomentum_x = [0.0, 0.25]\nmomentum_y = [0.0, -0.25]\n";
    run(&folder, VORTICES, case).ended(0).never_says("warning");
    let samples = folder.samples("out/trajectory.csv");
    // Equal vortices at the distance d rotate about their centre at the rate Γ/(π d²).
    let angle = 10.0 / std::f64::consts::PI;
    let turned = [0.5 * angle.cos(), 0.5 * angle.sin()];
    for (name, wanted) in ["x_1", "x_2"].into_iter().zip(turned) {
        let found = samples.end(name);
        assert!(
            (found.abs() - wanted.abs()).abs() < 1e-4,
            "{name}: {found} {wanted}"
        );
    }
}

/// Words and signs of other languages in the numbers of a case.
#[test]
fn words_of_other_languages_in_a_case_are_answered() {
    let model = "model Spring {
        param m, k: Real;
        field x: Real;
        lagrangian = m*(next(x)-x)^2/(2*h) - h*k*x^2;
    }";
    let radians = "angles are in radians: 30 degrees are `30*pi/180`, or `pi/6`";
    for (value, said) in [
        ("sin(30°)", radians),
        ("sin(30*deg)", radians),
        ("sind(30)", radians),
        ("sqrtt(2)", "did you mean `sqrt`?"),
        ("ln(3)", "write `log(x)`"),
        ("2*PI", "write `pi`"),
    ] {
        let case = format!(
            "model = \"spring\"\nh = 0.01\nsteps = 1\n[parameters]\nm = 1\nk = \"{value}\"\n[initial]\nx = 1\n"
        );
        let folder = Folder::new("misstated-words");
        text_runs::run(&folder, model, &case, "")
            .refuses("case.toml:6: parameters.k: ")
            .says(said);
    }
}

/// The message of a model states the mistake on its first line.
#[test]
fn rates_and_degrees_in_a_model_are_answered() {
    let rate = "write a rate of change as a difference over the step: `(next(x) - x)/h`";
    for (lagrangian, said) in [
        ("m*h*(d/dt x)^2/2", rate),
        ("m*h*dt(x)^2/2", rate),
        ("m*h*dot(x)^2/2", rate),
        ("m*(next(x)-x)^2/(2*h) - h*cos(30°*x)", "`30*pi/180`"),
        ("m*(next(x)-x)^2/(2*h) - h*cos(30*deg*x)", "`30*pi/180`"),
        ("m*(next(x)-x)^2/(2*h) - h*sqrtt(x)", "did you mean `sqrt`?"),
    ] {
        let folder = Folder::new("misstated-rates");
        let text = format!(
            "model Spring {{\n    param m: Real;\n    field x: Real;\n    lagrangian = {lagrangian};\n}}\n"
        );
        folder.write("spring.clebsch", &text);
        for command in ["derive", "run", "check"] {
            let done = folder.clebsch(&format!("{command} @spring.clebsch"));
            assert!(done.err.starts_with("error: "), "{command}: {}", done.err);
            done.says(said);
        }
    }
}

/// Energies near the largest f64: the message names the term that overflows, and reports no function outside
/// its domain.
#[test]
fn an_energy_beyond_the_range_of_numbers_is_named() {
    let model = "model Chain {
        label i in 0..N;
        param m, c: Real;
        field x: Real at nodes;
        lagrangian = m*(next(x)-x)^2/(2*h) - h*c*(next(x,i)-x)^2/2;
    }";
    for count in [4, 40] {
        for size in ["2.2e153", "3e153", "1e154"] {
            let case = format!(
                "model = \"chain\"\nh = 0.01\nsteps = 5\n[labels]\ni = {count}\n[parameters]\nm = 1\nc = {}\n[initial]\n\
                 x = \"i*{size}\"\nmomentum_x = 0\n",
                if count == 4 { 10 } else { 1 }
            );
            let folder = Folder::new("misstated-overflow");
            let done = text_runs::run(&folder, model, &case, "");
            done.never_says("left its domain");
            if done.code != 0 {
                done.says("`energy` is inf");
            }
        }
    }
    let spring = "model Spring {
        param m: Real;
        field x: Real;
        lagrangian = m*(next(x)-x)^2/(2*h) - h*x^2/2;
    }";
    let case = "model = \"spring\"\nh = 0.01\nsteps = 10\n[parameters]\nm = 1\n[initial]\nx = 1.3e154\nmomentum = 1.3e154\n";
    let done = text_runs::run(&Folder::new("misstated-overflow-check"), spring, case, "");
    let both = format!("{}{}", done.out, done.err);
    assert!(
        both.contains("`energy` is inf") && !both.contains("does NOT hold"),
        "{both}"
    );
}

#[test]
fn slips_of_a_new_user_are_answered_by_what_to_write() {
    let folder = Folder::new("slips");
    process_in(&folder.path(""), "new two").ended(0);
    let case = folder.read("two.toml");
    let said = |words: &str| {
        let done = process_in(&folder.path(""), words);
        format!("{}{}", done.out, done.err)
    };
    let sample = said("case two.clebsch");
    has(&sample, ["mass at y", "position of the second mass"]);
    let of_case = |from: &str, to: &str| {
        folder.write("own.toml", case.replace(from, to));
        said("check two.clebsch --case own.toml")
    };
    for [from, to, answer] in table(
        r#"
        k = 50.0     | k = 2*pi**2    | put expressions in quotes: "2*pi^2"
        k = 50.0     | k = (3.0, 0.0) | write [3.0, 0.0]
        k = 50.0     | k = None       | expected a number, found `None`
        k = 50.0     | k = "2*np.pi"  | write `pi`
        velocity_y = | velocty_y =    | did you mean `velocity_y`?
        m1 = 1.0     | m1 = 0         | the parameter `m1` of the kinetic energy is 0
"#,
    ) {
        let found = of_case(from, to);
        assert!(found.contains(answer), "{to}\n{found}");
    }
    for [words, answer] in table(
        "
        run two                                | did you mean `two.clebsch`?
        run two.clebsch --time 1               | '--until'
        list chian                             | did you mean `chain`?
        check two.clebsch                      | model two: derived, 2 configurations
        check two.clebsch --case sample        | first step: solved
        run toda-chain --set N=100             | `N` is the number of sites of `i`
        run free-body --set Lambda.angle=1     | `--set 'Lambda={axis=[0,1,0], angle=1}'`
        run free-body --set I=[0.2,0.2,0.55]   | moments of inertia must satisfy I3 <= I1 + I2; 0.55 > 0.4
",
    ) {
        let found = said(words);
        assert!(found.contains(answer), "{words}\n{found}");
    }
}
