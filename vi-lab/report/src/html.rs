//! HTML: what is computed is escaped before it stands on a page.

/// Text with the characters that HTML reserves replaced.
#[must_use]
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
