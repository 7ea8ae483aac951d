//! The page in headless Chromium.

#[path = "../../../../tests/lab/browser.rs"]
#[allow(dead_code, reason = "the lab's tests use more of it")]
mod browser;

pub(super) use browser::{Page, installed};
use serde_json::json;

/// Waits up to twenty seconds until an expression is true.
pub(super) fn until(page: &mut Page, expression: &str) -> Result<(), String> {
    for _ in 0..200 {
        if page.value(expression) == json!(true) {
            return Ok(());
        }
        page.value("new Promise((done) => setTimeout(done, 100))");
    }
    Err(format!("never true in the page: {expression}; errors: {:?}", page.errors))
}
