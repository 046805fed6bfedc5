//! Functions that a case defines: the run is identical to a run of the model with the expression typed in their
//! place. An error in a function is reported with file and line.

use crate::common::{Folder, runs, table};
use crate::text_runs::run;

const BOWL: &str = "/// A bead in a bowl, carried by a vector potential.
model Bowl {
    param m, g, A: Real;
    given b(Vec<2>): Real = case;
    given R(Vec<2>): Vec<2> = case;
    field X: Vec<2>;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + m*dot(R((X + next(X))/2), next(X) - X) - h*m*g*b(X);
}
";

const FUNCTIONS: &str = "b = \"A*x^2/2 + exp(y)\"\nR = [\"-A*y/2\", \"x*y/3\"]";

fn case(functions: &str) -> String {
    format!(
        "model = \"bowl\"\nh = 0.05\nsteps = 50\n{functions}\n[parameters]\nm = 1.2\ng = 0.8\nA = 0.7\n\
         [initial]\nX = [0.3, -0.2]\nmomentum = [0.1, 0.4]\n"
    )
}

fn rows(folder: &Folder, model: &str, case: &str, name: &str) -> String {
    let model = folder.write(&format!("{name}.clebsch"), model);
    let case = folder.write(&format!("{name}.toml"), case);
    let out = folder.path(name);
    runs(&format!("run {model} --case {case} --out {out}"));
    std::fs::read_to_string(format!("{out}/trajectory.csv")).expect("is written")
}

#[test]
fn a_run_is_that_of_the_expression_in_its_place() {
    let folder = Folder::new("functions");
    let by_hand = BOWL
        .replace("    given b(Vec<2>): Real = case;\n", "")
        .replace(
            "    given R(Vec<2>): Vec<2> = case;\n",
            "    let c = (X + next(X))/2;\n",
        )
        .replace("R((X + next(X))/2)", "((-A*c[2]/2)*E1 + (c[1]*c[2]/3)*E2)")
        .replace("b(X)", "(A*X[1]^2/2 + exp(X[2]))");
    let given = rows(
        &folder,
        BOWL,
        &case(&format!("[functions]\n{FUNCTIONS}")),
        "given",
    );
    assert_eq!(given, rows(&folder, &by_hand, &case(""), "typed"));
}

#[test]
fn a_fluid_over_topography_has_the_lengths_of_its_domain() {
    let folder = Folder::new("functions-fluid");
    let text = "model Lake {
        label a in 0..N; param m: Real at a; param g: Real; given b(Vec<2>): Real = case;
        field X: Vec<2> at a on torus(L); mesh D: Real at a = voronoi_area(X);
        lagrangian = (m/(2*h))*dot(next(X) - X, next(X) - X) - h*g*m*(m/D/2 + b(X));
    }";
    let model = folder.write("lake.clebsch", text);
    let sample = runs(&format!("case {model}"));
    sample.prints("b = \"0.1*cos(2*pi*x/Lx)\"");
    let steps = sample.out.replace("steps = 1000", "steps = 5");
    let of = |name: &str, model: &str, case: &str| {
        let own = folder.write(&format!("{name}.toml"), case);
        let out = folder.path(name);
        runs(&format!("run {model} --case {own} --out {out}"));
        std::fs::read_to_string(format!("{out}/trajectory.csv")).expect("is written")
    };
    let wide = steps.replace("L = [1.0, 1.0]", "L = [2.0, 1.0]");
    let given = of("given", &model, &wide);
    let by_hand = folder.write(
        "by-hand.clebsch",
        text.replace(" given b(Vec<2>): Real = case;", "")
            .replace("b(X)", "0.1*cos(2*pi*X[1]/2.0)"),
    );
    let bare = wide
        .replace("b = \"0.1*cos(2*pi*x/Lx)\"", "")
        .replace("[functions]", "");
    assert_eq!(given, of("typed", &by_hand, &bare));
}

#[test]
fn what_is_wrong_of_a_function_is_told_by_its_line() {
    let folder = Folder::new("functions-wrong");
    folder.write("bowl.clebsch", BOWL);
    for [functions, said] in table(
        r#"
                                                 | missing table [functions]
        [functions]\nb = "x"                     | missing key `functions.R`
        [functions]\nb = "x"\nR = "y"            | :6: functions.R: expected a list of 2 expressions
        [functions]\nb = "cos(x"\nR = ["x", "y"] | :5: functions.b: in this expression, at character 4: this `(` is not closed
        [functions]\nb = "q"\nR = ["x", "y"]     | :5: functions.b: `q` is unknown
        // Errors of the derivation are reported at the position of the expression in the case.
        [functions]\nb = "x"\nR = ["sqrt(-1 - y^2)", "y"] | :6: functions.R: the base of this root is negative for all values
        [functions]\nc = "x"\nR = ["x", "y"]     | :5: unknown key `functions.c`
"#,
    ) {
        folder.write("own.toml", case(functions));
        folder
            .clebsch("run @bowl.clebsch --case @own.toml")
            .refuses(said);
    }
    // A model without functions.
    folder.write("own.toml", case("[functions]\nb = \"x\""));
    let plain = BOWL
        .replace("= case;", "= \"x\";")
        .replace("Vec<2> = \"x\"", "Vec<2> = [\"x\", \"y\"]");
    let plain = folder.write("plain.clebsch", &plain);
    folder
        .clebsch(&format!("run {plain} --case @own.toml"))
        .refuses("unknown key `functions`");
}

/// Newton's method needs the second derivatives of Carlson's integral. The check of the action has its own integral.
#[test]
fn the_function_of_a_path_has_the_derivatives_that_newton_needs() {
    let case = "model = \"drop\"\nh = 0.05\nsteps = 20\n[parameters]\nm = 1\nk = 2\n\
                [initial]\nQ = [[1.2, 0.1, 0], [0, 0.9, 0.2], [0.1, 0, 1]]\n\
                velocity = [[0, 0.3, 0], [-0.3, 0, 0], [0, 0.1, 0.2]]\n";
    for (given, called) in [
        ("Sym<3>): Real = clebsch::functions::carlson_rf;", "RF(B)"),
        (
            "Real, Real, Real): Real = clebsch::functions::carlson_rf_of_invariants;",
            "RF(I1(B), I2(B), det(B))",
        ),
    ] {
        let model = format!(
            "model Drop {{ param m, k: Real; given RF({given} field Q: Mat<3>; let V = next(Q) - Q; let C = (Q + next(Q))/2;
             let B = C*C^T; lagrangian = m*tr(V^T*V)/(2*h) - h*k*{called} - h*k*tr(B)/2; }}"
        );
        run(&Folder::new("functions-newton"), &model, case, "")
            .succeeds()
            .prints("action as stated: 20 steps checked");
        let other = model.replace("carlson_rf", "carlson_rd");
        run(&Folder::new("functions-newton"), &other, case, "").says([
            "clebsch has no function `carlson_rd",
            "use `carlson_rf` of a `Sym<3>`",
        ]);
    }
}
