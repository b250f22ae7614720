//! A client on a bare socket, so that it can do what a library would not.

use serde_json::Value;
use std::io::{self, Read as _, Write as _};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

/// One scene, as the members of a JSON object.
pub(crate) const SCENE: &str = r#""model":"beckmann_spizzichino","surface":{"rms_height_um":0.2,"correlation_length_um":4},"illumination":{"wavelength_um":0.55}"#;

/// The same scene in a query.
pub(crate) const QUERY: &str =
    "model=beckmann_spizzichino&rms_height_um=0.2&correlation_length_um=4&wavelength_um=0.55";

/// A whole request with a body.
pub(crate) fn post(path: &str, headers: &str, body: &[u8]) -> Vec<u8> {
    let length = body.len();
    let head =
        format!("POST {path} HTTP/1.1\r\nhost: localhost\r\n{headers}content-length: {length}\r\n\r\n");
    [head.as_bytes(), body].concat()
}

/// A whole request with a JSON body.
pub(crate) fn post_json(path: &str, body: &[u8]) -> Vec<u8> {
    post(path, "content-type: application/json\r\n", body)
}

/// A whole request without a body.
pub(crate) fn get(path: &str, headers: &str) -> Vec<u8> {
    format!("GET {path} HTTP/1.1\r\nhost: localhost\r\n{headers}\r\n").into_bytes()
}

/// A request for one direction.
pub(crate) fn small() -> Vec<u8> {
    let body = format!(r#"{{{SCENE},"geometry":{{"theta_i_deg":30,"theta_r_deg":30}}}}"#);
    post_json("/v1/radiance", body.as_bytes())
}

/// The body of a request for many directions.
pub(crate) fn many(count: usize) -> Vec<u8> {
    let angles: Vec<_> = (0..count).map(|index| (index % 80).to_string()).collect();
    let angles = angles.join(",");
    format!(r#"{{{SCENE},"geometry":{{"theta_i_deg":30,"theta_r_deg":[{angles}]}}}}"#).into_bytes()
}

/// What came back.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
    /// Of the body, where it was not kept.
    pub(crate) length: u64,
}

impl Answer {
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.head.lines().find_map(|line| {
            let (found, value) = line.split_once(':')?;
            found.eq_ignore_ascii_case(name).then_some(value.trim())
        })
    }

    /// Whether the server will close the connection.
    pub(crate) fn closes(&self) -> bool {
        self.header("connection").is_some_and(|value| value.eq_ignore_ascii_case("close"))
    }

    /// The detail of a problem document of this status.
    pub(crate) fn problem(&self, status: u16) -> String {
        let text = String::from_utf8_lossy(&self.body);
        assert_eq!(self.status, status, "{text}");
        assert_eq!(self.header("content-type"), Some("application/problem+json"), "{text}");
        let document: Value = serde_json::from_slice(&self.body).expect("JSON");
        assert_eq!(document["status"], status);
        document["detail"].as_str().expect("a detail").to_owned()
    }
}

/// A connection.
pub(crate) struct Connection {
    stream: TcpStream,
    /// Read and not yet used.
    ahead: Vec<u8>,
}

impl Connection {
    pub(crate) fn open(address: &str) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(Duration::from_mins(1)))?;
        stream.set_write_timeout(Some(Duration::from_mins(1)))?;
        Ok(Self { stream, ahead: Vec::new() })
    }

    pub(crate) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    /// Says that nothing more will be sent.
    pub(crate) fn finish(&self) -> io::Result<()> {
        self.stream.shutdown(Shutdown::Write)
    }

    /// How long it waits for bytes.
    pub(crate) fn patience(&self, time: Duration) {
        self.stream.set_read_timeout(Some(time)).expect("a socket");
    }

    /// Reads on; 0 where the server has closed.
    pub(crate) fn more(&mut self) -> io::Result<usize> {
        let mut bytes = vec![0; 64 << 10];
        let length = self.stream.read(&mut bytes)?;
        self.ahead.extend_from_slice(&bytes[..length]);
        Ok(length)
    }

    /// Takes what comes within a few milliseconds, and forgets it.
    pub(crate) fn discard(&mut self) {
        self.patience(Duration::from_millis(3));
        // Nothing may have come.
        let _ = self.more();
        self.ahead.clear();
    }

    /// Whether the server has closed, by the time that its patience ends.
    pub(crate) fn is_closed(&mut self) -> bool {
        loop {
            match self.more() {
                Ok(0) => return true,
                Ok(_) => self.ahead.clear(),
                Err(error) => {
                    return !matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut);
                }
            }
        }
    }

    fn need(&mut self) -> io::Result<()> {
        if self.more()? == 0 { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(()) }
    }

    /// Up to and with the end of a line, or of a head.
    fn through(&mut self, end: &[u8]) -> io::Result<Vec<u8>> {
        let mut looked = 0;
        loop {
            if let Some(at) = self.ahead[looked..].windows(end.len()).position(|part| part == end) {
                let rest = self.ahead.split_off(looked + at + end.len());
                return Ok(std::mem::replace(&mut self.ahead, rest));
            }
            looked = self.ahead.len().saturating_sub(end.len() - 1);
            self.need()?;
        }
    }

    /// So many bytes, kept only if asked for.
    fn exactly(&mut self, mut length: u64, mut keep: Option<&mut Vec<u8>>) -> io::Result<()> {
        while length > 0 {
            if self.ahead.is_empty() {
                self.need()?;
            }
            let take = self.ahead.len().min(usize::try_from(length).unwrap_or(usize::MAX));
            let bytes = self.ahead.drain(..take);
            match &mut keep {
                Some(kept) => kept.extend(bytes),
                None => drop(bytes),
            }
            length -= take as u64;
        }
        Ok(())
    }

    /// Reads an answer to its end.
    pub(crate) fn answer(&mut self) -> io::Result<Answer> {
        self.read(true)
    }

    /// The same, without keeping the body.
    pub(crate) fn answer_dropped(&mut self) -> io::Result<Answer> {
        self.read(false)
    }

    fn read(&mut self, keep: bool) -> io::Result<Answer> {
        let mut head;
        loop {
            head = String::from_utf8_lossy(&self.through(b"\r\n\r\n")?).into_owned();
            if !head.starts_with("HTTP/1.1 100") {
                break;
            }
        }
        let status = head.get(9..12).and_then(|code| code.parse().ok());
        let status = status.ok_or(io::ErrorKind::InvalidData)?;
        let mut answer = Answer { status, head, body: Vec::new(), length: 0 };
        let mut body = Vec::new();
        if answer.header("transfer-encoding").is_some() {
            loop {
                let line = String::from_utf8_lossy(&self.through(b"\r\n")?).into_owned();
                let size = u64::from_str_radix(line.trim(), 16).map_err(|_| io::ErrorKind::InvalidData)?;
                self.exactly(size, keep.then_some(&mut body))?;
                self.through(b"\r\n")?;
                answer.length += size;
                if size == 0 {
                    break;
                }
            }
        } else if let Some(length) = answer.header("content-length") {
            let length = length.parse().map_err(|_| io::ErrorKind::InvalidData)?;
            self.exactly(length, keep.then_some(&mut body))?;
            answer.length = length;
        }
        answer.body = body;
        Ok(answer)
    }
}
