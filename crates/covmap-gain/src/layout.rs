//! How a cache lies in memory, in numbers: for whoever draws it, or wonders.

/// Where what is kept of a cell lies, in numbers of cells.
///
/// Rasters that beams are followed through have a border all around; rows of histograms, and of
/// whatever else is kept cell by cell, have a padding at either end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLayout {
    /// How many neighbouring view-points are a group, and cells a block.
    pub lanes: usize,
    /// Columns and rows around the grid in a bordered raster: as many as a stencil needs.
    pub border: usize,
    /// From one row of a bordered raster to the next.
    pub raster_width: usize,
    /// Columns before and after the blocks of a padded row.
    pub padding: usize,
    /// From one bin of a padded row to the next.
    pub padded_width: usize,
    /// The planes of gains, where the evaluation has any.
    pub planes: Option<PlaneLayout>,
}

/// Where the gains of the cells around some rows of view-points lie, at one distance ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlaneLayout {
    /// Columns on either side of the grid's, and rows: in whole blocks.
    pub border: usize,
    /// From one reading of a row to the next.
    pub stride: usize,
    /// From one row to the next: all its readings.
    pub row: usize,
}
