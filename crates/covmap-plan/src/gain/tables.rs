//! The evidence p(c | d) of every outcome for every cell of the stencil, computed once.

use super::logarithm::{LANES, Lanes};
use crate::{BeamStencil, Stencil};
use covmap::MAX_BINS;
use covmap_model::SensorModel;
use std::collections::BTreeMap;

/// The evidence of one outcome for the cells that it covers: blocks of [`LANES`] cells, for
/// each block n bins of lanes.
#[derive(Debug, Clone)]
pub(crate) struct OutcomeRows {
    /// How many cells the outcome covers.
    pub(crate) covered: usize,
    /// t = p(c | d).
    pub(crate) t: Vec<Lanes>,
    /// v = t·log t.
    pub(crate) v: Vec<Lanes>,
}

/// The evidence of every outcome, for every beam. Beams that see the same distances, as
/// those a quarter turn apart do, share it.
#[derive(Debug, Clone)]
pub(crate) struct GainTables {
    table_of_beam: Vec<usize>,
    tables: Vec<Vec<OutcomeRows>>,
}

impl GainTables {
    pub(crate) fn new(model: &SensorModel, stencil: &Stencil) -> Self {
        let mut known: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
        let mut tables = Vec::new();
        let mut table_of_beam = Vec::new();
        for beam in &stencil.beams {
            let distances = beam.cells.iter().map(|c| c.cell_distance.to_bits()).collect();
            let table = *known.entry(distances).or_insert_with(|| {
                let rows = |k| outcome_rows(model, stencil, beam, k);
                tables.push((0..stencil.outcomes()).map(rows).collect());
                tables.len() - 1
            });
            table_of_beam.push(table);
        }
        Self { table_of_beam, tables }
    }

    /// The rows of outcome `k` of a beam.
    #[inline(always)]
    pub(crate) fn rows(&self, beam: usize, k: usize) -> &OutcomeRows {
        &self.tables[self.table_of_beam[beam]][k]
    }
}

fn outcome_rows(
    model: &SensorModel,
    stencil: &Stencil,
    beam: &BeamStencil,
    k: usize,
) -> OutcomeRows {
    let bins = model.parameters().bins;
    let covered = beam.reach(k);
    // Lanes past the last cell hold no evidence at all; they are masked out.
    let mut t = vec![[1.0; LANES]; covered.div_ceil(LANES) * bins];
    let mut v = vec![[0.0; LANES]; t.len()];
    let mut evidence = [0.0; MAX_BINS];
    for (i, cell) in beam.cells[..covered].iter().enumerate() {
        model.evidence(cell.cell_distance, stencil.outcome(k), &mut evidence[..bins]);
        for (bin, e) in evidence[..bins].iter().enumerate() {
            let (row, lane) = (i / LANES * bins + bin, i % LANES);
            #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
            ((t[row][lane], v[row][lane]) = (*e as f32, (e * libm::log(*e)) as f32));
        }
    }
    OutcomeRows { covered, t, v }
}
