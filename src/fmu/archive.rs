//! A ZIP file: entries, deflated where that is shorter, the same bytes every time. In: names and contents. Out: bytes.
//!
//! Format: APPNOTE.TXT 6.3, PKWARE, without extensions.

use miniz_oxide::deflate::compress_to_vec;

/// First of January 1980: no file tells when it was made.
const DATE: u16 = 0x21;
/// Of the deflater, 0 to 10: from here on files get hardly shorter.
const LEVEL: u8 = 7;

/// An archive under construction.
pub struct Archive {
    bytes: Vec<u8>,
    directory: Vec<u8>,
    count: u16,
}

impl Archive {
    pub fn new() -> Self {
        Self { bytes: Vec::new(), directory: Vec::new(), count: 0 }
    }

    /// Adds a file; its name has `/` between folders.
    pub fn add(&mut self, name: &str, content: &[u8]) {
        let deflated = compress_to_vec(content, LEVEL);
        let (method, stored) =
            if deflated.len() < content.len() { (8_u16, &*deflated) } else { (0, content) };
        let offset = size(self.bytes.len());
        let mut header = Vec::new();
        // Names in UTF-8.
        for field in [20, 0x800, method, 0, DATE] {
            header.extend(field.to_le_bytes());
        }
        for field in [sum(content), size(stored.len()), size(content.len())] {
            header.extend(field.to_le_bytes());
        }
        header.extend((size(name.len()) as u16).to_le_bytes());
        header.extend(0_u16.to_le_bytes());
        self.bytes.extend(b"PK\x03\x04");
        self.bytes.extend(&header);
        self.bytes.extend(name.as_bytes());
        self.bytes.extend(stored);
        self.directory.extend(b"PK\x01\x02");
        // Made by Unix, as a regular file that all may read; libraries need no more.
        self.directory.extend(0x031e_u16.to_le_bytes());
        self.directory.extend(&header);
        for field in [0_u16, 0, 0] {
            self.directory.extend(field.to_le_bytes());
        }
        self.directory.extend((0o100_644_u32 << 16).to_le_bytes());
        self.directory.extend(offset.to_le_bytes());
        self.directory.extend(name.as_bytes());
        self.count += 1;
    }

    /// The whole file.
    pub fn finish(mut self) -> Vec<u8> {
        let (begin, length) = (size(self.bytes.len()), size(self.directory.len()));
        self.bytes.append(&mut self.directory);
        self.bytes.extend(b"PK\x05\x06");
        for field in [0, 0, self.count, self.count] {
            self.bytes.extend(field.to_le_bytes());
        }
        self.bytes.extend(length.to_le_bytes());
        self.bytes.extend(begin.to_le_bytes());
        self.bytes.extend(0_u16.to_le_bytes());
        self.bytes
    }
}

/// Units are some megabytes long.
fn size(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

/// CRC-32 of ISO 3309, as ZIP has it.
fn sum(bytes: &[u8]) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut index = 0;
        while index < 256 {
            let (mut value, mut bit) = (index as u32, 0);
            while bit < 8 {
                value = (value >> 1) ^ (0xedb8_8320 & (value & 1).wrapping_neg());
                bit += 1;
            }
            table[index] = value;
            index += 1;
        }
        table
    };
    !bytes.iter().fold(!0, |sum, byte| (sum >> 8) ^ TABLE[usize::from(sum as u8 ^ byte)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_sum_is_that_of_the_standard() {
        // The check value of the catalogue of CRC algorithms.
        assert_eq!(sum(b"123456789"), 0xcbf4_3926);
    }
}
