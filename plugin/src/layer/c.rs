//! Texts of C, read and written.

use std::ffi::{CStr, CString, c_char};

/// The text at a pointer. None if it is null or not UTF-8.
///
/// # Safety
/// A pointer that is not null is to a string that ends with a null and lives as long as the result.
pub(super) unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a str> {
    // SAFETY: as the caller promises.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }).and_then(|text| text.to_str().ok())
}

/// A text for C. Nulls, which would end it, are left out.
pub(super) fn string(text: &str) -> CString {
    let bytes: Vec<u8> = text.bytes().filter(|byte| *byte != 0).collect();
    CString::new(bytes).unwrap_or_default()
}

/// Writes a text into an array of C, with the null that ends it. What does not fit is cut off after a whole character.
pub(super) fn fill(array: &mut [c_char], text: &str) {
    let room = array.len().saturating_sub(1);
    let bytes = &text.as_bytes()[..text.floor_char_boundary(room)];
    array.fill(0);
    for (place, byte) in array.iter_mut().zip(bytes) {
        *place = *byte as c_char;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_cut_at_characters_and_come_back() {
        let mut array = [1; 6];
        for (given, expected) in
            [("Kick", "Kick"), ("Snare drum", "Snare"), ("Glöck", "Glöc"), ("Gong♪", "Gong"), ("", "")]
        {
            fill(&mut array, given);
            // SAFETY: the array ends with a null.
            assert_eq!(unsafe { text(array.as_ptr()) }, Some(expected));
        }
        fill(&mut [], "none");
        // SAFETY: null, and a string that ends with a null.
        assert_eq!(unsafe { (text(std::ptr::null()), text(c"\xff".as_ptr())) }, (None, None));
        assert_eq!(string("a\0b").as_c_str(), c"ab");
    }
}
