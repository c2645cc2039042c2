//! The layout of a cache in memory, in numbers, for pictures of it.

/// Layout of the values of a cell, in numbers of cells.
///
/// Rasters along which beams are followed have a border all around; rows of histograms, and of
/// other values that are kept cell by cell, have a padding at either end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLayout {
    /// Number of neighbouring view-points in a group, and of cells in a block.
    pub lanes: usize,
    /// Columns and rows around the grid in a bordered raster: as many as a stencil needs.
    pub border: usize,
    /// Distance from one row of a bordered raster to the next.
    pub raster_width: usize,
    /// Columns before and after the blocks of a padded row.
    pub padding: usize,
    /// Distance from one bin of a padded row to the next.
    pub padded_width: usize,
    /// The planes of gains, where the evaluation has any.
    pub planes: Option<PlaneLayout>,
}

/// Layout of the gains of the cells around some rows of view-points, at one distance ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlaneLayout {
    /// Columns and rows on either side of the grid, in whole blocks.
    pub border: usize,
    /// Distance from one reading of a row to the next.
    pub stride: usize,
    /// Distance from one row to the next: all its readings.
    pub row: usize,
}
