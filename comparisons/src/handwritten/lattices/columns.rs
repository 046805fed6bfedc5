//! A list for each of the numbers that a site has, so that one instruction takes the same number of several sites.
//! Takes and gives numbers of one site, or of some sites side by side.

/// Sites that are computed together: two registers of the widest instruction set.
pub const LANES: usize = 16;

/// `K` lists of the same length.
#[derive(Clone, Debug)]
pub struct Columns<const K: usize> {
    data: Vec<f64>,
    /// From where a list begins to where the next one does.
    stride: usize,
}

impl<const K: usize> Columns<K> {
    /// Lists of so many zeros.
    pub fn zeros(len: usize) -> Self {
        // Lists that begin at the same place of their pages of memory are taken for one another by a processor that
        // compares a load with earlier stores by that place.
        let stride = len.next_multiple_of(512) + 40;
        Self {
            data: vec![0.0; K * stride],
            stride,
        }
    }

    /// The numbers of a site.
    #[inline(always)]
    pub fn get(&self, site: usize) -> [f64; K] {
        lane(&self.read::<1>(site), 0)
    }

    /// Other numbers of a site.
    #[inline(always)]
    pub fn set(&mut self, site: usize, numbers: [f64; K]) {
        self.write(site, &numbers.map(|number| [number]));
    }

    /// The numbers of `L` sites from one on.
    #[inline(always)]
    pub fn read<const L: usize>(&self, first: usize) -> [[f64; L]; K] {
        let mut rows = [[0.0; L]; K];
        for (k, row) in rows.iter_mut().enumerate() {
            row.copy_from_slice(&self.data[k * self.stride + first..][..L]);
        }
        rows
    }

    /// Other numbers of `L` sites from one on.
    #[inline(always)]
    pub fn write<const L: usize>(&mut self, first: usize, rows: &[[f64; L]; K]) {
        for (k, row) in rows.iter().enumerate() {
            self.data[k * self.stride + first..][..L].copy_from_slice(row);
        }
    }
}

/// The numbers of one of the sites that are side by side.
#[inline(always)]
pub fn lane<const K: usize, const L: usize>(rows: &[[f64; L]; K], at: usize) -> [f64; K] {
    let mut numbers = [0.0; K];
    for k in 0..K {
        numbers[k] = rows[k][at];
    }
    numbers
}

/// Puts the numbers of one of the sites that are side by side.
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

/// Does something with all sites, several together and then those that are left over.
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
