//! What a cell is expected to change by at most, and from where.

/// For every cell the largest of what its entropy is expected to fall by from some view-points, by one
/// of their beams, and the view-point.
#[derive(Debug, Clone)]
pub(crate) struct Largest {
    /// By row-major index; nothing yet is −∞.
    of_cell: Vec<(f32, usize)>,
}

impl Largest {
    pub(crate) fn new(cells: usize) -> Self {
        Self { of_cell: vec![(f32::NEG_INFINITY, usize::MAX); cells] }
    }

    /// Takes over what a cell is expected to change by from a view-point, if it is more than before; of
    /// equal ones from the first view-point.
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

    /// By row-major index; `None` for a cell that no beam covers.
    pub(crate) fn into_cells(self) -> Vec<Option<(f64, usize)>> {
        let found = |(change, from): (f32, usize)| {
            (from != usize::MAX).then_some((f64::from(change), from))
        };
        self.of_cell.into_iter().map(found).collect()
    }
}
