//! Requests a second for one direction on loopback, beside a bare axum "hello" in the same run, both
//! as processes of their own under the same load; and the memory of a request of 1,000,000 directions.
//!
//! `cargo bench --bench loopback`. Trust the ratio, not the rates: servers and load share the cores.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error>;

const CONNECTIONS: usize = 16;
const ROUND: Duration = Duration::from_secs(2);
const ROUNDS: usize = 5;
const BODY: &str = r#"{"model":"beckmann_spizzichino","surface":{"rms_height_um":0.2,"correlation_length_um":4.0},"illumination":{"wavelength_um":0.55},"geometry":{"theta_i_deg":30,"theta_r_deg":45},"components":["specular_lobe"]}"#;

fn main() -> Result<(), Failure> {
    if std::env::args().any(|argument| argument == "--hello") {
        return hello();
    }
    let service =
        Server::start(Command::new(env!("CARGO_BIN_EXE_reflectance")).args(["--listen", "127.0.0.1:0"]))?;
    let hello = Server::start(Command::new(std::env::current_exe()?).arg("--hello"))?;
    let (post, get) = (post("/v1/radiance", BODY), b"GET / HTTP/1.1\r\nhost: bench\r\n\r\n".to_vec());
    let mut ratios = Vec::new();
    for round in 1..=ROUNDS {
        let (a, b) = (service.rate(&post)?, hello.rate(&get)?);
        ratios.push(a / b);
        println!("round {round}: one direction {a:.0} requests/s, bare hello {b:.0}, ratio {:.3}", a / b);
    }
    ratios.sort_by(f64::total_cmp);
    println!("median ratio to hello: {:.3}", ratios[ROUNDS / 2]);
    memory(&service)?;
    Ok(())
}

/// The bare server: one route, no layers.
fn hello() -> Result<(), Failure> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await?;
        println!("http://{}/", listener.local_addr()?);
        let router = axum::Router::new().route("/", axum::routing::get(|| async { "hello" }));
        axum::serve(listener, router).await?;
        Ok(())
    })
}

fn post(path: &str, body: &str) -> Vec<u8> {
    let length = body.len();
    format!("POST {path} HTTP/1.1\r\nhost: bench\r\ncontent-type: application/json\r\ncontent-length: {length}\r\n\r\n{body}")
        .into_bytes()
}

struct Server {
    process: Child,
    address: String,
}

impl Drop for Server {
    fn drop(&mut self) {
        // Nothing to do about a process that has gone already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Server {
    /// Both servers print the address they listen at first.
    fn start(command: &mut Command) -> Result<Self, Failure> {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
        let output = process.stdout.take().ok_or("no standard output")?;
        let mut first = String::new();
        BufReader::new(output).read_line(&mut first)?;
        let address = first
            .split("http://")
            .nth(1)
            .and_then(|rest| rest.split('/').next())
            .ok_or("no address in the first line")?
            .to_owned();
        Ok(Self { process, address })
    }

    /// Requests a second over [`CONNECTIONS`] keep-alive connections, each waiting for its answer.
    fn rate(&self, request: &[u8]) -> Result<f64, Failure> {
        let start = Instant::now();
        let counts: Vec<Result<usize, std::io::Error>> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..CONNECTIONS)
                .map(|_| {
                    scope.spawn(|| {
                        let mut connection = Connection::open(&self.address)?;
                        let mut count = 0;
                        while start.elapsed() < ROUND {
                            connection.exchange(request)?;
                            count += 1;
                        }
                        Ok(count)
                    })
                })
                .collect();
            workers.into_iter().filter_map(|worker| worker.join().ok()).collect()
        });
        let elapsed = start.elapsed().as_secs_f64();
        let mut total = 0;
        for count in counts {
            total += count?;
        }
        Ok(total as f64 / elapsed)
    }

    /// A line of /proc/PID/status in KiB.
    fn status(&self, field: &str) -> Result<u64, Failure> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.process.id()))?;
        let line = status.lines().find(|line| line.starts_with(field)).ok_or("no such line")?;
        Ok(line.split_whitespace().nth(1).ok_or("no number")?.parse()?)
    }
}

struct Connection {
    stream: BufReader<TcpStream>,
    body: Vec<u8>,
}

impl Connection {
    fn open(address: &str) -> Result<Self, std::io::Error> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        Ok(Self { stream: BufReader::new(stream), body: Vec::new() })
    }

    /// Sends a request and reads its answer, which must be a 200 with a length.
    fn exchange(&mut self, request: &[u8]) -> Result<usize, std::io::Error> {
        self.stream.get_mut().write_all(request)?;
        let mut line = String::new();
        self.stream.read_line(&mut line)?;
        if !line.contains(" 200 ") {
            return Err(std::io::Error::other(format!("answered {line}")));
        }
        let mut length = 0;
        loop {
            line.clear();
            self.stream.read_line(&mut line)?;
            if line == "\r\n" {
                break;
            }
            if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
                length = value.trim().parse().map_err(std::io::Error::other)?;
            }
        }
        self.body.resize(length, 0);
        self.stream.read_exact(&mut self.body)?;
        Ok(length)
    }
}

/// Peak and resting memory around one request of a million directions.
fn memory(service: &Server) -> Result<(), Failure> {
    let idle = service.status("VmRSS")?;
    let angles: Vec<String> = (0..1_000_000).map(|i| format!("{:.6}", f64::from(i) * 8.9e-5)).collect();
    let body = BODY.replace("\"theta_r_deg\":45", &format!("\"theta_r_deg\":[{}]", angles.join(",")));
    let request = post("/v1/radiance", &body);
    let start = Instant::now();
    let length = Connection::open(&service.address)?.exchange(&request)?;
    let seconds = start.elapsed().as_secs_f64();
    let (peak, after) = (service.status("VmHWM")?, service.status("VmRSS")?);
    println!(
        "1,000,000 directions: {seconds:.2} s, body {} MB in, {} MB out; memory {} MB idle, {} MB peak, {} MB after",
        request.len() / 1_000_000,
        length / 1_000_000,
        idle / 1024,
        peak / 1024,
        after / 1024
    );
    Ok(())
}
