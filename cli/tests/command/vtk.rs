//! Files for ParaView: every array exists, decoded from base64, with as many numbers as its points or cells; the
//! numbers equal the numbers of the trajectory. The files are written next to other results, and removed with them.

use crate::common::{Done, Folder, clebsch, names_in, rotor};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The number of an attribute.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let from = tag.split_once(&format!("{name}=\""))?.1;
    Some(from.split_once('"')?.0)
}

/// The words of an inline array, after its length.
fn words(text: &str) -> Vec<u64> {
    const LETTERS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let value = |c: char| LETTERS.find(c).expect("a letter of base64") as u32;
    let letters: Vec<u32> = text.chars().filter(|c| *c != '=').map(value).collect();
    let mut bytes = Vec::new();
    for four in letters.chunks(4) {
        let whole = four.iter().fold(0, |all, six| all << 6 | six) << (6 * (4 - four.len()));
        bytes.extend(&whole.to_be_bytes()[1..four.len()]);
    }
    let words = bytes.as_chunks::<8>().0.iter();
    let mut words: Vec<u64> = words.map(|w| u64::from_le_bytes(*w)).collect();
    assert_eq!(words.remove(0), 8 * words.len() as u64);
    words
}

/// A file: the counts of its piece, and its arrays by element and name.
struct Read {
    piece: String,
    arrays: BTreeMap<(String, String), Vec<u64>>,
}

impl Read {
    fn of(path: &str) -> Self {
        let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{path}: {e}"));
        let (mut element, mut piece) = (String::new(), String::new());
        let mut arrays = BTreeMap::new();
        for line in text.lines() {
            if let Some(tag) = line.strip_prefix("<DataArray") {
                let (tag, data) = tag.split_once('>').expect("ends");
                let name = attribute(tag, "Name").expect("has a name").to_owned();
                let data = data.strip_suffix("</DataArray>").expect("in one line");
                arrays.insert((element.clone(), name), words(data));
            } else if line.starts_with("<Piece") {
                piece = line.to_owned();
            } else if !line.starts_with("</") && !line.contains(' ') {
                element = line.trim_matches(['<', '>']).to_owned();
            }
        }
        Self { piece, arrays }
    }

    fn count(&self, of: &str) -> usize {
        let count = attribute(&self.piece, &format!("NumberOf{of}"));
        count.expect("is told").parse().expect("a number")
    }

    fn numbers(&self, element: &str, name: &str) -> Vec<f64> {
        let key = (element.to_owned(), name.to_owned());
        let own = self.arrays.get(&key);
        let own = own.unwrap_or_else(|| panic!("{element} {name}: {:?}", self.arrays.keys()));
        own.iter().map(|w| f64::from_bits(*w)).collect()
    }
}

/// Model files run in separate processes.
fn of(model: &str, arguments: &[&str]) -> Done {
    match model.ends_with(".clebsch") {
        true => clebsch(arguments),
        false => rotor(arguments),
    }
}

/// Runs a model with its case into `out`.
fn run(model: &str, case: Option<&str>, more: &[&str], out: &str) {
    let mut arguments = vec!["run", model, "--vtk", "--out", out];
    arguments.extend(case.iter().flat_map(|case| ["--case", *case]));
    arguments.extend(more);
    of(model, &arguments).succeeds();
}

/// The times and files of a collection, which are all there.
fn members(out: &str, name: &str) -> Vec<(f64, String)> {
    let text = fs::read_to_string(format!("{out}/vtk/{name}.pvd")).expect("a collection");
    let lines = text.lines().filter(|line| line.starts_with("<DataSet"));
    let member = |line: &str| {
        let time = attribute(line, "timestep").expect("a time").parse();
        let file = attribute(line, "file").expect("a file");
        let path = format!("{out}/vtk/{file}");
        assert!(Path::new(&path).is_file(), "{path}");
        (time.expect("a number"), path)
    };
    lines.map(member).collect()
}

fn shipped(file: &str) -> (String, String) {
    let root = format!("{}/../models/{file}", env!("CARGO_MANIFEST_DIR"));
    (format!("{root}.clebsch"), format!("{root}.toml"))
}

/// The largest of the sizes of numbers.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    clebsch::scalar::largest(numbers.map(f64::abs))
}

#[test]
fn a_rod_is_a_line_with_the_frames_of_its_segments() {
    let folder = Folder::new("vtk-rod");
    let out = folder.path("out");
    let (model, case) = shipped("lattices/geometrically-exact-rod");
    run(
        &model,
        Some(&case),
        &["--steps", "20", "--every", "10"],
        &out,
    );
    let files = members(&out, "line");
    let times: Vec<f64> = files.iter().map(|(t, _)| *t).collect();
    assert_eq!(times, [0.0, 0.005, 0.01]);
    for (_, file) in &files {
        let read = Read::of(file);
        let [points, lines] = [read.count("Points"), read.count("Lines")];
        assert_eq!((points, lines), (17, 16));
        let corners = &read.arrays[&("Lines".to_owned(), "connectivity".to_owned())];
        assert_eq!(&corners[..4], [0, 1, 1, 2]);
        let places = read.numbers("Points", "Points");
        assert_eq!(places, read.numbers("PointData", "phi"));
        // The first node is clamped at the given position, and its momentum is unknown.
        assert_eq!(&places[..3], [0.0; 3]);
        assert!(read.numbers("PointData", "momentum_phi")[0].is_nan());
        let [d1, d3] = ["d1", "d3"].map(|d| read.numbers("CellData", d));
        assert_eq!(d3.len(), 3 * lines);
        let products = d1.chunks(3).zip(d3.chunks(3));
        let products = products.map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        // Rounding of a rotation.
        assert!(largest(products) < 1e-12);
    }
}

#[test]
fn a_ring_is_closed() {
    let folder = Folder::new("vtk-ring");
    let out = folder.path("out");
    let (model, case) = shipped("lattices/toda-chain");
    run(&model, Some(&case), &["--steps", "4", "--every", "4"], &out);
    let read = Read::of(&members(&out, "line")[1].1);
    assert_eq!((read.count("Points"), read.count("Lines")), (33, 32));
    let places = read.numbers("Points", "Points");
    let momenta = read.numbers("PointData", "momentum_q");
    // The position of the first point again, with the offset around the ring.
    assert_eq!(places[3 * 32 + 1], places[1] - 2.0);
    assert_eq!(momenta[32], momenta[0]);
}

#[test]
fn a_fluid_on_a_torus_has_cells_that_fill_it() {
    let folder = Folder::new("vtk-cells");
    let out = folder.path("out");
    let (model, case) = shipped("fluids/shallow-water-2d-regularised");
    let text = fs::read_to_string(&case).expect("is shipped");
    let text = text.replace("f = 0.0", "f = 3.0");
    let own = folder.write("turning.toml", &text);
    run(&model, Some(&own), &["--steps", "6", "--every", "3"], &out);
    let (_, particles) = &members(&out, "particles")[0];
    let (_, cells) = &members(&out, "cells")[0];
    let [particles, cells] = [particles, cells].map(|file| Read::of(file));
    assert_eq!(
        (particles.count("Points"), cells.count("Polys")),
        (400, 400)
    );
    let points = cells.numbers("Points", "Points");
    let ends = &cells.arrays[&("Polys".to_owned(), "offsets".to_owned())];
    assert_eq!(ends.last().copied(), Some(cells.count("Points") as u64));
    // The areas of the polygons, computed from their corners, equal the areas of the cells and fill the square.
    let areas = cells.numbers("CellData", "area");
    let mut first = 0;
    for (end, area) in ends.iter().zip(&areas) {
        let last = usize::try_from(*end).expect("is small");
        let corner = |i: usize| [points[3 * i], points[3 * i + 1]];
        let twice: f64 = (first..last)
            .map(|i| {
                let next = if i + 1 == last { first } else { i + 1 };
                let ([x, y], [u, v]) = (corner(i), corner(next));
                x * v - u * y
            })
            .sum();
        // Corners of size one, areas of 1/400.
        assert!((twice / 2.0 - area).abs() < 1e-14, "{twice} {area}");
        first = last;
    }
    assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-13);
    // The case gives the velocity, from which the momenta are computed.
    let places = particles.numbers("Points", "Points");
    let velocity = particles.numbers("PointData", "velocity");
    let stated = |y: f64| 0.1 * (std::f64::consts::TAU * y).sin();
    let off = velocity.chunks(3).zip(places.chunks(3));
    let off = off.map(|(u, x)| (u[0] - stated(x[1])).abs() + u[1].abs() + u[2].abs());
    // Momenta with the rotation in them, 1.5 in units of a mass, of which the velocity is a difference.
    assert!(largest(off) < 1e-13);
    // (ζ + f)/h with f = 3 and the depth that the cell has.
    let of = |name: &str| cells.numbers("CellData", name);
    let (potential, zeta, depth) = (of("potential_vorticity"), of("vorticity"), of("depth"));
    let off = (0..400).map(|a| potential[a] * depth[a] - zeta[a] - 3.0);
    // Differences over 6e-6 of positions of size one, whose rounding error is 1e-16.
    assert!(largest(off) < 1e-9);
    assert!(largest(depth.iter().zip(&areas).map(|(h, a)| h * a - 1.0 / 400.0)) < 1e-16);
}

#[test]
fn a_fluid_on_a_grid_has_an_image_of_its_nodes() {
    let folder = Folder::new("vtk-grid");
    let out = folder.path("out");
    let (model, case) = shipped("fluids/particle-mesh-2d");
    run(&model, Some(&case), &["--steps", "2", "--every", "2"], &out);
    let text = fs::read_to_string(&members(&out, "grid")[1].1).expect("a file");
    // The channel is periodic along its length, so the first node is repeated at the seam.
    assert!(text.contains("Extent=\"0 32 0 16 0 0\""));
    assert!(text.contains("Spacing=\"0.0625 0.0625 1.0\""));
    let read = Read::of(&members(&out, "grid")[1].1);
    let depth = read.numbers("PointData", "H");
    assert_eq!(depth.len(), 33 * 17);
    assert_eq!(depth[..33], depth[33 * 16..]);
    // The bump is in the middle.
    let smoothed = read.numbers("PointData", "S");
    let top = (0..33 * 17).max_by(|a, b| smoothed[*a].total_cmp(&smoothed[*b]));
    assert_eq!(top, Some(33 * 8 + 16));
    let particles = Read::of(&members(&out, "particles")[1].1);
    assert_eq!(particles.count("Verts"), 1800);
    assert_eq!(particles.numbers("PointData", "velocity").len(), 5400);
}

#[test]
fn a_body_is_a_point_with_its_axes() {
    let folder = Folder::new("vtk-body");
    let out = folder.path("out");
    run("harmonic-rotor", None, &["--steps", "10"], &out);
    let files = members(&out, "bodies");
    assert_eq!(files.len(), 11);
    let samples = folder.samples("out/trajectory.csv");
    let of = |name: &str| samples.end(name);
    let read = Read::of(&files[10].1);
    assert_eq!(read.count("Points"), 1);
    for (axis, name) in ["d1", "d2", "d3"].iter().enumerate() {
        let column: Vec<f64> = (1..=3)
            .map(|i| of(&format!("Lambda_{i}{}", axis + 1)))
            .collect();
        assert_eq!(read.numbers("PointData", name), column);
    }
    let gamma: Vec<f64> = (1..=3).map(|i| of(&format!("Gamma_{i}"))).collect();
    assert_eq!(read.numbers("PointData", "Gamma"), gamma);
}

#[test]
fn the_folder_is_replaced_with_the_other_results_and_never_with_what_is_not_of_a_run() {
    let folder = Folder::new("vtk-force");
    let out = folder.path("out");
    run("harmonic-rotor", None, &["--steps", "10"], &out);
    let first = fs::read(format!("{out}/vtk/bodies-05.vtp")).expect("a file");
    // A repeated run writes the same bytes; fewer samples give fewer files; without the option nothing is written.
    run("harmonic-rotor", None, &["--steps", "10", "--force"], &out);
    let again = fs::read(format!("{out}/vtk/bodies-05.vtp")).expect("a file");
    assert!(first == again);
    run(
        "harmonic-rotor",
        None,
        &["--steps", "10", "--every", "10", "--force"],
        &out,
    );
    assert_eq!(
        names_in(format!("{out}/vtk")),
        ["bodies-0.vtp", "bodies-1.vtp", "bodies.pvd"]
    );
    fs::write(format!("{out}/vtk/notes.txt"), "mine").expect("written");
    let arguments = [
        "run",
        "harmonic-rotor",
        "--steps",
        "10",
        "--force",
        "--out",
        &out,
    ];
    let done = rotor(&arguments).exits(2);
    done.says("notes.txt");
    fs::remove_file(format!("{out}/vtk/notes.txt")).expect("removed");
    rotor(&arguments).succeeds();
    assert!(!Path::new(&format!("{out}/vtk")).exists());
    assert_eq!(folder.names(), ["out"]);
    // A run without these files cannot be resumed with them.
    folder
        .rotor("run harmonic-rotor --steps 10 --vtk --resume --out @out")
        .refuses("without --vtk");
}

#[test]
fn a_long_run_has_about_a_thousand_samples_with_its_last() {
    let folder = Folder::new("vtk-long");
    let out = folder.path("out");
    run("harmonic-rotor", None, &["--steps", "2500"], &out);
    let times: Vec<f64> = members(&out, "bodies").iter().map(|(t, _)| *t).collect();
    // Every third of 2501, and the last one.
    assert_eq!(times.len(), 835);
    let last = folder.samples("out/trajectory.csv").end("time");
    assert_eq!(times.last().copied(), Some(last));
}

#[test]
fn what_is_not_seen_is_refused_before_it_runs() {
    let folder = Folder::new("vtk-nothing");
    folder.write(
        "number.clebsch",
        "model Number { param m, c: Real; field q: Real; lagrangian = m*(next(q) - q)^2/(2*h) - h*c*q^2/2; }",
    );
    folder
        .clebsch(&format!(
            "run @number.clebsch --case sample --vtk --out {}",
            folder.path("out")
        ))
        .refuses("has nothing to show");
    assert!(!Path::new(&folder.path("out")).exists());
    // Without a folder there is nowhere to write to.
    rotor("run harmonic-rotor --vtk").ended(2);
}

/// An interrupted run keeps the files so far. A resumed run writes the same files as an uninterrupted run.
#[cfg(unix)]
#[test]
fn an_interrupted_run_is_gone_on_with_to_the_same_files() {
    use crate::signals::{begun, ended_by, succeeds, wait_for};
    let folder = Folder::new("vtk-resumed");
    let [whole, out] = ["whole", "out"].map(|name| folder.path(name));
    let words = |out: &str, more: &str| {
        format!("run heavy-top --steps 4000000 --every 400000 --vtk --out {out} {more}")
    };
    assert!(succeeds(&words(&whole, "")));
    let mut child = begun(&words(&out, "--checkpoint 0.001"));
    wait_for(&mut child, &out, "checkpoint", |bytes| !bytes.is_empty());
    ended_by("-INT", child);
    // Whether the signal arrived during the run or after its end.
    assert!(succeeds(&words(&out, "--resume")));
    let contents = |name: &str| -> Vec<(String, Vec<u8>)> {
        let files = names_in(folder.path(&format!("{name}/vtk"))).into_iter();
        let file = |file: String| (folder.bytes(&format!("{name}/vtk/{file}")), file);
        files.map(file).map(|(bytes, file)| (file, bytes)).collect()
    };
    assert!(contents("whole") == contents("out"));
    assert_eq!(contents("out").len(), 12);
}
