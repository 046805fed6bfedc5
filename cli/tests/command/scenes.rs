//! The page of a run: positions of bodies, links of constraints, the ground, the colours of particles. If Node
//! is installed, its script also draws them, on a canvas that writes SVG.

use crate::common::{Folder, runs};
use serde_json::Value;
use std::process::Command;

/// The data of the page of a shipped model after some steps.
fn of_shipped(folder: &Folder, model: &str, steps: &str) -> Value {
    let out = folder.path("out");
    let all = ["run", model, "--steps", steps, "--out", &out];
    runs(&[all.as_slice(), &["--stability-limit", "0"]].concat());
    data(&read(folder))
}

/// The page of a run of a model and a case, without a name for the sample.
fn page(folder: &Folder, model: &str, case: &str) -> String {
    let model = folder.write("own.clebsch", model);
    let out = folder.path("out");
    let mut all = vec!["run", &model, "--out", &out, "--stability-limit", "0"];
    let path;
    match case {
        "" => all.extend(["--case", "sample", "--steps", "40"]),
        case => {
            path = folder.write("case.toml", case);
            all.extend(["--case", &path]);
        }
    }
    runs(&all);
    read(folder)
}

fn read(folder: &Folder) -> String {
    folder.read("out/run.html")
}

/// The data of its view.
fn data(page: &str) -> Value {
    let from = page.split_once("id=\"scene\">").expect("a scene").1;
    let text = from.split_once("</script>").expect("its end").0;
    serde_json::from_str(text).expect("JSON")
}

fn numbers(v: &Value) -> Vec<f64> {
    let list = v.as_array().expect("a list").iter();
    list.map(|x| x.as_f64().expect("a number")).collect()
}

/// The positions in every frame of the body, or of the point, with this name.
fn places(scene: &Value, kind: &str, name: &str) -> Vec<Vec<f64>> {
    let all = scene[kind].as_array().expect("a list").iter();
    let mut own = all.filter(|b| b["name"] == name);
    let own = own.next().unwrap_or_else(|| panic!("{name}"));
    let frames = if kind == "bodies" { "places" } else { "frames" };
    own[frames]
        .as_array()
        .expect("frames")
        .iter()
        .map(numbers)
        .collect()
}

/// A model of free bodies with a potential.
fn bodies(fields: &str, attitudes: &[&str], potential: &str) -> String {
    let group =
        |a: &&str| format!("group {a}: SO<3> velocity V{a}; constraint next({a}) = {a}*V{a};");
    let groups: String = attitudes.iter().map(group).collect();
    let turning: String = attitudes
        .iter()
        .map(|a| format!(" - tr(J*V{a})/h"))
        .collect();
    let moving = fields
        .split(", ")
        .map(|x| format!(" + dot(next({x}) - {x}, next({x}) - {x})/(2*h)"));
    let moving: String = moving.collect();
    format!(
        "model Own {{ param J: Sym<3>; param k: Real; param p, s: Vec<3>; field {fields}: Vec<3>; {groups}
         lagrangian = 0{turning}{moving} - h*k*({potential}); }}"
    )
}

#[test]
fn a_body_is_shown_at_its_place() {
    for (name, model, pairs) in [
        // One position and one attitude.
        (
            "satellite",
            bodies("x", &["A"], "dot(x, A*J*A^T*x) + dot(x, x)"),
            vec![("A", "x")],
        ),
        // The sums that contain them decide, for any order of the declarations.
        (
            "arms",
            bodies(
                "y, x",
                &["A", "B"],
                "dot(x + A*p - y - B*s, x + A*p - y - B*s)",
            ),
            vec![("A", "x"), ("B", "y")],
        ),
        // By the numbers in their names.
        (
            "numbers",
            bodies(
                "x2, x1",
                &["A1", "A2"],
                "dot(x1 - x2, x1 - x2) + tr(A1^T*A2)",
            ),
            vec![("A1", "x1"), ("A2", "x2")],
        ),
    ] {
        let folder = Folder::new(&format!("scene-{name}"));
        let page = page(&folder, &model, "");
        let scene = data(&page);
        for (body, place) in pairs {
            let (own, point) = (
                places(&scene, "bodies", body),
                places(&scene, "chains", place),
            );
            assert!(own.len() > 10, "{name}");
            assert_eq!(own, point, "{name}: {body}");
            assert!(page.contains(&format!("{body} at {place}")), "{name}");
        }
    }
}

#[test]
fn a_body_without_a_place_is_beside_the_others() {
    // `x - A*p` compares a point with a point of a body about the origin. The position of B remains unknown.
    let folder = Folder::new("scene-beside");
    let model = bodies("x", &["A", "B"], "dot(x - A*p, x - A*p) + dot(A*p, B*s)");
    let page = page(&folder, &model, "");
    let scene = data(&page);
    assert!(places(&scene, "bodies", "A").iter().all(|p| *p == [0.0; 3]));
    assert!(page.contains("A about the origin"));
    assert!(page.contains("B has no position in the model and is drawn next to the others."));
    let arm = scene["arm"].as_f64().expect("a length");
    let [b, x] = [("bodies", "B"), ("chains", "x")].map(|(kind, name)| places(&scene, kind, name));
    let apart = |p: &[f64], q: &[f64]| {
        let sum: f64 = p.iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum();
        sum.sqrt()
    };
    for (b, x) in b.iter().zip(&x) {
        assert!(
            apart(b, x) > 2.0 * arm && apart(b, &[0.0; 3]) > 2.0 * arm,
            "{b:?} {x:?}"
        );
    }
    // A relative attitude is not a body.
    let folder = Folder::new("scene-seen-from");
    let out = folder.path("out");
    runs(&format!("run coupled-bodies --steps 40 --out {out}"));
    let scene = data(&read(&folder));
    assert_eq!(scene["bodies"].as_array().map(Vec::len), Some(2));
}

#[test]
fn bodies_in_the_plane_are_shown() {
    let folder = Folder::new("scene-plane");
    let model = "model Flat { param J: Sym<2>; param m, k: Real; field x: Vec<2>; group A: SO<2> velocity W;
         constraint next(A) = A*W;
         lagrangian = -tr(J*W)/h + m*dot(next(x) - x, next(x) - x)/(2*h) - h*k*dot(x + A*E1, x + A*E1)/2; }";
    let scene = data(&page(&folder, model, ""));
    assert_eq!(scene["flat"], true);
    let turn = numbers(&scene["bodies"][0]["turns"][3]);
    assert!((turn[0] * turn[0] + turn[3] * turn[3] - 1.0).abs() < 1e-12 && turn[8] == 1.0);
    let point = places(&scene, "chains", "x").remove(3);
    assert_eq!(places(&scene, "bodies", "A").remove(3)[..2], point[..]);
}

const DOUBLE: &str = "model Double { param m, l, g: Real; field x, y: Vec<2>;
     hold p: dot(x, x) = l^2; hold q: dot(y - x, y - x) = l^2;
     lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) - h*g*m*(x[2] + y[2]); }";

const SWUNG: &str = "model = \"double\"\nname = \"swung\"\ndoc = \"\"\nh = 0.02\nsteps = 60\n[parameters]\nm = 1.0\nl = 1.0\ng = 9.81\n\
     [initial]\nx = [1.0, 0.0]\ny = [2.0, 0.0]\nmomentum_x = [0.0, 0.0]\nmomentum_y = [0.0, 0.0]\n";

#[test]
fn what_a_constraint_joins_is_linked() {
    let folder = Folder::new("scene-double");
    let scene = data(&page(&folder, DOUBLE, SWUNG));
    let links = scene["links"].as_array().expect("links");
    assert_eq!(links.len(), 2);
    let (x, y) = (places(&scene, "chains", "x"), places(&scene, "chains", "y"));
    for (f, (x, y)) in x.iter().zip(&y).enumerate() {
        assert_eq!(numbers(&links[0][f]), [x[0], x[1], 0.0, 0.0, 0.0, 0.0]);
        let ends = numbers(&links[1][f]);
        assert!(ends == [y[0], y[1], 0.0, x[0], x[1], 0.0], "{ends:?}");
    }
    // The fixed point is drawn as ground.
    assert_eq!(scene["supports"].to_string(), "[[0.0,0.0,0.0]]");
}

#[test]
fn a_joint_is_linked_over_its_point() {
    // Two bars: the first is suspended at P, and both are constrained by components.
    let folder = Folder::new("scene-bars");
    let model =
        "model Bars { param m, K, g: Real; param P: Vec<2>; field x, y: Vec<2>; field a, b: Real;
         let u = cos(a)*E1 + sin(a)*E2; let v = cos(b)*E1 + sin(b)*E2;
         hold A: x - u = P; hold B: x + u = y - v;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h)
         + K*(next(a) - a)^2/(2*h) + K*(next(b) - b)^2/(2*h) - h*g*m*(x[2] + y[2]); }";
    let case = "model = \"bars\"\nname = \"hung\"\ndoc = \"\"\nh = 0.02\nsteps = 30\n[parameters]\nm = 1.0\nK = 0.3\ng = 9.81\n\
         P = [0.5, 2.0]\n[initial]\nx = [1.5, 2.0]\ny = [3.5, 2.0]\na = 0.0\nb = 0.0\nmomentum_x = [0.0, 0.0]\n\
         momentum_y = [0.0, 0.0]\nmomentum_a = 0.0\nmomentum_b = 0.0\n";
    let scene = data(&page(&folder, model, case));
    let links = scene["links"].as_array().expect("links");
    assert_eq!(links.len(), 2);
    assert_eq!(scene["supports"].to_string(), "[[0.5,2.0,0.0]]");
    let path = numbers(&links[1][7]);
    assert_eq!(path.len(), 9, "x, the joint, y: {path:?}");
    let length = |i: usize| (path[i] - path[i + 3]).hypot(path[i + 1] - path[i + 4]);
    assert!(
        (length(0) - 1.0).abs() < 1e-9 && (length(3) - 1.0).abs() < 1e-9,
        "{path:?}"
    );
    let folder = Folder::new("scene-components");
    let model = "model Ring { param m, l, g: Real; field x: Vec<2>; hold p: x[1]^2 + x[2]^2 = l^2;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*g*m*x[2]; }";
    let case = "model = \"ring\"\nname = \"swung\"\ndoc = \"\"\nh = 0.02\nsteps = 30\n[parameters]\nm = 1.0\nl = 1.0\ng = 9.81\n\
         [initial]\nx = [1.0, 0.0]\nmomentum = [0.0, 0.0]\n";
    let scene = data(&page(&folder, model, case));
    assert_eq!(scene["supports"].to_string(), "[[0.0,0.0,0.0]]");
}

#[test]
fn a_plane_that_holds_a_point_is_no_link() {
    let folder = Folder::new("scene-on-a-plane");
    let model = "model Orbit { param m, k: Real; field x: Vec<3>; hold p: x[3] = 0;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*k*dot(x, x)/2; }";
    // One full circle.
    let case = "model = \"orbit\"\nname = \"circle\"\ndoc = \"\"\nh = 0.02\nsteps = 300\n[parameters]\nm = 1.0\nk = 1.0\n\
         [initial]\nx = [1.0, 0.0, 0.0]\nmomentum = [0.0, 1.0, 0.0]\n";
    let scene = data(&page(&folder, model, case));
    assert_eq!(scene["links"].as_array().map(Vec::len), Some(0));
    assert_eq!(scene["supports"].as_array().map(Vec::len), Some(0));
}

#[test]
fn ends_that_are_held_are_shown_on_the_ground() {
    let folder = Folder::new("scene-ends");
    folder.runs("run hanging-chain --steps 20 --out @out");
    let scene = data(&read(&folder));
    let supports = scene["supports"].as_array().expect("a list");
    assert_eq!(supports.len(), 1);
    let chain = numbers(&scene["chains"][0]["frames"][5]);
    assert_eq!(
        chain[..3],
        numbers(&supports[0])[..],
        "the line begins where it is held"
    );
}

#[test]
fn particles_have_colours_with_a_scale() {
    for (name, model) in [
        ("grid", "particle-mesh-2d:bump"),
        ("cells", "shallow-water-2d-regularised:geostrophic-vortex"),
    ] {
        let folder = Folder::new(&format!("scene-particles-{name}"));
        let scene = of_shipped(&folder, model, "4");
        let tints = &scene["chains"][0]["tints"];
        let values = numbers(&tints["frames"][2]);
        let count = numbers(&scene["chains"][0]["frames"][2]).len() / 2;
        assert_eq!(values.len(), count, "{name}");
        let [low, high] = ["low", "high"].map(|k| tints[k].as_f64().expect("a number"));
        assert!(
            low < high && values.iter().all(|v| (low..=high).contains(v)),
            "{name}"
        );
        // The picture names the coloured quantity, above the scale and in its title.
        let svg = folder.read("out/particles.svg");
        let (title, above) = match name {
            "grid" => ("S = smooth(H, alpha)", "\nS\n"),
            _ => ("phi = helmholtz_depth(X, m, alpha)", "\nphi\n"),
        };
        assert!(svg.contains(title) && svg.contains(above), "{name}");
        assert!(svg.contains("X₁") && svg.contains("X₂"), "{name}");
    }
}

#[test]
fn particles_on_a_line_are_at_the_height_of_their_depth() {
    let folder = Folder::new("scene-line-of-particles");
    let scene = of_shipped(&folder, "particle-mesh-1d", "4");
    let chain = &scene["chains"][0];
    assert_eq!(
        (&chain["dim"], &chain["profile"]),
        (&1.into(), &false.into())
    );
    let counts = [&chain["frames"][2], &chain["tints"]["frames"][2]].map(|v| numbers(v).len());
    assert!(counts[0] > 1 && counts[0] == counts[1], "{counts:?}");
    if let Some(svg) = drawn(&folder, "2") {
        let dots = svg.matches("a2.").count().max(svg.matches("a3.").count());
        assert!(
            dots >= counts[0] && svg.contains(">S</text>") && !svg.contains("NaN"),
            "{svg:.3000}"
        );
    }
}

#[test]
fn many_bodies_without_places_stand_in_rows() {
    let folder = Folder::new("scene-rows");
    let scene = of_shipped(&folder, "uniform-tension-rod:closed", "2");
    let all = scene["bodies"].as_array().expect("bodies").iter();
    let mut places: Vec<Vec<f64>> = all.map(|b| numbers(&b["places"][0])).collect();
    let within = places.iter().all(|p| p[0] < 40.0);
    let hangs = places.iter().any(|p| p[2] < 0.0);
    assert!(places.len() > 20 && hangs && within, "{places:?}");
    let count = places.len();
    places.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    places.dedup();
    assert_eq!(places.len(), count);
}

/// A frame of a page as its script draws it; `None` without Node.
fn drawn(folder: &Folder, frame: &str) -> Option<String> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/command/canvas.js");
    let page = folder.path("out/run.html");
    let done = Command::new("node")
        .args([script, &page, frame])
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}");
    Some(String::from_utf8_lossy(&done.stdout).into_owned())
}

#[test]
fn the_view_has_names_ground_and_smooth_trails() {
    let folder = Folder::new("scene-drawn");
    page(&folder, DOUBLE, SWUNG);
    let Some(svg) = drawn(&folder, "40") else {
        return;
    };
    assert!(
        svg.contains(">x</text>") && svg.contains(">y</text>"),
        "{svg}"
    );
    // The ground is one path of five lines.
    let paths: Vec<&str> = svg.split("<path d=\"").skip(1).collect();
    let lines = |p: &&str| p.split('"').next().unwrap_or_default().matches('L').count();
    assert!(
        paths
            .iter()
            .any(|p| lines(p) == 5 && p.matches('M').count() == 5),
        "{svg}"
    );
    // If a point moves far between two frames, its trail has additional points.
    assert!(
        paths
            .iter()
            .any(|p| lines(p) > 1 && p.matches('M').count() == 1),
        "{svg}"
    );
    assert!(!svg.contains("NaN"), "{svg}");
}

#[test]
fn what_is_farther_is_paler() {
    let folder = Folder::new("scene-depth");
    page(
        &folder,
        &bodies("x", &["A"], "dot(x, A*J*A^T*x) + dot(x, x)"),
        "",
    );
    let Some(svg) = drawn(&folder, "20") else {
        return;
    };
    // Three axes, each in shades of its own colour.
    let inks: std::collections::HashSet<&str> = svg
        .split("stroke=\"")
        .skip(1)
        .filter_map(|s| s.split('"').next())
        .collect();
    assert!(!inks.contains("rgb(213,94,0)"), "{inks:?}");
    assert!(inks.len() > 5, "{inks:?}");
}
