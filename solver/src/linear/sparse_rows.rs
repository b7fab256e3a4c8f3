//! A sparse matrix, row after row.

use core::ops::Range;

/// A sparse matrix, row after row (CSR). What a value stands for is up to its owner.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseRows<T> {
    /// Where each row begins, and behind the last one the end.
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<T>,
}

impl<T> Default for SparseRows<T> {
    fn default() -> Self {
        Self { starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }
}

impl<T: Copy> SparseRows<T> {
    /// Appends a row of (column, value).
    pub fn push_row(&mut self, entries: impl IntoIterator<Item = (u32, T)>) {
        for (column, value) in entries {
            self.columns.push(column);
            self.values.push(value);
        }
        self.starts.push(self.columns.len() as u32);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Places of a row's entries in [`values`](Self::values).
    #[inline]
    pub fn range(&self, row: usize) -> Range<usize> {
        self.starts[row] as usize..self.starts[row + 1] as usize
    }

    /// Columns of a row's entries.
    #[inline]
    pub fn columns(&self, row: usize) -> &[u32] {
        &self.columns[self.range(row)]
    }

    /// Columns and values of a row's entries.
    #[inline]
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, T)> + Clone {
        let values = self.values[self.range(row)].iter().copied();
        self.columns(row).iter().map(|&column| column as usize).zip(values)
    }

    /// The value at a row and column, if there is an entry.
    pub fn get(&self, row: usize, column: usize) -> Option<T> {
        self.row(row).find(|&(at, _)| at == column).map(|(_, value)| value)
    }

    /// Values of all entries, row after row.
    pub fn values(&self) -> &[T] {
        &self.values
    }
}
