//! Functions of the runtime that loops over sites do themselves, without values between them.

/// Which function it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// `exp` and other functions of one number.
    Exp,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The square root.
    Sqrt,
    /// The natural logarithm.
    Ln,
    /// A whole power.
    Powi,
    /// The product of two arrays, entry by entry, summed.
    Dot,
    /// The vector product.
    Cross,
    /// The product with the transpose of the first.
    TrMul,
    /// The trace.
    Trace,
    /// The matrix of what stands for one.
    Matrix,
    /// The momentum in space of an edge.
    Space,
    /// `[x]`.
    Single,
    /// Whether all entries are finite.
    AllFinite,
    /// A value where a truth holds.
    ThenSome,
    /// The rest of an array, to be written.
    Rest,
    /// Numbers put into it, column after column.
    PutVector,
    /// Numbers put into it, row after row.
    PutMatrix,
    /// A column put into a matrix.
    SetColumn,
    /// A block put into a matrix.
    PutBlock,
    /// A matrix from its entries.
    FromFn,
    /// What is there, mapped.
    Map,
    /// The error of what is not there, mapped.
    MapErr,
    /// The division of a field's momentum by a number.
    Divided,
    /// `Ok(x)` and `Some(x)`, which are `x`.
    Done,
    /// How many values a list has.
    Length,
    /// Any other.
    Other,
}

impl Known {
    /// That of a name.
    pub fn of(name: &str) -> Self {
        match name {
            "exp" => Known::Exp,
            "sin" => Known::Sin,
            "cos" => Known::Cos,
            "sqrt" => Known::Sqrt,
            "ln" => Known::Ln,
            "powi" => Known::Powi,
            "dot" => Known::Dot,
            "cross" => Known::Cross,
            "tr_mul" => Known::TrMul,
            "trace" => Known::Trace,
            "matrix" => Known::Matrix,
            "space" => Known::Space,
            "single" => Known::Single,
            "all_finite" => Known::AllFinite,
            "then_some" => Known::ThenSome,
            "as_mut_slice" => Known::Rest,
            "put_vector" | "put_number" => Known::PutVector,
            "put_matrix" => Known::PutMatrix,
            "set_column" => Known::SetColumn,
            "put_block" => Known::PutBlock,
            "from_fn" => Known::FromFn,
            "map" => Known::Map,
            "map_err" => Known::MapErr,
            "Ok" | "Some" => Known::Done,
            "len" => Known::Length,
            "divided" => Known::Divided,
            _ => Known::Other,
        }
    }
}
