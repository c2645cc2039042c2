//! The largest expected change of a cell, and its view-point.

/// For every cell the largest expected fall of its entropy by one beam of some view-points, and the
/// view-point.
#[derive(Debug, Clone)]
pub(crate) struct Largest {
    /// By row-major index; −∞ at first.
    of_cell: Vec<(f32, usize)>,
}

impl Largest {
    pub(crate) fn new(cells: usize) -> Self {
        Self { of_cell: vec![(f32::NEG_INFINITY, usize::MAX); cells] }
    }

    /// Takes over the expected change of a cell from a view-point if it is larger than before, or
    /// equal and from an earlier view-point.
    pub(crate) fn take(&mut self, cell: usize, (change, from): (f32, usize)) {
        let best = &mut self.of_cell[cell];
        if change > best.0 || change >= best.0 && from < best.1 {
            *best = (change, from);
        }
    }

    pub(crate) fn merged(mut self, other: Self) -> Self {
        other.of_cell.into_iter().enumerate().for_each(|(cell, found)| self.take(cell, found));
        self
    }

    /// Returns the changes by row-major index; `None` for a cell that no beam covers.
    pub(crate) fn into_cells(self) -> Vec<Option<(f64, usize)>> {
        let found = |(change, from): (f32, usize)| {
            (from != usize::MAX).then_some((f64::from(change), from))
        };
        self.of_cell.into_iter().map(found).collect()
    }
}
