//! Pictures of attitudes, and pictures for a paper.

use crate::common::{Folder, has, on};
use clebsch_cli::gallery::Gallery;
use std::fs;

fn picture(folder: &Folder, name: &str, arguments: &[&str]) -> impl Fn(&str) -> String + use<> {
    let out = folder.path(name);
    let mut all = vec!["run"];
    all.extend(arguments);
    all.extend(["--out", &out]);
    on(&Gallery::shipped(), &all).succeeds();
    move |file: &str| fs::read_to_string(format!("{out}/{file}")).unwrap_or_default()
}

#[test]
fn attitudes_are_drawn_on_spheres() {
    let folder = Folder::new("spheres");
    let top = picture(&folder, "top", &["heavy-top", "--steps", "500"]);
    let svg = top("attitude.svg");
    has(
        &svg,
        ["Λ e₃: the body axis", "Γ on |Γ| = 1", "μ in the ball |μ| ≤"],
    );
    assert!(
        !svg.contains("kinetic"),
        "a momentum that changes its length has no sphere"
    );
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let free = picture(&folder, "free", &["free-body", "--steps", "500"]);
    assert!(free("attitude.svg").contains("equal kinetic"));
    // Unit quaternions are attitudes too; a point mass has none.
    let quaternions = picture(&folder, "quaternions", &["cayley-klein", "--steps", "500"]);
    assert!(quaternions("attitude.svg").contains("body axis"));
    let planet = picture(&folder, "planet", &["kepler", "--steps", "500"]);
    assert!(planet("attitude.svg").is_empty() && planet("angles.svg").is_empty());
    let angles = top("angles.svg");
    has(&angles, ["precession", "nutation", "spin"]);
}

#[test]
fn pictures_for_a_paper_fit_a_column() {
    let folder = Folder::new("paper");
    let wide = picture(&folder, "wide", &["heavy-top", "--steps", "500"]);
    let paper = picture(
        &folder,
        "column",
        &["heavy-top", "--steps", "500", "--paper"],
    );
    let pictures = ["momentum", "invariants", "advected", "attitude", "angles"];
    for file in pictures.map(|name| format!("{name}.svg")) {
        assert!(wide(&file).contains("heavy-top, case lagrange"), "{file}");
        let svg = paper(&file);
        assert!(
            svg.starts_with("<svg width=\"86mm\" height=\""),
            "{file}: {:.60}",
            svg
        );
        assert!(!svg.contains("heavy-top, case"), "{file} has a title");
    }
    // The numbers are the same.
    let read =
        |name: &str| fs::read(folder.path(&format!("{name}/trajectory.csv"))).expect("there");
    assert!(read("wide") == read("column"));
}

/// With `cargo test -p clebsch-cli --features pdf`.
#[cfg(feature = "pdf")]
#[test]
fn pictures_for_a_paper_are_there_as_pdf() {
    let folder = Folder::new("pdf");
    picture(&folder, "top", &["heavy-top", "--steps", "500", "--paper"]);
    for name in ["momentum", "invariants", "advected", "attitude", "angles"] {
        let pdf = fs::read(folder.path(&format!("top/{name}.pdf"))).expect("written");
        assert!(pdf.starts_with(b"%PDF-"), "{name}");
        // 86 mm in points of 1/72 inch, to the pixel of 1/96 inch that the page is rounded to.
        let text = String::from_utf8_lossy(&pdf).into_owned();
        let page = text.split("/MediaBox [0 0 ").nth(1).expect("a page");
        let width: f64 = page
            .split(' ')
            .next()
            .expect("a width")
            .parse()
            .expect("a number");
        assert!((width - 86.0 / 25.4 * 72.0).abs() < 0.75, "{name}: {width}");
        // Text is present, because fonts are embedded.
        assert!(
            text.contains("/FontDescriptor") || text.contains("/Type0"),
            "{name} has no text"
        );
    }
    let json = folder.read("top/run.json");
    assert!(json.contains("attitude.pdf"));
}

#[test]
fn entries_of_skew_matrices_are_drawn_once() {
    let folder = Folder::new("skew");
    let svg = picture(&folder, "body", &["body-n", "--steps", "500"])("momentum.svg");
    assert!(svg.contains("μ₁₂") && svg.contains("entries above the diagonal"));
    assert!(!svg.contains("μ₂₁") && !svg.contains("μ₁₁"));
}

/// If the energy is only bounded, its change divided by the power of the step size with the order of the scheme is
/// drawn below the drifts.
#[test]
fn changes_of_what_is_bounded_are_drawn_with_their_sign() {
    let folder = Folder::new("changes");
    let drawn =
        |name: &str, arguments: &[&str]| picture(&folder, name, arguments)("invariants.svg");
    let top = ["heavy-top", "--steps", "200"];
    let plain = drawn("plain", &top);
    assert!(plain.contains("energy: change since time 0, over h²"));
    assert!(!plain.contains("Gamma_squared: change"));
    let fourth = drawn("fourth", &[&top[..], &["--order", "4"]].concat());
    assert!(fourth.contains("energy: change since time 0, over h⁴"));
    let free = drawn("free", &["free-body", "--steps", "200"]);
    assert!(!free.contains("change since time 0"));
}

/// Elements of GL(n) are drawn like matrix fields, with the ratio of volumes; rotations are not.
#[test]
fn elements_of_the_linear_group_have_their_determinant() {
    let folder = Folder::new("volumes");
    let ellipsoid = picture(
        &folder,
        "ellipsoid",
        &["ellipsoid-convective", "--steps", "100"],
    );
    for words in ["Q₁₁", "det Q: the ratio of volumes"] {
        assert!(ellipsoid("fields.svg").contains(words), "{words}");
    }
    let body = picture(&folder, "body", &["body-n", "--dim", "4", "--steps", "100"]);
    assert!(body("fields.svg").is_empty());
}

/// Precession and spin are drawn only if they describe the motion, not for a body that passes through the vertical
/// repeatedly.
#[test]
fn euler_angles_are_drawn_where_they_mean_something() {
    let folder = Folder::new("angles");
    let run = |name: &str, arguments: &[&str]| picture(&folder, name, arguments)("angles.svg");
    let free = run(
        "upright",
        &["free-body", "--case", "figure-2-5", "--steps", "2000"],
    );
    assert!(free.contains("φ + ψ") && free.contains("θ nutation") && !free.contains("precession"));
    let tumbling = run("tumbling", &["body-in-two-fields", "--steps", "2000"]);
    assert!(tumbling.is_empty());
    let top = run(
        "top",
        &["heavy-top", "--case", "lagrange", "--steps", "2000"],
    );
    assert!(top.contains("φ precession") && top.contains("ψ spin"));
}

/// A field without a documentation comment has only its name above its panel; a field with a comment has both.
#[test]
fn panels_of_fields_are_named_as_the_model_documents_them() {
    let folder = Folder::new("panels-of-fields");
    let model = "model Two {
        param m: Real;
        field y: Vec<2>;
        /// height of the lid
        field z: Real;
        lagrangian = m*dot(next(y) - y, next(y) - y)/(2*h) + m*(next(z) - z)^2/(2*h) - h*dot(y, y)/2;
    }";
    let case = "model = \"two\"\nh = 0.05\nsteps = 30\n[parameters]\nm = 1.0\n[initial]\ny = [1.0, 0.0]\nmomentum_y = [0.0, 0.5]\n\
                z = 0.0\nmomentum_z = 1.0\n";
    crate::text_runs::run(&folder, model, case, "--out @out").succeeds();
    let svg = folder.read("out/fields.svg");
    let lines: Vec<&str> = svg.lines().map(str::trim).collect();
    assert!(lines.contains(&"y") && lines.contains(&"z: height of the lid"));
    assert!(!svg.contains("y: "));
}
