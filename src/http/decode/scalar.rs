//! Numbers as bytes.

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    F32,
    F64,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

/// What is accepted, for messages.
pub(super) const ACCEPTED: &str = "64- or 32-bit floats, or integers";

impl Scalar {
    pub(super) const fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::F32 | Self::I32 | Self::U32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }

    /// An integer of so many bits.
    pub(super) const fn integer(signed: bool, bits: usize) -> Option<Self> {
        Some(match (signed, bits) {
            (true, 8) => Self::I8,
            (true, 16) => Self::I16,
            (true, 32) => Self::I32,
            (true, 64) => Self::I64,
            (false, 8) => Self::U8,
            (false, 16) => Self::U16,
            (false, 32) => Self::U32,
            (false, 64) => Self::U64,
            _ => return None,
        })
    }

    /// Reads a number from each record, which holds it from byte `at` on; records that are too short hold none.
    /// Integers that f64 rounds are far outside of any range that is accepted.
    pub(super) fn extend(self, records: &[u8], record: usize, at: usize, big: bool, numbers: &mut Vec<f64>) {
        macro_rules! each {
            ($type:ty, $number:ident => $convert:expr) => {
                if record == size_of::<$type>() && !big {
                    // One after the other: the loop becomes one copy or a few vector instructions.
                    let (cells, _) = records.as_chunks();
                    numbers.extend(cells.iter().map(|cell| {
                        let $number = <$type>::from_le_bytes(*cell);
                        $convert
                    }));
                } else {
                    let cells = records.chunks_exact(record).filter_map(|r| r.get(at..)?.first_chunk());
                    numbers.extend(cells.map(|cell| {
                        let $number =
                            if big { <$type>::from_be_bytes(*cell) } else { <$type>::from_le_bytes(*cell) };
                        $convert
                    }));
                }
            };
        }
        match self {
            Self::F64 => each!(f64, number => number),
            Self::F32 => each!(f32, number => f64::from(number)),
            Self::I8 => each!(i8, number => f64::from(number)),
            Self::I16 => each!(i16, number => f64::from(number)),
            Self::I32 => each!(i32, number => f64::from(number)),
            Self::I64 => each!(i64, number => number as f64),
            Self::U8 => each!(u8, number => f64::from(number)),
            Self::U16 => each!(u16, number => f64::from(number)),
            Self::U32 => each!(u32, number => f64::from(number)),
            Self::U64 => each!(u64, number => number as f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Scalar;

    #[test]
    fn numbers_are_read_from_the_middle_of_records_in_either_order() {
        let mut numbers = Vec::new();
        let little: Vec<u8> = [1.5f64, -0.1].iter().flat_map(|x| x.to_le_bytes()).collect();
        Scalar::F64.extend(&little, 8, 0, false, &mut numbers);
        let mut records = Vec::new();
        for x in [300_i16, -2] {
            records.extend([7, 7]);
            records.extend(x.to_be_bytes());
        }
        Scalar::I16.extend(&records, 4, 2, true, &mut numbers);
        Scalar::U8.extend(&records, 4, 3, false, &mut numbers);
        assert_eq!(numbers, [1.5, -0.1, 300.0, -2.0, 44.0, 254.0]);
        // Beyond its record there is no number.
        Scalar::F64.extend(&records, 4, 0, false, &mut numbers);
        assert_eq!(numbers.len(), 6);
    }
}
