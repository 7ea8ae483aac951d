//! The first bytes of a file, which tell its format, and a tag that may stand before them.

use std::fs::File;
use std::io::Read;

/// Number of bytes at the start of a file that identify its format.
const MAGIC_LEN: usize = 36;
/// Length in bytes of the header of an ID3v2 tag.
const TAG_LEN: u64 = 10;

/// The next bytes of a file, at most [`MAGIC_LEN`].
pub(super) fn start(file: &mut File) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(MAGIC_LEN);
    file.take(MAGIC_LEN as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The length in bytes of the ID3v2 tag that a file starts with. Its size has 7 bits a byte, and leaves out header and footer
/// (ID3v2.4, §3.1).
pub(super) fn tag_len(magic: &[u8]) -> Option<u64> {
    let tag = magic.strip_prefix(b"ID3")?;
    let (flags, size) = (tag.get(2)?, tag.get(3..7)?);
    let size = size.iter().fold(0, |size, byte| size << 7 | u64::from(byte & 0x7f));
    Some(size + TAG_LEN * if flags & 0x10 != 0 { 2 } else { 1 })
}
