//! The image of a map: PGM or PNG, as its first bytes say.

use crate::map_error::ImageError;
use crate::pgm::Pgm;
use png::{ColorType, Decoder, DecodingError, Limits, Reader, Transformations};
use std::io::Cursor;

/// The most memory that the rows of a PNG image may need \[bytes\].
const MAX_PNG: usize = 1 << 28;

impl From<DecodingError> for ImageError {
    fn from(_: DecodingError) -> Self {
        Self::Png
    }
}

/// An image whose rows are read from the **top** on.
pub(crate) struct Image<'a> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Sum of the colours of a white pixel.
    pub(crate) white: u32,
    format: Format<'a>,
}

enum Format<'a> {
    Pgm(Pgm<'a>, Vec<u16>),
    Png(Box<Png<'a>>),
}

impl<'a> Image<'a> {
    /// Returns the image that a file holds.
    pub(crate) fn new(file: &'a [u8]) -> Result<Self, ImageError> {
        match file {
            [] => Err(ImageError::Empty),
            [0x89, b'P', b'N', b'G', ..] => Self::png(file),
            [0xff, 0xd8, ..] => Err(ImageError::Unread("a JPEG image")),
            [b'B', b'M', ..] => Err(ImageError::Unread("a BMP image")),
            [b'G', b'I', b'F', ..] => Err(ImageError::Unread("a GIF image")),
            [b'I', b'I', b'*', 0, ..] | [b'M', b'M', 0, b'*', ..] => {
                Err(ImageError::Unread("a TIFF image"))
            }
            [b'P', b'1' | b'4', ..] => Err(ImageError::Unread("a bitmap (PBM)")),
            [b'P', b'3' | b'6', ..] => Err(ImageError::Unread("a pixmap (PPM)")),
            _ => {
                let pgm = Pgm::new(file)?;
                let (width, height, white) = (pgm.width, pgm.height, pgm.max_value.into());
                Ok(Self { width, height, white, format: Format::Pgm(pgm, Vec::new()) })
            }
        }
    }

    fn png(file: &'a [u8]) -> Result<Self, ImageError> {
        let mut decoder = Decoder::new_with_limits(Cursor::new(file), Limits { bytes: MAX_PNG });
        // Palettes become colours, samples of fewer than eight bits get eight, and a transparent
        // colour becomes alpha.
        decoder.set_transformations(Transformations::EXPAND);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let header = decoder.read_header_info()?;
        let (width, height) = ImageError::check_size(header.width.into(), header.height.into())?;
        let png = Png::new(decoder.read_info()?)?;
        let white = png.white();
        Ok(Self { width, height, white, format: Format::Png(Box::new(png)) })
    }

    /// Puts the next row into `row`: for each pixel the sum of its colours, or `None` if the pixel
    /// is not opaque.
    pub(crate) fn next_row(&mut self, row: &mut Vec<Option<u32>>) -> Result<(), ImageError> {
        row.clear();
        match &mut self.format {
            Format::Pgm(pgm, samples) => {
                pgm.next_row(samples)?;
                row.extend(samples.iter().map(|sample| Some(u32::from(*sample))));
                Ok(())
            }
            Format::Png(png) => png.next_row(row),
        }
    }

    /// Checks the data behind the last row.
    pub(crate) fn finish(self) -> Result<(), ImageError> {
        match self.format {
            Format::Png(mut png) => Ok(png.reader.finish()?),
            Format::Pgm(..) => Ok(()),
        }
    }
}

struct Png<'a> {
    reader: Reader<Cursor<&'a [u8]>>,
    /// Number of colour samples of a pixel; `has_alpha` tells of one more sample for opacity.
    colors: usize,
    has_alpha: bool,
    is_wide: bool,
    /// One row; if rows are not stored in their order, the whole image.
    bytes: Vec<u8>,
    line: usize,
    /// Start of the next row in `bytes`, for an image whose rows are not in order.
    next: Option<usize>,
}

impl<'a> Png<'a> {
    fn new(mut reader: Reader<Cursor<&'a [u8]>>) -> Result<Self, ImageError> {
        let (color, depth) = reader.output_color_type();
        let (colors, has_alpha) = match color {
            ColorType::Grayscale | ColorType::Indexed => (1, false),
            ColorType::GrayscaleAlpha => (1, true),
            ColorType::Rgb => (3, false),
            ColorType::Rgba => (3, true),
        };
        let is_wide = depth == png::BitDepth::Sixteen;
        let line = reader.output_line_size(reader.info().width).ok_or(ImageError::Png)?;
        let is_interlaced = reader.info().interlaced;
        let needed = if is_interlaced { reader.output_buffer_size() } else { Some(line) };
        let needed = needed.filter(|bytes| *bytes <= MAX_PNG).ok_or(ImageError::Png)?;
        let mut bytes = vec![0; needed];
        if is_interlaced {
            reader.next_frame(&mut bytes)?;
        }
        let next = is_interlaced.then_some(0);
        Ok(Self { reader, colors, has_alpha, is_wide, bytes, line, next })
    }

    /// Returns the largest value of a sample.
    fn largest(&self) -> u32 {
        if self.is_wide { 65535 } else { 255 }
    }

    /// Returns the sum of the colours of a white pixel.
    fn white(&self) -> u32 {
        if self.colors == 1 { self.largest() } else { 3 * self.largest() }
    }

    fn next_row(&mut self, row: &mut Vec<Option<u32>>) -> Result<(), ImageError> {
        let begin = match &mut self.next {
            Some(next) => {
                *next += self.line;
                *next - self.line
            }
            None => {
                self.reader.read_row(&mut self.bytes)?.ok_or(ImageError::Png)?;
                0
            }
        };
        let line = self.bytes.get(begin..begin + self.line).ok_or(ImageError::Png)?;
        let size = if self.is_wide { 2 } else { 1 };
        let value = |sample: &[u8]| sample.iter().fold(0, |all, byte| all << 8 | u32::from(*byte));
        let samples = self.colors + usize::from(self.has_alpha);
        row.extend(line.chunks_exact(samples * size).map(|pixel| {
            let (colors, alpha) = pixel.split_at(self.colors * size);
            let is_opaque = !self.has_alpha || value(alpha) == self.largest();
            is_opaque.then(|| colors.chunks_exact(size).map(value).sum())
        }));
        Ok(())
    }
}
