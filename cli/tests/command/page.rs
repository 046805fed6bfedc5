//! The page of a run: one self-contained file, with data that its view reads. That it draws is tested in a browser by
//! `cli/tests/browser.sh`.

use crate::common::{Folder, rotor};

/// The text between the tags of the element with this identity.
fn data(page: &str) -> serde_json::Value {
    let from = page.split_once("id=\"scene\">").expect("a scene").1;
    let text = from.split_once("</script>").expect("its end").0;
    serde_json::from_str(text).expect("JSON")
}

fn page(folder: &Folder, arguments: &[&str]) -> String {
    let out = folder.path("out");
    let all = [&["run"], arguments, &["--out", &out]].concat();
    rotor(&all).succeeds();
    folder.read("out/run.html")
}

#[test]
fn a_body_is_shown_by_its_axes() {
    let folder = Folder::new("page-body");
    let page = page(&folder, &["harmonic-rotor", "--steps", "5000"]);
    let scene = data(&page);
    let times = scene["times"].as_array().expect("times").len();
    assert!((2..=600).contains(&times), "{times}");
    let body = &scene["bodies"][0];
    assert_eq!(body["turns"].as_array().map(Vec::len), Some(times));
    // Row by row: rows of a rotation are unit vectors.
    let entry = |i: usize| body["turns"][1][i].as_f64().expect("a number");
    let square: f64 = (0..3).map(|i| entry(i) * entry(i)).sum();
    assert!((square - 1.0).abs() < 1e-12, "{square}");
    assert!((entry(0) * entry(3) + entry(1) * entry(4) + entry(2) * entry(5)).abs() < 1e-12);
    // For fast motions the page shows only a part, and states its length.
    assert!(
        page.contains("The view shows the run up to time "),
        "{page:.3000}"
    );
    // Nothing is fetched: the only addresses are names of formats.
    let fetched =
        page.matches("src=").count() + page.matches("href=").count() + page.matches("url(").count();
    assert_eq!(fetched, 0);
    assert!(
        page.contains("<td>energy</td>") && page.contains("<svg"),
        "{page}"
    );
}

#[test]
fn points_on_a_line_are_a_chain_and_numbers_a_profile() {
    let folder = Folder::new("page-chain");
    let model = folder.write(
        "string.clebsch",
        "model String { label i in 0..N; param m, c: Real; field q: Vec<3> at nodes; field u: Real at nodes;
         lagrangian = m*dot(next(q) - q, next(q) - q)/(2*h) + m*(next(u) - u)^2/(2*h)
         - h*c*dot(next(q, i) - q, next(q, i) - q)/2 - h*c*(next(u, i) - u)^2/2; }",
    );
    let page = page(&folder, &[&model, "--case", "sample", "--steps", "20"]);
    let scene = data(&page);
    let chains = scene["chains"].as_array().expect("chains");
    assert_eq!(chains.len(), 2);
    assert_eq!(
        (&chains[0]["dim"], &chains[0]["line"]),
        (&3.into(), &true.into())
    );
    assert_eq!(
        (&chains[1]["profile"], &scene["flat"]),
        (&true.into(), &false.into())
    );
    assert_eq!(chains[0]["frames"][0].as_array().map(Vec::len), Some(3 * 9));
}

/// Bodies at segments, or at nodes, of a line of points.
fn rod(statements: &str, bodies: &str) -> String {
    format!(
        "model Rod {{ label i in 0..N; {statements} param m, c: Real; param J: Sym<3>;
         field x: Vec<3> at nodes; group A: SO<3> at {bodies} velocity W; constraint next(A) = A*W;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - tr(J*W)/h
         - h*c*dot(next(x, i) - x - A*E1, next(x, i) - x - A*E1)/2; }}"
    )
}

/// The first frame: the positions of bodies and of points, three numbers each.
fn first(scene: &serde_json::Value) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let numbers = |v: &serde_json::Value| -> Vec<f64> {
        let list = v.as_array().expect("a list").iter();
        list.map(|x| x.as_f64().expect("a number")).collect()
    };
    let bodies = scene["bodies"].as_array().expect("bodies").iter();
    let points = numbers(&scene["chains"][0]["frames"][0]);
    (
        bodies.map(|b| numbers(&b["places"][0])).collect(),
        points.chunks(3).map(<[f64]>::to_vec).collect(),
    )
}

fn midway(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| (x + y) / 2.0).collect()
}

#[test]
fn a_body_of_a_segment_is_midway_between_its_nodes() {
    for (name, statements, held) in [
        ("free", "", 0),
        ("first", "end i = 0 { pinned { x = given; } }", 1),
        ("last", "end i = N { pinned { x = given; } }", 2),
        ("ring", "periodic;", 3),
    ] {
        let folder = Folder::new(&format!("page-rod-{name}"));
        let model = folder.write("rod.clebsch", rod(statements, "segments"));
        let page = page(&folder, &[&model, "--case", "sample", "--steps", "5"]);
        let (bodies, points) = first(&data(&page));
        let run = folder.json("out/run.json");
        let given = |name: String| -> Vec<f64> {
            let value = run["parameters"][&name].as_array();
            let value = value.unwrap_or_else(|| panic!("{name}: {run}")).iter();
            value.map(|x| x.as_f64().expect("a number")).collect()
        };
        // A line is drawn to the prescribed ends, and closed for a ring.
        let last = points.len() - 1;
        match held {
            1 => assert_eq!(points[0], given("x_0".to_owned())),
            2 => assert_eq!(points[last], given(format!("x_{last}"))),
            3 => assert_eq!(points[last], points[0]),
            _ => {}
        }
        assert_eq!(points.len(), bodies.len() + 1, "{name}");
        for (i, body) in bodies.iter().enumerate() {
            assert_eq!(*body, midway(&points[i], &points[i + 1]), "{name} {i}");
        }
    }
}

#[test]
fn a_body_of_a_node_is_at_its_point_and_others_stand_in_one_row() {
    let folder = Folder::new("page-nodes");
    let ends = "end i = 0 { pinned { x = given; } }";
    let model = folder.write("rod.clebsch", rod(ends, "nodes"));
    let (bodies, points) = first(&data(&page(
        &folder,
        &[&model, "--case", "sample", "--steps", "5"],
    )));
    assert_eq!(bodies, points);
    let folder = Folder::new("page-two-groups");
    let model = folder.write(
        "tops.clebsch",
        "model Tops { label i in 0..N; param J: Sym<3>; param c: Real;
         group A: SO<3> at nodes velocity V; group B: SO<3> at nodes velocity W;
         constraint next(A) = A*V; constraint next(B) = B*W;
         lagrangian = -tr(J*V)/h - tr(J*W)/h + h*c*tr(A^T*B) + h*c*tr(A^T*next(A, i)); }",
    );
    let scene = data(&page(
        &folder,
        &[&model, "--case", "sample", "--steps", "5"],
    ));
    let mut places: Vec<String> = scene["bodies"]
        .as_array()
        .expect("bodies")
        .iter()
        .map(|b| b["places"][0].to_string())
        .collect();
    let count = places.len();
    places.sort();
    places.dedup();
    assert_eq!(places.len(), count);
}

#[test]
fn the_end_of_a_run_is_shown() {
    let folder = Folder::new("page-end");
    let scene = data(&page(&folder, &["harmonic-rotor", "--steps", "1999"]));
    let times = scene["times"].as_array().expect("times");
    let run = folder.read("out/trajectory.csv");
    let rows: Vec<&str> = run.lines().filter(|l| !l.starts_with('#')).collect();
    let shown = times
        .last()
        .and_then(serde_json::Value::as_f64)
        .expect("a time");
    let before = times[times.len() - 2].as_f64().expect("a time");
    // The whole run or the interval that is drawn: its last sample, closer than one stride.
    assert!(shown > before, "{shown} {before}");
    assert!(
        rows.iter()
            .any(|r| r.split(',').any(|x| x.parse() == Ok(shown))),
        "{shown}"
    );
}

#[test]
fn words_of_a_user_cannot_end_an_element() {
    let folder = Folder::new("page-words");
    let sample = rotor("case harmonic-rotor").out;
    let case: Vec<String> = sample
        .lines()
        .map(|line| match line.starts_with("doc = ") {
            true => "doc = \"</p><script>alert(1)</script> & <b>\"".to_owned(),
            false => line.to_owned(),
        })
        .collect();
    let case = folder.write("case.toml", case.join("\n"));
    let page = page(
        &folder,
        &["harmonic-rotor", "--case", &case, "--steps", "20"],
    );
    assert!(page.contains("&lt;/p&gt;&lt;script&gt;alert(1)"), "{page}");
    assert!(!page.contains("<script>alert"), "{page}");
}
