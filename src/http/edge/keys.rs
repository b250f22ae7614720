//! Bearer keys: who shows one, and how it is compared.

use crate::config::{Key, KeysFile};
use axum::http::{HeaderMap, header};
use std::sync::{Arc, PoisonError, RwLock};
use subtle::{Choice, ConditionallySelectable as _, ConstantTimeEq as _};

/// The keys in force.
#[derive(Debug)]
pub(super) struct Keys {
    file: KeysFile,
    ring: RwLock<Arc<Ring>>,
}

/// What a request that may not go on showed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refused {
    /// Nothing.
    Missing,
    /// Something else than a bearer key, or one that is not in force.
    Wrong,
}

impl Keys {
    pub(super) fn new(file: &KeysFile) -> Self {
        let ring = RwLock::new(Arc::new(Ring::new(file.keys())));
        Self { file: file.clone(), ring }
    }

    /// The name of the key that the headers show.
    pub(super) fn name(&self, headers: &HeaderMap) -> Result<Arc<str>, Refused> {
        let mut shown = headers.get_all(header::AUTHORIZATION).iter();
        let shown = match (shown.next(), shown.next()) {
            (None, _) => return Err(Refused::Missing),
            (Some(shown), None) => shown.as_bytes(),
            (Some(_), Some(_)) => return Err(Refused::Wrong),
        };
        let key = shown.split_at_checked(7).filter(|(scheme, _)| scheme.eq_ignore_ascii_case(b"bearer "));
        let key = key.map(|(_, key)| key.trim_ascii()).ok_or(Refused::Wrong)?;
        let ring = Arc::clone(&self.ring.read().unwrap_or_else(PoisonError::into_inner));
        ring.name(key).ok_or(Refused::Wrong)
    }

    /// Reads the file again and says how many keys are in force now; one that is wrong changes nothing.
    pub(super) fn reload(&self) -> Result<usize, String> {
        let keys = self.file.read_again()?;
        *self.ring.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(Ring::new(&keys));
        Ok(keys.len())
    }
}

/// Keys, made equally long so that a comparison takes as long whatever is compared.
#[derive(Debug)]
struct Ring {
    names: Vec<Arc<str>>,
    secrets: Vec<Vec<u8>>,
    width: usize,
}

impl Ring {
    fn new(keys: &[Key]) -> Self {
        let width = keys.iter().map(|key| key.secret.len()).max().unwrap_or(0);
        Self {
            names: keys.iter().map(|key| Arc::clone(&key.name)).collect(),
            secrets: keys.iter().map(|key| padded(key.secret.as_bytes(), width)).collect(),
            width,
        }
    }

    /// The name of a key. Every key is compared, all of it, whichever fits.
    fn name(&self, shown: &[u8]) -> Option<Arc<str>> {
        let padding = !shown.contains(&0) && shown.len() <= self.width;
        let shown = padded(shown, self.width);
        let mut place = u64::MAX;
        for (index, secret) in self.secrets.iter().enumerate() {
            let same = secret.ct_eq(&shown) & Choice::from(u8::from(padding));
            place.conditional_assign(&(index as u64), same);
        }
        self.names.get(usize::try_from(place).ok()?).cloned()
    }
}

/// The bytes in the first places of so many; keys have no zero in them.
fn padded(key: &[u8], width: usize) -> Vec<u8> {
    let mut wide = vec![0; width];
    let length = key.len().min(width);
    wide[..length].copy_from_slice(&key[..length]);
    wide
}

#[cfg(test)]
mod tests {
    use super::{Refused, Ring};
    use crate::config::Key;

    #[test]
    fn only_a_whole_key_fits() {
        let key = |name: &str, secret: &str| Key { name: name.into(), secret: secret.to_owned() };
        let ring = Ring::new(&[key("short", "0123456789abcdef"), key("long", "0123456789abcdefghij")]);
        let name = |shown: &[u8]| ring.name(shown);
        assert_eq!(name(b"0123456789abcdef").as_deref(), Some("short"));
        assert_eq!(name(b"0123456789abcdefghij").as_deref(), Some("long"));
        for wrong in [
            &b""[..],
            b"0123456789abcde",
            b"0123456789abcdefg",
            b"0123456789abcdef\0\0\0\0",
            b"0123456789abcdefghijk",
            b"0123456789ABCDEF",
        ] {
            assert_eq!(name(wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn the_header_has_to_be_a_bearers() {
        use super::Keys;
        use crate::config::KeysFile;
        use axum::http::{HeaderMap, HeaderValue, header::AUTHORIZATION};
        let path = std::env::temp_dir().join(format!("reflectance-keys-{}", std::process::id()));
        std::fs::write(&path, "name 0123456789abcdef\n").unwrap();
        let keys = Keys::new(&KeysFile::open(path.to_str().unwrap()).unwrap());
        let shown = |values: &[&str]| {
            let mut headers = HeaderMap::new();
            for value in values {
                headers.append(AUTHORIZATION, HeaderValue::from_str(value).unwrap());
            }
            keys.name(&headers).map(|name| name.to_string())
        };
        assert_eq!(shown(&[]), Err(Refused::Missing));
        for right in ["Bearer 0123456789abcdef", "bearer   0123456789abcdef "] {
            assert_eq!(shown(&[right]), Ok("name".to_owned()), "{right}");
        }
        for wrong in ["", "Basic 0123456789abcdef", "Bearer", "Bearer0123456789abcdef", "0123456789abcdef"] {
            assert_eq!(shown(&[wrong]), Err(Refused::Wrong), "{wrong}");
        }
        let right = "Bearer 0123456789abcdef";
        assert_eq!(shown(&[right, right]), Err(Refused::Wrong));
        // A file that is wrong changes nothing; a right one does at once.
        std::fs::write(&path, "name short\n").unwrap();
        assert!(keys.reload().is_err());
        assert_eq!(shown(&[right]), Ok("name".to_owned()));
        std::fs::write(&path, "new fedcba9876543210\n").unwrap();
        assert_eq!(keys.reload(), Ok(1));
        assert_eq!(shown(&[right]), Err(Refused::Wrong));
        assert_eq!(shown(&["Bearer fedcba9876543210"]), Ok("new".to_owned()));
        std::fs::remove_file(&path).unwrap();
    }
}
