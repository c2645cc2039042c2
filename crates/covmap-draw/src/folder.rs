//! Where figures and tables go.

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
    /// If that is not possible.
    pub fn create(dir: &Path, replace: Replace) -> Result<Self, FileError> {
        SharedFolder::open(dir, replace).map(Self)
    }

    /// The folder.
    pub fn dir(&self) -> &Path {
        self.0.dir()
    }

    /// The path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path(name)
    }

    /// Writes a file.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<(), FileError> {
        self.0.write(name, bytes.as_ref())
    }

    /// Removes a file of an earlier report.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn remove(&self, name: &str) -> Result<(), FileError> {
        self.0.remove(name)
    }

    /// Writes `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn figure(&self, name: &str, figure: &Figure) -> Result<(), FileError> {
        self.write(&format!("{name}.svg"), figure.to_svg())?;
        self.image(name, figure.to_png()).map(drop)
    }

    /// Writes `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn drawing(&self, name: &str, drawing: &Drawing) -> Result<(), FileError> {
        self.write(&format!("{name}.svg"), drawing.to_svg())?;
        self.image(name, drawing.to_png()).map(drop)
    }

    /// Writes `NAME.png`, and returns its bytes.
    ///
    /// # Errors
    /// If that is not possible.
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
    /// If that is not possible.
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
