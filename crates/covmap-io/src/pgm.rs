//! Portable grey maps: the images of map_server.

use covmap::{Grid, GridError};
use nalgebra::Point2;

/// What is wrong with an image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PgmError {
    /// The file is empty.
    #[error("the image is empty")]
    Empty,
    /// A grey map whose samples are written as text.
    #[error(
        "a PGM image in text form (P2) is not read; make it binary (P5), \
         for instance with `pnmtopnm map.pgm > binary.pgm`"
    )]
    Text,
    /// No grey map at all.
    #[error("not a PGM image: it does not begin with P5")]
    Magic,
    /// A number of the header is missing or is none.
    #[error("the header of the PGM image has no valid {0}")]
    Header(&'static str),
    /// A largest sample that PGM does not have.
    #[error("the PGM image has a maxval of {0}, which must be in 1..=65535")]
    MaxValue(u64),
    /// Absurd dimensions.
    #[error("the PGM image cannot be a map: {0}")]
    Size(#[from] GridError),
    /// The file ends before the image does.
    #[error(
        "the PGM image ends early: {width} × {height} pixels need {expected} bytes \
         and there are {actual}"
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
    /// A sample larger than the header allows.
    #[error("a pixel of the PGM image is {value}, above its maxval of {max_value}")]
    Sample {
        /// The sample.
        value: u16,
        /// The largest sample of the header.
        max_value: u16,
    },
}

/// A grey image, row by row from the **top** left.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pgm {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) max_value: u16,
    pub(crate) samples: Vec<u16>,
}

struct Header<'a>(&'a [u8]);

impl Header<'_> {
    /// The next number, behind white space and comments.
    fn number(&mut self, name: &'static str) -> Result<u64, PgmError> {
        loop {
            self.0 = self.0.trim_ascii_start();
            if self.0.first() != Some(&b'#') {
                break;
            }
            let end = self.0.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            self.0 = &self.0[end.unwrap_or(self.0.len())..];
        }
        let digits = self.0.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = self.0.split_at(digits);
        self.0 = rest;
        let number = std::str::from_utf8(number).ok().and_then(|text| text.parse().ok());
        number.ok_or(PgmError::Header(name))
    }

    /// The one byte of white space that ends the header.
    fn end(&mut self) -> Result<(), PgmError> {
        match self.0.split_first() {
            Some((space, rest)) if space.is_ascii_whitespace() => {
                self.0 = rest;
                Ok(())
            }
            _ => Err(PgmError::Header("end")),
        }
    }
}

impl Pgm {
    /// The image that the bytes of a P5 file hold; bytes behind the image do not matter.
    /// Nothing is allocated before the sizes are checked.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, PgmError> {
        let mut header = match bytes {
            [] => return Err(PgmError::Empty),
            [b'P', b'5', rest @ ..] => Header(rest),
            [b'P', b'2', ..] => return Err(PgmError::Text),
            _ => return Err(PgmError::Magic),
        };
        let mut side = |name| {
            let number = header.number(name)?;
            Ok::<_, PgmError>(usize::try_from(number).unwrap_or(usize::MAX))
        };
        let (width, height) = (side("width")?, side("height")?);
        let max_value = header.number("maxval")?;
        header.end()?;
        let max_value = match u16::try_from(max_value) {
            Ok(value) if value > 0 => value,
            _ => return Err(PgmError::MaxValue(max_value)),
        };
        let cells = Grid::new(Point2::origin(), 1.0, width, height)?.len();
        let sample_size = if max_value > 255 { 2 } else { 1 };
        let (expected, actual) = (cells * sample_size, header.0.len());
        let Some(pixels) = header.0.get(..expected) else {
            return Err(PgmError::Truncated { width, height, expected, actual });
        };
        let samples: Vec<u16> = if sample_size == 1 {
            pixels.iter().map(|byte| u16::from(*byte)).collect()
        } else {
            pixels.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect()
        };
        match samples.iter().find(|sample| **sample > max_value) {
            Some(value) => Err(PgmError::Sample { value: *value, max_value }),
            None => Ok(Self { width, height, max_value, samples }),
        }
    }
}

/// The bytes of a P5 file with 8-bit samples, row by row from the **top** left.
pub(crate) fn pgm_bytes(width: usize, height: usize, comment: &str, samples: &[u8]) -> Vec<u8> {
    let mut bytes = format!("P5\n# {comment}\n{width} {height}\n255\n").into_bytes();
    bytes.extend(samples);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parse(bytes: &[u8]) -> Result<Pgm, String> {
        Pgm::from_bytes(bytes).map_err(|error| error.to_string())
    }

    #[track_caller]
    fn refuse(bytes: &[u8], expected: &str) {
        let error = parse(bytes).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn comments_may_stand_anywhere_in_the_header() {
        let image = parse(b"P5 # one\n#two\r\n3#three\n 1\t# 9 9\n200\n\x00\x0a\xc8 more").unwrap();
        assert_eq!(image, Pgm { width: 3, height: 1, max_value: 200, samples: vec![0, 10, 200] });
    }

    #[test]
    fn samples_of_16_bits_have_their_high_byte_first() {
        let image = parse(b"P5 2 1 65535 \x01\x02\xff\xff").unwrap();
        assert_eq!(image.samples, [0x0102, 0xffff]);
    }

    #[test]
    fn what_is_written_is_read() {
        let image = parse(&pgm_bytes(2, 2, "a map", &[1, 2, 3, 255])).unwrap();
        assert_eq!(image, Pgm { width: 2, height: 2, max_value: 255, samples: vec![1, 2, 3, 255] });
    }

    #[test]
    fn a_damaged_image_is_refused_in_one_clear_sentence() {
        refuse(b"", "is empty");
        refuse(b"P2\n1 1\n255\n0", "make it binary (P5)");
        refuse(b"\x89PNG\r\n", "does not begin with P5");
        refuse(b"P5", "no valid width");
        refuse(b"P5 -3 4 255 ", "no valid width");
        refuse(b"P5 3 99999999999999999999999 255 ", "no valid height");
        refuse(b"P5 3 # 4 255 ", "no valid height");
        refuse(b"P5 1 1 0 a", "maxval of 0");
        refuse(b"P5 1 1 65536 a", "maxval of 65536");
        refuse(b"P5 1 1 255", "no valid end");
        refuse(b"P5 0 5 255 ", "0 × 5 cells is empty");
        refuse(b"P5 5000 5000 255 ", "more than 20000000 cells");
        refuse(b"P5 18446744073709551615 2 255 ", "more than 20000000 cells");
        refuse(b"P5 2 2 255 abc", "2 × 2 pixels need 4 bytes and there are 3");
        refuse(b"P5 2 1 256 abc", "2 × 1 pixels need 4 bytes and there are 3");
        refuse(b"P5 1 1 100 e", "is 101, above its maxval of 100");
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..60),
                                       header in "P5[ 0-9#\n]{0,30}") {
            let _ = Pgm::from_bytes(&bytes);
            let _ = Pgm::from_bytes(&[header.as_bytes(), &bytes].concat());
        }
    }
}
