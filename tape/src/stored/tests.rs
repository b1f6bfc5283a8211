use proptest::prelude::*;

use super::*;

fn back<T: Stored + PartialEq + std::fmt::Debug>(value: &T) {
    assert_eq!(unsealed::<T>(&sealed(value)).as_ref(), Ok(value));
}

#[test]
fn numbers_come_back_by_their_bits() {
    for number in [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::INFINITY, f64::NAN, 0.1] {
        let read: f64 = unsealed(&sealed(&number)).expect("a number");
        assert_eq!(read.to_bits(), number.to_bits());
    }
    for whole in [0, 127, 128, 16_383, 16_384, u64::from(u32::MAX) + 1, u64::MAX] {
        back(&whole);
    }
    back(&vec![("text".to_owned(), Some(1_u32), true), (String::new(), None, false)]);
}

#[test]
fn what_is_no_file_of_ours_or_older_says_so() {
    let bytes = sealed(&7_u64);
    assert_eq!(unsealed::<u64>(b"PK\x03\x04 and so on"), Err(Damage::Mark));
    assert_eq!(unsealed::<u64>(&bytes[..10]), Err(Damage::Short));
    let mut older = bytes.clone();
    older[8] = 9;
    assert_eq!(unsealed::<u64>(&older), Err(Damage::Version { found: 9, expected: VERSION }));
    assert_eq!(unsealed::<u32>(&sealed(&u64::MAX)), Err(Damage::value("a whole number is too large")));
    assert_eq!(unsealed::<u8>(&sealed(&u64::MAX)), Err(Damage::Sum));
}

#[test]
fn any_changed_bit_is_seen() {
    let bytes = sealed(&vec!["one".to_owned(), "two".to_owned()]);
    for place in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1 << bit;
            assert!(unsealed::<Vec<String>>(&damaged).is_err(), "bit {bit} of byte {place}");
        }
    }
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = crate::Tape::read(&mut &bytes[..]);
        let _ = linkwear_runtime::Description::read(&mut &bytes[..]);
        let _ = crate::Program::read(&mut &bytes[..]);
    }
}
