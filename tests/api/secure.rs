//! HTTPS: which protocol is spoken, and which certificate is shown.

use crate::server::Server;
use crate::wire::{connect, get};
use rcgen::{CertifiedKey, generate_simple_self_signed};
use std::fs;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName};
use tokio_rustls::rustls::version::{TLS12, TLS13};
use tokio_rustls::rustls::{
    ClientConfig, ClientConnection, RootCertStore, StreamOwned, SupportedProtocolVersion,
};

type Secure = StreamOwned<ClientConnection, TcpStream>;

/// A folder with a certificate and its key, gone with the test.
struct Files {
    folder: PathBuf,
    shown: CertificateDer<'static>,
}

impl Files {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("reflectance-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let mut files = Self { folder, shown: Vec::new().into() };
        files.renew();
        files
    }

    /// Another certificate in the same place.
    fn renew(&mut self) {
        let CertifiedKey { cert, signing_key } = generate_simple_self_signed(["localhost".into()]).unwrap();
        fs::write(self.path("cert.pem"), cert.pem()).unwrap();
        fs::write(self.path("key.pem"), signing_key.serialize_pem()).unwrap();
        self.shown = cert.der().clone();
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).to_str().unwrap().to_owned()
    }

    fn serve(&self, more: &[&str]) -> Server {
        let (cert, key) = (self.path("cert.pem"), self.path("key.pem"));
        let flags = [&["--tls-cert", &cert, "--tls-key", &key], more].concat();
        Server::with(&flags)
    }

    /// A client that trusts the certificate of now.
    fn client(&self, protocol: &[u8], version: &'static SupportedProtocolVersion) -> Arc<ClientConfig> {
        let mut roots = RootCertStore::empty();
        roots.add(self.shown.clone()).unwrap();
        let mut config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
            .with_protocol_versions(&[version])
            .unwrap()
            .with_root_certificates(roots)
            .with_no_client_auth();
        config.alpn_protocols = vec![protocol.to_vec()];
        Arc::new(config)
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        // What stays is small and in the folder for such things.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

fn secure(server: &Server, client: Arc<ClientConfig>) -> std::io::Result<Secure> {
    let name = ServerName::try_from("localhost").unwrap();
    let mut stream =
        StreamOwned::new(ClientConnection::new(client, name).unwrap(), connect(server.address()));
    while stream.conn.is_handshaking() {
        stream.conn.complete_io(&mut stream.sock)?;
    }
    Ok(stream)
}

/// A request and all that comes back.
fn ask(stream: &mut Secure) -> String {
    stream.write_all(b"GET /livez HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n").unwrap();
    let mut answer = String::new();
    // An end without a close_notify would be an error here.
    stream.read_to_string(&mut answer).unwrap();
    answer
}

#[test]
fn both_protocols_and_both_versions_are_spoken() {
    let files = Files::new("both");
    let server = files.serve(&[]);
    assert!(server.greeting[0].contains("https://"), "{:?}", server.greeting);
    for version in [&TLS12, &TLS13] {
        let mut stream = secure(&server, files.client(b"http/1.1", version)).unwrap();
        assert_eq!(stream.conn.alpn_protocol(), Some(&b"http/1.1"[..]));
        assert!(ask(&mut stream).starts_with("HTTP/1.1 200"));
        let mut stream = secure(&server, files.client(b"h2", version)).unwrap();
        assert_eq!(stream.conn.alpn_protocol(), Some(&b"h2"[..]));
        stream.write_all(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0").unwrap();
        let mut settings = [0; 9];
        stream.read_exact(&mut settings).unwrap();
        assert_eq!(settings[3], 4, "a SETTINGS frame");
    }
}

#[test]
fn who_speaks_http_to_it_is_told_so() {
    let files = Files::new("plain");
    let server = files.serve(&[]);
    let answer = get(&mut connect(server.address()), "/livez").unwrap();
    assert_eq!((answer.status, answer.is_last()), (400, true));
    assert!(String::from_utf8(answer.body).unwrap().contains("https"));
}

#[test]
fn a_handshake_that_does_not_go_on_ends() {
    let files = Files::new("silent");
    let server = files.serve(&["--idle-timeout-seconds", "0.3"]);
    let mut stream = connect(server.address());
    // The beginning of a handshake record.
    stream.write_all(b"\x16\x03\x01\x02\x00\x01").unwrap();
    assert!(crate::wire::ends(&mut stream));
}

#[test]
fn a_new_certificate_is_shown_after_sighup_and_a_broken_one_is_not() {
    let mut files = Files::new("renew");
    let mut server = files.serve(&["--log-level", "error"]);
    let old = files.client(b"http/1.1", &TLS13);
    assert!(secure(&server, Arc::clone(&old)).is_ok());
    files.renew();
    let new = files.client(b"http/1.1", &TLS13);
    assert!(secure(&server, Arc::clone(&new)).is_err(), "it was not told yet");
    server.signal("HUP");
    // It takes a moment.
    while secure(&server, Arc::clone(&new)).is_err() {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(secure(&server, old).is_err(), "the old one is still shown");
    fs::write(files.path("cert.pem"), "no certificate").unwrap();
    server.signal("HUP");
    std::thread::sleep(Duration::from_millis(300));
    let mut stream = secure(&server, new).unwrap();
    assert!(ask(&mut stream).starts_with("HTTP/1.1 200"));
    server.signal("INT");
    let (code, log) = server.end();
    assert_eq!(code, Some(0));
    assert_eq!(log.lines().count(), 1, "{log}");
    assert!(log.contains("cert.pem"), "{log}");
}

#[test]
fn files_that_cannot_be_used_end_the_start_with_one_line() {
    let (files, other) = (Files::new("bad"), Files::new("other"));
    fs::write(files.path("text.pem"), "hello").unwrap();
    let (cert, key) = (files.path("cert.pem"), files.path("key.pem"));
    for (cert, key, word) in [
        (files.path("nothing.pem"), key.clone(), "nothing.pem"),
        (cert.clone(), files.path("nothing.pem"), "nothing.pem"),
        (files.path("text.pem"), key, "text.pem"),
        (cert.clone(), files.path("text.pem"), "text.pem"),
        (cert, other.path("key.pem"), "key.pem"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_reflectance"))
            .args(["--listen", "127.0.0.1:0", "--tls-cert", &cert, "--tls-key", &key])
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(text.starts_with("reflectance: ") && text.contains(word), "{text}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_secure_connection_that_was_put_to_sleep_wakes_up() {
    let files = Files::new("sleep");
    let server = files.serve(&["--idle-timeout-seconds", "7"]);
    let mut stream = secure(&server, files.client(b"http/1.1", &TLS13)).unwrap();
    for _ in 0..2 {
        stream.write_all(b"GET /livez HTTP/1.1\r\nhost: x\r\n\r\n").unwrap();
        let mut answer = Vec::new();
        while !answer.ends_with(b"\"}") {
            let mut byte = [0];
            stream.read_exact(&mut byte).unwrap();
            answer.push(byte[0]);
        }
        assert!(answer.starts_with(b"HTTP/1.1 200"));
        // Longer than its buffers are kept.
        std::thread::sleep(Duration::from_secs(6));
    }
    // The end comes in good order.
    let mut rest = Vec::new();
    let end = stream.read_to_end(&mut rest);
    assert!(!matches!(&end, Err(error) if error.kind() == ErrorKind::WouldBlock), "{end:?}");
    assert!(end.is_ok(), "{end:?}");
}

#[test]
fn health_is_asked_over_tls_whatever_the_certificate() {
    let files = Files::new("health");
    let server = files.serve(&[]);
    let (cert, key) = (files.path("cert.pem"), files.path("key.pem"));
    let health = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_reflectance")).args(arguments).output().unwrap().status.code()
    };
    let own = ["--listen", server.address(), "--tls-cert", &cert, "--tls-key", &key, "health"];
    assert_eq!(health(&own), Some(0));
    assert_eq!(health(&["health", "--url", &server.url]), Some(0));
    // Plain HTTP to the same port is answered with 400.
    assert_eq!(health(&["health", "--url", &server.url.replace("https", "http")]), Some(1));
}
