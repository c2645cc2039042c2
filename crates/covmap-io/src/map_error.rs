//! Errors of the maps of map_server.

use covmap::GridError;

/// The most pixels of an image. The unknown border around the known part costs no memory, so this
/// is more than a grid may have.
const MAX_PIXELS: u64 = 1 << 26;

/// Error of the description of a map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapServerError {
    /// A key is missing.
    #[error("the key `{0}` is missing")]
    Missing(&'static str),
    /// The origin does not have three values.
    #[error("the origin is [x, y, yaw], in metres and radians: three numbers, not {0}")]
    Origin(usize),
    /// The yaw is no angle.
    #[error("the origin has a yaw of {0}, which must be a finite number of radians")]
    Yaw(f64),
    /// All pixels are unknown.
    #[error("all of its {0} × {1} pixels are unknown, so there is no map; look at the thresholds")]
    Unknown(usize, usize),
    /// The thresholds are out of order or out of range.
    #[error("free_thresh {free} and occupied_thresh {occupied} must be in order, and in 0..=1")]
    Thresholds {
        /// `free_thresh`.
        free: f64,
        /// `occupied_thresh`.
        occupied: f64,
    },
    /// The mode is none of map_server.
    #[error("the mode `{0}` is none of trinary, scale, raw")]
    Mode(String),
    /// The resolution or the origin is invalid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Error of an image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImageError {
    /// The file is empty.
    #[error("the image is empty")]
    Empty,
    /// The file is neither a PGM nor a PNG image.
    #[error("is {0}; the image of a map is PNG or PGM (P5 or P2): convert it")]
    Unread(&'static str),
    /// A number of a PGM header is missing or invalid.
    #[error("the header of the PGM image has no valid {0}")]
    Header(&'static str),
    /// The largest sample is not one of PGM.
    #[error("the PGM image has a maxval of {0}, which must be in 1..=65535")]
    MaxValue(u64),
    /// Absurd dimensions.
    #[error("{0} × {1} pixels are no map: there must be 1 to {MAX_PIXELS} in all")]
    Size(u64, u64),
    /// The file ends before the image does.
    #[error(
        "the image ends early: {width} × {height} pixels need {expected} bytes and there are \
         {actual}"
    )]
    Truncated {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Bytes that the pixels need.
        expected: usize,
        /// Bytes behind the header.
        actual: usize,
    },
    /// A PGM image in text form (P2) with too few numbers.
    #[error("the PGM image does not hold the numbers of {width} × {height} pixels")]
    NoSample {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A sample larger than the header allows.
    #[error("a pixel of the PGM image is {value}, above its maxval of {max_value}")]
    Sample {
        /// The sample.
        value: u16,
        /// The largest sample of the header.
        max_value: u16,
    },
    /// A binary image was transferred as if it were text.
    #[error("the line ends of the image were changed, and pixels with them: copy the file again")]
    LineEnds,
    /// A PNG image that is damaged.
    #[error("the PNG image is damaged or ends early")]
    Png,
}

impl ImageError {
    /// Returns the size of an image, if the number of its pixels is in range.
    pub(crate) fn check_size(width: u64, height: u64) -> Result<(usize, usize), Self> {
        match (usize::try_from(width), usize::try_from(height), width.checked_mul(height)) {
            (Ok(columns), Ok(rows), Some(1..=MAX_PIXELS)) => Ok((columns, rows)),
            _ => Err(Self::Size(width, height)),
        }
    }
}
