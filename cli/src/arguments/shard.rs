//! A part of a sweep, from `--shard`. Takes a text; gives the points of the part.

/// A part of a sweep: `3/16`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    pub(crate) part: u64,
    pub(crate) of: u64,
}

impl Shard {
    /// Reads `PART/OF`, counted from 1.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        match numbers {
            Some((part, of)) if 1 <= part && part <= of => Ok(Self { part, of }),
            _ => Err("give PART/OF, such as 3/16; parts count from 1".to_owned()),
        }
    }

    /// The points from the first to before the second.
    pub(crate) fn points(self, all: u64) -> (u64, u64) {
        let before = |part: u64| {
            let share = u128::from(all) * u128::from(part) / u128::from(self.of);
            u64::try_from(share).unwrap_or(all)
        };
        (before(self.part - 1), before(self.part))
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn parts_cover_every_point_once() {
        for all in [0, 1, 5, 16, 1_000_000_000] {
            for of in [1, 3, 16, 17] {
                let ends = (1..=of).map(|part| Shard { part, of }.points(all));
                let mut next = 0;
                for (first, end) in ends {
                    assert_eq!(first, next);
                    assert!(end >= first && end - first <= all / of + 1);
                    next = end;
                }
                assert_eq!(next, all);
            }
        }
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0", "-1/2"] {
            assert!(Shard::read(wrong).is_err(), "{wrong}");
        }
    }
}
