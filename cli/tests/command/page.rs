//! The page of a run: one file that needs no other, with data that its view reads. That it draws is tested in a browser
//! by `cli/tests/browser.sh`.

use crate::common::{Folder, clebsch};

/// The text between the tags of the element with this identity.
fn data(page: &str) -> serde_json::Value {
    let from = page.split_once("id=\"scene\">").expect("a scene").1;
    let text = from.split_once("</script>").expect("its end").0;
    serde_json::from_str(text).expect("JSON")
}

fn page(folder: &Folder, arguments: &[&str]) -> String {
    let out = folder.path("out");
    let all = [&["run"], arguments, &["--out", &out]].concat();
    let done = clebsch(&all);
    assert_eq!(done.code, 0, "{}", done.err);
    std::fs::read_to_string(format!("{out}/run.html")).expect("a page")
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
    // Nothing is fetched: addresses are names of formats only.
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
    let page = page(&folder, &[&model, "--steps", "20"]);
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

#[test]
fn words_of_a_user_cannot_end_an_element() {
    let folder = Folder::new("page-words");
    let sample = clebsch(&["case", "harmonic-rotor"]).out;
    let case: Vec<String> = sample
        .lines()
        .map(|line| match line.starts_with("doc = ") {
            true => "doc = \"</p><script>alert(1)</script> & <b>\"".to_owned(),
            false => line.to_owned(),
        })
        .collect();
    let case = folder.write("case.toml", &case.join("\n"));
    let page = page(
        &folder,
        &["harmonic-rotor", "--case", &case, "--steps", "20"],
    );
    assert!(page.contains("&lt;/p&gt;&lt;script&gt;alert(1)"), "{page}");
    assert!(!page.contains("<script>alert"), "{page}");
}
