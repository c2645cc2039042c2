//! Where figures and tables go.

use crate::csv_file;
use anyhow::{Result, anyhow};
use covmap_io::Figure;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A folder of figures, each as SVG and PNG, with the numbers behind it as CSV.
#[derive(Debug, Clone)]
pub(crate) struct Output {
    dir: PathBuf,
}

impl Output {
    /// Makes the folder, if it is not there.
    pub(crate) fn create(dir: &Path) -> Result<Self> {
        let fail = |error| anyhow!("{}: cannot be made: {error}", dir.display());
        std::fs::create_dir_all(dir).map_err(fail)?;
        Ok(Self { dir: dir.to_owned() })
    }

    /// The folder.
    pub(crate) fn dir(&self) -> &Path {
        &self.dir
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Writes `NAME.svg` and `NAME.png`.
    pub(crate) fn figure(&self, name: &str, figure: &Figure) -> Result<()> {
        let path = |kind: &str| self.path(&format!("{name}.{kind}"));
        Ok(figure.save(path("svg"), path("png"))?)
    }

    /// Writes `NAME.csv`: names of columns, and rows of as many fields.
    pub(crate) fn table(&self, name: &str, columns: &[&str], rows: &[Vec<String>]) -> Result<()> {
        csv_file::write(&self.path(&format!("{name}.csv")), |out| {
            writeln!(out, "{}", columns.join(","))?;
            rows.iter().try_for_each(|row| writeln!(out, "{}", row.join(",")))
        })
    }
}
