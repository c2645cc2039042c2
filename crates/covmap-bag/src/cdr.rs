//! CDR, the encoding of messages: little or big endian, with the alignment of its first version.

/// Why a message cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CdrError {
    /// The encoding is not plain CDR.
    #[error("the encoding {0:#04x} is not plain CDR")]
    Encoding(u8),
    /// The message ends before a field.
    #[error("it ends before `{0}`")]
    End(&'static str),
    /// A list or a text is longer than the message.
    #[error("`{field}` would have {count} items, more than the message has room for")]
    Length {
        /// The field.
        field: &'static str,
        /// The announced number of items.
        count: u32,
    },
}

/// The largest number of bytes of the header of the encoding.
const ENCAPSULATION: usize = 4;

/// Reader of the fields of one message, in their order.
///
/// The reader never reads beyond the message, and makes no list longer than the message is.
#[derive(Debug)]
pub struct CdrReader<'a> {
    data: &'a [u8],
    at: usize,
    big_endian: bool,
}

macro_rules! number {
    ($name:ident, $type:ty, $doc:literal) => {
        #[doc = $doc]
        ///
        /// # Errors
        /// If the message ends before.
        pub fn $name(&mut self, field: &'static str) -> Result<$type, CdrError> {
            let bytes = self.aligned(field)?;
            Ok(if self.big_endian {
                <$type>::from_be_bytes(bytes)
            } else {
                <$type>::from_le_bytes(bytes)
            })
        }
    };
}

impl<'a> CdrReader<'a> {
    /// Reads the header of a message's encoding.
    ///
    /// # Errors
    /// If the encoding is not plain CDR.
    pub fn new(message: &'a [u8]) -> Result<Self, CdrError> {
        let encoding = *message.get(1).ok_or(CdrError::End("encoding"))?;
        let data = message.get(ENCAPSULATION..).ok_or(CdrError::End("encoding"))?;
        match encoding {
            0 | 1 => Ok(Self { data, at: 0, big_endian: encoding == 0 }),
            other => Err(CdrError::Encoding(other)),
        }
    }

    number!(u8, u8, "Reads an unsigned number of one byte.");
    number!(i8, i8, "Reads a signed number of one byte.");
    number!(u16, u16, "Reads an unsigned number of two bytes.");
    number!(u32, u32, "Reads an unsigned number of four bytes.");
    number!(i32, i32, "Reads a signed number of four bytes.");
    number!(f32, f32, "Reads a single-precision number.");
    number!(f64, f64, "Reads a double-precision number.");

    /// Reads a truth value.
    ///
    /// # Errors
    /// If the message ends before.
    pub fn bool(&mut self, field: &'static str) -> Result<bool, CdrError> {
        Ok(self.u8(field)? != 0)
    }

    /// Reads a text; bytes that are not UTF-8 are replaced.
    ///
    /// # Errors
    /// If the message ends before, or the text is longer than the message.
    pub fn string(&mut self, field: &'static str) -> Result<String, CdrError> {
        let count = self.count(field, 1)?;
        let bytes = &self.data[self.at..self.at + count];
        self.at += count;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        Ok(String::from_utf8_lossy(text).into_owned())
    }

    /// Reads a list of items of at least `size` bytes each.
    ///
    /// # Errors
    /// If the message ends before, or the list is longer than the message.
    pub fn list<T>(
        &mut self,
        field: &'static str,
        size: usize,
        mut item: impl FnMut(&mut Self) -> Result<T, CdrError>,
    ) -> Result<Vec<T>, CdrError> {
        let count = self.count(field, size)?;
        (0..count).map(|_| item(self)).collect()
    }

    /// Returns whether all of the message was read. A later distribution may have added fields at the
    /// end, which an earlier one does not have.
    pub fn is_at_end(&self) -> bool {
        self.at >= self.data.len()
    }

    /// Reads the number of items of a list.
    fn count(&mut self, field: &'static str, size: usize) -> Result<usize, CdrError> {
        let count = self.u32(field)?;
        let left = self.data.len() - self.at;
        let fits = |n: &usize| n.checked_mul(size.max(1)).is_some_and(|bytes| bytes <= left);
        usize::try_from(count).ok().filter(fits).ok_or(CdrError::Length { field, count })
    }

    fn aligned<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], CdrError> {
        let start = self.at.next_multiple_of(N);
        let bytes = self.data.get(start..start + N).and_then(|bytes| bytes.try_into().ok());
        self.at = start + N;
        bytes.ok_or_else(|| {
            self.at = self.data.len();
            CdrError::End(field)
        })
    }
}

/// Writer of a message in little-endian CDR.
#[derive(Debug, Clone)]
pub struct CdrWriter {
    bytes: Vec<u8>,
}

impl Default for CdrWriter {
    fn default() -> Self {
        Self { bytes: vec![0, 1, 0, 0] }
    }
}

impl CdrWriter {
    /// Adds an unsigned number of one byte.
    pub fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    /// Adds an unsigned number of four bytes.
    pub fn u32(&mut self, value: u32) {
        self.aligned(value.to_le_bytes());
    }

    /// Adds a signed number of four bytes.
    pub fn i32(&mut self, value: i32) {
        self.aligned(value.to_le_bytes());
    }

    /// Adds a single-precision number.
    pub fn f32(&mut self, value: f32) {
        self.aligned(value.to_le_bytes());
    }

    /// Adds a double-precision number.
    pub fn f64(&mut self, value: f64) {
        self.aligned(value.to_le_bytes());
    }

    /// Adds single-precision numbers, without their count.
    pub fn f32s(&mut self, values: &[f32]) {
        values.iter().for_each(|value| self.f32(*value));
    }

    /// Adds double-precision numbers, without their count.
    pub fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.f64(*value));
    }

    /// Adds a text.
    pub fn string(&mut self, text: &str) {
        self.count(text.len() + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    /// Adds a list, item by item.
    pub fn list<T>(&mut self, items: &[T], mut add: impl FnMut(&mut Self, &T)) {
        self.count(items.len());
        items.iter().for_each(|item| add(self, item));
    }

    /// Returns the message.
    pub fn finish(self) -> Vec<u8> {
        self.bytes
    }

    fn count(&mut self, count: usize) {
        self.u32(u32::try_from(count).unwrap_or(u32::MAX));
    }

    fn aligned<const N: usize>(&mut self, bytes: [u8; N]) {
        let length = (self.bytes.len() - ENCAPSULATION).next_multiple_of(N) + ENCAPSULATION;
        self.bytes.resize(length, 0);
        self.bytes.extend_from_slice(&bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_aligned_to_their_size() {
        let mut writer = CdrWriter::default();
        writer.u8(7);
        writer.u32(1);
        writer.string("ab");
        writer.f64(1.5);
        let bytes = writer.finish();
        let expected = [
            &[0, 1, 0, 0][..],
            &[7, 0, 0, 0, 1, 0, 0, 0],
            &[3, 0, 0, 0, b'a', b'b', 0, 0],
            &1.5f64.to_le_bytes(),
        ];
        assert_eq!(bytes, expected.concat());
        let mut reader = CdrReader::new(&bytes).unwrap();
        assert_eq!((reader.u8("a"), reader.u32("b")), (Ok(7), Ok(1)));
        assert_eq!((reader.string("c"), reader.f64("d")), (Ok("ab".to_owned()), Ok(1.5)));
        assert!(reader.is_at_end());
        assert_eq!(reader.u8("e"), Err(CdrError::End("e")));
    }

    #[test]
    fn big_endian_is_read_and_other_encodings_are_refused() {
        let mut reader = CdrReader::new(&[0, 0, 0, 0, 0, 0, 1, 2]).unwrap();
        assert_eq!(reader.u32("a"), Ok(0x102));
        assert_eq!(CdrReader::new(&[0, 7, 0, 0]).unwrap_err(), CdrError::Encoding(7));
        assert_eq!(CdrReader::new(&[0, 1]).unwrap_err(), CdrError::End("encoding"));
    }

    #[test]
    fn a_list_longer_than_its_message_takes_no_memory() {
        let mut reader = CdrReader::new(&[0, 1, 0, 0, 255, 255, 255, 255, 1, 2]).unwrap();
        let list = reader.list("ranges", 4, |r| r.f32("range"));
        assert_eq!(list, Err(CdrError::Length { field: "ranges", count: u32::MAX }));
    }

    proptest! {
        #[test]
        fn no_bytes_do_harm(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
            if let Ok(mut reader) = CdrReader::new(&bytes) {
                while !reader.is_at_end() {
                    let _ = reader.string("a");
                    let _ = reader.f64("b");
                    let _ = reader.list("c", 4, |r| r.f32("d"));
                }
            }
        }
    }
}
