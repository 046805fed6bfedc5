//! Saves a state, a workspace or a whole trajectory outside the program, to resume it later bit for bit.
//! Takes a value that is [`Saved`]; gives words with a checksum, as bytes or, with the feature `serde`, as text.
//!
//! The bytes: `clebsch`, a version, the number of words, the words, a checksum of everything before it; numbers are
//! little-endian.

use crate::card::Trajectory;
use crate::saved::{Saved, Words};
use core::fmt;

/// How the bytes begin; the last one is the version.
const HEADER: [u8; 8] = *b"clebsch\x01";

/// The saved state of a trajectory.
///
/// A snapshot contains the parts that change from step to step. It does not contain the parameters, the step size and
/// the settings, so restore it into a value that was started from the same data. The value then continues bit for bit
/// as the original. If steps depend on earlier ones, save the workspace as well as the state. The workspace of a chain
/// is computed anew from the state, and such a run continues up to rounding.
///
/// A trajectory opened from a card rejects the snapshot of another model. A state or a workspace accepts any snapshot
/// with the same number of words.
///
/// ```
/// use clebsch::Snapshot;
/// use clebsch::nalgebra::Vector3;
///
/// let mut place = Vector3::new(0.1, 0.2, 0.3);
/// let kept = Snapshot::of(&place)?.to_bytes(); // into a file
/// place *= 2.0;
/// Snapshot::from_bytes(&kept)?.put_into(&mut place)?;
/// assert_eq!(place, Vector3::new(0.1, 0.2, 0.3));
/// # Ok::<(), clebsch::SnapshotError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    words: Vec<u64>,
}

/// Why a snapshot cannot be taken, read or restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The trajectory has parts that cannot be saved.
    NotSaved,
    /// It was taken from a value of another kind or another size.
    Unlike {
        /// The number of its words.
        words: usize,
    },
    /// The bytes are not a snapshot, or have a version that this program does not know.
    Foreign,
    /// It was changed or truncated after it was written.
    Damaged,
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSaved => f.write_str(
                "this trajectory has parts that cannot be saved; implement `Trajectory::words` for it",
            ),
            Self::Unlike { words } => write!(
                f,
                "the snapshot, of {words} words, belongs to a value of another kind or size; start the model from the same \
                 data as the snapshot"
            ),
            Self::Foreign => f.write_str(
                "this is not a snapshot of this version: it must begin with `clebsch` and the version 1",
            ),
            Self::Damaged => f.write_str(
                "the snapshot was changed or truncated after it was written: its checksum differs; use an earlier one",
            ),
        }
    }
}

impl std::error::Error for SnapshotError {}

impl Snapshot {
    /// Takes a snapshot of a value.
    ///
    /// # Errors
    /// [`SnapshotError::NotSaved`].
    pub fn of<S: Saved + Clone>(value: &S) -> Result<Self, SnapshotError> {
        Self::gathered(|words| value.clone().words(words))
    }

    /// Takes a snapshot of a trajectory opened from a card.
    ///
    /// # Errors
    /// [`SnapshotError::NotSaved`] if the trajectory does not implement [`Trajectory::words`].
    pub fn of_trajectory(running: &mut dyn Trajectory) -> Result<Self, SnapshotError> {
        Self::gathered(|words| {
            words.same(running.card().fingerprint);
            running.words(words);
        })
    }

    fn gathered(meet: impl FnOnce(&mut Words)) -> Result<Self, SnapshotError> {
        let mut words = Words::gathered();
        meet(&mut words);
        let words = words.into_list().ok_or(SnapshotError::NotSaved)?;
        Ok(Self { words })
    }

    /// Restores the snapshot into a value started from the same data.
    ///
    /// # Errors
    /// [`SnapshotError::Unlike`]; the value is then unchanged.
    pub fn put_into<S: Saved + Clone>(&self, value: &mut S) -> Result<(), SnapshotError> {
        let mut put = value.clone();
        self.given(|words| put.words(words))?;
        *value = put;
        Ok(())
    }

    /// Restores the snapshot into a trajectory opened from the same data.
    ///
    /// # Errors
    /// [`SnapshotError::Unlike`]; then open the trajectory anew, since a part of it may have changed.
    pub fn put_into_trajectory(&self, running: &mut dyn Trajectory) -> Result<(), SnapshotError> {
        self.given(|words| {
            words.same(running.card().fingerprint);
            running.words(words);
        })
    }

    fn given(&self, meet: impl FnOnce(&mut Words)) -> Result<(), SnapshotError> {
        let mut words = Words::given(self.words.clone());
        meet(&mut words);
        match words.all_put() {
            true => Ok(()),
            false => Err(SnapshotError::Unlike {
                words: self.words.len(),
            }),
        }
    }

    /// The bytes to keep.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = HEADER.to_vec();
        bytes.extend((self.words.len() as u64).to_le_bytes());
        bytes.extend(self.words.iter().flat_map(|word| word.to_le_bytes()));
        bytes.extend(checksum(&bytes).to_le_bytes());
        bytes
    }

    /// Reads the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// [`SnapshotError::Foreign`], [`SnapshotError::Damaged`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SnapshotError> {
        let rest = bytes.strip_prefix(&HEADER).ok_or(SnapshotError::Foreign)?;
        let (list, []) = rest.as_chunks::<8>() else {
            return Err(SnapshotError::Damaged);
        };
        let [count, words @ .., sum] = list else {
            return Err(SnapshotError::Damaged);
        };
        let end = bytes.len() - sum.len();
        let whole = u64::from_le_bytes(*count) == words.len() as u64
            && u64::from_le_bytes(*sum) == checksum(&bytes[..end]);
        match whole {
            true => Ok(Self {
                words: words.iter().map(|word| u64::from_le_bytes(*word)).collect(),
            }),
            false => Err(SnapshotError::Damaged),
        }
    }
}

/// FNV-1a of 64 bits: a change of any single byte changes it.
fn checksum(bytes: &[u8]) -> u64 {
    let mixed = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mixed)
}

/// As text: the bytes of [`Snapshot::to_bytes`] in hexadecimal digits, for any format.
#[cfg(feature = "serde")]
mod as_text {
    use super::Snapshot;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    impl Serialize for Snapshot {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let digits: String = self.to_bytes().iter().map(|b| format!("{b:02x}")).collect();
            serializer.serialize_str(&digits)
        }
    }

    impl<'de> Deserialize<'de> for Snapshot {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let digits = String::deserialize(deserializer)?;
            let pairs = digits.as_bytes().chunks(2);
            let byte = |pair: &[u8]| {
                let text = core::str::from_utf8(pair).ok()?;
                (text.len() == 2).then(|| u8::from_str_radix(text, 16).ok())?
            };
            let bytes: Option<Vec<u8>> = pairs.map(byte).collect();
            let bytes = bytes
                .ok_or_else(|| D::Error::custom("these are not pairs of hexadecimal digits"))?;
            Self::from_bytes(&bytes).map_err(D::Error::custom)
        }
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use serde::de::IntoDeserializer;
        use serde::de::value::{Error as ValueError, StrDeserializer};

        fn read(text: &str) -> Result<Snapshot, ValueError> {
            let from: StrDeserializer<'_, ValueError> = text.into_deserializer();
            Snapshot::deserialize(from)
        }

        #[test]
        fn digits_are_read_back_and_others_refused() {
            let kept = Snapshot {
                words: vec![1, u64::MAX, 0x0123_4567_89ab_cdef],
            };
            let digits: String = kept.to_bytes().iter().map(|b| format!("{b:02x}")).collect();
            assert_eq!(read(&digits), Ok(kept));
            assert!(read(&digits[1..]).is_err());
            assert!(read(&digits.replace('0', "é")).is_err());
            assert!(read("").is_err());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_changed_byte_and_every_cut_is_noticed() {
        let kept = Snapshot::of(&[0.1_f64, -3.0, f64::NAN, 0.0]).unwrap();
        let bytes = kept.to_bytes();
        assert_eq!(Snapshot::from_bytes(&bytes), Ok(kept));
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 0x10;
            assert!(Snapshot::from_bytes(&changed).is_err(), "byte {at}");
            assert!(Snapshot::from_bytes(&bytes[..at]).is_err(), "cut at {at}");
        }
    }

    #[test]
    fn a_value_of_another_size_refuses_and_is_unchanged() {
        let kept = Snapshot::of(&[1.0_f64, 2.0, 3.0]).unwrap();
        let mut shorter = [7.0, 8.0];
        assert_eq!(
            kept.put_into(&mut shorter),
            Err(SnapshotError::Unlike { words: 3 })
        );
        assert_eq!(shorter, [7.0, 8.0]);
        let mut longer = [7.0; 4];
        assert!(kept.put_into(&mut longer).is_err());
        assert_eq!(longer, [7.0; 4]);
    }
}
