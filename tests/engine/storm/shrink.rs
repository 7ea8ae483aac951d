//! Makes a failing case smaller before it is printed.

use super::case::RECORD;

/// Removes records in shorter and shorter runs, then lowers single bytes, as long as the case still fails.
pub(crate) fn shrink(mut bytes: Vec<u8>, fails: impl Fn(&[u8]) -> bool) -> Vec<u8> {
    let records = |bytes: &[u8]| bytes.len().saturating_sub(RECORD).div_ceil(RECORD);
    let mut run = records(&bytes).max(1);
    while run > 0 {
        let mut at = 0;
        while at < records(&bytes) {
            let mut shorter = bytes.clone();
            let start = RECORD * (at + 1);
            shorter.drain(start..(start + RECORD * run).min(bytes.len()));
            if fails(&shorter) {
                bytes = shorter;
            } else {
                at += run;
            }
        }
        run /= 2;
    }
    for at in 0..bytes.len() {
        let old = bytes[at];
        for lower in [0, old / 2, old.saturating_sub(1)] {
            bytes[at] = lower;
            if lower < old && fails(&bytes) {
                break;
            }
            bytes[at] = old;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_matter_is_taken_out() {
        let bytes: Vec<u8> = (1..=100).collect();
        let fails = |bytes: &[u8]| bytes.contains(&57) && bytes.len() >= RECORD;
        assert_eq!(shrink(bytes, fails), [0, 0, 0, 0, 0, 0, 57, 0, 0, 0]);
    }
}
