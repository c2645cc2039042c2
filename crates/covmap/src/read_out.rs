//! Calibrated reading of a map's posteriors, by the meaning that such posteriors had before.

use crate::coverage_map::EvidenceKind;
use crate::histogram::{MAX_BINS, MIN_BINS, PROBABILITY_FLOOR};
use crate::{CoverageMap, short};
use serde::{Deserialize, Serialize};

/// η: the share of every posterior that is spread evenly over its bins before it is read.
pub const READ_OUT_FLOOR: f64 = 1e-6;

/// Largest magnitude of a number in a read-out: beyond, all mass would be in one bin anyway.
const LARGEST: f64 = 1000.0;

/// A calibrated reading of posteriors, which keeps their shape: for every bin j a weighted sum of
/// the logarithms of the posterior in all bins.
///
/// ```text
/// p'_j ∝ exp(b_j + Σ_k W_jk · log p̃_k)         p̃ = (1 − η)·p + η/n,   η = 1e-6
/// ```
///
/// b is `bias`, and W is `weights`, a row for each bin j. With W = I and b = 0 the reading is p, but for η;
/// with W = t·I a posterior that is too sure is read as a flatter one. Evidence adds up in logarithms,
/// Eq. (8). A sum of logarithms can therefore take back evidence that was counted twice, and can tell a mode
/// of ½ from readings at the end of a beam from a mode of ½ from readings that contradict each other. The
/// model is that of a multinomial logistic regression, whose likelihood has one maximum.
///
/// The belief stays as it is: the reading is for the user who looks at the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct ReadOut {
    bias: Vec<f64>,
    weights: Vec<Vec<f64>>,
}

/// A read-out as it stands in a file.
#[derive(Serialize, Deserialize)]
#[serde(rename = "ReadOut", deny_unknown_fields)]
struct Plain {
    bias: Vec<f64>,
    weights: Vec<Vec<f64>>,
}

/// Reason why numbers are no read-out, or why a read-out does not fit a map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReadOutError {
    /// The number of bins is out of range.
    #[error("bias: {0} numbers; there must be one for each bin of a map, {MIN_BINS} to {MAX_BINS}")]
    Bins(usize),
    /// The number of rows is not the number of bins.
    #[error("weights: {rows} rows for {bins} bins; there must be one row for each number of bias")]
    Rows {
        /// Number of rows.
        rows: usize,
        /// Number of bins.
        bins: usize,
    },
    /// A row does not have one number for each bin.
    #[error("weights[{row}]: {numbers} numbers for {bins} bins; there must be one for each")]
    Row {
        /// Index of the row, from 0.
        row: usize,
        /// Length of the row.
        numbers: usize,
        /// Number of bins.
        bins: usize,
    },
    /// A number is out of range.
    #[error("{place}: {} must lie in [−{LARGEST}, {LARGEST}]", short(value))]
    Number {
        /// Place of the number.
        place: String,
        /// Value of the number.
        value: f64,
    },
    /// The map has another number of bins.
    #[error(
        "the read-out is for maps of {bins} bins, and this one has {map}; fit one to its model"
    )]
    OtherBins {
        /// Bins of the read-out.
        bins: usize,
        /// Bins of the map.
        map: usize,
    },
}

impl ReadOut {
    /// Creates the read-out with these numbers: `bias` has one for each bin, and `weights` one row
    /// for each bin with one number for each bin.
    ///
    /// # Errors
    /// If the number of bins is out of range, a length differs from it, or a number is not finite
    /// or outside \[−1000, 1000\].
    pub fn new(bias: Vec<f64>, weights: Vec<Vec<f64>>) -> Result<Self, ReadOutError> {
        let bins = bias.len();
        if !(MIN_BINS..=MAX_BINS).contains(&bins) {
            return Err(ReadOutError::Bins(bins));
        }
        if weights.len() != bins {
            return Err(ReadOutError::Rows { rows: weights.len(), bins });
        }
        let is_good = |value: &f64| (-LARGEST..=LARGEST).contains(value);
        if let Some(bin) = bias.iter().position(|value| !is_good(value)) {
            return Err(ReadOutError::Number { place: format!("bias[{bin}]"), value: bias[bin] });
        }
        for (row, numbers) in weights.iter().enumerate() {
            if numbers.len() != bins {
                return Err(ReadOutError::Row { row, numbers: numbers.len(), bins });
            }
            if let Some(bin) = numbers.iter().position(|value| !is_good(value)) {
                let place = format!("weights[{row}][{bin}]");
                return Err(ReadOutError::Number { place, value: numbers[bin] });
            }
        }
        Ok(Self { bias, weights })
    }

    /// Returns the read-out that reads posteriors as they are, but for η.
    ///
    /// # Panics
    /// Unless `bins` is in [`MIN_BINS`]`..=`[`MAX_BINS`].
    pub fn plain(bins: usize) -> Self {
        assert!((MIN_BINS..=MAX_BINS).contains(&bins), "{bins} bins");
        let row = |j| (0..bins).map(|k| if k == j { 1.0 } else { 0.0 }).collect();
        Self { bias: vec![0.0; bins], weights: (0..bins).map(row).collect() }
    }

    /// Returns the number of bins.
    pub fn bins(&self) -> usize {
        self.bias.len()
    }

    /// Writes log p̃ of every bin to `out`: the numbers that the weights multiply.
    ///
    /// # Panics
    /// This and [`Self::read`] panic if the slices differ in length.
    pub fn clues(posterior: &[f64], out: &mut [f64]) {
        assert_eq!(posterior.len(), out.len(), "a place for each bin");
        let even = READ_OUT_FLOOR / posterior.len() as f64;
        for (o, p) in out.iter_mut().zip(posterior) {
            *o = libm::log((1.0 - READ_OUT_FLOOR) * p + even);
        }
    }

    /// Writes the calibrated reading of a map's posterior to `out`.
    pub fn read(&self, posterior: &[f64], out: &mut [f64]) {
        let mut clues = [0.0; MAX_BINS];
        let clues = &mut clues[..self.bins()];
        Self::clues(posterior, clues);
        assert_eq!(out.len(), self.bins(), "a place for each bin");
        for ((o, b), row) in out.iter_mut().zip(&self.bias).zip(&self.weights) {
            *o = b + row.iter().zip(&*clues).map(|(w, c)| w * c).sum::<f64>();
        }
        let largest = out.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        out.iter_mut().for_each(|o| *o = libm::exp(*o - largest));
        let sum: f64 = out.iter().sum();
        out.iter_mut().for_each(|o| *o /= sum);
    }
}

impl CoverageMap {
    /// Returns the map as a read-out reads it. Only measured cells are read: unknown cells stay
    /// unknown, and pinned cells stay pinned.
    ///
    /// # Errors
    /// If the read-out is for another number of bins.
    pub fn read_by(&self, read_out: &ReadOut) -> Result<Self, ReadOutError> {
        let bins = self.bins;
        if read_out.bins() != bins {
            return Err(ReadOutError::OtherBins { bins: read_out.bins(), map: bins });
        }
        let mut map = self.clone();
        let (mut stored, mut read) = ([0.0; MAX_BINS], [0.0; MAX_BINS]);
        let (stored, read) = (&mut stored[..bins], &mut read[..bins]);
        for (index, evidence) in self.evidence.iter().enumerate() {
            if *evidence == EvidenceKind::Measured {
                let cell = index * bins..(index + 1) * bins;
                stored
                    .iter_mut()
                    .zip(&self.posterior[cell.clone()])
                    .for_each(|(s, p)| *s = f64::from(*p));
                read_out.read(stored, read);
                read.iter_mut().for_each(|p| *p = p.max(PROBABILITY_FLOOR));
                let sum: f64 = read.iter().sum();
                for (p, read) in map.posterior[cell].iter_mut().zip(&*read) {
                    #[allow(clippy::cast_possible_truncation, reason = "stored as f32")]
                    (*p = (read / sum) as f32);
                }
                map.refresh(index);
            }
        }
        Ok(map)
    }
}

impl TryFrom<Plain> for ReadOut {
    type Error = ReadOutError;

    fn try_from(plain: Plain) -> Result<Self, ReadOutError> {
        Self::new(plain.bias, plain.weights)
    }
}

impl From<ReadOut> for Plain {
    fn from(ReadOut { bias, weights }: ReadOut) -> Self {
        Self { bias, weights }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::{Cell, Grid};
    use nalgebra::Point2;
    use proptest::prelude::*;

    fn read(read_out: &ReadOut, posterior: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; posterior.len()];
        read_out.read(posterior, &mut out);
        out
    }

    #[test]
    fn what_is_read_by_hand() {
        // η is so small that p̃ = (.8, .2) to five digits. b = (0, ln 2), W = ½·I:
        // √.8 : 2·√.2 = .894427 : .894427, both ½.
        let half = ReadOut::new(vec![0.0, libm::log(2.0)], vec![vec![0.5, 0.0], vec![0.0, 0.5]]);
        let p = read(&half.unwrap(), &[0.8, 0.2]);
        assert!((p[0] - 0.5).abs() < 1e-4, "{p:?}");
        // Exchanged rows exchange the bins.
        let other = ReadOut::new(vec![0.0; 2], vec![vec![0.0, 1.0], vec![1.0, 0.0]]).unwrap();
        assert!((read(&other, &[0.8, 0.2])[1] - 0.8).abs() < 1e-4);
    }

    #[test]
    fn of_a_map_only_what_was_measured_is_read() {
        let grid = Grid::new(Point2::origin(), 0.1, 3, 1).unwrap();
        let mut map = CoverageMap::new(grid, 2).unwrap();
        let [unknown, measured, pinned] = [0, 1, 2].map(|x| Cell::new(x, 0));
        map.multiply(measured, &[0.8, 0.2]);
        map.pin_free(pinned);
        let flat = ReadOut::new(vec![0.0, 1.0], vec![vec![0.0; 2]; 2]).unwrap();
        let read = map.read_by(&flat).unwrap();
        // 1 : e.
        assert!((read.histogram(measured).probabilities()[0] - 0.268_941).abs() < 1e-5);
        assert!((read.mode(measured), map.mode(measured)) == (1.0, 0.0));
        assert!(!read.is_known(unknown) && read.histogram(unknown) == map.histogram(unknown));
        assert!(read.is_pinned(pinned) && read.histogram(pinned) == map.histogram(pinned));
        let wide = ReadOut::plain(3);
        let refused = map.read_by(&wide).unwrap_err();
        assert_eq!(refused, ReadOutError::OtherBins { bins: 3, map: 2 });
    }

    #[test]
    fn numbers_that_are_no_read_out_are_refused() {
        let new = |bias: &[f64], rows: &[&[f64]]| {
            ReadOut::new(bias.to_vec(), rows.iter().map(|row| row.to_vec()).collect())
        };
        assert_eq!(new(&[0.0], &[&[1.0]]), Err(ReadOutError::Bins(1)));
        let rows = new(&[0.0, 0.0], &[&[1.0, 0.0]]);
        assert_eq!(rows, Err(ReadOutError::Rows { rows: 1, bins: 2 }));
        let row = new(&[0.0, 0.0], &[&[1.0, 0.0], &[1.0]]);
        assert_eq!(row, Err(ReadOutError::Row { row: 1, numbers: 1, bins: 2 }));
        let error = new(&[0.0, f64::NAN], &[&[1.0, 0.0], &[0.0, 1.0]]).unwrap_err();
        assert!(error.to_string().starts_with("bias[1]: NaN must lie in"), "{error}");
        let error = new(&[0.0, 0.0], &[&[1.0, 0.0], &[1e4, 1.0]]).unwrap_err();
        assert!(error.to_string().starts_with("weights[1][0]: 10000 must"), "{error}");
        let json = "{\"bias\": [0, 0], \"weights\": [[1, 0]]}";
        let error = serde_json::from_str::<ReadOut>(json).unwrap_err().to_string();
        assert!(error.contains("1 rows for 2 bins"), "{error}");
    }

    proptest! {
        #[test]
        fn what_is_read_is_a_distribution(
            weights in prop::collection::vec(prop::collection::vec(-900.0..900.0f64, 4), 4),
            bias in prop::collection::vec(-900.0..900.0f64, 4),
            p in prop::collection::vec(0.0..1.0f64, 4),
        ) {
            let sum: f64 = p.iter().sum::<f64>() + 1e-12;
            let p: Vec<f64> = p.iter().map(|p| p / sum).collect();
            let read_out = ReadOut::new(bias, weights).unwrap();
            let out = read(&read_out, &p);
            prop_assert!((out.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{:?}", out);
            prop_assert!(out.iter().all(|p| *p >= 0.0));
            let written = serde_json::to_string(&read_out).unwrap();
            prop_assert_eq!(serde_json::from_str::<ReadOut>(&written).unwrap(), read_out);
        }

        #[test]
        fn the_plain_one_reads_what_is_there(p in prop::collection::vec(0.01..1.0f64, 11)) {
            let sum: f64 = p.iter().sum();
            let p: Vec<f64> = p.iter().map(|p| p / sum).collect();
            for (a, b) in read(&ReadOut::plain(11), &p).iter().zip(&p) {
                prop_assert!((a - b).abs() < 1e-4);
            }
        }
    }
}
