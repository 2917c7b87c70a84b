//! Spoils a valid file as files are spoiled: in bytes, in lines and in numbers.

use crate::contact::random::Random;

/// Numbers at which readers break.
const NUMBERS: [&str; 34] = [
    "nan",
    "NaN",
    "inf",
    "-inf",
    "+inf",
    "infinity",
    "1e308",
    "-1e308",
    "1.8e308",
    "1e309",
    "1e-320",
    "-0",
    "-0.0",
    "0",
    "1",
    "-1",
    "-2",
    "2",
    "0.5",
    "1e9",
    "1e300",
    "1e-300",
    "255",
    "2147483648",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "1000000000000",
    "0x10",
    "1_000",
    "1e",
    "",
];

/// Pieces that mean something in one of the formats.
const PIECES: [&str; 26] = [
    ",", ",,", "\n", "\n\n", "\r", "\r\n", "\0", "\u{feff}", "#", "%", "%%", "=", "[", "]", "[[",
    "{", "}", "\"", "\"\"\"", "'", ".", " ", "\t", "-", "é", "\u{2028}",
];

/// A stream of spoiled versions of files.
pub struct Mutator(pub Random);

impl Mutator {
    pub fn new(case: u64) -> Self {
        Self(Random(case.wrapping_mul(0x2545_F491_4F6C_DD1D)))
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.integer(0, count.max(1) - 1)
    }

    pub fn one_of<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.below(choices.len())]
    }

    /// One to four changes.
    pub fn spoil(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..self.0.integer(1, 4) {
            bytes = self.change(bytes);
        }
        bytes
    }

    fn change(&mut self, bytes: Vec<u8>) -> Vec<u8> {
        match self.below(10) {
            0 => self.in_bytes(bytes),
            1 | 2 => self.in_lines(&bytes),
            3 => self.piece(bytes),
            4 => self.whole(&bytes),
            _ => self.number(&bytes),
        }
    }

    /// One byte more, less or other, or the file cut off.
    fn in_bytes(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        let at = self.below(bytes.len());
        let byte = self.below(256) as u8;
        match self.below(4) {
            0 => bytes.insert(at.min(bytes.len()), byte),
            1 if !bytes.is_empty() => bytes[at] = byte,
            2 if !bytes.is_empty() => drop(bytes.remove(at)),
            _ => bytes.truncate(at),
        }
        bytes
    }

    /// A line dropped, doubled, moved or emptied.
    fn in_lines(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut lines: Vec<&[u8]> = bytes.split(|&byte| byte == b'\n').collect();
        let (at, other) = (self.below(lines.len()), self.below(lines.len()));
        match self.below(4) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(other, lines[at]),
            2 => lines.swap(at, other),
            _ => lines[at] = b"",
        }
        lines.join(&b'\n')
    }

    fn piece(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        let at = self.below(bytes.len() + 1);
        let piece = *self.one_of(&PIECES);
        let times = if self.below(20) == 0 { 2000 } else { 1 };
        bytes.splice(at..at, piece.repeat(times).into_bytes());
        bytes
    }

    /// Line ends of another system, a byte order mark, or the file twice.
    fn whole(&mut self, bytes: &[u8]) -> Vec<u8> {
        match self.below(3) {
            0 => {
                let lines: Vec<&[u8]> = bytes.split(|&byte| byte == b'\n').collect();
                lines.join(&b"\r\n"[..])
            }
            1 => ["\u{feff}".as_bytes(), bytes].concat(),
            _ => [bytes, bytes].concat(),
        }
    }

    /// Another number in place of one.
    fn number(&mut self, bytes: &[u8]) -> Vec<u8> {
        let of_number = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
        let starts: Vec<usize> = (0..bytes.len())
            .filter(|&i| bytes[i].is_ascii_digit() && (i == 0 || !of_number(bytes[i - 1])))
            .collect();
        if starts.is_empty() {
            return bytes.to_vec();
        }
        let start = *self.one_of(&starts);
        let length = bytes[start..]
            .iter()
            .position(|&byte| !of_number(byte))
            .unwrap_or(bytes.len() - start);
        let other = if self.below(4) == 0 {
            self.0.integer(0, 300).to_string()
        } else {
            (*self.one_of(&NUMBERS)).to_owned()
        };
        [&bytes[..start], other.as_bytes(), &bytes[start + length..]].concat()
    }
}
