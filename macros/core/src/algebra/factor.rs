//! Factors of a word: letters in one of four modes, unit vectors, hats and axial vectors, with
//! their shapes and transposes. Words are sequences of factors whose shapes chain.

use super::Algebra;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::{Letter, within};

/// Where a letter of a word comes from.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Source {
    /// A symbol at an offset.
    Letter(Letter),
    /// An interned sub-expression.
    Opaque(u32),
    /// The rotation of a quaternion or a rigid motion.
    Rotation(Letter),
    /// The translation of a rigid motion.
    Translation(Letter),
}

/// One factor of a word.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Factor {
    /// A matrix or vector letter.
    Letter {
        /// Where the factor comes from.
        source: Source,
        /// Whether it is transposed (for orthogonal letters: inverted).
        transposed: bool,
        /// Whether it is inverted (never set for orthogonal letters).
        inverted: bool,
    },
    /// A unit vector.
    Unit {
        /// Its dimension.
        dim: Dim,
        /// Its axis, counted from 0.
        axis: u8,
        /// Whether it is a row.
        transposed: bool,
    },
    /// The axial vector of a skew 3 x 3 letter: such letters are always written `hat(axial)`, so that the rules for
    /// hats apply to them too.
    Axial {
        /// The skew letter.
        source: Source,
        /// Whether it is a row.
        transposed: bool,
    },
    /// The zero-padding inclusion of a vector space into one of higher dimension.
    Inclusion {
        /// Its shape when not transposed: more rows than columns.
        shape: Shape,
        /// The first of the rows that it fills, counted from 0.
        at: u8,
        /// Whether it is the projection instead.
        transposed: bool,
    },
    /// The skew matrix of a vector word.
    Hat(Word),
    /// The left multiplication by a vector word, 4 x 4 and skew.
    Pure(Word),
    /// The imaginary part of a 4 x 4 word.
    Imaginary {
        /// The matrix word.
        word: Word,
        /// Whether it is a row.
        transposed: bool,
    },
    /// The axial vector of a matrix word.
    Vee {
        /// The matrix word.
        word: Word,
        /// Whether it is a row.
        transposed: bool,
    },
}

/// A product of factors; the empty word is the identity.
pub type Word = Vec<Factor>;

impl Algebra<'_> {
    /// The shape of a factor; transposed if the factor is.
    pub(super) fn shape_of(&self, f: &Factor) -> Shape {
        let (shape, transposed) = match f {
            Factor::Letter {
                source, transposed, ..
            } => (self.source_shape(*source), *transposed),
            Factor::Unit {
                dim, transposed, ..
            } => (Shape::vector(*dim), *transposed),
            Factor::Inclusion {
                shape, transposed, ..
            } => (*shape, *transposed),
            Factor::Hat(_) => return Shape::square(Dim::Fixed(3)),
            Factor::Pure(_) => return Shape::square(Dim::Fixed(4)),
            Factor::Axial { transposed, .. }
            | Factor::Vee { transposed, .. }
            | Factor::Imaginary { transposed, .. } => (Shape::vector(Dim::Fixed(3)), *transposed),
        };
        if transposed {
            shape.transposed()
        } else {
            shape
        }
    }

    fn source_shape(&self, source: Source) -> Shape {
        match source {
            Source::Letter(at) => self.symbols.get(at.symbol).shape,
            Source::Opaque(i) => self.matrices.borrow()[i as usize].meaning.shape(),
            Source::Rotation(at) => Shape::square(self.space_of(at)),
            Source::Translation(at) => Shape::vector(self.space_of(at)),
        }
    }

    /// The dimension of the space that a quaternion or a rigid motion moves.
    fn space_of(&self, at: Letter) -> Dim {
        within(self.symbols.get(at.symbol).shape.rows)
    }

    /// Structure of a letter.
    pub(super) fn structure(&self, source: Source) -> Structure {
        match source {
            Source::Letter(at) => self.symbols.get(at.symbol).structure,
            Source::Rotation(_) => Structure::Orthogonal,
            Source::Translation(_) => Structure::General,
            Source::Opaque(i) => {
                let table = self.matrices.borrow();
                let key = &table[i as usize].key;
                if key.symmetric {
                    Structure::Symmetric
                } else {
                    Structure::General
                }
            }
        }
    }

    /// Whether the factor is an element of an orthogonal group.
    pub(super) fn is_orthogonal(&self, f: &Factor) -> bool {
        matches!(f, Factor::Letter { source, .. } if self.structure(*source).is_orthogonal())
    }

    /// The transpose of a factor, with the sign for skew factors.
    pub(super) fn transposed(&self, f: &Factor) -> (bool, Factor) {
        match f {
            Factor::Letter {
                source,
                transposed,
                inverted,
            } => {
                let structure = self.structure(*source);
                let flip = match structure {
                    Structure::Symmetric | Structure::Diagonal | Structure::Skew => false,
                    Structure::General
                    | Structure::Orthogonal
                    | Structure::Invertible
                    | Structure::UnitQuaternion
                    | Structure::RigidMotion => true,
                };
                let factor = Factor::Letter {
                    source: *source,
                    transposed: *transposed ^ flip,
                    inverted: *inverted,
                };
                (structure == Structure::Skew, factor)
            }
            Factor::Unit {
                dim,
                axis,
                transposed,
            } => (
                false,
                Factor::Unit {
                    dim: *dim,
                    axis: *axis,
                    transposed: !transposed,
                },
            ),
            Factor::Inclusion {
                shape,
                at,
                transposed,
            } => (
                false,
                Factor::Inclusion {
                    shape: *shape,
                    at: *at,
                    transposed: !transposed,
                },
            ),
            Factor::Hat(_) | Factor::Pure(_) => (true, f.clone()),
            Factor::Axial { source, transposed } => (
                false,
                Factor::Axial {
                    source: *source,
                    transposed: !transposed,
                },
            ),
            Factor::Imaginary { word, transposed } => (
                false,
                Factor::Imaginary {
                    word: word.clone(),
                    transposed: !transposed,
                },
            ),
            Factor::Vee { word, transposed } => (
                false,
                Factor::Vee {
                    word: word.clone(),
                    transposed: !transposed,
                },
            ),
        }
    }

    /// The transpose of a word: reversed, each factor transposed; `true` for a minus sign.
    pub(super) fn transposed_word(&self, word: &[Factor]) -> (bool, Word) {
        let mut negative = false;
        let out = word
            .iter()
            .rev()
            .map(|f| {
                let (minus, t) = self.transposed(f);
                negative ^= minus;
                t
            })
            .collect();
        (negative, out)
    }

    /// Whether `a b` is the identity.
    pub(super) fn cancel(&self, a: &Factor, b: &Factor) -> bool {
        let (
            Factor::Letter {
                source: s,
                transposed: t,
                inverted: i,
            },
            Factor::Letter {
                source: s2,
                transposed: t2,
                inverted: i2,
            },
        ) = (a, b)
        else {
            return false;
        };
        s == s2
            && match self.structure(*s) {
                Structure::Orthogonal | Structure::UnitQuaternion => t != t2,
                Structure::Invertible
                | Structure::RigidMotion
                | Structure::General
                | Structure::Symmetric
                | Structure::Diagonal
                | Structure::Skew => t == t2 && i != i2,
            }
    }
}

/// Queries for the reduction of a model.
impl Algebra<'_> {
    /// The shape of a factor; transposed if the factor is.
    pub(crate) fn factor_shape(&self, f: &Factor) -> Shape {
        self.shape_of(f)
    }

    /// The transpose of a factor; `true` for a minus sign.
    pub(crate) fn transposed_factor(&self, f: &Factor) -> (bool, Factor) {
        self.transposed(f)
    }

    /// The transpose of a word; `true` for a minus sign.
    pub(crate) fn transposed_of(&self, word: &[Factor]) -> (bool, Word) {
        self.transposed_word(word)
    }

    /// The word without `g g^-1`.
    pub(crate) fn cancelled_word(&self, word: Word) -> Word {
        self.cancelled(word)
    }

    /// The group that contains a product for all values of its letters, if all letters belong to one group.
    pub(crate) fn structure_of_word(&self, word: &[Factor]) -> Option<Structure> {
        let mut found = None;
        for f in word {
            let Factor::Letter { source, .. } = f else {
                return None;
            };
            let own = self.structure(*source);
            if !own.is_invertible() || found.is_some_and(|other| other != own) {
                return None;
            }
            // The transpose of a rigid motion is not a rigid motion.
            if let Factor::Letter {
                transposed: true, ..
            } = f
                && own == Structure::RigidMotion
            {
                return None;
            }
            found = Some(own);
        }
        found
    }

    /// The expression of an interned number.
    pub(crate) fn opaque_number(&self, i: u32) -> crate::expr::Expr {
        self.numbers.borrow()[i as usize].meaning.clone()
    }

    /// The expression of an interned matrix.
    pub(crate) fn opaque_matrix(&self, i: u32) -> crate::expr::Expr {
        self.matrices.borrow()[i as usize].meaning.clone()
    }
}
