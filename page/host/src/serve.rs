//! Serves the page on this machine alone, compressed, each file with its type.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;

use axum::Router;
use axum::http::{HeaderValue, header};
use tower_http::services::ServeDir;
use tower_http::set_header::SetResponseHeaderLayer;

/// Serves `folder` until it is stopped, and says where.
pub fn serve(folder: &Path, port: u16) -> Result<(), String> {
    let files = ServeDir::new(folder).precompressed_br();
    // What was built anew is loaded anew.
    let fresh = SetResponseHeaderLayer::overriding(header::CACHE_CONTROL, HeaderValue::from_static("no-cache"));
    let router = Router::new().fallback_service(files).layer(fresh);
    let runtime = tokio::runtime::Runtime::new().map_err(|error| error.to_string())?;
    runtime.block_on(async {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let listener =
            tokio::net::TcpListener::bind(address).await.map_err(|error| format!("port {port}: {error}; --port names another"))?;
        let address = listener.local_addr().map_err(|error| error.to_string())?;
        println!("http://{address}/");
        axum::serve(listener, router).await.map_err(|error| error.to_string())
    })
}
