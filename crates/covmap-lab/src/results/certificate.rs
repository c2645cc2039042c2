//! `certificate.csv`: the status of each cell, and the largest expected change by one more scan.

use crate::error::{Fault, Result, about};
use covmap::{Cell, Grid};
use covmap_explore::Run;
use covmap_io::read_text;
use covmap_io::{FileError, csv};
use covmap_plan::{CellStatus, Promise};
use nalgebra::Point2;
use std::io::Write;
use std::path::Path;

/// Largest size of a certificate's file \[bytes\]; covmap makes no larger map.
const LONGEST: u64 = 4 << 30;

const HEADER: &str = "x,y,status,entropy,counted_scans,expected_change,from_x,from_y";

/// Writes the certificate: places in metres, entropies and changes in nats; empty where there is no number.
pub fn write(path: &Path, run: &Run) -> Result<(), FileError> {
    csv::write(path, |file| {
        writeln!(file, "{HEADER}")?;
        let grid = run.certificate.grid();
        for (cell, status) in run.certificate.iter().filter(|(_, s)| **s != CellStatus::Outside) {
            let at = grid.center(cell);
            let counted = run.counts.get(cell).copied().unwrap_or(0);
            let entropy = run.map.entropy(cell);
            write!(file, "{:.3},{:.3},{status:?},{entropy:.4},{counted},", at.x, at.y)?;
            match run.promises.get(cell).copied().flatten() {
                Some(Promise { change, from }) => {
                    let from = grid.center(from);
                    writeln!(file, "{change:.5},{:.3},{:.3}", from.x, from.y)?;
                }
                None => writeln!(file, ",,")?,
            }
        }
        Ok(())
    })
}

/// Explains the status of the cell at a place \[m\] in a sentence, by the file of a run on a grid.
pub fn why(path: &Path, grid: &Grid, at: Point2<f64>) -> Result<String> {
    let cell = grid.cell_at(at).filter(|cell| grid.index(*cell).is_some());
    let cell = cell.ok_or(Fault::NotInMap { x: at.x, y: at.y })?;
    let text = read_text(path, LONGEST)?;
    let mut lines = text.lines();
    if lines.next() != Some(HEADER) {
        return Err(about(path)(Fault::OtherVersion));
    }
    let row = lines.map(|line| line.split(',').collect::<Vec<_>>()).find(|row| is(row, grid, cell));
    let Some(row) = row else { return Ok("outside of what is to be explored".into()) };
    let [status, entropy, counted] = [row[2], row[3], row[4]];
    let known = format!("{}, H = {entropy} nats, {counted} scans counted", status.to_lowercase());
    Ok(match (row[5], row[6], row[7]) {
        _ if status == "Resolved" => known,
        ("", ..) => format!("{known}; no scan from a place in reach would tell of it"),
        (change, x, y) => format!(
            "{known}; one more scan is expected to lower H by {change} nats at most, from ({x}, {y})"
        ),
    })
}

fn is(row: &[&str], grid: &Grid, cell: Cell) -> bool {
    let number = |i: usize| row.get(i).and_then(|text| text.parse::<f64>().ok());
    let at = number(0).zip(number(1)).map(|(x, y)| Point2::new(x, y));
    row.len() == HEADER.split(',').count() && at.and_then(|at| grid.cell_at(at)) == Some(cell)
}
