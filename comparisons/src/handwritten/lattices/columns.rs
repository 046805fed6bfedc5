//! One list per component of a site, so that one instruction processes the same component of several sites.

/// Sites processed together: two registers of the widest instruction set.
pub const LANES: usize = 16;

/// `K` lists of the same length.
#[derive(Clone, Debug)]
pub struct Columns<const K: usize> {
    data: Vec<f64>,
    /// Offset between the beginnings of two lists.
    stride: usize,
}

impl<const K: usize> Columns<K> {
    /// Lists of `len` zeros.
    pub fn zeros(len: usize) -> Self {
        // If lists start at the same offset within memory pages, a processor that compares loads with earlier stores by that offset
        // confuses them.
        let stride = len.next_multiple_of(512) + 40;
        Self {
            data: vec![0.0; K * stride],
            stride,
        }
    }

    /// The components of a site.
    #[inline(always)]
    pub fn get(&self, site: usize) -> [f64; K] {
        lane(&self.read::<1>(site), 0)
    }

    /// Sets the components of a site.
    #[inline(always)]
    pub fn set(&mut self, site: usize, numbers: [f64; K]) {
        self.write(site, &numbers.map(|number| [number]));
    }

    /// The components of `L` consecutive sites.
    #[inline(always)]
    pub fn read<const L: usize>(&self, first: usize) -> [[f64; L]; K] {
        let mut rows = [[0.0; L]; K];
        for (k, row) in rows.iter_mut().enumerate() {
            row.copy_from_slice(&self.data[k * self.stride + first..][..L]);
        }
        rows
    }

    /// Sets the components of `L` consecutive sites.
    #[inline(always)]
    pub fn write<const L: usize>(&mut self, first: usize, rows: &[[f64; L]; K]) {
        for (k, row) in rows.iter().enumerate() {
            self.data[k * self.stride + first..][..L].copy_from_slice(row);
        }
    }
}

/// The components of one lane.
#[inline(always)]
pub fn lane<const K: usize, const L: usize>(rows: &[[f64; L]; K], at: usize) -> [f64; K] {
    let mut numbers = [0.0; K];
    for k in 0..K {
        numbers[k] = rows[k][at];
    }
    numbers
}

/// Sets the components of one lane.
#[inline(always)]
pub fn put_lane<const K: usize, const L: usize>(
    rows: &mut [[f64; L]; K],
    at: usize,
    numbers: [f64; K],
) {
    for k in 0..K {
        rows[k][at] = numbers[k];
    }
}

/// Applies a pass to all sites: several at a time, then the remaining ones.
macro_rules! of_sites {
    ($count:expr, $line:ident.$pass:ident) => {
        let whole = $count / $crate::handwritten::lattices::columns::LANES
            * $crate::handwritten::lattices::columns::LANES;
        for first in (0..whole).step_by($crate::handwritten::lattices::columns::LANES) {
            $line.$pass::<{ $crate::handwritten::lattices::columns::LANES }>(first);
        }
        for site in whole..$count {
            $line.$pass::<1>(site);
        }
    };
}

pub(super) use of_sites;
