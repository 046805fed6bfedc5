//! Pictures of quantities at the sites of chains: maps, selected spheres, and notes on zeros.

use crate::common::{Folder, has, runs, text_of};
use std::fs;

/// Runs a shipped model from such a case; gives its pictures by their names.
fn drawn(
    folder: &Folder,
    model: &str,
    case: &str,
    more: &[&str],
) -> impl Fn(&str) -> String + use<> {
    let case = folder.write("case.toml", case);
    let out = folder.path("out");
    let mut all = vec!["run", &model, "--case", &case, "--steps", "100"];
    all.extend(["--force", "--out", &out]);
    all.extend(more);
    runs(&all);
    move |name: &str| fs::read_to_string(format!("{out}/{name}.svg")).unwrap_or_default()
}

/// The shipped cantilever with five sections.
fn cantilever() -> String {
    let text = text_of("lattices/geometrically-exact-rod.toml");
    let (before, rest) = text.split_once("m = [").expect("masses");
    let (_, after) = rest.split_once("]\n").expect("their end");
    let masses = "m = [0.03125, 0.0625, 0.0625, 0.0625, 0.0625, 0.03125]\n";
    let short = format!("{before}{masses}{after}");
    short.replace("i = 16", "i = 5")
}

/// The height of a picture in pixels. On paper 430 pixels are 86 mm.
fn height(svg: &str) -> f64 {
    let own = svg.split("height=\"").nth(1).expect("a height");
    let own = own.split('"').next().expect("its end");
    match own.strip_suffix("mm") {
        Some(own) => own.parse::<f64>().expect("a number") * 430.0 / 86.0,
        None => own.parse().expect("a number"),
    }
}

#[test]
fn rods_have_maps_of_their_angles_and_some_of_their_spheres() {
    let folder = Folder::new("pictures-of-a-rod");
    let wide = drawn(&folder, "geometrically-exact-rod", &cantilever(), &[]);
    let angles = wide("angles");
    has(
        &angles,
        [
            "nutation θ of Λ = R₃(φ) R₁(θ) R₃(ψ), in rad",
            "φ + ψ of Λ, in rad",
            "site i",
        ],
    );
    // Sections of a straight rod are upright, where precession and spin alone are meaningless.
    assert!(!angles.contains("precession") && !angles.contains("spin"));
    assert!(!angles.contains("Λ_4") && height(&angles) < 1000.0);
    let attitude = wide("attitude");
    let told = "6 of 10 spheres are shown: Λ at i = 0, 2, 4; μ of Λ at i = 0, 2, 4";
    assert!(attitude.contains(told), "{attitude:.2000}");
    assert!(attitude.contains("Λ₄ e₃: the body axis e₃ in space"));
    assert!(!attitude.contains("Λ₁ e₃") && !attitude.contains("φ in the ball"));

    // In a plane, components that stay zero are noted. Momenta with the same symbol are distinguished by their
    // frames.
    let momentum = wide("momentum");
    assert_eq!(momentum.matches("zero throughout").count(), 5);
    has(
        &momentum,
        [
            "μ₂, momentum of Λ, body frame",
            "m₂, momentum of Λ, space frame",
        ],
    );
    let numbers: Vec<&str> = momentum.split('>').map(str::trim).collect();
    assert!(!numbers.iter().any(|own| own.starts_with("−0.5")));

    // On paper colour scales are next to their charts, and do not add to the height.
    let paper = drawn(
        &folder,
        "geometrically-exact-rod",
        &cantilever(),
        &["--paper"],
    );
    for (name, wide) in [("momentum", &momentum), ("angles", &angles)] {
        let own = paper(name);
        assert!(height(&own) < height(wide), "{name}: {}", height(&own));
    }
    assert!(paper("attitude").contains("6 of 10 spheres are shown"));
}

/// A planar chain is shown from the side, without tilt; a chain in space is shown in two planes.
#[test]
fn a_chain_in_space_is_drawn_in_planes_of_its_components() {
    let folder = Folder::new("pictures-of-a-chain");
    let flat = "model = \"hanging-chain\"\nh = 0.002\nsteps = 100\n[labels]\ni = 10\n[ends]\ni = [\"pinned\", \"free\"]\n\
                [parameters]\nm = 0.025\na = 0.1\ng = [0.0, 0.0, -1.0]\n[initial]\nx = [\"0.1*i\", 0.0, 0.0]\n\
                momentum_x = [0.0, 0.0, 0.0]\n";
    let own = drawn(&folder, "hanging-chain", flat, &[]);
    let svg = own("snapshots");
    has(
        &svg,
        [
            "shape of x, components 1 and 3",
            "component 1 to the right, 3 up",
            "x₁",
            "x₃",
        ],
    );
    assert!(!svg.contains("below") && !svg.contains("x₂"));
    // At the start it is level.
    let line = svg.split("<polyline").nth(1).expect("the first shape");
    let points = line.split("points=\"").nth(1).expect("its points");
    let points = points.split('"').next().expect("their end");
    let heights: Vec<&str> = points
        .split_whitespace()
        .filter_map(|p| Some(p.split_once(',')?.1))
        .collect();
    assert!(heights.len() == 11 && heights.iter().all(|y| *y == heights[0]));

    let deep = flat.replace(
        "momentum_x = [0.0, 0.0, 0.0]",
        "momentum_x = [0.0, \"0.1*i/N\", 0.0]",
    );
    let svg = drawn(&folder, "hanging-chain", &deep, &[])("snapshots");
    assert!(svg.contains("shape of x, components 1 and 2"), "{svg:.600}");
    let sideways = flat.replace(
        "momentum_x = [0.0, 0.0, 0.0]",
        "momentum_x = [0.0, \"0.02*i/N\", 0.0]",
    );
    let long = sideways.replace("g = [0.0, 0.0, -1.0]", "g = [0.0, 0.0, -20.0]");
    let svg = drawn(&folder, "hanging-chain", &long, &[])("snapshots");
    let told = "shape of x, components 1 and 3, below 1 and 2";
    assert!(svg.contains(told), "{svg:.600}");
}

#[test]
fn a_few_bodies_have_their_angles_against_time() {
    let folder = Folder::new("pictures-of-few-bodies");
    let case = text_of("lattices/coupled-tops.toml");
    let three = case.replace("i = 6", "i = 2");
    let few = drawn(&folder, "coupled-tops", &three, &[]);
    assert!(few("angles").contains("φ precession") && few("angles").contains("Λ_2: nutation"));
    assert!(!few("attitude").contains("spheres are shown"));
    let seven = drawn(&folder, "coupled-tops", &case, &[]);
    assert!(seven("angles").contains("nutation θ of Λ"));
    assert!(seven("attitude").contains("9 of 21 spheres are shown"));
}
