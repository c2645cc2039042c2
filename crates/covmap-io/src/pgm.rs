//! Portable grey maps: the images of map_server.

use crate::map_error::ImageError;

/// A grey image of the kind P5 (binary) or P2 (text), whose rows are read from the **top** on.
#[derive(Debug)]
pub(crate) struct Pgm<'a> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) max_value: u16,
    samples: Samples<'a>,
}

/// The samples that are still to be read.
#[derive(Debug)]
enum Samples<'a> {
    Text(Numbers<'a>),
    Bytes(&'a [u8]),
    /// The high byte first.
    Pairs(&'a [u8]),
}

impl<'a> Pgm<'a> {
    /// Returns the image that a file holds. Bytes behind the image are ignored, and nothing is allocated.
    pub(crate) fn new(file: &'a [u8]) -> Result<Self, ImageError> {
        let (is_text, rest) = match file {
            [b'P', b'5', rest @ ..] => (false, rest),
            [b'P', b'2', rest @ ..] => (true, rest),
            _ => return Err(ImageError::Unread("no image that is known here")),
        };
        let mut numbers = Numbers(rest);
        let mut number = |name| numbers.next().ok_or(ImageError::Header(name));
        let (width, height, max_value) = (number("width")?, number("height")?, number("maxval")?);
        let (width, height) = ImageError::check_size(width, height)?;
        let max_value = match u16::try_from(max_value) {
            Ok(value) if value > 0 => value,
            _ => return Err(ImageError::MaxValue(max_value)),
        };
        let samples = if is_text {
            Samples::Text(numbers)
        } else {
            let is_wide = max_value > 255;
            let expected = width * height * if is_wide { 2 } else { 1 };
            let bytes = numbers.binary(file, expected)?;
            let actual = bytes.len();
            if actual < expected {
                return Err(ImageError::Truncated { width, height, expected, actual });
            }
            if is_wide { Samples::Pairs(bytes) } else { Samples::Bytes(bytes) }
        };
        Ok(Self { width, height, max_value, samples })
    }

    /// Puts the samples of the next row into `row`.
    pub(crate) fn next_row(&mut self, row: &mut Vec<u16>) -> Result<(), ImageError> {
        let &mut Self { width, height, max_value, .. } = self;
        row.clear();
        match &mut self.samples {
            Samples::Bytes(bytes) => {
                let now = bytes.split_off(..width).unwrap_or_default();
                row.extend(now.iter().map(|byte| u16::from(*byte)));
            }
            Samples::Pairs(bytes) => {
                let now = bytes.split_off(..2 * width).unwrap_or_default();
                row.extend(now.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])));
            }
            Samples::Text(numbers) => {
                for _ in 0..width {
                    let value = numbers.next().ok_or(ImageError::NoSample { width, height })?;
                    // Refused next, unless the largest sample is 65535.
                    row.push(u16::try_from(value).unwrap_or(u16::MAX));
                }
            }
        }
        match row.iter().find(|sample| **sample > max_value) {
            Some(value) => Err(ImageError::Sample { value: *value, max_value }),
            None => Ok(()),
        }
    }
}

/// Numbers in text, with comments between them.
#[derive(Debug)]
struct Numbers<'a>(&'a [u8]);

impl<'a> Numbers<'a> {
    fn next(&mut self) -> Option<u64> {
        self.0 = self.0.trim_ascii_start();
        while self.0.first() == Some(&b'#') {
            self.0 = from_line_end(self.0).trim_ascii_start();
        }
        let digits = self.0.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = self.0.split_at(digits);
        self.0 = rest;
        std::str::from_utf8(number).ok()?.parse().ok()
    }

    /// Returns the binary samples behind the header of a file.
    ///
    /// One byte of white space ends a header, and a pixel may have any value: bytes that look like
    /// a line end of two bytes, or like one more comment, may be pixels. The header ends with CR LF
    /// if other lines of it do, or if there are enough bytes behind both. A comment counts as one
    /// if exactly the image is behind it.
    fn binary(&self, file: &[u8], expected: usize) -> Result<&'a [u8], ImageError> {
        let end = if self.0.first() == Some(&b'#') { from_line_end(self.0) } else { self.0 };
        let space = end.first().is_some_and(u8::is_ascii_whitespace);
        let plain = end.get(1..).filter(|_| space).ok_or(ImageError::Header("end"))?;
        let is_crlf = line_ends(&file[..file.len() - end.len()]) > 0;
        let begin = match end.strip_prefix(b"\r\n") {
            Some(behind) if is_crlf || behind.len() >= expected => behind,
            _ => plain,
        };
        let mut behind_comments = begin;
        while behind_comments.len() > expected && behind_comments.first() == Some(&b'#') {
            let end = from_line_end(behind_comments);
            behind_comments = end.strip_prefix(b"\r\n").or(end.get(1..)).unwrap_or_default();
        }
        if behind_comments.len() == expected {
            return Ok(behind_comments);
        }
        // A transfer as text makes CR LF of every pixel of value 10.
        if is_crlf && begin.len().checked_sub(expected) == Some(line_ends(begin)) {
            return Err(ImageError::LineEnds);
        }
        Ok(begin)
    }
}

/// Returns the text from the end of its first line on.
fn from_line_end(text: &[u8]) -> &[u8] {
    let end = text.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    &text[end.unwrap_or(text.len())..]
}

/// Returns the number of lines that end with CR LF.
fn line_ends(text: &[u8]) -> usize {
    text.windows(2).filter(|pair| pair == b"\r\n").count()
}

/// Returns the bytes of a P5 file with 8-bit samples, row by row from the **top** left, with a
/// comment of one or more lines.
pub(crate) fn pgm_bytes(width: usize, height: usize, comment: &str, samples: &[u8]) -> Vec<u8> {
    let comment: String = comment.lines().map(|line| format!("# {line}\n")).collect();
    let mut bytes = format!("P5\n{comment}{width} {height}\n255\n").into_bytes();
    bytes.extend(samples);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the largest sample, and all rows.
    fn parse(file: &[u8]) -> Result<(u16, Vec<Vec<u16>>), String> {
        let read = || {
            let mut pgm = Pgm::new(file)?;
            let mut row = Vec::new();
            let rows = (0..pgm.height).map(|_| pgm.next_row(&mut row).map(|()| row.clone()));
            let rows = rows.collect::<Result<_, _>>()?;
            Ok((pgm.max_value, rows))
        };
        read().map_err(|error: ImageError| error.to_string())
    }

    #[track_caller]
    fn check(file: &[u8], max_value: u16, rows: &[&[u16]]) {
        let rows = rows.iter().map(|row| row.to_vec()).collect();
        assert_eq!(parse(file), Ok((max_value, rows)));
    }

    #[track_caller]
    fn refuse(file: &[u8], expected: &str) {
        let error = parse(file).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn comments_may_stand_anywhere_in_the_header() {
        let file = b"P5 # one\n#two\r\n3#three\n 1\t# 9 9\n200\n\x00\x0a\xc8";
        check(file, 200, &[&[0, 10, 200]]);
        check(b"P5#\n#\n2 1 255#last\nab", 255, &[&[97, 98]]);
        check(b"P2 2 #\n 2 9 1 # 8\n 2#\n3 4", 9, &[&[1, 2], &[3, 4]]);
    }

    #[test]
    fn a_comment_behind_the_header_is_told_from_pixels_by_the_size() {
        check(b"P5\n2 1\n255\n# written by hand\nab", 255, &[&[97, 98]]);
        check(b"P5\r\n2 1\r\n255\r\n# one\r\n# two\r\nab", 255, &[&[97, 98]]);
        check(b"P5\n3 1\n255\n#\nb", 255, &[&[35, 10, 98]]);
    }

    #[test]
    fn lines_of_the_header_may_end_with_two_bytes() {
        check(b"P5\r\n2 2\r\n255\r\nabcd", 255, &[&[97, 98], &[99, 100]]);
        check(b"P5 2 2 255\r\nabcd", 255, &[&[97, 98], &[99, 100]]);
        check(b"P5\r\n1 2\r\n255\r\n\r\n", 255, &[&[13], &[10]]);
        check(b"P5\r\n1 2\r\n255\nab", 255, &[&[97], &[98]]);
        check(b"P2\r\n2 1\r\n255\r\n7 8\r\n", 255, &[&[7, 8]]);
        // With line ends of one CR, a pixel of value 10 is a pixel.
        check(b"P5\r1 2\r255\r\nb", 255, &[&[10], &[98]]);
        // One byte is missing: the LF is not taken for it.
        refuse(b"P5\r\n2 2\r\n255\r\nabc", "2 × 2 pixels need 4 bytes and there are 3");
        // The pixels are a, 10, c, 10.
        refuse(b"P5\r\n2 2\r\n255\r\na\r\nc\r\n", "copy the file again");
    }

    #[test]
    fn samples_of_16_bits_have_their_high_byte_first() {
        check(b"P5 2 1 65535 \x01\x02\xff\xff", 65535, &[&[0x0102, 0xffff]]);
        check(b"P5 1 2 256 \x01\x00\x00\xff", 256, &[&[256], &[255]]);
        check(b"P2 2 1 65535 65535\n0", 65535, &[&[65535, 0]]);
    }

    #[test]
    fn what_is_written_is_read() {
        let file = pgm_bytes(2, 2, "a map\nof mine", &[1, 2, 3, 255]);
        assert!(file.starts_with(b"P5\n# a map\n# of mine\n2 2\n"));
        check(&file, 255, &[&[1, 2], &[3, 255]]);
    }

    #[test]
    fn a_damaged_image_is_refused_in_one_clear_sentence() {
        refuse(b"P5", "no valid width");
        refuse(b"P5 -3 4 255 ", "no valid width");
        refuse(b"P5 3 99999999999999999999999 255 ", "no valid height");
        refuse(b"P5 3 # 4 255 ", "no valid height");
        refuse(b"P5 1 1 0 a", "maxval of 0");
        refuse(b"P5 1 1 65536 a", "maxval of 65536");
        refuse(b"P5 1 1 255", "no valid end");
        refuse(b"P5 1 1 255x", "no valid end");
        refuse(b"P5 1 1 255#", "no valid end");
        refuse(b"P5 0 5 255 ", "0 × 5 pixels");
        refuse(b"P5 9000 9000 255 ", "9000 × 9000 pixels");
        refuse(b"P5 18446744073709551615 2 255 ", "18446744073709551615 × 2 pixels");
        refuse(b"P5 2 2 255 abc", "2 × 2 pixels need 4 bytes and there are 3");
        refuse(b"P5 2 1 256 abc", "2 × 1 pixels need 4 bytes and there are 3");
        refuse(b"P5 1 1 100 e", "is 101, above its maxval of 100");
        refuse(b"P2 2 2 9 1 2 3", "does not hold the numbers of 2 × 2 pixels");
        refuse(b"P2 2 2 9 1 2 x 3", "does not hold the numbers of 2 × 2 pixels");
        refuse(b"P2 2 1 9 1 -2", "does not hold the numbers of 2 × 1 pixels");
        refuse(b"P2 2 1 9 1 10", "is 10, above its maxval of 9");
        refuse(b"P2 2 1 9 1 99999999", "is 65535, above its maxval of 9");
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..60),
                                       header in "P[25][ 0-9#\r\n]{0,30}") {
            let _ = parse(&bytes);
            let _ = parse(&[header.as_bytes(), &bytes].concat());
        }

        #[test]
        fn any_line_end_and_any_pixels_are_read(
            pixels in prop::collection::vec(any::<u8>(), 6), end in "\n|\r\n| |\t",
        ) {
            let file = [b"P5".as_slice(), b"3 2", b"255"].map(|line| [line, end.as_bytes()].concat());
            let file = [file.concat(), pixels.clone()].concat();
            let rows = pixels.chunks(3).map(|row| row.iter().copied().map(u16::from).collect());
            prop_assert_eq!(parse(&file), Ok((255, rows.collect())));
        }
    }
}
