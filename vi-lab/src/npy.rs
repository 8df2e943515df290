//! The header of an NPY file, the array format of `NumPy`: float64, row by row. Source: version 1.0 of the format.

/// Bytes before the numbers: magic, version, length of the header, header; a multiple of 64.
pub(crate) const HEADER_BYTES: usize = 128;

/// Magic, version 1.0, length of the description, description padded with blanks to the fixed size.
pub(crate) fn head(rows: u64, columns: usize) -> Vec<u8> {
    let description = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Ten bytes precede the description and a line end follows it: its length is 118, which fits two bytes.
    let mut head = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    head.extend(description.as_bytes());
    head.resize(HEADER_BYTES - 1, b' ');
    head.push(b'\n');
    head
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_has_a_fixed_size_for_any_number_of_rows() {
        for rows in [0, 1000, u64::MAX] {
            let head = head(rows, 1024);
            assert_eq!(head.len(), HEADER_BYTES);
            assert_eq!(usize::from(head[8]) + 256 * usize::from(head[9]) + 10, HEADER_BYTES);
            assert_eq!(head.last(), Some(&b'\n'));
            let text = String::from_utf8_lossy(&head[10..]);
            assert!(text.contains(&format!("'shape': ({rows}, 1024), }}")), "{text}");
        }
    }
}
