//! The file of bearer keys: one a line as `name key`.

use std::fmt;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Shortest and longest key, in characters.
const KEY_LENGTHS: std::ops::RangeInclusive<usize> = 16..=256;
/// Longest name.
const LONGEST_NAME: usize = 64;
/// Largest file that is read, in bytes: several thousand keys.
const LARGEST_FILE: u64 = 1 << 20;

/// A file of keys that was read and found right, and where to read it again.
#[derive(Clone, Debug)]
pub struct KeysFile {
    path: PathBuf,
    keys: Vec<Key>,
}

/// A client and the secret by which it is known.
#[derive(Clone, PartialEq, Eq)]
pub struct Key {
    /// What logs call the client.
    pub name: Arc<str>,
    /// What the client shows.
    pub secret: String,
}

/// Without the secret, wherever it ends up.
impl fmt::Debug for Key {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "Key({})", self.name)
    }
}

impl KeysFile {
    /// Reads a file.
    pub fn open(path: &str) -> Result<Self, String> {
        let path = PathBuf::from(path);
        let keys = read(&path)?;
        Ok(Self { path, keys })
    }

    /// Reads it again.
    pub fn read_again(&self) -> Result<Vec<Key>, String> {
        read(&self.path)
    }

    /// What was in it.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }
}

fn read(path: &Path) -> Result<Vec<Key>, String> {
    let mut text = String::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LARGEST_FILE + 1).read_to_string(&mut text))
        .map_err(|error| format!("cannot read it: {error}"))?;
    if text.len() as u64 > LARGEST_FILE {
        return Err(format!("it is larger than {LARGEST_FILE} bytes"));
    }
    parse(&text)
}

/// The keys of a file's text. No message repeats a key.
fn parse(text: &str) -> Result<Vec<Key>, String> {
    let mut keys: Vec<Key> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let key = key(line).map_err(|reason| format!("line {}: {reason}", index + 1))?;
        if keys.iter().any(|other| other.name == key.name || other.secret == key.secret) {
            return Err(format!("line {}: its name or its key stands in an earlier line", index + 1));
        }
        keys.push(key);
    }
    if keys.is_empty() {
        return Err("there is no key in it: expected lines of a name and a key".to_owned());
    }
    Ok(keys)
}

fn key(line: &str) -> Result<Key, String> {
    let mut words = line.split_whitespace();
    let (Some(name), Some(secret), None) = (words.next(), words.next(), words.next()) else {
        return Err("expected a name, a space and a key".to_owned());
    };
    let in_name = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.@".contains(&byte);
    if name.len() > LONGEST_NAME || !name.bytes().all(in_name) {
        return Err(format!("expected a name of at most {LONGEST_NAME} of A-Z a-z 0-9 - _ . @"));
    }
    // What a bearer token may consist of, RFC 6750.
    let in_key = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~+/=".contains(&byte);
    if !KEY_LENGTHS.contains(&secret.len()) || !secret.bytes().all(in_key) {
        let (least, most) = (KEY_LENGTHS.start(), KEY_LENGTHS.end());
        return Err(format!("expected a key of {least} to {most} of A-Z a-z 0-9 - . _ ~ + / ="));
    }
    Ok(Key { name: name.into(), secret: secret.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::{KeysFile, parse};

    const ONE: &str = "0123456789abcdef";
    const TWO: &str = "0123456789abcdeg";

    #[test]
    fn comments_and_spaces_do_not_matter() {
        let keys = parse(&format!("# who\n\n  a.b@c-1_  \t {ONE}  \r\nother {TWO}")).unwrap();
        let read: Vec<_> = keys.iter().map(|key| (&*key.name, key.secret.as_str())).collect();
        assert_eq!(read, [("a.b@c-1_", ONE), ("other", TWO)]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_and_without_the_key() {
        for (text, words) in [
            (String::new(), "no key in it"),
            ("# nothing\n".to_owned(), "no key in it"),
            (format!("a {ONE}\nalone"), "line 2: expected a name"),
            (format!("a {ONE} more"), "line 1: expected a name"),
            (format!("a {}", &ONE[1..]), "16 to 256"),
            (format!("a {}", "x".repeat(257)), "16 to 256"),
            (format!("a {ONE}é"), "16 to 256"),
            (format!("a\"b {ONE}"), "expected a name of at most 64"),
            (format!("{} {ONE}", "n".repeat(65)), "expected a name of at most 64"),
            (format!("a {ONE}\na {TWO}"), "line 2: its name or its key"),
            (format!("a {ONE}\nb {ONE}"), "line 2: its name or its key"),
        ] {
            let reason = parse(&text).unwrap_err();
            assert!(reason.contains(words) && !reason.contains(&ONE[1..]), "{text}: {reason}");
        }
        assert!(KeysFile::open("/nowhere/keys").unwrap_err().contains("cannot read it"));
    }

    #[test]
    fn a_key_is_not_printed() {
        let keys = parse(&format!("name {ONE}")).unwrap();
        assert_eq!(format!("{keys:?}"), "[Key(name)]");
    }
}
