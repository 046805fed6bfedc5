//! Reads files back with an independent reader: every array by its name, decoded from base64, compared with the
//! input.

use super::*;

/// Decodes base64.
fn decoded(text: &str) -> Vec<u8> {
    let value = |letter: u8| match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        other => panic!("{other} is not a base64 letter"),
    };
    assert!(text.len().is_multiple_of(4), "{}", text.len());
    let letters: Vec<u8> = text.bytes().filter(|c| *c != b'=').map(value).collect();
    let mut bytes = Vec::new();
    for four in letters.chunks(4) {
        let whole = four
            .iter()
            .fold(0_u32, |all, six| all << 6 | u32::from(*six));
        let whole = whole << (6 * (4 - four.len()));
        bytes.extend(&whole.to_be_bytes()[1..four.len()]);
    }
    bytes
}

/// The words of the array with this name that comes next after the element `from`.
fn words(text: &str, from: &str, name: &str) -> Vec<[u8; 8]> {
    let behind = text.split_once(&format!("<{from}>")).expect("is there").1;
    let named = format!("Name=\"{name}\"");
    let behind = behind.split_once(&named).expect("is there").1;
    let (_, behind) = behind.split_once('>').expect("ends");
    let bytes = decoded(behind.split_once('<').expect("ends").0);
    let (words, rest) = bytes.as_chunks::<8>();
    assert!(rest.is_empty());
    let (length, words) = words.split_first().expect("has a length");
    assert_eq!(u64::from_le_bytes(*length), 8 * words.len() as u64);
    words.to_vec()
}

fn numbers(text: &str, from: &str, name: &str) -> Vec<f64> {
    let words = words(text, from, name).into_iter();
    words.map(f64::from_le_bytes).collect()
}

fn counts(text: &str, from: &str, name: &str) -> Vec<u64> {
    let words = words(text, from, name).into_iter();
    words.map(u64::from_le_bytes).collect()
}

fn written(write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> String {
    let mut file = Vec::new();
    write(&mut file).expect("a list takes everything");
    String::from_utf8(file).expect("is text")
}

#[test]
fn points_cells_and_values_are_read_back() {
    let mut data = PolyData::of_points(vec![
        [0.0, 0.1, -1e-300],
        [1.0, 2.0, 3.0],
        [f64::MAX, 5.0, 6.0],
    ]);
    data.lines = vec![vec![0, 1], vec![2, 0]];
    data.polygons = vec![vec![0, 1, 2]];
    data.point_data = vec![
        Values::numbers("a<b", vec![1.0, f64::NAN, -0.0]),
        Values::vectors("u", &[[1.0, 2.0, 3.0]; 3]),
    ];
    data.cell_data = vec![Values::numbers("c", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])];
    let text = written(|file| data.write(file));
    assert!(text.contains(
        "NumberOfPoints=\"3\" NumberOfVerts=\"3\" NumberOfLines=\"2\" NumberOfStrips=\"0\" NumberOfPolys=\"1\""
    ));
    let all: Vec<f64> = data.points.iter().flatten().copied().collect();
    assert_eq!(numbers(&text, "Points", "Points"), all);
    let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let named = numbers(&text, "PointData", "a&lt;b");
    assert_eq!(bits(&named), bits(&data.point_data[0].numbers));
    assert_eq!(numbers(&text, "PointData", "u"), data.point_data[1].numbers);
    assert_eq!(numbers(&text, "CellData", "c"), data.cell_data[0].numbers);
    assert_eq!(counts(&text, "Verts", "connectivity"), [0, 1, 2]);
    assert_eq!(counts(&text, "Verts", "offsets"), [1, 2, 3]);
    assert_eq!(counts(&text, "Lines", "connectivity"), [0, 1, 2, 0]);
    assert_eq!(counts(&text, "Lines", "offsets"), [2, 4]);
    assert_eq!(counts(&text, "Polys", "connectivity"), [0, 1, 2]);
    assert_eq!(counts(&text, "Polys", "offsets"), [3]);
}

#[test]
fn long_arrays_are_read_back() {
    let list: Vec<f64> = (0..10_000).map(|i| (f64::from(i)).sqrt()).collect();
    let image = ImageData {
        origin: [0.0; 3],
        spacing: [0.1, 0.2, 1.0],
        nodes: [100, 100, 1],
        point_data: vec![Values::numbers("H", list.clone())],
    };
    let text = written(|file| image.write(file));
    assert!(
        text.contains(
            "WholeExtent=\"0 99 0 99 0 0\" Origin=\"0.0 0.0 0.0\" Spacing=\"0.1 0.2 1.0\""
        )
    );
    assert_eq!(numbers(&text, "PointData", "H"), list);
}

#[test]
fn values_of_another_number_are_refused() {
    let mut data = PolyData::of_points(vec![[0.0; 3]; 2]);
    data.point_data = vec![Values::numbers("a", vec![1.0])];
    let refused = data.write(&mut Vec::new()).expect_err("one is missing");
    assert_eq!(
        refused.to_string(),
        "`a` has 1 numbers, but 2 times 1 are needed"
    );
    let mut data = PolyData::of_points(vec![[0.0; 3]; 2]);
    data.lines = vec![vec![0, 2]];
    let refused = data.write(&mut Vec::new()).expect_err("there is no third");
    assert_eq!(
        refused.to_string(),
        "a cell has the corner 2, but there are 2 points"
    );
}

#[test]
fn collections_list_their_files() {
    let member = |time, file: &str| Member {
        time,
        file: file.to_owned(),
    };
    let members = [member(0.0, "a-0.vtp"), member(0.1, "a-1.vtp")];
    let text = written(|file| write_collection(file, &members));
    assert!(text.contains("<DataSet timestep=\"0.1\" group=\"\" part=\"0\" file=\"a-1.vtp\"/>"));
    assert_eq!(text.matches("<DataSet").count(), 2);
}
