//! trajectory.npz against trajectory.csv: the zip is valid, and the arrays contain the same bits. The reader in this
//! file follows the two format documents and shares no code with the writer.

use crate::common::{Folder, table};

fn u16_at(bytes: &[u8], at: usize) -> usize {
    usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u16_at(bytes, at) | u16_at(bytes, at + 2) << 16
}

/// CRC-32 bit by bit (polynomial 0xEDB88320, reflected).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & 0_u32.wrapping_sub(crc & 1))
        })
    })
}

/// Members by name, found through the directory at the end of the zip.
fn members(zip: &[u8]) -> Vec<(String, Vec<u8>)> {
    let end = zip.len() - 22;
    assert_eq!(&zip[end..end + 4], b"PK\x05\x06");
    let (count, size, start) = (
        u16_at(zip, end + 10),
        u32_at(zip, end + 12),
        u32_at(zip, end + 16),
    );
    assert_eq!(start + size, end);
    let mut at = start;
    let mut members = Vec::new();
    for _ in 0..count {
        assert_eq!(&zip[at..at + 4], b"PK\x01\x02");
        assert_eq!(u16_at(zip, at + 10), 0, "stored");
        let (sum, size, length) = (
            u32_at(zip, at + 16),
            u32_at(zip, at + 24),
            u16_at(zip, at + 28),
        );
        assert_eq!(u32_at(zip, at + 20), size);
        let local = u32_at(zip, at + 42);
        let name = &zip[at + 46..at + 46 + length];
        assert_eq!(&zip[local..local + 4], b"PK\x03\x04");
        assert_eq!(
            &zip[local + 4..local + 30],
            &zip[at + 6..at + 32],
            "both headers agree"
        );
        let data = local + 30 + length;
        assert_eq!(&zip[local + 30..data], name);
        let data = &zip[data..data + size];
        assert_eq!(crc(data) as usize, sum);
        members.push((
            String::from_utf8(name.to_vec()).expect("ASCII"),
            data.to_vec(),
        ));
        at += 46 + length;
    }
    assert_eq!(at, end);
    members
}

/// Dictionary of the header, and eight bytes per entry.
fn array(npy: &[u8]) -> (String, Vec<u64>) {
    assert_eq!(&npy[..8], b"\x93NUMPY\x01\x00");
    let data = 10 + u16_at(npy, 8);
    assert_eq!(data % 64, 0);
    let header = std::str::from_utf8(&npy[10..data]).expect("ASCII");
    assert!(header.ends_with('\n'));
    let entries = npy[data..].chunks(8);
    let bits = entries.map(|entry| u64::from_le_bytes(entry.try_into().expect("eight bytes")));
    (header.trim_end().to_owned(), bits.collect())
}

#[test]
fn arrays_hold_the_bits_of_the_csv() {
    let folder = Folder::new("npz");
    folder.rotor("run harmonic-rotor --steps 100 --every 30 --out @out");
    let samples = folder.samples("out/trajectory.csv");
    // The start, every thirtieth node, and the end.
    assert_eq!(samples.column("node"), [0.0, 30.0, 60.0, 90.0, 100.0]);

    let zip = folder.bytes("out/trajectory.npz");
    let members = members(&zip);
    // Name, type, shape, columns of the CSV.
    let expected = table::<4>(
        "
        node             | <u8 | (5,)       | node
        time             | <f8 | (5,)       | time
        Lambda           | <f8 | (5, 3, 3,) | Lambda_11 Lambda_12 Lambda_13 Lambda_21 Lambda_22 Lambda_23 Lambda_31 Lambda_32 Lambda_33
        body_momentum    | <f8 | (5, 3,)    | body_momentum_1 body_momentum_2 body_momentum_3
        Gamma            | <f8 | (5, 3,)    | Gamma_1 Gamma_2 Gamma_3
        angle            | <f8 | (5,)       | angle
        invariant_energy | <f8 | (5,)       | invariant_energy
        invariant_across | <f8 | (5, 2,)    | invariant_across_1 invariant_across_2
",
    );
    assert_eq!(members.len(), expected.len());
    for ((file, npy), [name, kind, shape, of]) in members.iter().zip(expected) {
        assert_eq!(*file, format!("{name}.npy"));
        let (header, bits) = array(npy);
        let dictionary =
            format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        assert_eq!(header, dictionary);
        let mut cells = (0..5).flat_map(|row| of.split(' ').map(move |column| (row, column)));
        for bits in bits {
            let (row, column) = cells.next().expect("not more entries than cells");
            let number = samples.at(column, row);
            let expected = if kind == "<u8" {
                number as u64
            } else {
                number.to_bits()
            };
            assert_eq!(bits, expected, "{column} in row {row}");
        }
        assert_eq!(cells.next(), None);
    }
}
