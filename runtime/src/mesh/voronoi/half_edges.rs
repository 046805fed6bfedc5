//! A triangulated torus as half-edges, three for each triangle, counterclockwise. Each half-edge stores its origin, its
//! twin, and the number of periods to the copy of the site at its end. A triangle may be adjacent to itself, and two
//! sites may share several edges, as in the mesh of a single site.

/// Half-edges of triangles: `3 t`, `3 t + 1`, `3 t + 2` go around triangle `t`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct HalfEdges {
    /// The site at which each half-edge starts.
    pub origin: Vec<u32>,
    /// The opposite half-edge, in the triangle on the right.
    pub twin: Vec<u32>,
    /// The whole periods along each direction that belong to the vector of the edge:
    /// `place[target] - place[origin] + offset * period`.
    pub offset: Vec<[i16; 2]>,
}

/// The next half-edge in the triangle.
#[inline(always)]
pub(super) fn next(e: usize) -> usize {
    if e % 3 == 2 { e - 2 } else { e + 1 }
}

/// The previous half-edge in the triangle.
#[inline(always)]
pub(super) fn previous(e: usize) -> usize {
    if e.is_multiple_of(3) { e + 2 } else { e - 1 }
}

fn sum(a: [i16; 2], b: [i16; 2]) -> [i16; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn negative(a: [i16; 2]) -> [i16; 2] {
    [-a[0], -a[1]]
}

impl HalfEdges {
    /// The torus with a single site: a rectangle with its diagonal.
    pub fn with_one_site(&mut self, site: u32) {
        self.origin.clear();
        self.twin.clear();
        self.offset.clear();
        self.origin.extend([site; 6]);
        self.twin.extend([3, 4, 5, 0, 1, 2]);
        self.offset
            .extend([[1, 0], [0, 1], [-1, -1], [-1, 0], [0, -1], [1, 1]]);
    }

    /// The number of half-edges.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// The site at which a half-edge ends.
    #[inline(always)]
    pub fn target(&self, e: usize) -> usize {
        self.origin[next(e)] as usize
    }

    /// Makes two half-edges twins.
    fn glue(&mut self, e: usize, f: usize) {
        self.twin[e] = f as u32;
        self.twin[f] = e as u32;
    }

    /// Replaces an edge by the other diagonal of its two triangles; returns the four sides of the quadrilateral.
    ///
    /// ```text
    ///        c                  c
    ///      /   \              / | \
    ///    a --e-> b    ->    a   |   b
    ///      \   /              \ | /
    ///        d                  d
    /// ```
    pub fn flip(&mut self, e: usize) -> [usize; 4] {
        let f = self.twin[e] as usize;
        let (from_c, from_d) = (previous(e), previous(f)); // c -> a, d -> b
        let (right_of_c, right_of_d) = (self.twin[from_c] as usize, self.twin[from_d] as usize);
        let (c, d) = (self.origin[from_c], self.origin[from_d]);
        let to_a = self.offset[from_c];
        let to_b = self.offset[from_d];
        // The path from c to d through a.
        let diagonal = sum(to_a, self.offset[next(f)]);
        self.origin[e] = d;
        self.origin[f] = c;
        self.offset[e] = to_b;
        self.offset[f] = to_a;
        self.offset[from_c] = diagonal;
        self.offset[from_d] = negative(diagonal);
        self.glue(from_c, from_d);
        // The two triangles may also share a second side.
        if right_of_d == from_c {
            self.glue(e, f);
        } else {
            self.glue(e, right_of_d);
            self.glue(f, right_of_c);
        }
        [e, next(e), f, next(f)]
    }

    /// Inserts a site into triangle `t` and divides it into three triangles. `to_site` are the offsets of the edges
    /// from the corners to the site. Returns the sides of the triangle.
    pub fn divide(&mut self, t: usize, site: u32, to_site: [[i16; 2]; 3]) -> [usize; 3] {
        let first = 3 * t;
        let second = self.len();
        let third = second + 3;
        let corners = [0, 1, 2].map(|k| self.origin[first + k]);
        let offsets = [0, 1, 2].map(|k| self.offset[first + k]);
        let outside = [0, 1, 2].map(|k| self.twin[first + k] as usize);
        self.origin.extend_from_slice(&[0; 6]);
        self.twin.extend_from_slice(&[0; 6]);
        self.offset.extend_from_slice(&[[0; 2]; 6]);
        let sides = [first, second, third];
        for k in 0..3 {
            let (side, other) = (sides[k], (k + 1) % 3);
            self.origin[side] = corners[k];
            self.origin[side + 1] = corners[other];
            self.origin[side + 2] = site;
            self.offset[side] = offsets[k];
            self.offset[side + 1] = to_site[other];
            self.offset[side + 2] = negative(to_site[k]);
        }
        for k in 0..3 {
            self.glue(sides[k] + 1, sides[(k + 1) % 3] + 2);
            self.glue(sides[k], outside[k]);
        }
        sides
    }

    /// Renumbers the triangles in the order of the sites, so that neighbours are close in memory.
    pub fn sort_by_sites(&mut self, sites: usize) {
        let triangles = self.len() / 3;
        let mut leaving = vec![u32::MAX; sites];
        for (e, &site) in self.origin.iter().enumerate().rev() {
            leaving[site as usize] = e as u32;
        }
        const UNSEEN: u32 = u32::MAX;
        let mut number = vec![UNSEEN; triangles];
        let mut order = Vec::with_capacity(triangles);
        for &start in leaving.iter().filter(|&&e| e != u32::MAX) {
            let mut e = start as usize;
            loop {
                if number[e / 3] == UNSEEN {
                    number[e / 3] = order.len() as u32;
                    order.push(e / 3);
                }
                e = self.twin[previous(e)] as usize;
                if e == start as usize {
                    break;
                }
            }
        }
        let old = self.clone();
        for (new, &t) in order.iter().enumerate() {
            for k in 0..3 {
                let twin = old.twin[3 * t + k];
                self.origin[3 * new + k] = old.origin[3 * t + k];
                self.offset[3 * new + k] = old.offset[3 * t + k];
                self.twin[3 * new + k] = 3 * number[twin as usize / 3] + twin % 3;
            }
        }
    }
}
