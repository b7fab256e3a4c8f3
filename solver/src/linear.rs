//! Linear algebra of sparse matrices.

pub(crate) mod cholesky;
pub mod sparse_rows;
