//! Site data from arrays of a file: a run starts from the end of another, files written by numpy can be read,
//! and errors are reported with their position.

use crate::common::{Folder, clebsch, models, runs, table, text_of};

/// CRC-32 bit by bit (polynomial 0xEDB88320, reflected).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & 0_u32.wrapping_sub(crc & 1))
        })
    })
}

/// An array as npy: type, whether its first index runs fastest, shape, data.
fn npy(kind: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let text = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}");
    let text = format!("{text:<117}\n");
    let mut out = b"\x93NUMPY\x01\x00v\x00".to_vec();
    out.extend(text.into_bytes());
    assert_eq!(out.len(), 128);
    out.extend(data);
    out
}

/// Numbers as an array.
fn floats(shape: &str, numbers: &[f64]) -> Vec<u8> {
    let data: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    npy("<f8", false, shape, &data)
}

/// The bytes of `numpy.savez` 2.4: local headers leave the sizes to a 64-bit field after the name; only the directory
/// contains them directly.
fn savez(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in arrays {
        let name = format!("{name}.npy");
        let (size, start) = (data.len() as u32, out.len() as u32);
        let sum = crc(data).to_le_bytes();
        let stored = b"-\x00\x00\x00\x00\x00\x00\x00!\x00";
        let long = [(name.len() as u16).to_le_bytes(), 20_u16.to_le_bytes()].concat();
        out.extend(
            [
                b"PK\x03\x04",
                &stored[..],
                &sum,
                &[255; 8],
                &long,
                name.as_bytes(),
            ]
            .concat(),
        );
        out.extend(b"\x01\x00\x10\x00");
        out.extend([u64::from(size).to_le_bytes(); 2].concat());
        out.extend(data);
        let short = [(name.len() as u16).to_le_bytes(), [0; 2]].concat();
        let sizes = [size.to_le_bytes(); 2].concat();
        directory.extend([b"PK\x01\x02-\x03", &stored[..], &sum, &sizes, &short].concat());
        directory.extend(b"\x00\x00\x00\x00\x00\x00\x00\x00\x80\x01");
        directory.extend([&start.to_le_bytes(), name.as_bytes()].concat());
    }
    let (count, start) = ((arrays.len() as u16).to_le_bytes(), out.len() as u32);
    out.extend(&directory);
    out.extend([b"PK\x05\x06\x00\x00\x00\x00", &count[..], &count].concat());
    out.extend([(directory.len() as u32).to_le_bytes(), start.to_le_bytes()].concat());
    out.extend([0, 0]);
    out
}

/// The rows of a run as names and numbers, without node, time and the invariants, which depend on the whole run.
fn rows(folder: &Folder, out: &str) -> Vec<Vec<(String, f64)>> {
    let csv = std::fs::read_to_string(folder.path(&format!("{out}/trajectory.csv")));
    let csv = csv.expect("is written");
    let names: Vec<&str> = csv.lines().next().expect("a head").split(',').collect();
    let row = |line: &str| {
        let all = names.iter().zip(line.split(','));
        let all = all.filter(|(name, _)| {
            !["node", "time"].contains(name) && !name.starts_with("invariant_")
        });
        let number = |x: &str| x.parse().expect("a number");
        all.map(|(name, x)| ((*name).to_owned(), number(x)))
            .collect()
    };
    csv.lines().skip(1).map(row).collect()
}

/// The difference of rows, relative to the largest number of the first row.
fn difference(one: &[(String, f64)], other: &[(String, f64)]) -> f64 {
    assert_eq!(one.len(), other.len());
    let scale = one.iter().fold(0.0_f64, |most, (_, x)| most.max(x.abs()));
    let differences = one.iter().zip(other).map(|((name, a), (own, b))| {
        assert_eq!(name, own);
        (a - b).abs() / scale
    });
    clebsch::scalar::largest(differences)
}

/// Runs a case for 60 steps, and runs it again from its middle, with the state from sample 1 of the first run by
/// these lines of `[initial]`. Returns the differences of the second run at its start and its end.
fn restarted(name: &str, model: &str, case: &str, initial: &str) -> [f64; 2] {
    let folder = Folder::new(&format!("from-npz-{name}"));
    let run = |out: &str, case: &str, steps: &str| {
        let case = folder.write(&format!("{out}.toml"), case);
        let to = folder.path(out);
        runs(&format!(
            "run {model} --case {case} --steps {steps} --every 30 --out {to}"
        ));
        rows(&folder, out)
    };
    let whole = run("whole", case, "60");
    let (head, rest) = case.split_once("[initial]").expect("has values");
    let bounds = rest
        .split_once("\n[")
        .map_or(String::new(), |(_, b)| format!("[{b}"));
    let from = "{ npz = \"whole/trajectory.npz\", sample = 1 }";
    let second = format!(
        "{head}[initial]\n{}\n{bounds}",
        initial.replace("NPZ", from)
    );
    let second = run("second", &second, "30");
    assert_eq!((whole.len(), second.len()), (3, 2));
    [0, 1].map(|k| difference(&whole[k + 1], &second[k]))
}

/// The second run starts with exactly the written numbers; the positions of the first run have a few more digits
/// (`clebsch::sum`), which are not written.
#[test]
fn the_end_of_a_run_is_the_start_of_another() {
    let ring = "q = NPZ\nmomentum_q = NPZ";
    let toda = text_of("lattices/toda-chain.toml");
    let model = models("lattices/toda-chain.clebsch");
    // A ring that is expanded site by site, and one with loops over sites.
    let long = toda.replace("i = 32", "i = 40");
    for (name, case) in [("ring", toda), ("long-ring", long)] {
        let [start, end] = restarted(name, &model, &case, ring);
        assert!(start == 0.0 && end < 4.0 * f64::EPSILON, "{start} {end}");
    }
}

/// Long, since two models are derived body by body and as chains, and each model is run twice. Attitudes are read as
/// matrices or quaternions. A run omits sites whose value an end condition prescribes; a second array lists the other
/// sites.
#[test]
fn rods_go_on_from_what_a_run_has_written() {
    for (sites, name) in [(8, "rod"), (40, "long-rod")] {
        for (model, q) in [
            ("geometrically-exact-rod", "Lambda"),
            ("quaternion-rod", "q"),
        ] {
            let case = text_of(&format!("lattices/{model}.toml"));
            let (before, rest) = case.split_once("m = [").expect("has masses");
            let (_, after) = rest.split_once("]\n").expect("ends");
            let case =
                format!("{before}m = 0.03\n{after}").replace("i = 16", &format!("i = {sites}"));
            let initial = format!(
                "phi = NPZ\nphi_0 = [0.0, 0.0, 0.0]\nmomentum_phi = NPZ\n{q} = NPZ\nbody_momentum_{q} = NPZ"
            );
            let file = models(&format!("lattices/{model}.clebsch"));
            let [start, end] = restarted(&format!("{model}-{name}"), &file, &case, &initial);
            // Attitudes are made orthonormal anew.
            assert!(start < 4.0 * f64::EPSILON, "{model} {name}: {start}");
            assert!(end < 1e-14, "{model} {name}: {end}");
        }
    }
}

/// If only one site moves, its momentum has the name of its quantity: on a ring of one site, and next to prescribed ends.
#[test]
fn a_single_site_goes_on_from_what_a_run_has_written() {
    let folder = Folder::new("from-npz-single-models");
    let fields =
        "model Fields { label i in 0..N; periodic; param m, k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*k*(1 - cos(next(q, i) - q)) - h*k*q^2/2;
        end i = 0 { free; held { q = given; } } end i = N { free; held { q = given; } } }";
    let turns = "model Turns { label i in 0..N; periodic; param J, C: Sym<3>; param b: Vec<3>;
        group Λ: SO<3> at nodes velocity Ω; constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - h*dot(b, Λ*E3) + h*tr(C*Λ^T*next(Λ, i));
        end i = 0 { free; held { Λ = given; } } end i = N { free; held { Λ = given; } } }";
    let identity = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    let moments = "[[1, 0, 0], [0, 2, 0], [0, 0, 1.5]]";
    let of_fields = ("m = 1.0\nk = 1.0", "q", "0.1", "momentum_q", "0.2");
    let numbers = format!("J = {moments}\nC = {moments}\nb = [0.3, 0, 1]");
    let of_turns = (
        &numbers[..],
        "Lambda",
        identity,
        "body_momentum_Lambda",
        "[0.1, 0.2, 0.3]",
    );
    for (model, text, (parameters, element, at, momentum, p)) in
        [("Fields", fields, of_fields), ("Turns", turns, of_turns)]
    {
        let file = folder.write(&format!("{model}.clebsch"), text);
        for (name, ends, given) in [
            ("ring", "\"periodic\"", None),
            ("first", "[\"held\", \"free\"]", Some(0)),
            ("last", "[\"free\", \"held\"]", Some(1)),
        ] {
            let case = format!(
                "model = \"{model}\"\nh = 0.01\nsteps = 10\n[labels]\ni = 1\n[ends]\ni = {ends}\n[parameters]\n{parameters}\n\
                 [initial]\n{element} = {at}\n{momentum} = {p}\n"
            );
            let own = given.map_or(String::new(), |site| format!("{element}_{site} = {at}\n"));
            let initial = format!("{element} = NPZ\n{momentum} = NPZ\n{own}");
            let [start, end] = restarted(&format!("{model}-{name}"), &file, &case, &initial);
            assert!(start < 4.0 * f64::EPSILON, "{model} {name}: {start}");
            assert!(end < 1e-14, "{model} {name}: {end}");
        }
    }
}

#[test]
fn bodies_and_particles_go_on_too() {
    let top = clebsch("case heavy-top").out;
    let initial = "Lambda = NPZ\nbody_momentum = NPZ";
    let [start, end] = restarted("top", "heavy-top", &top, initial);
    assert!(start < 4.0 * f64::EPSILON && end < 1e-14, "{start} {end}");
    let fluid = text_of("fluids/shallow-water-2d.toml").replace("a = 400", "a = 64");
    let model = models("fluids/shallow-water-2d.clebsch");
    // The particles have equal parts of the depth.
    let [start, end] = restarted("fluid", &model, &fluid, "X = NPZ\nmomentum_X = NPZ");
    assert!(start == 0.0 && end < 1e-14, "{start} {end}");
}

/// A ring of three points with these lines of `[initial]`.
fn ring(initial: &str) -> String {
    let case = text_of("lattices/toda-chain.toml").replace("i = 32", "i = 3");
    let (head, _) = case.split_once("[initial]").expect("has values");
    format!("{head}[initial]\n{initial}\n")
}

/// The arrays that the tests of this ring read.
fn arrays() -> Vec<u8> {
    let singles: Vec<u8> = [0.1_f32, 0.2, 0.3]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    savez(&[
        ("q", floats("(3,)", &[0.0, 0.5, 1.0])),
        ("p", floats("(3,)", &[0.1, 0.2, 0.3])),
        ("single", npy("<f4", false, "(3,)", &singles)),
        ("whole", npy("|i1", false, "(3,)", &[0, 1, 255])),
        ("runs", floats("(2, 3)", &[0.5, 0.5, 0.5, 0.0, 0.5, 1.0])),
        (
            "turned",
            npy(
                "<f8",
                true,
                "(2, 3)",
                &[0.5, 0.0, 0.5, 0.5, 0.5, 1.0_f64]
                    .map(f64::to_le_bytes)
                    .concat(),
            ),
        ),
        ("wide", floats("(3, 2)", &[0.0; 6])),
        ("short", floats("(2,)", &[0.0; 2])),
        ("infinite", floats("(3,)", &[0.0, f64::INFINITY, 0.0])),
        ("complex", npy("<c16", false, "(3,)", &[0; 48])),
        ("records", npy("<f8", false, "(3,)", &[0; 23])),
    ])
}

#[test]
fn files_of_numpy_are_read() {
    let folder = Folder::new("from-npz-numpy");
    std::fs::write(folder.path("data.npz"), arrays()).expect("a file for the test");
    let run = |initial: &str| {
        folder.write("case.toml", ring(initial));
        let done =
            folder.runs("run models/lattices/toda-chain.clebsch --case @case.toml --steps 50");
        done.out
    };
    let by_list = run("q = [0.0, 0.5, 1.0]\nmomentum_q = [0.1, 0.2, 0.3]");
    let momenta = "momentum_q = { npz = \"data.npz\", key = \"p\" }";
    for q in [
        "{ npz = \"data.npz\" }",
        "{ npz = \"../from-npz-numpy/data.npz\", key = \"q\" }",
        "{ npz = \"data.npz\", key = \"runs\" }",
        "{ npz = \"data.npz\", key = \"runs\", sample = 1 }",
        "{ npz = \"data.npz\", key = \"runs\", sample = -1 }",
        "{ npz = \"data.npz\", key = \"turned\" }",
    ] {
        assert_eq!(run(&format!("q = {q}\n{momenta}")), by_list, "{q}");
    }
    let first = "q = { npz = \"data.npz\", key = \"runs\", sample = -2 }\nmomentum_q = 0.0";
    assert_eq!(run(first), run("q = 0.5\nmomentum_q = 0.0"));
    let single = "q = { npz = \"data.npz\", key = \"whole\" }\nmomentum_q = { npz = \"data.npz\", key = \"single\" }";
    let list = [0.1_f32, 0.2, 0.3].map(f64::from);
    assert_eq!(
        run(single),
        run(&format!("q = [0, 1, -1]\nmomentum_q = {list:?}"))
    );
}

#[test]
fn what_is_wrong_is_told_where_it_stands() {
    let folder = Folder::new("from-npz-wrong");
    let write = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.path(name), bytes).expect("a file for the test");
    };
    let all = arrays();
    write("data.npz", &all);
    write("cut.npz", &all[..all.len() / 2]);
    write("one.npy", &floats("(3,)", &[0.0; 3]));
    write("note.txt", b"no arrays");
    write("none.npz", &savez(&[]));
    let mut damaged = all.clone();
    damaged[180] ^= 1;
    write("damaged.npz", &damaged);
    // The method of the first member in the directory: 8, deflated.
    let mut compressed = all.clone();
    let first = compressed
        .windows(4)
        .position(|w| w == b"PK\x01\x02")
        .expect("a directory");
    compressed[first + 10] = 8;
    write("compressed.npz", &compressed);
    let wrong = |case: &str, expected: &str| {
        folder.write("wrong.toml", case);
        folder
            .clebsch("run models/lattices/toda-chain.clebsch --case @wrong.toml")
            .refuses(expected);
    };
    for [table, expected] in table(
        r#"
        npz = "gone.npz"                         | gone.npz: No such file
        npz = "."                                | cannot read
        npz = "note.txt"                         | note.txt is not an npz file
        npz = "cut.npz"                          | cut.npz is not an npz file
        npz = "one.npy"                          | one.npy is a single array, written by numpy.save
        npz = "none.npz"                         | none.npz has no arrays
        npz = "damaged.npz"                      | damaged.npz is damaged: `q` cannot be read
        npz = "data.npz", key = "records"        | data.npz is damaged: `records` cannot be read
        npz = "compressed.npz"                   | write it with numpy.savez
        npz = "data.npz", key = "x"              | data.npz has no array `x`; known: q, p, single, whole, runs, turned, wide, short, infinite, complex, records
        npz = "data.npz", key = "run"            | data.npz has no array `run`; did you mean `runs`?
        npz = "data.npz", key = "complex"        | has entries of type `<c16`
        npz = "data.npz", key = "wide"           | data.npz has the shape (3, 2); a value at each of 3 sites takes (3,) or (samples, 3)
        npz = "data.npz", key = "short"          | has the shape (2,)
        npz = "data.npz", key = "infinite"       | the array `infinite` of
        npz = "data.npz", key = "infinite"       | data.npz is inf at site 1, which is not a finite number
        npz = "data.npz", simple = 1             | unknown key `simple`; did you mean `sample`?
        key = "q"                                | missing key `npz`
        npz = 1                                  | npz: expected a string in quotes, found a value of type integer
        npz = "data.npz", key = 1                | key: expected a string in quotes
        npz = "data.npz", sample = 0.5           | sample: expected a whole number
        npz = "data.npz", sample = 0             | has no samples, its shape is (3,)
        npz = "data.npz", key = "runs", sample = 2 | has 2 samples, 0 to 1 or, counted from the end, -1 to -2; found 2
        npz = "data.npz", key = "runs", sample = -3 | found -3
"#,
    ) {
        wrong(
            &ring(&format!("q = {{ {table} }}\nmomentum_q = 0.0")),
            expected,
        );
        // The keys of the table may also be on separate lines.
        wrong(
            &ring(&format!("momentum_q = 0.0\nq = {{ {table} }}")),
            ":23: initial.q: ",
        );
    }
    // A parameter at sites, and one without sites.
    let case = ring("q = 0.0\nmomentum_q = 0.0");
    let of = |key: &str| {
        case.replace(
            "m = 1.0",
            &format!("m = {{ npz = \"data.npz\", key = \"{key}\" }}"),
        )
    };
    wrong(&of("m"), ":16: parameters.m: ");
    wrong(&of("wide"), ":16: parameters.m: the array `wide` of ");
    let whole = case.replace("a = 1.0", "a = { npz = \"data.npz\", key = \"q\" }");
    wrong(&whole, ":17: parameters.a: the array `q` of ");
    wrong(&whole, "has the shape (3,); a value takes () or (samples,)");
}

#[test]
fn values_that_an_end_holds_are_told_where_they_stand() {
    let folder = Folder::new("from-npz-held");
    let sites = [0, 1, 2, 3].map(f64::from);
    let arrays = savez(&[
        ("u", floats("(4,)", &[0.0, 0.1, 0.2, 0.3])),
        ("momentum_u", floats("(2,)", &[0.1, 0.2])),
        ("inner", floats("(2,)", &[0.1, 0.2])),
        ("sites_of_inner", floats("(2,)", &sites[1..3])),
    ]);
    std::fs::write(folder.path("data.npz"), arrays).expect("a file for the test");
    let case = text_of("lattices/sine-gordon.toml").replace("i = 80", "i = 3");
    let (head, _) = case.split_once("[initial]").expect("has values");
    let run = |values: &str| {
        folder.write("case.toml", format!("{head}[initial]\n{values}\n"));
        folder.clebsch("run models/lattices/sine-gordon.clebsch --case @case.toml --steps 5")
    };
    let by_list = run("u = [0.0, 0.1, 0.2, 0.3]\nmomentum_u = [0.1, 0.2]").succeeds();
    let inner = "{ npz = \"data.npz\", key = \"inner\" }";
    for values in [
        "u = { npz = \"data.npz\" }\nmomentum_u = { npz = \"data.npz\" }".to_owned(),
        format!("u = {inner}\nu_0 = 0.0\nu_3 = 0.3\nmomentum_u = {inner}"),
    ] {
        let done = run(&values);
        done.ended(0).says_nothing();
        assert_eq!(done.out, by_list.out, "{values}");
    }
    for (values, expected) in [
        (
            format!("u = {inner}\nmomentum_u = 0.0"),
            ":21: initial.u: the array `inner` of ",
        ),
        (
            format!("u = {inner}\nmomentum_u = 0.0"),
            "has no value at site 0",
        ),
        (
            "u = [1.0, 2.0]\nmomentum_u = 0.0".to_owned(),
            ":21: initial.u: a list needs",
        ),
        (
            "u = \"1/i\"\nmomentum_u = 0.0".to_owned(),
            ":21: initial.u_0: inf",
        ),
        (
            "u = [[0.0], [0.0], [0.0], [0.0]]\nmomentum_u = 0.0".to_owned(),
            ":21: initial.u_0: expected a number",
        ),
    ] {
        run(&values).refuses(expected);
    }
}

#[test]
fn a_parameter_of_an_end_asks_which_ends_there_are() {
    let folder = Folder::new("ends-unchosen");
    folder.write(
        "line.clebsch",
        "model Line { label i in 0..N; periodic; param m: Real at nodes; field q: Real at nodes offset L;
        lagrangian = m*(next(q) - q)^2/(2*h) - (h/2)*(next(q, i) - q)^2;
        end i = 0 { free; pinned { q = given; } }
        end i = N { free; load { param F: Real; term h*F*q; } } }",
    );
    let run = |extra: &str, ends: &str| {
        let case = format!(
            "model = \"line\"\nh = 0.05\nsteps = 4\n[labels]\ni = 3\n{ends}[parameters]\nm = 1.0\n{extra}\n\
             [initial]\nq = \"i\"\nmomentum_q = 0.0\n"
        );
        folder.write("case.toml", &case);
        folder.clebsch("run @line.clebsch --case @case.toml")
    };
    let ends = "(first end: free, pinned; last end: free, load; or \"periodic\")";
    for [extra, owner, example] in table(
        r#"
        F = 0.1   | `load`         | add [ends] with i = ["free", "load"]
        F_N = 0.1 | `load`         | i = ["free", "load"]
        L = 3.0   | belongs to the ring | add [ends] with i = "periodic"
"#,
    ) {
        let done = run(extra, "").exits(2);
        done.says([":8: parameters.", owner, example, ends]);
        // If ends are chosen, the case may contain parameters of other ends.
        run(extra, "[ends]\ni = \"free\"\n").succeeds();
    }
    let (default, free) = (run("", ""), run("", "[ends]\ni = \"free\"\n"));
    assert_eq!(
        (default.code, default.out),
        (0, free.out),
        "{}",
        default.err
    );
}
