//! Content codings, RFC 9110 section 8.4: which the service knows, which a client wants, answers packed and bodies
//! unpacked.

mod accept;
pub(crate) mod compress;
pub(crate) mod expand;
mod pack;

pub(crate) use accept::Wanted;

/// A content coding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    Zstd,
    Brotli,
    Gzip,
}

impl Coding {
    /// Every coding, those first that cost less for what they save.
    pub(crate) const ALL: [Self; 3] = [Self::Zstd, Self::Brotli, Self::Gzip];
    /// Their names, as headers list them.
    pub(crate) const LIST: &'static str = "zstd, br, gzip";

    /// The name in headers.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Zstd => "zstd",
            Self::Brotli => "br",
            Self::Gzip => "gzip",
        }
    }

    /// By a name in any case.
    fn find(name: &str) -> Option<Self> {
        let name = if name.eq_ignore_ascii_case("x-gzip") { "gzip" } else { name };
        Self::ALL.into_iter().find(|coding| coding.name().eq_ignore_ascii_case(name))
    }
}

#[cfg(test)]
mod tests {
    use super::Coding;

    #[test]
    fn the_list_names_every_coding() {
        assert_eq!(Coding::LIST, Coding::ALL.map(Coding::name).join(", "));
        for coding in Coding::ALL {
            assert_eq!(Coding::find(&coding.name().to_uppercase()), Some(coding));
        }
        assert_eq!(Coding::find("deflate"), None);
    }
}
