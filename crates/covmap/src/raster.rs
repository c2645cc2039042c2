//! One value for each cell of a grid.

use crate::{Cell, Grid};

/// One value of type `T` for each cell of a grid, row by row from the lower left.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster<T> {
    grid: Grid,
    values: Vec<T>,
}

impl<T> Raster<T> {
    /// Creates a raster in which every cell has the same value.
    pub fn filled(grid: Grid, value: T) -> Self
    where
        T: Clone,
    {
        Self { grid, values: vec![value; grid.len()] }
    }

    /// Creates a raster with the value that `f` gives to each cell.
    pub fn from_fn(grid: Grid, f: impl FnMut(Cell) -> T) -> Self {
        Self { grid, values: grid.cells().map(f).collect() }
    }

    /// Creates a raster of values in row-major order; `None` if there is not one for each cell.
    pub fn from_values(grid: Grid, values: Vec<T>) -> Option<Self> {
        (values.len() == grid.len()).then_some(Self { grid, values })
    }

    /// Returns the grid whose cells have these values.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the value of a cell; `None` outside the grid.
    pub fn get(&self, cell: Cell) -> Option<&T> {
        self.grid.index(cell).map(|i| &self.values[i])
    }

    /// Returns the value of a cell for changing; `None` outside the grid.
    pub fn get_mut(&mut self, cell: Cell) -> Option<&mut T> {
        self.grid.index(cell).map(|i| &mut self.values[i])
    }

    /// Returns all values in row-major order.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Returns all values in row-major order for changing.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Returns every cell with its value, in row-major order.
    pub fn iter(&self) -> impl Iterator<Item = (Cell, &T)> {
        self.grid.cells().zip(&self.values)
    }

    /// Returns the raster of `f(value)` of each cell.
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Raster<U> {
        Raster { grid: self.grid, values: self.values.iter().map(f).collect() }
    }
}

impl<T> std::ops::Index<usize> for Raster<T> {
    type Output = T;
    /// Returns the value of the cell with a row-major index.
    ///
    /// # Panics
    /// If there is no such cell.
    fn index(&self, index: usize) -> &T {
        &self.values[index]
    }
}

impl<T> std::ops::IndexMut<usize> for Raster<T> {
    /// Returns the value of the cell with a row-major index for changing.
    ///
    /// # Panics
    /// If there is no such cell.
    fn index_mut(&mut self, index: usize) -> &mut T {
        &mut self.values[index]
    }
}
