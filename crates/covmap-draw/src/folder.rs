//! Folders of figures and tables.

use crate::{Drawing, Figure};
use covmap_io::{FileError, Replace, SharedFolder};
use std::io;
use std::path::{Path, PathBuf};

/// A folder of figures, each as SVG and PNG, with the numbers behind it as CSV.
#[derive(Debug, Clone)]
pub struct FigureFolder(SharedFolder);

impl FigureFolder {
    /// Makes the folder, if it is not there.
    ///
    /// # Errors
    /// If the folder cannot be made.
    pub fn create(dir: &Path, replace: Replace) -> Result<Self, FileError> {
        SharedFolder::open(dir, replace).map(Self)
    }

    /// Returns the folder.
    pub fn dir(&self) -> &Path {
        self.0.dir()
    }

    /// Returns the path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path(name)
    }

    /// Writes a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<(), FileError> {
        self.0.write(name, bytes.as_ref())
    }

    /// Removes a file of an earlier report.
    ///
    /// # Errors
    /// If the file cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), FileError> {
        self.0.remove(name)
    }

    /// Writes a figure as `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// If the figure cannot be drawn or written.
    pub fn figure(&self, name: &str, figure: &Figure) -> Result<(), FileError> {
        self.write(&format!("{name}.svg"), figure.to_svg())?;
        self.image(name, figure.to_png()).map(drop)
    }

    /// Writes a drawing as `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// If the drawing cannot be drawn or written.
    pub fn drawing(&self, name: &str, drawing: &Drawing) -> Result<(), FileError> {
        self.write(&format!("{name}.svg"), drawing.to_svg())?;
        self.image(name, drawing.to_png()).map(drop)
    }

    /// Writes `NAME.png`, and returns its bytes.
    ///
    /// # Errors
    /// If the image cannot be drawn or written.
    pub fn image(&self, name: &str, png: io::Result<Vec<u8>>) -> Result<Vec<u8>, FileError> {
        let name = format!("{name}.png");
        let fail = |reason| FileError::Io { path: self.path(&name), action: "drawn", reason };
        let png = png.map_err(fail)?;
        self.write(&name, &png)?;
        Ok(png)
    }

    /// Writes `NAME.csv`: names of columns, and rows of as many fields.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn table(
        &self,
        name: &str,
        columns: &[&str],
        rows: &[Vec<String>],
    ) -> Result<(), FileError> {
        let rows = rows.iter().map(|row| row.join(","));
        let lines: Vec<String> = std::iter::once(columns.join(",")).chain(rows).collect();
        self.write(&format!("{name}.csv"), lines.join("\n") + "\n")
    }
}
