//! The other end of a connection.

use std::net::{IpAddr, SocketAddr};

/// The other end of a connection: its address, and the same as text, made once for all requests.
#[derive(Debug)]
pub(super) struct Peer {
    address: Option<IpAddr>,
    text: String,
}

impl Peer {
    pub(super) fn new(address: SocketAddr) -> Self {
        // An IPv4 client of a socket that listens to both families is the same client.
        let address = address.ip().to_canonical();
        Self { address: Some(address), text: address.to_string() }
    }

    /// Where there is no connection: the router called from within the process.
    pub(super) fn none() -> Self {
        Self { address: None, text: "-".to_owned() }
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// What counts as one client: an address, or of IPv6 the 64 bits that name a network, because whoever has one
    /// address of it has all.
    pub(super) fn client(&self) -> Option<u64> {
        match self.address? {
            IpAddr::V4(address) => Some(u64::from(address.to_bits())),
            IpAddr::V6(address) => Some(u64::try_from(address.to_bits() >> 64).unwrap_or(u64::MAX)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Peer;

    fn peer(address: &str) -> Peer {
        Peer::new(address.parse().unwrap())
    }

    #[test]
    fn a_network_of_ipv6_is_one_client() {
        let client = |address| peer(address).client().unwrap();
        assert_eq!(client("[2001:db8::1]:1"), client("[2001:db8::ffff]:2"));
        assert_ne!(client("[2001:db8::1]:1"), client("[2001:db8:0:1::1]:1"));
        assert_ne!(client("10.0.0.1:1"), client("10.0.0.2:1"));
        assert_eq!(client("10.0.0.1:1"), client("[::ffff:10.0.0.1]:2"));
        assert_eq!(peer("[::ffff:10.0.0.1]:2").text(), "10.0.0.1");
        assert_eq!(Peer::none().client(), None);
    }
}
