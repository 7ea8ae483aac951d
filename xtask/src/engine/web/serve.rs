//! Serves the files of a folder to this machine only: browsers load no audio worklet from a file.

use std::io::{BufRead as _, BufReader, ErrorKind, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::time::Duration;

/// Listens on this machine alone; port 0 stands for any. Returns the port.
pub(super) fn listen(port: u16) -> Result<(u16, TcpListener), String> {
    let listener = TcpListener::bind(("127.0.0.1", port)).map_err(|error| match error.kind() {
        ErrorKind::AddrInUse => format!(
            "port {port} is taken, perhaps by another `cargo xtask web --serve`: end that, or choose another port with \
             --port N"
        ),
        _ => format!("port {port}: {error}"),
    })?;
    let port = listener.local_addr().map_err(|error| error.to_string())?.port();
    Ok((port, listener))
}

/// How long a request may take to arrive: a browser may open a connection and send nothing, while another one waits.
const PATIENCE: Duration = Duration::from_secs(1);

/// Answers requests one after another, for ever.
pub(super) fn run(listener: &TcpListener, folder: &Path) {
    for stream in listener.incoming().flatten() {
        // A browser that closes the connection is not an error.
        let _ = answer(stream, folder);
    }
}

fn answer(mut stream: TcpStream, folder: &Path) -> std::io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    // The rest of the head is read, so that the browser is not cut off while it writes.
    for line in lines {
        if line?.is_empty() {
            break;
        }
    }
    let found = name(&request).and_then(|name| Some((name, std::fs::read(folder.join(name)).ok()?)));
    let (status, kind, body) = match found {
        Some((name, body)) => ("200 OK", kind(name), body),
        None => ("404 Not Found", "text/plain", b"there is no such file\n".to_vec()),
    };
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    )?;
    // HEAD: the same header as for GET, without the body.
    if request.starts_with("HEAD ") { Ok(()) } else { stream.write_all(&body) }
}

/// The name of the file that a request line asks for; `None` if it is not a plain name, such as a path out of the folder.
fn name(request: &str) -> Option<&str> {
    let path = ["GET /", "HEAD /"].iter().find_map(|asked| request.strip_prefix(asked))?;
    let path = path.split([' ', '?']).next()?;
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
    match path {
        "" => Some("index.html"),
        name if name.chars().all(is_plain) && !name.starts_with('.') => Some(name),
        _ => None,
    }
}

fn kind(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "css" => "text/css",
        "js" => "text/javascript",
        "wasm" => "application/wasm",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn a_silent_connection_does_not_keep_others_waiting() {
        let (port, listener) = listen(0).unwrap();
        std::thread::spawn(move || run(&listener, Path::new("/nowhere")));
        let _silent = TcpStream::connect(("127.0.0.1", port)).unwrap();
        let answer = ask(port, "GET /page.js HTTP/1.1");
        assert!(answer.starts_with("HTTP/1.1 404 Not Found"), "{answer}");
    }

    #[test]
    fn head_is_answered_as_get_without_the_file() {
        let (port, listener) = listen(0).unwrap();
        std::thread::spawn(move || run(&listener, Path::new(env!("CARGO_MANIFEST_DIR"))));
        let [head, whole] = ["HEAD", "GET"].map(|method| ask(port, &format!("{method} /Cargo.toml HTTP/1.1")));
        assert!(head.starts_with("HTTP/1.1 200 OK") && head.ends_with("\r\n\r\n"), "{head}");
        assert!(whole.strip_prefix(&head).is_some_and(|file| file.starts_with("[package]")), "{whole}");
    }

    #[test]
    fn a_port_that_is_taken_is_named_with_what_to_do() {
        let (port, _listener) = listen(0).unwrap();
        let message = listen(port).unwrap_err();
        assert!(message.contains(&format!("port {port} is taken")) && message.contains("--port"), "{message}");
    }

    /// The answer to a request.
    fn ask(port: u16, request: &str) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(20 * PATIENCE)).unwrap();
        write!(stream, "{request}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    #[test]
    fn only_plain_names_are_served() {
        for (request, expected) in [
            ("GET / HTTP/1.1", Some("index.html")),
            ("GET /page.js?1 HTTP/1.1", Some("page.js")),
            ("HEAD /page.js HTTP/1.1", Some("page.js")),
            ("GET /../Cargo.toml HTTP/1.1", None),
            ("GET /.. HTTP/1.1", None),
            ("POST /page.js HTTP/1.1", None),
        ] {
            assert_eq!(name(request), expected, "{request}");
        }
        assert_eq!(kind("sprung.wasm"), "application/wasm");
    }
}
