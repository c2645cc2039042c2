//! Where figures and tables go.

use anyhow::Result;
use covmap_draw::{Drawing, Figure};
use covmap_io::{FileError, Replace, SharedFolder};
use std::io;
use std::path::{Path, PathBuf};

/// A folder of figures, each as SVG and PNG, with the numbers behind it as CSV.
#[derive(Debug, Clone)]
pub(crate) struct Output(SharedFolder);

impl Output {
    /// Makes the folder, if it is not there.
    pub(crate) fn create(dir: &Path, replace: Replace) -> Result<Self> {
        Ok(Self(SharedFolder::open(dir, replace)?))
    }

    /// The folder.
    pub(crate) fn dir(&self) -> &Path {
        self.0.dir()
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path(name)
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<()> {
        Ok(self.0.write(name, bytes.as_ref())?)
    }

    /// Removes a file of an earlier report.
    pub(crate) fn remove(&self, name: &str) -> Result<()> {
        Ok(self.0.remove(name)?)
    }

    /// Writes `NAME.svg` and `NAME.png`.
    pub(crate) fn figure(&self, name: &str, figure: &Figure) -> Result<()> {
        self.write(&format!("{name}.svg"), figure.to_svg())?;
        self.image(name, figure.to_png()).map(drop)
    }

    /// Writes `NAME.svg` and `NAME.png`.
    pub(crate) fn drawing(&self, name: &str, drawing: &Drawing) -> Result<()> {
        self.write(&format!("{name}.svg"), drawing.to_svg())?;
        self.image(name, drawing.to_png()).map(drop)
    }

    /// Writes `NAME.png`, and returns its bytes.
    pub(crate) fn image(&self, name: &str, png: io::Result<Vec<u8>>) -> Result<Vec<u8>> {
        let name = format!("{name}.png");
        let fail = |reason| FileError::Io { path: self.path(&name), action: "drawn", reason };
        let png = png.map_err(fail)?;
        self.write(&name, &png)?;
        Ok(png)
    }

    /// Writes `NAME.csv`: names of columns, and rows of as many fields.
    pub(crate) fn table(&self, name: &str, columns: &[&str], rows: &[Vec<String>]) -> Result<()> {
        let rows = rows.iter().map(|row| row.join(","));
        let lines: Vec<String> = std::iter::once(columns.join(",")).chain(rows).collect();
        self.write(&format!("{name}.csv"), lines.join("\n") + "\n")
    }
}
