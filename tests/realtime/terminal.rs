//! The terminal view, operated by keys in tmux.

use super::sandbox::{Sandbox, text, wait_until};
use std::process::Command;

/// A tmux server used only by this test.
struct Terminal {
    socket: String,
    sandbox: Sandbox,
}

impl Terminal {
    /// Starts `sprung` in a terminal of this size, on a null device that runs at real-time speed.
    fn start(name: &str, arguments: &str) -> Self {
        let sandbox = Sandbox::new();
        let pipe = sandbox.path("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let device = format!(
            "pcm.default {{ type file\n slave.pcm {{ type null }}\n file \"{}\"\n format \"raw\" }}",
            pipe.display()
        );
        sandbox.write("asound.conf", device);
        std::thread::spawn(move || super::alsa::read_at_a_pace(pipe));
        let terminal = Self { socket: format!("sprung-{name}-{}", std::process::id()), sandbox };
        let config = terminal.sandbox.path("asound.conf");
        let command = format!(
            "ulimit -f 200000; ALSA_CONFIG_PATH={} exec timeout --foreground -k 5 60 {} {arguments} 2> {}",
            config.display(),
            env!("CARGO_BIN_EXE_sprung"),
            terminal.sandbox.path("stderr").display(),
        );
        terminal.tmux(&["new-session", "-d", "-x", "100", "-y", "30", &command]);
        terminal
    }

    fn tmux(&self, arguments: &[&str]) -> String {
        let output = Command::new("tmux").args(["-L", &self.socket, "-f", "/dev/null"]).args(arguments).output();
        String::from_utf8_lossy(&output.unwrap().stdout).into_owned()
    }

    fn keys(&self, keys: &[&str]) {
        self.tmux(&[&["send-keys"], keys].concat());
    }

    #[track_caller]
    fn shows(&self, what: &str) {
        let mut last = String::new();
        wait_until(what, || {
            last = self.tmux(&["capture-pane", "-p"]);
            last.contains(what)
        });
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.tmux(&["kill-server"]);
    }
}

#[test]
#[ignore = "waits for seconds to pass"]
fn the_view_plays_loads_turns_and_resizes() {
    let terminal = Terminal::start("view", "play --midi-in none");
    terminal.shows("Masses");
    terminal.keys(&["z", "c", "b"]);
    terminal.shows("3 voices");
    terminal.keys(&["/", "k", "i", "c", "k", "Enter", "Enter"]);
    terminal.shows("channel 1 plays ‘Kick’");
    terminal.keys(&["Tab", "/", "d", "a", "m", "p", "e", "r", "Enter", "Enter"]);
    terminal.keys(&["2", "5", "Space", "%", "Enter"]);
    terminal.shows("25 %");
    terminal.keys(&["?"]);
    terminal.shows("Help");
    terminal.keys(&["?"]);
    for (width, height) in [("40", "12"), ("100", "30")] {
        terminal.tmux(&["resize-window", "-x", width, "-y", height]);
        wait_until("the size has changed", || {
            terminal.tmux(&["display-message", "-p", "#{window_width}x#{window_height}"]).trim()
                == format!("{width}x{height}")
        });
        terminal.shows("Masses");
    }
    terminal.keys(&["C-c"]);
    let stderr = terminal.sandbox.path("stderr");
    wait_until("it ends cleanly", || text(&stderr).contains("played "));
}
