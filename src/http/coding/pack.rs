//! One encoder for each content coding, at its fast level: more effort costs many times the processor time for a
//! tenth of the bytes.

use super::Coding;
use brotli::CompressorWriter;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::{self, Write};
use zstd::stream::write::Encoder;

const ZSTD_LEVEL: i32 = 1;
const GZIP_LEVEL: Compression = Compression::new(1);
const BROTLI_QUALITY: u32 = 1;
/// 256 KiB: answers are columns of numbers, whose digits do not repeat far away.
const BROTLI_LOG_WINDOW: u32 = 18;
const BROTLI_BUFFER: usize = 16 << 10;

/// An answer that is being packed.
pub(super) enum Packer {
    Zstd(Encoder<'static, Vec<u8>>),
    Brotli(Box<CompressorWriter<Vec<u8>>>),
    Gzip(GzEncoder<Vec<u8>>),
}

impl Packer {
    pub(super) fn new(coding: Coding) -> io::Result<Self> {
        Ok(match coding {
            Coding::Zstd => Self::Zstd(Encoder::new(Vec::new(), ZSTD_LEVEL)?),
            Coding::Brotli => Self::Brotli(Box::new(CompressorWriter::new(
                Vec::new(),
                BROTLI_BUFFER,
                BROTLI_QUALITY,
                BROTLI_LOG_WINDOW,
            ))),
            Coding::Gzip => Self::Gzip(GzEncoder::new(Vec::new(), GZIP_LEVEL)),
        })
    }

    /// Takes bytes, and gives what they make; all of it if it is to be flushed.
    pub(super) fn pack(&mut self, bytes: &[u8], flush: bool) -> io::Result<Vec<u8>> {
        fn through(mut writer: impl Write, bytes: &[u8], flush: bool) -> io::Result<()> {
            writer.write_all(bytes)?;
            if flush { writer.flush() } else { Ok(()) }
        }
        match self {
            Self::Zstd(encoder) => through(&mut *encoder, bytes, flush)?,
            Self::Brotli(encoder) => through(&mut **encoder, bytes, flush)?,
            Self::Gzip(encoder) => through(&mut *encoder, bytes, flush)?,
        }
        Ok(std::mem::take(self.out()))
    }

    fn out(&mut self) -> &mut Vec<u8> {
        match self {
            Self::Zstd(encoder) => encoder.get_mut(),
            Self::Brotli(encoder) => encoder.get_mut(),
            Self::Gzip(encoder) => encoder.get_mut(),
        }
    }

    /// The last bytes.
    pub(super) fn finish(self) -> io::Result<Vec<u8>> {
        match self {
            Self::Zstd(encoder) => encoder.finish(),
            Self::Brotli(encoder) => Ok(encoder.into_inner()),
            Self::Gzip(encoder) => encoder.finish(),
        }
    }
}

/// A whole body at once.
pub(super) fn whole(coding: Coding, bytes: &[u8]) -> io::Result<Vec<u8>> {
    if coding == Coding::Zstd {
        // Knows the size beforehand: smaller tables, and the size is in the frame.
        return zstd::bulk::compress(bytes, ZSTD_LEVEL);
    }
    let mut packer = Packer::new(coding)?;
    let mut packed = packer.pack(bytes, false)?;
    packed.append(&mut packer.finish()?);
    Ok(packed)
}
