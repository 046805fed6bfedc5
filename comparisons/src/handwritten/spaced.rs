//! Storage of a trajectory's numbers between two steps, with gaps that keep the compiler from loading neighbours together. A
//! 16-byte load of two numbers that were stored separately a few cycles earlier waits until both stores have left the store buffer.
//! In a step of about fifty cycles that wait is the largest single cost (measured: one third).

use super::attitude::{Quaternion, Vector};

/// Three numbers with gaps between them.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SpacedVector {
    x: f64,
    gap_x: u64,
    y: f64,
    gap_y: u64,
    z: f64,
    gap_z: u64,
}

impl SpacedVector {
    /// Stores a vector.
    #[inline(always)]
    pub fn new([x, y, z]: Vector) -> SpacedVector {
        SpacedVector {
            x,
            gap_x: 0,
            y,
            gap_y: 0,
            z,
            gap_z: 0,
        }
    }

    /// Overwrites the vector and leaves the gaps unchanged.
    #[inline(always)]
    pub fn set(&mut self, [x, y, z]: Vector) {
        self.x = x;
        self.y = y;
        self.z = z;
    }

    /// The stored vector.
    #[inline(always)]
    pub fn get(&self) -> Vector {
        [self.x, self.y, self.z]
    }
}

/// A quaternion as two pairs, each stored and loaded together.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SpacedQuaternion {
    wx: [f64; 2],
    gap_wx: u64,
    yz: [f64; 2],
    gap_yz: u64,
}

impl SpacedQuaternion {
    /// Stores a quaternion.
    #[inline(always)]
    pub fn new(q: Quaternion) -> SpacedQuaternion {
        let [w, x, y, z] = q.0;
        SpacedQuaternion {
            wx: [w, x],
            gap_wx: 0,
            yz: [y, z],
            gap_yz: 0,
        }
    }

    /// Overwrites the quaternion and leaves the gaps unchanged.
    #[inline(always)]
    pub fn set(&mut self, q: Quaternion) {
        let [w, x, y, z] = q.0;
        self.wx = [w, x];
        self.yz = [y, z];
    }

    /// The stored quaternion.
    #[inline(always)]
    pub fn get(&self) -> Quaternion {
        let ([w, x], [y, z]) = (self.wx, self.yz);
        Quaternion([w, x, y, z])
    }
}
