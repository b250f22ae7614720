//! One source, several instruction sets: a loop over branch-free arithmetic is compiled for each, and
//! the widest that the processor has is chosen when the program runs. No set fuses a multiplication
//! with an addition, so all of them give the same bits.

/// What a batch is computed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// What the program was compiled for.
    Portable,
    /// 4 doubles at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2(HasAvx2),
    /// 8 doubles at a time.
    #[cfg(target_arch = "x86_64")]
    Avx512(HasAvx512),
}

/// Proof that the processor said that it has AVX2: made nowhere but in [`InstructionSet::available`].
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HasAvx2(());

/// The same of AVX-512. A type of its own: the one proof is not good for the other.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HasAvx512(());

impl InstructionSet {
    /// All that this processor has, the widest last.
    pub fn available() -> impl Iterator<Item = Self> {
        let portable = [Some(Self::Portable)];
        #[cfg(target_arch = "x86_64")]
        let wider = [
            std::arch::is_x86_feature_detected!("avx2").then_some(Self::Avx2(HasAvx2(()))),
            (std::arch::is_x86_feature_detected!("avx512f")
                && std::arch::is_x86_feature_detected!("avx512dq")
                && std::arch::is_x86_feature_detected!("avx512vl"))
            .then_some(Self::Avx512(HasAvx512(()))),
        ];
        #[cfg(not(target_arch = "x86_64"))]
        let wider = [];
        portable.into_iter().chain(wider).flatten()
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::available().last().unwrap_or(Self::Portable)
    }

    /// The name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "avx512",
        }
    }
}

/// Defines a function that runs an `#[inline(always)]` one as compiled for the given instruction set.
macro_rules! vectorized {
    ($(#[$doc:meta])* $visibility:vis fn $name:ident = $body:path, ($($argument:ident: $type:ty),* $(,)?)) => {
        $(#[$doc])*
        $visibility fn $name(set: $crate::reflectance::numeric::dispatch::InstructionSet, $($argument: $type),*) {
            use $crate::reflectance::numeric::dispatch::InstructionSet;
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            fn avx2($($argument: $type),*) {
                $body($($argument),*);
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
            fn avx512($($argument: $type),*) {
                $body($($argument),*);
            }
            match set {
                InstructionSet::Portable => $body($($argument),*),
                // SAFETY: the proof inside is made only where the processor said that it has these features.
                #[cfg(target_arch = "x86_64")]
                #[expect(unsafe_code, reason = "3 to 4 times as fast: cargo bench --bench speed")]
                InstructionSet::Avx2(_) => unsafe { avx2($($argument),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                #[expect(unsafe_code, reason = "3 to 4 times as fast: cargo bench --bench speed")]
                InstructionSet::Avx512(_) => unsafe { avx512($($argument),*) },
            }
        }
    };
}
pub(crate) use vectorized;
