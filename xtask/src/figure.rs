//! `figure`: one figure of the paper.

use crate::arguments::Figure;
use crate::figures::{Output, fig1, fig2, fig3, partial_cells};
use crate::{input, say};
use anyhow::Result;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Figure) -> Result<ExitCode> {
    let output = Output::create(&arguments.common.out)?;
    let (paper, name) = input::config(Some(Path::new("configs/paper.ron")))?;
    let (b21r, b21r_name) = input::config(None)?;
    match arguments.number.as_str() {
        "1" => {
            let cells = partial_cells::measure(&paper, 100)?;
            fig1::write(&output, &cells, "paper.ron")?;
        }
        "2" => {
            let cells = partial_cells::measure(&paper, 100)?;
            let b21r = partial_cells::measure(&b21r, 100)?;
            fig2::write(&output, &[("paper.ron", &cells), ("b21r.ron", &b21r)])?;
        }
        _ => {
            let (a, b) = (input::check(&paper, &name)?, input::check(&b21r, &b21r_name)?);
            fig3::write(&output, &[("paper.ron", &a), ("b21r.ron", &b)])?;
        }
    }
    say::line(output.dir().display());
    Ok(ExitCode::SUCCESS)
}
