//! Checksums as text.

use std::fmt;

use hmac_sha256::Hash;

/// SHA-256 of all that a value says of itself.
pub(crate) fn sha256(value: &impl fmt::Debug) -> String {
    struct Sink(Hash);
    impl fmt::Write for Sink {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut sink = Sink(Hash::new());
    let _ = fmt::write(&mut sink, format_args!("{value:?}"));
    hexadecimal(&sink.0.finalize())
}

/// SHA-256 of bytes.
#[cfg(feature = "cli")]
pub(crate) fn sha256_of(bytes: &[u8]) -> String {
    hexadecimal(&Hash::hash(bytes))
}

/// Two digits a byte.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
