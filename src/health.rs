//! `reflectance health`: whether a running service takes requests, as its own `/readyz` says.

use crate::config::{Config, Probe};
use axum::http::header::HOST;
use axum::http::uri::Authority;
use axum::http::{Request, StatusCode, Uri};
use http_body_util::Empty;
use hyper::body::Bytes;
use hyper::client::conn::http1;
use hyper_util::rt::TokioIo;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Arc;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::TcpStream;
use tokio_rustls::TlsConnector;
use tokio_rustls::rustls::client::danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier};
use tokio_rustls::rustls::crypto::{CryptoProvider, WebPkiSupportedAlgorithms, ring};
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName, UnixTime};
use tokio_rustls::rustls::{ClientConfig, DigitallySignedStruct, Error, SignatureScheme};

/// Asks the service that runs by this configuration, or the one that the probe names. An error is one line.
pub fn check(config: &Config, probe: &Probe) -> Result<(), String> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let target = match &probe.url {
        Some(url) => Target::named(url),
        None => Target::own(config),
    }?;
    let within = probe.timeout_seconds;
    let asked = runtime.block_on(async { tokio::time::timeout(within, target.ask()).await });
    // A name that is still being looked up is not waited for.
    runtime.shutdown_background();
    let status = asked.unwrap_or_else(|_| Err(format!("no answer within {} s", within.as_secs_f64())));
    match status.map_err(|reason| format!("{target}: {reason}"))? {
        StatusCode::OK => Ok(()),
        other => Err(format!("{target}: not ready, status {}", other.as_u16())),
    }
}

/// Where to ask.
#[derive(Debug, PartialEq, Eq)]
struct Target {
    secure: bool,
    address: String,
    /// Host alone, for the handshake.
    host: String,
    path: String,
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let scheme = if self.secure { "https" } else { "http" };
        write!(f, "{scheme}://{}{}", self.address, self.path)
    }
}

impl Target {
    /// The address that a service of this configuration listens on, as it is reached from beside it.
    fn own(config: &Config) -> Result<Self, String> {
        let listen = &config.listen;
        let address = match listen.parse::<SocketAddr>() {
            Ok(mut address) => {
                match address.ip() {
                    IpAddr::V4(Ipv4Addr::UNSPECIFIED) => address.set_ip(Ipv4Addr::LOCALHOST.into()),
                    IpAddr::V6(Ipv6Addr::UNSPECIFIED) => address.set_ip(Ipv6Addr::LOCALHOST.into()),
                    _ => {}
                }
                address.to_string()
            }
            Err(_) => listen.clone(),
        };
        let authority = address.parse::<Authority>().ok();
        match authority.filter(|authority| authority.port_u16().is_some_and(|port| port != 0)) {
            Some(authority) => Ok(Self::at(config.access.tls_cert.is_some(), &authority, "")),
            None => {
                Err(format!("--listen {listen} does not say which port the service has: name it by --url"))
            }
        }
    }

    /// A service by its base URL, whose form the command line has checked.
    fn named(url: &Uri) -> Result<Self, String> {
        let authority = url.authority().ok_or_else(|| format!("{url} names no host"))?;
        let secure = url.scheme_str() == Some("https");
        Ok(Self::at(secure, authority, url.path().trim_end_matches('/')))
    }

    fn at(secure: bool, authority: &Authority, prefix: &str) -> Self {
        let port = authority.port_u16().unwrap_or(if secure { 443 } else { 80 });
        let host = authority.host();
        Self {
            secure,
            address: format!("{host}:{port}"),
            host: host.trim_matches(['[', ']']).to_owned(),
            path: format!("{prefix}/readyz"),
        }
    }

    async fn ask(&self) -> Result<StatusCode, String> {
        let stream = TcpStream::connect(&self.address).await.map_err(|error| error.to_string())?;
        if !self.secure {
            return self.ask_over(stream).await;
        }
        let name = ServerName::try_from(self.host.clone()).map_err(|error| error.to_string())?;
        let stream = handshake()?.connect(name, stream).await.map_err(|error| error.to_string())?;
        self.ask_over(stream).await
    }

    async fn ask_over<S>(&self, stream: S) -> Result<StatusCode, String>
    where
        S: AsyncRead + AsyncWrite + Unpin + Send + 'static,
    {
        let request = Request::get(&self.path).header(HOST, &self.address).body(Empty::<Bytes>::new());
        let request = request.map_err(|error| error.to_string())?;
        let (mut sender, connection) =
            http1::handshake(TokioIo::new(stream)).await.map_err(|error| error.to_string())?;
        // What ends the connection early is told by the request.
        let connection = tokio::spawn(connection);
        let answer = sender.send_request(request).await.map_err(|error| error.to_string());
        connection.abort();
        Ok(answer?.status())
    }
}

/// TLS that takes any certificate: the question is whether the service answers, and no secret goes with it. Its name is not
/// that of loopback, and whoever made it may be known to clients alone.
fn handshake() -> Result<TlsConnector, String> {
    let provider = ring::default_provider();
    let verifier = AnyCertificate(provider.signature_verification_algorithms);
    let config = ClientConfig::builder_with_provider(Arc::<CryptoProvider>::new(provider))
        .with_safe_default_protocol_versions()
        .map_err(|error| format!("cannot set up TLS: {error}"))?
        .dangerous()
        .with_custom_certificate_verifier(Arc::new(verifier))
        .with_no_client_auth();
    Ok(TlsConnector::from(Arc::new(config)))
}

/// Checks that the server holds the key of its certificate, and no more.
#[derive(Debug)]
struct AnyCertificate(WebPkiSupportedAlgorithms);

impl ServerCertVerifier for AnyCertificate {
    fn verify_server_cert(
        &self,
        _: &CertificateDer<'_>,
        _: &[CertificateDer<'_>],
        _: &ServerName<'_>,
        _: &[u8],
        _: UnixTime,
    ) -> Result<ServerCertVerified, Error> {
        Ok(ServerCertVerified::assertion())
    }

    fn verify_tls12_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        tokio_rustls::rustls::crypto::verify_tls12_signature(message, certificate, signature, &self.0)
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        certificate: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        tokio_rustls::rustls::crypto::verify_tls13_signature(message, certificate, signature, &self.0)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.0.supported_schemes()
    }
}

#[cfg(test)]
mod tests {
    use super::Target;
    use crate::config::{Cli, Command};
    use clap::Parser as _;

    fn target(arguments: &[&str]) -> Result<String, String> {
        let arguments = ["reflectance"].iter().chain(arguments);
        let cli = Cli::try_parse_from(arguments).map_err(|error| error.to_string())?;
        let Some(Command::Health(probe)) = cli.command else { return Err("another command".to_owned()) };
        let target = match &probe.url {
            Some(url) => Target::named(url),
            None => Target::own(&cli.config),
        };
        target.map(|target| target.to_string())
    }

    #[test]
    fn a_service_is_asked_where_it_listens() {
        for (listen, asked) in [
            ("0.0.0.0:8080", "http://127.0.0.1:8080/readyz"),
            ("[::]:9", "http://[::1]:9/readyz"),
            ("192.0.2.1:80", "http://192.0.2.1:80/readyz"),
            ("localhost:8080", "http://localhost:8080/readyz"),
        ] {
            assert_eq!(target(&["--listen", listen, "health"]).as_deref(), Ok(asked));
        }
        let secure = ["--listen", "0.0.0.0:1", "--tls-cert", "a", "--tls-key", "b", "health"];
        assert_eq!(target(&secure).as_deref(), Ok("https://127.0.0.1:1/readyz"));
        assert!(target(&["--listen", "127.0.0.1:0", "health"]).unwrap_err().contains("--url"));
    }

    #[test]
    fn another_is_asked_by_its_url() {
        for (url, asked) in [
            ("http://host:81", "http://host:81/readyz"),
            ("https://[::1]/under/", "https://[::1]:443/under/readyz"),
        ] {
            assert_eq!(target(&["health", "--url", url]).as_deref(), Ok(asked));
        }
        for wrong in ["host:81", "ftp://host", "http://", "http://host/?a=b", "http://a@host"] {
            assert!(target(&["health", "--url", wrong]).unwrap_err().contains("expected http"), "{wrong}");
        }
    }
}
