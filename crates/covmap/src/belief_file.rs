//! The whole posterior as bytes: the content of `belief.bin`.
//!
//! Little endian: the magic `COVMAP`, version (u16), bins (u32), width and height (u64),
//! lower left corner x, y and resolution (f64, m); then for each cell, row by row from the
//! lower left, one byte of evidence (0 unknown, 1 measured, 2 pinned); then, in the same
//! order, each cell's probabilities (f32).

use crate::coverage_map::EvidenceKind;
use crate::{CoverageMap, Grid, GridError, MapError};
use nalgebra::Point2;

const MAGIC: &[u8; 6] = b"COVMAP";
const VERSION: u16 = 1;
const HEADER: usize = 6 + 2 + 4 + 8 + 8 + 24;

/// Reason why bytes are not a belief.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BeliefFileError {
    /// The bytes do not begin as a belief does.
    #[error("this is not a belief file of covmap")]
    Magic,
    /// Another version of the format.
    #[error("belief file version {0}; this covmap reads version {VERSION}")]
    Version(u16),
    /// More or fewer bytes than the header promises.
    #[error("the belief file has {actual} bytes where its header promises {expected}")]
    Length {
        /// Number of bytes that the header promises.
        expected: u128,
        /// Number of bytes that are there.
        actual: usize,
    },
    /// A cell has no valid posterior.
    #[error("cell {0} of the belief file (row by row) has no valid posterior")]
    Posterior(usize),
    /// The geometry is invalid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The number of bins is invalid.
    #[error(transparent)]
    Map(#[from] MapError),
}

struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> &'a [u8] {
        let (head, tail) = self.0.split_at(count);
        self.0 = tail;
        head
    }

    fn array<const N: usize>(&mut self) -> [u8; N] {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N));
        out
    }
}

impl CoverageMap {
    /// Returns the whole posterior as bytes, exactly.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(HEADER + self.evidence.len() * (1 + 4 * self.bins));
        out.extend(MAGIC);
        out.extend(VERSION.to_le_bytes());
        #[allow(clippy::cast_possible_truncation, reason = "at most 64 bins")]
        out.extend((self.bins as u32).to_le_bytes());
        out.extend((self.grid.width() as u64).to_le_bytes());
        out.extend((self.grid.height() as u64).to_le_bytes());
        let corner = self.grid.lower_left();
        for value in [corner.x, corner.y, self.grid.resolution()] {
            out.extend(value.to_le_bytes());
        }
        out.extend(self.evidence.iter().map(|e| *e as u8));
        self.posterior.iter().for_each(|p| out.extend(p.to_le_bytes()));
        out
    }

    /// Reads the map that [`Self::to_bytes`] wrote, bit for bit.
    ///
    /// # Errors
    /// If the bytes are not a belief of this version, are cut short or too long, or hold
    /// anything but posteriors. Nothing is allocated before the length is checked.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BeliefFileError> {
        if bytes.len() < HEADER || &bytes[..6] != MAGIC {
            return Err(BeliefFileError::Magic);
        }
        let mut reader = Reader(&bytes[6..]);
        let version = u16::from_le_bytes(reader.array());
        if version != VERSION {
            return Err(BeliefFileError::Version(version));
        }
        let bins = u32::from_le_bytes(reader.array()) as usize;
        let width = u64::from_le_bytes(reader.array());
        let height = u64::from_le_bytes(reader.array());
        let [x, y, resolution] = std::array::from_fn(|_| f64::from_le_bytes(reader.array()));
        let cells = u128::from(width) * u128::from(height);
        let expected = cells.saturating_mul(1 + 4 * bins as u128).saturating_add(HEADER as u128);
        if expected != bytes.len() as u128 {
            return Err(BeliefFileError::Length { expected, actual: bytes.len() });
        }
        let side = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
        let grid = Grid::new(Point2::new(x, y), resolution, side(width), side(height))?;
        let evidence = parse_evidence(reader.take(grid.len()))?;
        let posterior: Vec<f32> = reader
            .0
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        for (cell, p) in posterior.chunks_exact(bins.max(1)).enumerate() {
            let sum: f32 = p.iter().sum();
            if !(p.iter().all(|p| *p > 0.0 && *p <= 1.0) && (sum - 1.0).abs() < 1e-3) {
                return Err(BeliefFileError::Posterior(cell));
            }
        }
        Ok(CoverageMap::from_parts(grid, bins, posterior, evidence)?)
    }
}

fn parse_evidence(bytes: &[u8]) -> Result<Vec<EvidenceKind>, BeliefFileError> {
    let parse = |(cell, byte): (usize, &u8)| match byte {
        0 => Ok(EvidenceKind::Unknown),
        1 => Ok(EvidenceKind::Measured),
        2 => Ok(EvidenceKind::Pinned),
        _ => Err(BeliefFileError::Posterior(cell)),
    };
    bytes.iter().enumerate().map(parse).collect()
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::Cell;
    use proptest::prelude::*;

    fn some_map() -> CoverageMap {
        let grid = Grid::new(Point2::new(-0.7, 3.1), 0.1, 5, 4).unwrap();
        let mut map = CoverageMap::new(grid, 4).unwrap();
        map.multiply(Cell::new(1, 2), &[0.3, 0.1, 0.7, 0.2]);
        map.pin_free(Cell::new(4, 3));
        map
    }

    #[test]
    fn a_belief_comes_back_exactly() {
        let map = some_map();
        assert_eq!(CoverageMap::from_bytes(&map.to_bytes()).unwrap(), map);
    }

    #[test]
    fn a_damaged_belief_is_refused() {
        let bytes = some_map().to_bytes();
        let refuse = |bytes: &[u8]| CoverageMap::from_bytes(bytes).unwrap_err();
        assert_eq!(refuse(b"PNG"), BeliefFileError::Magic);
        assert!(matches!(refuse(&bytes[..bytes.len() - 1]), BeliefFileError::Length { .. }));
        let mut newer = bytes.clone();
        newer[6] = 9;
        assert_eq!(refuse(&newer), BeliefFileError::Version(9));
        let mut huge = bytes.clone();
        huge[12..20].fill(0xff);
        assert!(matches!(refuse(&huge), BeliefFileError::Length { .. }));
        let mut lying = bytes;
        *lying.last_mut().unwrap() = 0xff;
        assert!(matches!(refuse(&lying), BeliefFileError::Posterior(19)));
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_never_panic(at in 0..600usize, byte in any::<u8>(), cut in 0..600usize) {
            let mut bytes = some_map().to_bytes();
            let length = bytes.len();
            bytes[at % length] = byte;
            let _ = CoverageMap::from_bytes(&bytes);
            let _ = CoverageMap::from_bytes(&bytes[..cut % length]);
        }
    }
}
