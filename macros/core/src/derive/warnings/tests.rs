//! Valid models that probably contain a mistake, and correct variants of them, for which clebsch does not warn.

mod fields;
mod typed;

use super::Topic::{self, *};
use crate::pipeline::derive_source;

fn model(body: &str) -> String {
    format!("model M {{ {body} }}")
}

fn topics(body: &str) -> Vec<Topic> {
    match derive_source(&model(body)) {
        Ok(d) => d.warnings.iter().map(|w| w.topic).collect(),
        Err(e) => panic!("{body}\n{e}"),
    }
}

fn words(body: &str) -> String {
    match derive_source(&model(body)) {
        Ok(d) => {
            let list = d.warnings.iter().map(|w| w.diagnostic.text());
            list.collect::<Vec<_>>().join("\n")
        }
        Err(e) => panic!("{body}\n{e}"),
    }
}

const BODY: &str = "param J: Sym<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; ";
const TOP: &str = "param J: Sym<3>; param gU, z: Vec<3>; group Λ: SO<3> velocity Ω; \
     advected Γ: Vec<3> = Λ^T*z; constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; ";
const POINT: &str = "param J: Sym<3>; param m: Real; group G: SE<3> velocity V; \
     constraint next(G) = G*V; ";

fn body(lagrangian: &str) -> Vec<Topic> {
    topics(&format!("{BODY} lagrangian = {lagrangian};"))
}

fn top(lagrangian: &str) -> Vec<Topic> {
    topics(&format!("{TOP} lagrangian = {lagrangian};"))
}

#[test]
fn sound_models_have_none() {
    assert_eq!(body("-tr(J*Ω)/h"), []);
    assert_eq!(body("tr(J)/h - tr(J*Ω)/h"), []);
    assert_eq!(top("-tr(J*Ω)/h - h*dot(gU, Γ)"), []);
    assert_eq!(top("-tr(J*Ω)/h - h*(dot(gU, Γ) - dot(gU, gU))"), []);
    assert_eq!(top("-(tr(J*Ω)/h + h*dot(gU, Γ))"), []);
}

#[test]
fn a_forgotten_step_is_said() {
    let forgotten = top("-tr(J*Ω) - h*dot(gU, Γ)");
    assert!(
        forgotten.contains(&DegenerateKineticEnergy),
        "{forgotten:?}"
    );
    let text = words(&format!("{TOP} lagrangian = -tr(J*Ω) - h*dot(gU, Γ);"));
    assert!(
        text.contains("did you forget `/h`, or the factor `h`"),
        "{text}"
    );
    // No kinetic energy, and a kinetic energy that vanishes too fast.
    assert!(top("-h*dot(gU, Γ) + h*tr(J*Ω)").contains(&DegenerateKineticEnergy));
    // The wrong power of the step size.
    assert!(body("-tr(J*Ω)/h^2").contains(&NoLimit));
    assert_eq!(top("-tr(J*Ω)/h - dot(gU, Γ)"), [NoLimit]);
}

#[test]
fn no_energy_is_listed_without_kinetic_energy() {
    let d = derive_source(&model(&format!(
        "{TOP} lagrangian = -tr(J*Ω) - h*dot(gU, Γ);"
    )));
    let names: Vec<String> = d.map_or(Vec::new(), |d| {
        d.invariants.iter().map(|v| v.name.clone()).collect()
    });
    assert!(
        !names.is_empty() && !names.contains(&"energy".to_owned()),
        "{names:?}"
    );
}

#[test]
fn degenerate_kinetic_energy_is_told_from_none() {
    // A point mass on a rod has no inertia about the rod.
    let rod = "param a: Vec<3>; param m: Real; group Λ: SO<3> velocity Ω; \
               constraint next(Λ) = Λ*Ω; lagrangian = m/(2*h)*dot((Ω - Id)*a, (Ω - Id)*a);";
    assert_eq!(topics(rod), [DegenerateKineticEnergy]);
    assert!(words(rod).contains("rank 2 of 3"), "{}", words(rod));
    // The translation of a body has no kinetic energy.
    let still =
        format!("{POINT} param e: Vec<3>; lagrangian = -tr(J*rot(V))/h - h*m*dot(e, pos(G));");
    assert_eq!(topics(&still), [DegenerateKineticEnergy]);
    assert!(words(&still).contains("rank 3 of 6"), "{}", words(&still));
    // One of two bodies has no kinetic energy.
    let two = "param J: Sym<3>; group A: SO<3> velocity V; group B: SO<3> velocity W; \
               constraint next(A) = A*V; constraint next(B) = B*W; \
               lagrangian = -tr(J*V)/h - tr(J*W);";
    assert!(topics(two).contains(&DegenerateKineticEnergy));
    // An assumption makes the inertia zero.
    let flat = "param J: Sym<3>; assume J == -J; group Λ: SO<3> velocity Ω; \
                constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h;";
    assert!(topics(flat).contains(&DegenerateKineticEnergy));
}

#[test]
fn the_sign_of_the_kinetic_energy_is_said() {
    assert_eq!(body("tr(J*Ω)/h"), [SignOfKineticEnergy]);
    assert_eq!(top("tr(J*Ω)/h + h*dot(gU, Γ)"), [SignOfKineticEnergy]);
    assert!(words(&format!("{BODY} lagrangian = tr(J*Ω)/h;")).contains("negative"));
    // State the action with a scale.
    assert_eq!(
        topics(&format!("{BODY} scale -h; lagrangian = tr(J*Ω);")),
        []
    );
    assert_eq!(
        topics(&format!("{BODY} scale h; lagrangian = tr(J*Ω);")),
        [SignOfKineticEnergy]
    );
    // One of two velocities has the wrong sign, which makes the form indefinite.
    let mixed = format!(
        "{POINT} let x = pos(G^-1*next(G)); \
        lagrangian = -tr(J*rot(G^-1*next(G)))/h - m*dot(x, x)/(2*h);"
    );
    assert_eq!(topics(&mixed), [SignOfKineticEnergy]);
    let sound = mixed.replace("- m*dot", "+ m*dot");
    assert_eq!(topics(&sound), []);
    // A sign in a parameter is left to the parameter.
    let carried = format!("{BODY} param c: Real; assume c < 0; lagrangian = c*tr(J*Ω)/h;");
    assert_eq!(topics(&carried), []);
    let other = format!("{BODY} param c: Real; assume c == 2; lagrangian = c*tr(J*Ω)/h;");
    assert_eq!(topics(&other), [SignOfKineticEnergy]);
    // Couplings of matrices, vectors and scalars are admitted, since they may be small.
    let coupled = format!(
        "{POINT} param D: Mat<3>; param a, b, c, e: Vec<3>; param p, q: Real; \
        let x = pos(G^-1*next(G)); let w = vee(rot(G^-1*next(G))); \
        lagrangian = -tr(J*rot(G^-1*next(G)))/h + m*dot(x, x)/(2*h) \
        + (dot(w, D*x) + p*dot(c, w)*dot(e, x) + q*dot(a, w)*dot(b, x))/h;"
    );
    assert!(!topics(&coupled).contains(&SignOfKineticEnergy));
    // I > 0, not J > 0.
    let inertia = "param I: Sym<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; \
                   lagrangian = -tr((tr(I)/2*Id - I)*Ω)/h;";
    assert_eq!(topics(inertia), []);
}

#[test]
fn first_order_that_is_not_asked_for_is_said() {
    // A magnetic term at one end of the step, linear in the velocity.
    let plane = |term: &str| {
        format!(
            "{POINT} param f: Real; param a, b: Vec<3>; let X = dot(a, pos(G)); \
             let Y = dot(b, pos(G)); \
             let d = pos(next(G)) - pos(G); \
             lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(d, d)/(2*h) + {term};"
        )
    };
    let sided = topics(&plane("m*f*X*(next(Y) - Y)"));
    assert_eq!(sided, [FirstOrder]);
    assert_eq!(topics(&plane("m*f*(X + next(X))/2*(next(Y) - Y)")), []);
    // A correction with an even power of the step size.
    assert_eq!(
        top("-tr(J*Ω)/h - h*dot(gU, Γ) - h^2*dot(gU, Γ)^2"),
        [FirstOrder]
    );
    // Total differences, even or odd, do not change the scheme.
    for difference in ["dot(gU, next(Γ) - Γ)", "h*dot(gU, next(Γ) - Γ)"] {
        let with = top(&format!("-tr(J*Ω)/h - h*dot(gU, Γ) + {difference}"));
        assert_eq!(with, [ConstantTerm], "{difference}");
    }
    // A requested first-order rule causes no warning, but other first-order terms do.
    for rule in ["incoming", "outgoing"] {
        let rule = |l: &str| topics(&format!("{TOP} node {rule}; lagrangian = {l};"));
        assert_eq!(rule("-tr(J*Ω)/h - h*dot(gU, Γ)"), []);
        assert_eq!(rule("-tr(J*Ω)/h - h*dot(gU, Γ)*dot(z, z)"), []);
        let sided = rule("-tr(J*Ω)/h - h*dot(gU, Γ)*dot(gU, next(Γ))^2");
        assert_eq!(sided, [FirstOrder]);
    }
    // The warning names these terms and no others, with the remainder they leave.
    let pair = |term: &str| {
        words(&format!(
            "param J: Sym<3>; param b, z: Vec<3>; param f: Real; group A: SO<3> velocity u; \
             group B: SO<3> velocity v; constraint next(A) = A*u; constraint next(B) = B*v; \
             lagrangian = -tr(J*u)/h - tr(J*v)/h + dot(z, next(A)*b - A*b)*f {term} \
             - h*f*dot(A*z, B*b);"
        ))
    };
    for (term, said) in [
        (
            "+ f*dot(A*vee(u), B*b)",
            "because of the term f (A_k vee(u_k))·(B_k b), which with its reverse adds up to \
             f (A_k vee(u_k))·(B_k b) + f (A_k u_k vee(u_kᵀ))·(B_k v_k b)\n",
        ),
        (
            "- (f/h)*dot((A*u - A)*z, (v*B - B)*b)",
            "because of the term -f ((A_k u_k - A_k) z)·((v_k B_k - B_k) b)/h\n",
        ),
        (
            "+ f*dot(z, A*b)*dot(z, next(B)*b - B*b)",
            "because of the term f (z·(A_k b)) z·(B_{k+1} b - B_k b), which",
        ),
        (
            "- h^2*f*dot(z, A*b) + f*dot(A*vee(u), B*b)",
            "because of the terms -h² f z·(A_k b) and f (A_k vee(u_k))·(B_k b)\n",
        ),
        // Two terms that are self-adjoint together.
        (
            "+ f*dot(z, A*b)*dot(z, next(B)*b - B*b) - h^2*f*dot(z, B*b) \
             + f*dot(z, next(A)*b)*dot(z, next(B)*b - B*b)",
            "because of the term -h² f z·(B_k b), which",
        ),
    ] {
        let found = pair(term);
        let first = found.lines().find(|l| l.contains("of first order only"));
        let first = first.map(|l| format!("{l}\n")).unwrap_or_default();
        assert!(first.contains(said), "{term}: {found}");
    }
    // A general left factor is symmetric if its matrix is.
    let general = "param C: Mat<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; \
                   lagrangian = -tr(C*Ω)/h;";
    assert_eq!(topics(general), []);
}

#[test]
fn what_has_no_effect_is_said() {
    assert_eq!(
        topics(&format!(
            "{BODY} param a, b: Vec<3>; lagrangian = -tr(J*Ω)/h;"
        )),
        [UnusedParameter, UnusedParameter]
    );
    let assumed = format!("{BODY} param a: Real; assume a > 0; lagrangian = -tr(J*Ω)/h;");
    assert_eq!(topics(&assumed), [UnusedParameter]);
    assert!(words(&assumed).contains("only in assumptions"));
    let hidden = format!("{BODY} param a: Real; let w = a*a; lagrangian = -tr(J*Ω)/h;");
    assert_eq!(topics(&hidden), [UnusedLet]);
    // Used in a scale, or in the definition of an advected quantity.
    let scaled = format!("{BODY} param c: Real; scale c; lagrangian = -c*tr(J*Ω)/h;");
    assert_eq!(topics(&scaled), []);
}

#[test]
fn constant_potentials_are_said() {
    assert_eq!(top("-tr(J*Ω)/h - h*dot(gU, gU)*dot(Γ, Γ)"), [ConstantTerm]);
    // Only the sum is constant.
    let sum = top("-tr(J*Ω)/h - h*dot(gU, gU)*(dot(E1, Γ)^2 + dot(E2, Γ)^2 + dot(E3, Γ)^2)");
    assert_eq!(sum, [ConstantTerm]);
    // One term of several is constant.
    assert_eq!(
        top("-tr(J*Ω)/h - h*dot(gU, Γ) - h*dot(Γ, Γ)"),
        [ConstantTerm]
    );
    assert_eq!(
        top("-tr(J*Ω)/h - h*dot(gU, Γ) + h*tr(Ω*Ω^T)"),
        [ConstantTerm]
    );
    // A constant without any configuration.
    let flat = topics(&format!(
        "{BODY} param m, g, l: Real; lagrangian = -tr(J*Ω)/h - h*m*g*l;"
    ));
    assert_eq!(flat, [ConstantTerm]);
}

#[test]
fn what_the_motion_does_not_depend_on_is_said() {
    let with = |term: &str| {
        topics(&format!(
            "{TOP} param p, q: Real; param n: Vec<3>;
             lagrangian = -(1 + q^2)*tr(J*Ω)/h - h*(1 + dot(n, n))*dot(gU, Γ) {term};"
        ))
    };
    for term in [
        // Constants with a parameter of their own, next to a potential.
        "- h*p",
        "- p/h",
        "- p",
        "+ h*p*dot(n, n)",
        "- h^2*p*dot(gU, z)",
        "- h*exp(p)*sqrt(1 + q^2)",
        // Total differences: a single term, a product, in pairs.
        "+ p*dot(gU, next(Γ) - Γ)",
        "+ p*(dot(n, next(Γ)) - dot(n, Γ))",
        "+ p*dot(n, next(Γ))^3 - p*dot(n, Γ)^3",
        "+ dot(gU, next(Γ))^2 - dot(gU, Γ)^2",
        "+ h*(dot(n, next(Γ))^2 - dot(n, Γ)^2)",
        "+ p*dot(n, (next(Γ) + Γ)/2)*0 + p*(Γ[1] + next(Γ)[1])*(Γ[1] - next(Γ)[1])",
        // Constant because the group preserves it.
        "+ p*dot(Γ, next(Γ) - Ω^T*Γ)",
        "+ h*p*dot(next(Γ), next(Γ))",
    ] {
        let mut found = with(&format!("+ p*0 + 0*q {term}"));
        found.retain(|t| *t != UnusedParameter);
        assert_eq!(found, [ConstantTerm], "{term}");
    }
    for term in [
        "- h*p*dot(gU, Γ)^2",
        "+ p*dot(gU, next(Γ) - Γ)*dot(n, Γ + next(Γ))",
        // A constant that normalises another term.
        "+ h*(1 + dot(n, n))*dot(gU, z) - h*p*dot(n, Γ)",
        "+ (1 + q^2)*tr(J)/h - h*p*dot(n, Γ)",
        "- h*p*(1 - dot(n, Γ))",
    ] {
        let found = with(term);
        assert!(!found.contains(&ConstantTerm), "{term}: {found:?}");
    }
    let text = words(&format!(
        "{TOP} param p: Real; lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ) - h*p;"
    ));
    assert!(text.contains("does not depend on `p`"), "{text}");
    // In space, on every other group, and stated by the configuration.
    let difference = "p*dot(z, pos(next(G)) - pos(G))";
    for update in ["G*V", "V*G"] {
        let found = topics(&format!(
            "param J: Sym<3>; param m, p: Real; param z: Vec<3>; group G: SE<3> velocity V;
             constraint next(G) = {update}; let d = pos(next(G)) - pos(G);
             lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(d, d)/(2*h)
                 - h*dot(z, pos(G)) + {difference};"
        ));
        assert_eq!(found, [ConstantTerm], "{update}");
    }
}

#[test]
fn a_potential_with_a_wrong_power_of_the_step_is_said() {
    let point = |term: &str| {
        topics(&format!(
            "{POINT} param z, w: Vec<3>; let d = pos(next(G)) - pos(G);
             lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*(1 + dot(w, w))*dot(d, d)/(2*h) {term};"
        ))
    };
    assert_eq!(point("- h*dot(z, pos(G))"), []);
    for wrong in [
        "- h^2*dot(z, pos(G))",
        "- h^3*dot(z, pos(G))",
        "- h^3*dot(w, pos(G))",
        "- h^3*dot(w, pos(G)) - h^2*dot(z, pos(G))^2",
        "- h*dot(w, pos(G)) - h^3*dot(z, pos(G))",
    ] {
        let found = point(wrong);
        assert!(found.contains(&NoLimit), "{wrong}: {found:?}");
        assert!(!found.contains(&FirstOrder), "{wrong}: {found:?}");
    }
    // A higher-order correction to an existing potential, and a scaled one.
    assert!(!point("- h*dot(z, pos(G)) - h^3*dot(z, z)*dot(z, pos(G))^2").contains(&NoLimit));
    let scaled = |l: &str| topics(&format!("{TOP} scale -h; lagrangian = {l};"));
    assert_eq!(scaled("tr(J*Ω) + h^2*dot(gU, Γ)"), []);
    assert_eq!(scaled("tr(J*Ω) + h^4*dot(gU, Γ)"), [NoLimit]);
    let text = words(&format!("{TOP} lagrangian = -tr(J*Ω)/h - h^3*dot(gU, Γ);"));
    assert!(text.contains("and this term to `h^3`"), "{text}");
}

#[test]
fn functions_that_are_not_smooth_are_said() {
    assert_eq!(top("-tr(J*Ω)/h - h*abs(dot(gU, Γ))"), [NotSmooth]);
    assert_eq!(
        top("-tr(J*Ω)/h - h*sign(dot(gU, Γ))*dot(gU, Γ)"),
        [NotSmooth]
    );
    assert_eq!(top("-tr(J*Ω)/h - h*abs(dot(gU, gU))*dot(gU, Γ)"), []);
    assert_eq!(top("-tr(J*Ω)/h - h*cos(dot(gU, Γ))"), []);
    let text = words(&format!(
        "{TOP} lagrangian = -tr(J*Ω)/h - h*abs(dot(gU, Γ));"
    ));
    assert!(text.contains("not smooth"), "{text}");
}

#[test]
fn assumptions_that_say_nothing_are_told() {
    let with = |assumption: &str| {
        topics(&format!(
            "{BODY} param m: Real; param a, b: Vec<3>; {assumption} \
             lagrangian = -m*(1 + dot(a, a) + dot(b, b))*tr(J*Ω)/h;"
        ))
    };
    for empty in [
        "assume dot(a, a) >= 0;",
        "assume m*m >= 0;",
        "assume 1 < 2;",
        "assume 1 == 1;",
        "assume tr(J*J) >= 0;",
        "assume 1 + m*m > 0;",
        "assume cross(a, a) == 0;",
        "assume dot(a, b)^2 <= dot(a, a)*dot(b, b);",
        "assume dot(a, a) >= -1;",
        "assume exp(m) > 0;",
        "assume 1/cosh(m) > 0;",
        "assume tanh(m) < 1;",
        "assume exp(-dot(a, a)) <= 1;",
        "assume sin(m) <= 1;",
        "assume abs(m) >= 0;",
        "assume sqrt(1 + m^2) >= 1;",
    ] {
        assert_eq!(with(empty), [Assumption], "{empty}");
    }
    for impossible in [
        "assume 1 == 2;",
        "assume 2 < 1;",
        "assume dot(a, a) < 0;",
        "assume dot(a, a) == -1;",
        "assume exp(m) <= 0;",
        "assume exp(m) == 0;",
        "assume sin(m) > 1;",
        "assume m > 0; assume exp(m) < 0;",
        "assume dot(a, b)^2 > dot(a, a)*dot(b, b);",
        "assume m > 0; assume m < 0;",
        "assume m > 2; assume dot(a, a) == 1; assume m*dot(a, a) < 1;",
    ] {
        assert_eq!(with(impossible), [Assumption], "{impossible}");
    }
    for sound in [
        "assume m > 0;",
        "assume m > 1000;",
        "assume m < 0.001; assume m > 0;",
        "assume dot(a, a) == 1;",
        "assume dot(a, a) > 0;",
        "assume cross(a, E3) == 0;",
        "assume J*hat(E3) == hat(E3)*J; assume cross(a, E3) == 0;",
        "assume dot(a, a) == 1; assume dot(b, b) == 1; assume dot(a, b) == 0;",
        "assume m*m > 4; assume m > 0;",
        "assume det(J) > 0;",
        "assume dot(a, b)^2 < 0.999*dot(a, a)*dot(b, b);",
        "assume tr(J) == 1;",
        "assume exp(m) > 1;",
        "assume abs(m) > 0;",
        "assume log(1 + m^2) > 0;",
    ] {
        let found = with(sound);
        assert!(!found.contains(&Assumption), "{sound}: {found:?}");
    }
}

/// The shipped texts: the gallery, and the models in the pages about the language.
fn shipped() -> Vec<(String, String)> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let files = std::fs::read_dir(format!("{root}/models/src")).map_or(Vec::new(), |list| {
        let paths = list.filter_map(|entry| Some(entry.ok()?.path()));
        paths.collect::<Vec<_>>()
    });
    let mut all: Vec<(String, String)> = files
        .iter()
        .filter_map(|path| {
            Some((
                path.display().to_string(),
                std::fs::read_to_string(path).ok()?,
            ))
        })
        .filter(|(_, text)| text.contains("clebsch::model! {"))
        .collect();
    for page in ["language.md", "limits.md", "tutorial.md"] {
        let text = std::fs::read_to_string(format!("{root}/docs/{page}")).unwrap_or_default();
        let blocks = text.split("```clebsch\n").skip(1);
        all.extend(
            blocks.filter_map(|b| Some((page.to_owned(), b.split("```").next()?.to_owned()))),
        );
    }
    all.sort();
    all
}

#[test]
fn what_ships_has_no_warnings() {
    let shipped = shipped();
    assert!(shipped.len() > 18, "{}", shipped.len());
    for (name, text) in shipped {
        match derive_source(&text) {
            Ok(d) => {
                let found: Vec<String> = d.warnings.iter().map(|w| w.diagnostic.text()).collect();
                assert!(found.is_empty(), "{name}: {found:?}\n{text}");
            }
            Err(e) => panic!("{name}\n{e}"),
        }
    }
}

#[test]
fn warnings_are_printed_in_every_form() {
    let source = model(&format!(
        "{TOP} param spare: Real; lagrangian = -tr(J*Ω) - h*dot(gU, Γ);"
    ));
    let d = match derive_source(&source) {
        Ok(d) => d,
        Err(e) => panic!("{e}"),
    };
    use crate::print::Format;
    for format in [
        Format::Text,
        Format::Latex,
        Format::Markdown,
        Format::MathMl,
        Format::Json,
    ] {
        let printed = crate::document::printed(&d, format);
        for words in ["Warnings", "is never used", "did you forget"] {
            let found = printed.to_lowercase().contains(&words.to_lowercase());
            assert!(found, "{format:?}: {words}\n{printed}");
        }
    }
    let json = crate::document::printed(&d, Format::Json);
    for entry in [
        "\"warnings\": [",
        "\"topic\": \"unused-parameter\"",
        "\"line\": ",
        "\"column\": ",
    ] {
        assert!(json.contains(entry), "{entry}");
    }
}
