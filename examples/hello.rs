//! The floor of a request: a bare axum server, one route and no layers. `scripts/load.sh` sets the service beside it.
//!
//! `cargo run --release --example hello` prints the address that it listens at.

use axum::Router;
use axum::routing::get;
use tokio::net::TcpListener;

#[tokio::main]
async fn main() -> Result<(), std::io::Error> {
    let listener = TcpListener::bind("127.0.0.1:0").await?;
    println!("hello on http://{}/", listener.local_addr()?);
    axum::serve(listener, Router::new().route("/", get(|| async { "hello" }))).await
}
