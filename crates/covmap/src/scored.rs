//! The cells that are scored: of the solid ones only the first layer, which a sensor can measure.

use crate::{Cell, Class, Raster};

/// Returns whether a cell is scored, by the true coverage. All cells that are not solid are scored,
/// and of the solid cells the first layer: those with a cell that is not solid among their eight
/// neighbours. No sensor can measure deeper cells. Outside the raster everything is solid.
pub fn is_scored(coverage: &Raster<f64>, cell: Cell) -> bool {
    let is_solid =
        |cell: Cell| coverage.get(cell).is_none_or(|coverage| Class::of(*coverage) == Class::Solid);
    let around = || (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| cell.offset(dx, dy)));
    coverage.get(cell).is_some() && !around().all(is_solid)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use nalgebra::Point2;

    #[test]
    fn the_first_layer_of_solid_cells_is_one_cell_thick_and_has_corners() {
        // A room of 2 × 1 cells, one of them half covered, in a grid of 7 × 5.
        let grid = Grid::new(Point2::origin(), 0.1, 7, 5).unwrap();
        let coverage = Raster::from_fn(grid, |cell| match (cell.x, cell.y) {
            (2, 2) => 0.0,
            (3, 2) => 0.5,
            _ => 1.0,
        });
        let picture: Vec<String> = (0..5)
            .map(|y| {
                let letter = |x| if is_scored(&coverage, Cell::new(x, y)) { '#' } else { '.' };
                (0..7).map(letter).collect()
            })
            .collect();
        assert_eq!(picture, [".......", ".####..", ".####..", ".####..", "......."]);
        assert!(!is_scored(&coverage, Cell::new(-1, 0)));
        let all = Raster::filled(grid, 1.0);
        assert!(grid.cells().all(|cell| !is_scored(&all, cell)));
    }
}
