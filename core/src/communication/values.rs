//! Values on their way from rank 0 to another one.

use serde::Serialize;
use serde::de::DeserializeOwned;
use zelus_linear_algebra::packed;

use super::Ranks;
use crate::diagnostics::{Error, Result};

impl Ranks {
    /// Sends a value that rank 0 has to `rank`, which gets it, as do no others; collective.
    ///
    /// # Errors
    /// A value that cannot be written or read, on the rank where that is so.
    pub fn send_from_root<T: Serialize + DeserializeOwned>(&self, value: Option<T>, rank: usize) -> Result<Option<T>> {
        let packed = value.map(|value| pack(&value)).transpose();
        let mut sent = vec![Vec::new(); self.size()];
        if let Ok(Some(words)) = &packed {
            sent[rank].clone_from(words);
        }
        let arrived = self.exchange_indices(&sent).swap_remove(0);
        packed?;
        if self.rank() == rank && !arrived.is_empty() { unpack(&arrived).map(Some) } else { Ok(None) }
    }
}

/// Number of bytes in two words, then the bytes.
fn pack(value: &impl Serialize) -> Result<Vec<u32>> {
    let mut bytes = packed::to_bytes(value).map_err(|error| failed(&error))?;
    let length = bytes.len() as u64;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let mut words = vec![length as u32, (length >> 32) as u32];
    words.extend(bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)));
    Ok(words)
}

fn unpack<T: DeserializeOwned>(words: &[u32]) -> Result<T> {
    let length = u64::from(words[0]) | u64::from(words[1]) << 32;
    let mut bytes: Vec<u8> = words[2..].iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.truncate(length as usize);
    packed::from_bytes(&bytes).map_err(|error| failed(&error))
}

fn failed(error: &dyn std::error::Error) -> Error {
    Error::System(format!("a message of rank 0 to another rank is lost: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_bits_whatever_their_length() {
        for count in 0..9 {
            let value: (Vec<f64>, String) = (vec![0.1 + 0.2; count], "x".repeat(count));
            assert_eq!(unpack::<(Vec<f64>, String)>(&pack(&value).unwrap()).unwrap(), value);
        }
        assert!(unpack::<String>(&pack(&1.5).unwrap()).is_err());
    }
}
