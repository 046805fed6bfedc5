//! A run in progress, on disk: everything needed to resume it with a bitwise identical result. Takes the words of a
//! trajectory and of its observations; gives a file that is either complete or absent. Reading rejects a file that is
//! damaged or belongs to another version or another run, with the reason.
//!
//! The file contains: a line with name and version; the identity of the run, as lines `key = value`, after their
//! length; the words, after their number; rows and checksum of the samples; a checksum of everything before. Numbers
//! have eight bytes, little-endian.

use crate::case_file::quantity_of;
use crate::plan::Plan;
use clebsch::card::{Card, Field};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// The name of the file.
pub(crate) const NAME: &str = "checkpoint";

/// The name during writing.
pub(crate) const UNFINISHED: &str = "checkpoint.new";

/// How every file begins, before its version.
const MAGIC: &str = "clebsch checkpoint ";

/// The version that is written, and the only version that is read.
const VERSION: &str = "5";

/// Bytes written at once.
const BUFFER: usize = 1 << 18;

/// The largest number of values that are listed one by one.
const TOLD: usize = 100;

/// The identity of a run: the values that must agree for one run to resume another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identity(Vec<(String, String)>);

impl Identity {
    /// The identity of a plan.
    pub(crate) fn of(card: &Card, plan: &Plan) -> Self {
        let text = |x: &dyn std::fmt::Debug| format!("{x:?}");
        let case = &plan.case;
        let mut all = vec![
            (
                "version of clebsch".to_owned(),
                env!("CARGO_PKG_VERSION").to_owned(),
            ),
            ("model".to_owned(), card.kebab.to_owned()),
            (
                "fingerprint of the model".to_owned(),
                format!("{:016x}", card.fingerprint),
            ),
            ("h".to_owned(), text(&case.h)),
            ("steps".to_owned(), text(&case.steps)),
            ("every".to_owned(), text(&plan.every)),
            ("order".to_owned(), text(&plan.order)),
            (
                "solver".to_owned(),
                text(&plan.solver.map(|solver| solver.name())),
            ),
            ("compensated".to_owned(), text(&plan.compensated)),
            ("halve".to_owned(), text(&plan.halve)),
        ];
        all.extend(compared_values(
            "parameters",
            card.parameters,
            &case.parameters,
        ));
        all.extend(compared_values("initial", card.initial, &case.initial));
        Self(all)
    }

    /// The identity with one more value that must agree.
    pub(crate) fn with(mut self, key: &str, value: String) -> Self {
        self.0.push((key.to_owned(), value));
        self
    }

    fn text(&self) -> String {
        let lines = self.0.iter();
        lines
            .map(|(key, value)| format!("{key} = {value}\n"))
            .collect()
    }

    /// The difference from another run, if there is one.
    fn unlike(&self, found: &str) -> Option<String> {
        let own = self.text();
        if own == found {
            return None;
        }
        let mut pairs = own.lines().zip(found.lines());
        Some(match pairs.find(|(a, b)| a != b) {
            Some((here, there)) => {
                format!("it belongs to another run: it has {there}, but this run has {here}")
            }
            None => "it belongs to another run, with other values".to_owned(),
        })
    }
}

/// The values of a table in a form for comparison: field by field. A quantity at many sites forms one entry.
fn compared_values(table: &str, fields: &[Field], values: &[Vec<f64>]) -> Vec<(String, String)> {
    let mut sites: BTreeMap<&str, usize> = BTreeMap::new();
    for quantity in fields.iter().filter_map(|f| quantity_of(f.ascii)) {
        *sites.entry(quantity).or_default() += 1;
    }
    sites.retain(|_, count| *count > TOLD);
    let mut all = Vec::new();
    let mut together: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (field, value) in fields.iter().zip(values) {
        match quantity_of(field.ascii).filter(|q| sites.contains_key(q)) {
            Some(quantity) => together.entry(quantity).or_default().extend(value),
            None => all.push((format!("{table}.{}", field.ascii), listed(value))),
        }
    }
    for (quantity, values) in together {
        all.push((format!("{table}.{quantity}"), listed(&values)));
    }
    all
}

/// Numbers in a form for comparison. A long list is represented by its length and a checksum.
fn listed(values: &[f64]) -> String {
    if values.len() <= TOLD {
        return format!("{values:?}");
    }
    let mut sum = crc32fast::Hasher::new();
    values.iter().for_each(|x| sum.update(&x.to_le_bytes()));
    let (count, sum) = (values.len(), sum.finalize());
    format!("{count} numbers with the checksum {sum:08x}")
}

/// The content of a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Checkpoint {
    /// The state of the trajectory.
    pub(crate) trajectory: Vec<u64>,
    /// The state of the observations.
    pub(crate) watch: Vec<u64>,
    /// Rows of the samples.
    pub(crate) rows: u64,
    /// Their checksum.
    pub(crate) sum: u32,
}

impl Checkpoint {
    /// Writes the checkpoint in small pieces, so that the numbers of a million particles are not copied in
    /// memory.
    pub(crate) fn put(&self, identity: &Identity, out: impl Write) -> io::Result<()> {
        let mut out = ChecksumWriter {
            out: BufWriter::with_capacity(BUFFER, out),
            sum: crc32fast::Hasher::new(),
        };
        let text = identity.text();
        out.write_all(format!("{MAGIC}{VERSION}\n").as_bytes())?;
        out.write_all(&(text.len() as u64).to_le_bytes())?;
        out.write_all(text.as_bytes())?;
        for list in [&self.trajectory, &self.watch] {
            out.write_all(&(list.len() as u64).to_le_bytes())?;
            for words in list.chunks(BUFFER / 8) {
                let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                out.write_all(&bytes)?;
            }
        }
        out.write_all(&self.rows.to_le_bytes())?;
        out.write_all(&u64::from(self.sum).to_le_bytes())?;
        let ChecksumWriter { mut out, sum } = out;
        out.write_all(&u64::from(sum.finalize()).to_le_bytes())?;
        out.flush()
    }

    /// Writes the file under a temporary name, flushes it to disk, and renames it atomically. Whenever the
    /// machine stops, the last checkpoint or the one before is present.
    pub(crate) fn write(&self, folder: &Path, identity: &Identity) -> io::Result<()> {
        let unfinished = folder.join(UNFINISHED);
        let file = File::create(&unfinished)?;
        self.put(identity, &file)?;
        file.sync_all()?;
        fs::rename(&unfinished, folder.join(NAME))?;
        // Flushes the name as well, if the system can flush folders.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }

    /// Reads the file in `folder` for the run `identity`.
    ///
    /// # Errors
    /// The reason why the run cannot be resumed, in words.
    pub(crate) fn read(folder: &Path, identity: &Identity) -> Result<Self, String> {
        let bytes = fs::read(folder.join(NAME)).map_err(|e| format!("it cannot be read: {e}"))?;
        Self::of_bytes(&bytes, identity)
    }

    /// Reads a checkpoint from bytes.
    pub(crate) fn of_bytes(bytes: &[u8], identity: &Identity) -> Result<Self, String> {
        let Some(rest) = bytes.strip_prefix(MAGIC.as_bytes()) else {
            return Err("it is not a checkpoint".to_owned());
        };
        let line = rest.iter().position(|byte| *byte == b'\n').unwrap_or(0);
        let (version, rest) = rest.split_at(line);
        let version = String::from_utf8_lossy(version);
        if version != VERSION {
            return Err(format!(
                "its format has version {}, but this program reads version {VERSION}",
                version.escape_debug()
            ));
        }
        let damaged = || "it is damaged: its checksum does not match its contents".to_owned();
        let Some((contents, sum)) = bytes.split_last_chunk::<8>() else {
            return Err(damaged());
        };
        if u64::from_le_bytes(*sum) != u64::from(crc32fast::hash(contents)) {
            return Err(damaged());
        }
        let mut rest = UnreadBytes(
            rest.get(1..rest.len().saturating_sub(8))
                .unwrap_or_default(),
        );
        let cut = "it is truncated";
        let text = rest.count().and_then(|n| rest.take(n)).ok_or(cut)?;
        if let Some(why) = identity.unlike(&String::from_utf8_lossy(text)) {
            return Err(why);
        }
        let trajectory = rest.list().ok_or(cut)?;
        let watch = rest.list().ok_or(cut)?;
        let rows = rest.word().ok_or(cut)?;
        let sum = rest.word().and_then(|sum| u32::try_from(sum).ok());
        Ok(Self {
            trajectory,
            watch,
            rows,
            sum: sum.ok_or(cut)?,
        })
    }
}

/// A writer that computes the checksum of its output.
struct ChecksumWriter<W> {
    out: W,
    sum: crc32fast::Hasher,
}

impl<W: Write> ChecksumWriter<W> {
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sum.update(bytes);
        self.out.write_all(bytes)
    }
}

/// The bytes that remain to be read.
struct UnreadBytes<'a>(&'a [u8]);

impl<'a> UnreadBytes<'a> {
    fn take(&mut self, bytes: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.0.split_at_checked(bytes)?;
        self.0 = left;
        Some(taken)
    }

    fn word(&mut self) -> Option<u64> {
        let eight = self.take(8)?.first_chunk::<8>()?;
        Some(u64::from_le_bytes(*eight))
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.word()?).ok()
    }

    fn list(&mut self) -> Option<Vec<u64>> {
        let count = self.count()?;
        let bytes = self.take(count.checked_mul(8)?)?;
        Some(
            bytes
                .as_chunks::<8>()
                .0
                .iter()
                .map(|x| u64::from_le_bytes(*x))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{Checkpoint, Identity, VERSION, compared_values, listed};
    use clebsch::card::{Field, Kind};

    fn identity(h: &str) -> Identity {
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        Identity(vec![pair("model", "top"), pair("h", h)])
    }

    fn bytes(checkpoint: &Checkpoint, identity: &Identity) -> Vec<u8> {
        let mut out = Vec::new();
        checkpoint.put(identity, &mut out).expect("is written");
        out
    }

    fn sample() -> Checkpoint {
        Checkpoint {
            trajectory: vec![1, u64::MAX, 0],
            watch: Vec::new(),
            rows: 7,
            sum: 0xdead_beef,
        }
    }

    /// Positions and momenta of `sites` sites, as on the card of a chain, and a number without a site.
    fn fields(sites: usize) -> (Vec<Field>, Vec<Vec<f64>>) {
        let field = |name: &str| {
            let name: &'static str = Box::leak(name.to_owned().into_boxed_str());
            Kind::Scalar.field(name, [1, 1], "").spelt(name)
        };
        let at_site = |site: usize| ["X", "momentum_X"].map(|of| field(&format!("{of}_{site}")));
        let fields = (0..sites).flat_map(at_site).chain([field("c0")]);
        let fields: Vec<Field> = fields.collect();
        let values = (0..fields.len()).map(|i| vec![i as f64]).collect();
        (fields, values)
    }

    #[test]
    fn values_at_many_sites_are_told_together_and_those_at_few_one_by_one() {
        let (few, values) = fields(3);
        let all = compared_values("initial", &few, &values);
        assert_eq!(all.len(), 7);
        assert_eq!(
            all[3],
            ("initial.momentum_X_1".to_owned(), "[3.0]".to_owned())
        );
        let (many, values) = fields(200);
        let all = compared_values("initial", &many, &values);
        let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["initial.c0", "initial.X", "initial.momentum_X"]);
        // Every value and its position count.
        for (site, other) in [(57, 0.5), (399, -1.0), (400, 2.0)] {
            let mut changed = values.clone();
            changed[site] = vec![other];
            assert_ne!(compared_values("initial", &many, &changed), all);
        }
        let mut changed = values.clone();
        changed.swap(2, 4);
        assert_ne!(compared_values("initial", &many, &changed), all);
    }

    #[test]
    fn what_is_written_is_read() {
        let bytes = bytes(&sample(), &identity("0.1"));
        assert_eq!(Checkpoint::of_bytes(&bytes, &identity("0.1")), Ok(sample()));
    }

    #[test]
    fn every_flipped_bit_and_every_cut_is_noticed() {
        let bytes = bytes(&sample(), &identity("0.1"));
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut other = bytes.clone();
                other[at] ^= 1 << bit;
                assert!(
                    Checkpoint::of_bytes(&other, &identity("0.1")).is_err(),
                    "{at} {bit}"
                );
            }
            assert!(
                Checkpoint::of_bytes(&bytes[..at], &identity("0.1")).is_err(),
                "{at}"
            );
        }
    }

    #[test]
    fn another_run_is_told_by_what_differs() {
        let bytes = bytes(&sample(), &identity("0.1"));
        let why = Checkpoint::of_bytes(&bytes, &identity("0.2"));
        assert_eq!(
            why,
            Err("it belongs to another run: it has h = 0.1, but this run has h = 0.2".to_owned())
        );
        let [one, other] = [0.0, 1.0].map(|last| {
            let mut list = vec![0.5; 1000];
            list[999] = last;
            listed(&list)
        });
        assert!(
            one != other && one.starts_with("1000 numbers"),
            "{one} {other}"
        );
        assert_eq!(listed(&[0.5, 1.0]), "[0.5, 1.0]");
        let later = String::from_utf8_lossy(&bytes[..21]).replace(VERSION, "9");
        let why = Checkpoint::of_bytes(later.as_bytes(), &identity("0.1"));
        assert_eq!(
            why,
            Err(format!(
                "its format has version 9, but this program reads version {VERSION}"
            ))
        );
    }
}
