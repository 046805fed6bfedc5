//! Every form of a rotation is accepted wherever a case contains a rotation: initial values, parameters, values at
//! sites and at ends.

use crate::common::{Folder, table};
use crate::text_runs::{Ran, run};

const MODEL: &str = "model Drawn {
    param J: Sym<3>;
    param R0: SO<3>;
    param q0: SU<2>;
    group R: SO<3> velocity W;
    constraint next(R) = R*W;
    lagrangian = -tr(J*W)/h + h*tr(R0^T*R) + h*tr(rot(q0)^T*R);
}";

fn case(parameter: &str, quaternion: &str, initial: &str) -> String {
    format!(
        "model = \"drawn\"\nh = 0.01\nsteps = 3\n[parameters]\nJ = {{ I = [1, 2, 2.5] }}\nR0 = {parameter}\nq0 = {quaternion}\n\
         [initial]\nR = {initial}\n"
    )
}

#[test]
fn a_parameter_that_is_a_rotation_is_given_as_an_initial_one_is() {
    let quarter = "[[1, 0, 0], [0, 0, -1], [0, 1, 0]]";
    let ways = [
        quarter,
        "[0.70710678, 0.70710678, 0.0, 0.0]",
        "{ axis = [1, 0, 0], angle = \"pi/2\" }",
        "{ euler = \"zxz\", angles = [0, \"pi/2\", 0] }",
        "{ from = [0, 1, 0], to = [0, 0, 2] }",
        "[[1, 0, 0], [0, 1e-8, -1], [0, 1, 0]]",
    ];
    for (n, way) in ways.iter().enumerate() {
        let ran = Ran::of(MODEL, &case(way, way, way), &format!("attitudes-{n}"));
        // It stays at rest at its equilibrium attitude.
        for node in [0, 3] {
            let found = [
                ran.at("R_32", node),
                ran.at("R_33", node),
                ran.at("R_11", node),
            ];
            for (x, expected) in found.into_iter().zip([1.0, 0.0, 1.0]) {
                assert!((x - expected).abs() < 2e-8, "{way}: {found:?}");
            }
            assert!((ran.at("R_32", node).hypot(ran.at("R_33", node)) - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn wrong_rotations_are_told_with_what_to_write() {
    let folder = Folder::new("attitudes-wrong");
    let good = "[1, 0, 0, 0]";
    for [wrong, said] in table(
        r#"
        [0.6, 0.7, 0, 0]                      | R0: the quaternion has norm 0.92195444572928
        { axis = [0, 0, 0], angle = 1 }       | R0: axis: a direction must have a non-zero length
        { axis = [0, 0, 1] }                  | R0: missing key `angle` in addition to `axis`
        { axis = [0, 0, 1], angel = 1 }       | R0: unknown key `angel`; did you mean `angle`?
        { euler = "zzx", angles = [0, 0, 0] } | R0: euler: expected three axes
        { from = [0, 0, 1], to = [0, 0, -1] } | R0: the directions are opposite
        [1, 2, 3]                             | R0: expected a 3x3 matrix [[..], [..], [..]], a unit quaternion [w, x, y, z], { axis =
"#,
    ) {
        run(&folder, MODEL, &case(wrong, good, good), "").refuses(format!("parameters.{said}"));
    }
}

/// The sample of such a model is the identity, and its case names the other forms.
#[test]
fn a_printed_case_of_rotations_runs() {
    let folder = Folder::new("attitudes-sample");
    folder.write("drawn.clebsch", MODEL);
    let sample = folder.runs("case @drawn.clebsch");
    for said in [
        "q0 = [\n    [1.0, 0.0, 0.0, 0.0],\n    [0.0, 1.0, 0.0, 0.0],",
        "{ axis, angle }",
        "or give angular_velocity, spatial_angular_velocity",
    ] {
        sample.prints(said);
    }
    folder.write("drawn.toml", &sample.out);
    folder.runs("run @drawn.clebsch --case @drawn.toml --steps 2");
}

/// The clamped end of a rod and its sections, in every form.
#[test]
fn sites_and_ends_have_attitudes_too() {
    let model = "model Sections {
        label i in 0..N step s;
        param J: Sym<3> at segments;
        param B: Sym<3>;
        group R: SO<3> at segments velocity W;
        constraint next(R) = R*W;
        lagrangian = -s*tr(J*W)/h + (h/s)*tr(B*R^T*next(R, i));
        end i = 0 { free; clamped { param Rw: SO<3>; term (2*h/s)*tr(B*Rw^T*R); } }
    }";
    let of = |sections: &str, clamp: &str, name: &str| {
        let case = format!(
            "model = \"sections\"\nh = 0.01\nsteps = 2\n[labels]\ni = 4\n[ends]\ni = [\"clamped\", \"free\"]\n\
             [parameters]\ns = 0.25\nJ = [[0.75, 0, 0], [0, 0.75, 0], [0, 0, 0.25]]\nB = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nRw = {clamp}\n\
             [initial]\nR = {sections}\nangular_velocity_R = [0, \"0.1*i\", 0]\n"
        );
        Ran::of(model, &case, name)
    };
    let tables = of(
        "{ axis = [0, 0, 1], angle = \"0.1*(i + 1/2)\" }",
        "{ axis = [1, 0, 0], angle = 0.2 }",
        "sections-tables",
    );
    let quaternions = of(
        "[\"cos(0.05*(i + 1/2))\", 0, 0, \"sin(0.05*(i + 1/2))\"]",
        "[\"cos(0.1)\", \"sin(0.1)\", 0, 0]",
        "sections-quaternions",
    );
    for i in 0..4_u32 {
        for entry in ["R_I_11", "R_I_32", "body_momentum_R_I_2"] {
            let name = entry.replace('I', &i.to_string());
            for node in [0, 2] {
                let [a, b] = [&tables, &quaternions].map(|ran| ran.at(&name, node));
                assert!((a - b).abs() < 1e-14, "{name}: {a} {b}");
            }
        }
        let turn = 0.1 * (f64::from(i) + 0.5);
        assert!((tables.at(&format!("R_{i}_11"), 0) - turn.cos()).abs() < 1e-15);
        let momentum = 0.25 * 0.1 * f64::from(i);
        assert!((tables.at(&format!("body_momentum_R_{i}_2"), 0) - momentum).abs() < 1e-14);
    }
}

#[test]
fn eight_digits_of_a_quaternion_are_enough() {
    let folder = Folder::new("attitudes-digits");
    let case = "model = \"cayley-klein\"\nh = 0.01\nsteps = 2\n[parameters]\nI = [2, 2, 1]\nc = 1\n\
                [initial]\nq = [0.70710678, -0.70710678, 0, 0]\n";
    folder.write("q.toml", case);
    folder.runs("run cayley-klein --case @q.toml");
}
